"""A rotor in Python: a shaft with two discs on bearings by matrices, and an unbalance that turns with it.

Run it with `python examples/10_rotor_in_python.py [FOLDER]`; the figure is written to the folder.
It is example 5.9.2 of Friswell, Penny, Garvey and Lees, Dynamics of Rotating Machines, Cambridge 2010: bearings stiffer
in one direction than in the other. The whirl speeds at 4000 rpm are those of the book, as the tests of ROSS quote them.
"""

import math
import sys
from pathlib import Path

import numpy as np

import mbs
from ehdmaps.outputs import write_figure

RPM, LENGTH, DIAMETER = math.pi / 30.0, 1.5, 0.05  # all in SI
STEEL = {"youngs_modulus": 211e9, "poisson_ratio": 211e9 / (2.0 * 81.2e9) - 1.0, "density": 7810.0}
BOOK = np.array([82.33, 86.86, 239.64, 287.25, 583.49, 806.89])  # rad/s
discs = [
    mbs.Disc(place, mbs.Inertia.cylinder(-0.035, 0.035, diameter, DIAMETER, density=7810.0))
    for place, diameter in ((0.5, 0.28), (1.0, 0.35))
]
frames = {"left": 0.0, "first": 0.5, "second": 1.0, "right": LENGTH}
freedoms, bar = ["y", "z", "theta_y", "theta_z"], mbs.Section(0.0, LENGTH, DIAMETER, **STEEL)
shaft = mbs.ShaftSpec("rotor", [bar], freedoms, frames, cutoff=None, discs=discs, spin=1.0, largest_element=0.25)
stiffness = np.diag([0.0, 1e6, 8e5, 0.0, 0.0, 0.0])[None]  # of x y z and of the rotations
bearings = [mbs.MatrixSpec(end, f"rotor:{end}", stiffness, 0.0 * stiffness) for end in ("left", "right")]
unbalance, speed = mbs.Unbalance("residual", "rotor:first", moment=1e-4), 4000.0 * RPM
scene = mbs.Scene(
    name="rotor", speed=speed, temperature=313.15, bodies=[shaft], elements=bearings, unbalances=[unbalance]
)
model = mbs.assemble(scene)
found = 2.0 * math.pi * np.sort(mbs.modes(model).dataset["frequency"].values)[:6]
print(f"whirl speeds at 4000 rpm: {found.round(2)} rad/s, of the book {BOOK} rad/s")
assert np.abs(found - BOOK).max() < 0.01  # last digit of the book, rounded
result = mbs.critical(model, mbs.SweepSettings(mbs.SweepRange(100.0 * RPM, 4000.0 * RPM, 14)))
write_figure(result.plot(), Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "10_rotor.png")
