"""Response over frequency: what 60 frequencies cost beside one point, and how far they are from a solve at each.

Run: python -m tests.benchmarks.bench_frequency [--transient]

Points of the NU308 with FVA 3 along the regimes, by the Reynolds solver. Costs are of one operating point from a cold
start, with its error estimates: the limit of slow motion alone, and with 60 frequencies from 0.01/T to 10/T, where T is
the natural time sqrt(b^2 + 2 h R)/u. The largest differences of K follow, relative to abs(K): from a direct complex
solve of all equations at each frequency (round-off), and from four times the cells (the error),
beside the largest estimate.
With --transient the linear response at 6 points and 3 frequencies beside the nonlinear film in time.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable

import numpy as np
from threadpoolctl import threadpool_limits

from ehdmaps.ehl.group_solution import linearised_profile
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.linearisation import Linearisation
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.ehl.spectrum import film_compliances
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import DRY_COMPLIANCE, half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.spectrum import contact_spectrum
from tests.cases.ehl import isoviscous_problem, roelands_problem
from tests.cases.moes import load_and_speed
from tests.verification.test_film_frequency import SOLIDS, TRANSIENT, oscillated

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
OIL = Lubricant.named("FVA3")
FREQUENCIES = 60
POINTS = (
    (0.01, 20.0, 40.0),
    (0.1, 20.0, 40.0),
    (0.4, 20.0, 40.0),
    (0.82, 20.0, 40.0),
    (1.2, 30.0, 20.0),
    (2.0, 20.0, 40.0),
    (5.0, 30.0, 20.0),
    (10.0, 12.0, 60.0),
    (50.0, 20.0, 40.0),
    (100.0, 12.0, 60.0),
    (0.5, 5.0, 100.0),
    (5.0, 5.0, 100.0),
)
"""M, L, and temperature [degC]."""

OSCILLATIONS = (
    (0.1, 20.0, (0.02, 0.1, 0.7)),
    (0.4, 20.0, (0.1, 1.0, 3.0)),
    (0.82, 20.0, (0.3, 1.0, 3.0)),
    (2.0, 20.0, (0.3, 1.0, 2.5)),
    (0.63, 30.0, (0.1, 1.0, 3.0)),
    (10.0, 0.0, (0.3, 1.0, 3.0)),
)
"""M, L (0: isoviscous) and omega b/u: rigid, half-loaded, two valleys, a band of negative damping."""


def _best(run: Callable[[], object]) -> float:
    """Shortest of five processor times [s], which do not count what other processes take."""
    times = []
    for _ in range(5):
        started = time.process_time()
        run()
        times.append(time.process_time() - started)
    return min(times)


def _direct(linear: Linearisation, omegas: np.ndarray) -> np.ndarray:
    """Film compliance by a complex solve of all equations at each frequency."""
    rates = np.column_stack([linear.storage(column) for column in np.eye(linear.size)])
    unit = linear.unit.astype(complex)
    heights = [np.linalg.solve(linear.matrix + 1j * omega * rates, unit)[linear.height] for omega in omegas]
    return -np.array(heights) - DRY_COMPLIANCE


def costs() -> None:
    """Print the table of costs and differences."""
    solver, fine = ReynoldsSolver(), ReynoldsSolver(density=26.0)
    print(f"{'M':>6s} {'L':>4s}  slow, ms  {FREQUENCIES} f., ms  ratio   direct     error  estimate   (largest)")
    ratios = []
    for M, L, celsius in POINTS:
        state = OIL.at(celsius + 273.15)
        alpha = state.pressure_viscosity.pressure_viscosity
        load, speed = load_and_speed(M, L, state.viscosity, alpha, CONTACT.radius, CONTACT.reduced_modulus)
        point = OperatingPoint(load, speed, celsius + 273.15)
        (film,) = solver.solve_line(CONTACT, OIL, (load,), speed, point.temperature)
        half = float(half_width(load, CONTACT.radius, CONTACT.reduced_modulus))
        natural = math.sqrt(half**2 + 2.0 * film.film_offset * CONTACT.radius) / speed
        frequencies = np.geomspace(0.01, 10.0, FREQUENCIES) / (2.0 * math.pi * natural)
        spectra = [
            contact_spectrum(each.film_spectrum(CONTACT, OIL, point, frequencies), CONTACT, point)
            for each in (solver, fine)
        ]
        slow = _best(
            lambda point=point: solver.solve_line(
                CONTACT, OIL, (point.load,), point.entrainment_speed, point.temperature
            )
        )
        many = _best(lambda point=point, f=frequencies: solver.film_spectrum(CONTACT, OIL, point, f))
        problem, *_ = line_problem(CONTACT, state, load, speed)
        profile = solve_groups(problem, M, L, solver.resolution).profile
        assert profile is not None
        omegas = 2.0 * np.pi * frequencies * half / speed
        direct = _direct(linearised_profile(profile), omegas) * 4.0 / CONTACT.reduced_modulus
        stiffness = np.abs(spectra[0].dynamic_stiffness)
        apart = np.max(np.abs(direct - spectra[0].film_compliance) * stiffness)
        error = np.max(np.abs(spectra[1].film_compliance - spectra[0].film_compliance) * stiffness)
        ratios.append(many / slow)
        print(
            f"{M:6g} {L:4g} {slow * 1e3:9.2f} {many * 1e3:10.2f} {ratios[-1]:6.2f}  {apart:7.1e}   {error:7.1e}   "
            f"{np.max(spectra[0].dynamic_stiffness_error):7.1e}",
            flush=True,
        )
    print(f"ratio: median {np.median(ratios):.2f}, largest {max(ratios):.2f}")


def transients() -> None:
    """Print the linear response beside the film in time."""
    print(
        "\n     M    L  omega b/u  S of the film in time      S of the linear response    differ by: of abs(S) abs(1/K)"
    )
    for M, L, omegas in OSCILLATIONS:
        solution = solve_groups(roelands_problem(M, L) if L else isoviscous_problem(M), M, L, TRANSIENT)
        assert solution.profile is not None
        linear = film_compliances(linearised_profile(solution.profile), np.array(omegas))
        natural = math.sqrt(1.0 + 2.0 * solution.film_offset)
        for omega, expected in zip(omegas, linear, strict=True):
            # at high frequency what is left of the start takes more periods to decay
            found = oscillated(solution, omega, 160, periods=8 if omega * natural > 5.0 else 3)
            apart = abs(found - expected)
            print(
                f"{M:6g} {L:4g} {omega:10g}  {found:24.5g}  {complex(expected):24.5g}  {apart / abs(expected):20.1e}"
                f"{apart / abs(SOLIDS + expected):10.1e}",
                flush=True,
            )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--transient", action="store_true", help="also the film in time; some minutes")
    arguments = parser.parse_args()
    costs()
    if arguments.transient:
        transients()


if __name__ == "__main__":
    with threadpool_limits(1):
        main()
