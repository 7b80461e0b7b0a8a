"""From film compliances at natural frequencies to the one number that the law in time takes from them.

The law has stiffness and damping of slow motion and the stiffness k_s of the locked film. Of these only k_s is open.
Its closed formula gets a factor, by which the complex stiffness of the law comes closest to that of the film solver, in
the mean square of the relative differences at the frequencies that the map holds. Whatever the factor, the law is
passive.

Where the response hardly depends on k_s, for rigid films and at the bottom of the damping valley, the factor stays at
one: a factor of e is held as likely as a difference of `DOUBT`, or of the response's own error where that is larger.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.locked_film import Film, locked_stiffness

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
