"""Laws of two contacts over the speed, for compiled runs: at nodes, on one grid of approaches, blended between nodes.

Nodes lie evenly in the logarithm of the speed. The laws are `mbs.bearings.locating.normal_law.NormalLaw`: those of a
ball in its grooves, and of lines in slices.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.errors import EhdmapsError
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers, room
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.locating.normal_law import NormalLaw, PairLaw, contacts_at
from mbs.bearings.speed_tables import CourseOfFilms, Made, SpeedWindow, shared

STEP = 0.04
"""Distance of the nodes in ln of the speed: blends are wrong by less than 1e-4 of the load, see the tests."""

SLOTS = 32
"""How many laws are held."""

_LOWEST = 1.0
"""Speed at which nodes change from even in its logarithm to even in the speed [rad/s]; no film is read that low."""

_WIDENED = 3.0
"""Factor by which a grid goes beyond the speeds for which it is made."""


_LAW_NUMBERS = len(NormalLaw._fields) - 1


class FilmData(Record):
    """Laws at nodes over the speed, those in use, and places of steps: `ehd_pair_films`.

    A film is that of both contacts of bearings that are alike.

    Attributes
    ----------
    films, slots, rows, columns, steps : int
        Lengths of the arrays.
    tables, numbers : array (films, slots, 2, rows, 4), (films, slots, 2, 7)
        Numbers of `NormalLaw` of the inner and the outer contact; without rows for dry contacts.
    most, lengths : array (films, slots)
        Highest load for which the law was made [N]; rows that it has, none where it is dry.
    table, current, highest, length : array (films, 2, rows, 4), (films, 2, 7), (films,), (films,)
        The laws in use.
    in_use : array (films, 2)
        Node and weight of those.
    springs, shorter : array (films, slots, 2, rows, columns), (columns - 1,)
        Springs of films with memory at the rows of the tables, and their longest time; times of the springs over it.
        Without memory no columns.
    nodes, weights : array (steps, films)
        Node below the speed of each step, and part of the way to the next one.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("films", "slots", "rows", "columns")),
        *((name, numbers) for name in ("tables", "numbers", "most")),
        ("lengths", integers),
        *((name, numbers) for name in ("table", "current", "highest")),
        ("length", integers),
        *((name, numbers) for name in ("in_use", "springs", "shorter")),
        ("steps", ctypes.c_int64),
        ("nodes", integers),
        ("weights", numbers),
    )
    shapes: ClassVar = {
        "tables": ("films", "slots", 2, "rows", 4),
        "numbers": ("films", "slots", 2, _LAW_NUMBERS),
        **dict.fromkeys(("most", "lengths"), ("films", "slots")),
        "table": ("films", 2, "rows", 4),
        "current": ("films", 2, _LAW_NUMBERS),
        **dict.fromkeys(("highest", "length"), ("films",)),
        "in_use": ("films", 2),
        "springs": ("films", "slots", 2, "rows", "columns"),
        **dict.fromkeys(("nodes", "weights"), ("steps", "films")),
    }


def on_grid(law: NormalLaw, grid: NormalLaw, out: FloatArray) -> None:
    """Write the table of a law on another grid of approaches.

    Parameters
    ----------
    law : NormalLaw
        Law with a film.
    grid : NormalLaw
        Grid: its centre, scale, first node and step.
    out : array (nodes, 4)
        Table, written.
    """
    z = grid.first + grid.step * np.arange(out.shape[0])
    load, k, c = contacts_at(law, grid.centre + grid.scale * np.sinh(z))
    out[:, 0] = 2.0 / 3.0 * np.log(load / law.coefficient)
    out[:, 1] = 2.0 / 3.0 * k / load * grid.scale * np.cosh(z) * grid.step
    out[:, 2] = np.log(c)
    out[1:-1, 3] = 0.5 * (out[2:, 2] - out[:-2, 2])
    out[0, 3], out[-1, 3] = out[1, 2] - out[0, 2], out[-1, 2] - out[-2, 2]


class FilmLaws(SpeedWindow):
    """Laws of one film at the nodes of a window of speeds.

    Parameters
    ----------
    element : LocatingElement
        One of the bearings with the film.
    films : FilmData
        Laws as C has them; written.
    film : int
        Place of the film there.
    """

    def __init__(self, element: LocatingElement, films: FilmData, film: int) -> None:
        super().__init__(STEP, SLOTS, _LOWEST, element.varies)
        self._element, self._films, self._film = element, films, film
        self._grids: tuple[NormalLaw, ...] = ()
        self._reach = math.inf, 0.0

    def begin(self, speeds: FloatArray) -> None:
        """Choose the grid of approaches for some speeds and those near: that of the laws at both ends.

        Parameters
        ----------
        speeds : array (n,)
            Speeds [rad/s].
        """
        low, high = float(np.abs(speeds).min()), float(np.abs(speeds).max())
        if not self.varies or low == high or (self._reach[0] <= low and high <= self._reach[1]):
            return
        for widened in (_WIDENED, 1.0):  # speeds to come need not have films
            reach = low / widened, high * widened
            try:
                ends = [self._element.law_at(speed) for speed in (max(reach[0], _LOWEST * STEP), reach[1])]
            except EhdmapsError:
                continue  # the step that asks for it will be told why
            if not (ends[0].dry or ends[1].dry):
                pairs = zip(*(end.sides for end in ends), strict=True)
                self._grids = tuple(_over(slow, fast, self._films.rows) for slow, fast in pairs)
                self._reach = reach
                self.forget()
                return

    def make(self, slot: int, speed: float, alone: bool) -> Made:
        """Write the laws of a node, see `SpeedWindow.make`."""
        films, film = self._films, self._film
        try:
            law: PairLaw = self._element.law_at(speed)
        except EhdmapsError:
            return Made(sound=False)
        films.given("most")[film, slot] = law.loads[1]
        films.given("lengths")[film, slot] = 0 if law.dry else films.rows
        for side, one in enumerate(law.sides):
            numbers, table = films.given("numbers")[film, slot, side], films.given("tables")[film, slot, side]
            if alone or law.dry:
                numbers[:] = one[:_LAW_NUMBERS]
                table[: one.table.shape[0]] = one.table
            elif self._grids:
                numbers[:] = self._grids[side][:_LAW_NUMBERS]
                on_grid(one, self._grids[side], table)
            else:
                return Made(sound=False)
            if self._element.relaxes and not law.dry:
                grid = one if alone else self._grids[side]
                films.given("springs")[film, slot, side] = law.springs_on(side, grid, table)
        return Made(sound=True, kind=int(law.dry))


def _over(slow: NormalLaw, fast: NormalLaw, rows: int) -> NormalLaw:
    """Grid of approaches that holds those of two laws."""
    ends = []
    for law in (slow, fast):
        z = law.first + law.step * np.array([0.0, law.table.shape[0] - 1.0])
        ends.append(law.centre + law.scale * np.sinh(z))
    centre, scale = 0.5 * (slow.centre + fast.centre), math.sqrt(slow.scale * fast.scale)
    first = math.asinh((min(end[0] for end in ends) - centre) / scale)
    last = math.asinh((max(end[1] for end in ends) - centre) / scale)
    return fast._replace(centre=centre, scale=scale, first=first, step=(last - first) / (rows - 1))


class FilmCourse:
    """Laws of the bearings of a run, made as it comes to their speeds.

    Parameters
    ----------
    elements : sequence of LocatingElement
        The bearings.
    rows : int
        Rows of the tables, where any of them varies.

    Attributes
    ----------
    films_of : list of int
        Film of each bearing.
    data : FilmData
        Laws as C has them.
    """

    def __init__(self, elements: Sequence[LocatingElement], rows: int) -> None:
        self.films_of, firsts = shared(one.film_key for one in elements)
        rows, slots = (rows, SLOTS) if any(elements[first].varies for first in firsts) else (0, 1)
        shorter = next((one.force.shorter for one in elements if one.relaxes), ())
        columns = len(shorter) + 1 if shorter else 0
        sizes = {"films": len(firsts), "slots": slots, "rows": rows, "columns": columns, "steps": 0}
        self.data = checked(FilmData, "ehd_pair_films")(**sizes, **room(FilmData, sizes), shorter=np.array(shorter))
        self._laws = [FilmLaws(elements[first], self.data, film) for film, first in enumerate(firsts)]
        self._course = CourseOfFilms(self._laws)

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables, and the grids of these."""
        for one in self._laws:
            one.begin(speeds)
        self._course.begin(speeds)

    def prepare(self, first: int, last: int) -> BoolArray:
        """Make the laws of the next steps, as many as are held at once; which steps have one.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        course, sound = self._course.prepare(first, last)
        self.data.given("in_use")[:, 1] = math.nan  # to be mixed anew
        self.data.put(steps=sound.size, nodes=course.given("nodes"), weights=course.given("weights"))
        return sound
