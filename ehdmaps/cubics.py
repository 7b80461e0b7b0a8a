"""Cubics through points, as `scipy.interpolate` has them, whose import takes a third of a second.

Values along the first axis, lines along the others. Steps follow those of scipy, so that numbers are equal to the last
bit where the processor rounds each operation.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg import solve, solve_banded

from ehdmaps.arrays import FloatArray

Values = npt.NDArray[Any]
"""Real or complex numbers."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """Polynomials between places, the end ones beyond; as `scipy.interpolate.PPoly`.

    Attributes
    ----------
    c : ndarray, shape (k, n - 1, ...)
        Coefficients, the highest power first.
    x : ndarray, shape (n,)
        Places between which they hold, rising.
    """

    c: Values
    x: FloatArray

    def __call__(self, at: npt.ArrayLike, order: int = 0) -> Values:
        """Values, or derivatives of an order, at places of any shape; (*at.shape, ...).

        Parameters
        ----------
        at : array
            Places that are read, of any shape.
        order : int
            Order of the derivative.
        """
        places = np.asarray(at, dtype=np.float64)
        flat = places.ravel()
        cell = np.clip(np.searchsorted(self.x, flat, side="right") - 1, 0, self.x.size - 2)
        along = (flat - self.x[cell]).reshape(-1, *(1,) * (self.c.ndim - 2))
        found, power = np.zeros((flat.size, *self.c.shape[2:]), dtype=self.c.dtype), np.ones_like(along)
        for exponent in range(order, self.c.shape[0]):
            term = self.c[self.c.shape[0] - 1 - exponent, cell] * power
            for factor in range(exponent, exponent - order, -1):
                term = term * float(factor)
            found = found + term
            power = power * along
        return found.reshape(places.shape + self.c.shape[2:])

    def derivative(self) -> Pieces:
        """Its derivative."""
        powers = np.arange(self.c.shape[0] - 1.0, 0.0, -1.0).reshape(-1, *(1,) * (self.c.ndim - 1))
        return Pieces(self.c[:-1] * powers, self.x)

    def antiderivative(self) -> Pieces:
        """Integral from the first place on."""
        powers = np.arange(self.c.shape[0], 0.0, -1.0).reshape(-1, *(1,) * (self.c.ndim - 1))
        whole = np.concatenate([self.c / powers, np.zeros_like(self.c[:1])])
        step = np.diff(self.x).reshape(-1, *(1,) * (self.c.ndim - 2))
        rises, power = [], step
        for coefficient in whole[-2::-1]:
            rises.append(coefficient * power)
            power = power * step
        # the ends of the pieces, term by term
        terms = np.stack(rises, axis=1)[:-1]
        ends = np.add.accumulate(terms.reshape(-1, *terms.shape[2:]), axis=0)[len(rises) - 1 :: len(rises)]
        whole[-1, 1:] = ends
        return Pieces(whole, self.x)


def cubic_spline(x: FloatArray, y: Values, ends: tuple[tuple[int, Values], tuple[int, Values]] | None = None) -> Pieces:
    """Cubic spline through points; as `scipy.interpolate.CubicSpline`.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Places, rising, two or more.
    y : ndarray, shape (n, ...)
        Values there.
    ends : ((order, values), (order, values)), optional
        First or second derivative at either end; without them the first two pieces are one cubic, and the last two.

    Examples
    --------
    >>> cubes = cubic_spline(np.array([0.0, 1.0, 3.0, 4.0]), np.array([0.0, 1.0, 27.0, 64.0]))
    >>> cubes(2.0).round(12).item(), cubes(2.0, 1).round(12).item(), cubes.antiderivative()(4.0).round(12).item()
    (8.0, 12.0, 64.0)
    """
    y = np.asarray(y)
    step = np.diff(x)
    wide = step.reshape(-1, *(1,) * (y.ndim - 1))
    rise = np.diff(y, axis=0) / wide
    if ends is None and x.size <= 3:
        return hermite_cubic(x, y, _slopes_of_few(step, wide, rise))
    matrix, right = np.zeros((3, x.size)), np.empty(y.shape, dtype=y.dtype)
    matrix[1, 1:-1], matrix[0, 2:], matrix[-1, :-2] = 2.0 * (step[:-1] + step[1:]), step[:-1], step[1:]
    right[1:-1] = 3.0 * (wide[1:] * rise[:-1] + wide[:-1] * rise[1:])
    if ends is None:
        first, last = x[2] - x[0], x[-1] - x[-3]
        matrix[1, 0], matrix[0, 1], matrix[1, -1], matrix[-1, -2] = step[1], first, step[-2], last
        right[0] = ((wide[0] + 2.0 * first) * wide[1] * rise[0] + wide[0] ** 2 * rise[1]) / first
        right[-1] = (wide[-1] ** 2 * rise[-2] + (2.0 * last + wide[-1]) * wide[-2] * rise[-1]) / last
    else:
        for (order, value), end, beside, row, sign in ((ends[0], 0, 1, 0, -1.0), (ends[1], -1, -2, -1, 1.0)):
            if order == 1:
                matrix[1, end], matrix[row, beside], right[end] = 1.0, 0.0, value
            else:
                matrix[1, end], matrix[row, beside] = 2.0 * step[end], step[end]
                risen = y[1] - y[0] if end == 0 else y[-1] - y[-2]
                right[end] = sign * 0.5 * value * step[end] ** 2 + 3.0 * risen
    slopes = solve_banded((1, 1), matrix, right.reshape(x.size, -1), check_finite=False)
    return hermite_cubic(x, y, slopes.reshape(y.shape))


def _slopes_of_few(step: FloatArray, wide: FloatArray, rise: Values) -> Values:
    """Slopes of the line through two points, or of the parabola through three."""
    if step.size == 1:
        return np.concatenate([rise, rise])
    matrix = np.array([[1.0, 1.0, 0.0], [step[1], 2.0 * (step[0] + step[1]), step[0]], [0.0, 1.0, 1.0]])
    right = np.stack([2.0 * rise[0], 3.0 * (wide[0] * rise[1] + wide[1] * rise[0]), 2.0 * rise[1]])
    return np.asarray(solve(matrix, right.reshape(3, -1), check_finite=False)).reshape(right.shape)


def monotone_cubic(x: FloatArray, y: FloatArray) -> Pieces:
    """Cubics that rise and fall where the points do; as `scipy.interpolate.PchipInterpolator`.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Places, rising, two or more.
    y : ndarray, shape (n, ...)
        Values there.

    References
    ----------
    F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304.

    Examples
    --------
    >>> monotone_cubic(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0]))(1.5).item()
    1.0
    """
    step = np.diff(x).reshape(-1, *(1,) * (y.ndim - 1))
    rise = np.diff(y, axis=0) / step
    if x.size == 2:
        return hermite_cubic(x, y, np.concatenate([rise, rise]))
    signs = np.sign(rise)
    flat = (signs[1:] != signs[:-1]) | (rise[1:] == 0.0) | (rise[:-1] == 0.0)
    left, right = 2.0 * step[1:] + step[:-1], step[1:] + 2.0 * step[:-1]
    slopes = np.zeros_like(y)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (left / rise[:-1] + right / rise[1:]) / (left + right)
        slopes[1:-1] = np.where(flat, 0.0, 1.0 / mean)
    slopes[0] = _end_slope(step[0], step[1], rise[0], rise[1])
    slopes[-1] = _end_slope(step[-1], step[-2], rise[-1], rise[-2])
    return hermite_cubic(x, y, slopes)


def _end_slope(step: FloatArray, beside: FloatArray, rise: FloatArray, next_rise: FloatArray) -> FloatArray:
    """Slope at an end by three points, which keeps the shape."""
    slope = ((2.0 * step + beside) * rise - step * next_rise) / (step + beside)
    steep = (np.sign(rise) != np.sign(next_rise)) & (np.abs(slope) > 3.0 * np.abs(rise))
    slope = np.where(steep, 3.0 * rise, slope)
    return np.where(np.sign(slope) != np.sign(rise), 0.0, slope)


def hermite_cubic(x: FloatArray, y: Values, slopes: Values) -> Pieces:
    """Cubics with given values and slopes; as `scipy.interpolate.CubicHermiteSpline`.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Places, rising, two or more.
    y, slopes : ndarray, shape (n, ...)
        Values and derivatives there.
    """
    step = np.diff(x).reshape(-1, *(1,) * (y.ndim - 1))
    rise = np.diff(y, axis=0) / step
    turn = (slopes[:-1] + slopes[1:] - 2.0 * rise) / step
    return Pieces(np.stack([turn / step, (rise - slopes[:-1]) / step - turn, slopes[:-1], y[:-1]]), x)
