"""The linear response against an oscillation of the load, integrated in time."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import pytest

from ehdmaps.openfoam.parameters import Flow, Oscillation, Parameters
from ehdmaps.openfoam.results import Results
from ehdmaps.physics.hertz import half_width
from tests.cases import openfoam_runs

pytestmark = pytest.mark.openfoam

M, L = 5.0, 8.0
GRIDS = {"thin_film": (120, 8), "full_stress": (80, 6)}
AMPLITUDE = 1e-3


def _settings(flow: Flow) -> Parameters:
    """Without columns at the spike: there the response lets the mesh follow it, which the oscillation does not."""
    found = openfoam_runs.parameters(M, L, *GRIDS[flow], flow=flow)
    return replace(found, mesh=replace(found.mesh, spike_width=0.0))


def _frequency(settings: Parameters, omega: float) -> float:
    """Frequency [Hz] at which omega b/u has a value."""
    half = float(half_width(settings.load, settings.reduced_radius, settings.reduced_modulus))
    return omega * 0.5 * (settings.lower_speed + settings.upper_speed) / (2.0 * math.pi * half)


@cache
def _oscillated(flow: Flow, omega: float, steps: int) -> Results:
    settings = _settings(flow)
    frequency = _frequency(settings, omega)
    oscillation = Oscillation(frequency, AMPLITUDE, steps_per_cycle=steps, cycles=3)
    return openfoam_runs.run(replace(settings, frequencies=(0.0, frequency), oscillation=oscillation)).results


def _differences(results: Results) -> tuple[float, float]:
    """Of the oscillation in time from the response, relative."""
    film, loss = results.oscillation_film_compliance, results.oscillation_loss_compliance
    assert film is not None
    assert loss is not None
    return film / results.film_compliance[1] - 1.0, loss / results.loss_compliance[1] - 1.0


@pytest.mark.parametrize("flow", ["thin_film", "full_stress"])
def test_oscillation_in_time(flow: Flow) -> None:
    coarse, fine = (_differences(_oscillated(flow, 1.0, steps)) for steps in (50, 100))
    for of_coarse, of_fine in zip(coarse, fine, strict=True):
        # backward differences of second order: (omega dt)^2/3 = 1.3e-3 of the rate at 100 steps a cycle, and some times
        # that of the film compliance, which is a difference; curvature over an amplitude of 1e-3 is 1e-6
        assert abs(of_fine) < 0.02
        # of second order a quarter; 0.35 leaves room for the terms after it
        assert abs(of_fine) < 0.35 * abs(of_coarse)


@pytest.mark.parametrize("flow", ["thin_film", "full_stress"])
def test_response_does_depend_on_frequency(flow: Flow) -> None:
    """So that the test above compares with more than the limit at rest."""
    results = _oscillated(flow, 1.0, 100)
    assert abs(results.film_compliance[1] / results.film_compliance[0] - 1.0) > 0.2
    assert abs(results.loss_compliance[1] / results.loss_compliance[0] - 1.0) > 0.2


@pytest.mark.parametrize("flow", ["thin_film", "full_stress"])
def test_low_frequency_limit(flow: Flow) -> None:
    settings = _settings(flow)
    results = openfoam_runs.run(replace(settings, frequencies=(0.0, _frequency(settings, 1e-3)))).results
    # (omega b/u)^2 = 1e-6 times some 30
    assert results.film_compliance[1] == pytest.approx(results.film_compliance[0], rel=1e-4)
    assert results.loss_compliance[1] == pytest.approx(results.loss_compliance[0], rel=1e-4)


@pytest.mark.parametrize("flow", ["thin_film", "full_stress"])
def test_slow_oscillation_in_time(flow: Flow) -> None:
    """Nearly a difference quotient of steady states on a mesh that stands: the film compliance has no error of dt."""
    film, loss = _differences(_oscillated(flow, 0.03, 100))
    assert abs(film) < 1e-4  # (omega dt)^2 of the part that depends on frequency, and the amplitude squared
    assert abs(loss) < 5e-3  # (omega dt)^2/3 = 1.3e-3 a step
