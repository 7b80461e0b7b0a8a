"""The gearbox in Exudyn beside `mbs`: equilibrium, modes, levels and time.

Run: python -m tests.benchmarks.exudyn_gearbox nu308.nc

Exudyn gets the reduced matrices of shafts and housing as an `ObjectGenericODE2`; bearings and gear mesh are a function
in Python that calls the elements of `mbs`. Statics, linearisation and integration are its own, and films follow at once
on both sides. What is compared are thus the solvers, not the models. Both integrate by their generalised-alpha methods
with the same spectral radius.
"""

from __future__ import annotations

import argparse
import math
import time
import warnings
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import NodeGenericODE2, ObjectGenericODE2, SensorNode

from ehdmaps.arrays import FloatArray
from mbs import assemble
from mbs.linearised.modes import modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, SpeedProfile
from mbs.model.system import System
from mbs.scene.reader import read_scene
from mbs.settings import Settings
from tests.cases.bearings import integrate

SPEED, DURATION, STEPS, RADIUS = 1500.0 * math.pi / 30.0, 0.05, (1e-5, 5e-6), 0.8
FORGET = 0.01
"""Begin of what is compared [s]: both start from rest."""

BAND = (50.0, 6e3)
"""Of the modes that are compared [Hz]."""


class There:
    """A system of `mbs` in Exudyn, at a constant speed; `rolls` tells whether its angle goes on."""

    def __init__(self, system: System, speed: float) -> None:
        self._system, self._speed, self.rolls, self.calls = system, speed, False, 0
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        zero = [0.0] * system.size
        self._node = self.mbs.AddNode(
            NodeGenericODE2(
                referenceCoordinates=zero, initialCoordinates=zero, initialCoordinates_t=zero,
                numberOfODE2Coordinates=system.size,
            )
        )  # fmt: skip
        self.mbs.AddObject(
            ObjectGenericODE2(
                nodeNumbers=[self._node],
                massMatrix=system.mass,
                stiffnessMatrix=system.stiffness,
                dampingMatrix=system.damping + speed * system.gyroscopic,
                forceUserFunction=self._force,
                jacobianUserFunction=self._jacobian,
            )
        )
        self.sensors = [
            self.mbs.AddSensor(SensorNode(nodeNumber=self._node, storeInternal=True, outputVariableType=kind))
            for kind in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_tt)
        ]
        self.mbs.Assemble()
        self.settings = exu.SimulationSettings()
        self.settings.solutionSettings.writeSolutionToFile = False
        for solver in (self.settings.staticSolver, self.settings.timeIntegration):
            solver.verboseMode = 0
            solver.newton.relativeTolerance = 1e-10

    def _evaluated(self, t: float, q: Any, v: Any) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Force on the coordinates, stiffness and damping of all elements."""
        system, operation = self._system, Operation(self._speed, self._speed * t * self.rolls, t)
        self.calls += 1
        force = system.loads(t)
        stiffness, damping = np.zeros((2, system.size, system.size))
        for connected, found in zip(system.elements, system.evaluate(np.array(q), np.array(v), operation), strict=True):
            force += connected.transform.T @ found.force
            stiffness += connected.transform.T @ found.stiffness @ connected.transform
            damping += connected.transform.T @ found.damping @ connected.transform
        return force, stiffness, damping

    def _force(self, mbs: Any, t: float, item: Any, q: Any, v: Any) -> FloatArray:
        return self._evaluated(t, q, v)[0]

    def _jacobian(self, mbs: Any, t: float, item: Any, q: Any, v: Any, by_q: float, by_v: float) -> FloatArray:
        _, stiffness, damping = self._evaluated(t, q, v)
        return by_q * stiffness + by_v * damping

    def settle(self) -> FloatArray:
        """Coordinates at rest, where later solutions begin."""
        self.mbs.SolveStatic(self.settings, updateInitialValues=True)
        return np.array(self.mbs.GetSensorValues(self.sensors[0]))

    def eigenvalues(self) -> FloatArray:
        """Complex eigenvalues with a positive imaginary part [1/s]."""
        values, _ = self.mbs.ComputeODE2Eigenvalues(
            self.settings, computeComplexEigenvalues=True, useAbsoluteValues=False
        )
        values = np.asarray(values)
        return values[values.imag > 0.0]

    def run(self, duration: float, step: float) -> FloatArray:
        """Accelerations of all coordinates after each step, shape (steps, n)."""
        self.rolls = True
        self.settings.timeIntegration.numberOfSteps = round(duration / step)
        self.settings.timeIntegration.endTime = duration
        self.settings.timeIntegration.generalizedAlpha.spectralRadius = RADIUS
        self.settings.solutionSettings.sensorsWritePeriod = step
        assert self.mbs.SolveDynamic(self.settings)
        return np.asarray(self.mbs.GetSensorStoredData(self.sensors[1]))[1:, 1:]


def levels(signal: FloatArray, step: float) -> FloatArray:
    """Levels of third octaves from 250 Hz to 5 kHz [dB]."""
    power = np.abs(np.fft.rfft(signal * np.hanning(signal.size))) ** 2
    at = np.fft.rfftfreq(signal.size, step)
    middles = 1000.0 * 2.0 ** (np.arange(-6, 8) / 3.0)
    sums = [np.sum(power[(at >= m * 2.0 ** (-1 / 6)) & (at < m * 2.0 ** (1 / 6))]) for m in middles]
    return 10.0 * np.log10(np.array(sums))


def main() -> None:
    """Print the comparison."""
    warnings.simplefilter("ignore", DeprecationWarning)
    parser = argparse.ArgumentParser(description="The gearbox in Exudyn beside mbs.")
    parser.add_argument("map", help="map of the NU308, by `ehdmaps generate nu308`")
    model = assemble(read_scene("gearbox"), emap=parser.parse_args().map, films="slow")
    system, profile = model.system, SpeedProfile(Course((0.0, DURATION), (SPEED, SPEED)))
    balance = equilibrium(system, Operation(SPEED))
    there = There(system, SPEED)
    rest, size = there.settle(), np.max(np.abs(balance.displacement))
    print(f"equilibrium: {np.max(np.abs(rest - balance.displacement)) / size:.1e} of the largest coordinate")
    ours, theirs = modes(balance).eigenvalues, there.eigenvalues()
    ours = ours[(np.abs(ours) > 2.0 * math.pi * BAND[0]) & (np.abs(ours) < 2.0 * math.pi * BAND[1])]
    apart = [np.min(np.abs(theirs - each)) / abs(each) for each in ours]
    print(f"{len(ours)} complex modes from {BAND[0]:g} to {BAND[1]:g} Hz: {np.max(apart):.1e} of their eigenvalues")
    row = system.relative("housing:sensor_top")[2]
    integrate(system, profile, 10 * STEPS[0], Settings(STEPS[0], STEPS[0], RADIUS), balance.displacement)  # compiles
    for step in STEPS:
        before = time.perf_counter()
        mine = integrate(system, profile, DURATION, Settings(step, step, RADIUS), balance.displacement)
        middle = time.perf_counter()
        there.calls = 0
        signal = there.run(DURATION, step) @ row
        seconds = middle - before, time.perf_counter() - middle
        wanted = mine.states.acceleration[1:] @ row
        late = round(FORGET / step)
        parts = signal[late:], wanted[late:]
        apart = np.sqrt(np.mean((parts[0] - parts[1]) ** 2) / np.mean(parts[1] ** 2))
        third = levels(parts[0], step) - levels(parts[1], step)
        print(
            f"{DURATION:g} s in steps of {1e6 * step:g} us: S1 differs by {100.0 * apart:.2g} % of its rms, "
            f"third octaves by {np.max(np.abs(third)):.2g} dB at most; mbs {seconds[0]:.2f} s, "
            f"Exudyn {seconds[1]:.1f} s with {there.calls} calls",
            flush=True,
        )


if __name__ == "__main__":
    main()
