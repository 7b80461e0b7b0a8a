"""Curves over load at one speed and temperature, dense, from the films that contact laws are made from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import MapError
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import FilmField
from ehdmaps.physics.contact import LineContact


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
    """Film between the solved points, where a map has a backbone that tells it; None for other maps."""
    if emap.backbone is None:
        return None
    try:
        return emap.film_field()
    except MapError:
        return None


def curves(
    field: FilmField, contacts: tuple[LineContact, ...], loads: FloatArray, speed: float, temperature: float
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
    """
    approach, offset, compliance, loss = (np.zeros(loads.size) for _ in range(4))
    for contact in contacts:
        approach += contact.structural_approach(loads)
        compliance += contact.structural_compliance(loads)
        if field.dry or speed == 0.0:
            continue
        films = field.films(contact.name, loads[:, None, None], np.array([speed]), np.array([temperature]))
        film, film_compliance, film_loss = (values[:, 0, 0] for values in films)
        approach -= film
        offset += film
        compliance += film_compliance
        loss += film_loss
    return Curves(loads, approach, offset, 1.0 / compliance, loss / compliance**2)
