"""Where the nodes of a mesh are, by their numbers.

Abaqus and CalculiX decks are read here, because node numbers matter and need not be consecutive; all other formats by
meshio, where node k is the k-th point of the file.
"""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.extras import needs
from ehdmaps.units import short
from mbs.flexible.matrix_files import NodePositions
from mbs.flexible.number_table import check_file

DECKS = (".inp",)

_SEVERAL = (".xdmf", ".xmf", ".xml", ".node", ".ele")
"""Formats of meshio that open further files, whatever those are."""

_PACKED = (".gz",)

SHORTEST_READ, BYTES_PER_SECOND = 20.0, 1e6
"""Seconds that meshio has, and what it reads in one more; it takes half a second to start, and 10 MB a second."""

_NO_PACKAGE = 3
"""Exit status of the process that reads, where meshio or a package that it needs is not installed."""

# meshio prints what went wrong, and leaves the program.
_READ = f"""
import os, sys
found = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)
try:
    import meshio, numpy
    numpy.save(found, numpy.asarray(meshio.read(sys.argv[1]).points, dtype=float))
except ImportError as error:
    sys.stderr.write(str(error))
    sys.exit({_NO_PACKAGE})
except (Exception, SystemExit) as error:
    sys.stderr.write(f" {{error}}")
"""


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
    points = _meshio_points(path)
    if points.ndim != 2 or points.shape[0] == 0 or points.shape[1] not in (2, 3) or not np.all(np.isfinite(points)):
        raise InputError(
            f"{path}: got points of shape {points.shape}; allowed: finite positions in two or three dimensions"
        )
    flat = np.zeros((points.shape[0], 3 - points.shape[1]))
    return NodePositions(np.arange(1, points.shape[0] + 1), np.hstack([points, flat]))


def _meshio_points(path: Path) -> FloatArray:
    """What meshio finds, in a process of its own: some of its readers never end where a file was cut off."""
    seconds = SHORTEST_READ + path.stat().st_size / BYTES_PER_SECOND
    with tempfile.TemporaryFile() as found:
        try:
            done = subprocess.run(
                # -P: nothing is imported from the folder in which we are.
                [sys.executable, "-P", "-c", _READ, str(path.absolute())],
                stdin=subprocess.DEVNULL,
                stdout=found,
                stderr=subprocess.PIPE,
                timeout=seconds,
                check=False,
            )
            words = " ".join(done.stderr.decode("utf-8", "replace").split())
            if done.returncode == _NO_PACKAGE:
                with needs("flexible", "meshio", f"{path}: reading this format"):
                    raise ImportError(f"{words:.120}")
        except subprocess.TimeoutExpired:
            words = f"it did not end within {seconds:.3g} s"
        found.seek(0)
        try:
            return np.asarray(np.load(found, allow_pickle=False), dtype=np.float64)
        except (OSError, ValueError, EOFError) as error:
            raise InputError(
                f"{path}: cannot be read as a mesh ({words:.120}); allowed: a format that meshio reads; was it cut off?"
            ) from error
