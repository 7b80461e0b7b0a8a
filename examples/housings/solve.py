"""CalculiX at work: stiffness and mass of a mesh, and the frequencies that it finds itself."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.solids import Material
from examples.housings.deck import deck
from examples.housings.mesh import Mesh
from mbs.flexible.calculix import read_calculix
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.matrix_files import NodePositions

LONGEST_RUN = 600.0
"""Seconds after which CalculiX is stopped."""

LOG_LINES = 4
"""Last lines of its output that a message quotes."""

_JOB = "housing"
_VERSION = re.compile(r"Version\s+(\S+)")
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
    _run(deck(mesh, material, clamped, 1, matrices=True), folder)
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
    _run(deck(mesh, material, clamped, count, matrices=False), folder)
    path = folder / f"{_JOB}.dat"
    text = path.read_text("utf-8", "replace") if path.is_file() else ""
    rows = [line.split() for line in text.splitlines() if _MODE.fullmatch(line)]
    found = np.array([float(row[3]) for row in rows[:count]])
    if len(found) < count or not np.isfinite(found).all():
        raise AnalysisError(f"CalculiX: {path.name} holds {len(found)} of {count} frequencies; ask for fewer")
    return found


def version() -> str:
    """Version of CalculiX.

    Raises
    ------
    InputError
        If it is missing.
    """
    result = subprocess.run([program(), "-v"], capture_output=True, text=True, check=False, timeout=60.0)
    found = _VERSION.search(result.stdout)
    return found[1] if found else "unknown"


def program() -> str:
    """Path of CalculiX.

    Raises
    ------
    InputError
        If it is missing.
    """
    found = shutil.which("ccx")
    if found is None:
        raise InputError(
            "CalculiX: ccx is not in PATH; making a housing needs it: on Debian apt-get install calculix-ccx"
        )
    return found


def _run(text: str, folder: Path) -> None:
    """Run CalculiX on a deck in a folder."""
    (folder / f"{_JOB}.inp").write_text(text, "ascii")
    log = folder / f"{_JOB}.log"
    command = [program(), "-i", _JOB]
    try:
        with log.open("wb") as output:
            result = subprocess.run(
                command,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                timeout=LONGEST_RUN,
                check=False,
                # Threads pay for larger models only, and change the last digits.
                env={**os.environ, "OMP_NUM_THREADS": "1"},
            )
    except subprocess.TimeoutExpired as error:
        raise AnalysisError(
            f"CalculiX: not done after {LONGEST_RUN:.0f} s; take larger elements; {_tail(log)}"
        ) from error
    except OSError as error:
        raise AnalysisError(f"CalculiX: {command[0]} cannot be started: {error.strerror}") from error
    if result.returncode != 0:
        raise AnalysisError(f"CalculiX: ended with status {result.returncode}; {_tail(log)}")


def _tail(log: Path) -> str:
    """Last lines of the log in one line."""
    lines = [" ".join(line.split()) for line in log.read_text("utf-8", "replace").splitlines() if line.strip()]
    return "last lines of its output: " + (" | ".join(lines[-LOG_LINES:]) or "none")
