"""Steps of compiled runs with films that have a memory: what begins a step, and what goes on when it is made.

The first question at the end of a new step begins it, with the states of the last step that was made, here or in
Python. Questions at other motions, and steps that are tried again with another length, leave these alone. Tables over
the speed are mixed as often as slices read them, see `Course.kept`.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.memory import FilmState
from mbs.bearings.film_course import Course
from mbs.bearings.memory_kernel import CHANGE, LATEST, LOAD, resume
from mbs.bearings.memory_tables import MemoryFilms, mix
from mbs.model.blocks import Moment

ACCEPTED, LAST, TRIAL, STEPS = range(4)
"""Times of a run: end of the last step that was made [s]; its length [s], 0 if there was none; end of the step that is
tried [s], NaN before that is known; and how many were made."""


def new_clock() -> FloatArray:
    """Times of a run that has made no step, shape (4,)."""
    return np.array([math.nan, 0.0, math.nan, 0.0])


@njit(error_model="numpy")
def begin_step(clock: FloatArray, films: MemoryFilms, course: Course, moment: Moment) -> float:
    """Begin a step: its time, and the tables; the length of the step by that of the last one, 0 at the first.

    Parameters
    ----------
    clock : array (4,)
        Times of the run; written.
    films : MemoryFilms
        Tables of the laws; mixed anew where it is their turn.
    course : Course
        Places of the steps on them.
    moment : Moment
        The step.
    """
    clock[TRIAL] = moment.time
    for film in range(films.in_use.shape[0]):
        if films.in_use[film, 0] < 0.0 or int(clock[STEPS]) % course.kept[moment.step] == 0:
            mix(films, film, course.nodes[moment.step, film], course.weights[moment.step, film])
    return (moment.time - clock[ACCEPTED]) / clock[LAST] if clock[LAST] > 0.0 else 0.0


@njit(error_model="numpy")
def make_step(clock: FloatArray, moment: Moment) -> None:
    """Count a step that is made.

    Parameters
    ----------
    clock : array (4,)
        Times of the run; written.
    moment : Moment
        The step.
    """
    clock[LAST] = moment.time - clock[ACCEPTED]
    clock[ACCEPTED] = moment.time
    clock[STEPS] += 1.0


def films_of_rows(rows: FloatArray, shape: tuple[int, int], last: float) -> FilmState:
    """Films of slices after a step, from their memory in compiled code.

    Parameters
    ----------
    rows : array (MEMORY, Z n)
        Memory of the slices, see `mbs.bearings.memory_kernel`.
    shape : (int, int)
        Rollers Z and slices n.
    last : float
        Length of the step [s].
    """
    approach, change, load = (rows[row].reshape(shape).copy() for row in (LATEST, CHANGE, LOAD))
    return FilmState(approach, change, load, last)


def resume_rows(films: FilmState, time: float, rows: FloatArray, clock: FloatArray) -> None:
    """Go on from films that Python has.

    Parameters
    ----------
    films : FilmState
        Films after the last step.
    time : float
        End of that step [s].
    rows : array (MEMORY, Z n)
        Memory of the slices in compiled code; written.
    clock : array (4,)
        Times of the run; written.
    """
    resume(films.approach.reshape(-1), films.change.reshape(-1), films.load.reshape(-1), rows)
    clock[: TRIAL + 1] = time, films.step, math.nan
