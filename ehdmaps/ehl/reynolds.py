"""The discrete problem: Reynolds equation, film equation and load balance of one line contact, with their Jacobian.

Hertz-dimensionless: X in b, P in p_H, H in b^2/R, time in b/u. With lambda = 3 pi^2/(8 M^2),

    d/dX( rho H^3/(lambda eta) dP/dX ) = d(rho H)/dX + d(rho H)/dT,
    H = H0 + X^2/2 - (1/pi) Int P ln|X - S| dS,      Int P dX = W  (pi/2 for p_H and b of the same load).

The grid hangs on the exit X_exit of the film, where P = dP/dX = 0 (Reynolds' condition); X_exit is an unknown.
In integrated form the flux through every face equals the flux m that leaves the contact:

    F_f = rho H^3/(lambda eta) dP/dX - rho H + m = 0        faces f = 0 .. n-1
    F_n = rho H - m = 0                                     exit node
    F_n+1 = Int P dX - W = 0

Unknowns u = (P_1 .. P_n-1, m, X_exit, H0). What makes it work:

- Poiseuille flux: exponential fitting (Scharfetter & Gummel), Int rho/eta dP over a cell with ln(eta/rho) a parabola in
  P, raised to fourth order on the staggered grid wherever ln eta changes by less than some units from cell to cell;
- wedge: four-point upwind-biased interpolation (1, -5, 15, 5)/16, which damps the odd-even mode where the viscosity
  cuts the Poiseuille flux off;
- everything in the uniform index of the grid, so that the order survives grading.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from ehdmaps.arrays import FloatArray
from ehdmaps.copies import put
from ehdmaps.physics.isotherm import Isotherm, density, log_viscosity

FITTED_STEP = 3.0
"""Change of ln eta over three cells at which the fourth-order correction of the Poiseuille flux is faded by half."""


class LineProblem(NamedTuple):
    """Dimensionless groups of one line contact.

    Attributes
    ----------
    wedge : float
        lambda = 3 pi^2/(8 M^2).
    isotherm : Isotherm
        Viscosity and density over P: pressures in p_H.
    """

    wedge: float
    isotherm: Isotherm


_log_viscosity, _density = njit(cache=True)(log_viscosity), njit(cache=True)(density)


@njit(cache=True)
def oil(
    problem: LineProblem,
    pressure: FloatArray,
    log_eta: FloatArray,
    log_eta_slope: FloatArray,
    rho: FloatArray,
    rho_slope: FloatArray,
) -> None:
    """Fill ln eta, rho and their derivatives at each pressure; a negative trial pressure acts as zero on them."""
    for i in range(pressure.size):
        p = max(pressure[i], 0.0)
        log_eta[i], log_eta_slope[i] = _log_viscosity(problem.isotherm, p)
        rho[i], rho_slope[i] = _density(problem.isotherm, p)
        if pressure[i] < 0.0:
            log_eta_slope[i] = 0.0
            rho_slope[i] = 0.0


@njit(cache=True)
def steepest_viscosity_step(problem: LineProblem, unknowns: FloatArray, move: FloatArray) -> float:
    """Largest change of ln eta by a move of the unknowns, to first order."""
    largest = 0.0
    for i in range(unknowns.size - 3):
        slope = _log_viscosity(problem.isotherm, max(unknowns[i], 0.0))[1]
        largest = max(largest, abs(move[i]) * slope)
    return largest


@njit(cache=True)
def node_pressure(unknowns: FloatArray) -> FloatArray:
    """Pressure at all nodes, shape (n + 1,), from the unknowns, shape (n + 2,)."""
    n = unknowns.size - 2
    pressure = np.zeros(n + 1)
    put(unknowns, pressure[1:n])
    return pressure


@njit(cache=True)
def film(x: FloatArray, kernel: FloatArray, unknowns: FloatArray) -> FloatArray:
    """Film H at all nodes, shape (n + 1,) [b^2/R]."""
    n = x.size - 1
    deflection = kernel @ node_pressure(unknowns)
    gap: FloatArray = unknowns[n + 1] + 0.5 * (unknowns[n] + x) ** 2 - deflection
    return gap


@njit(cache=True)
def _bend(d: float) -> tuple[float, float]:
    """Weight r of a bend of ln eta in the mean of 1/eta, and its derivative; d is the step of ln eta.

    r = Int t (1 - t) exp(-d t) dt/Int exp(-d t) dt over 0 < t < 1, which is even in d.
    """
    if abs(d) < 0.1:
        return 1.0 / 6.0 - d * d / 360.0 + d**4 / 15120.0, -d / 180.0 + d**3 / 3780.0
    e = math.exp(-abs(d))
    cotangent = (1.0 + e) / (1.0 - e)  # coth |d|/2
    r = cotangent / abs(d) - 2.0 / (d * d)
    slope = 0.5 * (1.0 - cotangent * cotangent) / d - cotangent / (d * abs(d)) + 4.0 / d**3
    return r, slope


@njit(cache=True)
def _cell_flow(
    problem: LineProblem, kinematic: FloatArray, slope: FloatArray, pressure: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Integral of rho/eta dP over each cell, its derivatives by both end pressures, and the step of ln(eta/rho).

    `kinematic` is ln(eta/rho) at the nodes and `slope` its derivative by P. It is taken as a parabola in P through both
    ends and the middle of a cell; a straight line would leave an error of second order wherever the oil's law bends.
    """
    n = pressure.size - 1
    flow, left, right, jump = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    for f in range(n):
        halfway = max(0.5 * (pressure[f] + pressure[f + 1]), 0.0)
        log_eta, eta_slope = _log_viscosity(problem.isotherm, halfway)
        rho, rho_slope = _density(problem.isotherm, halfway)
        middle, middle_slope = log_eta - math.log(rho), eta_slope - rho_slope / rho
        d = min(300.0, max(-300.0, kinematic[f + 1] - kinematic[f]))
        if abs(d) > 1e-2:
            e = math.exp(-d)
            phi = (1.0 - e) / d
            dphi = (e * (d + 1.0) - 1.0) / (d * d)
        else:
            phi = 1.0 - 0.5 * d + d * d / 6.0 - d**3 / 24.0
            dphi = -0.5 + d / 3.0 - d * d / 8.0
        bend = 4.0 * (kinematic[f] + kinematic[f + 1]) - 8.0 * middle
        weight, weight_slope = _bend(d)
        mean = math.exp(0.5 * bend * weight - kinematic[f]) * phi
        by_step = dphi / phi + 0.5 * bend * weight_slope
        rise = pressure[f + 1] - pressure[f]
        by_left = 2.0 * weight * (slope[f] - middle_slope) - slope[f] * (1.0 + by_step)
        by_right = 2.0 * weight * (slope[f + 1] - middle_slope) + slope[f + 1] * by_step
        flow[f] = mean * rise
        left[f] = mean * (by_left * rise - 1.0)
        right[f] = mean * (by_right * rise + 1.0)
        jump[f] = d
    return flow, left, right, jump


@njit(cache=True)
def residual(
    problem: LineProblem,
    x: FloatArray,
    step: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    load: float,
    out: FloatArray,
    jacobian: FloatArray,
) -> float:
    """Residual into `out`, shape (n + 2,), and the smallest H as value.

    The exact Jacobian goes into `jacobian`, shape (n + 2, n + 2); one of shape (1, n + 2) is scratch, and none is made.
    """
    n = x.size - 1
    pressure = node_pressure(unknowns)
    outflow, exit_at = unknowns[n - 1], unknowns[n]
    log_eta, slope, rho, rho_slope = np.empty(n + 1), np.empty(n + 1), np.empty(n + 1), np.empty(n + 1)
    oil(problem, pressure, log_eta, slope, rho, rho_slope)
    gap = film(x, kernel, unknowns)
    mass = rho * gap
    kinematic, kinematic_slope = log_eta - np.log(rho), slope - rho_slope / rho
    flow, left, right, jump = _cell_flow(problem, kinematic, kinematic_slope, pressure)
    limit4 = FITTED_STEP**4
    by_film = np.empty(5)  # dF_f/dH at nodes f-2 .. f+2
    wanted = jacobian.shape[0] > 1
    for f in range(n):
        by_film[:] = 0.0
        row = jacobian[f if wanted else 0]
        row[:] = 0.0
        # film at the face: central inside, one-sided at the exit
        if f == 0:
            gap_face = 0.5 * (gap[0] + gap[1])
            weights = (0.0, 0.0, 0.5, 0.5, 0.0)
        elif f == n - 1:
            gap_face = (gap[f - 2] - 5.0 * gap[f - 1] + 15.0 * gap[f] + 5.0 * gap[f + 1]) / 16.0
            weights = (1.0 / 16.0, -5.0 / 16.0, 15.0 / 16.0, 5.0 / 16.0, 0.0)
        else:
            gap_face = (9.0 * (gap[f] + gap[f + 1]) - gap[f - 1] - gap[f + 2]) / 16.0
            weights = (0.0, -1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0)
        conductance = gap_face**3 / (problem.wedge * face_step[f])
        # Poiseuille flux, with the fourth-order correction where it is safe
        gradient = flow[f]
        middle = f if f < n - 1 else f - 1
        corrected = f > 0
        if corrected:
            curvature = flow[middle + 1] - 2.0 * flow[middle] + flow[middle - 1]
            jumps = jump[middle - 1] ** 2 + jump[middle] ** 2 + jump[middle + 1] ** 2
            fade = 1.0 / (1.0 + jumps * jumps / limit4)
            gradient -= fade * curvature / 24.0
            by_flow = -conductance * fade / 24.0
            by_jump = conductance * curvature / 24.0 * fade * fade * 4.0 * jumps / limit4
            for k in range(3):
                i = middle - 1 + k
                c = by_flow * (-2.0 if k == 1 else 1.0)
                d = by_jump * jump[i]
                if i > 0:
                    row[i - 1] += c * left[i] - d * kinematic_slope[i]
                if i + 1 < n:
                    row[i] += c * right[i] + d * kinematic_slope[i + 1]
        flux = conductance * gradient
        if f > 0:
            row[f - 1] += conductance * left[f]
        if f + 1 < n:
            row[f] += conductance * right[f]
        for k in range(5):
            by_film[k] = 3.0 * flux / gap_face * weights[k]
        # wedge
        if f == 0:
            upwind = (0.0, 0.0, 0.5, 0.5)
        elif f == 1:
            upwind = (0.0, -0.125, 0.75, 0.375)
        else:
            upwind = (1.0 / 16.0, -5.0 / 16.0, 15.0 / 16.0, 5.0 / 16.0)
        carried = 0.0
        for k in range(4):
            i = f - 2 + k
            if upwind[k] != 0.0:
                carried += upwind[k] * mass[i]
                by_film[k] -= upwind[k] * rho[i]
                if 0 < i < n:
                    row[i - 1] -= upwind[k] * rho_slope[i] * gap[i]
        out[f] = flux - carried + outflow
        row[n - 1] = 1.0
        for k in range(5):
            c = by_film[k]
            if wanted and c != 0.0:
                i = f - 2 + k
                line = kernel[i]
                for j in range(1, n):
                    row[j - 1] -= c * line[j]
                row[n] += c * (exit_at + x[i])
                row[n + 1] += c
    carried_load = 0.0
    for j in range(1, n):
        carried_load += step[j] * pressure[j]
    if wanted:
        last, total = jacobian[n], jacobian[n + 1]
        for j in range(1, n):
            last[j - 1] = -rho[n] * kernel[n, j]
            total[j - 1] = step[j]
        last[n - 1], last[n], last[n + 1] = -1.0, rho[n] * (exit_at + x[n]), rho[n]
        total[n - 1], total[n], total[n + 1] = 0.0, 0.0, 0.0
    out[n] = mass[n] - outflow
    out[n + 1] = carried_load - load
    lowest: float = np.min(gap)
    return lowest


@njit(cache=True)
def stored_mass(
    problem: LineProblem, x: FloatArray, step: FloatArray, kernel: FloatArray, unknowns: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Minus the oil mass between each face and the exit, and the mass per length rho H carried through the face.

    Both have shape (n + 1,): faces 0 .. n-1, then the exit node.
    """
    n = x.size - 1
    pressure = node_pressure(unknowns)
    log_eta, slope, rho, rho_slope = np.empty(n + 1), np.empty(n + 1), np.empty(n + 1), np.empty(n + 1)
    oil(problem, pressure, log_eta, slope, rho, rho_slope)
    mass = rho * film(x, kernel, unknowns)
    return _accumulate(mass * step), _carried(mass)


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


@njit(cache=True)
def stored_oil(
    problem: LineProblem, x: FloatArray, step: FloatArray, kernel: FloatArray, unknowns: FloatArray
) -> StoredOil:
    """Stored oil of each node by film and pressure."""
    n = x.size - 1
    log_eta, slope, rho, rho_slope = np.empty(n + 1), np.empty(n + 1), np.empty(n + 1), np.empty(n + 1)
    oil(problem, node_pressure(unknowns), log_eta, slope, rho, rho_slope)
    return StoredOil(rho * step, rho_slope * film(x, kernel, unknowns) * step)


@njit(cache=True)
def stored_mass_rate(
    stored: StoredOil, x: FloatArray, kernel: FloatArray, exit_at: float, rate: FloatArray
) -> FloatArray:
    """Derivative of `stored_mass`[0] for a rate of the unknowns, shape (n + 2,), on a grid that moves with the exit."""
    n = x.size - 1
    pressure_rate = node_pressure(rate)
    gap_rate = rate[n + 1] + (exit_at + x) * rate[n] - kernel @ pressure_rate
    return _accumulate(stored.by_film * gap_rate + stored.by_pressure * pressure_rate)


@njit(cache=True)
def stored_mass_jacobian(
    problem: LineProblem, x: FloatArray, step: FloatArray, kernel: FloatArray, unknowns: FloatArray
) -> FloatArray:
    """Derivative of `stored_mass`[0] by the unknowns, shape (n + 1, n + 2), on a grid that moves with the exit."""
    n = x.size - 1
    pressure = node_pressure(unknowns)
    log_eta, slope, rho, rho_slope = np.empty(n + 1), np.empty(n + 1), np.empty(n + 1), np.empty(n + 1)
    oil(problem, pressure, log_eta, slope, rho, rho_slope)
    gap = film(x, kernel, unknowns)
    weight = rho * step
    by_unknowns = np.empty((n + 1, n + 2))
    for j in range(1, n):
        column = -weight * kernel[:, j]
        column[j] += step[j] * rho_slope[j] * gap[j]
        put(_accumulate(column), by_unknowns[:, j - 1])
    by_unknowns[:, n - 1] = 0.0
    put(_accumulate(weight * (unknowns[n] + x)), by_unknowns[:, n])
    put(_accumulate(weight), by_unknowns[:, n + 1])
    return by_unknowns


@njit(cache=True)
def _accumulate(density: FloatArray) -> FloatArray:
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


@njit(cache=True)
def _carried(mass: FloatArray) -> FloatArray:
    """rho H at the faces, interpolated as in the wedge term, and at the exit node."""
    n = mass.size - 1
    carried = np.empty(n + 1)
    carried[0] = 0.5 * (mass[0] + mass[1])
    carried[1] = -0.125 * mass[0] + 0.75 * mass[1] + 0.375 * mass[2]
    for f in range(2, n):
        carried[f] = (mass[f - 2] - 5.0 * mass[f - 1] + 15.0 * mass[f] + 5.0 * mass[f + 1]) / 16.0
    carried[n] = mass[n]
    return carried
