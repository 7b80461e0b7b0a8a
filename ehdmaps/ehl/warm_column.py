"""Columns of a film with temperatures: velocity, flow and heat of shear across the film, with exact derivatives.

Temperatures stand at Lobatto points across the film, and all integrals are those of the polynomial through them. With
F = rate/tau of the law of shear at the viscosity of the place, A_0 and A_1 the integrals of F and F zeta from the lower
wall, and rho in units of its value at the surfaces' temperature,

    mobility = -12 eta(T_0) Int rho (A_1 - A_1(1)/A_0(1) A_0) dzeta,   carriage = Int rho (U_1 + dU A_0/A_0(1)) dzeta

take the place of those of `column`. For the energy a column says how much oil goes through each height, Y = rho U H,
and what its shear heats, rate tau. Y is corrected by a parabola so that it sums up to the flow through the contact:
what the discrete Reynolds equation and the column differ by is an error of both, and heat has to go with one flow.

Where an oil yields, flow and heat rise with the gradient as by a hundredth power. Far from a solution such a column
takes the gradient for which it lets a given flow pass, from which the solution differs little: `gradient_asked`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.column import warm_viscosity
from ehdmaps.ehl.grid import Across
from ehdmaps.ehl.reynolds import YIELDING, LineProblem, cell_means, face_films, film, node_pressure, oil, upwind
from ehdmaps.physics.isotherm import density
from ehdmaps.physics.rheology import LIMITING, NEWTONIAN, ShearLaw, thinning, yielding

MOST_STEPS = 200
"""Steps towards the stress of a column."""

_thinning, _yielding = njit(thinning), njit(yielding)
_density = njit(density)


class Columns(NamedTuple):
    """All columns of a film, with derivatives by pressure, film, gradient and flow, in this order, and by temperatures.

    Attributes
    ----------
    place : ndarray, shape (n, 3)
        P, H and dP/dX at the faces.
    stress : ndarray, shape (n,)
        Stress at the lower wall.
    mobility, carriage : ndarray, shape (n, 4)
        Value, and derivatives by pressure, film and gradient.
    mobility_warm, carriage_warm : ndarray, shape (n, k)
        Derivatives by the temperatures.
    flow, flow_slopes, flow_warm : ndarray, shapes (n, k), (n, 4, k) and (n, k, k)
        Y = rho U H at the heights.
    heat, heat_slopes, heat_warm : ndarray, shapes (n, k), (n, 3, k) and (n, k, k)
        rate tau.
    density, density_slope, density_warm : ndarray, shapes (n, k), (n, k) and (n,)
        rho/rho_0, its derivatives by pressure and by temperature.
    gradient_warm : ndarray, shape (n, k)
        Derivatives of dP/dX by the temperatures, 0 where it is given.
    """

    place: FloatArray
    stress: FloatArray
    mobility: FloatArray
    carriage: FloatArray
    mobility_warm: FloatArray
    carriage_warm: FloatArray
    flow: FloatArray
    flow_slopes: FloatArray
    flow_warm: FloatArray
    heat: FloatArray
    heat_slopes: FloatArray
    heat_warm: FloatArray
    density: FloatArray
    density_slope: FloatArray
    density_warm: FloatArray
    gradient_warm: FloatArray


@njit
def empty_columns(n: int, k: int) -> Columns:
    """Return columns to be filled.

    Parameters
    ----------
    n, k : int
        Number of columns and of points across.
    """
    return Columns(
        np.empty((n, 3)),
        np.zeros(n),
        np.empty((n, 4)),
        np.empty((n, 4)),
        np.empty((n, k)),
        np.empty((n, k)),
        np.empty((n, k)),
        np.empty((n, 4, k)),
        np.empty((n, k, k)),
        np.empty((n, k)),
        np.empty((n, 3, k)),
        np.empty((n, k, k)),
        np.empty((n, k)),
        np.empty((n, k)),
        np.empty(n),
        np.zeros((n, k)),
    )


@njit
def gradient_asked(
    problem: LineProblem, pressure: float, film: float, rises: FloatArray, flow: float, start: float
) -> float:
    """dP/dX of a column whose product with its mobility is `flow`: Newton on logarithms, kept in its bracket.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    pressure, film : float
        P and H.
    rises : ndarray, shape (k,)
        Temperatures [K above T_0].
    flow : float
        Mobility times dP/dX.
    start : float
        dP/dX to start from.
    """
    if flow == 0.0:
        return 0.0
    law, across, p = problem.shear, problem.heat.across, max(pressure, 0.0)
    k, heights, weights = across.heights.size, across.heights, across.weights
    log_eta, by_rise, by_pressure = np.empty(k), np.empty(k), np.empty(k)
    warm_viscosity(problem.isotherm, problem.heat, p, np.zeros(1), log_eta[:1], by_rise[:1], by_pressure[:1])
    scale = 12.0 * math.exp(min(log_eta[0], 600.0))
    warm_viscosity(problem.isotherm, problem.heat, p, rises, log_eta, by_rise, by_pressure)
    fluid = np.exp(-np.minimum(log_eta, 600.0))
    below = (weights * (1.0 + problem.heat.density_slope * rises)) @ across.integral
    per_gradient, shear = 12.0 / problem.wedge * film, problem.slide / film
    secant, bend = fluid.copy(), np.empty(k)
    sign, wanted = math.copysign(1.0, flow), abs(flow)
    low = high = trial = tau_0 = 0.0
    for count in range(MOST_STEPS):
        by_stress, by_raised = 0.0, 0.0
        if count > 0:
            rise = sign * per_gradient * trial
            tau_0 = lower_stress(law, across, p, rise, shear, fluid, tau_0)
            for j in range(k):
                tau = tau_0 + heights[j] * rise
                factor, steep = _thinning(law, tau, p)
                secant[j] = fluid[j] * factor
                bend[j] = fluid[j] * (steep - factor) / tau if tau != 0.0 else 0.0
                by_stress += weights[j] * fluid[j] * steep
                by_raised += weights[j] * fluid[j] * steep * heights[j]
        lever = (weights @ (secant * heights)) / (weights @ secant)
        held, end = float(below @ secant), float(weights @ secant)
        mobility = -scale * float(below @ (secant * (heights - lever)))
        if count == 0:
            # an oil that yields lets more pass than one that does not
            high = wanted / mobility
            trial = min(sign * start, high) if sign * start > 0.0 else high
            continue
        slope = 0.0
        for j in range(k):
            by_secant = -scale * (heights[j] - lever) * (below[j] - weights[j] * held / end)
            slope += by_secant * bend[j] * (heights[j] - by_raised / by_stress) * sign * per_gradient
        total, steepness = mobility * trial, mobility + trial * slope
        if total > wanted:
            high = trial
        else:
            low = trial
        move, quadratic = 0.5 * (low + high) - trial, False
        if math.isfinite(total) and total > 0.0 and math.isfinite(steepness) and steepness > 0.0:
            newton = total / steepness * math.log(wanted / total)
            if low <= trial + newton <= high:
                move, quadratic = newton, True
        trial += move
        if abs(move) <= (1e-7 if quadratic else 1e-12) * trial:
            break
    return sign * trial


@njit
def lower_stress(
    law: ShearLaw, across: Across, pressure: float, rise: float, rate: float, fluid: FloatArray, guess: float
) -> float:
    """Stress at the lower wall for which the column shears by `rate`: Newton in a bracket.

    Parameters
    ----------
    law : ShearLaw
        The law.
    across : Across
        Points across the film.
    pressure : float
        Pressure P of the column.
    rise : float
        Stress at the upper wall less that at the lower one.
    rate : float
        dU/H.
    fluid : ndarray, shape (k,)
        1/eta at the heights.
    guess : float
        Stress to start from.
    """
    heights, weights = across.heights, across.weights
    a0 = a1 = 0.0
    thickest = 0.0
    for k in range(heights.size):
        a0 += weights[k] * fluid[k]
        a1 += weights[k] * fluid[k] * heights[k]
        thickest = max(thickest, 1.0 / fluid[k])
    if law.form == NEWTONIAN:
        return (rate - rise * a1) / a0
    sign = -1.0 if rate < 0.0 else 1.0
    rise, rate, guess = sign * rise, sign * rate, sign * guess
    bound = rate * thickest
    bound *= _yielding(law, bound, pressure)[0]
    low, high = min(-rise, 0.0), max(0.0, -rise) + bound
    trial = min(max(guess, low), high)
    unit, before = law.stress * a0, math.inf
    for _ in range(MOST_STEPS):
        total = slope = 0.0
        for k in range(heights.size):
            tau = trial + heights[k] * rise
            factor, steep = _thinning(law, tau, pressure)
            total += weights[k] * fluid[k] * factor * tau
            slope += weights[k] * fluid[k] * steep
        if total > rate:
            high = trial
        else:
            low = trial
        move, quadratic = 0.5 * (low + high) - trial, False
        if math.isfinite(total) and math.isfinite(slope) and slope > 0.0:
            miss = math.asinh(rate / unit) - math.asinh(total / unit)
            newton = miss * math.hypot(unit, total) / slope
            # walls that yield both ways throw Newton from one end of the bracket to the other and back
            if low <= trial + newton <= high and abs(newton) <= 0.5 * before:
                move, quadratic = newton, True
        before = abs(move)
        trial += move
        if abs(move) <= (1e-9 if quadratic else 1e-14) * (abs(trial) + abs(rise)):
            break
    return sign * trial


@njit
def fill_column(
    problem: LineProblem,
    i: int,
    pressure: float,
    film: float,
    gradient: float,
    outflow: float,
    rises: FloatArray,
    columns: Columns,
) -> None:
    """Fill column i; `columns.stress[i]` is taken as a start.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    i : int
        Number of the column.
    pressure, film, gradient, outflow : float
        P, H, dP/dX, and the flow through the contact.
    rises : ndarray, shape (k,)
        Temperatures [K above T_0].
    columns : Columns
        What is filled.
    """
    law, across = problem.shear, problem.heat.across
    k, heights, weights, integral = across.heights.size, across.heights, across.weights, across.integral
    p = max(pressure, 0.0)
    log_eta, warm, stiff = np.empty(k), np.empty(k), np.empty(k)
    warm_viscosity(problem.isotherm, problem.heat, p, rises, log_eta, warm, stiff)
    cold, cold_warm, cold_stiff = np.empty(1), np.empty(1), np.empty(1)
    warm_viscosity(problem.isotherm, problem.heat, p, np.zeros(1), cold, cold_warm, cold_stiff)
    ratio, ratio_slope = _density(problem.isotherm, p)
    if pressure < 0.0:
        stiff[:] = 0.0
        cold_stiff[:] = 0.0
        ratio_slope = 0.0
    per_rise = 12.0 / problem.wedge
    rise, slide = per_rise * film * gradient, problem.slide
    # fluidities are kept above the range of numbers: oil that thick is a solid anyhow
    fluid = np.exp(-np.minimum(log_eta, 600.0))
    low = lower_stress(law, across, p, rise, slide / film, fluid, columns.stress[i])
    columns.place[i, 0], columns.place[i, 1], columns.place[i, 2], columns.stress[i] = pressure, film, gradient, low
    rate, steepness, bend, yields, rho = np.empty(k), np.empty(k), np.empty(k), np.empty(k), np.empty(k)
    secant = np.empty(k)
    total = 0.0
    for j in range(k):
        tau = low + heights[j] * rise
        factor, steep = _thinning(law, tau, p)
        secant[j] = fluid[j] * factor
        rate[j] = secant[j] * tau
        steepness[j] = fluid[j] * steep
        bend[j] = fluid[j] * (steep - factor) / tau if tau != 0.0 else 0.0
        yields[j] = 0.0
        if law.form == LIMITING and pressure > 0.0:
            yields[j] = -fluid[j] * (steep - factor) * law.ratio / (law.stress + law.ratio * p)
        rho[j] = 1.0 + problem.heat.density_slope * rises[j]
        total += weights[j] * steepness[j]
    # how the stress follows: by pressure, film, gradient, and each temperature
    stress_by, rise_by = np.zeros(3), np.array([0.0, per_rise * gradient, per_rise * film])
    stress_warm = np.empty(k)
    for j in range(k):
        stress_by[0] += weights[j] * (rate[j] * stiff[j] - yields[j] * (low + heights[j] * rise))
        stress_by[1] -= weights[j] * steepness[j] * heights[j] * rise_by[1]
        stress_by[2] -= weights[j] * steepness[j] * heights[j] * rise_by[2]
        stress_warm[j] = weights[j] * rate[j] * warm[j] / total
    stress_by[1] -= slide / (film * film)
    stress_by /= total
    # mobility and carriage, and their slopes by F and rho
    a0, a1 = integral @ secant, integral @ (secant * heights)
    end = a0[k - 1]
    lever = a1[k - 1] / end
    below = (weights * rho) @ integral
    held = 0.0
    for j in range(k):
        held += weights[j] * rho[j] * a0[j]
    scale = 12.0 * math.exp(min(cold[0], 600.0))
    first = 1.0 - 0.5 * slide
    mobility = carriage = 0.0
    m_by, c_by, m_rho, c_rho = np.empty(k), np.empty(k), np.empty(k), np.empty(k)
    for j in range(k):
        m_rho[j] = -scale * weights[j] * (a1[j] - lever * a0[j])
        m_by[j] = -scale * (heights[j] - lever) * (below[j] - weights[j] * held / end)
        c_rho[j] = weights[j] * (first + slide * a0[j] / end)
        c_by[j] = slide * (below[j] / end - weights[j] * held / (end * end))
        mobility += m_rho[j] * rho[j]
        carriage += c_rho[j] * rho[j]
    columns.mobility[i, 0], columns.carriage[i, 0] = mobility, carriage
    m_stress = c_stress = 0.0
    for j in range(k):
        m_stress += m_by[j] * bend[j]
        c_stress += c_by[j] * bend[j]
    for v in range(3):
        m = c = 0.0
        for j in range(k):
            change = bend[j] * (stress_by[v] + heights[j] * rise_by[v])
            if v == 0:
                change += yields[j] - secant[j] * stiff[j]
            m += m_by[j] * change
            c += c_by[j] * change
        columns.mobility[i, 1 + v], columns.carriage[i, 1 + v] = m, c
    columns.mobility[i, 1] += mobility * cold_stiff[0]
    density_slope = problem.heat.density_slope
    for j in range(k):
        cooled = -secant[j] * warm[j]
        columns.mobility_warm[i, j] = m_rho[j] * density_slope + m_by[j] * cooled + m_stress * stress_warm[j]
        columns.carriage_warm[i, j] = c_rho[j] * density_slope + c_by[j] * cooled + c_stress * stress_warm[j]
    # heat of shear
    for j in range(k):
        tau = low + heights[j] * rise
        columns.heat[i, j] = rate[j] * tau
        by_stress = rate[j] + tau * steepness[j]
        for v in range(3):
            columns.heat_slopes[i, v, j] = by_stress * (stress_by[v] + heights[j] * rise_by[v])
        columns.heat_slopes[i, 0, j] += tau * (yields[j] * tau - rate[j] * stiff[j])
        for q in range(k):
            columns.heat_warm[i, j, q] = by_stress * stress_warm[q]
        columns.heat_warm[i, j, j] -= tau * rate[j] * warm[j]
    # flow at the heights
    sheared, softened = integral @ rate, integral @ steepness
    raised = integral @ (steepness * heights)
    stiffened = integral @ (rate * stiff)
    yielded = np.zeros(k)
    if law.form == LIMITING:
        stresses = np.empty(k)
        for j in range(k):
            stresses[j] = yields[j] * (low + heights[j] * rise)
        yielded = integral @ stresses
    missing = outflow
    for j in range(k):
        speed = first + film * sheared[j]
        columns.density[i, j] = ratio * rho[j]
        columns.density_slope[i, j] = ratio_slope * rho[j]
        columns.flow[i, j] = ratio * rho[j] * speed * film
        missing -= weights[j] * columns.flow[i, j]
        for v in range(3):
            by = film * (softened[j] * stress_by[v] + raised[j] * rise_by[v])
            if v == 0:
                by += film * (yielded[j] - stiffened[j])
            elif v == 1:
                by += sheared[j]
            columns.flow_slopes[i, v, j] = ratio * rho[j] * film * by
        columns.flow_slopes[i, 0, j] += ratio_slope * rho[j] * speed * film
        columns.flow_slopes[i, 1, j] += ratio * rho[j] * speed
        columns.flow_slopes[i, 3, j] = 0.0
        for q in range(k):
            by = film * (softened[j] * stress_warm[q] - integral[j, q] * rate[q] * warm[q])
            columns.flow_warm[i, j, q] = ratio * rho[j] * film * by
        columns.flow_warm[i, j, j] += ratio * density_slope * speed * film
    columns.density_warm[i] = ratio * density_slope
    for j in range(k):
        columns.flow[i, j] += across.parabola[j] * missing
    for v in range(4):
        missing_slope = 1.0 if v == 3 else 0.0
        for j in range(k):
            missing_slope -= weights[j] * columns.flow_slopes[i, v, j]
        for j in range(k):
            columns.flow_slopes[i, v, j] += across.parabola[j] * missing_slope
    for q in range(k):
        missing_slope = 0.0
        for j in range(k):
            missing_slope -= weights[j] * columns.flow_warm[i, j, q]
        for j in range(k):
            columns.flow_warm[i, j, q] += across.parabola[j] * missing_slope


HEATED_FROM = 300.0
"""Film over that of the flow through the contact at which heating begins: from 100 or 1000 the central film of a light
contact in cold oil, 25 N/mm at 10 m/s and 20 degC, differs by 0.15 or 0.01 %, its loss by 1.2 or 0.3 %, others by
less."""


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
    flows: FloatArray,
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
    flows : ndarray, shape (n,)
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
        follows = flows.size > 0 and not math.isnan(flows[f])
        if follows:
            gradient = gradient_asked(problem, middle, faces[f], rises[f], flows[f], gradient)
        fill_column(problem, f, middle, faces[f], gradient, unknowns[n - 1], rises[f], columns)
        if follows:
            steepness = columns.mobility[f, 0] + gradient * columns.mobility[f, 3]
            columns.gradient_warm[f] = -gradient / steepness * columns.mobility_warm[f]
            for j in range(rises.shape[1]):
                for q in range(rises.shape[1]):
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
    flows = np.full(n, np.nan)
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
            flows[f] = flow * problem.wedge / (film_here**3 * means[f])
    return flows
