"""Force, stiffness and damping of a bearing in compiled code, without allocation.

`bearing_force` is what other compiled code calls, with named tuples. Python calls `force_of_arrays` with the same as
plain arrays, because numba takes some ten microseconds longer to take tuples; they are the arrays of a `ForceAtPoint`
of `mbs.bearings.force_at_point`. Rollers are the first axis of the work arrays, slices the last. The steps are loops
of their own over few arrays, so that all but the reading of the table run in vector instructions.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.maps.binary_cells import FIRST, SHIFT
from ehdmaps.maps.kernel import evaluate_at
from ehdmaps.maps.lines import FAST, unilateral_force
from ehdmaps.maps.tables import LOAD, Point
from mbs.bearings.powers import power
from mbs.bearings.slice_table import (
    CELLS,
    LAST,
    ROWS,
    LawNumbers,
    PreparedLaw,
    fixed_tuple,
    law_numbers,
    read_cells,
)

NOT_FINITE, TOO_FAR = -1, -2
"""What `bearing_force` returns for values that are no finite numbers, and for poses beyond reason."""

_NO_APPROACH = 1e-30


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
    """What does not change of a bearing.

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


class Plane(NamedTuple):
    """A sum of s B B^T over rollers, B the direction of each in y, z, theta_y (a) and theta_z (b)."""

    yy: float
    yz: float
    zz: float
    ya: float
    yb: float
    za: float
    aa: float
    ab: float
    bb: float


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def roller_of(motion: RingMotion, shape: Shape, j: int) -> Roller:
    """Where a roller stands, and how it moves.

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


@njit(cache=True, error_model="numpy", fastmath=FAST)
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
    x, lost = shape.positions, shape.profile
    inverse = numbers.inverse_scale
    for j in range(rows.shape[0]):
        roller = roller_of(motion, shape, j)
        start, tilt = (roller.gap - numbers.centre) * inverse, roller.tilt * inverse
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
    x, lost = shape.positions, shape.profile
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        row = out[j * x.size : (j + 1) * x.size]
        for i in range(x.size):
            row[i] = roller.gap + x[i] * roller.tilt - lost[i]


@njit(cache=True, error_model="numpy", fastmath=FAST)
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
    x, lost = shape.positions, shape.profile
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
            delta = roller.gap + x[i] * roller.tilt - lost[i]
            safe = delta if delta > _NO_APPROACH else _NO_APPROACH
            slope = a * b * power(safe, b - 1.0)
            dw[i] = slope if delta > 0.0 else 0.0
            w[i] = slope * safe / b if delta > 0.0 else 0.0
        for i in range(x.size):
            loaded = w[i] > 0.0
            c[i] = damping + time * dw[i] if loaded else 0.0
            # The second derivative of the power, from load and slope.
            dc[i] = bend * dw[i] * dw[i] / (w[i] if loaded else 1.0)


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


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def added(plane: Plane, roller: Roller, flat: float, mixed: float, tilted: float) -> Plane:
    """The sum with one more roller, from its sums over 1, x and x^2.

    Parameters
    ----------
    plane : Plane
        The sum so far.
    roller : Roller
        The roller.
    flat, mixed, tilted : float
        Sums over its slices, for each length of a slice.
    """
    c, s = roller.cos, roller.sin
    cc, cs, ss = c * c, c * s, s * s
    return Plane(
        yy=plane.yy + flat * cc,
        yz=plane.yz + flat * cs,
        zz=plane.zz + flat * ss,
        ya=plane.ya - mixed * cs,
        yb=plane.yb + mixed * cc,
        za=plane.za - mixed * ss,
        aa=plane.aa + tilted * ss,
        ab=plane.ab - tilted * cs,
        bb=plane.bb + tilted * cc,
    )


@njit(cache=True, error_model="numpy", fastmath=FAST)
def write_plane(plane: Plane, length: float, out: FloatArray) -> None:
    """Write a sum into `out` (6, 6), for slices of a length.

    Parameters
    ----------
    plane : Plane
        The sum over all rollers.
    length : float
        Length of a slice [m].
    out : array (6, 6)
        Matrix, written.
    """
    for i in range(6):
        for k in range(6):
            out[i, k] = 0.0
    out[1, 1], out[2, 2] = plane.yy * length, plane.zz * length
    out[4, 4], out[5, 5] = plane.aa * length, plane.bb * length
    out[1, 2] = out[2, 1] = plane.yz * length
    out[1, 4] = out[4, 1] = plane.ya * length
    out[1, 5] = out[5, 1] = plane.yb * length
    out[2, 4] = out[4, 2] = plane.za * length
    out[2, 5] = out[5, 2] = -plane.ya * length
    out[4, 5] = out[5, 4] = plane.ab * length


@njit(cache=True, error_model="numpy", fastmath=FAST)
def assemble(motion: RingMotion, shape: Shape, numbers: LawNumbers, states: FloatArray, out: FloatArray) -> int:
    """Force, stiffness and damping, into `out` (13, 6); returns how many rollers are above the mapped load.

    The loads are those at the rate of each slice, see `ehdmaps.physics.unilateral`.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    numbers : LawNumbers
        The limits of the law, and what slopes are multiplied by.
    states : array (4, Z, n)
        States of the slices, as of `Work`.
    out : array (13, 6)
        Force, six rows of stiffness, six rows of damping.
    """
    w, dw, c, dc = states[0], states[1], states[2], states[3]
    slope, length = numbers.slope, shape.sizes.slice_length
    above = 0
    y = z = a = b = 0.0
    stiffness = damping = Plane(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        if roller.deepest <= numbers.lift_off:
            continue
        rates = roller.rate, roller.tilt_rate
        found = _moderate_sums(shape.positions, w, dw, c, dc, rates, j)
        if found[8] > 0.0:
            found = _lifting_sums(shape.positions, w, dw, c, dc, rates, j)
        load, moment, k0, k1, k2, c0, c1, c2, _ = found
        y -= roller.cos * load
        z -= roller.sin * load
        a += roller.sin * moment
        b -= roller.cos * moment
        stiffness = added(stiffness, roller, k0 * slope, k1 * slope, k2 * slope)
        damping = added(damping, roller, c0, c1, c2)
        if roller.deepest > numbers.safe_approach and np.max(w[j]) > numbers.highest:
            above += 1
    out[0, 0] = out[0, 3] = 0.0
    out[0, 1], out[0, 2], out[0, 4], out[0, 5] = y * length, z * length, a * length, b * length
    write_plane(stiffness, length, out[1:7])
    write_plane(damping, length, out[7:13])
    return above


@njit(cache=True, error_model="numpy", fastmath=FAST)
def roller_power(
    roller: Roller, positions: FloatArray, weights: FloatArray, states: FloatArray, j: int
) -> tuple[float, float, float]:
    """Power that a roller dissipates, its load at rest, and that load times its places; for each length of a slice.

    Parameters
    ----------
    roller : Roller
        Motion of the roller.
    positions : array (n,)
        Places of the slices [m].
    weights : array (n,)
        How many slices each stands for.
    states : array (4, Z, n)
        States of the slices, as of `Work`.
    j : int
        Which roller.
    """
    w, c = states[0, j], states[2, j]
    lost = flat = tilted = 0.0
    for i in range(positions.size):
        x = positions[i]
        rate = roller.rate + x * roller.tilt_rate
        part = c[i] * rate
        parting = part < -0.5 * w[i]
        # the rule of `ehdmaps.physics.unilateral`, less the load at rest
        more = -0.25 * w[i] * w[i] / (part if parting else 1.0) - w[i] if parting else part
        lost += weights[i] * more * rate
        flat += weights[i] * w[i]
        tilted += weights[i] * w[i] * x
    return lost, flat, tilted


@njit(cache=True, error_model="numpy", fastmath=FAST)
def ring_powers(
    motion: RingMotion, shape: Shape, weights: FloatArray, numbers: LawNumbers, states: FloatArray, cage_rate: float
) -> tuple[float, float]:
    """Power that the contacts of a bearing dissipate, and that the turning of the cage brings in [W].

    Turning the cage by dphi moves the loads at rest by y' = -y sin + z cos in the approach; that work is stored.

    Parameters
    ----------
    motion, shape : RingMotion, Shape
        Motion of the ring, and the bearing.
    weights : array (n,)
        How many slices each slice stands for.
    numbers : LawNumbers
        The limits of the law.
    states : array (4, Z, n)
        States of the slices, as of `Work`.
    cage_rate : float
        [rad/s].
    """
    lost = torque = 0.0
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        if roller.deepest <= numbers.lift_off:
            continue
        power, flat, tilted = roller_power(roller, shape.positions, weights, states, j)
        c, s = roller.cos, roller.sin
        lost += power
        torque += flat * (motion.z * c - motion.y * s) - tilted * (motion.theta_z * s + motion.theta_y * c)
    length = shape.sizes.slice_length
    return lost * length, torque * cage_rate * length


@njit(cache=True, error_model="numpy")
def assemble_slices(motion: RingMotion, shape: Shape, states: FloatArray, out: FloatArray) -> None:
    """`assemble` for slices whose states are those of the motion itself, with whole slopes and loads of any size.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    states : array (4, Z, n)
        Loads and their slopes; zeros where the damping would be.
    out : array (13, 6)
        Force, six rows of stiffness, six rows of zeros.
    """
    numbers = LawNumbers(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, math.inf, math.inf, -math.inf, 1.0)
    assemble(motion, shape, numbers, states, out)


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy", fastmath=FAST)
def bearing_force(motion: RingMotion, shape: Shape, law: PreparedLaw, work: Work, out: FloatArray) -> int:
    """Force on the inner ring, stiffness and damping.

    Parameters
    ----------
    motion : RingMotion
        Motion of the inner ring, and where the cage stands.
    shape : Shape
        The bearing.
    law : PreparedLaw
        Law of a roller between both raceways, at a speed and temperature.
    work : Work
        Work space, overwritten.
    out : array (13, 6)
        Force, six rows of stiffness, six rows of damping.

    Returns
    -------
    int
        A code: zero; 1 if some slice was above the mapped load; NOT_FINITE or TOO_FAR, with `out` left alone.
    """
    wrong = check_motion(motion, shape.sizes)
    if wrong != 0:
        return wrong
    states = work.states
    if law.numbers.kind == CELLS:
        # The places lie where the load is written, at the same time as they are read.
        find_cells(motion, shape, law.numbers, work.rows, states[0])
        read_cells(law.cells, work.rows.reshape(-1), states.reshape(4, -1))
    else:
        power_states(motion, shape, law.numbers, states)
    above = assemble(motion, shape, law.numbers, states, out)
    return 1 if above > 0 else 0


@njit(cache=True, error_model="numpy", fastmath=FAST)
def bearing_force_of_point(
    point: Point,
    motion: RingMotion,
    shape: Shape,
    numbers: LawNumbers,
    states: FloatArray,
    counts: IntArray,
    out: FloatArray,
) -> int:
    """`bearing_force` straight from a `Point`, for laws that no table fits; some ten times slower.

    Parameters
    ----------
    point : Point
        The law.
    motion, shape
        The same as for `bearing_force`.
    numbers : LawNumbers
        Numbers with a slope of 1, and without lift-off.
    states : array (4, Z, n)
        Work space, overwritten by the slices at their rates.
    counts : array (4,), of int
        Numbers of calls outside the map, counted up.
    out : array (13, 6)
        Result, see `bearing_force`.
    """
    wrong = check_motion(motion, shape.sizes)
    if wrong != 0:
        return wrong
    before = counts[LOAD]
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        for i in range(shape.positions.size):
            delta = roller.gap + shape.positions[i] * roller.tilt - shape.profile[i]
            rate = roller.rate + shape.positions[i] * roller.tilt_rate
            found = evaluate_at(point, delta, rate, counts)
            states[0, j, i], states[1, j, i], states[2, j, i], states[3, j, i] = found[0], found[1], found[2], 0.0
    # The rates are in the loads.
    still = RingMotion(
        y=motion.y, z=motion.z, theta_y=motion.theta_y, theta_z=motion.theta_z, y_rate=0.0, z_rate=0.0,
        theta_y_rate=0.0, theta_z_rate=0.0, cage_cos=motion.cage_cos, cage_sin=motion.cage_sin,
    )  # fmt: skip
    assemble(still, shape, numbers, states, out)
    return 1 if counts[LOAD] > before else 0


@njit(cache=True, error_model="numpy")
def sizes_of(numbers: FloatArray) -> Sizes:
    """Sizes from an array (6,) in their order."""
    return Sizes(*fixed_tuple(numbers, 6))


@njit(cache=True, error_model="numpy")
def ring_motion(state: FloatArray) -> RingMotion:
    """What rollers feel of pose (6,), velocity (6,) and cage angle in a row."""
    c, s = math.cos(state[12]), math.sin(state[12])
    return RingMotion(state[1], state[2], state[4], state[5], state[7], state[8], state[10], state[11], c, s)


@njit(cache=True, error_model="numpy")
def all_finite(state: FloatArray) -> bool:
    """Whether all numbers are finite, and their sum is."""
    total = 0.0
    for value in state:
        total += abs(value)
    return total < math.inf


@njit(cache=True, error_model="numpy")
def force_of_arrays(
    state: FloatArray,
    sizes: FloatArray,
    slices: FloatArray,
    angles: FloatArray,
    numbers: FloatArray,
    cells: FloatArray,
    rows: IntArray,
    states: FloatArray,
    out: FloatArray,
) -> int:
    """`bearing_force` for callers in Python.

    Parameters
    ----------
    state : array (13,)
        Pose (6), velocity (6), cage angle: [m], [rad], [m/s], [rad/s].
    sizes : array (6,)
        The numbers of `Sizes` in their order.
    slices, angles : array (2, n), (2, Z)
        Positions and profile, cosine and sine of `Shape`.
    numbers : array (10,)
        The numbers of `LawNumbers` in their order.
    cells : array (2 ROWS, 8)
        Table of `PreparedLaw`.
    rows, states : array (Z, n), (4, Z, n)
        Arrays of `Work`.
    out : array (13, 6)
        Result, see `bearing_force`.
    """
    if not all_finite(state):
        return NOT_FINITE
    shape = Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1])
    law = PreparedLaw(law_numbers(numbers), cells)
    status: int = bearing_force(ring_motion(state), shape, law, Work(rows, states), out)
    return status


@njit(cache=True, error_model="numpy")
def force_of_point_arrays(
    point: Point,
    state: FloatArray,
    sizes: FloatArray,
    slices: FloatArray,
    angles: FloatArray,
    numbers: FloatArray,
    states: FloatArray,
    counts: IntArray,
    out: FloatArray,
) -> int:
    """`bearing_force_of_point` for callers in Python.

    Parameters
    ----------
    point : Point
        The law.
    state, sizes, slices, angles, numbers, states
        The same arrays as for `force_of_arrays`.
    counts : array (4,), of int
        Numbers of calls outside the map, counted up.
    out : array (13, 6)
        Result, see `bearing_force`.
    """
    if not all_finite(state):
        return NOT_FINITE
    shape = Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1])
    status: int = bearing_force_of_point(point, ring_motion(state), shape, law_numbers(numbers), states, counts, out)
    return status


@njit(cache=True, error_model="numpy")
def rollers_of_arrays(state: FloatArray, sizes: FloatArray, slices: FloatArray, angles: FloatArray) -> FloatArray:
    """Gap, tilt and their rates of all rollers, shape (4, Z), for callers in Python.

    Parameters
    ----------
    state, sizes, slices, angles
        The same arrays as for `force_of_arrays`.
    """
    shape = Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1])
    motion = ring_motion(state)
    found = np.empty((4, shape.cos.size))
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        found[0, j], found[1, j], found[2, j], found[3, j] = roller.gap, roller.tilt, roller.rate, roller.tilt_rate
    return found


@njit(cache=True, error_model="numpy")
def approaches_of_arrays(
    state: FloatArray, sizes: FloatArray, slices: FloatArray, angles: FloatArray, out: FloatArray
) -> int:
    """Approaches of all slices into `out` (Z, n) [m], for callers in Python; zero, or what is wrong about the pose.

    Parameters
    ----------
    state, sizes, slices, angles
        The same arrays as for `force_of_arrays`.
    out : array (Z, n)
        Approaches, written [m].
    """
    if not all_finite(state):
        return NOT_FINITE
    shape = Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1])
    motion = ring_motion(state)
    slice_approaches(motion, shape, out.reshape(-1))
    wrong: int = check_motion(motion, shape.sizes)
    return wrong


@njit(cache=True, error_model="numpy")
def assemble_arrays(
    state: FloatArray, sizes: FloatArray, slices: FloatArray, angles: FloatArray, states: FloatArray, out: FloatArray
) -> None:
    """`assemble_slices` for callers in Python.

    Parameters
    ----------
    state, sizes, slices, angles
        The same arrays as for `force_of_arrays`.
    states : array (4, Z, n)
        Loads and their slopes; zeros where the damping would be.
    out : array (13, 6)
        Result, see `bearing_force`.
    """
    shape = Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1])
    assemble_slices(ring_motion(state), shape, states, out)
