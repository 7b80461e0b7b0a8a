"""Stiffness and damping of a bearing over its load, dry and with an oil film.

Run it with `python examples/04_bearing_stiffness_and_damping.py [FOLDER]`; the figure is written to the folder.
The dry bearing without clearance is checked: the force of every contact goes with the power 10/9 of its approach, so
the force of the whole bearing does too, and by Euler's theorem K delta/F = 10/9 at every load.
"""

import math
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import ehdmaps
from ehdmaps.outputs import write_figure
from mbs import Bearing
from mbs.bearing_point import bearing_points
from mbs.bearings.films import DryContacts, MapFilms
from mbs.bearings.laws import hertz

TEMPERATURE, SPEED = 333.15, 1500 * math.pi / 30
bearing = Bearing(ehdmaps.BearingGeometry.named("NU308"), profile="straight")
u = bearing.geometry.entrainment_speed(SPEED)
oil = ehdmaps.Lubricant.named("FVA3")
grid = {
    "loads": np.geomspace(1e2, 1e6, 17),
    "entrainment_speeds": [0.8 * u, u, 1.25 * u],
    "temperatures": [TEMPERATURE],
}
job = ehdmaps.Job.build(bearing=bearing.geometry, lubricant=oil, **grid, solver_options={"density": 4.5})
emap = ehdmaps.EHDMap(ehdmaps.generate(job))
loads = np.geomspace(500.0, 10e3, 9)
sources = {
    "dry": (hertz(bearing), DryContacts(bearing.geometry.contacts(bearing.material, "iso16281"))),
    "film": (emap.law("series", outside="asymptote"), MapFilms(emap)),
}
figure = Figure(figsize=(7.0, 3.0), layout="constrained")
left, right = figure.subplots(1, 2)
for name, (law, films) in sources.items():
    points = [row[0] for row in bearing_points(bearing, law, films, [(0.0, f) for f in loads], [SPEED], TEMPERATURE)]
    K = np.array([point.along_across(point.stiffness)[0] for point in points])
    C = np.array([point.along_across(point.damping)[0] for point in points])
    left.plot(loads, 1e-6 * K, label=name)
    right.plot(loads, 1e-3 * C, label=name)
    if name == "dry":
        exponent = K * np.array([point.displacement[1] for point in points]) / loads
        print("dry: K delta/F =", exponent.round(6))
        assert np.allclose(exponent, 10 / 9, rtol=1e-8)  # what the equilibrium leaves of its load
left.set(xlabel="load, N", ylabel="stiffness along the load, N/um")
right.set(xlabel="load, N", ylabel="damping along the load, N s/mm")
left.legend()
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "04_bearing.png", 120)
