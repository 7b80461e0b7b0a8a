"""Ball bearings in compiled runs: the kernel of a bearing alone.

Films change with the speed: their laws are made at nodes that
lie evenly in its logarithm, on one grid of approaches, and blended straight between two nodes, see
`mbs.bearings.balls.film_tables`.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from mbs.bearings.balls.answers import LawBlock, answer_port, felt_rows, read_pose
from mbs.bearings.balls.ball_bearing import NEGLIGIBLE
from mbs.bearings.balls.ball_element import BallStates, MachineBalls
from mbs.bearings.balls.ball_kernel import (
    COLUMNS,
    NO_BALANCE,
    NUMBERS,
    START,
    TOO_FAR,
    BallShape,
    ball_force,
)
from mbs.bearings.balls.ball_memory import SPRINGS, FilmsOfBalls, go_on, hold
from mbs.bearings.balls.ball_speed import Drive, ball_loads, dry_energy, speed_work
from mbs.bearings.balls.film_tables import FilmLaws, FilmTables, blend, film_tables, law_of
from mbs.bearings.balls.laws import NODES
from mbs.bearings.balls.normal_law import HELD, NormalLaw, contact, load_approach
from mbs.bearings.speed_tables import Course, course_of
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment

_REST_STEPS = 20


class Balls(NamedTuple):
    """Ball bearings as arrays, one row a bearing; rows of balls are as long as the longest.

    Attributes
    ----------
    firsts, places, films_of, counts : array (bearings,), of int
        First of what each feels, its place among all elements, its film, and how many balls it has.
    starts, turns, offsets : array (bearings,)
        Angle of the first ball [rad], cage angle by that of the system, axial offset [m].
    spins : array (bearings, 2)
        Speeds of the rings by that of the system.
    shapes : array (bearings, 7)
        `BallShape` in its order.
    drives : array (bearings, 6)
        `Drive` in its order, at rest.
    cos, sin : array (bearings, Z)
        Directions of the balls in the cage.
    centres, rows : array (bearings, Z, START), (bearings, Z, COLUMNS)
        Starts of the balls, and what `place_ball` writes of each, at the last answer.
    rests : array (bearings,)
        Approach at the outer raceway under the centrifugal load alone [m].
    powers : array (bearings, 2)
        What it dissipates, and what the turning cage brings in [W].
    last, times, works : array (bearings, Z, 4), (bearings,), (bearings,)
        What `speed_work` keeps of the last step, its time [s], and its work by that time [W].
    relaxes : array (bearings,), of bool
        Whether films have a memory.
    held, passed : array (bearings, Z, 2, HELD), (bearings, Z, 2, SPRINGS, 2)
        What contacts with memory hold over the step, see `mbs.bearings.balls.ball_memory.hold`.
    forces, springs, approaches : array (bearings, Z, 2, SPRINGS), (..., SPRINGS + 1), (..., 2)
        Their states after the last step that was made.
    clock : array (2,)
        Times at the end of that step, and of the step for which they hold [s].
    rooms, matrices : array (3, NUMBERS), (2, 6, 6)
        Room for a bearing's pose, numbers and force, and for its stiffness and damping.
    films : FilmTables
        Laws of the contacts.
    course : Course
        Places of the steps on the tables.
    """

    firsts: IntArray
    places: IntArray
    films_of: IntArray
    counts: IntArray
    starts: FloatArray
    turns: FloatArray
    offsets: FloatArray
    spins: FloatArray
    shapes: FloatArray
    drives: FloatArray
    cos: FloatArray
    sin: FloatArray
    centres: FloatArray
    rows: FloatArray
    rests: FloatArray
    powers: FloatArray
    last: FloatArray
    times: FloatArray
    works: FloatArray
    relaxes: BoolArray
    held: FloatArray
    passed: FloatArray
    forces: FloatArray
    springs: FloatArray
    approaches: FloatArray
    clock: FloatArray
    rooms: FloatArray
    matrices: FloatArray
    films: FilmTables
    course: Course


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _read_springs(films: FilmTables, film: int, side: int, at: float, out: FloatArray) -> None:
    """Write the springs of a contact at a place on its table, straight between rows and nodes; held beyond the ends."""
    last = films.length[film] - 1
    if last < 1:
        out[:] = 0.0
        out[SPRINGS] = 1.0
        return
    node, weight, springs = int(films.in_use[film, 0]), films.in_use[film, 1], films.springs
    other = (node + 1) % films.numbers.shape[1] if weight > 0.0 else node
    place = min(max(at, 0.0), float(last))
    cell = min(int(place), last - 1)
    t = place - cell
    for r in range(SPRINGS + 1):
        slow, fast = springs[film, node, side, cell, r], springs[film, other, side, cell, r]
        slow += t * (springs[film, node, side, cell + 1, r] - slow)
        fast += t * (springs[film, other, side, cell + 1, r] - fast)
        out[r] = slow + weight * (fast - slow)


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _hold_all(balls: Balls, step: float) -> None:
    """Write what the contacts with memory hold over a step [s]."""
    for b in range(balls.firsts.size):
        if balls.relaxes[b]:
            for j in range(balls.counts[b]):
                for side in range(2):
                    springs, forces = balls.springs[b, j, side], balls.forces[b, j, side]
                    passed, held = balls.passed[b, j, side], balls.held[b, j, side]
                    hold(step, balls.approaches[b, j, side], springs, forces, passed, held)


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _go_on_all(balls: Balls) -> None:
    """Bring the contacts with memory to the end of a step that was made."""
    after = balls.rooms[0, : SPRINGS + 1]
    for b in range(balls.firsts.size):
        if balls.relaxes[b]:
            for j in range(balls.counts[b]):
                for side in range(2):
                    approach = balls.rows[b, j, 14 + side]
                    _read_springs(balls.films, balls.films_of[b], side, balls.rows[b, j, 20 + side], after)
                    moved, passed = approach - balls.approaches[b, j, side], balls.passed[b, j, side]
                    go_on(moved, balls.springs[b, j, side], after, passed, balls.forces[b, j, side])
                    balls.approaches[b, j, side] = approach


@njit(error_model="numpy", _nrt=False)
def rest_approach(law: NormalLaw, load: float, start: float) -> float:
    """Approach at which a contact carries a load >= 0 [m], from a start near it.

    Parameters
    ----------
    law : NormalLaw
        Law of the contact.
    load : float
        Load [N].
    start : float
        Approach to begin with [m].
    """
    if load <= 0.0:
        return 0.0
    if law.table.shape[0] > 0:
        for _ in range(_REST_STEPS):
            found, k, _c = contact(law, start)
            if not (found > 0.0 and k > 0.0):
                break
            short = math.log(load / found)
            if abs(short) <= 1e-12:
                return start
            start += short * found / k
    approach: float = load_approach(law, load)
    return approach


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _on_ring(balls: Balls, b: int, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Write the answer of a bearing; status as of `ball_force`."""
    i, z, film = balls.firsts[b], balls.counts[b], balls.films_of[b]
    pose, numbers, force = balls.rooms[0, :6], balls.rooms[1], balls.rooms[2, :6]
    stiffness, damping = balls.matrices[0], balls.matrices[1]
    read_pose(i, balls.offsets[b], motion, pose)
    s = balls.shapes[b]
    if s[0] * (s[0] + pose[0]) < 0.0:  # an angular contact bearing beyond its middle, where it has no raceway
        return TOO_FAR
    shape = BallShape(s[0], s[1], s[2], s[3], s[4], s[5], s[6])
    inner, outer = law_of(balls.films, film, 0), law_of(balls.films, film, 1)
    at_rest = balls.drives[b]
    speeds = balls.spins[b, 0] * moment.speed, balls.spins[b, 1] * moment.speed
    drive = Drive(speeds[0], speeds[1], at_rest[2], at_rest[3], at_rest[4], at_rest[5])
    rest = rest_approach(outer, ball_loads(drive, balls.turns[b] * moment.speed)[0], balls.rests[b])
    balls.rests[b] = rest
    moves = 0.0 if inner.table.shape[0] == 0 and rest < NEGLIGIBLE else 1.0
    numbers[0], numbers[1] = balls.starts[b] + balls.turns[b] * moment.angle, rest
    numbers[2], numbers[3] = moves * speeds[0], moves * speeds[1]
    for n in range(2, at_rest.size):
        numbers[2 + n] = at_rest[n]
    centres, rows = balls.centres[b, :z], balls.rows[b, :z]
    held = balls.held[b, : z if balls.relaxes[b] else 0]
    found = NO_BALANCE
    for _ in range(2):
        found = ball_force(
            pose, numbers, balls.cos[b, :z], balls.sin[b, :z], shape, inner, outer, force, stiffness, damping,
            centres, rows, held,
        )  # fmt: skip
        if found != NO_BALANCE:
            break
        centres[:] = math.nan  # once more, from nothing
    if found < 0:
        centres[:] = math.nan
        return found
    answer_port(i, balls.turns[b], moment, motion, pose, force, balls.matrices, answers, balls.powers[b])
    return found


@njit(error_model="numpy", _nrt=False)
def balls_answer(balls: Balls, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and slopes of all ball bearings; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    balls : Balls
        The bearings, with the tables of their laws.
    moment : Moment
        Step, angle, speed, weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    course, films = balls.course, balls.films
    for film in range(films.highest.size):
        blend(films, film, course.nodes[moment.step, film], course.weights[moment.step, film])
    if balls.clock[1] != moment.time:
        balls.clock[1] = moment.time
        _hold_all(balls, moment.time - balls.clock[0])
    for b in range(balls.firsts.size):
        found = _on_ring(balls, b, moment, motion, answers)
        if found < 0:
            return IN_PYTHON if found == TOO_FAR else NO_SOLUTION
        largest = 0.0
        for j in range(balls.counts[b]):
            largest = max(largest, balls.rows[b, j, 10], balls.rows[b, j, 11])
        if largest > films.highest[balls.films_of[b]]:
            answers.outside[balls.places[b]] += 1
    return FOUND


@njit(error_model="numpy", _nrt=False)
def balls_accept(balls: Balls, moment: Moment) -> None:
    """Take note of a step that was made: films with memory.

    Parameters
    ----------
    balls, moment
        The same as of `balls_answer`, of which this was the last one.
    """
    _go_on_all(balls)
    balls.clock[0], balls.clock[1] = moment.time, math.nan


@njit(error_model="numpy", _nrt=False)
def balls_powers(balls: Balls, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray) -> None:
    """Write what contacts dissipate, and what cage and speed bring in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    balls, moment, motion, answers
        The same as of `balls_answer`, of which this was the last one.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    for b in range(balls.firsts.size):
        z, h = balls.counts[b], moment.time - balls.times[b]
        work = speed_work(balls.rows[b, :z], balls.shapes[b, 4], balls.last[b, :z])
        balls.times[b], balls.works[b] = moment.time, work / h if h > 0.0 else 0.0
        out[balls.places[b], 0], out[balls.places[b], 1] = balls.powers[b, 0], balls.powers[b, 1] + balls.works[b]


class BallBlock(LawBlock[Balls]):
    """The ball bearings of a run; see `mbs.model.blocks.StatefulBlock`.

    Parameters
    ----------
    members : sequence of Member
        Bearings of the class `MachineBalls`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        elements: list[MachineBalls] = [member.element for member in members]
        super().__init__(elements, NODES, lambda films_of, laws: _gather(members, films_of, laws))

    def states(self) -> Sequence[BallStates]:
        """States of each bearing after the last step."""
        arrays = self._arrays
        return [
            BallStates(
                time=float(arrays.times[b]),
                last=arrays.last[b, :z].copy(),
                dissipated=float(arrays.powers[b, 0]),
                driven=float(arrays.powers[b, 1] + arrays.works[b]),
                stored=dry_energy(arrays.rows[b, :z]),
                films=FilmsOfBalls(*(place.copy() for place in self._places(b))) if arrays.relaxes[b] else None,
            )
            for b, z in enumerate(arrays.counts.tolist())
        ]

    def resume(self, states: Sequence[BallStates]) -> None:
        """Go on with states that `MachineBalls.advance` gave.

        Parameters
        ----------
        states : sequence of BallStates
            States of each bearing.
        """
        for b, one in enumerate(states):
            self._arrays.times[b] = one.time
            self._arrays.last[b, : one.last.shape[0]] = one.last
            self._arrays.clock[:] = one.time, math.nan
            places = self._places(b)
            for place, values in zip(
                places, dataclasses.astuple(one.films) if one.films else (0.0, 0.0, 0.0), strict=True
            ):
                place[:] = values

    def _places(self, b: int) -> tuple[FloatArray, ...]:
        """Arrays of the films of a bearing: forces, springs, approaches."""
        arrays, z = self._arrays, int(self._arrays.counts[b])
        return arrays.forces[b, :z], arrays.springs[b, :z], arrays.approaches[b, :z]


def _gather(members: Sequence[Member], films_of: list[int], laws: Sequence[FilmLaws]) -> Balls:
    """Arrays of some bearings."""
    elements: list[MachineBalls] = [member.element for member in members]
    count, most = len(elements), max((one.force.geometry.balls for one in elements), default=0)
    films = film_tables(laws, NODES, SPRINGS + 1 if any(one.relaxes for one in elements) else 0)
    cos, sin = np.zeros((2, count, most))
    for b, one in enumerate(elements):
        cos[b, : one.force.geometry.balls], sin[b, : one.force.geometry.balls] = one.force.directions
    return Balls(
        firsts=np.array([member.first for member in members], dtype=np.int64),
        places=np.array([member.place for member in members], dtype=np.int64),
        films_of=np.array(films_of, dtype=np.int64),
        counts=np.array([one.force.geometry.balls for one in elements], dtype=np.int64),
        starts=np.array([one.start_angle for one in elements], dtype=np.float64),
        turns=np.array([one.cage_turn for one in elements], dtype=np.float64),
        offsets=np.array([one.axial_offset for one in elements], dtype=np.float64),
        spins=np.array([(one.inner_spin, one.outer_spin) for one in elements], dtype=np.float64).reshape(count, 2),
        shapes=np.array([one.force.shape for one in elements], dtype=np.float64).reshape(count, 7),
        drives=np.array([one.force.drive for one in elements], dtype=np.float64).reshape(count, 6),
        cos=cos,
        sin=sin,
        centres=np.full((count, most, START), np.nan),
        rows=np.zeros((count, most, COLUMNS)),
        rests=np.zeros(count),
        powers=np.zeros((count, 2)),
        last=np.zeros((count, most, 4)),
        times=np.zeros(count),
        works=np.zeros(count),
        relaxes=np.array([one.relaxes for one in elements], dtype=np.bool_),
        held=np.zeros((count, most, 2, HELD)),
        passed=np.zeros((count, most, 2, SPRINGS, 2)),
        forces=np.zeros((count, most, 2, SPRINGS)),
        springs=np.zeros((count, most, 2, SPRINGS + 1)),
        approaches=np.zeros((count, most, 2)),
        clock=np.array([0.0, math.nan]),
        rooms=np.zeros((3, NUMBERS)),
        matrices=np.zeros((2, 6, 6)),
        films=films,
        course=course_of(0, len(laws)),
    )


BALLS = Kind(
    arrays=Balls,
    answer=balls_answer,
    feels=felt_rows,
    gather=BallBlock,
    accept=balls_accept,
    powers=balls_powers,
    rare=True,
)
"""For `mbs.transient.kinds`."""
