"""Force of a bearing that carries axial load, by the pose of its inner ring: what its kinds have in common.

Pose and signs are those of `mbs.bearings.bearing`, with x: x, y, z, and the tilts theta_y = -n_z, theta_z = n_y of the
inner ring's axis n in the frame O of the outer ring; theta_x has no force. Quasi-static: each rolling element is in
balance at the speeds of the rings, and has no inertia against small motions beside its centrifugal load and gyroscopic
moment. A kind is balls, or rollers with ribs; its balance is in C.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.solids import Material
from mbs.model.findings import CARRIES, Cause, Finding

if TYPE_CHECKING:
    from mbs.life import ReferenceLife

LAST = 16
"""Numbers that `LocatingForce.works` keeps of a rolling element: `EHD_PAIR_LAST`."""

BY_RATES = 8
"""Numbers of the effect that rates of deviations have, `EHD_PAIR_BY_RATES`: force on the inner ring (6,) [N], [N m];
what dampers dissipate by them alone, and the power of the loads at rest [W]."""

FASTEST = 2e4
"""Largest accepted speed of a ring [rad/s]; 1e5 rpm is half of it."""

NOT_FINITE, TOO_FAR, NO_BALANCE = -1, -2, -3
"""What functions in C find instead of an answer."""


@dataclass(frozen=True, eq=False)
class Loads:
    """State of all rolling elements at one pose; kinds inherit from it.

    Attributes
    ----------
    angle : array (Z,)
        Angles of the elements in O, from y towards z, within -pi to pi [rad].
    load : array (2 or more, Z)
        Loads, first of the inner contact, then of the outer one [N].
    """

    angle: FloatArray
    load: FloatArray

    @property
    def loaded(self) -> int:
        """Number of elements that carry more than 1 % of the highest inner load: films that hardly touch carry some."""
        return int(np.count_nonzero(self.load[0] > CARRIES * self.load[0].max()))

    @property
    def largest(self) -> float:
        """Load of the most loaded contact, in the unit of its law: [N], or [N/m] of slices."""
        return float(self.load.max())

    def life(self, geometry: Any, inner_turns: bool) -> ReferenceLife:
        """Equivalent load and life of ISO/TS 16281, by the rating of ISO 281.

        Parameters
        ----------
        geometry : BallGeometry or TaperedGeometry
            Geometry of the bearing.
        inner_turns : bool
            Whether the inner ring turns against the load.
        """
        raise NotImplementedError


class Settled(NamedTuple):
    """A bearing at a pose.

    Attributes
    ----------
    force : LocatingForce
        The force with the films of the speed, after a call at the pose.
    pose : array, shape (6,)
        Pose of the inner ring in the outer one [m, rad].
    conditions : dict
        Angle of the cage [rad] and speeds [rad/s], by the names that the force takes.
    loads : Loads
        State of its rolling elements.
    """

    force: Any
    pose: FloatArray
    conditions: dict[str, float]
    loads: Any

    @property
    def speeds(self) -> tuple[float, float]:
        """Speeds of the inner and the outer ring [rad/s]."""
        return self.conditions["inner_speed"], self.conditions["outer_speed"]


def later(module: str, name: str) -> Callable[..., Any]:
    """Make a method of a kind, whose module of `mbs.bearings` is loaded when it is called: runs do not need it.

    Parameters
    ----------
    module, name : str
        Module and name of the function, which takes the force first.
    """

    def called(self: LocatingForce, *given: Any) -> Any:
        return getattr(import_module(f"mbs.bearings.{module}"), name)(self, *given)

    return called


class LocatingForce:
    """Force, stiffness and damping of a bearing that carries axial load; kinds inherit from it, and are rows by that.

    Attributes
    ----------
    rolling_element : str
        How one of its rolling elements is called: ball, roller.
    geometry : BallGeometry or TaperedGeometry
        Geometry of the bearing; its `kind` is named in messages.
    material : Material
        Material of elements and rings.
    shape : BallShape or TaperedShape
        Lengths of the bearing.
    angles : array (Z,)
        Angles of the elements in the cage [rad].
    film_loads : (float, float)
        Loads of a rolling element from which and up to which its films were made [N]; zero and infinity where it is
        dry.
    held : array (Z, 2, rows, n) or None
        Memory of films over a step, see `mbs.bearings.locating.film_memory`; None without one.
    dry_law : LocatingForce.with_films takes it
        Law where nothing rolls.
    same_films : object
        Key of its contacts, whatever its clearance, and which way it stands.
    of_points : bool
        Whether contacts are points, else lines in slices.
    slices : int
        Slices of a contact, 1 of points.
    shorter : tuple of float
        Times of the springs of a contact with memory over the longest, see `mbs.bearings.locating.film_memory`.
    gauge : callable
        Loads at rest to what its contacts feel, `mbs.model.findings.Gauge`.
    felt : callable
        Loads at rest, films over the speed or None, and speeds of the rings [rad/s] to pressures and films of contacts,
        and the loss of rolling, see `OnRings.felt`.
    relaxation : callable
        Loads at rest and their conditions to the `Relaxation` of its films.
    condensed : callable
        The same, and whether films have a memory, to its rolling elements for small motions, `Condensed`; None without
        films, or without a load.

    Notes
    -----
    An object is for one thread: it keeps the places of the elements as a start for the next call.
    """

    rolling_element: ClassVar[str]
    of_points: ClassVar[bool] = False
    shorter: ClassVar[tuple[float, ...]]
    gauge: ClassVar[Callable[..., Any]]
    felt: ClassVar[Callable[..., Any]]
    relaxation: ClassVar[Callable[..., Any]]
    condensed: ClassVar[Callable[..., Any]]
    slices: int = 1
    dry_law: Any
    same_films: Any
    geometry: Any
    material: Material
    shape: Any
    angles: FloatArray
    film_loads: tuple[float, float]
    held: Any
    _data: Any
    _deviates = False

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
            Angle of the first element, from y towards z [rad].
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        cage_speed : float, optional
            Speed of a cage that holds all elements [rad/s]; that of rolling if left out, of each ball its own.

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
            Where the balance of an element is not found.
        """
        found = self._evaluated(pose, cage_angle, inner_speed, outer_speed, cage_speed)
        force, stiffness, damping = (array.copy() for array in found)
        if velocity is not None:
            rate = self._six(velocity, "velocity")
            if not np.all(np.isfinite(rate)):
                raise InputError(f"{self.geometry.kind}, velocity: got {rate.tolist()}; allowed: finite numbers")
            force -= damping @ rate
        if self._deviates:
            force += self.by_rates[:6]
        return force, stiffness, damping

    def loads(
        self,
        pose: npt.ArrayLike,
        *,
        cage_angle: float = 0.0,
        inner_speed: float = 0.0,
        outer_speed: float = 0.0,
        cage_speed: float | None = None,
    ) -> Any:
        """Loads and places of all elements, `Loads`; arguments and errors as of a call.

        Parameters
        ----------
        pose : array (6,)
            Pose of the inner ring in O.
        cage_angle, inner_speed, outer_speed, cage_speed : float
            Angle of the cage [rad] and speeds [rad/s].
        """
        self._evaluated(pose, cage_angle, inner_speed, outer_speed, cage_speed)
        idle = self.geometry.cage_speed(inner_speed, outer_speed) if cage_speed is None else cage_speed
        return self._loads(np.angle(np.exp(1j * (self.angles + cage_angle))), float(idle))

    def _loads(self, angle: FloatArray, idle: float) -> Loads:
        """Loads after a call, with the angles of the elements, and the speed of a cage whose elements are idle."""
        raise NotImplementedError

    def speed_loads(
        self, inner_speed: float, outer_speed: float = 0.0, cage_speed: float | None = None
    ) -> tuple[float, float]:
        """Centrifugal load of an element [N], and what makes its gyroscopic moment [N m].

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        cage_speed : float, optional
            Speed of the element around the axis [rad/s]; that of pure rolling at the nominal angle if left out.

        Raises
        ------
        InputError
            For speeds that are no finite numbers, or beyond `FASTEST`.
        """
        raise NotImplementedError

    def with_films(self, films: Any) -> Self:
        """The same bearing with other laws of its contacts.

        Parameters
        ----------
        films : BallLaw or LineFilms
            The laws.
        """
        raise NotImplementedError

    @property
    def ratings(self) -> tuple[float, float]:
        """C of ISO 281 and C0 of ISO 76 by the inner geometry [N]."""
        raise NotImplementedError

    @property
    def contacts(self) -> tuple[int, int, int]:
        """Contacts of all elements: Z, 2, and slices of each."""
        return self.angles.size, 2, self.slices

    def deviate(self, added: FloatArray | None) -> None:
        """Add approaches to the elements, see `mbs.model.elements.OnRings.deviate`; `by_rates` has what rates do.

        Parameters
        ----------
        added : array (Z, 2, 2) or None
            Approaches and rates of both contacts.
        """
        self._deviates = added is not None
        self._data.put(added=added)
        if self._deviates:
            self._data.put(by_rates=np.zeros(BY_RATES))

    @property
    def by_rates(self) -> FloatArray:
        """Effect of the rates of deviations at the last call that had some, `BY_RATES` numbers."""
        found: FloatArray = self._data.given("by_rates")
        return found

    def go_on(self, memory: FloatArray) -> None:
        """Bring films with memory to the end of a step, at which the last call was.

        Parameters
        ----------
        memory : array (Z, 2, rows, n)
            Memory of all contacts over the step, see `mbs.bearings.locating.film_memory`; written.
        """
        raise NotImplementedError

    def beyond(self, pose: FloatArray) -> bool:
        """Tell whether the inner ring is where it has no raceway, however near.

        Parameters
        ----------
        pose : array (6,)
            Pose of the inner ring in the outer one.
        """
        return False

    def forget(self) -> None:
        """Drop the places of the elements after the last call, so that the next one is as the first.

        Kinds that keep none have nothing to drop.
        """

    @property
    def last_loads(self) -> FloatArray:
        """Loads of the inner and the outer contacts after the last call, shape (2, Z) [N]."""
        raise NotImplementedError

    @property
    def last_rows(self) -> FloatArray:
        """Numbers of all elements after the last call, (Z, ...); loads, where a kind keeps no others."""
        return self.last_loads.T

    def works(self, speeds: tuple[float, float], last: FloatArray) -> tuple[float, float]:
        """Works since the last call [J]: of centrifugal loads and gyroscopic moments, and of what memory adds to loads.

        Parameters
        ----------
        speeds : (float, float)
            Speeds of the rings [rad/s].
        last : array (Z, LAST)
            What is kept of the last call; written.
        """
        raise NotImplementedError

    def stored(self, rows: FloatArray) -> float:
        """Energy of its contacts at rest [J].

        Parameters
        ----------
        rows : array (Z, ...)
            Numbers of all elements, see `last_rows`.
        """
        raise NotImplementedError

    def reach_of(self, load: FloatArray) -> Finding | None:
        """Contacts that matter whose loads have no film; machines tell of theirs by `Forces.outside`.

        Parameters
        ----------
        load : array (2, Z)
            Loads of the inner and the outer contacts [N].
        """
        low, high = self.film_loads
        largest = float(load.max())
        light = int(np.count_nonzero((load < low) & (load > CARRIES * largest)))
        if largest <= high and not light:
            return None
        words = (
            f"films are known from {low:.3g} to {high:.4g} N; contacts carry up to {largest:.4g} N, and {light} less "
            "than that: their films go on along straight lines in the logarithms"
        )
        return Finding(Cause.REACH if largest > high else Cause.FILM, words, excess=max(largest / high, 1.0))

    def _evaluated(
        self, pose: npt.ArrayLike, cage_angle: float, inner_speed: float, outer_speed: float, cage_speed: float | None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Force, stiffness and damping by C; the arrays are overwritten by the next call."""
        raise NotImplementedError

    def _cage_of(self, inner_speed: float, outer_speed: float, cage_speed: float | None) -> float:
        """Speed of the cage that is given, or of pure rolling [rad/s]."""
        cage = float(self.geometry.cage_speed(inner_speed, outer_speed) if cage_speed is None else cage_speed)
        if not all(abs(speed) <= FASTEST for speed in (inner_speed, outer_speed, cage)):
            raise InputError(
                f"{self.geometry.kind}, speeds: got {inner_speed!r} and {outer_speed!r} of the rings, {cage!r} rad/s "
                f"of the cage; allowed: finite numbers, at most {FASTEST:g} rad/s either way"
            )
        return cage

    def _six(self, values: npt.ArrayLike, name: str) -> FloatArray:
        """Six numbers."""
        try:
            array = np.ascontiguousarray(values, dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError(f"{self.geometry.kind}, {name}: got {values!r:.80}; allowed: six real numbers") from None
        if array.shape != (6,):
            raise InputError(f"{self.geometry.kind}, {name}: got an array of shape {array.shape}; allowed: (6,)")
        return array

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
        raise AnalysisError(
            f"{kind} {self.geometry.name}: no balance of a {self.rolling_element} was found at {pose.tolist()}"
        )


def directions(count: int) -> FloatArray:
    """Angles of elements that stand evenly in their cage, (count,) [rad].

    Parameters
    ----------
    count : int
        How many there are.
    """
    return 2.0 * math.pi * np.arange(count) / count
