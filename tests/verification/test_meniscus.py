"""Starved contacts: the inlet's meniscus in `reynolds` beside closed forms, a second method, and the flooded film."""

from __future__ import annotations

import dataclasses
import math
from functools import cache

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import ehdmaps.ehl.meniscus as meniscus_module
from ehdmaps.ehl.grid import log_kernel
from ehdmaps.ehl.group_solution import linearised_profile
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.meniscus import StarvedGroups, starved_groups
from ehdmaps.ehl.newton import newton
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.ehl.solver import ReynoldsSolver, SuppliedFilm
from ehdmaps.ehl.ways import LOAD
from ehdmaps.jobs.reader import read_job
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import DRY_COMPLIANCE, half_width
from ehdmaps.physics.isotherm import log_viscosity
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.solution import FilmSolution, Status
from tests.cases.ehl import incompressible_problem, isoviscous_problem, solved

JOB = read_job("nu308")
INNER, OIL = JOB.contacts[0], JOB.lubricant
SOLVER = ReynoldsSolver()


@cache
def starved(M: float, L: float, ratio: float, law: str = "incompressible", density: float = 6.5) -> StarvedGroups:
    """Solve a contact at a part of its flooded flow."""
    flooded = solved(M, L, law, density=density)
    return starved_groups(M, L, Resolution(density=density), ratio * flooded.mass_flow, flooded)


# ---- loaded limit: Grubin's inlet, cut off at the meniscus (Wolveridge, Baglin, Archard, Proc. IMechE 185, 1970, 1159)


def hertz_gap(x: float) -> float:
    """Gap of the dry contact outside of its edge [b^2/R]; series near it, where the closed form cancels."""
    beyond = x - 1.0
    if beyond < 1e-4:
        return 2.0 / 3.0 * math.sqrt(2.0) * beyond**1.5
    return 0.5 * (x * math.sqrt(x * x - 1.0) - math.log(x + math.sqrt(x * x - 1.0)))


def grubin_film(problem: LineProblem, meniscus: float) -> float:
    """Film at which Int dP/eta from the meniscus to the edge of the Hertz zone is that of an oil that goes solid."""
    reduced = quad(lambda P: math.exp(-log_viscosity(problem.isotherm, P)[0]), 0.0, 1.0, points=(0.02, 0.1))[0]

    def excess(film: float) -> float:
        def rise(root: float) -> float:  # x = 1 + root^2
            gap = hertz_gap(1.0 + root * root)
            return problem.wedge * gap / (film + gap) ** 3 * 2.0 * root

        far = math.sqrt(meniscus - 1.0)
        near = min(film ** (1.0 / 3.0), 0.5 * far)  # the gap there is about the film
        return (
            quad(rise, 0.0, near)[0]
            + quad(rise, near, min(10.0 * near, far))[0]
            + (quad(rise, 10.0 * near, far)[0] if 10.0 * near < far else 0.0)
            - reduced
        )

    return float(brentq(excess, 1e-5, 10.0, rtol=1e-10))


@pytest.mark.parametrize("L", [10.0, 20.0, 30.0])
@pytest.mark.parametrize("ratio", [0.99, 0.95, 0.9, 0.8, 0.6, 0.4])
def test_loaded_film_falls_as_in_grubins_inlet(L, ratio):
    """Grubin leaves out what the inlet's own pressure, of size 1/alpha, does to the gap: of order L^(-5/4)."""
    problem = incompressible_problem(30.0, L)
    here = grubin_film(problem, -starved(30.0, L, ratio).meniscus) / grubin_film(problem, 300.0)
    assert here == pytest.approx(ratio, abs=1.3 * (1.0 - ratio) * L**-1.25 + 1e-4)


def test_loaded_film_is_the_layer():
    """Behind the inlet a piezoviscous contact carries its film unchanged: the film in the middle is the flow."""
    flooded = solved(30.0, 20.0, "incompressible")
    for ratio in (0.9, 0.4, 0.1):
        film = starved(30.0, 20.0, ratio).solution.central_film
        assert film / flooded.central_film == pytest.approx(ratio, rel=5e-4)


# ---- light limit: rigid cylinder, constant viscosity, in units of sqrt(2 H0) and H0; all by quadrature


def rigid_exit(inlet: float) -> float:
    """Exit c of a film that begins at -inlet: Int (t^2 - c^2)/(1 + t^2)^3 dt = 0 between both."""

    def pressure_at_exit(c: float) -> float:
        return float(quad(lambda t: (t * t - c * c) / (1.0 + t * t) ** 3, -inlet, c, points=(0.0,), limit=200)[0])

    return float(brentq(pressure_at_exit, 1e-6, 1.0, xtol=1e-14))


def rigid_load(inlet: float) -> float:
    """W H0/(2 lambda) = -Int t (t^2 - c^2)/(1 + t^2)^3 dt."""
    c = rigid_exit(inlet)
    return -float(quad(lambda t: t * (t * t - c * c) / (1.0 + t * t) ** 3, -inlet, c, points=(0.0,), limit=200)[0])


def rigid_flow(inlet: float) -> float:
    """M at a given load, in units of 2 lambda/W."""
    return rigid_load(inlet) * (1.0 + rigid_exit(inlet) ** 2)


@dataclasses.dataclass(frozen=True)
class RigidFilm:
    """H0, place of the meniscus, -dH0/dW and the loss with the meniscus held, in the groups of the problem."""

    film: float
    meniscus: float
    compliance: float
    loss: float


def rigid_film(wedge: float, ratio: float) -> RigidFilm:
    """Closed form of the starved cylinder at a part of the flooded flow."""
    flooded = rigid_flow(1e3)
    inlet = float(brentq(lambda a: rigid_flow(a) - ratio * flooded, 1e-2, 1e3, xtol=1e-10))
    c = rigid_exit(inlet)
    film = 2.0 * wedge * rigid_load(inlet) / LOAD
    unit = math.sqrt(2.0 * film)
    # W = 2 lambda I(a)/H0 with a = X_in/sqrt(2 H0), X_in held
    slope = (rigid_load(1.001 * inlet) - rigid_load(0.999 * inlet)) / (0.002 * inlet)
    by_film = -2.0 * wedge / film**2 * (rigid_load(inlet) + 0.5 * inlet * slope)
    # squeeze e = dH0/dT: P' = lambda (H - m + e (X - X_exit))/H^3; the exit moves so that P stays zero there

    def moment(power: int, weight: float) -> float:
        whole = quad(lambda t: t**power / (1.0 + t * t) ** 3, -inlet, c, points=(0.0,), limit=200)[0]
        return float(weight * whole)

    by_squeeze = moment(1, 1.0) - moment(0, c)  # Int (t - c)/(1 + t^2)^3
    by_exit = -2.0 * moment(0, c)  # derivative of Int (t^2 - c^2)/(1 + t^2)^3 by c
    moved = -by_squeeze / by_exit
    lifted = -(moment(2, 1.0) - moment(1, c)) + moved * moment(1, 2.0 * c)
    # by t: e (X - X_exit) is e unit (t - c) against H0 (t^2 - c^2)
    by_rate = 2.0 * wedge / film * unit / film * lifted
    compliance = -1.0 / by_film
    return RigidFilm(film, -inlet * unit, compliance, -compliance * compliance * by_rate)


@pytest.mark.parametrize("ratio", [0.99, 0.9, 0.6, 0.3, 0.1])
def test_rigid_cylinder_has_its_closed_form(ratio):
    """M = 1e-3: elastic deflection is 1e-6 of the film. Bars: what the grid of density 13 leaves, order two."""
    M = 1e-3
    problem = isoviscous_problem(M)
    flooded = solved(M, 0.0, density=13.0)
    found = starved_groups(M, 0.0, Resolution(density=13.0), ratio * flooded.mass_flow, flooded)
    wanted = rigid_film(problem.wedge, ratio)
    assert found.solution.film_offset == pytest.approx(wanted.film, rel=1e-4)
    assert found.meniscus == pytest.approx(wanted.meniscus, rel=2e-3)
    assert found.solution.film_compliance + DRY_COMPLIANCE == pytest.approx(wanted.compliance, rel=1e-3)
    assert found.solution.loss == pytest.approx(wanted.loss, rel=2e-3)


# ---- response


@pytest.mark.parametrize(("M", "L", "ratio"), [(0.3, 10.0, 0.6), (4.0, 15.0, 0.9), (15.0, 10.0, 0.5)])
def test_film_compliance_is_that_of_a_held_meniscus(M, L, ratio):
    """Newton at 0.1 % more and less load with the grid's end where it was; the differences' own error is 1e-5.

    Where there is a spike the response follows it, and the differences do not: their bar is that of the grid, 1 %.
    """
    found = starved(M, L, ratio)
    profile = found.solution.profile
    assert profile is not None
    heights = []
    for load in (1.001 * LOAD, 0.999 * LOAD):
        unknowns, length = profile.unknowns, profile.layout.length
        for _ in range(8):
            grid = dataclasses.replace(profile.layout, length=length).grid(profile.cells)
            kernel = log_kernel(grid.x, grid.step)
            arguments = grid.x, grid.step, grid.face_step, kernel
            unknowns = newton(profile.problem, *arguments, unknowns, load, 1e-11, 60).unknowns
            length = float(unknowns[-2]) - found.meniscus
        heights.append(unknowns[-1])
    compliance = (heights[1] - heights[0]) / (0.002 * LOAD) - DRY_COMPLIANCE
    assert found.solution.film_compliance == pytest.approx(compliance, rel=1e-2 if profile.spike else 1e-5)


@pytest.mark.parametrize("load", [2e3, 50e3])
def test_compliance_at_a_given_layer_is_the_slope_of_its_films(load):
    """The tangent with the meniscus following, beside films at 1 % more and less load; bar: second order, and grids."""
    temperature, layer = 333.15, OilSupply(0.3e-6)

    def film(weight: float) -> SuppliedFilm:
        return SOLVER.supplied_film(INNER, OIL, OperatingPoint(weight, 2.0, temperature), layer)

    lighter, heavier = film(0.99 * load).film.film_offset, film(1.01 * load).film.film_offset
    slope = (lighter - heavier) / (0.02 * load)
    # both are small differences: of the order of 1e-2 of film over load
    assert film(load).supplied_compliance == pytest.approx(slope, abs=1e-3 * film(load).film.film_offset / load)


def test_a_flooded_contact_has_no_meniscus_to_follow():
    profile = solved(1.0, 10.0).profile
    assert profile is not None
    with pytest.raises(ValueError, match="no meniscus"):
        linearised_profile(profile).supplied_compliance()


# ---- facts of a second method: a solver of its own, whose secant finds the length of the film


@pytest.mark.parametrize(
    ("load", "ratio", "meniscus", "central", "offset", "compliance", "loss"),
    [
        (0.5e3, 0.9, "166", "0.902", "0.902", "0.82", "0.77"),
        (0.5e3, 0.6, "60", "0.613", "0.614", "0.42", "0.32"),
        (0.5e3, 0.2, "17", "0.217", "0.218", "0.10", "0.05"),
        (5e3, 0.9, "13.8", "0.904", "0.900", "0.66", "0.62"),
        (5e3, 0.6, "4.8", "0.625", "0.617", "0.15", "0.11"),
        (5e3, 0.4, "2.7", "0.442", "0.419", "0.13", "0.09"),
        (50e3, 0.9, "2.97", "0.899", "0.875", "1.09", "0.95"),
        (50e3, 0.6, "1.64", "0.599", "0.577", "2.2", "1.3"),
        (200e3, 0.9, "1.83", "0.900", "0.881", "1.4", "1.04"),
        (200e3, 0.4, "1.13", "0.400", "0.388", "7.0", "3.3"),
    ],
)
def test_nu308_at_60_degrees_as_by_a_second_method(load, ratio, meniscus, central, offset, compliance, loss):
    """2 m/s, FVA 3; bars: one of the last digit for place and films, half of it and 1 % of the grid for responses."""
    point = OperatingPoint(load, 2.0, 333.15)
    flooded, found = flooded_and_starved(point, ratio)
    half = float(half_width(load, INNER.radius, INNER.reduced_modulus))
    film = found.film

    def digit(text: str) -> float:
        return float(10.0 ** -len(text.partition(".")[2]))

    def is_about(value: float, text: str, digits: float, share: float = 0.0) -> bool:
        return abs(value - float(text)) <= digits * digit(text) + share * abs(value)

    assert found.flow_ratio == pytest.approx(ratio, rel=1e-9)
    assert is_about(found.meniscus / half, meniscus, 1.0)
    assert is_about(film.central_film / flooded.central_film, central, 1.0)
    assert is_about(film.film_offset / flooded.film_offset, offset, 1.0)
    assert is_about(film.film_compliance / flooded.film_compliance, compliance, 0.5, 0.01)
    assert is_about(film.loss_compliance / flooded.loss_compliance, loss, 0.5, 0.01)


def flooded_and_starved(point: OperatingPoint, ratio: float) -> tuple[FilmSolution, SuppliedFilm]:
    """The flooded film, and that behind a layer that brings a part of its flow."""
    flooded = SOLVER.supplied_film(INNER, OIL, point, FLOODED).film
    layer = ratio * flooded.mass_flow / (OIL.at(point.temperature).density * point.entrainment_speed)
    return flooded, SOLVER.supplied_film(INNER, OIL, point, OilSupply(layer))


# ---- limits


@pytest.mark.parametrize("load", [0.3e3, 5e3, 200e3])
def test_a_layer_that_just_fails_to_flood_changes_nothing(load):
    """1e-7 less than flooded: bars are what the end of the inlet changes, 6 over the squared length."""
    point = OperatingPoint(load, 2.0, 333.15)
    flooded, found = flooded_and_starved(point, 1.0 - 1e-7)
    lost = 6.0 / SOLVER.resolution.inlet**2
    assert 0.0 < found.flow_ratio < 1.0 and found.meniscus < math.inf
    assert found.film.film_offset == pytest.approx(flooded.film_offset, rel=lost)
    assert found.film.film_compliance == pytest.approx(flooded.film_compliance, rel=2.0 * lost)
    assert found.film.loss_compliance == pytest.approx(flooded.loss_compliance, rel=2.0 * lost)


@pytest.mark.parametrize("supply", [FLOODED, OilSupply(1e-3)])
def test_enough_oil_gives_the_flooded_film_to_the_last_bit(supply):
    found = SOLVER.supplied_film(INNER, OIL, OperatingPoint(20e3, 1.0, 323.15), supply)
    (flooded,) = SOLVER.solve_line(INNER, OIL, (20e3,), 1.0, 323.15)
    assert dataclasses.replace(found.film, solve_seconds=0.0) == dataclasses.replace(flooded, solve_seconds=0.0)
    assert (found.flow_ratio, found.meniscus) == (1.0, math.inf) and math.isnan(found.supplied_compliance)


@pytest.mark.parametrize("layer", [1e-9, 1e-7, 1e-5, 1e-3])
@pytest.mark.parametrize(("load", "speed", "kelvin"), [(1.0, 30.0, 273.15), (1e3, 0.01, 313.15), (1e6, 0.3, 373.15)])
def test_extreme_layers_have_a_film_each(load, speed, kelvin, layer):
    """From a molecule to a millimetre; the flow is the layer to the tolerance of the search; k and c are positive."""
    found = SOLVER.supplied_film(INNER, OIL, OperatingPoint(load, speed, kelvin), OilSupply(layer))
    film = found.film
    assert film.status.usable, film.reason
    assert 0.0 < found.flow_ratio <= 1.0
    if found.flow_ratio < 1.0:
        assert film.mass_flow == pytest.approx(layer * OIL.at(kelvin).density * speed, rel=1e-7)
        assert film.film_compliance > 0.0 and film.loss_compliance > 0.0
        assert found.profile is not None
        assert -found.profile.x[0] == pytest.approx(found.meniscus) and found.profile.pressure[0] == 0.0
        assert np.all(found.profile.pressure >= 0.0) and film.central_film < 1.3 * layer


def test_thinner_layers_have_thinner_films_and_nearer_menisci():
    point = OperatingPoint(10e3, 1.0, 333.15)
    found = [SOLVER.supplied_film(INNER, OIL, point, OilSupply(layer)) for layer in np.geomspace(2e-8, 4e-7, 8)]
    assert found[-1].flow_ratio > 0.9
    for name in ("central_film", "minimum_film", "film_offset", "rolling_force"):
        assert np.all(np.diff([getattr(each.film, name) for each in found]) > 0.0), name
    assert np.all(np.diff([each.meniscus for each in found]) > 0.0)


def test_points_without_a_starved_film_say_so(monkeypatch):
    layer = OilSupply(1e-7)
    dry = SOLVER.supplied_film(INNER, OIL, OperatingPoint(1e4, 0.0, 333.15), layer)
    assert dry.film.status is Status.ASYMPTOTE and math.isnan(dry.flow_ratio) and dry.profile is None
    beyond = SOLVER.supplied_film(INNER, OIL, OperatingPoint(1e9, 1.0, 333.15), layer)
    assert beyond.film.status is Status.OUTSIDE_VALIDITY and beyond.profile is None
    monkeypatch.setattr(meniscus_module, "MOST_PLACES", 0)
    lost = SOLVER.supplied_film(INNER, OIL, OperatingPoint(1e4, 1.0, 333.15), layer)
    assert lost.film.status is Status.STAGNATED and "meniscus" in lost.film.reason
    assert math.isnan(lost.film.film_offset) and math.isnan(lost.meniscus) and 0.0 < lost.flow_ratio < 1.0


@pytest.mark.parametrize(("M", "ratio"), [(0.1, 0.5), (3.0, 0.3), (40.0, 0.7)])
def test_stated_errors_cover_a_finer_grid(M, ratio):
    """Density 6.5 beside 15; what the finer one still has, a fifth of it, is part of the bar."""
    rough, fine = starved(M, 10.0, ratio, "roelands").solution, starved(M, 10.0, ratio, "roelands", 15.0).solution
    flow = fine.mass_flow / rough.mass_flow  # both have a part of their own flow
    for name in ("film_offset", "film_compliance", "loss", "central_film", "rolling_force"):
        error = abs(getattr(rough, name) / getattr(fine, name) - 1.0) - abs(flow - 1.0)
        assert error <= 1.25 * abs(getattr(rough, name).error), name
