"""Order domain: the signal at equal angles instead of equal times, its spectra, and single orders over speed.

An order counts periods per turn of the system, so a line that is locked to the rotation keeps its place while the speed
changes, and a window over turns does not smear it. On the way from times to angles the signal is limited to its band
and made ten times denser by one filter (Kaiser, 100 dB), then interpolated by quintic splines: the amplitude of a sine
in the band is kept within 1e-4. Angles are equal steps so small that the highest frequency of the band is sampled 2.5
times a period at the lowest speed, and more often above: nothing is aliased.

References
----------
K. R. Fyfe, E. D. S. Munck, Mech. Syst. Signal Process. 11 (1997) 187-205 (computed order tracking, and how its accuracy
depends on the filter and the interpolation).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy  # its parts at first use: scipy.signal takes half a second
from scipy.fft import next_fast_len
from scipy.interpolate import make_interp_spline

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.units import written
from mbs.spectral.levels import level
from mbs.spectral.run_signal import RPM, RunSignal
from mbs.spectral.spectra import LEAST_OVERSAMPLING, MOST_WINDOWS, without_mean

_DENSE = 10.0
"""Samples a period of the highest frequency before interpolation."""

_STOP = 100.0
"""Attenuation of the filter [dB]."""

_SLOWEST = 0.1
"""Lowest speed by default, as a part of the highest."""

_MOST_SAMPLES = 5_000_000
"""Their spline takes half a gigabyte."""

_MOST_VALUES = 10_000_000
_DENSITY = 4
_SPLINE_END = 16
_TURN = 2.0 * math.pi
_LEAST_PERIODS = 2.0
"""Of an order in a window: the main lobe of a Hann window reaches so far, and must not reach the mean."""


@dataclass(frozen=True, eq=False)
class AngleSignal:
    """A signal at equal angles.

    Attributes
    ----------
    turns : array, shape (samples,)
        Turned since the beginning of the record, at equal distances.
    time, speed, signal : array, shape (samples,)
        [s], [rad/s], and the signal within its band.
    highest : float
        Highest frequency of the band [Hz].
    """

    turns: FloatArray
    time: FloatArray
    speed: FloatArray
    signal: FloatArray
    highest: float

    @property
    def per_turn(self) -> int:
        """Samples a turn."""
        return round((self.turns.size - 1) / self.length)

    @property
    def length(self) -> float:
        """Turns in all."""
        return float(self.turns[-1] - self.turns[0])


@dataclass(frozen=True, eq=False)
class OrderSpectra:
    """Power spectra over orders, one a window.

    Attributes
    ----------
    time, speeds : array, shape (windows,)
        Time [s] and speed [rad/s] at the middle of each window.
    orders : array, shape (lines,)
        Periods a turn of the system.
    power : array, shape (windows, lines)
        Mean square of a sine at each line [square of the unit]; NaN where order times speed lies above the band.
    window : float
        Length of the windows [turns].
    """

    time: FloatArray
    speeds: FloatArray
    orders: FloatArray
    power: FloatArray
    window: float

    def mean(self) -> FloatArray:
        """Power of each order over all windows that have it, shape (lines,); NaN where none has it."""
        there = np.isfinite(self.power)
        count = there.sum(axis=0)
        total = np.where(there, self.power, 0.0).sum(axis=0)
        return np.asarray(np.where(count > 0, total / np.maximum(count, 1), np.nan), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class OrderTracks:
    """Single orders over speed.

    Attributes
    ----------
    time, speeds : array, shape (windows,)
        Time [s] and speed [rad/s] at the middle of each window.
    orders : array, shape (orders,)
        Periods a turn of the system.
    amplitude : array, shape (windows, orders)
        Complex: the signal is Re(amplitude exp(i order angle)); NaN where order times speed lies above the band.
    window : float
        Length of the windows [turns].
    """

    time: FloatArray
    speeds: FloatArray
    orders: FloatArray
    amplitude: ComplexArray
    window: float

    def level(self, reference: float) -> FloatArray:
        """Level of the root mean square of each order [dB], shape (windows, orders)."""
        return level(0.5 * np.abs(self.amplitude) ** 2, reference)


@dataclass(frozen=True)
class OrderPeak:
    """A place along an order where its level is highest, such as where it crosses a mode.

    Attributes
    ----------
    order : float
        Periods a turn of the system.
    speed : float
        Speed of the system [rad/s].
    frequency : float
        Order times speed [Hz].
    level : float
        [dB].
    prominence : float
        How far it stands above the higher one of the valleys beside it [dB].
    """

    order: float
    speed: float
    frequency: float
    level: float
    prominence: float


def angle_signal(run: RunSignal, highest: float, lowest_speed: float | None = None) -> AngleSignal:
    """The signal at equal angles.

    Parameters
    ----------
    run : RunSignal
        The signal at equal times; its speed may rise, fall or be constant.
    highest : float
        Highest frequency to keep [Hz].
    lowest_speed : float, optional
        Speed below which the signal is left out [rad/s]; a tenth of the highest speed if left out.

    Raises
    ------
    InputError
        If the record is sampled too slowly or too short for the band, or the result would be too large.
    """
    top = float(run.speed.max())
    lowest = _SLOWEST * top if lowest_speed is None else lowest_speed
    needed = LEAST_OVERSAMPLING * highest
    problems = Problems()
    if not (math.isfinite(highest) and highest > 0.0):
        problems.append(f"orders, highest frequency: got {highest!r} Hz; allowed: finite and > 0")
    elif run.rate < needed * (1.0 - 1e-6):
        problems.append(
            f"orders, sample rate: got {run.rate:.6g} Hz; allowed: at least {needed:.6g} Hz for a band up to "
            f"{highest:.6g} Hz; record more often or lower the highest frequency"
        )
    if not 0.0 < lowest < top:
        problems.append(
            f"orders, lowest speed: got {written(lowest * RPM)} rpm; allowed: above 0, below the highest of "
            f"{written(top * RPM)} rpm"
        )
    problems.check()
    fast = np.flatnonzero(run.speed >= lowest)
    turned = float(run.angle[fast[-1]] - run.angle[fast[0]]) / float(run.speed[fast].min())
    samples = round(max(turned * needed, run.duration * max(_DENSE * highest, run.rate)))
    if samples > _MOST_SAMPLES:
        raise InputError(
            f"orders: got {samples} samples on the way to equal angles; allowed: {_MOST_SAMPLES}; take a higher lowest "
            "speed, a lower highest frequency or a part of the run"
        )
    times, dense = _band_limited(run, highest)
    # At its ends a spline is not as good as within.
    within = (run.time >= times[_SPLINE_END]) & (run.time <= times[-1 - _SPLINE_END])
    fast = np.flatnonzero((run.speed >= lowest) & within)
    if fast.size < 2 or fast[-1] - fast[0] + 1 != fast.size:
        raise InputError(
            f"orders, record: has no one part with more than {written(lowest * RPM)} rpm; allowed: one "
            "ramp, some periods "
            f"of the highest frequency {highest:.6g} Hz long; cut the record, or lower the lowest speed"
        )
    begin, end = run.angle[fast[0]] - run.angle[0], run.angle[fast[-1]] - run.angle[0]
    # A whole number a turn, so that whole orders fall on lines; of small factors, for the Fourier transforms.
    step = _TURN / next_fast_len(math.ceil(_TURN * needed / float(run.speed[fast].min())), real=True)
    angle = begin + step * np.arange(int((end - begin) / step) + 1)
    # Between two samples the angle is nearly linear: it is off by (speed change per s) (time step)^2/8 at most.
    time = np.interp(angle, run.angle - run.angle[0], run.time)
    values = make_interp_spline(times, dense, k=5)(time)
    speed = np.interp(time, run.time, run.speed)
    return AngleSignal(angle / _TURN, time, speed, np.asarray(values, dtype=np.float64), highest)


def order_spectra(signal: AngleSignal, window: float | None = None) -> OrderSpectra:
    """Spectra of windows over turns, Hann, that overlap by three quarters; each without its weighted mean.

    Parameters
    ----------
    signal : AngleSignal
        Signal at equal angles.
    window : float, optional
        Length of a window [turns]: lines are 1.44/window wide. An eighth of the record, at most 8, if left out.

    Raises
    ------
    InputError
        If the window holds too little, or the result would be too large.
    """
    eighth = min(8.0, signal.length / 8.0)
    # Whole turns put whole orders on lines.
    turns = (math.floor(eighth) or eighth) if window is None else window
    length, hop, weights = _windows(signal, turns, "spectra")
    transform = scipy.signal.ShortTimeFFT(weights, hop, signal.per_turn, mfft=_DENSITY * length)
    # Above this order the band ends at every speed that the record has.
    highest = signal.highest * _TURN / float(signal.speed.min())
    lines = np.flatnonzero(transform.f <= highest)
    first, last = transform.lower_border_end[1], transform.upper_border_begin(signal.signal.size)[1]
    if last - first > MOST_WINDOWS or (last - first) * lines.size > _MOST_VALUES:
        raise InputError(
            f"orders: got {last - first} windows of {lines.size} lines each; allowed: {MOST_WINDOWS} windows, and "
            f"{_MOST_VALUES} values in all; take a longer window, a higher lowest speed or a lower highest frequency"
        )
    parts = transform.stft_detrend(signal.signal, without_mean(weights), first, last)[lines]
    twice = np.where(lines == 0, 1.0, 2.0)[:, None] / weights.sum() ** 2
    power = (twice * (parts.real**2 + parts.imag**2)).T
    middles = np.arange(first, last) * hop
    speeds, orders = signal.speed[middles], transform.f[lines]
    power[speeds[:, None] * orders > _TURN * signal.highest] = np.nan
    return OrderSpectra(signal.time[middles], speeds, orders, power, length / signal.per_turn)


def track_orders(signal: AngleSignal, orders: Sequence[float], window: float | None = None) -> OrderTracks:
    """Amplitude of single orders over speed: windows over turns, Hann, that overlap by seven eighths.

    Each order is brought to zero by exp(-i order angle) first, so it need not fall on a line of a spectrum. Another
    order is seen in this one by less than 1 % if it lies 2/window beside it, or more.

    Parameters
    ----------
    signal : AngleSignal
        Signal at equal angles.
    orders : sequence of float
        Periods a turn of the system; at least 2 periods in a window.
    window : float, optional
        Length of a window [turns]; 2 if left out, less in a record of less than 20 turns, more for orders below 1. A
        shorter window follows narrow resonances better.

    Raises
    ------
    InputError
        If an order or the window is not possible.
    """
    wanted = np.array(orders, dtype=np.float64)
    if wanted.ndim != 1 or wanted.size == 0 or not np.all((wanted > 0.0) & (wanted < 0.5 * signal.per_turn)):
        raise InputError(
            f"orders: got {list(orders)!r:.80}; allowed: at least one, each above 0 and below "
            f"{0.5 * signal.per_turn:.5g}, which is the highest that the record holds"
        )
    least = _LEAST_PERIODS / float(wanted.min())
    turns = max(min(2.0, 0.1 * signal.length), least) if window is None else window
    if turns < least * (1.0 - 1e-9):
        raise InputError(
            f"orders, window: got {turns!r} turns; allowed: at least {least:.4g} turns, {_LEAST_PERIODS:g} periods of "
            f"order {wanted.min():g}; take a longer window or higher orders"
        )
    length, _, weights = _windows(signal, turns, "tracks")
    hop = max(length // 8, 1)
    middles = np.arange(length // 2, signal.signal.size - length // 2, hop)
    if middles.size * wanted.size > _MOST_VALUES:
        raise InputError(
            f"orders: got {middles.size} windows for {wanted.size} orders; allowed: {_MOST_VALUES} values in all; take "
            "a longer window, or fewer orders"
        )
    amplitude = np.empty((middles.size, wanted.size), dtype=np.complex128)
    kernel = 2.0 * weights / weights.sum()
    for column, order in enumerate(wanted):
        still = signal.signal * np.exp(-1j * _TURN * order * signal.turns)
        amplitude[:, column] = scipy.signal.oaconvolve(still, kernel, mode="valid")[middles - length // 2]
    speeds = signal.speed[middles]
    amplitude[speeds[:, None] * wanted > _TURN * signal.highest] = np.nan
    return OrderTracks(signal.time[middles], speeds, wanted, amplitude, length / signal.per_turn)


def order_peaks(
    tracks: OrderTracks, reference: float, count: int = 5, prominence: float = 3.0
) -> tuple[OrderPeak, ...]:
    """The strongest local maxima of the orders over speed, strongest first.

    The ends of a track are no maxima: there the level may go on to rise. In a run-up through a lightly damped
    resonance the maximum comes somewhat after the speed of the resonance, the later the faster the speed rises
    (F. M. Lewis, Trans. ASME 54 (1932) 253-261), and the window widens it.

    Parameters
    ----------
    tracks : OrderTracks
        Orders over speed.
    reference : float
        Root mean square at 0 dB, in the unit of the signal.
    count : int
        How many at most.
    prominence : float
        Least height above the higher one of the valleys beside it [dB].
    """
    levels = tracks.level(reference)
    peaks = []
    for column, order in enumerate(tracks.orders):
        there = np.flatnonzero(np.isfinite(levels[:, column]))
        places, properties = scipy.signal.find_peaks(levels[there, column], prominence=prominence)
        for place, height in zip(there[places], properties["prominences"], strict=True):
            speed = float(tracks.speeds[place])
            peaks.append(
                OrderPeak(
                    float(order), speed, float(order) * speed / _TURN, float(levels[place, column]), float(height)
                )
            )
    return tuple(sorted(peaks, key=lambda peak: -peak.level)[:count])


def _band_limited(run: RunSignal, highest: float) -> tuple[FloatArray, FloatArray]:
    """Times and values of the signal limited to its band, at least `_DENSE` samples a period of the highest frequency.

    Zeros are put between the samples, and one filter takes both the mirror images that this makes and what lies above
    the band. The ends, where the filter would see beyond the record, are left out.
    """
    factor = max(math.ceil(_DENSE * highest / run.rate - 1e-6), 1)
    rate = factor * run.rate
    nyquist = 0.5 * rate
    # The pass band ends at `highest`, the stop band begins where aliases of the angles, and mirror images, begin.
    stop = 0.5 * LEAST_OVERSAMPLING * highest
    taps, beta = scipy.signal.kaiserord(_STOP, (stop - highest) / nyquist)
    taps += 1 - taps % 2
    if taps > factor * run.signal.size // 2:
        raise InputError(
            f"orders, record: got {run.duration:.4g} s; allowed: at least {2.0 * taps / rate:.4g} s for a band up to "
            f"{highest:.6g} Hz; record for longer"
        )
    kernel = factor * scipy.signal.firwin(taps, 0.5 * (highest + stop) / nyquist, window=("kaiser", beta))
    stuffed = np.zeros((run.signal.size - 1) * factor + 1)
    stuffed[::factor] = run.signal
    dense = scipy.signal.oaconvolve(stuffed, kernel, mode="valid")
    times = run.time[0] + (taps // 2 + np.arange(dense.size)) / rate
    return times, np.asarray(dense, dtype=np.float64)


def _windows(signal: AngleSignal, turns: float, what: str) -> tuple[int, int, FloatArray]:
    """Length, distance and weights of windows over turns."""
    longest = 0.5 * signal.length
    length = 2 * round(0.5 * turns * signal.per_turn) if math.isfinite(turns) else 0
    if not (length >= 8 and turns <= longest):
        raise InputError(
            f"orders, window of the {what}: got {turns!r} turns; allowed: {8.0 / signal.per_turn:.3g} turns to half "
            f"the record, {longest:.4g} turns; choose one between, or record more turns"
        )
    return length, max(length // 4, 1), scipy.signal.get_window("hann", length)
