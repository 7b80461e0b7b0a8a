"""A bearing in a system whose rollers are bodies: each has a mass and a radial freedom, between two contacts.

The radial freedoms are counted in the cage, which turns; what its turning adds to the rollers' motion but the
centrifugal load is left out, as speeds of vibration are small against it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement, RingElement
from mbs.bearings.contact_energy import brought_by_speed, cage_moment, energy_at_rest
from mbs.bearings.contact_groups import ContactGroup
from mbs.bearings.roller_contacts import RollerContacts
from mbs.model.body import Body
from mbs.model.elements import Excitation, Forces, Operation, Port, Powers
from mbs.model.relaxation import Films, Relaxation


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
