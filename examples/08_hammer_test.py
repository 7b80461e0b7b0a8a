"""A hammer test: hits on a shipped machine, and the modes that a fit finds in them.

Run it with `python examples/08_hammer_test.py [FOLDER]`; the figure is written to the folder.
The records are simulated, with 1 % of noise. The fit knows the records only; the mode that it finds in the band must
have frequency and damping of an eigenvalue of the linear system that was hit. It does not find every eigenvalue: the
hits are vertical, and modes along the shaft or sideways, which they hardly excite, are lost in the noise.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.outputs import write_figure
from mbs import HammerSettings, assemble, hammer, read_scene
from mbs.modal.estimation import estimate
from mbs.modal.fit import identify

test = hammer(assemble(read_scene("n1014_testrig"), "hertz"), HammerSettings(highest=3000.0, duration=1.3, seed=1))
responses = estimate(test.hits).responses
found = identify(responses, band=(1000.0, 1800.0))

for frequency, ratio, error in zip(found.frequency, found.damping_ratio, found.frequency_uncertainty, strict=True):
    nearest = np.argmin(np.abs(test.modes.frequency - frequency))
    expected, damped = test.modes.frequency[nearest], test.modes.damping_ratio[nearest]
    print(f"{frequency:.2f} +- {error:.2f} Hz, {100 * ratio:.4f} %; eigenvalue {expected:.2f} Hz, {100 * damped:.4f} %")
    # four standard uncertainties by noise, and what modes outside the band add
    assert abs(frequency - expected) < 4.0 * error + 1e-4 * expected
    assert abs(ratio / damped - 1.0) < 0.02
assert found.frequency.size > 0

figure = Figure(figsize=(7.0, 3.5), layout="constrained")
axes = figure.subplots()
for row, label in zip(responses.response, responses.labels, strict=True):
    axes.semilogy(responses.frequency, np.abs(row) / np.abs(row).max(), label=label, linewidth=0.8)
for frequency in found.frequency:
    axes.axvline(frequency, color="k", linestyle="--", linewidth=0.8)
axes.set(xlabel="frequency, Hz", ylabel="response over its largest value", xlim=(0.0, 3000.0))
axes.legend()
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "08_hammer.png")
