"""Integral of dA/h over a lubricated contact, by its films: what its capacitance is made of.

In the Hertz zone the film is nearly even; beside it the gap is that of the dry contact, opened by the film:

    Int dA/h = f pi a b/h_c + 2 pi sqrt(Rx Ry) (ln(1 + h_out/h) + w(kappa, h/delta))        points
    Int dx/h = f 2 b/h_c + 2 (2 R/b) o(2 R h/b^2)                                           lines, a length

w and o are integrals over the dry gap alone, of the ellipse in confocal coordinates, and of the line with x = b cosh s.
h is the film offset, by which the film moves the bodies. A point needs the gap h_out at which the oil ends, as its
integral grows with the logarithm of it; that of a line is finite.

f is the mean of h_c/h over the zone: films are thicker where the load is smaller, at the ends of a long ellipse, and
thin in the horseshoe of a round one and at the exit. It is linear in h_c/h_m and in the offset over h_c, with numbers
that every second of 74 solved points, and of 140 solved lines, gave; the others are met within `POINT_ERROR` and
`LINE_ERROR` (`python -m tests.benchmarks.bench_electrics` draws new ones). In the limit of rigid bodies both are exact,
whatever f is. Where the offset of a line is not known, h is h_c, with numbers of its own.

Behind the contact the oil that came through is a layer of thickness h_c in a gap that opens: its share is h_c/h. That
part is the strip behind the Hertz zone, opened as behind a line.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, RectBivariateSpline

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.point.ellipse import Ellipse, curvature_ratio

POINT_ERROR, LINE_ERROR, CENTRAL_ERROR = 0.03, 0.02, 0.08
"""Largest errors of the rules against fine solutions, of points from M 2 to 25 000 with kappa 1 to 24, of lines from M
0.1 to 320, and of lines without an offset, which M below 2 has; above it is 0.005."""

_POINT, _LINE, _CENTRAL = (0.969, 0.107, -0.162), (0.969, 0.178, 0.006), (0.9986, -0.171, 0.0)
"""f: a constant, by h_c/h_m - 1, and by offset/h_c - 1, of points, lines, and lines without an offset."""

LONGEST = 60.0
"""Largest ellipticity for which w is tabulated."""

_THIN, _THICK, _THICKEST = 1e-6, 1e3, 1e14
_ANGLES, _STRIPS = 24, 6


class Integral(NamedTuple):
    """Integral of dA/h and its parts; points in m, lines in m a length of m, arrays (n,).

    Attributes
    ----------
    zone : array
        Part of the Hertz zone.
    beside : array
        Part of all the oil beside it.
    outlet : callable
        (permittivity) -> what the outlet would have if it were full of oil, and what is left of it, as multiples of the
        integral in oil, with oil and gas beside each other, one over the other, and with gas alone.
    error : float
        Relative error of the rule.
    """

    zone: FloatArray
    beside: FloatArray
    outlet: Callable[[float], tuple[FloatArray, FloatArray, FloatArray, FloatArray]]
    error: float


def point_integral(
    ellipse: Ellipse, load: FloatArray, central: FloatArray, minimum: FloatArray, offset: FloatArray, outer_gap: float
) -> Integral:
    """Integral of dA/h of point contacts [m].

    Parameters
    ----------
    ellipse : Ellipse
        The contact.
    load : array (n,)
        Loads [N], > 0.
    central, minimum, offset : array (n,)
        Central and smallest film and film offset [m], > 0.
    outer_gap : float
        Gap at which the oil ends [m].
    """
    a, b = (np.asarray(axis) for axis in ellipse.semi_axes(load))
    scale = 2.0 * math.pi * math.sqrt(ellipse.rolling_radius * ellipse.transverse_radius)
    eta = np.clip(offset / np.asarray(ellipse.approach(load)), _THIN, _THICK)
    shape = math.log(min(max(ellipse.ellipticity, 1.0), LONGEST))
    beside = scale * (np.log1p(outer_gap / offset) + _beside_points()(shape, np.log(eta), grid=False))
    factor = _evenness(_POINT, central, minimum, offset)
    places, weights = np.polynomial.legendre.leggauss(2 * _STRIPS)
    places, weights = places[_STRIPS:, None], 2.0 * weights[_STRIPS:, None]
    half = a * np.sqrt(1.0 - places**2)

    def outlet(permittivity: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        parts = _outlets(ellipse.rolling_radius, half, central, permittivity)
        full, beside_gas, under_gas, gas = (b * np.sum(weights * part, axis=0) for part in parts)
        return full, beside_gas, under_gas, gas

    return Integral(factor * math.pi * a * b / central, np.maximum(beside, 0.0), outlet, POINT_ERROR)


def line_integral(
    contact: LineContact,
    load: FloatArray,
    central: FloatArray,
    minimum: FloatArray,
    offset: FloatArray | None = None,
) -> Integral:
    """Integral of dx/h of line contacts, a number a length.

    Parameters
    ----------
    contact : LineContact
        The contact.
    load : array
        Loads per length [N/m], > 0.
    central, minimum : array
        Central and smallest film [m], > 0.
    offset : array, optional
        Film offset [m], > 0.
    """
    b = np.asarray(half_width(load, contact.radius, contact.reduced_modulus))
    numbers, error = (_CENTRAL, CENTRAL_ERROR) if offset is None else (_LINE, LINE_ERROR)
    moved = central if offset is None else offset
    beside = 2.0 * _opening(contact.radius, b, moved)
    factor = _evenness(numbers, central, minimum, moved)

    def outlet(permittivity: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        return _outlets(contact.radius, b, central, permittivity)

    return Integral(factor * 2.0 * b / central, beside, outlet, error)


def _evenness(
    numbers: tuple[float, float, float], central: FloatArray, minimum: FloatArray, offset: FloatArray
) -> FloatArray:
    """Mean f of h_c/h over the Hertz zone."""
    first, by_ratio, by_offset = numbers
    return np.asarray(first + by_ratio * (central / minimum - 1.0) + by_offset * (offset / central - 1.0))


def open_point(ellipse: Ellipse, gap: FloatArray, outer_gap: float) -> FloatArray:
    """Integral of dA/h of bodies that do not touch, 2 pi sqrt(Rx Ry) ln(1 + h_out/h) [m].

    Parameters
    ----------
    ellipse : Ellipse
        The contact.
    gap : array
        Smallest gap h [m], > 0.
    outer_gap : float
        Gap at which the oil ends [m].
    """
    area = math.sqrt(ellipse.rolling_radius * ellipse.transverse_radius)
    return np.asarray(2.0 * math.pi * area * np.log1p(outer_gap / gap))


def open_line(radius: float, gap: FloatArray) -> FloatArray:
    """Integral of dx/h of a roller that does not touch, pi sqrt(2 R/h), a number a length.

    Parameters
    ----------
    radius : float
        Reduced radius R [m].
    gap : array
        Smallest gap h [m], > 0.
    """
    return np.asarray(math.pi * np.sqrt(2.0 * radius / gap))


def _outlets(
    radius: float, half: FloatArray, film: FloatArray, permittivity: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Outlet of lines full of oil, with oil beside gas, under gas, and with gas alone, as integrals in oil."""
    full = _opening(radius, half, film)
    eta = _eta(radius, half, film)
    spline = _beside_lines()
    # Int h_c dx/h^2 = -d/d ln h_c of the integral; layers in series are a gap that opens as much faster
    squared = (2.0 * radius / half) * np.exp(spline(np.log(eta))) * -spline(np.log(eta), 1)
    beside_gas = squared + (full - squared) / permittivity
    under_gas = _opening(radius, half, film / permittivity) / permittivity
    return full, beside_gas, under_gas, full / permittivity


def _eta(radius: float, half: FloatArray, film: FloatArray) -> FloatArray:
    """2 R h/b^2 within what is tabulated."""
    return np.asarray(np.clip(2.0 * radius * film / half**2, _THIN, _THICKEST))


def _opening(radius: float, half: FloatArray, film: FloatArray) -> FloatArray:
    """Integral of dx/(h + gap) from the edge of a line contact on."""
    return np.asarray((2.0 * radius / half) * np.exp(_beside_lines()(np.log(_eta(radius, half, film)))))


@lru_cache(maxsize=1)
def _beside_lines() -> CubicSpline:
    """ln o over ln eta: o = Int sinh s ds/(eta + cosh s sinh s - s) from 0 on."""
    eta = np.geomspace(_THIN, _THICKEST, 181)
    t = np.linspace(0.0, 1.0, 3001)
    s = 26.0 * t**2  # dense near the edge; the rest falls with e^-s
    opened = np.cosh(s) * np.sinh(s) - s
    values = [np.trapezoid(np.sinh(s) / (one + opened) * 52.0 * t, t) for one in eta]
    return CubicSpline(np.log(eta), np.log(values))


@lru_cache(maxsize=1)
def _beside_points() -> RectBivariateSpline:
    """w over ln kappa and ln(h/delta)."""
    shapes = np.geomspace(1.0, LONGEST, 12)
    eta = np.geomspace(_THIN, _THICK, 46)
    return RectBivariateSpline(np.log(shapes), np.log(eta), [_beside(float(kappa), eta) for kappa in shapes])


def _beside(kappa: float, eta: FloatArray) -> FloatArray:
    """w of one ellipse: Int dA/(gap + h) outside of it, less its logarithm, over 2 pi sqrt(Rx Ry)."""
    ellipse = Ellipse(1.0, max(1.0, 1.0 / float(curvature_ratio(kappa))), 1e9)
    a, b = (float(axis) for axis in ellipse.semi_axes(1.0))
    delta, square = float(ellipse.approach(1.0)), (b / a) ** 2
    # confocal ellipses: (1 + v^2), (square + v^2) are the squares of their semi-axes
    v = np.concatenate([[0.0], np.geomspace(1e-4, 3e3 * kappa, 400)])
    places, weights = np.polynomial.legendre.leggauss(5)
    step = 0.5 * np.diff(v)[:, None]
    nodes = 0.5 * (v[1:] + v[:-1])[:, None] + step * places
    slope = step * weights * 2.0 / np.sqrt((1.0 + nodes**2) * (square + nodes**2))
    along, across, plain = (
        np.concatenate([[0.0], np.cumsum(np.sum(part, axis=1))])
        for part in (slope / (1.0 + nodes**2), slope / (square + nodes**2), slope)
    )
    angles, shares = np.polynomial.legendre.leggauss(_ANGLES)
    angles, shares = 0.25 * math.pi * (angles + 1.0), math.pi * shares
    cosine, sine = np.cos(angles) ** 2, np.sin(angles) ** 2
    first, second = (1.0 + v**2)[:, None], (square + v**2)[:, None]
    gap = first * along[:, None] * cosine + second * across[:, None] * sine - plain[:, None]
    gap = np.maximum(gap, 0.0) / (plain[-1] + 2.0 / v[-1])
    area = v[:, None] * (second * cosine + first * sine) / np.sqrt(first * second)
    end = 0.3 * float(gap[-1].min())
    scale = a * a / (delta * 2.0 * math.pi * math.sqrt(ellipse.transverse_radius))
    found = np.zeros(eta.size)
    for index, share in enumerate(shares):
        last = int(np.searchsorted(gap[:, index], end))
        reach = np.append(v[:last], np.interp(end, gap[:, index], v))
        opened = np.append(gap[:last, index], end)
        widths = np.append(area[:last, index], np.interp(reach[-1], v, area[:, index]))
        found += share * np.trapezoid(widths / (opened + eta[:, None]), reach, axis=1)
    return np.asarray(scale * found - np.log1p(end / eta))
