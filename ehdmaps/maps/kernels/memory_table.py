"""A contact whose film has a memory, as arrays at one speed and temperature.

A film answers a change of load with a delay. Its state is xi, the approach at which it would be in equilibrium; the
load of that equilibrium is p(xi). Approach and load w of the contact are

    delta = a(w) + y(p),          w = x + sqrt(x^2 + p^2),    x = G',    dG/dxi = C = c k_s/(k_s - k).

a is what answers at once: the structure, and the little by which oil that cannot leave the inlet stiffens it,
da/dw = 1/k_s. y is what follows: y(p) = xi - a(p), so that at rest w = p and delta = xi, the law of the map. To first
order w = p + x, and a small oscillation sees k + i omega c/(1 + i omega c/(k_s - k)): k and c of the map at low
frequency, k_s at high frequency. w follows the exact load of rigid rollers that are squeezed while they roll
(x + sqrt(x^2 + p^2) within 3 %), is never a tension, and rises with x.

Why it is passive: a and y rise with their arguments (k_s > k > 0), and w - p has the sign of x, which is that of p'.
So the work is w da + p dy + (w - p) dy: the first two are stored, the last one is never negative. Taken by backward
Euler, or by any rate x with the sign of the change of G, this holds for steps of any size.

The table has p, y and G over xi in cells which are the binary digits of 1 + |z|, z = (xi - centre)/scale, and a over w
in cells which are those of 1 + w/`LIGHTEST`: no logarithm is needed to find one. All are cubics through values and
slopes that rise.

The stiffness k_s of the locked film and its bound: `ehdmaps.maps.kernels.locked_film`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.kernel import evaluate_at, structural_state
from ehdmaps.maps.kernels.lines import FAST
from ehdmaps.maps.kernels.locked_film import Film, LockedFactors, factor_at, locked_stiffness
from ehdmaps.maps.kernels.tables import FIRST, SHIFT, Point, last_of, nodes_of, rows_of

LIGHTEST = 1.0
"""Load up to which the cells of a over w are even [N/m]."""

ROWS, LOAD_ROWS = rows_of(14), rows_of(24)
"""Cells on each side of the centre, and of the load."""

NODES, LOAD_NODES = nodes_of(ROWS), nodes_of(LOAD_ROWS)
"""Ends of the cells."""

_LAST, _LAST_LOAD = last_of(NODES), last_of(LOAD_NODES)
_LEAST_DAMPING, _LEAST_FILM = 1e-12, 1e-9
_STEPS = 60
_EXACT = 1e-13
_NO_CHANGE = 1e-30
_NOTHING = 1e-60


class MemoryTable(NamedTuple):
    """A contact with memory at one speed and temperature.

    Attributes
    ----------
    cells : array (2 ROWS, 12)
        Cubics over the distance in scales from the end of a cell that is nearer to the centre: four coefficients of p
        [N/m], of y [m] and of G [N s/m2].
    load_cells : array (LOAD_ROWS, 4)
        Cubics of a [m] over the distance from the lower end of a cell, in `LIGHTEST`.
    centre, inverse_scale : float
        Centre and inverse scale of the cells [m], [1/m].
    lift_off : float
        Highest end of a cell without load [m]: below it nothing changes, load and slopes are zero there.
    """

    cells: FloatArray
    load_cells: FloatArray
    centre: float
    inverse_scale: float
    lift_off: float


@njit(error_model="numpy")
def _cubic(y0: float, y1: float, s0: float, s1: float, h: float, out: FloatArray) -> None:
    """Cubic through values and slopes at the ends of a cell; slopes are held so that it rises if the values do."""
    secant = (y1 - y0) / h
    s0, s1 = min(max(s0, 0.0), 3.0 * secant), min(max(s1, 0.0), 3.0 * secant)
    out[0], out[1] = y0, s0
    out[2] = (3.0 * secant - 2.0 * s0 - s1) / h
    out[3] = (s0 + s1 - 2.0 * secant) / (h * h)


@njit(error_model="numpy")
def fill_memory(
    point: Point, film: Film, factors: LockedFactors, nodes: FloatArray, load_nodes: FloatArray, cells: FloatArray,
    load_cells: FloatArray, counts: IntArray,
) -> MemoryTable:  # fmt: skip
    """Fill a table with the law of a point.

    Parameters
    ----------
    point : Point
        The law at one speed and temperature, without centrifugal load.
    film : Film
        Film for the stiffness of the locked film.
    factors : LockedFactors
        Factors of its closed formula.
    nodes, load_nodes : array (ROWS + 1,), (LOAD_ROWS + 1,)
        `NODES`, `LOAD_NODES`.
    cells, load_cells : array (2 ROWS, 12), (LOAD_ROWS, 4)
        Cells, which are filled.
    counts : array (4,)
        int64, counted up outside the map.
    """
    rows = nodes.size - 1
    size = 2 * rows + 1
    # a faded film takes its part of the offset, and of the approach of lift-off
    centre, inverse = point.film * point.own.offset, point.own.inverse_scale
    lift_off = point.film * point.lift_off
    z, xi = np.empty(size), np.empty(size)
    p, k, c = np.zeros(size), np.zeros(size), np.zeros(size)
    y, sum_g, by_y, by_c = np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size)
    beyond, slope_beyond = np.zeros(size), np.zeros(size)
    for i in range(size):
        z[i] = nodes[i - rows] - 1.0 if i >= rows else 1.0 - nodes[rows - i]
        xi[i] = centre + z[i] / inverse
        p[i], k[i], c[i] = evaluate_at(point, xi[i], 0.0, counts)
        y[i], by_y[i] = xi[i], 1.0
        if p[i] <= 0.0:
            # Higher up in the cell that begins here its cubics have some load: the law lifts off within the cell.
            lift_off = xi[i]
        else:
            dry, compliance = structural_state(point.structure, 0.0, p[i])
            c[i] = max(c[i], _LEAST_DAMPING * k[i])
            factor = factor_at(factors, p[i])
            stiff = locked_stiffness(film, dry - xi[i], p[i], k[i], c[i], compliance, factor)
            by_y[i] = 1.0 - k[i] / stiff
            # without film nothing is squeezed
            by_c[i] = c[i] / by_y[i] if by_y[i] > _LEAST_FILM else 0.0
            slope_beyond[i] = 1.0 / stiff - compliance
            before = p[i - 1] if i > 0 else 0.0
            slope_before = slope_beyond[i - 1] if before > 0.0 else slope_beyond[i]
            last = beyond[i - 1] if i > 0 else 0.0
            beyond[i] = last + 0.5 * (slope_before + slope_beyond[i]) * (p[i] - before)
            y[i] = xi[i] - dry - beyond[i]
        if i > 0:
            y[i] = max(y[i], y[i - 1])  # it rises, but for rounding where the film hardly gives way
            sum_g[i] = sum_g[i - 1] + 0.5 * (by_c[i - 1] + by_c[i]) * (xi[i] - xi[i - 1])
    for side in range(2):
        for row in range(rows):
            near, far = (rows + row, rows + row + 1) if side == 0 else (rows - row, rows - row - 1)
            h = z[far] - z[near]
            out = cells[side * rows + row]
            _cubic(p[near], p[far], k[near] / inverse, k[far] / inverse, h, out[0:4])
            _cubic(y[near], y[far], by_y[near] / inverse, by_y[far] / inverse, h, out[4:8])
            _cubic(sum_g[near], sum_g[far], by_c[near] / inverse, by_c[far] / inverse, h, out[8:12])
    _fill_loads(point, p, beyond, slope_beyond, load_nodes, load_cells)
    return MemoryTable(cells, load_cells, centre, inverse, lift_off)


@njit(error_model="numpy")
def _fill_loads(
    point: Point, p: FloatArray, beyond: FloatArray, slopes: FloatArray, nodes: FloatArray, load_cells: FloatArray
) -> None:
    """Cells of a(w), the structure and what is `beyond` it: a function of the loads p with these slopes."""
    first = 0
    while first < p.size - 1 and p[first + 1] <= 0.0:
        first += 1
    i, before, slope_before = first, 0.0, math.inf
    for row in range(1, nodes.size):
        load = LIGHTEST * (nodes[row] - 1.0)
        while i + 2 < p.size and p[i + 1] < load:
            i += 1
        dry, compliance = structural_state(point.structure, 0.0, load)
        begin = slopes[i] if p[i] > 0.0 else slopes[i + 1]
        # straight between two nodes, and the last slope goes on
        t = min((load - p[i]) / (p[i + 1] - p[i]), 1.0)
        slope = begin + t * (slopes[i + 1] - begin)
        more = beyond[i] + 0.5 * (begin + slope) * min(load - p[i], p[i + 1] - p[i]) + slope * max(load - p[i + 1], 0.0)
        value, per_load = dry + more, (compliance + slope) * LIGHTEST
        _cubic(before, value, slope_before, per_load, nodes[row] - nodes[row - 1], load_cells[row - 1])
        before, slope_before = value, per_load


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def state_cell(table: MemoryTable, xi: float) -> tuple[int, float]:
    """Row of the cells in which a state is, and its place there."""
    z = (xi - table.centre) * table.inverse_scale
    a = 1.0 + abs(z)
    a = a if a < _LAST else _LAST
    cell = np.uint64(np.float64(a).view(np.uint64) >> SHIFT)
    t = a - np.uint64(cell << SHIFT).view(np.float64)
    row = int(np.int64(cell) - FIRST)
    return (row, t) if z >= 0.0 else (row + ROWS, -t)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def cubic_at(c: FloatArray, first: int, t: float) -> tuple[float, float]:
    """Value and slope of a cubic.

    Parameters
    ----------
    c : array
        Coefficients of a cell.
    first : int
        Index of the first coefficient of this cubic.
    t : float
        Place in the cell.
    """
    high = c[first + 3]
    bend = c[first + 2] + t * high
    mean = c[first + 1] + t * bend
    return c[first] + t * mean, mean + t * (bend + t * high)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def load_cell(load: float) -> tuple[int, float]:
    """Row of the cells of a in which a load w >= 0 is, and its place there."""
    a = 1.0 + load / LIGHTEST
    a = a if a < _LAST_LOAD else _LAST_LOAD
    cell = np.uint64(np.float64(a).view(np.uint64) >> SHIFT)
    return int(np.int64(cell) - FIRST), a - np.uint64(cell << SHIFT).view(np.float64)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def approach_at(table: MemoryTable, load: float) -> tuple[float, float]:
    """Approach a of a load w >= 0, and da/dw = 1/k_s."""
    row, t = load_cell(load)
    a, slope = cubic_at(table.load_cells[row], 0, t)
    return a, slope / LIGHTEST


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def load_of(p: float, dp: float, x: float, dx: float) -> tuple[float, float]:
    """w = x + sqrt(x^2 + p^2), without cancellation, and its derivative.

    Parameters
    ----------
    p, dp : float
        Load of the equilibrium [N/m], and its derivative.
    x, dx : float
        Rate of squeezing G' [N/m], and its derivative.
    """
    root = math.sqrt(x * x + p * p + _NOTHING)
    w = x + root if x >= 0.0 else p * p / (root - x)
    return w, (w * dx + p * dp) / root


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def equilibrium_at(table: MemoryTable, xi: float) -> tuple[float, float, float, float, float, float]:
    """p, y and G of a state, each with its slope."""
    row, t = state_cell(table, xi)
    c, per = table.cells[row], table.inverse_scale
    p, dp = cubic_at(c, 0, t)
    y, dy = cubic_at(c, 4, t)
    g, dg = cubic_at(c, 8, t)
    return p, dp * per, y, dy * per, g, dg * per


class Step(NamedTuple):
    """A step in time, as the method of integration sees it.

    Attributes
    ----------
    rate : float
        1/h [1/s].
    ahead, back : float
        Weights of the change of G over this step and over the last one: (1 + 2 r)/(1 + r) and r^2/(1 + r) with the
        ratio r of the steps for backward differences of second order; 1 and 0 for backward Euler.
    """

    rate: float
    ahead: float
    back: float


MOST_GROWTH = 1.2
"""Ratio of a step to the last one above which backward Euler takes it: what follows would no longer rise."""


@njit(error_model="numpy")
def step_of(h: float, last: float) -> Step:
    """Weights of a step of h [s] after one of `last` [s]; 0 or less if there was none."""
    if last <= 0.0 or h > MOST_GROWTH * last:
        return Step(1.0 / h, 1.0, 0.0)
    r = h / last
    return Step(1.0 / h, (1.0 + 2.0 * r) / (1.0 + r), r * r / (1.0 + r))


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def fading_of(last: float) -> float:
    """1.5 by the size of the last change of G: what `rate_of` fades with [1/(N s/m2)]."""
    return 1.5 / (abs(last) + _NO_CHANGE)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def rate_of(step: Step, change: float, last: float, fading: float) -> tuple[float, float]:
    """x = G' at the end of a step by the changes of G over it and over the last step, and dx/dG.

    Backward differences of second order, but where the change falls below two thirds of the last one, at turning
    points, the share of the last one fades with it. So x has the sign of the change, whatever the step, and rises with
    it.

    Parameters
    ----------
    step : Step
        How long.
    change, last : float
        Changes of G over this step and over the last one [N s/m2].
    fading : float
        `fading_of` the last one.
    """
    t = abs(change) * fading
    t = t if t < 1.0 else 1.0
    turn = 9.0 * t * (1.0 - t)
    return (
        step.rate * (step.ahead * change - step.back * last * t * t * (3.0 - 2.0 * t)),
        step.rate * (step.ahead - step.back * (turn if change * last >= 0.0 else -turn)),
    )


@njit(error_model="numpy", fastmath=FAST)
def advanced(
    table: MemoryTable, step: Step, delta: float, before: float, last: float, start: float
) -> tuple[float, float, float]:
    """Load, its derivative by the approach, and the state, at the end of a step.

    Parameters
    ----------
    table : MemoryTable
        The contact.
    step : Step
        How long.
    delta : float
        Approach at the end of the step [m].
    before : float
        G at its beginning [N s/m2].
    last : float
        Change of G over the step before [N s/m2].
    start : float
        State at its beginning, where the state is looked for first [m].

    Returns
    -------
    w, tangent, xi : float
        [N/m], dw/ddelta [N/m2], [m].
    """
    left = table.lift_off
    xi = start if start > left else left
    # A film that is squeezed lags behind the approach, one that is relieved behind its last state: the state is not
    # above both, but for what cubics miss. Without that bound a film that has ended, whose y rises by rounding alone,
    # sends Newton's first step beyond the table.
    right = max(delta, xi)
    right += right - left
    w = tangent = 0.0
    before_last = moved = math.inf
    fading = fading_of(last)
    for _ in range(_STEPS):
        p, dp, y, dy, g, dg = equilibrium_at(table, xi)
        x, dx = rate_of(step, g - before, last, fading)
        w, slope = load_of(p, dp, x, dx * dg)
        stretched, compliance = approach_at(table, w)
        rise = compliance * slope + dy
        short = delta - stretched - y
        # zero, but for rounding, where the film has ended
        tangent = slope / rise if slope > 0.0 and rise > 0.0 else 0.0
        if short > 0.0:
            left = xi
        else:
            right = xi
        following = xi + short / rise if rise != 0.0 else math.inf
        # bisection where Newton's steps leave the bracket or do not shrink
        if not (left <= following <= right and 2.0 * abs(following - xi) <= before_last):
            following = 0.5 * (left + right)
        before_last, moved = moved, abs(following - xi)
        if moved * table.inverse_scale <= _EXACT * (1.0 + abs(xi - table.centre) * table.inverse_scale):
            break
        xi = following
    return w, tangent, xi
