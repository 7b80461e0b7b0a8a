"""Whether a file or a dataset is a map: attributes, axes and variables held to the table of `schema`, and what is
derived to the films that it is derived from.

The shape that a file declares is checked before anything is loaded, so that a damaged or foreign file costs neither
memory nor time; values are checked when they are there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.errors import MapError
from ehdmaps.maps import schema
from ehdmaps.maps.records import contacts_of
from ehdmaps.maps.schema import Variable
from ehdmaps.maps.structure import contradictions

_AGAIN = "generate the map again"
_WHOLE, _REAL, _TEXT = "iu", "iuf", "OSUT"
"""Kinds of numpy types that may stand for whole numbers, for numbers and for texts."""

_MULTILINE = ("job_toml",)
"""Attributes that hold lines; the others are printed, so that they hold no control characters."""


def validate(dataset: xr.Dataset, where: str = "map", backbone: xr.Dataset | None = None) -> None:
    """Hold a dataset to the table, and what is derived to its films.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map.
    where : str
        File name, for the message.
    backbone : xarray.Dataset, optional
        Group of its refinement lines.

    Raises
    ------
    MapError
        With every problem found, one a line.
    """
    check_tables(dataset, where, backbone)
    refuse(contradictions(dataset, contacts_of(dataset)), where)


def check_tables(dataset: xr.Dataset, where: str = "map", backbone: xr.Dataset | None = None) -> None:
    """Hold a dataset to the table of its version; arguments as of `validate`.

    Raises
    ------
    MapError
        With every problem found, one a line.
    """
    refuse(version_problems(dataset.attrs), where)
    version = schema.version_of(dataset)
    problems = [*attribute_problems(dataset.attrs), *_grid_problems(dataset, version)]
    if backbone is not None:
        problems += [f"group {schema.BACKBONE}: {problem}" for problem in _backbone_problems(backbone, version)]
    refuse(problems, where)


def refuse(problems: Iterable[str], where: str) -> None:
    """Raise the problems, if there are any."""
    lines = [f"{where}: {problem}" for problem in problems]
    if lines:
        raise MapError("\n".join(lines))


def version_problems(attributes: Mapping[str, Any]) -> Iterator[str]:
    """Yield why the attributes are not those of a map of this version."""
    version = attributes.get("schema_version")
    if version is None:
        yield "has no attribute schema_version; expected a map written by `ehdmaps generate`"
    elif not isinstance(version, (int, np.integer)):
        yield f"attribute schema_version is {version!r:.60}, no whole number; {_AGAIN}"
    elif not 1 <= version <= schema.SCHEMA_VERSION:
        newer = "it was made by a newer one: update ehdmaps, or " if version > schema.SCHEMA_VERSION else ""
        yield f"schema_version is {version}; this ehdmaps reads 1 to {schema.SCHEMA_VERSION}; {newer}{_AGAIN}"


def attribute_problems(attributes: Mapping[str, Any]) -> Iterator[str]:
    """Yield which attributes are missing, or of a type that they do not have in a map."""
    for name in schema.ATTRIBUTES:
        if name not in attributes:
            yield f"attribute {name} is missing; {_AGAIN}"
    for name, value in attributes.items():
        if name not in (*schema.ATTRIBUTES, *schema.NUMBERS, *schema.TEXTS) and not name.startswith("law_"):
            continue
        number = isinstance(value, (int, float, np.integer, np.floating)) and math.isfinite(value)
        if name in schema.NUMBERS or name.endswith("_within_bar"):
            if not number:
                yield f"attribute {name} is {value!r:.60}; expected a finite number; {_AGAIN}"
        elif name == "schema_version" or (number and name not in schema.ATTRIBUTES):
            continue
        elif not isinstance(value, str):
            yield f"attribute {name} is {value!r:.60}; expected a text; {_AGAIN}"
        elif name not in _MULTILINE and not all(c.isprintable() or c == "\n" for c in value):
            yield f"attribute {name} is {value!r:.60}, with control characters; expected a plain text; {_AGAIN}"


def shape_problems(entry: Variable, dims: Sequence[str], shape: Sequence[int], kind: str) -> Iterator[str]:
    """Yield what is wrong with the shape and type that a variable is declared to have.

    Parameters
    ----------
    entry : Variable
        Row of the table.
    dims, shape : sequence
        Names and lengths of its dims, without that of the characters of a text.
    kind : str
        Kind of its numpy type.
    """
    what = _what(entry)
    if tuple(dims) != entry.dims:
        yield f"{what} has dims {tuple(map(str, dims))}; expected {entry.dims}; {_AGAIN}"
    allowed = _TEXT if entry.dtype == "str" else _WHOLE if entry.dtype.startswith("int") else _REAL
    if kind not in allowed:
        yield f"{what} has values of another type (kind {kind!r}); expected {entry.dtype}; {_AGAIN}"
    if math.prod(shape) > schema.MOST_POINTS:
        yield f"{what} has {' x '.join(map(str, shape))} values; allowed: at most {schema.MOST_POINTS}; {_AGAIN}"


def _grid_problems(dataset: xr.Dataset, version: int) -> Iterator[str]:
    """Yield what is wrong with the axes and variables of a map."""
    yield from _table_problems(dataset, schema.GRID, version)
    if "contact" in dataset.coords:
        names = tuple(str(name) for name in np.atleast_1d(dataset["contact"].values))
        if names not in schema.CONTACT_NAMES:
            yield f"contact holds {', '.join(names):.60}; expected inner, outer or line"


def _backbone_problems(group: xr.Dataset, version: int) -> Iterator[str]:
    """Yield what is wrong with the group of refinement lines."""
    if not isinstance(group.attrs.get(schema.REFERENCE_CONTACT), str):
        yield f"attribute {schema.REFERENCE_CONTACT} is missing or no text; {_AGAIN}"
    yield from _table_problems(group, schema.BACKBONE, version)
    together = schema.response_rows(version)
    lacking = [entry for entry in together if entry.name not in group.variables]
    if lacking and len(lacking) < len(together):
        held = ", ".join(entry.name for entry in together if entry not in lacking)
        yield from (f"{_what(entry)} is missing; it belongs to {held}; {_AGAIN}" for entry in lacking)
    own = [entry for entry in schema.table(schema.BACKBONE, version) if entry.name.startswith(schema.OWN)]
    if any(entry.name in group.variables for entry in own):
        there = [entry for entry in own if entry.name.removeprefix(schema.OWN) in group.variables]
        lost = [entry for entry in there if entry.name not in group.variables]
        yield from (
            f"{_what(entry)} is missing; it belongs to the lines of the outer contact; {_AGAIN}" for entry in lost
        )


def _table_problems(dataset: xr.Dataset, group: str, version: int) -> Iterator[str]:
    """Yield what is wrong with a dataset, by the rows of a group."""
    for entry in schema.table(group, version):
        held = dataset.coords if entry.axis else dataset.data_vars
        if entry.name not in held:
            if entry.required_in(version):
                yield f"{_what(entry)} is missing; {_AGAIN}"
            continue
        found = held[entry.name]
        yield from shape_problems(entry, list(map(str, found.dims)), found.shape, found.dtype.kind)
        if entry.dtype == "str":
            continue
        if found.attrs.get("units") != entry.units:
            yield f"{_what(entry)} has units {found.attrs.get('units')!r:.60}; expected {entry.units!r}"
        if found.dtype.kind in _REAL:
            yield from _value_problems(entry, found.values)


def _value_problems(entry: Variable, values: npt.NDArray[Any]) -> Iterator[str]:
    """Yield what is wrong with the numbers of an axis or a flag."""
    if entry.axis:
        yield from _axis_problems(entry, np.atleast_1d(values))
    elif entry.flags:
        known = [value for value, _ in entry.flags]
        unknown = np.setdiff1d(values, known)
        if unknown.size:
            yield f"{entry.name} holds {unknown[:5].tolist()}; expected {known}"


def _axis_problems(entry: Variable, values: npt.NDArray[Any]) -> Iterator[str]:
    """Yield what is wrong with a numeric axis."""
    what = _what(entry)
    low, high = entry.limits or (-math.inf, math.inf)
    if values.size == 0 or not np.all(np.isfinite(values)):
        yield f"{what} is empty or holds values that are not finite numbers"
    elif np.any(np.diff(values) <= 0):
        yield f"{what} does not rise from value to value"
    elif values[0] < low or values[-1] > high:
        wrong = values[0] if values[0] < low else values[-1]
        yield f"{what} holds {wrong:g} {entry.units}; allowed: {low:g} to {high:g}; {_AGAIN}"


def _what(entry: Variable) -> str:
    """What a variable is called in a message."""
    return f"{'coordinate' if entry.axis else 'variable'} {entry.name}"
