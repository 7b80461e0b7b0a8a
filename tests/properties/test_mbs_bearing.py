"""Properties of the bearing force that hold for any motion: no energy from a closed cycle, no tension, no surprise."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.cases.bearings import PLANE, force
from tests.cases.laws import SMALL_FIELD

speeds = st.sampled_from([0.0, 0.15, 0.3, 1.0, 3.0])
temperatures = st.sampled_from([SMALL_FIELD.temperature_range[0], 330.0])
clearances = st.sampled_from([-4e-6, 0.0, 20e-6])
angles = st.floats(-7.0, 7.0)
tilts = st.floats(-5e-4, 5e-4)
places = st.floats(-25e-6, 25e-6)


@functools.cache
def element(law, clearance, slices=11):
    return force(law, clearance=clearance, slices=slices)


@functools.cache
def point(law, clearance, speed, temperature):
    return element(law, clearance).at(speed, temperature)


@pytest.mark.parametrize("law", ["hertz", "map"])
@settings(max_examples=12, deadline=None)
@given(
    clearance=clearances,
    speed=speeds,
    temperature=temperatures,
    angle=angles,
    mean=st.tuples(places, places, tilts, tilts),
    amplitudes=st.lists(st.tuples(places, places, tilts, tilts), min_size=2, max_size=6),
    frequency=st.floats(1.0, 3e4),
)
def test_closed_cycles_create_no_energy(law, clearance, speed, temperature, angle, mean, amplitudes, frequency):
    at = point(law, clearance, speed, temperature)
    phase = np.linspace(0.0, 2.0 * np.pi, 1501)
    order = 1 + np.arange(len(amplitudes)) // 2
    angles = phase[:, None] * order + 0.5 * np.pi * (np.arange(len(amplitudes)) % 2)
    pose, velocity = np.zeros((phase.size, 6)), np.zeros((phase.size, 6))
    pose[:, PLANE] = np.array(mean) + np.cos(angles) @ np.array(amplitudes)
    velocity[:, PLANE] = -frequency * (np.sin(angles) * order) @ np.array(amplitudes)
    power = np.array([-at(p, v, angle)[0] @ v for p, v in zip(pose, velocity, strict=True)]) / frequency
    taken = np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(phase))
    # the elastic part gives back what it took, but for the error of the trapezia
    assert taken >= -2e-4 * np.sum(np.abs(power)) * phase[1]


@pytest.mark.parametrize("law", ["damped hertz", "hertz with a damping time", "constant"])
@settings(max_examples=25, deadline=None)
@given(
    clearance=clearances,
    angle=angles,
    pose=st.tuples(places, places, tilts, tilts),
    velocity=st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-50.0, 50.0), st.floats(-50.0, 50.0)),
)
def test_damping_of_dry_laws_takes_power(law, clearance, angle, pose, velocity):
    p, v = np.zeros(6), np.zeros(6)
    p[PLANE], v[PLANE] = pose, velocity
    each = element(law, clearance)
    damped, at_rest = each(p, v, cage_angle=angle)[0], each(p, cage_angle=angle)[0]
    assert (damped - at_rest) @ v <= 1e-12 * np.max(np.abs(damped)) * np.max(np.abs(v))


@pytest.mark.parametrize("law", ["hertz", "damped hertz", "hertz with a damping time", "constant", "map"])
@settings(max_examples=25, deadline=None)
@given(
    clearance=clearances,
    speed=speeds,
    temperature=temperatures,
    angle=angles,
    pose=st.tuples(places, places, tilts, tilts),
    velocity=st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-50.0, 50.0), st.floats(-50.0, 50.0)),
)
def test_matrices_and_loads_have_the_right_signs(law, clearance, speed, temperature, angle, pose, velocity):
    p, v = np.zeros(6), np.zeros(6)
    p[PLANE], v[PLANE] = pose, velocity
    at = point(law, clearance, speed, temperature)
    f, K, C = at(p, v, angle)
    np.testing.assert_array_equal(K, K.T)
    np.testing.assert_array_equal(C, C.T)
    assert f[0] == f[3] == 0.0
    assert not K[[0, 3]].any()
    scale = np.diag([1.0, 1.0, 1.0, 1.0, 1e2, 1e2])  # about the same size for tilts, so that round-off is too
    assert np.linalg.eigvalsh(scale @ C @ scale)[0] >= -1e-12 * np.max(np.abs(scale @ C @ scale))
    at_rest = scale @ at(p, None, angle)[1] @ scale
    assert np.linalg.eigvalsh(at_rest)[0] >= -1e-12 * np.max(at_rest)
    assert np.all(at.rollers(p, v, angle).load_per_length >= 0.0)


@settings(max_examples=25, deadline=None)
@given(clearance=clearances, speed=speeds, angle=angles, pose=st.tuples(places, places, tilts, tilts))
def test_cage_turned_by_a_pitch_changes_nothing(clearance, speed, angle, pose):
    p = np.zeros(6)
    p[PLANE] = pose
    at = point("map", clearance, speed, 330.0)
    f, K, _ = at(p, None, angle)
    again, stiffness, _ = at(p, None, angle + 2.0 * np.pi / 12)
    np.testing.assert_allclose(again, f, atol=1e-9 * (1.0 + np.max(np.abs(f))))
    # At rest a dry slice is as stiff as delta^(1/9): one at lift-off by round-off has a few per cent of a slice.
    share = 1e-7 if speed > 0.0 else 2e-3
    np.testing.assert_allclose(stiffness, K, atol=share * (1.0 + np.max(K)))
