"""Rotors as a user meets them: critical speeds, matrices over speed, and a drive, on the command line."""

from __future__ import annotations

import re

import numpy as np
import pytest
import xarray as xr

from tests.cases.commands import run
from tests.cases.masses import masses_on

DAMPED = ("--law", "hertz:1.25e-5 s")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_critical_speeds_of_the_shipped_rotor(here, capsys):
    asked = ("--speed", "8000 rpm", "15000 rpm", "8", "--cage-angles", "1", "-o", "rotor.nc", "--plot", "rotor.png")
    status, out, _ = run(capsys, "critical", "overhung_rotor", *DAMPED, *asked)
    assert status == 0
    assert "9539.5 rpm" in out
    assert "backward (-0.97)" in out
    assert "none: along or about the axis" in out
    assert "orbit of rotor:wheel" in out
    assert re.search(
        r"warning: front: order 1: the dynamic load of the bearing, .* N, exceeds its static one of 248.9 N", out
    )
    with xr.open_dataset(here / "rotor.nc") as found:
        assert found.attrs["loads"] == "order 1: residual; order 5: blades"
        assert found["orbit_major"].dims == ("order", "speed", "place")
        assert np.all(found["orbit_major"] >= np.abs(found["orbit_minor"]))
        peak = float(found["speed"][np.argmax(found["orbit_major"].sel(order=1, place="rotor:wheel").values)])
        # The speeds around a critical one are half its damping ratio apart.
        assert np.min(np.abs(found["critical_speed"].values / peak - 1.0)) < 2e-3
    assert (here / "rotor.png").stat().st_size > 10_000


@pytest.mark.slow
def test_critical_speeds_of_several_laws_in_one_table(here, capsys):
    """Each law has in the table, and in the file, what it has alone."""
    speeds = ("--speed", "9300 rpm", "9700 rpm", "2", "--cage-angles", "1", "-o", "rotor.nc")
    laws = ("--law", "hertz", *DAMPED)
    status, out, _ = run(capsys, "critical", "overhung_rotor", *laws, *speeds, "--plot", "rotor.png")
    assert status == 0
    table = out[out.index("critical speeds") :]
    assert [line.split()[3] for line in table.splitlines()[1:3]] == ["9539.4", "9539.5"]
    assert "   law\n" in table
    assert "backward (-0.97)                 dry Hertz, c = 12.5 us times k\n" in table
    with xr.open_dataset("rotor.nc") as data:
        found = data.load()
    assert found["critical_speed"].dims == ("law", "critical")
    assert run(capsys, "critical", "overhung_rotor", *DAMPED, *speeds)[0] == 0
    with xr.open_dataset("rotor.nc") as alone:
        ours = found.isel(law=1).sel(speed=alone["speed"])
        # Rounding: the same equations at the same speeds.
        np.testing.assert_allclose(ours["orbit_major"], alone["orbit_major"], rtol=1e-9)
        np.testing.assert_allclose(
            ours["critical_speed"].dropna("critical"), alone["critical_speed"].values, rtol=1e-12
        )
    assert (here / "rotor.png").stat().st_size > 10_000


@pytest.mark.parametrize("command", ["statics", "modes"])
def test_bearings_by_matrices_beside_others(here, capsys, command):
    status, out, err = run(capsys, command, "overhung_rotor", *DAMPED)
    assert status == 0, out + err


def _scene(here, *changes):
    from importlib import resources

    text = (resources.files("mbs") / "systems" / "overhung_rotor.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (here / "own.toml").write_text(text, encoding="utf-8")


@pytest.mark.slow
def test_a_drive_is_told(here, capsys):
    _scene(here, ('duration = "2.5 s"', 'duration = "4 ms"'))
    status, out, _ = run(capsys, "runup", "own.toml", *DAMPED)
    assert status == 0
    assert "drive: the motor gave" in out


def test_a_speed_beyond_a_table_is_a_warning(here, capsys):
    _scene(
        here,
        ('x = "5e7 N/m", y = "1e5 N/m"', 'x = "5e7 N/m", y = ["1e5 N/m", "2e5 N/m"]'),
        ('name = "locating"', 'name = "locating"\nspeeds = ["0 rpm", "1000 rpm"]'),
    )
    status, out, _ = run(capsys, "statics", "own.toml", *DAMPED)
    assert status == 1
    assert "warning: locating: lies outside its table of speeds, where it is held at its edge; give it" in out


@pytest.mark.slow
def test_no_critical_speed_without_spin_or_speeds(here, capsys):
    _scene(here, ('[sweep]\nfrom = "300 rpm"\nto = "15000 rpm"\npoints = 50\nassumed = ["from", "to"]\n', ""))
    status, _, err = run(capsys, "critical", "own.toml")
    assert (status, "no speeds" in err) == (2, True)


@pytest.mark.slow
def test_a_mode_without_films_has_bands_of_zero(here, capsys):
    """The axial mode strains the locating spring alone: its error is what the cut-off of the shaft leaves out."""
    status, out, _ = run(capsys, "modes", "overhung_rotor", "--law", "table", "-o", "modes.nc")
    axial = next(int(line.split()[0]) - 1 for line in out.splitlines() if "locating 97.4 %" in line)
    assert status == 0
    with xr.open_dataset(here / "modes.nc") as found:
        for name in ("frequency", "damping_ratio"):
            error, left_out = found[f"{name}_error"].values, np.abs(found[f"{name}_reduction"].values)
            assert error[axial] == pytest.approx(left_out[axial], rel=1e-6) and left_out[axial] > 0.0
            assert np.count_nonzero(error > 1.001 * left_out) > 3  # the others have films


@pytest.mark.slow
def test_run_writes_all_that_it_computes(here, capsys):
    """Without -o into a folder here, with critical speeds where there are speeds."""
    sweep = '[sweep]\nfrom = "1000 rpm"\nto = "3000 rpm"\npoints = 3\n'
    (here / "own.toml").write_text(masses_on("6208") + sweep)
    status, said, _ = run(capsys, "run", "own.toml")
    assert status == 0
    names = ("statics", "modes", "sweep", "critical")
    written = {path.name for path in (here / "own_results").iterdir()}
    assert written == {f"{name}.{end}" for name in names for end in ("nc", "png", "txt")} - {"statics.png"} | {
        "report.html",
        "report.txt",
    }
    assert all(f"own_results/{name}: written" in said for name in written)
    with xr.open_dataset("own_results/critical.nc") as found:
        assert {"critical_speed", "response_real"} & set(found.variables)
