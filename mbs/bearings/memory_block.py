"""Bearings whose films have a memory, in compiled runs: each slice has a state, which goes on when a step is made.

Rollers are massless, with one contact that stands for both in series, or bodies with two contacts each. Steps begin
and go on as in `mbs.bearings.memory_kernel`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import in_python, njit
from ehdmaps.maps.kernels.memory import FilmState
from ehdmaps.maps.kernels.memory_table import step_of
from mbs.bearings.bearing_element import FilmStates
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
    add_contact,
    alike_contacts,
    alone,
    answer_ring,
    begin_answer,
    cage_of,
    feels,
    folding_of,
    gather_rings,
    motion_of,
    outward_power,
    place_of,
    placed,
    plain,
    shape_of,
    strict,
    turned_by,
)
from mbs.bearings.slices import TOO_FAR, Sizes, check_motion, sizes_of, slice_approaches
from mbs.bearings.speed_tables import Course, CourseOfFilms, FilmBlock, course_of
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment


class MemoryBearings(NamedTuple):
    """Bearings with memory as arrays, one row a bearing.

    Attributes
    ----------
    rings : Rings
        What does not change.
    strict : array (bearings,), of bool
        Whether a law refuses loads above its map.
    memory : array (bearings, sides, MEMORY Z n)
        Memory of all slices, see `mbs.bearings.memory_kernel`.
    approaches : array (Z n,)
        Work space for one side of the contacts of a bearing after the other [m].
    states : array (bearings, sides, 4 Z n)
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
def memory_of(bearings: MemoryBearings, b: int, side: int) -> FloatArray:
    """Memory of the slices of one side, shape (MEMORY, Z n), contiguous.

    Parameters
    ----------
    bearings : MemoryBearings
        All bearings.
    b, side : int
        Which bearing, and which side of its contacts.
    """
    size = bearings.rings.rollers[b] * bearings.rings.slices[b]
    memory: FloatArray = bearings.memory[b, side][: MEMORY * size].reshape(MEMORY, size)
    return memory


@njit(error_model="numpy")
def _begin(bearings: MemoryBearings, moment: Moment) -> None:
    """Begin a step: tables, and what slices start from."""
    films, films_of, steps = bearings.films, bearings.rings.films_of, int(bearings.clock[STEPS])
    growth, kept = begin_step(bearings.clock, films, bearings.course, moment), bearings.course.kept[moment.step]
    for b in range(films_of.shape[0]):
        for side in range(films_of.shape[1]):
            begin(table_in_use(films, films_of[b, side]), growth, steps, kept, memory_of(bearings, b, side))


@njit(error_model="numpy")
def _settled(bearings: MemoryBearings, b: int, side: int, moment: Moment) -> tuple[FloatArray, bool]:
    """Loads and tangents of the slices of a side at their approaches, (4, Z n), and whether a load is above the map."""
    size, film = bearings.rings.rollers[b] * bearings.rings.slices[b], bearings.rings.films_of[b, side]
    states = bearings.states[b, side][: 4 * size].reshape(4, size)
    step = step_of(moment.time - bearings.clock[ACCEPTED], bearings.clock[LAST])
    table, memory = table_in_use(bearings.films, film), memory_of(bearings, b, side)
    loads(table, step, memory, bearings.approaches[:size], states[0], states[1])
    return states, np.max(states[0]) > bearings.films.mixed[film, HIGHEST]


@njit(error_model="numpy")
def _on_rings(bearings: MemoryBearings, b: int, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Write the answer of a bearing with massless rollers; 1 with a load above the map, negative without an answer."""
    rings, out = bearings.rings, np.empty((13, 6))
    z, n = rings.rollers[b], rings.slices[b]
    ring, shape = motion_of(rings, b, moment, motion), shape_of(rings, b)
    wrong = check_motion(ring, shape.sizes)
    if wrong != 0:
        return wrong
    slice_approaches(ring, shape, bearings.approaches[: z * n])
    states, above = _settled(bearings, b, 0, moment)
    if rings.felt[b] == LEVEL:
        assemble_level_slices(ring, shape, rings.weights[b][:n], states.reshape(4, z, n), out)
    else:
        assemble_slices(ring, shape, states.reshape(4, z, n), out)
    answer_ring(rings.firsts[b], rings.felt[b], moment, out, answers)
    return 1 if above else 0


@njit(error_model="numpy")
def _moves_within(place: Place, sizes: Sizes) -> bool:
    """Tell whether approaches are finite and within reason."""
    far, tilt = sizes.most_travel, sizes.most_tilt
    return abs(place.approach[0]) <= far and abs(place.approach[1]) <= far and abs(place.tilt) <= tilt


@njit(error_model="numpy")
def _on_rollers(bearings: MemoryBearings, b: int, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """`_on_rings` of a bearing whose rollers are bodies, side by side."""
    rings, deltas, beyond = bearings.rings, bearings.approaches, 0
    z, n = rings.rollers[b], rings.slices[b]
    x, profile, sizes = rings.positions[b][:n], rings.profiles[b][:n], sizes_of(rings.sizes[b])
    cage, length = cage_of(rings, b, moment), sizes.slice_length
    slope = moment.by_q * length
    begin_answer(rings, b, moment, answers)
    for side in range(2):
        for j in range(z):
            place = place_of(rings, b, j, cage, motion)
            if not _moves_within(place, sizes):
                return TOO_FAR
            row = deltas[j * n : (j + 1) * n]
            for i in range(n):
                row[i] = place.approach[side] + x[i] * place.tilt - 0.5 * profile[i]
        states, above = _settled(bearings, b, side, moment)
        for j in range(z):
            w, dw = states[0, j * n : (j + 1) * n], states[1, j * n : (j + 1) * n]
            w0 = w1 = k0 = k1 = k2 = 0.0
            for i in range(n):
                w0 += w[i]
                w1 += w[i] * x[i]
                k0 += dw[i]
                k1 += dw[i] * x[i]
                k2 += dw[i] * x[i] * x[i]
            contact = Contact(w0 * length, w1 * length, k0 * slope, k1 * slope, k2 * slope)
            add_contact(rings, b, j, side, place_of(rings, b, j, cage, motion), contact, answers)
        beyond = 1 if above else beyond
    return beyond


@njit(error_model="numpy")
def memory_answer(bearings: MemoryBearings, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and tangents of all bearings at the end of a step; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings : MemoryBearings
        The bearings, with their states and the tables of their laws.
    moment : Moment
        Step, its end, angle, speed, weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    if bearings.clock[TRIED] != moment.time:
        _begin(bearings, moment)
    course, rings = bearings.course, bearings.rings
    count, sides = rings.films_of.shape
    for b in range(count):
        status = 0
        if sides == 1:
            status = _on_rings(bearings, b, moment, motion, answers)
        else:
            status = _on_rollers(bearings, b, moment, motion, answers)
        if status < 0:
            return NO_SOLUTION
        if status > 0 and bearings.strict[b]:
            return IN_PYTHON
        for side in range(sides):
            status = max(status, course.outside[moment.step, rings.films_of[b, side]])
        answers.outside[rings.places[b]] += status
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
    rings = bearings.rings
    count, sides = rings.films_of.shape
    for b in range(count):
        size, weights = rings.rollers[b] * rings.slices[b], rings.weights[b][: rings.slices[b]]
        length = sizes_of(rings.sizes[b]).slice_length
        bearings.spent[b] = 0.0
        for side in range(sides):
            table, memory = table_in_use(bearings.films, rings.films_of[b, side]), memory_of(bearings, b, side)
            loads_now = bearings.states[b, side][:size]
            bearings.spent[b] += spent(table, memory, loads_now, weights) * length
            commit(table, memory, loads_now)
    make_step(bearings.clock, moment)


@njit(error_model="numpy")
def memory_powers(
    bearings: MemoryBearings, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray
) -> None:
    """Write what films take up, and what cage and centrifugal forces bring in; see `mbs.model.blocks.Kind`.

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
        out[place, 1] = torque * rings.cage_rates[b] * moment.speed + outward_power(rings, b, moment, motion)


class MemoryBlock(FilmBlock[MemoryBearings]):
    """The bearings with memory of a run; contacts with the same law at the same conditions share their tables.

    Parameters
    ----------
    members : sequence of Member
        Elements of the class `MemoryBearing`, or of the class `MemoryRollers`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        films_of, alike = alike_contacts(members)
        tables = []
        for one in alike:
            assert not isinstance(one.law.law, DryLaw)  # an element with memory refuses it
            tables.append(MemoryTables(one.law.law, one.temperature, one.rates[0]))
        rings, films = gather_rings(members, films_of), room(len(tables))
        course = CourseOfFilms(
            [table.places for table in tables],
            lambda film, *places: tables[film].prepare(*places, films, film),
            in_turns=True,
        )
        arrays = MemoryBearings(
            rings=rings,
            strict=strict(members),
            memory=np.zeros((*films_of.shape, MEMORY * rings.most_slices)),
            approaches=np.zeros(rings.most_slices),
            states=np.zeros((*films_of.shape, 4 * rings.most_slices)),
            spent=np.zeros(len(members)),
            clock=new_clock(),
            films=films,
            course=course_of(0, len(tables)),
        )
        super().__init__(course, arrays)
        self._folds = [folding_of(plain(member.element)) for member in members]

    def states(self) -> list[FilmStates]:
        """Films of each bearing after the last step that was made."""
        rings, last, time = self._arrays.rings, float(self._arrays.clock[LAST]), float(self._arrays.clock[ACCEPTED])
        states = []
        for b, fold in enumerate(self._folds):
            shape = int(rings.rollers[b]), int(rings.slices[b])
            films = [_slices(films_of_rows(rows, shape, last), fold.groups) for rows in self._rows(b)]
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
            for films, rows in zip(state.films, self._rows(b), strict=True):
                resume_rows(_slices(films, fold.firsts), state.time, rows, self._arrays.clock)

    def _rows(self, b: int) -> list[FloatArray]:
        """Memory of the slices of a bearing, side by side."""
        sides = self._arrays.rings.films_of.shape[1]
        return [in_python(memory_of)(self._arrays, b, side) for side in range(sides)]


def _slices(films: FilmState, which: IntArray) -> FilmState:
    """Films of some slices of all rollers, in a given order."""
    return dataclasses.replace(
        films, approach=films.approach[:, which], change=films.change[:, which], load=films.load[:, which]
    )


MEMORY_BEARINGS = Kind(
    arrays=MemoryBearings,
    answer=memory_answer,
    feels=feels,
    gather=MemoryBlock,
    accept=memory_accept,
    powers=memory_powers,
    placed=placed,
)
"""For `mbs.transient.kinds`."""

MEMORY_ROLLERS = dataclasses.replace(MEMORY_BEARINGS, placed=None, alone=alone)
"""The same with rollers as bodies."""
