"""Elastic deflection of two half-spaces under a line pressure: the logarithmic kernel on a graded grid.

The gap grows by -(1/pi) Int P(S) ln|X - S| dS (lengths in b, pressures in p_H, gap in b^2/R). In the uniform index s of
the grid the integral is a trapezoidal sum; the singular node gets its own weight and a second-difference correction,
which makes the error O(ds^5) where P is smooth (Sidi & Israeli, J. Sci. Comput. 3 (1988) 201-231, with the
Euler-Maclaurin constant zeta'(-2)). Both ends of the sum need nothing: P and dP/dX vanish at the exit, and the inlet is
far away.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit

ZETA_PRIME_MINUS_TWO = -0.030448457058393270780
"""zeta'(-2) = -zeta(3)/(4 pi^2): weight of the second difference at the singular node."""

DRY_DATUM = -0.25 * (1.0 + 2.0 * math.log(2.0))
"""H0 of the dry Hertz contact for this kernel: H(X) = H0 + X^2/2 - (1/pi) Int P ln|X - S| dS vanishes for |X| <= 1."""


@njit
def log_kernel(x: FloatArray, step: FloatArray) -> FloatArray:
    """Matrix K with (K P)_i = (1/pi) Int P ln|x_i - S| dS.

    Parameters
    ----------
    x, step : ndarray, shape (n,)
        Nodes and dx/ds [b].

    Returns
    -------
    ndarray, shape (n, n)
    """
    n = x.size
    kernel = np.empty((n, n))
    weight = step / math.pi
    correction = ZETA_PRIME_MINUS_TWO
    for i in range(n):
        for j in range(i):
            value = math.log(x[i] - x[j])
            kernel[i, j] = value * weight[j]
            kernel[j, i] = value * weight[i]
    for i in range(n):
        kernel[i, i] = (math.log(step[i] / (2.0 * math.pi)) - 2.0 * correction) * weight[i]
        if i > 0:
            kernel[i, i - 1] += correction * weight[i - 1]
        if i < n - 1:
            kernel[i, i + 1] += correction * weight[i + 1]
    return kernel
