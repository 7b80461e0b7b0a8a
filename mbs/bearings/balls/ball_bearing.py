"""A ball bearing as a force element with five freedoms: force, stiffness and damping by the pose of its inner ring.

Frame O sits in the middle of the outer groove, x along its axis. Pose and signs are those of `mbs.bearings.bearing`:
x, y, z, and the tilts theta_y = -n_z, theta_z = n_y of the inner ring's axis n; theta_x has no force. The pose zero has
both grooves where their nominal contact angle puts them: deep groove bearings stand in their middle, so that clearance
lets them go either way; angular contact bearings just touch, without clearance.

Quasi-static: each ball is in balance at the speeds of the rings, and has no inertia against small motions beside that.
It rolls at both raceways about an axis that is a hypothesis: by default it does not drill at the outer one, whose
traction holds the whole gyroscopic moment (outer race control). Its speed around the axis follows its contact angles,
see `mbs.bearings.balls.ball_speed`; in the derivatives it follows, too, and speeds of the rings are held. That is slow
motion. `cage_speed` holds all balls at one speed: motion that is too fast for them to follow. The potential of dry
contacts takes the arm of the inner groove's centre for both displacement and moment; ISO/TS 16281 takes d_m/2 for
moments, which is 1 % less.

References
----------
T. A. Harris, M. N. Kotzalas, Advanced Concepts of Bearing Technology, CRC, 2007, chapter 3. J. M. de Mul, J. M. Vree,
D. A. Maas, Journal of Tribology 111 (1989) 142. ISO/TS 16281.
"""

from __future__ import annotations

import ctypes
import dataclasses
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.physics.point.ball_geometry import HYPOTHESES, BallGeometry
from ehdmaps.physics.solids import STEEL, Material
from mbs.bearings.balls.ball_data import (
    COLUMNS,
    START,
    BallData,
    BallShape,
    DriveData,
    ShapeData,
)
from mbs.bearings.balls.ball_speed import Drive, ball_loads, ball_works, mean_speed
from mbs.bearings.balls.laws import BallLaw
from mbs.bearings.balls.response import SHORTER
from mbs.bearings.locating.film_memory import springs_of
from mbs.bearings.locating.locating_force import Loads, LocatingForce, directions, later
from mbs.bearings.locating.normal_law import energies, law_data, load_approach
from mbs.model.findings import CARRIES

if TYPE_CHECKING:
    from mbs.life import ReferenceLife

SPHERE_TILT = 0.1
"""Largest accepted tilt of a bearing whose outer raceway is a sphere [rad]; makers allow half of it."""

NEGLIGIBLE = 1e-11
"""Approach [m] of a dry contact under a centrifugal load that is left out: less than a micronewton."""


@dataclass(frozen=True, eq=False)
class BallLoads(Loads):
    """State of all balls at one pose, see `Loads`.

    Attributes
    ----------
    contact_angle : array (2, Z)
        Contact angles of both [rad].
    approach : array (2, Z)
        Approaches of both [m]; below zero a gap, or a film.
    speed : array (Z,)
        Speeds around the axis [rad/s].
    centrifugal, traction, inner_traction : array (Z,)
        Centrifugal loads, and tractions at the outer and the inner raceway that hold the gyroscopic moment, with the
        sign of the contact angle [N].
    cage_speed : float
        Speed of the cage: the mean of the balls' speeds by their inner loads [rad/s].
    """

    contact_angle: FloatArray
    approach: FloatArray
    speed: FloatArray
    centrifugal: FloatArray
    traction: FloatArray
    inner_traction: FloatArray
    cage_speed: float

    @property
    def gyroscopic_traction(self) -> float:
        """Largest traction that holds a gyroscopic moment, over the load of its ball at the same raceway.

        Of contacts that carry load: films press a little on all others.
        """
        loaded = self.load > CARRIES * self.load[1].max()
        traction = np.abs([self.inner_traction, self.traction])
        return float(np.max(traction[loaded] / self.load[loaded], initial=0.0))

    def life(self, geometry: BallGeometry, inner_turns: bool) -> ReferenceLife:
        """See `Loads.life`."""
        from ehdmaps.physics.point.ball_ratings import ball_dynamic_rating  # where lives are asked for
        from mbs.life import ball_reference_life

        return ball_reference_life(geometry, self.load, ball_dynamic_rating(geometry), inner_turns=inner_turns)

    def mean_angle(self, side: int) -> float:
        """Mean contact angle of a side, 0 the inner one, by the loads of its balls [rad]; zero without load."""
        total = float(np.sum(self.load[side]))
        return float(self.load[side] @ self.contact_angle[side]) / total if total > 0.0 else 0.0


class BallForce(LocatingForce):
    """Force, stiffness and damping of a ball bearing, see `LocatingForce`.

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
    rows : array (Z, 4)
        Way, place [m] and shift [m] of the row of each ball, and how far its other contacts are, see `BallGeometry`.
    """

    rolling_element = "ball"
    of_points, shorter = True, SHORTER
    gauge = later("balls.ball_findings", "ball_gauge")
    felt = later("balls.ball_report", "ball_contacts")
    relaxation = later("balls.balls_in_balance", "ball_relaxation")
    condensed = later("balls.balls_in_balance", "balls_in_balance")
    geometry: BallGeometry

    def __init__(self, geometry: BallGeometry, law: BallLaw, material: Material = STEEL) -> None:
        self.geometry, self.law, self.dry_law, self.material = geometry, law, law, material
        distance, angle = geometry.groove_distance, geometry.contact_angle
        places = [abs(row.place) for row in geometry.rows]
        self._shape = BallShape(
            axial=distance * math.sin(angle),
            radial=geometry.radial_distance,
            arm=geometry.tilt_arm,
            inner_arm=(geometry.inner_conformity - 0.5) * geometry.ball_diameter,
            outer_arm=(geometry.outer_conformity - 0.5) * geometry.ball_diameter,
            most_travel=geometry.most_travel,
            most_tilt=SPHERE_TILT if geometry.spherical else distance / max(geometry.inner_groove_radius, *places),
        )
        mass, diameter, pitch = geometry.ball_mass(material), geometry.ball_diameter, geometry.pitch_diameter
        axis = float(HYPOTHESES.index(geometry.hypothesis))
        self.drive = Drive(0.0, 0.0, math.nan, diameter / pitch, 0.5 * mass * pitch, 0.2 * mass * pitch, axis)
        self.angles = np.tile(directions(geometry.balls), len(geometry.rows))
        self.film_loads = law.loads
        turned = np.array([1.0, math.copysign(1.0, angle), math.copysign(1.0, angle), 1.0])
        rows = [
            (*row, other * geometry.balls) for row, other in zip(geometry.shifted_rows, geometry.others, strict=True)
        ]
        self.rows = np.repeat(np.array(rows, dtype=np.float64) * turned, geometry.balls, axis=0)
        self.same_films = dataclasses.replace(geometry, clearance=0.0, contact_angle=abs(geometry.contact_angle))
        self.directions = np.cos(self.angles), np.sin(self.angles)
        balls = geometry.rolling_elements
        self._pose, self._starts, self._balls = np.zeros(6), np.zeros((balls, START)), np.zeros((balls, COLUMNS))
        self._out = np.zeros(6), np.zeros((6, 6)), np.zeros((6, 6))
        self._rest = (0.0, 0.0)
        self._data = checked(BallData, "ehd_ball_data")(
            shape=ShapeData(**self._shape._asdict()),
            drive=DriveData(**self.drive._asdict()),
            balls=balls,
            cosine=self.directions[0],
            sine=self.directions[1],
            rows=self.rows,
            inner=law_data(law.inner),
            outer=law_data(law.outer),
        )
        self._held: FloatArray | None = None
        rooms = self._pose, self._starts, self._balls, *self._out
        self._arguments = self._data.address, *(room.ctypes.data for room in rooms)
        self._force, self._angles = _functions()

    def __reduce__(self) -> tuple[Any, ...]:
        """For other processes: as it was made, without what calls left behind."""
        return BallForce, (self.geometry, self.law, self.material)

    def with_films(self, films: BallLaw) -> BallForce:
        """See `LocatingForce.with_films`."""
        return BallForce(self.geometry, films, self.material)

    def beyond(self, pose: FloatArray) -> bool:
        """Tell whether an angular contact bearing is beyond its middle, where it has no raceway."""
        return bool(np.any(self.shape.axial * (self.shape.axial + self.rows[:, 0] * pose[0]) < 0.0))

    def by_pose(self, angle: FloatArray) -> FloatArray:
        """Motion of the inner groove's centre of each ball, axial and radial, by the pose, (Z, 2, 6).

        Parameters
        ----------
        angle : array (Z,)
            Angles of the balls [rad].
        """
        c, s, arm = np.cos(angle), np.sin(angle), self.shape.arm
        way, place, *_ = self.rows.T
        found = np.zeros((angle.size, 2, 6))
        found[:, 0, 0], found[:, 0, 4], found[:, 0, 5] = way, way * arm * s, -way * arm * c
        found[:, 1, 1], found[:, 1, 2] = c, s
        found[:, 1, 4], found[:, 1, 5] = -place * s, place * c
        return found

    @property
    def ratings(self) -> tuple[float, float]:
        """See `LocatingForce.ratings`."""
        from ehdmaps.physics.point.ball_ratings import ball_dynamic_rating, ball_static_rating

        return ball_dynamic_rating(self.geometry), ball_static_rating(self.geometry)

    @property
    def shape(self) -> BallShape:
        """Lengths of the bearing."""
        return self._shape

    @shape.setter
    def shape(self, shape: BallShape) -> None:
        self._shape = shape
        self._data.put(shape=ShapeData(**shape._asdict()))

    @property
    def held(self) -> FloatArray | None:
        """See `LocatingForce.held`."""
        return self._held

    @held.setter
    def held(self, held: FloatArray | None) -> None:
        self._held = None if held is None else np.ascontiguousarray(held, dtype=np.float64)
        self._data.put(held=self._held)

    def go_on(self, memory: FloatArray) -> None:
        """See `LocatingForce.go_on`."""
        springs, laws = springs_of(self.law, SHORTER), self._data.address + BallData.inner.offset
        _go_on()(len(self._balls), laws, springs.address, self._balls.ctypes.data, memory.ctypes.data)

    def speed_loads(
        self, inner_speed: float, outer_speed: float = 0.0, cage_speed: float | None = None
    ) -> tuple[float, float]:
        """Centrifugal load, and factor G of the moment G sin(alpha_o), see `LocatingForce.speed_loads`."""
        centrifugal, traction, _, _ = ball_loads(
            self.drive_at(inner_speed=inner_speed, outer_speed=outer_speed),
            self._cage_of(inner_speed, outer_speed, cage_speed),
        )
        return float(centrifugal), 0.5 * float(traction) * self.geometry.ball_diameter

    def _loads(self, angle: FloatArray, idle: float) -> BallLoads:
        """See `LocatingForce`."""
        self._angles(len(self._balls), self._balls.ctypes.data)
        rows = self._balls.T.copy()
        cage = float(mean_speed(self._balls, idle))
        return BallLoads(angle, rows[10:12], rows[12:14], rows[14:16], rows[22], rows[23], rows[24], rows[25], cage)

    def forget(self) -> None:
        """See `LocatingForce.forget`."""
        self._starts[:] = 0.0

    @property
    def last_rows(self) -> FloatArray:
        """See `LocatingForce.last_rows`, shape (Z, COLUMNS), see `mbs.bearings.balls.ball_data`.

        Contact angles are there after `balls` alone.
        """
        return self._balls

    @property
    def last_loads(self) -> FloatArray:
        """See `LocatingForce.last_loads`."""
        return self._balls[:, 10:12].T

    def works(self, speeds: tuple[float, float], last: FloatArray) -> tuple[float, float]:
        """See `LocatingForce.works`; `last` as of `ball_works`."""
        return ball_works(self._balls, self._data.shape, last, self._data.given("added"))

    def stored(self, rows: FloatArray) -> float:
        """See `LocatingForce.stored`."""
        approaches = rows[:, 14:16].T
        return sum(float(np.sum(energies(*one))) for one in zip(self.law.sides, approaches, strict=True))

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
            Speeds [rad/s] and angle of the cage, which changes nothing; see `LocatingForce.__call__`.
        """
        cage = math.nan if cage_speed is None else float(cage_speed)
        return self.drive._replace(inner=float(inner_speed), outer=float(outer_speed), cage=cage)

    def drive_of(self, rows: FloatArray, conditions: dict[str, Any]) -> Drive:
        """Speeds and masses of balls by their rows, see `last_rows`: one of four contacts has a part of its mass.

        Parameters
        ----------
        rows : array (n, COLUMNS)
            Rows of the balls.
        conditions : dict
            Arguments of `drive_at`.
        """
        drive = self.drive_at(**conditions)
        if not np.any(self.rows[:, 3]):
            return drive
        whole = drive.centrifugal * rows[:, 22] ** 2
        part: Any = np.where(whole > 0.0, rows[:, 23] / np.where(whole > 0.0, whole, 1.0), 1.0)
        return drive._replace(centrifugal=part * drive.centrifugal, gyroscopic=part * drive.gyroscopic)

    def _evaluated(
        self, pose: npt.ArrayLike, cage_angle: float, inner_speed: float, outer_speed: float, cage_speed: float | None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Call the kernel; its arrays are overwritten by the next call."""
        self._pose[:] = self._six(pose, "pose")
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


@functools.cache
def _functions() -> tuple[Callable[..., int], Callable[..., None]]:
    """Functions in C: force, stiffness and damping; contact angles."""
    place = ctypes.c_void_p
    force = function("ehd_ball_force_surely", *7 * (place,))
    return force, function("ehd_ball_angles", ctypes.c_int64, place, result=None)


@functools.cache
def _go_on() -> Callable[..., None]:
    """Memory of films at the end of a step, in C."""
    return function("ehd_ball_go_on", ctypes.c_int64, *4 * (ctypes.c_void_p,), result=None)
