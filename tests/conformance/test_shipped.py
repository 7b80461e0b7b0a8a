"""Every shipped scene, with fewer points and a short run-up: `mbs run` with all its analyses."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import mbs
from mbs import shipped_systems
from tests.cases.commands import run
from tests.cases.reports import without_budget

SYSTEMS = Path(mbs.__file__).parent / "systems"

SHORTER = (
    (r"points = \d{3,}", "points = 12"),  # of frequencies
    (r"points = \d\d\b", "points = 2"),  # of speeds
    (r"slices = \d+", "slices = 3"),
    (r'(?<=duration = )"[^"]*"', '"40 ms"'),
    (r'(?<=\nstep = )"[^"]*"', '"100 us"'),
    (r'(?<=\nsample = )"[^"]*"', '"100 us"'),
    (r'(?<=\nhighest = )"[^"]*"', '"2 kHz"'),
)

DRY = ("gearbox", "n1014_rigid", "nu2210_shaft", "overhung_rotor", "spindle", "two_stage")
"""Scenes whose bearings others have too, with films: `nu308_flexible`, `electric_drive`, `n1014_testrig`."""

BUDGETS = ("nu308_rigid",)
"""The scene whose page has an error budget, with a law for each of its lines."""


@pytest.fixture
def shortened(tmp_path, monkeypatch):
    """Writes a short copy of a scene, with the bodies that it reads beside it; of figures all but the picture."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("matplotlib.figure.Figure.savefig", lambda figure, path, **_: path.write_bytes(b"drawn"))
    for body in SYSTEMS.glob("*.nc"):
        (tmp_path / body.name).symlink_to(body)

    def write(name):
        text = (SYSTEMS / f"{name}.toml").read_text(encoding="utf-8")
        for pattern, short in SHORTER:
            text = re.sub(pattern, short, text)
        Path("scene.toml").write_text(text, encoding="utf-8")
        return text

    return write


@pytest.mark.slow
@pytest.mark.parametrize("name", shipped_systems())
def test_every_analysis_of_a_shipped_scene(name, shortened, capsys, monkeypatch):
    """Of two speeds and 400 steps: whatever ends with another status than 0 says why."""
    text = shortened(name)
    monkeypatch.setattr("mbs.budget.SUPPLIES", ("oil air",))  # of three, with a law for each
    if name not in BUDGETS:
        without_budget(monkeypatch)
    law = ("--law", "hertz:1.25e-5 s") if name in DRY else ()
    status, out, err = run(capsys, "run", "scene.toml", "-o", "folder", *law)
    beyond = re.search(r"^(error: |warning: .*held at)", out, re.MULTILINE)  # a map that ends, or steps too coarse
    assert status == (1 if beyond else 0), err or out
    assert "no result" not in out and "nan" not in out.lower().split()
    analyses = ["statics", "modes", "lsa", *["sweep", "critical"] * ("[sweep]" in text)]
    for analysis in analyses:
        assert f"=== mbs {analysis} scene.toml" in out and Path(f"folder/{analysis}.nc").exists()
    page = Path("folder/report.html").read_text(encoding="utf-8")
    assert ("mbs tradeoff measures more" in page) == (name in BUDGETS)
    assert "=== mbs campbell" in out or "=== mbs runup" in out


@pytest.mark.slow
def test_critical_speeds_of_a_scene_without_a_sweep(shortened, capsys):
    assert "[sweep]" not in shortened("nu308_rigid")
    status, out, err = run(capsys, "critical", "scene.toml", "--speed", "600 rpm", "1200 rpm", "2")
    assert status == 0, err or out
