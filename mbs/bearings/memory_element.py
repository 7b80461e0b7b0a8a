"""Bearings of rollers in a system whose films need time: each slice of each side of a contact has a state in runs.

The law is that of `ehdmaps.maps.kernels.memory_table`. At rest they are the elements without; small oscillations see
films that relax.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.bearings.bearing_element import BearingElement, RingElement
from mbs.bearings.roller_contacts import AT_REST
from mbs.bearings.roller_element import RollerElement
from mbs.model.elements import Forces, Operation, Powers
from mbs.model.relaxation import Films

if TYPE_CHECKING:
    from ehdmaps.maps.kernels.memory import FilmMemory, FilmState


_NO_FILMS = "got 'memory' with a law without films; allowed: laws map and formula"


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
    """A bearing whose films have a memory in time, with rollers of either kind."""

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
        conditions = self.entrainment_speed(operation), self.temperature, self.centrifugal_load(operation)
        return (self.force.in_time(*conditions).law.memory,), self.bearing.slice_length

    def advance_films(
        self, before: tuple[FilmState, ...] | None, displacement: FloatArray, dt: float, operation: Operation
    ) -> tuple[Forces, tuple[FilmState, ...]]:
        """Forces and films after a step, see `FilmsInTime.advance_films`."""
        forces, films = self.force.advance(
            None if before is None else before[0],
            displacement,
            AT_REST if before is None else dt,
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
