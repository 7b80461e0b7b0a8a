"""A map of your own bearing and oil, without a job file: values in, xarray.Dataset out.

Run it with `python examples/02_map_of_your_own_bearing.py [FOLDER]`; the figure is written to the folder.
It solves 80 points of the Reynolds equation and makes a contact law of them. At a point of the map the law must give
back the load that the point was solved for: its approach is the sum of the approaches at both raceways.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

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
job = ehdmaps.Job.build(
    bearing=bearing,
    lubricant=oil,
    loads=np.geomspace(1e3, 1e6, 10),
    entrainment_speeds=[0.5, 1.0, 2.0, 4.0],
    temperatures=[333.15],
    solver_options={"density": 4.5},
    name="mine",
)
made = ehdmaps.generate(job)  # with an output file it would go on after an interruption
w, k, c = ehdmaps.EHDMap(made).law("series")(
    made["approach"].sum("contact").values[:, 2, 0], 0.0, job.entrainment_speeds[2], job.temperatures[0]
)
assert np.allclose(w, job.loads, rtol=1e-4)  # what a smooth table loses of coarse points
print(f"{made.attrs['title']}: {job.points} points; at {job.loads[5]:.4g} N/m the law gives {w[5]:.4g} N/m")

figure = Figure(figsize=(7.0, 3.0), layout="constrained")
left, right = figure.subplots(1, 2)
for speed, film in zip(
    job.entrainment_speeds, made["central_film"].sel(contact="inner").values[:, :, 0].T, strict=True
):
    left.loglog(job.loads, 1e6 * film, label=f"{speed:g} m/s")
left.legend()
left.set(xlabel="load, N/m", ylabel="central film, um")
right.loglog(job.loads, k)
right.set(xlabel="load, N/m", ylabel="stiffness of a roller, N/m2")
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "02_own_map.png", 120)
