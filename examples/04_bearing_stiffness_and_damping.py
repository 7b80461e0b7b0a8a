"""Stiffness and damping of a bearing over its load, dry and with an oil film.

Run it with `python examples/04_bearing_stiffness_and_damping.py [FOLDER]`; the figure is written to the folder.
Dry contacts obey F ~ delta^(10/9), and without clearance so does the bearing: K delta/F = 10/9 by Euler's theorem.
"""

import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import ehdmaps
from ehdmaps.outputs import write_figure
from mbs import Bearing
from mbs.analyses.bearing_point import bearing_points
from mbs.bearings.films import DryContacts, MapFilms
from mbs.bearings.laws import hertz

T, SPEED = 333.15, 1500 * np.pi / 30
bearing = Bearing(ehdmaps.BearingGeometry.named("NU308").without_clearance, profile="straight")
oil, u = ehdmaps.Lubricant.named("FVA3"), bearing.geometry.entrainment_speed(SPEED)
grid: Any = {"loads": np.geomspace(1e2, 1e6, 17), "entrainment_speeds": [0.8 * u, u, 1.25 * u], "temperatures": [T]}
job = ehdmaps.Job.build(bearing=bearing.geometry, lubricant=oil, **grid, solver_options={"density": 4.5})
emap, loads = ehdmaps.EHDMap(ehdmaps.generate(job)), np.geomspace(500.0, 10e3, 9)
dry = hertz(bearing), DryContacts(bearing.geometry.contacts(bearing.material, "iso16281"))
laws: dict[str, Any] = {"dry": dry, "film": (emap.law("series", outside="asymptote"), MapFilms(emap))}
figure, (left, right) = plt.subplots(1, 2, figsize=(7.0, 3.0), layout="constrained")
for name, (law, films) in laws.items():
    points = [row[0] for row in bearing_points(bearing, law, films, [(0.0, f) for f in loads], [SPEED], T)]
    K, C = np.array([(point.stiffness[2, 2], point.damping[2, 2]) for point in points]).T  # along the load
    left.plot(loads, 1e-6 * K, "--" if name == "dry" else "-")
    right.plot(loads, 1e-3 * C, "--" if name == "dry" else "-")
    exponent = K * np.array([point.pose[2] for point in points]) / loads
    print(f"{name}: K delta/F = {exponent.round(6)}")
    assert name == "film" or np.allclose(exponent, 10 / 9, rtol=1e-8)  # what the equilibrium leaves of its load
left.set(xlabel="load, N", ylabel="stiffness, N/um", title="dashed: dry")
right.set(xlabel="load, N", ylabel="damping, N s/mm")
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "04_bearing.png")
