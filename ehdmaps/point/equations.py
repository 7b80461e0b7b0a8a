"""Linear equations of a Newton step: what they do to a change, and their solution.

Factors are of single precision, half the cost, of which a step feels nothing. Each step has new equations, and hardly
other ones where it is small: then the factors of a step before, also of one with other free nodes, take the place of
new ones. They precondition Arnoldi's process, a few vectors of which, each a product with bands and kernel, hold the
solution; what these leave is solved for again where more digits are asked for.

References
----------
Y. Saad, Krylov subspace methods for solving large unsymmetric linear systems, Math. Comp. 37, 1981, 105-126.
J. Langou and others, Exploiting the performance of 32 bit floating point arithmetic in obtaining 64 bit accuracy, Proc.
Supercomputing 2006.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dgesv, dgetrf, dgetrs, sgetrf, sgetrs

from ehdmaps.arrays import BoolArray, FloatArray, IndexArray
from ehdmaps.ehl.spectrum import orthogonalised
from ehdmaps.point.grid import PointGrid
from ehdmaps.point.reynolds import Balance, changed, jacobian

MOST_VECTORS = 15
"""Vectors after which new factors cost less."""

LEAST_LEFT = 1e-5
"""What a solve by factors of single precision leaves at best."""


@dataclass(frozen=True, eq=False)
class Factors:
    """LU factors of the equations of free nodes, rows scaled.

    Attributes
    ----------
    found : Balance
        The equations.
    free : ndarray of bool, shape (n, m)
        Nodes whose pressure was unknown.
    lu : tuple of ndarray
        Factors of the transposed matrix and its pivots, as LAPACK gives them.
    scale : ndarray, shape (k + 1,)
        What rows were multiplied by.
    """

    found: Balance
    free: BoolArray
    lu: tuple[npt.NDArray[np.floating], IndexArray]
    scale: FloatArray

    def solved(self, right: FloatArray) -> FloatArray:
        """Solve for one right-hand side, shape (k + 1,).

        Parameters
        ----------
        right : ndarray, shape (k + 1,)
            Right-hand side: free nodes, then the load.
        """
        scaled = (right * self.scale).astype(self.lu[0].dtype)
        solve = dgetrs if self.double else sgetrs
        return np.asarray(solve(*self.lu, scaled, trans=1, overwrite_b=1)[0], dtype=np.float64)

    @property
    def double(self) -> bool:
        """True for factors of double precision."""
        return bool(self.lu[0].dtype == np.float64)


@dataclass(frozen=True, eq=False)
class Equations:
    """Equations of free pressures and H0 about a state.

    Attributes
    ----------
    grid : PointGrid
        The grid.
    found : Balance
        Equations at the nodes.
    free : ndarray of bool, shape (n, m)
        Nodes whose pressure is unknown.
    tail_slope : float
        Derivative of the load outside of the grid by H0.
    """

    grid: PointGrid
    found: Balance
    free: BoolArray
    tail_slope: float

    def factorised(self, double: bool = False) -> Factors | None:
        """Factors of these equations; None where they are singular.

        Parameters
        ----------
        double : bool
            Whether they are of double precision.
        """
        matrix, scale = jacobian(self.found, self.grid.kernel, self.free, self.grid.weights, self.tail_slope)
        if not np.all(np.isfinite(scale)):
            return None
        # columns first, as LAPACK has them: no copy
        lu, pivots, info = (dgetrf if double else sgetrf)(
            matrix.T if double else matrix.astype(np.float32).T, overwrite_a=1
        )
        return Factors(self.found, self.free, (lu, pivots), scale) if info == 0 else None

    def applied(self, change: FloatArray) -> FloatArray:
        """Change of the equations by one of free pressures and H0, both of shape (k + 1,).

        Parameters
        ----------
        change : ndarray, shape (k + 1,)
            Free pressures, then H0.
        """
        pressure = np.zeros(self.grid.shape)
        pressure[self.free] = change[:-1]
        film = self.grid.deflection(pressure) + change[-1]
        done = np.empty(change.size)
        done[:-1] = changed(self.found, pressure, film)[self.free]
        done[-1] = np.vdot(self.grid.weights, pressure) + self.tail_slope * change[-1]
        return done

    def solved(self, right: FloatArray, factors: Factors, tolerance: float) -> FloatArray | None:
        """Solution for a right-hand side, shape (k + 1,); None where these factors do not lead there.

        Parameters
        ----------
        right : ndarray, shape (k + 1,)
            Right-hand side: free nodes, then the load.
        factors : Factors
            Factors of these equations, or of those of a step nearby.
        tolerance : float
            What is left, over the solution.
        """
        if factors.double and factors.found is self.found:
            return factors.solved(right)
        found, left = np.zeros(right.size), right
        while True:
            part = self._part(left, factors, max(tolerance, LEAST_LEFT))
            if part is None:
                return None
            found += part
            tolerance /= LEAST_LEFT
            if tolerance >= 1.0:
                return found
            left = right - self.applied(found)

    def _part(self, right: FloatArray, factors: Factors, tolerance: float) -> FloatArray | None:
        """Solution in a few vectors; None where these do not hold it."""
        start = self._nearly(right, factors)
        norm = float(np.linalg.norm(start))
        if not 0.0 < norm < math.inf:
            return start if norm == 0.0 else None
        basis, hessenberg = np.empty((MOST_VECTORS + 1, start.size)), np.zeros((MOST_VECTORS + 1, MOST_VECTORS))
        basis[0] = start / norm
        for k in range(MOST_VECTORS):
            orthogonalised(self._nearly(self.applied(basis[k]), factors), basis, hessenberg, k)
            first = np.zeros(k + 1)
            first[0] = norm
            shares, info = dgesv(hessenberg[: k + 1, : k + 1], first)[2:]
            if info:
                continue
            if hessenberg[k + 1, k] * abs(shares[k]) <= tolerance * norm:
                return np.asarray(shares @ basis[: k + 1])
        return None

    def _nearly(self, right: FloatArray, factors: Factors) -> FloatArray:
        """Solution by the factors of other equations; a node that was not free then by its own equation alone."""
        if np.array_equal(self.free, factors.free):
            return factors.solved(right)
        whole, other = np.zeros(self.grid.shape), np.empty(factors.scale.size)
        whole[self.free] = right[:-1]
        other[:-1], other[-1] = whole[factors.free], right[-1]
        other = factors.solved(other)
        pressure, found = whole / self.own, np.empty(right.size)
        pressure[factors.free] = other[:-1]
        found[:-1], found[-1] = pressure[self.free], other[-1]
        return found

    @cached_property
    def own(self) -> FloatArray:
        """Derivative of each node's equation by its own pressure, shape (n, m)."""
        return own_slopes(self.grid, self.found)


def own_slopes(grid: PointGrid, found: Balance) -> FloatArray:
    """Derivative of each node's equation by its own pressure, shape (n, m).

    Parameters
    ----------
    grid : PointGrid
        The grid.
    found : Balance
        Equations at the nodes.
    """
    own = found.by_pressure[:, :, 0] + found.by_film[:, :, 0] * np.diagonal(grid.kernel).reshape(grid.shape)
    return np.maximum(own, 1e-300)
