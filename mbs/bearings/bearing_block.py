"""Bearings in compiled runs with films of slow motion or dry: they read tables of their law over the speed.

Massless rollers are answered all at once. Each contact of a roller that is a body is a bearing of one roller at the
angle zero to `mbs.bearings.bearing_kernel`: its approach is the displacement y, its tilt theta_z.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.copies import put
from ehdmaps.maps.kernels.lines import FAST
from mbs.bearings import slice_table as table
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.bearing_kernel import bearing_force, level_force, ring_powers, roller_power
from mbs.bearings.rings import (
    LEVEL,
    Contact,
    Place,
    Rings,
    add_contact,
    alike_contacts,
    alone,
    answer_ring,
    begin_answer,
    cage_of,
    feels,
    gather_rings,
    motion_of,
    outward_power,
    place_of,
    placed,
    shape_of,
    strict,
)
from mbs.bearings.slice_table import CELLS, KNOTS, LawNumbers
from mbs.bearings.slices import (
    PreparedLaw,
    RingMotion,
    Shape,
    Work,
    fade,
    law_numbers,
    roller_of,
    sizes_of,
    store_numbers,
)
from mbs.bearings.speed_tables import NODES, Course, CourseOfFilms, FilmBlock, SpeedTables, course_of
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment
from mbs.model.elements import Element

_Y, _THETA_Z = 1, 5
"""What a contact of a roller feels as a bearing of one roller."""


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
    states : array (bearings, sides, 4 Z n)
        Slices of each bearing at rest at the last answer, as of `mbs.bearings.slices.Work`: of all its rollers together
        where they are massless, else of one contact after the other.
    films : Films
        Tables of the laws.
    course : Course
        Places of the steps on the tables.
    strict : array (bearings,), of bool
        Whether a law refuses loads above its map.
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
def _law_of(bearings: Bearings, b: int, side: int) -> PreparedLaw:
    """The law in use of a side of the contacts of a bearing."""
    films, film = bearings.films, bearings.rings.films_of[b, side]
    return PreparedLaw(law_numbers(films.current[film]), films.cells[film], films.knots[film])


@njit(error_model="numpy")
def _on_rings(bearings: Bearings, b: int, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Write the answer of a bearing with massless rollers, all of them at once; status as of `bearing_force`."""
    rings, out = bearings.rings, np.empty((13, 6))
    z, n = rings.rollers[b], rings.slices[b]
    work = Work(bearings.rows[: z * n].reshape(z, n), bearings.states[b, 0][: 4 * z * n].reshape(4, z, n))
    ring, shape, law = motion_of(rings, b, moment, motion), shape_of(rings, b), _law_of(bearings, b, 0)
    status = 0
    if rings.felt[b] == LEVEL:
        status = level_force(ring, shape, rings.weights[b][:n], law, work, out)
    else:
        status = bearing_force(ring, shape, law, work, out)
    if status >= 0:
        answer_ring(rings.firsts[b], rings.felt[b], moment, out, answers)
    return status


@njit(error_model="numpy")
def _one_roller(rings: Rings, b: int) -> Shape:
    """A contact of a roller as a bearing of one roller, which has half of the profile."""
    n = rings.slices[b]
    return Shape(sizes_of(rings.sizes[b]), rings.positions[b][:n], 0.5 * rings.profiles[b][:n], np.ones(1), np.zeros(1))


@njit(error_model="numpy")
def _contact_motion(place: Place, side: int, shape: Shape) -> RingMotion:
    """Motion of the ring of that bearing."""
    y = place.approach[side] + shape.sizes.half_clearance
    return RingMotion(y, 0.0, 0.0, place.tilt, place.rate[side], 0.0, 0.0, place.tilt_rate, 1.0, 0.0)


@njit(error_model="numpy")
def _contact_states(bearings: Bearings, b: int, side: int, j: int) -> FloatArray:
    """States of the slices of a contact, shape (4, 1, n)."""
    n = bearings.rings.slices[b]
    states: FloatArray = bearings.states[b, side][4 * n * j : 4 * n * (j + 1)].reshape(4, 1, n)
    return states


@njit(error_model="numpy")
def _on_rollers(bearings: Bearings, b: int, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Write the answer of a bearing whose rollers are bodies, contact by contact; status as of `bearing_force`."""
    rings, out, above = bearings.rings, np.empty((13, 6)), 0
    n, cage, shape = rings.slices[b], cage_of(rings, b, moment), _one_roller(rings, b)
    rows = bearings.rows[:n].reshape(1, n)
    begin_answer(rings, b, moment, answers)
    for j in range(rings.rollers[b]):
        place = place_of(rings, b, j, cage, motion)
        for side in range(2):
            work, ring = Work(rows, _contact_states(bearings, b, side, j)), _contact_motion(place, side, shape)
            status = bearing_force(ring, shape, _law_of(bearings, b, side), work, out)
            if status < 0:
                return status
            above = max(above, status)
            stiffness, damping = out[1:7], out[7:13]
            contact = Contact(
                -out[0, _Y],
                -out[0, _THETA_Z],
                moment.by_q * stiffness[_Y, _Y] + moment.by_v * damping[_Y, _Y],
                moment.by_q * stiffness[_Y, _THETA_Z] + moment.by_v * damping[_Y, _THETA_Z],
                moment.by_q * stiffness[_THETA_Z, _THETA_Z] + moment.by_v * damping[_THETA_Z, _THETA_Z],
            )
            add_contact(rings, b, j, side, place, contact, answers)
    return above


@njit(error_model="numpy")
def bearings_answer(bearings: Bearings, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and slopes of all bearings; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings : Bearings
        The bearings, with the tables of their laws.
    moment : Moment
        Step, angle, speed, weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    course, rings = bearings.course, bearings.rings
    for film in range(bearings.films.current.shape[0]):
        blend(bearings.films, film, course.nodes[moment.step, film], course.weights[moment.step, film])
    count, sides = rings.films_of.shape
    for b in range(count):
        status = 0
        if sides == 1:
            status = _on_rings(bearings, b, moment, motion, answers)
        else:
            status = _on_rollers(bearings, b, moment, motion, answers)
        if status < 0:
            return NO_SOLUTION
        if status > 0 and bearings.strict[b]:
            return IN_PYTHON
        for side in range(sides):
            status = max(status, course.outside[moment.step, rings.films_of[b, side]])
        answers.outside[rings.places[b]] += status
    return FOUND


@njit(error_model="numpy")
def _contact_powers(bearings: Bearings, b: int, moment: Moment, motion: FloatArray) -> tuple[float, float]:
    """`ring_powers` of a bearing whose rollers are bodies."""
    rings = bearings.rings
    cage, shape, weights = cage_of(rings, b, moment), _one_roller(rings, b), rings.weights[b][: rings.slices[b]]
    dissipated = torque = 0.0
    first, x = rings.firsts[b], motion[0]
    for j in range(rings.rollers[b]):
        place = place_of(rings, b, j, cage, motion)
        for side in range(2):
            roller = roller_of(_contact_motion(place, side, shape), shape, 0)
            states = _contact_states(bearings, b, side, j)
            power, flat, tilted = roller_power(roller, shape.positions, weights, states, 0)
            sign, c, s, r = 1.0 - 2.0 * side, place.cos, place.sin, first + 2 * side
            across = x[r + 1] * c - x[r] * s
            dissipated += power
            torque += sign * across * flat - 0.5 * (x[first + 5] * s + x[first + 4] * c) * tilted
    length = shape.sizes.slice_length
    dissipated, torque = dissipated * length, torque * length
    return dissipated, torque * rings.cage_rates[b] * moment.speed + outward_power(rings, b, moment, motion)


@njit(error_model="numpy")
def bearings_powers(bearings: Bearings, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray) -> None:
    """Write what contacts dissipate, and what cage and centrifugal forces bring in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    bearings, moment, motion, answers
        The same as of `bearings_answer`, of which this was the last one.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    rings = bearings.rings
    count, sides = rings.films_of.shape
    for b in range(count):
        place = rings.places[b]
        if sides == 2:
            out[place, 0], out[place, 1] = _contact_powers(bearings, b, moment, motion)
            continue
        z, n = rings.rollers[b], rings.slices[b]
        states = bearings.states[b, 0][: 4 * z * n].reshape(4, z, n)
        numbers = law_numbers(bearings.films.current[rings.films_of[b, 0]])
        cage_rate = rings.cage_rates[b] * moment.speed
        ring, shape = motion_of(rings, b, moment, motion), shape_of(rings, b)
        out[place, 0], out[place, 1] = ring_powers(ring, shape, rings.weights[b][:n], numbers, states, cage_rate)


class BearingBlock(FilmBlock[Bearings]):
    """The bearings of a run; contacts with the same law at the same conditions share their tables.

    Parameters
    ----------
    members : sequence of Member
        Bearings with a `BearingForce`, or elements of the class `RollerElement`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        films_of, alike = alike_contacts(members)
        tables = [SpeedTables(one.bearing, one.law, one.temperature, one.rates) for one in alike]
        rings, films = gather_rings(members, films_of), room_of(tables)
        arrays = Bearings(
            rings=rings,
            rows=np.zeros(rings.most_slices, dtype=np.int64),
            states=np.zeros((*films_of.shape, 4 * rings.most_slices)),
            films=films,
            course=course_of(0, len(tables)),
            strict=strict(members),
        )
        super().__init__(course_over(tables, films), arrays)


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
    """Tell whether the force of a bearing is the compiled one."""
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


ROLLERS = Kind(
    arrays=Bearings,
    answer=bearings_answer,
    feels=feels,
    gather=BearingBlock,
    alone=alone,
    powers=bearings_powers,
)
"""For `mbs.transient.kinds`: the same with rollers as bodies."""
