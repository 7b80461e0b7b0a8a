"""Curves over load of what a map holds: films and contacts, at any speed and temperature, for pictures and reports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import MapError
from ehdmaps.maps import schema
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.rough_layer import LEAST_SPEED, RoughLayer
from ehdmaps.physics.contact import LineContact

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap


@dataclass(frozen=True)
class Curves:
    """Curves over load, of one contact or of several in series, per unit length; arrays of shape (n,).

    Attributes
    ----------
    loads : ndarray
        [N/m].
    approach, film_offset : ndarray
        [m]; of contacts in series their sums.
    stiffness, damping : ndarray
        [N/m2], [N s/m2]; damping is not negative, as in contact laws.
    """

    loads: FloatArray
    approach: FloatArray
    film_offset: FloatArray
    stiffness: FloatArray
    damping: FloatArray


def law_field(emap: EHDMap) -> FilmField | None:
    """Film between the solved points, where a backbone or the film table tells it; None for other maps."""
    if not emap.known_between:
        return None
    try:
        return emap.film_field()
    except MapError:
        return None


SMOOTH_LAYERS: Mapping[str, RoughLayer] = MappingProxyType({})
"""No load sharing in any contact."""


def rough_layers(emap: EHDMap) -> Mapping[str, RoughLayer]:
    """Return the load sharing of the contacts of a map, by their names; none where its surfaces are smooth.

    Parameters
    ----------
    emap : EHDMap
        The map.
    """
    if emap.surface.smooth:
        return SMOOTH_LAYERS
    speeds = emap.dataset["entrainment_speed"].values
    slowest = float(min(speeds[speeds > 0.0], default=LEAST_SPEED))
    return {contact.name: RoughLayer(emap.surface, contact, emap.lubricant, slowest) for contact in emap.contacts}


def curves(
    field: FilmField,
    contacts: tuple[LineContact, ...],
    loads: FloatArray,
    speed: float,
    temperature: float,
    layers: Mapping[str, RoughLayer] = SMOOTH_LAYERS,
) -> Curves:
    """Curves of contacts that carry the same load.

    Parameters
    ----------
    field : FilmField
        Films of these contacts.
    contacts : tuple of LineContact
        One, or those in series: compliances and loss compliances add.
    loads : ndarray, shape (n,)
        [N/m], > 0.
    speed, temperature : float
        [m/s], >= 0; [K].
    layers : mapping
        Load sharing of film and asperities, by the name of a contact; none where its surfaces are smooth.
    """
    approach, offset, compliance, loss = (np.zeros(loads.size) for _ in range(4))
    for contact in contacts:
        approach += contact.structural_approach(loads)
        compliance += contact.structural_compliance(loads)
        layer = layers.get(contact.name)
        still = field.dry or speed == 0.0
        if still and layer is None:
            continue
        at, root = (np.array([speed]), np.array([temperature])), np.cbrt(loads)[:, None, None]
        # at standstill nothing but asperities
        nothing = np.zeros((3, loads.size, 1, 1))
        films = nothing if still else field.films(contact.name, loads[:, None, None], *at)
        if layer is not None:
            shared = layer.shared(root, films[0], -3.0 * root**2 * films[1], *at)
            films = shared.offset, -shared.slope / (3.0 * root**2), films[2] * shared.share**2
        film, film_compliance, film_loss = (values[:, 0, 0] for values in films)
        approach -= film
        offset += film
        compliance += film_compliance
        loss += film_loss
    return Curves(loads, approach, offset, 1.0 / compliance, loss / compliance**2)


def film_between(
    emap: EHDMap, film: str, contact: str, loads: FloatArray, speed: float, temperature: float
) -> FloatArray:
    """Film over load: between the map's points linear in the logarithms of film, load and speed, and in temperature.

    Parameters
    ----------
    emap : EHDMap
        The map.
    film : str
        A film that the map holds at its points only, such as "central_film".
    contact : str
        Name of the contact.
    loads : ndarray, shape (n,)
        [N/m].
    speed, temperature : float
        [m/s], [K].

    Returns
    -------
    ndarray, shape (n,)
        [m]; 0 at a standstill, NaN where points that are read are not known.
    """
    from ehdmaps.maps.edges.reach import continued_lines, known_runs, reach_of

    values = emap.dataset.sel(contact=contact)[film].transpose(*schema.DIMS[1:]).values
    if speed == 0.0 or not np.any(np.nan_to_num(values)):
        return np.zeros(loads.size)
    axes = emap.axis("load"), emap.axis("entrainment_speed"), emap.axis("temperature")
    known = known_runs((np.isfinite(values) & (values > 0.0))[None])
    reach = reach_of(known, axes)
    if reach is None:
        return np.full(loads.size, np.nan)
    log_loads, lines = np.log(reach.loads), reach.part(np.where(known[0], values, np.nan))
    logs = continued_lines(np.log(lines).reshape(log_loads.size, -1), log_loads).reshape(lines.shape)
    at_speed = _between(logs, np.log(reach.speeds), float(np.log(speed)), 1)
    at_point = _between(at_speed, reach.temperatures, temperature, 1)
    first, last = reach.loads_at(speed, temperature)
    found = np.exp(np.interp(np.log(loads), log_loads, at_point))
    return np.asarray(np.where((loads >= 0.999 * first) & (loads <= 1.001 * last), found, np.nan))


def _between(values: FloatArray, axis: FloatArray, at: float, along: int) -> FloatArray:
    """Linear interpolation at one place along one axis."""
    if axis.size == 1:
        return np.asarray(np.take(values, 0, along))
    i = min(max(int(np.searchsorted(axis, at)) - 1, 0), axis.size - 2)
    share = (at - axis[i]) / (axis[i + 1] - axis[i])
    return np.asarray((1.0 - share) * np.take(values, i, along) + share * np.take(values, i + 1, along))
