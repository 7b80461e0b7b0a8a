"""The bearing force element: from the pose and velocity of the inner ring to force, stiffness and damping.

Frame O is the one of the outer ring, x axial. A pose is (x, y, z, theta_x, theta_y, theta_z) of the inner ring in O,
its velocity the rate of that; the force is conjugate to it. Neither x nor theta_x has a stiffness: what holds a ring
axially is another element. Spins, cage angle, entrainment speed, temperature and centrifugal load are given beside, and
are held fixed in the derivatives.

Each slice of each roller carries w(delta, rate) times its length, w the law of the roller between both raceways: no
slice knows of its neighbours (the alternative slicing technique of ISO 16281 is left out). Slip and traction, contacts
with the cage and with the ribs are left out too. An EHD law takes the contacts as fully flooded all round: without
clearance the films of the unloaded side preload the bearing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ehdmaps.errors import InputError
from ehdmaps.maps.law import ContactLaw
from mbs.bearings.bearing import Bearing
from mbs.bearings.force_at_point import Arrays, FlatLaw, ForceAtPoint, Triple
from mbs.bearings.kinematics import RingState
from mbs.bearings.laws import DryLaw, Law
from mbs.bearings.ring_forces import RingForces, ring_forces
from mbs.bearings.roller_loads import RollerLoads
from mbs.model.elements import Forces

_ALIKE = 1e-6


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

    Raises
    ------
    InputError
        For a law of a single contact, of another geometry or of another policy.

    Notes
    -----
    A call is for one pose; `evaluate` says besides whether it was outside the map. Speed, temperature and centrifugal
    load may change from call to call, which costs tens of microseconds more; `at` gives the element at fixed ones. Both
    give the same numbers. For speeds between zero and the lowest mapped one the law itself is called for each slice,
    which is slower. An object is for one thread.
    """

    def __init__(self, bearing: Bearing, law: Law, slices: int | None = None, outside: str | None = None) -> None:
        if not isinstance(bearing, Bearing):
            raise InputError(f"bearing force, bearing: got {type(bearing).__name__}; allowed: mbs.Bearing")
        self.bearing = bearing if slices is None or slices == bearing.slices else bearing.with_slices(slices)
        _check_law(law, bearing, outside)
        self.law = law
        self.flat_law = FlatLaw(law)
        self._work = Arrays(self.bearing)
        self._current: ForceAtPoint | None = None

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
            zero for a ring that does not turn, see `mbs.bearings.kinematics.spin`.
        """
        point = self._prepared(entrainment_speed, temperature, centrifugal_load)
        return ring_forces(
            lambda pose, velocity: point(pose, velocity, cage_angle), inner, outer, outer_spin, outer_spin_rate
        )

    def rolling_average(
        self,
        pose: npt.ArrayLike,
        velocity: npt.ArrayLike | None = None,
        *,
        angles: int = 32,
        entrainment_speed: float = math.nan,
        temperature: float = math.nan,
        centrifugal_load: float = 0.0,
    ) -> Triple:
        """Mean of force, stiffness and damping over the rolling of the cage by one roller, at a fixed pose.

        Parameters
        ----------
        pose, velocity : array (6,)
            Pose and velocity of the inner ring in O [m], [rad], [m/s], [rad/s]; at rest if there is no velocity.
        angles : int
            Number of cage angles, evenly spaced over a pitch.
        entrainment_speed, temperature : float
            u [m/s] and T [K]; a map's law needs them.
        centrifugal_load : float
            Centrifugal load of a roller [N/m]; for a map's law only.
        """
        if not isinstance(angles, int) or angles < 1:
            raise InputError(f"bearing force, angles: got {angles!r}; allowed: a whole number >= 1")
        point = self._prepared(entrainment_speed, temperature, centrifugal_load)
        pitch = 2.0 * math.pi / self.bearing.geometry.rollers
        parts = [point(pose, velocity, pitch * i / angles) for i in range(angles)]
        f, K, C = (np.asarray(np.mean(part, axis=0)) for part in zip(*parts, strict=True))
        return f, K, C

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
    if isinstance(law, DryLaw):
        if law.kind != "series":
            raise InputError(
                f"bearing force, law {law.name!r}: got the law of a single contact; allowed: that of a roller between "
                "both raceways; leave out `single()`"
            )
        return
    if not isinstance(law, ContactLaw):
        raise InputError(
            f"bearing force, law: got {type(law).__name__}; allowed: a law of mbs.bearings.laws, or the law 'series' "
            "of a map"
        )
    problems: list[str] = []
    if law.kind != "series":
        problems.append(f"bearing force, law: got the law {law.kind!r}; allowed: 'series', both contacts of a roller")
    else:
        problems += _other_geometry(law, bearing)
    if outside is not None and outside != law.outside:
        problems.append(
            f"bearing force, outside: got {outside!r} with a law made with {law.outside!r}; allowed: what the law has; "
            f"make it by emap.law('series', outside={outside!r})"
        )
    if problems:
        raise InputError(problems)


def _other_geometry(law: ContactLaw, bearing: Bearing) -> Sequence[str]:
    """In what the contacts of a law are not those of the bearing."""
    geometry = bearing.geometry
    problems = []
    for contact, radius in zip(law.contacts, (geometry.inner_radius, geometry.outer_radius), strict=True):
        for name, got, wanted in (
            ("radius", contact.radius, radius),
            ("roller_length", contact.roller_length, geometry.roller_length),
        ):
            if got is not None and abs(got - wanted) > _ALIKE * wanted:
                problems.append(
                    f"bearing force, law, contact {contact.name!r}, {name}: got {got:.6g} m; the bearing "
                    f"{geometry.name!r} has {wanted:.6g} m; take a map made for this bearing"
                )
    return problems
