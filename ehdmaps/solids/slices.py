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

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.solids.finite_line import FiniteLine, depth_term, mirror_factor

_NODES = 24
_GAUSS = 8
_FAR_DEPTHS = 20.0


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
