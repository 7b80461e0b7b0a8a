"""The law for many points: the functions of `kernel` in blocks, so that each step runs in vector instructions.

The points that the table alone does not answer (faded films, centrifugal loads, outside the map, not finite) go
through `kernel` one by one.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import ByteArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.kernel import collapse, evaluate_at, within_map
from ehdmaps.maps.kernels.lines import (
    FAST,
    cell_of,
    collapsed_row,
    cubics,
    force_of,
    log,
    place_within,
    quadratic_weights,
    splines,
    state_of,
    stretched,
)
from ehdmaps.maps.kernels.roller_balance import balanced_states
from ehdmaps.maps.kernels.tables import COLDEST, NOT_FINITE, ApproachTable, LawTable, Line, Point

_BLOCK = 256


@njit(error_model="numpy", fastmath=FAST)
def _places(
    delta: FloatArray,
    offset: FloatArray,
    inverse_scale: FloatArray,
    axis: tuple[float, float, int],
    places: FloatArray,
    scales: FloatArray,
) -> None:
    """Places on the stretched axis (start, step, cells), and their derivatives by the approach."""
    start, step, cells = axis
    for i in range(delta.size):
        s, ds = stretched((delta[i] - offset[i]) * inverse_scale[i])
        places[i] = place_within((s - start) * step, cells)
        scales[i] = step * ds * inverse_scale[i]


@njit(error_model="numpy", fastmath=FAST)
def _line_cubics(coefficients: FloatArray, places: FloatArray, found: FloatArray) -> None:
    """Splines of a line and their slopes, into `found` (4, n)."""
    cells = coefficients.shape[0]
    g, dg, q, dq = found[0], found[1], found[2], found[3]
    for i in range(places.size):
        cell = cell_of(places[i], cells)
        g[i], dg[i], q[i], dq[i] = cubics(coefficients, cell, places[i] - cell)


@njit(error_model="numpy", fastmath=FAST)
def _forces(
    found: FloatArray, scales: FloatArray, rate: FloatArray, w: FloatArray, dw: FloatArray, dc: FloatArray
) -> None:
    """Forces from the splines and their slopes."""
    g, dg, q, dq = found[0], found[1], found[2], found[3]
    for i in range(rate.size):
        state = state_of(g[i], dg[i] * scales[i], q[i], dq[i] * scales[i])
        w[i], dw[i], dc[i] = force_of(state, rate[i])


@njit(error_model="numpy", fastmath=FAST)
def evaluate_many_at(point: Point, delta: FloatArray, rate: FloatArray, forces: FloatArray, counts: IntArray) -> None:
    """`kernel.evaluate_at` for arrays (n,), into `forces` (3, n)."""
    if point.film < 1.0 or point.centrifugal_load > 0.0:
        for i in range(delta.size):
            forces[0, i], forces[1, i], forces[2, i] = evaluate_at(point, delta[i], rate[i], counts)
        return
    line: Line = point.own
    found, scratch = np.empty((4, _BLOCK)), np.empty((2, _BLOCK))
    offset, inverse_scale = np.full(_BLOCK, line.offset), np.full(_BLOCK, line.inverse_scale)
    axis = (line.start, line.step, line.coefficients.shape[0])
    for first in range(0, delta.size, _BLOCK):
        last = min(first + _BLOCK, delta.size)
        n = last - first
        places, scales = scratch[0, :n], scratch[1, :n]
        d, r = delta[first:last], rate[first:last]
        w, dw, dc = forces[0, first:last], forces[1, first:last], forces[2, first:last]
        _places(d, offset, inverse_scale, axis, places, scales)
        _line_cubics(line.coefficients, places, found)
        _forces(found, scales, r, w, dw, dc)
        for i in range(n):
            if not (abs(r[i]) < math.inf and -math.inf < d[i] <= point.held_approach):
                w[i], dw[i], dc[i] = evaluate_at(point, d[i], r[i], counts)


@njit(error_model="numpy", fastmath=FAST)
def rest_states(point: Point, delta: FloatArray, states: FloatArray) -> None:
    """Loads at rest with the whole film, their slopes, damping and its slopes.

    Parameters
    ----------
    point : Point
        The law, of which no hold is taken.
    delta : array (n,)
        Approaches [m].
    states : array (4, n)
        Filled: w [N/m], dw/ddelta [N/m2], c [N s/m2], dc/ddelta [N s/m3].
    """
    w, dw, c, dc = states[0], states[1], states[2], states[3]
    if point.centrifugal_load > 0.0:
        balanced_states(point, delta, states)
        return
    line: Line = point.own
    scratch, found = np.empty((2, delta.size)), np.empty((4, delta.size))
    offset, inverse_scale = np.full(delta.size, line.offset), np.full(delta.size, line.inverse_scale)
    places, scales = scratch[0], scratch[1]
    _places(delta, offset, inverse_scale, (line.start, line.step, line.coefficients.shape[0]), places, scales)
    _line_cubics(line.coefficients, places, found)
    for i in range(delta.size):
        w[i], dw[i], ratio, dc[i] = state_of(found[0, i], found[1, i] * scales[i], found[2, i], found[3, i] * scales[i])
        c[i] = w[i] * ratio


@njit(error_model="numpy", fastmath=FAST)
def _speed_places(speeds: FloatArray, table: LawTable, nodes: IntArray, weights: FloatArray) -> None:
    """Nearest nodes of speeds, and weights (3, n) of the splines there."""
    own: ApproachTable = table.own
    start, step, last = own.log_speed_start, own.log_speed_step, own.place.shape[0] - 3
    w0, w1, w2 = weights[0], weights[1], weights[2]
    for n in range(speeds.size):
        size = abs(speeds[n])
        size = size if size > table.lowest_speed else table.lowest_speed
        place = place_within((log(size) - start) * step, last)
        nodes[n] = int(place + 0.5)
        w0[n], w1[n], w2[n] = quadratic_weights(place - nodes[n])


@njit(error_model="numpy", fastmath=FAST)
def _temperature_places(temperatures: FloatArray, own: ApproachTable, nodes: IntArray, weights: FloatArray) -> None:
    """Nearest nodes of temperatures, and weights (3, n) of the splines there."""
    start, step, last = own.temperature_start, own.temperature_step, own.place.shape[1] - 3
    w0, w1, w2 = weights[0], weights[1], weights[2]
    for n in range(temperatures.size):
        place = place_within((1.0 / (temperatures[n] - COLDEST) - start) * step, last)
        nodes[n] = int(place + 0.5)
        w0[n], w1[n], w2[n] = quadratic_weights(place - nodes[n])


@njit(error_model="numpy", fastmath=FAST)
def _alignments(own: ApproachTable, count: int, nodes: IntArray, weights: FloatArray, found: FloatArray) -> None:
    """Offsets and inverse scales, into `found` (2, n); nodes (2, n) and weights (6, n) of speed and temperature."""
    sums = np.empty(2)
    i, j = nodes[0], nodes[1]
    u0, u1, u2, t0, t1, t2 = weights[0], weights[1], weights[2], weights[3], weights[4], weights[5]
    offset, inverse_scale = found[0], found[1]
    for n in range(count):
        along_u, along_t = (u0[n], u1[n], u2[n]), (t0[n], t1[n], t2[n])
        collapsed_row(own.place, i[n], j[n], along_u, along_t, 0, 2, sums)
        offset[n], inverse_scale[n] = sums[0], sums[1]


@njit(error_model="numpy", fastmath=FAST)
def _table_splines(
    own: ApproachTable, places: FloatArray, nodes: IntArray, weights: FloatArray, found: FloatArray
) -> None:
    """Splines of a table and their slopes, into `found` (4, n); nodes and weights as in `_alignments`."""
    cells = own.coefficients.shape[2] // 2 - 3
    sums = np.empty(8)
    i, j = nodes[0], nodes[1]
    u0, u1, u2, t0, t1, t2 = weights[0], weights[1], weights[2], weights[3], weights[4], weights[5]
    g, dg, q, dq = found[0], found[1], found[2], found[3]
    for n in range(places.size):
        k = cell_of(places[n], cells)
        along_u, along_t = (u0[n], u1[n], u2[n]), (t0[n], t1[n], t2[n])
        collapsed_row(own.coefficients, i[n], j[n], along_u, along_t, 2 * k, 8, sums)
        g[n], dg[n], q[n], dq[n] = splines(sums, places[n] - k)


@njit(error_model="numpy", fastmath=FAST)
def _others(
    table: LawTable,
    delta: FloatArray,
    rate: FloatArray,
    entrainment_speed: FloatArray,
    temperature: FloatArray,
    centrifugal_load: FloatArray,
    roots: FloatArray,
    others: ByteArray,
) -> int:
    """Mark the points that the table alone does not answer, and count them."""
    count = 0
    slowest, fastest = max(table.film_speed, table.lowest_speed), table.counted_speed
    coldest, hottest, highest = table.counted_cold, table.counted_hot, table.known_root
    for i in range(delta.size):
        size, t, d, r = abs(entrainment_speed[i]), temperature[i], delta[i], rate[i]
        within = (size >= slowest) & (size <= fastest) & (t >= coldest) & (t <= hottest) & (roots[i] <= highest)
        finite = (abs(d) < math.inf) & (abs(r) < math.inf)
        others[i] = 0 if within & finite & (centrifugal_load[i] == 0.0) else 1
        count += int(others[i])
    return count


@njit(error_model="numpy", fastmath=FAST)
def _one_by_one(
    table: LawTable,
    workspace: FloatArray,
    delta: FloatArray,
    rate: FloatArray,
    entrainment_speed: FloatArray,
    temperature: FloatArray,
    centrifugal_load: FloatArray,
    others: ByteArray,
    forces: FloatArray,
    counts: IntArray,
) -> None:
    """`kernel.evaluate` for the marked points; what stays the same from one to the next is collapsed once."""
    u, t, q = table.lowest_speed, table.lowest_temperature, 0.0
    point = collapse(table, workspace, u, t, q, counts.copy())
    for i in range(delta.size):
        if not others[i]:
            continue
        d, r = delta[i], rate[i]
        if not (
            abs(d) < math.inf
            and abs(r) < math.inf
            and abs(entrainment_speed[i]) < math.inf
            and abs(temperature[i]) < math.inf
            and abs(centrifugal_load[i]) < math.inf
        ):
            counts[NOT_FINITE] += 1
            forces[:, i] = math.nan
            continue
        if u == entrainment_speed[i] and t == temperature[i] and q == centrifugal_load[i]:
            within_map(table, u, t, counts)
        else:
            u, t, q = entrainment_speed[i], temperature[i], centrifugal_load[i]
            point = collapse(table, workspace, u, t, q, counts)
        forces[0, i], forces[1, i], forces[2, i] = evaluate_at(point, d, r, counts)


@njit(error_model="numpy", fastmath=FAST)
def evaluate_many(
    table: LawTable,
    workspace: FloatArray,
    delta: FloatArray,
    rate: FloatArray,
    entrainment_speed: FloatArray,
    temperature: FloatArray,
    centrifugal_load: FloatArray,
    forces: FloatArray,
    counts: IntArray,
) -> None:
    """`kernel.evaluate` for arrays (n,), into `forces` (3, n)."""
    own: ApproachTable = table.own
    axis = (own.start, own.step, own.coefficients.shape[2] // 2 - 3)
    nodes = np.empty((2, _BLOCK), dtype=np.int64)
    weights, alignment, found = np.empty((6, _BLOCK)), np.empty((2, _BLOCK)), np.empty((4, _BLOCK))
    scratch = np.empty((2, _BLOCK))
    others = np.empty(delta.size, dtype=np.uint8)
    count = 0
    for first in range(0, delta.size, _BLOCK):
        last = min(first + _BLOCK, delta.size)
        n = last - first
        places, scales = scratch[0, :n], scratch[1, :n]
        d, r, u, t = delta[first:last], rate[first:last], entrainment_speed[first:last], temperature[first:last]
        _speed_places(u, table, nodes[0], weights[:3])
        _temperature_places(t, own, nodes[1], weights[3:])
        _alignments(own, n, nodes, weights, alignment)
        _places(d, alignment[0], alignment[1], axis, places, scales)
        _table_splines(own, places, nodes, weights, found)
        _forces(found, scales, r, forces[0, first:last], forces[1, first:last], forces[2, first:last])
        count += _others(table, d, r, u, t, centrifugal_load[first:last], found[0], others[first:last])
    if count > 0:
        _one_by_one(
            table, workspace, delta, rate, entrainment_speed, temperature, centrifugal_load, others, forces, counts
        )
