"""Stiffness and damping of the film: linear response of the discrete transient equations about the steady solution.

A small load dW(T) moves the far bodies by dH0: dH0/dW = -a + i Omega b + O(Omega^2), Omega = omega b/u. `a` is the
compliance of the contact in the log kernel's datum (it contains the dry ln(2)/pi), `b` its low-frequency loss.

The pressure spike of a strongly piezoviscous contact is a front far narrower than a cell. On a grid that stands still
the front is locked to its cell, and the tangent is that of a staircase. So the grid's spike follows an isobar of the
front: its position is one more unknown, and the pressure at the front's node is held. In the limit of fine grids the
response does not depend on how the grid moves.
"""

from __future__ import annotations

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
    """Film compliance a - ln(2)/pi and loss b, dimensionless; at Omega > 0 real part and -imaginary part over Omega."""

    compliance: float
    loss: float


def film_response(
    problem: LineProblem,
    grid: Grid,
    kernel: FloatArray,
    unknowns: FloatArray,
    load: float,
    neighbour: Neighbour | None = None,
    frequency: float = 0.0,
) -> Response:
    """Film and loss compliance at a converged solution.

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
    frequency : float
        Omega = omega b/u; 0 is the low-frequency limit.
    """
    size = unknowns.size
    n = size - 2
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
    unit = np.zeros(total)
    unit[n + 1] = 1.0
    _, carried = stored_mass(problem, grid.x, grid.step, kernel, unknowns)

    def storage(rate: FloatArray) -> FloatArray:
        """What the time derivative adds to the residual for a rate of the unknowns (and of the spike)."""
        added = np.zeros(total)
        mass_rate = stored_mass_rate(problem, grid.x, grid.step, kernel, unknowns, rate[:size]) - carried * rate[n]
        if grid_mass is not None:
            mass_rate += grid_mass * rate[size]
        added[:n] = -mass_rate[:n]
        added[n] = mass_rate[n]
        return added

    if frequency == 0.0:
        scale = 1.0 / np.max(np.abs(matrix), axis=1)
        factors = lu_factor(matrix * scale[:, None], overwrite_a=True, check_finite=False)
        static = lu_solve(factors, scale * unit, check_finite=False)
        slow = lu_solve(factors, -scale * storage(static), check_finite=False)
        return Response(compliance=-float(static[n + 1]) - DRY_COMPLIANCE, loss=float(slow[n + 1]))
    rates = np.column_stack([storage(column) for column in np.eye(total)])
    dynamic = np.linalg.solve(matrix + 1j * frequency * rates, unit.astype(complex))[n + 1]
    return Response(compliance=-float(dynamic.real) - DRY_COMPLIANCE, loss=float(dynamic.imag) / frequency)


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
