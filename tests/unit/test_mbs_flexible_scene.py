"""Flexible bodies in scenes: their table, their interfaces, and how far they reach."""

from __future__ import annotations

import argparse
import re
import sys

import numpy as np
import pytest
from scipy import sparse

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from mbs import cli
from mbs.commands.scenes import reduce as command
from mbs.flexible.finite_elements import Extent, FiniteElementModel, extent
from mbs.flexible.reduced_file import read_reduced
from mbs.model.body import FREEDOMS
from mbs.scene.assembly import build_body
from mbs.scene.flexible import read_flexible
from tests.cases.flexible import DENSITY, SIZE, block, written

ROUND_OFF = 1e-12


@pytest.fixture
def files(tmp_path):
    return written(tmp_path)


def read_table(folder, **changes):
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
    spec = read_flexible(section, "housing", folder)
    section.close(("name",))
    return spec, problems


def table(folder, **changes):
    """The body of a table, with all problems of reading and of building it."""
    spec, problems = read_table(folder, **changes)
    try:
        body = build_body(spec) if spec else None
    except InputError as error:
        return None, "\n".join([*problems, *error.problems])
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
            ({"matrices": {"format": "ansys"}}, "format: got 'ansys'; allowed: 'calculix'"),
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
