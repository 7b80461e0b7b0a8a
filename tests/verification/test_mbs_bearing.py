"""The bearing force against ISO 16281, published relations and numbers found independently."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbs.bearings import laws
from mbs.bearings.bearing import Bearing, RingState
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.roller_contacts import RollerContacts
from tests.cases.bearings import AT, PLANE, bearing, equilibrium, map_law, single_law


def hertz_force(name, slices=41, **keywords):
    each = Bearing.named(name, slices=slices, **{"clearance": 0.0, **keywords})
    return BearingForce(each, laws.hertz(each))


@pytest.mark.parametrize(
    ("name", "load", "stiffness"),
    [("N1014", 1e3, 796.9), ("N1014", 10e3, 1003.2), ("NU308", 2e3, 689.0), ("NU308", 20e3, 867.4)],
)
def test_radial_stiffness_without_profile(name, load, stiffness):
    element = hertz_force(name, profile="straight")
    at, K = equilibrium(element, [load, 0.0])
    assert K[1, 1] / 1e6 == pytest.approx(stiffness, abs=0.06)  # printed digits
    geometry = element.bearing.geometry
    power_law = 1e9 * geometry.rollers**0.9 * geometry.roller_length**0.8 * load**0.1
    assert K[1, 1] == pytest.approx(power_law, rel=0.012)  # the power law is a fit
    rollers = element.rollers([0.0, *at, 0.0, 0.0, 0.0])
    assert np.max(rollers.load) * geometry.rollers / load == pytest.approx(4.08, abs=0.005)


@pytest.mark.parametrize(
    ("name", "load", "radial", "tangential"), [("NU308", 141.42, 1.747e8, 1.157e8), ("N1014", 40.0, 1.548e8, 8.89e7)]
)
def test_stiffness_with_the_profile_and_41_slices(name, load, radial, tangential):
    along, across = np.array([1.0, 1.0]) / math.sqrt(2.0), np.array([1.0, -1.0]) / math.sqrt(2.0)
    _, K = equilibrium(hertz_force(name), load * along)
    assert along @ K[1:3, 1:3] @ along == pytest.approx(radial, rel=5e-4)  # printed digits
    # N1014 has rollers square to the load, whose middle slice is at lift-off to round-off, where k ~ delta^(1/9)
    assert across @ K[1:3, 1:3] @ across == pytest.approx(tangential, rel=1.5e-3)


def test_converged_stiffness_rises_with_the_load_as_it_should():
    along = np.array([1.0, 1.0]) / math.sqrt(2.0)
    element = hertz_force("NU308", slices=2001)
    k = []
    for load in (141.42, 212.1, 282.8):
        _, K = equilibrium(element, load * along)
        k.append(along @ K[1:3, 1:3] @ along)
    assert k[0] == pytest.approx(1.837e8, rel=1e-3)
    assert k[1] / k[0] == pytest.approx(1.160, abs=1e-3)
    assert k[2] / k[0] == pytest.approx(1.288, abs=1.5e-3)


def iso16281(diameter, length, rollers, clearance, slices, cage_angle, pose):
    """Forces and moments on the inner ring, summed in plain numbers [N, mm] as the standard writes them."""
    c_l = 35948.0 * (1e3 * length) ** (8.0 / 9.0)
    y, z, tilt_y, tilt_z = (1e3 * pose[1], 1e3 * pose[2], pose[4], pose[5])
    force = [0.0, 0.0, 0.0, 0.0]
    for j in range(rollers):
        phi = cage_angle + 2.0 * math.pi * j / rollers
        delta = y * math.cos(phi) + z * math.sin(phi) - 0.5e3 * clearance
        psi = tilt_z * math.cos(phi) - tilt_y * math.sin(phi)
        for k in range(slices):
            x = 1e3 * length * ((k + 0.5) / slices - 0.5)
            profile = 0.00035 * 1e3 * diameter * math.log(1.0 / (1.0 - (2.0 * x / (1e3 * length)) ** 2))
            total = delta + x * psi - 2.0 * profile
            if total > 0.0:
                q = c_l / slices * total ** (10.0 / 9.0)
                force[0] -= q * math.cos(phi)
                force[1] -= q * math.sin(phi)
                force[2] += 1e-3 * q * x * math.sin(phi)
                force[3] -= 1e-3 * q * x * math.cos(phi)
    return force


@pytest.mark.parametrize("clearance", [0.0, 20e-6, -5e-6])
@pytest.mark.parametrize(
    ("y", "z", "tilts"), [(12e-6, -9e-6, (0, 0)), (5e-6, 25e-6, (3e-4, -5e-4)), (0.0, 0.0, (0, 0))]
)
def test_hertz_is_the_sum_of_the_standard(clearance, y, z, tilts):
    pose = [0.0, y, z, 0.0, *tilts]
    f, _, _ = hertz_force("NU308", clearance=clearance)(pose, cage_angle=0.3)
    expected = iso16281(14e-3, 15e-3, 12, clearance, 41, 0.3, pose)
    np.testing.assert_allclose(f[PLANE], expected, rtol=1e-12, atol=1e-9)
    assert f[0] == f[3] == 0.0


def test_map_law_at_rest_and_standstill_is_the_dry_standard():
    element = BearingForce(bearing(), map_law())
    pose = [0.0, 8e-6, 3e-6, 0.0, 1e-4, -2e-4]
    for got, expected in zip(
        element(pose, entrainment_speed=0.0, temperature=330.0), hertz_force("NU308")(pose), strict=True
    ):
        np.testing.assert_allclose(got, expected, rtol=1e-9, atol=1e-9 * np.max(np.abs(expected)))


@pytest.mark.parametrize("clearance", [0.0, 20e-6])
@pytest.mark.parametrize("kind", ["hertz", "constant", "map"])
def test_rollers_as_bodies_have_the_statics_of_the_series(kind, clearance):
    each = bearing(clearance=clearance)
    series, inner, outer, tolerance = {
        "hertz": (laws.hertz(each, 30.0), laws.hertz(each, 30.0).single(), laws.hertz(each, 30.0).single(), 1e-12),
        "constant": (laws.constant(2e8, 9.0), laws.constant(2e8).single(), laws.constant(2e8).single(), 1e-12),
        # rigid rollers balance as a whole, not slice by slice
        "map": (map_law(), single_law("inner"), single_law("outer"), 2e-4),
    }[kind]
    pose = np.array([0.0, 12e-6, 9e-6, 0.0, 1e-4, -2e-4])
    f, K, _ = BearingForce(each, series)(pose, cage_angle=0.1, **AT)
    contacts = RollerContacts(each, inner, outer)
    q = contacts.settled(pose, cage_angle=0.1, **AT)
    parts, k, _ = contacts(q, cage_angle=0.1, **AT)
    np.testing.assert_allclose(parts[:6], f, atol=tolerance * np.max(np.abs(f)))
    np.testing.assert_allclose(parts[6:12], -parts[:6], atol=1e-9 * np.max(np.abs(f)))
    np.testing.assert_allclose(parts[12:], 0.0, atol=1e-9 * np.max(np.abs(f)))
    loaded = 12 + np.flatnonzero(np.diag(k)[12:] > 0.0)
    condensed = k[np.ix_(PLANE, PLANE)] - k[np.ix_(PLANE, loaded)] @ np.linalg.solve(
        k[np.ix_(loaded, loaded)], k[np.ix_(loaded, PLANE)]
    )
    np.testing.assert_allclose(condensed, K[np.ix_(PLANE, PLANE)], atol=5.0 * tolerance * np.max(K))


def turned(vector):
    """Rotation matrix of a rotation vector."""
    angle = np.linalg.norm(vector)
    if angle == 0.0:
        return np.eye(3)
    a = np.asarray(vector) / angle
    cross = np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


def rings_in_motion():
    outer = RingState([0.3, -0.2, 0.1], turned([0.4, 0.2, -0.3]), [0.02, -0.01, 0.03], [3.0, -0.2, 0.1])
    place = outer.position + outer.rotation @ np.array([2e-4, 9e-6, 6e-6])
    inner = RingState(
        place,
        outer.rotation @ turned([0.0, 2e-4, -3e-4]) @ turned([1.7, 0.0, 0.0]),
        outer.velocity + np.cross(outer.angular_velocity, place - outer.position) + np.array([0.0, 2e-5, -3e-5]),
        outer.angular_velocity + outer.rotation @ np.array([80.0, 2e-3, 1e-3]),
    )
    return inner, outer


@pytest.mark.parametrize("spin", [(0.0, 0.0), (0.7, 2.5)])
def test_momentum_balances_and_rotation_of_everything_changes_nothing(spin):
    element = BearingForce(bearing(), map_law())
    inner, outer = rings_in_motion()
    keywords = {**AT, "cage_angle": 0.2, "outer_spin": spin[0], "outer_spin_rate": spin[1]}
    got = element.rings(inner, outer, **keywords)
    force = np.max(np.abs(got.inner_force))
    assert np.all(got.inner_force + got.outer_force == 0.0)
    about_origin = (
        got.inner_moment
        + got.outer_moment
        + np.cross(inner.position, got.inner_force)
        + np.cross(outer.position, got.outer_force)
    )
    assert np.max(np.abs(about_origin)) < 1e-15 * force  # lever arms of 0.4 m, round-off
    Q = turned([1.1, -2.0, 0.4])
    moved = [
        RingState(Q @ ring.position, Q @ ring.rotation, Q @ ring.velocity, Q @ ring.angular_velocity)
        for ring in (inner, outer)
    ]
    again = element.rings(*moved, **keywords)
    np.testing.assert_allclose(again.vector.reshape(4, 3) @ Q, got.vector.reshape(4, 3), atol=1e-8 * force)
    big = np.kron(np.eye(4), Q)
    for a, b in ((again.stiffness, got.stiffness), (again.damping, got.damping)):
        np.testing.assert_allclose(big.T @ a @ big, b, atol=1e-8 * np.max(np.abs(b)))


def displaced(ring, vector):
    return RingState(
        ring.position + vector[:3], turned(vector[3:]) @ ring.rotation, ring.velocity, ring.angular_velocity
    )


def hurried(ring, vector):
    return RingState(ring.position, ring.rotation, ring.velocity + vector[:3], ring.angular_velocity + vector[3:])


@pytest.mark.parametrize("spin", [(0.0, 0.0), (0.7, 2.5)])
def test_jacobians_of_the_rings_are_the_derivatives(spin):
    element = BearingForce(bearing(), map_law())
    inner, outer = rings_in_motion()
    keywords = {**AT, "cage_angle": 0.2, "outer_spin": spin[0], "outer_spin_rate": spin[1]}
    got = element.rings(inner, outer, **keywords)
    for change, matrix, steps in (
        (displaced, got.stiffness, (1e-9, 1e-7)),
        (hurried, got.damping, (1e-4, 1e-2)),
    ):
        for i in range(12):
            vector = np.zeros(12)
            vector[i] = steps[0] if i % 6 < 3 else steps[1]
            ahead, behind = (
                element.rings(change(inner, sign * vector[:6]), change(outer, sign * vector[6:]), **keywords).vector
                for sign in (1.0, -1.0)
            )
            column = -(ahead - behind) / (2.0 * np.max(vector))
            # forces and moments differ in size, and so do their rows
            for rows in (slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12)):
                scale = np.max(np.abs(matrix[rows]))
                np.testing.assert_allclose(matrix[rows, i], column[rows], atol=2e-6 * scale)
