"""Films of tapered rollers that have a memory in time: a spring in series with a damper in each slice of both lines.

A slice at rest has the load p(approach). Beside it acts a spring K = c/theta in series with a damper, whose force f is
its state, as at the contacts of balls, `mbs.bearings.balls.ball_memory`: the load is p + f, and where f pulls it is
f + sqrt(f^2 + p^2), never a tension. c is the damping of slow motion and theta the relaxation time of
`mbs.bearings.roller_contacts`: small oscillations are those of linear analyses, `tapered_relaxing`. Over a step f is
exact by `mbs.bearings.balls.spring_damper`, so that the balance of a roller stays that of a convex potential.

K and theta are read from tables over the approach with the rows of the laws, straight between them; beyond the ends K
stays, and theta follows c.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.lines import FAST
from mbs.bearings.balls.normal_law import NormalLaw
from mbs.bearings.balls.spring_damper import gone_on, over_step
from mbs.bearings.tapered.kernel_structs import MEMORY, LineSprings, functions
from mbs.bearings.tapered.line_kernel import AT, PULL, SPRING, cell_of_place, find_places
from mbs.bearings.tapered.tapered_kernel import RollerLaws, TaperedShape

if TYPE_CHECKING:
    from mbs.bearings.tapered.tapered_bearing import TaperedForce

LEFT, FORCE, STIFFNESS, TIME = range(3, MEMORY)
"""Rows of the memory of the slices of a line beside those of `mbs.bearings.tapered.line_kernel`."""


class SpringTables(NamedTuple):
    """K and theta of both lines over the rows of their tables, at two speeds.

    Attributes
    ----------
    cone, cone_other, cup, cup_other : array (rows, 2)
        K [N/m] and theta [s] of a whole roller.
    weight : float
        Weight of the other speed.
    """

    cone: FloatArray
    cone_other: FloatArray
    cup: FloatArray
    cup_other: FloatArray
    weight: float


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def _hold_line(step: float, memory: FloatArray) -> None:
    """Write what the slices of a line hold over a step."""
    pull, spring, left = memory[PULL], memory[SPRING], memory[LEFT]
    force, stiffness, time = memory[FORCE], memory[STIFFNESS], memory[TIME]
    for i in range(force.size):
        left[i], spring[i] = over_step(step, stiffness[i], time[i])
        pull[i] = left[i] * force[i]


@njit(error_model="numpy", _nrt=False)
def hold_rollers(step: float, count: int, memory: FloatArray) -> None:
    """Write what all slices hold over a step.

    Parameters
    ----------
    step : float
        Length of the step [s], >= 0.
    count : int
        How many rollers there are.
    memory : array (Z, 2, MEMORY, n)
        Memory of the slices of cone and cup.
    """
    for j in range(count):
        for side in range(2):
            _hold_line(step, memory[j, side])


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def _move_line(
    law: NormalLaw, approach: float, turn: float, levers: FloatArray, profile: FloatArray, memory: FloatArray
) -> None:
    """Bring f and approaches of a line to the end of a step, and write places on the table into `PULL`."""
    spring, at, left, force = memory[SPRING], memory[AT], memory[LEFT], memory[FORCE]
    for i in range(levers.size):
        g = approach + turn * levers[i] - profile[i]
        force[i] = left[i] * force[i] + spring[i] * (g - at[i])
        at[i] = g
    find_places(law, approach, turn, levers, profile, memory[PULL])


@njit(error_model="numpy", _nrt=False)
def _read_line(law: NormalLaw, slow: FloatArray, fast: FloatArray, weight: float, memory: FloatArray) -> None:
    """Read K and theta at the places in `PULL`, and let f follow K."""
    last, zero, one = law.table.shape[0] - 1, np.uint64(0), np.uint64(1)
    for i in range(memory.shape[1]):
        if last < 1:
            memory[FORCE, i], memory[STIFFNESS, i], memory[TIME, i] = 0.0, 0.0, 1.0
            continue
        place, c_follows = memory[PULL, i], 1.0
        if place < 0.0:
            c_follows, place = math.exp(law.table[0, 3] * place), 0.0
        elif place > last:
            c_follows, place = math.exp(law.table[last, 3] * (place - last)), float(last)
        cell, t = cell_of_place(place, last - 1.0)
        k = slow[cell, zero] + t * (slow[cell + one, zero] - slow[cell, zero])
        time = slow[cell, one] + t * (slow[cell + one, one] - slow[cell, one])
        if weight > 0.0:
            other = fast[cell, zero] + t * (fast[cell + one, zero] - fast[cell, zero])
            k += weight * (other - k)
            other = fast[cell, one] + t * (fast[cell + one, one] - fast[cell, one])
            time += weight * (other - time)
        memory[FORCE, i] = gone_on(memory[FORCE, i], 1.0, 0.0, memory[STIFFNESS, i], k)
        memory[STIFFNESS, i], memory[TIME, i] = k, max(c_follows * time, _SHORTEST)


_SHORTEST = 1e-30
"""Shortest theta [s]: below any step."""


@njit(error_model="numpy", _nrt=False)
def go_on_rollers(
    rollers: FloatArray, shape: TaperedShape, laws: RollerLaws, springs: SpringTables, memory: FloatArray
) -> None:
    """Bring the memory of all slices to the end of a step, and to K and theta there.

    Parameters
    ----------
    rollers : array (Z, 28)
        What `place_roller` wrote of each roller at the end of the step.
    shape, laws : TaperedShape, RollerLaws
        Lengths, and laws of the contacts.
    springs : SpringTables
        K and theta.
    memory : array (Z, 2, MEMORY, n)
        Memory of the slices of cone and cup, with what they held; written.
    """
    for j in range(shape.cos.size):
        v, d = rollers[j, 9:12], rollers[j, 12:15]
        x, r, turn = d[0] - v[0], d[1] - v[1], d[2] - v[2]
        cone, cup = memory[j, 0], memory[j, 1]
        _move_line(
            laws.cone_film, shape.cone[0] * x + shape.cone[1] * r, turn, shape.levers, shape.profile, cone
        )  # fmt: skip
        _move_line(
            laws.cup_film, shape.cup[0] * v[0] + shape.cup[1] * v[1], v[2], shape.levers, shape.profile, cup
        )  # fmt: skip
        _read_line(laws.cone_film, springs.cone, springs.cone_other, springs.weight, cone)
        _read_line(laws.cup_film, springs.cup, springs.cup_other, springs.weight, cup)


def no_memory(rollers: int, slices: int) -> FloatArray:
    """Memory of slices that have none yet, (Z, 2, MEMORY, n)."""
    found = np.zeros((rollers, 2, MEMORY, slices))
    found[:, :, TIME] = 1.0
    return found


@dataclass(frozen=True, eq=False)
class FilmsOfRollers:
    """Films of a bearing after a step.

    Attributes
    ----------
    memory : array (Z, 2, MEMORY, n)
        Memory of the slices of cone and cup of each roller.
    """

    memory: FloatArray

    @classmethod
    def at_rest(cls, force: TaperedForce) -> FilmsOfRollers:
        """Films that have not moved, at the pose of the last call of a force.

        Parameters
        ----------
        force : TaperedForce
            The force.
        """
        return cls(no_memory(force.angles.size, force.positions.size))._gone_on(force)

    def held(self, step: float) -> FloatArray:
        """Memory with what the slices hold over a step [s]."""
        memory = self.memory.copy()
        count, _, _, slices = memory.shape
        functions().hold(count, slices, step, memory.ctypes.data)
        return memory

    def after(self, step: float, force: TaperedForce) -> FilmsOfRollers:
        """Films after a step.

        Parameters
        ----------
        step : float
            Length of the step [s].
        force : TaperedForce
            The force with the films of its end, at the pose of its last call.
        """
        return FilmsOfRollers(self.held(step))._gone_on(force)

    def _gone_on(self, force: TaperedForce) -> FilmsOfRollers:
        """Bring the memory, which is its own, to the end of a step."""
        cone, cup = force.films.springs
        springs = LineSprings(cone=cone, cup=cup, cone_other=cone, cup_other=cup)
        force.go_on(springs, self.memory)
        return self
