"""Speed of the ball bearing's force with stiffness and damping, beside the error of its stiffness.

Run: python -m tests.benchmarks.bench_balls

A 6208 of 9 balls under combined displacements, dry with a damper. Compiled is what a compiled integrator pays a call,
processor time; the ring stands, or moves by up to a micrometre a call. The error is that of the stiffness against
central differences of 2 nm.
"""

from __future__ import annotations

import math
import time

import numpy as np
from numba import njit

from ehdmaps.physics.point.ball_catalogue import ball_estimate
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_kernel import ball_force
from mbs.bearings.balls.laws import dry_law

POSE = np.array([20e-6, 15e-6, 3e-6, 0.0, 1e-4, 2e-4])
STEP = np.array([1e-6, 1e-6, 1e-6, 0.0, 1e-5, 1e-5])
TIMES = 20000


@njit
def many(times, step, pose, numbers, cos, sin, shape, inner, outer, force, stiffness, damping, centres, balls):
    """Call the kernel many times from compiled code, at poses around one."""
    place = pose.copy()
    for i in range(times):
        for m in range(6):
            place[m] = pose[m] + step[m] * math.sin(0.01 * i)
        ball_force(place, numbers, cos, sin, shape, inner, outer, force, stiffness, damping, centres, balls)


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


def main() -> None:
    """Print the table."""
    geometry = ball_estimate("6208")
    force = BallForce(geometry, dry_law(geometry, damping_time=1.25e-5))
    print(f"{geometry.name}, {geometry.balls} balls, f + K + C, us a call; error of K against differences")
    print(f"{'rpm':>8s} {'stands':>8s} {'moves':>8s} {'error':>9s}")
    for rpm in (0.0, 3e3, 15e3):
        speed = rpm * math.pi / 30.0
        force(POSE, inner_speed=speed)
        numbers, arrays = force.kernel_arguments(inner_speed=speed)
        found = []
        for step in (np.zeros(6), STEP):
            many(10, step, POSE, numbers, *arrays)
            best = math.inf
            for _ in range(5):
                start = time.process_time()
                many(TIMES, step, POSE, numbers, *arrays)
                best = min(best, (time.process_time() - start) / TIMES)
            found.append(1e6 * best)
        print(f"{rpm:8.0f} {found[0]:8.2f} {found[1]:8.2f} {stiffness_error(force, speed):9.1e}")


if __name__ == "__main__":
    main()
