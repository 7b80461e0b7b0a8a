"""Bearings whose films have a memory, in compiled runs: each slice has a state, which goes on when a step is made.

How a step begins, and what then goes on, has its home in `mbs.bearings.film_clock`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import in_python, njit
from ehdmaps.maps.memory import FilmState
from ehdmaps.maps.memory_table import step_of
from mbs.bearings.bearing_kernel import assemble_slices
from mbs.bearings.film_clock import (
    ACCEPTED,
    LAST,
    STEPS,
    TRIAL,
    begin_step,
    films_of_rows,
    make_step,
    new_clock,
    resume_rows,
)
from mbs.bearings.film_course import Course, CourseOfFilms, FilmBlock, course_of, shared
from mbs.bearings.laws import DryLaw
from mbs.bearings.level_kernel import assemble_level_slices
from mbs.bearings.memory_element import FilmStates, MemoryBearing
from mbs.bearings.memory_kernel import MEMORY, begin, commit, loads, spent
from mbs.bearings.memory_tables import HIGHEST, MemoryFilms, MemoryTables, room, table_in_use
from mbs.bearings.rings import (
    LEVEL,
    Rings,
    answer_ring,
    feels,
    folding_of,
    gather_rings,
    motion_of,
    placed,
    shape_of,
    turned_by,
)
from mbs.bearings.roller_motion import check_motion, sizes_of, slice_approaches
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment
from mbs.model.elements import Element


class MemoryBearings(NamedTuple):
    """Bearings with memory as arrays, one row a bearing.

    Attributes
    ----------
    rings : Rings
        What does not change.
    strict : array (bearings,), of bool
        Whether the law refuses loads above its map.
    memory : array (bearings, MEMORY Z n)
        Memory of all slices, see `mbs.bearings.memory_kernel`.
    approaches : array (Z n,)
        Work space for one bearing after the other [m].
    states : array (bearings, 4 Z n)
        Loads and tangents of the last answer; the other rows are zero.
    spent : array (bearings,)
        What the films of each took up over the last step [J].
    clock : array (4,)
        Times of the run.
    films : MemoryFilms
        Tables of the laws.
    course : Course
        Places of the steps on them.
    """

    rings: Rings
    strict: BoolArray
    memory: FloatArray
    approaches: FloatArray
    states: FloatArray
    spent: FloatArray
    clock: FloatArray
    films: MemoryFilms
    course: Course


@njit(error_model="numpy")
def memory_of(bearings: MemoryBearings, b: int) -> FloatArray:
    """Memory of the slices of a bearing, shape (MEMORY, Z n), contiguous."""
    size = bearings.rings.rollers[b] * bearings.rings.slices[b]
    memory: FloatArray = bearings.memory[b][: MEMORY * size].reshape(MEMORY, size)
    return memory


@njit(error_model="numpy")
def _begin(bearings: MemoryBearings, moment: Moment) -> None:
    """Begin a step: tables, and what its slices start from."""
    films, steps = bearings.films, int(bearings.clock[STEPS])
    growth, kept = begin_step(bearings.clock, films, bearings.course, moment), bearings.course.kept[moment.step]
    for b in range(bearings.rings.firsts.size):
        begin(table_in_use(films, bearings.rings.films_of[b]), growth, steps, kept, memory_of(bearings, b))


@njit(error_model="numpy")
def _answer(bearings: MemoryBearings, b: int, moment: Moment, motion: FloatArray, out: FloatArray) -> int:
    """Force and tangent of a bearing into `out` (13, 6); status as of `bearing_force`."""
    rings = bearings.rings
    z, n, film = rings.rollers[b], rings.slices[b], rings.films_of[b]
    ring, shape = motion_of(rings, b, moment, motion), shape_of(rings, b)
    wrong = check_motion(ring, shape.sizes)
    if wrong != 0:
        return wrong
    size = z * n
    table, memory, deltas = table_in_use(bearings.films, film), memory_of(bearings, b), bearings.approaches[:size]
    states = bearings.states[b][: 4 * size].reshape(4, size)
    slice_approaches(ring, shape, deltas)
    step = step_of(moment.time - bearings.clock[ACCEPTED], bearings.clock[LAST])
    loads(table, step, memory, deltas, states[0], states[1])
    if rings.felt[b] == LEVEL:
        assemble_level_slices(ring, shape, rings.weights[b][:n], states.reshape(4, z, n), out)
    else:
        assemble_slices(ring, shape, states.reshape(4, z, n), out)
    return 1 if np.max(states[0]) > bearings.films.mixed[film, HIGHEST] else 0


@njit(error_model="numpy")
def memory_answer(bearings: MemoryBearings, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and tangents of all bearings at the end of a step; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings : MemoryBearings
        The bearings, with their states and the tables of their laws.
    moment : Moment
        Step, its end, angle, weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    if bearings.clock[TRIAL] != moment.time:
        _begin(bearings, moment)
    course, rings = bearings.course, bearings.rings
    out = np.empty((13, 6))
    for b in range(rings.firsts.size):
        status = _answer(bearings, b, moment, motion, out)
        if status < 0:
            return NO_SOLUTION
        if status > 0 and bearings.strict[b]:
            return IN_PYTHON
        outside = course.outside[moment.step, rings.films_of[b]]
        answers.outside[rings.places[b]] += 1 if status > 0 or outside > 0 else 0
        answer_ring(rings.firsts[b], rings.felt[b], moment, out, answers)
    return FOUND


@njit(error_model="numpy")
def memory_accept(bearings: MemoryBearings, moment: Moment) -> None:
    """Make the step: states go on; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings : MemoryBearings
        The bearings.
    moment : Moment
        The step that was answered last.
    """
    for b in range(bearings.rings.firsts.size):
        size = bearings.rings.rollers[b] * bearings.rings.slices[b]
        table, memory = table_in_use(bearings.films, bearings.rings.films_of[b]), memory_of(bearings, b)
        loads_now, weights = bearings.states[b][:size], bearings.rings.weights[b][: bearings.rings.slices[b]]
        taken = spent(table, memory, loads_now, weights)
        bearings.spent[b] = taken * sizes_of(bearings.rings.sizes[b]).slice_length
        commit(table, memory, loads_now)
    make_step(bearings.clock, moment)


@njit(error_model="numpy")
def memory_powers(
    bearings: MemoryBearings, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray
) -> None:
    """What films take up, and what the cage brings in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings, moment, motion, answers
        The same as of `memory_answer`.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    rings = bearings.rings
    for b in range(rings.firsts.size):
        place, torque = rings.places[b], turned_by(rings.firsts[b], rings.felt[b] // 2, motion, answers)
        out[place, 0], out[place, 2] = 0.0, bearings.spent[b]
        out[place, 1] = torque * rings.cage_rates[b] * moment.speed


class MemoryBlock(FilmBlock[MemoryBearings]):
    """The bearings with memory of a run; those with the same law at the same speed and temperature share their tables.

    Parameters
    ----------
    members : sequence of Member
        Elements of the class `MemoryBearing`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        elements: list[MemoryBearing] = [member.element for member in members]
        films_of, firsts = shared((id(element.law), element.temperature, element.rates[1]) for element in elements)
        tables = [
            MemoryTables(element.law, element.temperature, element.rates[1])
            for element in (elements[first] for first in firsts)
        ]
        rings, films = gather_rings(members, films_of), room(len(tables))
        course = CourseOfFilms(
            [table.places for table in tables],
            lambda film, *places: tables[film].prepare(*places, films, film),
        )
        arrays = MemoryBearings(
            rings=rings,
            strict=np.array([element.law.outside == "error" for element in elements], dtype=np.bool_),
            memory=np.zeros((len(elements), MEMORY * rings.most_slices)),
            approaches=np.zeros(rings.most_slices),
            states=np.zeros((len(elements), 4 * rings.most_slices)),
            spent=np.zeros(len(elements)),
            clock=new_clock(),
            films=films,
            course=course_of(0, len(tables)),
        )
        super().__init__(course, arrays)
        self._folds = [folding_of(element) for element in elements]

    def states(self) -> list[FilmStates]:
        """Films of each bearing after the last step that was made."""
        last, time = float(self._arrays.clock[LAST]), float(self._arrays.clock[ACCEPTED])
        return [
            FilmStates(_slices(films_of_rows(self._rows(b), self._shape(b), last), fold.groups), time)
            for b, fold in enumerate(self._folds)
        ]

    def resume(self, states: Sequence[FilmStates]) -> None:
        """Go on from the films that each bearing has in Python.

        Parameters
        ----------
        states : sequence of FilmStates
            One a bearing, all after the same step.
        """
        for b, (state, fold) in enumerate(zip(states, self._folds, strict=True)):
            resume_rows(_slices(state.films, fold.firsts), state.time, self._rows(b), self._arrays.clock)

    def _shape(self, b: int) -> tuple[int, int]:
        """Rollers and slices of a bearing."""
        rings = self._arrays.rings
        return int(rings.rollers[b]), int(rings.slices[b])

    def _rows(self, b: int) -> FloatArray:
        """Memory of the slices of a bearing."""
        rows: FloatArray = in_python(memory_of)(self._arrays, b)
        return rows


def _slices(films: FilmState, which: IntArray) -> FilmState:
    """Films of some slices of all rollers, in a given order."""
    return dataclasses.replace(
        films, approach=films.approach[:, which], change=films.change[:, which], load=films.load[:, which]
    )


def _takes(element: Element) -> bool:
    """Whether the law has a memory in compiled code."""
    return isinstance(element, MemoryBearing) and not isinstance(element.law, DryLaw)


MEMORY_BEARINGS = Kind(
    arrays=MemoryBearings,
    answer=memory_answer,
    feels=feels,
    gather=MemoryBlock,
    takes=_takes,
    accept=memory_accept,
    powers=memory_powers,
    placed=placed,
)
"""For `mbs.transient.kinds`."""
