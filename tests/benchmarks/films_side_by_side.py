"""Contact laws by the film formula, by the film table and by a map of solved lines, beside fresh solves: time, errors.

Run: python -m tests.benchmarks.films_side_by_side [POINTS]

For three bearings and six oils, over the ranges of the shipped jobs. Points at random, a fifth of them in the damping
valley, are drawn by a seed, and solved afresh by `reynolds` with density = 14 and inlet_length = 700. Errors in per
cent, median / 95 %: of k; of c beside the larger of itself and 0.02 k b/u. Times are processor times of one process:
until a law of both contacts is there, and for a point that is solved afresh.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.generate import generate_in_memory
from ehdmaps.jobs.make.law_check import SMALL_DAMPING, at_loads
from ehdmaps.jobs.make.sampling import SamplePoint, draw_apart
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.catalogue import estimate
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolution, contact_solution
from mbs.bearings.bearing import Bearing
from mbs.bearings.laws import formula
from tests.benchmarks.film_table import LOADS, REFERENCE, SPEEDS, TEMPERATURES, oils

OILS = 6
"""Oils of the family of the table that are compared."""

_SEED = 11


def main(argv: Sequence[str]) -> None:
    count = int(argv[0]) if argv else 60
    bearings = {name: BearingGeometry.named(name) for name in ("NU308", "N1014")} | {"NU206": estimate("NU206")}
    print(f"{'':30s} {'film formula':>28s} {'film table':>28s} {'map of solved lines':>28s} {'fresh':>7s}")
    each = f"{'s':>6s} {'k [%]':>10s} {'c [%]':>10s}"
    print(f"{'bearing, oil':30s} {each} {each} {each} {'s/point':>7s}")
    kept: dict[str, list[FloatArray]] = {}
    spent: dict[str, list[float]] = {}
    for bearing, geometry in bearings.items():
        for oil, lubricant in list(oils().items())[:OILS]:
            row = _compared(geometry, lubricant, count)
            print(f"{f'{bearing}, {oil}':30s} {_words(row)}", flush=True)
            for way, (seconds, errors) in row.items():
                kept.setdefault(way, []).append(errors)
                spent.setdefault(way, []).append(seconds)
    everything = {way: (float(np.median(spent[way])), np.concatenate(parts, axis=1)) for way, parts in kept.items()}
    print(f"{'all, times: median':30s} {_words(everything)}")


def _words(row: Mapping[str, tuple[float, FloatArray]]) -> str:
    """One line of the table."""
    parts = []
    for way, (seconds, errors) in row.items():
        if way == "fresh":
            parts.append(f"{seconds:7.3f}")
            continue
        told = (f"{np.quantile(found, 0.5):.2g}/{np.quantile(found, 0.95):.2g}" for found in 100.0 * errors)
        parts.append(f"{seconds:6.2f} " + " ".join(f"{text:>10s}" for text in told))
    return " ".join(parts)


def _compared(geometry: BearingGeometry, oil: Lubricant, count: int) -> dict[str, tuple[float, FloatArray]]:
    """Seconds and errors of k and c, (2, n), by the way to the law."""
    job = Job.build(
        lubricant=oil,
        bearing=geometry,
        structural_law="iso16281",
        loads=np.geomspace(*LOADS, 25),
        entrainment_speeds=np.geomspace(*SPEEDS, 12),
        temperatures=np.linspace(*TEMPERATURES, 6),
    )
    over, valley = draw_apart(job, np.random.default_rng(_SEED), count)
    begin = time.process_time()
    drawn = [(point, _solved(point, oil)) for point in (*over, *valley)]
    seconds = (time.process_time() - begin) / len(drawn)
    points = [(point, found) for point, found in drawn if found.status.usable]
    ways: dict[str, tuple[float, FloatArray]] = {}
    for way in ("formula", "table", "solved"):
        begin = time.process_time()
        laws = _laws(job, way)
        ways[way] = time.process_time() - begin, _errors(laws, points)
    return {**ways, "fresh": (seconds, np.zeros((2, 0)))}


def _solved(point: SamplePoint, oil: Lubricant) -> ContactSolution:
    """One point, solved afresh."""
    (film,) = REFERENCE.solve_line(point.contact, oil, (point.load,), point.speed, point.temperature)
    return contact_solution(film, point.contact, OperatingPoint(point.load, point.speed, point.temperature))


def _laws(job: Job, way: str) -> dict[str, ContactLaw]:
    """Laws of both contacts."""
    names = [contact.name for contact in job.contacts]
    if way == "formula":
        bearing = Bearing(job.bearing)
        return {name: formula(bearing, job.lubricant, kind=name, outside="clamp") for name in names}
    made = generate_in_memory(replace(job, law_check=0, solver_options={"films": way}), workers=1)
    emap = EHDMap(made.dataset, made.backbone)
    return {name: emap.law(name, "clamp") for name in names}


def _errors(laws: Mapping[str, ContactLaw], points: list[tuple[SamplePoint, ContactSolution]]) -> FloatArray:
    """Relative errors of k and c, (2, n)."""
    found = []
    for point, fresh in points:
        at = (np.array([x]) for x in (fresh.approach, point.load, point.speed, point.temperature))
        _, k, c = (float(x[0]) for x in at_loads(laws[point.contact.name], *at))
        width = float(half_width(point.load, point.contact.radius, point.contact.reduced_modulus))
        least = SMALL_DAMPING * fresh.stiffness * width / point.speed
        solved_c = max(fresh.damping, 0.0)
        found.append((abs(k / fresh.stiffness - 1.0), abs(c - solved_c) / max(solved_c, least)))
    return np.array(found).T


if __name__ == "__main__":
    main(sys.argv[1:])
