"""Films that slide, by both solvers: film, k, c, traction, temperatures, and the frequency at which c ends.

Run: python -m tests.benchmarks.bench_slip [--openfoam RATIO [RATIO ...]]

Inner contact of NU308 with FVA 3, heat in the film, limiting shear stress, 100 N/mm, 3 m/s, 60 degC. Film compliance s
and loss compliance of slow motion are beside k and c. The column "secant" is s by the films of two solves at loads of
10 % less and more, without any linear response. The rows of `--openfoam` are of `thin_film` with its default grid.
"""

from __future__ import annotations

import argparse
import math
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import ContactSolver, contact_solution
from ehdmaps.physics.spectrum import contact_spectrum

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
OIL = Lubricant.named("FVA3")
LOAD, SPEED, CELSIUS = 1e5, 3.0, 60.0
POINT = OperatingPoint(LOAD, SPEED, CELSIUS + 273.15)
PHYSICS: dict[str, Any] = {"physics": "thermal", "shear": "limiting"}
ROWS = (
    (PHYSICS, (0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.5, 0.55, 0.6, 0.8, 1.0, 1.5)),
    ({"physics": "isothermal", "shear": "limiting"}, (0.1, 0.3, 0.5, 0.6, 1.0)),
    ({"physics": "thermal", "shear": "eyring"}, (0.1, 0.3, 0.5, 0.6, 1.0)),
)
SECANT = 0.1
NUMBERS = (1.0, 3.0)
"""omega b/u at which c is shown."""


def secant(solver: ReynoldsSolver) -> float:
    """Film compliance by two films at other loads [m2/N]; NaN where one is not solved."""
    loads = (LOAD * (1.0 - SECANT), LOAD * (1.0 + SECANT))
    lower, upper = (solver.solve_line(CONTACT, OIL, (load,), SPEED, POINT.temperature)[0] for load in loads)
    return (lower.film_offset - upper.film_offset) / (loads[1] - loads[0])


def row(ratio: float, solver: ContactSolver) -> str:
    """The row of one film."""
    omega = np.array(NUMBERS) * SPEED / float(half_width(LOAD, CONTACT.radius, CONTACT.reduced_modulus))
    if isinstance(solver, ReynoldsSolver):
        found = contact_spectrum(solver.film_spectrum(CONTACT, OIL, POINT, omega / (2.0 * math.pi)), CONTACT, POINT)
        film, fast, beside = found.solution, found.damping, secant(solver)
    else:
        (line,) = solver.solve_line(CONTACT, OIL, (LOAD,), SPEED, POINT.temperature)
        film, fast, beside = contact_solution(line, CONTACT, POINT), np.full(len(NUMBERS), np.nan), math.nan
    if not film.status.usable:
        return f"{ratio:5.2f}  {film.status.word}"
    return (
        f"{ratio:5.2f} {1e9 * film.central_film:7.1f} {1e9 * film.minimum_film:7.1f} "
        f"{1e-9 * film.stiffness:7.3f} {1e-3 * film.damping:7.2f} {100.0 * film.damping_error:5.1f} "
        + " ".join(f"{1e-3 * value:6.2f}" for value in fast)
        + f" {1e13 * film.film_compliance:7.2f} {1e13 * beside:7.2f} {1e17 * film.loss_compliance:6.2f} "
        f"{film.traction / LOAD:7.4f} {film.film_temperature - 273.15:6.1f} {film.surface_temperature - 273.15:6.1f}"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--openfoam", type=float, nargs="+", default=[], metavar="RATIO")
    ratios = parser.parse_args().openfoam
    place = f"NU308 inner, {LOAD / 1e3:g} N/mm, {SPEED:g} m/s, {CELSIUS:g} degC"
    print(f"{place}; slip (u2 - u1)/u; c in kN s/m2, of slow motion and at omega b/u")
    print(
        "s and secant in 1e-13 m2/N, loss in 1e-17 m2 s/N; mu is traction over load; hottest of film and wall in degC"
    )
    print(
        f"{'slip':>5s} {'h, nm':>7s} {'h_min':>7s} {'k, GPa':>7s} {'c':>7s} {'+- %':>5s} "
        + " ".join(f"{f'at {number:g}':>6s}" for number in NUMBERS)
        + f" {'s':>7s} {'secant':>7s} {'loss':>6s} {'mu':>7s} {'film':>6s} {'wall':>6s}"
    )
    for physics, here in ROWS:
        print(f"reynolds, {', '.join(physics.values())}")
        for ratio in here:
            print(row(ratio, ReynoldsSolver(slide_to_roll=ratio, **physics)), flush=True)
    if not ratios:
        return
    from ehdmaps.ehl.start import reynolds_start
    from ehdmaps.openfoam.solver import OpenFoamSolver

    print(f"ehlFoam, thin_film, {', '.join(PHYSICS.values())}")
    for ratio in ratios:
        print(
            row(ratio, OpenFoamSolver(slide_to_roll=ratio, starter=reynolds_start, timeout=600.0, **PHYSICS)),
            flush=True,
        )


if __name__ == "__main__":
    with threadpool_limits(1):
        main()
