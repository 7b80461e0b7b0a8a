"""Tests marked openfoam need OpenFOAM and the built ehlFoam: skipped without them, but in CI a failure."""

import functools
import subprocess
from pathlib import Path

import pytest

from tests.cases.programs import needed

BUILD = Path(__file__).parents[2] / "openfoam_cases" / "build"


@functools.cache
def why_not() -> str:
    result = subprocess.run([needed("bash"), BUILD, "--check"], capture_output=True, text=True, check=False)
    return "" if result.returncode == 0 else f"ehlFoam is {(result.stdout + result.stderr).strip()}"


def pytest_runtest_setup(item):
    if item.get_closest_marker("openfoam") and (reason := why_not()):
        pytest.skip(reason)
