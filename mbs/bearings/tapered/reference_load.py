"""Dynamic equivalent reference load of ISO/TS 16281 of a roller bearing by the loads of all slices.

Each slice of each raceway has its own rating; the load of a slice over the rollers that pass it is a mean of the power
4 at the ring that turns against the load and 4.5 at the other one, and lives add up with the Weibull slope 9/8. The
factor for stress at edges is one: profiled rollers have none.

References
----------
ISO/TS 16281:2008, clause 5 (radial roller bearings with line contacts).
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray

_REDUCTION = 0.83
"""lambda nu of radial roller bearings."""


def reference_load(
    slices: FloatArray, rating: float, gamma: float, angle: float, *, inner_turns: bool = True
) -> tuple[float, float]:
    """Load P_ref [N], and the basic reference rating life L10r in millions of turns.

    Parameters
    ----------
    slices : array (2, Z, n)
        Loads of the slices of the inner and the outer contact of all rollers, in N.
    rating : float
        Dynamic rating C [N].
    gamma : float
        D cos(alpha)/d_m.
    angle : float
        Contact angle [rad].
    inner_turns : bool
        Whether the inner ring turns against the load.
    """
    count, number = slices.shape[1:]
    both = (1.038 * ((1.0 - gamma) / (1.0 + gamma)) ** (143.0 / 108.0)) ** 4.5
    roller = rating / (_REDUCTION * count * math.cos(angle))
    inner = roller / 0.378 * (1.0 + both) ** (2.0 / 9.0)
    outer = roller / 0.364 * (1.0 + 1.0 / both) ** (2.0 / 9.0)
    powers = (4.0, 4.5) if inner_turns else (4.5, 4.0)
    total = 0.0
    for loads, capacity, power in zip(slices, (inner, outer), powers, strict=True):
        mean = np.mean(loads**power, axis=0) ** (1.0 / power)
        total += float(np.sum((mean / (capacity * number ** (-7.0 / 9.0))) ** 4.5))
    life = total ** (-8.0 / 9.0) if total > 0.0 else math.inf
    return float(rating * life**-0.3), life
