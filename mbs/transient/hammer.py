"""Simulated hammer tests: what a hammer and the sensors of a scene would record.

A hit is a half-sine of random height. The linear response of the equilibrium is exact at every sample: the state and
the half-sine together obey a linear equation without input, whose matrix exponential steps through the pulse, and
after it through the free decay. Everything is computed at a rate sixteen times as high as that of the records, then
force and responses pass the same linear-phase filter, as in an analyser, and every sixteenth sample is kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy  # its parts at first use: scipy.signal takes half a second
from scipy.fft import next_fast_len
from scipy.linalg import expm

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, Problems
from mbs.linearised.linear import StateSpace, input_matrix, sensor_matrix, state_space
from mbs.linearised.modes import Modes
from mbs.modal.records import LONGEST, Channel, Hits, Measured
from mbs.model.elements import Input, Sensor
from mbs.model.equilibrium import Equilibrium
from mbs.model.profiles import Course, HalfSine, SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import WITH_STATES, States, run

OVERSAMPLING = 16
"""Computed samples for each recorded one. What a half-sine has beyond half the rate of the computed samples folds back,
0.05 % of its spectrum at low frequencies and 0.25 % at the highest one of interest."""

PER_HIGHEST = 2.56
"""Sampling rate over the highest frequency of interest, as analysers have it."""

_TAPS = 40 * OVERSAMPLING + 1
"""Of the anti-aliasing filter: symmetric, so that it delays by 20 recorded samples, which are taken off."""

_QUIET = 1.0 / 64.0
"""Part of a record before the hit."""

DECAYED = 1e-3
"""Level to which the slowest mode has decayed at the end of a record, if that is not too long."""

MOST_SAMPLES = 2**14
"""Recorded samples of a hit, if the duration is left out."""


@dataclass(frozen=True)
class HammerTest:
    """Settings of a hammer test.

    Attributes
    ----------
    highest : float
        Highest frequency of interest [Hz]: the sampling rate is 2.56 times it, and the pulse lasts one period of it,
        so that its spectrum is a third of its largest value there.
    duration : float
        Length of a record [s]; rounded up to a number of samples that transforms quickly.
    hits : int
        Number of hits at each place.
    noise : float
        Standard deviation of white noise on every channel, as a part of the peak of the channel in that hit.
    seed : int
        Seed of the random heights and the noise.
    spread : float
        Heights lie evenly within this part of the amplitude of the input, either way.

    Raises
    ------
    InputError
        With every value that is not possible.
    """

    highest: float
    duration: float
    hits: int = 8
    noise: float = 0.01
    seed: int = 0
    spread: float = 0.5

    def __post_init__(self) -> None:
        problems = Problems()
        if not (math.isfinite(self.highest) and 0.0 < self.highest <= 1e6):
            problems.append(f"hammer test, highest: got {self.highest!r} Hz; allowed: above 0, up to 1 MHz")
        elif not (math.isfinite(self.duration) and 64.0 <= self.duration * PER_HIGHEST * self.highest <= LONGEST / 4):
            problems.append(
                f"hammer test, duration: got {self.duration!r} s; allowed: 64 to {LONGEST // 4} samples at "
                f"{PER_HIGHEST} times {self.highest:.6g} Hz"
            )
        if not 1 <= self.hits <= 1000:
            problems.append(f"hammer test, hits: got {self.hits!r}; allowed: 1 to 1000")
        if not 0.0 <= self.noise <= 1.0:
            problems.append(f"hammer test, noise: got {self.noise!r}; allowed: 0 to 1, a part of the peak")
        if self.seed < 0:
            problems.append(f"hammer test, seed: got {self.seed!r}; allowed: 0 or more")
        if not 0.0 <= self.spread < 1.0:
            problems.append(f"hammer test, spread: got {self.spread!r}; allowed: 0 to below 1")
        problems.check()

    @property
    def step(self) -> float:
        """Between recorded samples [s]: six digits, which is what a UFF file keeps of it."""
        return float(f"{1.0 / (PER_HIGHEST * self.highest):.5e}")

    @property
    def samples(self) -> int:
        """Samples of a record."""
        wanted = math.ceil(self.duration / self.step)
        return int(next_fast_len(wanted + wanted % 2, real=True))

    @property
    def quiet(self) -> int:
        """Recorded samples before the hit."""
        return max(round(_QUIET * self.samples), 24)

    @property
    def pulse(self) -> float:
        """Time for which the hammer touches [s]; a whole number of computed steps."""
        fine = self.step / OVERSAMPLING
        return max(round(1.0 / self.highest / fine), 2) * fine


def suggested_duration(found: Modes, highest: float) -> float:
    """Time in which the slowest oscillating mode below `highest` [Hz] decays to a thousandth, at most 16384 samples.

    Parameters
    ----------
    found : Modes
        Modes of the equilibrium.
    highest : float
        [Hz].
    """
    longest = MOST_SAMPLES / (PER_HIGHEST * highest)
    seen = (found.eigenvalues.imag > 0.0) & (found.frequency <= highest)
    slowest = float(np.min(-found.eigenvalues.real[seen], initial=math.inf))
    needed = -math.log(DECAYED) / slowest if slowest > 0.0 else math.inf
    return min(max(needed, 1024.0 / (PER_HIGHEST * highest)), longest)


def linear_hits(
    balance: Equilibrium, inputs: tuple[Input, ...], sensors: tuple[Sensor, ...], test: HammerTest
) -> tuple[Hits, ...]:
    """Hits at every input, answered by the linearised system.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    inputs, sensors : tuple
        Places hit and what is recorded.
    test : HammerTest
        Settings of the test.

    Raises
    ------
    AnalysisError
        If the motion grows beyond all bounds.
    """
    space = state_space(balance, inputs, sensors)
    answers = []
    for column in range(len(inputs)):
        response = _free_response(space, column, balance.system.size, test)
        if not np.all(np.isfinite(response)):
            raise AnalysisError(
                "hammer test: the motion after a hit grows beyond all bounds; the linearised system is not stable: "
                "see `mbs modes`"
            )
        answers.append(_filtered(response, test))

    def respond(column: int, height: float) -> FloatArray:
        return height * answers[column]

    return _hits(inputs, sensors, test, respond)


def nonlinear_hits(
    balance: Equilibrium,
    inputs: tuple[Input, ...],
    sensors: tuple[Sensor, ...],
    test: HammerTest,
    progress: Callable[[], None] | None = None,
) -> tuple[tuple[Hits, ...], dict[str, int]]:
    """Hits at every input, answered by the nonlinear system.

    The cage stands at its start angle while the films feel the speed, as in the linear analyses: the rollers that
    pass would excite the system besides the hammer. Films with memory begin in equilibrium. Integrated by the
    trapezoidal rule, which damps nothing; its frequencies are low by (omega h)^2/12, 0.2 % at the highest frequency of
    interest and 0.05 % at half of it.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which each hit begins.
    inputs, sensors, test
        The same as for `linear_hits`.
    progress : callable, optional
        Called after each hit.

    Returns
    -------
    hits : tuple of Hits
        One an input.
    outside : dict of str to int
        How often each element was evaluated outside its map, by name.

    Raises
    ------
    AnalysisError
        If a time step finds no solution.
    """
    system = balance.system
    measured = sensor_matrix(balance, sensors)
    at_rest = measured @ balance.displacement
    fine = test.step / OVERSAMPLING
    count = (test.samples + _TAPS // (2 * OVERSAMPLING)) * OVERSAMPLING
    speed = _CageAtRest(Course((0.0,), (balance.operation.speed,)))
    settings = Settings(step=fine, sample=fine, spectral_radius=1.0)
    forces = input_matrix(balance, inputs)
    begin = test.quiet * test.step
    part = (np.arange(count) * fine - begin) / test.pulse
    outside = dict.fromkeys(balance.outside, 0)
    sine = np.where((part > 0.0) & (part < 1.0), np.sin(np.pi * part), 0.0)

    def respond(column: int, height: float) -> FloatArray:
        struck = system.with_load(height * forces[:, column], HalfSine(begin, test.pulse))
        recording = run(
            struck, speed, (count - 1) * fine, settings, displacement=balance.displacement, options=WITH_STATES
        )
        for name, calls in recording.outside.items():
            outside[name] += calls
        if progress:
            progress()
        signals = _sensed(recording.states, sensors, measured, at_rest)
        return _filtered(np.concatenate([height * sine[None], signals]), test)

    return _hits(inputs, sensors, test, respond), outside


@dataclass(frozen=True)
class _CageAtRest(SpeedProfile):
    """A speed that the films feel, while the cage stands."""

    def at(self, time: float) -> tuple[float, float]:
        """Speed [rad/s], and no angle."""
        return self.course(time), 0.0


def _free_response(space: StateSpace, column: int, size: int, test: HammerTest) -> FloatArray:
    """Response (1 + sensors, computed samples) to a half-sine of height 1 at an input, the force itself first."""
    A, b, C, d = space.A, space.B[:, column], space.C, space.D[:, column]
    n, fine = A.shape[0], test.step / OVERSAMPLING
    # A matrix of one size is kinder to the exponential: velocities in units of the highest frequency, and films, which
    # follow velocities, by the roots of their springs.
    springs = np.linalg.norm(A[2 * size :, size : 2 * size], axis=1)
    slow = 1.0 / (2.0 * np.pi * test.highest)
    scale = np.concatenate([np.ones(size), np.full(size, slow), 1.0 / np.maximum(springs, 1e-30)])
    rate = np.pi / test.pulse
    turning = np.zeros((n + 2, n + 2))
    turning[:n, :n] = scale[:, None] * A / scale
    turning[:n, n] = scale * b
    turning[n, n + 1], turning[n + 1, n] = rate, -rate
    outputs = np.zeros((1 + C.shape[0], n + 2))
    outputs[0, n] = 1.0
    outputs[1:, :n], outputs[1:, n] = C / scale, d
    through = expm(turning * fine)
    state = np.zeros(n + 2)
    state[n + 1] = 1.0
    steps = round(test.pulse / fine)
    begin = test.quiet * OVERSAMPLING
    total = (test.samples + _TAPS // (2 * OVERSAMPLING)) * OVERSAMPLING
    response = np.zeros((outputs.shape[0], total))
    for k in range(begin, begin + steps):
        response[:, k] = outputs @ state
        state = through @ state
    rest = total - begin - steps
    after = _decay(through[:n, :n], outputs[1:, :n], state[:n], rest)
    response[1:, begin + steps :] = after
    return response


def _decay(through: FloatArray, outputs: FloatArray, state: FloatArray, samples: int) -> FloatArray:
    """Outputs (sensors, samples) of a state left to itself, in blocks: a block is one product of matrices."""
    block = outputs[None]
    power = through
    with np.errstate(over="ignore", invalid="ignore"):
        while block.shape[0] < min(samples, 1024):
            block = np.concatenate([block, block @ power])
            power = power @ power
        pieces = []
        for _ in range(-(-samples // block.shape[0])):
            pieces.append(block @ state)
            state = power @ state
    return np.asarray(np.concatenate(pieces)[:samples].T, dtype=np.float64)


def _filtered(fine: FloatArray, test: HammerTest) -> FloatArray:
    """Records (channels, samples) of computed channels, through the anti-aliasing filter."""
    taps = scipy.signal.firwin(_TAPS, 0.5 / OVERSAMPLING, window=("kaiser", 8.0), fs=1.0)
    delay = _TAPS // (2 * OVERSAMPLING)
    filtered = scipy.signal.upfirdn(taps, fine, down=OVERSAMPLING, axis=-1)
    return np.asarray(filtered[:, delay : delay + test.samples], dtype=np.float64)


def _sensed(states: States, sensors: tuple[Sensor, ...], measured: FloatArray, at_rest: FloatArray) -> FloatArray:
    """Signals of sensors in a run, without the equilibrium, shape (sensors, samples)."""
    motion = {
        "displacement": states.displacement @ measured.T - at_rest,
        "velocity": states.velocity @ measured.T,
        "acceleration": states.acceleration @ measured.T,
    }
    return np.stack([motion[sensor.quantity][:, i] for i, sensor in enumerate(sensors)])


def _hits(
    inputs: tuple[Input, ...],
    sensors: tuple[Sensor, ...],
    test: HammerTest,
    respond: Callable[[int, float], FloatArray],
) -> tuple[Hits, ...]:
    """Records of all hits at all inputs, with noise."""
    random = np.random.default_rng(test.seed)
    references, channels = _channels(inputs, sensors)
    hits = []
    for column, entry in enumerate(inputs):
        records = []
        for _ in range(test.hits):
            height = entry.amplitude * random.uniform(1.0 - test.spread, 1.0 + test.spread)
            clean = respond(column, height)
            peak = np.max(np.abs(clean), axis=1, keepdims=True)
            records.append(clean + test.noise * peak * random.standard_normal(clean.shape))
        stacked = np.stack(records)
        hits.append(Hits(test.step, stacked[:, 0], stacked[:, 1:], references[column], channels))
    return tuple(hits)


def _channels(
    inputs: tuple[Input, ...], sensors: tuple[Sensor, ...]
) -> tuple[tuple[Channel, ...], tuple[Channel, ...]]:
    """Channels of the inputs and of the sensors; a node a place, in the order in which they come."""
    places = list(dict.fromkeys([*(entry.on for entry in inputs), *(entry.on for entry in sensors)]))

    def channel(entry: Input | Sensor, quantity: Measured) -> Channel:
        return Channel(entry.name, places.index(entry.on) + 1, _direction(entry.direction), quantity)

    return (
        tuple(channel(entry, "force") for entry in inputs),
        tuple(channel(entry, entry.quantity) for entry in sensors),
    )


def _direction(direction: FloatArray) -> int:
    """Code of a direction: 1 to 6 along or about an axis, negative against it, else 0."""
    along = np.nonzero(direction)[0]
    return 0 if along.size != 1 else int(np.sign(direction[along[0]])) * (int(along[0]) + 1)
