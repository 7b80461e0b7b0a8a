"""Operating ranges that a scene needs of a contact map, with a stated margin, and the jobs that cover just these.

The speeds follow from the spins. The loads are those of dry contacts in equilibrium, over the angles of one pitch of
the rollers, the extremes of loads that vary and a turn of unbalances and excitations as a stiff rotor bears them,
times a margin for what moves; the films themselves take up clearance, which a second set of equilibria shows. Below
its lowest load and speed a law goes on by itself: the film fades.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from itertools import pairwise
from typing import Any

import numpy as np

from ehdmaps.errors import AnalysisError, InputError, Problems
from ehdmaps.jobs.job import Job, check_oil
from ehdmaps.jobs.job_text import bearing_keys, lubricant_keys, table_lines
from ehdmaps.jobs.problem import LOAD_AXIS, SPEED_AXIS, AxisRule
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.units import LOAD, RPM, SPEED, TEMPERATURE, Display, quantity
from mbs.analyses.operating import held
from mbs.linearised.averaged import pitch
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Constant, Course, Harmonic, LoadProfile
from mbs.model.system import System
from mbs.planning.criteria import closed_contact
from mbs.scene.assembly import AnyBearing, Model, assemble
from mbs.scene.fields import FORCE
from mbs.scene.scene import Scene

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
    mapped : bool
        Whether its bearings have a map, as cylindrical rollers do.
    """

    geometry: Any
    bearings: tuple[str, ...]
    load: tuple[float, float]
    entrainment_speed: tuple[float, float]
    temperature: float
    static_load: float
    film_room: float
    of_points: bool = False
    mapped: bool = True

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
        mapped = not one.locating
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
        mapped, of_points = not one.locating, getattr(one.force, "of_points", False)
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
                mapped=mapped,
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


LOADS_PER_DECADE, SPEEDS_PER_DECADE = 6, 5
"""As close as in the shipped jobs; contact laws choose lines of their own besides."""

FEWEST = 4
LAW_CHECK = 500

_SPEEDS = 5


def planned_job(scene: Scene, needed: Needed, name: str = "plan") -> Job:
    """The job that covers what the bearings of one geometry need, read back by the reader of jobs.

    Parameters
    ----------
    scene : Scene
        Scene with a lubricant.
    needed : Needed
        The ranges.
    name : str
        Name of the job.

    Raises
    ------
    InputError
        With everything that a job does not allow, or cannot say.
    """
    assert scene.lubricant is not None  # `plan` saw to it
    geometry = next(entry.geometry for entry in scene.bearings if entry.name == needed.bearings[0])
    grid = {
        "load": _axis(needed.load, LOAD, LOAD_AXIS, LOADS_PER_DECADE),
        "entrainment_speed": _axis(needed.entrainment_speed, SPEED, SPEED_AXIS, SPEEDS_PER_DECADE),
        "temperature": [_temperature(scene.temperature)],
    }
    lines = [
        f"# What {_plain(scene.name)} needs of a contact map, for {_plain(', '.join(needed.bearings))}.",
        f"# Largest load of a slice at rest {LOAD.text(needed.static_load)}; the highest load of the map is "
        f"{needed.load[1] / needed.static_load:.3g} times that.",
        "",
        "schema = 1",
        *table_lines("bearing", bearing_keys(geometry)),
        *table_lines("lubricant", lubricant_keys(scene.lubricant)),
        *table_lines("grid", grid),
        *table_lines("solver", {"name": "reynolds", "structural_law": "iso16281", "law_check": LAW_CHECK}),
        "",
    ]
    job = parse_job("\n".join(lines), name, f"the job for {', '.join(needed.bearings)}", to_run=True)
    check_oil(scene.lubricant, job)
    return job


def _temperature(value: float) -> str:
    """A temperature in degC, as people write it, where it reads back as the same value."""
    text = f"{TEMPERATURE.value(value):.10g} {TEMPERATURE.unit}"
    return text if quantity(text, "K") == value else f"{value!r} K"


def _axis(ends: tuple[float, float], display: Display, rule: AxisRule, per_decade: int) -> list[str] | dict[str, Any]:
    """An axis of a job that covers a range."""
    low, high = outward(*(display.value(max(end, rule.low)) for end in ends))
    if low == high:
        return [f"{low:g} {display.unit}"]
    points = max(FEWEST, math.ceil(per_decade * math.log10(high / low)) + 1)
    texts = {"from": f"{low:g} {display.unit}", "to": f"{high:g} {display.unit}"}
    return {**texts, "points": points, "spacing": "log"}


def _plain(text: str) -> str:
    """A text that may stand in a comment."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


@dataclass(frozen=True)
class PlanSettings:
    """Settings by which the ranges are found.

    Attributes
    ----------
    clearance : float or None
        Diametral clearance of all bearings [m]; None for those of the scene.
    margin : float
        Highest load of the map over the largest one at rest, for what moves.
    """

    clearance: float | None = None
    margin: float = MARGIN


@dataclass(frozen=True, eq=False)
class PlanResult:
    """Ranges that a scene needs of a contact map.

    Attributes
    ----------
    scene : Scene
        What was planned for.
    model : Model
        The same with dry contacts, from which loads and speeds follow.
    speeds : (float, float)
        Lowest and highest speed of the system [rad/s].
    needed : tuple of Needed
        Ranges of a map by geometry; none without cylindrical roller bearings.
    seen : tuple of Needed
        Ranges of the other bearings by geometry, of balls, tapered or ribbed rollers.
    """

    scene: Scene
    model: Model
    speeds: tuple[float, float]
    needed: tuple[Needed, ...]
    seen: tuple[Needed, ...]

    def jobs(self, names: Sequence[str] = ()) -> tuple[Job, ...]:
        """Jobs that cover the ranges, one a geometry, read back by the reader of jobs.

        Parameters
        ----------
        names : sequence of str
            One a geometry; "plan" if left out.

        Raises
        ------
        InputError
            With everything that a job does not allow.
        """
        problems, jobs = Problems(), []
        for entry, name in zip(self.needed, names or ["plan"] * len(self.needed), strict=True):
            with problems:
                jobs.append(planned_job(self.scene, entry, name))
        problems.check()
        return tuple(jobs)


def held_films(seen: Needed, model: Model, speeds: tuple[float, float]) -> tuple[tuple[float, float], str]:
    """Loads that the film table has over the speeds of a scene, of bearings of which no map is made.

    Parameters
    ----------
    seen : Needed
        The bearings.
    model : Model
        The scene with films of the table.
    speeds : (float, float)
        Lowest and highest speed of the system [rad/s].

    Returns
    -------
    (float, float)
        Loads at all speeds that have films, in the unit of `Needed.load`; NaN where there are none.
    str
        Speed at which there are no films, and why; empty where there are films at all speeds.
    """
    element = next(entry for entry in model.located if entry.name == seen.bearings[0])
    length = 1.0 if seen.of_points else seen.geometry.roller_length
    loads, missing = [], ""
    for speed in np.unique(np.geomspace(*speeds, _SPEEDS)).tolist():
        try:
            loads.append(np.array(element.law_at(speed).loads) / length)
        except AnalysisError as error:
            rate = SPEED.text(element.entrainment_rate * speed)
            missing = missing or f"none at {RPM.text(speed)}, {rate}: {str(error.__cause__).partition('; ')[0]}"
    if not loads:
        return (math.nan, math.nan), missing
    ends = np.array(loads)
    return (float(ends[:, 0].max()), float(ends[:, 1].min())), missing


def plan(scene: Scene, settings: PlanSettings | None = None) -> PlanResult:
    """Find the operating ranges that a scene needs of a contact map.

    Parameters
    ----------
    scene : Scene
        Scene with bearings and a lubricant.
    settings : PlanSettings, optional
        How the ranges are found.

    Raises
    ------
    InputError
        With everything because of which no map can be planned.
    AnalysisError
        If a bearing carries no load or does not roll, or there is no equilibrium.

    Examples
    --------
    >>> from mbs import plan, read_scene
    >>> found = plan(read_scene("nu308_rigid"))
    >>> [job.bearing.name for job in found.jobs()]
    ['NU308']
    """
    settings = settings or PlanSettings()
    model, oil = _dry_model(scene, settings), scene.lubricant
    assert oil is not None  # `_dry_model` saw to it
    steady = (scene.speed, *(scene.sweep.speeds.tolist() if scene.sweep else ()))
    speeds = speed_range(steady, scene.run_up.speed.course.values if scene.run_up else ())
    fastest = [entry.rates[1] * speeds[1] for entry in model.bearings]
    if max(fastest, default=0.0) > SPEED_AXIS.high:
        raise InputError(
            f"{scene.name}: its highest speed {RPM.text(speeds[1])} is an entrainment speed of "
            f"{SPEED.text(max(fastest))}; allowed: up to {SPEED.text(SPEED_AXIS.high)}, the limit of a map; check units"
        )
    mounted = held(model)
    # Loads that turn would thin the films, whose room is largest where the rotor has no unbalance. An unloaded bearing
    # has films, too: those of a light load.
    at_rest = largest_loads(mounted.system, mounted.on_rings, speeds[1], turning=False)
    turns = bool(mounted.system.turning)
    loads = np.array(largest_loads(mounted.system, mounted.on_rings, speeds[1]) if turns else at_rest)
    rooms = tuple(
        film_room(entry.bearing.geometry, oil, max(load, LIGHT), speed, scene.temperature) if speed > 0.0 else 0.0
        for entry, load, speed in zip(model.bearings, at_rest, fastest, strict=False)
    )
    if rooms:  # in clearances that the films have taken up
        filled = held(assemble(_dry_scene(model.scene, rooms), "hertz"))
        loads = np.maximum(loads, largest_loads(filled.system, filled.on_rings, speeds[1]))
    for index, (entry, given) in enumerate(zip(model.bearings, scene.bearings, strict=True)):
        thrown = entry.bearing.centrifugal_load(entry.inner_spin, entry.outer_spin) * speeds[1] ** 2
        loads[index] += thrown if given.centrifugal else 0.0
    # of bearings without maps nothing is taken up
    rooms += (0.0,) * len(model.located)
    found = needed_ranges(model.on_rings, loads.tolist(), rooms, speeds, settings.margin, scene.temperature)
    needed, seen = ([one for one in found if one.mapped is mapped] for mapped in (True, False))
    return PlanResult(scene, model, speeds, tuple(needed), tuple(seen))


def _dry_model(scene: Scene, settings: PlanSettings) -> Model:
    """The scene with dry contacts, from which loads and speeds follow; all problems at once."""
    problems = Problems()
    model = None
    with problems:
        model = assemble(_dry_scene(scene), "hertz", clearance=settings.clearance)
    if not scene.has_bearings:
        problems.append("got no bearing; allowed: at least one [[bearings]], which is what a map is for")
    if warm := [entry.name for entry in scene.bearings if entry.thermal is not None]:
        problems.append(
            f"got thermal in {', '.join(warm)}; allowed: one temperature for all, that of [operation]; leave thermal "
            "out of a copy of the scene, or take a map over many temperatures, such as that of the shipped job nu308"
        )
    if scene.lubricant is None:
        why = "a map is made for" if scene.bearings else "films need"
        problems.append(f'got no [lubricant], which {why}; add the table to the scene, such as name = "FVA3"')
    named = [problem if problem.startswith("--") else f"{scene.name}: {problem}" for problem in problems]
    if named or model is None:
        raise InputError(named)
    return model


def _dry_scene(scene: Scene, rooms: tuple[float, ...] = ()) -> Scene:
    """The scene for dry contacts: massless rollers, no centrifugal load; rooms are taken from the clearances [m]."""
    bearings = tuple(
        dataclasses.replace(
            entry,
            rollers_as_bodies=False,
            centrifugal=False,
            geometry=dataclasses.replace(entry.geometry, diametral_clearance=entry.geometry.diametral_clearance - room),
        )
        for entry, room in zip(scene.bearings, rooms or (0.0,) * len(scene.bearings), strict=True)
    )
    return scene.with_bearings(bearings)
