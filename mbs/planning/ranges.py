"""Operating ranges that a system needs of a contact map: only what occurs in it, with a stated margin.

The speeds follow from the spins. The loads are those of dry contacts in equilibrium, over the angles of one pitch of
the rollers, the extremes of loads that vary and a turn of unbalances and excitations as a stiff rotor bears them,
times a margin for what moves; the films themselves take up clearance,
which a second set of equilibria shows. Below its lowest load and speed a law goes on by itself: the film fades.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from itertools import pairwise
from typing import Any

import numpy as np

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.units import LOAD, Display
from mbs.bearings.bearing_element import BearingElement
from mbs.linearised.averaged import pitch
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Constant, Course, Harmonic, LoadProfile
from mbs.model.system import System
from mbs.planning.criteria import closed_contact
from mbs.scene.assembly import AnyBearing
from mbs.scene.fields import FORCE

ANGLES = 12
"""Angles within one pitch of the rollers."""

PHASES = 8
"""Angles within the slowest turn of unbalances and excitations: the largest of a sine is at most 8 % above these."""

MARGIN = 3.0
"""Highest load of a map over the largest load at rest: room for what moves."""

MOST_MARGIN = 1000.0

SLOWEST = 1.0 / 20.0
"""Lowest mapped speed over the highest one, where a system starts from rest; the film fades below it."""

LIGHTEST = 1.0 / 1000.0
"""Lowest mapped load over the highest one."""

LIGHT = 1e3
"""The lowest mapped load is not above this [N/m]: lightly loaded films carry the damping of unloaded rollers."""

DIGITS = 2
"""Of the ends of an axis."""


@dataclass(frozen=True)
class Needed:
    """Operating ranges of the bearings of one geometry.

    Attributes
    ----------
    geometry : BearingGeometry, BallGeometry or TaperedGeometry
        One of theirs.
    bearings : tuple of str
        Their names.
    load : (float, float)
        Lowest and highest load per unit length [N/m], or load of a ball [N].
    entrainment_speed : (float, float)
        Lowest and highest [m/s].
    temperature : float
        Temperature of the raceways [K].
    static_load : float
        Largest load at rest of a slice, centrifugal load included, or of a ball, in the unit of `load`.
    film_room : float
        How much diametral clearance the films take up at the highest speed [m]; 0 where no map is made.
    of_points : bool
        Whether its contacts are points, else lines.
    """

    geometry: Any
    bearings: tuple[str, ...]
    load: tuple[float, float]
    entrainment_speed: tuple[float, float]
    temperature: float
    static_load: float
    film_room: float
    of_points: bool = False

    @property
    def mapped(self) -> bool:
        """True where its bearings have a map, as cylindrical rollers do."""
        return isinstance(self.geometry, BearingGeometry)

    @property
    def display(self) -> Display:
        """Unit in which its loads are told."""
        return FORCE if self.of_points else LOAD


def same_contacts(geometry: BearingGeometry) -> tuple[float, ...]:
    """Dimensions on which the contacts of a bearing depend: raceways and rollers [m], rounded to a nanometre.

    Bearings that agree in it share a map, whatever their clearance and number of rollers.
    """
    names = ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "roller_length")
    return tuple(round(getattr(geometry, name), 9) for name in names)


def speed_range(steady: Iterable[float], ramp: Sequence[float] = ()) -> tuple[float, float]:
    """Lowest speed above rest and highest speed that occur, without sign.

    Parameters
    ----------
    steady : iterable of float
        Speeds that are held [rad/s].
    ramp : sequence of float
        Corners of a course that the speed follows [rad/s]. One that passes rest gives `SLOWEST` times the highest
        speed as the lowest one.

    Raises
    ------
    AnalysisError
        If everything stands still: no film, and no map, is needed then.

    Examples
    --------
    >>> speed_range([50.0, 0.0], [0.0, 200.0])
    (10.0, 200.0)
    >>> speed_range([50.0], [50.0, 200.0])
    (50.0, 200.0)
    """
    corners = list(ramp)
    sizes = [abs(speed) for speed in (*steady, *corners) if speed != 0.0]
    if not sizes:
        raise AnalysisError(
            "plan: nothing turns at any speed of the scene, so that it needs no map; analyse it with --law hertz, or "
            "give it a speed in [operation], [sweep] or [runup]"
        )
    low, high = min(sizes), max(sizes)
    passes_rest = any(a * b <= 0.0 for a, b in pairwise(corners))
    return (min(low, SLOWEST * high) if passes_rest else low), high


def largest_loads(
    system: System, bearings: Sequence[AnyBearing], speed: float, turning: bool = True
) -> tuple[float, ...]:
    """Largest load of a contact of each bearing at rest: of a slice [N/m], or of a ball [N].

    Parameters
    ----------
    system : System
        System with dry contact laws.
    bearings : sequence of BearingElement
        Those of the system.
    speed : float
        Speed of the system [rad/s].
    turning : bool
        Whether unbalances and excitations count.

    Raises
    ------
    AnalysisError
        If there is no equilibrium.

    Notes
    -----
    Over `ANGLES` cage angles of one pitch (that of the slowest cage), at time zero and where a load that varies has
    an extreme. Two loads that vary, each between its own extremes, may together have a larger one.

    Unbalances and excitations stand still at `PHASES` angles of their slowest turn, with their size at this speed, m r
    w^2 of an unbalance: what the bearings of a stiff rotor carry. Well below the first critical speed a rotor bends
    little, and this holds; from half of it on the rotor adds more than a third, and near it any multiple.
    """
    pitches = [angle for bearing in bearings if (angle := pitch(bearing)) > 0.0]
    places = [(entry, system.relative(entry.inner, entry.outer)) for entry in bearings]
    largest = np.zeros(len(places))
    profiles = [profile for _, profile in system.varying_loads]
    times = sorted({0.0, *(time for profile in profiles for time in _extremes(profile))})
    for turned, time in itertools.product(_turned(system, speed) if turning else (system,), times):
        start = None
        for part in range(ANGLES if pitches else 1):
            operation = Operation(speed, max(pitches, default=0.0) * part / ANGLES, time)
            start = equilibrium(turned, operation, start).displacement
            loads = [entry.largest_load(place @ start, operation) for entry, place in places]
            largest = np.maximum(largest, loads)
    return tuple(largest.tolist())


def _turned(system: System, speed: float) -> Iterator[System]:
    """The system as it is; and where loads turn, with these held at some angles of their slowest turn."""
    yield system
    if system.turning:
        turn = 2.0 * math.pi / min(abs(load.order) for load in system.turning)
        for part in range(PHASES):
            yield system.with_load(system.turning_loads(speed, turn * part / PHASES, 0.0), Constant())


def film_room(
    geometry: BearingGeometry, lubricant: Lubricant, load: float, entrainment_speed: float, temperature: float
) -> float:
    """Diametral clearance that the films of both contacts take up [m]: twice the sum of their central films.

    Parameters
    ----------
    geometry : BearingGeometry
        Geometry of the bearing, which is of steel.
    lubricant : Lubricant
        The oil.
    load : float
        Load per unit length [N/m], > 0.
    entrainment_speed : float
        [m/s], > 0.
    temperature : float
        [K].

    References
    ----------
    Films as of `ehdmaps.physics.films.moes_central`.
    """
    contacts, at = geometry.contacts(STEEL, "iso16281"), np.array([load])
    return 2.0 * sum(
        float(closed_contact(one, lubricant, at, entrainment_speed, temperature).film[0]) for one in contacts
    )


def needed_ranges(
    bearings: Sequence[AnyBearing],
    static_loads: Sequence[float],
    rooms: Sequence[float],
    speeds: tuple[float, float],
    margin: float = MARGIN,
    temperature: float = math.nan,
) -> tuple[Needed, ...]:
    """Ranges that each geometry needs, in the order of the bearings.

    Parameters
    ----------
    bearings : sequence of BearingElement or LocatingElement
        Those of the system that have maps, or those that have none.
    static_loads : sequence of float
        Largest load of each bearing, from `largest_loads` and the centrifugal load [N/m], or [N] of balls.
    rooms : sequence of float
        Room of the films of each bearing, from `film_room` [m].
    speeds : (float, float)
        Lowest and highest speed of the system [rad/s].
    margin : float
        Highest load over the static one, 1 to `MOST_MARGIN`.
    temperature : float
        Temperature of the raceways of bearings that have no maps [K].

    Raises
    ------
    AnalysisError
        If all bearings of a geometry are unloaded or stand still.
    InputError
        For a margin out of range.
    """
    if not 1.0 <= margin <= MOST_MARGIN:
        raise InputError(f"plan, margin: got {margin!r}; allowed: 1 to {MOST_MARGIN:g}")
    groups: dict[object, list[tuple[Any, float, float]]] = {}
    one: Any
    for one, load, room in zip(bearings, static_loads, rooms, strict=True):
        mapped = isinstance(one, BearingElement)
        key = same_contacts(one.bearing.geometry) if mapped else one.force.same_films
        groups.setdefault(key, []).append((one, load, room))
    found = []
    for members in groups.values():
        every, loads, taken = zip(*members, strict=True)
        one, load, names = every[0], max(loads), tuple(bearing.name for bearing in every)
        rates = [bearing.entrainment_rate for bearing in every if bearing.entrainment_rate > 0.0]
        if not (load > 0.0 and rates):
            raise AnalysisError(
                f"plan: the rollers of {', '.join(names)} {'carry no load' if rates else 'do not roll'} in any "
                "equilibrium of the scene, so that no range can be told; give the scene loads, spins, or a smaller "
                "clearance"
            )
        mapped, of_points = isinstance(one, BearingElement), getattr(one.force, "of_points", False)
        highest = margin * load
        found.append(
            Needed(
                geometry=one.bearing.geometry if mapped else one.force.geometry,
                bearings=names,
                load=(LIGHTEST * highest if of_points else min(LIGHTEST * highest, LIGHT), highest),
                entrainment_speed=(min(rates) * speeds[0], max(rates) * speeds[1]),
                temperature=one.temperature if mapped else temperature,
                static_load=load,
                film_room=max(taken),
                of_points=of_points,
            )
        )
    return tuple(found)


def outward(low: float, high: float) -> tuple[float, float]:
    """Ends of a range of positive numbers to two digits, never inward.

    Examples
    --------
    >>> outward(0.8247, 4.123)
    (0.82, 4.2)
    """
    down, up = (Context(prec=DIGITS, rounding=rule) for rule in (ROUND_FLOOR, ROUND_CEILING))
    return float(down.create_decimal_from_float(low)), float(up.create_decimal_from_float(high))


def _extremes(profile: LoadProfile) -> tuple[float, ...]:
    """Times at which a load has its extremes [s]; none where they are not known."""
    if isinstance(profile, Course):
        return tuple(profile.times[int(at(profile.values))] for at in (np.argmax, np.argmin))
    if isinstance(profile, Harmonic) and profile.frequency > 0.0:
        first = (0.25 - profile.phase / (2.0 * math.pi)) % 1.0
        return first / profile.frequency, ((first + 0.5) % 1.0) / profile.frequency
    return ()
