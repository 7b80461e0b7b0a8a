"""`ehdmaps export --to c`: films with memory are those of Python, step by step and as a differential equation."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ehdmaps.exports.c.kernel import locked_table
from ehdmaps.jobs.cli import main
from ehdmaps.maps.emap import open_map
from ehdmaps.maps.kernels.locked_film import FORMULA
from ehdmaps.maps.kernels.memory import FilmMemory
from ehdmaps.maps.kernels.tables import COLDEST
from ehdmaps.maps.law import ContactLaw
from mbs import Bearing, BearingForce
from tests.cases.c_kernel import Kernel, compiled
from tests.cases.jobs import LINE
from tests.conftest import made_map

EXACT = 1e-9
"""Rounding, as a part of the load and of the lowest mapped one. A short step after a long one magnifies that of a
state, 1e-13 of its place, by the film's damping over its length."""

ABOVE_SPEED, NOT_FINITE, BAD_ARGUMENT = 2, 8, 64


def kernel_of(path, folder, *options):
    """The library of an export that holds at the edges of the map."""
    assert main(["export", str(path), "--to", "c", "-o", str(folder), "--outside", "clamp", *options]) == 0
    return Kernel(compiled(folder, "-shared", "-fPIC"))


@pytest.fixture(scope="module")
def kernel(reynolds_map, tmp_path_factory):
    """The library of a map that knows how films oscillate."""
    return kernel_of(reynolds_map, tmp_path_factory.mktemp("film") / "c")


@pytest.fixture(scope="module")
def law(reynolds_map):
    return open_map(reynolds_map).law("series", "clamp")


@pytest.fixture(scope="module")
def table(law):
    return locked_table(law)


def memory_of(law, table, u, T):
    """The law with memory of Python with the factors of the export."""
    return FilmMemory(law.at(u, T).point, law.contacts, u, table.at(u, T), lambda loads: None)


def conditions(law):
    """Speeds from standstill to above the map, and temperatures on both sides of it."""
    (slow, fast), (cold, hot) = law.speed_range, law.temperature_range
    speeds = np.array([0.0, 0.02, 0.4, 1.0, -2.0]) * slow, np.array([0.9, 1.2]) * fast
    temperatures = cold, hot, cold, 0.5 * (cold + hot), 0.7 * cold + 0.3 * hot, hot, hot + 5.0
    return list(zip(np.concatenate(speeds).tolist(), temperatures, strict=True))


def assert_steps(kernel, memory, lowest, rng, size):
    """Two hundred steps of any length over approaches of a size, from far apart to far together."""
    start = memory.table.lift_off + abs(rng.normal()) * 1e-5
    state, (_, held) = memory.settled(start), kernel.film_settled(start)
    for n in range(200):
        delta, step = start + size * (math.sin(0.2 * n) + 0.2 * rng.normal()), 10.0 ** rng.uniform(-7.0, -3.0)
        w, tangent, after = memory.advance(state, delta, step)
        status, found, held = kernel.film_advance(held, delta, step, state.step)
        assert status & (NOT_FINITE | BAD_ARGUMENT) == 0
        assert abs(found[0] - w) <= EXACT * (w + lowest)
        if w > 1e-9 * lowest:  # hardly a load has a stiffness of rounding
            # where the rate of squeezing turns, stiffness changes faster than the load
            assert abs(found[1] - tangent) <= 10.0 * EXACT * tangent * (1.0 + lowest / w)
        state = after


def test_steps(kernel, law, table):
    """Loads and stiffness at the end of each step are those of `FilmMemory.advance`."""
    rng = np.random.default_rng(4)
    for u, T in conditions(law):
        kernel.film_at(u, T)
        for size in (1e-7, 5e-6, 1e-4):
            assert_steps(kernel, memory_of(law, table, u, T), law.load_range[0], rng, size)


def test_factors(law, table):
    """At the places of the table the factors are those of the map; between them a quick step is right within 2e-3.

    That is the error of going straight between the places; the law itself is right within 5 % at high frequency.
    """
    assert table.factors.size > 1
    u, T = math.exp(table.speeds.places[3]), 1.0 / table.temperatures.places[-1] + COLDEST
    exact, held = law.locked_factors(u, T), table.at(u, T)
    at = held.lowest + np.arange(held.values.size) / held.per_log
    wanted = np.interp(at, exact.lowest + np.arange(exact.values.size) / exact.per_log, exact.values)
    np.testing.assert_allclose(held.values, wanted, rtol=1e-5)  # six digits are written
    rng, delta = np.random.default_rng(0), np.linspace(1e-6, 3e-5, 50)
    (slow, fast), (cold, hot) = law.speed_range, law.temperature_range
    for _ in range(10):
        u, T = math.exp(rng.uniform(math.log(slow), math.log(fast))), rng.uniform(cold, hot)
        memories = memory_of(law, table, u, T), law.at(u, T).memory
        quick = [memory.advance(memory.settled(delta), 1.02 * delta, 1e-6) for memory in memories]
        loaded = memories[1].settled(delta).load > law.load_range[0]
        assert np.max(np.abs(quick[0][1] / quick[1][1] - 1.0)[loaded]) < 2e-3


@pytest.mark.slow
def test_formula(small_map, tmp_path):
    """A map that knows nothing of films that oscillate has the closed formula as it stands."""
    law = open_map(small_map).law("series", "clamp")
    table = locked_table(law)
    assert law.locked_factors(1.0, 310.0) is FORMULA
    np.testing.assert_array_equal(table.factors, np.ones((1, 1, 1)))
    kernel, rng = kernel_of(small_map, tmp_path / "c"), np.random.default_rng(1)
    kernel.film_at(1.0, 310.0)
    assert_steps(kernel, memory_of(law, table, 1.0, 310.0), law.load_range[0], rng, 5e-6)


def test_bare_contact(tmp_path):
    """The law of a half-space of one contact."""
    path = made_map(tmp_path, LINE)
    law = open_map(path).law("line", "clamp")
    kernel, T = kernel_of(path, tmp_path / "c", "--law", "line"), law.temperature_range[0]
    kernel.film_at(1.0, T)
    memory = memory_of(law, locked_table(law), 1.0, T)
    assert_steps(kernel, memory, law.load_range[0], np.random.default_rng(1), 5e-6)


def test_rates(kernel, law):
    """The differential equation follows the same films as the steps, through contact, opening and coming together.

    Both errors are those of integration: steps of 1/2000 of a period, and a tolerance of 1e-6 of the solver.
    """
    for (u, T), middle, size, frequency in zip(
        conditions(law)[1:6], (2e-5, 8e-6, 3e-6, 2e-6, 3e-6), (1e-6, 6e-6, 6e-6, 2e-5, 6e-6),
        (1e4, 500.0, 5000.0, 300.0, 500.0), strict=True,
    ):  # fmt: skip
        kernel.film_at(u, T)

        def moved(time, middle=middle, size=size, frequency=frequency):
            return middle + size * math.sin(2.0 * math.pi * frequency * time)

        steps, period = 2000, 1.0 / frequency
        _, state = kernel.film_settled(middle)
        begin, last, loads = state[0], 0.0, [state[2]]
        for n in range(1, steps + 1):
            _, found, state = kernel.film_advance(state, moved(n * period / steps), period / steps, last)
            last = period / steps
            loads.append(found[0])
        solved = solve_ivp(
            lambda time, x: [kernel.film_rate(moved(time), x[0])[1][3]], (0.0, period), [begin], method="BDF",
            jac=lambda time, x: [[kernel.film_rate(moved(time), x[0])[1][5]]],
            t_eval=np.linspace(0.0, period, steps + 1), rtol=1e-6, atol=1e-13, max_step=0.05 * period,
        )  # fmt: skip
        assert solved.success
        found = [kernel.film_rate(moved(time), x)[1][0] for time, x in zip(solved.t, solved.y[0], strict=True)]
        assert np.max(np.abs(np.array(found) - loads)) < 2e-3 * np.ptp(loads)


def test_rates_derivatives(kernel, law):
    """All four derivatives are difference quotients; those at a bend of a cubic are left to the other steps.

    The quotients are right within 1e-4 of the largest derivative of their kind; cells end at few of the points.
    """
    rng, wrong = np.random.default_rng(5), 0
    for u, T in conditions(law)[1:]:
        kernel.film_at(u, T)
        for _ in range(50):
            delta = rng.uniform(-2e-6, 2e-5)
            state, step = delta + rng.normal() * 10.0 ** rng.uniform(-9.0, -5.5), 1e-12
            found = kernel.film_rate(delta, state)[1]
            by_delta, by_state = (
                (kernel.film_rate(delta + a, state + b)[1] - kernel.film_rate(delta - a, state - b)[1]) / (2.0 * step)
                for a, b in ((step, 0.0), (0.0, step))
            )
            pairs = np.array([by_delta[[0, 3]], by_state[[0, 3]]]).T
            exact = found[[1, 2, 4, 5]].reshape(2, 2)
            wrong += np.any(
                np.abs(pairs - exact) > 1e-3 * np.abs(exact) + 1e-4 * np.max(np.abs(exact), axis=1)[:, None]
            )
    assert wrong <= 3


def test_bearing(kernel, law, table, reynolds_map, monkeypatch):
    """Forces of steps are those of `BearingForce.advance`; films in equilibrium stay there, with the static force."""
    monkeypatch.setattr(ContactLaw, "locked_factors", lambda _, u, T: table.at(u, T))
    slices, cage, rng = 9, 0.3, np.random.default_rng(6)
    geometry = dataclasses.replace(open_map(reynolds_map).bearing, diametral_clearance=10e-6)
    force = BearingForce(Bearing(geometry, slices=slices), law)
    kernel.make(10e-6, slices)
    units = np.array([1.0, 1.0, 1.0, 100.0, 100.0, 100.0])
    for u, T in conditions(law)[1:6:2]:
        assert kernel.film_at(u, T) == 0
        pose = 1e-5 * rng.normal(size=6) * units
        status, held = kernel.settled(pose, cage, geometry.rollers * slices)
        at = force.at(u, T)(pose, cage_angle=cage)[0]
        status, found, rates = kernel.rates(pose, cage, held[:, 0])
        assert status == 0
        np.testing.assert_allclose(found[0], at, rtol=1e-5, atol=1e-5 * np.max(np.abs(at)))  # cells of the film's table
        # of motions of up to 10 mm/s; a film that fades below the map hardly damps what its cells leave of the load
        assert np.max(np.abs(rates[:, 3])) < (1e-6 if abs(u) >= law.plain_table.lowest_speed else 0.1)
        _, state = force.advance(None, pose, 1e-5, cage_angle=cage, entrainment_speed=u, temperature=T)
        for n in range(10):
            moved = pose + 3e-6 * rng.normal(size=6) * units
            given = dict(cage_angle=cage + 1e-3 * n, entrainment_speed=u, temperature=T)
            wanted, state = force.advance(state, moved, 1e-5, **given)
            status, found, held = kernel.advance(held, moved, cage + 1e-3 * n, 1e-5, 1e-5)
            assert (status != 0) == wanted.outside
            np.testing.assert_allclose(found[0], wanted.force, rtol=0.0, atol=1e-9 * np.max(np.abs(wanted.force)))
            np.testing.assert_allclose(
                found[1:], wanted.stiffness, rtol=0.0, atol=1e-9 * np.max(np.abs(wanted.stiffness))
            )


@pytest.mark.slow
def test_refused(small_map, tmp_path):
    """Outside the map, numbers that are none, and steps of no length have a status and give NaN."""
    assert main(["export", str(small_map), "--to", "c", "-o", str(tmp_path / "c")]) == 0
    kernel = Kernel(compiled(tmp_path / "c", "-shared", "-fPIC"))
    assert kernel.film_rate(1e-6, 1e-6)[0] == BAD_ARGUMENT  # no film yet
    assert kernel.film_at(1e3, 310.0) == ABOVE_SPEED
    for status, values in (kernel.film_rate(1e-6, 1e-6), kernel.film_settled(1e-6)):
        assert status == ABOVE_SPEED
        assert np.all(np.isnan(values))
    assert kernel.film_at(1.0, 310.0) == 0
    _, state = kernel.film_settled(1e-6)
    for status, values in (
        (NOT_FINITE, kernel.film_advance(state, np.nan, 1e-5, 0.0)),
        (NOT_FINITE, kernel.film_advance(np.full(3, np.inf), 1e-6, 1e-5, 0.0)),
        (BAD_ARGUMENT, kernel.film_advance(state, 1e-6, 0.0, 0.0)),
        (1, kernel.film_advance(state, 1e-3, 1e-5, 0.0)),
    ):
        assert values[0] == status
        assert np.all(np.isnan(values[1])) and np.all(np.isnan(values[2]))
