"""Where the tables of the films of a compiled run lie, and what all blocks of bearings with such tables do."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray

ArraysOfFilms = TypeVar("ArraysOfFilms", bound=Any)
"""Named tuple of arrays with the fields `films`, tables of the laws, and `course`, a `Course`."""


class Course(NamedTuple):
    """Where the tables of some steps lie.

    Attributes
    ----------
    nodes, weights : array (steps, films)
        Node below the speed, and the part of the way to the next one.
    outside : array (steps, films), of int
        Whether speed or temperature lie outside the map.
    kept : array (steps,), of int
        Steps for which what was read from the tables holds.
    """

    nodes: IntArray
    weights: FloatArray
    outside: IntArray
    kept: IntArray


MOST_KEPT = 8
"""Steps for which what was read from a table is kept at most."""

MOVED = 1.0 / 64.0
"""Part of the distance of two tables by which the speed may move meanwhile, 6e-5 of the speed for films with memory:
their load then lags behind by some 1e-5, as much as their parabolas are wrong. Slices are read in turns, so that more
would shake the machine at an eighth of the rate of the steps, the more the faster a run-up begins."""


Places = tuple[IntArray, FloatArray]
Prepared = tuple[IntArray, BoolArray, IntArray]


class CourseOfFilms:
    """Where the tables of the films of a run lie, step after step.

    Parameters
    ----------
    places : sequence of callable
        Nodes and weights of speeds (n,) [rad/s], a function for each film.
    prepare : callable
        Function that makes the tables of a film, by its index, for the first of some speeds, their nodes and weights.
    """

    def __init__(
        self,
        places: Sequence[Callable[[FloatArray], Places]],
        prepare: Callable[[int, FloatArray, IntArray, FloatArray], Prepared],
    ) -> None:
        self._place, self._prepare = places, prepare
        self._places: list[Places] = []
        self._speeds = np.zeros(0)
        self._kept = np.zeros(0, dtype=np.int64)

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables."""
        self._speeds = speeds
        self._places = [place(speeds) for place in self._place]
        self._kept = _kept(self._places, speeds.size)

    def prepare(self, first: int, last: int) -> tuple[Course, BoolArray]:
        """Have the tables of the next steps made, as many as are held at once, and say which steps have one.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        part = slice(first, last)
        found = [
            (*self._prepare(film, self._speeds[part], nodes[part], weights[part]), weights[part])
            for film, (nodes, weights) in enumerate(self._places)
        ]
        count = min((slots.size for slots, _, _, _ in found), default=last - first)
        course, whole = course_of(count, len(found)), np.ones(count, dtype=np.bool_)
        course.kept[:] = self._kept[first : first + count]
        for film, (slots, sound, outside, weights) in enumerate(found):
            course.nodes[:, film], course.weights[:, film] = slots[:count], weights[:count]
            course.outside[:, film] = outside[:count]
            whole &= sound[:count]
        return course, whole


def course_of(steps: int, films: int) -> Course:
    """Room for the course of some steps."""
    shape = (steps, films)
    nodes, outside = np.zeros((2, *shape), dtype=np.int64)
    return Course(nodes, np.zeros(shape), outside, np.ones(steps, dtype=np.int64))


def _kept(places: Sequence[Places], steps: int) -> IntArray:
    """Steps for which what was read holds, shape (steps,): a power of two; 1 for a step alone, whose speed may move."""
    if steps < 2:
        return np.ones(steps, dtype=np.int64)
    moved = np.zeros(steps - 1)
    for nodes, weights in places:
        moved = np.maximum(moved, np.abs(np.diff(nodes.astype(np.float64) + weights)))
    most = np.clip(MOVED / np.maximum(moved, MOVED / MOST_KEPT), 1.0, MOST_KEPT)
    kept = 2 ** np.floor(np.log2(most)).astype(np.int64)
    return np.concatenate([kept[:1], kept])


def shared(keys: Iterable[tuple[object, ...]]) -> tuple[list[int], list[int]]:
    """Number of the film of each bearing, by what makes films alike; and which bearing is the first with each film."""
    numbers: dict[tuple[object, ...], int] = {}
    films_of: list[int] = []
    firsts: list[int] = []
    for place, key in enumerate(keys):
        if key not in numbers:
            numbers[key] = len(firsts)
            firsts.append(place)
        films_of.append(numbers[key])
    return films_of, firsts


class FilmBlock(Generic[ArraysOfFilms]):
    """Bearings of a run that look their films up in tables over the speed; see `mbs.model.blocks.Block`.

    Parameters
    ----------
    course : CourseOfFilms
        Places of the tables, step after step.
    arrays : named tuple
        The bearings, with `films` and `course`.
    """

    def __init__(self, course: CourseOfFilms, arrays: ArraysOfFilms) -> None:
        self._course, self._arrays = course, arrays

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables."""
        self._course.begin(speeds)

    def prepare(self, first: int, last: int) -> tuple[ArraysOfFilms, BoolArray]:
        """Make the tables of the next steps, as many as are held at once.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        course, sound = self._course.prepare(first, last)
        self._arrays.films.in_use[:] = -1.0
        return self._arrays._replace(course=course), sound
