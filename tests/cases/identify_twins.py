"""Twins of machines: responses with hidden values of the unknowns and noise of a known size."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs import Scene, assemble, read_scene
from mbs.analyses.operating import settled
from mbs.identification.free import Free, read_free
from mbs.identification.machine import Machine, looked
from mbs.identification.measured import MeasuredModes, MeasuredResponses
from mbs.identification.search import Question

RPM = math.pi / 30.0

ROTOR = Path(__file__).parents[1] / "data" / "identify_rotor.toml"

SEATS = [f"foot_{side}.{kind}" for side in ("left", "right") for kind in ("stiffness", "damping")]

ROLLERS = {
    "left.clearance": 18e-6,
    "right.clearance": 31e-6,
    "temperature": 331.15,
    "foot_left.stiffness.y": 3.3e8,
    "foot_left.stiffness.z": 1.8e8,
    "foot_left.damping.y": 7e3,
    "foot_left.damping.z": 3e3,
    "foot_right.stiffness.y": 2.6e8,
    "foot_right.stiffness.z": 2.3e8,
    "foot_right.damping.y": 5e3,
    "foot_right.damping.z": 6e3,
}
"""Hidden values of the rotor on rollers."""

BALLS = {"drive.clearance": 11e-6, "end.clearance": 18e-6, "temperature": 345.0, "preload.force": 380.0}
"""Hidden values of the electric drive."""


def noisy(response: ComplexArray, rng: np.random.Generator) -> tuple[ComplexArray, FloatArray]:
    """Responses with noise of 2 % of each value and 1 % of the median of its channel, and the relative deviation."""
    deviation = np.hypot(0.02, 0.01 * np.median(np.abs(response), axis=0) / np.abs(response))
    unit = (rng.normal(size=response.shape) + 1j * rng.normal(size=response.shape)) / math.sqrt(2.0)
    return response * (1.0 + deviation * unit), deviation


@dataclasses.dataclass(frozen=True, eq=False)
class Twin:
    """A machine whose values are hidden.

    Attributes
    ----------
    machine : Machine
        The machine of the scene.
    free : tuple of Free
        Unknowns.
    hidden : mapping of str to float
        Values by unknown [SI].
    scene : Scene
        What the hidden machine is otherwise: that of the machine, or with other loads.
    law : str
        Law of the hidden machine; empty for that of the machine.
    """

    machine: Machine
    free: tuple[Free, ...]
    hidden: Mapping[str, float]
    scene: Scene
    law: str = ""

    @property
    def truth(self) -> FloatArray:
        """Hidden values in the coordinates of the search."""
        return np.array([one.coordinate(self.hidden[one.name]) for one in self.free])

    def responses(
        self, speeds: Sequence[float], frequencies: FloatArray, rng: np.random.Generator, sensors: int = 2
    ) -> tuple[MeasuredResponses, ...]:
        """Responses of the first sensors to the first input, at speeds [rpm]."""
        rows = tuple((sensor, self.scene.inputs[0]) for sensor in self.scene.sensors[:sensors])
        shape = frequencies.size, len(rows)
        found = []
        for speed in speeds:
            empty = MeasuredResponses("twin", speed * RPM, frequencies, np.ones(shape, complex), np.ones(shape), rows)
            response, deviation = noisy(np.exp(self._looked(empty)), rng)
            found.append(dataclasses.replace(empty, response=response, deviation=deviation))
        return tuple(found)

    def modes(self, speeds: Sequence[float], near: FloatArray, rng: np.random.Generator) -> tuple[MeasuredModes, ...]:
        """Frequencies of the modes nearest to some [Hz], 0.2 % off, at speeds [rpm]; no damping ratios."""
        found = []
        for speed in speeds:
            none = np.full(near.size, math.nan)
            empty = MeasuredModes("twin", speed * RPM, near, near, none, none)
            frequency = np.exp(self._looked(empty)[0].real) * (1.0 + 0.002 * rng.normal(size=near.size))
            found.append(dataclasses.replace(empty, frequency=frequency, frequency_deviation=0.002 * frequency))
        return tuple(found)

    def _looked(self, empty: MeasuredResponses | MeasuredModes) -> ComplexArray:
        machine = dataclasses.replace(self.machine, law=self.law or self.machine.law)
        return looked(machine, self.scene, self.free, [self.hidden[one.name] for one in self.free], empty)

    def question(self, measured: Sequence[MeasuredResponses | MeasuredModes]) -> Question:
        """What is asked of the machine of the scene."""
        return Question(self.machine, self.machine.model.scene, self.free, tuple(measured))


def twin(
    name: str | Path, fastest: float, free: Sequence[str], hidden: Mapping[str, float], highest: float, angles: int = 4
) -> Twin:
    """A twin of a scene, at speeds up to one [rpm] and frequencies up to one [Hz]."""
    scene = dataclasses.replace(read_scene(name), speed=fastest * RPM)
    model = settled([assemble(scene)], scene.speed, highest)[0]
    return Twin(Machine(model, angles), read_free(free, model.scene), hidden, model.scene)


def rollers(angles: int = 4) -> Twin:
    """The rotor on two cylindrical bearings."""
    return twin(ROTOR, 4000.0, ["clearance", "temperature", *SEATS], ROLLERS, 2500.0, angles)


def balls(angles: int = 4) -> Twin:
    """The electric drive on two ball bearings."""
    return twin("electric_drive", 6000.0, list(BALLS), BALLS, 2000.0, angles)
