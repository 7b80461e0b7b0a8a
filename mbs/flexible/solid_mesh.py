"""A solid mesh as a body: read by meshio, assembled by CalculiX, ready for a reduction.

=====================  ==========================  ========================================
mesh                   groups of nodes             material
=====================  ==========================  ========================================
.msh of Gmsh           physical groups             stated
.inp of Abaqus         *NSET, *ELSET               *MATERIAL, *SOLID SECTION
.bdf .nas .fem         properties ("property 3")   MAT1, PSOLID
.med of Salome         groups                      stated
=====================  ==========================  ========================================

Elements are tetrahedra, wedges and hexahedra of first or second order; shells and beams of the same file, which mesh
programs write along with solids, are left out, and said. Groups of elements may be of different materials. CalculiX
assembles stiffness and mass once, in SI, in a folder that is removed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.inputs import read_text
from ehdmaps.physics.solids import Material
from ehdmaps.solids.calculix import LONGEST_RUN, run_deck
from mbs.flexible.apart import run_apart
from mbs.flexible.finite_elements import check_size
from mbs.flexible.number_table import LONGEST_FILE, check_file

MESHES = (".msh", ".inp", ".bdf", ".nas", ".fem", ".med")
"""Endings of solid meshes."""

UNITS: Mapping[str, float] = {"m": 1.0, "mm": 1e-3}
"""Units of lengths of a mesh [m]."""

JOB = "body"
"""Name of the files of CalculiX."""

_ELEMENTS = {
    "tetra": "C3D4",
    "tetra10": "C3D10",
    "wedge": "C3D6",
    "wedge15": "C3D15",
    "hexahedron": "C3D8",
    "hexahedron20": "C3D20",
}
"""Elements of CalculiX by those of meshio, whose nodes are in the same order."""

_PER_LINE = 12
"""Entries of a line of a deck; CalculiX takes up to 16."""

_READ = """
import meshio, numpy, pathlib, tempfile
path = pathlib.Path(sys.argv[1])
bulk = path.read_text(errors="replace") if path.suffix.lower() in (".bdf", ".nas", ".fem") else "BEGIN BULK"
if "BEGIN BULK" in bulk.upper():
    mesh = meshio.read(path)
else:  # as Gmsh writes them
    with tempfile.TemporaryDirectory() as folder:
        whole = pathlib.Path(folder) / "whole.bdf"
        whole.write_text("BEGIN BULK\\n" + bulk)
        mesh = meshio.read(whole)
points = numpy.asarray(mesh.points, dtype=float)
found, groups, others, members, starts = {}, {}, set(), {}, []
kinds = KINDS
for block in mesh.cells:
    starts.append(sum(len(part) for part in found.get(block.type, [])))
    if block.type in kinds:
        found.setdefault(block.type, []).append(block.data)
    else:
        others.add(block.type)
def add(name, nodes):
    groups[str(name)] = numpy.unique(numpy.concatenate([groups.get(str(name), numpy.zeros(0, int)), nodes]))
def member(name, k, rows):
    if mesh.cells[k].type in kinds:
        members.setdefault((str(name), mesh.cells[k].type), []).append(starts[k] + numpy.asarray(rows, int))
for name, nodes in mesh.point_sets.items():
    add(name, numpy.asarray(nodes, int).ravel())
names = {(tag, dim): name for name, (tag, dim) in mesh.field_data.items()}
tags = mesh.cell_data.get("gmsh:physical")
dims = {"vertex": 0, "line": 1, "line3": 1, "triangle": 2, "triangle6": 2, "quad": 2, "quad8": 2, "quad9": 2}
for k, block in enumerate(mesh.cells):
    if tags is not None:
        for tag in numpy.unique(tags[k]):
            name = names.get((int(tag), dims.get(block.type, 3)))
            if name is not None:
                add(name, block.data[tags[k] == tag].ravel())
                member(name, k, numpy.flatnonzero(tags[k] == tag))
    refs = mesh.cell_data.get("nastran:ref")
    for ref in numpy.unique(refs[k]) if refs is not None else ():
        member("property %d" % ref, k, numpy.flatnonzero(refs[k] == ref))
for name, parts in mesh.cell_sets.items():
    for k, (block, cells) in enumerate(zip(mesh.cells, parts)):
        if cells is not None and len(cells):
            add(name, block.data[numpy.asarray(cells, int)].ravel())
            member(name, k, cells)
if "point_tags" in mesh.point_data:
    for tag, named in getattr(mesh, "point_tags", {}).items():
        for name in named:
            add(name, numpy.flatnonzero(mesh.point_data["point_tags"] == tag))
data = {"cells " + kind: numpy.concatenate(blocks) for kind, blocks in found.items()}
data.update({"group " + name: nodes for name, nodes in groups.items()})
data.update({"part " + kind + " " + name: numpy.concatenate(rows) for (name, kind), rows in members.items()})
numpy.savez(output, points=points, others=numpy.array(sorted(others), dtype=str), **data)
""".replace("KINDS", repr(tuple(_ELEMENTS)))


@dataclass(frozen=True, eq=False)
class SolidMesh:
    """Nodes and solid elements.

    Attributes
    ----------
    positions : array, shape (nodes, 3)
        [m]; node n of CalculiX is row n - 1. Every node is used.
    elements : mapping of str to array of int, shape (elements, corners)
        Indices into `positions` by the kind of meshio.
    groups : mapping of str to array of int
        Numbers of nodes, from 1, by the name of a group.
    left_out : tuple of str
        Kinds of elements that are no solids.
    parts : mapping of str to mapping of str to array of int
        Rows of `elements` by the name of a group of elements, then by kind.
    """

    positions: FloatArray
    elements: Mapping[str, IntArray]
    groups: Mapping[str, IntArray]
    left_out: tuple[str, ...] = ()
    parts: Mapping[str, Mapping[str, IntArray]] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """Number of elements."""
        return sum(len(cells) for cells in self.elements.values())


def read_solid(path: Path, unit: float) -> SolidMesh:
    """Read a solid mesh.

    Parameters
    ----------
    path : Path
        A mesh of a format at the head of this module.
    unit : float
        Unit of its lengths [m].

    Raises
    ------
    InputError
        For what is no such mesh, or has more freedoms than are reduced.
    DependencyError
        If meshio is not installed.
    """
    check_file(path)
    content, words = run_apart(_READ, [str(path.absolute())], path.stat().st_size, "flexible", "meshio", str(path))
    try:
        with np.load(BytesIO(content), allow_pickle=False) as archive:
            found = {name: archive[name] for name in archive.files}
    except (OSError, ValueError, EOFError, KeyError) as error:
        raise InputError(
            f"{path}: cannot be read as a mesh ({words:.120}); allowed: {', '.join(MESHES)}; was it cut off?"
        ) from error
    cells = {name.removeprefix("cells "): found[name] for name in found if name.startswith("cells ")}
    others = tuple(str(name) for name in found["others"])
    if not cells:
        raise InputError(
            f"{path}: has no solid elements (got {', '.join(others) or 'none'}); allowed: {', '.join(_ELEMENTS)}"
        )
    points = np.asarray(found["points"], dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or not np.all(np.isfinite(points)):
        raise InputError(f"{path}: got points of shape {points.shape}; allowed: three finite coordinates a node")
    used = np.unique(np.concatenate([block.ravel() for block in cells.values()]))
    check_size(str(path), 3 * used.size)
    place = np.full(len(points), -1)
    place[used] = np.arange(used.size)
    groups: dict[str, IntArray] = {}
    parts: dict[str, dict[str, IntArray]] = {}
    for name, values in found.items():
        if name.startswith("part "):
            kind, _, own_name = name.removeprefix("part ").partition(" ")
            parts.setdefault(own_name, {})[kind] = values
        if name.startswith("group "):
            own = place[values]
            groups[name.removeprefix("group ")] = np.asarray(own[own >= 0] + 1, dtype=np.int64)
    elements = {kind: np.asarray(place[block], dtype=np.int64) for kind, block in cells.items()}
    return SolidMesh(unit * points[used], elements, groups, others, parts)


def materials_of(path: Path) -> dict[str, Material]:
    """Read the materials that a deck of Abaqus or Nastran states, in its own units; none of other meshes.

    They go by the groups of elements that have them; one that no group has, by an empty name.

    Parameters
    ----------
    path : Path
        The mesh.

    Raises
    ------
    InputError
        For numbers that are none.
    """
    ending = path.suffix.lower()
    if ending not in (".inp", ".bdf", ".nas", ".fem"):
        return {}
    lines = read_text(path, LONGEST_FILE, "a mesh").splitlines()
    rows, sections = (_abaqus(lines), _sections(lines)) if ending == ".inp" else (_nastran(lines), _properties(lines))
    problems = Problems()
    found = {}
    for name, (modulus, ratio, density) in rows:
        with problems:
            found[name] = Material(modulus, ratio, density)
    if problems:
        raise InputError([f"{path}: material: {problem}" for problem in problems])
    alone = list(dict.fromkeys(found.values()))
    if len(alone) < 2:
        return dict.fromkeys(("",) * len(alone), *alone)
    told = {group: found[name] for group, name in sections if name in found}
    if not told:
        raise InputError(
            f"{path}: material: got {len(alone)}, and no section that says which elements have them; allowed: *SOLID "
            "SECTION of Abaqus, PSOLID of Nastran; or --material 'GROUP = MATERIAL'"
        )
    return told


def _keyword(line: str) -> tuple[str, dict[str, str]]:
    """A keyword of Abaqus and its parameters, in capitals."""
    words = [word.strip() for word in line.strip().split(",")]
    pairs = (word.partition("=") for word in words[1:])
    return words[0].upper(), {key.strip().upper(): value.strip() for key, _, value in pairs}


def _sections(lines: list[str]) -> Iterator[tuple[str, str]]:
    """Set of elements and material of each *SOLID SECTION."""
    for line in lines:
        if line.lstrip().upper().startswith("*SOLID SECTION"):
            _, given = _keyword(line)
            yield given.get("ELSET", ""), given.get("MATERIAL", "").upper()


def _properties(lines: list[str]) -> Iterator[tuple[str, str]]:
    """Group of elements and material of each PSOLID."""
    for line in lines:
        if line.upper().startswith("PSOLID"):
            wide = 16 if line.upper().startswith("PSOLID*") else 8
            fields = line.split(",") if "," in line else [line[at : at + wide] for at in (8, 8 + wide)]
            pid, mid = (text.strip() for text in (fields[1:3] if "," in line else fields))
            yield f"property {pid}", mid


def _abaqus(lines: list[str]) -> Iterator[tuple[str, tuple[float, float, float]]]:
    """Name, modulus, ratio and density of each *MATERIAL."""
    values: dict[str, list[float]] = {}
    name = ""

    def done() -> Iterator[tuple[str, tuple[float, float, float]]]:
        if "ELASTIC" in values:
            modulus, ratio = (values["ELASTIC"] + [0.3, 0.3])[:2]
            yield name, (modulus, ratio, values.get("DENSITY", [0.0])[0])

    for k, line in enumerate(lines):
        keyword = line.strip().upper().split(",")[0]
        if keyword == "*MATERIAL":
            yield from done()
            values, name = {}, _keyword(line)[1].get("NAME", "").upper()
        elif keyword in ("*ELASTIC", "*DENSITY") and k + 1 < len(lines):
            values[keyword[1:]] = [_number(text) for text in lines[k + 1].split(",") if text.strip()]
    yield from done()


def _nastran(lines: list[str]) -> Iterator[tuple[str, tuple[float, float, float]]]:
    """Number, modulus, ratio and density of each MAT1."""
    for k, line in enumerate(lines):
        if not line.upper().startswith("MAT1"):
            continue
        if "," in line:
            fields = [text.strip() for text in line.split(",")]
        elif line.upper().startswith("MAT1*"):
            both = line[:72].ljust(72) + (lines[k + 1][8:72] if k + 1 < len(lines) else "")
            fields = ["MAT1", *(both[at : at + 16].strip() for at in range(8, len(both), 16))]
        else:
            fields = ["MAT1", *(line[at : at + 8].strip() for at in range(8, len(line), 8))]
        fields += [""] * (6 - len(fields))
        modulus, shear, ratio = (_number(text) if text else 0.0 for text in fields[2:5])
        if not ratio and modulus and shear:
            ratio = 0.5 * modulus / shear - 1.0
        density = _number(fields[5]) if fields[5] else 0.0
        yield fields[1], (modulus or 2.0 * shear * (1.0 + ratio), ratio, density)


def _number(text: str) -> float:
    """A number of a deck, which may leave out the letter of its power of ten; NaN where it is none."""
    try:
        return float(re.sub(r"(?<=[0-9.])([+-][0-9]+)$", r"e\1", text.strip().replace("D", "E").replace("d", "e")))
    except ValueError:
        return float("nan")


def assembled(mesh: SolidMesh, materials: Mapping[str, Material], folder: Path) -> tuple[Path, Path, Path, Path]:
    """Have CalculiX assemble stiffness and mass of a free body, in SI.

    Parameters
    ----------
    mesh : SolidMesh
        The mesh.
    materials : mapping of str to Material
        See `solid_lines`.
    folder : Path
        An empty folder for its files.

    Returns
    -------
    stiffness, mass, dofs, deck : Path
        Files that `mbs.flexible.plan.ReductionPlan` names.

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If it fails.
    """
    # a minute for each 100 000 elements on a machine of its own, ten on a busy one
    longest = LONGEST_RUN * max(1.0, mesh.count / 2e4)
    step = ("*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "1", "*END STEP")
    run_deck("\n".join((*solid_lines(mesh, materials), *step)) + "\n", folder, JOB, "assembling a mesh", longest)
    stiffness, mass, dofs, deck = (folder / f"{JOB}.{ending}" for ending in ("sti", "mas", "dof", "inp"))
    return stiffness, mass, dofs, deck


def solid_lines(mesh: SolidMesh, materials: Mapping[str, Material]) -> Iterator[str]:
    """Lines of a deck of CalculiX up to its steps: nodes, elements, materials.

    Parameters
    ----------
    mesh : SolidMesh
        The mesh.
    materials : mapping of str to Material
        Materials by groups of elements; that of the empty name is of all others.

    Raises
    ------
    InputError
        If an element has no material.
    """
    yield "*NODE, NSET=ALL"
    # CalculiX reads no more than 20 characters a number.
    for number, (x, y, z) in enumerate(mesh.positions.tolist(), start=1):
        yield f"{number},{x:.12e},{y:.12e},{z:.12e}"
    number = 0
    for kind, cells in mesh.elements.items():
        yield f"*ELEMENT, TYPE={_ELEMENTS[kind]}, ELSET=SOLID"
        for nodes in (cells + 1).tolist():
            number += 1
            yield from _listed(str(number), *map(str, nodes))
    names = list(materials)
    for place, numbers in enumerate(_of_materials(mesh, names)):
        material = materials[names[place]]
        yield f"*ELSET, ELSET=PART{place}"
        yield from _listed(*map(str, numbers.tolist()), ends=True)
        yield f"*MATERIAL, NAME=MATERIAL{place}"
        yield from ("*ELASTIC", f"{material.youngs_modulus:.12e},{material.poisson_ratio:.12e}")
        yield from ("*DENSITY", f"{material.density:.12e}")
        yield f"*SOLID SECTION, ELSET=PART{place}, MATERIAL=MATERIAL{place}"


def _listed(*words: str, ends: bool = False) -> Iterator[str]:
    """Lines of a list; each is whole, or goes on with the next one."""
    parts = [",".join(words[at : at + _PER_LINE]) for at in range(0, len(words), _PER_LINE)]
    yield ("\n" if ends else ",\n").join(parts)


def _of_materials(mesh: SolidMesh, names: list[str]) -> Iterator[IntArray]:
    """Numbers of the elements of each group; the empty name has what no other one has."""
    owner = np.full(mesh.count, names.index("") if "" in names else -1)
    for place, name in enumerate(names):
        first = 0
        for kind, cells in mesh.elements.items():
            owner[first + mesh.parts.get(name, {}).get(kind, np.zeros(0, dtype=np.int64))] = place
            first += len(cells)
    if np.any(owner < 0):
        raise InputError(
            f"--material: {int(np.sum(owner < 0))} of {mesh.count} elements have none; allowed: one for all others, "
            f"without a group; groups: {', '.join(mesh.parts) or 'none'}"
        )
    for place in range(len(names)):
        yield np.flatnonzero(owner == place) + 1
