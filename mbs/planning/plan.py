"""Operating ranges that a scene needs of a contact map, and the jobs that cover just these."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.errors import AnalysisError, InputError, Problems
from ehdmaps.jobs.job import Job, check_oil
from ehdmaps.jobs.job_text import bearing_keys, lubricant_keys, table_lines
from ehdmaps.jobs.problem import LOAD_AXIS, SPEED_AXIS, AxisRule
from ehdmaps.jobs.reader import parse_job
from ehdmaps.units import LOAD, RPM, SPEED, TEMPERATURE, Display, quantity
from mbs.analyses.operating import held
from mbs.planning import ranges
from mbs.planning.ranges import Needed
from mbs.scene.assembly import Model, assemble
from mbs.scene.scene import Scene

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
    lines = [
        f"# What {_plain(scene.name)} needs of a contact map, for {_plain(', '.join(needed.bearings))}.",
        f"# Largest load of a slice at rest {LOAD.text(needed.static_load)}; the highest load of the map is "
        f"{needed.load[1] / needed.static_load:.3g} times that.",
        "",
        "schema = 1",
        *table_lines("bearing", bearing_keys(geometry)),
        *table_lines("lubricant", lubricant_keys(scene.lubricant)),
        "",
        "[grid]",
        f"load = {_axis(needed.load, LOAD, LOAD_AXIS, LOADS_PER_DECADE)}",
        f"entrainment_speed = {_axis(needed.entrainment_speed, SPEED, SPEED_AXIS, SPEEDS_PER_DECADE)}",
        f'temperature = ["{_temperature(scene.temperature)}"]',
        "",
        "[solver]",
        'name = "reynolds"',
        'structural_law = "iso16281"',
        f"law_check = {LAW_CHECK}",
        "",
    ]
    job = parse_job("\n".join(lines), name, f"the job for {', '.join(needed.bearings)}", to_run=True)
    check_oil(scene.lubricant, job)
    return job


def _temperature(value: float) -> str:
    """A temperature in degC, as people write it, where it reads back as the same value."""
    text = f"{TEMPERATURE.value(value):.10g} {TEMPERATURE.unit}"
    return text if quantity(text, "K") == value else f"{value!r} K"


def _axis(ends: tuple[float, float], display: Display, rule: AxisRule, per_decade: int) -> str:
    """An axis of a job that covers a range."""
    low, high = ranges.outward(*(display.value(max(end, rule.low)) for end in ends))
    if low == high:
        return f'["{low:g} {display.unit}"]'
    points = max(FEWEST, math.ceil(per_decade * math.log10(high / low)) + 1)
    return f'{{ from = "{low:g} {display.unit}", to = "{high:g} {display.unit}", points = {points}, spacing = "log" }}'


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
    margin: float = ranges.MARGIN


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
    speeds = ranges.speed_range(steady, scene.run_up.speed.course.values if scene.run_up else ())
    fastest = [entry.rates[1] * speeds[1] for entry in model.bearings]
    if max(fastest, default=0.0) > SPEED_AXIS.high:
        raise InputError(
            f"{scene.name}: its highest speed {RPM.text(speeds[1])} is an entrainment speed of "
            f"{SPEED.text(max(fastest))}; allowed: up to {SPEED.text(SPEED_AXIS.high)}, the limit of a map; check units"
        )
    mounted = held(model)
    # Loads that turn would thin the films, whose room is largest where the rotor has no unbalance. An unloaded bearing
    # has films, too: those of a light load.
    at_rest = ranges.largest_loads(mounted.system, mounted.on_rings, speeds[1], turning=False)
    turns = bool(mounted.system.turning)
    loads = np.array(ranges.largest_loads(mounted.system, mounted.on_rings, speeds[1]) if turns else at_rest)
    rooms = tuple(
        ranges.film_room(entry.bearing.geometry, oil, max(load, ranges.LIGHT), speed, scene.temperature)
        if speed > 0.0
        else 0.0
        for entry, load, speed in zip(model.bearings, at_rest, fastest, strict=False)
    )
    if rooms:  # in clearances that the films have taken up
        filled = held(assemble(_dry_scene(model.scene, rooms), "hertz"))
        loads = np.maximum(loads, ranges.largest_loads(filled.system, filled.on_rings, speeds[1]))
    for index, (entry, given) in enumerate(zip(model.bearings, scene.bearings, strict=True)):
        thrown = entry.bearing.centrifugal_load(entry.inner_spin, entry.outer_spin) * speeds[1] ** 2
        loads[index] += thrown if given.centrifugal else 0.0
    # of bearings without maps nothing is taken up
    rooms += (0.0,) * len(model.located)
    found = ranges.needed_ranges(model.on_rings, loads.tolist(), rooms, speeds, settings.margin, scene.temperature)
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
        raise InputError(tuple(dict.fromkeys(named)))
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
