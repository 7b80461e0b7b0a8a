"""Bodies as other programs write them: Matrix Market, Abaqus, CalculiX, tables of numbers, and places of the nodes.

Stiffness and mass as other programs write them: tables of numbers, Matrix Market, Abaqus matrix output.

All readers give a sparse matrix and labels (node, direction) of its rows. A symmetric matrix may be given as one half
or as a whole; which one it is, the entries say: each pair once, or each twice.

Where the nodes of a mesh are, by their numbers.

Abaqus and CalculiX decks are read here, because node numbers matter and need not be consecutive; all other formats by
meshio, where node k is the k-th point of the file.

Matrices that CalculiX writes for `*FREQUENCY, SOLVER=MATRIXSTORAGE`.

job.sti, job.mas    lines "row column value", counted from 1, of one half of K and M
job.dof             lines "node.direction", one for each row

Degrees of freedom that are fixed (*BOUNDARY), and those that follow others (*EQUATION, *TIE), are not in the matrices:
CalculiX has worked the others' share into the rows that are. So a node that is missing may be fixed or may follow, and
can be no interface. The rotations of a *RIGID BODY appear as displacements of an auxiliary node, and *TRANSFORM turns
the directions of a node: decks with these are refused.
"""

from __future__ import annotations

import math
import re
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import io, sparse

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError
from ehdmaps.extras import needs
from ehdmaps.units import short
from mbs.flexible.finite_elements import MOST_FREEDOMS, FiniteElementModel
from mbs.flexible.number_table import NumberTable, check_file, check_last_line, read_numbers
from mbs.flexible.plan import UNIT_SYSTEMS

_BLOCK = 2**20
"""Bytes of a file that are looked at in one piece."""

_FIXED = 1e35
"""Stiffness from which on a degree of freedom is taken as fixed: Abaqus writes 1e36 for those."""


class Labelled(NamedTuple):
    """A symmetric matrix and what its rows mean.

    Attributes
    ----------
    matrix : sparse array, shape (N, N)
        The matrix, in the units of the file.
    nodes, directions : array of int, shape (N,)
        Node number, and 0..2 for displacements, 3..5 for rotations.
    """

    matrix: sparse.csc_array
    nodes: IntArray
    directions: IntArray


class NodePositions(NamedTuple):
    """Nodes with known positions: numbers (P,), positions (P, 3) in the units of the file."""

    numbers: IntArray
    positions: FloatArray


def assemble_model(stiffness: Labelled, mass: Labelled, nodes: NodePositions, units: str = "SI") -> FiniteElementModel:
    """Put what files hold into one model in SI.

    Parameters
    ----------
    stiffness, mass : Labelled
        Their rows may be in different order; they have the same degrees of freedom.
    nodes : NodePositions
        Nodes of the mesh.
    units : {"SI", "mm-t-s"}
        Units of all three.

    Raises
    ------
    InputError
        If the matrices do not have the same degrees of freedom, or do not make a model.
    """
    if units not in UNIT_SYSTEMS:
        raise InputError(f"units: got {units!r:.40}; allowed: {', '.join(UNIT_SYSTEMS)}")
    keys = [entry.nodes * 6 + entry.directions for entry in (stiffness, mass)]
    orders = [np.argsort(key, kind="stable") for key in keys]
    if not np.array_equal(keys[0][orders[0]], keys[1][orders[1]]):
        apart = np.setxor1d(keys[0], keys[1])
        shown = ", ".join(f"node {key // 6} direction {key % 6 + 1}" for key in apart[:5].tolist())
        raise InputError(
            f"matrices: {shown}{f' and {apart.size - 5} more' if apart.size > 5 else ''} in only one of stiffness and "
            "mass; allowed: both of the same body, every degree of freedom with stiffness and mass"
        )
    force, length = (1.0, 1.0) if units == "SI" else (1e3, 1e-3)
    directions = stiffness.directions[orders[0]]
    # N/mm and tonne are 1e3 in SI, N/rad and t mm are 1, N mm and t mm2 are 1e-3.
    step = np.where(directions < 3, 0, 1)
    matrices = []
    for entry, order in zip((stiffness, mass), orders, strict=True):
        matrix = sparse.coo_array(sparse.csc_array(entry.matrix)[order][:, order])
        factors = np.array([force, force * length, force * length**2])
        with np.errstate(over="ignore"):  # the model refuses what is infinite
            scaled = matrix.data * factors[step[matrix.row] + step[matrix.col]]
        matrices.append(sparse.csc_array((scaled, (matrix.row, matrix.col)), shape=matrix.shape))
    return FiniteElementModel(
        stiffness=matrices[0],
        mass=matrices[1],
        nodes=stiffness.nodes[orders[0]],
        directions=directions,
        numbers=nodes.numbers,
        positions=nodes.positions * length,
    )


def read_matrix_market(path: Path, dofs: Path) -> Labelled:
    """Read a Matrix Market file, whose rows a table of degrees of freedom explains.

    Parameters
    ----------
    path : Path
        Real or integer entries; symmetric, or general and symmetric.
    dofs : Path
        See `read_dof_table`.

    Raises
    ------
    InputError
        For files that do not read or do not fit together.
    """
    nodes, directions = read_dof_table(dofs)
    check_file(path)
    _check_plain(path)
    try:
        rows, columns, entries, _, values, _ = io.mminfo(path)
    except (OSError, ValueError, OverflowError) as error:
        raise InputError(
            f"{path}: is no Matrix Market file ({_first_line(error)}); allowed: one that begins with %%MatrixMarket"
        ) from error
    if values not in ("real", "integer", "double"):
        raise InputError(f"{path}: got {values} entries; allowed: real ones")
    if (rows, columns) != (nodes.size, nodes.size):
        raise InputError(
            f"{path}: got {rows} rows and {columns} columns; allowed: {nodes.size} of each, as many as lines in {dofs}"
        )
    # An entry takes two characters at least: a header that promises more must not fill the memory.
    if 2 * entries > path.stat().st_size:
        raise InputError(f"{path}: the header promises {entries} entries, which the file does not hold; it was cut off")
    check_last_line(path)
    try:
        matrix = sparse.csc_array(io.mmread(path, spmatrix=False), dtype=np.float64)
    except (OSError, ValueError, OverflowError, MemoryError) as error:
        raise InputError(f"{path}: cannot be read ({_first_line(error)}); it was cut off or damaged") from error
    # Whether the entries are finite and symmetric, the model looks.
    return Labelled(matrix, nodes, directions)


def read_abaqus_matrix(path: Path, dofs: Path | None = None) -> Labelled:
    """Read what Abaqus writes for *MATRIX OUTPUT.

    FORMAT=MATRIX INPUT has lines "row node, row dof, column node, column dof, value"; FORMAT=COORDINATE has lines "row
    column value" and needs a table of degrees of freedom. Rows with a stiffness of 1e36, which stand for fixed degrees
    of freedom, are kept here: `without_fixed` takes them out.

    Parameters
    ----------
    path : Path
        The file; either half of a symmetric matrix, or the whole.
    dofs : Path, optional
        Table of degrees of freedom for FORMAT=COORDINATE; see `read_dof_table`.

    Raises
    ------
    InputError
        With file and line; also for nodes that Abaqus made itself, such as multipliers of constraints.
    """
    if dofs is not None:
        return read_triplets(path, *read_dof_table(dofs))
    table = read_numbers(path, 5, "*", ",")
    whole = table.whole(4)
    for column in (0, 2):
        bad = np.flatnonzero(whole[:, column] < 1)
        if bad.size:
            raise table.problem(
                int(bad[0]),
                "allowed: node numbers from 1; Abaqus gives those below to nodes of its own, such as the multipliers "
                "of constraints: tie by elements instead",
            )
        bad = np.flatnonzero((whole[:, column + 1] < 1) | (whole[:, column + 1] > 6))
        if bad.size:
            raise table.problem(int(bad[0]), "allowed: directions 1 to 3 for displacements, 4 to 6 for rotations")
    keys = 6 * whole[:, [0, 2]] + whole[:, [1, 3]] - 1
    labels, places = np.unique(keys, return_inverse=True)
    places = places.reshape(keys.shape)
    _check_count(path, labels.size)
    matrix = _symmetric(table, places[:, 0], places[:, 1], labels.size)
    return Labelled(matrix, labels // 6, labels % 6)


def without_fixed(stiffness: Labelled, mass: Labelled) -> tuple[Labelled, Labelled]:
    """Both matrices without the degrees of freedom whose stiffness is 1e36, as Abaqus marks what is fixed."""
    fixed = stiffness.matrix.diagonal() >= _FIXED
    gone = (stiffness.nodes * 6 + stiffness.directions)[fixed]
    left = []
    for entry in (stiffness, mass):
        kept = np.flatnonzero(~np.isin(entry.nodes * 6 + entry.directions, gone))
        left.append(Labelled(sparse.csc_array(entry.matrix[kept][:, kept]), entry.nodes[kept], entry.directions[kept]))
    return left[0], left[1]


def read_triplets(path: Path, nodes: IntArray, directions: IntArray) -> Labelled:
    """Read lines "row column value", counted from 1, of one half of a symmetric matrix or of the whole.

    Parameters
    ----------
    path : Path
        The file.
    nodes : IntArray
        Node of each row of the matrix.
    directions : IntArray
        Direction of each row.

    Raises
    ------
    InputError
        With file and line.
    """
    table = read_numbers(path, 3, "*")
    whole = table.whole(2)
    bad = np.flatnonzero(((whole < 1) | (whole > nodes.size)).any(axis=1))
    if bad.size:
        raise table.problem(int(bad[0]), f"allowed: rows and columns from 1 to {nodes.size}, the degrees of freedom")
    return Labelled(_symmetric(table, whole[:, 0] - 1, whole[:, 1] - 1, nodes.size), nodes, directions)


def read_dof_table(path: Path) -> tuple[IntArray, IntArray]:
    """Read lines "node direction", one for each row; direction 1 to 3 for displacements, 4 to 6 for rotations.

    Returns
    -------
    nodes, directions : array of int, shape (N,)
        Directions counted from 0.

    Raises
    ------
    InputError
        With file and line.
    """
    table = read_numbers(path, 2, "#")
    return checked_labels(table, table.whole(2))


def checked_labels(table: NumberTable, whole: IntArray) -> tuple[IntArray, IntArray]:
    """Nodes and directions (from 0) of rows (node, direction from 1), shape (N, 2); InputError with file and line."""
    _check_count(table.path, whole.shape[0])
    bad = np.flatnonzero((whole[:, 0] < 1) | (whole[:, 1] < 1) | (whole[:, 1] > 6))
    if bad.size:
        raise table.problem(int(bad[0]), "allowed: a node from 1 and a direction from 1 to 6")
    _, first = np.unique(whole, axis=0, return_index=True)
    if first.size < whole.shape[0]:
        again = int(np.setdiff1d(np.arange(whole.shape[0]), first)[0])
        raise table.problem(again, "which is there twice; allowed: each degree of freedom once")
    return whole[:, 0].copy(), whole[:, 1] - 1


def _check_count(path: Path, count: int) -> None:
    """Raise if there are more degrees of freedom than can be reduced."""
    if count > MOST_FREEDOMS:
        raise InputError(
            f"{path}: got {count} degrees of freedom; allowed: at most {MOST_FREEDOMS}; take a coarser mesh"
        )


def _symmetric(table: NumberTable, rows: IntArray, columns: IntArray, size: int) -> sparse.csc_array:
    """The whole matrix of values given once or twice for each pair of rows, rows and columns from 0."""
    values = table.values[:, -1]
    entries = rows * size + columns
    _, first = np.unique(entries, return_index=True)
    if first.size < entries.size:
        again = int(np.setdiff1d(np.arange(entries.size), first)[0])
        raise table.problem(again, "an entry that is there twice; allowed: each once")
    given = sparse.csc_array((values, (rows, columns)), shape=(size, size))
    apart = rows != columns
    mirrored = np.isin(entries[apart], columns[apart] * size + rows[apart])
    if not mirrored.any():
        diagonal = sparse.dia_array((given.diagonal()[None, :], [0]), shape=given.shape)
        return sparse.csc_array(given + given.T - diagonal)
    if not mirrored.all():
        row = int(np.flatnonzero(apart)[np.argmin(mirrored)])
        raise table.problem(
            row,
            "an entry without its mirror image, while others have theirs; allowed: one half of the matrix, or the "
            "whole",
        )
    return given


def _first_line(error: BaseException) -> str:
    """Message of an error, in one line."""
    return (str(error).splitlines() or [type(error).__name__])[0][:200]


def _check_plain(path: Path) -> None:
    """Refuse a text with zero bytes: the library that reads Matrix Market files reads on behind them, and crashes."""
    with path.open("rb") as file:
        while block := file.read(_BLOCK):
            if b"\0" in block:
                raise InputError(
                    f"{path}: is no Matrix Market file (it has zero bytes); allowed: text; was it damaged?"
                )


DECKS = (".inp",)

_SEVERAL = (".xdmf", ".xmf", ".xml", ".node", ".ele")
"""Formats of meshio that open further files, whatever those are."""

_PACKED = (".gz",)

SHORTEST_READ, BYTES_PER_SECOND = 20.0, 1e6
"""Seconds that meshio has, and what it reads in one more; it takes half a second to start, and 10 MB a second."""

_NO_PACKAGE = 3
"""Exit status of the process that reads, where meshio or a package that it needs is not installed."""

# meshio prints what went wrong, and leaves the program.
_AROUND = """
import os, sys
output = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)
try:
{}
except ImportError as error:
    sys.stderr.write(str(error))
    sys.exit({})
except (Exception, SystemExit) as error:
    sys.stderr.write(f" {{error}}")
"""

_READ = """
import meshio, numpy
numpy.save(output, numpy.asarray(meshio.read(sys.argv[1]).points, dtype=float))
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
    places: dict[int, tuple[float, float, float]] = {}
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
                places[node] = position
    if not places:
        raise InputError(f"{path}: has no *NODE block; allowed: the deck that has the nodes of the mesh")
    return NodePositions(np.array(list(places), dtype=np.int64), np.array(list(places.values()), dtype=np.float64))


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
    """Points that meshio finds; some of its readers never end where a file was cut off."""
    content, words = run_apart(_READ, [str(path.absolute())], path.stat().st_size, "flexible", "meshio", str(path))
    try:
        return np.asarray(np.load(BytesIO(content), allow_pickle=False), dtype=np.float64)
    except (OSError, ValueError, EOFError) as error:
        raise InputError(
            f"{path}: cannot be read as a mesh ({words:.120}); allowed: a format that meshio reads; was it cut off?"
        ) from error


def run_apart(
    code: str, arguments: Sequence[str], length: int, extra: str, package: str, where: str
) -> tuple[bytes, str]:
    """Read files with another package in a process of its own.

    Parameters
    ----------
    code : str
        Python that imports the package, and writes what it finds in sys.argv[1:] to the binary file `output`.
    arguments : sequence of str
        Content of sys.argv[1:].
    length : int
        Bytes of the files; the time that it may take grows with them.
    extra, package : str
        Names of the extra and of the package, for `ehdmaps.extras.needs`.
    where : str
        Begin of a message on a missing package.

    Returns
    -------
    content : bytes
        Content of `output`.
    words : str
        Complaints of the package.

    Raises
    ------
    DependencyError
        If the package cannot be loaded.
    """
    seconds = SHORTEST_READ + length / BYTES_PER_SECOND
    script = _AROUND.format(textwrap.indent(code.strip(), "    "), _NO_PACKAGE)
    with tempfile.TemporaryFile() as output:
        try:
            process = subprocess.run(
                # -P: nothing is imported from the folder in which we are.
                [sys.executable, "-P", "-c", script, *arguments],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.PIPE,
                timeout=seconds,
                check=False,
            )
            words = " ".join(process.stderr.decode("utf-8", "replace").split())
            if process.returncode == _NO_PACKAGE:
                with needs(extra, package, f"{where}: reading this format"):
                    raise ImportError(f"{words:.120}")
        except subprocess.TimeoutExpired:
            words = f"it did not end within {seconds:.3g} s"
        output.seek(0)
        return output.read(), words


_REFUSED = ("RIGIDBODY", "TRANSFORM", "MPC", "DISTRIBUTINGCOUPLING", "KINEMATIC", "DISTRIBUTING", "COUPLING")
_ROW = re.compile(r"([0-9]{1,20})\.([0-9]{1,20})")


def read_calculix(
    stiffness: Path, mass: Path, dofs: Path, nodes: NodePositions, units: str = "SI"
) -> FiniteElementModel:
    """Read the matrices of a CalculiX run.

    Parameters
    ----------
    stiffness, mass, dofs : Path
        Files job.sti, job.mas and job.dof of one run.
    nodes : NodePositions
        Nodes of its mesh; see `mbs.flexible.matrix_files`.
    units : {"SI", "mm-t-s"}
        Units of deck and matrices.

    Raises
    ------
    InputError
        With file and line.
    """
    labels = read_dofs(dofs)
    return assemble_model(read_triplets(stiffness, *labels), read_triplets(mass, *labels), nodes, units)


def read_dofs(path: Path) -> tuple[IntArray, IntArray]:
    """Read a .dof file.

    Returns
    -------
    nodes, directions : array of int, shape (N,)
        Directions counted from 0.

    Raises
    ------
    InputError
        With file and line.
    """
    # As numbers first, for length, line and finiteness; "12.10" would be direction 1 as a number, so as text then.
    table = read_numbers(path, 1, "#")
    with path.open(encoding="utf-8", errors="replace") as file:
        rows = [_ROW.fullmatch(text) for line in file if (text := line.partition("#")[0].strip())]
    if None in rows:
        raise table.problem(rows.index(None), 'allowed: "node.direction", such as 12.1')
    whole = np.array([[int(part) for part in match.groups()] for match in rows if match], dtype=object)
    huge = np.flatnonzero((whole > 10**12).any(axis=1))
    if huge.size:
        raise table.problem(int(huge[0]), "allowed: a node from 1 and a direction from 1 to 6")
    return checked_labels(table, whole.astype(np.int64))


def check_deck(path: Path) -> None:
    """Raise InputError if a deck has constraints that make its matrices unreadable: see the head of this module."""
    check_file(path)
    wrong = []
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            if line.startswith("*") and not line.startswith("**"):
                keyword = line[1:].partition(",")[0].strip().upper()
                if keyword.replace(" ", "") in _REFUSED:
                    wrong.append(
                        f"{path}, line {number}: got *{keyword}; allowed: solid elements, fixed nodes, ties; "
                        "interfaces follow by a spider of this program instead"
                    )
    if wrong:
        raise InputError(wrong)
