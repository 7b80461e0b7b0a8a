"""Pictures and pages of machines and maps with the longest names: nothing is cut off, no title lies on another."""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path

import pytest

from ehdmaps.errors import LONGEST_LABEL
from ehdmaps.figures import legend_columns
from ehdmaps.jobs import cli as jobs_cli
from ehdmaps.physics.catalogue import estimate
from mbs import cli
from tests.cases.jobs import map_job
from tests.cases.pictures import cut_off, drawn, on_each_other, titles
from tests.cases.reports import without_budget

LABEL = "Bearing of the maker in the north, batch of the year 2019, C3"[:LONGEST_LABEL]
OIL = "Gear oil of the store room, mineral, grade ISO VG 46, batch 12"[:LONGEST_LABEL]
TITLE = "Test rig of the institute for machine elements: a rigid shaft on two types of roller bearings, built in 2019"
TYPES = ("NU2210", "NU2310")
SENTENCE = "inner geometry estimated from catalogue dimensions"
MAPS = ("--map", "NU2210.nc", "--map", "NU2310.nc")

LUBRICANT = f"""
[lubricant]
viscosity_law = "roelands"
label = "{OIL}"
viscosity_40 = "46 mm^2/s"
viscosity_100 = "6.8 mm^2/s"
density = "870 kg/m^3"
pressure_viscosity = "20 1/GPa"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Maps of two estimated bearings, and a machine on both."""
    folder = tmp_path_factory.mktemp("long")
    job = map_job(
        '["1 N/mm", "10 N/mm", "100 N/mm", "400 N/mm"]', '["0.1 m/s", "0.5 m/s", "2 m/s", "10 m/s"]', '["40 degC"]'
    )
    job = re.sub(r"\[lubricant\][^\[]*", LUBRICANT, job)
    for name in TYPES:
        given = re.sub(r"\[bearing\][^\[]*", f'[bearing]\nestimate = "{name}"\nlabel = "{LABEL}"\n', job)
        (folder / f"{name}.toml").write_text(given)
        assert jobs_cli.main(["generate", f"{folder}/{name}.toml", "-o", f"{folder}/{name}.nc", "--workers", "1"]) == 0
    text = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
    text = text.replace("NU308: rigid shaft on two bearings", TITLE).replace("slices = 41", "slices = 5")
    text = re.sub(r"\[lubricant\][^\[]*?\n\n", f"{LUBRICANT}\n", text).replace("points = 2000", "points = 40")
    for name in TYPES:
        text = text.replace('name = "NU308", d', f'estimate = "{name}", label = "{LABEL}", d', 1)
    (folder / "machine.toml").write_text(text)
    return folder


def looked_at(figures):
    """Fail where a text runs out of a picture, or a title lies on another one."""
    assert figures
    for figure in figures:
        assert cut_off(figure) == []
        assert on_each_other(titles(figure)) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    "command",
    [
        ("modes", "--shapes", "a.png", "--plot", "b.png"),
        ("sweep", "--law", "hertz:1e-6 s", "--films", "slow", "--films", "memory", "--clearance", "0 um",
         "--clearance", "20 um", "--speed", "500 rpm", "600 rpm", "2", "--plot", "a.png"),
    ],
    ids=lambda command: " ".join(command[:2]) + (" cases" if len(command) > 12 else ""),
)  # fmt: skip
def test_of_a_machine(folder, monkeypatch, capsys, command):
    monkeypatch.chdir(folder)
    name, *more = command
    with drawn() as figures:
        assert cli.main([name, "machine.toml", *MAPS, *more]) in (0, 1)
    looked_at(figures)
    printed = capsys.readouterr().out
    assert "NU2210 (bearing_left): " + estimate("NU2210").estimated in printed


@pytest.mark.slow
def test_of_a_map(folder, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    with drawn() as figures:
        assert jobs_cli.main(["plot", "NU2210.nc", "-o", "a.png"]) == 0
        assert jobs_cli.main(["plot", "NU2210.nc", "--roughness", "0.2 um", "-o", "b.png"]) == 0
    looked_at(figures)
    texts = [words for words, _ in titles(figures[0])]
    assert f"EHD contact map: {LABEL}, oil {OIL}" in texts
    assert sum(SENTENCE in words for words in texts) == 1


@pytest.mark.slow
def test_headings_of_reports_are_short_and_say_once_what_is_estimated(folder, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    without_budget(monkeypatch)
    assert jobs_cli.main(["report", "NU2210.nc", "-o", "map.html"]) == 0
    assert cli.main(["report", "machine.toml", *MAPS, "-o", "machine.html"]) in (0, 1)
    for name, count in (("map.html", 1), ("machine.html", None)):
        page = Path(name).read_text(encoding="utf-8")
        headings = re.findall(r"<(?:title|h[1-6])[^>]*>(.*?)</", page)
        assert headings and not any(SENTENCE in words for words in headings)
        shown = re.sub(r"<details>.*?</details>", "", page, flags=re.DOTALL)
        assert SENTENCE in shown and (count is None or shown.count(SENTENCE) == count)


def test_a_legend_has_as_many_columns_as_there_is_room_for():
    assert [legend_columns(["a" * size] * 4, 150, 4) for size in (1, 29, 30, 42, 67, 200)] == [4, 4, 3, 3, 2, 1]
    assert legend_columns([], 150, 4) == 4
