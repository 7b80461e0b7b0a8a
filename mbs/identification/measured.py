"""Measurements of a machine at one speed: frequency responses or modes, each with what noise leaves open."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.units import RPM
from mbs.model.elements import Input, Sensor

POOREST = 0.3
"""Relative deviation from which on a line is in its noise, and left out: kept, such lines pull a fit off."""

ASSUMED = 0.02, 0.01
"""Relative deviation of a line where no coherence tells it, and beside it the part of the median of its channel."""

FREQUENCY_DEVIATION, DAMPING_DEVIATION = 0.002, 0.05
"""Relative deviation of frequencies and damping ratios of modes that state none."""


@dataclass(frozen=True, eq=False)
class MeasuredResponses:
    """Frequency responses at one speed.

    Attributes
    ----------
    label : str
        File, for people.
    speed : float
        Speed of the system [rad/s].
    frequencies : array, shape (lines,)
        [Hz].
    response : array, shape (lines, rows)
        Responses in the SI unit of each sensor per N or N m.
    deviation : array, shape (lines, rows)
        Standard deviation of each complex value over its size, at least `POOREST` where it is left out.
    rows : tuple of (Sensor, Input)
        What each row is: sensor and input of the scene, with the quantity that was measured.
    decay : float
        1/tau of the exponential window that force and response have been through [1/s].
    """

    label: str
    speed: float
    frequencies: FloatArray
    response: ComplexArray
    deviation: FloatArray
    rows: tuple[tuple[Sensor, Input], ...]
    decay: float = 0.0

    @property
    def channels(self) -> tuple[str, ...]:
        """Each row in words."""
        return tuple(f"{sensor.name} by {entry.name} at {RPM.text(self.speed)}" for sensor, entry in self.rows)

    def weights(self, widened: float = 0.0) -> FloatArray:
        """Weight of a logarithmic residual of each value, 0 of what is left out, shape (lines, rows).

        Parameters
        ----------
        widened : float
            Relative deviation that every line gets beside its own, so that peaks are felt from afar.
        """
        deviation = np.hypot(self.deviation, widened)
        return np.where(self.deviation < POOREST, np.sqrt(2.0) / deviation, 0.0)

    def thinned(self, most: int) -> MeasuredResponses:
        """Every n-th line, so that there are `most` at most."""
        every = -(-self.frequencies.size // most)
        part = slice(None, None, every)
        return dataclasses.replace(
            self,
            frequencies=self.frequencies[part],
            response=self.response[part],
            deviation=self.deviation[part],
        )


@dataclass(frozen=True, eq=False)
class MeasuredModes:
    """Frequencies and damping ratios of modes at one speed.

    Attributes
    ----------
    label : str
        File, for people.
    speed : float
        Speed of the system [rad/s].
    frequency, frequency_deviation : array, shape (modes,)
        Frequencies, rising, and their standard deviations [Hz].
    damping_ratio, damping_deviation : array, shape (modes,)
        Damping ratios and their standard deviations; NaN where none was measured.
    shapes : array, shape (modes, sensors), or None
        Displacements of the sensors in each mode, of any size; modes are paired by them.
    sensors : tuple of Sensor
        Sensors of the shapes.
    """

    label: str
    speed: float
    frequency: FloatArray
    frequency_deviation: FloatArray
    damping_ratio: FloatArray
    damping_deviation: FloatArray
    shapes: ComplexArray | None = None
    sensors: tuple[Sensor, ...] = ()


LEAST = 1e-3
"""Least relative deviation of a line: windows, leakage and clocks leave as much."""

_SMOOTHED = 9
"""Lines over which noise is averaged."""

Measured = MeasuredResponses | MeasuredModes


def assumed_deviation(response: ComplexArray) -> FloatArray:
    """Relative deviation of responses whose coherence is not known, shape (lines, rows).

    Parameters
    ----------
    response : array, shape (lines, rows)
        Responses in any unit.
    """
    part, floor = ASSUMED
    size = np.abs(response)
    with np.errstate(divide="ignore", invalid="ignore"):
        noise = floor * np.median(size, axis=0) / size
    return np.asarray(np.hypot(part, np.where(np.isfinite(noise), noise, np.inf)), dtype=np.float64)


def noise_of(response: ComplexArray, coherence: FloatArray, averages: int) -> FloatArray:
    """Relative deviation of responses by their coherence, shape (lines, rows).

    The noise of a line, |H|^2 (1 - g^2)/((n - 1) g^2), is known to a third only by eight averages; it is smooth over
    frequency, so that its mean over some lines is taken. Single lines whose coherence is high by chance do not count
    then as measured.

    Parameters
    ----------
    response : array, shape (lines, rows)
        Responses in any unit.
    coherence : array, shape (lines, rows)
        Ordinary coherence; NaN where it is not known.
    averages : int
        Averages n, two at least.

    References
    ----------
    Bendat and Piersol, Random Data, 4th ed., section 9.1.
    """
    clipped = np.clip(coherence, 1e-12, 1.0)
    size = np.abs(response)
    noise = size**2 * (1.0 - clipped) / (max(averages - 1, 1) * clipped)
    smooth = uniform_filter1d(np.where(np.isfinite(noise), noise, 0.0), _SMOOTHED, axis=0, mode="nearest")
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.sqrt(smooth) / size
    return np.asarray(np.where(size > 0.0, np.maximum(found, LEAST), np.inf), dtype=np.float64)
