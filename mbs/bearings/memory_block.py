"""Bearings whose films have a memory, in compiled runs: each slice has a state, which goes on when a step is made.

Rollers are massless, with one contact that stands for both in series, or bodies with two contacts each. The law is that
of `ehdmaps.maps.kernels.memory_table`. Each slice carries parabolas of p, y and G around a state and of a around a
load; they stand for the cubics of its cells, from which they differ in third order, and are read anew where the slice
leaves their reach, and every few steps, as the law follows the speed (`mbs.bearings.speed_tables`). Tables over the
speed are mixed as often as slices read them, see `Course.kept`.

The equations are in `ehdmaps/kernel/c/film/film_slices.c` and `ehdmaps/kernel/c/film/film_block.c`.
"""

from __future__ import annotations

import contextlib
import ctypes
import dataclasses
import math
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import EhdmapsError
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from ehdmaps.maps.kernels.memory import FilmState
from ehdmaps.maps.kernels.memory_table import NUMBERS
from ehdmaps.maps.law import ContactLaw
from mbs.bearings.bearing_element import FilmStates
from mbs.bearings.laws import DryLaw
from mbs.bearings.rings import (
    Rings,
    alike_contacts,
    alone,
    feels,
    folding_of,
    gather_rings,
    placed,
    strict,
)
from mbs.bearings.speed_tables import Course, CourseBlock, CourseOfFilms, Made, SpeedWindow, course_of
from mbs.model.blocks import Kind, Member

STEP = 4e-3
"""Distance of the nodes in ln of the speed: the straight blend between two is right to some 1e-6 of the load."""

NODES = 8
"""How many tables are held."""

_ROUND_OFF = 1e-12


class MemoryTables(SpeedWindow):
    """Tables of one law at one temperature, for a window of speeds.

    Parameters
    ----------
    law : ContactLaw
        The law of a roller between both raceways; all bearings with the same one, the same temperature and rate share
        the tables.
    temperature : float
        [K].
    rate : float
        Entrainment speed for each speed of the system [m/rad].
    tables : array (NODES, NUMBERS)
        Room for the tables of this law.
    """

    def __init__(self, law: ContactLaw, temperature: float, rate: float, tables: FloatArray) -> None:
        self._law, self._temperature, self._rate, self._tables = law, temperature, rate, tables
        super().__init__(STEP, NODES, law.plain_table.lowest_speed / abs(rate) if rate else 1.0)

    def ahead(self, speeds: FloatArray) -> None:
        """Have what costs most made for many speeds [rad/s] at once."""
        with contextlib.suppress(EhdmapsError):  # the step that asks for it will be told why
            at = np.array([self._entrainment(speed) for speed in speeds.tolist()])
            self._law.make_locked_factors(at, self._temperature)

    def _entrainment(self, speed: float) -> float:
        """Entrainment speed of a node [m/s]: the one at the lowest speed has its whole film, whatever the rounding."""
        lowest, u = self._law.plain_table.lowest_speed, abs(self._rate * speed)
        return lowest if abs(u - lowest) < _ROUND_OFF * lowest else u

    def make(self, slot: int, speed: float, alone: bool) -> Made:
        """Make the table of a speed, see `SpeedWindow.make`."""
        before = dict(self._law.outside_counts)
        try:
            self._tables[slot] = self._law.at(self._entrainment(speed), self._temperature).memory.table.numbers
        except EhdmapsError:
            return Made(sound=False)  # the step that asks for it will be told why
        return Made(sound=True, outside=self._law.outside_counts != before)


LATEST, CHANGE, FADE, LOAD, TRIAL, AROUND = 0, 2, 3, 4, 5, 6
MEMORY = 22
"""Rows of the memory of the slices, see `ehdmaps/kernel/c/film/film_slices.c`, and how many there are."""

_BEFORE, _NO_CHANGE = 1, 1e-30
ACCEPTED, LAST, TRIED, _STEPS = range(4)
"""Times of a run, as in `ehdmaps/kernel/c/film/film_block.c`."""


def resume(films: FilmState, memory: FloatArray) -> None:
    """Go on from states.

    Parameters
    ----------
    films : FilmState
        Films of n slices.
    memory : array (MEMORY, n)
        Memory of the slices; written. Parabolas are read at the next step.
    """
    memory[:] = 0.0
    memory[[LATEST, _BEFORE, TRIAL]] = films.approach.reshape(-1)
    memory[CHANGE], memory[LOAD], memory[AROUND] = films.change.reshape(-1), films.load.reshape(-1), math.inf
    memory[FADE] = 1.5 / (np.abs(memory[CHANGE]) + _NO_CHANGE)


class MemoryBearings(Record):
    """Bearings with memory of a run as C takes them.

    Attributes
    ----------
    rings, course : Rings, Course
        What does not change; places of the steps on the tables.
    nodes, most : int
        Tables of each film; slices of all rollers together, of the bearing that has most.
    strict : array (bearings,), of int
        Whether a law refuses loads above its map.
    memory, states : array (bearings, sides, MEMORY most), (bearings, sides, 2 most)
        Memory of all slices; loads and slopes of the last answer.
    approaches, work : array (most,), (2 most,)
        Work space.
    spent : array (bearings,)
        What the films of each took up over the last step [J].
    clock : array (4,)
        Times of the run.
    tables, mixed, in_use : array (films, NODES, NUMBERS), (films, NUMBERS), (films, 2)
        Tables over the speed, those in use, and node and weight of these.
    """

    _fields_ = (
        ("rings", Rings),
        ("course", Course),
        *((name, ctypes.c_int64) for name in ("nodes", "most")),
        ("strict", integers),
        *((name, numbers) for name in ("memory", "states", "approaches", "work", "spent", "clock")),
        *((name, numbers) for name in ("tables", "mixed", "in_use")),
    )
    shapes: ClassVar = {"approaches": ("most",), "work": ("most", 2), "clock": (4,)}


class MemoryBlock(CourseBlock):
    """The bearings with memory of a run; contacts with the same law at the same conditions share their tables.

    Parameters
    ----------
    members : sequence of Member
        Elements of the class `BearingElement`, or of the class `RollerElement`, whose films relax.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        films_of, alike = alike_contacts(members)
        tables, in_use = np.zeros((len(alike), NODES, NUMBERS)), np.full((len(alike), 2), -1.0)
        laws = []
        for one, room in zip(alike, tables, strict=True):
            assert not isinstance(one.law.law, DryLaw)  # an element with memory refuses it
            laws.append(MemoryTables(one.law.law, one.temperature, one.rates[0], room))
        rings = gather_rings(members, films_of)
        super().__init__(CourseOfFilms(laws, in_turns=True), in_use)
        most = rings.most
        self._memory = np.zeros((*films_of.shape, MEMORY * most))
        self._clock = np.array([math.nan, 0.0, math.nan, 0.0])
        self.data = checked(MemoryBearings, "ehd_film_block")(
            rings=rings,
            course=course_of(0, len(laws)),
            nodes=NODES,
            most=most,
            strict=strict(members).astype(np.int64),
            memory=self._memory,
            states=np.zeros((*films_of.shape, 2 * most)),
            approaches=np.zeros(most),
            work=np.zeros(2 * most),
            spent=np.zeros(len(members)),
            clock=self._clock,
            tables=tables,
            mixed=np.zeros((len(laws), NUMBERS)),
            in_use=in_use,
        )
        self._shapes = list(zip(rings.given("rollers").tolist(), rings.given("slices").tolist(), strict=True))
        self._folds = [folding_of(member.element.plain) for member in members]

    def states(self) -> list[FilmStates]:
        """Films of each bearing after the last step that was made."""
        last, time = float(self._clock[LAST]), float(self._clock[ACCEPTED])
        states = []
        for b, fold in enumerate(self._folds):
            films = []
            for memory in self._memories(b):
                approach, change, load = (
                    memory[row].reshape(self._shapes[b])[:, fold.groups] for row in (LATEST, CHANGE, LOAD)
                )
                films.append(FilmState(approach, change, load, last))
            states.append(FilmStates(tuple(films), time))
        return states

    def resume(self, states: Sequence[FilmStates]) -> None:
        """Go on from the films that each bearing has in Python.

        Parameters
        ----------
        states : sequence of FilmStates
            One a bearing, all after the same step.
        """
        for b, (state, fold) in enumerate(zip(states, self._folds, strict=True)):
            for films, memory in zip(state.films, self._memories(b), strict=True):
                resume(_slices(films, fold.firsts), memory)
                self._clock[: TRIED + 1] = state.time, films.step, math.nan

    def _memories(self, b: int) -> list[FloatArray]:
        """Memory of the slices of a bearing, side by side, (MEMORY, Z n) each."""
        size = math.prod(self._shapes[b])
        return [side[: MEMORY * size].reshape(MEMORY, size) for side in self._memory[b]]


def _slices(films: FilmState, which: IntArray) -> FilmState:
    """Films of some slices of all rollers, in a given order."""
    return dataclasses.replace(
        films, approach=films.approach[:, which], change=films.change[:, which], load=films.load[:, which]
    )


MEMORY_BEARINGS = Kind(
    answer="ehd_film_block_answer",
    feels=feels,
    gather=MemoryBlock,
    accept="ehd_film_block_accept",
    powers="ehd_film_block_powers",
    placed=placed,
)
"""For `mbs.transient.kinds`."""

MEMORY_ROLLERS = dataclasses.replace(MEMORY_BEARINGS, placed=None, alone=alone)
"""The same with rollers as bodies."""
