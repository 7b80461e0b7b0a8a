"""Force, stiffness and damping of a bearing in compiled code, without allocation.

`bearing_force` is what other compiled code calls; the arrays for it are those of a `ForceAtPoint` of
`mbs.bearings.force_at_point`. Rollers are the first axis of the work arrays, slices the last. The steps are loops of
their own over few arrays, so that all but the reading of the table run in vector instructions.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.maps.kernel import evaluate_at
from ehdmaps.maps.lines import FAST, unilateral_force
from ehdmaps.maps.tables import LOAD, Point
from mbs.bearings.powers import power
from mbs.bearings.slice_table import (
    CELLS,
    CENTRE,
    COEFFICIENT,
    DAMPING,
    EXPONENT,
    FIRST,
    HIGHEST,
    INVERSE_SCALE,
    KIND,
    LAST,
    LIFT_OFF,
    ROWS,
    SAFE_APPROACH,
    SHIFT,
    SLOPE,
    read_cells,
)

NOT_FINITE, TOO_FAR = -1, -2
"""What `bearing_force` returns for values that are no finite numbers, and for poses beyond reason."""

HALF_CLEARANCE, SLICE_LENGTH, MOST_TRAVEL, MOST_TILT, HALF_LENGTH, LEAST_LOST = range(6)
"""Places in the array `geometry`."""

_NO_APPROACH = 1e-30

COS, SIN, GAP, TILT, RATE, TILT_RATE, DEEPEST = range(7)
"""Rows of the array `rollers`: direction of each roller, approach and tilt over the slices, their rates, and a
bound that no approach of a slice is above."""


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _place_rollers(state: FloatArray, geometry: FloatArray, angles: FloatArray, rollers: FloatArray) -> None:
    """Directions of the rollers and their motion, from pose, velocity and cage angle in `state` (13,)."""
    c, s = math.cos(state[12]), math.sin(state[12])
    for j in range(angles.shape[1]):
        cos = c * angles[0, j] - s * angles[1, j]
        sin = s * angles[0, j] + c * angles[1, j]
        rollers[COS, j], rollers[SIN, j] = cos, sin
        rollers[GAP, j] = state[1] * cos + state[2] * sin - geometry[HALF_CLEARANCE]
        rollers[TILT, j] = state[5] * cos - state[4] * sin
        rollers[RATE, j] = state[7] * cos + state[8] * sin
        rollers[TILT_RATE, j] = state[11] * cos - state[10] * sin
        reach = geometry[HALF_LENGTH] * abs(rollers[TILT, j]) - geometry[LEAST_LOST]
        rollers[DEEPEST, j] = rollers[GAP, j] + reach


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _find_cells(
    numbers: FloatArray, slices: FloatArray, rollers: FloatArray, rows: IntArray, places: FloatArray
) -> None:
    """Row of the table of each slice, and the place in the cell."""
    x, lost = slices[0], slices[1]
    inverse = numbers[INVERSE_SCALE]
    for j in range(rows.shape[0]):
        start, tilt = (rollers[GAP, j] - numbers[CENTRE]) * inverse, rollers[TILT, j] * inverse
        row, place = rows[j], places[j]
        for i in range(x.size):
            z = start + x[i] * tilt - lost[i] * inverse
            a = 1.0 + abs(z)
            a = a if a < LAST else LAST
            cell = np.uint64(np.float64(a).view(np.uint64) >> SHIFT)
            t = a - np.uint64(cell << SHIFT).view(np.float64)
            place[i] = t if z >= 0.0 else -t
            row[i] = np.int64(cell) - FIRST + (0 if z >= 0.0 else ROWS)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _power_states(numbers: FloatArray, slices: FloatArray, rollers: FloatArray, states: FloatArray) -> None:
    """States of w = a delta^b with a constant damping; rollers without load are left out."""
    x, lost = slices[0], slices[1]
    a, b, damping = numbers[COEFFICIENT], numbers[EXPONENT], numbers[DAMPING]
    for j in range(rollers.shape[1]):
        start, tilt = rollers[GAP, j], rollers[TILT, j]
        w, dw, c, dc = states[0, j], states[1, j], states[2, j], states[3, j]
        if rollers[DEEPEST, j] <= 0.0:
            for i in range(x.size):
                w[i] = dw[i] = c[i] = dc[i] = 0.0
            continue
        for i in range(x.size):
            delta = start + x[i] * tilt - lost[i]
            safe = delta if delta > _NO_APPROACH else _NO_APPROACH
            slope = a * b * power(safe, b - 1.0)
            dw[i] = slope if delta > 0.0 else 0.0
            w[i] = slope * safe / b if delta > 0.0 else 0.0
        for i in range(x.size):
            c[i] = damping if w[i] > 0.0 else 0.0
            dc[i] = 0.0


Motion = tuple[float, float]
Sums = tuple[float, float, float, float, float, float, float, float, float]


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _moderate_sums(
    positions: FloatArray, w: FloatArray, dw: FloatArray, c: FloatArray, dc: FloatArray, motion: Motion, j: int
) -> Sums:
    """Sums for slices that all have c rate >= -w/2, where the rule is linear; and a sum that is zero then alone."""
    w0 = w1 = k0 = k1 = k2 = c0 = c1 = c2 = 0.0
    lifting = 0.0  # a sum, because the compiler cannot put a minimum into vector instructions
    steady, tilting = motion
    for i in range(positions.size):
        x = positions[i]
        rate = steady + x * tilting
        damping = c[j, i]
        at_rest, part = w[j, i], damping * rate
        load, k = at_rest + part, dw[j, i] + dc[j, i] * rate
        twice = load + part
        lifting += abs(twice) - twice
        kx, cx = k * x, damping * x
        w0 += load
        w1 += load * x
        k0 += k
        k1 += kx
        k2 += kx * x
        c0 += damping
        c1 += cx
        c2 += cx * x
    return w0, w1, k0, k1, k2, c0, c1, c2, lifting


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _lifting_sums(
    positions: FloatArray, w: FloatArray, dw: FloatArray, c: FloatArray, dc: FloatArray, motion: Motion, j: int
) -> Sums:
    """As `_moderate_sums`, for any rates, by the whole rule without tension."""
    w0 = w1 = k0 = k1 = k2 = c0 = c1 = c2 = 0.0
    steady, tilting = motion
    for i in range(positions.size):
        x = positions[i]
        rate = steady + x * tilting
        load, k, damping = unilateral_force(w[j, i], dw[j, i], c[j, i], dc[j, i], rate)
        w0 += load
        w1 += load * x
        k0 += k
        k1 += k * x
        k2 += k * x * x
        c0 += damping
        c1 += damping * x
        c2 += damping * x * x
    return w0, w1, k0, k1, k2, c0, c1, c2, 0.0


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _sum_slices(
    slices: FloatArray, rollers: FloatArray, states: FloatArray, numbers: FloatArray, sums: FloatArray
) -> int:
    """Sums over the slices of each roller, into `sums` (Z, 8); returns how many rollers are above the mapped load.

    w, w x, k, k x, k x^2, c, c x, c x^2 with the loads at the rate of each slice, see `ehdmaps.physics.unilateral`.
    """
    slope = numbers[SLOPE]
    above = 0
    positions, w, dw, c, dc = slices[0], states[0], states[1], states[2], states[3]
    for j in range(sums.shape[0]):
        if rollers[DEEPEST, j] <= numbers[LIFT_OFF]:
            sums[j] = 0.0
            continue
        motion = rollers[RATE, j], rollers[TILT_RATE, j]
        found = _moderate_sums(positions, w, dw, c, dc, motion, j)
        if found[8] > 0.0:
            found = _lifting_sums(positions, w, dw, c, dc, motion, j)
        sums[j, 0], sums[j, 1] = found[0], found[1]
        sums[j, 2], sums[j, 3], sums[j, 4] = found[2] * slope, found[3] * slope, found[4] * slope
        sums[j, 5], sums[j, 6], sums[j, 7] = found[5], found[6], found[7]
        if rollers[DEEPEST, j] > numbers[SAFE_APPROACH] and np.max(w[j]) > numbers[HIGHEST]:
            above += 1
    return above


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _matrix(rollers: FloatArray, sums: FloatArray, first: int, length: float, out: FloatArray) -> None:
    """Sum of s B B^T over the rollers, into `out` (6, 6), from three columns of `sums`."""
    yy = yz = zz = ya = yb = za = aa = ab = bb = 0.0
    for j in range(sums.shape[0]):
        c, s = rollers[COS, j], rollers[SIN, j]
        m0, m1, m2 = sums[j, first], sums[j, first + 1], sums[j, first + 2]
        cc, cs, ss = c * c, c * s, s * s
        yy += m0 * cc
        yz += m0 * cs
        zz += m0 * ss
        ya -= m1 * cs
        yb += m1 * cc
        za -= m1 * ss
        aa += m2 * ss
        ab -= m2 * cs
        bb += m2 * cc
    for i in range(6):
        for k in range(6):
            out[i, k] = 0.0
    out[1, 1], out[2, 2], out[4, 4], out[5, 5] = yy * length, zz * length, aa * length, bb * length
    out[1, 2] = out[2, 1] = yz * length
    out[1, 4] = out[4, 1] = ya * length
    out[1, 5] = out[5, 1] = yb * length
    out[2, 4] = out[4, 2] = za * length
    out[2, 5] = out[5, 2] = -ya * length
    out[4, 5] = out[5, 4] = ab * length


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _assemble(rollers: FloatArray, sums: FloatArray, length: float, out: FloatArray) -> None:
    """Force, stiffness and damping, into `out` (13, 6)."""
    y = z = a = b = 0.0
    for j in range(sums.shape[0]):
        c, s = rollers[COS, j], rollers[SIN, j]
        load, moment = sums[j, 0], sums[j, 1]
        y -= c * load
        z -= s * load
        a += s * moment
        b -= c * moment
    out[0, 0] = out[0, 3] = 0.0
    out[0, 1], out[0, 2], out[0, 4], out[0, 5] = y * length, z * length, a * length, b * length
    _matrix(rollers, sums, 2, length, out[1:7])
    _matrix(rollers, sums, 5, length, out[7:13])


@njit(cache=True, error_model="numpy")
def _check(state: FloatArray, geometry: FloatArray) -> int:
    """Zero, or what is wrong about the state."""
    total = 0.0
    for i in range(13):
        total += abs(state[i])
    if not total < math.inf:
        return NOT_FINITE
    far, tilted = geometry[MOST_TRAVEL], geometry[MOST_TILT]
    within = abs(state[1]) <= far and abs(state[2]) <= far and abs(state[4]) <= tilted and abs(state[5]) <= tilted
    return 0 if within else TOO_FAR


@njit(cache=True, error_model="numpy", fastmath=FAST)
def bearing_force(
    state: FloatArray,
    geometry: FloatArray,
    slices: FloatArray,
    angles: FloatArray,
    numbers: FloatArray,
    cells: FloatArray,
    rows: IntArray,
    states: FloatArray,
    rollers: FloatArray,
    sums: FloatArray,
    out: FloatArray,
) -> int:
    """Force on the inner ring, stiffness and damping.

    Parameters
    ----------
    state : array (13,)
        Pose (6), velocity (6), cage angle: [m], [rad], [m/s], [rad/s].
    geometry : array (6,)
        Half the diametral clearance [m], slice length [m], largest accepted travel [m] and tilt [rad],
        half the roller length [m], twice the smallest profile [m].
    slices : array (2, n)
        Positions of the slices and twice the profile there [m].
    angles : array (2, Z)
        Cosine and sine of the angles of the rollers in the cage.
    numbers, cells : arrays (10,), (2 ROWS, 8)
        The prepared law.
    rows, states, rollers, sums : arrays (Z, n), (4, Z, n), (7, Z), (Z, 8)
        Work space. Afterwards `states` holds load, slope, damping and its slope of all slices at rest per unit length
        (the slopes to be multiplied by numbers[SLOPE]), `sums` the sums over slices.
    out : array (13, 6)
        Force, six rows of stiffness, six rows of damping.

    Returns
    -------
    int
        A code: zero; 1 if some slice was above the mapped load; NOT_FINITE or TOO_FAR, with `out` left alone.
    """
    wrong = _check(state, geometry)
    if wrong != 0:
        return wrong
    _place_rollers(state, geometry, angles, rollers)
    if numbers[KIND] == CELLS:
        # The places lie where the load is written, at the same time as they are read.
        _find_cells(numbers, slices, rollers, rows, states[0])
        flat = states.reshape(4, -1)
        read_cells(cells, rows.reshape(-1), flat[0], flat)
    else:
        _power_states(numbers, slices, rollers, states)
    above = _sum_slices(slices, rollers, states, numbers, sums)
    _assemble(rollers, sums, geometry[SLICE_LENGTH], out)
    return 1 if above > 0 else 0


@njit(cache=True, error_model="numpy", fastmath=FAST)
def bearing_force_of_point(
    point: Point,
    state: FloatArray,
    geometry: FloatArray,
    slices: FloatArray,
    angles: FloatArray,
    numbers: FloatArray,
    states: FloatArray,
    rollers: FloatArray,
    sums: FloatArray,
    counts: IntArray,
    out: FloatArray,
) -> int:
    """`bearing_force` straight from a `Point`, for laws that no table fits; some ten times slower."""
    wrong = _check(state, geometry)
    if wrong != 0:
        return wrong
    _place_rollers(state, geometry, angles, rollers)
    before = counts[LOAD]
    for j in range(sums.shape[0]):
        for i in range(slices.shape[1]):
            delta = rollers[GAP, j] + slices[0, i] * rollers[TILT, j] - slices[1, i]
            rate = rollers[RATE, j] + slices[0, i] * rollers[TILT_RATE, j]
            found = evaluate_at(point, delta, rate, counts)
            states[0, j, i], states[1, j, i], states[2, j, i], states[3, j, i] = found[0], found[1], found[2], 0.0
        rollers[RATE, j] = rollers[TILT_RATE, j] = 0.0  # the rates are in the loads
    _sum_slices(slices, rollers, states, numbers, sums)
    _assemble(rollers, sums, geometry[SLICE_LENGTH], out)
    return 1 if counts[LOAD] > before else 0
