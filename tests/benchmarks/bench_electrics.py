"""Integrals of dA/h by the rules of `ehdmaps.electrics` beside fine solutions that they have not seen, and their cost.

Of points the rule is told with the films of the fine solution, and with those read from the table of points; beside it
stands the error of the central film that is read. What is tabulated at the nodes of that table is read between them no
better than its films are, whose errors the rule takes over.

Run: python -m tests.benchmarks.bench_electrics [--points N] [--lines N] [--seed N]

Reduced radii of 1 to 20 mm, ellipses of any shape of ball bearings, 0.3 to 2.8 GPa, three oils from 30 to 110 degC.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.electrics import point_capacitance
from ehdmaps.electrics.gaps import line_integral, point_integral
from ehdmaps.errors import EhdmapsError
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import STEEL
from ehdmaps.table.points.file import shipped_point_table
from tests.cases.electrics import fine_point, line_field_integral, point_field_integral

OILS = tuple(map(Lubricant.named, ("FVA3", "ISO VG 32", "ISO VG 220")))
MODULUS = 2.1e11 / 0.91


def between(rng: np.random.Generator, low: float, high: float) -> float:
    """A number, evenly in the logarithm."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def point_errors(rng: np.random.Generator, count: int) -> dict[str, list[float]]:
    """Relative errors at points by the rule, by it on films of the table, and of these; what fails is drawn again."""
    found: dict[str, list[float]] = {"points": [], "on films of the table": [], "central films of the table": []}
    table = shipped_point_table()
    while len(found["points"]) < count:
        radius = between(rng, 1e-3, 20e-3)
        ellipse = Ellipse(radius, radius * between(rng, 1.0, 200.0), MODULUS)
        load = 1e3 * (between(rng, 3e8, 2.8e9) / float(ellipse.max_pressure(1e3))) ** 3
        oil, speed, kelvin = OILS[rng.integers(3)], between(rng, 0.1, 12.0), rng.uniform(303.0, 383.0)
        try:
            coarse, fine = fine_point(ellipse, oil, load, speed, kelvin)
        except EhdmapsError:
            continue
        if coarse.field is None or fine.field is None or fine.load_number < 2.0:
            continue
        gap = max(100.0 * fine.central_film, 1e-4)
        first, second = (point_field_integral(each, gap) for each in (coarse, fine))
        films = (np.array([each]) for each in (load, fine.central_film, fine.minimum_film, fine.film_offset))
        rule = point_integral(ellipse, *films, gap)
        true = second - 0.8 * max(first - second, 0.0)
        found["points"].append(float((rule.zone + rule.beside)[0]) / true - 1.0)
        read = table.films(ellipse, oil, np.array([load]), np.array([speed]), kelvin)
        if np.all(read.central_film > 0.0):
            own = point_integral(ellipse, np.array([load]), read.central_film, read.minimum_film, read.film_offset, gap)
            found["on films of the table"].append(float((own.zone + own.beside)[0]) / true - 1.0)
            found["central films of the table"].append(float(read.central_film[0]) / fine.central_film - 1.0)
    return found


def line_errors(rng: np.random.Generator, count: int) -> list[float]:
    """Relative errors at lines, M from 0.1 to some hundreds."""
    solver, found = ReynoldsSolver(), list[float]()
    while len(found) < count:
        radius = between(rng, 1e-3, 20e-3)
        contact = LineContact("line", radius, STEEL, "half_space", reference_depth=radius)
        oil, speed, kelvin = OILS[rng.integers(3)], between(rng, 0.1, 12.0), rng.uniform(303.0, 383.0)
        load = 2.0 * np.pi * radius * between(rng, 3e7, 2.5e9) ** 2 / MODULUS
        film, profile = solver.film_profile(contact, oil, OperatingPoint(load, speed, kelvin))
        if profile is None:
            continue
        numbers = (load, film.central_film, film.minimum_film, film.film_offset)
        rule = line_integral(contact, *(np.array([each]) for each in numbers))
        half = float(half_width(load, radius, contact.reduced_modulus))
        found.append(float((rule.zone + rule.beside)[0]) / line_field_integral(profile, half, radius) - 1.0)
    return found


def main() -> None:
    """Print errors, and the time of a contact."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--points", type=int, default=40)
    parser.add_argument("--lines", type=int, default=100)
    parser.add_argument("--seed", type=int, default=7)
    asked = parser.parse_args()
    rng = np.random.default_rng(asked.seed)
    everything = {**point_errors(rng, asked.points), "lines": line_errors(rng, asked.lines)}
    for name, errors in everything.items():
        size = np.abs(errors)
        words = (
            f"median {np.median(errors):+.2%}, 90 % within {np.percentile(size, 90):.2%}, all within {size.max():.2%}"
        )
        print(f"{name}: {size.size} fine solutions, {words}")
    ellipse, oil = Ellipse(5e-3, 60e-3, MODULUS), OILS[0]
    loads = np.geomspace(10.0, 1e3, 1000)
    point_capacitance(ellipse, oil, loads, 3.0, 333.15, 2.2, 2e-4)
    start = time.process_time()
    point_capacitance(ellipse, oil, loads, 3.0, 333.15, 2.2, 2e-4)
    print(f"a contact of 1000, films read from the table: {1e3 * (time.process_time() - start):.1f} us")


if __name__ == "__main__":
    main()
