"""Grids of a roller of finite length: a profile across in place of a parabola, and the dry contact on them.

Lengths in a, the half-width of the line contact whose load per length is the highest one of the dry roller, P in its
Hertz pressure, H in a^2/R:

    H = H0 + X^2/2 + Z(Y) + 1/(2 pi) Int P/r dX dY,      Int P dX dY = W,      lambda = 3 pi^2/(8 M^2),

with the depth Z of the profile and Moes' M of that line. At the ends of the roller there is no pressure. The solids are
half-spaces that go on beyond the ends.

Cells across are small where the dry contact ends and at corners of the profile, and grow with the distance from there.
Before the grid the film is that of a line: P = lambda |X|/(3 H^2) of rolling and -lambda/(2 H^2) dH/dT of squeezing,
Kapitza's forms of D = 0; what their load does to the deflection of the contact, some 1e-3 a^2/R at most, is left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.films import moes_central
from ehdmaps.physics.isotherm import Isotherm
from ehdmaps.point.grid import PointGrid, grid_kernel, node_widths, nodes_along
from ehdmaps.point.tail import Tail

LARGEST_DEPTH = 1e3
"""Depth at which a profile is cut off [a^2/R]: that of ISO/TS 16281 has none at the very ends."""

_END_CELL, _GROWTH, _LARGEST_PART = 0.25, 0.3, 1.0 / 6.0
_COARSE_ALONG, _COARSE_ACROSS, _COARSE_REACH = 24, 40, 2.5
_SAMPLES = 20001
_PART = 0.15
_MOST_ROUNDS = 100


class RollerProblem(NamedTuple):
    """Dimensionless groups of a roller of finite length.

    Attributes
    ----------
    load_number, oil_number : float
        Moes' M and L of the line.
    load : float
        W, integral of P.
    isotherm : Isotherm
        Viscosity and density over P.
    """

    load_number: float
    oil_number: float
    load: float
    isotherm: Isotherm

    @property
    def wedge(self) -> float:
        """Wedge number lambda = 3 pi^2/(8 M^2)."""
        return 3.0 * math.pi**2 / (8.0 * self.load_number**2)

    @property
    def start_film(self) -> float:
        """Film of a line by a formula [a^2/R], from which a solution is sought."""
        return math.pi / (8.0 * self.load_number) * float(moes_central(self.load_number, self.oil_number))


@dataclass(frozen=True, eq=False)
class RollerGrid(PointGrid):
    """Grid of half of a roller's contact.

    Attributes
    ----------
    depth : ndarray, shape (m,)
        Depth of the profile across [a^2/R].
    """

    depth: FloatArray

    @cached_property
    def elasticity(self) -> float:
        """Factor 1/(2 pi) of the deflection."""
        return 0.5 / math.pi

    @cached_property
    def parabola(self) -> FloatArray:
        """Gap of the undeformed bodies that touch, X^2/2 + Z(Y), shape (n, m)."""
        return np.asarray(0.5 * self.x[:, None] ** 2 + self.depth[None, :])


class DryContact(NamedTuple):
    """The dry contact on a grid.

    Attributes
    ----------
    pressure : ndarray, shape (n, m)
        P >= 0.
    height : float
        H0, less than zero: minus the approach.
    """

    pressure: FloatArray
    height: float


def roller_grid(
    depth: Callable[[FloatArray], FloatArray],
    half_length: float,
    places: Sequence[float],
    cells: tuple[int, int],
    inlet: float,
    edge: float,
    scale: float,
) -> RollerGrid:
    """Grid that is fine at given places across.

    Parameters
    ----------
    depth : callable
        Z [a^2/R] of places Y.
    half_length : float
        Half of the roller's length [a].
    places : sequence of float
        Places where it is fine: the ends of the dry contact, corners of the profile [a].
    cells : (int, int)
        Cells along and across half of the contact.
    inlet, edge, scale : float
        Length of the inlet, size of the cells at the edges along, and stretch of both, see `ehdmaps.point.grid.Cells`.
    """
    x = scale * nodes_along(edge, inlet, cells[0])
    y = _across(half_length, places, scale * _END_CELL, cells[1])
    across = depth(y)
    return RollerGrid(0.0, scale, x, y, grid_kernel(x, y, 0.5 / math.pi), line_tail(x, y, across), across)


def line_tail(x: FloatArray, y: FloatArray, depth: FloatArray) -> Tail:
    """Far pressures before a grid whose film is that of a line.

    Parameters
    ----------
    x, y : ndarray, shape (n,), (m,)
        Nodes along and across [a].
    depth : ndarray, shape (m,)
        Depth of the profile across.
    """
    far = np.zeros((x.size, y.size), dtype=bool)
    far[0, :-1] = True
    about = np.repeat(np.maximum(-x, 0.0)[:, None] / 3.0, y.size, axis=1)
    width, start = 2.0 * node_widths(y), 0.5 * x[0] ** 2
    gap = start + depth  # Int |x|/(3 H^2) dx = 1/(3 H) at the end of the grid
    squeeze = -float(np.sum(width * 2.0 / (3.0 * abs(x[0]) ** 3) * (start / gap) ** 2))
    load = (
        float(np.sum(width / (3.0 * gap))),
        float(-np.sum(width / (3.0 * gap**2))),
        float(np.sum(width / (3.0 * gap**3))),
    )
    return Tail(far, np.where(far, about, 0.0), np.where(far, 0.5, 0.0), about, load, squeeze, 0.0, 0.0)


def dry_contact(kernel: FloatArray, gap: FloatArray, weights: FloatArray, load: float) -> DryContact | None:
    """Dry contact on a grid: nodes that touch are chosen anew until they stay the same; None if they do not.

    Parameters
    ----------
    kernel : ndarray, shape (n m, n m)
        Deflection by pressures.
    gap : ndarray, shape (n, m)
        Gap of the undeformed bodies.
    weights : ndarray, shape (n, m)
        Weights of the pressures in the load.
    load : float
        Integral of P.
    """
    apart, weight = gap.ravel(), weights.ravel()
    touching = apart < 0.5
    pressure = np.zeros(apart.size)
    for _ in range(_MOST_ROUNDS):
        nodes = np.flatnonzero(touching)
        count = nodes.size
        matrix = np.zeros((count + 1, count + 1))
        matrix[:count, :count] = kernel[np.ix_(nodes, nodes)]
        matrix[:count, count], matrix[count, :count] = 1.0, weight[nodes]
        found = np.linalg.solve(matrix, np.r_[-apart[nodes], load])
        pressure[:] = 0.0
        pressure[nodes] = found[:count]
        left = kernel[:, nodes] @ pressure[nodes] + apart + found[count]
        after = (pressure > 0.0) | (~touching & (left < 0.0))
        if np.array_equal(after, touching):
            return DryContact(pressure.reshape(gap.shape), float(found[count]))
        touching = after
    return None


def dry_compliance(grid: RollerGrid, load: float) -> float:
    """Derivative of the dry approach by the load, as a quotient over 0.85 to 1.15 of it; NaN where it is not found.

    Nodes begin to touch one after another: a quotient is smoother than the slope at one load. By the power of the
    approach over load, 2/3 to 1, it is at most 0.2 % too large.

    Parameters
    ----------
    grid : RollerGrid
        The grid.
    load : float
        Integral of P.
    """
    ends = [dry_contact(grid.kernel, grid.parabola, grid.weights, part * load) for part in (1.0 - _PART, 1.0 + _PART)]
    heights = [math.nan if end is None else end.height for end in ends]
    return (heights[0] - heights[1]) / (2.0 * _PART * load)


def dry_extent(
    depth: Callable[[FloatArray], FloatArray], half_length: float, corners: Sequence[float]
) -> tuple[float, float] | None:
    """Place across where the dry contact ends, and its highest load per length over the mean; None if not found.

    Parameters
    ----------
    depth : callable
        Z of places Y, in units of the line with the mean load per length.
    half_length : float
        Half of the roller's length, in the same units.
    corners : sequence of float
        Corners of the profile.
    """
    y = _across(half_length, [*corners, 0.9 * half_length], 0.3, _COARSE_ACROSS)
    x = np.linspace(-_COARSE_REACH, _COARSE_REACH, _COARSE_ALONG + 1)
    gap = 0.5 * x[:, None] ** 2 + depth(y)[None, :]
    weights = 2.0 * np.outer(node_widths(x), node_widths(y))
    found = dry_contact(grid_kernel(x, y, 0.5 / math.pi), gap, weights, math.pi * half_length)
    if found is None:
        return None
    along = found.pressure.T @ node_widths(x)
    # sharp ends have loads without a bound: those of the inner half count
    return float(y[np.flatnonzero(along > 0.0)[-1]]), float(np.max(along[y <= 0.5 * half_length]) / (0.5 * math.pi))


def _across(half_length: float, places: Sequence[float], end_cell: float, cells: int) -> FloatArray:
    """Nodes across, small at some places."""
    fine = np.linspace(0.0, half_length, _SAMPLES)
    apart = np.min([np.abs(fine - place) for place in places], axis=0)
    density = 1.0 / np.minimum(end_cell + _GROWTH * apart, _LARGEST_PART * half_length)
    count = np.r_[0.0, np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(fine))]
    nodes = np.interp(np.linspace(0.0, count[-1], cells + 1), count, fine)
    nodes[0], nodes[-1] = 0.0, half_length
    return np.asarray(nodes)
