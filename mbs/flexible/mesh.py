"""Where the nodes of a mesh are, by their numbers.

Abaqus and CalculiX decks are read here, because node numbers matter and need not count on; all other formats by meshio,
where node k is the k-th point of the file.
"""

from __future__ import annotations

import contextlib
import io
import math
from pathlib import Path

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.units import short
from mbs.flexible.matrix_files import NodePositions
from mbs.flexible.number_table import check_file

DECKS = (".inp",)

_SEVERAL = (".xdmf", ".xmf", ".xml", ".node", ".ele")
"""Formats of meshio that open further files, whatever those are."""

_PACKED = (".gz",)


def read_mesh_nodes(path: Path) -> NodePositions:
    """Read the positions of the nodes, in the units of the file.

    Parameters
    ----------
    path : Path
        .inp: all *NODE blocks; anything else that meshio reads: .msh, .vtk, .vtu, .bdf ...

    Raises
    ------
    InputError
        With the file, and the line of a deck.
    """
    check_file(path)
    if path.suffix.lower() in (*_SEVERAL, *_PACKED):
        raise InputError(
            f"{path}: got the ending {path.suffix!r}, of a mesh in several files or a packed one; allowed: a mesh in "
            "one file, such as .inp, .msh, .vtk, .vtu, .bdf; convert it"
        )
    return _deck_nodes(path) if path.suffix.lower() in DECKS else _meshio_nodes(path)


def _deck_nodes(path: Path) -> NodePositions:
    """Nodes of a deck."""
    found: dict[int, tuple[float, float, float]] = {}
    inside = False
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            text = line.strip()
            if not text or text.startswith("**"):
                continue
            if text.startswith("*"):
                keyword = text[1:].partition(",")[0].strip().upper()
                if keyword == "INCLUDE":
                    raise InputError(f"{path}, line {number}: got {short(text)}; allowed: a deck with its nodes in it")
                inside = keyword == "NODE"
                if inside and "SYSTEM" in text.upper().replace("SYSTEM=R", ""):
                    raise InputError(f"{path}, line {number}: got {short(text)}; allowed: rectangular coordinates")
                continue
            if inside:
                if not line.endswith("\n"):
                    raise InputError(
                        f"{path}, line {number}: got {short(text)}, which has no end; allowed: a deck that is whole; "
                        "the file was cut off, or add a line break where it was not"
                    )
                node, position = _node(path, number, text)
                found[node] = position
    if not found:
        raise InputError(f"{path}: has no *NODE block; allowed: the deck that has the nodes of the mesh")
    return NodePositions(np.array(list(found), dtype=np.int64), np.array(list(found.values()), dtype=np.float64))


def _node(path: Path, number: int, text: str) -> tuple[int, tuple[float, float, float]]:
    """One line of a *NODE block."""
    parts = [part.strip() for part in text.rstrip(",").split(",")]
    try:
        node = int(parts[0])
        values = [float(part) if part else 0.0 for part in parts[1:4]]
    except ValueError:
        node, values = 0, []
    # A coordinate that is left out is zero.
    if not (1 <= node <= 10**12 and 1 <= len(values) <= 3 and all(math.isfinite(value) for value in values)):
        raise InputError(f"{path}, line {number}: got {short(text)}; allowed: a node from 1, and x, y, z")
    x, y, z = [*values, 0.0, 0.0][:3]
    return node, (x, y, z)


def _meshio_nodes(path: Path) -> NodePositions:
    """Points of a mesh that meshio reads."""
    import meshio

    said = io.StringIO()
    try:
        # meshio prints what went wrong, and leaves the program.
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            points = np.asarray(meshio.read(path).points, dtype=np.float64)
    except (Exception, SystemExit) as error:
        words = " ".join(f"{said.getvalue()} {error}".split())
        raise InputError(
            f"{path}: cannot be read as a mesh ({words:.120}); allowed: a format that meshio reads"
        ) from error
    if points.ndim != 2 or points.shape[0] == 0 or points.shape[1] not in (2, 3) or not np.all(np.isfinite(points)):
        raise InputError(
            f"{path}: got points of shape {points.shape}; allowed: finite positions in two or three dimensions"
        )
    flat = np.zeros((points.shape[0], 3 - points.shape[1]))
    return NodePositions(np.arange(1, points.shape[0] + 1), np.hstack([points, flat]))
