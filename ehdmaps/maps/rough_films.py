"""What roughness makes of the points of a map: the film parameter Lambda, and the film's share of the load."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.rough_layer import RoughLayer
from ehdmaps.maps.schema import DIMS
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.roughness import Surface

FILM_PARAMETER, FILM_SHARE = "film_parameter", "film_share"
"""Names of the two variables."""

BOUNDARY, MIXED = 1.0, 3.0
"""Lambda below which lubrication is usually called boundary, and mixed: asperities carry most, or some, of the load."""

LEAST_SPEED = 1e-9
"""Speed that stands for a standstill where one above zero is needed [m/s]."""


def rough_variables(
    dataset: xr.Dataset, contacts: tuple[LineContact, ...], lubricant: Lubricant, surface: Surface
) -> xr.Dataset:
    """Lambda and the film's share at all points of a map.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map, of smooth surfaces.
    contacts : tuple of LineContact
        Its contacts.
    lubricant : Lubricant
        Its oil.
    surface : Surface
        A rough one.

    Returns
    -------
    xarray.Dataset
        `film_parameter`, minimum film between smooth surfaces over the roughness, and `film_share`, the part of the
        load that the film carries by `ehdmaps.maps.rough_layer`; NaN where a point has no solution.
    """
    ordered = dataset.transpose(*DIMS, ...)
    loads, speeds, temperatures = (ordered[name].values.astype(np.float64) for name in DIMS[1:])
    share = np.empty(tuple(ordered.sizes[name] for name in DIMS))
    for i, contact in enumerate(contacts):
        layer = RoughLayer(surface, contact, lubricant, max(float(speeds[-1]), LEAST_SPEED))
        share[i] = film_share(layer, ordered["film_offset"].values[i], loads, speeds, temperatures)
    variables = {
        FILM_PARAMETER: (
            ordered["minimum_film"].values / surface.roughness,
            "Lambda, minimum film between smooth surfaces over the combined rms roughness",
        ),
        FILM_SHARE: (share, "part of the load that the film carries, the rest is carried by asperities"),
    }
    return xr.Dataset(
        {name: (DIMS, values, {"units": "1", "long_name": words}) for name, (values, words) in variables.items()},
        {name: ordered[name] for name in DIMS},
    )


def film_share(
    layer: RoughLayer, film: FloatArray, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
) -> FloatArray:
    """Share of the film of one contact, (n, n_u, n_T).

    Parameters
    ----------
    layer : RoughLayer
        The contact with its rough surfaces.
    film : array (n, n_u, n_T)
        Film offset between smooth surfaces [m]; NaN where it is not known, 0 at standstill.
    loads, speeds, temperatures : array (n,), (n_u,), (n_T,)
        [N/m], [m/s], [K].
    """
    known = np.isfinite(film)
    solid = np.where(known, film, 0.0)
    root = np.broadcast_to(np.cbrt(loads)[:, None, None], film.shape)
    shared = layer.shared(root, solid, np.zeros(film.shape), speeds, temperatures)
    return np.where(known, shared.share, np.nan)
