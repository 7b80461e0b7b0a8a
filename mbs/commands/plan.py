"""`mbs plan`: which operating ranges a scene needs of a contact map, and the job that covers just these."""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import re
import tomllib
from pathlib import Path

import numpy as np

from ehdmaps.errors import EhdmapsError, InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.axes import LOAD_AXIS, SPEED_AXIS, AxisRule
from ehdmaps.jobs.commands.check import estimated_time
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.reader import parse_job, read_job, shipped_jobs
from ehdmaps.jobs.refinement import refinement
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.usable import check_usable
from ehdmaps.outputs import SEALED, Output, output_problems, sealed, write_text
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import LOAD, SPEED, TEMPERATURE, Display
from mbs import planning
from mbs.assembly import Model, assemble, constant_name, find_problems
from mbs.commands.cases import read_clearance, scene_output_problems
from mbs.commands.common import heading
from mbs.planning import Needed
from mbs.reading.fields import MICROMETRE, RPM
from mbs.scene import Scene
from mbs.scene_reader import read_scene

LOADS_PER_DECADE, SPEEDS_PER_DECADE = 6, 5
"""As close as in the shipped jobs; contact laws choose lines of their own besides."""

FEWEST = 4
LAW_CHECK = 500
ROUND_OFF = 1e-9
"""Of units that a map was written with, relative."""

_UNSAFE = re.compile(r"[^A-Za-z0-9_-]+")


@dataclasses.dataclass(frozen=True)
class _Planned:
    """A job that covers what one geometry needs."""

    needed: Needed
    job: Job
    path: Path | None


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Tell the ranges; then write the job, or say whether a map covers them."""
    scene, emap, clearance, margin = _read(arguments)
    oil = scene.lubricant if scene.lubricant is not None or emap is None else emap.lubricant
    assert oil is not None  # `_read` saw to it
    model, speeds, needed = _needed(scene, arguments.law, oil, clearance, margin)
    lines = [
        *heading(model),
        f"  turns at {RPM.text(speeds[0])} to {RPM.text(speeds[1])}; loads of slices at rest, "
        f"dry, over {planning.ANGLES} cage angles of a pitch, times {margin:g} for what moves",
    ]
    if emap is not None:
        if scene.lubricant is not None and scene.lubricant != emap.lubricant:
            lines.append(
                f"  the oil of the map counts ({emap.lubricant.title}); that of the scene is another "
                f"({scene.lubricant.title})"
            )
        return _covered(lines, needed, emap, arguments.map)
    planned = _plan(scene, needed, arguments)
    for entry in planned:
        lines += _described(entry)
    lines += [_written(entry.job, entry.path) for entry in planned if entry.path is not None]
    return "\n".join(lines if arguments.output else [*lines, "nothing written; -o JOB.toml writes the job"]), 0


def _read(arguments: argparse.Namespace) -> tuple[Scene, EHDMap | None, float | None, float]:
    """Read scene, map, clearance and margin; all problems at once."""
    problems: list[str] = []
    scene: Scene | None = None
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
    law = arguments.law
    if law != "hertz" and constant_name(law) is None:
        problems.append(
            f"--law: got {law!r:.60}; allowed here: hertz, constant:NAME; loads at rest are those of dry contacts"
        )
    files = argparse.Namespace(scene=arguments.scene, map=arguments.map, output=arguments.output, plot=None)
    problems += scene_output_problems(files, scene.files if scene else (), SEALED)
    if arguments.output is not None and arguments.map is not None:
        problems.append(
            "--map: stands beside -o; allowed: a map to be looked at, or a job to be written; leave one out"
        )
    if scene is not None:
        problems += _scene_problems(scene, arguments, emap, clearance)
    if problems or scene is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    return scene, emap, clearance, margin


def _scene_problems(
    scene: Scene, arguments: argparse.Namespace, emap: EHDMap | None, clearance: float | None
) -> list[str]:
    """Why no map can be planned for a scene."""
    plain = _dry_scene(scene)
    dry = arguments.law if constant_name(arguments.law) is not None else "hertz"
    problems = find_problems(plain, dry, None, clearance)
    if emap is not None:
        problems += find_problems(plain, "map", emap, clearance)
    if not scene.bearings:
        problems.append("got no bearing; allowed: at least one [[bearings]], which is what a map is for")
    if scene.lubricant is None and arguments.map is None:
        problems.append(
            'got no [lubricant], which a map is made for; add the table to the scene, such as name = "FVA3"'
        )
    return [problem if problem.startswith("--") else f"{scene.name}: {problem}" for problem in problems]


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


def _plan(scene: Scene, needed: tuple[Needed, ...], arguments: argparse.Namespace) -> list[_Planned]:
    """The job of each geometry, read back by the reader of jobs; all problems at once."""
    planned = []
    paths = [_path(arguments.output, entry, alone=len(needed) == 1) for entry in needed]
    # One name was looked at by `_read`; several only now that they are known.
    problems = output_problems([Output("-o", path, SEALED) for path in paths], [arguments.scene, *scene.files])
    for entry, path in zip(needed, paths, strict=True):
        words = f"the job for {', '.join(entry.bearings)}"
        try:
            job = parse_job(job_text(scene, entry), path.stem if path else "plan", words, to_run=True)
            planned.append(_Planned(entry, job, path))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(tuple(dict.fromkeys(problems)))
    return planned


def _path(output: str | None, needed: Needed, alone: bool) -> Path | None:
    """Where the job of a geometry goes: with several, the name of its first bearing is appended."""
    if output is None:
        return None
    path = Path(output)
    return path if alone else path.with_stem(f"{path.stem}_{_UNSAFE.sub('_', needed.bearings[0])}")


def job_text(scene: Scene, needed: Needed) -> str:
    """Text of the job that covers what the bearings of one geometry need.

    Parameters
    ----------
    scene : Scene
        With a lubricant; geometry, oil and temperature are copied from its text.
    needed : Needed
        The ranges.
    """
    values = tomllib.loads(scene.text)
    index = next(i for i, entry in enumerate(scene.bearings) if entry.name == needed.bearings[0])
    tables = {"bearing": values["bearings"][index]["geometry"], "lubricant": values["lubricant"]}
    lines = [
        f"# What {_plain(scene.name)} needs of a contact map, for {_plain(', '.join(needed.bearings))}.",
        f"# Largest load of a slice at rest {LOAD.text(needed.static_load)}; the highest load of the map is "
        f"{needed.load[1] / needed.static_load:.3g} times that.",
        "",
        "schema = 1",
    ]
    for name, table in tables.items():
        lines += ["", f"[{name}]", *(f"{key} = {_toml(value)}" for key, value in table.items())]
    return "\n".join(
        [
            *lines,
            "",
            "[grid]",
            f"load = {_axis(needed.load, LOAD, LOAD_AXIS, LOADS_PER_DECADE)}",
            f"entrainment_speed = {_axis(needed.entrainment_speed, SPEED, SPEED_AXIS, SPEEDS_PER_DECADE)}",
            f"temperature = [{_toml(values['operation']['temperature'])}]",
            "",
            "[solver]",
            'name = "reynolds"',
            'structural_law = "iso16281"',
            f"law_check = {LAW_CHECK}",
            "",
        ]
    )


def _axis(ends: tuple[float, float], display: Display, rule: AxisRule, per_decade: int) -> str:
    """An axis of a job that covers a range."""
    low, high = planning.outward(*(display.value(max(end, rule.low)) for end in ends))
    if low == high:
        return f'["{low:g} {display.unit}"]'
    points = max(FEWEST, math.ceil(per_decade * math.log10(high / low)) + 1)
    return f'{{ from = "{low:g} {display.unit}", to = "{high:g} {display.unit}", points = {points}, spacing = "log" }}'


def _toml(value: object) -> str:
    """A string, number or table of them in TOML."""
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_toml(entry)}' for key, entry in value.items())} }}"
    if isinstance(value, str):
        # JSON escapes all that TOML wants escaped, but for this one.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value)


def _plain(text: str) -> str:
    """A text that may stand in a comment."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


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
    return job.points + (refined.points if refined else 0) + job.law_check


def _written(job: Job, path: Path) -> str:
    """Write a job."""
    write_text(path, sealed(job.text), SEALED)
    return f"{path}: written; `ehdmaps generate {path}` makes the map"


def _covered(lines: list[str], needed: tuple[Needed, ...], emap: EHDMap, name: str) -> tuple[str, int]:
    """Say of each axis whether a map covers what is needed."""
    # A law refuses such a map, whatever its axes are.
    check_usable(emap.dataset, ("inner", "outer"))
    axes = [emap.dataset[key].values for key in ("load", "entrainment_speed", "temperature")]
    # At rest there is no film to be mapped; only a dry map has no other speed.
    mapped = [axis[axis > 0.0] if np.any(axis > 0.0) else axis for axis in axes]
    short = False
    for planned in needed:
        highest = planned.load[1]
        entry = dataclasses.replace(planned, load=(min(planning.LIGHT_ENOUGH * highest, planning.LIGHT), highest))
        wanted = (entry.load, entry.entrainment_speed, (entry.temperature, entry.temperature))
        lines += [*_head(entry), f"  {'':18s} {'needed':28s} {'mapped':28s}"]
        for (axis, text), (low, high), values, display in zip(
            _ranges(entry), wanted, mapped, (LOAD, SPEED, TEMPERATURE), strict=True
        ):
            ends = (float(values.min()), float(values.max()))
            sides = [
                *(["below"] if low < ends[0] * (1.0 - ROUND_OFF) else []),
                *(["above"] if high > ends[1] * (1.0 + ROUND_OFF) else []),
            ]
            short |= bool(sides)
            fades = ", where the film fades" if "below" in sides and axis != "temperature" else ""
            verdict = f"short {' and '.join(sides)}{fades}" if sides else "ok"
            lines.append(f"  {axis:18s} {text:28s} {_span(ends, display):28s} {verdict}")
    word = "does not cover the scene; plan a map for it with -o JOB.toml" if short else "covers the scene"
    return "\n".join([*lines, f"{name}: {word}"]), 1 if short else 0
