"""Eigenvalues by ROSS of a rotor on films that relax: the numbers of `films` in `tests/references/rotors.toml`.

Run: python -m tests.benchmarks.ross_films, in an environment of its own: Python 3.13 or later with
`pip install ross-rotordynamics==3.1.0`. Nothing of this project is imported.
"""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

REFERENCES = tomllib.loads((Path(__file__).parents[1] / "references" / "rotors.toml").read_text(encoding="utf-8"))
LINK_MASSES = (1e-4, 1e-6)
"""Of the node between damper and spring [kg]; lighter ones lose digits."""

FREQUENCIES = np.geomspace(5.0, 2e5, 1500)
"""Of the tables for matched whirl [rad/s]."""


def rotor(ross: Any, link_mass: float | None) -> Any:
    """The rotor with films as springs and dampers, or as tables over frequency where there is no mass of a link."""
    shaft, films = REFERENCES["friswell"], REFERENCES["films"]
    steel = ross.Material("steel", rho=shaft["density"], E=shaft["youngs_modulus"], G_s=shaft["shear_modulus"])
    count = round(shaft["length"] / shaft["element"])
    elements = [
        ross.ShaftElement(
            shaft["element"], 0.0, shaft["diameter"], material=steel, shear_effects=True, rotary_inertia=True,
            gyroscopic=True,
        )
        for _ in range(count)
    ]  # fmt: skip
    discs = [
        ross.DiskElement.from_geometry(
            n=round(place / shaft["element"]), material=steel, width=shaft["disc_width"], i_d=shaft["diameter"],
            o_d=diameter,
        )
        for place, diameter in films["discs"]
    ]  # fmt: skip
    k, c, spring = films["stiffness"], films["damping"], films["springs"]
    bearings, masses = [], []
    for index, place in enumerate(films["bearings"]):
        node, link = round(place / shaft["element"]), count + 1 + index
        if link_mass is None:
            s = 1j * FREQUENCIES
            z = [k[i] + s * c[i] / (1.0 + s * c[i] / spring[i]) for i in (0, 1)]
            bearings.append(
                ross.BearingElement(
                    n=node, frequency=FREQUENCIES, kxx=z[0].real, kyy=z[1].real, cxx=z[0].imag / FREQUENCIES,
                    cyy=z[1].imag / FREQUENCIES,
                )
            )  # fmt: skip
            continue
        bearings += [
            ross.BearingElement(n=node, kxx=k[0], kyy=k[1], cxx=0.0, cyy=0.0),
            ross.BearingElement(n=node, n_link=link, kxx=0.0, kyy=0.0, cxx=c[0], cyy=c[1]),
            ross.BearingElement(n=link, kxx=spring[0], kyy=spring[1], kzz=1e9, cxx=0.0, cyy=0.0),
        ]
        masses.append(ross.PointMass(n=link, m=link_mass))
    return ross.Rotor(elements, discs, bearings, point_mass_elements=masses)


def main() -> None:
    """Print the eigenvalues."""
    import ross  # type: ignore[import-not-found, unused-ignore]

    speed = REFERENCES["films"]["speed"] * math.pi / 30.0
    ways: list[tuple[str, float | None, dict[str, Any]]] = [
        *((f"springs and dampers, links of {mass:g} kg", mass, {}) for mass in LINK_MASSES),
        ("matched whirl", None, {"matched_whirl": True, "whirl_rtol": 1e-12, "whirl_max_iter": 60}),
    ]
    for words, mass, options in ways:
        found = rotor(ross, mass).run_modal(speed, sparse=False, num_modes=60, **options).evalues
        # Torsion and the motion along the axis are not damped.
        bending = sorted((v for v in found if v.imag > 1.0 and -v.real > 1e-6 * abs(v)), key=abs)
        print(words)
        for value in bending[: len(REFERENCES["films"]["real"])]:
            print(f"  {value.real:16.8f} {value.imag:16.8f}")


if __name__ == "__main__":
    main()
