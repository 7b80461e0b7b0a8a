"""CalculiX at work: stiffness and mass of a mesh, and the frequencies that it finds itself."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError
from ehdmaps.physics.solids import Material
from ehdmaps.solids.calculix import run_deck
from examples.housings.deck import deck
from examples.housings.mesh import Mesh
from mbs.flexible.finite_elements import FiniteElementModel, NodePositions
from mbs.flexible.matrix_files import read_calculix

PURPOSE = "making a housing"
"""What needs CalculiX, for messages."""

_JOB = "housing"
_MODE = re.compile(r"\s*\d+(?:\s+[-+]?\d\.\d+E[-+]\d+){4}\s*")


def matrices(mesh: Mesh, material: Material, clamped: IntArray, folder: Path) -> FiniteElementModel:
    """Have CalculiX assemble stiffness and mass.

    Parameters
    ----------
    mesh : Mesh
        The solid; node n of the model is row n - 1 of its positions.
    material : Material
        Material of the mesh.
    clamped : array of int
        Indices of nodes that are held; their freedoms are not in the matrices.
    folder : Path
        Empty, for its files; 100 MB for 50 000 coordinates.

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If it fails.
    """
    run_deck(deck(mesh, material, clamped, 1, matrices=True), folder, _JOB, PURPOSE)
    stiffness, mass, dofs = (folder / f"{_JOB}.{ending}" for ending in ("sti", "mas", "dof"))
    numbers = np.arange(1, len(mesh.positions) + 1)
    return read_calculix(stiffness, mass, dofs, NodePositions(numbers, mesh.positions))


def own_frequencies(mesh: Mesh, material: Material, clamped: IntArray, count: int, folder: Path) -> FloatArray:
    """Lowest frequencies of a clamped solid as CalculiX' own eigenvalue solver finds them, shape (count,) [Hz].

    Parameters
    ----------
    mesh, material, clamped
        The same as for `matrices`.
    count : int
        Frequencies to find.
    folder : Path
        Empty, for the files of CalculiX.

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If it fails.
    """
    run_deck(deck(mesh, material, clamped, count, matrices=False), folder, _JOB, PURPOSE)
    path = folder / f"{_JOB}.dat"
    text = path.read_text("utf-8", "replace") if path.is_file() else ""
    rows = [line.split() for line in text.splitlines() if _MODE.fullmatch(line)]
    found = np.array([float(row[3]) for row in rows[:count]])
    if len(found) < count or not np.isfinite(found).all():
        raise AnalysisError(f"CalculiX: {path.name} holds {len(found)} of {count} frequencies; ask for fewer")
    return found
