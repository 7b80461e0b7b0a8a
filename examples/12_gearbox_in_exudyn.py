"""A gearbox of ours in Exudyn, another multibody program: equilibrium and natural frequencies.

Run it with `python examples/12_gearbox_in_exudyn.py [FOLDER]`; the figure is written to the folder.
Exudyn gets the matrices of shafts and housing; bearings and mesh are calls of ours, statics and modes its own.
Without Exudyn (`pip install exudyn`) it draws ours alone.
"""

import sys
import warnings
from importlib.util import find_spec
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from ehdmaps.outputs import write_figure
from mbs import Operation, assemble, read_scene
from mbs.exports.exudyn import add_system
from mbs.linearised.modes import modes
from mbs.model.equilibrium import equilibrium

turning = Operation(1500.0 * np.pi / 30.0)  # rad/s
system = assemble(read_scene("gearbox"), law="hertz").system
rest = equilibrium(system, turning)
ours = np.array([value for value in modes(rest).eigenvalues if 100.0 * np.pi < value.imag < 12e3 * np.pi])
print(f"mbs: {ours.size} modes from 50 Hz to 6 kHz" + ("" if find_spec("exudyn") else "; Exudyn is not installed"))
figure, axes = plt.subplots(figsize=(7.0, 3.0), layout="constrained")
axes.plot(ours.imag / 2e3 / np.pi, -ours.real / np.abs(ours), "o")
if find_spec("exudyn"):
    import exudyn as exu

    there = (container := exu.SystemContainer()).AddSystem()  # the container must live
    add_system(there, system, turning, 1.02 * rest.displacement)
    there.Assemble()
    warnings.simplefilter("ignore", DeprecationWarning)  # Exudyn 1.13 renames settings, and takes the old names
    (settings := exu.SimulationSettings()).solutionSettings.writeSolutionToFile = False
    settings.staticSolver.newton.relativeTolerance, settings.staticSolver.verboseMode = 1e-10, 0
    there.SolveStatic(settings, updateInitialValues=True)
    away = np.abs(there.systemData.GetODE2Coordinates() - rest.displacement).max() / np.abs(rest.displacement).max()
    theirs = there.ComputeODE2Eigenvalues(settings, computeComplexEigenvalues=True, useAbsoluteValues=False)[0]
    apart = max(np.abs(theirs - value).min() / abs(value) for value in ours)
    print(f"Exudyn: equilibrium departs by {away:.0e} of the largest coordinate, eigenvalues by {apart:.0e}")
    assert away < 1e-9 and apart < 1e-9  # residual of the equilibria, rounding of the eigenvalues
    axes.plot(theirs.imag / 2e3 / np.pi, -theirs.real / np.abs(theirs), "k+")
axes.set(
    xlabel="frequency, kHz", ylabel="damping ratio", xlim=(0.5, 6.0), ylim=(0.0, 0.05), title="modes; crosses: Exudyn"
)
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "12_gearbox.png")
