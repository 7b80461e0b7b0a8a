"""A roller in equilibrium between its two contacts, of which the outer one carries its centrifugal load besides.

The approach delta of both contacts together divides into a and delta - a so that W_i(a) + q = W_o(delta - a). Newton's
method in the logarithm of the loads, inside a closing bracket, finds a from any start; from a neighbouring approach,
whose solution is carried on to the second order, in two steps.
"""

from __future__ import annotations

from numba import njit

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.elementary import log
from ehdmaps.maps.lines import FAST, State, bent_state, line_approach, line_load
from ehdmaps.maps.tables import Point

LEAST_LOAD = 1e-200
"""Load that is none [N/m]."""

_STEPS = 100
_LIGHT = 0.3

_CLOSE = 1e-8
"""How far the logarithms of both loads may be apart before the last step, which leaves the square of that."""


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _start(point: Point, delta: float) -> float:
    """Where to begin without a neighbour."""
    inner, outer, q = point.inner, point.outer, point.centrifugal_load
    high = delta - point.outer_start
    load_i, slope_i = line_load(inner, high)
    if load_i < _LIGHT * q:  # the outer contact hardly moves
        return float(high - load_i / (slope_i + line_load(outer, point.outer_start)[1]))
    # both alike, as their scales are
    share = outer.inverse_scale / (inner.inverse_scale + outer.inverse_scale)
    return float(inner.offset + (delta - inner.offset - outer.offset) * share)


@njit(cache=True, error_model="numpy", fastmath=FAST)
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


@njit(cache=True, error_model="numpy", fastmath=FAST)
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


@njit(cache=True, error_model="numpy", fastmath=FAST)
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


@njit(cache=True, error_model="numpy", fastmath=FAST)
def balanced_states(point: Point, delta: FloatArray, states: FloatArray) -> None:
    """States of the roller at rest, each from the one before; fast where approaches rise in small steps.

    Parameters
    ----------
    point : Point
        The law, with a centrifugal load.
    delta : array (n,)
        Approaches of both contacts together [m].
    states : array (4, n)
        Filled: w [N/m], dw/ddelta [N/m2], c [N s/m2], dc/ddelta [N s/m3].
    """
    w, dw, c, dc = states[0], states[1], states[2], states[3]
    a = part = change = 0.0
    fresh = True
    for i in range(delta.size):
        if delta[i] <= point.lift_off:
            w[i] = dw[i] = c[i] = dc[i] = 0.0
            fresh = True
            continue
        if fresh:
            a = _start(point, delta[i])
        else:
            more = delta[i] - delta[i - 1]
            a += more * (part + 0.5 * more * change)
        a = _divided(point, delta[i], a)
        state, part, change = _joined(point, delta[i], a)
        w[i], dw[i], c[i], dc[i] = state[0], state[1], state[0] * state[2], state[3]
        fresh = state[0] == 0.0


@njit(cache=True, error_model="numpy", fastmath=FAST)
def balanced_approach(point: Point, load: float) -> float:
    """Approach at which the inner contact carries a load, the outer one that and the centrifugal load."""
    approach: float = line_approach(point.inner, load) + line_approach(point.outer, load + point.centrifugal_load)
    return approach
