"""One rotor on exported bearings: its damped frequencies and its unbalance response by ROSS and by this project.

Run twice, in one folder for what passes between both environments:

    python -m tests.benchmarks.ross_export make MAP.nc FOLDER      here: exports the bearings, computes by mbs
    python -m tests.benchmarks.ross_export compare FOLDER          in an environment of ROSS (2.3 on Python 3.11, or
                                                                   3.1 on 3.13): reads the files, prints differences

The rotor is the shaft and the wheel of the shipped overhung rotor on two NU308 with 20 um clearance, each with a
static load of 2 kN, without weight; MAP.nc is a map of the NU308. The bearings of ROSS have no stiffness against
tilting, those of mbs have: that is part of the differences.
"""

from __future__ import annotations

import json
import math
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

RPM = math.pi / 30.0
SPEEDS = (500.0, 1500.0, 2500.0, 3500.0, 4500.0, 5500.0, 6000.0)
"""Speeds of the tables, at which both are compared too [rpm]."""

LOAD, CLEARANCE, TEMPERATURE = "2 kN", "20 um", "40 degC"
PLACES = {"end": 0.03, "front": 0.31}
FAN = tomllib.loads((Path(__file__).parents[1] / "references" / "rotors.toml").read_text(encoding="utf-8"))["fan"]
DOFS = 6


def make(source: str, folder: Path) -> None:
    """Export the bearings, and compute the rotor by mbs."""
    from ehdmaps.jobs.cli import main as ehdmaps
    from mbs import assemble, parse_scene, read_scene
    from mbs.linearised.critical import order_responses
    from mbs.linearised.modes import modes
    from mbs.model.elements import Operation
    from mbs.model.equilibrium import equilibrium

    folder.mkdir(parents=True, exist_ok=True)
    point = ["--load", LOAD, "--clearance", CLEARANCE, "--temperature", TEMPERATURE, "--films", "slow"]
    speeds = [word for speed in SPEEDS for word in ("--speed", f"{speed} rpm")]
    for version in "23":
        name = str(folder / f"bearing{version}.toml")
        assert ehdmaps(["export", source, "--to", "ross", "--ross", version, "-o", name, *point, *speeds]) == 0
    text = read_scene("overhung_rotor").text
    head, tail = text.split("[[bearings]]", 1)
    head = head.replace('"-9.81 m/s^2"', '"0 m/s^2"').replace("damping_ratio = 0.001", "damping_ratio = 0")
    rest = "[[unbalances]]" + tail.split("[[unbalances]]", 1)[1].split("[[excitations]]")[0]
    parts = [head]
    for name in PLACES:
        geometry = f'{{ name = "NU308", diametral_clearance = "{CLEARANCE}" }}'
        parts.append(
            f'[[bearings]]\nname = "{name}"\ninner = "rotor:{name}"\nouter = "ground"\ngeometry = {geometry}\n'
            f'[[loads]]\nname = "on_{name}"\non = "rotor:{name}"\nforce = ["0 N", "{LOAD}", "0 N"]\n'
        )
    parts.append('[[springs]]\nname = "axis"\non = "rotor:end"\nstiffness = { x = "5e7 N/m" }\n')
    scene = parse_scene("\n".join([*parts, rest]), "ross_export", "ross_export")
    model = assemble(scene, "map", source, films="slow")
    turning = np.array(SPEEDS) * RPM
    (response,) = order_responses(lambda speed: model.system, turning)
    moved = response.motion @ model.system.relative("rotor:wheel")[1:3].T
    found = [modes(equilibrium(model.system, Operation(speed))).eigenvalues for speed in turning]
    (folder / "mbs.json").write_text(
        json.dumps(
            {
                "eigenvalues": [[[v.real, v.imag] for v in values if v.imag > 1.0] for values in found],
                "response": [[[v.real, v.imag] for v in row] for row in moved],
            }
        ),
        encoding="utf-8",
    )
    print(f"{folder}: bearing2.toml, bearing3.toml, mbs.json written")


def rotor(ross: Any, path: Path) -> Any:
    """The rotor on exported bearings."""
    steel = ross.Material("steel", rho=FAN["density"], E=FAN["youngs_modulus"], Poisson=FAN["poisson_ratio"])
    element = FAN["element"]
    elements = [
        ross.ShaftElement(
            element, 0.0, diameter, material=steel, shear_effects=True, rotary_inertia=True, gyroscopic=True
        )
        for begin, end, diameter in FAN["sections"]
        for _ in range(round((end - begin) / element))
    ]
    place, mass, polar, transverse = FAN["disc"]
    disc = ross.DiskElement(n=round(place / element), m=mass, Ip=polar, Id=transverse)
    bearings = []
    for name, at in PLACES.items():
        bearing = ross.BearingElement.load(path)
        bearing.n, bearing.tag = round(at / element), name
        bearing.n_l = bearing.n_r = bearing.n
        bearings.append(bearing)
    return ross.Rotor(elements, [disc], bearings)


def compare(folder: Path) -> None:
    """Print the differences between ROSS and mbs."""
    import ross  # type: ignore[import-not-found, unused-ignore]

    version = "2" if ross.__version__.startswith("2") else "3"
    machine = rotor(ross, folder / f"bearing{version}.toml")
    ours = json.loads((folder / "mbs.json").read_text(encoding="utf-8"))
    node, turning = round(FAN["disc"][0] / FAN["element"]), np.array(SPEEDS) * RPM
    moved = machine.run_unbalance_response(node, FAN["unbalance"], 0.0, turning).forced_resp
    frequency, response = [], []
    print(f"ROSS {ross.__version__}; speed [rpm], frequencies by ROSS and mbs [Hz], differences of frequency, response")
    for k, speed in enumerate(turning):
        values = machine.run_modal(speed, num_modes=24).evalues
        theirs = sorted(abs(v.imag) / (2.0 * math.pi) for v in values if v.imag > 1.0 and abs(v.real) > 1e-7 * abs(v))
        mine = [abs(v[1]) / (2.0 * math.pi) for v in ours["eigenvalues"][k]]
        lowest = theirs[:4]
        nearest = [min(mine, key=lambda f, t=t: abs(f - t)) for t in lowest]
        apart = [abs(n / t - 1.0) for n, t in zip(nearest, lowest, strict=True)]
        x, y = moved[DOFS * node, k], moved[DOFS * node + 1, k]
        wanted = np.array([complex(*v) for v in ours["response"][k]])
        off = float(np.max(np.abs(np.array([x, y]) - wanted)) / np.max(np.abs(wanted)))
        frequency.append(max(apart))
        response.append(off)
        words = " ".join(f"{t:.2f}/{n:.2f}" for t, n in zip(lowest, nearest, strict=True))
        print(f"  {speed / RPM:7.0f}  {words}  {max(apart):.2e}  {off:.2e}")
    for name, found in (("frequency", frequency), ("response", response)):
        print(f"largest difference of {name}: {max(found):.2e}, median {np.median(found):.2e}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["make"]:
        make(sys.argv[2], Path(sys.argv[3]))
    else:
        compare(Path(sys.argv[2]))
