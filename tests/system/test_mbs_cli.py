"""The command line `mbs` as a person or a script meets it."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps import errors
from mbs.scene.reader import read_scene
from tests.cases.commands import check_units, run


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(Path(errors.__file__).parents[1]))
    return tmp_path


def test_statics(here, capsys):
    status, out, err = run(capsys, "statics", "nu308_rigid", "--law", "hertz", "-o", "a.nc", "--plot", "a.png")
    assert (status, err) == (0, "")
    assert "law dry Hertz, ISO 16281" in out
    assert "bearing_left: 141.421 N on the inner ring (y -100, z -100)" in out
    assert "6 of 12 rollers loaded" in out
    with xr.open_dataset("a.nc") as data:
        check_units(data)
        np.testing.assert_allclose(np.hypot(*data["bearing_force"].values[:, 1:].T), 141.42136, rtol=1e-7)
        assert data["bearing_stiffness"].shape == (2, 6, 6)
        assert data.attrs["scene_toml"] == read_scene("nu308_rigid").text
    assert (here / "a.png").stat().st_size > 10_000


def test_modes_by_map(here, capsys, formula_maps):
    status, out, err = run(
        capsys, "modes", "nu308_rigid", "--map", formula_maps["NU308"], "-o", "m.nc", "--plot", "m.png"
    )
    assert (status, err) == (0, "")
    assert "law map of NU308, FVA3, solver formula" in out
    assert re.search(
        r"bearing_left: films with memory; estimated error of the dynamic stiffness along the load at", out
    )
    with xr.open_dataset("m.nc") as data:
        check_units(data)
        np.testing.assert_allclose(data["energy_share"].sum("part"), 1.0, rtol=1e-9)


@pytest.mark.slow
def test_sweep_of_two_laws_and_clearances(here, capsys, formula_maps):
    status, out, err = run(
        capsys, "sweep", "nu308_rigid", "--map", formula_maps["NU308"], "--law", "hertz", "--clearance", "0 um",
        "--clearance", "20 um", "--speed", "200 rpm", "2000 rpm", "4", "-o", "s.nc", "--plot", "s.png",
    )  # fmt: skip
    assert (status, err) == (0, "")
    assert "law map of NU308, FVA3, solver formula" in out
    assert "case: dry Hertz, 20 um" in out
    assert "by energy: summed, one step" in out
    assert "bearing_left: films with memory; estimated error" in out
    assert "undamped modes are those of slow motion" in out
    with xr.open_dataset("s.nc") as data:
        check_units(data)
        along = data["frequency"].isel(mode=-1)
        # Dry: the same at every speed; with films rising without clearance, falling with it.
        np.testing.assert_allclose(along[:2], along[:2, :1].values * np.ones(4), rtol=1e-6)
        assert np.all(np.diff(along.values[2]) > 0.0)
        assert np.all(np.diff(along.values[3]) < 0.0)
        np.testing.assert_allclose(data["clearance"], [0.0, 20e-6, 0.0, 20e-6])
        assert data["response_real"].dims == ("case", "speed", "response_frequency", "sensor", "input")
        assert data["bearing_stiffness"].shape == (4, 4, 2)
    assert (here / "s.png").stat().st_size > 10_000


@pytest.mark.slow
def test_sweep_of_films(here, capsys, formula_maps):
    """Slow films, films with memory and none stand side by side; films are told with their error."""
    status, out, err = run(
        capsys, "sweep", "nu308_rigid", "--map", formula_maps["NU308"], "--films", "slow", "--films", "memory",
        "--law", "hertz", "--clearance", "20 um", "--speed", "500 rpm", "2000 rpm", "4", "-o",
        "s.nc", "--plot", "s.png",
    )  # fmt: skip
    assert (status, err) == (0, "")
    for words in ("formula map, slow films", "formula map, films with memory", "dry Hertz"):
        assert out.count(f"case: {words}\n") == 1
    assert "law map of NU308, FVA3, solver formula, flooded, smooth surfaces, films with memory" in out
    assert out.count("warning: bearing_left: slow films; estimated error") == 1
    assert out.count("bearing_left: films with memory; estimated error") == 1
    with xr.open_dataset("s.nc") as data:
        check_units(data)
        assert data["case"].values.tolist() == [
            "dry Hertz",
            "formula map, slow films",
            "formula map, films with memory",
        ]
        np.testing.assert_array_equal(data["frequency"][1], data["frequency"][2])
        highest = data["complex_damping_ratio"].isel(speed=0).max("complex_mode")
        assert float(highest[1]) != float(highest[2])
    assert (here / "s.png").stat().st_size > 10_000


@pytest.mark.slow
def test_films_with_memory_at_one_speed(here, capsys, formula_maps):
    films = ("--map", formula_maps["NU308"], "--films", "memory")
    status, out, err = run(capsys, "modes", "nu308_rigid", *films, "-o", "m.nc", "--plot", "m.png")
    assert (status, err) == (0, "")
    assert "films with memory" in out and "warning" not in out
    assert "motions without oscillation that are as quick as films relax" in out
    status, out, err = run(capsys, "lsa", "nu308_rigid", *films, "-o", "l.nc")
    assert (status, err) == (0, "")
    with xr.open_dataset("l.nc") as data:
        check_units(data)
        assert "film_1" in data["state"].values
        assert data.attrs["law"].endswith("films with memory")
    struck = ("--hits", "1", "--highest", "9 kHz", "--duration", "10 ms", "-o", "h.uff")
    status, out, err = run(capsys, "hammer", "nu308_rigid", *films, *struck)
    assert (status, err) == (0, "")
    assert "films with memory; estimated error" in out
    assert "slow films; estimated error" in run(capsys, "hammer", "nu308_rigid", *films[:3], "slow", *struck)[1]
    slow = run(capsys, "statics", "nu308_rigid", *films[:2], "--films", "slow")[1]
    memory = run(capsys, "statics", "nu308_rigid", *films)[1]
    kept = [line for line in slow.splitlines() if ": law " not in line]
    assert any("K and C are those of slow motion" in line for line in kept)
    assert [line for line in memory.splitlines() if ": law " not in line] == kept
    dry = run(capsys, "statics", "nu308_rigid", *films[:2], "--law", "hertz")[1]
    assert "law dry Hertz, ISO 16281" in dry


def test_a_hammer_test_says_which_films_it_had(here, capsys, formula_maps):
    given = ("hammer", "nu308_rigid", "--map", formula_maps["NU308"], "--clearance", "20 um", "--hits", "1")
    found = []
    for films in ("slow", "memory"):
        status, out, _ = run(capsys, *given, "--films", films, "-o", f"{films}.uff", "--duration", "0.05 s")
        assert status == 0
        found.append(re.findall(r"^ +\d+ +(\S+) Hz", out, re.MULTILINE))
    # the eigenvalues that are expected, and the records, are those of the films that were asked for
    assert found[0] != found[1]
    assert "formula map, slow films, flooded: 1 hits, simulated" in (here / "slow.uff").read_text()
    assert "formula map, films with memory, flooded: 1 hits, simulated" in (here / "memory.uff").read_text()


@pytest.mark.slow
def test_linear_analysis_with_rollers_as_bodies(here, capsys, formula_maps):
    given = ("lsa", "n1014_rigid", "--map", formula_maps["N1014"])
    status, out, _ = run(capsys, *given, "--films", "slow", "-o", "l.nc", "--plot", "l.png")
    assert status == 0
    assert "state space: 60 states, 1 inputs, 1 outputs" in out
    assert "S1 (acceleration, m/s2/N) by E1: peaks at" in out
    with xr.open_dataset("l.nc") as data:
        check_units(data)
        assert data["A"].shape == (60, 60)
    status, out, _ = run(capsys, "lsa", "n1014_rigid", "--law", "constant:hertz")
    assert "the dynamic load of the bearing, " in out
    assert "contacts lift off, a linear analysis is not valid there" in out


def test_linear_analysis_of_several_laws_ends_with_their_peaks(here, capsys):
    """Heights are the largest of the written responses within two half-widths of the eigenvalues of the matrices."""
    laws = ("--law", "hertz:1.25e-5 s", "--law", "formula", "--films", "slow")
    status, out, _ = run(capsys, "lsa", "nu308_rigid", *laws, "-o", "l.nc")
    assert status in (0, 1)
    table = re.search(r"^S1 .* by E1: modes that have a peak by dry Hertz.*\n.*\n((?:  +\d+ .*\n)+)", out, re.MULTILINE)
    rows = [line.replace("%", "").replace("dB", "").split() for line in table[1].splitlines()]
    assert len(rows) == 4
    with xr.open_dataset("l.nc") as data:
        size = np.hypot(data["response_real"], data["response_imaginary"]).sel(sensor="S1", input="E1").values
        frequency = data["frequency"].values
        eigenvalues = [np.linalg.eigvals(data["A"].values[law]) for law in (0, 1)]
    for row in rows[1:]:  # the first stands beside that of the other plane
        first, height, other, part, its_height, level = map(float, row[1:])
        for law, (at, told) in enumerate(((first, height), (other, its_height))):
            poles = eigenvalues[law][eigenvalues[law].imag > 0.0]
            pole = poles[np.argmin(np.abs(np.abs(poles) / (2.0 * np.pi * at) - 1.0))]
            beside = np.abs(frequency / at - 1.0) < -2.02 * pole.real / abs(pole)
            assert size[law][beside].max() == pytest.approx(told, rel=0.03)
        assert part == pytest.approx(100.0 * (other / first - 1.0), abs=0.02)
        assert level == pytest.approx(20.0 * np.log10(its_height / height), abs=0.1)


def short_run(here, **changes):
    text = read_scene("nu308_rigid").text.replace('duration = "0.2 s"', 'duration = "2 ms"')
    for old, new in changes.items():
        assert f"{old} = " in text
        text = text.replace(f"{old} = ", f"{old} = {new} #", 1)
    (here / "short.toml").write_text(text)
    return "short.toml"


def test_run_up(here, capsys, formula_maps):
    status, out, err = run(
        capsys, "runup", short_run(here), "--map", formula_maps["NU308"], "-o", "r.nc", "--plot", "r.png"
    )
    assert status == 0
    # so quick a start may halve some steps
    steps = int(re.search(r"from 0 rpm to 2000 rpm in 0.002 s: (\d+) steps", out)[1])
    assert steps >= 100 and "100 of 100 steps" in err
    assert "; 0 calls outside the map" in out
    # The map begins at 0.05 m/s: below, the film fades to the dry contact, which is no call outside.
    assert "warning: 0 to 30.3 rpm lie below the map (4.8 % of the run; entrainment speed below 0.05 m/s)" in out
    assert "N below 30.3 rpm, where the film fades, and" in out
    with xr.open_dataset("r.nc") as data:
        check_units(data)
        assert data.sizes["time"] == 21
        assert data["speed"].values[-1] == pytest.approx(2000.0 * np.pi / 30.0)
        np.testing.assert_array_equal(data["outside_calls"], 0)


def test_outside_the_map_is_counted_said_and_makes_status_1(here, capsys, formula_maps):
    scene = short_run(here, temperature='"65 degC"')
    status, out, _ = run(capsys, "runup", scene, "--map", formula_maps["NU308"])
    assert status == 1
    assert "; 0 calls outside the map" not in out
    status, out, _ = run(capsys, "statics", scene, "--map", formula_maps["NU308"])
    assert status == 1
    assert "warning: bearing_left: lies outside the map" in out


@pytest.mark.slow
def test_bad_input_lists_every_problem_and_writes_nothing(here, capsys, formula_maps):
    status, out, err = run(
        capsys, "modes", "nu308_rigid", "--map", formula_maps["N1014"], "--clearance", "5 kg", "-o", "no/x.nc"
    )
    assert (status, out) == (2, "")
    for words in ("is made for N1014: inner_raceway_diameter 82 mm and not 52 mm", "got the unit 'kg'", "is no folder"):
        assert words in err
    assert not list(here.iterdir())
    for arguments, words in (
        (["statics", "nowhere"], "shipped system: electric_drive, gearbox, n1014_rigid, n1014_testrig, "),
        (["statics", "nu308_rigid", "--law", "map"], "got 'map' without a map"),
        (["statics", "nu308_rigid", "--map", "nu.nc"], "--map: nu.nc: cannot be read"),
        (["statics", "nu308_rigid", "--clearance", "1 m"], "allowed: within 10000 um either way"),
        (["statics", "nu308_rigid", "--clearance", "1 um", "--clearance", "2 um"], "got 2 of them; allowed: one"),
        (["modes", "nu308_rigid", "--clearance", "1 um", "--clearance", "2 um"], "got 2 of them; allowed: one"),
        (["sweep", "nu308_rigid", "--speed", "9 rpm", "5 rpm", "x"], "allowed: a whole number from 2"),
        (["sweep", "nu308_rigid", "--speed", "9 rpm", "5 rpm", "3"], "allowed: rising"),
        (["sweep", "nu308_rigid", "--load-factor", "none"], "--load-factor: got 'none'; allowed: above 0"),
        (["modes", "nu308_rigid", "--law", "hertz", "--films", "memory"], "--films: got memory without a law that has"),
        (["modes", "nu308_rigid", "--films", "fast"], "--films: got 'fast'; allowed: memory, slow"),
        (
            ["sweep", "nu308_rigid", "--films", "slow", "--films", "slow"],
            "--films: got 'slow' twice; allowed: each once",
        ),
        (["modes", "nu308_rigid", "--films", "dry", "--films", "slow"], "--films: got 2 of them; allowed: one"),
        (["sweep", "nu308_rigid"], "no speeds; allowed: --speed"),
        (["statics", "nu308_rigid", "--plot", "a.xyz"], "--plot: got a.xyz; allowed: a file that ends in .png"),
    ):
        status, out, err = run(capsys, *arguments)
        assert (status, out) == (2, ""), arguments
        assert words in err


def test_scenes_without_what_an_analysis_needs(here, capsys):
    text = read_scene("nu308_rigid").text
    (here / "a.toml").write_text(text[: text.index("[[inputs]]")])
    status, _, err = run(capsys, "lsa", "a.toml")
    assert status == 2
    assert "[[inputs]] missing" in err and "[[sensors]] missing" in err and "frequencies missing" in err
    status, _, err = run(capsys, "runup", "a.toml")
    assert status == 2
    assert "[runup] missing" in err


def test_what_a_scene_lacks_is_said_before_laws_are_made(here, capsys, monkeypatch):
    monkeypatch.setattr("mbs.scene.contact_laws._of_formula", lambda *_: pytest.fail("a law was made"))
    text = read_scene("nu308_rigid").text.replace('"acceleration"', '"velocity"')
    (here / "a.toml").write_text(text[: text.index("[[inputs]]")])
    (here / "b.toml").write_text(text)
    for *command, words in (
        ("lsa", "a.toml", "[[inputs]] missing"),
        ("runup", "a.toml", "[runup] missing"),
        ("sweep", "a.toml", "no speeds; allowed: --speed"),
        ("hammer", "a.toml", "-o", "h.uff", "[[sensors]] missing"),
        ("campbell", "b.toml", "has no sensor of an acceleration"),
    ):
        status, out, err = run(capsys, *command, "--law", "formula")
        assert (status, out) == (2, "")
        assert words in err


@pytest.mark.slow
def test_steps_that_resolve_nothing_are_said_and_what_the_method_takes(here, capsys):
    text = read_scene("nu308_rigid").text.replace('duration = "0.2 s"', 'duration = "10 ms"')
    (here / "fine.toml").write_text(text)
    (here / "long.toml").write_text(text.replace('"20 us"', '"5 ms"').replace('sample = "0.1 ms"', 'sample = "5 ms"'))
    _, out, _ = run(capsys, "runup", "long.toml", "--law", "hertz")
    assert "warning: steps of 5 ms do not resolve what moves here: the lowest mode of the system is at 41.6 Hz" in out
    assert "it is excited with up to 157.6 Hz" in out and "take steps of 635 us or less" in out
    _, out, _ = run(capsys, "runup", "fine.toml", "--law", "hertz")
    assert "warning: steps" not in out
    assert "steps of 20 us: 10 a period at 5000 Hz; numerical damping (spectral radius 0.8) takes 47.7 % at 2500" in out


@pytest.mark.slow
def test_a_load_beyond_what_a_bearing_can_hold_is_status_1(here, capsys):
    (here / "a.toml").write_text(read_scene("nu308_rigid").text.replace('"100 N", "100 N"', '"1e9 N", "100 N"'))
    status, out, err = run(capsys, "statics", "a.toml")
    assert (status, out) == (1, "")
    assert "no equilibrium: on the way to it an element is moved farther than it can be (bearing force, pose" in err
    assert "check units and size of the loads" in err


def test_free_motions_have_no_frequency_and_no_damping_ratio(here, capsys):
    text = read_scene("n1014_rigid").text.replace("points = 2000", "points = 5")
    (here / "a.toml").write_text(text)
    options = ("a.toml", "--law", "hertz", "--clearance", "20 um")
    for command in (
        ("sweep", *options, "--speed", "500 rpm", "600 rpm", "2"),
        ("hammer", *options, "--hits", "2", "-o", "hits.uff"),
    ):
        status, out, _ = run(capsys, *command)
        assert status == 0
        assert re.search(r"\d\d free motions at 0 Hz without strain energy, such as unloaded rollers", out)
        assert not re.search(r"\de-(0[7-9]|[1-9]\d) +(to|Hz)|ratio -", out)


def test_records_of_hits_are_no_netcdf(here, capsys):
    status, _, err = run(capsys, "hammer", "nu308_rigid", "-o", "hits.nc")
    assert status == 2
    assert "-o: got hits.nc; allowed: a file that ends in .uff, .unv, .uf, .58" in err


@pytest.mark.slow
def test_no_equilibrium_is_status_1(here, capsys):
    text = read_scene("nu308_rigid").text.replace('against = "ring_left"\nforce', "force")
    text = text.replace('stiffness = { y = "1e5 N/m", z = "1e5 N/m" }', 'stiffness = { x = "1e5 N/m" }')
    (here / "free.toml").write_text(text)
    status, out, err = run(capsys, "statics", "free.toml")
    assert (status, out) == (1, "")
    assert "something moves freely under its load" in err


@pytest.mark.slow
def test_as_a_module(here):
    result = subprocess.run(
        [sys.executable, "-m", "mbs", "statics", "nu308_rigid", "--law", "hertz", "--bands", "numerics"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "141.421 N" in result.stdout


@pytest.mark.slow
def test_runs_in_time_say_how_quick_their_films_are(here, capsys, formula_maps):
    short = short_run(here, speed='"2000 rpm"')
    options = (short, "--map", formula_maps["NU308"], "--clearance", "20 um", "--films", "slow")
    status, out, _ = run(capsys, "runup", *options)
    assert status == 0
    found = re.search(r"slow films: .* estimated error of up to 5 % up to (?:.*, )?(\S+) Hz at 2000 rpm", out)
    # the run ends at the speed of the operation
    same = re.search(r"the load passes 5 % at (\S+) Hz", run(capsys, "statics", *options)[1])
    assert found is not None and same is not None
    assert found[1] == same[1]
    assert "films of slow" not in run(capsys, "runup", short)[1]
