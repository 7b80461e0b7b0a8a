"""Critical speeds and unbalance response by ROSS of an overhung rotor: the numbers of `overhung` in `rotors.toml`.

Run: python -m tests.benchmarks.ross_unbalance, in an environment of its own: Python 3.13 or later with
`pip install ross-rotordynamics==3.1.0`. Nothing of this project is imported.
"""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import brentq

REFERENCES = tomllib.loads((Path(__file__).parents[1] / "references" / "rotors.toml").read_text(encoding="utf-8"))
RPM = math.pi / 30.0
DOFS = 6
"""Of a node in ROSS: x, y, z (along the axis) and rotations about them."""


def rotor(ross: Any) -> Any:
    """The rotor, with bearings as tables over speed."""
    shaft, case = REFERENCES["friswell"], REFERENCES["overhung"]
    steel = ross.Material("steel", rho=shaft["density"], E=shaft["youngs_modulus"], G_s=shaft["shear_modulus"])
    element = case["element"]
    elements = [
        ross.ShaftElement(
            element, 0.0, shaft["diameter"], material=steel, shear_effects=True, rotary_inertia=True, gyroscopic=True
        )
        for _ in range(round(shaft["length"] / element))
    ]
    place, diameter = case["disc"]
    disc = ross.DiskElement.from_geometry(
        n=round(place / element), material=steel, width=shaft["disc_width"], i_d=shaft["diameter"], o_d=diameter
    )
    speeds = np.array(case["speeds"]) * RPM
    tables = {
        f"{ours[0]}{axes[0]}{axes[1]}": np.array(case[ours][i][j])
        for ours in ("k", "c")
        for i, j, axes in ((0, 0, "xx"), (0, 1, "xy"), (1, 0, "yx"), (1, 1, "yy"))
    }
    bearings = [ross.BearingElement(n=round(at / element), frequency=speeds, **tables) for at in case["bearings"]]
    return ross.Rotor(elements, [disc], bearings)


def frequencies(machine: Any, speed: float) -> Any:
    """Eigenvalues of bending at a speed [rad/s], in the order of their frequency; torsion is not damped."""
    values = machine.run_modal(speed, sparse=False, num_modes=60).evalues
    found = [v for v in values if v.imag > 1.0 and abs(v.real) > 1e-7 * abs(v)]
    return np.array(sorted(found, key=lambda v: v.imag))


def main() -> None:
    """Print critical speeds and responses."""
    import ross  # type: ignore[import-not-found, unused-ignore]

    case, machine = REFERENCES["overhung"], rotor(ross)
    grid = np.linspace(100.0, case["speeds"][-1], 60) * RPM
    apart = np.array([[frequencies(machine, w)[mode].imag - w for mode in range(4)] for w in grid])
    print("critical speeds [rpm], damping ratio")
    for mode in range(4):
        for i in np.flatnonzero(apart[:-1, mode] * apart[1:, mode] < 0.0):
            speed = brentq(lambda w, m=mode: frequencies(machine, w)[m].imag - w, grid[i], grid[i + 1], xtol=1e-9)
            value = frequencies(machine, speed)[mode]
            print(f"  {speed / RPM:14.6f} {-value.real / abs(value):12.8f}")
    element = case["element"]
    node = round(case["disc"][0] / element)
    speeds = np.array(case["response_speeds"]) * RPM
    found = machine.run_unbalance_response(node, case["unbalance"], 0.0, speeds).forced_resp
    print("amplitudes [m] at the disc along both directions: real, imaginary")
    for k, speed in enumerate(case["response_speeds"]):
        x, y = found[DOFS * node, k], found[DOFS * node + 1, k]
        print(f"  {speed:8.1f} rpm {x.real: .8e} {x.imag: .8e} {y.real: .8e} {y.imag: .8e}")


if __name__ == "__main__":
    main()
