"""Forces and moments of a bearing on both its rings, wherever they are in space, with exact derivatives.

With n the axis of the inner ring in O, theta_y = -n_z and theta_z = n_y. The generalised moments of the pose are
therefore forces on n, and the moment on the inner ring about its centre is n x (0, f_theta_z, -f_theta_y). The outer
ring gets the opposite force, and the opposite moment with that of the force about its own centre: the sums of forces
and of moments about any point are zero to round-off.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.kinematics import RingState, axial_rotation, relative_motion

PoseForce = Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray, FloatArray]]

_EYE = np.eye(3)


@dataclass(frozen=True, eq=False)
class RingForces:
    """What a bearing does to its rings, all in the inertial frame.

    Attributes
    ----------
    inner_force, outer_force : array (3,)
        [N].
    inner_moment, outer_moment : array (3,)
        Moments about the centre of each ring [N m].
    stiffness, damping : array (12, 12)
        Minus the derivatives of (inner force, inner moment, outer force, outer moment) by small displacements and
        rotations (inner position, inner rotation vector, outer position, outer rotation vector), and by velocities and
        angular velocities. Rotation vectors are of the inertial frame, R -> exp(theta) R. Velocities, cage angle,
        speeds and temperature are held in the first, spins in both: O turns with the outer ring.
    """

    inner_force: FloatArray
    inner_moment: FloatArray
    outer_force: FloatArray
    outer_moment: FloatArray
    stiffness: FloatArray
    damping: FloatArray

    @property
    def vector(self) -> FloatArray:
        """Forces and moments in the order of the matrices, (12,)."""
        return np.concatenate((self.inner_force, self.inner_moment, self.outer_force, self.outer_moment))


def ring_forces(
    force: PoseForce, inner: RingState, outer: RingState, outer_spin: float = 0.0, outer_spin_rate: float = 0.0
) -> RingForces:
    """Bring the force on the inner ring in O to both rings.

    Parameters
    ----------
    force : callable
        (pose, velocity) -> (f, K, C), a `BearingForce` with all else held.
    inner, outer : RingState
        The rings.
    outer_spin, outer_spin_rate : float
        The same as for `relative_motion`.
    """
    pose, rate = relative_motion(inner, outer, outer_spin, outer_spin_rate)
    f, K, C = force(pose, rate)
    frame = outer.rotation @ axial_rotation(-outer_spin)

    # All in components of O.
    place = pose[:3]
    axis = frame.T @ inner.rotation[:, 0]
    outer_turning = frame.T @ outer.angular_velocity
    turning = outer_turning - np.array([outer_spin_rate, 0.0, 0.0])
    inner_turning = frame.T @ inner.angular_velocity
    apart = frame.T @ (inner.velocity - outer.velocity)
    push = f[:3]
    pull = np.array([0.0, f[5], -f[4]])
    inner_moment = np.cross(axis, pull)
    outer_moment = -inner_moment - np.cross(place, push)

    # Derivatives by (inner position, inner rotation, outer position, outer rotation).
    d_place = np.hstack((_EYE, np.zeros((3, 3)), -_EYE, _skew(place)))
    d_axis = np.hstack((np.zeros((3, 3)), -_skew(axis), np.zeros((3, 3)), _skew(axis)))
    by_outer = np.zeros((3, 12))
    by_outer[:, 9:] = _EYE
    d_velocity = (_skew(apart) + _skew(place) @ _skew(outer_turning)) @ by_outer - _skew(turning) @ d_place
    d_relative = (_skew(inner_turning) - _skew(outer_turning)) @ by_outer
    d_axis_rate = _skew(inner_turning - turning) @ d_axis - _skew(axis) @ d_relative
    d_pose, d_rate = _pose_rows(d_place, d_axis), _pose_rows(d_velocity, d_axis_rate)

    by_position = -K @ d_pose - C @ d_rate
    by_velocity = -C @ d_pose
    stiffness, damping = (
        -_ring_rows(change, d_axis * moved, d_place * moved, by_outer * moved, axis, place, push, pull)
        for change, moved in ((by_position, 1.0), (by_velocity, 0.0))
    )
    turn = np.kron(np.eye(4), frame)
    return RingForces(
        inner_force=frame @ push,
        inner_moment=frame @ inner_moment,
        outer_force=-(frame @ push),
        outer_moment=frame @ outer_moment,
        stiffness=turn @ stiffness @ turn.T,
        damping=turn @ damping @ turn.T,
    )


def _ring_rows(
    change: FloatArray,
    d_axis: FloatArray,
    d_place: FloatArray,
    turned: FloatArray,
    axis: FloatArray,
    place: FloatArray,
    push: FloatArray,
    pull: FloatArray,
) -> FloatArray:
    """Derivatives (12, 12) of the forces and moments on both rings, in components of O, from those (6, 12) of f."""
    inner_moment = np.cross(axis, pull)
    # O itself turns with the outer ring, and the vectors with it.
    d_push = change[:3] - _skew(push) @ turned
    d_pull = np.vstack((np.zeros(12), change[5], -change[4]))
    d_inner = _skew(axis) @ d_pull - _skew(pull) @ d_axis - _skew(inner_moment) @ turned
    d_apart = d_place - _skew(place) @ turned  # the vector from ring to ring, seen from outside
    d_outer = -d_inner + _skew(push) @ d_apart - _skew(place) @ d_push
    return np.vstack((d_push, d_inner, -d_push, d_outer))


def _pose_rows(d_place: FloatArray, d_axis: FloatArray) -> FloatArray:
    """Derivatives (6, 12) of a pose."""
    return np.vstack((d_place, np.zeros(12), -d_axis[2], d_axis[1]))


def _skew(a: FloatArray) -> FloatArray:
    """Matrix (3, 3) of the cross product a x b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])
