"""Several maps for one scene: each bearing takes the one that was made for it; what is missing or too much is named."""

from __future__ import annotations

import argparse
import json
import re
from dataclasses import replace
from importlib import resources
from pathlib import Path
from types import SimpleNamespace

import pytest

from ehdmaps.errors import InputError, Problems
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.solids import STEEL
from mbs import assemble
from mbs.analyses.reach import source_of
from mbs.bearings.bearing import Bearing
from mbs.commands.cases import load_cases, read_compared
from mbs.output.model_text import heading
from mbs.report.examination import examined
from mbs.report.machine import machine, warnings
from mbs.scene.assembly import law_attributes
from mbs.scene.contact_laws import ContactLaws
from mbs.scene.map_set import MapSet, map_sets
from mbs.scene.reader import parse_scene
from tests.cases.laws import dataset_of

TEXT = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8").replace("= 41", "= 5")
N1014 = BearingGeometry.named("N1014").without_clearance


def two_types():
    """The shipped rigid shaft with an N1014 on its right."""
    before, begin, after = TEXT.partition('name = "bearing_right"')
    return before + begin + after.replace('name = "NU308"', 'name = "N1014"', 1)


def scene(text=""):
    return parse_scene(text or two_types(), "two", "two.toml")


@pytest.fixture(scope="module")
def small():
    """Small maps by the film formula of both types; the second one states grease."""
    axes = {"loads": (1e3, 1e4, 1e5), "speeds": (0.3, 1.2), "temperatures": (313.15, 333.15)}
    first = dataset_of(**axes).assign_attrs(solver="formula")
    second = dataset_of(contacts=N1014.contacts(STEEL, "iso16281"), bearing=N1014, **axes)
    grease = {schema.OIL_SUPPLY: '{"lubrication": "grease", "oil_layer": 7e-07}', "solver": "reynolds"}
    return EHDMap(first), EHDMap(second.assign_attrs(grease))


def test_each_bearing_has_law_supply_and_films_of_its_own_map(small):
    laws = ContactLaws("map", scene(), MapSet(small[::-1]))
    assert laws.problems() == []
    left, right = scene().bearings
    assert (laws.supply(left), laws.supply(right)) == (FLOODED, OilSupply.named("grease"))
    assert laws.label == "Reynolds map and formula map, supply by bearing"
    assert "map of N1014, FVA3, solver reynolds; map of NU308, FVA3, solver formula" in laws.words
    for spec, emap in zip((left, right), small, strict=True):
        bearing = Bearing(spec.geometry, slices=5)
        assert laws.films(bearing, FLOODED).emap is emap
        law, own = laws.of(bearing, FLOODED).series, emap.law("series", outside="clamp", supply=FLOODED)
        assert law(1e-6, 0.0, 0.6, 313.15)[0] == own(1e-6, 0.0, 0.6, 313.15)[0]  # the same arithmetic


def test_several_maps_are_called_maps_where_they_end(small):
    """Not the film formula, whose bounds a user cannot change."""
    law = ContactLaws("map", scene(), MapSet(small)).words
    assert source_of(SimpleNamespace(law=law)) == "the map"
    assert source_of(SimpleNamespace(law="maps of NU308 and N1014, FVA3, solver reynolds")) == "the map"
    assert source_of(SimpleNamespace(law="film formula moes")) == "the table of the film formula"


def test_maps_of_one_type_are_compared_and_those_of_several_belong_together(small):
    first, second = small
    other = EHDMap(first.dataset)
    bearings = scene().bearings
    assert [(words, one.maps) for words, one in map_sets([("a", first), ("b", second)], bearings)] == [
        ("", (first, second))
    ]
    assert [(words, one.maps) for words, one in map_sets([("a", first), ("b", second), ("c", other)], bearings)] == [
        ("a", (first, second)),
        ("c", (other, second)),
    ]


def test_of_several_oils_those_belong_together_that_are_the_same(small):
    def thin(emap):
        text = emap.dataset.attrs["lubricant"].replace("FVA3", "thin")
        return EHDMap(emap.dataset.assign_attrs(lubricant=text))

    names = "abcd"
    given = [small[0], small[1], thin(small[0]), thin(small[1])]
    found = map_sets(list(zip(names, given, strict=True)), scene().bearings)
    assert [words for words, _ in found] == ["a b", "c d"]
    mixed = map_sets([("a", given[0]), ("d", given[3])], scene().bearings)
    assert len(mixed) == 1  # two oils in one machine, where nothing else is given


def heavier(emap, words):
    """The map with the record of another oil: a label, and a higher viscosity."""
    record = json.loads(emap.dataset.attrs["lubricant"])
    record["vogel_factor"] *= 1.5
    return EHDMap(emap.dataset.assign_attrs(lubricant=json.dumps({**record, "label": words})))


def test_oils_that_contradict_each_other_are_told_and_those_of_the_maps_count(small):
    first, second = small
    agreed = assemble(scene(), emap=[first, second])
    assert agreed.warnings == [] and "warnings" not in law_attributes(agreed)
    assert set(agreed.oils.values()) == {Lubricant.named("FVA3")}
    assert assemble(scene(), "hertz").oils == {}  # dry
    heavy = heavier(second, "VG 150")
    model = assemble(scene(), emap=[first, heavy])
    assert model.oils == {"bearing_left": first.lubricant, "bearing_right": heavy.lubricant}
    several, other = model.warnings
    assert (
        "the maps of the bearings are made for different oils (FVA3 (84.54 mPa s at 40 degC): bearing_left" in several
    )
    assert "VG 150 (126.8 mPa s at 40 degC): bearing_right), which differ in viscosity; each bearing has" in several
    assert "[lubricant] of the scene, FVA3 (84.54 mPa s" in other
    assert "not the oil of the map of bearing_right, VG 150" in other and "the oil of the map counts" in other
    assert law_attributes(model)["warnings"] == "; ".join(model.warnings)
    # without [lubricant] there is nothing that the maps contradict but each other
    bare = scene(re.sub(r"\[lubricant\][^\[]*", "", two_types()))
    assert assemble(bare, emap=[first, heavy]).warnings == [several]
    assert assemble(bare, emap=[first, second]).warnings == []
    # the heading of every command, and a page to send
    assert heading(model)[-2:] == model.warnings
    found = examined(model, MapSet([first, heavy]), None, swept=False)
    assert "FVA3 (bearing_left); VG 150 (bearing_right)" in str(machine(found))
    assert warnings(found)[:2] == [line.removeprefix("warning: ") for line in model.warnings]


def test_what_is_missing_or_too_much_is_named(small):
    first, second = small
    with pytest.raises(InputError, match=r"--map: is made for NU308: .* as the N1014 of bearing 'bearing_right'"):
        assemble(scene(), emap=[first])
    with pytest.raises(InputError, match=r"b is made for N1014, which no bearing .* NU308 \(bearing_left, bearing_ri"):
        map_sets([("a", first), ("b", second)], scene(TEXT).bearings)
    with pytest.raises(InputError, match="two maps for the same contacts"):
        MapSet((first, first))
    with pytest.raises(InputError, match="got none; allowed: at least one map"):
        MapSet(())
    by_hand = two_types().replace('name = "N1014"', 'estimate = "NU2210"', 1)
    with pytest.raises(InputError, match="bearing 'bearing_right', NU2210, has no map; given are maps of NU308, N1014"):
        assemble(scene(by_hand), emap=MapSet(small))
    rough = EHDMap(second.dataset.assign_attrs({schema.SURFACE: '{"roughness": 3e-07}'}))
    with pytest.raises(InputError, match=r"different surfaces .*; state \[surface\] in the scene"):
        assemble(scene(), emap=[first, rough])


def test_a_map_of_the_same_name_says_in_what_it_differs(small):
    """Both are called NU308; the rollers of the scene are 1 mm longer."""
    longer = replace(small[0].bearing, roller_length=16e-3)
    bearings = tuple(replace(spec, geometry=replace(longer, diametral_clearance=0.0)) for spec in scene(TEXT).bearings)
    words = "roller_length 15 mm and not 16 mm"
    assert MapSet(small[:1]).problems("here", longer) == [
        f"--map: is made for NU308: {words} as the NU308 of here; generate a map of that bearing"
    ]
    assert f"given are maps of NU308 ({words}), N1014; allowed" in MapSet(small).problems("here", longer)[0]
    with pytest.raises(InputError, match=rf"a is made for NU308 \({words}\), which no bearing of the scene is"):
        map_sets([("a", small[0]), ("b", small[1])], bearings)


def test_commands_take_several_maps_as_one_case_or_more(tmp_path, formula_maps):
    path = tmp_path / "two.toml"
    path.write_text(two_types(), encoding="utf-8")

    def given(*maps):
        texts = {"output": None, "plot": None, "law": None, "clearance": "0 um", "films": None}
        return argparse.Namespace(scene=str(path), map=list(maps), **texts)

    def labels(*maps):
        problems = Problems()
        _, laws, _ = read_compared(argparse.Namespace(**{**vars(given(*maps)), "films": None}), problems)
        assert problems == []
        return [law.label for law in laws]

    assert labels(formula_maps["NU308"], formula_maps["N1014"]) == ["formula map"]
    again = tmp_path / "again.nc"
    again.write_bytes(Path(formula_maps["NU308"]).read_bytes())
    maps = formula_maps["NU308"], formula_maps["N1014"], str(again)
    assert labels(*maps) == ["formula map map", "formula map again"]
    with pytest.raises(InputError, match="got 3 of them, several for one type of bearing; allowed: one for each type"):
        load_cases(given(*maps), several=False)
