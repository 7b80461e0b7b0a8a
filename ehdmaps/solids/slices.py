"""Coupling of the slices of a roller with their neighbours: a matrix of compliances between them.

A law of a contact gives the approach of a slice as if all slices bore the same load. What is left of the elasticity of
three dimensions is linear, and depends little on the width of the contact:

    approach_i = law(w_i) + sum_j C_ij w_j

Rows of a roller without ends add up to zero: under the same load everywhere the law alone holds. A slice that bears
more than its neighbours yields less than its law says, and moves them: C is negative on its diagonal, positive beside
it. It is symmetric, and with the slopes of the law on its diagonal positive definite as long as contacts are narrower
than the half-width for which it was made. Ends are in it: the free end of a roller yields more, a raceway that goes on
beyond it less.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.approach import half_space, half_space_compliance
from ehdmaps.solids.three_d import FiniteLine, Profile, depth_term, mirror_factor

SliceLaw = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Loads per length and their slopes by approaches."""

_NODES = 24
_GAUSS = 8
_FAR_DEPTHS = 20.0
_MOST_STEPS = 60
_CLOSE = 1e-11
_TABLE = 600


def slice_coupling(line: FiniteLine, slices: int, half_width: float, mirrored: float | None = None) -> FloatArray:
    """Compliances between the slices of one contact, beyond those of its law, (n, n) [m2/N].

    Pressures are taken as those of Hertz over the width, and as even along each slice; displacements as their means,
    weighted by the pressures.

    Parameters
    ----------
    line : FiniteLine
        Roller and raceway.
    slices : int
        Number n of slices of equal length.
    half_width : float
        Half-width of the contact [m]; contacts should not get wider.
    mirrored : float, optional
        Factor on pressures mirrored at a free end; `mirror_factor` if left out.

    Raises
    ------
    InputError
        For no slices, or a half-width that is not positive.
    """
    if slices < 1 or not (math.isfinite(half_width) and half_width > 0.0):
        raise InputError(
            f"slice coupling: got {slices!r} slices and a half-width of {half_width!r} m; allowed: at least 1, and > 0"
        )
    factor = mirror_factor(line.material) if mirrored is None else mirrored
    step = line.length / slices
    index = np.arange(slices)
    apart = np.abs(index[:, None] - index[None, :])
    from_start = index[:, None] + index[None, :] + 1
    from_end = 2 * slices - from_start
    places: FloatArray = step * np.arange(2 * slices, dtype=np.float64)
    total = np.zeros((slices, slices))
    for depth, free_end in zip(_depths(line), (True, line.flush), strict=True):
        shared = _between(places, step, half_width, depth)
        total += shared[apart]
        if free_end:
            total += factor * (shared[from_start] + shared[from_end])
        total[index, index] -= _everywhere(half_width, depth)
    return line.body_compliance * total


def _depths(line: FiniteLine) -> tuple[float, float]:
    """Depths of the roller's and the raceway's body [m]."""
    return line.roller_depth, line.race_depth


def _distances(half_width: float) -> tuple[FloatArray, FloatArray]:
    """Distances across between two places of a contact, and their weights by the pressures of Hertz at both."""
    places, weights = [], []
    for count in (_NODES, _NODES + 1):  # two rules without common nodes: no distance is zero
        angle = math.pi * np.arange(1, count + 1) / (count + 1)
        places.append(half_width * np.cos(angle))
        weights.append(2.0 / (count + 1) * np.sin(angle) ** 2)
    apart = np.abs(places[0][:, None] - places[1][None, :]).ravel()
    return apart, np.outer(*weights).ravel()


def _between(places: FloatArray, step: float, half_width: float, depth: float) -> FloatArray:
    """Mean of the response over a slice to an even load on another one, by the distance of their middles."""
    apart, weights = _distances(half_width)

    def twice(y: FloatArray) -> FloatArray:
        """Second integral of 1/distance along the roller."""
        far = np.hypot(y[:, None], apart)
        return np.asarray((y[:, None] * np.arcsinh(y[:, None] / apart) - far) @ weights)

    flat = (twice(places + step) - 2.0 * twice(places) + twice(places - step)) / step
    x, w = np.polynomial.legendre.leggauss(_GAUSS)
    shift, share = 0.5 * step * (1.0 + x), 0.5 * step * w * (1.0 - 0.5 * (1.0 + x))
    deep = sum(depth_term(places[:, None] + sign * shift, depth) @ share for sign in (1.0, -1.0))
    return np.asarray(flat + deep)


def _everywhere(half_width: float, depth: float) -> float:
    """The same for an even load all along a roller without ends: what the law holds already."""
    apart, weights = _distances(half_width)
    x, w = np.polynomial.legendre.leggauss(16)
    edges = np.linspace(0.0, _FAR_DEPTHS * depth, 61)
    half = 0.5 * np.diff(edges)
    y = (edges[:-1, None] + half[:, None] * (1.0 + x)).ravel()
    deep = 2.0 * float(depth_term(y, depth) @ (half[:, None] * w).ravel())
    return 2.0 * float(np.arcsinh(_FAR_DEPTHS * depth / apart) @ weights) + deep


def without_ends(coupling: FloatArray) -> FloatArray:
    """The coupling beside a law that holds for a roller as a whole, such as that of ISO 16281: its ends are in the law.

    Under an even load the mean of the approach is then that of the law; only its distribution is added.

    Parameters
    ----------
    coupling : array (n, n)
        Coupling beside a plane law [m2/N].
    """
    return np.asarray(coupling - float(coupling.sum()) / len(coupling) * np.eye(len(coupling)))


def plane_depth(line: FiniteLine) -> float:
    """Depth d* of the law `half_space` that belongs to the bodies of a line, without its ends [m].

    See `ehdmaps.physics.approach.half_space`; with this law beside it the coupling gives the approach in three
    dimensions.

    Parameters
    ----------
    line : FiniteLine
        Roller and raceway.
    """
    # The slope of the law is that of a flat punch, whose displacement is even over its width.
    width = 1e-3 * min(line.roller_depth, line.race_depth)
    apart, weights = _distances(width)
    mean = float(np.log(apart) @ weights)
    yields = [_everywhere(width, depth) + 2.0 * (mean - math.log(0.5 * width)) for depth in _depths(line)]
    return 0.5 * width * math.exp(0.25 * sum(yields))


def coupled_loads(overlap: FloatArray, law: SliceLaw, coupling: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Loads of slices by how far rigid bodies overlap there, and their slopes.

    Newton's method on the part s of the approach that the law takes: s = overlap - C w(s).

    Parameters
    ----------
    overlap : array (n,)
        Overlap of the slices [m]; below zero a gap.
    law : callable
        Load per length [N/m] and its slope [N/m2] by the approach [m].
    coupling : array (n, n)
        The matrix C [m2/N]; zeros for slices on their own.

    Returns
    -------
    load : array (n,)
        w [N/m].
    stiffness : array (n, n)
        dw_i/d overlap_j [N/m2].

    Raises
    ------
    AnalysisError
        If no loads are found: contacts may be wider than the coupling was made for.
    """
    own = overlap.copy()
    identity = np.eye(overlap.size)
    for _ in range(_MOST_STEPS):
        load, slope = law(own)
        step = np.linalg.solve(identity + coupling * slope, overlap - own - coupling @ load)
        own = own + step
        if np.abs(step).max() <= _CLOSE * max(float(np.abs(own).max()), 1e-9):
            load, slope = law(own)
            return load, slope[:, None] * np.linalg.inv(identity + coupling * slope)
    raise AnalysisError(
        f"slice coupling: no loads after {_MOST_STEPS} steps; the contact may be wider than the coupling was made for"
    )


def balanced_loads(
    line: FiniteLine, law: SliceLaw, coupling: FloatArray, profile: Profile, load: float, moment: float = 0.0
) -> tuple[FloatArray, FloatArray, float, float]:
    """Loads of slices under a load and a moment.

    Parameters
    ----------
    line : FiniteLine
        Roller and raceway.
    law, coupling
        What `coupled_loads` takes.
    profile : callable
        P(y) [m].
    load, moment : float
        [N], [N m].

    Returns
    -------
    places, load_per_length : array (n,)
        Middles of the slices [m], loads [N/m].
    approach, tilt : float
        Approach in the middle [m], tilt.

    Raises
    ------
    AnalysisError
        If no balance is found.
    """
    count = len(coupling)
    width = line.length / count
    places = ((np.arange(count) + 0.5) / count - 0.5) * line.length
    depths = profile(places)
    rigid = np.stack([np.ones(count), places / line.length], axis=1)
    wanted = np.array([load, moment / line.length])
    # From an overlap that is surely too deep: loads are convex functions of it.
    motion = np.array([float(np.median(depths)), 0.0])
    while coupled_loads(motion[0] - depths, law, coupling)[0].sum() * width < load:
        motion[0] = 1.5 * motion[0] + 1e-6
    for _ in range(_MOST_STEPS):
        w, stiffness = coupled_loads(rigid @ motion - depths, law, coupling)
        step = np.linalg.solve(width * rigid.T @ stiffness @ rigid, wanted - width * rigid.T @ w)
        motion = motion + step
        if np.abs(step).max() <= _CLOSE * np.abs(motion).max():
            w, _ = coupled_loads(rigid @ motion - depths, law, coupling)
            return places, w, float(motion[0]), float(motion[1]) / line.length
    raise AnalysisError(f"slices: no balance after {_MOST_STEPS} steps; the load may lie outside the roller")


def plane_law(line: FiniteLine) -> SliceLaw:
    """The law `half_space` that belongs to the bodies of a line, as loads by approaches.

    Parameters
    ----------
    line : FiniteLine
        Roller and raceway.
    """
    depth, modulus = plane_depth(line), 1.0 / (math.pi * line.body_compliance)
    # Up to where the contact is as wide as the depth allows.
    widest = math.pi * modulus * depth**2 / (8.0 * line.radius)
    loads = np.concatenate([[0.0], np.geomspace(1e-9 * widest, 0.99 * widest, _TABLE)])
    approaches = half_space(loads, depth, line.radius, modulus)

    def law(approach: FloatArray) -> tuple[FloatArray, FloatArray]:
        loaded = approach > 0.0
        load = np.maximum(np.interp(approach, approaches, loads), loads[1])
        for _ in range(2):  # from the table to round-off
            missing = approach - half_space(load, depth, line.radius, modulus)
            load += missing / half_space_compliance(load, depth, line.radius, modulus)
            load = np.clip(load, loads[1], loads[-1])
        slope = 1.0 / half_space_compliance(load, depth, line.radius, modulus)
        return np.where(loaded, load, 0.0), np.where(loaded, slope, 0.0)

    return law
