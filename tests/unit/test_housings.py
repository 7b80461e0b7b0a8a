"""Designs, meshes, decks and messages of the housings; neither gmsh nor CalculiX is needed."""

from __future__ import annotations

import math
import os
import re
import shlex
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.solids import STEEL
from ehdmaps.solids import calculix
from ehdmaps.solids.mesh_plane import load_gmsh
from examples.housings import __main__ as command_line
from examples.housings import geometry, make, solve
from examples.housings.deck import deck
from examples.housings.designs import HOUSINGS, GearboxShape, housing
from examples.housings.mesh import Mesh
from examples.housings.picture import housing_figure
from mbs.bearings.bearing import Bearing

ROOT = Path(__file__).parents[2]
SCENES = ("gearbox", "n1014_testrig", "nu308_flexible")
"""Shipped scenes with such a housing."""

CORNERS = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 5.0]])
"""A tetrahedron of volume 2*3*5/6 = 5 m3."""

NONE = np.zeros(0, dtype=np.int64)


def middles(corners: np.ndarray) -> np.ndarray:
    return np.array([0.5 * (corners[i] + corners[j]) for i, j in ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))])


def one_element(corners: np.ndarray = CORNERS) -> Mesh:
    return Mesh(np.vstack([corners, middles(corners)]), np.arange(10)[None, :])


def test_seats_are_those_of_the_bearings():
    # outer rings of the named bearings: catalogue d 40 D 90 B 23 (NU308), d 70 D 110 B 20 (N1014)
    for name, bearing, diameter, width in (
        ("gearbox_housing", "NU308", 90e-3, 23e-3),
        ("nu308_housing", "NU308", 90e-3, 23e-3),
        ("n1014_housing", "N1014", 110e-3, 20e-3),
    ):
        for seat in HOUSINGS[name].seats.values():
            assert (seat.diameter, seat.width) == (diameter, width)
            assert seat.diameter > Bearing.named(bearing).geometry.outer_raceway_diameter


def test_gears_turn_freely_in_the_gearbox():
    shape = HOUSINGS["gearbox_housing"].shape
    assert isinstance(shape, GearboxShape)
    module = 4.5e-3
    assert shape.centre_distance == pytest.approx(module * (21 + 23) / 2, rel=1e-12)  # rounding
    for y, teeth in ((0.0, 21), (shape.centre_distance, 23)):
        tip = 0.5 * module * (teeth + 2)
        assert y - tip > shape.inner_y[0] + 5e-3
        assert y + tip < shape.inner_y[1] - 5e-3
        assert -tip > shape.inner_z[0] + 5e-3
        assert tip < shape.inner_z[1] - 5e-3
    assert shape.seat_diameter < shape.centre_distance


def test_sensors_have_names_of_their_own():
    for entry in HOUSINGS.values():
        assert not set(entry.seats) & set(entry.sensors)
        assert entry.sensors
        assert all(place[2] > entry.ground for place in entry.sensors.values())


def test_help_names_every_housing():
    assert ", ".join(HOUSINGS) in " ".join(command_line.parser().format_help().split())


@pytest.mark.parametrize("name", ["gearbox_housin", "", "x" * 10000, None, 7])
def test_unknown_housing(name):
    with pytest.raises(InputError, match=r"housing: got .{0,80}; allowed: gearbox_housing, nu308_housing"):
        housing(name)


def test_a_slip_of_the_pen_is_recognised():
    with pytest.raises(InputError, match="did you mean 'gearbox_housing'"):
        housing("gearbox_housin")


def test_volume_of_one_element():
    mesh = one_element()
    assert mesh.volume == pytest.approx(5.0, rel=1e-14)  # rounding: the rule is exact
    assert mesh.least_quality() == pytest.approx(1.0, rel=1e-13)
    assert len(mesh.surface) == 4


def test_volume_of_a_curved_element():
    # Moving the node on edge 1-2 by d along -z moves every point by 4 l1 l2 d, which makes the volume linear in d. The
    # face z = 0 of area A sweeps the integral of 4 l1 l2 d over it, A d/3; the other face at the edge moves in itself.
    bulge = 0.1
    mesh = one_element()
    positions = mesh.positions.copy()
    positions[4, 2] -= bulge
    area = 0.5 * 2.0 * 3.0
    assert Mesh(positions, mesh.elements).volume == pytest.approx(5.0 + area * bulge / 3.0, rel=1e-13)  # rounding


def test_element_turned_inside_out_is_seen():
    assert one_element(CORNERS[[1, 0, 2, 3]]).volume == pytest.approx(-5.0)
    mesh = one_element()
    positions = mesh.positions.copy()
    positions[4] = [-1.0, 0.0, 0.0]
    assert Mesh(positions, mesh.elements).least_quality() < 0.0


def test_faces_look_outwards():
    mesh = one_element()
    a, b, c = (mesh.positions[mesh.surface[:, k]] for k in range(3))
    # divergence theorem for the field r/3
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0 == pytest.approx(5.0, rel=1e-14)
    for face in mesh.surface:
        for k, (i, j) in enumerate(((0, 1), (1, 2), (0, 2))):
            middle = 0.5 * (mesh.positions[face[i]] + mesh.positions[face[j]])
            np.testing.assert_allclose(mesh.positions[face[3 + k]], middle, atol=1e-15)


def test_areas_add_up_to_the_face():
    mesh = one_element()
    bottom = mesh.near_height(0.0)
    assert sorted(bottom.tolist()) == [0, 1, 2, 4, 5, 6]
    areas = mesh.areas(bottom)
    assert areas.sum() == pytest.approx(3.0, rel=1e-14)  # rounding
    # a corner has one of the four parts and shares it with two nodes, an edge has three
    np.testing.assert_allclose(areas, np.where(bottom < 4, 3.0 / 12.0, 3.0 / 4.0), rtol=1e-14)
    assert mesh.areas(np.array([0, 1]))[0] == 0.0


@pytest.mark.parametrize(
    ("positions", "elements", "message"),
    [
        (np.full((10, 3), np.nan), np.arange(10)[None, :], "positions: got .* all finite"),
        (np.zeros((10, 2)), np.arange(10)[None, :], "positions: got"),
        (np.zeros((10, 3)), np.zeros((0, 10), dtype=np.int64), "elements: got"),
        (np.zeros((10, 3)), np.arange(4)[None, :], "elements: got"),
        (np.zeros((10, 3)), np.arange(1, 11)[None, :], "elements: got indices"),
        (np.zeros((11, 3)), np.arange(10)[None, :], "elements: got indices"),
    ],
)
def test_no_mesh(positions, elements, message):
    with pytest.raises(InputError, match=message):
        Mesh(positions, elements)


def test_deck_keeps_to_the_columns_of_calculix():
    mesh = one_element(CORNERS * np.array([-1.0, -1.0, 1.0]) * 1.23456789e-7)
    text = deck(mesh, STEEL, np.arange(10), 3, matrices=True)
    for line in text.splitlines():
        fields = line.split(",")
        assert len(fields) <= 16
        if not line.startswith("*"):
            assert all(0 < len(field) <= 20 for field in fields)
    assert "*FREQUENCY, SOLVER=MATRIXSTORAGE\n3\n*END STEP\n" in text
    assert "*BOUNDARY\nCLAMPED,1,3\n" in text
    assert "1,1,2,3,4,5,6,7,8,9,10\n" in text


def test_deck_of_a_free_solid_clamps_nothing():
    text = deck(one_element(), STEEL, NONE, 2, matrices=False)
    assert "BOUNDARY" not in text
    assert "*FREQUENCY\n2\n" in text


@pytest.mark.parametrize("size", [0.0, -1.0, 1e-6, 1.0, math.nan, math.inf])
def test_size_of_elements(size):
    with pytest.raises(InputError, match=r"size of the elements: got .* mm; allowed: 5 mm to 40 mm"):
        geometry.mesh_housing(HOUSINGS["nu308_housing"], size)


@pytest.mark.parametrize("cutoff", [0.0, -8e3, 1e9, math.nan, math.inf])
def test_cutoff(cutoff):
    with pytest.raises(InputError, match=r"cutoff: got .* Hz; allowed: 100 Hz to 30 kHz"):
        make.make(HOUSINGS["nu308_housing"], 13e-3, cutoff)


def test_without_calculix(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match=r"ccx is not in PATH.*apt-get install calculix-ccx"):
        make.make(HOUSINGS["nu308_housing"], 13e-3, 8e3)


@pytest.mark.parametrize("error", ["missing module", "missing library"])
def test_without_gmsh(monkeypatch, tmp_path, error):
    monkeypatch.delitem(sys.modules, "gmsh", raising=False)
    if error == "missing module":
        monkeypatch.setitem(sys.modules, "gmsh", None)
    else:
        (tmp_path / "gmsh.py").write_text("raise OSError('libGLU.so.1: cannot open shared object file')")
        monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match=r'gmsh cannot be loaded .*pip install "ehdmaps\[solids\]".*libglu1-mesa'):
        load_gmsh("drawing a housing")


def fake(folder: Path, monkeypatch, script: str) -> None:
    """Put a ccx of our own before all others."""
    program = folder / "bin" / "ccx"
    program.parent.mkdir()
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{program.parent}{os.pathsep}{os.environ['PATH']}")


def test_calculix_that_fails(monkeypatch, tmp_path):
    fake(tmp_path, monkeypatch, "echo '*ERROR in e_c3d: nonpositive jacobian'; exit 201")
    with pytest.raises(AnalysisError, match=r"ended with status 201; last lines .*nonpositive jacobian"):
        solve.matrices(one_element(), STEEL, NONE, tmp_path)


def test_calculix_that_crashes(monkeypatch, tmp_path):
    fake(tmp_path, monkeypatch, "kill -SEGV $$")
    with pytest.raises(AnalysisError, match=r"ended with status -11; last lines of its output: none"):
        solve.matrices(one_element(), STEEL, NONE, tmp_path)


def test_calculix_that_hangs(monkeypatch, tmp_path):
    fake(tmp_path, monkeypatch, "exec sleep 60")
    monkeypatch.setattr(calculix, "LONGEST_RUN", 0.2)
    with pytest.raises(AnalysisError, match="not done after"):
        solve.own_frequencies(one_element(), STEEL, NONE, 1, tmp_path)


def test_calculix_that_cannot_be_started(monkeypatch, tmp_path):
    fake(tmp_path, monkeypatch, "")
    (tmp_path / "bin" / "ccx").write_bytes(b"\x00\x01 no program")
    with pytest.raises(AnalysisError, match="cannot be started"):
        solve.own_frequencies(one_element(), STEEL, NONE, 1, tmp_path)


@pytest.mark.parametrize(
    "script",
    [
        "exit 0",
        "echo '      1   0.4E+01   0.2E+01   0.3183099E+00' > housing.dat",
        "echo '      1   NAN   NAN   NAN  NAN' > housing.dat",
    ],
)
def test_calculix_that_leaves_no_frequencies(monkeypatch, tmp_path, script):
    fake(tmp_path, monkeypatch, script)
    with pytest.raises(AnalysisError, match=r"housing\.dat holds 0 of 1 frequencies"):
        solve.own_frequencies(one_element(), STEEL, NONE, 1, tmp_path)


def test_frequencies_are_read_in_cycles(monkeypatch, tmp_path):
    row = "1   0.5276061E+08   0.7263650E+04   0.1156046E+04   0.0000000E+00"
    fake(tmp_path, monkeypatch, f"echo '      {row}' > housing.dat")
    (found,) = solve.own_frequencies(one_element(), STEEL, NONE, 1, tmp_path)
    assert found == pytest.approx(7263.650 / (2.0 * math.pi), rel=1e-6)  # digits of the file


def test_version_of_calculix(monkeypatch, tmp_path):
    fake(tmp_path, monkeypatch, "echo; echo 'This is Version 2.20'")
    assert calculix.version("a test") == "2.20"


def test_every_problem_of_the_arguments_at_once(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments = ["castle", "--size", "1 km", "--cutoff", "8", "-o", "none/a.nc", "--picture", "a.doc"]
    assert command_line.main(arguments) == 2
    shown = capsys.readouterr().err
    assert shown.startswith("examples.housings: 5 problems\n")
    for part in (
        "housing: got 'castle'",
        "--size: ",
        "--cutoff: got '8' without a unit",
        "-o: got none",
        "ends in .png",
    ):
        assert part in shown
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("size", ["0 mm", "-3 mm", "1e300 m", "30 mm"])
def test_sizes_of_the_table(capsys, size):
    assert command_line.main(["nu308_housing", "--convergence", "--size", size]) == 2
    assert "--size: size of the elements: got" in capsys.readouterr().err  # 30 mm: 1.5 times that is too large


def test_exit_status_of_a_failed_run(capsys, tmp_path, monkeypatch):
    def fails(*_):
        raise AnalysisError("gmsh: no mesh")

    monkeypatch.chdir(tmp_path)
    fake(tmp_path, monkeypatch, "exit 0")
    monkeypatch.setattr(make, "mesh_housing", fails)
    assert command_line.main(["nu308_housing"]) == 1
    assert "gmsh: no mesh" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["bin"]


def test_mesh_that_is_too_fine(monkeypatch, tmp_path):
    fake(tmp_path, monkeypatch, "exit 0")
    monkeypatch.setattr(make, "mesh_housing", lambda *_: one_element())
    monkeypatch.setattr(make, "MOST_COORDINATES", 29)
    with pytest.raises(InputError, match=r"got 5 mm, which makes 30 coordinates; allowed: up to 29; take larger"):
        make.make(HOUSINGS["nu308_housing"], 5e-3, 8e3)


def test_folder_to_keep_must_be_empty(tmp_path, monkeypatch):
    fake(tmp_path, monkeypatch, "exit 0")
    monkeypatch.setattr(make, "mesh_housing", lambda *_: one_element())
    with pytest.raises(InputError, match=r"--keep: .* is not empty; allowed: a new or empty folder"):
        make.make(HOUSINGS["nu308_housing"], 13e-3, 8e3, keep=tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match=r"--keep: .* cannot be made"):
        make.make(HOUSINGS["nu308_housing"], 13e-3, 8e3, keep=tmp_path / "file")


def test_picture_names_seats_and_sensors():
    chosen = replace(HOUSINGS["nu308_housing"])
    figure = housing_figure(chosen, one_element())
    shown = {text.get_text().strip() for panel in figure.axes for text in panel.texts}
    assert {*chosen.seats, *chosen.sensors} <= shown


@pytest.mark.parametrize(
    "page",
    ["examples/README.md", "docs/machines.md", *(f"mbs/systems/{name}.toml" for name in SCENES)],
)
def test_commands_that_are_shown_are_understood(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    shown = re.findall(r"`python -m examples\.housings\s([^`]*)`", text)
    assert shown
    assert all(command_line.parser().parse_args(shlex.split(words)).name in HOUSINGS for words in shown)
