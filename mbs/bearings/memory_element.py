"""A bearing in a system whose films need time to follow: a `BearingElement` with a state for each slice in runs."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.maps.memory import FilmMemory, FilmState
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.contact_energy import cage_moment
from mbs.bearings.laws import DryLaw
from mbs.model.elements import Forces, Operation, Powers
from mbs.model.relaxation import Films

if TYPE_CHECKING:
    from ehdmaps.maps.law import ContactLaw


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
