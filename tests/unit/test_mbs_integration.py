"""Time integration against closed forms: order, dissipation, step control."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import ElementDefaults, Forces, Load, Spring
from mbs.model.profiles import Harmonic, SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.stepping import energy_lost, numerical_damping_ratio, principal_root
from tests.cases.bearings import integrate
from tests.cases.elements import MASS, OneSided, force, stiff

REST = SpeedProfile.constant(0.0)
OMEGA = math.sqrt(5e4 / 2.0)


def oscillator(c=0.0, loads=()):
    return System([rigid_body("a", [MASS], ["y"])], [Spring("s", "a", "ground", stiff(y=5e4), stiff(y=c))], loads)


@pytest.mark.parametrize("radius", [0.0, 0.5, 0.8, 1.0])
def test_second_order(radius):
    errors = []
    for steps in (100, 200):
        h = 0.05 / steps
        run = integrate(oscillator(4.0), REST, 0.05, Settings(h, 0.05, radius), np.array([1e-3]))
        decay, damped = 1.0, math.sqrt(OMEGA**2 - 1.0)
        exact = 1e-3 * math.exp(-decay * 0.05) * (math.cos(damped * 0.05) + decay / damped * math.sin(damped * 0.05))
        errors.append(abs(run.states.displacement[-1, 0] - exact))
        assert run.steps == steps
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_spectral_radius_one_keeps_the_energy_of_a_linear_system():
    run = integrate(oscillator(), REST, 0.5, Settings(1e-3, 1e-3, 1.0), np.array([1e-3]))
    energy = 25e3 * run.states.displacement[:, 0] ** 2 + run.states.velocity[:, 0] ** 2
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)  # what Newton leaves over, times 500 steps


@pytest.mark.parametrize("radius", [0.0, 0.5, 0.8, 0.9, 1.0])
def test_numerical_damping_is_that_of_a_run(radius):
    """Decay and period of a free oscillation, from the complex motion q + i v/omega at two times a whole run apart."""
    step, steps = 1e-3, 200
    run = integrate(oscillator(), REST, steps * step, Settings(step, step, radius), np.array([1e-3]))
    # A recursion of third order has three roots; the third one is gone after some steps.
    q = run.states.displacement[-41:, 0]
    columns = np.column_stack([q[2:-1], q[1:-2], q[:-3]])
    roots = np.roots([1.0, *(-np.linalg.lstsq(columns, q[3:], rcond=1e-9)[0])])
    frequency = OMEGA / (2.0 * math.pi)
    expected = principal_root(radius, step, frequency)
    found = roots[np.argmin(np.abs(roots - expected))]
    # Newton's remainder: 1e-10 of the motion in each of 40 steps.
    assert abs(found - expected) < 1e-7
    size = abs(expected)
    assert energy_lost(radius, step, frequency) == pytest.approx(1.0 - size ** (2.0 / step), abs=1e-12)
    assert numerical_damping_ratio(radius, step, frequency) == pytest.approx(-math.log(size) / abs(np.log(expected)))


def test_numerical_damping_rises_by_the_third_power_of_frequency_and_step():
    small, twice, finer = (numerical_damping_ratio(0.8, *given) for given in ((1e-5, 1e3), (1e-5, 2e3), (2e-5, 1e3)))
    # The next term is smaller by (omega h)^2, 0.4 and 1.6 %.
    assert twice / small == pytest.approx(8.0, rel=0.02)
    assert finer / small == pytest.approx(8.0, rel=0.02)


def test_spectral_radius_dissipates_what_the_step_does_not_resolve():
    run = integrate(oscillator(), REST, 5.0, Settings(0.1, 0.1, 0.5), np.array([1e-3]))
    assert abs(run.states.displacement[-1, 0]) < 1e-12


def test_harmonic_load():
    """Started on the steady state, it stays there: 2e-4 is the phase error of 60 steps a period."""
    omega = 2.0 * math.pi * 10.0
    amplitude = 1.0 / (5e4 - 2.0 * omega**2)
    system = oscillator(0.0, [Load("l", "a", force(y=1.0), profile=Harmonic(10.0))])
    run = integrate(system, REST, 0.3, Settings(1e-4, 1e-3, 1.0), velocity=np.array([amplitude * omega]))
    np.testing.assert_allclose(
        run.states.displacement[:, 0], amplitude * np.sin(omega * run.time), atol=2e-4 * amplitude
    )


def test_gyroscopic_precession():
    """A spinning free body, nudged, turns its axis on a circle: the angular momentum stays."""
    body = rigid_body("a", [Inertia(1.0, 0.02, 0.04)], ["theta_y", "theta_z"], spin=1.0)
    run = integrate(System([body]), SpeedProfile.constant(200.0), 0.5, Settings(1e-4, 1e-3, 1.0), velocity=[1e-3, 0.0])
    momentum = 0.04 * run.states.velocity + 0.02 * 200.0 * run.states.displacement @ np.array([[0.0, -1.0], [1.0, 0.0]])
    np.testing.assert_allclose(
        momentum, np.tile(momentum[0], (run.time.size, 1)), atol=1e-10 * np.abs(momentum[0]).max()
    )


def test_step_control_meets_its_tolerance_through_an_impact():
    """A mass falls on a one-sided contact: steps are halved there, and grow again."""
    body = rigid_body("a", [MASS], ["y"])
    system = System([body], (), [Load("l", "a", force(y=20.0))], [OneSided("c", "a", k=1e9, gap=1e-3)])
    fine = integrate(system, REST, 0.04, Settings(4e-6, 1e-3, 1.0))
    free = integrate(system, REST, 0.04, Settings(1e-3, 1e-3, 1.0, tolerance=1e-8))
    assert free.halved > 0
    assert free.steps < fine.steps / 10
    np.testing.assert_allclose(free.states.displacement, fine.states.displacement, atol=1e-5)


def test_progress_and_samples():
    seen = []
    run = integrate(oscillator(), REST, 0.01, Settings(1e-3, 2e-3), np.array([1e-3]), progress=seen.append)
    assert seen == [1, 2, 3, 4, 5]
    np.testing.assert_allclose(run.time, np.arange(6) * 2e-3)
    assert run.states.displacement.shape == (6, 1)


def test_settings_that_are_not_possible_are_refused_all_at_once():
    with pytest.raises(InputError) as caught:
        Settings(1e-3, 1.5e-3, 1.5, -1.0, 2.0)
    text = "\n".join(caught.value.problems)
    for words in ("sample: got 0.0015 s", "spectral_radius: got 1.5", "tolerance: got -1.0", "residual: got 2.0"):
        assert words in text
    with pytest.raises(InputError, match=r"step: got 0\.0 s; allowed: finite and > 0"):
        Settings(0.0, 1.0)


class Mad(ElementDefaults):
    """An element whose Jacobian has the wrong sign and size, so that Newton never arrives."""

    name = "mad"

    def __init__(self):
        self.ports = OneSided("c", "a").ports

    def evaluate(self, displacement, velocity, operation):
        return Forces(1e3 * np.sin(1e14 * displacement + 1.0), 1e30 * np.eye(6), np.zeros((6, 6)))


def test_a_step_without_solution_is_said():
    system = System([rigid_body("a", [MASS], ["y"])], (), (), [Mad()])
    with pytest.raises(AnalysisError, match=r"no solution at 0 s with steps of .*start nearer to an equilibrium"):
        integrate(system, REST, 1.0, Settings(1e-1, 1e-1))
