"""The point contact: its parts against closed forms, its films against published ones, its response against motion."""

import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import dblquad

from ehdmaps.errors import InputError
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse, elliptic_numbers, ellipticity
from ehdmaps.physics.point.film_formulas import hamrock_dowson_minimum
from ehdmaps.physics.solution import Status
from ehdmaps.point import solve
from ehdmaps.point.grid import Cells, grid_on, point_grid
from ehdmaps.point.linearisation import Tangent
from ehdmaps.point.newton import newton, starts
from ehdmaps.point.reynolds import balance, changed, jacobian
from ehdmaps.point.two_grids import MOST_ERROR, Resolution, solve_groups
from tests.cases.points import point_problem
from tests.cases.witnesses import HAMROCK_DOWSON, hamrock_dowson

LINES = tomllib.loads((Path(__file__).parents[1] / "references" / "line_contact.toml").read_text(encoding="utf-8"))[
    "point"
]
BALL_OIL = Lubricant.roelands(viscosity=0.02, pressure_viscosity=2e-8, density=870.0)
STEEL = 230.769e9
WARM = 313.15
NUMBERS = ("approach", "film_offset", "stiffness", "damping", "central_film", "minimum_film", "max_pressure")


def on_grid(problem, grid):
    state = newton(problem, grid, *next(starts(problem, grid, (1.0,))))
    assert state.status is Status.CONVERGED
    return state


def test_deflection_by_a_hat_is_its_integral():
    """The kernel's entry of one node against quadrature of its bilinear hat and the hat's image: round-off."""
    grid = point_grid(1.5, 1.0, Cells(10, 5))
    x, y, (i, j) = grid.x, grid.y, (5, 2)
    at = (x[7], y[1])

    def hat(s, nodes, k):
        return np.interp(s, nodes[k - 1 : k + 2], (0.0, 1.0, 0.0))

    def part(v, u, sign):
        return hat(u, x, i) * hat(v, y, j) / math.hypot(at[0] - u, at[1] - sign * v)

    total = sum(
        dblquad(part, u0, u1, v0, v1, (sign,), epsrel=1e-9)[0]
        for u0, u1 in ((x[i - 1], x[i]), (x[i], x[i + 1]))
        for v0, v1 in ((y[j - 1], y[j]), (y[j], y[j + 1]))
        for sign in (1.0, -1.0)
    )
    factor = float(elliptic_numbers(1.5).pressure_factor) / math.pi
    node, other = 7 * y.size + 1, i * y.size + j
    assert grid.kernel[node, other] == pytest.approx(factor * total, rel=1e-8)


@pytest.mark.parametrize("kappa", [0.4, 1.0, 7.0, 30.0])
def test_pressure_of_hertz_makes_the_dry_approach(kappa):
    """Deflection at the centre, g K; a square-root edge leaves an error of order 3/2, and half of the cells less."""
    exact = float(elliptic_numbers(kappa).pressure_factor * elliptic_numbers(kappa).integral)
    errors = []
    for cells in (Cells(24, 12), Cells(48, 24)):
        grid = point_grid(kappa, 1.0, cells)
        middle = int(np.argmin(np.abs(grid.x)))
        deflection = grid.deflection(grid.hertz_pressure())[:, 0]
        along = grid.x[middle - 3 : middle + 4]
        here = np.polynomial.Polynomial.fit(along, deflection[middle - 3 : middle + 4], 4)(0.0)
        errors.append(abs(here / exact - 1.0))
    assert errors[0] < 2e-2
    assert errors[1] < 0.5 * errors[0]


def test_derivatives_are_those_of_the_equations():
    """Bands against central differences of the residual, step 1e-6: truncation and round-off of 1e-7 or so."""
    problem = point_problem(50.0, 8.0, 2.0)
    grid = point_grid(2.0, 1.0, Cells(16, 7))
    state = on_grid(problem, grid)
    rng = np.random.default_rng(1)
    pressure = rng.uniform(-1.0, 1.0, grid.shape) * state.pressure
    film = rng.uniform(-1.0, 1.0, grid.shape) * state.film

    def residual(step):
        found = balance(
            grid.x,
            grid.y,
            state.pressure + step * pressure,
            state.film + step * film,
            problem.wedge,
            problem.isotherm,
            grid.tail.far,
            grid.tail.rolling,
        )
        return found.residual, found

    by_bands = changed(residual(0.0)[1], pressure, film)
    by_steps = (residual(1e-6)[0] - residual(-1e-6)[0]) / 2e-6
    assert np.max(np.abs(by_bands - by_steps)) < 1e-6 * np.max(np.abs(by_bands))


def test_remembered_films_are_those_of_their_fit():
    """Within 5 %: the largest distance of the fit from its own solutions, at k = 1; slips of a digit are more."""
    for k, film in HAMROCK_DOWSON.items():
        fit = hamrock_dowson_minimum(0.1683e-11, 0.1106e-6, 4522.0, k)
        assert 1e6 * fit == pytest.approx(film, rel=0.05)


def test_minimum_films_of_hamrock_and_dowson():
    """Within 5 %: their grids and their inlet of four half-widths; k = 1.03 (Ry/Rx)^0.64 is theirs."""
    assert np.max(np.abs(hamrock_dowson().ratio - 1.0)) < 0.05


@pytest.mark.parametrize("ratio", [0.05, 0.25, 1.0, 3.0])
def test_rigid_isoviscous_films(ratio):
    """Brewe, Hamrock, Taylor (J. Lubr. Technol. 101, 1979, 231-239), a fit, within 6 %; above the closed form.

    With half of Sommerfeld's condition the pressure of a rigid paraboloid has a closed form (Kapitza), whose load is
    too small: for circles the film is H M^2 = 28.4 then.
    """
    leak = 1.0 / (1.0 + 2.0 * ratio / 3.0)
    fit = 128.0 / ratio * (leak * (0.131 * math.atan(0.5 / ratio) + 1.683)) ** 2 / 4.0
    problem = point_problem(0.3, 0.0, ellipticity(ratio))
    film = solve_groups(problem, Resolution()).numbers.minimum_film * problem.moes * 0.3**2
    assert film == pytest.approx(fit, rel=0.06)
    assert ratio != 1.0 or film > 28.4


@pytest.mark.parametrize("line", [point for point in LINES if point["L"] > 0.0], ids=lambda p: f"M{p['M']:g}")
def test_long_ellipses_have_the_film_of_the_line(line):
    """Mid-plane film at kappa 40 against references of lines, with which the line solver agrees: 0.8 %.

    At M = 20 that is of the grids, at M = 5 of the ellipse: on finer grids and with a longer inlet +0.8 % is left at
    kappa 40, 0.7 % at 80, 0.6 % at 200.

    A film of lines is one of their Hertz groups, so that it is compared in these.
    """
    M, L = line["M"], line["L"]
    factor = float(elliptic_numbers(40.0).pressure_factor)
    wedge, piezoviscosity = 3.0 * math.pi**2 / (8.0 * M * M), L * math.sqrt(M / (2.0 * math.pi))
    q = (12.0 / (factor * wedge)) ** 0.75
    problem = point_problem(q * math.pi * 40.0 * factor / 3.0, piezoviscosity / (0.5 * factor * q ** (1 / 3)), 40.0)
    found = solve_groups(problem, Resolution()).numbers
    assert found.central_film * 8.0 * M / math.pi == pytest.approx(line["central_film"], rel=8e-3)


@pytest.mark.parametrize("point", [(20.0, 10.0, 1.0), (100.0, 10.0, 7.0)])
def test_length_of_the_inlet_does_not_matter(point):
    """The same cells, with further ones outside up to three times the inlet: all numbers stay within 0.2 %."""
    problem = point_problem(*point)
    grid = point_grid(point[2], 1.0, Cells(34, 12))
    outer = np.geomspace(1.0, 3.0, 9)[1:]
    along = np.r_[grid.x[0] * outer[::-1], grid.x, grid.x[-1] * outer]
    across = np.r_[grid.y, grid.y[-1] * outer]
    near, wide = on_grid(problem, grid), on_grid(problem, grid_on(point[2], 1.0, along, across))
    before, after = Tangent.of(near).slow(), Tangent.of(wide).slow()
    assert wide.datum + problem.dry_approach == pytest.approx(near.datum + problem.dry_approach, rel=2e-3)
    middle = int(np.argmin(np.abs(grid.x)))
    assert wide.film[middle + outer.size, 0] == pytest.approx(near.film[middle, 0], rel=2e-3)
    assert after.compliance == pytest.approx(before.compliance, rel=2e-3)
    assert after.loss == pytest.approx(before.loss, rel=5e-3)


@pytest.mark.parametrize("point", [(20.0, 10.0, 1.0), (100.0, 10.0, 7.0), (5.0, 0.0, 0.5)])
def test_stiffness_is_the_slope_of_the_approach(point):
    """Tangent against the quotient over 2e-3 of load, on the same nodes in metres: curvature, and nodes that switch."""
    problem, step = point_problem(*point), 1e-3

    def approach(factor):
        grid = point_grid(point[2], factor ** (-1.0 / 3.0), Cells(32, 12))
        return -on_grid(problem.at_load(factor), grid).datum * factor ** (2.0 / 3.0)

    quotient = (approach(1.0 + step) - approach(1.0 - step)) / (2.0 * step * problem.load)
    tangent = Tangent.of(on_grid(problem, point_grid(point[2], 1.0, Cells(32, 12)))).slow()
    assert tangent.compliance == pytest.approx(quotient, rel=1e-3)


def test_tangent_of_another_speed_is_that_of_its_equations():
    """Response over frequency from the Krylov space against a complex solve of the same equations: round-off."""
    state = on_grid(point_problem(20.0, 10.0, 1.0), point_grid(1.0, 1.0, Cells(20, 8)))
    tangent = Tangent.of(state)
    size = tangent.factors.scale.size
    unit = np.eye(size)
    turned = np.column_stack([tangent.moved(unit[k]) for k in range(size)])
    frequencies = np.array([0.01, 0.3, 1.0, 10.0])
    moved = tangent.motions(frequencies)
    for frequency, found in zip(frequencies, moved, strict=True):
        direct = np.linalg.solve(unit + 1j * frequency * turned, tangent.static())[-1]
        assert found == pytest.approx(direct * (1.0 - 1j * frequency * tangent.squeezed), rel=1e-6)
    slow = tangent.slow()
    assert -moved[0].real == pytest.approx(slow.compliance, rel=1e-4)
    assert moved[0].imag / 0.01 == pytest.approx(slow.loss, rel=1e-3)


def test_factors_of_a_step_nearby_solve_what_own_ones_do():
    """Single-precision factors at 25 % more load, with other free nodes, against double ones: 1e-7 of the response.

    Asked for is 1e-10 of all pressures together, of which the approach is some hundredth.
    """
    problem, grid = point_problem(20.0, 6.0, 1.0), point_grid(1.0, 1.0, Cells(20, 8))
    state, other = on_grid(problem, grid), on_grid(problem.at_load(1.25), grid)
    assert not other.factors.double and not np.array_equal(state.free, other.free)
    load = np.zeros(np.count_nonzero(state.free) + 1)
    load[-1] = 1.0
    own = state.equations.factorised(double=True).solved(load)
    assert state.equations.solved(load, other.factors, 1e-10) == pytest.approx(own, abs=1e-7 * np.max(np.abs(own)))
    assert state.equations.applied(own) == pytest.approx(load, abs=1e-10)


def in_motion(state, frequency, steps, amplitude=2e-3):
    """Complex stiffness of a contact whose approach swings, by the equations in time: two periods, backward by two."""
    problem, grid = state.problem, state.grid
    wedge, kernel = problem.wedge, grid.kernel
    size, dt = amplitude * float(np.min(state.film)), 2.0 * math.pi / frequency / steps
    pressure, heights, masses, films = state.pressure.copy(), [state.height] * 2, [], [state.film] * 2
    found = balance(grid.x, grid.y, pressure, state.film, wedge, problem.isotherm, grid.tail.far, grid.tail.rolling)
    masses = [found.density * state.film] * 2
    loads = []
    for count in range(1, 2 * steps + 1):
        height = state.height - size * math.sin(frequency * count * dt)
        for _ in range(40):
            film = grid.deflection(pressure) + grid.parabola + height
            found = balance(grid.x, grid.y, pressure, film, wedge, problem.isotherm, grid.tail.far, grid.tail.rolling)
            rate = (1.5 * found.density * film - 2.0 * masses[-1] + 0.5 * masses[-2]) / dt
            opening = (1.5 * film - 2.0 * films[-1] + 0.5 * films[-2]) / dt
            squeezed = grid.tail.squeezing * wedge * opening / film**2
            residual = found.residual + np.where(grid.tail.far, squeezed, np.where(grid.inner, grid.areas * rate, 0.0))
            by_film = np.where(grid.tail.far, 1.5 / dt * grid.tail.squeezing * wedge / film**2, 0.0)
            by_film += np.where(grid.inner & ~grid.tail.far, 1.5 / dt * grid.areas * found.density, 0.0)
            by_pressure = np.where(grid.inner & ~grid.tail.far, 1.5 / dt * grid.areas * found.density_slope * film, 0.0)
            scaled, scale = jacobian(found, kernel, np.ones(grid.shape, dtype=bool), grid.weights, 0.0)
            bands = (scaled / scale[:, None])[:-1, :-1]
            matrix = bands + by_film.ravel()[:, None] * kernel + np.diag(by_pressure.ravel())
            asked = pressure - residual / np.diagonal(matrix).reshape(grid.shape).clip(1e-300)
            free = ((grid.inner & (asked > 0.0)) | grid.tail.far).ravel()
            drop = np.where(free, 0.0, -pressure.ravel())
            right = -residual.ravel() - matrix @ drop
            move = drop.copy()
            move[free] = np.linalg.solve(matrix[np.ix_(free, free)], right[free])
            pressure = np.maximum(pressure + move.reshape(grid.shape), 0.0)
            if np.max(np.abs(move)) < 1e-10:
                break
        film = grid.deflection(pressure) + grid.parabola + height
        heights.append(height)
        films.append(film)
        found = balance(grid.x, grid.y, pressure, film, wedge, problem.isotherm, grid.tail.far, grid.tail.rolling)
        masses.append(found.density * film)
        rate = (1.5 * heights[-1] - 2.0 * heights[-2] + 0.5 * heights[-3]) / dt
        tail = grid.tail.loads(height)[0] + grid.tail.squeeze * rate
        loads.append(float(np.sum(grid.weights * pressure)) + wedge * tail)
    last = np.array(loads[steps:]) - problem.load
    phase = np.exp(-1j * frequency * dt * np.arange(steps + 1, 2 * steps + 1))
    return 2.0 * np.mean(last * phase) / (-1j * size)


@pytest.mark.parametrize("frequency", [0.5, 2.0])
def test_damping_is_that_of_a_swinging_contact(frequency):
    """Stiffness and damping of the equations in time, two steps extrapolated, against the linearised ones: 1 %.

    What is left is the start of the swing after a period, the square of its size, and the fourth order of the step.
    """
    state = on_grid(point_problem(20.0, 6.0, 1.0), point_grid(1.0, 1.0, Cells(14, 6)))
    linear = -1.0 / Tangent.of(state).motions(np.array([frequency]))[0]
    coarse, fine = (in_motion(state, frequency, steps) for steps in (24, 48))
    moving = fine + (fine - coarse) / 3.0
    assert moving.real == pytest.approx(linear.real, rel=0.01)
    assert moving.imag == pytest.approx(linear.imag, rel=0.01)


@pytest.mark.parametrize("point", [(30.0, 5.0, 7.0), (100.0, 15.0, 1.0), (400.0, 10.0, 3.0), (2.0, 0.0, 1.0)])
def test_stated_errors_bound_the_difference_from_finer_grids(point):
    """Against grids of four thirds of the cells each way, whose own error is a half or so of these."""
    problem = point_problem(*point)
    usual, finer = (solve_groups(problem, grids) for grids in (Resolution(), Resolution((46, 16), (69, 24))))
    for name, value, exact, error in zip(
        usual.numbers._fields, usual.numbers, finer.numbers, usual.errors, strict=True
    ):
        assert abs(value / exact - 1.0) < error, name


def test_a_heavy_circle_is_solved_on_finer_grids():
    """Side films narrower than a cell of the usual grids: these close, or differ by more than is allowed."""
    found = solve_groups(point_problem(2000.0, 10.0, 1.0), Resolution())
    assert found.status is Status.CONVERGED and found.resolution == Resolution().finer
    assert found.worst[1] < MOST_ERROR
    assert found.numbers.minimum_film < 0.5 * found.numbers.central_film
    assert solve_groups(point_problem(2e4, 11.0, 1.0), Resolution()).numbers is None


def test_a_start_from_a_neighbour_ends_in_the_same_numbers():
    """Within the tolerance of Newton, which is quadratic; the neighbour has four thirds of the load."""
    contact = Ellipse(5e-3, 60e-3, STEEL)
    neighbour = solve(contact, BALL_OIL, 80.0, 2.0, WARM)
    cold, warm = (solve(contact, BALL_OIL, 60.0, 2.0, WARM, previous=start) for start in (None, neighbour))
    assert cold.status is warm.status is Status.CONVERGED
    for name in NUMBERS:
        assert getattr(warm, name) == pytest.approx(getattr(cold, name), rel=1e-6)


def test_numbers_of_a_contact_belong_together():
    """Approach and stiffness against the dry contact, slow response against k and c: round-off, and 1e-4 of Omega."""
    contact = Ellipse(4.771e-3, 154.7e-3, STEEL)
    found = solve(contact, BALL_OIL, 100.0, 7.5, WARM, [1.0, 2e4])
    assert found.status is Status.CONVERGED and not found.reason
    assert found.approach == pytest.approx(contact.approach(100.0) - found.film_offset, rel=1e-12)
    dry = 1.0 / float(contact.stiffness(100.0))
    assert 1.0 / found.stiffness == pytest.approx(dry + found.film_compliance, rel=1e-9)
    assert found.damping == pytest.approx(found.loss_compliance * found.stiffness**2, rel=1e-9)
    response = found.response
    assert response.stiffness[0] == pytest.approx(found.stiffness, rel=1e-4)
    assert response.damping[0] == pytest.approx(found.damping, rel=1e-4)
    assert 0.0 < response.damping[1] < 0.9 * found.damping  # the film locks
    assert response.stiffness[1] > found.stiffness
    assert float(np.min(found.field.film)) == pytest.approx(found.minimum_film, rel=0.05)
    assert found.minimum_film < found.central_film < found.film_offset


def nothing_is_told(found):
    return all(math.isnan(getattr(found, name)) and math.isnan(getattr(found, name).error) for name in NUMBERS)


@pytest.mark.parametrize(
    ("load", "speed", "radius", "words"),
    [
        (0.0, 1.0, 10e-3, "no load"),
        (1e6, 1.0, 10e-3, "Hertz pressure"),
        (1e-9, 10.0, 10e-3, "rigid contact"),
        (100.0, 1e-9, 10e-3, "thinner than the grid resolves"),
        (100.0, 1.0, 10.0, "contact of a line"),
        (100.0, 1e-300, 10e-3, "not finite|thinner"),
        (100.0, 1e4, 10e-3, "rigid contact|L = |thicker|film"),
    ],
)
def test_what_is_beyond_reach_is_refused_with_its_reason(load, speed, radius, words):
    found = solve(Ellipse(10e-3, radius, STEEL), BALL_OIL, load, speed, WARM, [10.0])
    if found.status.usable:
        pytest.fail(f"solved: {found}")
    assert re.search(words, found.reason)
    assert nothing_is_told(found)
    assert found.response is None and found.field is None


def test_surfaces_at_rest_are_dry():
    contact = Ellipse(10e-3, 20e-3, STEEL)
    found = solve(contact, BALL_OIL, 50.0, 0.0, WARM, [10.0])
    assert found.status is Status.ASYMPTOTE and found.reason == "no entrainment: dry contact"
    assert found.stiffness == contact.stiffness(50.0) and found.approach == contact.approach(50.0)
    assert found.damping == found.central_film == 0.0
    assert found.response.dynamic_stiffness[0] == contact.stiffness(50.0)


@pytest.mark.parametrize(("load", "speed"), [(-1.0, 1.0), (math.nan, 1.0), (1.0, -1.0), (1.0, math.inf), ("1 N", 1.0)])
def test_what_is_no_load_or_speed_is_refused(load, speed):
    with pytest.raises(InputError, match=r"point contact, .*allowed: a finite number >= 0"):
        solve(Ellipse(10e-3, 10e-3, STEEL), BALL_OIL, load, speed, WARM)


@pytest.mark.parametrize("kappa", [0.3, 3.0, 30.0])
@pytest.mark.parametrize("M", [0.5, 20.0, 20000.0])
def test_every_answer_has_its_error_or_its_reason(M, kappa):
    """From thick films to heavy circles: numbers in their physical order with errors, or none with a reason."""
    radius, modulus = 10e-3, STEEL
    contact = Ellipse(radius, radius / float(elliptic_numbers(kappa).curvature_ratio), modulus)
    speed = 2.0 * 0.02 * 2.0 / (modulus * radius)  # U of 2 m/s
    found = solve(contact, BALL_OIL, M * modulus * radius**2 * speed**0.75, 2.0, WARM)
    if not found.status.usable:
        assert found.reason and nothing_is_told(found)
        return
    assert 0.0 < found.minimum_film <= found.central_film * (1.0 + 1e-9)
    assert found.stiffness > 0.0 and found.max_pressure > 0.0
    for name in NUMBERS:
        assert 0.0 <= getattr(found, name).error < math.inf
