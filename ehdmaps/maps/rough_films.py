"""What roughness makes of the points of a map: Lambda, the film's share of the load, and where that is out of range.

Load sharing holds while the mean planes of both surfaces are apart. Where they overlap, the gap that is open to the
oil on average is less than 0.4 of the roughness, and most of it lies in pockets between asperities that touch, through
which no film flows as between smooth walls. And at a given distance asperities carry a given pressure, so that the film
is left with the rest of a heavy load, however thin it is. At a given load the mean planes meet at one share of the
film, see `least_share`: below it shares are a guess.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.maps.asperities import asperity_pressure
from ehdmaps.maps.rough_layer import RoughLayer
from ehdmaps.maps.schema import DIMS
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.surface import Surface

FILM_PARAMETER, FILM_SHARE, MEAN_DISTANCE = "film_parameter", "film_share", "mean_distance"
"""Names of the three variables."""

OVERLAP = "the mean planes of the rough surfaces overlap: out of the range of load sharing, the film's share is a guess"
"""What is said where a film carries a load and the distance of the mean planes is below zero."""

BOUNDARY, MIXED = 1.0, 3.0
"""Lambda below which lubrication is usually called boundary, and mixed. What asperities carry there is `film_share`."""

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
        load that the film carries by `ehdmaps.maps.rough_layer`; `mean_distance`, the distance of the mean planes over
        the roughness. NaN where a point has no solution.
    """
    ordered = dataset.transpose(*DIMS, ...)
    loads, speeds, temperatures = (ordered[name].values.astype(np.float64) for name in DIMS[1:])
    share, distance = np.empty((2, *(ordered.sizes[name] for name in DIMS)))
    for i, contact in enumerate(contacts):
        layer = RoughLayer(surface, contact, lubricant, max(float(speeds[-1]), LEAST_SPEED))
        film = ordered["film_offset"].values[i]
        share[i], distance[i] = load_sharing(layer, film, loads, speeds, temperatures)
    variables = {
        FILM_PARAMETER: (
            ordered["minimum_film"].values / surface.roughness,
            "Lambda, minimum film between smooth surfaces over the combined rms roughness",
        ),
        FILM_SHARE: (share, "part of the load that the film carries, the rest is carried by asperities"),
        MEAN_DISTANCE: (distance, "distance of the mean planes over the combined rms roughness"),
    }
    return xr.Dataset(
        {name: (DIMS, values, {"units": "1", "long_name": words}) for name, (values, words) in variables.items()},
        {name: ordered[name] for name in DIMS},
    )


def load_sharing(
    layer: RoughLayer, film: FloatArray, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Share of the film of one contact, and distance of the mean planes over the roughness, (n, n_u, n_T) each.

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
    distance = shared.offset / layer.surface.roughness
    return np.where(known, shared.share, np.nan), np.where(known, distance, np.nan)


def overlapping(share: FloatArray, distance: FloatArray) -> BoolArray:
    """Where a film carries a load while the mean planes overlap: `load_sharing` out of its range.

    Parameters
    ----------
    share, distance : array
        What `load_sharing` gives. Without a film asperities carry everything, and nothing is shared.
    """
    return np.asarray((share > 0.0) & (distance < 0.0))


def least_share(layer: RoughLayer, loads: FloatArray) -> FloatArray:
    """Share of the film at which the mean planes meet, (n,); below zero where the load is too light for that.

    Parameters
    ----------
    layer : RoughLayer
        The contact with its rough surfaces.
    loads : array (n,)
        [N/m], > 0.
    """
    contact = layer.contact
    pressures = 0.25 * np.pi * np.asarray(max_pressure(loads, contact.radius, contact.reduced_modulus))
    carried, _ = asperity_pressure(layer.surface, 0.0, contact.reduced_modulus)
    return np.asarray(1.0 - carried / pressures)
