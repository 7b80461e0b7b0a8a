"""Films with temperatures: parts against closed forms, whole films against a prototype with another coupling."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from ehdmaps.ehl.column import STEP, heat_groups, warm_viscosity
from ehdmaps.ehl.grid import ACROSS, moved_across, points_across
from ehdmaps.ehl.group_solution import GroupSolution, left_across
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.line import _by_points, _in_turn, _witness, solve_groups
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.ehl.warm_column import (
    empty_columns,
    fill_column,
    gradient_asked,
    lower_stress,
)
from ehdmaps.ehl.warm_newton import wall_weights
from ehdmaps.ehl.warm_response import WarmLinearisation
from ehdmaps.ehl.ways import coarse_solution, with_points
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.heat import HOTTEST_SURFACE, HeatData, extreme_note
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.rheology import LIMITING_RATIO, LIMITING_STRESS_AT_REST
from ehdmaps.physics.solution import FilmSolution, Status
from tests.cases.laws import CONTACTS, OIL

INNER = CONTACTS[0]
THERMAL = ReynoldsSolver(physics="thermal")
LIMITING = ReynoldsSolver(physics="thermal", shear="limiting")


def film(load: float, speed: float, celsius: float, solver: ReynoldsSolver = THERMAL) -> FilmSolution:
    """Film of the inner contact of NU308."""
    return solver.solve_line(INNER, OIL, (load,), speed, celsius + 273.15)[0]


def groups(load: float, speed: float, celsius: float) -> GroupSolution:
    """The same in groups."""
    problem, M, L = THERMAL._problem(INNER, OIL, OperatingPoint(load, speed, celsius + 273.15))
    return solve_groups(problem, M, L, Resolution())


def test_strip_of_heat_on_a_moving_solid() -> None:
    """Jaeger: 2 sqrt(X) below a strip of constant flux, 2 sqrt(X) - 2 sqrt(X - 1) behind it; exact but for its end."""
    x = np.concatenate([np.linspace(0.0, 1.0, 60) ** 1.5, [1.0 + 1e-9], np.linspace(1.02, 3.0, 40)])
    flux = (x <= 1.0).astype(float)
    behind = np.sqrt(np.maximum(x - 1.0, 0.0))
    assert wall_weights(x, 0) @ flux == pytest.approx(2.0 * np.sqrt(x) - 2.0 * behind, abs=1e-4)


@pytest.mark.parametrize("nahme", [0.1, 1.0, 10.0])
def test_nahme_couette(nahme: float) -> None:
    """An oil that thins by exp(-theta) between cold walls is warmest by ln(1 + Na/8): the matrices across the film.

    theta'' + Na tau^2 exp(theta) = 0 with a stress tau that the difference of the walls' speeds gives, by Picard steps.
    Nine points resolve the profile at Na = 10, where the middle is warmer by 0.8/beta, to 4e-6.
    """
    across = points_across(ACROSS)
    theta = np.zeros(ACROSS)
    for _ in range(200):
        stress = 1.0 / (across.weights @ np.exp(theta))
        made = nahme * stress**2 * across.weights * np.exp(theta)
        inside = np.linalg.solve(across.conduction[1:-1, 1:-1], made[1:-1])
        theta[1:-1] += 0.5 * (inside - theta[1:-1])
    middle = theta[ACROSS // 2]
    assert middle == pytest.approx(math.log1p(nahme / 8.0), rel=1e-5)


@pytest.mark.parametrize("points", [ACROSS, 13, 29])
def test_points_across_a_film(points: int) -> None:
    """What is said of the polynomial through the points holds of a polynomial, to rounding."""
    across = points_across(points)
    z, faces = across.heights, np.cumsum(across.weights)[:-1]
    assert across.integral @ z**4 == pytest.approx(z**5 / 5.0, abs=1e-12)
    assert z**2 @ across.conduction @ z**3 == pytest.approx(6.0 / 4.0, abs=1e-10)  # Int 2 zeta 3 zeta^2
    for carried in (across.rising, across.falling):
        assert carried @ (1.0 - 3.0 * z + z**2) == pytest.approx(1.0 - 3.0 * faces + faces**2, abs=1e-12)
    # of what does not go into the oil ahead by one point, nothing comes back
    ahead = np.arange(points)[None, :] > np.arange(1, points)[:, None]
    assert not np.any(across.rising[1:][ahead[1:]])
    assert moved_across((z**4)[None, :], 19)[0] == pytest.approx(points_across(19).heights ** 4, abs=1e-12)


def test_viscosity_between_its_temperatures() -> None:
    """The cubic over temperature against `Lubricant.at`, at two pressures: exact at T_0, 1e-4 in ln eta elsewhere."""
    kelvin, peak = 313.15, 1e9
    heat = heat_groups(OIL, HeatData(), kelvin, 1e-4, 5e-3, peak, np.array([1.0, 1.0]))
    state = OIL.at(kelvin)
    rises = np.array([0.0, 0.37 * STEP, 31.0, 98.7, -11.0])
    for pressure in (0.0, 0.8):
        found, by_rise, by_pressure = np.empty(5), np.empty(5), np.empty(5)
        warm_viscosity(state.isotherm(peak), heat, pressure, rises, found, by_rise, by_pressure)
        wanted = [math.log(OIL.at(kelvin + rise).viscosity_at(pressure * peak) / state.viscosity) for rise in rises]
        assert found == pytest.approx(np.array(wanted), abs=1e-4)
        assert found[0] == pytest.approx(wanted[0], abs=1e-12)


def test_column_of_one_temperature() -> None:
    """Mobility and carriage of a Newtonian column are 1 at T_0, and its flow is the one asked for."""
    problem, _, _ = THERMAL._problem(INNER, OIL, OperatingPoint(5e4, 2.0, 333.15))
    columns = empty_columns(1, ACROSS)
    fill_column(problem, 0, 0.01, 0.5, 0.02, 0.45, np.zeros(ACROSS), columns)
    assert columns.mobility[0, 0] == pytest.approx(1.0, abs=1e-12)
    assert points_across(ACROSS).weights @ columns.flow[0] == pytest.approx(0.45, abs=1e-12)


@pytest.mark.parametrize("slide", [0.0, 0.1])
def test_gradient_that_a_yielding_column_is_asked_for(slide: float) -> None:
    """The column at the gradient that is found lets the flow pass that was asked for; the gradient is found to 1e-7.

    The flow rises there with the gradient by a power of up to 500: 1e-4.
    """
    problem = replace(LIMITING, slide_to_roll=slide)._problem(INNER, OIL, OperatingPoint(2e5, 10.0, 373.15))[0]
    rises = 20.0 / 6.0 * points_across(ACROSS).parabola
    columns = empty_columns(1, ACROSS)
    for asked in (1e-3, -1e3, 1e6):
        gradient = gradient_asked(problem, 0.8, 0.15, rises, asked, 0.0)
        fill_column(problem, 0, 0.8, 0.15, gradient, 0.15, rises, columns)
        assert columns.mobility[0, 0] * gradient == pytest.approx(asked, rel=1e-4)


@pytest.mark.slow
def test_yielding_film() -> None:
    """An oil that yields in a hot film: heat thins it as it does a Newtonian one, and friction stays below the bound.

    In pure rolling the oil yields at the spike only, and the inlet makes the film: the prototype's factor of the
    Newtonian film, which differs from grid to grid by 0.3 %. With the walls sliding by
    a tenth all of the contact is near the bound tau0 + Lambda p, whose integral no friction reaches.
    """
    rolling = film(2e5, 10.0, 100.0, LIMITING)
    cold = film(2e5, 10.0, 100.0, replace(LIMITING, physics="isothermal"))
    assert rolling.status is Status.CONVERGED
    assert rolling.central_film / cold.central_film == pytest.approx(0.939, rel=3e-3)
    sliding = film(2e5, 10.0, 100.0, replace(LIMITING, slide_to_roll=0.1))
    bound = LIMITING_RATIO * 2e5 + LIMITING_STRESS_AT_REST * 2.2 * float(
        half_width(2e5, INNER.radius, INNER.reduced_modulus)
    )
    assert 0.8 * bound < sliding.traction < bound
    assert sliding.film_temperature > rolling.film_temperature + 10.0


@pytest.mark.slow
def test_errors_where_both_grids_agree_by_chance() -> None:
    """What is stated bounds the distance to twice the cells; the film offsets of both grids are closer than that.

    Temperatures are those of the hottest place, which a front makes.
    """
    solver = replace(LIMITING, slide_to_roll=0.22)
    found, fine = (film(49.9e3, 1.51, 52.0, replace(solver, density=density)) for density in (6.5, 13.0))
    assert abs(found.film_offset / fine.film_offset - 1.0) < abs(found.film_offset_error) < 1e-3
    for name in ("film_temperature", "surface_temperature"):
        stated = getattr(found, f"{name}_error")
        assert abs(getattr(found, name) - getattr(fine, name)) < stated < 0.2 * (getattr(fine, name) - 325.15)


def test_a_film_that_burns_says_so() -> None:
    """Full sliding under 1000 N/mm is solved, far above what steel and oil stand; in pure rolling nothing is said."""
    burning = film(1e6, 1.0, 60.0, replace(LIMITING, slide_to_roll=2.0))
    assert burning.status is Status.CONVERGED
    assert burning.surface_temperature > HOTTEST_SURFACE
    assert burning.reason.startswith("surfaces at 2")
    assert not film(1e6, 1.0, 60.0, LIMITING).reason
    assert extreme_note(320.0, 1.35e-9) == "film of 1.4 nm: some molecules, below 5 nm"
    assert not extreme_note(math.nan, 1.35e-9)


@pytest.mark.parametrize(
    ("load", "speed", "celsius", "film_factor", "loss_factor"),
    [(2e5, 10.0, 100.0, 0.939, 0.874), (5e4, 2.0, 60.0, 0.982, 0.965)],
)
def test_against_a_prototype(load: float, speed: float, celsius: float, film_factor: float, loss_factor: float) -> None:
    """Thermal over isothermal film and loss of a prototype of the same equations, another scheme, mixing and GMRES.

    It differs from grid to grid by 0.3 % in the film and 1 % in the loss.
    """
    warm, cold = film(load, speed, celsius), film(load, speed, celsius, ReynoldsSolver())
    assert warm.central_film / cold.central_film == pytest.approx(film_factor, rel=3e-3)
    assert warm.loss_compliance / cold.loss_compliance == pytest.approx(loss_factor, rel=1e-2)
    assert warm.film_temperature > warm.surface_temperature > celsius + 273.15


def test_energy_balance() -> None:
    """Heat into the walls and out with the oil is the heat of shear and compression: to rounding, on any grid."""
    for load, speed, celsius in ((5e3, 10.0, 60.0), (2e5, 10.0, 100.0)):
        for linear in (groups(load, speed, celsius).linear, groups(load, speed, celsius).rough_linear):
            assert isinstance(linear, WarmLinearisation)
            assert abs(linear.balance) < 1e-11


def test_heat_goes_with_the_oil_of_the_eddies() -> None:
    """A light, fast contact in cold oil, whose inlet carries a thousand times the heat that it conducts.

    Film and loss of `ehlFoam`, finite volumes in OpenFOAM, 400 x 24 cells: 6959.5 nm and 8.223e-14, with 200 x 24 cells
    by 0.05 and 1 % different. The points across the film leave 0.1 %. Isothermal they are 8160 nm and 7.8e-14.
    """
    warm = film(5e3, 5.0, 20.0)
    assert warm.central_film == pytest.approx(6959.5e-9, rel=2e-3)
    assert warm.loss_compliance == pytest.approx(8.223e-14, rel=0.01)
    assert 5e-4 < abs(warm.film_offset_error) < 2e-3


def test_points_across_leave_what_is_stated() -> None:
    """Film offsets of random points where heat counts, against 39 points across: their error alone, on the same grid.

    What is stated holds at 95 % of the points, and is no idle bound: its median is twice the error.
    """
    random, held, over = np.random.default_rng(8), [], []
    for number in range(40):
        speed, celsius = float(np.exp(random.uniform(0.0, math.log(10.0)))), float(random.uniform(20.0, 70.0))
        load = float(np.exp(random.uniform(math.log(300.0), math.log(3e5))))
        problem, M, L = THERMAL._problem(CONTACTS[number % 2], OIL, OperatingPoint(load, speed, celsius + 273.15))
        start = coarse_solution(problem, M, L, Resolution(), None)[0]
        assert start is not None
        known = _by_points(start, Resolution().tolerance)[0]
        chosen = _in_turn(known)[0]
        exact = with_points(known[-1], 39, Resolution().tolerance)[0]
        assert exact is not None
        stated, error = left_across(chosen, _witness(known, chosen)), abs(chosen.film_offset / exact.film_offset - 1.0)
        held.append(error <= stated)
        over.append(stated / error)
        assert stated < 1e-3 or chosen.points == 29
    assert np.mean(held) >= 0.95
    assert np.median(over) < 3.0


def test_a_cold_and_fast_contact_is_solved() -> None:
    """Heat takes half of the film at 10 m/s and 20 degC: let in bit by bit it leads there, from the isothermal film."""
    warm, cold = film(80e3, 10.0, 20.0), film(80e3, 10.0, 20.0, ReynoldsSolver())
    assert warm.status is Status.CONVERGED
    assert 0.4 < warm.central_film / cold.central_film < 0.6


@pytest.mark.parametrize("guess", [0.0, 1000.0, 3000.0])
def test_walls_that_yield_both_ways(guess: float) -> None:
    """The stress at the lower wall of a column in pure rolling is half of the rise, wherever the search begins."""
    problem = LIMITING._problem(INNER, OIL, OperatingPoint(2e5, 10.0, 373.15))[0]
    fluid = np.full(ACROSS, 1e-8)
    assert lower_stress(problem.shear, problem.heat.across, 0.8, -2168.25, 0.0, fluid, guess) == pytest.approx(
        1084.125, rel=1e-8
    )


def test_no_traction_in_pure_rolling() -> None:
    """Equal walls, equal stresses: what is left of them is rounding, of a rolling force of 30 N/m here."""
    rolling = film(5e4, 2.0, 60.0, ReynoldsSolver(physics="thermal", shear="eyring"))
    assert abs(rolling.traction) < 1e-6


def test_film_compliance_is_the_slope_of_the_film() -> None:
    """Against the difference quotient over 2 % of the load: both carry the error of the grid, 1 % here."""
    films = [film(5e4 * factor, 2.0, 60.0) for factor in (0.99, 1.0, 1.01)]
    quotient = (films[0].film_offset - films[2].film_offset) / 1e3
    assert films[1].film_compliance == pytest.approx(quotient, rel=0.01)


@pytest.mark.parametrize(
    ("load", "speed", "celsius"), [(5e4, 0.0, 60.0), (5e4, 1e-3, 150.0), (1e-3, 20.0, 80.0), (1e6, 20.0, 150.0)]
)
def test_any_point_has_an_answer(load: float, speed: float, celsius: float) -> None:
    """A status for whatever is asked, and a film that is finite where it is usable."""
    found = film(load, speed, celsius)
    assert found.status.usable == math.isfinite(found.film_offset)
    assert found.status is not Status.FAILED


def test_slow_end_of_the_spectrum() -> None:
    """At a low frequency S is film compliance - i omega loss, to the next order of omega b/u = 0.01."""
    point = OperatingPoint(5e4, 2.0, 333.15)
    omega = 0.01 * 2.0 / float(half_width(5e4, INNER.radius, INNER.reduced_modulus))
    found = THERMAL.film_spectrum(INNER, OIL, point, np.array([omega / (2.0 * math.pi)]))
    assert found.compliance[0].real == pytest.approx(found.film.film_compliance, rel=2e-3)
    assert -found.compliance[0].imag / omega == pytest.approx(found.film.loss_compliance, rel=2e-3)


def test_spectrum_of_a_film_that_heat_leaves_alone() -> None:
    """So slow that nothing warms: the isothermal spectrum, with the temperatures among the unknowns.

    The columns take the oil's flow by another quadrature: 1e-4 of the film.
    """
    point, frequencies = OperatingPoint(5e4, 0.02, 333.15), np.array([20.0, 100.0, 300.0])
    warm, cold = (
        solver.film_spectrum(INNER, OIL, point, frequencies).compliance for solver in (THERMAL, ReynoldsSolver())
    )
    assert np.abs(warm / cold - 1.0) == pytest.approx(0.0, abs=5e-3)


def test_maps_have_slow_motion_only() -> None:
    """Maps with heat have no natural frequencies, and say what they are made with."""
    assert THERMAL.natural_frequencies == ()
    assert THERMAL.settings()["physics"] == "thermal"
