"""A whole machine struck lightly in time against its linear analyses: films with memory are one law in both.

The runs step the nonlinear contact law with a state for each slice; the analyses have the law's linear response at each
frequency, with all slices. Neither knows of the other.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.analyses.hammer import HammerSettings, hammer
from mbs.analyses.lsa import LsaSettings, lsa
from mbs.linearised.averaged import steady_system
from mbs.linearised.linear import input_matrix, sensor_matrix
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import Model, assemble
from mbs.scene.reader import parse_scene, read_scene

BAND = (100.0, 10e3)
MOUNT = 'stiffness = { y = "1e5 N/m", z = "1e5 N/m" }'
DAMPED = f'{MOUNT}\ndamping = {{ y = "500 N s/m", z = "500 N s/m" }}'
"""Dampers beside the springs on which the rings stand, so that a record of 40 ms ends at rest."""


@functools.cache
def model() -> Model:
    """The rigid shaft on two NU308 without clearance at 500 rpm, with films by formula; 0.1 N are 1/1400 of a load."""
    text = read_scene("nu308_rigid").text.replace(MOUNT, DAMPED)
    text = text.replace("slices = 41", "slices = 9").replace('amplitude = "1 N"', 'amplitude = "0.1 N"')
    assert text.count(DAMPED) == 2
    return assemble(parse_scene(text, "struck", "struck"), law="formula", films="memory")


def measured(highest: float, nonlinear: bool) -> tuple[FloatArray, ComplexArray]:
    """Frequencies of the band, and the responses that a hammer test finds there, shape (frequencies, sensors)."""
    settings = HammerSettings(highest, 0.04, hits=1, noise=0.0, nonlinear=nonlinear)
    (hits,) = hammer(model(), settings).hits
    frequencies = np.fft.rfftfreq(hits.force.shape[1], hits.step)
    inside = (frequencies >= BAND[0]) & (frequencies <= BAND[1])
    spectra = np.fft.rfft(hits.response[0])[:, inside] / np.fft.rfft(hits.force[0])[inside]
    return frequencies[inside], np.asarray(spectra.T, dtype=np.complex128)


def analysed(frequencies: FloatArray) -> ComplexArray:
    """The same by a linear analysis."""
    found = lsa(model(), LsaSettings(tuple(frequencies.tolist())))
    return np.asarray(found.responses[np.searchsorted(found.frequencies, frequencies), :, 0], dtype=np.complex128)


def slow(frequencies: FloatArray) -> ComplexArray:
    """The same with stiffness and damping of slow motion."""
    scene, s = model().scene, 2j * np.pi * frequencies[:, None, None]
    balance = equilibrium(steady_system(model().system), model().operation)
    dynamic = s * s * balance.system.mass + s * balance.damping + balance.stiffness
    motion = np.linalg.solve(dynamic, input_matrix(balance, scene.inputs)[None])
    orders = np.array([{"displacement": 0, "acceleration": 2}[sensor.quantity] for sensor in scene.sensors])
    seen = s ** orders[:, None] * (sensor_matrix(balance, scene.sensors) @ motion)
    return np.asarray(seen[:, :, 0], dtype=np.complex128)


def error(found: ComplexArray, exact: ComplexArray) -> float:
    """Largest difference of a sensor at a frequency, over the response there."""
    return float(np.max(np.abs(found - exact) / np.abs(exact)))


@pytest.mark.slow
def test_responses_in_time_are_those_of_the_linear_analysis_up_to_10_khz() -> None:
    frequencies, coarse = measured(10e3, nonlinear=True)
    exact = analysed(frequencies)
    finer_at, fine = measured(20e3, nonlinear=True)
    errors = error(coarse, exact), error(fine, analysed(finer_at))
    # The trapezoidal rule and backward differences with steps of 2.4 us and 1.2 us: found 0.38 % and 0.08 %.
    assert errors[0] < 0.01
    assert errors[1] < 0.3 * errors[0]
    # The control: films of slow motion are another machine.
    assert error(slow(frequencies), exact) > 0.25


def test_a_linear_hammer_test_has_the_films_of_the_linear_analysis() -> None:
    frequencies, found = measured(20e3, nonlinear=False)
    # Motion is exact at each sample; what is left of it at the end of the record, and of the pulse beyond its samples.
    assert error(found, analysed(frequencies)) < 1e-3
