"""The isotherm of an oil: its forms, their derivatives, the compiled law beside the Python one, and Tait-Doolittle."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.reynolds import LineProblem, oil
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.errors import InputError
from ehdmaps.openfoam.parameters import Mesh, Parameters
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.isotherm import (
    FREE_VOLUME,
    LINEAR,
    LOGARITHMIC,
    POWER,
    RATIONAL,
    FreeVolume,
    PressureViscosity,
    density,
    log_viscosity,
)
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.viscosity import PRESSURE_LAWS, TaitDoolittle

LAWS = {
    LINEAR: PressureViscosity(2e-8, 1.0, math.inf),
    RATIONAL: PressureViscosity(2.2e-8, -1.0, 2.7e9),
    LOGARITHMIC: PressureViscosity(2e-8, 0.0, 1.96e8),
    POWER: PressureViscosity(1.7e-8, 0.67, 1.96e8),
    FREE_VOLUME: FreeVolume(2e-8, 1e8, 4.0),
}
PRESSURES = np.array([0.0, 1e5, 1e8, 5e8, 1e9, 3e9, 3.5e9, 6e9])
NUMBERS = {
    "doolittle_slope": 4.5,
    "occupied_fraction": 0.66,
    "occupied_expansion": -7e-4,
    "volume_expansion": 8e-4,
    "bulk_modulus": 8.7e9,
    "bulk_modulus_decay": 6.3e-3,
    "bulk_modulus_slope": 11.0,
    "reference_temperature": 313.15,
}
OWN = Lubricant.own("tait-doolittle", NUMBERS, viscosity=0.02, density=800.0)
CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
HEADERS = Path(__file__).parents[2] / "openfoam_cases" / "ehlFoam" / "lubricant"

every_form = pytest.mark.parametrize(("form", "law"), LAWS.items(), ids=["linear", "fva3", "log", "power", "free"])


# --- the forms -------------------------------------------------------------------------------------------


@every_form
def test_the_compiled_law_is_the_python_one(form, law):
    """One source: a difference beyond round-off means that stale compiled code is loaded (delete __pycache__)."""
    unit = 1.3e9
    isotherm = law.isotherm(unit, compressible=True)
    assert isotherm.form == form
    out = oil(LineProblem(1.0, isotherm), PRESSURES / unit)
    expected = [*log_viscosity(isotherm, PRESSURES / unit), *density(isotherm, PRESSURES / unit)]
    for found, value in zip(out, expected, strict=True):
        np.testing.assert_allclose(found, value, rtol=1e-14)  # round-off of numpy's and the compiler's functions


@every_form
def test_derivatives_are_those_of_the_law(form, law):
    isotherm = law.isotherm(1e9, compressible=True)
    p, step = np.linspace(0.05, 3.4, 12), 1e-5
    for function in (log_viscosity, density):
        difference = (function(isotherm, p + step)[0] - function(isotherm, p - step)[0]) / (2.0 * step)
        # truncation step^2 f''' and round-off 1e-16 f/step of the difference
        np.testing.assert_allclose(function(isotherm, p)[1], difference, rtol=1e-6)


@every_form
def test_the_slope_at_zero_is_the_pressure_viscosity(form, law):
    assert law.log_ratio_slope(0.0) == pytest.approx(law.pressure_viscosity, rel=1e-15)  # round-off
    assert law.log_ratio(0.0) == 0.0


@every_form
def test_the_unit_of_pressure_does_not_matter(form, law):
    plain, other = law.isotherm(1.0, compressible=True), law.isotherm(2.0e9, compressible=True)
    for function in (log_viscosity, density):
        value, slope = function(plain, 0.8e9)
        assert function(other, 0.4) == pytest.approx((value, slope * 2.0e9), rel=1e-14)  # round-off
        assert function(plain.scaled(2.0e9), 0.4) == pytest.approx((value, slope * 2.0e9), rel=1e-14)


# --- free volume -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("temperature", [293.15, 313.15, 373.15])
@pytest.mark.parametrize("p", [1e7, 3e8, 1.2e9])
def test_tait_doolittle_in_its_usual_form(temperature, p):
    """Tait's volume and Doolittle's viscosity written out, relative to p = 0."""
    b, r0, e, a, k00, beta, slope, reference = NUMBERS.values()

    def exponent(pressure):
        modulus = k00 * math.exp(-beta * temperature)
        shrunk = 1.0 - math.log(1.0 + pressure * (1.0 + slope) / modulus) / (1.0 + slope)
        volume = shrunk * (1.0 + a * (temperature - reference))
        occupied = 1.0 + e * (temperature - reference)
        return b * r0 * (occupied / (volume - r0 * occupied) - 1.0 / (1.0 - r0))

    law = OWN.at(temperature).pressure_viscosity
    assert law.log_ratio(p) == pytest.approx(exponent(p) - exponent(0.0), rel=1e-12)  # round-off of the differences
    alpha = (exponent(1e3) - exponent(0.0)) / 1e3
    assert law.pressure_viscosity == pytest.approx(alpha, rel=1e-4)  # truncation 1e3 Pa * 1e-8, round-off 1e-15/1e-5


def test_free_volume_bends_up_where_the_family_bends_down():
    """ln eta over pressure of this law has an inflection; the other laws are concave."""
    slopes = FreeVolume(2e-8, 1e8, 4.0).log_ratio_slope(np.array([0.0, 3e8, 2e9]))
    assert slopes[1] < slopes[0] and slopes[1] < slopes[2]


def test_a_vast_free_volume_is_the_exponent_zero():
    free, limit = FreeVolume(2e-8, 1.96e8, 500.0), PressureViscosity(2e-8, 0.0, 1.96e8)
    g = math.log1p(1e9 / 1.96e8)
    assert free.log_ratio(1e9) == pytest.approx(limit.log_ratio(1e9) / (1.0 - g / 500.0), rel=1e-14)  # round-off


def test_a_vast_pressure_scale_is_barus():
    # ln(1 + x) = x - x^2/2 and 1/(1 - x/c), with x = 1e-6
    assert FreeVolume(2e-8, 1e15, 4.0).log_ratio(1e9) == pytest.approx(20.0, rel=1e-6)


def test_the_law_goes_on_along_its_tangent():
    law = FreeVolume(2e-8, 1e8, 4.0)
    end = 1e8 * math.expm1(0.9 * 4.0)
    assert law.log_ratio_slope(3.0 * end) == law.log_ratio_slope(end)
    assert law.log_ratio(3.0 * end) == pytest.approx(law.log_ratio(end) + 2.0 * end * law.log_ratio_slope(end))


def test_reynolds_solves_a_free_volume_that_is_barus():
    """With p_c far above the pressures of the contact ln eta is that of Barus within 1e-6."""
    state = OWN.at(313.15)
    films = []
    for law in (FreeVolume(1.5e-8, 1e15, 4.0), PressureViscosity(1.5e-8, 1.0, math.inf)):
        problem, M, L = line_problem(CONTACT, dataclasses.replace(state, pressure_viscosity=law), 2e4, 1.0)
        films.append(solve_groups(problem, M, L, Resolution(density=4.0)).film_offset)
    assert films[0] == pytest.approx(films[1], rel=1e-5)


def test_reynolds_solves_tait_doolittle():
    """The film depends on alpha above all: it lies near that of Barus' law with the same alpha."""
    solver, line = ReynoldsSolver(density=4.0), ((2e3, 2e4), 1.0, 313.15)
    alpha = OWN.at(313.15).pressure_viscosity.pressure_viscosity
    barus = Lubricant.barus(viscosity=0.02, pressure_viscosity=alpha, density=800.0)
    for film, same in zip(
        solver.solve_line(CONTACT, OWN, *line), solver.solve_line(CONTACT, barus, *line), strict=True
    ):
        assert film.status.usable
        assert film.central_film == pytest.approx(same.central_film, rel=0.1)  # what else there is than alpha


# --- what is refused -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((-1e-8, 1e8, 4.0), r"pressure_viscosity: got -1e-08 1/Pa; allowed: finite and >= 0"),
        ((2e-8, math.inf, 4.0), r"pressure_scale: got inf Pa; allowed: finite and > 0 Pa"),
        ((2e-8, 1e8, 0.0), r"free_volume: got 0.0; allowed: > 0 and at most 500"),
    ],
)
def test_numbers_of_no_free_volume_are_refused(values, message):
    with pytest.raises(InputError, match=message):
        FreeVolume(*values)


def test_numbers_out_of_the_limits_of_tait_doolittle_are_all_named():
    with pytest.raises(InputError) as caught:
        TaitDoolittle(**NUMBERS | {"occupied_fraction": 1.0, "bulk_modulus": 1.0})
    assert [problem.partition(";")[0] for problem in caught.value.problems] == [
        "occupied_fraction: got 1.0",
        "bulk_modulus: got 1.0 Pa",
    ]


def test_a_temperature_without_free_volume_is_refused():
    law = TaitDoolittle(**NUMBERS | {"occupied_expansion": -1e-2, "volume_expansion": 1e-2})
    with pytest.raises(InputError, match=r"occupied volume of .*; allowed: above 0 and below the volume"):
        law.at(250.0, 0.1)


@pytest.mark.parametrize(
    ("word", "numbers", "stated", "message"),
    [
        ("own", {}, {}, r"viscosity_law: got 'own'; allowed: barus, roelands, fva3, tait-doolittle"),
        ("barus", {"exponent": 0.6}, {"pressure_viscosity": 2e-8}, r"exponent: stands beside .* has: none; delete it"),
        ("tait-doolittle", {}, {}, r"doolittle_slope: missing; viscosity_law tait-doolittle needs it"),
        ("tait-doolittle", NUMBERS, {"pressure_viscosity": 2e-8}, r"whose numbers give it; delete it"),
    ],
)
def test_an_own_oil_states_the_numbers_of_its_law(word, numbers, stated, message):
    with pytest.raises(InputError, match=message):
        Lubricant.own(word, numbers, viscosity=0.1, density=880.0, **stated)


def test_no_correlation_with_a_law_that_gives_alpha():
    with pytest.raises(InputError, match=r"correlation: got 'so-klaus' with a law whose numbers give alpha"):
        dataclasses.replace(OWN, correlation="so-klaus")


# --- the other home: C++ ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "law", [law for form, law in LAWS.items() if form != LOGARITHMIC], ids=lambda law: law.case_name
)
def test_every_law_has_a_class_that_reads_its_numbers(law):
    """The case file names a type of ehlFoam and every entry that its constructor asks for."""
    source = (HEADERS / f"{law.case_name}.C").read_text()
    assert f'TypeName("{law.case_name}")' in (HEADERS / f"{law.case_name}.H").read_text()
    wanted = set(re.findall(r'\(dict, "(\w+)"\)', source))
    state = dataclasses.replace(OWN.at(313.15), pressure_viscosity=law)
    text = Parameters(5e-3, 2.3e11, 1e4, 1.0, 1.0, state, 500.0, Mesh(0.2), 40, 4).text()
    (block,) = re.findall(r"^viscosity\s*\{\s*type\s+(\w+);(.*?)\}", re.sub("//.*", "", text), re.MULTILINE | re.DOTALL)
    assert block[0] == law.case_name
    assert wanted == set(re.findall(r"(\w+)\s+[^;]+;", block[1]))


def test_every_law_of_a_job_file_is_looked_at_here():
    assert list(PRESSURE_LAWS) == ["barus", "roelands", "fva3", "tait-doolittle"]
