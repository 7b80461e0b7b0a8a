"""A scene of masses, each on one bearing that holds it along x, y and z."""

from __future__ import annotations

OIL = '[lubricant]\nname = "ISO VG 32"\n'

_MASS = """
[[bodies]]
name = "{bearing}"
freedoms = ["x", "y", "z"]
spin = 1
mass = "20 kg"
polar_inertia = "0.05 kg m^2"
transverse_inertia = "0.2 kg m^2"
[[bearings]]
name = "of {bearing}"
bearing = "{bearing}"
inner = "{bearing}"
outer = "ground"
[[loads]]
name = "on {bearing}"
on = "{bearing}"
force = ["1500 N", "-2000 N", "0 N"]
"""


def masses_on(*bearings: str) -> str:
    """Text of the scene, with an oil."""
    head = f'schema = 1\n[operation]\nspeed = "3000 rpm"\ntemperature = "60 degC"\n{OIL}'
    return head + "".join(_MASS.format(bearing=name) for name in bearings)


MASSES = masses_on("32208", "NUP210", "6208")
