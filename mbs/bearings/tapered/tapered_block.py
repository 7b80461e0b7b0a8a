"""Tapered roller bearings in compiled runs: the kernel of a bearing alone, see `mbs.model.blocks`.

Films change with the speed: see `mbs.bearings.balls.film_tables`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from mbs.bearings.balls.ball_speed import turned_by
from mbs.bearings.balls.film_tables import FilmLaws, FilmTables, blend, film_tables, law_of
from mbs.bearings.speed_tables import Course, CourseOfFilms, FilmBlock, Prepared, course_of, shared
from mbs.bearings.tapered.line_film import NODES
from mbs.bearings.tapered.tapered_bearing import FASTEST, TaperedForce
from mbs.bearings.tapered.tapered_element import TaperedElement
from mbs.bearings.tapered.tapered_energy import TaperedStates, dry_energy, place_work
from mbs.bearings.tapered.tapered_kernel import (
    COLUMNS,
    MOST_RIBS,
    NO_BALANCE,
    TOO_FAR,
    Ribs,
    RollerLaws,
    RollerWork,
    TaperedShape,
    roller_work,
    tapered_force,
)
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment

FELT = np.array([0, 1, 2, 4, 5])
"""Displacements of its port that a tapered roller bearing feels."""


class Tapered(NamedTuple):
    """Tapered roller bearings as arrays, one row a bearing; rows of rollers and slices are as long as the longest.

    Attributes
    ----------
    firsts, places, films_of, counts, slices : array (bearings,), of int
        First of what each feels, its place among all elements, its film, how many rollers it has, and how
        many slices these.
    starts, turns, offsets : array (bearings,)
        Angle of the first roller [rad], cage angle by that of the system, axial offset [m].
    fastest : array (bearings,)
        Largest speed of the system [rad/s].
    shapes : array (bearings, 7)
        Numbers of `TaperedShape` in its order, those of normals one by one.
    rib_normals, rib_numbers, rib_outer : array (bearings, m, 2), (bearings, 3, m), (bearings, m)
        Arrays of `Ribs` in their order: normals, then levers, plays and laws, then on which ring.
    rib_counts : array (bearings,), of int
        How many ribs a bearing has.
    laws : array (bearings, 4)
        Numbers of `RollerLaws` in its order.
    loads : array (bearings, 2)
        Centrifugal load and gyroscopic moment over the square of the system's speed [N s2], [N m s2].
    levers, profiles : array (bearings, slices)
        Levers of the slices, and depths of the profile [m].
    cos, sin : array (bearings, Z)
        Directions of the rollers in the cage.
    starting, rows : array (bearings, Z, 3), (bearings, Z, 28)
        Places of the rollers, and what `place_roller` writes of each, at the last answer.
    powers : array (bearings, 2)
        What the last answer dissipates, and what the turning cage brings in [W].
    last, times, works : array (bearings, Z, 4), (bearings,), (bearings,)
        What `place_work` keeps of the last step, its time [s], and its work by that time [W].
    work : RollerWork
        Work space.
    rooms, matrices : array (3, 6), (2, 6, 6)
        Room for a bearing's pose, loads and force, and for its stiffness and damping.
    films : FilmTables
        Laws of the lines.
    course : Course
        Places of the steps on the tables.
    """

    firsts: IntArray
    places: IntArray
    films_of: IntArray
    counts: IntArray
    slices: IntArray
    starts: FloatArray
    turns: FloatArray
    offsets: FloatArray
    fastest: FloatArray
    shapes: FloatArray
    rib_normals: FloatArray
    rib_numbers: FloatArray
    rib_outer: BoolArray
    rib_counts: IntArray
    laws: FloatArray
    loads: FloatArray
    levers: FloatArray
    profiles: FloatArray
    cos: FloatArray
    sin: FloatArray
    starting: FloatArray
    rows: FloatArray
    powers: FloatArray
    last: FloatArray
    times: FloatArray
    works: FloatArray
    work: RollerWork
    rooms: FloatArray
    matrices: FloatArray
    films: FilmTables
    course: Course


@njit(error_model="numpy", _nrt=False)
def _on_ring(tapered: Tapered, b: int, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Write the answer of a bearing; status as of `tapered_force`."""
    i, z, n, x, y = tapered.firsts[b], tapered.counts[b], tapered.slices[b], motion[0], motion[1]
    pose, loads, force = tapered.rooms[0], tapered.rooms[1], tapered.rooms[2]
    stiffness, damping = tapered.matrices[0], tapered.matrices[1]
    pose[0], pose[1], pose[2], pose[3] = x[i] + tapered.offsets[b], x[i + 1], x[i + 2], 0.0
    pose[4], pose[5] = x[i + 3], x[i + 4]
    if not abs(moment.speed) <= tapered.fastest[b]:
        return TOO_FAR
    s, c = tapered.shapes[b], tapered.laws[b]
    m, numbers = tapered.rib_counts[b], tapered.rib_numbers[b]
    ribs = Ribs(
        tapered.rib_normals[b, :m], numbers[0, :m], numbers[1, :m], numbers[2, :m], tapered.rib_outer[b, :m]
    )  # fmt: skip
    shape = TaperedShape(
        s[0], (s[1], s[2]), (s[3], s[4]), ribs, tapered.levers[b, :n], tapered.profiles[b, :n],
        tapered.cos[b, :z], tapered.sin[b, :z], s[5], s[6],
    )  # fmt: skip
    film = tapered.films_of[b]
    cone, cup = law_of(tapered.films, film, 0), law_of(tapered.films, film, 1)
    laws = RollerLaws(c[0], c[1], c[2], c[3], cup, cone)
    square = moment.speed * moment.speed
    loads[0], loads[1], loads[2] = 0.0, tapered.loads[b, 0] * square, tapered.loads[b, 1] * square
    angle = tapered.starts[b] + tapered.turns[b] * moment.angle
    starting, rows = tapered.starting[b, :z], tapered.rows[b, :z]
    found = NO_BALANCE
    for _ in range(2):
        found = tapered_force(
            pose, angle, loads, shape, laws, force, stiffness, damping, starting, rows, tapered.work
        )  # fmt: skip
        if found != NO_BALANCE:
            break
        starting[:] = math.nan  # once more, from nothing
    if found < 0:
        starting[:] = math.nan
        return found
    dissipated = 0.0
    for p in range(FELT.size):
        row = FELT[p]
        total = force[row]
        for q in range(FELT.size):
            column = FELT[q]
            slowed = damping[row, column] * y[i + q]
            total -= slowed
            dissipated += y[i + p] * slowed
            answers.slopes[i + p, i + q] = moment.by_q * stiffness[row, column] + moment.by_v * damping[row, column]
        answers.force[i + p] = total
    tapered.powers[b, 0] = dissipated
    tapered.powers[b, 1] = turned_by(pose, force) * tapered.turns[b] * moment.speed
    return found


@njit(error_model="numpy", _nrt=False)
def tapered_answer(tapered: Tapered, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and slopes of all tapered roller bearings; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    tapered : Tapered
        The bearings.
    moment : Moment
        Step, angle, speed, weights of the slopes.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    course, films = tapered.course, tapered.films
    for film in range(films.highest.size):
        blend(films, film, course.nodes[moment.step, film], course.weights[moment.step, film])
    for b in range(tapered.firsts.size):
        found = _on_ring(tapered, b, moment, motion, answers)
        if found < 0:
            return IN_PYTHON if found == TOO_FAR else NO_SOLUTION
        largest = 0.0
        for j in range(tapered.counts[b]):
            largest = max(largest, tapered.rows[b, j, 3], tapered.rows[b, j, 4])
        if largest > films.highest[tapered.films_of[b]]:
            answers.outside[tapered.places[b]] += 1
    return FOUND


@njit(error_model="numpy", _nrt=False)
def tapered_accept(tapered: Tapered, moment: Moment) -> None:
    """Take note of a step that was made: places of the rollers for the work of their loads.

    Parameters
    ----------
    tapered, moment
        The same as of `tapered_answer`, of which this was the last one.
    """
    square = moment.speed * moment.speed
    for b in range(tapered.firsts.size):
        z, h = tapered.counts[b], moment.time - tapered.times[b]
        loads = tapered.loads[b, 0] * square, tapered.loads[b, 1] * square
        work = place_work(tapered.rows[b, :z], loads, tapered.last[b, :z])
        tapered.times[b], tapered.works[b] = moment.time, work / h if h > 0.0 else 0.0


@njit(error_model="numpy", _nrt=False)
def tapered_powers(tapered: Tapered, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray) -> None:
    """Write what contacts dissipate, and what cage and speed bring in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    tapered, moment, motion, answers
        The same as of `tapered_answer`, of which this was the last one.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    for b in range(tapered.firsts.size):
        place = tapered.places[b]
        out[place, 0], out[place, 1] = tapered.powers[b, 0], tapered.powers[b, 1] + tapered.works[b]


class TaperedBlock(FilmBlock[Tapered]):
    """The tapered roller bearings of a run; see `mbs.model.blocks.StatefulBlock`.

    Parameters
    ----------
    members : sequence of Member
        Bearings of the class `TaperedElement`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        self._elements: list[TaperedElement] = [member.element for member in members]
        films_of, firsts = shared(one.film_key for one in self._elements)
        self._laws = [FilmLaws(self._elements[first], NODES) for first in firsts]
        arrays = _gather(members, films_of, self._laws)
        films = arrays.films

        def make(film: int, speeds: FloatArray, nodes: IntArray, weights: FloatArray) -> Prepared:
            return self._laws[film].prepare(films, film, speeds, nodes, weights)

        super().__init__(CourseOfFilms([one.places for one in self._laws], make), arrays)

    def begin(self, speeds: FloatArray) -> None:
        """Find the places of the speeds [rad/s] on the tables, and the grids of these."""
        for one in self._laws:
            one.begin(speeds)
        super().begin(speeds)

    def states(self) -> Sequence[TaperedStates]:
        """States of each bearing after the last step."""
        arrays = self._arrays
        return [
            TaperedStates(
                time=float(arrays.times[b]),
                last=arrays.last[b, : arrays.counts[b]].copy(),
                dissipated=float(arrays.powers[b, 0]),
                driven=float(arrays.powers[b, 1] + arrays.works[b]),
                stored=dry_energy(one.force.laws, one.force.shape, arrays.rows[b, : arrays.counts[b]]),
            )
            for b, one in enumerate(self._elements)
        ]

    def resume(self, states: Sequence[TaperedStates]) -> None:
        """Go on with states that `TaperedElement.advance` gave.

        Parameters
        ----------
        states : sequence of TaperedStates
            States of each bearing.
        """
        for b, one in enumerate(states):
            self._arrays.times[b] = one.time
            self._arrays.last[b, : one.last.shape[0]] = one.last


def _gather(members: Sequence[Member], films_of: list[int], laws: Sequence[FilmLaws]) -> Tapered:
    """Arrays of some bearings."""
    elements: list[TaperedElement] = [member.element for member in members]
    forces: list[TaperedForce] = [one.force for one in elements]
    counts = np.array([force.geometry.rollers for force in forces], dtype=np.int64)
    slices = np.array([force.positions.size for force in forces], dtype=np.int64)
    count, most, longest = len(elements), max(counts, default=0), max(slices, default=0)
    levers, profiles = np.zeros((2, count, longest))
    cos, sin = np.zeros((2, count, most))
    for b, force in enumerate(forces):
        levers[b, : slices[b]], profiles[b, : slices[b]] = force.shape.levers, force.shape.profile
        cos[b, : counts[b]], sin[b, : counts[b]] = force.shape.cos, force.shape.sin
    spins = [(one.inner_spin, one.outer_spin, one.cage_turn) for one in elements]
    shapes = [(s.pitch_radius, *s.cup, *s.cone, s.most_travel, s.most_tilt) for s in (force.shape for force in forces)]
    normals, numbers = np.zeros((count, MOST_RIBS, 2)), np.zeros((count, 3, MOST_RIBS))
    rib_outer = np.zeros((count, MOST_RIBS), dtype=np.bool_)
    rib_counts = np.array([force.shape.ribs.levers.size for force in forces], dtype=np.int64)
    for b, ribs in enumerate(force.shape.ribs for force in forces):
        m = rib_counts[b]
        normals[b, :m], rib_outer[b, :m] = ribs.normals, ribs.outer
        numbers[b, :, :m] = ribs.levers, ribs.plays, ribs.laws
    return Tapered(
        firsts=np.array([member.first for member in members], dtype=np.int64),
        places=np.array([member.place for member in members], dtype=np.int64),
        films_of=np.array(films_of, dtype=np.int64),
        counts=counts,
        slices=slices,
        starts=np.array([one.start_angle for one in elements], dtype=np.float64),
        turns=np.array([one.cage_turn for one in elements], dtype=np.float64),
        offsets=np.array([one.axial_offset for one in elements], dtype=np.float64),
        fastest=np.array([FASTEST / max(*map(abs, each), 1e-12) for each in spins], dtype=np.float64),
        shapes=np.array(shapes, dtype=np.float64).reshape(count, 7),
        rib_normals=normals,
        rib_numbers=numbers,
        rib_outer=rib_outer,
        rib_counts=rib_counts,
        laws=np.array([force.laws[:4] for force in forces], dtype=np.float64).reshape(count, 4),
        loads=np.array(
            [force.speed_loads(*each[:2]) for force, each in zip(forces, spins, strict=True)], dtype=np.float64
        ).reshape(count, 2),
        levers=levers,
        profiles=profiles,
        cos=cos,
        sin=sin,
        starting=np.full((count, most, 3), np.nan),
        rows=np.zeros((count, most, COLUMNS)),
        powers=np.zeros((count, 2)),
        last=np.zeros((count, most, 4)),
        times=np.zeros(count),
        works=np.zeros(count),
        work=roller_work(MOST_RIBS),
        rooms=np.zeros((3, 6)),
        matrices=np.zeros((2, 6, 6)),
        films=film_tables(laws, NODES, relaxes=False),
        course=course_of(0, len(laws)),
    )


def _feels(element: TaperedElement) -> FloatArray:
    """Rows of what a bearing feels of its port."""
    return np.asarray(np.eye(6)[FELT])


TAPERED = Kind(
    arrays=Tapered,
    answer=tapered_answer,
    feels=_feels,
    gather=TaperedBlock,
    accept=tapered_accept,
    powers=tapered_powers,
    rare=True,
)
"""For `mbs.transient.kinds`."""
