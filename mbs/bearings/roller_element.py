"""A bearing in a system whose rollers are bodies: each has a mass and a radial freedom, between two contacts."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import NO_FILMS, BearingElement, RingElement
from mbs.bearings.contact_energy import brought_by_speed, cage_moment, energy_at_rest
from mbs.bearings.laws import FlatLaw, Law
from mbs.bearings.roller_contacts import RollerContacts
from mbs.model.body import Body
from mbs.model.elements import Excitation, Forces, Operation, Port
from mbs.model.findings import Gauge
from mbs.model.on_rings import ring_motion
from mbs.model.relaxation import Films, Relaxation

if TYPE_CHECKING:
    from ehdmaps.maps.kernels.memory import FilmMemory, FilmState
    from mbs.bearings.deviating.tables import DeviationData
    from mbs.bearings.slices_in_balance import Side


def roller_body(name: str, bearing: Bearing) -> Body:
    """The rollers of a bearing as one body, with a radial coordinate [m] for each."""
    count = bearing.geometry.rolling_elements
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

    def __post_init__(self) -> None:
        if self.relaxes and not self.film_laws:
            raise InputError(f"bearing {self.name!r}, films: {NO_FILMS}")

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

    def passed(self, part: float) -> Self:
        """See `OnRings.passed`: itself, for a mean over cage angles makes one of a loaded roller and a free one."""
        return self

    @property
    def felt_rows(self) -> FloatArray:
        """See `RingElement.felt_rows`: y and z of both rings, and the tilts of one against the other, (6, 12 + Z)."""
        rows = np.zeros((6, self.contacts.size))
        for row, place in enumerate((1, 2, 7, 8)):
            rows[row, place] = 1.0
        for row, place in ((4, 4), (5, 5)):
            rows[row, place], rows[row, place + 6] = 1.0, -1.0
        return rows

    @property
    def contact_rates(self) -> tuple[float, float]:
        """See `RingElement.contact_rates`: the centrifugal load acts on the rollers, and not in their contacts."""
        return self.plain.rates[1], 0.0

    @property
    def deviation_data(self) -> DeviationData | None:
        """Tables of its deviations; None without any."""
        return self.plain.deviation_data

    def deviate(self, added: FloatArray | None) -> None:
        """See `OnRings.deviate`."""
        self.contacts.added = added

    def contact_loads(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> FloatArray:
        """Loads of the inner and the outer contacts, see `RingElement.contact_loads`."""
        return self.contacts.loads(displacement, velocity, **self.plain.conditions(operation))

    def with_laws(self, laws: Sequence[Law]) -> Self:
        """See `RingElement.with_laws`."""
        return dataclasses.replace(self, contacts=RollerContacts(self.contacts.bearing, *laws))

    def in_state(self, bearing: Bearing, temperature: float) -> Self:
        """See `RingElement.in_state`."""
        contacts = RollerContacts(bearing, *self.contacts.laws)
        return dataclasses.replace(self, plain=self.plain.in_state(bearing, temperature), contacts=contacts)

    def element_loads(self, displacement: FloatArray, operation: Operation) -> FloatArray:
        """See `OnRings.element_loads`: those of rollers that follow in equilibrium."""
        return self.plain.element_loads(ring_motion(displacement), operation)

    def gauge(self, displacement: FloatArray, operation: Operation) -> Gauge:
        """See `OnRings.gauge`: that of rollers that follow in equilibrium."""
        return self.plain.gauge(ring_motion(displacement), operation)

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

    def in_time(self, operation: Operation) -> tuple[tuple[FilmMemory, ...], float]:
        """See `RingElement.in_time`."""
        memories = self.contacts.memories(self.plain.entrainment_speed(operation), self.plain.temperature)
        return memories, self.plain.bearing.slice_length

    def advance_films(
        self, before: tuple[FilmState, ...] | None, displacement: FloatArray, dt: float, operation: Operation
    ) -> tuple[Forces, tuple[FilmState, ...]]:
        """Forces and films after a step, see `RingElement.advance_films`."""
        forces, films = self.contacts.advance(before, displacement, dt, **self.plain.conditions(operation))
        forces.force[12:] += self.outward(operation)
        return forces, films

    def brought_in(
        self, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> float:
        """Power of the turning cage and of centrifugal forces, see `RingElement.brought_in`."""
        turning = cage_moment(force, displacement, 2) * self.plain.rates[0] * operation.speed
        return turning + self.outward(operation) * float(np.sum(velocity[12:]))

    def stored_at_rest(self, displacement: FloatArray, operation: Operation) -> float:
        """See `RingElement.stored_at_rest`; without that of a centrifugal field."""
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
                with self.deviating(operations[sample]):
                    return self.contacts.approaches(displacements[sample], angle)[side]

            total += brought_by_speed(law, plain.bearing, conditions, approaches)
        return total

    def outward(self, operation: Operation) -> float:
        """Centrifugal force of a roller [N]; zero where it is left out."""
        return self.plain.centrifugal_load(operation) * self.plain.bearing.geometry.roller_length
