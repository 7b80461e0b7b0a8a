"""How often errors hold that `reynolds` states of films with heat, limiting stress and sliding.

Run: python -m tests.benchmarks.bench_warm_errors [--points N] [--seed S] [--kind KIND] [--wide] [--limit S]

Random points of the inner contact of NU308, FVA 3: 5 to 300 N/mm and 0.5 to 8 m/s, both logarithmic, 40 to 100 degC,
M above 0.5; slide-to-roll 0 (a third of the points) or 0.02 to 1, logarithmic. What is stated is compared with twice
the density of cells and its longer inlet. The error of that reference is bounded by its own statement, which is shown
as "references". Temperatures are the rises of the hottest place of the film and of the surfaces.

With --wide points are those of a whole map, 0.1 to 1000 N/mm, 0.05 to 10 m/s, 20 to 120 degC, in pure rolling, and the
reference has 29 points across the film, the most that there are, wherever it solves. With --limit solutions that take
more processor time than that, nearly all references of heavy contacts in cold oil, are counted as not solved.
"""

from __future__ import annotations

import argparse
import signal
import time
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl import line
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import ContactSolution, contact_solution

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
OIL = Lubricant.named("FVA3")
LOADS, SPEEDS, CELSIUS, SLIPS = (5e3, 3e5), (0.5, 8.0), (40.0, 100.0), (0.02, 1.0)
WIDE = (1e2, 1e6), (0.05, 10.0), (20.0, 120.0), None
LIGHTEST, REFERENCE, ACROSS = 0.5, 13.0, line.ACROSS_TOLERANCE
KINDS = {
    "thermal, limiting": {"physics": "thermal", "shear": "limiting"},
    "thermal, eyring": {"physics": "thermal", "shear": "eyring"},
    "isothermal, limiting": {"physics": "isothermal", "shear": "limiting"},
}
NAMES = ("film_offset", "stiffness", "damping", "central_film", "minimum_film", "rolling_force")
RISES = ("film_temperature", "surface_temperature")


class Place(NamedTuple):
    """Load [N/m], speed [m/s], temperature [K] and slide-to-roll ratio."""

    load: float
    speed: float
    temperature: float
    slip: float


def places(seed: int, count: int, wide: bool = False) -> list[Place]:
    """Points of the ranges above."""
    rng = np.random.default_rng(seed)
    found: list[Place] = []
    loads, speeds, celsius, slips = WIDE if wide else (LOADS, SPEEDS, CELSIUS, SLIPS)
    while len(found) < count:
        load, speed = (float(np.exp(rng.uniform(*np.log(ends)))) for ends in (loads, speeds))
        slip = 0.0 if slips is None else float(np.exp(rng.uniform(*np.log(slips))))
        temperature = float(rng.uniform(*celsius)) + 273.15
        state = OIL.at(temperature)
        alpha = state.pressure_viscosity.pressure_viscosity
        M, _ = moes_groups(load, speed, state.viscosity, alpha, CONTACT.radius, CONTACT.reduced_modulus)
        if wide or M > LIGHTEST:
            found.append(Place(load, speed, temperature, 0.0 if len(found) % 3 == 0 else slip))
    return found


def solved(place: Place, kind: str, density: float, across: float = ACROSS) -> ContactSolution:
    """The contact at one place, with as many points across as a tolerance asks for."""
    line.ACROSS_TOLERANCE = across
    solver = ReynoldsSolver(slide_to_roll=place.slip, density=density, **KINDS[kind])  # type: ignore[arg-type]
    (film,) = solver.solve_line(CONTACT, OIL, (place.load,), place.speed, place.temperature)
    return contact_solution(film, CONTACT, OperatingPoint(place.load, place.speed, place.temperature))


def solved_within(seconds: float, place: Place, kind: str, density: float, across: float) -> ContactSolution | None:
    """The same, or None where it takes more processor time [s]; zero allows any."""
    signal.signal(signal.SIGVTALRM, _late)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        return solved(place, kind, density, across)
    except TimeoutError:
        return None
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)


def _late(*_: object) -> None:
    raise TimeoutError


def numbers(place: Place, found: ContactSolution) -> FloatArray:
    """What is compared."""
    rises = [getattr(found, name) - place.temperature for name in RISES]
    return np.array([*(getattr(found, name) for name in NAMES), *rises])


def stated(place: Place, found: ContactSolution) -> FloatArray:
    """Relative errors that are stated of the same."""
    rises = [getattr(found, f"{name}_error") / (getattr(found, name) - place.temperature) for name in RISES]
    return np.abs([*(getattr(found, f"{name}_error") for name in NAMES), *rises])


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--points", type=int, default=30)
    parser.add_argument("--seed", type=int, default=4, help="1 to 3 are those by which the estimates were chosen")
    parser.add_argument("--kind", choices=KINDS, action="append")
    parser.add_argument("--wide", action="store_true")
    parser.add_argument("--limit", type=float, default=0.0, metavar="S", help="processor time of a reference [s]")
    options = parser.parse_args()
    for kind in options.kind or KINDS:
        started, rows, unsolved = time.perf_counter(), [], 0
        for place in places(options.seed, options.points, options.wide):
            found = solved(place, kind, ReynoldsSolver().density)
            across = 0.0 if options.wide else ACROSS
            reference = solved_within(options.limit, place, kind, REFERENCE, across)
            if reference is None or not (found.status.usable and reference.status.usable):
                unsolved += 1
                continue
            exact = numbers(place, reference)
            error = np.abs(numbers(place, found) / exact - 1.0)
            rows.append((error, stated(place, found), stated(place, reference)))
        errors, bars, references = (np.array(part) for part in zip(*rows, strict=True))
        seconds = time.perf_counter() - started
        print(f"{kind}: {len(rows)} points of seed {options.seed}, {unsolved} not solved on both; {seconds:.0f} s")
        print(f"  {'':20s}{'error: median':>16s}{'95 %':>10s}{'stated: median':>16s}{'held':>8s}{'references':>12s}")
        for i, name in enumerate((*NAMES, *(f"{each} rise" for each in RISES))):
            if not np.isfinite(errors[:, i]).all():
                continue
            print(
                f"  {name.replace('_', ' '):26s}{np.median(errors[:, i]):10.1e}{np.quantile(errors[:, i], 0.95):10.1e}"
                f"{np.median(bars[:, i]):16.1e}{100.0 * np.mean(errors[:, i] <= bars[:, i]):7.0f}%"
                f"{np.median(references[:, i]):12.1e}"
            )


if __name__ == "__main__":
    with threadpool_limits(1):
        main()
