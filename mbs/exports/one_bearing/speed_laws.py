"""Laws of contacts over the entrainment speed: one table of approaches and speeds, as programs in C read it.

A law at one speed is a table over z = asinh((approach - centre)/scale). Here centre and scale go with the film offset
h of the speed at one load, centre = -h and scale = h/2, so that the same nodes of z are the same places of all films,
and ln g and ln c change evenly with ln u. Between speeds that are even in ln u all is a polynomial through the four
nearest ones.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.balls.laws import NODES
from mbs.bearings.locating.film_tables import on_grid
from mbs.bearings.locating.normal_law import NormalLaw, PairLaw, contact, load_approach

STEP = 0.2
"""Largest distance of two speeds in ln u: with it loads are right within some 1e-4 between them."""

NEIGHBOURS = 4
"""Most speeds of the table that a place between them takes; as in `pair_speeds.c`."""

LIGHT = 1e-2
"""Part of the highest load from which on the error between speeds is stated."""

_SCALE = 0.5
_BEYOND = 3.0
_LEAST = 0.1


@dataclass(frozen=True, eq=False)
class SpeedLaws:
    """Laws of both contacts over the speed.

    Attributes
    ----------
    inner, outer : NormalLaw
        Coefficient and nodes of z, which all speeds share; the table is that of the first speed.
    speeds : array (n,)
        Entrainment speeds, even in the logarithm [m/s]; none for dry contacts.
    tables : array (n, 2, nodes, 4)
        Tables of the inner and the outer contact.
    places : array (n, 2, 2)
        Their centres and scales [m].
    highest : float
        Load up to which all of them were made [N].
    shorter : tuple of float
        Times of the springs of a film with memory over the longest one; none without memory.
    springs : array (n, 2, nodes, springs + 1)
        Springs of films with memory: the part of the damping that each has, and ln of the longest of their times [s].
    """

    inner: NormalLaw
    outer: NormalLaw
    speeds: FloatArray
    tables: FloatArray
    places: FloatArray
    highest: float
    shorter: tuple[float, ...] = ()
    springs: FloatArray = field(default_factory=lambda: np.zeros((0, 2, 0, 0)))

    @property
    def memory(self) -> bool:
        """True where films have a memory."""
        return bool(self.shorter)

    @property
    def dry(self) -> bool:
        """True where contacts have no films."""
        return self.speeds.size == 0

    @cached_property
    def per_log(self) -> float:
        """Speeds in a unit of ln u; 0 where there is one."""
        count = self.speeds.size
        return float((count - 1) / math.log(self.speeds[-1] / self.speeds[0])) if count > 1 else 0.0

    def at(self, entrainment_speed: float) -> PairLaw:
        """Laws at a speed, as the C has them.

        Parameters
        ----------
        entrainment_speed : float
            Speed [m/s], of either sign; held at the ends of the table.
        """
        if self.dry:
            return PairLaw(self.inner, self.outer)
        speed = min(max(abs(entrainment_speed), float(self.speeds[0])), float(self.speeds[-1]))
        first, weights = _weights(math.log(speed / self.speeds[0]) * self.per_log, self.speeds.size)
        chosen = slice(first, first + weights.size)
        tables, places = (np.tensordot(weights, one[chosen], 1) for one in (self.tables, self.places))
        inner, outer = (
            side._replace(centre=float(place[0]), scale=float(place[1]), table=np.ascontiguousarray(table))
            for side, table, place in zip((self.inner, self.outer), tables, places, strict=True)
        )
        return PairLaw(inner, outer, (0.0, self.highest))


def dry_speed_laws(inner: NormalLaw, outer: NormalLaw) -> SpeedLaws:
    """Laws without films.

    Parameters
    ----------
    inner, outer : NormalLaw
        The dry laws of both contacts.
    """
    return SpeedLaws(inner, outer, np.zeros(0), np.zeros((0, 2, 0, 4)), np.zeros((0, 2, 2)), math.inf)


def film_speed_laws(
    films: Callable[[float], PairLaw],
    slowest: float,
    fastest: float,
    *,
    shorter: tuple[float, ...] = (),
    dry: Callable[[float], float] | None = None,
    step: float = STEP,
) -> SpeedLaws:
    """Laws with films from one speed to another.

    Parameters
    ----------
    films : callable
        Law with the films of an entrainment speed [m/s].
    slowest, fastest : float
        Entrainment speeds [m/s], > 0. Where they are alike the law is that of the speed, on its own nodes.
    shorter : tuple of float
        Times of the springs of films with memory over the longest one, such as `mbs.bearings.balls.response.SHORTER`.
    dry : callable, optional
        Approach [m] of a dry contact by its load [N]; that of balls if left out.
    step : float
        Largest distance of two speeds in ln u.

    Raises
    ------
    SolverError
        If a speed has no films, or none over frequency for a memory.
    """
    count = 1 if fastest == slowest else max(NEIGHBOURS, 1 + math.ceil(math.log(fastest / slowest) / step))
    speeds = np.geomspace(slowest, fastest, count)
    laws = [films(float(speed)) for speed in speeds]
    lowest, highest = max(law.loads[0] for law in laws), min(law.loads[1] for law in laws)
    inner, inner_tables, inner_places = _side([law.inner for law in laws], lowest, highest, dry)
    outer, outer_tables, outer_places = _side([law.outer for law in laws], lowest, highest, dry)
    tables = np.stack((inner_tables, outer_tables), axis=1)
    made = SpeedLaws(inner, outer, speeds, tables, np.stack((inner_places, outer_places), axis=1), highest)
    return dataclasses.replace(made, shorter=shorter, springs=_springs(laws, made, shorter)) if shorter else made


def _springs(laws: Sequence[PairLaw], made: SpeedLaws, shorter: tuple[float, ...]) -> FloatArray:
    """Springs of films with memory at all speeds and nodes."""
    found = np.zeros((*made.tables.shape[:3], len(shorter) + 1))
    for n, law in enumerate(laws):
        for side, one in enumerate((made.inner, made.outer)):
            (centre, scale), table = made.places[n, side].tolist(), made.tables[n, side]
            *springs, time = law.springs_on(side, one._replace(centre=centre, scale=scale), table).T
            parts = [k * part * time / np.exp(table[:, 2]) for k, part in zip(springs, shorter, strict=True)]
            found[n, side] = np.column_stack([*parts, np.log(time)])
    return found


def error_between(
    laws: SpeedLaws, films: Callable[[float], PairLaw], *, of_largest: bool = False
) -> tuple[float, float, float]:
    """Largest relative errors of load, stiffness and damping in the middles between the speeds of a table.

    Loads are from `LIGHT` of the highest one to that.

    Parameters
    ----------
    laws : SpeedLaws
        The table, with films.
    films : callable
        What it was made of.
    of_largest : bool
        Whether errors of the damping are parts of its largest value among these loads.
    """
    worst = np.zeros(3)
    loads = np.geomspace(LIGHT, 1.0, 25) * laws.highest
    for speed in np.sqrt(laws.speeds[1:] * laws.speeds[:-1]).tolist():
        found, wanted = laws.at(speed), films(speed)
        for name in ("inner", "outer"):
            one, other = getattr(found, name), getattr(wanted, name)
            places = [load_approach(other, float(load)) for load in loads]
            values, exact = (np.array([contact(law, place) for place in places]) for law in (one, other))
            sizes = exact.copy()
            if of_largest:
                sizes[:, 2] = exact[:, 2].max()
            worst = np.maximum(worst, np.max(np.abs((values - exact) / sizes), axis=0))
    load, stiffness, damping = worst.tolist()
    return load, stiffness, damping


def _weights(place: float, speeds: int) -> tuple[int, FloatArray]:
    """First neighbour of a place in steps, and the weights of the polynomial through it and the next ones."""
    count = min(speeds, NEIGHBOURS)
    first = min(max(math.floor(place) - (count // 2 - 1), 0), speeds - count)
    weights = np.ones(count)
    for i in range(count):
        for k in range(count):
            if k != i:
                weights[i] *= (place - first - k) / (i - k)
    return first, weights


def _side(
    laws: list[NormalLaw], lowest: float, highest: float, dry: Callable[[float], float] | None
) -> tuple[NormalLaw, FloatArray, FloatArray]:
    """Nodes, tables and places of one contact at all speeds."""
    if len(laws) == 1:
        return laws[0], laws[0].table[None], np.array([[laws[0].centre, laws[0].scale]])
    middle, ends = math.sqrt(lowest * highest), (lowest, _BEYOND * highest)
    bare = [(middle / law.coefficient) ** (2.0 / 3.0) if dry is None else dry(middle) for law in laws]
    offsets = [approach - load_approach(law, middle) for approach, law in zip(bare, laws, strict=True)]
    if dry is not None:  # thinner films than this law of dry lines is right keep a scale
        offsets = [
            0.5 * (h + math.hypot(h, 2.0 * _LEAST * approach)) for h, approach in zip(offsets, bare, strict=True)
        ]
    places = np.array([[-offset, _SCALE * offset] for offset in offsets])
    reach = [
        math.asinh((load_approach(law, load) - centre) / scale)
        for law, (centre, scale) in zip(laws, places.tolist(), strict=True)
        for load in ends
    ]
    first, tables = min(reach), np.zeros((len(laws), NODES, 4))
    step = (max(reach) - first) / (NODES - 1)
    grids = [law._replace(centre=c, scale=s, first=first, step=step) for law, (c, s) in zip(laws, places, strict=True)]
    for law, grid, table in zip(laws, grids, tables, strict=True):
        on_grid(law, grid, table)
    return grids[0]._replace(table=tables[0]), tables, places
