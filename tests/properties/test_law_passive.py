"""Properties of the contact law that hold for any motion: never a tension, no energy from a closed cycle."""

from __future__ import annotations

import functools
import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import SMOOTH, Surface
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD

speeds = st.floats(0.0, 3.0)
temperatures = st.floats(*SMALL_FIELD.temperature_range)
centrifugal = st.sampled_from([0.0, 0.0, 1.0, 800.0])
surfaces = st.sampled_from([SMOOTH, Surface(3e-7)])
layers = st.sampled_from([math.inf, math.inf, 2e-6])


@functools.cache
def law(surface=SMOOTH, layer=math.inf):
    return ContactLaw("series", CONTACTS, OIL, SMALL_FIELD, "clamp", supply=OilSupply(layer), surface=surface)


@settings(max_examples=25, deadline=None)
@given(
    surface=surfaces,
    layer=layers,
    speed=speeds,
    temperature=temperatures,
    q=centrifugal,
    mean=st.floats(-1e-5, 2e-5),
    amplitudes=st.lists(st.floats(-8e-6, 8e-6), min_size=2, max_size=8),
    frequency=st.floats(1.0, 1e5),
)
def test_closed_cycles_create_no_energy(surface, layer, speed, temperature, q, mean, amplitudes, frequency):
    phase = np.linspace(0.0, 2.0 * np.pi, 4001)
    order = 1 + np.arange(len(amplitudes)) // 2
    shift = 0.5 * np.pi * (np.arange(len(amplitudes)) % 2)
    angles = phase[:, None] * order + shift
    delta = mean + np.cos(angles) @ np.array(amplitudes)
    rate = -frequency * (np.sin(angles) * order) @ np.array(amplitudes)
    w, _, c = law(surface, layer).at(speed, temperature, q)(delta, rate)
    assert np.all(w >= 0.0)
    assert np.all(c >= 0.0)
    power = w * rate / frequency
    work = np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(phase))
    # The elastic part returns what it took, but for the error of the trapezia; below 1e-30 J/m there is no contact.
    assert work >= -1e-4 * np.sum(np.abs(power)) * phase[1] - 1e-30


@settings(max_examples=25, deadline=None)
@given(
    surface=surfaces,
    layer=layers,
    speed=speeds,
    temperature=temperatures,
    q=centrifugal,
    delta=st.floats(-1e-3, 2e-5),
    step=st.floats(0.0, 1e-5),
    rate=st.floats(-10.0, 10.0),
    more=st.floats(0.0, 10.0),
)
def test_load_rises_with_approach_at_rest_and_with_rate(surface, layer, speed, temperature, q, delta, step, rate, more):
    point = law(surface, layer).at(speed, temperature, q)
    w, k, _ = point([delta, delta + step], 0.0)
    assert w[1] >= w[0] * (1.0 - 1e-12)
    assert np.all(k >= 0.0)
    w, _, c = point(delta, [rate, rate + more])
    assert w[1] >= w[0] * (1.0 - 1e-12)
    assert np.all(w >= 0.0)
    assert np.all(c >= 0.0)
    # Damping takes power: the force differs from the one at rest in the sense of the rate.
    at_rest, _, _ = point(delta, 0.0)
    assert (point(delta, rate)[0] - at_rest) * rate >= 0.0
