"""Energy in the film: its discrete equation across and along the film, and the linear equations of its temperatures.

Columns stand at the faces of the grid. Lengths across are zeta = z/H, along X in b; with Y = rho U H,

    a H (Y T_X + W T_zeta) = T_zetazeta + Br H^2 rate tau - Cc H^2 T (rho_T/rho) U P_X,      W = -Int_0 Y_X dzeta
    walls:  T(X) = T_0 + B Int q(S)/sqrt(X - S) dS,   q = +- T_zeta/H    (J. C. Jaeger, Proc. R. Soc. NSW 76, 1942, 203)

by collocation across and upwind differences of second order along, which telescope: what leaves a column enters the
next one. So the heat that goes into the walls and out with the oil is the heat made. Before the column `first` the film
is so thick that the eddies in it are closed, and the oil has the temperature of the surfaces.

The equations of all temperatures, linearised, are solved column by column; those of columns with backflow, which see
each other, together. Many right-hand sides at once cost little: those of all unknowns of the film give the derivative
of the temperatures by the pressures, and with that the exact Jacobian of the film with its temperatures.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.reynolds import YIELDING, LineProblem, cell_means, face_films, film, node_pressure, oil, upwind
from ehdmaps.ehl.warm_column import (
    BEND,
    INTEGRAL,
    POINTS,
    SLOPE,
    Columns,
    fill_column,
    gradient_asked,
)

HEATED_FROM = 30.0
"""Film over that of the flow through the contact at which heating begins: from 10 or 100 the central film differs by
0.7 or 0.1 % at most."""


LARGEST_RISE = 30.0
"""Largest change of a temperature in one step [K]."""


class EnergyEquations(NamedTuple):
    """Energy of all columns and its derivatives; rows 0 and -1 of a column are those of the walls.

    Attributes
    ----------
    residual : ndarray, shape (n, k)
        What is wrong with the energy of each height; 0 up to `first`.
    itself, inverse : ndarray, shape (n, k, k)
        Derivative by the temperatures of the column itself, and its inverse.
    before, before_that : ndarray, shape (n, k, k)
        Derivatives by the temperatures of the two columns before.
    behind, behind_that : ndarray, shape (n, k)
        Derivatives by those of the two columns behind, at the same height.
    slopes : ndarray, shape (n, 3, 4, k)
        Derivatives by pressure, film, gradient and flow of the column itself and of the two before.
    walls : ndarray, shape (2, n, n)
        Temperature of a wall per flux into it, lower and upper.
    flux : ndarray, shape (2, n)
        T_zeta/H into lower and upper wall.
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
    last_back: int


@njit(cache=True)
def wall_weights(x: FloatArray, first: int) -> tuple[FloatArray, FloatArray]:
    """Matrices of Int q(S)/sqrt(X - S) dS and Int q(S) sqrt(X - S) dS from place `first` on, q linear between places.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Places along the wall [b].
    first : int
        Place before which nothing flows.
    """
    n = x.size
    slow, late = np.zeros((n, n)), np.zeros((n, n))
    for i in range(first + 1, n):
        for j in range(first, i):
            far, near = x[i] - x[j], x[i] - x[j + 1]
            if j + 1 == i:
                near = 0.0
            width = far - near
            a, b = math.sqrt(far), math.sqrt(near)
            total = 2.0 * width / (a + b)
            # Int of sqrt(t) dt, and of the distance from the nearer place, without differences of nearly equal numbers
            third = 2.0 / 3.0 * width * (far + a * b + near) / (a + b)
            part = third - near * total
            slow[i, j] += part / width
            slow[i, j + 1] += total - part / width
            fifth = 0.4 * width * (far * far + far * a * b + far * near + a * b * near + near * near) / (a + b)
            part = fifth - near * third
            late[i, j] += part / width
            late[i, j + 1] += third - part / width
    return slow, late


@njit(cache=True)
def first_column(gap: FloatArray, outflow: float) -> int:
    """The last face before which the film is thicker than `HEATED_FROM` times that of the flow; at least 1."""
    faces = face_films(gap)
    first = 1
    for f in range(faces.size - 4):
        if faces[f] < HEATED_FROM * outflow:
            break
        first = max(f, 1)
    return first


@njit(cache=True)
def fill_columns(
    problem: LineProblem,
    x: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    rises: FloatArray,
    asked: FloatArray,
    columns: Columns,
) -> None:
    """Fill all columns of a film.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    x, face_step, kernel, unknowns
        The arguments of `reynolds.residual`.
    rises : ndarray, shape (n, k)
        Temperatures [K above T_0].
    asked : ndarray, shape (n,)
        Flow that the gradient of a column follows, see `asked_flows`, NaN where it is that of the pressures; of no
        length where it is so everywhere.
    columns : Columns
        What is filled.
    """
    n = face_step.size
    pressure = node_pressure(unknowns)
    faces = face_films(film(x, kernel, unknowns))
    for f in range(n):
        middle = 0.5 * (pressure[f] + pressure[f + 1])
        gradient = (pressure[f + 1] - pressure[f]) / face_step[f]
        columns.gradient_warm[f] = 0.0
        follows = asked.size > 0 and not math.isnan(asked[f])
        if follows:
            gradient = gradient_asked(problem, middle, faces[f], rises[f], asked[f], gradient)
        fill_column(problem, f, middle, faces[f], gradient, unknowns[n - 1], rises[f], columns)
        if follows:
            steepness = columns.mobility[f, 0] + gradient * columns.mobility[f, 3]
            columns.gradient_warm[f] = -gradient / steepness * columns.mobility_warm[f]
            for j in range(POINTS):
                for q in range(POINTS):
                    columns.heat_warm[f, j, q] += columns.heat_slopes[f, 2, j] * columns.gradient_warm[f, q]
                    columns.flow_warm[f, j, q] += columns.flow_slopes[f, 2, j] * columns.gradient_warm[f, q]


@njit(cache=True)
def hold_gradients(problem: LineProblem, outflow: float, rises: FloatArray, columns: Columns) -> None:
    """Fill all columns at the gradients that they have, which no longer follow the temperatures.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    outflow : float
        Flow through the contact.
    rises : ndarray, shape (n, k)
        Temperatures [K above T_0].
    columns : Columns
        Columns of the film.
    """
    for f in range(columns.place.shape[0]):
        pressure, film_here, gradient = columns.place[f]
        columns.gradient_warm[f] = 0.0
        fill_column(problem, f, pressure, film_here, gradient, outflow, rises[f], columns)


@njit(cache=True)
def asked_flows(
    problem: LineProblem,
    x: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    rises: FloatArray,
    columns: Columns,
) -> FloatArray:
    """Mobility times dP/dX that the flow through the contact asks of each column that yields, NaN of others.

    Parameters
    ----------
    problem, x, face_step, kernel, unknowns
        The arguments of `reynolds.residual`.
    rises : ndarray, shape (n, k)
        Temperatures [K above T_0].
    columns : Columns
        Columns that are overwritten with those of the pressures.
    """
    n = face_step.size
    pressure, gap = node_pressure(unknowns), film(x, kernel, unknowns)
    log_eta, slope, rho, rho_slope = np.empty(n + 1), np.empty(n + 1), np.empty(n + 1), np.empty(n + 1)
    oil(problem, pressure, log_eta, slope, rho, rho_slope)
    means = cell_means(problem, log_eta - np.log(rho), slope - rho_slope / rho, pressure)[0]
    fill_columns(problem, x, face_step, kernel, unknowns, rises, np.empty(0), columns)
    asked = np.full(n, np.nan)
    for f in range(n):
        film_here, gradient = columns.place[f, 1], columns.place[f, 2]
        mobility, by_gradient = columns.mobility[f, 0], columns.mobility[f, 3]
        # with walls that slide the stress can pass its bound at one wall only, where points across are too few for the
        # sign of the slope
        if not mobility + abs(gradient * by_gradient) <= YIELDING * mobility:
            carried = 0.0
            weights = upwind(f)
            for k in range(4):
                if weights[k] != 0.0:
                    carried += weights[k] * rho[f - 2 + k] * gap[f - 2 + k]
            flow = columns.carriage[f, 0] * carried - unknowns[n - 1]
            asked[f] = flow * problem.wedge / (film_here**3 * means[f])
    return asked


@njit(cache=True)
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
        First matrix of `wall_weights`.
    rises : ndarray, shape (n, k)
        Temperatures [K above T_0], zero up to `first`.
    first : int
        Last column that is not heated.
    """
    n, k, heat = face_step.size, POINTS, problem.heat
    out = np.zeros((n, k))
    itself = np.zeros((n, k, k))
    inverse, before, before_that = np.zeros((n, k, k)), np.zeros((n, k, k)), np.zeros((n, k, k))
    behind, behind_that, slopes = np.zeros((n, k)), np.zeros((n, k)), np.zeros((n, 3, 4, k))
    taken = np.empty((2, n, n))
    taken[0], taken[1] = heat.lower * walls, heat.upper * walls
    flux = np.zeros((2, n))
    last_back = first
    flow, place = columns.flow, columns.place
    for f in range(first + 1, n):
        low = high = 0.0
        for q in range(k):
            low += SLOPE[0, q] * rises[f, q]
            high -= SLOPE[k - 1, q] * rises[f, q]
        flux[0, f], flux[1, f] = low / place[f, 1], high / place[f, 1]
    for f in range(first + 1, n):
        film_here, gradient = place[f, 1], place[f, 2]
        here, one, two = rises[f], rises[f - 1], rises[f - 2]
        along = heat.convection * film_here / face_step[f]
        across = -(INTEGRAL @ (1.5 * flow[f] - 2.0 * flow[f - 1] + 0.5 * flow[f - 2]))
        lean, bent = SLOPE @ here, BEND @ here
        own, by_one, by_two = np.zeros((k, k)), np.zeros((k, k)), np.zeros((k, k))  # derivatives by Y of three columns
        matrix = inverse[f]
        for j in range(1, k - 1):
            y = flow[f, j]
            carried = across[j] * lean[j]
            # what enters and leaves between columns, its temperature extrapolated from where it comes
            leaves, enters = 1.5 * y - 0.5 * flow[f - 1, j], 1.5 * flow[f - 1, j] - 0.5 * flow[f - 2, j]
            change = 0.0
            if leaves >= 0.0:
                change = 0.5 * (here[j] - one[j])
                matrix[j, j] += along * 0.5 * leaves
                before[f, j, j] -= along * 0.5 * leaves
            elif f < n - 1:
                last_back = f
                c1, c2 = (1.5, -0.5) if f < n - 2 else (1.0, 0.0)
                change = c1 * rises[f + 1, j] - here[j]
                if f < n - 2:
                    change += c2 * rises[f + 2, j]
                behind[f, j] += along * c1 * leaves
                behind_that[f, j] += along * c2 * leaves
                matrix[j, j] -= along * leaves
            carried += leaves * change
            own[j, j] += along * 1.5 * change
            by_one[j, j] -= along * 0.5 * change
            change = 0.0
            if enters >= 0.0:
                change = 1.5 * one[j] - 0.5 * two[j] - here[j]
                matrix[j, j] += along * enters
                before[f, j, j] -= along * 1.5 * enters
                before_that[f, j, j] += along * 0.5 * enters
            elif f < n - 1:
                last_back = f
                change = 0.5 * (here[j] - rises[f + 1, j])
                behind[f, j] += along * 0.5 * enters
                matrix[j, j] -= along * 0.5 * enters
            carried -= enters * change
            by_one[j, j] -= along * 1.5 * change
            by_two[j, j] += along * 0.5 * change
            warm = heat.temperature + here[j]
            rho, rho_warm = columns.density[f, j], columns.density_warm[f]
            pressed = heat.compression * film_here * gradient * rho_warm / (rho * rho)
            squeezed = pressed * warm * y
            made = heat.dissipation * film_here * film_here
            out[f, j] = along * carried - bent[j] - made * columns.heat[f, j] + squeezed
            own[j, j] += pressed * warm
            matrix[j, j] += pressed * y * (1.0 - 2.0 * warm * rho_warm / rho)
            slopes[f, 0, 0, j] -= squeezed * columns.density_slope[f, j] / rho
            slopes[f, 0, 1, j] += (along * carried + squeezed) / film_here
            slopes[f, 0, 1, j] -= 2.0 * made / film_here * columns.heat[f, j]
            for v in range(3):
                slopes[f, 0, v, j] -= made * columns.heat_slopes[f, v, j]
            slopes[f, 0, 2, j] += heat.compression * film_here * rho_warm / (rho * rho) * warm * y
            turned = heat.compression * film_here * rho_warm / (rho * rho) * warm * y
            for q in range(k):
                matrix[j, q] += turned * columns.gradient_warm[f, q]
                matrix[j, q] += along * across[j] * SLOPE[j, q] - BEND[j, q] - made * columns.heat_warm[f, j, q]
                swept = along * lean[j] * INTEGRAL[j, q]
                own[j, q] -= 1.5 * swept
                by_one[j, q] += 2.0 * swept
                by_two[j, q] -= 0.5 * swept
        matrix += own @ columns.flow_warm[f]
        if f - 1 > first:
            before[f] += by_one @ columns.flow_warm[f - 1]
        if f - 2 > first:
            before_that[f] += by_two @ columns.flow_warm[f - 2]
        for v in range(4):
            slopes[f, 0, v] += own @ columns.flow_slopes[f, v]
            slopes[f, 1, v] += by_one @ columns.flow_slopes[f - 1, v]
            slopes[f, 2, v] += by_two @ columns.flow_slopes[f - 2, v]
        for side in range(2):
            j = 0 if side == 0 else k - 1
            sign = 1.0 if side == 0 else -1.0
            total = here[j]
            for i in range(first + 1, f + 1):
                total -= taken[side, f, i] * flux[side, i]
            out[f, j] = total
            matrix[j, j] += 1.0
            for q in range(k):
                matrix[j, q] -= taken[side, f, f] * sign * SLOPE[j, q] / film_here
            slopes[f, 0, 1, j] += taken[side, f, f] * flux[side, f] / film_here
        if not np.all(np.isfinite(matrix)):
            out[f] = np.nan
            break
        itself[f] = matrix
        inverse[f] = np.linalg.inv(matrix)
    return EnergyEquations(
        out, itself, inverse, before, before_that, behind, behind_that, slopes, taken, flux, last_back
    )


@njit(cache=True)
def marched(
    equations: EnergyEquations, faces: FloatArray, right: FloatArray, flux: FloatArray, first: int
) -> FloatArray:
    """Temperatures of the linear equations, shape (n, k, m), for m right-hand sides.

    Parameters
    ----------
    equations : EnergyEquations
        The equations.
    faces : ndarray, shape (n,)
        H at the faces.
    right : ndarray, shape (n, k, m)
        Right-hand sides.
    flux : ndarray, shape (2, n, m)
        What comes to the fluxes into the walls besides that of the temperatures, for the columns behind.
    first : int
        Last column that is not heated.
    """
    n, k, many = right.shape
    found = np.zeros((n, k, many))
    taken = flux.copy()
    start = first + 1
    if equations.last_back > first:
        # columns with backflow and the two that these see, at once
        end = min(equations.last_back + 3, n)
        _together(equations, faces, right, flux, start, end, found)
        for f in range(start, end):
            taken[0, f] += (SLOPE[0] @ found[f]) / faces[f]
            taken[1, f] -= (SLOPE[k - 1] @ found[f]) / faces[f]
        start = end
    for f in range(start, n):
        _one_column(equations, faces, right, first, f, found, taken)
    return found


@njit(cache=True)
def _together(
    equations: EnergyEquations,
    faces: FloatArray,
    right: FloatArray,
    flux: FloatArray,
    start: int,
    end: int,
    found: FloatArray,
) -> None:
    """Temperatures of the columns from `start` to before `end` by elimination."""
    _, k, many = right.shape
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
        for g in range(start, f):
            there = (g - start) * k
            low, high = equations.walls[0, f, g], equations.walls[1, f, g]
            for j in range(k):
                matrix[at, there + j] -= low * SLOPE[0, j] / faces[g]
                matrix[at + k - 1, there + j] += high * SLOPE[k - 1, j] / faces[g]
            for q in range(many):
                side[at, q] += low * flux[0, g, q]
                side[at + k - 1, q] += high * flux[1, g, q]
    solved = np.linalg.solve(matrix, side)
    for f in range(start, end):
        for i in range(k):
            for q in range(many):
                found[f, i, q] = solved[(f - start) * k + i, q]


@njit(cache=True)
def _one_column(
    equations: EnergyEquations,
    faces: FloatArray,
    right: FloatArray,
    first: int,
    f: int,
    found: FloatArray,
    taken: FloatArray,
) -> None:
    """Temperatures of one column from those before it; its fluxes into the walls."""
    k = right.shape[1]
    side = right[f].copy()
    if f - 1 > first:
        side -= equations.before[f] @ found[f - 1]
        for wall in range(2):
            row = 0 if wall == 0 else k - 1
            side[row] += equations.walls[wall, f, first + 1 : f] @ taken[wall, first + 1 : f]
    if f - 2 > first:
        side -= equations.before_that[f] @ found[f - 2]
    found[f] = equations.inverse[f] @ side
    taken[0, f] += (SLOPE[0] @ found[f]) / faces[f]
    taken[1, f] -= (SLOPE[k - 1] @ found[f]) / faces[f]


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
    faces = columns.place[:, 1].copy()
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
    right, flux = np.zeros((n, k, many)), np.zeros((2, n, many))
    for f in range(n if frozen else first + 1, n):
        for g in range(3):
            slope, i = equations.slopes[f, g], f - g
            for j in range(k):
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
        for wall in range(2):
            part = -equations.flux[wall, f] / faces[f]
            for q in range(size):
                flux[wall, f, q] = part * films[f, q]
    found = right if frozen else marched(equations, faces, right, flux, first)
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


def warm_temperatures(
    problem: LineProblem,
    x: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    walls: FloatArray,
    first: int,
    rises: FloatArray,
    columns: Columns,
    asked: FloatArray,
    tolerance: float,
    most_steps: int,
) -> tuple[EnergyEquations, float, int]:
    """Temperatures of a film by Newton, from `rises`, which is overwritten: equations there, last step [K], steps.

    Parameters
    ----------
    problem, x, face_step, kernel, unknowns
        The arguments of `reynolds.residual`.
    walls : ndarray, shape (n, n)
        First matrix of `wall_weights`.
    first : int
        Last column that is not heated.
    rises : ndarray, shape (n, k)
        Temperatures [K above T_0].
    columns : Columns
        Columns of the film, on return those at its temperatures.
    asked : ndarray, shape (n,)
        Flow that the gradient of a column follows, see `asked_flows`, NaN where it is that of the pressures; of no
        length where it is so everywhere.
    tolerance : float
        Largest last step [K].
    most_steps : int
        Steps at most.
    """
    n, k = face_step.size, POINTS
    nothing = np.zeros((2, n, 1))
    last = math.inf
    count = 0
    while True:
        fill_columns(problem, x, face_step, kernel, unknowns, rises, asked, columns)
        equations = energy(problem, columns, face_step, walls, rises, first)
        if not np.all(np.isfinite(equations.residual)):
            return equations, math.inf, count
        if last <= tolerance or count >= most_steps:
            if asked.size > 0:
                hold_gradients(problem, unknowns[n - 1], rises, columns)
                equations = energy(problem, columns, face_step, walls, rises, first)
            return equations, last, count
        right = -equations.residual.reshape((n, k, 1))
        move = marched(equations, columns.place[:, 1].copy(), right, nothing, first)[:, :, 0]
        last = np.max(np.abs(move))
        if not math.isfinite(last):
            return equations, math.inf, count
        part = min(1.0, LARGEST_RISE / max(last, 1e-300))
        rises += part * move
        count += 1
