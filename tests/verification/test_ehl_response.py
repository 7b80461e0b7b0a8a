"""Stiffness and damping of the film against difference quotients and time integration."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.ehl.group_solution import GroupSolution
from ehdmaps.ehl.linearisation import Linearisation, linearised, stored_mass, stored_mass_rate, stored_oil
from ehdmaps.ehl.newton import CONVERGED, newton
from ehdmaps.ehl.profile import Profile
from ehdmaps.ehl.reynolds import residual
from ehdmaps.ehl.spectrum import film_compliances
from ehdmaps.ehl.ways import LOAD, at_load
from ehdmaps.physics.hertz import DRY_COMPLIANCE
from tests.cases.ehl import roelands_problem, solved


def _profile(result: GroupSolution) -> Profile:
    assert result.profile is not None
    return result.profile


def _standing(profile: Profile) -> Linearisation:
    """On a grid that does not follow a spike."""
    return linearised(profile.problem, profile.grid, profile.kernel, profile.unknowns, LOAD)


def _solve_at(profile: Profile, load: float) -> np.ndarray:
    grid = profile.grid
    result = newton(
        profile.problem, grid.x, grid.step, grid.face_step, profile.kernel, profile.unknowns, load, 1e-11, 30
    )
    assert result.outcome == CONVERGED
    return result.unknowns


@pytest.mark.parametrize(("M", "L"), [(0.2, 3.0), (1.0, 5.0), (5.0, 5.0), (30.0, 3.0)])
def test_compliance_is_the_derivative_of_the_film_offset(M: float, L: float) -> None:
    profile = _profile(solved(M, L))
    fixed = _standing(profile).slow_response()
    step = 1e-4 * LOAD
    up, down = _solve_at(profile, LOAD + step), _solve_at(profile, LOAD - step)
    quotient = -(up[-1] - down[-1]) / (2.0 * step)
    # 1e-7: third derivative times step^2, and round-off of H0 over the step
    assert fixed.compliance + DRY_COMPLIANCE == pytest.approx(quotient, rel=1e-7)


@pytest.mark.parametrize(("M", "L"), [(3.0, 18.0), (5.0, 12.0), (8.0, 20.0)])
def test_grid_that_follows_the_spike_gives_the_secant(M: float, L: float) -> None:
    """The tangent with a spike against a secant over +-5 % of load, from solves that place their own grids."""
    result = solved(M, L)
    assert _profile(result).spike is not None
    from ehdmaps.ehl.limits import Resolution
    from ehdmaps.ehl.line import solve_groups

    problem = roelands_problem(M, L)
    heights = []
    for factor in (1.05, 0.95):
        near = solve_groups(at_load(problem, factor), M * factor, L, Resolution(density=20.0))
        # film offset in units of the middle point's b^2/R
        heights.append(near.film_offset * factor)
    secant = -(heights[0] - heights[1]) / (0.1 * LOAD)
    # 1 %: offset error 2e-5 of two solves over 10 % of load, and the curvature over the secant
    assert result.film_compliance == pytest.approx(secant, rel=0.01)


@pytest.mark.parametrize(("M", "L"), [(1.0, 5.0), (5.0, 8.0)])
def test_following_and_standing_grids_agree_where_the_front_is_resolved(M: float, L: float) -> None:
    from ehdmaps.ehl.limits import Resolution
    from ehdmaps.ehl.line import solve_groups

    problem = roelands_problem(M, L)
    following = solve_groups(problem, M, L, Resolution(density=20.0, spike_steepness=1e-3))
    standing = solve_groups(problem, M, L, Resolution(density=20.0, spike_steepness=1e9))
    assert _profile(following).spike is not None
    assert _profile(standing).spike is None
    # grid error of both
    assert following.film_compliance == pytest.approx(standing.film_compliance, rel=1e-3)
    assert following.loss == pytest.approx(standing.loss, rel=1e-3)


def test_jacobian_is_exact() -> None:
    profile = _profile(solved(5.0, 10.0))
    grid, u = profile.grid, profile.unknowns
    size = u.size

    def evaluate(unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        out, jacobian = np.empty(size), np.empty((size, size))
        residual(profile.problem, grid.x, grid.step, grid.face_step, profile.kernel, unknowns, LOAD, out, jacobian)
        return out, jacobian

    _, jacobian = evaluate(u)
    rng = np.random.default_rng(1)
    for _ in range(5):
        direction = rng.normal(size=size) * np.maximum(np.abs(u), 1e-3)
        step = 1e-6
        quotient = (evaluate(u + step * direction)[0] - evaluate(u - step * direction)[0]) / (2.0 * step)
        # relative to the sum of what is added: truncation step^2 and round-off
        scale = np.abs(jacobian) @ np.abs(direction)
        assert np.max(np.abs(jacobian @ direction - quotient) / scale) < 1e-6


def test_mass_is_conserved() -> None:
    """The flux from pressure and film, computed here, is the same through every face."""
    profile = _profile(solved(5.0, 5.0))
    grid = profile.grid
    out = np.empty(profile.unknowns.size)
    residual(
        profile.problem, grid.x, grid.step, grid.face_step, profile.kernel, profile.unknowns, LOAD, out,
        np.empty((out.size, out.size)),
    )  # fmt: skip
    outflow = profile.unknowns[-3]
    assert np.max(np.abs(out[:-1])) < 1e-9 * outflow  # what Newton leaves after its last quadratic step
    # an independent second-order flux at the faces, where the film is thin and the cells are small
    problem, pressure, gap = profile.problem, profile.pressure, profile.film
    middle = 0.5 * (pressure[1:] + pressure[:-1])
    law = problem.isotherm
    eta = np.exp(law.alpha / (0.67 * law.curvature) * ((1.0 + law.curvature * middle) ** 0.67 - 1.0))
    rho = (1.0 + 1.34 * law.density_curvature * middle) / (1.0 + law.density_curvature * middle)
    height = 0.5 * (gap[1:] + gap[:-1])
    flux = rho * height - rho * height**3 / (problem.wedge * eta) * np.diff(pressure) / np.diff(grid.x)
    near = (0.5 * (profile.position[1:] + profile.position[:-1]) > -1.2) & (middle > 0.0)
    assert np.max(np.abs(flux[near] / outflow - 1.0)) < 0.02  # second-order truncation of this flux


def test_stored_mass_rate_is_the_derivative_of_the_stored_mass() -> None:
    profile = _profile(solved(2.0, 4.0))
    grid, u = profile.grid, profile.unknowns
    rng = np.random.default_rng(2)
    direction = rng.normal(size=u.size) * np.abs(u)
    step = 1e-6
    plus, _ = stored_mass(profile.problem, grid.x, grid.step, profile.kernel, u + step * direction)
    minus, _ = stored_mass(profile.problem, grid.x, grid.step, profile.kernel, u - step * direction)
    stored = stored_oil(profile.problem, grid.x, grid.step, profile.kernel, u)
    rate = stored_mass_rate(stored, grid.x, profile.kernel, u[-2], direction)
    assert rate == pytest.approx((plus - minus) / (2.0 * step), rel=1e-6, abs=1e-6 * np.max(np.abs(rate)))  # truncation


@pytest.mark.parametrize(("M", "L", "omega"), [(5.0, 3.0, 0.3), (1.0, 4.0, 0.5), (0.52, 45.0, 0.1)])
def test_impedance_against_a_small_oscillation_in_time(M: float, L: float, omega: float) -> None:
    """Nonlinear time stepping (backward differences of the stored mass) of a small oscillation of the load.

    The last point has negative damping. The load is prescribed, not H0: with its datum at one half-width the log kernel
    is not positive for wide pressures, so that bodies held at that datum have no stable motion.
    """
    profile = _profile(solved(M, L, density=5.0))
    grid, kernel, problem = profile.grid, profile.kernel, profile.problem
    steady = profile.unknowns
    size = steady.size
    n = size - 2
    out, jacobian = np.empty(size), np.empty((size, size))
    residual(problem, grid.x, grid.step, grid.face_step, kernel, steady, LOAD, out, jacobian)
    _, carried = stored_mass(problem, grid.x, grid.step, kernel, steady)
    stored = stored_oil(problem, grid.x, grid.step, kernel, steady)
    rates = np.zeros((size, size))
    for j in range(size):
        unit = np.zeros(size)
        unit[j] = 1.0
        rate = stored_mass_rate(stored, grid.x, kernel, steady[n], unit) - carried * unit[n]
        rates[:n, j], rates[n, j] = -rate[:n], rate[n]
    steps, periods = 240, 4
    dt = 2.0 * math.pi / omega / steps
    matrix = jacobian + 1.5 / dt * rates
    amplitude = 1e-4 * LOAD
    old = older = steady
    mass_old, _ = stored_mass(problem, grid.x, grid.step, kernel, steady)
    mass_older = mass_old
    heights = []
    for k in range(1, steps * periods + 1):
        u = old.copy()
        load = LOAD + amplitude * math.sin(omega * k * dt)
        for _ in range(12):
            residual(problem, grid.x, grid.step, grid.face_step, kernel, u, load, out, jacobian)
            mass, carried_now = stored_mass(problem, grid.x, grid.step, kernel, u)
            growth = (1.5 * mass - 2.0 * mass_old + 0.5 * mass_older) / dt
            growth -= carried_now * (1.5 * u[n] - 2.0 * old[n] + 0.5 * older[n]) / dt
            total = out.copy()
            total[:n] -= growth[:n]
            total[n] += growth[n]
            change = np.linalg.solve(matrix, -total)
            u += change
            if np.max(np.abs(change)) < 1e-12:
                break
        older, old = old, u
        mass_older, mass_old = mass_old, mass
        heights.append(u[n + 1] - steady[n + 1])
    time = dt * np.arange(1, steps * periods + 1)
    last = time > ((periods - 1) * steps + 0.5) * dt
    basis = np.column_stack([np.sin(omega * time[last]), np.cos(omega * time[last])])
    (real, imaginary), *_ = np.linalg.lstsq(basis, np.array(heights)[last], rcond=None)
    measured = complex(real, imaginary) / amplitude
    predicted = -(film_compliances(_standing(profile), np.array([omega]))[0] + DRY_COMPLIANCE)
    # backward differences: (omega dt)^2/3 = 2e-4 a step; what is left of the start after three periods
    assert abs(measured / predicted - 1.0) < 2e-3


def test_low_frequency_limit_of_the_impedance() -> None:
    profile = _profile(solved(5.0, 5.0))
    low = _standing(profile).slow_response()
    (slow,) = film_compliances(_standing(profile), np.array([1e-3]))
    # O(Omega^2)
    assert slow.real == pytest.approx(low.compliance, rel=1e-4)
    assert -slow.imag / 1e-3 == pytest.approx(low.loss, rel=1e-4)

    # damping falls with frequency: 0.95-0.97 of its limit at Omega = 0.3, 0.46-0.59 at 1 (another solver)
    def damping(omega: float) -> float:
        compliance = film_compliances(_standing(profile), np.array([omega]))[0] + DRY_COMPLIANCE
        return float((1.0 / compliance).imag / omega)

    assert 0.90 < damping(0.3) / damping(1e-3) < 1.0
    assert 0.35 < damping(1.0) / damping(1e-3) < 0.75
