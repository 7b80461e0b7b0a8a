"""The command `mbs campbell`: laws side by side, orders of the gears, and what is refused before it runs."""

from __future__ import annotations

import argparse
import importlib
from importlib import resources

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import AnalysisError, InputError
from mbs import assemble, campbell, read_scene
from mbs.spectral.levels import difference_text
from mbs.transient.run import run
from tests.cases.run_up import refused


def arguments(scene, **values):
    names = (
        "law",
        "map",
        "clearance",
        "output",
        "plot",
        "sensor",
        "highest",
        "window",
        "bands",
        "tolerance",
        "waterfall",
    )
    return argparse.Namespace(
        **{**dict.fromkeys(names), "modes": False, "workers": 1, "executor": None, "scene": str(scene), **values}
    )


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """The shipped NU308 with a short run."""
    text = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
    path = tmp_path_factory.mktemp("scene") / "short.toml"
    path.write_text(
        text.replace('from = "0 rpm"', 'from = "2000 rpm"')
        .replace('to = "2000 rpm"', 'to = "5000 rpm"')
        .replace('duration = "0.2 s"', 'duration = "0.08 s"')
        .replace('sample = "0.1 ms"', "")
        .replace("slices = 41", "slices = 5")
    )
    return path


def run_command(*values, **more):
    return importlib.import_module("mbs.commands.campbell").run(arguments(*values, **more))


def test_the_command_compares_laws(scene, tmp_path, capsys):
    out, plot = tmp_path / "out.nc", tmp_path / "figure.png"
    text, status = run_command(
        scene, law=["hertz", "constant:hertz"], clearance=["20 um"], output=str(out), plot=str(plot), modes=True
    )
    assert status == 0
    assert "sensor S1, dB re 1e-06 m/s2" in text
    assert text.count("highest sum level") == 2
    with xr.open_dataset(out) as data:
        dry, other = data["sum_level"].values
    # told at the same speed, and not only where each is highest
    assert f"  constant hertz beside dry Hertz: {difference_text(dry, other)}" in text
    assert f"median {np.median(other - dry):.1f} dB" in text
    assert plot.stat().st_size > 10_000
    with xr.open_dataset(out) as data:
        assert data["law"].values.tolist() == ["dry Hertz", "constant hertz"]
        assert np.all(np.isfinite(data["level"]))
        # Rollers pass 12 times a turn of the cage.
        assert data["track"].values[0] == pytest.approx(12.0 * 0.3939, rel=1e-3)  # digits of the cage's speed
        assert data.attrs["law"].startswith("dry Hertz: dry Hertz, ISO 16281; constant hertz: constant hertz: ")
    assert capsys.readouterr().out == ""


@pytest.mark.slow
def test_the_command_lists_every_problem(scene):
    problems = refused(
        lambda: run_command(
            scene, law=["hertz", "hertz", "nonsense", "formula", "map"], clearance=["20 kg"], window="3 m"
        ),
        "--law: got 'hertz' twice",
        "--law: got 'nonsense'",
        "--clearance",
        "--window: got the unit 'm'",
    )
    assert len(problems) == len(set(problems))
    laws = ["hertz", "constant:hertz", "constant:reynolds", "constant:cfd"]
    refused(
        lambda: run_command(scene, law=laws, clearance=["0 um", "20 um"]), "got 8 combinations; allowed: up to 4 side"
    )
    refused(
        lambda: run_command(scene, sensor="aproach", highest="50 kHz", window="3 m"),
        "sensor 'aproach' is not there (did you mean 'approach'?); allowed: S1, approach",
        "step: got 20 us; allowed: up to 8 us for frequencies up to 50000 Hz",
        "--window: got",
    )
    refused(lambda: run_command(scene, plot="figure.xyz"), "--plot: got figure.xyz; allowed: a file that ends in .png")
    refused(lambda: run_command(scene, highest="1 nHz"), "--highest: got '1 nHz'; allowed: 1 Hz to 1e+06 Hz")


@pytest.mark.slow
def test_orders_above_the_band_are_left_out(scene, tmp_path):
    out, path = tmp_path / "out.nc", tmp_path / "longer.toml"
    path.write_text(scene.read_text().replace('"0.08 s"', '"0.25 s"'))
    # Rollers pass 4.73 times a turn, which is 158 Hz at 2000 rpm and twice that for the second harmonic.
    run_command(path, law=["hertz"], highest="250 Hz", output=str(out))
    with xr.open_dataset(out) as data:
        np.testing.assert_allclose(data["track"], [4.727], rtol=1e-3)  # digits


GEARS = """
schema = 1
[operation]
speed = "1000 rpm"
temperature = "60 degC"
[[bodies]]
name = "first"
freedoms = ["y", "z", "theta_x"]
position = ["0 mm", "0 mm", "0 mm"]
spin = -2
mass = "2 kg"
polar_inertia = "0.01 kg m^2"
transverse_inertia = "0.01 kg m^2"
[[bodies]]
name = "second"
freedoms = ["y", "z", "theta_x"]
position = ["0 mm", "99 mm", "0 mm"]
spin = 1.826086956521739
mass = "2 kg"
polar_inertia = "0.01 kg m^2"
transverse_inertia = "0.01 kg m^2"
[[springs]]
name = "hold_first"
on = "first"
stiffness = { y = "1e8 N/m", z = "1e8 N/m", theta_x = "10 N m/rad" }
damping = { y = "500 N s/m", z = "500 N s/m" }
[[springs]]
name = "hold_second"
on = "second"
stiffness = { y = "1e8 N/m", z = "1e8 N/m", theta_x = "10 N m/rad" }
damping = { y = "500 N s/m", z = "500 N s/m" }
[[loads]]
name = "drive"
on = "first"
moment = ["82 N m", "0 N m", "0 N m"]
[[loads]]
name = "brake"
on = "second"
moment = ["89.8 N m", "0 N m", "0 N m"]
[[gears]]
name = "mesh"
on = "first"
against = "second"
teeth = [21, 23]
module = "4.5 mm"
pressure_angle = "20 deg"
face_width = "25 mm"
stiffness = "14 N/(um mm)"
damping = "1e3 N s/m"
backlash = "0.1 mm"
transmission_error = ["0.5 um"]
[[sensors]]
name = "top"
on = "second"
direction = "y"
quantity = "acceleration"
[campbell]
highest = "3 kHz"
[runup]
from = "500 rpm"
to = "1500 rpm"
duration = "0.3 s"
step = "40 us"
"""


def test_orders_are_those_of_the_gears(tmp_path):
    out, path = tmp_path / "out.nc", tmp_path / "gears.toml"
    path.write_text(GEARS)
    assert run_command(path, output=str(out))[1] == 0
    with xr.open_dataset(out) as data:
        # 21 teeth on a shaft that turns twice as fast as the system.
        np.testing.assert_allclose(data["track"], 42.0 * np.arange(1, 6))
        # Each stands out of the orders half way to the next one; by more than 25 dB in a longer run.
        order, level = data["order"].values, data["order_level"].values[0]
        for mesh in (42.0, 84.0, 126.0):
            assert np.interp(mesh, order, level) > np.interp(mesh + 21.0, order, level) + 10.0
        assert data.attrs["sensor"] == "top"


def test_options_go_before_the_scene(tmp_path):
    out, path = tmp_path / "out.nc", tmp_path / "gears.toml"
    path.write_text(GEARS.replace('highest = "3 kHz"', 'highest = "3 kHz"\nwindow = "20 ms"\norders = [42]'))
    run_command(path, output=str(out), highest="2 kHz", window="30 ms")
    with xr.open_dataset(out) as data:
        assert data.attrs["window_s"] == pytest.approx(0.03, rel=1e-2)  # whole samples
        assert 1950.0 < data["frequency"][-1] <= 2000.0
        np.testing.assert_array_equal(data["track"], [42.0])


def test_the_command_needs_a_run_and_a_sensor(scene, tmp_path):
    text = scene.read_text()
    path = tmp_path / "still.toml"
    path.write_text(text[: text.index("[runup]")].replace('"acceleration"', '"velocity"'))
    refused(
        lambda: run_command(path), "[runup] missing", "has no sensor of an acceleration; allowed: one of S1, approach"
    )


@pytest.mark.slow
def test_the_command_refuses_a_constant_speed(scene, tmp_path):
    path = tmp_path / "constant.toml"
    path.write_text(scene.read_text().replace('to = "5000 rpm"', 'to = "2000 rpm"'))
    refused(lambda: run_command(path), "allowed: a ramp from one speed to another", "mbs lsa")


@pytest.mark.slow
def test_the_command_looks_at_the_window_before_it_runs(scene, monkeypatch):
    command = importlib.import_module("mbs.analyses.ramp")
    monkeypatch.setattr(command, "run_system", lambda *_, **__: pytest.fail("ran"))
    refused(lambda: run_command(scene, window="1 s"), "spectra, window: got 1.0 s")


def test_a_law_without_a_result_leaves_the_others(scene, monkeypatch):
    command = importlib.import_module("mbs.analyses.ramp")
    first = []

    def fails_once(*values, **more):
        if not first:
            first.append(True)
            raise AnalysisError("no solution at 0.1 s")
        return run(*values, **more)

    monkeypatch.setattr(command, "run_system", fails_once)
    text, status = run_command(scene, law=["hertz", "constant:hertz"])
    assert status == 1
    assert "warning: dry Hertz: no solution at 0.1 s" in text
    assert text.count("highest sum level") == 1
    monkeypatch.setattr(command, "run_system", fails_once)
    first.clear()
    with pytest.raises(AnalysisError, match="dry Hertz: no solution"):
        run_command(scene, law=["hertz"])


def test_a_drive_takes_each_law_to_speeds_of_its_own():
    scene = read_scene("overhung_rotor")
    models = [assemble(scene, law) for law in ("hertz", "hertz:1.25e-5 s")]
    for given, bands in ((models, 0), (models[:1], 1)):
        with pytest.raises(
            InputError, match=r"\[drive\]: got . cases and . runs of bands; allowed: one case"
        ) as caught:
            campbell(given, bands=bands)
        assert "mbs variants" in str(caught.value)
