"""Mix solved lines at constant zeta: the compiled inner loop of the backbone field."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit


@njit(error_model="numpy")
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
    last = lattice.shape[1] - 2
    for i in range(zeta.size):
        place = (zeta[i] - first) / spacing
        cell = min(max(int(np.floor(place)), 0), last)
        t = min(max(place - cell, 0.0), 1.0)
        beyond = (place - cell - t) * spacing
        s = 1.0 - t
        value_0, value_1 = s * s * (1.0 + 2.0 * t), t * t * (3.0 - 2.0 * t)
        slope_0, slope_1 = t * s * s * spacing, -t * t * s * spacing
        film, rate, loss = 0.0, 0.0, 0.0
        for m in range(lines.size):
            a, b = lattice[lines[m], cell], lattice[lines[m], cell + 1]
            here = value_0 * a[1] + value_1 * b[1] + slope_0 * a[2] + slope_1 * b[2]
            film += weights[m] * (value_0 * a[0] + value_1 * b[0] + slope_0 * a[1] + slope_1 * b[1] + here * beyond)
            rate += weights[m] * here
            end = (b[4] if t == 1.0 else a[4]) * beyond
            loss += weights[m] * (value_0 * a[3] + value_1 * b[3] + slope_0 * a[4] + slope_1 * b[4] + end)
        out[0, i], out[1, i], out[2, i] = film, rate, loss
