"""`mbs run`: every analysis for which the scene has a table, and the report, with films that `--auto` may choose.

Results, figures, texts and `report.html` are written into one folder. What will be done, and about how long that
takes, is said before, on stderr, and again after each analysis.
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import math
import time
from pathlib import Path

from ehdmaps.choices import texts_of
from ehdmaps.errors import AnalysisError, EhdmapsError, InputError
from ehdmaps.jobs.make.status import duration
from ehdmaps.outputs import Kind, Output, check_outputs, write_text
from ehdmaps.program import tell
from ehdmaps.units import RPM
from mbs.analyses.campbell import campbell_problems
from mbs.analyses.case import Case
from mbs.analyses.modes import modes
from mbs.analyses.runup import runups
from mbs.analyses.statics import statics
from mbs.commands.cases import load_cases
from mbs.report.examination import MOST_SPEEDS
from mbs.scene.assembly import Model
from mbs.scene.choices import OPTIONS
from mbs.scene.reader import read_scene
from mbs.scene.scene import Scene
from mbs.unknowns.held_open import held_open_of

_TOLD_ONCE = ("auto: ", "note: ")

MARK = "mbs run"
REPORT = "report"

TEXT = Kind("a text of mbs run", (".txt",), lambda path: path.read_bytes().startswith(MARK.encode()))
"""Texts that are replaced only if they were written by this command."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Do all of them; what has no result does not stop the others."""
    scene = read_scene(arguments.scene)
    folder = _folder(arguments.output or f"{Path(arguments.scene).stem}_results")
    planned = {name: arguments.parse(_words(arguments, scene, name, folder)) for name in _analyses(scene)}
    lines, status = [f"{scene.title}: {', '.join(planned)}"], 0
    refused, told = 0, set[str]()
    expected = _expected(planned)
    tell(f"{MARK} {arguments.scene}: {_plan(expected)}; into {folder}")
    began = time.monotonic()
    for count, (name, one) in enumerate(planned.items()):
        try:
            text, found = importlib.import_module(f"mbs.commands.{name}").run(one)
        except (InputError, AnalysisError) as error:
            refused += isinstance(error, InputError)
            if refused == len(planned):
                raise
            text, found = "\n".join(f"warning: no result: {line}" for line in str(error).splitlines()), 1
        status = max(status, found)
        if name == "critical" and REPORT in planned:
            planned[REPORT].found = getattr(one, "found", None)  # which the report need not find again
        # The same plan, the same verdicts and the same note on films are told once.
        shown = [line for line in text.splitlines() if line not in told or not line.startswith(_TOLD_ONCE)]
        told.update(text.splitlines())
        lines += ["", f"=== mbs {name} {arguments.scene}", *shown]
        path = folder / f"{name}.txt"
        write_text(path, f"{MARK} {arguments.scene}: {name}\n{text}\n", TEXT)
        lines.append(f"{path}: written")
        left = _left(expected, count + 1, time.monotonic() - began)
        tell(f"{MARK}: {name} done, {count + 1} of {len(planned)}{left}")
    return "\n".join(lines), status


def _analyses(scene: Scene) -> list[str]:
    """The analyses for which a scene has what they need, in the order in which a machine is examined."""
    found = ["statics", "modes"]
    if scene.frequencies and scene.inputs and scene.sensors:
        found.append("lsa")
    if scene.sweep is not None:
        found.append("sweep")
        if any(body.spin for body in scene.bodies):
            found.append("critical")
    if scene.run_up is not None:
        found.append("runup" if campbell_problems(scene, scene.campbell) else "campbell")
    return [*found, REPORT]


def _expected(planned: dict[str, argparse.Namespace]) -> dict[str, float]:
    """Seconds that each analysis will about take: a trial, times how often its like is done; NaN where none is known.

    A trial is one equilibrium with its modes, and of a run some steps, by their processor time. Tables of laws that are
    made for it are kept.
    """
    expected = dict.fromkeys(planned, math.nan)
    try:
        model = load_cases(planned["modes"])[0].model
        statics(model)
        began = time.process_time()
        modes(model)
        once = time.process_time() - began
    except EhdmapsError:
        return expected  # the analyses themselves tell what is wrong
    banded = planned["modes"].bands in (None, "all")
    weights = _weights(model, len(held_open_of(model)) if banded else 0)
    expected |= {name: once * weights[name] for name in planned if name in weights}
    for name in ("campbell", "runup"):
        if name in planned:
            expected[name] = _of_run(model)
    return expected


def _weights(model: Model, unknown: int) -> dict[str, float]:
    """Cost of each analysis in equilibria with their modes, fitted to the processor time of shipped machines."""
    scene = model.scene
    speeds = 0 if scene.sweep is None else scene.sweep.points
    shared = speeds and any(body.spin for body in scene.bodies)  # the report has what `critical` found
    swept = 0 if shared else min(speeds or MOST_SPEEDS, MOST_SPEEDS)
    return {
        "statics": 1.0 + 0.6 * unknown,
        "modes": 2.2,
        "lsa": 3.5,
        "sweep": 0.35 * speeds,
        "critical": 0.45 * speeds,
        # an error budget of rollers has a law for each of its lines
        REPORT: 5.0 + 0.45 * swept + (22.0 if model.bearings else 0.0),
    }


_TRIED = (100, 500)
"""Steps of the two trials of a run; what they differ by is what steps take."""


def _of_run(model: Model) -> float:
    """Seconds that the run of a model will about take; NaN where its trial fails."""
    course = model.scene.run_up
    assert course is not None  # there is one where a run is planned
    step = course.settings.step
    if course.duration <= _TRIED[-1] * step:
        return 0.0
    spent = []
    for steps in _TRIED:
        short = dataclasses.replace(course, duration=steps * step)
        trial = dataclasses.replace(model, scene=dataclasses.replace(model.scene, run_up=short))
        began = time.process_time()
        try:
            runups([Case("", trial, math.nan)])
        except EhdmapsError:
            return math.nan
        spent.append(time.process_time() - began)
    # parts are made again with twice the step, for its error
    return 1.1 * max(spent[1] - spent[0], 0.0) * course.duration / (step * (_TRIED[1] - _TRIED[0]))


def _plan(expected: dict[str, float]) -> str:
    """Analyses, and about how long they take."""
    parts = [f"{name} {duration(value)}" if math.isfinite(value) else name for name, value in expected.items()]
    known = sum(value for value in expected.values() if math.isfinite(value))
    return f"{', '.join(parts)}" + (f"; about {duration(known)} in all" if known > 0.0 else "")


def _left(expected: dict[str, float], done: int, spent: float) -> str:
    """Time that the rest will about take, by what is done already."""
    values = [value if math.isfinite(value) else 0.0 for value in expected.values()]
    before, after = sum(values[:done]), sum(values[done:])
    if not before > 0.0 or not after > 0.0:
        return ""
    return f", about {duration(after * max(spent / before, 0.0))} left"


def _folder(given: str) -> Path:
    """The folder of the results, which is made where it is not there."""
    folder = Path(given)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"-o: got {given!r:.200}; allowed: a folder ({error.strerror or error})") from error
    return folder


def _words(arguments: argparse.Namespace, scene: Scene, name: str, folder: Path) -> list[str]:
    """The command line of one analysis."""
    words = [name, arguments.scene]
    for choice in OPTIONS:
        for text in texts_of(arguments, choice):
            words += [f"--{choice.name}", text]
    if arguments.auto_tolerance is not None:
        words += ["--auto-tolerance", arguments.auto_tolerance]
    if arguments.auto:
        words.append("--auto")
    if arguments.bands is not None and name not in ("campbell", "runup"):
        words += ["--bands", arguments.bands]
    check_outputs([Output("-o", folder / f"{name}.txt", TEXT)])
    if name == REPORT:
        swept = scene.sweep if "critical" in _analyses(scene) else None
        if swept is not None:
            words += ["--speed", *(f"{RPM.value(end):.9g} rpm" for end in (swept.begin, swept.end)), str(swept.points)]
        return [*words, "-o", str(folder / f"{name}.html")]
    # The figure of statics is one of rollers.
    figure = ["--plot", str(folder / f"{name}.png")] if name != "statics" or scene.bearings else []
    return [*words, "-o", str(folder / f"{name}.nc"), *figure]
