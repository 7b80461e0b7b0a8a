"""CalculiX for tests: skipped without it on a user's machine, a failure in CI."""

from __future__ import annotations

import os
import shutil

import pytest


def needed_calculix() -> str:
    """Path of CalculiX; ends the test where there is none."""
    found = shutil.which("ccx")
    if found is not None:
        return found
    if os.environ.get("CI"):
        pytest.fail("ccx is not on the PATH (in CI no test of CalculiX may be skipped)", pytrace=False)
    pytest.skip("ccx is not on the PATH: install CalculiX")
