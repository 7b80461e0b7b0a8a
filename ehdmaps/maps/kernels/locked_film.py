"""The stiffness of a contact whose film cannot give way: a closed formula, and what a map knows better.

At high frequency the oil cannot leave the inlet, and stiffens the contact a little above its dry structure: it takes
`locked_compliance` off the compliance of the solids. The closed formula for it is fitted to the linear response of the
isothermal Newtonian line contact, see `LOCKED` and `LONGEST`.

A map with film compliances at natural frequencies has a factor for it besides, `fitted_factor`. The law in time has
stiffness and damping of slow motion and the stiffness k_s of the locked film, of which only k_s is open. So the factor
is the one by which the complex stiffness of the law comes closest to that of the film solver, in the mean square of the
relative differences at the frequencies that the map holds. Whatever the factor, the law is passive.

Where the response hardly depends on k_s, for rigid films and at the bottom of the damping valley, the factor stays at
one: a factor of e is held as likely as a difference of `DOUBT`, or of the response's own error where that is larger.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.compiled import njit
from ehdmaps.physics.contact import LineContact

LOCKED, LOCKED_BY_LOAD = 0.02, 0.087
"""Compliance that locked oil takes off a contact, in 4/E' for each ln(1 + 2 h R/b^2): the first number, and the second
one times -d(ln h)/d(ln w), which is 1 for a rigid film of constant viscosity, and falls where its inlet is
piezoviscous or it is elastic. Fitted with FVA 3: the complex stiffness is right within 7 % up to ten natural
frequencies, and with other oils within 6 % up to L = 40 and 9 % above. A factor from the map makes
that 5 % and 7 %."""

LONGEST = 1.4
"""Longest relaxation time c/(k_s - k) in natural times sqrt(b^2 + 2 h R)/u. Fitted likewise."""

MOST_LOCKED = 0.6
"""Part of the structure's compliance that locked oil takes off at most."""


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


@njit(error_model="numpy")
def factor_at(factors: LockedFactors, load: float) -> float:
    """Factor of the closed formula at a load > 0 [N/m]; straight between its values."""
    last = factors.values.size - 1
    place = min(max((math.log(load) - factors.lowest) * factors.per_log, 0.0), float(last))
    cell = min(int(place), last - 1)
    low, high = factors.values[cell], factors.values[cell + 1]
    value: float = low + (place - cell) * (high - low)
    return value


@njit(error_model="numpy")
def locked_compliance(film: Film, offset: float, load: float, compliance: float) -> float:
    """Compliance that locked oil takes off, by the closed formula [m2/N].

    Parameters
    ----------
    film : Film
        Geometry and moduli.
    offset : float
        Film offset of all contacts together [m].
    load : float
        Load [N/m], > 0.
    compliance : float
        Film compliance of all contacts together [m2/N].
    """
    each = max(offset, 0.0) / film.contacts
    square = 8.0 * load * film.radius / (math.pi * film.modulus)
    exponent = min(max(compliance * load / offset, 0.0), 1.0) if each > 0.0 else 0.0
    part = (LOCKED + LOCKED_BY_LOAD * exponent) * 4.0 / film.modulus
    return film.contacts * part * math.log1p(2.0 * each * film.radius / square)


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
    return _many(film_of(contacts, 0.0), offsets, loads, compliances)


@njit(error_model="numpy")
def _many(film: Film, offsets: FloatArray, loads: FloatArray, compliances: FloatArray) -> FloatArray:
    """`locked_compliance` of arrays."""
    found = np.empty(loads.size)
    for i in range(loads.size):
        found[i] = locked_compliance(film, offsets[i], loads[i], compliances[i])
    return found


@njit(error_model="numpy")
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
    found = np.zeros(loads.size)
    for i in range(loads.size):
        stiff = locked_stiffness(film, offsets[i], loads[i], k[i], c[i], solids[i], factors[i])
        if stiff > k[i]:
            found[i] = c[i] / (stiff - k[i])
    return found


@njit(error_model="numpy")
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
        Of the closed formula: 1 for the formula itself.
    """
    locked = factor * locked_compliance(film, offset, load, 1.0 / k - solids)
    stiff = 1.0 / (solids - min(locked, MOST_LOCKED * solids))
    square = 8.0 * load * film.radius / (math.pi * film.modulus)
    per_natural = film.speed / math.sqrt(square + 2.0 * max(offset, 0.0) / film.contacts * film.radius)
    return max(stiff, k, k + c * per_natural / LONGEST)


DOUBT = 1e-3
"""Relative difference of the complex stiffness below which a response says nothing of the locked film."""

MOST = 8.0
"""Largest factor of the closed formula, and inverse of the smallest one."""

_TRIES = 41
_ROUNDS = 25
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


@njit(error_model="numpy")
def fitted_factor(
    film: Film, load: float, offset: float, solids: float, compliance: float, loss: float, natural: FloatArray,
    response: ComplexArray, error: float,
) -> float:  # fmt: skip
    """Factor of the closed formula of the locked film at one point.

    Parameters
    ----------
    film : Film
        One contact at a speed > 0.
    load, offset : float
        [N/m] and film offset [m], > 0.
    solids : float
        Compliance of the structure [m2/N].
    compliance, loss : float
        Film compliance [m2/N] and loss compliance [m2 s/N] of slow motion, as the law takes them.
    natural : array (k,)
        Natural frequencies omega sqrt(b^2 + 2 h R)/u.
    response : array (k,)
        Film compliances there, complex [m2/N].
    error : float
        Relative error of the complex stiffness that they make.
    """
    doubt = max(error, DOUBT)
    reach = math.log(MOST)
    best, least = 0, math.inf
    for i in range(_TRIES):
        value = _difference(film, load, offset, solids, compliance, loss, natural, response, doubt, _tried(i, reach))
        if value < least:
            best, least = i, value
    low, high = _tried(max(best - 1, 0), reach), _tried(min(best + 1, _TRIES - 1), reach)
    for _ in range(_ROUNDS):
        left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        at_left = _difference(film, load, offset, solids, compliance, loss, natural, response, doubt, left)
        at_right = _difference(film, load, offset, solids, compliance, loss, natural, response, doubt, right)
        if at_left <= at_right:
            high = right
        else:
            low = left
    return math.exp(0.5 * (low + high))


@njit(error_model="numpy")
def _tried(i: int, reach: float) -> float:
    """Logarithm of a factor that is tried."""
    return reach * (2.0 * i / (_TRIES - 1) - 1.0)


@njit(error_model="numpy")
def _difference(
    film: Film, load: float, offset: float, solids: float, compliance: float, loss: float, natural: FloatArray,
    response: ComplexArray, doubt: float, log_factor: float,
) -> float:  # fmt: skip
    """Sum of the squares of the relative differences, and of what holds the factor at one."""
    apart = law_differences(film, load, offset, solids, compliance, loss, natural, response, math.exp(log_factor))
    total = (doubt * log_factor) ** 2
    for i in range(apart.size):
        total += abs(apart[i]) ** 2
    return total


@njit(error_model="numpy")
def law_differences(
    film: Film, load: float, offset: float, solids: float, compliance: float, loss: float, natural: FloatArray,
    response: ComplexArray, factor: float,
) -> ComplexArray:  # fmt: skip
    """Relative differences of the complex stiffness of the law from that of the film solver, shape (k,).

    Parameters
    ----------
    film, load, offset, solids, compliance, loss, natural, response
        The same as for `fitted_factor`.
    factor : float
        Factor of the closed formula.
    """
    k = 1.0 / (solids + compliance)
    c = loss * k * k
    stiff = locked_stiffness(film, offset, load, k, c, solids, factor)
    time = math.sqrt(8.0 * load * film.radius / (math.pi * film.modulus) + 2.0 * offset * film.radius) / film.speed
    relaxation = c / (stiff - k) if stiff > k else 0.0
    apart = np.empty(natural.size, dtype=np.complex128)
    for i in range(natural.size):
        rate = 1j * natural[i] / time
        law = k + (rate * c / (1.0 + rate * relaxation) if stiff > k else 0.0)
        apart[i] = law * (solids + response[i]) - 1.0
    return apart


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
