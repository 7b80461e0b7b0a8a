"""Bearings of tapered rollers, or between ribs, in compiled runs, by `ehdmaps/kernel/c/taper/taper_block.c`."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings.locating.film_tables import FilmData
from mbs.bearings.locating.locating_block import COURSES, PLACES, SHAPES, WORKS, LocatingBlock, felt_rows
from mbs.bearings.locating.locating_force import FASTEST
from mbs.bearings.tapered.kernel_structs import COLUMNS, MEMORY, TaperedData, data_of, functions
from mbs.bearings.tapered.line_film import NODES
from mbs.bearings.tapered.tapered_bearing import dry_energy
from mbs.bearings.tapered.tapered_memory import FilmsOfRollers, no_memory
from mbs.model.blocks import Kind, Member


class Tapered(Record):
    """Bearings as C takes them, one row a bearing; rows of rollers are as long as the longest.

    Attributes
    ----------
    count, longest : int
        How many bearings, and rollers of the longest row.
    bearings : int
        Address of an array of `mbs.bearings.tapered.kernel_structs.TaperedData`.
    firsts, places, films_of : array (count,), of int
        First of what each feels, its place among all elements, and its film.
    starts, turns, offsets : array (count,)
        Angle of the first roller [rad], cage angle by that of the system, axial offset [m].
    fastest : array (count,)
        Largest speed of the system [rad/s].
    lines : array (count, 2)
        C of dry cone and cup [N/m^(10/9)].
    loads : array (count, 2)
        Centrifugal load and gyroscopic moment over the square of the system's speed [N s2], [N m s2].
    rollers : array (count, longest, COLUMNS)
        Numbers of the rollers at the last answer.
    powers : array (count, 2)
        What the last answer dissipates, and what the turning cage brings in [W].
    last, times, works : array (count, longest, 4), (count,), (count,)
        What `mbs.bearings.tapered.tapered_bearing.place_work` keeps of the last step, its time [s], and its work by
        that time [W].
    memories : array (count,), of int
        First number of the memory of a bearing; below zero for films without one.
    memory : array
        Memory of the slices, (Z, 2, MEMORY, n) of each bearing, see `mbs.bearings.tapered.tapered_memory`.
    clock : array (2,)
        Times at the end of the last step that was made, and of the step for which slices hold [s].
    films : FilmData
        Laws of the lines, and places of the steps on their tables.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("count", "longest")),
        ("bearings", ctypes.c_void_p),
        *PLACES,
        *COURSES,
        *((name, numbers) for name in ("fastest", "lines", "loads", "rollers")),
        *WORKS,
        ("memories", integers),
        *((name, numbers) for name in ("memory", "clock")),
        ("films", ctypes.POINTER(FilmData)),
    )
    shapes: ClassVar = {
        **SHAPES,
        **dict.fromkeys(("fastest", "memories"), ("count",)),
        **dict.fromkeys(("lines", "loads"), ("count", 2)),
        "rollers": ("count", "longest", COLUMNS),
    }


class TaperedBlock(LocatingBlock):
    """The bearings of tapered rollers, or of rollers between ribs, of a run; see `LocatingBlock`.

    Parameters
    ----------
    members : sequence of Member
        The bearings.
    """

    nodes, columns = NODES, 2

    def __init__(self, members: Sequence[Member]) -> None:
        super().__init__(members)
        elements = self.elements
        own = [data_of(one.force.shape, one.force.laws) for one in elements]
        self._kept = own, (TaperedData * len(own))(*own)
        spins = [(one.inner_spin, one.outer_spin, one.cage_turn) for one in elements]
        sizes = [math.prod(self._shape(b)) if one.relaxes else 0 for b, one in enumerate(elements)]
        firsts = np.cumsum([0, *sizes])[:-1]
        memories = [int(first) if one.relaxes else -1 for one, first in zip(elements, firsts, strict=True)]
        self.arrays |= {
            "fastest": self.rows([FASTEST / max(*map(abs, each), 1e-12) for each in spins]),
            "lines": self.rows([(one.force.laws.cone, one.force.laws.cup) for one in elements], 2),
            "loads": self.rows([one.force.speed_loads(*e[:2]) for one, e in zip(elements, spins, strict=True)], 2),
            "rollers": np.zeros((len(elements), self.longest, COLUMNS)),
            "memories": np.array(memories, dtype=np.int64),
            "memory": np.zeros(sum(sizes)),
        }
        functions()  # which compares the structs
        self.data = checked(Tapered, "ehd_taper_block")(
            count=len(own),
            longest=self.longest,
            bearings=ctypes.addressof(self._kept[1]),
            films=self.course.data,
            **self.arrays,
        )

    def stored(self, b: int) -> float:
        """See `LocatingBlock.stored`."""
        force = self.elements[b].force
        return dry_energy(force.laws, force.shape, self.arrays["rollers"][b, : self.size(b)])

    def films(self, b: int) -> FilmsOfRollers:
        """See `LocatingBlock.films`."""
        return FilmsOfRollers(self._memory(b).copy())

    def put(self, b: int, films: FilmsOfRollers | None) -> None:
        """See `LocatingBlock.put`."""
        memory = self._memory(b)
        memory[:] = films.memory if films else no_memory(memory.shape[0], memory.shape[-1])

    def _shape(self, b: int) -> tuple[int, int, int, int]:
        """Lengths of the memory of the slices of a bearing."""
        return self.size(b), 2, MEMORY, self.elements[b].force.positions.size

    def _memory(self, b: int) -> FloatArray:
        """Memory of the slices of a bearing."""
        shape, first = self._shape(b), int(self.arrays["memories"][b])
        memory: FloatArray = self.arrays["memory"][first : first + math.prod(shape)].reshape(shape)
        return memory


TAPERED = Kind(
    answer="ehd_taper_block_answer",
    feels=felt_rows,
    gather=TaperedBlock,
    accept="ehd_taper_block_accept",
    powers="ehd_taper_block_powers",
)
"""For `mbs.transient.kinds`."""
