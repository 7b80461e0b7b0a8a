"""Outer race control against velocities in space, and stiffness, angles and cage speed against a balance by them."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import BISECTOR, HYPOTHESES, INNER, NO_MOMENT, OUTER
from ehdmaps.physics.solids import STEEL
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_motion import ball_motion
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.balls.ball_speed import Drive, ball_loads, turned
from mbs.bearings.balls.laws import dry_law
from mbs.output.one_bearing.balls import BALLS
from mbs.output.one_bearing.files import point_dataset
from mbs.output.one_bearing.kind import Description
from mbs.output.one_bearing.table import point_text
from tests.cases.balls import balls_in_space, rolls

RPM = math.pi / 30.0
NITRIDE = dataclasses.replace(STEEL, youngs_modulus=310e9, poisson_ratio=0.26, density=3250.0)
"""Balls and rings of silicon nitride: the product has one material for both."""


def directions(ai, ao):
    return math.sin(ai), math.cos(ai), math.sin(ao), math.cos(ao)


def in_vectors(ratio, ai, ao, inner, outer, hypothesis):
    """Speed around the axis and spin in space, at a pitch radius of one half."""
    touches = (
        -0.5 * ratio * np.array([math.sin(ai), math.cos(ai), 0.0]),
        0.5 * ratio * np.array([math.sin(ao), math.cos(ao), 0.0]),
    )
    speed, spin, left = rolls(np.array([0.0, 0.5, 0.0]), touches, (inner, outer), hypothesis)
    assert left < 1e-14
    return speed, spin


@pytest.mark.parametrize("hypothesis", HYPOTHESES)
def test_no_slip_at_both_raceways_and_the_axis_of_a_hypothesis(hypothesis) -> None:
    """Random bearings and angles, either ring turning: round-off. The moment is the change of the ball's spin."""
    draw, axis = np.random.default_rng(1), HYPOTHESES.index(hypothesis)
    for _ in range(100):
        ratio, (ai, ao), (inner, outer) = (
            draw.uniform(0.05, 0.3),
            draw.uniform(-0.2, 1.1, 2),
            draw.uniform(-1.0, 1.0, 2),
        )
        drive = Drive(inner, outer, math.nan, ratio, 1.0, 0.4, axis)
        at, step = (ratio, ai, ao, inner, outer, hypothesis), 1e-6
        speed, spin = in_vectors(*at)
        found, by_i, by_o, k, k_i, k_o = turned(drive, *directions(ai, ao))
        assert abs(found - speed) < 1e-12
        for n, slopes in ((1, (by_i, k_i)), (2, (by_o, k_o))):
            there = [[x + s * (i == n) if i < 5 else x for i, x in enumerate(at)] for s in (step, -step)]
            ahead, behind = ((in_vectors(*one)[0], turned(drive, *directions(*one[1:3])).k) for one in there)
            assert slopes == pytest.approx(
                [(a - b) / (2.0 * step) for a, b in zip(ahead, behind, strict=True)], abs=2e-9
            )
        # M_g = w_c x J spin, about the direction x times r;  J = m Dw^2/10, the drive's m d_m/2 = 1
        _, traction, _, _ = ball_loads(drive, found)
        if traction > -0.499 * found**2:  # see ball_loads
            moment = np.cross([speed, 0.0, 0.0], spin) * 0.1 * 2.0 * ratio**2 * (hypothesis != NO_MOMENT)
            assert 0.5 * ratio * traction * k == pytest.approx(moment[2], abs=1e-12)


def test_hypotheses_agree_at_equal_angles() -> None:
    """Outer and inner race control and the bisector: the formula of nominal angles; rings that turn alike: theirs."""
    for angle in (-0.3, 0.0, 0.7):
        for inner, outer in ((1.0, 0.0), (0.0, 1.0), (0.7, -0.4)):
            part = 0.2 * math.cos(angle)
            nominal = 0.5 * (inner * (1.0 - part) + outer * (1.0 + part))
            for axis in range(len(HYPOTHESES)):
                drive = Drive(inner, outer, math.nan, 0.2, 1.0, 0.4, axis)
                assert turned(drive, *directions(angle, angle)).speed == pytest.approx(nominal, abs=1e-15)
    for ai, ao in ((0.9, 0.5), (0.2, -0.1)):
        assert turned(Drive(0.6, 0.6, math.nan, 0.2, 1.0, 0.4), *directions(ai, ao)).speed == 0.6


CASES = [
    # name, radial and axial load, speeds of the rings in rpm; K radial along the load and axial [N/um], speed of the
    # cage [rpm]: those of the independent balance of `ball_films.md`, NaN where it has none
    ("6208", 0.0, 2000.0, 30e3, 0.0, 252.6, 60.0, 12280.0),
    ("7014C", 0.0, 500.0, 10e3, 0.0, 97.4, 26.1, 4462.0),
    ("7208B", 0.0, 1000.0, 10e3, 0.0, 23.0, 36.8, 4545.0),
    ("7208B", 1000.0, 3000.0, 15e3, 0.0, 106.5, 135.0, 6695.0),
]


@pytest.mark.parametrize("case", CASES, ids=str)
def test_stiffness_of_fast_bearings_by_another_program(case) -> None:
    """A balance by Jones and Harris of another author, with closed formulas, printed with three to four digits."""
    name, radial, axial, inner, outer, along, across, cage = case
    geometry = ball_estimate(name).with_clearance(0.0)
    point = BallPoint.at(BallForce(geometry, dry_law(geometry)), (axial, radial, 0.0), inner * RPM, outer * RPM)
    assert point.stiffness[1, 1] == pytest.approx(1e6 * along, rel=2.5e-3)
    assert point.stiffness[0, 0] == pytest.approx(1e6 * across, rel=2.5e-3)
    assert point.cage_speed == pytest.approx(cage * RPM, rel=5e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "material", "axial", "inner", "outer"),
    [
        (f"6208, {INNER}", STEEL, 2000.0, 30e3, 0.0),
        (f"7014C, {BISECTOR}", STEEL, 500.0, 10e3, 0.0),
        (f"7208B, {NO_MOMENT}", STEEL, 1000.0, 8e3, -4e3),
        ("6208", STEEL, 2000.0, 30e3, 0.0),
        ("7014C", NITRIDE, 500.0, 16e3, 0.0),
        ("7208B", STEEL, 1000.0, 0.0, 10e3),
        ("7208B", NITRIDE, 1000.0, 8e3, -4e3),
    ],
    ids=str,
)
def test_jones_balance(name, material, axial, inner, outer) -> None:
    """K along all five freedoms, angles and speed under an axial load against the balance by velocities in space.

    Differences of 20 nm: their second order, and the residual of scipy's root over the step, leave 2e-5 of K.
    """
    name, _, hypothesis = name.partition(", ")
    geometry, speeds = ball_estimate(name).with_clearance(0.0), (inner * RPM, outer * RPM)
    geometry = dataclasses.replace(geometry, hypothesis=hypothesis or OUTER)
    force = BallForce(geometry, dry_law(geometry, material), material)
    point = BallPoint.at(force, (axial, 0.0, 0.0), *speeds)

    def space(pose, only=None):
        return balls_in_space(geometry, pose, *speeds, material=material, only=only)

    (ball,) = space(point.pose, 1)[1]
    np.testing.assert_allclose(point.elements.contact_angle[:, 0], ball.angles, rtol=1e-7)
    np.testing.assert_allclose(point.elements.load[:, 0], ball.loads, rtol=1e-7)
    assert point.cage_speed == pytest.approx(ball.speed, rel=1e-9)
    assert abs(point.elements.traction[0]) == pytest.approx(ball.traction, rel=1e-7)
    found = np.zeros((6, 3))
    for column, axis in enumerate((0, 1, 4)):
        step = np.zeros(6)
        step[axis] = 2e-8 / (force.shape.arm if axis > 3 else 1.0)
        found[:, column] = (space(point.pose - step)[0] - space(point.pose + step)[0]) / (2.0 * step[axis])
    scale = np.array([1.0, 1.0, 1.0, 1.0, force.shape.arm, force.shape.arm])
    wanted = point.stiffness[:, [0, 1, 4]] / np.outer(scale, scale[[0, 1, 4]])
    found /= np.outer(scale, scale[[0, 1, 4]])
    assert np.max(np.abs(found - wanted)) < 2e-5 * np.max(np.abs(wanted))


def test_slip_and_spin_are_those_of_the_velocities() -> None:
    """Balls that roll by their own angles, and balls that a cage holds at another speed: they slip inside."""
    geometry, speeds = ball_estimate("7208B"), (9e3 * RPM, -1e3 * RPM)
    force = BallForce(geometry, dry_law(geometry))
    pose = np.array([25e-6, 6e-6, -3e-6, 0.0, 2e-4, 0.0])
    half, pitch = 0.5 * geometry.ball_diameter, 0.5 * geometry.pitch_diameter
    rolling = force.loads(pose, inner_speed=speeds[0], outer_speed=speeds[1])
    assert np.ptp(rolling.speed) > 0.005 * rolling.cage_speed
    for balls in (rolling, force.loads(pose, inner_speed=speeds[0], outer_speed=speeds[1], cage_speed=360.0)):
        motion = ball_motion(force, balls, *speeds)
        for j in range(geometry.balls):
            ai, ao = balls.contact_angle[:, j]
            inner = -half * np.array([math.sin(ai), math.cos(ai), 0.0])
            outer = half * np.array([math.sin(ao), math.cos(ao), 0.0])
            spot = np.array([0.0, pitch, 0.0])
            # the outer raceway and the way around the axis give the spin: no inner one
            own = balls.speed[j]
            e = outer / half
            across = np.cross([0.0, 0.0, 1.0], e)
            rim = np.cross([speeds[1], 0.0, 0.0], spot + outer) - np.cross([own, 0.0, 0.0], spot)
            spin = speeds[1] * e[0] * e + (rim[2] / (half * (across[0] * e[1] - across[1] * e[0]))) * across
            for side, touch in enumerate((inner, outer)):
                ring = np.cross([speeds[side], 0.0, 0.0], spot + touch)
                ball = np.cross([own, 0.0, 0.0], spot) + np.cross(spin, touch)
                normal = touch / half * (1.0 if side else -1.0)
                turning = (np.array([speeds[side], 0.0, 0.0]) - spin) @ normal
                assert motion.slip[side, j] == pytest.approx((ring - ball)[2], abs=1e-10)
                assert motion.spin[side, j] == pytest.approx(turning, abs=1e-8)
                with_cage = 0.5 * (ring + ball)[2] - np.cross([own, 0.0, 0.0], spot + touch)[2]
                assert motion.entrainment[side, j] == pytest.approx(abs(with_cage), rel=1e-12)
        slips = np.abs(motion.slip[0]).max()
        assert slips < 1e-9 if balls is rolling else slips > 0.1
        assert np.abs(motion.spin[0]).min() > 100.0
    for hypothesis in HYPOTHESES:
        other = dataclasses.replace(geometry, hypothesis=hypothesis)
        other = BallForce(other, dry_law(other))
        balls = other.loads(pose, inner_speed=speeds[0], outer_speed=speeds[1])
        motion = ball_motion(other, balls, *speeds)
        for j, (ai, ao) in enumerate(balls.contact_angle.T):
            normals = [np.array([math.sin(a), math.cos(a), 0.0]) for a in (ai, ao)]
            spot, touches = np.array([0.0, pitch, 0.0]), (-half * normals[0], half * normals[1])
            _, spin, _ = rolls(spot, touches, speeds, hypothesis)
            wanted = [(np.array([ring, 0.0, 0.0]) - spin) @ one for ring, one in zip(speeds, normals, strict=True)]
            assert motion.spin[:, j] == pytest.approx(wanted, abs=1e-7)
        assert np.abs(motion.slip).max() < 1e-9


def test_slip_and_spin_are_outputs() -> None:
    """Dataset and page: of all balls, the largest of loaded ones; no slip in rolling; traction as the note says it."""
    geometry = ball_estimate("7208B")
    point = BallPoint.at(BallForce(geometry, dry_law(geometry)), (1000.0, 10.0, 0.0), 1e4 * RPM)
    given = Description("dry Hertz", "", 0.0, 313.15, 0.3e-6, False, ())
    data = point_dataset(BALLS, given, [[point]]).isel(load=0, speed=0)
    assert data["slip"].values.max() < 1e-9
    assert data["spin"].sel(contact="inner") == np.abs(data["ball_spin"].sel(contact="inner")).max() > 1000.0
    assert abs(data["spin"].sel(contact="outer")) < 1e-9
    assert data["ball_speed"].values == pytest.approx(point.cage_speed, rel=0.01)
    share = np.abs(point.elements.traction) / point.elements.load[1]
    assert data["gyroscopic_traction"] == share.max() > 0.05
    text = "\n".join(point_text(BALLS, given, [[point]]))
    assert "spin of the ring on the ball     rad/s          1723" in text
    assert "gyroscopic traction up to 0.077 of the load" in text
