"""Parts of flexible shafts: elements, bodies, damping, and the tables of a scene that describe them."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from mbs.flexible.beam import (
    CrossSection,
    element_gyroscopic,
    element_length,
    element_mass,
    element_stiffness,
    shear_coefficient,
    wave_length,
)
from mbs.flexible.reduced_body import modal_damping
from mbs.flexible.shaft import flexible_shaft
from mbs.flexible.shaft_parts import Disc, Section, shaft_problems
from mbs.linearised.modes import modes
from mbs.model.body import FREEDOMS, Inertia, lever_arm, rigid_body
from mbs.model.elements import Operation, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.system import System
from mbs.scene.assembly import build_body
from mbs.scene.shafts.tables import read_shaft

BENDING = ("y", "z", "theta_y", "theta_z")
STEEL_BAR = CrossSection.annulus(0.04, 0.01, 210e9, 0.3, 7850.0)
BAR = Section(0.0, 0.3, 0.04)
FRAMES = {"left": 0.05, "right": 0.25}
DISC = Disc(0.15, Inertia(2.0, 4e-3, 3e-3))


def shaft(sections=(BAR,), discs=(), freedoms=BENDING, position=(0.0, 0.0, 0.0), frames=None, **settings):
    frames = FRAMES if frames is None else frames
    return flexible_shaft("rotor", sections, discs, freedoms, position, frames, **settings)


def rigid_motion(places):
    """Displacements of nodes at places on the axis by that of the origin."""
    return np.vstack([lever_arm((place, 0.0, 0.0)) for place in places])


# ---- elements


@pytest.mark.parametrize("shear", [None, math.inf])
def test_an_element_that_moves_as_a_whole_is_a_rigid_body(shear):
    length, begin = 0.02, 0.1
    section = STEEL_BAR if shear is None else dataclasses.replace(STEEL_BAR, shear=shear)
    motion = rigid_motion([begin, begin + length])
    whole = rigid_body("cylinder", [Inertia.cylinder(begin, begin + length, 0.04, 0.01)], FREEDOMS)
    scale = np.sqrt(np.outer(np.diag(whole.mass), np.diag(whole.mass)))
    # Round-off.
    assert np.max(np.abs(motion.T @ element_mass(section, length) @ motion - whole.mass) / scale) < 1e-12
    assert np.max(np.abs(motion.T @ element_gyroscopic(section, length) @ motion - whole.gyroscopic) / scale) < 1e-12
    stiffness = element_stiffness(section, length)
    assert np.max(np.abs(stiffness @ motion)) < 1e-12 * np.max(stiffness)


def test_matrices_of_an_element_have_their_symmetry():
    mass, gyroscopic, stiffness = (
        element(STEEL_BAR, 0.07) for element in (element_mass, element_gyroscopic, element_stiffness)
    )
    # Round-off of the quadrature.
    np.testing.assert_allclose(mass, mass.T, rtol=1e-12)
    assert np.array_equal(stiffness, stiffness.T)
    assert np.array_equal(gyroscopic, -gyroscopic.T)
    assert np.all(np.linalg.eigvalsh(mass) > 0.0)
    values = np.linalg.eigvalsh(stiffness)
    # Six rigid motions, six that deform.
    assert np.sum(values > 1e-9 * values[-1]) == 6


def test_a_cantilever_of_one_element_bends_by_bending_and_shear():
    length, section = 0.3, STEEL_BAR
    tip = np.linalg.inv(element_stiffness(section, length)[6:, 6:])
    flexure, shear = length**3 / (3.0 * section.bending), length / section.shear
    # Round-off.
    assert tip[1, 1] == pytest.approx(flexure + shear, rel=1e-12)
    assert tip[2, 2] == pytest.approx(flexure + shear, rel=1e-12)
    # A force along y turns the tip about z, one along z against y.
    assert tip[5, 1] == pytest.approx(length**2 / (2.0 * section.bending), rel=1e-12)
    assert tip[4, 2] == pytest.approx(-(length**2) / (2.0 * section.bending), rel=1e-12)
    assert tip[0, 0] == pytest.approx(length / section.axial, rel=1e-12)
    assert tip[3, 3] == pytest.approx(length / section.torsion, rel=1e-12)


def test_the_shear_coefficient_has_cowpers_limits():
    # Thin tube, in closed form in the same paper.
    assert shear_coefficient(1.0 - 1e-9, 0.3) == pytest.approx(2.0 * 1.3 / (4.0 + 0.9), rel=1e-8)
    assert shear_coefficient(0.0, 0.0) == pytest.approx(6.0 / 7.0, rel=1e-15)
    with pytest.raises(InputError, match=r"bore over diameter 1\.0, nu 0\.3; allowed: 0 <= bore"):
        shear_coefficient(1.0, 0.3)
    with pytest.raises(InputError, match="nu nan"):
        shear_coefficient(0.0, math.nan)


def test_a_slender_wave_is_eulers_and_needs_longer_elements_than_a_thick_one():
    slender = CrossSection.annulus(0.001, 0.0, 210e9, 0.3, 7850.0)
    euler = 2.0 * math.pi * (slender.bending / slender.mass / (2.0 * math.pi * 100.0) ** 2) ** 0.25
    # Shear and rotary inertia: (k d/4)^2 of 1e-4.
    assert wave_length(slender, 100.0) == pytest.approx(euler, rel=1e-3)
    thick = CrossSection.annulus(0.05, 0.0, 210e9, 0.3, 7850.0)
    parts = [
        wave_length(section, frequency) / element_length(section, frequency, 1e-4)
        for section, frequency in ((slender, 100.0), (thick, 20e3))
    ]
    assert 8.0 < parts[0] < 15.0 < 40.0 < parts[1] < 120.0


# ---- damping


def test_modal_damping_gives_every_elastic_mode_its_ratio_and_leaves_rigid_motion_alone():
    body = shaft(discs=[DISC], freedoms=FREEDOMS, cutoff=9e3, damping_ratio=0.02)
    found = modes(equilibrium(System([body]), Operation()))
    elastic = found.frequency > 100.0
    assert np.sum(elastic) == len(body.coordinates) - 6
    # Round-off of the eigenvalues.
    np.testing.assert_allclose(found.damping_ratio[elastic], 0.02, rtol=1e-6)
    transform = np.vstack([frame.transform for frame in body.frames.values()])
    rigid = np.linalg.lstsq(
        np.vstack([transform, body.stiffness / np.max(body.stiffness)]),
        np.vstack([rigid_motion(FRAMES.values()), np.zeros((len(body.coordinates), 6))]),
        rcond=None,
    )[0]
    assert np.max(np.abs(body.damping @ rigid)) < 1e-7 * np.max(body.damping)
    assert np.all(np.linalg.eigvalsh(body.damping) > -1e-9 * np.max(body.damping))


def test_no_damping_is_none():
    assert not np.any(shaft(cutoff=5e3).damping)
    assert not np.any(modal_damping(np.eye(2), np.eye(2), 0.0))


@pytest.mark.parametrize("ratio", [math.nan, -0.01, 1.0, math.inf])
def test_a_damping_ratio_is_between_zero_and_one(ratio):
    with pytest.raises(InputError, match=r"damping ratio: got .*; allowed: 0 <= ratio < 1"):
        modal_damping(np.eye(2), np.eye(2), ratio)


@pytest.mark.parametrize("mass", [np.diag([1.0, -1.0]), np.diag([1.0, math.nan])])
def test_damping_needs_a_mass(mass):
    with pytest.raises(InputError, match=r"modes cannot be computed.*mass positive definite"):
        modal_damping(mass, np.eye(2), 0.01)


# ---- the body


def test_a_reduced_shaft_has_frames_and_modes():
    body = shaft(position=(1.0, 2.0, 3.0), cutoff=9e3, spin=-2.0)
    count = len(body.coordinates) - 8
    assert count > 0
    assert body.coordinates[:8] == tuple(f"{frame}.{freedom}" for frame in ("left", "right") for freedom in BENDING)
    assert body.coordinates[8:] == tuple(f"mode {index + 1}" for index in range(count))
    assert body.units == ("m", "m", "rad", "rad") * 2 + ("1",) * count
    assert body.spin == -2.0
    np.testing.assert_allclose(body.frames["right"].position, [1.25, 2.0, 3.0])
    expected = np.zeros((6, len(body.coordinates)))
    expected[[1, 2, 4, 5], [4, 5, 6, 7]] = 1.0
    np.testing.assert_array_equal(body.frames["right"].transform, expected)
    own = np.diag(body.stiffness)[8:]
    assert np.all(np.diff(own) >= 0.0)
    assert np.all(own <= (2.0 * math.pi * 9e3) ** 2)
    # Normalised to round-off of the eigenvectors.
    np.testing.assert_allclose(body.mass[8:, 8:], np.eye(count), atol=1e-9)


def test_modes_lie_in_the_planes_of_the_shaft():
    body = shaft(cutoff=9e3)
    coupling = np.abs(body.mass[8:, :8])
    in_plane = {"y": coupling[:, [0, 3, 4, 7]].sum(axis=1), "z": coupling[:, [1, 2, 5, 6]].sum(axis=1)}
    assert np.all((in_plane["y"] == 0.0) != (in_plane["z"] == 0.0))


def test_without_cutoff_all_nodes_are_kept():
    body = shaft(largest_element=0.05)
    assert len(body.coordinates) == 7 * 4
    assert body.coordinates[0] == "node 1.y"
    assert body.coordinates[4] == "left.y"
    assert set(body.units) == {"m", "rad"}
    # Half the diameter by default: 15 elements of 20 mm at least, with nodes at the frames.
    assert len(shaft().coordinates) == (3 + 10 + 3 + 1) * 4


def test_frames_at_one_place_share_their_coordinates():
    body = shaft(frames={"bearing": 0.05, "seal": 0.05, "end": 0.3}, cutoff=5e3)
    assert body.coordinates[:8] == tuple(f"{frame}.{freedom}" for frame in ("bearing", "end") for freedom in BENDING)
    np.testing.assert_array_equal(body.frames["bearing"].transform, body.frames["seal"].transform)


def test_a_shaft_of_frames_only_has_no_modes():
    body = shaft(frames={"a": 0.0, "b": 0.3}, largest_element=0.3, cutoff=9e3)
    assert len(body.coordinates) == 8
    np.testing.assert_allclose(body.mass, shaft(frames={"a": 0.0, "b": 0.3}, largest_element=0.3).mass, rtol=1e-12)


def test_a_pressed_ring_adds_up_with_the_shaft():
    ring = Section(0.1, 0.2, 0.06, 0.04)
    frames = {"a": 0.0, "b": 0.3}
    composed = shaft([BAR, ring], frames=frames, cutoff=9e3)
    pieces = [Section(0.0, 0.1, 0.04), Section(0.1, 0.2, 0.06), Section(0.2, 0.3, 0.04)]
    solid = shaft(pieces, frames=frames, cutoff=9e3)
    bare = shaft(frames=frames, cutoff=9e3)
    # Same area and moments; only the shear coefficients of ring and core differ from that of the whole, by some 10 %
    # of a compliance by shear that is a few per cent here.
    np.testing.assert_allclose(np.diag(composed.mass), np.diag(solid.mass), rtol=1e-2)
    np.testing.assert_allclose(np.diag(composed.stiffness)[:8], np.diag(solid.stiffness)[:8], rtol=1e-2)
    assert np.all(np.diag(composed.stiffness)[:8] > 1.03 * np.diag(bare.stiffness)[:8])


def test_a_disc_has_its_centre_of_mass_at_its_offset():
    near = shaft(discs=[Disc(0.15, Inertia(2.0, 4e-3, 3e-3, 0.01))], frames={"disc": 0.15}, largest_element=0.05)
    bare = shaft(frames={"disc": 0.15}, largest_element=0.05)
    added = rigid_body("disc", [Inertia(2.0, 4e-3, 3e-3, 0.01)], BENDING)
    rows = [near.coordinates.index(f"disc.{freedom}") for freedom in BENDING]
    # Round-off of the sum.
    np.testing.assert_allclose((near.mass - bare.mass)[np.ix_(rows, rows)], added.mass, atol=1e-14)
    np.testing.assert_allclose((near.gyroscopic - bare.gyroscopic)[np.ix_(rows, rows)], added.gyroscopic, atol=1e-14)


def test_places_that_are_nearly_the_same_are_one_node():
    sections = [Section(0.0, 0.1, 0.04), Section(0.1 + 5e-7, 0.3, 0.04)]
    body = shaft(sections, frames={"a": 0.1, "b": 0.1 + 4e-7}, largest_element=0.1)
    assert len(body.coordinates) == 4 * 4
    np.testing.assert_array_equal(body.frames["a"].transform, body.frames["b"].transform)
    # A gap that counts as touching may be all that a short element has; there the next section counts.
    thin = [Section(0.0, 0.1, 0.04), Section(0.1 + 0.9e-6, 0.3, 0.04)]
    assert len(shaft(thin, frames={"a": 0.1 - 0.3e-6}, largest_element=0.1).coordinates) == 5 * 4
    split = [Section(0.0, 0.1 + 0.5e-6, 0.04), Section(0.1 + 1.4e-6, 0.3, 0.04)]
    assert shaft(split, frames={"a": 0.1}, largest_element=0.1).mass[0, 0] > 0.0


def test_held_freedoms_do_not_move():
    body = shaft(freedoms=("y", "theta_z"), cutoff=5e3)
    assert not np.any(body.frames["left"].transform[[0, 2, 3, 4]])
    assert not np.any(body.gyroscopic)


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"freedoms": ()}, "rotor', freedoms: got none; allowed: some of x, y"),
        ({"freedoms": ("y", "y", "theta_z")}, "freedoms: got 'y'; allowed: .* each once"),
        ({"freedoms": ("up",)}, "freedoms: got 'up'; allowed: x, y"),
        ({"freedoms": ("y",)}, "freedoms: got y alone; allowed: y and theta_z together"),
        ({"freedoms": ("theta_y", "x")}, "freedoms: got theta_y alone; allowed: z and theta_y together"),
        ({"frames": {}}, "frames: got none; allowed: at least one place"),
        ({"frames": {"": 0.1}}, "frames: got the name ''; allowed: a short text"),
        ({"frames": {"far": 0.4}}, "frames far: got x = 400 mm; allowed: 0 to 300 mm"),
        ({"frames": {"nowhere": math.nan}}, "frames nowhere: got x = nan mm"),
        ({"frames": {f"{i}": 0.1 for i in range(401)}}, "frames: got 401; allowed: 0 to 400"),
        ({"sections": ()}, "sections: got 0; allowed: 1 to 400"),
        ({"sections": (BAR,) * 401}, "sections: got 401"),
        ({"sections": (BAR, Section(0.31, 0.4, 0.04))}, "nothing from 300 to 310 mm; allowed: no gap"),
        (
            {"sections": (BAR, Section(0.1, 0.2, 0.06, 0.03))},
            r"sections\[0\] and sections\[1\]: both fill x = 100 to 200",
        ),
        (
            {"sections": (BAR, Section(0.1, 0.2, 0.06, 0.04, 2e11, 0.3, 7850.0, 0.06, 0.03))},
            r"sections\[0\] and sections\[1\]: both fill x = 100 to 200 mm between d = 30 and 40 mm",
        ),
        ({"sections": (Section(0.0, 0.3, 0.04, 0.0, 0.0),)}, "sections: got no youngs_modulus above 0"),
        (
            {"sections": (BAR, Section(0.3, 0.4, 0.04, 0.0, 0.0))},
            "sections: nothing that bends from 300 to 400 mm; allowed: layers without stiffness upon one with",
        ),
        (
            {"sections": (Section(0.0, 0.1, 0.04), Section(0.0, 0.3, 0.06, 0.04, 0.0), Section(0.2, 0.3, 0.04))},
            "sections: nothing that bends from 100 to 200 mm",
        ),
        ({"discs": [Disc(-0.1, DISC.inertia)]}, r"discs\[0\]: got x = -100 mm"),
        ({"position": (0.0, 0.0)}, "position: got .*three finite numbers"),
        ({"position": (0.0, 0.0, math.inf)}, "position: got .*three finite numbers"),
        ({"spin": math.nan}, "spin: got nan; allowed: finite"),
        ({"largest_element": 0.0}, "largest_element: got 0.0 m; allowed: finite and > 0"),
        ({"largest_element": 1e-5}, "largest_element: got 0.01 mm, which makes more than 400 elements"),
        ({"largest_element": 5e-324}, "makes more than 400 elements"),
        ({"cutoff": -1.0}, "cutoff: got -1.0 Hz; allowed: 0.001 to"),
        ({"cutoff": 1e-300}, "cutoff: got 1e-300 Hz"),
        ({"cutoff": math.nan}, "cutoff: got nan Hz"),
        ({"cutoff": 1e200}, r"cutoff: got 1e\+200 Hz; allowed: 0.001 to 1e\+07 Hz"),
        ({"cutoff": 5e5}, "cutoff: got 500000 Hz, where bending waves are shorter than the diameter"),
        ({"sections": (Section(0.0, 3.0, 0.005),), "cutoff": 2e4}, "by default, which makes more than 400 elements"),
        ({"damping_ratio": 2.0}, "damping_ratio: got 2.0; allowed: 0 <= ratio < 1"),
    ],
)
def test_a_shaft_that_does_not_fit_is_refused(changes, text):
    with pytest.raises(InputError, match=text):
        shaft(**changes)


@pytest.mark.parametrize(("thin", "modulus"), [(0.01, 1e5), (1e-5, 210e9)], ids=["lost digits", "not definite"])
def test_a_shaft_that_is_singular_to_working_precision_is_refused(thin, modulus):
    sections = [Section(0.0, 0.1, thin, 0.0, modulus), Section(0.1, 0.2, 0.1), Section(0.2, 0.21, 0.3)]
    with pytest.raises(InputError, match="shaft 'rotor', sections: the held shaft is singular to working precision"):
        shaft(sections, frames={"end": 0.0}, largest_element=0.05, cutoff=1.0)


def test_all_problems_of_a_shaft_come_at_once():
    with pytest.raises(InputError) as caught:
        shaft(freedoms=("y",), frames={"far": 9.0}, position=(math.nan,) * 3, cutoff=0.0, damping_ratio=-1.0)
    assert len(caught.value.problems) == 5
    assert all(problem.startswith("shaft 'rotor', ") for problem in caught.value.problems)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ((0.1, 0.0, 0.04), "end: got 0.0 m, begin 0.1 m"),
        ((math.nan, 0.1, 0.04), "begin: got nan m; allowed: -10000 to 10000 m"),
        ((0.0, 1e300, 0.04), r"end: got 1e\+300 m"),
        ((0.0, 0.1, 0.04, 0.04), "bore: got 0.04 m, diameter 0.04 m; allowed: 0 <= bore < diameter"),
        ((0.0, 0.1, 0.04, -0.01), "bore: got -0.01 m"),
        ((0.0, 0.1, math.inf), "diameter: got inf m"),
        ((0.0, 0.1, 0.04, 0.0, -1.0), "youngs_modulus: got -1.0 Pa"),
        ((0.0, 0.1, 0.04, 0.0, 2e11, 0.5), "poisson_ratio: got 0.5; allowed: -1 < nu < 0.5"),
        ((0.0, 0.1, 0.04, 0.0, 2e11, 0.3, -1.0), "density: got -1.0 kg/m3"),
        ((0.0, 0.1, 0.04, 0.0, 2e11, 0.3, 7850.0, math.nan), "end_diameter: got nan m"),
        ((0.0, 0.1, 0.04, 0.02, 2e11, 0.3, 7850.0, 0.01), "end_bore: got 0.02 m, end_diameter 0.01 m"),
    ],
)
def test_a_section_that_is_none_is_refused(values, text):
    with pytest.raises(InputError, match=text):
        Section(*values)


def test_cones_that_touch_may_lie_in_each_other():
    cone = Section(0.0, 0.3, 0.04, 0.0, 2e11, 0.3, 7850.0, 0.08)
    ring = Section(0.0, 0.3, 0.1, 0.04, 2e11, 0.3, 7850.0, 0.1, 0.08)
    assert not shaft_problems([cone, ring], [], BENDING, (0.0, 0.0, 0.0), FRAMES, 0.0, None, None, 0.0)
    # One is within the other at either end, and both fill the same space between.
    other = Section(0.0, 0.3, 0.08, 0.05, 2e11, 0.3, 7850.0, 0.04, 0.02)
    assert "both fill" in shaft_problems([cone, other], [], BENDING, (0.0, 0.0, 0.0), FRAMES, 0.0, None, None, 0.0)[0]


def test_stiffness_that_is_not_finite_is_refused():
    with pytest.raises(InputError, match="stiffness or mass is not finite"):
        shaft(discs=[Disc(0.1, Inertia(1e300, 1e300, 1e300, 1e300))])


def test_a_shaft_works_in_a_system_under_the_name_of_its_frames():
    body = shaft(discs=[DISC], cutoff=9e3, spin=1.0)
    stiffness = np.diag([0.0, 1e8, 1e8, 0.0, 0.0, 0.0])
    springs = [Spring(f"spring {frame}", f"rotor:{frame}", "ground", stiffness) for frame in FRAMES]
    system = System([body], springs)
    at_rest, turning = (modes(equilibrium(system, Operation(speed))).frequency[:2] for speed in (0.0, 3000.0))
    # The disc sits in the middle, but the shaft is long to both sides: the pair splits, by little.
    assert at_rest[1] - at_rest[0] < 1e-6 * at_rest[0]
    assert turning[0] < turning[1]
    assert "rotor" in equilibrium(system, Operation()).parts


def test_a_stiff_shaft_is_a_rigid_body():
    stiff = dataclasses.replace(BAR, youngs_modulus=1e15)
    flexible = shaft([stiff], [DISC], cutoff=9e3, spin=1.0)
    parts = [Inertia.cylinder(0.0, 0.3, 0.04), dataclasses.replace(DISC.inertia, offset=DISC.position)]
    rigid = rigid_body(
        "rotor", parts, BENDING, frames={key: (place, 0.0, 0.0) for key, place in FRAMES.items()}, spin=1.0
    )
    stiffness = np.diag([0.0, 1e8, 3e8, 0.0, 0.0, 0.0])
    springs = [Spring(f"spring {frame}", f"rotor:{frame}", "ground", stiffness) for frame in FRAMES]
    found, wanted = (
        modes(equilibrium(System([body], springs), Operation(3000.0))).frequency[:4] for body in (flexible, rigid)
    )
    # What is left of the elasticity: springs of 3e8 N/m against 1e11 N/m and more of the shaft.
    np.testing.assert_allclose(found, wanted, rtol=2e-3)


# ---- reading

TABLE = {
    "name": "shaft",
    "freedoms": ["y", "z", "theta_x", "theta_y", "theta_z"],
    "position": ["1 mm", "2 mm", "3 mm"],
    "spin": 2,
    "sections": [
        {"from": "0 mm", "to": "240 mm", "diameter": "40 mm", "bore": "0 mm"},
        {"from": "107 mm", "to": "133 mm", "diameter": "60 mm", "bore": "40 mm", "youngs_modulus": "205 GPa",
         "poisson_ratio": 0.29, "density": "7800 kg/m^3"},
    ],
    "discs": [
        {"at": "120 mm", "mass": "1.2 kg", "polar_inertia": "1e-3 kg m^2", "transverse_inertia": "6e-4 kg m^2"},
        {"from": "107 mm", "to": "133 mm", "diameter": "94.5 mm", "bore": "60 mm"},
    ],
    "frames": {"left": "40 mm", "gear": "120 mm", "right": "200 mm"},
    "cutoff": "8 kHz",
    "damping_ratio": 0.005,
}  # fmt: skip


def read(changes=None, without=()):
    values = {key: value for key, value in {**TABLE, **(changes or {})}.items() if key not in without}
    problems: list[str] = []
    spec = read_shaft(Table(values, "[[shafts]] shaft", problems), "shaft")
    assert (spec is None) == bool(problems)
    assert all(problem.startswith("[[shafts]] shaft") for problem in problems)
    return spec and build_body(spec), "\n".join(problems)


def test_a_shaft_is_read():
    body, _ = read()
    direct = flexible_shaft(
        "shaft",
        [Section(0.0, 0.24, 0.04), Section(0.107, 0.133, 0.06, 0.04, 205e9, 0.29, 7800.0)],
        [
            Disc(0.12, Inertia(1.2, 1e-3, 6e-4)),
            Disc(0.12, Inertia.cylinder(-0.013, 0.013, 0.0945, 0.06)),
        ],
        ("y", "z", "theta_x", "theta_y", "theta_z"),
        (0.001, 0.002, 0.003),
        {"left": 0.04, "gear": 0.12, "right": 0.2},
        spin=2.0,
        cutoff=8e3,
        damping_ratio=0.005,
    )
    assert body.name == "shaft"
    assert body.spin == 2.0
    assert body.coordinates == direct.coordinates
    for name in ("mass", "gyroscopic", "damping", "stiffness"):
        found, wanted = getattr(body, name), getattr(direct, name)
        # Round-off of 133 mm - 107 mm.
        np.testing.assert_allclose(found, wanted, atol=1e-9 * np.max(np.abs(wanted)))
    np.testing.assert_allclose(body.frames["gear"].position, [0.121, 0.002, 0.003])


def test_what_may_be_left_out_may_be_left_out():
    body, _ = read(without=("position", "spin", "discs", "damping_ratio"))
    assert body.spin == 0.0
    assert not np.any(body.damping)
    np.testing.assert_allclose(body.frames["left"].position, [0.04, 0.0, 0.0])
    coarse, _ = read({"largest_element": "40 mm"})
    assert len(coarse.coordinates) <= len(read()[0].coordinates)


def test_a_shaft_without_freedoms_and_cutoff_bends_up_to_5_khz():
    body, _ = read(without=("freedoms", "cutoff"))
    same, _ = read({"freedoms": ["y", "z", "theta_y", "theta_z"], "cutoff": "5 kHz"})
    assert body.coordinates == same.coordinates


@pytest.mark.parametrize("key", ["sections", "frames"])
def test_what_may_not_be_left_out_is_missed(key):
    assert f"{key}: missing; allowed: " in read(without=(key,))[1]


@pytest.mark.parametrize(
    ("changes", "texts"),
    [
        ({"freedoms": "y"}, ["freedoms: got 'y'; allowed: a list"]),
        ({"freedoms": ["y"]}, ["shaft 'shaft', freedoms: got y alone"]),
        ({"position": ["1 mm"]}, ["position: got a list of 1 entries"]),
        ({"spin": "1"}, ["spin: got '1'; allowed: a bare number"]),
        ({"sections": {}}, ["sections: got a table of 0 entries; allowed: a list of tables with length, diameter, or"]),
        ({"sections": []}, ["sections: got 0; allowed: 1 to 400"]),
        ({"sections": [1]}, ["sections[0]: got 1; allowed: a table", "sections[0] from: missing"]),
        (
            {"sections": [{"from": "0", "to": "1 kg", "diameter": "nan mm", "bor": "1 mm"}]},
            [
                "from: got '0' without a unit",
                "to: got the unit 'kg'",
                "diameter: got 'nan mm'",
                "bor: unknown key (did",
            ],
        ),
        (
            {"sections": [{"from": "2 mm", "to": "1 mm", "diameter": "1 mm", "bore": "2 mm"}]},
            ["sections[0]: section, end: got 0.001 m", "sections[0]: section, bore: got 0.002 m"],
        ),
        (
            {"sections": [{**TABLE["sections"][0], "poisson_ratio": 0.6}]},
            ["poisson_ratio: got 0.6; allowed: -0.999 to 0.499"],
        ),
        ({"discs": "none"}, ["discs: got 'none'; allowed: a list of tables with at, diameter, width, or at, mass"]),
        ({"discs": [{"at": "1 mm", "mass": "1 kg", "polar_inertia": "1 kg m^2"}]}, ["transverse_inertia: missing"]),
        (
            {
                "discs": [
                    {"at": "1 mm", "mass": "1 kg", "polar_inertia": "1 kg m^2", "transverse_inertia": "0.1 kg m^2"}
                ]
            },
            ["discs[0]: inertia, polar: got 1.0 kg m2; allowed: at most twice"],
        ),
        ({"discs": [{"from": "1 mm", "to": "3 mm"}]}, ["discs[0] diameter: missing"]),
        ({"discs": [{**TABLE["discs"][0], "to": "3 mm"}]}, ["discs[0] to: unknown key"]),
        ({"discs": [{**TABLE["discs"][0], "at": "300 mm"}]}, ["discs[0]: got x = 300 mm; allowed: 0 to 240 mm"]),
        ({"frames": ["left"]}, ["frames: got a list of 1 entries; allowed: a table"]),
        ({"frames": {}}, ["frames: got none; allowed: at least one place"]),
        ({"frames": {"left": 40}}, ["frames left: got 40 without a unit"]),
        ({"cutoff": "8000 rpm"}, ["cutoff: got the unit 'rpm'"]),
        ({"cutoff": "1 MHz"}, ["cutoff: got 1e+06 Hz, where bending waves are shorter"]),
        ({"largest_element": "0 mm"}, ["largest_element: got '0 mm'; allowed: 0.001 mm to"]),
        ({"largest_element": "1 um"}, ["which makes more than 400 elements"]),
        ({"damping_ratio": 1}, ["damping_ratio: got 1; allowed: 0 to 0.5"]),
        ({"damping_ratio": True}, ["damping_ratio: got True; allowed: a bare number"]),
        ({"spin": math.nan, "cutoff": None}, ["spin: got nan", "cutoff: got None"]),
    ],
)
def test_every_slip_is_found_and_said(changes, texts):
    found = read(changes)[1]
    for text in texts:
        assert text in found


def test_keys_of_the_shaft_that_nobody_knows_are_left_to_the_caller():
    problems: list[str] = []
    table = Table({**TABLE, "colour": "red"}, "[[shafts]] shaft", problems)
    assert read_shaft(table, "shaft") is not None
    table.close(("name",))
    assert [problem for problem in problems if "colour" in problem]
    assert len(problems) == 2  # and the name, which is read before
