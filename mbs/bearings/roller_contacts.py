"""Bearings whose rollers are bodies between two contacts.

The rollers have a radial freedom each, between an inner and an outer contact. All is linear in a frame that does not
move: poses of both rings and radial places of the rollers are small displacements from the nominal positions. A roller
takes half of the tilt between the rings, as its two contacts, being nearly alike, make it do. Clearance and profile
divide evenly between the contacts. The rollers being rigid, the slices of a roller carry on both sides what the two
laws give them; only their sums balance. With equal laws that is what `BearingForce` finds with both contacts in
series; with the laws of a map the two differ by the square of the small difference of the contacts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, OutsideMapError, Problems, SolverError
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import AT_REST
from mbs.bearings.force_at_point import real_numbers
from mbs.bearings.laws import DryLaw, FlatLaw, Law, law_problems
from mbs.bearings.slices_in_balance import Side
from mbs.model.elements import Forces

if TYPE_CHECKING:
    from ehdmaps.maps.kernels.memory import FilmMemory, FilmState
    from ehdmaps.maps.law import ContactLaw
    from ehdmaps.maps.law_films import LawAtPoint


_STEPS = 100


class RollerContacts:
    """Forces between rings and rollers.

    The vector of displacements is (inner pose, outer pose, radial places of the rollers), 12 + Z long; radial places
    are positive outwards, along the direction of each roller.

    Parameters
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    inner, outer : DryLaw or ContactLaw
        Laws of a single contact: `hertz(bearing).single()` or `constant(k, c).single()` of `mbs.bearings.laws`, or the
        laws "inner" and "outer" of a map.

    Attributes
    ----------
    added : array (Z, 2, 2) or None
        Approach and rate that deviations add to both contacts, see `mbs.model.elements.OnRings.deviate`.

    Raises
    ------
    InputError
        For laws of other contacts.
    """

    def __init__(self, bearing: Bearing, inner: Law, outer: Law) -> None:
        where = "roller contacts, law of the {} contact"
        problems = Problems(law_problems(where.format("inner"), inner, bearing, "inner"))
        problems += law_problems(where.format("outer"), outer, bearing, "outer")
        problems.check()
        self.bearing = bearing
        self.laws = (inner, outer)
        self.flat_laws = (FlatLaw(inner), FlatLaw(outer))
        self._points: dict[int, LawAtPoint] = {}
        self._x = bearing.row_places[:, None] + bearing.slice_positions
        self.added: FloatArray | None = None
        self._depths = bearing.profile_depths + 0.25 * bearing.geometry.diametral_clearance

    @property
    def size(self) -> int:
        """Length of the vector of displacements."""
        return 12 + self.bearing.geometry.rolling_elements

    def __call__(
        self,
        displacement: npt.ArrayLike,
        velocity: npt.ArrayLike | None = None,
        *,
        cage_angle: float = 0.0,
        entrainment_speed: float = math.nan,
        temperature: float = math.nan,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Generalised forces on rings and rollers, and their derivatives.

        Parameters
        ----------
        displacement, velocity : array (12 + Z,)
            [m], [rad], [m/s], [rad/s]; at rest if there is no velocity.
        cage_angle, entrainment_speed, temperature : float
            The same as for `BearingForce`.

        Returns
        -------
        f, K, C : arrays (m,), (m, m), (m, m)
            f [N], [N m], K = -df/d displacement, C = -df/d velocity; both symmetric.

        Raises
        ------
        InputError
            For values that are no finite numbers, or of another number.
        OutsideMapError
            Outside the map, where a law has the policy "error".
        """
        conditions = {"entrainment_speed": entrainment_speed, "temperature": temperature}
        return self.evaluate(displacement, velocity, cage_angle=cage_angle, **conditions)[:3]

    def evaluate(
        self,
        displacement: npt.ArrayLike,
        velocity: npt.ArrayLike | None = None,
        *,
        cage_angle: float = 0.0,
        entrainment_speed: float = math.nan,
        temperature: float = math.nan,
    ) -> Forces:
        """As a call, and whether a slice was outside the map of its contact."""
        q = self._vector("displacement", displacement)
        v = np.zeros(self.size) if velocity is None else self._vector("velocity", velocity)
        f, K, C = np.zeros(self.size), np.zeros((self.size, self.size)), np.zeros((self.size, self.size))
        outside = False
        for side, (flat, tilted), delta in self._contacts(q, cage_angle):
            rate = self._rate(side, (flat, tilted), v)
            load, k, c, beyond = self._evaluate(side, delta, rate, entrainment_speed, temperature)
            outside |= beyond
            f -= flat.T @ load.sum(axis=1) + tilted.T @ (load * self._x).sum(axis=1)
            K += self._matrix(flat, tilted, k)
            C += self._matrix(flat, tilted, c)
        return Forces(f, K, C, outside)

    def loads(
        self,
        displacement: npt.ArrayLike,
        velocity: npt.ArrayLike,
        *,
        cage_angle: float,
        entrainment_speed: float,
        temperature: float,
    ) -> FloatArray:
        """Loads of both contacts of each roller, shape (Z, 2) [N].

        Parameters
        ----------
        displacement, velocity : array (12 + Z,)
            What a call takes.
        cage_angle, entrainment_speed, temperature : float
            The same as for `BearingForce`.
        """
        q, v = self._vector("displacement", displacement), self._vector("velocity", velocity)
        found = [
            self._evaluate(side, delta, self._rate(side, rows, v), entrainment_speed, temperature)[0].sum(axis=1)
            for side, rows, delta in self._contacts(q, cage_angle)
        ]
        return np.stack(found, axis=1)

    def _rate(self, side: int, rows: tuple[FloatArray, FloatArray], v: FloatArray) -> FloatArray:
        """Rates of the approaches of one side, (Z, n) [m/s]."""
        flat, tilted = rows
        rate = (flat @ v)[:, None] + self._x * (tilted @ v)[:, None]
        return np.asarray(rate if self.added is None else rate + self.added[:, side, 1:])

    def advance(
        self,
        states: tuple[FilmState, ...] | None,
        displacement: npt.ArrayLike,
        dt: float,
        *,
        cage_angle: float,
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[Forces, tuple[FilmState, FilmState]]:
        """A step in time with films that have a memory, each contact with its own.

        Parameters
        ----------
        states : (FilmState, FilmState) or None
            Films of the inner and of the outer contacts at the beginning of the step; None for films in equilibrium.
        displacement : array (12 + Z,)
            Displacements at its end [m], [rad].
        dt : float
            Length of the step [s], > 0; of no effect without states.
        cage_angle, entrainment_speed, temperature : float
            The same as for `BearingForce`, at its end.

        Returns
        -------
        forces : Forces
            Forces and tangents at the end of the step; the damping is zero, as the forces do not depend on rates.
        states : (FilmState, FilmState)
            Films there.

        Raises
        ------
        InputError
            For laws without films, and for values that are no finite numbers.
        OutsideMapError
            Outside the map, where a law has the policy "error".
        """
        q = self._vector("displacement", displacement)
        f, K, C = np.zeros(self.size), np.zeros((self.size, self.size)), np.zeros((self.size, self.size))
        dry = next((law.name for law in self.laws if isinstance(law, DryLaw)), None)
        if dry is not None:
            raise InputError(f"roller contacts, films: got the law {dry!r} without films; allowed: map, formula")
        length, films, memories = self.bearing.slice_length, [], self.memories(entrainment_speed, temperature)
        for side, (flat, tilted), delta in self._contacts(q, cage_angle):
            memory = memories[side]
            begin = memory.settled(delta) if states is None else states[side]
            load, tangent, end = memory.advance(begin, delta, AT_REST if states is None else dt)
            films.append(begin if states is None else end)
            f -= length * (flat.T @ load.sum(axis=1) + tilted.T @ (load * self._x).sum(axis=1))
            K += self._matrix(flat, tilted, tangent * length)
        return Forces(f, K, C), (films[0], films[1])

    def sides(
        self, displacement: npt.ArrayLike, *, cage_angle: float, entrainment_speed: float, temperature: float
    ) -> tuple[Side, ...]:
        """Slices of the inner contacts and of the outer ones, at rest; none for laws without films.

        Parameters
        ----------
        displacement : array (12 + Z,)
            Displacements [m], [rad].
        cage_angle, entrainment_speed, temperature : float
            The same as for `BearingForce`.
        """
        if any(isinstance(law, DryLaw) for law in self.laws):
            return ()
        points = self._film_points(entrainment_speed, temperature)
        q = self._vector("displacement", displacement)
        return tuple(
            Side(points[side], np.stack(rows, axis=1), approach, self._x, self.bearing.slice_length)
            for side, rows, approach in self._contacts(q, cage_angle)
        )

    def settled(
        self,
        inner_pose: npt.ArrayLike,
        outer_pose: npt.ArrayLike | None = None,
        *,
        cage_angle: float = 0.0,
        entrainment_speed: float = math.nan,
        temperature: float = math.nan,
    ) -> FloatArray:
        """Displacements (12 + Z,) with the rollers in equilibrium at rest between rings that are held.

        Rollers without load stay in the middle.

        Parameters
        ----------
        inner_pose : array_like
            Pose of the inner ring, shape (6,) [m], [rad].
        outer_pose : array_like, optional
            Pose of the outer ring, shape (6,); at the origin if left out.
        cage_angle : float
            Angle at which the cage stands [rad].
        entrainment_speed : float
            u [m/s].
        temperature : float
            T [K].

        Raises
        ------
        SolverError
            If a roller finds no equilibrium.
        """
        q = np.zeros(self.size)
        q[:6] = inner_pose
        q[6:12] = 0.0 if outer_pose is None else outer_pose
        q = self._vector("pose", q)
        flat, _ = self._rows(0, cage_angle)
        other, _ = self._rows(1, cage_angle)
        q[12:] = 0.5 * (flat[:, :12] @ q[:12] - other[:, :12] @ q[:12])
        conditions = {"entrainment_speed": entrainment_speed, "temperature": temperature}
        for _ in range(_STEPS):
            f, K, _, _ = self.evaluate(q, cage_angle=cage_angle, **conditions)
            stiffness = np.diag(K)[12:]
            loaded = stiffness > 0.0
            step = np.where(loaded, f[12:] / np.where(loaded, stiffness, 1.0), 0.0)
            q[12:] += step
            if np.max(np.abs(step)) < 1e-15:
                return q
        raise SolverError(
            f"roller contacts: no equilibrium of the rollers, still moving by {np.max(np.abs(step)):.3g} m after "
            f"{_STEPS} steps at the inner pose {q[:6].tolist()}; look at the law, or start from a smaller load"
        )

    def approaches(self, displacement: npt.ArrayLike, cage_angle: float) -> tuple[FloatArray, FloatArray]:
        """Approach of the slices of the inner and of the outer contacts, shape (Z, n) each [m].

        Parameters
        ----------
        displacement : array (12 + Z,)
            Displacements [m], [rad].
        cage_angle : float
            Angle of the first roller [rad].
        """
        q = self._vector("displacement", displacement)
        inner, outer = (approach for _, _, approach in self._contacts(q, cage_angle))
        return inner, outer

    def memories(self, entrainment_speed: float, temperature: float) -> tuple[FilmMemory, FilmMemory]:
        """Laws with memory of both contacts at a speed [m/s] and temperature [K]; for laws with films only."""
        inner, outer = (point.memory for point in self._film_points(entrainment_speed, temperature))
        return inner, outer

    def _film_points(self, speed: float, temperature: float) -> list[LawAtPoint]:
        """Laws of both contacts at a speed and temperature; for laws with films only."""
        films = [law for law in self.laws if not isinstance(law, DryLaw)]
        return [self._point(side, law, speed, temperature) for side, law in enumerate(films)]

    def _rows(self, side: int, cage_angle: float) -> tuple[FloatArray, FloatArray]:
        """Approach (Z, m) of the contacts by the displacements, and how it grows along the roller."""
        angle = cage_angle + self.bearing.roller_angles
        count = angle.size
        c, s = np.cos(angle), np.sin(angle)
        flat, tilted = np.zeros((count, self.size)), np.zeros((count, self.size))
        sign, ring = (1.0, 0) if side == 0 else (-1.0, 6)
        flat[:, ring + 1], flat[:, ring + 2] = sign * c, sign * s
        flat[np.arange(count), 12 + np.arange(count)] = -sign
        tilted[:, 4], tilted[:, 5] = -0.5 * s, 0.5 * c
        tilted[:, 10], tilted[:, 11] = 0.5 * s, -0.5 * c
        return flat, tilted

    def _contacts(
        self, q: FloatArray, cage_angle: float
    ) -> Iterator[tuple[int, tuple[FloatArray, FloatArray], FloatArray]]:
        """Each side, its rows, and the approach of its slices, shape (Z, n)."""
        for side in (0, 1):
            flat, tilted = self._rows(side, cage_angle)
            depths = self._depths if self.added is None else self._depths - self.added[:, side, :1]
            yield side, (flat, tilted), (flat @ q)[:, None] + self._x * (tilted @ q)[:, None] - depths

    def _matrix(self, flat: FloatArray, tilted: FloatArray, values: FloatArray) -> FloatArray:
        """Sum of values B B^T over the slices."""
        first, second, third = (np.sum(values * self._x**power, axis=1) for power in range(3))
        mixed = (flat * second[:, None]).T @ tilted
        flats, tilts = (flat * first[:, None]).T @ flat, (tilted * third[:, None]).T @ tilted
        return np.asarray(flats + mixed + mixed.T + tilts)

    def _evaluate(
        self, side: int, delta: FloatArray, rate: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, FloatArray, FloatArray, bool]:
        """Loads and derivatives of the slices of one side [N], [N/m], [N s/m], and whether any lies outside the map."""
        law = self.laws[side]
        if isinstance(law, DryLaw):
            w, k, c = (part / self.bearing.slices for part in law.evaluate(delta, rate))
            return w, k, c, self._above(law, delta)
        length = self.bearing.slice_length
        w, k, c, outside = self._point(side, law, speed, temperature).evaluate(delta, rate)
        return w * length, k * length, c * length, outside

    def _above(self, law: DryLaw, delta: FloatArray) -> bool:
        """Tell whether a slice lies above the last point of a law without film; an error where the law asks for one."""
        above = law.is_above(delta)
        if above and law.outside == "error":
            raise OutsideMapError(
                f"roller contacts, approach: got {float(np.max(delta)):.6g} m, above the last point of the law "
                f"{law.name!r}; give it points that reach there"
            )
        return above

    def _point(self, side: int, law: ContactLaw, speed: float, temperature: float) -> LawAtPoint:
        """The law of one side at a speed and temperature: that of the last call, or a new one."""
        point = self._points.get(side)
        if point is None or (point.entrainment_speed, point.temperature) != (speed, temperature):
            if not (math.isfinite(speed) and math.isfinite(temperature)):
                raise InputError(
                    f"roller contacts: got the entrainment_speed {speed!r} and the temperature {temperature!r}; "
                    "the law of a map needs finite numbers; give both"
                )
            point = self._points[side] = law.at(speed, temperature)
        return point

    def _vector(self, name: str, given: npt.ArrayLike) -> FloatArray:
        """Finite numbers, as many as there are displacements."""
        wanted = "", self.size, "the inner pose, the outer pose and the rollers"
        values = real_numbers(f"roller contacts, {name}", given, wanted)
        if not np.all(np.isfinite(values)):
            raise InputError(f"roller contacts, {name}: got {values.tolist()}; allowed: finite numbers")
        return values
