"""Error of the step that runs state of themselves, beside the true one: how often it is on the safe side, and how wide.

Run: python -m tests.benchmarks.bench_step_error [SCENE ...] [--law "hertz:1.25e-5 s"]

Each scene is run with several steps and clearances. True is the difference of levels from those of a quarter of the
step, which 95 % of 40 windows of the run keep; levels more than 20 dB below the loudest ones count as these 20 dB.
Ramps are shortened, so that each run takes seconds. Errors below 0.01 dB count as that. Rows of the dry law without
damping are runs whose levels scatter.
"""

from __future__ import annotations

import argparse

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.analyses.operating import held
from mbs.analyses.ramp import recorded_run, run_course
from mbs.analyses.step_error import level_change, step_check, up_to, window_sizes
from mbs.scene import changes
from mbs.scene.assembly import assemble
from mbs.scene.reader import parse_scene, read_scene
from mbs.scene.scene import Scene
from tests.cases.swinging import SWINGING

WINDOWS = 40
FINER = 4
QUANTILE = 0.95
LEAST = 0.01
"""Errors below it are equal [dB]."""

LAWS = ("hertz:1.25e-5 s", "hertz")
CASES: dict[str, tuple[float | None, tuple[float, ...], tuple[float | None, ...]]] = {
    "swinging": (1.0, (4e-5, 8e-5), (None,)),
    "nu2210_shaft": (0.5, (1e-5, 2e-5, 4e-5), (None, 30e-6)),
    "nu308_flexible": (0.5, (1e-5, 2e-5), (None, 5e-6)),
    "nu308_rigid": (0.2, (1e-5, 2e-5, 4e-5), (None, 30e-6)),
    "n1014_testrig": (0.3, (5e-6, 1e-5, 2e-5), (None, 10e-6)),
    "overhung_rotor": (None, (5e-5, 1e-4), (None,)),
    "gearbox": (0.25, (1e-5, 2e-5), (None, 40e-6)),
    "two_stage": (0.25, (1e-5, 2e-5), (None,)),
}
"""Length of the ramp [s], steps [s], clearances [m]; None: that of the scene."""


def named(name: str) -> Scene:
    """A scene by its name."""
    return parse_scene(SWINGING, name, "swinging.toml") if name == "swinging" else read_scene(name)


def signals(scene: Scene, law: str, clearance: float | None, check: bool) -> tuple[FloatArray, FloatArray | None]:
    """Signals of a run up to the highest frequency of the scene, and the errors that it states of itself."""
    highest = scene.campbell.highest
    course = run_course(scene, highest, problems := [])
    assert course is not None, problems
    model = held(assemble(scene, law, clearance=clearance))
    record = recorded_run(model, course, scene.sensors, marks=check)
    stated = step_check(model, course, record, highest) if check else None
    return up_to(record.signals, course.settings.step, highest), None if stated is None else stated.largest


def true_error(coarse: FloatArray, fine: FloatArray) -> FloatArray:
    """Difference of the levels that most windows keep, shape (sensors,) [dB]."""
    change = level_change(window_sizes(coarse, WINDOWS), window_sizes(fine, WINDOWS))
    return np.asarray(np.quantile(change, QUANTILE, axis=0))


def main() -> None:
    """Print each run, then how often the stated error covers the true one."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", metavar="SCENE", nargs="*", default=list(CASES))
    parser.add_argument("--law", action="append", help="default: dry with and without damping")
    arguments = parser.parse_args()
    ratios: dict[str, list[float]] = {}
    print("scene           law              clearance     step  stated / true of each sensor [dB]")
    for name in arguments.scenes:
        duration, steps, clearances = CASES[name]
        for law in arguments.law or LAWS:
            for clearance in clearances:
                for step in steps:
                    scene = named(name) if duration is None else changes.with_duration(named(name), duration)
                    scene = changes.with_step(scene, step)
                    coarse, stated = signals(scene, law, clearance, True)
                    fine, _ = signals(changes.with_step(scene, step / FINER), law, clearance, False)
                    true = true_error(coarse, fine)
                    gap = "as it is" if clearance is None else f"{1e6 * clearance:.3g} um"
                    pairs = (
                        "none"
                        if stated is None
                        else ", ".join(f"{one:.2f} / {other:.2f}" for one, other in zip(stated, true, strict=True))
                    )
                    print(f"{name:15} {law:16} {gap:>9} {1e6 * step:5.3g} us  {pairs}", flush=True)
                    if stated is not None:
                        ratio = np.maximum(stated, LEAST) / np.maximum(true, LEAST)
                        ratios.setdefault(law, []).extend(ratio.tolist())
    for law, found in ratios.items():
        told = np.array(found)
        print(
            f"{law}: {told.size} signals; true up to 3 times the stated error: {100 * np.mean(told >= 1 / 3):.0f} %; "
            f"stated over true {np.median(told):.2g} in the median, {told.min():.2g} to {told.max():.2g}; within a "
            f"factor of 3: {100 * np.mean((told >= 1 / 3) & (told <= 3)):.0f} %"
        )


if __name__ == "__main__":
    main()
