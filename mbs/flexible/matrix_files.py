"""Stiffness and mass as other programs write them: tables of numbers, Matrix Market, Abaqus and CalculiX output.

All readers give a sparse matrix and labels (node, direction) of its rows. A symmetric matrix may be given as one half
or as a whole; which one it is, the entries say: each pair once, or each twice.

Matrices that CalculiX writes for `*FREQUENCY, SOLVER=MATRIXSTORAGE`.

job.sti, job.mas    lines "row column value", counted from 1, of one half of K and M
job.dof             lines "node.direction", one for each row

Degrees of freedom that are fixed (*BOUNDARY), and those that follow others (*EQUATION, *TIE), are not in the matrices:
CalculiX has worked the others' share into the rows that are. So a node that is missing may be fixed or may follow, and
can be no interface. The rotations of a *RIGID BODY appear as displacements of an auxiliary node: decks with it are
refused.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import sparse

from ehdmaps.arrays import IntArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.inputs import first_bytes
from ehdmaps.units import short
from mbs.flexible.finite_elements import FiniteElementModel, NodePositions, check_size, named
from mbs.flexible.number_table import NumberTable, check_file, check_last_line, read_numbers
from mbs.flexible.plan import UNIT_SYSTEMS
from mbs.flexible.rigid_motion import check_rigid_motion

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
        If the matrices do not have the same degrees of freedom, do not make a model, or do not fit the nodes.
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
    model = FiniteElementModel(
        stiffness=matrices[0],
        mass=matrices[1],
        nodes=stiffness.nodes[orders[0]],
        directions=directions,
        numbers=nodes.numbers,
        positions=nodes.positions * length,
    )
    check_rigid_motion(model)
    return model


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
    head = first_bytes(path, 200, "a Matrix Market file").decode("ascii", "replace").partition("\n")[0].split()
    if len(head) < 5 or head[0] != "%%MatrixMarket" or head[1].lower() != "matrix":
        raise InputError(f"{path}: is no Matrix Market file; allowed: one that begins with %%MatrixMarket matrix")
    shape, values, symmetry = (word.lower() for word in head[2:5])
    if values not in ("real", "integer", "double"):
        raise InputError(f"{path}: got {short(values)} entries; allowed: real ones")
    if shape not in ("coordinate", "array") or symmetry not in ("symmetric", "general"):
        raise InputError(
            f"{path}: got {short(f'{shape} {symmetry}')}; allowed: coordinate or array, symmetric or general"
        )
    if shape == "array":
        return Labelled(_dense(path, symmetry, nodes.size, dofs), nodes, directions)
    # The line of the size has three numbers, as those of the entries.
    table = read_numbers(path, 3, "%")
    rows, columns, entries = (round(number) for number in table.values[0].tolist())
    _check_shape(path, rows, columns, nodes.size, dofs)
    if entries != table.values.shape[0] - 1:
        raise InputError(
            f"{path}: the header promises {entries} entries, and the file has {table.values.shape[0] - 1}; it was cut "
            "off, or entries do not have a line each"
        )
    whole = table.whole(2)
    bad = np.flatnonzero(((whole < 1) | (whole > nodes.size))[1:].any(axis=1))
    if bad.size:
        raise table.problem(int(bad[0]) + 1, f"allowed: rows and columns from 1 to {nodes.size}")
    matrix = _symmetric(table, whole[:, 0] - 1, whole[:, 1] - 1, nodes.size, begin=1)
    return Labelled(matrix, nodes, directions)


def _check_shape(path: Path, rows: int, columns: int, size: int, dofs: Path) -> None:
    """Raise if a matrix has not as many rows and columns as there are degrees of freedom."""
    if (rows, columns) != (size, size):
        raise InputError(
            f"{path}: got {rows} rows and {columns} columns; allowed: {size} of each, as many as lines in {dofs}"
        )


def _dense(path: Path, symmetry: str, size: int, dofs: Path) -> sparse.csc_array:
    """A matrix whose entries are all written, column by column; of a symmetric one those below the diagonal."""
    check_last_line(path)
    with path.open(encoding="utf-8", errors="replace") as file:
        words = [word for line in file if not line.startswith("%") for word in line.split()]
    try:
        rows, columns = (int(word) for word in words[:2])
        _check_shape(path, rows, columns, size, dofs)
        values = np.array(words[2:], dtype=np.float64)
    except ValueError as error:
        raise InputError(f"{path}: cannot be read ({str(error)[:200]}); allowed: numbers; was it damaged?") from error
    place = np.tril_indices(size) if symmetry == "symmetric" else np.indices((size, size)).reshape(2, -1)
    order = np.lexsort((place[0], place[1]))
    if values.size != order.size:
        raise InputError(f"{path}: got {values.size} entries; allowed: {order.size}, as its header says")
    matrix = np.zeros((size, size))
    matrix[place[0][order], place[1][order]] = values
    if symmetry == "symmetric":
        matrix[place[1][order], place[0][order]] = values
    return sparse.csc_array(matrix)


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
    check_size(str(path), labels.size)
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
    check_size(str(table.path), whole.shape[0])
    bad = np.flatnonzero((whole[:, 0] < 1) | (whole[:, 1] < 1) | (whole[:, 1] > 6))
    if bad.size:
        raise table.problem(int(bad[0]), "allowed: a node from 1 and a direction from 1 to 6")
    _, first = np.unique(whole, axis=0, return_index=True)
    if first.size < whole.shape[0]:
        again = int(np.setdiff1d(np.arange(whole.shape[0]), first)[0])
        raise table.problem(again, "which is there twice; allowed: each degree of freedom once")
    return whole[:, 0].copy(), whole[:, 1] - 1


def _symmetric(table: NumberTable, rows: IntArray, columns: IntArray, size: int, begin: int = 0) -> sparse.csc_array:
    """The whole matrix of values given once or twice for each pair of rows; rows and columns from 0, from a line on."""
    rows, columns, values = rows[begin:], columns[begin:], table.values[begin:, -1]
    entries = rows * size + columns
    _, first = np.unique(entries, return_index=True)
    if first.size < entries.size:
        again = int(np.setdiff1d(np.arange(entries.size), first)[0])
        raise table.problem(again + begin, "an entry that is there twice; allowed: each once")
    given = sparse.csc_array((values, (rows, columns)), shape=(size, size))
    apart = rows != columns
    mirrored = np.isin(entries[apart], columns[apart] * size + rows[apart])
    if not mirrored.any():
        diagonal = sparse.dia_array((given.diagonal()[None, :], [0]), shape=given.shape)
        return sparse.csc_array(given + given.T - diagonal)
    if not mirrored.all():
        row = int(np.flatnonzero(apart)[np.argmin(mirrored)])
        raise table.problem(
            row + begin,
            "an entry without its mirror image, while others have theirs; allowed: one half of the matrix, or the "
            "whole",
        )
    return given


_REFUSED = ("RIGIDBODY", "MPC", "DISTRIBUTINGCOUPLING", "KINEMATIC", "DISTRIBUTING", "COUPLING")
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
    strange = np.setdiff1d(labels[0], nodes.numbers)
    if strange.size:
        raise InputError(
            f"{dofs}: got {named(strange)}, which the mesh has not; allowed: solid elements, each node in the mesh; "
            "CalculiX makes solids with nodes of its own of shells, beams and plane elements"
        )
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
    wrong = Problems()
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            if line.startswith("*") and not line.startswith("**"):
                keyword = line[1:].partition(",")[0].strip().upper()
                if keyword.replace(" ", "") in _REFUSED:
                    wrong.append(
                        f"{path}, line {number}: got *{keyword}; allowed: solid elements, fixed nodes, ties; "
                        "interfaces follow by a spider of this program instead"
                    )
    wrong.check()
