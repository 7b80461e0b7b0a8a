"""Estimated pressure-viscosity: the formulas, their stated error, where they are refused, and what a map says."""

import dataclasses
import itertools
import json
import math
import re
import tomllib
from pathlib import Path

import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.job_text import lubricant_keys
from ehdmaps.jobs.problem import read_lubricant
from ehdmaps.jobs.table import Table
from ehdmaps.maps.records import lubricant_from_json, record_json
from ehdmaps.physics.lubricant import FITTED_PRESSURE, Lubricant
from ehdmaps.physics.own_oil import CORRELATIONS, estimate, gold_mineral, so_klaus
from ehdmaps.physics.viscosity import AstmViscosity

VG32 = {"viscosity_40": 32e-6, "viscosity_100": 5.4e-6, "density": 870.0, "density_slope": -0.6}
MAKERS = (Lubricant.barus, Lubricant.roelands, Lubricant.fva3)


def alpha_of(oil, celsius):
    return oil.at(273.15 + celsius).pressure_viscosity.pressure_viscosity


def published():
    """Viscosity [m2/s], density, slope and measured alpha [1/Pa] of each value of the table."""
    data = tomllib.loads((Path(__file__).parents[1] / "references/pressure_viscosity.toml").read_text())
    temperatures = data["temperatures"]
    densities = [data["density_15"] + data["density_slope"] * (t - 15.0) for t in temperatures]
    for oil in data["oil"]:
        nu = [1e-3 * eta / rho for eta, rho in zip(oil["viscosity"], densities, strict=True)]
        ends = [math.log10(math.log10(1e6 * nu[k] + 0.7)) for k in (0, -1)]
        slope = (ends[0] - ends[1]) / math.log10((273.15 + temperatures[-1]) / (273.15 + temperatures[0]))
        for k, alpha in enumerate(oil["alpha"]):
            if alpha:
                yield nu[k], densities[k], slope, 1e-9 * alpha


@pytest.mark.parametrize("name", CORRELATIONS)
def test_the_stated_error_is_the_one_against_published_oils(name):
    errors = [estimate(name, *given) / alpha - 1.0 for *given, alpha in published()]
    mean = sum(errors) / len(errors)
    rms = math.sqrt(sum(error**2 for error in errors) / len(errors))
    word = "high" if mean > 0 else "low"
    words = f"against {len(errors)} published values of mineral oils {abs(mean):.0%} {word} on average, {rms:.0%} rms"
    assert CORRELATIONS[name].error == words.replace("%", " %")


@pytest.mark.parametrize("name", CORRELATIONS)
def test_the_stated_error_of_a_change_is_the_one_against_published_oils(name):
    """From the value at 30 degC on, which 12 of the oils have, to those at 60 and 100 degC."""
    values, errors = list(published()), []
    densest = max(density for _, density, *_ in values)  # at 30 degC
    for k in (k for k, (_, density, *_) in enumerate(values) if density == densest):
        cold, known = estimate(name, *values[k][:3]), values[k][3]
        for *given, alpha in values[k + 1 : k + 3]:
            errors.append(estimate(name, *given) / cold * known / alpha - 1.0)
    mean, rms = sum(errors) / len(errors), math.sqrt(sum(error**2 for error in errors) / len(errors))
    word = "high" if mean > 0 else "low"
    change = f"from 30 degC on {abs(mean):.0%} {word} on average"
    words = f"{change} against {len(errors)} published values of mineral oils, {rms:.0%} rms"
    assert CORRELATIONS[name].change == words.replace("%", " %")


def test_so_klaus_term_by_term():
    """At nu = 10 mm2/s all logarithms are 1: the sum of the coefficients, with slope and density alone."""
    assert so_klaus(10.0, 1.0, 1.0) == pytest.approx(1.216 + 4.143 + 2.848e-4 - 3.999, rel=1e-14)  # round-off
    assert so_klaus(1.0, 0.9, 3.5) == pytest.approx(1.216, rel=1e-14)
    assert so_klaus(10.0, 0.9, 3.0) - so_klaus(10.0, 0.9, 2.0) == pytest.approx(
        2.848e-4 * (3.0**5.1903 - 2.0**5.1903), rel=1e-12
    )


def test_gold_for_mineral_oils():
    assert gold_mineral(1.0) == 0.9904
    assert gold_mineral(320.0) == pytest.approx(2.208, abs=5e-4)  # half a unit of the last digit of 2.208e-8 1/Pa


def test_the_slope_is_that_of_the_viscosity_law():
    law = AstmViscosity(32e-6, 5.4e-6)
    step = 1.0001
    low, high = (law.at(t, 1.0) * 1e6 for t in (330.0, 330.0 * step))
    difference = math.log10(math.log10(low + 0.7)) - math.log10(math.log10(high + 0.7))
    assert law.slope == pytest.approx(difference / math.log10(step), rel=1e-9)  # round-off over a step of 1e-4


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("name", CORRELATIONS)
def test_an_estimate_holds_at_each_temperature(make, name):
    oil = make(pressure_viscosity=name, **VG32)
    for celsius in (20.0, 40.0, 70.0, 100.0):
        state = oil.at(273.15 + celsius)
        slope = AstmViscosity(32e-6, 5.4e-6).slope
        expected = estimate(name, state.viscosity / state.density, state.density, slope)
        assert state.pressure_viscosity.pressure_viscosity == pytest.approx(expected, rel=1e-12)  # round-off


@pytest.mark.parametrize("name", CORRELATIONS)
def test_an_estimate_is_said_and_not_vouched_for(name):
    oil = Lubricant.roelands(pressure_viscosity=name, **VG32)
    assert not oil.verified
    assert oil.estimated == f"pressure-viscosity estimated by {CORRELATIONS[name].authors}; {CORRELATIONS[name].error}"
    record = oil.record()
    assert record["correlation"] == name and record["estimated"] == oil.estimated
    assert record["pressure_viscosity_40"] == pytest.approx(alpha_of(oil, 40.0), rel=1e-12)
    back = lubricant_from_json(record_json(record))
    assert back == oil and alpha_of(back, 70.0) == alpha_of(oil, 70.0)
    stated = Lubricant.roelands(pressure_viscosity_40=2e-8, pressure_viscosity_100=1.5e-8, **VG32)
    assert stated.verified and stated.estimated == "" and "estimated" not in stated.record()


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("stated_at", [None, 298.15, 343.15])
def test_one_stated_alpha_changes_with_temperature_as_that_of_named_oils(make, stated_at):
    """An oil stated by the numbers of a named one is that oil at all temperatures, density and all."""
    named = Lubricant.named("ISO VG 46")
    alpha = alpha_of(named, 40.0 if stated_at is None else stated_at - 273.15)
    data = {} if stated_at is None else {"pressure_viscosity_temperature": stated_at}
    law = named.viscosity
    oil = make(
        viscosity_40=law.viscosity_40, viscosity_100=law.viscosity_100, density=880.0, pressure_viscosity=alpha, **data
    )
    for celsius in (-5.0, 20.0, 40.0, 70.0, 100.0, 150.0):
        assert alpha_of(oil, celsius) == pytest.approx(alpha_of(named, celsius), rel=1e-12)  # round-off
        state, other = oil.at(273.15 + celsius), named.at(273.15 + celsius)
        assert (state.density, state.viscosity) == (other.density, other.viscosity)
    at = "40 degC (assumed)" if stated_at is None else f"{stated_at - 273.15:.4g} degC"
    assert oil.verified
    assert oil.estimated == (
        f"density -0.6 kg/m3 a K (assumed); pressure-viscosity {1e9 * alpha:.4g} 1/GPa at {at}, its change with "
        f"temperature estimated by So and Klaus (1980), {CORRELATIONS['so-klaus'].change}"
    )
    back = lubricant_from_json(record_json(oil.record()))
    assert back == oil and back.estimated == oil.estimated and alpha_of(back, 70.0) == alpha_of(oil, 70.0)
    section = tomllib.loads("\n".join(f"{key} = {json.dumps(value)}" for key, value in lubricant_keys(oil).items()))
    again = read_lubricant(Table(section, "[lubricant]", problems := []))
    assert not problems and again is not None
    assert alpha_of(again, 70.0) == pytest.approx(alpha_of(oil, 70.0), rel=1e-12)  # round-off of units


def test_a_stated_alpha_is_refused_nowhere_for_the_sake_of_an_estimate():
    """Beyond the reach of its correlation it stays as at the end of that, without a jump."""
    thick = Lubricant.roelands(viscosity_40=320e-6, viscosity_100=24e-6, density=890.0, pressure_viscosity=22e-9)
    alphas = [alpha_of(thick, celsius) for celsius in range(-25, 160, 5)]
    assert max(abs(cold / warm - 1.0) for cold, warm in itertools.pairwise(alphas)) < 0.05  # as within the reach
    assert alphas[0] == pytest.approx(alphas[5], rel=1e-9)  # of 40 halvings
    assert alpha_of(thick, 40.0) == pytest.approx(22e-9, rel=1e-12)
    very = Lubricant.roelands(viscosity_40=2e-3, viscosity_100=80e-6, density=900.0, pressure_viscosity=30e-9)
    assert "Gold et al." in very.estimated
    thin = Lubricant.roelands(viscosity_40=1.5e-6, viscosity_100=0.8e-6, density=800.0, pressure_viscosity=12e-9)
    assert alpha_of(thin, 100.0) == alpha_of(thin, 20.0) == 12e-9
    assert "pressure-viscosity constant over temperature: no correlation knows so thin an oil" in thin.estimated
    assert (
        Lubricant.barus(viscosity_40=32e-6, viscosity_100=5e-6, density=870.0, pressure_viscosity=0.0)
        .at(373.15)
        .pressure_viscosity.pressure_viscosity
        == 0.0
    )


def test_its_error_is_none_where_it_is_stated_and_grows_from_there():
    oil = Lubricant.roelands(pressure_viscosity=2e-8, **VG32)
    errors = [oil.coefficient_error(273.15 + celsius) for celsius in (40.0, 60.0, 100.0)]
    assert errors[0] < 1e-12 < 0.03 < errors[1] < errors[2] < 0.3
    assert Lubricant.roelands(pressure_viscosity="so-klaus", **VG32).coefficient_error(313.15) == 0.17
    assert Lubricant.named("FVA3").coefficient_error(373.15) == 0.0


@pytest.mark.parametrize(
    "data",
    [
        {"pressure_viscosity": "so-klaus", **VG32},
        {"pressure_viscosity_40": 2e-8, "pressure_viscosity_100": 1e-8, **VG32},
        {"pressure_viscosity": 2e-8, "viscosity": 0.1, "density": 880.0},
    ],
)
def test_a_temperature_of_no_alpha_is_refused(data):
    words = "pressure_viscosity_temperature: stands without one pressure_viscosity in 1/Pa beside viscosity_40 and"
    with pytest.raises(InputError, match=words):
        Lubricant.roelands(pressure_viscosity_temperature=313.15, **data)


def test_a_constant_oil_is_told():
    oil = Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0)
    assert oil.estimated == "density and viscosity constant over temperature" and oil.verified
    assert oil.density_slope == 0.0


def test_the_law_of_fva3_takes_no_alpha_of_fva3_silently():
    """The film of an ISO VG 32 was 18 % off without a word."""
    text = r"lubricant 'own oil', pressure_viscosity: got none; viscosity_law fva3 needs it; .*so-klaus, gold-mineral"
    with pytest.raises(InputError, match=text):
        Lubricant.fva3(**VG32)


@pytest.mark.parametrize("make", MAKERS)
def test_an_own_oil_has_a_limit_of_pressure(make):
    assert make(pressure_viscosity=2e-8, **VG32).fitted_pressure == FITTED_PRESSURE == 0.6e9
    assert make(pressure_viscosity=2e-8, fitted_pressure=1e9, **VG32).fitted_pressure == 1e9


def test_what_an_estimate_needs():
    constant = {"viscosity": 0.03, "density": 870.0}
    with pytest.raises(InputError, match=r"got 'so-klaus', which needs the viscosity at two temperatures; .*_40 and"):
        Lubricant.barus(pressure_viscosity="so-klaus", **constant)
    assert alpha_of(Lubricant.barus(pressure_viscosity="gold-mineral", **constant), 60.0) > 0.0
    with pytest.raises(InputError, match=r"pressure_viscosity: got 'gold'; allowed: a number in 1/Pa, or so-klaus, g"):
        Lubricant.barus(pressure_viscosity="gold", **VG32)
    with pytest.raises(InputError, match=r"correlation: got 'gold'; allowed: so-klaus, gold-mineral"):
        dataclasses.replace(Lubricant.named("FVA3"), correlation="gold")


def test_estimates_are_refused_out_of_reach():
    with pytest.raises(InputError, match=r"so-klaus: got 0.9 mm2/s, .*; allowed: 1 mm2/s and above; give pressure_v"):
        estimate("so-klaus", 0.9e-6, 860.0, 3.5)
    with pytest.raises(InputError, match=r"so-klaus: got 2000 mm2/s, .* falls with viscosity; allowed: thinner or li"):
        estimate("so-klaus", 2000e-6, 900.0, 3.0)
    heavy = {"viscosity_40": 1000e-6, "viscosity_100": 60e-6, "density": 980.0}
    with pytest.raises(InputError, match=r"lubricant 'own oil', pressure_viscosity so-klaus: .* \(at 40 degC\)"):
        Lubricant.barus(pressure_viscosity="so-klaus", **heavy)
    oil = Lubricant.barus(pressure_viscosity="so-klaus", **VG32)
    with pytest.raises(InputError, match=re.escape("lubricant 'own oil', pressure_viscosity so-klaus: got")):
        oil.at(248.15)
