"""Rollers that are bodies, in compiled runs, with films of slow motion or dry.

Each contact of a roller is a bearing of one roller at the angle zero to `mbs.bearings.bearing_kernel`: its approach is
the displacement y, and its tilt theta_z.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from mbs.bearings.bearing_block import Films, blend, course_over, is_strict, room_of
from mbs.bearings.bearing_kernel import bearing_force, roller_power
from mbs.bearings.film_course import Course, FilmBlock, course_of, shared
from mbs.bearings.flat_law import FlatLaw
from mbs.bearings.roller_element import RollerElement
from mbs.bearings.roller_motion import RingMotion, Shape, Work, roller_of, sizes_of
from mbs.bearings.roller_places import (
    Contact,
    Rollers,
    add_contact,
    alone,
    begin_answer,
    feels,
    gather_rollers,
    outward_power,
    place_of,
)
from mbs.bearings.slice_table import PreparedLaw, law_numbers
from mbs.bearings.speed_tables import SpeedTables
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment

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
    feels=feels,
    gather=RollerBlock,
    alone=alone,
    powers=rollers_powers,
)
"""For `mbs.transient.kinds`."""
