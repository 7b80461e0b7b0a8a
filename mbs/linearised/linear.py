"""Linear analysis at an equilibrium: state space; frequency responses, solved or from modes; bands of levels.

Linear analysis at an equilibrium: state space, and frequency responses between inputs and sensors.

M x'' + C x' + K x = b u with C and K of the equilibrium; for small motion only, at fixed cage angle. Films have the
stiffness and damping of slow motion, or relax: then each slice answers at the frequency in question, and the state
space has a few states more.

Frequency responses from the modes of the state: as exact as solving at each frequency, and much faster for many.

H(omega) = sum_k (c . r_k)(l_k . b)/(i omega - lambda_k)

with right and left vectors r and l, all of them, so that nothing is cut off. Where two modes are nearly one, as beside
critical damping, the vectors grow and digits are lost: some frequencies are solved directly to see how many. Where
films relax, the modes have them as a few states, which leaves an error of its own; direct solutions have all slices.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
import scipy

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from ehdmaps.errors import AnalysisError
from ehdmaps.units import MOTIONS, Display
from mbs.linearised.bands import film_share, law_bands
from mbs.linearised.dynamic import dynamic_stiffness, system_film_states
from mbs.linearised.modes import StateModes
from mbs.model.elements import Input, MeshInput, Sensor
from mbs.model.equilibrium import Equilibrium

if TYPE_CHECKING:
    from mbs.gears.gear import GearMesh

_PER_TIME = ("", "/s", "/s2")


_AROUND = np.array([-8.0, -4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0, 8.0])
"""Places around a peak, in half widths."""

_AT_ONCE = 64
"""Frequencies whose matrices are held at a time."""

_WIDEST = 0.1
"""Damping ratio above which a peak is so wide that any axis shows it."""

_PROMINENCE = 0.05
"""How far a peak stands out of both valleys beside it, as a logarithm."""


def with_peaks(frequencies: FloatArray, eigenvalues: ComplexArray) -> FloatArray:
    """The frequencies of an axis and, among them, some around each lightly damped mode, which the axis may step over.

    Parameters
    ----------
    frequencies : array, shape (m,)
        [Hz].
    eigenvalues : array, shape (modes,)
        Eigenvalues of the complex modes [1/s]. Modes without any damping have no finite peak, and are left out.

    Returns
    -------
    array, shape (>= m,)
        [Hz], rising; all of `frequencies` are there.
    """
    if not frequencies.size:
        return frequencies
    half_width, place = -eigenvalues.real / (2.0 * np.pi), eigenvalues.imag / (2.0 * np.pi)
    narrow = (half_width > 1e-12 * place) & (half_width < _WIDEST * place)
    added = (place[narrow, None] + half_width[narrow, None] * _AROUND).ravel()
    inside = added[(added > frequencies.min()) & (added < frequencies.max())]
    return np.asarray(np.unique(np.concatenate([frequencies, inside])))


def peak_places(size: FloatArray) -> IntArray:
    """Places of the peaks of a response, in rising order: they stand out of both valleys beside them.

    Between the frequencies of an axis a lightly damped peak is any height: take one `with_peaks`.

    Parameters
    ----------
    size : array, shape (frequencies,)
        Size of the response, in any unit.
    """
    places, _ = scipy.signal.find_peaks(np.log(np.maximum(size, 1e-300)), prominence=_PROMINENCE)
    return np.asarray(places, dtype=np.int64)


def response_unit(sensor: Sensor, entry: Input) -> str:
    """Unit of the response of a sensor to an input, such as m/s2/N; rad for rotations, (N m) for moments."""
    return f"{sensor_unit(sensor)}/{f'({entry.unit})' if ' ' in entry.unit else entry.unit}"


def sensor_unit(sensor: Sensor) -> str:
    """Unit of a sensor, such as m/s2; rad for rotations."""
    return f"{'rad' if np.any(sensor.direction[3:]) else 'm'}{_PER_TIME[sensor.order]}"


def response_display(sensor: Sensor, entry: Input) -> Display:
    """Display in which people see the response of a sensor to an input, such as um/N."""
    shown = MOTIONS[sensor_unit(sensor)]
    per = response_unit(sensor, entry).removeprefix(sensor_unit(sensor))
    if entry.unit in MOTIONS:
        beside = MOTIONS[entry.unit]
        return Display(f"{shown.unit}/{beside.unit}", shown.factor / beside.factor)
    return Display(shown.unit + per, shown.factor)


@dataclass(frozen=True, eq=False)
class StateSpace:
    """x' = A x + B u, y = C x + D u, where x is the displacement from the equilibrium, then the velocity.

    Where films relax, q states of theirs follow: forces by the roots of their springs [N^0.5 m^0.5]. N = 2 n + q.

    Attributes
    ----------
    A : array, shape (N, N)
        System matrix.
    B : array, shape (N, inputs)
        Input matrix for inputs of 1 N or 1 N m.
    C : array, shape (sensors, N)
        Sensors [m or rad, per s, per s2].
    D : array, shape (sensors, inputs)
        What accelerations have of the inputs at once.
    """

    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: FloatArray


def input_matrix(balance: Equilibrium, inputs: Sequence[Input]) -> FloatArray:
    """Generalised load of each input at 1 N or 1 N m, shape (n, inputs)."""
    columns = [_load(balance, entry) for entry in inputs]
    return np.stack(columns, axis=1) if columns else np.zeros((balance.system.size, 0))


def _load(balance: Equilibrium, entry: Input) -> FloatArray:
    """Generalised load of an input at 1 N or 1 N m, shape (n,)."""
    if isinstance(entry, MeshInput):
        return _flank(balance, entry)[0]
    found: FloatArray = balance.system.relative(entry.on, entry.against).T @ entry.direction
    return found


def _factors(balance: Equilibrium, inputs: Sequence[Input], s: ComplexArray) -> ComplexArray:
    """Load of one unit of each input, shape (frequencies, inputs): 1, or of a transmission error that of its mesh.

    The flank that carries is compressed by r u - e, so that e loads the bodies by r (k + s c) e; of the other flank e
    is a compression, and its sign turns.
    """
    found = np.ones((s.size, len(inputs)), dtype=np.complex128)
    for column, entry in enumerate(inputs):
        if isinstance(entry, MeshInput) and entry.quantity == "transmission_error":
            _, sign, stiffness, damping = _flank(balance, entry)
            found[:, column] = sign * (stiffness + s * damping)
    return found


def _flank(balance: Equilibrium, entry: MeshInput) -> tuple[FloatArray, float, float, float]:
    """Load by a unit force on the flank that carries, sign of its error, stiffness and damping at the equilibrium."""
    from mbs.gears.gear_kernel import BY_RATE, SLOPE

    found = next(connected for connected in balance.system.elements if connected.element.name == entry.pair)
    mesh = cast("GearMesh", found.element)
    displacement = found.transform @ balance.displacement
    flanks = mesh.flanks(displacement, np.zeros_like(displacement), balance.operation)
    flank = int(np.argmax(flanks[:, SLOPE]))
    load = np.asarray(found.transform.T @ mesh.rows[flank], dtype=np.float64)
    return load, 1.0 - 2.0 * flank, float(flanks[flank, SLOPE]), float(flanks[flank, BY_RATE])


def sensor_matrix(balance: Equilibrium, sensors: Sequence[Sensor]) -> FloatArray:
    """Displacement that each sensor sees, or differentiates, by the coordinates, shape (sensors, n)."""
    system = balance.system
    rows = [sensor.direction @ system.relative(sensor.on, sensor.against) for sensor in sensors]
    return np.stack(rows) if rows else np.zeros((0, system.size))


def state_space(balance: Equilibrium, inputs: Sequence[Input] = (), sensors: Sequence[Sensor] = ()) -> StateSpace:
    """State space of small motion about an equilibrium.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    inputs, sensors : sequence
        Columns of B and D, rows of C and D.
    """
    n = balance.system.size
    films = system_film_states(balance)
    q = films.size if films else 0
    damping = balance.damping if films is None else balance.damping - films.relaxation.damping
    springs = np.zeros((n, 0)) if films is None else films.relaxation.rows.T
    solved = np.linalg.solve(
        balance.system.mass, np.hstack([-balance.stiffness, -damping, -springs, input_matrix(balance, inputs)])
    )
    acceleration, by_input = solved[:, : 2 * n + q], solved[:, 2 * n + q :]
    A = np.vstack([np.hstack([np.zeros((n, n)), np.eye(n), np.zeros((n, q))]), acceleration])
    if films is not None:
        A = np.vstack([A, np.hstack([np.zeros((q, n)), springs.T, -np.diag(1.0 / films.relaxation.times)])])
    rows = sensor_matrix(balance, sensors)
    C, D = np.zeros((len(sensors), 2 * n + q)), np.zeros((len(sensors), len(inputs)))
    for i, sensor in enumerate(sensors):
        order = sensor.order
        if order == 2:
            C[i], D[i] = rows[i] @ acceleration, rows[i] @ by_input
        else:
            C[i, order * n : (order + 1) * n] = rows[i]
    return StateSpace(A, np.vstack([np.zeros_like(by_input), by_input, np.zeros((q, len(inputs)))]), C, D)


def responses(
    balance: Equilibrium, inputs: Sequence[Input], frequencies: FloatArray, decay: float = 0.0
) -> ComplexArray:
    """Complex amplitudes of the coordinates for each input at 1 N or 1 N m, shape (frequencies, n, inputs) [m or rad].

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    inputs : sequence of Input
        What excites.
    frequencies : array, shape (frequencies,)
        [Hz].
    decay : float
        1/tau of an exponential window on loads and motion [1/s]: the amplitudes are those at decay + i omega.
    """
    s = np.asarray(decay + 2j * np.pi * np.asarray(frequencies), dtype=np.complex128)
    load = input_matrix(balance, inputs)
    motion = np.empty((s.size, balance.system.size, len(inputs)), dtype=np.complex128)
    for first in range(0, s.size, _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        dynamic = dynamic_stiffness(balance, s[part])
        motion[part] = np.linalg.solve(dynamic, np.broadcast_to(load, (dynamic.shape[0], *load.shape)))
    return motion * _factors(balance, inputs, s)[:, None, :] if inputs else motion


def frequency_response(
    balance: Equilibrium,
    inputs: Sequence[Input],
    sensors: Sequence[Sensor],
    frequencies: FloatArray,
    decay: float = 0.0,
) -> ComplexArray:
    """Frequency responses, shape (frequencies, sensors, inputs) [sensor unit per N or N m].

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    inputs, sensors : sequence
        Inputs and sensors of the responses.
    frequencies : array, shape (frequencies,)
        [Hz].
    decay : float
        1/tau of an exponential window that loads and sensors have been through [1/s].
    """
    return sensed(balance, sensors, frequencies, responses(balance, inputs, frequencies, decay), decay)


def sensed(
    balance: Equilibrium,
    sensors: Sequence[Sensor],
    frequencies: FloatArray,
    motion: ComplexArray,
    decay: float = 0.0,
) -> ComplexArray:
    """Frequency responses from the motion of the coordinates, shape (frequencies, sensors, inputs).

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    sensors : sequence of Sensor
        Sensors of the responses.
    frequencies : array, shape (frequencies,)
        [Hz].
    motion : array, shape (frequencies, n, inputs)
        What `responses` finds.
    decay : float
        Decay of an exponential window, as there [1/s].
    """
    seen = sensor_matrix(balance, sensors) @ motion
    s = decay + 2j * np.pi * np.asarray(frequencies, dtype=np.float64)
    orders = np.array([sensor.order for sensor in sensors])
    result: ComplexArray = seen * (s[:, None] ** orders[None, :])[:, :, None]
    return result


TOLERANCE = 1e-8
"""Error at the frequencies checked, above which all are solved directly; others may have some times as much."""

FILM_TOLERANCE = 1e-6
"""The same where films relax: a hundred times what their few states leave, as resonances enlarge it."""

_CHECKED = 3


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
    displacement = (resonance @ residues).reshape(omega.size, len(sensors), len(inputs))
    orders = np.array([sensor.order for sensor in sensors], dtype=np.int64)
    result: ComplexArray = displacement * ((1j * omega[:, None]) ** orders)[:, :, None]
    if inputs:
        result *= _factors(balance, inputs, np.asarray(1j * omega, dtype=np.complex128))[:, None, :]
    return result


def seen_of_loads(
    balance: Equilibrium,
    states: StateModes,
    sensors: Sequence[Sensor],
    frequencies: FloatArray,
    ports: FloatArray,
) -> ComplexArray:
    """Response of each sensor to a load of 1 N or 1 N m on each of some ports, shape (frequencies, sensors, ports).

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
    orders = np.array([sensor.order for sensor in sensors], dtype=np.int64)
    displacement = np.stack([(resonance * row) @ by_load for row in seen], axis=1)
    return np.asarray(displacement * (rate[:, None] ** orders)[:, :, None])


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
    """Compute what `checked_response` returns, or raise numpy's error for a singular system."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        modal = modal_response(balance, states, inputs, sensors, frequencies)
    checked = np.unique(np.linspace(0, frequencies.size - 1, _CHECKED + 2).astype(np.int64))
    at = frequencies[checked]
    direct = frequency_response(balance, inputs, sensors, at)
    omega = 2.0 * np.pi * at[:, None, None]
    orders = np.array([sensor.order for sensor in sensors])[None, :, None]
    whole = np.linalg.norm(responses(balance, inputs, at), axis=1)[:, None, :]
    rows = np.linalg.norm(sensor_matrix(balance, sensors), axis=1)[None, :, None]
    size = np.abs(direct) + 1e-6 * rows * whole * omega**orders
    error = float(np.max(np.abs(modal[checked] - direct) / np.maximum(size, 1e-300)))
    if np.all(np.isfinite(modal)) and error <= (TOLERANCE if states.films is None else FILM_TOLERANCE):
        return modal, error
    return frequency_response(balance, inputs, sensors, frequencies), 0.0


def level_bands(
    balance: Equilibrium,
    states: StateModes,
    sensors: Sequence[Sensor],
    frequencies: FloatArray,
    motion: ComplexArray,
    responses: ComplexArray,
) -> tuple[FloatArray | None, float]:
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
    float
        Median part of the bands that is what films with memory leave out.
    """
    laws = law_bands(balance)
    if laws is None:
        return None, 0.0
    back = seen_of_loads(balance, states, sensors, frequencies, laws.ports)
    band, by_films = laws.of_responses(frequencies, laws.ports @ motion, back, responses)
    levels = np.asarray(20.0 * np.log10(1.0 + band / np.maximum(np.abs(responses), 1e-300)))
    return levels, film_share(by_films, band)
