"""Campbell diagram of a run-up: level over speed and frequency, the sum level, orders, and where they are strongest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.settings import HIGHEST
from mbs.spectral.levels import level
from mbs.spectral.orders import (
    OrderPeak,
    OrderSpectra,
    OrderTracks,
    angle_signal,
    order_peaks,
    order_spectra,
    track_orders,
)
from mbs.spectral.run_signal import RunSignal
from mbs.spectral.spectra import LEAST_PERIODS, LINE_WIDTH, default_window, short_time_spectra

_MEAN_LOBE = 2.0
"""Where the main lobe of a Hann window around the mean ends, in lines of 1/window."""


@dataclass(frozen=True, eq=False)
class Campbell:
    """Level of a signal over speed and frequency.

    Attributes
    ----------
    time, speeds : array, shape (windows,)
        Time [s] and speed [rad/s] at the middle of each window; the speeds only rise, or only fall.
    frequencies : array, shape (lines,)
        [Hz].
    level : array, shape (windows, lines)
        Level of the root mean square of a sine at each line [dB].
    sum_level : array, shape (windows,)
        Level of the root mean square of all lines together [dB].
    reference : float
        Root mean square at 0 dB, in the unit of the signal.
    window : float
        Length of the windows [s].
    line_width : float
        Width of a line at rest, 3 dB [Hz].
    smear : float
        Frequency range that the highest order sweeps in a window [Hz].
    """

    time: FloatArray
    speeds: FloatArray
    frequencies: FloatArray
    level: FloatArray
    sum_level: FloatArray
    reference: float
    window: float
    line_width: float
    smear: float


@dataclass(frozen=True, eq=False)
class RunUpSpectra:
    """All that is found in one signal of a run-up.

    Attributes
    ----------
    campbell : Campbell
        Level over speed and frequency, and sum level.
    spectra : OrderSpectra
        Spectra over orders.
    tracks : OrderTracks or None
        Single orders; None where none was asked for.
    peaks : tuple of OrderPeak
        The strongest along those orders.
    """

    campbell: Campbell
    spectra: OrderSpectra
    tracks: OrderTracks | None
    peaks: tuple[OrderPeak, ...]


def campbell(
    run: RunSignal,
    reference: float,
    highest: float = HIGHEST,
    window: float | None = None,
    highest_order: float | None = None,
) -> Campbell:
    """Level over speed and frequency.

    Parameters
    ----------
    run : RunSignal
        A ramp; held speeds before and after it are left out.
    reference : float
        Root mean square at 0 dB, in the unit of the signal.
    highest : float
        Highest frequency [Hz]. The lowest one is 2/window: below it is the mean.
    window : float, optional
        Length of the windows [s]; see `mbs.spectral.spectra` for the default.
    highest_order : float, optional
        That is looked at, for the default window; the order at the highest frequency and speed if left out.

    Raises
    ------
    InputError
        If the speed makes no ramp, or window or band do not fit the record.
    """
    ramp = run.ramp()
    top = float(ramp.speed.max())
    if not (math.isfinite(highest) and highest > 0.0):
        raise InputError(f"campbell, highest: got {highest!r} Hz; allowed: finite and > 0")
    at_top = 2.0 * math.pi * highest / top
    order = at_top if highest_order is None else min(highest_order, at_top)
    length = max(default_window(ramp, order), LEAST_PERIODS / highest) if window is None else window
    lowest = _MEAN_LOBE / length if math.isfinite(length) and length > 0.0 else 0.0
    spectra = short_time_spectra(ramp, length, (min(lowest, 0.5 * highest), highest))
    rise = float(np.max(np.abs(np.gradient(ramp.speed, ramp.time)))) / (2.0 * math.pi)
    return Campbell(
        spectra.time,
        spectra.speeds,
        spectra.frequencies,
        level(spectra.power, reference),
        level(spectra.mean_square(), reference),
        reference,
        spectra.window,
        LINE_WIDTH / spectra.window,
        order * rise * spectra.window,
    )


def run_up_spectra(
    run: RunSignal,
    reference: float,
    highest: float = HIGHEST,
    window: float | None = None,
    orders: Sequence[float] = (),
) -> RunUpSpectra:
    """Campbell diagram, order spectra, and the given orders with their peaks.

    Parameters
    ----------
    run : RunSignal
        A ramp.
    reference : float
        Root mean square at 0 dB, in the unit of the signal.
    highest : float
        Highest frequency [Hz].
    window : float, optional
        Length of the windows of the Campbell diagram [s].
    orders : sequence of float
        Orders to be followed.

    Raises
    ------
    InputError
        If the run makes no ramp, or window, band or orders do not fit it.
    """
    diagram = campbell(run, reference, highest, window, max(orders, default=None))
    turned = angle_signal(run.ramp(), highest)
    tracks = track_orders(turned, orders) if orders else None
    peaks = order_peaks(tracks, reference) if tracks else ()
    return RunUpSpectra(diagram, order_spectra(turned), tracks, peaks)
