"""What a tapered roller bearing refuses, and its element."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.rollers.tapered_catalogue import tapered_estimate
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.locating import locating_element
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.locating.locating_force import LAST
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.model.elements import Operation

FORCE = TaperedForce(tapered_estimate("32208"), slices=5)


def test_wrong_values_are_refused() -> None:
    with pytest.raises(InputError) as caught:
        TaperedForce(FORCE.geometry, -1.0, math.nan, profile="round", slices=1)
    text = str(caught.value)
    for words in ("damping: got -1.0 N s/m", "damping_time: got nan s", "profile: got 'round'", "slices: got 1"):
        assert words in text
    with pytest.raises(InputError, match=r"got x, y, z = 0.01, 0, 0 m, .* within 0.000995833 m and 0.0331944 rad"):
        FORCE([0.01, 0, 0, 0, 0, 0])
    with pytest.raises(InputError, match="allowed: within"):
        FORCE([0, 0, 0, 0, 0.1, 0])
    with pytest.raises(InputError, match="and the cage angle nan; allowed: finite numbers"):
        FORCE(np.zeros(6), cage_angle=math.nan)
    with pytest.raises(InputError, match=r"velocity: got .*nan.*; allowed: finite numbers"):
        FORCE(np.zeros(6), [math.nan] * 6)
    with pytest.raises(InputError, match=r"speeds: got 1000000.0 and 0.0 of the rings.* at most 20000 rad/s"):
        FORCE(np.zeros(6), inner_speed=1e6)
    with pytest.raises(InputError, match=r"pose: got an array of shape \(3,\); allowed: \(6,\)"):
        FORCE(np.zeros(3))
    with pytest.raises(InputError, match="pose: got 'a'; allowed: six real numbers"):
        FORCE("a")


def test_no_balance_is_said(monkeypatch) -> None:
    force = TaperedForce(FORCE.geometry, slices=5)
    monkeypatch.setattr(force, "_kernel", lambda *_: -3)
    with pytest.raises(AnalysisError, match="tapered bearing 32208: no balance of a roller was found at"):
        force(np.zeros(6))


def test_the_element_takes_offset_and_speeds() -> None:
    element = LocatingElement("b", "shaft:0", "ground", FORCE, inner_spin=2.0, start_angle=0.1, axial_offset=10e-6)
    operation = Operation(angle=0.4, speed=100.0)
    displacement = np.array([5e-6, 1e-6, 0.0, 0.0, 0.0, 1e-5])
    turn = FORCE.geometry.cage_speed(2.0)
    found = element.evaluate(displacement, np.array([0.0, 0.1, 0.0, 0.0, 0.0, 0.0]), operation)
    pose = displacement + np.array([10e-6, 0, 0, 0, 0, 0])
    expected = FORCE(pose, [0, 0.1, 0, 0, 0, 0], cage_angle=0.1 + 0.4 * turn, inner_speed=200.0)
    np.testing.assert_allclose(found.force, expected[0], rtol=1e-9, atol=1e-9)  # balance of rollers
    assert element.excitation is not None and element.excitation.order == FORCE.geometry.rollers * turn
    assert element.ports[0].on == "shaft:0"
    loads = element.loads(displacement, operation)
    # slices add up to the rollers, and rollers to the force along the axis
    total = loads.slices.sum(axis=2) * FORCE.geometry.roller_length / 5
    np.testing.assert_allclose(total, loads.load[:2], rtol=1e-9)
    assert found.force[0] == pytest.approx(-float(loads.load[1].sum()) * FORCE.shape.cup[0], rel=1e-9)
    assert element.excitation.harmonics == locating_element.HARMONICS


def test_rollers_of_loose_rings_lie_in_the_cup() -> None:
    """Without load between the rings only centrifugal load and moment are left: they lean on cup and rib."""
    loose = [-50e-6, 0.0, 0.0, 0.0, 0.0, 0.0]
    assert not np.any(FORCE.loads(loose).load)
    loads = FORCE.loads(loose, inner_speed=1000.0).load
    centrifugal, _ = FORCE.speed_loads(1000.0)
    # no contact with the cone: two forces and the rib's hold a roller, by the triangle of their directions
    parts = np.linalg.solve(np.array([np.array(FORCE.shape.cup), -FORCE.shape.ribs.normals[0]]).T, [0.0, centrifugal])
    assert loads[0] == pytest.approx(0.0, abs=1e-6)
    np.testing.assert_allclose(loads[1:], np.repeat(parts[:, None], FORCE.geometry.rollers, 1), rtol=1e-6)


@pytest.mark.parametrize("force", [FORCE, BallForce(ball_estimate("7208B"), dry_law(ball_estimate("7208B")))])
def test_what_ring_and_speed_do_is_stored(force) -> None:
    """On a path on which elements part and come back at a speed that does not change; error of 400 trapezoids."""
    turn, speeds = np.linspace(0.0, 2.6, 401), (1200.0, 0.0)
    path = np.zeros((turn.size, 6))
    path[:, 0], path[:, 1], path[:, 5] = 25e-6 * np.cos(turn), 8e-6 * np.sin(2.0 * turn), 1e-4 * np.sin(turn)
    last, forces, works, stored = np.zeros((force.angles.size, LAST)), [], [], []
    for pose in path:
        forces.append(force(pose, inner_speed=speeds[0])[0])
        works.append(force.works(speeds, last)[0])
        stored.append(force.stored(force.last_rows))
    ring = -np.sum(0.5 * (np.array(forces[1:]) + forces[:-1]) * np.diff(path, axis=0), axis=1)
    gained, by_speed = stored[-1] - stored[0], float(np.sum(works[1:]))
    assert abs(by_speed) > 1e-2 * abs(gained)
    assert float(ring.sum()) + by_speed == pytest.approx(gained, abs=1e-4 * np.abs(ring).sum())
