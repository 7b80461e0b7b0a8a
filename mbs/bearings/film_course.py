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
    """

    nodes: IntArray
    weights: FloatArray
    outside: IntArray


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

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables."""
        self._speeds = speeds
        self._places = [place(speeds) for place in self._place]

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
        for film, (slots, sound, outside, weights) in enumerate(found):
            course.nodes[:, film], course.weights[:, film] = slots[:count], weights[:count]
            course.outside[:, film] = outside[:count]
            whole &= sound[:count]
        return course, whole


def course_of(steps: int, films: int) -> Course:
    """Room for the course of some steps."""
    shape = (steps, films)
    return Course(np.zeros(shape, dtype=np.int64), np.zeros(shape), np.zeros(shape, dtype=np.int64))


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
