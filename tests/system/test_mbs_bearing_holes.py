"""`mbs bearing` with a list in which one point has no answer: the others stand, for every kind of bearing."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tests.cases import commands

KINDS = {
    "rollers": ("NU1005",),
    "balls": ("6208",),
    "angular contact": ("7208B", "--axial", "1 kN"),
    "tapered": ("32208", "--axial", "600 N"),
    "between ribs": ("NUP210", "--axial", "1 kN"),
}
DRY = ("--law", "hertz", "--speed", "1 rpm", "--speed", "1000 rpm")
LOADS = ("--load", "1e7 N", "--load", "1 kN")
"""The first one is beyond what any of them can carry."""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def run(capsys, *arguments):
    return commands.run(capsys, "bearing", *arguments)


@pytest.mark.parametrize("kind", KINDS)
def test_one_failed_load_keeps_the_others(capsys, kind) -> None:
    ask = (*KINDS[kind], *DRY)
    status, out, _ = run(capsys, *ask, *LOADS, "-o", "both.nc")
    assert status == 1 and out.count("no answer") == 2
    assert "warning: no equilibrium of" in out and "(2 of 4 points" in out
    run(capsys, *ask, "--load", "1 kN", "-o", "alone.nc")
    both, alone = xr.load_dataset("both.nc"), xr.load_dataset("alone.nc")
    np.testing.assert_array_equal(both["load"], [1e3, 1e7])
    for name, values in alone.data_vars.items():
        np.testing.assert_array_equal(both[name].sel(load=1e3), values.sel(load=1e3), err_msg=str(name))
        hole = both[name].sel(load=1e7)
        assert (
            np.all(hole.isnull()) if hole.dtype.kind == "f" else all("no equilibrium" in text for text in hole.values)
        )
    status, _, err = run(capsys, *ask, "--load", "1e7 N")
    assert status != 0 and "no equilibrium of" in err


def test_a_slow_speed_and_one_at_which_it_falls_apart(capsys) -> None:
    """1 rpm, where idle rollers are pressed by less than a micronewton, and centrifugal loads that take it apart."""
    ask = ("32208", "--load", "2 kN", "--axial", "600 N", "--speed", "1 rpm", "--speed", "19000 rpm", "--law", "hertz")
    status, _, _ = run(capsys, *ask, "-o", "a.csv")
    rows = list(csv.DictReader(line for line in Path("a.csv").read_text().splitlines() if line[0] != "#"))
    assert status == 1 and len(rows) == 2
    assert float(rows[0]["stiffness_along [N/m]"]) > 1e8 and not rows[0]["outside"]
    assert rows[1]["stiffness_along [N/m]"] == "" and "falls apart" in rows[1]["outside"]
    status, _, err = run(capsys, *ask, "-o", "a.toml")
    assert status != 0 and "a.toml: not written: 1 of 2 points have no answer" in err
