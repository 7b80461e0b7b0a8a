"""Unknowns of a machine from what is measured of it: `mbs identify`, and the same in Python."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.units import quantity
from mbs.analyses.case import Workers
from mbs.analyses.operating import settled
from mbs.identification.certainty import certainty
from mbs.identification.explained import damper, wrong_channels
from mbs.identification.found import Identified
from mbs.identification.free import Free, read_free
from mbs.identification.machine import Machine
from mbs.identification.measured import Measured, MeasuredModes
from mbs.identification.planning import Step, before, information_of, plan, told_by
from mbs.identification.reading import Reading, read_measured, responses_of
from mbs.identification.search import STARTS, Question, search
from mbs.modal.records import Responses
from mbs.scene.assembly import Model, assemble
from mbs.scene.scene import Scene
from mbs.settings import CAGE_ANGLES, check_cage_angles

Progress = Callable[[str], Callable[[int, int], None]]
"""Makes what is told of the progress of a part, by its name."""

PLAN_LINES = 150
"""Lines of each response of a plan."""


def _silent(part: str) -> Callable[[int, int], None]:
    """Tell nobody."""
    return lambda done, total: None


Record = Measured | tuple[str | Path | Responses, str]
"""Something measured: read already, or a file or its responses with their speed."""


def identify(
    machine: Model | Scene,
    records: Sequence[Record],
    free: Sequence[str],
    cage_angles: int = CAGE_ANGLES,
    seed: int = 0,
    progress: Progress = _silent,
    workers: Workers = 1,
) -> Identified:
    """Find unknowns of a machine from frequency responses or modes.

    Parameters
    ----------
    machine : Model or Scene
        Scene with its law, or a scene, which gets that of `mbs.assemble`.
    records : sequence of (str, Path or Responses, str), or of MeasuredResponses or MeasuredModes
        What was measured, at one speed or several: files and their speeds, such as ("hits.uff", "1500 rpm"), with an
        empty speed where the file has it; responses that `mbs.modal.estimation.estimate` makes of hits, likewise; or
        what `mbs.identification.reading.read_measured` reads.
    free : sequence of str
        What is sought: "clearance", "temperature", "foot.stiffness", see `mbs.identification.free`. Damping ratios of
        bodies are sought besides where films are: they damp alike.
    cage_angles : int
        Angles within one pitch over which stiffness and damping are averaged.
    seed : int
        Seed of the random starts.
    progress : callable, optional
        Makes a callable that is told how much of a part is done, by its name.
    workers : int or concurrent.futures.Executor
        Number of processes among which starts and trials are divided, or what computes them in their place.

    Raises
    ------
    InputError
        With every problem; for channels of another sign or unit than stated.
    AnalysisError
        If the machine finds no equilibrium.
    """
    check_cage_angles("identify", cage_angles)
    model = assemble(machine) if isinstance(machine, Scene) else machine
    measured = [entry for record in records for entry in _read(record, model.scene)]
    if not measured:
        raise InputError("identify: got nothing measured; allowed: responses or modes, of one speed at least")
    looked, unknowns = _asked(model, [one.speed for one in measured], free, cage_angles, _highest(measured))
    question = Question(looked, looked.model.scene, unknowns, tuple(measured))
    fit = search(question, STARTS, seed=seed, progress=progress("look"), workers=workers)
    if wrong := wrong_channels(fit):
        raise InputError([f"{one.channel}: {one.words}; state it as it was measured" for one in wrong])
    sure = certainty(fit, progress("assumption"), workers)
    other = None
    if looked.model.has_films and not (fit.stopped or sure.stopped):
        with contextlib.suppress(KeyboardInterrupt):  # what was found is kept
            other = damper(fit, progress("look"), workers)
    return Identified(fit, sure, other)


def _read(record: Record, scene: Scene) -> Sequence[Measured]:
    """Measurements of a record, from its file where it is one."""
    if not isinstance(record, tuple):
        return [record]
    file, speed = record
    if isinstance(file, Responses):
        return [responses_of(Path("responses"), file, quantity(speed, "rad/s"), scene, Reading())[0]]
    return read_measured(Path(file), quantity(speed, "rad/s") if speed else None, scene, Reading())[0]


def _asked(
    model: Model, speeds: Sequence[float], free: Sequence[str], cage_angles: int, highest: float
) -> tuple[Machine, tuple[Free, ...]]:
    """Machine and unknowns: laws up to the highest speed, shafts whose cut-off is not felt."""
    fastest = max((abs(speed) for speed in speeds), default=0.0)
    scene = dataclasses.replace(model.scene, speed=fastest or model.scene.speed)
    model = settled([model.again(scene)], scene.speed, highest)[0]
    unknowns = read_free(free, model.scene)
    named = {one.name for one in unknowns}
    if model.has_films and "temperature" in named:
        besides = [
            f"{body.name}.damping_ratio"
            for body in model.scene.bodies
            if getattr(body, "damping_ratio", 0.0) > 0.0 and f"{body.name}.damping_ratio" not in named
        ]
        unknowns += read_free(besides, model.scene) if besides else ()
    return Machine(model, cage_angles), unknowns


def _highest(measured: Sequence[Measured]) -> float:
    """Highest frequency that was measured [Hz]."""
    return float(max(np.max(one.frequency if isinstance(one, MeasuredModes) else one.frequencies) for one in measured))


def would_tell(found: Identified, speeds: Sequence[float] = ()) -> Step | None:
    """The channel more that tells best what is not told apart; None where all is, or nothing more can be measured.

    Parameters
    ----------
    found : Identified
        The result.
    speeds : sequence of float
        Speeds that may be measured at besides [rad/s]; half and all of those that were, and rest, if left out.
    """
    question = found.fit.question
    scene = question.scene
    all_told = not (found.certainty.groups() or found.certainty.untold(question.width))
    if all_told or not (scene.sensors and scene.inputs):
        return None
    machine = question.machine
    free = [dataclasses.replace(one, start=value) for one, value in zip(found.free, found.fit.values, strict=True)]
    there = {one.speed for one in question.measured}
    asked = sorted({*(speeds or [0.0, *(0.5 * one for one in there), *there])})
    try:
        channels = information_of(machine, scene, free, asked, _lines(scene.frequencies, _highest(question.measured)))
    except AnalysisError:
        return None
    done = {
        (one.speed, sensor.name, entry.name)
        for one in question.measured
        if not isinstance(one, MeasuredModes)
        for sensor, entry in one.rows
    }
    rest = {one: own for one, own in channels.items() if (one.speed, one.sensor, one.entry) not in done}
    known = found.fit.jacobian.T @ found.fit.jacobian + before(free)
    return told_by(free, known, rest)


def identify_plan(
    model: Model,
    free: Sequence[str],
    speeds: Sequence[float] = (),
    cage_angles: int = CAGE_ANGLES,
    progress: Progress = _silent,
) -> tuple[tuple[Free, ...], list[Step]]:
    """Propose what to measure so that unknowns are told apart.

    Parameters
    ----------
    model : Model
        Scene with its law, with inputs and sensors.
    free : sequence of str
        What is sought.
    speeds : sequence of float
        Speeds that may be measured at [rad/s]; a quarter, half and all of that of the scene, and rest, if left out.
    cage_angles : int
        Angles within one pitch.
    progress : callable, optional
        Callable that `identify` takes, too.

    Raises
    ------
    InputError
        With every problem.
    AnalysisError
        If the machine finds no equilibrium at any speed.
    """
    scene = model.scene
    if not (scene.sensors and scene.inputs):
        raise InputError(f"{scene.name}: has no [[inputs]] or no [[sensors]]; a plan chooses among them")
    asked = tuple(speeds) or (0.0, 0.25 * scene.speed, 0.5 * scene.speed, scene.speed)
    asked = tuple(dict.fromkeys(asked))
    lines = _lines(scene.frequencies, 0.0)
    machine, unknowns = _asked(model, asked, free, cage_angles, float(lines[-1]))
    channels = information_of(machine, machine.model.scene, unknowns, asked, lines, progress("speed"))
    return unknowns, plan(unknowns, channels)


def _lines(frequencies: Sequence[float], highest: float) -> FloatArray:
    """Lines of responses that are planned [Hz]."""
    low, high = (min(frequencies), max(frequencies)) if frequencies else (20.0, 0.0)
    return np.asarray(np.geomspace(max(low, 1.0), max(high, highest) or 2500.0, PLAN_LINES), dtype=np.float64)
