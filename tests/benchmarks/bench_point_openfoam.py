"""Point contacts by OpenFOAM against `reynolds`: differences, both stated errors, and cost.

Run: python -m tests.benchmarks.bench_point_openfoam [--seed N] [--columns N --lines N]

Points are drawn, even in the logarithms: light ones and moderate ones over M, L and ellipticity, and both contacts of a
6208; the oil is ISO VG 46. Nothing of either solver was chosen by them. Under each difference stands the sum of the
errors that both state, and a mark where it is exceeded. Times are wall times of a point, both meshes together.
"""

from __future__ import annotations

import argparse
import math

import numpy as np

from ehdmaps.openfoam.point import OpenFoamPointSolver
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ellipse import Ellipse, curvature_ratio
from ehdmaps.physics.solids import STEEL
from ehdmaps.point import solve
from ehdmaps.point.two_grids import Resolution

OIL = Lubricant.named("ISO VG 46")
RADIUS, MODULUS, TEMPERATURE = 8e-3, 230.769e9, 323.15
NAMES = ("central_film", "minimum_film", "max_pressure", "approach", "stiffness", "damping")
HEADS = ("central film", "least film", "peak", "approach", "k", "c")

Place = tuple[Ellipse, float, float, float]
"""Ellipse, load [N], speed [m/s], temperature [K]."""


def drawn(count: int, seed: int, loads: tuple[float, float]) -> list[Place]:
    """Points over Moes' M, L from 5 to 10 and ellipticities from 1 to 8."""
    random, state = np.random.default_rng(seed), OIL.at(TEMPERATURE)
    found = []
    for _ in range(count):
        M = math.exp(random.uniform(*np.log(loads)))
        L, kappa = float(random.uniform(5.0, 10.0)), math.exp(random.uniform(0.0, math.log(8.0)))
        U = (L / (state.pressure_viscosity.pressure_viscosity * MODULUS)) ** 4
        speed = U * MODULUS * RADIUS / (2.0 * state.viscosity)
        ellipse = Ellipse(RADIUS, RADIUS / float(curvature_ratio(kappa)), MODULUS)
        found.append((ellipse, M * MODULUS * RADIUS**2 * U**0.75, speed, TEMPERATURE))
    return found


def of_a_bearing(count: int, seed: int) -> list[Place]:
    """Contacts of a 6208 in turn: 10 to 1000 N a ball, 1 to 10 m/s, 40 to 90 degC."""
    random, contacts = np.random.default_rng(seed), ball_estimate("6208").contacts(STEEL)
    found = []
    for i in range(count):
        load, speed = np.exp(random.uniform(*np.log([[10.0, 1.0], [1000.0, 10.0]])))
        found.append((contacts[i % 2], float(load), float(speed), float(random.uniform(313.15, 363.15))))
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seed", type=int, default=31)
    parser.add_argument("--columns", type=int, default=96)
    parser.add_argument("--lines", type=int, default=36)
    options = parser.parse_args()
    solver = OpenFoamPointSolver(columns=options.columns, lines=options.lines)
    print(f"{options.columns} x {options.lines} columns of half of the contact, two thirds each way for the estimates")
    print(f"{'OpenFOAM less reynolds, % (stated)':34s}{'h, nm':>8s}" + "".join(f"{x:>15s}" for x in HEADS))
    groups = {
        "moderate": drawn(6, options.seed, (10.0, 300.0)),
        "light": drawn(2, options.seed + 1, (3.0, 10.0)),
        "6208": of_a_bearing(6, options.seed + 2),
    }
    apart: list[list[float]] = []
    for name, places in groups.items():
        for ellipse, load, speed, temperature in places:
            cfd = solver.solve(ellipse, OIL, load, speed, temperature)
            other = solve(ellipse, OIL, load, speed, temperature)
            line = f"{name:9s}M {other.load_number:6.4g} L {other.oil_number:4.3g} kappa {ellipse.ellipticity:4.3g}"
            if not (cfd.status.usable and other.status.usable):
                print(f"{line:34s} {cfd.status.word}: {cfd.reason:.60}; reynolds {other.status.word}")
                continue
            cells, row = "", []
            for key in NAMES:
                difference = getattr(cfd, key) / getattr(other, key) - 1.0
                stated = getattr(cfd, key).error + getattr(other, key).error
                cells += f"{100 * difference:+7.2f} ({100 * stated:4.2g}){'!' if abs(difference) > stated else ' '}"
                row.append(abs(difference))
            apart.append(row)
            print(f"{line:34s}{1e9 * cfd.central_film:8.1f}{cells} {cfd.solve_seconds:5.1f} s", flush=True)
    print(f"{'median of all':42s}" + "".join(f"{100 * x:8.2f}       " for x in np.median(apart, axis=0)))
    print(f"{'largest':42s}" + "".join(f"{100 * x:8.2f}       " for x in np.max(apart, axis=0)))
    ladder(groups["moderate"][0])


def ladder(place: Place) -> None:
    """Print the central film of a point on finer meshes of both solvers."""
    found: list[tuple[int, float, float]] = []
    for columns, lines in ((48, 18), (72, 27), (108, 42)):
        film = OpenFoamPointSolver(columns=columns, lines=lines).solve(place[0], OIL, *place[1:])
        found.append((columns, film.central_film, film.central_film.error))
    others = [solve(place[0], OIL, *place[1:], resolution=grids) for grids in (Resolution(), Resolution().finer.finer)]
    told = ", ".join(f"{n} columns {1e9 * film:.3f} +- {1e9 * film * error:.3f}" for n, film, error in found)
    beside = " and ".join(f"{1e9 * other.central_film:.3f}" for other in others)
    print(f"central film of the first, nm: {told}; reynolds on its own grids and finer ones {beside}")


if __name__ == "__main__":
    main()
