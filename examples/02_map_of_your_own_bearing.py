"""A map of your own bearing and oil, without a job file: values in, xarray.Dataset out.

Run it with `python examples/02_map_of_your_own_bearing.py [FOLDER]`; the figure is written to the folder.
It solves 80 points of the Reynolds equation and makes a contact law of them. At a point of the map the law must give
back the load that the point was solved for: its approach is the sum of the approaches at both raceways.
"""

import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import ehdmaps
from ehdmaps.outputs import write_figure

bearing = ehdmaps.BearingGeometry(
    name="my bearing",
    inner_raceway_diameter=40e-3,
    outer_raceway_diameter=62e-3,
    roller_diameter=11e-3,
    roller_length=12e-3,
    rollers=12,
    diametral_clearance=20e-6,
)
oil = ehdmaps.Lubricant.roelands(viscosity_40=68e-6, viscosity_100=8.7e-6, pressure_viscosity=2e-8, density=870.0)
loads, speeds, temperature = np.geomspace(1e3, 1e6, 10), [0.5, 1.0, 2.0, 4.0], 333.15
grid: Any = {"loads": loads, "entrainment_speeds": speeds, "temperatures": [temperature]}
job = ehdmaps.Job.build(bearing=bearing, lubricant=oil, **grid, solver_options={"density": 4.5}, name="mine")
made = ehdmaps.generate(job)  # with an output file it would go on after an interruption
approach = made["approach"].sum("contact").values[:, 2, 0]
w, _, _ = ehdmaps.EHDMap(made).law("series")(approach, 0.0, speeds[2], temperature)
assert np.allclose(w, loads, rtol=1e-4)  # what a smooth table loses of coarse points
print(f"{made.attrs['title']}: {job.points} points; at {loads[5]:.4g} N/m the law gives {w[5]:.4g} N/m")
figure, axes = plt.subplots(figsize=(7.0, 3.0), layout="constrained")
axes.loglog(loads, 1e6 * made["central_film"].sel(contact="inner")[..., 0], label=[f"{u:g} m/s" for u in speeds])
axes.set(xlabel="load, N/m", ylabel="central film, um")
axes.legend()
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "02_own_map.png")
