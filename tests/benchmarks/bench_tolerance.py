"""Cost of a tolerance of levels: processor time of a run-up with `--tolerance`, the first time, over the plain run.

Run: python -m tests.benchmarks.bench_tolerance [SCENE ...] [--law "hertz:1.25e-5 s"] [--tolerance "3 dB"] [--pairs 3]

Each pair is a plain run and one with the tolerance, in one process, after a pair that compiles. Each has its laws made
anew, and a choice that was kept before is not used. Ramps of gears are shortened. Where the settings do not stay, the
run itself is another one, so that the ratio says less about the trials.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable

import numpy as np

from mbs.analyses.campbell import CampbellResult, campbell
from mbs.analyses.step_error import StepCheck
from mbs.instruments.tolerance import Numerics, Tolerated, read_tolerance, within
from mbs.scene import changes, map_set
from mbs.scene.choices import LawChoice, Subject
from mbs.scene.reader import read_scene

DURATIONS = {"nu308_rigid": None, "nu2210_shaft": None, "gearbox": 0.5, "n1014_testrig": None}
"""Lengths of the ramps [s]; None: that of the scene."""


def made(subject: Subject) -> tuple[CampbellResult, StepCheck | None]:
    """A run-up with its analysis, and the errors that it states of its step."""
    found = campbell(subject.model(), subject.scene.campbell, keep_partial=True)
    return found, found.runs[0].steps


def spent(work: Callable[[], object]) -> float:
    """Processor time of some work [s]."""
    map_set._made.cache_clear()
    begin = time.process_time()
    work()
    return time.process_time() - begin


def cost(subject: Subject, tolerance: float, pairs: int) -> tuple[list[float], float, Tolerated]:
    """Times with a tolerance over those without, of pairs; the shortest plain one [s], and what was chosen."""
    last: list[Tolerated] = []

    def tolerated() -> None:
        last[:] = [within(subject, tolerance, made)[0]]

    ratios, shortest = [], math.inf
    for pair in range(pairs + 1):
        plain, more = spent(lambda: made(subject)), spent(tolerated)
        if pair:
            ratios.append(more / plain)
            shortest = min(shortest, plain)
    return ratios, shortest, last[0]


def main() -> None:
    """Print a line for each scene."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", metavar="SCENE", nargs="*", default=list(DURATIONS))
    parser.add_argument("--law", default="hertz:1.25e-5 s")
    parser.add_argument("--tolerance", default="3 dB")
    parser.add_argument("--pairs", type=int, default=3)
    arguments = parser.parse_args()
    for name in arguments.scenes:
        scene, duration = read_scene(name), DURATIONS.get(name)
        scene = scene if duration is None else changes.with_duration(scene, duration)
        given, subject = Numerics.of(scene), Subject(scene, LawChoice(arguments.law, arguments.law))
        ratios, plain, told = cost(subject, read_tolerance(arguments.tolerance), arguments.pairs)
        same = "settings stay" if told.numerics == given else f"chosen: {told.numerics.text}"
        print(
            f"{name:15} {np.median(ratios):.3f} of the plain run ({min(ratios):.3f} to {max(ratios):.3f}; "
            f"{plain:.3g} s), trials {told.seconds:.3g} s; {same}; {'met' if told.met else 'not met'}",
            flush=True,
        )


if __name__ == "__main__":
    main()
