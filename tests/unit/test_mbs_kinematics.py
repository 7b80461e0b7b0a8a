"""Motion of the rings of a roller bearing: spin, cage, turning frames."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs.bearings.bearing import RingState, axial_rotation, relative_motion, spin
from tests.cases.bearings import AT, bearing, force


def test_spin_counts_full_turns_through_tilts():
    tilt = np.linalg.qr(np.array([[1.0, 1e-3, 2e-3], [-1e-3, 1.0, 0.0], [-2e-3, 0.0, 1.0]]))[0]
    tilt *= np.sign(np.diag(tilt))
    last = 0.0
    for angle in np.linspace(0.0, 40.0, 400):
        last = spin(tilt @ axial_rotation(angle), near=last)
        assert last == pytest.approx(angle, abs=1e-5)


def test_pose_of_a_spinning_tilted_ring_is_steady():
    tilt_y, tilt_z = 2e-4, -3e-4
    cy, sy, cz, sz = math.cos(tilt_y), math.sin(tilt_y), math.cos(tilt_z), math.sin(tilt_z)
    tilt = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1.0]]) @ np.array([[cy, 0, sy], [0, 1.0, 0], [-sy, 0, cy]])
    for angle in (0.0, 1.0, math.pi / 2, 4.0):
        inner = RingState([1e-5, 2e-6, 3e-6], tilt @ axial_rotation(angle), np.zeros(3), tilt[:, 0] * 100.0)
        pose, velocity = relative_motion(inner, RingState.at_rest())
        np.testing.assert_allclose(pose, [1e-5, 2e-6, 3e-6, 0.0, math.sin(tilt_y), sz * cy], rtol=1e-12)
        np.testing.assert_allclose(velocity, 0.0, atol=1e-12)


def test_spinning_outer_ring_leaves_the_frame_where_it_is():
    outer = RingState(np.zeros(3), axial_rotation(2.0), np.zeros(3), [50.0, 0.0, 0.0])
    inner = RingState([0.0, 1e-5, 0.0], np.eye(3), np.zeros(3), np.zeros(3))
    pose, velocity = relative_motion(inner, outer, 2.0, 50.0)
    np.testing.assert_allclose(pose, [0.0, 1e-5, 0.0, 0.0, 0.0, 0.0], atol=1e-20)
    np.testing.assert_allclose(velocity, 0.0, atol=1e-18)


def test_cage_turns_with_both_rings():
    each = bearing()
    assert each.cage_angle(1.0, 1.0) == pytest.approx(1.0)
    assert each.cage_angle(1.0, 0.0) + each.cage_angle(0.0, 1.0) == pytest.approx(1.0)


def test_outer_ring_with_the_rollers_gives_the_same_as_the_inner():
    # rings move apart by the same amount whichever is displaced
    element = force()
    inner, outer = RingState.at_rest([0.0, 7e-6, 0.0]), RingState.at_rest()
    one = element.rings(inner, outer, **AT)
    two = element.rings(RingState.at_rest(), RingState.at_rest([0.0, -7e-6, 0.0]), **AT)
    np.testing.assert_allclose(one.vector[:3], two.vector[:3], rtol=1e-12)


def test_bad_rings():
    with pytest.raises(InputError) as caught:
        RingState([0.0, 0.0], np.eye(3), [0.0, 0.0, math.nan], "fast")
    assert len(caught.value.problems) == 3
    with pytest.raises(InputError, match=r"rotation: got a matrix that is .* from a rotation"):
        RingState.at_rest(rotation=1.1 * np.eye(3))
