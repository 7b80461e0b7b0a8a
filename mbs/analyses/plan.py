"""Which operating ranges a scene needs of a contact map, and the jobs that cover just these."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

from ehdmaps.errors import InputError
from ehdmaps.jobs.axes import SPEED_AXIS
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import RPM, SPEED
from mbs.analyses import planning
from mbs.analyses.planned_job import job_text
from mbs.analyses.planning import Needed
from mbs.scene.assembly import Model, assemble, constant_name, find_problems
from mbs.scene.scene import Scene


@dataclass(frozen=True)
class PlanSettings:
    """How the ranges are found.

    Attributes
    ----------
    law : str
        hertz or constant:NAME, for the loads at rest.
    clearance : float or None
        Diametral clearance of all bearings [m]; None for those of the scene.
    margin : float
        Highest load of the map over the largest one at rest, for what moves.
    """

    law: str = "hertz"
    clearance: float | None = None
    margin: float = planning.MARGIN


@dataclass(frozen=True, eq=False)
class PlanResult:
    """What a scene needs of a contact map.

    Attributes
    ----------
    scene : Scene
        What was planned for.
    model : Model
        The same with dry contacts, from which loads and speeds follow.
    speeds : (float, float)
        Lowest and highest speed of the system [rad/s].
    needed : tuple of Needed
        Ranges by geometry.
    """

    scene: Scene
    model: Model
    speeds: tuple[float, float]
    needed: tuple[Needed, ...]

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
        problems: list[str] = []
        jobs = []
        for entry, name in zip(self.needed, names or ["plan"] * len(self.needed), strict=True):
            words = f"the job for {', '.join(entry.bearings)}"
            try:
                jobs.append(parse_job(job_text(self.scene, entry), name, words, to_run=True))
            except InputError as error:
                problems += error.problems
        if problems:
            raise InputError(tuple(dict.fromkeys(problems)))
        return tuple(jobs)


def plan(scene: Scene, settings: PlanSettings | None = None, emap: EHDMap | None = None) -> PlanResult:
    """Find the operating ranges that a scene needs of a contact map.

    Parameters
    ----------
    scene : Scene
        Scene with bearings, and with a lubricant unless there is a map.
    settings : PlanSettings, optional
        How the ranges are found.
    emap : EHDMap, optional
        A map that is to be looked at with `mbs.analyses.coverage.coverage`; its oil counts.

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
    problems = plan_problems(scene, settings, emap)
    if problems:
        raise InputError(tuple(dict.fromkeys(problems)))
    oil = scene.lubricant if scene.lubricant is not None or emap is None else emap.lubricant
    assert oil is not None  # `plan_problems` saw to it
    model, speeds, needed = _needed(scene, settings.law, oil, settings.clearance, settings.margin)
    return PlanResult(scene, model, speeds, needed)


def law_problems(law: str) -> list[str]:
    """What is wrong about the law of the loads at rest."""
    if law == "hertz" or constant_name(law) is not None:
        return []
    return [f"--law: got {law!r:.60}; allowed here: hertz, constant:NAME; loads at rest are those of dry contacts"]


def plan_problems(scene: Scene, settings: PlanSettings, emap: EHDMap | None = None, mapped: bool = False) -> list[str]:
    """Everything because of which no map can be planned for a scene.

    Parameters
    ----------
    scene : Scene
        What is planned for.
    settings : PlanSettings
        Law and clearance.
    emap : EHDMap, optional
        A map that is to be looked at.
    mapped : bool
        Whether there is a map that could not be read, so that the scene needs no lubricant.
    """
    plain = _dry_scene(scene)
    dry = settings.law if constant_name(settings.law) is not None else "hertz"
    problems = find_problems(plain, dry, None, settings.clearance)
    if emap is not None:
        problems += find_problems(plain, "map", emap, settings.clearance)
    if not scene.bearings:
        problems.append("got no bearing; allowed: at least one [[bearings]], which is what a map is for")
    if scene.lubricant is None and emap is None and not mapped:
        problems.append(
            'got no [lubricant], which a map is made for; add the table to the scene, such as name = "FVA3"'
        )
    named = [problem if problem.startswith("--") else f"{scene.name}: {problem}" for problem in problems]
    return [*law_problems(settings.law), *named]


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
    return dataclasses.replace(scene, bearings=bearings)


def _needed(
    scene: Scene, law: str, oil: Lubricant, clearance: float | None, margin: float
) -> tuple[Model, tuple[float, float], tuple[Needed, ...]]:
    """Ranges that the scene needs, with the dry model and the speeds of the system [rad/s] from which they follow."""
    steady = (scene.speed, *(scene.sweep.speeds.tolist() if scene.sweep else ()))
    speeds = planning.speed_range(steady, scene.run_up.speed.course.values if scene.run_up else ())
    model = assemble(_dry_scene(scene), law, clearance=clearance)
    fastest = [entry.rates[1] * speeds[1] for entry in model.bearings]
    if max(fastest) > SPEED_AXIS.high:
        raise InputError(
            f"{scene.name}: its highest speed {RPM.text(speeds[1])} is an entrainment speed of "
            f"{SPEED.text(max(fastest))}; allowed: up to {SPEED.text(SPEED_AXIS.high)}, the limit of a map; check units"
        )
    dry = planning.largest_loads(model.system, model.bearings, speeds[1])
    # An unloaded bearing has films, too: those of a light load.
    rooms = tuple(
        planning.film_room(entry.bearing.geometry, oil, max(load, planning.LIGHT), speed, scene.temperature)
        if speed > 0.0
        else 0.0
        for entry, load, speed in zip(model.bearings, dry, fastest, strict=True)
    )
    filled = assemble(_dry_scene(model.scene, rooms), law)
    preloaded = planning.largest_loads(filled.system, filled.bearings, speeds[1])
    centrifugal = [
        entry.bearing.centrifugal_load(entry.inner_spin, entry.outer_spin) * speeds[1] ** 2
        if given.centrifugal
        else 0.0
        for entry, given in zip(model.bearings, scene.bearings, strict=True)
    ]
    static = [max(pair) + more for *pair, more in zip(dry, preloaded, centrifugal, strict=True)]
    return model, speeds, planning.needed_ranges(model.bearings, static, rooms, speeds, margin)
