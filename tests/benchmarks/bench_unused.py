"""What a scene does not use, and what it costs: rings that cannot tilt, and a speed that does not change.

    python -m tests.benchmarks.bench_unused nu308.nc [--duration 0.1] [--rounds 3]

The shipped scene nu308_rigid with a shaft that moves in y and z only, in runs in time: processor time with all slices
and tilts over that with one slice of each depth and no tilts (the median of alternating runs), and by how much the
recorded forces and motions of all elements differ, over the largest of each. Films with memory keep parabolas for some
steps, which slices take anew in turn; other slices are other turns, so that these runs agree as well as the parabolas.
Then how often a law is prepared for a speed in a run at constant speed.
"""

from __future__ import annotations

import argparse
import dataclasses
import time
from unittest import mock

import numpy as np

from ehdmaps.maps.emap import open_map
from mbs import Model, assemble, read_scene, runup
from mbs.analyses.runup import RunUpResult
from mbs.bearings.speed_tables import SpeedWindow
from mbs.model.profiles import Course, SpeedProfile
from mbs.scene.scene import Scene
from mbs.transient import run_elements

SPEEDS = (100.0, 102.0)
"""Speeds of the run [rad/s]: within the map."""

STEP = 1e-5


def radial(profile: str, duration: float) -> Scene:
    """The shipped scene, whose shaft does not tilt."""
    scene = read_scene("nu308_rigid")
    bodies = [dataclasses.replace(body, freedoms=("y", "z")) for body in scene.bodies]
    assert scene.run_up is not None
    settings = dataclasses.replace(scene.run_up.settings, step=STEP, sample=10.0 * STEP)
    course = dataclasses.replace(
        scene.run_up, speed=SpeedProfile(Course((0.0, duration), SPEEDS)), duration=duration, settings=settings
    )
    changed = dataclasses.replace(scene, bodies=bodies, run_up=course)
    return changed.with_bearings(dataclasses.replace(entry, profile=profile) for entry in changed.bearings)


def timed(model: Model) -> tuple[float, RunUpResult]:
    """Processor time of a run [s], and what it gave."""
    begin = time.process_time()
    found = runup(model)
    return time.process_time() - begin, found


def difference(one: RunUpResult, other: RunUpResult) -> float:
    """Largest difference of forces and motions of an element, over the largest value of each."""
    pairs = [*zip(one.record.forces, other.record.forces, strict=True)]
    pairs += zip(one.record.motions, other.record.motions, strict=True)
    # An element along which nothing acts has no size to relate to.
    return max(float(np.max(np.abs(a - b)) / max(np.max(np.abs(a)), 1e-300)) for a, b in pairs)


def compared(model: Model, rounds: int) -> tuple[float, float]:
    """Ratio of processor times with all slices and with what is used, and the difference of the results."""
    whole = mock.patch.object(run_elements, "_placed", lambda entry: entry)
    with whole:
        timed(model)
    timed(model)
    ratios, worst = [], 0.0
    for _ in range(rounds):
        with whole:
            before, all_slices = timed(model)
        after, used = timed(model)
        ratios.append(before / after)
        worst = max(worst, difference(all_slices, used))
    return float(np.median(ratios)), worst


def collapses(model: Model) -> int:
    """How often a table of the law is made in a run at constant speed; that of all bearings is one."""
    assert model.scene.run_up is not None
    duration = model.scene.run_up.duration
    steady = SpeedProfile(Course((0.0, duration), (SPEEDS[0], SPEEDS[0])))
    made: list[tuple[object, int]] = []
    hold = SpeedWindow._hold

    def counted(window: SpeedWindow, slot: int, key: tuple[bool, float], speed: float) -> None:
        if window._held[slot] != key:
            made.append((window, slot))
        hold(window, slot, key, speed)

    with mock.patch.object(SpeedWindow, "_hold", counted):
        runup(model, dataclasses.replace(model.scene.run_up, speed=steady))
    return len(made)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map")
    parser.add_argument("--duration", type=float, default=0.1)
    parser.add_argument("--rounds", type=int, default=3)
    asked = parser.parse_args()
    emap = open_map(asked.map)
    print("rings that cannot tilt                 processor time, all over used   largest difference")
    for profile in ("iso", "straight"):
        scene = radial(profile, asked.duration)
        for name, films in (("hertz", None), ("map", "slow"), ("map", "memory")):
            model = assemble(scene, name, emap if name == "map" else None, films=films)
            ratio, worst = compared(model, asked.rounds)
            words = f"{profile} profile, {name}{f', {films} films' if films else ''}"
            print(f"  {words:36s} {ratio:29.2f} {worst:20.1e}")
    print("constant speed                         tables of the law made in the run")
    for films in ("slow", "memory"):
        model = assemble(radial("iso", asked.duration), "map", emap, films=films)
        print(f"  {films + ' films':36s} {collapses(model):25d}")


if __name__ == "__main__":
    main()
