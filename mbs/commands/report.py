"""`mbs report`: a scene as one file of HTML that can be sent, read without a network, and printed."""

from __future__ import annotations

import argparse
import shlex
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from ehdmaps.errors import Problems
from ehdmaps.report.page import REPORT, write_report
from mbs.analyses.case import Case
from mbs.analyses.reach import outside_at
from mbs.analyses.soundness import Judged
from mbs.commands.auto import analysed
from mbs.commands.cases import load_cases
from mbs.commands.common import Looked, with_bands
from mbs.commands.sweep import read_speeds
from mbs.planning.question import at_one_speed, over_speeds
from mbs.report.campbell import read_result
from mbs.report.examination import Examination, examined, speeds_of
from mbs.report.machine import warnings
from mbs.report.scene_report import scene_report
from mbs.scene.choices import OPTIONS
from mbs.scene.map_set import MapSet
from mbs.settings import SweepRange

_OPTIONS = (*(choice.name for choice in OPTIONS), "auto-tolerance", "bands", "result")


class _Asked(NamedTuple):
    """The model, speeds of the sweep, and a result in its place."""

    case: Case
    speeds: SweepRange | None
    saved: xr.Dataset | None


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Examine the scene and write the report; by default in this folder, with the name of the scene."""
    arguments.output = arguments.output or f"{Path(arguments.scene).stem}.html"
    looked: list[_Asked] = []
    done = analysed(arguments, _asked, lambda asked: _examine(asked, looked, arguments), _looks_at)
    asked = looked[-1]
    found = done.result
    saved = None if asked.saved is None else (Path(arguments.result).name, asked.saved)
    maps = [Path(path).name for path in arguments.map or ()]
    text = scene_report(found, _command(arguments), maps, saved, [line.strip() for line in done.lines])
    write_report(arguments.output, text)
    failed = [reason for reason in (found.modes, found.speeds) if isinstance(reason, str) and reason]
    told = [f"warning: {line}" for line in (*warnings(found), *failed)]
    judged = Judged([("", found.findings)])
    lines = [*judged.first, *done.lines, *told, *judged.last, f"{arguments.output}: written"]
    outside = outside_at(found.model, found.statics.balance)
    return "\n".join(lines), 1 if failed or outside or judged.status else 0


def _asked(arguments: argparse.Namespace) -> _Asked:
    """Read what is asked for; all problems at once."""
    problems = Problems()
    speeds, saved, cases = None, None, []
    with_bands(arguments, problems)
    with problems:
        speeds = read_speeds(arguments.speed) if arguments.speed else None
    if arguments.result is not None:
        with problems:
            saved = read_result(arguments.result)
        if arguments.speed:
            problems.append("--speed: stands beside --result, whose speeds are drawn; leave one of them out")
    with problems:
        cases = load_cases(arguments, several=False, kind=REPORT)
    problems.check()
    return _Asked(cases[0], speeds, saved)


def _examine(asked: _Asked, looked: list[_Asked], arguments: argparse.Namespace) -> Examination:
    """Examine the model; what was asked last is kept, with what `--auto` chose."""
    looked.append(asked)
    one, banded = asked.case, with_bands(arguments, [])
    # with --auto the films of the report may be others
    known = None if arguments.auto else getattr(arguments, "found", None)
    return examined(one.model, _maps(asked), asked.speeds, asked.saved is None, one.subject, banded, known)


def _maps(asked: _Asked) -> MapSet | None:
    """The maps of the law, if it is that of maps."""
    law = None if asked.case.subject is None else asked.case.subject.law
    return None if law is None or law.name not in ("map", None) else law.maps


def _looks_at(asked: _Asked) -> Looked:
    """The scene at its operating speed and over those of the diagram, up to the highest frequency of its modes."""
    scene = asked.case.model.scene
    swept = None if asked.saved is not None else asked.speeds or speeds_of(scene)
    visited = at_one_speed(scene) if swept is None else over_speeds(scene, swept, and_operation=True)
    return Looked(visited, max(scene.frequencies, default=scene.campbell.highest))


def _command(arguments: argparse.Namespace) -> str:
    """The command line, with the names of the files alone."""
    words = ["mbs", "report", Path(arguments.scene).name]
    for option in _OPTIONS:
        given = getattr(arguments, option.replace("-", "_"), None)
        for value in [given] if isinstance(given, str) else given or ():
            words += [f"--{option}", Path(value).name if option in ("map", "result") else value]
    words += ["--auto"] if arguments.auto else []
    words += ["--speed", *arguments.speed] if arguments.speed else []
    return shlex.join([*words, "-o", Path(arguments.output).name])
