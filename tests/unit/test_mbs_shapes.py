"""Shapes of modes in space: the line of a shaft, what is drawn, and the file for ParaView."""

from __future__ import annotations

import meshio
import numpy as np
import pytest
from scipy.linalg import eigh

from mbs import cli
from mbs.flexible.shaft import flexible_shaft
from mbs.flexible.shaft_parts import Section
from mbs.linearised.shapes import AXIS, JOINT, MARK, skeleton
from mbs.model.system import System
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene


def shaft(cutoff, freedoms=("y", "theta_z")):
    section = Section(0.0, 0.4, 0.03)
    return flexible_shaft("s", [section], [], freedoms, (0.0, 0.0, 0.0), {"a": 0.0, "b": 0.4}, cutoff=cutoff)


def test_the_line_of_a_reduced_shaft_is_that_of_the_whole_one():
    """First bending of a free shaft: the reduced one moves along its line as one of all nodes does, and a free beam."""
    shapes = []
    for body in (shaft(20e3), shaft(None)):
        vectors = eigh(body.stiffness, body.mass)[1]
        line = skeleton(System([body])).transforms[: len(body.line), 1] @ vectors[:, 2]
        places = np.array([frame.position[0] for frame in body.line])
        shapes.append(np.interp(np.linspace(0.0, 0.4, 11), places, line / line[0]))
    # Modes of the held shaft above 20 kHz are left out, and nodes lie elsewhere: lines between them.
    np.testing.assert_allclose(shapes[0], shapes[1], atol=5e-3)
    # Euler's beam of 13 diameters: beta l = 4.73004, in its middle -0.6078 of its ends; shear takes 2 % of that.
    assert shapes[0][5] == pytest.approx(-0.6078, rel=0.03)


def test_turning_about_x_moves_a_mark():
    model = assemble(read_scene("gearbox"), "hertz")
    bones = skeleton(model.system)
    assert {AXIS, MARK, JOINT} == set(bones.kinds)  # the housing is drawn by its surface
    shape = np.zeros(model.system.size, dtype=complex)
    for place, name in enumerate(model.system.coordinates):
        if name.startswith("shaft_1.") and name.endswith("theta_x"):
            shape[place] = 1.0
    moved = bones.displacement(shape)
    for (begin, end), kind in zip(bones.lines, bones.kinds, strict=True):
        own = bones.bodies[bones.owners[begin]] == "shaft_1"
        if kind == MARK and own:
            across = bones.points[end] - bones.points[begin]
            # theta e_x times r e_z = -r theta e_y, to the round-off of static shapes
            np.testing.assert_allclose(np.abs(moved[end]), [0.0, across[2], 0.0], atol=1e-9)
        elif kind == AXIS:
            np.testing.assert_allclose(moved[[begin, end]], 0.0, atol=1e-9)


@pytest.mark.slow
def test_pictures_and_a_file(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = ["modes", "nu308_rigid", "--highest", "9 kHz"]
    assert cli.main([*words, "--shapes", "s.png", "--shapes-file", "s.vtu", "--shape-modes", "5", "1", "999"]) == 0
    out = capsys.readouterr().out
    assert "s.png: written" in out and "s.vtu: written, 2 modes" in out
    assert "--shape-modes: mode 999 is not there" in out
    mesh = meshio.read("s.vtu")
    names = [name for name in mesh.point_data if name.endswith("_real")]
    assert [name[:9] for name in names] == ["mode_005_", "mode_001_"]
    sizes = [np.abs(mesh.point_data[name] + 1j * mesh.point_data[name.replace("real", "imaginary")]) for name in names]
    np.testing.assert_allclose([size.max() for size in sizes], 1.0, rtol=1e-12)
    # Written again, and not over something else.
    assert cli.main([*words, "--shapes", "s.png", "--shapes-file", "s.vtu"]) == 0
    (tmp_path / "mine.vtu").write_text("<VTKFile/>")
    capsys.readouterr()
    for more, message in (
        (["--shapes-file", "mine.vtu"], "is not mode shapes of mbs"),
        (["--shapes-file", "a.xyz"], "--shapes-file: got a.xyz; allowed: a file that ends in .vtu"),
        (["--shapes", "a.vtu"], "--shapes: got a.vtu; allowed: a file that ends in .png"),
        (["--shape-modes", "1"], "--shape-modes: stands without --shapes"),
        (["--shapes", "a.png", "--shape-modes", "x"], "--shape-modes: got 'x'; allowed: numbers of modes"),
        (["--shapes", "a.png", "--shape-modes", *"1234567"], "got 7 modes for a picture; allowed: up to 6"),
    ):
        assert cli.main([*words, *more]) == 2
        assert message in capsys.readouterr().err
