"""Oils: the viscosity family over pressure, the laws over temperature, density, records."""

import dataclasses
import inspect
import json
import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ehdmaps.errors import InputError
from ehdmaps.jobs.job_text import lubricant_keys
from ehdmaps.maps.records import lubricant_from_json
from ehdmaps.physics.heat import HeatData, heat_data
from ehdmaps.physics.lubricant import FITTED_PRESSURE, LUBRICANTS, Lubricant, LubricantState, OilData, PressureViscosity
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.viscosity import AstmViscosity, Barus, ConstantViscosity, Fva3, Roelands, VogelViscosity

ROUND_OFF = 1e-12
C40, C100 = 313.15, 373.15
P0 = 1.96e8

families = st.builds(
    PressureViscosity,
    pressure_viscosity=st.floats(1e-9, 5e-8),
    exponent=st.sampled_from([-1.0, 0.0, 0.3, 0.67, 0.999, 1.0]),
    pressure_scale=st.floats(1e7, 1e10),
)


# --- the family ------------------------------------------------------------------------------------------


def test_barus_is_exact():
    law = PressureViscosity(2e-8, 1.0, math.inf)
    pressures = np.array([0.0, 1e8, 3e9])
    np.testing.assert_array_equal(law.log_ratio(pressures), 2e-8 * pressures)
    np.testing.assert_array_equal(law.log_ratio_slope(pressures), 2e-8)
    assert PressureViscosity(2e-8, 1.0, P0).log_ratio(1e9) == 20.0


def test_roelands_in_its_usual_form():
    eta0, z, p = 0.04, 0.67, 0.8e9
    alpha = z * (math.log(eta0) + 9.67) / P0
    expected = (math.log(eta0) + 9.67) * ((1 + p / P0) ** z - 1)
    assert PressureViscosity(alpha, z, P0).log_ratio(p) == pytest.approx(expected, rel=ROUND_OFF)


def test_fva3_in_its_usual_form_in_bar():
    theta, bar = 60.0, 4000.0
    expected = bar / (327.7918 + 2.9862 * theta + (4.419e-3 + 3.0115e-4 * theta) * bar)
    law = Fva3().at(273.15 + theta, viscosity=0.03)
    assert law.log_ratio(bar * 1e5) == pytest.approx(expected, rel=ROUND_OFF)


@given(law=families)
def test_alpha_is_the_slope_at_zero_pressure(law):
    assert law.log_ratio(0.0) == 0.0
    assert law.log_ratio_slope(0.0) == law.pressure_viscosity
    assert law.log_ratio(1.0) == pytest.approx(law.pressure_viscosity, rel=1e-6)  # p/p_c = 1e-7 at most


@given(law=families, p=st.floats(1e5, 4e9))
def test_slope_is_the_derivative(law, p):
    """Central differences with a relative step of 1e-4: truncation (1e-4)^2."""
    step = 1e-4 * p
    difference = (law.log_ratio(p + step) - law.log_ratio(p - step)) / (2 * step)
    assert law.log_ratio_slope(p) == pytest.approx(difference, rel=1e-6)


@given(law=families, p=st.just(0.0) | st.floats(1e-3, 4e9))
def test_viscosity_rises_with_pressure_and_barus_bounds_it(law, p):
    assert 0.0 <= law.log_ratio(p) <= law.pressure_viscosity * p * (1 + ROUND_OFF)
    assert law.log_ratio(p + 1e6) > law.log_ratio(p)


@given(p=st.floats(1e6, 3e9))
def test_family_is_continuous_in_its_exponent(p):
    """At z = 1e-7 and 1 - 1e-7 the difference from the limit is of the order 1e-7 ln(1 + p/p_c)."""
    zero = PressureViscosity(2e-8, 0.0, P0).log_ratio(p)
    assert PressureViscosity(2e-8, 1e-7, P0).log_ratio(p) == pytest.approx(zero, rel=1e-6)
    assert PressureViscosity(2e-8, 1 - 1e-7, P0).log_ratio(p) == pytest.approx(2e-8 * p, rel=1e-6)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ((-1e-8, 1.0, math.inf), r"pressure_viscosity: got -1e-08 1/Pa; allowed: finite and >= 0"),
        ((math.nan, 1.0, math.inf), r"pressure_viscosity: got nan 1/Pa"),
        ((2e-8, math.inf, 1e8), r"exponent: got inf; allowed: finite"),
        (
            (2e-8, 0.6, math.inf),
            r"pressure_scale: got inf Pa with the exponent 0.6; .* inf only with the exponent 1",
        ),
        ((2e-8, 0.6, 0.0), r"pressure_scale: got 0.0 Pa"),
        ((2e-8, 0.6, math.nan), r"pressure_scale: got nan Pa"),
    ],
)
def test_impossible_families_are_refused(values, text):
    with pytest.raises(InputError, match=text):
        PressureViscosity(*values)


# --- named oils ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("temperature", "viscosity", "alpha"), [(C40, 84.5e-3, 2.24e-8), (C100, 9.86e-3, 1.60e-8)])
def test_fva3_viscosity(temperature, viscosity, alpha):
    """Half a unit of the last of three printed digits."""
    state = Lubricant.named("FVA3").at(temperature)
    assert state.viscosity == pytest.approx(viscosity, rel=6e-4)
    assert state.pressure_viscosity.pressure_viscosity == pytest.approx(alpha, rel=3e-3)


def test_fva3_record_and_density():
    oil = Lubricant.named("FVA3")
    assert oil.verified
    assert oil.at(288.15).density == pytest.approx(887.6, rel=ROUND_OFF)
    assert oil.at(C40).density == pytest.approx(887.6 - 0.6 * 25, rel=ROUND_OFF)
    assert oil.at(C40).fitted_pressure == 0.6e9
    assert oil.thermal_conductivity == 0.134


def test_a_reach_that_nobody_stated_is_called_assumed():
    data = {"viscosity": 0.04, "roelands_z": 0.6, "density": 870.0}
    assumed = Lubricant.roelands(**data)
    stated = Lubricant.roelands(**data, fitted_pressure=FITTED_PRESSURE)
    far = Lubricant.roelands(**data, fitted_pressure=1e9)
    endless = Lubricant.roelands(**data, fitted_pressure=math.inf)
    assert assumed == stated != far  # the same numbers
    assert [oil.reach_assumed for oil in (assumed, stated, far, endless)] == [True, False, False, False]
    assert assumed.reach == "0.6 GPa, the reach that is assumed for own oil (none is stated)"
    assert replace(stated, label="VG 46").reach == "0.6 GPa, up to which VG 46 is stated"
    assert endless.reach == "those of its data"
    for oil in (assumed, stated, far, Lubricant.named("FVA3")):
        assert lubricant_from_json(json.dumps(oil.record())).reach == oil.reach
    # records and jobs that were made before anyone asked are those of today
    assert "fitted_pressure_stated" not in assumed.record() | far.record()
    assert "fitted_pressure" not in lubricant_keys(assumed)
    assert lubricant_keys(stated)["fitted_pressure"] == "600000000.0 Pa"


def test_spirax_is_marked_as_a_guess():
    oil = Lubricant.named("Spirax MA 80W")
    state = oil.at(C40)
    assert not oil.verified
    assert state.viscosity / state.density == pytest.approx(87.5e-6, rel=1e-9)
    assert state.pressure_viscosity.pressure_viscosity == pytest.approx(2e-8, rel=ROUND_OFF)
    assert oil.at(C100).viscosity / oil.at(C100).density == pytest.approx(9.5e-6, rel=1e-9)


def test_unknown_oil():
    with pytest.raises(InputError, match=r"lubricant name: got 'FVA 4'.*; allowed: FVA3, .*, or ISO VG 2, 3"):
        Lubricant.named("FVA 4")


@pytest.mark.parametrize("name", LUBRICANTS)
@given(celsius=st.floats(-10.0, 150.0))
def test_named_oils_thin_with_temperature(name, celsius):
    oil = Lubricant.named(name)
    cold, hot = oil.at(273.15 + celsius), oil.at(274.15 + celsius)
    assert hot.viscosity < cold.viscosity
    assert hot.density < cold.density
    assert hot.pressure_viscosity.pressure_viscosity < cold.pressure_viscosity.pressure_viscosity


# --- own oils --------------------------------------------------------------------------------------------


def test_constant_barus_oil():
    state = Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0).at(C100)
    assert state == LubricantState(C100, 0.1, 880.0, PressureViscosity(2e-8, 1.0, math.inf), True, 0.6e9)
    assert state.viscosity_at(1e9) == pytest.approx(0.1 * math.exp(20.0), rel=ROUND_OFF)


def test_astm_viscosity_hits_both_of_its_points():
    oil = Lubricant.barus(
        viscosity_40=100e-6, viscosity_100=11e-6, pressure_viscosity=2e-8, density=880.0, density_slope=0.0
    )
    assert oil.at(C40).viscosity == pytest.approx(100e-6 * 880.0, rel=1e-11)  # double exponential of round-off
    assert oil.at(C100).viscosity == pytest.approx(11e-6 * 880.0, rel=1e-11)


def test_kinematic_viscosity_takes_the_density_of_its_temperature():
    oil = Lubricant.barus(
        viscosity_40=100e-6, viscosity_100=11e-6, pressure_viscosity=2e-8, density=880.0, density_slope=-0.6
    )
    assert oil.at(C100).viscosity == pytest.approx(11e-6 * (880.0 - 0.6 * 85), rel=1e-11)


def test_coefficient_at_40_and_100_degc_is_log_linear():
    oil = Lubricant.barus(viscosity=0.1, pressure_viscosity_40=2.4e-8, pressure_viscosity_100=1.5e-8, density=880.0)
    alpha = [oil.at(273.15 + theta).pressure_viscosity.pressure_viscosity for theta in (40.0, 70.0, 100.0)]
    assert alpha == pytest.approx([2.4e-8, math.sqrt(2.4e-8 * 1.5e-8), 1.5e-8], rel=ROUND_OFF)


def test_roelands_z_left_out_follows_from_the_coefficient():
    alphas = {"pressure_viscosity_40": 2e-8, "pressure_viscosity_100": 2e-8}
    oil = Lubricant.roelands(viscosity_40=100e-6, viscosity_100=11e-6, density=880.0, **alphas)
    for temperature in (C40, C100):
        state = oil.at(temperature)
        law = state.pressure_viscosity
        assert law.pressure_viscosity == 2e-8
        assert law.exponent == pytest.approx(2e-8 * P0 / (math.log(state.viscosity) + 9.67), rel=ROUND_OFF)
        assert law.pressure_scale == P0


def test_roelands_coefficient_left_out_follows_from_z():
    law = Lubricant.roelands(viscosity=0.05, roelands_z=0.6, density=880.0).at(C40).pressure_viscosity
    assert law.pressure_viscosity == pytest.approx(0.6 * (math.log(0.05) + 9.67) / P0, rel=ROUND_OFF)
    assert law.exponent == 0.6


def test_roelands_with_both_given_keeps_both():
    oil = Lubricant.roelands(viscosity=0.04, roelands_z=0.67, pressure_viscosity=1.7e-8, density=870.0)
    assert oil.at(C40).pressure_viscosity == PressureViscosity(1.7e-8, 0.67, P0)


def test_own_oil_with_the_law_of_fva3():
    named = Lubricant.named("FVA3").at(C40).pressure_viscosity
    oil = Lubricant.fva3(viscosity=0.05, density=880.0, pressure_viscosity=named.pressure_viscosity)
    assert oil.at(C40).pressure_viscosity.log_ratio(1e9) == pytest.approx(named.log_ratio(1e9), rel=ROUND_OFF)
    given_alpha = Lubricant.fva3(viscosity=0.05, density=880.0, pressure_viscosity=2e-8).at(C40)
    assert given_alpha.pressure_viscosity.log_ratio_slope(0.0) == 2e-8
    b = 4.419e-3 + 3.0115e-4 * 40
    assert given_alpha.pressure_viscosity.log_ratio(1e30) == pytest.approx(1 / b, rel=1e-9)  # p >> p_c


def test_isoviscous_oils():
    for oil in (
        Lubricant.barus(viscosity=0.1, pressure_viscosity=0.0, density=880.0),
        Lubricant.roelands(viscosity=0.1, pressure_viscosity=0.0, density=880.0),
        Lubricant.fva3(viscosity=0.1, pressure_viscosity=0.0, density=880.0),
    ):
        assert oil.at(C40).viscosity_at(1e9) == 0.1


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        (
            {"viscosity": None},
            r"lubricant 'own oil', viscosity: got none; allowed: either viscosity, or viscosity_40",
        ),
        (
            {"viscosity_40": 1e-4},
            r"viscosity: got viscosity and viscosity_40; allowed: either viscosity",
        ),
        ({"viscosity": -0.1}, r"lubricant 'own oil', viscosity: got -0.1 Pa s; allowed: finite and > 0"),
        (
            {"pressure_viscosity_40": 2e-8},
            r"pressure_viscosity: got pressure_viscosity and pressure_viscosity_40",
        ),
        ({"density": 0.0}, r"lubricant 'own oil', density: got 0.0 kg/m3; allowed: finite and > 0"),
        ({"density_slope": math.nan}, r"density_slope: got nan kg/\(m3 K\); allowed: finite"),
        ({"density_law": "dh"}, r"density_law: got 'dh'; allowed: dowson-higginson, incompressible"),
        ({"fitted_pressure": 0.0}, r"fitted_pressure: got 0.0 Pa; allowed: > 0, inf if unknown"),
    ],
)
@pytest.mark.parametrize("make", [Lubricant.barus, Lubricant.roelands, Lubricant.fva3])
def test_impossible_oils_are_refused(make, changes, text):
    values = {"viscosity": 0.1, "pressure_viscosity": 2e-8, "density": 880.0}
    with pytest.raises(InputError, match=text):
        make(**(values | changes))


def test_missing_coefficients():
    with pytest.raises(InputError, match=r"pressure_viscosity: got none; viscosity_law barus needs it; give it in 1/"):
        Lubricant.barus(viscosity=0.1, density=880.0)
    with pytest.raises(InputError, match=r"roelands: got neither pressure_viscosity nor roelands_z; allowed: one of"):
        Lubricant.roelands(viscosity=0.1, density=880.0)
    with pytest.raises(InputError, match=r"roelands_z: got -0.6; allowed: finite and > 0"):
        Lubricant.roelands(viscosity=0.1, density=880.0, roelands_z=-0.6)
    with pytest.raises(InputError, match=r"pressure_viscosity_100: got None 1/Pa; allowed: finite and >= 0"):
        Roelands(0.6, 2e-8, None)
    with pytest.raises(InputError, match=r"pressure_viscosity_100: got 0.0 1/Pa; .*> 0 if it varies"):
        Barus(2e-8, 0.0)


def test_own_oils_by_name_and_by_word_are_alike():
    data = {"viscosity": 0.05, "pressure_viscosity": 2e-8, "density": 880.0, "density_slope": -0.6, "name": "mine"}
    assert Lubricant.barus(**data) == Lubricant.own("barus", {}, **data)
    assert Lubricant.fva3(**data) == Lubricant.own("fva3", {}, **data)
    assert Lubricant.roelands(**data) == Lubricant.own("roelands", {}, **data)
    assert Lubricant.roelands(roelands_z=0.6, **data) == Lubricant.own("roelands", {"exponent": 0.6}, **data)
    keywords = inspect.getfullargspec(Lubricant.own).kwonlyargs
    assert list(OilData.__annotations__) == keywords, "the table for type checkers is the signature of `own`"


def test_problems_of_viscosity_and_coefficient_come_together():
    with pytest.raises(InputError) as caught:
        Lubricant.fva3(density=880.0, pressure_viscosity_40=1e-8)
    assert len(caught.value.problems) == 2


def test_heat_of_a_contact_comes_from_oil_and_solids():
    steel = dataclasses.replace(STEEL, conductivity=30.0, heat_capacity=500.0, density=7700.0)
    oil = Lubricant.barus(
        viscosity=0.1, pressure_viscosity=2e-8, density=880.0, thermal_conductivity=0.14, heat_capacity=1900.0
    )
    assert heat_data(oil, steel) == HeatData(0.14, 1900.0, 30.0, 500.0, 7700.0)
    with pytest.raises(InputError, match=r"Spirax MA 80W', thermal_conductivity: got none; .* in \[lubricant\]"):
        heat_data(Lubricant.named("Spirax MA 80W"), steel)


def test_conductivity_is_checked():
    oil = Lubricant.named("FVA3")
    with pytest.raises(InputError, match=r"heat_capacity: got nan J/\(kg K\); allowed: finite and > 0"):
        dataclasses.replace(oil, heat_capacity=math.nan)
    with pytest.raises(InputError, match=r"thermal_conductivity: got 0.0 W/\(m K\); allowed: finite and > 0"):
        dataclasses.replace(oil, thermal_conductivity=0.0)


@pytest.mark.parametrize(
    ("viscosities", "text"),
    [
        ((0.2e-6, 0.1e-6), r"viscosity_40: got 2e-07 m2/s = 0.2 mm2/s; allowed: finite and > 0.3 mm2/s"),
        (
            (11e-6, 100e-6),
            r"viscosity_100: got 100 mm2/s; allowed: below viscosity_40 = 11 mm2/s; exchange them",
        ),
        ((math.nan, 1e-5), r"viscosity_40: got nan m2/s"),
    ],
)
def test_impossible_kinematic_viscosities_are_refused(viscosities, text):
    with pytest.raises(InputError, match=text):
        AstmViscosity(*viscosities)


# --- where the laws break down ---------------------------------------------------------------------------


@pytest.mark.parametrize("temperature", [0.0, -5.0, math.nan, math.inf])
def test_impossible_temperatures(temperature):
    with pytest.raises(InputError, match=r"lubricant 'FVA3', temperature: got .* K; allowed: finite and > 0 K"):
        Lubricant.named("FVA3").at(temperature)


def test_vogel_breaks_down_in_the_cold():
    with pytest.raises(InputError, match=r"got -110 degC; Vogel's law breaks down at -101.552 degC; .* > -91.3347"):
        VogelViscosity(0.062e-3, 1021.7, 101.5517).at(163.15, 900.0)
    with pytest.raises(InputError, match=r"lubricant 'FVA3', temperature: got -100 degC; Vogel's law"):
        Lubricant.named("FVA3").at(173.15)


def test_fva3_pressure_law_breaks_down_in_the_cold():
    text = r"lubricant 'FVA3', temperature: got -20 degC; .* at a finite pressure; .* -14.67 degC and above"
    with pytest.raises(InputError, match=text):
        Lubricant.named("FVA3").at(253.15)
    with pytest.raises(InputError, match=r"a1 \+ a2 theta = -.* Pa"):
        Lubricant.fva3(viscosity=0.1, density=880.0, pressure_viscosity=2e-8).at(153.15)
    assert Lubricant.named("FVA3").at(258.5).viscosity_at(1e9) > 0  # -14.65 degC


def test_fva3_law_without_its_second_term_is_barus():
    law = Fva3(b1=0.0, b2=0.0).at(C40, 0.1)
    assert (law.exponent, law.pressure_scale) == (1.0, math.inf)


def test_astm_overflows_in_the_cold():
    oil = Lubricant.barus(viscosity_40=100e-6, viscosity_100=11e-6, pressure_viscosity=2e-8, density=880.0)
    with pytest.raises(InputError, match=r"got -223.15 degC, where the viscosity of ASTM D341 overflows; .* raise it"):
        oil.at(50.0)


def test_roelands_needs_a_viscosity_above_its_pole():
    oil = Lubricant.roelands(viscosity=6e-5, pressure_viscosity=1e-8, density=880.0)
    with pytest.raises(InputError, match=r"viscosity: got 6e-05 Pa s at 40 degC; allowed: above 6.31e-05 Pa s .*barus"):
        oil.at(C40)


def test_density_must_stay_positive():
    oil = Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0, density_slope=-20.0)
    with pytest.raises(InputError, match=r"got 100 degC, where its density is -820 kg/m3; .* check density_slope"):
        oil.at(C100)


# --- state, values, records ------------------------------------------------------------------------------


def test_density_over_pressure():
    state = Lubricant.named("FVA3").at(C40)
    assert state.density_ratio(0.0) == 1.0
    assert state.density_ratio(0.59e9) == pytest.approx(0.5 * (1 + 1.34), rel=ROUND_OFF)
    step = 1e5
    difference = (state.density_ratio(5e8 + step) - state.density_ratio(5e8 - step)) / (2 * step)
    assert state.density_ratio_slope(5e8) == pytest.approx(difference, rel=1e-6)  # round-off of the difference


def test_incompressible_density():
    oil = dataclasses.replace(Lubricant.named("FVA3"), density_law="incompressible")
    pressures = np.array([0.0, 1e9])
    np.testing.assert_array_equal(oil.at(C40).density_ratio(pressures), [1.0, 1.0])
    np.testing.assert_array_equal(oil.at(C40).density_ratio_slope(pressures), [0.0, 0.0])
    assert oil.at(C40).density_ratio(1e9) == 1.0


@given(p=st.floats(0.0, 4e9))
def test_arrays_and_floats_agree(p):
    state = Lubricant.named("FVA3").at(C40)
    for function in (
        state.viscosity_at,
        state.density_ratio,
        state.density_ratio_slope,
        state.pressure_viscosity.log_ratio,
        state.pressure_viscosity.log_ratio_slope,
    ):
        assert type(function(p)) is float
        assert function(np.array([p]))[0] == pytest.approx(function(p), rel=1e-14)


def test_overflowing_viscosity_is_inf_without_a_warning():
    state = Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0).at(C40)
    assert state.viscosity_at(1e11) == math.inf


@pytest.mark.parametrize("name", LUBRICANTS)
def test_oils_are_values(name):
    oil = Lubricant.named(name)
    copy = pickle.loads(pickle.dumps(oil))
    assert copy == oil
    assert hash(copy) == hash(oil)
    assert copy.at(C40) == oil.at(C40)
    assert oil != dataclasses.replace(oil, density_15=900.0)


def test_records():
    record = Lubricant.named("FVA3").record()
    assert record["name"] == "FVA3"
    assert record["verified"] is True
    assert record["viscosity_law"] == "fva3"
    assert record["viscosity_over_temperature"] == "vogel"
    assert record["vogel_factor"] == 0.062e-3
    assert record["a1"] == pytest.approx(327.7918e5)
    assert record["density_15"] == 887.6
    own = Lubricant.roelands(viscosity=0.05, roelands_z=0.6, density=880.0).record()
    assert own["viscosity_law"] == "roelands"
    assert own["viscosity_over_temperature"] == "constant"
    assert own["viscosity"] == 0.05
    assert own["roelands_z"] == 0.6
    assert "pressure_viscosity_40" not in own
    assert all(type(value) in (float, str, bool) for value in own.values())


def test_records_differ_where_oils_do():
    makers = (Lubricant.barus, Lubricant.roelands, Lubricant.fva3)
    records = [make(viscosity=0.1, pressure_viscosity=2e-8, density=880.0).record() for make in makers]
    assert len({tuple(sorted((key, str(value)) for key, value in record.items())) for record in records}) == 3


def test_constant_viscosity_is_checked():
    with pytest.raises(InputError, match=r"viscosity: got inf Pa s; allowed: finite and > 0"):
        ConstantViscosity(math.inf)
