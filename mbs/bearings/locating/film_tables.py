"""Laws of two contacts over the speed, for compiled runs: at nodes, on one grid of approaches, blended between nodes.

Nodes lie evenly in the logarithm of the speed. The laws are `mbs.bearings.locating.normal_law.NormalLaw`: those of a
ball in its grooves, and of lines in slices.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.errors import EhdmapsError
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings.locating.normal_law import NormalLaw, contacts_at
from mbs.bearings.speed_tables import CourseOfFilms, Made, Prepared, SpeedWindow, shared

STEP = 0.04
"""Distance of the nodes in ln of the speed: blends are wrong by less than 1e-4 of the load, see the tests."""

SLOTS = 32
"""How many laws are held."""

_LOWEST = 1.0
"""Speed at which nodes change from even in its logarithm to even in the speed [rad/s]; no film is read that low."""

_WIDENED = 3.0
"""Factor by which a grid goes beyond the speeds for which it is made."""


_LAW_NUMBERS = len(NormalLaw._fields) - 1


class FilmTables(NamedTuple):
    """Laws at nodes over the speed, and those in use; a film is that of both contacts of bearings that are alike.

    Attributes
    ----------
    tables, numbers : array (films, slots, 2, rows, 4), (films, slots, 2, 10)
        Numbers of `NormalLaw` of the inner and the outer contact; without rows for dry contacts.
    most, lengths : array (films, slots)
        Highest load for which the law was made [N]; rows that it has, none where it is dry.
    table, current, highest, length : array (films, 2, rows, 4), (films, 2, 10), (films,), (films,)
        The laws in use.
    in_use : array (films, 2)
        Node and weight of those.
    springs : array (films, slots, 2, rows, columns)
        Springs of films with memory at the rows of the tables, and their time; without memory no columns.
    """

    tables: FloatArray
    numbers: FloatArray
    most: FloatArray
    lengths: IntArray
    table: FloatArray
    current: FloatArray
    highest: FloatArray
    length: IntArray
    in_use: FloatArray
    springs: FloatArray


class FilmData(Record):
    """The same in C, with the places of the steps: `ehd_pair_films`.

    Attributes
    ----------
    films, slots, rows, columns, steps : int
        Lengths of the arrays.
    nodes, weights : array (steps, films)
        Node below the speed of each step, and part of the way to the next one.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("films", "slots", "rows", "columns")),
        *((name, numbers) for name in ("tables", "numbers", "most")),
        ("lengths", integers),
        *((name, numbers) for name in ("table", "current", "highest")),
        ("length", integers),
        *((name, numbers) for name in ("in_use", "springs")),
        ("steps", ctypes.c_int64),
        ("nodes", integers),
        ("weights", numbers),
    )
    shapes: ClassVar = {
        "tables": ("films", "slots", 2, "rows", 4),
        "numbers": ("films", "slots", 2, 10),
        **dict.fromkeys(("most", "lengths"), ("films", "slots")),
        "table": ("films", 2, "rows", 4),
        "current": ("films", 2, 10),
        **dict.fromkeys(("highest", "length"), ("films",)),
        "in_use": ("films", 2),
        "springs": ("films", "slots", 2, "rows", "columns"),
        **dict.fromkeys(("nodes", "weights"), ("steps", "films")),
    }


def film_data(films: FilmTables) -> FilmData:
    """Laws as C has them.

    Parameters
    ----------
    films : FilmTables
        The laws, which must be kept; without steps.
    """
    count, slots, _, rows, columns = films.springs.shape
    return checked(FilmData, "ehd_pair_films")(films=count, slots=slots, rows=rows, columns=columns, **films._asdict())


class PairLaw(Protocol):
    """Laws of the inner and the outer contact at one speed, such as `mbs.bearings.balls.laws.BallLaw`."""

    @property
    def inner(self) -> NormalLaw:
        """Law of the inner contact."""

    @property
    def outer(self) -> NormalLaw:
        """Law of the outer contact."""

    @property
    def loads(self) -> tuple[float, float]:
        """Lowest and highest load for which both were made [N]."""

    def springs_on(self, side: int, law: NormalLaw, table: FloatArray) -> FloatArray:
        """Springs of films with memory at the rows of a table, and their time, (rows, columns).

        Parameters
        ----------
        side : int
            0 the inner contact.
        law : NormalLaw
            Law of the table.
        table : array (rows, 4)
            The table.
        """

    @property
    def dry(self) -> bool:
        """Sign of contacts without films."""


class WithFilms(Protocol):
    """Bearing whose laws depend on the speed of its system."""

    @property
    def varies(self) -> bool:
        """Sign of films that change with the speed."""

    @property
    def relaxes(self) -> bool:
        """Sign of films with memory."""

    @property
    def film_key(self) -> tuple[object, ...]:
        """Key that bearings with the same law at all speeds have in common."""

    def law_at(self, speed: float) -> PairLaw:
        """Law at a speed of the system [rad/s]."""


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


def _sides(law: PairLaw) -> tuple[NormalLaw, NormalLaw]:
    """Inner and outer."""
    return law.inner, law.outer


class FilmLaws:
    """Laws of one film at the nodes of a window of speeds.

    Parameters
    ----------
    element : WithFilms
        One of the bearings with the film.
    rows : int
        Rows of the tables.
    """

    def __init__(self, element: WithFilms, rows: int) -> None:
        self._element, self._rows = element, rows
        self.varies = element.varies
        self._window = SpeedWindow(STEP, SLOTS, _LOWEST, self.varies)
        self._grids: tuple[NormalLaw, ...] = ()
        self._reach = math.inf, 0.0

    def law(self, speed: float) -> PairLaw:
        """The law at a speed [rad/s]."""
        return self._element.law_at(speed)

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
                ends = self.law(max(reach[0], _LOWEST * STEP)), self.law(reach[1])
            except EhdmapsError:
                continue  # the step that asks for it will be told why
            if not (ends[0].dry or ends[1].dry):
                pairs = zip(*map(_sides, ends), strict=True)
                self._grids = tuple(_over(slow, fast, self._rows) for slow, fast in pairs)
                self._reach, self._window = reach, SpeedWindow(STEP, SLOTS, _LOWEST)
                return

    def places(self, speeds: FloatArray) -> tuple[IntArray, FloatArray]:
        """Nodes and weights of speeds [rad/s]."""
        return self._window.places(speeds)

    def prepare(
        self, films: FilmTables, film: int, speeds: FloatArray, nodes: IntArray, weights: FloatArray
    ) -> Prepared:
        """Make the laws for the first of some speeds, see `SpeedWindow.prepare`."""

        def make(slot: int, speed: float, alone: bool) -> Made:
            return self._made(films, film, slot, speed, alone)

        return self._window.prepare(speeds, nodes, weights, make)

    def _made(self, films: FilmTables, film: int, slot: int, speed: float, alone: bool) -> Made:
        """Write the laws of a node."""
        try:
            law = self.law(speed)
        except EhdmapsError:
            return Made(sound=False)
        films.most[film, slot], films.lengths[film, slot] = law.loads[1], 0 if law.dry else self._rows
        for side, one in enumerate(_sides(law)):
            numbers, table = films.numbers[film, slot, side], films.tables[film, slot, side]
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
                films.springs[film, slot, side] = law.springs_on(side, grid, table)
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


def film_tables(laws: Sequence[FilmLaws], rows: int, columns: int) -> FilmTables:
    """Room for the laws of some films.

    Parameters
    ----------
    laws : sequence of FilmLaws
        The films.
    rows : int
        Rows of the tables, where any of them varies.
    columns : int
        Springs of a contact and their time; 0 where none of them has a memory.
    """
    count = len(laws)
    rows, slots = (rows, SLOTS) if any(one.varies for one in laws) else (0, 1)
    return FilmTables(
        tables=np.zeros((count, slots, 2, rows, 4)),
        numbers=np.zeros((count, slots, 2, _LAW_NUMBERS)),
        most=np.zeros((count, slots)),
        lengths=np.zeros((count, slots), dtype=np.int64),
        table=np.zeros((count, 2, rows, 4)),
        current=np.zeros((count, 2, _LAW_NUMBERS)),
        highest=np.zeros(count),
        length=np.zeros(count, dtype=np.int64),
        in_use=np.full((count, 2), -1.0),
        springs=np.zeros((count, slots, 2, rows, columns)),
    )


class FilmCourse:
    """Laws of the bearings of a run, made as it comes to their speeds.

    Parameters
    ----------
    elements : sequence of WithFilms
        The bearings.
    rows, columns : int
        See `film_tables`.

    Attributes
    ----------
    films_of : list of int
        Film of each bearing.
    data : FilmData
        Laws as C has them.
    """

    def __init__(self, elements: Sequence[WithFilms], rows: int, columns: int) -> None:
        self.films_of, firsts = shared(one.film_key for one in elements)
        self._laws = [FilmLaws(elements[first], rows) for first in firsts]
        self._tables = film_tables(self._laws, rows, columns)
        self.data = film_data(self._tables)
        self._course = CourseOfFilms([one.places for one in self._laws], self._made)

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
        self._tables.in_use[:, 1] = math.nan  # to be mixed anew
        self.data.put(steps=sound.size, nodes=course.nodes, weights=course.weights)
        return sound

    def _made(self, film: int, speeds: FloatArray, nodes: IntArray, weights: FloatArray) -> Prepared:
        """Make the laws of a film."""
        return self._laws[film].prepare(self._tables, film, speeds, nodes, weights)
