"""Reduced housings of tetrahedra of second order beside CalculiX' own modes: mass, rigid-body modes, ten frequencies.

`python -m tests.benchmarks.housing_sizes --size 10.5` meshes the box of a gearbox with elements of 10.5 mm (14 000),
`--size 4` with 207 000, reduces it by `mbs reduce` with four seats and four feet, lets it go free, and has CalculiX
find 16 modes of the free body itself (of the large one for an hour or more, by SPOOLES; `--without` leaves it out).
Feet are rigid: they stiffen the pads, which shows in the frequencies; `--averaging` makes them follow as seats do.
"""

from __future__ import annotations

import argparse
import re
import tempfile
import time
from pathlib import Path

import gmsh
import numpy as np

import mbs.cli
from ehdmaps.physics.solids import MATERIALS
from ehdmaps.solids.calculix import run_deck
from mbs.flexible.reduced_file import read_reduced
from mbs.flexible.solid_mesh import read_solid, solid_lines

LENGTH, WIDTH, HEIGHT, WALL = 160.0, 260.0, 180.0, 14.0
"""Of the box [mm]."""

BORES = {"b1": (0.0, 72.0), "b2": (99.0, 90.0)}
"""Distance along y and diameter of the bores in both walls [mm]."""

MATERIAL = "cast iron"
LONGEST = 4.0 * 3600.0
"""Seconds that CalculiX has."""


def mesh(path: Path, size: float) -> None:
    """Mesh the box with elements of a size [mm]."""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        occ = gmsh.model.occ
        outer = occ.addBox(-LENGTH / 2, -80, -90, LENGTH, WIDTH, HEIGHT)
        inside = (LENGTH - 2 * WALL, WIDTH - 2 * WALL, HEIGHT - 2 * WALL)
        inner = occ.addBox(-LENGTH / 2 + WALL, -80 + WALL, -90 + WALL, *inside)
        body, _ = occ.cut([(3, outer)], [(3, inner)])
        corners = [(x, y) for x in (-LENGTH / 2, LENGTH / 2 - 40) for y in (-110, WIDTH - 90)]
        body, _ = occ.fuse(body, [(3, occ.addBox(x, y, -90, 40, 40, WALL)) for x, y in corners])
        for y, diameter in BORES.values():
            body, _ = occ.cut(body, [(3, occ.addCylinder(-LENGTH, y, 0, 2 * LENGTH, 0, 0, diameter / 2))])
        occ.synchronize()
        for name, value in (("MeshSizeMax", size), ("MeshSizeMin", min(size, 6.0)), ("ElementOrder", 2)):
            gmsh.option.setNumber(f"Mesh.{name}", value)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 12)
        gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], 1)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


def words(path: Path, target: Path, cutoff: str, averaging: bool) -> list[str]:
    """The command that reduces it."""
    found = ["reduce", str(path), "--units", "mm", "--material", MATERIAL, "--cutoff", cutoff, "-o", str(target)]
    for name, (y, diameter) in BORES.items():
        for end, x in (("l", -73), ("r", 73)):
            found += ["--seat", f"{name}{end} = {x} {y:g} 0 mm, {diameter:g} mm x 14 mm, x"]
    if not averaging:
        for k, (x, y) in enumerate(((-60, -90), (60, -90), (-60, 190), (60, 190)), 1):
            found += ["--foot", f"f{k} = {x} {y} -90 mm, 36 mm, z"]
    return found


def own(path: Path, folder: Path) -> tuple[list[float], float]:
    """Frequencies [Hz] of the free body and its mass [kg] by CalculiX alone."""
    step = ("*STEP", "*FREQUENCY", "16", "*END STEP")
    lines = (*solid_lines(read_solid(path, 1e-3), {"": MATERIALS[MATERIAL]}), *step)
    run_deck("\n".join(lines) + "\n", folder, "own", "the benchmark", LONGEST)
    text = (folder / "own.dat").read_text()
    rows = [line.split() for line in text.splitlines()]
    frequencies = [float(row[3]) for row in rows if len(row) == 5 and re.fullmatch(r"\d+", row[0])]
    effective = text[text.index("E F F E C T I V E") :]
    return frequencies[:16], float(re.search(r"TOTAL\s+(\S+)", effective)[1])


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=float, default=10.5, help="of the elements, mm")
    parser.add_argument("--cutoff", default="10 kHz", help="of the modes that are kept")
    parser.add_argument("--averaging", action="store_true", help="leave the rigid feet out")
    parser.add_argument("--without", action="store_true", help="leave CalculiX' own modes out")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path, target = folder / "housing.msh", folder / "housing.nc"
        mesh(path, given.size)
        began = time.perf_counter(), time.process_time()
        if mbs.cli.main(words(path, target, given.cutoff, given.averaging)):
            raise SystemExit("mbs reduce failed")
        wall, own_time = time.perf_counter() - began[0], time.process_time() - began[1]
        print(f"reduced in {wall:.0f} s, {own_time:.0f} s of processor time beside CalculiX")
        body = read_reduced(target)
        squares = np.sort(np.linalg.eigvals(np.linalg.solve(body.mass, body.stiffness)).real)
        found = np.sqrt(np.abs(squares[:16])) / (2.0 * np.pi)
        print(f"rigid-body modes below {found[:6].max():.2g} Hz")
        alone, mass = ([np.nan] * 16, np.nan) if given.without else own(path, folder)
        print(f"mass by CalculiX {mass:.6g} kg\n{'mode':>4} {'reduced, Hz':>12} {'CalculiX, Hz':>13} {'apart':>9}")
        for k in range(6, 16):
            print(f"{k + 1:4d} {found[k]:12.2f} {alone[k]:13.2f} {100.0 * (found[k] / alone[k] - 1.0):+8.3f} %")


if __name__ == "__main__":
    main()
