"""The solvers hertz and formula, and the contact that `contact_solution` makes of their films."""

import dataclasses
import math
import pickle
import re
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ehdmaps.errors import InputError
from ehdmaps.physics import films, hertz, moes
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FILM_FORMULAS, FormulaSolver, HertzSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import ContactSolver, Status, contact_solution
from ehdmaps.physics.spectrum import contact_spectrum

INNER, OUTER = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")
OIL = Lubricant.named("FVA3")
C40 = 313.15
ROUND_OFF = 1e-12

loads = st.floats(1e2, 1e6)
speeds = st.floats(0.05, 10.0)


def solve(solver, load=88571.4, speed=1.7, temperature=C40, oil=OIL, contact=INNER):
    (film,) = solver.solve_line(contact, oil, (load,), speed, temperature)
    return film


def test_they_are_contact_solvers():
    solvers: list[ContactSolver] = [HertzSolver(), FormulaSolver()]
    assert [solver.name for solver in solvers] == ["hertz", "formula"]
    assert [solver.settings() for solver in solvers] == [{}, {"film_formula": "moes"}]
    assert pickle.loads(pickle.dumps(solvers)) == solvers


def test_hertz_is_dry():
    film = solve(HertzSolver())
    assert (film.status, film.reason) == (Status.CONVERGED, "")
    assert film.film_offset == film.film_compliance == film.loss_compliance == 0.0
    assert film.central_film == film.minimum_film == 0.0
    assert film.max_pressure == hertz.max_pressure(88571.4, INNER.radius, INNER.reduced_modulus)
    contact = contact_solution(film, INNER, OperatingPoint(88571.4, 1.7, C40))
    assert contact.stiffness == pytest.approx(1 / INNER.structural_compliance(88571.4), rel=ROUND_OFF)
    assert contact.damping == 0.0


@pytest.mark.parametrize("speed", [0.0, 1.7])
@pytest.mark.parametrize("solver", [HertzSolver(), FormulaSolver()])
def test_no_error_is_stated(solver, speed):
    """None of a closed form's numbers has a numerical error; the error that counts, that of the model, is not known."""
    film = solve(solver, speed=speed)
    contact = contact_solution(film, INNER, OperatingPoint(88571.4, speed, C40))
    for found in (film, contact):
        errors = {field.name: getattr(found, field.name) for field in fields(found) if field.name.endswith("_error")}
        assert len(errors) >= 8 and all(math.isnan(error) for error in errors.values()), errors


def test_formula_is_the_formula():
    film, state = solve(FormulaSolver()), OIL.at(C40)
    groups = (88571.4, 1.7, state.viscosity, state.pressure_viscosity.pressure_viscosity)
    M, L = moes.moes_groups(*groups, INNER.radius, INNER.reduced_modulus)
    expected = moes.film_from_moes(films.moes_central(M, L), 1.7, state.viscosity, INNER.radius, INNER.reduced_modulus)
    assert film.status is Status.CONVERGED
    assert film.film_offset == film.central_film == pytest.approx(expected, rel=ROUND_OFF)
    c = films.rolling_film_damping(film.central_film, state.viscosity, INNER.radius)
    assert film.loss_compliance == pytest.approx(c * film.film_compliance**2, rel=ROUND_OFF)
    assert 0 < film.minimum_film < film.central_film


@pytest.mark.parametrize("formula", FILM_FORMULAS)
@given(load=loads, speed=speeds)
def test_film_compliance_is_the_derivative_of_the_film(formula, load, speed):
    """Central differences with a relative step of 1e-4: truncation 1e-8."""
    solver, step = FormulaSolver(formula), 1e-4 * load
    film = solve(solver, load, speed)
    up, down = solve(solver, load + step, speed), solve(solver, load - step, speed)
    slope = (down.film_offset - up.film_offset) / (2 * step)
    assert film.film_compliance == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("formula", FILM_FORMULAS)
@given(load=loads, speed=speeds, celsius=st.floats(0.0, 120.0))
def test_films_are_ordered_and_physical(formula, load, speed, celsius):
    solver = FormulaSolver(formula, thickest_film=math.inf)
    film = solve(solver, load, speed, 273.15 + celsius)
    assert film.status.usable
    assert film.film_compliance > 0
    assert film.loss_compliance > 0
    assert 0 < film.minimum_film <= film.central_film == film.film_offset
    faster = solve(solver, load, 1.5 * speed, 273.15 + celsius)
    assert faster.central_film > film.central_film


@given(load=loads, speed=speeds)
def test_approach_and_stiffness_agree(load, speed):
    """k is the derivative of the approach: central differences with a relative step of 1e-4."""
    solver, step = FormulaSolver(), 1e-4 * load

    def solution(at):
        return contact_solution(solve(solver, at, speed), INNER, OperatingPoint(at, speed, C40))

    difference = 2 * step / (solution(load + step).approach - solution(load - step).approach)
    assert solution(load).stiffness == pytest.approx(difference, rel=1e-5)
    assert solution(load).damping > 0


def test_at_rest_the_contact_is_dry_and_says_so():
    film = solve(FormulaSolver(), speed=0.0)
    assert film.status is Status.ASYMPTOTE
    assert film.reason == "entrainment speed zero: dry contact"
    dry = solve(HertzSolver(), speed=0.0)
    assert dataclasses.replace(film, status=dry.status, reason="") == dry


def test_thick_films_are_a_stated_limit():
    film = solve(FormulaSolver(), load=1000.0, speed=10.0, temperature=273.15)
    assert film.status is Status.ASYMPTOTE
    assert "above 0.01: outside thin-film theory" in film.reason
    assert film.film_offset > 0.01 * INNER.radius
    refused = solve(FormulaSolver(), load=1.0, speed=10.0, temperature=273.15)
    assert refused.status is Status.OUTSIDE_VALIDITY
    assert re.match("film h/R = [0-9.]+ above 0.3: neither thin-film theory nor", refused.reason)


def test_extrapolated_viscosity_is_flagged():
    assert not solve(FormulaSolver(), load=1e4).viscosity_extrapolated
    assert solve(FormulaSolver(), load=1e6).viscosity_extrapolated
    assert not solve(HertzSolver(), load=1e6).viscosity_extrapolated


def test_no_film_is_a_status_and_no_number():
    isoviscous = Lubricant.barus(viscosity=0.08, pressure_viscosity=0.0, density=880.0)
    film = solve(FormulaSolver("dowson-toyoda"), oil=isoviscous)
    assert film.status is Status.OUTSIDE_VALIDITY
    assert film.reason == "the film formula dowson-toyoda gives no finite, positive film here"
    assert math.isnan(film.film_offset)
    assert solve(FormulaSolver(), oil=isoviscous).status is Status.CONVERGED


@pytest.mark.parametrize(("load", "speed"), [(1e-300, 1e-300), (1e300, 1e-300), (1e-300, 1e300), (1e300, 1e300)])
def test_absurd_points_end_with_a_status(load, speed):
    film = solve(FormulaSolver(), load, speed)
    numbers = (film.film_offset, film.film_compliance, film.loss_compliance, film.max_pressure)
    assert film.status.usable == all(math.isfinite(number) for number in numbers)


def test_a_load_beyond_floats_ends_with_a_status():
    for solver in (HertzSolver(), FormulaSolver()):
        film = solve(solver, load=1.7e308)
        assert film.status is Status.OUTSIDE_VALIDITY
        assert math.isnan(film.max_pressure)
    assert solve(HertzSolver(), load=1.7e308).reason == "the Hertz pressure is not finite here"


def test_a_line_is_its_points_in_the_order_given():
    line = FormulaSolver().solve_line(OUTER, OIL, (1e5, 1e3, 1e4), 1.0, C40)
    assert line == tuple(solve(FormulaSolver(), load, 1.0, contact=OUTER) for load in (1e5, 1e3, 1e4))


@pytest.mark.parametrize("solver", [HertzSolver(), FormulaSolver()])
def test_films_without_memory_over_frequency(solver):
    """S = s - i omega loss at every frequency, from one solve."""
    frequencies = np.array([1.0, 1000.0])
    found = solver.film_spectrum(INNER, OIL, OperatingPoint(88571.4, 1.7, C40), frequencies)
    film = solve(solver)
    assert found.film == film
    assert found.compliance.real == pytest.approx(np.full(2, film.film_compliance), rel=ROUND_OFF)
    assert found.compliance.imag == pytest.approx(-2.0 * math.pi * frequencies * film.loss_compliance, rel=ROUND_OFF)
    assert np.isnan(found.errors).all() and np.isnan(found.largest_error).all()
    response = contact_spectrum(found, INNER, OperatingPoint(88571.4, 1.7, C40))
    assert np.isnan(response.stiffness_error).all() and np.isnan(response.damping_error).all()
    assert math.isnan(response.at(1).film_compliance_error)


@pytest.mark.parametrize("solver", [HertzSolver(), FormulaSolver()])
def test_impossible_points_are_refused(solver):
    with pytest.raises(InputError, match=r"load: got 0.0 N/m; allowed: finite and > 0"):
        solve(solver, load=0.0)
    with pytest.raises(InputError, match=r"entrainment_speed: got -1.0 m/s"):
        solve(solver, speed=-1.0)
    with pytest.raises(InputError, match=r"temperature: got nan K"):
        solve(solver, temperature=math.nan)


def test_a_temperature_without_an_oil_is_bad_input():
    with pytest.raises(InputError, match=r"lubricant 'FVA3', temperature: got -20 degC"):
        solve(FormulaSolver(), temperature=253.15)


def test_unknown_formula():
    with pytest.raises(InputError, match=r"film_formula: got 'grubin'; allowed: moes, dowson-toyoda, pan-hamrock"):
        FormulaSolver("grubin")
