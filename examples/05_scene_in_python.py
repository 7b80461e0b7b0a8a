"""A scene in Python, without a file: a rigid shaft with a disc on two bearings, pulled down by 300 N.

Run it with `python examples/05_scene_in_python.py [FOLDER]`; the figure is written to the folder.
It finds the equilibrium and the natural frequencies. The shaft is symmetric, so that its bounce is a mass on two equal
springs: sqrt(2 k/m)/(2 pi), where k is that of one bearing under half the force, computed apart.
"""

import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt

from ehdmaps.outputs import write_figure
from mbs import BearingForce, assemble, modes, parse_scene
from mbs.analyses.bearing_point import bearing_point

SCENE = """
schema = 1
operation = { speed = "500 rpm", temperature = "40 degC" }
loads = [{ name = "pull", on = "shaft", force = ["0 N", "0 N", "-300 N"] }]
bearings = [
    { name = "left", inner = "shaft:left", outer = "ground", geometry = { name = "NU308" } },
    { name = "right", inner = "shaft:right", outer = "ground", geometry = { name = "NU308" } }]
[[bodies]]
name = "shaft"
freedoms = ["y", "z", "theta_y", "theta_z"]
position = ["0 mm", "0 mm", "0 mm"]
spin = 1
cylinders = [{ from = "-15 cm", to = "15 cm", diameter = "4 cm" }, { from = "-2 cm", to = "2 cm", diameter = "20 cm" }]
frames = { left = ["-10 cm", "0 cm", "0 cm"], right = ["10 cm", "0 cm", "0 cm"] }
"""
model = assemble(parse_scene(SCENE, "disc", "the scene"), clearance=-2e-6)  # preloaded a little
scene, force, found = model.scene, model.bearings[0].force, modes(model).dataset["frequency"].values
assert isinstance(force, BearingForce)
one = bearing_point(force, model.films["left"], (0.0, -150.0), scene.speed, scene.temperature)
expected = math.sqrt(2.0 * one.stiffness[1, 1] / model.system.mass[0, 0]) / (2.0 * math.pi)
bounce = min(found, key=lambda frequency: abs(frequency - expected))
print(f"{found.round(2)} Hz; bounce {bounce:.4f} Hz, of one bearing and half the mass {expected:.4f} Hz")
assert abs(bounce / expected - 1.0) < 1e-6  # rounding of two equilibria
figure, axes = plt.subplots(figsize=(6.0, 3.0), layout="constrained")
axes.bar(range(1, 5), found)
axes.axhline(expected, color="k", linestyle="--")
axes.set(xlabel="mode", ylabel="natural frequency, Hz", title="dashed: two springs k, one mass")
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "05_scene.png", 120)
