"""What tests need: without it they are skipped, with the reason, and fail in CI; one helper finds all programs."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cases.programs import PACKAGES, needed

ROOT = Path(__file__).parents[2]

ASKING = {"tests/cases/programs.py", "tests/openfoam/test_build.py"}
"""The helper, and the test of a script on a machine of its own."""

SHORT = (
    "tests/system/test_export_simpack.py::test_simpack_feels_the_bearing",
    "tests/system/test_report_browser.py",
    "tests/system/test_octave.py",
    "tests/system/test_setup.py",
    "tests/unit/test_version.py",
)
"""A test for each way of asking, which end before the long part of their work; the last ones need git alone."""


def test_a_missing_program_is_named_with_its_package(monkeypatch, tmp_path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    message = "chromium or chromium-browser is not on the PATH: apt-get install chromium"
    with pytest.raises(pytest.skip.Exception, match=message):
        needed("chromium", "chromium-browser")
    for name in ("gfortran", "chromium-browser"):
        (tmp_path / name).touch(mode=0o755)
    assert needed("gfortran") == str(tmp_path / "gfortran")
    assert needed("chromium", "chromium-browser") == str(tmp_path / "chromium-browser")


def test_no_test_starts_such_a_program_without_asking() -> None:
    """Neither by its name, first in a list or call, nor by looking for it itself."""
    found = []
    for path in sorted((ROOT / "tests").rglob("*.py")):
        name = path.relative_to(ROOT).as_posix()
        if name in ASKING or name.startswith("tests/benchmarks/"):
            continue
        text = path.read_text()
        if ".which(" not in text and not any(f'"{each}"' in text for each in PACKAGES):
            continue  # parsing takes long
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Attribute) and node.attr == "which":
                found.append(f"{name}:{node.lineno}: shutil.which")
            called = getattr(node, "func", None)
            starts = getattr(called, "id", getattr(called, "attr", "")) in ("run", "Popen", "start", "done")
            words = node.elts if isinstance(node, ast.List) else node.args if starts else []
            first = words[0] if words else None
            if isinstance(first, ast.Constant) and first.value in PACKAGES:
                found.append(f"{name}:{node.lineno}: {first.value}")
    assert found == []


@pytest.mark.slow
def test_with_python_and_git_alone_tests_pass_or_say_what_they_need(tmp_path) -> None:
    for path in (sys.executable, needed("git")):
        (tmp_path / Path(path).name).symlink_to(path)
    environment = {key: value for key, value in os.environ.items() if key != "CI"} | {"PATH": str(tmp_path)}
    command = [sys.executable, "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", *SHORT]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-3000:]
    for name in ("gcc", "chromium", "octave-cli", "bash"):
        assert f"{name} is not on the PATH: apt-get install {PACKAGES[name]}" in done.stdout.replace(
            " or chromium-browser", ""
        )
    assert " passed" in done.stdout


@pytest.mark.slow
def test_in_ci_what_is_missing_fails(tmp_path) -> None:
    """A program, a package that a whole file needs, and one that a test needs; what does not apply is skipped."""
    (tmp_path / "hidden.py").write_text("import sys\nsys.modules.update(dict.fromkeys(('exudyn', 'distributed')))\n")
    (tmp_path / "bin").mkdir()
    files = ("test_octave.py", "test_balls_exudyn.py", "test_executors.py", "test_elements.py")
    chosen = [str(path) for path in sorted((ROOT / "tests").rglob("test_*.py")) if path.name in files]
    paths = os.pathsep.join(filter(None, (str(tmp_path), os.environ.get("PYTHONPATH"))))
    environment = {**os.environ, "CI": "true", "PATH": str(tmp_path / "bin"), "PYTHONPATH": paths}
    words = "octave or exudyn or dask or (test_claim and definite and table)"
    command = [sys.executable, "-m", "pytest", "-q", "-rfEs", "-p", "no:cacheprovider", "-p", "hidden"]
    command += ["--continue-on-collection-errors", "-k", words, *chosen]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stdout[-3000:]
    assert done.stdout.count("(in CI no test may be skipped)") >= 3
    assert "1 skipped" in done.stdout
