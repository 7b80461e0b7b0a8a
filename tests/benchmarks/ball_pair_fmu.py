"""A rotor on two units of a 7208B in O arrangement, in time, beside the same rotor on the bearings in Python.

Run: python -m tests.benchmarks.ball_pair_fmu

`mbs bearing` writes one unit with films from 600 to 12 000 rpm; two instances of it, one mirrored, carry a rotor with
preload and unbalance at 6000 rpm. Python reads the films of that speed. Both go through the same integrator, whose
error falls out: what is left is what the unit's table leaves between its speeds. Then by how much the speed of the
cage, which derivatives hold, would change K at 12 000 rpm.
"""

from __future__ import annotations

import contextlib
import dataclasses
import io
import math
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.films import ball_films
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.cli import main as mbs
from mbs.model.elements import Operation
from tests.cases.fmu import Unit

FREE = [0, 1, 2, 4, 5]
OUTPUTS = ("force.x", "force.y", "force.z", "moment.y", "moment.z")
POSE = ["pose.x", "pose.y", "pose.z", "pose.theta_y", "pose.theta_z"]
VELOCITY = [name.replace("pose", "velocity") for name in POSE]

INERTIA = np.array([5.0, 5.0, 5.0, 0.02, 0.02])
"""Of the rotor along x, y, z [kg], and about y and z [kg m2]."""

HALF, PRELOAD, UNBALANCE, SPEED, WARM = 40e-3, 10e-6, 50.0, 200.0 * math.pi, 333.15
"""Place of the bearings on both sides [m], way of each ring [m], force [N], speed [rad/s], temperature [K]."""

DURATION, SAMPLES = 0.01, 201

Force = Callable[[float, FloatArray, FloatArray, float], FloatArray]
"""Which bearing, pose, velocity (5,) of its inner ring and time [s] to the force on the ring (5,)."""


def on_units(unit: Unit) -> Force:
    """Forces of two instances."""
    models = {way: unit.instance() for way in (-1.0, 1.0)}
    unit.put(models[-1.0], ["mirrored"], [1.0])

    def force(way: float, pose: FloatArray, velocity: FloatArray, now: float) -> FloatArray:
        names = [*POSE, *VELOCITY, "speed.inner", "spin.inner"]
        unit.put(models[way], names, [*pose, *velocity, SPEED, SPEED * now])
        return unit.get(models[way], OUTPUTS)

    return force


def in_python() -> Force:
    """Forces of two bearings with the films of the speed."""
    nominal = ball_estimate("7208B")
    law = ball_films(nominal, Lubricant.named("FVA3"), nominal.entrainment_speed(SPEED), WARM, solves=False).law
    elements = {}
    for way in (-1.0, 1.0):
        geometry = dataclasses.replace(nominal, contact_angle=way * nominal.contact_angle)
        elements[way] = LocatingElement("bearing", "inner", "outer", BallForce(geometry, law))

    def force(way: float, pose: FloatArray, velocity: FloatArray, now: float) -> FloatArray:
        place, rate = np.zeros((2, 6))
        place[FREE], rate[FREE] = pose, velocity
        return elements[way].evaluate(place, rate, Operation(SPEED, angle=SPEED * now)).force[FREE]

    return force


def run(force: Force) -> FloatArray:
    """Displacements of the rotor (5, samples)."""

    def at(way: float, motion: FloatArray) -> FloatArray:
        arm = -way * HALF  # the plain one, which takes +x, stands at -x
        x, y, z, about_y, about_z = motion
        return np.array([x, y + arm * about_z, z - arm * about_y, about_y, about_z])

    def rates(now: float, state: FloatArray) -> FloatArray:
        total = UNBALANCE * np.array([0.0, math.cos(SPEED * now), math.sin(SPEED * now), 0.0, 0.0])
        total[3] += 1e-2 * total[1]  # the unbalance is not in the middle
        for way in (-1.0, 1.0):
            pose = at(way, state[:5])
            pose[0] += way * PRELOAD
            found = force(way, pose, at(way, state[5:]), now)
            total += found
            total[3:] += way * HALF * np.array([found[2], -found[1]])
        return np.concatenate((state[5:], total / INERTIA))

    times = np.linspace(0.0, DURATION, SAMPLES)
    options = {"method": "RK45", "rtol": 1e-8, "atol": 1e-13, "max_step": 5e-5}
    return np.asarray(solve_ivp(rates, (0.0, DURATION), np.zeros(10), t_eval=times, **options).y[:5])


def held_cage(unit: Unit) -> float:
    """Largest difference of the derivatives by pose and quotients of forces, at 12 000 rpm, over the largest of K."""
    model, parts = unit.instance(), []
    unit.put(model, ["pose.x", "pose.y", "speed.inner"], [15e-6, 2e-6, 2.0 * SPEED])
    for name in POSE[:3]:
        place, sides = unit.get(model, (name,))[0], []
        for step in (2e-8, -2e-8):
            unit.put(model, [name], [place + step])
            sides.append(unit.get(model, OUTPUTS))
        unit.put(model, [name], [place])
        parts.append((unit.derivatives(model, name, OUTPUTS)[:3], (sides[0] - sides[1])[:3] / 4e-8))
    exact, quotient = np.array(parts).swapaxes(0, 1)
    return float(np.max(np.abs(exact - quotient)) / np.max(np.abs(exact)))


def main() -> None:
    """Print differences and costs."""
    with tempfile.TemporaryDirectory() as name, contextlib.redirect_stderr(io.StringIO()):
        path = Path(name) / "pair.fmu"
        words = ["--speed", "600 rpm", "12000 rpm", "5", "--law", "table", "--temperature", "60 degC", "-o", str(path)]
        with contextlib.redirect_stdout(io.StringIO()):
            assert mbs(["bearing", "7208B", "--load", "1 kN", "--axial", "3 kN", *words]) == 0
        unit = Unit(path, Path(name) / "unit")
        found = []
        for force in (on_units(unit), in_python()):
            begin = time.perf_counter()
            found.append(run(force))
            print(f"{time.perf_counter() - begin:.1f} s", end=" ")
        across, tilts = (
            np.abs(found[0] - found[1])[rows].max() / np.abs(found[1])[rows].max() for rows in ([1, 2], [3, 4])
        )
        print(f"for units, Python; as a part of what they move: displacements {across:.1e}, tilts {tilts:.1e}")
        print(f"K at 12 000 rpm with a cage whose speed is held: {held_cage(unit):.1e}")


if __name__ == "__main__":
    main()
