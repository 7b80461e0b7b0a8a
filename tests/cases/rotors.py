"""Rotors of `tests/references/rotors.toml` as scenes."""

from __future__ import annotations

import dataclasses
import tomllib
from pathlib import Path

import numpy as np

from mbs import Inertia, Scene, ShaftSpec, Spring, parse_scene, read_scene
from mbs.scene.matrices import MatrixSpec

AXIS = Spring("axis", "rotor:end", "ground", np.diag([5e7, 0.0, 0.0, 0.0, 0.0, 0.0]))
REFERENCES = tomllib.loads((Path(__file__).parents[1] / "references" / "rotors.toml").read_text(encoding="utf-8"))
OVERHUNG, FAN = REFERENCES["overhung"], REFERENCES["fan"]


def fan() -> Scene:
    """The shipped overhung rotor without damping of the shaft, on the radial stiffness of its roller bearings alone."""
    scene = read_scene("overhung_rotor")
    (shaft,) = scene.bodies
    assert isinstance(shaft, ShaftSpec)
    kept = [
        MatrixSpec(
            entry.name,
            entry.inner,
            np.pad(stiffness, ((1, 3), (1, 3)))[None],
            np.pad(damping, ((1, 3), (1, 3)))[None],
        )
        for entry, (_, stiffness, damping) in zip(reversed(scene.bearings), FAN["bearings"], strict=True)
    ]
    return dataclasses.replace(
        scene, bodies=[dataclasses.replace(shaft, damping_ratio=0.0)], elements=kept, excitations=(), springs=[AXIS]
    )


def overhung() -> Scene:
    """The overhung rotor on bearings by matrices, with its unbalance."""
    shaft, (place, diameter) = REFERENCES["friswell"], OVERHUNG["disc"]
    poisson = shaft["youngs_modulus"] / (2.0 * shaft["shear_modulus"]) - 1.0
    names = ("y", "z")

    def table(key: str, unit: str) -> str:
        entries = (
            f"{a}_{b} = {[f'{value!r} {unit}' for value in OVERHUNG[key][i][j]]!r}"
            for i, a in enumerate(names)
            for j, b in enumerate(names)
        )
        return f"{{ {', '.join(entries)} }}"

    bearings = "".join(
        f"""
[[bearings]]
kind = "table"
name = "bearing_{index}"
inner = "shaft:at_{index}"
outer = "ground"
speeds = {[f"{speed!r} rpm" for speed in OVERHUNG["speeds"]]!r}
stiffness = {table("k", "N/m")}
damping = {table("c", "N s/m")}
"""
        for index in range(len(OVERHUNG["bearings"]))
    )
    frames = ", ".join(f'at_{index} = "{at!r} m"' for index, at in enumerate(OVERHUNG["bearings"]))
    half = 0.5 * shaft["disc_width"]
    disc = Inertia.cylinder(-half, half, diameter, shaft["diameter"], shaft["density"])
    return parse_scene(
        f"""
schema = 1
[operation]
speed = "1000 rpm"
temperature = "40 degC"
[[shafts]]
name = "shaft"
freedoms = ["y", "z", "theta_y", "theta_z"]
spin = 1
cutoff = "5 kHz"
largest_element = "{OVERHUNG["element"]!r} m"
sections = [{{ from = "0 m", to = "{shaft["length"]!r} m", diameter = "{shaft["diameter"]!r} m", \
youngs_modulus = "{shaft["youngs_modulus"]!r} Pa", poisson_ratio = {poisson!r}, \
density = "{shaft["density"]!r} kg/m^3" }}]
discs = [{{ at = "{place!r} m", mass = "{disc.mass!r} kg", polar_inertia = "{disc.polar!r} kg m^2", \
transverse_inertia = "{disc.transverse!r} kg m^2" }}]
frames = {{ {frames}, disc = "{place!r} m" }}
{bearings}
[[unbalances]]
name = "unbalance"
on = "shaft:disc"
moment = "{OVERHUNG["unbalance"]!r} kg m"
""",
        "overhung",
        "overhung",
    )


DISC = """
schema = 1
[operation]
speed = "3000 rpm"
temperature = "40 degC"
[[bodies]]
name = "disc"
freedoms = ["y", "z"]
spin = 1
mass = "2 kg"
polar_inertia = "0.01 kg m^2"
transverse_inertia = "0.005 kg m^2"
[[springs]]
name = "shaft"
on = "disc"
stiffness = { y = "2e5 N/m", z = "2e5 N/m" }
damping = { y = "40 N s/m", z = "40 N s/m" }
"""
"""Scene of a disc of 2 kg between springs of 2e5 N/m and dampers of 40 N s/m."""
