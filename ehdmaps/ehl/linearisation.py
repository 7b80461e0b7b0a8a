"""Stiffness and damping of the film: linear response of the discrete transient equations about the steady solution.

A small load dW(T) moves the far bodies by dH0: dH0/dW = -a + i Omega b + O(Omega^2), Omega = omega b/u. `a` is the
compliance of the contact in the log kernel's datum (it contains the dry ln(2)/pi), `b` its low-frequency loss.

The pressure spike of a strongly piezoviscous contact is a front far narrower than a cell. On a grid that stands still
the front is locked to its cell, and the tangent is that of a staircase. So the grid's spike follows an isobar of the
front: its position is one more unknown, and the pressure at the front's node is held. In the limit of fine grids the
response does not depend on how the grid moves.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgWarning, lu_factor

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.elastic import log_kernel
from ehdmaps.ehl.grid import Grid
from ehdmaps.ehl.reynolds import LineProblem, residual
from ehdmaps.ehl.stored_mass import StoredOil, stored_mass, stored_mass_rate, stored_oil
from ehdmaps.physics.hertz import DRY_COMPLIANCE


class Neighbour(NamedTuple):
    """A grid that differs from the solution's grid in the place of the spike only, by `shift` [b]."""

    grid: Grid
    shift: float
    node: int  # the node whose isobar the grid follows


class GridShift(NamedTuple):
    """A grid that differs from the solution's grid in its length only, by `shift` [b]."""

    grid: Grid
    shift: float


class Inlet(NamedTuple):
    """What the distance of a meniscus from the exit does, with the exit where it is.

    Attributes
    ----------
    residual : ndarray, shape (n + 2,)
        Derivative of the steady equations.
    mass : ndarray, shape (n + 1,)
        Derivative of the stored mass, as faces see it that move with the grid.
    """

    residual: FloatArray
    mass: FloatArray


class Response(NamedTuple):
    """Film compliance a - ln(2)/pi and loss b, dimensionless, of slow motion."""

    compliance: float
    loss: float


class Arrays(NamedTuple):
    """A `Linearisation` for compiled code.

    Attributes
    ----------
    scale : ndarray, shape (size,)
        What the rows were multiplied by, in the order of the factors.
    factors : ndarray, shape (size, size)
        LU factors of the scaled matrix, row by row.
    order : ndarray of int, shape (size,)
        The row of the matrix that each row of the factors stands for.
    x, kernel : ndarray, shapes (n + 1,) and (n + 1, n + 1)
        Nodes and deflection.
    exit_at : float
        Place of the exit.
    stored : StoredOil
        Stored oil of the nodes.
    carried : ndarray, shape (n + 1,)
        Mass per length that a face which moves with the exit sweeps.
    grid_mass : ndarray, shape (n + 1,)
        Stored mass per shift of the spike; zero where the grid follows none.
    """

    scale: FloatArray
    factors: FloatArray
    order: IntArray
    x: FloatArray
    kernel: FloatArray
    exit_at: float
    stored: StoredOil
    carried: FloatArray
    grid_mass: FloatArray


@njit(fastmath={"contract", "reassoc"})
def solved(linear: Arrays, right: FloatArray) -> FloatArray:
    """Solve matrix z = right, both of shape (size,)."""
    factors, size = linear.factors, right.size
    found = np.empty(size)
    for i in range(size):
        total = linear.scale[i] * right[linear.order[i]]
        row = factors[i]
        for j in range(i):
            total -= row[j] * found[j]
        found[i] = total
    for i in range(size - 1, -1, -1):
        total = found[i]
        row = factors[i]
        for j in range(i + 1, size):
            total -= row[j] * found[j]
        found[i] = total / row[i]
    return found


@njit
def storage(linear: Arrays, rate: FloatArray) -> FloatArray:
    """What the time derivative adds to the equations for a rate of the unknowns, both of shape (size,)."""
    n = linear.x.size - 1
    mass_rate = stored_mass_rate(linear.stored, linear.x, linear.kernel, linear.exit_at, rate[: n + 2])
    mass_rate -= linear.carried * rate[n]
    if rate.size > n + 2:
        mass_rate += linear.grid_mass * rate[n + 2]
    added = np.zeros(rate.size)
    for i in range(n):
        added[i] = -mass_rate[i]
    added[n] = mass_rate[n]
    return added


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
    inlet : Inlet or None
        What the place of the meniscus adds, of a starved contact. In the matrix the meniscus is held.
    """

    problem: LineProblem
    grid: Grid
    kernel: FloatArray
    unknowns: FloatArray
    matrix: FloatArray
    grid_mass: FloatArray | None
    inlet: Inlet | None = None

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

    @property
    def singular(self) -> bool:
        """Whether the film has no linear response: a pivot of its matrix is zero to the rounding of the numbers."""
        return not np.all(np.diagonal(self.arrays.factors))

    @cached_property
    def arrays(self) -> Arrays:
        """The same for compiled code, the matrix factorised."""
        grid, n = self.grid, self.unknowns.size - 2
        scale = 1.0 / np.max(np.abs(self.matrix), axis=1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LinAlgWarning)  # `singular` says it
            factors, swaps = lu_factor(self.matrix * scale[:, None], overwrite_a=True, check_finite=False)
        order = np.arange(self.size)
        carried = stored_mass(self.problem, grid.x, grid.step, self.kernel, self.unknowns)[1]
        if self.inlet is not None:  # the length grows as the exit moves away from the held meniscus
            carried = carried - self.inlet.mass
        for row, other in enumerate(swaps):
            order[row], order[other] = order[other], order[row]
        return Arrays(
            scale=scale[order],
            factors=np.ascontiguousarray(factors),
            order=order,
            x=grid.x,
            kernel=self.kernel,
            exit_at=float(self.unknowns[n]),
            stored=stored_oil(self.problem, grid.x, grid.step, self.kernel, self.unknowns),
            carried=carried,
            grid_mass=np.zeros(n + 1) if self.grid_mass is None else self.grid_mass,
        )

    def storage(self, rate: FloatArray) -> FloatArray:
        """What the time derivative adds to the equations for a rate of the unknowns, both of shape (size,)."""
        return storage(self.arrays, rate)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve matrix z = right, both of shape (size,)."""
        return solved(self.arrays, right)

    def slow_response(self) -> Response:
        """Film compliance and loss in the limit of slow motion."""
        static = self.solve(self.unit)
        slow = self.solve(-self.storage(static))
        return Response(compliance=-float(static[self.height]) - DRY_COMPLIANCE, loss=float(slow[self.height]))

    def supplied_compliance(self) -> float:
        """Film compliance of a starved contact whose meniscus follows until it takes the layer again.

        It is the slope of the film over the load at a given layer: what a slow load would feel, after a time that grows
        without bound towards the flooded contact. With the meniscus held see `slow_response`.

        Raises
        ------
        ValueError
            If there is no meniscus.
        """
        if self.inlet is None:
            raise ValueError("supplied_compliance: the contact is flooded, it has no meniscus")
        flow = self.height - 2
        right = np.zeros(self.size)
        right[: self.inlet.residual.size] = self.inlet.residual
        held, moved = self.solve(self.unit), self.solve(right)
        static = held[self.height] - moved[self.height] * held[flow] / moved[flow]
        return -float(static) - DRY_COMPLIANCE


def linearised(
    problem: LineProblem,
    grid: Grid,
    kernel: FloatArray,
    unknowns: FloatArray,
    load: float,
    neighbour: Neighbour | None = None,
    longer: GridShift | None = None,
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
    longer : GridShift, optional
        Needed where the grid begins at a meniscus, which is then held.
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
        by_grid, grid_mass = _by_grid(problem, grid, kernel, unknowns, load, out, neighbour.grid, neighbour.shift)
        matrix[:size, size] = by_grid
        matrix[size, neighbour.node - 1] = 1.0
    inlet: Inlet | None = None
    if longer is not None:
        inlet = Inlet(*_by_grid(problem, grid, kernel, unknowns, load, out, longer.grid, longer.shift))
        matrix[:size, size - 2] += inlet.residual  # the exit's column: the length is the exit less the held meniscus
    return Linearisation(problem, grid, kernel, unknowns, matrix, grid_mass, inlet)


def _by_grid(
    problem: LineProblem,
    grid: Grid,
    kernel: FloatArray,
    unknowns: FloatArray,
    load: float,
    here: FloatArray,
    moved: Grid,
    shift: float,
) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the residual and of the stored mass (as moving faces see it) with respect to a shift of nodes."""
    moved_kernel = log_kernel(moved.x, moved.step)
    there = np.empty(unknowns.size)
    scratch = np.empty((1, unknowns.size))
    residual(problem, moved.x, moved.step, moved.face_step, moved_kernel, unknowns, load, there, scratch)
    mass, carried = stored_mass(problem, grid.x, grid.step, kernel, unknowns)
    moved_mass, _ = stored_mass(problem, moved.x, moved.step, moved_kernel, unknowns)
    face_shift = np.append(moved.face - grid.face, moved.x[-1] - grid.x[-1])
    by_grid: FloatArray = (there - here) / shift
    return by_grid, (moved_mass - mass - carried * face_shift) / shift
