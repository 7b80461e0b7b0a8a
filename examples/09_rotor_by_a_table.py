"""A rotor by a table: a hollow stepped shaft with a disc, on two bearings by designation and position.

Run it with `python examples/09_rotor_by_a_table.py [FOLDER]`; the figure is written to the folder.
Weight is on. It finds the forces of the bearings, whose sum is the weight by hand, and the critical speeds.
"""

import math
import sys
from pathlib import Path

from ehdmaps.outputs import write_figure
from mbs import assemble, critical, parse_scene, statics

ROTOR = """
schema = 1
bearings = [
    { name = "left", bearing = "NU210", shaft = "rotor", position = "30 mm", diametral_clearance = "20 um" },
    { name = "right", bearing = "NU208", shaft = "rotor", position = "660 mm", diametral_clearance = "20 um" },
]
unbalances = [{ name = "residual", on = "rotor:wheel", moment = "100 g mm" }]
operation = { speed = "3000 rpm", temperature = "60 degC" }
lubricant = { name = "FVA3" }
sweep = { from = "1000 rpm", to = "8000 rpm", points = 8 }
[[shafts]]
name = "rotor"
sections = [{ length = "60 mm", diameter = "50 mm" }, { length = "620 mm", diameter = "40 mm", bore = "10 mm" }]
discs = [{ name = "wheel", at = "350 mm", diameter = "250 mm", width = "40 mm", bore = "40 mm" }]
damping_ratio = 0.005
"""
model = assemble(parse_scene(ROTOR, "rotor", "rotor"), law="table")  # films of the oil from the shipped table
carried = statics(model).dataset["bearing_force"].sum("bearing").values[1]
volume = 0.25 * math.pi * (0.06 * 0.05**2 + 0.62 * (0.04**2 - 0.01**2) + 0.04 * (0.25**2 - 0.04**2))
print(f"{model.scene.weight}: bearings carry {carried:.4f} N, by hand {7850.0 * volume * 9.80665:.4f} N")
assert abs(carried / (7850.0 * volume * 9.80665) - 1.0) < 1e-8  # rounding of an equilibrium
found = critical(model)
print("critical speeds:", ", ".join(f"{entry.speed * 30.0 / math.pi:.0f} rpm" for entry in found.found))
write_figure(found.plot(), Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "09_rotor.png")
