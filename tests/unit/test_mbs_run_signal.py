"""The signal of a run-up: what is refused, its angle, and the speeds that are held."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from mbs.spectral.run_signal import RunSignal
from tests.cases.run_up import RATE, held, ramp, refused


def test_a_signal_is_refused_with_every_problem():
    run = ramp()
    problems = refused(
        lambda: RunSignal(run.time, run.speed[:-1], run.angle[:5], ["a"]),
        "speed: got 16000 samples; allowed: as many as times",
        "angle: got shape (5,); allowed: (samples,) with at least 64",
        "signal: got no array of real numbers",
    )
    assert len(problems) == 3


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e200])
@pytest.mark.parametrize("name", ["time", "speed", "angle", "signal"])
def test_values_that_are_no_numbers_are_refused(name, value):
    run = ramp()
    values = getattr(run, name).copy()
    values[7] = value
    refused(lambda: dataclasses.replace(run, **{name: values}), f"{name}: got {value} at sample 7")


def test_times_are_equally_far_apart():
    run = ramp()
    time = run.time.copy()
    time[9] += 1e-5
    refused(lambda: dataclasses.replace(run, time=time), "time: got steps of", "interpolate the record")
    refused(lambda: dataclasses.replace(run, time=-run.time), "allowed: equal and > 0")


def test_angle_is_the_integral_of_the_speed():
    run = ramp()
    refused(
        lambda: dataclasses.replace(run, angle=run.angle / (2.0 * np.pi)), "check rad and rad/s against turns and rpm"
    )
    refused(lambda: dataclasses.replace(run, angle=-run.angle), "angle: got")


def test_a_rotation_that_reverses_is_refused():
    refused(lambda: ramp(-500.0, 500.0), "got -500 to 500 rpm, a rotation that reverses", "cut the record")


def test_backwards_is_forwards():
    run = ramp()
    back = RunSignal(run.time, -run.speed, -run.angle, run.signal)
    np.testing.assert_array_equal(back.speed, run.speed)
    np.testing.assert_array_equal(back.angle, run.angle)


def test_held_speeds_at_the_ends_are_left_out():
    part = held([0.0, 1.0, 3.0, 4.0], [300.0, 300.0, 1500.0, 1500.0]).ramp()
    # One sample: where a kink lies between two of them, either may count.
    assert part.time[0] == pytest.approx(1.0, abs=1.0 / RATE)
    assert part.time[-1] == pytest.approx(3.0, abs=1.0 / RATE)
