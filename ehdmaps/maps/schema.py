"""The map file: names, dims, units, types and meanings of everything in it, in one table.

Both sides stand on this table: `jobs` writes by it, `maps` and `mbs` read by it, and `validation` holds a file to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.physics.solution import Status

SCHEMA_VERSION = 1
"""Raised when a reader of the old file would misread the new one."""

DIMS = ("contact", "load", "entrainment_speed", "temperature")
"""Order of the dims of every map variable."""

CONTACT_NAMES = (("inner", "outer"), ("line",))
"""What the contact axis may hold: both raceways of a bearing, or one bare line contact."""

BACKBONE_GROUP = "backbone"
"""netCDF group with the refinement lines of the contact law, where a map has them."""

BACKBONE_DIMS = ("zeta", "reference_speed", "temperature")
"""Order of the dims of every variable of that group."""

NOT_NEEDED = -1
"""Status of a place of the backbone that no contact of the map comes to."""

MOST_POINTS = 2_000_000
"""Largest number of values of one variable; a file that declares more is no map."""

LONGEST_TEXTS = 2**31
"""Most bytes of one variable of texts."""


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
        """Return how xarray stores it: compressed; texts as characters, which Octave and old MATLAB can read."""
        if self.dtype == "str":
            length = f"{self.name}_length"
            return {"dtype": "S1", "_Encoding": "utf-8", "char_dim_name": length, "zlib": True, "complevel": 4}
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
    Variable("central_film_error", "1", "estimated relative numerical error of central_film", required=False),
    Variable("minimum_film_error", "1", "estimated relative numerical error of minimum_film", required=False),
    Variable("max_pressure_error", "1", "estimated relative numerical error of max_pressure", required=False),
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

BACKBONE_COORDINATES = (
    Variable("zeta", "1", "ln(M/M_valley(L))", dims=("zeta",)),
    Variable("reference_speed", "m s-1", "entrainment speed of the reference contact", dims=("reference_speed",)),
    Variable("temperature", "K", "oil temperature", dims=("temperature",)),
)

BACKBONE_VARIABLES = (
    Variable("film_offset", "m", "dry minus lubricated approach at equal load, reference contact", dims=BACKBONE_DIMS),
    Variable(
        "film_compliance",
        "m2 N-1",
        "minus the derivative of the film offset by load, reference contact",
        dims=BACKBONE_DIMS,
    ),
    Variable(
        "loss_compliance",
        "m2 s N-1",
        "damping over squared stiffness, low-frequency limit, reference contact",
        dims=BACKBONE_DIMS,
    ),
    Variable(
        "status",
        "1",
        "how the point ended; -1: no contact of the map comes here",
        "int8",
        flags=((NOT_NEEDED, "not_needed"), *((int(s), s.word) for s in Status)),
        dims=BACKBONE_DIMS,
    ),
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
"""Attributes that every map has, and what they hold: a whole number the first, texts the others."""

NUMBERS = ("lubricant_verified", "structural_scaling")
"""Attributes that are numbers, where a map has them; those of the check of the laws, `law_*`, may be."""

CHECKSUM = "content_sha256"
"""Attribute with the checksum of everything that a law or a reader of the map relies on; see `checksum`."""

TEXTS = ("title", "job_name", "created", "fill", "solver_version", "openfoam_version", "openfoam_build", CHECKSUM)
"""Attributes that are texts, where a map has them; others than those named here are left alone."""

REFERENCE_CONTACT = "reference_contact"
"""Attribute of the backbone, JSON: the contact that it was solved for."""


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
    return _built(_BY_NAME, coordinates, values, attributes)


def backbone(coordinates: dict[str, Any], values: dict[str, Any], attributes: dict[str, Any]) -> xr.Dataset:
    """Build the group of refinement lines; arguments as for `dataset`, dims in the order of `BACKBONE_DIMS`."""
    entries = {entry.name: entry for entry in BACKBONE_COORDINATES + BACKBONE_VARIABLES}
    return _built(entries, coordinates, values, attributes)


def _built(
    entries: dict[str, Variable], coordinates: dict[str, Any], values: dict[str, Any], attributes: dict[str, Any]
) -> xr.Dataset:
    """Build a dataset by a table."""
    built = xr.Dataset(
        {name: _typed(entries[name], data) for name, data in values.items()},
        coords={name: _typed(entries[name], data) for name, data in coordinates.items()},
        attrs=attributes,
    )
    for name in built.variables:
        built[name].encoding = entries[str(name)].encoding()
    return built


def _typed(entry: Variable, data: Any) -> xr.Variable:
    """Give an array the dims, type and attributes of its entry."""
    array = np.asarray(data, dtype=object if entry.dtype == "str" else entry.dtype)
    return xr.Variable(entry.dims, array, entry.attributes())
