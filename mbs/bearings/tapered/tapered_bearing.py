"""A tapered roller bearing as a force element with five freedoms: force, stiffness, damping by the pose of its ring.

Frame O sits in the plane of the middles of the rollers, x along the axis. Pose and signs are those of
`mbs.bearings.balls.ball_bearing`; the pose zero has all contacts just touch, without clearance: what presses or loosens
them is an axial displacement. A positive contact angle carries +x.

Quasi-static: each roller is in balance between cup, cone and rib with its centrifugal load and gyroscopic moment, moves
along and across the contacts and tilts in its plane. Both raceways carry after ISO/TS 16281, in slices, half of the
total approach each, with the profile on each side, or by tables with films; ribs are dry, after Hertz. Cylindrical
rollers between ribs on both rings (NJ, NUP) are those of a contact angle of zero, in the middle of the play of both
raceways and of the ribs at the pose zero. Speeds are held in the derivatives. Left out: friction, skewing, the cage,
how slices of a roller press on each other, bending of the rings.

References
----------
ISO/TS 16281:2008. J. M. de Mul, J. M. Vree, D. A. Maas, Journal of Tribology 111 (1989) 149.
"""

from __future__ import annotations

import copy
import ctypes
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.kernel.record import address
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.surface import iso_profile
from mbs.bearings.balls.normal_law import contacts_at
from mbs.bearings.laws import roller_coefficient
from mbs.bearings.tapered.kernel_structs import (
    ANSWER,
    COLUMNS,
    FIRST_RIB,
    MEMORY,
    NOT_FINITE,
    PLACE,
    RING,
    TOO_FAR,
    LineSprings,
    both_lines,
    data_of,
    functions,
)
from mbs.bearings.tapered.line_film import DRY_LINES, LineFilms
from mbs.bearings.tapered.tapered_shape import Ribs, RollerLaws, TaperedShape

FASTEST = 2e4
"""Largest accepted speed of a ring [rad/s]."""

SLICES, MOST_SLICES = 21, 1000

FARTHEST = 0.1
"""Largest accepted displacement over the roller's diameter: bodies are linear."""


@dataclass(frozen=True, eq=False)
class TaperedLoads:
    """State of all rollers at one pose.

    Attributes
    ----------
    angle : array (Z,)
        Angles of the rollers in O, from y towards z, within -pi to pi [rad].
    load : array (3, Z)
        Loads of cone, cup and all ribs of the cone [N].
    ribs : array (m, Z)
        Loads of the ribs, as the geometry has them [N].
    centre : array (2, Z)
        Places along the roller where cone and cup carry, from its middle towards the apex [m].
    slices : array (2, Z, n)
        Loads per length of the slices of cone and cup [N/m].
    """

    angle: FloatArray
    load: FloatArray
    ribs: FloatArray
    centre: FloatArray
    slices: FloatArray


class TaperedForce:
    """Force, stiffness and damping of a tapered roller bearing.

    Parameters
    ----------
    geometry : TaperedGeometry
        Geometry of the bearing.
    damping : float
        Constant damping of each contact of a roller while it carries load [N s/m], >= 0.
    damping_time : float
        Damping over stiffness of each contact [s], >= 0.
    films : LineFilms
        Laws of the lines with films at one speed; dry lines if left out.
    profile : {"iso", "straight"} or callable
        Profile of the rollers on one side [m], by name or over the distance from the middle [m].
    slices : int
        Slices of a roller.
    material : Material
        Material of rollers and rings; its density gives them mass.

    Attributes
    ----------
    held : array (Z, 2, MEMORY, n) or None
        What slices of films with memory hold over a step, see `mbs.bearings.tapered.tapered_memory`.

    Raises
    ------
    InputError
        For damping, profile or slices that are none.

    Notes
    -----
    An object is for one thread: it keeps the places of the rollers as a start for the next call.

    Examples
    --------
    >>> force = TaperedForce(TaperedGeometry("32208", 10e-3, 15e-3, 60e-3, 17, math.radians(14.0)))
    >>> f, K, C = force([10e-6, 0.0, 0.0, 0.0, 0.0, 0.0])
    >>> bool(f[0] < 0.0), bool(K[1, 1] > 5.0 * K[0, 0])
    (True, True)
    """

    def __init__(
        self,
        geometry: TaperedGeometry,
        damping: float = 0.0,
        damping_time: float = 0.0,
        *,
        films: LineFilms = DRY_LINES,
        profile: str | Callable[[FloatArray], FloatArray] = "iso",
        slices: int = SLICES,
        material: Material = STEEL,
    ) -> None:
        problems = [
            f"{geometry.kind}, {name}: got {value!r:.60} {unit}; allowed: finite and >= 0"
            for name, value, unit in (("damping", damping, "N s/m"), ("damping_time", damping_time, "s"))
            if not (isinstance(value, int | float) and math.isfinite(value) and value >= 0.0)
        ]
        if profile not in ("iso", "straight") and not callable(profile):
            problems.append(f"{geometry.kind}, profile: got {profile!r:.60}; allowed: iso, straight")
        if not isinstance(slices, int) or isinstance(slices, bool) or not 2 <= slices <= MOST_SLICES:
            problems.append(
                f"{geometry.kind}, slices: got {slices!r:.60}; allowed: a whole number from 2 to {MOST_SLICES}"
            )
        if problems:
            raise InputError(problems)
        self.geometry, self.material = geometry, material
        self.damping, self.damping_time, self.profile = float(damping), float(damping_time), profile
        length, diameter, half = geometry.roller_length, geometry.roller_diameter, geometry.half_cone_angle
        self.positions = ((np.arange(slices) + 0.5) / slices - 0.5) * length
        depths = iso_profile(self.positions, diameter, length) if profile == "iso" else np.zeros(slices)
        if callable(profile):
            depths = np.array(profile(self.positions.copy()), dtype=np.float64)
        places = 2.0 * math.pi * np.arange(geometry.rollers) / geometry.rollers
        way = -1.0 if geometry.contact_angle < 0.0 else 1.0
        self.ribs = geometry.ribs(material)
        self.shape = TaperedShape(
            pitch_radius=0.5 * geometry.pitch_diameter,
            cup=(way * math.sin(geometry.cup_angle), math.cos(geometry.cup_angle)),
            cone=(way * math.sin(geometry.cone_angle), math.cos(geometry.cone_angle)),
            ribs=Ribs(
                np.array([rib.normal for rib in self.ribs], dtype=np.float64).reshape(-1, 2),
                np.array([rib.lever for rib in self.ribs], dtype=np.float64),
                np.array([rib.play for rib in self.ribs], dtype=np.float64),
                np.array([rib.contact.coefficient for rib in self.ribs], dtype=np.float64),
                np.array([rib.outer for rib in self.ribs], dtype=np.bool_),
            ),
            levers=way * (self.positions / math.cos(half) - 0.5 * diameter * math.sin(half)),
            profile=depths + geometry.raceway_play,
            cos=np.cos(places),
            sin=np.sin(places),
            most_travel=FARTHEST * diameter,
            most_tilt=2.0 * FARTHEST * diameter / geometry.pitch_diameter,
        )
        # each raceway takes half of the total approach at the same load
        single = 2.0 ** (10.0 / 9.0) * roller_coefficient(length, material)
        self.films = films
        self.laws = RollerLaws(single, single, self.damping, self.damping_time, films.outer, films.inner, False)
        self.angles, self._way = places, way
        self._data, self._kernel = data_of(self.shape, self.laws), functions().force
        self._begin()

    def _begin(self) -> None:
        """Make what the kernel reads of the laws, and the arrays that it writes."""
        self._lines, self._kept = both_lines(self.laws)
        self._given, self._answer = np.zeros((2, 6)), np.zeros(ANSWER)
        self._rollers = np.zeros((self.geometry.rollers, COLUMNS))
        self._out = self._answer[:6], self._answer[6:42].reshape(6, 6), self._answer[42:].reshape(6, 6)
        self._places = (
            (self._data.address, ctypes.addressof(self._lines), self._given[0].ctypes.data),
            self._given[1].ctypes.data,
            (self._rollers.ctypes.data, self._answer.ctypes.data),
        )
        self.held: FloatArray | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        """For other processes: as it was made, without what calls left behind."""
        made = functools.partial(
            TaperedForce,
            films=self.films,
            profile=self.profile,
            slices=self.positions.size,
            material=self.material,
        )
        return made, (self.geometry, self.damping, self.damping_time)

    def with_films(self, films: LineFilms) -> TaperedForce:
        """The same bearing with other films.

        Parameters
        ----------
        films : LineFilms
            Laws of the lines.
        """
        other = copy.copy(self)
        other.films, other.laws = films, self.laws._replace(cup_film=films.outer, cone_film=films.inner)
        other._begin()
        return other

    def speed_loads(
        self, inner_speed: float, outer_speed: float = 0.0, cage_speed: float | None = None
    ) -> tuple[float, float]:
        """Centrifugal load of a roller [N], and its gyroscopic moment from the axis outwards [N m].

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        cage_speed : float, optional
            Speed of the cage [rad/s]; that of pure rolling if left out.

        Raises
        ------
        InputError
            For speeds that are no finite numbers, or beyond `FASTEST`.
        """
        geometry = self.geometry
        cage = geometry.cage_speed(inner_speed, outer_speed) if cage_speed is None else cage_speed
        if not all(abs(speed) <= FASTEST for speed in (inner_speed, outer_speed, cage)):
            raise InputError(
                f"{geometry.kind}, speeds: got {inner_speed!r}, {outer_speed!r} and {cage!r} rad/s; allowed: finite "
                f"numbers, at most {FASTEST:g} rad/s either way"
            )
        mass = geometry.roller_mass(self.material)
        along, across = geometry.roller_inertia(self.material)
        sine, cosine = math.sin(geometry.axis_angle), math.cos(geometry.axis_angle)
        spin = geometry.roller_speed(inner_speed, outer_speed) + cage * cosine
        moment = cage * sine * (along * spin - across * cage * cosine)
        return 0.5 * mass * geometry.pitch_diameter * cage**2, self._way * moment

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
            Angle of the first roller, from y towards z [rad].
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        cage_speed : float, optional
            Speed of the cage [rad/s]; that of pure rolling if left out.

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
            Where the balance of a roller is not found.
        """
        self._evaluated(pose, cage_angle, inner_speed, outer_speed, cage_speed)
        force, stiffness, damping = (array.copy() for array in self._out)
        if velocity is not None:
            rate = _six(velocity, "velocity")
            if not np.all(np.isfinite(rate)):
                raise InputError(f"{self.geometry.kind}, velocity: got {rate.tolist()}; allowed: finite numbers")
            force -= damping @ rate
        return force, stiffness, damping

    def rollers(
        self,
        pose: npt.ArrayLike,
        *,
        cage_angle: float = 0.0,
        inner_speed: float = 0.0,
        outer_speed: float = 0.0,
        cage_speed: float | None = None,
    ) -> TaperedLoads:
        """Loads of all rollers; arguments and errors as of a call.

        Parameters
        ----------
        pose : array (6,)
            Pose of the inner ring in O.
        cage_angle, inner_speed, outer_speed, cage_speed : float
            Angle of the cage [rad] and speeds [rad/s], see `TaperedForce.__call__`.
        """
        self._evaluated(pose, cage_angle, inner_speed, outer_speed, cage_speed)
        rows, shape = self._rollers.T.copy(), self.shape
        angle = np.angle(np.exp(1j * (self.angles + cage_angle)))
        place, ring = rows[PLACE], rows[RING]
        slices = np.zeros((2, angle.size, self.positions.size))
        for side, (normal, moved) in enumerate(((shape.cone, ring - place), (shape.cup, place))):
            approach = normal[0] * moved[0] + normal[1] * moved[1]
            depth = approach[:, None] + moved[2][:, None] * shape.levers - shape.profile
            each = (self.laws.cone, self.laws.cup)[side] / self.geometry.roller_length
            slices[side] = each * np.maximum(depth, 0.0) ** (10.0 / 9.0)
            if not self.films.dry:
                law = (self.films.inner, self.films.outer)[side]
                slices[side] = contacts_at(law, depth)[0] / self.geometry.roller_length
        half, diameter = self.geometry.half_cone_angle, self.geometry.roller_diameter
        centre = (self._way * rows[6:8] + 0.5 * diameter * math.sin(half)) * math.cos(half)
        ribs = rows[FIRST_RIB : FIRST_RIB + len(self.ribs)]
        return TaperedLoads(angle, rows[3:6], ribs, np.where(rows[3:5] > 0.0, centre, 0.0), slices)

    @property
    def last_rollers(self) -> FloatArray:
        """Numbers of the rollers at the last call, (Z, `COLUMNS`), see `mbs.bearings.tapered.kernel_structs`."""
        return self._rollers

    def go_on(self, springs: LineSprings, memory: FloatArray) -> None:
        """Bring films with memory to the end of a step, at which the last call was.

        Parameters
        ----------
        springs : LineSprings
            Springs of the films there.
        memory : array (Z, 2, MEMORY, n)
            What slices of cone and cup held over the step, see `mbs.bearings.tapered.tapered_memory`; written.
        """
        kept = self._room(memory)
        functions().go_on(*self._places[0][:2], springs.address, self._places[2][0], kept)

    def _room(self, memory: FloatArray) -> int:
        """Address of the memory of all slices."""
        wanted = (self.geometry.rollers, 2, MEMORY, self.positions.size)
        if memory.shape != wanted:
            raise InputError(f"{self.geometry.kind}, memory: got an array of shape {memory.shape}; allowed: {wanted}")
        return address(memory, self._rollers.dtype, "memory of rollers")

    def _evaluated(
        self, pose: npt.ArrayLike, cage_angle: float, inner_speed: float, outer_speed: float, cage_speed: float | None
    ) -> None:
        """Call the kernel, which writes into the arrays of this object."""
        place = _six(pose, "pose")
        centrifugal, moment = self.speed_loads(inner_speed, outer_speed, cage_speed)
        memory, (first, loads, last) = None if self.held is None else self._room(self.held), self._places
        self._given[0], self._given[1, 1], self._given[1, 2] = place, centrifugal, moment
        found = self._kernel(*first, float(cage_angle), loads, memory, *last)
        if found < 0:
            self._rollers[:] = 0.0
            self._refuse(found, place, cage_angle)

    def _refuse(self, found: int, pose: FloatArray, cage_angle: float) -> None:
        """Say what is wrong."""
        kind = self.geometry.kind
        if found == NOT_FINITE:
            raise InputError(
                f"{kind}, pose: got {pose.tolist()} and the cage angle {cage_angle!r}; allowed: finite numbers"
            )
        if found == TOO_FAR:
            raise InputError(
                f"{kind}, pose: got x, y, z = {pose[0]:.6g}, {pose[1]:.6g}, {pose[2]:.6g} m, theta_y, theta_z "
                f"= {pose[4]:.6g}, {pose[5]:.6g} rad; allowed: within {self.shape.most_travel:.6g} m and "
                f"{self.shape.most_tilt:.6g} rad; check units and the step of the solver"
            )
        raise AnalysisError(f"{kind} {self.geometry.name}: no balance of a roller was found at {pose.tolist()}")


def _six(values: npt.ArrayLike, name: str) -> FloatArray:
    """Six numbers."""
    try:
        array = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"bearing, {name}: got {values!r:.80}; allowed: six real numbers") from None
    if array.shape != (6,):
        raise InputError(f"bearing, {name}: got an array of shape {array.shape}; allowed: (6,)")
    return array
