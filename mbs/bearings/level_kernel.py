"""Force, stiffness and damping of a bearing whose rings do not tilt against each other, in compiled code.

All slices of a roller then have the approach of its middle less their own depth. Slices of one depth are one, with
their number as its weight; moments, and what tilts would change, are not computed. The rest is that of
`mbs.bearings.bearing_kernel`, to round-off.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.lines import FAST, unilateral_force
from mbs.bearings.roller_motion import RingMotion, Shape, Work, check_motion, roller_of
from mbs.bearings.slice_states import rest_states
from mbs.bearings.slice_table import LawNumbers, PreparedLaw, unbounded


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _moderate_sums(
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
def _lifting_sums(
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
        States of the slices, as of `mbs.bearings.roller_motion.Work`.
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
        load, k, d, lifting = _moderate_sums(weights, w[j], dw[j], c[j], dc[j], roller.rate)
        if lifting > 0.0:
            load, k, d, _ = _lifting_sums(weights, w[j], dw[j], c[j], dc[j], roller.rate)
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
