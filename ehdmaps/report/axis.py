"""Axes of charts: their ends by the values that they show, the places of values along them, and their ticks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ehdmaps.arrays import FloatArray

_MOST_TICKS = 8
_BESIDE = 10.0
"""Factor by which a logarithmic axis of one value reaches to both sides."""

_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Axis:
    """An axis.

    Attributes
    ----------
    label, unit : str
        What it shows.
    kind : {"linear", "log", "symlog"}
        Spacing of the values; symlog is logarithmic both ways from zero, and linear within `linear`.
    low, high : float
        Ends of the axis in its unit; low < high, and above 0 where it is logarithmic.
    linear : float
        Values up to which symlog is linear.
    """

    label: str
    unit: str
    kind: Literal["linear", "log", "symlog"]
    low: float
    high: float
    linear: float = 1.0

    @property
    def title(self) -> str:
        """Text that is written beside it."""
        return f"{self.label}, {self.unit}" if self.unit else self.label

    def places(self, values: FloatArray) -> FloatArray:
        """Places along the axis, 0 at its low and 1 at its high end; NaN where a value has none.

        Parameters
        ----------
        values : ndarray
            Values in the unit of the axis.
        """
        low, high = self._scaled(np.array([self.low, self.high]))
        return np.asarray((self._scaled(values) - low) / (high - low))

    def _scaled(self, values: FloatArray) -> FloatArray:
        """Values on the scale on which the axis is even."""
        if self.kind == "log":
            return np.asarray(np.log10(np.where(values > 0.0, values, np.nan)))
        if self.kind == "symlog":
            return np.asarray(np.sign(values) * np.log1p(np.abs(values) / self.linear))
        return np.asarray(values, dtype=np.float64)

    @property
    def ticks(self) -> list[tuple[float, str]]:
        """Values that are written, with their texts."""
        if self.kind == "log":
            return [(value, f"{value:g}") for value in _log_ticks(self.low, self.high)]
        if self.kind == "symlog":
            most = max(abs(self.low), abs(self.high), self.linear)
            decades = [self.linear * 10.0**power for power in range(math.ceil(math.log10(most / self.linear)) + 1)]
            values = [-value for value in reversed(decades)] + [0.0, *decades]
            inside = [value for value in values if self.low <= value <= self.high]
            return [(value, f"{value:g}") for value in inside]
        return [(value, f"{value:g}") for value in _linear_ticks(self.low, self.high)]


def _log_ticks(low: float, high: float) -> list[float]:
    """Decades; also 2 and 5 where there are few of them, every second one where there are many, even steps in one."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    steps = (1.0, 2.0, 5.0) if math.log10(high / low) < 2.0 else (1.0,)
    every = max(math.ceil((last - first) / _MOST_TICKS), 1)
    powers = [power for power in range(first, last + 1) if power % every == 0]
    ticks = [step * 10.0**power for power in powers for step in steps]
    inside = [value for value in ticks if low * (1.0 - _ROUND_OFF) <= value <= high * (1.0 + _ROUND_OFF)]
    return inside if len(inside) > 1 else [value for value in _linear_ticks(low, high) if value > 0.0]


def _linear_ticks(low: float, high: float) -> list[float]:
    """Multiples of 1, 2 or 5 times a power of ten."""
    rough = (high - low) / (_MOST_TICKS - 2)
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= rough * (1.0 - _ROUND_OFF))
    first, last = math.ceil(low / step - _ROUND_OFF), math.floor(high / step + _ROUND_OFF)
    return [round(index * step, 12) for index in range(first, last + 1)]


def log_axis(label: str, unit: str, values: FloatArray, floor: float = 0.0, room: float = 1.0) -> Axis:
    """Return a logarithmic axis for some values.

    Parameters
    ----------
    label, unit : str
        What it shows.
    values : ndarray
        Values in its unit; those that are not above 0 are passed over.
    floor : float
        Share of the largest value below which nothing is shown.
    room : float
        Factor by which it reaches beyond its values.
    """
    known = values[np.isfinite(values) & (values > 0.0)]
    if not known.size:
        return Axis(label, unit, "log", 0.1, 10.0)
    high = float(known.max())
    low = max(float(known.min()), floor * high)
    if low == high:
        return Axis(label, unit, "log", low / _BESIDE, high * _BESIDE)
    return Axis(label, unit, "log", low / room, high * room)


def linear_axis(label: str, unit: str, values: FloatArray, from_zero: bool = True) -> Axis:
    """Return a linear axis for some values.

    Parameters
    ----------
    label, unit : str
        What it shows.
    values : ndarray
        Values in its unit.
    from_zero : bool
        Whether it begins at zero.
    """
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    low = min(low, 0.0) if from_zero else low
    return Axis(label, unit, "linear", low, high if high > low else low + max(abs(low), 1.0))


def symlog_axis(label: str, unit: str, values: FloatArray, linear: float) -> Axis:
    """Return an axis that is logarithmic both ways from zero.

    Parameters
    ----------
    label, unit : str
        What it shows.
    values : ndarray
        Values in its unit.
    linear : float
        Up to where it is linear.
    """
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if known.size else (-linear, linear)
    beyond = [1.3 * end if abs(end) > linear else end for end in (low, high)]
    low, high = min(beyond[0], 0.0), max(beyond[1], 0.0)
    return Axis(label, unit, "symlog", low, high if high > low else linear, linear)
