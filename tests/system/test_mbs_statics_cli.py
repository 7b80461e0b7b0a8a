"""What `mbs statics` says of pressures, films, and of what does not hold."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import xarray as xr

from ehdmaps.jobs import cli as ehdmaps_cli
from mbs import Bearing
from mbs.scene.reader import read_scene
from tests.cases.commands import check_units, run
from tests.cases.jobs import WIDE
from tests.cases.reports import without_budget

STRAIGHT = ('profile = "iso"', 'profile = "straight"')
FREE_RING = ('freedoms = ["y", "z"]\nposition = ["-70 mm"', 'freedoms = ["x", "y", "z"]\nposition = ["-70 mm"')


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def scene(here, *changes):
    text = read_scene("nu308_rigid").text
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (here / "changed.toml").write_text(text)
    return "changed.toml"


def test_dry_contacts_have_a_pressure_and_no_film(here, capsys):
    status, out, _ = run(capsys, "statics", scene(here, STRAIGHT), "--law", "hertz", "-o", "a.nc")
    assert status == 0
    assert "  Hertz pressure up to 0.1" in out and "film down to" not in out and "warning" not in out
    with xr.open_dataset("a.nc") as data:
        check_units(data)
        assert data.attrs["warnings"] == ""
        assert np.all(np.isnan(data["minimum_film"]))
        geometry = Bearing.named("NU308").geometry
        text = next(line for line in out.splitlines() if "rollers loaded, the most with" in line)
        mean = float(text.split("the most with ")[1].split()[0]) / geometry.roller_length
        modulus = 210e9 / (1.0 - 0.3**2)
        found = data["hertz_pressure"].isel(bearing=0).values
        for pressure, radius in zip(found, (geometry.inner_radius, geometry.outer_radius), strict=True):
            # Closed form; the printed load has five digits.
            assert pressure == pytest.approx(math.sqrt(mean * modulus / (2.0 * math.pi * radius)), rel=1e-4)
        assert found[0] / found[1] == pytest.approx(math.sqrt(geometry.outer_radius / geometry.inner_radius))


def test_the_loads_of_all_loaded_rollers_are_listed(here, capsys):
    _, out, _ = run(capsys, "statics", "nu308_rigid", "--law", "hertz")
    line = next(line for line in out.splitlines() if line.startswith("  rollers, from y towards z: "))
    found = np.array(re.findall(r"([0-9.e+-]+) N at ([0-9.e+-]+) deg", line), dtype=float)
    assert np.all(np.diff(found[:, 0]) <= 0.0)
    angles = np.radians(found[:, 1])
    # Equilibrium with the preload; four digits are printed.
    assert found[:, 0] @ np.cos(angles) == pytest.approx(100.0, rel=1e-3)
    assert found[:, 0] @ np.sin(angles) == pytest.approx(100.0, rel=1e-3)


@pytest.mark.parametrize(
    "command",
    ["statics", "lsa", "sweep", pytest.param("report", marks=pytest.mark.slow), "bearing", "solve", "spectrum"],
)
def test_stiffness_damping_and_responses_have_the_units_of_engineers(here, capsys, monkeypatch, command):
    """One unit for each quantity: none of newtons a metre, which files have."""
    without_budget(monkeypatch)
    path = scene(here, ("points = 2000", "points = 3"), ("slices = 41", "slices = 5"))
    given = {
        "lsa": (command, path),
        "statics": (command, path, "--law", "constant:cfd"),
        "sweep": (command, path, "--law", "hertz:100 N s/m", "--speed", "500 rpm", "600 rpm", "2"),
        "report": (command, path, "--law", "constant:cfd", "-o", "page.html"),
        "bearing": (command, "nu308", "--load", "1 kN", "--speed", "900 rpm"),
    }
    if command in ("solve", "spectrum"):
        solve = ["solve", "nu308", "--load", "20 N", "--speed", "1 m/s", "--temperature", "40 degC"]
        more = ["--solver", "formula"] if command == "solve" else ["--frequency", "100 Hz", "1 kHz", "2"]
        assert ehdmaps_cli.main([*solve, "--length", "0.5 mm", *more]) == 0
        told = capsys.readouterr().out
    else:
        status, told, _ = run(capsys, *given[command])
        assert status == 0
    if command == "report":
        page = (here / "page.html").read_text(encoding="utf-8")
        told = re.sub(r"<details>.*?</details>|<[^>]*>", " ", page, flags=re.DOTALL).replace("\\u00b5", "µ")
        assert not re.search(r"\b(nan|inf|None)\b", told)
    expected = {
        "lsa": ("um/N", "m/s2/N"),
        "sweep": ("N/um", "N s/mm", "um/N", "c = 0.1 N s/mm"),
        "statics": ("N/um, N/urad; N m/um, N m/urad", "18 N/um and 0.015 N s/mm"),
        "report": ("N/µm, N/µrad; N m/µm, N m/µrad", "18 N/um and 0.015 N s/mm"),
        "bearing": ("N/um", "N s/mm"),
        "solve": ("N/(um mm)", "N s/mm2", "N/um ", "N s/mm "),
        "spectrum": ("N/(um mm)", "N s/mm2", "um mm/N", "N/um", "N s/mm"),
    }
    for unit in expected[command]:
        assert unit in told
    without = told.replace("rolling force          N/m", "")
    assert re.findall(r"(?:N|N s)/(?:\()?m2?(?![A-Za-z])|(?<![A-Za-zµ])m2?/N", without) == []


@pytest.mark.slow
@pytest.mark.parametrize("command", ["statics", "sweep", "variants", "report"])
def test_heads_say_whether_weight_is_in_the_equilibrium(here, capsys, monkeypatch, command):
    without_budget(monkeypatch)
    short = (
        ("points = 2000", "points = 3"),
        ('duration = "0.2 s"', 'duration = "0.05 s"'),
        ("slices = 41", "slices = 5"),
    )
    heavy = ("[operation]\n", '[operation]\ngravity = ["0 m/s^2", "3 m/s^2", "-4 m/s^2"]\n')
    more = {
        "sweep": ["--speed", "500 rpm", "600 rpm", "2"],
        "report": ["-o", "page.html"],
        "variants": ["--law", "hertz", "--law", "hertz:1e-6 s", "--vary", "clearance", "1 um"],
    }
    for changes, words in ((short, "without weight (no gravity in [operation])"), ((*short, heavy), "in y, -z)")):
        status, told, _ = run(capsys, command, scene(here, *changes), *more.get(command, []))
        assert status == 0
        assert words in ((here / "page.html").read_text(encoding="utf-8") if command == "report" else told)


@pytest.mark.slow
@pytest.mark.parametrize("law", ["map", "formula"])
def test_films_where_the_law_knows_them(here, capsys, formula_map, law):
    options = ("--map", formula_map) if law == "map" else ("--law", "formula")
    status, out, _ = run(capsys, "statics", "nu308_rigid", *options, "-o", "a.nc", "--plot", "a.png")
    assert status == 0
    assert "; film down to 0." in out
    with xr.open_dataset("a.nc") as data:
        assert np.all(data["minimum_film"] < data["central_film"])
        assert np.all(data["minimum_film"].sel(contact="inner") < data["minimum_film"].sel(contact="outer"))
        films = data["central_film"].values
    # `mbs bearing` at the same load, between two rollers as there, says the same.
    bearing = (
        "bearing",
        "NU308",
        "--clearance",
        "0 um",
        "--load",
        "141.421356 N",
        "--direction",
        "1",
        "1",
        "--speed",
        "500 rpm",
    )
    assert run(capsys, *bearing, *options, "-o", "b.nc")[0] == 0
    with xr.open_dataset("b.nc") as data:
        # The formula's law is made over other ranges there: its table's error.
        np.testing.assert_allclose(data["central_film"].values[0, 0], films[0], rtol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("law", ["map", "formula"])
def test_temperatures_without_a_viscosity_have_no_films(here, capsys, formula_map, law):
    name = scene(here, ('temperature = "40 degC"', 'temperature = "-30 degC"'))
    options = ("--map", formula_map) if law == "map" else ("--law", "formula")
    status, out, _ = run(capsys, "statics", name, *options)
    assert status == 1
    source = "the map" if law == "map" else "the table of the film formula"
    assert f"warning: bearing_left: lies outside {source} (temperature of -30 degC is outside {source} (" in out
    # The map's films are those of its edge, as its law is.
    assert ("film down to" in out) == (law == "map")


def test_a_speed_below_the_map_is_said(here, capsys, formula_map):
    name = scene(here, ('speed = "500 rpm"', 'speed = "2 rpm"'))
    status, out, _ = run(capsys, "statics", name, "--map", formula_map)
    assert status == 0
    assert "warning: 2 rpm lies below the map (entrainment speed below " in out
    assert "the film fades to the dry contact there" in out


def test_overload_is_no_silent_equilibrium(here, capsys):
    name = scene(here, ('"0 N", "100 N", "100 N"', '"0 N", "1e6 N", "0 N"'))
    status, out, _ = run(capsys, "statics", name, "-o", "a.nc", "--plot", "a.png")
    assert status == 1
    assert "warning: bearing_left: Hertz pressure of 12." in out
    assert "above 4 GPa, the static limit of ISO 76: permanent deformation" in out
    with xr.open_dataset("a.nc") as data:
        assert "bearing_right: Hertz pressure" in data.attrs["warnings"]
    assert (here / "a.png").stat().st_size > 10_000


@pytest.mark.slow
def test_what_moves_freely_is_said(here, capsys):
    name = scene(here, FREE_RING)
    status, out, _ = run(capsys, "statics", name, "-o", "a.nc")
    assert status == 0
    assert "warning: ring_left moves freely along x: its position is arbitrary" in out
    with xr.open_dataset("a.nc") as data:
        assert data.attrs["warnings"] == "ring_left moves freely along x: its position is arbitrary"


@pytest.mark.slow
def test_a_load_on_what_is_free_is_no_equilibrium(here, capsys):
    text = read_scene("nu308_rigid").text.replace(*FREE_RING)
    push = '\n[[loads]]\nname = "push"\non = "ring_left"\nforce = ["1e-9 N", "0 N", "0 N"]\n'
    (here / "pushed.toml").write_text(text + push)
    status, out, err = run(capsys, "statics", "pushed.toml", "-o", "a.nc")
    assert (status, out) == (1, "")
    assert "no equilibrium: ring_left moves freely along x, and a load of 1e-09 N acts that way" in err
    assert not (here / "a.nc").exists()


def test_one_map_by_another_structural_law(here, capsys, formula_map):
    """--structural-law gives what a map gives whose job had that law, in `mbs statics`, `sweep` and `bearing`."""
    (here / "half.toml").write_text(WIDE.replace('"iso16281"', '"half_space"'))
    assert ehdmaps_cli.main(["generate", "half.toml", "-o", "half.nc", "--workers", "1"]) in (0, 1)
    ways = {"iso": (formula_map,), "half": ("half.nc",), "chosen": (formula_map, "--structural-law", "half_space")}
    for name, (path, *options) in ways.items():
        status, out, _ = run(capsys, "statics", "nu308_rigid", "--map", path, *options, "-o", f"{name}.statics.nc")
        assert (status, "structural law half_space" in out) == (0, name != "iso")
        bearing = ("bearing", "NU308", "--load", "1 kN", "--speed", "500 rpm", "--map", path, *options)
        status, out, _ = run(capsys, *bearing, "-o", f"{name}.bearing.nc")
        assert (status, "structural law half_space" in out) == (0, name != "iso")
    found = {"statics": ("bearing_stiffness", "bearing_damping"), "bearing": ("stiffness_along", "damping_along")}
    for kind, variables in found.items():
        iso, half, chosen = (xr.open_dataset(f"{name}.{kind}.nc") for name in ways)
        for name in variables:
            largest = float(np.abs(half[name]).max())
            # Equilibria of two tables whose films differ in their last digits, to the tolerance of Newton's method.
            np.testing.assert_allclose(chosen[name], half[name], rtol=0.0, atol=1e-9 * largest)
            assert float(np.abs(iso[name] - half[name]).max()) > 1e-3 * largest


@pytest.mark.slow
@pytest.mark.parametrize("command", ["statics", "sweep", "bearing"])
def test_structural_laws_that_do_not_suit_are_refused(here, capsys, formula_map, command):
    given = ("NU308", "--load", "1 kN", "--speed", "500 rpm") if command == "bearing" else ("nu308_rigid",)
    status, _, err = run(capsys, command, *given, "--map", formula_map, "--structural-law", "half-space")
    assert status == 2
    assert "--structural-law: got 'half-space'" in err
    assert "allowed: iso16281, palmgren, half_space" in err
    # films of the film table take it; dry contacts are ISO 16281
    speeds = ("--speed", "500 rpm", "600 rpm", "2") if command == "sweep" else ()
    status, _, err = run(capsys, command, *given, *speeds, "--law", "hertz", "--structural-law", "palmgren")
    assert status == 2
    assert "--structural-law: got palmgren without a map; allowed: with --map MAP.nc" in err
