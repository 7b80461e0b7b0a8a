"""A contact whose load oscillates: linear responses of both programs beside steps in time, and solids with losses.

Run: python -m tests.benchmarks.bench_in_time

Inner contact of NU308, FVA 3, the point of the case `openfoam_cases/lineContact`. `ehlFoam` integrates the equations of
the film between elastic half-spaces over a load w (1 + 1e-3 sin(omega t)), three cycles of 100 steps; the last one is
analysed. Roller and ring are finite: their compliance, by finite elements (structural law `fe`), is in series with the
film's, k and c are those of the whole.

The last lines give all elastic compliance a loss factor, C (1 - i eta): that of the deflection under the film and that
of roller and ring. The film's equations have the derivative by the film times the deflection for it,

    (A + i eta F D + i Omega (B - i eta B_D)) z = e,

F by difference quotients of the residual, D the deflection by the pressures, B_D what the rate of the deflection
stores. `in series` leaves the film as it is between solids without losses.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from ehdmaps.arrays import ComplexArray
from ehdmaps.ehl.group_solution import linearised_profile
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.linearisation import Linearisation, storage
from ehdmaps.ehl.profile import Profile
from ehdmaps.ehl.reynolds import residual
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.ehl.spectrum import film_compliances
from ehdmaps.ehl.start import reynolds_start
from ehdmaps.ehl.ways import LOAD
from ehdmaps.openfoam.grid_solver import GridSolver
from ehdmaps.openfoam.installation import installation
from ehdmaps.openfoam.parameters import Oscillation
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import DRY_COMPLIANCE, half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "fe")[0]
OIL = Lubricant.named("FVA3")
POINT = OperatingPoint(2e4, 2.0, 373.15)
NUMBERS = (0.03, 0.3, 1.0)
"""omega b/u."""

LOSSES = (1e-4, 1e-3, 1e-2)
"""Loss factors of the solids, assumed: some 1e-4 of steel itself, more with joints."""

TIME = POINT.entrainment_speed / float(half_width(POINT.load, CONTACT.radius, CONTACT.reduced_modulus))
UNIT = 4.0 / CONTACT.reduced_modulus
SOLIDS = float(CONTACT.structural_compliance(POINT.load))


def main() -> None:
    """Print the tables."""
    omegas = TIME * np.array(NUMBERS)
    frequencies = omegas / (2.0 * math.pi)
    print(
        f"NU308 inner, {POINT.load / 1e3:g} N/mm, {POINT.entrainment_speed:g} m/s, {POINT.temperature - 273.15:g} degC"
    )
    print(
        "k in GPa and c in kN s/m2 at omega b/u of" + "".join(f"{number:12g}" for number in NUMBERS),
        end="\n" + " " * 41,
    )
    print("".join(f"{1e-3 * frequency:9.3g} kHz" for frequency in frequencies))
    with threadpool_limits(1):
        spectrum = ReynoldsSolver().film_spectrum(CONTACT, OIL, POINT, frequencies)
        show("reynolds, linear response", spectrum.compliance, omegas)
        in_time(omegas)
        problem, M, L = line_problem(CONTACT, OIL.at(POINT.temperature), POINT.load, POINT.entrainment_speed)
        profile = solve_groups(problem, M, L, ReynoldsSolver().resolution).profile
    assert profile is not None
    linear = linearised_profile(profile, follows=False)
    assert isinstance(linear, Linearisation)
    plain = UNIT * film_compliances(linear, np.array(NUMBERS))
    same = UNIT * lossy(profile, linear, 0.0)
    assert np.allclose(same, plain, rtol=1e-9, atol=0.0)
    print("c by solids with a loss factor, over c without")
    before = (1.0 / (SOLIDS + plain)).imag
    for loss in LOSSES:
        for name, film in (("", UNIT * lossy(profile, linear, loss)), (", in series", plain)):
            more = (1.0 / (SOLIDS * (1.0 - 1j * loss) + film)).imag
            print(f"{f'eta {loss:g}{name}':<41}" + "".join(f"{ratio:13.4f}" for ratio in more / before))


def show(name: str, films: ComplexArray, omegas: np.ndarray, seconds: float = math.nan) -> None:
    """Print k and c of the whole contact."""
    stiffness = 1.0 / (SOLIDS + films)
    cells = "".join(
        f"{1e-9 * K.real:7.3f}{1e-3 * K.imag / omega:6.2f}" for K, omega in zip(stiffness, omegas, strict=True)
    )
    print(f"{name:<41}{cells}" + ("" if math.isnan(seconds) else f"   {seconds:.0f} s"))


def in_time(omegas: np.ndarray) -> None:
    """Rows of ehlFoam: its linear response, and steps in time."""
    solver = OpenFoamSolver(starter=reynolds_start)
    found = solver.parameters(CONTACT, OIL, POINT)
    linear, steps = np.empty((2, omegas.size), dtype=complex)
    began = time.perf_counter()
    for i, omega in enumerate(omegas):
        frequency = omega / (2.0 * math.pi)
        settings = replace(
            found,
            mesh=replace(found.mesh, spike_width=0.0),
            frequencies=(frequency,),
            oscillation=Oscillation(frequency, 1e-3, steps_per_cycle=100, cycles=3),
        )
        results = (
            GridSolver(installation(), None).run_case(settings, "in-time", False, time.monotonic() + 300.0).results
        )
        assert results.oscillation_film_compliance is not None
        assert results.oscillation_loss_compliance is not None
        linear[i] = results.complex_compliance[0]
        steps[i] = results.oscillation_film_compliance - 1j * omega * results.oscillation_loss_compliance
    show("ehlFoam, linear response", linear, omegas)
    show("ehlFoam, in time", steps, omegas, time.perf_counter() - began)


def lossy(profile: Profile, linear: Linearisation, loss: float) -> ComplexArray:
    """Film compliances between solids with a loss factor, in units of 4/E', on a grid that stands still."""
    grid, kernel, unknowns = profile.grid, profile.kernel, profile.unknowns
    size, n = unknowns.size, unknowns.size - 2
    pressure, step = profile.pressure, 1e-5 * float(profile.film.min())
    loaded = int(np.argmax(pressure))
    by_film = np.empty((size, n + 1))
    scratch = np.empty((1, size))
    for j in range(n + 1):
        sides = []
        for move in (step, -step):
            moved, out = kernel.copy(), np.empty(size)
            moved[j, loaded] -= move / pressure[loaded]
            residual(profile.problem, grid.x, grid.step, grid.face_step, moved, unknowns, LOAD, out, scratch)
            sides.append(out)
        by_film[:, j] = (sides[0] - sides[1]) / (2.0 * step)
    deflection = np.zeros((n + 1, size))
    deflection[:, : n - 1] = kernel[:, 1:n]
    stiff = linear.arrays._replace(kernel=np.zeros_like(kernel))
    stored = np.array([storage(linear.arrays, unit) for unit in np.eye(size)]).T
    of_deflection = stored - np.array([storage(stiff, unit) for unit in np.eye(size)]).T
    matrix = linear.matrix + 1j * loss * by_film @ deflection
    found = [
        -np.linalg.solve(matrix + 1j * number * (stored - 1j * loss * of_deflection), linear.unit)[linear.height]
        for number in NUMBERS
    ]
    return np.array(found) - DRY_COMPLIANCE * (1.0 - 1j * loss)


if __name__ == "__main__":
    main()
