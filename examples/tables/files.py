"""Files of the film tables, as they are written: what `ehdmaps.table` reads."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from netCDF4 import Dataset

from ehdmaps.arrays import ByteArray, FloatArray
from ehdmaps.outputs import MADE_AS
from ehdmaps.physics.moes import valley_load_number
from ehdmaps.table.coordinates import ALPHA
from ehdmaps.table.fields import FIELDS
from ehdmaps.table.file import AXES, CHECKSUM, FORMAT, KIND, TableFile, content_sha256
from ehdmaps.table.nodes import CODES, LARGEST_ERROR, LEAST_ERROR, Nodes
from ehdmaps.table.points import file as of_points
from ehdmaps.table.points.films import PointTable
from ehdmaps.table.points.nodes import ERRORS
from ehdmaps.table.points.nodes import FIELDS as POINT_FIELDS

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
"""Parts of a table of lines, and what their axes mean."""

_POINT_MEANING = {
    "zeta": ("ln(M/M_knee(L, kappa)), see ehdmaps.table.points.nodes", "1"),
    "size": ("ln L, of Moes' oil number L", "1"),
    "shape": ("ln kappa, the ellipticity of the dry contact", "1"),
    "alpha": ("ln alpha, alpha = d ln eta/dp at p = 0 in 1/Pa", "1"),
    "bend": ("(1 - z) sqrt(17/GPa / alpha) with the exponent z of Roelands' law", "1"),
}
"""Meaning and unit of the axes of a table of points."""

_BITS = 16
"""Binary digits of a value that are kept: behind the point, or of its mantissa where it is smaller than one."""


def write_tables(path: Path, tables: TableFile) -> None:
    """Write a file of films, with its checksum.

    Parameters
    ----------
    path : Path
        The file.
    tables : TableFile
        Tables and attributes.
    """
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
        ("error_codes", "u1", nodes.codes, "_cell", "their errors between nodes, see ehdmaps.table.nodes.decoded"),
    ):
        variable = group.createVariable(
            name, kind, ("field", *(f"{axis}{suffix}" for axis in AXES)), compression="zlib", complevel=6, shuffle=True,
            chunksizes=(1, *array.shape[:-1]),
        )  # fmt: skip
        variable[:] = np.moveaxis(array, -1, 0)
        variable.setncattr("long_name", meaning)


def write_point_table(path: Path, table: PointTable) -> None:
    """Write a file, with its checksum.

    Parameters
    ----------
    path : Path
        The file.
    table : PointTable
        Nodes and attributes.
    """
    nodes = table.nodes
    own = {
        MADE_AS: of_points.KIND,
        "table_format": of_points.FORMAT,
        "errors": " ".join(ERRORS),
        CHECKSUM: of_points.content_sha256(table),
    }
    with Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts({**table.attributes, **own})
        file.createDimension("field", len(POINT_FIELDS))
        file.createDimension("error", len(ERRORS))
        for (name, (meaning, unit)), places in zip(_POINT_MEANING.items(), nodes.axes.all, strict=True):
            file.createDimension(name, places.size)
            file.createDimension(f"{name}_cell", places.size - 1)
            variable = file.createVariable(name, "f8", (name,))
            variable[:] = places
            variable.setncatts({"long_name": meaning, "units": unit})
        for name, kind, array, first, suffix, meaning in (
            ("values", "f4", nodes.values, "field", "", "forms of reduced films, see ehdmaps.table.points.nodes"),
            ("error_codes", "u1", nodes.codes, "error", "_cell", "their errors, see ehdmaps.table.nodes.decoded"),
        ):
            variable = file.createVariable(
                name, kind, (first, *(f"{axis}{suffix}" for axis in of_points.AXES)), compression="zlib", complevel=9,
                shuffle=True, chunksizes=(array.shape[-1], *array.shape[:-1]),
            )  # fmt: skip
            variable[:] = np.moveaxis(array, -1, 0)
            variable.setncattr("long_name", meaning)
        marks = file.createVariable("continued", "u1", [f"{axis}_cell" for axis in of_points.AXES], compression="zlib")
        marks[:] = nodes.continued
        marks.setncattr("long_name", "1 where a number goes on from lighter loads")


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


def encoded(errors: FloatArray) -> ByteArray:
    """Errors in a byte each, rounded up; NaN becomes the largest.

    Parameters
    ----------
    errors : ndarray
        Errors of smooth forms, >= 0.
    """
    clipped = np.clip(np.where(np.isnan(errors), LARGEST_ERROR, errors), LEAST_ERROR, LARGEST_ERROR)
    span = np.log(LARGEST_ERROR / LEAST_ERROR)
    return np.asarray(np.ceil(CODES * np.log(clipped / LEAST_ERROR) / span - 1e-9).astype(np.uint8))


def exponent_of(alpha: float, bend: float) -> float:
    """Roelands' z of a bend, the inverse of `bend_of`.

    Parameters
    ----------
    alpha : float
        Pressure-viscosity coefficient [1/Pa], > 0.
    bend : float
        The bend.
    """
    return float(1.0 - bend * np.sqrt(alpha / ALPHA))


def load_number_at(zeta: FloatArray, oil_number: FloatArray, shift: FloatArray | float = 0.0) -> FloatArray:
    """Moes' M of a place zeta, the inverse of `zeta_of`.

    Parameters
    ----------
    zeta : ndarray
        The coordinate.
    oil_number, shift
        The arguments of `zeta_of`.
    """
    return np.asarray(np.exp(zeta + shift) * valley_load_number(oil_number))
