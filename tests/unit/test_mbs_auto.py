"""Analyses that choose their physics: films from the table, maps that they make, what is refused."""

from __future__ import annotations

import argparse
import dataclasses
import re
from importlib import resources
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError, MapError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.make.tasks import solver_version
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.surface import Surface
from mbs import AutoSettings, automatic, parse_scene, statics
from mbs.commands.auto_maps import read_tolerance
from mbs.planning import auto, kept_maps, plan, verdicts
from mbs.planning.auto import settled
from mbs.planning.criteria import (
    closed_contact,
    film_over_roughness,
    heat_effect,
    memory_effect,
    roughness_effect,
    supply_effect,
)
from mbs.planning.kept_maps import covering, covers
from mbs.planning.left_out import left_out_line
from mbs.planning.question import at_one_speed, in_time, over_speeds
from mbs.planning.ranges import Needed
from mbs.planning.verdicts import (
    Verdict,
    change_felt,
    heat_verdict,
    left_out_verdict,
    memory_verdict,
    shear_verdict,
    up_to,
    visited,
)
from mbs.scene.map_set import table_maps
from mbs.settings import SweepRange
from tests.cases.commands import run

TEXT = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
SHORT = TEXT.replace("slices = 41", "slices = 3").replace("points = 2000", "points = 5").split("[runup]")[0]


@pytest.fixture(autouse=True)
def by_formula(monkeypatch):
    """Maps by the film formula, in a moment: what is looked at here is when they are made, and for what."""
    made = []

    def quick(job, path, workers, progress=None):
        made.append(job)
        return generate(job, path, 1, solver=solvers.build("formula", {}))

    monkeypatch.setattr(auto, "generate", quick)
    monkeypatch.setattr(plan, "LAW_CHECK", 0)
    return made


def scene(text=SHORT):
    return parse_scene(text, "short", "short.toml")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Maps of several tests, as the plans are the same."""
    return tmp_path_factory.mktemp("maps")


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "short.toml"
    path.write_text(SHORT)
    return str(path)


def test_films_come_from_the_table_and_a_map_is_made_where_heat_or_shear_matters(file, capsys, by_formula):
    status, out, _ = run(capsys, "modes", file, "--auto")
    assert status == 0
    assert out.startswith("auto: films from the film table\n") and "films from the film table, flooded" in out
    assert "films with memory" in out
    assert not by_formula and not list(Path().glob("*.nc"))
    status, out, _ = run(capsys, "modes", file, "--auto", "--maps", "new", "--shear", "limiting")
    (path,) = Path("new").glob("short_nu308_*.nc")
    assert status == 0
    assert re.match(rf"auto: {path}: [0-9]+ points solved, 0 taken over; .* \(3 times the largest load at rest\)", out)
    assert by_formula[0].solver_options == {"shear": "limiting"}
    # what is solved is taken over from the store
    status, out, _ = run(capsys, "statics", file, "--auto", "--maps", "new", "--shear", "limiting")
    assert status == 0 and f"auto: {path}: 0 points solved, " in out


def test_what_stands_in_the_place_of_a_map_is_left_alone(file, capsys):
    limiting = ("statics", file, "--auto", "--shear", "limiting")
    assert run(capsys, *limiting)[0] == 0
    (path,) = Path().glob("*.nc")
    path.write_text("mine")
    assert run(capsys, *limiting)[0] == 2
    assert path.read_text() == "mine"
    Path("mine").write_text("mine")
    status, _, err = run(capsys, *limiting, "--maps", "mine")
    assert status == 2 and "--maps: got 'mine', which is no folder and cannot be made; allowed: a" in err


def test_a_command_says_what_the_laws_miss(file, capsys, monkeypatch):
    monkeypatch.setattr(auto, "unmet", lambda dataset, backbone: ["unmet: damping", "advice"])
    status, out, _ = run(capsys, "statics", file, "--auto", "--shear", "limiting")
    assert status == 1
    assert ".nc: unmet: damping" in out and "advice" not in out


def test_stated_physics_is_off_where_it_does_not_matter(folder, monkeypatch):
    monkeypatch.setattr(auto, "machine_verdicts", lambda *given: ())  # of laws by layers and roughness, which are dear
    plain = scene()
    for supply, surface, on in (
        (OilSupply(1e-3), Surface(1e-9), False),
        (OilSupply(1e-7), Surface(1e-6), True),
    ):
        stated = dataclasses.replace(plain, supply=supply, surface=surface)
        found = automatic(stated, statics, AutoSettings(folder=folder))
        assert [verdict.on for verdict in found.verdicts[1:3]] == [on, on]
        assert found.subject.law.supply == (None if on else FLOODED)
        assert found.subject.scene.surface.smooth is not on
    assert found.subject.model().supplies["bearing_left"] == supply


def test_bearings_of_two_types_have_films_each(folder):
    first, _, second = SHORT.rpartition('{ name = "NU308"')
    two = scene(f'{first}{{ name = "N1014"{second}')
    found = automatic(two, statics, AutoSettings(folder=folder, highest=0.0, shear="limiting"))
    assert [one.emap.bearing.name for one in found.made] == ["NU308", "N1014"]
    assert "maps of NU308 and N1014, FVA3, solver formula" in found.subject.model().law
    supply, *heats_and_shears = found.verdicts[1], *found.verdicts[3:7]
    assert re.fullmatch("NU308: none is stated; .* would matter; N1014: none is stated; .* would matter", supply.words)
    assert [verdict.words[:7] for verdict in heats_and_shears] == ["NU308: ", "N1014: "] * 2
    # a limiting stress matters in one of them alone: the other one's films are those of the table
    mixed = automatic(two, statics, AutoSettings(folder=folder, highest=0.0))
    assert [one.emap.bearing.name for one in mixed.made] == ["N1014"]
    law = mixed.subject.model().law
    assert "map of NU308, FVA3, films from the film table; map of N1014, FVA3, solver formula" in law


def test_options_that_do_not_go_together_are_refused_before_a_map_is_made(file, capsys, by_formula):
    status, _, err = run(
        capsys, "modes", file, "--auto", "--map", "a.nc", "--clearance", "1 um", "--clearance", "2 um",
        "--maps", file, "--auto-tolerance", "5", "--highest", "far", "--law", "hertz", "--films", "thick",
        "--supply", "much",
    )  # fmt: skip
    assert status == 2
    for words in (
        "--map: stands beside --auto",
        "--clearance: got 2 of them",
        f"--maps: got {file!r}, which is no folder and cannot be made",
        "--auto-tolerance: got '5'; allowed: above 0 up to 900 % or 20 dB",
        "--highest: got 'far'",
        "--law: stands beside --auto",
        "--films: got 'thick'",
        "--supply: ",
    ):
        assert words in err
    assert run(capsys, "modes", file, "--maps", ".")[0] == 2
    assert not by_formula


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
    assert read("20 dB") == auto.MOST_TOLERANCE
    assert read() == auto.TOLERANCE


def test_run_does_what_the_scene_has_tables_for(file, capsys, tmp_path):
    status, out, _ = run(capsys, "run", file, "--auto", "-o", "out")
    assert status == 0
    assert out.startswith("NU308: rigid shaft on two bearings: statics, modes, lsa\n")
    assert out.count("inlet heating") == 1  # what is the same is told once
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {f"{name}.{end}" for name in ("statics", "modes", "lsa") for end in ("nc", "png", "txt")}
    (tmp_path / "out" / "modes.txt").write_text("mine")
    assert run(capsys, "run", file, "-o", "out")[0] == 2
    assert (tmp_path / "out" / "modes.txt").read_text() == "mine"


def test_numerical_settings_are_chosen_for_the_map_and_its_physics(file, capsys, monkeypatch):
    Path(file).write_text(TEXT.replace("slices = 41", "slices = 3"))
    chosen = []

    def within(subject, tolerance, made, settings, tell):
        chosen.append((subject.law.name, subject.law.films, tolerance))
        raise AnalysisError("enough")

    monkeypatch.setattr("mbs.planning.tolerated.within", within)
    assert run(capsys, "campbell", file, "--auto", "--tolerance", "1 dB")[0] == 1
    assert chosen == [("map", "memory", 1.0)]


# criteria


def contact(load, speed=1.0, temperature=313.15):
    oil = Lubricant.named("FVA3")
    inner = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
    return closed_contact(inner, oil, np.atleast_1d(np.asarray(load, dtype=float)), speed, temperature)


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


def test_heat_and_roughness_go_with_their_numbers():
    oil = Lubricant.named("FVA3")
    assert heat_effect(contact([5e4], 4.0), oil) > heat_effect(contact([5e4], 0.4), oil) > 0.0
    unknown = dataclasses.replace(oil, thermal_conductivity=None)
    assert np.isnan(heat_effect(contact([5e4]), unknown)).all()
    rough = film_over_roughness(contact([5e4]), 2e-7)
    np.testing.assert_allclose(film_over_roughness(contact([5e4]), 4e-7), 0.5 * rough)


def there(speed, temperature, load=(1e3, 2e5)):
    geometry = BearingGeometry.named("NU308")
    needed = Needed(geometry, ("a",), load, (0.5 * speed, speed), temperature, load[1], 0.0)
    return visited(needed, Lubricant.named("FVA3"), 0.05)


def test_heat_is_in_the_map_where_its_rule_holds_and_told_where_it_does_not():
    slow, hot, cold = there(1.0, 373.15), there(9.0, 383.15), there(4.0, 313.15)
    assert not heat_verdict(slow).on and "not more than 5 %" in heat_verdict(slow).words
    found = heat_verdict(hot)
    assert found.on and found.solver == {"physics": "inlet-heat"} and "the map has it by its rule" in found.line
    beyond = heat_verdict(cold)
    assert not beyond.on and not beyond.solver
    assert "its rule does not hold here (M = " in beyond.words and beyond.words.endswith("--physics thermal has it")
    asked = heat_verdict(cold, "thermal")
    assert asked.on and asked.solver == {"physics": "thermal"} and asked.words.startswith("as asked, thermal; ")
    assert not heat_verdict(hot, "isothermal").on
    with pytest.raises(InputError, match="auto, physics: got 'warm'; allowed: isothermal, inlet-heat, thermal"):
        AutoSettings(physics="warm")


def test_the_planned_map_has_the_physics_that_is_asked_for(folder, by_formula):
    for physics, shear in (("thermal", "newtonian"), (None, "newtonian"), (None, "eyring")):
        automatic(scene(), statics, AutoSettings(folder=folder, physics=physics, shear=shear))
    assert [job.solver_options for job in by_formula] == [{"physics": "thermal"}, {"shear": "eyring"}]


def test_a_map_that_cannot_be_used_says_what_makes_another(monkeypatch):
    """The same plan would end the same way: the physics that --auto added is what can be left out."""

    def unfit(subject):
        raise MapError("backbone of the map: has 2 unsolved points")

    stand_in = SimpleNamespace(with_left_out=lambda *errors: None)
    monkeypatch.setattr(auto, "_films", lambda scene, found, pairs, *given: ([stand_in], pairs))
    monkeypatch.setattr(auto, "MapSet", lambda maps: None)
    monkeypatch.setattr(auto, "_subject", lambda *given: None)
    with pytest.raises(MapError, match=r"^backbone of the map: has 2 unsolved points\nauto: the map was made with lim"):
        automatic_of(unfit, AutoSettings(shear="limiting"))
    with pytest.raises(MapError, match=r"as asked, eyring; .*--shear newtonian makes one without"):
        automatic_of(unfit, AutoSettings(shear="eyring"))
    with pytest.raises(MapError, match=r"^backbone of the map: has 2 unsolved points$"):
        automatic_of(unfit, AutoSettings(shear="newtonian"))


def automatic_of(analyse, settings):
    return settled(scene(), analyse, settings)


def test_physics_belong_to_auto(file, capsys):
    status, _, err = run(capsys, "statics", file, "--physics", "thermal", "--map", "a.nc")
    assert status == 2 and "--physics: stands without --auto; allowed: with it" in err
    status, _, err = run(capsys, "statics", file, "--auto", "--physics", "therma")
    assert status == 2 and "--physics: got 'therma' (did you mean 'thermal'?); allowed: isothermal" in err


@pytest.mark.slow
def test_a_limiting_stress_is_in_the_map_where_it_matters():
    hot, cold = there(1.0, 373.15, (1e3, 1e4)), there(4.0, 313.15, (1e3, 3.5e4))
    assert not shear_verdict(hot).on and "not more than 5 %" in shear_verdict(hot).words
    assert shear_verdict(cold).solver == {"shear": "limiting"}
    asked = shear_verdict(hot, "eyring")
    assert asked.on and asked.solver == {"shear": "eyring"} and asked.words.startswith("as asked, eyring; ")
    assert not shear_verdict(cold, "newtonian").on
    with pytest.raises(InputError, match="auto, shear: got 'thin'; allowed: newtonian, eyring, carreau, limiting"):
        AutoSettings(shear="thin")


# what an analysis asks for

FASTEST_OF_MAPS = '[runup]\nfrom = "0 rpm"\nto = "3000 rpm"\nduration = "2 ms"\nstep = "20 us"\nsample = "0.1 ms"\n'
SWEPT = '[sweep]\nfrom = "300 rpm"\nto = "2400 rpm"\npoints = 5\n'


@pytest.mark.parametrize("bearing", ["NU308", "N1014"])
@pytest.mark.parametrize("rpm", [500.0, 1200.0])
def test_only_the_speeds_that_an_analysis_visits_are_planned_for(bearing, rpm):
    text = SHORT.replace('"500 rpm"', f'"{rpm:g} rpm"').replace("NU308", bearing)
    alone, whole = scene(text), scene(f"{text}\n{FASTEST_OF_MAPS}\n{SWEPT}")
    speeds = [
        plan.plan(visited_by).speeds
        for visited_by in (at_one_speed(whole), at_one_speed(alone), over_speeds(whole, None), in_time(whole), whole)
    ]
    turning = np.pi / 30.0
    np.testing.assert_allclose(
        speeds,
        np.array([[rpm, rpm], [rpm, rpm], [300.0, 2400.0], [150.0, 3000.0], [150.0, 3000.0]]) * turning,
    )
    narrow = over_speeds(whole, SweepRange(100.0, 150.0, 3))
    assert plan.plan(narrow).speeds == (100.0, 150.0)
    assert over_speeds(alone, None).speed == alone.speed and in_time(alone) is alone
    # the operating speed of a report is visited beside those of its diagram
    both = over_speeds(whole, SweepRange(100.0, 150.0, 3), and_operation=True)
    np.testing.assert_allclose(plan.plan(both).speeds, sorted([rpm * turning, 100.0, 150.0])[::2])


def test_a_scene_that_stands_still_is_judged_at_its_other_speeds():
    still = scene(f"{SHORT.replace('500 rpm', '0 rpm')}\n{FASTEST_OF_MAPS}")
    assert at_one_speed(still) is still


def test_statics_and_a_run_up_of_one_scene_are_judged_each_at_their_own_speed(file, capsys, by_formula):
    Path(file).write_text(f"{SHORT}\n{FASTEST_OF_MAPS}")
    limiting = ("--auto", "--shear", "limiting", "--maps", "maps")
    # 500 rpm of an NU308 are 0.8251 m/s, 3000 rpm are 4.951 m/s
    assert "0.8251 m/s" in (out := run(capsys, "statics", file, *limiting)[1]) and "4.951" not in out
    assert "0.24 to 5 m/s" in run(capsys, "runup", file, *limiting)[1]
    assert len({job.sha256 for job in by_formula}) == len(list(Path("maps").glob("*.nc"))) == 2
    # the map of the run-up left that of statics as it was
    status, out, _ = run(capsys, "statics", file, *limiting)
    assert status == 0 and ": 0 points solved, " in out


# never a dead end


@pytest.fixture
def holes(monkeypatch):
    """Maps with a limiting stress make no law, as where the solver ends beside one another."""
    quick = auto.generate

    def generated(job, path, workers, progress=None):
        found = quick(job, path, workers, progress)
        if "limiting" in job.solver_options.values():
            found.dataset.attrs["law_refused"] = "backbone of the map: has 2 unsolved points; the solver ended there"
        return found

    monkeypatch.setattr(auto, "generate", generated)


def test_physics_whose_map_makes_no_law_is_left_out_and_said(file, capsys, holes, monkeypatch):
    monkeypatch.setattr(verdicts, "shear_effect", lambda *given: (0.1, 2.68))
    Path(file).write_text(SHORT.replace("500 rpm", "9000 rpm"))
    status, out, _ = run(capsys, "statics", file, "--auto")
    assert status == 1 and "films from the film table" in out and "equilibrium in" in out
    assert (
        "warning: auto: limiting shear stress: off, left out although it would change k or c of a contact by a "
        "factor of up to 3.7 at 14.85 m/s (more than 5 %): the map with it makes no contact law (backbone of the map: "
        "has 2 unsolved points)\n"
    ) in out


def test_heat_stays_in_the_map_where_a_limiting_stress_is_left_out(holes, monkeypatch, tmp_path, by_formula):
    monkeypatch.setattr(verdicts, "shear_effect", lambda *given: (0.1, 2.68))
    hot = dataclasses.replace(scene(SHORT.replace("500 rpm", "6000 rpm")), temperature=383.15)
    found = automatic(hot, statics, AutoSettings(folder=tmp_path, highest=0.0))
    assert [job.solver_options.get("shear") for job in by_formula] == ["limiting", None]
    assert [job.solver_options.get("physics") for job in by_formula] == ["inlet-heat"] * 2
    assert len(found.made) == 1 and not found.made[0].refused
    assert [verdict.on for verdict in found.verdicts[3:5]] == [True, False]
    assert [verdict.warns for verdict in found.verdicts[3:5]] == [False, True]


def test_folders_of_maps_are_made_with_those_that_they_lie_in(file, capsys):
    assert run(capsys, "statics", file, "--auto", "--maps", "none/where")[0] == 0
    assert Path("none/where").is_dir()


def test_a_change_of_damping_in_its_valley_is_held_against_what_is_felt():
    state = contact([1e4])
    width = half_width(1e4, state.contact.radius, state.contact.reduced_modulus)
    k = 1e9
    small = 0.02 * k * width / state.speed

    def solved(damping, stiffness=k):
        return SimpleNamespace(stiffness=stiffness, damping=damping)

    assert change_felt(state, 1e4, solved(1e-9 * small), solved(0.5 * small)) == pytest.approx((0.0, 0.5))
    assert change_felt(state, 1e4, solved(10.0 * small), solved(5.0 * small)) == pytest.approx((0.0, 0.5))
    assert change_felt(state, 1e4, solved(small), solved(small, 1.2 * k)) == pytest.approx((0.2, 0.0))


def test_no_size_is_told_beyond_ten_times():
    assert up_to(5820.6) == "a factor of more than 10"
    assert up_to(9.0) == "a factor of up to 10"
    assert up_to(1.0) == "up to 100 %"
    huge = dataclasses.replace(there(1.0, 313.15), tolerance=1e-6)
    assert "%" not in re.search(r"wrong by (.*?) in k", memory_verdict(huge, 1e7, None).words).group(1)


# what is left out is in the bands


def test_physics_that_is_left_out_is_in_the_errors_that_bands_are_made_of(holes, monkeypatch, tmp_path):
    monkeypatch.setattr(verdicts, "shear_effect", lambda *given: (0.1, 2.68))
    fast = scene(SHORT.replace("500 rpm", "9000 rpm"))
    found = automatic(fast, statics, AutoSettings(folder=tmp_path))
    (emap,) = found.subject.law.maps.maps
    (plain,) = table_maps(fast).maps
    loads = np.geomspace(1e3, 1e5, 5)
    ours, theirs = (one.law_errors.bounds(["inner"], loads, 14.85, 313.15) for one in (emap, plain))
    # the limiting stress; Palmgren's law of the solids in place of the one that is taken; the centrifugal load
    missing = {verdict.physics: verdict.missing[0] for verdict in found.verdicts if verdict.missing[0] > 0.0}
    assert missing["limiting shear stress"] == 0.1 and 0.01 < missing["structural law"] < 0.1 and len(missing) == 3
    np.testing.assert_allclose(ours.stiffness - theirs.stiffness, sum(missing.values()), rtol=1e-5)
    # heat and a limiting stress together are more than bands can have
    np.testing.assert_allclose(ours.damping - theirs.damping, 0.9, rtol=1e-5)
    summed = found.verdicts[-1]
    assert summed.on is None and summed.size > 2.68
    assert summed.line.startswith(
        "left out of the films: 14 % of k and 90 % of c of a contact, by the sizes above, at mo"
    )


def test_an_equilibrium_has_no_bands_and_what_is_on_is_not_left_out(folder):
    found = automatic(scene(), statics, AutoSettings(folder=folder, highest=0.0))
    assert found.verdicts[-1].physics == "not decided"
    on, off = (Verdict("heat", state, 0.2, "", errors=(0.0, 0.2)) for state in (True, False))
    verdict, errors = left_out_verdict((on, off))
    assert errors == (0.0, 0.2) and verdict.words.startswith(
        "0 % of k and 20 % of c of a contact, by the sizes above; "
    )


# maps that were made before


def test_a_map_of_a_wider_range_is_used_again_and_no_other(tmp_path):
    """Loads and speeds may be fewer; another temperature, oil, physics or solver is another map."""
    wide, narrow, hotter = (
        plan.plan(given).job(0, solver={"shear": "limiting"})
        for given in (
            scene(f"{SHORT}\n{SWEPT}"),
            at_one_speed(scene()),
            dataclasses.replace(at_one_speed(scene()), temperature=333.15),
        )
    )
    assert covers(wide, wide) and covers(wide, narrow)
    assert not covers(narrow, wide) and not covers(wide, hotter)
    assert not covers(wide, dataclasses.replace(narrow, solver_options={"shear": "eyring"}))
    assert not covers(wide, dataclasses.replace(narrow, solver="formula", solver_options={}))
    by_formula = [dataclasses.replace(job, solver="formula", solver_options={}) for job in (wide, narrow)]
    damaged, path = tmp_path / "damaged.nc", tmp_path / "wide.nc"
    damaged.write_bytes(b"\x89HDF\r\n\x1a\n and no more")
    generate(dataclasses.replace(wide, name="wide"), path, 1, solver=solvers.build("formula", {}))
    # it was made by another solver than its job names, so that it is not that of the job
    assert covering([damaged, path], narrow) is None
    assert covers(*by_formula)


def test_a_command_of_fewer_speeds_takes_the_map_that_is_there(tmp_path, by_formula, monkeypatch):
    monkeypatch.setattr(verdicts, "shear_effect", lambda *given: (0.1, 0.2))
    monkeypatch.setattr(kept_maps, "solver_version", lambda solver: solver_version(solvers.build("formula", {})))
    # It is made by the film formula in place of the solver that was asked for.
    monkeypatch.setattr(kept_maps, "_asked", lambda job: (job.contacts, job.lubricant, job.temperatures))
    swept = scene(f"{SHORT}\n{SWEPT}")
    settings = AutoSettings(folder=tmp_path, highest=0.0)
    first = automatic(swept, statics, settings, planned_for=over_speeds(swept, None))
    again = automatic(swept, statics, settings, planned_for=at_one_speed(swept))
    assert len(by_formula) == 1
    assert (first.made[0].sweep is None, again.made[0].sweep) == (False, None)
    assert again.made[0].path == first.made[0].path


# what the other way would give


def test_a_result_says_what_the_other_way_gives(file, capsys, monkeypatch):
    monkeypatch.setattr(verdicts, "shear_effect", lambda *given: (0.1, 0.2))
    _, out, _ = run(capsys, "statics", file, "--auto")
    assert "auto: the same command without --auto leaves out limiting shear stress (up to 20 %)\n" in out
    _, out, _ = run(capsys, "statics", file, "--auto", "--shear", "newtonian")
    assert "auto: the same command without --auto has the same physics\n" in out


def test_films_without_heat_say_so_where_it_matters():
    slow, fast = (at_one_speed(scene(SHORT.replace("500 rpm", f"{rpm} rpm"))) for rpm in (200, 3000))
    assert left_out_line(slow) == ""
    assert re.search(r"no heat, which would lower c of a contact by up to \d+ % at 4.95 m/s", left_out_line(fast))
    assert left_out_line(dataclasses.replace(fast, lubricant=None)) == ""


def test_roughness_that_does_not_touch_still_has_a_size():
    """Load sharing goes to nothing for thick films, and to more than a tolerance where asperities touch."""
    state, oil = contact([1e4, 1e5]), Lubricant.named("FVA3")
    sizes = [max(float(part.max()) for part in roughness_effect(state, Surface(rq), oil)) for rq in (2e-8, 1e-7, 5e-7)]
    assert sizes[0] < sizes[1] < sizes[2]
    assert sizes[0] < 0.01 < 0.05 < sizes[2]
