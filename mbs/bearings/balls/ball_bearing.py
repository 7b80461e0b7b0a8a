"""A ball bearing as a force element with five freedoms: force, stiffness and damping by the pose of its inner ring.

Frame O sits in the middle of the outer groove, x along its axis. Pose and signs are those of `mbs.bearings.bearing`:
x, y, z, and the tilts theta_y = -n_z, theta_z = n_y of the inner ring's axis n; theta_x has no force. The pose zero has
both grooves where their nominal contact angle puts them: deep groove bearings stand in their middle, so that clearance
lets them go either way; angular contact bearings just touch, without clearance.

Quasi-static: each ball is in balance at the speeds of the rings, and has no inertia against small motions beside that.
It rolls at both raceways and does not drill at the outer one, whose traction holds the whole gyroscopic moment (outer
race control), so that its speed around the axis follows its contact angles, see `mbs.bearings.balls.ball_speed`; in the
derivatives it follows, too, and speeds of the rings are held. That is slow motion. `cage_speed` holds all balls at one
speed: motion that is too fast for them to follow. The potential of dry contacts takes the arm of the inner
groove's centre for both displacement and moment; ISO/TS 16281 takes d_m/2 for moments, which is 1 % less.

References
----------
T. A. Harris, M. N. Kotzalas, Advanced Concepts of Bearing Technology, CRC, 2007, chapter 3. J. M. de Mul, J. M. Vree,
D. A. Maas, Journal of Tribology 111 (1989) 142. ISO/TS 16281.
"""

from __future__ import annotations

import ctypes
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.kernel.library import checked, function
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.solids import STEEL, Material
from mbs.bearings.balls.ball_data import (
    COLUMNS,
    NOT_FINITE,
    START,
    TOO_FAR,
    BallData,
    BallShape,
    DriveData,
    ShapeData,
)
from mbs.bearings.balls.ball_speed import Drive, ball_loads, mean_speed
from mbs.bearings.balls.laws import BallLaw
from mbs.bearings.balls.normal_law import law_data, load_approach, nothing_held
from mbs.model.elements import Excitation, Forces, OnRings, Operation, Port
from mbs.model.findings import CARRIES

FASTEST = 2e4
"""Largest accepted speed of a ring [rad/s]; 1e5 rpm is half of it."""

NEGLIGIBLE = 1e-11
"""Approach [m] of a dry contact under a centrifugal load that is left out: less than a micronewton."""

HARMONICS = 3
"""Multiples of the passing frequency of the balls that are worth following."""


@dataclass(frozen=True, eq=False)
class BallLoads:
    """State of all balls at one pose.

    Attributes
    ----------
    angle : array (Z,)
        Angles of the balls in O, from y towards z, within -pi to pi [rad].
    load : array (2, Z)
        Loads of the inner and the outer contact [N].
    contact_angle : array (2, Z)
        Contact angles of both [rad].
    approach : array (2, Z)
        Approaches of both [m]; below zero a gap, or a film.
    speed : array (Z,)
        Speeds around the axis [rad/s].
    centrifugal, traction : array (Z,)
        Centrifugal loads, and tractions at the outer raceway that hold the gyroscopic moment, with the sign of the
        contact angle [N].
    cage_speed : float
        Speed of the cage: the mean of the balls' speeds by their inner loads [rad/s].
    """

    angle: FloatArray
    load: FloatArray
    contact_angle: FloatArray
    approach: FloatArray
    speed: FloatArray
    centrifugal: FloatArray
    traction: FloatArray
    cage_speed: float

    @property
    def loaded(self) -> int:
        """Number of balls that carry more than 1 % of the highest inner load: films that hardly touch carry some."""
        return int(np.count_nonzero(self.load[0] > CARRIES * self.load[0].max()))

    @property
    def gyroscopic_traction(self) -> float:
        """Largest traction that holds a gyroscopic moment, over the load of its ball at the outer raceway.

        Of balls that carry load: films press a little on all others.
        """
        loaded = self.load[1] > CARRIES * self.load[1].max()
        return float(np.max(np.abs(self.traction[loaded]) / self.load[1][loaded], initial=0.0))

    def mean_angle(self, side: int) -> float:
        """Mean contact angle of a side, 0 the inner one, by the loads of its balls [rad]; zero without load."""
        total = float(np.sum(self.load[side]))
        return float(self.load[side] @ self.contact_angle[side]) / total if total > 0.0 else 0.0


class BallForce:
    """Force, stiffness and damping of a ball bearing.

    Parameters
    ----------
    geometry : BallGeometry
        Geometry and clearance.
    law : BallLaw
        Laws of the contacts, see `mbs.bearings.balls.laws`.
    material : Material
        Material of the balls; its density gives them mass.

    Attributes
    ----------
    drive : Drive
        Masses and sizes of the balls for `mbs.bearings.balls.ball_speed`, at rest.
    directions : (array (Z,), array (Z,))
        Directions of the balls in the cage, y and z.

    Notes
    -----
    An object is for one thread: it keeps the places of the balls as a start for the next call.
    """

    def __init__(self, geometry: BallGeometry, law: BallLaw, material: Material = STEEL) -> None:
        self.geometry, self.law, self.material = geometry, law, material
        distance, angle = geometry.groove_distance, geometry.contact_angle
        self._shape = BallShape(
            axial=distance * math.sin(angle),
            radial=geometry.radial_distance,
            arm=geometry.inner_groove_radius,
            inner_arm=(geometry.inner_conformity - 0.5) * geometry.ball_diameter,
            outer_arm=(geometry.outer_conformity - 0.5) * geometry.ball_diameter,
            most_travel=distance,
            most_tilt=distance / geometry.inner_groove_radius,
        )
        mass, diameter, pitch = geometry.ball_mass(material), geometry.ball_diameter, geometry.pitch_diameter
        self.drive = Drive(0.0, 0.0, math.nan, diameter / pitch, 0.5 * mass * pitch, 0.2 * mass * pitch)
        self._places = 2.0 * math.pi * np.arange(geometry.balls) / geometry.balls
        self.directions = np.cos(self._places), np.sin(self._places)
        self._turns = geometry.cage_speed(1.0, 0.0), geometry.cage_speed(0.0, 1.0)
        balls = geometry.balls
        self._pose, self._starts, self._balls = np.zeros(6), np.zeros((balls, START)), np.zeros((balls, COLUMNS))
        self._out = np.zeros(6), np.zeros((6, 6)), np.zeros((6, 6))
        self._rest = (0.0, 0.0)
        self._data = checked(BallData, "ehd_ball_data")(
            shape=ShapeData(**self._shape._asdict()),
            drive=DriveData(**self.drive._asdict()),
            balls=balls,
            cosine=self.directions[0],
            sine=self.directions[1],
            inner=law_data(law.inner),
            outer=law_data(law.outer),
        )
        self._held = nothing_held()
        rooms = self._pose, self._starts, self._balls, *self._out
        self._arguments = self._data.address, *(room.ctypes.data for room in rooms)
        self._force, self._angles = _functions()

    def __reduce__(self) -> tuple[Any, ...]:
        """For other processes: as it was made, without what calls left behind."""
        return BallForce, (self.geometry, self.law, self.material)

    @property
    def shape(self) -> BallShape:
        """Lengths of the bearing."""
        return self._shape

    @shape.setter
    def shape(self, shape: BallShape) -> None:
        self._shape = shape
        self._data.put(shape=ShapeData(**shape._asdict()))

    @property
    def held(self) -> FloatArray:
        """Numbers that the films of both contacts of each ball hold over a step, see `mbs.bearings.balls.ball_memory`.

        Shape (Z, 2, HELD); none, (0, 2, HELD), where they have no memory.
        """
        return self._held

    @held.setter
    def held(self, held: FloatArray) -> None:
        self._held = np.ascontiguousarray(held, dtype=np.float64)
        self._data.put(held=self._held if held.shape[0] > 0 else None)

    def speed_loads(
        self, inner_speed: float, outer_speed: float, cage_speed: float | None = None
    ) -> tuple[float, float]:
        """Centrifugal load of a ball [N], and factor G of its gyroscopic moment G sin(alpha_o) [N m].

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        cage_speed : float, optional
            Speed of the ball around the axis [rad/s]; that of the nominal contact angle if left out.

        Raises
        ------
        InputError
            For speeds that are no finite numbers, or beyond `FASTEST`.
        """
        centrifugal, traction, _, _ = ball_loads(
            self.drive_at(inner_speed=inner_speed, outer_speed=outer_speed),
            self._cage_of(inner_speed, outer_speed, cage_speed),
        )
        return float(centrifugal), 0.5 * float(traction) * self.geometry.ball_diameter

    def _cage_of(self, inner_speed: float, outer_speed: float, cage_speed: float | None) -> float:
        """Speed of the cage that is given, or of the nominal contact angle [rad/s]."""
        if not (abs(inner_speed) <= FASTEST and abs(outer_speed) <= FASTEST):
            raise InputError(
                f"ball bearing, speeds: got {inner_speed!r} and {outer_speed!r} rad/s; allowed: finite numbers, at "
                f"most {FASTEST:g} rad/s either way"
            )
        cage = inner_speed * self._turns[0] + outer_speed * self._turns[1] if cage_speed is None else cage_speed
        if not abs(cage) <= FASTEST:
            raise InputError(f"ball bearing, cage_speed: got {cage!r} rad/s; allowed: at most {FASTEST:g} rad/s")
        return float(cage)

    def __call__(
        self,
        pose: npt.ArrayLike,
        velocity: npt.ArrayLike | None = None,
        *,
        cage_angle: float = 0.0,
        inner_speed: float = 0.0,
        outer_speed: float = 0.0,
        cage_speed: float | None = None,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Force on the inner ring, and its derivatives.

        Parameters
        ----------
        pose, velocity : array (6,)
            Pose and velocity of the inner ring in O [m], [rad], [m/s], [rad/s]; at rest if there is no velocity.
            Damping is that of small velocities: the force is linear in them.
        cage_angle : float
            Angle of the first ball, from y towards z [rad].
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        cage_speed : float, optional
            Speed of a cage that holds all balls [rad/s]; each ball has its own, by its contact angles, if left out.

        Returns
        -------
        f, K, C : arrays (6,), (6, 6), (6, 6)
            Force and moments [N], [N m] in O about the centre of the inner ring, K = -df/dpose at rest,
            C = -df/dvelocity.

        Raises
        ------
        InputError
            For values that are no finite numbers, and poses or speeds beyond reason.
        AnalysisError
            Where the balance of a ball is not found.
        """
        force, stiffness, damping = self._evaluated(pose, cage_angle, inner_speed, outer_speed, cage_speed)
        force, stiffness, damping = force.copy(), stiffness.copy(), damping.copy()
        if velocity is not None:
            rate = _six(velocity, "velocity")
            if not np.all(np.isfinite(rate)):
                raise InputError(f"ball bearing, velocity: got {rate.tolist()}; allowed: finite numbers")
            force -= damping @ rate
        return force, stiffness, damping

    def balls(
        self,
        pose: npt.ArrayLike,
        *,
        cage_angle: float = 0.0,
        inner_speed: float = 0.0,
        outer_speed: float = 0.0,
        cage_speed: float | None = None,
    ) -> BallLoads:
        """Loads, contact angles and approaches of all balls; arguments and errors as of a call.

        Parameters
        ----------
        pose : array (6,)
            Pose of the inner ring in O.
        cage_angle, inner_speed, outer_speed, cage_speed : float
            Angle of the cage [rad] and speeds [rad/s], see `BallForce.__call__`.
        """
        self._evaluated(pose, cage_angle, inner_speed, outer_speed, cage_speed)
        self._angles(self.geometry.balls, self._balls.ctypes.data)
        angle = np.angle(np.exp(1j * (self._places + cage_angle)))
        rows = self._balls.T.copy()
        idle = self.geometry.cage_speed(inner_speed, outer_speed) if cage_speed is None else cage_speed
        traction = rows[24] * rows[18]
        cage = float(mean_speed(self._balls, float(idle)))
        return BallLoads(angle, rows[10:12], rows[12:14], rows[14:16], rows[22], rows[23], traction, cage)

    @property
    def last_balls(self) -> FloatArray:
        """Rows of the balls after the last call, shape (Z, COLUMNS), see `mbs.bearings.balls.ball_data`.

        Contact angles are there after `balls` alone.
        """
        return self._balls

    def drive_at(
        self,
        *,
        inner_speed: float = 0.0,
        outer_speed: float = 0.0,
        cage_speed: float | None = None,
        cage_angle: float = 0.0,
    ) -> Drive:
        """Speeds that turn the balls, with their masses.

        Parameters
        ----------
        inner_speed, outer_speed, cage_speed, cage_angle : float
            Speeds [rad/s] and angle of the cage, which changes nothing; see `BallForce.__call__`.
        """
        cage = math.nan if cage_speed is None else float(cage_speed)
        return self.drive._replace(inner=float(inner_speed), outer=float(outer_speed), cage=cage)

    def _evaluated(
        self, pose: npt.ArrayLike, cage_angle: float, inner_speed: float, outer_speed: float, cage_speed: float | None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Call the kernel; its arrays are overwritten by the next call."""
        self._pose[:] = _six(pose, "pose")
        centrifugal = self.drive.centrifugal * self._cage_of(inner_speed, outer_speed, cage_speed) ** 2
        if self._rest[0] != centrifugal:
            self._rest = centrifugal, load_approach(self.law.outer, centrifugal) if centrifugal > 0.0 else 0.0
        data, drive, rest = self._data, self._data.drive, self._rest[1]
        still = rest < NEGLIGIBLE and self.law.dry
        drive.inner, drive.outer = (0.0, 0.0) if still else (inner_speed, outer_speed)
        drive.cage = math.nan if still or cage_speed is None else cage_speed
        data.cage_angle, data.rest = cage_angle, rest
        found = self._force(*self._arguments)
        if found < 0:
            self._refuse(found, self._pose, cage_angle)
        return self._out

    def _refuse(self, found: int, pose: FloatArray, cage_angle: float) -> None:
        """Say what is wrong."""
        if found == NOT_FINITE:
            raise InputError(
                f"ball bearing, pose: got {pose.tolist()} and the cage angle {cage_angle!r}; allowed: finite numbers"
            )
        if found == TOO_FAR:
            raise InputError(
                f"ball bearing, pose: got x, y, z = {pose[0]:.6g}, {pose[1]:.6g}, {pose[2]:.6g} m, theta_y, theta_z = "
                f"{pose[4]:.6g}, {pose[5]:.6g} rad; allowed: within {self.shape.most_travel:.6g} m (the distance of "
                f"the groove centres) and {self.shape.most_tilt:.6g} rad; check units and the step of the solver"
            )
        raise AnalysisError(f"ball bearing {self.geometry.name}: no balance of a ball was found at {pose.tolist()}")


@functools.cache
def _functions() -> tuple[Callable[..., int], Callable[..., None]]:
    """Functions in C: force, stiffness and damping; contact angles."""
    place = ctypes.c_void_p
    force = function("ehd_ball_force_surely", *7 * (place,))
    return force, function("ehd_ball_angles", ctypes.c_int64, place, result=None)


def _six(values: npt.ArrayLike, name: str) -> FloatArray:
    """Six numbers."""
    try:
        array = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"ball bearing, {name}: got {values!r:.80}; allowed: six real numbers") from None
    if array.shape != (6,):
        raise InputError(f"ball bearing, {name}: got an array of shape {array.shape}; allowed: (6,)")
    return array


@dataclass(frozen=True, eq=False)
class BallElement(OnRings):
    """A ball bearing between an inner and an outer ring.

    Attributes
    ----------
    name : str
        Name for messages and results.
    inner, outer : str
        Places at the middle of the bearing.
    force : BallForce
        The force.
    inner_spin, outer_spin : float
        Speeds of the rings as multiples of the system's.
    start_angle : float
        Angle of the first ball from y at the beginning [rad].
    """

    locating: ClassVar[bool] = True
    name: str
    inner: str
    outer: str
    force: BallForce
    inner_spin: float = 1.0
    outer_spin: float = 0.0
    start_angle: float = 0.0

    @property
    def ports(self) -> tuple[Port, ...]:
        """Displacement of the inner ring against the outer one."""
        return (Port(self.inner, self.outer),)

    @property
    def excitation(self) -> Excitation | None:
        """The passing of the balls; None for a cage that stands."""
        order = self.force.geometry.balls * abs(self.cage_turn)
        return Excitation(order, HARMONICS, rank=1) if order > 0.0 else None

    @cached_property
    def cage_turn(self) -> float:
        """Speed of the cage as a multiple of the system's, by the nominal contact angle."""
        return self.force.geometry.cage_speed(self.inner_spin, self.outer_spin)

    def conditions(self, operation: Operation) -> dict[str, float]:
        """Angle of the cage and speeds, by the names that the force takes."""
        return {
            "cage_angle": self.start_angle + self.cage_turn * operation.angle,
            "inner_speed": self.inner_spin * operation.speed,
            "outer_speed": self.outer_spin * operation.speed,
        }

    def balls(self, displacement: FloatArray, operation: Operation) -> BallLoads:
        """Loads of all balls at rest at the displacement (6,) of the inner ring against the outer one."""
        return self.force.balls(displacement, **self.conditions(operation))

    def element_loads(self, displacement: FloatArray, operation: Operation) -> FloatArray:
        """See `OnRings.element_loads`."""
        return np.asarray(self.balls(displacement, operation).load[0])

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Force on the inner ring, stiffness and damping, see `Element.evaluate`."""
        return Forces(*self.force(displacement, velocity, **self.conditions(operation)))
