"""`ehdmaps solve --solver roller`: whole rollers with their profile on the command line."""

from __future__ import annotations

import json
from functools import partial

import pytest

from ehdmaps.jobs.cli import main
from ehdmaps.jobs.solve import roller_ends
from ehdmaps.point.two_grids import Resolution

POINT = ("--load", "1500 N", "--speed", "3000 rpm", "--temperature", "60 degC")
CROWN = "{ crown_drop = '10 um', straight = '13 mm' }"


@pytest.fixture
def on_small_grids(monkeypatch):
    grids = Resolution((26, 14), (32, 18))
    monkeypatch.setattr(roller_ends, "solve_roller", partial(roller_ends.solve_roller, resolution=grids))


def solved(capsys, *arguments: str) -> tuple[int, str, str]:
    status = main(["solve", *arguments])
    captured = capsys.readouterr()
    return status, captured.out, captured.err


def test_the_table_tells_where_the_smallest_film_lies(capsys, on_small_grids) -> None:
    status, out, _ = solved(capsys, "--bearing", "NU308", *POINT, "--solver", f"roller:{CROWN}")
    assert status == 0 and "NU308, FVA3: 1500 N a roller, 4.95 m/s" in out and "13 mm straight, half-spaces" in out
    rows = {line[2:20].strip(): line[28:].split() for line in out.splitlines()}
    for place in rows["off the middle by"]:
        assert 6.5 < float(place) < 7.5  # beyond the straight part, within the roller
    middle, least = (float(rows[name][0]) for name in ("smallest, middle", "smallest film"))
    assert 0.6 * middle < least < 0.95 * middle


def test_plain_values_of_a_roller_by_iso(capsys, on_small_grids) -> None:
    status, out, _ = solved(capsys, "nu308", *POINT, "--solver", "roller", "--json")
    inner, outer = json.loads(out)
    assert status == 0 and (inner["contact"], outer["contact"]) == ("inner", "outer")
    assert inner["status"] == "converged" and inner["minimum_film"] < inner["central_film"] < outer["central_film"]
    assert inner["minimum_film"] == pytest.approx(inner["middle_film"], rel=0.01)  # the profile leaves no dip


def test_without_a_film_there_are_no_numbers(capsys) -> None:
    point = ("--load", "100 N", "--speed", "100 m/s", "--temperature", "60 degC")
    status, out, _ = solved(capsys, "nu308", *point, "--solver", "roller:straight", "--json")
    inner, _ = json.loads(out)
    assert status == 1 and inner["status"] == "outside_validity" and inner["minimum_film"] is None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("nu308", *POINT, "--length", "1 mm", "--films", "table"), "--length: not with --solver roller"),
        (("nu308", "--load", "5 N/mm", *POINT[2:]), "--load: got the unit 'N/mm'"),
        (("--bearing", "NU308", *POINT[:4], "--temperature", "900 degC"), "--temperature: got '900 degC'"),
        (("nu308x", *POINT), "nu308x"),
    ],
)
def test_refusals(capsys, arguments, words) -> None:
    status, _, err = solved(capsys, *arguments, "--solver", "roller")
    assert status == 2 and words in err


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        ("isso", "--solver roller: got 'isso' (did you mean 'iso'?)"),
        ("{ positions = ['-8 mm', '0 mm', '8 mm'], depths = ['1 um', '0 um', '2 um'] }", "differs on both sides"),
    ],
)
def test_wrong_profiles_are_refused(capsys, profile, words) -> None:
    status, _, err = solved(capsys, "nu308", *POINT, "--solver", f"roller:{profile}")
    assert status == 2 and words in err


def test_a_bare_contact_has_no_rollers(capsys, tmp_path) -> None:
    job = tmp_path / "line.toml"
    job.write_text(
        'schema = 1\n[contact]\nradius = "5 mm"\nroller_length = "10 mm"\n[lubricant]\nname = "FVA3"\n',
        encoding="utf-8",
    )
    status, _, err = solved(capsys, str(job), *POINT, "--solver", "roller")
    assert status == 2 and "got a job of a bare [contact]; allowed: one with [bearing]" in err
