"""Ball bearings in compiled runs, by `ehdmaps/kernel/c/ball/ball_block.c`.

Films change with the speed: their laws are made at nodes that lie evenly in its logarithm, on one grid of approaches,
and blended straight between two nodes, see `mbs.bearings.balls.film_tables`.
"""

from __future__ import annotations

import ctypes
import dataclasses
import math
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings.balls.answers import felt_rows
from mbs.bearings.balls.ball_data import COLUMNS, START
from mbs.bearings.balls.ball_element import BallStates, MachineBalls
from mbs.bearings.balls.ball_memory import SPRINGS, FilmsOfBalls
from mbs.bearings.balls.ball_speed import dry_energy
from mbs.bearings.balls.film_tables import FilmCourse, FilmData
from mbs.bearings.balls.laws import NODES
from mbs.bearings.balls.normal_law import HELD
from mbs.bearings.balls.response import SHORTER
from mbs.model.blocks import Kind, Member


class Balls(Record):
    """Ball bearings as C takes them, one row a bearing; rows of balls are as long as the longest.

    Attributes
    ----------
    count, longest : int
        How many bearings, and balls of the longest row.
    firsts, places, films_of, counts : array (count,), of int
        First of what each feels, its place among all elements, its film, and how many balls it has.
    starts, turns, offsets : array (count,)
        Angle of the first ball [rad], cage angle by that of the system, axial offset [m].
    spins : array (count, 2)
        Speeds of the rings by that of the system.
    lengths, drives : array (count, 7), (count, 6)
        `BallShape` and `Drive` in their order, at rest.
    cosine, sine : array (count, longest)
        Directions of the balls in the cage.
    centres, rows : array (count, longest, START), (count, longest, COLUMNS)
        Starts of the balls, and what is known of each, at the last answer, see `mbs.bearings.balls.ball_data`.
    rests : array (count,)
        Approach at the outer raceway under the centrifugal load alone [m].
    powers : array (count, 2)
        What it dissipates, and what the turning cage brings in [W].
    last, times, works : array (count, longest, 4), (count,), (count,)
        What `speed_work` keeps of the last step, its time [s], and its work by that time [W].
    relaxes : array (count,), of int
        One where films have a memory.
    held, passed : array (count, longest, 2, HELD), (count, longest, 2, SPRINGS, 2)
        What contacts with memory hold over the step, see `mbs.bearings.balls.ball_memory`.
    forces, springs, approaches : array (count, longest, 2, SPRINGS), (..., SPRINGS + 1), (count, longest, 2)
        Their states after the last step that was made.
    clock : array (2,)
        Times at the end of that step, and of the step for which they hold [s].
    shorter : array (SPRINGS,)
        Times of the springs over the longest one.
    films : FilmData
        Laws of the contacts, and places of the steps on their tables.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("count", "longest")),
        *((name, integers) for name in ("firsts", "places", "films_of", "counts")),
        *((name, numbers) for name in ("starts", "turns", "offsets", "spins", "lengths", "drives", "cosine", "sine")),
        *((name, numbers) for name in ("centres", "rows", "rests", "powers", "last", "times", "works")),
        ("relaxes", integers),
        *((name, numbers) for name in ("held", "passed", "forces", "springs", "approaches", "clock", "shorter")),
        ("films", ctypes.POINTER(FilmData)),
    )
    shapes: ClassVar = {
        **dict.fromkeys(("firsts", "places", "films_of", "counts", "starts", "turns", "offsets"), ("count",)),
        **dict.fromkeys(("rests", "times", "works", "relaxes"), ("count",)),
        **dict.fromkeys(("spins", "powers"), ("count", 2)),
        "lengths": ("count", 7),
        "drives": ("count", 6),
        **dict.fromkeys(("cosine", "sine"), ("count", "longest")),
        "centres": ("count", "longest", START),
        "rows": ("count", "longest", COLUMNS),
        "last": ("count", "longest", 4),
        "held": ("count", "longest", 2, HELD),
        "passed": ("count", "longest", 2, SPRINGS, 2),
        "forces": ("count", "longest", 2, SPRINGS),
        "springs": ("count", "longest", 2, SPRINGS + 1),
        "approaches": ("count", "longest", 2),
        "clock": (2,),
        "shorter": (SPRINGS,),
    }


class BallBlock:
    """The ball bearings of a run; see `mbs.model.blocks.StatefulBlock`.

    Parameters
    ----------
    members : sequence of Member
        Bearings of the class `MachineBalls`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        elements: list[MachineBalls] = [member.element for member in members]
        columns = SPRINGS + 1 if any(one.relaxes for one in elements) else 0
        self._course = FilmCourse(elements, NODES, columns)
        self._data, self._arrays = _gather(members, self._course)

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables, and the grids of these."""
        self._course.begin(speeds)

    def prepare(self, first: int, last: int) -> tuple[Balls, BoolArray]:
        """Make the laws of the next steps, as many as are held at once.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        return self._data, self._course.prepare(first, last)

    def states(self) -> Sequence[BallStates]:
        """States of each bearing after the last step."""
        arrays = self._arrays
        return [
            BallStates(
                time=float(arrays["times"][b]),
                last=arrays["last"][b, :z].copy(),
                dissipated=float(arrays["powers"][b, 0]),
                driven=float(arrays["powers"][b, 1] + arrays["works"][b]),
                stored=dry_energy(arrays["rows"][b, :z]),
                films=FilmsOfBalls(*(place.copy() for place in self._places(b))) if arrays["relaxes"][b] else None,
            )
            for b, z in enumerate(arrays["counts"].tolist())
        ]

    def resume(self, states: Sequence[BallStates]) -> None:
        """Go on with states that `MachineBalls.advance` gave.

        Parameters
        ----------
        states : sequence of BallStates
            States of each bearing.
        """
        for b, one in enumerate(states):
            self._arrays["times"][b] = one.time
            self._arrays["last"][b, : one.last.shape[0]] = one.last
            self._arrays["clock"][:] = one.time, math.nan
            places = self._places(b)
            for place, values in zip(
                places, dataclasses.astuple(one.films) if one.films else (0.0, 0.0, 0.0), strict=True
            ):
                place[:] = values

    def _places(self, b: int) -> tuple[FloatArray, ...]:
        """Arrays of the films of a bearing: forces, springs, approaches."""
        arrays, z = self._arrays, int(self._arrays["counts"][b])
        return arrays["forces"][b, :z], arrays["springs"][b, :z], arrays["approaches"][b, :z]


def _gather(members: Sequence[Member], course: FilmCourse) -> tuple[Balls, dict[str, FloatArray]]:
    """Data of some bearings, and their arrays."""
    elements: list[MachineBalls] = [member.element for member in members]
    count, most = len(elements), max((one.force.geometry.balls for one in elements), default=0)
    cosine, sine = np.zeros((2, count, most))
    for b, one in enumerate(elements):
        cosine[b, : one.force.geometry.balls], sine[b, : one.force.geometry.balls] = one.force.directions

    def whole(values: Sequence[int]) -> FloatArray:
        return np.array(values, dtype=np.int64)

    def rows(values: Sequence[float] | Sequence[Sequence[float]], *columns: int) -> FloatArray:
        return np.array(values, dtype=np.float64).reshape(count, *columns)

    arrays = {
        "firsts": whole([member.first for member in members]),
        "places": whole([member.place for member in members]),
        "films_of": whole(course.films_of),
        "counts": whole([one.force.geometry.balls for one in elements]),
        "starts": rows([one.start_angle for one in elements]),
        "turns": rows([one.cage_turn for one in elements]),
        "offsets": rows([one.axial_offset for one in elements]),
        "spins": rows([(one.inner_spin, one.outer_spin) for one in elements], 2),
        "lengths": rows([one.force.shape for one in elements], 7),
        "drives": rows([one.force.drive for one in elements], 6),
        "cosine": cosine,
        "sine": sine,
        "centres": np.zeros((count, most, START)),
        "rows": np.zeros((count, most, COLUMNS)),
        "rests": np.zeros(count),
        "powers": np.zeros((count, 2)),
        "last": np.zeros((count, most, 4)),
        "times": np.zeros(count),
        "works": np.zeros(count),
        "relaxes": whole([int(one.relaxes) for one in elements]),
        "held": np.zeros((count, most, 2, HELD)),
        "passed": np.zeros((count, most, 2, SPRINGS, 2)),
        "forces": np.zeros((count, most, 2, SPRINGS)),
        "springs": np.zeros((count, most, 2, SPRINGS + 1)),
        "approaches": np.zeros((count, most, 2)),
        "clock": np.array([0.0, math.nan]),
        "shorter": np.array(SHORTER),
    }
    data = checked(Balls, "ehd_ball_block")(count=count, longest=most, films=course.data, **arrays)
    return data, arrays


BALLS = Kind(
    answer="ehd_ball_block_answer",
    feels=felt_rows,
    gather=BallBlock,
    accept="ehd_ball_block_accept",
    powers="ehd_ball_block_powers",
)
"""For `mbs.transient.kinds`."""
