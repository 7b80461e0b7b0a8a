"""Line contacts by their groups, run through the same door as the points of a map."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.start import reynolds_start
from ehdmaps.openfoam.grid_solver import GridSolution, GridSolver
from ehdmaps.openfoam.installation import Installation, installation
from ehdmaps.openfoam.parameters import Flow, Parameters
from ehdmaps.openfoam.results import Results
from ehdmaps.openfoam.run import TimeLimit
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from tests.cases.moes import load_and_speed

CONTACT = LineContact("line", 10e-3, STEEL, "half_space", reference_depth=1e-3)
TEMPERATURE = 313.15
VISCOSITY, ALPHA = 0.1, 1.7e-8

ROELANDS = Lubricant.roelands(viscosity=VISCOSITY, pressure_viscosity=ALPHA, roelands_z=0.67, density=880.0)
"""The oil of the reference points: compressible after Dowson and Higginson."""

ISOVISCOUS = Lubricant.barus(viscosity=VISCOSITY, pressure_viscosity=0.0, density=880.0, density_law="incompressible")
"""Constant viscosity and density."""

ISOVISCOUS_L = 0.5
"""Oil number that sets the speed, and so h/R, of points whose oil has none: h/R is 1.6e-8 Moes films."""

SETTINGS = ("inlet_length", "slide_to_roll", "flow", "shear", "shear_stress", "limiting_ratio", "carreau_exponent")
"""What is a setting of the solver, and not of one run."""


def parameters(
    M: float, L: float, columns: int = 100, rows: int = 8, *, hertz: bool = False, **changes: Any
) -> Parameters:
    """A run at Moes' groups, from the Reynolds solution or from Hertz' pressure on the same mesh.

    L = 0 is an isoviscous, incompressible oil; `changes` are other settings of the run, or of the solver.
    """
    settings = {key: changes.pop(key) for key in SETTINGS if key in changes}
    solver = OpenFoamSolver(starter=reynolds_start, **settings)
    oil = ROELANDS if L > 0.0 else ISOVISCOUS
    load, speed = load_and_speed(M, L or ISOVISCOUS_L, VISCOSITY, ALPHA, CONTACT.radius, CONTACT.reduced_modulus)
    found = solver.parameters(CONTACT, oil, OperatingPoint(load, speed, TEMPERATURE))
    assert found.start is not None
    return replace(found, columns=columns, rows=rows, start=None if hertz else found.start, **changes)


def run(settings: Parameters, keep: Path | None = None) -> GridSolution:
    """Run one case; where `keep` is given its folder stays there, with its fields."""
    return GridSolver(installation(), keep).run_case(settings, "case", False, TimeLimit(300.0))


@cache
def results(M: float, L: float, columns: int = 100, rows: int = 8, flow: Flow = "thin_film", **changes: Any) -> Results:
    """Numbers of a point; solved once for all tests."""
    return run(parameters(M, L, columns, rows, flow=flow, **changes)).results


def program(installed: Installation, name: str | Path, case: Path, *options: str) -> subprocess.CompletedProcess[str]:
    """Run a program of OpenFOAM in a folder, come what may."""
    return subprocess.run(
        [str(name), "-case", str(case), *options],
        cwd=case,
        env={**installed.full_environment(), "PWD": str(case)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120.0,
        check=False,
    )


def table(settings: Parameters, case: Path, option: str, **lists: FloatArray) -> FloatArray:
    """Table that ehlFoam writes of lists with -laws or -walls, in a new folder."""
    installed = installation()
    (case / "system").mkdir(parents=True)
    (case / "constant").mkdir()
    (case / "system" / "controlDict").write_text((installed.template / "system" / "controlDict").read_text())
    (case / "constant" / "ehlProperties").write_text(settings.text())
    text = "".join(f"{name} ({' '.join(map(repr, values.tolist()))});\n" for name, values in lists.items())
    (case / "points").write_text(text)
    ended = program(installed, installed.solver, case, f"-{option}", str(case / "points"))
    assert ended.returncode == 0, ended.stdout
    return np.loadtxt(case / f"{option}.dat", ndmin=2)
