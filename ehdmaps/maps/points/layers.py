"""Films of a point over load on an oil layer and between rough surfaces, from flooded films of smooth ones.

Layers act on a fine grid of loads, so that slopes of the film offset, and stiffness with them, are those of what is
read: of the capped offset on a layer, of the distance of the mean planes between rough surfaces. Damping of the layer
is that of the flooded contact; of the film between asperities the loss compliance goes with the square of its share.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FilmConditions, OilSupply
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.point.inlet_heat import line_number
from ehdmaps.physics.point.oil_layer import Layered, layered
from ehdmaps.physics.surface import Surface

if TYPE_CHECKING:
    from ehdmaps.table.points.films import PointFilms

PER_DECADE = 40
"""Loads in a decade."""

_LEAST_SHARE = 1e-3

LAYERED = ("film_offset", "central_film", "minimum_film", "damping")
"""Numbers of a film that layers change, in their order [m], [m], [m], [N s/m]."""

OFFSET, CENTRAL, SMALLEST, DAMPING = range(4)


class PointPlace(NamedTuple):
    """A contact with its oil at a speed and a temperature.

    Attributes
    ----------
    ellipse : Ellipse
        The contact.
    oil : Lubricant
        The oil.
    speed, temperature : float
        u [m/s], > 0, and T [K].
    """

    ellipse: Ellipse
    oil: Lubricant
    speed: float
    temperature: float


class LayeredFilms(NamedTuple):
    """Films over load.

    Attributes
    ----------
    loads : ndarray, shape (n,)
        F [N], rising.
    values : ndarray, shape (n, 4)
        Those of `LAYERED`; between rough surfaces the offset is the distance of the mean planes, of either sign.
    share : ndarray, shape (n,)
        Share of the film in the load; 1 between smooth surfaces.
    """

    loads: FloatArray
    values: FloatArray
    share: FloatArray


def fine_loads(lowest: float, highest: float) -> FloatArray:
    """Loads between two [N], so near to each other that slopes by cubics through them are those of the films.

    Parameters
    ----------
    lowest, highest : float
        [N], > 0.
    """
    return np.geomspace(lowest, highest, max(8, round(PER_DECADE * np.log10(highest / lowest))))


def on_layer(place: PointPlace, supply: OilSupply, load: FloatArray, values: FloatArray) -> Layered:
    """Factors and errors of films on an oil layer.

    Parameters
    ----------
    place : PointPlace
        The contact.
    supply : OilSupply
        Oil before it.
    load : ndarray, shape (n,)
        F [N], > 0.
    values : ndarray, shape (n, 4)
        Flooded films.
    """
    ellipse, state = place.ellipse, place.oil.at(place.temperature)
    ratio = supply.oil_layer / (state.density_ratio(np.asarray(ellipse.max_pressure(load))) * values[:, CENTRAL])
    line = line_number(ellipse, state.viscosity, load, place.speed)
    return layered(ellipse.ellipticity, ratio, values[:, CENTRAL] / values[:, OFFSET], line)


def layered_films(
    place: PointPlace,
    conditions: FilmConditions,
    loads: FloatArray,
    values: FloatArray,
) -> LayeredFilms:
    """Films under conditions, from flooded ones of smooth surfaces.

    Parameters
    ----------
    place : PointPlace
        The contact.
    conditions : FilmConditions
        Oil supply and surfaces; heat is in the films already.
    loads : ndarray, shape (n,)
        Loads, rising and near to each other, see `fine_loads` [N].
    values : ndarray, shape (n, 4)
        Flooded films there.
    """
    if not conditions.supply.flooded:
        at = on_layer(place, conditions.supply, loads, values)
        values = values * np.column_stack([at.offset, at.film, at.film, np.ones(loads.size)])
    if conditions.surface.smooth:
        return LayeredFilms(loads, values, np.ones(loads.size))
    return _rough(place, conditions.surface, loads, values)


def _rough(place: PointPlace, surface: Surface, loads: FloatArray, values: FloatArray) -> LayeredFilms:
    """Films between rough surfaces, from those of smooth ones."""
    from ehdmaps.maps.points.rough import load_shares, shared_films  # with the asperities

    thicker = shared_films(place.ellipse, place.oil, loads, place.speed, place.temperature)
    share, distance = load_shares(surface, place.ellipse, loads, values[:, OFFSET], thicker)
    dry = 1.0 / np.asarray(place.ellipse.stiffness(loads))
    smooth, rough = (
        dry - CubicSpline(np.log(loads), film)(np.log(loads), 1) / loads for film in (values[:, OFFSET], distance)
    )
    damping = values[:, DAMPING] * (np.maximum(share, _LEAST_SHARE) * smooth / rough) ** 2
    return LayeredFilms(loads, np.column_stack([distance, values[:, CENTRAL], values[:, SMALLEST], damping]), share)


def films_under(place: PointPlace, conditions: FilmConditions, loads: FloatArray, films: PointFilms) -> PointFilms:
    """Films of the table of points with what oil supply and surfaces make of them; their errors are added.

    Parameters
    ----------
    place : PointPlace
        The contact.
    conditions : FilmConditions
        Oil supply and surfaces; heat is in the films already.
    loads : ndarray, shape (n,)
        Loads, rising and near to each other [N].
    films : PointFilms
        Films there, all usable, arrays (n,). Their response over frequency stays that of flooded, smooth contacts.
    """
    if conditions.plain:
        return films
    flooded = np.column_stack([getattr(films, name) for name in LAYERED])
    found = layered_films(place, conditions, loads, flooded)
    changed = dict(zip(LAYERED, found.values.T, strict=True))
    slope = CubicSpline(np.log(loads), changed["film_offset"])(np.log(loads), 1) / loads
    dry, errors = 1.0 / np.asarray(place.ellipse.stiffness(loads)), dict(films.errors)
    if not conditions.supply.flooded:
        added = on_layer(place, conditions.supply, loads, flooded).errors.T
        errors |= {name: errors[name] + more for name, more in zip(LAYERED, added, strict=True)}
    return replace(
        films,
        **changed,
        approach=films.approach + flooded[:, OFFSET] - changed["film_offset"],
        stiffness=1.0 / (dry - slope),
        film_compliance=-slope,
        loss_compliance=changed["damping"] * (dry - slope) ** 2,
        errors=errors,
    )
