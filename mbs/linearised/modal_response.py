"""Frequency responses from the modes of the state: as exact as solving at each frequency, and much faster for many.

    H(omega) = sum_k (c . r_k)(l_k . b)/(i omega - lambda_k)

with right and left vectors r and l, all of them, so that nothing is cut off. Where two modes are nearly one, as beside
critical damping, the vectors grow and digits are lost: some frequencies are solved directly to see how many. Where
films relax, the modes have them as a few states, which leaves an error of its own; direct solutions have all slices.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import AnalysisError
from mbs.linearised.linear import frequency_response, input_matrix, responses, sensor_matrix
from mbs.linearised.modes import StateModes
from mbs.model.elements import Input, Sensor
from mbs.model.equilibrium import Equilibrium

TOLERANCE = 1e-8
"""Error at the frequencies checked, above which all are solved directly; others may have some times as much."""

FILM_TOLERANCE = 1e-6
"""The same where films relax: a hundred times what their few states leave, as resonances enlarge it."""

_CHECKED = 3
_ORDER = {"displacement": 0, "velocity": 1, "acceleration": 2}


def modal_response(
    balance: Equilibrium,
    states: StateModes,
    inputs: Sequence[Input],
    sensors: Sequence[Sensor],
    frequencies: FloatArray,
) -> ComplexArray:
    """Frequency responses by the sum over modes, shape (frequencies, sensors, inputs).

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    states : StateModes
        Complex modes of the same equilibrium.
    inputs, sensors : sequence
        Inputs and sensors of the responses.
    frequencies : array, shape (frequencies,)
        [Hz].
    """
    n = balance.system.size
    seen = sensor_matrix(balance, sensors) @ states.right[:n]
    driven = states.left[:, n : 2 * n] @ np.linalg.solve(balance.system.mass, input_matrix(balance, inputs))
    omega = 2.0 * np.pi * np.asarray(frequencies, dtype=np.float64)
    resonance = 1.0 / (1j * omega[:, None] - states.eigenvalues)
    residues = (seen.T[:, :, None] * driven[:, None, :]).reshape(states.eigenvalues.size, -1)
    found = (resonance @ residues).reshape(omega.size, len(sensors), len(inputs))
    orders = np.array([_ORDER[sensor.quantity] for sensor in sensors], dtype=np.int64)
    result: ComplexArray = found * ((1j * omega[:, None]) ** orders)[:, :, None]
    return result


def seen_of_loads(
    balance: Equilibrium,
    states: StateModes,
    sensors: Sequence[Sensor],
    frequencies: FloatArray,
    ports: FloatArray,
) -> ComplexArray:
    """What each sensor sees of a load of 1 N or 1 N m on each of some ports, shape (frequencies, sensors, ports).

    Parameters
    ----------
    balance, states, sensors, frequencies
        The same as for `modal_response`.
    ports : array, shape (ports, n)
        How the ports follow the coordinates.
    """
    n = balance.system.size
    seen = sensor_matrix(balance, sensors) @ states.right[:n]
    by_load = np.linalg.solve(balance.system.mass.T, states.left[:, n : 2 * n].T).T @ ports.T
    rate = 2j * np.pi * np.asarray(frequencies, dtype=np.float64)
    resonance = 1.0 / (rate[:, None] - states.eigenvalues)
    orders = np.array([_ORDER[sensor.quantity] for sensor in sensors], dtype=np.int64)
    found = np.stack([(resonance * row) @ by_load for row in seen], axis=1)
    return np.asarray(found * (rate[:, None] ** orders)[:, :, None])


def checked_response(
    balance: Equilibrium,
    states: StateModes,
    inputs: Sequence[Input],
    sensors: Sequence[Sensor],
    frequencies: FloatArray,
) -> tuple[ComplexArray, float]:
    """Frequency responses, and the largest error seen beside a direct solution; arguments as of `modal_response`.

    Returns
    -------
    responses : array, shape (frequencies, sensors, inputs)
        Responses by modes, or by direct solution where the error was above `TOLERANCE`, or `FILM_TOLERANCE` with films
        that relax, or a mode lies on the frequency axis.
    error : float
        Error of the responses, as a part of them or of a millionth of how the whole system moves, whichever is more; 0
        if they were solved directly.

    Raises
    ------
    AnalysisError
        If there is no response: a frequency is just that of an undamped or free motion.
    """
    if not (len(inputs) and len(sensors) and frequencies.size):
        return np.zeros((frequencies.size, len(sensors), len(inputs)), dtype=np.complex128), 0.0
    try:
        return _checked(balance, states, inputs, sensors, frequencies)
    except np.linalg.LinAlgError as error:
        raise AnalysisError(
            "responses: one of the frequencies is just that of an undamped or free motion, where there is none; move "
            "the frequencies, or add damping"
        ) from error


def _checked(
    balance: Equilibrium,
    states: StateModes,
    inputs: Sequence[Input],
    sensors: Sequence[Sensor],
    frequencies: FloatArray,
) -> tuple[ComplexArray, float]:
    """What `checked_response` returns, or numpy's error for a singular system."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found = modal_response(balance, states, inputs, sensors, frequencies)
    checked = np.unique(np.linspace(0, frequencies.size - 1, _CHECKED + 2).astype(np.int64))
    at = frequencies[checked]
    direct = frequency_response(balance, inputs, sensors, at)
    omega = 2.0 * np.pi * at[:, None, None]
    orders = np.array([_ORDER[sensor.quantity] for sensor in sensors])[None, :, None]
    whole = np.linalg.norm(responses(balance, inputs, at), axis=1)[:, None, :]
    rows = np.linalg.norm(sensor_matrix(balance, sensors), axis=1)[None, :, None]
    size = np.abs(direct) + 1e-6 * rows * whole * omega**orders
    error = float(np.max(np.abs(found[checked] - direct) / np.maximum(size, 1e-300)))
    if np.all(np.isfinite(found)) and error <= (TOLERANCE if states.films is None else FILM_TOLERANCE):
        return found, error
    return frequency_response(balance, inputs, sensors, frequencies), 0.0
