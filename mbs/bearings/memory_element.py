"""A bearing in a system whose films need time to follow: a `BearingElement` with a state for each slice in runs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.memory import FilmState
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.bearing_kernel import rollers_of_arrays
from mbs.bearings.force_at_point import Arrays
from mbs.model.elements import Forces, Operation
from mbs.model.relaxation import Films


class FilmStates(NamedTuple):
    """States of a bearing's films after a step.

    Attributes
    ----------
    films : FilmState
        Films of all slices of all rollers, shape (Z, n).
    time : float
        End of the step [s].
    """

    films: FilmState
    time: float


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
        if not (isinstance(self.force, BearingForce) and isinstance(self.force.law, ContactLaw)):
            raise InputError(
                f"bearing {self.name!r}, films: got 'memory' with a law without films; allowed: laws map and formula"
            )

    @property
    def law(self) -> ContactLaw:
        """The law of a roller between both raceways."""
        assert isinstance(self.force, BearingForce) and isinstance(self.force.law, ContactLaw)
        return self.force.law

    @cached_property
    def _arrays(self) -> Arrays:
        """Constants of the bearing."""
        return Arrays(self.bearing)

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
        work = self._arrays
        state = np.concatenate((displacement, np.zeros(6), [self.cage_angle(operation)]))
        gap, tilt, _, _ = rollers_of_arrays(state, np.array(work.sizes), work.slices, work.angles)
        positions, profile = work.slices
        deltas = gap[:, None] + tilt[:, None] * positions - profile
        memory = self.law.at(self.entrainment_speed(operation), self.temperature).memory
        films = memory.settled(deltas) if states is None else states.films
        if states is None:
            loads, tangents, _ = memory.advance(films, deltas, _AT_REST)
        else:
            loads, tangents, films = memory.advance(states.films, deltas, operation.time - states.time)
        cos, sin = self._directions(operation)
        zero = np.zeros_like(cos)
        by = np.stack((zero, cos, sin, zero, zero, zero))[:, :, None] + np.stack(
            (zero, zero, zero, zero, -sin, cos)
        )[:, :, None] * positions  # fmt: skip
        force = -work.sizes.slice_length * np.einsum("ajn,jn->a", by, loads)
        stiffness = work.sizes.slice_length * np.einsum("ajn,jn,bjn->ab", by, tangents, by)
        return Forces(force, stiffness, np.zeros((6, 6))), FilmStates(films, operation.time)

    def _directions(self, operation: Operation) -> tuple[FloatArray, FloatArray]:
        """Cosine and sine of the angles of all rollers."""
        angle = self.cage_angle(operation)
        cos, sin = self._arrays.angles
        return np.cos(angle) * cos - np.sin(angle) * sin, np.sin(angle) * cos + np.cos(angle) * sin


_AT_REST = 1e6
"""A step so long that films are in equilibrium at its end [s]."""
