"""A rigid rotor on two bearings: as a scene for `mbs runup`, and on two units."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from mbs.cli import main
from tests.cases.fmu import Unit
from tests.cases.fmu_run import coupled_run

SIDES = ("left", "right")


@dataclass(frozen=True)
class Rotor:
    """A rotor and its run-up; coordinates are y, z, theta_y and theta_z of its centre of mass.

    Attributes
    ----------
    mass, polar, transverse : float
        [kg], [kg m2].
    arm : float
        Half the distance of its bearings, which stand on both sides of its centre of mass [m].
    place : float
        Where its load and its unbalance sit along x [m].
    load : tuple of float
        Along y and z [N].
    unbalance : float
        [kg m]; it begins along y.
    clearance, temperature : float
        Of the bearings [m], [K].
    speeds : tuple of float
        First and last [rad/s].
    duration, step, sample : float
        Of the run, of the steps of `mbs`, between samples [s].
    slices : int
        Slices of each roller.
    """

    mass: float
    polar: float
    transverse: float
    arm: float
    place: float
    load: tuple[float, float]
    unbalance: float
    clearance: float
    temperature: float
    speeds: tuple[float, float]
    duration: float
    step: float
    sample: float
    slices: int = 41

    @property
    def scene(self) -> str:
        """Its scene; the trapezoidal rule, which dissipates nothing."""
        bearings = "".join(
            f"""
[[bearings]]
name = "bearing_{side}"
inner = "rotor:{side}"
outer = "ground"
slices = {self.slices}
geometry = {{ name = "NU308", diametral_clearance = "{self.clearance!r} m" }}
"""
            for side in SIDES
        )
        return f"""
schema = 1
title = "Rigid rotor on two bearings"
[operation]
speed = "{self.speeds[0]!r} rad/s"
temperature = "{self.temperature!r} K"
[[bodies]]
name = "rotor"
freedoms = ["y", "z", "theta_y", "theta_z"]
spin = 1
mass = "{self.mass!r} kg"
polar_inertia = "{self.polar!r} kg m^2"
transverse_inertia = "{self.transverse!r} kg m^2"
frames = {{ left = {_along(-self.arm)}, right = {_along(self.arm)}, wheel = {_along(self.place)} }}
[[loads]]
name = "weight"
on = "rotor:wheel"
force = ["0 N", "{self.load[0]!r} N", "{self.load[1]!r} N"]
[[unbalances]]
name = "residual"
on = "rotor:wheel"
moment = "{self.unbalance!r} kg m"
{bearings}
[runup]
from = "{self.speeds[0]!r} rad/s"
to = "{self.speeds[1]!r} rad/s"
duration = "{self.duration!r} s"
step = "{self.step!r} s"
sample = "{self.sample!r} s"
spectral_radius = 1.0
"""


def _along(x: float) -> str:
    """A place along x [m], as a scene has it."""
    return f'["{x!r} m", "0 m", "0 m"]'


class RotorOnUnits:
    """The rotor for `coupled_run`: displacements, then velocities.

    The equations are written here, and not taken from `mbs`: two forces, two moments and the gyroscopic moment.

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    start : array, shape (8,)
        Its states at the beginning.
    """

    def __init__(self, rotor: Rotor, start: FloatArray) -> None:
        self._rotor, self.start = rotor, start
        # The sizes of what moves a bearing by some thousandths of its films, at 1000 rad/s.
        moves = np.array([1e-6, 1e-6, 1e-6 / rotor.arm, 1e-6 / rotor.arm])
        self.nominals = np.concatenate([moves, 1e3 * moves])

    def _spin(self, time: float) -> tuple[float, float, float]:
        """Acceleration, speed and angle."""
        rotor = self._rotor
        rate = (rotor.speeds[1] - rotor.speeds[0]) / rotor.duration
        return rate, rotor.speeds[0] + rate * time, rotor.speeds[0] * time + 0.5 * rate * time**2

    def inputs(self, time: float, states: FloatArray) -> list[dict[str, float]]:
        """Motion of both inner rings; the outer ones stand."""
        _, speed, angle = self._spin(time)
        found = []
        for x in (-self._rotor.arm, self._rotor.arm):
            values = {"spin.inner": angle, "speed.inner": speed, "temperature": self._rotor.temperature}
            for name, (y, z, theta_y, theta_z) in (("pose", states[:4].tolist()), ("velocity", states[4:].tolist())):
                ring = {"y": y + x * theta_z, "z": z - x * theta_y, "theta_y": theta_y, "theta_z": theta_z}
                values |= {f"{name}.{key}": value for key, value in ring.items()}
            found.append(values)
        return found

    def rates(self, time: float, states: FloatArray, outputs: list[FloatArray]) -> FloatArray:
        """Velocities and accelerations."""
        rotor = self._rotor
        rate, speed, angle = self._spin(time)
        # A mass off the axis pulls outwards, and against the turning while that gets faster.
        cos, sin = np.cos(angle), np.sin(angle)
        turning = rotor.unbalance * np.array([speed**2 * cos + rate * sin, speed**2 * sin - rate * cos])
        total = np.zeros(4)
        pulls = [(rotor.place, *(np.array(rotor.load) + turning), 0.0, 0.0)]
        pulls += [(x, *output) for x, output in zip((-rotor.arm, rotor.arm), outputs, strict=True)]
        for x, f_y, f_z, m_y, m_z in pulls:
            total += [f_y, f_z, m_y - x * f_z, m_z + x * f_y]
        *_, tilting_y, tilting_z = states
        total -= [0.0, 0.0, rotor.polar * speed * tilting_z, -rotor.polar * speed * tilting_y]
        return np.concatenate([states[4:], total / [rotor.mass, rotor.mass, rotor.transverse, rotor.transverse]])


class Beside(NamedTuple):
    """Two runs of a rotor.

    Attributes
    ----------
    start : array, shape (8,)
        Displacements and velocities at the beginning [m, rad, m/s, rad/s].
    times : array, shape (m,)
        [s].
    wanted, found : array, shape (m, 4)
        Displacements by `mbs runup`, and on units [m or rad].
    calls : int
        How often CVODE asked for rates.
    seconds : tuple of float
        That `mbs runup` and CVODE took.
    """

    start: FloatArray
    times: FloatArray
    wanted: FloatArray
    found: FloatArray
    calls: int
    seconds: tuple[float, float]

    @property
    def moved(self) -> FloatArray:
        """What each coordinate moves, from its least to its largest value, shape (4,) [m or rad]."""
        return np.ptp(self.wanted, axis=0)

    @property
    def differences(self) -> FloatArray:
        """Largest difference of each coordinate as a part of what it moves, shape (4,)."""
        return self.difference(self.found)

    def difference(self, found: FloatArray) -> FloatArray:
        """Those of other displacements, shape (m, 4) as `found`."""
        return np.max(np.abs(found - self.wanted), axis=0) / self.moved


def side_by_side(rotor: Rotor, map_file: str, units: tuple[Unit, Unit], folder: Path, tolerance: float) -> Beside:
    """Run a rotor by the command `mbs runup` and, from the same beginning, on two units in FMPy's CVODE.

    The films of `mbs` have a memory where the units have states.

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    map_file : str
        The map of both.
    units : tuple of Unit
        Its exports, for the bearing on the left and on the right; they may be the same.
    folder : Path
        Where scene and result are written.
    tolerance : float
        Of CVODE.
    """
    scene, result = folder / "rotor.toml", folder / "rotor.nc"
    scene.write_text(rotor.scene)
    films = "memory" if units[0].description.numberOfContinuousStates else "slow"
    began = time.perf_counter()
    status = main(["runup", str(scene), "--map", map_file, "--films", films, "-o", str(result)])
    middle = time.perf_counter()
    assert status == 0, "the run stays within the map"
    with xr.open_dataset(result) as dataset:
        names = [[str(name) for name in dataset[f"{kind}_coordinate"].values] for kind in ("translation", "rotation")]
        assert names == [["rotor.y", "rotor.z"], ["rotor.theta_y", "rotor.theta_z"]]
        times = dataset["time"].values
        wanted = np.hstack([dataset["displacement"].values, dataset["rotation"].values])
        velocity = np.hstack([dataset["velocity"].values, dataset["rotation_velocity"].values])
    start = np.concatenate([wanted[0], velocity[0]])
    found, calls = coupled_run(RotorOnUnits(rotor, start), units, times, tolerance)
    return Beside(start, times, wanted, found[:, :4], calls, (middle - began, time.perf_counter() - middle))
