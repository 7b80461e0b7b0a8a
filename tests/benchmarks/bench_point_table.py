"""The film table of points beside solved films: errors at random points from which it was not made, and times.

Run: python -m tests.benchmarks.bench_point_table [POINTS]

Points are drawn by a seed over M = 20 to 20 000, L = 3 to 25, ellipticity 1 to 14, alpha 8 to 36 /GPa and the bends of
the table, and over a 6208 with FVA 3, whose law is none of the table's. References are solved on the grids of the
table; "beyond" is the share of points that differ by more than the table states. Points are counted as a hole where the
table has no film and the solver has one, and as a slip where the table has one and the solver has none. Knee:
abs(zeta) < 1, where damping dives. Stiffness is the slope of the film offset, compared with solved tangents.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs.make.point_table import RESOLUTION, group_problem, read_errors, solved_point
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.solids import STEEL
from ehdmaps.point.solver import solve
from ehdmaps.point.two_grids import solve_groups
from ehdmaps.table.points.coordinates import point_zeta
from ehdmaps.table.points.file import shipped_point_table
from ehdmaps.table.points.nodes import ERRORS, FILMS, SLOPE

SEED, LOADS, KNEE = 7, (20.0, 20000.0), 1.0
NAMES = (*(field.name for field in FILMS), SLOPE)
_SHOWN = tuple(ERRORS.index(name) for name in NAMES)


def drawn(count: int) -> tuple[FloatArray, ...]:
    """M, ln L, ln kappa, ln alpha and bend of random points."""
    axes = shipped_point_table().nodes.axes
    random = np.random.default_rng(SEED)
    M = np.exp(random.uniform(*np.log(LOADS), count))
    return M, *(random.uniform(nodes[0], nodes[-1], count) for nodes in axes.all[1:])


def compared(count: int) -> tuple[FloatArray, FloatArray, FloatArray, dict[str, float]]:
    """zeta, differences and stated errors of points that both have, shape (n, errors), and what was counted."""
    nodes = shipped_point_table().nodes
    M, size, shape, alpha, bend = drawn(count)
    zeta = point_zeta(M, np.exp(size), np.exp(shape))
    inside = zeta <= nodes.axes.zeta[-1]
    started = time.process_time()
    solved = []
    for i in range(count):
        problem = group_problem(float(M[i]), *(math.exp(x[i]) for x in (size, shape, alpha)), float(bend[i]))
        solved.append(solved_point(problem, solve_groups(problem, RESOLUTION, finer=False)))
    seconds = time.process_time() - started
    place = nodes.place(zeta, size, shape, (alpha, bend))
    stated, hole = nodes.errors(place)
    has = ~hole & inside
    there = np.array([point is not None for point in solved])
    both = has & there
    at = tuple(x[both] for x in (zeta, size, shape, alpha, bend))
    wrong = read_errors(nodes, at, [point for point, known in zip(solved, both, strict=True) if known])
    counts = {
        "both": np.count_nonzero(both),
        "hole": np.count_nonzero(~has & there),
        "slip": np.count_nonzero(has & ~there),
        "neither": np.count_nonzero(~has & ~there),
        "seconds": seconds,
    }
    return zeta[both], wrong, stated[both], counts


def of_a_bearing(count: int) -> tuple[FloatArray, FloatArray]:
    """Differences and stated errors of both contacts of a 6208 with FVA 3, shape (n, names)."""
    random = np.random.default_rng(SEED)
    oil, table = Lubricant.named("FVA3"), shipped_point_table()
    wrong, stated = [], []
    for i in range(count):
        contact = ball_estimate("6208").contacts(STEEL)[i % 2]
        load, speed = np.exp(random.uniform(*np.log([5.0, 1500.0]))), np.exp(random.uniform(*np.log([0.5, 20.0])))
        point = float(load), float(speed), float(random.uniform(303.15, 363.15))
        films, found = table.films(contact, oil, *point), solve(contact, oil, *point)
        if films.usable.all() and found.status.usable:
            wrong.append([abs(math.log(float(getattr(films, name)) / getattr(found, name))) for name in NAMES])
            stated.append([float(films.errors[name]) for name in NAMES])
    return np.array(wrong), np.array(stated)


def told(label: str, wrong: FloatArray, stated: FloatArray) -> None:
    """Print a line for each number: differences, stated errors, and how many are beyond."""
    for k, name in enumerate(NAMES):
        middle, most, worst = np.percentile(wrong[:, k], (50, 95, 100))
        states, beyond = np.median(stated[:, k]), np.mean(wrong[:, k] > stated[:, k])
        row = "".join(f"{100.0 * x:9.2f}" for x in (middle, most, worst, states, beyond))
        print(f"{label:24s}{name:14s}{row}")


def main(count: int = 240) -> None:
    """Print the table."""
    zeta, wrong, stated, counts = compared(count)
    knee = np.abs(zeta) < KNEE
    print(f"{count} points: {counts['both']} in both, {counts['hole']} holes, {counts['slip']} slips, ", end="")
    print(f"{counts['neither']} in neither; {max(2, count // 6)} of a 6208")
    columns = "".join(f"{word:>9s}" for word in ("median", "95 %", "worst", "stated", "beyond"))
    print(f"{'differences [%]':38s}{columns}")
    told("all", wrong[:, _SHOWN], stated[:, _SHOWN])
    told("knee", wrong[knee][:, _SHOWN], stated[knee][:, _SHOWN])
    told("6208, FVA 3", *of_a_bearing(max(2, count // 6)))
    oil, contact = Lubricant.named("FVA3"), ball_estimate("6208").contacts(STEEL)[0]
    loads, table = np.geomspace(5.0, 1000.0, 100), shipped_point_table()
    started = time.process_time()
    for _ in range(20):
        table.films(contact, oil, loads, 5.0, 333.15)
    read = (time.process_time() - started) / 2000.0
    print(f"solved in {counts['seconds'] / count:.2g} s a point, read in {1e6 * read:.0f} us a point of 100 together")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
