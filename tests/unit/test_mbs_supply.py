"""The oil supply of scenes and commands: which one is in force, how it is told and compared, and what is refused."""

from __future__ import annotations

import argparse
from importlib import resources

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError, Problems
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from mbs import assemble, read_scene
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.films import MapFilms
from mbs.commands.cases import read_compared
from mbs.output.state_text import FLOODED_NOTE, flooded_note
from mbs.scene.assembly import law_attributes
from mbs.scene.changes import with_supply
from mbs.scene.choices import VARIED
from mbs.scene.contact_laws import ContactLaws, supply_words
from mbs.scene.map_set import MapSet
from mbs.scene.reader import parse_scene
from mbs.scene.subject import LawChoice, Subject
from tests.cases.commands import run
from tests.cases.laws import dataset_of

LAYER, GREASE, AIR = OilSupply(5e-6), OilSupply.named("grease"), OilSupply.named("oil air")
TEXT = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")


def scene_text(supply="", of_bearing="", slices=5):
    """The shipped NU308 with supplies, at the speed of its map, and few slices."""
    text = TEXT.replace("slices = 41", f"slices = {slices}")
    before, begin, after = text.partition("[[bearings]]\n")
    own = f"supply = {of_bearing}\n" if of_bearing else ""
    table = f"[supply]\n{supply}\n" if supply else ""
    return f"{before}{table}{begin}{own}{after}"


def scene(*args, **keywords):
    return parse_scene(scene_text(*args, **keywords), "supplied", "supplied.toml")


@pytest.fixture(scope="module")
def emaps():
    """A map that states nothing, and the same with a job that states grease."""
    data = dataset_of(speeds=(0.3, 0.6, 1.2, 2.4))
    stated = data.assign_attrs({schema.OIL_SUPPLY: '{"lubrication": "grease", "oil_layer": 7e-07}'})
    return EHDMap(data.assign_attrs(solver="formula")), EHDMap(stated.assign_attrs(solver="formula"))


def test_what_is_asked_goes_before_bearing_scene_and_map(emaps):
    plain, stated = emaps
    own = '{ oil_layer = "5 um" }'
    for given, emap, asked, first, second in (
        (scene(), plain, None, FLOODED, FLOODED),
        (scene(), stated, None, GREASE, GREASE),
        (scene('lubrication = "oil air"'), stated, None, AIR, AIR),
        (scene('lubrication = "oil air"', own), stated, None, LAYER, AIR),
        (scene('lubrication = "oil air"', own), stated, FLOODED, FLOODED, FLOODED),
    ):
        laws = ContactLaws("map", given if asked is None else with_supply(given, asked), MapSet([emap]))
        assert laws.supplies == {"bearing_left": first, "bearing_right": second}


def test_laws_and_films_have_the_supply_of_their_bearing(emaps):
    model = assemble(scene(of_bearing='{ lubrication = "grease" }'), emap=emaps[0])
    laws = [entry.force.law for entry in model.bearings if isinstance(entry.force, BearingForce)]
    assert [law.supply for law in laws] == [GREASE, FLOODED]
    assert [one.source.in_force for one in model.bearings] == [GREASE, FLOODED]
    # Two films of a roller, of at most 1.23 times the layer, do not fill a gap of 3 um; flooded ones do.
    loads = [law(-3e-6, 0.0, 1.2, 313.15)[0] for law in laws]
    assert loads[0] == 0.0 < loads[1]
    words = "bearing_left grease (oil layer 0.7 um), bearing_right flooded"
    assert law_attributes(model)["oil_supply"] == words


def test_films_of_a_map_have_the_supply_that_its_job_states(emaps):
    plain, stated = emaps
    assert (MapFilms(plain).in_force, MapFilms(stated).in_force) == (FLOODED, GREASE)
    assert stated.law("inner").supply == GREASE
    assert stated.law("inner", supply=FLOODED).supply == FLOODED


def test_a_supply_is_said_with_the_law(emaps):
    plain, _ = emaps
    words, mixed = "map of NU308, FVA3, solver formula", "bearing_left grease (oil layer 0.7 um), bearing_right flooded"
    rest = "smooth surfaces, films with memory"
    for given, asked, law, label in (
        (scene(), None, f"{words}, flooded, {rest}", "formula map"),
        (scene(), AIR, f"{words}, oil air (oil layer 2 um), {rest}", "formula map, oil air"),
        (scene(), LAYER, f"{words}, oil layer 5 um, {rest}", "formula map, oil layer 5 um"),
        (
            scene(of_bearing='{ lubrication = "grease" }'),
            None,
            f"{words}, {mixed}, {rest}",
            "formula map, supply by bearing",
        ),
    ):
        laws = ContactLaws("map", given if asked is None else with_supply(given, asked), MapSet([plain]))
        assert (laws.words, laws.label) == (law, label)
    dry = assemble(scene('lubrication = "grease"'), "hertz")
    assert (dry.law, dry.label, dry.supplies) == ("dry Hertz, ISO 16281", "dry Hertz", {})
    assert supply_words({}) == "" and "oil_supply" not in law_attributes(dry)


def test_slips_of_a_scene_are_told():
    with pytest.raises(InputError) as caught:
        scene('lubrication = "oil bad"', '{ oil_layer = "5 km" }')
    text = str(caught.value)
    assert "supplied.toml: [supply] lubrication: got 'oil bad' (did you mean 'oil bath'?); allowed: 'flooded'" in text
    assert "[[bearings]] bearing_left supply oil_layer: got '5 km'; allowed: 0.001 um to 1000 um" in text
    with pytest.raises(InputError, match=r"\[supply\] assumed: got"):
        scene('lubrication = "grease"\nassumed = ["oil_layer"]')
    assert scene('lubrication = "grease"\nassumed = ["lubrication"]').assumed[-1] != ""


def test_a_supply_is_a_key_of_comparisons(emaps):
    key = VARIED["supply"]
    film, dry = LawChoice("map", "map", MapSet([emaps[0]])), LawChoice("dry", "hertz")
    assert key.varied(Subject(scene(), film), key.read("grease"), first=False).law.supply == GREASE
    assert key.varied(Subject(scene(), dry), key.read("grease"), first=True).law.supply is None
    with pytest.raises(InputError, match="got 'grese'"):
        key.read("grese")


@pytest.fixture
def shaft(tmp_path, emaps, monkeypatch):
    """A scene and a map as files."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "shaft.toml").write_text(scene_text())
    (tmp_path / "aired.toml").write_text(scene_text('lubrication = "oil air"'))
    emaps[0].dataset.to_netcdf(tmp_path / "map.nc")
    return tmp_path


def test_supplies_stand_side_by_side(shaft, capsys):
    status, out, err = run(
        capsys, "sweep", "shaft.toml", "--map", "map.nc", "--supply", "flooded", "--supply", "grease", "--law",
        "hertz", "--clearance", "0 um", "--speed", "800 rpm", "1200 rpm", "2", "-o", "s.nc",
    )  # fmt: skip
    assert (status, err) == (0, "")
    labels = ["dry Hertz", "formula map, flooded", "formula map, grease"]
    for label in labels:
        assert out.count(f"case: {label}\n") == 1
    with xr.open_dataset("s.nc") as data:
        assert data["case"].values.tolist() == labels
        assert data.attrs["oil_supply"] == (
            "formula map, flooded: flooded; formula map, grease: grease (oil layer 0.7 um)"
        )
        stiffness = data["bearing_stiffness"].isel(bearing=0).values
    # Without clearance idle films preload the bearing: flooded ones grow with speed (+24 %), those that the layer of
    # grease caps hardly do (+3 %, by rollers whose films are near the layer).
    change = stiffness[:, 1] / stiffness[:, 0] - 1.0
    assert change[0] == pytest.approx(0.0, abs=1e-9)  # equilibrium of dry contacts
    assert change[1] > 0.2 and abs(change[2]) < 0.05


def test_one_supply_is_in_the_label_where_it_is_not_flooded(shaft):
    for name, given, label in (
        ("shaft.toml", None, "formula map"),
        ("shaft.toml", ["flooded"], "formula map"),
        ("shaft.toml", ["grease"], "formula map, grease"),
        ("shaft.toml", ["flooded", "grease"], "formula map, flooded; formula map, grease"),
        ("aired.toml", None, "formula map, oil air"),
        ("aired.toml", ["flooded"], "formula map"),
    ):
        problems = Problems()
        asked = argparse.Namespace(scene=name, map=["map.nc"], supply=given, output=None, plot=None)
        _, laws, _ = read_compared(asked, problems)
        assert problems == []
        assert "; ".join(law.label for law in laws) == label
    dry = argparse.Namespace(scene="shaft.toml", map=["map.nc"], law=["hertz"], films=["slow"], supply=["grease"])
    _, laws, _ = read_compared(argparse.Namespace(**vars(dry), output=None, plot=None), problems)
    assert [law.label for law in laws] == ["dry Hertz", "formula map, slow films, grease"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("statics", "shaft.toml", "--law", "hertz", "--supply", "grease"),
            "--supply: got grease without a law that has films",
        ),
        (
            ("modes", "shaft.toml", "--supply", "grease", "--supply", "5 um"),
            "--supply: got 2 of them; allowed: one; lsa, sweep, critical, runup, campbell and hammer compare more",
        ),
        (
            ("sweep", "shaft.toml", "--supply", "5 um", "--supply", "0.005 mm"),
            "--supply: got '0.005 mm' twice; allowed: each once",
        ),
        (
            ("bearing", "NU308", "--load", "1 kN", "--speed", "1000 rpm", "--supply", "5 um", "--supply", "grease"),
            "--supply: got 2 of them; allowed: one; run the command again for another",
        ),
    ],
)
def test_what_is_refused(shaft, capsys, arguments, message):
    status, out, err = run(capsys, *arguments)
    assert (status, out) == (2, "")
    assert message in err


def test_one_bearing_with_a_supply(shaft, capsys):
    """The supply caps the films that are shown, also beside dry loads."""
    asked = ("bearing", "NU308", "--load", "1 kN", "--speed", "1000 rpm", "--clearance", "0 um", "-o", "b.nc")
    films = {}
    for law in ("hertz", "formula"):
        for supply in ("flooded", "0.2 um"):
            status, out, _ = run(capsys, *asked, "--law", law, "--supply", supply)
            assert status == 0
            with xr.open_dataset("b.nc") as data:
                films[law, supply] = float(data["central_film"].min())
                assert data.attrs["oil_supply"] == ("flooded" if supply == "flooded" else "oil layer 0.2 um")
                assert data.attrs["oil_supply"] in out
        assert films[law, "0.2 um"] < 0.2e-6 < films[law, "flooded"]


def test_the_file_of_a_bearing_may_state_its_supply(shaft, capsys):
    alone = '[bearing]\nname = "NU308"\n[supply]\nlubrication = "grease"\n'
    (shaft / "alone.toml").write_text(alone)
    (shaft / "wrong.toml").write_text(alone.replace("grease", "greese"))
    asked = ("--law", "hertz", "--load", "1 kN", "--speed", "1000 rpm")
    status, out, _ = run(capsys, "bearing", "alone.toml", *asked)
    assert status == 0 and "for FVA3, grease (oil layer 0.7 um)\n" in out
    status, out, _ = run(capsys, "bearing", "alone.toml", *asked, "--supply", "flooded")
    assert status == 0 and "for FVA3, flooded\n" in out
    status, _, err = run(capsys, "bearing", "wrong.toml", *asked)
    assert status == 2 and "wrong.toml: [supply] lubrication: got 'greese' (did you mean 'grease'?)" in err


def test_flooded_torque_says_what_to_do():
    assert flooded_note(0.1, [GREASE, FLOODED]) == [FLOODED_NOTE]
    assert "--supply" in FLOODED_NOTE
    for torque, supply in ((0.1, GREASE), (0.0, FLOODED), (np.nan, FLOODED)):
        assert flooded_note(torque, [supply]) == []


def test_a_shipped_scene_states_no_supply():
    assert read_scene("nu308_rigid").supply is None
