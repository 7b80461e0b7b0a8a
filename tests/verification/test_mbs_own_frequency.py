"""Modes at their own frequency: against a count of all zeros of the determinant, slow films, and published figures.

The figures are those of a study of its own with the same closed formula of the locked film, but with the films of each
slice from the Reynolds solver at its load instead of a map's table: frequencies within 0.3 %, damping ratios within
10 % is what the map's splines and the other law of two contacts in series leave.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.maps.emap import open_map
from mbs.analyses.film_errors import film_errors
from mbs.bearings.bearing_element import BearingElement, RingElement
from mbs.linearised.averaged import steady_system
from mbs.linearised.dynamic import FilmStates, Reason, at_own_frequency, dynamic_stiffness, newton, system_film_states
from mbs.linearised.linear import FILM_TOLERANCE, frequency_response, state_space
from mbs.linearised.modes import modes, state_modes, undamped_modes
from mbs.linearised.sweep import sweep
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.relaxation import Relaxation
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene

RPM = math.pi / 30.0


@pytest.fixture(scope="module")
def emap(reynolds_map):
    return open_map(reynolds_map)


@pytest.fixture(scope="module")
def rigid(emap):
    """nu308_rigid at 500 rpm with 20 um of clearance, where films are too slow for all shaft modes."""
    model = assemble(read_scene("nu308_rigid"), "map", emap, 20e-6, "memory")
    return equilibrium(model.system, Operation(500.0 * RPM))


def gearbox(emap, rpm, films, clearance=30e-6):
    model = assemble(read_scene("gearbox"), "map", emap, clearance, films)
    return equilibrium(steady_system(model.system), Operation(rpm * RPM))


def with_times(balance, factor):
    """The same equilibrium with films that relax faster by a factor."""
    copy = dataclasses.replace(balance)
    scaled = [
        None if one is None else Relaxation(one.rows / math.sqrt(factor), one.times * factor)
        for one in balance.relaxations
    ]
    copy.__dict__["relaxations"] = tuple(scaled)
    return copy


def by_hand(balance, s):
    """Z(s) from k, c and theta of each slice by plain sums, without what the program has for it."""
    found = balance.stiffness + s * balance.damping + s * s * balance.system.mass
    for index in balance.system.select(RingElement):
        connected = balance.system.elements[index]
        element = connected.element
        assert isinstance(element, BearingElement)
        ports = connected.transform @ balance.displacement
        at = element.force.law.at(element.entrainment_speed(balance.operation), element.temperature)
        rollers = element.loads(ports, balance.operation)
        for angle, approaches in zip(rollers.angle, rollers.approach, strict=True):
            c, theta = at(approaches, 0.0)[2], times(at, approaches)
            cos, sin, x = math.cos(angle), math.sin(angle), rollers.position
            nothing, whole = np.zeros(x.size), np.ones(x.size)
            y = np.stack([nothing, cos * whole, sin * whole, nothing, -sin * x, cos * x])
            change = s * c / (1.0 + s * theta) - s * c
            part = (y * change) @ y.T * element.bearing.slice_length
            found = found + connected.transform.T @ part @ connected.transform
    return found


def times(at, approaches):
    """theta = c/(k_s - k) by the response of the law in time: the load that follows a step of the approach at once."""
    memory = at.memory
    _, k, c = at(approaches, 0.0)
    state = memory.settled(approaches)
    _, locked, _ = memory.advance(state, approaches, 1e-16)
    return np.where(c > 0.0, c / np.maximum(locked - k, 1e-30), 0.0)


def zeros_within(balance, low, high, steepest):
    """How often det Z(s) turns about zero along the edge of a sector: its zeros there, as its poles lie outside."""
    count = 6000
    rays = [np.exp(1j * angle) for angle in (0.45 * math.pi, steepest)]
    radii = np.geomspace(low, high, count)
    arc = np.exp(1j * np.linspace(0.45 * math.pi, steepest, count))
    path = np.concatenate([radii * rays[0], high * arc, radii[::-1] * rays[1], low * arc[::-1]])
    signs = [np.linalg.slogdet(dynamic_stiffness(balance, part))[0] for part in np.array_split(path, 100)]
    turned = np.angle(np.roll(np.concatenate(signs), -1) / np.concatenate(signs))
    # The path is fine enough to follow the argument.
    assert np.abs(turned).max() < 1.0
    return round(float(turned.sum()) / (2.0 * math.pi))


class TestAgainstTheDeterminant:
    def test_all_modes_are_there(self, rigid):
        """The argument of det Z along a closed path counts the modes inside, whatever finds them."""
        found = modes(rigid)
        low, high, steepest = 2.0 * math.pi * 300.0, 2.0 * math.pi * 3e4, 0.9 * math.pi
        size, angle = np.abs(found.eigenvalues), np.angle(found.eigenvalues)
        inside = (size > low) & (size < high) & (angle > 0.45 * math.pi) & (angle < steepest)
        assert zeros_within(rigid, low, high, steepest) == np.count_nonzero(inside) > 0

    def test_each_mode_makes_the_matrix_singular(self, rigid):
        found = modes(rigid)
        for value in found.eigenvalues[(found.eigenvalues.imag > 0.0) & (found.frequency > 300.0)]:
            matrix = dynamic_stiffness(rigid, np.array([value]))[0]
            scale = 1.0 / np.sqrt(np.abs(np.diag(matrix)))
            scaled = scale[:, None] * matrix * scale
            sizes = np.linalg.svd(scaled, compute_uv=False)
            # First order from the few states: the square of 1e-8, and rounding.
            assert sizes[-1] < 1e-9 * sizes[0]

    def test_sum_over_slices_by_hand(self, rigid):
        for s in (2000j, -4e3 + 2e4j, 3e5j):
            expected = by_hand(rigid, s)
            found = dynamic_stiffness(rigid, np.array([s]))[0]
            # The tables' slopes differ by some 1e-4 between states and loads.
            assert np.abs(found - expected).max() < 1e-3 * np.abs(expected).max()


def zeros_by_contour(balance, middle, radius, points=256, probes=None):
    """Eigenvalues of Z(s) inside a circle, from integrals of Z(s)^-1 along it: nothing of what the program does.

    W.-J. Beyn, Linear Algebra Appl. 436 (2012) 3839-3863. Z is summed from k, c and theta of the slices. The integrals
    by the trapezoidal rule converge with (distance of the nearest other eigenvalue)^-points.
    """
    n = balance.system.size
    rows, times = [], []
    for connected, relaxation in zip(balance.system.elements, balance.relaxations, strict=True):
        if relaxation is not None:
            rows.append(relaxation.rows @ connected.transform)
            times.append(relaxation.times)
    springs, theta = np.concatenate(rows), np.concatenate(times)
    probe = np.eye(n) if probes is None else np.random.default_rng(0).standard_normal((n, probes))
    zeroth = np.zeros((n, probe.shape[1]), dtype=complex)
    first = zeroth.copy()
    for turn in np.exp(2j * math.pi * (np.arange(points) + 0.5) / points):
        s = middle + radius * turn
        more = (springs.T * (-((s * theta) ** 2) / (1.0 + s * theta))) @ springs
        solved = np.linalg.solve(s * s * balance.system.mass + s * balance.damping + balance.stiffness + more, probe)
        zeroth += solved * (radius * turn / points)
        first += solved * (radius * turn * turn / points)
    left, sizes, right = np.linalg.svd(zeroth, full_matrices=False)
    count = int(np.count_nonzero(sizes > 1e-8 * sizes[0]))
    reduced = left[:, :count].conj().T @ first @ right[:count].conj().T / sizes[:count]
    values = middle + radius * np.linalg.eigvals(reduced)
    return np.sort_complex(values[np.abs(values - middle) < radius])


def program_finds(balance, middle, radius):
    """Eigenvalues that the program finds inside a circle."""
    found = modes(balance).eigenvalues
    return np.sort_complex(found[np.abs(found - middle) < radius])


class TestAgainstContourIntegrals:
    """Every mode is found by a second method, at the same complex frequency: frequency and damping to 1e-6 and less.

    What is left are the trapezoidal rule and the first order from the few states of films, each below 1e-7.
    """

    def test_of_the_rigid_shaft(self, rigid):
        middle, radius = (-3e3 + 2.1e4j), 1.45e4
        expected = zeros_by_contour(rigid, middle, radius)
        np.testing.assert_allclose(program_finds(rigid, middle, radius), expected, rtol=1e-6)
        assert expected.size == 4

    def test_of_the_gearbox(self, emap):
        balance = gearbox(emap, 500.0, "memory")
        middle, radius = 2.0 * math.pi * (-150.0 + 3000.0j), 2.0 * math.pi * 1200.0
        expected = zeros_by_contour(balance, middle, radius, 384, 40)
        found = program_finds(balance, middle, radius)
        assert found.size == expected.size > 10
        np.testing.assert_allclose(found, expected, rtol=1e-6)


class TestAgainstSlowFilms:
    def test_films_that_need_no_time_are_slow_films(self, emap):
        """Ten thousand times as quick, films move every mode by what they relax in a period."""
        slow, memory = gearbox(emap, 500.0, "slow"), gearbox(emap, 500.0, "memory")
        expected, found = modes(slow), modes(with_times(memory, 1e-4))
        assert found.lost == ()
        wanted = expected.eigenvalues[expected.eigenvalues.imag > 0.0]
        got = found.eigenvalues[found.eigenvalues.imag > 0.0]
        assert got.size == wanted.size
        # omega theta is at most 1e-3 of what films contribute.
        np.testing.assert_allclose(got, wanted, rtol=1e-3)

    def test_slow_films_have_no_states(self, emap):
        balance = gearbox(emap, 500.0, "slow")
        assert system_film_states(balance) is None
        assert state_space(balance).A.shape == (2 * balance.system.size,) * 2

    def test_the_error_of_slow_films_is_their_difference(self, emap):
        """Along the load at a frequency, and 5 % where it says so; of a map that holds no response of its films."""
        scene = read_scene("gearbox")
        slow = assemble(scene, "map", emap, 30e-6, "slow")
        balance = gearbox(emap, 500.0, "memory")
        entry = dataclasses.replace(film_errors(slow, balance.displacement, balance.operation)[0], contacts=None)
        relaxation, force = balance.relaxations[0], balance.forces[0]
        along = np.array([0.0, *(force[1:3] / np.linalg.norm(force[1:3])), 0.0, 0.0, 0.0])
        s = 2j * math.pi * np.array([3000.0])
        plain = along @ (balance.element_stiffness[0] + s[0] * balance.element_damping[0]) @ along
        more = along @ relaxation.more(s)[0] @ along
        assert entry.error(np.array([3000.0]))[0] == pytest.approx(abs(more) / abs(plain + more), rel=1e-9)
        # The grid in which the frequency is looked for has steps of 2.3 %.
        below, above = entry.error(entry.frequency * np.array([0.977, 1.0]))
        assert below <= 0.05 < above


class TestResponses:
    def test_state_space_has_the_same_response(self, rigid):
        scene = read_scene("nu308_rigid")
        frequencies = np.geomspace(50.0, 2e4, 60)
        space = state_space(rigid, scene.inputs, scene.sensors)
        direct = frequency_response(rigid, scene.inputs, scene.sensors, frequencies)
        unit = np.eye(space.A.shape[0])
        found = np.array(
            [space.C @ np.linalg.solve(2j * math.pi * f * unit - space.A, space.B) + space.D for f in frequencies]
        )
        # Few states for all slices: 1e-8, and some of that more at resonances.
        assert np.all(np.abs(found - direct) <= 1e-7 * np.abs(direct).max(axis=0))

    def test_of_a_sweep(self, emap):
        scene = read_scene("nu308_rigid")
        model = assemble(scene, "map", emap, 20e-6, "memory")
        frequencies = np.array([100.0, 3000.0])
        result = sweep(model.system, np.array([500.0, 600.0]) * RPM, 0.0, scene.inputs, scene.sensors, frequencies)
        balance = equilibrium(model.system, Operation(600.0 * RPM))
        direct = frequency_response(balance, scene.inputs, scene.sensors, frequencies)
        assert 0.0 < result.responses.error[1] <= FILM_TOLERANCE
        # Equilibria from another start, and FILM_TOLERANCE.
        np.testing.assert_allclose(result.responses.values[1], direct, rtol=1e-6)
        own = modes(balance)
        shown = result.damped.eigenvalues[1]
        shown = np.sort_complex(shown[np.isfinite(shown)])
        expected = own.eigenvalues[own.eigenvalues.imag > 0.0]
        assert np.abs(shown[:, None] - expected[None, :]).min(axis=1).max() < 1e-6 * np.abs(expected).max()


class TestLostModes:
    def test_newton_arrives_from_one_per_cent_away(self, rigid):
        found = modes(rigid)
        k = int(np.flatnonzero((found.eigenvalues.imag > 0.0) & (found.frequency > 1000.0))[0])
        value = newton(rigid, complex(found.eigenvalues[k]) * (1.01 - 0.01j), found.shapes[:, k])
        assert value == pytest.approx(complex(found.eigenvalues[k]), rel=1e-7)

    def test_films_that_are_far_off_lose_modes_with_a_reason(self, rigid):
        """States of films ten times as slow are no start: a mode is found where it is near, or it is NaN."""
        slower = with_times(rigid, 10.0)
        states = state_modes(slower, undamped_modes(slower))
        kept = np.flatnonzero(states.oscillates & (np.abs(states.eigenvalues) > 2e3))
        n = rigid.system.size
        films = states.films
        assert isinstance(films, FilmStates)
        own = at_own_frequency(
            rigid, films, states.eigenvalues[kept], states.right[:n, kept], states.left[kept, n : 2 * n]
        )
        assert own.lost
        assert {entry.reason for entry in own.lost} <= set(Reason)
        assert np.count_nonzero(~own.found) == len(own.lost)
        assert np.all(np.isnan(own.eigenvalues[~own.found]))
        true = modes(rigid).eigenvalues
        for value in own.eigenvalues[own.found]:
            assert np.abs(true - value).min() < 1e-6 * abs(value)


ALONG = {
    500.0: ((2536.0, 4.41), (3294.0, 4.19), (3886.0, 3.87)),
    1500.0: ((2467.0, 4.50), (3237.0, 4.35), (3835.0, 4.03)),
    2500.0: ((2423.0, 4.09), (3198.0, 4.10), (3797.0, 3.87)),
}
"""Frequency [Hz] and damping ratio [%] of the modes of the gearbox along the load, by rpm."""


@pytest.mark.parametrize("rpm", ALONG)
def test_modes_of_the_gearbox_along_the_load(emap, rpm):
    balance = gearbox(emap, rpm, "memory")
    found, slow = modes(balance), modes(gearbox(emap, rpm, "slow"))
    bearings = [found.parts.index(balance.system.elements[i].element.name) for i in balance.system.select(RingElement)]
    share = found.shares[bearings].sum(axis=0)
    swinging = (found.eigenvalues.imag > 0.0) & (share > 0.45)
    for frequency, ratio in ALONG[rpm]:
        k = int(np.argmin(np.where(swinging, np.abs(found.frequency - frequency), np.inf)))
        assert found.frequency[k] == pytest.approx(frequency, rel=3e-3)
        assert 100.0 * found.damping_ratio[k] == pytest.approx(ratio, rel=0.1)
        # Slow films damp the same modes more, at 500 rpm about twice as much.
        j = int(np.argmin(np.abs(slow.frequency - frequency) / frequency - slow.shares[bearings].sum(axis=0)))
        assert slow.damping_ratio[j] > (1.9 if rpm == 500.0 else 1.08) * found.damping_ratio[k]
