"""Bearings in compiled runs: each feels four displacements of its ring, and reads tables of its law over the speed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.maps.lines import FAST
from mbs.bearings import slice_table as table
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.bearing_kernel import RingMotion, Shape, Work, bearing_force, sizes_of
from mbs.bearings.force_at_point import Arrays
from mbs.bearings.slice_table import CELLS, LawNumbers, PreparedLaw, law_numbers, store_numbers
from mbs.bearings.speed_tables import NODES, SpeedTables
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment
from mbs.model.elements import Element

FELT = np.array([1, 2, 4, 5])
"""Displacements of its port that a bearing feels: y, z, theta_y, theta_z."""


class Films(NamedTuple):
    """Tables of the laws at nodes over the speed, and the tables in use.

    Attributes
    ----------
    tables, numbers : array (films, nodes, rows, 8), (films, nodes, NUMBERS)
        Laws prepared as in `mbs.bearings.slice_table`.
    cells, current : array (films, rows, 8), (films, NUMBERS)
        The law in use.
    in_use : array (films, 2)
        Node and weight of those.
    """

    tables: FloatArray
    numbers: FloatArray
    cells: FloatArray
    current: FloatArray
    in_use: FloatArray


class Course(NamedTuple):
    """Where the tables of some steps lie.

    Attributes
    ----------
    nodes, weights : array (steps, films)
        Node below the speed, and the part of the way to the next one.
    outside : array (steps, films), of int
        Whether speed or temperature lie outside the map.
    """

    nodes: IntArray
    weights: FloatArray
    outside: IntArray


class Bearings(NamedTuple):
    """Bearings as arrays, one row a bearing; rows of slices and rollers are as long as the longest.

    Attributes
    ----------
    firsts, places, films_of : array (bearings,), of int
        First of what each feels, its place among all elements, its film.
    rollers, slices : array (bearings,), of int
        How many each has.
    start_angles, cage_rates : array (bearings,)
        Angle of the first roller [rad], and cage angle by that of the system.
    sizes : array (bearings, 6)
        `Sizes` in their order.
    positions, profiles : array (bearings, n)
        Slices, see `Shape` [m].
    cos, sin : array (bearings, Z)
        Directions of the rollers, see `Shape`.
    rows, states : array (Z n,), (4 Z n,)
        Work space for one bearing after the other.
    films : Films
        Tables of the laws.
    course : Course
        Places of the steps on the tables.
    """

    firsts: IntArray
    places: IntArray
    films_of: IntArray
    rollers: IntArray
    slices: IntArray
    start_angles: FloatArray
    cage_rates: FloatArray
    sizes: FloatArray
    positions: FloatArray
    profiles: FloatArray
    cos: FloatArray
    sin: FloatArray
    rows: IntArray
    states: FloatArray
    films: Films
    course: Course


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _between(low: FloatArray, high: FloatArray, weight: float, out: FloatArray) -> None:
    """Straight between the numbers of two laws; bounds stay bounds."""
    for i in range(out.size):
        out[i] = low[i] + weight * (high[i] - low[i])
    first, second, mixed = law_numbers(low), law_numbers(high), law_numbers(out)
    # Nodes of the cells move with centre and scale.
    aside = abs(second.lift_off - first.lift_off)
    bounded = LawNumbers(
        kind=mixed.kind,
        coefficient=mixed.coefficient,
        exponent=mixed.exponent,
        damping=mixed.damping,
        centre=mixed.centre,
        inverse_scale=mixed.inverse_scale,
        highest=mixed.highest,
        safe_approach=min(first.safe_approach, second.safe_approach) - aside,
        lift_off=min(first.lift_off, second.lift_off) - aside,
        slope=mixed.slope,
    )
    store_numbers(bounded, out)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def blend(films: Films, film: int, node: int, weight: float) -> None:
    """Bring the table in use to a place between two nodes: straight in ln of the speed, cell by cell.

    Tables have the same cells in z = (delta - centre)/scale, so that the blend of laws that rise with the approach
    rises too, and is C1.

    Parameters
    ----------
    films : Films
        Tables over speed of all bearings; the one in use is written.
    film : int
        Index of the film.
    node : int
        The lower node.
    weight : float
        Weight of the upper node, 0 to 1.
    """
    if films.in_use[film, 0] == node and films.in_use[film, 1] == weight:
        return
    films.in_use[film, 0], films.in_use[film, 1] = node, weight
    low, cells, current = films.numbers[film, node], films.cells[film], films.current[film]
    tabulated = law_numbers(low).kind == CELLS
    if weight == 0.0:
        current[:] = low
        if tabulated:
            cells[:] = films.tables[film, node]
        return
    other = (node + 1) % films.tables.shape[1]
    _between(low, films.numbers[film, other], weight, current)
    if not tabulated:
        return
    first, second, mixed = (
        films.tables[film, node].reshape(-1),
        films.tables[film, other].reshape(-1),
        cells.reshape(-1),
    )
    for i in range(mixed.size):
        mixed[i] = first[i] + weight * (second[i] - first[i])


@njit(cache=True, error_model="numpy")
def _force(bearings: Bearings, b: int, moment: Moment, motion: FloatArray, out: FloatArray) -> int:
    """Force, stiffness and damping of a bearing into `out` (13, 6); status as of `bearing_force`."""
    z, n, i, film = bearings.rollers[b], bearings.slices[b], bearings.firsts[b], bearings.films_of[b]
    x, y = motion[0], motion[1]
    angle = bearings.start_angles[b] + bearings.cage_rates[b] * moment.angle
    c, s = math.cos(angle), math.sin(angle)
    ring = RingMotion(x[i], x[i + 1], x[i + 2], x[i + 3], y[i], y[i + 1], y[i + 2], y[i + 3], c, s)
    shape = Shape(
        sizes_of(bearings.sizes[b]),
        bearings.positions[b][:n],
        bearings.profiles[b][:n],
        bearings.cos[b][:z],
        bearings.sin[b][:z],
    )
    films = bearings.films
    law = PreparedLaw(law_numbers(films.current[film]), films.cells[film])
    cells = z * n
    work = Work(bearings.rows[:cells].reshape(z, n), bearings.states[: 4 * cells].reshape(4, z, n))
    status: int = bearing_force(ring, shape, law, work, out)
    return status


@njit(cache=True, error_model="numpy")
def bearings_answer(bearings: Bearings, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and slopes of all bearings; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings : Bearings
        The bearings, with the tables of their laws.
    moment : Moment
        Step, angle, weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    course = bearings.course
    for film in range(bearings.films.current.shape[0]):
        blend(bearings.films, film, course.nodes[moment.step, film], course.weights[moment.step, film])
    out = np.empty((13, 6))
    for b in range(bearings.firsts.size):
        status = _force(bearings, b, moment, motion, out)
        if status != 0:
            return NO_SOLUTION if status < 0 else IN_PYTHON
        answers.outside[bearings.places[b]] += course.outside[moment.step, bearings.films_of[b]]
        first = bearings.firsts[b]
        for i in range(4):
            k = FELT[i]
            answers.force[first + i] = out[0, k]
            for j in range(4):
                slope = moment.by_q * out[1 + k, FELT[j]] + moment.by_v * out[7 + k, FELT[j]]
                answers.slopes[first + i, first + j] = slope
    return FOUND


class BearingBlock:
    """The bearings of a run; those with the same law at the same speed and temperature share their tables.

    Parameters
    ----------
    members : sequence of Member
        Bearings with a `BearingForce`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        self._films: list[SpeedTables] = []
        shared: dict[tuple[object, ...], int] = {}
        films_of = []
        for member in members:
            element: BearingElement = member.element
            force = element.force
            assert isinstance(force, BearingForce)
            _, by_speed, centrifugal = element.rates
            key = (id(force.law), element.temperature, by_speed, centrifugal)
            if key not in shared:
                shared[key] = len(self._films)
                self._films.append(SpeedTables(force, element.temperature, (by_speed, centrifugal)))
            films_of.append(shared[key])
        self._places: list[tuple[IntArray, FloatArray]] = []
        self._speeds = np.zeros(0)
        self._arrays = _arrays(members, films_of, self._films)

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables."""
        self._speeds = speeds
        self._places = [film.places(speeds) for film in self._films]

    def prepare(self, first: int, last: int) -> tuple[Bearings, BoolArray]:
        """Make the tables of the next steps, as many as are held at once.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        part, found = slice(first, last), []
        films = self._arrays.films
        for index, (film, (nodes, weights)) in enumerate(zip(self._films, self._places, strict=True)):
            slots, sound, outside = film.prepare(
                self._speeds[part], nodes[part], weights[part], films.tables[index], films.numbers[index]
            )
            found.append((slots, weights[part], outside, sound))
        films.in_use[:] = -1.0
        count = min((slots.size for slots, _, _, _ in found), default=last - first)
        course, whole = _course(count, len(found)), np.ones(count, dtype=np.bool_)
        for index, (slots, weights, outside, sound) in enumerate(found):
            course.nodes[:, index], course.weights[:, index] = slots[:count], weights[:count]
            course.outside[:, index] = outside[:count]
            whole &= sound[:count]
        return self._arrays._replace(course=course), whole


def _course(steps: int, films: int) -> Course:
    """Room for the course of some steps."""
    shape = (steps, films)
    return Course(np.zeros(shape, dtype=np.int64), np.zeros(shape), np.zeros(shape, dtype=np.int64))


def padded(rows: Sequence[FloatArray]) -> FloatArray:
    """Rows of several lengths as one array, with zeros behind."""
    padded = np.zeros((len(rows), max((row.size for row in rows), default=0)))
    for place, row in zip(padded, rows, strict=True):
        place[: row.size] = row
    return padded


def whole(numbers: Iterable[int]) -> IntArray:
    """Whole numbers as an array."""
    return np.array(list(numbers), dtype=np.int64)


def _arrays(members: Sequence[Member], films_of: Sequence[int], films: Sequence[SpeedTables]) -> Bearings:
    """The arrays of some bearings, and room for tables."""
    elements: list[BearingElement] = [member.element for member in members]
    works = [Arrays(element.bearing) for element in elements]
    rollers = [work.angles.shape[1] for work in works]
    slices = [work.slices.shape[1] for work in works]
    cells = max((z * n for z, n in zip(rollers, slices, strict=True)), default=0)
    return Bearings(
        firsts=whole(member.first for member in members),
        places=whole(member.place for member in members),
        films_of=whole(films_of),
        rollers=whole(rollers),
        slices=whole(slices),
        start_angles=np.array([element.start_angle for element in elements], dtype=np.float64),
        cage_rates=np.array([element.rates[0] for element in elements], dtype=np.float64),
        sizes=np.array([work.sizes for work in works], dtype=np.float64).reshape(len(works), 6),
        positions=padded([work.slices[0] for work in works]),
        profiles=padded([work.slices[1] for work in works]),
        cos=padded([work.angles[0] for work in works]),
        sin=padded([work.angles[1] for work in works]),
        rows=np.zeros(cells, dtype=np.int64),
        states=np.zeros(4 * cells),
        films=_room(len(films), any(film.varies for film in films)),
        course=_course(0, len(films)),
    )


def _room(films: int, varies: bool) -> Films:
    """Room for tables."""
    nodes, cells = (NODES, 2 * table.ROWS) if varies else (1, 1)
    return Films(
        tables=np.zeros((films, nodes, cells, 8)),
        numbers=np.zeros((films, nodes, table.NUMBERS)),
        cells=np.zeros((films, cells, 8)),
        current=np.zeros((films, table.NUMBERS)),
        in_use=np.full((films, 2), -1.0),
    )


def _takes(element: Element) -> bool:
    """Whether the force of a bearing is the compiled one."""
    return isinstance(element, BearingElement) and type(element.force) is BearingForce


def _feels(element: BearingElement) -> FloatArray:
    """Rows of what a bearing feels."""
    return np.asarray(np.eye(6)[FELT])


BEARINGS = Kind(arrays=Bearings, answer=bearings_answer, feels=_feels, gather=BearingBlock, takes=_takes)
"""For `mbs.transient.kinds`."""
