"""The skin of a mesh: faces that belong to one element alone, as triangles, for pictures of a body.

Read are solid elements and shells of decks (Abaqus, CalculiX) and of what meshio reads. Of elements of second order
the corners are taken. Faces of shells that lie on solids are left out: a mesh program often writes both.
"""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError
from ehdmaps.inputs import check_input
from mbs.flexible.apart import run_apart
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.mesh_files import point_numbers
from mbs.flexible.number_table import LONGEST_FILE
from mbs.model.body import Skin

MOST_NODES = 20_000
"""Of a skin: more take hundreds of megabytes by the coordinates of a body, and a picture shows no more."""

_FACES: dict[str, tuple[tuple[int, ...], ...]] = {
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
}
"""Corners of the faces of solid elements, seen from outside."""

_SHELLS = {"triangle": (0, 1, 2), "quad": (0, 1, 2, 3)}
_CORNERS = {"tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8, "triangle": 3, "quad": 4}

_SOLID_TYPES = {4: "tetra", 5: "pyramid", 6: "wedge", 8: "hexahedron", 10: "tetra", 13: "pyramid", 15: "wedge",
                20: "hexahedron", 27: "hexahedron"}  # fmt: skip
_SHELL_TYPES = {3: "triangle", 4: "quad", 6: "triangle", 8: "quad"}
"""Kind of an element by its number of nodes."""

_READ = f"""
import meshio, numpy
mesh = meshio.read(sys.argv[1])
found = dict(count=len(mesh.points))
for kind, corners in {list(_CORNERS.items())!r}:
    blocks = [b.data[:, :corners] for b in mesh.cells if b.type.rstrip("0123456789") == kind]
    found[kind] = numpy.concatenate([numpy.zeros((0, corners), dtype=int), *blocks])
numpy.savez(output, **found)
"""


def skin_triangles(elements: Mapping[str, IntArray]) -> IntArray:
    """Triangles of the skin of some elements, shape (t, 3).

    Parameters
    ----------
    elements : mapping of str to array of int, shape (e, corners)
        Node numbers of the corners by kind of element: tetra, pyramid, wedge, hexahedron, triangle, quad.

    Examples
    --------
    Two tetrahedra that share a face have six faces outside:

    >>> skin_triangles({"tetra": np.array([[1, 2, 3, 4], [2, 3, 4, 5]])}).shape
    (6, 3)
    """
    faces = [
        _four(elements[kind][:, list(face)]) for kind, of_kind in _FACES.items() if kind in elements for face in of_kind
    ]
    solid = np.concatenate([np.zeros((0, 4), dtype=np.int64), *faces])
    # A triangle has its last corner twice; sorted, it must not depend on which corner that is.
    last = np.where(solid[:, 3] == solid[:, 2], -1, solid[:, 3])
    corners = np.sort(np.column_stack((solid[:, :3], last)), axis=1)
    _, first, count = np.unique(corners, axis=0, return_index=True, return_counts=True)
    outside = solid[np.sort(first[count == 1])]
    nodes = np.unique(solid)
    shells = [_four(elements[kind][:, list(corners)]) for kind, corners in _SHELLS.items() if kind in elements]
    alone = [part[~np.isin(part, nodes).all(axis=1)] for part in shells]
    every = np.concatenate([outside, *alone])
    halves = np.concatenate([every[:, [0, 1, 2]], every[:, [0, 2, 3]]])
    return np.asarray(halves[(halves[:, 1] != halves[:, 2]) & (halves[:, 0] != halves[:, 2])])


def _four(face: IntArray) -> IntArray:
    """Faces with four corners: a triangle has its last one twice."""
    return face if face.shape[1] == 4 else face[:, [0, 1, 2, 2]]


def read_skin(path: Path) -> IntArray:
    """Read the skin of a mesh as triangles of node numbers, shape (t, 3); none where its elements have no faces.

    Parameters
    ----------
    path : Path
        A deck (.inp), or another mesh of which `mbs.flexible.mesh_files` knows the numbers of the nodes.

    Raises
    ------
    InputError
        For an element of a deck that is not written as its type says, with file and line.
    """
    check_input(path, LONGEST_FILE, "a mesh", "take a coarser mesh")
    return skin_triangles(_of_deck(path) if path.suffix.lower() == ".inp" else _of_meshio(path))


def _of_deck(path: Path) -> dict[str, IntArray]:
    """Corners of the elements of a deck, by kind."""
    found: dict[str, list[list[int]]] = {}
    kind, count, row = "", 0, list[int]()
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            text = line.strip()
            if not text or text.startswith("**"):
                continue
            if text.startswith("*"):
                kind, count = _kind(text)
                row = []
            elif kind:
                row += _numbers(path, number, text)
                if len(row) > count:
                    found.setdefault(kind, []).append(row[1 : 1 + _CORNERS[kind]])
                    row = []
    return {name: np.array(rows, dtype=np.int64) for name, rows in found.items()}


def _kind(keyword: str) -> tuple[str, int]:
    """Kind and number of nodes of the elements below a line of a deck; no kind where they have no faces."""
    words = [word.strip().upper() for word in keyword[1:].split(",")]
    named = [word.partition("=")[2].strip() for word in words[1:] if word.startswith("TYPE")]
    if words[0] != "ELEMENT" or not named:
        return "", 0
    for begin, kinds in (("C3D", _SOLID_TYPES), ("S", _SHELL_TYPES)):
        digits = named[0].removeprefix(begin)
        count = "".join(letter for letter in digits.rstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ") if letter.isdigit())
        if named[0].startswith(begin) and digits[:1].isdigit() and int(count[:3]) in kinds:
            return kinds[int(count[:3])], int(count[:3])
    return "", 0


def _numbers(path: Path, number: int, text: str) -> list[int]:
    """Numbers of a line of elements."""
    try:
        return [int(part) for part in text.split(",") if part.strip()]
    except ValueError as error:
        raise InputError(
            f"{path}, line {number}: got {text[:60]!r}; allowed: numbers of an element and of its nodes"
        ) from error


def _of_meshio(path: Path) -> dict[str, IntArray]:
    """Corners of the elements that meshio finds; none where it fails: what lacks are pictures."""
    try:
        content, _ = run_apart(_READ, [str(path.absolute())], path.stat().st_size, "flexible", "meshio", str(path))
        with np.load(BytesIO(content), allow_pickle=False) as found:
            numbers = point_numbers(path, int(found["count"]))
            return {kind: numbers[found[kind]] for kind in _CORNERS}
    except (InputError, OSError, ValueError, EOFError, KeyError, IndexError):
        return {}


def skin_of(model: FiniteElementModel, triangles: IntArray, motion: FloatArray) -> Skin | None:
    """The skin of a reduced body; None where it has none, or one of more than `MOST_NODES` nodes.

    Parameters
    ----------
    model : FiniteElementModel
        The body.
    triangles : array of int, shape (t, 3)
        Node numbers; those of nodes without a position are left out.
    motion : array, shape (N, n)
        Motion of its degrees of freedom by the coordinates of the reduced body. Nodes that are not among them are
        fixed, and stay where they are.
    """
    known = triangles[np.isin(triangles, model.numbers).all(axis=1)]
    used, corners = np.unique(known, return_inverse=True)
    if not 0 < used.size <= MOST_NODES:
        return None
    rows = np.array(
        [[-1 if (row := model.row(node, axis)) is None else row for axis in range(3)] for node in used.tolist()]
    )
    transforms = np.where((rows >= 0)[:, :, np.newaxis], motion[rows], 0.0)
    places = np.array([model.position(node) for node in used.tolist()])
    return Skin(places, transforms, corners.reshape(-1, 3).astype(np.int64))
