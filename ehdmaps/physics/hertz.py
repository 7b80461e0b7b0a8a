"""Dry line contact of Hertz: half-width, pressure, gap, and the compliance of the plane log kernel.

Reference: K. L. Johnson, Contact Mechanics, Cambridge, 1985, sections 4.2 and 5.6.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray, Values, as_given

DRY_COMPLIANCE = math.log(2.0) / math.pi
"""-dH0/dW of dry Hertz: lengths by b, film by b^2/R, pressure by p_H, log kernel with reference length b."""

LINE_LIMIT, POINT_LIMIT = 4.0e9, 4.2e9
"""Hertz pressures of the static load ratings of roller and of ball bearings after ISO 76 [Pa]: permanent deformation
of 1e-4 of the diameter of a rolling element above them."""

LARGEST_PRESSURE = 10e9
"""Hertz pressure above which no film is solved [Pa]; steel yields long before."""


def half_width(load: Values, radius: float, reduced_modulus: float) -> Values:
    """Half-width of the contact, b = sqrt(8 w R / (pi E')) [m].

    Parameters
    ----------
    load : float or array
        w [N/m], >= 0.
    radius : float
        R [m].
    reduced_modulus : float
        E' [Pa].

    Examples
    --------
    >>> round(1e6 * half_width(88571.4, radius=5.5152e-3, reduced_modulus=230.769e9), 2)
    73.42
    """
    return as_given(np.sqrt(8.0 * load * radius / (math.pi * reduced_modulus)), load)


def natural_time(load: Values, film_offset: Values, speed: float, radius: float, reduced_modulus: float) -> Values:
    """Time in which the surfaces pass through a lubricated contact, sqrt(b^2 + 2 h R)/u [s].

    Parameters
    ----------
    load : float or array
        w [N/m], >= 0.
    film_offset : float or array
        h, dry minus lubricated approach at equal load [m].
    speed : float
        u [m/s], > 0.
    radius : float
        R [m].
    reduced_modulus : float
        E' [Pa].

    Examples
    --------
    >>> f"{natural_time(88571.4, 1e-6, speed=1.7, radius=5.5152e-3, reduced_modulus=230.769e9):.4g}"
    '7.538e-05'
    """
    width = half_width(load, radius, reduced_modulus)
    return as_given(np.sqrt(np.square(width) + 2.0 * film_offset * radius) / speed, load)


def max_pressure(load: Values, radius: float, reduced_modulus: float) -> Values:
    """Largest pressure, p_H = 2 w/(pi b) = sqrt(w E' / (2 pi R)) [Pa].

    Parameters
    ----------
    load : float or array
        w [N/m], >= 0.
    radius : float
        R [m].
    reduced_modulus : float
        E' [Pa].

    Examples
    --------
    >>> round(max_pressure(88571.4, radius=5.5152e-3, reduced_modulus=230.769e9) / 1e6, 1)
    768.0
    """
    return as_given(np.sqrt(load * reduced_modulus / (2.0 * math.pi * radius)), load)


def pressure(x: FloatArray, half_width: float, max_pressure: float) -> FloatArray:
    """Pressure p_H sqrt(1 - (x/b)^2) inside the contact, zero outside [Pa], at the places x [m].

    Parameters
    ----------
    x : ndarray
        Places along the contact [m], 0 at its centre.
    half_width : float
        b [m].
    max_pressure : float
        p_H [Pa].
    """
    return np.asarray(max_pressure * np.sqrt(np.maximum(1.0 - (x / half_width) ** 2, 0.0)))


def gap(x: FloatArray, half_width: float, radius: float) -> FloatArray:
    """Gap beside the contact, (b^2/2R) [X sqrt(X^2 - 1) - ln(X + sqrt(X^2 - 1))], X = |x|/b >= 1 [m].

    Zero inside the contact; x^2/(2R) - (b^2/2R)(ln(2X) + 1/2) far away.

    Parameters
    ----------
    x : ndarray
        Places along the contact [m], 0 at its centre.
    half_width : float
        b [m].
    radius : float
        R [m].
    """
    distance = np.maximum(np.abs(x) / half_width, 1.0)
    root = np.sqrt(distance**2 - 1.0)
    return np.asarray(half_width**2 / (2.0 * radius) * (distance * root - np.arccosh(distance)))
