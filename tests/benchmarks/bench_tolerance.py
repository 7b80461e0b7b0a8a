"""Cost of a tolerance of levels: processor time of a run-up with `--tolerance` over the run itself.

Run: python -m tests.benchmarks.bench_tolerance [SCENE ...] [--law "hertz:1.25e-5 s"] [--tolerance "3 dB"] [--pairs 3]

Each pair is a run with the tolerance and a plain one with the settings that it chose, in one process, after a pair that
does not count. Where these are not those of the scene, a plain run with those of the scene is timed as well. Each has
its laws made anew. Ramps of gears are shortened.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable

import numpy as np

from mbs.analyses.campbell import CampbellResult, campbell
from mbs.analyses.step_error import StepCheck
from mbs.planning.tolerance import Numerics, Tolerated, read_tolerance, within
from mbs.scene import changes, map_set
from mbs.scene.reader import read_scene
from mbs.scene.subject import LawChoice, Subject

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


def cost(subject: Subject, tolerance: float, pairs: int) -> tuple[list[float], float, float, Tolerated]:
    """Times with a tolerance over those with its choice, of pairs; the shortest of these and of the scene's own [s]."""
    last: list[Tolerated] = []

    def tolerated() -> None:
        last[:] = [within(subject, tolerance, made)[0]]

    given = Numerics.of(subject.scene)
    ratios, chosen, own = list[float](), math.inf, math.inf
    for pair in range(pairs + 1):
        more = spent(tolerated)
        told = last[0]
        plain = spent(lambda: made(told.subject))  # noqa: B023
        scene = plain if told.numerics == given else spent(lambda: made(subject))
        if pair:
            ratios.append(more / plain)
            chosen, own = min(chosen, plain), min(own, scene)
    return ratios, chosen, own, last[0]


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
        ratios, chosen, own, told = cost(subject, read_tolerance(arguments.tolerance), arguments.pairs)
        same = (
            "settings stay" if told.numerics == given else f"chosen: {told.numerics.text}, {chosen / own:.2f} x scene's"
        )
        print(
            f"{name:15} {np.median(ratios):.3f} of the run itself ({min(ratios):.3f} to {max(ratios):.3f}; "
            f"{chosen:.3g} s), trials {told.seconds:.3g} s; {same}; {'met' if told.met else 'not met'}",
            flush=True,
        )


if __name__ == "__main__":
    main()
