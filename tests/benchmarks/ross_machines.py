"""Five machines with little damping by ROSS: their files in `tests/data/ross`, and its figures in `ross_machines.toml`.

Run: python -m tests.benchmarks.ross_machines, in an environment of its own: Python 3.11 with
`pip install ross-rotordynamics==2.3.0 "plotly<6"`. Nothing of this project is imported.

Matrices are those of ROSS at each speed. Its rotors move along and about their axis, too; these motions, which nothing
bends, are left out before eigenvalues are found.
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.linalg import eigvals
from scipy.optimize import brentq

TESTS = Path(__file__).parents[1]
RPM = math.pi / 30.0
TURNING = 1.0
"""Least angular frequency of what counts as a mode [rad/s]."""

UNBALANCE = 1e-4
"""Mass times radius [kg m]."""

AROUND = (-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0)
"""Speeds of responses about a critical one, in damping ratios of it: the peak and its width."""


def machines(ross: Any) -> dict[str, tuple[Any, tuple[float, ...], int, float, float]]:
    """Rotors by name, with speeds of modes [rpm], node of the unbalance, range of critical speeds [rpm] from and to."""
    steel = ross.Material("Steel", rho=7810.0, E=211e9, G_s=81.2e9)

    def shaft(diameters: list[tuple[float, float]], length: float) -> list[Any]:
        return [ross.ShaftElement(length, 0.0, first, 0.0, last, material=steel) for first, last in diameters]

    def cone(first: float, last: float, length: float, count: int) -> list[Any]:
        # ROSS's cones have the shapes of cylinders: some elements make the difference small.
        ends = np.linspace(first, last, count + 1).tolist()
        return shaft(list(pairwise(ends)), length / count)

    speeds = np.linspace(100.0, 1300.0, 7)
    cross = 5e2 * speeds
    seal = ross.Rotor(
        cone(0.05, 0.06, 0.15, 6) + shaft([(0.06, 0.06)] * 4, 0.15) + cone(0.06, 0.05, 0.15, 6),
        [ross.DiskElement(n=8, m=25.0, Id=0.12, Ip=0.22)],
        [
            *(ross.BearingElement(n=n, kxx=4e7, cxx=1.5e3) for n in (0, 16)),
            ross.SealElement(n=8, kxx=0.0 * speeds, cxx=0.0 * speeds + 800.0, kxy=cross, kyx=-cross, frequency=speeds),
        ],
    )
    mounts = ross.Rotor(
        shaft([(0.04, 0.04)] * 8, 0.1),
        [ross.DiskElement(n=3, m=15.0, Id=0.05, Ip=0.09)],
        [
            *(ross.BearingElement(n=n, n_link=link, kxx=8e7, cxx=4e2) for n, link in ((0, 9), (8, 10))),
            *(ross.BearingElement(n=n, kxx=6e6, kyy=9e6, cxx=0.0) for n in (9, 10)),
        ],
        point_mass_elements=[ross.PointMass(n=n, m=12.0) for n in (9, 10)],
    )
    fan = ross.Rotor(
        shaft([(0.06, 0.06)] * 4, 0.08) + cone(0.06, 0.045, 0.24, 12),
        [ross.DiskElement(n=16, m=14.0, Id=0.09, Ip=0.17), ross.DiskElement(n=2, m=2.0, Id=0.0, Ip=0.0)],
        [ross.BearingElement(n=n, kxx=5e7, kyy=3e7, cxx=2e2) for n in (0, 4)],
    )
    return {
        "rotor": (ross.rotor_example(), (0.0, 3000.0, 9000.0), 2, 300.0, 6000.0),
        "compressor": (ross.compressor_example(), (4500.0, 8000.0, 10500.0), 26, 9000.0, 10900.0),
        "seal": (seal, (1500.0, 4000.0, 9000.0), 8, 1000.0, 9000.0),
        "mounts": (mounts, (0.0, 3000.0, 8000.0), 3, 500.0, 9000.0),
        "fan": (fan, (0.0, 3000.0, 9000.0), 16, 500.0, 9000.0),
    }


def across(rotor: Any) -> list[int]:
    """Rows that bend: x, y and tilts of the nodes of the shaft, x and y of supports."""
    nodes = rotor.elements and rotor.shaft_elements[-1].n + 2
    bending = [6 * node + row for node in range(nodes) for row in (0, 1, 3, 4)]
    return bending + [row for first in range(6 * nodes, rotor.ndof, 3) for row in (first, first + 1)]


def matrices(rotor: Any, speed: float) -> tuple[Any, Any, Any]:
    """M, C with gyroscopic terms, K at a speed [rad/s]."""
    rows = np.ix_(across(rotor), across(rotor))
    return rotor.M(speed)[rows], (rotor.C(speed) + speed * rotor.G())[rows], rotor.K(speed)[rows]


def eigenvalues(rotor: Any, speed: float) -> Any:
    """Those that oscillate, by their frequency [1/s]."""
    mass, damping, stiffness = matrices(rotor, speed)
    zero, one = np.zeros_like(mass), np.eye(len(mass))
    values = eigvals(np.block([[zero, one], [-np.linalg.solve(mass, np.hstack([stiffness, damping]))]]))
    values = values[values.imag > TURNING]
    return values[np.argsort(values.imag)]


def critical(rotor: Any, low: float, high: float) -> list[complex]:
    """Eigenvalues at the speeds that are their frequencies [1/s]."""
    grid = np.linspace(low, high, 12)
    below = [int(np.sum(eigenvalues(rotor, speed).imag < speed)) for speed in grid]
    found = []
    for begin, end, first, last in zip(grid, grid[1:], below, below[1:], strict=False):
        for mode in range(first, last):
            speed = brentq(lambda s, m=mode: eigenvalues(rotor, s)[m].imag - s, begin, end, rtol=1e-10)
            found.append(complex(eigenvalues(rotor, speed)[mode]))
    return found


def response(rotor: Any, node: int, speed: float) -> list[complex]:
    """Amplitudes along x and y at the unbalance, ahead of its angle by nothing [m]."""
    rows = across(rotor)
    mass, damping, stiffness = matrices(rotor, speed)
    force = np.zeros(len(rows), dtype=complex)
    force[rows.index(6 * node)], force[rows.index(6 * node + 1)] = UNBALANCE * speed**2, -1j * UNBALANCE * speed**2
    moved = np.linalg.solve(stiffness + 1j * speed * damping - speed**2 * mass, force)
    return [complex(moved[rows.index(6 * node + row)]) for row in (0, 1)]


def limit(rotor: Any, low: float, high: float) -> float | None:
    """Speed at which a mode begins to grow [rad/s]."""

    def growth(speed: float) -> float:
        return float(np.max(eigenvalues(rotor, speed).real))

    return brentq(growth, low, high, rtol=1e-10) if growth(low) < 0.0 < growth(high) else None


def parts(values: Any) -> str:
    """Complex numbers as pairs."""
    return "[" + ", ".join(f"[{value.real!r}, {value.imag!r}]" for value in map(complex, values)) + "]"


def figures(
    ross: Any, name: str, rotor: Any, speeds: tuple[float, ...], node: int, low: float, high: float
) -> list[str]:
    """Lines of a machine in the file of figures."""
    lines = [f"[{name}]", f"node = {node}", f"place = {float(rotor.nodes_pos[node])!r}"]
    lines += [f"speeds = {[speed * RPM for speed in speeds]!r}", "eigenvalues = ["]
    lines += [f"    {parts(eigenvalues(rotor, speed * RPM)[:10])}," for speed in speeds] + ["]"]
    found = critical(rotor, low * RPM, high * RPM)
    lines += [f"from = {low * RPM!r}", f"to = {high * RPM!r}", f"critical = {parts(found)}"]
    damped = next((value for value in found if -value.real > 1e-5 * abs(value)), None)
    if damped is not None and name != "compressor":
        ratio = -damped.real / abs(damped)
        about = [damped.imag * (1.0 + part * ratio) for part in AROUND]
        moved = [response(rotor, node, speed) for speed in about]
        lines += [f"about = {about!r}", "moved = [", *(f"    {parts(row)}," for row in moved), "]"]
    if name == "seal":
        lines.append(f"limit = {limit(rotor, 200.0, 1300.0)!r}")
    if name == "compressor":
        stiff = {beam.n: beam for beam in rotor.shaft_elements if beam.material.E > 1e9}
        for beam in rotor.shaft_elements:
            beam.phi = stiff[beam.n].phi
        other = ross.Rotor(rotor.shaft_elements, rotor.disk_elements, rotor.bearing_elements)
        lines += ["# With the shear of the shaft given to its layers.", "shared = ["]
        lines += [f"    {parts(eigenvalues(other, speed * RPM)[:10])}," for speed in speeds] + ["]"]
    return lines


def main() -> None:
    """Write files and figures."""
    import ross  # type: ignore[import-not-found, unused-ignore]

    folder = TESTS / "data" / "ross"
    folder.mkdir(exist_ok=True)
    lines = [
        "# Figures by ROSS of the rotors in tests/data/ross: python -m tests.benchmarks.ross_machines",
        "# Eigenvalues as pairs of real and imaginary part [1/s], by their frequency; speeds in rad/s; responses in m.",
        f'ross_version = "{ross.__version__}"',
        f"unbalance = {UNBALANCE}",
    ]
    for name, (rotor, *of) in machines(ross).items():
        rotor.save(folder / f"{name}.toml")
        lines += ["", *figures(ross, name, rotor, *of)]
    target = TESTS / "references" / "ross_machines.toml"
    target.write_text("\n".join([*lines, ""]), encoding="utf-8")
    print(f"{target}: written")


if __name__ == "__main__":
    main()
