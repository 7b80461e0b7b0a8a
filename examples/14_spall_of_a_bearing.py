"""What a spall of the outer ring does to a ball bearing on a test spindle, beside a ring that is only wavy.

Run it with `python examples/14_spall_of_a_bearing.py [FOLDER]`; the figure is written to the folder.
The bearing turns at 1800 rpm under 150 N along its axis, as ISO 15242 measures vibration. The blows of the spall ring
in the high band, so that the envelope of that band has a line where the balls pass the outer ring. In a machine the
same keys stand in `[[bearings]]` of its scene.
"""

import math
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.outputs import write_figure
from mbs.vibration import BANDS, SPEED, envelope_spectrum, ring_vibration

WAVY = 'waviness = [{ on = "inner", waves = [2, 200], amplitude = "0.02 um", seed = 1 }]\n'
SPALL = 'spall = [{ on = "outer", length = "0.5 mm", depth = "20 um" }]\n'

figure = Figure(figsize=(7.0, 3.5), layout="constrained")
axes = figure.add_subplot(xlabel="order of the spindle", ylabel="envelope of the high band [um/s]")
for name, keys in (("wavy", WAVY), ("wavy, with a spall", WAVY + SPALL)):
    found = ring_vibration("6205", keys, 150.0, 0.06, laws=["hertz:1.25e-5 s"], duration=0.5)
    low, medium, high = 1e6 * found.bands[0]
    print(f"{name}: {low:.3g}, {medium:.3g} and {high:.3g} um/s in the low, the medium and the high band")
    frequency, amplitude = envelope_spectrum(found.signals[0], found.rate, BANDS[2])
    order = 2.0 * math.pi * frequency / SPEED
    axes.plot(order[order < 20.0], 1e6 * amplitude[order < 20.0], label=name)

largest = order[np.argmax(np.where(order > 0.5, amplitude, 0.0))]
passing = found.orders["1 BPFO"]
print(f"largest line of the envelope: order {largest:.3f}; balls pass the outer ring at {passing:.3f}")
# half of the distance of two lines of 0.5 s: 1 Hz
assert abs(largest - passing) <= 2.0 * math.pi * 1.0 / SPEED

axes.legend()
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "14_spall.png")
