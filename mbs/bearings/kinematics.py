"""Spins, cage angle and the pose of one ring in the frame of the other, exact for any rotation.

Frame O sits on the outer ring, x along its axis, and does not spin. Tilts are entries of rotation matrices: Euler
angles would be singular twice a turn.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError

_ROTATION_ERROR = 1e-6


@dataclass(frozen=True, eq=False)
class RingState:
    """Where a ring is and how it moves, all in the inertial frame.

    Attributes
    ----------
    position, velocity : array (3,)
        Position and velocity of the centre of the ring [m], [m/s].
    rotation : array (3, 3)
        Rotation from the ring's body to the inertial frame; its first column is the axis of the ring.
    angular_velocity : array (3,)
        [rad/s].

    Raises
    ------
    InputError
        For arrays of other shapes, values that are not finite, and matrices that are no rotation.
    """

    position: FloatArray
    rotation: FloatArray
    velocity: FloatArray
    angular_velocity: FloatArray

    def __post_init__(self) -> None:
        problems = []
        for name, shape in (("position", (3,)), ("rotation", (3, 3)), ("velocity", (3,)), ("angular_velocity", (3,))):
            try:
                values = np.ascontiguousarray(getattr(self, name), dtype=np.float64)
            except (TypeError, ValueError):
                problems.append(f"ring, {name}: got {getattr(self, name)!r}; allowed: real numbers of shape {shape}")
                continue
            object.__setattr__(self, name, values)
            if values.shape != shape or not np.all(np.isfinite(values)):
                problems.append(f"ring, {name}: got {values.tolist()}; allowed: finite numbers of shape {shape}")
        if not problems:
            error = float(np.max(np.abs(self.rotation @ self.rotation.T - np.eye(3))))
            if error > _ROTATION_ERROR or np.linalg.det(self.rotation) < 0.0:
                problems.append(
                    f"ring, rotation: got a matrix that is {error:.3g} from a rotation; allowed: orthonormal within "
                    f"{_ROTATION_ERROR}, right-handed; normalise it"
                )
        if problems:
            raise InputError(problems)

    @classmethod
    def at_rest(cls, position: npt.ArrayLike = (0.0, 0.0, 0.0), rotation: npt.ArrayLike | None = None) -> RingState:
        """A ring that does not move, its axis along x if no rotation is given."""
        turned = np.eye(3) if rotation is None else rotation
        return cls(
            np.asarray(position, dtype=np.float64), np.asarray(turned, dtype=np.float64), np.zeros(3), np.zeros(3)
        )


def axial_rotation(angle: float) -> FloatArray:
    """Rotation matrix (3, 3) about x by an angle [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def spin(rotation: FloatArray, near: float = 0.0) -> float:
    """Angle by which a rotation turns about its own axis x [rad], on the turn that is nearest to `near`.

    atan2(A21 - A12, A11 + A22): what remains of the rotation when its tilt is taken out by the shortest way.

    Parameters
    ----------
    rotation : array (3, 3)
        Such as of the inner ring in O.
    near : float
        The last spin [rad]: call it more often than each half turn.

    Examples
    --------
    >>> round(spin(axial_rotation(7.0), near=6.5), 6)
    7.0
    """
    angle = math.atan2(rotation[2, 1] - rotation[1, 2], rotation[1, 1] + rotation[2, 2])
    return angle + 2.0 * math.pi * round((near - angle) / (2.0 * math.pi))


def relative_motion(
    inner: RingState, outer: RingState, outer_spin: float = 0.0, outer_spin_rate: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Pose of the inner ring in O and its rate, each (6,), as `BearingForce` takes them.

    theta_y = -A20 and theta_z = A10, A the rotation of the inner ring in O. theta_x is left at zero: spins are given
    apart.

    Parameters
    ----------
    inner, outer : RingState
        The rings.
    outer_spin, outer_spin_rate : float
        How far O lags behind the body of the outer ring about its axis [rad], [rad/s].
    """
    frame = outer.rotation @ axial_rotation(-outer_spin)
    turning = frame.T @ outer.angular_velocity - np.array([outer_spin_rate, 0.0, 0.0])
    place = frame.T @ (inner.position - outer.position)
    axis = frame.T @ inner.rotation[:, 0]
    velocity = frame.T @ (inner.velocity - outer.velocity) - np.cross(turning, place)
    axis_rate = np.cross(frame.T @ inner.angular_velocity - turning, axis)
    pose = np.array([*place, 0.0, -axis[2], axis[1]])
    return pose, np.array([*velocity, 0.0, -axis_rate[2], axis_rate[1]])
