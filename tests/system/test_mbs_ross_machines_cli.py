"""Machines with little damping through the commands, from the files that ROSS wrote; figures beside those of ROSS."""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tests.cases.commands import run

TESTS = Path(__file__).parents[1]
ROSS = tomllib.loads((TESTS / "references" / "ross_machines.toml").read_text(encoding="utf-8"))
NAMES = ("rotor", "compressor", "seal", "mounts", "fan")

MORE = """
[[unbalances]]
name = "unbalance"
on = "rotor"
at = "{place!r} m"
moment = "{moment} kg m"

[[sensors]]
name = "wheel"
on = "rotor:unbalance"
direction = "y"
quantity = "acceleration"

[runup]
from = "{begin} rad/s"
to = "{end} rad/s"
duration = "60 ms"
step = "0.1 ms"
sample = "0.2 ms"

[campbell]
window = "20 ms"
highest = "1 kHz"
"""


@pytest.fixture(scope="module", params=NAMES)
def machine(request, tmp_path_factory):
    """Name and folder of a machine whose scene was written by `mbs import`, with an unbalance and a run-up."""
    from mbs import cli

    name, folder = request.param, tmp_path_factory.mktemp(request.param)
    scene, case = folder / "scene.toml", ROSS[name]
    assert cli.main(["import", str(TESTS / "data" / "ross" / f"{name}.toml"), "-o", str(scene)]) == 0
    speeds = case["speeds"]
    text = scene.read_text(encoding="utf-8")
    text = re.sub(r'(?m)^speed = ".*?"', f'speed = "{speeds[1]!r} rad/s"', text)
    text = re.sub(r"(?ms)^\[linear\].*", "[linear]\nfrequencies = " + repr([f"{f} Hz" for f in range(5, 400, 5)]), text)
    more = MORE.format(place=case["place"], moment=ROSS["unbalance"], begin=speeds[1], end=1.05 * speeds[1])
    scene.write_text(text + more, encoding="utf-8")
    return name, scene


def went(capsys, *arguments):
    """Output of a command that went well."""
    status, out, err = run(capsys, *map(str, arguments))
    assert status == 0, err
    assert "unsound" not in out
    return out


def test_check_and_statics(machine, capsys):
    _, scene = machine
    for command in ("check", "statics"):
        assert went(capsys, command, scene)


def test_modes_have_the_damping_of_ross(machine, capsys):
    name, scene = machine
    out = scene.with_name("modes.nc")
    went(capsys, "modes", scene, "--highest", "600 Hz", "-o", out)
    wanted = np.array(ROSS[name]["eigenvalues"][1]) @ np.array([1, 1j])
    wanted = wanted[np.abs(wanted) < 2.0 * math.pi * 380.0]
    with xr.open_dataset(out) as dataset:
        frequency, ratio = dataset["frequency"].to_numpy(), dataset["damping_ratio"].to_numpy()
    near = np.argmin(np.abs(frequency[:, None] - np.abs(wanted)[None, :] / (2.0 * math.pi)), axis=0)
    np.testing.assert_allclose(frequency[near], np.abs(wanted) / (2.0 * math.pi), rtol=2e-4)
    np.testing.assert_allclose(ratio[near], -wanted.real / np.abs(wanted), atol=2e-4)


def test_critical(machine, capsys):
    name, scene = machine
    case = ROSS[name]
    said = went(capsys, "critical", scene, "--speed", f"{case['from']!r} rad/s", f"{case['to']!r} rad/s", "6")
    numbers = np.array([float(word) for word in re.findall(r"\d+(?:\.\d+)?", said)])
    for _, speed in case["critical"]:
        # Printed with four digits; where a coarse sweep loses none of them.
        assert np.min(np.abs(numbers / (speed * 30.0 / math.pi) - 1.0)) < 5e-4, speed


def test_hammer(machine, capsys):
    _, scene = machine
    hits = scene.with_name("hits.uff")
    went(
        capsys,
        "hammer",
        scene,
        "--hits",
        "1",
        "--highest",
        "400 Hz",
        "--duration",
        "2 s",
        "--noise",
        "0",
        "-o",
        hits,
        "--workers",
        "1",
    )
    assert hits.stat().st_size > 1000


def test_runup_and_campbell(machine, capsys):
    """Little is dissipated, so that the balance of energy judges the run.

    Its residual is of second order in the step, (2 pi f h)^2/12 = 0.5 % at 400 Hz, up to which the machines answer.
    Levels of all that happens are between nothing and the largest acceleration.
    """
    _, scene = machine
    out = scene.with_name("run.nc")
    said = went(capsys, "runup", scene, "-o", out)
    assert float(re.search(r"residual .* J, ([\d.e-]+) %", said)[1]) < 0.5
    said = went(capsys, "campbell", out)
    assert "no contact law" in said
    level = float(re.search(r"highest sum level ([\d.]+) dB", said)[1])
    with xr.open_dataset(out) as dataset:
        signal = dataset["signal"].sel(sensor="wheel").to_numpy()
    assert 0.0 < level < 20.0 * math.log10(np.max(np.abs(signal)) / 1e-6)
