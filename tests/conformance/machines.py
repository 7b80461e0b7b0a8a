"""Kinds of bearings, pairs of them and machines that mix them: one row each, as scenes of a rigid rotor."""

from __future__ import annotations

from dataclasses import dataclass

HEAD = """
schema = 1
title = "{name}"
[operation]
speed = "1500 rpm"
temperature = "60 degC"
[lubricant]
name = "FVA3"
[[bodies]]
name = "rotor"
freedoms = {freedoms}
spin = 1
mass = "8 kg"
polar_inertia = "0.02 kg m^2"
transverse_inertia = "0.2 kg m^2"
frames = {{ left = ["-60 mm", "0 mm", "0 mm"], middle = ["0 mm", "0 mm", "0 mm"], right = ["60 mm", "0 mm", "0 mm"] }}
"""

TAIL = """
[[loads]]
name = "pull"
on = "rotor"
force = {load}
[[unbalances]]
name = "residual"
on = "rotor"
moment = "20 g mm"
[[inputs]]
name = "push"
on = "rotor:left"
direction = "y"
[[sensors]]
name = "seen"
on = "rotor:right"
direction = "y"
quantity = "acceleration"
[linear]
frequencies = { from = "50 Hz", to = "4 kHz", points = 12, spacing = "log" }
[sweep]
from = "1000 rpm"
to = "3000 rpm"
points = 2
[runup]
from = "1500 rpm"
to = "1600 rpm"
duration = "80 ms"
step = "20 us"
sample = "100 us"
[campbell]
sensor = "seen"
highest = "4 kHz"
"""

BEARING = """
[[bearings]]
name = "{name}"
inner = "rotor:{at}"
outer = "ground"
{keys}
"""

RADIAL = '["y", "z", "theta_y", "theta_z"]'
FULL = '["x", "y", "z", "theta_y", "theta_z"]'

SLICES = "slices = 5"
NU = f'bearing = "NU308"\n{SLICES}\ndiametral_clearance = "10 um"'
NEEDLE, NN, NNU = (NU.replace("NU308", name) for name in ("NA4908", "NN3016", "NNU4920"))
FEW = """
geometry = { inner_raceway_diameter = "52 mm", outer_raceway_diameter = "80 mm", roller_diameter = "14 mm", \
roller_length = "14 mm", rollers = 7, diametral_clearance = "5 um" }
rollers = "bodies"
slices = 3
"""
NUP, NJ, NNCF = (NU.replace("NU308", name) for name in ("NUP308", "NJ308", "NNCF5010"))
BALL, ANGULAR, TAPERED = (f'bearing = "{name}"' for name in ("6208", "7208B", "32208"))
ROWS, FOUR_POINT, SPHERE, THRUST = (f'bearing = "{name}"' for name in ("3208", "QJ208", "1208", "51208"))
TABLE = """
kind = "table"
speeds = ["0 rpm", "3000 rpm"]
stiffness = { x_x = "1e7 N/m", y_y = ["2e8 N/m", "2.2e8 N/m"], z_z = "1.8e8 N/m", y_z = "1e6 N/m", z_y = "-1e6 N/m" }
damping = { x_x = "100 N s/m", y_y = "2e3 N s/m", z_z = "2e3 N s/m" }
"""
PUSHED = 'axial_offset = "6 um"'
BACK = 'axial_offset = "-6 um"\nmirrored = true'
TURNED = "mirrored = true"

Bearings = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Machine:
    """A row: a rotor on bearings.

    Attributes
    ----------
    name : str
        Name of the kind, the pair or the mix.
    bearings : tuple of (str, str)
        Place on the rotor and keys of each.
    axial : bool
        Whether the rotor moves along its axis.
    films : bool
        Whether its bearings have films.
    heavy : tuple of float
        Direction of a load that its bearings carry as far as contacts do.
    """

    name: str
    bearings: Bearings
    axial: bool = True
    films: bool = True
    heavy: tuple[float, float, float] = (0.0, -1.0, 0.0)

    def text(self, load: tuple[float, float, float] = (200.0, -500.0, 150.0)) -> str:
        """The scene under a load on the rotor [N]."""
        parts = [HEAD.format(name=self.name, freedoms=FULL if self.axial else RADIAL)]
        parts += [
            BEARING.format(name=f"{at}_{index}", at=at, keys=keys) for index, (at, keys) in enumerate(self.bearings)
        ]
        return "".join([*parts, TAIL.replace("{load}", str([f"{part!r} N" for part in load]))])


def alike(keys: str) -> Bearings:
    """Two bearings of a kind."""
    return (("left", keys), ("right", keys))


def preloaded(left: str, right: str = "") -> Bearings:
    """Two bearings in O arrangement, preloaded by displacement."""
    return (("left", f"{left}\n{PUSHED}"), ("right", f"{right or left}\n{BACK}"))


KINDS = (
    Machine("cylindrical", alike(NU), axial=False),
    Machine("rollers as bodies", alike(FEW), axial=False),
    Machine("needle", (("left", NEEDLE), ("right", NEEDLE.replace("NA4908", "HK4020"))), axial=False),
    Machine("double row cylindrical", (("left", NN), ("right", NNU)), axial=False),
    Machine("deep groove", alike(BALL)),
    Machine("hybrid, thin section", (("left", 'bearing = "6208 HC"'), ("right", 'bearing = "61912"'))),
    Machine(
        "two rows, four-point", (("left", 'bearing = "3208"'), ("right", 'bearing = "QJ208"')), heavy=(1.0, -0.3, 0.0)
    ),
    Machine("self-aligning", alike(SPHERE)),
    Machine("thrust", (*preloaded(THRUST), ("left", NU), ("right", NU)), heavy=(1.0, -0.3, 0.0)),
    Machine("angular contact", preloaded(ANGULAR), heavy=(1.0, -0.3, 0.0)),
    Machine("tapered", preloaded(TAPERED), heavy=(0.25, -1.0, 0.0)),
    Machine("ribbed NUP", alike(NUP)),
    Machine("ribbed NJ, NNCF", (("left", NJ), ("right", f"{NNCF}\n{TURNED}"))),
    Machine("table", alike(TABLE), films=False),
)
"""Machines of one kind each."""

MIXED = (
    Machine("deep groove, cylindrical", (("left", BALL), ("right", NU))),
    Machine("tapered, idle cylindrical", (*preloaded(TAPERED), ("middle", NU.replace("10 um", "100 um")))),
    Machine("angular, tapered, cylindrical", (*preloaded(ANGULAR, TAPERED), ("right", NU))),
    Machine(
        "all kinds",
        (
            *preloaded(ANGULAR, TAPERED),
            ("left", BALL),
            ("left", NU),
            ("right", FEW),
            ("middle", NEEDLE),
            ("middle", NUP),
            ("right", TABLE),
        ),
    ),
)
"""Machines that mix them."""

MACHINES = (*KINDS, *MIXED)
