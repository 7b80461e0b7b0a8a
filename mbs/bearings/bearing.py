"""A bearing as the force element sees it: geometry, clearance, profile, slices, and the motion of its rings.

Frame O sits on the outer ring, x along its axis, and does not spin. Tilts are entries of rotation matrices: Euler
angles would be singular twice a turn. Poses and spins are exact for any rotation.

With n the axis of the inner ring in O, theta_y = -n_z and theta_z = n_y. The generalised moments of the pose are
therefore forces on n, and the moment on the inner ring about its centre is n x (0, f_theta_z, -f_theta_y). The outer
ring gets the opposite force, and the opposite moment with that of the force about its own centre: the sums of forces
and of moments about any point are zero to round-off.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.hertz import LINE_LIMIT
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.surface import iso_profile

Profile = str | Callable[[FloatArray], npt.ArrayLike] | tuple[float, ...] | FloatArray

MOST_SLICES = 100_000

MOST_COUPLED = 100
"""Slices that know of their neighbours: more would be narrower than the contacts are wide."""

_PROFILES = ("iso", "straight")


@dataclass(frozen=True, eq=False)
class Bearing:
    """A cylindrical roller bearing, cut into slices.

    Attributes
    ----------
    geometry : BearingGeometry
        Raceways, rollers, and the diametral clearance P_d that is in force.
    profile : {"iso", "straight"}, callable, or array (slices,)
        Roller profile P [m] on one side: by name, as P(x) of the distance x [m] from the middle, or its values at the
        middles of the slices. A callable is called once.
    slices : int
        Number of slices of equal length of a roller. Statics want 30 or more.
    material : Material
        Material of the bearing; its density gives the rollers their centrifugal load.
    coupled : bool
        Whether the slices of a roller know of their neighbours, see `ehdmaps.kernel`; else each bears
        its load alone.
    pocket_clearance : float, optional
        Clearance of a roller in its pocket of the cage [m], > 0: rolling torques are those of rollers that films and
        pockets turn, see `mbs.bearings.roller_spin`. None for rollers that roll without slip.

    Raises
    ------
    InputError
        With every problem.

    Examples
    --------
    >>> bearing = Bearing.named("NU308", clearance=20e-6)
    >>> bearing.geometry.diametral_clearance, bearing.slices
    (2e-05, 41)
    """

    geometry: BearingGeometry
    profile: Profile = "iso"
    slices: int = 41
    material: Material = STEEL
    coupled: bool = False
    pocket_clearance: float | None = None

    def __post_init__(self) -> None:
        count = self.slices
        if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= MOST_SLICES:
            raise InputError(f"bearing, slices: got {count!r}; allowed: a whole number from 1 to {MOST_SLICES}")
        if self.coupled and count > MOST_COUPLED:
            raise InputError(f"bearing, slices: got {count} that are coupled; allowed: at most {MOST_COUPLED}")
        if self.pocket_clearance is not None and not 0.0 < self.pocket_clearance < math.inf:
            raise InputError(
                f"bearing, pocket_clearance: got {self.pocket_clearance!r} m; allowed: finite and > 0, or None"
            )
        _ = self.profile_depths

    @classmethod
    def named(cls, name: str, *, clearance: float | None = None, profile: Profile = "iso", slices: int = 41) -> Bearing:
        """A cylindrical roller bearing by its designation, of steel; its inner geometry is estimated if not known.

        Parameters
        ----------
        name : str
            Such as "NU308" or "NU308 C3".
        clearance : float, optional
            Diametral clearance P_d [m], < 0 for a preloaded bearing. If left out the middle of the class in the
            designation; zero without a class.
        profile, slices
            The same as for the class.
        """
        number = isinstance(clearance, int | float | np.floating | np.integer) and not isinstance(clearance, bool)
        if clearance is not None and not number:
            raise InputError(f"bearing, clearance: got {clearance!r}; allowed: a number of metres")
        from ehdmaps.physics.catalogue import designated  # with the tables of all catalogues

        geometry = designated(name)
        if clearance is not None:
            geometry = geometry.with_clearance(float(clearance))
        return cls(geometry, profile, slices)

    def with_slices(self, slices: int) -> Bearing:
        """The same bearing cut into another number of slices."""
        return dataclasses.replace(self, slices=slices)

    @cached_property
    def slice_positions(self) -> FloatArray:
        """Middles of the slices along the roller, (slices,) [m], from the middle of the bearing."""
        places = (np.arange(self.slices) + 0.5) / self.slices - 0.5
        return np.asarray(places * self.geometry.roller_length)

    @cached_property
    def roller_angles(self) -> FloatArray:
        """Angles of the rollers in the cage, row by row, (Z,) [rad]: those of all rows stand side by side."""
        geometry = self.geometry
        return np.tile(2.0 * math.pi * np.arange(geometry.rollers) / geometry.rollers, geometry.row_count)

    @cached_property
    def row_places(self) -> FloatArray:
        """Places of the rows of the rollers along x, (Z,) [m]."""
        geometry = self.geometry
        return np.repeat(np.array(geometry.row_places), geometry.rollers)

    @property
    def slice_length(self) -> float:
        """Length of a slice [m]."""
        return self.geometry.roller_length / self.slices

    @cached_property
    def profile_depths(self) -> FloatArray:
        """Profile P at the middles of the slices, on one side, (slices,) [m]."""
        x, geometry = self.slice_positions, self.geometry
        if isinstance(self.profile, str):
            if self.profile not in _PROFILES:
                raise InputError(
                    f"bearing, profile: got {self.profile!r}; allowed: {', '.join(_PROFILES)}, a function P(x), "
                    "or its values at the slices"
                )
            if self.profile == "straight":
                return np.zeros(self.slices)
            return iso_profile(x, geometry.roller_diameter, geometry.roller_length)
        given = self.profile(x.copy()) if callable(self.profile) else self.profile
        try:
            depths = np.array(given, dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError(f"bearing, profile: got {given!r}; allowed: real numbers [m], one a slice") from None
        if depths.shape != (self.slices,):
            raise InputError(
                f"bearing, profile: got values of shape {depths.shape}; allowed: ({self.slices},), one a slice; "
                "a function P(x) suits any number of slices"
            )
        if not np.all(np.abs(depths) < geometry.roller_diameter):
            wrong = depths[~(np.abs(depths) < geometry.roller_diameter)][0]
            raise InputError(
                f"bearing, profile: got {wrong:.6g} m; allowed: finite and smaller than the roller diameter "
                f"{geometry.roller_diameter:.6g} m; check its unit"
            )
        return depths

    @cached_property
    def coupling(self) -> FloatArray:
        """Compliances between the slices of a roller, beyond a plane law of its contacts, (slices, slices) [m2/N].

        Both contacts together, see `ehdmaps.solids.slices`: for contacts up to the static limit of bearings, with free
        end faces of the roller, raceways that go on beyond them, and bodies of the rings as deep as the roller is
        thick.
        """
        # scipy is loaded for those who want it only: scenes are read without
        from ehdmaps.solids.finite_line import FiniteLine
        from ehdmaps.solids.slices import slice_coupling

        geometry = self.geometry
        diameter = geometry.roller_diameter
        total = np.zeros((self.slices, self.slices))
        for radius in (geometry.inner_radius, geometry.outer_radius):
            line = FiniteLine(radius, geometry.roller_length, 0.5 * diameter, diameter, self.material)
            total += slice_coupling(line, self.slices, line.half_width_of(LINE_LIMIT))
        return total

    @property
    def roller_mass(self) -> float:
        """Mass of a roller, as a plain cylinder [kg]."""
        return self._mass_per_length * self.geometry.roller_length

    def cage_angle(self, inner_spin: float, outer_spin: float = 0.0) -> float:
        """Angle of the cage from the spins of the rings [rad]; the rollers roll without slip.

        phi_c = (phi_i (1 - gamma) + phi_o (1 + gamma))/2. The spins must be counted through full turns.
        The same formula gives the speed of the cage from the speeds of the rings [rad/s].

        Examples
        --------
        >>> round(Bearing.named("NU308").cage_angle(1.0), 4)
        0.3939
        """
        gamma = self.geometry.gamma
        return 0.5 * (inner_spin * (1.0 - gamma) + outer_spin * (1.0 + gamma))

    def centrifugal_load(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Centrifugal load of a roller for each metre of its length [N/m].

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].

        Examples
        --------
        At 2000 rpm of the inner ring:

        >>> round(Bearing.named("NU308").centrifugal_load(2000.0 * math.pi / 30.0), 1)
        271.5
        """
        cage_speed = self.cage_angle(inner_speed, outer_speed)
        return self._mass_per_length * 0.5 * self.geometry.pitch_diameter * cage_speed**2

    @property
    def _mass_per_length(self) -> float:
        return self.material.density * math.pi / 4.0 * self.geometry.roller_diameter**2


_ROTATION_ERROR = 1e-6


@dataclass(frozen=True, eq=False)
class RingState:
    """Position and motion of a ring, all in the inertial frame.

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
        problems = Problems()
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
        problems.check()

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


PoseForce = Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray, FloatArray]]

_EYE = np.eye(3)


@dataclass(frozen=True, eq=False)
class RingForces:
    """Forces and moments of a bearing on its rings, all in the inertial frame.

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
