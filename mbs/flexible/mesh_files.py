"""Places of the nodes of a mesh, by their numbers.

The rows of matrices name nodes by number, so numbers count, and need not be 1, 2, 3. They are read by

.inp               here: the flat deck of Abaqus or CalculiX; what moves, makes or renames nodes is refused
.msh               here: Gmsh 2.2 and 4.1, because meshio does not give the numbers away
.bdf .nas .fem     pyNastran, with the coordinate systems of the GRIDs
.med .exo ...      meshio, and the numbers beside it where the file has some
.vtk .vtu ...      meshio: node k is the k-th point; as many as the file says that it has
"""

from __future__ import annotations

import math
import mmap
import re
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError
from ehdmaps.units import short
from mbs.flexible.apart import run_apart
from mbs.flexible.finite_elements import NodePositions
from mbs.flexible.nastran_files import grid_numbers, read_grids
from mbs.flexible.number_table import check_file

DECKS, GMSH, NASTRAN = (".inp",), (".msh",), (".bdf", ".nas", ".fem")

_COUNTED = {
    ".vtk": rb"(?m)^POINTS\s+(\d+)",
    ".vtu": rb'NumberOfPoints\s*=\s*"(\d+)"',
    ".mesh": rb"(?m)^\s*Vertices\s+(\d+)",
    ".su2": rb"(?m)^\s*NPOIN\s*=\s*(\d+)",
    ".vol": rb"(?m)^points\s+(\d+)",
}
"""Where a file says how many points it has, of formats without numbers."""

_NUMBERED = (".med", ".e", ".exo", ".ex2")
"""Formats with numbers, or without, that are read beside meshio."""

_READ = """
import meshio, numpy
path, ending = sys.argv[1:]
points = numpy.asarray(meshio.read(path).points, dtype=float)
numbers = numpy.arange(1, len(points) + 1)
if ending == ".med":
    import h5py
    with h5py.File(path) as file:
        found = []
        file["ENS_MAA"].visititems(lambda name, entry: found.append(entry[:]) if name.endswith("NOE/NUM") else None)
    numbers = numpy.concatenate(found) if found else numbers
elif ending in (".e", ".exo", ".ex2"):
    import netCDF4
    with netCDF4.Dataset(path) as file:
        for name in ("node_num_map", "node_id_map"):
            numbers = file[name][:].data if name in file.variables else numbers
numpy.savez(output, points=points, numbers=numpy.asarray(numbers, dtype=numpy.int64))
"""

_ELSEWHERE = {
    "SYSTEM": "nodes in one system of coordinates",
    "TRANSFORM": "displacements along one system of coordinates",
    "INCLUDE": "a deck with its nodes in it",
    "NGEN": "each node written out",
    "NFILL": "each node written out",
    "NCOPY": "each node written out",
    "NMAP": "nodes where they are written",
}
"""Keywords of a deck that make, move or turn nodes, and what is allowed instead."""


def read_mesh_nodes(path: Path) -> NodePositions:
    """Read the positions of the nodes, in the units of the file.

    Parameters
    ----------
    path : Path
        A mesh of a format at the head of this module.

    Raises
    ------
    InputError
        With the file, and the line of a deck; for other formats, and what would place nodes elsewhere.
    """
    check_file(path)
    ending = path.suffix.lower()
    if ending in DECKS:
        return _deck_nodes(path)
    if ending in GMSH:
        return _gmsh_nodes(path)
    if ending in NASTRAN:
        return read_grids(path)
    if ending not in _COUNTED and ending not in _NUMBERED:
        every = (*DECKS, *GMSH, *NASTRAN, *_NUMBERED, *_COUNTED)
        raise InputError(
            f"{path}: got the ending {path.suffix!r}, of a mesh whose numbers of nodes are not read; allowed: a mesh "
            f"in one file, {', '.join(every)}; convert it"
        )
    return _meshio_nodes(path, ending)


def point_numbers(path: Path, count: int) -> IntArray:
    """Numbers of the points that meshio finds in a mesh, in their order; InputError if there are not as many.

    Parameters
    ----------
    path : Path
        A mesh that meshio reads.
    count : int
        Number of points that it found.
    """
    ending = path.suffix.lower()
    if ending in NASTRAN:
        numbers = grid_numbers(path)
    elif ending in GMSH:
        numbers = _gmsh_nodes(path).numbers
    elif ending in _NUMBERED:
        numbers = _meshio_nodes(path, ending).numbers
    else:
        numbers = np.arange(1, count + 1)
    if numbers.size != count:
        raise InputError(f"{path}: got {count} points of {numbers.size} nodes; allowed: a mesh that meshio reads whole")
    return numbers


def _deck_nodes(path: Path) -> NodePositions:
    """Nodes of a deck."""
    places: dict[int, tuple[float, float, float]] = {}
    parts: set[str] = set()
    block = ""
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            text = line.strip()
            if not text or text.startswith("**"):
                continue
            if text.startswith("*"):
                block, parameters = _keyword(text)
                _check_keyword(path, number, text, parameters, parts)
            elif block == "INSTANCE" and any(part.strip(" .0+-eE") for part in text.split(",")):
                raise _refused(path, number, text, f"a part that is not moved; {_FLAT}")
            elif block == "NODE":
                if not line.endswith("\n"):
                    raise InputError(
                        f"{path}, line {number}: got {short(text)}, which has no end; allowed: a deck that is whole; "
                        "the file was cut off, or add a line break where it was not"
                    )
                node, position = _node(path, number, text)
                if places.setdefault(node, position) != position:
                    raise _refused(path, number, text, f"one place for each node; node {node} has another one; {_FLAT}")
    if not places:
        raise InputError(f"{path}: has no *NODE block; allowed: the deck that has the nodes of the mesh")
    return NodePositions(np.array(list(places), dtype=np.int64), np.array(list(places.values()), dtype=np.float64))


_FLAT = "write the deck without parts and assemblies, as Abaqus writes its matrices"


def _keyword(text: str) -> tuple[str, dict[str, str]]:
    """Keyword of a line of a deck, and its parameters."""
    first, *others = text[1:].upper().split(",")
    pairs = (other.partition("=") for other in others)
    return " ".join(first.split()), {name.strip(): value.strip() for name, _, value in pairs}


def _check_keyword(path: Path, number: int, text: str, parameters: Mapping[str, str], parts: set[str]) -> None:
    """Refuse what would place nodes elsewhere than their lines say; `parts` are those that are used already."""
    keyword, _ = _keyword(text)
    if keyword in _ELSEWHERE:
        raise _refused(path, number, text, _ELSEWHERE[keyword])
    if keyword == "NODE" and parameters.get("SYSTEM", "R") != "R":
        raise _refused(path, number, text, "rectangular coordinates")
    if keyword == "NODE" and "INPUT" in parameters:
        raise _refused(path, number, text, _ELSEWHERE["INCLUDE"])
    if keyword == "INSTANCE":
        part = parameters.get("PART", "")
        if part in parts:
            raise _refused(path, number, text, f"each part once, else two nodes have one number; {_FLAT}")
        parts.add(part)


def _refused(path: Path, number: int, text: str, allowed: str) -> InputError:
    """An error at a line."""
    return InputError(f"{path}, line {number}: got {short(text)}; allowed: {allowed}")


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
        raise _refused(path, number, text, "a node from 1, and x, y, z")
    x, y, z = [*values, 0.0, 0.0][:3]
    return node, (x, y, z)


def _gmsh_nodes(path: Path) -> NodePositions:
    """Nodes of a mesh of Gmsh."""
    content = path.read_bytes()
    head = re.match(
        rb"\s*(?:\$Comments.*?\$EndComments\s*)?\$MeshFormat\s+(\S+)\s+([01])\s+8\s*?\n", content, re.DOTALL
    )
    version = head[1].decode("ascii", "replace") if head else "none"
    if head is None or version not in ("2", "2.2", "4.1"):
        raise InputError(
            f"{path}: is no mesh of Gmsh of a version that is read (got {short(version)}); allowed: 2.2 and 4.1, which "
            "Gmsh saves"
        )
    binary = head[2] == b"1"
    if binary and content[head.end() : head.end() + 4] != b"\1\0\0\0":
        raise InputError(f"{path}: got binary numbers of another order of bytes; allowed: little endian, or text")
    section = re.compile(rb"\$Nodes[ \r]*\n").search(content, head.end())
    try:
        if section is None:
            raise ValueError("no $Nodes")
        values = _Numbers(content, section.end(), binary)
        numbers, positions = _of_version_2(values) if version.startswith("2") else _of_version_4(values)
        if not content[values.at :].lstrip().startswith(b"$EndNodes"):
            raise ValueError("no $EndNodes where it should be")
    except (ValueError, OverflowError) as error:
        raise InputError(
            f"{path}: cannot be read as a mesh of Gmsh ({error}); allowed: one that is whole; was it cut off?"
        ) from error
    return _checked(path, numbers, positions)


class _Numbers:
    """Numbers of a section, one after another: binary, or words of a text."""

    def __init__(self, content: bytes, at: int, binary: bool) -> None:
        self.content, self.at, self.binary = content, at, binary

    def line(self) -> int:
        """A whole number on a line of its own, which is text in binary files too."""
        end = self.content.find(b"\n", self.at) + 1
        text, self.at = self.content[self.at : end], end
        return int(text)

    def take(self, kind: str, count: int) -> FloatArray:
        """The next `count` numbers of a type."""
        if not 0 <= count <= len(self.content) - self.at:
            raise ValueError(f"{count} numbers that the file does not hold")
        if self.binary:
            found = np.frombuffer(self.content, np.dtype(kind), count, self.at)
            self.at += found.nbytes
            return np.asarray(found, dtype=np.float64)
        words = []
        for _ in range(count):
            match = _WORD.match(self.content, self.at)
            if match is None:
                raise ValueError("too few numbers")
            words.append(match[1])
            self.at = match.end()
        return np.array(words, dtype=np.float64)


_WORD = re.compile(rb"\s*([^\s$]+)")


def _of_version_2(values: _Numbers) -> tuple[FloatArray, FloatArray]:
    """Numbers and positions: a line "number x y z" a node."""
    count = values.line()
    if values.binary:
        rows = np.frombuffer(values.content, np.dtype([("n", "<i4"), ("x", "<f8", 3)]), count, values.at)
        values.at += rows.nbytes
        return rows["n"].astype(np.float64), rows["x"].astype(np.float64)
    table = values.take("", 4 * count).reshape(-1, 4)
    return table[:, 0], table[:, 1:]


def _of_version_4(values: _Numbers) -> tuple[FloatArray, FloatArray]:
    """Numbers and positions: in blocks, first all numbers, then all positions."""
    blocks, count = (int(number) for number in values.take("<u8", 4)[:2])
    numbers, positions = [], []
    for _ in range(blocks):
        dimension, _, parametric = (int(number) for number in values.take("<i4", 3))
        here = int(values.take("<u8", 1)[0])
        numbers.append(values.take("<u8", here))
        width = 3 + (dimension if parametric else 0)
        positions.append(values.take("<f8", width * here).reshape(here, width)[:, :3])
    found = np.concatenate([np.zeros(0), *numbers])
    if found.size != count:
        raise ValueError(f"{found.size} nodes and not {count}, as its head says")
    return found, np.concatenate([np.zeros((0, 3)), *positions])


def _meshio_nodes(path: Path, ending: str) -> NodePositions:
    """Points of a mesh that meshio finds; some of its readers never end where a file was cut off."""
    where = [str(path.absolute()), ending]
    content, words = run_apart(_READ, where, path.stat().st_size, "flexible", "meshio", str(path))
    try:
        with np.load(BytesIO(content), allow_pickle=False) as archive:
            points, numbers = np.asarray(archive["points"], dtype=np.float64), np.asarray(archive["numbers"])
    except (OSError, ValueError, EOFError, KeyError) as error:
        raise InputError(
            f"{path}: cannot be read as a mesh ({words:.120}); allowed: a format that meshio reads; was it cut off?"
        ) from error
    if points.ndim != 2 or points.shape[0] == 0 or points.shape[1] not in (2, 3):
        raise InputError(f"{path}: got points of shape {points.shape}; allowed: two or three coordinates a node")
    count = _announced(path, ending)
    if numbers.size != points.shape[0] or count not in (points.shape[0], None):
        raise InputError(
            f"{path}: meshio finds {points.shape[0]} points of {numbers.size if count is None else count} nodes; "
            "allowed: a mesh that it reads whole"
        )
    flat = np.zeros((points.shape[0], 3 - points.shape[1]))
    return _checked(path, numbers.astype(np.float64), np.hstack([points, flat]))


def _announced(path: Path, ending: str) -> int | None:
    """Number of points that a file says that it has; None of a format that says nothing in text."""
    if ending not in _COUNTED or not path.stat().st_size:
        return None
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        return sum(int(match[1]) for match in re.finditer(_COUNTED[ending], content))


def _checked(path: Path, numbers: FloatArray, positions: FloatArray) -> NodePositions:
    """Nodes with numbers that can be, each once, and finite positions."""
    if numbers.size == 0 or np.any(numbers != np.round(numbers)) or np.any(numbers < 1) or np.any(numbers > 1e12):
        raise InputError(f"{path}: got no nodes, or numbers of nodes that are none; allowed: whole numbers from 1")
    if np.unique(numbers).size < numbers.size:
        raise InputError(f"{path}: got a number of a node twice; allowed: each node once")
    if not np.all(np.isfinite(positions)):
        raise InputError(f"{path}: got positions that are no finite numbers; allowed: finite ones")
    return NodePositions(numbers.astype(np.int64), positions)
