"""One bearing that carries axial load at an operating point: where its inner ring comes to rest.

The outer ring is held in its place, the inner one moves along x, y and z, and tilts if it may. A kind has its own
pressures and films there: `LocatingPoint.own`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import written
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.locating.locating_force import Settled
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.findings import RingPoint
from mbs.model.system import System

RING, TURNING = "inner ring", Operation(1.0)
"""The ring; speeds are those of the rings at a speed of the system of one."""


class Course(NamedTuple):
    """Conditions of a point, beside the state of its rolling elements.

    Attributes
    ----------
    speeds : (float, float)
        Speeds of the inner and the outer ring [rad/s].
    oil : Lubricant or None
        Oil of the films; no films without one.
    temperature : float
        Temperature of the raceways, and so of the oil [K].
    films : BallFilms or None
        Films that were solved, in place of those of formulas.
    """

    speeds: tuple[float, float]
    oil: Lubricant | None
    temperature: float
    films: Any


@dataclass(frozen=True, eq=False, kw_only=True)
class LocatingPoint(RingPoint):
    """A bearing that carries axial load in equilibrium; kinds inherit from it.

    Attributes
    ----------
    force : LocatingForce
        Geometry and laws.
    pressure, central_film, minimum_film : array (2, Z)
        Largest Hertz pressure [Pa] and smallest films [m] of the inner and outer contacts; NaN for films of contacts
        without load, or without an oil.
    """

    force: Any
    pressure: FloatArray
    central_film: FloatArray
    minimum_film: FloatArray

    @classmethod
    def at(
        cls,
        force: Any,
        load: Sequence[float],
        inner_speed: float,
        outer_speed: float = 0.0,
        *,
        tilts: bool = False,
        oil: Lubricant | None = None,
        temperature: float = 313.15,
        films: Any = None,
    ) -> Self:
        """Equilibrium of a bearing.

        Parameters
        ----------
        force : LocatingForce
            Geometry and laws.
        load : (float, float, float)
            Load on the inner ring, x, y and z [N]; x with the sign of the contact angle, or as ribs carry it.
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        tilts : bool
            Whether the inner ring tilts freely, without a moment; else it is held.
        oil : Lubricant, optional
            Oil of the films; no films without one.
        temperature : float
            Temperature of the raceways, and so of the oil [K].
        films : BallFilms, optional
            Films that were solved, in place of those of formulas.

        Raises
        ------
        InputError
            For loads that are no finite numbers, or all zero.
        AnalysisError
            Where no equilibrium is found.
        """
        given, speeds = ring_load(load), (inner_speed, outer_speed)
        element = LocatingElement("bearing", RING, "ground", force, *speeds)
        free = ["x", "y", "z", "theta_y", "theta_z"] if tilts else ["x", "y", "z"]
        ring = rigid_body(RING, [Inertia(1.0, 1.0, 1.0)], free)
        system = System([ring], loads=[Load("load", RING, np.array([*given, 0.0, 0.0, 0.0]))], elements=[element])
        start = cls.start(force, given)
        begin = None if start is None else np.concatenate([start, np.zeros(len(free) - 3)])
        try:
            balance = equilibrium(system, TURNING, begin)
        except AnalysisError as error:
            under = f"{written(given[0])} N axial, {written(math.hypot(*given[1:]))} N radial"
            words = f"no equilibrium of {force.geometry.name} under {under}{cls.advice(force, given, speeds)}"
            raise AnalysisError(f"{words}: {error.__cause__ or error}") from error
        pose = np.zeros(6)
        pose[[0, 1, 2, 4, 5][: len(free)]] = balance.displacement
        at = element.settled(pose, TURNING)
        return cls(
            force=force,
            load=given,
            inner_speed=inner_speed,
            outer_speed=outer_speed,
            elements=at.loads,
            pose=pose,
            stiffness=balance.element_stiffness[0],
            damping=balance.element_damping[0],
            balance=balance,
            findings=(*force.gauge(at.loads).findings, *filter(None, [force.reach_of(at.loads.load[:2])])),
            **cls.own(at, Course(speeds, oil, temperature, films)),
        )

    @staticmethod
    def start(force: Any, load: FloatArray) -> FloatArray | None:
        """Displacement (3,) of the ring to start from [m]; None for its place without load.

        Parameters
        ----------
        force : LocatingForce
            Geometry and laws.
        load : array (3,)
            Load on the inner ring [N].
        """
        return None

    @staticmethod
    def advice(force: Any, load: FloatArray, speeds: tuple[float, float]) -> str:
        """Advice where there is no equilibrium, to be added to what is said of it.

        Parameters
        ----------
        force, load
            The same as of `start`.
        speeds : (float, float)
            Speeds of the rings [rad/s].
        """
        return ""

    @staticmethod
    def own(at: Settled, course: Course) -> dict[str, Any]:
        """Fields of the kind, by name: pressures, films and what else it has.

        Parameters
        ----------
        at : Settled
            The bearing at rest.
        course : Course
            What else is known.
        """
        raise NotImplementedError

    @property
    def geometry(self) -> Any:
        """Geometry of the bearing."""
        return self.force.geometry

    @property
    def ratings(self) -> tuple[float, float]:
        """C of ISO 281 and C0 of ISO 76 by the inner geometry [N]."""
        ratings: tuple[float, float] = self.force.ratings
        return ratings

    @property
    def cage_speed(self) -> float:
        """Speed of the cage, in pure rolling [rad/s]."""
        return float(self.geometry.cage_speed(self.inner_speed, self.outer_speed))

    @property
    def entrainment_speed(self) -> float:
        """Speed of both surfaces against the cage, in pure rolling, in the middle of a roller [m/s]."""
        return float(self.geometry.entrainment_speed(self.inner_speed, self.outer_speed))

    @property
    def centrifugal_load(self) -> float:
        """Centrifugal load of a rolling element [N]."""
        return float(self.force.speed_loads(self.inner_speed, self.outer_speed)[0])

    @property
    def smallest_film(self) -> float:
        """Smallest of all minimum films [m]; NaN where none is known."""
        known = self.minimum_film[np.isfinite(self.minimum_film)]
        return float(known.min()) if known.size else math.nan


def ring_load(load: Sequence[float]) -> FloatArray:
    """Load on a ring, x, y and z [N].

    Parameters
    ----------
    load : (float, float, float)
        The load as it was given.

    Raises
    ------
    InputError
        For loads that are no finite numbers, or all zero.
    """
    given = np.array(load, dtype=np.float64)
    if given.shape != (3,) or not np.all(np.isfinite(given)) or not np.any(given):
        raise InputError(f"bearing point, load: got {load!r} N; allowed: three finite numbers, x, y, z, not all zero")
    return given
