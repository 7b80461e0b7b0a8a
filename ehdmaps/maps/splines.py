"""Cubic splines on uniform axes: coefficients for a kernel, weights for a table, Hermite pieces."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.linalg import solve_banded

from ehdmaps.physics._values import FloatArray


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
    rows = np.moveaxis(values, axis, 0)
    n = rows.shape[0]
    if n == 1:
        return np.ascontiguousarray(np.moveaxis(np.repeat(rows, degree + 1, axis=0), 0, axis))
    order = min(n, degree + 1)
    end = _alternating_binomials(order)
    bands = np.zeros((2 * order + 1, n + 2))
    matrix_rows = [(0, 0, end), *((i, i - 1, _AT_NODE[degree]) for i in range(1, n + 1)), (n + 1, n + 1 - order, end)]
    for row, first, entries in matrix_rows:
        for column, entry in enumerate(entries, start=first):
            bands[order + row - column, column] = entry
    right = np.zeros((n + 2, rows[0].size))
    right[1:-1] = rows.reshape(n, -1)
    solved = solve_banded((order, order), bands, right)
    return np.ascontiguousarray(np.moveaxis(solved.reshape((n + 2, *rows.shape[1:])), 0, axis))


_AT_NODE = {2: (1.0 / 8.0, 6.0 / 8.0, 1.0 / 8.0), 3: (1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0)}
"""Values of the three B-splines that are not zero at a node."""


def _alternating_binomials(order: int) -> tuple[float, ...]:
    """Weights of a difference of that order."""
    weights = [1.0]
    for i in range(order):
        weights.append(-weights[-1] * (order - i) / (i + 1))
    return tuple(weights)


def spline_weights(nodes: FloatArray, wanted: FloatArray) -> FloatArray:
    """Matrix that takes values at nodes to values at other places.

    A cubic spline (of lower degree below four nodes) inside, its tangent outside, the constant of a single
    node.

    Parameters
    ----------
    nodes : array (n,)
        Rising.
    wanted : array (m,)
        Where values are wanted.

    Returns
    -------
    array (m, n)
        Weights.
    """
    if nodes.size == 1:
        return np.ones((wanted.size, 1))
    spline = make_interp_spline(nodes, np.eye(nodes.size), k=min(3, nodes.size - 1))
    inside = np.clip(wanted, nodes[0], nodes[-1])
    weights: FloatArray = spline(inside) + (wanted - inside)[:, None] * spline(inside, nu=1)
    return weights


def hermite(
    left: tuple[FloatArray, FloatArray], right: tuple[FloatArray, FloatArray], part: FloatArray, step: float
) -> tuple[FloatArray, FloatArray]:
    """Cubic with given values and slopes at both ends: its value and slope in between.

    Parameters
    ----------
    left, right : (values, slopes)
        At the ends of the piece.
    part : array
        Place in the piece, 0 to 1.
    step : float
        Length of the piece.
    """
    (y0, m0), (y1, m1) = left, right
    rise = (y1 - y0) / step
    bend0 = 3.0 * rise - 2.0 * m0 - m1
    bend1 = m0 + m1 - 2.0 * rise
    value = y0 + step * part * (m0 + part * (bend0 + part * bend1))
    slope = m0 + part * (2.0 * bend0 + 3.0 * part * bend1)
    return value, slope
