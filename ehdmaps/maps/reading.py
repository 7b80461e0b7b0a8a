"""A map file as datasets: only what the table of its version names is read, and nothing before its declared shape is
known.

Read with netCDF4 itself: xarray would load every axis of a file and decode every variable, foreign ones too, before
anybody could look at their sizes.
"""

from __future__ import annotations

import stat
from collections.abc import Iterator, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.errors import MapError
from ehdmaps.maps import schema
from ehdmaps.maps.schema import Variable
from ehdmaps.maps.validation import attribute_problems, refuse, shape_problems, version_problems
from ehdmaps.netcdf_structure import DAMAGE, structure_problem

_OF_THE_FILE = ("_FillValue", "_Encoding", "_Unsigned", "missing_value", "coordinates")
"""Attributes that say how values are stored; values themselves are read as they are."""

_SCALED = ("scale_factor", "add_offset")


def read_map(path: str | PathLike[str]) -> tuple[xr.Dataset, xr.Dataset | None]:
    """Read the grid of a map file and its backbone, None where it has none.

    Raises
    ------
    MapError
        If it cannot be read, or its attributes, dims, types or sizes are not those of a map.
    """
    name = fspath(path)
    try:
        if not stat.S_ISREG(Path(name).stat().st_mode):
            raise OSError("no regular file")
        damage = structure_problem(name)
        if damage:
            raise OSError(damage)
        with netCDF4.Dataset(name) as file:
            return _read(file, name)
    except DAMAGE as error:
        cause = " ".join(str(error).split()) or type(error).__name__
        raise MapError(
            f"{name}: cannot be read ({cause:.300}); expected a map file written by `ehdmaps generate`"
        ) from error


def _read(file: Any, where: str) -> tuple[xr.Dataset, xr.Dataset | None]:
    """Read an open file: first all that it declares, then the values."""
    attributes = _attributes(file)
    refuse(version_problems(attributes), where)
    version = int(attributes["schema_version"])
    grid, refined = schema.table(schema.GRID, version), schema.table(schema.BACKBONE, version)
    group = file.groups.get(schema.BACKBONE)
    problems = [*attribute_problems(attributes), *_declared_problems(file, grid)]
    if group is not None:
        problems += [f"group {schema.BACKBONE}: {problem}" for problem in _declared_problems(group, refined)]
    refuse(problems, where)
    backbone = None if group is None else _dataset(group, refined, _attributes(group))
    return _dataset(file, grid, attributes), backbone


def _attributes(holder: Any) -> dict[str, Any]:
    """Attributes of a file, group or variable."""
    return {name: holder.getncattr(name) for name in holder.ncattrs()}


def _declared_problems(group: Any, entries: Sequence[Variable]) -> Iterator[str]:
    """Yield what is wrong with the variables that a file declares; what it lacks is seen later."""
    for entry in entries:
        found = group.variables.get(entry.name)
        if found is None:
            continue
        dims, shape = found.dimensions, found.shape
        if _is_characters(found):
            if shape and np.prod(shape, dtype=float) > schema.LONGEST_TEXTS:
                yield f"variable {entry.name} has {' x '.join(map(str, shape))} characters; generate the map again"
            dims, shape = dims[:-1], shape[:-1]
        yield from shape_problems(entry, dims, shape, "U" if found.dtype is str else np.dtype(found.dtype).kind)
        if any(name in found.ncattrs() for name in _SCALED):
            yield f"variable {entry.name} is packed (attribute scale_factor or add_offset); save it as it is"


def _is_characters(variable: Any) -> bool:
    """Whether a variable holds single characters, the last dim being that of the text."""
    return variable.dtype is not str and np.dtype(variable.dtype) == np.dtype("S1") and bool(variable.dimensions)


def _dataset(group: Any, entries: Sequence[Variable], attributes: dict[str, Any]) -> xr.Dataset:
    """Read the variables of the table."""
    variables = {entry.name: _variable(group.variables[entry.name], entry) for entry in entries if _has(group, entry)}
    axes = {entry.name for entry in entries if entry.axis}
    return xr.Dataset(
        {name: found for name, found in variables.items() if name not in axes},
        coords={name: found for name, found in variables.items() if name in axes},
        attrs=attributes,
    )


def _has(group: Any, entry: Variable) -> bool:
    """Whether a file has a variable."""
    return entry.name in group.variables


def _variable(found: Any, entry: Variable) -> xr.Variable:
    """Read one variable."""
    found.set_auto_maskandscale(False)
    found.set_auto_chartostring(False)
    values = np.asarray(found[...])
    if _is_characters(found):
        values = _texts(values)
    elif entry.dtype == "str":
        values = values.astype(object)
    attributes = {name: value for name, value in _attributes(found).items() if name not in _OF_THE_FILE}
    return xr.Variable(entry.dims, values, attributes, entry.encoding())


def _texts(characters: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Texts of an array of characters in UTF-8, along its last axis."""
    *shape, length = characters.shape
    if length == 0:
        return np.full(shape, "", dtype=object)
    words = np.ascontiguousarray(characters).view(f"S{length}")[..., 0]
    known, places = np.unique(words, return_inverse=True)
    return np.array([word.decode() for word in known], dtype=object)[places].reshape(shape)
