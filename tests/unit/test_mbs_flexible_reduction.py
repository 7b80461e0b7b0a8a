"""Reduction of finite-element bodies, the reduced body, and its file."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import ArpackError

from ehdmaps.errors import AnalysisError, InputError
from mbs.flexible import held_body
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.reduced_body import ReducedBody, to_body, up_to
from mbs.flexible.reduced_file import read_reduced, write_reduced
from mbs.flexible.reduction import Interface, nodes_in_plane, reduce
from mbs.model.body import Frame
from tests.cases.flexible import block, ends, spring

ROUND_OFF = 1e-12


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
        assert np.array_equal(found.left_out, reduced.left_out) and found.cutoff == 20e3
        # modes that are dropped are left out as if they had never been kept: accuracy of static shapes and modes
        fewer = up_to(found, 12e3)
        other = reduce(model, ends(model), cutoff=12e3)
        assert fewer.size == other.size < found.size
        np.testing.assert_allclose(fewer.left_out, other.left_out, rtol=0.0, atol=1e-7 * np.abs(other.left_out).max())
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
