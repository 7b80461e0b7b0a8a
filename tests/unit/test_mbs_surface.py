"""Rough surfaces of scenes and of a single bearing: which are in force, how they are told, and what they do."""

from __future__ import annotations

from importlib import resources

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.records import record_json
from ehdmaps.physics.surface import SMOOTH, Surface
from mbs import assemble
from mbs.scene.assembly import law_attributes
from mbs.scene.contact_laws import ContactLaws
from mbs.scene.map_set import MapSet
from mbs.scene.reader import parse_scene
from tests.cases.commands import run
from tests.cases.laws import dataset_of

TEXT = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
TEXT = TEXT.replace("slices = 41", "slices = 5")
STATED = Surface(3e-7)


def scene(table=""):
    return parse_scene(TEXT.replace("[[bearings]]\n", f"{table}[[bearings]]\n", 1), "rough", "rough.toml")


ROUGH = '[surface]\nroughness = "0.2 um"\n'


@pytest.fixture(scope="module")
def emaps():
    """A map that states nothing, and the same with a job that states a roughness."""
    data = dataset_of(speeds=(0.3, 0.6, 1.2, 2.4)).assign_attrs(solver="formula")
    return EHDMap(data), EHDMap(data.assign_attrs({schema.SURFACE: record_json(STATED)}))


def test_the_scene_goes_before_the_map_and_dry_laws_have_no_surface(emaps):
    plain, stated = emaps
    for given, emap, expected in (
        (scene(), plain, SMOOTH),
        (scene(), stated, STATED),
        (scene(ROUGH), plain, Surface(2e-7)),
        (scene(ROUGH), stated, Surface(2e-7)),
    ):
        assert ContactLaws("map", given, MapSet([emap])).surface == expected
    assert ContactLaws("hertz", scene(ROUGH), None).surface is None


def test_every_result_says_whether_its_films_are_rough(emaps):
    plain, _ = emaps
    smooth, rough = (ContactLaws("map", given, MapSet([plain])) for given in (scene(), scene(ROUGH)))
    assert ", smooth surfaces, " in smooth.words and "roughness" not in smooth.label
    assert ", roughness 0.2 um, " in rough.words and rough.label.endswith(", roughness 0.2 um")
    model = assemble(scene(ROUGH), emap=plain)
    assert law_attributes(model)["surface"] == "roughness 0.2 um"
    assert "surface" not in law_attributes(assemble(scene(ROUGH), "hertz"))


def test_slips_in_the_table_of_a_scene_are_told():
    with pytest.raises(InputError, match=r"\[surface\] roughness: got '1 mm'; allowed: 0.001 um to 10 um"):
        scene('[surface]\nroughness = "1 mm"\n')


@pytest.mark.slow
def test_a_given_roughness_shares_the_load_and_an_assumed_one_does_not(tmp_path, capsys):
    found = {}
    for name, options in (("assumed", []), ("given", ["--roughness", "0.3 um"])):
        path = tmp_path / f"{name}.nc"
        args = ["--load", "500 N", "--speed", "100 rpm", "--temperature", "100 degC", "--law", "formula", *options]
        status, out, _ = run(capsys, "bearing", "NU308", *args, "-o", str(path))
        assert status == 0
        with xr.open_dataset(path) as data:
            found[name] = data.load(), out
    (assumed, words), (given, rough_words) = found["assumed"], found["given"]
    assert "roughness 0.3 um (for Lambda only)" in words and "smooth surfaces" in words
    assert "of the load of the most loaded roller" not in words
    assert "with the softest to the stiffest usual ones stiffness is " in rough_words
    assert "the film carries " in rough_words and ", roughness 0.3 um\n" in rough_words
    assert (assumed.attrs["surface"], given.attrs["surface"]) == ("smooth surfaces", "roughness 0.3 um")
    assert float(assumed["film_share"].item()) == 1.0
    assert 0.05 < given["film_share"].item() < 0.8
    np.testing.assert_allclose(given["film_parameter"], assumed["film_parameter"], rtol=0.05)  # other roller loads
    softer = given["stiffness_along"].item() / assumed["stiffness_along"].item()
    assert 0.7 < softer < 0.97  # asperities give way where smooth solids do not
