"""What a time step of the shipped gearbox costs with films that have a memory, beside films of slow motion.

Run: python -m tests.benchmarks.bench_film_steps MAP.nc [--rounds 5] [--duration 0.03]

Rows are pieces of the scene's ramp of 400 rpm each second, and the steady speed of 500 rpm; `run-up` is their mean over
the ramp, 500 to 2500 rpm. Both kinds of films run in turns, and each number is the median of the rounds: microseconds
of the processor a step, their ratio, and Newton iterations a step.
"""

from __future__ import annotations

import argparse
import math
import time

import numpy as np

import ehdmaps
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, SpeedProfile
from mbs.model.relaxation import Films
from mbs.scene.assembly import Model, assemble
from mbs.scene.reader import read_scene
from mbs.transient.run import run

RPM = math.pi / 30.0
RATE = 400.0
"""Of the ramp [rpm/s]."""
PIECES = (500.0, 1000.0, 1500.0, 2000.0, 2500.0)
"""Speeds around which the ramp is run [rpm]."""
KINDS: tuple[Films, Films] = ("slow", "memory")


def course(speed: float, rate: float, duration: float) -> SpeedProfile:
    """A ramp of `rate` [rpm/s] around a speed [rpm]."""
    half = 0.5 * rate * duration
    return SpeedProfile(Course((0.0, duration), ((speed - half) * RPM, (speed + half) * RPM)))


def cost(model: Model, profile: SpeedProfile, duration: float) -> tuple[float, float]:
    """Microseconds and Newton iterations a step."""
    assert model.scene.run_up is not None
    start = equilibrium(model.system, Operation(profile.at(0.0)[0])).displacement
    begin = time.process_time()
    record = run(model.system, profile, duration, model.scene.run_up.settings, displacement=start)
    return 1e6 * (time.process_time() - begin) / record.steps, record.iterations / record.steps


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("map", metavar="MAP.nc")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--duration", type=float, default=0.03)
    arguments = parser.parse_args()
    scene, emap = read_scene("gearbox"), ehdmaps.open_map(arguments.map)
    models = [assemble(scene, "map", emap, films=kind) for kind in KINDS]
    rows = [("500 rpm, steady", 500.0, 0.0), *((f"{speed:g} rpm, ramp", speed, RATE) for speed in PIECES)]
    for model in models:
        cost(model, course(500.0, 0.0, 1e-3), 1e-3)  # compiles
    print(f"{'':16} {'slow':>8} {'memory':>8} {'ratio':>6}   Newton, slow and memory")
    ramp = []
    for label, speed, rate in rows:
        profile = course(speed, rate, arguments.duration)
        rounds = [[cost(model, profile, arguments.duration) for model in models] for _ in range(arguments.rounds)]
        middle = np.median(np.array(rounds), axis=0)
        ramp += [middle[:, 0]] if rate else []
        (slow, memory), (of_slow, of_memory) = middle[:, 0], middle[:, 1]
        print(f"{label:16} {slow:8.1f} {memory:8.1f} {memory / slow:6.2f}   {of_slow:.2f} {of_memory:.2f}", flush=True)
    slow, memory = np.average(ramp, axis=0, weights=[0.5, *[1.0] * (len(ramp) - 2), 0.5])
    print(f"{'run-up':16} {slow:8.1f} {memory:8.1f} {memory / slow:6.2f}")


if __name__ == "__main__":
    main()
