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
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.errors import InputError
from mbs.model.blocks import FOUND, Answers, Kind, Member, Moment, SteadyBlock
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
        problems = []
        if self.speeds.ndim != 1 or not 1 <= count <= MOST_SPEEDS or np.any(np.diff(self.speeds) <= 0.0):
            problems.append(f"{self.name!r}, speeds: got {count}; allowed: 1 to {MOST_SPEEDS}, each above the last")
        problems += [
            f"{self.name!r}, {name}: got the shape {getattr(self, name).shape}; allowed: {(count, 6, 6)}"
            for name in ("stiffness", "damping")
            if getattr(self, name).shape != (count, 6, 6)
        ]
        if not all(np.all(np.isfinite(getattr(self, name))) for name in ("speeds", "stiffness", "damping")):
            problems.append(f"{self.name!r}: got numbers that are not finite; allowed: finite ones")
        if problems:
            raise InputError(problems)

    @cached_property
    def ports(self) -> tuple[Port, ...]:
        """The displacement of one place against the other."""
        return (Port(self.on, self.against),)

    def beyond(self, speed: float) -> bool:
        """Whether a speed [rad/s] lies beyond the table, where its end holds."""
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
        stiffness, damping = self.at(operation.speed)
        force = -(stiffness @ displacement) - damping @ velocity
        return Forces(force, stiffness, damping, self.beyond(operation.speed))

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers:
        """What the damping takes, and what the skew part of the stiffness brings in.

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


class Matrices(NamedTuple):
    """Connections by matrices as arrays.

    Attributes
    ----------
    firsts, places, counts : array (elements,), of int
        First of what each feels, its place among all elements, and the number of its speeds.
    speeds : array (elements, speeds)
        Speeds of the tables [rad/s].
    tables : array (elements, speeds, 2, 6, 6)
        Stiffness and damping.
    """

    firsts: IntArray
    places: IntArray
    counts: IntArray
    speeds: FloatArray
    tables: FloatArray


@njit(error_model="numpy")
def _at(matrices: Matrices, e: int, speed: float, out: FloatArray) -> bool:
    """Write stiffness and damping of an element at a speed; whether that lies beyond its table."""
    count, speeds, tables = matrices.counts[e], matrices.speeds[e], matrices.tables[e]
    low = 0
    while low + 2 < count and speeds[low + 1] < speed:
        low += 1
    high = min(low + 1, count - 1)
    part = 0.0
    if high > low:
        part = min(max((speed - speeds[low]) / (speeds[high] - speeds[low]), 0.0), 1.0)
    for m in range(2):
        for i in range(6):
            for j in range(6):
                begin = tables[low, m, i, j]
                out[m, i, j] = begin + part * (tables[high, m, i, j] - begin)
    return bool(count > 1 and (speed < speeds[0] or speed > speeds[count - 1]))


@njit(error_model="numpy")
def matrices_answer(matrices: Matrices, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and slopes of all connections; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    matrices : Matrices
        The connections.
    moment : Moment
        Speed and weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    both = np.empty((2, 6, 6))
    for e in range(matrices.firsts.size):
        first = matrices.firsts[e]
        if _at(matrices, e, moment.speed, both):
            answers.outside[matrices.places[e]] += 1
        for i in range(6):
            total = 0.0
            for j in range(6):
                k, c = both[0, i, j], both[1, i, j]
                total -= k * motion[0, first + j] + c * motion[1, first + j]
                answers.slopes[first + i, first + j] = moment.by_q * k + moment.by_v * c
            answers.force[first + i] = total
    return FOUND


@njit(error_model="numpy")
def matrices_powers(matrices: Matrices, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray) -> None:
    """What dampings take, and what skew stiffnesses bring in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    matrices, moment, motion, answers
        The same as of `matrices_answer`.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    both = np.empty((2, 6, 6))
    for e in range(matrices.firsts.size):
        first, place = matrices.firsts[e], matrices.places[e]
        _at(matrices, e, moment.speed, both)
        lost = driven = 0.0
        for i in range(6):
            for j in range(6):
                lost += motion[1, first + i] * both[1, i, j] * motion[1, first + j]
                driven -= motion[1, first + i] * 0.5 * (both[0, i, j] - both[0, j, i]) * motion[0, first + j]
        out[place, 0], out[place, 1] = lost, driven


def _gather(members: Sequence[Member]) -> SteadyBlock:
    """Arrays of some connections; tables as long as the longest."""
    elements: list[MatrixElement] = [member.element for member in members]
    longest = max((element.speeds.size for element in elements), default=1)
    speeds, tables = np.zeros((len(elements), longest)), np.zeros((len(elements), longest, 2, 6, 6))
    for index, element in enumerate(elements):
        count = element.speeds.size
        speeds[index, :count] = element.speeds
        tables[index, :count, 0], tables[index, :count, 1] = element.stiffness, element.damping
    firsts, places = (np.array([getattr(m, key) for m in members], dtype=np.int64) for key in ("first", "place"))
    counts = np.array([element.speeds.size for element in elements], dtype=np.int64)
    return SteadyBlock(Matrices(firsts, places, counts, speeds, tables))


def _all_six(element: MatrixElement) -> FloatArray:
    """All displacements of the port."""
    return np.eye(6)


MATRICES = Kind(
    arrays=Matrices, answer=matrices_answer, feels=_all_six, gather=_gather, powers=matrices_powers, rare=True
)
"""For `mbs.transient.kinds`."""
