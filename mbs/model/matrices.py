"""A connection by full matrices of stiffness and damping, over speed: journal bearings, seals, magnetic pull.

The force on the `on` side is -K(w) x - C(w) v. K need not be symmetric: its skew part drives a whirl or brakes it, and
does work on closed courses. It may be negative. Between the speeds of the table both are linear; beyond them those at
its end hold, and each such call is counted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from mbs.model.elements import GROUND, ElementDefaults, Forces, Operation, Port, Powers

MOST_SPEEDS = 1000
"""Speeds of a table."""


@dataclass(frozen=True, eq=False)
class MatrixElement(ElementDefaults):
    """Stiffness and damping by matrices between two places.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on, against : str
        Places at the same point.
    speeds : array, shape (speeds,)
        Speeds of the system, rising [rad/s]; one for matrices that hold at any speed.
    stiffness, damping : array, shape (speeds, 6, 6)
        Matrices of the six displacements of `on` against `against` [N/m, N/rad, N m/rad; with s].

    Raises
    ------
    InputError
        For arrays that do not belong together.
    """

    name: str
    on: str
    stiffness: FloatArray
    damping: FloatArray
    against: str = GROUND
    speeds: FloatArray = field(default_factory=lambda: np.zeros(1))

    def __post_init__(self) -> None:
        for name in ("speeds", "stiffness", "damping"):
            object.__setattr__(self, name, np.ascontiguousarray(getattr(self, name), dtype=np.float64))
        count = self.speeds.size
        problems = Problems()
        if self.speeds.ndim != 1 or not 1 <= count <= MOST_SPEEDS or np.any(np.diff(self.speeds) <= 0.0):
            problems.append(f"{self.name!r}, speeds: got {count}; allowed: 1 to {MOST_SPEEDS}, each above the last")
        problems += [
            f"{self.name!r}, {name}: got the shape {getattr(self, name).shape}; allowed: {(count, 6, 6)}"
            for name in ("stiffness", "damping")
            if getattr(self, name).shape != (count, 6, 6)
        ]
        if not all(np.all(np.isfinite(getattr(self, name))) for name in ("speeds", "stiffness", "damping")):
            problems.append(f"{self.name!r}: got numbers that are not finite; allowed: finite ones")
        problems.check()

    @cached_property
    def ports(self) -> tuple[Port, ...]:
        """The displacement of one place against the other."""
        return (Port(self.on, self.against),)

    def beyond(self, speed: float) -> bool:
        """Tell whether a speed [rad/s] lies beyond the table, where its end holds."""
        return self.speeds.size > 1 and not self.speeds[0] <= speed <= self.speeds[-1]

    def at(self, speed: float) -> tuple[FloatArray, FloatArray]:
        """Stiffness and damping at a speed [rad/s], shape (6, 6) each."""
        index = int(np.clip(np.searchsorted(self.speeds, speed) - 1, 0, max(self.speeds.size - 2, 0)))
        if self.speeds.size == 1:
            return self.stiffness[0], self.damping[0]
        part = (speed - self.speeds[index]) / (self.speeds[index + 1] - self.speeds[index])
        part = min(max(part, 0.0), 1.0)
        k, c = (table[index] + part * (table[index + 1] - table[index]) for table in (self.stiffness, self.damping))
        return k, c

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Force -K x - C v.

        Parameters
        ----------
        displacement, velocity : array, shape (6,)
            Motion of `on` against `against` [m or rad, and per s].
        operation : Operation
            Speed of the system; angle and time change nothing.
        """
        if not (np.all(np.isfinite(displacement)) and np.all(np.isfinite(velocity))):
            raise InputError(f"{self.name!r}: got a motion of {displacement} and {velocity}; allowed: finite numbers")
        stiffness, damping = self.at(operation.speed)
        force = -(stiffness @ displacement) - damping @ velocity
        return Forces(force, stiffness, damping, self.beyond(operation.speed))

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers:
        """Power that the damping takes, and that the skew part of the stiffness brings in.

        Parameters
        ----------
        states, force
            Nothing, and the force that `evaluate` returned; neither is looked at.
        displacement, velocity : array, shape (6,)
            Motion of `on` against `against` [m or rad, and per s].
        operation : Operation
            Speed of the system; angle and time change nothing.
        """
        stiffness, damping = self.at(operation.speed)
        skew = 0.5 * (stiffness - stiffness.T)
        return Powers(float(velocity @ damping @ velocity), -float(velocity @ skew @ displacement))

    def stored(self, states: Any, displacement: FloatArray, operation: Operation) -> float:
        """Energy of the symmetric part of the stiffness [J].

        Parameters
        ----------
        states
            States of the element; there are none.
        displacement : array, shape (6,)
            Displacement of `on` against `against` [m or rad].
        operation : Operation
            Speed of the system; angle and time change nothing.
        """
        return 0.5 * float(displacement @ self.at(operation.speed)[0] @ displacement)

    def brought_by_speed(self, displacements: FloatArray, operations: Sequence[Operation]) -> float:
        """Energy that comes in as the stiffness changes with the speed, by the trapezoidal rule [J]."""
        if self.speeds.size == 1 or len(operations) < 2:
            return 0.0
        total = 0.0
        for (x, here), (y, there) in pairwise(zip(displacements, operations, strict=True)):
            if here.speed != there.speed:
                change = self.at(there.speed)[0] - self.at(here.speed)[0]
                total += 0.25 * float(x @ change @ x + y @ change @ y)
        return total
