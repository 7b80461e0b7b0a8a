"""Bearings in compiled runs: each feels four displacements of its ring, and reads tables of its law over the speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.copies import put
from ehdmaps.maps.lines import FAST
from mbs.bearings import slice_table as table
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.bearing_kernel import bearing_force, ring_powers
from mbs.bearings.faded_table import fade
from mbs.bearings.film_course import Course, CourseOfFilms, FilmBlock, course_of, shared
from mbs.bearings.laws import Law
from mbs.bearings.level_kernel import level_force
from mbs.bearings.rings import LEVEL, Rings, answer_ring, feels, gather_rings, motion_of, placed, shape_of
from mbs.bearings.roller_motion import Work
from mbs.bearings.slice_table import CELLS, KNOTS, LawNumbers, PreparedLaw, law_numbers, store_numbers
from mbs.bearings.speed_tables import NODES, SpeedTables
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment
from mbs.model.elements import Element


class Films(NamedTuple):
    """Tables of the laws at nodes over the speed, and the tables in use.

    Attributes
    ----------
    tables, numbers : array (films, nodes, rows, 8), (films, nodes, NUMBERS)
        Laws prepared as in `mbs.bearings.slice_table`.
    cells, knots, current : array (films, rows, 8), (films, rows), (films, NUMBERS)
        The law in use.
    in_use : array (films, 2)
        Node and weight of those.
    """

    tables: FloatArray
    numbers: FloatArray
    cells: FloatArray
    knots: FloatArray
    current: FloatArray
    in_use: FloatArray


class Bearings(NamedTuple):
    """Bearings without states as arrays.

    Attributes
    ----------
    rings : Rings
        What does not change.
    rows : array (Z n,)
        Work space for one bearing after the other.
    states : array (bearings, 4 Z n)
        Slices of each bearing at rest at the last answer, as of `mbs.bearings.roller_motion.Work`.
    films : Films
        Tables of the laws.
    course : Course
        Places of the steps on the tables.
    strict : array (bearings,), of bool
        Whether the law refuses loads above its map.
    """

    rings: Rings
    rows: IntArray
    states: FloatArray
    films: Films
    course: Course
    strict: BoolArray


@njit(error_model="numpy", fastmath=FAST)
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
        damping_time=mixed.damping_time,
        centre=mixed.centre,
        inverse_scale=mixed.inverse_scale,
        highest=mixed.highest,
        safe_approach=min(first.safe_approach, second.safe_approach) - aside,
        lift_off=min(first.lift_off, second.lift_off) - aside,
        slope=mixed.slope,
        held_approach=mixed.held_approach,
        held_load=mixed.held_load,
        held_stiffness=mixed.held_stiffness,
        held_damping=mixed.held_damping,
    )
    store_numbers(bounded, out)


@njit(error_model="numpy", fastmath=FAST)
def blend(films: Films, film: int, node: int, weight: float) -> None:
    """Bring the table in use to a place between two nodes: straight in ln of the speed, cell by cell.

    Tables have the same cells in z = (delta - centre)/scale, so that the blend of laws that rise with the approach
    rises too, and is C1. A faded film has one table, and its weight is the part of the film that is there.

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
    kind = law_numbers(low).kind
    if kind == KNOTS:
        fade(films.tables[film, node], low, weight, cells, films.knots[film], current)
        return
    tabulated = kind == CELLS
    if weight == 0.0:
        put(low, current)
        if tabulated:
            put(films.tables[film, node].reshape(-1), cells.reshape(-1))
        return
    other = (node + 1) % NODES
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


@njit(error_model="numpy")
def _force(bearings: Bearings, b: int, moment: Moment, motion: FloatArray, out: FloatArray) -> int:
    """Force, stiffness and damping of a bearing into `out` (13, 6); status as of `bearing_force`."""
    rings, films = bearings.rings, bearings.films
    z, n, film = rings.rollers[b], rings.slices[b], rings.films_of[b]
    law = PreparedLaw(law_numbers(films.current[film]), films.cells[film], films.knots[film])
    cells = z * n
    work = Work(bearings.rows[:cells].reshape(z, n), bearings.states[b][: 4 * cells].reshape(4, z, n))
    ring, shape = motion_of(rings, b, moment, motion), shape_of(rings, b)
    if rings.felt[b] == LEVEL:
        level: int = level_force(ring, shape, rings.weights[b][:n], law, work, out)
        return level
    status: int = bearing_force(ring, shape, law, work, out)
    return status


@njit(error_model="numpy")
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
    course, rings = bearings.course, bearings.rings
    for film in range(bearings.films.current.shape[0]):
        blend(bearings.films, film, course.nodes[moment.step, film], course.weights[moment.step, film])
    out = np.empty((13, 6))
    for b in range(rings.firsts.size):
        status = _force(bearings, b, moment, motion, out)
        if status < 0:
            return NO_SOLUTION
        if status > 0 and bearings.strict[b]:
            return IN_PYTHON
        outside = course.outside[moment.step, rings.films_of[b]]
        answers.outside[rings.places[b]] += 1 if status > 0 or outside > 0 else 0
        answer_ring(rings.firsts[b], rings.felt[b], moment, out, answers)
    return FOUND


@njit(error_model="numpy")
def bearings_powers(bearings: Bearings, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray) -> None:
    """What contacts dissipate, and what the cage brings in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings, moment, motion, answers
        The same as of `bearings_answer`.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    rings = bearings.rings
    for b in range(rings.firsts.size):
        z, n, place = rings.rollers[b], rings.slices[b], rings.places[b]
        states = bearings.states[b][: 4 * z * n].reshape(4, z, n)
        numbers = law_numbers(bearings.films.current[rings.films_of[b]])
        cage_rate = rings.cage_rates[b] * moment.speed
        ring, shape = motion_of(rings, b, moment, motion), shape_of(rings, b)
        weights = rings.weights[b][:n]
        out[place, 0], out[place, 1] = ring_powers(ring, shape, weights, numbers, states, cage_rate)


class BearingBlock(FilmBlock[Bearings]):
    """The bearings of a run; those with the same law at the same speed and temperature share their tables.

    Parameters
    ----------
    members : sequence of Member
        Bearings with a `BearingForce`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        elements: list[BearingElement] = [member.element for member in members]
        films_of, firsts = shared(
            (id(_force_of(element).law), element.temperature, *element.rates[1:]) for element in elements
        )
        tables = [
            SpeedTables(element.bearing, _force_of(element).flat_law, element.temperature, element.rates[1:])
            for element in (elements[first] for first in firsts)
        ]
        rings = gather_rings(members, films_of)
        films = room_of(tables)
        course = course_over(tables, films)
        arrays = Bearings(
            rings=rings,
            rows=np.zeros(rings.most_slices, dtype=np.int64),
            states=np.zeros((len(elements), 4 * rings.most_slices)),
            films=films,
            course=course_of(0, len(tables)),
            strict=np.array([is_strict(_force_of(element).law) for element in elements], dtype=np.bool_),
        )
        super().__init__(course, arrays)


def _force_of(element: BearingElement) -> BearingForce:
    """The force of a bearing that the kind takes."""
    assert isinstance(element.force, BearingForce)
    return element.force


def is_strict(law: Law) -> bool:
    """Whether a law refuses loads above its map."""
    return law.outside == "error"


def room_of(tables: Sequence[SpeedTables]) -> Films:
    """Room for tables; dry laws have one for all speeds, and power laws none."""
    films, nodes = len(tables), NODES + 1 if any(one.varies for one in tables) else 1
    cells = 2 * table.ROWS if any(one.has_cells for one in tables) else 1
    return Films(
        tables=np.zeros((films, nodes, cells, 8)),
        numbers=np.zeros((films, nodes, table.NUMBERS)),
        cells=np.zeros((films, cells, 8)),
        knots=np.zeros((films, cells)),
        current=np.zeros((films, table.NUMBERS)),
        in_use=np.full((films, 2), -1.0),
    )


def course_over(tables: Sequence[SpeedTables], films: Films) -> CourseOfFilms:
    """Tables that are made ahead of a run into their room, one for each film.

    Parameters
    ----------
    tables : sequence of SpeedTables
        What makes them.
    films : Films
        Room of `room_of`.
    """
    return CourseOfFilms(
        [table.places for table in tables],
        lambda film, *places: tables[film].prepare(*places, films.tables[film], films.numbers[film]),
    )


def _takes(element: Element) -> bool:
    """Whether the force of a bearing is the compiled one."""
    return isinstance(element, BearingElement) and type(element.force) is BearingForce and not element.bearing.coupled


BEARINGS = Kind(
    arrays=Bearings,
    answer=bearings_answer,
    feels=feels,
    gather=BearingBlock,
    takes=_takes,
    placed=placed,
    powers=bearings_powers,
)
"""For `mbs.transient.kinds`."""
