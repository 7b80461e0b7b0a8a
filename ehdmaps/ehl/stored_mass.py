"""The oil that a film stores: mass behind each face, how it goes with film and pressure, and its derivatives.

Sums as the fluxes of `reynolds` take them: in the uniform index of the grid, with the wedge's interpolation at the
faces.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.copies import put
from ehdmaps.ehl.reynolds import LineProblem, film, node_pressure, oil


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
    """How the oil that a cell stores goes with film and pressure: all that the rate of a stored mass needs of the oil.

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
def stored_mass_jacobian(
    problem: LineProblem, x: FloatArray, step: FloatArray, kernel: FloatArray, unknowns: FloatArray
) -> FloatArray:
    """Derivative of `stored_mass`[0] by the unknowns, shape (n + 1, n + 2), on a grid that moves with the exit."""
    n = x.size - 1
    _, _, rho, rho_slope = oil(problem, node_pressure(unknowns))
    gap = film(x, kernel, unknowns)
    weight = rho * step
    by_unknowns = np.empty((n + 1, n + 2))
    for j in range(1, n):
        column = -weight * kernel[:, j]
        column[j] += step[j] * rho_slope[j] * gap[j]
        put(accumulated(column), by_unknowns[:, j - 1])
    by_unknowns[:, n - 1] = 0.0
    put(accumulated(weight * (unknowns[n] + x)), by_unknowns[:, n])
    put(accumulated(weight), by_unknowns[:, n + 1])
    return by_unknowns


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
