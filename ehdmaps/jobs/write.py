"""Write a map file, by the rule of all files that are written."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from ehdmaps.errors import InputError, MapError
from ehdmaps.outputs import MAP, written_aside

_ADVICE = "free space or choose another output with -o, and run the same command again: what was solved is kept"


def write_map(dataset: xr.Dataset, path: Path, groups: Mapping[str, xr.Dataset] | None = None) -> None:
    """Write a map; a map that stands there is replaced at once and whole, or not at all.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map as `assemble` made it.
    path : Path
        The map file.
    groups : mapping, optional
        Datasets of further netCDF groups, such as "backbone".

    Raises
    ------
    MapError
        If it cannot be written, or something else stands there; that is untouched.
    """
    try:
        with written_aside(path, MAP, _ADVICE) as aside:
            dataset.to_netcdf(aside, engine="netcdf4", mode="w")
            for name, group in (groups or {}).items():
                group.to_netcdf(aside, engine="netcdf4", mode="a", group=name)
    except InputError as error:
        raise MapError(str(error)) from error
