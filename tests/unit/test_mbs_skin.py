"""Surfaces of finite-element bodies: from elements to triangles, through reduction and files, to pictures and pages."""

from __future__ import annotations

import base64
import json
import re
from dataclasses import replace
from types import SimpleNamespace

import meshio
import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs.flexible.reduced_body import to_body, up_to
from mbs.flexible.reduced_file import read_reduced, write_reduced
from mbs.flexible.reduction import reduce
from mbs.flexible.skin import read_skin, skin_triangles
from mbs.linearised.shapes import skeleton
from mbs.model.system import System
from mbs.output.shapes.shapes_file import FRAMES, series_files, write_shapes
from mbs.output.shapes.shapes_page import shapes_page
from tests.cases.flexible import block, ends

CUBE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], dtype=float)


def volume(places, triangles):
    """By the divergence theorem: right only of a closed surface, seen from outside."""
    a, b, c = (places[triangles[:, k]] for k in range(3))
    return float(np.sum(a * np.cross(b, c)) / 6.0)


class TestTriangles:
    @pytest.mark.parametrize(
        ("elements", "expected", "count"),
        [
            ({"hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]]}, 1.0, 12),
            ({"tetra": [[0, 1, 2, 5]]}, 1.0 / 6.0, 4),
            ({"wedge": [[0, 1, 3, 4, 5, 7], [1, 2, 3, 5, 6, 7]]}, 1.0, 12),
            ({"wedge": [[0, 1, 3, 4, 5, 7]]}, 0.5, 8),
            ({"pyramid": [[0, 1, 2, 3, 4]]}, 1.0 / 3.0, 6),
            # A shell on a solid is no surface of its own.
            ({"hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]], "quad": [[0, 1, 2, 3]]}, 1.0, 12),
        ],
    )
    def test_they_enclose_the_elements(self, elements, expected, count):
        triangles = skin_triangles({kind: np.array(nodes) for kind, nodes in elements.items()})
        assert len(triangles) == count
        assert volume(CUBE, triangles) == pytest.approx(expected, rel=1e-14)  # round-off

    def test_shells_alone(self):
        assert skin_triangles({"triangle": np.array([[1, 2, 3]]), "quad": np.array([[2, 3, 4, 5]])}).tolist() == [
            [1, 2, 3], [2, 3, 4], [2, 4, 5]
        ]  # fmt: skip


DECK = """*NODE
1, 0., 0., 0.
*ELEMENT, TYPE=C3D10, ELSET=all
1, 11, 12, 13, 14, 101, 102, 103, 104,
105, 106
** a comment
2, 12, 13, 14, 15, 1, 2, 3, 4, 5, 6
*ELEMENT, TYPE=T3D2
3, 11, 12
*Element, elset=b, type=S8R
4, 21, 22, 23, 24, 1, 2, 3, 4
*STEP
9, 9, 9
"""


class TestMeshes:
    def test_a_deck(self, tmp_path):
        path = tmp_path / "m.inp"
        path.write_text(DECK)
        expected = skin_triangles(
            {"tetra": np.array([[11, 12, 13, 14], [12, 13, 14, 15]]), "quad": np.array([[21, 22, 23, 24]])}
        )
        np.testing.assert_array_equal(read_skin(path), expected)

    def test_a_deck_that_is_damaged(self, tmp_path):
        path = tmp_path / "m.inp"
        path.write_text(DECK.replace("105, 106", "105, x"))
        with pytest.raises(InputError, match=r"m.inp, line 5: got '105, x'; allowed: numbers of an element"):
            read_skin(path)

    def test_other_meshes_and_files_that_are_none(self, tmp_path):
        path = tmp_path / "m.vtk"
        meshio.Mesh(CUBE, [("hexahedron", [[0, 1, 2, 3, 4, 5, 6, 7]]), ("line", [[0, 1]])]).write(path)
        # points count from 1
        assert volume(CUBE, read_skin(path) - 1) == pytest.approx(1.0, rel=1e-14)
        other = tmp_path / "n.vtk"
        other.write_text("no mesh")
        assert read_skin(other).shape == (0, 3)


@pytest.fixture(scope="module")
def reduced():
    """A free steel block with both ends as interfaces, and a surface."""
    model = block()
    faces = ends(model, "rigid")
    left, right = (face.nodes for face in faces.values())
    # Any triangles do: between the nodes of both ends, and one with a node that is not there.
    corners = np.array([[left[0], left[1], right[0]], [right[0], right[1], left[1]], [1, 2, 10**9]])
    return reduce(model, faces, {"seen": int(right[0])}, 1e5, triangles=corners)


class TestReduction:
    def test_the_surface_moves_as_the_points_on_it(self, reduced):
        skin = reduced.skin
        assert skin.triangles.shape == (2, 3) and skin.positions.shape == (4, 3)
        seen = reduced.frames["seen"]
        (place,) = np.flatnonzero(np.all(np.abs(skin.positions - seen.position) < 1e-12, axis=1))
        np.testing.assert_array_equal(skin.transforms[place], seen.transform[:3])

    @pytest.mark.parametrize("ending", [".nc", ".npz"])
    def test_it_is_kept_in_files(self, reduced, ending, tmp_path):
        path = tmp_path / f"b{ending}"
        write_reduced(path, reduced)
        found = read_reduced(path)
        np.testing.assert_array_equal(found.stiffness, reduced.stiffness)
        np.testing.assert_array_equal(found.skin.triangles, reduced.skin.triangles)
        # single precision, and three digits in netCDF
        np.testing.assert_allclose(found.skin.positions, reduced.skin.positions, rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(found.skin.transforms, reduced.skin.transforms, rtol=1e-3, atol=1e-9)
        write_reduced(path, replace(reduced, skin=None))
        assert read_reduced(path).skin is None

    def test_a_lower_cutoff_and_a_turn(self, reduced):
        cut = up_to(reduced, 0.0)
        np.testing.assert_array_equal(cut.skin.transforms, reduced.skin.transforms[:, :, : cut.size])
        quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        body = to_body(reduced, "b", (1.0, 2.0, 3.0), rotation=quarter)
        np.testing.assert_allclose(
            body.skin.positions, reduced.skin.positions @ quarter.T + [1.0, 2.0, 3.0], rtol=1e-14
        )
        np.testing.assert_array_equal(body.skin.transforms[:, 1], reduced.skin.transforms[:, 0])

    def test_surfaces_that_do_not_fit(self, reduced):
        for skin, message in (
            (replace(reduced.skin, triangles=np.array([[0, 1, 4]])), "got corners 0 to 4 of 4 places; allowed: 0 to 3"),
            (replace(reduced.skin, transforms=np.zeros((4, 3, 1))), "surface: got shapes"),
            (replace(reduced.skin, positions=np.full((4, 3), np.nan)), "no finite numbers"),
        ):
            with pytest.raises(InputError, match=message):
                replace(reduced, skin=skin)


@pytest.fixture(scope="module")
def moving(reduced):
    """A system of the block, and two modes of it: one real, one that goes round."""
    bones = skeleton(System([to_body(reduced, "<b>")]))
    shapes = np.zeros((reduced.size, 2), dtype=complex)
    shapes[1, 0], shapes[1, 1], shapes[2, 1] = 1.0, 1.0, 1j
    found = SimpleNamespace(shapes=shapes, frequency=np.array([10.0, 1234.5]), damping_ratio=np.array([0.01, 0.02]))
    return found, bones


class TestPictures:
    def test_a_series_turns_once(self, moving, tmp_path):
        found, bones = moving
        files = write_shapes(tmp_path / "m.pvd", found, bones, [0, 1])
        assert files[1:] == series_files(tmp_path / "m.pvd")
        text = (tmp_path / "m.pvd").read_text()
        assert re.findall(r'file="(.*?)"', text) == [file.name for file in files[1:]]
        first, quarter, half = (meshio.read(files[1 + k * FRAMES // 4]) for k in range(3))
        for mode, name in enumerate(("mode_001_10Hz", "mode_002_1234Hz")):
            moved = bones.scaled(found.shapes[:, mode])
            assert max(np.abs(moved.real).max(), np.abs(moved.imag).max()) > 0.7
            for file, expected in ((first, moved.real), (quarter, -moved.imag), (half, -moved.real)):
                np.testing.assert_allclose(file.point_data[name], expected, atol=1e-12)  # text of 11 digits and more
        assert [len(cells.data) for cells in first.cells if cells.type == "triangle"] == [2]

    def test_a_page_holds_the_shapes(self, moving):
        found, bones = moving
        page = shapes_page("A <title>", "words", found, bones, [1], {1: "first of <b>"})
        assert "<title>A &lt;title&gt;</title>" in page and not re.search(r"https?://", page)
        data = json.loads(re.search(r'id="shapes-data">(.*?)</script>', page)[1])
        assert data["names"][0] == ["<b>", "surface"]
        (mode,) = data["modes"]
        assert mode["name"].endswith("(first of <b>)")
        parts = [np.frombuffer(base64.b64decode(mode[name]), dtype="<i2") / 32767 for name in ("real", "imaginary")]
        # 16 bits
        np.testing.assert_allclose(
            (parts[0] + 1j * parts[1]).reshape(-1, 3), bones.scaled(found.shapes[:, 1]), atol=0.6 / 32767
        )
        places = np.frombuffer(base64.b64decode(data["points"]), dtype="<f4").reshape(-1, 3)
        np.testing.assert_allclose(places, bones.points, rtol=1e-6, atol=1e-9)

    def test_a_body_with_a_surface_is_drawn_by_it(self, moving):
        _, bones = moving
        assert len(bones.triangles) == 2 and len(bones.lines) == 0
