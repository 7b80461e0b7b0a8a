"""The columns of a whole film with temperatures, at given unknowns or at the gradients that a flow asks of them."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.reynolds import YIELDING, LineProblem, cell_means, face_films, film, node_pressure, oil, upwind
from ehdmaps.ehl.warm_column import POINTS, Columns, fill_column, gradient_asked

HEATED_FROM = 100.0
"""Film over that of the flow through the contact at which heating begins: from 30 or 300 the central film of a light
contact in cold oil, 5 N/mm at 5 m/s and 20 degC, differs by 0.5 or 0.07 %, others by less."""


@njit
def first_column(gap: FloatArray, outflow: float) -> int:
    """The last face before which the film is thicker than `HEATED_FROM` times that of the flow; at least 1."""
    faces = face_films(gap)
    first = 1
    for f in range(faces.size - 4):
        if faces[f] < HEATED_FROM * outflow:
            break
        first = max(f, 1)
    return first


@njit
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


@njit
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


@njit
def asked_flows(
    problem: LineProblem,
    x: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    columns: Columns,
) -> FloatArray:
    """Mobility times dP/dX that the flow through the contact asks of each column that yields, NaN of others.

    Parameters
    ----------
    problem, x, kernel, unknowns
        The arguments of `reynolds.residual`.
    columns : Columns
        Columns at the gradients of the pressures.
    """
    n = x.size - 1
    pressure, gap = node_pressure(unknowns), film(x, kernel, unknowns)
    log_eta, slope, rho, rho_slope = oil(problem, pressure)
    means = cell_means(problem, log_eta - np.log(rho), slope - rho_slope / rho, pressure)[0]
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
