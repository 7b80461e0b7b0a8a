"""The film table of points beside films on finer grids, beside lines under heavy loads, and times.

Run: python -m tests.benchmarks.bench_point_table [POINTS]

Points are drawn by a seed that set no error of the table, over its coordinates up to the heaviest load that was solved,
and over a 6208 with FVA 3, whose law is none of the table's. References are solved on grids with half as many cells
more in each direction than those of the table; "beyond" is the share of points that differ by more than the table
states. Knee: abs(zeta) < 1, where damping dives. Stiffness is the slope of the film offset, compared with solved
tangents. Heavier: a unit of ln M above the heaviest load of the table's nodes, where all is continued.

Beside lines: the central film of a heavy contact is that of a line contact of the same width, largest pressure, speed
and oil, which the film table of lines has, from another solver: at the middle the edge of the contact, where the film
is made, is the same.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.solids import STEEL
from ehdmaps.point.solver import solve
from ehdmaps.table.file import shipped_tables
from ehdmaps.table.points.file import shipped_point_table
from ehdmaps.table.points.nodes import ERRORS, FILMS, SLOPE, point_zeta
from examples.tables.point_errors import SEED as SET
from examples.tables.point_errors import finer_points, random_points, read_errors
from examples.tables.point_lines import RESOLUTION, THIN_RESOLUTION
from examples.tables.points import SOLVED

SEED, KNEE, HEAVIER, UNRESOLVED = 7, 1.0, 1.0, 0.15
NAMES = (*(field.name for field in FILMS), SLOPE)
_SHOWN = tuple(ERRORS.index(name) for name in NAMES)
assert SEED != SET


def compared(place: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """zeta, differences and stated errors of points that both have; NaN of what the finer grids do not resolve."""
    nodes = shipped_point_table().nodes
    solved = finer_points(place)
    stated, hole = nodes.errors(nodes.place(place[0], place[1], place[2], place[3:]))
    both = ~hole & np.array([point is not None for point in solved])
    finer = [point for point, known in zip(solved, both, strict=True) if known and point is not None]
    wrong = read_errors(nodes, tuple(place[:, both]), finer)
    wrong[np.array([point.errors for point in finer]) > UNRESOLVED] = math.nan
    print(f"{place.shape[1]} points: {np.count_nonzero(both)} in both, {np.count_nonzero(hole)} holes")
    return place[0][both], wrong[:, _SHOWN], stated[both][:, _SHOWN]


def of_a_bearing(count: int) -> tuple[FloatArray, FloatArray]:
    """Differences and stated errors of both contacts of a 6208 with FVA 3, shape (n, names)."""
    random = np.random.default_rng(SEED)
    oil, table = Lubricant.named("FVA3"), shipped_point_table()
    wrong, stated = [], []
    for i in range(count):
        contact = ball_estimate("6208").contacts(STEEL)[i % 2]
        load, speed = np.exp(random.uniform(*np.log([5.0, 4000.0]))), np.exp(random.uniform(*np.log([0.5, 20.0])))
        point = float(load), float(speed), float(random.uniform(303.15, 363.15))
        films = table.films(contact, oil, *point)
        thin = float(films.film_offset) < 0.07 * float(contact.semi_axes(load)[0]) ** 2 / contact.rolling_radius
        found = solve(contact, oil, *point, resolution=THIN_RESOLUTION if thin else RESOLUTION.finer)
        if films.usable.all() and found.status.usable:
            unresolved = [getattr(found, name).error > UNRESOLVED for name in NAMES]
            differences = [abs(math.log(float(getattr(films, name)) / getattr(found, name))) for name in NAMES]
            wrong.append(np.where(unresolved, math.nan, differences))
            stated.append([float(films.errors[name]) for name in NAMES])
    return np.array(wrong), np.array(stated)


def told(label: str, wrong: FloatArray, stated: FloatArray) -> None:
    """Print a line for each number: differences, stated errors, and how many are beyond."""
    for k, name in enumerate(NAMES):
        known = np.isfinite(wrong[:, k])
        here, says = wrong[known, k], stated[known, k]
        middle, most, worst = np.percentile(here, (50, 95, 100)) if here.size else (math.nan,) * 3
        row = "".join(f"{100.0 * x:9.2f}" for x in (middle, most, worst, np.median(says), np.mean(here > says)))
        print(f"{label:24s}{name:14s}{row}{here.size:7d}")


def beside_lines() -> None:
    """Print central films of heavy contacts over those of lines."""
    oil = Lubricant.named("FVA3")
    for side, contact in zip(("inner", "outer"), ball_estimate("6208").contacts(STEEL), strict=True):
        ratios, errors, places = [], [], []
        for speed, temperature in ((0.1, 373.15), (0.3, 353.15), (3.0, 333.15)):
            loads = np.geomspace(20.0, 1.1e4, 30)
            films = shipped_point_table().films(contact, oil, loads, speed, temperature)
            a, peak = np.asarray(contact.semi_axes(loads)[0]), np.asarray(contact.max_pressure(loads))
            for i in range(loads.size):
                line = LineContact("line", contact.reduced_modulus * a[i] / (4.0 * peak[i]), STEEL, "iso16281", 1e-2)
                width = math.pi * a[i] * peak[i] / 2.0
                found = shipped_tables().of(oil).films(line, oil, width, speed, temperature)
                ratios.append(float(films.central_film[i]) / float(found.central_film) - 1.0)
            errors += films.errors["central_film"].tolist()
            places += point_zeta(films.load_number, films.oil_number, np.full(30, contact.ellipticity)).tolist()
        apart, zeta = np.array(ratios), np.array(places)
        for low, high in ((3.0, SOLVED), (SOLVED, 8.2), (8.2, 11.2)):
            here = (zeta >= low) & (zeta < high) & np.isfinite(apart)
            least, most, says = 100.0 * np.min(apart[here]), 100.0 * np.max(apart[here]), np.array(errors)[here]
            print(f"{side}, zeta {low:.1f} to {high:.1f}: central film {least:+.1f} to {most:+.1f} % of that of a "
                  f"line, stated {100.0 * np.median(says):.1f} %")  # fmt: skip


def main(count: int = 60) -> None:
    """Print the table."""
    axes = shipped_point_table().nodes.axes
    started = time.process_time()
    zeta, wrong, stated = compared(random_points(axes, SOLVED, count, SEED))
    seconds = (time.process_time() - started) / count
    columns = "".join(f"{word:>9s}" for word in ("median", "95 %", "worst", "stated", "beyond"))
    print(f"{'differences [%]':38s}{columns}{'points':>7s}")
    told("all", wrong, stated)
    knee = np.abs(zeta) < KNEE
    told("knee", wrong[knee], stated[knee])
    told("6208, FVA 3", *of_a_bearing(max(2, count // 3)))
    heavier = random_points(axes, SOLVED, max(2, count // 6), SEED + 1)
    heavier[0] = SOLVED + HEAVIER * np.linspace(0.0, 1.0, heavier.shape[1])
    told("heavier", *compared(heavier)[1:])
    beside_lines()
    oil, contact = Lubricant.named("FVA3"), ball_estimate("6208").contacts(STEEL)[0]
    loads, table = np.geomspace(5.0, 1000.0, 100), shipped_point_table()
    started = time.process_time()
    for _ in range(20):
        table.films(contact, oil, loads, 5.0, 333.15)
    read = (time.process_time() - started) / 2000.0
    print(f"finer grids: {seconds:.2g} s a point; read in {1e6 * read:.0f} us a point of 100 together")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
