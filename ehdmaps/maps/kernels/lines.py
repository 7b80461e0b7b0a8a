"""Exponential, logarithm and the rule without tension, for kernels that numba compiles.

exp and log are own ones that the compiler can put into vector instructions, without a branch or a call: the textbook
reductions with Taylor series long enough for double precision, exp to 4e-16 relative for |x| < 700, log to 3e-16
absolute or relative for positive normal numbers.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.compiled import njit
from ehdmaps.physics.contact import unilateral_force as rule

_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_LOG2_E = 1.4426950408889634
_BIAS = np.uint64(1023 << 52)
_ROOT_HALF = np.uint64(0x3FE6A09E667F3BCD)
_WHOLE = np.uint64(0x4330000000000000)
_WHOLE_VALUE = 2.0**52 + 1023.0
_MANTISSA = np.uint64(52)


@njit(error_model="numpy", fastmath={"contract", "nsz"}, forceinline=True)
def exp(x: float) -> float:
    """e^x for |x| < 700; held there beyond."""
    x = x if x > -700.0 else -700.0
    x = x if x < 700.0 else 700.0
    n = math.floor(x * _LOG2_E + 0.5)
    r = (x - n * _LN2_HIGH) - n * _LN2_LOW
    r2 = r * r
    r4 = r2 * r2
    low = (1.0 + r) + r2 * (1.0 / 2.0 + r * (1.0 / 6.0))
    middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0))
    high = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + r2 * (1.0 / 3628800.0 + r * (1.0 / 39916800.0))
    last = 1.0 / 479001600.0 + r * (1.0 / 6227020800.0)
    series = low + r4 * (middle + r4 * (high + r4 * last))
    power: float = np.int64((np.int64(n) + 1023) << 52).view(np.float64)
    return series * power


@njit(error_model="numpy", fastmath={"contract", "nsz"}, forceinline=True)
def log(x: float) -> float:
    """Natural logarithm of a positive normal number."""
    bits = np.float64(x).view(np.uint64)
    # Sums in this order never leave the 64 bits, of which numpy warns where kernels run as Python.
    exponent = (bits + (_BIAS - _ROOT_HALF)) >> _MANTISSA
    e = np.uint64(exponent | _WHOLE).view(np.float64) - _WHOLE_VALUE
    m = np.uint64(bits + _BIAS - (exponent << _MANTISSA)).view(np.float64)
    f = (m - 1.0) / (m + 1.0)
    z = f * f
    z2 = z * z
    z4 = z2 * z2
    low = (2.0 / 3.0 + z * (2.0 / 5.0)) + z2 * (2.0 / 7.0 + z * (2.0 / 9.0))
    high = (2.0 / 11.0 + z * (2.0 / 13.0)) + z2 * (2.0 / 15.0 + z * (2.0 / 17.0))
    series = low + z4 * (high + z4 * (2.0 / 19.0 + z * (2.0 / 21.0)))
    value: float = e * _LN2_HIGH + (e * _LN2_LOW + f * (2.0 + z * series))
    return value


FAST = {"contract", "reassoc", "nsz", "arcp"}
"""What the compiler may rearrange; NaN and infinity keep their meaning."""

unilateral_force = njit(error_model="numpy", fastmath=FAST, forceinline=True)(rule)
"""The rule without tension, compiled as the kernels are that it becomes a part of."""


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def stretched(z: float) -> tuple[float, float]:
    """Return asinh(z), with a small absolute error, and its derivative."""
    root = math.sqrt(1.0 + z * z)
    size = log(abs(z) + root)
    return (size if z >= 0.0 else -size), 1.0 / root
