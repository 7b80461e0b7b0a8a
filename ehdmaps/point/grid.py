"""Nodes about a point contact, and the deflection of the half-spaces by pressures on them.

A tensor grid of half of the contact (it is symmetric in y), its cells small where the dry contact ends and growing in
proportion to the distance outside. Pressures are bilinear between nodes, so that the deflection is exact: 1/r is the
fourth derivative G_xxyy of

    G = x^2 |y|/2 asinh(|y|/|x|) + |x| y^2/2 asinh(|x|/|y|) - r^3/6,

and the deflection by a hat the second difference of second differences of G.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.compiled import njit
from ehdmaps.copies import put
from ehdmaps.physics.point.ellipse import elliptic_numbers
from ehdmaps.point.tail import Tail, far_tail

OUTLET = 0.4
"""Length of the outlet over that of the inlet: at the sides the film of the far field breaks as far behind the centre.
"""

GROWTH = 2.0
"""Growth of the cells outside with the distance from the contact, over their size at its edge in x; over the square
root of `Cells.edge` where that is below one."""

_EDGE, _CORE = 0.55, 1.1
_MOST_KERNELS = 12
_BESIDE = 1e-3
_SAMPLES = 5001
_TOUCHING = 1e-14


@dataclass(frozen=True)
class Cells:
    """Size of a grid.

    Attributes
    ----------
    along, across : int
        Cells in x, and in y of one half.
    inlet : float
        Length of the inlet before the contact centre [a, times the scale].
    edge : float
        Size of the cells where the dry contact ends, over that of a film which is not thin; a thin film has a short
        inlet zone.
    """

    along: int
    across: int
    inlet: float = 8.0
    edge: float = 1.0


@dataclass(frozen=True, eq=False)
class PointGrid:
    """A grid and all of it that no load changes.

    Attributes
    ----------
    ellipticity : float
        Ellipticity kappa.
    scale : float
        Stretch of the grid against the dry contact; above 1 for films as thick as that is wide.
    x, y : ndarray, shape (n,), (m,)
        Nodes along and across [a]; y begins at 0.
    kernel : ndarray, shape (n m, n m)
        Deflection at the nodes by the pressures at the nodes, those of the other half included.
    tail : Tail
        Pressure before and beside the grid.
    """

    ellipticity: float
    scale: float
    x: FloatArray
    y: FloatArray
    kernel: FloatArray
    tail: Tail

    @cached_property
    def curvature_ratio(self) -> float:
        """D = Rx/Ry."""
        return float(elliptic_numbers(self.ellipticity).curvature_ratio)

    @cached_property
    def elasticity(self) -> float:
        """Factor g/pi of the deflection."""
        return float(elliptic_numbers(self.ellipticity).pressure_factor) / math.pi

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Nodes along and across."""
        return self.x.size, self.y.size

    @cached_property
    def parabola(self) -> FloatArray:
        """Gap of the undeformed bodies that touch, X^2/2 + D Y^2/2, shape (n, m)."""
        return np.asarray(0.5 * self.x[:, None] ** 2 + 0.5 * self.curvature_ratio * self.y[None, :] ** 2)

    @cached_property
    def areas(self) -> FloatArray:
        """Area of each node in the half, shape (n, m)."""
        return np.outer(node_widths(self.x), node_widths(self.y))

    @cached_property
    def weights(self) -> FloatArray:
        """Weight of each pressure in the load, both halves, shape (n, m)."""
        return 2.0 * self.areas

    @cached_property
    def inner(self) -> BoolArray:
        """Nodes with an equation of flow, shape (n, m)."""
        inside = np.zeros(self.shape, dtype=bool)
        inside[1:-1, :-1] = True
        return inside

    def deflection(self, pressure: FloatArray) -> FloatArray:
        """Deflection at the nodes by pressures there, both of shape (n, m)."""
        return np.asarray((self.kernel @ pressure.ravel()).reshape(self.shape))

    def hertz_pressure(self) -> FloatArray:
        """Pressure of an ellipse of the grid's scale with the load of the dry contact, shape (n, m)."""
        x, y = self.x[:, None] / self.scale, self.y[None, :] / (self.ellipticity * self.scale)
        return np.asarray(np.sqrt(np.maximum(1.0 - x * x - y * y, 0.0)) / self.scale**2)


@lru_cache(maxsize=_MOST_KERNELS)
def point_grid(ellipticity: float, scale: float, cells: Cells) -> PointGrid:
    """Make a grid; those made last are kept, since loads and oils share them.

    Parameters
    ----------
    ellipticity : float
        Ellipticity kappa.
    scale : float
        Stretch of the grid.
    cells : Cells
        Size of the grid.
    """
    ratio = float(elliptic_numbers(ellipticity).curvature_ratio)
    x = scale * nodes_along(cells.edge, cells.inlet, cells.along)
    side = max(1.7 * ellipticity, ellipticity + 1.0, 0.8 * cells.inlet / math.sqrt(ratio))
    y = scale * _graded(_size_across(ellipticity, cells.edge), 0.0, side, cells.across)
    return grid_on(ellipticity, scale, x, y)


def grid_on(ellipticity: float, scale: float, x: FloatArray, y: FloatArray) -> PointGrid:
    """Grid on given nodes.

    Parameters
    ----------
    ellipticity : float
        Ellipticity kappa.
    scale : float
        Size of the pressures that a start has, over that of the dry contact.
    x, y : ndarray, shape (n,), (m,)
        Nodes along, from before the contact to behind it, and across, from 0 [a].
    """
    numbers = elliptic_numbers(ellipticity)
    kernel = grid_kernel(x, y, float(numbers.pressure_factor) / math.pi)
    return PointGrid(ellipticity, scale, x, y, kernel, far_tail(x, y, float(numbers.curvature_ratio)))


def nodes_along(edge: float, inlet: float, cells: int) -> FloatArray:
    """Nodes along, from before the contact to behind it [a].

    Parameters
    ----------
    edge : float
        Size of the cells where the dry contact ends, see `Cells`.
    inlet : float
        Length of the inlet before the contact centre.
    cells : int
        Number of cells.
    """
    return _graded(_size_along(edge), -inlet, OUTLET * inlet, cells)


def _size_along(edge: float) -> Callable[[FloatArray], FloatArray]:
    """Relative size of the cells along."""
    least = _EDGE * edge
    places = (-1.15, -0.9, -0.3, 0.3, 0.75, 1.1, 1.6)
    sizes = (least, 0.6 * edge, _CORE, _CORE, least, least, 1.5)

    def size(x: FloatArray) -> FloatArray:
        outside = GROWTH / math.sqrt(edge) * (np.maximum(-1.15 - x, 0.0) + np.maximum(x - 1.6, 0.0))
        return np.asarray(np.interp(x, places, sizes) + outside)

    return size


def _size_across(ellipticity: float, edge: float) -> Callable[[FloatArray], FloatArray]:
    """Relative size of the cells across, for an ellipticity."""

    def size(y: FloatArray) -> FloatArray:
        core = ellipticity * np.interp(y / ellipticity, (0.0, 0.4, 0.8, 1.0), (1.2, 1.1, 0.6, 0.45 * edge))
        return np.asarray(core + 1.2 * GROWTH / math.sqrt(edge) * np.maximum(y - 1.05 * ellipticity, 0.0))

    return size


def _graded(size: Callable[[FloatArray], FloatArray], low: float, high: float, cells: int) -> FloatArray:
    """Nodes of so many cells from low to high, each as large as its place asks for, up to one factor."""
    fine = np.r_[np.linspace(low, high, _SAMPLES), np.linspace(max(low, -3.0), min(high, 3.0), _SAMPLES)]
    fine.sort(kind="stable")  # two rising parts: one pass
    fine = fine[np.r_[True, np.diff(fine) > 0.0]]
    density = 1.0 / size(fine)
    count = np.r_[0.0, np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(fine))]
    nodes = np.interp(np.linspace(0.0, count[-1], cells + 1), count, fine)
    nodes[0], nodes[-1] = low, high
    return np.asarray(nodes)


def node_widths(nodes: FloatArray) -> FloatArray:
    """Half the cells on both sides of each node.

    Parameters
    ----------
    nodes : ndarray, shape (k,)
        Rising places.
    """
    half = 0.5 * np.diff(nodes)
    return np.asarray(np.r_[half, 0.0] + np.r_[0.0, half])


@njit(fastmath=True)
def grid_kernel(x: FloatArray, y: FloatArray, factor: float) -> FloatArray:
    """Deflection at each node by the hat of each node and by its image in the other half, times a factor.

    Hats at the ends of the grid are half ones: beyond, they fall to zero over a small part of a cell. G is even in both
    distances: each pair of places along, and of places across, is looked at once.

    Parameters
    ----------
    x, y : ndarray, shape (n,), (m,)
        Nodes along and across; y begins at 0.
    factor : float
        Factor of the deflection.
    """
    n, m = x.size, y.size
    along, across = np.empty(n + 2), np.empty(m + 1)
    put(x, along[1 : n + 1])
    put(y, across[:m])
    along[0] = x[0] - _BESIDE * (x[1] - x[0])
    along[n + 1] = x[n - 1] + _BESIDE * (x[n - 1] - x[n - 2])
    across[m] = y[m - 1] + _BESIDE * (y[m - 1] - y[m - 2])
    pairs = m * (m + 3) // 2
    apart, place = np.empty(2 * pairs), np.empty((m, 2 * m + 1), dtype=np.int64)  # distances across, and where they are
    pair = 0
    for j in range(m):
        for s in range(j, m + 1):
            apart[pair], apart[pairs + pair] = across[s] - y[j], across[s] + y[j]
            place[j, m - s] = pairs + pair
            place[j, m + s] = pair
            if s < m:
                place[s, m - j] = pairs + pair
                place[s, m + j] = pair
            pair += 1
    logs, values = np.log(np.maximum(apart, _TOUCHING)), np.empty(2 * pairs)
    whole = np.empty(2 * m + 1)
    for j in range(m + 1):
        whole[m + j], whole[m - j] = across[j], -across[j]
    rates = 1.0 / np.diff(whole)
    line, bent = np.empty(2 * m + 1), np.empty(2 * m + 1)
    second = np.empty((n, n + 2, m, m))  # second differences across
    for i in range(n):
        for k in range(n + 2):
            if 0 < k <= i:  # seen from there
                second[i, k] = second[k - 1, i + 1]
                continue
            _fourfold(abs(x[i] - along[k]), apart, logs, values)
            for j in range(m):
                out = second[i, k, j]
                for s in range(2 * m + 1):
                    line[s] = values[place[j, s]]
                for s in range(1, 2 * m):
                    bent[s] = (line[s - 1] - line[s]) * rates[s - 1] + (line[s + 1] - line[s]) * rates[s]
                out[0] = bent[m]
                for node in range(1, m):
                    out[node] = bent[m + node] + bent[m - node]
    kernel = np.empty((n * m, n * m))
    for i in range(n):
        for j in range(m):
            row = kernel[i * m + j]
            for k in range(1, n + 1):
                before, behind = factor / (along[k] - along[k - 1]), factor / (along[k + 1] - along[k])
                first, own, last = second[i, k - 1, j], second[i, k, j], second[i, k + 1, j]
                for node in range(m):
                    row[(k - 1) * m + node] = (first[node] - own[node]) * before + (last[node] - own[node]) * behind
    return kernel


@njit(fastmath=True)
def _fourfold(distance: float, apart: FloatArray, logs: FloatArray, values: FloatArray) -> None:
    """Values of G at a distance along and some across, whose logarithms are known."""
    touching = distance < _TOUCHING
    own, square = 0.0 if touching else math.log(distance), distance * distance
    for k in range(apart.size):
        far = apart[k]
        r = math.sqrt(square + far * far)
        values[k] = -r * r * r / 6.0
        if not touching:
            turned = distance * (math.log(far + r) - own) + far * (math.log(distance + r) - logs[k])
            values[k] += 0.5 * distance * far * turned
