"""The law at run time: load, its derivative with approach and with rate, in compiled code.

Three functions are meant to be called from other compiled code, one point at a time and without allocation:

- `evaluate_at(point, delta, rate, counts)` for one speed, temperature and centrifugal load;
- `collapse(table, workspace, entrainment_speed, temperature, centrifugal_load, counts)` -> the `Point` for it;
- `evaluate(table, workspace, delta, rate, entrainment_speed, temperature, centrifugal_load, counts)`.

A bearing calls `collapse` once a time step and `evaluate_at` once a slice::

    point = collapse(law.table, workspace, u, T, q, counts)
    for j in range(slices):
        w, dw_ddelta, dw_drate = evaluate_at(point, delta[j], rate[j], counts)

or `ehdmaps.maps.bulk.evaluate_many_at` for all slices together, which is quicker still.

`counts` (int64, 4) is counted up at `LOAD`, `SPEED` or `TEMPERATURE` for arguments outside the map, whatever the
policy of the law, and at `NOT_FINITE`; speed and temperature are then held at the edge, and above the held load
the law is its tangent. The caller looks at the counts when its loop is done.

The state of a contact at rest is (w, dw/ddelta, c/w, dc/ddelta) throughout.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ehdmaps.maps.elementary import exp, log
from ehdmaps.maps.tables import (
    COLDEST,
    HALF_SPACE,
    LOAD,
    NOT_FINITE,
    SPEED,
    TEMPERATURE,
    ApproachTable,
    CountArray,
    LawTable,
    Line,
    Point,
)
from ehdmaps.physics._values import FloatArray

State = tuple[float, float, float, float]
Force = tuple[float, float, float]
Triple = tuple[float, float, float]
Quad = tuple[float, float, float, float]

LOAD_TOLERANCE = 1e-3
"""Part of the highest load by which a load may pass it: the error of a table, not of a caller."""

EDGE_TOLERANCE = 1e-6
"""Part of the highest speed, and of the temperatures, by which they may be passed: single precision."""

_FAST = {"contract", "reassoc", "nsz", "arcp"}
"""What the compiler may rearrange; NaN and infinity keep their meaning."""

_STEPS = 100
_LEAST_LOAD = 1e-200
_LIGHT = 0.3


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def quadratic_weights(t: float) -> Triple:
    """Quadratic B-splines around a node, at t steps from it, -1/2 <= t <= 1/2."""
    low, high = 0.5 - t, 0.5 + t
    return 0.5 * low * low, 0.75 - t * t, 0.5 * high * high


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def spline_weights(t: float) -> Quad:
    """Cubic B-splines over a cell, at its part t."""
    r = 1.0 - t
    tt, rr = t * t, r * r
    return (
        rr * r * (1.0 / 6.0),
        (2.0 / 3.0) - tt * (1.0 - 0.5 * t),
        (2.0 / 3.0) - rr * (1.0 - 0.5 * r),
        tt * t * (1.0 / 6.0),
    )


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def spline_slopes(t: float) -> Quad:
    """Derivatives of the cubic B-splines by t."""
    r = 1.0 - t
    return (-0.5 * r * r, t * (1.5 * t - 2.0), -r * (1.5 * r - 2.0), 0.5 * t * t)


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def place_within(x: float, cells: int) -> float:
    """Place x, in steps from the first node, held to so many cells; zero for NaN."""
    last = float(cells)
    x = x if x > 0.0 else 0.0
    return x if x < last else last


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def cell_of(x: float, cells: int) -> int:
    """Cell of a place within an axis."""
    return min(int(x), max(cells - 1, 0))


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def stretched(z: float) -> tuple[float, float]:
    """Return asinh(z), with a small absolute error, and its derivative."""
    root = math.sqrt(1.0 + z * z)
    size = log(abs(z) + root)
    return (size if z >= 0.0 else -size), 1.0 / root


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def state_of(g: float, dg: float, log_ratio: float, dlog_ratio: float) -> State:
    """State at rest from g, ln(c/w) and their derivatives by the approach; zero for g < 0."""
    g = g if g > 0.0 else 0.0
    w, dw = g * g * g, 3.0 * g * g * dg
    ratio = exp(log_ratio)
    return w, dw, ratio, ratio * (dw + w * dlog_ratio)


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def force_of(state: State, rate: float) -> Force:
    """Force at a rate: w (1 + x) with x = c rate/w, -w/(4 x) below x = -1/2, and its derivatives."""
    w, dw, ratio, dc = state
    x = ratio * rate
    moderate = x >= -0.5
    part = 1.0 + x if moderate else -0.25 / x
    return (
        w * part,
        dw + dc * rate if moderate else part * (2.0 * dw - dc / ratio),
        w * ratio if moderate else -w * part / rate,
    )


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def collapsed_row(
    values: FloatArray, i: int, j: int, along_u: Triple, along_t: Triple, k: int, count: int, sums: FloatArray
) -> None:
    """Collapse `count` neighbouring numbers from k on of the last axis, over 3 x 3 speeds and temperatures."""
    u0, u1, u2 = along_u
    t0, t1, t2 = along_t
    i0, j0, k0 = np.uint64(i), np.uint64(j), np.uint64(k)
    i1, i2 = i0 + np.uint64(1), i0 + np.uint64(2)
    j1, j2 = j0 + np.uint64(1), j0 + np.uint64(2)
    for n in range(count):
        m = k0 + np.uint64(n)
        v = values
        sums[n] = (
            u0 * (t0 * v[i0, j0, m] + t1 * v[i0, j1, m] + t2 * v[i0, j2, m])
            + u1 * (t0 * v[i1, j0, m] + t1 * v[i1, j1, m] + t2 * v[i1, j2, m])
            + u2 * (t0 * v[i2, j0, m] + t1 * v[i2, j1, m] + t2 * v[i2, j2, m])
        )


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def _line_state(line: Line, delta: float) -> State:
    """State of a line at an approach."""
    s, ds = stretched((delta - line.offset) * line.inverse_scale)
    cells = line.coefficients.shape[0]
    x = place_within((s - line.start) * line.step, cells)
    cell = cell_of(x, cells)
    t = x - cell
    g, dg, q, dq = cubics(line.coefficients, cell, t)
    scale = line.step * ds * line.inverse_scale
    return state_of(g, dg * scale, q, dq * scale)


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def cubics(coefficients: FloatArray, cell: int, t: float) -> tuple[float, float, float, float]:
    """Both cubics of a cell of a line, and their derivatives by t."""
    c, k = coefficients, np.uint64(cell)
    a1, a2, a3 = c[k, np.uint64(1)], c[k, np.uint64(2)], c[k, np.uint64(3)]
    b1, b2, b3 = c[k, np.uint64(5)], c[k, np.uint64(6)], c[k, np.uint64(7)]
    return (
        c[k, np.uint64(0)] + t * (a1 + t * (a2 + t * a3)),
        a1 + t * (2.0 * a2 + 3.0 * t * a3),
        c[k, np.uint64(4)] + t * (b1 + t * (b2 + t * b3)),
        b1 + t * (2.0 * b2 + 3.0 * t * b3),
    )


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _curvature(line: Line, delta: float, state: State) -> float:
    """Second derivative of the load of a line by the approach, where it carries load."""
    z = (delta - line.offset) * line.inverse_scale
    s, ds = stretched(z)
    c = line.coefficients
    x = place_within((s - line.start) * line.step, c.shape[0])
    i = cell_of(x, c.shape[0])
    g, _, _, _ = cubics(c, i, x - i)
    dg = state[1] / (3.0 * g * g)
    per_s = ds * line.inverse_scale
    ddg = (2.0 * c[i, 2] + 6.0 * (x - i) * c[i, 3]) * (line.step * per_s) ** 2 - dg * z * ds * per_s
    curvature: float = 6.0 * g * dg * dg + 3.0 * g * g * ddg
    return curvature


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _line_approach(line: Line, load: float) -> float:
    """Approach at which a line carries a load; the highest with none for zero."""
    c = line.coefficients
    wanted = math.pow(load, 1.0 / 3.0)
    low, high = 0, c.shape[0]
    while high - low > 1:
        middle = (low + high) // 2
        if c[middle, 0] <= wanted:
            low = middle
        else:
            high = middle
    left, right, t = 0.0, 1.0, 0.5
    for _ in range(_STEPS):
        g, slope, _, _ = cubics(c, low, t)
        if g > wanted:
            right = t
        else:
            left = t
        following = t - (g - wanted) / slope if slope > 0.0 else -1.0
        if not left <= following <= right:
            following = 0.5 * (left + right)
        moved = abs(following - t)
        t = following
        if moved < 1e-15:
            break
    approach: float = line.offset + math.sinh(line.start + (low + t) / line.step) / line.inverse_scale
    return approach


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def _structural(structure: FloatArray, centrifugal_load: float, load: float) -> tuple[float, float]:
    """Structural approach of the contacts at a load, and its derivative; the last one carries more."""
    approach = compliance = 0.0
    last = structure.shape[0] - 1
    for i in range(last + 1):
        w = load + centrifugal_load if i == last else load
        if w > _LEAST_LOAD:
            kind, a, b = structure[i, 0], structure[i, 1], structure[i, 2]
            if kind == HALF_SPACE:
                part = a * w * (b - 0.5 * log(w))
                compliance += part / w - 0.5 * a
            else:
                part = a * exp(b * log(w))
                compliance += b * part / w
            approach += part
    return approach, compliance


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _balanced_state(point: Point, delta: float) -> State:
    """State of a roller between its two contacts, the outer one carrying the centrifugal load besides.

    The approach divides into a and delta - a so that W_i(a) + q = W_o(delta - a): Newton's method in the logarithm
    of the loads, inside a closing bracket.
    """
    if delta <= point.lift_off:
        return 0.0, 0.0, 0.0, 0.0
    inner, outer, q = point.inner, point.outer, point.centrifugal_load
    low, high = _line_approach(inner, 0.0), delta - _line_approach(outer, q)
    scale = 1.0 / inner.inverse_scale
    state_i, state_o = _line_state(inner, high), _line_state(outer, point.outer_start)
    if state_i[0] < _LIGHT * q:  # the outer contact hardly moves
        a = high - state_i[0] / (state_i[1] + state_o[1])
    else:  # both alike, as their scales are
        share = outer.inverse_scale / (inner.inverse_scale + outer.inverse_scale)
        a = inner.offset + (delta - inner.offset - outer.offset) * share
    last = False
    for _ in range(_STEPS):
        if not low <= a <= high:
            a = 0.5 * (low + high)
        state_i, state_o = _line_state(inner, a), _line_state(outer, delta - a)
        if last:
            break
        if state_o[0] <= 0.0:
            high = a
            a = 0.5 * (low + high)
            continue
        excess = math.log((state_i[0] + q) / state_o[0])
        if excess > 0.0:
            high = a
        else:
            low = a
        step = excess / (state_i[1] / (state_i[0] + q) + state_o[1] / state_o[0])
        a -= step
        last = abs(step) <= 1e-9 * (abs(a) + scale)
    w, k_i, r_i, dc_i = state_i
    w_o, k_o, r_o, dc_o = state_o
    if w < _LEAST_LOAD or w_o < _LEAST_LOAD:
        return 0.0, 0.0, 0.0, 0.0
    part_i, part_o = k_o / (k_i + k_o), k_i / (k_i + k_o)
    c_i, c_o = w * r_i, w_o * r_o
    bend_i = _curvature(inner, a, state_i) * part_i
    bend_o = _curvature(outer, delta - a, state_o) * part_o
    change = (bend_o * k_i - k_o * bend_i) / (k_i + k_o) ** 2
    dc = dc_i * part_i**3 + dc_o * part_o**3 + 2.0 * change * (c_i * part_i - c_o * part_o)
    return w, k_i * part_i, r_i * part_i**2 + w_o / w * r_o * part_o**2, dc


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def _full_state(point: Point, delta: float) -> State:
    """State with the whole film."""
    if point.centrifugal_load > 0.0:
        return _balanced_state(point, delta)
    return _line_state(point.own, delta)


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def _faded_state(point: Point, delta: float) -> State:
    """State with a part of the film: film offset and c at equal load are that part of the whole ones.

    With the approach y of the whole film, (1 - part) E(w(y)) + part y = delta, E the structural approach.
    """
    part, structure, q = point.film, point.structure, point.centrifugal_load
    empty, _ = _structural(structure, q, 0.0)
    if delta <= (1.0 - part) * empty + part * point.lift_off:
        return 0.0, 0.0, 0.0, 0.0
    offset, scale = point.own.offset, 1.0 / point.own.inverse_scale
    low, _ = stretched((point.lift_off - offset) * point.own.inverse_scale)
    high, _ = stretched((delta - offset) * point.own.inverse_scale)
    high = max(high, low)
    place = high
    state = (0.0, 0.0, 0.0, 0.0)
    slope = 1.0
    last = False
    for _ in range(_STEPS):
        growth = exp(place)
        y = offset + 0.5 * scale * (growth - 1.0 / growth)
        state = _full_state(point, y)
        dry, compliance = _structural(structure, q, state[0])
        excess = (1.0 - part) * dry + part * y - delta
        slope = part
        if state[0] > 0.0:
            slope += (1.0 - part) * compliance * state[1]
        if last:
            break
        if excess > 0.0:
            high = place
        else:
            low = place
            if place >= high:  # only a table's error makes y > delta
                high = place + 1.0
        per_place = 0.5 * slope * scale * (growth + 1.0 / growth)
        following = place - excess / per_place if per_place > 0.0 else low - 1.0
        if not low <= following <= high:
            following = 0.5 * (low + high)
        last = abs(following - place) <= 1e-9
        place = following
    w, dw, ratio, dc = state
    if w < _LEAST_LOAD:
        return 0.0, 0.0, 0.0, 0.0
    return w, dw / slope, part * ratio, part * dc / slope


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _rest_state(point: Point, delta: float) -> State:
    """State at rest, before the hold above the highest load."""
    if point.film < 1.0:
        return _faded_state(point, delta)
    return _full_state(point, delta)


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def _held(point: Point, delta: float) -> State:
    """State on the tangent above the held load."""
    w = point.held_load + point.held_stiffness * (delta - point.held_approach)
    return w, point.held_stiffness, point.held_damping / w, 0.0


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def evaluate_at(point: Point, delta: float, rate: float, counts: CountArray) -> Force:
    """Load and derivatives at a point of speed, temperature and centrifugal load.

    Parameters
    ----------
    point : Point
        From `collapse`, or `LawAtPoint.point`.
    delta, rate : float
        Approach [m] and its rate [m/s].
    counts : array (4,)
        int64, counted up.

    Returns
    -------
    w, dw_ddelta, dw_drate : float
        [N/m], [N/m2], [N s/m2].
    """
    if not (abs(delta) < math.inf and abs(rate) < math.inf):
        counts[NOT_FINITE] += 1
        return math.nan, math.nan, math.nan
    if delta > point.held_approach:
        state = _held(point, delta)
    elif point.film == 1.0 and point.centrifugal_load == 0.0:
        state = _line_state(point.own, delta)
    else:
        state = _rest_state(point, delta)
    if state[0] <= 0.0:
        return 0.0, 0.0, 0.0
    if state[0] > point.highest_load * (1.0 + LOAD_TOLERANCE):
        counts[LOAD] += 1
    return force_of(state, rate)


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def place_of(table: ApproachTable, log_speed: float, temperature: float) -> tuple[int, float, int, float]:
    """Nearest nodes of a speed and a temperature, and the steps from them."""
    last_u, last_t = table.coefficients.shape[0] - 3, table.coefficients.shape[1] - 3
    x = place_within((log_speed - table.log_speed_start) * table.log_speed_step, last_u)
    cold = 1.0 / (temperature - COLDEST)
    y = place_within((cold - table.temperature_start) * table.temperature_step, last_t)
    i, j = int(x + 0.5), int(y + 0.5)
    return i, x - i, j, y - j


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _collapsed(
    table: ApproachTable, cubics: FloatArray, sums: FloatArray, log_speed: float, temperature: float
) -> Line:
    """A table at one speed and temperature, written into `cubics`."""
    i, t, j, r = place_of(table, log_speed, temperature)
    along_u, along_t = quadratic_weights(t), quadratic_weights(r)
    collapsed_row(table.place, i, j, along_u, along_t, 0, 2, sums)
    offset, inverse_scale = sums[0], sums[1]
    width = table.coefficients.shape[2]
    collapsed_row(table.coefficients, i, j, along_u, along_t, 0, width, sums)
    cells = width // 2 - 3
    for k in range(cells):
        for f in range(2):
            c0, c1, c2, c3 = sums[2 * k + f], sums[2 * k + 2 + f], sums[2 * k + 4 + f], sums[2 * k + 6 + f]
            cubics[k, 4 * f] = (c0 + 4.0 * c1 + c2) / 6.0
            cubics[k, 4 * f + 1] = 0.5 * (c2 - c0)
            cubics[k, 4 * f + 2] = 0.5 * (c0 + c2) - c1
            cubics[k, 4 * f + 3] = (c3 - c0) / 6.0 + 0.5 * (c1 - c2)
    return Line(cubics[:cells], offset, inverse_scale, table.start, table.step)


@njit(cache=True, error_model="numpy", forceinline=True)
def within_map(
    table: LawTable, entrainment_speed: float, temperature: float, counts: CountArray
) -> tuple[float, float]:
    """Size of the speed, and temperature, held at the edges of the map and counted outside."""
    speed = abs(entrainment_speed)
    if speed > table.counted_speed * (1.0 + EDGE_TOLERANCE):
        counts[SPEED] += 1
    low, high = table.lowest_temperature, table.highest_temperature
    if not low * (1.0 - EDGE_TOLERANCE) <= temperature <= high * (1.0 + EDGE_TOLERANCE):
        counts[TEMPERATURE] += 1
    return min(speed, table.highest_speed), min(max(temperature, low), high)


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def collapse(
    table: LawTable,
    workspace: FloatArray,
    entrainment_speed: float,
    temperature: float,
    centrifugal_load: float,
    counts: CountArray,
) -> Point:
    """Law at one speed, temperature and centrifugal load.

    Parameters
    ----------
    table : LawTable
        `ContactLaw.table`.
    workspace : array (4, n, 8)
        From `ContactLaw.workspace`; the `Point` lives in it until the next call with it.
    entrainment_speed, temperature, centrifugal_load : float
        u [m/s], T [K], q >= 0 [N/m]; finite.
    counts : array (4,)
        int64, counted up.
    """
    speed, temperature = within_map(table, entrainment_speed, temperature, counts)
    part = min(speed / table.film_speed, 1.0)
    film = part * part * part * (10.0 - part * (15.0 - 6.0 * part))
    log_speed = log(max(speed, table.lowest_speed))
    q = centrifugal_load
    if q >= table.held_load:
        counts[LOAD] += 1
        q = 0.5 * table.held_load
    held_load = table.held_load - q
    sums = workspace[3].reshape(-1)
    own = _collapsed(table.own, workspace[0], sums, log_speed, temperature)
    inner, outer, inner_lift_off, outer_start = own, own, 0.0, 0.0
    if q > 0.0:
        inner = _collapsed(table.inner, workspace[1], sums, log_speed, temperature)
        outer = _collapsed(table.outer, workspace[2], sums, log_speed, temperature)
        inner_lift_off, outer_start = _line_approach(inner, 0.0), _line_approach(outer, q)
        lift_off = inner_lift_off + outer_start
        held = _line_approach(inner, held_load) + _line_approach(outer, table.held_load)
    else:
        lift_off = _line_approach(own, 0.0)
        held = _line_approach(own, held_load)
    dry, compliance = _structural(table.structure, q, held_load)
    held = (1.0 - film) * dry + film * held
    unheld = Point(
        own, inner, outer, table.structure, film, q, inner_lift_off, outer_start, lift_off,
        table.highest_load - q, held_load, held, 1.0 / compliance, 0.0,
    )  # fmt: skip
    _, _, ratio, _ = _rest_state(unheld, held)
    return Point(
        own, inner, outer, table.structure, film, q, inner_lift_off, outer_start, lift_off,
        table.highest_load - q, held_load, held, 1.0 / compliance, ratio * held_load,
    )  # fmt: skip


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def _table_state(table: ApproachTable, delta: float, log_speed: float, temperature: float, sums: FloatArray) -> State:
    """State of a table at an approach, speed and temperature within it; `sums` is scratch for 8 numbers."""
    i, t, j, r = place_of(table, log_speed, temperature)
    along_u, along_t = quadratic_weights(t), quadratic_weights(r)
    collapsed_row(table.place, i, j, along_u, along_t, 0, 2, sums)
    inverse_scale = sums[1]
    s, ds = stretched((delta - sums[0]) * inverse_scale)
    cells = table.coefficients.shape[2] // 2 - 3
    x = place_within((s - table.start) * table.step, cells)
    k = cell_of(x, cells)
    collapsed_row(table.coefficients, i, j, along_u, along_t, 2 * k, 8, sums)
    g, dg, q, dq = splines(sums, x - k)
    scale = table.step * ds * inverse_scale
    return state_of(g, dg * scale, q, dq * scale)


@njit(cache=True, error_model="numpy", fastmath=_FAST, forceinline=True)
def splines(sums: FloatArray, t: float) -> tuple[float, float, float, float]:
    """Both splines from their coefficients side by side, and their derivatives by t."""
    b0, b1, b2, b3 = spline_weights(t)
    d0, d1, d2, d3 = spline_slopes(t)
    return (
        b0 * sums[0] + b1 * sums[2] + b2 * sums[4] + b3 * sums[6],
        d0 * sums[0] + d1 * sums[2] + d2 * sums[4] + d3 * sums[6],
        b0 * sums[1] + b1 * sums[3] + b2 * sums[5] + b3 * sums[7],
        d0 * sums[1] + d1 * sums[3] + d2 * sums[5] + d3 * sums[7],
    )


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _through_point(
    table: LawTable,
    workspace: FloatArray,
    delta: float,
    rate: float,
    entrainment_speed: float,
    temperature: float,
    centrifugal_load: float,
    counts: CountArray,
) -> Force:
    """`evaluate` by way of `collapse`."""
    point = collapse(table, workspace, entrainment_speed, temperature, centrifugal_load, counts)
    return evaluate_at(point, delta, rate, counts)


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def evaluate(
    table: LawTable,
    workspace: FloatArray,
    delta: float,
    rate: float,
    entrainment_speed: float,
    temperature: float,
    centrifugal_load: float,
    counts: CountArray,
) -> Force:
    """Load and derivatives; arguments and results as of `evaluate_at` and `collapse`.

    Below the lowest mapped speed, with a centrifugal load and outside the map it collapses the table first, which
    costs some microseconds.
    """
    finite = abs(delta) < math.inf and abs(rate) < math.inf and abs(entrainment_speed) < math.inf
    if not (finite and abs(temperature) < math.inf and abs(centrifugal_load) < math.inf):
        counts[NOT_FINITE] += 1
        return math.nan, math.nan, math.nan
    speed = abs(entrainment_speed)
    if (
        table.film_speed <= speed <= table.counted_speed
        and table.lowest_temperature <= temperature <= table.highest_temperature
        and centrifugal_load == 0.0
    ):
        state = _table_state(table.own, delta, log(speed), temperature, workspace[3, 0])
        if state[0] <= table.highest_load:
            return force_of(state, rate)
    return _through_point(table, workspace, delta, rate, entrainment_speed, temperature, centrifugal_load, counts)
