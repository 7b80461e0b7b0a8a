"""Processor time of a solved point contact and its differences from finer grids; and a film table that was made anew.

Run: python -m tests.benchmarks.bench_points [FILE.nc]

Points are drawn over the coordinates of the table up to the heaviest load that was solved, and over both contacts of a
6208 with FVA 3. First: its ellipticity is new to the process, whose kernels are made for it. Again: the shortest of two
more solves, with the same kernels. Differences are those from 51 x 18 and 76 x 27 cells, extrapolated as the others.

FILE.nc is what `python -m examples.tables points` wrote: node by node beside the shipped table, with the error that it
states there; "beyond" is the share of nodes that differ by more.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.solids import STEEL
from ehdmaps.point.grid import point_grid
from ehdmaps.point.problem import PointProblem
from ehdmaps.point.solver import point_groups
from ehdmaps.point.tail import similarity
from ehdmaps.point.two_grids import PointGroups, Resolution, solve_groups
from ehdmaps.table.points.file import read_point_table, shipped_point_table
from ehdmaps.table.points.nodes import ERRORS, FIELDS, point_load_number
from examples.tables.point_errors import random_points
from examples.tables.point_lines import group_problem
from examples.tables.points import SOLVED

SEED = 12345
SHOWN = ("central_film", "minimum_film", "film_offset", "stiffness", "damping")


def over_the_table(count: int) -> list[PointProblem]:
    """Random points over the table."""
    found = []
    for zeta, size, shape, alpha, bend in random_points(shipped_point_table().nodes.axes, SOLVED, count, SEED).T:
        L, kappa = math.exp(size), math.exp(shape)
        M = float(point_load_number(zeta, np.asarray(L), np.asarray(kappa)))
        found.append(group_problem(M, L, kappa, math.exp(alpha), float(bend)))
    return found


def of_a_bearing(count: int) -> list[PointProblem]:
    """Random points of both contacts of a 6208 with FVA 3: 5 to 2000 N, 0.5 to 20 m/s, 30 to 90 degC."""
    random, oil, contacts = np.random.default_rng(SEED), Lubricant.named("FVA3"), ball_estimate("6208").contacts(STEEL)
    found = []
    for i in range(count):
        load, speed = np.exp(random.uniform(*np.log([[5.0, 0.5], [2000.0, 20.0]])))
        contact, state = contacts[i % 2], oil.at(float(random.uniform(303.15, 363.15)))
        M, L = point_groups(contact, state, float(load), float(speed))
        found.append(PointProblem(contact.ellipticity, M, L, state.isotherm(float(contact.max_pressure(load)))))
    return found


def spent(work: Callable[[], object]) -> float:
    """Processor time of some work [s]."""
    begin = time.process_time()
    work()
    return time.process_time() - begin


def timed(label: str, problems: list[PointProblem]) -> None:
    """Print times and differences of some points."""
    first, again, apart = [], [], []
    for problem in problems:
        point_grid.cache_clear()
        similarity.cache_clear()
        found: list[PointGroups] = []
        first.append(spent(lambda: found.append(solve_groups(problem, Resolution()))))  # noqa: B023
        again.append(min(spent(lambda: solve_groups(problem, Resolution())) for _ in range(2)))  # noqa: B023
        finer = solve_groups(problem, Resolution().finer)
        if found[0].numbers is not None and finer.numbers is not None:
            ours, theirs = (np.array([getattr(x, name) for name in SHOWN]) for x in (found[0].numbers, finer.numbers))
            apart.append(np.abs(ours / theirs - 1.0))
    for words, times in (("first", first), ("again", again)):
        print(f"{label}, {words}: median {np.median(times):.3f} s, {min(times):.3f} to {max(times):.3f}, mean "
              f"{np.mean(times):.3f}; {len(times)} points")  # fmt: skip
    middle, most = 100.0 * np.percentile(apart, (50, 95), axis=0)
    told = ", ".join(f"{name} {a:.2f} ({b:.2f})" for name, a, b in zip(SHOWN, middle, most, strict=True))
    print(f"{label}, from finer grids, median (95 %) [%]: {told}")


def beside(path: Path) -> None:
    """Print differences of the nodes of a table that was made anew from those of the shipped one."""
    ours, theirs = shipped_point_table().nodes, read_point_table(path).nodes
    if any(not np.array_equal(a, b) for a, b in zip(ours.axes.all, theirs.axes.all, strict=True)):
        raise SystemExit(f"{path}: other nodes than those of the shipped table")
    zeta, size, shape, alpha, bend = (x.ravel() for x in np.meshgrid(*ours.axes.all, indexing="ij"))
    stated, hole = ours.errors(ours.place(zeta, size, shape, (alpha, bend)))
    apart = np.abs(theirs.values.astype(float) - ours.values).reshape(-1, len(FIELDS))
    print(f"{'nodes beside the shipped table [%]':34s}" + "".join(f"{x:>9s}" for x in COLUMNS))
    for part, here in (("solved", zeta <= SOLVED), ("continued", zeta > SOLVED)):
        for k, field in enumerate(FIELDS):
            told, wrong = stated[here & ~hole, ERRORS.index(field.name)], apart[here & ~hole, k]
            middle, most, worst = np.percentile(wrong, (50, 95, 100))
            row: FloatArray = 100.0 * np.array([middle, most, worst, np.median(told), np.mean(wrong > told)])
            print(f"{part:12s}{field.name:22s}" + "".join(f"{x:9.3f}" for x in row))
    codes = ours.codes.astype(int) - theirs.codes
    print(f"codes of errors: {100.0 * np.mean(codes == 0):.1f} % alike, largest difference {np.max(np.abs(codes))}; "
          f"continued cells alike: {np.array_equal(ours.continued, theirs.continued)}")  # fmt: skip


COLUMNS = ("median", "95 %", "worst", "stated", "beyond")


def main(*paths: str) -> None:
    """Print all."""
    for path in paths:
        beside(Path(path))
    if not paths:
        solve_groups(of_a_bearing(1)[0], Resolution())  # compiles
        timed("table", over_the_table(40))
        timed("6208, FVA 3", of_a_bearing(20))


if __name__ == "__main__":
    main(*sys.argv[1:])
