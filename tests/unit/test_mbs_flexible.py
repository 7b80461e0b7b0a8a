"""Matrices, spiders, reduced bodies and their files: what is read, and that every slip is found and said."""

from __future__ import annotations

import argparse
import re
import sys

import meshio
import numpy as np
import pytest
from scipy import io, sparse
from scipy.sparse.linalg import ArpackError

from ehdmaps.errors import DependencyError, InputError
from ehdmaps.jobs.table import Table
from mbs import cli
from mbs.commands import reduce as command
from mbs.errors import AnalysisError
from mbs.flexible import held_body
from mbs.flexible.calculix import check_deck, read_calculix, read_dofs
from mbs.flexible.extent import Extent, extent
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.matrix_files import (
    Labelled,
    NodePositions,
    assemble_model,
    read_abaqus_matrix,
    read_dof_table,
    read_matrix_market,
    read_triplets,
    without_fixed,
)
from mbs.flexible.mesh import read_mesh_nodes
from mbs.flexible.reduced_body import ReducedBody, to_body
from mbs.flexible.reduced_file import read_reduced, write_reduced
from mbs.flexible.reduction import reduce
from mbs.flexible.spiders import Interface, nearest_node, nodes_in_plane, nodes_on_cylinder, spider
from mbs.model.body import FREEDOMS, Frame
from mbs.scene.flexible import read_flexible
from tests.unit.flexible_cases import DENSITY, SIZE, block, ends, rigid_motion

ROUND_OFF = 1e-12


def spring(k=1e6, m=1.0):
    """Two nodes with three displacements each, joined by springs along x, y, z."""
    one = np.eye(3)
    return {
        "stiffness": sparse.csc_array(k * np.block([[one, -one], [-one, one]])),
        "mass": sparse.csc_array(m * np.eye(6)),
        "nodes": np.array([1, 1, 1, 2, 2, 2]),
        "directions": np.array([0, 1, 2, 0, 1, 2]),
        "numbers": np.array([1, 2]),
        "positions": np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]]),
    }


class TestModel:
    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"nodes": np.array([])}, "nodes: got shape .0,.; allowed: one for each degree of freedom"),
            ({"directions": np.array([0])}, "directions: got shape"),
            ({"mass": sparse.csc_array((5, 6))}, r"mass: got shape \(5, 6\); allowed: \(6, 6\)"),
            ({"positions": np.zeros((2, 2))}, "positions: got shape"),
            ({"stiffness": sparse.csc_array(np.full((6, 6), np.nan))}, "stiffness: got entries that are no finite"),
            (
                {"stiffness": sparse.csc_array(np.triu(np.ones((6, 6))))},
                "stiffness: is not symmetric: entries differ by 1",
            ),
            (
                {"directions": np.array([0, 1, 7, 0, 1, 2])},
                "directions: node 1 direction 7: got a direction that is none",
            ),
            ({"directions": np.array([0, 1, 1, 0, 1, 2])}, "nodes: node 1 direction 1: is there twice"),
            ({"numbers": np.array([1, 1])}, "numbers: a node has two positions"),
            ({"positions": np.full((2, 3), np.inf)}, "positions: got values that are no finite numbers at nodes 1, 2"),
            ({"stiffness": sparse.csc_array(-np.eye(6))}, "stiffness: has a negative diagonal"),
            ({"stiffness": sparse.csc_array(np.fliplr(np.eye(6)))}, "or entries larger than their diagonals allow"),
            (
                {"stiffness": sparse.csc_array(np.diag([1.0, 1, 1, 1, 1, 0]))},
                "stiffness: node 2 direction 2: no stiffness",
            ),
            ({"mass": sparse.csc_array(np.diag([1.0, 1, 1, 1, 1, 0]))}, "mass: node 2 direction 2: no mass"),
        ],
    )
    def test_slips(self, changes, message):
        with pytest.raises(InputError, match=message):
            FiniteElementModel(**(spring() | changes))

    def test_knows_its_rows(self):
        model = FiniteElementModel(**spring())
        assert (model.size, model.row(2, 1), model.row(2, 3), model.row(9, 0)) == (6, 4, None, None)
        assert model.position(2) == pytest.approx([0.1, 0.0, 0.0])


class TestSpiders:
    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"position": np.zeros(2)}, "position: got"),
            ({"position": np.array([0.0, np.nan, 0.0])}, "position: got"),
            ({"nodes": np.zeros(0)}, "allowed: a list of at least one node"),
            ({"nodes": np.array([1, 1])}, "a node is there twice"),
            ({"kind": "loose"}, "kind: got 'loose'; allowed: rigid, averaging"),
            ({"freedoms": ()}, "freedoms: got"),
            ({"freedoms": ("x", "x")}, "freedoms: got"),
            ({"freedoms": ("q",)}, "freedoms: got"),
            ({"weights": np.array([1.0])}, "weights: got shape"),
            ({"weights": np.array([1.0, -1.0, 1.0])}, "weights: got shape"),
        ],
    )
    def test_slips(self, changes, message):
        given = {"position": np.zeros(3), "nodes": np.array([1, 2, 3])}
        with pytest.raises(InputError, match=message):
            Interface(**(given | changes))

    @pytest.mark.parametrize(
        ("nodes", "kind", "message"),
        [
            ([1, 999], "averaging", "nodes: node 999 without a position"),
            ([1], "averaging", "got one, which does not say how the place turns"),
            ([1, 2, 3, 4, 5], "averaging", "got 5 on a line"),
            ([1, 2], "rigid", "got 2 on a line"),
        ],
    )
    def test_nodes_that_do_not_say_how_a_place_turns(self, nodes, kind, message):
        model = block(elements=(4, 2, 2))
        line = np.sort(model.numbers[(model.positions[:, 1:] == 0.0).all(axis=1)])
        chosen = [int(line[n - 1]) if n < 999 else n for n in nodes]
        with pytest.raises(InputError, match=message):
            spider(model, "seat", Interface(np.zeros(3), np.array(chosen), kind))

    def test_fixed_nodes_are_none(self):
        model = block(fixed=True)
        node = int(model.numbers[np.argmin(np.abs(model.positions).sum(axis=1))])
        with pytest.raises(
            InputError, match=f"'seat', nodes: node {node} without displacements in the matrices: fixed"
        ):
            spider(model, "seat", Interface(np.zeros(3), np.array([node])))

    @pytest.mark.parametrize("kind", ["rigid", "averaging"])
    def test_weights_draw_the_mean(self, kind):
        model = block()
        nodes = ends(model)["right"].nodes
        weights = np.linspace(1.0, 5.0, nodes.size)
        place = spider(model, "seat", Interface(np.array([0.2, 0.0, 0.0]), nodes, kind, FREEDOMS, weights))
        # Rigid motion is found whatever the weights.
        assert place.mean @ rigid_motion(model, (0.2, 0.0, 0.0))[place.rows] == pytest.approx(np.eye(6), abs=1e-10)
        # The weighted sum of the nodes' displacements that are not rigid vanishes: normal equations.
        u = np.random.default_rng(1).standard_normal(place.rows.size)
        rest = u - place.rigid @ (place.mean @ u)
        assert place.rigid.T @ (np.repeat(weights, 3) * rest) == pytest.approx(np.zeros(6), abs=1e-10)

    def test_a_single_node_of_a_solid_has_translations(self):
        model = block()
        reduced = reduce(
            model,
            {
                **ends(model),
                "pin": Interface(model.position(20), np.array([20]), "rigid", ("x", "y", "z")),
            },
            cutoff=10e3,
        )
        assert [name for name in reduced.coordinates if name.startswith("pin")] == ["pin.x", "pin.y", "pin.z"]
        assert not reduced.frames["pin"].transform[3:].any()

    def test_nodes_are_found(self):
        model = block()
        assert nodes_in_plane(model, (0.2, 0, 0), (-2.0, 0, 0), 1e-9).size == 9
        assert nodes_in_plane(model, (0.2, 0.025, 0.02), (1, 0, 0), 1e-9, radius=0.021).size == 3
        assert nodes_on_cylinder(model, (0, 0.025, 0.02), (5, 0, 0), 0.02, 0.0, 0.1, 1e-9).size == 6
        node = nearest_node(model, (0.19, 0.05, 0.05))
        assert model.position(node) == pytest.approx(SIZE)
        with pytest.raises(InputError, match="no node of the mesh has displacements"):
            nearest_node(FiniteElementModel(**(spring() | {"numbers": np.array([7, 8])})), (0, 0, 0))


class TestReduction:
    def slip(self, interfaces=None, points=None, cutoff=10e3, model=None):
        model = model or block()
        with pytest.raises(InputError) as caught:
            reduce(model, ends(model) if interfaces is None else interfaces, points, cutoff)
        return "\n".join(caught.value.problems)

    def test_slips_come_together(self):
        model = block()
        nodes = ends(model)["left"].nodes
        text = self.slip(
            {
                "a": Interface(np.zeros(3), nodes),
                "b": Interface(np.zeros(3), nodes, "rigid"),
                "c": Interface([0, 0, 0], [1]),
            },
            {
                "a": 1,
                "far": (1.0, 0.0, 0.0),
                "gone": 10**9,
                "odd": (0.0, np.nan, 0.0),
                "line": Interface([0, 0, 0], [2]),
            },
            np.nan,
        )
        for words in (
            "cutoff: got nan Hz",
            "points: 'a' is the name of an interface",
            "interface 'a', nodes: nodes",
            "belong to the rigid interface 'b' too",
            "interface 'c', nodes: got one",
            "point 'far': got [1.0, 0.0, 0.0] m, 0.8 m from the nearest node",
            "point 'gone': got node 1000000000; allowed: a node with a position",
            "point 'odd': got (0.0, nan, 0.0)",
            "interface 'line', nodes: got one",
        ):
            assert words in text
        assert "interfaces: got none" in self.slip({})

    def test_averages_of_the_same_nodes(self):
        entry = ends(block())["left"]
        assert "depend on each other" in self.slip({"a": entry, "b": entry})

    @pytest.mark.parametrize("dense", [0, 10**6])
    def test_a_body_that_still_moves(self, dense, monkeypatch):
        monkeypatch.setattr(held_body, "_DENSE", dense)
        entry = ends(block(), freedoms=("x", "y", "z"))["left"]
        assert "the body can still move in 3 ways" in self.slip({"left": entry})

    @pytest.mark.parametrize("dense", [0, 10**6])
    def test_matrices_that_are_no_body(self, dense, monkeypatch):
        monkeypatch.setattr(held_body, "_DENSE", dense)
        good = block()
        given = (good.nodes, good.directions, good.numbers, good.positions)
        # Every pair of rows alone may belong to a body; all together do not.
        pushed = sparse.lil_array(good.stiffness)
        pushed[20, 20] *= 0.6
        text = self.slip(model=FiniteElementModel(pushed.tocsc(), good.mass, *given))
        assert "stiffness and mass are not those of a body" in text

    def test_a_body_that_is_all_rigid(self):
        model = block()
        whole = Interface(np.zeros(3), model.numbers, "rigid")
        reduced = reduce(model, {"all": whole}, cutoff=1e4)
        assert (reduced.size, np.any(reduced.stiffness)) == (6, False)
        few = Interface(np.zeros(3), model.numbers, "rigid", ("x",))
        assert "most degrees of freedom have none" in self.slip({"all": few})

    def test_one_interface_holds_a_free_body(self):
        reduced = reduce(block(), {"left": ends(block())["left"]}, cutoff=20e3)
        # No static shape strains it: it moves as one.
        assert not reduced.stiffness[:6].any()
        assert reduced.size > 10

    def test_a_mass_that_is_none(self):
        model = FiniteElementModel(**spring())
        ring = np.eye(3) - 0.9 * (np.ones((3, 3)) - np.eye(3))  # eigenvalue 1 - 1.8
        mass = sparse.csc_array(np.kron(np.eye(2), ring))
        bad = FiniteElementModel(**(spring() | {"mass": mass}))
        pin = {"pin": Interface(np.zeros(3), np.array([1]), "rigid", ("x", "y", "z"))}
        assert reduce(model, pin, cutoff=1e3).size == 6
        assert "stiffness and mass are not those of a body" in self.slip(pin, cutoff=1e3, model=bad)

    def test_too_many_modes(self, monkeypatch):
        monkeypatch.setattr(held_body, "MOST_MODES", 30)
        for dense in (0, 10**6):
            monkeypatch.setattr(held_body, "_DENSE", dense)
            assert "allowed: at most 30; lower it" in self.slip(cutoff=1e6, model=block(elements=(5, 2, 2)))

    def test_static_shapes_that_do_not_settle(self, monkeypatch):
        monkeypatch.setattr(held_body, "_ITERATIONS", 1)
        model = block()
        with pytest.raises(AnalysisError, match="static shapes still change"):
            reduce(model, ends(model), cutoff=10e3)

    @pytest.mark.parametrize(
        ("name", "value", "message"),
        [
            ("mbs.flexible.held_body.splu", RuntimeError("singular"), r"cannot be factorised \(singular\)"),
            ("mbs.flexible.held_body.eigsh", ArpackError(-9999), "the modes of the held body were not found"),
            ("mbs.flexible.reduction._COUPLED", -1.0, "static shapes and modes are coupled by"),
        ],
    )
    def test_what_the_libraries_do_not_manage(self, monkeypatch, name, value, message):
        def fail(*arguments, **keywords):
            raise value

        monkeypatch.setattr(held_body, "_DENSE", 0)
        monkeypatch.setattr(name, fail if isinstance(value, Exception) else value)
        model = block()
        with pytest.raises(AnalysisError, match=message):
            reduce(model, ends(model), cutoff=10e3)

    def test_points(self):
        model = block()
        middle = nodes_in_plane(model, (0.1, 0, 0), (1, 0, 0), 1e-9)
        reduced = reduce(
            model,
            ends(model),
            {"node": 3, "place": (0.1, 0.05, 0.04), "mean": Interface(np.array([0.1, 0.02, 0.02]), middle)},
            20e3,
            {"made": "here"},
        )
        left = reduced.frames["left"].position
        for name in ("place", "mean", "right"):
            frame = reduced.frames[name]
            x, y, z = frame.position - left
            # Turning the body as one about its left end: the coordinates of both ends follow.
            motion = np.zeros(reduced.size)
            motion[3:6] = [1e-3, 2e-3, 3e-3]
            far = reduced.frames["right"].position - left
            motion[6:9], motion[9:12] = np.cross(motion[3:6], far), motion[3:6]
            moved = frame.transform @ motion
            assert moved[:3] == pytest.approx(np.cross([1e-3, 2e-3, 3e-3], [x, y, z]), abs=1e-12)
            assert moved[3:] == pytest.approx([0, 0, 0] if name == "place" else [1e-3, 2e-3, 3e-3], abs=1e-12)
        assert reduced.attributes["made"] == "here"
        assert reduced.attributes["interfaces"] == "left: averaging, 9 nodes; right: averaging, 9 nodes"
        again = reduce(model, ends(model), {"node": 3, "place": (0.1, 0.05, 0.04)}, 20e3)
        assert np.array_equal(again.mass, reduced.mass)


def tiny(**changes):
    given = {
        "mass": np.diag([1.0, 2.0]),
        "stiffness": np.diag([0.0, 5.0]),
        "coordinates": ("left.x", "mode 1"),
        "units": ("m", "1"),
        "frames": {"left": Frame(np.zeros(3), np.eye(6)[:, :2])},
        "attributes": {"from": "a test"},
    }
    return ReducedBody(**(given | changes))


class TestReducedBody:
    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"coordinates": ()}, "coordinates: got 0; allowed: 1 to"),
            ({"coordinates": ("a", "a")}, "coordinates: a name is there twice"),
            ({"units": ("m", "kg")}, "units: got"),
            ({"mass": np.eye(3)}, r"mass: got shape \(3, 3\)"),
            ({"stiffness": np.array([[1.0, np.inf], [np.inf, 1.0]])}, "stiffness: got entries"),
            ({"mass": np.diag([1.0, 0.0])}, "mass: got 0 on the diagonal at mode 1"),
            ({"mass": np.ones((2, 2))}, "mass: the scaled matrix has the eigenvalue"),
            ({"mass": np.array([[1.0, 0.5], [0.0, 1.0]])}, "mass: is not symmetric"),
            ({"stiffness": np.diag([-1.0, 5.0])}, "stiffness: the scaled matrix has the eigenvalue -1"),
            ({"frames": {"a": Frame(np.zeros(2), np.zeros((6, 2)))}}, "frame 'a': got shapes"),
            ({"frames": {"a": Frame(np.full(3, np.nan), np.zeros((6, 2)))}}, "frame 'a': got values"),
        ],
    )
    def test_slips(self, changes, message):
        with pytest.raises(InputError, match=message):
            tiny(**changes)

    def test_in_a_system(self):
        body = to_body(tiny(), "b", (1.0, 0.0, 0.0), 0.01, spin=0.0)
        assert body.frames["left"].position == pytest.approx([1.0, 0.0, 0.0])
        assert body.damping[1, 1] == pytest.approx(2.0 * 0.01 * np.sqrt(5.0 / 2.0) * 2.0, rel=ROUND_OFF)
        with pytest.raises(InputError, match="damping ratio: got 2"):
            to_body(tiny(), "b", damping_ratio=2.0)


class TestFiles:
    @pytest.mark.parametrize("end", ["nc", "npz"])
    def test_round_trip_and_the_same_bytes(self, tmp_path, end):
        model = block()
        reduced = reduce(model, ends(model), {"top": (0.1, 0.05, 0.04)}, 20e3, {"command": "test"})
        first, second = tmp_path / f"a.{end}", tmp_path / f"b.{end}"
        write_reduced(first, reduced)
        write_reduced(second, reduced)
        assert first.read_bytes() == second.read_bytes()
        assert not list(tmp_path.glob(".*"))
        found = read_reduced(first)
        assert np.array_equal(found.mass, reduced.mass)
        assert np.array_equal(found.stiffness, reduced.stiffness)
        assert (found.coordinates, found.units) == (reduced.coordinates, reduced.units)
        assert dict(found.attributes) == dict(reduced.attributes)
        for name, frame in reduced.frames.items():
            assert np.array_equal(found.frames[name].position, frame.position)
            assert np.array_equal(found.frames[name].transform, frame.transform)

    def test_files_that_are_none(self, tmp_path):
        def problem(path):
            with pytest.raises(InputError) as caught:
                read_reduced(path)
            return "\n".join(caught.value.problems)

        assert "got the ending '.txt'; allowed: .nc, .npz" in problem(tmp_path / "a.txt")
        assert "cannot be read" in problem(tmp_path / "gone.nc")
        for end in ("nc", "npz"):
            path = tmp_path / f"bad.{end}"
            for content in (b"", b"\x93NUMPY nonsense", b"PK\x03\x04 nothing", b"CDF\x01 nothing at all"):
                path.write_bytes(content)
                assert "is no reduced body" in problem(path)
            with pytest.raises(InputError, match="is not a body that was reduced by mbs"):
                write_reduced(path, tiny())
            path.unlink()
            for _ in range(2):
                write_reduced(path, tiny())
            path.write_bytes(path.read_bytes()[:-300])
            assert "bad" in problem(path)
        with pytest.raises(InputError, match="no folder is no folder"):
            write_reduced(tmp_path / "no folder" / "a.nc", tiny())

    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"mass": None}, "missing: mass"),
            ({"mass": np.array([[{}]], dtype=object)}, "is no reduced body"),  # nothing is unpickled
            ({"mass": np.array([["x", "y"]])}, "mass: got <U1; allowed: real numbers"),
            ({"coordinates": np.array([1.0, 2.0])}, "coordinates: got 1 dimensions of float64"),
            ({"positions": np.zeros((5, 3))}, r"positions: got shape \(5, 3\); allowed: \(1, 3\)"),
            ({"mass": np.eye(3)}, "mass: got shape"),
            ({"attributes": np.zeros(3)}, "attributes: got shape"),
        ],
    )
    def test_npz_slips(self, tmp_path, changes, message):
        path = tmp_path / "a.npz"
        write_reduced(path, tiny())
        with np.load(path) as file:
            arrays = {name: file[name] for name in file.files} | changes
        np.savez(path, **{name: value for name, value in arrays.items() if value is not None})
        with pytest.raises(InputError, match=message):
            read_reduced(path)

    def test_netcdf_slips(self, tmp_path):
        import xarray as xr

        path, other = tmp_path / "a.nc", tmp_path / "b.nc"
        write_reduced(path, tiny())
        with xr.open_dataset(path) as file:
            dataset = file.load()
        assert dataset["mass"].attrs["long_name"] == "mass matrix"
        dataset.assign_attrs(schema_version=9).to_netcdf(other)
        with pytest.raises(InputError, match="got the schema_version"):
            read_reduced(other)
        dataset.drop_vars("transform").to_netcdf(other)
        with pytest.raises(InputError, match="the variables transform are missing"):
            read_reduced(other)


def upper(matrix, labels=None):
    """Lines of the upper half, as CalculiX writes them, or with labels as Abaqus does."""
    rows, columns = np.nonzero(np.triu(matrix))
    if labels is None:
        return "".join(f"{i + 1} {j + 1}  {matrix[i, j]:.17e}\n" for i, j in zip(rows, columns, strict=True))
    pairs = zip(rows, columns, strict=True)
    return "".join(
        f"{labels[i][0]},{labels[i][1]}, {labels[j][0]},{labels[j][1]}, {matrix[i, j]:.17e}\n" for i, j in pairs
    )


@pytest.fixture
def files(tmp_path):
    """A block in the files of every format, in mm, tonne, s for Abaqus; nodes with numbers of their own."""
    model = block(elements=(2, 1, 1))
    labels = [(int(n) * 10, int(d) + 1) for n, d in zip(model.nodes, model.directions, strict=True)]
    k, m = model.stiffness.toarray(), model.mass.toarray()
    (tmp_path / "b.sti").write_text(upper(k))
    (tmp_path / "b.mas").write_text(upper(m))
    (tmp_path / "b.dof").write_text("".join(f"{n}.{d}\n" for n, d in labels))
    (tmp_path / "dofs.txt").write_text("# node direction\n" + "".join(f"{n} {d}\n" for n, d in labels))
    io.mmwrite(tmp_path / "k.mtx", sparse.coo_array(k), symmetry="symmetric", precision=17)
    io.mmwrite(tmp_path / "m.mtx", sparse.coo_array(m), symmetry="general", precision=17)
    (tmp_path / "k_abaqus.mtx").write_text("** STIFFNESS\n" + upper(k / 1e3, labels))
    (tmp_path / "m_abaqus.mtx").write_text(upper(m / 1e3, labels))
    for name, factor in (("m", 1.0), ("mm", 1e3)):
        lines = [
            f"{10 * n}, " + ", ".join(f"{factor * x:.17g}" for x in p)
            for n, p in zip(model.numbers, model.positions, strict=True)
        ]
        (tmp_path / f"{name}.inp").write_text(
            "*HEADING\n*NODE, NSET=ALL\n" + "\n".join(lines) + "\n** a comment\n*ELEMENT, TYPE=C3D8\n1, 2, 3\n"
        )
    return tmp_path, model


def same(found, model):
    order = np.lexsort((model.directions, model.nodes))
    assert np.array_equal(found.nodes, 10 * model.nodes[order])
    for name in ("stiffness", "mass"):
        expected = getattr(model, name).toarray()[np.ix_(order, order)]
        # Two texts of 17 digits, and factors of 1000.
        assert getattr(found, name).toarray() == pytest.approx(expected, rel=1e-14)
    assert found.positions == pytest.approx(model.positions, rel=1e-14)


class TestReaders:
    def test_the_same_body_from_every_format(self, files):
        folder, model = files
        mesh = read_mesh_nodes(folder / "m.inp")
        same(read_calculix(folder / "b.sti", folder / "b.mas", folder / "b.dof", mesh), model)
        labelled = [read_matrix_market(folder / f"{name}.mtx", folder / "dofs.txt") for name in "km"]
        same(assemble_model(*labelled, mesh), model)
        labelled = [read_abaqus_matrix(folder / f"{name}_abaqus.mtx") for name in "km"]
        same(assemble_model(*without_fixed(*labelled), read_mesh_nodes(folder / "mm.inp"), "mm-t-s"), model)
        labelled = [read_abaqus_matrix(folder / name, folder / "dofs.txt") for name in ("b.sti", "b.mas")]
        same(assemble_model(*labelled, mesh), model)

    def test_a_whole_matrix_is_taken_as_it_is(self, tmp_path):
        path = tmp_path / "a.sti"
        path.write_text("1 1 2.0\n1 2 -1.0\n2 1 -1.0\n2 2 2.0\n")
        found = read_triplets(path, np.array([1, 1]), np.array([0, 1]))
        assert found.matrix.toarray().tolist() == [[2.0, -1.0], [-1.0, 2.0]]

    def test_fixed_degrees_of_freedom_of_abaqus_are_left_out(self):
        labels = np.array([1, 1, 2]), np.array([0, 1, 0])
        stiffness = Labelled(sparse.csc_array(np.diag([1e36, 2.0, 3.0])), *labels)
        kept, mass = without_fixed(stiffness, Labelled(sparse.csc_array(np.eye(3)), *labels))
        assert kept.matrix.toarray().tolist() == [[2.0, 0.0], [0.0, 3.0]]
        assert (mass.nodes.tolist(), mass.directions.tolist()) == ([1, 2], [1, 0])

    def test_rotations_in_millimetres(self):
        one = sparse.csc_array(np.ones((2, 2)) + np.eye(2))
        entry = Labelled(one, np.array([1, 1]), np.array([0, 3]))
        model = assemble_model(entry, entry, NodePositions(np.array([1]), np.array([[1.0, 2.0, 3.0]])), "mm-t-s")
        # N/mm, N/rad, N mm/rad; tonne, tonne mm, tonne mm2.
        assert model.stiffness.toarray() == pytest.approx(np.array([[2e3, 1.0], [1.0, 2e-3]]), rel=ROUND_OFF)
        assert model.positions == pytest.approx(np.array([[1e-3, 2e-3, 3e-3]]), rel=ROUND_OFF)
        with pytest.raises(InputError, match="units: got 'inch'; allowed: SI, mm-t-s"):
            assemble_model(entry, entry, NodePositions(np.array([1]), np.zeros((1, 3))), "inch")
        other = Labelled(one, np.array([1, 2]), np.array([0, 0]))
        with pytest.raises(
            InputError, match="node 1 direction 4, node 2 direction 1 in only one of stiffness and mass"
        ):
            assemble_model(entry, other, NodePositions(np.array([1]), np.zeros((1, 3))))

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("", "has no numbers"),
            ("1 1\n", "line 1: got '1 1'; allowed: 3 numbers a line"),
            ("1 1 2.0\n1 2\n", "line 2: got '1 2'; allowed: 3 numbers a line"),
            ("1 1 2.0\n\nx 2 1.0\n", "line 3: got 'x 2 1.0'"),
            ("1 1 nan\n", "line 1: got '1 1 nan'; allowed: finite numbers"),
            ("1 1 1\n1 1e30 1\n", "line 2: got '1 1e30 1'; allowed: whole numbers"),
            ("1 1.5 1\n", "line 1: got '1 1.5 1'; allowed: whole numbers"),
            ("1 1 1\n1 3 1\n", "line 2: got '1 3 1'; allowed: rows and columns from 1 to 2"),
            ("0 1 1\n", "allowed: rows and columns from 1 to 2"),
            ("1 1 1\n1 1 1\n", "line 2: got '1 1 1'; an entry that is there twice"),
            ("1 1 1\n2 1 1\n1 2 1\n2 2 1\n1 3 1\n", "allowed: rows and columns"),
            ("1 1 1\n1 2 5\n2 1 5\n2 2 1\n\x00\n", "line 5"),
        ],
    )
    def test_triplets_that_are_none(self, tmp_path, text, message):
        path = tmp_path / "a.sti"
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_triplets(path, np.array([1, 1]), np.array([0, 1]))

    def test_halves_that_are_mixed(self, tmp_path):
        path = tmp_path / "a.sti"
        path.write_text("1 1 1\n1 2 5\n2 1 5\n1 3 4\n")
        with pytest.raises(InputError, match="line 4: got '1 3 4'; an entry without its mirror image"):
            read_triplets(path, np.array([1, 1, 1]), np.array([0, 1, 2]))

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("1,1,1,1\n", "allowed: 5 numbers a line"),
            ("-3,1,1,1,5.0\n", "line 1: got '-3,1,1,1,5.0'; allowed: node numbers from 1; Abaqus gives"),
            ("1,1,1,1,5.0\n1,8,1,1,5.0\n", "line 2: got '1,8,1,1,5.0'; allowed: directions 1 to 3"),
        ],
    )
    def test_abaqus_slips(self, tmp_path, text, message):
        path = tmp_path / "a.mtx"
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_abaqus_matrix(path)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("1.1\n1.9\n", "line 2: got '1.9'; allowed: a node from 1 and a direction from 1 to 6"),
            ("1.1\n1.1\n", "line 2: got '1.1'; which is there twice"),
            ("12\n", "line 1: got '12'; allowed: \"node.direction\""),
            ("1e1\n", 'allowed: "node.direction"'),
            ("99999999999999999999.1\n", "allowed: a node from 1"),
            ("a.1\n", "allowed: 1 numbers a line"),
        ],
    )
    def test_dof_files_that_are_none(self, tmp_path, text, message):
        path = tmp_path / "a.dof"
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_dofs(path)

    def test_dof_files(self, tmp_path, monkeypatch):
        path = tmp_path / "a.dof"
        path.write_text("120.1\n7.3\n")
        assert [entry.tolist() for entry in read_dofs(path)] == [[120, 7], [0, 2]]
        path.write_text("7 4\n")
        assert [entry.tolist() for entry in read_dof_table(path)] == [[7], [3]]
        monkeypatch.setattr("mbs.flexible.matrix_files.MOST_FREEDOMS", 0)
        with pytest.raises(InputError, match="got 1 degrees of freedom; allowed: at most 0"):
            read_dof_table(path)

    def test_matrix_market_slips(self, files):
        folder, _ = files
        dofs, path = folder / "dofs.txt", folder / "x.mtx"
        text = (folder / "k.mtx").read_text()
        size = next(line for line in text.splitlines() if not line.startswith("%"))
        for content, message in (
            ("nothing", "is no Matrix Market file"),
            ("%%MatrixMarket matrix coordinate complex general\n36 36 1\n1 1 1 0\n", "got complex entries"),
            ("%%MatrixMarket matrix coordinate real general\n5 5 1\n1 1 1\n", "got 5 rows and 5 columns"),
            (text.replace(size, "36 36 999999999"), "promises 999999999 entries"),
            (text[: len(text) // 2], "promises|its last line has no end"),
            (text[:-5], "its last line has no end"),
            (text.rstrip().rpartition("\n")[0] + "\n36 36 x\n", "cannot be read"),
        ):
            path.write_text(content)
            with pytest.raises(InputError, match=message):
                read_matrix_market(path, dofs)
        with pytest.raises(InputError, match=r"gone.mtx: cannot be read .*No such file"):
            read_matrix_market(folder / "gone.mtx", dofs)

    def test_files_that_are_too_long(self, files, monkeypatch):
        monkeypatch.setattr("mbs.flexible.number_table.LONGEST_FILE", 10)
        with pytest.raises(
            InputError, match=r"longer than 10 bytes \(got \d+\); allowed: a file of the body; take a coarser mesh"
        ):
            read_dof_table(files[0] / "dofs.txt")

    def test_files_that_fill_the_memory(self, tmp_path, monkeypatch):
        def fail(*arguments, **keywords):
            raise MemoryError

        path = tmp_path / "a.dof"
        path.write_text("1 1\n")
        monkeypatch.setattr(np, "loadtxt", fail)
        with pytest.raises(InputError, match="does not fit into the memory"):
            read_dof_table(path)

    def test_decks_that_are_refused(self, tmp_path):
        path = tmp_path / "a.inp"
        path.write_text("*NODE\n1,0,0,0\n*RIGID BODY, NSET=END, REF NODE=1\n*Transform, NSET=A\n**RIGID BODY\n")
        with pytest.raises(InputError) as caught:
            check_deck(path)
        assert len(caught.value.problems) == 2
        assert "line 3: got *RIGID BODY; allowed" in caught.value.problems[0]

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("*ELEMENT\n1,2\n", r"has no \*NODE block"),
            ("*NODE\n1,0,x,0\n", "line 2: got '1,0,x,0'; allowed: a node from 1"),
            ("*NODE\n1\n", "line 2: got '1'"),
            ("*NODE\n1,nan,0,0\n", "line 2"),
            ("*INCLUDE, INPUT=b.inp\n", "line 1: got '.INCLUDE, INPUT=b.inp'; allowed: a deck with its nodes in it"),
            ("*NODE, SYSTEM=C\n1,0,0,0\n", "allowed: rectangular coordinates"),
        ],
    )
    def test_decks_without_nodes(self, tmp_path, text, message):
        path = tmp_path / "a.inp"
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_mesh_nodes(path)

    def test_meshes_of_other_programs(self, tmp_path, monkeypatch):
        points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2]])
        path = tmp_path / "a.vtk"
        meshio.write(path, meshio.Mesh(points, [("tetra", np.array([[0, 1, 2, 3]]))]))
        found = read_mesh_nodes(path)
        assert found.numbers.tolist() == [1, 2, 3, 4]
        assert found.positions == pytest.approx(points)
        for name in ("b.vtk", "b.xyz0"):
            (tmp_path / name).write_text("nonsense")
            with pytest.raises(InputError, match="cannot be read as a mesh"):
                read_mesh_nodes(tmp_path / name)
        meshio.write(path, meshio.Mesh(np.full((2, 3), np.nan), [("line", np.array([[0, 1]]))]))
        with pytest.raises(InputError, match=r"got points of shape \(2, 3\); allowed: finite positions"):
            read_mesh_nodes(path)
        # A reader of meshio that waits for an end that was cut off.
        monkeypatch.setattr("mbs.flexible.mesh.SHORTEST_READ", 2.0)
        (tmp_path / "a.mdpa").write_text("Begin Nodes\n 1 0.0 0.0 0.0\n")
        with pytest.raises(InputError, match=r"cannot be read as a mesh \(it did not end within 2 s\)"):
            read_mesh_nodes(tmp_path / "a.mdpa")

    def test_without_meshio(self, tmp_path, monkeypatch):
        (tmp_path / "meshio.py").write_text("raise ImportError('none here')")
        monkeypatch.setenv("PYTHONPATH", str(tmp_path))
        (tmp_path / "a.vtk").write_text("nothing")
        message = r'a\.vtk: reading this format: the package meshio .*\(none here\).*"ehdmaps\[flexible\]"'
        with pytest.raises(DependencyError, match=message):
            read_mesh_nodes(tmp_path / "a.vtk")
        (tmp_path / "a.inp").write_text("*NODE\n1,0,0,0\n")
        assert read_mesh_nodes(tmp_path / "a.inp").numbers.tolist() == [1]


def table(folder, **changes):
    values = {
        "matrices": {"format": "calculix", "stiffness": "b.sti", "mass": "b.mas", "dofs": "b.dof"},
        "mesh": "m.inp",
        "cutoff": "20 kHz",
        "interfaces": {
            name: {"at": [f"{x} mm", "25 mm", "20 mm"], "plane": {"axis": "x"}, "kind": kind}
            for name, x, kind in (("left", 0, "rigid"), ("right", 200, "averaging"))
        },
        "points": {
            "top": ["100 mm", "50 mm", "40 mm"],
            "node": 20,
            "face": {"at": ["100 mm", "25 mm", "20 mm"], "plane": {"axis": "x", "diameter": "70 mm"}},
        },
        "position": ["1 m", "0 mm", "0 mm"],
        "damping_ratio": 0.01,
    }
    values |= changes
    problems = []
    section = Table(
        {key: value for key, value in values.items() if value is not None}, "[[flexible]] housing", problems
    )
    body = read_flexible(section, "housing", folder, [])
    section.close(("name",))
    return body, "\n".join(problems)


class TestScene:
    def test_matrices_and_a_reduced_file_give_the_same_body(self, files):
        folder, model = files
        body, problems = table(folder)
        assert not problems
        assert body.coordinates[:12] == tuple(f"{name}.{key}" for name in ("left", "right") for key in FREEDOMS)
        assert set(body.frames) == {"left", "right", "top", "node", "face"}
        assert body.frames["right"].position == pytest.approx([1.2, 0.025, 0.02])
        assert body.damping.any()
        source = folder / "body.toml"
        source.write_text(BODY)
        text, status = command.run(argparse.Namespace(body=str(source), output=str(folder / "b.nc")))
        assert status == 0
        assert f"{model.size} degrees of freedom to {body.size}" in text
        assert "b.nc: written" in text
        again, problems = table(
            folder, **dict.fromkeys(("matrices", "mesh", "cutoff", "interfaces", "points")), reduced="b.nc"
        )
        assert not problems
        assert np.array_equal(again.mass, body.mass)
        assert np.array_equal(again.damping, body.damping)
        assert read_reduced(folder / "b.nc").attributes["command"] == "mbs reduce body.toml -o b.nc"

    @pytest.mark.parametrize("form", ["matrix-market", "abaqus"])
    def test_other_formats(self, files, form):
        matrices = {
            "matrix-market": {"format": form, "stiffness": "k.mtx", "mass": "m.mtx", "dofs": "dofs.txt"},
            "abaqus": {"format": form, "stiffness": "k_abaqus.mtx", "mass": "m_abaqus.mtx"},
        }[form]
        units = {"mesh": "mm.inp", "units": "mm-t-s"} if form == "abaqus" else {}
        body, problems = table(files[0], matrices=matrices, **units)
        assert not problems
        expected, _ = table(files[0])
        assert body.stiffness == pytest.approx(expected.stiffness, rel=1e-6, abs=1e-6 * np.max(expected.stiffness[:12]))

    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"matrices": None}, "[[flexible]] housing matrices: missing; allowed: reduced, or matrices"),
            ({"matrices": {"format": "nastran"}}, "format: got 'nastran'; allowed: 'calculix'"),
            ({"matrices": {"format": "calculix", "stiffness": 5}}, "stiffness: got 5; allowed: the path of a file"),
            ({"matrices": {"format": "abaqus", "stiffness": "a", "mass": "b", "mess": 1}}, "mess: unknown key"),
            ({"mesh": None}, "mesh: missing"),
            ({"mesh": "gone.inp"}, "gone.inp: cannot be read"),
            ({"units": "inch"}, "units: got 'inch'"),
            ({"cutoff": "20"}, "cutoff: got '20' without a unit|cutoff: got '20'"),
            ({"cutoff": None}, "cutoff: missing"),
            ({"interfaces": None}, "interfaces: missing"),
            ({"interfaces": {}}, "interfaces: got none"),
            ({"interfaces": {"a.b": {}}}, "got the name 'a.b'; allowed: a short name without"),
            ({"interfaces": {"a": {"plane": {"axis": "x"}}}}, "interfaces a at: missing"),
            ({"interfaces": {"a": {"at": ["0 mm"] * 3}}}, "interfaces a: got no surface; allowed: one of nodes"),
            (
                {"interfaces": {"a": {"at": ["0 mm"] * 3, "nodes": [1], "plane": {}}}},
                "got nodes, plane; allowed: one of",
            ),
            (
                {"interfaces": {"a": {"at": ["0 mm"] * 3, "nodes": [1.5]}}},
                "nodes: got a list of 1 entries; allowed: a list of node",
            ),
            ({"interfaces": {"a": {"at": ["0 mm"] * 3, "nodes": [7]}}}, "node 7 without a position"),
            ({"interfaces": {"a": {"at": ["0 mm"] * 3, "plane": {"axis": "w"}}}}, "axis: got 'w'"),
            (
                {"interfaces": {"a": {"at": ["1 mm"] * 3, "plane": {"axis": "x"}}}},
                "no node of the mesh is on its surface",
            ),
            ({"interfaces": {"a": {"at": ["1 mm"] * 3, "plane": {"axis": "x"}, "kind": "soft"}}}, "kind: got 'soft'"),
            ({"interfaces": {"a": {"at": ["1 mm"] * 3, "plane": {"axis": "x"}, "freedoms": []}}}, "freedoms: got []"),
            (
                {
                    "interfaces": {
                        "a": {
                            "at": ["0 mm"] * 3,
                            "cylinder": {"axis": "x", "diameter": "1 mm", "from": "2 mm", "to": "1 mm"},
                        }
                    }
                },
                "allowed: from <= to",
            ),
            (
                {
                    "interfaces": {
                        "a": {"at": ["0 mm"] * 3, "cylinder": {"axis": "x", "diameter": "1 mm", "from": "0 mm"}}
                    }
                },
                "to: missing",
            ),
            ({"points": {"a": 0}}, "points a: got 0; allowed: a node number from 1"),
            ({"points": {"a": "top"}}, "points a: got 'top'; allowed: three lengths"),
            ({"points": {"a": {"at": ["5 mm"] * 3, "plane": {"axis": "x"}}}}, "interface 'a': no node of the mesh"),
            ({"reduced": "b.nc"}, "matrices: stands beside reduced"),
            ({"damping_ratio": 2}, "damping_ratio: got 2"),
            ({"position": ["0 mm"]}, "position: got a list of 1 entries; allowed: three lengths"),
            ({"colour": 1}, "colour: unknown key"),
        ],
    )
    def test_slips(self, files, changes, message):
        body, problems = table(files[0], **changes)
        assert any(words in problems for words in message.split("|")), problems
        assert body is None or "unknown key" in message

    def test_a_cylinder_and_nodes(self, files):
        folder, model = files
        about = {"at": ["200 mm", "25 mm", "20 mm"]}
        edge = {"axis": "x", "diameter": "64.0312 mm", "from": "-1 mm", "to": "1 mm"}
        corners = [int(10 * node) for node in model.numbers[np.abs(model.positions[:, 0] - 0.2) < 1e-9]]
        found = [
            table(folder, interfaces={"left": LEFT, "right": about | surface})
            for surface in ({"cylinder": edge}, {"nodes": corners}, {"plane": {"axis": "x"}})
        ]
        assert not any(problems for _, problems in found)
        for body, _ in found[1:]:
            assert np.array_equal(body.stiffness, found[0][0].stiffness)

    def test_command_slips(self, tmp_path):
        def problem(text, output="a.nc"):
            source = tmp_path / "body.toml"
            source.write_bytes(text)
            with pytest.raises(InputError) as caught:
                command.run(argparse.Namespace(body=str(source), output=output and str(tmp_path / output)))
            return "\n".join(caught.value.problems)

        assert "body.toml: is not TOML" in problem(b"a = ")
        assert "body.toml: is not UTF-8 text (byte 0); allowed: a body file in TOML" in problem(b"\xff")
        both = problem(b"colour = 1", "a.txt")
        assert "-o: got" in both
        assert "body file colour: unknown key" in both
        assert "body file matrices: missing" in both
        assert "gone.toml: cannot be read" in "".join(slip_of(tmp_path / "gone.toml"))


class TestExtent:
    def test_mass_centre_and_box_of_bricks(self):
        found = extent(block())
        assert found.mass == pytest.approx(DENSITY * np.prod(SIZE), rel=ROUND_OFF)
        assert found.centre == pytest.approx(0.5 * np.array(SIZE), rel=ROUND_OFF)
        assert found.lower.tolist() == [0.0, 0.0, 0.0]
        assert found.upper == pytest.approx(SIZE, rel=ROUND_OFF)
        assert found.density == pytest.approx(DENSITY, rel=ROUND_OFF)
        assert found.warnings("SI") == ()

    def test_mass_and_centre_of_beams(self):
        """Two masses with moments of inertia of their own, which turn with the body."""
        place = np.array([[0.1, 0.2, 0.3], [1.1, -0.4, 0.8]])
        mass = np.repeat([3.0, 1.0], 6) * np.tile([1.0, 1.0, 1.0, 0.1, 0.2, 0.3], 2)
        found = extent(
            FiniteElementModel(
                sparse.eye_array(12, format="csc"),
                sparse.diags_array(mass, format="csc"),
                np.repeat([1, 2], 6),
                np.tile(np.arange(6), 2),
                np.array([1, 2]),
                place,
            )
        )
        assert found.mass == pytest.approx(4.0, rel=ROUND_OFF)
        assert found.centre == pytest.approx(0.75 * place[0] + 0.25 * place[1], rel=ROUND_OFF)

    def test_fixed_nodes_and_nodes_without_a_position(self):
        free, fixed = extent(block()), extent(block(fixed=True))
        # The shapes of the free nodes add up to a third in the mean square over the first of four bricks.
        assert fixed.mass == pytest.approx((1.0 - 2.0 / 3.0 / 4.0) * free.mass, rel=ROUND_OFF)
        model = block()
        # A node without a position counts with its mass, and turns about the origin of none.
        lost = FiniteElementModel(
            model.stiffness, model.mass, model.nodes, model.directions, model.numbers[1:], model.positions[1:]
        )
        assert extent(lost).mass == pytest.approx(free.mass, rel=ROUND_OFF)

    def test_a_body_without_thickness_has_no_density(self):
        flat = Extent(7.0, np.zeros(3), np.zeros(3), np.array([1.0, 0.5, 0.0]))
        assert flat.density is None
        assert flat.warnings("SI") == ()
        assert Extent(7.0, np.zeros(3), np.zeros(3), np.array([60.0, 0.5, 0.0])).warnings("SI") == (
            'got a box of 60 m with units = "SI"; allowed: 0.001 to 50 m, 1 to 25000 kg/m3; units = "mm-t-s" would '
            "give a box of 0.06 m",
        )

    @pytest.mark.parametrize(
        ("mass", "side", "units", "message"),
        [
            (0.2106, 300.0, "SI", 'got a box of 300 m and 7.8e-09 kg/m3 .* units = "mm-t-s" would give a box of 0.3 m'),
            (210.6e3, 3e-4, "mm-t-s", 'got a box of 0.0003 m .* units = "SI" would give a box of 0.3 m and 7.8e.03'),
            (210.6e3, 0.3, "SI", "got a box of 0.3 m and 7.8e.06 .*; no units of this program fit: check mesh and mat"),
            (0.02, 0.3, "SI", "got a box of 0.3 m and 0.741 kg/m3 .*; no units of this program fit"),
        ],
    )
    def test_units_that_cannot_be(self, mass, side, units, message):
        (told,) = Extent(mass, np.zeros(3), np.zeros(3), np.full(3, side)).warnings(units)
        assert re.search(message, told), told

    def test_the_command_shows_them(self, files):
        folder, _ = files
        source = folder / "body.toml"
        source.write_text(BODY)
        text, _ = command.run(argparse.Namespace(body=str(source), output=None))
        mass = DENSITY * np.prod(SIZE)
        assert f"{mass:.6g} kg without what fixed nodes have of it" in text
        assert re.search(r"centre of mass +100\.0000 +25\.0000 +20\.0000\n", text)
        assert re.search(r"box from +0\.0000 +0\.0000 +0\.0000\nbox to +200\.0000 +50\.0000 +40\.0000\n", text)
        assert "warning" not in text

    def test_without_pymetis(self, files, monkeypatch, capsys):
        folder, _ = files
        (folder / "body.toml").write_text(BODY)
        monkeypatch.setitem(sys.modules, "pymetis", None)
        assert cli.main(["reduce", str(folder / "body.toml"), "-o", str(folder / "body.nc")]) == 2
        assert 'pip install "ehdmaps[flexible]", or pip install pymetis' in capsys.readouterr().err
        assert not (folder / "body.nc").exists()

    def test_units_left_out(self, files):
        """A deck in mm, tonne and s that is taken for SI: a thousandth of the mass, a thousand times the size."""
        folder, model = files
        source = folder / "body.toml"
        matrices = 'matrices = { format = "abaqus", stiffness = "k_abaqus.mtx", mass = "m_abaqus.mtx" }'
        body = re.sub("matrices = .*", matrices, BODY.partition("[interfaces]")[0]).replace('"m.inp"', '"mm.inp"')
        wrong = body + '[interfaces]\nleft = { at = ["0 m", "25 m", "20 m"], plane = { axis = "x" } }\n'
        source.write_text(wrong)
        text, status = command.run(argparse.Namespace(body=str(source), output=None))
        assert status == 0
        assert f"{1e-3 * DENSITY * np.prod(SIZE):.6g} kg" in text
        assert f"warning: {source}: got a box of 200 m" in text
        assert 'units = "mm-t-s" would give a box of 0.2 m and 7.85e+03 kg/m3 over it' in text
        right = wrong.replace('units = "SI"', 'units = "mm-t-s"').replace(' m"', ' mm"')
        source.write_text(right)
        assert "warning" not in command.run(argparse.Namespace(body=str(source), output=None))[0]
        corners = [int(10 * node) for node in model.numbers[np.abs(model.positions[:, 0] - 0.2) < 1e-9]]
        far = f'left = {{ at = ["200 mm", "25 mm", "20 mm"], nodes = {corners} }}'
        source.write_text(re.sub("left = .*", far, wrong))
        with pytest.raises(InputError, match=r"at: got 200 mm, 25 mm, 20 mm, .* from its 4 nodes") as caught:
            command.run(argparse.Namespace(body=str(source), output=None))
        assert 'units = "mm-t-s" would give a box of 0.2 m' in caught.value.problems[1]


class TestFilesOfAnotherKind:
    @pytest.mark.parametrize("end", [".xdmf", ".XML", ".node", ".ele", ".gz"])
    def test_meshes_in_several_files(self, tmp_path, end):
        path = tmp_path / f"m{end}"
        path.write_text("1\n")
        with pytest.raises(
            InputError, match=r"of a mesh in several files or a packed one; allowed: a mesh in one file"
        ):
            read_mesh_nodes(path)

    def test_tables_that_are_no_text_in_lines(self, tmp_path):
        path = tmp_path / "a.sti"
        path.write_text("1 " * 5001)
        with pytest.raises(InputError, match=r"which is no text in lines; allowed: 3 numbers a line"):
            read_triplets(path, np.array([1]), np.array([0]))

    def test_tables_and_decks_that_were_cut_off(self, files):
        """What is left of a number is a number, too: a mass of 5.8 for 5.8e-2, a node at z = 0."""
        folder, _ = files
        for name in ("b.sti", "m_abaqus.mtx", "b.dof", "dofs.txt"):
            path = folder / name
            path.write_text(path.read_text()[:-4])
        for read in (
            lambda: read_triplets(folder / "b.sti", np.arange(1, 13), np.zeros(12, dtype=int)),
            lambda: read_abaqus_matrix(folder / "m_abaqus.mtx"),
            lambda: read_dofs(folder / "b.dof"),
            lambda: read_dof_table(folder / "dofs.txt"),
        ):
            with pytest.raises(InputError, match=r"its last line has no end; allowed: a table that is whole"):
                read()
        deck = folder / "m.inp"
        nodes = deck.read_text().partition("** a comment")[0]
        deck.write_text(nodes)
        assert len(read_mesh_nodes(deck).numbers) == 12
        deck.write_text(nodes.rpartition(",")[0])
        with pytest.raises(
            InputError, match=r"m.inp, line 14: got .*, which has no end; allowed: a deck that is whole"
        ):
            read_mesh_nodes(deck)

    def test_a_large_file_of_nothing(self, tmp_path):
        path = tmp_path / "a.dof"
        with path.open("wb") as file:
            file.truncate(3_000_000_000)  # takes no space on the disk
        with pytest.raises(InputError, match="which is no text in lines"):
            read_dofs(path)

    def test_rows_with_a_comment_in_any_language(self, tmp_path):
        path = tmp_path / "a.dof"
        path.write_text("# d\u00e9placements\n1.1\n", encoding="utf-8")
        assert [entry.tolist() for entry in read_dofs(path)] == [[1], [0]]


class TestPlaceOfAnInterface:
    @pytest.mark.parametrize("surface", ["nodes", "plane", "cylinder"])
    def test_far_from_its_nodes(self, files, surface):
        folder, model = files
        corners = [int(10 * node) for node in model.numbers[np.abs(model.positions[:, 0] - 0.2) < 1e-9]]
        edge = {"axis": "x", "diameter": "64.0312 mm"}
        # A diagonal of the face is 64.03 mm.
        for away, good in ((64.0, True), (64.1, False)):
            at = {"nodes": f"{200 + away} mm", "plane": "200 mm", "cylinder": f"{200 + away} mm"}[surface]
            given = {
                "nodes": {"nodes": corners},
                "plane": {"plane": {"axis": "x"}},
                "cylinder": {"cylinder": edge | {"from": f"{-away - 1} mm", "to": f"{-away + 1} mm"}},
            }[surface]
            y = f"{50 + away} mm" if surface == "plane" else "25 mm"
            _, problems = table(folder, interfaces={"left": LEFT, "right": {"at": [at, y, "20 mm"], **given}})
            told = [problem for problem in problems.splitlines() if "interface 'right', at: got" in problem]
            assert not told if good else told, problems
            if told:
                assert "64.1 mm from its 4 nodes, whose centroid is at 200 mm, 25 mm, 20 mm; allowed: up to" in told[0]
                assert "check at, the nodes and units" in told[0]

    def test_a_single_node_may_have_a_place_beside_it(self, files):
        """Up to the part of the mesh's extent that a point may be off."""
        near = {"at": ["109 mm", "0 mm", "0 mm"], "nodes": [30], "freedoms": ["x", "y", "z"]}
        for change, words in (
            ({}, "got one, which does not say how the place turns"),
            ({"at": ["0.3 m", "0 m", "0 m"]}, "at: got 300"),
        ):
            _, problems = table(files[0], interfaces={"left": LEFT, "right": near | change})
            assert words in problems


def slip_of(path):
    with pytest.raises(InputError) as caught:
        command.read_body_file(path)
    return caught.value.problems


LEFT = {"at": ["0 mm", "25 mm", "20 mm"], "plane": {"axis": "x"}, "kind": "rigid"}

BODY = """
matrices = { format = "calculix", stiffness = "b.sti", mass = "b.mas", dofs = "b.dof" }
mesh = "m.inp"
units = "SI"
cutoff = "20 kHz"
assumed = ["interfaces"]
[interfaces]
left = { at = ["0 mm", "25 mm", "20 mm"], plane = { axis = "x" }, kind = "rigid" }
right = { at = ["200 mm", "25 mm", "20 mm"], plane = { axis = "x" } }
[points]
top = ["100 mm", "50 mm", "40 mm"]
node = 20
face = { at = ["100 mm", "25 mm", "20 mm"], plane = { axis = "x", diameter = "70 mm" } }
"""
