"""Peaks of frequency responses that belong to modes: where each is highest beside its mode, and by several laws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from mbs.linearised.linear import frequency_response, peak_places
from mbs.linearised.modes import Modes
from mbs.linearised.pairs import in_order, partners
from mbs.model.elements import Input, Sensor
from mbs.model.equilibrium import Equilibrium

_BESIDE = np.linspace(-2.0, 2.0, 9)
"""Places beside a mode at which its peak is sought, in half-widths of it."""

_WIDE = 3.0
"""Distance of a peak from its mode in half-widths, at most, or `_NEAR`."""

_NEAR = 0.005
"""The same as a part of the frequency."""

_UNDAMPED = 1e-9
"""Damping ratio below which a mode has no finite peak."""


def peaks_of_modes(
    found: Modes, chosen: IntArray, frequencies: FloatArray, sizes: FloatArray
) -> tuple[IntArray, IntArray]:
    """Peaks that belong to a mode, shape (peaks, 3), and the place of its mode among the chosen ones.

    Parameters
    ----------
    found : Modes
        The modes.
    chosen : array of int
        Which of them may have peaks.
    frequencies : array, shape (frequencies,)
        [Hz].
    sizes : array, shape (frequencies, sensors, inputs)
        Sizes of the responses.
    """
    places, own = [], []
    frequency, ratio = found.frequency[chosen], found.damping_ratio[chosen]
    for sensor, entry in np.ndindex(sizes.shape[1:]):
        for k in peak_places(sizes[:, sensor, entry]).tolist():
            apart = np.abs(frequency / frequencies[k] - 1.0)
            if apart.size and apart.min() <= max(_WIDE * ratio[int(np.argmin(apart))], _NEAR):
                places.append((k, sensor, entry))
                own.append(int(np.argmin(apart)))
    return np.array(places, dtype=np.int64).reshape(-1, 3), np.array(own, dtype=np.int64)


def highest_beside(
    balance: Equilibrium,
    inputs: Sequence[Input],
    sensors: Sequence[Sensor],
    modes: tuple[FloatArray, FloatArray],
    of: IntArray,
) -> FloatArray:
    """Frequency [Hz] and size of the highest response beside modes, shape (2, peaks); NaN where there is none.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which the system is linearised.
    inputs, sensors : sequence
        Inputs and sensors of the responses.
    modes : (array, array), shape (peaks,) each
        Frequencies [Hz] and damping ratios of the modes.
    of : array of int, shape (peaks, 2)
        Sensor and input of each.
    """
    frequency, ratio = modes
    there = np.isfinite(frequency) & (ratio > _UNDAMPED)
    beside = frequency[:, None] * (1.0 + ratio[:, None] * _BESIDE)
    values = np.full((2, frequency.size), np.nan)
    if not there.any():
        return values
    response = np.abs(frequency_response(balance, inputs, sensors, beside[there].reshape(-1)))
    for row, k in enumerate(np.flatnonzero(there)):
        sizes = response[row * _BESIDE.size : (row + 1) * _BESIDE.size, of[k, 0], of[k, 1]]
        highest = int(np.argmax(sizes))
        values[:, k] = beside[k, highest], sizes[highest]
    return values


class Linearised(NamedTuple):
    """Machine with a law, at its equilibrium.

    Attributes
    ----------
    balance : Equilibrium
        Equilibrium at which it is linearised.
    modes : Modes
        Modes there.
    """

    balance: Equilibrium
    modes: Modes


def by_laws(
    laws: Sequence[Linearised], inputs: Sequence[Input], sensors: Sequence[Sensor], chosen: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz], (laws, modes), and heights, (laws, sensors, inputs, modes), of modes of the first law.

    Modes of the others are those of the same shape; what is not there, or is not damped, is NaN.

    Parameters
    ----------
    laws : sequence of Linearised
        A machine with each law.
    inputs, sensors : sequence
        Inputs and sensors of the responses.
    chosen : array of int
        Modes of the first law.
    """
    first = laws[0]
    frequencies = np.full((len(laws), chosen.size), np.nan)
    heights = np.full((len(laws), len(sensors), len(inputs), chosen.size), np.nan)
    for row, (balance, found) in enumerate(laws):
        partner = partners(first.balance.system, first.modes.shapes[:, chosen], balance.system, found.shapes)
        known = first.modes.frequency[chosen], first.modes.damping_ratio[chosen]
        partner = chosen if row == 0 else in_order(*known, partner, found.frequency)
        own = [np.where(partner >= 0, part[partner], np.nan) for part in (found.frequency, found.damping_ratio)]
        frequencies[row] = own[0]
        for sensor, entry in np.ndindex(len(sensors), len(inputs)):
            of = np.tile([sensor, entry], (chosen.size, 1))
            heights[row, sensor, entry] = highest_beside(balance, inputs, sensors, (own[0], own[1]), of)[1]
    return frequencies, heights
