"""The sanitizers of addresses and of undefined behaviour find nothing in the C library, whatever it is given."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from ehdmaps.kernel import building, library
from tests.cases.programs import needed

ROOT = Path(__file__).parents[2]
DATA = ROOT / "tests" / "data" / "c"

FROM_PYTHON = (
    "tests/unit/test_mbs_gear.py", "tests/unit/test_ball_force.py", "tests/unit/test_mbs_changing.py",
    "tests/unit/test_mbs_level.py", "tests/unit/test_mbs_rollers.py", "tests/unit/test_mbs_table_law.py",
)  # fmt: skip
"""Tests that call the library from Python, and where numba compiles nothing, or little."""

pytestmark = pytest.mark.slow


def test_tables_of_all_sizes_and_numbers_of_any_kind(tmp_path):
    options = [*building.ALWAYS, *building.OPTIONS["sanitized"], *building.LINES, "-Werror", "-I", building.SOURCES]
    command = [needed("gcc"), *options, DATA / "hostile_kernel.c", "-o", tmp_path / "run", "-lm"]
    subprocess.run(list(map(str, command)), check=True)
    result = subprocess.run([tmp_path / "run", "100"], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr


def test_what_python_gives_the_library():
    """The library of a kind that is checked at each access, in Python, which has to load the sanitizers first."""
    ask = [needed("gcc"), "-print-file-name=libasan.so"]
    sanitizer = subprocess.run(ask, capture_output=True, text=True, check=True).stdout.strip()
    environment = {
        **os.environ,
        "LD_PRELOAD": sanitizer,
        "ASAN_OPTIONS": "detect_leaks=0",  # Python itself leaves much behind when it ends
        library.KIND_VARIABLE: "sanitized",
        "NUMBA_DISABLE_JIT": "1",
    }
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *FROM_PYTHON]
    result = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, env=environment)
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-3000:]
    assert "passed" in result.stdout
