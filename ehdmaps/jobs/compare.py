"""Differences between two maps on the points that they share."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.errors import MapError
from ehdmaps.jobs.report import AXES, span
from ehdmaps.maps.records import record_from_json
from ehdmaps.physics.solution import Status

COMPARED = ("stiffness", "damping", "approach", "film_offset", "central_film", "minimum_film", "max_pressure")

_SAME_AXIS_VALUE = 1e-9
"""Relative: what two ways of writing one number differ by."""

_PROVENANCE = ("solver", "solver_settings", "structural_law", "lubricant", "geometry", "contacts")


@dataclass(frozen=True)
class Difference:
    """How far one variable of two maps lies apart, over the points that both have solved.

    Attributes
    ----------
    variable : str
        Name of the variable.
    median, high, largest : float
        Median, 95 % quantile and largest value of |B - A|/|A|; NaN where no point can be compared.
    place : mapping
        Contact, load [N/m], entrainment speed [m/s] and temperature [K] of the largest; empty where there is none.
    left_out : int
        Points where A is zero.
    """

    variable: str
    median: float
    high: float
    largest: float
    place: Mapping[str, str | float]
    left_out: int


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two maps A and B, point by point.

    Attributes
    ----------
    names, titles : tuple of str
        What the maps are called here, and their own titles.
    points : tuple of int
        Points of each map.
    differing : tuple of str
        Attributes in which they differ.
    relative : xarray.Dataset
        (B - A)/A of each compared variable, on the points that both maps have; NaN where not both are solved, or A
        is zero and B is not.
    solved : int
        Points solved in both.
    differences : tuple of Difference
        One for each compared variable; none where no point is solved in both.
    """

    names: tuple[str, str]
    titles: tuple[str, str]
    points: tuple[int, int]
    differing: tuple[str, ...]
    relative: xr.Dataset
    solved: int
    differences: tuple[Difference, ...]

    @property
    def common(self) -> int:
        """Number of points that both maps have."""
        return int(self.relative[COMPARED[0]].size)


def compare(first: xr.Dataset, second: xr.Dataset, names: tuple[str, str]) -> Comparison:
    """Compare two maps on the points that they share.

    Parameters
    ----------
    first, second : xarray.Dataset
        The maps.
    names : tuple of str
        What messages call them.

    Raises
    ------
    MapError
        If they have no point in common.
    """
    here, there = _common(first, second, names)
    usable = _usable(here) & _usable(there)
    found = {name: _relative(here[name].values, there[name].values, usable) for name in COMPARED}
    left_out = {name: int(np.count_nonzero(usable & ~np.isfinite(values))) for name, values in found.items()}
    known = {name: np.where(np.isfinite(values), values, np.nan) for name, values in found.items()}
    dims = here["status"].dims
    return Comparison(
        names=names,
        titles=(str(first.attrs["title"]), str(second.attrs["title"])),
        points=(int(first["status"].size), int(second["status"].size)),
        differing=tuple(name for name in _PROVENANCE if _without_label(first, name) != _without_label(second, name)),
        relative=xr.Dataset({name: (dims, values) for name, values in known.items()}, coords=here.coords),
        solved=int(usable.sum()),
        differences=tuple(
            _difference(name, np.abs(known[name]), here, left_out[name]) for name in (COMPARED if usable.any() else ())
        ),
    )


def comparison_text(found: Comparison) -> str:
    """Return a comparison as the table that is printed."""
    return "\n".join(_lines(found))


def _lines(found: Comparison) -> Iterator[str]:
    yield f"A  {found.names[0]}: {found.titles[0]}"
    yield f"B  {found.names[1]}: {found.titles[1]}"
    yield f"   differ in {', '.join(found.differing)}" if found.differing else "   made from the same settings"
    yield (
        f"   {found.common} points in common, {found.solved} of them solved in both "
        f"(A has {found.points[0]}, B {found.points[1]})"
    )
    if found.differences:
        yield "relative difference |B - A|/|A|    median       95 %    largest  largest at"
    for entry in found.differences:
        note = f"  ({entry.left_out} points where A is zero left out)" if entry.left_out else ""
        if not entry.place:
            yield f"  {entry.variable:25s} no point to compare{note}"
            continue
        numbers = f"{entry.median:13.3g} {entry.high:10.3g} {entry.largest:10.3g}"
        yield f"  {entry.variable:25s} {numbers}  {_place(entry.place)}{note}"


def _without_label(dataset: xr.Dataset, name: str) -> object:
    """An attribute; of a record all that is more than shown."""
    text = dataset.attrs.get(name)
    if name not in ("lubricant", "geometry") or text is None:
        return text
    return {key: value for key, value in record_from_json(text, name).items() if key != "label"}


def _relative(a: FloatArray, b: FloatArray, usable: BoolArray) -> FloatArray:
    """Return (b - a)/a where both are usable: not finite where a alone is zero, NaN elsewhere."""
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(a == b, 0.0, (b - a) / a)
    return np.where(usable, relative, np.nan)


def _difference(name: str, size: FloatArray, here: xr.Dataset, left_out: int) -> Difference:
    """Sum up the sizes of the differences of one variable."""
    known = np.isfinite(size)
    if not known.any():
        return Difference(name, np.nan, np.nan, np.nan, {}, left_out)
    middle, high = (float(value) for value in np.quantile(size[known], (0.5, 0.95)))
    worst = np.unravel_index(int(np.argmax(np.where(known, size, -1.0))), size.shape)
    place: dict[str, str | float] = {"contact": str(here["contact"].values[worst[0]])}
    place |= {axis: float(here[axis].values[worst[position]]) for position, (axis, _) in enumerate(AXES, 1)}
    return Difference(name, middle, high, float(size[worst]), place, left_out)


def _place(place: Mapping[str, str | float]) -> str:
    """Say where a point lies."""
    return ", ".join([str(place["contact"]), *(display.text(float(place[name])) for name, display in AXES)])


def _usable(dataset: xr.Dataset) -> BoolArray:
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
