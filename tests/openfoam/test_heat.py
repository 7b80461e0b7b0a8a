"""Heat in the film: closed forms, the balance of energy, work that becomes heat, and k as the slope over the load."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.ehl.start import reynolds_start
from ehdmaps.openfoam.fields import read_fields
from ehdmaps.openfoam.grid_solver import GridSolution
from ehdmaps.openfoam.parameters import STEP, Heat, Isotherms, Parameters
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.heat import HeatData
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from tests.cases import openfoam_runs

pytestmark = pytest.mark.openfoam

OIL = Lubricant.named("FVA3")
CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
DATA = HeatData()
POINT = OperatingPoint(5e3, 10.0, 333.15)
"""Light and fast: film and loss follow the heat in the inlet."""


@cache
def _parameters(load: float = POINT.load) -> Parameters:
    """The point, or another load [N/m]."""
    solver = OpenFoamSolver(physics="thermal", starter=reynolds_start)
    return replace(solver.parameters(CONTACT, OIL, replace(POINT, load=load)), columns=100, rows=6)


@cache
def _solved(load: float = POINT.load) -> GridSolution:
    return openfoam_runs.run(_parameters(load))


def test_a_strip_of_heat_on_a_moving_solid(tmp_path: Path) -> None:
    half, flux = 1e-4, 1e8
    face = half * np.linspace(-2.0, 3.0, 201)
    middle = 0.5 * (face[1:] + face[:-1])
    heated = np.where(np.abs(middle) < half, flux, 0.0)
    x, warmer = openfoam_runs.table(_parameters(), tmp_path / "strip", "walls", face=face, flux=heated).T
    effusivity = math.sqrt(DATA.solid_conductivity * DATA.solid_heat_capacity * DATA.solid_density)
    unit = 2.0 * flux / (effusivity * math.sqrt(math.pi * POINT.entrainment_speed))
    jaeger = unit * (np.sqrt(np.maximum(x + half, 0.0)) - np.sqrt(np.maximum(x - half, 0.0)))
    # round-off: flux is constant in columns, and the strip ends between two of them
    np.testing.assert_allclose(warmer, jaeger, rtol=1e-11, atol=1e-12 * unit)
    # an elliptic source: the largest Int sqrt(1 - s^2)/sqrt(x - s) ds is 2.1880; 40 columns across the half-width
    ellipse = flux * np.sqrt(np.maximum(1.0 - (middle / half) ** 2, 0.0))
    _, warmer = openfoam_runs.table(_parameters(), tmp_path / "ellipse", "walls", face=face, flux=ellipse).T
    assert warmer.max() == pytest.approx(0.5 * 2.1880 * unit * math.sqrt(half), rel=1e-3)


def test_the_isotherms_are_the_oil(tmp_path: Path) -> None:
    pressures, temperatures = (
        np.array([0.0, 1e7, 3e8, 1e9]),
        POINT.temperature + np.array([-31.0, -2.0, 0.0, 1.3, 77.0, 250.5]),
    )
    table = openfoam_runs.table(_parameters(), tmp_path / "oil", "laws", pressure=pressures, temperature=temperatures)
    viscosity, density, expansion = table[:, 2:].T.reshape(3, pressures.size, temperatures.size)
    for k, temperature in enumerate(temperatures.tolist()):
        state, warmer = OIL.at(temperature), OIL.at(temperature + 1.0)
        # the cubic through four isotherms
        np.testing.assert_allclose(np.log(viscosity[:, k]), np.log(state.viscosity_at(pressures)), atol=1e-4)
        np.testing.assert_allclose(density[:, k], state.density * state.density_ratio(pressures), rtol=1e-12)
        np.testing.assert_allclose(expansion[:, k], (state.density - warmer.density) / state.density, rtol=1e-9)


@pytest.mark.parametrize("nahme", [0.5, 8.0])
def test_a_couette_film_between_walls_that_stay_cold(nahme: float, tmp_path: Path) -> None:
    warming, slide_to_roll, rows = 0.03, 1.8, 16
    settings = openfoam_runs.parameters(1.0, 0.0, 60, rows, hertz=True)
    cold = settings.oil
    sliding = math.sqrt(nahme * DATA.oil_conductivity / (warming * cold.viscosity))
    speed = sliding / slide_to_roll
    scale = speed / settings.lower_speed
    states = tuple(replace(cold, viscosity=cold.viscosity * math.exp(-warming * k * STEP)) for k in range(-3, 40))
    # nothing is carried, and walls that lead heat perfectly
    data = HeatData(oil_heat_capacity=1e-6, solid_conductivity=1e15)
    settings = replace(
        settings,
        load=math.sqrt(scale) * settings.load,
        lower_speed=speed * (1.0 - 0.5 * slide_to_roll),
        upper_speed=speed * (1.0 + 0.5 * slide_to_roll),
        heat=Heat(cold.temperature, data, Isotherms(cold.temperature - 3.0 * STEP, states)),
        write_fields=True,
    )
    found = openfoam_runs.run(settings, keep=tmp_path)
    (case,) = [path.parent for path in tmp_path.rglob("constant") if path.is_dir()]
    fields = read_fields(case)
    assert fields.T is not None
    # where the pressure is largest nothing but the walls drags the oil
    place = float(found.film.x[np.argmax(found.film.pressure)])
    height, temperature = fields.profile(fields.T, place, rows)
    _, velocity = fields.profile(fields.U[:, 0], place, rows)
    root = math.sqrt(nahme / 8.0)
    turn = math.asinh(root)
    expected = np.log((1.0 + nahme / 8.0) / np.cosh(turn * (2.0 * height - 1.0)) ** 2) / warming
    # the even part of temperatures and the odd one of velocities: the pressure has a small gradient in the column;
    # second order in the rows
    even = 0.5 * (temperature + temperature[::-1]) - cold.temperature
    np.testing.assert_allclose(even, expected, atol=2e-3 * expected.max())
    moved = 0.5 * sliding * np.tanh(turn * (2.0 * height - 1.0)) / math.tanh(turn)
    np.testing.assert_allclose(0.5 * (velocity - velocity[::-1]), moved, atol=2e-3 * sliding)


def test_the_energy_that_is_made_leaves_the_film() -> None:
    found = _solved().results
    made = found.dissipated_heat + found.compression_heat
    # round-off: the scheme is conservative, so only what Newton's method leaves is missing
    assert found.wall_heat + found.carried_heat == pytest.approx(made, abs=1e-7 * found.dissipated_heat)
    assert found.film_temperature > found.surface_temperature + 1.0 > POINT.temperature + 1.1


def test_the_work_of_the_walls_becomes_heat_and_pressure() -> None:
    found = _solved()
    film = found.film
    rise = np.diff(film.pressure)
    between = 0.5 * (film.film[1:] + film.film[:-1])
    volume = film.flux / film.density
    work = POINT.entrainment_speed * np.sum(between * rise) - np.sum(0.5 * (volume[1:] + volume[:-1]) * rise)
    # the scheme: heat of shear by parabolas in a row of 6, and first differences of the pressure along 100 columns
    assert found.results.dissipated_heat == pytest.approx(float(work), rel=0.02)


def test_the_film_compliance_is_the_slope_of_the_film_over_the_load() -> None:
    load, step = POINT.load, 0.01
    more, less = (_solved(load * (1.0 + sign * step)).results for sign in (1.0, -1.0))
    slope = (less.film_offset - more.film_offset) / (2.0 * step * load)
    # columns move with the load: what that changes of the film is part of the discretisation
    assert _solved().results.film_compliance[0] == pytest.approx(slope, rel=0.02)


def test_all_stresses_with_heat() -> None:
    thin, full = _solved().results, openfoam_runs.run(replace(_parameters(), flow="full_stress")).results
    # what thin films neglect: the slope of the film, 0.01 in the inlet where it is made and heated
    for name in ("central_film", "minimum_film", "film_offset"):
        assert getattr(full, name) == pytest.approx(getattr(thin, name), rel=2e-3), name
    for name in ("film_temperature", "surface_temperature"):
        rise, thin_rise = (getattr(found, name) - POINT.temperature for found in (full, thin))
        assert rise == pytest.approx(thin_rise, rel=0.01), name
    # not so what is made in all: the inlet of all stresses begins at half a radius, and backflow before it heats too
    assert full.wall_heat == pytest.approx(thin.wall_heat, rel=5e-3)
    # responses are of first order along the film: 3 % x 100/columns each
    for name in ("film_compliance", "loss_compliance"):
        assert getattr(full, name)[0] == pytest.approx(getattr(thin, name)[0], rel=0.03), name
    # conservative: what Newton's method leaves
    made = full.dissipated_heat + full.compression_heat
    assert full.wall_heat + full.carried_heat == pytest.approx(made, abs=1e-7 * full.dissipated_heat)


def test_no_heat_is_no_change() -> None:
    settings = _parameters()
    assert settings.heat is not None
    # an oil that leads heat away as fast as copper stays cold
    data = replace(DATA, oil_conductivity=1e9, solid_conductivity=1e12)
    cold = openfoam_runs.run(replace(settings, heat=replace(settings.heat, data=data))).results
    plain = openfoam_runs.run(replace(settings, heat=None)).results
    for name in ("central_film", "minimum_film", "film_offset"):
        # what is left of the heat, 1e-9 of a kelvin
        assert getattr(cold, name) == pytest.approx(getattr(plain, name), rel=1e-7)
    for name in ("film_compliance", "loss_compliance"):
        assert getattr(cold, name)[0] == pytest.approx(getattr(plain, name)[0], rel=1e-5)


@pytest.mark.parametrize(("load", "celsius"), [(2.5e4, 20.0), (4e3, 70.0)])
def test_the_stated_error_covers_that_of_the_rows(load: float, celsius: float) -> None:
    """Six rows alone cost up to 2 % of a hot film; the reference has 24 on the same columns, a sixteenth of that."""
    contact = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[1]
    point = OperatingPoint(load, 10.0, celsius + 273.15)
    solver = OpenFoamSolver(columns=120, physics="thermal", shear="limiting", starter=reynolds_start)
    film, fine = solver.solve_fields(contact, OIL, point)
    assert film.status.usable, film.reason
    assert fine is not None
    parameters = solver.parameters(contact, OIL, point)
    many = openfoam_runs.run(replace(parameters, rows=24, start=fine.start)).results
    found = (film.film_offset, film.film_compliance, film.loss_compliance)
    errors = (film.film_offset_error, film.film_compliance_error, film.loss_compliance_error)
    for mine, error, true in zip(
        found, errors, (many.film_offset, many.film_compliance[0], many.loss_compliance[0]), strict=True
    ):
        assert abs(mine - true) < abs(error * mine), (mine, true, error)
    # what is left of the rows' error is a fraction of what six of them have
    rows = fine.results.film_offset - many.film_offset
    assert abs(film.film_offset - many.film_offset) < max(0.25 * abs(rows), 5e-4 * many.film_offset)


def test_a_run_from_its_own_film_is_there() -> None:
    cold, warm = _solved(), openfoam_runs.run(replace(_parameters(), start=_solved().start))
    # 1e-9 is the length of the last step of both
    assert warm.results.film_offset == pytest.approx(cold.results.film_offset, rel=1e-8)
    assert warm.results.film_temperature == pytest.approx(cold.results.film_temperature, rel=1e-8)
    # heat at once, in the columns where it is
    assert warm.results.iterations <= 10


def test_a_run_from_its_own_film_is_there_where_the_stress_is_limited() -> None:
    """Fast and loaded: each column has to begin with its own temperatures, not with those of the centre."""
    solver = OpenFoamSolver(physics="thermal", shear="limiting", starter=reynolds_start)
    point = OperatingPoint(1.585e5, 10.0, 323.15)
    parameters = replace(solver.parameters(CONTACT, OIL, point), columns=200, rows=3)
    cold = openfoam_runs.run(parameters)
    warm = openfoam_runs.run(replace(parameters, start=cold.start))
    # 1e-9 is the length of the last step of both
    assert warm.results.film_offset == pytest.approx(cold.results.film_offset, rel=1e-7)
    assert warm.results.iterations <= 10


def test_a_limiting_stress_and_heat_at_the_highest_pressures() -> None:
    """From a coarse grid on, each grid is near the one before it, with its temperatures: from cold films none is."""
    contact = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[1]
    point = OperatingPoint(1e6, 10.0**-0.15, 293.15)
    solver = OpenFoamSolver(columns=200, physics="thermal", shear="limiting", starter=reynolds_start)
    (film,) = solver.solve_line(contact, OIL, (point.load,), point.entrainment_speed, point.temperature)
    assert film.status.usable, film.reason
    reynolds = ReynoldsSolver(physics="thermal", shear="limiting")
    (known,) = reynolds.solve_line(contact, OIL, (point.load,), point.entrainment_speed, point.temperature)
    stated = abs(film.film_offset_error) + abs(known.film_offset_error)
    # two ways to write the same equations: what both state, and what inlet and the mean of columns differ by
    assert film.film_offset == pytest.approx(known.film_offset, rel=stated + 3e-3)


def test_a_cold_fast_loaded_film_is_found_from_an_oil_that_hardly_stiffens() -> None:
    """Where the isothermal film has none, the way over stiffening ends at the film to which a slower one leads."""
    contact = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[1]
    solver = OpenFoamSolver(columns=120, physics="thermal", shear="limiting", starter=reynolds_start)
    point = OperatingPoint(1.585e5, 10.0, 293.15)
    asked = replace(solver.parameters(contact, OIL, point), columns=120, rows=3)
    found = openfoam_runs.run(asked)
    slower = openfoam_runs.run(replace(asked, lower_speed=9.7, upper_speed=9.7, start=found.start))
    again = openfoam_runs.run(replace(asked, start=slower.start))
    assert slower.results.film_offset < 0.999 * found.results.film_offset
    # 1e-9 is the length of the last step of both
    assert again.results.film_offset == pytest.approx(found.results.film_offset, rel=1e-7)
