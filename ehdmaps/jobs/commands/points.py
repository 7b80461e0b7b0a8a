"""`ehdmaps generate`, `show`, `plot` and `export` of a ball bearing: its map of points."""

from __future__ import annotations

import argparse
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.errors import Problems
from ehdmaps.exports.mat import KIND as MATLAB
from ehdmaps.exports.mat import ascii_text, write_matlab
from ehdmaps.jobs.make.points_asked import MADE
from ehdmaps.jobs.make.points_map import (
    DIMS,
    KIND,
    SIDES,
    PointsRequest,
    points_map,
    read_points_map,
    reasons,
    usable,
    write_points_map,
)
from ehdmaps.jobs.solve.options import Options
from ehdmaps.outputs import FIGURE, MARK, TABLE, Output, check_outputs, write_figure, write_text
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.table.points.films import NUMBERS
from ehdmaps.units import SPEED, TEMPERATURE, quantity_between, short

_OF_LINES = (
    *("solver", "workers", "fresh", "fresh_films", "law_tolerance", "keep_cases"),
    *("structural_law", "supply", "roughness"),
)
"""Options of maps of line contacts."""

_OF_PANELS = ("quantity", "contact", "temperature")
"""Options of figures of such maps."""

EXPORTS = ("csv", "mat")
_POINT, _FASTEST = ("speed", "temperature", "contact"), 1e3


def run(arguments: argparse.Namespace, source: str) -> tuple[str, int]:
    """Make the map, or tell, draw or write what one holds.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of generate, show, plot or export.
    source : str
        Designation of the bearing, or file of the map.
    """
    names = (*_OF_LINES, *(_OF_PANELS if arguments.command == "plot" else ()))
    problems = Problems()
    Options(problems).refuse(arguments, names, "{}: is one of line contacts; allowed: without it")
    exported = arguments.command == "export"
    if exported and arguments.to not in EXPORTS:
        problems.append(
            f"--to: got {short(arguments.to)} for point contacts; allowed: {', '.join(EXPORTS)}; K and C of the "
            "bearing: mbs bearing -o k.csv; the bearing itself: -o NAME.c, NAME.fmu"
        )
    request = None
    if not os.path.exists(source):
        with problems:
            request = PointsRequest.named(source, arguments.oil)
        if exported and request is not None:
            request = _narrowed(request, arguments, problems)
    elif arguments.oil is not None:
        problems.append(f"--oil: got {short(arguments.oil)} beside a map; allowed: with --bearing")
    elif exported:
        beside = "{}: stands beside a map of points; allowed: with --bearing, read at that point"
        Options(problems).refuse(arguments, _POINT, beside)
    problems.check()
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
    if exported and arguments.to == "mat":
        kind, ending = MATLAB, ".mat"
    path = output or name.with_suffix(ending)
    if kind is not None:
        check_outputs([Output("-o", path, kind)], [] if request is not None else [name])
    dataset = read_points_map(name) if request is None else points_map(request)
    if exported and request is not None and (side := getattr(arguments, "contact", None)) is not None:
        dataset = dataset.sel(contact=[side])
    if kind is None:
        return described(dataset), 0
    if kind is FIGURE:
        from ehdmaps.jobs.show.points_plot import points_map_figure

        write_figure(points_map_figure(dataset), path)
    elif kind is MATLAB:
        write_matlab(path, {"map": matlab_struct(dataset)}, "export it as csv")
    else:
        write_text(path, table(dataset), TABLE)
    return f"{path}: written", 0


def _narrowed(request: PointsRequest, arguments: argparse.Namespace, problems: Problems) -> PointsRequest:
    """The request at the speed and temperature that were given, with so many loads."""
    chosen: dict[str, Any] = {}
    for name, field, unit, low, high, display in (
        ("speed", "speeds", "m/s", 0.0, _FASTEST, SPEED),
        ("temperature", "temperatures", "K", *OIL_TEMPERATURES, TEMPERATURE),
    ):
        text = getattr(arguments, name, None)
        if text is None:
            continue
        with problems.after(f"--{name}: "):
            chosen[field] = (quantity_between(text, unit, low, high, display),)
    contact = getattr(arguments, "contact", None)
    if contact not in (None, *SIDES):
        problems.append(f"--contact: got {short(contact)} for point contacts; allowed: {', '.join(SIDES)}")
    if getattr(arguments, "points", None) is not None and chosen:
        chosen["loads"] = arguments.points
        if arguments.points < 2:
            problems.append(f"--points: got {arguments.points}; allowed: 2 to 1024")
    return replace(request, **chosen)


def matlab_struct(dataset: xr.Dataset) -> dict[str, Any]:
    """A map as nested structs: axes, a struct a contact with arrays over load, speed, temperature, units, meaning.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map of points.
    """
    names = [*NUMBERS, *(f"{name}_error" for name in NUMBERS), "status", "cause"]
    content: dict[str, Any] = {axis: dataset[axis].values.astype(float)[:, None] for axis in DIMS[1:]}
    for side in dataset[DIMS[0]].values:
        content[str(side)] = {name: dataset[name].sel(contact=side).values.astype(float) for name in names}
    described = [*DIMS[1:], *names]
    content["units"] = {name: ascii_text(dataset[name].attrs.get("units", "1")) for name in described}
    content["meaning"] = {name: ascii_text(dataset[name].attrs["long_name"]) for name in described}
    lines = [dataset.attrs["title"], dataset.attrs["estimated"], f"causes: {dataset.attrs['causes']}"]
    content["header"] = np.array([ascii_text(line) for line in lines if line], dtype=object)[:, None]
    return content


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
