"""How far the highest of sampled pressures may lie below the peak, which stands between the places; and in words.

The largest pressure of a film is that of a grid point. Where a cold or loaded oil makes a sharp spike, its tip is 1e-5
half-widths wide and less: it stands higher on every finer grid. The stated error bounds by how much. Against grids of
two to four times the density of cells, and tips resolved to 1e-6 half-widths, it did so at 252 of 254 spikes (FVA 3
and an oil ISO VG 320 at 0 to 120 degC, NU308 and N1014; the oils of `tests.benchmarks.bench_spikes`). Where it is above
`SHARP`, what was missing was a quarter of it in the median, less than half of it at 85 %, and 130 % of the pressure at
most; elsewhere 4 % of the pressure at most.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray

SHARP = 0.1
"""Stated error of a largest pressure above which that is missing of the tip of a sharp spike."""


def tip_words(error: float) -> str:
    """Say what a largest pressure lacks of the tip of a sharp spike; empty where there is none.

    Parameters
    ----------
    error : float
        Stated error of the pressure, or the largest one of several; NaN where none is known.

    Examples
    --------
    >>> tip_words(1.0516)
    'largest pressure: of a grid point; the tip of a sharp spike is higher, by 105 % at most, mostly less than half'
    >>> tip_words(0.01)
    ''
    """
    if not error > SHARP:
        return ""
    missing = f"by {100.0 * error:.0f} % at most, mostly less than half"
    return f"largest pressure: of a grid point; the tip of a sharp spike is higher, {missing}"


def peak_sampling_error(position: FloatArray, pressure: FloatArray, cusp: bool) -> float:
    """Share of the largest sampled pressure by which the peak between the places may rise above it.

    Parameters
    ----------
    position, pressure : array (n,)
        Rising places, and pressures there that are not negative; any units.
    cusp : bool
        Whether a peak may be a cusp, as the pressure spike of a piezoviscous oil is: half a step at the steeper of the
        slopes beside each local maximum then bounds it. Else the parabola through three places gives it.

    Examples
    --------
    The parabola 1 - x^2, sampled beside its top:

    >>> x = np.array([-0.9, -0.4, 0.1, 0.6])
    >>> round(0.99 * (1.0 + peak_sampling_error(x, 1.0 - x * x, cusp=False)), 12)
    1.0
    """
    tops = 1 + np.flatnonzero((pressure[1:-1] >= pressure[:-2]) & (pressure[1:-1] >= pressure[2:]))
    highest = float(np.max(pressure))
    if tops.size == 0 or highest <= 0.0:
        return 0.0
    top = highest
    for i in tops:
        left, right = position[i] - position[i - 1], position[i + 1] - position[i]
        rise, fall = (pressure[i] - pressure[i - 1]) / left, (pressure[i + 1] - pressure[i]) / right
        slope, curvature = (rise * right + fall * left) / (left + right), 2.0 * (fall - rise) / (left + right)
        above = 0.0
        if cusp:
            above = 0.5 * max(rise * right, -fall * left)
        elif curvature < 0.0:
            above = -0.5 * slope**2 / min(curvature, -1e-300)
        top = max(top, float(pressure[i] + above))
    return top / highest - 1.0
