"""A roller in equilibrium between its two contacts, of which the outer one carries its centrifugal load besides.

The approach delta of both contacts together divides into a and delta - a so that W_i(a) + q = W_o(delta - a). Newton's
method in the logarithm of the loads, inside a closing bracket, finds a from any start. Of many approaches only some are
solved so, each from the one before, carried on to the second order; the others start on the cubic between these, and
take their steps together, in loops that the processor overlaps.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.lines import (
    FAST,
    State,
    bent_state,
    cell_of,
    line_approach,
    line_load,
    log,
    place_within,
    stretched,
)
from ehdmaps.maps.kernels.tables import Line, Point

LEAST_LOAD = 1e-200
"""Load below which a contact counts as unloaded [N/m]."""

_STEPS, _ROUNDS = 100, 4
_LIGHT = 0.3

_CLOSE = 1e-8
"""How far the logarithms of both loads may be apart before the last step, which leaves the square of that."""

_REACH = 0.25
"""How far apart approaches that are solved first may be, as a part of the scale and of how far they are from it."""


@njit(error_model="numpy", fastmath=FAST)
def _start(point: Point, delta: float) -> float:
    """Starting value without a neighbour."""
    inner, outer, q = point.inner, point.outer, point.centrifugal_load
    high = delta - point.outer_start
    load_i, slope_i = line_load(inner, high)
    if load_i < _LIGHT * q:  # the outer contact hardly moves
        return float(high - load_i / (slope_i + line_load(outer, point.outer_start)[1]))
    # both alike, as their scales are
    share = outer.inverse_scale / (inner.inverse_scale + outer.inverse_scale)
    return float(inner.offset + (delta - inner.offset - outer.offset) * share)


@njit(error_model="numpy", fastmath=FAST)
def _divided(point: Point, delta: float, start: float) -> float:
    """Approach of the inner contact in equilibrium, from a start."""
    inner, outer, q = point.inner, point.outer, point.centrifugal_load
    low, high, a = point.inner_lift_off, delta - point.outer_start, start
    for _ in range(_STEPS):
        if not low <= a <= high:
            a = 0.5 * (low + high)
        load_i, slope_i = line_load(inner, a)
        load_o, slope_o = line_load(outer, delta - a)
        if load_o <= 0.0:
            high = a
            a = 0.5 * (low + high)
            continue
        excess = log((load_i + q) / load_o)
        if excess > 0.0:
            high = a
        else:
            low = a
        a -= excess / (slope_i / (load_i + q) + slope_o / load_o)
        if abs(excess) <= _CLOSE:
            break
    # the bracket is exact but for the rounding of the lines
    return float(min(max(a, low), high)) if low < high else a


@njit(error_model="numpy", fastmath=FAST)
def _joined(point: Point, delta: float, a: float) -> tuple[State, float, float]:
    """State of the roller, the part of a growing approach that the inner contact takes, and how that part changes."""
    (w, k_i, r_i, dc_i), curve_i = bent_state(point.inner, a)
    (w_o, k_o, r_o, dc_o), curve_o = bent_state(point.outer, delta - a)
    if w < LEAST_LOAD or w_o < LEAST_LOAD:
        return (0.0, 0.0, 0.0, 0.0), 1.0, 0.0
    both = 1.0 / (k_i + k_o)
    part_i, part_o = k_o * both, k_i * both
    c_i, c_o = w * r_i, w_o * r_o
    change = (curve_o * part_o * k_i - k_o * curve_i * part_i) * both * both
    dc = dc_i * part_i**3 + dc_o * part_o**3 + 2.0 * change * (c_i * part_i - c_o * part_o)
    return (w, k_i * part_i, r_i * part_i**2 + w_o / w * r_o * part_o**2, dc), part_i, change


@njit(error_model="numpy", fastmath=FAST)
def balanced_state(point: Point, delta: float) -> State:
    """State of the roller at rest, at one approach.

    Parameters
    ----------
    point : Point
        The law, with a centrifugal load.
    delta : float
        Approach of both contacts together [m].
    """
    if delta <= point.lift_off:
        return 0.0, 0.0, 0.0, 0.0
    state: State = _joined(point, delta, _divided(point, delta, _start(point, delta)))[0]
    return state


@njit(error_model="numpy", fastmath=FAST)
def _starts(point: Point, delta: FloatArray, a: FloatArray) -> None:
    """Starts for the equilibria at rising approaches above lift-off: some are solved, the others lie between these."""
    centre, scale = point.inner.offset + point.outer.offset, 1.0 / point.inner.inverse_scale
    a[0] = _divided(point, delta[0], _start(point, delta[0]))
    _, part, change = _joined(point, delta[0], a[0])
    here = 0
    while here < delta.size - 1:
        reach = delta[here] + _REACH * (scale + abs(delta[here] - centre))
        ahead = here + 1
        while ahead + 1 < delta.size and delta[ahead + 1] <= reach:
            ahead += 1
        h = delta[ahead] - delta[here]
        a[ahead] = _divided(point, delta[ahead], a[here] + h * (part + 0.5 * h * change))
        _, next_part, change = _joined(point, delta[ahead], a[ahead])
        secant = (a[ahead] - a[here]) / h if h > 0.0 else part
        for i in range(here + 1, ahead):
            t = (delta[i] - delta[here]) / h if h > 0.0 else 0.0
            bend = (1.0 - t) * (part - secant) - t * (next_part - secant)
            a[i] = a[here] + t * h * (secant + (1.0 - t) * bend)
        here, part = ahead, next_part


@njit(error_model="numpy", fastmath=FAST)
def _roots(line: Line, at: FloatArray, g: FloatArray, dg: FloatArray) -> None:
    """Cube roots of the loads of a line at many approaches, and their slopes."""
    offset, inverse, start, step, c = line.offset, line.inverse_scale, line.start, line.step, line.coefficients
    cells = c.shape[0]
    for i in range(at.size):
        s, ds = stretched((at[i] - offset) * inverse)
        g[i], dg[i] = place_within((s - start) * step, cells), step * ds * inverse
    for i in range(at.size):
        cell = cell_of(g[i], cells)
        k, t = np.uint64(cell), g[i] - cell
        a1, a2, a3 = c[k, np.uint64(1)], c[k, np.uint64(2)], c[k, np.uint64(3)]
        g[i] = c[k, np.uint64(0)] + t * (a1 + t * (a2 + t * a3))
        dg[i] *= a1 + t * (2.0 * a2 + 3.0 * t * a3)


@njit(error_model="numpy", fastmath=FAST)
def _approached(point: Point, delta: FloatArray, a: FloatArray, work: FloatArray) -> bool:
    """A step of Newton's method at all approaches; whether it was the last."""
    q, other, g_i, dg_i, g_o, dg_o = point.centrifugal_load, work[0], work[1], work[2], work[3], work[4]
    for i in range(delta.size):
        other[i] = delta[i] - a[i]
    _roots(point.inner, a, g_i, dg_i)
    _roots(point.outer, other, g_o, dg_o)
    left = 0.0
    for i in range(delta.size):
        x = g_i[i] if g_i[i] > 0.0 else 0.0
        y = g_o[i] if g_o[i] > 0.0 else 0.0
        load_i, load_o = x * x * x + q, y * y * y
        excess = log(load_i / load_o)
        a[i] -= excess / (3.0 * x * x * dg_i[i] / load_i + 3.0 * y * y * dg_o[i] / load_o)
        left += 0.0 if abs(excess) <= _CLOSE else 1.0
    return left == 0.0


@njit(error_model="numpy", fastmath=FAST)
def balanced_states(point: Point, delta: FloatArray, states: FloatArray) -> None:
    """States of the roller at rest, at approaches that rise; fast where they rise in small steps.

    Parameters
    ----------
    point : Point
        The law, with a centrifugal load.
    delta : array (n,)
        Approaches of both contacts together, rising [m].
    states : array (4, n)
        Filled: w [N/m], dw/ddelta [N/m2], c [N s/m2], dc/ddelta [N s/m3].
    """
    w, dw, c, dc = states[0], states[1], states[2], states[3]
    first = 0
    while first < delta.size and delta[first] <= point.lift_off:
        w[first] = dw[first] = c[first] = dc[first] = 0.0
        first += 1
    if first == delta.size:
        return
    loaded = delta[first:]
    a, work = np.empty(loaded.size), np.empty((5, loaded.size))
    _starts(point, loaded, a)
    found = False
    for _ in range(_ROUNDS):
        found = _approached(point, loaded, a, work)
        if found:
            break
    for i in range(loaded.size):
        if not found:
            a[i] = _divided(point, loaded[i], a[i])
        # the bracket is exact but for the rounding of the lines
        between = min(max(a[i], point.inner_lift_off), loaded[i] - point.outer_start)
        state, _, _ = _joined(point, loaded[i], between)
        k = first + i
        w[k], dw[k], c[k], dc[k] = state[0], state[1], state[0] * state[2], state[3]


@njit(error_model="numpy", fastmath=FAST)
def balanced_approach(point: Point, load: float) -> float:
    """Approach at which the inner contact carries a load, the outer one that and the centrifugal load."""
    approach: float = line_approach(point.inner, load) + line_approach(point.outer, load + point.centrifugal_load)
    return approach
