"""Speed of the ball bearing's force with stiffness and damping, beside the error of its stiffness; and in runs in time.

Run: python -m tests.benchmarks.bench_balls [--runs]

A 6208 of 9 balls under combined displacements: dry with a damper, and with films of ISO VG 32 at 80 degC, slow and with
a memory over a step. Compiled is what an integrator in C pays a call, processor time; the ring stands, or moves by
up to 10 nm a call. The error is that of the stiffness against central differences of 2 nm.

--runs: a stiff rotor on two 6208, two NU208 and two 32208 of 21 slices whose rings tilt, and springs alone, at one
speed in steps of 20 us: processor time of a step, without what a run takes to begin, and what a bearing adds to it.
"""

from __future__ import annotations

import ctypes
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ehdmaps.kernel.library import library
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.films import ball_films
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.locating.film_memory import FilmsInTime
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.model.relaxation import Films
from mbs.scene.assembly import assemble
from mbs.scene.reader import parse_scene
from mbs.settings import Settings
from mbs.transient.run import run

POSE = np.array([20e-6, 15e-6, 3e-6, 0.0, 1e-4, 2e-4])
STEP = np.array([1e-6, 1e-6, 1e-6, 0.0, 1e-5, 1e-5])
TIMES = 20000
RPM = math.pi / 30.0
MACHINE = """
schema = 1
[operation]
speed = "600 rpm"
temperature = "80 degC"
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[lubricant]
name = "ISO VG 32"
[[bodies]]
name = "rotor"
freedoms = ["x", "y", "z", "theta_y", "theta_z"]
spin = 1
mass = "20 kg"
polar_inertia = "0.05 kg m^2"
transverse_inertia = "0.2 kg m^2"
frames = { left = ["-100 mm", "0 mm", "0 mm"], right = ["100 mm", "0 mm", "0 mm"] }
[[springs]]
name = "axial"
on = "rotor"
stiffness = { x = "1e6 N/m" }
[[unbalances]]
name = "residual"
on = "rotor"
moment = "50 g mm"
"""
BEARING = """
[[bearings]]
name = "{name}"
inner = "rotor:{name}"
outer = "ground"
{bearing}
"""
SPRING = """
[[springs]]
name = "{name}"
on = "rotor:{name}"
stiffness = { y = "1e8 N/m", z = "1e8 N/m" }
"""
BALLS = 'bearing = "6208"\ndiametral_clearance = "-5 um"'
ROLLERS = (
    'geometry = { estimate = "NU208", basic_static_rating = "53 kN", diametral_clearance = "-5 um" }\nslices = 21\n'
    'start_angle = "3 deg"'
)
TAPERED = 'bearing = "32208"\naxial_offset = "10 um"\n'
"""The right one is turned round."""


DRIVER = """
#include <math.h>
#include <stdint.h>
int ehd_ball_force_surely(const void *, const double *, void *, void *, double *, double *, double *);
void many(int64_t times, const double *step, const double *pose, const void *data, void *start, void *found, double *f,
          double *k, double *c) {
    double place[6];
    for (int64_t i = 0; i < times; i++) {
        for (int m = 0; m < 6; m++) place[m] = pose[m] + step[m] * sin(0.01 * (double)i);
        ehd_ball_force_surely(data, place, start, found, f, k, c);
    }
}
"""


def driver(folder: str) -> Callable[..., None]:
    """Function in C that calls the kernel many times, at poses around one."""
    source, made = Path(folder) / "many.c", Path(folder) / "many.so"
    source.write_text(DRIVER)
    options = ["-std=c99", "-O2", "-shared", "-fPIC", str(source), library()._name, "-lm", "-o", str(made)]
    subprocess.run(["gcc", *options], check=True)
    found = ctypes.CDLL(str(made)).many
    found.argtypes, found.restype = [ctypes.c_int64, *8 * [ctypes.c_void_p]], None
    return found


def stiffness_error(force: BallForce, speed: float) -> float:
    """Largest difference to the difference quotient, as a part of the largest entry; tilts by the arm."""
    found = np.zeros((6, 6))
    scale = np.array([1.0, 1.0, 1.0, 1.0, force.shape.arm, force.shape.arm])
    exact = force(POSE, inner_speed=speed)[1]
    for i in (0, 1, 2, 4, 5):
        step = np.zeros(6)
        step[i] = 2e-9 / scale[i]
        ahead, back = (force(POSE + way * step, inner_speed=speed)[0] for way in (1.0, -1.0))
        found[:, i] = (back - ahead) / (2.0 * step[i])
    return float(
        np.max(np.abs((found - exact) / np.outer(scale, scale))) / np.max(np.abs(exact / np.outer(scale, scale)))
    )


def run_cost(part: str, law: str, films: Films | None = None) -> float:
    """Processor time of a step [s] at one speed, between springs or two bearings with a law, by runs of two lengths."""
    parts = [part.replace("{name}", name) for name in ("left", "right")]
    if TAPERED in parts[1]:
        parts[1] = parts[1].replace('"10 um"', '"-10 um"\nmirrored = true')
    model = assemble(parse_scene(MACHINE + "".join(parts), "rotor", "rotor.toml"), law, films=films)
    start, settings = equilibrium(model.system, model.operation).displacement, Settings(step=2e-5, sample=1e-3)
    speed, taken = SpeedProfile.constant(model.operation.speed), []
    for length in (0.1, 0.5):
        best = math.inf
        for _ in range(3):
            begin = time.process_time()
            done = run(model.system, speed, length, settings, displacement=start)
            best = min(best, time.process_time() - begin)
            assert done.compiled == done.steps
        taken.append(best)
    return (taken[1] - taken[0]) / (0.4 / settings.step)


def runs() -> None:
    """Print the cost of bearings in runs."""
    bare = run_cost(SPRING, "hertz")
    print(f"a step, us; what a bearing adds to the {1e6 * bare:.1f} us of the rotor between springs")
    for name, lines in (("6208", BALLS), ("NU208", ROLLERS), ("32208", TAPERED)):
        for law, films in (("hertz:1.25e-5 s", None), ("table", "slow"), ("table", "memory")):
            if films == "memory" and name == "NU208":
                continue
            cost = run_cost(BEARING.replace("{bearing}", lines), law, films)
            print(f"  {name:6s} {films or law:16s} {1e6 * cost:7.1f} {0.5e6 * (cost - bare):7.1f}")


def force_of(kind: str, speed: float) -> BallForce:
    """The bearing, dry or with films that are slow or have a memory, which holds a step of 20 us."""
    geometry = ball_estimate("6208")
    if kind == "dry":
        return BallForce(geometry, dry_law(geometry, damping_time=1.25e-5))
    entrainment = geometry.entrainment_speed(speed, 0.0)
    law = ball_films(geometry, Lubricant.named("ISO VG 32"), entrainment, 353.15, solves=False).law
    force = BallForce(geometry, law)
    if kind == "memory":
        force(POSE, inner_speed=speed)
        force.held = FilmsInTime.at_rest(force).held(2e-5, force.shorter)
    return force


def main() -> None:
    """Print the table."""
    if "--runs" in sys.argv:
        runs()
        return
    print("6208, 9 balls, f + K + C, us a call; error of K against differences")
    print(f"{'rpm':>8s} {'films':>8s} {'stands':>8s} {'moves':>8s} {'error':>9s}")
    with tempfile.TemporaryDirectory() as folder:
        many = driver(folder)
    for kind, rpm in (("dry", 0.0), ("dry", 3e3), ("dry", 15e3), ("slow", 3e3), ("memory", 3e3)):
        speed = rpm * RPM
        force = force_of(kind, speed)
        force(POSE, inner_speed=speed)
        found = []
        for step in (np.zeros(6), STEP):
            arguments = step.ctypes.data, POSE.ctypes.data, force._arguments[0], *force._arguments[2:]
            many(10, *arguments)
            best = math.inf
            for _ in range(5):
                start = time.process_time()
                many(TIMES, *arguments)
                best = min(best, (time.process_time() - start) / TIMES)
            found.append(1e6 * best)
        print(f"{rpm:8.0f} {kind:>8s} {found[0]:8.2f} {found[1]:8.2f} {stiffness_error(force, speed):9.1e}")


if __name__ == "__main__":
    main()
