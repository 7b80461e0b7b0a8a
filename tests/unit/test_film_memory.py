"""Films with memory against the law that they rest on, their own linearisation, difference quotients and energy."""

from __future__ import annotations

import dataclasses
import functools
import math
import pickle

import numpy as np
import pytest
from scipy.optimize import brentq

from ehdmaps.errors import InputError, OutsideMapError
from ehdmaps.maps.kernels.memory import FilmState
from ehdmaps.maps.kernels.memory_table import equilibrium_at
from ehdmaps.maps.law import ContactLaw
from tests.cases import memory_text
from tests.cases.c_functions import approach_at, rate_of
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD, ValleyField

WARM = 330.0
SPEED = 1.2


@functools.cache
def law(kind="series", outside="clamp"):
    contacts = CONTACTS if kind == "series" else [c for c in CONTACTS if c.name == kind]
    return ContactLaw(kind, contacts, OIL, SMALL_FIELD, outside)


def approach_of(at, load):
    """Approach at which a law carries a load at rest."""
    return brentq(lambda delta: at(delta, 0.0)[0] - load, at.memory.table.lift_off, 1e-4, xtol=1e-17)


def course(memory, h, deltas, second_order):
    """Loads over a course of slices that start in equilibrium; deltas (steps, ...)."""
    state = memory.settled(deltas[0])
    loads = [state.load]
    for delta in deltas[1:]:
        before = state if second_order else dataclasses.replace(state, step=0.0)
        w, _, state = memory.advance(before, delta, h)
        loads.append(w)
    return np.array(loads)


@pytest.mark.parametrize("kind", ["series", "outer"])
@pytest.mark.parametrize("speed", [0.0, 0.1, SPEED, -3.0])
def test_at_rest_it_is_the_law_of_the_map(kind, speed):
    at = law(kind).at(speed, WARM)
    low = at.memory.table.lift_off
    deltas = np.concatenate((np.linspace(low - 1e-5, low + 1e-6, 5), np.linspace(-2e-5, 3e-5, 31)))
    state = at.memory.settled(deltas)
    w, tangent, after = at.memory.advance(state, deltas, 1e-5)
    rest, k, _ = at(deltas, 0.0)
    # The table's cubics, of some 1e-6 of the load; below the map the film fades, where the cells are coarse.
    assert w == pytest.approx(rest, rel=1e-6 if abs(speed) > 0.3 or speed == 0.0 else 1e-4, abs=1e-3)
    assert np.all(tangent >= 0.99 * k * (w > 1.0))
    # Cubics of a and y that do not quite add up: found 3e-12 m, 1e-7 of the approach.
    assert after.approach == pytest.approx(state.approach, abs=5e-12)


@pytest.mark.parametrize("load", [2e3, 1e4, 1e5])
def test_low_frequency_gives_stiffness_and_damping_of_the_map(load):
    at = law().at(SPEED, WARM)
    delta = approach_of(at, load)
    _, k, c = at(delta, 0.0)
    _, dp, _, dy, _, _ = equilibrium_at(at.memory.table, delta)
    theta = c / (dp / (1.0 - dy) - k)
    omega = 0.02 / max(theta, c / k)
    z = response(at, delta, omega / (2.0 * math.pi), 1e-4 * load / k)
    # Both are met to second order in omega c/k and omega theta (0.02) and in the step (1/200 of a period).
    assert z.real == pytest.approx(k, rel=1e-3)
    assert z.imag == pytest.approx(omega * c, rel=2e-3)


def response(at, delta, frequency, amplitude, steps=200):
    """Complex stiffness in time, of the fourth period of a small sine."""
    h = 1.0 / (steps * frequency)
    times = h * np.arange(4 * steps + 1)
    deltas = delta + amplitude * np.sin(2.0 * math.pi * frequency * times)
    loads = course(at.memory, h, deltas, True)
    last = slice(3 * steps + 1, None)
    turn = np.exp(-2j * math.pi * frequency * times[last])
    return 2j * np.mean((loads[last] - loads[0]) * turn) / amplitude


@pytest.mark.parametrize("load", [2e3, 1e4, 1e5])
@pytest.mark.parametrize("ratio", [0.3, 3.0, 30.0])
def test_response_is_a_damper_with_a_spring_in_series(load, ratio):
    at = law().at(SPEED, WARM)
    delta = approach_of(at, load)
    _, k, c = at(delta, 0.0)
    p, dp, _, dy, _, _ = equilibrium_at(at.memory.table, delta)
    locked = dp / (1.0 - dy)
    theta = c / (locked - k)
    omega = ratio / theta
    wanted = k + 1j * omega * c / (1.0 + 1j * omega * theta)
    found = response(at, delta, omega / (2.0 * math.pi), 1e-5 * load / k)
    # Two hundred steps a period: (omega h)^2/3 of the damper's part, and the table's slopes.
    assert abs(found - wanted) < 2e-3 * abs(wanted)
    assert 1.0 / approach_at(at.memory.table, p)[1] == pytest.approx(locked, rel=1e-3)


@pytest.mark.parametrize("kind", ["series", "inner"])
def test_tangent_is_exact_and_load_rises_without_jumps(kind):
    at = law(kind).at(SPEED, WARM)
    start = np.repeat(np.linspace(-3e-5, 2e-5, 11), 2)
    state = at.memory.settled(start)
    _, _, state = at.memory.advance(state, start + 2e-7, 1e-5)
    moves = np.linspace(-5e-6, 5e-6, 4001)
    loads, tangents = np.empty((moves.size, start.size)), np.empty((moves.size, start.size))
    for i, move in enumerate(moves):
        loads[i], tangents[i], _ = at.memory.advance(state, start + move, 1e-5)
    assert np.all(loads >= 0.0)
    assert np.all(np.diff(loads, axis=0) >= 0.0)
    quotient = np.diff(loads, axis=0) / np.diff(moves)[:, None]
    middle = 0.5 * (tangents[1:] + tangents[:-1])
    # The trapezium of a C1 function, over 2.5 nm: largest where the film of a light slice is squeezed at once.
    assert np.max(np.abs(quotient - middle) / np.max(tangents, axis=0)) < 5e-3


def swings(random, times, amplitude):
    """Approaches of a course of six waves that ends where it begins."""
    phases = random.uniform(0.0, 2.0 * math.pi, (6, 1))
    waves = np.sin(2.0 * math.pi * np.arange(1, 7)[:, None] * times + phases) - np.sin(phases)
    deltas = random.uniform(-3e-5, 1.5e-5) + amplitude * random.normal(size=6) @ waves
    deltas[-1] = deltas[0]
    return deltas


def test_no_course_gives_work():
    """Backward differences that give way at turning points take up energy in any step, as large as it may be."""
    random = np.random.default_rng(7)
    times = np.linspace(0.0, 1.0, 81)
    least = math.inf
    for speed in (0.35, SPEED, 3.0):
        memory = law().at(speed, WARM).memory
        deltas = np.array([swings(random, times, 10.0**power) for power in (-8, -7, -6, -5) for _ in range(60)]).T
        for second_order in (True, False):
            loads, moved = course(memory, 1e-5, deltas, second_order), np.diff(deltas, axis=0)
            work = np.sum(loads[1:] * moved, axis=0) / np.sum(loads[1:] * np.abs(moved), axis=0)
            least = min(least, np.min(work))
    # The table's cubics stand for functions that fit each other: their mismatch is some 1e-8 of the work.
    assert least > -1e-8


def test_plain_second_order_differences_would_give_work():
    """The control: without giving way at turning points there are courses that give work."""
    memory = ContactLaw("series", CONTACTS, OIL, ValleyField(), "clamp").at(0.06, 313.15).memory
    random, cells = np.random.default_rng(3), memory_text.Cells(memory.table)
    times = np.linspace(0.0, 1.0, 81)
    deltas = np.array([swings(random, times, 1e-4) for _ in range(60)]).T
    limited = np.sum(course(memory, 1e-6, deltas, True)[1:] * np.diff(deltas, axis=0), axis=0)
    plain = []
    for way in deltas.T[np.argsort(limited)[:12]]:
        xi, g, last, work = way[0], cells.equilibrium(way[0])[4], 0.0, 0.0
        for i in range(1, way.size):
            # 3/2 G' h = G - (4 G1 - G2)/3 as a backward Euler step of two thirds
            w, _, xi = cells.advanced(1e-6 / 1.5, 0.0, way[i], g + last / 3.0, 0.0, xi)
            now = cells.equilibrium(xi)[4]
            g, last = now, now - g
            work += w * (way[i] - way[i - 1])
        plain.append(work)
    assert min(plain) < 0.0 < min(limited)


def test_steps_are_of_second_order():
    memory = law().at(SPEED, WARM).memory
    period = 1e-3

    def loads(steps):
        times = np.linspace(0.0, period, steps + 1)
        deltas = 1e-6 + 2e-6 * np.sin(2.0 * math.pi * times / period) ** 2
        return course(memory, period / steps, deltas, True)

    coarse, fine, finest = loads(100), loads(200), loads(3200)
    errors = [np.mean(np.abs(found[::n] - finest[::32])) for found, n in ((coarse, 1), (fine, 2))]
    # Second order but for a few steps at the turning points, which are of first order.
    assert 2.8 < errors[0] / errors[1] < 6.0


@pytest.mark.parametrize("ratio", [0.4, 0.8, 1.0, 1.19])
def test_rate_has_the_sign_of_the_change_and_rises_with_it(ratio):
    for last in (-2.0, 0.0, 1e-3, 3.0):
        changes = np.linspace(-5.0, 5.0, 20001)
        rates, slopes = rate_of(ratio, 1.0, changes, last)
        assert np.all(rates * changes >= 0.0)
        assert np.all(slopes > 0.0)
        quotient = np.diff(rates) / np.diff(changes)
        # The mean of the slopes at the ends of 5e-4, where the slope's own slope is up to 2e4 (the small last change).
        bound = 1e-2 if abs(last) > 0.1 or last == 0.0 else 2.0
        assert quotient == pytest.approx(0.5 * (slopes[1:] + slopes[:-1]), abs=bound)


def test_growing_steps_are_taken_by_backward_euler():
    assert rate_of(2.0, 1.0, 3.0, 2.0) == rate_of(2.0, 0.0, 3.0, 2.0) == (1.5, 0.5)
    # Differences of second order: 3/2 of a change, less half of one that was alike.
    assert rate_of(1.0, 1.0, 2.0, 2.0)[0] == pytest.approx(2.0)


def test_a_table_is_read_and_goes_on_as_its_text_in_python():
    """The same equations as a scalar text; both solve each step to 1e-13."""
    at, random = law().at(SPEED, WARM), np.random.default_rng(2)
    table, cells = at.memory.table, memory_text.Cells(at.memory.table)
    approaches = random.uniform(-4e-5, 4e-5, 200)
    read = np.array(equilibrium_at(table, approaches))
    alike(read, np.array([cells.equilibrium(xi) for xi in approaches]).T, 1e-12)
    loads = 10.0 ** random.uniform(-3.0, 6.0, 200)
    alike(np.array(approach_at(table, loads)), np.array([cells.stretch(load) for load in loads]).T, 1e-12)
    for h, last_h in ((1e-5, 0.0), (1e-5, 1e-5), (2e-5, 1e-5), (3e-6, 1e-5)):
        change = random.normal(size=200) * 10.0 ** random.uniform(-3.0, 2.0, 200)
        ends = approaches + random.uniform(-3e-6, 3e-6, 200)
        begin = FilmState(np.maximum(approaches, table.lift_off), change, np.zeros(200), last_h)
        w, tangent, end = at.memory.advance(begin, ends, h)
        text = [
            cells.advanced(h, last_h, delta, cells.equilibrium(xi)[4], last, xi)
            for delta, last, xi in zip(ends, change, begin.approach, strict=True)
        ]
        alike(np.array([w, tangent, end.approach]), np.array(text).T, 1e-9)


def alike(found, wanted, within):
    """Rows are the same within a part of the largest of each."""
    assert np.max(np.abs(found - wanted) / np.max(np.abs(wanted), axis=1, keepdims=True)) < within


def test_a_table_can_be_pickled():
    at = law().at(SPEED, WARM)
    again = pickle.loads(pickle.dumps(at.memory.table))
    assert equilibrium_at(again, 1e-6) == equilibrium_at(at.memory.table, 1e-6)


def test_separation_and_contact_again():
    at = law().at(SPEED, WARM)
    low = at.memory.table.lift_off
    state = at.memory.settled(1e-6)
    loads = []
    for delta in (1e-6, low - 1e-5, low - 1e-5, low + 1e-6, 1e-6):
        w, tangent, state = at.memory.advance(state, delta, 1e-4)
        loads.append(w)
        assert tangent >= 0.0
    assert max(loads[1:3]) < 1e-3
    assert loads[4] > at(1e-6, 0.0)[0]  # pressed together quickly: the film is still thick


def test_a_step_can_be_tried_again():
    memory = law().at(SPEED, WARM).memory
    state = memory.settled(np.array([1e-6, 2e-6]))
    first = memory.advance(state, np.array([2e-6, 3e-6]), 1e-5)
    memory.advance(state, np.array([5e-6, 9e-6]), 1e-3)
    again = memory.advance(state, np.array([2e-6, 3e-6]), 1e-5)
    assert np.array_equal(first[0], again[0])


def test_the_law_takes_speed_and_temperature_at_each_call():
    w, tangent, state = law().advance(None, 1e-6, 1e-5, SPEED, WARM)
    assert isinstance(w, float)
    assert w == pytest.approx(law()(1e-6, 0.0, SPEED, WARM)[0], rel=1e-6)
    assert tangent > 0.0
    faster, _, _ = law().advance(state, 1e-6, 1e-5, 1.01 * SPEED, WARM)
    assert faster != w


def test_what_is_refused():
    at = law("series", "error").at(SPEED, WARM)
    memory = at.memory
    state = memory.settled([0.0, 1e-6])
    with pytest.raises(InputError, match=r"film memory, delta: got the shape \(3,\); the state has \(2,\)"):
        memory.advance(state, [0.0, 0.0, 0.0], 1e-5)
    with pytest.raises(InputError, match=r"film memory, delta: got nan; allowed: finite numbers"):
        memory.advance(state, [0.0, math.nan], 1e-5)
    with pytest.raises(InputError, match=r"film memory, delta: got 'a'; allowed: real numbers"):
        memory.settled("a")
    for dt in (0.0, -1e-5, math.inf, math.nan, "1"):
        with pytest.raises(InputError, match=r"film memory, dt: got .* allowed: finite and > 0 s"):
            memory.advance(state, [0.0, 0.0], dt)
    with pytest.raises(InputError, match=r"film memory, centrifugal_load: got 5 N/m; allowed: 0"):
        _ = law().at(SPEED, WARM, 5.0).memory
    calls = law("series", "error").outside_counts["load"]
    with pytest.raises(OutsideMapError, match=r"film memory, load: got .* above the map, which ends at 1e\+06 N/m"):
        memory.advance(state, [0.0, 1e-4], 1e-5)
    assert law("series", "error").outside_counts["load"] == calls + 1


def test_a_dry_map_has_no_memory():
    dry = ContactLaw("series", CONTACTS, OIL, ValleyField(dry=True), "clamp")
    at = dry.at(SPEED, WARM)
    state = at.memory.settled(1e-6)
    assert isinstance(state, FilmState)
    w, tangent, _ = at.memory.advance(state, 5e-6, 1e-6)
    rest, k, _ = at(5e-6, 0.0)
    assert w == pytest.approx(rest, rel=1e-6)
    assert tangent == pytest.approx(k, rel=1e-5)


def test_a_dry_slice_that_comes_into_contact_has_the_load_at_rest():
    # Without a film y rises by rounding alone at lift-off, which sent Newton's first step beyond the table.
    at = law().at(0.0, WARM)
    apart = at.memory.settled(np.array([-1e-6, 0.0, -1e-6]))
    deltas = np.array([1.3e-8, 7e-8, 1e-5])
    w, _, after = at.memory.advance(apart, deltas, 1e-5)
    rest = at(deltas, 0.0)[0]
    # Cubics of the table in the cells next to lift-off.
    assert w == pytest.approx(rest, rel=1e-3)
    assert after.approach == pytest.approx(deltas, rel=1e-3)


class TestEnergy:
    @pytest.mark.parametrize("speed", [0.1, SPEED])
    def test_work_is_stored_or_taken_up(self, speed):
        memory, gone = law().at(speed, WARM).memory, []
        middle, swing = approach_of(law().at(speed, WARM), 2e5), 2e-6
        for steps in (200, 400):
            # A rest, because cubics of a and y do not quite add up to the approach of a settled state.
            state = memory.advance(memory.settled(np.array([middle])), np.array([middle]), 1e3)[2]
            first, last, work, spent = memory.stored(state)[0], state.load[0], 0.0, 0.0
            before = middle
            for i in range(steps):
                delta = middle + swing * math.sin(2.0 * math.pi * (i + 1.0) / steps)
                w, _, after = memory.advance(state, np.array([delta]), 1e-3 / steps)
                work += 0.5 * (last + w[0]) * (delta - before)
                spent += memory.spent(state, after)[0]
                state, last, before = after, w[0], delta
            assert spent > 0.0
            gone.append(abs(work - spent - memory.stored(state)[0] + first) / spent)
        # The trapezoidal rule, of second order.
        assert gone[1] < 0.3 * gone[0] < 0.01

    def test_stored_is_the_integral_of_the_load_for_slow_motion(self):
        at = law().at(SPEED, WARM)
        deltas = np.linspace(approach_of(at, 1e4), approach_of(at, 3e5), 2001)
        loads, stored = at(deltas, 0.0)[0], at.memory.stored(at.memory.settled(deltas[[0, -1]]))
        # Cubics of a and y that do not quite add up to the approach.
        assert stored[1] - stored[0] == pytest.approx(np.trapezoid(loads, deltas), rel=1e-5)
