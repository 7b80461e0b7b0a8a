"""Levels in decibels: reference values, and from a mean square to a level.

References
----------
ISO 1683:2015, Acoustics - Preferred reference values for acoustical and vibratory levels: 1 pm of displacement, 1 nm/s
of velocity, 1 um/s2 of acceleration. Rotations have no reference there; the same numbers in rad, rad/s and rad/s2 are
used for them, and the unit says so.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.model.elements import Quantity, Sensor

SPREAD = (0.05, 0.5, 0.95)
"""Quantiles by which differences of levels are told."""

LOWEST = -200.0
"""Level of nothing [dB]: a signal of zero has this one and not minus infinity."""

REFERENCES: dict[Quantity, float] = {"displacement": 1e-12, "velocity": 1e-9, "acceleration": 1e-6}
"""Of ISO 1683 [m, m/s, m/s2]."""

_PER_TIME: dict[Quantity, str] = {"displacement": "", "velocity": "/s", "acceleration": "/s2"}


@dataclass(frozen=True)
class Reference:
    """Reference of the levels of a quantity.

    Attributes
    ----------
    quantity : {"displacement", "velocity", "acceleration"}
        What was measured.
    value : float
        Root mean square at 0 dB, in `unit`.
    unit : str
        m, m/s or m/s2; rad in place of m for rotations.
    """

    quantity: Quantity
    value: float
    unit: str

    @classmethod
    def of(cls, sensor: Sensor) -> Reference:
        """Reference of the quantity of a sensor."""
        return cls.of_quantity(sensor.quantity, bool(np.any(sensor.direction[3:])))

    @classmethod
    def of_quantity(cls, quantity: Quantity, rotational: bool = False) -> Reference:
        """Reference of a quantity, of translations or rotations."""
        return cls(quantity, REFERENCES[quantity], f"{'rad' if rotational else 'm'}{_PER_TIME[quantity]}")

    @property
    def text(self) -> str:
        """As on an axis, such as "dB re 1e-06 m/s2"."""
        return f"dB re {self.value:.0e} {self.unit}"


def level(mean_square: FloatArray, reference: float) -> FloatArray:
    """Level of a mean square [dB], at least `LOWEST`; NaN stays NaN.

    Parameters
    ----------
    mean_square : array
        [square of the unit].
    reference : float
        Root mean square at 0 dB [unit].

    Examples
    --------
    >>> round(float(level(np.array(0.5), 1e-6)), 2)  # a sine of 1 m/s2
    116.99
    """
    lowest = 10.0 ** (LOWEST / 10.0)
    # The square of a reference of 1e-12 is far from the smallest number, so divide before taking the logarithm.
    return np.asarray(10.0 * np.log10(np.maximum(mean_square / reference**2, lowest)), dtype=np.float64)


@dataclass(frozen=True)
class LevelDifference:
    """Difference of two courses of a level: other minus first.

    Attributes
    ----------
    low, median, high : float
        Differences at the same speed, at the quantiles `SPREAD` of the windows [dB].
    energy : float
        Difference of the mean energies: of the levels of the mean square over all windows [dB].
    highest : float
        Difference of the highest of each, at any speed [dB].
    """

    low: float
    median: float
    high: float
    energy: float
    highest: float

    @classmethod
    def of(cls, first: FloatArray, other: FloatArray) -> LevelDifference:
        """Compare two courses.

        Parameters
        ----------
        first, other : array, shape (windows,)
            Levels at the same speeds, in windows of one length [dB].

        Examples
        --------
        >>> difference = LevelDifference.of(np.array([80.0, 90.0, 100.0]), np.array([80.0, 85.0, 90.0]))
        >>> round(difference.median, 1), round(difference.energy, 1), difference.highest
        (-5.0, -8.9, -10.0)
        """
        low, median, high = (float(value) for value in np.quantile(other - first, SPREAD))
        energies = [float(10.0 * np.log10(np.mean(10.0 ** (values / 10.0)))) for values in (first, other)]
        return cls(low, median, high, energies[1] - energies[0], float(np.max(other) - np.max(first)))


def at_equal_speeds(
    speeds: FloatArray, levels: FloatArray, other_speeds: FloatArray, other: FloatArray
) -> tuple[FloatArray, FloatArray] | None:
    """Two courses of a level at the speeds of the first that lie within both; None where fewer than two do.

    Parameters
    ----------
    speeds, levels : array, shape (windows,)
        Speeds of the first course [rad/s], and its levels [dB].
    other_speeds, other : array, shape (other windows,)
        Those of the other one, in any order. Its levels are interpolated as mean squares.

    Examples
    --------
    >>> first = np.array([1.0, 2.0, 3.0]), np.array([80.0, 90.0, 100.0])
    >>> at_equal_speeds(*first, np.array([2.0, 5.0]), np.array([60.0, 60.0]))
    (array([ 90., 100.]), array([60., 60.]))
    """
    if np.array_equal(speeds, other_speeds):
        return levels, other
    order = np.argsort(other_speeds)
    inside = (speeds >= np.min(other_speeds)) & (speeds <= np.max(other_speeds))
    if np.count_nonzero(inside) < 2:
        return None
    powers = np.power(10.0, 0.1 * other[order])
    return levels[inside], level(np.interp(speeds[inside], other_speeds[order], powers), 1.0)


def difference_text(first: FloatArray, other: FloatArray) -> str:
    """Say how two courses of a level differ, window by window and not only where each is highest.

    Parameters
    ----------
    first, other : array, shape (windows,)
        Levels at the same speeds [dB].

    Examples
    --------
    >>> difference_text(np.array([80.0, 90.0, 100.0]), np.array([80.0, 85.0, 90.0]))
    'median -5.0 dB, 5 to 95 % of the windows -9.5 to -0.5 dB; highest of each, at any speed, -10.0 dB'
    """
    difference = LevelDifference.of(first, other)
    return (
        f"median {difference.median:.1f} dB, 5 to 95 % of the windows {difference.low:.1f} to {difference.high:.1f} "
        f"dB; highest of each, at any speed, {difference.highest:.1f} dB"
    )
