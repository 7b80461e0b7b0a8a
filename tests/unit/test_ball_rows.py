"""Ball bearings of several rows: against single ones at their places, and what catalogues tell of their inside."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.designations.reader import table
from ehdmaps.physics.point.ball_catalogue import ball_dynamic_rating, ball_estimate, ball_static_rating
from ehdmaps.physics.point.ball_geometry import BallGeometry, BallRow
from ehdmaps.physics.point.row_catalogue import row_designations
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.laws import dry_law

ANGULAR = ball_estimate("7208AC")
PLACES = {"O": (-9e-3, 9e-3), "X": (9e-3, -9e-3)}


def force_of(geometry: BallGeometry) -> BallForce:
    return BallForce(geometry, dry_law(geometry, damping_time=1e-5))


def carried(place: float) -> np.ndarray:
    """Pose of a ring at a place along the axis by that of the shaft."""
    found = np.eye(6)
    found[1, 5], found[2, 4] = place, -place
    return found


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("arrangement", PLACES)
def test_two_rows_are_two_bearings_at_their_places(arrangement, turned):
    """Force, K and C to round-off, tilted, turning, pressed and turned round."""
    shift, sign = 3e-6, -1.0 if turned else 1.0
    rows = tuple(BallRow(way, place, shift) for way, place in zip((1.0, -1.0), PLACES[arrangement], strict=True))
    both = dataclasses.replace(ANGULAR, contact_angle=sign * ANGULAR.contact_angle, rows=rows)
    pose = np.array([2e-6, 5e-6, -7e-6, 0.0, 1e-4, -2e-4])
    at = {"inner_speed": 500.0, "cage_angle": 0.3}
    found, wanted = force_of(both)(pose, **at), [np.zeros(6), np.zeros((6, 6)), np.zeros((6, 6))]
    for row in rows:
        way, place = sign * row.way, sign * row.place
        single = force_of(dataclasses.replace(ANGULAR, contact_angle=way * ANGULAR.contact_angle))
        moves = carried(place)
        force, *matrices = single(moves @ pose + np.array([way * shift, 0.0, 0.0, 0.0, 0.0, 0.0]), **at)
        wanted[0] += moves.T @ force
        wanted[1] += moves.T @ matrices[0] @ moves
        wanted[2] += moves.T @ matrices[1] @ moves
    for ours, theirs in zip(found, wanted, strict=True):
        assert np.max(np.abs(ours - theirs)) < 1e-12 * np.max(np.abs(theirs))
    assert np.max(np.abs(found[2])) > 0.0


def test_small_motions_know_the_rows():
    """The motions of groove centres, by which films with memory are condensed, give the stiffness of the force."""
    both = force_of(dataclasses.replace(ANGULAR, rows=(BallRow(1.0, -9e-3, 4e-6), BallRow(-1.0, 9e-3, 4e-6))))
    pose = np.array([1e-6, 2e-6, -1e-6, 0.0, 1e-4, -1e-4])
    _, stiffness, _ = both(pose)
    moved = both.by_pose(both.angles)
    springs = both.last_balls[:, 2:6].reshape(-1, 2, 2)
    np.testing.assert_allclose(np.einsum("zai,zab,zbj->ij", moved, springs, moved), stiffness, rtol=1e-12, atol=1e-6)


def test_four_points_under_an_axial_load_are_an_angular_bearing():
    four = ball_estimate("QJ208").with_clearance(0.0)
    one = dataclasses.replace(four, rows=(BallRow(),))
    pose = np.array([1.2e-5, 0.0, 0.0, 0.0, 0.0, 0.0])
    for speed in (0.0, 300.0):
        for ours, theirs in zip(
            force_of(four)(pose, inner_speed=speed), force_of(one)(pose, inner_speed=speed), strict=True
        ):
            np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-9)
    assert math.degrees(one.contact_angle) == pytest.approx(35.0)


def test_axial_clearance_is_the_way_between_both_rows():
    """It shifts the rows, and leaves their contact angle: half of it either way, then load."""
    bearing = ball_estimate("3208").with_clearance(20e-6)
    assert math.degrees(bearing.free_angle) == pytest.approx(25.0)
    force = force_of(bearing)
    for x, loaded in ((9.99e-6, False), (10.01e-6, True), (-9.99e-6, False), (-10.01e-6, True)):
        assert (abs(force(np.array([x, 0, 0, 0, 0, 0.0]))[0][0]) > 0.0) == loaded
    pressed = force_of(bearing.with_clearance(-6e-6))(np.zeros(6))
    assert pressed[0][0] == pytest.approx(0.0, abs=1e-9) and pressed[1][0, 0] > 0.0


def test_double_rows_of_the_catalogue_have_balls_as_they_are_made():
    """C and C0 agree on balls within 2 % of C; by chance a third of them would be within 1 % of 32nds of an inch."""
    rows = {f"{series}{row[0]:g}": row for series, rows in table("balls")["double_row"].items() for row in rows}
    near, ratios = [], []
    for name in row_designations():
        if name[0] == "Q":
            continue
        found = ball_estimate(name)
        bore = {"00": 10, "01": 12, "02": 15, "03": 17}.get(name[2:], 5 * int(name[2:]))
        row = rows[f"{name[:2]}{bore}"]
        ratios.append(ball_dynamic_rating(found) / row[3])
        assert ball_static_rating(found) == pytest.approx(row[4], rel=1e-9)
        assert 2.0 * found.rows[1].place > found.ball_diameter  # rows have room beside each other
        size = found.ball_diameter / 25.4e-3 * 32.0
        near.append(abs(size / round(size) - 1.0) < 0.01)
    assert len(near) == 31 and near.count(True) >= 28
    assert np.max(np.abs(np.array(ratios) - 1.0)) < 0.02


@pytest.mark.parametrize(
    ("typed", "name", "angle", "least", "largest"),
    [
        ("3208", "3208", 25.0, 0.0, 29.0), ("3208 ATN9/C3", "3208A", 30.0, 1.0, 40.0),
        ("5208", "3208", 25.0, 0.0, 29.0),
        ("3208-B-TVH", "3208B", 25.0, 0.0, 29.0), ("QJ 308 N2MA", "QJ308", 35.0, 42.0, 106.0),
    ],
)  # fmt: skip
def test_names_of_makers(typed, name, angle, least, largest):
    found = ball_estimate(typed)
    assert (found.name, math.degrees(found.contact_angle)) == (name, pytest.approx(angle))
    assert np.array(found.clearance_range.reach) == pytest.approx([1e-6 * least, 1e-6 * largest])
    assert "of SKF, axial" in found.clearance_range.words


@pytest.mark.parametrize("typed", ["3308 DMA", "3299", "QJ299", "3208 A C5"])
def test_others_are_refused(typed):
    with pytest.raises(InputError, match="designation: got"):
        ball_estimate(typed)
