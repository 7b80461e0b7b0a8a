"""The input deck of CalculiX: one solid of one material with clamped nodes, and one step that finds frequencies."""

from __future__ import annotations

from collections.abc import Iterator

from ehdmaps.arrays import IntArray
from ehdmaps.physics.solids import Material
from examples.housings.mesh import Mesh
from mbs.flexible.solid_mesh import SolidMesh, solid_lines

_PER_LINE = 12
"""CalculiX takes up to 16 entries a line."""


def deck(mesh: Mesh, material: Material, clamped: IntArray, count: int, matrices: bool) -> str:
    """Write the deck, in SI.

    Parameters
    ----------
    mesh : Mesh
        The solid; node n of the deck is row n - 1 of its positions.
    material : Material
        Material of all elements.
    clamped : array of int
        Indices of nodes whose three displacements are held; none for a free solid.
    count : int
        Frequencies to find.
    matrices : bool
        Store stiffness and mass (files .sti, .mas, .dof) in place of finding frequencies. Freedoms that are held are
        not in them.

    Returns
    -------
    str
        Text of the file.
    """
    return "\n".join(_lines(mesh, material, clamped, count, matrices)) + "\n"


def _lines(mesh: Mesh, material: Material, clamped: IntArray, count: int, matrices: bool) -> Iterator[str]:
    """The deck, line by line."""
    yield from solid_lines(SolidMesh(mesh.positions, {"tetra10": mesh.elements}, {}), {"": material})
    if clamped.size:
        yield "*NSET, NSET=CLAMPED"
        numbers = (clamped + 1).tolist()
        for first in range(0, len(numbers), _PER_LINE):
            yield ",".join(map(str, numbers[first : first + _PER_LINE]))
        yield from ("*BOUNDARY", "CLAMPED,1,3")
    yield from ("*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE" if matrices else "*FREQUENCY", str(count), "*END STEP")
