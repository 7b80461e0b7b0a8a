"""Rollers between ribs and tapered ones find their balance at any pose and speed, from nothing and in sequence."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ehdmaps.physics.rollers.ribbed_geometry import ribbed_estimate
from ehdmaps.physics.rollers.tapered_catalogue import tapered_estimate
from mbs.bearings.locating.locating_force import FASTEST
from mbs.bearings.tapered.tapered_bearing import TaperedForce

LEFT = 1e-8
"""Force on a roller that may be left over the largest on it: Newton's method leaves 1e-9 at most, and what is read here
is of places whose rounding, 1e-16 of 1 mm, is 1e-9 of an approach of 0.1 nm."""

SMALL = 1e-5
"""Force that may be left in any case [N]: loads up to 1e-6 N are left out, and rounding of 1e-19 m at 1e9 N/m."""

sizes = st.floats(-9.0, 0.0).map(lambda exponent: 10.0**exponent)
parts = st.tuples(*[st.sampled_from([-1.0, 0.0, 1.0]) | st.floats(-1.0, 1.0)] * 5)
speeds = st.sampled_from([0.0, FASTEST]) | st.floats(-8.0, math.log10(0.999 * FASTEST)).map(
    lambda exponent: 10.0**exponent
)


@functools.cache
def bearing(name, profile):
    geometry = tapered_estimate(name) if name[0] == "3" else ribbed_estimate(name, 20e-6, 20e-6)
    return TaperedForce(geometry, profile=profile)


def left(force, loads):
    """Largest force left on a roller beside the largest that acts on it [N], by the sum over its contacts."""
    worst = 0.0
    for index, row in enumerate(force.last_rows):
        v, d, f = row[9:12], row[12:15], np.array([0.0, *loads])
        arm, size = abs(force.shape.levers[-1]), np.abs(f).sum()
        for sign, moved, normal, c in (
            (-1, v, force.shape.cup, force.dry_law.inner.coefficient),
            (1, d - v, force.shape.cone, force.dry_law.inner.coefficient),
        ):
            depth = np.dot(normal, moved[:2]) + moved[2] * force.shape.levers - force.shape.profile
            q = c / depth.size * np.maximum(depth, 0.0) ** (10.0 / 9.0)
            f += sign * np.array([q.sum() * normal[0], q.sum() * normal[1], q @ force.shape.levers])
            size += q.sum()
        for rib in force.ribs if index < force.geometry.rollers else ():  # the first row leans on them
            moved = v if rib.outer else d - v
            q = rib.contact.coefficient * max(np.dot((*rib.normal, rib.lever), moved) - rib.play, 0.0) ** 1.5
            f += (-1 if rib.outer else 1) * q * np.array([*rib.normal, rib.lever])
            size += q
        worst = max(worst, max(abs(f[0]), abs(f[1]), abs(f[2]) / arm) - LEFT * size)
    return worst


@pytest.mark.parametrize("profile", ["iso", "straight"])
@pytest.mark.parametrize("name", ["32208", "30204", "NUP210", "NNCF5010"])
@settings(max_examples=25, deadline=None)
@given(poses=st.lists(st.tuples(sizes, parts, speeds, st.floats(-7.0, 7.0)), min_size=1, max_size=4))
def test_the_balance_is_found(name, profile, poses):
    """Poses up to the largest accepted ones; a bearing that goes from one to the other, as a solver calls it."""
    force = bearing(name, profile)
    limits = np.array([force.shape.most_travel] * 3 + [force.shape.most_tilt] * 2)
    for size, part, speed, angle in poses:
        pose = np.insert(np.array(part) * size * limits, 3, 0.0)
        f, stiffness, _ = force(pose, cage_angle=angle, inner_speed=speed)
        assert np.all(np.isfinite(f)) and np.all(np.isfinite(stiffness))
        assert left(force, force.speed_loads(speed)) <= SMALL
