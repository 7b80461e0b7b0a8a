"""The file of the table of points: netCDF with provenance and a checksum; it opens in some milliseconds."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from importlib import resources
from pathlib import Path

import numpy as np

from ehdmaps.errors import MapError
from ehdmaps.netcdf_structure import DAMAGE, opened
from ehdmaps.outputs import MADE_AS
from ehdmaps.table.file import CHECKSUM
from ehdmaps.table.nodes import nodes_problem
from ehdmaps.table.points.films import PointTable
from ehdmaps.table.points.nodes import ERRORS, FIELDS, PointAxes, PointNodes

SHIPPED = "point_table.nc"
"""Name of the shipped file in this package."""

KIND, FORMAT = "film table of points", "2"

AXES = ("zeta", "size", "shape", "alpha", "bend")
"""Axes of the table."""


@lru_cache(maxsize=1)
def shipped_point_table() -> PointTable:
    """Return the table that the package ships."""
    with resources.as_file(resources.files(__package__).joinpath(SHIPPED)) as path:
        return read_point_table(path)


def read_point_table(path: Path) -> PointTable:
    """Read a file.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    MapError
        If it cannot be read, is of another kind or was changed.
    """
    try:
        with opened(path) as file:
            file.set_auto_mask(False)
            attributes = {name: str(file.getncattr(name)) for name in file.ncattrs()}
            if (attributes.get(MADE_AS), attributes.get("table_format")) != (KIND, FORMAT):
                raise MapError(f"{path}: is no {KIND} of this version; take the one that comes with ehdmaps")
            if attributes["errors"].split() != list(ERRORS):
                raise MapError(f"{path}: holds other numbers than this version reads; make it again")
            axes = PointAxes(*(np.asarray(file[name][:], dtype=float) for name in AXES))
            values, codes = (np.moveaxis(file[name][:], 0, -1) for name in ("values", "error_codes"))
            continued = np.asarray(file["continued"][:], dtype=bool)
    except DAMAGE as error:
        raise MapError(f"{path}: cannot be read as a {KIND} ({error!s:.300}); make it again") from None
    problem = nodes_problem(axes.all, values, len(FIELDS), codes, len(ERRORS))
    if problem or continued.shape != codes.shape[:-1]:
        raise MapError(f"{path}: holds {problem or 'marks of other cells'}; make it again")
    table = PointTable(PointNodes(axes, values, codes, continued), attributes)
    if attributes.get(CHECKSUM) != content_sha256(table):
        raise MapError(f"{path}: was changed since it was made: its content does not match {CHECKSUM}; make it again")
    return table


def content_sha256(table: PointTable) -> str:
    """Checksum over nodes, values and errors.

    Parameters
    ----------
    table : PointTable
        The table.
    """
    digest = hashlib.sha256(f"{KIND} {FORMAT}".encode())
    for array in (*table.nodes.axes.all, table.nodes.values, table.nodes.codes, table.nodes.continued):
        digest.update(str(array.shape).encode())
        digest.update(np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<")).tobytes())
    return digest.hexdigest()
