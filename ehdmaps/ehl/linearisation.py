"""The oil that a film stores: mass behind each face, how it goes with film and pressure, and its derivatives.

Sums as the fluxes of `reynolds` take them: in the uniform index of the grid, with the wedge's interpolation at the
faces.

Stiffness and damping of the film: linear response of the discrete transient equations about the steady solution.

A small load dW(T) moves the far bodies by dH0: dH0/dW = -a + i Omega b + O(Omega^2), Omega = omega b/u. `a` is the
compliance of the contact in the log kernel's datum (it contains the dry ln(2)/pi), `b` its low-frequency loss.

The pressure spike of a strongly piezoviscous contact is a front far narrower than a cell. On a grid that stands still
the front is locked to its cell, and the tangent is that of a staircase. So the grid's spike follows an isobar of the
front: its position is one more unknown, and the pressure at the front's node is held. In the limit of fine grids the
response does not depend on how the grid moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.copies import put
from ehdmaps.ehl.dense import Factorised, factorised, solved
from ehdmaps.ehl.grid import Grid, log_kernel
from ehdmaps.ehl.reynolds import LineProblem, film, node_pressure, oil, residual
from ehdmaps.physics.hertz import DRY_COMPLIANCE


@njit
def stored_mass(
    problem: LineProblem, x: FloatArray, step: FloatArray, kernel: FloatArray, unknowns: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Minus the oil mass between each face and the exit, and the mass per length rho H carried through the face.

    Both have shape (n + 1,): faces 0 .. n-1, then the exit node.
    """
    rho = oil(problem, node_pressure(unknowns))[2]
    mass = rho * film(x, kernel, unknowns)
    return accumulated(mass * step), carried_mass(mass)


class StoredOil(NamedTuple):
    """Change of the oil that a cell stores with film and pressure: all that the rate of a stored mass needs of the oil.

    Attributes
    ----------
    by_film : ndarray, shape (n + 1,)
        Stored oil of each node per film thickness: rho times the cell.
    by_pressure : ndarray, shape (n + 1,)
        Stored oil of each node per pressure at a standing film.
    """

    by_film: FloatArray
    by_pressure: FloatArray


@njit
def stored_oil(
    problem: LineProblem, x: FloatArray, step: FloatArray, kernel: FloatArray, unknowns: FloatArray
) -> StoredOil:
    """Stored oil of each node by film and pressure."""
    _, _, rho, rho_slope = oil(problem, node_pressure(unknowns))
    return StoredOil(rho * step, rho_slope * film(x, kernel, unknowns) * step)


@njit
def stored_mass_rate(
    stored: StoredOil, x: FloatArray, kernel: FloatArray, exit_at: float, rate: FloatArray
) -> FloatArray:
    """Derivative of `stored_mass`[0] for a rate of the unknowns, shape (n + 2,), on a grid that moves with the exit."""
    n = x.size - 1
    pressure_rate = node_pressure(rate)
    gap_rate = rate[n + 1] + (exit_at + x) * rate[n] - kernel @ pressure_rate
    return accumulated(stored.by_film * gap_rate + stored.by_pressure * pressure_rate)


@njit
def accumulated(density: FloatArray) -> FloatArray:
    """Minus the integral over s from each face (and from the exit: 0) to the exit; fourth order inside.

    Counted from the exit, where the film is thin: the inlet holds so much oil that its round-off would drown the rest.
    """
    n = density.size - 1
    total = np.empty(n + 1)
    total[n] = 0.0
    stored = (8.0 * density[n] + 5.0 * density[n - 1] - density[n - 2]) / 24.0
    total[n - 1] = -stored
    for f in range(n - 2, -1, -1):
        stored += (density[f] + 22.0 * density[f + 1] + density[f + 2]) / 24.0
        total[f] = -stored
    return total


@njit
def carried_mass(mass: FloatArray) -> FloatArray:
    """rho H at the faces, interpolated as in the wedge term, and at the exit node."""
    n = mass.size - 1
    carried = np.empty(n + 1)
    carried[0] = 0.5 * (mass[0] + mass[1])
    carried[1] = -0.125 * mass[0] + 0.75 * mass[1] + 0.375 * mass[2]
    for f in range(2, n):
        carried[f] = (mass[f - 2] - 5.0 * mass[f - 1] + 15.0 * mass[f] + 5.0 * mass[f + 1]) / 16.0
    carried[n] = mass[n]
    return carried


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
    """Derivatives by the distance of a meniscus from the exit, with the exit where it is.

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


class Masses(NamedTuple):
    """Quantities of a steady film that the rate of the stored mass needs.

    Attributes
    ----------
    stored : StoredOil
        Stored oil of the nodes.
    carried : ndarray, shape (n + 1,)
        Mass per length that a face which moves with the exit sweeps.
    by_spike : ndarray, shape (n + 1,)
        Stored mass per shift of the spike; zero where the grid follows none.
    """

    stored: StoredOil
    carried: FloatArray
    by_spike: FloatArray


class Arrays(NamedTuple):
    """A `Linearisation` for compiled code.

    Attributes
    ----------
    lu : Factorised
        The matrix, factorised.
    x, kernel : ndarray, shapes (n + 1,) and (n + 1, n + 1)
        Nodes and deflection.
    exit_at : float
        Place of the exit.
    masses : Masses
        What the rate of the stored mass needs.
    """

    lu: Factorised
    x: FloatArray
    kernel: FloatArray
    exit_at: float
    masses: Masses


@njit
def storage(linear: Arrays, rate: FloatArray) -> FloatArray:
    """Contribution of the time derivative to the equations for a rate of the unknowns, both of shape (size,)."""
    n = linear.x.size - 1
    mass_rate = stored_mass_rate(linear.masses.stored, linear.x, linear.kernel, linear.exit_at, rate[: n + 2])
    mass_rate -= linear.masses.carried * rate[n]
    if rate.size > n + 2:
        mass_rate += linear.masses.by_spike * rate[n + 2]
    added = np.zeros(rate.size)
    for i in range(n):
        added[i] = -mass_rate[i]
    added[n] = mass_rate[n]
    return added


@njit
def unit_load(linear: Arrays) -> FloatArray:
    """Right-hand side of a unit load."""
    unit = np.zeros(linear.lu.scale.size)
    unit[linear.x.size] = 1.0
    return unit


@dataclass(frozen=True)
class Linearisation:
    """The transient equations to first order about a steady solution: matrix z + storage(dz/dT) = unit dW.

    Attributes
    ----------
    matrix : ndarray, shape (size, size)
        Derivative of the steady equations; size is n + 2, or n + 3 where the grid follows the spike.
    arrays : Arrays
        The same for compiled code, the matrix factorised.
    slow : Response
        Film compliance and loss in the limit of slow motion.
    inlet : Inlet or None
        What the place of the meniscus adds, of a starved contact. In the matrix the meniscus is held.
    """

    matrix: FloatArray
    arrays: Arrays
    slow: Response
    inlet: Inlet | None = None

    @property
    def size(self) -> int:
        """Number of unknowns, that of the spike's place included."""
        return int(self.matrix.shape[0])

    @property
    def height(self) -> int:
        """Index of H0 among the unknowns, and of the load among the equations."""
        return self.arrays.x.size

    @property
    def unit(self) -> FloatArray:
        """Right-hand side of a unit load, shape (size,)."""
        return unit_load(self.arrays)

    @property
    def singular(self) -> bool:
        """True where the film has no linear response: a pivot of its matrix is zero to the rounding of the numbers."""
        return self.arrays.lu.singular

    def storage(self, rate: FloatArray) -> FloatArray:
        """Contribution of the time derivative to the equations for a rate of the unknowns, both of shape (size,)."""
        return storage(self.arrays, rate)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve matrix z = right, both of shape (size,)."""
        return solved(self.arrays.lu, right)

    def slow_response(self) -> Response:
        """Film compliance and loss in the limit of slow motion."""
        return self.slow

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
    follows = Neighbour(grid, 0.0, 0) if neighbour is None else neighbour
    lengthened = GridShift(grid, 0.0) if longer is None else longer
    matrix, lu, masses, static, slow, *inlet = _linearised(problem, grid, kernel, unknowns, load, follows, lengthened)
    arrays = Arrays(lu, grid.x, kernel, float(unknowns[-2]), masses)
    response = Response(compliance=-static - DRY_COMPLIANCE, loss=slow)
    return Linearisation(matrix, arrays, response, None if longer is None else Inlet(*inlet))


@njit
def _linearised(
    problem: LineProblem,
    grid: Grid,
    kernel: FloatArray,
    unknowns: FloatArray,
    load: float,
    neighbour: Neighbour,
    longer: GridShift,
) -> tuple[FloatArray, Factorised, Masses, float, float, FloatArray, FloatArray]:
    """Matrix, factors, masses, H0 of the static and of the next response, and the `Inlet`; a shift of zero is none."""
    size = unknowns.size
    n = size - 2
    here, jacobian = np.empty(size), np.empty((size, size))
    residual(problem, grid.x, grid.step, grid.face_step, kernel, unknowns, load, here, jacobian)
    mass, carried = stored_mass(problem, grid.x, grid.step, kernel, unknowns)
    stored = stored_oil(problem, grid.x, grid.step, kernel, unknowns)
    matrix, by_spike, longer_residual, longer_mass = jacobian, np.zeros(n + 1), np.zeros(size), np.zeros(n + 1)
    if neighbour.shift != 0.0:
        by_grid, by_spike = _by_grid(
            problem, grid, unknowns, load, here, mass, carried, neighbour.grid, neighbour.shift
        )
        matrix = np.zeros((size + 1, size + 1))
        for i in range(size):
            put(jacobian[i], matrix[i, :size])
            matrix[i, size] = by_grid[i]
        matrix[size, neighbour.node - 1] = 1.0
    if longer.shift != 0.0:
        longer_residual, longer_mass = _by_grid(
            problem, grid, unknowns, load, here, mass, carried, longer.grid, longer.shift
        )
        # the length is the exit less the held meniscus
        for i in range(size):
            matrix[i, n] += longer_residual[i]
        carried = carried - longer_mass
    masses = Masses(stored, carried, by_spike)
    linear = Arrays(factorised(matrix), grid.x, kernel, unknowns[n], masses)
    static = solved(linear.lu, unit_load(linear))
    slow = solved(linear.lu, storage(linear, static))
    return matrix, linear.lu, masses, static[n + 1], -slow[n + 1], longer_residual, longer_mass


@njit
def _by_grid(
    problem: LineProblem,
    grid: Grid,
    unknowns: FloatArray,
    load: float,
    here: FloatArray,
    mass: FloatArray,
    carried: FloatArray,
    moved: Grid,
    shift: float,
) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the residual and of the stored mass (as moving faces see it) with respect to a shift of nodes."""
    kernel = log_kernel(moved.x, moved.step)
    there = np.empty(unknowns.size)
    scratch = np.empty((1, unknowns.size))
    residual(problem, moved.x, moved.step, moved.face_step, kernel, unknowns, load, there, scratch)
    moved_mass, _ = stored_mass(problem, moved.x, moved.step, kernel, unknowns)
    n = grid.face.size
    swept = np.empty(n + 1)
    for f in range(n):
        swept[f] = carried[f] * (moved.face[f] - grid.face[f])
    swept[n] = carried[n] * (moved.x[n] - grid.x[n])
    return (there - here) / shift, (moved_mass - mass - swept) / shift
