"""Write a map file: aside in the same folder, brought to the disk, then renamed over the old one."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from ehdmaps.errors import MapError


def write_map(dataset: xr.Dataset, path: Path, groups: Mapping[str, xr.Dataset] | None = None) -> None:
    """Write a map; a map that stands there is replaced at once and whole, or not at all.

    Parameters
    ----------
    dataset : xarray.Dataset
        As `assemble` made it.
    path : Path
        The map file.
    groups : mapping, optional
        Datasets of further netCDF groups, such as "backbone".

    Raises
    ------
    MapError
        If it cannot be written; the old map is untouched.
    """
    aside = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        try:
            dataset.to_netcdf(aside, engine="netcdf4", mode="w")
            for name, group in (groups or {}).items():
                group.to_netcdf(aside, engine="netcdf4", mode="a", group=name)
            _sync(aside)
            aside.replace(path)
        finally:
            aside.unlink(missing_ok=True)
        _sync(path.parent)
    except (OSError, RuntimeError) as error:
        # netCDF4 reports a full disk as a RuntimeError.
        raise MapError(
            f"{path}: cannot be written ({error}); allowed: a file in a folder that may be written, with "
            "space on the "
            "disk; free space or choose another output with -o, and run the same command again: what "
            "was solved is kept"
        ) from error


def _sync(path: Path) -> None:
    """Bring a file or a folder to the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
