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
PARTS = ("piezoviscous", "isoviscous")
"""Axes and parts of a table."""


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
                parts = {part: _read_nodes(group.groups[part], path) for part in PARTS}
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


def content_sha256(tables: TableFile) -> str:
    """Checksum over nodes, values and errors of all tables.

    Parameters
    ----------
    tables : TableFile
        The tables.
    """
    digest = hashlib.sha256(f"{KIND} {FORMAT}".encode())
    for law, table in sorted(tables.tables.items()):
        for part in PARTS:
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
