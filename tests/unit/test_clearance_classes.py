"""Classes of radial clearance in designations: their ranges, the reader of all kinds, what every door makes of them."""

from __future__ import annotations

import json
from itertools import pairwise

import pytest

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.defaults import designated_job
from ehdmaps.jobs.make.points_map import PointsRequest
from ehdmaps.jobs.reader import read_job
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry
from ehdmaps.physics.catalogue import designated
from ehdmaps.physics.designations.clearance import _BALLS, _ROLLERS, CLASSES, class_range
from ehdmaps.physics.designations.families import SERVED, not_served
from ehdmaps.physics.designations.reader import CYLINDRICAL, DEEP_GROOVE, NEEDLE, read_designation
from ehdmaps.physics.point.ball_catalogue import ball_designations, ball_estimate
from ehdmaps.physics.point.row_catalogue import row_designations
from ehdmaps.physics.rollers.ribbed_geometry import ribbed_estimate
from ehdmaps.physics.rollers.tapered_catalogue import tapered_designations, tapered_estimate
from mbs import Bearing, assemble, read_scene
from mbs.cli import main as mbs_main

# bore [mm], class, range [um], as printed: NSK E1102e (balls), SKF general catalogue 2018 (rollers)
PRINTED = (
    (DEEP_GROOVE, 10, "C2", 0, 7), (DEEP_GROOVE, 17, "CN", 3, 18), (DEEP_GROOVE, 20, "C4", 20, 36),
    (DEEP_GROOVE, 25, "C3", 13, 28), (DEEP_GROOVE, 40, "C3", 15, 33), (DEEP_GROOVE, 45, "C5", 45, 73),
    (DEEP_GROOVE, 65, "CN", 8, 28), (DEEP_GROOVE, 80, "C4", 46, 71), (DEEP_GROOVE, 100, "C2", 1, 18),
    (CYLINDRICAL, 20, "C2", 0, 25), (CYLINDRICAL, 30, "C5", 70, 95), (CYLINDRICAL, 40, "C3", 45, 70),
    (CYLINDRICAL, 50, "CN", 30, 60), (CYLINDRICAL, 65, "C4", 80, 110), (CYLINDRICAL, 70, "C3", 65, 100),
    (CYLINDRICAL, 100, "C5", 155, 190), (NEEDLE, 40, "C3", 45, 70),
)  # fmt: skip


@pytest.mark.parametrize(("kind", "bore", "name", "least", "largest"), PRINTED)
def test_ranges_are_those_in_print(kind, bore, name, least, largest):
    found = class_range(kind, 1e-3 * bore, name)
    assert (1e6 * found.least, 1e6 * found.largest) == pytest.approx((least, largest), abs=1e-9)  # round-off


@pytest.mark.parametrize("table", [_BALLS, _ROLLERS])
def test_no_row_of_the_tables_slips(table):
    """Classes rise, larger bores have no less, and a slip of a digit would leave the spread of a class."""
    for before, row in pairwise(table):
        assert row[0] > before[0]
        assert all(now >= then for now, then in zip(row[1:], before[1:], strict=True))
    for row in table:
        least, largest = row[1::2], row[2::2]
        assert list(least) == sorted(least)
        assert list(largest) == sorted(largest)
        assert all(5 <= high - low <= max(45, 0.5 * row[0]) for low, high in zip(least, largest, strict=True))


@pytest.mark.parametrize(
    ("typed", "plain", "clearance", "reach"),
    [
        ("6208", "6208", 10e-6, (0.0, 20e-6)),
        ("6205-2RSH/C3", "6205", 15.5e-6, (3e-6, 28e-6)),
        ("6208-C-2Z-C4", "6208", 32e-6, (18e-6, 46e-6)),
        ("6208 P63", "6208", 19e-6, (5e-6, 33e-6)),
        ("6208 CN", "6208", 10e-6, (0.0, 20e-6)),
        ("NU308-C3", "NU308", 47.5e-6, (25e-6, 70e-6)),
        ("NU 308 ECP/C4", "NU308", 62.5e-6, (40e-6, 85e-6)),
        ("NU208", "NU208", 27.5e-6, (5e-6, 50e-6)),
        ("N1014", "N1014", 47.5e-6, (20e-6, 75e-6)),
        ("NU 210 E.TVP2/C3", "NU210", 55e-6, (30e-6, 80e-6)),
        ("NA4908-C2", "NA4908", 15e-6, (0.0, 30e-6)),
        ("RNA4908", "RNA4908", 28.5e-6, (5e-6, 52e-6)),
        ("K40x48x20", "K40x48x20", 22.5e-6, (9e-6, 36e-6)),
    ],
)
def test_a_class_less_a_fit_gives_its_middle_and_keeps_its_range(typed, plain, clearance, reach):
    balls = typed[0] == "6"
    bearing = (ball_estimate if balls else designated)(typed)
    found = bearing.clearance if balls else bearing.diametral_clearance
    assert (bearing.name, found) == (plain, clearance)
    assert bearing.clearance_range.reach == pytest.approx(reach, abs=1e-15)  # round-off
    assert bearing.clearance_range.words.startswith("clearance not stated: ")


def test_without_a_class_it_is_cn_and_a_stated_one_counts():
    for bearing in (ball_estimate("6208"), designated("NU308"), BEARINGS["NU308"], ribbed_estimate("NUP308")):
        assert bearing.clearance_range.name == "CN"
        assert not bearing.clearance_range.typed
        assert bearing.with_clearance(1e-5).clearance_range is None
    cn = designated("NU308").clearance_range.unmounted  # of a bearing whose fit is stated
    assert (cn.reach, cn.clearance) == ((25e-6, 50e-6), 37.5e-6)
    beside = ball_estimate("6208 C3").with_clearance(1e-5)
    assert beside.clearance == 1e-5
    assert beside.clearance_range.words.startswith("clearance as stated: C3 of the designation would be 15 to 33 um")
    assert ball_estimate("7208B").clearance_range is None  # set when it is mounted


@pytest.mark.parametrize(
    ("estimate", "typed", "why"),
    [
        (ball_estimate, "7208B C3", "the play of angular contact bearings is set when they are mounted; leave C3 out"),
        (tapered_estimate, "32208 C3", "the play of tapered bearings is set when they are mounted; leave C3 out"),
        (designated, "RNA4908 C3", "without an inner ring, shaft and needles make the clearance; leave C3 out"),
        (ball_estimate, "6208CM", "one of the classes C2, CN, C3, C4, C5 of ISO 5753-1; state the clearance"),
        (ball_estimate, "6208 C3 C4", "one of the classes C2, CN, C3, C4, C5 of ISO 5753-1; state the clearance"),
    ],
)
def test_classes_that_a_bearing_does_not_have_are_refused(estimate, typed, why):
    with pytest.raises(InputError, match=f"got '{typed}'; allowed: .*{why}"):
        estimate(typed)


def test_jobs_keep_the_class(tmp_path):
    job = read_job("NU308-C3, FVA3")
    assert job.bearing.diametral_clearance == 47.5e-6
    assert designated_job("NU308-C3").name == "NU308_C3"
    assert 'name = "NU308 C3"' in designated_job("nu308-c3").text
    assert PointsRequest.named("6208 C3").file_name.startswith("6208_C3_")
    file = tmp_path / "part.toml"
    file.write_text('schema = 1\n[bearing]\nestimate = "NU210 C3"\ndiametral_clearance = "10 um"\n')
    assert read_job(file).bearing.clearance_range.taken == "stated"


def test_laws_and_bearings_in_python_keep_it():
    assert Bearing.named("NU308 C3").geometry.diametral_clearance == 47.5e-6
    assert Bearing.named("NU308 C3", clearance=2e-5).geometry.diametral_clearance == 2e-5
    assert Bearing.named("NU308").geometry == BearingGeometry.named("NU308")
    assert ehdmaps.law("6208 C3", "FVA3").geometry.clearance == 19e-6


SCENE = """
schema = 1
[operation]
speed = "1500 rpm"
temperature = "40 degC"
[[shafts]]
name = "shaft"
sections = [{{ length = "200 mm", diameter = "40 mm" }}]
[[bearings]]
name = "left"
bearing = "{}"
shaft = "shaft"
position = "20 mm"
[[bearings]]
name = "right"
bearing = "NU308-C3"
shaft = "shaft"
position = "180 mm"
{}
"""


def test_scenes_have_it_and_say_so(tmp_path, capsys):
    scene = tmp_path / "machine.toml"
    scene.write_text(SCENE.format("6208 C3", 'diametral_clearance = "20 um"'))
    read = read_scene(scene)
    assert read.located[0].geometry.clearance == 19e-6
    assert read.bearings[0].geometry.diametral_clearance == 20e-6
    assert mbs_main(["check", str(scene), "--law", "hertz"]) == 0
    said = capsys.readouterr().out
    assert "clearance of left 5 to 33 um (not stated: C3 of ISO 5753-1, less a fit)" in said
    assert "NU308 (right): clearance as stated: C3 of the designation would be 45 to 70 um" in said
    other = assemble(read, "hertz", clearance=1e-5).scene
    assert {reach.taken for _, reach in other.clearance_ranges.values()} == {"stated"}


def test_one_bearing_says_it(capsys):
    assert mbs_main(["bearing", "6208 C3", "--load", "1 kN", "--speed", "0 rpm", "--law", "hertz"]) == 0
    said = capsys.readouterr().out
    assert "clearance 19 um" in said
    assert "clearance not stated: C3 of ISO 5753-1, less a fit" in said
    assert mbs_main(["bearing", "NU308", "--load", "1 kN", "--speed", "0 rpm", "--law", "hertz"]) == 0
    assert (
        "clearance not stated: CN of ISO 5753-1, less a fit: 27.5 um, the middle of 5 to 50 um"
        in capsys.readouterr().out
    )


def test_check_reads_it(capsys):
    assert main(["check", "--bearing", "32208"]) == 2
    capsys.readouterr()
    assert main(["check", "--bearing", "RNA4908 C3"]) == 2
    assert "--bearing: bearing designation: got 'RNA4908 C3'" in capsys.readouterr().err


FAMILIES = {
    "spherical roller bearing": ("22208", "22310-E1-K", "23024", "SKF 22208 E", "BS2-2210-2RSK", "239/500"),
    "self-aligning ball bearing of another series": ("11208", "126"),
    "thrust ball bearing with a spherical washer": ("53208", "54208"),
    "thrust ball bearing of two directions": ("52208",),
    "four-point contact ball bearing": ("QJF208",),
    "double row cylindrical roller bearing": ("NN3910", "NNU4120"),
    "full complement cylindrical roller bearing": ("NCF2808", "NJG2318", "SL045010"),
    "double row angular contact ball bearing of another series": ("3008", "3808"),
    "drawn cup needle roller bearing": ("BK1616", "HN2020"),
    "needle roller bearing of another type": ("NKI40/20", "NK40/20"),
    "tapered roller bearing of another series": ("33208", "33010", "T7FC045"),
    "deep groove ball bearing of another series": ("62208", "63008", "6708"),
    "miniature deep groove ball bearing": ("608", "625-2RS"),
    "angular contact ball bearing of another series": ("70808C", "70914 ACD/P4"),
    "spherical roller thrust bearing": ("29412",),
    "cylindrical roller thrust bearing": ("81208",),
    "toroidal roller bearing": ("C2208",),
    "insert ball bearing": ("UC208",),
    "track roller": ("NUTR25", "KR22", "NATV 20 PP", "NA2203.2RS", "LR5204"),
}


@pytest.mark.parametrize(("words", "names"), FAMILIES.items())
def test_kinds_that_are_not_served_are_named_in_one_sentence(words, names, capsys):
    for name in names:
        expected = f"got {name!r}, {words}: not yet; served are {SERVED}"
        assert not_served(name) == expected
        for read in (designated, ball_estimate, tapered_estimate):
            with pytest.raises(InputError) as found:
                read(name)
            assert found.value.problems == (f"bearing designation: {expected}",)
    assert mbs_main(["bearing", names[0], "--load", "1 kN", "--speed", "0 rpm", "--axial", "1 kN"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 2
    assert "did you mean" not in said
    assert main(["generate", names[0]]) == 2
    assert f"{words}: not yet" in capsys.readouterr().err


def test_what_is_served_and_what_is_no_bearing_is_not_refused_so():
    served = [
        *ball_designations(),
        *row_designations(),
        *tapered_designations(),
        "NU308",
        "N1014",
        "NUP2310 C3",
        "NA4908",
        "K40x48x20",
    ]
    assert not [name for name in served if not_served(name)]
    assert all(read_designation(name) is not None for name in served)
    assert not [name for name in ("housing", "22208.toml", "map.nc", "FVA3", "", "nu", "12") if not_served(name)]


def test_a_scene_with_a_kind_that_is_not_served(tmp_path, capsys):
    scene = tmp_path / "machine.toml"
    scene.write_text(SCENE.format("22208", ""))
    assert mbs_main(["check", str(scene)]) == 2
    said = capsys.readouterr().err
    assert "[[bearings]] left bearing: got '22208', spherical roller bearing: not yet" in said
    assert "did you mean" not in said


def test_an_angle_that_is_missing_is_asked_for():
    assert not_served("7208 C3") == not_served("7208").replace("'7208'", "'7208 C3'")
    assert "7208C (15 degrees), 7208AC (25), 7208B (40)" in not_served("7208")


def test_maps_say_nothing_of_it(tmp_path):
    """Records of a bearing are of its contacts and its clearance; old maps are read as before."""
    record = json.loads(json.dumps(designated("NU210 C3").record()))
    assert "clearance_range" not in record
    assert BearingGeometry(**record) == designated("NU210 C3")
    assert set(CLASSES) == {"C2", "CN", "C3", "C4", "C5"}
