"""The bearing force element: from the pose and velocity of the inner ring to force, stiffness and damping.

Frame O is the one of the outer ring, x axial. A pose is (x, y, z, theta_x, theta_y, theta_z) of the inner ring in O,
its velocity the rate of that; the force is conjugate to it. Neither x nor theta_x has a stiffness: what holds a ring
axially is another element. Spins, cage angle, entrainment speed, temperature and centrifugal load are given beside, and
are held fixed in the derivatives.

Each slice of each roller carries w(delta, rate) times its length, w the law of the roller between both raceways. By
default no slice knows of its neighbours; those of a `Bearing` with `coupled` do, see `ehdmaps.solids.slices` and
`cylinder_coupled.c` of `ehdmaps.kernel`. Slip and traction, contacts with the cage and with the ribs are left out too.
An EHD law takes the contacts as fully flooded all round: without clearance the films of the unloaded side preload the
bearing.

`ForceInTime` is the same with films that need time to follow: each slice has a state.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.maps.kernels.tables import LOAD_TOLERANCE
from mbs.bearings.bearing import Bearing, RingForces, RingState, ring_forces
from mbs.bearings.cylinder import NOT_FINITE, Arrays
from mbs.bearings.force_at_point import (
    ForceAtPoint,
    RollerLoads,
    Triple,
    check_conditions,
    coupling_beside,
    raise_state,
    six_numbers,
)
from mbs.bearings.laws import DryLaw, FlatLaw, Law, law_problems
from mbs.model.elements import Forces

if TYPE_CHECKING:
    from ehdmaps.maps.kernels.memory import FilmState
    from ehdmaps.maps.law_films import LawAtPoint


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
        self._state, self._arrays = np.zeros(13), arrays

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
        loads, slopes, after = memory.advance(before, approaches, dt)
        out = self._arrays.of_loads(self._state, loads, slopes)
        above = float(np.max(loads)) > self.law.point.highest_load * (1.0 + LOAD_TOLERANCE)
        return Forces(out[0], out[1:7], out[7:], self.law.outside or above), after

    def _approaches(self, pose: npt.ArrayLike, cage_angle: float) -> FloatArray:
        """Approach of all slices (Z, n) [m]."""
        self._state[:6], self._state[12] = six_numbers("pose", pose), cage_angle
        approaches = np.empty((self._arrays.shape.rollers, self._arrays.shape.slices))
        wrong = self._arrays.approaches(self._state, approaches)
        if wrong != 0:
            raise_state(self._state, self._arrays.shape, wrong == NOT_FINITE)
        return approaches


AT_REST = 1e6
"""A step so long that films are in equilibrium at its end [s]."""

NO_COUPLED_MEMORY = "got coupled slices with films that have a memory; allowed: slow films, or slices on their own"


class BearingForce:
    """Force, stiffness and damping of a cylindrical roller bearing.

    Parameters
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    law : DryLaw or ContactLaw
        Law from `mbs.bearings.laws`, or the law "series" of a map made for the same geometry.
    slices : int, optional
        Number of slices; that of the bearing if left out.
    outside : {"error", "clamp", "asymptote"}, optional
        If given, what the law must do outside its map; that is chosen where the law is made, by
        `emap.law("series", outside)`.

    Attributes
    ----------
    coupling : array (slices, slices) or None
        Compliances between slices beside the law [m2/N]; None for slices on their own.

    Raises
    ------
    InputError
        For a law of a single contact, of another geometry or of another policy.

    Notes
    -----
    A call is for one pose; `evaluate` says besides whether it was outside the map. Speed, temperature and centrifugal
    load may change from call to call, which costs some 10 microseconds more, 30 with a centrifugal load; `at` gives the
    element at fixed ones. Both give the same numbers. An object is for one thread.
    """

    def __init__(self, bearing: Bearing, law: Law, slices: int | None = None, outside: str | None = None) -> None:
        if not isinstance(bearing, Bearing):
            raise InputError(f"bearing force, bearing: got {type(bearing).__name__}; allowed: mbs.Bearing")
        self.bearing = bearing if slices is None or slices == bearing.slices else bearing.with_slices(slices)
        _check_law(law, bearing, outside)
        self.law = law
        self.flat_law = FlatLaw(law)
        self.coupling = coupling_beside(self.bearing, law)
        self._work = Arrays(self.bearing, self.coupling)
        self._current: ForceAtPoint | None = None
        self._in_time: ForceInTime | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        """For other processes: as it was made; its arrays are views of each other, which copies would not be."""
        return BearingForce, (self.bearing, self.law)

    def __repr__(self) -> str:
        """Bearing, clearance, slices and law."""
        geometry = self.bearing.geometry
        made = f"clearance {1e6 * geometry.diametral_clearance:.4g} um, {self.bearing.slices} slices"
        return f"<BearingForce {geometry.title}, {made}: {self.law!r}>"

    def at(
        self, entrainment_speed: float = math.nan, temperature: float = math.nan, centrifugal_load: float = 0.0
    ) -> ForceAtPoint:
        """Element at one speed [m/s], temperature [K] and centrifugal load [N/m]; dry laws need none of them.

        Parameters
        ----------
        entrainment_speed : float
            u [m/s].
        temperature : float
            T [K].
        centrifugal_load : float
            Centrifugal load of a roller, per unit length [N/m].

        Raises
        ------
        InputError, OutsideMapError
            As the law does.
        """
        return ForceAtPoint(self.bearing, self.flat_law, (entrainment_speed, temperature, centrifugal_load))

    def __call__(
        self,
        pose: npt.ArrayLike,
        velocity: npt.ArrayLike | None = None,
        *,
        cage_angle: float = 0.0,
        entrainment_speed: float = math.nan,
        temperature: float = math.nan,
        centrifugal_load: float = 0.0,
    ) -> Triple:
        """Force on the inner ring, and its derivatives.

        Parameters
        ----------
        pose, velocity : array (6,)
            Pose and velocity of the inner ring in O [m], [rad], [m/s], [rad/s]; at rest if there is no velocity.
        cage_angle : float
            Angle of the first roller, from y towards z [rad]; see `Bearing.cage_angle`.
        entrainment_speed, temperature : float
            u [m/s] and T [K]; a map's law needs them, see `BearingGeometry.entrainment_speed`.
        centrifugal_load : float
            Centrifugal load of a roller [N/m], see `Bearing.centrifugal_load`; for a map's law only.

        Returns
        -------
        f, K, C : arrays (6,), (6, 6), (6, 6)
            Force and moments [N], [N m] in O about the centre of the inner ring, K = -df/dpose, C = -df/dvelocity.

        Raises
        ------
        InputError
            For values that are no finite numbers, and poses beyond reason.
        OutsideMapError
            Outside the map, where the law has the policy "error".
        """
        return self._prepared(entrainment_speed, temperature, centrifugal_load)(pose, velocity, cage_angle)

    def evaluate(
        self,
        pose: npt.ArrayLike,
        velocity: npt.ArrayLike | None = None,
        *,
        cage_angle: float = 0.0,
        entrainment_speed: float = math.nan,
        temperature: float = math.nan,
        centrifugal_load: float = 0.0,
    ) -> Forces:
        """Force on the inner ring, its derivatives, and whether a slice was outside the map; else as a call.

        Parameters
        ----------
        pose, velocity : array (6,)
            Pose of the inner ring in O [m], [rad], and its rate; at rest if there is no velocity.
        cage_angle : float
            Angle of the first roller [rad].
        entrainment_speed, temperature : float
            u [m/s] and T [K]; a map's law needs them.
        centrifugal_load : float
            Load of a roller [N/m]; for a map's law only.
        """
        return self._prepared(entrainment_speed, temperature, centrifugal_load).evaluate(pose, velocity, cage_angle)

    def advance(
        self,
        state: FilmState | None,
        pose: npt.ArrayLike,
        dt: float,
        *,
        cage_angle: float = 0.0,
        entrainment_speed: float = math.nan,
        temperature: float = math.nan,
        centrifugal_load: float = 0.0,
    ) -> tuple[Forces, FilmState]:
        """A step in time with films that need time to follow: the law is that of `ContactLaw.advance`, slice by slice.

        The force follows from the pose at the end of the step and from the states at its beginning; the velocity has no
        part in it. The state that goes in stays as it is, so that a step may be tried again, at another pose or with
        another length, as often as the solver of the equations of motion asks.

        Parameters
        ----------
        state : FilmState or None
            Films of all slices of all rollers at the beginning of the step; None for films in equilibrium at `pose`.
        pose : array (6,)
            Pose of the inner ring in O at the end of the step [m], [rad].
        dt : float
            Length of the step [s], > 0. The method is of second order while steps grow by no more than a fifth.
        cage_angle : float
            Angle of the first roller at the end of the step, from y towards z [rad].
        entrainment_speed, temperature : float
            u [m/s] and T [K] there; a change from call to call costs some tenths of a millisecond.
        centrifugal_load : float
            Centrifugal load of a roller there [N/m].

        Returns
        -------
        forces : Forces
            Force (6,) on the inner ring, its exact derivative K = -df/dpose (6, 6) at the end of the step, a damping of
            zeros, and whether some slice lies outside the map.
        state : FilmState
            Films at the end of the step, arrays of shape (Z, n); `load` has the loads of the slices [N/m].

        Raises
        ------
        InputError
            For a dry law, for values that are no finite numbers, and as `FilmMemory.advance` does.
        OutsideMapError
            Outside the map, where the law has the policy "error".

        Examples
        --------
        A mass of 20 kg on the bearing under a constant load, by the trapezoidal rule; Newton's method asks for the
        force at several poses, and the last state is kept:

        >>> import numpy as np
        >>> from ehdmaps import Lubricant
        >>> from mbs import Bearing, BearingForce
        >>> from mbs.bearings.laws import formula
        >>> bearing = Bearing.named("NU308", clearance=0.0)
        >>> force = BearingForce(bearing, formula(bearing, Lubricant.named("FVA3")))
        >>> at = {"entrainment_speed": 1.7, "temperature": 313.15}
        >>> mass, load, h = 20.0, np.array([800.0, 0.0]), 1e-5
        >>> pose, v, a, state = np.array([0.0, 1.2e-5, 0.0, 0.0, 0.0, 0.0]), np.zeros(2), np.zeros(2), None
        >>> for _ in range(100):
        ...     begin, known, unknown = pose[1:3].copy(), a, a
        ...     for _ in range(4):
        ...         pose[1:3] = begin + h * v + 0.25 * h * h * (known + unknown)
        ...         forces, trial = force.advance(state, pose, h, **at)
        ...         left = mass * unknown - load - forces.force[1:3]
        ...         slope = mass * np.eye(2) + 0.25 * h * h * forces.stiffness[1:3, 1:3]
        ...         unknown = unknown - np.linalg.solve(slope, left)
        ...     v, a, state = v + 0.5 * h * (known + unknown), unknown, trial
        >>> round(1e6 * float(pose[1]), 1)  # um
        2.5
        """
        in_time = self.in_time(entrainment_speed, temperature, centrifugal_load)
        return in_time.advance(state, pose, dt, cage_angle)

    def in_time(self, entrainment_speed: float, temperature: float, centrifugal_load: float = 0.0) -> ForceInTime:
        """The force in time at one speed, temperature and centrifugal load: that of the last call, or a new one.

        Parameters
        ----------
        entrainment_speed, temperature, centrifugal_load : float
            The same as of `advance`.

        Raises
        ------
        InputError
            For a dry law, and for values that are no finite numbers.
        """
        law = self.law
        if self.bearing.coupled:
            raise InputError(f"bearing force, advance: {NO_COUPLED_MEMORY}")
        if isinstance(law, DryLaw):
            raise InputError(
                f"bearing force, advance: got the law {law.name!r}, which has no films; allowed: the law of a map, or "
                "laws.formula; without films the force of a call holds in time"
            )
        conditions, current = (entrainment_speed, temperature, centrifugal_load), self._in_time
        check_conditions(conditions)
        made = current is not None and conditions == (
            current.law.entrainment_speed,
            current.law.temperature,
            current.law.centrifugal_load,
        )
        if not made:
            self._in_time = None
            self._in_time = ForceInTime(law.at(*conditions), self._work)
        assert self._in_time is not None
        return self._in_time

    def rollers(
        self,
        pose: npt.ArrayLike,
        velocity: npt.ArrayLike | None = None,
        *,
        cage_angle: float = 0.0,
        entrainment_speed: float = math.nan,
        temperature: float = math.nan,
        centrifugal_load: float = 0.0,
    ) -> RollerLoads:
        """Loads and approaches of all rollers and slices, to look at.

        Parameters
        ----------
        pose, velocity : array (6,)
            Pose and velocity of the inner ring in O [m], [rad], [m/s], [rad/s]; at rest if there is no velocity.
        cage_angle : float
            Angle of the first roller, from y towards z [rad].
        entrainment_speed, temperature : float
            u [m/s] and T [K]; a map's law needs them.
        centrifugal_load : float
            Centrifugal load of a roller [N/m]; for a map's law only.
        """
        point = self._prepared(entrainment_speed, temperature, centrifugal_load)
        return point.rollers(pose, velocity, cage_angle)

    def rings(
        self,
        inner: RingState,
        outer: RingState,
        *,
        cage_angle: float = 0.0,
        entrainment_speed: float = math.nan,
        temperature: float = math.nan,
        centrifugal_load: float = 0.0,
        outer_spin: float = 0.0,
        outer_spin_rate: float = 0.0,
    ) -> RingForces:
        """Forces and moments on both rings, wherever they are in space, with their derivatives.

        Parameters
        ----------
        inner, outer : RingState
            Positions and velocities of the rings.
        cage_angle, entrainment_speed, temperature, centrifugal_load
            The same as for a call.
        outer_spin, outer_spin_rate : float
            How far frame O lags behind the outer ring's body about its axis, because O does not spin [rad], [rad/s];
            zero for a ring that does not turn, see `mbs.bearings.bearing.spin`.
        """
        point = self._prepared(entrainment_speed, temperature, centrifugal_load)
        return ring_forces(
            lambda pose, velocity: point(pose, velocity, cage_angle), inner, outer, outer_spin, outer_spin_rate
        )

    def deviate(self, added: FloatArray | None) -> None:
        """Add approaches to the rollers, see `mbs.model.elements.OnRings.deviate`.

        Parameters
        ----------
        added : array (Z, 2, 2) or None
            Approaches and rates of both contacts.
        """
        self._work.shape.put(added=added)

    def _prepared(self, entrainment_speed: float, temperature: float, centrifugal_load: float) -> ForceAtPoint:
        """The element at this point: the one of the last call, or a new law in its place."""
        current = self._current
        if current is not None and (
            (isinstance(self.law, DryLaw) and centrifugal_load == 0.0)
            or current.conditions == (entrainment_speed, temperature, centrifugal_load)
        ):
            return current
        self._current = None
        conditions = (entrainment_speed, temperature, centrifugal_load)
        self._current = ForceAtPoint(self.bearing, self.flat_law, conditions, self._work)
        return self._current


def _check_law(law: Law, bearing: Bearing, outside: str | None) -> None:
    """Refuse a law that does not belong to the bearing."""
    problems = Problems(law_problems("bearing force, law", law, bearing, "series"))
    if outside is not None and not (problems or isinstance(law, DryLaw)) and outside != law.outside:
        problems.append(
            f"bearing force, outside: got {outside!r} with a law made with {law.outside!r}; allowed: what the law has; "
            f"make it by emap.law('series', outside={outside!r})"
        )
    problems.check()
