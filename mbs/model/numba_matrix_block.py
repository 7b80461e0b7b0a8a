"""Connections by matrices in compiled runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from mbs.model.blocks import FOUND, Answers, Kind, Member, Moment, SteadyBlock
from mbs.model.matrices import MatrixElement


class Matrices(NamedTuple):
    """Connections by matrices as arrays.

    Attributes
    ----------
    firsts, places, counts : array (elements,), of int
        First of what each feels, its place among all elements, and the number of its speeds.
    speeds : array (elements, speeds)
        Speeds of the tables [rad/s].
    tables : array (elements, speeds, 2, 6, 6)
        Stiffness and damping.
    """

    firsts: IntArray
    places: IntArray
    counts: IntArray
    speeds: FloatArray
    tables: FloatArray


@njit(error_model="numpy")
def _at(matrices: Matrices, e: int, speed: float, out: FloatArray) -> bool:
    """Write stiffness and damping of an element at a speed; whether that lies beyond its table."""
    count, speeds, tables = matrices.counts[e], matrices.speeds[e], matrices.tables[e]
    low = 0
    while low + 2 < count and speeds[low + 1] < speed:
        low += 1
    high = min(low + 1, count - 1)
    part = 0.0
    if high > low:
        part = min(max((speed - speeds[low]) / (speeds[high] - speeds[low]), 0.0), 1.0)
    for m in range(2):
        for i in range(6):
            for j in range(6):
                begin = tables[low, m, i, j]
                out[m, i, j] = begin + part * (tables[high, m, i, j] - begin)
    return bool(count > 1 and (speed < speeds[0] or speed > speeds[count - 1]))


@njit(error_model="numpy")
def matrices_answer(matrices: Matrices, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and slopes of all connections; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    matrices : Matrices
        The connections.
    moment : Moment
        Speed and weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    both = np.empty((2, 6, 6))
    for e in range(matrices.firsts.size):
        first = matrices.firsts[e]
        if _at(matrices, e, moment.speed, both):
            answers.outside[matrices.places[e]] += 1
        for i in range(6):
            total = 0.0
            for j in range(6):
                k, c = both[0, i, j], both[1, i, j]
                total -= k * motion[0, first + j] + c * motion[1, first + j]
                answers.slopes[first + i, first + j] = moment.by_q * k + moment.by_v * c
            answers.force[first + i] = total
    return FOUND


@njit(error_model="numpy")
def matrices_powers(matrices: Matrices, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray) -> None:
    """Write powers that dampings take, and that skew stiffnesses bring in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    matrices, moment, motion, answers
        The same as of `matrices_answer`.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    both = np.empty((2, 6, 6))
    for e in range(matrices.firsts.size):
        first, place = matrices.firsts[e], matrices.places[e]
        _at(matrices, e, moment.speed, both)
        dissipated = driven = 0.0
        for i in range(6):
            for j in range(6):
                dissipated += motion[1, first + i] * both[1, i, j] * motion[1, first + j]
                driven -= motion[1, first + i] * 0.5 * (both[0, i, j] - both[0, j, i]) * motion[0, first + j]
        out[place, 0], out[place, 1] = dissipated, driven


def _gather(members: Sequence[Member]) -> SteadyBlock:
    """Arrays of some connections; tables as long as the longest."""
    elements: list[MatrixElement] = [member.element for member in members]
    longest = max((element.speeds.size for element in elements), default=1)
    speeds, tables = np.zeros((len(elements), longest)), np.zeros((len(elements), longest, 2, 6, 6))
    for index, element in enumerate(elements):
        count = element.speeds.size
        speeds[index, :count] = element.speeds
        tables[index, :count, 0], tables[index, :count, 1] = element.stiffness, element.damping
    firsts, places = (np.array([getattr(m, key) for m in members], dtype=np.int64) for key in ("first", "place"))
    counts = np.array([element.speeds.size for element in elements], dtype=np.int64)
    return SteadyBlock(Matrices(firsts, places, counts, speeds, tables))


def _all_six(element: MatrixElement) -> FloatArray:
    """All displacements of the port."""
    return np.eye(6)


MATRICES = Kind(
    arrays=Matrices, answer=matrices_answer, feels=_all_six, gather=_gather, powers=matrices_powers, rare=True
)
"""For `mbs.transient.kinds`."""
