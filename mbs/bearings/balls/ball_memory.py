"""Films of balls that have a memory in time: springs in series with dampers beside the law of rest, step by step.

A contact at rest has the load p(approach). Beside it act the springs of `mbs.bearings.balls.response`, of stiffness
K_r = c_r/theta_r each, whose forces f_r are its states:

    f_r' = K_r approach' - f_r/theta_r,        f = sum f_r,
    load = p + f where f >= 0,        load = f + sqrt(f^2 + p^2) where films are pulled.

So a load is never a tension, and rises with the approach. Small oscillations see k and c over frequency as linear
analyses have them. Over a step in which the approach goes evenly the solution is exact, see
`mbs.bearings.balls.spring_damper`: p gets a constant force and a spring, no more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import in_python, njit
from ehdmaps.copies import put
from mbs.bearings.balls.laws import BallLaw
from mbs.bearings.balls.normal_law import HELD, contact
from mbs.bearings.balls.response import SHORTER
from mbs.bearings.balls.spring_damper import gone_on, over_step

SPRINGS = len(SHORTER)
"""Springs of a contact."""


@njit(error_model="numpy", _nrt=False, forceinline=True)
def hold(
    step: float, approach: float, springs: FloatArray, forces: FloatArray, passed: FloatArray, held: FloatArray
) -> None:
    """Write what a contact holds against an approach over a step.

    Parameters
    ----------
    step : float
        Length of the step [s], >= 0.
    approach : float
        Approach at its beginning [m].
    springs : array (SPRINGS + 1,)
        K_r [N/m], and the longest of their times [s].
    forces : array (SPRINGS,)
        f_r at its beginning [N].
    passed : array (SPRINGS, 2)
        Part of f_r that is left, and its spring of the end of the step [N/m]; written.
    held : array (3,)
        Force [N] at the approach held[2] [m], and spring held[1] [N/m] of the end of the step; written.
    """
    held[0], held[1], held[2] = 0.0, 0.0, approach
    for r in range(SPRINGS):
        passed[r, 0], passed[r, 1] = over_step(step, springs[r], springs[SPRINGS] * SHORTER[r])
        held[0] += passed[r, 0] * forces[r]
        held[1] += passed[r, 1]


@njit(error_model="numpy", _nrt=False, forceinline=True)
def go_on(moved: float, springs: FloatArray, after: FloatArray, passed: FloatArray, forces: FloatArray) -> None:
    """Bring the forces to the end of a step, and to the springs there.

    Parameters
    ----------
    moved : float
        Change of the approach [m].
    springs, after : array (SPRINGS + 1,)
        The same as of `hold`, at the beginning and at the end; the first gets the numbers of the second.
    passed : array (SPRINGS, 2)
        What `hold` wrote.
    forces : array (SPRINGS,)
        f_r [N]; written.
    """
    for r in range(SPRINGS):
        forces[r] = gone_on(forces[r], passed[r, 0], passed[r, 1] * moved, springs[r], after[r])
    put(after, springs)


@dataclass(frozen=True, eq=False)
class FilmsOfBalls:
    """Films of a bearing after a step.

    Attributes
    ----------
    forces : array (Z, 2, SPRINGS)
        Forces f_r of the inner and the outer contact of each ball [N].
    springs : array (Z, 2, SPRINGS + 1)
        Springs, see `hold`.
    approaches : array (Z, 2)
        Approaches [m].
    """

    forces: FloatArray
    springs: FloatArray
    approaches: FloatArray

    @classmethod
    def at_rest(cls, law: BallLaw, approaches: FloatArray) -> FilmsOfBalls:
        """Films that have not moved.

        Parameters
        ----------
        law : BallLaw
            Laws of the contacts.
        approaches : array (Z, 2)
            Approaches [m].
        """
        return cls(np.zeros((*approaches.shape, SPRINGS)), _springs(law, approaches), approaches.copy())

    def held(self, step: float) -> FloatArray:
        """Numbers that contacts hold over a step [s], (Z, 2, HELD), see `hold`."""
        return self._over(step)[1]

    def _over(self, step: float) -> tuple[FloatArray, FloatArray]:
        """Numbers that `hold` writes of all contacts."""
        shape = self.approaches.shape
        passed, held = np.zeros((*shape, SPRINGS, 2)), np.zeros((*shape, HELD))
        for at in np.ndindex(shape):
            in_python(hold)(step, self.approaches[at], self.springs[at], self.forces[at], passed[at], held[at])
        return passed, held

    def after(self, step: float, law: BallLaw, approaches: FloatArray) -> FilmsOfBalls:
        """Films after a step.

        Parameters
        ----------
        step : float
            Length of the step [s].
        law : BallLaw
            Laws of the contacts there.
        approaches : array (Z, 2)
            Approaches there [m].
        """
        forces, springs, after = self.forces.copy(), self.springs.copy(), _springs(law, approaches)
        moved, passed = approaches - self.approaches, self._over(step)[0]
        for at in np.ndindex(approaches.shape):
            in_python(go_on)(moved[at], springs[at], after[at], passed[at], forces[at])
        return FilmsOfBalls(forces, springs, approaches.copy())


def _springs(law: BallLaw, approaches: FloatArray) -> FloatArray:
    """Springs of both contacts at approaches (Z, 2), shape (Z, 2, SPRINGS + 1); without stiffness for dry contacts."""
    found = np.zeros((*approaches.shape, SPRINGS + 1))
    found[..., -1] = 1.0
    for side, (one, response) in enumerate(zip((law.inner, law.outer), law.responses, strict=False)):
        values = np.array([in_python(contact)(one, approach) for approach in approaches[:, side].tolist()])
        found[:, side] = response.in_time(values[:, 0], values[:, 2])
    return found
