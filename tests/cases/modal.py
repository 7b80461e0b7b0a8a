"""A structure in closed form for the tests of modal identification."""

from __future__ import annotations

import numpy as np

from mbs.modal.records import Channel, Hits, Responses

STEP, SAMPLES = 1.0 / 4096.0, 4096
FREQUENCY = np.array([310.0, 640.0, 700.0])
DAMPING = np.array([0.008, 0.006, 0.01])
SHAPES = np.array([[1.0, 0.8, -0.6], [0.7, -1.0, 0.9]])
"""Of two sensors; the place hit is the first of them."""

OMEGA = 2.0 * np.pi * FREQUENCY
POLES = OMEGA * (-DAMPING + 1j * np.sqrt(1.0 - DAMPING**2))
REFERENCE = Channel("hammer", 1, 2, "force")
SENSORS = (Channel("tip", 1, 2, "displacement"), Channel("root", 2, 2, "acceleration"))
ORDERS = np.array([0, 2])


def responses_at(s):
    """Sum of modes with unit modal mass, displacement of the first and acceleration of the second sensor."""
    modes = 1.0 / (s[:, None] ** 2 + 2.0 * DAMPING * OMEGA * s[:, None] + OMEGA**2)
    return (SHAPES * SHAPES[0]) @ modes.T * s ** ORDERS[:, None]


def measured(noise=0.0, seed=0, decay=0.0, low=0.0, spacing=1.0):
    """Responses up to 1 kHz, with noise as a part of the rms of each row."""
    frequency = np.arange(low, 1000.0 + 0.5 * spacing, spacing)
    H = responses_at(2j * np.pi * frequency + decay)
    random = np.random.default_rng(seed)
    scale = noise * np.sqrt(np.mean(np.abs(H) ** 2, axis=1, keepdims=True) / 2.0)
    H = H + scale * (random.standard_normal(H.shape) + 1j * random.standard_normal(H.shape))
    pairs = tuple((sensor, REFERENCE) for sensor in SENSORS)
    return Responses(frequency, H, np.full(H.shape, np.nan), pairs, decay=decay)


def impulse_responses(samples=SAMPLES):
    """Displacements of both sensors after a unit impulse, shape (2, samples)."""
    t = np.arange(samples) * STEP
    damped = OMEGA * np.sqrt(1.0 - DAMPING**2)
    modes = np.exp(-DAMPING * OMEGA * t[:, None]) * np.sin(damped * t[:, None]) / damped
    return (SHAPES * SHAPES[0]) @ modes.T


def hits(count=6, noise=0.0, seed=0, samples=SAMPLES):
    """Hits of one sample, and displacements with noise as a part of their peaks; the noise spares the force."""
    random = np.random.default_rng(seed)
    heights = random.uniform(50.0, 150.0, count)
    force = np.zeros((count, samples))
    force[:, 0] = heights
    clean = heights[:, None, None] * impulse_responses(samples)
    peak = np.abs(clean).max(axis=2, keepdims=True)
    sensors = tuple(Channel(c.name, c.node, c.direction, "displacement") for c in SENSORS)
    return Hits(STEP, force, clean + noise * peak * random.standard_normal(clean.shape), REFERENCE, sensors)
