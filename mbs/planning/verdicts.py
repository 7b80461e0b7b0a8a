"""Physics of the films that a scene requires, from the ranges that it visits: verdicts with their reasons.

How much a limiting shear stress changes a contact: by two solutions, as no closed form says it.

Where the pressure has a steep spike, a Newtonian oil would carry more shear stress at the walls than any oil bears
(`ehdmaps.physics.wall_stress`). A solution takes some hundredths of a second.

The criteria are those of `mbs.planning.criteria`, each taken at its worst over both contacts, over the speeds of
the scene, and over the loads of the rollers that carry it, `SHARES` of the highest load at rest. Rollers that carry
less take less than that part in stiffness. The oil supply is looked at down to the lowest load of the planned map,
that of idle rollers, whose films are the thick ones.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import SolverError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job_text import Entry
from ehdmaps.jobs.make.law_check import SMALL_DAMPING
from ehdmaps.maps.film_field import RIGID, load_at
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.heat import INLET_HEAT, ISOTHERMAL, inlet_heat
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, THICKEST, THINNEST, OilSupply
from ehdmaps.physics.solution import ContactSolution, ContactSolver, contact_solution
from ehdmaps.physics.surface import FINEST, SMOOTH, Surface
from ehdmaps.units import SPEED
from mbs.model.relaxation import Films
from mbs.planning.criteria import (
    TOUCHING,
    ClosedContact,
    film_over_roughness,
    heat_effect,
    memory_change,
    memory_effect,
    roughness_effect,
    supply_effect,
)
from mbs.planning.ranges import Needed
from mbs.scene.fields import HERTZ, MICROMETRE

if TYPE_CHECKING:
    from mbs.planning.seen import PointContact, Seen


def shear_effect(state: ClosedContact, lubricant: Lubricant, loads: FloatArray) -> tuple[float, float]:
    """By how much a limiting stress changes k and c of a contact, the largest over some loads, as parts.

    Parameters
    ----------
    state : ClosedContact
        Contact, speed and temperature.
    lubricant : Lubricant
        The oil.
    loads : ndarray, shape (n,)
        Loads [N/m], > 0, rising.

    Returns
    -------
    (float, float)
        Changes as of `change_felt`; -1 where no load has both solutions.
    """
    both = (solvers.build("reynolds", {"shear": shear}) for shear in ("newtonian", "limiting"))
    pairs = zip(*(_solved(solver, state, lubricant, loads) for solver in both), loads.tolist(), strict=True)
    sizes = [
        change_felt(state, load, plain, limited)
        for plain, limited, load in pairs
        if plain.status.usable and limited.status.usable
    ]
    stiffness, damping = np.max(sizes, axis=0, initial=-1.0) if sizes else (-1.0, -1.0)
    return float(stiffness), float(damping)


def change_felt(
    state: ClosedContact, load: float, plain: ContactSolution, other: ContactSolution
) -> tuple[float, float]:
    """By how much k and c of a contact change, as parts of the plain values.

    Damping runs through zero in its valley. There its change is related to `SMALL_DAMPING` k b/u, as in the check of
    the laws of a map: a damper below that is one that nothing feels.

    Parameters
    ----------
    state : ClosedContact
        Contact and speed.
    load : float
        Load [N/m].
    plain, other : ContactSolution
        Solutions at the load, without the physics and with it.
    """
    width = half_width(load, state.contact.radius, state.contact.reduced_modulus)
    least = SMALL_DAMPING * plain.stiffness * width / state.speed
    by_damping = abs(other.damping - plain.damping) / max(abs(plain.damping), least)
    return abs(other.stiffness / plain.stiffness - 1.0), float(by_damping)


def _solved(
    solver: ContactSolver, state: ClosedContact, lubricant: Lubricant, loads: FloatArray
) -> list[ContactSolution]:
    """Solutions at all loads."""
    films = solver.solve_line(state.contact, lubricant, tuple(loads.tolist()), state.speed, state.temperature)
    return [
        contact_solution(film, state.contact, OperatingPoint(load, state.speed, state.temperature))
        for film, load in zip(films, loads.tolist(), strict=True)
    ]


TOLERANCE = 0.05
"""Change of a stiffness or damping of a contact above which physics is switched on, as a part of it."""

SHARES = (0.1, 1.0)
"""Loads of rollers that carry a bearing, over the highest one at rest."""

_LOADS, _SPEEDS, _SOLVED_LOADS = 9, 5, 4
_ZETA, _ZETAS = (RIGID, 6.0), 41
"""Places ln(M/M_valley) that the lines of a map reach, and how many of them are looked at."""

_LAYERS = 241


_ASKED = "as asked"
"""Beginning of the reason of what was asked for."""


@dataclass(frozen=True)
class Verdict:
    """Verdict on whether one kind of physics is switched on, and why.

    Attributes
    ----------
    physics : str
        Which: "film memory", "oil supply", "roughness", "inlet heating", "limiting shear stress", or of the machine
        (`mbs.planning.machine`).
    on : bool or None
        Whether the analysis has it; None for what cannot be decided.
    size : float
        How much it matters: the largest change of a stiffness or damping, as a part of it; of roughness the smallest
        Lambda. NaN where it was not looked at.
    words : str
        The reason, for people.
    solver : mapping
        Keys of [solver] of the map that it takes.
    errors : (float, float)
        What k and c of a contact may be wrong by without it, as parts; 0 where that is not known.
    warns : bool
        Whether physics that matters is left out, since it cannot be had.
    """

    physics: str
    on: bool | None
    size: float
    words: str
    solver: Mapping[str, Entry] = field(default_factory=dict)
    errors: tuple[float, float] = (0.0, 0.0)
    warns: bool = False

    @property
    def asked(self) -> bool:
        """Tell whether it is as it was asked for, in the place of a judgement."""
        return self.words.startswith(_ASKED)

    @property
    def missing(self) -> tuple[float, float]:
        """Errors of k and c of a contact for want of it, as parts: none where it is on."""
        return (0.0, 0.0) if self.on else self.errors

    @property
    def line(self) -> str:
        """The verdict in a line."""
        state = "" if self.on is None else "on, " if self.on else "off, "
        return f"{self.physics}: {state}{self.words}"

    def left_out(self, reason: str) -> Verdict:
        """The verdict on physics that cannot be had: off, and a warning of what that leaves out.

        Parameters
        ----------
        reason : str
            Why it cannot be had.
        """
        return replace(self, on=False, words=f"left out although {self.words}: {reason}", solver={}, warns=True)


@dataclass(frozen=True, eq=False)
class Range:
    """Contacts at the operating points that a scene visits.

    Attributes
    ----------
    states : tuple of ClosedContact
        One a contact and speed, over loads from the lowest one of the plan to the highest one at rest.
    highest : float
        Highest load at rest [N/m].
    lubricant : Lubricant
        The oil.
    tolerance : float
        Change of a stiffness or damping that is still accepted, as a part of it.
    points : tuple of PointContact
        The same of points; then there are no lines.
    has_map : bool
        Whether maps are made of such contacts.
    """

    states: tuple[ClosedContact, ...]
    highest: float
    lubricant: Lubricant
    tolerance: float
    points: tuple[PointContact, ...] = ()
    has_map: bool = True

    @property
    def of_lines(self) -> bool:
        """Tell whether its contacts are lines."""
        return bool(self.states)

    @property
    def slowest_and_fastest(self) -> tuple[ClosedContact, ...]:
        """The states at the lowest and at the highest speed of each contact."""
        speeds = [state.speed for state in self.states]
        return tuple(state for state in self.states if state.speed in (min(speeds), max(speeds)))

    def carrying(self, values: Callable[[Any], FloatArray]) -> tuple[float, ClosedContact | PointContact]:
        """The largest of some values at the loads of rollers that carry the bearing, and where it is.

        Parameters
        ----------
        values : callable
            Gives a value for each load of a contact.
        """
        low = SHARES[0] * self.highest * (1.0 - 1e-9)
        every: tuple[ClosedContact | PointContact, ...] = (*self.states, *self.points)
        worst = [(float(np.max(values(state)[state.load >= low])), state) for state in every]
        return max(worst, key=lambda entry: entry[0])


def visited(needed: Needed | Seen, lubricant: Lubricant, tolerance: float) -> Range:
    """The range of the bearings of one geometry.

    Parameters
    ----------
    needed : Needed or Seen
        What they need of a map, or see without one. Speeds at which the film table has no points are left out.
    lubricant : Lubricant
        The oil.
    tolerance : float
        Accepted change, as a part.
    """
    highest = needed.static_load
    carried = np.geomspace(SHARES[0] * highest, SHARES[1] * highest, _LOADS)
    idle = np.geomspace(min(needed.load[0], carried[0]), carried[0], _LOADS)
    loads = np.union1d(idle[:-1], carried)
    pairs = []
    for speed in np.unique(np.geomspace(*needed.entrainment_speed, _SPEEDS)).tolist():
        with contextlib.suppress(SolverError):
            pairs.append(needed.states(lubricant, loads, speed))
    states = [state for side in zip(*pairs, strict=True) for state in side]
    lines = tuple(state for state in states if isinstance(state, ClosedContact))
    points = tuple(state for state in states if not isinstance(state, ClosedContact))
    return Range(lines, highest, lubricant, tolerance, points, isinstance(needed, Needed))


def memory_verdict(found: Range, frequency: float, asked: Films | None, without: str = "") -> Verdict:
    """Judge whether films need their memory.

    Parameters
    ----------
    found : Range
        Operating points.
    frequency : float
        Highest frequency that is looked at [Hz]; 0 for an equilibrium.
    asked : {"slow", "memory"} or None
        What was asked for.
    without : str
        What of the scene films with memory do not go with; empty where they do.
    """
    name = "film memory"
    if frequency == 0.0:
        return Verdict(name, False, math.nan, "as an equilibrium has no frequency")
    effect, of = (memory_effect, "k + i omega c") if found.has_map else (memory_change, "k or c")
    size, state = found.carrying(lambda entry: effect(entry, frequency))
    words = (
        f"films of slow motion would be wrong by {up_to(size)} in {of} of a contact at "
        f"{HERTZ.text(frequency)} and {SPEED.text(state.speed)}"
    )
    if asked is not None:
        return Verdict(name, asked == "memory", size, f"{_ASKED}; {words}")
    if without:
        return Verdict(name, False, size, f"{words}; with {without} there is none", warns=size > found.tolerance)
    return Verdict(name, size > found.tolerance, size, f"{words} ({beside(size, found.tolerance)})")


def supply_verdict(found: Range, supplies: tuple[OilSupply, ...], asked: bool = False) -> Verdict:
    """Judge whether the stated oil supply matters; without one, which layer would.

    Parameters
    ----------
    found : Range
        Operating points.
    supplies : tuple of OilSupply
        Those of the bearings.
    asked : bool
        Whether they were asked for, so that they are taken in any case.
    """
    name = "oil supply"
    stated = [supply for supply in supplies if not supply.flooded]
    if not stated:
        layer = _layer_that_matters(found)
        return Verdict(name, False, math.nan, f"none is stated; a layer below {MICROMETRE.text(layer, 3)} would matter")
    thinnest = min(stated, key=lambda supply: supply.oil_layer)
    size = max(float(np.max(supply_effect(state, thinnest.oil_layer))) for state in found.states)
    words = f"{thinnest.label} changes k or c of a contact by {up_to(size)} ({beside(size, found.tolerance)})"
    on = asked or size > found.tolerance
    return Verdict(name, on, size, f"{f'{_ASKED}; ' if asked else ''}{words}", errors=(size, size))


def roughness_verdict(found: Range, surface: Surface | None) -> Verdict:
    """Judge whether the stated roughness matters; without one, which would.

    Parameters
    ----------
    found : Range
        Operating points.
    surface : Surface or None
        Surfaces that the scene states.
    """
    name = "roughness"
    sizes, state = found.carrying(lambda entry: -film_over_roughness(entry, 1.0))
    smallest = -sizes
    if surface is None or surface.smooth:
        least = max(smallest / TOUCHING, FINEST)
        return Verdict(
            name, False, math.nan, f"none is stated; above {MICROMETRE.text(least, 2)} asperities would touch"
        )
    size = smallest / surface.roughness
    beside = "asperities touch" if size < TOUCHING else "asperities do not touch"
    words = f"Lambda down to {size:.2g} at {SPEED.text(state.speed)} ({beside}; they do below {TOUCHING:g})"
    carried = [entry.load >= SHARES[0] * found.highest * (1.0 - 1e-9) for entry in found.states]
    # of asperities no more is known than their usual range
    ends = np.array(
        [
            np.max(
                [
                    [part[which].max() for part in roughness_effect(entry, corner, found.lubricant)]
                    for entry, which in zip(found.states, carried, strict=True)
                ],
                axis=0,
            )
            for corner in surface.corners
        ]
    )
    changes, least = ends.max(axis=0).tolist(), ends.min(axis=0).tolist()
    words += f"; it changes k of a contact by {up_to(changes[0])}, c by {up_to(changes[1])}"
    if ends[0].tolist() != ends[1].tolist():
        words += f" (other usual asperities {up_to(least[0])}, {up_to(least[1])})"
    return Verdict(name, size < TOUCHING, size, words, errors=(changes[0], changes[1]))


def heat_verdict(found: Range, asked: str | None = None) -> Verdict:
    """Judge whether heating of the inlet matters, and whether the map has it.

    Where it matters the map has it by its rule (`ehdmaps.physics.heat`) where that holds all over the map. Films
    with temperatures take some ten times as long, and are made where they are asked for.

    Parameters
    ----------
    found : Range
        Operating points.
    asked : {"isothermal", "inlet-heat", "thermal"} or None
        What was asked for.
    """
    name = "inlet heating"
    size, state = found.carrying(lambda entry: heat_effect(entry, found.lubricant))
    if math.isnan(size):
        return Verdict(name, False, size, f"unknown: no thermal conductivity of {found.lubricant.title} is known")
    errors = (0.0, size)
    change = "more than the formula covers" if size >= 1.0 else f"{up_to(size)} at {SPEED.text(state.speed)}"
    words = f"it would lower c by {change} ({beside(size, found.tolerance)})"
    if asked is not None:
        on = asked != ISOTHERMAL
        return Verdict(name, on, size, f"{_ASKED}, {asked}; {words}", {"physics": asked} if on else {}, errors)
    if size <= found.tolerance:
        return Verdict(name, False, size, words, errors=errors)
    refused = _no_rule(found) if found.has_map else ""
    if not refused:
        return Verdict(name, True, size, f"{words}; the map has it by its rule", {"physics": INLET_HEAT}, errors)
    words = f"{words}; its rule does not hold here ({refused}); --physics thermal has it"
    return Verdict(name, False, size, words, errors=errors)


def shear_verdict(found: Range, asked: str | None = None) -> Verdict:
    """Judge whether a limiting shear stress matters: by solutions with it and without, at few loads.

    Parameters
    ----------
    found : Range
        Operating points.
    asked : str or None
        Law of shear that was asked for, a word of `ehdmaps.physics.rheology.SHEARS`.
    """
    name = "limiting shear stress"
    loads = np.geomspace(*SHARES, _SOLVED_LOADS) * found.highest
    effects = [shear_effect(state, found.lubricant, loads) for state in found.slowest_and_fastest]
    size, state = max(zip(map(max, effects), found.slowest_and_fastest, strict=True), key=lambda entry: entry[0])
    errors = max(0.0, *(k for k, _ in effects)), max(0.0, *(c for _, c in effects))
    if size < 0.0:
        words = "unknown: no film of these contacts could be solved with it and without"
        size = math.nan
    else:
        words = (
            f"it would change k or c of a contact by {up_to(size)} at {SPEED.text(state.speed)} "
            f"({beside(size, found.tolerance)})"
        )
    if asked is not None:
        on = asked != "newtonian"
        return Verdict(name, on, size, f"{_ASKED}, {asked}; {words}", {"shear": asked} if on else {}, errors)
    on = size > found.tolerance
    return Verdict(name, on, size, words, {"shear": "limiting"} if on else {}, errors)


def _no_rule(found: Range) -> str:
    """Say why the rule of inlet heat fails at some points that a map of this range solves; empty where it holds."""
    for state in found.states:
        for zeta in np.linspace(*_ZETA, _ZETAS).tolist():
            load = load_at(state.contact, found.lubricant, zeta, state.speed, state.temperature)
            heat = inlet_heat(state.contact, found.lubricant, OperatingPoint(load, state.speed, state.temperature))
            if heat.refused:
                return heat.refused.removeprefix("inlet heat: ").split("; ")[0]
    return ""


def in_force(supplies: tuple[OilSupply, ...], verdict: Verdict) -> OilSupply | None:
    """The supply that a law is made with: flooded where a stated one does not matter, else None, which is as stated.

    Parameters
    ----------
    supplies : tuple of OilSupply
        Those of the bearings.
    verdict : Verdict
        Verdict on these supplies.
    """
    stated = any(not supply.flooded for supply in supplies)
    return FLOODED if stated and not verdict.on else None


def surface_in_force(surface: Surface | None, verdict: Verdict) -> Surface | None:
    """The surface that a law is made with: smooth where a stated roughness does not matter.

    Parameters
    ----------
    surface : Surface or None
        What the scene states.
    verdict : Verdict
        Verdict on this surface.
    """
    return surface if surface is None or verdict.on else SMOOTH


def _layer_that_matters(found: Range) -> float:
    """Thickest oil layer that changes a contact by more than the tolerance [m]."""
    layers = np.geomspace(THINNEST, THICKEST, _LAYERS)
    thickest = [layer for layer in layers.tolist() if _changes(found, layer)]
    return max(thickest, default=THINNEST)


def _changes(found: Range, layer: float) -> bool:
    """Tell whether an oil layer changes a contact by more than the tolerance."""
    return any(np.any(supply_effect(state, layer) > found.tolerance) for state in found.states)


MOST_STATED = 0.9
"""Most that an error of k or c is stated as, as a part: laws that are wrong on purpose keep a stiffness."""


def left_out_verdict(verdicts: Sequence[Verdict], in_bands: bool = True) -> tuple[Verdict, tuple[float, float]]:
    """Sum up what is left out or not decided, and what errors of k and c a law is to state for it.

    Parameters
    ----------
    verdicts : sequence of Verdict
        Those on the films of one type of bearing.
    in_bands : bool
        Whether bands have them: those of bearings with maps do.
    """
    stiffness, damping = (math.fsum(parts) for parts in zip(*(verdict.missing for verdict in verdicts), strict=True))
    stated = min(stiffness, MOST_STATED), min(damping, MOST_STATED)
    capped = f", at most {percent(MOST_STATED)} each" if (stiffness, damping) != stated else ""
    words = (
        f"{percent(stated[0])} of k and {percent(stated[1])} of c of a contact, by the sizes above{capped}; "
        f"{'the bands (+-) have them' if in_bands else 'no band has them'}"
    )
    return Verdict("left out of the films", None, max(stiffness, damping), words), stated


MOST_TOLD = 9.0
"""Change, as a part, above which its size is not told: what grows tenfold is another contact."""


def percent(part: float) -> str:
    """A part in per cent, with two digits or more, and no exponent above.

    Parameters
    ----------
    part : float
        The part, >= 0.

    Examples
    --------
    >>> percent(0.0123), percent(1.234)
    ('1.2 %', '123 %')
    """
    return f"{100.0 * part:.2g} %" if part < 0.995 else f"{100.0 * part:.0f} %"


def up_to(part: float) -> str:
    """The largest of some changes, for people.

    Parameters
    ----------
    part : float
        The part, >= 0.

    Examples
    --------
    >>> up_to(0.55), up_to(2.32), up_to(5820.6)
    ('up to 55 %', 'a factor of up to 3.3', 'a factor of more than 10')
    """
    if part <= 1.0:
        return f"up to {percent(part)}"
    return f"a factor of up to {1.0 + part:.2g}" if part <= MOST_TOLD else f"a factor of more than {1.0 + MOST_TOLD:g}"


def beside(size: float, tolerance: float) -> str:
    """A size beside the tolerance, for people.

    Parameters
    ----------
    size, tolerance : float
        Change, and the accepted one, as parts.

    Examples
    --------
    >>> beside(0.1, 0.05), beside(0.01, 0.05)
    ('more than 5 %', 'not more than 5 %')
    """
    return f"{'more' if size > tolerance else 'not more'} than {percent(tolerance)}"
