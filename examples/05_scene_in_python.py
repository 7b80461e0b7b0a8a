"""A scene in Python, without a file: a rigid shaft with a disc on two bearings, pulled down by 300 N.

Run it with `python examples/05_scene_in_python.py [FOLDER]`; the figure is written to the folder.
It finds the equilibrium and the natural frequencies. The shaft is symmetric, so that its bounce is a mass on two equal
springs: sqrt(2 k/m)/(2 pi), where k is that of one bearing under half the force, computed apart.
"""

import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from ehdmaps import BearingGeometry
from ehdmaps.outputs import write_figure
from mbs import BearingForce, BearingSpec, Inertia, Load, RigidSpec, Scene, assemble, modes
from mbs.analyses.bearing_point import bearing_point

parts = [Inertia.cylinder(-0.15, 0.15, diameter=0.04), Inertia.cylinder(-0.02, 0.02, diameter=0.2)]  # all in SI
frames = {"left": (-0.1, 0.0, 0.0), "right": (0.1, 0.0, 0.0)}
shaft = RigidSpec("shaft", parts, ["y", "z", "theta_y", "theta_z"], frames=frames, spin=1.0)
pull, nu308 = Load("pull", "shaft", np.array([0.0, 0.0, -300.0, 0.0, 0.0, 0.0])), BearingGeometry.named("NU308")
bearings = [BearingSpec(side, f"shaft:{side}", "ground", nu308) for side in ("left", "right")]
scene = Scene(name="disc", speed=52.36, temperature=313.15, bodies=[shaft], loads=[pull], elements=bearings)
model = assemble(scene, clearance=-2e-6)  # preloaded a little
left, found = model.bearings[0], modes(model, cage_angles=1).dataset["frequency"].values
assert isinstance(left.force, BearingForce) and left.source is not None
one = bearing_point(left.force, left.source, (0.0, -150.0), scene.speed, scene.temperature)
expected = math.sqrt(2.0 * one.stiffness[2, 2] / model.system.mass[0, 0]) / (2.0 * math.pi)
bounce = min(found, key=lambda frequency: abs(frequency - expected))
print(f"{found.round(2)} Hz; bounce {bounce:.4f} Hz, of one bearing and half the mass {expected:.4f} Hz")
assert abs(bounce / expected - 1.0) < 1e-6  # rounding of two equilibria
figure, axes = plt.subplots(figsize=(6.0, 3.0), layout="constrained")
axes.bar(range(1, 5), found)
axes.axhline(expected, color="k", linestyle="--")
axes.set(xlabel="mode", ylabel="natural frequency, Hz", title="dashed: two springs k, one mass")
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "05_scene.png")
