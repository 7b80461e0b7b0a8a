"""The bearing force in time at one speed and temperature: films need time to follow, and each slice has a state."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.kernel import LOAD_TOLERANCE
from mbs.bearings.bearing_kernel import assemble_arrays
from mbs.bearings.force_at_point import Arrays, raise_state, six_numbers
from mbs.bearings.roller_motion import NOT_FINITE, approaches_of_arrays
from mbs.model.elements import Forces

if TYPE_CHECKING:
    from ehdmaps.maps.law import LawAtPoint
    from ehdmaps.maps.memory import FilmState


class ForceInTime:
    """A `BearingForce` at one speed, temperature and centrifugal load, whose films go from step to step.

    Parameters
    ----------
    law : LawAtPoint
        Law of a roller between both raceways, of a map or by formula.
    arrays : Arrays
        Constants of the bearing, and work space.
    """

    def __init__(self, law: LawAtPoint, arrays: Arrays) -> None:
        self.law = law
        self._state, self._states = np.zeros(13), np.zeros_like(arrays.states)
        self._sizes, self._shape = arrays.sizes, (np.array(arrays.sizes), arrays.slices, arrays.angles)

    def settled(self, pose: npt.ArrayLike, cage_angle: float = 0.0) -> FilmState:
        """Films in equilibrium at a pose, shape (Z, n).

        Parameters
        ----------
        pose : array (6,)
            Pose of the inner ring in O [m], [rad].
        cage_angle : float
            Angle of the first roller [rad].
        """
        return self.law.memory.settled(self._approaches(pose, cage_angle))

    def advance(
        self, state: FilmState | None, pose: npt.ArrayLike, dt: float, cage_angle: float = 0.0
    ) -> tuple[Forces, FilmState]:
        """A step in time; see `BearingForce.advance`.

        Parameters
        ----------
        state : FilmState or None
            Films at the beginning of the step; None for films in equilibrium at `pose`.
        pose : array (6,)
            Pose of the inner ring at its end [m], [rad].
        dt : float
            Length of the step [s].
        cage_angle : float
            Angle of the first roller at its end [rad].
        """
        memory, approaches = self.law.memory, self._approaches(pose, cage_angle)
        before = memory.settled(approaches) if state is None else state
        self._states[0], self._states[1], after = memory.advance(before, approaches, dt)
        out = np.empty((13, 6))
        assemble_arrays(self._state, *self._shape, self._states, out)
        above = float(np.max(self._states[0])) > self.law.point.highest_load * (1.0 + LOAD_TOLERANCE)
        return Forces(out[0], out[1:7], out[7:], self.law.outside or above), after

    def _approaches(self, pose: npt.ArrayLike, cage_angle: float) -> FloatArray:
        """Approach of all slices (Z, n) [m]."""
        self._state[:6], self._state[12] = six_numbers("pose", pose), cage_angle
        approaches = np.empty(self._states.shape[1:])
        wrong = approaches_of_arrays(self._state, *self._shape, approaches)
        if wrong != 0:
            raise_state(self._state, self._sizes, wrong == NOT_FINITE)
        return approaches
