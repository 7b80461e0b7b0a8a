"""Housings against closed forms, CalculiX' own frequencies, beams, and the shipped files made anew on a coarse mesh."""

from __future__ import annotations

import contextlib
import functools
import io
import math
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh, spsolve

import mbs
from ehdmaps.errors import InputError
from ehdmaps.physics.solids import STEEL
from ehdmaps.solids.calculix import program
from ehdmaps.solids.mesh_plane import load_gmsh
from examples.housings import __main__ as command_line
from examples.housings import command, geometry, make, solve
from examples.housings.designs import HOUSINGS, PedestalShape
from mbs.flexible.finite_elements import NodePositions
from mbs.flexible.matrix_files import read_calculix
from mbs.flexible.reduced_file import read_reduced
from mbs.flexible.shaft import flexible_shaft
from mbs.flexible.shaft_parts import Section

SHIPPED = Path(mbs.__file__).parent / "systems"
NONE = np.zeros(0, dtype=np.int64)

pytestmark = pytest.mark.slow


@functools.cache
def why_not() -> str:
    try:
        load_gmsh("a test")
        program("a test")
    except InputError as error:
        return str(error)
    return ""


@pytest.fixture(scope="session")
def programs():
    """gmsh and CalculiX: skipped without them, but in CI a failure."""
    if reason := why_not():
        pytest.skip(reason)


class Coarse(NamedTuple):
    made: make.Made
    folder: Path
    shown: str


@pytest.fixture(scope="module")
def run(programs, tmp_path_factory):
    """The command on the smallest housing with a coarse mesh, and what it made."""
    folder = tmp_path_factory.mktemp("housing")
    made = []

    def spy(*arguments):
        made.append(make.make(*arguments))
        return made[0]

    output = io.StringIO()
    arguments = ["nu308_housing", "--size", "24 mm", "-o", str(folder / "housing.nc")]
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(output):
        patch.setattr(command, "make", spy)
        more = ["--picture", str(folder / "housing.png"), "--keep", str(folder / "kept")]
        assert command_line.main([*arguments, *more]) == 0
    return Coarse(made[0], folder, output.getvalue())


@pytest.fixture(scope="module")
def coarse(run):
    return run.made


def shipped_numbers(reduced, attribute: str) -> np.ndarray:
    return np.array([float(word) for word in re.findall(r"\d[\d.]*(?:e[+-]?\d+)?", reduced.attributes[attribute])])


def box(gmsh):
    return 3, gmsh.model.occ.addBox(-30.0, 0.0, 10.0, 60.0, 40.0, 30.0)


def shaft(gmsh):
    return 3, gmsh.model.occ.addCylinder(-120.0, 0.0, 0.0, 240.0, 0.0, 0.0, 20.0)


def test_volume_of_a_cylinder(programs):
    errors = []
    for around in (8, 16):
        mesh = geometry.tetrahedra(shaft, 30e-3, around=around)
        errors.append(1.0 - mesh.volume / (math.pi * 0.02**2 * 0.24))
        # A parabola for an arc of angle t: the area t - sin t between arc and chord is t^4/480 of the sector too small.
        angle = 2.0 * math.pi / around
        assert 0.0 < errors[-1] < 1.05 * angle**4 / 480.0
    assert errors[1] < errors[0] / 8.0  # fourth order, and no mesh has exactly these angles


def test_same_mesh_twice(programs):
    first, second = (geometry.mesh_housing(HOUSINGS["nu308_housing"], 30e-3) for _ in range(2))
    assert np.array_equal(first.positions, second.positions)
    assert np.array_equal(first.elements, second.elements)


def test_two_solids_are_no_housing(programs):
    def draw(gmsh):
        gmsh.model.occ.addBox(100.0, 0.0, 0.0, 10.0, 10.0, 10.0)
        return box(gmsh)

    with pytest.raises(make.AnalysisError, match="the drawing has 2 solids; allowed: one"):
        geometry.tetrahedra(draw, 20e-3)


def test_drawing_that_fails(programs):
    def draw(gmsh):
        return 3, gmsh.model.occ.addCylinder(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0)

    with pytest.raises(make.AnalysisError, match=r"gmsh: no mesh with elements of 20 mm .*try another size"):
        geometry.tetrahedra(draw, 20e-3)
    # and the session is over
    assert geometry.tetrahedra(box, 20e-3).volume == pytest.approx(72e-6, rel=1e-12)  # rounding: flat faces


def test_point_off_the_surface(programs):
    with pytest.raises(InputError, match=r"point at .* is on no face of the solid"):
        geometry.tetrahedra(box, 20e-3, [(0.0, 0.02, 0.025)])


def test_linear_fields_in_the_matrices_of_calculix(programs, tmp_path):
    # Fields that are linear in space are exact in any mesh: energy and mass have closed forms. They fail for a wrong
    # order of nodes, wrong units and a matrix that is read by its wrong half.
    mesh = geometry.tetrahedra(box, 20e-3)
    model = solve.matrices(mesh, STEEL, NONE, tmp_path)
    assert model.size == mesh.positions.size
    volume = 60e-3 * 40e-3 * 30e-3
    shear = STEEL.youngs_modulus / (2.0 * (1.0 + STEEL.poisson_ratio))
    first = 2.0 * shear * (1.0 - STEEL.poisson_ratio) / (1.0 - 2.0 * STEEL.poisson_ratio)
    x, y, z = (mesh.positions - [0.0, 20e-3, 25e-3])[model.nodes - 1].T

    def along(direction, values):
        return np.where(model.directions == direction, values, 0.0)

    # 14 digits of the file, as the entries add up to 1e-3 of the largest
    for field, energy in ((along(0, x), first), (along(1, y), first), (along(0, y), shear), (along(1, z), shear)):
        assert field @ (model.stiffness @ field) == pytest.approx(energy * volume, rel=1e-9)
    turn = along(1, -z) + along(2, y)
    assert abs(turn @ (model.stiffness @ turn)) < 1e-9 * shear * volume
    mass = STEEL.density * volume
    for direction in range(3):
        push = along(direction, 1.0)
        assert push @ (model.mass @ push) == pytest.approx(mass, rel=1e-9)
    assert turn @ (model.mass @ turn) == pytest.approx(mass * (40e-3**2 + 30e-3**2) / 12.0, rel=1e-9)


def test_shaft_of_calculix_against_beams(programs, tmp_path):
    mesh = geometry.tetrahedra(shaft, 12e-3, around=10)
    model = solve.matrices(mesh, STEEL, NONE, tmp_path)
    shift = -((2.0 * math.pi * 500.0) ** 2)  # the free shaft is singular at 0 Hz
    values = eigsh(model.stiffness, 14, model.mass, sigma=shift, return_eigenvectors=False)
    solid = np.sqrt(np.sort(values)[6:]) / (2.0 * math.pi)
    section = Section(-0.12, 0.12, 40e-3, 0.0, STEEL.youngs_modulus, STEEL.poisson_ratio, STEEL.density)
    freedoms = ("x", "y", "z", "theta_x", "theta_y", "theta_z")
    beam = flexible_shaft("shaft", [section], [], freedoms, (0.0, 0.0, 0.0), {"middle": 0.0}, largest_element=5e-3)
    values = eigh(beam.stiffness, beam.mass, eigvals_only=True)
    beams = np.sqrt(values[6:14]) / (2.0 * math.pi)
    # Two bending pairs, torsion, axial, one more pair. Model error: plane sections, no lateral inertia of the axial
    # mode (nu^2 pi^2 r^2 / (4 L^2) = 0.15 %). Seen: 0.13 %, 0.05 %, 0.4 %, 0.16 %, 0.7 %.
    np.testing.assert_allclose(solid, beams, rtol=1e-2)


def test_sensors_are_nodes(coarse):
    housing = HOUSINGS["nu308_housing"]
    for name, place in housing.sensors.items():
        away = np.linalg.norm(coarse.mesh.positions - np.array(place), axis=1).min()
        assert away < 1e-9  # rounding of lengths in mm
        np.testing.assert_allclose(coarse.reduced.frames[name].position, place, atol=1e-9)


def test_reduced_housing_against_calculix(coarse):
    # Seats free, feet held. Craig and Bampton: modes above the cutoff are missing, which moves those below half of it
    # by less than 0.5 %.
    below = coarse.frequencies < 0.5 * HOUSINGS["nu308_housing"].cutoff
    assert below.sum() >= 6
    np.testing.assert_allclose(coarse.reduced_frequencies[below], coarse.frequencies[below], rtol=5e-3)
    # Fewer shapes are stiffer; the digits of CalculiX' file are 7.
    assert np.all(coarse.reduced_frequencies[below] > coarse.frequencies[below] * (1.0 - 1e-6))


def test_seat_against_a_force_on_it(run):
    # The static stiffness of a seat is exact in the reduced body: the full model gives it for the mean of the surface.
    housing = HOUSINGS["nu308_housing"]
    coarse, mesh = run.made, run.made.mesh
    files = [run.folder / "kept" / "matrices" / f"housing.{ending}" for ending in ("sti", "mas", "dof")]
    model = read_calculix(*files, NodePositions(np.arange(1, len(mesh.positions) + 1), mesh.positions))
    seat = housing.seats["left"]
    away = mesh.positions - np.array(seat.centre)
    on = (np.abs(np.hypot(away[:, 1], away[:, 2]) - 0.5 * seat.diameter) < 1e-6) & (
        np.abs(away[:, 0]) < 0.5 * seat.width + 1e-6
    )
    nodes = np.flatnonzero(on)
    areas = mesh.areas(nodes)
    # the surface stands for the areas of a cylinder, to the chords of a coarse mesh
    assert areas.sum() == pytest.approx(math.pi * seat.diameter * seat.width, rel=1e-2)
    force = np.zeros(model.size)
    # A unit force along z, spread so that it has no moment about the centre: by symmetry nearly the areas.
    arms = away[nodes]
    moments = np.column_stack([np.ones(len(nodes)), arms])
    weights = areas * (moments @ np.linalg.solve(moments.T @ (areas[:, None] * moments), [1.0, 0.0, 0.0, 0.0]))
    for node, weight in zip(nodes, weights, strict=True):
        force[model.row(int(node) + 1, 2)] = weight
    moved = spsolve(model.stiffness, force, permc_spec="MMD_AT_PLUS_A")
    # The two spreads of the force differ by what the mesh lacks in symmetry.
    assert 1.0 / (force @ moved) == pytest.approx(coarse.seat_stiffness["left"], rel=1e-3)


@pytest.mark.parametrize("name", list(HOUSINGS))
def test_shipped_file(name):
    housing = HOUSINGS[name]
    path = SHIPPED / f"{name}.nc"
    assert path.stat().st_size < 900_000  # most of it the surface, for pictures
    reduced = read_reduced(path)
    assert set(reduced.frames) == {*housing.seats, *housing.sensors}
    for key, seat in housing.seats.items():
        np.testing.assert_allclose(reduced.frames[key].position, seat.centre, atol=1e-12)
    for matrix in (reduced.mass, reduced.stiffness):
        assert np.linalg.eigvalsh(matrix).min() > 0.0
    assert f"m: {housing.shape}" in reduced.attributes["dimensions"]  # made of the present design
    # Modes above the cutoff are missing: up to 0.35 %, 0.47 % and 0.63 % of a frequency.
    clamped = shipped_numbers(reduced, "clamped_frequencies")
    below = clamped < 0.5 * housing.cutoff
    found = make.own_frequencies(reduced)[: len(clamped)]
    assert below.sum() >= 6
    np.testing.assert_allclose(found[below], clamped[below], rtol=7e-3)
    assert np.all(found[below] > clamped[below] * (1.0 - 1e-5))  # fewer shapes are stiffer; six digits
    # Seats at both ends are mirror images; the mesh is not quite.
    values = make.seat_stiffness(reduced, tuple(housing.seats))
    for key, value in values.items():
        if key.endswith("left"):
            assert value == pytest.approx(values[key.replace("left", "right")], rel=1e-2)


def test_shipped_file_against_a_coarse_mesh(coarse):
    reduced = read_reduced(SHIPPED / "nu308_housing.nc")
    clamped = shipped_numbers(reduced, "clamped_frequencies")
    # Discretisation: 24 mm against 13 mm, 0.3 to 1.8 % in the first ten, 1.5 % in the seats; coarser is stiffer.
    assert np.all(coarse.frequencies > clamped)
    np.testing.assert_allclose(coarse.frequencies, clamped, rtol=2.5e-2)
    for key, value in make.seat_stiffness(reduced, ("left", "right")).items():
        assert 1.0 < coarse.seat_stiffness[key] / value < 1.025
    # both follow the round faces to a part in a thousand
    mass = coarse.mesh.volume * HOUSINGS["nu308_housing"].material.density
    assert mass == pytest.approx(shipped_numbers(reduced, "total_mass")[0], rel=1e-3)


@pytest.mark.parametrize("name", ["nu308_housing", "n1014_housing"])
def test_mass_of_the_pedestals(name):
    housing = HOUSINGS[name]
    shape = housing.shape
    assert isinstance(shape, PedestalShape)
    radius, half, height = 0.5 * shape.head_diameter, 0.5 * shape.base_width, shape.axis_height
    # From the corner of the base a tangent of the head: triangle, sector of the head, and half the triangle below.
    reach = math.hypot(half, height)
    tangent = math.sqrt(reach**2 - radius**2)
    below = math.atan2(half, height) + math.acos(radius / reach)  # angle at the centre from straight down to the touch
    profile = 2.0 * (0.5 * half * height + 0.5 * radius * tangent + 0.5 * radius**2 * (math.pi - below))
    profile -= math.pi * 0.25 * shape.seat_diameter**2
    volume = 2.0 * profile * shape.seat_width
    volume += shape.gusset_length * shape.gusset_height * shape.gusset_thickness
    volume += shape.plate_length * shape.plate_width * shape.plate_thickness
    volume += 4.0 * shape.foot_size**2 * shape.foot_height
    found = shipped_numbers(read_reduced(SHIPPED / f"{name}.nc"), "total_mass")[0]
    assert found == pytest.approx(volume * housing.material.density, rel=1e-4)  # second-order arcs, six digits


def test_command_makes_a_file(run):
    modes = run.made.modes
    assert f"8 coordinates of the seats and {modes} modes up to 12000 Hz" in run.shown
    assert (run.folder / "housing.png").stat().st_size > 10_000
    reduced = read_reduced(run.folder / "housing.nc")
    assert (
        reduced.attributes["command"] == 'python -m examples.housings nu308_housing --size "24 mm" --cutoff "12000 Hz"'
    )
    assert reduced.units.count("1") == modes == len(reduced.units) - 8
    assert np.array_equal(reduced.stiffness, run.made.reduced.stiffness)
    assert not [path.name for path in run.folder.iterdir() if path.name not in ("housing.nc", "housing.png", "kept")]
