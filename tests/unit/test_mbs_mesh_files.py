"""Places of nodes in meshes of every format, and that a body which moves as one is not strained."""

from __future__ import annotations

import importlib.util
import subprocess
import sys

import meshio
import numpy as np
import pytest
from scipy import sparse

from ehdmaps.errors import InputError
from mbs.flexible.finite_elements import FiniteElementModel, NodePositions, extent
from mbs.flexible.matrix_files import assemble_model, read_abaqus_matrix
from mbs.flexible.mesh_files import read_mesh_nodes
from mbs.flexible.nastran_files import entries, read_nastran
from mbs.flexible.rigid_motion import strained
from mbs.flexible.skin import read_skin
from tests.cases.flexible import block, upper

NEEDS_PYNASTRAN = pytest.mark.skipif(importlib.util.find_spec("pyNastran") is None, reason="needs pyNastran")
NEEDS_GMSH = pytest.mark.skipif(importlib.util.find_spec("gmsh") is None, reason="needs gmsh")

POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2], [5, 5, 5]])
NUMBERS = np.array([7, 3, 12, 5, 40])
TETRA = np.array([[7, 3, 12, 5]])
"""Out of order, with gaps, and a node of no element."""


def msh(version, binary, parametric=False):
    """A mesh of Gmsh of one tetrahedron, as its manual describes the format."""

    def put(kind, values):
        if binary:
            return np.asarray(values, kind).tobytes()
        return " ".join(str(value) for value in np.ravel(values).tolist()).encode() + b"\n"

    end = b"\n" if binary else b""
    head = f"$MeshFormat\n{version} {int(binary)} 8\n".encode() + (put("<i4", [1]) + end if binary else b"")
    head += b"$EndMeshFormat\n$Nodes\n"
    if version == "2.2":
        nodes = b"5\n" + b"".join(put("<i4", [n]).strip(b"\n" * (not binary)) + b" " * (not binary) + put("<f8", p)
                                  for n, p in zip(NUMBERS, POINTS, strict=True))  # fmt: skip
        elements = b"1\n" + (put("<i4", [4, 1, 0, 1, *TETRA[0]]) if binary else b"1 4 0 7 3 12 5\n")
    else:
        nodes = put("<u8", [2, 5, 3, 40])
        for begin, stop, dimension in ((0, 2, 1), (2, 5, 3)):
            here = parametric and dimension < 3
            rows = np.hstack([POINTS[begin:stop], np.full((stop - begin, dimension * here), 0.5)])
            nodes += put("<i4", [dimension, 1, int(here)]) + put("<u8", [stop - begin])
            nodes += put("<u8", NUMBERS[begin:stop]) + put("<f8", rows)
        elements = put("<u8", [1, 1, 1, 1]) + put("<i4", [3, 1, 4]) + put("<u8", [1]) + put("<u8", [1, *TETRA[0]])
    return head + nodes + end + b"$EndNodes\n$Elements\n" + elements + end + b"$EndElements\n"


def bulk(*cards):
    """Bulk data of the same tetrahedron; the places of three nodes in systems of their own."""
    places = {
        7: "GRID,7,,0.,0.,0.",
        3: "GRID           3       9      0.      0.      1.",  # cylindrical about x: radius, angle, along
        12: f"GRID*   {12:16d}{'':16}{0.0:16.9f}{1.0:16.9f}*\n*       {0.0:16.9f}",
        5: "GRID,5,9,2.,90.,0.,,,",
        40: "GRID,40,8,5.,5.,3.",
    }
    systems = "CORD2C,9,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\nCORD2R,8,,0.,0.,2.,0.,0.,3.\n,1.,0.,2.\n"
    lines = [places[n] for n in NUMBERS] + ["CTETRA,1,1,7,3,12,5", *cards]
    return "BEGIN BULK\n" + systems + "\n".join(lines) + "\nENDDATA\n"


def is_it(found):
    order = np.argsort(NUMBERS)
    place = np.argsort(found.numbers)
    np.testing.assert_array_equal(found.numbers[place], NUMBERS[order])
    np.testing.assert_allclose(found.positions[place], POINTS[order], atol=1e-12)  # round-off of a turn


@pytest.mark.parametrize(
    ("version", "binary", "parametric"),
    [("2.2", False, False), ("2.2", True, False), ("4.1", False, False), ("4.1", True, False), ("4.1", True, True)],
)
def test_numbers_of_gmsh(tmp_path, version, binary, parametric):
    path = tmp_path / "a.msh"
    path.write_bytes(msh(version, binary, parametric))
    is_it(read_mesh_nodes(path))
    path.write_bytes(path.read_bytes().replace(b"\n$EndNodes" if not binary else b"$EndNodes", b""))
    with pytest.raises(InputError, match=r"cannot be read as a mesh of Gmsh \(.*\); allowed: one that is whole"):
        read_mesh_nodes(path)
    path.write_bytes(msh(version, binary)[:120])
    with pytest.raises(InputError, match="cannot be read as a mesh of Gmsh"):
        read_mesh_nodes(path)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"(0 grid)\n", "is no mesh of Gmsh of a version that is read"),
        (msh("2.2", False).replace(b"2.2", b"4.0"), "got '4.0'"),
        (msh("2.2", True).replace(b"\1\0\0\0", b"\0\0\0\1", 1), "another order of bytes"),
        (msh("2.2", False).replace(b"\n7 ", b"\n3 "), "got a number of a node twice"),
        (msh("2.2", False).replace(b"\n7 0.0", b"\n7 nan"), "positions that are no finite numbers"),
        (msh("2.2", False).replace(b"\n7 ", b"\n0 "), "numbers of nodes that are none"),
        (msh("4.1", False).replace(b"2 5 3 40", b"2 6 3 40"), "5 nodes and not 6"),
        (msh("4.1", False).replace(b"2 5 3 40", b"2 -5 3 40").replace(b"1 1 0\n2\n", b"1 1 0\n-2\n"), "does not hold"),
    ],
)
def test_meshes_of_gmsh_that_are_refused(tmp_path, content, words):
    path = tmp_path / "a.msh"
    path.write_bytes(content)
    with pytest.raises(InputError, match=words):
        read_mesh_nodes(path)


@pytest.mark.slow
@NEEDS_GMSH
def test_meshes_that_gmsh_writes(tmp_path):
    """Gmsh itself says which node is where: second order, numbers that are no order, in every form that is read."""
    script = """
import gmsh, numpy, sys
folder = sys.argv[1]
gmsh.initialize(["", "-v", "0"])
gmsh.model.occ.addBox(0, 0, 0, 2, 1, 1)
gmsh.model.occ.synchronize()
gmsh.option.setNumber("Mesh.MeshSizeMin", 0.7)
gmsh.model.mesh.generate(3)
gmsh.model.mesh.setOrder(2)
old = gmsh.model.mesh.getNodes()[0]
gmsh.model.mesh.renumberNodes(old, 10 + 3 * old[::-1])
for name, version, binary in (("a", 2.2, 0), ("b", 2.2, 1), ("c", 4.1, 0), ("d", 4.1, 1)):
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.option.setNumber("Mesh.SaveParametric", int(name == "d"))
    gmsh.write(f"{folder}/{name}.msh")
said = {}
for name in "abcd":
    gmsh.clear()
    gmsh.open(f"{folder}/{name}.msh")
    tags, places, _ = gmsh.model.mesh.getNodes()
    said[name] = numpy.column_stack([tags, places.reshape(-1, 3)])[numpy.argsort(tags)]
numpy.savez(f"{folder}/said.npz", **said)
"""
    subprocess.run([sys.executable, "-c", script, str(tmp_path)], check=True, timeout=120, capture_output=True)
    with np.load(tmp_path / "said.npz") as said:
        for name in "abcd":
            found = read_mesh_nodes(tmp_path / f"{name}.msh")
            rows = np.column_stack([found.numbers, found.positions])[np.argsort(found.numbers)]
            np.testing.assert_allclose(rows, said[name], atol=1e-15)  # 16 digits
        assert said["c"][0, 0] > 1.0  # Gmsh gives no numbers of its own to what it writes


@pytest.mark.slow
class TestOtherPrograms:
    @pytest.mark.parametrize("name", ["a.vtk", "a.vtu", "a.mesh", "a.su2", "a.vol", "a.med", "a.e"])
    def test_points_in_order(self, tmp_path, name):
        path = tmp_path / name
        meshio.write(path, meshio.Mesh(POINTS, [("tetra", np.array([[0, 1, 2, 3]]))]))
        found = read_mesh_nodes(path)
        np.testing.assert_array_equal(found.numbers, np.arange(1, 6))
        np.testing.assert_allclose(found.positions, POINTS)

    def test_numbers_beside_points(self, tmp_path):
        import h5py
        import netCDF4

        mesh = meshio.Mesh(POINTS, [("tetra", np.array([[0, 1, 2, 3]]))])
        for name in ("a.med", "a.e"):
            mesh.write(tmp_path / name)
        with h5py.File(tmp_path / "a.med", "a") as file:
            nodes = []
            file["ENS_MAA"].visit(lambda key: nodes.append(key) if key.endswith("NOE") else None)
            file[f"ENS_MAA/{nodes[0]}"].create_dataset("NUM", data=NUMBERS)
        with netCDF4.Dataset(tmp_path / "a.e", "a") as file:
            file.createVariable("node_num_map", "i4", ("num_nodes",))[:] = NUMBERS
        is_it(read_mesh_nodes(tmp_path / "a.med"))
        is_it(read_mesh_nodes(tmp_path / "a.e"))
        np.testing.assert_array_equal(np.unique(read_skin(tmp_path / "a.e")), np.sort(TETRA[0]))

    def test_skins_have_the_numbers_of_the_file(self, tmp_path):
        for name, content in (("a.msh", msh("4.1", False)), ("b.bdf", bulk().encode())):
            (tmp_path / name).write_bytes(content)
            np.testing.assert_array_equal(np.unique(read_skin(tmp_path / name)), np.sort(TETRA[0]))

    def test_points_that_the_library_does_not_find(self, tmp_path):
        path = tmp_path / "a.mesh"
        meshio.write(path, meshio.Mesh(POINTS, [("tetra", np.array([[0, 1, 2, 3]]))]))
        path.write_text(path.read_text() + "\nVertices\n3\n")
        with pytest.raises(InputError, match=r"meshio finds 5 points of 8 nodes|cannot be read as a mesh"):
            read_mesh_nodes(path)

    @NEEDS_PYNASTRAN
    def test_grids(self, tmp_path):
        path = tmp_path / "a.bdf"
        path.write_text(bulk())
        is_it(read_mesh_nodes(path))

    @NEEDS_PYNASTRAN
    @pytest.mark.parametrize(
        ("card", "words"),
        [
            ("GRID,x,,0.,0.,0.", "got a GRID of number 'x'"),
            ("GRID,8,,0.,0.,0.\n=,9,=,1.,=,=", "got '=,9,=,1.,=,='; allowed: each entry written out"),
            ("GRID,8,,0.,0.,0.,,,,,1.", "allowed: up to 10 fields a line, 8 of them data"),
        ],
    )
    def test_bulk_data_that_is_refused(self, tmp_path, card, words):
        path = tmp_path / "a.bdf"
        path.write_text(bulk(card))
        with pytest.raises(InputError, match=words):
            read_mesh_nodes(path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "*NODE\n1,0,0,0\n*SYSTEM\n0,0,0,1,0,0\n0,0,1\n*NODE\n2,1,0,0\n",
            r"line 3: got '\*SYSTEM'; allowed: nodes in one",
        ),
        ("*NODE\n1,0,0,0\n9,8,0,0\n*NGEN, NSET=a\n1,9\n", r"line 4: .*NGEN.*; allowed: each node written out"),
        ("*NODE\n1,0,0,0\n*nfill\n", "allowed: each node written out"),
        ("*NODE\n1,0,0,0\n*TRANSFORM, NSET=a\n", "allowed: displacements along one system"),
        ("*NODE, INPUT=far.txt\n*NODE\n1,0,0,0\n", "line 1: .*; allowed: a deck with its nodes in it"),
        ("*NODE, system = C\n1,0,0,0\n", "allowed: rectangular coordinates"),
        (
            "*PART, NAME=a\n*NODE\n1,0,0,0\n*END PART\n*PART, NAME=b\n*NODE\n1,1,0,0\n",
            "line 7: got '1,1,0,0'; allowed: one place for each node; node 1 has another one; write the deck without",
        ),
        (
            "*PART, NAME=a\n*NODE\n1,0,0,0\n*END PART\n*INSTANCE, NAME=a-1, PART=a\n0.,0.,0.\n0,0,0, 1,0,0, 90.\n",
            "line 7: got '0,0,0, 1,0,0, 90.'; allowed: a part that is not moved",
        ),
        (
            "*PART, NAME=a\n*NODE\n1,0,0,0\n*END PART\n*INSTANCE, NAME=i, PART=a\n*END INSTANCE\n"
            "*INSTANCE, NAME=j, part=A\n",
            "line 7: .*; allowed: each part once",
        ),
    ],
)
def test_decks_whose_nodes_are_elsewhere(tmp_path, text, words):
    path = tmp_path / "a.inp"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        read_mesh_nodes(path)


def test_a_part_that_stays_where_it_is(tmp_path):
    path = tmp_path / "a.inp"
    path.write_text("*PART, NAME=a\n*NODE\n1,1,2,3\n*END PART\n*INSTANCE, NAME=i, PART=a\n0., 0, -0.0\n*END INSTANCE\n")
    assert read_mesh_nodes(path).positions.tolist() == [[1.0, 2.0, 3.0]]


# a body that moves as one


def deck(model, numbers):
    """A deck of the nodes of a model, with other numbers."""
    rows = zip(numbers, model.positions.tolist(), strict=True)
    return "*NODE\n" + "".join(f"{n}, {x:.9g}, {y:.9g}, {z:.9g}\n" for n, (x, y, z) in rows)


def bent(model):
    """Deflection of the far end of a block by 1 kN along z on it [m], from the matrices alone."""
    far = model.numbers[model.positions[:, 0] >= model.positions[:, 0].max() - 1e-9]
    rows = np.array([model.row(int(node), 2) for node in far])
    force = np.zeros(model.size)
    force[rows] = 1e3 / rows.size
    return float(np.mean(sparse.linalg.spsolve(model.stiffness, force)[rows]))


def test_mass_centre_and_deflection_do_not_depend_on_the_numbers(tmp_path):
    model = block((6, 2, 2), fixed=True)
    numbers = np.random.default_rng(1).permutation(model.numbers.size) * 3 + 5
    own = dict(zip(model.numbers.tolist(), numbers.tolist(), strict=True))
    labels = [(own[n], d + 1) for n, d in zip(model.nodes.tolist(), model.directions.tolist(), strict=True)]
    for name in ("stiffness", "mass"):
        (tmp_path / f"{name}.mtx").write_text(upper(getattr(model, name).toarray(), labels))
    (tmp_path / "right.inp").write_text(deck(model, numbers))
    (tmp_path / "shifted.inp").write_text(deck(model, np.roll(numbers, 1)))
    matrices = [read_abaqus_matrix(tmp_path / f"{name}.mtx") for name in ("stiffness", "mass")]
    found = assemble_model(*matrices, read_mesh_nodes(tmp_path / "right.inp"))
    assert extent(found).mass == pytest.approx(extent(model).mass, rel=1e-12)
    assert extent(found).centre == pytest.approx(extent(model).centre, rel=1e-9)  # nine digits of a place
    assert bent(found) == pytest.approx(bent(model), rel=1e-9)
    with pytest.raises(InputError, match=r"a turn of the whole body strains .* allowed: nodes where the mesh"):
        assemble_model(*matrices, read_mesh_nodes(tmp_path / "shifted.inp"))


def moved(model, **changes):
    """A model with other parts."""
    kept = {name: getattr(model, name) for name in ("stiffness", "mass", "nodes", "directions", "numbers", "positions")}
    return FiniteElementModel(**kept | changes)


class TestStrained:
    @pytest.mark.parametrize("fixed", [False, True])
    def test_sound_bodies(self, fixed):
        """Far from the origin, with five digits of the stiffness and places to a thousandth of an element."""
        model = block((6, 2, 2), fixed=fixed)
        random = np.random.default_rng(0)
        spoilt = sparse.coo_array(sparse.triu(model.stiffness))
        size = 10.0 ** (np.floor(np.log10(np.abs(spoilt.data))) - 4)
        half = sparse.csc_array((np.round(spoilt.data / size) * size, (spoilt.row, spoilt.col)), shape=spoilt.shape)
        whole = half + half.T - sparse.diags_array(half.diagonal())
        places = model.positions + 1e-5 * random.uniform(-1.0, 1.0, model.positions.shape) + np.array([3.0, -20.0, 1.0])
        found = strained(moved(model, stiffness=whole, positions=places))
        assert found.displaced.size == 0
        # What is held next to: one layer of six.
        assert found.held.size == (9 if fixed else 0)
        assert found.nodes == (54 if fixed else 63)

    def test_nodes_that_are_elsewhere(self, monkeypatch):
        """A few nodes, such as the arms of a seat; one part turned; length in another unit for some. In many pieces."""
        monkeypatch.setattr("mbs.flexible.rigid_motion._BLOCK", 1000)
        model = block((10, 2, 2))
        far = model.positions[:, 0] > 0.19
        quarter = np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]])
        turned = np.where(far[:, None], model.positions @ quarter.T, model.positions)
        pushed = model.positions + np.where(far[:, None], [0.01, 0.0, 0.0], 0.0)
        for places in (turned, pushed, np.where(far[:, None], 1e-3 * model.positions, model.positions)):
            found = strained(moved(model, positions=places))
            assert found.held.size == 0
            # Those nodes, or their neighbours.
            assert found.displaced.size >= 9
            with pytest.raises(InputError, match=r"a turn of the whole body strains"):
                check(moved(model, positions=places))

    def test_a_spring_between_nodes_apart_is_told(self):
        """Across the line between two nodes of many: a turn strains it, and the body is sound."""
        model = block((20, 2, 2))
        rows = [model.row(model.numbers[0], 2), model.row(model.numbers[20], 2)]
        spring = sparse.coo_array(([1e9, 1e9, -1e9, -1e9], ([0, 1, 0, 1], [0, 1, 1, 0])), shape=(2, 2))
        whole = sparse.lil_array(model.stiffness)
        for k, m, value in zip(spring.row, spring.col, spring.data, strict=True):
            whole[rows[k], rows[m]] += value
        found = strained(moved(model, stiffness=sparse.csc_array(whole)))
        assert found.displaced.tolist() == model.numbers[[0, 20]].tolist()
        assert "springs between nodes apart" in found.warnings()[0]
        assert strained(model).warnings() == ()
        check(moved(model, stiffness=sparse.csc_array(whole)))

    def test_values_that_were_lost(self):
        """Beside the diagonal a few values are left, as of rows that were cut off."""
        model = block((10, 2, 2))
        left = sparse.csc_array(sparse.diags_array(model.stiffness.diagonal()))
        with pytest.raises(InputError, match=r"a shift of the whole body strains 99 of 99 nodes.* were values lost"):
            check(moved(model, stiffness=left))

    def test_beams_and_modes(self):
        """Beams along any direction, whose rows mix forces and moments; a coordinate of a mode stays where it is."""
        length, along = 0.3, np.array([2.0, -1.0, 2.0]) / 3.0
        stiff = sparse.csc_array(beam(along, length))
        nodes, directions = np.repeat([1, 2], 6), np.tile(np.arange(6), 2)
        whole = sparse.block_diag([stiff, sparse.csc_array([[4.0]])], format="csc")
        model = FiniteElementModel(
            whole,
            sparse.eye_array(13, format="csc"),
            np.append(nodes, 9),
            np.append(directions, 3),
            np.array([1, 2]),
            np.array([[5.0, 5.0, 5.0], 5.0 + length * along]),
        )
        found = strained(model)
        assert (found.held.size, found.displaced.size, found.nodes) == (0, 0, 2)
        found = strained(moved(model, positions=model.positions * 1.1))
        assert found.displaced.tolist() == [1, 2]


def check(model):
    """The check as readers make it."""
    from mbs.flexible.matrix_files import Labelled

    labels = model.nodes, model.directions
    both = (Labelled(matrix, *labels) for matrix in (model.stiffness, model.mass))
    assemble_model(*both, NodePositions(model.numbers, model.positions))


def beam(along, length, stretch=4e8, twist=3e3, bend=2e4):
    """Stiffness of a slender beam of two nodes, of its closed form, shape (12, 12)."""
    across = np.cross(along, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    axes = np.kron(np.eye(4), np.array([along, across, np.cross(along, across)]))
    one, matrix = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.zeros((12, 12))
    matrix[np.ix_([0, 6], [0, 6])] = stretch / length * one
    matrix[np.ix_([3, 9], [3, 9])] = twist / length * one
    for rows, sign in (([1, 5, 7, 11], 1.0), ([2, 4, 8, 10], -1.0)):
        h = sign * length
        matrix[np.ix_(rows, rows)] = (
            bend / length**3 * np.array([
                [12.0, 6 * h, -12, 6 * h],
                [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                [-12, -6 * h, 12, -6 * h],
                [6 * h, 2 * h * h, -6 * h, 4 * h * h],
            ])
        )  # fmt: skip
    return axes.T @ matrix @ axes


# DMIG entries, counted


HEAD = "DMIG,K,0,6,2,0\nDMIG,M,0,6,2,0\nGRID,1,,0.,0.,0.\n"
END = "DMIG,{0},1,2,,1,2,2.,,+a\n+a,1,3,.5\nDMIG,{0},1,3,,1,3,2.\n"
ROWS = {
    "right": "DMIG,{0},1,1,,1,1,2.\n,1,2,0.5,,1,3,0.25\n" + END,
    "large": "DMIG*,{0},1,1,\n*,1,1,2.,\n*,1,2,0.5\n*,1,3,.25\nDMIG*,{0},1,2,\n*,1,2,2.\n*,1,3,0.5\n"
    "DMIG*,{0},1,3\n*,1,3,2.\n",
    "long row": "DMIG,{0},1,1,,1,1,2.,,1,2,0.5,,1,3,0.25\nDMIG,{0},1,2,,1,2,2.,,1,3,.5\nDMIG,{0},1,3,,1,3,2.\n",
    "long line": "DMIG,{0},1,1,,1,1,2.\n,1,2,0.5,,1,3,0.25,,1,4,0.5\nDMIG,{0},1,3,,1,3,2.\n",
    "long large": "DMIG*,{0},1,1,,1,1,2.\n*,1,2,0.5,,1,3,.25\n" + END,
}


@pytest.mark.slow
@NEEDS_PYNASTRAN
@pytest.mark.parametrize("name", ROWS)
def test_rows_are_read_whole_or_refused(tmp_path, name):
    path = tmp_path / "a.bdf"
    path.write_text(HEAD + "".join(ROWS[name].format(matrix) for matrix in "KM"))
    if name.startswith("long"):
        with pytest.raises(
            InputError, match=r"line \d+: got .*; allowed: up to (10|6) fields a line, (8|4) of them data"
        ):
            read_nastran(path, path, path, ("K", "M"))
    else:
        model = read_nastran(path, path, path, ("K", "M"))
        assert model.stiffness.toarray().tolist() == [[2.0, 0.5, 0.25], [0.5, 2.0, 0.5], [0.25, 0.5, 2.0]]


@pytest.mark.slow
@NEEDS_PYNASTRAN
def test_values_that_the_library_does_not_find(tmp_path, monkeypatch):
    path = tmp_path / "a.bdf"
    path.write_text(HEAD + "".join(ROWS["long row"].format(matrix) for matrix in "KM"))
    monkeypatch.setattr("mbs.flexible.nastran_files._split", lenient)
    with pytest.raises(
        InputError, match=r"DMIG K: pyNastran finds 3 values where the file has 6; allowed: rows"
    ) as caught:
        read_nastran(path, path, path, ("K", "M"))
    assert "DMIG M" in caught.value.problems[1]


def lenient(text):
    """Fields of a line of any length."""
    first, *fields = text.split(",")
    return first, fields, False


def test_entries_of_bulk_data(tmp_path):
    path = tmp_path / "a.bdf"
    path.write_text(
        "GRID,9\nBEGIN BULK\n$ c\ngrid,1,,1. $ c\n,2\nPARAM,X,1,,,,,,,,9\nGRID*\t2\n*\t3\nENDDATA\nGRID,4\n"
    )
    found = list(entries(path, ("GRID",)))
    assert [(entry.line, entry.name) for entry in found] == [(4, "GRID"), (7, "GRID")]
    assert found[0].fields == ["1", "", "1.", "", "", "", "", "", "2", *[""] * 7]
    assert found[1].fields == ["2", "", "", "", "3", "", "", ""]
