"""Bearings and laws for the tests of the bearing force."""

from __future__ import annotations

import functools

import numpy as np

from ehdmaps.maps.law import ContactLaw
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.transient.run import WITH_STATES, run
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD

SPEED, TEMPERATURE = 1.0, 330.0
AT = {"entrainment_speed": SPEED, "temperature": TEMPERATURE}
PLANE = [1, 2, 4, 5]
"""Coordinates that have a stiffness."""


@functools.cache
def map_law(outside="clamp"):
    return ContactLaw("series", CONTACTS, OIL, SMALL_FIELD, outside)


@functools.cache
def single_law(side):
    return ContactLaw(side, [CONTACTS[side == "outer"]], OIL, SMALL_FIELD, "clamp")


def bearing(**keywords):
    return Bearing.named("NU308", **{"clearance": 0.0, **keywords})


LAWS = {
    "hertz": lambda: laws.hertz(bearing()),
    "damped hertz": lambda: laws.hertz(bearing(), damping=100.0),
    "hertz with a damping time": lambda: laws.hertz(bearing(), damping_time=1.25e-5),
    "constant": lambda: laws.constant(2e8, 50.0),
    "map": map_law,
}


def force(law="map", **keywords):
    return BearingForce(bearing(**keywords), LAWS[law]())


def integrate(system, speed, duration, settings, displacement=None, velocity=None, progress=None):
    """A run that records the motion of all coordinates."""
    return run(system, speed, duration, settings, (), displacement, velocity, progress, WITH_STATES)


def equilibrium(element, load, start=5e-6, steps=80):
    """Pose without tilt under a radial load (2,) [N], by Newton's method, and the matrix there."""
    at = np.array([start, 0.0]) if np.ndim(start) == 0 else np.array(start)
    load = np.asarray(load, dtype=float)
    for _ in range(steps):
        f, K, _ = element([0.0, *at, 0.0, 0.0, 0.0])
        step = np.linalg.solve(K[1:3, 1:3], f[1:3] + load)
        at = at + step
        if np.max(np.abs(step)) < 1e-17:
            break
    f, K, _ = element([0.0, *at, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(f[1:3], -load, rtol=1e-9, atol=1e-9 * np.max(np.abs(load)))
    return at, K


def central_difference(call, at, step):
    """Columns of derivatives of a function of six coordinates."""
    columns = []
    for i in range(len(at)):
        ahead, behind = at.copy(), at.copy()
        ahead[i] += step[i]
        behind[i] -= step[i]
        columns.append((call(ahead) - call(behind)) / (ahead[i] - behind[i]))
    return np.array(columns).T
