"""Mesh and fields of a film of a line or a point, read by numpy from ascii files of a case; written as VTU or XDMF."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import SolverError
from ehdmaps.extras import needs
from ehdmaps.openfoam.dictionary import camel
from ehdmaps.openfoam.pyfoam import parse
from ehdmaps.outputs import FIELDS, MARK, written_aside

TIME = "1"
"""Name of the folder with the solution."""

_ASCII = re.compile(rb"format\s+ascii\s*;")
_LIST = re.compile(rb"\}.*?\s(\d+)\s*\(", re.DOTALL)
_INTERNAL = re.compile(rb"internalField\s+(?:(uniform)\s+(\([^)]*\)|[^;\s]+)|nonuniform\s+List<\w+>\s*(\d+)\s*\()")
_BRACKETS = bytes.maketrans(b"()", b"  ")


@dataclass(frozen=True)
class FilmFields:
    """The film between both surfaces: a mesh with a value of each field a cell.

    Attributes
    ----------
    points : ndarray, shape (points, 3)
        Places from the contact centre [m]. Of a line contact x along, y across the film, z = 0; of the half of a point
        contact x along, y >= 0 beside, z across the film.
    corners : ndarray, shape (cells, 4) or (cells, 8)
        Indices of the points at the corners of its quadrangles, or hexahedra.
    p : ndarray, shape (cells,)
        Pressure [Pa].
    U : ndarray, shape (cells, 3)
        Velocity [m/s].
    mu : ndarray, shape (cells,)
        Viscosity [Pa s].
    rho : ndarray, shape (cells,)
        Density [kg/m3].
    liquid_fraction : ndarray, shape (cells,)
        1 where there is oil only.
    T : ndarray, shape (cells,), optional
        Temperature [K]; None of an isothermal film.
    """

    points: FloatArray
    corners: IntArray
    p: FloatArray
    U: FloatArray
    mu: FloatArray
    rho: FloatArray
    liquid_fraction: FloatArray
    T: FloatArray | None = None

    @property
    def block(self) -> tuple[str, IntArray]:
        """Shape of the cells and their corners."""
        return "quad" if self.corners.shape[1] == 4 else "hexahedron", self.corners

    def profile(self, values: FloatArray, x: float, rows: int) -> tuple[FloatArray, FloatArray]:
        """Values of a line contact in the column of cells nearest to a place.

        Parameters
        ----------
        values : ndarray, shape (cells,)
            Values in the cells.
        x : float
            Distance from the contact centre [m].
        rows : int
            Cells across the film.

        Returns
        -------
        height : ndarray, shape (rows,)
            y/h of the cell centres, rising from the lower surface.
        values : ndarray, shape (rows,)
            Values there.
        """
        corners = self.points[self.corners]
        centres = corners.mean(axis=1)
        nearest = np.argsort(np.abs(centres[:, 0] - x), kind="stable")[0]
        column = np.argsort(np.abs(centres[:, 0] - centres[nearest, 0]), kind="stable")[:rows]
        column = column[np.argsort(centres[column, 1])]
        heights = np.sort(corners[column, :, 1], axis=1)
        low, high = heights[0, :2].mean(), heights[-1, 2:].mean()
        return (centres[column, 1] - low) / (high - low), values[column]


def read_point_fields(case: Path, columns: int, lines: int, rows: int) -> FilmFields:
    """Read the fields of a point contact that has run with `writeFields true`.

    Parameters
    ----------
    case : Path
        The case folder.
    columns, lines, rows : int
        Cells along the motion, beside it, and across the film.

    Raises
    ------
    SolverError
        If a file is missing, not ascii, or has other than the expected numbers.
    """
    points = _list(case / "constant" / "polyMesh" / "points", 3)
    shape = (lines + 1, columns + 1, rows + 1)
    if points.shape[0] != math.prod(shape):
        raise SolverError(f"{case}: got a mesh of {points.shape[0]} points; allowed: {math.prod(shape)}, as asked")
    number = np.arange(points.shape[0]).reshape(shape)
    floor = [number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]]
    corners = [*(each[..., :-1] for each in floor), *(each[..., 1:] for each in floor)]
    cells, last = columns * lines * rows, case / TIME
    return FilmFields(points, np.stack(corners, axis=-1).reshape(cells, 8), **_in_cells(last, cells))


def read_fields(case: Path) -> FilmFields:
    """Read the fields of a case that has run with `writeFields true`.

    The mesh is one cell thick; the film is that side of it on which every cell has its first face of type empty.

    Raises
    ------
    SolverError
        If a file is missing, not ascii, or has other than the expected numbers.
    """
    mesh, last = case / "constant" / "polyMesh", case / TIME
    points = _list(mesh / "points", 3)
    owner = _list(mesh / "owner", 1).astype(np.int64)
    faces = _list(mesh / "faces", 5).astype(np.int64)
    cells = int(owner.max()) + 1
    sides = [patch for patch in parse(mesh / "boundary", boundary=True).values() if patch.get("type") == "empty"]
    if len(sides) != 1 or sides[0]["nFaces"] != 2 * cells or (faces[:, 0] != 4).any():
        raise SolverError(
            f"{mesh}: got another mesh; allowed: one cell thick, of hexahedra, with one patch of type empty"
        )
    first = int(sides[0]["startFace"])
    cell, face = np.unique(owner[first : first + 2 * cells], return_index=True)
    if cell.size != cells:
        raise SolverError(f"{mesh}: got {cell.size} cells with an empty face; allowed: {cells}, all of them")
    used, quads = np.unique(faces[first + face, 1:], return_inverse=True)
    plane = points[used]
    thickness = int(np.argmin(np.ptp(plane[:, 1:], axis=0))) + 1
    flat = np.column_stack([plane[:, 0], plane[:, 3 - thickness], np.zeros(used.size)])
    values = _in_cells(last, cells)
    values["U"] = np.column_stack([values["U"][:, 0], values["U"][:, 3 - thickness], np.zeros(cells)])
    return FilmFields(flat, quads.reshape(cells, 4), **values)


def write_fields(fields: FilmFields, path: Path) -> None:
    """Write the fields as VTU or XDMF, by the ending of the file, for ParaView: coordinates in m, all data a cell.

    A film is a thousand times longer than thick: look at it with its y scaled.

    Raises
    ------
    InputError
        If the file cannot be written, or something else stands there.
    DependencyError
        If meshio is not installed.
    """
    with needs("openfoam", "meshio", "fields of the film"):
        import meshio

    names = [name for name in ("p", "U", "mu", "rho", "liquid_fraction", "T") if getattr(fields, name) is not None]
    mesh = meshio.Mesh(fields.points, [fields.block], cell_data={name: [getattr(fields, name)] for name in names})
    # XML keeps an XDMF file in one piece, without HDF5
    options: dict[str, Any] = {"data_format": "XML"} if path.suffix == ".xdmf" else {}
    with written_aside(path, FIELDS) as aside:
        mesh.write(aside, **options)
        with aside.open("a", encoding="utf-8") as file:
            file.write(f"<!-- {MARK} -->\n")


def _in_cells(folder: Path, cells: int) -> dict[str, FloatArray]:
    """The fields of a folder, by the names of `FilmFields`."""
    widths = {"p": 1, "U": 3, "mu": 1, "rho": 1, "liquid_fraction": 1} | ({"T": 1} if (folder / "T").exists() else {})
    return {name: _field(folder / camel(name), cells, width) for name, width in widths.items()}


def _list(path: Path, width: int) -> FloatArray:
    """A list of numbers, vectors or faces, shape (n,) or (n, width)."""
    data = _ascii(path)
    head = _LIST.search(data)
    if head is None:
        raise SolverError(f"{path}: got no list; allowed: an ascii list of OpenFOAM")
    return _values(path, data[head.end() :], int(head[1]), width)


def _field(path: Path, cells: int, width: int) -> FloatArray:
    """Values of a field in the cells, shape (cells,) or (cells, width)."""
    data = _ascii(path)
    head = _INTERNAL.search(data)
    if head is None:
        raise SolverError(f"{path}: got no internalField; allowed: an ascii field of OpenFOAM")
    if head[1]:
        return np.broadcast_to(_values(path, head[2], 1, width), (cells, width) if width > 1 else (cells,)).copy()
    if int(head[3]) != cells:
        raise SolverError(f"{path}: got {int(head[3])} values; allowed: {cells}, one a cell")
    return _values(path, data[head.end() :], cells, width)


def _ascii(path: Path) -> bytes:
    """Text of a file of OpenFOAM."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise SolverError(f"{path}: cannot be read ({error.strerror})") from error
    if not _ASCII.search(data[:2000]):
        raise SolverError(f"{path}: got another format; allowed: a file of OpenFOAM with format ascii")
    return data


def _values(path: Path, text: bytes, count: int, width: int) -> FloatArray:
    """Numbers at the beginning of a text."""
    words = text.translate(_BRACKETS).split(None, count * width)[: count * width]
    try:
        values = np.array(words, dtype=np.bytes_).astype(np.float64)
    except ValueError:
        values = np.empty(0)
    if values.size != count * width or not np.isfinite(values).all():
        raise SolverError(f"{path}: got something else than {count * width} finite numbers; the run was cut short?")
    return values.reshape(count, width) if width > 1 else values
