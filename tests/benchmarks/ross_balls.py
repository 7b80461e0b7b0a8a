"""The shipped scenes `spindle` and `electric_drive` by ROSS, with the same tables of their bearings over speed.

Run: python -m tests.benchmarks.ross_balls tables, which writes the tables of dry contacts with a damper; and
python -m tests.benchmarks.ross_balls figures, in an environment of its own as for `tests.benchmarks.ross_machines`,
which reads them and nothing else of this project. ROSS has no stiffness against tilting; it is left out of the tables.
"""

from __future__ import annotations

import sys
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tests.benchmarks.ross_machines import RPM, across, eigenvalues, matrices, parts

REFERENCES = Path(__file__).parents[1] / "references"
LAW = "hertz:1.25e-5 s"

LARGEST = 0.01
"""Longest element [m]."""


class Machine(NamedTuple):
    """A rotor as its scene has it.

    Attributes
    ----------
    speeds : tuple
        Speeds of the tables [rpm].
    sections : tuple
        Sections of the shaft: from, to, diameter and bore [m].
    bearings : dict
        Places of the bearings [m] by their names.
    disc : tuple
        Place, length, diameter and bore of the disc [m].
    """

    speeds: tuple[float, ...]
    sections: tuple[tuple[float, float, float, float], ...]
    bearings: dict[str, float]
    disc: tuple[float, float, float, float]


MACHINES = {
    "spindle": Machine(
        (500.0, 2500.0, 5000.0, 7500.0, 10000.0),
        (
            (0.0, 0.06, 0.05, 0.0),
            (0.06, 0.1, 0.09, 0.03),
            (0.1, 0.17, 0.07, 0.03),
            (0.17, 0.39, 0.066, 0.03),
            (0.39, 0.46, 0.06, 0.03),
            (0.46, 0.5, 0.05, 0.03),
        ),
        {"front": 0.115, "front_inside": 0.155, "rear_inside": 0.410, "rear": 0.440},
        (0.275, 0.15, 0.11, 0.066),
    ),
    "electric_drive": Machine(
        (600.0, 3000.0, 6000.0, 12000.0, 18000.0),
        ((0.0, 0.03, 0.04, 0.0), (0.03, 0.29, 0.05, 0.0), (0.29, 0.32, 0.04, 0.0), (0.32, 0.38, 0.038, 0.0)),
        {"drive": 0.305, "end": 0.015},
        (0.16, 0.16, 0.11, 0.05),
    ),
}


def target(name: str) -> Path:
    """File of the tables of a machine, and of what ROSS finds."""
    return REFERENCES / f"ross_{name}.toml"


def tables(name: str) -> None:
    """Write the tables of the bearings of a machine."""
    from mbs import assemble, read_scene
    from mbs.bearings.locating.locating_element import LocatingElement
    from mbs.model.elements import Operation
    from mbs.model.equilibrium import equilibrium

    model = assemble(read_scene(name), LAW)
    found: dict[str, list[Any]] = {ball.name: [] for ball in model.balls}
    for rpm in MACHINES[name].speeds:
        at = Operation(rpm * RPM)
        rest = equilibrium(model.system, at)
        for entry in model.system.elements:
            element = entry.element
            if isinstance(element, LocatingElement):
                answer = element.evaluate(entry.transform @ rest.displacement, np.zeros(6), at)
                rows = np.ix_((1, 2), (1, 2))
                found[element.name].append((answer.stiffness[rows], answer.damping[rows]))
    lines = [
        f"# Stiffness [N/m] and damping [N s/m] along y and z of the bearings of `{name}`, {LAW}, over speed [rad/s]:",
        "# python -m tests.benchmarks.ross_balls tables; figures by ROSS below: python -m ... figures",
        f"speeds = {[rpm * RPM for rpm in MACHINES[name].speeds]!r}",
    ]
    for bearing, answers in found.items():
        lines += ["", f"[tables.{bearing}]"]
        for key, which in (("stiffness", 0), ("damping", 1)):
            lines.append(f"{key} = {np.round([answer[which] for answer in answers], 6).tolist()!r}")
    target(name).write_text("\n".join([*lines, ""]), encoding="utf-8")


def rotor_of(ross: Any, machine: Machine, given: dict[str, Any]) -> Any:
    """The rotor of a machine in ROSS, and the node of its disc."""
    steel = ross.Material("Steel", rho=7850.0, E=210e9, Poisson=0.3)
    places = [0.0]
    shaft = []
    middle, length, outer, inner = machine.disc
    ends = {end for section in machine.sections for end in section[:2]}
    cuts = sorted({middle, *machine.bearings.values(), *ends})
    for begin, end in pairwise(cuts):
        section = next(s for s in machine.sections if s[0] <= begin and end <= s[1] + 1e-12)
        count = int(np.ceil((end - begin) / LARGEST - 1e-9))
        for _ in range(count):
            shaft.append(ross.ShaftElement((end - begin) / count, section[3], section[2], material=steel))
            places.append(places[-1] + (end - begin) / count)

    def node(place: float) -> int:
        return int(np.argmin(np.abs(np.array(places) - place)))

    mass = 7850.0 * np.pi / 4.0 * (outer**2 - inner**2) * length
    polar = mass * (outer**2 + inner**2) / 8.0
    disc = ross.DiskElement(n=node(middle), m=mass, Ip=polar, Id=0.5 * polar + mass * length**2 / 12.0)
    speeds = np.array(given["speeds"])
    bearings = []
    for name, place in machine.bearings.items():
        k, c = (np.array(given["tables"][name][key]) for key in ("stiffness", "damping"))
        terms = {
            f"{letter}{one}{other}": table[:, i, j]
            for letter, table in (("k", k), ("c", c))
            for i, one in enumerate("xy")
            for j, other in enumerate("xy")
        }
        bearings.append(ross.BearingElement(n=node(place), frequency=speeds, **terms))
    return ross.Rotor(shaft, [disc], bearings), node(middle)


def figures(name: str) -> None:
    """Add what ROSS finds of a machine."""
    import ross  # type: ignore[import-not-found, unused-ignore]

    text = target(name).read_text(encoding="utf-8").partition("\n[ross]")[0]
    given = tomllib.loads(text)
    rotor, disc = rotor_of(ross, MACHINES[name], given)
    lines = ["", "[ross]", f'version = "{ross.__version__}"', "eigenvalues = ["]
    lines += [f"    {parts(eigenvalues(rotor, speed)[:8])}," for speed in given["speeds"]] + ["]"]
    moved = []
    for speed in given["speeds"]:
        rows = across(rotor)
        mass, damping, stiffness = matrices(rotor, speed)
        force = np.zeros(len(rows), dtype=complex)
        force[rows.index(6 * disc)], force[rows.index(6 * disc + 1)] = speed**2, -1j * speed**2
        answer = np.linalg.solve(stiffness + 1j * speed * damping - speed**2 * mass, force)
        moved.append([complex(answer[rows.index(6 * disc + row)]) for row in (0, 1)])
    lines += ["moved = [", *(f"    {parts(row)}," for row in moved), "]", ""]
    target(name).write_text(text.rstrip("\n") + "\n" + "\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    for machine_name in MACHINES:
        {"tables": tables, "figures": figures}[sys.argv[1]](machine_name)
