"""The map file: names, dims, units, types and meanings of everything in it, in one table.

Both sides stand on this table: `jobs` writes by it, `maps` and `mbs` read by it, and `validate` holds a file
to it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.errors import MapError
from ehdmaps.physics.solution import Status

SCHEMA_VERSION = 1
"""Raised when a reader of the old file would misread the new one."""

DIMS = ("contact", "load", "entrainment_speed", "temperature")
"""Order of the dims of every map variable."""

CONTACT_NAMES = (("inner", "outer"), ("line",))
"""What the contact axis may hold: both raceways of a bearing, or one bare line contact."""

BACKBONE_GROUP = "backbone"
"""netCDF group with the refinement lines of the contact law, where a map has them."""


@dataclass(frozen=True)
class Variable:
    """One variable of the map file.

    Attributes
    ----------
    name, units, long_name : str
        As in the file; units in UDUNITS form, "1" for a pure number.
    dtype : str
        numpy type, or "str".
    required : bool
        Whether a map without it is broken.
    flags : tuple of (int, str)
        CF flag values and meanings, where the variable is a flag.
    dims : tuple of str
        Its dims; a coordinate has itself.
    """

    name: str
    units: str
    long_name: str
    dtype: str = "float64"
    required: bool = True
    flags: tuple[tuple[int, str], ...] = ()
    dims: tuple[str, ...] = DIMS

    def attributes(self) -> dict[str, Any]:
        """Return the CF attributes of the variable."""
        attributes: dict[str, Any] = {"units": self.units, "long_name": self.long_name}
        if self.flags:
            attributes["flag_values"] = np.array([value for value, _ in self.flags], dtype=self.dtype)
            attributes["flag_meanings"] = " ".join(meaning for _, meaning in self.flags)
        return attributes

    def encoding(self) -> dict[str, Any]:
        """Return how xarray stores it: numbers compressed (netCDF cannot compress strings)."""
        if self.dtype == "str":
            return {"dtype": "str"}
        return {"dtype": self.dtype, "zlib": True, "complevel": 4, "shuffle": True}


_NO_YES = ((0, "no"), (1, "yes"))

COORDINATES = (
    Variable("contact", "1", "contact of the roller with this raceway", "str", dims=("contact",)),
    Variable("load", "N m-1", "load per unit length", dims=("load",)),
    Variable("entrainment_speed", "m s-1", "mean of the two surface speeds", dims=("entrainment_speed",)),
    Variable("temperature", "K", "oil temperature", dims=("temperature",)),
)

VARIABLES = (
    Variable("approach", "m", "mutual approach of the bodies, positive together"),
    Variable("film_offset", "m", "dry minus lubricated approach at equal load"),
    Variable("stiffness", "N m-2", "stiffness per unit length, derivative of load by approach"),
    Variable("damping", "N s m-2", "damping per unit length, low-frequency limit"),
    Variable("central_film", "m", "film thickness at the contact centre"),
    Variable("minimum_film", "m", "smallest film thickness"),
    Variable("max_pressure", "Pa", "largest pressure"),
    Variable("friction_force", "N m-1", "friction force per unit length", required=False),
    Variable("status", "1", "how the point ended", "int8", flags=tuple((int(s), s.word) for s in Status)),
    Variable("reason", "1", "cause of the status, in words", "str"),
    Variable("film_offset_error", "1", "estimated relative numerical error of film_offset"),
    Variable("film_compliance_error", "1", "estimated relative numerical error of 1/stiffness minus its dry part"),
    Variable("stiffness_error", "1", "estimated relative numerical error of stiffness"),
    Variable("damping_error", "1", "estimated relative numerical error of damping"),
    Variable("iterations", "1", "iterations of the solver, all grids together", "int32"),
    Variable("solve_seconds", "s", "time to solve the point"),
    Variable(
        "viscosity_extrapolated",
        "1",
        "pressure beyond the fitted range of the viscosity",
        "int8",
        flags=_NO_YES,
    ),
    Variable("filled", "1", "values interpolated from neighbours; status keeps the cause", "int8", flags=_NO_YES),
)

ATTRIBUTES = {
    "schema_version": "version of this file format",
    "job_toml": "exact text of the job file",
    "job_sha256": "sha256 of that text",
    "solver": "name of the solver that made the map",
    "solver_settings": "JSON: everything that changes its numbers",
    "structural_law": "law of the elastic part of the approach",
    "contacts": "JSON: one record a contact, in the order of the contact axis",
    "geometry": "JSON: the bearing, or null for a bare contact",
    "lubricant": "JSON: the oil",
    "package_versions": "JSON: versions of ehdmaps and of the libraries under it",
}
"""Attributes that every map has, and what they hold."""


def variable(name: str) -> Variable:
    """Return the table's entry of a variable or coordinate.

    Raises
    ------
    KeyError
        If the table has no such name.
    """
    return _BY_NAME[name]


_BY_NAME = {entry.name: entry for entry in COORDINATES + VARIABLES}


def dataset(coordinates: dict[str, Any], values: dict[str, Any], attributes: dict[str, Any]) -> xr.Dataset:
    """Build a dataset with the units, names and types of the table.

    Parameters
    ----------
    coordinates : dict
        The four axes by name, SI.
    values : dict
        Arrays by variable name, dims in the order of `DIMS`, SI.
    attributes : dict
        Attributes of the file (see `ATTRIBUTES`).
    """
    built = xr.Dataset(
        {name: _typed(variable(name), data) for name, data in values.items()},
        coords={name: _typed(variable(name), data) for name, data in coordinates.items()},
        attrs=attributes,
    )
    for name in built.variables:
        built[name].encoding = variable(str(name)).encoding()
    return built


def _typed(entry: Variable, data: Any) -> xr.Variable:
    """Give an array the dims, type and attributes of its entry."""
    array = np.asarray(data, dtype=object if entry.dtype == "str" else entry.dtype)
    return xr.Variable(entry.dims, array, entry.attributes())


def validate(opened: xr.Dataset, where: str = "map") -> None:
    """Hold a dataset to the table.

    Parameters
    ----------
    opened : xarray.Dataset
        What was read from a map file.
    where : str
        File name, for the message.

    Raises
    ------
    MapError
        With every problem found, one a line.
    """
    problems = list(_problems(opened))
    if problems:
        raise MapError("\n".join(f"{where}: {problem}" for problem in problems))


def _problems(opened: xr.Dataset) -> Iterable[str]:
    """Yield what is wrong with a dataset."""
    version = opened.attrs.get("schema_version")
    if version is None:
        yield "has no attribute schema_version; expected a map written by `ehdmaps generate`"
        return
    if version != SCHEMA_VERSION:
        yield f"schema_version is {version}; this ehdmaps reads {SCHEMA_VERSION}; generate the map again"
        return
    for name in ATTRIBUTES:
        if name not in opened.attrs:
            yield f"attribute {name} is missing; generate the map again"
    for entry in COORDINATES:
        if entry.name not in opened.coords:
            yield f"coordinate {entry.name} is missing; generate the map again"
        elif entry.name != "contact":
            yield from _axis_problems(entry, opened)
    if "contact" in opened.coords:
        names = tuple(str(name) for name in np.atleast_1d(opened["contact"].values))
        if names not in CONTACT_NAMES:
            yield f"contact holds {', '.join(names)}; expected inner, outer or line"
    for entry in VARIABLES:
        if entry.name not in opened.data_vars:
            if entry.required:
                yield f"variable {entry.name} is missing; generate the map again"
            continue
        found = opened[entry.name]
        if found.dims != entry.dims:
            yield f"variable {entry.name} has dims {tuple(map(str, found.dims))}; expected {entry.dims}"
        if found.attrs.get("units") != entry.units:
            yield f"variable {entry.name} has units {found.attrs.get('units')!r}; expected {entry.units!r}"
    if "status" in opened.data_vars:
        known = [int(status) for status in Status]
        unknown = np.setdiff1d(opened["status"].values, known)
        if unknown.size:
            yield f"status holds {unknown[:5].tolist()}; expected {known}"


def _axis_problems(entry: Variable, opened: xr.Dataset) -> Iterable[str]:
    """Yield what is wrong with a numeric axis."""
    axis = opened[entry.name]
    if axis.attrs.get("units") != entry.units:
        yield f"coordinate {entry.name} has units {axis.attrs.get('units')!r}; expected {entry.units!r}"
    values = np.atleast_1d(axis.values)
    if not np.issubdtype(values.dtype, np.number) or values.size == 0 or not np.all(np.isfinite(values)):
        yield f"coordinate {entry.name} is empty or holds values that are not finite numbers"
    elif np.any(np.diff(values) <= 0):
        yield f"coordinate {entry.name} does not rise from value to value"
