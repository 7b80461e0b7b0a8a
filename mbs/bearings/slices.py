"""The slices of a bearing in compiled code: where rollers stand, how they move, and what their slices carry at rest.

Each kind of law finds its slices in its own way: a power law by its formula, tables by their cells. Above the load that
the law is held at, all go on along its tangent.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba.np.unsafe.ndarray import to_fixed_tuple

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import COMPILES, njit
from ehdmaps.maps.kernels.lines import FAST, log
from ehdmaps.maps.kernels.tables import FIRST, SHIFT
from mbs.bearings.slice_table import CELLS, KNOTS, LAST, POWER, ROWS, LawNumbers

fixed_tuple: Any = to_fixed_tuple if COMPILES else lambda values, size: tuple(values[:size])
"""The first numbers of an array as a tuple."""

_LOG2_E = 1.4426950408889634
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_ROUNDING = 1.5 * 2.0**52
_MANTISSA = np.uint64(52)
_BIAS = np.uint64(1023)


@njit(error_model="numpy", fastmath={"contract", "nsz"}, forceinline=True)
def power(x: float, b: float) -> float:
    """x^b for a positive normal x, and a result between 1e-300 and 1e300; to some 1e-15 relative."""
    y = b * log(x)
    # Adding this number leaves the nearest whole number in the lowest bits.
    shifted = y * _LOG2_E + _ROUNDING
    n = shifted - _ROUNDING
    r = (y - n * _LN2_HIGH) - n * _LN2_LOW
    r2 = r * r
    r4 = r2 * r2
    low = (1.0 + r) + r2 * (1.0 / 2.0 + r * (1.0 / 6.0))
    middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0))
    high = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + r2 * (1.0 / 3628800.0 + r * (1.0 / 39916800.0))
    series = low + r4 * (middle + r4 * (high + r4 * (1.0 / 479001600.0)))
    bits = np.uint64(np.uint64(np.float64(shifted).view(np.uint64) + _BIAS) << _MANTISSA)
    value: float = series * bits.view(np.float64)
    return value


class PreparedLaw(NamedTuple):
    """A law at one speed, temperature and centrifugal load.

    Attributes
    ----------
    numbers : LawNumbers
        Numbers of the law.
    cells : array (2 ROWS, 8)
        Table of the law, coefficients of load and damping in turns; anything for POWER.
    knots : array (2 ROWS,)
        Approaches at which the cells begin [m], the last one infinite; anything but for KNOTS.
    """

    numbers: LawNumbers
    cells: FloatArray
    knots: FloatArray


@njit(error_model="numpy")
def law_numbers(numbers: FloatArray) -> LawNumbers:
    """The numbers of a law from an array (NUMBERS,) in their order."""
    return LawNumbers(*fixed_tuple(numbers, 15))


@njit(error_model="numpy")
def store_numbers(law: LawNumbers, numbers: FloatArray) -> None:
    """Write the numbers of a law into an array (NUMBERS,)."""
    for i in range(len(law)):
        numbers[i] = law[i]


@njit(error_model="numpy")
def unbounded() -> LawNumbers:
    """Numbers for states that are there already: whole slopes, loads of any size."""
    inf = math.inf
    return LawNumbers(POWER, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inf, inf, -inf, 1.0, inf, inf, 0.0, 0.0)


@njit(error_model="numpy", fastmath=FAST)
def read_cells(cells: FloatArray, rows: IntArray, states: FloatArray) -> None:
    """Load, slope, damping and its slope, into `states` (4, n), from rows (n,) and places in the cells, states[0]."""
    w, dw, c, dc = states[0], states[1], states[2], states[3]
    for i in range(rows.size):
        m, t = np.uint64(rows[i]), w[i]
        high = cells[m, np.uint64(6)]
        bend = cells[m, np.uint64(4)] + t * high
        mean = cells[m, np.uint64(2)] + t * bend
        w[i], dw[i] = cells[m, np.uint64(0)] + t * mean, mean + t * (bend + t * high)
        high = cells[m, np.uint64(7)]
        bend = cells[m, np.uint64(5)] + t * high
        mean = cells[m, np.uint64(3)] + t * bend
        c[i], dc[i] = cells[m, np.uint64(1)] + t * mean, mean + t * (bend + t * high)


WHOLE, DRY, RISE, LOADS, SLOPES, DAMPINGS, BENDS = range(7)
"""Columns of the nodes of a faded film: approach with the whole film and without [m], growth of the latter by the
former; load [N/m] and damping [N s/m2], each with its slope by the approach with the whole film."""


@njit(error_model="numpy", fastmath=FAST)
def fade(
    film: FloatArray, given: FloatArray, part: float, cells: FloatArray, knots: FloatArray, numbers: FloatArray
) -> None:
    """The table of a part of a film, from the nodes of the film.

    Parameters
    ----------
    film, given : array (2 ROWS, 8), (NUMBERS,)
        What `ehd_cylinder_prepare` makes of a film alone.
    part : float
        Part of the film that is there, 0 to 1.
    cells, knots : array (2 ROWS, 8), (2 ROWS,)
        Filled: coefficients of load and damping in turns, over the distance from the lower end of a cell [m]; where
        cells begin [m].
    numbers : array (NUMBERS,)
        Filled with `LawNumbers`.
    """
    last, rest = film.shape[0] - 1, 1.0 - part
    slopes, bends = np.empty(last), np.empty(last)
    for i in range(last):
        knots[i] = rest * film[i, DRY] + part * film[i, WHOLE]
        stretch = rest * film[i, RISE] + part
        loaded = film[i, LOADS] > 0.0
        slopes[i] = film[i, SLOPES] / (stretch if loaded else 1.0)
        bends[i] = part * film[i, BENDS] / (stretch if loaded else 1.0)
    knots[last] = math.inf
    for i in range(last - 1):
        h = knots[i + 1] - knots[i]
        # Without film all nodes without load are one.
        rise = 3.0 * (film[i + 1, LOADS] - film[i, LOADS]) / h if h > 0.0 else 0.0
        slopes[i], slopes[i + 1] = min(slopes[i], rise), min(slopes[i + 1], rise)
        if h > 0.0:
            bends[i] = max(bends[i], -3.0 * part * film[i, DAMPINGS] / h)
            bends[i + 1] = min(bends[i + 1], 3.0 * part * film[i + 1, DAMPINGS] / h)
    for i in range(last - 1):
        h, cell = knots[i + 1] - knots[i], cells[i]
        by = 1.0 / h if h > 0.0 else 0.0
        secant = (film[i + 1, LOADS] - film[i, LOADS]) * by
        cell[0], cell[2] = film[i, LOADS], slopes[i]
        cell[4] = (3.0 * secant - 2.0 * slopes[i] - slopes[i + 1]) * by
        cell[6] = (slopes[i] + slopes[i + 1] - 2.0 * secant) * by * by
        secant = part * (film[i + 1, DAMPINGS] - film[i, DAMPINGS]) * by
        cell[1], cell[3] = part * film[i, DAMPINGS], bends[i]
        cell[5] = (3.0 * secant - 2.0 * bends[i] - bends[i + 1]) * by
        cell[7] = (bends[i] + bends[i + 1] - 2.0 * secant) * by * by
    for k in range(8):
        for i in range(last - 1, last + 1):
            cells[i, k] = 0.0
    whole = law_numbers(given)
    faded = LawNumbers(
        kind=KNOTS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=0.0, inverse_scale=0.0,
        highest=whole.highest, safe_approach=knots[int(whole.safe_approach)], lift_off=knots[int(whole.lift_off)],
        slope=1.0, held_approach=rest * film[last, DRY] + part * film[last, WHOLE], held_load=whole.held_load,
        held_stiffness=whole.held_stiffness, held_damping=part * film[last, DAMPINGS],
    )  # fmt: skip
    store_numbers(faded, numbers)


NOT_FINITE, TOO_FAR = -1, -2
"""What `check_motion` finds: values that are no finite numbers, and poses beyond reason."""


class Sizes(NamedTuple):
    """Sizes of a bearing.

    Attributes
    ----------
    half_clearance, slice_length : float
        Half the diametral clearance [m], and how long a slice is [m].
    most_travel, most_tilt : float
        Largest accepted displacement [m] and tilt [rad] of the ring.
    half_length : float
        Half the length of a roller [m].
    least_profile : float
        The smallest of `Shape.profile` [m].
    """

    half_clearance: float
    slice_length: float
    most_travel: float
    most_tilt: float
    half_length: float
    least_profile: float


class Shape(NamedTuple):
    """Data of a bearing that do not change.

    Attributes
    ----------
    sizes : Sizes
        Clearance, lengths, limits.
    positions, profile : array (n,)
        Places of the slices along the roller, and twice the depth of the profile there [m].
    cos, sin : array (Z,)
        Directions of the rollers in the cage.
    """

    sizes: Sizes
    positions: FloatArray
    profile: FloatArray
    cos: FloatArray
    sin: FloatArray


class RingMotion(NamedTuple):
    """Motion of the inner ring against the outer one, as far as rollers feel it, and where the cage stands.

    Attributes
    ----------
    y, z, theta_y, theta_z : float
        Displacements [m] and tilts [rad].
    y_rate, z_rate, theta_y_rate, theta_z_rate : float
        Their rates.
    cage_cos, cage_sin : float
        Direction of the first roller.
    """

    y: float
    z: float
    theta_y: float
    theta_z: float
    y_rate: float
    z_rate: float
    theta_y_rate: float
    theta_z_rate: float
    cage_cos: float
    cage_sin: float


class Roller(NamedTuple):
    """Motion of a roller.

    Attributes
    ----------
    cos, sin : float
        Direction of the roller.
    gap, tilt : float
        Approach in its middle [m], and how it grows along it.
    rate, tilt_rate : float
        Their rates.
    deepest : float
        A bound that no approach of a slice is above [m].
    """

    cos: float
    sin: float
    gap: float
    tilt: float
    rate: float
    tilt_rate: float
    deepest: float


class Work(NamedTuple):
    """Work space, which holds the slices at rest after a call, per unit length.

    Attributes
    ----------
    rows : array (Z, n), of int
        Row of the table of each slice.
    states : array (4, Z, n)
        Load w, dw/d approach, damping c, dc/d approach; the derivatives to be multiplied by `LawNumbers.slope`.
    """

    rows: IntArray
    states: FloatArray


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def roller_of(motion: RingMotion, shape: Shape, j: int) -> Roller:
    """Find the place of a roller, and its motion.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    j : int
        Which roller.
    """
    cos = motion.cage_cos * shape.cos[j] - motion.cage_sin * shape.sin[j]
    sin = motion.cage_sin * shape.cos[j] + motion.cage_cos * shape.sin[j]
    sizes = shape.sizes
    gap = motion.y * cos + motion.z * sin - sizes.half_clearance
    tilt = motion.theta_z * cos - motion.theta_y * sin
    return Roller(
        cos=cos,
        sin=sin,
        gap=gap,
        tilt=tilt,
        rate=motion.y_rate * cos + motion.z_rate * sin,
        tilt_rate=motion.theta_z_rate * cos - motion.theta_y_rate * sin,
        deepest=gap + (sizes.half_length * abs(tilt) - sizes.least_profile),
    )


@njit(error_model="numpy", fastmath=FAST)
def slice_approaches(motion: RingMotion, shape: Shape, out: FloatArray) -> None:
    """Approach of all slices of all rollers.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    out : array (Z n,)
        Approaches, written [m].
    """
    x, profile = shape.positions, shape.profile
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        row = out[j * x.size : (j + 1) * x.size]
        for i in range(x.size):
            row[i] = roller.gap + x[i] * roller.tilt - profile[i]


@njit(error_model="numpy")
def check_motion(motion: RingMotion, sizes: Sizes) -> int:
    """Zero, or what is wrong about the motion: `NOT_FINITE`, `TOO_FAR`."""
    total = abs(motion.y) + abs(motion.z) + abs(motion.theta_y) + abs(motion.theta_z)
    total += abs(motion.y_rate) + abs(motion.z_rate) + abs(motion.theta_y_rate) + abs(motion.theta_z_rate)
    if not total + abs(motion.cage_cos) < math.inf:
        return NOT_FINITE
    far, tilted = sizes.most_travel, sizes.most_tilt
    within = abs(motion.y) <= far and abs(motion.z) <= far
    within = within and abs(motion.theta_y) <= tilted and abs(motion.theta_z) <= tilted
    return 0 if within else TOO_FAR


@njit(error_model="numpy")
def sizes_of(numbers: FloatArray) -> Sizes:
    """Sizes from an array (6,) in their order."""
    return Sizes(*fixed_tuple(numbers, 6))


_NO_APPROACH = 1e-30


@njit(error_model="numpy", fastmath=FAST)
def find_cells(motion: RingMotion, shape: Shape, numbers: LawNumbers, rows: IntArray, places: FloatArray) -> None:
    """Row of the table of each slice, and the place in the cell.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    numbers : LawNumbers
        Centre and scale of the cells.
    rows : array (Z, n), of int
        Rows, written.
    places : array (Z, n)
        Places in the cells, written.
    """
    x, profile = shape.positions, shape.profile
    inverse = numbers.inverse_scale
    for j in range(rows.shape[0]):
        roller = roller_of(motion, shape, j)
        start, tilt = (roller.gap - numbers.centre) * inverse, roller.tilt * inverse
        row, place = rows[j], places[j]
        for i in range(x.size):
            z = start + x[i] * tilt - profile[i] * inverse
            a = 1.0 + abs(z)
            a = a if a < LAST else LAST
            cell = np.uint64(np.float64(a).view(np.uint64) >> SHIFT)
            t = a - np.uint64(cell << SHIFT).view(np.float64)
            place[i] = t if z >= 0.0 else -t
            row[i] = np.int64(cell) - FIRST + (0 if z >= 0.0 else ROWS)


@njit(error_model="numpy", fastmath=FAST)
def power_states(motion: RingMotion, shape: Shape, numbers: LawNumbers, states: FloatArray) -> None:
    """States of w = a delta^b with c = damping + damping_time dw; rollers without load are left out.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    numbers : LawNumbers
        The power law.
    states : array (4, Z, n)
        States of the slices, written.
    """
    x, profile = shape.positions, shape.profile
    a, b, damping, time = numbers.coefficient, numbers.exponent, numbers.damping, numbers.damping_time
    bend = time * (b - 1.0) / b
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        w, dw, c, dc = states[0, j], states[1, j], states[2, j], states[3, j]
        if roller.deepest <= 0.0:
            for i in range(x.size):
                w[i] = dw[i] = c[i] = dc[i] = 0.0
            continue
        for i in range(x.size):
            delta = roller.gap + x[i] * roller.tilt - profile[i]
            safe = delta if delta > _NO_APPROACH else _NO_APPROACH
            slope = a * b * power(safe, b - 1.0)
            dw[i] = slope if delta > 0.0 else 0.0
            w[i] = slope * safe / b if delta > 0.0 else 0.0
        for i in range(x.size):
            loaded = w[i] > 0.0
            c[i] = damping + time * dw[i] if loaded else 0.0
            # The second derivative of the power, from load and slope.
            dc[i] = bend * dw[i] * dw[i] / (w[i] if loaded else 1.0)


@njit(error_model="numpy", fastmath=FAST)
def find_knots(motion: RingMotion, shape: Shape, knots: FloatArray, rows: IntArray, places: FloatArray) -> None:
    """Cell between knots of each slice, and the place there, as `find_cells`.

    Parameters
    ----------
    motion, shape : RingMotion, Shape
        Motion of the ring, and the bearing.
    knots : array (2 ROWS,)
        Approaches at which cells begin [m].
    rows, places : array (Z, n)
        Written: cells, and places there [m].
    """
    x, profile = shape.positions, shape.profile
    last = knots.size - 2
    for j in range(rows.shape[0]):
        roller = roller_of(motion, shape, j)
        row, place = rows[j], places[j]
        cell = 0
        for i in range(x.size):
            delta = roller.gap + x[i] * roller.tilt - profile[i]
            if delta <= knots[0]:
                row[i], place[i] = 0, 0.0
                continue
            if not knots[cell] <= delta < knots[cell + 1]:  # not that of the slice before
                low, high = 0, last + 1
                while high - low > 1:
                    middle = (low + high) // 2
                    if knots[middle] <= delta:
                        low = middle
                    else:
                        high = middle
                cell = low
            row[i], place[i] = cell, delta - knots[cell]


@njit(error_model="numpy", fastmath=FAST)
def _hold(motion: RingMotion, shape: Shape, numbers: LawNumbers, states: FloatArray) -> None:
    """States on the tangent, for slices above the held load."""
    x, profile = shape.positions, shape.profile
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        if roller.deepest <= numbers.safe_approach:
            continue
        w, dw, c, dc = states[0, j], states[1, j], states[2, j], states[3, j]
        for i in range(x.size):
            above = roller.gap + x[i] * roller.tilt - profile[i] - numbers.held_approach
            if above > 0.0:
                w[i] = numbers.held_load + numbers.held_stiffness * above
                dw[i], c[i], dc[i] = numbers.held_stiffness / numbers.slope, numbers.held_damping, 0.0


@njit(error_model="numpy", fastmath=FAST)
def read_states(motion: RingMotion, shape: Shape, law: PreparedLaw, work: Work) -> None:
    """States of all slices at rest, from the rows of a table and the places there.

    Parameters
    ----------
    motion, shape, law
        The same as for `rest_states`.
    work : Work
        Rows, and places where the load is written; overwritten by the states.
    """
    read_cells(law.cells, work.rows.reshape(-1), work.states.reshape(4, -1))
    _hold(motion, shape, law.numbers, work.states)


@njit(error_model="numpy", fastmath=FAST)
def rest_states(motion: RingMotion, shape: Shape, law: PreparedLaw, work: Work) -> None:
    """States of all slices at rest.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    law : PreparedLaw
        Law of a roller between both raceways, at a speed and temperature.
    work : Work
        Work space, overwritten.
    """
    states, numbers = work.states, law.numbers
    if numbers.kind == POWER:
        power_states(motion, shape, numbers, states)
        _hold(motion, shape, numbers, states)
        return
    # The places lie where the load is written, at the same time as they are read.
    if numbers.kind == CELLS:
        find_cells(motion, shape, numbers, work.rows, states[0])
    else:
        find_knots(motion, shape, law.knots, work.rows, states[0])
    read_states(motion, shape, law, work)
