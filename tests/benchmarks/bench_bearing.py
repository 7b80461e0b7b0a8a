"""Speed of the bearing force beside its error, for several numbers of slices; all in one run.

Run: python -m tests.benchmarks.bench_bearing [MAP.nc]

An NU308 of 12 rollers, without clearance, so that all rollers carry films, at a tilted pose and in motion. Compiled is
what a compiled integrator pays a call, Python what a script pays, both at fixed speed and temperature. The error is
that of force and stiffness against 401 slices, at the pose that the load of 2 kN makes with each number of slices for
the stiffness, and at one fixed pose for the force. Without a map file the law is that of a film formula.
"""

from __future__ import annotations

import ctypes
import math
import sys
import time
from collections.abc import Callable

import numpy as np
from numba import njit

import ehdmaps
from ehdmaps.kernel.library import function
from ehdmaps.physics.lubricant import Lubricant
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.force_at_point import ForceAtPoint

SLICES = (11, 21, 41, 81, 161)
CONVERGED = 401
POSE = np.array([0.0, 7e-6, 7e-6, 0.0, 1e-5, 2e-5])
VELOCITY = np.array([0.0, 1e-5, 2e-5, 0.0, 1e-5, 2e-5])
LOAD = 2e3 * np.array([1.0, 1.0]) / math.sqrt(2.0)


FORCE = function("ehd_cylinder_force", ctypes.c_void_p)


@njit
def many(times, address):
    """Call the kernel many times from compiled code."""
    for _ in range(times):
        FORCE(address)


def best_of(call: Callable[[], object], times: int, repeats: int = 15) -> float:
    """Shortest mean time of a few [us]."""
    call()
    found = []
    for _ in range(repeats):
        start = time.process_time()
        for _ in range(times):
            call()
        found.append((time.process_time() - start) / times)
    return min(found) * 1e6


def stiffness(point: ForceAtPoint) -> float:
    """Stiffness along the load at its equilibrium [N/m]."""
    at = np.array([5e-6, 5e-6])
    for _ in range(60):
        f, K, _ = point([0.0, *at, 0.0, 0.0, 0.0])
        at = at + np.linalg.solve(K[1:3, 1:3], f[1:3] + LOAD)
    along = LOAD / np.linalg.norm(LOAD)
    return float(along @ K[1:3, 1:3] @ along)


def main() -> None:
    """Print the table."""
    bearing = Bearing.named("NU308", clearance=0.0)
    if len(sys.argv) > 1:
        law = ehdmaps.open_map(sys.argv[1]).law("series", "clamp")
    else:
        law = laws.formula(bearing, Lubricant.named("FVA3"), outside="clamp")
    print(f"{'law':8} {'slices':>7} {'compiled us':>12} {'Python us':>10} {'force error':>12} {'stiffness error':>16}")
    for name, each in (("map", law), ("hertz", laws.hertz(bearing, 100.0))):
        exact = BearingForce(bearing, each, CONVERGED).at(1.0, 330.0)
        force, k = exact(POSE)[0], stiffness(exact)
        for slices in SLICES:
            point = BearingForce(bearing, each, slices).at(1.0, 330.0)
            point(POSE, VELOCITY)
            compiled = best_of(lambda point=point: many(1000, point.address.data), 2) / 1000
            called = best_of(lambda point=point: point(POSE, VELOCITY), 2000)
            error = np.linalg.norm(point(POSE)[0][1:3] - force[1:3]) / np.linalg.norm(force[1:3])
            softer = abs(stiffness(point) / k - 1.0)
            print(f"{name:8} {slices:7d} {compiled:12.2f} {called:10.2f} {error:12.1e} {softer:16.1e}")
    print("\n41 slices, from Python, one condition changed at each call:")
    element = BearingForce(bearing, law)
    step = iter(range(10**9))

    def varied(first: float, last: float, temperature: bool = False, q: float = 0.0, both: bool = False) -> None:
        part = (next(step) * 0.6180339887) % 1.0
        value = first + (last - first) * part
        u, T = (1.0, value) if temperature else (value, 320.0 + 20.0 * part if both else 330.0)
        element(POSE, VELOCITY, entrainment_speed=u, temperature=T, centrifugal_load=q)

    low = law.speed_range[0]
    for what, call, times in (
        ("speed", lambda: varied(0.5, 1.5), 300),
        ("temperature", lambda: varied(320.0, 340.0, True), 300),
        ("speed and temperature", lambda: varied(0.5, 1.5, both=True), 300),
        ("speed, with a centrifugal load", lambda: varied(0.5, 1.5, q=50.0), 30),
        ("speed, below the lowest mapped one", lambda: varied(0.2 * low, 0.8 * low), 30),
    ):
        print(f"  {what:36} {best_of(call, times, 7):8.1f} us")
    element(POSE, VELOCITY, entrainment_speed=0.5 * low, temperature=330.0)
    fixed = element.at(0.5 * low, 330.0)
    print(f"  {'none, below the lowest mapped speed':36} {best_of(lambda: fixed(POSE, VELOCITY), 30, 7):8.1f} us")


if __name__ == "__main__":
    main()
