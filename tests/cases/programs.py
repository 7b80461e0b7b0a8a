"""What tests need besides the product: skipped without it on a user's machine, a failure in CI."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from ehdmaps.errors import InputError
from ehdmaps.openfoam.installation import installation

PACKAGES = {
    "bash": "bash",
    "git": "git",
    "gcc": "gcc libc6-dev",
    "clang": "clang",
    "g++": "g++",
    "gfortran": "gfortran",
    "octave-cli": "octave octave-netcdf",
    "ccx": "calculix-ccx",
    "ngspice": "ngspice",
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


DOES_NOT_APPLY = "does not apply"
"""What the reason says of a test that is skipped in CI, too."""


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
    pytest.skip(f"{' or '.join(names)} is not on the PATH: apt-get install {PACKAGES[names[0]]}")


def needs_film_solver() -> None:
    """End the test where `ehlFoam` is not built: the short tier runs without OpenFOAM, too."""
    try:
        installation()
    except InputError as error:
        pytest.skip(str(error))


def quick_compiler(folder: Path) -> str:
    """A C compiler that does not optimise, as value of CC: of builds that are not asked how fast they run.

    Parameters
    ----------
    folder : Path
        Folder for it, without blanks in its path.
    """
    program = folder / "quick-cc"
    program.write_text(f'#!/bin/sh\nexec {needed("gcc", "clang")} "$@" -O0\n', encoding="ascii")
    program.chmod(0o755)
    return str(program)


def held_to_run(report: pytest.TestReport | pytest.CollectReport) -> None:
    """Turn the report of a skip into one of a failure in CI, unless the test does not apply to what it is given.

    Parameters
    ----------
    report : TestReport or CollectReport
        Changed in place.
    """
    if not os.environ.get("CI") or not report.skipped or hasattr(report, "wasxfail"):
        return
    reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
    if DOES_NOT_APPLY not in reason:
        report.outcome, report.longrepr = "failed", f"{reason} (in CI no test may be skipped)"
