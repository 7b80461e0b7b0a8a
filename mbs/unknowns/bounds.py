"""Bounds of a band in data sets: beside each variable one more for either side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.arrays import FloatArray
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
    low, high = (np.full(dataset[name].shape, np.nan) for _ in SIDES)
    low[places], high[places] = band.low, band.high
    return with_sides(dataset, name, low, high)


def with_sides(dataset: xr.Dataset, name: str, low: FloatArray, high: FloatArray) -> xr.Dataset:
    """A data set with both bounds of a variable, of its dimensions, in its unit.

    Parameters
    ----------
    dataset : xarray.Dataset
        The data set.
    name : str
        The variable.
    low, high : array
        Bounds, of the shape of the variable; NaN where there is none.
    """
    own = dataset[name]
    for side, words, bounds in zip(SIDES, ("lower", "upper"), (low, high), strict=True):
        long = f"{words} bound of 90 % of what is not known of the {own.attrs['long_name']}"
        attributes = {"units": own.attrs["units"], "long_name": long}
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
