"""Levels of run-ups in words: resolution, highest levels, peaks along orders, differences."""

from __future__ import annotations

import numpy as np

from ehdmaps.units import RPM, Display
from mbs.spectral.campbell import RunUpSpectra
from mbs.spectral.levels import Reference
from mbs.spectral.orders import OrderPeak

PEAKS = "  peaks along the orders: order   speed/rpm   frequency/Hz   level/dB   above its valleys/dB"
"""Heading of the lines of peaks."""

_HERTZ, _MILLISECOND = Display("Hz"), Display("ms", 1e3)


def resolution_lines(spectra: RunUpSpectra, highest: float) -> list[str]:
    """How finely speed and frequency are resolved.

    Parameters
    ----------
    spectra : RunUpSpectra
        Of one run.
    highest : float
        Highest frequency that was asked for [Hz].
    """
    found = spectra.campbell
    return [
        f"band {_HERTZ.text(found.frequencies[0])} to {_HERTZ.text(highest)}; windows of "
        f"{_MILLISECOND.text(found.window)}: lines are {found.line_width:.3g} Hz wide, the highest order sweeps by "
        f"{found.smear:.3g} Hz in one; order spectra over {spectra.spectra.window:.3g} turns"
        + (f", single orders over {spectra.tracks.window:.3g} turns" if spectra.tracks else "")
    ]


def highest_line(spectra: RunUpSpectra) -> str:
    """The highest sum level, and where.

    Parameters
    ----------
    spectra : RunUpSpectra
        Of one run.
    """
    found = spectra.campbell
    at = int(np.argmax(found.sum_level))
    return f"highest sum level {found.sum_level[at]:.1f} dB at {RPM.text(float(found.speeds[at]))}"


def peak_line(peak: OrderPeak) -> str:
    """Line of a peak, below `PEAKS`.

    Parameters
    ----------
    peak : OrderPeak
        The peak.
    """
    return (
        f"  {peak.order:29.5g} {RPM.value(peak.speed):11.1f} {peak.frequency:14.5g} {peak.level:10.1f} "
        f"{peak.prominence:22.1f}"
    )


def peak_lines(spectra: RunUpSpectra) -> list[str]:
    """Lines of all peaks along the orders; none where no order was followed.

    Parameters
    ----------
    spectra : RunUpSpectra
        Of one run.
    """
    if spectra.peaks:
        return [PEAKS, *map(peak_line, spectra.peaks)]
    return ["  no peak along the orders"] if spectra.tracks else []


def sensor_line(name: str, reference: Reference, spectra: RunUpSpectra) -> str:
    """One line on a sensor among several: highest sum level, and strongest peak along the orders.

    Parameters
    ----------
    name : str
        Name of the sensor.
    reference : Reference
        Reference of its levels.
    spectra : RunUpSpectra
        Its levels.
    """
    line = f"  {name} ({reference.text}): {highest_line(spectra)}"
    if not spectra.peaks:
        return line
    best = max(spectra.peaks, key=lambda peak: peak.level)
    return (
        f"{line}; strongest peak along the orders {best.level:.1f} dB, order {best.order:.5g} at "
        f"{RPM.text(best.speed)}, {best.frequency:.5g} Hz"
    )
