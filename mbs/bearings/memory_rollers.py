"""A bearing in a system whose rollers are bodies and whose films need time: a state for each slice of each contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.maps.memory import FilmMemory, FilmState
from mbs.bearings.laws import DryLaw
from mbs.bearings.roller_element import RollerElement
from mbs.model.elements import Forces, Operation, Powers
from mbs.model.relaxation import Films

if TYPE_CHECKING:
    from ehdmaps.maps.law import ContactLaw


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
