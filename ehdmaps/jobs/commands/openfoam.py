"""`ehdmaps openfoam`: build ehlFoam, the solver of the solver openfoam, from the sources of this installation.

With `--check` it is asked whether it is up to date, and then run: a program that is there may still lack a library, or
crash on this machine.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess

from ehdmaps.errors import InputError
from ehdmaps.openfoam.installation import build_script

_COLUMNS, _ROWS = 100, 4
"""Cells of the case that is tried: few, and enough for it to converge."""

_LOAD, _SPEED, _TEMPERATURE = 2e4, 2.0, 333.15
"""Its load [N/m], entrainment speed [m/s] and temperature [K]."""

_SECONDS = 60.0
"""Time that it may take: ten times what it takes on a slow machine."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Run the script; its exit status is ours: 1 if the build failed or is out of date, 2 if something is missing.

    A check ends with 1, too, where the case that is tried has no solution.
    """
    bash, script = shutil.which("bash"), build_script()
    if bash is None:
        raise InputError(f"bash is not in PATH; needed: a shell that runs {script}")
    options = [f"--{name}" for name in ("install", "check") if getattr(arguments, name)]
    result = subprocess.run([bash, str(script), *options], stdout=subprocess.PIPE, text=True, check=False)
    said = result.stdout.rstrip("\n")
    if not arguments.check or result.returncode:
        return said, result.returncode
    words, solved = tried()
    return f"{said}\n{words}", 0 if solved else 1


def tried() -> tuple[str, bool]:
    """Solve one point on a coarse grid, and tell how it ended, and whether it has a solution.

    Raises
    ------
    InputError
        If something is missing that it needs.
    """
    from ehdmaps.openfoam.solver import OpenFoamSolver  # with all that runs a case
    from ehdmaps.physics.bearing import BearingGeometry
    from ehdmaps.physics.lubricant import DEFAULT_OIL, Lubricant
    from ehdmaps.physics.solids import STEEL

    solver = OpenFoamSolver(columns=_COLUMNS, rows=_ROWS, timeout=_SECONDS)
    contact, *_ = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")
    (film,) = solver.solve_line(contact, Lubricant.named(DEFAULT_OIL), (_LOAD,), _SPEED, _TEMPERATURE)
    case = f"a case of {_COLUMNS} x {_ROWS} cells (NU308, {DEFAULT_OIL})"
    if not film.status.usable:
        return f"does not run: {case} ended as {film.status.word}: {film.reason}", False
    return f"runs: {case} has a central film of {1e6 * film.central_film:.3g} um, in {film.solve_seconds:.1f} s", True
