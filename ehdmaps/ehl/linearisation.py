"""Stiffness and damping of the film: linear response of the discrete transient equations about the steady solution.

A small load dW(T) moves the far bodies by dH0: dH0/dW = -a + i Omega b + O(Omega^2), Omega = omega b/u. `a` is the
compliance of the contact in the log kernel's datum (it contains the dry ln(2)/pi), `b` its low-frequency loss.

The pressure spike of a strongly piezoviscous contact is a front far narrower than a cell. On a grid that stands still
the front is locked to its cell, and the tangent is that of a staircase. So the grid's spike follows an isobar of the
front: its position is one more unknown, and the pressure at the front's node is held. In the limit of fine grids the
response does not depend on how the grid moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.elastic import log_kernel
from ehdmaps.ehl.grid import Grid
from ehdmaps.ehl.reynolds import LineProblem, residual, stored_mass, stored_mass_rate
from ehdmaps.physics.hertz import DRY_COMPLIANCE


class Neighbour(NamedTuple):
    """A grid that differs from the solution's grid in the place of the spike only, by `shift` [b]."""

    grid: Grid
    shift: float
    node: int  # the node whose isobar the grid follows


class Response(NamedTuple):
    """Film compliance a - ln(2)/pi and loss b, dimensionless, of slow motion."""

    compliance: float
    loss: float


@dataclass(frozen=True)
class Linearisation:
    """The transient equations to first order about a steady solution: matrix z + storage(dz/dT) = unit dW.

    Attributes
    ----------
    problem : LineProblem
        Dimensionless groups.
    grid : Grid
        The grid of the solution.
    kernel : ndarray, shape (n + 1, n + 1)
        Deflection at the nodes by the pressures at the nodes.
    unknowns : ndarray, shape (n + 2,)
        Converged unknowns on `grid`.
    matrix : ndarray, shape (size, size)
        Derivative of the steady equations; size is n + 2, or n + 3 where the grid follows the spike.
    grid_mass : ndarray, shape (n + 1,), or None
        Stored mass per shift of the spike.
    """

    problem: LineProblem
    grid: Grid
    kernel: FloatArray
    unknowns: FloatArray
    matrix: FloatArray
    grid_mass: FloatArray | None

    @property
    def size(self) -> int:
        """Number of unknowns, that of the spike's place included."""
        return int(self.matrix.shape[0])

    @property
    def height(self) -> int:
        """Index of H0 among the unknowns, and of the load among the equations."""
        return self.unknowns.size - 1

    @property
    def unit(self) -> FloatArray:
        """Right-hand side of a unit load, shape (size,)."""
        unit = np.zeros(self.size)
        unit[self.height] = 1.0
        return unit

    @cached_property
    def _carried(self) -> FloatArray:
        """Mass per length that a face which moves with the exit sweeps."""
        return stored_mass(self.problem, self.grid.x, self.grid.step, self.kernel, self.unknowns)[1]

    @cached_property
    def _factors(self) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
        """Scale of the rows, and LU factors of the scaled matrix."""
        scale = 1.0 / np.max(np.abs(self.matrix), axis=1)
        return scale, lu_factor(self.matrix * scale[:, None], overwrite_a=True, check_finite=False)

    def storage(self, rate: FloatArray) -> FloatArray:
        """What the time derivative adds to the equations for a rate of the unknowns, both of shape (size,)."""
        size = self.unknowns.size
        n = size - 2
        added = np.zeros(self.size)
        mass_rate = stored_mass_rate(self.problem, self.grid.x, self.grid.step, self.kernel, self.unknowns, rate[:size])
        mass_rate -= self._carried * rate[n]
        if self.grid_mass is not None:
            mass_rate += self.grid_mass * rate[size]
        added[:n] = -mass_rate[:n]
        added[n] = mass_rate[n]
        return added

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve matrix z = right, both of shape (size,)."""
        scale, factors = self._factors
        return np.asarray(lu_solve(factors, scale * right, check_finite=False))

    def slow_response(self) -> Response:
        """Film compliance and loss in the limit of slow motion."""
        static = self.solve(self.unit)
        slow = self.solve(-self.storage(static))
        return Response(compliance=-float(static[self.height]) - DRY_COMPLIANCE, loss=float(slow[self.height]))


def linearised(
    problem: LineProblem,
    grid: Grid,
    kernel: FloatArray,
    unknowns: FloatArray,
    load: float,
    neighbour: Neighbour | None = None,
) -> Linearisation:
    """The transient equations to first order about a converged solution.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    grid : Grid
        The grid of the solution.
    kernel : ndarray, shape (n + 1, n + 1)
        Deflection at the nodes by the pressures at the nodes.
    unknowns : ndarray, shape (n + 2,)
        Converged unknowns on `grid`.
    load : float
        Integral of the dimensionless pressure.
    neighbour : Neighbour, optional
        Needed where the grid has a spike term: the grid then follows the spike.
    """
    size = unknowns.size
    total = size + (neighbour is not None)
    matrix = np.zeros((total, total))
    out = np.empty(size)
    jacobian = np.empty((size, size))
    residual(problem, grid.x, grid.step, grid.face_step, kernel, unknowns, load, out, jacobian)
    matrix[:size, :size] = jacobian
    grid_mass: FloatArray | None = None
    if neighbour is not None:
        by_grid, grid_mass = _by_grid(problem, grid, kernel, unknowns, load, out, neighbour)
        matrix[:size, size] = by_grid
        matrix[size, neighbour.node - 1] = 1.0
    return Linearisation(problem, grid, kernel, unknowns, matrix, grid_mass)


def _by_grid(
    problem: LineProblem,
    grid: Grid,
    kernel: FloatArray,
    unknowns: FloatArray,
    load: float,
    here: FloatArray,
    neighbour: Neighbour,
) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the residual and of the stored mass (as moving faces see it) with respect to the spike's place."""
    moved, shift = neighbour.grid, neighbour.shift
    moved_kernel = log_kernel(moved.x, moved.step)
    there = np.empty(unknowns.size)
    scratch = np.empty((1, unknowns.size))
    residual(problem, moved.x, moved.step, moved.face_step, moved_kernel, unknowns, load, there, scratch)
    mass, carried = stored_mass(problem, grid.x, grid.step, kernel, unknowns)
    moved_mass, _ = stored_mass(problem, moved.x, moved.step, moved_kernel, unknowns)
    face_shift = np.append(moved.face - grid.face, moved.x[-1] - grid.x[-1])
    by_grid: FloatArray = (there - here) / shift
    return by_grid, (moved_mass - mass - carried * face_shift) / shift
