"""What each physics costs and changes: film, k and c with laws of shear, heat and solids, over two bearings' maps.

Run: python -m tests.benchmarks.bench_physics [--points N] [--seed N] [--solver NAME]

Points are drawn at random, even in the logarithms, over the axes of the shipped jobs nu308 and n1014. Each is solved
with every physics in turn, beside the isothermal, Newtonian film of the same solver. Times are ratios of processor
times, at each point the quickest of three. The solids are compared at the same points: k of a whole contact by the
structural laws, beside ISO 16281. What a solver does not know is a row that says so.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.reader import read_job
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from tests.cases.physics_ways import NOT_THERE, SOLVERS, WAYS, Answer, answer, solver_of

JOBS = ("nu308", "n1014")
BASE = "newtonian"
LAWS = ("iso16281", "half_space", "palmgren", "fe")
"""Structural laws: the first is the one that others stand beside."""

NAMED = (
    ("nu308", 0, 2e5, 10.0, 100.0),
    ("nu308", 0, 2e4, 2.0, 100.0),
    ("nu308", 1, 5e3, 10.0, 20.0),
    ("n1014", 0, 8.8889e4, 3.297, 40.0),
    ("n1014", 1, 2e4, 3.0, 30.0),
    ("n1014", 0, 2e3, 1.0, 60.0),
)
"""Bearing, side, load [N/m], speed [m/s], celsius [degC] of points that are shown one by one."""


@dataclass(frozen=True)
class Case:
    """A point of a map with its contact and its oil."""

    name: str
    bearing: str
    side: int
    oil: Lubricant
    point: OperatingPoint

    def contact(self, law: str = LAWS[0]) -> LineContact:
        """The contact with the solids of a structural law."""
        return BearingGeometry.named(self.bearing).contacts(STEEL, law)[self.side]


def case_of(job: Job, bearing: str, side: int, load: float, speed: float, kelvin: float) -> Case:
    """A case under a name that says all of it."""
    where = ("inner", "outer")[side]
    name = f"{bearing} {where} {load / 1e3:.3g} N/mm {speed:.3g} m/s {kelvin - 273.15:.3g} degC"
    return Case(name, bearing, side, job.lubricant, OperatingPoint(load, speed, kelvin))


def drawn(count: int, seed: int) -> Iterator[Case]:
    """Points over the axes of the shipped jobs, each bearing and contact in turn."""
    generator = np.random.default_rng(seed)
    jobs = [read_job(name) for name in JOBS]
    for index in range(count):
        job = jobs[index % 2]
        assert job.bearing is not None
        shares = generator.random(3)
        axes = (job.loads, [speed for speed in job.entrainment_speeds if speed > 0.0])
        load, speed = (
            float(min(axis) * (max(axis) / min(axis)) ** share) for axis, share in zip(axes, shares, strict=False)
        )
        low, high = min(job.temperatures), max(job.temperatures)
        yield case_of(job, JOBS[index % 2].upper(), index // 2 % 2, load, speed, low + shares[2] * (high - low))


@dataclass(frozen=True)
class Change:
    """What a physics changes at a point, relative, and the ratio of times."""

    film: float
    stiffness: float
    damping: float
    times: float


def change(case: Case, base: Answer, other: Answer) -> Change:
    """One film beside that of the base."""
    contact, load = case.contact(), case.point.load
    assert base.film is not None and other.film is not None
    return Change(
        other.film.central_film / base.film.central_film - 1.0,
        other.stiffness(contact, load) / base.stiffness(contact, load) - 1.0,
        (other.damping(contact, load) - base.damping(contact, load)) / abs(base.damping(contact, load)),
        other.seconds / base.seconds,
    )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--points", type=int, default=48)
    parser.add_argument("--seed", type=int, default=15)
    parser.add_argument("--solver", choices=SOLVERS, default="reynolds")
    options = parser.parse_args()
    solvers = {way: solver_of(options.solver, way) for way in WAYS}
    cases = list(drawn(options.points, options.seed))
    repeats = 3 if options.solver == "reynolds" else 1
    answer(solvers[BASE], cases[0].contact(), cases[0].oil, cases[0].point)  # compiles
    answers = {
        way: [answer(solver, case.contact(), case.oil, case.point, repeats) for case in cases]
        for way, solver in solvers.items()
    }
    print(f"{options.solver}: {len(cases)} points, seed {options.seed}; {BASE} is isothermal and Newtonian")
    print(f"{'changes, %, median (5 to 95 %)':<30} {'solved':>8} {'film':>22} {'k':>22} {'c':>26}   processor time")
    for way in WAYS:
        print(row(way, cases, answers[BASE], answers[way]))
    print()
    print_named(options.solver)
    print()
    print_laws(cases, answers[BASE])


def row(way: str, cases: Sequence[Case], base: Sequence[Answer], found: Sequence[Answer]) -> str:
    """Changes by one physics over all points, its statuses where points have no solution, and what it costs."""
    pairs = [(case, one, two) for case, one, two in zip(cases, base, found, strict=True) if one.usable and two.usable]
    if all(each.word == NOT_THERE for each in found):
        return f"{way:<30} {NOT_THERE:>8}"
    others = Counter(each.word for each in found if not each.usable)
    words = "".join(f"; {count} {word}" for word, count in others.most_common())
    solved = f"{sum(each.usable for each in found)}/{len(found)}"
    if way == BASE:
        median = 1e3 * _median([one.seconds for _, one, _ in pairs])
        return f"{way:<30} {solved:>8} {f'median {median:.2f}':>84} ms{words}"
    changes = [change(*pair) for pair in pairs]
    cells = [spread([getattr(each, name) for each in changes]) for name in ("film", "stiffness", "damping")]
    times = _median([each.times for each in changes])
    return f"{way:<30} {solved:>8} {cells[0]:>22} {cells[1]:>22} {cells[2]:>26}   x {times:.2f}{words}"


def spread(values: Sequence[float]) -> str:
    """Median and quantiles in percent."""
    if not values:
        return "-"
    low, middle, high = np.quantile(values, [0.05, 0.5, 0.95])
    return f"{100 * middle:+.2f} ({100 * low:+.1f} to {100 * high:+.1f})"


def print_named(solver: str) -> None:
    """Single points: film, k and c of the base, and the changes by each physics."""
    oil_of = {name: read_job(name) for name in JOBS}
    solvers = {way: solver_of(solver, way) for way in WAYS}
    ways = [way for way in WAYS if solvers[way] is not None and way != BASE]
    heads = "".join(f" | {way + ', %: h':>22} {'k':>7} {'c':>8}" for way in ways)
    print(f"{'single points':<44} {'h/nm':>8} {'k/(N/m2)':>10} {'c/(N s/m2)':>10}{heads}")
    for name, side, load, speed, celsius in NAMED:
        case = case_of(oil_of[name], name.upper(), side, load, speed, celsius + 273.15)
        base = answer(solvers[BASE], case.contact(), case.oil, case.point)
        if not base.usable:
            print(f"{case.name:<44} {base.word}")
            continue
        assert base.film is not None
        k, c = base.stiffness(case.contact(), load), base.damping(case.contact(), load)
        cells = []
        for way in ways:
            found = answer(solvers[way], case.contact(), case.oil, case.point)
            if found.usable:
                one = change(case, base, found)
                cells.append(f" | {100 * one.film:+22.2f} {100 * one.stiffness:+7.2f} {100 * one.damping:+8.2f}")
            else:
                cells.append(f" | {found.word:>39}")
        print(f"{case.name:<44} {1e9 * base.film.central_film:8.1f} {k:10.4g} {c:10.4g}{''.join(cells)}", flush=True)


def print_laws(cases: Sequence[Case], films: Sequence[Answer]) -> None:
    """Change of k and c by the structural law, with the same films."""
    print(f"{'solids beside ' + LAWS[0] + ', %':<30} {'points':>8} {'film':>22} {'k':>22} {'c':>26}")
    for law in LAWS[1:]:
        changes = []
        try:
            for case, found in zip(cases, films, strict=True):
                if found.usable:
                    own, usual = case.contact(law), case.contact()
                    load = case.point.load
                    k = found.stiffness(own, load) / found.stiffness(usual, load) - 1.0
                    c = found.damping(own, load) / found.damping(usual, load) - 1.0
                    changes.append((k, c))
        except (InputError, KeyError, ValueError):
            print(f"{law:<30} {NOT_THERE:>8}")
            continue
        k_changes, c_changes = zip(*changes, strict=True)
        print(f"{law:<30} {len(changes):>8} {'the same':>22} {spread(k_changes):>22} {spread(c_changes):>26}")


def _median(values: Sequence[float]) -> float:
    """Median of a few numbers."""
    return float(np.median(values))


if __name__ == "__main__":
    main()
