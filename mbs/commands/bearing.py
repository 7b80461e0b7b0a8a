"""`mbs bearing`: one bearing under loads and speeds, without a scene."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.outputs import write_figure
from mbs.analyses.bearing_point import bearing_points
from mbs.bearings import laws
from mbs.bearings.laws import Law
from mbs.commands.bearing_request import BearingRequest, read_request
from mbs.output.bearing_table import bearing_dataset, bearing_text, write_csv
from mbs.output.files import write_dataset
from mbs.scene.contact_laws import Damper, hertz_damper, table_path
from mbs.scene.law_file import read_law

RESOLUTION = 150
FORMULA_LOADS = (100.0, 1e8)
"""Loads for which the law of the formula is made [N/m]; far beyond 4 GPa in any bearing of steel."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Compute all points, describe and write them; status 1 where one is outside of what the laws hold for."""
    request = read_request(arguments)
    points = bearing_points(
        request.bearing, _law(request), request.films, request.load_vectors, request.speeds, request.temperature
    )
    lines = bearing_text(request.description, points)
    if arguments.output:
        dataset = bearing_dataset(request.description, points)
        if Path(arguments.output).suffix.lower() == ".csv":
            write_csv(dataset, arguments.output)
        else:
            write_dataset(dataset, Path(arguments.output))
        lines.append(f"{arguments.output}: written")
    if arguments.plot:
        from mbs.output.bearing_plot import bearing_figure

        write_figure(bearing_figure(request.description, points), arguments.plot, RESOLUTION)
        lines.append(f"{arguments.plot}: written")
    problems = any(point.problems for row in points for point in row)
    return "\n".join(lines), 1 if problems else 0


def _law(request: BearingRequest) -> Law:
    """The law of a roller between both raceways, over what is asked of it."""
    if request.law == "map" and request.emap is not None:
        return request.emap.law("series", outside="clamp", supply=request.supply, surface=request.surface)
    if request.law == "formula":
        turning = [speed for speed in request.speeds if speed > 0.0] or [1.0]
        u = [request.bearing.geometry.entrainment_speed(speed) for speed in (min(turning), max(turning))]
        return laws.formula(
            request.bearing,
            request.oil,
            load=FORMULA_LOADS,
            entrainment_speed=(u[0] / 1.1, u[1] * 1.1),
            temperature=(request.temperature, request.temperature + 2.0),
            outside="clamp",
            supply=request.supply,
            surface=request.surface,
        )
    if (path := table_path(request.law)) is not None:
        return read_law(path, request.bearing.geometry.roller_length)
    damper = hertz_damper(request.law) or Damper()
    return laws.hertz(request.bearing, damper.constant, damper.time)
