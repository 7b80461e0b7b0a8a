"""A bearing in a system: the bearing force between two places, at the speed and cage angle that the system has.

Films follow at once, or need time: then each slice has a state in runs (`MemoryBearing`).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import NO_COUPLED_MEMORY, BearingForce, brought_by_speed, cage_moment, energy_at_rest
from mbs.bearings.force_at_point import Arrays, RollerLoads
from mbs.bearings.laws import DryLaw
from mbs.bearings.slices import approaches_of_arrays
from mbs.model.elements import ElementDefaults, Excitation, Forces, Operation, Port, Powers
from mbs.model.relaxation import Films, Relaxation

if TYPE_CHECKING:
    from ehdmaps.maps.law import ContactLaw
    from ehdmaps.maps.memory import FilmMemory, FilmState
    from mbs.bearings.roller_contacts import ContactGroup
    from mbs.model.system import System


NO_CENTRIFUGAL = "got 'memory' with centrifugal = true; allowed: films with memory without it, or slow films"

NO_MAP = "none stated: the law is not that of a map"
"""What is said where laws state no errors."""

HARMONICS = 3
"""Multiples of the order of passing rollers that are worth following."""


class RingForce(Protocol):
    """What a `BearingForce` does; a test or a study may put something else in its place."""

    def evaluate(
        self,
        pose: FloatArray,
        velocity: FloatArray,
        *,
        cage_angle: float,
        entrainment_speed: float,
        temperature: float,
        centrifugal_load: float = 0.0,
    ) -> Forces:
        """Force on the inner ring, its stiffness and damping, and whether it lies outside a map."""
        ...


class RingElement(ElementDefaults):
    """What is listed as a bearing: an element whose first six displacements are those of an inner ring.

    `mbs.model.system.System.select` finds bearings by this class; a bearing of your own inherits from it.
    """

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """How its films would relax, whether linear analyses are to see that or not; None without films.

        Parameters
        ----------
        displacement : array, shape (m,)
            Displacements of all ports, at rest [m or rad].
        operation : Operation
            Speed, angle and time.
        """
        return None

    def natural_times(self, displacement: FloatArray, operation: Operation) -> FloatArray:
        """Natural times of the contacts of `film_relaxation`, in its order, shape (r,) [s]; none without films.

        Parameters
        ----------
        displacement, operation
            The same as for `film_relaxation`.
        """
        return np.zeros(0)

    @property
    def error_words(self) -> str:
        """Which errors its law states, for people; empty for laws that state none."""
        return ""

    def contact_groups(self, displacement: FloatArray, operation: Operation) -> tuple[ContactGroup, ...]:
        """Its slices by the law that they have, at rest; none without films.

        Parameters
        ----------
        displacement, operation
            The same as for `film_relaxation`.
        """
        return ()


@dataclass(frozen=True, eq=False)
class BearingElement(RingElement):
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
        Temperature of the raceways [K].
    inner_spin, outer_spin : float
        Speeds of the rings as multiples of the system's.
    start_angle : float
        Angle of the first roller from y at the beginning [rad].
    centrifugal : bool
        Whether the rollers' centrifugal load is taken into account.
    films : {"slow", "memory"}
        Whether small oscillations see the films of slow motion at any frequency, or films that relax.
    tilts : bool
        Whether its rings may tilt against each other; runs in time feel less, and compute less, where they cannot.

    Raises
    ------
    InputError
        For films with memory and a centrifugal load, or slices that are coupled.
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
    tilts: bool = True

    def __post_init__(self) -> None:
        if self.films == "memory" and self.centrifugal:
            raise InputError(f"bearing {self.name!r}, films: {NO_CENTRIFUGAL}")
        if self.films == "memory" and self.bearing.coupled:
            raise InputError(f"bearing {self.name!r}, films: {NO_COUPLED_MEMORY}")

    @property
    def ports(self) -> tuple[Port, ...]:
        """Displacement of the inner ring against the outer one."""
        return (Port(self.inner, self.outer),)

    @property
    def excitation(self) -> Excitation | None:
        """The passing of the rollers; None for a cage that stands."""
        order = self.bearing.geometry.rollers * abs(self.rates[0])
        return Excitation(order, HARMONICS, rank=1) if order > 0.0 else None

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
        """See `RingElement.film_relaxation`; with centrifugal load the times are those without it, as an estimate."""
        if not isinstance(self.force, BearingForce) or isinstance(self.force.law, DryLaw):
            return None
        from mbs.bearings.roller_contacts import bearing_relaxation

        law = self.force.law.at(self.entrainment_speed(operation), self.temperature)
        return bearing_relaxation(law, self.rollers(displacement, operation), self.bearing.slice_length)

    def natural_times(self, displacement: FloatArray, operation: Operation) -> FloatArray:
        """See `RingElement.natural_times`."""
        if not isinstance(self.force, BearingForce) or isinstance(self.force.law, DryLaw):
            return np.zeros(0)
        from mbs.bearings.roller_contacts import natural_times

        law = self.force.law.at(self.entrainment_speed(operation), self.temperature)
        return natural_times(law, self.rollers(displacement, operation).approach).reshape(-1)

    @property
    def error_words(self) -> str:
        """See `RingElement.error_words`."""
        if not isinstance(self.force, BearingForce) or isinstance(self.force.law, DryLaw):
            return ""
        errors = self.force.law.errors
        return "" if errors is None else errors.words

    def contact_groups(self, displacement: FloatArray, operation: Operation) -> tuple[ContactGroup, ...]:
        """See `RingElement.contact_groups`: slices of both contacts in series; none where slices are coupled."""
        if self.bearing.coupled:
            return ()
        if not isinstance(self.force, BearingForce) or isinstance(self.force.law, DryLaw):
            return ()
        from mbs.bearings.roller_contacts import ContactGroup, massless_rows

        u, q = self.entrainment_speed(operation), self.centrifugal_load(operation)
        rollers = self.rollers(displacement, operation)
        law, length = self.force.law.at(u, self.temperature, q), self.bearing.slice_length
        relaxes = self.films == "memory"
        return (ContactGroup(law, massless_rows(rollers), rollers.approach.reshape(-1), length, relaxes),)

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Force on the inner ring, stiffness and damping, see `Element.evaluate`."""
        return self.force.evaluate(
            displacement,
            velocity,
            cage_angle=self.cage_angle(operation),
            entrainment_speed=self.entrainment_speed(operation),
            temperature=self.temperature,
            centrifugal_load=self.centrifugal_load(operation),
        )

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers | None:
        """What its contacts dissipate, and what the turning of the cage brings in, see `Element.powers`."""
        if not isinstance(self.force, BearingForce):
            return None
        at_rest = self.evaluate(displacement, np.zeros(6), operation).force
        torque = cage_moment(at_rest, displacement, 1)
        return Powers(-float((force - at_rest) @ velocity), torque * self.rates[0] * operation.speed)

    def stored(self, states: Any, displacement: FloatArray, operation: Operation) -> float | None:
        """Energy of its contacts at rest [J]: the integral of their loads over the approach; see `Element.stored`."""
        if not isinstance(self.force, BearingForce):
            return None
        conditions = self.entrainment_speed(operation), self.temperature, self.centrifugal_load(operation)
        rollers = self.rollers(displacement, operation)
        energy = energy_at_rest(self.force.law, conditions, self.bearing, rollers.approach)
        coupling = self.force.coupling
        if coupling is None:
            return energy
        w = rollers.load_per_length
        return energy + 0.5 * self.bearing.slice_length * float(np.sum((w @ coupling) * w))

    def brought_by_speed(self, displacements: FloatArray, operations: Sequence[Operation]) -> float:
        """Energy that changes of the speed brought into its films, see `mbs.bearings.bearing_force`."""
        if not isinstance(self.force, BearingForce):
            return 0.0
        conditions = [(self.entrainment_speed(op), self.temperature, self.centrifugal_load(op)) for op in operations]
        if self.bearing.coupled:

            def own(sample: int) -> FloatArray:
                return self.rollers(displacements[sample], operations[sample]).approach

            return brought_by_speed(self.force.law, self.force.bearing, conditions, own)

        work, state = Arrays(self.force.bearing), np.zeros(13)
        shape = np.array(work.sizes), work.slices, work.angles

        def approaches(sample: int) -> FloatArray:
            found = np.empty(work.rows.shape)
            state[:6], state[12] = displacements[sample], self.cage_angle(operations[sample])
            approaches_of_arrays(state, *shape, found)
            return found

        return brought_by_speed(self.force.law, self.force.bearing, conditions, approaches)


def error_words(system: System) -> str:
    """What is in the bands of a system, for people; empty without bearings."""
    bearings = [system.elements[index].element for index in system.select(RingElement)]
    if not bearings:
        return ""
    words = {element.error_words for element in bearings if isinstance(element, RingElement)}
    return NO_MAP if "" in words else "; ".join(sorted(words))


def ring_matrices(stiffness: FloatArray, damping: FloatArray) -> tuple[FloatArray, FloatArray]:
    """K and C (6, 6) of the inner ring against the outer one from those of an element in its ports.

    Rollers that are bodies follow in equilibrium; those without load are left where they are.

    Parameters
    ----------
    stiffness, damping : array, shape (6, 6) or (12 + Z, 12 + Z)
        Matrices of massless rollers, or of rings and rollers.
    """
    following = ring_following(stiffness)
    return following.T @ stiffness @ following, following.T @ damping @ following


def ring_following(stiffness: FloatArray) -> FloatArray:
    """How the ports of an element follow the inner ring, the outer one being held, shape (m, 6).

    Parameters
    ----------
    stiffness : array, shape (6, 6) or (12 + Z, 12 + Z)
        Matrix of massless rollers, or of rings and rollers.
    """
    if stiffness.shape[0] == 6:
        return np.eye(6)
    own = stiffness[12:, 12:]
    following = np.zeros((stiffness.shape[0], 6))
    following[:6] = np.eye(6)
    loaded = np.nonzero(np.diag(own) > 0.0)[0]
    following[12 + loaded] = -np.linalg.solve(own[np.ix_(loaded, loaded)], stiffness[12 + loaded, :6])
    return following


class FilmStates(NamedTuple):
    """States of a bearing's films after a step.

    Attributes
    ----------
    films : FilmState
        Films of all slices of all rollers, shape (Z, n).
    time : float
        End of the step [s].
    before : FilmState or None
        Films at its beginning; None where that is not known.
    """

    films: FilmState
    time: float
    before: FilmState | None = None


@dataclass(frozen=True, eq=False)
class MemoryBearing(BearingElement):
    """A bearing whose films have a memory in time, see `ehdmaps.maps.memory_table`.

    At rest it is the `BearingElement` with the same force; small oscillations see films that relax.

    Raises
    ------
    InputError
        With a force that has no contact law with films, or with centrifugal loads: such films have no memory.
    """

    films: Films = "memory"

    def __post_init__(self) -> None:
        BearingElement.__post_init__(self)
        if not isinstance(self.force, BearingForce) or isinstance(self.force.law, DryLaw):
            raise InputError(
                f"bearing {self.name!r}, films: got 'memory' with a law without films; allowed: laws map and formula"
            )

    @property
    def law(self) -> ContactLaw:
        """The law of a roller between both raceways."""
        assert isinstance(self.force, BearingForce) and not isinstance(self.force.law, DryLaw)
        return self.force.law

    def advance(
        self, states: FilmStates | None, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, FilmStates]:
        """A step in time up to the time of `operation`, as `ContactLaw.advance` for all slices.

        Parameters
        ----------
        states : FilmStates or None
            States after the last step; None for films in equilibrium.
        displacement, velocity : array, shape (6,)
            Motion of the inner ring against the outer one at the end of the step; the rates have no effect.
        operation : Operation
            Speed, angle and time there.

        Raises
        ------
        InputError, OutsideMapError
            As the law does.
        """
        assert isinstance(self.force, BearingForce)
        forces, films = self.force.advance(
            None if states is None else states.films,
            displacement,
            _AT_REST if states is None else operation.time - states.time,
            cage_angle=self.cage_angle(operation),
            entrainment_speed=self.entrainment_speed(operation),
            temperature=self.temperature,
            centrifugal_load=self.centrifugal_load(operation),
        )
        # A run begins with films that have not moved yet.
        if states is None:
            return forces, FilmStates(dataclasses.replace(films, step=0.0), operation.time)
        return forces, FilmStates(films, operation.time, states.films)

    def powers(
        self,
        states: FilmStates,
        force: FloatArray,
        displacement: FloatArray,
        velocity: FloatArray,
        operation: Operation,
    ) -> Powers:
        """What its films take up, and what the turning of the cage brings in, see `Element.powers`."""
        driven, spent = cage_moment(force, displacement, 1) * self.rates[0] * operation.speed, 0.0
        if states.before is not None:
            spent = float(np.sum(self._memory(operation).spent(states.before, states.films)))
        return Powers(0.0, driven, spent * self.bearing.slice_length)

    def stored(self, states: FilmStates, displacement: FloatArray, operation: Operation) -> float:
        """Energy of its contacts [J]: of the solids and of the films that follow; see `Element.stored`."""
        return float(np.sum(self._memory(operation).stored(states.films))) * self.bearing.slice_length

    def _memory(self, operation: Operation) -> FilmMemory:
        """The law with memory at the speed."""
        assert isinstance(self.force, BearingForce)
        conditions = self.entrainment_speed(operation), self.temperature, self.centrifugal_load(operation)
        return self.force.in_time(*conditions).law.memory


_AT_REST = 1e6
"""A step so long that films are in equilibrium at its end [s]."""
