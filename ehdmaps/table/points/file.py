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

AXES = {
    "zeta": ("ln(M/M_knee(L, kappa)), see ehdmaps.table.points.nodes", "1"),
    "size": ("ln L, of Moes' oil number L", "1"),
    "shape": ("ln kappa, the ellipticity of the dry contact", "1"),
    "alpha": ("ln alpha, alpha = d ln eta/dp at p = 0 in 1/Pa", "1"),
    "bend": ("(1 - z) sqrt(17/GPa / alpha) with the exponent z of Roelands' law", "1"),
}
"""Axes of the table, their meaning and unit."""


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


def write_point_table(path: Path, table: PointTable) -> None:
    """Write a file, with its checksum.

    Parameters
    ----------
    path : Path
        The file.
    table : PointTable
        Nodes and attributes.
    """
    from netCDF4 import Dataset

    nodes = table.nodes
    own = {MADE_AS: KIND, "table_format": FORMAT, "errors": " ".join(ERRORS), CHECKSUM: content_sha256(table)}
    with Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts({**table.attributes, **own})
        file.createDimension("field", len(FIELDS))
        file.createDimension("error", len(ERRORS))
        for (name, (meaning, unit)), places in zip(AXES.items(), nodes.axes.all, strict=True):
            file.createDimension(name, places.size)
            file.createDimension(f"{name}_cell", places.size - 1)
            variable = file.createVariable(name, "f8", (name,))
            variable[:] = places
            variable.setncatts({"long_name": meaning, "units": unit})
        for name, kind, array, first, suffix, meaning in (
            ("values", "f4", nodes.values, "field", "", "forms of reduced films, see ehdmaps.table.points.nodes"),
            ("error_codes", "u1", nodes.codes, "error", "_cell", "their errors, see ehdmaps.table.nodes.encoded"),
        ):
            variable = file.createVariable(
                name, kind, (first, *(f"{axis}{suffix}" for axis in AXES)), compression="zlib", complevel=9,
                shuffle=True, chunksizes=(array.shape[-1], *array.shape[:-1]),
            )  # fmt: skip
            variable[:] = np.moveaxis(array, -1, 0)
            variable.setncattr("long_name", meaning)
        marks = file.createVariable("continued", "u1", [f"{axis}_cell" for axis in AXES], compression="zlib")
        marks[:] = nodes.continued
        marks.setncattr("long_name", "1 where a number goes on from lighter loads")


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
