"""A rotor of your own by a table: sections, a disc, two bearings by designation; statics, modes, critical speeds.

    python examples/09_rotor_by_a_table.py

Writes rotor.png with the critical speeds into this folder.
"""

from __future__ import annotations

from mbs import assemble, critical, modes, parse_scene, statics

ROTOR = """
schema = 1
bearings = [
    { name = "left", bearing = "NU210", shaft = "rotor", position = "30 mm", diametral_clearance = "20 um" },
    { name = "right", bearing = "NU206", shaft = "rotor", position = "660 mm", diametral_clearance = "20 um" },
]
unbalances = [{ name = "residual", on = "rotor:wheel", moment = "100 g mm" }]
operation = { speed = "3000 rpm", temperature = "60 degC" }
lubricant = { name = "FVA3" }
sweep = { from = "1000 rpm", to = "12000 rpm", points = 12 }
[[shafts]]
name = "rotor"
sections = [{ length = "60 mm", diameter = "50 mm" }, { length = "620 mm", diameter = "40 mm", bore = "10 mm" }]
discs = [{ name = "wheel", at = "350 mm", diameter = "250 mm", width = "40 mm", bore = "40 mm" }]
damping_ratio = 0.005
"""

if __name__ == "__main__":
    model = assemble(parse_scene(ROTOR, "rotor", "rotor"))
    print(model.scene.weight)
    print(statics(model).dataset["bearing_force"].round(1).to_pandas())
    print(modes(model).dataset["frequency"].values[:4].round(1), "Hz")
    found = critical(model)
    print([f"{entry.speed * 9.5493:.0f} rpm" for entry in found.found])
    found.plot().savefig("rotor.png", dpi=150)
