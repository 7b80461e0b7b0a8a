"""Bands of the levels of frequency responses, from the errors that a map states; see `mbs.linearised.bands`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.linearised.bands import law_bands
from mbs.linearised.modal_response import seen_of_loads
from mbs.linearised.modes import StateModes
from mbs.model.elements import Sensor
from mbs.model.equilibrium import Equilibrium


def level_bands(
    balance: Equilibrium,
    states: StateModes,
    sensors: Sequence[Sensor],
    frequencies: FloatArray,
    motion: ComplexArray,
    responses: ComplexArray,
) -> FloatArray | None:
    """Bands of the levels of frequency responses, either way, shape (frequencies, sensors, inputs) [dB].

    A response H with the band b is told as 20 log10(1 + b/|H|), which stays finite at an antiresonance, where its
    level goes to -infinity.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which the system is linearised.
    states : StateModes
        Complex modes there: what sensors see of loads on the bearings are their sums.
    sensors : sequence of Sensor
        Sensors of the responses.
    frequencies : array, shape (frequencies,)
        [Hz].
    motion : array, shape (frequencies, n, inputs)
        Amplitudes of the coordinates for each input.
    responses : array, shape (frequencies, sensors, inputs)
        The responses.

    Returns
    -------
    array or None
        None for laws that state no errors.
    """
    laws = law_bands(balance)
    if laws is None:
        return None
    back = seen_of_loads(balance, states, sensors, frequencies, laws.ports)
    band = laws.of_responses(frequencies, laws.ports @ motion, back, responses)
    return np.asarray(20.0 * np.log10(1.0 + band / np.maximum(np.abs(responses), 1e-300)))
