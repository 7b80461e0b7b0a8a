"""Differences between two maps on the points that they share."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.errors import MapError
from ehdmaps.jobs.report import AXES, span
from ehdmaps.maps.records import record_from_json
from ehdmaps.physics.solution import Status

COMPARED = ("stiffness", "damping", "approach", "film_offset", "central_film", "minimum_film", "max_pressure")
_SAME_AXIS_VALUE = 1e-9
"""Relative: what two ways of writing one number differ by."""

_PROVENANCE = ("solver", "solver_settings", "structural_law", "lubricant", "geometry", "contacts")


def compare(first: xr.Dataset, second: xr.Dataset, names: tuple[str, str]) -> str:
    """Return a table of the relative differences (second - first)/first.

    Parameters
    ----------
    first, second : xarray.Dataset
        The maps.
    names : tuple of str
        Of their files.

    Raises
    ------
    MapError
        If they have no point in common.
    """
    return "\n".join(_lines(first, second, names))


def _lines(first: xr.Dataset, second: xr.Dataset, names: tuple[str, str]) -> Iterator[str]:
    here, there = _common(first, second, names)
    yield f"A  {names[0]}: {first.attrs['title']}"
    yield f"B  {names[1]}: {second.attrs['title']}"
    differing = [name for name in _PROVENANCE if _without_label(first, name) != _without_label(second, name)]
    yield f"   differ in {', '.join(differing)}" if differing else "   made from the same settings"
    usable = _usable(here) & _usable(there)
    yield (
        f"   {here['status'].size} points in common, {int(usable.sum())} of them solved in both "
        f"(A has {first['status'].size}, B {second['status'].size})"
    )
    if not usable.any():
        return
    yield "relative difference |B - A|/|A|    median       95 %    largest  largest at"
    for name in COMPARED:
        yield _difference(name, here, there, usable)


def _without_label(dataset: xr.Dataset, name: str) -> object:
    """An attribute; of a record all that is more than shown."""
    text = dataset.attrs.get(name)
    if name not in ("lubricant", "geometry") or text is None:
        return text
    return {key: value for key, value in record_from_json(text, name).items() if key != "label"}


def _difference(name: str, here: xr.Dataset, there: xr.Dataset, usable: npt.NDArray[np.bool_]) -> str:
    """Return the table's line of one variable."""
    a, b = here[name].values, there[name].values
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.abs(b - a) / np.abs(a)
    relative = np.where(a == b, 0.0, relative)
    known = usable & np.isfinite(relative)
    zeros = int(np.count_nonzero(usable & ~np.isfinite(relative)))
    note = f"  ({zeros} points where A is zero left out)" if zeros else ""
    if not known.any():
        return f"  {name:25s} no point to compare{note}"
    middle, high = (float(value) for value in np.quantile(relative[known], (0.5, 0.95)))
    worst = np.unravel_index(int(np.argmax(np.where(known, relative, -1.0))), relative.shape)
    most = float(relative[worst])
    return f"  {name:25s} {middle:13.3g} {high:10.3g} {most:10.3g}  {_place(here, worst)}{note}"


def _place(dataset: xr.Dataset, index: tuple[Any, ...]) -> str:
    """Say where a point lies."""
    values = [
        display.text(float(dataset[name].values[index[position]])) for position, (name, display) in enumerate(AXES, 1)
    ]
    return ", ".join([str(dataset["contact"].values[index[0]]), *values])


def _usable(dataset: xr.Dataset) -> npt.NDArray[np.bool_]:
    """Whether a point was solved; filled ones were not."""
    return np.isin(dataset["status"].values, [int(status) for status in Status if status.usable])


def _common(first: xr.Dataset, second: xr.Dataset, names: tuple[str, str]) -> tuple[xr.Dataset, xr.Dataset]:
    """Return both maps on the points that they share."""
    here: dict[str, Any] = {}
    there: dict[str, Any] = {}
    contacts = [str(name) for name in first["contact"].values if name in second["contact"].values]
    if not contacts:
        raise MapError(
            f"{names[0]} and {names[1]}: contacts are {', '.join(map(str, first['contact'].values))} and "
            f"{', '.join(map(str, second['contact'].values))}; allowed: maps that share a contact"
        )
    here["contact"] = [list(map(str, first["contact"].values)).index(name) for name in contacts]
    there["contact"] = [list(map(str, second["contact"].values)).index(name) for name in contacts]
    for name, display in AXES:
        a, b = first[name].values, second[name].values
        rows, columns = np.nonzero(np.abs(a[:, None] - b[None, :]) <= _SAME_AXIS_VALUE * np.abs(a[:, None]))
        if rows.size == 0:
            raise MapError(
                f"{names[0]} and {names[1]}: no {name} in common ({a.size} values, {span(a, display)}, "
                f"against {b.size}, "
                f"{span(b, display)}); allowed: maps that share points; generate one of them on the "
                "other's axis"
            )
        here[name], there[name] = rows, columns
    return first.isel(here), second.isel(there)
