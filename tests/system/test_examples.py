"""Every example passes its own check, prints and draws, from any folder; it is short enough to be read.

The gallery of the documentation runs them, and what it has run is not run again here, unless anything changed since.
"""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))
LONGEST = 50


def test_there_are_fourteen_and_the_page_names_them():
    page = (ROOT / "examples" / "README.md").read_text(encoding="utf-8")
    assert [path.name[:2] for path in EXAMPLES] == [f"{number:02d}" for number in range(1, 15)]
    assert all(f"`{path.name}`" in page for path in EXAMPLES)


@pytest.fixture(scope="module")
def gallery():
    """The module that runs examples for the documentation."""
    spec = importlib.util.spec_from_file_location("gallery", ROOT / "docs" / "gallery.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def surroundings(gallery):
    """What examples run on."""
    return gallery.surroundings()


@pytest.mark.slow
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example(path, gallery, surroundings):
    page = gallery.make_page(path, surroundings)
    printed = page.read_text(encoding="utf-8").partition("It prints\n\n```text\n")[2].partition("\n```\n")[0]
    assert printed.strip()
    figures = list(page.with_suffix("").glob("*.png"))
    assert len(figures) == 1
    assert figures[0].name.startswith(path.name[:2])
    assert figures[0].read_bytes().startswith(b"\x89PNG")
    text = path.read_text(encoding="utf-8")
    assert "assert " in text
    assert text.count("\n") <= LONGEST


@pytest.mark.slow
def test_without_a_folder_the_figure_is_written_where_one_stands(tmp_path):
    """All ask for the folder in the same words; one of them is run."""
    assert all(
        'Path(sys.argv[1] if len(sys.argv) > 1 else ".")' in path.read_text(encoding="utf-8") for path in EXAMPLES
    )
    command = [sys.executable, "-W", "error", str(EXAMPLES[4])]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["05_scene.png"]


def test_an_example_that_fails_or_draws_nothing_is_no_page(tmp_path, monkeypatch, gallery):
    monkeypatch.setattr(gallery, "PAGES", tmp_path / "pages")
    for body, told in (("assert 1 == 2", "exit status 1\n.*AssertionError"), ("print(1)", "got 0 figures")):
        (tmp_path / "01_wrong.py").write_text(f'"""Wrong."""\n{body}\n')
        with pytest.raises(gallery.ExampleError, match=f"(?s)01_wrong.py: {told}"):
            gallery.make_page(tmp_path / "01_wrong.py", "any")
        assert list((tmp_path / "pages").glob("*.md")) == []
