"""Runs whose levels are known in closed form, and a machine that runs up in a tenth of a second."""

from __future__ import annotations

import numpy as np

from mbs.timedata.records import TimeChannel, TimeRecord

RATE, SECONDS = 5000.0, 2.0
SINE, CHIRP, ORDER = 3.0, 0.02, 12.0
"""Amplitudes of a sine of 700 Hz [m/s2] and of an order [m/s]."""

ACCELERATION = TimeChannel("S1", "acceleration", "m/s2")
VELOCITY = TimeChannel("a longer name", "velocity", "m/s")

MACHINE = """
schema = 1
title = "a mass"
[operation]
speed = "1000 rpm"
temperature = "60 degC"
[[bodies]]
name = "mass"
freedoms = ["y", "z"]
position = ["0 mm", "0 mm", "0 mm"]
mass = "2 kg"
polar_inertia = "0.01 kg m^2"
transverse_inertia = "0.01 kg m^2"
[[springs]]
name = "hold"
on = "mass"
stiffness = { y = "1e6 N/m", z = "4e6 N/m" }
damping = { y = "50 N s/m", z = "50 N s/m" }
[[loads]]
name = "shaker"
on = "mass"
force = ["0 N", "3 N", "5 N"]
frequency = "300 Hz"
[[inputs]]
name = "E"
on = "mass"
direction = "y"
[[sensors]]
name = "top"
on = "mass"
direction = "y"
quantity = "acceleration"
[[sensors]]
name = "side"
on = "mass"
direction = "z"
quantity = "displacement"
[linear]
frequencies = ["100 Hz", "200 Hz"]
[campbell]
highest = "1 kHz"
orders = [5]
[runup]
from = "500 rpm"
to = "1500 rpm"
duration = "0.2 s"
step = "50 us"
sample = "0.4 ms"
"""
"""Steps are eight times as dense as samples."""


def known(noise: float = 0.0) -> TimeRecord:
    """A run-up from 600 to 1800 rpm with a sine and an order; the speed may have noise [rpm]."""
    time = np.arange(round(RATE * SECONDS) + 1) / RATE
    speed, angle = (20.0 + 20.0 * time) * np.pi, (20.0 * time + 10.0 * time**2) * np.pi
    given = speed + noise * np.pi / 30.0 * np.random.default_rng(1).standard_normal(time.size)
    values = np.column_stack([SINE * np.sin(2.0 * np.pi * 700.0 * time), CHIRP * np.cos(ORDER * angle)])
    return TimeRecord("known", time, (ACCELERATION, VELOCITY), values, given, angle)
