"""Force, stiffness and damping of a bearing in compiled runs, without allocation.

Rollers are the first axis of the work arrays, slices the last. The steps are loops of their own over few arrays, so
that all but the reading of the table run in vector instructions. Python calls a bearing in C, see
`mbs.bearings.cylinder`.

Between rings that do not tilt against each other all slices of a roller have the approach of its middle less their own
depth. Slices of one depth are one, with their number as its weight; moments, and what tilts would change, are not
computed (`level_force`). The rest is the same, to round-off.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.lines import FAST, unilateral_force
from mbs.bearings.slice_table import LawNumbers
from mbs.bearings.slices import (
    PreparedLaw,
    RingMotion,
    Roller,
    Shape,
    Work,
    check_motion,
    rest_states,
    roller_of,
    unbounded,
)


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


Motion = tuple[float, float]
Sums = tuple[float, float, float, float, float, float, float, float, float]


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
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


@njit(error_model="numpy", fastmath=FAST)
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


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
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


@njit(error_model="numpy", fastmath=FAST)
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


@njit(error_model="numpy", fastmath=FAST)
def assemble(motion: RingMotion, shape: Shape, numbers: LawNumbers, states: FloatArray, out: FloatArray) -> int:
    """Force, stiffness and damping, into `out` (13, 6); returns how many rollers are above the mapped load.

    The loads are those at the rate of each slice, see `ehdmaps.physics.contact`.

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
        sums = _moderate_sums(shape.positions, w, dw, c, dc, rates, j)
        if sums[8] > 0.0:
            sums = _lifting_sums(shape.positions, w, dw, c, dc, rates, j)
        load, moment, k0, k1, k2, c0, c1, c2, _ = sums
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


@njit(error_model="numpy", fastmath=FAST)
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
    dissipated = flat = tilted = 0.0
    for i in range(positions.size):
        x = positions[i]
        rate = roller.rate + x * roller.tilt_rate
        part = c[i] * rate
        parting = part < -0.5 * w[i]
        # the rule of `ehdmaps.physics.contact`, less the load at rest
        more = -0.25 * w[i] * w[i] / (part if parting else 1.0) - w[i] if parting else part
        dissipated += weights[i] * more * rate
        flat += weights[i] * w[i]
        tilted += weights[i] * w[i] * x
    return dissipated, flat, tilted


@njit(error_model="numpy", fastmath=FAST)
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
    dissipated = torque = 0.0
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        if roller.deepest <= numbers.lift_off:
            continue
        power, flat, tilted = roller_power(roller, shape.positions, weights, states, j)
        c, s = roller.cos, roller.sin
        dissipated += power
        torque += flat * (motion.z * c - motion.y * s) - tilted * (motion.theta_z * s + motion.theta_y * c)
    length = shape.sizes.slice_length
    return dissipated * length, torque * cage_rate * length


@njit(error_model="numpy")
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
    assemble(motion, shape, unbounded(), states, out)


@njit(error_model="numpy", fastmath=FAST)
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
    rest_states(motion, shape, law, work)
    above = assemble(motion, shape, law.numbers, work.states, out)
    return 1 if above > 0 else 0


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _moderate_level_sums(
    weights: FloatArray, w: FloatArray, dw: FloatArray, c: FloatArray, dc: FloatArray, rate: float
) -> tuple[float, float, float, float]:
    """Load, stiffness, damping of a roller where all slices have c rate >= -w/2; and a sum that is zero then alone."""
    load = stiffness = damping = lifting = 0.0
    for i in range(weights.size):
        part = c[i] * rate
        total = w[i] + part
        twice = total + part
        lifting += abs(twice) - twice
        load += weights[i] * total
        stiffness += weights[i] * (dw[i] + dc[i] * rate)
        damping += weights[i] * c[i]
    return load, stiffness, damping, lifting


@njit(error_model="numpy", fastmath=FAST)
def _lifting_level_sums(
    weights: FloatArray, w: FloatArray, dw: FloatArray, c: FloatArray, dc: FloatArray, rate: float
) -> tuple[float, float, float, float]:
    """As `_moderate_sums`, for any rates, by the whole rule without tension."""
    load = stiffness = damping = 0.0
    for i in range(weights.size):
        one, slope, resists = unilateral_force(w[i], dw[i], c[i], dc[i], rate)
        load += weights[i] * one
        stiffness += weights[i] * slope
        damping += weights[i] * resists
    return load, stiffness, damping, 0.0


@njit(error_model="numpy", fastmath=FAST)
def assemble_level(
    motion: RingMotion, shape: Shape, weights: FloatArray, numbers: LawNumbers, states: FloatArray, out: FloatArray
) -> int:
    """Force, stiffness and damping in y and z into `out` (13, 6); returns how many rollers are above the mapped load.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring, without tilts.
    shape : Shape
        The bearing, with one slice of each depth.
    weights : array (n,)
        How many slices of that depth there are.
    numbers : LawNumbers
        The limits of the law, and what slopes are multiplied by.
    states : array (4, Z, n)
        States of the slices, as of `mbs.bearings.slices.Work`.
    out : array (13, 6)
        Force, six rows of stiffness, six rows of damping; rows and columns of y and z alone are written.
    """
    w, dw, c, dc = states[0], states[1], states[2], states[3]
    length, above = shape.sizes.slice_length, 0
    y = z = kyy = kyz = kzz = cyy = cyz = czz = 0.0
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        if roller.deepest <= numbers.lift_off:
            continue
        load, k, d, lifting = _moderate_level_sums(weights, w[j], dw[j], c[j], dc[j], roller.rate)
        if lifting > 0.0:
            load, k, d, _ = _lifting_level_sums(weights, w[j], dw[j], c[j], dc[j], roller.rate)
        k *= numbers.slope
        y -= roller.cos * load
        z -= roller.sin * load
        cc, cs, ss = roller.cos * roller.cos, roller.cos * roller.sin, roller.sin * roller.sin
        kyy, kyz, kzz = kyy + k * cc, kyz + k * cs, kzz + k * ss
        cyy, cyz, czz = cyy + d * cc, cyz + d * cs, czz + d * ss
        if roller.deepest > numbers.safe_approach and np.max(w[j]) > numbers.highest:
            above += 1
    out[0, 1], out[0, 2] = y * length, z * length
    out[2, 1], out[3, 2] = kyy * length, kzz * length
    out[2, 2] = out[3, 1] = kyz * length
    out[8, 1], out[9, 2] = cyy * length, czz * length
    out[8, 2] = out[9, 1] = cyz * length
    return above


@njit(error_model="numpy")
def assemble_level_slices(
    motion: RingMotion, shape: Shape, weights: FloatArray, states: FloatArray, out: FloatArray
) -> None:
    """`assemble_level` for slices whose states are those of the motion itself, with whole slopes and loads of any size.

    Parameters
    ----------
    motion, shape, weights
        The same as for `assemble_level`.
    states : array (4, Z, n)
        Loads and their slopes; zeros where the damping would be.
    out : array (13, 6)
        Written as by `assemble_level`.
    """
    assemble_level(motion, shape, weights, unbounded(), states, out)


@njit(error_model="numpy", fastmath=FAST)
def level_force(
    motion: RingMotion, shape: Shape, weights: FloatArray, law: PreparedLaw, work: Work, out: FloatArray
) -> int:
    """Force on the inner ring, stiffness and damping, as `mbs.bearings.bearing_kernel.bearing_force`.

    Parameters
    ----------
    motion, shape, weights
        The same as for `assemble_level`.
    law : PreparedLaw
        Law of a roller between both raceways, at a speed and temperature.
    work : Work
        Work space, overwritten.
    out : array (13, 6)
        Written as by `assemble_level`.
    """
    wrong = check_motion(motion, shape.sizes)
    if wrong != 0:
        return wrong
    rest_states(motion, shape, law, work)
    above = assemble_level(motion, shape, weights, law.numbers, work.states, out)
    return 1 if above > 0 else 0
