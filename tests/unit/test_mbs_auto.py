"""Physics of films that matters to a scene: sizes in closed form, verdicts, `--auto`, and what is refused."""

from __future__ import annotations

import argparse
import dataclasses
import re
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.maps.film_field import load_at
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.heat import inlet_heat
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.surface import Surface
from mbs import AutoSettings, automatic, parse_scene, statics
from mbs.commands.auto import read_tolerance
from mbs.planning.criteria import (
    STRESS_FELT,
    closed_contact,
    heat_effect,
    memory_effect,
    roughness_effect,
    stress_felt,
    supply_effect,
)
from mbs.planning.physics import MOST_TOLERANCE, switched, up_to, verdicts
from mbs.planning.plan import plan
from mbs.planning.question import at_one_speed, in_time, over_speeds
from mbs.settings import SweepRange
from tests.benchmarks.bench_auto_criteria import THERMAL
from tests.cases.commands import run
from tests.cases.reports import without_budget
from tests.unit.test_tapered_scenes import O_PAIR, text

TEXT = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
SHORT = TEXT.replace("slices = 41", "slices = 3").replace("points = 2000", "points = 5").split("[runup]")[0]
OIL = Lubricant.named("FVA3")


def scene(text=SHORT):
    return parse_scene(text, "short", "short.toml")


def turning(rpm, celsius=40.0):
    """The scene at another speed and temperature."""
    text = SHORT.replace("500 rpm", f"{rpm} rpm").replace("40 degC", f"{celsius} degC")
    return at_one_speed(scene(text))


def judged(given, **settings):
    """Verdicts by what they are on."""
    return {verdict.physics: verdict for verdict in verdicts(given, AutoSettings(**settings))}


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "short.toml"
    path.write_text(SHORT)
    return str(path)


# commands


def test_auto_chooses_films_and_says_what_matters(file, capsys):
    status, out, _ = run(capsys, "modes", file, "--auto")
    assert status == 0 and "films with memory" in out
    assert out.startswith("auto: film memory: on, films of slow motion are wrong by ")
    assert not list(Path().glob("*.nc"))
    # 6000 rpm at 110 degC: the rule of the inlet holds
    Path(file).write_text(SHORT.replace("500 rpm", "6000 rpm").replace("40 degC", "110 degC"))
    status, out, _ = run(capsys, "statics", file, "--auto")
    assert status == 0 and "films from the film table, inlet heat" in out
    assert re.search(r"auto: inlet heat: on, it changes k or c of a contact by up to [0-9.]+ % at 9.901 m/s\n", out)
    _, plain, _ = run(capsys, "statics", file)
    assert plain == out[out.index("NU308: rigid") :]
    _, cold, _ = run(capsys, "statics", file, "--physics", "isothermal")
    assert cold.startswith("note: inlet heat: off, it changes k or c") and "; --physics inlet-heat has it\n" in cold
    assert "films from the film table, isothermal, flooded" in cold
    _, out, _ = run(capsys, "check", file)
    assert "  inlet heat: on, it changes" in out and "  film memory: on, films of slow motion" in out
    assert not run(capsys, "statics", file, "--law", "hertz")[1].startswith("note: ")


def test_options_that_do_not_go_together_are_refused(file, capsys):
    status, _, err = run(
        capsys, "modes", file, "--auto", "--map", "a.nc", "--clearance", "1 um", "--clearance", "2 um",
        "--auto-tolerance", "5", "--highest", "far", "--law", "hertz", "--films", "thick", "--supply", "much",
        "--physics", "therma",
    )  # fmt: skip
    assert status == 2
    for words in (
        "--map: stands beside --auto",
        "--clearance: got 2 of them",
        "--auto-tolerance: got '5'; allowed: above 0 up to 900 % or 20 dB",
        "--highest: got 'far'",
        "--law: got 'hertz' beside --auto; allowed: table",
        "--films: got 'thick'",
        "--supply: ",
        "--physics: got 'therma'",
    ):
        assert words in err
    status, _, err = run(capsys, "statics", file, "--auto-tolerance", "5 %")
    assert status == 2 and "--auto-tolerance: stands without --auto; allowed: with it" in err
    status, _, err = run(capsys, "statics", file, "--physics", "inlet-heat", "--law", "formula")
    assert status == 2 and "--physics: got inlet-heat without a map; allowed: with --map MAP.nc, " in err


@pytest.mark.parametrize("tolerance", [0.0, 9.5, float("nan")])
def test_tolerances_out_of_range_are_refused(tolerance):
    with pytest.raises(InputError, match="allowed: above 0 up to 9"):
        AutoSettings(tolerance=tolerance)


def test_a_decibel_is_twelve_per_cent():
    def read(text=None, level=None):
        return read_tolerance(argparse.Namespace(auto_tolerance=text, tolerance=level), [])

    assert read("1 dB") == pytest.approx(0.1220, abs=5e-5)
    assert read("2 %", "1 dB") == 0.02
    assert read(level="1 dB") == read("1 dB")
    assert read("20 dB") == MOST_TOLERANCE
    assert read() is None


def test_the_report_of_a_run_has_what_critical_found(file, capsys, tmp_path, monkeypatch):
    """Speeds and bands are not found again, and the report says by which speeds."""
    without_budget(monkeypatch)

    def again(*_):
        raise AssertionError("critical speeds were found again")

    monkeypatch.setattr("mbs.report.examination.critical", again)
    text = Path(file).read_text() + '[sweep]\nfrom = "500 rpm"\nto = "1500 rpm"\npoints = 3\n'
    (tmp_path / "swept.toml").write_text(text)
    status, out, _ = run(capsys, "run", "swept.toml", "--law", "hertz", "-o", "out")
    assert (status, "=== mbs critical" in out) == (0, True)
    assert "--speed &#x27;500 rpm&#x27; &#x27;1500 rpm&#x27; 3" in (tmp_path / "out" / "report.html").read_text()


def test_run_does_what_the_scene_has_tables_for(file, capsys, tmp_path, monkeypatch):
    without_budget(monkeypatch)
    status, out, err = run(capsys, "run", file, "--auto", "-o", "out")
    assert status == 0
    assert out.startswith("NU308: rigid shaft on two bearings: statics, modes, lsa, report\n")
    # said before, and how far it is
    assert re.match(r"mbs run \S+: statics \S+ s, modes .* report .*; about .* in all; into out\n", err)
    assert re.findall(r"mbs run: (\w+) done, (\d) of 4", err)[-1] == ("report", "4")
    # what is the same is told once: at the operating speed, and over the speeds of the report
    assert out.count("inlet heat: on") == 2
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {f"{name}.{end}" for name in ("statics", "modes", "lsa") for end in ("nc", "png", "txt")} | {
        "report.html",
        "report.txt",
    }
    (tmp_path / "out" / "modes.txt").write_text("mine")
    assert run(capsys, "run", file, "-o", "out")[0] == 2
    assert (tmp_path / "out" / "modes.txt").read_text() == "mine"


def test_numerical_settings_are_chosen_for_the_films(file, capsys, monkeypatch):
    Path(file).write_text(TEXT.replace("slices = 41", "slices = 3"))
    chosen = []

    def within(subject, tolerance, made, settings, tell):
        chosen.append((subject.law.name, subject.law.films, tolerance))
        raise AnalysisError("enough")

    monkeypatch.setattr("mbs.planning.tolerance.within", within)
    slow = ("campbell", file, "--auto", "--auto-tolerance", "900 %", "--tolerance", "1 dB")
    assert run(capsys, *slow)[0] == 1
    assert chosen == [("map", "slow", 1.0)]


# sizes


def contact(load, speed=1.0, temperature=313.15):
    inner = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
    return closed_contact(inner, OIL, np.atleast_1d(np.asarray(load, dtype=float)), speed, temperature)


def test_a_light_contact_has_the_film_compliance_of_rigid_surfaces():
    state = contact([1.0, 10.0])
    # h goes with 1/w, so that -dh/dw is h/w; Moes' formula is there within its blend of regimes
    np.testing.assert_allclose(state.film_compliance, state.film / state.load, rtol=0.05)
    np.testing.assert_allclose(state.stiffness, state.load / state.film, rtol=0.15)


def test_memory_grows_with_frequency_and_fades_without_it():
    state = contact([500.0, 5e3, 5e4])
    sizes = np.array([memory_effect(state, frequency) for frequency in (1.0, 100.0, 1e3, 1e4)])
    assert np.all(np.diff(sizes, axis=0) > 0.0)
    assert np.all(sizes[0] < 1e-3)
    # to first order the error goes with the square of the frequency
    np.testing.assert_allclose(memory_effect(state, 2.0) / sizes[0], 4.0, rtol=1e-2)


def test_a_layer_that_floods_changes_nothing_and_a_thin_one_much():
    state = contact([500.0, 5e3, 5e4])
    assert np.all(supply_effect(state, np.inf) < 1e-9)  # the ratios are polynomials, to 1e-11
    assert np.all(supply_effect(state, 20.0 * state.film.max()) < 1e-6)
    assert np.all(supply_effect(state, 0.3 * state.film.min()) > 0.1)


def test_roughness_that_does_not_touch_still_has_a_size():
    """Load sharing goes to nothing for thick films, and to more than a tolerance where asperities touch."""
    state = contact([1e4, 1e5])
    sizes = [max(float(part.max()) for part in roughness_effect(state, Surface(rq), OIL)) for rq in (2e-8, 1e-7, 5e-7)]
    assert sizes[0] < sizes[1] < sizes[2]
    assert sizes[0] < 0.01 < 0.05 < sizes[2]


def test_heat_has_the_size_of_films_with_temperatures():
    """Beside c of films with temperatures in them, by a prototype: within what the rule may be wrong by."""
    for load, speed, celsius, ratio in THERMAL:
        state = contact([1e3 * load], float(speed), celsius + 273.15)
        wrong = inlet_heat(state.contact, OIL, OperatingPoint(1e3 * load, float(speed), celsius + 273.15)).loss_error
        assert float(heat_effect(state, OIL)[1][0]) == pytest.approx(abs(1.0 - ratio), abs=wrong + 0.01)
    unknown = dataclasses.replace(OIL, thermal_conductivity=None)
    assert np.isnan(heat_effect(contact([5e4]), unknown)).all()


@pytest.mark.slow
@pytest.mark.parametrize(("speed", "celsius", "felt"), [(1.0, 60.0, False), (4.0, 40.0, True)])
def test_a_limiting_stress_is_felt_in_deep_damping_valleys_alone(speed, celsius, felt):
    """Solutions with a limiting stress and without, over the valley of NU308 and far into its loaded side."""
    inner, kelvin = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0], celsius + 273.15
    zetas = np.array([-1.5, -0.7, 0.0, 0.7, 1.5])
    loads = np.array([load_at(inner, OIL, zeta, speed, kelvin) for zeta in zetas])
    newton, limiting = (
        ReynoldsSolver(shear=shear).solve_line(inner, OIL, tuple(loads.tolist()), speed, kelvin)
        for shear in ("newtonian", "limiting")
    )
    assert all(film.status.usable for film in (*newton, *limiting))
    solids = np.asarray(inner.structural_compliance(loads))
    k, c = [], []
    for films in (newton, limiting):
        k.append(1.0 / (solids + [film.film_compliance for film in films]))
        c.append(k[-1] ** 2 * [film.loss_compliance for film in films])
    stiffness, damping = (np.abs(other / plain - 1.0) for plain, other in (k, c))
    state = contact(loads, speed, kelvin)
    np.testing.assert_array_equal(stress_felt(state), felt & (np.abs(zetas) < STRESS_FELT))
    outside = ~stress_felt(state)
    assert np.all(stiffness < 0.03)
    assert np.all(damping[outside] < 0.05)
    assert not felt or damping[2] > 0.5


# verdicts


def test_heat_is_on_where_its_rule_holds_and_told_where_it_does_not():
    slow, hot, cold = turning(100), turning(6000, 110.0), turning(3000)
    assert not judged(slow)["inlet heat"].matters
    found = judged(hot)["inlet heat"]
    assert found.on and found.matters and found.size > 0.05
    beyond = judged(cold)["inlet heat"]
    assert beyond.matters and beyond.on
    assert "; its rule fails where M = " in beyond.words and beyond.words.endswith('with physics = "thermal" has it')
    off = judged(hot, physics="isothermal")["inlet heat"]
    assert not off.on and off.words.endswith("; --physics inlet-heat has it")
    unknown = dataclasses.replace(hot, lubricant=dataclasses.replace(OIL, thermal_conductivity=None))
    assert "no thermal conductivity" in judged(unknown)["inlet heat"].words


def test_a_limiting_stress_is_told_where_carrying_rollers_are_in_the_valley():
    found = judged(turning(3000))["limiting shear stress"]
    assert (
        found.matters and not found.on and '`ehdmaps generate JOB.toml` with shear = "limiting" has it' in found.words
    )
    assert not judged(turning(500, 100.0))["limiting shear stress"].matters


def test_stated_supply_and_roughness_stay_and_have_their_size():
    plain = at_one_speed(scene())
    assert "none is stated; a layer below" in judged(plain)["oil supply"].words
    assert "none is stated; above" in judged(plain)["roughness"].words
    for supply, surface, matters in ((OilSupply(1e-3), Surface(1e-9), False), (OilSupply(1e-7), Surface(1e-6), True)):
        found = judged(dataclasses.replace(plain, supply=supply, surface=surface))
        assert all(found[name].on for name in ("oil supply", "roughness"))
        assert [found[name].matters for name in ("oil supply", "roughness")] == [matters, matters]
        assert judged(plain, supply=supply)["oil supply"].size == found["oil supply"].size


def test_memory_is_on_where_it_matters_and_can_be_had():
    plain = at_one_speed(scene())
    assert "film memory" not in judged(plain, highest=0.0)
    assert judged(plain)["film memory"].on and not judged(plain, highest=1.0)["film memory"].on
    assert not judged(plain, films="slow")["film memory"].on
    coupled = plain.with_bearings(dataclasses.replace(entry, slices=5, slices_coupled=True) for entry in plain.bearings)
    memory = judged(coupled)["film memory"]
    assert memory.matters and not memory.on and memory.words.endswith("with coupled slices there is none")
    loaded = plain.with_bearings(dataclasses.replace(entry, centrifugal=True) for entry in plain.bearings)
    assert judged(loaded)["film memory"].words.endswith("with a centrifugal load of massless rollers there is none")


def test_an_analysis_has_what_is_switched_on():
    hot = turning(6000, 110.0)
    found = automatic(hot, statics, AutoSettings(highest=1.0))
    assert switched(found.verdicts) == {"films": "slow", "physics": "inlet-heat"}
    assert found.subject.law.films == "slow"
    assert "films from the film table, inlet heat" in found.result.model.law
    (emap,) = found.subject.law.maps.maps
    assert emap.inlet_heat


def test_no_size_is_told_beyond_ten_times():
    assert up_to(5820.6) == "a factor of more than 10"
    assert up_to(9.0) == "a factor of up to 10"
    assert up_to(1.0) == "up to 100 %"


# what an analysis asks for


FASTEST_OF_MAPS = '[runup]\nfrom = "0 rpm"\nto = "3000 rpm"\nduration = "2 ms"\nstep = "20 us"\nsample = "0.1 ms"\n'
SWEPT = '[sweep]\nfrom = "300 rpm"\nto = "2400 rpm"\npoints = 5\n'


@pytest.mark.parametrize("bearing", ["NU308", "N1014"])
@pytest.mark.parametrize("rpm", [500.0, 1200.0])
def test_only_the_speeds_that_an_analysis_visits_are_planned_for(bearing, rpm):
    text = SHORT.replace('"500 rpm"', f'"{rpm:g} rpm"').replace("NU308", bearing)
    alone, whole = scene(text), scene(f"{text}\n{FASTEST_OF_MAPS}\n{SWEPT}")
    speeds = [
        plan(visited_by).speeds
        for visited_by in (at_one_speed(whole), at_one_speed(alone), over_speeds(whole, None), in_time(whole), whole)
    ]
    unit = np.pi / 30.0
    np.testing.assert_allclose(
        speeds,
        np.array([[rpm, rpm], [rpm, rpm], [300.0, 2400.0], [150.0, 3000.0], [150.0, 3000.0]]) * unit,
    )
    narrow = over_speeds(whole, SweepRange(100.0, 150.0, 3))
    assert plan(narrow).speeds == (100.0, 150.0)
    assert over_speeds(alone, None).speed == alone.speed and in_time(alone) is alone
    # the operating speed of a report is visited beside those of its diagram
    both = over_speeds(whole, SweepRange(100.0, 150.0, 3), and_operation=True)
    np.testing.assert_allclose(plan(both).speeds, sorted([rpm * unit, 100.0, 150.0])[::2])


def test_a_scene_that_stands_still_is_judged_at_its_other_speeds():
    still = scene(f"{SHORT.replace('500 rpm', '0 rpm')}\n{FASTEST_OF_MAPS}")
    assert at_one_speed(still) is still


def test_heat_of_tapered_rollers_is_sized():
    oil = '[lubricant]\nname = "FVA3"\n'
    scene = parse_scene(text(**{**O_PAIR, "more": oil}).replace("500.0 rad/s", "1200 rad/s"), "rotor", "rotor.toml")
    found = {verdict.physics: verdict for verdict in verdicts(scene)}["inlet heat"]
    assert found.on and found.matters and "k or c of a contact by up to" in found.words
