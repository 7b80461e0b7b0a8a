"""Bands of the peaks of frequency responses: each look follows the mode of a peak, and reads the response there.

Heights are in dB, for what is not known of damping multiplies them. What numerics leave open of a height is taken at
the top of its peak: at a frequency beside it, a resonance that shifts moves the level far more than the height.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from mbs.linearised.linear import frequency_response
from mbs.linearised.modes import Modes, modes
from mbs.linearised.peaks import highest_beside, peaks_of_modes
from mbs.model.equilibrium import Equilibrium
from mbs.scene.assembly import Model
from mbs.scene.scene import Scene
from mbs.unknowns.held_open import held_open_of
from mbs.unknowns.looks import Band, band
from mbs.unknowns.of_modes import ModeLook, banded, looked_at

_CLOSE = 0.3
"""Distance from a top at which its peak is looked at again, in parts of that between frequencies there."""

_LEAST = 1e-300


@dataclass(frozen=True, eq=False)
class PeakBands:
    """Bands of the peaks of responses.

    Attributes
    ----------
    places : array of int, shape (peaks, 3)
        Frequency, sensor and input of each.
    frequency, level : Band
        Bands of the frequencies [Hz] and of the levels [dB re 1 of the unit of the response], shape (peaks,) each.
    """

    places: IntArray
    frequency: Band
    level: Band

    def place(self, frequency: int, sensor: int, entry: int) -> int | None:
        """Place of a peak among those that have bands; None for one that has none."""
        found = np.flatnonzero(np.all(self.places == (frequency, sensor, entry), axis=1))
        return int(found[0]) if found.size else None


def peak_bands(
    model: Model,
    balance: Equilibrium,
    found: Modes,
    frequencies: FloatArray,
    sizes: FloatArray,
    errors: Callable[[FloatArray], FloatArray | None],
) -> PeakBands:
    """Bands of the peaks of the responses of a model that belong to one of its modes.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium at which it was linearised.
    found : Modes
        Modes there.
    frequencies : array, shape (frequencies,)
        [Hz].
    sizes : array, shape (frequencies, sensors, inputs)
        Sizes of the responses.
    errors : callable
        What numerics leave open of their levels [dB] at other frequencies [Hz]; None where that is not known.
    """
    chosen = banded(found, float(frequencies[-1]))
    places, own = peaks_of_modes(found, chosen, frequencies, sizes)
    look = _PeakLook(ModeLook(model, balance, found, chosen[own]), places[:, 1:])
    at = places[:, 0], places[:, 1], places[:, 2]
    values = np.array([frequencies[places[:, 0]], _level(sizes[at])])
    numerics = np.zeros_like(values)
    if found.bands is not None:
        numerics[0] = found.bands.frequency[chosen[own]]
    if places.size and (at_tops := errors(_tops(balance, model.scene, frequencies, sizes, places))) is not None:
        numerics[1] = at_tops[np.arange(places.shape[0]), places[:, 1], places[:, 2]]
    # Looks read the response beside the mode alone: what that misses of the printed peak is in all of them alike.
    missed = values - look.values(balance, found)
    both = band(lambda scene, standing: look(scene, standing) + missed, values, held_open_of(model), numerics)
    level = dataclasses.replace(both.of(1), signed=np.ones(places.shape[0], dtype=np.bool_))
    return PeakBands(places, both.of(0), level)


@dataclass(frozen=True, eq=False)
class _PeakLook:
    """Frequency and level of the peak of each mode in a response, shape (2, peaks).

    Attributes
    ----------
    modes : ModeLook
        The mode of each peak; one mode may have several.
    of : array of int, shape (peaks, 2)
        Sensor and input of each.
    """

    modes: ModeLook
    of: IntArray

    def __call__(self, scene: Scene, standing: bool) -> FloatArray:
        """Look at a changed scene."""
        balance = looked_at(self.modes.model.again(scene), self.modes.balance, standing)
        return self.values(balance, modes(balance, errors=False))

    def values(self, balance: Equilibrium, found: Modes) -> FloatArray:
        """Peaks of the modes of a system."""
        scene, modes_there = self.modes.model.scene, self.modes.paired(balance, found)
        values = highest_beside(balance, scene.inputs, scene.sensors, (modes_there[0], modes_there[1]), self.of)
        return np.array([values[0], _level(values[1])])


def _tops(
    balance: Equilibrium, scene: Scene, frequencies: FloatArray, sizes: FloatArray, places: IntArray
) -> FloatArray:
    """Frequencies of the tops of peaks between those beside them, shape (peaks,) [Hz]: from the axis, then closer."""
    beside = places[:, 0] + np.array([[-1], [0], [1]])
    top = _lowest(frequencies[beside], sizes[beside, places[:, 1], places[:, 2]])
    near = top + _CLOSE * np.diff(frequencies[beside], axis=0).min(axis=0) * np.array([[-1.0], [0.0], [1.0]])
    response = np.abs(frequency_response(balance, scene.inputs, scene.sensors, near.reshape(-1)))
    row = np.arange(near.size).reshape(near.shape)
    return _lowest(near, response[row, places[:, 1], places[:, 2]])


def _lowest(frequencies: FloatArray, sizes: FloatArray) -> FloatArray:
    """Frequency of the top of peaks by three of their frequencies, shape (3, peaks).

    Of one mode 1/|H|^2 is a parabola of the frequency, whose lowest place is the top.
    """
    first, middle, last = frequencies
    depth = (sizes.max(axis=0) / sizes) ** 2
    before, after = (depth[1] - depth[0]) / (middle - first), (depth[2] - depth[1]) / (last - middle)
    bend = (after - before) / (last - first)
    top = 0.5 * (first + middle) - 0.5 * before / np.where(bend > 0.0, bend, np.inf)
    return np.asarray(np.where(bend > 0.0, np.clip(top, first, last), middle))


def _level(size: FloatArray) -> FloatArray:
    """Level of a size [dB]."""
    return np.asarray(20.0 * np.log10(np.maximum(size, _LEAST)))
