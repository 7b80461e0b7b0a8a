"""The short form of `ehdmaps stability` and of the readers of `mbs stability`: nothing fails at the extremes."""

from __future__ import annotations

import json

import pytest

from ehdmaps.jobs.cli import main
from mbs.laboratory.extremes import machine_readers as of_mbs
from mbs.laboratory.extremes import map_readers as of_ehdmaps
from mbs.laboratory.extremes.check import checks_text
from mbs.laboratory.extremes.fuzzing import fuzz

READERS = {**of_ehdmaps.READERS, **of_mbs.READERS}

MUTATIONS = 100
"""Damaged files for each reader; the long form, the commands `stability` of both programs, has 10000."""


@pytest.mark.slow
@pytest.mark.parametrize("name", READERS)
def test_damaged_files_are_read_or_refused_and_do_no_harm(name) -> None:
    found = fuzz(READERS[name](), MUTATIONS, 14)
    assert found.failed == 0, checks_text([found])
    # Neither all refused nor all read: the damage is of the kind that tells something.
    assert found.right >= 2 and found.refused > 0.3 * MUTATIONS
    assert found.tried == MUTATIONS


def test_contacts_at_the_extremes(tmp_path, capsys) -> None:
    path = tmp_path / "found.json"
    short = ["--points", "200", "--openfoam", "0", "--only", "contact", "--seed", "14"]
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
    reader = of_ehdmaps.READERS["status of a run"]()
    wrong = type(reader)(reader.name, reader.folders, lambda folder: "another number")
    monkeypatch.setattr("mbs.laboratory.commands.stability.MAP_READERS", {"status of a run": lambda: wrong})
    path = tmp_path / "found.json"
    assert main(["stability", "--only", "status of a run", "--mutations", "3", "-o", str(path)]) == 1
    (check,) = json.loads(path.read_text())["checks"]
    assert check["failed"] == 4 and check["failures"][0]["what"] == "another number"  # the good file, too


def test_what_is_searched_has_to_be_known(capsys) -> None:
    assert main(["stability", "--only", "maps"]) == 2
    assert "--only: got 'maps' (did you mean 'map'?); allowed: contact, job file, map" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["stability", "--points", "many"])
    assert "--points: got 'many'; allowed: a whole number" in capsys.readouterr().err
