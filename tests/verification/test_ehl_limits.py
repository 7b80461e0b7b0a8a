"""The solver against closed forms, independent solutions and film formulas."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.ehl.grid import DRY_DATUM, lay_out, log_kernel
from ehdmaps.ehl.group_solution import COMPLIANCE_LOST, FILM_LOST, LOSS_LOST, ROLLING_GAINED
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.films import dowson_higginson_minimum, dowson_toyoda_central, moes_central
from ehdmaps.physics.hertz import DRY_COMPLIANCE
from tests.cases.ehl import isoviscous_problem, moes_film, solved

REFERENCES = tomllib.loads((Path(__file__).parents[1] / "references" / "line_contact.toml").read_text())
POINTS = REFERENCES["point"]
LIMITS = {limit["name"]: limit for limit in REFERENCES["limit"]}


@pytest.mark.parametrize("point", POINTS, ids=lambda p: f"M{p['M']:g}-L{p['L']:g}")
def test_independent_solver(point: dict[str, float]) -> None:
    # the bars of the default grid: 1e-3 in films, 5e-3 in loss; the compliance's 1e-2 of its film part is 1e-3 or more
    # here; at M = 0.1 the inlet of the reference ends early, which is 7e-4 in films and 1.4e-3 in compliance
    result = solved(point["M"], point["L"])
    assert moes_film(result.minimum_film, point["M"]) == pytest.approx(point["minimum_film"], rel=1e-3)
    if "central_film" in point:
        assert moes_film(result.central_film, point["M"]) == pytest.approx(point["central_film"], rel=1e-3)
    assert result.film_compliance + DRY_COMPLIANCE == pytest.approx(point["compliance"], rel=2e-3)
    assert result.loss == pytest.approx(point["loss"], rel=5e-3)


@pytest.mark.parametrize("point", POINTS, ids=lambda p: f"M{p['M']:g}-L{p['L']:g}")
def test_independent_solver_on_a_fine_grid(point: dict[str, float]) -> None:
    """With the inlet of the references, which ends at 60 sqrt(2hR): what a longer inlet changes is tested below."""
    # 1e-4: what is left of both grid errors; 1e-3 in loss: the reference's tangent is locked to the cell of its spike
    result = solved(point["M"], point["L"], density=30.0, inlet_length=60.0)
    assert moes_film(result.minimum_film, point["M"]) == pytest.approx(point["minimum_film"], rel=1e-4)
    if "central_film" in point:
        assert moes_film(result.central_film, point["M"]) == pytest.approx(point["central_film"], rel=1e-4)
    assert result.film_compliance + DRY_COMPLIANCE == pytest.approx(point["compliance"], rel=1e-4)
    assert result.loss == pytest.approx(point["loss"], rel=1e-3)


def test_inlet_length() -> None:
    """An inlet that ends at X sqrt(2hR) loses about 2.4/X^2 of a thick film, as its error estimate says."""
    long, short = (solved(0.1, 0.0, density=20.0, inlet_length=x) for x in (2000.0, 60.0))
    lost = 1.0 - short.film_offset / long.film_offset
    assert lost == pytest.approx(2.4 / 60.0**2, rel=0.1)  # 10 %: the next term of the series
    assert lost < short.film_offset.error < 5.0 * lost


def test_what_an_inlet_loses_and_what_is_stated() -> None:
    """Of a rigid film the bounds are a fifth larger than the loss, and what is stated no more than a third."""
    long, short = (solved(1e-3, 0.0, density=26.0, inlet_length=x) for x in (3000.0, 60.0))
    for name, bound in (
        ("film_offset", FILM_LOST),
        ("mass_flow", FILM_LOST),
        ("film_compliance", COMPLIANCE_LOST),
        ("loss", LOSS_LOST),
        ("rolling_force", -ROLLING_GAINED),
    ):
        lost = 1.0 - getattr(short, name) / getattr(long, name)
        assert lost * 60.0**2 == pytest.approx(bound / 1.22, rel=0.03)  # 3 %: rounded, and the next term of the series
        assert abs(lost) < abs(getattr(short, name).error) < 1.3 * abs(lost)


def test_default_inlet_loses_less_than_the_cells_add() -> None:
    """Of a rigid film, of which it loses most, less than half; at a density of 13 too, whose inlet is longer."""
    for density in (Resolution().density, 13.0):
        usual, long, exact = (
            solved(1e-3, 0.0, density=d, inlet_length=x)
            for d, x in ((density, None), (density, 3000.0), (26.0, 3000.0))
        )
        added = long.film_offset / exact.film_offset - 1.0
        lost = 1.0 - usual.film_offset / long.film_offset
        assert 0.0 < lost < 0.5 * added
    assert ReynoldsSolver(density=13.0).settings()["inlet_length"] == 4.0 * Resolution().inlet


def test_martin_limit() -> None:
    # elastic deflection is 1e-5 of the film at M = 1e-3; grid error of a rigid film at 4 times the default density
    M = 1e-3
    result = solve_groups(isoviscous_problem(M), M, 0.0, Resolution(density=26.0, inlet_length=3000.0))
    limit = LIMITS["rigid isoviscous rolling film"]
    assert moes_film(result.minimum_film, M) * M == pytest.approx(limit["film_times_M"], rel=5e-5)
    # film stiffness w/h: compliance H/W
    assert result.film_compliance == pytest.approx(result.minimum_film / (0.5 * math.pi), rel=2e-4)
    # c = loss/compliance^2 = 6.548 eta (R/h)^1.5, with eta u R^2/(b^3 p_H) = lambda/12
    damping = result.loss / result.film_compliance**2
    viscosity = isoviscous_problem(M).wedge / 12.0
    assert damping == pytest.approx(limit["damping"] * viscosity / result.minimum_film**1.5, rel=3e-4)


def test_dry_limit() -> None:
    # at M = 1e5 the film is 2e-6 b^2/R: pressure is Hertz's but for the inlet, which is 2e-4 b wide (sqrt(2e-4) high)
    result = solved(1e5, 2.0)
    profile = result.profile
    assert profile is not None
    hertz = np.sqrt(np.maximum(0.0, 1.0 - profile.position**2))
    assert np.max(np.abs(profile.pressure - hertz)) < 0.03
    inside = np.abs(profile.position) < 0.99
    assert np.max(np.abs(profile.pressure - hertz)[inside]) < 1e-3
    assert result.film_offset < 1e-5
    assert abs(result.film_compliance) < 1e-5  # round-off and grid error; dry compliance is 0.22


@pytest.mark.parametrize("cells", [40, 80, 160])
def test_log_kernel_on_hertz_pressure(cells: int) -> None:
    """The deflection of (1 - X^2)^3, whose integral has a closed form by quadrature, to fourth order or better."""
    from scipy.integrate import quad

    layout = lay_out(0.5, 3.0)
    grid = layout.grid(cells)
    kernel = log_kernel(grid.x, grid.step)
    centre = -2.0

    def pressure(x: float) -> float:
        t = x - centre
        return max(0.0, 1.0 - t * t) ** 5

    node = int(np.argmin(np.abs(grid.x - centre - 0.3)))
    at = float(grid.x[node])
    exact = quad(lambda s: pressure(s) * math.log(abs(at - s)), -3.0, -1.0, points=[at], limit=200)[0] / math.pi
    error = abs(float(kernel[node] @ np.array([pressure(x) for x in grid.x])) - exact)
    # order 4: error of 40 cells is 3e-5 or less, and falls by 2^4 each time
    assert error < 1e-4 * (40 / cells) ** 4


def test_datum_of_the_dry_contact() -> None:
    """H0 of Hertz' pressure: the integral at X = 0 in closed form."""
    from scipy.integrate import quad

    integral = 2.0 * quad(lambda s: math.sqrt(1.0 - s * s) * math.log(s), 0.0, 1.0)[0] / math.pi
    assert integral == pytest.approx(DRY_DATUM, rel=1e-10)  # quadrature error


@pytest.mark.parametrize(("M", "L"), [(2.0, 5.0), (5.0, 10.0), (20.0, 5.0), (20.0, 15.0), (100.0, 10.0), (300.0, 5.0)])
def test_film_formulas_within_their_bands(M: float, L: float) -> None:
    """Stated bands of the formulas (model error of the formulas) for M >= 2."""
    result = solved(M, L, "incompressible")
    central = moes_film(result.central_film, M)
    minimum = moes_film(result.minimum_film, M)
    assert -0.06 <= central / float(moes_central(M, L)) - 1.0 <= 0.01
    # any U gives the same groups: h/R = H sqrt(2 U)
    speed = 1e-11
    load = M * math.sqrt(2.0 * speed)
    material = L / (2.0 * speed) ** 0.25
    height = math.sqrt(2.0 * speed)
    assert -0.07 <= minimum * height / float(dowson_higginson_minimum(speed, load, material)) - 1.0 <= 0.16
    assert abs(central * height / float(dowson_toyoda_central(speed, load, material)) - 1.0) <= 0.22
