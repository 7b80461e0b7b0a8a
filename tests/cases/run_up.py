"""Signals of run-ups in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs.spectral.run_signal import RPM, RunSignal

RATE = 4000.0


def ramp(begin=300.0, end=1500.0, duration=4.0, rate=RATE, signal=None):
    """A run from one speed to another [rpm]; by default with a signal of order 5 and of 200 Hz."""
    time = np.arange(round(duration * rate) + 1) / rate
    rise = (end - begin) / duration
    speed = (begin + rise * time) / RPM
    angle = (begin * time + 0.5 * rise * time**2) / RPM
    values = np.sin(5.0 * angle) + 0.1 * np.sin(2.0 * np.pi * 200.0 * time) if signal is None else signal(time)
    return RunSignal(time, speed, angle, values)


def refused(call, *parts):
    with pytest.raises(InputError) as caught:
        call()
    text = str(caught.value)
    assert all(part in text for part in parts), text
    return caught.value.problems


def held(times, speeds):
    """A run through given speeds [rpm] at given times."""
    time = np.arange(round(times[-1] * RATE) + 1) / RATE
    speed = np.interp(time, times, speeds) / RPM
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1])) / RATE])
    return RunSignal(time, speed, angle, np.cos(5.0 * angle))
