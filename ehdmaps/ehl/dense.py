"""Dense linear systems in compiled code: rows scaled, LU factors with row pivoting, and what they solve.

Four columns at a time are factorised beside the matrix, where a column lies in one piece; then four rows at once lose
what those columns explain of them (the right-looking scheme of LAPACK's getrf). The matrix is filled up to a multiple
of four with rows of the unit matrix, so that there are no remainders. At the sizes of a line contact this takes half
the time of a general library.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit

_BLOCK = 4


class Factorised(NamedTuple):
    """LU factors of a matrix, shape (size, size), filled up to a multiple of four.

    Attributes
    ----------
    factors : ndarray, shape (whole, whole)
        L below the diagonal, whose own is one, and U.
    scale : ndarray, shape (size,)
        What the rows of the matrix were multiplied by.
    order : ndarray of int, shape (whole,)
        The row of the matrix that each row of the factors stands for.
    singular : bool
        Whether a pivot is zero, or the matrix not finite.
    """

    factors: FloatArray
    scale: FloatArray
    order: IntArray
    singular: bool


@njit(error_model="numpy")
def factorised(matrix: FloatArray) -> Factorised:
    """Factorise a matrix, its rows scaled to a largest entry of one.

    Parameters
    ----------
    matrix : ndarray, shape (size, size)
        It stays as it is.
    """
    size = matrix.shape[0]
    whole = (size + _BLOCK - 1) // _BLOCK * _BLOCK
    factors, scale = np.zeros((whole, whole)), np.ones(size)
    for i in range(size):
        row, scaled = matrix[i], factors[i]
        largest = 0.0
        for j in range(size):
            largest = max(largest, abs(row[j]))
        if largest > 0.0:
            scale[i] = 1.0 / largest
        for j in range(size):
            scaled[j] = scale[i] * row[j]
    for i in range(size, whole):
        factors[i, i] = 1.0
    order, columns = np.arange(whole), np.empty((_BLOCK, whole))
    singular = False
    for first in range(0, whole, _BLOCK):
        _factorise_columns(factors, order, columns, first)
        for k in range(first, first + _BLOCK):
            singular |= not abs(factors[k, k]) > 0.0
        _subtract(factors, first)
    return Factorised(factors, scale, order, singular)


@njit(error_model="numpy", fastmath={"contract"})
def _factorise_columns(factors: FloatArray, order: IntArray, columns: FloatArray, first: int) -> None:
    """Pivots and multipliers of four columns, and the rows of U beside them."""
    whole, end = factors.shape[0], first + _BLOCK
    for i in range(first, whole):
        row = factors[i, first:end]
        for q in range(_BLOCK):
            columns[q, i] = row[q]
    for q in range(_BLOCK):
        k = first + q
        column = columns[q]
        pivot, largest = k, abs(column[k])
        for i in range(k + 1, whole):
            if abs(column[i]) > largest:
                pivot, largest = i, abs(column[i])
        if pivot != k:
            order[k], order[pivot] = order[pivot], order[k]
            _swap(factors[k], factors[pivot])
            for other in columns:
                other[k], other[pivot] = other[pivot], other[k]
        below = column[k + 1 :]
        share = 1.0 / column[k] if largest > 0.0 else 0.0
        for i in range(below.size):
            below[i] *= share
        for r in range(q + 1, _BLOCK):
            lower, times = columns[r, k + 1 :], columns[r, k]
            for i in range(below.size):
                lower[i] -= times * below[i]
    for i in range(first, whole):
        row = factors[i, first:end]
        for q in range(_BLOCK):
            row[q] = columns[q, i]
    for k in range(first + 1, end):
        right = factors[k, end:]
        for m in range(first, k):
            times, above = factors[k, m], factors[m, end:]
            for j in range(right.size):
                right[j] -= times * above[j]


@njit
def _swap(one: FloatArray, other: FloatArray) -> None:
    """Exchange two rows."""
    for j in range(one.size):
        one[j], other[j] = other[j], one[j]


@njit(fastmath={"contract"})
def _subtract(factors: FloatArray, first: int) -> None:
    """Take from the rows below what four rows of U explain of them."""
    end = first + _BLOCK
    u0, u1, u2, u3 = factors[first, end:], factors[first + 1, end:], factors[first + 2, end:], factors[first + 3, end:]
    for i in range(end, factors.shape[0], _BLOCK):
        (a0, a1, a2, a3), a = _multipliers(factors[i], first), factors[i, end:]
        (b0, b1, b2, b3), b = _multipliers(factors[i + 1], first), factors[i + 1, end:]
        (c0, c1, c2, c3), c = _multipliers(factors[i + 2], first), factors[i + 2, end:]
        (d0, d1, d2, d3), d = _multipliers(factors[i + 3], first), factors[i + 3, end:]
        for j in range(u0.size):
            v0, v1, v2, v3 = u0[j], u1[j], u2[j], u3[j]
            a[j] -= a0 * v0 + a1 * v1 + a2 * v2 + a3 * v3
            b[j] -= b0 * v0 + b1 * v1 + b2 * v2 + b3 * v3
            c[j] -= c0 * v0 + c1 * v1 + c2 * v2 + c3 * v3
            d[j] -= d0 * v0 + d1 * v1 + d2 * v2 + d3 * v3


@njit
def _multipliers(row: FloatArray, first: int) -> tuple[float, float, float, float]:
    """Four entries of a row of L."""
    return row[first], row[first + 1], row[first + 2], row[first + 3]


@njit(error_model="numpy")
def solved(lu: Factorised, right: FloatArray) -> FloatArray:
    """Solve matrix z = right, both of shape (size,); infinite where the matrix is singular."""
    factors, size = lu.factors, right.size
    if lu.singular:
        return np.full(size, np.inf)
    z = np.zeros(factors.shape[0])
    for i in range(size):
        z[i] = lu.scale[lu.order[i]] * right[lu.order[i]]
    for first in range(0, z.size, _BLOCK):
        _take(factors, first, 0, first, z)
        for i in range(first + 1, first + _BLOCK):
            for j in range(first, i):
                z[i] -= factors[i, j] * z[j]
    for first in range(z.size - _BLOCK, -1, -_BLOCK):
        end = first + _BLOCK
        _take(factors, first, end, z.size, z)
        for i in range(end - 1, first - 1, -1):
            for j in range(i + 1, end):
                z[i] -= factors[i, j] * z[j]
            z[i] /= factors[i, i]
    return z[:size]


@njit(fastmath={"contract", "reassoc"})
def _take(factors: FloatArray, first: int, begin: int, end: int, z: FloatArray) -> None:
    """Take from four sums of z what their rows make of the unknowns from begin to end, which are known."""
    a, b, known = factors[first, begin:end], factors[first + 1, begin:end], z[begin:end]
    c, d = factors[first + 2, begin:end], factors[first + 3, begin:end]
    s0 = s1 = s2 = s3 = 0.0
    for j in range(known.size):
        s0 += a[j] * known[j]
        s1 += b[j] * known[j]
        s2 += c[j] * known[j]
        s3 += d[j] * known[j]
    z[first] -= s0
    z[first + 1] -= s1
    z[first + 2] -= s2
    z[first + 3] -= s3
