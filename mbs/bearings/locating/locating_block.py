"""Bearings that carry axial load in compiled runs: what blocks of their kinds have in common.

Films change with the speed: their laws are made at nodes that lie evenly in its logarithm, on one grid of approaches,
and blended straight between two nodes, see `mbs.bearings.locating.film_tables`.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers, room
from mbs.bearings.deviating.tables import gathered
from mbs.bearings.locating.film_memory import FilmsInTime, no_memory, rows_of
from mbs.bearings.locating.film_tables import FilmCourse, FilmData
from mbs.bearings.locating.locating_element import LocatingElement, LocatingStates
from mbs.bearings.locating.locating_force import LAST
from mbs.model.blocks import Kind, Member

FELT = np.array([0, 1, 2, 4, 5])
"""Displacements of its port that a bearing feels."""


class PairBlock(Record):
    """Bearings of a kind as C takes them, one row a bearing: `ehd_pair_block`; those of kinds have fields behind these.

    Attributes
    ----------
    count, longest : int
        How many bearings, and rolling elements of the one that has most.
    firsts, places, films_of : array (count,), of int
        First of what each feels, its place among all elements, its film.
    counts, slices : array (count,), of int
        How many rolling elements it has, and slices of a contact.
    starts, turns, offsets : array (count,)
        Angle of its first rolling element [rad], cage angle by that of the system, axial offset [m].
    powers : array (count, 2)
        What it dissipates, and what the turning cage brings in [W].
    last, times, works, spent : array (count, longest, LAST), (count,), (count,), (count,)
        What `LocatingForce.works` keeps of the last step, its time [s], the power of speed over it [W], and what films
        with memory took up [J].
    memories, memory : array (count,), of int, (numbers,)
        First number of the memory of a bearing, < 0 without one; memory of the contacts of all bearings,
        (Z, 2, rows, n) each, see `mbs.bearings.locating.film_memory`.
    clock : array (2,)
        Times at the end of the last step that was made, and of the step for which films hold [s].
    films : FilmData
        Laws of the contacts, and places of the steps on their tables.
    deviations : address or None
        Deviations of each bearing from its form, see `mbs.bearings.deviating.tables`.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("count", "longest")),
        *((name, integers) for name in ("firsts", "places", "films_of", "counts", "slices")),
        *((name, numbers) for name in ("starts", "turns", "offsets", "powers", "last", "times", "works", "spent")),
        ("memories", integers),
        *((name, numbers) for name in ("memory", "clock")),
        ("films", ctypes.POINTER(FilmData)),
        ("deviations", ctypes.c_void_p),
    )
    shapes: ClassVar = {
        **dict.fromkeys(("firsts", "places", "films_of", "counts", "slices", "memories"), ("count",)),
        **dict.fromkeys(("starts", "turns", "offsets", "times", "works", "spent"), ("count",)),
        "powers": ("count", 2),
        "last": ("count", "longest", LAST),
        "clock": (2,),
    }


class LocatingBlock:
    """Bearings of one kind in a run, see `mbs.model.blocks.StatefulBlock`; kinds inherit from it.

    Parameters
    ----------
    members : sequence of Member
        Bearings, of the class `LocatingElement`.

    Attributes
    ----------
    record, name : type of PairBlock, str
        The struct of the kind, and how C calls it.
    nodes : int
        Nodes of a law over the approach.
    last_rows : str
        Name of the array with the numbers of all elements at the last answer.
    elements : list of LocatingElement
        The bearings.
    arrays : dict of array
        What C reads and writes, by name.
    data : PairBlock
        The same as C takes it.
    """

    record: ClassVar[type[PairBlock]]
    name: ClassVar[str]
    nodes: ClassVar[int]
    last_rows: ClassVar[str] = "rows"

    def __init__(self, members: Sequence[Member]) -> None:
        self.elements: list[LocatingElement] = [member.element for member in members]
        self.course = FilmCourse(self.elements, self.nodes)
        sizes = [self._memory_shape(b) for b in range(len(members))]
        memory = [math.prod(size) if one.relaxes else 0 for one, size in zip(self.elements, sizes, strict=True)]
        firsts = np.cumsum([0, *memory])[:-1]
        self.longest = max((size[0] for size in sizes), default=0)
        lengths = {"count": len(members), "longest": self.longest}
        whole = {
            "firsts": [member.first for member in members],
            "places": [member.place for member in members],
            "films_of": self.course.films_of,
            "counts": [size[0] for size in sizes],
            "slices": [size[3] for size in sizes],
            "memories": np.where([one.relaxes for one in self.elements], firsts, -1),
        }
        self.arrays: dict[str, Any] = {
            **room(self.record, lengths),
            **{name: np.array(values, dtype=np.int64) for name, values in whole.items()},
            "starts": self.rows([one.start_angle for one in self.elements]),
            "turns": self.rows([one.cage_turn for one in self.elements]),
            "offsets": self.rows([one.axial_offset for one in self.elements]),
            "clock": np.array([0.0, math.nan]),
            "memory": np.zeros(sum(memory)),
        }
        self.arrays |= self.own()
        self._deviate, deviations = gathered([one.deviation_data for one in self.elements])
        given = {"films": self.course.data, "deviations": deviations}
        self.data = checked(self.record, self.name)(**lengths, **given, **self.arrays)

    def own(self) -> dict[str, Any]:
        """Fields of the kind, by name; what is left out of the arrays is zero."""
        raise NotImplementedError

    def size(self, b: int) -> int:
        """Number of rolling elements of a bearing."""
        return int(self.elements[b].force.angles.size)

    def rows(self, values: Sequence[Any], *columns: int) -> FloatArray:
        """Numbers of all bearings, a row each."""
        return np.array(values, dtype=np.float64).reshape(len(self.elements), *columns)

    def _memory_shape(self, b: int) -> tuple[int, ...]:
        """Lengths of the memory of the contacts of a bearing."""
        force = self.elements[b].force
        elements, sides, slices = force.contacts
        return elements, sides, rows_of(len(force.shorter)), slices

    def _memory(self, b: int) -> FloatArray:
        """Memory of the contacts of a bearing."""
        shape, first = self._memory_shape(b), int(self.arrays["memories"][b])
        memory: FloatArray = self.arrays["memory"][first : first + math.prod(shape)].reshape(shape)
        return memory

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables, and the grids of these."""
        self.course.begin(speeds)

    def prepare(self, first: int, last: int) -> tuple[Record, BoolArray]:
        """Make the laws of the next steps, as many as are held at once.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        return self.data, self.course.prepare(first, last)

    def states(self) -> Sequence[LocatingStates]:
        """States of each bearing after the last step."""
        arrays = self.arrays
        return [
            LocatingStates(
                time=float(arrays["times"][b]),
                last=arrays["last"][b, : self.size(b)].copy(),
                dissipated=float(arrays["powers"][b, 0]),
                driven=float(arrays["powers"][b, 1] + arrays["works"][b]),
                spent=float(arrays["spent"][b]),
                rows=arrays[self.last_rows][b, : self.size(b)].copy(),
                films=FilmsInTime(self._memory(b).copy()) if one.relaxes else None,
            )
            for b, one in enumerate(self.elements)
        ]

    def resume(self, states: Sequence[LocatingStates]) -> None:
        """Go on with states that `LocatingElement.advance` gave.

        Parameters
        ----------
        states : sequence of LocatingStates
            States of each bearing.
        """
        for b, (element, one) in enumerate(zip(self.elements, states, strict=True)):
            self.arrays["times"][b] = one.time
            self.arrays["last"][b, : one.last.shape[0]] = one.last
            self.arrays["clock"][:] = one.time, math.nan
            if element.relaxes:
                force = element.force
                self._memory(b)[:] = one.films.memory if one.films else no_memory(force.contacts, len(force.shorter))


def kind_of(block: type[LocatingBlock]) -> Kind:
    """Kind of bearings for `mbs.transient.kinds`, by their block."""
    answer, accept, powers = (f"{block.name}_{what}" for what in ("answer", "accept", "powers"))
    return Kind(answer, lambda element: np.asarray(np.eye(6)[FELT]), block, accept=accept, powers=powers)
