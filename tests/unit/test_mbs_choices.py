"""Choices of scenes and maps: one row makes an option, is compared, varied, applied and written into results."""

from __future__ import annotations

import argparse
import dataclasses
import io
import sys
from contextlib import redirect_stdout
from importlib import resources

import numpy as np
import pytest
import xarray as xr

from ehdmaps.choices import MAP_CHOICES, ROUGHNESS, STRUCTURE
from ehdmaps.errors import InputError, Problems
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from mbs import assemble, statics
from mbs.cli import main, parser
from mbs.commands.cases import combinations, load_cases, read_compared, read_dry
from mbs.output.model_text import heading
from mbs.scene import choices
from mbs.scene.choices import CHOICES, OPTIONS, VARIED, SceneChoice
from mbs.scene.map_set import MapSet
from mbs.scene.reader import parse_scene, read_scene
from mbs.scene.subject import LawChoice, Subject, named_law
from tests.cases.laws import dataset_of

TEXT = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8").replace("= 41", "= 5")


@pytest.fixture(scope="module")
def emap():
    """A small map by the film formula."""
    axes = {"loads": (1e3, 1e4, 1e5), "speeds": (0.3, 1.2), "temperatures": (313.15, 333.15)}
    return EHDMap(dataset_of(**axes).assign_attrs(solver="formula"))


@pytest.fixture(scope="module")
def mapped(emap, tmp_path_factory):
    path = tmp_path_factory.mktemp("maps") / "small.nc"
    emap.dataset.to_netcdf(path)
    return str(path)


def given(**options):
    return argparse.Namespace(scene="nu308_rigid", output=None, plot=None, **options)


def refused(call, *parts):
    with pytest.raises(InputError) as caught:
        call()
    assert all(part in str(caught.value) for part in parts), caught.value


def _doubled_weight(subject, factor):
    """The change of a choice that no command knows: the scene with more gravity."""
    gravity = tuple(factor * 9.81 * part for part in (0.0, -1.0, 0.0))
    return dataclasses.replace(subject, scene=dataclasses.replace(subject.scene, gravity=gravity))


WEIGHT = SceneChoice(
    "weight", "FACTOR", "weight of all bodies, a toy", "", float, _doubled_weight, "{:g} g".format, example="2"
)


@pytest.fixture
def weight(monkeypatch):
    """A choice more: its row, and nothing else, wherever the table is known by name."""
    more = {"CHOICES": {**CHOICES, "weight": WEIGHT}, "OPTIONS": (*OPTIONS, WEIGHT)}
    more["VARIED"] = {**VARIED, "weight": WEIGHT}
    before = {table: getattr(choices, table) for table in more}
    for name, module in list(sys.modules.items()):
        for table, rows in more.items() if name.startswith("mbs.") else ():
            if getattr(module, table, None) is before[table]:
                monkeypatch.setattr(module, table, rows)
    parser.cache_clear()
    yield
    parser.cache_clear()


class TestARowIsEnough:
    def test_of_a_command(self, weight, tmp_path):
        """The option, what it changes, what the result tells; bit for bit what a scene gives that states it."""
        out = tmp_path / "heavy.nc"
        with redirect_stdout(io.StringIO()):
            assert main(["statics", "nu308_rigid", "--law", "hertz", "--weight", "2", "-o", str(out)]) == 0
        with xr.open_dataset(out) as data:
            assert data.attrs["choices"] == "weight 2 g"
            stated = dataclasses.replace(read_scene("nu308_rigid"), gravity=(0.0, -2.0 * 9.81, 0.0))
            expected = statics(assemble(stated, "hertz")).dataset["bearing_force"].values
            np.testing.assert_array_equal(data["bearing_force"].values, expected)

    def test_it_is_compared_and_refused_where_one_is_allowed(self, weight):
        cases = load_cases(given(law=["hertz"], weight=["1", "3"]))
        assert [case.label for case in cases] == ["1 g", "3 g"]
        assert [case.model.scene.gravity[1] for case in cases] == pytest.approx([-9.81, -29.43])
        refused(lambda: load_cases(given(law=["hertz"], weight=["1", "3"]), several=False), "--weight: got 2 of them")
        refused(lambda: load_cases(given(law=["hertz"], weight=["1", "1"])), "--weight: got '1' twice")

    def test_it_is_varied(self, weight):
        key = choices.VARIED["weight"]
        subject = Subject(read_scene("nu308_rigid"), LawChoice("dry", "hertz"))
        assert key.varied(subject, key.read("2"), first=False).scene.gravity[1] == pytest.approx(-19.62)


class TestChoices:
    def test_rows_read_what_they_show(self):
        for choice in VARIED.values():
            value = choice.read(choice.example)
            assert choice.text(value)
            assert choice.help("scene")
        assert {choice.name for choice in MAP_CHOICES} <= {choice.name for choice in OPTIONS}

    @pytest.mark.parametrize(
        ("option", "text", "part"),
        [
            ("temperature", "1000 degC", "--temperature: got '1000 degC'; allowed: -60 degC to 300 degC"),
            ("roughness", "1 m", "--roughness: got '1 m'; allowed: a combined rms roughness"),
            ("films", "dry", "--films: got 'dry'; contacts without films are --law hertz"),
            ("films", "wet", "--films: got 'wet'; allowed: memory, slow"),
            ("structural_law", "iso1628", "--structural-law: got 'iso1628' (did you mean 'iso16281'?)"),
            ("load_factor", "nan", "--load-factor: got 'nan'; allowed: above 0"),
            ("roughness", "0.2 um", "--roughness: got roughness 0.2 um without a law that has films"),
            ("structural_law", "palmgren", "--structural-law: got palmgren without a map"),
        ],
    )
    def test_what_is_wrong_is_said(self, option, text, part):
        refused(lambda: load_cases(given(law=["hertz"], **{option: [text]})), part)

    def test_all_problems_at_once(self):
        refused(
            lambda: load_cases(given(law=["hertz"], clearance=["1 s"], temperature=["hot"], start_angle=["9 rad"])),
            "--clearance: got the unit 's'",
            "--temperature: got 'hot'",
            "--start-angle: got '9 rad'",
        )

    def test_a_choice_is_that_of_the_file(self, mapped):
        """Temperature, roughness and loads by option give, bit for bit, what a scene gives that states them."""
        stated = TEXT.replace('temperature = "40 degC"', 'temperature = "55 degC"') + (
            '\n[surface]\nroughness = "0.3 um"\n'
        )
        scene = parse_scene(stated, "stated", "stated.toml")
        (case,) = load_cases(given(map=[mapped], temperature=["55 degC"], roughness=["0.3 um"]))
        other = Subject(scene, LawChoice("map", "map", MapSet([open_map(mapped)]))).model()
        assert (case.model.scene.temperature, case.model.surface) == (other.scene.temperature, other.surface)
        assert case.model.law == other.law
        assert case.model.chosen == {"roughness": "roughness 0.3 um", "temperature": "55 degC"}

    def test_roughness_keeps_what_is_known_of_the_surface(self):
        scene = dataclasses.replace(read_scene("nu308_rigid"), surface=Surface(1e-7, hardness=5e9))
        changed = CHOICES["roughness"].chosen(Subject(scene, LawChoice("map", "formula")), ROUGHNESS.read("0.4 um"))
        assert changed.scene.surface == Surface(4e-7, hardness=5e9)

    def test_structures_stand_side_by_side(self, mapped):
        cases = load_cases(given(map=[mapped], structural_law=["iso16281", "half_space"]))
        assert [case.label for case in cases] == [
            "formula map, structural law iso16281",
            "formula map, structural law half_space",
        ]
        laws = [case.subject.law.maps.maps[0] for case in cases]
        for one, structure in zip(laws, ("iso16281", "half_space"), strict=True):
            assert one.dataset.identical(open_map(mapped, structural_law=structure).dataset)

    def test_what_concerns_films_leaves_a_dry_law_as_it_is(self, emap):
        scene = read_scene("nu308_rigid")
        laws = [LawChoice(name, "map", MapSet([EHDMap(emap.dataset)])) for name in ("one", "two")]
        problems = Problems()
        subjects = [Subject(scene, law) for law in (*laws, named_law("hertz", scene))]
        found = combinations(subjects, {"films": ["slow"], "supply": [OilSupply.named("grease")]}, problems)
        assert problems == []
        assert [one.subject.law.label for one in found] == [
            "one, slow films, grease",
            "two, slow films, grease",
            "dry Hertz",
        ]

    def test_the_film_table_follows_the_temperature(self):
        """Beyond the usual range of its maps they are made again, by the structural law that was chosen."""
        (case,) = load_cases(given(law=["table"], temperature=["140 degC"], structural_law=["palmgren"]))
        (emap,) = case.subject.law.maps.maps
        assert float(emap.dataset["temperature"][-1]) >= 413.15
        assert emap.structural_law == "palmgren"

    def test_several_values_are_told_by_results(self):
        from mbs.scene.assembly import choice_attributes

        cases = load_cases(given(law=["hertz"], clearance=["0 um", "20 um"], load_factor=["2"]))
        attributes = choice_attributes([(case.label, case.model) for case in cases])
        assert attributes == {
            "choices": "0 um: clearance 0 um, load-factor 2 x; 20 um: clearance 20 um, load-factor 2 x"
        }
        np.testing.assert_array_equal(cases[0].model.scene.loads[0].force, cases[1].model.scene.loads[0].force)

    def test_the_heading_tells_what_it_would_not_say_otherwise(self):
        (case,) = load_cases(given(law=["hertz"], clearance=["20 um"], load_factor=["2"], start_angle=["7 deg"]))
        line = heading(case.model)[1]
        assert line.count("20 um") == 1
        assert ", load-factor 2 x, start-angle 7 deg; assumed:" in line

    def test_a_plan_takes_loads_and_temperature(self):
        problems = Problems()
        scene, clearance = read_dry(given(temperature=["60 degC"], load_factor=["2"], clearance=["20 um"]), problems)
        assert problems == []
        assert (scene.temperature, clearance) == (333.15, 20e-6)
        assert scene.loads[0].force[1] == 2.0 * read_scene("nu308_rigid").loads[0].force[1]

    def test_what_is_compared_by_variations_is_given_once(self):
        problems = Problems()
        read_compared(given(law=["hertz", "hertz:1e-5 s"], temperature=["40 degC", "60 degC"]), problems)
        assert "--temperature: got 2 of them; allowed: one, and others by --vary temperature" in problems


def test_the_table_of_a_law_is_not_written_over(tmp_path, capsys):
    """Nor by files that one command alone writes: it is read, as the map and the scene are."""
    table = tmp_path / "law.csv"
    table.write_text("approach [um], load [N/m], damping [N s/m2]\n0, 0, 0\n10, 1e5, 1\n20, 3e5, 1\n", encoding="utf-8")
    before = table.read_bytes()
    assert main(["runup", "nu308_rigid", "--law", f"table:{table}", "--signals", str(table)]) == 2
    assert "which is read; choose another name" in capsys.readouterr().err
    assert table.read_bytes() == before


def test_a_map_with_another_supply_is_a_map(emap, tmp_path):
    """Its checksum is that of what it states, so that it is read back; its films stay."""
    oil_air = emap.with_supply(OilSupply.named("oil air"))
    assert oil_air.supply == OilSupply.named("oil air")
    assert oil_air.with_supply(OilSupply.named("flooded")).dataset.identical(emap.dataset)
    path = tmp_path / "oil_air.nc"
    oil_air.dataset.to_netcdf(path)
    assert open_map(path).supply == oil_air.supply
    np.testing.assert_array_equal(oil_air.dataset["film_offset"], emap.dataset["film_offset"])


def test_structural_laws_are_named_at_once():
    refused(lambda: STRUCTURE.read("rigid"), "allowed: iso16281")


class TestSpeed:
    """Operating speed: of analyses at one speed; sweeps have an option of that name with three values."""

    def test_it_is_that_of_the_analysis_and_told(self, tmp_path):
        path = tmp_path / "there.nc"
        assert main(["statics", "nu308_rigid", "--law", "hertz", "--speed", "4321 rpm", "-o", str(path)]) == 0
        with xr.open_dataset(path) as found:
            assert found.attrs["choices"] == "speed 4321 rpm"
        (case,) = load_cases(given(speed="4321 rpm", law="hertz"))
        # Closed form: rpm in rad/s, to rounding.
        assert case.model.scene.speed == pytest.approx(4321.0 * np.pi / 30.0, rel=1e-14)
        assert case.model.operation.speed == case.model.scene.speed

    def test_speeds_of_a_sweep_are_not_one(self):
        (case,) = load_cases(given(speed=["500 rpm", "900 rpm", "3"], law="hertz"))
        assert case.model.scene.speed == read_scene("nu308_rigid").speed

    @pytest.mark.parametrize("text", ["-1 rpm", "1e9 rpm", "nan rpm", "5 m", "fast"])
    def test_what_is_no_speed_is_refused(self, text):
        refused(lambda: load_cases(given(speed=text, law="hertz")), "--speed: got")


def test_a_scene_without_roller_bearings_names_no_law():
    text = """
schema = 1
[operation]
speed = "3000 rpm"
temperature = "40 degC"
[[bodies]]
name = "disc"
freedoms = ["y", "z"]
mass = "10 kg"
polar_inertia = "0.2 kg m^2"
transverse_inertia = "0.1 kg m^2"
[[springs]]
name = "bush"
on = "disc"
against = "ground"
stiffness = { y = "1e6 N/m", z = "2e6 N/m" }
"""
    scene = parse_scene(text, "disc", "disc.toml")
    model = Subject(scene, named_law("hertz", scene)).model()
    assert model.law == "none"
