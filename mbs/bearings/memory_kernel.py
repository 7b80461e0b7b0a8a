"""Slices whose films have a memory, in compiled code: one time step of all slices of a bearing.

The law is that of `ehdmaps.maps.kernels.memory_table`. Each slice carries parabolas of p, y and G around a state and of
a around a load; they stand for the cubics of its cells, from which they differ in third order, and are read anew where
the slice leaves their reach, and every few steps, as the law follows the speed (`mbs.bearings.speed_tables`). So
Newton's method for the states is arithmetic alone, in vector instructions over all slices. A slice that leaves them
within a step is solved from the table itself, with a bracket. Tables of the law over the speed are as those of
`mbs.bearings.speed_tables`.

A step is `begin`, `loads` as often as the system asks for them, and `commit`.

The first question at the end of a new step begins it, with the states of the last step that was made, here or in
Python. Questions at other motions, and steps that are tried again with another length, leave these alone. Tables over
the speed are mixed as often as slices read them, see `Course.kept`.
"""

from __future__ import annotations

import contextlib
import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.copies import put
from ehdmaps.errors import EhdmapsError
from ehdmaps.maps.kernels.lines import FAST
from ehdmaps.maps.kernels.memory import FilmState, spent_by
from ehdmaps.maps.kernels.memory_table import (
    LIGHTEST,
    LOAD_ROWS,
    ROWS,
    MemoryTable,
    Step,
    advanced,
    equilibrium_at,
    fading_of,
    load_cell,
    rate_of,
    state_cell,
)
from ehdmaps.maps.kernels.tables import LOAD_TOLERANCE
from ehdmaps.maps.law import ContactLaw
from mbs.bearings.speed_tables import Course, Made, SpeedWindow
from mbs.model.blocks import Moment

STEP = 4e-3
"""Distance of the nodes in ln of the speed: the straight blend between two is right to some 1e-6 of the load."""

NODES = 8
"""How many tables are held."""

_ROUND_OFF = 1e-12

CENTRE, INVERSE_SCALE, LIFT_OFF, HIGHEST = range(4)
"""Numbers of a table: as of `MemoryTable`, and the load above which slices are counted [N/m]."""


class MemoryFilms(NamedTuple):
    """Tables of the laws at nodes over the speed, and the tables in use.

    Attributes
    ----------
    cells, load_cells, numbers : array (films, NODES, 2 ROWS, 12), (films, NODES, LOAD_ROWS, 4), (films, NODES, 4)
        Tables, as of `ehdmaps.maps.kernels.memory_table`.
    mixed_cells, mixed_load_cells, mixed : array (films, 2 ROWS, 12), (films, LOAD_ROWS, 4), (films, 4)
        The table in use.
    in_use : array (films, 2)
        Node and weight of those; negative for none.
    """

    cells: FloatArray
    load_cells: FloatArray
    numbers: FloatArray
    mixed_cells: FloatArray
    mixed_load_cells: FloatArray
    mixed: FloatArray
    in_use: FloatArray


def room(films: int) -> MemoryFilms:
    """Room for the tables of so many laws."""
    return MemoryFilms(
        cells=np.zeros((films, NODES, 2 * ROWS, 12)),
        load_cells=np.zeros((films, NODES, LOAD_ROWS, 4)),
        numbers=np.zeros((films, NODES, 4)),
        mixed_cells=np.zeros((films, 2 * ROWS, 12)),
        mixed_load_cells=np.zeros((films, LOAD_ROWS, 4)),
        mixed=np.zeros((films, 4)),
        in_use=np.full((films, 2), -1.0),
    )


@njit(error_model="numpy", fastmath=FAST)
def mix(films: MemoryFilms, film: int, node: int, weight: float) -> None:
    """Bring the table in use to a place between two nodes, straight in ln of the speed.

    Parameters
    ----------
    films : MemoryFilms
        Tables over the speed; those in use are written.
    film : int
        Index of the law.
    node : int
        The lower node.
    weight : float
        Weight of the upper node, 0 to 1.
    """
    if films.in_use[film, 0] == node and films.in_use[film, 1] == weight:
        return
    films.in_use[film, 0], films.in_use[film, 1] = node, weight
    other = (node + 1) % films.numbers.shape[1] if weight > 0.0 else node
    _straight(films.cells[film, node].reshape(-1), films.cells[film, other].reshape(-1), weight,
              films.mixed_cells[film].reshape(-1))  # fmt: skip
    _straight(films.load_cells[film, node].reshape(-1), films.load_cells[film, other].reshape(-1), weight,
              films.mixed_load_cells[film].reshape(-1))  # fmt: skip
    _straight(films.numbers[film, node], films.numbers[film, other], weight, films.mixed[film])


@njit(error_model="numpy", fastmath=FAST)
def _straight(low: FloatArray, high: FloatArray, weight: float, out: FloatArray) -> None:
    """Straight between two arrays."""
    for i in range(out.size):
        out[i] = low[i] + weight * (high[i] - low[i])


@njit(error_model="numpy")
def table_in_use(films: MemoryFilms, film: int) -> MemoryTable:
    """The table in use.

    Parameters
    ----------
    films : MemoryFilms
        Tables over the speed.
    film : int
        Index of the law.
    """
    numbers = films.mixed[film]
    return MemoryTable(
        films.mixed_cells[film],
        films.mixed_load_cells[film],
        numbers[CENTRE],
        numbers[INVERSE_SCALE],
        numbers[LIFT_OFF],
    )


class MemoryTables:
    """Tables of one law at one temperature, for a window of speeds.

    Parameters
    ----------
    law : ContactLaw
        The law of a roller between both raceways; all bearings with the same one, the same temperature and rate share
        the tables.
    temperature : float
        [K].
    rate : float
        Entrainment speed for each speed of the system [m/rad].
    """

    def __init__(self, law: ContactLaw, temperature: float, rate: float) -> None:
        self._law, self._temperature, self._rate = law, temperature, rate
        self._window = SpeedWindow(STEP, NODES, law.plain_table.lowest_speed / abs(rate) if rate else 1.0)

    def places(self, speeds: FloatArray) -> tuple[IntArray, FloatArray]:
        """Nodes and weights of speeds [rad/s], see `SpeedWindow.places`."""
        return self._window.places(speeds)

    def prepare(
        self, speeds: FloatArray, nodes: IntArray, weights: FloatArray, films: MemoryFilms, film: int
    ) -> tuple[IntArray, BoolArray, IntArray]:
        """Make the tables for the first of some speeds, see `SpeedWindow.prepare`.

        Parameters
        ----------
        speeds : array (n,)
            Speeds [rad/s].
        nodes, weights : array (n,)
            Nodes and weights from `places`.
        films : MemoryFilms
            Room for the tables.
        film : int
            Index of this law there.
        """

        def make(slot: int, speed: float, _: bool) -> Made:
            return self._made(slot, speed, films, film)

        return self._window.prepare(speeds, nodes, weights, make, self._ahead)

    def _ahead(self, speeds: FloatArray) -> None:
        """Have what costs most made for many speeds [rad/s] at once."""
        with contextlib.suppress(EhdmapsError):  # the step that asks for it will be told why
            at = np.array([self._entrainment(speed) for speed in speeds.tolist()])
            self._law.make_locked_factors(at, self._temperature)

    def _entrainment(self, speed: float) -> float:
        """Entrainment speed of a node [m/s]: the one at the lowest speed has its whole film, whatever the rounding."""
        lowest, u = self._law.plain_table.lowest_speed, abs(self._rate * speed)
        return lowest if abs(u - lowest) < _ROUND_OFF * lowest else u

    def _made(self, slot: int, speed: float, films: MemoryFilms, film: int) -> Made:
        """Make the table of a speed."""
        before = dict(self._law.outside_counts)
        try:
            at = self._law.at(self._entrainment(speed), self._temperature)
            table = at.memory.table
        except EhdmapsError:
            return Made(sound=False)  # the step that asks for it will be told why
        films.cells[film, slot], films.load_cells[film, slot] = table.cells, table.load_cells
        highest = at.point.highest_load * (1.0 + LOAD_TOLERANCE)
        films.numbers[film, slot] = table.centre, table.inverse_scale, table.lift_off, highest
        return Made(sound=True, outside=self._law.outside_counts != before)


LATEST, BEFORE, CHANGE, FADE, LOAD, TRIAL, AROUND, REACH, LOADED, LOAD_REACH = range(10)
P, Y, G, A = 10, 13, 16, 19
MEMORY = 22
"""Rows of the memory of the slices: states after the last two steps, change of G over the last one and `fading_of` it,
load after it; state of the trial; where the parabolas lie and how far they reach, in the state and in the load;
parabolas. G counts from the last state."""

_PART = 2.0**-6
"""How far a parabola reaches, as a part of the distance from the centre of the table: a cell or less."""

_LOAD_PART = 2.0**-4
_TOLERANCE = 3e-7
_SMALL = 30.0
"""A slice has its state when the last move changed its load by less than `_TOLERANCE` of the load and this [N/m]: what
is left is the square, which has to lie below what the equations of motion are solved to."""

_ROUNDS = 12
_LEAST = 1e-30


@njit(error_model="numpy")
def resume(approach: FloatArray, change: FloatArray, load: FloatArray, memory: FloatArray) -> None:
    """Go on from states, as of `ehdmaps.maps.kernels.memory.FilmState`.

    Parameters
    ----------
    approach, change, load : array (n,)
        Approach at which each film would be in equilibrium [m], what the last step changed in G [N s/m2], and the load
        after it [N/m].
    memory : array (MEMORY, n)
        Memory of the slices; written. Parabolas are read at the next step.
    """
    memory[:] = 0.0
    for i in range(approach.size):
        memory[LATEST, i] = memory[BEFORE, i] = memory[TRIAL, i] = approach[i]
        memory[CHANGE, i], memory[FADE, i] = change[i], fading_of(change[i])
        memory[LOAD, i], memory[AROUND, i] = load[i], math.inf


@njit(error_model="numpy", fastmath=FAST)
def begin(table: MemoryTable, growth: float, count: int, kept: int, memory: FloatArray) -> None:
    """Begin a step.

    Parameters
    ----------
    table : MemoryTable
        The law at the end of the step.
    growth : float
        Length of the step by that of the last one; 0 at the first.
    count : int
        Number of the step.
    kept : int
        Steps for which parabolas are kept at most.
    memory : array (MEMORY, n)
        Memory of the slices; states are foretold, parabolas read where they are used up.
    """
    latest, before, trial, load = memory[LATEST], memory[BEFORE], memory[TRIAL], memory[LOAD]
    around, reach, loaded, load_reach = memory[AROUND], memory[REACH], memory[LOADED], memory[LOAD_REACH]
    lowest = table.lift_off
    for i in range(latest.size):
        guess = latest[i] + growth * (latest[i] - before[i])
        trial[i] = guess if guess > lowest else lowest
    for i in range(latest.size):
        moved, more = abs(trial[i] - around[i]), abs(load[i] - loaded[i])
        if 2.0 * moved > reach[i] or 2.0 * more > load_reach[i] or (count + i) % kept == 0:
            _read(table, memory, i)


@njit(error_model="numpy", fastmath=FAST)
def _read(table: MemoryTable, memory: FloatArray, i: int) -> None:
    """Parabolas of a slice around the state of the trial and the last load."""
    per, per_load = table.inverse_scale, 1.0 / LIGHTEST
    xi, load = memory[TRIAL, i], memory[LOAD, i]
    row, t = state_cell(table, xi)
    c = table.cells[row]
    reach = _PART / per * (1.0 + abs((xi - table.centre) * per))
    memory[AROUND, i], memory[REACH, i] = xi, reach
    memory[P, i] = c[0] + t * (c[1] + t * (c[2] + t * c[3]))
    memory[P + 1, i] = (c[1] + t * (2.0 * c[2] + 3.0 * t * c[3])) * per
    memory[P + 2, i] = (c[2] + 3.0 * t * c[3]) * per * per
    memory[Y, i] = c[4] + t * (c[5] + t * (c[6] + t * c[7]))
    memory[Y + 1, i] = (c[5] + t * (2.0 * c[6] + 3.0 * t * c[7])) * per
    memory[Y + 2, i] = (c[6] + 3.0 * t * c[7]) * per * per
    slope = (c[9] + t * (2.0 * c[10] + 3.0 * t * c[11])) * per
    bend = (c[10] + 3.0 * t * c[11]) * per * per
    ahead = xi - memory[LATEST, i]
    if abs(ahead) <= reach:
        change = ahead * (slope - ahead * bend)
    else:
        change = c[8] + t * (c[9] + t * (c[10] + t * c[11])) - equilibrium_at(table, memory[LATEST, i])[4]
    memory[G, i], memory[G + 1, i], memory[G + 2, i] = change, slope, bend
    row, t = load_cell(load)
    c = table.load_cells[row]
    slope = (c[1] + t * (2.0 * c[2] + 3.0 * t * c[3])) * per_load
    memory[LOADED, i] = load
    memory[A, i] = c[0] + t * (c[1] + t * (c[2] + t * c[3]))
    memory[A + 1, i], memory[A + 2, i] = slope, (c[2] + 3.0 * t * c[3]) * per_load * per_load
    # the structure matters the less, the softer the film is beside it
    memory[LOAD_REACH, i] = _LOAD_PART * (load + LIGHTEST) / math.sqrt(slope * memory[P + 1, i] + _LEAST)


@njit(error_model="numpy", fastmath=FAST)
def _round(step: Step, memory: FloatArray, delta: FloatArray, load: FloatArray, tangent: FloatArray) -> float:
    """A Newton step for the states of all slices, with loads and tangents there; how many still move."""
    trial, around, change, fading, loaded = memory[TRIAL], memory[AROUND], memory[CHANGE], memory[FADE], memory[LOADED]
    p0, p1, p2 = memory[P], memory[P + 1], memory[P + 2]
    y0, y1, y2 = memory[Y], memory[Y + 1], memory[Y + 2]
    g0, g1, g2 = memory[G], memory[G + 1], memory[G + 2]
    a0, a1, a2 = memory[A], memory[A + 1], memory[A + 2]
    left = 0.0
    for i in range(delta.size):
        s = trial[i] - around[i]
        p, dp = p0[i] + s * (p1[i] + s * p2[i]), p1[i] + 2.0 * s * p2[i]
        y, dy = y0[i] + s * (y1[i] + s * y2[i]), y1[i] + 2.0 * s * y2[i]
        g, dg = g0[i] + s * (g1[i] + s * g2[i]), g1[i] + 2.0 * s * g2[i]
        x, dx = rate_of(step, g, change[i], fading[i])
        root = math.sqrt(x * x + p * p + _LEAST)
        w = x + root
        slope = (w * dx * dg + p * dp) / root
        v = w - loaded[i]
        a, compliance = a0[i] + v * (a1[i] + v * a2[i]), a1[i] + 2.0 * v * a2[i]
        stiff = slope / (compliance * slope + dy)
        gained = (delta[i] - a - y) * stiff
        trial[i] += gained / slope
        load[i] = w + gained
        tangent[i] = stiff
        left += 1.0 if abs(gained) > _TOLERANCE * (w + _SMALL) else 0.0
    return left


@njit(error_model="numpy")
def _unsettled(step: Step, memory: FloatArray, delta: FloatArray, load: FloatArray, tangent: FloatArray) -> None:
    """Give the slices that Newton's steps on parabolas do not settle to the table, whose steps have a bracket.

    So it is where a film begins to carry within a step, as on an oil layer: its parabolas are flat on one side.
    """
    before = load.copy()
    _round(step, memory, delta, load, tangent)
    for i in range(load.size):
        if not abs(load[i] - before[i]) <= _TOLERANCE * (abs(load[i]) + _SMALL):
            memory[TRIAL, i] = math.inf


@njit(error_model="numpy", fastmath=FAST)
def loads(
    table: MemoryTable, step: Step, memory: FloatArray, delta: FloatArray, load: FloatArray, tangent: FloatArray
) -> None:
    """Loads of all slices at the end of a step, and their derivatives by the approach.

    Parameters
    ----------
    table : MemoryTable
        The law.
    step : Step
        How long.
    memory : array (MEMORY, n)
        Memory of the slices; the states of the trial are written.
    delta : array (n,)
        Approaches [m].
    load, tangent : array (n,)
        Written: [N/m], [N/m2].
    """
    left = 1.0
    for _ in range(_ROUNDS):
        left = _round(step, memory, delta, load, tangent)
        if left == 0.0:
            break
    if left > 0.0:
        _unsettled(step, memory, delta, load, tangent)
    trial, around, reach, loaded, load_reach = (
        memory[TRIAL],
        memory[AROUND],
        memory[REACH],
        memory[LOADED],
        memory[LOAD_REACH],
    )
    far = 0.0
    for i in range(delta.size):
        inside = (abs(trial[i] - around[i]) <= reach[i]) & (abs(load[i] - loaded[i]) <= load_reach[i])
        far += 0.0 if inside else 1.0
    if far == 0.0:
        return
    for i in range(delta.size):
        if not (abs(trial[i] - around[i]) <= reach[i] and abs(load[i] - loaded[i]) <= load_reach[i]):
            if delta[i] <= table.lift_off:
                # Out of contact, as many slices on an oil layer are: what the table would find.
                load[i], tangent[i], trial[i] = 0.0, 0.0, table.lift_off
                continue
            xi = memory[LATEST, i]
            before = equilibrium_at(table, xi)[4]
            load[i], tangent[i], trial[i] = advanced(table, step, delta[i], before, memory[CHANGE, i], xi)


@njit(error_model="numpy", fastmath=FAST)
def commit(table: MemoryTable, memory: FloatArray, load: FloatArray) -> None:
    """Make the step: the trial becomes the state.

    Parameters
    ----------
    table : MemoryTable
        The law.
    memory : array (MEMORY, n)
        Memory of the slices.
    load : array (n,)
        What `loads` found last [N/m].
    """
    trial, around, reach = memory[TRIAL], memory[AROUND], memory[REACH]
    latest, before, change, fading = memory[LATEST], memory[BEFORE], memory[CHANGE], memory[FADE]
    g0, g1, g2 = memory[G], memory[G + 1], memory[G + 2]
    far = 0.0
    for i in range(load.size):
        far += 0.0 if abs(trial[i] - around[i]) <= reach[i] else 1.0
    for i in range(load.size):
        s = trial[i] - around[i]
        g = g0[i] + s * (g1[i] + s * g2[i])
        change[i] = g
        g0[i] -= g
        fading[i] = fading_of(g)
    if far > 0.0:
        for i in range(load.size):
            if not abs(trial[i] - around[i]) <= reach[i]:
                change[i] = 0.0
                if trial[i] != latest[i]:
                    change[i] = equilibrium_at(table, trial[i])[4] - equilibrium_at(table, latest[i])[4]
                fading[i] = fading_of(change[i])
                around[i] = math.inf
    for i in range(load.size):
        before[i], latest[i] = latest[i], trial[i]
    put(load, memory[LOAD])


@njit(error_model="numpy", fastmath=FAST)
def spent(table: MemoryTable, memory: FloatArray, load: FloatArray, weights: FloatArray) -> float:
    """Energy that all films take up over a step, before `commit`, for each length of a slice [J/m].

    Parameters
    ----------
    table : MemoryTable
        The law.
    memory : array (MEMORY, Z n)
        Memory of the slices.
    load : array (Z n,)
        What `loads` found last [N/m].
    weights : array (n,)
        How many slices each slice of a roller stands for.
    """
    trial, latest, around, reach, last = memory[TRIAL], memory[LATEST], memory[AROUND], memory[REACH], memory[LOAD]
    p0, p1, p2, y1, y2 = memory[P], memory[P + 1], memory[P + 2], memory[Y + 1], memory[Y + 2]
    total = far = 0.0
    for first in range(0, load.size, weights.size):
        for k in range(weights.size):
            i = first + k
            s, t = trial[i] - around[i], latest[i] - around[i]
            near = (abs(s) <= reach[i]) & (abs(t) <= reach[i])
            s, t = (s if near else 0.0), (t if near else 0.0)
            rest = 2.0 * p0[i] + s * (p1[i] + s * p2[i]) + t * (p1[i] + t * p2[i])
            total += 0.5 * weights[k] * (load[i] + last[i] - rest) * (s - t) * (y1[i] + (s + t) * y2[i])
            far += 0.0 if near else 1.0
    if far > 0.0:
        for i in range(load.size):
            if not (abs(trial[i] - around[i]) <= reach[i] and abs(latest[i] - around[i]) <= reach[i]):
                total += weights[i % weights.size] * spent_by(table, latest[i], last[i], trial[i], load[i])
    return total


ACCEPTED, LAST, TRIED, STEPS = range(4)
"""Times of a run: end of the last step that was made [s]; its length [s], 0 if there was none; end of the step that is
tried [s], NaN before that is known; and how many were made."""


def new_clock() -> FloatArray:
    """Times of a run that has made no step, shape (4,)."""
    return np.array([math.nan, 0.0, math.nan, 0.0])


@njit(error_model="numpy")
def begin_step(clock: FloatArray, films: MemoryFilms, course: Course, moment: Moment) -> float:
    """Begin a step: its time, and the tables; the length of the step by that of the last one, 0 at the first.

    Parameters
    ----------
    clock : array (4,)
        Times of the run; written.
    films : MemoryFilms
        Tables of the laws; mixed anew where it is their turn.
    course : Course
        Places of the steps on them.
    moment : Moment
        The step.
    """
    clock[TRIED] = moment.time
    for film in range(films.in_use.shape[0]):
        if films.in_use[film, 0] < 0.0 or int(clock[STEPS]) % course.kept[moment.step] == 0:
            mix(films, film, course.nodes[moment.step, film], course.weights[moment.step, film])
    return (moment.time - clock[ACCEPTED]) / clock[LAST] if clock[LAST] > 0.0 else 0.0


@njit(error_model="numpy")
def make_step(clock: FloatArray, moment: Moment) -> None:
    """Count a step that is made.

    Parameters
    ----------
    clock : array (4,)
        Times of the run; written.
    moment : Moment
        The step.
    """
    clock[LAST] = moment.time - clock[ACCEPTED]
    clock[ACCEPTED] = moment.time
    clock[STEPS] += 1.0


def films_of_rows(rows: FloatArray, shape: tuple[int, int], last: float) -> FilmState:
    """Films of slices after a step, from their memory in compiled code.

    Parameters
    ----------
    rows : array (MEMORY, Z n)
        Memory of the slices, see `mbs.bearings.memory_kernel`.
    shape : (int, int)
        Rollers Z and slices n.
    last : float
        Length of the step [s].
    """
    approach, change, load = (rows[row].reshape(shape).copy() for row in (LATEST, CHANGE, LOAD))
    return FilmState(approach, change, load, last)


def resume_rows(films: FilmState, time: float, rows: FloatArray, clock: FloatArray) -> None:
    """Go on from films that Python has.

    Parameters
    ----------
    films : FilmState
        Films after the last step.
    time : float
        End of that step [s].
    rows : array (MEMORY, Z n)
        Memory of the slices in compiled code; written.
    clock : array (4,)
        Times of the run; written.
    """
    resume(films.approach.reshape(-1), films.change.reshape(-1), films.load.reshape(-1), rows)
    clock[: TRIED + 1] = time, films.step, math.nan
