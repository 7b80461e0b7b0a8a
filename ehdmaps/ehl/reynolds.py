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

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.copies import put
from ehdmaps.ehl.column import NO_HEAT, Heat, sheared_column
from ehdmaps.physics.isotherm import Isotherm, density, log_viscosity
from ehdmaps.physics.rheology import LIMITING, NEWTONIAN, ShearLaw

FITTED_STEP = 3.0
"""Change of ln eta over three cells at which the fourth-order correction of the Poiseuille flux is faded by half."""


MOST_LOG_VISCOSITY = 600.0
"""Largest ln eta whose exponential is taken: beyond, a stress of sliding is bounded by its law anyhow."""


YIELDING = 4.0
"""Power with which the flow grows with the step of pressure, above which soft tangents are taken."""

MOST_DROPS = 60
"""Steps towards the step of pressure that a flow asks for."""


class LineProblem(NamedTuple):
    """Dimensionless groups of one line contact.

    Attributes
    ----------
    wedge : float
        lambda = 3 pi^2/(8 M^2).
    isotherm : Isotherm
        Viscosity and density over P: pressures in p_H.
    shear : ShearLaw
        How the oil answers to shear, stresses in eta0 u R/b^2.
    slide : float
        Slide-to-roll ratio, of no effect on a Newtonian film of one temperature.
    heat : Heat
        Groups of heat, none in an isothermal film.
    """

    wedge: float
    isotherm: Isotherm
    shear: ShearLaw = ShearLaw()
    slide: float = 0.0
    heat: Heat = NO_HEAT


class Factors(NamedTuple):
    """Changes at the faces by an oil that is not Newtonian, or not of one temperature; see `column`.

    The flow by pressure through a face is `slope` times the step of pressure plus `offset`, both times the mean of
    rho/eta. `slope` is the derivative of mobility times step at the step `drop`, about which this is a tangent.

    Attributes
    ----------
    slope, offset, drop, carriage : ndarray, shape (n,)
        See above, and the factor on what the walls carry; of no length where the film is Newtonian.
    mobility_slopes, carriage_slopes : ndarray, shape (n, 3)
        Derivatives of mobility and carriage by the pressures at the nodes before and behind the face and by the film at
        the face; those of the mobility at the step `drop`. Of no length where the film is warm.
    mobility_rows, carriage_rows : ndarray, shape (n, n + 2)
        Their derivatives by all unknowns where the film is warm; else of no length.
    """

    slope: FloatArray
    offset: FloatArray
    drop: FloatArray
    carriage: FloatArray
    mobility_slopes: FloatArray
    carriage_slopes: FloatArray
    mobility_rows: FloatArray
    carriage_rows: FloatArray


_log_viscosity, _density = njit(log_viscosity), njit(density)


@njit
def oil(problem: LineProblem, pressure: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """ln eta and its derivative, rho and its, at each pressure; a negative trial pressure acts as zero on them."""
    n = pressure.size
    log_eta, log_eta_slope, rho, rho_slope = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    for i in range(n):
        p = max(pressure[i], 0.0)
        log_eta[i], log_eta_slope[i] = _log_viscosity(problem.isotherm, p)
        rho[i], rho_slope[i] = _density(problem.isotherm, p)
        if pressure[i] < 0.0:
            log_eta_slope[i] = 0.0
            rho_slope[i] = 0.0
    return log_eta, log_eta_slope, rho, rho_slope


@njit
def steepest_viscosity_step(problem: LineProblem, unknowns: FloatArray, move: FloatArray) -> float:
    """Largest change of ln eta by a move of the unknowns, to first order."""
    largest = 0.0
    for i in range(unknowns.size - 3):
        slope = _log_viscosity(problem.isotherm, max(unknowns[i], 0.0))[1]
        largest = max(largest, abs(move[i]) * slope)
    return largest


@njit
def node_pressure(unknowns: FloatArray) -> FloatArray:
    """Pressure at all nodes, shape (n + 1,), from the unknowns, shape (n + 2,)."""
    n = unknowns.size - 2
    pressure = np.zeros(n + 1)
    put(unknowns, pressure[1:n])
    return pressure


@njit
def film(x: FloatArray, kernel: FloatArray, unknowns: FloatArray) -> FloatArray:
    """Film H at all nodes, shape (n + 1,) [b^2/R]."""
    n = x.size - 1
    deflection = kernel @ node_pressure(unknowns)
    gap: FloatArray = unknowns[n + 1] + 0.5 * (unknowns[n] + x) ** 2 - deflection
    return gap


@njit
def _bend(d: float, e: float) -> tuple[float, float]:
    """Weight r of a bend of ln eta in the mean of 1/eta, and its derivative; d is the step of ln eta, e = exp(-d).

    r = Int t (1 - t) exp(-d t) dt/Int exp(-d t) dt over 0 < t < 1, which is even in d.
    """
    if abs(d) < 0.1:
        return 1.0 / 6.0 - d * d / 360.0 + d**4 / 15120.0, -d / 180.0 + d**3 / 3780.0
    cotangent = (1.0 + e) / (1.0 - e)  # coth d/2
    r = cotangent / d - 2.0 / (d * d)
    slope = 0.5 * (1.0 - cotangent * cotangent) / d - cotangent / (d * d) + 4.0 / d**3
    return r, slope


@njit
def cell_means(
    problem: LineProblem, kinematic: FloatArray, slope: FloatArray, pressure: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Mean of rho/eta over P in each cell, derivatives of its logarithm by both end pressures, step of ln(eta/rho).

    ln(eta/rho) is taken as a parabola in P through both ends and the middle of a cell; a straight line would leave an
    error of second order wherever the oil's law bends.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    kinematic, slope, pressure : ndarray, shape (n + 1,)
        ln(eta/rho), its derivative by P, and P at the nodes.
    """
    n = pressure.size - 1
    means, left, right, jump = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    for f in range(n):
        halfway = max(0.5 * (pressure[f] + pressure[f + 1]), 0.0)
        log_eta, eta_slope = _log_viscosity(problem.isotherm, halfway)
        rho, rho_slope = _density(problem.isotherm, halfway)
        middle, middle_slope = log_eta - math.log(rho), eta_slope - rho_slope / rho
        d = min(300.0, max(-300.0, kinematic[f + 1] - kinematic[f]))
        e = math.exp(-d)
        if abs(d) > 1e-2:
            phi = (1.0 - e) / d
            dphi = (e * (d + 1.0) - 1.0) / (d * d)
        else:
            phi = 1.0 - 0.5 * d + d * d / 6.0 - d**3 / 24.0
            dphi = -0.5 + d / 3.0 - d * d / 8.0
        bend = 4.0 * (kinematic[f] + kinematic[f + 1]) - 8.0 * middle
        weight, weight_slope = _bend(d, e)
        by_step = dphi / phi + 0.5 * bend * weight_slope
        means[f] = math.exp(0.5 * bend * weight - kinematic[f]) * phi
        left[f] = 2.0 * weight * (slope[f] - middle_slope) - slope[f] * (1.0 + by_step)
        right[f] = 2.0 * weight * (slope[f + 1] - middle_slope) + slope[f + 1] * by_step
        jump[f] = d
    return means, left, right, jump


@njit
def face_films(gap: FloatArray) -> FloatArray:
    """H at the faces, shape (n,), from the nodes: central inside, one-sided at the exit."""
    n = gap.size - 1
    faces = np.empty(n)
    for f in range(n):
        first, weights = face_weights(f, n)
        faces[f] = 0.0
        for k in range(4):
            if weights[k] != 0.0:
                faces[f] += weights[k] * gap[first + k]
    return faces


@njit
def face_weights(f: int, n: int) -> tuple[int, tuple[float, float, float, float]]:
    """First of the four nodes that give the film at a face, and their weights.

    Parameters
    ----------
    f, n : int
        Number of the face, and of all faces.
    """
    if f == 0:
        return -1, (0.0, 0.5, 0.5, 0.0)
    if f == n - 1:
        return f - 2, (1.0 / 16.0, -5.0 / 16.0, 15.0 / 16.0, 5.0 / 16.0)
    return f - 1, (-1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0)


@njit
def no_factors() -> Factors:
    """Factors of a Newtonian film of one temperature."""
    none, nothing = np.empty(0), np.empty((0, 0))
    return Factors(none, none, none, none, nothing, nothing, nothing, nothing)


@njit
def shear_factors(
    problem: LineProblem, x: FloatArray, face_step: FloatArray, kernel: FloatArray, unknowns: FloatArray, soft: bool
) -> tuple[Factors, FloatArray]:
    """Factors at the faces of an isothermal film, and the mean stresses there.

    Where the oil yields, flow rises with stress as by a hundredth power, and Newton would creep. There a soft tangent
    is taken at the step of pressure that the flow asks for, by which the oil hardly differs, instead of at the trial's.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    x, face_step, kernel, unknowns
        The arguments of `residual`.
    soft : bool
        Whether to take soft tangents: far from a solution. It is the same in a solution.
    """
    n = x.size - 1
    pressure, gap = node_pressure(unknowns), film(x, kernel, unknowns)
    faces = face_films(gap)
    log_eta, slope, rho, rho_slope = oil(problem, pressure)
    mass = rho * gap
    means = cell_means(problem, log_eta - np.log(rho), slope - rho_slope / rho, pressure)[0] if soft else rho
    tangent, offset, drops = np.empty(n), np.empty(n), np.empty(n)
    carriage, stress = np.empty(n), np.empty(n)
    mobility_slopes, carriage_slopes = np.empty((n, 3)), np.empty((n, 3))
    for f in range(n):
        film_here, middle = faces[f], 0.5 * (pressure[f] + pressure[f + 1])
        log_middle, eta_slope = _log_viscosity(problem.isotherm, max(middle, 0.0))
        if middle < 0.0:
            eta_slope = 0.0
        per_drop = 12.0 / problem.wedge * film_here / face_step[f]
        sliding = problem.slide * math.exp(min(log_middle, MOST_LOG_VISCOSITY)) / film_here
        drop = pressure[f + 1] - pressure[f]
        column = sheared_column(problem.shear, middle, per_drop * drop, sliding, problem.slide)
        growth = 1.0 + drop * column.mobility_by_rise * per_drop / column.mobility
        if soft and problem.shear.form == LIMITING and growth > YIELDING:
            carried = 0.0
            weights = upwind(f)
            for k in range(4):
                if weights[k] != 0.0:
                    carried += weights[k] * mass[f - 2 + k]
            conductance = film_here**3 / (problem.wedge * face_step[f])
            flow = (column.carriage * carried - unknowns[n - 1]) / (conductance * means[f])
            drop = _drop_asked(problem, middle, per_drop, sliding, flow, drop)
            column = sheared_column(problem.shear, middle, per_drop * drop, sliding, problem.slide)
        drops[f], carriage[f], stress[f] = drop, column.carriage, column.mean_stress
        tangent[f] = column.mobility + drop * column.mobility_by_rise * per_drop
        offset[f] = -drop * drop * column.mobility_by_rise * per_drop
        by_pressure = 0.5 * (column.mobility_by_pressure + column.mobility_by_slide * sliding * eta_slope)
        mobility_slopes[f, 0] = mobility_slopes[f, 1] = by_pressure
        mobility_slopes[f, 2] = (
            column.mobility_by_rise * per_drop * drop - column.mobility_by_slide * sliding
        ) / film_here
        by_pressure = 0.5 * (column.carriage_by_pressure + column.carriage_by_slide * sliding * eta_slope)
        carriage_slopes[f, 0] = by_pressure - column.carriage_by_rise * per_drop
        carriage_slopes[f, 1] = by_pressure + column.carriage_by_rise * per_drop
        carriage_slopes[f, 2] = (
            column.carriage_by_rise * per_drop * drop - column.carriage_by_slide * sliding
        ) / film_here
    none = np.empty((0, 0))
    return Factors(tangent, offset, drops, carriage, mobility_slopes, carriage_slopes, none, none), stress


@njit
def _drop_asked(
    problem: LineProblem, pressure: float, per_drop: float, sliding: float, flow: float, start: float
) -> float:
    """Step of pressure whose product with its mobility is `flow`: Newton on logarithms, kept in its bracket."""
    wanted = abs(flow)
    if wanted == 0.0:
        return 0.0
    low, high = 0.0, wanted
    trial = min(abs(start), wanted)
    if trial == 0.0:
        trial = wanted
    for _ in range(MOST_DROPS):
        column = sheared_column(problem.shear, pressure, per_drop * trial, sliding, problem.slide)
        total = column.mobility * trial
        steep = column.mobility + trial * column.mobility_by_rise * per_drop
        if total > wanted:
            high = trial
        else:
            low = trial
        move, quadratic = 0.5 * (low + high) - trial, False
        if math.isfinite(total) and math.isfinite(steep) and steep > 0.0:
            newton = total / steep * math.log(wanted / total)
            if low <= trial + newton <= high:
                move, quadratic = newton, True
        trial += move
        if abs(move) <= (1e-5 if quadratic else 1e-9) * trial:
            break
    return math.copysign(trial, flow)


@njit
def upwind(f: int) -> tuple[float, float, float, float]:
    """Weights of the nodes f-2 .. f+1 in what the walls carry through a face."""
    if f == 0:
        return 0.0, 0.0, 0.5, 0.5
    if f == 1:
        return 0.0, -0.125, 0.75, 0.375
    return 1.0 / 16.0, -5.0 / 16.0, 15.0 / 16.0, 5.0 / 16.0


@njit
def _subtract_deflections(kernel: FloatArray, f: int, by_film: FloatArray, row: FloatArray) -> None:
    """Take the deflections of the nodes f-3 .. f+3 from a row of the Jacobian, in one pass."""
    last = kernel.shape[0] - 1  # nodes beyond the ends have no factor
    c0, c1, c2, c3, c4, c5, c6 = by_film[0], by_film[1], by_film[2], by_film[3], by_film[4], by_film[5], by_film[6]
    k0, k1, k2 = kernel[max(f - 3, 0), 1:], kernel[max(f - 2, 0), 1:], kernel[max(f - 1, 0), 1:]
    k3, k4, k5, k6 = kernel[f, 1:], kernel[f + 1, 1:], kernel[min(f + 2, last), 1:], kernel[min(f + 3, last), 1:]
    for j in range(last - 1):
        row[j] -= c0 * k0[j] + c1 * k1[j] + c2 * k2[j] + c3 * k3[j] + c4 * k4[j] + c5 * k5[j] + c6 * k6[j]


@njit
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
    """Residual of an isothermal film into `out`, shape (n + 2,), and the smallest H as value.

    The exact Jacobian goes into `jacobian`, shape (n + 2, n + 2); one of shape (1, n + 2) is scratch, and none is made.
    """
    factors = no_factors()
    if problem.shear.form != NEWTONIAN:
        factors = shear_factors(problem, x, face_step, kernel, unknowns, False)[0]
    return residual_with(problem, factors, x, step, face_step, kernel, unknowns, load, out, jacobian)


@njit
def residual_with(
    problem: LineProblem,
    factors: Factors,
    x: FloatArray,
    step: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    load: float,
    out: FloatArray,
    jacobian: FloatArray,
) -> float:
    """The same as `residual` with given factors at the faces.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    factors : Factors
        Factors at the faces.
    x, step, face_step, kernel, unknowns, load, out, jacobian
        The other arguments of `residual`.
    """
    n = x.size - 1
    pressure = node_pressure(unknowns)
    outflow, exit_at = unknowns[n - 1], unknowns[n]
    log_eta, slope, rho, rho_slope = oil(problem, pressure)
    gap = film(x, kernel, unknowns)
    faces = face_films(gap)
    mass = rho * gap
    kinematic, kinematic_slope = log_eta - np.log(rho), slope - rho_slope / rho
    means, left, right, jump = cell_means(problem, kinematic, kinematic_slope, pressure)
    sheared, by_rows = factors.slope.size > 0, factors.mobility_rows.shape[0] > 0
    flow, plain = np.empty(n), np.empty(n)
    for f in range(n):
        rise, tangent = pressure[f + 1] - pressure[f], 1.0
        if sheared:
            tangent = factors.slope[f]
            rise = tangent * rise + factors.offset[f]
            plain[f] = means[f] * factors.drop[f]
        flow[f] = means[f] * rise
        left[f] = means[f] * (left[f] * rise - tangent)
        right[f] = means[f] * (right[f] * rise + tangent)
    limit4 = FITTED_STEP**4
    by_film = np.empty(7)  # dF_f/dH at nodes f-3 .. f+3
    by_flow = np.empty(4)  # dF_f/d(flow) of the cells middle-1 .. middle+1 and f
    wanted = jacobian.shape[0] > 1
    for f in range(n):
        by_film[:] = 0.0
        by_flow[:] = 0.0
        row = jacobian[f if wanted else 0]
        row[:] = 0.0
        gap_face = faces[f]
        conductance = gap_face**3 / (problem.wedge * face_step[f])
        # Poiseuille flux, with the fourth-order correction where it is safe
        gradient = flow[f]
        middle = f if f < n - 1 else f - 1
        if f > 0:
            curvature = flow[middle + 1] - 2.0 * flow[middle] + flow[middle - 1]
            jumps = jump[middle - 1] ** 2 + jump[middle] ** 2 + jump[middle + 1] ** 2
            fade = 1.0 / (1.0 + jumps * jumps / limit4)
            gradient -= fade * curvature / 24.0
            corrected = -conductance * fade / 24.0
            by_jump = conductance * curvature / 24.0 * fade * fade * 4.0 * jumps / limit4
            for k in range(3):
                i = middle - 1 + k
                by_flow[k] = corrected * (-2.0 if k == 1 else 1.0)
                d = by_jump * jump[i]
                if i > 0:
                    row[i - 1] += by_flow[k] * left[i] - d * kinematic_slope[i]
                if i + 1 < n:
                    row[i] += by_flow[k] * right[i] + d * kinematic_slope[i + 1]
        by_flow[3] = conductance
        flux = conductance * gradient
        if f > 0:
            row[f - 1] += conductance * left[f]
        if f + 1 < n:
            row[f] += conductance * right[f]
        first, weights = face_weights(f, n)
        for k in range(4):
            by_film[first + k - f + 3] = 3.0 * flux / gap_face * weights[k]
        # wedge
        ahead = upwind(f)
        carriage = factors.carriage[f] if sheared else 1.0
        carried = 0.0
        for k in range(4):
            i = f - 2 + k
            if ahead[k] != 0.0:
                carried += ahead[k] * mass[i]
                by_film[k + 1] -= carriage * ahead[k] * rho[i]
                if 0 < i < n:
                    row[i - 1] -= carriage * ahead[k] * rho_slope[i] * gap[i]
        out[f] = flux - carriage * carried + outflow
        if sheared and wanted:
            if by_rows:
                for k in range(4):
                    i = middle - 1 + k if k < 3 else f
                    if by_flow[k] != 0.0:
                        c, other = by_flow[k] * plain[i], factors.mobility_rows[i]
                        for j in range(n + 2):
                            row[j] += c * other[j]
                other = factors.carriage_rows[f]
                for j in range(n + 2):
                    row[j] -= carried * other[j]
            else:
                for k in range(5):
                    i = f
                    if k < 3:
                        i = middle - 1 + k
                    c, slopes = 0.0, factors.mobility_slopes[0]
                    if k == 4:
                        c, slopes = -carried, factors.carriage_slopes[f]
                    elif by_flow[k] != 0.0:
                        c, slopes = by_flow[k] * plain[i], factors.mobility_slopes[i]
                    if c == 0.0:
                        continue
                    if i > 0:
                        row[i - 1] += c * slopes[0]
                    if i + 1 < n:
                        row[i] += c * slopes[1]
                    first, weights = face_weights(i, n)
                    for q in range(4):
                        if weights[q] != 0.0:
                            by_film[first + q - f + 3] += c * slopes[2] * weights[q]
        row[n - 1] += 1.0
        if wanted:
            for k in range(7):
                if by_film[k] != 0.0:
                    row[n] += by_film[k] * (exit_at + x[f - 3 + k])
                    row[n + 1] += by_film[k]
            _subtract_deflections(kernel, f, by_film, row)
    # the exit of a warm film takes the factor on the walls' flow from the last two faces; there is no other's
    carriage = 1.0
    if sheared and factors.mobility_slopes.shape[0] == 0:
        carriage = 1.5 * factors.carriage[n - 1] - 0.5 * factors.carriage[n - 2]
    carried_load = 0.0
    for j in range(1, n):
        carried_load += step[j] * pressure[j]
    if wanted:
        last, total = jacobian[n], jacobian[n + 1]
        c = carriage * rho[n]
        for j in range(1, n):
            last[j - 1] = -c * kernel[n, j]
            total[j - 1] = step[j]
        last[n - 1], last[n], last[n + 1] = -1.0, c * (exit_at + x[n]), c
        total[n - 1], total[n], total[n + 1] = 0.0, 0.0, 0.0
        if by_rows:
            for j in range(n + 2):
                last[j] += mass[n] * (1.5 * factors.carriage_rows[n - 1, j] - 0.5 * factors.carriage_rows[n - 2, j])
    out[n] = carriage * mass[n] - outflow
    out[n + 1] = carried_load - load
    lowest: float = np.min(gap)
    return lowest
