"""A bearing in a system: the bearing force between two places, at the speed and cage angle that the system has.

Its rollers are massless, with one law of both contacts in series, or bodies between two contacts. Films follow at once,
or need time: then each slice of each side of a contact has a state in runs.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.physics.hertz import LINE_LIMIT, max_pressure
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import NO_COUPLED_MEMORY, BearingForce, brought_by_speed, cage_moment, energy_at_rest
from mbs.bearings.cylinder import Arrays
from mbs.bearings.force_at_point import RollerLoads
from mbs.bearings.laws import DryLaw, FlatLaw
from mbs.model.body import Body
from mbs.model.elements import Excitation, Forces, OnRings, Operation, Port, Powers
from mbs.model.findings import Gauge
from mbs.model.relaxation import Films, Relaxation

if TYPE_CHECKING:
    from ehdmaps.maps.kernels.memory import FilmMemory, FilmState
    from ehdmaps.maps.law import ContactLaw
    from mbs.bearings.roller_contacts import RollerContacts
    from mbs.bearings.slices_in_balance import Side
    from mbs.model.condensed import Condensed
    from mbs.model.system import System


NO_CENTRIFUGAL = "got 'memory' with centrifugal = true; allowed: films with memory without it, or slow films"

NO_MAP = "none stated: the law is not that of a map or a film table"
"""What is said where laws state no errors."""

HARMONICS = 3
"""Multiples of the order of passing rollers that are worth following."""


class RingForce(Protocol):
    """Interface of a `BearingForce`; a test or a study may put something else in its place."""

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


class RingElement(OnRings):
    """Element that is listed as a roller bearing: its first six displacements are those of an inner ring.

    `mbs.model.system.System.select` finds bearings by this class; a bearing of your own inherits from it.

    Attributes
    ----------
    films : {"slow", "memory"}
        Whether small oscillations see the films of slow motion at any frequency, or films that relax.
    """

    films: Films = "slow"

    @property
    def flat_laws(self) -> tuple[FlatLaw, ...]:
        """Law of each side of its contacts: of both in series, or of the inner and the outer one; none if unknown."""
        return ()

    @property
    def film_laws(self) -> tuple[ContactLaw, ...]:
        """The same where all of them have films; else none."""
        laws = tuple(flat.law for flat in self.flat_laws if not isinstance(flat.law, DryLaw))
        return laws if len(laws) == len(self.flat_laws) else ()

    def brought_in(
        self, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> float:
        """Power that the turning of the cage and the centrifugal forces of rollers bring in [W].

        Parameters
        ----------
        force, displacement, velocity, operation
            What `powers` takes; the force is that which the cage feels.
        """
        return 0.0

    def sides(self, displacement: FloatArray, operation: Operation) -> tuple[Side, ...]:
        """Its slices at rest by the law that they have; none without films, and where slices are coupled.

        Parameters
        ----------
        displacement : array, shape (m,)
            Displacements of all ports, at rest [m or rad].
        operation : Operation
            Speed, angle and time.
        """
        return ()

    def small_motions(self, displacement: FloatArray, operation: Operation) -> Condensed | None:
        """See `OnRings.small_motions`: of its `sides`."""
        sides = self.sides(displacement, operation)
        if not sides:
            return None
        from mbs.bearings.slices_in_balance import slices_in_balance

        return slices_in_balance(sides, relaxes=self.films == "memory")


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

    @property
    def flat_laws(self) -> tuple[FlatLaw, ...]:
        """See `RingElement.flat_laws`: that of both contacts in series."""
        return (self.force.flat_law,) if isinstance(self.force, BearingForce) else ()

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

    def conditions(self, operation: Operation) -> dict[str, float]:
        """Angle of the cage, entrainment speed and temperature, by the names that forces take."""
        return {
            "cage_angle": self.cage_angle(operation),
            "entrainment_speed": self.entrainment_speed(operation),
            "temperature": self.temperature,
        }

    def loads(self, displacement: FloatArray, operation: Operation) -> RollerLoads:
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
        conditions, load = self.conditions(operation), self.centrifugal_load(operation)
        return self.force.rollers(displacement, **conditions, centrifugal_load=load)

    @property
    def entrainment_rate(self) -> float:
        """See `OnRings.entrainment_rate`."""
        return self.rates[1]

    def largest_load(self, displacement: FloatArray, operation: Operation) -> float:
        """See `OnRings.largest_load`; NaN of forces that are no `BearingForce`."""
        if not isinstance(self.force, BearingForce):
            return math.nan
        return float(self.loads(displacement, operation).load_per_length.max())

    def element_loads(self, displacement: FloatArray, operation: Operation) -> FloatArray | None:
        """See `OnRings.element_loads`; None of forces that are no `BearingForce`."""
        return self.loads(displacement, operation).load if isinstance(self.force, BearingForce) else None

    def gauge(self, displacement: FloatArray, operation: Operation) -> Gauge | None:
        """See `OnRings.gauge`; None of forces that are no `BearingForce`."""
        if not isinstance(self.force, BearingForce):
            return None
        lines = self.loads(displacement, operation).load_per_length
        sides = lines, np.maximum(lines + self.centrifugal_load(operation), 0.0)
        contacts = self.bearing.geometry.contacts(self.bearing.material, "iso16281")
        pressure = [
            float(max_pressure(float(side.max(initial=0.0)), contact.radius, contact.reduced_modulus))
            for side, contact in zip(sides, contacts, strict=True)
        ]
        load = np.array([side.sum(axis=1) for side in sides]) * self.bearing.slice_length
        return Gauge("roller", load, np.array(pressure), LINE_LIMIT)

    def relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """Relaxation of the films, where they relax, see `Element.relaxation`."""
        return self.film_relaxation(displacement, operation) if self.films == "memory" else None

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """See `OnRings.film_relaxation`; with centrifugal load the times are those without it, as an estimate."""
        if not self.film_laws:
            return None
        from mbs.bearings.slices_in_balance import slice_relaxation

        side, rollers = self._side(displacement, operation)
        return slice_relaxation([side], [rollers.damping * side.length])

    @property
    def error_words(self) -> str:
        """See `OnRings.error_words`."""
        errors = self.film_laws[0].errors if self.film_laws else None
        return "" if errors is None else errors.words

    def sides(self, displacement: FloatArray, operation: Operation) -> tuple[Side, ...]:
        """See `RingElement.sides`: slices of both contacts in series."""
        return () if self.bearing.coupled or not self.film_laws else self._side(displacement, operation)[:1]

    def _side(self, displacement: FloatArray, operation: Operation) -> tuple[Side, RollerLoads]:
        """Slices of both contacts in series, of a law with films, and the rollers."""
        from mbs.bearings.slices_in_balance import massless_side

        u, q = self.entrainment_speed(operation), self.centrifugal_load(operation)
        rollers, law = self.loads(displacement, operation), self.film_laws[0].at(u, self.temperature, q)
        return massless_side(law, rollers, self.bearing.slice_length), rollers

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Force on the inner ring, stiffness and damping, see `Element.evaluate`."""
        conditions, load = self.conditions(operation), self.centrifugal_load(operation)
        return self.force.evaluate(displacement, velocity, **conditions, centrifugal_load=load)

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers | None:
        """Power that its contacts dissipate, and power that the turning of the cage brings in, see `Element.powers`."""
        if not isinstance(self.force, BearingForce):
            return None
        at_rest = self.evaluate(displacement, np.zeros(6), operation).force
        return Powers(-float((force - at_rest) @ velocity), self.brought_in(at_rest, displacement, velocity, operation))

    def brought_in(
        self, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> float:
        """Power of the turning cage, see `RingElement.brought_in`."""
        return cage_moment(force, displacement, 1) * self.rates[0] * operation.speed

    def stored(self, states: Any, displacement: FloatArray, operation: Operation) -> float | None:
        """Energy of its contacts at rest [J]: the integral of their loads over the approach; see `Element.stored`."""
        if not isinstance(self.force, BearingForce):
            return None
        conditions = self.entrainment_speed(operation), self.temperature, self.centrifugal_load(operation)
        rollers = self.loads(displacement, operation)
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
                return self.loads(displacements[sample], operations[sample]).approach

            return brought_by_speed(self.force.law, self.force.bearing, conditions, own)

        arrays, state = Arrays(self.force.bearing), np.zeros(13)

        def approaches(sample: int) -> FloatArray:
            approach = np.empty((arrays.shape.rollers, arrays.shape.slices))
            state[:6], state[12] = displacements[sample], self.cage_angle(operations[sample])
            arrays.approaches(state, approach)
            return approach

        return brought_by_speed(self.force.law, self.force.bearing, conditions, approaches)


def roller_body(name: str, bearing: Bearing) -> Body:
    """The rollers of a bearing as one body, with a radial coordinate [m] for each."""
    count = bearing.geometry.rollers
    zero = np.zeros((count, count))
    return Body(
        name=name,
        coordinates=tuple(f"roller_{index + 1}" for index in range(count)),
        units=("m",) * count,
        mass=bearing.roller_mass * np.eye(count),
        gyroscopic=zero,
        damping=zero,
        stiffness=zero,
    )


@dataclass(frozen=True, eq=False)
class RollerElement(RingElement):
    """A bearing whose rollers are bodies: each has a mass and a radial freedom, between two contacts.

    The radial freedoms are counted in the cage, which turns; what its turning adds to the rollers' motion but the
    centrifugal load is left out, as speeds of vibration are small against it.

    Attributes
    ----------
    plain : BearingElement
        The same bearing with massless rollers: places, speeds, and the loads of rollers to look at.
    contacts : RollerContacts
        The forces.
    rollers : str
        Name of the body of the rollers.
    films : {"slow", "memory"}
        The same as of a `BearingElement`.
    """

    plain: BearingElement
    contacts: RollerContacts
    rollers: str
    films: Films = "slow"

    @property
    def name(self) -> str:
        """For messages and results."""
        return self.plain.name

    @property
    def flat_laws(self) -> tuple[FlatLaw, ...]:
        """See `RingElement.flat_laws`: those of the inner and of the outer contacts."""
        return self.contacts.flat_laws

    @property
    def ports(self) -> tuple[Port, ...]:
        """Inner ring, outer ring, rollers."""
        return Port(self.plain.inner), Port(self.plain.outer), Port(self.rollers, coordinates=True)

    @property
    def excitation(self) -> Excitation | None:
        """The passing of the rollers."""
        return self.plain.excitation

    def element_loads(self, displacement: FloatArray, operation: Operation) -> FloatArray | None:
        """See `OnRings.element_loads`: those of rollers that follow in equilibrium."""
        return self.plain.element_loads(ring_motion(displacement), operation)

    def gauge(self, displacement: FloatArray, operation: Operation) -> Gauge | None:
        """See `OnRings.gauge`: that of rollers that follow in equilibrium."""
        return self.plain.gauge(ring_motion(displacement), operation)

    def relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """Relaxation of the films of both contacts, where they relax, see `Element.relaxation`."""
        return self.film_relaxation(displacement, operation) if self.films == "memory" else None

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """See `OnRings.film_relaxation`."""
        sides = self.sides(displacement, operation)
        if not sides:
            return None
        from mbs.bearings.slices_in_balance import slice_relaxation

        return slice_relaxation(sides)

    @property
    def entrainment_rate(self) -> float:
        """See `OnRings.entrainment_rate`."""
        return self.plain.entrainment_rate

    @property
    def error_words(self) -> str:
        """See `OnRings.error_words`."""
        return self.plain.error_words

    def sides(self, displacement: FloatArray, operation: Operation) -> tuple[Side, ...]:
        """See `RingElement.sides`: slices of the inner contacts, and of the outer ones."""
        return self.contacts.sides(displacement, **self.plain.conditions(operation))

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Forces on rings and rollers, stiffness and damping, see `Element.evaluate`."""
        forces = self.contacts.evaluate(displacement, velocity, **self.plain.conditions(operation))
        forces.force[12:] += self.outward(operation)
        return forces

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers:
        """Power that its contacts dissipate; power that cage and centrifugal forces bring in, see `Element.powers`."""
        at_rest = self.evaluate(displacement, np.zeros_like(velocity), operation).force
        return Powers(-float((force - at_rest) @ velocity), self.brought_in(at_rest, displacement, velocity, operation))

    def brought_in(
        self, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> float:
        """Power of the turning cage and of centrifugal forces, see `RingElement.brought_in`."""
        turning = cage_moment(force, displacement, 2) * self.plain.rates[0] * operation.speed
        return turning + self.outward(operation) * float(np.sum(velocity[12:]))

    def stored(self, states: Any, displacement: FloatArray, operation: Operation) -> float:
        """Energy of its contacts at rest [J], without that of a centrifugal field; see `Element.stored`."""
        plain, contacts = self.plain, self.contacts
        conditions = plain.entrainment_speed(operation), plain.temperature, 0.0
        approaches = contacts.approaches(displacement, plain.cage_angle(operation))
        return sum(
            energy_at_rest(law, conditions, plain.bearing, approach)
            for law, approach in zip(contacts.laws, approaches, strict=True)
        )

    def brought_by_speed(self, displacements: FloatArray, operations: Sequence[Operation]) -> float:
        """Energy that changes of the speed brought into the films of both contacts."""
        plain, total = self.plain, 0.0
        conditions = [(plain.entrainment_speed(op), plain.temperature, 0.0) for op in operations]
        for side, law in enumerate(self.contacts.laws):

            def approaches(sample: int, side: int = side) -> FloatArray:
                angle = plain.cage_angle(operations[sample])
                return self.contacts.approaches(displacements[sample], angle)[side]

            total += brought_by_speed(law, plain.bearing, conditions, approaches)
        return total

    def outward(self, operation: Operation) -> float:
        """Centrifugal force of a roller [N]; zero where it is left out."""
        return self.plain.centrifugal_load(operation) * self.plain.bearing.geometry.roller_length


def error_words(system: System, film_share: float = 0.0) -> str:
    """Name the errors in the bands of a system, for people, the largest first; empty without bearings.

    Parameters
    ----------
    system : System
        The system.
    film_share : float
        Part of the bands that is what films with memory leave out; 0 if that is not in them.
    """
    bearings = [system.elements[index].element for index in system.select(OnRings)]
    if not bearings:
        return ""
    words = {element.error_words for element in bearings if isinstance(element, OnRings)}
    if "" in words:
        return NO_MAP
    stated = "; ".join(sorted(words))
    if film_share == 0.0:
        return f"{stated}; how films relax is not in it"
    in_slices = all(isinstance(element, RingElement) for element in bearings)
    memory = "one relaxation time of a slice leaves" if in_slices else "springs and dampers of films with memory leave"
    films = f"what {memory} out ({100.0 * film_share:.2g} % of the median band)"
    return f"{films}, then {stated}" if film_share > 0.5 else f"{stated}; then {films}"


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
    """Motion by which the ports of an element follow the inner ring, the outer one being held, shape (m, 6).

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


def ring_motion(ports: FloatArray) -> FloatArray:
    """Displacement of an inner ring against the outer one from that of the ports of its element, shape (..., 6).

    Parameters
    ----------
    ports : array, shape (..., 6) or (..., 12 + Z)
        Displacements of the ports [m or rad]; rollers that are bodies have both rings in theirs.
    """
    return ports if ports.shape[-1] == 6 else ports[..., :6] - ports[..., 6:12]


_NO_FILMS = "got 'memory' with a law without films; allowed: laws map and formula"

_AT_REST = 1e6
"""A step so long that films are in equilibrium at its end [s]."""


class FilmStates(NamedTuple):
    """States of a bearing's films after a step.

    Attributes
    ----------
    films : tuple of FilmState
        Films of all slices of all rollers, shape (Z, n), for each side of the contacts.
    time : float
        End of the step [s].
    before : tuple of FilmState or None
        Films at its beginning; None where that is not known.
    """

    films: tuple[FilmState, ...]
    time: float
    before: tuple[FilmState, ...] | None = None


class FilmsInTime(RingElement):
    """A bearing whose films have a memory in time, with rollers of either kind.

    The law is that of `ehdmaps.maps.kernels.memory_table`.

    At rest it is the element without; small oscillations see films that relax.
    """

    def advance(
        self, states: FilmStates | None, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, FilmStates]:
        """A step in time up to the time of `operation`, as `ContactLaw.advance` for all slices.

        Parameters
        ----------
        states : FilmStates or None
            States after the last step; None for films in equilibrium.
        displacement, velocity : array, shape (m,)
            Motion of the ports at the end of the step; the rates have no effect.
        operation : Operation
            Speed, angle and time there.

        Raises
        ------
        InputError, OutsideMapError
            As the law does.
        """
        before = None if states is None else states.films
        dt = 0.0 if states is None else operation.time - states.time
        forces, films = self.advance_films(before, displacement, dt, operation)
        return forces, FilmStates(films, operation.time, before)

    def powers(
        self,
        states: FilmStates,
        force: FloatArray,
        displacement: FloatArray,
        velocity: FloatArray,
        operation: Operation,
    ) -> Powers:
        """Energy that its films take up; power that cage and centrifugal forces bring in, see `Element.powers`."""
        memories, length = self.in_time(operation)
        spent = 0.0
        if states.before is not None:
            sides = zip(memories, states.before, states.films, strict=True)
            spent = sum(float(np.sum(memory.spent(before, films))) for memory, before, films in sides)
        return Powers(0.0, self.brought_in(force, displacement, velocity, operation), spent * length)

    def stored(self, states: FilmStates, displacement: FloatArray, operation: Operation) -> float:
        """Energy of its contacts [J]: of the solids and of the films that follow, see `Element.stored`."""
        memories, length = self.in_time(operation)
        sides = zip(memories, states.films, strict=True)
        return sum(float(np.sum(memory.stored(films))) for memory, films in sides) * length

    def in_time(self, operation: Operation) -> tuple[tuple[FilmMemory, ...], float]:
        """Laws with memory of each side of the contacts at the speed, and the length of a slice [m]."""
        raise NotImplementedError

    def advance_films(
        self, before: tuple[FilmState, ...] | None, displacement: FloatArray, dt: float, operation: Operation
    ) -> tuple[Forces, tuple[FilmState, ...]]:
        """Forces and films after a step.

        Parameters
        ----------
        before : tuple of FilmState or None
            Films at its beginning; None for films in equilibrium at its end, which have not moved yet.
        displacement : array, shape (m,)
            Displacements of the ports at its end.
        dt : float
            Length of the step [s]; of no effect without `before`.
        operation : Operation
            Speed, angle and time at its end.
        """
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class MemoryBearing(FilmsInTime, BearingElement):
    """A `BearingElement` whose films have a memory in time.

    Raises
    ------
    InputError
        With a force that has no contact law with films, or with centrifugal loads: such films have no memory.
    """

    films: Films = "memory"

    def __post_init__(self) -> None:
        BearingElement.__post_init__(self)
        if not self.film_laws:
            raise InputError(f"bearing {self.name!r}, films: {_NO_FILMS}")

    def in_time(self, operation: Operation) -> tuple[tuple[FilmMemory, ...], float]:
        """See `FilmsInTime.in_time`."""
        assert isinstance(self.force, BearingForce)
        conditions = self.entrainment_speed(operation), self.temperature, self.centrifugal_load(operation)
        return (self.force.in_time(*conditions).law.memory,), self.bearing.slice_length

    def advance_films(
        self, before: tuple[FilmState, ...] | None, displacement: FloatArray, dt: float, operation: Operation
    ) -> tuple[Forces, tuple[FilmState, ...]]:
        """Forces and films after a step, see `FilmsInTime.advance_films`."""
        assert isinstance(self.force, BearingForce)
        forces, films = self.force.advance(
            None if before is None else before[0],
            displacement,
            _AT_REST if before is None else dt,
            **self.conditions(operation),
            centrifugal_load=self.centrifugal_load(operation),
        )
        return forces, (dataclasses.replace(films, step=0.0) if before is None else films,)


@dataclass(frozen=True, eq=False)
class MemoryRollers(FilmsInTime, RollerElement):
    """A `RollerElement` whose films have a memory in time.

    Raises
    ------
    InputError
        With contact laws that have no films.
    """

    films: Films = "memory"

    def __post_init__(self) -> None:
        if not self.film_laws:
            raise InputError(f"bearing {self.name!r}, films: {_NO_FILMS}")

    def in_time(self, operation: Operation) -> tuple[tuple[FilmMemory, ...], float]:
        """See `FilmsInTime.in_time`."""
        memories = self.contacts.memories(self.plain.entrainment_speed(operation), self.plain.temperature)
        return memories, self.plain.bearing.slice_length

    def advance_films(
        self, before: tuple[FilmState, ...] | None, displacement: FloatArray, dt: float, operation: Operation
    ) -> tuple[Forces, tuple[FilmState, ...]]:
        """Forces and films after a step, see `FilmsInTime.advance_films`."""
        forces, films = self.contacts.advance(before, displacement, dt, **self.plain.conditions(operation))
        forces.force[12:] += self.outward(operation)
        return forces, films
