"""`mbs bearing`: one bearing under loads and speeds, without a scene."""

from __future__ import annotations

import argparse
import json
import math
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ehdmaps.errors import AnalysisError, InputError, Problems
from ehdmaps.outputs import Output, output_problems, write_figure
from ehdmaps.physics.designations.families import not_served
from ehdmaps.physics.designations.reader import BALLS, TAPERED, read_designation
from mbs.commands.common import with_bands
from mbs.one_bearing.bands import point_lines
from mbs.one_bearing.family import Family, Request
from mbs.output.one_bearing.kind import Description, Kind, Points
from mbs.output.one_bearing.table import heading, point_text

if TYPE_CHECKING:
    from mbs.unknowns.looks import Band

_BALLS = re.compile(r"\s*[67]\d{3}(?!\d)")
"""Beginning of what may be meant as the designation of a ball bearing."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Compute all points, describe and write them; status 1 where one is outside of what the laws hold for."""
    arguments = _without_deviations(arguments)
    if getattr(arguments, "vibration", None) is not None:
        from mbs.commands.vibration import run_vibration

        stated = getattr(arguments, "deviations", {})
        keys = "\n".join(f"{key} = {_braced(value)}" for key, value in stated.items())
        return run_vibration(arguments, keys, family_of(arguments.bearing, arguments.axial))
    if not arguments.load and arguments.axial is None:
        unknown = not_served(arguments.bearing)
        missing = '--load: missing; allowed: on the inner ring, such as "5 kN", or a history, FILE.csv'
        raise InputError([*([f"BEARING: {unknown}"] if unknown else []), missing])
    arguments.load = arguments.load or [["0 N"]]  # an axial load alone
    history = [text for given in arguments.load for text in given if text.strip().lower().endswith(HISTORY)]
    if history:
        from mbs.one_bearing.history import run_history

        return run_history(arguments, history[0], family_of)
    asked = Problems()
    if not arguments.speed:
        asked.append('--speed: missing; allowed: of the inner ring, such as "1500 rpm"')
    banded = with_bands(arguments, asked)
    path, warmth = arguments.output, arguments.temperature or []
    ending = Path(path or "").suffix.lower()
    over = len(warmth) > 1 and arguments.permittivity is not None
    if over and ending != ".csv":
        asked.append(f"--temperature: got {len(warmth)} of them; allowed: one, or several with -o NAME.csv")
    if ending == CIRCUIT:
        asked += _circuit_problems(path, arguments.permittivity is not None)
        arguments = argparse.Namespace(**{**vars(arguments), "output": None})
    asked.check()
    from mbs.one_bearing import request as one  # with what its refusals do not need

    family = family_of(arguments.bearing, arguments.axial)
    each = [{**vars(arguments), "temperature": [text]} for text in warmth] if over else [vars(arguments)]
    requests = [one.read_request(argparse.Namespace(**each_), family) for each_ in each]
    answers = [_answer(request, banded and not over) for request in requests]
    lines = "\n\n".join("\n".join(answer.lines) for answer in answers).split("\n")
    first, kind = answers[0], family.kind
    if over:
        from mbs.output.one_bearing.files import point_dataset, write_csv

        datasets = [point_dataset(kind, answer.description, answer.points) for answer in answers]
        write_csv(kind, kind.numbers_of(first.description), datasets, path)
        lines.append(f"{path}: written")
    elif ending == CIRCUIT:
        lines.append(_circuit(path, kind, first))
    elif path:
        lines.append(one.write_file(path, requests[0], first.points, first.bands))
    if arguments.plot:
        lines.append(_drawn(arguments.plot, kind, first.description, first.points))
    every = [point for answer in answers for row in answer.points for point in row]
    return "\n".join(lines), 1 if any(point.problems for point in every) else 0


def _without_deviations(arguments: argparse.Namespace) -> argparse.Namespace:
    """Arguments with the deviations from the form that stand in the braces of the bearing apart."""
    text = arguments.bearing
    if not (text.lstrip().startswith("{") and any(key in text for key in DEVIATIONS)):
        return arguments
    from ehdmaps.jobs.table import inline

    problems: list[str] = []
    values = inline(text, "BEARING", problems)
    if problems:
        raise InputError(problems)
    own = {key: values.pop(key) for key in DEVIATIONS if key in values}
    # a designation alone may be that of any kind
    rest = values["name"] if set(values) == {"name"} and isinstance(values["name"], str) else _braced(values)
    return argparse.Namespace(**{**vars(arguments), "bearing": rest, "deviations": own})


def _braced(value: Any) -> str:
    """A value as TOML writes it in a line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {_braced(one)}" for key, one in value.items()) + "}"
    return f"[{', '.join(map(_braced, value))}]" if isinstance(value, list) else json.dumps(value, default=str)


DEVIATIONS = ("waviness", "size_difference", "spall")
"""Keys in the braces of a bearing that are those of [[bearings]] of scenes."""

HISTORY = ".csv"
"""Ending of a history of operating points, in place of a load."""

CIRCUIT = ".cir"
"""Ending of a subcircuit for SPICE."""


class _Answer(NamedTuple):
    """Points of a request, their bands, and what is told of them."""

    description: Description
    points: Points
    bands: dict[str, Band]
    lines: list[str]


def _answer(request: Request, banded: bool) -> _Answer:
    """Answer one request."""
    from mbs.one_bearing import request as one

    family, description, points = request.family, request.description, one.points_of(request)
    bands = one.bands_of(request, points) if banded else {}
    told = point_lines(bands, one.scene_as(request), one.open_of(request)) if bands else []
    lines = point_text(family.kind, description, points, [*family.beside(request, points), *told])
    return _Answer(description, points, bands, lines)


def _circuit_problems(path: str, electric: bool) -> list[str]:
    """Problems with a subcircuit."""
    from mbs.output.one_bearing.electric import CIRCUITS

    problems = output_problems([Output("-o", path, CIRCUITS)])
    if not electric:
        problems.append(f"-o: got {path!r:.80}, a circuit; allowed: with --permittivity 2.2, that of the oil")
    return problems


def _circuit(path: str, kind: Kind, answer: _Answer) -> str:
    """Write the subcircuit of the only point."""
    from mbs.output.one_bearing.electric import electrics, write_circuit

    points = [point for row in answer.points for point in row]
    if len(points) > 1:
        raise InputError(f"-o {path}: got {len(points)} points; allowed: one load and one speed")
    found = electrics(points[0], answer.description)
    if math.isnan(found.capacitance):
        raise AnalysisError(f"-o {path}: the bearing has no films at this point, and so no capacitance")
    heads = heading(kind, answer.description, points[0])
    return write_circuit(path, points[0].geometry.name, heads, found)


def family_of(name: str, axial: str | None) -> Family:
    """Row of a bearing, by its designation; that of cylindrical rollers of files, too.

    Parameters
    ----------
    name : str
        Designation, a file, or keys in braces.
    axial : str or None
        Axial load as it was typed, which ribs carry.
    """
    by_keys = "\0" not in name and (name.lstrip().startswith("{") or os.path.isfile(name))
    if by_keys:
        from ehdmaps.jobs.balls import balls_of

        if balls_of(name) is not None:
            from mbs.one_bearing.balls import BALL_BEARINGS

            return BALL_BEARINGS
    if not by_keys:
        found = read_designation(name)
        kind = "" if found is None else found.kind
        if kind in BALLS or (not kind and _BALLS.match(name)):
            from mbs.one_bearing.balls import BALL_BEARINGS

            return BALL_BEARINGS
        if words := not_served(name):
            raise InputError(f"BEARING: {words}")
        if kind == TAPERED:
            from mbs.one_bearing.ribs import TAPERED_BEARINGS

            return TAPERED_BEARINGS
        if axial is not None:
            from ehdmaps.physics.rollers.ribbed_geometry import ribbed_way

            if ribbed_way(name):
                from mbs.one_bearing.ribs import RIBBED_BEARINGS

                return RIBBED_BEARINGS
    from mbs.one_bearing.cylindrical import CYLINDERS

    return CYLINDERS


def _drawn(path: str, kind: Kind, description: Description, points: Points) -> str:
    """Draw the figure of --plot, and return what was written in words."""
    from mbs.output.bearing_plot import bearing_figure

    write_figure(bearing_figure(kind, description, points), path)
    return f"{path}: written"
