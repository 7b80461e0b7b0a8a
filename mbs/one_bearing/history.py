"""`mbs bearing --load HISTORY.csv`: operating points that take turns, and the life under all of them.

A line of the file is an operating point: load, speed, an axial load if there is one, and how much of all revolutions
pass there, as a share of them or by the time that the point lasts.
"""

from __future__ import annotations

import argparse
import math
from functools import cache
from typing import Any, NamedTuple

from ehdmaps.errors import AnalysisError, InputError, Problems
from ehdmaps.outputs import TABLE, Output, output_problems
from ehdmaps.units import RPM
from mbs.one_bearing.family import Family, Request
from mbs.one_bearing.request import point_at, read_request
from mbs.one_bearing.shared import LOADS, SPEEDS
from mbs.output.one_bearing.history import history_lines, write_history
from mbs.scene.fields import FORCE, read_columns

FORM = "columns 'load [kN]', 'speed [rpm]', perhaps 'axial [kN]', and 'share [%]' of the revolutions or 'time [h]'"
"""What the file holds, for messages."""

_UNITS = {"load": "N", "axial": "N", "speed": "rad/s", "share": "1", "time": "s"}

_MOST, _LONGEST = 250, 1_000_000
"""Most points, and longest file [bytes]."""

_WHOLE = 1e-3
"""How far a sum of shares may be from one, as of percents that were typed."""


class History(NamedTuple):
    """Operating points that take turns.

    Attributes
    ----------
    loads : tuple of float
        Radial loads on the inner ring [N].
    axial : tuple of float or None
        Axial ones [N]; None without a column of them.
    speeds : tuple of float
        Speeds of the inner ring [rad/s].
    shares : tuple of float
        Shares of the revolutions, with the sum 1.
    """

    loads: tuple[float, ...]
    axial: tuple[float, ...] | None
    speeds: tuple[float, ...]
    shares: tuple[float, ...]


def read_history(path: str) -> History:
    """Read operating points.

    Parameters
    ----------
    path : str
        The file.

    Raises
    ------
    InputError
        With every problem.
    """
    found = read_columns(path, _UNITS, FORM, _MOST, _LONGEST)
    lacking = [name for name in ("load", "speed") if name not in found]
    if lacking or ("share" in found) == ("time" in found):
        raise InputError(f"{path}: got the columns {', '.join(found)}; allowed: {FORM}")
    loads, speeds, weights = found["load"], found["speed"], found.get("share") or found.get("time") or []
    axial = found.get("axial", [0.0] * len(loads))
    if not loads:
        raise InputError(f"{path}: got no points; allowed: 1 to {_MOST}")
    problems = Problems()
    for line, (load, along, speed, weight) in enumerate(zip(loads, axial, speeds, weights, strict=True), 1):
        where = f"{path}, point {line}"
        if not (0.0 <= load <= LOADS[1] and abs(along) <= LOADS[1] and max(load, abs(along)) >= LOADS[0]):
            problems.append(
                f"{where}: got a load of {load:.4g} N, axial {along:.4g} N; allowed: {LOADS[0]:g} to {LOADS[1]:g} N"
            )
        if not SPEEDS[0] <= speed <= SPEEDS[1]:
            problems.append(f"{where}: got {RPM.text(speed)}; allowed: 0 to {RPM.text(SPEEDS[1])}")
        if not 0.0 <= weight < math.inf or (speed == 0.0 < weight and "share" in found):
            problems.append(f"{where}: got {weight:.4g}; allowed: a share of the revolutions, or a time, of 0 or more")
    turns = weights if "share" in found else [time * speed for time, speed in zip(weights, speeds, strict=True)]
    total = math.fsum(turns)
    if not problems and "share" in found and abs(total - 1.0) > _WHOLE:
        problems.append(f"{path}: got shares with a sum of {100.0 * total:.6g} %; allowed: 100 %, of the revolutions")
    if not problems and not 0.0 < total < math.inf:
        problems.append(f"{path}: got no revolution; allowed: a point that turns for some time")
    problems.check()
    return History(
        tuple(loads), tuple(axial) if "axial" in found else None, tuple(speeds), tuple(turn / total for turn in turns)
    )


def run_history(arguments: argparse.Namespace, path: str, family_of: Any) -> tuple[str, int]:
    """Compute the points of a history, describe and write them; status 1 where one is outside of the laws.

    Parameters
    ----------
    arguments : Namespace
        Options as they were parsed.
    path : str
        File of the history.
    family_of : callable
        (name, axial load as it is typed or None) -> row of a bearing.

    Raises
    ------
    InputError
        With every problem.
    AnalysisError
        Where a point has no equilibrium.
    """
    wrong = Problems(output_problems([Output("-o", arguments.output, TABLE)], [path]))
    for option, given in (("--speed", arguments.speed), ("--plot", arguments.plot)):
        wrong += [f"{option}: got {given!r:.60} with a history; leave it out"] if given else []
    if len(arguments.load) + len(arguments.load[0]) > 2:
        wrong.append(f"--load: got {path!r:.80} beside others; allowed: a history alone")
    history = read_history(path)
    if history.axial is not None and arguments.axial is not None:
        wrong.append(f"--axial: got {arguments.axial!r:.60}, and {path} has axial loads; leave one of the two out")
    wrong.check()
    axial = arguments.axial if history.axial is None else _newtons(max(history.axial, key=abs))
    family: Family = family_of(arguments.bearing, axial)
    given = {
        "load": [[_newtons(load)] for load in sorted({min(history.loads), max(history.loads)})],
        "speed": [[f"{speed!r} rad/s"] for speed in sorted(set(history.speeds))],
        "axial": axial,
        "output": None,
    }
    request = read_request(argparse.Namespace(**{**vars(arguments), **given}), family)
    for pushed in set(history.axial or ()):
        if words := family.wrong(request.asked, request.operating._replace(axial=pushed)):
            raise InputError(f"{path}: {words.removeprefix('--axial: ')}")
    points = _points(request, history, path)
    lines = history_lines(family.kind, request.description, points, history.shares, path)
    if arguments.output:
        lines.append(write_history(family.kind, request.description, points, history.shares, arguments.output))
    return "\n".join(lines), 1 if any(point.problems for point in points) else 0


def _newtons(load: float) -> str:
    """A load as it is typed."""
    return f"{load!r} N"


def _points(request: Request, history: History, path: str) -> list[Any]:
    """Points of all lines."""
    at_speed, way = cache(request.family.at_speed(request)), request.operating.way
    axial = history.axial or (request.operating.axial,) * len(history.loads)
    points = []
    for line, (load, along, speed) in enumerate(zip(history.loads, axial, history.speeds, strict=True), 1):
        try:
            points.append(point_at(request, (along, load * way[0], load * way[1]), speed, at_speed(speed)))
        except (AnalysisError, InputError) as error:
            where = f"{path}, point {line}, {FORCE.text(load)} at {RPM.text(speed)}"
            raise AnalysisError(f"{where}: {str(error).splitlines()[0]}") from error
    return points
