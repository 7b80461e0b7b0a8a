"""The stiffness of a contact whose film cannot give way: a closed formula, and what a map knows better.

At high frequency the oil cannot leave the inlet, and stiffens the contact a little above its dry structure: it takes
`locked_compliances` off the compliance of the solids. The closed formula for it is fitted to the linear response of the
isothermal Newtonian line contact, see `LOCKED` and `LONGEST_MEMORY` in `ehdmaps/kernel/c/film/film.c`.

A map with film compliances at natural frequencies has a factor for it besides, `fitted_factors`. The law in time has
stiffness and damping of slow motion and the stiffness k_s of the locked film, of which only k_s is open. So the factor
is the one by which the complex stiffness of the law comes closest to that of the film solver, in the mean square of the
relative differences at the frequencies that the map holds. Whatever the factor, the law is passive.

Where the response hardly depends on k_s, for rigid films and at the bottom of the damping valley, the factor stays at
one: a factor of e is held as likely as a difference of `DOUBT`, or of the response's own error where that is larger.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.kernel.record import at
from ehdmaps.maps.kernels.memory_table import called
from ehdmaps.physics.contact import LineContact


class Film(NamedTuple):
    """Data that the closed formula of the locked film needs besides the law.

    Attributes
    ----------
    contacts : int
        Number of contacts in series.
    radius : float
        Mean reduced radius R [m].
    modulus : float
        E' [Pa].
    speed : float
        u [m/s], >= 0.
    """

    contacts: int
    radius: float
    modulus: float
    speed: float


class LockedFactors(NamedTuple):
    """Factors of the closed formula over the load, at one speed and temperature; held beyond both ends.

    Attributes
    ----------
    lowest : float
        ln of the lowest load, in N/m.
    per_log : float
        Inverse step of ln of the load.
    values : array (n,)
        Factors at even steps, n > 1.
    """

    lowest: float
    per_log: float
    values: FloatArray


FORMULA = LockedFactors(0.0, 0.0, np.ones(2))
"""The closed formula as it stands, for maps that know nothing better."""


def film_of(contacts: Sequence[LineContact], speed: float) -> Film:
    """Film of contacts in series, of one material.

    Parameters
    ----------
    contacts : sequence of LineContact
        The contacts.
    speed : float
        u [m/s], of either sign.
    """
    radius = sum(contact.radius for contact in contacts) / len(contacts)
    return Film(len(contacts), radius, contacts[0].reduced_modulus, abs(speed))


def locked_compliances(
    contacts: Sequence[LineContact], offsets: FloatArray, loads: FloatArray, compliances: FloatArray
) -> FloatArray:
    """Compliance that locked oil takes off contacts in series, by the closed formula [m2/N]; arrays (n,).

    Parameters
    ----------
    contacts : sequence of LineContact
        The contacts.
    offsets, loads, compliances : array (n,)
        Film offset [m] and film compliance [m2/N] of all contacts together, and load [N/m].
    """
    return _each("ehd_film_locked", film_of(contacts, 0.0), (), (offsets, loads, compliances))


def relaxation_times(
    film: Film, offsets: FloatArray, loads: FloatArray, k: FloatArray, c: FloatArray, solids: FloatArray,
    factors: FloatArray,
) -> FloatArray:  # fmt: skip
    """Relaxation times c/(k_s - k) of contacts at rest, shape (n,) [s]; 0 where nothing relaxes.

    Parameters
    ----------
    film : Film
        Geometry, moduli, speed.
    offsets, loads, k, c, solids, factors : array (n,)
        The same as for `locked_stiffness`.
    """
    stiff = _each("ehd_film_stiff", film, (film.speed,), (offsets, loads, k, c, solids, factors))
    return np.divide(c, stiff - k, out=np.zeros_like(stiff), where=stiff > k)


def locked_stiffness(film: Film, offset: float, load: float, k: float, c: float, solids: float, factor: float) -> float:
    """Stiffness k_s of a contact whose film cannot give way [N/m2].

    Parameters
    ----------
    film : Film
        Geometry, moduli, speed.
    offset, load, k, c : float
        Film offset [m], load [N/m], > 0, stiffness [N/m2] and damping [N s/m2] at rest.
    solids : float
        Compliance of the structure [m2/N].
    factor : float
        Factor of the closed formula: 1 for the formula itself.
    """
    values = [np.array([value], dtype=np.float64) for value in (offset, load, k, c, solids, factor)]
    return float(_each("ehd_film_stiff", film, (film.speed,), values)[0])


def _each(name: str, film: Film, numbers: tuple[float, ...], arrays: Sequence[FloatArray]) -> FloatArray:
    """Answer of a function of many contacts: numbers, the count, arrays (n,)."""
    kept = [np.ascontiguousarray(array, dtype=np.float64) for array in arrays]
    out, geometry = np.empty(kept[0].size), geometry_of(film)
    called(name)(at(geometry), *numbers, out.size, *(at(array) for array in kept), at(out))
    return out


def geometry_of(film: Film) -> FloatArray:
    """Number, radius [m] and E' [Pa] of the contacts, an `ehd_film_contacts`, shape (3,)."""
    return np.array(film[:3], dtype=np.float64)


DOUBT = 1e-3
"""Relative difference of the complex stiffness below which a response says nothing of the locked film."""

MOST = 8.0
"""Largest factor of the closed formula, and inverse of the smallest one."""


def fitted_factors(
    film: Film, loads: FloatArray, offsets: FloatArray, solids: FloatArray, compliances: FloatArray,
    losses: FloatArray, natural: FloatArray, responses: ComplexArray, errors: FloatArray,
) -> tuple[FloatArray, ComplexArray]:  # fmt: skip
    """Factors of the closed formula of the locked film, and what the law leaves out with them.

    Parameters
    ----------
    film : Film
        One contact at a speed > 0.
    loads, offsets : array (n,)
        [N/m] and film offsets [m], > 0.
    solids : array (n,)
        Compliances of the structure [m2/N].
    compliances, losses : array (n,)
        Film compliances [m2/N] and loss compliances [m2 s/N] of slow motion, as the law takes them.
    natural : array (k,)
        Natural frequencies omega sqrt(b^2 + 2 h R)/u.
    responses : array (n, k)
        Film compliances there, complex [m2/N].
    errors : array (n,)
        Relative errors of the complex stiffness that they make.

    Returns
    -------
    factors : array (n,)
        Factors, between 1/`MOST` and `MOST`.
    apart : array (n, k)
        Relative differences of the complex stiffness of the law from that of the film solver.
    """
    values = np.column_stack((loads, offsets, solids, compliances, losses, np.maximum(errors, DOUBT)))
    values, natural = (np.ascontiguousarray(array, dtype=np.float64) for array in (values, natural))
    responses = np.ascontiguousarray(responses, dtype=np.complex128)
    count, geometry = values.shape[0], geometry_of(film)
    factors, apart = np.empty(count), np.empty((count, natural.size), dtype=np.complex128)
    called("ehd_film_fits")(
        at(geometry), film.speed, MOST, natural.size, at(natural), count, at(values), at(responses), at(factors),
        at(apart),
    )  # fmt: skip
    return factors, apart


def response_error(solids: FloatArray, response: ComplexArray, errors: FloatArray) -> FloatArray:
    """Largest relative error of the complex stiffness over the frequencies, shape (n,); 0 where none is stated.

    Parameters
    ----------
    solids : array (n,)
        Compliance of the structure [m2/N].
    response : array (n, k)
        Film compliances, complex [m2/N].
    errors : array (n, k)
        Their errors, relative to their magnitude; NaN where not known.
    """
    stated = np.abs(response) * np.nan_to_num(errors) / np.abs(solids[:, None] + response)
    return np.asarray(np.max(stated, axis=1))
