"""A tapered roller bearing as a force element with five freedoms: force, stiffness, damping by the pose of its ring.

Frame O sits in the plane of the middles of the rollers, x along the axis. Pose and signs are those of
`mbs.bearings.balls.ball_bearing`; the pose zero has all contacts just touch, without clearance: what presses or loosens
them is an axial displacement. A positive contact angle carries +x.

Quasi-static: each roller is in balance between cup, cone and rib with its centrifugal load and gyroscopic moment, moves
along and across the contacts and tilts in its plane. Both raceways carry after ISO/TS 16281, in slices, half of the
total approach each, with the profile on each side, or by tables with films; ribs are dry, after Hertz. Cylindrical
rollers between ribs on both rings (NJ, NUP) are those of a contact angle of zero, in the middle of the play of both
raceways and of the ribs at the pose zero. Of two rows (NNCF) one leans on ribs; x is counted from the middle between
them. Speeds are held in the derivatives. Left out: friction, skewing, the cage,
how slices of a roller press on each other, bending of the rings.

Contacts at rest store U, the sum of the integrals of their loads over the approaches. With the balance of each roller

    dU/dt = f . dD/dt + F . dV/dt,

V and D of `ehdmaps/kernel/c/taper/taper_balance.c`, f the forces of the ring on its rollers: the first part is the work
of the ring and of the turning cage, the second one that of speed.

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
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.kernel.record import address
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.surface import iso_profile
from mbs.bearings.laws import roller_coefficient
from mbs.bearings.locating.film_memory import rows_of, springs_of
from mbs.bearings.locating.locating_force import Loads, LocatingForce, directions, later
from mbs.bearings.locating.normal_law import LawData, NormalLaw, contacts_at, energies, law_data
from mbs.bearings.tapered.kernel_structs import (
    ADDED,
    ANSWER,
    COLUMNS,
    FIRST_RIB,
    PLACE,
    RING,
    Ribs,
    TaperedShape,
    data_of,
    functions,
)
from mbs.bearings.tapered.line_film import LineFilms, cylinder_of

if TYPE_CHECKING:
    from mbs.life import ReferenceLife

SLICES, MOST_SLICES = 21, 1000

FARTHEST = 0.1
"""Largest accepted displacement over the roller's diameter: bodies are linear."""


@dataclass(frozen=True, eq=False)
class TaperedLoads(Loads):
    """State of all rollers at one pose, see `Loads`: loads are those of cone, cup and all ribs of the cone.

    Attributes
    ----------
    ribs : array (m, Z)
        Loads of the ribs, as the geometry has them [N].
    centre : array (2, Z)
        Places along the roller where cone and cup carry, from its middle towards the apex [m].
    slices : array (2, Z, n)
        Loads per length of the slices of cone and cup [N/m].
    """

    ribs: FloatArray
    centre: FloatArray
    slices: FloatArray

    @property
    def largest(self) -> float:
        """Load per length of the most loaded slice [N/m]."""
        return float(self.slices.max())

    def life(self, geometry: TaperedGeometry, inner_turns: bool) -> ReferenceLife:
        """See `Loads.life`."""
        from ehdmaps.physics.rollers.tapered_catalogue import tapered_ratings  # where lives are asked for
        from mbs.life import roller_reference_life

        slices = self.slices * geometry.roller_length / self.slices.shape[2]
        gamma = geometry.roller_diameter * math.cos(geometry.cup_angle) / geometry.pitch_diameter
        rating = tapered_ratings(geometry)[0]
        rows = len(geometry.row_places)
        return roller_reference_life(slices, rating, gamma, geometry.cup_angle, inner_turns=inner_turns, rows=rows)


class TaperedForce(LocatingForce):
    """Force, stiffness and damping of a tapered roller bearing, see `LocatingForce`.

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
        What slices of films with memory hold over a step, see `mbs.bearings.locating.film_memory`.

    Raises
    ------
    InputError
        For damping, profile or slices that are none.

    Examples
    --------
    >>> force = TaperedForce(TaperedGeometry("32208", 10e-3, 15e-3, 60e-3, 17, math.radians(14.0)))
    >>> f, K, C = force([10e-6, 0.0, 0.0, 0.0, 0.0, 0.0])
    >>> bool(f[0] < 0.0), bool(K[1, 1] > 5.0 * K[0, 0])
    (True, True)
    """

    rolling_element = "roller"
    shorter = (1.0,)
    gauge = later("tapered.roller_findings", "roller_gauge")
    felt = later("tapered.roller_report", "roller_contacts")
    relaxation = later("tapered.rollers_in_balance", "line_relaxation")
    condensed = later("tapered.rollers_in_balance", "rollers_in_balance")
    geometry: TaperedGeometry

    def __init__(
        self,
        geometry: TaperedGeometry,
        damping: float = 0.0,
        damping_time: float = 0.0,
        *,
        films: LineFilms | None = None,
        profile: str | Callable[[FloatArray], FloatArray] = "iso",
        slices: int = SLICES,
        material: Material = STEEL,
    ) -> None:
        problems = Problems(
            f"{geometry.kind}, {name}: got {value!r:.60} {unit}; allowed: finite and >= 0"
            for name, value, unit in (("damping", damping, "N s/m"), ("damping_time", damping_time, "s"))
            if not (isinstance(value, int | float) and math.isfinite(value) and value >= 0.0)
        )
        if profile not in ("iso", "straight") and not callable(profile):
            problems.append(f"{geometry.kind}, profile: got {profile!r:.60}; allowed: iso, straight")
        if not isinstance(slices, int) or isinstance(slices, bool) or not 2 <= slices <= MOST_SLICES:
            problems.append(
                f"{geometry.kind}, slices: got {slices!r:.60}; allowed: a whole number from 2 to {MOST_SLICES}"
            )
        problems.check()
        self.geometry, self.same_films, self.material = geometry, cylinder_of(geometry), material
        self.damping, self.damping_time, self.profile = float(damping), float(damping_time), profile
        length, diameter, half = geometry.roller_length, geometry.roller_diameter, geometry.half_cone_angle
        self.positions = ((np.arange(slices) + 0.5) / slices - 0.5) * length
        depths = iso_profile(self.positions, diameter, length) if profile == "iso" else np.zeros(slices)
        if callable(profile):
            depths = np.array(profile(self.positions.copy()), dtype=np.float64)
        places = np.tile(directions(geometry.rollers), len(geometry.row_places))
        way = -1.0 if geometry.contact_angle < 0.0 else 1.0
        self.ribs = geometry.ribs(material)
        self.shape = TaperedShape(
            rows=geometry.row_places,
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
        line = NormalLaw(single, self.damping, self.damping_time)
        self.dry_law = LineFilms(line, line)
        self.angles, self.slices, self._way = places, slices, way
        self._data, self._kernel = data_of(self.shape, line), functions().force
        self._begin(films or self.dry_law)

    def _begin(self, films: LineFilms) -> None:
        """Make what the kernel reads of the laws, and the arrays that it writes."""
        self.films = self.dry_law if films.dry else films
        self.film_loads = self.films.loads
        self._kept = [law_data(law) for law in self.films.sides]
        self._lines = (LawData * 2)(*self._kept)
        self._given, self._answer = np.zeros((2, 6)), np.zeros(ANSWER)
        self._rollers = np.zeros((self.angles.size, COLUMNS))
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
        """See `LocatingForce.with_films`."""
        other = copy.copy(self)
        other._begin(films)
        return other

    @property
    def ratings(self) -> tuple[float, float]:
        """See `LocatingForce.ratings`."""
        from ehdmaps.physics.rollers.tapered_catalogue import tapered_ratings

        return tapered_ratings(self.geometry)

    def speed_loads(
        self, inner_speed: float, outer_speed: float = 0.0, cage_speed: float | None = None
    ) -> tuple[float, float]:
        """Centrifugal load, and moment from the axis outwards, see `LocatingForce.speed_loads`."""
        geometry, cage = self.geometry, self._cage_of(inner_speed, outer_speed, cage_speed)
        mass = geometry.roller_mass(self.material)
        along, across = geometry.roller_inertia(self.material)
        sine, cosine = math.sin(geometry.axis_angle), math.cos(geometry.axis_angle)
        spin = geometry.roller_speed(inner_speed, outer_speed) + cage * cosine
        moment = cage * sine * (along * spin - across * cage * cosine)
        return 0.5 * mass * geometry.pitch_diameter * cage**2, self._way * moment

    def _loads(self, angle: FloatArray, idle: float) -> TaperedLoads:
        """See `LocatingForce`."""
        rows, shape = self._rollers.T.copy(), self.shape
        place, ring = rows[PLACE], rows[RING]
        slices = np.zeros((2, angle.size, self.positions.size))
        for side, (normal, moved) in enumerate(((shape.cone, ring - place), (shape.cup, place))):
            approach = normal[0] * moved[0] + normal[1] * moved[1] + rows[ADDED][side]
            depth = approach[:, None] + moved[2][:, None] * shape.levers - shape.profile
            law = self.films.sides[side]
            dry = law.coefficient * np.maximum(depth, 0.0) ** (10.0 / 9.0)
            slices[side] = (dry if self.films.dry else contacts_at(law, depth)[0]) / self.geometry.roller_length
        half, diameter = self.geometry.half_cone_angle, self.geometry.roller_diameter
        centre = (self._way * rows[6:8] + 0.5 * diameter * math.sin(half)) * math.cos(half)
        ribs = rows[FIRST_RIB : FIRST_RIB + len(self.ribs)]
        return TaperedLoads(angle, rows[3:6], ribs, np.where(rows[3:5] > 0.0, centre, 0.0), slices)

    def forget(self) -> None:
        """See `LocatingForce.forget`."""
        self._rollers[:] = 0.0

    @property
    def last_rows(self) -> FloatArray:
        """See `LocatingForce.last_rows`, (Z, `COLUMNS`), see `mbs.bearings.tapered.kernel_structs`."""
        return self._rollers

    @property
    def last_loads(self) -> FloatArray:
        """See `LocatingForce.last_loads`: of cone and cup."""
        return self._rollers[:, 3:5].T

    def works(self, speeds: tuple[float, float], last: FloatArray) -> tuple[float, float]:
        """See `LocatingForce.works`; `last` as of `ehd_taper_works`."""
        given, found = np.array(self.speed_loads(*speeds)), np.empty(2)
        places = self._rollers.ctypes.data, given.ctypes.data, last.ctypes.data, found.ctypes.data
        functions().works(self._data.address, *places)
        return float(found[0]), float(found[1])

    def stored(self, rows: FloatArray) -> float:
        """See `LocatingForce.stored`; with 2/5 of the load times the approach of each rib."""
        shape, place, ring = self.shape, rows[:, PLACE], rows[:, RING]
        ribs = rows[:, FIRST_RIB : FIRST_RIB + shape.ribs.laws.size]
        total = 0.4 * float(np.sum(ribs ** (5.0 / 3.0) * shape.ribs.laws ** (-2.0 / 3.0)))
        for side, (normal, moved) in enumerate(((shape.cone, ring - place), (shape.cup, place))):
            approach = moved[:, :2] @ np.array(normal) + rows[:, ADDED][:, side]
            depth = approach[:, None] + moved[:, 2:] * shape.levers - shape.profile
            total += float(np.sum(energies(self.films.sides[side], depth, 10.0 / 9.0))) / shape.levers.size
        return total

    def go_on(self, memory: FloatArray) -> None:
        """See `LocatingForce.go_on`."""
        springs, approaches = springs_of(self.films, self.shorter), np.zeros(self.slices)
        given = self._places[0][:2], (springs.address, self._places[2][0], approaches.ctypes.data, self._room(memory))
        functions().go_on(*given[0], *given[1])

    def _room(self, memory: FloatArray) -> int:
        """Address of the memory of all slices."""
        wanted = (*self.contacts[:2], rows_of(len(self.shorter)), self.slices)
        if memory.shape != wanted:
            raise InputError(f"{self.geometry.kind}, memory: got an array of shape {memory.shape}; allowed: {wanted}")
        return address(memory, self._rollers.dtype, "memory of rollers")

    def _evaluated(
        self, pose: npt.ArrayLike, cage_angle: float, inner_speed: float, outer_speed: float, cage_speed: float | None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """See `LocatingForce`."""
        place = self._six(pose, "pose")
        centrifugal, moment = self.speed_loads(inner_speed, outer_speed, cage_speed)
        memory, (first, loads, last) = None if self.held is None else self._room(self.held), self._places
        self._given[0], self._given[1, 1], self._given[1, 2] = place, centrifugal, moment
        found = self._kernel(*first, float(cage_angle), loads, memory, *last)
        if found < 0:
            self._rollers[:] = 0.0
            self._refuse(found, place, cage_angle)
        return self._out
