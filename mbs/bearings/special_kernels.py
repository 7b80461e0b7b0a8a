"""The bearing force in compiled code where one prepared law does not do: coupled slices, conditions that change.

Coupled slices
--------------
The raceways overlap by a_i at slice i, of which the law takes s_i; the rest is what all slices of the roller press
away at i, see `ehdmaps.solids.slices`:

    s = a - C w(s)

Newton's method finds s for each roller at rest, by a Cholesky factor of 1 + sqrt(k) C sqrt(k), k the slopes of the law.
Stiffness and damping follow from the same factor: with B = d a/d pose and G = (1 + C k)^-1,

    K = B^T k G B,    c = (G B)^T c (G B)

The rate of s is G times that of a, as for motion slow against the films; the change of G with the pose is left out of
the stiffness of a bearing in motion, and at rest nothing is.

Changing conditions
-------------------
Speed, temperature and centrifugal load may change from call to call. A whole table of the law costs as much as ten
bearing forces, or a hundred with a centrifugal load; the slices of a bearing lie in a tenth of its cells. So the law is
collapsed at its new conditions, and only those cells are made where slices are. As long as the conditions stay, later
calls make what is still missing.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ehdmaps.arrays import ByteArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.kernel import collapse, evaluate_at
from ehdmaps.maps.kernels.lines import unilateral_force
from ehdmaps.maps.kernels.tables import FIRST, LOAD, SHIFT
from mbs.bearings.bearing_kernel import Plane, added, assemble, write_plane
from mbs.bearings.laws import FlatTable, counted_load, law_table
from mbs.bearings.slice_table import (
    CELLS,
    LAST,
    ROWS,
    LawNumbers,
    PreparedLaw,
    all_made,
    fill,
    is_placed,
    law_numbers,
    place_numbers,
    read_cells,
    store_numbers,
)
from mbs.bearings.slices import (
    NOT_FINITE,
    Shape,
    Work,
    all_finite,
    check_motion,
    find_cells,
    power,
    read_states,
    ring_motion,
    roller_of,
    sizes_of,
)

NO_LOADS = -3
"""What is returned where a roller has no loads: contacts are wider than the coupling was made for."""

_MOST_STEPS, _MOST_HALVINGS = 60, 8
_CLOSE = 1e-10
_SCALE = 1e-9
"""Approaches are found to `_CLOSE` of themselves and of this [m]."""

_WEAK = 1e-4
"""Product of coupling and slope below which one step of a series is exact to its square."""


@njit(error_model="numpy")
def _read_law(
    point: Any,
    numbers: LawNumbers,
    cells: FloatArray,
    own: FloatArray,
    rows: IntArray,
    states: FloatArray,
    counts: IntArray,
) -> None:
    """States (4, n) of slices at rest, with whole slopes, by the approaches that the law takes."""
    w, dw, c, dc = states[0], states[1], states[2], states[3]
    if point is not None:
        for i in range(own.size):
            w[i], dw[i], c[i] = evaluate_at(point, own[i], 0.0, counts)
            dc[i] = 0.0
        return
    if numbers.kind == CELLS:
        for i in range(own.size):
            z = (own[i] - numbers.centre) * numbers.inverse_scale
            a = 1.0 + abs(z)
            a = a if a < LAST else LAST
            cell = np.uint64(np.float64(a).view(np.uint64) >> SHIFT)
            t = a - np.uint64(cell << SHIFT).view(np.float64)
            w[i] = t if z >= 0.0 else -t
            rows[i] = np.int64(cell) - FIRST + (0 if z >= 0.0 else ROWS)
        read_cells(cells, rows, states)
        for i in range(own.size):
            dw[i] *= numbers.slope
            dc[i] *= numbers.slope
        return
    for i in range(own.size):
        w[i] = dw[i] = c[i] = dc[i] = 0.0
        if own[i] > 0.0:
            dw[i] = numbers.coefficient * numbers.exponent * power(own[i], numbers.exponent - 1.0)
            w[i] = dw[i] * own[i] / numbers.exponent
            c[i] = numbers.damping + numbers.damping_time * dw[i]
            dc[i] = numbers.damping_time * (numbers.exponent - 1.0) * dw[i] / own[i]


@njit(error_model="numpy")
def _factor(coupling: FloatArray, root: FloatArray, out: FloatArray) -> bool:
    """Cholesky factor of 1 + root C root, in the lower half; False where there is none."""
    for i in range(root.size):
        for k in range(i + 1):
            total = coupling[i, k] * root[i] * root[k]
            if i == k:
                total += 1.0
            for m in range(k):
                total -= out[i, m] * out[k, m]
            if i > k:
                out[i, k] = total / out[k, k]
            elif total > 0.0:
                out[i, i] = math.sqrt(total)
            else:
                return False
    return True


@njit(error_model="numpy")
def _relieved(
    coupling: FloatArray, root: FloatArray, factor: FloatArray, weak: bool, given: FloatArray, out: FloatArray
) -> None:
    """(1 + C k)^-1 times a vector, k = root^2, by the factor; by its series where that is as good."""
    size = given.size
    if weak:
        for i in range(size):
            total = given[i]
            for m in range(size):
                total -= coupling[i, m] * root[m] * root[m] * given[m]
            out[i] = total
        return
    held = np.empty(size)
    for i in range(size):
        total = root[i] * given[i]
        for m in range(i):
            total -= factor[i, m] * held[m]
        held[i] = total / factor[i, i]
    for i in range(size - 1, -1, -1):
        total = held[i]
        for m in range(i + 1, size):
            total -= factor[m, i] * held[m]
        held[i] = total / factor[i, i]
    for i in range(size):
        held[i] *= root[i]
    for i in range(size):
        total = given[i]
        for m in range(size):
            total -= coupling[i, m] * held[m]
        out[i] = total


@njit(error_model="numpy")
def _left(overlap: FloatArray, own: FloatArray, coupling: FloatArray, w: FloatArray, out: FloatArray) -> float:
    """Find what approaches miss, overlap - own - C w, and the largest of it."""
    largest = 0.0
    for i in range(own.size):
        total = overlap[i] - own[i]
        for m in range(own.size):
            total -= coupling[i, m] * w[m]
        out[i] = total
        largest = max(largest, abs(total))
    return largest


@njit(error_model="numpy")
def _settle(
    point: Any,
    numbers: LawNumbers,
    cells: FloatArray,
    coupling: FloatArray,
    overlap: FloatArray,
    own: FloatArray,
    rows: IntArray,
    states: FloatArray,
    root: FloatArray,
    factor: FloatArray,
    counts: IntArray,
) -> int:
    """Approaches that the law takes, into `own`, with states, roots of the slopes and factor.

    It returns 0, or 1 where the coupling is weak and there is no factor, or `NO_LOADS`.
    """
    size = overlap.size
    left, step, tried = np.empty(size), np.empty(size), np.empty(size)
    strength = 0.0
    for i in range(size):
        total = 0.0
        for m in range(size):
            total += abs(coupling[i, m])
        strength = max(strength, total)
        own[i] = overlap[i]
    _read_law(point, numbers, cells, own, rows, states, counts)
    missing = _left(overlap, own, coupling, states[0], left)
    for _ in range(_MOST_STEPS):
        stiffest = largest = 0.0
        for i in range(size):
            root[i] = math.sqrt(max(states[1, i], 0.0))
            stiffest = max(stiffest, states[1, i])
            largest = max(largest, abs(own[i]))
        weak = stiffest * strength < _WEAK
        if not weak and not _factor(coupling, root, factor):
            return NO_LOADS
        if missing <= _CLOSE * (largest + _SCALE):
            return 1 if weak else 0
        _relieved(coupling, root, factor, weak, left, step)
        share, before = 1.0, missing
        for i in range(size):
            tried[i] = own[i]
        for _ in range(_MOST_HALVINGS):
            for i in range(size):
                own[i] = tried[i] + share * step[i]
            _read_law(point, numbers, cells, own, rows, states, counts)
            missing = _left(overlap, own, coupling, states[0], left)
            if missing < before:
                break
            share *= 0.5
    return NO_LOADS


@njit(error_model="numpy")
def coupled_arrays(
    point: Any,
    state: FloatArray,
    sizes: FloatArray,
    slices: FloatArray,
    angles: FloatArray,
    numbers: FloatArray,
    cells: FloatArray,
    rows: IntArray,
    states: FloatArray,
    coupling: FloatArray,
    own: FloatArray,
    counts: IntArray,
    out: FloatArray,
) -> int:
    """`mbs.bearings.bearing_kernel.force_of_arrays` with slices that know of their neighbours.

    Parameters
    ----------
    point : Point or None
        The law where no table holds it.
    state, sizes, slices, angles, numbers, cells, rows, states
        The same as there; states are those of the slices at rest.
    coupling : array (n, n)
        Compliances between slices, of both contacts together [m2/N].
    own : array (Z, n)
        Approaches that the law takes, written [m].
    counts : array (4,), of int
        Numbers of calls of `point` outside the map, counted up.
    out : array (13, 6)
        Force, six rows of stiffness, six rows of damping.

    Returns
    -------
    int
        A code as of `bearing_force`, or `NO_LOADS`.
    """
    if not all_finite(state):
        return -1
    shape, law, motion = (
        Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1]),
        law_numbers(numbers),
        ring_motion(state),
    )
    wrong = check_motion(motion, shape.sizes)
    if wrong != 0:
        return wrong
    before = counts[LOAD]
    x, size = shape.positions, shape.positions.size
    ones, overlap, root = np.ones(size), np.empty(size), np.empty(size)
    factor, flat, tilted = np.empty((size, size)), np.empty(size), np.empty(size)
    above = 0
    y = z = a = b = 0.0
    stiffness = damping = Plane(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        for i in range(size):
            overlap[i] = roller.gap + x[i] * roller.tilt - shape.profile[i]
        here = states[:, j]
        if roller.deepest <= law.lift_off:
            for i in range(size):
                own[j, i] = overlap[i]
                here[0, i] = here[1, i] = here[2, i] = here[3, i] = 0.0
            continue
        code = _settle(point, law, cells, coupling, overlap, own[j], rows[j], here, root, factor, counts)
        if code < 0:
            return code
        _relieved(coupling, root, factor, code == 1, ones, flat)
        _relieved(coupling, root, factor, code == 1, x, tilted)
        load = moment = k0 = k1 = k2 = c0 = c1 = c2 = 0.0
        for i in range(size):
            rest, slope, highest = here[0, i], here[1, i], here[0, i]
            moving, stiff, resists = unilateral_force(
                rest, slope, here[2, i], here[3, i], flat[i] * roller.rate + tilted[i] * roller.tilt_rate
            )
            more, stiffer = moving - rest, stiff - slope
            load += rest + flat[i] * more
            moment += rest * x[i] + tilted[i] * more
            k0 += slope * flat[i] + stiffer * flat[i] * flat[i]
            k1 += slope * flat[i] * x[i] + stiffer * flat[i] * tilted[i]
            k2 += slope * tilted[i] * x[i] + stiffer * tilted[i] * tilted[i]
            c0 += resists * flat[i] * flat[i]
            c1 += resists * flat[i] * tilted[i]
            c2 += resists * tilted[i] * tilted[i]
            if point is None and highest > law.highest:
                above += 1
        y -= roller.cos * load
        z -= roller.sin * load
        a += roller.sin * moment
        b -= roller.cos * moment
        stiffness = added(stiffness, roller, k0, k1, k2)
        damping = added(damping, roller, c0, c1, c2)
    length = shape.sizes.slice_length
    out[0, 0] = out[0, 3] = 0.0
    out[0, 1], out[0, 2], out[0, 4], out[0, 5] = y * length, z * length, a * length, b * length
    write_plane(stiffness, length, out[1:7])
    write_plane(damping, length, out[7:13])
    return 1 if above > 0 or counts[LOAD] > before else 0


NO_TABLE, CELLS_MISSING = -4, -5
"""Status where no table fits the law, and where slices are in cells that are not made yet."""


@njit(error_model="numpy")
def changed_force(
    law: FlatTable,
    workspace: FloatArray,
    conditions: FloatArray,
    nodes: FloatArray,
    counts: IntArray,
    marks: ByteArray,
    state: FloatArray,
    sizes: FloatArray,
    slices: FloatArray,
    angles: FloatArray,
    numbers: FloatArray,
    cells: FloatArray,
    knots: FloatArray,
    rows: IntArray,
    states: FloatArray,
    out: FloatArray,
) -> int:
    """Force, stiffness and damping at new conditions, or where `remade_force` misses cells.

    Parameters
    ----------
    law, workspace
        The same as for `mbs.bearings.laws.tabulate_law`.
    conditions : array (4,)
        u [m/s], at which the whole film is there, T [K], q [N/m], within the map; and zero where they are new, one
        after the first call that has an answer.
    nodes : array (4, NODES)
        Work space of `mbs.bearings.slice_table.fill`, kept from call to call.
    counts : array (4,)
        int64, for the law to count in.
    marks, state, sizes, slices, angles, numbers, cells, knots, rows, states, out
        The same as for `remade_force`.

    Returns
    -------
    int
        Status of `bearing_force`, or `NO_TABLE`.
    """
    if not all_finite(state):
        return NOT_FINITE
    shape = Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1])
    motion = ring_motion(state)
    wrong: int = check_motion(motion, shape.sizes)
    if wrong != 0:
        return wrong
    point = collapse(law_table(law), workspace, conditions[0], conditions[1], conditions[2], counts)
    if conditions[3] == 0.0:
        placed = place_numbers(point, counted_load(point))
        if not is_placed(placed):
            return NO_TABLE
        store_numbers(placed, numbers)
        marks[:] = 0
        conditions[3] = 1.0
    prepared = PreparedLaw(law_numbers(numbers), cells, knots)
    find_cells(motion, shape, prepared.numbers, rows, states[0])
    fill(point, prepared.numbers, rows.reshape(-1), nodes, marks, cells)
    read_states(motion, shape, prepared, Work(rows, states))
    return 1 if assemble(motion, shape, prepared.numbers, states, out) > 0 else 0


@njit(error_model="numpy")
def remade_force(
    marks: ByteArray,
    state: FloatArray,
    sizes: FloatArray,
    slices: FloatArray,
    angles: FloatArray,
    numbers: FloatArray,
    cells: FloatArray,
    knots: FloatArray,
    rows: IntArray,
    states: FloatArray,
    out: FloatArray,
) -> int:
    """Force, stiffness and damping at the conditions of the call before.

    Parameters
    ----------
    marks : array (2, NODES), of uint8
        Work space of `mbs.bearings.slice_table.fill`: which cells are made.
    state, sizes, slices, angles, numbers, cells, knots, rows, states, out
        The same as for `force_of_arrays`; numbers and cells are those of the call before.

    Returns
    -------
    int
        Status of `bearing_force`, or `CELLS_MISSING`, with `out` left alone.
    """
    if not all_finite(state):
        return NOT_FINITE
    shape = Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1])
    motion = ring_motion(state)
    wrong: int = check_motion(motion, shape.sizes)
    if wrong != 0:
        return wrong
    prepared = PreparedLaw(law_numbers(numbers), cells, knots)
    find_cells(motion, shape, prepared.numbers, rows, states[0])
    if not all_made(rows.reshape(-1), marks):
        return CELLS_MISSING
    read_states(motion, shape, prepared, Work(rows, states))
    return 1 if assemble(motion, shape, prepared.numbers, states, out) > 0 else 0
