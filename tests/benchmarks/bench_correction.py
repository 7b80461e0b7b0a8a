"""What a few points of a dearer solver are worth: errors at held-out points, corrected by 0 to 32 of them, and costs.

Run: python -m tests.benchmarks.bench_correction [--pair NAME] [--job JOB] [--points N ...] [--held-out N]
    [--store FILE]

The held-out points are drawn over the job's own range with another seed than the candidates of the design, one in five
in the damping valley. `left out` is what the correction itself says of its error: at its own points, each left out in
turn, each weighed by the part of the range that is nearest to it. `in 1 s` is the share of held-out points within one
standard deviation that the map would state, 68 % where these are right. Costs are those that the dearer solver states
for its points, and processor seconds of choosing them and of the fit. Runs take over what the store has.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.correction import JUDGED, Correction, Films, Place, correction, error_of, quantiles
from ehdmaps.jobs.make.sampling import VALLEY_SHARE, draw, draw_in_valley
from ehdmaps.jobs.make.store import Arrays, NoStore, Results, Store
from ehdmaps.jobs.make.sweep import sweep
from ehdmaps.jobs.make.tasks import LineTask
from ehdmaps.jobs.reader import read_job
from ehdmaps.physics.solution import ContactSolver, Status

HELD_OUT_SEED = 77

PAIRS = {
    "formula-reynolds": (("formula", {}), ("reynolds", {})),
    "coarse-reynolds": (("reynolds", {"density": 4.0}), ("reynolds", {"density": 12.0})),
    "reynolds-thin_film": (("reynolds", {}), ("openfoam", {"flow": "thin_film"})),
    "heat-thin_film": (
        ("reynolds", {"physics": "thermal", "shear": "limiting"}),
        ("openfoam", {"physics": "thermal", "shear": "limiting"}),
    ),
    "reynolds-full_stress": (("reynolds", {}), ("openfoam", {"flow": "full_stress"})),
}
"""Cheaper and dearer solver, each with its keys."""


class HeldOut:
    """Points that no correction has seen, with the films of both solvers.

    Parameters
    ----------
    job : Job
        Over whose range they are drawn.
    count : int
        How many.
    pair : sequence of two ContactSolver
        Cheaper and dearer solver.
    results : Results
        Store.
    """

    def __init__(self, job: Job, count: int, pair: Sequence[ContactSolver], results: Results) -> None:
        rng = np.random.default_rng(HELD_OUT_SEED)
        valley = round(VALLEY_SHARE * count)
        drawn = [draw(job, rng) for _ in range(count - valley)]
        while len(drawn) < count:
            drawn += [point for point in [draw_in_valley(job, rng)] if point is not None]
        self.tasks = [
            [LineTask(p.contact, job.lubricant, (p.load,), p.speed, p.temperature, s) for s in pair] for p in drawn
        ]
        self.found = sweep([task for both in self.tasks for task in both], results, 1).arrays
        self.asked = count

    def errors(self, made: Correction | None) -> tuple[dict[str, FloatArray], dict[str, FloatArray]]:
        """Errors of `JUDGED` of the cheaper solver with a correction, and what the map would state of k and c."""
        errors: dict[str, list[float]] = {name: [] for name in JUDGED}
        stated: dict[str, list[float]] = {name: [] for name in JUDGED[1:]}
        for cheap, dear in self.tasks:
            arrays, true = self.found[cheap.key], self.found[dear.key]
            if not all(Status(int(one["status"][0])).usable for one in (arrays, true)):
                continue
            corrected = made.corrected(cheap, arrays) if made else arrays
            loads = np.array(cheap.loads)
            where = Place.of(cheap.contact, cheap.lubricant, loads, cheap.entrainment_speed, cheap.temperature)
            films, truth = Films.of(corrected), Films.of(true)
            for name, value in error_of(where, films, truth).items():
                errors[name].append(float(value[0]))
            if made:
                of_k, of_c = made.model_errors(films, where)
                # As `error_of` relates errors of damping.
                k = 1.0 / (where.dry + truth.compliance)
                c = np.abs(films.loss) / (where.dry + films.compliance) ** 2
                scale = np.maximum(truth.loss * k**2, 0.02 * k * where.width / where.speed)
                stated["stiffness"].append(float(of_k[0]))
                stated["damping"].append(float((of_c * c / scale)[0]))
        return {k: np.array(v) for k, v in errors.items()}, {k: np.array(v) for k, v in stated.items()}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pair", choices=PAIRS, default="formula-reynolds")
    parser.add_argument("--job", default="nu308")
    parser.add_argument("--points", type=int, nargs="+", default=[0, 8, 16, 32])
    parser.add_argument("--held-out", type=int, default=60)
    parser.add_argument("--store", type=Path)
    options = parser.parse_args()
    job = read_job(options.job)
    pair = [solvers.build(name, keys) for name, keys in PAIRS[options.pair]]
    if options.store is None:
        table(job, pair, options.pair, options.points, options.held_out, NoStore())
    else:
        with Store(options.store) as store:
            table(job, pair, options.pair, options.points, options.held_out, store)


def table(
    job: Job, pair: Sequence[ContactSolver], title: str, counts: Sequence[int], held_out: int, results: Results
) -> None:
    """Print the errors and costs of one pair of solvers."""
    cheap, dear = pair
    held = HeldOut(job, held_out, pair, results)
    errors, _ = held.errors(None)
    print(f"{title}: {job.title}, {job.lubricant.title}; {errors['stiffness'].size} of {held.asked} held-out points")
    print(
        "points usable  dear s  own s | film: median   95 %  largest | k: median   95 %  largest  in 1 s | "
        "c: median   95 %  largest  in 1 s | left out, median and 95 %: film, k, c"
    )
    for count in counts:
        known: dict[str, Arrays] = {}
        solving = [0.0]

        def solve(
            tasks: Sequence[LineTask], known: dict[str, Arrays] = known, spent: list[float] = solving
        ) -> Mapping[str, Arrays]:
            begun = time.process_time()
            known |= sweep(tasks, results, 1).arrays
            spent[0] += time.process_time() - begun
            return known

        begun = time.process_time()
        made = correction(job, cheap, dear, count, solve) if count else None
        own = time.process_time() - begun - solving[0]
        errors, stated = held.errors(made)
        print(row(count, made, own, errors, stated), flush=True)


def row(
    count: int,
    made: Correction | None,
    own: float,
    errors: Mapping[str, FloatArray],
    stated: Mapping[str, FloatArray],
) -> str:
    """One line of the table."""
    usable, seconds = (made.record["usable"], made.record["solve_seconds"]) if made else (0, 0.0)
    cells = [f"{count:6d} {usable:6d} {seconds:7.1f} {own:6.2f}"]
    for name, found in quantiles(errors).items():
        text = f"{found['median']:10.2%} {found['95 %']:7.2%} {found['largest']:8.2%}"
        if name in stated:
            inside = np.mean(np.abs(errors[name]) <= stated[name]) if made else np.nan
            text += f" {inside:7.0%}" if made else "       -"
        cells.append(text)
    if made:
        left = made.record["leave_one_out"]
        cells.append("; ".join(f"{left[name]['median']:.2%} {left[name]['95 %']:.2%}" for name in JUDGED))
    return " | ".join(cells)


if __name__ == "__main__":
    main()
