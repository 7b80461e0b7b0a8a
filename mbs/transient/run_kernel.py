"""Many steps of a run in compiled code: the linear part by its own inverse, Newton on the forces of the elements.

The steps are those of `mbs.transient.stepping`. Coordinates are M-orthonormal modes of the linear part, so that mass
is the unit matrix and stiffness a diagonal; damping and gyroscopic terms stay whole. With the acceleration a at the
end of a step as unknown the equation of motion is

    L a = loads - B v0 - lambda p0 + T^T f,  L = 1 + by_v B + by_q lambda,  B = D + speed G,

where T are the rows of the ports and f the forces of the elements. So the motion of the ports is linear in f, by the
receptance R = T L^-1 T^T, and Newton has as few unknowns as the elements have ports:

    f - F(x0 + by_q R f, y0 + by_v R f) = 0.

The inverse follows the speed by its expansion to second order about a reference; the caller moves the reference
before the third order matters.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.maps.lines import FAST
from mbs.bearings.bearing_kernel import bearing_force
from mbs.bearings.slice_table import CELLS, KIND, LIFT_OFF, SAFE_APPROACH
from mbs.gears.gear_kernel import BY_RATE, FORCE, SLOPE, mesh_force
from mbs.transient.run_arrays import (
    AT_ANGLES,
    AT_CELLS,
    AT_ROLLERS,
    AT_SLICES,
    CAGE_RATE,
    FILM,
    FIRST,
    GEOMETRY,
    ROLLERS,
    SLICES,
    START_ANGLE,
    Course,
    Elements,
    Films,
    Linear,
    Numbers,
    Records,
    State,
)

DONE, NO_SOLUTION, TOO_LARGE, ABOVE = range(4)
"""How `advance` ended: all steps made; Newton found nothing; error above the tolerance; a load above the table."""

PORTS = np.array([1, 2, 4, 5])
"""Displacements of its port that a bearing feels."""


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _times(matrix: FloatArray, x: FloatArray, out: FloatArray) -> None:
    """Matrix times vector."""
    for i in range(matrix.shape[0]):
        row = matrix[i]
        total = 0.0
        for j in range(x.size):
            total += row[j] * x[j]
        out[i] = total


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _expanded_times(matrices: FloatArray, by: float, x: FloatArray, out: FloatArray) -> None:
    """(M0 + by M1 + by^2 M2) times vector."""
    for i in range(matrices.shape[1]):
        r0, r1, r2 = matrices[0, i], matrices[1, i], matrices[2, i]
        t0 = t1 = t2 = 0.0
        for j in range(x.size):
            t0 += r0[j] * x[j]
            t1 += r1[j] * x[j]
            t2 += r2[j] * x[j]
        out[i] = t0 + by * (t1 + by * t2)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _expanded(matrices: FloatArray, by: float, out: FloatArray) -> None:
    """M0 + by M1 + by^2 M2."""
    for i in range(out.shape[0]):
        r0, r1, r2, row = matrices[0, i], matrices[1, i], matrices[2, i], out[i]
        for j in range(row.size):
            row[j] = r0[j] + by * (r1[j] + by * r2[j])


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _size(matrix: FloatArray, x: FloatArray) -> float:
    """Root of x^T M x."""
    total = 0.0
    for i in range(x.size):
        row = matrix[i]
        part = 0.0
        for j in range(x.size):
            part += row[j] * x[j]
        total += part * x[i]
    return math.sqrt(max(total, 0.0))


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _norm(x: FloatArray) -> float:
    """Euclidean norm."""
    total = 0.0
    for i in range(x.size):
        total += x[i] * x[i]
    return math.sqrt(total)


@njit(cache=True, error_model="numpy")
def _solve(matrix: FloatArray, right: FloatArray) -> bool:
    """Gaussian elimination with partial pivoting, in place: no allocation; False if singular or not finite."""
    n = right.size
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        if not 0.0 < abs(matrix[pivot, k]) < math.inf:
            return False
        if pivot != k:
            for j in range(k, n):
                matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
            right[k], right[pivot] = right[pivot], right[k]
        inverse = 1.0 / matrix[k, k]
        upper = matrix[k]
        for i in range(k + 1, n):
            factor = matrix[i, k] * inverse
            if factor != 0.0:
                row = matrix[i]
                for j in range(k + 1, n):
                    row[j] -= factor * upper[j]
                right[i] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        total = right[k]
        for j in range(k + 1, n):
            total -= matrix[k, j] * right[j]
        right[k] = total / matrix[k, k]
    return True


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
        Index of the bearing.
    node : int
        The lower node.
    weight : float
        Weight of the upper node, 0 to 1.
    """
    if films.in_use[film, 0] == node and films.in_use[film, 1] == weight:
        return
    films.in_use[film, 0], films.in_use[film, 1] = node, weight
    low, cells, current = films.numbers[film, node], films.cells[film], films.current[film]
    if weight == 0.0:
        current[:] = low
        if low[KIND] == CELLS:
            cells[:] = films.tables[film, node]
        return
    other = (node + 1) % films.tables.shape[1]
    high = films.numbers[film, other]
    for i in range(low.size):
        current[i] = low[i] + weight * (high[i] - low[i])
    # Bounds stay bounds: nodes of the cells move with centre and scale.
    aside = abs(high[LIFT_OFF] - low[LIFT_OFF])
    current[LIFT_OFF] = min(low[LIFT_OFF], high[LIFT_OFF]) - aside
    current[SAFE_APPROACH] = min(low[SAFE_APPROACH], high[SAFE_APPROACH]) - aside
    if low[KIND] != CELLS:
        return
    first, second, mixed = (
        films.tables[film, node].reshape(-1),
        films.tables[film, other].reshape(-1),
        cells.reshape(-1),
    )
    for i in range(mixed.size):
        mixed[i] = first[i] + weight * (second[i] - first[i])


@njit(cache=True, error_model="numpy")
def _bearing(
    elements: Elements, films: Films, b: int, angle: float, x: FloatArray, y: FloatArray, state: FloatArray,
    out: FloatArray,
) -> int:  # fmt: skip
    """Evaluate a bearing at the motion of its ports, by way of `state` (13,), into `out` (13, 6)."""
    entry, numbers = elements.bearings[b], elements.bearing_numbers[b]
    z, n, first, film = entry[ROLLERS], entry[SLICES], entry[FIRST], entry[FILM]
    state[1], state[2], state[4], state[5] = x[first], x[first + 1], x[first + 2], x[first + 3]
    state[7], state[8], state[10], state[11] = y[first], y[first + 1], y[first + 2], y[first + 3]
    state[12] = numbers[START_ANGLE] + numbers[CAGE_RATE] * angle
    at, turned, on, over = entry[AT_SLICES], entry[AT_ANGLES], entry[AT_CELLS], entry[AT_ROLLERS]
    status: int = bearing_force(
        state,
        numbers[GEOMETRY:],
        elements.slices[at : at + 2 * n].reshape(2, n),
        elements.angles[turned : turned + 2 * z].reshape(2, z),
        films.current[film],
        films.cells[film],
        elements.rows[on : on + z * n].reshape(z, n),
        elements.states[4 * on : 4 * (on + z * n)].reshape(4, z, n),
        elements.rollers[7 * over : 7 * (over + z)].reshape(7, z),
        elements.sums[8 * over : 8 * (over + z)].reshape(z, 8),
        out,
    )
    return status


@njit(cache=True, error_model="numpy")
def _evaluate(
    elements: Elements,
    films: Films,
    outside: IntArray,
    speed: float,
    angle: float,
    motion: FloatArray,
    found: FloatArray,
    by: tuple[float, float],
) -> int:
    """Forces of all elements at the motion (2, m) of their ports, and by_q K + by_v C, into `found` (1 + m, m)."""
    x, y = motion[0], motion[1]
    force, slopes = found[0], found[1:]
    by_q, by_v = by
    state, out, flanks = np.zeros(13), np.empty((13, 6)), np.empty((2, 3))
    for b in range(elements.bearings.shape[0]):
        status = _bearing(elements, films, b, angle, x, y, state, out)
        if status != 0:
            return NO_SOLUTION if status < 0 else ABOVE
        elements.counts[b] += outside[elements.bearings[b, FILM]]
        first = elements.bearings[b, FIRST]
        for i in range(4):
            k = PORTS[i]
            force[first + i] = out[0, k]
            for j in range(4):
                slopes[first + i, first + j] = by_q * out[1 + k, PORTS[j]] + by_v * out[7 + k, PORTS[j]]
    for g in range(elements.mesh_ports.size):
        first = elements.mesh_ports[g]
        constants, series = elements.mesh_constants[g], elements.mesh_series[g]
        mesh_force(constants, series, angle, speed, x[first : first + 2], y[first : first + 2], flanks)
        for i in range(2):
            force[first + i] = -flanks[i, FORCE]
            slopes[first + i, first + i] = by_q * flanks[i, SLOPE] + by_v * flanks[i, BY_RATE]
    return DONE


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _jacobian(slopes: FloatArray, receptance: FloatArray, out: FloatArray) -> None:
    """1 + (by_q K + by_v C) R; the slopes are zero but for blocks on the diagonal."""
    m = out.shape[0]
    for i in range(m):
        row = out[i]
        row[:] = 0.0
        row[i] = 1.0
        for k in range(m):
            slope = slopes[i, k]
            if slope != 0.0:
                by = receptance[k]
                for j in range(m):
                    row[j] += slope * by[j]


@njit(cache=True, error_model="numpy")
def observe(state: State, records: Records, row: int) -> None:
    """Record the state.

    Parameters
    ----------
    state : State
        The state of the run.
    records : Records
        What is recorded.
    row : int
        Index of the sample.
    """
    for i in range(records.orders.size):
        seen, motion = records.rows[i], state.motion[records.orders[i]]
        total = 0.0
        for j in range(motion.size):
            total += seen[j] * motion[j]
        records.outputs[row, i] = total
    records.forces[row] = state.forces[0]
    if records.motions.shape[0] > 0:
        records.motions[row] = state.motion[:3]


@njit(cache=True, error_model="numpy")
def advance(
    linear: Linear,
    numbers: Numbers,
    elements: Elements,
    films: Films,
    course: Course,
    state: State,
    records: Records,
    counters: IntArray,
) -> tuple[int, int, float]:
    """Make the steps of a course.

    Parameters
    ----------
    linear, numbers, elements, films, course
        What moves.
    state : State
        Overwritten after each step that is made.
    records : Records
        Records, which are filled.
    counters : array (1,), of int
        Newton iterations, counted up.

    Returns
    -------
    done, status, error : int, int, float
        How many steps were made; how it ended; the estimated error of the last step, infinite where there is no
        solution. The step that failed has left no trace in the state.
    """
    n, m = linear.eigenvalues.size, linear.ports.shape[0]
    p, v, a, carried = state.motion[0], state.motion[1], state.motion[2], state.motion[3]
    p0, v0, known, right, free = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    found_a, load = np.empty(n), np.empty(n)
    unmoved, motion, found = np.empty((2, m)), np.empty((2, m)), np.zeros((1 + m, m))
    u, short, jacobian = np.empty(m), np.empty(m), np.empty((m, m))
    reach, receptance = linear.reach[0].copy(), linear.receptance[0].copy()
    h, by_q, by_v = numbers.h, numbers.by_q, numbers.by_v
    latest, before, earlier = state.forces[0], state.forces[1], state.forces[2]
    error = 0.0
    for step in range(course.speeds.size):
        speed, angle = course.speeds[step], course.angles[step]
        by = speed - linear.reference
        load[:] = course.steady
        for i in range(course.varying.shape[0]):
            factor = course.factors[step, i]
            for j in range(n):
                load[j] += factor * course.varying[i, j]
        for i in range(n):
            known[i] = (numbers.alpha_f * a[i] - numbers.alpha_m * carried[i]) / (1.0 - numbers.alpha_m)
            p0[i] = p[i] + h * v[i] + h * h * ((0.5 - numbers.beta) * carried[i] + numbers.beta * known[i])
            v0[i] = v[i] + h * ((1.0 - numbers.gamma) * carried[i] + numbers.gamma * known[i])
        _times(linear.damping, v0, right)
        for i in range(n):
            right[i] = load[i] - right[i] - linear.eigenvalues[i] * p0[i]
        if linear.turning and by != 0.0:
            _times(linear.gyroscopic, v0, free)
            for i in range(n):
                right[i] -= by * free[i]
            _expanded_times(linear.inverse, by, right, free)
            _expanded(linear.reach, by, reach)
            _expanded(linear.receptance, by, receptance)
        else:
            _times(linear.inverse[0], right, free)
            if linear.turning:
                reach[:], receptance[:] = linear.reach[0], linear.receptance[0]
        for i in range(n):
            right[i] = p0[i] + by_q * free[i]
        _times(linear.ports, right, unmoved[0])
        for i in range(n):
            right[i] = v0[i] + by_v * free[i]
        _times(linear.ports, right, unmoved[1])
        for film in range(films.current.shape[0]):
            blend(films, film, course.nodes[step, film], course.weights[step, film])
        for i in range(m):
            u[i] = 3.0 * (latest[i] - before[i]) + earlier[i]
        by_load, largest = _norm(load), 0.0
        status = NO_SOLUTION
        for _ in range(numbers.iterations):
            counters[0] += 1
            _times(receptance, u, short)
            for i in range(m):
                motion[0, i] = unmoved[0, i] + by_q * short[i]
                motion[1, i] = unmoved[1, i] + by_v * short[i]
            reached = _evaluate(elements, films, course.outside[step], speed, angle, motion, found, (by_q, by_v))
            if reached != DONE:
                status = reached
                break
            for i in range(n):
                found_a[i] = free[i]
            for k in range(m):
                row = reach[k]
                for i in range(n):
                    found_a[i] += u[k] * row[i]
            for i in range(m):
                short[i] = u[i] - found[0, i]
            largest = max(largest, by_load, _size(linear.size, found[0]), _norm(found_a))
            if _size(linear.size, short) <= numbers.residual * largest:
                status = DONE
                break
            _jacobian(found[1:], receptance, jacobian)
            if not _solve(jacobian, short):
                break
            for i in range(m):
                u[i] -= short[i]
        if status != DONE:
            return step, status, math.inf
        error = 0.0
        if numbers.tolerance < math.inf:
            for i in range(n):
                right[i] = found_a[i] - a[i]
            _times(linear.physical, right, free)
            error = numbers.error_weight * np.max(np.abs(free))
            if not error <= numbers.tolerance:
                return step, TOO_LARGE, error
        for i in range(n):
            p[i], v[i] = p0[i] + by_q * found_a[i], v0[i] + by_v * found_a[i]
            carried[i], a[i] = known[i] + numbers.ratio * found_a[i], found_a[i]
        for i in range(m):
            earlier[i], before[i], latest[i] = before[i], latest[i], u[i]
        if course.rows[step] >= 0:
            observe(state, records, course.rows[step])
    return course.speeds.size, DONE, error
