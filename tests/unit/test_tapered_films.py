"""Films of tapered rollers: beside the cylindrical element, in scenes, and in runs in time."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.jobs.make.table_law import table_map
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from mbs import assemble, parse_scene
from mbs.analyses.film_errors import film_error, film_errors, line_error
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.tapered.line_film import LOADS, LineFilms, line_films
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_block import FELT, TaperedBlock, tapered_answer
from mbs.bearings.tapered.tapered_element import TaperedElement
from mbs.linearised.modes import modes
from mbs.model.blocks import FOUND, Answers, Member, Moment
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import run
from tests.cases import commands
from tests.unit.test_tapered_runs import PLACE, RATE
from tests.unit.test_tapered_scenes import GEOMETRY, O_PAIR, text

RPM = math.pi / 30.0
WARM = 333.15
OIL = '[lubricant]\nname = "FVA3"\n'
POSE = np.array([0.0, 12e-6, 5e-6, 0.0, 0.0, 0.0])
CYLINDER = BearingGeometry("plain", 50e-3, 70e-3, 10e-3, 15e-3, 17, 0.0)
U = 3.0


@pytest.fixture(scope="module")
def emap():
    """Map in memory of one speed and temperature of a cylindrical roller bearing."""
    return table_map(CYLINDER, Lubricant.named("FVA3"), LOADS, (0.9 * U, 1.1 * U), (WARM, WARM))


@pytest.fixture(scope="module")
def films(emap):
    return line_films((emap.law("inner", "clamp"), emap.law("outer", "clamp")), 15e-3, U, WARM)


def scene(law="table", more="", **keys):
    given = text(**(keys or O_PAIR)).replace("[operation]", OIL + "[operation]") + more
    return assemble(parse_scene(given, "rotor", "rotor.toml"), law)


@pytest.mark.parametrize(
    ("angle", "profile", "tilt", "within"),
    [
        # the law of both contacts in series is made of points, its parts are tables: 1e-7 of each
        (0.0, "straight", 0.0, (1e-7, 1e-6, 1e-6)),
        # normals that lean: 1 - cos of 1e-3 and its square root by the tangential way of the ring
        (1e-3, "straight", 0.0, (1e-3, 1e-3, 1e-3)),
        # a roller moves as a body, where each slice of the other element finds its own place between the rings
        (0.0, "iso", 2e-4, (1e-4, 3e-4, 2e-2)),
    ],
)
def test_without_an_angle_it_is_the_cylindrical_element_with_these_films(emap, films, angle, profile, tilt, within):
    force = TaperedForce(TaperedGeometry("plain", 10e-3, 15e-3, 60e-3, 17, angle), films=films, profile=profile)
    pose = POSE + np.array([0.0, 0.0, 0.0, 0.0, 0.5 * tilt, tilt])
    bearing = Bearing(CYLINDER, profile, 21)
    other = BearingForce(bearing, emap.law("series", "clamp"))
    theirs = other.evaluate(pose, np.zeros(6), entrainment_speed=U, temperature=WARM)
    for ours, expected, part in zip(force(pose), (theirs.force, theirs.stiffness, theirs.damping), within, strict=True):
        radial = (slice(1, 3),) * ours.ndim
        assert np.max(np.abs(ours - expected)[radial]) < part * np.max(np.abs(expected[radial]))


def test_stiffness_is_the_derivative_and_dampers_only_take(films):
    """Central differences of 1 nm: films bend over 0.3 um, (1 nm/0.3 um)^2 of them, and the table is a cubic."""
    force = TaperedForce(GEOMETRY).with_films(films)
    _, stiffness, damping = force(PLACE, inner_speed=500.0)
    size = np.array([1.0, 1.0, 1.0, 1.0, 0.03, 0.03])
    scale = np.outer(size, size) * float(np.max(np.abs(stiffness[:3, :3])))
    for i in FELT:
        step = np.zeros(6)
        step[i] = 1e-9 / size[i]
        ahead, behind = (force(PLACE + way * step, inner_speed=500.0)[0] for way in (1.0, -1.0))
        assert np.max(np.abs((behind - ahead) / (2.0 * step[i]) - stiffness[:, i]) / scale[:, i]) < 3e-5
    assert np.linalg.eigvalsh(damping[np.ix_(FELT, FELT)])[0] > 0.0


def test_a_scene_has_the_point_of_the_bearing_alone(capsys, tmp_path, monkeypatch):
    """Both read the same law: a mass that one bearing holds, beside `mbs bearing` at the same load."""
    monkeypatch.chdir(tmp_path)
    one = text(right='kind = "x"').split("[[bearings]]")
    given = one[0] + "[[bearings]]" + one[1]
    given = given.replace('freedoms = ["x", "y", "z", "theta_y", "theta_z"]', 'freedoms = ["x", "y", "z"]')
    given = given.replace("[operation]", OIL + "[operation]").replace(f"{500.0} rad/s", "3000 rpm")
    push = '[[loads]]\nname = "push"\non = "rotor:left"\nforce = ["3 kN", "2 kN", "0 N"]\n'
    machine = assemble(parse_scene(given + push, "rotor", "rotor.toml"), "table")
    balance = equilibrium(machine.system, machine.operation)
    asked = ("32208", "--load", "2 kN", "--axial", "3 kN", "--speed", "3000 rpm", "--temperature", "60 degC")
    status, out, _ = commands.run(capsys, "bearing", *asked, "--law", "table", "-o", "b.csv")
    assert status == 0 and "film table at radius and speed of the middle, rib dry" in out
    head, row = [line.split(",") for line in Path("b.csv").read_text("utf-8").splitlines() if not line.startswith("#")]
    found = {name.split(" ")[0].split("[")[0]: value for name, value in zip(head, row, strict=True)}
    for name, axis in (("along", 1), ("axial", 0)):
        # digits of the file, and of both equilibria
        stiffness, damping = balance.element_stiffness[0][axis, axis], balance.element_damping[0][axis, axis]
        assert float(found[f"stiffness_{name}"]) == pytest.approx(stiffness, rel=1e-7)
        assert float(found[f"damping_{name}"]) == pytest.approx(damping, rel=1e-7)
        assert float(found[f"displacement_{name}"]) == pytest.approx(balance.displacement[axis], rel=1e-7)


@pytest.mark.parametrize("law", ["table", "formula"])
def test_films_stiffen_a_pair_that_displacement_preloads(law):
    """Both films of both rows are thicker than the lines are flattened by 0.2 um of the way along the axis."""
    dry, wet = scene("hertz"), scene(law)
    at_dry, at_wet = (equilibrium(one.system, one.operation) for one in (dry, wet))
    assert 1.1 * abs(at_dry.forces[0][0]) < abs(at_wet.forces[0][0]) < 3.0 * abs(at_dry.forces[0][0])
    assert modes(at_wet).damping_ratio.min() > 1e-5
    assert "slow films, ribs dry" in wet.law and "FVA3, flooded, smooth surfaces" in wet.law
    assert wet.memory == "slow"
    element = wet.system.elements[0].element
    assert element.powers(None, *[np.zeros(6)] * 3, wet.operation) is None
    with pytest.raises(InputError, match=r"slow motion; allowed: slow"):
        assemble(wet.scene, law, films="memory")


def test_what_has_no_films_is_said():
    with pytest.raises(InputError, match=r"bearing 'left': films need the oil of the scene; add \[lubricant\]"):
        assemble(parse_scene(text(**O_PAIR), "rotor", "rotor.toml"), "table")
    hot = parse_scene(text(**O_PAIR).replace("[operation]", OIL + "[operation]"), "rotor", "rotor.toml")
    with pytest.raises(InputError, match=r"bearing 'left', -58 degC: "):
        assemble(dataclasses.replace(hot, temperature=215.15), "table")

    def none(*_):
        raise InputError("no film here")

    element = dataclasses.replace(scene().system.elements[0].element, films=none)
    with pytest.raises(AnalysisError, match=r"bearing 'left': no films at 4775 rpm of the system \(no film here\)"):
        element.evaluate(PLACE, RATE, Operation(500.0))
    assert element.evaluate(PLACE, RATE, Operation(0.0)).force[0] < 0.0  # dry where nothing rolls


def answers(block, speeds, step):
    """Force and by_q K + by_v C of the only bearing of a block at a step of some speeds."""
    arrays, sound = block.prepare(step, step + 1)
    assert sound[0]
    found = Answers(np.zeros(5), np.zeros((5, 5)), np.zeros(1, dtype=np.int64))
    moment = Moment(0, 0.0, float(speeds[step]), 0.3, 1.0, 1e3)
    assert tapered_answer(arrays, moment, np.array([PLACE[FELT], RATE[FELT]]), found) == FOUND
    return found


def test_compiled_block_is_the_element_with_films():
    """At one speed the same table; over the speed straight in ln g between nodes that are 4 % apart, which is wrong by
    at most (0.67 * 0.04)^2/8 = 9e-5 of the films, and these are a tenth of the approach."""
    element = scene().system.elements[0].element
    assert isinstance(element, TaperedElement)
    block, one = TaperedBlock([Member(element, 0, 0)]), np.array([400.0])
    block.begin(one)
    for speeds, steps, within in (
        (one, [0], 1e-9),
        (np.linspace(0.0, 1000.0, 240), [60, 239], 1e-4),
        (np.linspace(100.0, 900.0, 240), [3, 160], 1e-4),
    ):
        block.begin(speeds)
        for step in steps:
            found = answers(block, speeds, step)
            theirs, _ = element.advance(None, PLACE, RATE, Operation(float(speeds[step]), 0.3))
            slopes = (theirs.stiffness + 1e3 * theirs.damping)[np.ix_(FELT, FELT)]
            assert np.max(np.abs(found.force - theirs.force[FELT])) < within * np.max(np.abs(theirs.force))
            assert np.max(np.abs(found.slopes - slopes)) < 5.0 * within * np.max(np.abs(slopes))
            assert not found.outside[0]
    crushed = LineFilms(*[element.law_at(400.0).inner] * 2, loads=(0.0, 1.0))
    assert dataclasses.replace(element, films=lambda *_: crushed).evaluate(PLACE, RATE, Operation(400.0)).outside


@pytest.mark.slow
def test_run_up_from_rest_with_films_stays_compiled():
    """Preload by displacement rises with the films; steps are halved where these begin, and damp most."""
    machine = scene()
    rest = equilibrium(machine.system, Operation(0.0))
    course = SpeedProfile.ramp(0.0, 600.0, 0.02)
    done = run(machine.system, course, 0.02, Settings(step=2e-5, sample=1e-3), displacement=rest.displacement)
    assert done.compiled == done.steps and 1000 <= done.steps < 1200
    axial = np.abs(done.forces[0][:, 0])
    assert axial[-1] > 1.2 * axial[0]
    assert done.energy.elements[0].told is False


def test_films_of_slow_motion_say_from_where_they_are_wrong(emap, films):
    """Springs in series have the dampers that act in slow motion, so that their sum is C, to what the table of damping
    is wrong at its corners. Without an angle the error is that of the cylindrical element, whose slices have both
    contacts in series: one relaxation time for two that are alike within a tenth."""
    machine = scene()
    balance = equilibrium(machine.system, machine.operation)
    element = machine.system.elements[0].element
    ports = machine.system.elements[0].transform @ balance.displacement
    relaxation, _ = element.film_relaxation(ports, machine.operation)
    damping, free = balance.element_damping[0], np.ix_(FELT, FELT)
    assert np.max(np.abs(relaxation.damping - damping)[free]) < 1e-6 * np.max(np.abs(damping))
    rest = film_errors(machine, balance.displacement, Operation(0.0))
    assert rest[0].at_rest and rest[0].at(1e3) == 0.0
    assert film_errors(scene("hertz"), balance.displacement, machine.operation) == []

    plain = TaperedForce(TaperedGeometry("plain", 10e-3, 15e-3, 60e-3, 17, 0.0), profile="straight")
    ours = TaperedElement("ours", "ring", "ground", plain, films=lambda *_: films)
    bearing = Bearing(CYLINDER, "straight", 21)
    theirs = BearingElement(
        "theirs", "ring", "ground", bearing, BearingForce(bearing, emap.law("series", "clamp")), WARM, films="slow"
    )
    at = Operation(U / CYLINDER.entrainment_speed(1.0))
    one, other = line_error(ours, POSE, at), film_error(theirs, POSE, at, "slow", False)
    frequencies, plain_error = np.geomspace(100.0, 1e4, 5), dataclasses.replace(other, contacts=())
    np.testing.assert_allclose(one.error(frequencies), plain_error.error(frequencies), rtol=0.1)
    assert one.frequency == pytest.approx(plain_error.frequency, rel=0.1)
    assert not one.may_relax
