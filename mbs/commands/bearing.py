"""`mbs bearing`: one bearing under loads and speeds, without a scene."""

from __future__ import annotations

import argparse
import os
import re
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.outputs import write_figure
from ehdmaps.physics.designations.families import not_served
from mbs.commands.common import with_bands
from mbs.commands.one_bearing.bands import point_lines
from mbs.commands.one_bearing.cylindrical import read_request
from mbs.output.one_bearing.cylindrical import CYLINDRICAL
from mbs.output.one_bearing.kind import Description, Kind, Points
from mbs.output.one_bearing.table import point_text

_BALLS = re.compile(r"\s*[67]\d{3}(?!\d)")
"""Beginning of the designation of a ball bearing."""

_TAPERED = re.compile(r"\s*(?:HR ?)?3[0-3][0-9][ -]?\d\d(?!\d)", re.IGNORECASE)
"""Beginning of the designation of a tapered roller bearing."""

RESOLUTION = 150


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Compute all points, describe and write them; status 1 where one is outside of what the laws hold for."""
    asked: list[str] = []
    banded = with_bands(arguments, asked)
    if asked:
        raise InputError(asked)
    family = _family(arguments)
    if family is None:
        cylinders = read_request(arguments)
        kind, description, points = CYLINDRICAL, cylinders.description, cylinders.points()
        bands = cylinders.bands(points) if banded else {}
        told = point_lines(bands, cylinders.scene) if bands else []
        lines = point_text(kind, description, points, [*cylinders.beside(points), *told])
        if arguments.output:
            from mbs.output.one_bearing.files import write_points

            lines.append(write_points(kind, description, points, arguments.output, bands))
    else:
        from mbs.commands.one_bearing import rolling  # with kernels that others do not need

        request = rolling.read_request(arguments, family)
        kind, description, points = family.kind, request.description, rolling.points_of(request)
        bands = rolling.bands_of(request, points) if banded else {}
        lines = point_text(kind, description, points, point_lines(bands, rolling.scene_as(request)) if bands else ())
        if arguments.output:
            lines.append(rolling.write_file(arguments.output, request, points, bands))
    if arguments.plot:
        lines.append(_drawn(arguments.plot, kind, description, points))
    return "\n".join(lines), 1 if any(point.problems for row in points for point in row) else 0


def _family(arguments: argparse.Namespace) -> Any:
    """Row of a bearing that carries axial load, by its designation; None of cylindrical rollers, and of files."""
    name = arguments.bearing
    if os.path.isfile(name):
        return None
    if _BALLS.match(name):
        from mbs.commands.one_bearing.balls import BALL_BEARINGS

        return BALL_BEARINGS
    if words := not_served(name):
        raise InputError(f"BEARING: {words}")
    if arguments.axial is None and not _TAPERED.match(name):
        return None
    from ehdmaps.physics.rollers.ribbed_geometry import ribbed_way

    if not (_TAPERED.match(name) or ribbed_way(name)):
        return None
    from mbs.commands.one_bearing.ribs import RIBBED_BEARINGS, TAPERED_BEARINGS

    return RIBBED_BEARINGS if ribbed_way(name) else TAPERED_BEARINGS


def _drawn(path: str, kind: Kind, description: Description, points: Points) -> str:
    """Draw the figure of --plot, and return what was written in words."""
    from mbs.output.bearing_plot import bearing_figure

    write_figure(bearing_figure(kind, description, points), path, RESOLUTION)
    return f"{path}: written"
