"""Tables of a contact law over the speed of a system, for runs whose speed changes all the time.

Making a table of `mbs.bearings.cylinder` costs thirty bearing forces, too much for each step. Its cells lie at equal
places z = (delta - centre)/scale at all speeds; so a run makes tables at nodes evenly spaced in ln of the speed, as
it comes to them, and takes between two nodes the straight blend of cells, centre and scale. The nodes are so close
that the blend is wrong by less than the tables are: `STEP` makes some 1e-8 of load and stiffness of a bearing.

Below the speeds with a whole film one table serves all: what is left of the film moves its knots, see `cylinder_law.c`
of `ehdmaps.kernel`. With a centrifugal load, which changes with the speed, each step has a table of its own.

A few slots hold the nodes and are used again and again. Below a lowest speed, where a film fades out, laws change with
the speed itself and not with its logarithm: nodes there are evenly spaced in the speed, as closely as at the lowest
one.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings import cylinder as table
from mbs.bearings.bearing import Bearing
from mbs.bearings.cylinder import FILM_ALONE, WHOLE, LawRoom
from mbs.bearings.force_at_point import is_one_power
from mbs.bearings.laws import DryLaw, FlatLaw

if TYPE_CHECKING:
    from ehdmaps.maps.law import ContactLaw


class Made(NamedTuple):
    """Description of a table that was made.

    Attributes
    ----------
    sound : bool
        Whether it holds the law; else compiled code has no answer at this speed.
    outside : bool
        Whether every call counts as outside the map.
    kind : int
        Tables of two kinds cannot be blended.
    """

    sound: bool
    outside: bool = False
    kind: int = 0


Places = tuple[IntArray, FloatArray]
Prepared = tuple[IntArray, BoolArray, IntArray]

AHEAD = 64
"""Nodes for which what costs most is made at once: those of a run's next steps."""


class SpeedWindow:
    """The slots of the tables of one law; laws inherit from it.

    Parameters
    ----------
    step : float
        Distance of the nodes in ln of the speed.
    slots : int
        How many tables are held.
    lowest : float
        Speed at which the nodes change from even in ln of the speed to even in the speed [rad/s], > 0.
    varies : bool
        Whether the law changes with speed; a dry one has one table for all.

    Attributes
    ----------
    varies : bool
        The same.
    """

    def __init__(self, step: float, slots: int, lowest: float, varies: bool = True) -> None:
        self._step, self._slots, self._lowest, self.varies = step, slots, lowest, varies
        self._sound, self._outside = np.zeros(slots, dtype=np.bool_), np.zeros(slots, dtype=np.bool_)
        self._kinds = np.zeros(slots, dtype=np.int64)
        self.forget()

    def forget(self) -> None:
        """Hold no table any more."""
        self._held: list[tuple[bool, float] | None] = [None] * self._slots
        self._foreseen = range(0)

    def make(self, slot: int, speed: float, alone: bool) -> Made:
        """Make the table of a slot.

        Parameters
        ----------
        slot : int
            Place of the table.
        speed : float
            Speed [rad/s].
        alone : bool
            Whether it is the only speed of the run so far, and no node.
        """
        raise NotImplementedError

    def ahead(self, speeds: FloatArray) -> None:
        """Take note of speeds [rad/s] whose tables will be made one by one, some to come among them."""

    def places(self, speeds: FloatArray) -> Places:
        """Nodes below speeds [rad/s], and parts of the way to the next nodes; both zero for one speed alone."""
        size = np.abs(speeds)
        if not self.varies or np.all(size == size[0]):
            return np.zeros(size.size, dtype=np.int64), np.zeros(size.size)
        by_lowest = size / self._lowest
        place = np.where(by_lowest < 1.0, by_lowest - 1.0, np.log(np.maximum(by_lowest, 1.0))) / self._step
        node = np.floor(place)
        return node.astype(np.int64), place - node

    def speed_of(self, node: int) -> float:
        """Speed of a node [rad/s]; exactly the lowest one for the node 0."""
        place = node * self._step
        return self._lowest * (math.exp(place) if node > 0 else max(1.0 + place, 0.0))

    def prepare(self, speeds: FloatArray, nodes: IntArray, weights: FloatArray) -> Prepared:
        """Have the tables made for the first of some speeds, as many as are held at once.

        Parameters
        ----------
        speeds : array (n,)
            Speeds [rad/s].
        nodes, weights : array (n,)
            Nodes and weights from `places`.

        Returns
        -------
        slots : array (k,)
            Slots of the tables of the first k speeds.
        sound : array (k,)
            Whether tables hold the law there.
        outside : array (k,), of int
            One where every call counts as outside the map.
        """
        if not self.varies or not (np.any(weights) or np.any(nodes)):
            speed = abs(float(speeds[0]))
            self._hold(0, (True, speed if self.varies else 0.0), speed)
            sound, outside = self._sound[:1], self._outside[:1]
            return np.zeros_like(nodes), np.repeat(sound, nodes.size), np.repeat(outside, nodes.size).astype(np.int64)
        low, high = np.minimum.accumulate(nodes), np.maximum.accumulate(nodes)
        count = int(np.searchsorted(high - low, self._slots - 2, side="right"))
        to_come = range(int(low[count - 1]), int(high[count - 1]) + 2)
        missing = [node for node in to_come if self._held[node % self._slots] != (False, float(node))]
        if not all(node in self._foreseen for node in missing):
            rises = nodes[count - 1] >= nodes[0]
            first, last = missing[0], missing[-1]
            first, last = (first, max(last, first + AHEAD)) if rises else (min(first, last - AHEAD), last)
            self._foreseen = range(first, last + 1)
            self.ahead(np.array([self.speed_of(node) for node in self._foreseen]))
        for node in missing:
            self._hold(node % self._slots, (False, float(node)), self.speed_of(node))
        slots, following = nodes[:count] % self._slots, (nodes[:count] + 1) % self._slots
        alike = self._kinds[slots] == self._kinds[following]
        return slots, alike & self._sound[slots] & self._sound[following], self._outside[slots].astype(np.int64)

    def _hold(self, slot: int, key: tuple[bool, float], speed: float) -> None:
        """Have the table of a slot made, unless it is there."""
        if self._held[slot] != key:
            self._held[slot] = key
            self._sound[slot], self._outside[slot], self._kinds[slot] = self.make(slot, speed, key[0])


STEP = 1e-3
"""Distance of the nodes in ln of the speed."""

NODES = 32
"""How many tables are held, besides that of a faded film."""

_FADED = -(2**60)
"""Node of the speeds at which a film is faded."""

_KIND = table.LawNumbers._fields.index("kind")


class SpeedTables(SpeedWindow):
    """Tables of one law at one temperature, for a window of speeds.

    Parameters
    ----------
    bearing : Bearing
        A bearing with the law.
    law : FlatLaw
        The law; all bearings with the same one, the same temperature and rates may share the tables.
    temperature : float
        [K].
    rates : (float, float)
        Entrainment speed for each speed of the system [m/rad], and centrifugal load for its square [N s2/(m rad2)].

    Attributes
    ----------
    has_cells : bool
        Whether the law is read from cells; a power law is not.
    cells, numbers : array (NODES + 1, rows, 8), (NODES + 1, NUMBERS)
        Tables of a run, which sets them; the last one for the faded film.
    """

    cells: FloatArray
    numbers: FloatArray

    def __init__(self, bearing: Bearing, law: FlatLaw, temperature: float, rates: tuple[float, float]) -> None:
        self._bearing, self._law, self._temperature, self._rates = bearing, law, temperature, rates
        self.has_cells = not isinstance(law.law, DryLaw) or law.law.prepared(1.0)[1] is not None
        lowest, self._faded_below = 1.0, 0.0
        if not isinstance(law.law, DryLaw):
            lowest, self._faded_below = _limits(law.law, abs(rates[0]))
        super().__init__(STEP, NODES, lowest, not isinstance(law.law, DryLaw))
        self._room = LawRoom()
        self._film = Made(sound=False)
        self._has_film = False

    def places(self, speeds: FloatArray) -> Places:
        """Nodes and weights of speeds [rad/s], see `SpeedWindow.places`; the part of the film where it is faded."""
        nodes, weights = super().places(speeds)
        law, faded = self._law.law, np.abs(speeds) < self._faded_below
        # Dry contacts that are one power law need no table.
        if not isinstance(law, DryLaw) and faded.any() and (np.any(speeds) or not is_one_power(law)):
            nodes[faded] = _FADED
            weights[faded] = [self._law.film_part(law, self._rates[0] * speed) for speed in speeds[faded].tolist()]
        return nodes, weights

    def prepare(self, speeds: FloatArray, nodes: IntArray, weights: FloatArray) -> Prepared:
        """Make the tables for the first of some speeds, see `SpeedWindow.prepare`; faded ones have one of their own."""
        faded = nodes == _FADED
        if faded[0]:
            return self._faded(speeds[: _leading(faded)])
        count = _leading(~faded)
        return super().prepare(speeds[:count], nodes[:count], weights[:count])

    def _faded(self, speeds: FloatArray) -> Prepared:
        """Have the table of the faded film made, unless it is there."""
        one = self._rates[1] == 0.0
        count = speeds.size if one else 1
        if not (one and self._has_film):
            conditions = self._conditions(abs(float(speeds[0])))
            self._film = self._prepared(conditions, FILM_ALONE, table.KNOTS, NODES)
            self._has_film = True
        slots, sound = np.full(count, NODES, dtype=np.int64), np.full(count, self._film.sound)
        return slots, sound, np.full(count, int(self._film.outside), dtype=np.int64)

    def make(self, slot: int, speed: float, alone: bool) -> Made:
        """Make the table of a speed, see `SpeedWindow.make`, or take over its power law."""
        law, (u, temperature, centrifugal) = self._law.law, self._conditions(speed)
        if isinstance(law, DryLaw):
            self.numbers[slot], given = law.prepared(self._bearing.geometry.roller_length)
            if given is not None:
                self.cells[slot] = given.reshape(-1, 8)
            return _told(True, False, self.numbers[slot])
        if not alone and speed >= self._faded_below > 0.0:
            # The node at the lowest speed has its whole film, whatever the rounding.
            u = max(abs(u), law.plain_table.lowest_speed)
        return self._prepared((u, temperature, centrifugal), WHOLE, table.CELLS, slot)

    def _prepared(self, conditions: tuple[float, float, float], asked: int, wanted: float, slot: int) -> Made:
        """Make the law ready at some conditions: a table of the kind that is wanted, or a power law, is sound."""
        law, room, centrifugal, numbers = self._law.law, self._room, conditions[2], self.numbers[slot]
        assert not isinstance(law, DryLaw)
        if not 0.0 <= centrifugal < law.load_range[1]:
            return Made(sound=False)
        outside = room.prepare(self._law.data(law, centrifugal > 0.0), conditions, asked) != 0
        numbers[:] = room.numbers
        if numbers[_KIND] == table.CELLS:
            self.cells[slot] = room.array("cells").reshape(-1, 8)
        elif numbers[_KIND] == table.KNOTS and wanted == table.KNOTS:
            self.cells[slot] = room.array("film")
        sound = numbers[_KIND] in (wanted, table.POWER) and not (outside and law.outside == "error")
        return _told(bool(sound), outside, numbers)

    def _conditions(self, speed: float) -> tuple[float, float, float]:
        """Entrainment speed, temperature, centrifugal load."""
        return self._rates[0] * speed, self._temperature, self._rates[1] * speed**2


def _limits(law: ContactLaw, rate: float) -> tuple[float, float]:
    """Speed from which on the law changes with ln of the speed, and below which its film is faded [rad/s]."""
    numbers = law.plain_table
    if rate == 0.0 or math.isinf(numbers.film_speed):
        # no film at any speed of the map
        return 1.0, 0.0 if is_one_power(law) else numbers.counted_speed / rate if rate else math.inf
    return numbers.lowest_speed / rate, numbers.film_speed / rate


def _leading(marked: BoolArray) -> int:
    """Count the marked ones at the beginning."""
    return marked.size if marked.all() else int(np.argmin(marked))


def _told(sound: bool, outside: bool, numbers: FloatArray) -> Made:
    """Describe a table; only tables of the same kind that count alike are blended."""
    return Made(sound, outside, 2 * int(numbers[_KIND]) + int(outside))


class Course(Record):
    """Places of the tables of some steps: `ehd_film_course`.

    Attributes
    ----------
    films : int
        How many tables.
    nodes, weights : array (steps, films)
        Node below the speed, and the part of the way to the next one.
    outside : array (steps, films), of int
        Whether speed or temperature lie outside the map.
    kept : array (steps,), of int
        Steps for which what was read from the tables holds.
    """

    _fields_ = (
        ("films", ctypes.c_int64),
        *((name, integers) for name in ("nodes", "outside")),
        ("weights", numbers),
        ("kept", integers),
    )


MOST_KEPT = 8
"""Steps for which what was read from a table is kept at most."""

MOVED = 1.0 / 64.0
"""Part of the distance of two tables by which the speed may move meanwhile, 6e-5 of the speed for films with memory:
load by load that is some 1e-5, as much as their parabolas are wrong. Slices are read in turns, so that more would shake
the machine at an eighth of the rate of the steps, the more the faster a run-up begins."""


class CourseOfFilms:
    """Places of the tables of the films of a run, step after step.

    Parameters
    ----------
    windows : sequence of SpeedWindow
        Tables of each film.
    in_turns : bool
        Whether what is read from the tables is kept for some steps, see `Course.kept`. Their places then lie ahead.
    """

    def __init__(self, windows: Sequence[SpeedWindow], in_turns: bool = False) -> None:
        self._windows, self._in_turns = windows, in_turns
        self._places: list[Places] = []
        self._speeds = np.zeros(0)
        self._kept = np.zeros(0, dtype=np.int64)

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables."""
        self._speeds = speeds
        self._places = [window.places(speeds) for window in self._windows]
        self._kept = np.ones(speeds.size, dtype=np.int64)
        if self._in_turns:
            self._kept = _kept(self._places, speeds.size)
            self._places = [_ahead(*places, self._kept) for places in self._places]

    def prepare(self, first: int, last: int) -> tuple[Course, BoolArray]:
        """Have the tables of the next steps made, as many as are held at once, and say which steps have one.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        part = slice(first, last)
        films = [
            (*window.prepare(self._speeds[part], nodes[part], weights[part]), weights[part])
            for window, (nodes, weights) in zip(self._windows, self._places, strict=True)
        ]
        count = min((slots.size for slots, _, _, _ in films), default=last - first)
        course, whole = course_of(count, len(films)), np.ones(count, dtype=np.bool_)
        course.given("kept")[:] = self._kept[first : first + count]
        for film, (slots, sound, outside, weights) in enumerate(films):
            for name, values in (("nodes", slots), ("weights", weights), ("outside", outside)):
                course.given(name)[:, film] = values[:count]
            whole &= sound[:count]
        return course, whole


def course_of(steps: int, films: int) -> Course:
    """Room for the course of some steps."""
    nodes, outside = np.zeros((2, steps, films), dtype=np.int64)
    kept = np.ones(steps, dtype=np.int64)
    weights = np.zeros((steps, films))
    return checked(Course, "ehd_film_course")(films=films, nodes=nodes, outside=outside, weights=weights, kept=kept)


class CourseBlock:
    """Bearings of a run whose laws are tables over the speed, see `mbs.model.blocks.Block`; kinds inherit from it.

    Attributes
    ----------
    data : Record
        The bearings as C takes them; its `course` has the places of the steps on the tables.
    """

    data: Record

    def __init__(self, course: CourseOfFilms, in_use: FloatArray) -> None:
        self._course, self._in_use = course, in_use

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables."""
        self._course.begin(speeds)

    def prepare(self, first: int, last: int) -> tuple[Record, BoolArray]:
        """Make the tables of the next steps, as many as are held at once.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        course, sound = self._course.prepare(first, last)
        # slots have other tables now; films with memory mix them at their next turn: a turn of its own would be a kick
        self._in_use[:, 1] = math.nan
        self.data.put(course=course)
        return self.data, sound


def _kept(places: Sequence[Places], steps: int) -> IntArray:
    """Steps for which what was read holds, shape (steps,): a power of two; 1 for a step alone, whose speed may move."""
    if steps < 2:
        return np.ones(steps, dtype=np.int64)
    moved = np.zeros(steps - 1)
    for nodes, weights in places:
        moved = np.maximum(moved, np.abs(np.diff(nodes.astype(np.float64) + weights)))
    most = np.clip(MOVED / np.maximum(moved, MOVED / MOST_KEPT), 1.0, MOST_KEPT)
    kept = 2 ** np.floor(np.log2(most)).astype(np.int64)
    return np.concatenate([kept[:1], kept])


def _ahead(nodes: IntArray, weights: FloatArray, kept: IntArray) -> Places:
    """Places moved ahead by as many steps as what is read there will be old, on the mean of all slices.

    A table is mixed every `kept` steps. Slices read it in turns meanwhile, and keep that as long: the mean age is
    `kept` - 1 steps at every step. Without this all loads would lag behind, and a machine gets a kick where `kept`
    changes.
    """
    if nodes.size < 2:
        return nodes, weights
    place = nodes + weights
    moved = np.diff(place)
    place += (kept - 1) * np.append(moved, moved[-1])
    nodes = np.floor(place).astype(np.int64)
    return nodes, place - nodes


def shared(keys: Iterable[tuple[object, ...]]) -> tuple[list[int], list[int]]:
    """Number of the film of each bearing, by what makes films alike; and which bearing is the first with each film."""
    numbers: dict[tuple[object, ...], int] = {}
    films_of: list[int] = []
    firsts: list[int] = []
    for place, key in enumerate(keys):
        if key not in numbers:
            numbers[key] = len(firsts)
            firsts.append(place)
        films_of.append(numbers[key])
    return films_of, firsts
