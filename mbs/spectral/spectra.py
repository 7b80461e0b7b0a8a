"""Short-time spectra of a signal while the speed changes: the power of each line, window by window.

A Hann window of length T slides over the signal. Power is scaled to mean squares: a sine of amplitude A has the power
A^2/2 in its peak line whatever T is, low by at most 0.09 dB between two lines (lines are four times denser than 1/T).
The sum over a band, times line distance and over noise bandwidth 1.5/T, is the mean square in the window (Parseval).

Resolution: a line at rest is 1.44/T wide (3 dB). An order N sweeps by N (dn/dt) T meanwhile, n in turns per second. The
default window makes both equal, T = sqrt(1.44/(N dn/dt)) for the highest order that is looked at: then its peak is
lower than at rest by 0.13 dB, and its line is 1.46/T wide. Lower orders smear less. Twice the window would make that
line a sixth narrower and take 1 dB more off its peak; modes are resolved the better the longer the window is.

References
----------
F. J. Harris, Proc. IEEE 66 (1978) 51-83 (Hann: noise bandwidth 1.5, 3 dB width 1.44 lines).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy  # its parts at first use: scipy.signal takes half a second
from scipy.fft import next_fast_len

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.units import written
from mbs.spectral.run_signal import RPM, RunSignal

LINE_WIDTH = 1.44
"""3 dB width of a line of a Hann window, times its length."""

LEAST_OVERSAMPLING = 2.5
"""Samples per second over the highest frequency: twice, and room for the flank of a filter against aliasing."""

LEAST_PERIODS = 8
"""Of the highest frequency in a window."""

LONGEST_PART = 0.5
"""Longest window, of the duration of the run."""

_DENSITY = 4
_MOST_VALUES = 40_000_000

MOST_WINDOWS = 20_000
"""Each takes some 0.1 ms, however short it is."""

_CHUNK = 2_000_000
_SAME_SPEED = 1e-6
_DEFAULT_PART = 0.05


@dataclass(frozen=True, eq=False)
class Spectra:
    """Power spectra, one a window.

    Attributes
    ----------
    time, speeds : array, shape (windows,)
        Time [s] and speed [rad/s] at the middle of each window.
    frequencies : array, shape (lines,)
        [Hz].
    power : array, shape (windows, lines)
        Mean square of a sine at each line [square of the unit].
    window : float
        Length of the windows [s].
    noise_bandwidth : float
        Noise bandwidth of a line [Hz]: white noise of density 1/Hz has this power in each line.
    """

    time: FloatArray
    speeds: FloatArray
    frequencies: FloatArray
    power: FloatArray
    window: float
    noise_bandwidth: float

    def mean_square(self) -> FloatArray:
        """Mean square of the signal in each window, of all lines, shape (windows,) [square of the unit]."""
        distance = float(self.frequencies[1] - self.frequencies[0])
        return np.asarray(self.power.sum(axis=1) * distance / self.noise_bandwidth, dtype=np.float64)


def default_window(ramp: RunSignal, highest_order: float) -> float:
    """Window in which the highest order sweeps by the width of a line, at most a twentieth of the run [s].

    Parameters
    ----------
    ramp : RunSignal
        Whose speed changes.
    highest_order : float
        Order that is looked at with the highest frequency.
    """
    rise = np.max(np.abs(np.gradient(ramp.speed, ramp.time))) / (2.0 * math.pi)
    return min(math.sqrt(LINE_WIDTH / (highest_order * float(rise))), _DEFAULT_PART * ramp.duration)


def short_time_spectra(run: RunSignal, window: float, band: tuple[float, float]) -> Spectra:
    """Spectra of windows that lie in the run as a whole and overlap by three quarters; each without its weighted mean.

    Parameters
    ----------
    run : RunSignal
        The signal.
    window : float
        Length of a window [s]; 8 periods of the highest frequency to half the run.
    band : (float, float)
        Lowest and highest frequency [Hz].

    Raises
    ------
    InputError
        With every value that is not possible, or whose result would be too large.
    """
    problems = Problems([*_band_problems(run, band), *_window_problems(run, window, band)])
    problems.check()
    length = 2 * round(0.5 * window * run.rate)
    hop = max(length // 4, 1)
    weights = scipy.signal.get_window("hann", length)
    transform = scipy.signal.ShortTimeFFT(weights, hop, run.rate, mfft=next_fast_len(_DENSITY * length, real=True))
    lines = np.flatnonzero((transform.f >= band[0]) & (transform.f <= band[1]))
    first, last = transform.lower_border_end[1], transform.upper_border_begin(run.signal.size)[1]
    if last - first > MOST_WINDOWS or (last - first) * lines.size > _MOST_VALUES:
        raise InputError(
            f"spectra: got {last - first} windows of {lines.size} lines each; allowed: {MOST_WINDOWS} windows, and "
            f"{_MOST_VALUES} values in all; take a longer window, a lower highest frequency or a part of the run"
        )
    # Positive and negative frequencies together, but at zero and at half the rate, which are their own mirror images.
    twice = np.where((lines == 0) | (2 * lines == transform.mfft), 1.0, 2.0)[:, None] / weights.sum() ** 2
    power = np.empty((last - first, lines.size))
    windows = max(_CHUNK // transform.mfft, 1)
    for begin in range(first, last, windows):
        end = min(begin + windows, last)
        parts = transform.stft_detrend(run.signal, without_mean(weights), begin, end)[lines]
        power[begin - first : end - first] = (twice * (parts.real**2 + parts.imag**2)).T
    middles = np.arange(first, last) * hop
    noise_bandwidth = run.rate * float((weights**2).sum() / weights.sum() ** 2)
    return Spectra(run.time[middles], run.speed[middles], transform.f[lines], power, length / run.rate, noise_bandwidth)


@dataclass(frozen=True, eq=False)
class AmplitudeSpectrum:
    """Amplitudes of the sines in a signal about one speed.

    Attributes
    ----------
    time, speed : float
        Middle of the window [s], and the speed there [rad/s].
    frequencies : array, shape (lines,)
        [Hz].
    amplitude : array, shape (lines,)
        Amplitude of a sine at each line [unit of the signal]; low by at most 1 % (0.09 dB) between two lines.
    window : float
        Length of the window [s].
    """

    time: float
    speed: float
    frequencies: FloatArray
    amplitude: FloatArray
    window: float


def amplitude_spectrum(run: RunSignal, speed: float, window: float, highest: float) -> AmplitudeSpectrum:
    """Amplitudes in a Hann window whose middle is where the run passes a speed, without the weighted mean.

    Parameters
    ----------
    run : RunSignal
        A ramp, or a run at constant speed, of which the last window is taken.
    speed : float
        Speed that is looked at [rad/s].
    window : float
        Length of the window [s]; 8 periods of the highest frequency to half the run.
    highest : float
        Highest frequency [Hz].

    Raises
    ------
    InputError
        If the run does not pass the speed with half a window on both sides, or window or band do not fit it.
    """
    problems = Problems([*_band_problems(run, (0.0, highest)), *_window_problems(run, window, (0.0, highest))])
    problems.check()
    half = round(0.5 * window * run.rate)
    # The speeds at which a whole window has its middle.
    inner = run.speed[half : run.speed.size - half]
    low, high = float(inner.min()), float(inner.max())
    slack = _SAME_SPEED * high
    if not low - slack <= speed <= high + slack:
        raise InputError(
            f"spectrum, speed: got {written(speed * RPM, 5)} rpm; allowed: {written(low * RPM, 5)} to "
            f"{written(high * RPM, 5)} rpm, where a "
            f"window of {1e3 * window:.4g} ms lies in the run as a whole; choose another speed or a shorter window"
        )
    near = np.flatnonzero(np.abs(inner - speed) <= np.abs(inner - speed).min() + slack)
    middle = half + int(near[-1] if high - low <= 2.0 * slack else near[near.size // 2])
    weights = scipy.signal.get_window("hann", 2 * half)
    part = without_mean(weights)(run.signal[middle - half : middle + half]) * weights
    size = next_fast_len(_DENSITY * part.size, real=True)
    lines = np.arange(size // 2 + 1) * run.rate / size
    kept = (lines > 0.0) & (lines <= highest)
    amplitude = 2.0 * np.abs(np.fft.rfft(part, size))[kept] / weights.sum()
    return AmplitudeSpectrum(float(run.time[middle]), speed, lines[kept], amplitude, 2.0 * half / run.rate)


def without_mean(weights: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Take the mean off each window, weighted as the window is.

    The plain mean of a window holds what an oscillation leaves over where the window cuts it off. Taken off, that would
    be a constant which is not in the signal, and its lines, some 60 dB below the oscillation, would cover all that is
    at the lowest frequencies.

    Parameters
    ----------
    weights : array, shape (length,)
        Weights of the window.

    Returns
    -------
    callable
        A function that takes a part of the signal (..., length) and returns it without its mean.
    """
    unit = weights / weights.sum()

    def without(part: FloatArray) -> FloatArray:
        return np.asarray(part - (part @ unit)[..., None], dtype=np.float64)

    return without


def _band_problems(run: RunSignal, band: tuple[float, float]) -> list[str]:
    """Problems with the band."""
    low, high = band
    if not (math.isfinite(low) and math.isfinite(high) and 0.0 <= low < high):
        return [f"spectra, band: got {low!r} to {high!r} Hz; allowed: finite, 0 <= lowest < highest"]
    needed = LEAST_OVERSAMPLING * high
    # Times in a file are rounded, and so is the rate found from them.
    if run.rate < needed * (1.0 - 1e-6):
        return [
            f"spectra, sample rate: got {run.rate:.6g} Hz; allowed: at least {needed:.6g} Hz for a band up to "
            f"{high:.6g} Hz; record every {1e3 / needed:.4g} ms or more often, or lower the highest frequency to "
            f"{run.rate / LEAST_OVERSAMPLING:.5g} Hz"
        ]
    return []


def _window_problems(run: RunSignal, window: float, band: tuple[float, float]) -> list[str]:
    """Problems with the window."""
    high = band[1]
    longest = LONGEST_PART * run.duration
    shortest = LEAST_PERIODS / high if high > 0.0 else math.inf
    if not (math.isfinite(window) and shortest <= window <= longest):
        return [
            f"spectra, window: got {window!r} s; allowed: {shortest:.4g} s ({LEAST_PERIODS} periods of the highest "
            f"frequency) to {longest:.4g} s (half the run); "
            + ("choose one between" if shortest <= longest else "record a longer run, or look at higher frequencies")
        ]
    return []
