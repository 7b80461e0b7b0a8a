"""Speed sweep of the shipped gearbox: its time beside the errors of its modes, responses and slices.

Run: python -m tests.benchmarks.bench_sweep MAP.nc

40 speeds from 500 to 2500 rpm, 1000 frequencies, all inputs and sensors of the scene. Four tables:

time        beside the error of responses against direct solutions at each frequency (of the largest at the sensor),
            of complex eigenvalues against those of the full state matrix, and with the cage angles averaged
slices      largest difference from 161 slices over all speeds: of k and c along the load of a bearing, and of the
            undamped natural frequencies up to 5 kHz
cage angle  how far k, c and frequencies scatter over one pitch of the rollers: what one fixed angle leaves open
load        scatter of k from the straight course through its neighbours while the torque rises in steps of 1 %: a slice
            that comes into contact is a step in the stiffness of a dry law, and the more so the fewer slices there are
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import time

import numpy as np

import ehdmaps
from ehdmaps.maps.emap import EHDMap
from mbs.bearings.bearing import Bearing
from mbs.linearised.averaged import steady_system
from mbs.linearised.linear import frequency_response, state_space
from mbs.linearised.modes import state_modes, undamped_modes
from mbs.linearised.sweep import Sweep, along_load, sweep
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.system import System
from mbs.scene.assembly import assemble, build_bodies
from mbs.scene.reader import read_scene
from mbs.scene.scene import Scene

RPM = math.pi / 30.0
SPEEDS = np.linspace(500.0, 2500.0, 40) * RPM
FREQUENCIES = np.linspace(50.0, 6000.0, 1000)
MIDDLE = 1500.0 * RPM
HIGHEST = 5e3
SLICES, CONVERGED = (11, 21, 41), 161
ANGLES = 8


def made(scene: Scene, law: str, emap: EHDMap, slices: int = 21) -> System:
    """The gearbox with a law and a number of slices."""
    bearings = tuple(dataclasses.replace(entry, slices=slices) for entry in scene.bearings)
    return assemble(scene.with_bearings(bearings), law, emap).system


def timed(scene: Scene, law: str, emap: EHDMap) -> None:
    """Print time and errors."""
    system = made(scene, law, emap)
    sweep(system, SPEEDS[:2], 0.0, scene.inputs, scene.sensors, FREQUENCIES)
    found, seconds = None, []
    for angles in (ANGLES, 1):
        start = time.process_time()
        found = sweep(system, SPEEDS, 0.0, scene.inputs, scene.sensors, FREQUENCIES, angles)
        seconds.append(time.process_time() - start)
    assert found is not None
    print(
        f"\nlaw {law}: {system.size} coordinates, {SPEEDS.size} speeds (and {found.between} between), "
        f"{FREQUENCIES.size} frequencies x {len(scene.sensors)} sensors x {len(scene.inputs)} inputs: "
        f"{seconds[1]:.2f} s of the processor; {seconds[0]:.2f} s with {ANGLES} cage angles"
    )
    steady = steady_system(system)
    for index in (0, SPEEDS.size // 2, -1):
        balance = equilibrium(steady, Operation(float(SPEEDS[index])), found.displacement[index])
        start = time.process_time()
        direct = frequency_response(balance, scene.inputs, scene.sensors, FREQUENCIES)
        slow = time.process_time() - start
        error = np.abs(found.responses.values[index] - direct).max(axis=0) / np.abs(direct).max(axis=0)
        plain = np.linalg.eigvals(state_space(balance).A)
        ours = state_modes(balance, undamped_modes(balance)).eigenvalues
        nearest = np.abs(ours[:, None] - plain[None, :]).min(axis=1) / np.abs(ours)
        print(
            f"  {SPEEDS[index] / RPM:.0f} rpm: responses within {error.max():.1e} of direct solutions, which take "
            f"{slow:.2f} s a speed; eigenvalues within {nearest.max():.1e} of the full matrix"
        )


def heard(found: Sweep) -> np.ndarray:
    """Undamped natural frequencies up to 5 kHz, shape (speeds, modes), rising."""
    rising = np.sort(found.undamped.frequency, axis=1)
    return rising[:, : int(np.sum(rising <= HIGHEST, axis=1).min())]


def differences(found: Sweep, other: Sweep) -> tuple[float, float, float]:
    """Largest relative differences of k, c and frequencies."""
    k = np.abs(found.bearings.stiffness / other.bearings.stiffness - 1.0).max()
    scale = np.where(other.bearings.damping > 0.0, other.bearings.damping, 1.0)
    c = (np.abs(found.bearings.damping - other.bearings.damping) / scale).max()
    first, second = heard(found), heard(other)
    size = min(first.shape[1], second.shape[1])
    return float(k), float(c), float(np.abs(first[:, :size] / second[:, :size] - 1.0).max())


def slice_table(scene: Scene, law: str, emap: EHDMap) -> None:
    """Print the differences from many slices."""
    speeds = SPEEDS[::3]
    converged = sweep(made(scene, law, emap, CONVERGED), speeds)
    print(f"  slices beside {CONVERGED}:  largest difference of k, c, f")
    for slices in SLICES:
        k, c, f = differences(sweep(made(scene, law, emap, slices), speeds), converged)
        print(f"    {slices:3d}: {k:9.3%} {c:9.3%} {f:9.4%}")


def angle_table(scene: Scene, law: str, emap: EHDMap) -> None:
    """Print the scatter over a pitch of the slower cage at the middle speed."""
    system = made(scene, law, emap)
    bearing = Bearing.named("NU308", clearance=0.0)
    slowest = min(abs(body.spin) for body in scene.bodies if body.spin)
    pitch = 2.0 * math.pi / (bearing.geometry.rollers * abs(bearing.cage_angle(slowest, 0.0)))
    found = [sweep(system, np.array([MIDDLE]), pitch * part / ANGLES) for part in range(ANGLES)]
    k, c = (np.array([getattr(each.bearings, name)[0] for each in found]) for name in ("stiffness", "damping"))
    lines = [heard(each)[0] for each in found]
    f = np.array([each[: min(map(len, lines))] for each in lines])
    spreads = [
        np.ptp(values, axis=0) / 2.0 / np.where(values.mean(axis=0) > 0.0, values.mean(axis=0), 1.0)
        for values in (k, c, f)
    ]
    print(
        f"  {ANGLES} cage angles over a pitch at 1500 rpm, half the range: k {spreads[0].max():.2%}, c "
        f"{spreads[1].max():.2%}, f {spreads[2].max():.3%} at most, {np.median(spreads[2]):.4%} in the median"
    )


def load_table(scene: Scene, law: str, emap: EHDMap) -> None:
    """Print how far k is from smooth while the torque rises."""
    factors = 1.01 ** np.arange(-20, 21)
    texts = []
    for slices in (*SLICES, CONVERGED):
        steady, at, found = steady_system(made(scene, law, emap, slices)), None, []
        elements = [entry.element for entry in steady.elements]
        for factor in factors.tolist():
            loads = [dataclasses.replace(load, force=factor * np.asarray(load.force)) for load in scene.loads]
            balance = equilibrium(
                System(build_bodies(scene.bodies), scene.springs, loads, elements), Operation(MIDDLE), at
            )
            at = balance.displacement
            found.append(along_load(balance)[1])
        k = np.array(found)
        rough = np.abs(k[1:-1] - 0.5 * (k[2:] + k[:-2])) / k[1:-1]
        texts.append(f"{slices} slices {rough.max():.3%}")
    print(f"  torque in steps of 1 %, k beside the mean of its neighbours, at most: {', '.join(texts)}")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description="Speed sweep of the shipped gearbox: time beside errors.")
    parser.add_argument("map", help="Reynolds map of the NU308, by `ehdmaps generate nu308`")
    emap = ehdmaps.open_map(parser.parse_args().map)
    scene = read_scene("gearbox")
    print(scene.title)
    for law in ("map", "hertz"):
        timed(scene, law, emap)
        slice_table(scene, law, emap)
        angle_table(scene, law, emap)
        load_table(scene, law, emap)


if __name__ == "__main__":
    main()
