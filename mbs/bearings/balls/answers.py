"""Answers of five freedoms, and laws over the speed, that bearings of balls and of tapered rollers share in runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from mbs.bearings.balls.ball_speed import turned_by
from mbs.bearings.balls.film_tables import FilmLaws, WithFilms
from mbs.bearings.speed_tables import ArraysOfFilms, CourseOfFilms, FilmBlock, Prepared, shared
from mbs.model.blocks import Answers, Moment

_turned_by = njit(error_model="numpy", _nrt=False)(turned_by)

FELT = np.array([0, 1, 2, 4, 5])
"""Displacements of its port that a bearing feels."""


def felt_rows(element: object) -> FloatArray:
    """Rows of what a bearing feels of its port; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    element : object
        The bearing.
    """
    return np.asarray(np.eye(6)[FELT])


@njit(error_model="numpy", _nrt=False, forceinline=True)
def read_pose(first: int, offset: float, motion: FloatArray, pose: FloatArray) -> None:
    """Write the pose (6,) of an inner ring by what its bearing feels.

    Parameters
    ----------
    first : int
        First of what the bearing feels.
    offset : float
        Axial offset [m].
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    pose : array (6,)
        Pose of the ring, which is written.
    """
    for p in range(FELT.size):
        pose[FELT[p]] = motion[0, first + p]
    pose[0] += offset
    pose[3] = 0.0


@njit(error_model="numpy", _nrt=False, forceinline=True)
def answer_port(
    first: int,
    turn: float,
    moment: Moment,
    motion: FloatArray,
    pose: FloatArray,
    force: FloatArray,
    matrices: FloatArray,
    answers: Answers,
    powers: FloatArray,
) -> None:
    """Write the answer of a bearing, what it dissipates, and what its turning cage brings in.

    Parameters
    ----------
    first : int
        First of what the bearing feels.
    turn : float
        Cage angle by that of the system.
    moment, motion
        Step and motion, of `mbs.model.blocks.Kind`.
    pose, force : array (6,)
        Pose of the inner ring, and the force at rest.
    matrices : array (2, 6, 6)
        Stiffness and damping.
    answers : Answers
        Answers of all elements; written.
    powers : array (2,)
        Both powers [W]; written.
    """
    y, stiffness, damping = motion[1], matrices[0], matrices[1]
    dissipated = 0.0
    for p in range(FELT.size):
        row = FELT[p]
        total = force[row]
        for q in range(FELT.size):
            column = FELT[q]
            slowed = damping[row, column] * y[first + q]
            total -= slowed
            dissipated += y[first + p] * slowed
            slope = moment.by_q * stiffness[row, column] + moment.by_v * damping[row, column]
            answers.slopes[first + p, first + q] = slope
        answers.force[first + p] = total
    powers[0], powers[1] = dissipated, _turned_by(pose, force) * turn * moment.speed


class LawBlock(FilmBlock[ArraysOfFilms]):
    """Bearings of a run whose laws are `FilmTables`; see `mbs.model.blocks.StatefulBlock`.

    Parameters
    ----------
    elements : sequence
        The bearings, each with the key of its film.
    rows : int
        Rows of the tables.
    gather : callable
        Function that makes the arrays by the film of each bearing and the films.
    """

    def __init__(
        self,
        elements: Sequence[WithFilms],
        rows: int,
        gather: Callable[[list[int], Sequence[FilmLaws]], ArraysOfFilms],
    ) -> None:
        films_of, firsts = shared(one.film_key for one in elements)
        self._laws = [FilmLaws(elements[first], rows) for first in firsts]
        arrays = gather(films_of, self._laws)

        def make(film: int, speeds: FloatArray, nodes: IntArray, weights: FloatArray) -> Prepared:
            return self._laws[film].prepare(arrays.films, film, speeds, nodes, weights)

        super().__init__(CourseOfFilms([one.places for one in self._laws], make), arrays)

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables, and the grids of these."""
        for one in self._laws:
            one.begin(speeds)
        super().begin(speeds)
