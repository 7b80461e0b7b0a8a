"""Every example runs from any folder, passes its own check, and writes its figure; it is short enough to be read."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))
LONGEST = 40


def test_there_are_eight_and_the_page_names_them():
    page = (ROOT / "examples" / "README.md").read_text(encoding="utf-8")
    assert [path.name[:2] for path in EXAMPLES] == [f"{number:02d}" for number in range(1, 9)]
    assert all(f"`{path.name}`" in page for path in EXAMPLES)


@pytest.mark.slow
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example(path, tmp_path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    command = [sys.executable, "-W", "error", str(path)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout
    figures = list(tmp_path.glob(f"{path.name[:2]}_*.png"))
    assert len(figures) == 1
    assert figures[0].read_bytes().startswith(b"\x89PNG")
    text = path.read_text(encoding="utf-8")
    assert "assert " in text
    assert text.count("\n") <= LONGEST
