"""A scene built in Python, without a TOML file: a rigid shaft with a disc on two bearings.

Run it with `python examples/05_scene_in_python.py [FOLDER]`; the figure is written to the folder.
It finds the equilibrium under the weight and the natural frequencies. The shaft is symmetric, so that its bounce is a
mass on two equal springs: sqrt(2 k/m)/(2 pi), where k is that of one bearing under half the weight, computed apart.
"""

import math
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.outputs import write_figure
from mbs import Bearing, BearingForce
from mbs.bearing_point import bearing_point
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.films import DryContacts
from mbs.bearings.laws import hertz
from mbs.body import Inertia, rigid_body
from mbs.elements import Load, Operation
from mbs.equilibrium import equilibrium
from mbs.linearised.modes import undamped_modes
from mbs.system import System

SPEED, TEMPERATURE = 500 * math.pi / 30, 313.15
parts = [Inertia.cylinder(-0.15, 0.15, 0.04), Inertia.cylinder(-0.02, 0.02, 0.2)]
mass = sum(part.mass for part in parts)
shaft = rigid_body(
    "shaft", parts, ["y", "z", "theta_y", "theta_z"], frames={"left": (-0.1, 0, 0), "right": (0.1, 0, 0)}, spin=1.0
)
weight = Load("weight", "shaft", np.array([0.0, 0.0, -9.81 * mass, 0.0, 0.0, 0.0]))
bearing = Bearing.named("NU308", clearance=-2e-6)  # preloaded a little
force = BearingForce(bearing, hertz(bearing))
bearings = [BearingElement(end, f"shaft:{end}", "ground", bearing, force, TEMPERATURE) for end in ("left", "right")]
system = System([shaft], loads=[weight], elements=bearings)
found = undamped_modes(equilibrium(system, Operation(SPEED)))
for frequency, shape in zip(found.frequency, found.shapes.T, strict=True):
    print(f"{frequency:8.2f} Hz", dict(zip(system.coordinates, shape.round(3).tolist(), strict=True)))

films = DryContacts(bearing.geometry.contacts(bearing.material, "iso16281"))
one = bearing_point(force, films, (0.0, -0.5 * 9.81 * mass), SPEED, TEMPERATURE)
expected = math.sqrt(2.0 * one.stiffness[1, 1] / mass) / (2.0 * math.pi)
nearest = found.frequency[np.argmin(np.abs(found.frequency - expected))]
print(f"bounce {nearest:.4f} Hz, of one bearing and half the mass {expected:.4f} Hz")
assert abs(nearest / expected - 1.0) < 1e-6  # rounding of two equilibria

figure = Figure(figsize=(6.0, 3.0), layout="constrained")
axes = figure.subplots()
axes.bar(range(1, 5), found.frequency)
axes.axhline(expected, color="k", linestyle="--", label="two springs k, one mass")
axes.set(xlabel="mode", ylabel="natural frequency, Hz")
axes.legend()
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "05_scene.png", 120)
