"""`mbs bearing` as a newcomer meets it."""

from __future__ import annotations

import csv
import math
import os

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import root

import ehdmaps
from ehdmaps.jobs import cli
from ehdmaps.maps.rough_layer import OVERLAP
from ehdmaps.physics.bearing import BEARINGS
from ehdmaps.physics.solution import tip_words
from mbs import Bearing, BearingForce
from tests.cases import commands
from tests.cases.commands import check_units
from tests.cases.jobs import WIDE

OWN = """
[bearing]
inner_raceway_diameter = "52 mm"
outer_raceway_diameter = "80 mm"
roller_diameter = "14 mm"
roller_length = "15 mm"
rollers = 12
diametral_clearance = "20 um"
"""


DRY = ("--law", "hertz")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(capsys, *arguments):
    return commands.run(capsys, "bearing", *arguments)


def value(out, label):
    """First number of a line of the page, which begins with its label and unit."""
    return float(next(line for line in out.splitlines() if line.startswith(f"  {label}")).split()[-2])


@pytest.mark.parametrize("name", ["NU308", "N1014"])
def test_a_named_bearing_needs_a_load_and_a_speed(here, capsys, name):
    status, out, err = run(capsys, name, *DRY, "--load", "5 kN", "--speed", "1500 rpm", "--plot", "a.png", "-o", "a.nc")
    assert (status, err) == (0, "")
    for words in (
        f"{name}: law dry Hertz, ISO 16281; films: Moes' formula (minimum: Dowson-Higginson, Martin) for FVA3",
        "assumed: temperature 40 degC, combined rms roughness 0.3 um (for Lambda only), clearance not stated: CN of ",
        " um, oil FVA3",
        "5000 N on the inner ring at 1500 rpm: entrainment speed",
        "(smallest film over 0.3 um of roughness; mixed: asperities touch)",
        "rollers carry more than 1 % of the highest load",
        "note: the viscosity of FVA3 is extrapolated above 0.6 GPa",
    ):
        assert words in out
    with xr.open_dataset("a.nc") as data:
        check_units(data)
        assert data["roller_load"].dims == ("load", "speed", "roller")
        assert data["slice_minimum_film"].dims == ("load", "speed", "contact", "slice")
        assert "extrapolated" in data.attrs["warnings"]
    assert (here / "a.png").stat().st_size > 10_000


def test_an_estimated_bearing_says_so_and_how_well(here, capsys):
    for name in ("NU210", "NA4908"):
        assert "  inner geometry estimated from" in run(capsys, name, *DRY, "--load", "5 kN", "--speed", "0 rpm")[1]
    assert "estimated" not in run(capsys, "NU308", *DRY, "--load", "5 kN", "--speed", "0 rpm")[1]


def test_a_map_gives_what_a_program_of_ones_own_gets_from_it(here, capsys, formula_map):
    options = ("--map", formula_map, "--clearance", "20 um", "--temperature", "40 degC", "--direction", "800", "600")
    status, out, _ = run(capsys, "NU308", "--load", "1 kN", "--speed", "500 rpm", *options, "-o", "a.nc")
    assert status == 0
    assert "law map of FVA3, solver formula; films of the map, FVA3, flooded" in out
    bearing = Bearing.named("NU308", clearance=20e-6)
    speed = bearing.geometry.entrainment_speed(500.0 * math.pi / 30.0)
    force = BearingForce(bearing, ehdmaps.open_map(formula_map).law("series")).at(speed, 313.15)

    def balance(yz):
        f, K, _ = force([0, *yz, 0, 0, 0])
        return f[1:3] + np.array([800.0, 600.0]), -K[1:3, 1:3]

    place = root(balance, [10e-6, 10e-6], jac=True, tol=1e-12).x
    _, K, C = force([0, *place, 0, 0, 0])
    along, across = np.array([0.8, 0.6]), np.array([-0.6, 0.8])
    with xr.open_dataset("a.nc") as data:
        here_found = data.isel(load=0, speed=0)
        for name, matrix in (("stiffness", K), ("damping", C)):
            for word, way in (("along", along), ("across", across)):
                # Both equilibria are within 1e-9 of the forces.
                assert float(here_found[f"{name}_{word}"]) == pytest.approx(way @ matrix[1:3, 1:3] @ way, rel=1e-6)
        assert float(here_found["displacement_along"]) == pytest.approx(along @ place, rel=1e-7)


def test_tables_over_load_and_speed(here, capsys):
    status, out, _ = run(
        capsys, "N1014", "--load", "1 kN", "5 kN", "3", "--load", "20 kN", "--speed", "0 rpm", "--speed", "900 rpm",
        "--law", "formula", "-o", "t.csv", "--plot", "t.png",
    )  # fmt: skip
    assert status == 0
    assert len([line for line in out.splitlines() if line.strip()[:1].isdigit()]) == 8 + 1  # and the temperature
    lines = (here / "t.csv").read_text().splitlines()
    assert lines[0] == "# table made by ehdmaps: one bearing at operating points, SI"
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert [float(row["load [N]"]) for row in rows] == [1e3, 1e3, 3e3, 3e3, 5e3, 5e3, 20e3, 20e3]
    assert float(rows[0]["minimum_film_inner [m]"]) == 0.0 < float(rows[1]["minimum_film_inner [m]"])
    assert float(rows[0]["damping_along [N s/m]"]) == 0.0 < float(rows[1]["damping_along [N s/m]"])
    assert (here / "t.png").stat().st_size > 10_000
    # A result may be replaced by its like, and nothing else may be.
    assert run(capsys, "N1014", "--load", "1 kN", "--speed", "9 rpm", "-o", "t.csv")[0] == 0
    (here / "mine.csv").write_text("1,2\n")
    status, _, err = run(capsys, "N1014", "--load", "1 kN", "--speed", "9 rpm", "-o", "mine.csv")
    assert status == 2 and "is not a table of ehdmaps" in err


@pytest.mark.parametrize("more", [("--roughness", "0.3 um"), ("--supply", "5 um"), ("--temperature", "95 degC")])
def test_a_speed_alone_has_the_films_that_it_has_among_others(here, capsys, more):
    """Alone the law is made for that speed; among others it is one over all of them, and of standstill."""
    asked = ("NU308", "--load", "2 kN", *more)
    for name, speeds in (("one.nc", ["700 rpm"]), ("all.nc", ["0 rpm", "150 rpm", "700 rpm", "6000 rpm"])):
        options = [word for speed in speeds for word in ("--speed", speed)]
        assert run(capsys, *asked, *options, "-o", name)[0] == 0
    with xr.open_dataset("one.nc") as one, xr.open_dataset("all.nc") as among:
        alone, other = one.isel(load=0, speed=0), among.isel(load=0, speed=2)
        assert float(one["speed"][0]) == float(among["speed"][2])
        # 1e-3 bounds what the law of all speeds misses between its nodes; damping falls with the valley.
        assert float(alone["stiffness_along"]) == pytest.approx(float(other["stiffness_along"]), rel=1e-3)
        assert float(alone["damping_along"]) == pytest.approx(float(other["damping_along"]), rel=5e-3)
        films = [data["minimum_film"].min("contact") for data in (alone, other)]
        # heat bends films over the speed: 1.4e-3 between nodes, a tenth of what its rule is wrong by
        assert float(films[0]) == pytest.approx(float(films[1]), rel=2e-3)


@pytest.mark.slow
def test_profiles_in_the_words_of_scenes(here, capsys):
    """An arc is what it is at measured points: straight lines between 4001 of them are 1e-12 m off the arc."""
    asked = ("NU308", "--load", "5 kN", "--speed", "0 rpm")
    arc = '{ crown_drop = "8 um", straight = "6 mm" }'
    status, out, _ = run(capsys, *asked, "--profile", arc, "-o", "arc.nc")
    assert status == 0
    assert "profile iso" not in out
    half = 0.5 * BEARINGS["NU308"].roller_length
    x = np.linspace(0.0, half, 4001)
    beyond = np.maximum(x - 3e-3, 0.0)
    radius = ((half - 3e-3) ** 2 + 8e-6**2) / (2.0 * 8e-6)
    depth = radius - np.sqrt(radius**2 - beyond**2)
    table = f"{{ positions = {[f'{v!r} m' for v in x.tolist()]}, depths = {[f'{v!r} m' for v in depth.tolist()]} }}"
    assert run(capsys, *asked, "--profile", table, "-o", "table.nc")[0] == 0
    with xr.open_dataset("arc.nc") as one, xr.open_dataset("table.nc") as other:
        for name in ("stiffness_along", "roller_load"):
            np.testing.assert_allclose(other[name], one[name], rtol=1e-6, atol=1e-6 * float(np.abs(one[name]).max()))


@pytest.mark.slow
def test_wide_ranges_of_load_are_spaced_in_the_logarithm(here, capsys):
    run(capsys, "N1014", "--load", "1 N", "100 N", "3", "--speed", "0 rpm", "6000 rpm", "3", "-o", "w.nc")
    with xr.open_dataset("w.nc") as data:
        np.testing.assert_array_equal(data["load"], [1.0, 10.0, 100.0])
        np.testing.assert_allclose(data["speed"], np.array([0.0, 100.0, 200.0]) * np.pi, rtol=1e-11)


def test_a_bearing_of_ones_own(here, capsys):
    (here / "own.toml").write_text(OWN)
    status, out, _ = run(capsys, "own.toml", *DRY, "--load", "5 kN", "--speed", "1500 rpm")
    assert status == 0
    assert "bearing 52/80 mm, 12 rollers 14 x 15 mm: law dry Hertz" in out
    assert "clearance 20 um" in out and "clearance not stated" not in out
    named = run(capsys, "NU308", *DRY, "--load", "5 kN", "--speed", "1500 rpm", "--clearance", "20 um")[1]
    assert out.splitlines()[3:] == named.splitlines()[3:]
    (here / "oil.toml").write_text(
        OWN + '[material]\nyoungs_modulus = "100 GPa"\n[lubricant]\nname = "Spirax MA 80W"\n'
    )
    soft = run(capsys, "oil.toml", *DRY, "--load", "5 kN", "--speed", "1500 rpm")[1]
    assert "for Spirax MA 80W, flooded (unverified data of the oil)" in soft and "oil FVA3" not in soft
    assert value(soft, "Hertz pressure") < 0.8 * value(out, "Hertz pressure")
    assert value(soft, "stiffness") < 0.6 * value(out, "stiffness")
    shipped = run(capsys, "nu308", *DRY, "--load", "5 kN", "--speed", "1500 rpm")[1]
    assert "combined rms roughness 0.3 um (for Lambda only), clearance not stated: CN of" in shipped


def test_overload_and_what_is_outside_the_map_make_status_1(here, capsys, formula_map):
    options = ("--load", "1e6 N", "--speed", "1500 rpm", "--map", formula_map, "--temperature", "70 degC")
    status, out, _ = run(capsys, "NU308", *options, "-o", "a.nc", "--plot", "a.png")
    assert status == 1
    for words in (
        "is above 4 GPa, the static limit of ISO 76: permanent deformation",
        "warning: load per length of",
        "warning: temperature of 70 degC is outside the map (30 to 50 degC)",
    ):
        assert words in out
    with xr.open_dataset("a.nc") as data:
        assert "static limit of ISO 76" in data.attrs["warnings"]
        assert "static limit of ISO 76" in str(data["outside"].values[0, 0])


BAD = (
    ("NU3O9", [], "BEARING: got 'NU3O9' (did you mean 'NU319'?); allowed: a designation such as NU308 or NU210"),
    ("NU308", ["--load", "nan"], "--load: got 'nan', which does not start with a number"),
    ("NU308", ["--load", "-5 kN"], "--load: got '-5 kN'; allowed: 0.001 N to 1e+07 N"),
    ("NU308", ["--load", "0 N"], "--load: got '0 N'; allowed: 0.001 N to 1e+07 N"),
    ("NU308", ["--load", "1 N", "2 N"], "--load: got 2 values ('1 N 2 N'); allowed: one, or FROM TO POINTS"),
    ("NU308", ["--load", "2 N", "1 N", "5"], "--load: got '2 N' to '1 N'; allowed: rising"),
    ("NU308", ["--load", "1 N", "2 N", "1"], "--load, POINTS: got '1'; allowed: a whole number from 2 to 500"),
    ("NU308", ["--load", "1 N", "2 N", "400", "--speed", "1 rpm", "2 rpm", "9"], "points; allowed: at most 500"),
    ("NU308", ["--speed", "-1 rpm"], "--speed: got '-1 rpm'; allowed: 0 rpm to 100000 rpm"),
    ("NU308", ["--temperature", "-20 degC"], "--temperature: lubricant 'FVA3', temperature: got -20 degC"),
    ("NU308", ["--temperature", "400 degC"], "--temperature: got '400 degC'; allowed: -60 degC to 300 degC"),
    (
        "NU308",
        ["--roughness", "0 um"],
        "--roughness: got '0 um'; allowed: a combined rms roughness of 0.001 um",
    ),
    ("NU308", ["--direction", "0", "0"], "--direction: got '0 0'; allowed: an angle from y towards z"),
    ("NU308", ["--direction", "1", "2", "3"], "--direction: got '1 2 3'; allowed: an angle"),
    ("NU308", ["--direction", "nan"], "--direction: got 'nan'; allowed: an angle"),
    ("NU308", ["--clearance", "1 m"], "--clearance: got '1 m'; allowed: within 10000 um either way"),
    ("N1014", ["--clearance", "9.5 mm"], "--clearance: bearing 'N1014', diametral_clearance: got 0.0095 m"),
    ("NU308", ["--profile", "izo"], "--profile: got 'izo' (did you mean 'iso'?); allowed: iso, straight"),
    ("NU308", ["--profile", "{ crown_radius = }"], "--profile: is not TOML"),
    ("NU308", ["--profile", '{ crown_radius = "1 mm" }'], "--profile: crown_radius: got"),
    ("NU308", ["--profile", '{ crown = "1 mm" }'], "--profile: got"),
    ("NU308", ["--slices", "0"], "--slices: got '0'; allowed: a whole number from 1 to 1000"),
    (
        "N1014",
        ["--slices", "1000", "--load", "1 N", "9 N", "300"],
        "--slices: got 1000 for all rollers at 300 points; allowed: 5000000 slices in all",
    ),
    (
        "NU308",
        ["--law", "hurtz"],
        "--law: got 'hurtz' (did you mean 'hertz'?) for a cylindrical roller bearing; allowed: hertz",
    ),
    ("NU308", ["--law", "map"], "--law: got 'map' without a map"),
    ("NU308", ["--map", "no.nc"], "--map: no.nc: cannot be read"),
    ("NU308", ["--map", "MAP", "--law", "formula"], "--law: got 'formula' with a map"),
    ("NU308", ["--map", "MAP", "--oil", "FVA3"], "--oil: got 'FVA3' with a map, which was made for an oil"),
    ("N1014", ["--map", "MAP"], "--map: is made for NU308: inner_raceway_diameter 52 mm and not 82 mm"),
    ("NU308", ["--oil", "FVA9"], "--oil: lubricant name: got 'FVA9' (did you mean 'FVA3'?); allowed: FVA3, "),
    ("NU308", ["-o", "x.text"], "-o: got x.text; allowed: a file that ends in .nc, .csv, .toml, .bdf, .inp, .txt"),
    ("NU308", ["--plot", "x.bmp"], "--plot: got x.bmp; allowed: a file that ends in .png, .pdf, .svg"),
    ("NU308", ["--map", "MAP", "-o", "MAP"], "which would be written over"),
    ("bare.toml", [], "bare.toml: bearing file: has [contact]; allowed: [bearing]"),
    ("job.toml", [], "job.toml: is the job of a bare [contact]; allowed: one with [bearing]"),
    ("odd.toml", [], "odd.toml: [bearing] rollers: missing"),
    ("odd.toml", [], "odd.toml: bearing file sped: unknown key"),
    ("no.toml", [], "no.toml: is not TOML"),
)


@pytest.mark.parametrize(("bearing", "options", "words"), BAD)
def test_bad_input_is_refused_in_words(here, capsys, formula_map, bearing, options, words):
    contact = '[contact]\nradius = "5 mm"\nroller_length = "9 mm"\n'
    (here / "bare.toml").write_text(contact)
    job = WIDE
    (here / "job.toml").write_text(job.replace('[bearing]\nname = "NU308"\n', contact))
    (here / "odd.toml").write_text(OWN.replace("rollers = 12\n", "") + "[sped]\n")
    (here / "no.toml").write_text("= 1")
    before = sorted(os.listdir(here))
    needed = [part for option, value in (("--load", "1 kN"), ("--speed", "9 rpm")) if option not in options
              for part in (option, value)]  # fmt: skip
    given = [formula_map if option == "MAP" else option for option in options]
    status, out, err = run(capsys, bearing, *needed, *given)
    assert (status, out) == (2, "")
    assert words in err
    assert sorted(os.listdir(here)) == before


def test_all_problems_are_listed_at_once(here, capsys):
    status, out, err = run(
        capsys, "NU3O9", "--load", "x", "--speed", "y", "--temperature", "z", "--law", "w", "--slices", "v"
    )
    assert (status, out) == (2, "")
    assert err.startswith("mbs bearing: 6 problems\n")


@pytest.mark.slow
def test_no_equilibrium_is_status_1(here, capsys):
    soft = OWN + '[material]\nyoungs_modulus = "1 GPa"\n'
    (here / "soft.toml").write_text(soft)
    status, out, err = run(capsys, "soft.toml", "--load", "1e7 N", "--speed", "9 rpm")
    assert (status, out) == (1, "")
    assert "the load is beyond what the bearing can carry" in err


@pytest.mark.slow
def test_where_load_sharing_is_out_of_its_range_is_said(here, capsys, formula_map):
    at = ("NU308", "--load", "5 kN", "--temperature", "50 degC", "--map", formula_map, "--roughness", "2 um")
    for speed, wanted in (("100 rpm", True), ("3000 rpm", False)):
        status, out, _ = run(capsys, *at[:3], "--speed", speed, *at[3:])
        assert status == 0 and "the film carries" in out
        assert (OVERLAP in out) == wanted


def test_the_missing_tip_of_a_spike_is_said_alike_everywhere(here, capsys, reynolds_map):
    """By `solve`, `show` and `mbs bearing`: one sentence, with the error that the point or the map states."""
    status, out, _ = run(capsys, "NU308", "--load", "5 kN", "--speed", "1500 rpm", "--map", reynolds_map)
    assert status == 0 and "  film pressure with spike " in out and "+-" not in out
    assert cli.main(["show", reynolds_map]) == 0
    shown = capsys.readouterr().out
    errors = ehdmaps.open_map(reynolds_map).dataset["max_pressure_error"]
    assert tip_words(float(errors.max())) in shown
    place = ["--load", "80 N/mm", "--speed", "1.7 m/s", "--temperature", "40 degC"]
    assert cli.main(["solve", "nu308", *place]) == 0
    solved = capsys.readouterr().out
    sentence = tip_words(1.0).split(", by")[0]
    assert sentence in out and sentence in shown and solved.count(sentence) == 2
    assert cli.main(["solve", "nu308", *place[:2], "--speed", "0.1 m/s", "--temperature", "100 degC"]) == 0
    assert sentence not in capsys.readouterr().out
