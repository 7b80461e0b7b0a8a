"""Dry point contact of Hertz with any ratio of radii: ellipse, pressure, approach, stiffness.

x is the direction of rolling, with semi-axis a and reduced radius Rx; y lies across, with b and Ry. The ellipticity
kappa = b/a and the curvature ratio D = Rx/Ry know of each other only:

    D = (K - E)/(kappa^2 E - K),    g = p_H Rx/(E* a) = (kappa^2 - 1)/(2 (kappa^2 E - K)),
    F = (2 pi/3) kappa a^2 p_H,     approach = g K a^2/Rx,

with the complete elliptic integrals K and E of the parameter m = 1 - 1/kappa^2, and E* = E'/2. A circle has g = 2/pi, a
line of infinite length 1/2. kappa < 1 is an ellipse that is longer along x; m is negative then, which the integrals
allow.

The integrals come from the arithmetic-geometric mean. What cancels in D and g near the circle, K - E and
kappa^2 E - K, is taken from the sum that the mean leaves behind, so that all is exact to round-off for any kappa.

References
----------
K. L. Johnson, Contact Mechanics, Cambridge, 1985, section 4.2. M. Abramowitz, I. A. Stegun, Handbook of Mathematical
Functions, 1964, section 17.6.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, Values, as_given
from ehdmaps.errors import InputError, Problems

ELLIPTICITIES = (1e-3, 1e3)
"""Smallest and largest ellipticity: beyond them the half-space bodies would have to be thousands of widths large."""

WIDEST = 0.6
"""Half-width sqrt(2 Ry h) of a film, over the radius of the smaller body across, beyond which it is refused: there a
circle is 11 % further away than its paraboloid."""

_STEPS = 8
_MOST_NEWTON = 30


class EllipticNumbers(NamedTuple):
    """Numbers of an ellipse, each as a float or an array.

    Attributes
    ----------
    integral : float or array
        K, the complete elliptic integral of the first kind with m = 1 - 1/kappa^2.
    second_integral : float or array
        E, that of the second kind.
    curvature_ratio : float or array
        D = Rx/Ry.
    pressure_factor : float or array
        g = p_H Rx/(E* a).
    exponent : float or array
        d ln D/d ln kappa, from -3/2 (circle) to -2 (line).
    """

    integral: FloatArray | float
    second_integral: FloatArray | float
    curvature_ratio: FloatArray | float
    pressure_factor: FloatArray | float
    exponent: FloatArray | float


def elliptic_numbers(ellipticity: Values) -> EllipticNumbers:
    """Elliptic integrals of an ellipse, its curvature ratio and its pressure factor.

    Parameters
    ----------
    ellipticity : float or array
        kappa = b/a, > 0.

    Examples
    --------
    >>> circle = elliptic_numbers(1.0)
    >>> circle.curvature_ratio, round(circle.pressure_factor, 12) == round(2.0 / math.pi, 12)
    (1.0, True)
    """
    b = 1.0 / np.asarray(ellipticity, dtype=np.float64)
    m = 1.0 - b * b
    # sum of 2^(n-1) c_n^2 of the mean, beyond c_0^2/2 = m/2, in units of m^2
    mean, other, c = 0.5 * (1.0 + b), np.sqrt(b), 0.5 / (1.0 + b)
    rest, weight = c * c, 1.0
    for _ in range(_STEPS):
        # c_(n+1) = c_n^2/(4 a_(n+1)); c is in units of m
        mean, other = 0.5 * (mean + other), np.sqrt(mean * other)
        c = m * c * c / (4.0 * mean)
        weight *= 2.0
        rest = rest + weight * c * c
    half = 0.5 + m * rest  # (K - E)/(K m)
    left = 0.5 - m * rest  # (E - (1 - m) K)/(K m)
    first = 0.5 * math.pi / mean
    exponent = (-2.0 * rest - 2.0 * half + 3.0 * half * half) / (half * left)
    found = (first, first * (1.0 - m * half), b * b * half / left, 0.5 / (first * left), exponent)
    return EllipticNumbers(*(as_given(value, ellipticity) for value in found))


def curvature_ratio(ellipticity: Values) -> Values:
    """Ratio of the reduced radii, D = Rx/Ry, of an ellipticity.

    Parameters
    ----------
    ellipticity : float or array
        kappa = b/a, > 0.

    Examples
    --------
    >>> round(curvature_ratio(7.0), 6)
    0.049174
    """
    return as_given(elliptic_numbers(ellipticity).curvature_ratio, ellipticity)


def ellipticity(curvature_ratio: Values) -> Values:
    """Ellipticity kappa = b/a of a ratio of reduced radii D = Rx/Ry.

    Parameters
    ----------
    curvature_ratio : float or array
        D, > 0; 1 for a circle.

    Raises
    ------
    InputError
        If a ratio is no positive number, or beyond `ELLIPTICITIES`.

    Examples
    --------
    >>> round(ellipticity(0.049174), 3), ellipticity(1.0)
    (7.0, 1.0)
    """
    given = np.asarray(curvature_ratio, dtype=np.float64)
    with np.errstate(invalid="ignore"):
        wrong = ~((given >= _LEAST_RATIO) & (given <= _LARGEST_RATIO))
    if np.any(wrong):
        raise InputError(
            f"curvature ratio Rx/Ry: got {float(np.extract(wrong, given)[0])!r}; allowed: {_LEAST_RATIO:.3g} to "
            f"{_LARGEST_RATIO:.3g}; both reduced radii are positive, and a longer contact is one of a line"
        )
    target = np.log(given)
    found = -0.636 * target
    for _ in range(_MOST_NEWTON):
        numbers = elliptic_numbers(np.exp(found))
        step = (target - np.log(numbers.curvature_ratio)) / numbers.exponent
        found = found + step
        if np.all(np.abs(step) < 1e-13):
            break
    return as_given(np.exp(found), curvature_ratio)


_LEAST_RATIO, _LARGEST_RATIO = sorted(curvature_ratio(end) for end in ELLIPTICITIES)


@dataclass(frozen=True)
class Ellipse:
    """A dry elliptical contact of two bodies.

    Attributes
    ----------
    rolling_radius : float
        Rx, reduced radius in the direction of rolling [m], > 0.
    transverse_radius : float
        Ry, that across it [m], > 0.
    reduced_modulus : float
        E' = 2/((1 - nu1^2)/E1 + (1 - nu2^2)/E2) [Pa], > 0.
    body_radius : float
        Radius of the smaller body across, such as of a ball [m], > 0; infinite where it is not known.

    Raises
    ------
    InputError
        If a value is no positive number, or the ellipticity is beyond `ELLIPTICITIES`.

    Examples
    --------
    The inner contact of a ball of 7.94 mm in a groove of 52 % of it:

    >>> contact = Ellipse(3.1623e-3, 103.2e-3, 230.769e9)
    >>> round(contact.ellipticity, 2), round(contact.max_pressure(100.0) / 1e9, 3)
    (9.34, 1.204)
    """

    rolling_radius: float
    transverse_radius: float
    reduced_modulus: float
    body_radius: float = math.inf

    def __post_init__(self) -> None:
        problems = Problems()
        if not self.body_radius > 0.0:
            problems.append(f"ellipse, body_radius: got {self.body_radius!r} m; allowed: > 0")
        for name, unit in (("rolling_radius", "m"), ("transverse_radius", "m"), ("reduced_modulus", "Pa")):
            value = getattr(self, name)
            if not (isinstance(value, int | float) and math.isfinite(value) and value > 0.0):
                problems.append(f"ellipse, {name}: got {value!r} {unit}; allowed: finite and > 0")
        problems.check()
        _ = self.ellipticity

    @cached_property
    def ellipticity(self) -> float:
        """Ratio kappa = b/a of the semi-axes; below 1 where the ellipse is longer along the direction of rolling."""
        return ellipticity(self.rolling_radius / self.transverse_radius)

    @property
    def widest_film(self) -> float:
        """Film [m] as wide as the gap is a paraboloid, see `WIDEST`; infinite where bodies have no known radius."""
        return 0.5 * (WIDEST * self.body_radius) ** 2 / self.transverse_radius

    def too_wide(self, film: float) -> str:
        """Reason why a film is refused that is wider than the paraboloid holds; empty where it is not.

        Parameters
        ----------
        film : float
            Film offset h [m].
        """
        if not film > self.widest_film:
            return ""
        return (
            f"film of {1e6 * film:.3g} um is wider than {WIDEST:g} of the ball's radius, which is so from "
            f"{1e6 * self.widest_film:.3g} um on: the gap is no paraboloid; take a higher load, a lower speed or a "
            "thinner oil"
        )

    @cached_property
    def numbers(self) -> EllipticNumbers:
        """Elliptic integrals and factors of the ellipse, floats."""
        return elliptic_numbers(self.ellipticity)

    @cached_property
    def _width_factor(self) -> float:
        """a^3/F [m3/N]."""
        modulus = 0.5 * self.reduced_modulus * float(self.numbers.pressure_factor)
        return 1.5 * self.rolling_radius / (math.pi * self.ellipticity * modulus)

    @cached_property
    def _approach_factor(self) -> float:
        """Approach over a^2 [1/m]."""
        return float(self.numbers.pressure_factor) * float(self.numbers.integral) / self.rolling_radius

    @cached_property
    def coefficient(self) -> float:
        """C of F = C approach^(3/2) [N/m^1.5]."""
        return float(self._approach_factor**-1.5 / self._width_factor)

    def semi_axes(self, load: Values) -> tuple[Values, Values]:
        """Semi-axes a, in the direction of rolling, and b, across it [m].

        Parameters
        ----------
        load : float or array
            F [N], >= 0.
        """
        a = np.cbrt(self._width_factor * load)
        return as_given(a, load), as_given(self.ellipticity * a, load)

    def max_pressure(self, load: Values) -> Values:
        """Largest pressure p_H = 3 F/(2 pi a b) = g E* a/Rx [Pa], zero without load.

        Parameters
        ----------
        load : float or array
            F [N], >= 0.
        """
        factor = 0.5 * self.reduced_modulus * float(self.numbers.pressure_factor) / self.rolling_radius
        return as_given(factor * np.cbrt(self._width_factor * load), load)

    def approach(self, load: Values) -> Values:
        """Approach of the two bodies [m].

        Parameters
        ----------
        load : float or array
            F [N], >= 0.
        """
        return as_given(self._approach_factor * np.square(np.cbrt(self._width_factor * load)), load)

    def load(self, approach: Values) -> Values:
        """Load F = C approach^(3/2) [N]; zero for bodies apart, approach < 0.

        Parameters
        ----------
        approach : float or array
            Approach [m].
        """
        return as_given(self.coefficient * np.maximum(approach, 0.0) ** 1.5, approach)

    def stiffness(self, load: Values) -> Values:
        """Stiffness dF/d approach = (3/2) F/approach [N/m], zero without load.

        Parameters
        ----------
        load : float or array
            F [N], >= 0.
        """
        return as_given(1.5 * self.coefficient ** (2.0 / 3.0) * np.cbrt(load), load)
