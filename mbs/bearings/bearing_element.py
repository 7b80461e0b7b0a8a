"""A bearing in a system: the bearing force between two places, at the speed and cage angle that the system has.

Its rollers are massless, with one law of both contacts in series (`BearingElement`), or bodies between two contacts
(`mbs.bearings.roller_element`). Films follow at once, or need time (`films`).
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple, Self

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.physics.hertz import LINE_LIMIT, max_pressure
from ehdmaps.physics.solids import STEEL
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import AT_REST, NO_COUPLED_MEMORY, BearingForce
from mbs.bearings.contact_energy import brought_by_speed, cage_moment, energy_at_rest
from mbs.bearings.cylinder import Arrays
from mbs.bearings.films import DryContacts, FilmSource
from mbs.bearings.force_at_point import RollerLoads
from mbs.bearings.laws import DryLaw, FlatLaw, Law
from mbs.model.elements import Excitation, Forces, OnRings, Operation, Port, Powers
from mbs.model.findings import Gauge
from mbs.model.relaxation import Films, Relaxation

if TYPE_CHECKING:
    from ehdmaps.maps.kernels.memory import FilmMemory, FilmState
    from ehdmaps.maps.law import ContactLaw
    from ehdmaps.physics.lubricant import Lubricant
    from mbs.bearings.contact_report import BearingContacts, RollingLoss
    from mbs.bearings.deviating.tables import DeviationData, Deviations
    from mbs.bearings.slices_in_balance import Side
    from mbs.model.condensed import Condensed


NO_CENTRIFUGAL = "got 'memory' with centrifugal = true; allowed: films with memory without it, or slow films"

FELT = np.array([1, 2, 4, 5])
"""Displacements of its port that a bearing feels: y, z, theta_y, theta_z."""

LEVEL = 2
"""How many of them one feels whose rings do not tilt: the first ones."""

HARMONICS = 3
"""Multiples of the order of passing rollers that are worth following."""


NO_FILMS = "got 'memory' with a law without films; allowed: laws map and formula"


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


class RingElement(OnRings):
    """Element that is listed as a roller bearing: its first six displacements are those of an inner ring.

    `mbs.model.system.System.select` finds bearings by this class; a bearing of your own inherits from it.

    Attributes
    ----------
    films : {"slow", "memory"}
        Whether small oscillations see the films of slow motion at any frequency, or films that relax. Those that do
        have a state for each slice of each side of a contact in runs, by `ehdmaps.maps.kernels.memory_table`; at rest
        they are the same.
    """

    memory_words: ClassVar[str] = "one relaxation time of a slice leaves"
    films: Films = "slow"

    @property
    def relaxes(self) -> bool:
        """See `OnRings.relaxes`."""
        return self.films == "memory"

    @property
    def flat_laws(self) -> tuple[FlatLaw, ...]:
        """Law of each side of its contacts: of both in series, or of the inner and the outer one; none if unknown."""
        return ()

    @property
    def film_laws(self) -> tuple[ContactLaw, ...]:
        """The same where all of them have films; else none."""
        laws = tuple(flat.law for flat in self.flat_laws if not isinstance(flat.law, DryLaw))
        return laws if len(laws) == len(self.flat_laws) else ()

    def advance(
        self, states: FilmStates | None, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, FilmStates | None]:
        """A step of films with memory, by no rates, as `ContactLaw.advance` for all slices; see `Element.advance`."""
        with self.deviating(operation):
            return self._advanced(states, displacement, velocity, operation)

    def _advanced(
        self, states: FilmStates | None, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, FilmStates | None]:
        """The same with the deviations of that time."""
        if not self.relaxes:
            return super().advance(states, displacement, velocity, operation)
        before = None if states is None else states.films
        dt = 0.0 if states is None else operation.time - states.time
        forces, films = self.advance_films(before, displacement, dt, operation)
        return forces, FilmStates(films, operation.time, before)

    def powers(
        self,
        states: FilmStates | None,
        force: FloatArray,
        displacement: FloatArray,
        velocity: FloatArray,
        operation: Operation,
    ) -> Powers | None:
        """Power that contacts or films take up, that cage, rollers and deviations bring in; see `Element.powers`."""
        if not self.flat_laws:
            return None
        rates = (
            None if self.deviation_data is None else self.deviation_data.at(operation.angle, operation.speed)[..., 1]
        )
        if states is None:
            still = np.zeros_like(velocity)
            with self.deviating(operation):
                moving = None if rates is None else self.contact_loads(displacement, velocity, operation)
            with self.deviating(operation._replace(speed=0.0)):
                at_rest = self.evaluate(displacement, still, operation).force
                resting = None if rates is None else self.contact_loads(displacement, still, operation)
            brought = self.brought_in(at_rest, displacement, velocity, operation)
            dissipated = -float((force - at_rest) @ velocity)
            if rates is not None and moving is not None and resting is not None:
                dissipated, brought = (
                    dissipated + float(np.sum((moving - resting) * rates)),
                    brought + float(np.sum(moving * rates)),
                )
            return Powers(dissipated, brought)
        memories, length = self.in_time(operation)
        spent = 0.0
        if states.before is not None:
            sides = zip(memories, states.before, states.films, strict=True)
            spent = sum(float(np.sum(memory.spent(before, films))) for memory, before, films in sides)
        brought = self.brought_in(force, displacement, velocity, operation)
        if rates is not None:  # massless rollers have one film for both sides
            brought += length * float(
                np.sum(np.stack([films.load.sum(axis=1) for films in states.films], axis=1) * rates)
            )
        return Powers(0.0, brought, spent * length)

    def contact_loads(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> FloatArray:
        """Loads of the contacts of each roller, without films that relax, shape (Z, 2), or (Z, 1) of both alike [N].

        Parameters
        ----------
        displacement, velocity, operation
            What `evaluate` takes.
        """
        raise NotImplementedError

    def stored(self, states: FilmStates | None, displacement: FloatArray, operation: Operation) -> float | None:
        """Energy of its contacts at rest [J], or of the solids and of films that follow, see `Element.stored`."""
        if states is None:
            with self.deviating(operation):
                return self.stored_at_rest(displacement, operation)
        memories, length = self.in_time(operation)
        sides = zip(memories, states.films, strict=True)
        return sum(float(np.sum(memory.stored(films))) for memory, films in sides) * length

    def stored_at_rest(self, displacement: FloatArray, operation: Operation) -> float | None:
        """Energy of its contacts at rest [J], the integral of loads over approaches; None if it does not say."""
        return None

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

    if TYPE_CHECKING:  # a property at run time would be the default of the field of this name

        @property
        def plain(self) -> BearingElement:
            """The same bearing with massless rollers: places, speeds, and the loads of rollers to look at."""

    @property
    def felt_rows(self) -> FloatArray:
        """Rows of what it feels of its rings in compiled runs, shape (felt, m)."""
        raise NotImplementedError

    @property
    def contact_rates(self) -> tuple[float, float]:
        """Entrainment speed for each speed of the system, and centrifugal load in its contacts for the square of it."""
        return self.plain.rates[1], self.plain.rates[2]

    def with_laws(self, laws: Sequence[Law]) -> Self:
        """The bearing with other laws, one for each of `flat_laws`.

        Parameters
        ----------
        laws : sequence of Law
            The laws.
        """
        raise NotImplementedError

    def in_state(self, bearing: Bearing, temperature: float) -> Self:
        """The bearing with another clearance and temperature.

        Parameters
        ----------
        bearing : Bearing
            The same bearing, with its clearance in operation.
        temperature : float
            Temperature of the raceways [K].
        """
        raise NotImplementedError

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

        return slices_in_balance(sides, relaxes=self.relaxes)


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
    force : BearingForce
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
    source : FilmSource or None
        What knows pressures and films of its contacts; None for those of dry contacts.
    deviations : Deviations or None
        Deviations from its form, which excite runs in time.

    Raises
    ------
    InputError
        For films with memory and a centrifugal load, or slices that are coupled.
    """

    name: str
    inner: str
    outer: str
    bearing: Bearing
    force: BearingForce
    temperature: float
    inner_spin: float = 1.0
    outer_spin: float = 0.0
    start_angle: float = 0.0
    centrifugal: bool = False
    films: Films = "slow"
    tilts: bool = True
    source: FilmSource | None = None
    deviations: Deviations | None = None

    def __post_init__(self) -> None:
        wrong = (
            (NO_CENTRIFUGAL, self.centrifugal),
            (NO_COUPLED_MEMORY, self.bearing.coupled),
            (NO_FILMS, not self.film_laws),
        )
        for words, found in wrong:
            if self.relaxes and found:
                raise InputError(f"bearing {self.name!r}, films: {words}")

    @property
    def ports(self) -> tuple[Port, ...]:
        """Displacement of the inner ring against the outer one."""
        return (Port(self.inner, self.outer),)

    @property
    def count(self) -> int:
        """See `OnRings.count`."""
        return self.bearing.geometry.rollers

    @property
    def excitation(self) -> Excitation | None:
        """The passing of the rollers; None for a cage that stands."""
        order = self.count * abs(self.rates[0])
        return Excitation(order, HARMONICS, rank=1) if order > 0.0 else None

    @property
    def flat_laws(self) -> tuple[FlatLaw, ...]:
        """See `RingElement.flat_laws`: that of both contacts in series."""
        return (self.force.flat_law,)

    @property
    def plain(self) -> BearingElement:
        """It itself, see `RingElement.plain`."""
        return self

    @property
    def felt_rows(self) -> FloatArray:
        """See `RingElement.felt_rows`: (4, 6), or (2, 6) without tilts."""
        return np.asarray(np.eye(6)[FELT if self.tilts else FELT[:LEVEL]])

    def with_laws(self, laws: Sequence[Law]) -> Self:
        """See `RingElement.with_laws`."""
        (law,) = laws
        return dataclasses.replace(self, force=BearingForce(self.force.bearing, law))

    def in_state(self, bearing: Bearing, temperature: float) -> Self:
        """See `RingElement.in_state`."""
        force = BearingForce(bearing, self.force.law)
        return dataclasses.replace(self, bearing=bearing, force=force, temperature=temperature)

    @cached_property
    def rates(self) -> tuple[float, float, float]:
        """Cage speed and entrainment speed for each speed of the system, centrifugal load for its square."""
        spins = (self.inner_spin, self.outer_spin)
        centrifugal = self.bearing.centrifugal_load(*spins) if self.centrifugal else 0.0
        return self.bearing.cage_angle(*spins), self.bearing.geometry.entrainment_speed(*spins), centrifugal

    def deviate(self, added: FloatArray | None) -> None:
        """See `OnRings.deviate`."""
        self.force.deviate(added)

    def contact_loads(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> FloatArray:
        """Loads that both sides of massless rollers have, see `RingElement.contact_loads`."""
        conditions, load = self.conditions(operation), self.centrifugal_load(operation)
        return self.force.rollers(displacement, velocity, **conditions, centrifugal_load=load).load[:, None]

    @cached_property
    def deviation_data(self) -> DeviationData | None:
        """Tables of its deviations; None without any."""
        if self.deviations is None:
            return None
        from mbs.bearings.deviating.tables import deviation_data  # with what few scenes state

        bearing, spins = self.bearing, (self.inner_spin, self.outer_spin)
        return deviation_data(self.deviations, bearing.geometry, spins, self.start_angle, bearing.roller_angles)

    @property
    def lubricant(self) -> Lubricant | None:
        """Oil of its films; None where none is known."""
        return None if self.source is None else self.source.lubricant

    def passed(self, part: float) -> Self:
        """See `OnRings.passed`."""
        turn = 2.0 * math.pi * part / self.count
        return dataclasses.replace(self, start_angle=self.start_angle + turn * float(np.sign(self.rates[0])))

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
        """Loads of all rollers at rest at the displacement (6,) of the inner ring against the outer one."""
        conditions, load = self.conditions(operation), self.centrifugal_load(operation)
        return self.force.rollers(displacement, **conditions, centrifugal_load=load)

    @property
    def entrainment_rate(self) -> float:
        """See `OnRings.entrainment_rate`."""
        return self.rates[1]

    def largest_load(self, displacement: FloatArray, operation: Operation) -> float:
        """See `OnRings.largest_load`."""
        return float(self.loads(displacement, operation).load_per_length.max())

    def element_loads(self, displacement: FloatArray, operation: Operation) -> FloatArray:
        """See `OnRings.element_loads`."""
        return self.loads(displacement, operation).load

    def gauge(self, displacement: FloatArray, operation: Operation) -> Gauge:
        """See `OnRings.gauge`."""
        lines = self.loads(displacement, operation).load_per_length
        sides = lines, np.maximum(lines + self.centrifugal_load(operation), 0.0)
        contacts = self.bearing.geometry.contacts(self.bearing.material, "iso16281")
        pressure = [
            float(max_pressure(float(side.max(initial=0.0)), contact.radius, contact.reduced_modulus))
            for side, contact in zip(sides, contacts, strict=True)
        ]
        load = np.array([side.sum(axis=1) for side in sides]) * self.bearing.slice_length
        return Gauge("roller", load, np.array(pressure), LINE_LIMIT)

    def felt(self, displacement: FloatArray, operation: Operation) -> tuple[BearingContacts, RollingLoss]:
        """See `OnRings.felt`; contacts are dry where the oil has no viscosity, at an edge at which a law is held."""
        from mbs.bearings.contact_report import bearing_contacts, rolling_loss

        rollers, u = self.loads(displacement, operation), self.entrainment_speed(operation)
        at = rollers, u, self.temperature, self.centrifugal_load(operation)
        dry = DryContacts(self.bearing.geometry.contacts(STEEL, "iso16281"))
        source = self.source or dry
        try:
            contacts = bearing_contacts(source, *at)
        except InputError:
            contacts = bearing_contacts(dry, *at)
        ring_speed = (self.inner_spin - self.outer_spin) * operation.speed
        return contacts, rolling_loss(self.bearing, source, contacts, rollers, u, ring_speed, *at[2:])

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """See `OnRings.film_relaxation`; with centrifugal load the times are those without it, as an estimate."""
        if not self.film_laws:
            return None
        from mbs.bearings.slices_in_balance import slice_relaxation

        side, rollers = self._side(displacement, operation)
        return slice_relaxation([side], [rollers.damping * side.length])

    @property
    def slowest_film(self) -> float:
        """See `OnRings.slowest_film`."""
        return self.film_laws[0].speed_range[0] if self.film_laws else 0.0

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

    def in_time(self, operation: Operation) -> tuple[tuple[FilmMemory, ...], float]:
        """See `RingElement.in_time`."""
        conditions = self.entrainment_speed(operation), self.temperature, self.centrifugal_load(operation)
        return (self.force.in_time(*conditions).law.memory,), self.bearing.slice_length

    def advance_films(
        self, before: tuple[FilmState, ...] | None, displacement: FloatArray, dt: float, operation: Operation
    ) -> tuple[Forces, tuple[FilmState, ...]]:
        """Forces and films after a step, see `RingElement.advance_films`."""
        forces, films = self.force.advance(
            None if before is None else before[0],
            displacement,
            AT_REST if before is None else dt,
            **self.conditions(operation),
            centrifugal_load=self.centrifugal_load(operation),
        )
        return forces, (dataclasses.replace(films, step=0.0) if before is None else films,)

    def brought_in(
        self, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> float:
        """Power of the turning cage, see `RingElement.brought_in`."""
        return cage_moment(force, displacement, 1) * self.rates[0] * operation.speed

    def stored_at_rest(self, displacement: FloatArray, operation: Operation) -> float:
        """See `RingElement.stored_at_rest`."""
        conditions = self.entrainment_speed(operation), self.temperature, self.centrifugal_load(operation)
        rollers = self.loads(displacement, operation)
        energy = energy_at_rest(self.force.law, conditions, self.bearing, rollers.approach)
        coupling = self.force.coupling
        if coupling is None:
            return energy
        w = rollers.load_per_length
        return energy + 0.5 * self.bearing.slice_length * float(np.sum((w @ coupling) * w))

    def brought_by_speed(self, displacements: FloatArray, operations: Sequence[Operation]) -> float:
        """Energy that changes of the speed brought into its films, see `mbs.bearings.contact_energy`."""
        conditions = [(self.entrainment_speed(op), self.temperature, self.centrifugal_load(op)) for op in operations]
        if self.bearing.coupled:

            def own(sample: int) -> FloatArray:
                return self.loads(displacements[sample], operations[sample]).approach

            return brought_by_speed(self.force.law, self.force.bearing, conditions, own)

        arrays, state = Arrays(self.force.bearing), np.zeros(13)

        def approaches(sample: int) -> FloatArray:
            approach = np.empty((arrays.shape.rollers, arrays.shape.slices))
            state[:6], state[12] = displacements[sample], self.cage_angle(operations[sample])
            if self.deviation_data is not None:
                arrays.shape.put(added=self.deviation_data.at(operations[sample].angle, operations[sample].speed))
            arrays.approaches(state, approach)
            return approach

        return brought_by_speed(self.force.law, self.force.bearing, conditions, approaches)
