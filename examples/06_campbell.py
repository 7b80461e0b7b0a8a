"""A Campbell diagram: a short run-up of a shipped machine, as levels over speed and frequency.

Run it with `python examples/06_campbell.py [FOLDER]`; the figure is written to the folder.
Rollers that pass under the load excite the machine. The cage turns at (1 - gamma)/2 of the speed of the shaft, so Z
rollers pass Z (1 - gamma)/2 times a turn: that must be the strongest order of the ring's travel.
Its acceleration has stronger ones at high frequency.
"""

import dataclasses
import math
import sys
from pathlib import Path

from matplotlib.figure import Figure

from ehdmaps.outputs import write_figure
from mbs import CampbellSettings, RunUp, assemble, campbell, read_scene
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings

RPM = math.pi / 30
course = RunUp(SpeedProfile.ramp(500 * RPM, 2000 * RPM, 0.6), 0.6, Settings(step=25e-6, sample=25e-6))
scene = dataclasses.replace(read_scene("nu308_rigid"), run_up=course)
settings = CampbellSettings(sensor="approach", highest=1500.0)
found = campbell(assemble(scene, "hertz", clearance=20e-6), settings).dataset.isel(law=0)

geometry = scene.bearings[0].geometry
passing = geometry.rollers * (1.0 - geometry.gamma) / 2.0
strongest = float(found["order_level"].idxmax())
print(f"strongest order {strongest:.3f}; rollers pass {passing:.3f} times a turn")
assert abs(strongest - passing) < float(found["order"][1])  # distance of two lines

figure = Figure(figsize=(7.0, 4.0), layout="constrained")
axes = figure.subplots()
rpm, top = found["speed"] / RPM, float(found["level"].max())
image = axes.pcolormesh(rpm, found["frequency"], found["level"].T, vmin=top - 60.0, vmax=top, rasterized=True)
axes.plot(rpm, passing * rpm / 60.0, "k--", linewidth=0.8)
axes.set(xlabel="speed, rpm", ylabel="frequency, Hz")
figure.colorbar(image, label="level, dB")
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "06_campbell.png")
