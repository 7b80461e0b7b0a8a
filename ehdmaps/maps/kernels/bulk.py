"""States of a law at rest at many approaches, so that each step runs in vector instructions."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.lines import (
    FAST,
    cell_of,
    cubics,
    place_within,
    state_of,
    stretched,
)
from ehdmaps.maps.kernels.roller_balance import balanced_states
from ehdmaps.maps.kernels.tables import Line, Point


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
