"""Frequencies at which bearings repeat themselves."""

from __future__ import annotations

import math

import pytest

from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.rollers.tapered_catalogue import tapered_estimate
from mbs.passes import passes_of


def test_the_bearing_of_a_public_data_set():
    # 6205-2RS JEM of the Case Western Reserve University: sizes in inches, and multiples of the speed, as it publishes.
    # The bound is a digit of the published numbers; its "rolling element" counts both raceways that a defect meets.
    inch = 25.4e-3
    geometry = BallGeometry("6205", 0.3126 * inch, 1.537 * inch, 9, 0.52, 0.53)
    found = passes_of(geometry, 9, 1.0)
    assert found.inner == pytest.approx(5.4152, abs=1e-4)
    assert found.outer == pytest.approx(3.5848, abs=1e-4)
    assert found.cage == pytest.approx(0.39828, abs=1e-4)
    assert 2.0 * found.element == pytest.approx(4.7135, abs=2e-4)


@pytest.mark.parametrize("angle", [0.0, 15.0, 40.0])
@pytest.mark.parametrize("speeds", [(1.0, 0.0), (0.0, 1.0), (1.0, -0.5), (-1.0, 0.2)])
def test_points_of_contact_have_one_speed_on_both_bodies(angle, speeds):
    # Pure rolling, seen from the cage: where a ball touches a ring both surfaces move alike. The bound is round-off.
    geometry = BallGeometry("b", 10e-3, 60e-3, 12, 0.52, 0.52, math.radians(angle))
    found, lean = passes_of(geometry, 12, *speeds), math.cos(math.radians(angle))
    inner, outer = 30e-3 - 5e-3 * lean, 30e-3 + 5e-3 * lean
    assert found.inner / 12 * inner == pytest.approx(found.element * 5e-3, rel=1e-12)
    assert found.outer / 12 * outer == pytest.approx(found.element * 5e-3, rel=1e-12)
    assert found.inner + found.outer == pytest.approx(12 * abs(speeds[0] - speeds[1]), rel=1e-12)


def test_rollers_of_a_cone_turn_as_their_geometry_says():
    geometry = tapered_estimate("32208")
    turns = abs(geometry.roller_speed(1.0))
    assert passes_of(geometry, geometry.rollers, 1.0).element == pytest.approx(turns, rel=1e-12)
