"""A bearing of ours in Exudyn, another multibody program: a rigid rotor on a preloaded NU308 rings after a push.

Run it with `python examples/11_bearing_in_exudyn.py [FOLDER]`; the figure is written to the folder.
It must follow a sine of sqrt(k/m) for ten periods. Without Exudyn (`pip install exudyn`) it draws the sine alone.
"""

import sys
import warnings
from importlib.util import find_spec
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from ehdmaps.outputs import write_figure
from mbs import Bearing, BearingForce
from mbs.bearings import laws
from mbs.exports.exudyn import ExudynBearing

MASS, PUSH, nu308 = 5.0, 1e-4, Bearing.named("NU308", clearance=-10e-6)  # kg, m/s
force = BearingForce(nu308, laws.hertz(nu308))
rate = np.sqrt(force(np.zeros(6), np.zeros(6))[1][1, 1] / MASS)
t = np.linspace(0.0, 20.0 * np.pi / rate, 1001)
curves = [PUSH / rate * np.sin(rate * t)]
print(f"sqrt(k/m): {rate / (2.0 * np.pi):.3f} Hz" + ("" if find_spec("exudyn") else "; Exudyn is not installed"))
if find_spec("exudyn"):
    import exudyn as exu
    from exudyn.utilities import MarkerBodyRigid, RigidBodyInertia, SensorBody

    system = (container := exu.SystemContainer()).AddSystem()  # the container must live
    body = {"inertia": RigidBodyInertia(MASS, 0.01 * np.eye(3)), "nodeType": exu.NodeType.RotationRxyz}
    bodies = system.CreateGround(), system.CreateRigidBody(**body, initialVelocity=[0.0, PUSH, 0.0])
    ExudynBearing(force).add(system, *(system.AddMarker(MarkerBodyRigid(bodyNumber=number)) for number in bodies))
    what = {"outputVariableType": exu.OutputVariableType.Displacement, "storeInternal": True}
    sensor = system.AddSensor(SensorBody(bodyNumber=bodies[1], **what))
    system.Assemble()
    warnings.simplefilter("ignore", DeprecationWarning)  # Exudyn 1.13 renames settings, and takes the old names
    settings = exu.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile, settings.solutionSettings.sensorsWritePeriod = False, t[1]
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = t.size - 1, t[-1]
    assert system.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    curves.append(np.asarray(system.GetSensorStoredData(sensor))[:, 2])
    departs = np.abs(curves[1] - curves[0]).max() / curves[0].max()
    print(f"Exudyn departs from it by {departs:.1e} of the swing in ten periods")
    assert departs < 1e-4  # squared ratio of swing and preload: the contacts are not quite linear
figure, axes = plt.subplots(figsize=(7.0, 3.0), layout="constrained")
for curve, style in zip(curves, ("C0", "k--"), strict=False):
    axes.plot(1e3 * t, 1e9 * curve, style)
axes.set(xlabel="time, ms", ylabel="motion, nm", title="rotor after a push; dashed: Exudyn")
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "11_exudyn.png")
