"""`mbs plan`: which operating ranges a scene needs of its contact maps, and the jobs that cover just these."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ehdmaps.errors import InputError, Problems
from ehdmaps.jobs import solvers
from ehdmaps.jobs.commands.check import cost_of
from ehdmaps.jobs.cost import total
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.generate import planned_tasks
from ehdmaps.outputs import SEALED, Output, output_problems, sealed, write_text
from ehdmaps.units import LOAD, RPM, SPEED, TEMPERATURE, Display
from mbs.commands.cases import read_dry, scene_output_problems
from mbs.output.model_text import heading
from mbs.planning.plan import (
    ANGLES,
    MARGIN,
    MOST_MARGIN,
    PHASES,
    Needed,
    PlanResult,
    PlanSettings,
    held_films,
    plan,
)
from mbs.scene.assembly import assemble
from mbs.scene.fields import MICROMETRE
from mbs.scene.map_set import TABLE_LAW
from mbs.scene.scene import Scene

_NOTHING = ("nothing written; -o JOB.toml writes the job",)
_UNSAFE = re.compile(r"[^A-Za-z0-9_-]+")


@dataclass(frozen=True)
class _Planned:
    """A job that covers what one geometry needs."""

    needed: Needed
    job: Job
    path: Path | None


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Tell the ranges, and write the jobs that cover them."""
    scene, settings = _read(arguments)
    found = plan(scene, settings)
    slowest, fastest = found.speeds
    lines = [
        *heading(found.model),
        f"  turns at {RPM.text(slowest)} to {RPM.text(fastest)}; loads of contacts at rest, "
        f"dry, over {ANGLES} cage angles of a pitch, times {settings.margin:g} for what moves",
        *_turning(found),
    ]
    planned = _plan(found, arguments)
    for entry in planned:
        lines += _described(entry)
    lines += _others(found, settings)
    if not planned:
        return "\n".join([*lines, "nothing to write: there is no map to make"]), 0
    written = [entry.path for entry in planned if entry.path is not None]
    for entry in planned:
        if entry.path is not None:
            write_text(entry.path, sealed(entry.job.text), SEALED)
    return "\n".join([*lines, *(_next_steps(written, arguments.scene) if written else _NOTHING)]), 0


def _turning(found: PlanResult) -> list[str]:
    """A line on the loads that turn, where there are any: how they count."""
    names = ", ".join(name for load in found.model.system.turning for name in load.names)
    if not names:
        return []
    return [
        f"  {names}: with their size at {RPM.text(found.speeds[1])}, standing still at {PHASES} angles, as a "
        "stiff rotor bears them; near and above a critical speed loads are larger: see mbs critical, and --margin"
    ]


def _read(arguments: argparse.Namespace) -> tuple[Scene, PlanSettings]:
    """Read the scene with what is chosen of it, and the margin; all problems at once."""
    problems = Problems()
    margin = _margin(arguments.margin, problems)
    scene, clearance = read_dry(arguments, problems)
    settings = PlanSettings(clearance, margin)
    if arguments.output is not None and scene is not None and not scene.bearings and scene.located:
        problems.append(
            f"-o: got {arguments.output!r:.60} for bearings whose films are read from the film table: there is no map "
            "to make, and no job; leave -o out"
        )
    problems += scene_output_problems(arguments.scene, scene.files if scene else (), arguments.output, kind=SEALED)
    if problems or scene is None:
        raise InputError(problems)
    return scene, settings


def _margin(text: str | None, problems: Problems) -> float:
    """Read --margin."""
    if text is None:
        return MARGIN
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 1.0 <= value <= MOST_MARGIN:
        problems.append(f"--margin: got {text!r:.40}; allowed: a number from 1 to {MOST_MARGIN:g}")
    return value


def _plan(found: PlanResult, arguments: argparse.Namespace) -> list[_Planned]:
    """The job of each geometry with its path; all problems at once."""
    paths = [_path(arguments.output, entry, alone=len(found.needed) == 1) for entry in found.needed]
    # One name was looked at by `_read`; several only now that they are known.
    problems = Problems(
        output_problems([Output("-o", path, SEALED) for path in paths], [arguments.scene, *found.scene.files])
    )
    jobs: tuple[Job, ...] = ()
    with problems:
        jobs = found.jobs([path.stem if path else "plan" for path in paths])
    problems.check()
    return [_Planned(*entry) for entry in zip(found.needed, jobs, paths, strict=True)]


def _path(output: str | None, needed: Needed, alone: bool) -> Path | None:
    """Path to which the job of a geometry goes: with several, the name of its first bearing is appended."""
    if output is None:
        return None
    path = Path(output)
    return path if alone else path.with_stem(f"{path.stem}_{_UNSAFE.sub('_', needed.bearings[0])}")


def _described(planned: _Planned) -> list[str]:
    """Lines of one job: what is needed beside its axes, and what it costs."""
    needed, job = planned.needed, planned.job
    points = sum(task.points for task in planned_tasks(job))
    lines = [
        f"{needed.geometry.title}: {', '.join(needed.bearings)}",
        f"  largest load of a slice at rest {LOAD.text(needed.static_load)}; films take up to "
        f"{MICROMETRE.text(needed.film_room)} of the clearance",
        f"  {'':18s} {'needed':28s} {'in the job':28s} points",
    ]
    for axis, ends, mapped, display in (
        ("load", needed.load, job.loads, LOAD),
        ("entrainment speed", needed.entrainment_speed, job.entrainment_speeds, SPEED),
        ("temperature", (needed.temperature,), job.temperatures, TEMPERATURE),
    ):
        lines.append(f"  {axis:18s} {_span(ends, display):28s} {_span(mapped, display):28s} {len(mapped):6d}")
    if points < job.points:
        told = f"{job.points} read from the film table, {points} solved to check its contact laws"
        return [*lines, f"  points             {told}"]
    return [
        *lines,
        f"  points             {points}, {points - job.points} of them for the contact laws",
        total([cost_of(job, solvers.of_map(job), points)]),
    ]


def _others(found: PlanResult, settings: PlanSettings) -> list[str]:
    """Lines on bearings of which no map is made: what they see, and what the film table has there."""
    if not found.seen:
        return []
    model = assemble(found.scene, TABLE_LAW, clearance=settings.clearance)
    lines = []
    for entry in found.seen:
        body, kind = ("ball", "points") if entry.of_points else ("slice", "lines")
        loads, missing = held_films(entry, model, found.speeds)
        table = "none" if math.isnan(loads[0]) else _span(loads, entry.display)
        lines += [
            f"{entry.geometry.title}: {', '.join(entry.bearings)}",
            f"  largest load of a {body} at rest {entry.display.text(entry.static_load)}",
            f"  {'':18s} {'seen':28s} in the film table of {kind}, which answers: no map",
            f"  {'load':18s} {_span(entry.load, entry.display):28s} {table}",
            f"  {'entrainment speed':18s} {_span(entry.entrainment_speed, SPEED):28s} {missing or 'held'}",
            f"  {'temperature':18s} {TEMPERATURE.text(entry.temperature)}",
        ]
        if missing:
            lines.append("  films              --law table is refused there; dry contacts: --law 'hertz:1.25e-5 s'")
        elif not entry.static_load <= loads[1]:
            lines.append("  films              go on straight in logarithms above these loads, and runs count it")
    return lines


def _span(values: Sequence[float], display: Display) -> str:
    """A range in words."""
    begin = f"{display.value(values[0]):.4g} to " if len(values) > 1 else ""
    return f"{begin}{display.text(values[-1])}"


def _next_steps(written: Sequence[Path], scene: str) -> list[str]:
    """Lines on what was written, and how the maps are made and used."""
    names = " ".join(str(path) for path in written)
    if len(written) == 1:
        return [f"{names}: written; `ehdmaps generate {names}` makes the map"]
    used = " ".join(f"--map {path.stem}.nc" for path in written)
    return [
        *(f"{path}: written" for path in written),
        f"`ehdmaps generate {names}` makes the maps; `mbs statics {scene} {used}` and the other commands take them, "
        "each bearing its own",
    ]
