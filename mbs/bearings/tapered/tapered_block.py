"""Bearings of tapered rollers, or of rollers between ribs, in compiled runs, by `ehdmaps/kernel/c/taper/taper_block.c`.

Films change with the speed: see `mbs.bearings.balls.film_tables`.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings.balls.answers import felt_rows
from mbs.bearings.balls.film_tables import FilmCourse, FilmData
from mbs.bearings.tapered.kernel_structs import COLUMNS, MEMORY, TaperedData, data_of, functions
from mbs.bearings.tapered.line_film import NODES
from mbs.bearings.tapered.tapered_bearing import FASTEST
from mbs.bearings.tapered.tapered_element import TaperedElement
from mbs.bearings.tapered.tapered_energy import TaperedStates, dry_energy
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
        What `mbs.bearings.tapered.tapered_energy.place_work` keeps of the last step, its time [s], and its work by that
        time [W].
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
        *((name, integers) for name in ("firsts", "places", "films_of")),
        *((name, numbers) for name in ("starts", "turns", "offsets", "fastest", "lines", "loads")),
        *((name, numbers) for name in ("rollers", "powers", "last", "times", "works")),
        ("memories", integers),
        *((name, numbers) for name in ("memory", "clock")),
        ("films", ctypes.POINTER(FilmData)),
    )
    shapes: ClassVar = {
        **dict.fromkeys(("firsts", "places", "films_of", "starts", "turns", "offsets", "fastest"), ("count",)),
        **dict.fromkeys(("times", "works", "memories"), ("count",)),
        **dict.fromkeys(("lines", "loads", "powers"), ("count", 2)),
        "rollers": ("count", "longest", COLUMNS),
        "last": ("count", "longest", 4),
        "clock": (2,),
    }


class TaperedBlock:
    """The bearings of a run; see `mbs.model.blocks.StatefulBlock`.

    Parameters
    ----------
    members : sequence of Member
        Bearings of the class `TaperedElement`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        self._elements: list[TaperedElement] = [member.element for member in members]
        self._course = FilmCourse(self._elements, NODES, 2 if any(one.relaxes for one in self._elements) else 0)
        own = [data_of(one.force.shape, one.force.laws) for one in self._elements]
        self._kept = own, (TaperedData * len(own))(*own)
        self._arrays = _arrays(members, self._course)
        functions()  # which compares the structs
        self._data = checked(Tapered, "ehd_taper_block")(
            count=len(own),
            longest=self._arrays["rollers"].shape[1],
            bearings=ctypes.addressof(self._kept[1]),
            films=self._course.data,
            **self._arrays,
        )

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables, and the grids of these."""
        self._course.begin(speeds)

    def prepare(self, first: int, last: int) -> tuple[Tapered, BoolArray]:
        """Make the laws of the next steps, as many as are held at once.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        return self._data, self._course.prepare(first, last)

    def states(self) -> Sequence[TaperedStates]:
        """States of each bearing after the last step."""
        arrays = self._arrays
        return [
            TaperedStates(
                time=float(arrays["times"][b]),
                last=arrays["last"][b, : one.force.geometry.rollers].copy(),
                dissipated=float(arrays["powers"][b, 0]),
                driven=float(arrays["powers"][b, 1] + arrays["works"][b]),
                stored=dry_energy(one.force.laws, one.force.shape, arrays["rollers"][b, : one.force.geometry.rollers]),
                films=FilmsOfRollers(self._memory(b).copy()) if one.relaxes else None,
            )
            for b, one in enumerate(self._elements)
        ]

    def resume(self, states: Sequence[TaperedStates]) -> None:
        """Go on with states that `TaperedElement.advance` gave.

        Parameters
        ----------
        states : sequence of TaperedStates
            States of each bearing.
        """
        arrays = self._arrays
        for b, one in enumerate(states):
            arrays["times"][b] = one.time
            arrays["last"][b, : one.last.shape[0]] = one.last
            arrays["clock"][:] = one.time, math.nan
            if self._elements[b].relaxes:
                memory = self._memory(b)
                memory[:] = one.films.memory if one.films else no_memory(memory.shape[0], memory.shape[-1])

    def _memory(self, b: int) -> FloatArray:
        """Memory of the slices of a bearing."""
        shape, first = _memory_shape(self._elements[b]), int(self._arrays["memories"][b])
        memory: FloatArray = self._arrays["memory"][first : first + math.prod(shape)].reshape(shape)
        return memory


def _memory_shape(element: TaperedElement) -> tuple[int, int, int, int]:
    """Lengths of the memory of the slices of a bearing."""
    return element.force.geometry.rollers, 2, MEMORY, element.force.positions.size


def _arrays(members: Sequence[Member], course: FilmCourse) -> dict[str, Any]:
    """Arrays of some bearings."""
    elements: list[TaperedElement] = [member.element for member in members]
    count, most = len(elements), max((one.force.geometry.rollers for one in elements), default=0)
    spins = [(one.inner_spin, one.outer_spin, one.cage_turn) for one in elements]
    sizes = [math.prod(_memory_shape(one)) if one.relaxes else 0 for one in elements]
    firsts = np.cumsum([0, *sizes])[:-1]

    def whole(values: Sequence[int]) -> Any:
        return np.array(values, dtype=np.int64)

    def rows(values: Sequence[Any], *columns: int) -> FloatArray:
        return np.array(values, dtype=np.float64).reshape(count, *columns)

    return {
        "firsts": whole([member.first for member in members]),
        "places": whole([member.place for member in members]),
        "films_of": whole(course.films_of),
        "starts": rows([one.start_angle for one in elements]),
        "turns": rows([one.cage_turn for one in elements]),
        "offsets": rows([one.axial_offset for one in elements]),
        "fastest": rows([FASTEST / max(*map(abs, each), 1e-12) for each in spins]),
        "lines": rows([(one.force.laws.cone, one.force.laws.cup) for one in elements], 2),
        "loads": rows([one.force.speed_loads(*each[:2]) for one, each in zip(elements, spins, strict=True)], 2),
        "rollers": np.zeros((count, most, COLUMNS)),
        "powers": np.zeros((count, 2)),
        "last": np.zeros((count, most, 4)),
        "times": np.zeros(count),
        "works": np.zeros(count),
        "memories": whole([int(first) if one.relaxes else -1 for one, first in zip(elements, firsts, strict=True)]),
        "memory": np.zeros(sum(sizes)),
        "clock": np.array([0.0, math.nan]),
    }


TAPERED = Kind(
    answer="ehd_taper_block_answer",
    feels=felt_rows,
    gather=TaperedBlock,
    accept="ehd_taper_block_accept",
    powers="ehd_taper_block_powers",
)
"""For `mbs.transient.kinds`."""
