"""Cylindrical rollers between ribs: a balance by points in the plane and scipy, the same without ribs, both ways."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from scipy.optimize import root

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.rollers.ribbed_geometry import RibbedGeometry, mirrored_ribs, ribbed_estimate, with_ribs
from ehdmaps.physics.solids import STEEL
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_point import RIB_FRICTION, TaperedPoint

GEOMETRY = ribbed_estimate("NUP210", 8e-6, 12e-6)
FORCE = TaperedForce(GEOMETRY, slices=7)
POSE = np.array([9e-6, 8e-6, -4e-6, 0.0, 2e-4, -3e-4])
SIZE = np.array([1.0, 1.0, 1.0, 1.0, 0.03, 0.03])


def by_points(force: TaperedForce, pose: np.ndarray, centrifugal: float) -> np.ndarray:
    """Force on the inner ring: each contact by where its point goes, both bodies rigid, rollers balanced by scipy."""
    geometry, total = force.geometry, np.zeros(6)
    sphere, half, at = geometry.end_sphere, 0.5 * geometry.roller_length, force.positions
    single, play = force.dry_law.inner.coefficient / at.size, 0.25 * geometry.diametral_clearance
    angle = math.asin(geometry.rib_lever / sphere)
    for j in range(geometry.rollers):
        c, s = (turn(2.0 * math.pi * j / geometry.rollers) for turn in (math.cos, math.sin))
        tilt = pose[5] * c - pose[4] * s
        ring = np.array([pose[0] - 0.5 * geometry.pitch_diameter * tilt, pose[1] * c + pose[2] * s, tilt])

        def moved(body: np.ndarray, point: np.ndarray) -> np.ndarray:
            return body[:2] + body[2] * np.array([-point[1], point[0]])

        def forces(v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            on_roller, on_ring = np.array([0.0, centrifugal, 0.0]), np.zeros(3)
            for place, depth in zip(at, force.shape.profile - play, strict=True):
                point = np.array([place, 0.0])
                cup = single * max(moved(v, point)[1] - play - depth, 0.0) ** (10.0 / 9.0)
                cone = single * max((moved(ring, point) - moved(v, point))[1] - play - depth, 0.0) ** (10.0 / 9.0)  # noqa: B023
                on_roller += (cone - cup) * np.array([0.0, 1.0, place])
                on_ring -= cone * np.array([0.0, 1.0, place])
            for index, rib in enumerate(force.ribs):
                end = math.copysign(1.0, rib.normal[0]) * (1.0 if rib.outer else -1.0)
                up = 1.0 if rib.outer else -1.0
                away = np.array([end * math.cos(angle), up * math.sin(angle)])  # from the end out of the roller
                point = np.array([end * (half - sphere), 0.0]) + sphere * away
                other = np.zeros(3) if rib.outer else ring  # noqa: B023
                gap = float(
                    (moved(v, point) - moved(other, point)) @ away
                ) - 0.25 * geometry.axial_clearance * math.cos(angle)
                push = -force.shape.ribs.laws[index] * max(gap, 0.0) ** 1.5 * away
                both = np.array([*push, point[0] * push[1] - point[1] * push[0]])
                on_roller += both
                on_ring -= 0.0 if rib.outer else both
            return on_roller, on_ring

        start = 1e6 * force._rollers[j, 9:12] + 0.01  # no answer: what is left of the balance is asked below
        found = root(lambda v: forces(1e-6 * v)[0] / [1.0, 1.0, half], start, options={"xtol": 1e-14, "maxfev": 2000})
        assert np.max(np.abs(found.fun)) < 1e-6
        axial, radial, moment = forces(1e-6 * found.x)[1]
        moment -= 0.5 * geometry.pitch_diameter * axial
        total += np.array([axial, radial * c, radial * s, 0.0, -moment * s, moment * c])
    return total


@pytest.mark.parametrize("speed", [0.0, 1000.0])
def test_contacts_by_points_give_the_same_force(speed) -> None:
    """Places of points of rigid bodies and a general solver in place of levers and Newton's method."""
    found, _, _ = FORCE(POSE, inner_speed=speed)
    expected = by_points(FORCE, POSE, FORCE.speed_loads(speed)[0])
    assert abs(expected[0]) > 100.0
    assert np.max(np.abs(found - expected) / SIZE) < 1e-7 * np.linalg.norm(expected)  # balance of rollers by scipy


def test_without_axial_load_it_is_the_bearing_without_ribs() -> None:
    plain = BearingGeometry("plain", 50e-3, 70e-3, 10e-3, 15e-3, 17, 6e-6)
    bearing = Bearing(plain, "iso", 41)
    pose = POSE * [0.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    f, K, _ = TaperedForce(with_ribs(plain, axial_clearance=200e-6), slices=41)(pose)
    g, L, _ = BearingForce(bearing, laws.hertz(bearing))(pose)
    # round-off of sums and of powers; rollers are balanced to 1e-13 of their load
    assert np.max(np.abs(f - g)) < 3e-12 * float(np.linalg.norm(g))
    assert np.max(np.abs(K - L)) < 3e-11 * float(np.max(np.abs(L)))


def test_stiffness_is_the_derivative_of_the_force() -> None:
    _, stiffness, damping = TaperedForce(GEOMETRY, damping_time=1e-5)(POSE, inner_speed=800.0)
    quotient = np.zeros((6, 6))
    for i in (0, 1, 2, 4, 5):
        step = np.zeros(6)
        step[i] = 1e-9 / SIZE[i]
        force = TaperedForce(GEOMETRY)
        ahead, behind = (force(POSE + sign * step, inner_speed=800.0)[0] for sign in (1.0, -1.0))
        quotient[:, i] = (behind - ahead) / (2.0 * step[i])
    scale = np.outer(SIZE, SIZE) * float(np.max(np.abs(stiffness[:3, :3])))
    assert np.max(np.abs(quotient - stiffness) / scale) < 3e-5  # slices that begin to carry within the step
    assert np.max(np.abs(stiffness - stiffness.T) / scale) < 1e-12  # a potential
    assert np.max(np.abs(damping - 1e-5 * stiffness) / scale) < 1e-9 * 1e-5  # what holds loose rollers


def test_both_ways_are_alike_and_one_way_is_half_of_it() -> None:
    """Turned about the axis y: x and theta_z change their signs, and so do force and moment along them; round-off."""
    turned = np.array([-1.0, 1.0, 1.0, 1.0, 1.0, -1.0])
    still = POSE * [1.0, 1.0, 0.0, 1.0, 0.0, 1.0]
    force, _, _ = FORCE(still)
    other, _, _ = FORCE(still * turned)
    scale = SIZE * np.linalg.norm(force)
    assert np.max(np.abs(other - force * turned) / scale) < 1e-11
    shift = still * [1.0, 1.0, 0.0, 0.0, 0.0, 0.0]
    one = dataclasses.replace(GEOMETRY, carries="+x")
    for geometry, way in ((one, 1.0), (mirrored_ribs(one), -1.0)):
        alone = TaperedForce(geometry, slices=7)
        found, expected = (each(shift * [way, 1, 1, 1, 1, 1])[0] for each in (alone, FORCE))
        assert np.max(np.abs(found - expected) / scale) < 1e-11
        assert abs(alone(shift * [-way, 1, 1, 1, 1, 1])[0][0]) < 1e-9


def test_the_couple_of_the_ribs_moves_the_loads_along_the_roller() -> None:
    """Moments about the middle of each roller; where one end has lifted off the raceway the other one holds it.

    Ribs lean, so that the lever of their couple is a little less than between their contacts.
    """
    for axial, radial, lifted in ((9e-6, 25e-6, False), (120e-6, 8e-6, True)):
        rollers = FORCE.loads([axial, radial, 0.0, 0.0, 0.0, 0.0])
        cone, cup, rib = rollers.load
        np.testing.assert_allclose(rollers.ribs[0], rollers.ribs[1], rtol=1e-9, atol=1e-9)
        couple = rib * 2.0 * GEOMETRY.rib_reach
        np.testing.assert_allclose(cup * rollers.centre[1] - cone * rollers.centre[0], couple, atol=1e-9 * cup.max())
        ends = rollers.slices[:, rollers.load[0].argmax()][:, [1, -2]]  # the outermost ones are relieved by the profile
        assert np.all(ends[[0, 1], [0, 1]] > 0.0) and np.all(ends[[0, 1], [1, 0]] == 0.0) == lifted
    assert 0.95 * 0.75 * GEOMETRY.roller_diameter < 2.0 * GEOMETRY.rib_reach < 0.75 * GEOMETRY.roller_diameter


def test_an_operating_point_takes_the_load_and_slides_at_both_ribs() -> None:
    point = TaperedPoint.at(FORCE, (-1500.0, 4000.0, 0.0), 300.0)
    assert float(FORCE(point.pose, inner_speed=300.0)[0][0]) == pytest.approx(1500.0, rel=1e-8)  # of the equilibrium
    assert not np.any(point.elements.ribs[:2] > 0.0) and not point.notes[1:]
    # both ribs roll off at the raceways: they slide by their height above them, at the speed of the roller and theirs
    height = 0.5 * GEOMETRY.roller_diameter - GEOMETRY.rib_lever
    cage, spin = GEOMETRY.cage_speed(300.0), GEOMETRY.roller_speed(300.0)
    slides = [height * (abs(ring - cage) + sign * abs(spin)) for ring, sign in ((300.0, 1.0), (0.0, -1.0))]
    power = RIB_FRICTION * float(np.abs(slides) @ point.elements.ribs[2:].sum(axis=1))
    assert point.rib_power == pytest.approx(power, rel=1e-12)
    with pytest.raises(InputError) as caught:
        RibbedGeometry("a", 10e-3, 15e-3, 60e-3, 14, 0.0, carries="z", axial_clearance=math.nan)
    for words in ("carries: got 'z'; allowed: both", "axial_clearance: got nan m; allowed: a finite number"):
        assert words in str(caught.value)
    with pytest.raises(InputError, match=r"ribbed bearing 'a', contact_angle: got 0.1 rad; allowed: 0"):
        RibbedGeometry("a", 10e-3, 15e-3, 60e-3, 14, 0.1)
    with pytest.raises(InputError, match=r"ribbed bearing 'a', rib_height, end_radius: got a contact 3.75 mm"):
        RibbedGeometry("a", 10e-3, 15e-3, 60e-3, 14, 0.0, end_radius=1e-3)
    assert {rib.outer for rib in GEOMETRY.ribs(STEEL)} == {False, True}
