"""Rollers that are bodies, in compiled runs, with films that have a memory: each contact of a roller has its own.

Steps begin and go on as in `mbs.bearings.film_clock`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.compiled import in_python, njit
from ehdmaps.maps.memory_table import step_of
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
from mbs.bearings.memory_kernel import MEMORY, begin, commit, loads, spent
from mbs.bearings.memory_rollers import ContactStates, MemoryRollers
from mbs.bearings.memory_tables import HIGHEST, MemoryFilms, MemoryTables, room, table_in_use
from mbs.bearings.rings import turned_by
from mbs.bearings.roller_motion import Sizes, sizes_of
from mbs.bearings.roller_places import (
    Contact,
    Place,
    Rollers,
    add_contact,
    alone,
    begin_answer,
    feels,
    gather_rollers,
    outward_power,
    place_of,
)
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment


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
        Times of the run, see `mbs.bearings.film_clock`.
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
def _begin(bearings: MemoryRollerBearings, moment: Moment) -> None:
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
def _answer(
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
    if bearings.clock[TRIAL] != moment.time:
        _begin(bearings, moment)
    rollers, course = bearings.rollers, bearings.course
    for b in range(bearings.strict.size):
        found, above = _answer(bearings, b, moment, motion, answers)
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
    feels=feels,
    gather=MemoryRollerBlock,
    accept=memory_rollers_accept,
    powers=memory_rollers_powers,
    alone=alone,
)
"""For `mbs.transient.kinds`."""
