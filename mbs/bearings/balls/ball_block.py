"""Ball bearings in compiled runs, by `ehdmaps/kernel/c/ball/ball_block.c`."""

from __future__ import annotations

import ctypes
import dataclasses
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings.balls.ball_data import COLUMNS, START
from mbs.bearings.balls.ball_memory import SPRINGS, FilmsOfBalls
from mbs.bearings.balls.ball_speed import dry_energy
from mbs.bearings.balls.laws import NODES
from mbs.bearings.balls.response import SHORTER
from mbs.bearings.locating.film_tables import FilmData
from mbs.bearings.locating.locating_block import COURSES, PLACES, SHAPES, WORKS, LocatingBlock, felt_rows
from mbs.bearings.locating.normal_law import HELD
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
    ways : array (count, longest, 4)
        `BallForce.rows`.
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
        *PLACES,
        ("counts", integers),
        *COURSES,
        *((name, numbers) for name in ("spins", "lengths", "drives", "cosine", "sine", "ways")),
        *((name, numbers) for name in ("centres", "rows", "rests")),
        *WORKS,
        ("relaxes", integers),
        *((name, numbers) for name in ("held", "passed", "forces", "springs", "approaches", "clock", "shorter")),
        ("films", ctypes.POINTER(FilmData)),
    )
    shapes: ClassVar = {
        **SHAPES,
        **dict.fromkeys(("counts", "rests", "relaxes"), ("count",)),
        "spins": ("count", 2),
        "lengths": ("count", 7),
        "drives": ("count", 6),
        **dict.fromkeys(("cosine", "sine"), ("count", "longest")),
        "ways": ("count", "longest", 4),
        "centres": ("count", "longest", START),
        "rows": ("count", "longest", COLUMNS),
        "held": ("count", "longest", 2, HELD),
        "passed": ("count", "longest", 2, SPRINGS, 2),
        "forces": ("count", "longest", 2, SPRINGS),
        "springs": ("count", "longest", 2, SPRINGS + 1),
        "approaches": ("count", "longest", 2),
        "shorter": (SPRINGS,),
    }


class BallBlock(LocatingBlock):
    """The ball bearings of a run, `MachineBalls`; see `LocatingBlock`.

    Parameters
    ----------
    members : sequence of Member
        The bearings.
    """

    nodes, columns = NODES, SPRINGS + 1

    def __init__(self, members: Sequence[Member]) -> None:
        super().__init__(members)
        elements, count, most = self.elements, len(self.elements), self.longest
        cosine, sine = np.zeros((2, count, most))
        ways = np.zeros((count, most, 4))
        for b, one in enumerate(elements):
            cosine[b, : self.size(b)], sine[b, : self.size(b)] = one.force.directions
            ways[b, : self.size(b)] = one.force.rows
        self.arrays |= {
            "counts": np.array([self.size(b) for b in range(count)], dtype=np.int64),
            "spins": self.rows([(one.inner_spin, one.outer_spin) for one in elements], 2),
            "lengths": self.rows([one.force.shape for one in elements], 7),
            "drives": self.rows([one.force.drive for one in elements], 6),
            "cosine": cosine,
            "sine": sine,
            "ways": ways,
            "centres": np.zeros((count, most, START)),
            "rows": np.zeros((count, most, COLUMNS)),
            "rests": np.zeros(count),
            "relaxes": np.array([int(one.relaxes) for one in elements], dtype=np.int64),
            "held": np.zeros((count, most, 2, HELD)),
            "passed": np.zeros((count, most, 2, SPRINGS, 2)),
            "forces": np.zeros((count, most, 2, SPRINGS)),
            "springs": np.zeros((count, most, 2, SPRINGS + 1)),
            "approaches": np.zeros((count, most, 2)),
            "shorter": np.array(SHORTER),
        }
        self.data = checked(Balls, "ehd_ball_block")(count=count, longest=most, films=self.course.data, **self.arrays)

    def stored(self, b: int) -> float:
        """See `LocatingBlock.stored`."""
        return dry_energy(self.arrays["rows"][b, : self.size(b)])

    def films(self, b: int) -> FilmsOfBalls:
        """See `LocatingBlock.films`."""
        return FilmsOfBalls(*(place.copy() for place in self._places(b)))

    def put(self, b: int, films: FilmsOfBalls | None) -> None:
        """See `LocatingBlock.put`."""
        values = (0.0, 0.0, 0.0) if films is None else dataclasses.astuple(films)
        for place, value in zip(self._places(b), values, strict=True):
            place[:] = value

    def _places(self, b: int) -> tuple[FloatArray, ...]:
        """Arrays of the films of a bearing: forces, springs, approaches."""
        forces, springs, approaches = (self.arrays[name][b] for name in ("forces", "springs", "approaches"))
        z = self.size(b)
        return forces[:z], springs[:z], approaches[:z]


BALLS = Kind(
    answer="ehd_ball_block_answer",
    feels=felt_rows,
    gather=BallBlock,
    accept="ehd_ball_block_accept",
    powers="ehd_ball_block_powers",
)
"""For `mbs.transient.kinds`."""
