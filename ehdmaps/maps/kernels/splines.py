"""Cubic splines on uniform axes: coefficients for a kernel, weights for a table, Hermite pieces; mixed lines."""

from __future__ import annotations

import ctypes
import functools
import math
from collections.abc import Callable

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.linalg.lapack import dgtsv

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.kernel import library
from ehdmaps.kernel.record import at


def spline_coefficients(values: FloatArray, axis: int, degree: int) -> FloatArray:
    """Coefficients of the B-spline of degree 2 or 3 through values at uniform nodes.

    Parameters
    ----------
    values : array
        n values along `axis`.
    axis : int
        The uniform axis.
    degree : {2, 3}
        The cubic has its knots at the nodes, the quadratic between them.

    Returns
    -------
    array
        n + 2 coefficients along `axis`, each belonging to a node, the first and the last to one outside. They
        continue the coefficients as a polynomial of that degree at both ends (not-a-knot), of degree n - 1 if
        there are too few. A single value becomes degree + 1 equal coefficients, a constant.
    """
    n = values.shape[axis]
    if n == 1:
        return np.ascontiguousarray(np.repeat(values, degree + 1, axis=axis))
    matrix = np.zeros((n + 2, n + 2))
    for i in range(1, n + 1):
        matrix[i, i - 1 : i + 2] = _AT_NODE[degree]
    # A difference of the coefficients vanishes at both ends.
    order = min(n, degree + 1)
    end = [(-1.0) ** i * math.comb(order, i) for i in range(order + 1)]
    matrix[0, : order + 1] = matrix[-1, -order - 1 :] = end
    solved = np.tensordot(np.linalg.inv(matrix)[:, 1:-1], values, (1, axis))
    return np.ascontiguousarray(np.moveaxis(solved, 0, axis))


_AT_NODE = {2: (1.0 / 8.0, 6.0 / 8.0, 1.0 / 8.0), 3: (1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0)}
"""Values of the three B-splines that are not zero at a node."""


def spline_weights(nodes: FloatArray, wanted: FloatArray) -> FloatArray:
    """Matrix that takes values at nodes to values at other places.

    A cubic spline (of lower degree below four nodes) inside, its tangent outside, the constant of a single
    node.

    Parameters
    ----------
    nodes : array (n,)
        Nodes, rising.
    wanted : array (m,)
        Places where values are wanted.

    Returns
    -------
    array (m, n)
        Weights of the values at the nodes.
    """
    if nodes.size == 1:
        return np.ones((wanted.size, 1))
    spline = make_interp_spline(nodes, np.eye(nodes.size), k=min(3, nodes.size - 1))
    inside = np.clip(wanted, nodes[0], nodes[-1])
    weights: FloatArray = spline(inside) + (wanted - inside)[:, None] * spline(inside, nu=1)
    return weights


def spline_slopes(nodes: FloatArray, values: FloatArray) -> FloatArray:
    """Slopes at its nodes of a cubic spline, not-a-knot: those of `scipy.interpolate.CubicSpline`, with less overhead.

    Parameters
    ----------
    nodes, values : array (n,)
        Nodes, rising, at least four, and the values there.

    Examples
    --------
    >>> spline_slopes(np.array([0.0, 1.0, 3.0, 4.0]), np.array([1.0, 8.0, 64.0, 125.0])).round(12)
    array([ 3., 12., 48., 75.])
    """
    step = np.diff(nodes)
    rise = np.diff(values) / step
    first, last = step[0] + step[1], step[-1] + step[-2]
    lower, upper = np.append(step[1:], last), np.append(first, step[:-1])
    middle, right = np.empty_like(values), np.empty_like(values)
    middle[0], middle[1:-1], middle[-1] = step[1], 2.0 * (step[:-1] + step[1:]), step[-2]
    right[0] = ((step[0] + 2.0 * first) * step[1] * rise[0] + step[0] ** 2 * rise[1]) / first
    right[1:-1] = 3.0 * (step[1:] * rise[:-1] + step[:-1] * rise[1:])
    right[-1] = (step[-1] ** 2 * rise[-2] + (2.0 * last + step[-1]) * step[-2] * rise[-1]) / last
    slopes: FloatArray = dgtsv(lower, middle, upper, right)[3]
    return slopes


def hermite(
    left: tuple[FloatArray, FloatArray],
    right: tuple[FloatArray, FloatArray],
    part: FloatArray,
    step: float | FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Cubic with given values and slopes at both ends: its value and slope in between.

    Parameters
    ----------
    left, right : (values, slopes)
        Values and slopes at the ends of the piece.
    part : array
        Place in the piece, 0 to 1.
    step : float or array
        Length of the piece.
    """
    (y0, m0), (y1, m1) = left, right
    rise = (y1 - y0) / step
    bend0 = 3.0 * rise - 2.0 * m0 - m1
    bend1 = m0 + m1 - 2.0 * rise
    value = y0 + step * part * (m0 + part * (bend0 + part * bend1))
    slope = m0 + part * (2.0 * bend0 + 3.0 * part * bend1)
    return value, slope


@functools.cache
def _lines() -> Callable[..., None]:
    """The function of the C library that mixes lines."""
    pointer, count, number = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double
    return library.function(
        "ehd_table_lines", pointer, count, number, number, count, pointer, pointer, count, pointer, pointer, result=None
    )


def mix_lines(
    lattice: FloatArray,
    first: float,
    spacing: float,
    lines: IntArray,
    weights: FloatArray,
    zeta: FloatArray,
    out: FloatArray,
) -> None:
    """Weighted sum of some lines at each zeta, by cubic Hermite on their common lattice, linear beyond its ends.

    Parameters
    ----------
    lattice : ndarray, shape (lines, nodes, 5)
        ln(film number), its slope, the slope of that, scaled loss, its slope, over zeta.
    first, spacing : float
        First zeta of the lattice, and its step.
    lines, weights : ndarray, shape (m,)
        Which lines, how much of each.
    zeta : ndarray, shape (n,)
        Places on the line.
    out : ndarray, shape (3, n)
        Filled with ln(film number), its slope, scaled loss.
    """
    lattice, weights, zeta = (np.ascontiguousarray(part, np.float64) for part in (lattice, weights, zeta))
    lines, into = np.ascontiguousarray(lines, np.int64), np.empty(out.shape)
    _lines()(
        at(lattice), lattice.shape[1], first, spacing, lines.size, at(lines), at(weights), zeta.size, at(zeta), at(into)
    )
    out[...] = into
