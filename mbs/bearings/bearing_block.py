"""Bearings in compiled runs with films of slow motion or dry: they read tables of their law over the speed.

With massless rollers each feels four displacements of its ring. Each contact of a roller that is a body is a bearing of
one roller at the angle zero to `mbs.bearings.bearing_kernel`: its approach is the displacement y, its tilt theta_z.
"""

from __future__ import annotations

import math
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
from mbs.bearings.bearing_kernel import bearing_force, level_force, ring_powers, roller_power
from mbs.bearings.laws import FlatLaw, Law
from mbs.bearings.rings import (
    LEVEL,
    Contact,
    Rings,
    Rollers,
    add_contact,
    alone,
    answer_ring,
    begin_answer,
    feels,
    gather_rings,
    gather_rollers,
    motion_of,
    outward_power,
    place_of,
    placed,
    rollers_feel,
    shape_of,
)
from mbs.bearings.roller_element import RollerElement
from mbs.bearings.slice_table import CELLS, KNOTS, LawNumbers, PreparedLaw, fade, law_numbers, store_numbers
from mbs.bearings.slices import RingMotion, Shape, Work, roller_of, sizes_of
from mbs.bearings.speed_tables import NODES, Course, CourseOfFilms, FilmBlock, SpeedTables, course_of, shared
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
        Slices of each bearing at rest at the last answer, as of `mbs.bearings.slices.Work`.
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


_Y, _THETA_Z = 1, 5


class RollerBearings(NamedTuple):
    """Bearings with rollers that are bodies, and contacts without states, as arrays.

    Attributes
    ----------
    rollers : Rollers
        What does not change.
    rows, states : array (n,), (4 n,)
        Work space for one contact after the other.
    films : Films
        Tables of the laws of single contacts.
    course : Course
        Places of the steps on the tables.
    lost, torques : array (bearings,)
        Power that the contacts of each dissipated at the last answer [W], and moment of their loads at rest on the
        cage [N m].
    strict : array (bearings,), of bool
        Whether a law refuses loads above its map.
    """

    rollers: Rollers
    rows: IntArray
    states: FloatArray
    films: Films
    course: Course
    lost: FloatArray
    torques: FloatArray
    strict: BoolArray


@njit(error_model="numpy")
def rollers_answer(bearings: RollerBearings, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and slopes of all bearings; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings : RollerBearings
        The bearings, with the tables of their laws.
    moment : Moment
        Step, angle, speed, weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    rollers, course, films = bearings.rollers, bearings.course, bearings.films
    rings = rollers.rings
    for film in range(films.current.shape[0]):
        blend(films, film, course.nodes[moment.step, film], course.weights[moment.step, film])
    out, cos, sin = np.empty((13, 6)), np.ones(1), np.zeros(1)
    for b in range(rings.firsts.size):
        n = rings.slices[b]
        angle = rings.start_angles[b] + rings.cage_rates[b] * moment.angle
        cage = math.cos(angle), math.sin(angle)
        sizes = sizes_of(rings.sizes[b])
        shape = Shape(sizes, rings.positions[b][:n], 0.5 * rings.profiles[b][:n], cos, sin)
        work = Work(bearings.rows[:n].reshape(1, n), bearings.states[: 4 * n].reshape(4, 1, n))
        begin_answer(rollers, b, moment, answers)
        lost = torque = 0.0
        outside = 0
        first, x = rings.firsts[b], motion[0]
        for j in range(rings.rollers[b]):
            place = place_of(rollers, b, j, cage, motion)
            for side in range(2):
                film = rollers.films_of[b, side]
                law = PreparedLaw(law_numbers(films.current[film]), films.cells[film], films.knots[film])
                y = place.approach[side] + sizes.half_clearance
                ring = RingMotion(y, 0.0, 0.0, place.tilt, place.rate[side], 0.0, 0.0, place.tilt_rate, 1.0, 0.0)
                status = bearing_force(ring, shape, law, work, out)
                if status < 0:
                    return NO_SOLUTION
                if status > 0 and bearings.strict[b]:
                    return IN_PYTHON
                outside = max(outside, status, course.outside[moment.step, film])
                stiffness, damping = out[1:7], out[7:13]
                contact = Contact(
                    -out[0, _Y],
                    -out[0, _THETA_Z],
                    moment.by_q * stiffness[_Y, _Y] + moment.by_v * damping[_Y, _Y],
                    moment.by_q * stiffness[_Y, _THETA_Z] + moment.by_v * damping[_Y, _THETA_Z],
                    moment.by_q * stiffness[_THETA_Z, _THETA_Z] + moment.by_v * damping[_THETA_Z, _THETA_Z],
                )
                add_contact(rollers, b, j, side, place, contact, answers)
                power, flat, tilted = roller_power(
                    roller_of(ring, shape, 0), shape.positions, rings.weights[b][:n], work.states, 0
                )
                sign, c, s, r = 1.0 - 2.0 * side, place.cos, place.sin, first + 2 * side
                across = x[r + 1] * c - x[r] * s
                lost += power
                torque += sign * across * flat - 0.5 * (x[first + 5] * s + x[first + 4] * c) * tilted
        bearings.lost[b], bearings.torques[b] = lost * sizes.slice_length, torque * sizes.slice_length
        answers.outside[rings.places[b]] += outside
    return FOUND


@njit(error_model="numpy")
def rollers_powers(
    bearings: RollerBearings, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray
) -> None:
    """What contacts dissipate, and what the cage brings in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings, moment, motion, answers
        The same as of `rollers_answer`.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    rings = bearings.rollers.rings
    for b in range(rings.firsts.size):
        out[rings.places[b], 0] = bearings.lost[b]
        outward = outward_power(bearings.rollers, b, moment, motion)
        out[rings.places[b], 1] = bearings.torques[b] * rings.cage_rates[b] * moment.speed + outward


class RollerBlock(FilmBlock[RollerBearings]):
    """The bearings of a run; contacts with the same law at the same speed and temperature share their tables.

    Parameters
    ----------
    members : sequence of Member
        Elements of the class `RollerElement`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        elements: list[RollerElement] = [member.element for member in members]
        pairs = [(element.plain, law) for element in elements for law in element.contacts.laws]
        films_of, firsts = shared((id(law), plain.temperature, plain.rates[1]) for plain, law in pairs)
        tables = []
        for first in firsts:
            plain, law = pairs[first]
            tables.append(SpeedTables(plain.bearing, FlatLaw(law), plain.temperature, (plain.rates[1], 0.0)))
        rollers = gather_rollers(members, films_of)
        films = room_of(tables)
        course = course_over(tables, films)
        most = int(np.max(rollers.rings.slices, initial=0))
        arrays = RollerBearings(
            rollers=rollers,
            rows=np.zeros(most, dtype=np.int64),
            states=np.zeros(4 * most),
            films=films,
            course=course_of(0, len(tables)),
            lost=np.zeros(len(elements)),
            torques=np.zeros(len(elements)),
            strict=np.array([any(map(is_strict, each.contacts.laws)) for each in elements], dtype=np.bool_),
        )
        super().__init__(course, arrays)


ROLLERS = Kind(
    arrays=RollerBearings,
    answer=rollers_answer,
    feels=rollers_feel,
    gather=RollerBlock,
    alone=alone,
    powers=rollers_powers,
)
"""For `mbs.transient.kinds`."""
