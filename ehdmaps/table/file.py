"""The file of the film table: a netCDF file with provenance, checksum and a group for each part of each density law.

It is read by netCDF4 alone: a table opens in some 20 ms.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import ByteArray, FloatArray
from ehdmaps.errors import MapError
from ehdmaps.netcdf_structure import DAMAGE, opened
from ehdmaps.outputs import MADE_AS
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.table.fields import FIELDS
from ehdmaps.table.films import FilmTable
from ehdmaps.table.interpolation import Axes
from ehdmaps.table.nodes import Nodes, nodes_problem

SHIPPED = "film_table.nc"
"""Name of the shipped file in this package."""

KIND, FORMAT, CHECKSUM = "film table", "2", "content_sha256"

AXES = ("zeta", "size", "alpha", "bend")
_MEANING = {
    "piezoviscous": (
        ("ln(M/M_valley(L)) - shift(L, alpha, z), see ehdmaps.table.coordinates", "1"),
        ("ln L, of Moes' oil number L", "1"),
        ("ln alpha, alpha = d ln eta/dp at p = 0 in 1/Pa", "1"),
        ("(1 - z) sqrt(17/GPa / alpha) with the exponent z of Roelands' law", "1"),
    ),
    "isoviscous": (
        ("ln(M/M_valley(L)) - shift(L, alpha, z), see ehdmaps.table.coordinates", "1"),
        ("ln(L/alpha), L/alpha in Pa", "1"),
        ("alpha = d ln eta/dp at p = 0", "1/Pa"),
        ("1 - z, z the exponent of Roelands' law", "1"),
    ),
}
"""Parts of a table, and what their axes mean."""

_BITS = 16
"""Binary digits of a value that are kept: behind the point, or of its mantissa where it is smaller than one."""


@dataclass(frozen=True, eq=False)
class TableFile:
    """Contents of a file of films.

    Attributes
    ----------
    tables : mapping of str to FilmTable
        Tables by density law.
    attributes : mapping of str to str
        Provenance of the tables, by name.
    """

    tables: Mapping[str, FilmTable]
    attributes: Mapping[str, str]

    def of(self, lubricant: Lubricant) -> FilmTable:
        """The table of an oil's density law.

        Parameters
        ----------
        lubricant : Lubricant
            The oil.

        Raises
        ------
        MapError
            If the file has none.
        """
        try:
            return self.tables[lubricant.density_law]
        except KeyError:
            raise MapError(
                f"film table: has no films of the density law {lubricant.density_law!r}; allowed: "
                f"{', '.join(self.tables)}; solve these films"
            ) from None


@lru_cache(maxsize=1)
def shipped_tables() -> TableFile:
    """Return the tables that the package ships."""
    with resources.as_file(resources.files(__package__).joinpath(SHIPPED)) as path:
        return read_tables(path)


def film_table(lubricant: Lubricant) -> FilmTable:
    """Return the shipped table for an oil.

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    """
    return shipped_tables().of(lubricant)


def read_tables(path: Path) -> TableFile:
    """Read a file of films.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    MapError
        If it cannot be read, is of another kind, holds no table or was changed.
    """
    try:
        with opened(path) as file:
            attributes = {name: str(file.getncattr(name)) for name in file.ncattrs()}
            if (attributes.get(MADE_AS), attributes.get("table_format")) != (KIND, FORMAT):
                raise MapError(f"{path}: is no film table of this version; take the one that comes with ehdmaps")
            tables = {}
            for law, group in file.groups.items():
                parts = {part: _read_nodes(group.groups[part], path) for part in _MEANING}
                tables[law] = FilmTable(**parts, compressible=law != "incompressible")
    except DAMAGE as error:
        raise MapError(f"{path}: cannot be read as a film table ({error!s:.300}); make it again") from None
    table_file = TableFile(tables, attributes)
    if attributes.get(CHECKSUM) != content_sha256(table_file):
        raise MapError(f"{path}: was changed since it was made: its content does not match {CHECKSUM}; make it again")
    return table_file


def _read_nodes(group: Any, path: Path) -> Nodes:
    """One part of a table from its group."""
    group.set_auto_mask(False)
    if group.getncattr("fields").split() != [field.name for field in FIELDS]:
        raise MapError(f"{path}: holds other fields than this version reads; make it again")
    axes = Axes(*(np.asarray(group[name][:], dtype=float) for name in AXES))
    values, codes = (np.moveaxis(group[name][:], 0, -1) for name in ("values", "error_codes"))
    along = [getattr(axes, name) for name in AXES]
    if problem := nodes_problem(along, values, len(FIELDS), codes, len(FIELDS)):
        raise MapError(f"{path}: holds {problem}; make it again")
    return Nodes(axes, values, codes)


def write_tables(path: Path, tables: TableFile) -> None:
    """Write a file of films, with its checksum.

    Parameters
    ----------
    path : Path
        The file.
    tables : TableFile
        Tables and attributes.
    """
    from netCDF4 import Dataset

    with Dataset(path, "w", format="NETCDF4") as file:
        attributes = {**tables.attributes, MADE_AS: KIND, "table_format": FORMAT, CHECKSUM: content_sha256(tables)}
        file.setncatts(attributes)
        for law, table in tables.tables.items():
            for part, meanings in _MEANING.items():
                _write_nodes(file.createGroup(f"{law}/{part}"), getattr(table, part), meanings)


def _write_nodes(group: Any, nodes: Nodes, meanings: tuple[tuple[str, str], ...]) -> None:
    """One part of a table to its group."""
    group.setncattr("fields", " ".join(field.name for field in FIELDS))
    group.createDimension("field", len(FIELDS))
    for name, (meaning, unit) in zip(AXES, meanings, strict=True):
        places = getattr(nodes.axes, name)
        group.createDimension(name, places.size)
        group.createDimension(f"{name}_cell", places.size - 1)
        variable = group.createVariable(name, "f8", (name,))
        variable[:] = places
        variable.setncatts({"long_name": meaning, "units": unit})
    for name, kind, array, suffix, meaning in (
        ("values", "f4", nodes.values, "", "smooth forms of reduced films, see ehdmaps.table.fields"),
        ("error_codes", "u1", nodes.codes, "_cell", "their errors between nodes, see ehdmaps.table.nodes.encoded"),
    ):
        variable = group.createVariable(
            name, kind, ("field", *(f"{axis}{suffix}" for axis in AXES)), compression="zlib", complevel=6, shuffle=True,
            chunksizes=(1, *array.shape[:-1]),
        )  # fmt: skip
        variable[:] = np.moveaxis(array, -1, 0)
        variable.setncattr("long_name", meaning)


def content_sha256(tables: TableFile) -> str:
    """Checksum over nodes, values and errors of all tables.

    Parameters
    ----------
    tables : TableFile
        The tables.
    """
    digest = hashlib.sha256(f"{KIND} {FORMAT}".encode())
    for law, table in sorted(tables.tables.items()):
        for part in _MEANING:
            nodes: Nodes = getattr(table, part)
            digest.update(json.dumps([law, part, *nodes.values.shape]).encode())
            for name in AXES:
                digest.update(_bytes(getattr(nodes.axes, name)))
            digest.update(_bytes(np.moveaxis(nodes.values, -1, 0)))
            digest.update(_bytes(np.moveaxis(nodes.codes, -1, 0)))
    return digest.hexdigest()


def _bytes(values: FloatArray | npt.NDArray[np.float32] | ByteArray) -> bytes:
    """Values as little-endian bytes."""
    return np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<")).tobytes()


def rounded(values: FloatArray) -> npt.NDArray[np.float32]:
    """Values as a file holds them.

    Parameters
    ----------
    values : ndarray
        Finite smooth forms.
    """
    _, power = np.frexp(np.minimum(np.abs(values), 0.5))
    step = np.ldexp(1.0, power - _BITS)
    return np.asarray(step * np.round(values / step), dtype=np.float32)
