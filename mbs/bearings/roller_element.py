"""A bearing in a system whose rollers are bodies: each has a mass and a radial freedom, between two contacts.

The radial freedoms are counted in the cage, which turns; what its turning adds to the rollers' motion but the
centrifugal load is left out, as speeds of vibration are small against it.

Films follow at once, or need time: then each slice of each contact has a state in runs (`MemoryRollers`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement, RingElement
from mbs.bearings.bearing_force import brought_by_speed, cage_moment, energy_at_rest
from mbs.bearings.laws import DryLaw
from mbs.bearings.roller_contacts import ContactGroup, RollerContacts
from mbs.model.body import Body
from mbs.model.elements import Excitation, Forces, Operation, Port, Powers
from mbs.model.relaxation import Films, Relaxation

if TYPE_CHECKING:
    from ehdmaps.maps.law import ContactLaw
    from ehdmaps.maps.memory import FilmMemory, FilmState


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
    """A bearing between two rings and its rollers.

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
    def ports(self) -> tuple[Port, ...]:
        """Inner ring, outer ring, rollers."""
        return Port(self.plain.inner), Port(self.plain.outer), Port(self.rollers, coordinates=True)

    @property
    def excitation(self) -> Excitation | None:
        """The passing of the rollers."""
        return self.plain.excitation

    def relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """How the films of both contacts relax, where they do, see `Element.relaxation`."""
        return self.film_relaxation(displacement, operation) if self.films == "memory" else None

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """See `RingElement.film_relaxation`."""
        plain = self.plain
        return self.contacts.relaxation(
            displacement,
            cage_angle=plain.cage_angle(operation),
            entrainment_speed=plain.entrainment_speed(operation),
            temperature=plain.temperature,
        )

    def natural_times(self, displacement: FloatArray, operation: Operation) -> FloatArray:
        """See `RingElement.natural_times`."""
        plain = self.plain
        return self.contacts.natural_times(
            displacement,
            cage_angle=plain.cage_angle(operation),
            entrainment_speed=plain.entrainment_speed(operation),
            temperature=plain.temperature,
        )

    @property
    def error_words(self) -> str:
        """See `RingElement.error_words`."""
        return self.plain.error_words

    def contact_groups(self, displacement: FloatArray, operation: Operation) -> tuple[ContactGroup, ...]:
        """See `RingElement.contact_groups`: slices of the inner contacts, and of the outer ones."""
        plain = self.plain
        return self.contacts.groups(
            displacement,
            relaxes=self.films == "memory",
            cage_angle=plain.cage_angle(operation),
            entrainment_speed=plain.entrainment_speed(operation),
            temperature=plain.temperature,
        )

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Forces on rings and rollers, stiffness and damping, see `Element.evaluate`."""
        plain = self.plain
        found = self.contacts.evaluate(
            displacement,
            velocity,
            cage_angle=plain.cage_angle(operation),
            entrainment_speed=plain.entrainment_speed(operation),
            temperature=plain.temperature,
        )
        found.force[12:] += self.outward(operation)
        return found

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers:
        """What its contacts dissipate; what cage and centrifugal forces bring in, see `Element.powers`."""
        at_rest = self.evaluate(displacement, np.zeros_like(velocity), operation).force
        return Powers(-float((force - at_rest) @ velocity), self.brought_in(at_rest, displacement, velocity, operation))

    def brought_in(
        self, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> float:
        """Power that the turning of the cage and the centrifugal forces of the rollers bring in [W].

        Parameters
        ----------
        force, displacement, velocity, operation
            What `powers` takes; the force is that which the cage feels.
        """
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


class ContactStates(NamedTuple):
    """States of the films of both contacts after a step.

    Attributes
    ----------
    films : (FilmState, FilmState)
        Films of all slices of the inner and of the outer contacts, shape (Z, n) each.
    time : float
        End of the step [s].
    before : (FilmState, FilmState) or None
        Films at its beginning; None where that is not known.
    """

    films: tuple[FilmState, FilmState]
    time: float
    before: tuple[FilmState, FilmState] | None = None


@dataclass(frozen=True, eq=False)
class MemoryRollers(RollerElement):
    """A bearing whose rollers are bodies, and whose films have a memory in time.

    At rest it is the `RollerElement` with the same contacts; small oscillations see films that relax.

    Raises
    ------
    InputError
        With contact laws that have no films.
    """

    films: Films = "memory"

    def __post_init__(self) -> None:
        if any(isinstance(law, DryLaw) for law in self.contacts.laws):
            raise InputError(
                f"bearing {self.name!r}, films: got 'memory' with a law without films; allowed: laws map and formula"
            )

    @property
    def laws(self) -> tuple[ContactLaw, ContactLaw]:
        """Laws of the inner and of the outer contact."""
        inner, outer = self.contacts.laws
        assert not isinstance(inner, DryLaw) and not isinstance(outer, DryLaw)
        return inner, outer

    def advance(
        self, states: ContactStates | None, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, ContactStates]:
        """A step in time up to the time of `operation`, as `ContactLaw.advance` for all slices.

        Parameters
        ----------
        states : ContactStates or None
            States after the last step; None for films in equilibrium.
        displacement, velocity : array, shape (12 + Z,)
            Motion of rings and rollers at the end of the step; the rates have no effect.
        operation : Operation
            Speed, angle and time there.

        Raises
        ------
        InputError, OutsideMapError
            As the laws do.
        """
        plain = self.plain
        found, films = self.contacts.advance(
            None if states is None else states.films,
            displacement,
            0.0 if states is None else operation.time - states.time,
            cage_angle=plain.cage_angle(operation),
            entrainment_speed=plain.entrainment_speed(operation),
            temperature=plain.temperature,
        )
        found.force[12:] += self.outward(operation)
        return found, ContactStates(films, operation.time, None if states is None else states.films)

    def powers(
        self,
        states: ContactStates,
        force: FloatArray,
        displacement: FloatArray,
        velocity: FloatArray,
        operation: Operation,
    ) -> Powers:
        """What its films take up; what cage and centrifugal forces bring in, see `Element.powers`."""
        spent = 0.0
        if states.before is not None:
            both = zip(self._memories(operation), states.before, states.films, strict=True)
            spent = sum(float(np.sum(memory.spent(before, films))) for memory, before, films in both)
        driven = self.brought_in(force, displacement, velocity, operation)
        return Powers(0.0, driven, spent * self.plain.bearing.slice_length)

    def stored(self, states: ContactStates, displacement: FloatArray, operation: Operation) -> float:
        """Energy of its contacts [J]: of the solids and of the films that follow, see `Element.stored`."""
        pairs = zip(self._memories(operation), states.films, strict=True)
        return sum(float(np.sum(memory.stored(films))) for memory, films in pairs) * self.plain.bearing.slice_length

    def _memories(self, operation: Operation) -> tuple[FilmMemory, FilmMemory]:
        """The laws with memory at the speed."""
        return self.contacts.memories(self.plain.entrainment_speed(operation), self.plain.temperature)
