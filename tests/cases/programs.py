"""Programs that tests start, and that are no Python: skipped without them on a user's machine, a failure in CI."""

from __future__ import annotations

import os
import shutil
from typing import NoReturn

import pytest

PACKAGES = {
    "bash": "bash",
    "git": "git",
    "gcc": "gcc libc6-dev",
    "clang": "clang",
    "g++": "g++",
    "gfortran": "gfortran",
    "x86_64-w64-mingw32-gcc": "gcc-mingw-w64-x86-64-win32",
    "octave-cli": "octave octave-netcdf",
    "ccx": "calculix-ccx",
    "chromium": "chromium",
    "chromium-browser": "chromium",
    "checkMesh": "openfoam",
    "foamToVTK": "openfoam",
    "setpriv": "util-linux",
    "mount": "mount",
    "umount": "mount",
    "simpleFoam": "openfoam",
}
"""Packages of Debian that have the programs, by their names; those of `.ci/tools` and `openfoam_cases/build --install`
among them."""


def needed(*names: str) -> str:
    """Path of the first of some programs that is there; ends the test where none is.

    Parameters
    ----------
    names : str
        Names in `PACKAGES`, any of which does.
    """
    for name in names:
        if found := shutil.which(name):
            return found
    missing(f"{' or '.join(names)} is not on the PATH: apt-get install {PACKAGES[names[0]]}")


def missing(reason: str) -> NoReturn:
    """End a test that cannot run here, for a reason: skipped, but a failure in CI.

    Parameters
    ----------
    reason : str
        What is missing, and how to get it.
    """
    if os.environ.get("CI"):
        pytest.fail(f"{reason} (in CI no test may be skipped for a missing program)", pytrace=False)
    pytest.skip(reason)
