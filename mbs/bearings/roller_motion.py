"""Where the rollers of a bearing stand and how they move, in compiled code."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.maps.lines import FAST
from mbs.bearings.slice_table import fixed_tuple

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


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
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
    x, lost = shape.positions, shape.profile
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        row = out[j * x.size : (j + 1) * x.size]
        for i in range(x.size):
            row[i] = roller.gap + x[i] * roller.tilt - lost[i]


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


@njit(error_model="numpy")
def ring_motion(state: FloatArray) -> RingMotion:
    """What rollers feel of pose (6,), velocity (6,) and cage angle in a row."""
    c, s = math.cos(state[12]), math.sin(state[12])
    return RingMotion(state[1], state[2], state[4], state[5], state[7], state[8], state[10], state[11], c, s)


@njit(error_model="numpy")
def all_finite(state: FloatArray) -> bool:
    """Whether all numbers are finite, and their sum is."""
    total = 0.0
    for value in state:
        total += abs(value)
    return total < math.inf


@njit(error_model="numpy")
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


@njit(error_model="numpy")
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
