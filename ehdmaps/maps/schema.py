"""The map file: names, dims, units, types and meanings of everything in it, in one table.

Both sides stand on this table: `jobs` writes by it, `maps` and `mbs` read by it, and `validation` holds a file to it,
the grid and the group "backbone" alike.

What a solver finds is the film: film offset, film compliance and loss compliance. They are stored, and laws are made
from them. Approach, stiffness and damping also contain the solids, by a structural law that the reader may choose:
they are derived, see `ehdmaps.maps.records`. They are written too, for other programs, by the structural law of the
job; no law reads them.

Versions
--------
Every change of the table raises `SCHEMA_VERSION`, and each row says since which version it is there. A file is read by
the table of its own version:

- a file of a higher version is refused, since nobody can know what its new rows mean;
- a file of a lower version is read as it was written; what it lacks is derived or missing;
- a variable, group or attribute that the table of the file's version does not name belongs to somebody else: it is
  neither read nor checked, whatever it is called.

Version 2 added film compliance, loss compliance and its error to the grid; version 1 had approach, stiffness and
damping in their place. Version 3 added rolling force and mass flow, with their errors, and the film compliance at
natural frequencies to the backbone, where the solver has it: complex, in units of the film alone, over
omega sqrt(b^2 + 2 h R)/u with b and the film offset h of each point. Version 4 added the model errors of stiffness and
damping, of a map whose films are corrected by a dearer solver. Version 5 added traction, wall stress and temperatures
of films, where the solver finds them, and to the backbone the films of the outer contact, where heat makes them its
own. Version 7 added the errors of temperatures. Version 8 added what laws lose between the points of a map
without lines.

To add a variable, write one row in `variables.toml` with ``since`` the new version, and raise `SCHEMA_VERSION`. With
``required = false`` a map may lack it. It is then written, where `dataset` or `backbone` is given values for it, read,
checked and sealed by the checksum. To add an axis (a frequency, a slide-to-roll ratio), write one row whose only dim is
its own name, with the limits of its values, and ``required = false``; the variables over it are rows of their own that
name it in their dims. The dims of a row that is there already never change: old readers of old rows stay right.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from importlib import resources
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.physics.solution import Status

if TYPE_CHECKING:
    import xarray as xr

SCHEMA_VERSION = 8
"""Version of the table; files of this and of all lower versions are read."""

DIMS = ("contact", "load", "entrainment_speed", "temperature")
"""Order of the dims of every map variable."""

CONTACT_NAMES = (("inner", "outer"), ("line",))
"""What the contact axis may hold: both raceways of a bearing, or one bare line contact."""

GRID = ""
"""The group of the map's points: the root of the file."""

BACKBONE = "backbone"
"""netCDF group with the refinement lines of the contact law, where a map has them."""

BACKBONE_DIMS = ("zeta", "reference_speed", "temperature")
"""Order of the dims of the films of that group."""

NATURAL = "natural_frequency"
"""Axis of how these films answer."""

OWN = "outer_"
"""How the films of the outer contact begin where it has lines of its own, on the axes of those of the inner one.

Films with heat are no functions of M and L alone: contacts do not share their lines. The reference contact is then the
inner one, and the outer one is its own.
"""

NOT_NEEDED = -1
"""Status of a place of the backbone that no contact of the map comes to."""

MOST_POINTS = 2_000_000
"""Largest number of values of one variable; a file that declares more is no map."""

LONGEST_TEXTS = 2**31
"""Most bytes of one variable of texts."""


_DERIVED = "derived from the films by the structural law of the map; contact laws do not read it"


@dataclass(frozen=True)
class Variable:
    """One variable or axis of the map file: a row of the table.

    Attributes
    ----------
    name, units, long_name : str
        Words as in the file; units in UDUNITS form, "1" for a pure number.
    dtype : str
        numpy type, or "str".
    required : bool
        Whether a map without it is broken.
    flags : tuple of (int, str)
        CF flag values and meanings, where the variable is a flag.
    dims : tuple of str
        Names of its dims; an axis has itself.
    group : str
        `GRID` or `BACKBONE`.
    since : int
        Version from which on it is in the table.
    derived_since : int, optional
        Version from which on it follows from the others by the structural law: a file may lack it then.
    limits : (float, float), optional
        Limits of an axis of numbers: far outside of what a job may ask for; what lies beyond is damage, and would
        overflow somewhere.
    """

    name: str
    units: str
    long_name: str
    dtype: str = "float64"
    required: bool = True
    flags: tuple[tuple[int, str], ...] = ()
    dims: tuple[str, ...] = DIMS
    group: str = GRID
    since: int = 1
    derived_since: int | None = None
    limits: tuple[float, float] | None = None

    @property
    def axis(self) -> bool:
        """True where it is an axis."""
        return self.dims == (self.name,)

    @property
    def derived(self) -> bool:
        """True where it follows from other variables by the structural law."""
        return self.derived_since is not None

    def required_in(self, version: int) -> bool:
        """Tell whether a file of that version has to have it."""
        return self.required and not (self.derived_since is not None and version >= self.derived_since)

    def attributes(self) -> dict[str, Any]:
        """Return the CF attributes of the variable."""
        attributes: dict[str, Any] = {"units": self.units, "long_name": self.long_name}
        if self.flags:
            attributes["flag_values"] = np.array([value for value, _ in self.flags], dtype=self.dtype)
            attributes["flag_meanings"] = " ".join(meaning for _, meaning in self.flags)
        if self.derived:
            attributes["comment"] = _DERIVED
        return attributes

    def encoding(self) -> dict[str, Any]:
        """Return how xarray stores it: compressed; texts as characters, which Octave and old MATLAB can read."""
        if self.dtype == "str":
            length = f"{self.name}_length"
            return {"dtype": "S1", "_Encoding": "utf-8", "char_dim_name": length, "zlib": True, "complevel": 4}
        return {"dtype": self.dtype, "zlib": True, "complevel": 4, "shuffle": True}


_NO_YES = ((0, "no"), (1, "yes"))

_STATUS = tuple((int(status), status.word) for status in Status)


_FLAGS = {"no_yes": _NO_YES, "status": _STATUS, "status_or_not_needed": ((NOT_NEEDED, "not_needed"), *_STATUS)}
"""Flags by their names in the table."""


def _rows() -> Iterator[Variable]:
    """Rows of the table; behind those of the backbone the films of the outer contact, see `OWN`."""
    text = (resources.files(__package__) / "variables.toml").read_text(encoding="utf-8")
    for group, dims, rows in zip((GRID, BACKBONE), (DIMS, BACKBONE_DIMS), tomllib.loads(text).values(), strict=True):
        for row in rows:
            lists = {key: tuple(row[key]) for key in ("dims", "limits") if key in row}
            flags = {"flags": _FLAGS[row["flags"]]} if "flags" in row else {}
            yield Variable(**{"dims": dims, **row, **lists, **flags, "group": group})


def _own(entry: Variable) -> Variable:
    """Row of a film of the outer contact, like that of the reference contact; see `OWN`."""
    words = entry.long_name.replace("reference contact", "outer contact")
    return replace(entry, name=f"{OWN}{entry.name}", long_name=words, required=False, since=5)


_STATED = tuple(_rows())

TABLE = (*_STATED, *(_own(entry) for entry in _STATED if entry.group == BACKBONE and not entry.axis))
"""All rows, in the order in which they are written."""

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

ASSUMED = "job_assumed"
"""Attribute of a map whose job leaves oil, axes or solver to the program: what it took, in words."""

OIL_SUPPLY = "oil_supply"
"""Attribute of a map whose job states the oil supply of its contacts, JSON: what its laws have by default.

The points of a map are those of flooded films, whatever it says.
"""

SURFACE = "surface"
"""Attribute of a map whose job states rough surfaces, JSON: what its laws have by default.

The points of a map are those of smooth surfaces, whatever it says.
"""

CORRECTION = "correction"
"""Attribute of a map whose films are corrected, JSON: the dearer solver, its points, the errors of leaving one out."""

FILM_TABLE = "film_table"
"""Attribute of a map whose points were read from the film table, as its laws are: checksum of that table."""

UNSERVED = "film_table_unserved"
"""Attribute of a map whose films were to be read from the film table, and were solved: why."""

OWN_POINTS = "own_points"
"""Attribute of a map whose points are its user's own: why neither film table nor refinement lines stand for them."""

CODE = "code_hash"
"""Attribute with the hash of all that the map was computed with, see `ehdmaps.provenance.code_hash`."""

TEXTS = (
    "title",
    "job_name",
    ASSUMED,
    "created",
    "fill",
    "solver_version",
    "openfoam_version",
    "openfoam_build",
    OIL_SUPPLY,
    SURFACE,
    CORRECTION,
    FILM_TABLE,
    UNSERVED,
    OWN_POINTS,
    CODE,
    CHECKSUM,
)
"""Attributes that are texts, where a map has them; others than those named here are left alone."""

SEAL = "points_sha256"
"""Attribute of the backbone: checksum of the points of the map that it was made with, see `ehdmaps.maps.reading`."""

REFERENCE_CONTACT = "reference_contact"
"""Attribute of the backbone, JSON: the contact that it was solved for."""


def table(group: str = GRID, version: int | None = None) -> tuple[Variable, ...]:
    """Return the rows of a group in files of a version, of the latest one if left out."""
    latest = SCHEMA_VERSION if version is None else version
    return tuple(entry for entry in TABLE if entry.group == group and entry.since <= latest)


def response_rows(version: int) -> tuple[Variable, ...]:
    """Return the rows of the backbone that say how its films answer: a file of that version has all of them or none."""
    return tuple(
        entry for entry in table(BACKBONE, version) if NATURAL in entry.dims and not entry.name.startswith(OWN)
    )


def version_of(dataset: xr.Dataset) -> int:
    """Version of the table that a dataset of the root group was made by."""
    return int(dataset.attrs["schema_version"])


def variable(name: str, group: str = GRID) -> Variable:
    """Return the row of a variable or axis.

    Raises
    ------
    KeyError
        If the table has no such name.
    """
    for entry in table(group):
        if entry.name == name:
            return entry
    raise KeyError(name)


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
    return _built(GRID, coordinates, values, attributes)


def backbone(coordinates: dict[str, Any], values: dict[str, Any], attributes: dict[str, Any]) -> xr.Dataset:
    """Build the group of refinement lines; arguments as for `dataset`, dims in the order of `BACKBONE_DIMS`."""
    return _built(BACKBONE, coordinates, values, attributes)


def typed(entry: Variable, data: Any) -> xr.Variable:
    """Give an array the dims, type, attributes and encoding of its row."""
    import xarray as xr  # a third of a second, which laws of the film table do without

    array = np.asarray(data, dtype=object if entry.dtype == "str" else entry.dtype)
    return xr.Variable(entry.dims, array, entry.attributes(), entry.encoding())


def _built(group: str, coordinates: dict[str, Any], values: dict[str, Any], attributes: dict[str, Any]) -> xr.Dataset:
    """Build a dataset by the rows of a group."""
    import xarray as xr

    return xr.Dataset(
        {name: typed(variable(name, group), data) for name, data in values.items()},
        coords={name: typed(variable(name, group), data) for name, data in coordinates.items()},
        attrs=attributes,
    )
