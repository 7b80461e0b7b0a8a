"""Bounds of a band in data sets: beside each variable one more for either side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from mbs.unknowns.looks import Band

if TYPE_CHECKING:
    import xarray as xr

SIDES = ("low", "high")
"""Ends of the names of bounds."""


def with_bounds(dataset: xr.Dataset, name: str, band: Band, places: Any = ...) -> xr.Dataset:
    """A data set with the bounds of a variable, of its dimensions, NaN where there is no band.

    Parameters
    ----------
    dataset : xarray.Dataset
        The data set.
    name : str
        The variable.
    band : Band
        Band of the variable, in its unit.
    places : index
        Index of the values of the band among those of the variable.
    """
    own = dataset[name]
    for side, words in zip(SIDES, ("lower", "upper"), strict=True):
        bounds = np.full(own.shape, np.nan)
        bounds[places] = getattr(band, side)
        attributes = {
            "units": own.attrs["units"],
            "long_name": f"{words} bound of 90 % of what is not known of the {own.attrs['long_name']}",
        }
        dataset = dataset.assign({f"{name}_{side}": (own.dims, bounds, attributes)})
    return dataset


def bounded(dataset: xr.Dataset, bands: Mapping[str, Band]) -> xr.Dataset:
    """A data set with the bounds of several whole variables; those that it lacks are left out.

    Parameters
    ----------
    dataset : xarray.Dataset
        The data set.
    bands : mapping of str to Band
        Bands by the names of the variables.
    """
    for name, band in bands.items():
        dataset = with_bounds(dataset, name, band)
    return dataset
