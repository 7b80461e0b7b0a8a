"""Speed sweep of a machine of the size of a gearbox: time beside the error of its modes and frequency responses.

Run: python -m tests.benchmarks.bench_sweep [MAP.nc]

Two flexible shafts with a gear pair on four NU308, 20 um of clearance, in a housing of random modes: a stand-in of the
same size for a gearbox, not a machine. 40 speeds, 2000 frequencies, two sensors. Without a map the bearings have the
film formula. Errors are against the full state matrix in physical coordinates (eigenvalues, of |lambda|) and against a
direct solution at each frequency (responses, of the largest at the sensor), at the first and the last speed.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np

import ehdmaps
from ehdmaps.physics.lubricant import Lubricant
from mbs import laws
from mbs.bearing import Bearing
from mbs.bearing_element import BearingElement
from mbs.bearing_force import BearingForce
from mbs.body import Body, Frame, Inertia
from mbs.elements import Input, Load, Operation, Sensor, Spring
from mbs.flexible.shaft import flexible_shaft
from mbs.flexible.shaft_parts import Disc, Section
from mbs.gear import GearPair, gear_mesh
from mbs.linear import frequency_response, state_space
from mbs.modes import state_modes, undamped_modes
from mbs.statics import equilibrium
from mbs.steady import steady_system
from mbs.sweep import sweep
from mbs.system import System

RPM = math.pi / 30.0
SPEEDS = np.linspace(500.0, 2500.0, 40) * RPM
FREQUENCIES = np.geomspace(50.0, 5000.0, 2000)
TEETH = (21, 23)
MODULE = 4.5e-3
SEATS = {"left": -0.08, "right": 0.08}


def housing(count: int) -> Body:
    """Modes from 300 Hz to 20 kHz of a housing of 30 kg, with random amplitudes at four seats."""
    random = np.random.default_rng(1)
    omega = 2.0 * math.pi * np.geomspace(300.0, 20e3, count)
    centre = 0.5 * MODULE * sum(TEETH)
    frames = {}
    for index, y in enumerate((0.0, centre)):
        for seat, x in SEATS.items():
            transform = random.normal(size=(6, count)) / math.sqrt(30.0)
            frames[f"{seat}_{index + 1}"] = Frame(np.array([x, y, 0.0]), transform)
    return Body(
        name="housing",
        coordinates=tuple(f"mode_{k + 1}" for k in range(count)),
        units=("1",) * count,
        mass=np.eye(count),
        gyroscopic=np.zeros((count, count)),
        damping=np.diag(0.02 * omega),
        stiffness=np.diag(omega**2),
        frames=frames,
    )


def machine(law: laws.Law) -> System:
    """The whole of it; the torque of 82 N m goes in and out at the shafts' ends, which a soft spring holds axially."""
    shafts, springs = [], []
    spins = (1.0, -TEETH[0] / TEETH[1])
    for index, (spin, teeth) in enumerate(zip(spins, TEETH, strict=True)):
        name = f"shaft_{index + 1}"
        gear = Inertia.cylinder(-0.0125, 0.0125, MODULE * teeth, 0.04)
        shafts.append(
            flexible_shaft(
                name,
                [Section(-0.12, 0.12, 0.04)],
                [Disc(0.0, gear)],
                ("y", "z", "theta_x", "theta_y", "theta_z"),
                (0.0, index * 0.5 * MODULE * sum(TEETH), 0.0),
                {**SEATS, "gear": 0.0, "end": 0.12},
                spin,
                largest_element=0.06,
                damping_ratio=0.01,
            )
        )
        springs.append(Spring(f"coupling_{index + 1}", f"{name}:end", "ground", np.diag([0, 0, 0, 1e2, 0, 0])))
    torque = 82.0 * np.eye(6)[3]
    loads = [Load("in", "shaft_1:end", torque), Load("out", "shaft_2:end", torque * TEETH[1] / TEETH[0])]
    size = 115 - sum(shaft.size for shaft in shafts)
    bodies = [*shafts, housing(size)]
    bearing = Bearing.named("NU308", clearance=20e-6, slices=21)
    elements = [
        BearingElement(
            f"{seat}_{index + 1}",
            f"shaft_{index + 1}:{seat}",
            f"housing:{seat}_{index + 1}",
            bearing,
            BearingForce(bearing, law),
            333.15,
            inner_spin=spins[index],
        )
        for index in range(2)
        for seat in SEATS
    ]
    pair = GearPair("mesh", "shaft_1:gear", "shaft_2:gear", TEETH, MODULE, math.radians(20.0), 25e-3, 14e9, 1e-4)
    places = [shaft.frames["gear"].position for shaft in shafts]
    return System(bodies, springs, loads, [*elements, gear_mesh(pair, places[0], places[1], *spins)])


def main() -> None:
    """Print time and errors."""
    bearing = Bearing.named("NU308", clearance=20e-6, slices=21)
    if len(sys.argv) > 1:
        law = ehdmaps.open_map(sys.argv[1]).law("series", outside="clamp")
    else:
        law = laws.formula(bearing, Lubricant.named("FVA3"), kind="series", outside="clamp")
    system = machine(law)
    inputs = [Input("E", "shaft_1:gear", np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]))]
    along = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    sensors = [
        Sensor("housing", "housing:left_1", along, "acceleration"),
        Sensor("ring", "shaft_1:left", along, "displacement", against="housing:left_1"),
    ]
    sweep(system, SPEEDS[:2], 0.0, inputs, sensors, FREQUENCIES)
    start = time.perf_counter()
    found = sweep(system, SPEEDS, 0.0, inputs, sensors, FREQUENCIES)
    elapsed = time.perf_counter() - start
    print(
        f"{system.size} coordinates, {len(found.bearings.names)} bearings, {SPEEDS.size} speeds (and {found.between} "
        f"between), {FREQUENCIES.size} frequencies x {len(sensors)} sensors: {elapsed:.2f} s"
    )
    changes = found.bearings.stiffness[-1] / found.bearings.stiffness[0] - 1.0
    inside = found.undamped.bearing_share.max(axis=0) >= 0.05
    shift, summed = found.undamped.shift[-1][inside], found.undamped.summed_shift[-1][inside]
    print(
        f"{inside.sum()} modes with 5 % of their energy in the bearings; k {100 * changes.min():+.1f} % to "
        f"{100 * changes.max():+.1f} %, f {100 * shift.min():+.2f} % to {100 * shift.max():+.2f} %; the identity, "
        f"summed over the steps, is within {100 * np.abs(summed - shift).max():.4f} % of f"
    )
    least = found.undamped.assurance.min(), np.nanmin(found.damped.assurance)
    print(f"least assurance: undamped {least[0]:.3f}, complex {least[1]:.3f}")
    steady = steady_system(system)
    for index in (0, -1):
        balance = equilibrium(steady, Operation(float(SPEEDS[index])), found.displacement[index])
        start = time.perf_counter()
        direct = frequency_response(balance, inputs, sensors, FREQUENCIES)
        slow = time.perf_counter() - start
        values = found.responses.values[index]
        error = np.abs(values - direct).max(axis=0) / np.abs(direct).max(axis=0)
        plain = np.linalg.eigvals(state_space(balance).A)
        ours = state_modes(balance, undamped_modes(balance)).eigenvalues
        nearest = np.abs(ours[:, None] - plain[None, :]).min(axis=1) / np.abs(ours)
        print(
            f"  {SPEEDS[index] / RPM:.0f} rpm: responses within {error.max():.1e} of direct solutions, which take "
            f"{slow:.2f} s a speed; eigenvalues within {nearest.max():.1e} of the full matrix"
        )


if __name__ == "__main__":
    main()
