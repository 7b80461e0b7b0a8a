"""Checksum of what a map holds, so that values changed after the map was made are noticed.

Over names, dims, shapes and values of all variables of the table of the map's version, of the grid and of the backbone,
and over the attributes that laws are made from. Not over the way they are stored: compression, chunks and the form of
texts may change. Nor over what the clock says: maps that are equal in all physics have one sum.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Collection

import numpy as np
import xarray as xr

from ehdmaps.errors import MapError
from ehdmaps.maps import schema

_ATTRIBUTES = ("contacts", "geometry", "lubricant", "structural_law", schema.REFERENCE_CONTACT)

_WHERE_STATED = (schema.OIL_SUPPLY, schema.SURFACE, schema.FILM_TABLE)
"""Attributes that only some maps have: of the others the checksum is that of a table without them."""

_TIMES = ("solve_seconds",)
"""Variables that another run of the same job finds otherwise."""


def content_sha256(dataset: xr.Dataset, backbone: xr.Dataset | None) -> str:
    """Return the checksum of a map, in hexadecimal digits.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    backbone : xarray.Dataset or None
        Group of its refinement lines.
    """
    return _sum(dataset, backbone, _TIMES)


def _sum(dataset: xr.Dataset, backbone: xr.Dataset | None, without: Collection[str]) -> str:
    """The checksum over everything but some variables."""
    digest = hashlib.sha256()
    version = schema.version_of(dataset)
    for group, held in ((schema.GRID, dataset), (schema.BACKBONE, backbone)):
        if held is None:
            continue
        for name in _ATTRIBUTES:
            digest.update(_header(group, name, held.attrs.get(name)))
        for name in _WHERE_STATED:
            if name in held.attrs:
                digest.update(_header(group, name, held.attrs[name]))
        for entry in schema.table(group, version):
            if entry.name in held.variables and entry.name not in without:
                found = held[entry.name]
                digest.update(_header(group, entry.name, [*map(str, found.dims), *found.shape, entry.dtype]))
                digest.update(_content(found, entry.dtype))
    return digest.hexdigest()


def check_content(dataset: xr.Dataset, backbone: xr.Dataset | None, where: str) -> None:
    """Refuse a map that is not what its checksum says; maps without one, made before there was any, pass.

    So do those whose checksum was made over the times, too, as it once was.

    Parameters
    ----------
    dataset : xr.Dataset
        The map.
    backbone : xr.Dataset or None
        Group of its refinement lines, if it has one.
    where : str
        How messages call the map.

    Raises
    ------
    MapError
        With what to do.
    """
    stated = dataset.attrs.get(schema.CHECKSUM)
    if stated is not None and stated not in (_sum(dataset, backbone, left_out) for left_out in (_TIMES, ())):
        raise MapError(
            f"{where}: was changed since it was made: variables, contacts, geometry, oil, surface, oil supply or group "
            f"{schema.BACKBONE} do not match its attribute {schema.CHECKSUM}; generate it again; or, if the "
            "change is meant, delete that attribute, and the map counts as yours"
        )


def _header(*words: object) -> bytes:
    """A line that no other content can look like."""
    return json.dumps(words, default=str).encode() + b"\n"


def _content(found: xr.DataArray, dtype: str) -> bytes:
    """Values as bytes: numbers in the type of the table, little-endian."""
    if dtype == "str":
        return _header(*(str(text) for text in found.values.ravel()))
    return np.ascontiguousarray(found.values, dtype=np.dtype(found.dtype).newbyteorder("<")).tobytes()
