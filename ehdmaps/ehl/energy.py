"""Energy in the film: its discrete equation across and along the film, with exact derivatives.

Columns stand at the faces of the grid. Lengths across are zeta = z/H, along X in b; with Y = rho U H,

    a H (Y T_X + W T_zeta) = T_zetazeta + Br H^2 rate tau - Cc H^2 T (rho_T/rho) U P_X,      W = -Int_0 Y_X dzeta
    walls:  T(X) = T_0 + B Int q(S)/sqrt(X - S) dS,   q = +- T_zeta/H    (see `wall_heat`)

Each Lobatto point has a cell as high as its weight. Conduction is that of the polynomial through the points, in weak
form: what a cell gives its neighbours get, and the heat that flows into a wall is what is left over in the wall's cell.
Along the film oil carries the temperature of where it comes from, extrapolated, and across it that of a parabola
through two points where it comes from and one where it goes. So the heat that goes into the walls and out with the oil
is the heat made, to rounding.

Before the column `first` the oil that enters has the temperature of the surfaces, and what flows back is lost.

The linear equations of all temperatures of a film: how these follow what changes.

They are solved column by column; those of columns with backflow, which see each other, together. Many right-hand sides
at once cost little: those of all unknowns of the film give the derivative of the temperatures by the pressures, and
with that the exact Jacobian of the film with its temperatures.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.reynolds import LineProblem, face_weights, node_pressure
from ehdmaps.ehl.warm_column import Columns


class EnergyEquations(NamedTuple):
    """Energy of all columns and its derivatives.

    The equations of a column are those of its k temperatures, of which the first and the last are Jaeger's of the
    walls, and those of the fluxes into lower and upper wall, flux less what the energy of the wall's cell leaves over.

    Attributes
    ----------
    residual : ndarray, shape (n, k)
        What is wrong with the temperatures; 0 up to `first`.
    itself, inverse : ndarray, shape (n, k, k)
        Derivative by the temperatures of the column itself, and its inverse.
    before, before_that : ndarray, shape (n, k, k)
        Derivatives by the temperatures of the two columns before.
    behind, behind_that : ndarray, shape (n, k)
        Derivatives by those of the two columns behind, at the same height.
    slopes : ndarray, shape (n, 3, 4, k + 2)
        Derivatives by pressure, film, gradient and flow of the column itself and of the two before.
    walls : ndarray, shape (2, n, n)
        Temperature of a wall per flux into it, lower and upper.
    flux : ndarray, shape (2, n)
        Heat into lower and upper wall.
    flux_warm : ndarray, shape (n, 3, 2, k)
        Derivatives of the fluxes by the temperatures of the column itself and of the two before.
    last_back : int
        Last column with backflow; `first` if there is none.
    """

    residual: FloatArray
    itself: FloatArray
    inverse: FloatArray
    before: FloatArray
    before_that: FloatArray
    behind: FloatArray
    behind_that: FloatArray
    slopes: FloatArray
    walls: FloatArray
    flux: FloatArray
    flux_warm: FloatArray
    last_back: int


def energy(
    problem: LineProblem, columns: Columns, face_step: FloatArray, walls: FloatArray, rises: FloatArray, first: int
) -> EnergyEquations:
    """Energy of all columns with its exact derivatives.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    columns : Columns
        Columns at these temperatures.
    face_step : ndarray, shape (n,)
        dx/ds at the faces.
    walls : ndarray, shape (n, n)
        Matrix of `wall_heat.wall_weights`.
    rises : ndarray, shape (n, k)
        Temperatures [K above T_0], zero up to `first`.
    first : int
        Last column that is not heated.
    """
    equations = _energy(problem, columns, face_step, walls, rises, first)
    if np.all(np.isfinite(equations.residual)):
        try:
            equations.inverse[first + 1 :] = np.linalg.inv(equations.itself[first + 1 :])
        except np.linalg.LinAlgError:
            equations.residual[first + 1 :] = math.nan
    return equations


@njit(forceinline=True)
def _add_product(matrix: FloatArray, vector: FloatArray, out: FloatArray) -> None:
    """Add a product of matrix and vector to the first entries of a row."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[1]):
            out[i] += matrix[i, j] * vector[j]


@njit
def _energy(
    problem: LineProblem, columns: Columns, face_step: FloatArray, walls: FloatArray, rises: FloatArray, first: int
) -> EnergyEquations:
    """`energy` without the inverses."""
    n, k, heat = face_step.size, rises.shape[1], problem.heat
    across, weights = heat.across, heat.across.weights
    out = np.zeros((n, k))
    itself, inverse = np.zeros((n, k, k)), np.zeros((n, k, k))
    before, before_that = np.zeros((n, k, k)), np.zeros((n, k, k))
    behind, behind_that, slopes = np.zeros((n, k)), np.zeros((n, k)), np.zeros((n, 3, 4, k + 2))
    taken = np.empty((2, n, n))
    taken[0], taken[1] = heat.lower * walls, heat.upper * walls
    flux, flux_warm = np.zeros((2, n)), np.zeros((n, 3, 2, k))
    last_back = first
    flow, place = columns.flow, columns.place
    own, by_one, by_two = np.empty((k, k)), np.empty((k, k)), np.empty((k, k))  # derivatives by Y of three columns
    for f in range(first + 1, n):
        film_here, gradient = place[f, 1], place[f, 2]
        here, one, two = rises[f], rises[f - 1], rises[f - 2]
        along = heat.convection * film_here / face_step[f]
        made = heat.dissipation * film_here * film_here
        total, matrix = out[f], itself[f]
        own[:] = 0.0
        by_one[:] = 0.0
        by_two[:] = 0.0
        for j in range(k):
            weight, y = weights[j], flow[f, j]
            share = along * weight
            # what enters and leaves between columns, its temperature extrapolated from where it comes
            leaves, enters = 1.5 * y - 0.5 * flow[f - 1, j], 1.5 * flow[f - 1, j] - 0.5 * flow[f - 2, j]
            at_wall = j == 0 or j == k - 1  # walls do not run back
            change = 0.0
            if leaves >= 0.0 or at_wall:
                change = 0.5 * (here[j] - one[j])
                matrix[j, j] += share * 0.5 * leaves
                before[f, j, j] -= share * 0.5 * leaves
            elif f < n - 1:
                last_back = f
                c1, c2 = (1.5, -0.5) if f < n - 2 else (1.0, 0.0)
                change = c1 * rises[f + 1, j] - here[j]
                if f < n - 2:
                    change += c2 * rises[f + 2, j]
                behind[f, j] += share * c1 * leaves
                behind_that[f, j] += share * c2 * leaves
                matrix[j, j] -= share * leaves
            carried = leaves * change
            own[j, j] += share * 1.5 * change
            by_one[j, j] -= share * 0.5 * change
            change = 0.0
            if enters >= 0.0 or at_wall:
                change = 1.5 * one[j] - 0.5 * two[j] - here[j]
                matrix[j, j] += share * enters
                before[f, j, j] -= share * 1.5 * enters
                before_that[f, j, j] += share * 0.5 * enters
            elif f < n - 1:
                last_back = f
                change = 0.5 * (here[j] - rises[f + 1, j])
                behind[f, j] += share * 0.5 * enters
                matrix[j, j] -= share * 0.5 * enters
            carried -= enters * change
            by_one[j, j] -= share * 1.5 * change
            by_two[j, j] += share * 0.5 * change
            warm = heat.temperature + here[j]
            rho, rho_warm = columns.density[f, j], columns.density_warm[f]
            pressed = weight * heat.compression * film_here * gradient * rho_warm / (rho * rho)
            squeezed = pressed * warm * y
            total[j] += share * carried - weight * made * columns.heat[f, j] + squeezed
            own[j, j] += pressed * warm
            matrix[j, j] += pressed * y * (1.0 - 2.0 * warm * rho_warm / rho)
            slopes[f, 0, 0, j] -= squeezed * columns.density_slope[f, j] / rho
            slopes[f, 0, 1, j] += (share * carried + squeezed) / film_here
            slopes[f, 0, 1, j] -= 2.0 * weight * made / film_here * columns.heat[f, j]
            for v in range(3):
                slopes[f, 0, v, j] -= weight * made * columns.heat_slopes[f, v, j]
            by_gradient = weight * heat.compression * film_here * rho_warm / (rho * rho) * warm * y
            slopes[f, 0, 2, j] += by_gradient
            for q in range(k):
                matrix[j, q] += by_gradient * columns.gradient_warm[f, q]
                matrix[j, q] += across.conduction[j, q] - weight * made * columns.heat_warm[f, j, q]
                total[j] += across.conduction[j, q] * here[q]
        # between the cells of a column
        upwards = 0.0
        for j in range(k - 1):
            upwards -= weights[j] * (1.5 * flow[f, j] - 2.0 * flow[f - 1, j] + 0.5 * flow[f - 2, j])
            carried = across.rising[j] if upwards >= 0.0 else across.falling[j]
            face = 0.0
            for q in range(k):
                face += carried[q] * here[q]
                matrix[j, q] += along * upwards * carried[q]
                matrix[j + 1, q] -= along * upwards * carried[q]
            matrix[j, j] -= along * upwards
            matrix[j + 1, j + 1] += along * upwards
            below, above = along * (face - here[j]), along * (here[j + 1] - face)
            total[j] += below * upwards
            total[j + 1] += above * upwards
            slopes[f, 0, 1, j] += below * upwards / film_here
            slopes[f, 0, 1, j + 1] += above * upwards / film_here
            for q in range(j + 1):
                own[j, q] -= 1.5 * weights[q] * below
                own[j + 1, q] -= 1.5 * weights[q] * above
                by_one[j, q] += 2.0 * weights[q] * below
                by_one[j + 1, q] += 2.0 * weights[q] * above
                by_two[j, q] -= 0.5 * weights[q] * below
                by_two[j + 1, q] -= 0.5 * weights[q] * above
        matrix += own @ columns.flow_warm[f]
        if f - 1 > first:
            before[f] += by_one @ columns.flow_warm[f - 1]
        if f - 2 > first:
            before_that[f] += by_two @ columns.flow_warm[f - 2]
        for v in range(4):
            _add_product(own, columns.flow_slopes[f, v], slopes[f, 0, v])
            _add_product(by_one, columns.flow_slopes[f - 1, v], slopes[f, 1, v])
            _add_product(by_two, columns.flow_slopes[f - 2, v], slopes[f, 2, v])
        # what the cell at a wall has left over flows into the wall
        for side in range(2):
            row = 0 if side == 0 else k - 1
            flux[side, f] = -total[row] / film_here
            for q in range(k):
                flux_warm[f, 0, side, q] = -matrix[row, q] / film_here
                flux_warm[f, 1, side, q] = -before[f, row, q] / film_here
                flux_warm[f, 2, side, q] = -before_that[f, row, q] / film_here
            for g in range(3):
                for v in range(4):
                    slopes[f, g, v, k + side] = slopes[f, g, v, row] / film_here
            slopes[f, 0, 1, k + side] += flux[side, f] / film_here
            itself_taken = taken[side, f, f]
            total[row] = here[row]
            for i in range(first + 1, f + 1):
                total[row] -= taken[side, f, i] * flux[side, i]
            for q in range(k):
                matrix[row, q] = -itself_taken * flux_warm[f, 0, side, q]
                before[f, row, q] = -itself_taken * flux_warm[f, 1, side, q]
                before_that[f, row, q] = -itself_taken * flux_warm[f, 2, side, q]
            matrix[row, row] += 1.0
            for g in range(3):
                for v in range(4):
                    slopes[f, g, v, row] = itself_taken * slopes[f, g, v, k + side]
        if not np.all(np.isfinite(matrix)):
            out[f] = np.nan
            break
    return EnergyEquations(
        out, itself, inverse, before, before_that, behind, behind_that, slopes, taken, flux, flux_warm, last_back
    )


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
    n, k, many = right.shape[0], right.shape[1] - 2, right.shape[2]
    temperatures, start, end = np.zeros((n, k, many)), first + 1, first + 1
    if equations.last_back > first:
        # columns with backflow and the two that these see, at once
        end = min(equations.last_back + 3, n)
        matrix, side = _together(equations, right, start, end)
        temperatures[start:end] = np.linalg.solve(matrix, side).reshape((end - start, k, many))
    _one_by_one(equations, right, first, end, temperatures)
    return temperatures


@njit
def _one_by_one(
    equations: EnergyEquations, right: FloatArray, first: int, start: int, temperatures: FloatArray
) -> None:
    """Fill the temperatures of the columns from `start` on; those before are known."""
    n, k, many = temperatures.shape
    fluxes = np.zeros((2, n, many))
    for f in range(first + 1, start):
        _wall_fluxes(equations, right, first, f, temperatures, fluxes)
    for f in range(start, n):
        side = right[f, :k].copy()
        if f - 1 > first:
            side -= equations.before[f] @ temperatures[f - 1]
            for wall in range(2):
                row = 0 if wall == 0 else k - 1
                side[row] += equations.walls[wall, f, first + 1 : f] @ fluxes[wall, first + 1 : f]
        if f - 2 > first:
            side -= equations.before_that[f] @ temperatures[f - 2]
        temperatures[f] = equations.inverse[f] @ side
        _wall_fluxes(equations, right, first, f, temperatures, fluxes)


@njit
def _wall_fluxes(
    equations: EnergyEquations, right: FloatArray, first: int, f: int, temperatures: FloatArray, fluxes: FloatArray
) -> None:
    """Fill the fluxes of a column into both walls, from its temperatures and those before it."""
    k = temperatures.shape[1]
    for wall in range(2):
        fluxes[wall, f] = right[f, k + wall]
        for g in range(min(3, f - first)):
            fluxes[wall, f] += equations.flux_warm[f, g, wall] @ temperatures[f - g]


@njit
def _together(equations: EnergyEquations, right: FloatArray, start: int, end: int) -> tuple[FloatArray, FloatArray]:
    """Matrix and right-hand sides of the columns from `start` to before `end`."""
    k, many = right.shape[1] - 2, right.shape[2]
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
        following = np.zeros((face_step.size, columns.flow.shape[1], unknowns.size + 1))
    else:
        following = marched(equations, _by_unknowns(equations, face_step, films, apart, first), first)
    return following, *_factor_rows(columns, face_step, films, apart, following)


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
    (n, size), k = films.shape, equations.residual.shape[1]
    right = np.zeros((n, k + 2, size + 1))
    for f in range(first + 1, n):
        for j in range(k):
            right[f, j, size] = -equations.residual[f, j]
        for g in range(3):
            slope, i = equations.slopes[f, g], f - g
            for j in range(k + 2):
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
    columns: Columns, face_step: FloatArray, films: FloatArray, apart: FloatArray, following: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Derivatives of mobilities and carriages by all unknowns, and what else changes them."""
    n, size = films.shape
    mobility, carriage = np.empty((n, size + 1)), np.empty((n, size + 1))
    for f in range(n):
        for which in range(2):
            rows, slope = (mobility, columns.mobility[f]) if which == 0 else (carriage, columns.carriage[f])
            warm = columns.mobility_warm[f] if which == 0 else columns.carriage_warm[f]
            line = warm @ following[f]
            for q in range(size):
                rows[f, q] = line[q] + slope[2] * films[f, q]
            rows[f, size] = line[size] + slope[3] * apart[f]
            if f > 0:
                rows[f, f - 1] += 0.5 * slope[1] - slope[3] / face_step[f]
            if f + 1 < n:
                rows[f, f] += 0.5 * slope[1] + slope[3] / face_step[f]
    return mobility, carriage
