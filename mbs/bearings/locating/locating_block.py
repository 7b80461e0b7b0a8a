"""Bearings that carry axial load in compiled runs: what blocks of their kinds have in common.

Films change with the speed: their laws are made at nodes that lie evenly in its logarithm, on one grid of approaches,
and blended straight between two nodes, see `mbs.bearings.locating.film_tables`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings.locating.film_tables import FilmCourse
from mbs.bearings.locating.locating_element import LocatingElement, LocatingStates
from mbs.model.blocks import Member

FELT = np.array([0, 1, 2, 4, 5])
"""Displacements of its port that a bearing feels."""

PLACES = tuple((name, integers) for name in ("firsts", "places", "films_of"))
"""First of what each bearing feels, its place among all elements, its film."""

COURSES = tuple((name, numbers) for name in ("starts", "turns", "offsets"))
"""Angle of its first rolling element [rad], cage angle by that of the system, axial offset [m]."""

WORKS = tuple((name, numbers) for name in ("powers", "last", "times", "works"))
"""What it dissipates, and what the turning cage brings in [W]; what `LocatingForce.work` keeps of the last step, its
time [s], and its work by that time [W]."""

SHAPES: dict[str, tuple[str | int, ...]] = {
    **dict.fromkeys(("firsts", "places", "films_of", "starts", "turns", "offsets", "times", "works"), ("count",)),
    "powers": ("count", 2),
    "last": ("count", "longest", 4),
    "clock": (2,),
}
"""Shapes of these, and of times at the end of the last step that was made, and of the step for which films hold [s]."""


def felt_rows(element: object) -> FloatArray:
    """Rows of what a bearing feels of its port; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    element : object
        The bearing.
    """
    return np.asarray(np.eye(6)[FELT])


class LocatingBlock:
    """Bearings of one kind in a run, see `mbs.model.blocks.StatefulBlock`; kinds inherit from it.

    Parameters
    ----------
    members : sequence of Member
        Bearings, of the class `LocatingElement`.

    Attributes
    ----------
    nodes, columns : int
        Nodes of a law over the approach; numbers of the springs of films with memory at each.
    elements : list of LocatingElement
        The bearings.
    arrays : dict of array
        What C reads and writes, by name.
    data : Record
        The same as C takes it.
    """

    nodes: ClassVar[int]
    columns: ClassVar[int]
    data: Record

    def __init__(self, members: Sequence[Member]) -> None:
        self.elements: list[LocatingElement] = [member.element for member in members]
        self.course = FilmCourse(
            self.elements, self.nodes, self.columns if any(e.relaxes for e in self.elements) else 0
        )
        count = len(self.elements)
        self.longest = max((self.size(b) for b in range(count)), default=0)
        whole = {
            "firsts": [member.first for member in members],
            "places": [member.place for member in members],
            "films_of": self.course.films_of,
        }
        self.arrays: dict[str, Any] = {
            **{name: np.array(values, dtype=np.int64) for name, values in whole.items()},
            "starts": self.rows([one.start_angle for one in self.elements]),
            "turns": self.rows([one.cage_turn for one in self.elements]),
            "offsets": self.rows([one.axial_offset for one in self.elements]),
            "powers": np.zeros((count, 2)),
            "last": np.zeros((count, self.longest, 4)),
            "times": np.zeros(count),
            "works": np.zeros(count),
            "clock": np.array([0.0, math.nan]),
        }

    def size(self, b: int) -> int:
        """Number of rolling elements of a bearing."""
        return int(self.elements[b].force.angles.size)

    def rows(self, values: Sequence[Any], *columns: int) -> FloatArray:
        """Numbers of all bearings, a row each."""
        return np.array(values, dtype=np.float64).reshape(len(self.elements), *columns)

    def stored(self, b: int) -> float:
        """Energy of the dry contacts of a bearing at the last answer [J]."""
        raise NotImplementedError

    def films(self, b: int) -> Any:
        """Films with memory of a bearing after the last step."""
        raise NotImplementedError

    def put(self, b: int, films: Any) -> None:
        """Write films with memory of a bearing; None: they have not moved."""
        raise NotImplementedError

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
                stored=self.stored(b),
                films=self.films(b) if one.relaxes else None,
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
                self.put(b, one.films)
