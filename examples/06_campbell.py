"""A Campbell diagram: a short run-up of a shipped machine, as levels over speed and frequency.

Run it with `python examples/06_campbell.py [FOLDER]`; the figure is written to the folder.
Rollers that pass under the load excite the machine. The cage turns at (1 - gamma)/2 of the speed of the shaft, so Z
rollers pass Z (1 - gamma)/2 times a turn: that must be the strongest order of the run.
"""

import math
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.outputs import write_figure
from mbs.assembly import assemble
from mbs.elements import Operation
from mbs.equilibrium import equilibrium
from mbs.profiles import SpeedProfile
from mbs.scene_reader import read_scene
from mbs.spectral.campbell import run_up_spectra
from mbs.spectral.levels import Reference
from mbs.spectral.run_signal import RunSignal
from mbs.transient.run import run
from mbs.transient.stepping import Settings

model = assemble(read_scene("nu308_rigid"), "hertz", clearance=20e-6)
sensor = model.scene.sensors[1]  # displacement of the shaft against a ring
speed = SpeedProfile.ramp(500 * math.pi / 30, 2000 * math.pi / 30, 1.0)
start = equilibrium(model.system, Operation(speed.at(0.0)[0]))
record = run(
    model.system, speed, 1.0, Settings(step=25e-6, sample=1e-4), sensors=(sensor,), displacement=start.displacement
)
signal = RunSignal(record.time, record.speed, record.angle, record.signals[:, 0])
found = run_up_spectra(signal, Reference.of(sensor).value, highest=1500.0)

geometry = model.scene.bearings[0].geometry
passing = geometry.rollers * (1.0 - geometry.gamma) / 2.0
lines = found.spectra.orders
strongest = lines[np.argmax(np.nansum(found.spectra.power, axis=0))]
print(f"strongest order {strongest:.3f}; rollers pass {passing:.3f} times a turn")
assert abs(strongest - passing) < lines[1] - lines[0]  # distance of two lines

figure = Figure(figsize=(7.0, 4.0), layout="constrained")
axes = figure.subplots()
rpm, diagram = found.campbell.speeds * 30 / math.pi, found.campbell
top = diagram.level.max()
image = axes.pcolormesh(rpm, diagram.frequencies, diagram.level.T, vmin=top - 60.0, vmax=top, rasterized=True)
axes.plot(rpm, passing * rpm / 60.0, "w--", linewidth=0.8)
axes.set(xlabel="speed, rpm", ylabel="frequency, Hz")
figure.colorbar(image, label="level, dB")
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "06_campbell.png", 120)
