"""Measured data: channels, time records of hammer hits, and the frequency responses estimated from them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import InputError, Problems

Measured = Literal["displacement", "velocity", "acceleration", "force", "unknown"]

DERIVATIVE: dict[Measured, int] = {"displacement": 0, "velocity": 1, "acceleration": 2, "force": 0, "unknown": 0}
"""How often a channel differentiates the displacement."""

LONGEST = 2**24
"""Samples of a record, or lines of a response, that are still read."""

_DIRECTIONS = {0: "", 1: "+x", 2: "+y", 3: "+z", 4: "+theta_x", 5: "+theta_y", 6: "+theta_z"}


@dataclass(frozen=True)
class Channel:
    """Place and quantity of a measurement.

    Attributes
    ----------
    name : str
        Name of the sensor or of the place hit; may be empty.
    node : int
        Number of the place.
    direction : int
        0 along no axis or unknown; 1, 2, 3 along x, y, z; 4, 5, 6 about them; negative: against them.
    quantity : {"displacement", "velocity", "acceleration", "force", "unknown"}
        What is measured.
    """

    name: str
    node: int
    direction: int
    quantity: Measured

    @property
    def rotational(self) -> bool:
        """True for an angle or a moment."""
        return abs(self.direction) > 3

    @property
    def label(self) -> str:
        """Name, node and direction in short."""
        axis = _DIRECTIONS.get(abs(self.direction), "")
        axis = axis.replace("+", "-") if self.direction < 0 else axis
        return f"{self.name or 'node'}:{self.node}{axis}"

    @property
    def place(self) -> tuple[str, int, int]:
        """Key that channels of the same place share."""
        return self.name, self.node, self.direction


@dataclass(frozen=True, eq=False)
class Hits:
    """Time records of hits at one place.

    Attributes
    ----------
    step : float
        Time between samples [s].
    force : array, shape (hits, samples)
        [N or N m].
    response : array, shape (hits, sensors, samples)
        Responses in the SI unit of each sensor.
    reference : Channel
        The place hit.
    sensors : tuple of Channel
        Sensors, as many as `response` has.
    decay : float
        1/tau of an exponential window, from the first sample on, that the responses have been through [1/s].
    force_decays : bool
        Whether the force has been through it, too.

    Raises
    ------
    InputError
        With everything that does not fit together.
    """

    step: float
    force: FloatArray
    response: FloatArray
    reference: Channel
    sensors: tuple[Channel, ...]
    decay: float = 0.0
    force_decays: bool = False

    def __post_init__(self) -> None:
        problems = Problems()
        where = f"hits at {self.reference.label}"
        if not (np.isfinite(self.decay) and self.decay >= 0.0):
            problems.append(f"{where}, decay: got {self.decay!r} 1/s; allowed: finite and >= 0")
        if not (np.isfinite(self.step) and self.step > 0.0):
            problems.append(f"{where}, step: got {self.step!r} s; allowed: finite and > 0")
        if self.force.ndim != 2 or self.response.ndim != 3:
            problems.append(
                f"{where}: got force of shape {self.force.shape} and response of shape {self.response.shape}; allowed: "
                "(hits, samples) and (hits, sensors, samples)"
            )
        else:
            hits, samples = self.force.shape
            if self.response.shape != (hits, len(self.sensors), samples) or not self.sensors or hits < 1:
                problems.append(
                    f"{where}: got {hits} hits of {samples} samples with responses of shape {self.response.shape} for "
                    f"{len(self.sensors)} sensors; allowed: at least one of each, and records of equal length"
                )
            elif not 16 <= samples <= LONGEST:
                problems.append(f"{where}: got {samples} samples; allowed: 16 to {LONGEST}")
        problems.check()

    @property
    def duration(self) -> float:
        """Duration of a record [s]."""
        return self.step * int(self.force.shape[1])


@dataclass(frozen=True, eq=False)
class Responses:
    """Frequency responses, a row for each pair of a sensor and a place hit.

    Attributes
    ----------
    frequency : array, shape (lines,)
        Rising [Hz].
    response : array, shape (rows, lines)
        Responses in the SI unit of the sensor per N or N m.
    coherence : array, shape (rows, lines)
        Ordinary coherence; NaN where it is not known, as for a single hit.
    pairs : tuple of (Channel, Channel)
        Sensor and place hit of each row.
    hits : int
        How many were averaged; 0 if not known.
    decay : float
        1/tau of the exponential window that force and response have been through [1/s]; 0 for none.

    Raises
    ------
    InputError
        With everything that does not fit together.
    """

    frequency: FloatArray
    response: ComplexArray
    coherence: FloatArray
    pairs: tuple[tuple[Channel, Channel], ...]
    hits: int = 0
    decay: float = 0.0

    def __post_init__(self) -> None:
        problems = Problems()
        rows, lines = len(self.pairs), self.frequency.size
        if self.frequency.ndim != 1 or not 2 <= lines <= LONGEST:
            problems.append(f"responses: got {lines} frequencies; allowed: a list of 2 to {LONGEST}")
        elif not np.all(np.isfinite(self.frequency)) or self.frequency[0] < 0.0 or np.any(np.diff(self.frequency) <= 0):
            problems.append("responses: got frequencies that are not finite, >= 0 Hz and rising; sort them")
        if rows < 1 or self.response.shape != (rows, lines) or self.coherence.shape != (rows, lines):
            problems.append(
                f"responses: got values of shape {self.response.shape} and coherence of shape {self.coherence.shape} "
                f"for {rows} pairs and {lines} frequencies; allowed: (pairs, frequencies), at least one pair"
            )
        elif not np.all(np.isfinite(self.response)):
            problems.append("responses: got values that are not finite; leave those responses out")
        if not (np.isfinite(self.decay) and self.decay >= 0.0):
            problems.append(f"responses, decay: got {self.decay!r} 1/s; allowed: finite and >= 0")
        problems.check()

    @property
    def derivatives(self) -> tuple[int, ...]:
        """Number of times that the sensor of each row differentiates the displacement."""
        return tuple(DERIVATIVE[sensor.quantity] for sensor, _ in self.pairs)

    @property
    def labels(self) -> tuple[str, ...]:
        """Each row in words."""
        return tuple(f"{sensor.label} by {reference.label}" for sensor, reference in self.pairs)

    def within(self, low: float, high: float) -> Responses:
        """The lines from `low` to `high` [Hz], without 0 Hz."""
        kept = (self.frequency >= low) & (self.frequency <= high) & (self.frequency > 0.0)
        if np.count_nonzero(kept) < 2:
            raise InputError(
                f"band: got {low:.6g} Hz to {high:.6g} Hz, with {np.count_nonzero(kept)} lines of the responses in it; "
                f"allowed: a part of {self.frequency[0]:.6g} Hz to {self.frequency[-1]:.6g} Hz with many lines"
            )
        return Responses(
            self.frequency[kept],
            self.response[:, kept],
            self.coherence[:, kept],
            self.pairs,
            self.hits,
            self.decay,
        )
