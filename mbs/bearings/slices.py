"""Powers in compiled code, for lines of tapered rollers; those of cylindrical ones are in C, see `ehdmaps.kernel`."""

from __future__ import annotations

import numpy as np

from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.lines import log

_LOG2_E = 1.4426950408889634
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_ROUNDING = 1.5 * 2.0**52
_MANTISSA = np.uint64(52)
_BIAS = np.uint64(1023)


@njit(error_model="numpy", fastmath={"contract", "nsz"}, forceinline=True)
def power(x: float, b: float) -> float:
    """x^b for a positive normal x, and a result between 1e-300 and 1e300; to some 1e-15 relative."""
    y = b * log(x)
    # Adding this number leaves the nearest whole number in the lowest bits.
    shifted = y * _LOG2_E + _ROUNDING
    n = shifted - _ROUNDING
    r = (y - n * _LN2_HIGH) - n * _LN2_LOW
    r2 = r * r
    r4 = r2 * r2
    low = (1.0 + r) + r2 * (1.0 / 2.0 + r * (1.0 / 6.0))
    middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0))
    high = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + r2 * (1.0 / 3628800.0 + r * (1.0 / 39916800.0))
    series = low + r4 * (middle + r4 * (high + r4 * (1.0 / 479001600.0)))
    bits = np.uint64(np.uint64(np.float64(shifted).view(np.uint64) + _BIAS) << _MANTISSA)
    value: float = series * bits.view(np.float64)
    return value
