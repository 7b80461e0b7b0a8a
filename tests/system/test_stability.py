"""The short form of `ehdmaps stability`: nothing fails at the extremes."""

from __future__ import annotations

import json

import pytest

from ehdmaps.jobs.cli import main
from mbs.laboratory.extremes.check import Check, Failure


def test_contacts_at_the_extremes(tmp_path, capsys) -> None:
    path = tmp_path / "found.json"
    short = ["--points", "200", "--openfoam", "0", "--seed", "14"]
    assert main(["stability", *short, "-o", str(path)]) == 0
    told = capsys.readouterr()
    assert "contact: reynolds, a hair apart" in told.out and "FAILED" not in told.out
    checks = json.loads(path.read_text())["checks"]
    assert [check["name"] for check in checks if check["failed"]] == []
    counted = {check["name"]: check for check in checks}
    assert counted["contact: reynolds, value or status"]["tried"] == 200
    assert counted["contact: reynolds, value or status"]["right"] > 60
    assert counted["contact: what is no point"]["refused"] == counted["contact: what is no point"]["tried"] > 200


def test_a_failure_ends_with_status_1(monkeypatch, tmp_path) -> None:
    wrong = Check("films", 3, 2, 0, "within 1 %", (Failure("M = 3", "2 % off"),), 1)
    monkeypatch.setattr("mbs.laboratory.commands.stability.contact_checks", lambda *asked: iter([wrong]))
    path = tmp_path / "found.json"
    assert main(["stability", "-o", str(path)]) == 1
    (check,) = json.loads(path.read_text())["checks"]
    assert check["failed"] == 1 and check["failures"][0]["what"] == "2 % off"


def test_a_number_of_points_is_whole(capsys) -> None:
    with pytest.raises(SystemExit):
        main(["stability", "--points", "many"])
    assert "--points: got 'many'; allowed: a whole number" in capsys.readouterr().err
