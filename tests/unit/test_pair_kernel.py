"""Laws of contacts in C against splines of scipy; springs in series with dampers against their equation in time."""

from __future__ import annotations

import copy
import ctypes
import math
import pickle

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

from ehdmaps.kernel.library import function
from mbs.bearings.balls.ball_memory import FilmsOfBalls
from mbs.bearings.balls.response import SHORTER
from mbs.bearings.locating.normal_law import NormalLaw, contacts_at, empty_table, law_data, load_approach

ROWS, CENTRE, SCALE, FIRST, STEP, HERTZ = 23, -2e-7, 1.3e-7, -4.0, 0.4, 1.1e10
APPROACHES = CENTRE + SCALE * np.sinh(np.linspace(FIRST - 1.5, FIRST + STEP * (ROWS - 1) + 1.5, 401))


def film():
    """A law with a film whose load rises with the approach."""
    node = np.arange(ROWS)
    logs, waves = -17.0 + 0.3 * node + 0.2 * np.sin(node), 6.0 + np.cos(0.7 * node)
    table = np.stack([logs, 0.3 + 0.2 * np.cos(node), waves, -0.7 * np.sin(0.7 * node)], axis=1)
    return NormalLaw(HERTZ, 0.0, 0.0, CENTRE, SCALE, FIRST, STEP, 0.0, 0.0, 0.0, table)


def by_splines(law, approach):
    """Load and damping at one approach, straight in the logarithms beyond the ends of the table."""
    node = np.arange(ROWS)
    place = (math.asinh((approach - law.centre) / law.scale) - law.first) / law.step
    held = min(max(place, 0.0), ROWS - 1.0)
    logs = []
    for column in (0, 2):
        spline = CubicHermiteSpline(node, law.table[:, column], law.table[:, column + 1])
        logs.append(float(spline(held)) + float(spline(held, 1)) * (place - held))
    return law.coefficient * math.exp(logs[0]) ** 1.5, math.exp(logs[1])


def test_a_film_is_the_cubics_of_its_table():
    law = film()
    load, stiffness, damping = contacts_at(law, APPROACHES)
    wanted = np.array([by_splines(law, one) for one in APPROACHES]).T
    np.testing.assert_allclose(load, wanted[0], rtol=1e-12)
    np.testing.assert_allclose(damping, wanted[1], rtol=1e-12)
    step = 1e-6 * (SCALE + np.abs(APPROACHES))
    ahead, back = (contacts_at(law, APPROACHES + way * step)[0] for way in (1.0, -1.0))
    np.testing.assert_allclose(stiffness, (ahead - back) / (2.0 * step), rtol=1e-7)  # of second order


def test_a_dry_contact_has_a_damper_while_it_carries():
    law = NormalLaw(HERTZ, 30.0, 1e-5, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, empty_table())
    load, stiffness, damping = contacts_at(law, np.array([[-1e-6, 0.0], [1e-6, 9e-6]]))
    np.testing.assert_array_equal([load[0], stiffness[0], damping[0]], np.zeros((3, 2)))
    np.testing.assert_allclose(load[1], HERTZ * np.array([1e-9, 27e-9]), rtol=1e-14)
    np.testing.assert_allclose(stiffness[1], 1.5 * HERTZ * np.array([1e-3, 3e-3]), rtol=1e-14)
    np.testing.assert_allclose(damping[1], 30.0 + 1e-5 * stiffness[1], rtol=1e-14)
    assert load_approach(law, HERTZ * 27e-9) == pytest.approx(9e-6, rel=1e-14)


def test_a_load_has_its_approach():
    law = film()
    for approach in np.linspace(CENTRE, APPROACHES[-80], 20).tolist():
        load = by_splines(law, approach)[0]
        assert load_approach(law, load) == pytest.approx(approach, abs=1e-14 * SCALE + 1e-13 * abs(approach))


@pytest.mark.parametrize("made", [copy.deepcopy, lambda data: pickle.loads(pickle.dumps(data))])
def test_laws_are_copied_with_their_tables(made):
    data = law_data(film())
    other = made(data)
    assert other.given("table") is not data.given("table")
    np.testing.assert_array_equal(other.given("table"), film().table)
    assert (other.rows, other.coefficient, other.table[5]) == (ROWS, HERTZ, film().table[1, 1])


@pytest.mark.parametrize("part", [0.0, 1e-9, 1e-3, 0.2499, 0.2501, 3.0, 400.0])
def test_springs_over_a_step_solve_their_equation(part):
    """f' = K v - f/theta of three springs whose end goes evenly, by a method of eighth order."""
    rng, longest, moved = np.random.default_rng(3), 2e-5, 3e-7
    step = part * longest
    springs = np.concatenate([rng.uniform(1e7, 1e8, (1, 2, 3)), np.full((1, 2, 1), longest)], axis=2)
    films = FilmsOfBalls(rng.uniform(-20.0, 20.0, (1, 2, 3)), springs, np.array([[1e-6, -2e-6]]))
    held = films.held(step)
    assert held.shape == (1, 2, 3)
    np.testing.assert_array_equal(held[..., 2], films.approaches)
    for side in range(2):
        k, f, theta = springs[0, side, :3], films.forces[0, side], longest * np.array(SHORTER)
        wanted = f + k * moved
        if step > 0.0:
            ended = solve_ivp(
                lambda _, force, k=k, theta=theta: k * moved / step - force / theta,
                (0.0, min(step, 60.0 * longest)), f, method="DOP853", rtol=1e-12, atol=1e-12,
            )  # fmt: skip
            wanted = ended.y[:, -1]
        assert held[0, side, 0] + held[0, side, 1] * moved == pytest.approx(wanted.sum(), rel=1e-9, abs=1e-9)


def test_forces_fall_with_their_springs_and_do_not_rise_with_them():
    go_on = function("ehd_ball_go_on", ctypes.c_int64, *5 * (ctypes.c_void_p,), result=None)
    spring, after = np.array([4.0, 4.0, 4.0, 1.0]), np.array([2.0, 8.0, 4.0, 3.0])
    passed, force, moved = np.array([[0.5, 1.0]] * 3), np.array([6.0, 6.0, 6.0]), np.array([2.0])
    go_on(1, *(one.ctypes.data for one in (moved, spring, after, passed, force)))
    np.testing.assert_array_equal(force, [2.5, 5.0, 5.0])
    np.testing.assert_array_equal(spring, after)
