"""A rotor on ball bearings by ROSS and by this project: the same K and C over speed, and one K for all speeds.

Run twice, in one folder for what passes between both environments:

    python -m tests.benchmarks.ross_drive make electric_drive FOLDER    here: K and C over speed, modes by mbs
    python -m tests.benchmarks.ross_drive compare FOLDER                in an environment of ROSS: prints both

The scene has one shaft; outer rings are held across the axis. ROSS has y and z of the bearings (2 x 2), mbs their tilts
too: it is compared with them and without. Frequencies are those of the lowest two modes that bend, which a shaft has
backward and forward.
"""

from __future__ import annotations

import dataclasses
import json
import math
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

RPM = math.pi / 30.0
SPEEDS = np.linspace(2000.0, 40000.0, 20)
"""Speeds of the tables [rpm]."""

BENDING = 0.2
"""Part of the motion of a mode that is across the axis, from which on it bends."""


def make(source: str, folder: Path) -> None:
    """Write shaft, discs, K and C of the bearings, and the modes by mbs."""
    from mbs import assemble, read_scene
    from mbs.linearised.averaged import mean_equilibrium
    from mbs.linearised.modes import modes
    from mbs.model.elements import Operation
    from mbs.scene.specs import ShaftSpec

    folder.mkdir(parents=True, exist_ok=True)
    scene = read_scene(source)
    model = assemble(scene)
    (shaft,) = (spec for spec in scene.bodies if isinstance(spec, ShaftSpec))
    body = next(body for body in model.system.bodies if body.name == shaft.name)
    own = model.system.own(shaft.name)
    across = np.array([frame.transform[1:3] for frame in body.frames.values()]).reshape(-1, body.size)
    tables: dict[str, Any] = {element.name: {"k": [], "c": []} for element in model.on_rings}
    whole: list[list[float]] = []
    bare: list[list[float]] = []
    for speed in (SPEEDS * RPM).tolist():
        balance = mean_equilibrium(model.system, Operation(speed), 1)
        for element, place in zip(model.on_rings, model.ring_places, strict=True):
            tables[element.name]["k"].append(balance.element_stiffness[place][1:3, 1:3].tolist())
            tables[element.name]["c"].append(balance.element_damping[place][1:3, 1:3].tolist())
        for one, rows in ((balance, whole), (_without_tilts(model, balance), bare)):
            found = modes(one, errors=False)
            swinging = (found.eigenvalues.imag > 1.0) & (np.abs(across @ found.shapes[own]).max(axis=0) > BENDING)
            rows.append(np.sort(found.eigenvalues.imag[swinging])[:4].tolist())
    places = {element.name: shaft.frames[element.inner.partition(":")[2]] for element in model.on_rings}
    (folder / "rotor.json").write_text(
        json.dumps(
            {
                "sections": [
                    [p.begin, p.end, p.diameter, p.bore, p.youngs_modulus, p.poisson_ratio, p.density]
                    for p in shaft.sections
                ],
                "discs": [[d.position, d.inertia.mass, d.inertia.polar, d.inertia.transverse] for d in shaft.discs],
                "bearings": {name: {"at": places[name], **table} for name, table in tables.items()},
                "mbs": whole,
                "mbs without tilts": bare,
            }
        ),
        encoding="utf-8",
    )
    print(f"{folder / 'rotor.json'}: written")


_FREE = 60.0
"""Frequency below which a motion of ROSS is free [rad/s]."""


def _without_tilts(model: Any, balance: Any) -> Any:
    """The equilibrium whose bearings have y, z and x alone, each for itself, as ROSS has them."""
    stiffness = balance.stiffness.copy()
    kept = np.zeros((6, 6))
    kept[0, 0] = kept[1, 1] = kept[1, 2] = kept[2, 1] = kept[2, 2] = 1.0
    for place in model.ring_places:
        transform = model.system.elements[place].transform
        stiffness -= transform.T @ (balance.element_stiffness[place] * (1.0 - kept)) @ transform
    return dataclasses.replace(balance, stiffness=stiffness)


def rotor(ross: Any, data: dict[str, Any], constant: int | None) -> Any:
    """The rotor of ROSS; with the K and C of one speed where its place is given."""
    stations = {0.0}
    for begin, end, *_ in data["sections"]:
        stations |= {round(begin, 9), round(end, 9)}
    stations |= {round(disc[0], 9) for disc in data["discs"]} | {round(b["at"], 9) for b in data["bearings"].values()}
    nodes = sorted(stations)
    fine = [x for a, b in pairwise(nodes) for x in np.linspace(a, b, 3)[:-1]] + [nodes[-1]]
    parts = []
    for a, b in pairwise(fine):
        middle = 0.5 * (a + b)
        _, _, outer, bore, modulus, ratio, density = next(s for s in data["sections"] if s[0] <= middle <= s[1])
        material = ross.Material(name="steel", rho=density, E=modulus, Poisson=ratio)
        parts.append(ross.ShaftElement(L=b - a, idl=bore, odl=outer, material=material))
    at = {round(x, 9): n for n, x in enumerate(fine)}
    discs = [ross.DiskElement(n=at[round(x, 9)], m=m, Ip=polar, Id=other) for x, m, polar, other in data["discs"]]
    bearings = []
    for bearing in data["bearings"].values():
        entries = {}
        for name in "kc":
            table = np.array(bearing[name])
            for row, column, axes in ((0, 0, "xx"), (0, 1, "xy"), (1, 0, "yx"), (1, 1, "yy")):
                values = table[:, row, column]
                entries[name + axes] = values if constant is None else np.full(values.size, values[constant])
        bearings.append(ross.BearingElement(n=at[round(bearing["at"], 9)], frequency=SPEEDS * RPM, **entries))
    return ross.Rotor(parts, discs, bearings)


def compare(folder: Path) -> None:
    """Print frequencies and critical speeds by both."""
    import ross

    data = json.loads((folder / "rotor.json").read_text(encoding="utf-8"))
    ours, bare = (np.array(data[name]) / (2.0 * math.pi) for name in ("mbs", "mbs without tilts"))
    middle = int(np.argmin(np.abs(SPEEDS - 12000.0)))
    over, one = rotor(ross, data, None), rotor(ross, data, middle)
    theirs, fixed = (np.array([_bending(r, speed * RPM) for speed in SPEEDS.tolist()]) for r in (over, one))
    print("rpm      mbs: 1 b, 1 f Hz      mbs without tilts     ROSS, K over speed      ROSS, K of 12000 rpm")
    for row, speed in enumerate(SPEEDS.tolist()):
        cells = "   ".join(f"{a[row, 0]:9.2f} {a[row, 1]:9.2f}" for a in (ours, bare, theirs, fixed))
        print(f"{speed:7.0f}  {cells}")
    for name, lines in (("mbs", ours), ("mbs without tilts", bare)):
        print(f"ROSS beside {name}: first two modes within {np.max(np.abs(theirs[:, :2] / lines[:, :2] - 1.0)):.2%}")
    for name, lines in (
        ("mbs", ours),
        ("mbs without tilts", bare),
        ("ROSS, K over speed", theirs),
        ("ROSS, K of 12000 rpm", fixed),
    ):
        print(f"{name}: critical at {_critical(lines[:, 1]):.0f} rpm")


def _bending(machine: Any, speed: float) -> np.ndarray:
    """Lowest four damped frequencies of bending [Hz], rising."""
    found = machine.run_modal(speed=speed, num_modes=24, sparse=False)
    # ROSS leaves the axis and the turning free: at zero, to rounding
    values = np.sort(np.asarray(found.wd)[np.asarray(found.wd) > _FREE])
    return np.asarray(values[:4]) / (2.0 * math.pi)


def _critical(frequency: np.ndarray) -> float:
    """Speed at which the first forward mode is that of the turns [rpm]; NaN if it is none of these."""
    gap = frequency * 60.0 - SPEEDS
    for k in np.flatnonzero((gap[:-1] > 0.0) & (gap[1:] <= 0.0)):
        return float(SPEEDS[k] + (SPEEDS[k + 1] - SPEEDS[k]) * gap[k] / (gap[k] - gap[k + 1]))
    return math.nan


if __name__ == "__main__":
    if sys.argv[1] == "make":
        make(sys.argv[2], Path(sys.argv[3]))
    else:
        compare(Path(sys.argv[2]))
