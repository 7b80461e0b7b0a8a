"""Films with memory in time: springs in series with dampers beside the law of rest, at every contact of a bearing.

A contact at rest, a point or a slice of a line, has the load p(approach). Beside it act springs in series with dampers,
of stiffness K_r = c_r/theta_r each, whose forces f_r are its states:

    f_r' = K_r approach' - f_r/theta_r,        f = sum f_r,
    load = p + f where f >= 0,        load = f + sqrt(f^2 + p^2) where films are pulled.

So a load is never a tension, and rises with the approach. Small oscillations see k and c over frequency as linear
analyses have them: points have the three springs of `mbs.bearings.balls.response`, lines one, whose time is that of
`mbs.bearings.slices_in_balance`. Over a step in which the approach goes evenly the solution is exact: p gets a constant
force and a spring, no more, so that the balance of a rolling element stays that of a convex potential. K and theta are
read from tables over the approach with the rows of the laws, see `ehdmaps/kernel/c/pair/pair_memory.c`.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, numbers
from mbs.bearings.locating.normal_law import PairLaw

PULL, SPRING, AT, TIME, HEAD = range(5)
"""Rows of the memory of a contact: the force [N] and the spring [N/m] that it holds over a step, by the approach beyond
`AT` [m], and the longest of its times [s]."""

LEFT, OVER, FORCE, STIFFNESS, EACH = range(5)
"""Rows that follow for each of its springs: the part of f that is left after the step and the spring of its end, f [N]
and K [N/m] at its beginning."""


def rows_of(springs: int) -> int:
    """Count the rows of the memory of a contact with so many springs."""
    return HEAD + EACH * springs


class Springs(Record):
    """Springs of films with memory at the rows of the tables of a law: `ehd_pair_springs`.

    Attributes
    ----------
    count : int
        Springs of a contact.
    shorter : array (count,)
        Their times over the longest.
    inner, outer, inner_other, outer_other : array (rows, count + 1)
        K_r [N/m] and the longest theta [s] of both contacts; those of another speed.
    weight : float
        Part of the way to those.
    """

    _fields_ = (
        ("count", ctypes.c_int64),
        *((name, numbers) for name in ("shorter", "inner", "outer", "inner_other", "outer_other")),
        ("weight", ctypes.c_double),
    )


def springs_of(law: PairLaw, shorter: Sequence[float]) -> Springs:
    """Springs of a law at one speed, as C takes them.

    Parameters
    ----------
    law : PairLaw
        The law.
    shorter : sequence of float
        Times of the springs of a contact over the longest.
    """
    inner, outer = law.springs
    of_law = {"inner": inner, "outer": outer, "inner_other": inner, "outer_other": outer}
    return checked(Springs, "ehd_pair_springs")(count=len(shorter), shorter=np.array(shorter), **of_law)


def no_memory(contacts: tuple[int, int, int], springs: int) -> FloatArray:
    """Memory of contacts that have none yet, (Z, 2, rows, n).

    Parameters
    ----------
    contacts : (int, int, int)
        Z, 2, and slices n of a contact, 1 of points.
    springs : int
        Springs of each.
    """
    *elements, slices = contacts
    found = np.zeros((*elements, rows_of(springs), slices))
    found[:, :, TIME] = 1.0
    return found


@functools.cache
def _hold() -> Callable[..., None]:
    """Numbers that contacts hold over a step, by C."""
    count, place = ctypes.c_int64, ctypes.c_void_p
    return function("ehd_pair_hold", count, count, count, place, ctypes.c_double, place, result=None)


@dataclass(frozen=True, eq=False)
class FilmsInTime:
    """Films of a bearing after a step.

    Attributes
    ----------
    memory : array (Z, 2, rows, n)
        Memory of all contacts, inner and outer; see the rows of this module.
    """

    memory: FloatArray

    @classmethod
    def at_rest(cls, force: Any) -> FilmsInTime:
        """Films that have not moved, at the last call of a force.

        Parameters
        ----------
        force : LocatingForce
            The force.
        """
        return cls(no_memory(force.contacts, len(force.shorter)))._gone_on(force)

    @property
    def stored(self) -> float:
        """Energy of the springs of all contacts [J]."""
        force, stiffness = self.memory[:, :, HEAD + FORCE :: EACH], self.memory[:, :, HEAD + STIFFNESS :: EACH]
        return float(np.sum(0.5 * force**2 / np.where(stiffness > 0.0, stiffness, np.inf)))

    def held(self, step: float, shorter: Sequence[float]) -> FloatArray:
        """Memory with what contacts hold over a step, as `LocatingForce.held` takes it.

        Parameters
        ----------
        step : float
            Length of the step [s].
        shorter : sequence of float
            Times of the springs of a contact over the longest.
        """
        memory, times = self.memory.copy(), np.array(shorter)
        count, sides, _, slices = memory.shape
        _hold()(count * sides, slices, times.size, times.ctypes.data, step, memory.ctypes.data)
        return memory

    def after(self, step: float, force: Any) -> FilmsInTime:
        """Films after a step.

        Parameters
        ----------
        step : float
            Length of the step [s].
        force : LocatingForce
            The force with the films of its end, at its last call.
        """
        return FilmsInTime(self.held(step, force.shorter))._gone_on(force)

    def _gone_on(self, force: Any) -> FilmsInTime:
        """Bring the memory, which is its own, to the end of a step."""
        force.go_on(self.memory)
        return self
