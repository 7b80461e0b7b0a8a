"""Dimensionless groups of an isothermal line contact, and back.

Moes' groups M and L (two of them) and the groups U, W, G of Dowson and Higginson (three) say the same
thing: load, speed, oil and radius collapse to them exactly for a Barus oil without compressibility, nearly
otherwise. Note their speeds: Moes takes the sum us = 2u of the surface speeds, Dowson and Higginson the
mean u.

References
----------
H. Moes, Optimum similarity analysis with applications to elastohydrodynamic lubrication, Wear 159, 1992,
57-66. D. Dowson, G. R. Higginson, Elasto-Hydrodynamic Lubrication, Pergamon, 1966.
"""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np

from ehdmaps.arrays import FloatArray, Values, as_given

Speeds = TypeVar("Speeds", float, FloatArray)


def moes_groups(
    load: Values,
    speed: Speeds,
    viscosity: float,
    pressure_viscosity: float,
    radius: float,
    reduced_modulus: float,
) -> tuple[Values, Speeds]:
    """Load number M = w/(E'R) (eta0 us/(E'R))^(-1/2) and oil number L = alpha E' (eta0 us/(E'R))^(1/4).

    Parameters
    ----------
    load : float or array
        w [N/m].
    speed : float or array
        Entrainment speed u, the mean of the surface speeds [m/s], > 0; us = 2u. An array, of an array of loads only.
    viscosity : float
        eta0 [Pa s].
    pressure_viscosity : float
        alpha = d ln eta/dp at p = 0 [1/Pa].
    radius : float
        R [m].
    reduced_modulus : float
        E' [Pa].

    Examples
    --------
    >>> M, L = moes_groups(88571.4, 1.7, 0.0845, 2.24e-8, 5.5152e-3, 230.769e9)
    >>> round(M, 3), round(L, 3)
    (4.632, 20.037)
    """
    speed_number = moes_speed_number(speed, viscosity, radius, reduced_modulus)
    with np.errstate(over="ignore"):  # absurd loads have groups that are infinite
        load_number = load / (reduced_modulus * radius) / np.sqrt(speed_number)
    return as_given(load_number, load), as_given(pressure_viscosity * reduced_modulus * speed_number**0.25, speed)


def moes_speed_number(speed: Speeds, viscosity: float, radius: float, reduced_modulus: float) -> Speeds:
    """Group eta0 us/(E'R) with the sum us = 2u of the surface speeds.

    Parameters
    ----------
    speed : float or array
        Entrainment speed u, the mean of the surface speeds [m/s], > 0.
    viscosity : float
        eta0 [Pa s].
    radius : float
        R [m].
    reduced_modulus : float
        E' [Pa].
    """
    return as_given(viscosity * 2.0 * speed / (reduced_modulus * radius), speed)


def film_from_moes(
    film_number: Values, speed: float, viscosity: float, radius: float, reduced_modulus: float
) -> Values:
    """Film thickness h = H R (eta0 us/(E'R))^(1/2) [m] of Moes' film number H.

    Parameters
    ----------
    film_number : float or array
        Moes' film number H.
    speed : float
        Entrainment speed u, the mean of the surface speeds [m/s], > 0.
    viscosity : float
        eta0 [Pa s].
    radius : float
        R [m].
    reduced_modulus : float
        E' [Pa].
    """
    scale = radius * math.sqrt(moes_speed_number(speed, viscosity, radius, reduced_modulus))
    return as_given(film_number * scale, film_number)


def dowson_groups(
    load: Values,
    speed: float,
    viscosity: float,
    pressure_viscosity: float,
    radius: float,
    reduced_modulus: float,
) -> tuple[float, Values, float]:
    """Groups U = eta0 u/(E'R) with the mean speed u, W = w/(E'R), G = alpha E'.

    Parameters
    ----------
    load : float or array
        w [N/m].
    speed : float
        Entrainment speed u, the mean of the surface speeds [m/s], > 0.
    viscosity : float
        eta0 [Pa s].
    pressure_viscosity : float
        alpha = d ln eta/dp at p = 0 [1/Pa].
    radius : float
        R [m].
    reduced_modulus : float
        E' [Pa].

    Examples
    --------
    >>> U, W, G = dowson_groups(88571.4, 1.7, 0.0845, 2.24e-8, 5.5152e-3, 230.769e9)
    >>> f"{U:.4g} {W:.4g} {G:.4g}"
    '1.129e-10 6.959e-05 5169'
    """
    speed_number = viscosity * speed / (reduced_modulus * radius)
    load_number = as_given(load / (reduced_modulus * radius), load)
    return speed_number, load_number, pressure_viscosity * reduced_modulus


def valley_load_number(oil_number: Values) -> Values:
    """Moes' M at the bottom of the damping valley, 2.2/(1 + L/12).

    There the film goes from rigid to elastic, and film compliance and damping dive through a minimum, some tenths
    of ln M wide. A fit to our own solutions with FVA 3, L = 3 to 48, 20 to 120 degC: within 6 % in M. It serves as a
    coordinate and as a place to refine, never as a result.

    Examples
    --------
    >>> round(valley_load_number(12.0), 2)
    1.1
    """
    return as_given(2.2 / (1.0 + oil_number / 12.0), oil_number)
