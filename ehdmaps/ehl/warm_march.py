"""The linear equations of all temperatures of a film: how these follow what changes.

They are solved column by column; those of columns with backflow, which see each other, together. Many right-hand sides
at once cost little: those of all unknowns of the film give the derivative of the temperatures by the pressures, and
with that the exact Jacobian of the film with its temperatures.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.energy import ROWS, EnergyEquations
from ehdmaps.ehl.reynolds import face_films
from ehdmaps.ehl.warm_column import POINTS, Columns


@njit(cache=True)
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
    n, k, many = right.shape[0], POINTS, right.shape[2]
    found, fluxes = np.zeros((n, k, many)), np.zeros((2, n, many))
    start = first + 1
    if equations.last_back > first:
        # columns with backflow and the two that these see, at once
        end = min(equations.last_back + 3, n)
        _together(equations, right, start, end, found)
        for f in range(start, end):
            _wall_fluxes(equations, right, first, f, found, fluxes)
        start = end
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
    return found


@njit(cache=True)
def _wall_fluxes(
    equations: EnergyEquations, right: FloatArray, first: int, f: int, found: FloatArray, fluxes: FloatArray
) -> None:
    """Fill the fluxes of a column into both walls, from its temperatures and those before it."""
    for wall in range(2):
        fluxes[wall, f] = right[f, POINTS + wall]
        for g in range(min(3, f - first)):
            fluxes[wall, f] += equations.flux_warm[f, g, wall] @ found[f - g]


@njit(cache=True)
def _together(equations: EnergyEquations, right: FloatArray, start: int, end: int, found: FloatArray) -> None:
    """Temperatures of the columns from `start` to before `end` by elimination."""
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
    solved = np.linalg.solve(matrix, side)
    for f in range(start, end):
        for i in range(k):
            for q in range(many):
                found[f, i, q] = solved[(f - start) * k + i, q]


@njit(cache=True)
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


@njit(cache=True)
def followed(
    equations: EnergyEquations,
    columns: Columns,
    x: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    first: int,
    frozen: bool,
    apart: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Derivatives of temperatures, shape (n, k, n + 2), mobilities and carriages, shape (n, n + 2), by all unknowns.

    With `apart` there is one more at the end: what the gradients change that are apart from those of the columns.

    Parameters
    ----------
    equations : EnergyEquations
        The energy at the temperatures of these unknowns.
    columns : Columns
        The columns there.
    x, face_step, kernel, unknowns
        The arguments of `reynolds.residual`.
    first : int
        Last column that is not heated.
    frozen : bool
        Whether the temperatures stay as they are.
    apart : ndarray, shape (n,)
        dP/dX at the faces less that of the columns; of no length where it is the same.
    """
    n, k = face_step.size, POINTS
    size = n + 2
    nodes = np.empty((n + 1, size))
    for i in range(n + 1):
        for j in range(1, n):
            nodes[i, j - 1] = -kernel[i, j]
        nodes[i, n - 1], nodes[i, n], nodes[i, n + 1] = 0.0, unknowns[n] + x[i], 1.0
    films = np.empty((n, size))
    for j in range(size):
        column = face_films(nodes[:, j].copy())
        for f in range(n):
            films[f, j] = column[f]
    many = size + (apart.size > 0)
    right = np.zeros((n, ROWS, many))
    for f in range(n if frozen else first + 1, n):
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
                if many > size:
                    right[f, j, size] -= slope[2, j] * apart[i]
    found = np.zeros((n, k, many)) if frozen else marched(equations, right, first)
    mobility, carriage = np.empty((n, many)), np.empty((n, many))
    for f in range(n):
        for which in range(2):
            rows, slope = (mobility, columns.mobility[f]) if which == 0 else (carriage, columns.carriage[f])
            warm = columns.mobility_warm[f] if which == 0 else columns.carriage_warm[f]
            line = warm @ found[f]
            for q in range(size):
                rows[f, q] = line[q] + slope[2] * films[f, q]
            if many > size:
                rows[f, size] = line[size] + slope[3] * apart[f]
            if f > 0:
                rows[f, f - 1] += 0.5 * slope[1] - slope[3] / face_step[f]
            if f + 1 < n:
                rows[f, f] += 0.5 * slope[1] + slope[3] / face_step[f]
    return found, mobility, carriage
