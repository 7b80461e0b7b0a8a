"""Heat in the surfaces of a contact: moving half-spaces, warmed by what flows into them.

T(X) = T_0 + B Int q(S)/sqrt(X - S) dS        J. C. Jaeger, Proc. R. Soc. NSW 76, 1942, 203-224
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit


@njit
def wall_weights(x: FloatArray, first: int) -> FloatArray:
    """Matrix of Int q(S)/sqrt(X - S) dS from place `first` on, q linear between places.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Places along the wall [b].
    first : int
        Place before which nothing flows.
    """
    n = x.size
    weights = np.zeros((n, n))
    for i in range(first + 1, n):
        for j in range(first, i):
            far, near = x[i] - x[j], x[i] - x[j + 1]
            if j + 1 == i:
                near = 0.0
            width = far - near
            a, b = math.sqrt(far), math.sqrt(near)
            total = 2.0 * width / (a + b)
            # Int of sqrt(t) dt, and of the distance from the nearer place, without differences of nearly equal numbers
            part = 2.0 / 3.0 * width * (far + a * b + near) / (a + b) - near * total
            weights[i, j] += part / width
            weights[i, j + 1] += total - part / width
    return weights
