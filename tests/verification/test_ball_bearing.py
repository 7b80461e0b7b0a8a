"""Ball bearings against public numbers of ISO/TS 16281, Harris, and Newton's laws of each ball in space."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.physics.point.ball_catalogue import ANGULAR_GROOVES, GROOVES, ball_estimate
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.balls.laws import dry_law
from tests.cases.balls import ANGULAR, BEARINGS, DEEP, LOOSE, STEEP, in_space, rest

RPM = math.pi / 30.0
RADIAL, AXIAL = 1e3 * np.eye(6)[1], 1e3 * np.eye(6)[0]


@pytest.mark.parametrize(
    ("geometry", "load", "expected"),
    [
        (DEEP, RADIAL, {"y": 15.1101}),
        (DEEP, AXIAL, {"x": 133.5381}),
        (LOOSE, RADIAL, {"y": 21.223}),
        (LOOSE, AXIAL, {"x": 149.1717}),
        (LOOSE, RADIAL + AXIAL, {"y": 19.5923, "x": 146.4603, "tilt": 2.6872}),
        (LOOSE, RADIAL + AXIAL + np.eye(6)[4], {"y": 19.7144, "x": 146.3084, "tilt": 2.7239}),
        (DEEP, np.eye(6)[4], {"tilt": 3.6957}),
    ],
)
def test_public_test_of_iso_16281(geometry, load, expected) -> None:
    """Public repository minzhun/ISO16281, Test_BallBearing.py, numbers of MASTA, in um and mrad, to 6 digits.

    Tilts there have the arm d_m/2, for displacements too; the constant 1.48 of ISO is rounded. So five digits of single
    loads, four of combined ones.
    """
    pose, _, _ = rest(geometry, load, arm=0.5 * geometry.pitch_diameter)
    found = {
        "x": 1e6 * pose[0],
        "y": 1e6 * math.hypot(pose[1], pose[2]),
        "tilt": 1e3 * math.hypot(pose[4], pose[5]),
    }
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=1e-5 if len(expected) == 1 and name != "tilt" else 2e-4)


def test_axial_load_of_harris() -> None:
    """218 under 17 800 N: contact angle 41.6 deg (Rolling Bearing Analysis, example 7.5), by charts and constants."""
    pose, _, balls = rest(ANGULAR, 17800.0 * np.eye(6)[0])
    assert math.degrees(balls.mean_angle(0)) == pytest.approx(41.6, abs=0.2)
    assert pose[0] == pytest.approx(0.0386e-3, rel=0.1)


@pytest.mark.parametrize("name", ["7204B", "7208B", "7312B"])
@pytest.mark.parametrize("load", [50.0, 200.0])
def test_the_axial_displacement_is_that_of_a_catalogue(name, load) -> None:
    """NSK, Rolling Bearings E1102m, section 15.1 (1): 0.00044 (Q^2/Dw)^(1/3)/sin(alpha), N and mm, two digits.

    Its contact angle is that without load; these loads turn it by less than 0.5 degrees, 1 % of the sine.
    """
    geometry, angle = ball_estimate(name).with_clearance(0.0), math.radians(40.0)
    pose, _, balls = rest(geometry, load * np.eye(6)[0])
    _, stiffness, _ = BallForce(geometry, dry_law(geometry))(pose)
    assert 40.0 < math.degrees(balls.mean_angle(0)) < 40.5
    ball = load / (geometry.balls * math.sin(angle))
    displacement = 4.4e-7 * (ball**2 / (1e3 * geometry.ball_diameter)) ** (1.0 / 3.0) / math.sin(angle)
    assert pose[0] == pytest.approx(displacement, rel=0.03)
    assert stiffness[0, 0] == pytest.approx(1.5 * load / displacement, rel=0.045)


def test_radial_load_of_harris() -> None:
    """209 with 0.015 mm of clearance under 8900 N: 4536 N on the ball (example 7.1, by an integral over the ring)."""
    geometry = dataclasses.replace(DEEP, ball_diameter=12.7e-3, pitch_diameter=65e-3, balls=9, outer_conformity=0.52)
    geometry = dataclasses.replace(geometry, clearance=15e-6)
    _, _, balls = rest(geometry, 8900.0 * np.eye(6)[1])
    assert float(balls.load.max()) == pytest.approx(4536.0, rel=0.01)


@pytest.mark.parametrize("name", BEARINGS)
@pytest.mark.parametrize("speeds", [(0.0, 0.0), (8e3, 0.0), (0.0, 8e3), (15e3, -3e3)], ids=str)
def test_newtons_laws_in_space(name, speeds) -> None:
    """Force at poses off the middle; the residual of scipy's root, some 1e-9 of the load."""
    geometry = BEARINGS[name]
    inner, outer = speeds[0] * RPM, speeds[1] * RPM
    force = BallForce(geometry, dry_law(geometry))
    sign = -1.0 if name == "other way" else 1.0
    for pose in ([sign * 25e-6, 10e-6, -7e-6, 0.0, 3e-4, -2e-4], [sign * 40e-6, -3e-6, 4e-6, 0.0, 0.0, 1e-4]):
        found = force(pose, inner_speed=inner, outer_speed=outer)[0]
        expected = in_space(geometry, np.array(pose), inner, outer)
        scale = np.array([1.0, 1.0, 1.0, 1.0, force.shape.arm, force.shape.arm]) * np.linalg.norm(expected[:3])
        assert np.max(np.abs(found - expected) / scale) < 1e-7


def test_speed_parts_the_contact_angles() -> None:
    """Centrifugal load: smaller angle at the outer raceway, larger at the inner one, the more the faster (Jones)."""
    angles = []
    for rpm in (0.0, 3e3, 6e3, 1e4, 1.5e4):
        _, _, balls = rest(ANGULAR, 17800.0 * np.eye(6)[0], rpm * RPM)
        angles.append((balls.mean_angle(0), balls.mean_angle(1)))
    inner, outer = np.array(angles).T
    assert inner[0] == pytest.approx(outer[0], rel=1e-9)
    assert np.all(np.diff(inner) > 0.0)
    assert np.all(np.diff(outer) < 0.0)


def test_balance_of_a_ball_under_axial_load_by_hand() -> None:
    """Axial parts of both loads carry the axial load, but for the traction of the gyroscopic moment; radial F_c."""
    speed = 1e4 * RPM
    _, _, balls = rest(ANGULAR, 17800.0 * np.eye(6)[0], speed)
    force = BallForce(ANGULAR, dry_law(ANGULAR))
    centrifugal, factor = force.speed_loads(speed, 0.0, balls.cage_speed)
    (qi, qo), (ai, ao) = balls.load[:, 0], balls.contact_angle[:, 0]
    traction = 2.0 * factor * math.sin(ao) / ANGULAR.ball_diameter
    assert 16.0 * qi * math.sin(ai) == pytest.approx(17800.0, rel=1e-9)
    assert qo * math.sin(ao) + traction * math.cos(ao) == pytest.approx(qi * math.sin(ai), rel=1e-9)
    assert qo * math.cos(ao) - traction * math.sin(ao) == pytest.approx(qi * math.cos(ai) + centrifugal, rel=1e-9)


def test_preload_stiffens_and_clearance_softens() -> None:
    stiffness = []
    for clearance in (-10e-6, -5e-6, 0.0, 5e-6, 10e-6):
        _, found, _ = rest(dataclasses.replace(DEEP, clearance=clearance), 200.0 * np.eye(6)[1])
        stiffness.append(found.stiffness[1, 1])
    assert np.all(np.diff(stiffness) < 0.0)


def test_contact_angle_trades_radial_for_axial_stiffness() -> None:
    ratios = []
    for degrees in (15.0, 25.0, 40.0, 60.0):
        geometry = dataclasses.replace(ANGULAR, contact_angle=math.radians(degrees))
        _, found, _ = rest(geometry, 5e3 * np.eye(6)[0])
        ratios.append(found.stiffness[0, 0] / found.stiffness[1, 1])
    assert np.all(np.diff(ratios) > 0.0)
    # balls of one load: K_xx/K_yy about 2 tan^2 of the contact angle, some degrees above the nominal one
    assert ratios[-1] == pytest.approx(2.0 * math.tan(math.radians(60.0)) ** 2, rel=0.1)


def test_stiffness_under_axial_load_is_that_of_one_ball() -> None:
    """K_xx = Z (k sin^2 + Q/A' cos^2), K_yy = Z/2 (k cos^2 + Q/A' sin^2), from the load alone; A' the stretched A."""
    _, found, balls = rest(STEEP, 8e3 * np.eye(6)[0])
    q, angle = balls.load[0, 0], balls.contact_angle[0, 0]
    k = 1.5 * q / float(balls.approach[:, 0].sum())
    across = q / (STEEP.groove_distance + float(balls.approach[:, 0].sum()))
    sin, cos = math.sin(angle) ** 2, math.cos(angle) ** 2
    assert found.stiffness[0, 0] == pytest.approx(16.0 * (k * sin + across * cos), rel=1e-8)
    assert found.stiffness[1, 1] == pytest.approx(8.0 * (k * cos + across * sin), rel=1e-8)


@pytest.mark.parametrize(
    ("name", "load", "held", "stated"),
    [
        ("6208", (500.0, 2000.0, 0.0), 50e-6, GROOVES),
        ("6208", (0.0, 2000.0, 0.0), 50e-6, GROOVES),
        ("7014C", (1000.0, 500.0, 0.0), 6e-6, ANGULAR_GROOVES),
        ("7208B", (3000.0, 1000.0, 0.0), 8e-6, ANGULAR_GROOVES),
    ],
)
def test_groove_radii_change_stiffness_as_estimates_say(name, load, held, stated) -> None:
    """An outer groove of 0.53 in place of 0.52: radial, axial and tilt K at a load, axial K of a held ring."""
    speed, tight = 3000.0 * RPM, ball_estimate(name).with_clearance(0.0)
    wide = dataclasses.replace(tight, outer_conformity=0.53)
    forces = [BallForce(geometry, dry_law(geometry)) for geometry in (tight, wide)]
    one, other = (np.diag(BallPoint.at(force, load, speed).stiffness) for force in forces)
    with np.errstate(invalid="ignore"):
        change = 1.0 - other / one
    at = np.array([held, 0.0, 0.0, 0.0, 0.0, 0.0])
    one, other = (force(at, inner_speed=speed)[1][0, 0] for force in forces)
    radial, along, kept = (0.01 * part for part in stated)
    assert 0.0 < change[1] < radial
    assert max(change[0], change[4], change[5]) < along
    assert kept * 0.5 < 1.0 - other / one < kept
    if load[0] == 0.0:  # the largest of them
        assert max(change[0], change[4]) > 0.9 * along
        assert 1.0 - other / one > 0.95 * kept
