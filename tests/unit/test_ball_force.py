"""The ball bearing as a force element: derivatives, symmetry, passivity, extremes, refusals, copies."""

from __future__ import annotations

import copy
import dataclasses
import itertools
import math
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.locating.locating_force import FASTEST
from mbs.model.elements import Operation
from tests.cases.balls import ANGULAR, BEARINGS, DEEP, FREE, LOOSE, OTHER_WAY, rest

RPM = math.pi / 30.0
DAMPED = {"damping_time": 1.25e-5, "damping": 20.0}


def force_of(name):
    geometry = BEARINGS[name]
    return BallForce(geometry, dry_law(geometry, **DAMPED))


def poses(force, count=6):
    """Random poses, some with balls that are lost."""
    draw = np.random.default_rng(7)
    arm = force.shape.arm
    sign = math.copysign(1.0, force.geometry.contact_angle)
    for _ in range(count):
        pose = draw.uniform(-1.0, 1.0, 6) * np.array([30e-6, 15e-6, 15e-6, 0.0, 20e-6 / arm, 20e-6 / arm])
        pose[0] += sign * 20e-6
        yield pose


def scaled(matrix, force):
    """Entries in N/m: moments and tilts by the arm."""
    scale = np.array([1.0, 1.0, 1.0, 1.0, force.shape.arm, force.shape.arm])
    return matrix / np.outer(scale, scale)


@pytest.mark.parametrize("name", BEARINGS)
@pytest.mark.parametrize("rpm", [0.0, 3e3, 2e4])
def test_stiffness_is_the_difference_quotient(name, rpm) -> None:
    """Central differences of 2 nm: round-off some 1e-7 of K, and 1e-5 of what a ball at 50 nm bends."""
    force = force_of(name)
    tried = 0
    for pose in poses(force, 12):
        _, stiffness, _ = force(pose, inner_speed=rpm * RPM)
        approach = force.loads(pose, inner_speed=rpm * RPM).approach[0]
        if np.min(np.abs(approach)) < 50e-9 or np.max(approach) < 50e-9:
            continue  # differences across the kink where a ball lifts off
        tried += 1
        found = np.zeros((6, 6))
        for i in FREE:
            step = np.zeros(6)
            step[i] = 2e-9 / (force.shape.arm if i > 3 else 1.0)
            ahead, back = (force(pose + way * step, inner_speed=rpm * RPM)[0] for way in (1.0, -1.0))
            found[:, i] = (back - ahead) / (2.0 * step[i])
        size = np.max(np.abs(scaled(stiffness, force)))
        assert np.max(np.abs(scaled(found - stiffness, force))) < 3e-5 * size
    assert tried >= 3


@pytest.mark.parametrize("name", BEARINGS)
@pytest.mark.parametrize(("rpm", "given"), [(3e3, 1e-3), (2e4, 3e-2)])
def test_damping_takes_up_power_at_speed(name, rpm, given) -> None:
    """What balls change of their speed makes it unsymmetric, and lets speed give a little power to slow motion: up to
    3e-2 of the largest term at 2e4 rpm, where half of the loads of a 218 are centrifugal."""
    force = force_of(name)
    for pose in poses(force):
        damping = scaled(force(pose, inner_speed=rpm * RPM)[2], force)
        assert np.min(np.linalg.eigvalsh(0.5 * (damping + damping.T))) >= -given * np.max(np.abs(damping))


def test_damping_is_the_limit_of_a_slow_oscillation() -> None:
    """Against each contact with its own damper and the ball between them: Im of the dynamic stiffness over omega.

    One ball, both groove centres in line: k and c in series, c = k^2 (c_i/k_i^2 + c_o/k_o^2).
    """
    force = force_of("deep")
    pose = np.array([0.0, 20e-6, 0.0, 0.0, 0.0, 0.0])
    balls = force.loads(pose)
    _, stiffness, damping = force(pose)
    k, c = 0.0, 0.0
    for j in np.flatnonzero(balls.load[0] > 0.0):
        each = 1.5 * balls.load[:, j] / balls.approach[:, j]
        dampers = DAMPED["damping"] + DAMPED["damping_time"] * each
        pair = 1.0 / np.sum(1.0 / each)
        along = math.cos(balls.angle[j]) ** 2
        k += pair * along
        c += pair**2 * np.sum(dampers / each**2) * along
    # all contact angles are zero here; forces that turn act along x and tilts only
    assert stiffness[1, 1] == pytest.approx(k, rel=1e-9)
    assert damping[1, 1] == pytest.approx(c, rel=1e-9)


def test_velocity_brings_the_damping() -> None:
    force = force_of("angular")
    pose, velocity = next(poses(force)), np.array([1e-3, -2e-3, 1e-3, 5.0, 1e-2, 2e-2])
    still, _, damping = force(pose)
    moving, _, _ = force(pose, velocity)
    np.testing.assert_allclose(moving, still - damping @ velocity, rtol=1e-14)
    assert moving[3] == 0.0


@pytest.mark.parametrize("name", ["loose", "angular"])
def test_copies_do_not_share_their_balls(name) -> None:
    """Pickled and copied: the same forces, each from nothing, and so in threads of their own."""
    force = force_of(name)
    poses_of, speed = list(poses(force, 40)), 1e4 * RPM
    wanted = [force_of(name)(pose, inner_speed=speed)[0] for pose in poses_of]
    copies = [pickle.loads(pickle.dumps(force)), copy.deepcopy(force), force, force_of(name)]
    with ThreadPoolExecutor(len(copies)) as pool:
        found = list(pool.map(lambda one: [one(pose, inner_speed=speed)[0] for pose in poses_of], copies))
    for one in found:
        np.testing.assert_allclose(one, wanted, rtol=1e-9, atol=1e-9 * np.max(np.abs(wanted)))


def test_order_of_calls_does_not_matter() -> None:
    """Places of the balls of the last call are only a start: to the tolerance of the balance, 1e-13, over k."""
    used, fresh = force_of("loose"), force_of("loose")
    far = next(poses(used))
    used(far, inner_speed=2e3)
    used(-far, inner_speed=10.0)
    pose = np.array([5e-6, 9e-6, 1e-6, 0.0, 1e-4, 0.0])
    for one, other in zip(used(pose, inner_speed=300.0), fresh(pose, inner_speed=300.0), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-8, atol=1e-9 * np.max(np.abs(other)))


@pytest.mark.parametrize("name", BEARINGS)
@pytest.mark.parametrize("rpm", [0.0, 1e3, 3e4, 1e5])
@pytest.mark.parametrize("outer", [0.0, 1.0])
def test_extremes_have_values(name, rpm, outer) -> None:
    """From no load to heavy ones, any turning ring, 1e5 rpm: finite numbers, balls in balance."""
    force = force_of(name)
    speeds = {"inner_speed": rpm * RPM * (1.0 - outer), "outer_speed": rpm * RPM * outer}
    travel, tilt = force.shape.most_travel, force.shape.most_tilt
    for x, y, t in itertools.product((-0.3, 0.0, 1e-9, 0.3), (0.0, -1e-9, 0.3), (0.0, 0.2)):
        pose = [x * travel, y * travel, 0.0, 0.0, t * tilt, 0.0]
        for values in force(pose, **speeds):
            assert np.all(np.isfinite(values))


def test_idle_balls_lie_on_the_outer_raceway() -> None:
    force = force_of("loose")
    balls = force.loads(np.zeros(6), inner_speed=5e3 * RPM)
    centrifugal, _ = force.speed_loads(5e3 * RPM, 0.0)
    np.testing.assert_array_equal(balls.load[0], 0.0)
    np.testing.assert_allclose(balls.load[1], centrifugal, rtol=1e-10)
    np.testing.assert_allclose(balls.contact_angle[1], 0.0, atol=1e-12)


def test_mirrored_bearing_carries_the_other_way() -> None:
    pose, _, balls = rest(ANGULAR, [5e3, 1e3, 0.0, 0.0, 0.0, 0.0])
    other, _, mirrored = rest(OTHER_WAY, [-5e3, 1e3, 0.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(other, pose * [-1, 1, 1, 1, -1, -1], rtol=1e-7, atol=1e-13)
    np.testing.assert_allclose(mirrored.load, balls.load, rtol=1e-6, atol=1e-6)


def test_angular_contact_does_not_hold_the_other_way() -> None:
    with pytest.raises(AnalysisError, match="no equilibrium"):
        rest(ANGULAR, [-5e3, 0.0, 0.0, 0.0, 0.0, 0.0])


def test_cage_angle_turns_the_balls() -> None:
    """After a pitch everything is as before; round-off."""
    force = force_of("loose")
    pose = [3e-6, 12e-6, 2e-6, 0.0, 1e-4, 0.0]
    pitch = 2.0 * math.pi / LOOSE.balls
    for one, other in zip(
        force(pose, inner_speed=100.0), force(pose, cage_angle=pitch, inner_speed=100.0), strict=True
    ):
        np.testing.assert_allclose(one, other, rtol=1e-8, atol=1e-8 * np.max(np.abs(one)))
    assert force(pose, cage_angle=0.5 * pitch)[0][2] != pytest.approx(force(pose)[0][2], rel=1e-3)


def test_speed_loads_by_hand() -> None:
    """A turning outer ring drives the cage faster; both rings at one speed: the ball does not spin about itself."""
    force = force_of("angular")
    mass = 7850.0 * math.pi / 6.0 * 22.225e-3**3
    centrifugal, factor = force.speed_loads(1000.0, 0.0)
    cage = 500.0 * (1.0 - 22.225 * math.cos(math.radians(40.0)) / 125.26)
    assert centrifugal == pytest.approx(mass * 62.63e-3 * cage**2, rel=1e-12)
    assert factor == pytest.approx(0.1 * mass * 22.225e-3**2 * cage**2 * 125.26 / 22.225, rel=1e-12)
    assert force.speed_loads(0.0, 1000.0)[0] > centrifugal
    together, none = force.speed_loads(1000.0, 1000.0)
    assert together == pytest.approx(mass * 62.63e-3 * 1e6, rel=1e-12)
    assert none == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("pose", "keywords", "words"),
    [
        ([math.nan, 0, 0, 0, 0, 0], {}, "pose: got .*finite numbers"),
        ([0, 0, math.inf, 0, 0, 0], {}, "pose: got .*finite numbers"),
        ([0, 1.0, 0, 0, 0, 0], {}, "within"),
        ([0, 0, 0, 0, 0.5, 0], {}, "within"),
        ([0, 0, 0], {}, r"shape \(3,\)"),
        ("hello", {}, "six real numbers"),
        ([0] * 6, {"cage_angle": math.nan}, "cage angle nan"),
        ([0] * 6, {"inner_speed": math.nan}, "speeds: got nan"),
        ([0] * 6, {"outer_speed": 2.0 * FASTEST}, "speeds: got"),
        ([0] * 6, {"cage_speed": math.inf}, "speeds: got .*inf rad/s of the cage"),
        ([0] * 6, {"velocity": [math.nan] * 6}, "velocity: got"),
    ],
)
def test_what_is_no_motion_is_refused(pose, keywords, words) -> None:
    with pytest.raises(InputError, match=words):
        force_of("deep")(pose, **keywords)


@pytest.mark.parametrize(("name", "value"), [("damping", -1.0), ("damping_time", math.nan)])
def test_dampers_that_are_none_are_refused(name, value) -> None:
    with pytest.raises(InputError, match=f"ball law, {name}: got"):
        dry_law(DEEP, **{name: value})


def test_element_turns_with_the_system() -> None:
    force = force_of("deep")
    element = LocatingElement("bearing", "ring", "ground", force, inner_spin=2.0)
    conditions = element.conditions(Operation(10.0, 3.0))
    assert conditions["inner_speed"] == 20.0
    assert conditions["cage_angle"] == pytest.approx(3.0 * DEEP.cage_speed(2.0), rel=1e-14)
    assert element.excitation.order == pytest.approx(7.0 * DEEP.cage_speed(2.0), rel=1e-14)
    assert dataclasses.replace(element, inner_spin=0.0).excitation is None


def test_idle_balls_between_rings_against_each_other_have_an_answer() -> None:
    """They go around at next to no speed, and nothing presses them on a raceway."""
    geometry = dataclasses.replace(ball_estimate("7014C"), clearance=20e-6)
    pose = [4.01578328e-05, 4.07220817e-05, -3.56027299e-05, 0.0, -8.73386791e-05, 4.24532939e-04]
    force, _, _ = BallForce(geometry, dry_law(geometry))(pose, inner_speed=1.4163468, outer_speed=-1.3458069)
    still, _, _ = BallForce(geometry, dry_law(geometry))(pose)
    np.testing.assert_allclose(force, still, atol=1e-3 * np.abs(still).max())
