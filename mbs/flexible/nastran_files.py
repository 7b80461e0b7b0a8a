"""Matrices of Nastran: DMIG entries of bulk data or punch files, as pyNastran reads them.

KAAX, MAAX      names of EXTSEOUT(DMIGPCH) for stiffness and mass of a reduced part; any others can be named
GRID            nodes, in any rectangular, cylindrical or spherical system; displacements along the basic system
SPOINT          generalised coordinates of a part with modes; they have component 0

pyNastran runs in a process of its own: a file that leads it astray ends there. It passes over values of rows that are
longer than it expects, so what it finds is counted against the file.

Bulk data of Nastran, split into entries: to count by, not to read by.

Libraries read bulk data, and leave out in silence what they do not expect. So the entries of a file are counted here.

GRID,1,,0.,0.,1.       fields apart by commas: ten a line; of a name with a star, as GRID*, six
GRID           1       or in columns of 8, of a name with a star 8 and four times 16
+, * or blanks         begin a line that goes on
"""

from __future__ import annotations

import io
import itertools
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy import sparse

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.units import short
from mbs.flexible.apart import run_apart
from mbs.flexible.finite_elements import ASYMMETRY, FiniteElementModel, NodePositions, check_size, named
from mbs.flexible.matrix_files import Labelled, assemble_model
from mbs.flexible.number_table import check_file, check_last_line


class Entry(NamedTuple):
    """An entry of bulk data.

    Attributes
    ----------
    line : int
        Number of its first line.
    name : str
        Name of the entry, without a star.
    fields : list of str
        Fields behind the name; those that a line leaves out are empty.
    """

    line: int
    name: str
    fields: list[str]


def entries(path: Path, names: tuple[str, ...]) -> Iterator[Entry]:
    """Split bulk data into entries.

    Parameters
    ----------
    path : Path
        Bulk data, with or without what stands before BEGIN BULK.
    names : tuple of str
        Names of the entries that are wanted.

    Raises
    ------
    InputError
        For a line of a wanted entry with more fields than it may have, lines that repeat others, and INCLUDE.
    """
    entry: Entry | None = None
    for number, text in _lines(path):
        first, fields, surplus = _split(text)
        begins = first[:1] not in ("", "+", "*")
        if begins:
            if entry is not None and entry.name in names:
                yield entry
            if first.startswith("="):
                raise _refused(path, number, text, "each entry written out; = repeats the one above")
            entry = Entry(number, first.rstrip("*").strip(), fields)
            if entry.name == "ENDDATA":
                return
        elif entry is not None:
            entry.fields.extend(fields)
        if surplus and entry is not None and entry.name in names:
            most = len(fields)
            raise _refused(
                path, number, text, f"up to {most + 2} fields a line, {most} of them data; go on in a line more"
            )
    if entry is not None and entry.name in names:
        yield entry


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """Lines of the bulk data without comments, and their numbers."""
    with path.open(encoding="latin-1") as file:
        begun = not any(line.lstrip().upper().startswith("BEGIN") for line in file)
        file.seek(0)
        for number, line in enumerate(file, start=1):
            text = line.partition("$")[0].rstrip()
            if text.lstrip()[:7].upper() == "INCLUDE":
                raise _refused(path, number, text.strip(), "bulk data in one file")
            if begun and text:
                yield number, text
            begun = begun or text.lstrip().upper().startswith("BEGIN")


def _split(text: str) -> tuple[str, list[str], bool]:
    """First field of a line; the others without the last one, which says that it goes on; whether there are more."""
    free = "," in text
    if free:
        parts = [part.strip() for part in text.split(",")]
    else:
        columns = text.expandtabs(8)
        width = 16 if "*" in columns[:8] else 8
        ends = [0, 8, *range(8 + width, 73, width), 80]
        parts = [columns[begin:end].strip() for begin, end in itertools.pairwise(ends)]
    first = parts[0].upper()
    most = 4 if "*" in first else 8
    fields = parts[1 : most + 1]
    return first, fields + [""] * (most - len(fields)), free and any(parts[most + 2 :])


def _refused(path: Path, number: int, text: str, allowed: str) -> InputError:
    """An error at a line."""
    return InputError(f"{path}, line {number}: got {short(text)}; allowed: {allowed}")


_SYMMETRIC, _SQUARE = 6, 1
"""Forms of a DMIG: one half of a symmetric matrix, or all of a square one."""

_MODAL = 3
"""Direction given to a generalised coordinate: like a rotation it has no length, so units of its rows are the same."""

# What pip installs with pyNastran 1.4 is a numpy below 2; of what newer ones lack it needs in1d alone.
_READ = """
import io
import numpy
if not hasattr(numpy, "in1d"):
    numpy.in1d = numpy.isin
from pyNastran.bdf.bdf import BDF
CARDS = {"GRID", "GRDSET", "DMIG", "CORD1R", "CORD1C", "CORD1S", "CORD2R", "CORD2C", "CORD2S"}
found = {}
mesh, *matrices = sys.argv[1:]
models = {}
def model_of(path):
    if path not in models:
        with open(path, encoding="latin-1") as file:
            lines = file.readlines()
        # The library wants all sections or the last one alone: that is all that is read here.
        begin = next((k + 1 for k, line in enumerate(lines) if line.lstrip().upper().startswith("BEGIN")), 0)
        model = models[path] = BDF(debug=None)
        model.cards_to_read = set(CARDS)
        model.read_bdf(io.StringIO("".join(lines[begin:])), validate=False, xref=False, punch=True, read_includes=False)
    return models[path]
model = model_of(mesh)
grids = sorted(model.nodes)
found["turned"] = numpy.array([n for n in grids if model.nodes[n].cd not in (0, None)], dtype=numpy.int64)
found["default"] = numpy.array(model.grdset is not None)
found["numbers"] = numpy.array(grids, dtype=numpy.int64)
found["positions"] = numpy.array([model.nodes[n].get_position_no_xref(model) for n in grids], dtype=float)
for which, path, name in zip(("k", "m"), matrices[::2], matrices[1::2]):
    entries = model_of(path).dmig
    found[which + "_names"] = numpy.array(sorted(entries), dtype=str)
    if name in entries:
        entry = entries[name]
        found[which + "_kind"] = numpy.array([entry.matrix_form, entry.tin], dtype=numpy.int64)
        for part, values in (("_columns", entry.GCj), ("_rows", entry.GCi)):
            found[which + part] = numpy.array(values, dtype=numpy.int64).reshape(-1, 2)
        found[which + "_values"] = numpy.array(entry.Real, dtype=float)
numpy.savez(output, **found)
"""


def read_nastran(
    stiffness: Path, mass: Path, mesh: Path, names: tuple[str, str] = ("KAAX", "MAAX"), units: str = "SI"
) -> FiniteElementModel:
    """Read a body from DMIG entries and GRIDs; the three files may be one.

    Parameters
    ----------
    stiffness, mass : Path
        Bulk data or punch files with the DMIG entries.
    mesh : Path
        Bulk data with the GRIDs.
    names : (str, str)
        Names of the DMIG entries of stiffness and mass.
    units : {"SI", "mm-t-s"}
        Units of all of them.

    Raises
    ------
    InputError
        With file and entry; DependencyError without pyNastran.
    """
    for path in dict.fromkeys((stiffness, mass, mesh)):
        check_file(path)
        check_last_line(path)
    parts = _entries(mesh, (stiffness, names[0]), (mass, names[1]))
    nodes = _nodes(mesh, parts)
    k, m = (
        _labelled(f"{path}, DMIG {name}", parts, which, nodes, mesh)
        for which, path, name in (("k", stiffness, names[0]), ("m", mass, names[1]))
    )
    return assemble_model(k, m, nodes, units)


def read_grids(mesh: Path) -> NodePositions:
    """Read the GRIDs of bulk data, in the units of the file.

    Parameters
    ----------
    mesh : Path
        Bulk data with GRIDs in any system.

    Raises
    ------
    InputError
        With file and entry; DependencyError without pyNastran.
    """
    check_file(mesh)
    check_last_line(mesh)
    return _nodes(mesh, _entries(mesh))


def grid_numbers(mesh: Path) -> IntArray:
    """Numbers of all GRIDs in the order of the file; InputError if one is none."""
    numbers = []
    for entry in entries(mesh, ("GRID",)):
        if not entry.fields[0].isdecimal():
            raise InputError(
                f"{mesh}, line {entry.line}: got a GRID of number {short(entry.fields[0])}; allowed: a whole number"
            )
        numbers.append(int(entry.fields[0]))
    return np.array(numbers, dtype=np.int64)


def _dmig_counts(path: Path) -> Counter[str]:
    """Number of values of each DMIG of a file."""
    counts: Counter[str] = Counter()
    for entry in entries(path, ("DMIG",)):
        if entry.fields[1] != "0":  # else it is the head of the matrix
            counts[entry.fields[0].upper()] += sum(bool(value) for value in entry.fields[6::4])
    return counts


def _entries(mesh: Path, *matrices: tuple[Path, str]) -> Mapping[str, Any]:
    """Nodes and values that pyNastran finds in the files, as many as stand there."""
    paths = dict.fromkeys([mesh, *(path for path, _ in matrices)])
    grids = grid_numbers(mesh)
    counts = {path: _dmig_counts(path) for path, _ in matrices}
    given = [str(mesh.absolute()), *(text for path, name in matrices for text in (str(path.absolute()), name))]
    shown = ", ".join(str(path) for path in paths)
    content, words = run_apart(_READ, given, sum(path.stat().st_size for path in paths), "nastran", "pyNastran", shown)
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as archive:
            parts = dict(archive)
    except (OSError, ValueError, EOFError) as error:
        raise InputError(
            f"{shown}: cannot be read as bulk data ({words:.200}); allowed: GRID and DMIG entries that pyNastran "
            "reads; was it cut off?"
        ) from error
    lost = np.setxor1d(grids, parts["numbers"])
    problems = Problems(
        [f"{mesh}: pyNastran does not find GRID {named(lost)}; allowed: entries that it reads"] if lost.size else []
    )
    for which, (path, name) in zip("km", matrices, strict=False):
        there, found = counts[path][name.upper()], np.size(parts.get(f"{which}_values", ()))
        if there != found:
            problems.append(
                f"{path}, DMIG {name}: pyNastran finds {found} values where the file has {there}; allowed: rows of a "
                "head and lines that go on, such as Nastran writes them"
            )
    problems.check()
    return parts


def _nodes(mesh: Path, parts: Mapping[str, Any]) -> NodePositions:
    """The GRIDs, whose displacements are along the basic system."""
    numbers, positions = parts["numbers"], parts["positions"]
    if numbers.size == 0:
        raise InputError(f"{mesh}: got no GRID; allowed: bulk data with the nodes of the matrices")
    if parts["default"]:
        raise InputError(f"{mesh}: got a GRDSET; allowed: each GRID with what it needs")
    if parts["turned"].size:
        raise InputError(
            f"{mesh}: got GRID {named(parts['turned'])} with displacements in a system of their own (CD); allowed: in "
            "the basic system, CD left out or 0"
        )
    return NodePositions(numbers, positions)


def _labelled(where: str, parts: Mapping[str, Any], which: str, nodes: NodePositions, mesh: Path) -> Labelled:
    """One of the two matrices."""
    if f"{which}_kind" not in parts:
        there = ", ".join(parts[f"{which}_names"].tolist()) or "none"
        raise InputError(f"{where}: got none of this name; allowed: a DMIG of the file: {there:.200}")
    form, kind = parts[f"{which}_kind"].tolist()
    if form not in (_SYMMETRIC, _SQUARE):
        raise InputError(f"{where}: got a matrix of form {form}; allowed: 6, symmetric, or 1, square")
    if kind not in (1, 2):
        raise InputError(f"{where}: got complex entries (TIN {kind}); allowed: real ones, TIN 1 or 2")
    values: FloatArray = parts[f"{which}_values"]
    if values.size == 0 or not np.all(np.isfinite(values)):
        raise InputError(f"{where}: got no entries, or some that are no finite numbers; allowed: finite numbers")
    keys = np.stack([_keys(where, parts[f"{which}_{part}"], nodes, mesh) for part in ("rows", "columns")])
    labels, places = np.unique(keys, return_inverse=True)
    rows, columns = places.reshape(keys.shape)
    check_size(str(where), labels.size)
    # In one half a pair is the same either way round.
    low, high = (np.minimum(rows, columns), np.maximum(rows, columns)) if form == _SYMMETRIC else (rows, columns)
    _, first, counts = np.unique(low * labels.size + high, return_index=True, return_counts=True)
    if np.any(counts > 1):
        k = int(first[np.argmax(counts > 1)])
        raise InputError(
            f"{where}: got the entry of {_freedom(labels[rows[k]])} and {_freedom(labels[columns[k]])} twice; allowed: "
            f"each once{', in one half' if form == _SYMMETRIC else ''}"
        )
    matrix = sparse.csc_array((values, (low, high)), shape=(labels.size, labels.size))
    if form == _SYMMETRIC:
        diagonal = sparse.dia_array((matrix.diagonal()[None, :], [0]), shape=matrix.shape)
        matrix = sparse.csc_array(matrix + matrix.T - diagonal)
    apart = sparse.coo_array(abs(matrix - matrix.T))
    if apart.nnz and np.max(apart.data) > ASYMMETRY * np.max(np.abs(values)):
        k = int(np.argmax(apart.data))
        raise InputError(
            f"{where}: is not symmetric: the entries of {_freedom(labels[apart.row[k]])} and "
            f"{_freedom(labels[apart.col[k]])} differ by {apart.data[k]:.3g}; allowed: symmetric matrices"
        )
    return Labelled(matrix, labels // 6, labels % 6)


def _keys(where: str, labels: IntArray, nodes: NodePositions, mesh: Path) -> IntArray:
    """Node and direction of rows or columns as one number each."""
    points, components = labels.T
    known = np.isin(points, nodes.numbers)
    lost = np.unique(points[(components > 0) & ~known])
    if lost.size:
        raise InputError(
            f"{where}: got {named(lost)} without a GRID in {mesh}; allowed: nodes of the mesh, which has "
            f"{nodes.numbers.size}; name the bulk data that has them"
        )
    scalar = np.unique(points[(components == 0) & known])
    if scalar.size:
        raise InputError(f"{where}: got component 0 of GRID {named(scalar)}; allowed: 1 to 6, and 0 of an SPOINT alone")
    return np.asarray(6 * points + np.where(components == 0, _MODAL, components - 1), dtype=np.int64)


def _freedom(key: int) -> str:
    """A degree of freedom in words."""
    return f"node {key // 6} direction {key % 6 + 1}"
