"""One contact by every solver: dry after Hertz, by a film formula, by the Reynolds equation, and by OpenFOAM.

Run it with `python examples/01_one_contact_by_four_solvers.py [FOLDER]`; the figure is written to the folder.
It prints stiffness and damping of a slice of 0.45 mm of an N1014 at 40 N, and checks the dry stiffness: ISO/TS 16281
gives the approach of both contacts by Q = 35948 L^(8/9) delta^(10/9) (N, mm), so that k = (10/9) Q/(delta/2) is known.
"""

import sys
from pathlib import Path

from matplotlib.figure import Figure

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.outputs import write_figure
from ehdmaps.units import DAMPER, SPRING

BEARING, SLICE, FORCE = ehdmaps.BearingGeometry.named("N1014"), 0.45e-3, 40.0
contact, _ = BEARING.contacts(ehdmaps.STEEL, "iso16281")
point = ehdmaps.OperatingPoint(load=FORCE / SLICE, entrainment_speed=3.297, temperature=313.15)

found = {}
for solver in ("hertz", "formula", "reynolds", "openfoam"):
    try:
        found[solver] = one = ehdmaps.solve(contact, ehdmaps.Lubricant.named("FVA3"), point, solver)
    except InputError as error:
        print(f"{solver}: skipped; {error}")
        continue
    print(f"{solver}: k {SPRING.text(one.stiffness * SLICE)}, c {DAMPER.text(one.damping * SLICE, 3)}")

length = 1e3 * BEARING.roller_length  # the law takes the whole roller, in mm and N
both = (point.load * 1e-3 * length / (35948.0 * length ** (8 / 9))) ** 0.9 * 1e-3
expected = 10 / 9 * point.load / (both / 2)
assert abs(found["hertz"].stiffness / expected - 1.0) < 1e-12  # rounding

figure = Figure(figsize=(7.0, 3.0), layout="constrained")
for axes, name, display in zip(figure.subplots(1, 2), ("stiffness", "damping"), (SPRING, DAMPER), strict=True):
    axes.bar(list(found), [display.value(getattr(solution, name) * SLICE) for solution in found.values()])
    axes.set_ylabel(f"{name} of the slice, {display.unit}")
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "01_one_contact.png")
