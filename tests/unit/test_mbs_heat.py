"""Heat of bearings: balances beside closed forms, run-away, and scenes whose bearings are warm."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.special import lambertw

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.maps.emap import open_map
from ehdmaps.physics.solids import STEEL, Material
from mbs import (
    CampbellSettings,
    HammerSettings,
    LawChoice,
    SweepRange,
    SweepSettings,
    assemble,
    campbell,
    hammer,
    lsa,
    modes,
    parse_scene,
    plan,
    runup,
    statics,
    sweep,
    variants,
)
from mbs.analyses.operating import held, operating
from mbs.bearings.contact_report import load_torque, viscous_torque
from mbs.bearings.thermal import HeatPaths, Mounting, Seat, heat_of_contacts, steady_temperatures
from mbs.model.profiles import SpeedProfile
from mbs.settings import RunUp, Settings
from tests.cases.commands import check_units, run

AROUND = 313.15
FULL = HeatPaths(
    shaft=1.5,
    housing=4.0,
    shaft_temperature=320.0,
    housing_temperature=300.0,
    oil_flow=3.0,
    oil_inlet=310.0,
    raceways_to_oil=5.0,
    between_raceways=0.7,
)


def network(paths):
    """Three equations for inner and outer raceway and oil, written down one by one: matrix and right-hand side."""
    s, h, f, b, w = paths.shaft, paths.housing, paths.raceways_to_oil, paths.between_raceways, paths.oil_flow
    matrix = np.array([[s + f + b, -b, -f], [-b, h + f + b, -f], [-f, -f, w + 2.0 * f]])
    return matrix, np.array([s * paths.shaft_temperature, h * paths.housing_temperature, w * paths.oil_inlet])


def test_friction_that_falls_linearly_has_the_balance_of_three_equations():
    """Residuals of 1e-10 of the friction, over some W/K."""
    power, slope = np.array([30.0, 20.0]), np.array([0.4, 0.3])
    found = steady_temperatures(["b"], [FULL], lambda t: power - slope * (t - 300.0))[0]
    matrix, right = network(FULL)
    matrix[:2, :2] += np.diag(slope)
    right[:2] += power + slope * 300.0
    expected = np.linalg.solve(matrix, right)
    np.testing.assert_allclose([*found, FULL.oil_temperature(found)], expected, rtol=0.0, atol=1e-8)
    friction = float((power - slope * (found - 300.0)).sum())
    assert sum(FULL.flows(found)) == pytest.approx(friction, rel=1e-9)


@pytest.mark.parametrize("strength", [0.1, 10.0, 1e4])
def test_friction_that_falls_exponentially(strength):
    """x = strength exp(-x) in units of its decay, whose solution is Lambert's function; however steep it is."""
    paths = HeatPaths(shaft=2.0, housing=2.0).within(AROUND)
    decay = 12.0
    found = steady_temperatures(["b"], [paths], lambda t: 2.0 * decay * strength * np.exp(-(t - AROUND) / decay))
    np.testing.assert_allclose(found - AROUND, decay * lambertw(strength).real, rtol=1e-8)


def test_a_bearing_warms_up_to_its_first_balance_or_runs_away():
    """x = strength exp(x) has two solutions up to 1/e, the colder of which is stable, and none above."""
    paths = HeatPaths(shaft=2.0, housing=2.0).within(AROUND)

    def grows(strength):
        return lambda t: 2.0 * 15.0 * strength * np.exp((t - AROUND) / 15.0)

    found = steady_temperatures(["b"], [paths], grows(0.3))
    np.testing.assert_allclose(found - AROUND, -15.0 * lambertw(-0.3).real, rtol=1e-8)
    with pytest.raises(AnalysisError, match=r"bearing 'hot': thermal run-away: no heat balance below 200 degC"):
        steady_temperatures(
            ["cold", "hot"], [paths, paths], lambda t: np.array([1.0, 1.0]) * [[0.0], [1.0]] * grows(0.4)(t)
        )
    with pytest.raises(
        AnalysisError, match=r"bearing 'b': too hot: no heat balance below 200 degC, where its friction"
    ):
        steady_temperatures(["b"], [paths], lambda t: np.full((1, 2), 400.0))
    jumps = iter(range(1000))
    with pytest.raises(AnalysisError, match="bearing 'b': its heat balance does not settle"):
        steady_temperatures(["b"], [paths], lambda t: np.full((1, 2), 1.0 + next(jumps) % 2))


def test_heat_of_contacts_goes_to_both_raceways():
    np.testing.assert_allclose(heat_of_contacts(6.0, 2.0, 4.0), [3.0 + 2.0 + 2.0, 1.0 + 2.0 + 2.0])


def test_torques_of_palmgren():
    """M_0 = 1e-7 f0 (nu n)^(2/3) d_m^3 by hand: 1e-7 * 2 * 27000 * 1e6 / 1 at nu n = 27000^1.5, d_m = 100 mm."""
    speed = 27000.0**1.5 / 100.0 * math.pi / 30.0
    assert viscous_torque(2.0, 100e-6, speed, 0.1) == pytest.approx(5.4, rel=1e-12)
    assert viscous_torque(1.0, 1e-6, 1.0, 0.1) == pytest.approx(160e-7 * 1e6 * 1e-3, rel=0.01)  # its rounded 160e-7
    assert load_torque(3e-4, -1000.0, 66e-3) == pytest.approx(0.0198)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "got a raceway from which no heat can flow"),
        ({"shaft": 1.0}, "got a raceway from which no heat can flow"),
        ({"oil_flow": 1.0}, "oil_flow, raceways_to_oil: got 1 and 0 W/K; allowed: both or neither"),
        ({"shaft": -1.0}, "shaft: got -1.0; allowed: a finite number >= 0"),
        ({"shaft": math.nan, "palmgren": -1.0}, "palmgren: got -1.0"),
    ],
)
def test_heat_without_a_way_out_is_refused(values, words):
    with pytest.raises(InputError, match=words):
        HeatPaths(**values)


PLAIN = """
schema = 1
operation = { speed = "1000 rpm", temperature = "40 degC" }
lubricant = { name = "FVA3" }
loads = [{ name = "pull", on = "shaft", force = ["0 N", "0 N", "-600 N"] }]
inputs = [{ name = "E", on = "shaft", direction = "z" }]
sensors = [{ name = "S", on = "shaft", direction = "z", quantity = "acceleration" }]
[linear]
frequencies = ["100 Hz", "200 Hz"]
[[bodies]]
name = "shaft"
freedoms = ["y", "z"]
spin = 1
cylinders = [{ from = "-100 mm", to = "100 mm", diameter = "40 mm" }]
[[bearings]]
name = "left"
inner = "shaft"
outer = "ground"
slices = 5
geometry = { name = "NU308", diametral_clearance = "40 um" }
"""
ADDED = 'thermal = { shaft = "1 W/K", housing = "3 W/K", load_friction = 3e-4, constant_power = "4 W" }\n'
BALANCE = ADDED.replace("load_friction", "palmgren = 2.0, load_friction")
GIVEN = 'thermal = { inner_ring = "70 degC", outer_ring = "60 degC" }\n'
FIT = 'fit = { inner = { interference = "12 um", seat = "40 mm" } }\n'


def scene(more="", **changes):
    text = PLAIN + more
    for old, new in changes.items():
        text = text.replace(old, new)
    return parse_scene(text, "scene", "scene.toml")


def test_a_scene_without_keys_is_left_alone():
    model = assemble(scene(), "hertz")
    assert operating(model, 100.0) is model and held(model) is model
    dataset = statics(model).dataset
    assert float(dataset["inner_raceway_temperature"][0]) == AROUND
    assert float(dataset["operating_clearance"][0]) == 40e-6
    assert "friction_power" not in dataset and "stated_clearance" not in dataset


def test_given_temperatures_and_fits_change_clearance_and_law():
    """As the same bearing with this clearance at the mean temperature: the same numbers, bit for bit."""
    warm = statics(assemble(scene(GIVEN + FIT), "hertz"))
    (state,) = warm.model.states
    expected = 40e-6 - 11.7e-6 * 10.0 * 66e-3 - 12e-6 * 40.0 / 52.0
    assert state.clearance.operating == pytest.approx(expected, rel=1e-12)
    assert (warm.model.bearings[0].temperature, state.heat) == (338.15, None)
    base = scene()
    (entry,) = base.bearings
    geometry = dataclasses.replace(entry.geometry, diametral_clearance=state.clearance.operating)
    plain = dataclasses.replace(base.with_bearings([dataclasses.replace(entry, geometry=geometry)]), temperature=338.15)
    same = statics(assemble(plain, "hertz")).dataset
    for name in ("displacement", "bearing_stiffness", "hertz_pressure"):
        np.testing.assert_array_equal(warm.dataset[name], same[name])


def test_the_balance_of_a_scene_closes():
    """Friction by hand at the temperatures that were found: 1e-9 of it. The two raceways have the same friction."""
    found = statics(assemble(scene(BALANCE), "hertz"))
    (state,) = found.model.states
    oil = found.model.scene.lubricant.at(state.film_temperature)
    omega = 1000.0 * math.pi / 30.0
    rolling = viscous_torque(2.0, oil.viscosity / oil.density, omega, 66e-3) * omega
    added = 3e-4 * 600.0 * 66e-3 * omega + 4.0
    assert (state.heat.rolling, state.heat.added) == pytest.approx((rolling, added), rel=1e-9)
    assert state.heat.to_shaft == pytest.approx(0.5 * (rolling + added), rel=1e-9)
    assert state.inner - AROUND == pytest.approx(0.5 * (rolling + added) / 1.0, rel=1e-9)
    assert state.outer - AROUND == pytest.approx(0.5 * (rolling + added) / 3.0, rel=1e-9)
    assert abs(state.heat.left) <= 1e-9 * state.heat.friction
    assert state.clearance.operating == pytest.approx(40e-6 - 11.7e-6 * 66e-3 * (state.inner - state.outer), rel=1e-9)
    data = found.dataset.isel(bearing=0)
    assert float(data["friction_power"]) == pytest.approx(rolling + added, rel=1e-9)
    assert math.isnan(float(data["oil_temperature"]))


def test_every_analysis_has_the_same_bearing():
    """Statics, modes, responses, a hammer and a sweep at its speed; a run keeps that of the operating speed."""
    model = assemble(scene(BALANCE), "hertz")
    clearance = operating(model, model.scene.speed).states[0].clearance.operating
    assert clearance < 39e-6
    expected = statics(model).balance.displacement
    for found in (modes(model), lsa(model)):
        np.testing.assert_allclose(found.balance.displacement, expected, rtol=1e-9)
    assert (
        hammer(model, HammerSettings(highest=500.0, hits=1, duration=0.05)).model.states[0].clearance.operating
        == clearance
    )
    speeds = SweepRange(0.0, model.scene.speed, 3)
    swept = sweep(model, SweepSettings(speeds)).dataset.isel(case=0, bearing=0)
    np.testing.assert_allclose(swept["operating_clearance"][[0, -1]], [40e-6, clearance], rtol=1e-9)
    assert np.all(np.diff(swept["inner_raceway_temperature"]) > 1.0)
    assert float(swept["friction_power"][0]) == 0.0  # at rest
    course = RunUp(SpeedProfile.ramp(0.0, 10.0, 1e-3), 1e-3, Settings(1e-4, 1e-4))
    ran = runup(model, course)
    assert float(ran.dataset["operating_clearance"][0]) == clearance
    assert float(ran.dataset["outer_raceway_temperature"][0]) == operating(model, model.scene.speed).states[0].outer


def test_rollers_as_bodies_and_the_rolling_of_films(reynolds_map):
    """The films of a map are held outside its one temperature: constant heat, whose balance is a division."""
    with pytest.raises(InputError, match="the law 'dry Hertz, ISO 16281' knows no rolling force at 40 degC"):
        statics(assemble(scene(ADDED), "hertz"))
    emap = open_map(reynolds_map)
    for rollers in ("", 'rollers = "bodies"\n'):
        found = statics(assemble(scene(ADDED + rollers), emap=emap))
        (state,) = found.model.states
        assert state.heat.rolling == pytest.approx(found.losses[0].total, rel=1e-9) and state.heat.rolling > 10.0
        inner, outer = found.losses[0].power.sum(axis=1)
        into = heat_of_contacts(inner, outer, state.heat.added)
        np.testing.assert_allclose([state.inner - AROUND, (state.outer - AROUND) * 3.0], into, rtol=1e-8)
        assert abs(state.heat.left) <= 1e-9 * state.heat.friction
        assert found.balance.outside["left"]


def test_a_bearing_that_loses_its_clearance_runs_away(reynolds_map):
    """Heat leaves over the outer ring alone: each watt takes 0.4 um of a tight bearing's clearance."""
    text = 'thermal = { shaft = "0 W/K", housing = "20 W/K", between_raceways = "0.5 W/K" }\n'
    model = assemble(scene(text, **{"40 um": "-60 um", "1000 rpm": "10000 rpm"}), emap=open_map(reynolds_map))
    with pytest.raises(AnalysisError, match=r"heat of the bearings at 10000 rpm: bearing 'left': thermal run-away"):
        statics(model)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (
            "thermal = {}\n",
            r"thermal: got nothing; allowed: inner_ring and outer_ring, or paths of heat: shaft, housing",
        ),
        ('thermal = { inner_ring = "60 degC", shaft = "1 W/K" }\n', "thermal: got inner_ring and shaft; allowed: temp"),
        ('thermal = { inner_ring = "60" }\n', "inner_ring: got '60' without a unit"),
        ('thermal = { shaft = "1 W/K", housing_temperature = "1 degC" }\n', "got housing_temperature without housing"),
        ('thermal = { shaft = "1 W/K" }\n', "thermal: got a raceway from which no heat can flow"),
        (
            'thermal = { shaft = "1 W", housing = "1 W/K", palmgren = "2" }\n',
            "palmgren: got '2'; allowed: a bare number",
        ),
        ('thermal = { inner_rings = "60 degC" }\n', r"inner_rings: unknown key \(did you mean 'inner_ring'\?\)"),
        ("fit = {}\n", "fit: got nothing; allowed: inner = { interference, seat }"),
        ('fit = { outer = { interference = "1 um", seat = "90 mm" } }\n', "fit outer diameter: missing"),
        (
            'fit = { inner = { interference = "2 mm", seat = "40 mm" } }\n',
            "interference: got '2 mm'; allowed: -1000 um",
        ),
        ('expansion = "12e-6 1/K"\n', "expansion: has no effect; allowed: with thermal or fit"),
    ],
)
def test_what_is_wrong_about_the_keys_is_said(more, words):
    with pytest.raises(InputError, match=words):
        scene(more)


def test_the_block_of_the_reference_page_is_read():
    page = (Path(__file__).parents[2] / "docs" / "reference_mbs.md").read_text()
    block = page.partition("### Warm bearings and their fits")[2].partition("```toml")[2].partition("```")[0]
    (bearing,) = parse_scene(PLAIN[: PLAIN.index("[[bearings]]")] + block, "page", "page").bearings
    assert bearing.thermal == HeatPaths(
        shaft=0.5,
        shaft_temperature=318.15,
        housing=2.0,
        oil_flow=6.0,
        oil_inlet=313.15,
        raceways_to_oil=4.0,
        between_raceways=0.3,
        constant_power=3.0,
    )
    aluminium = Material(70e9, STEEL.poisson_ratio)
    assert bearing.mounting == Mounting(Seat(8e-6, 40e-3, 10e-3), Seat(-5e-6, 90e-3, 130e-3, aluminium, 23.8e-6))


def test_seats_that_do_not_fit_are_refused_with_the_bearing():
    text = FIT.replace("40 mm", "55 mm") + 'expansion = "12e-6 1/K"\n'
    assert scene(text).bearings[0].mounting.expansion == 12e-6
    with pytest.raises(InputError, match="'left', fit of the inner ring: got a bore of 0 mm and a seat of 55 mm"):
        assemble(scene(text), "hertz")


def test_a_plan_takes_fits_and_refuses_heat():
    lost = 12.0 * 40.0 / 52.0
    fitted, same = plan(scene(FIT)).needed[0], plan(scene(**{"40 um": f"{40.0 - lost!r} um"})).needed[0]
    assert fitted.static_load == pytest.approx(same.static_load, rel=1e-9)
    assert fitted.static_load < 0.97 * plan(scene()).needed[0].static_load  # more rollers carry
    with pytest.raises(InputError, match="got thermal in left; allowed: one temperature for all"):
        plan(scene(BALANCE))


def test_comparisons_say_what_is_missing_before_anything_runs():
    course = RunUp(SpeedProfile.ramp(10.0, 100.0, 0.5), 0.5, Settings(1e-4, 1e-4))
    given = dataclasses.replace(scene(ADDED), run_up=course)
    laws = LawChoice("dry", "hertz"), LawChoice("damped", "hertz:1e-5 s")
    look = CampbellSettings(highest=1000.0)
    with pytest.raises(InputError, match="knows no rolling force"):
        variants(given, laws, [], settings=look)
    with pytest.raises(InputError, match="knows no rolling force"):
        campbell(assemble(given, "hertz"), look)


@pytest.mark.slow
def test_commands_say_temperatures_clearance_and_where_heat_goes(tmp_path, capsys):
    file, result = tmp_path / "scene.toml", tmp_path / "a.nc"
    file.write_text(
        PLAIN + BALANCE + FIT + '[runup]\nfrom = "0 rpm"\nto = "9 rpm"\nduration = "1 ms"\nstep = "0.1 ms"\n'
    )
    file.write_text(file.read_text().replace("[[bearings]]", "[[bearings]]", 1))
    status, out, err = run(capsys, "statics", str(file), "-o", str(result), "--plot", str(tmp_path / "a.png"))
    assert (status, err) == (0, "")
    assert re.search(
        r"left: raceways [\d.]+ inner, [\d.]+ degC outer; operating clearance [\d.]+ um \(40 um stated,", out
    )
    assert re.search(
        r"friction [\d.]+ W \([\d.]+ W of it added\); [\d.]+ W to the shaft, [\d.]+ W to the housing; ", out
    )
    with xr.open_dataset(result) as data:
        check_units(data)
    status, out, err = run(capsys, "sweep", str(file), "--speed", "100 rpm", "200 rpm", "2")
    assert "1000 rpm" not in out and "  at 200 rpm:\n    left: raceways" in out
    status, out, err = run(capsys, "runup", str(file))
    assert "temperatures and clearances are held at those of 1000 rpm, of [operation]" in out


@pytest.mark.slow
def test_rings_of_one_bearing(capsys):
    asked = (
        "bearing",
        "NU308",
        "--load",
        "1 kN",
        "--speed",
        "500 rpm",
        "--clearance",
        "20 um",
        "--ring-temperatures",
        "60 degC",
        "50 degC",
    )
    status, out, err = run(capsys, *asked)
    assert (status, err) == (0, "")
    assert (
        "55 degC, raceways 60 inner, 50 degC outer; operating clearance 12.28 um (20 um stated, temperature -7.72"
        in out
    )
    status, out, err = run(capsys, *asked, "--temperature", "40 degC")
    assert status == 2 and "with --ring-temperatures; allowed: one of the two" in err
