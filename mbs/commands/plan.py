"""`mbs plan`: which operating ranges a scene needs of a contact map, and the job that covers just these."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ehdmaps.errors import EhdmapsError, InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.commands.check import estimated_time
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.law_check import check_points
from ehdmaps.jobs.reader import read_job, shipped_jobs
from ehdmaps.jobs.refinement import refinement
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.outputs import SEALED, Output, output_problems, sealed, write_text
from ehdmaps.units import LOAD, RPM, SPEED, TEMPERATURE, Display
from mbs.analyses import planning
from mbs.analyses.coverage import AxisCover, Coverage, coverage
from mbs.analyses.plan import PlanResult, PlanSettings, dry_model, law_problems, needed_of
from mbs.analyses.planning import Needed
from mbs.commands.cases import read_clearance, scene_output_problems
from mbs.commands.common import heading
from mbs.scene.assembly import Model
from mbs.scene.fields import MICROMETRE
from mbs.scene.reader import read_scene
from mbs.scene.scene import Scene

_UNSAFE = re.compile(r"[^A-Za-z0-9_-]+")


@dataclass(frozen=True)
class _Planned:
    """A job that covers what one geometry needs."""

    needed: Needed
    job: Job
    path: Path | None


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Tell the ranges; then write the job, or say whether a map covers them."""
    model, scene, emap, settings = _read(arguments)
    found = needed_of(scene, model, settings, emap)
    slowest, fastest = found.speeds
    lines = [
        *heading(found.model),
        f"  turns at {RPM.text(slowest)} to {RPM.text(fastest)}; loads of slices at rest, "
        f"dry, over {planning.ANGLES} cage angles of a pitch, times {settings.margin:g} for what moves",
    ]
    if emap is not None:
        if scene.lubricant is not None and scene.lubricant != emap.lubricant:
            lines.append(
                f"  the oil of the map counts ({emap.lubricant.title}); that of the scene is another "
                f"({scene.lubricant.title})"
            )
        return _covered(lines, coverage(found.needed, emap), arguments.map)
    planned = _plan(found, arguments)
    for entry in planned:
        lines += _described(entry)
    lines += [_written(entry.job, entry.path) for entry in planned if entry.path is not None]
    return "\n".join(lines if arguments.output else [*lines, "nothing written; -o JOB.toml writes the job"]), 0


def _read(arguments: argparse.Namespace) -> tuple[Model, Scene, EHDMap | None, PlanSettings]:
    """Read scene, map, clearance and margin, and put the scene together; all problems at once."""
    problems: list[str] = []
    scene: Scene | None = None
    model: Model | None = None
    emap: EHDMap | None = None
    try:
        scene = read_scene(arguments.scene)
    except InputError as error:
        problems += error.problems
    if arguments.map is not None:
        try:
            emap = open_map(arguments.map)
        except EhdmapsError as error:
            problems += [f"--map: {line}" for line in str(error).splitlines()]
    clearance = read_clearance(arguments.clearance, problems) if arguments.clearance is not None else None
    margin = _margin(arguments.margin, problems)
    settings = PlanSettings(arguments.law, clearance, margin)
    problems += law_problems(settings.law)
    read = [arguments.map] if arguments.map is not None else []
    problems += scene_output_problems(
        arguments.scene, [*read, *(scene.files if scene else ())], arguments.output, kind=SEALED
    )
    if arguments.output is not None and arguments.map is not None:
        problems.append(
            "--map: stands beside -o; allowed: a map to be looked at, or a job to be written; leave one out"
        )
    if scene is not None:
        try:
            model = dry_model(scene, settings, emap, mapped=arguments.map is not None)
        except InputError as error:
            problems += error.problems
    if problems or scene is None or model is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    return model, scene, emap, settings


def _margin(text: str | None, problems: list[str]) -> float:
    """Read --margin."""
    if text is None:
        return planning.MARGIN
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 1.0 <= value <= planning.MOST_MARGIN:
        problems.append(f"--margin: got {text!r:.40}; allowed: a number from 1 to {planning.MOST_MARGIN:g}")
    return value


def _plan(found: PlanResult, arguments: argparse.Namespace) -> list[_Planned]:
    """The job of each geometry with its path; all problems at once."""
    paths = [_path(arguments.output, entry, alone=len(found.needed) == 1) for entry in found.needed]
    # One name was looked at by `_read`; several only now that they are known.
    problems = output_problems([Output("-o", path, SEALED) for path in paths], [arguments.scene, *found.scene.files])
    jobs: tuple[Job, ...] = ()
    try:
        jobs = found.jobs([path.stem if path else "plan" for path in paths])
    except InputError as error:
        problems += error.problems
    if problems:
        raise InputError(tuple(dict.fromkeys(problems)))
    return [_Planned(*entry) for entry in zip(found.needed, jobs, paths, strict=True)]


def _path(output: str | None, needed: Needed, alone: bool) -> Path | None:
    """Where the job of a geometry goes: with several, the name of its first bearing is appended."""
    if output is None:
        return None
    path = Path(output)
    return path if alone else path.with_stem(f"{path.stem}_{_UNSAFE.sub('_', needed.bearings[0])}")


def _described(planned: _Planned) -> list[str]:
    """Lines of one job: what is needed beside its axes, and what it costs."""
    needed, job = planned.needed, planned.job
    mapped = {
        "load": _span((job.loads[0], job.loads[-1]), LOAD),
        "entrainment speed": _span((job.entrainment_speeds[0], job.entrainment_speeds[-1]), SPEED),
        "temperature": TEMPERATURE.text(job.temperatures[0]),
    }
    counts = (len(job.loads), len(job.entrainment_speeds), len(job.temperatures))
    lines = [*_head(needed), f"  {'':18s} {'needed':28s} {'in the job':28s} points"]
    for (axis, text), (name, ends), count in zip(_ranges(needed), mapped.items(), counts, strict=True):
        assert axis == name
        lines.append(f"  {axis:18s} {text:28s} {ends:28s} {count:6d}")
    points = _points(job)
    lines.append(f"  points             {points}, {points - job.points} of them for the contact laws")
    solver = solvers.build(job.solver, job.solver_options)
    lines.append(f"  time               {estimated_time(job, solver, points)}")
    shipped = (job.bearing.name if job.bearing else job.title).lower()
    if shipped in shipped_jobs():
        whole = _points(read_job(shipped))
        lines.append(f"  the shipped job {shipped} has {whole} points, {whole / points:.3g} times as many")
    return lines


def _head(needed: Needed) -> list[str]:
    """Lines on the bearings, and on where their loads come from."""
    return [
        f"{needed.geometry.title}: {', '.join(needed.bearings)}",
        f"  largest load of a slice at rest {LOAD.text(needed.static_load)}; films take up to "
        f"{MICROMETRE.text(needed.film_room)} of the clearance",
    ]


def _ranges(needed: Needed) -> list[tuple[str, str]]:
    """Axes and what is needed of them, in words."""
    return [
        ("load", _span(needed.load, LOAD)),
        ("entrainment speed", _span(needed.entrainment_speed, SPEED)),
        ("temperature", TEMPERATURE.text(needed.temperature)),
    ]


def _span(ends: tuple[float, float], display: Display) -> str:
    """A range in words."""
    return f"{display.value(ends[0]):.4g} to {display.text(ends[1])}"


def _points(job: Job) -> int:
    """Points that a job solves in all."""
    refined = refinement(job, solvers.build(job.solver, job.solver_options))
    return job.points + (refined.points if refined else 0) + check_points(job.law_check)


def _written(job: Job, path: Path) -> str:
    """Write a job."""
    write_text(path, sealed(job.text), SEALED)
    return f"{path}: written; `ehdmaps generate {path}` makes the map"


def _covered(lines: list[str], covers: Sequence[Coverage], name: str) -> tuple[str, int]:
    """Say of each axis whether a map covers what is needed."""
    for cover in covers:
        lines += [*_head(cover.needed), f"  {'':18s} {'needed':28s} {'mapped':28s}"]
        for (axis, text), mapped, display in zip(
            _ranges(cover.needed), cover.axes, (LOAD, SPEED, TEMPERATURE), strict=True
        ):
            lines.append(f"  {axis:18s} {text:28s} {_span(mapped.mapped, display):28s} {_verdict(axis, mapped)}")
    whole = all(cover.whole for cover in covers)
    word = "covers the scene" if whole else "does not cover the scene; plan a map for it with -o JOB.toml"
    return "\n".join([*lines, f"{name}: {word}"]), 0 if whole else 1


def _verdict(axis: str, mapped: AxisCover) -> str:
    """Whether an axis is covered."""
    sides = [word for word, short in (("below", mapped.below), ("above", mapped.above)) if short]
    fades = ", where the film fades" if mapped.below and axis != "temperature" else ""
    return f"short {' and '.join(sides)}{fades}" if sides else "ok"
