"""`mbs bearing`: one bearing under loads and speeds, without a scene."""

from __future__ import annotations

import argparse
import os
import re

from ehdmaps.errors import InputError
from ehdmaps.outputs import write_figure
from ehdmaps.physics.designations.families import not_served
from mbs.commands.common import with_bands
from mbs.commands.one_bearing.bands import point_lines
from mbs.commands.one_bearing.family import Family
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
    from mbs.commands.one_bearing import request as one  # with what its refusals do not need

    family = family_of(arguments.bearing, arguments.axial)
    request = one.read_request(arguments, family)
    kind, description, points = family.kind, request.description, one.points_of(request)
    bands = one.bands_of(request, points) if banded else {}
    told = point_lines(bands, one.scene_as(request)) if bands else []
    lines = point_text(kind, description, points, [*family.beside(request, points), *told])
    if arguments.output:
        lines.append(one.write_file(arguments.output, request, points, bands))
    if arguments.plot:
        lines.append(_drawn(arguments.plot, kind, description, points))
    return "\n".join(lines), 1 if any(point.problems for row in points for point in row) else 0


def family_of(name: str, axial: str | None) -> Family:
    """Row of a bearing, by its designation; that of cylindrical rollers of files, too.

    Parameters
    ----------
    name : str
        Designation, or a file.
    axial : str or None
        Axial load as it was typed, which ribs carry.
    """
    if not os.path.isfile(name):
        if _BALLS.match(name):
            from mbs.commands.one_bearing.balls import BALL_BEARINGS

            return BALL_BEARINGS
        if words := not_served(name):
            raise InputError(f"BEARING: {words}")
        if _TAPERED.match(name):
            from mbs.commands.one_bearing.ribs import TAPERED_BEARINGS

            return TAPERED_BEARINGS
        if axial is not None:
            from ehdmaps.physics.rollers.ribbed_geometry import ribbed_way

            if ribbed_way(name):
                from mbs.commands.one_bearing.ribs import RIBBED_BEARINGS

                return RIBBED_BEARINGS
    from mbs.commands.one_bearing.cylindrical import CYLINDERS

    return CYLINDERS


def _drawn(path: str, kind: Kind, description: Description, points: Points) -> str:
    """Draw the figure of --plot, and return what was written in words."""
    from mbs.output.bearing_plot import bearing_figure

    write_figure(bearing_figure(kind, description, points), path, RESOLUTION)
    return f"{path}: written"
