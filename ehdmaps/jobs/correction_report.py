"""What a map says of its correction by a dearer solver, in lines for `generate` and `show`."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.errors import MapError
from ehdmaps.jobs.correction import JUDGED
from ehdmaps.maps import schema
from ehdmaps.maps.records import MODEL_ERRORS, record_from_json
from ehdmaps.program import plain
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

_LEVELS = ("median", "95 %", "largest")
_WIDTH = 49
_USABLE = ("converged", "asymptote")


def correction_lines(dataset: xr.Dataset) -> Iterator[str]:
    """Yield by what a map is corrected, by how many points, and how well; nothing for a map that is not.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.

    Raises
    ------
    MapError
        If its attribute `correction` is not as `generate` writes it.
    """
    if schema.CORRECTION not in dataset.attrs:
        return
    try:
        lines = list(_lines(dataset, record_from_json(dataset.attrs[schema.CORRECTION], schema.CORRECTION)))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise MapError(
            f"attribute {schema.CORRECTION} is not as `ehdmaps generate` writes it; generate the map again"
        ) from error
    yield from lines


def unsolved(dataset: xr.Dataset) -> int:
    """Number of points that the correcting solver was asked for and that have no solution by both.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map, just made.
    """
    if schema.CORRECTION not in dataset.attrs:
        return 0
    record = record_from_json(dataset.attrs[schema.CORRECTION], schema.CORRECTION)
    return int(record["asked"]) - int(record["usable"])


def _lines(dataset: xr.Dataset, record: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of a correction."""
    settings = ", ".join(f"{plain(key).replace('_', ' ')} {plain(value)}" for key, value in record["settings"].items())
    yield f"correction by {plain(record['solver'])}{f' ({settings})' if settings else ''}"
    counts = f"{int(record['asked'])} points, {int(record['usable'])} of them with a solution by both solvers"
    yield f"  {counts}; {float(record['solve_seconds']):.3g} s of solving, all cores"
    failed = defaultdict(list)
    for point in record["points"]:
        if point["status"] not in _USABLE:
            failed[plain(point["status"])].append(point)
    for status, points in failed.items():
        yield f"  {status:17s} {len(points):7d}"
        for point in points:
            yield f"    {_place(point)}: {plain(point.get('reason', 'no reason given'))}"
    for name in record["not_applied"]:
        words = plain(name).replace("_", " ")
        yield f"  {words} left as it was: points left out one by one are no better with the correction"
    yield f"  {'difference from it, relative':{_WIDTH}s}" + "".join(f"{level:>11s}" for level in _LEVELS)
    for kind, words in (("before", "not corrected"), ("leave_one_out", "corrected, leaving out each point")):
        for name in JUDGED:
            values = "".join(f"{float(record[kind][name][level]):11.2g}" for level in _LEVELS)
            yield f"  {name.replace('_', ' ') + ', ' + words:{_WIDTH}s}{values}"
    for name in MODEL_ERRORS:
        known = dataset[name].values[np.isfinite(dataset[name].values)] if name in dataset else np.empty(0)
        if known.size:
            values = "".join(f"{value:11.2g}" for value in np.quantile(known, (0.5, 0.95, 1.0)))
            yield f"  {name.partition('_')[0] + ', one deviation, at all points':{_WIDTH}s}{values}"


def _place(point: Mapping[str, Any]) -> str:
    """Say where a point lies."""
    values = (("load", LOAD), ("entrainment_speed", SPEED), ("temperature", TEMPERATURE))
    place = ", ".join(display.text(float(point[name])) for name, display in values)
    return f"{plain(point['contact'])} at {place}"
