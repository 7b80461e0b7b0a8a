"""`ehdmaps openfoam`: build ehlFoam, the solver of the solver openfoam, from the sources of this installation."""

from __future__ import annotations

import argparse
import shutil
import subprocess

from ehdmaps.errors import InputError
from ehdmaps.openfoam.installation import build_script


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Run the script; its exit status is ours: 1 if the build failed or is out of date, 2 if something is missing."""
    bash, script = shutil.which("bash"), build_script()
    if bash is None:
        raise InputError(f"bash is not in PATH; needed: a shell that runs {script}")
    options = [f"--{name}" for name in ("install", "check") if getattr(arguments, name)]
    result = subprocess.run([bash, str(script), *options], stdout=subprocess.PIPE, text=True, check=False)
    return result.stdout.rstrip("\n"), result.returncode
