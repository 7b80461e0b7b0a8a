"""Results as files: what every dataset says of itself, and how it is written."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING

from ehdmaps.outputs import MADE_AS, TABLE, Kind, dataset_kind, written_aside
from ehdmaps.provenance import code_hash
from ehdmaps.version import version

if TYPE_CHECKING:
    import matplotlib.figure
    import xarray as xr

    Figure = matplotlib.figure.Figure
    """What results draw themselves as: they name it here, and load the library when they are asked to."""

SCHEMA_VERSION = 1

_RESULT = "result of mbs"

RESULT = dataset_kind("a result of mbs", _RESULT)
"""What -o writes, but where a command says otherwise."""


def result_kind(path: str | None) -> Kind:
    """Kind of file that a result is written as, by the ending of its name."""
    if path is not None and Path(path).suffix.lower() == ".csv":
        return TABLE
    return dataclasses.replace(RESULT, endings=(".nc", ".csv"))


def write_dataset(dataset: xr.Dataset, path: Path) -> None:
    """Write a result, by the rule of all files that are written.

    Raises
    ------
    InputError
        If it cannot be written, or something else stands there.
    """
    with written_aside(path, RESULT) as aside:
        dataset.assign_attrs({MADE_AS: _RESULT}).to_netcdf(aside, engine="netcdf4", mode="w")


def described(dataset: xr.Dataset, **attributes: str) -> xr.Dataset:
    """The dataset with its provenance: scene, law and versions."""
    return dataset.assign_attrs(
        schema_version=SCHEMA_VERSION, ehdmaps_version=version(), code_hash=code_hash(), **attributes
    )
