"""The gearbox in Exudyn beside `mbs`: equilibrium, modes, levels and time.

Run: python -m tests.benchmarks.exudyn_gearbox nu308.nc [--films memory]

`mbs.exports.exudyn.add_system` gives Exudyn the reduced matrices of shafts and housing as an `ObjectGenericODE2`;
bearings and gear mesh are a function in Python that calls the elements of `mbs`. Statics, linearisation and integration
are its own; modes are those of films that follow at once. What is compared are thus the solvers, not the models. Both
integrate by their generalised-alpha methods with the same spectral radius.
"""

from __future__ import annotations

import argparse
import math
import time
import warnings

import exudyn as exu
import numpy as np
from exudyn.utilities import SensorNode

from ehdmaps.arrays import FloatArray
from mbs import assemble
from mbs.exports.exudyn import add_system
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
    """A system of `mbs` in Exudyn at a constant speed, at rest or in time."""

    def __init__(self, system: System, start: FloatArray, in_time: bool) -> None:
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        node = add_system(self.mbs, system, Operation(SPEED), start, in_time)
        self._sensor = self.mbs.AddSensor(
            SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=exu.OutputVariableType.Coordinates_tt)
        )
        self.mbs.Assemble()
        self.settings = exu.SimulationSettings()
        self.settings.solutionSettings.writeSolutionToFile = False
        for solver in (self.settings.staticSolver, self.settings.timeIntegration):
            solver.verboseMode = 0
            solver.newton.relativeTolerance = 1e-10

    def settle(self) -> FloatArray:
        """Coordinates at rest, where later solutions begin."""
        self.mbs.SolveStatic(self.settings, updateInitialValues=True)
        return np.array(self.mbs.systemData.GetODE2Coordinates())

    def eigenvalues(self) -> FloatArray:
        """Complex eigenvalues with a positive imaginary part [1/s]."""
        values, _ = self.mbs.ComputeODE2Eigenvalues(
            self.settings, computeComplexEigenvalues=True, useAbsoluteValues=False
        )
        values = np.asarray(values)
        return values[values.imag > 0.0]

    def run(self, duration: float, step: float) -> FloatArray:
        """Accelerations of all coordinates after each step, shape (steps, n)."""
        self.settings.timeIntegration.numberOfSteps = round(duration / step)
        self.settings.timeIntegration.endTime = duration
        self.settings.timeIntegration.generalizedAlpha.spectralRadius = RADIUS
        self.settings.solutionSettings.sensorsWritePeriod = step
        assert self.mbs.SolveDynamic(self.settings)
        return np.asarray(self.mbs.GetSensorStoredData(self._sensor))[1:, 1:]


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
    parser.add_argument("--films", choices=("slow", "memory"), default="slow")
    arguments = parser.parse_args()
    model = assemble(read_scene("gearbox"), emap=arguments.map, films=arguments.films)
    system, profile = model.system, SpeedProfile(Course((0.0, DURATION), (SPEED, SPEED)))
    balance = equilibrium(system, Operation(SPEED))
    there = There(system, 1.02 * balance.displacement, in_time=False)
    rest, size = there.settle(), np.max(np.abs(balance.displacement))
    print(f"equilibrium: {np.max(np.abs(rest - balance.displacement)) / size:.1e} of the largest coordinate")
    slow = assemble(read_scene("gearbox"), emap=arguments.map, films="slow").system
    ours, theirs = modes(equilibrium(slow, Operation(SPEED))).eigenvalues, there.eigenvalues()
    ours = ours[(np.abs(ours) > 2.0 * math.pi * BAND[0]) & (np.abs(ours) < 2.0 * math.pi * BAND[1])]
    apart = [np.min(np.abs(theirs - each)) / abs(each) for each in ours]
    print(f"{len(ours)} complex modes from {BAND[0]:g} to {BAND[1]:g} Hz: {np.max(apart):.1e} of their eigenvalues")
    row = system.relative("housing:sensor_top")[2]
    integrate(system, profile, 10 * STEPS[0], Settings(STEPS[0], STEPS[0], RADIUS), balance.displacement)  # compiles
    for step in STEPS:
        before = time.process_time()
        mine = integrate(system, profile, DURATION, Settings(step, step, RADIUS), balance.displacement)
        middle = time.process_time()
        signal = There(system, balance.displacement, in_time=True).run(DURATION, step) @ row
        seconds = np.array([middle - before, time.process_time() - middle])
        wanted = mine.states.acceleration[1:] @ row
        late = round(FORGET / step)
        parts = signal[late:], wanted[late:]
        apart = np.sqrt(np.mean((parts[0] - parts[1]) ** 2) / np.mean(parts[1] ** 2))
        third = levels(parts[0], step) - levels(parts[1], step)
        print(
            f"{DURATION:g} s in steps of {1e6 * step:g} us: S1 differs by {100.0 * apart:.2g} % of its rms, "
            f"third octaves by {np.max(np.abs(third)):.2g} dB at most; processor time of a step "
            f"{1e6 * seconds[0] * step / DURATION:.0f} us, of Exudyn {1e6 * seconds[1] * step / DURATION:.0f}, "
            f"ratio {seconds[1] / seconds[0]:.1f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
