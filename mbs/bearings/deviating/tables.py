"""Deviations of a bearing from its form, by which it excites what it carries: waves, spalls, elements of other sizes.

They add an approach to each contact of a rolling element with the inner or the outer ring, and its rate, as
`ehdmaps/kernel/c/run/deviations.h` says: tables over a turn of a ring or of an element, and the sizes of elements. Runs
in time have them; an equilibrium is that of the perfect bearing. Rows of one ring have the same waves.
"""

from __future__ import annotations

import ctypes
import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, NamedTuple, Protocol

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.passes import Rolling, passes_of

On = Literal["inner", "outer", "elements"]
"""What deviates: a ring, or rolling elements."""

PARTS: tuple[On, ...] = ("inner", "outer", "elements")

HARMONICS = 2
"""Multiples of the passing of elements with orders of their own, of bearings with deviations."""

_PER_WAVE, _PER_SPALL, _FEWEST, _MOST = 32, 64, 1024, 2**17
"""Nodes of a table in its shortest wave and its shortest spall: cubics are right to h^4/384, 4e-6 of a wave, and
their slopes to 6e-5, below what deviations are known to; finer tables leave the cache of a processor. Bounds of all."""


@dataclass(frozen=True)
class Wave:
    """A wave of a ring or of rolling elements, amplitude cos(waves angle + phase), which adds to the approach.

    Attributes
    ----------
    on : {"inner", "outer", "elements"}
        What deviates.
    waves : int
        Waves in a turn, >= 1.
    amplitude : float
        Half of what lies between crest and valley [m].
    phase : float
        [rad].
    element : int or None
        Number of the rolling element, from 1; None for all of them.
    """

    on: On
    waves: int
    amplitude: float
    phase: float = 0.0
    element: int | None = None


@dataclass(frozen=True)
class Spall:
    """A hole of a raceway or of a rolling element, a full cosine wave deep, by which contacts are further apart.

    Attributes
    ----------
    on : {"inner", "outer", "elements"}
        What deviates.
    angle : float
        Place of its middle on the ring or element [rad].
    length : float
        Length along the raceway [m].
    depth : float
        Depth in the middle [m]; elements sink no deeper than to where they touch both edges, length^2/(4 Dw).
    element : int or None
        The same as of a `Wave`.
    """

    on: On
    angle: float
    length: float
    depth: float
    element: int | None = None


@dataclass(frozen=True)
class Deviations:
    """Deviations of a bearing from its form.

    Attributes
    ----------
    waves : tuple of Wave
        Waves of rings and elements.
    spalls : tuple of Spall
        Holes of rings and elements.
    sizes : tuple of float
        How much the diameter of each rolling element is larger, in turn [m]; those left out are as the geometry says.
    """

    waves: tuple[Wave, ...] = ()
    spalls: tuple[Spall, ...] = ()
    sizes: tuple[float, ...] = ()


class Pitched(Rolling, Protocol):
    """Geometry of a bearing of any kind, with its pitch diameter."""

    @property
    def pitch_diameter(self) -> float:
        """Pitch diameter [m]."""
        ...


class Turns(NamedTuple):
    """Angles of the parts of a bearing by that of the system, in pure rolling.

    Attributes
    ----------
    cage, inner, outer : float
        Those of cage and rings.
    element : float
        That of a rolling element about its axis, against the cage; positive where the inner ring drives.
    """

    cage: float
    inner: float
    outer: float
    element: float

    @classmethod
    def of(cls, geometry: Rolling, inner: float, outer: float) -> Turns:
        """Turns by those of the rings.

        Parameters
        ----------
        geometry : Rolling
            Geometry of the bearing.
        inner, outer : float
            Turns of the rings.

        Examples
        --------
        >>> from ehdmaps.physics.bearing import BearingGeometry
        >>> turns = Turns.of(BearingGeometry.named("NU308"), 1.0, 0.0)
        >>> round(turns.cage, 3), round(turns.element, 3)
        (0.394, 2.251)
        """
        cage = 0.5 * (inner * (1.0 - geometry.gamma) + outer * (1.0 + geometry.gamma))
        return cls(cage, inner, outer, passes_of(geometry, 1, 1.0).element * (inner - outer))


class DeviationData(Record):
    """Deviations of a bearing as C takes them, `ehd_deviations`; zero is a bearing without any."""

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("elements", "nodes", "rings", "owned")),
        ("start", ctypes.c_double),
        ("turns", ctypes.c_double * 4),
        ("tables", integers),
        *((name, numbers) for name in ("places", "sizes", "table", "own", "added", "moment")),
    )
    shapes: ClassVar = {
        "tables": ("elements", 3),
        "places": ("elements",),
        "sizes": ("elements",),
        "table": ("rings", "nodes", 2),
        "own": ("nodes", "owned", 2),
        "added": ("elements", 2, 2),
        "moment": (2,),
    }

    def at(self, angle: float, speed: float) -> FloatArray:
        """Approach [m] and rate [m/s] that they add to the inner and the outer contact of all elements, (Z, 2, 2).

        Parameters
        ----------
        angle, speed : float
            Angle [rad] and speed [rad/s] of the system.
        """
        _at()(self.address, angle, speed)
        added: FloatArray = self.given("added")
        return added.copy()

    def named_orders(self) -> dict[str, float]:
        """Orders at which the bearing excites, by their names: FTF, BSF, k BPFO, k BPFI, and a turn beside."""
        cage, element = self.turns[0], self.turns[3]
        places = self.given("places") / self.nodes * 2.0 * math.pi
        count = np.unique(np.round(np.exp(1j * places), 9)).size
        found = {"FTF": abs(cage), "2 BSF": 2.0 * abs(element)}
        for name, ring in zip(("BPFI", "BPFO"), self.turns[1:3], strict=True):
            for k in range(1, HARMONICS + 1):
                passing = k * count * abs(cage - ring)
                beside = {f"{k} {name} {way:+d}": passing + way * abs(ring) for way in (-1, 1) if ring}
                found |= {f"{k} {name}": passing, **beside}
        return {name: order for name, order in found.items() if order > 0.0}


@functools.cache
def _at() -> Callable[..., Any]:
    """Function in C that finds what deviations add."""
    checked(DeviationData, "ehd_deviations")
    return function("ehd_deviations_at", ctypes.c_void_p, ctypes.c_double, ctypes.c_double, result=ctypes.c_void_p)


def deviation_data(
    deviations: Deviations, geometry: Pitched, spins: tuple[float, float], start: float, places: FloatArray
) -> DeviationData:
    """Make the tables of a bearing.

    Parameters
    ----------
    deviations : Deviations
        What deviates.
    geometry : Pitched
        Geometry of the bearing.
    spins : (float, float)
        Turns of its rings by that of the system.
    start : float
        Angle of the cage where that of the system is zero [rad].
    places : array (Z,)
        Angles of the elements in the cage [rad].
    """
    elements = np.arange(places.size)
    if any(getattr(geometry, "others", ())):  # balls with four contacts stand there twice
        elements %= places.size // 2
    diameter = geometry.gamma * geometry.pitch_diameter / geometry.lean
    rings = (
        0.5 * geometry.pitch_diameter * (1.0 - geometry.gamma),
        0.5 * geometry.pitch_diameter * (1.0 + geometry.gamma),
    )
    radii = dict(zip(PARTS, (*rings, 0.5 * diameter), strict=True))
    finest: list[float] = [_PER_WAVE * wave.waves for wave in deviations.waves]
    finest += [_PER_SPALL * 2.0 * math.pi * radii[spall.on] / spall.length for spall in deviations.spalls]
    nodes = 2 ** math.ceil(math.log2(min(max(_FEWEST, *finest, 0.0), _MOST)))
    angle = 2.0 * math.pi * np.arange(nodes) / nodes
    rows: tuple[list[FloatArray], list[FloatArray]] = [], []
    tables = np.full((places.size, 3), -1, dtype=np.int64)
    for column, part in enumerate(PARTS):
        for number in range(int(elements.max()) + 1) if part == "elements" else (0,):
            found = np.zeros((nodes, 2))
            for wave in deviations.waves:
                if wave.on == part and wave.element in (None, number + 1):
                    turn = wave.waves * angle + wave.phase
                    found[:, 0] += wave.amplitude * np.cos(turn)
                    found[:, 1] -= wave.amplitude * wave.waves * np.sin(turn)
            for spall in deviations.spalls:
                if spall.on == part and spall.element in (None, number + 1):
                    found += _hole(spall, radii[part], diameter, angle)
            if not np.any(found):
                continue
            own = part == "elements"
            tables[elements == number if own else slice(None), column] = len(rows[own])
            rows[own].append(found * [1.0, 2.0 * math.pi / nodes])
    sizes = np.zeros(int(elements.max()) + 1)
    sizes[: len(deviations.sizes)] = deviations.sizes
    return checked(DeviationData, "ehd_deviations")(
        elements=places.size,
        nodes=nodes,
        rings=len(rows[0]),
        owned=len(rows[1]),
        start=start,
        turns=np.array(Turns.of(geometry, *spins)),
        tables=tables,
        places=places * (nodes / (2.0 * math.pi)),
        sizes=0.5 * sizes[elements],
        table=np.array(rows[0]).reshape(-1, nodes, 2),
        own=np.ascontiguousarray(np.moveaxis(np.array(rows[1]).reshape(-1, nodes, 2), 0, 1)),
        added=np.zeros((places.size, 2, 2)),
        moment=np.full(2, math.nan),
    )


def _hole(spall: Spall, radius: float, diameter: float, angle: FloatArray) -> FloatArray:
    """Approach that a spall adds over the angle, and its derivative by it, (angles, 2)."""
    depth, half = min(spall.depth, spall.length**2 / (4.0 * diameter)), 0.5 * spall.length / radius
    away = (angle - spall.angle + math.pi) % (2.0 * math.pi) - math.pi
    inside, turn = np.abs(away) < half, math.pi * away / half
    value, slope = -0.5 * depth * (1.0 + np.cos(turn)), 0.5 * depth * math.pi / half * np.sin(turn)
    return np.where(inside[:, None], np.stack([value, slope], axis=1), 0.0)


def spectrum(
    on: On, waves: tuple[int, int], amplitude: float, decay: float, seed: int, elements: Sequence[int | None]
) -> tuple[Wave, ...]:
    """Waves with phases by chance, each lower than that of fewer waves: amplitude (first/waves)^decay.

    Decay 1 has the same velocity in each wave, as raceways are measured.

    Parameters
    ----------
    on : {"inner", "outer", "elements"}
        What deviates.
    waves : (int, int)
        Fewest and most waves in a turn.
    amplitude : float
        Amplitude of the fewest [m].
    decay : float
        Exponent, >= 0.
    seed : int
        Start of the random numbers, >= 0.
    elements : sequence of int or None
        Rolling elements with phases of their own, from 1; None alone for a ring.
    """
    chance = np.random.default_rng([seed, PARTS.index(on)])
    return tuple(
        Wave(on, n, amplitude * (waves[0] / n) ** decay, float(chance.uniform(0.0, 2.0 * math.pi)), element)
        for element in elements
        for n in range(waves[0], waves[1] + 1)
    )


def gathered(given: Sequence[DeviationData | None]) -> tuple[Any, int | None]:
    """Deviations of the bearings of a block: what is to be kept, and the address of an array; None where none has any.

    Parameters
    ----------
    given : sequence of DeviationData or None
        Those of each bearing.
    """
    if all(one is None for one in given):
        return None, None
    whole = [one or checked(DeviationData, "ehd_deviations")() for one in given]
    array = (DeviationData * len(whole))(*whole)
    return (whole, array), ctypes.addressof(array)
