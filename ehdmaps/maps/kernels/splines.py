"""Cubic splines on uniform axes: coefficients for a kernel, weights for a table, Hermite pieces; mixed lines."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable, Sequence

import numpy as np
from scipy.interpolate import make_interp_spline

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
    # a value is its coefficient and `side` times the second difference of the coefficients, of which this is a spline
    # too: a difference of it vanishes at both ends
    side, order = _AT_SIDE[degree], min(n, degree + 1)
    given = np.ascontiguousarray(np.moveaxis(values, axis, 0))
    bends = np.zeros_like(given)
    if n > 2:
        middle, beside = np.full(n - 2, 1.0 - 2.0 * side), np.full(n - 3, side)
        above, below = beside.copy(), beside.copy()
        middle[[0, -1]], above[:1], below[-1:] = (1.0, 0.0, 0.0) if order == 4 else (1.0 - side, side, side)
        if n == 3:
            middle[0] = 1.0
        inner = bends[1:-1]
        inner[:] = np.diff(given, 2, axis=0)
        for i in range(1, n - 2):
            factor = below[i - 1] / middle[i - 1]
            middle[i] -= factor * above[i - 1]
            inner[i] -= factor * inner[i - 1]
        inner[-1] /= middle[-1]
        for i in range(n - 4, -1, -1):
            inner[i] = (inner[i] - above[i] * inner[i + 1]) / middle[i]
        bends[0], bends[-1] = (2.0 * inner[0] - inner[1], 2.0 * inner[-1] - inner[-2]) if order == 4 else inner[[0, -1]]
    solved = np.empty((n + 2, *given.shape[1:]))
    solved[1:-1] = given - side * bends
    solved[0], solved[-1] = 2.0 * solved[1] - solved[2] + bends[0], 2.0 * solved[-2] - solved[-3] + bends[-1]
    return np.ascontiguousarray(np.moveaxis(solved, 0, axis))


_AT_SIDE = {2: 1.0 / 8.0, 3: 1.0 / 6.0}
"""Value of a B-spline at the nodes beside that where it is largest."""


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


@functools.cache
def _nodes() -> Callable[..., None]:
    """The function of the C library that makes the nodes of a table."""
    pointer, count = ctypes.c_void_p, ctypes.c_int64
    samples = [count, count, *[pointer] * 4]
    return library.function("ehd_law_nodes", *samples, count, count, *[pointer] * 3, result=None)


def law_nodes(samples: Sequence[FloatArray], nodes: FloatArray, held: int, values: FloatArray) -> None:
    """g and ln(c/w) at the nodes of the stretched approach s, from samples along lines.

    Cubics between the samples. g goes on along its tangent below them, and as an exponential above them; ln(c/w) along
    its tangents.

    Parameters
    ----------
    samples : four of ndarray, shape (n, ...)
        s, which rises along each line, g, dg/ds and ln(c/w), at n >= 4 samples.
    nodes : ndarray, shape (m,)
        Nodes of s, rising.
    held : int
        Number of the sample below which ln(c/w) stays what it is there; -1 for none.
    values : ndarray, shape (..., m, 2)
        Filled with g and ln(c/w) at the nodes.
    """
    nodes, *of = (np.ascontiguousarray(part, np.float64) for part in (nodes, *samples))
    lines = of[0][0].size
    room, into = np.empty(34 * len(of[0])), np.empty((lines, nodes.size, 2))
    _nodes()(len(of[0]), lines, *map(at, of), held, nodes.size, at(nodes), at(room), at(into))
    values[...] = into.reshape(values.shape)
