"""Plan of hits, sensors and speeds that tell unknowns apart, by the machine's own derivatives.

Each channel, a sensor by a hit at a speed, adds F = J'J with the noise that `measured.ASSUMED` takes; what is known
beforehand adds its own, and so does the range of each unknown. The next channel is always that after which the ranges
are smallest in all, the determinant of F largest. A machine that stands counts as one speed more.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.units import RPM
from mbs.identification.certainty import APART
from mbs.identification.free import Free
from mbs.identification.machine import Machine, looked
from mbs.identification.measured import MeasuredResponses, assumed_deviation
from mbs.identification.search import STEP
from mbs.scene.scene import Scene

MOST_CHANNELS = 8
"""Channels of a plan."""

ENOUGH = 0.2
"""Gain of a channel more, as the logarithm of a deviation, below which a plan ends where all is told apart."""


@dataclass(frozen=True)
class Channel:
    """Something that can be measured.

    Attributes
    ----------
    speed : float
        [rad/s].
    sensor, entry : str
        Sensor and input of the scene.
    """

    speed: float
    sensor: str
    entry: str

    @property
    def text(self) -> str:
        """The channel in words."""
        return f"{self.sensor} by a hit at {self.entry}, {RPM.text(self.speed) if self.speed else 'at rest'}"


@dataclass(frozen=True, eq=False)
class Step:
    """A plan up to one of its channels.

    Attributes
    ----------
    channel : Channel
        What is measured besides.
    deviation : array, shape (unknowns,)
        Standard deviations in the coordinates of the search, of noise alone.
    correlation : array, shape (unknowns, unknowns)
        Correlations of the unknowns.
    """

    channel: Channel
    deviation: FloatArray
    correlation: FloatArray

    @property
    def closest(self) -> tuple[int, int, float]:
        """The two unknowns that are least told apart, and their correlation."""
        size = np.abs(np.tril(self.correlation, -1))
        if size.size < 2:
            return 0, 0, 0.0
        row, column = np.unravel_index(int(np.argmax(size)), size.shape)
        return int(row), int(column), float(self.correlation[row, column])


def information_of(
    machine: Machine,
    scene: Scene,
    free: Sequence[Free],
    speeds: Sequence[float],
    frequencies: FloatArray,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> dict[Channel, FloatArray]:
    """Information of each channel about the unknowns, J'J in parts of their ranges.

    Parameters
    ----------
    machine : Machine
        The machine.
    scene : Scene
        Scene of the machine; derivatives are taken at its values.
    free : sequence of Free
        Unknowns of the machine.
    speeds : sequence of float
        Speeds that may be measured at [rad/s]; 0 at rest.
    frequencies : array, shape (lines,)
        Lines [Hz].
    progress : callable
        Told how much is done, and of how much.

    Raises
    ------
    AnalysisError
        If the machine has no equilibrium at any of the speeds.
    """
    rows = tuple(itertools.product(scene.sensors, scene.inputs))
    widths = np.array([one.ends[1] - one.ends[0] for one in free])
    found: dict[Channel, FloatArray] = {}
    progress(0, len(speeds))
    reasons: list[str] = []
    for n, speed in enumerate(speeds):
        shape = frequencies.size, len(rows)
        empty = MeasuredResponses("plan", speed, frequencies, np.ones(shape, complex), np.full(shape, 0.01), rows)
        values = [one.start for one in free]
        try:
            middle = looked(machine, scene, free, values, empty)
            columns = []
            for k, one in enumerate(free):
                at = one.coordinate(one.start)
                step = STEP * widths[k] * (1.0 if at - one.ends[0] < 0.5 * widths[k] else -1.0)
                moved = [one.value(at + step) if j == k else value for j, value in enumerate(values)]
                columns.append((looked(machine, scene, free, moved, empty) - middle) / (step / widths[k]))
        except (AnalysisError, InputError) as error:
            reasons.append(f"{RPM.text(speed)}: {error}")
            continue
        weights = np.sqrt(2.0) / assumed_deviation(np.exp(middle))
        J = np.stack(columns, axis=2) * weights[:, :, None]
        for row, (sensor, entry) in enumerate(rows):
            own = J[:, row]
            found[Channel(speed, sensor.name, entry.name)] = np.asarray((own.conj().T @ own).real)
        progress(n + 1, len(speeds))
    if not found:
        raise AnalysisError("; ".join(reasons))
    return found


def before(free: Sequence[Free]) -> FloatArray:
    """Information that ranges and statements are, in parts of the ranges."""
    parts = np.full(len(free), 12.0)  # uniform over the range
    for k, one in enumerate(free):
        if one.prior is not None:
            parts[k] = max(parts[k], ((one.ends[1] - one.ends[0]) / one.prior[1]) ** 2)
    return np.diag(parts)


def plan(free: Sequence[Free], channels: dict[Channel, FloatArray], most: int = MOST_CHANNELS) -> list[Step]:
    """Choose channels, the most telling first.

    Parameters
    ----------
    free : sequence of Free
        Unknowns of the machine.
    channels : dict of Channel to array
        What `information_of` finds.
    most : int
        Channels at most.
    """
    total = before(free)
    steps: list[Step] = []
    rest = dict(channels)
    while rest and len(steps) < most:
        gains = {one: float(np.linalg.slogdet(total + own)[1]) for one, own in rest.items()}
        best = max(gains, key=lambda one: gains[one])
        gain = 0.5 * (gains[best] - float(np.linalg.slogdet(total)[1]))
        if steps and gain < ENOUGH * len(free) and abs(steps[-1].closest[2]) < APART:
            break
        total = total + rest.pop(best)
        steps.append(_step(free, best, total))
    return steps


def told_by(free: Sequence[Free], known: FloatArray, channels: dict[Channel, FloatArray]) -> Step | None:
    """The one channel more that tells best what is not told apart; None without any.

    Parameters
    ----------
    free : sequence of Free
        Unknowns of the machine.
    known : array, shape (unknowns, unknowns)
        Information that there is.
    channels : dict of Channel to array
        What could be measured besides.
    """
    steps = [_step(free, one, known + own) for one, own in channels.items()]
    return min(steps, key=lambda one: abs(one.closest[2]), default=None)


def _step(free: Sequence[Free], channel: Channel, total: FloatArray) -> Step:
    """A plan with this information in all."""
    scale = np.sqrt(np.diag(total))
    inverse = np.linalg.inv(total / np.outer(scale, scale)) / np.outer(scale, scale)
    parts = np.sqrt(np.diag(inverse))
    widths = np.array([one.ends[1] - one.ends[0] for one in free])
    return Step(channel, parts * widths, inverse / np.outer(parts, parts))
