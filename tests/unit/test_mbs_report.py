"""Reports of scenes: loads of rollers, crossings, saved results, and what happens where something fails."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError
from mbs.bearings.force_at_point import RollerLoads
from mbs.cli import main
from mbs.output.files import write_dataset
from mbs.report.bearings import roller_drawing
from mbs.report.campbell import Lines, campbell, read_result, saved_campbell
from mbs.scene.reader import read_scene
from tests.cases.reports import Report, without_budget

HOSTILE = "<script>alert(1)</script><img src=x onerror=alert(2)>"
SPEEDS = np.linspace(50.0, 350.0, 7)


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def lines_at(*frequencies: float) -> Lines:
    """Modes whose frequencies do not change."""
    values = np.broadcast_to(frequencies, (SPEEDS.size, len(frequencies))).copy()
    number = np.arange(len(frequencies), dtype=np.float64)
    return Lines(SPEEDS, values, np.full(values.shape, 0.01), np.full(values.shape, 0.5), number)


def sweep_result(frequency: float) -> xr.Dataset:
    """What `mbs sweep -o` writes of one mode."""
    dims, shape = ("case", "speed", "complex_mode"), (1, SPEEDS.size, 1)
    values = {"complex_frequency": frequency, "complex_damping_ratio": 0.01, "complex_bearing_share": 0.5}
    variables = {name: (dims, np.full(shape, value)) for name, value in values.items()}
    number = {"complex_number": (("case", "complex_mode"), [[0.0]])}
    return xr.Dataset({**variables, **number}, coords={"speed": SPEEDS, "case": [HOSTILE]})


def test_bars_are_as_long_as_the_loads():
    angle, load = np.radians([0.0, 90.0, 180.0, -90.0]), np.array([50.0, 100.0, 0.0, 25.0])
    empty = np.zeros((4, 1))
    rollers = RollerLoads(angle, load, np.zeros(4), empty, empty, empty, np.zeros(1), np.zeros(4))
    report = Report(str(roller_drawing(rollers, np.array([0.0, 1.0]), "a", "Loads")))
    bars = [str(a["d"]) for a in report.named("path") if a.get("class") == "load"]
    ends = np.array([re.findall(r"[-0-9.]+", bar) for bar in bars], dtype=float)
    lengths = np.hypot(ends[:, 2] - ends[:, 0], ends[:, 3] - ends[:, 1])
    # places have a tenth of a pixel
    np.testing.assert_allclose(lengths / lengths[1], [0.5, 1.0, 0.25], atol=5e-3)
    # y to the right, z upwards
    assert ends[0, 2] > ends[0, 0] and ends[1, 3] < ends[1, 1] and ends[2, 3] > ends[2, 1]
    assert "3 of 4 rollers carry more than 1 % of the highest load. The one at 90° carries most" in report.words


def test_orders_meet_modes_where_they_should():
    # order n meets a mode of f Hz at 60 f/n rpm: of 2 that is 30 f
    text = Report(str(campbell(lines_at(60.0, 110.0, 900.0), [(2.0, "2")], 500.0, 340.0))).words
    assert (
        "Orders meet them 2 times; nearest to the operating speed is order 2 with mode 2 at 3300 rpm and 110 Hz" in text
    )
    assert "mode 3" not in text  # above what is drawn
    assert "No order that excites meets one of them here" in Report(str(campbell(lines_at(60.0), [], 500.0, 1.0))).words


def test_modes_that_end_are_drawn_as_far_as_they_are():
    lines = lines_at(100.0, 200.0)
    lines.frequency[3:, 0] = np.nan
    report = Report(str(campbell(lines, [(1.0, "1")], 500.0, None)))
    (data,) = report.charts.values()
    assert data["curves"][0] == [100, 100, 100, None, None, None, None]
    np.testing.assert_allclose(data["x"]["values"], 30.0 / math.pi * SPEEDS, rtol=6e-5)  # five digits


def test_saved_results_are_drawn(tmp_path):
    path = tmp_path / "sweep.nc"
    write_dataset(sweep_result(60.0), path)
    words = Report(str(saved_campbell(read_result(str(path)), [(2.0, "2")], 500.0, HOSTILE))).words
    assert f"From {HOSTILE}. " in words and "first order 2 with mode 1 at 1800 rpm and 60 Hz" in words
    level = np.full((1, 7, 50), 40.0)
    level[0, 5, 30] = 95.0
    sums = level.max(axis=2)
    run = xr.Dataset(
        {"level": (("law", "speed", "frequency"), level, {"units": "dB"}), "sum_level": (("law", "speed"), sums)},
        coords={"law": [HOSTILE], "speed": SPEEDS, "frequency": np.linspace(0.0, 500.0, 50)},
    )
    report = Report(str(saved_campbell(run, [(2.0, "2")], 500.0, "run.nc")))
    assert "The darkest class is 90 to 96 dB" in report.words and HOSTILE in report.words
    assert "The sum level is highest, 95 dB, at 2860 rpm" in report.words  # 300 rad/s, three digits
    darkest = [a for a in report.named("path") if a.get("fill") == "#0a1f44"]
    assert len(darkest) == 1 and str(darkest[0]["d"]).count("M") == 1


def test_all_cases_of_a_result_are_drawn():
    one = sweep_result(60.0)
    many = xr.concat([one.assign_coords(case=[f"case {n}"]) for n in range(8)], "case", data_vars="minimal")
    report = Report(str(saved_campbell(many, [(2.0, "2")], 500.0, "sweep.nc")))
    assert sorted(report.charts) == ["campbell", *(f"campbell-{n}" for n in range(2, 7))]
    assert (
        "Frequencies of the modes over speed, case 5" in report.words and "Not drawn: case 6, case 7." in report.words
    )


def test_other_files_are_no_results(tmp_path):
    (tmp_path / "text.nc").write_text("no netCDF")
    write_dataset(xr.Dataset({"a": 1.0}), tmp_path / "other.nc")
    for name, words in (("text.nc", "cannot be read"), ("none.nc", "no file"), ("other.nc", "holds no modes")):
        with pytest.raises(InputError, match=rf"--result: .*{words}.*allowed: a result of `mbs sweep -o`"):
            read_result(str(tmp_path / name))


def test_a_scene_with_dry_contacts(here, capsys, monkeypatch):
    without_budget(monkeypatch)
    dry = ("--law", "hertz")
    text = read_scene("nu308_rigid").text
    title = re.search(r'^title = "(.*)"$', text, re.MULTILINE)
    assert title
    (here / "mine.toml").write_text(text.replace(title[0], f'title = "{HOSTILE}"'))
    assert main(["report", "mine.toml", *dry, "--speed", "400 rpm", "600 rpm", "3"]) == 0
    assert capsys.readouterr().out == "mine.html: written\n"
    written = Path("mine.html").read_text()
    report = Report(written)
    report.check_alone(2)
    assert report.words.count(HOSTILE) >= 3  # heading, title of the window, text of the scene
    assert "law dry Hertz, ISO 16281" in report.words and "no map stands behind it" in report.words
    assert not re.search(r"\b(nan|inf|None)\b", report.words)
    # what `mbs statics` and `mbs modes` print
    assert main(["statics", "mine.toml", *dry]) == 0
    statics = capsys.readouterr().out
    life = re.search(r"L10r \S+ million turns", statics)
    assert life and life[0] in report.words
    loads = re.search(r"the most with ([0-9.]+) N", statics)
    assert loads and f"{float(loads[1]):.3g} N" in report.words
    assert main(["modes", "mine.toml", *dry]) == 0
    first = re.search(r"^ +1 +([0-9.]+) ", capsys.readouterr().out, re.MULTILINE)
    assert first and f"{float(first[1]):.5g}" in report.words
    assert main(["report", "mine.toml", *dry, "--speed", "400 rpm", "600 rpm", "3"]) == 0
    assert Path("mine.html").read_text() == written


def test_all_problems_at_once(here, capsys):
    (here / "mine.html").write_text("<p>mine</p>")
    words = ["--speed", "1 rpm", "x", "3", "--result", "none.nc", "--law", "nothing", "-o", "mine.html"]
    assert main(["report", "nu308_rigid", *words]) == 2
    told = capsys.readouterr().err
    for part in (
        "--speed: got 'x'",
        "--result: none.nc",
        "leave one of them out",
        "nothing",
        "not a report of ehdmaps",
    ):
        assert part in told
    assert (here / "mine.html").read_text() == "<p>mine</p>"


@pytest.mark.slow
def test_without_an_equilibrium_nothing_is_written(here, capsys):
    text = read_scene("nu2210_shaft").text
    assert '"-2 kN"' in text
    (here / "heavy.toml").write_text(text.replace('"-2 kN"', '"-9e8 N"'))
    assert main(["report", "heavy.toml"]) == 1
    assert "no equilibrium" in capsys.readouterr().err
    assert not (here / "heavy.html").exists()
