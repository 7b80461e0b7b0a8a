"""The linear equations of all temperatures of a film: how these follow what changes.

They are solved column by column; those of columns with backflow, which see each other, together. Many right-hand sides
at once cost little: those of all unknowns of the film give the derivative of the temperatures by the pressures, and
with that the exact Jacobian of the film with its temperatures.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.energy import ROWS, EnergyEquations
from ehdmaps.ehl.reynolds import face_weights, node_pressure
from ehdmaps.ehl.warm_column import POINTS, Columns


def marched(equations: EnergyEquations, right: FloatArray, first: int) -> FloatArray:
    """Temperatures of the linear equations, shape (n, k, m), for m right-hand sides.

    Parameters
    ----------
    equations : EnergyEquations
        The equations.
    right : ndarray, shape (n, k + 2, m)
        Right-hand sides of the temperatures and of the fluxes into both walls.
    first : int
        Last column that is not heated.
    """
    n, many = right.shape[0], right.shape[2]
    found, start, end = np.zeros((n, POINTS, many)), first + 1, first + 1
    if equations.last_back > first:
        # columns with backflow and the two that these see, at once
        end = min(equations.last_back + 3, n)
        matrix, side = _together(equations, right, start, end)
        found[start:end] = np.linalg.solve(matrix, side).reshape((end - start, POINTS, many))
    _one_by_one(equations, right, first, end, found)
    return found


@njit
def _one_by_one(equations: EnergyEquations, right: FloatArray, first: int, start: int, found: FloatArray) -> None:
    """Fill the temperatures of the columns from `start` on; those before are known."""
    n, k, many = found.shape
    fluxes = np.zeros((2, n, many))
    for f in range(first + 1, start):
        _wall_fluxes(equations, right, first, f, found, fluxes)
    for f in range(start, n):
        side = right[f, :k].copy()
        if f - 1 > first:
            side -= equations.before[f] @ found[f - 1]
            for wall in range(2):
                row = 0 if wall == 0 else k - 1
                side[row] += equations.walls[wall, f, first + 1 : f] @ fluxes[wall, first + 1 : f]
        if f - 2 > first:
            side -= equations.before_that[f] @ found[f - 2]
        found[f] = equations.inverse[f] @ side
        _wall_fluxes(equations, right, first, f, found, fluxes)


@njit
def _wall_fluxes(
    equations: EnergyEquations, right: FloatArray, first: int, f: int, found: FloatArray, fluxes: FloatArray
) -> None:
    """Fill the fluxes of a column into both walls, from its temperatures and those before it."""
    for wall in range(2):
        fluxes[wall, f] = right[f, POINTS + wall]
        for g in range(min(3, f - first)):
            fluxes[wall, f] += equations.flux_warm[f, g, wall] @ found[f - g]


@njit
def _together(equations: EnergyEquations, right: FloatArray, start: int, end: int) -> tuple[FloatArray, FloatArray]:
    """Matrix and right-hand sides of the columns from `start` to before `end`."""
    k, many = POINTS, right.shape[2]
    size = (end - start) * k
    matrix, side = np.zeros((size, size)), np.empty((size, many))
    for f in range(start, end):
        at = (f - start) * k
        for i in range(k):
            for j in range(k):
                matrix[at + i, at + j] = equations.itself[f, i, j]
                if f - 1 >= start:
                    matrix[at + i, at - k + j] = equations.before[f, i, j]
                if f - 2 >= start:
                    matrix[at + i, at - 2 * k + j] = equations.before_that[f, i, j]
            if f + 1 < end:
                matrix[at + i, at + k + i] += equations.behind[f, i]
            if f + 2 < end:
                matrix[at + i, at + 2 * k + i] += equations.behind_that[f, i]
            for q in range(many):
                side[at + i, q] = right[f, i, q]
        for wall in range(2):
            row = at if wall == 0 else at + k - 1
            for i in range(start, f):
                taken = equations.walls[wall, f, i]
                for g in range(min(3, i - start + 1)):
                    there = (i - g - start) * k
                    for j in range(k):
                        matrix[row, there + j] -= taken * equations.flux_warm[i, g, wall, j]
                for q in range(many):
                    side[row, q] += taken * right[i, k + wall, q]
    return matrix, side


@njit
def stored(equations: EnergyEquations, columns: Columns, added: FloatArray) -> FloatArray:
    """Right-hand sides, shape (n, k + 2, 1), of what is added to the energy of the cells.

    Parameters
    ----------
    equations : EnergyEquations
        The equations.
    columns : Columns
        Columns of the film.
    added : ndarray, shape (n, k)
        What is added.
    """
    n, k = added.shape
    right = np.zeros((n, k + 2, 1))
    for f in range(n):
        for j in range(1, k - 1):
            right[f, j, 0] = -added[f, j]
        for wall in range(2):
            flux = -added[f, 0 if wall == 0 else k - 1] / columns.place[f, 1]
            right[f, k + wall, 0] = flux
            right[f, 0 if wall == 0 else k - 1, 0] = equations.walls[wall, f, f] * flux
    return right


def followed(
    equations: EnergyEquations | None,
    columns: Columns,
    x: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    first: int,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Derivatives of temperatures, shape (n, k, n + 3), mobilities and carriages, shape (n, n + 3), by all unknowns.

    The last ones are no derivatives: what the energy still asks of the temperatures changes, and what gradients change
    that are apart from those of the columns.

    Parameters
    ----------
    equations : EnergyEquations or None
        The energy at the temperatures of these unknowns; None where temperatures stay as they are.
    columns : Columns
        The columns there.
    x, face_step, kernel, unknowns
        The arguments of `reynolds.residual`.
    first : int
        Last column that is not heated.
    """
    apart = np.diff(node_pressure(unknowns)) / face_step - columns.place[:, 2]
    films = _films(x, kernel, float(unknowns[x.size - 1]))
    if equations is None:
        found = np.zeros((face_step.size, POINTS, unknowns.size + 1))
    else:
        found = marched(equations, _by_unknowns(equations, face_step, films, apart, first), first)
    return found, *_factor_rows(columns, face_step, films, apart, found)


@njit
def _films(x: FloatArray, kernel: FloatArray, exit_at: float) -> FloatArray:
    """Derivatives of the films at the faces by all unknowns, shape (n, n + 2)."""
    n = x.size - 1
    films = np.zeros((n, n + 2))
    for f in range(n):
        start, weights = face_weights(f, n)
        for i in range(4):
            if weights[i] != 0.0:
                for j in range(1, n):
                    films[f, j - 1] -= weights[i] * kernel[start + i, j]
                films[f, n] += weights[i] * (exit_at + x[start + i])
                films[f, n + 1] += weights[i]
    return films


@njit
def _by_unknowns(
    equations: EnergyEquations, face_step: FloatArray, films: FloatArray, apart: FloatArray, first: int
) -> FloatArray:
    """Right-hand sides of `marched` for all unknowns, and for what is left of the energy."""
    n, size = films.shape
    right = np.zeros((n, ROWS, size + 1))
    for f in range(first + 1, n):
        for j in range(POINTS):
            right[f, j, size] = -equations.residual[f, j]
        for g in range(3):
            slope, i = equations.slopes[f, g], f - g
            for j in range(ROWS):
                by_film, by_pressure, by_gradient = slope[1, j], 0.5 * slope[0, j], slope[2, j] / face_step[i]
                if by_film != 0.0:
                    for q in range(size):
                        right[f, j, q] -= by_film * films[i, q]
                if i > 0:
                    right[f, j, i - 1] -= by_pressure - by_gradient
                if i + 1 < n:
                    right[f, j, i] -= by_pressure + by_gradient
                right[f, j, n - 1] -= slope[3, j]
                right[f, j, size] -= slope[2, j] * apart[i]
    return right


@njit
def _factor_rows(
    columns: Columns, face_step: FloatArray, films: FloatArray, apart: FloatArray, found: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Derivatives of mobilities and carriages by all unknowns, and what else changes them."""
    n, size = films.shape
    mobility, carriage = np.empty((n, size + 1)), np.empty((n, size + 1))
    for f in range(n):
        for which in range(2):
            rows, slope = (mobility, columns.mobility[f]) if which == 0 else (carriage, columns.carriage[f])
            warm = columns.mobility_warm[f] if which == 0 else columns.carriage_warm[f]
            line = warm @ found[f]
            for q in range(size):
                rows[f, q] = line[q] + slope[2] * films[f, q]
            rows[f, size] = line[size] + slope[3] * apart[f]
            if f > 0:
                rows[f, f - 1] += 0.5 * slope[1] - slope[3] / face_step[f]
            if f + 1 < n:
                rows[f, f] += 0.5 * slope[1] + slope[3] / face_step[f]
    return mobility, carriage
