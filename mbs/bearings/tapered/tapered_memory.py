"""Films of tapered rollers that have a memory in time: a spring in series with a damper in each slice of both lines.

A slice at rest has the load p(approach). Beside it acts a spring K = c/theta in series with a damper, whose force f is
its state, as at the contacts of balls, `mbs.bearings.balls.ball_memory`: the load is p + f, and where f pulls it is
f + sqrt(f^2 + p^2), never a tension. c is the damping of slow motion and theta the relaxation time of
`mbs.bearings.slices_in_balance`: small oscillations are those of linear analyses, `rollers_in_balance`. Over a step f
is exact, so that the balance of a roller stays that of a convex potential.

K and theta are read from tables over the approach with the rows of the laws, straight between them; beyond the ends K
stays, and theta follows c.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.tapered.kernel_structs import MEMORY, LineSprings, functions

LEFT, FORCE, STIFFNESS, TIME = range(3, MEMORY)
"""Some rows of the memory of the slices of a line: the part of f that is left after a step; f [N], K [N/m] and theta
[s] of a whole roller at its beginning. The ones before are what they hold over it."""


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
    def at_rest(cls, force: Any) -> FilmsOfRollers:
        """See `FilmsInTime.at_rest` of `mbs.bearings.locating.locating_force`."""
        return cls(no_memory(force.angles.size, force.positions.size))._gone_on(force)

    def held(self, step: float) -> FloatArray:
        """Memory with what the slices hold over a step [s]."""
        memory = self.memory.copy()
        count, _, _, slices = memory.shape
        functions().hold(count, slices, step, memory.ctypes.data)
        return memory

    def after(self, step: float, force: Any) -> FilmsOfRollers:
        """See `FilmsInTime.after`."""
        return FilmsOfRollers(self.held(step))._gone_on(force)

    def _gone_on(self, force: Any) -> FilmsOfRollers:
        """Bring the memory, which is its own, to the end of a step."""
        cone, cup = force.films.springs
        springs = LineSprings(cone=cone, cup=cup, cone_other=cone, cup_other=cup)
        force.go_on(springs, self.memory)
        return self
