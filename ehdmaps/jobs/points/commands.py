"""`ehdmaps generate`, `show`, `plot` and `export` of a ball bearing: its map of points."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

import numpy as np
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.jobs.points.asked import MADE
from ehdmaps.jobs.points.points_map import (
    DIMS,
    KIND,
    PointsRequest,
    points_map,
    read_points_map,
    reasons,
    usable,
    write_points_map,
)
from ehdmaps.outputs import FIGURE, MARK, TABLE, Output, check_outputs, write_figure, write_text
from ehdmaps.table.points.films import NUMBERS
from ehdmaps.units import short

_OF_LINES = (
    *("solver", "workers", "fresh", "fresh_films", "law_tolerance", "keep_cases"),
    *("structural_law", "supply", "roughness"),
)
"""Options of maps of line contacts."""


def run(arguments: argparse.Namespace, source: str) -> tuple[str, int]:
    """Make the map, or tell, draw or write what one holds.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of generate, show, plot or export.
    source : str
        Designation of the bearing, or file of the map.
    """
    options = [name for name in _OF_LINES if getattr(arguments, name, None) not in (None, False)]
    problems = [f"--{name.replace('_', '-')}: is one of line contacts; allowed: without it" for name in options]
    if arguments.command == "export" and arguments.to != "csv":
        problems.append(
            f"--to: got {short(arguments.to)} for point contacts; allowed: csv; K and C of the bearing: mbs bearing -o "
            "k.csv"
        )
    request = None
    if not os.path.exists(source):
        try:
            request = PointsRequest.named(source, arguments.oil)
        except InputError as error:
            problems += error.problems
    elif arguments.oil is not None:
        problems.append(f"--oil: got {short(arguments.oil)} beside a map; allowed: with --bearing")
    if problems:
        raise InputError(problems)
    name = Path(source if request is None else request.file_name)
    output = None if arguments.command == "show" or not arguments.output else Path(arguments.output)
    if arguments.command == "generate":
        path = output or name
        check_outputs([Output("-o", path, KIND)])
        assert request is not None
        dataset = points_map(request)
        write_points_map(dataset, path)
        return f"{path}: written\n{described(dataset)}", 0 if bool(usable(dataset).all()) else 1
    kind, ending = {"plot": (FIGURE, ".png"), "export": (TABLE, ".csv"), "show": (None, "")}[arguments.command]
    path = output or name.with_suffix(ending)
    if kind is not None:
        check_outputs([Output("-o", path, kind)], [] if request is not None else [name])
    dataset = read_points_map(name) if request is None else points_map(request)
    if kind is None:
        return described(dataset), 0
    if kind is FIGURE:
        from ehdmaps.jobs.points.points_plot import RESOLUTION, points_map_figure

        write_figure(points_map_figure(dataset), path, RESOLUTION)
    else:
        write_text(path, table(dataset), TABLE)
    return f"{path}: written", 0


def described(dataset: xr.Dataset) -> str:
    """Describe a map: its axes, its points by their status, its errors.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map of points.
    """
    about = dataset.attrs
    lines = [f"{MADE}: {about['title']}", *([about["estimated"]] if about["estimated"] else [])]
    for name in DIMS[1:]:
        axis = dataset[name]
        lines.append(f"  {axis.attrs['long_name']:32s} {axis.size:4d}  {float(axis[0]):.4g} to {float(axis[-1]):.4g} "
                     f"{axis.attrs['units']}")  # fmt: skip
    known = usable(dataset).values
    lines.append(f"  {'points with films':32s} {np.count_nonzero(known):4d}  of {known.size}")
    causes, counts = np.unique(reasons(dataset)[~known], return_counts=True)
    lines += [f"    {count:4d} without: {cause}" for cause, count in zip(causes, counts, strict=True)]
    for name in NUMBERS:
        errors = dataset[f"{name}_error"].values[known]
        middle, most = 100.0 * np.percentile(errors, (50.0, 95.0)) if errors.size else (np.nan, np.nan)
        lines.append(f"  error of {name:23s} median {middle:.2g} %, 95 of 100 points below {most:.2g} %")
    return "\n".join(lines)


def table(dataset: xr.Dataset) -> str:
    """A map as text: a row a point, SI.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map of points.
    """
    columns = [f"{name} [{dataset[name].attrs['units']}]" for name in DIMS[1:]]
    columns += [f"{name} [{dataset[name].attrs['units']}]" for name in NUMBERS]
    columns += [f"{name}_error" for name in NUMBERS]
    lines = [f"# table {MARK}: {dataset.attrs['title']}", ",".join([DIMS[0], *columns, "reason"])]
    axes = [dataset[name].values for name in DIMS]
    numbers = np.stack([dataset[name].values for name in (*NUMBERS, *(f"{name}_error" for name in NUMBERS))], axis=-1)
    causes = reasons(dataset)
    for place in np.ndindex(*numbers.shape[:-1]):
        at = [axis[i] for axis, i in zip(axes, place, strict=True)]
        row = ["" if np.isnan(number) else f"{number:.6g}" for number in numbers[place]]
        cause = str(causes[place]).replace('"', "'")
        lines.append(",".join([str(at[0]), *(f"{x:.9g}" for x in at[1:]), *row, f'"{cause}"' if cause else ""]))
    return "\n".join(lines) + "\n"
