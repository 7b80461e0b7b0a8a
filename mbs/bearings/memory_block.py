"""Bearings whose films have a memory, in compiled runs: each slice has a state, which goes on when a step is made.

Rollers are massless, with one contact that stands for both in series, or bodies with two contacts each. Steps begin
and go on as in `mbs.bearings.memory_kernel`.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import in_python, njit
from ehdmaps.maps.memory import FilmState
from ehdmaps.maps.memory_table import step_of
from mbs.bearings.bearing_element import FilmStates, MemoryBearing
from mbs.bearings.bearing_kernel import assemble_level_slices, assemble_slices
from mbs.bearings.laws import DryLaw
from mbs.bearings.memory_kernel import (
    ACCEPTED,
    HIGHEST,
    LAST,
    MEMORY,
    STEPS,
    TRIED,
    MemoryFilms,
    MemoryTables,
    begin,
    begin_step,
    commit,
    films_of_rows,
    loads,
    make_step,
    new_clock,
    resume_rows,
    room,
    spent,
    table_in_use,
)
from mbs.bearings.rings import (
    LEVEL,
    Contact,
    Place,
    Rings,
    Rollers,
    add_contact,
    alone,
    answer_ring,
    begin_answer,
    feels,
    folding_of,
    gather_rings,
    gather_rollers,
    motion_of,
    outward_power,
    place_of,
    placed,
    rollers_feel,
    shape_of,
    turned_by,
)
from mbs.bearings.roller_element import ContactStates, MemoryRollers
from mbs.bearings.slices import Sizes, check_motion, sizes_of, slice_approaches
from mbs.bearings.speed_tables import Course, CourseOfFilms, FilmBlock, course_of, shared
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
    if bearings.clock[TRIED] != moment.time:
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


class MemoryRollerBearings(NamedTuple):
    """Bearings with rollers that are bodies, and films with memory, as arrays.

    Attributes
    ----------
    rollers : Rollers
        What does not change.
    strict : array (bearings,), of bool
        Whether the laws refuse loads above their map.
    memory : array (bearings, 2, MEMORY Z n)
        Memory of the slices of the inner and outer contacts, see `mbs.bearings.memory_kernel`.
    approaches : array (Z n,)
        Work space for one row of contacts after the other [m].
    answered : array (bearings, 2, 2 Z n)
        Loads and tangents of the last answer.
    spent : array (bearings,)
        What the films of each took up over the last step [J].
    clock : array (4,)
        Times of the run, see `mbs.bearings.memory_kernel`.
    films : MemoryFilms
        Tables of the laws of single contacts.
    course : Course
        Places of the steps on them.
    """

    rollers: Rollers
    strict: BoolArray
    memory: FloatArray
    approaches: FloatArray
    answered: FloatArray
    spent: FloatArray
    clock: FloatArray
    films: MemoryFilms
    course: Course


@njit(error_model="numpy")
def _memory_of(bearings: MemoryRollerBearings, b: int, side: int) -> FloatArray:
    """Memory of the slices of one side of a bearing, shape (MEMORY, Z n), contiguous."""
    size = bearings.rollers.rings.rollers[b] * bearings.rollers.rings.slices[b]
    memory: FloatArray = bearings.memory[b, side][: MEMORY * size].reshape(MEMORY, size)
    return memory


@njit(error_model="numpy")
def _begin_rollers(bearings: MemoryRollerBearings, moment: Moment) -> None:
    """Begin a step: tables, and what slices start from."""
    films, rollers, steps = bearings.films, bearings.rollers, int(bearings.clock[STEPS])
    growth, kept = begin_step(bearings.clock, films, bearings.course, moment), bearings.course.kept[moment.step]
    for b in range(bearings.strict.size):
        for side in range(2):
            begin(table_in_use(films, rollers.films_of[b, side]), growth, steps, kept, _memory_of(bearings, b, side))


@njit(error_model="numpy")
def _moves_within(place: Place, sizes: Sizes) -> bool:
    """Whether approaches are finite and within reason."""
    far, tilt = sizes.most_travel, sizes.most_tilt
    return abs(place.approach[0]) <= far and abs(place.approach[1]) <= far and abs(place.tilt) <= tilt


@njit(error_model="numpy")
def _answer_rollers(
    bearings: MemoryRollerBearings, b: int, moment: Moment, motion: FloatArray, answers: Answers
) -> tuple[bool, bool]:
    """Forces and tangents of a bearing among the answers; whether it has any, and a load is above the map."""
    rollers, films, clock = bearings.rollers, bearings.films, bearings.clock
    rings = rollers.rings
    z, n = rings.rollers[b], rings.slices[b]
    x, profile, sizes = rings.positions[b][:n], rings.profiles[b][:n], sizes_of(rings.sizes[b])
    angle = rings.start_angles[b] + rings.cage_rates[b] * moment.angle
    cage = math.cos(angle), math.sin(angle)
    deltas, above = bearings.approaches[: z * n], False
    begin_answer(rollers, b, moment, answers)
    for side in range(2):
        for j in range(z):
            place = place_of(rollers, b, j, cage, motion)
            if not _moves_within(place, sizes):
                return False, above
            row = deltas[j * n : (j + 1) * n]
            for i in range(n):
                row[i] = place.approach[side] + x[i] * place.tilt - 0.5 * profile[i]
        table = table_in_use(films, rollers.films_of[b, side])
        memory = _memory_of(bearings, b, side)
        answered = bearings.answered[b, side][: 2 * z * n].reshape(2, z * n)
        step = step_of(moment.time - clock[ACCEPTED], clock[LAST])
        loads(table, step, memory, deltas, answered[0], answered[1])
        highest = 0.0
        for j in range(z):
            w, dw = answered[0, j * n : (j + 1) * n], answered[1, j * n : (j + 1) * n]
            w0 = w1 = k0 = k1 = k2 = 0.0
            for i in range(n):
                w0 += w[i]
                w1 += w[i] * x[i]
                k0 += dw[i]
                k1 += dw[i] * x[i]
                k2 += dw[i] * x[i] * x[i]
                highest = max(highest, w[i])
            length = sizes.slice_length
            slope = moment.by_q * length
            contact = Contact(w0 * length, w1 * length, k0 * slope, k1 * slope, k2 * slope)
            add_contact(rollers, b, j, side, place_of(rollers, b, j, cage, motion), contact, answers)
        above = above or highest > films.mixed[rollers.films_of[b, side], HIGHEST]
    return True, above


@njit(error_model="numpy")
def memory_rollers_answer(bearings: MemoryRollerBearings, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and tangents of all bearings at the end of a step; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings : MemoryRollerBearings
        The bearings, with their states and the tables of their laws.
    moment : Moment
        Step, its end, angle, speed, weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    if bearings.clock[TRIED] != moment.time:
        _begin_rollers(bearings, moment)
    rollers, course = bearings.rollers, bearings.course
    for b in range(bearings.strict.size):
        found, above = _answer_rollers(bearings, b, moment, motion, answers)
        if not found:
            return NO_SOLUTION
        if above and bearings.strict[b]:
            return IN_PYTHON
        outside = (
            course.outside[moment.step, rollers.films_of[b, 0]] + course.outside[moment.step, rollers.films_of[b, 1]]
        )
        answers.outside[rollers.rings.places[b]] += 1 if above or outside > 0 else 0
    return FOUND


@njit(error_model="numpy")
def memory_rollers_powers(
    bearings: MemoryRollerBearings, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray
) -> None:
    """What films take up, and what the cage brings in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings, moment, motion, answers
        The same as of `memory_rollers_answer`.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    rollers = bearings.rollers
    rings = rollers.rings
    for b in range(bearings.strict.size):
        out[rings.places[b], 0], out[rings.places[b], 2] = 0.0, bearings.spent[b]
        torque = turned_by(rings.firsts[b], 3, motion, answers)
        outward = outward_power(rollers, b, moment, motion)
        out[rings.places[b], 1] = torque * rings.cage_rates[b] * moment.speed + outward


@njit(error_model="numpy")
def memory_rollers_accept(bearings: MemoryRollerBearings, moment: Moment) -> None:
    """Make the step: states go on; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings : MemoryRollerBearings
        The bearings.
    moment : Moment
        The step that was answered last.
    """
    rollers = bearings.rollers
    for b in range(bearings.strict.size):
        size = rollers.rings.rollers[b] * rollers.rings.slices[b]
        length = sizes_of(rollers.rings.sizes[b]).slice_length
        weights = rollers.rings.weights[b][: rollers.rings.slices[b]]
        bearings.spent[b] = 0.0
        for side in range(2):
            table, memory = table_in_use(bearings.films, rollers.films_of[b, side]), _memory_of(bearings, b, side)
            loads_now = bearings.answered[b, side][:size]
            bearings.spent[b] += spent(table, memory, loads_now, weights) * length
            commit(table, memory, loads_now)
    make_step(bearings.clock, moment)


class MemoryRollerBlock(FilmBlock[MemoryRollerBearings]):
    """The bearings of a run; contacts with the same law at the same speed and temperature share their tables.

    Parameters
    ----------
    members : sequence of Member
        Elements of the class `MemoryRollers`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        elements: list[MemoryRollers] = [member.element for member in members]
        pairs = [(element.plain, law) for element in elements for law in element.laws]
        films_of, firsts = shared((id(law), plain.temperature, plain.rates[1]) for plain, law in pairs)
        tables = [MemoryTables(law, plain.temperature, plain.rates[1]) for plain, law in map(pairs.__getitem__, firsts)]
        rollers, films = gather_rollers(members, films_of), room(len(tables))
        course = CourseOfFilms(
            [table.places for table in tables],
            lambda film, *places: tables[film].prepare(*places, films, film),
        )
        count, most = len(elements), rollers.rings.most_slices
        arrays = MemoryRollerBearings(
            rollers=rollers,
            strict=np.array([any(law.outside == "error" for law in each.laws) for each in elements], dtype=np.bool_),
            memory=np.zeros((count, 2, MEMORY * most)),
            approaches=np.zeros(most),
            answered=np.zeros((count, 2, 2 * most)),
            spent=np.zeros(len(elements)),
            clock=new_clock(),
            films=films,
            course=course_of(0, len(tables)),
        )
        super().__init__(course, arrays)

    def states(self) -> list[ContactStates]:
        """Films of both contacts of each bearing after the last step that was made."""
        last, time = float(self._arrays.clock[LAST]), float(self._arrays.clock[ACCEPTED])
        found = []
        for b in range(self._arrays.strict.size):
            inner, outer = (films_of_rows(self._rows(b, side), self._shape(b), last) for side in range(2))
            found.append(ContactStates((inner, outer), time))
        return found

    def resume(self, states: Sequence[ContactStates]) -> None:
        """Go on from the films that each bearing has in Python.

        Parameters
        ----------
        states : sequence of ContactStates
            One a bearing, all after the same step.
        """
        for b, state in enumerate(states):
            for side, films in enumerate(state.films):
                resume_rows(films, state.time, self._rows(b, side), self._arrays.clock)

    def _shape(self, b: int) -> tuple[int, int]:
        """Rollers and slices of a bearing."""
        rings = self._arrays.rollers.rings
        return int(rings.rollers[b]), int(rings.slices[b])

    def _rows(self, b: int, side: int) -> FloatArray:
        """Memory of the slices of one side of a bearing."""
        rows: FloatArray = in_python(_memory_of)(self._arrays, b, side)
        return rows


MEMORY_ROLLERS = Kind(
    arrays=MemoryRollerBearings,
    answer=memory_rollers_answer,
    feels=rollers_feel,
    gather=MemoryRollerBlock,
    accept=memory_rollers_accept,
    powers=memory_rollers_powers,
    alone=alone,
)
"""For `mbs.transient.kinds`."""
