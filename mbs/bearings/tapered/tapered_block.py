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
from mbs.bearings.balls.answers import LawBlock, answer_port, felt_rows, read_pose
from mbs.bearings.balls.film_tables import FilmLaws, FilmTables, blend, film_tables, law_of
from mbs.bearings.speed_tables import Course, course_of
from mbs.bearings.tapered.line_film import NODES
from mbs.bearings.tapered.tapered_bearing import FASTEST, TaperedForce
from mbs.bearings.tapered.tapered_element import TaperedElement
from mbs.bearings.tapered.tapered_energy import TaperedStates, dry_energy, place_work
from mbs.bearings.tapered.tapered_kernel import (
    COLUMNS,
    MOST_RIBS,
    TOO_FAR,
    Ribs,
    RollerLaws,
    RollerWork,
    TaperedShape,
    roller_work,
    tapered_force,
)
from mbs.bearings.tapered.tapered_memory import (
    MEMORY,
    FilmsOfRollers,
    SpringTables,
    go_on_rollers,
    hold_rollers,
    no_memory,
)
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Kind, Member, Moment


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
    relaxes : array (bearings,), of bool
        Whether films have a memory.
    memory : array (bearings, Z, 2, MEMORY, slices)
        Memory of the slices of cone and cup, see `mbs.bearings.tapered.tapered_memory`; no slices without.
    clock : array (2,)
        Times at the end of the last step that was made, and of the step for which slices hold [s].
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
    relaxes: BoolArray
    memory: FloatArray
    clock: FloatArray
    rooms: FloatArray
    matrices: FloatArray
    films: FilmTables
    course: Course


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _shape_of(tapered: Tapered, b: int) -> TaperedShape:
    """Lengths of a bearing."""
    s, z, n = tapered.shapes[b], tapered.counts[b], tapered.slices[b]
    m, numbers = tapered.rib_counts[b], tapered.rib_numbers[b]
    ribs = Ribs(
        tapered.rib_normals[b, :m], numbers[0, :m], numbers[1, :m], numbers[2, :m], tapered.rib_outer[b, :m]
    )  # fmt: skip
    return TaperedShape(
        s[0], (s[1], s[2]), (s[3], s[4]), ribs, tapered.levers[b, :n], tapered.profiles[b, :n],
        tapered.cos[b, :z], tapered.sin[b, :z], s[5], s[6],
    )  # fmt: skip


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _laws_of(tapered: Tapered, b: int) -> RollerLaws:
    """Laws of a bearing at the speed of the step."""
    c, film = tapered.laws[b], tapered.films_of[b]
    cone, cup = law_of(tapered.films, film, 0), law_of(tapered.films, film, 1)
    return RollerLaws(c[0], c[1], c[2], c[3], cup, cone, tapered.relaxes[b])


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _springs_of(films: FilmTables, film: int) -> SpringTables:
    """Springs of films with memory at the speed of the step."""
    node, weight = int(films.in_use[film, 0]), films.in_use[film, 1]
    other = (node + 1) % films.numbers.shape[1] if weight > 0.0 else node
    slow, fast = films.springs[film, node], films.springs[film, other]
    return SpringTables(slow[0], fast[0], slow[1], fast[1], weight)


@njit(error_model="numpy", _nrt=False)
def _on_ring(tapered: Tapered, b: int, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Write the answer of a bearing; status as of `tapered_force`."""
    i, z = tapered.firsts[b], tapered.counts[b]
    pose, loads, force = tapered.rooms[0], tapered.rooms[1], tapered.rooms[2]
    stiffness, damping = tapered.matrices[0], tapered.matrices[1]
    read_pose(i, tapered.offsets[b], motion, pose)
    if not abs(moment.speed) <= tapered.fastest[b]:
        return TOO_FAR
    shape, laws = _shape_of(tapered, b), _laws_of(tapered, b)
    square = moment.speed * moment.speed
    loads[0], loads[1], loads[2] = 0.0, tapered.loads[b, 0] * square, tapered.loads[b, 1] * square
    angle = tapered.starts[b] + tapered.turns[b] * moment.angle
    starting, rows = tapered.starting[b, :z], tapered.rows[b, :z]
    found: int = tapered_force(
        pose, angle, loads, shape, laws, tapered.memory[b], force, stiffness, damping, starting, rows, tapered.work
    )
    if found < 0:
        starting[:] = math.nan
        return found
    answer_port(i, tapered.turns[b], moment, motion, pose, force, tapered.matrices, answers, tapered.powers[b])
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
    if tapered.clock[1] != moment.time:
        tapered.clock[1] = moment.time
        for b in range(tapered.firsts.size):
            if tapered.relaxes[b]:
                hold_rollers(moment.time - tapered.clock[0], tapered.counts[b], tapered.memory[b])
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
    """Take note of a step that was made: places of the rollers for the work of their loads, films with memory.

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
        if tapered.relaxes[b]:
            springs = _springs_of(tapered.films, tapered.films_of[b])
            go_on_rollers(tapered.rows[b], _shape_of(tapered, b), _laws_of(tapered, b), springs, tapered.memory[b])
    tapered.clock[0], tapered.clock[1] = moment.time, math.nan


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


class TaperedBlock(LawBlock[Tapered]):
    """The tapered roller bearings of a run; see `mbs.model.blocks.StatefulBlock`.

    Parameters
    ----------
    members : sequence of Member
        Bearings of the class `TaperedElement`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        self._elements: list[TaperedElement] = [member.element for member in members]
        super().__init__(self._elements, NODES, lambda films_of, laws: _gather(members, films_of, laws))

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
                films=FilmsOfRollers(self._memory(b).copy()) if arrays.relaxes[b] else None,
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
            self._arrays.clock[:] = one.time, math.nan
            if self._arrays.relaxes[b]:
                memory = self._memory(b)
                memory[:] = one.films.memory if one.films else no_memory(memory.shape[0], memory.shape[-1])

    def _memory(self, b: int) -> FloatArray:
        """Memory of the slices of a bearing."""
        arrays = self._arrays
        return arrays.memory[b, : arrays.counts[b], ..., : arrays.slices[b]]


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
    relaxes = np.array([one.relaxes for one in elements], dtype=np.bool_)
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
        work=roller_work(MOST_RIBS, longest),
        relaxes=relaxes,
        memory=np.zeros((count, most, 2, MEMORY, longest if relaxes.any() else 0)),
        clock=np.array([0.0, math.nan]),
        rooms=np.zeros((3, 6)),
        matrices=np.zeros((2, 6, 6)),
        films=film_tables(laws, NODES, 2 if relaxes.any() else 0),
        course=course_of(0, len(laws)),
    )


TAPERED = Kind(
    arrays=Tapered,
    answer=tapered_answer,
    feels=felt_rows,
    gather=TaperedBlock,
    accept=tapered_accept,
    powers=tapered_powers,
    rare=True,
)
"""For `mbs.transient.kinds`."""
