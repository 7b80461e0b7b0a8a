"""The law for many points: the functions of `kernel` in blocks, so that each step runs in vector instructions.

The points that the table alone does not answer (faded films, centrifugal loads, outside the map, not finite) go
through `kernel` one by one.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ehdmaps.maps.elementary import log
from ehdmaps.maps.kernel import (
    cell_of,
    collapsed_row,
    cubics,
    evaluate,
    evaluate_at,
    force_of,
    place_within,
    quadratic_weights,
    splines,
    state_of,
    stretched,
)
from ehdmaps.maps.tables import COLDEST, ApproachTable, CountArray, LawTable, Line, Point
from ehdmaps.physics._values import FloatArray

_FAST = {"contract", "reassoc", "nsz", "arcp"}
_BLOCK = 256


@njit(cache=True, error_model="numpy", fastmath=_FAST)
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


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _line_cubics(coefficients: FloatArray, places: FloatArray, found: FloatArray) -> None:
    """Splines of a line and their slopes, into `found` (4, n)."""
    cells = coefficients.shape[0]
    g, dg, q, dq = found[0], found[1], found[2], found[3]
    for i in range(places.size):
        cell = cell_of(places[i], cells)
        g[i], dg[i], q[i], dq[i] = cubics(coefficients, cell, places[i] - cell)


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _forces(
    found: FloatArray, scales: FloatArray, rate: FloatArray, w: FloatArray, dw: FloatArray, dc: FloatArray
) -> None:
    """Forces from the splines and their slopes."""
    g, dg, q, dq = found[0], found[1], found[2], found[3]
    for i in range(rate.size):
        state = state_of(g[i], dg[i] * scales[i], q[i], dq[i] * scales[i])
        w[i], dw[i], dc[i] = force_of(state, rate[i])


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def evaluate_many_at(point: Point, delta: FloatArray, rate: FloatArray, forces: FloatArray, counts: CountArray) -> None:
    """`kernel.evaluate_at` for arrays (n,), into `forces` (3, n)."""
    if point.film < 1.0 or point.centrifugal_load > 0.0:
        for i in range(delta.size):
            forces[0, i], forces[1, i], forces[2, i] = evaluate_at(point, delta[i], rate[i], counts)
        return
    line: Line = point.own
    scratch = np.empty((8, _BLOCK))
    scratch[0, :] = line.offset
    scratch[1, :] = line.inverse_scale
    axis = (line.start, line.step, line.coefficients.shape[0])
    for first in range(0, delta.size, _BLOCK):
        last = min(first + _BLOCK, delta.size)
        n = last - first
        places, scales, found = scratch[2, :n], scratch[3, :n], scratch[4:, :n]
        d, r = delta[first:last], rate[first:last]
        w, dw, dc = forces[0, first:last], forces[1, first:last], forces[2, first:last]
        _places(d, scratch[0, :n], scratch[1, :n], axis, places, scales)
        _line_cubics(line.coefficients, places, found)
        _forces(found, scales, r, w, dw, dc)
        for i in range(n):
            if not (abs(r[i]) < math.inf and -math.inf < d[i] <= point.held_approach):
                w[i], dw[i], dc[i] = evaluate_at(point, d[i], r[i], counts)


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _speed_places(speeds: FloatArray, lowest: float, start: float, step: float, cells: int, places: FloatArray) -> None:
    """Places on the axis of speed."""
    for i in range(speeds.size):
        size = abs(speeds[i])
        size = size if size > lowest else lowest
        places[i] = place_within((log(size) - start) * step, cells)


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _temperature_places(temperatures: FloatArray, start: float, step: float, cells: int, places: FloatArray) -> None:
    """Places on the axis of temperature."""
    for i in range(temperatures.size):
        places[i] = place_within((1.0 / (temperatures[i] - COLDEST) - start) * step, cells)


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _alignments(table: ApproachTable, along_u: FloatArray, along_t: FloatArray, found: FloatArray) -> None:
    """Offsets and inverse scales at places in speed and temperature, into `found` (2, n)."""
    sums = np.empty(2)
    for n in range(along_u.size):
        i, j = int(along_u[n] + 0.5), int(along_t[n] + 0.5)
        weights_u, weights_t = quadratic_weights(along_u[n] - i), quadratic_weights(along_t[n] - j)
        collapsed_row(table.place, i, j, weights_u, weights_t, 0, 2, sums)
        found[0, n], found[1, n] = sums[0], sums[1]


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _table_splines(
    table: ApproachTable, along_u: FloatArray, along_t: FloatArray, places: FloatArray, found: FloatArray
) -> None:
    """Splines of a table and their slopes, into `found` (4, n)."""
    values = table.coefficients
    cells = values.shape[2] // 2 - 3
    sums = np.empty(8)
    g, dg, q, dq = found[0], found[1], found[2], found[3]
    for n in range(places.size):
        i, j, k = int(along_u[n] + 0.5), int(along_t[n] + 0.5), cell_of(places[n], cells)
        weights_u, weights_t = quadratic_weights(along_u[n] - i), quadratic_weights(along_t[n] - j)
        collapsed_row(values, i, j, weights_u, weights_t, 2 * k, 8, sums)
        g[n], dg[n], q[n], dq[n] = splines(sums, places[n] - k)


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def evaluate_many(
    table: LawTable,
    workspace: FloatArray,
    delta: FloatArray,
    rate: FloatArray,
    entrainment_speed: FloatArray,
    temperature: FloatArray,
    centrifugal_load: FloatArray,
    forces: FloatArray,
    counts: CountArray,
) -> None:
    """`kernel.evaluate` for arrays (n,), into `forces` (3, n)."""
    own: ApproachTable = table.own
    values = own.coefficients
    cells_u, cells_t = values.shape[0] - 3, values.shape[1] - 3
    axis = (own.start, own.step, values.shape[2] // 2 - 3)
    scratch = np.empty((10, _BLOCK))
    for first in range(0, delta.size, _BLOCK):
        last = min(first + _BLOCK, delta.size)
        n = last - first
        along_u, along_t, places, scales = scratch[0, :n], scratch[1, :n], scratch[2, :n], scratch[3, :n]
        alignment, found = scratch[4:6, :n], scratch[6:, :n]
        d, r, u, t = delta[first:last], rate[first:last], entrainment_speed[first:last], temperature[first:last]
        w, dw, dc = forces[0, first:last], forces[1, first:last], forces[2, first:last]
        _speed_places(u, table.lowest_speed, own.log_speed_start, own.log_speed_step, cells_u, along_u)
        _temperature_places(t, own.temperature_start, own.temperature_step, cells_t, along_t)
        _alignments(own, along_u, along_t, alignment)
        _places(d, alignment[0], alignment[1], axis, places, scales)
        _table_splines(own, along_u, along_t, places, found)
        _forces(found, scales, r, w, dw, dc)
        for i in range(n):
            size = abs(u[i])
            if not (
                table.film_speed <= size <= table.counted_speed
                and table.lowest_temperature <= t[i] <= table.highest_temperature
                and centrifugal_load[first + i] == 0.0
                and abs(d[i]) < math.inf
                and abs(r[i]) < math.inf
                and found[0, i] <= table.highest_root
            ):
                w[i], dw[i], dc[i] = evaluate(
                    table, workspace, d[i], r[i], u[i], t[i], centrifugal_load[first + i], counts
                )
