"""What a search at the extremes tells: counts, the worst case, failures, as text, as JSON and in files."""

from __future__ import annotations

import argparse
import json

import pytest

from mbs.laboratory.extremes.check import MOST_FAILURES, Check, Verdict, checked, checks_json, checks_text, searched


def test_checks_as_text_and_json() -> None:
    right = [Verdict("0.4 % off at M = 3", 0.4), Verdict("0.9 % off at M = 5", 0.9)]
    wrong = [Verdict(f"M = {number}", wrong="2 % off") for number in range(MOST_FAILURES + 2)]
    found = checked("films", "within 1 %", [*right, *3 * [Verdict(refused="too thick")], *wrong])
    text = checks_text([found])
    assert "films" in text and "worst: 0.9 % off at M = 5" in text and "refused: 3 too thick" in text
    assert "FAILED: 2 % off; case: M = 0" in text and "FAILED: 2 more" in text
    assert text.splitlines()[1].split()[:5] == ["films", "27", "2", "3", "22"]
    read = json.loads(checks_json([found]))["checks"][0]
    assert Check(**{**read, "failures": found.failures}) == found


@pytest.mark.parametrize("name", ["a.txt", "a.json"])
def test_what_is_found_is_written(tmp_path, name) -> None:
    asked = argparse.Namespace(only=None, output=str(tmp_path / name), json=False)
    for _ in range(2):  # what we made may be replaced
        text, status = searched(asked, {"films": lambda: [checked("films", "within 1 %", [Verdict()])]}, "all")
        assert "films" in (tmp_path / name).read_text() and text.startswith("all\n") and status == 0
