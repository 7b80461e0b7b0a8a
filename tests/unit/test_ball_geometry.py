"""Geometry of ball bearings: curvatures, groove centres, speeds, and what is refused."""

from __future__ import annotations

import dataclasses
import math

import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.solids import STEEL

HARRIS_209 = BallGeometry("209", 12.7e-3, 65e-3, 9, 0.52, 0.52, 0.0, 15e-6)
HARRIS_218 = BallGeometry("218", 22.225e-3, 125.26e-3, 16, 0.5232, 0.5232, math.radians(40.0))


def test_free_angle_of_harris() -> None:
    """209 with 0.015 mm of diametral clearance: 0.508 mm between the groove centres, 9 deg 52' (example 2.1)."""
    assert 1e3 * HARRIS_209.groove_distance == pytest.approx(0.508, rel=1e-12)
    assert math.degrees(HARRIS_209.free_angle) == pytest.approx(9.0 + 52.0 / 60.0, abs=0.01)


def test_curvatures_of_harris() -> None:
    """218, ball on the inner raceway: sum of curvatures 0.108 1/mm, difference 0.9260 (example 2.3)."""
    inner, outer = HARRIS_218.contacts(STEEL)
    total = [1e-3 * (1.0 / c.rolling_radius + 1.0 / c.transverse_radius) for c in (inner, outer)]
    difference = [
        (c.transverse_radius - c.rolling_radius) / (c.transverse_radius + c.rolling_radius) for c in (inner, outer)
    ]
    assert total[0] == pytest.approx(0.108, abs=5e-4)
    assert difference[0] == pytest.approx(0.926, abs=5e-4)
    assert total[1] == pytest.approx(0.0832, abs=5e-4)
    assert difference[1] == pytest.approx(0.9038, abs=5e-4)


def test_signs_and_preload() -> None:
    other = dataclasses.replace(HARRIS_218, contact_angle=-HARRIS_218.contact_angle)
    assert other.free_angle == -HARRIS_218.free_angle
    assert HARRIS_218.free_angle == pytest.approx(math.radians(40.0), rel=1e-12)
    pressed = dataclasses.replace(HARRIS_209, clearance=-10e-6)
    assert pressed.free_angle == 0.0
    assert pressed.radial_distance > pressed.groove_distance


def test_pure_rolling() -> None:
    """Surface speeds at both races against the cage: equal to the entrainment speed; round-off."""
    inner, outer = 314.0, -25.0
    cage = HARRIS_218.cage_speed(inner, outer)
    gamma, half = HARRIS_218.gamma, 0.5 * HARRIS_218.pitch_diameter
    u = HARRIS_218.entrainment_speed(inner, outer)
    assert abs(inner - cage) * half * (1.0 - gamma) == pytest.approx(u, rel=1e-12)
    assert abs(outer - cage) * half * (1.0 + gamma) == pytest.approx(u, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"ball_diameter": math.nan}, "ball_diameter: got nan"),
        ({"ball_diameter": 30e-3}, "balls that have room"),
        ({"pitch_diameter": 0.0}, "pitch_diameter: got 0.0"),
        ({"balls": 2}, "balls: got 2"),
        ({"balls": 9.0}, "balls: got 9.0"),
        ({"inner_conformity": 0.5}, "inner_conformity: got 0.5"),
        ({"outer_conformity": 1.2}, "outer_conformity: got 1.2"),
        ({"contact_angle": 1.6}, "contact_angle: got 1.6"),
        ({"contact_angle": -1.6}, "contact_angle: got -1.6"),
        ({"clearance": 1.0}, "clearance: got 1e"),
        ({"clearance": math.inf}, "clearance: got inf"),
        ({"name": ""}, "has no name"),
        ({"label": "\n"}, "label: got"),
    ],
)
def test_impossible_geometries_are_refused(change, words) -> None:
    with pytest.raises(InputError, match=words):
        dataclasses.replace(HARRIS_209, **change)


def test_all_problems_at_once() -> None:
    with pytest.raises(InputError) as error:
        dataclasses.replace(HARRIS_209, ball_diameter=-1.0, balls=0, inner_conformity=math.nan)
    assert len(error.value.problems) == 3
