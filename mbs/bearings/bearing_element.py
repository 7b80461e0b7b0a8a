"""A bearing in a system: the bearing force between two places, at the speed and cage angle that the system has."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.maps.law import ContactLaw
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.film_relaxation import Films, bearing_relaxation
from mbs.bearings.roller_loads import RollerLoads
from mbs.model.elements import Operation, Port
from mbs.model.relaxation import Relaxation


class RingForce(Protocol):
    """What a `BearingForce` does; a test or a study may put something else in its place.

    A force without a map has ``outside_calls = 0`` as an attribute of its class.
    """

    @property
    def outside_calls(self) -> int:
        """Calls outside the map so far; 0 for a force that has none."""
        ...

    def __call__(
        self,
        pose: FloatArray,
        velocity: FloatArray,
        *,
        cage_angle: float,
        entrainment_speed: float,
        temperature: float,
        centrifugal_load: float = 0.0,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Force on the inner ring, and its stiffness and damping."""
        ...


@dataclass(frozen=True, eq=False)
class BearingElement:
    """A bearing between an inner and an outer ring.

    Attributes
    ----------
    name : str
        Name for messages and results.
    inner, outer : str
        Places at the middle of the bearing.
    bearing : Bearing
        Geometry and slices.
    force : RingForce
        The force.
    temperature : float
        Temperature of the oil [K].
    inner_spin, outer_spin : float
        Speeds of the rings as multiples of the system's.
    start_angle : float
        Angle of the first roller from y at the beginning [rad].
    centrifugal : bool
        Whether the rollers' centrifugal load is taken into account.
    films : {"slow", "memory"}
        Whether small oscillations see the films of slow motion at any frequency, or films that relax.
    """

    name: str
    inner: str
    outer: str
    bearing: Bearing
    force: RingForce
    temperature: float
    inner_spin: float = 1.0
    outer_spin: float = 0.0
    start_angle: float = 0.0
    centrifugal: bool = False
    films: Films = "slow"

    @property
    def ports(self) -> tuple[Port, ...]:
        """Displacement of the inner ring against the outer one."""
        return (Port(self.inner, self.outer),)

    @property
    def outside_calls(self) -> int:
        """Calls outside the map so far."""
        return self.force.outside_calls

    @cached_property
    def rates(self) -> tuple[float, float, float]:
        """Cage speed and entrainment speed for each speed of the system, centrifugal load for its square."""
        spins = (self.inner_spin, self.outer_spin)
        centrifugal = self.bearing.centrifugal_load(*spins) if self.centrifugal else 0.0
        return self.bearing.cage_angle(*spins), self.bearing.geometry.entrainment_speed(*spins), centrifugal

    def cage_angle(self, operation: Operation) -> float:
        """Angle of the first roller [rad]."""
        return self.start_angle + self.rates[0] * operation.angle

    def entrainment_speed(self, operation: Operation) -> float:
        """Entrainment speed [m/s]."""
        return self.rates[1] * abs(operation.speed)

    def centrifugal_load(self, operation: Operation) -> float:
        """Centrifugal load for each metre of a roller [N/m]; zero where it is left out."""
        return self.rates[2] * operation.speed**2

    def rollers(self, displacement: FloatArray, operation: Operation) -> RollerLoads:
        """Loads of all rollers at rest at the displacement (6,) of the inner ring against the outer one.

        Raises
        ------
        InputError
            If the force is not a `BearingForce`.
        """
        if not isinstance(self.force, BearingForce):
            raise InputError(
                f"bearing {self.name!r}, rollers: got a {type(self.force).__name__} as force; allowed: BearingForce"
            )
        return self.force.rollers(
            displacement,
            cage_angle=self.cage_angle(operation),
            entrainment_speed=self.entrainment_speed(operation),
            temperature=self.temperature,
            centrifugal_load=self.centrifugal_load(operation),
        )

    def relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """How the films relax, where they do, see `Element.relaxation`."""
        return self.film_relaxation(displacement, operation) if self.films == "memory" else None

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """How the films relax; None for laws without films, and for rollers with centrifugal load.

        Parameters
        ----------
        displacement, operation
            As of `relaxation`.
        """
        if not isinstance(self.force, BearingForce) or not isinstance(self.force.law, ContactLaw):
            return None
        if self.centrifugal_load(operation) != 0.0:
            return None
        law = self.force.law.at(self.entrainment_speed(operation), self.temperature)
        return bearing_relaxation(law, self.rollers(displacement, operation), self.bearing.slice_length)

    def evaluate(
        self, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Force on the inner ring, stiffness and damping, see `Element.evaluate`."""
        return self.force(
            displacement,
            velocity,
            cage_angle=self.cage_angle(operation),
            entrainment_speed=self.entrainment_speed(operation),
            temperature=self.temperature,
            centrifugal_load=self.centrifugal_load(operation),
        )
