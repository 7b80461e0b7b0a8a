"""`mbs reduce MESH`: meshes, groups, materials, places of seats and feet; bodies beside CalculiX' own modes."""

from __future__ import annotations

import re
import sys

import meshio
import numpy as np
import pytest

import mbs.cli
from ehdmaps.errors import InputError
from ehdmaps.physics.solids import MATERIALS, Material
from ehdmaps.solids.calculix import run_deck
from mbs.commands.scenes import reduce_mesh
from mbs.flexible import finite_elements
from mbs.flexible.matrix_files import read_dofs, read_triplets
from mbs.flexible.reduced_file import read_reduced
from mbs.flexible.solid_mesh import assembled, materials_of, read_solid, solid_lines
from tests.cases.programs import needed

SIZE = np.array([60.0, 40.0, 20.0])
"""Of a block [mm]."""


def block(parts=(6, 4, 2)) -> meshio.Mesh:
    """A block of hexahedra of second order, from the origin, with its ends as sets of nodes."""
    grid = np.stack(np.meshgrid(*(np.arange(2 * n + 1) for n in parts), indexing="ij"), axis=-1).reshape(-1, 3)
    shape = [2 * n + 1 for n in parts]
    corner = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]])
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    local = np.concatenate([corner, [(corner[a] + corner[b]) // 2 for a, b in edges]])
    first = 2 * np.stack(np.meshgrid(*(np.arange(n) for n in parts), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    cells = np.ravel_multi_index(tuple(np.moveaxis(first + local, 2, 0)), shape)
    used, cells = np.unique(cells, return_inverse=True)
    points = grid[used] / (2.0 * np.array(parts)) * SIZE
    sets = {name: np.flatnonzero(points[:, 0] == x) for name, x in (("LEFT", 0.0), ("RIGHT", SIZE[0]))}
    return meshio.Mesh(points, [("hexahedron20", cells.reshape(-1, 20))], point_sets=sets)


@pytest.fixture(scope="module")
def deck(tmp_path_factory):
    """The block as a deck of Abaqus with its material, in mm and t."""
    path = tmp_path_factory.mktemp("mesh") / "block.inp"
    block().write(path, file_format="abaqus")
    text = path.read_text() + "*MATERIAL, NAME=IRON\n*ELASTIC\n110000.0, 0.25\n*DENSITY\n7.2e-09\n"
    path.write_text(text)
    return path


def test_a_mesh_has_its_nodes_groups_and_material(deck) -> None:
    mesh = read_solid(deck, 1e-3)
    assert mesh.count == 48 and set(mesh.groups) == {"LEFT", "RIGHT"}
    assert np.ptp(mesh.positions, axis=0) == pytest.approx(1e-3 * SIZE)
    assert np.all(mesh.positions[mesh.groups["RIGHT"] - 1, 0] == 0.06)
    assert materials_of(deck) == {"": Material(110e3, 0.25, 7.2e-9)}


@pytest.mark.parametrize(
    ("name", "text", "found"),
    [
        ("a.bdf", "MAT1    1       2.1+5           .3      7.85-9", [(2.1e5, 0.3, 7.85e-9)]),
        ("a.bdf", "MAT1,1,2.1+5,,.3,7.85-9", [(2.1e5, 0.3, 7.85e-9)]),
        ("a.bdf", "MAT1,1,2.6+5,1.+5,,7.85-9", [(2.6e5, 0.3, 7.85e-9)]),
        (
            "a.nas",
            "MAT1*   1               2.1E+11                         0.3\n*       7850.\n",
            [(2.1e11, 0.3, 7850.0)],
        ),
        ("a.inp", "*Material, name=A\n*Density\n7850.,\n*Elastic\n2.1e11, 0.3\n", [(2.1e11, 0.3, 7850.0)]),
        ("a.inp", "*NODE\n1,0,0,0\n", []),
        ("a.msh", "$MeshFormat", []),
    ],
)
def test_materials_of_decks(tmp_path, name, text, found) -> None:
    path = tmp_path / name
    path.write_text(text)
    assert [(one.youngs_modulus, one.poisson_ratio, one.density) for one in materials_of(path).values()] == [
        pytest.approx(row) for row in found
    ]


def halves(tmp_path):
    """The block as a deck of two sets of elements, each with a material."""
    mesh = block()
    left = mesh.points[mesh.cells[0].data].mean(axis=1)[:, 0] < 0.5 * SIZE[0]
    mesh.cell_sets = {"IN": [np.flatnonzero(left)], "OUT": [np.flatnonzero(~left)]}
    path = tmp_path / "two.inp"
    mesh.write(path, file_format="abaqus")
    more = "".join(
        f"*MATERIAL, NAME={name}\n*ELASTIC\n{modulus}, {ratio}\n*DENSITY\n{density}\n"
        for name, modulus, ratio, density in (("iron", 110e3, 0.25, 7.2e-9), ("alu", 70e3, 0.33, 2.7e-9))
    )
    sections = "*SOLID SECTION, ELSET=IN, MATERIAL=Iron\n*SOLID SECTION, ELSET=OUT, MATERIAL=ALU\n"
    path.write_text(path.read_text() + more + sections)
    return path


def test_materials_by_groups_of_elements(tmp_path) -> None:
    path = halves(tmp_path)
    assert materials_of(path) == {"IN": Material(110e3, 0.25, 7.2e-9), "OUT": Material(70e3, 0.33, 2.7e-9)}
    path.write_text(re.sub(r"(?m)^\*SOLID.*\n", "", path.read_text()))
    with pytest.raises(InputError, match="got 2, and no section that says which elements have them"):
        materials_of(path)
    mesh = read_solid(path, 1e-3)
    assert {name: sum(map(len, rows.values())) for name, rows in mesh.parts.items()} == {"IN": 24, "OUT": 24}
    with pytest.raises(
        InputError,
        match=r"--material: 24 of 48 elements have none; allowed: .*; groups: IN, OUT",
    ):
        list(solid_lines(mesh, {"IN": MATERIALS["steel"]}))


@pytest.mark.slow
def test_a_body_of_two_materials_has_the_mass_of_both(tmp_path) -> None:
    needed("ccx")
    mesh = read_solid(halves(tmp_path), 1e-3)
    folder = tmp_path / "ccx"
    folder.mkdir()
    _, mass, dofs, _ = assembled(mesh, {"": MATERIALS["steel"], "OUT": MATERIALS["aluminium"]}, folder)
    labels = read_dofs(dofs)
    matrix = read_triplets(mass, *labels).matrix
    along = (labels[1] == 0).astype(float)
    half = 0.5e-9 * float(np.prod(SIZE))
    # consistent mass of second order: exact but for the digits of the file
    expected = half * (MATERIALS["steel"].density + MATERIALS["aluminium"].density)
    assert along @ (matrix @ along) == pytest.approx(expected, rel=1e-9)


def run(capsys, *words: str) -> tuple[int, str, str]:
    """Exit status and what was printed."""
    status = mbs.cli.main(["reduce", *words])
    out, err = capsys.readouterr()
    return status, out, err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "--seat: got none"),
        (["--seat", "a=LEFT", "--units", "inch"], "--units: got 'inch'"),
        (["--seat", "a=LEFT", "--units", "m"], "--units: got 'm', but E is 1.1e+05"),
        (["--seat", "a=LEFT", "--units", "mm", "--material", "wood"], "--material: got 'wood'"),
        (["--seat", "a=LEFT", "--material", "steel"], "--units: got none"),
        (["--seat", "a=LEFT", "--cutoff", "5"], "--cutoff: got '5' without a unit"),
        (["--seat", "a=LEF"], "did you mean 'LEFT'"),
        (["--seat", "a = 0 0 0 mm, 5 mm, x"], "DIAMETER mm x WIDTH mm"),
        (["--seat", "a=LEFT", "--foot", "a=RIGHT"], "got 'a' twice"),
        (["--seat", "a=LEFT", "--point", "p = here"], "--point: got 'p = here'"),
        (["--seat", "a=LEFT", "-o", "block.inp"], "block.inp"),
    ],
)
def test_bad_input(deck, tmp_path, monkeypatch, capsys, words, told) -> None:
    needed("ccx")
    monkeypatch.chdir(deck.parent)
    status, _, err = run(capsys, "block.inp", *words)
    assert status == 2
    assert told in err


def test_without_calculix_it_is_said_before_a_mesh_is_read(deck, monkeypatch, capsys) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    status, _, err = run(capsys, str(deck), "--seat", "a=LEFT")
    assert status == 2 and "apt-get install calculix-ccx" in err


def test_large_bodies_need_an_extra_which_is_said_before_calculix_runs(deck, tmp_path, monkeypatch, capsys) -> None:
    needed("ccx")
    monkeypatch.setattr(finite_elements, "MOST_BY_LU", 1000)
    monkeypatch.setitem(sys.modules, "cvxopt", None)
    status, _, err = run(capsys, str(deck), "--seat", "a=LEFT", "-o", str(tmp_path / "a.nc"))
    assert status == 2 and "1047 degrees of freedom, more than 1000: the package cvxopt cannot be loaded" in err
    assert 'pip install "ehdmaps[large]"' in err and "assembled" not in err


def test_what_memory_does_not_hold_is_refused_before_calculix_runs(deck, tmp_path, monkeypatch, capsys) -> None:
    needed("ccx")
    monkeypatch.setattr(reduce_mesh, "_available", lambda: 0.3)
    status, _, err = run(capsys, str(deck), "--seat", "a=LEFT", "-o", str(tmp_path / "a.nc"))
    assert status == 2 and "allowed: the 0.3 GB that are free; take a coarser mesh" in err


def test_shells_alone_are_no_body(tmp_path) -> None:
    path = tmp_path / "a.msh"
    meshio.Mesh(np.eye(3), [("triangle", [[0, 1, 2]])]).write(path, file_format="gmsh22", binary=False)
    with pytest.raises(InputError, match="no solid elements"):
        read_solid(path, 1.0)


def test_a_block_is_that_of_calculix(deck, tmp_path, capsys) -> None:
    """Mass of a closed form to round-off; ten free modes beside those that CalculiX finds itself.

    Modes that are kept up to 180 kHz leave those up to 43 kHz as they are to 1e-3, and a seat whose ring follows the
    mean of its nodes stiffens nothing.
    """
    needed("ccx")
    target = tmp_path / "block.nc"
    words = ("--seat", "left=LEFT", "--point", "s = 30 20 20 mm")
    status, out, _ = run(capsys, str(deck), *words, "--cutoff", "180 kHz", "-o", str(target))
    assert status == 0 and "material of the file, E 110 GPa" in out and "lengths in mm" in out
    body = read_reduced(target)
    assert set(body.frames) == {"left", "s"}
    mass = 7200.0 * float(np.prod(1e-3 * SIZE))
    assert f"{mass:.6g} kg" in out
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(body.mass, body.stiffness)).real)
    rigid, elastic = squares[:6], np.sqrt(squares[6:16]) / (2.0 * np.pi)
    assert np.all(np.sqrt(np.abs(rigid)) / (2.0 * np.pi) < 1e-3 * elastic[0])
    mesh = read_solid(deck, 1e-3)
    step = ("*STEP", "*FREQUENCY", "16", "*END STEP")
    run_deck(
        "\n".join((*solid_lines(mesh, {"": Material(110e9, 0.25, 7200.0)}), *step)) + "\n", tmp_path, "own", "the test"
    )
    rows = [line.split() for line in (tmp_path / "own.dat").read_text().splitlines()]
    own = [float(row[3]) for row in rows if len(row) == 5 and re.fullmatch(r"\d+", row[0])][6:16]
    assert elastic == pytest.approx(own, rel=1e-3)


def test_all_kinds_of_elements_are_assembled(tmp_path) -> None:
    """A cube of one element of first order of each kind: their mass is that of the solid."""
    needed("ccx")
    cube = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
    path = tmp_path / "a.msh"
    cells = [("wedge", [[0, 1, 2, 4, 5, 6]]), ("tetra", [[0, 2, 3, 7]])]
    meshio.Mesh(cube, cells).write(path, file_format="gmsh22", binary=False)
    mesh = read_solid(path, 1.0)
    assert mesh.count == 2
    _, mass, dofs, _ = assembled(mesh, {"": MATERIALS["steel"]}, tmp_path)
    rows = np.loadtxt(mass, ndmin=2)
    whole = np.sum(np.where(rows[:, 0] == rows[:, 1], 1.0, 2.0) * rows[:, 2]) / 3.0
    assert whole == pytest.approx(7850.0 * (0.5 + 1.0 / 6.0), rel=1e-9)
    assert len(dofs.read_text().split()) == 24


@pytest.mark.parametrize("begin", ["BEGIN BULK\n", ""])
def test_bulk_of_nastran_with_and_without_its_head(tmp_path, begin) -> None:
    """Gmsh leaves out BEGIN BULK."""
    path = tmp_path / "a.bdf"
    grids = "".join(f"GRID,{k + 1},,{x},{y},{z}\n" for k, (x, y, z) in enumerate(np.vstack([np.zeros(3), np.eye(3)])))
    path.write_text(f"{begin}{grids}CTETRA,1,1,1,2,3,4\nMAT1,1,2.1+5,,.3,7.85-9\nENDDATA\n")
    mesh = read_solid(path, 1e-3)
    assert mesh.count == 1 and mesh.positions.max() == pytest.approx(1e-3)
