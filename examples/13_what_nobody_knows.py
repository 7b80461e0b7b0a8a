"""A hammer test tells the clearances of two ball bearings that the scene does not know.

Run it with `python examples/13_what_nobody_knows.py [FOLDER]`; the figure is written to the folder.
The records are simulated, with 1 % of noise, on a machine with another clearance than the scene says. What is found
must be the clearance that was hidden, and its band must hold it. Records of a real machine come from a file:
`identify(scene, [("hits.uff", "6000 rpm")], free=["clearance"])`.
"""

import sys
from pathlib import Path

from ehdmaps.outputs import write_figure
from mbs import HammerSettings, assemble, hammer, identify, read_scene
from mbs.modal.estimation import estimate

HIDDEN = 11e-6  # m

scene = read_scene("electric_drive")
test = hammer(assemble(scene, clearance=HIDDEN), HammerSettings(highest=1500.0, seed=1))
responses = estimate(test.hits).responses

found = identify(scene, [(responses, "6000 rpm")], free=["clearance"], cage_angles=1)
for name, value, low, high in zip(
    found.dataset["unknown"].values, found.fit.values, found.bands[0], found.bands[1], strict=True
):
    print(f"{name}: {1e6 * value:.2f} um, {1e6 * low:.1f} to {1e6 * high:.1f} um")
    # half a micrometre: what 1 % of noise leaves is less
    assert abs(value - HIDDEN) < 0.5e-6
    assert low < HIDDEN < high

write_figure(found.plot(), Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "13_identified.png")
