"""Splines of a table and of a line, and the states of a contact that they give, in compiled code.

The state of a contact at rest is (w, dw/ddelta, c/w, dc/ddelta) throughout.

exp and log are own ones that the compiler can put into vector instructions, without a branch or a call: the textbook
reductions with Taylor series long enough for double precision, exp to 4e-16 relative for |x| < 700, log to 3e-16
absolute or relative for positive normal numbers.

Loads at which films end are arrays as of `ehdmaps.maps.ends`.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.tables import COLDEST, ApproachTable, Line
from ehdmaps.physics.contact import Force
from ehdmaps.physics.contact import unilateral_force as rule

_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_LOG2_E = 1.4426950408889634
_BIAS = np.uint64(1023 << 52)
_ROOT_HALF = np.uint64(0x3FE6A09E667F3BCD)
_WHOLE = np.uint64(0x4330000000000000)
_WHOLE_VALUE = 2.0**52 + 1023.0
_MANTISSA = np.uint64(52)


@njit(error_model="numpy", fastmath={"contract", "nsz"}, forceinline=True)
def exp(x: float) -> float:
    """e^x for |x| < 700; held there beyond."""
    x = x if x > -700.0 else -700.0
    x = x if x < 700.0 else 700.0
    n = math.floor(x * _LOG2_E + 0.5)
    r = (x - n * _LN2_HIGH) - n * _LN2_LOW
    r2 = r * r
    r4 = r2 * r2
    low = (1.0 + r) + r2 * (1.0 / 2.0 + r * (1.0 / 6.0))
    middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0))
    high = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + r2 * (1.0 / 3628800.0 + r * (1.0 / 39916800.0))
    last = 1.0 / 479001600.0 + r * (1.0 / 6227020800.0)
    series = low + r4 * (middle + r4 * (high + r4 * last))
    power: float = np.int64((np.int64(n) + 1023) << 52).view(np.float64)
    return series * power


@njit(error_model="numpy", fastmath={"contract", "nsz"}, forceinline=True)
def log(x: float) -> float:
    """Natural logarithm of a positive normal number."""
    bits = np.float64(x).view(np.uint64)
    # Sums in this order never leave the 64 bits, of which numpy warns where kernels run as Python.
    exponent = (bits + (_BIAS - _ROOT_HALF)) >> _MANTISSA
    e = np.uint64(exponent | _WHOLE).view(np.float64) - _WHOLE_VALUE
    m = np.uint64(bits + _BIAS - (exponent << _MANTISSA)).view(np.float64)
    f = (m - 1.0) / (m + 1.0)
    z = f * f
    z2 = z * z
    z4 = z2 * z2
    low = (2.0 / 3.0 + z * (2.0 / 5.0)) + z2 * (2.0 / 7.0 + z * (2.0 / 9.0))
    high = (2.0 / 11.0 + z * (2.0 / 13.0)) + z2 * (2.0 / 15.0 + z * (2.0 / 17.0))
    series = low + z4 * (high + z4 * (2.0 / 19.0 + z * (2.0 / 21.0)))
    value: float = e * _LN2_HIGH + (e * _LN2_LOW + f * (2.0 + z * series))
    return value


State = tuple[float, float, float, float]
Triple = tuple[float, float, float]
Quad = tuple[float, float, float, float]

FAST = {"contract", "reassoc", "nsz", "arcp"}
"""What the compiler may rearrange; NaN and infinity keep their meaning."""

_STEPS = 100

unilateral_force = njit(error_model="numpy", fastmath=FAST, forceinline=True)(rule)
"""The rule without tension, compiled as the kernels are that it becomes a part of."""


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def quadratic_weights(t: float) -> Triple:
    """Quadratic B-splines around a node, at t steps from it, -1/2 <= t <= 1/2."""
    low, high = 0.5 - t, 0.5 + t
    return 0.5 * low * low, 0.75 - t * t, 0.5 * high * high


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
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


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def spline_slopes(t: float) -> Quad:
    """Derivatives of the cubic B-splines by t."""
    r = 1.0 - t
    return (-0.5 * r * r, t * (1.5 * t - 2.0), -r * (1.5 * r - 2.0), 0.5 * t * t)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def place_within(x: float, cells: int) -> float:
    """Place x, in steps from the first node, held to so many cells; zero for NaN."""
    last = float(cells)
    x = x if x > 0.0 else 0.0
    return x if x < last else last


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def cell_of(x: float, cells: int) -> int:
    """Cell of a place within an axis."""
    return min(int(x), max(cells - 1, 0))


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def stretched(z: float) -> tuple[float, float]:
    """Return asinh(z), with a small absolute error, and its derivative."""
    root = math.sqrt(1.0 + z * z)
    size = log(abs(z) + root)
    return (size if z >= 0.0 else -size), 1.0 / root


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def state_of(g: float, dg: float, log_ratio: float, dlog_ratio: float) -> State:
    """State at rest from g, ln(c/w) and their derivatives by the approach; zero for g < 0.

    Parameters
    ----------
    g : float
        g, the cube root of the load [(N/m)^(1/3)]; no load below 0.
    dg : float
        Derivative of g by the approach.
    log_ratio : float
        ln(c/w).
    dlog_ratio : float
        Derivative of the logarithm of the ratio by the approach.
    """
    g = g if g > 0.0 else 0.0
    w, dw = g * g * g, 3.0 * g * g * dg
    ratio = exp(log_ratio)
    return w, dw, ratio, ratio * (dw + w * dlog_ratio)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def force_of(state: State, rate: float) -> Force:
    """Force of a state at a rate, and its derivatives, see `ehdmaps.physics.contact`."""
    w, dw, ratio, dc = state
    force: Force = unilateral_force(w, dw, w * ratio, dc, rate)
    return force


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
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


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def cubics(coefficients: FloatArray, cell: int, t: float) -> tuple[float, float, float, float]:
    """Both cubics of a cell of a line, and their derivatives by t.

    Parameters
    ----------
    coefficients : ndarray
        Coefficients of the line, cell by cell.
    cell : int
        Index of the cell.
    t : float
        Place in the cell, 0 to 1.
    """
    c, k = coefficients, np.uint64(cell)
    a1, a2, a3 = c[k, np.uint64(1)], c[k, np.uint64(2)], c[k, np.uint64(3)]
    b1, b2, b3 = c[k, np.uint64(5)], c[k, np.uint64(6)], c[k, np.uint64(7)]
    return (
        c[k, np.uint64(0)] + t * (a1 + t * (a2 + t * a3)),
        a1 + t * (2.0 * a2 + 3.0 * t * a3),
        c[k, np.uint64(4)] + t * (b1 + t * (b2 + t * b3)),
        b1 + t * (2.0 * b2 + 3.0 * t * b3),
    )


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
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


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def place_of(table: ApproachTable, log_speed: float, temperature: float) -> tuple[int, float, int, float]:
    """Nearest nodes of a speed and a temperature, and the steps from them.

    Parameters
    ----------
    table : ApproachTable
        The table.
    log_speed : float
        ln u, u in m/s.
    temperature : float
        T [K].
    """
    last_u, last_t = table.coefficients.shape[0] - 3, table.coefficients.shape[1] - 3
    x = place_within((log_speed - table.log_speed_start) * table.log_speed_step, last_u)
    cold = 1.0 / (temperature - COLDEST)
    y = place_within((cold - table.temperature_start) * table.temperature_step, last_t)
    i, j = int(x + 0.5), int(y + 0.5)
    return i, x - i, j, y - j


@njit(error_model="numpy", fastmath=FAST)
def collapsed_line(
    table: ApproachTable, cubics: FloatArray, sums: FloatArray, log_speed: float, temperature: float
) -> Line:
    """A table at one speed and temperature, written into `cubics`.

    Parameters
    ----------
    table : ApproachTable
        The table.
    cubics : ndarray
        Array that the cubics of the line are written to.
    sums : ndarray
        Scratch space.
    log_speed : float
        ln u, u in m/s.
    temperature : float
        T [K].
    """
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


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def table_state(table: ApproachTable, delta: float, log_speed: float, temperature: float, sums: FloatArray) -> State:
    """State of a table at an approach, speed and temperature within it; `sums` is scratch for 8 numbers.

    Parameters
    ----------
    table : ApproachTable
        The table.
    delta : float
        Approach [m].
    log_speed : float
        ln u, u in m/s.
    temperature : float
        T [K].
    sums : ndarray
        Scratch, shape (8,).
    """
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


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def line_state(line: Line, delta: float) -> State:
    """State of a line at an approach."""
    s, ds = stretched((delta - line.offset) * line.inverse_scale)
    cells = line.coefficients.shape[0]
    x = place_within((s - line.start) * line.step, cells)
    cell = cell_of(x, cells)
    t = x - cell
    g, dg, q, dq = cubics(line.coefficients, cell, t)
    scale = line.step * ds * line.inverse_scale
    return state_of(g, dg * scale, q, dq * scale)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def line_load(line: Line, delta: float) -> tuple[float, float]:
    """Load of a line at an approach, and its slope: all that an equilibrium of contacts asks for."""
    s, ds = stretched((delta - line.offset) * line.inverse_scale)
    c = line.coefficients
    x = place_within((s - line.start) * line.step, c.shape[0])
    cell = cell_of(x, c.shape[0])
    k, t = np.uint64(cell), x - cell
    a1, a2, a3 = c[k, np.uint64(1)], c[k, np.uint64(2)], c[k, np.uint64(3)]
    g = c[k, np.uint64(0)] + t * (a1 + t * (a2 + t * a3))
    dg = (a1 + t * (2.0 * a2 + 3.0 * t * a3)) * (line.step * ds * line.inverse_scale)
    g = g if g > 0.0 else 0.0
    return g * g * g, 3.0 * g * g * dg


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def bent_state(line: Line, delta: float) -> tuple[State, float]:
    """State of a line at an approach, and the second derivative of its load by the approach.

    Parameters
    ----------
    line : Line
        The line.
    delta : float
        Approach [m].
    """
    z = (delta - line.offset) * line.inverse_scale
    s, ds = stretched(z)
    c = line.coefficients
    x = place_within((s - line.start) * line.step, c.shape[0])
    cell = cell_of(x, c.shape[0])
    k, t = np.uint64(cell), x - cell
    g, dg, q, dq = cubics(c, cell, t)
    per_s = ds * line.inverse_scale
    scale = line.step * per_s
    dg *= scale
    ddg = (2.0 * c[k, np.uint64(2)] + 6.0 * t * c[k, np.uint64(3)]) * (scale * scale) - dg * z * ds * per_s
    g = g if g > 0.0 else 0.0
    return state_of(g, dg, q, dq * scale), 6.0 * g * dg * dg + 3.0 * g * g * ddg


@njit(error_model="numpy", fastmath=FAST)
def line_approach(line: Line, load: float) -> float:
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


@njit(error_model="numpy", fastmath=FAST)
def _between(nodes: FloatArray, place: float) -> tuple[int, int, float]:
    """Nodes beside a place, and the weight of the second one."""
    last = nodes.size - 1
    if not place > nodes[0]:
        return 0, 0, 0.0
    if place >= nodes[last]:
        return last, last, 0.0
    i = 0
    while nodes[i + 1] <= place:
        i += 1
    return i, i + 1, (place - nodes[i]) / (nodes[i + 1] - nodes[i])


@njit(error_model="numpy", fastmath=FAST)
def end_at(ends: FloatArray, log_speed: float, temperature: float) -> float:
    """Load at which films end at a speed and temperature [N/m].

    Parameters
    ----------
    ends : array (1 + n_u, 1 + n_T)
        Ends of the loads.
    log_speed, temperature : float
        ln u, u in m/s, and T [K].
    """
    i, up, a = _between(ends[1:, 0], log_speed)
    j, on, b = _between(ends[0, 1:], temperature)
    corner: float = ends[1 + i, 1 + j]
    if ends[1 + i, 1 + on] == corner and ends[1 + up, 1 + j] == corner and ends[1 + up, 1 + on] == corner:
        return corner
    low = (1.0 - b) * log(corner) + b * log(ends[1 + i, 1 + on])
    high = (1.0 - b) * log(ends[1 + up, 1 + j]) + b * log(ends[1 + up, 1 + on])
    found: float = exp((1.0 - a) * low + a * high)
    return found
