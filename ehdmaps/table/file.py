"""The file of the film table: a netCDF file with a group for each density law, its provenance and its checksum.

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

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import ByteArray, FloatArray
from ehdmaps.errors import MapError
from ehdmaps.outputs import MADE_AS
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.table.fields import FIELDS
from ehdmaps.table.films import FilmTable
from ehdmaps.table.interpolation import Axes

SHIPPED = "film_table.nc"
"""Name of the shipped file in this package."""

KIND, FORMAT, CHECKSUM = "film table", "1", "content_sha256"

AXES = ("zeta", "oil_number", "pressure_viscosity", "bend")
_MEANING = {
    "zeta": ("ln(M/M_valley(L)) - shift(L, alpha, z), see ehdmaps.table.coordinates", "1"),
    "oil_number": ("Moes' oil number L", "1"),
    "pressure_viscosity": ("alpha, d ln eta/dp at p = 0", "1/Pa"),
    "bend": ("(1 - z) sqrt(17/GPa / alpha) with the exponent z of Roelands' law", "1"),
}
_BITS = 17
"""Bits of a value's mantissa that are kept."""

ROUNDING = 2.0 ** -(_BITS + 1)
"""What keeping these changes a value by, relatively, at most."""


@dataclass(frozen=True, eq=False)
class TableFile:
    """What a file of films holds.

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
        If it cannot be read, is of another kind or was changed.
    """
    from netCDF4 import Dataset

    try:
        with Dataset(path) as file:
            attributes = {name: str(file.getncattr(name)) for name in file.ncattrs()}
            if (attributes.get(MADE_AS), attributes.get("table_format")) != (KIND, FORMAT):
                raise MapError(f"{path}: is no film table of this version; make one by `ehdmaps table make`")
            tables = {}
            for law, group in file.groups.items():
                group.set_auto_mask(False)
                nodes = [np.asarray(group[name][:], dtype=float) for name in AXES]
                axes = Axes(nodes[0], np.log(nodes[1]), np.log(nodes[2]), nodes[3])
                fields = [str(name) for name in group.getncattr("fields").split()]
                if fields != [field.name for field in FIELDS]:
                    raise MapError(f"{path}: holds other fields than this version reads; make it again")
                values, codes = (np.moveaxis(group[name][:], 0, -1) for name in ("values", "error_codes"))
                tables[law] = FilmTable(axes, values, codes, law != "incompressible")
    except (OSError, KeyError, IndexError, AttributeError) as error:
        raise MapError(f"{path}: cannot be read as a film table ({error}); make it again") from None
    found = TableFile(tables, attributes)
    if attributes.get(CHECKSUM) != content_sha256(found):
        raise MapError(f"{path}: was changed since it was made: its content does not match {CHECKSUM}; make it again")
    return found


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
            group = file.createGroup(law)
            group.setncattr("fields", " ".join(field.name for field in FIELDS))
            group.createDimension("field", len(FIELDS))
            axes = table.axes
            for name, nodes in zip(
                AXES, (axes.zeta, np.exp(axes.log_l), np.exp(axes.log_alpha), axes.bend), strict=True
            ):
                group.createDimension(name, nodes.size)
                variable = group.createVariable(name, "f8", (name,))
                variable[:] = nodes
                variable.setncatts(dict(zip(("long_name", "units"), _MEANING[name], strict=True)))
            for name, kind, held, meaning in (
                ("values", "f4", table.values, "smooth forms of reduced films, see ehdmaps.table.fields"),
                ("error_codes", "u1", table.codes, "their errors, see ehdmaps.table.films.encoded"),
            ):
                variable = group.createVariable(
                    name, kind, ("field", *AXES), compression="zlib", complevel=6, shuffle=True,
                    chunksizes=(1, *held.shape[:-1]),
                )  # fmt: skip
                variable[:] = np.moveaxis(held, -1, 0)
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
        axes = table.axes
        nodes: tuple[FloatArray, ...] = (axes.zeta, axes.log_l, axes.log_alpha, axes.bend)
        digest.update(json.dumps([law, *table.values.shape]).encode())
        for held in nodes:
            # 12 digits: nodes stand in the file as L and alpha, and come back through a logarithm
            digest.update(np.char.mod("%.12g", held).tobytes())
        digest.update(_bytes(np.moveaxis(table.values, -1, 0)))
        digest.update(_bytes(np.moveaxis(table.codes, -1, 0)))
    return digest.hexdigest()


def _bytes(values: npt.NDArray[np.float32] | ByteArray) -> bytes:
    """Values as little-endian bytes."""
    return np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<")).tobytes()


def rounded(values: FloatArray) -> npt.NDArray[np.float32]:
    """Values with the bits that a file holds.

    Parameters
    ----------
    values : ndarray
        Finite values.
    """
    single = np.ascontiguousarray(values, dtype=np.float32)
    dropped = 23 - _BITS
    bits = single.view(np.uint32)
    half = np.uint32(1 << (dropped - 1))
    kept = np.uint32(0xFFFFFFFF << dropped & 0xFFFFFFFF)
    return ((bits + half) & kept).view(np.float32).reshape(values.shape)
