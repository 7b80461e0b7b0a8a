"""Modes followed over speed against closed forms: whirl, crossing, veering, critical damping; and the energy identity.

Systems of one and two masses and of a disc, whose frequencies are written down; and the shipped system with dry Hertz,
which must not change with the speed.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
import scipy.linalg

from mbs.bearings.bearing_element import RingElement
from mbs.linearised import sweep_result
from mbs.linearised.averaged import averaged, over_pitch, steady_system
from mbs.linearised.dynamic import dynamic_stiffness
from mbs.linearised.linear import TOLERANCE, checked_response, frequency_response, modal_response, state_space
from mbs.linearised.modes import state_modes, undamped_modes
from mbs.linearised.sweep import sweep
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Forces, Input, Operation, Port, Sensor, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.system import System
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene

RPM = math.pi / 30.0
MASS = 2.0
POLAR, TRANSVERSE = 0.03, 0.02
Y = np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
ROUND_OFF = 1e-9


class OverSpeed(RingElement):
    """A spring and damper along y that vary with the speed, in place of a bearing."""

    def __init__(self, name, on, against="ground", stiffness=lambda speed: 0.0, damping=lambda speed: 0.0):
        self.name, self.stiffness, self.damping = name, stiffness, damping
        self.ports = (Port(on, against),)

    def evaluate(self, displacement, velocity, operation):
        k, c = (value(operation.speed) * np.outer(Y, Y) for value in (self.stiffness, self.damping))
        return Forces(-k @ displacement - c @ velocity, k, c)


def disc(translation=8e4, tilt=500.0, damping=0.0):
    """A disc on springs that are alike all round."""
    body = rigid_body("disc", [Inertia(MASS, POLAR, TRANSVERSE)], ["y", "z", "theta_y", "theta_z"], spin=1.0)
    stiffness = np.diag([0.0, translation, translation, 0.0, tilt, tilt])
    return System([body], [Spring("s", "disc", "ground", stiffness, damping * stiffness)])


def whirl(speed, tilt=500.0):
    """Backward and forward whirl of the disc [rad/s] and their slopes over the speed.

    I_t w^2 - I_p Omega w - k = 0 for the tilt theta_y + i theta_z turning with w: any textbook of rotor dynamics.
    """
    half = 0.5 * POLAR * speed / TRANSVERSE
    root = np.sqrt(half**2 + tilt / TRANSVERSE)
    slope = 0.5 * POLAR / TRANSVERSE * half / root
    return root - half, root + half, slope - 0.5 * POLAR / TRANSVERSE, slope + 0.5 * POLAR / TRANSVERSE


class TestWhirl:
    SPEEDS = np.linspace(1.0, 200.0, 12)

    def test_branches_are_followed_through_a_crossing(self):
        """Forward whirl crosses both translations at 200 rad/s, backward whirl falls away from them."""
        found = sweep(disc(), self.SPEEDS).damped
        backward, forward, falling, rising = whirl(self.SPEEDS)
        omega = found.eigenvalues.imag
        assert forward[0] < 200.0 < forward[-1]
        assert omega.shape == (12, 4)
        assert np.all(np.isfinite(omega))
        # Eigenvalues in double precision.
        np.testing.assert_allclose(omega[:, 0], backward, rtol=ROUND_OFF)
        np.testing.assert_allclose(omega[:, 1], forward, rtol=ROUND_OFF)
        np.testing.assert_allclose(omega[:, 2:], 200.0, rtol=ROUND_OFF)
        np.testing.assert_allclose(found.whirl[:, 0], falling, rtol=1e-7)
        np.testing.assert_allclose(found.whirl[:, 1], rising, rtol=1e-7)
        np.testing.assert_allclose(found.whirl[:, 2:], 0.0, atol=1e-9)

    def test_branches_apart_from_rest_on(self):
        """At rest the pair is equal and has no shapes of its own; it must split all the same, and not end."""
        found = sweep(disc(), np.linspace(0.0, 200.0, 5)).damped
        assert found.eigenvalues.shape == (5, 4)
        assert np.all(np.isfinite(found.eigenvalues))
        backward, forward, _, _ = whirl(200.0)
        ends = np.sort(found.eigenvalues[-1].imag)
        np.testing.assert_allclose(ends, np.sort([backward, forward, 200.0, 200.0]), rtol=ROUND_OFF)
        signs = np.sign(found.whirl[1:, :]) * (np.abs(found.whirl[1:, :]) > 1e-6)
        # No track changes from forward to backward.
        assert np.all(signs == signs[0])

    def test_undamped_modes_leave_gyroscopic_terms_out(self):
        found = sweep(disc(), self.SPEEDS).undamped
        np.testing.assert_allclose(found.frequency * 2.0 * np.pi, np.tile(found.frequency[0] * 2.0 * np.pi, (12, 1)))
        np.testing.assert_allclose(np.sort(found.frequency[0]) * 2.0 * np.pi, [*[math.sqrt(25e3)] * 2, 200.0, 200.0])

    def test_damping_beside_gyroscopic_terms(self):
        """Damping as a part of the stiffness: I_t s^2 + (c - i I_p Omega) s + k = 0 for each sense, by its roots."""
        found = sweep(disc(damping=1e-3), self.SPEEDS).damped
        for index, speed in enumerate(self.SPEEDS):
            roots = [
                max(np.roots([TRANSVERSE, 1e-3 * 500.0 + sign * 1j * POLAR * speed, 500.0]), key=lambda root: root.imag)
                for sign in (1.0, -1.0)
            ]
            np.testing.assert_allclose(found.eigenvalues[index, :2], roots, rtol=ROUND_OFF)


def pair(coupling, begin=5e4, end=2e5, last=100.0, damping=0.0):
    """Two masses; the spring of the first one becomes stiffer with the speed, that of the second stays at 1e5 N/m."""
    bodies = [rigid_body(name, [Inertia(MASS, 0.01, 0.02)], ["y"]) for name in ("a", "b")]
    springs = [
        Spring("b_ground", "b", "ground", 1e5 * np.outer(Y, Y)),
        Spring("coupling", "a", "b", coupling * np.outer(Y, Y)),
    ]
    varying = OverSpeed(
        "bearing",
        "a",
        stiffness=lambda speed: begin + (end - begin) * speed / last,
        damping=lambda speed: damping,
    )
    return System(bodies, springs, (), [varying])


def pair_frequencies(coupling, speeds, begin=5e4, end=2e5, last=100.0):
    """Of both branches [rad/s], from the characteristic polynomial."""
    first, second = begin + (end - begin) * speeds / last + coupling, 1e5 + coupling
    mean, half = 0.5 * (first + second), 0.5 * (first - second)
    root = np.sqrt(half**2 + coupling**2)
    return np.sqrt(np.stack([mean - root, mean + root], axis=1) / MASS)


class TestVeering:
    SPEEDS = np.linspace(0.0, 100.0, 9)

    def test_branches_that_turn_away_are_followed_around_the_corner(self):
        """With a coupling of 4 % the corner is narrower than a step: speeds in between are needed to see it."""
        result = sweep(pair(4e3), self.SPEEDS)
        np.testing.assert_allclose(
            2.0 * np.pi * result.undamped.frequency, pair_frequencies(4e3, self.SPEEDS), rtol=ROUND_OFF
        )
        np.testing.assert_allclose(result.damped.eigenvalues.imag, pair_frequencies(4e3, self.SPEEDS), rtol=ROUND_OFF)
        assert result.between > 0
        # Energy moves from the varying spring to the other one, and back again for the other branch.
        assert result.undamped.bearing_share[0, 0] > 0.8 > 0.2 > result.undamped.bearing_share[-1, 0]

    def test_branches_that_cross_are_followed_straight_on(self):
        result = sweep(pair(0.0), self.SPEEDS)
        expected = np.sqrt(np.stack([5e4 + 1.5e3 * self.SPEEDS, np.full(9, 1e5)], axis=1) / MASS)
        np.testing.assert_allclose(2.0 * np.pi * result.undamped.frequency, expected, rtol=ROUND_OFF)
        np.testing.assert_allclose(result.damped.eigenvalues.imag, expected, rtol=ROUND_OFF)
        assert result.between == 0

    @pytest.mark.parametrize("points", [9, 10, 41])
    def test_where_damped_modes_cross_undamped_ones_go_straight_on(self, points):
        """A gap narrower than the decay rates are apart: both keep their shapes, wherever the speeds lie.

        One of the speeds of 10 lies in the middle of the corner, where both shapes are halves of each other.
        """
        coupling, damping = 4e2, 40.0
        speeds = np.linspace(0.0, 100.0, points)
        found = sweep(pair(coupling, damping=damping), speeds)
        gap = 2.0 * coupling / (2.0 * math.sqrt(1e5 * MASS))
        assert gap < damping / (2.0 * MASS)
        plain = 2.0 * np.pi * found.undamped.frequency
        expected = np.sqrt(np.stack([5e4 + 1.5e3 * speeds + coupling, np.full(points, 1e5 + coupling)], axis=1) / MASS)
        # half the gap, of straight lines beside the branches that turn away
        np.testing.assert_allclose(plain, expected, atol=0.51 * gap)
        assert np.all(found.undamped.bearing_share[:, 0] >= 0.45)
        assert found.undamped.bearing_share[-1, 0] > 0.99 > 0.01 > found.undamped.bearing_share[-1, 1]
        np.testing.assert_array_equal(found.damped.number, [0, 1])
        # Complex modes cross by themselves; where they do, undamped ones are halves of both (the gap), and damping
        # lowers them by zeta^2/2 (5e-4).
        np.testing.assert_allclose(found.damped.frequency[:, :2] * 2.0 * np.pi, plain, rtol=5e-4, atol=gap)
        assert sweep_result.exchanged(found.undamped) == []
        # trapezoidal rule over the steps, and the corner between two of them
        np.testing.assert_allclose(found.undamped.summed_shift[-1], found.undamped.shift[-1], rtol=0.02, atol=4e-3)

    def test_a_mode_that_crosses_two_others(self):
        """Three shapes change their places in a ring: each crossing is with another mode."""
        bodies = [rigid_body(name, [Inertia(MASS, 0.01, 0.02)], ["y"]) for name in ("a", "b", "c")]
        springs = [
            Spring("b_ground", "b", "ground", 8e4 * np.outer(Y, Y)),
            Spring("c_ground", "c", "ground", 1.4e5 * np.outer(Y, Y)),
            Spring("a_b", "a", "b", 300.0 * np.outer(Y, Y)),
            Spring("a_c", "a", "c", 300.0 * np.outer(Y, Y)),
        ]
        rising = OverSpeed("bearing", "a", stiffness=lambda speed: 5e4 + 1.5e3 * speed, damping=lambda speed: 60.0)
        found = sweep(System(bodies, springs, (), [rising]), np.linspace(0.0, 100.0, 41)).undamped
        assert sweep_result.exchanged(found) == []
        expected = np.sqrt(np.array([[5e4 + 600.0, 8e4 + 300.0, 1.4e5 + 300.0], [2e5 + 600.0, 8e4, 1.4e5]]) / MASS)
        # 0.3 %: the couplings to second order
        np.testing.assert_allclose(2.0 * np.pi * found.frequency[[0, -1]], expected, rtol=3e-3)
        assert np.all(found.bearing_share[-1] == pytest.approx([1.0, 0.0, 0.0], abs=0.01))
        # trapezoidal rule over the steps, and two corners
        np.testing.assert_allclose(found.summed_shift[-1], found.shift[-1], rtol=0.02, atol=4e-3)

    def test_without_damping_they_turn_away_and_it_is_said(self):
        found = sweep(pair(4e2), np.linspace(0.0, 100.0, 10))
        assert sweep_result.exchanged(found.undamped) == [(0, 1)]
        assert found.undamped.bearing_share[-1, 0] < 0.01

    def test_energy_shares(self):
        """Of the varying spring: k_a y_a^2 of the eigenvector written out."""
        coupling = 4e4
        found = sweep(pair(coupling), self.SPEEDS).undamped
        for index, speed in enumerate(self.SPEEDS):
            stiffness = 5e4 + 1.5e3 * speed
            squares = MASS * pair_frequencies(coupling, np.array([speed]))[0] ** 2
            other = (stiffness + coupling - squares) / coupling
            total = stiffness + 1e5 * other**2 + coupling * (1.0 - other) ** 2
            np.testing.assert_allclose(found.bearing_share[index], stiffness / total, rtol=1e-8)
            np.testing.assert_allclose(found.shares[:, index].sum(axis=0), 1.0, rtol=1e-12)


class TestIdentity:
    """df/f = phi' dK phi/(2 phi' K phi), dK of the bearings."""

    def test_error_falls_with_the_square_of_the_step(self):
        """The trapezoidal rule over the steps of the sweep, against the frequencies themselves."""
        errors = []
        for points in (6, 11, 21, 41):
            found = sweep(pair(4e4), np.linspace(0.0, 100.0, points)).undamped
            errors.append(np.abs(found.summed_shift[-1] - found.shift[-1]))
        orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
        # Second order; the next term leaves a tenth at these steps.
        np.testing.assert_allclose(orders[-1], 2.0, atol=0.1)
        # For a mode of the varying spring alone the rule leaves dk^2 (1/k_first^2 - 1/k_last^2)/48 of ln f.
        step = 1.5e5 / 40.0
        assert np.all(errors[-1] < step**2 / 48.0 / 5e4**2 * (1.0 + found.shift[-1]))

    def test_one_step_is_right_to_first_order(self):
        errors = []
        for last in (4.0, 2.0, 1.0):
            found = sweep(pair(4e4), np.array([0.0, last])).undamped
            errors.append(np.abs(found.direct_shift / found.shift[-1] - 1.0))
        orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
        np.testing.assert_allclose(orders, 1.0, atol=0.1)

    @pytest.mark.slow
    def test_holds_for_a_bearing_with_films(self):
        """NU308 with the film formula, 20 um: the sum over 19 steps agrees with the shift to 1 % of it."""
        model = assemble(read_scene("nu308_rigid"), "formula", clearance=20e-6)
        result = sweep(model.system, np.linspace(500.0, 2500.0, 20) * RPM, cage_angles=3)
        inside = result.undamped.bearing_share[0] > 0.5
        assert inside.sum() == 4
        shift = result.undamped.shift[-1][inside]
        assert np.abs(shift).min() > 0.1
        np.testing.assert_allclose(result.undamped.summed_shift[-1][inside], shift, rtol=0.01)
        # Along the load the film in series makes the contact softer, and damping falls as it grows.
        assert np.all(result.bearings.stiffness[-1] < result.bearings.stiffness[0])
        assert np.all(result.bearings.damping[-1] < result.bearings.damping[0])
        assert not any(map(np.any, result.outside.values()))


class TestDryHertz:
    def test_nothing_changes_with_speed(self):
        """Newton's method leaves 1e-10 of the load, and the stiffness changes with a power of it."""
        result = sweep(assemble(read_scene("nu308_rigid"), "hertz").system, np.linspace(500.0, 2500.0, 5) * RPM)
        np.testing.assert_allclose(result.undamped.shift, 0.0, atol=1e-6)
        np.testing.assert_allclose(result.undamped.summed_shift, 0.0, atol=1e-6)
        for values in (result.bearings.load, result.bearings.stiffness):
            np.testing.assert_allclose(values, np.tile(values[0], (5, 1)), rtol=1e-6)

    def test_frequencies_rise_with_the_load(self):
        scene = read_scene("nu308_rigid")
        found = []
        for factor in (1.0, 1.5, 2.0):
            loads = tuple(dataclasses.replace(load, force=factor * load.force) for load in scene.loads)
            result = sweep(assemble(dataclasses.replace(scene, loads=loads), "hertz").system, np.array([500.0]) * RPM)
            found.append(result.undamped.frequency[0, -1])
            np.testing.assert_allclose(result.bearings.load, factor * 141.42136, rtol=1e-7)
        assert found[0] < found[1] < found[2]

    def test_stiffness_along_the_load(self):
        """1.747e8 N/m to its digits: 41 slices, a roller at 0 degrees, load at 45 degrees."""
        result = sweep(assemble(read_scene("nu308_rigid"), "hertz").system, np.array([500.0]) * RPM)
        np.testing.assert_allclose(result.bearings.stiffness, 1.747e8, rtol=5e-4)
        assert result.bearings.names == ("bearing_left", "bearing_right")

    def test_mean_over_a_pitch_is_the_mean_over_start_angles(self):
        scene = read_scene("nu308_rigid")
        mean = sweep(assemble(scene, "hertz").system, np.array([500.0]) * RPM, cage_angles=4).bearings
        one_by_one = []
        for part in range(4):
            bearings = tuple(
                dataclasses.replace(entry, start_angle=2.0 * math.pi / 12.0 * part / 4.0) for entry in scene.bearings
            )
            turned = assemble(scene.with_bearings(bearings), "hertz").system
            one_by_one.append(sweep(turned, np.array([500.0]) * RPM).bearings.stiffness)
        np.testing.assert_allclose(mean.stiffness, np.mean(one_by_one, axis=0), rtol=1e-7)
        spread = 0.5 * np.ptp(one_by_one, axis=0) / np.mean(one_by_one, axis=0)
        np.testing.assert_allclose(mean.stiffness_spread, spread, rtol=1e-5)


@pytest.fixture(scope="module")
def over(formula_map):
    """Equilibria of nu308_rigid with films of a map and 20 um at four angles of a pitch, and their mean."""
    model = assemble(read_scene("nu308_rigid"), "map", formula_map, 20e-6)
    found = over_pitch(equilibrium(steady_system(model.system), Operation(1500.0 * RPM)), 4)
    return model, found, averaged(found)


class TestMeanOverAPitch:
    def test_is_the_mean_at_any_frequency(self, over):
        """With films that relax too; the sums over slices round differently."""
        _, found, mean = over
        s = np.array([1j * 1e3, -2e3 + 2e4j, 1j * 1e5])
        expected = np.mean([dynamic_stiffness(each, s) for each in found], axis=0)
        assert mean.relaxations[0] is not None
        np.testing.assert_allclose(dynamic_stiffness(mean, s), expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())

    def test_modes_and_responses_have_it(self, over):
        model, found, mean = over
        ports, at = (model.scene.inputs, model.scene.sensors), np.array([300.0, 1500.0, 3000.0])
        speeds = np.array([1500.0 * RPM])
        many, one = (sweep(model.system, speeds, 0.0, *ports, at, cage_angles=count) for count in (4, 1))
        direct = frequency_response(mean, *ports, at)
        np.testing.assert_allclose(many.responses.values[0], direct, rtol=1e-6)  # by modes beside a direct solution
        assert np.abs(many.responses.values / one.responses.values - 1.0).max() > 1e-3
        stiffness = np.mean([each.stiffness for each in found], axis=0)
        squares = scipy.linalg.eigvalsh(0.5 * (stiffness + stiffness.T), model.system.mass)
        np.testing.assert_allclose(many.undamped.frequency[0], np.sqrt(squares) / (2.0 * math.pi), rtol=1e-9)
        value = many.damped.eigenvalues[0, 0]
        own = dynamic_stiffness(mean, np.array([value]))[0]
        assert np.abs(np.linalg.eigvals(own)).min() < 1e-7 * np.abs(np.linalg.eigvals(own)).max()
        assert not one.undamped.frequency_spread.any() and not one.damped.damping_ratio_spread.any()
        # To first order; what frequencies vary by is 0.1 to 3 %, so that its square is 0.1 % and less.
        each = np.array([undamped_modes(entry).frequency for entry in found])
        exact = 0.5 * np.ptp(each, axis=0)
        np.testing.assert_allclose(many.undamped.frequency_spread[0], exact, atol=2e-3 * each.mean(axis=0).min())


def damped_mass(damping, stiffness=8e4):
    """Two masses that do not know of each other; the first one has a damper that varies with the speed."""
    bodies = [rigid_body(name, [Inertia(MASS, 0.01, 0.02)], ["y"]) for name in ("a", "b")]
    springs = [Spring("a_ground", "a", "ground", stiffness * np.outer(Y, Y))]
    springs.append(Spring("b_ground", "b", "ground", 1.5 * stiffness * np.outer(Y, Y), 20.0 * np.outer(Y, Y)))
    return System(bodies, springs, (), [OverSpeed("film", "a", damping=damping)])


CRITICAL = 2.0 * math.sqrt(8e4 * MASS)


class TestOscillationThatEnds:
    SPEEDS = np.linspace(0.0, 100.0, 11)

    def test_a_mode_that_stops_to_oscillate_ends(self):
        found = sweep(damped_mass(lambda speed: 2.0 * CRITICAL * speed / 100.0), self.SPEEDS).damped
        ratio = 2.0 * self.SPEEDS / 100.0
        alive = ratio < 1.0
        assert found.eigenvalues.shape[1] == 2
        np.testing.assert_allclose(found.damping_ratio[alive, 0], ratio[alive], atol=ROUND_OFF)
        # |lambda| is omega_0 however strong the damping.
        np.testing.assert_allclose(found.frequency[alive, 0], 200.0 / (2.0 * math.pi), rtol=ROUND_OFF)
        assert np.all(np.isnan(found.eigenvalues[~alive, 0].real))
        assert np.all(np.isfinite(found.eigenvalues[:, 1]))
        np.testing.assert_allclose(found.frequency[:, 1], math.sqrt(6e4) / (2.0 * math.pi), rtol=ROUND_OFF)

    def test_a_mode_that_begins_to_oscillate_begins(self):
        found = sweep(damped_mass(lambda speed: 2.0 * CRITICAL * (1.0 - speed / 100.0)), self.SPEEDS).damped
        ratio = 2.0 * (1.0 - self.SPEEDS / 100.0)
        alive = ratio < 1.0
        assert found.eigenvalues.shape[1] == 2
        assert np.all(np.isfinite(found.eigenvalues[:, 0]))
        np.testing.assert_allclose(found.damping_ratio[alive, 1], ratio[alive], atol=ROUND_OFF)
        assert np.all(np.isnan(found.eigenvalues[~alive, 1].real))

    def test_a_mode_that_comes_back_is_another_one(self):
        found = sweep(damped_mass(lambda speed: 1.6 * CRITICAL * math.sin(math.pi * speed / 100.0)), self.SPEEDS).damped
        assert found.eigenvalues.shape[1] == 3
        alive = np.isfinite(found.eigenvalues.real)
        assert alive[:3, 0].all() and not alive[3:, 0].any()
        assert not alive[:8, 2].any() and alive[8:, 2].all()

    def test_a_mode_that_ends_is_not_taken_for_one_that_begins(self):
        """Critical damping of both masses at 50 rad/s: below only the first oscillates, above only the second."""
        bodies = [rigid_body(name, [Inertia(MASS, 0.01, 0.02)], ["y"]) for name in ("a", "b")]
        springs = [Spring(name, name[0], "ground", 8e4 * np.outer(Y, Y)) for name in ("a_ground", "b_ground")]
        films = [
            OverSpeed("rising", "a", damping=lambda speed: CRITICAL * speed / 50.0),
            OverSpeed("falling", "b", damping=lambda speed: CRITICAL * (2.0 - speed / 50.0)),
        ]
        # No speed of the sweep or in between is just 50 rad/s, where none oscillates.
        speeds = np.linspace(0.0, 99.0, 12)
        found = sweep(System(bodies, springs, (), films), speeds).damped
        assert found.eigenvalues.shape[1] == 2
        alive = np.isfinite(found.eigenvalues.real)
        np.testing.assert_array_equal(alive[:, 0], speeds < 50.0)
        np.testing.assert_array_equal(alive[:, 1], speeds > 50.0)
        np.testing.assert_allclose(found.damping_ratio[:6, 0], speeds[:6] / 50.0, atol=ROUND_OFF)
        np.testing.assert_allclose(found.damping_ratio[6:, 1], 2.0 - speeds[6:] / 50.0, atol=ROUND_OFF)

    def test_undamped_modes_go_on(self):
        found = sweep(damped_mass(lambda speed: 2.0 * CRITICAL * speed / 100.0), self.SPEEDS).undamped
        np.testing.assert_allclose(found.damping_ratio[:, 0], 2.0 * self.SPEEDS / 100.0, atol=ROUND_OFF)


def chain(count, damping, seed=3):
    """A chain of masses with random springs, dampers and tilts, with gyroscopic terms."""
    random = np.random.default_rng(seed)
    freedoms = ["y", "z", "theta_y", "theta_z"]
    bodies = [
        rigid_body(
            f"m{k}", [Inertia(*random.uniform([0.5, 0.01, 0.01, 0.01], [2.0, 0.015, 0.02, 0.05]))], freedoms, spin=1.0
        )
        for k in range(count)
    ]
    springs = []
    for k in range(count):
        size = np.diag([0.0, *random.uniform(1e6, 1e8, 2), 0.0, *random.uniform(1e3, 1e5, 2)])
        springs.append(Spring(f"s{k}", f"m{k}", f"m{k - 1}" if k else "ground", size, damping * size))
    return System(bodies, springs)


class TestResponses:
    FREQUENCIES = np.geomspace(1.0, 5000.0, 300)

    def pieces(self, count):
        inputs = [Input("E", "m0", Y), Input("F", f"m{count - 1}", np.eye(6)[4])]
        sensors = [
            Sensor("d", f"m{count - 1}", Y),
            Sensor("v", "m1", np.eye(6)[2], "velocity"),
            Sensor("a", "m0", Y, "acceleration", f"m{count - 1}"),
        ]
        return inputs, sensors

    @pytest.mark.parametrize("damping", [0.0, 1e-6, 1e-4])
    def test_sum_over_modes_is_the_direct_solution(self, damping):
        """To 1e-8 of the largest response; undamped ones at frequencies off the resonances, by chance of the grid."""
        count = 8
        balance = equilibrium(chain(count, damping), Operation(300.0))
        inputs, sensors = self.pieces(count)
        states = state_modes(balance, undamped_modes(balance))
        found = modal_response(balance, states, inputs, sensors, self.FREQUENCIES)
        direct = frequency_response(balance, inputs, sensors, self.FREQUENCIES)
        # Round-off of both ways, enlarged near lightly damped resonances by how far away the grid's points are.
        assert np.all(np.abs(found - direct) <= 1e-8 * np.abs(direct).max(axis=0))
        checked, error = checked_response(balance, states, inputs, sensors, self.FREQUENCIES)
        np.testing.assert_array_equal(checked, found)
        assert 0.0 < error < 1e-8

    def test_critical_damping_is_solved_directly_where_digits_are_lost(self):
        """Two eigenvectors are one: the sum over modes may fail, the result may not."""
        balance = equilibrium(damped_mass(lambda speed: CRITICAL), Operation(1.0))
        inputs, sensors = [Input("E", "a", Y)], [Sensor("S", "a", Y, "velocity")]
        states = state_modes(balance, undamped_modes(balance))
        found, error = checked_response(balance, states, inputs, sensors, self.FREQUENCIES)
        omega = 2.0 * np.pi * self.FREQUENCIES
        expected = 1j * omega / (8e4 + 1j * omega * CRITICAL - MASS * omega**2)
        # 1e-8 at the frequencies checked; a hundred times as much is room for those in between.
        np.testing.assert_allclose(found[:, 0, 0], expected, rtol=1e-6)
        assert error <= TOLERANCE

    def test_of_a_sweep(self):
        system = chain(3, 1e-5)
        inputs, sensors = self.pieces(3)
        result = sweep(system, np.array([10.0, 300.0]), 0.0, inputs, sensors, self.FREQUENCIES)
        assert result.responses.values.shape == (2, 300, 3, 2)
        for index, speed in enumerate(result.speeds):
            direct = frequency_response(equilibrium(system, Operation(float(speed))), inputs, sensors, self.FREQUENCIES)
            assert np.all(np.abs(result.responses.values[index] - direct) <= 1e-8 * np.abs(direct).max(axis=0))

    @pytest.mark.parametrize("damping", [2.0, 20.0])
    def test_peaks_are_as_high_as_they_are_between_the_frequencies(self, damping):
        """The velocity of a damped mass by a force has its peak of 1/c at the undamped frequency."""
        system = damped_mass(lambda speed: damping * (1.0 + speed))
        inputs, sensors = [Input("E", "a", Y)], [Sensor("S", "a", Y, "velocity"), Sensor("T", "b", Y)]
        axis = np.linspace(1.0, 100.0, 12)
        found = sweep(system, np.array([0.0, 1.0]), 0.0, inputs, sensors, axis).responses
        resonance = math.sqrt(8e4 / MASS) / (2.0 * math.pi)
        assert found.peak_size.shape == (2, 1, 2, 1)
        # The nearest point of the axis lies zeta/2 half widths beside the peak: a height lower by zeta^2/8.
        ratios = damping * np.array([1.0, 2.0]) / CRITICAL
        np.testing.assert_allclose(found.peak_size[:, 0, 0, 0] * CRITICAL * ratios, 1.0 - ratios**2 / 8.0, rtol=1e-5)
        np.testing.assert_allclose(found.peak_frequency[:, 0, 0, 0] / resonance, 1.0 - ratios**2 / 2.0, rtol=1e-5)
        assert np.all(np.isnan(found.peak_size[:, 0, 1, 0]))  # T feels nothing of E
        assert np.abs(found.values[:, :, 0, 0]).max() < 0.7 / damping  # the frequencies asked for step over it
        nearest = int(np.argmin(np.abs(axis - resonance)))
        np.testing.assert_array_equal(np.argmax(found.largest(0, 0), axis=1), nearest)
        np.testing.assert_array_equal(found.largest(0, 0)[:, nearest], found.peak_size[:, 0, 0, 0])
        others = np.arange(axis.size) != nearest
        np.testing.assert_array_equal(found.largest(0, 0)[:, others], np.abs(found.values[:, others, 0, 0]))


@pytest.mark.parametrize("damping", [0.0, 1e-5, 1e-2])
def test_eigenvalues_are_those_of_the_plain_state_matrix(damping):
    balance = equilibrium(chain(6, damping), Operation(300.0))
    states = state_modes(balance, undamped_modes(balance))
    plain = np.linalg.eigvals(state_space(balance).A)
    distance = np.abs(states.eigenvalues[:, None] - plain[None, :]).min(axis=1)
    # Round-off of a matrix of size |lambda|_max.
    assert distance.max() < 1e-10 * np.abs(plain).max()
    identity = states.left @ states.right
    np.testing.assert_allclose(identity, np.eye(identity.shape[0]), atol=1e-7)
