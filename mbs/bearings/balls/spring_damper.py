"""A spring in series with a damper over a step in time, exact where its end moves evenly.

Its force f follows the approach of its end,

    f' = K approach' - f/theta,

so that over a step of h

    f <- exp(-a) f + K phi (approach - approach before),        a = h/theta, phi = (1 - exp(-a))/a,

with K and theta of the beginning of the step. Between two steps K follows the load: where it falls f falls in
proportion, where it rises f stays. Both take energy away.
"""

from __future__ import annotations

from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.lines import exp

_SHORT = 0.25
"""h/theta below which 1 - exp(-a) is its series, right to 1e-15."""


@njit(error_model="numpy", _nrt=False, forceinline=True)
def over_step(step: float, spring: float, time: float) -> tuple[float, float]:
    """Part of the force that is left at the end of a step, and the spring of the end [N/m]; without branches.

    Parameters
    ----------
    step : float
        Length of the step [s], >= 0.
    spring, time : float
        K [N/m] and theta > 0 [s].

    Examples
    --------
    >>> left, spring = over_step(1e-5, 1e8, 1e-5)
    >>> f"{left:.6f} {spring:.6g}"
    '0.367879 6.32121e+07'
    """
    a = step / time
    x = a if a < _SHORT else _SHORT
    series = 1.0 - x / 8.0 * (1.0 - x / 9.0 * (1.0 - x / 10.0 * (1.0 - x / 11.0 * (1.0 - x / 12.0))))
    series = 1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0 * (1.0 - x / 7.0 * series)))
    series = 1.0 - x / 2.0 * (1.0 - x / 3.0 * series)
    left = exp(-a)
    long = a >= _SHORT
    mean = (1.0 - left) / a if long else series
    left = left if long else 1.0 - a * series
    return (left if spring > 0.0 else 0.0), spring * mean


@njit(error_model="numpy", _nrt=False, forceinline=True)
def gone_on(force: float, left: float, pushed: float, spring: float, after: float) -> float:
    """Force at the end of a step, beside the spring there [N].

    Parameters
    ----------
    force, left : float
        f at the beginning [N], and the part that is left.
    pushed : float
        Spring of the end of the step times the way of the approach [N].
    spring, after : float
        K at the beginning and at the end [N/m].

    Examples
    --------
    >>> gone_on(10.0, 0.5, 3.0, 1e8, 2e8), gone_on(10.0, 0.5, 3.0, 1e8, 5e7)
    (8.0, 4.0)
    """
    found = left * force + pushed
    return found * after / spring if after < spring else found
