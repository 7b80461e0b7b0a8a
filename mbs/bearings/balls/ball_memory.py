"""Films of balls that have a memory in time: springs in series with dampers beside the law of rest, step by step.

A contact at rest has the load p(approach). Beside it act the springs of `mbs.bearings.balls.response`, of stiffness
K_r = c_r/theta_r each, whose forces f_r are its states:

    f_r' = K_r approach' - f_r/theta_r,        f = sum f_r,
    load = p + f where f >= 0,        load = f + sqrt(f^2 + p^2) where films are pulled.

So a load is never a tension, and rises with the approach. Small oscillations see k and c over frequency as linear
analyses have them. Over a step in which the approach goes evenly the solution is exact, see
`ehdmaps/kernel/c/pair/pair_memory.c`: p gets a constant force and a spring, no more.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import function
from mbs.bearings.balls.laws import BallLaw
from mbs.bearings.balls.response import SHORTER
from mbs.bearings.locating.normal_law import HELD, contacts_at

SPRINGS = len(SHORTER)
"""Springs of a contact."""

_SHORTER = np.array(SHORTER)


@functools.cache
def _hold() -> Callable[..., None]:
    """Numbers that contacts hold over a step, by C."""
    place = ctypes.c_void_p
    return function("ehd_ball_hold", ctypes.c_int64, place, ctypes.c_double, *5 * (place,), result=None)


@functools.cache
def _go_on() -> Callable[..., None]:
    """States of contacts at the end of a step, by C."""
    return function("ehd_ball_go_on", ctypes.c_int64, *5 * (ctypes.c_void_p,), result=None)


@dataclass(frozen=True, eq=False)
class FilmsOfBalls:
    """Films of a bearing after a step.

    Attributes
    ----------
    forces : array (Z, 2, SPRINGS)
        Forces f_r of the inner and the outer contact of each ball [N].
    springs : array (Z, 2, SPRINGS + 1)
        K_r [N/m] of each contact, and the longest of their times [s].
    approaches : array (Z, 2)
        Approaches [m].
    """

    forces: FloatArray
    springs: FloatArray
    approaches: FloatArray

    @classmethod
    def at_rest(cls, force: Any) -> FilmsOfBalls:
        """See `FilmsInTime.at_rest` of `mbs.bearings.locating.locating_force`."""
        approaches = force.last_balls[:, 14:16].copy()
        return cls(np.zeros((*approaches.shape, SPRINGS)), _springs(force.law, approaches), approaches)

    def held(self, step: float) -> FloatArray:
        """Force [N], spring [N/m] and approach [m] that contacts hold over a step [s], (Z, 2, HELD)."""
        return self._over(step)[1]

    def _over(self, step: float) -> tuple[FloatArray, FloatArray]:
        """Parts of the forces that are left over a step, with the springs of its end; and what contacts hold."""
        shape = self.approaches.shape
        passed, held = np.zeros((*shape, SPRINGS, 2)), np.zeros((*shape, HELD))
        arrays = self.approaches, self.springs, self.forces, passed, held
        _hold()(self.approaches.size, _SHORTER.ctypes.data, step, *(one.ctypes.data for one in arrays))
        return passed, held

    def after(self, step: float, force: Any) -> FilmsOfBalls:
        """See `FilmsInTime.after`."""
        approaches = force.last_balls[:, 14:16].copy()
        forces, springs, after = self.forces.copy(), self.springs.copy(), _springs(force.law, approaches)
        moved, passed = approaches - self.approaches, self._over(step)[0]
        _go_on()(moved.size, *(one.ctypes.data for one in (moved, springs, after, passed, forces)))
        return FilmsOfBalls(forces, springs, approaches)


def _springs(law: BallLaw, approaches: FloatArray) -> FloatArray:
    """Springs of both contacts at approaches (Z, 2), shape (Z, 2, SPRINGS + 1); without stiffness for dry contacts."""
    found = np.zeros((*approaches.shape, SPRINGS + 1))
    found[..., -1] = 1.0
    for side, (one, response) in enumerate(zip((law.inner, law.outer), law.responses, strict=False)):
        load, _, damping = contacts_at(one, approaches[:, side])
        found[:, side] = response.in_time(load, damping)
    return found
