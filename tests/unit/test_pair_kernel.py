"""Laws of contacts in C against splines of scipy; springs in series with dampers against their equation in time."""

from __future__ import annotations

import copy
import ctypes
import math
import pickle

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.interpolate import CubicHermiteSpline

from ehdmaps.kernel.library import function
from mbs.bearings.balls.ball_data import COLUMNS
from mbs.bearings.balls.response import SHORTER
from mbs.bearings.locating.film_memory import (
    AT,
    EACH,
    FORCE,
    HEAD,
    LEFT,
    OVER,
    PULL,
    SPRING,
    STIFFNESS,
    TIME,
    FilmsInTime,
    Springs,
    no_memory,
)  # fmt: skip
from mbs.bearings.locating.normal_law import LawData, NormalLaw, contacts_at, energies, law_data, load_approach

ROWS, CENTRE, SCALE, FIRST, STEP, HERTZ = 23, -2e-7, 1.3e-7, -4.0, 0.4, 1.1e10
APPROACHES = CENTRE + SCALE * np.sinh(np.linspace(FIRST - 1.5, FIRST + STEP * (ROWS - 1) + 1.5, 401))


def film():
    """A law with a film whose load rises with the approach."""
    node = np.arange(ROWS)
    logs, waves = -17.0 + 0.3 * node + 0.2 * np.sin(node), 6.0 + np.cos(0.7 * node)
    table = np.stack([logs, 0.3 + 0.2 * np.cos(node), waves, -0.7 * np.sin(0.7 * node)], axis=1)
    return NormalLaw(HERTZ, 0.0, 0.0, CENTRE, SCALE, FIRST, STEP, table)


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
    law = NormalLaw(HERTZ, 30.0, 1e-5, 0.0, 1.0, 0.0, 1.0)
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
    memory = no_memory((1, 2, 1), 3)
    k, f = memory[0, :, HEAD + STIFFNESS :: EACH, 0], memory[0, :, HEAD + FORCE :: EACH, 0]
    k[:], f[:], memory[:, :, AT, 0], memory[:, :, TIME] = (
        rng.uniform(1e7, 1e8, (2, 3)), rng.uniform(-20.0, 20.0, (2, 3)), [[1e-6, -2e-6]], longest
    )  # fmt: skip
    held = FilmsInTime(memory).held(step, SHORTER)[..., 0]
    np.testing.assert_array_equal(held[..., AT], memory[:, :, AT, 0])
    for side in range(2):
        theta = longest * np.array(SHORTER)
        wanted = f[side] + k[side] * moved
        if step > 0.0:
            ended = solve_ivp(
                lambda _, force, k=k[side], theta=theta: k * moved / step - force / theta,
                (0.0, min(step, 60.0 * longest)), f[side], method="DOP853", rtol=1e-12, atol=1e-12,
            )  # fmt: skip
            wanted = ended.y[:, -1]
        assert held[0, side, PULL] + held[0, side, SPRING] * moved == pytest.approx(wanted.sum(), rel=1e-9, abs=1e-9)


def test_energies_are_the_integrals_of_loads():
    """Against adaptive quadrature over the approach, within the table and beyond both ends: to what that asks, 1e-9."""
    law, begin = film(), CENTRE - 5.0 * SCALE * math.sinh(-FIRST)
    ends = APPROACHES[::50]
    asked = {"epsabs": 0.0, "epsrel": 1e-10, "limit": 200}
    wanted = [
        quad(lambda at: contacts_at(law, np.array([at]))[0, 0], begin, end, points=[CENTRE], **asked)[0] for end in ends
    ]
    found = energies(law, ends) - energies(law, np.array([begin]))
    np.testing.assert_allclose(found, wanted, rtol=1e-7, atol=1e-9 * max(wanted))
    # dry points and lines, F = C g^(3/2) and C g^(10/9)
    for exponent in (1.5, 10.0 / 9.0):
        whole = quad(lambda g, exponent=exponent: HERTZ * g**exponent, 0.0, 3e-6, **asked)[0]
        assert energies(NormalLaw(HERTZ), np.array([3e-6, -1e-6]), exponent) == pytest.approx([whole, 0.0], rel=1e-9)


def moved_on(place, after, memory):
    """Memory of the contacts of a ball at a place on their tables, where springs and times are `after` at all rows."""
    law, rows = film(), np.tile(after, (ROWS, 1))
    springs = Springs(
        count=3, shorter=np.array(SHORTER), **dict.fromkeys(("inner", "outer", "inner_other", "outer_other"), rows)
    )
    ball, both = np.zeros(COLUMNS), (LawData * 2)(law_data(law), law_data(law))
    ball[14:16] = CENTRE + SCALE * math.sinh(place)
    go_on = function("ehd_ball_go_on", ctypes.c_int64, *4 * (ctypes.c_void_p,), result=None)
    go_on(1, ctypes.addressof(both), springs.address, ball.ctypes.data, memory.ctypes.data)
    return ball[14]


def test_forces_fall_with_their_springs_and_do_not_rise_with_them():
    """A ball that moved by 2 m from films of which half of each force is left, and a spring of 1 N/m."""
    memory, place = no_memory((1, 2, 1), 3), FIRST + 2.5 * STEP
    memory[0, :, HEAD + STIFFNESS :: EACH], memory[0, :, HEAD + FORCE :: EACH] = 4.0, 6.0
    memory[0, :, HEAD + LEFT :: EACH], memory[0, :, HEAD + OVER :: EACH] = 0.5, 1.0
    memory[0, :, AT] = CENTRE + SCALE * math.sinh(place) - 2.0
    approach = moved_on(place, [2.0, 8.0, 4.0, 3.0], memory)
    for side in range(2):
        np.testing.assert_allclose(memory[0, side, HEAD + FORCE :: EACH, 0], [2.5, 5.0, 5.0], rtol=1e-12)
        np.testing.assert_array_equal(memory[0, side, HEAD + STIFFNESS :: EACH, 0], [2.0, 8.0, 4.0])
    np.testing.assert_array_equal(memory[0, :, TIME], 3.0)
    np.testing.assert_array_equal(memory[0, :, AT], approach)


@pytest.mark.parametrize(("place", "row"), [(FIRST - 0.5 * STEP, 0), (FIRST + (ROWS - 0.5) * STEP, ROWS - 1)])
def test_beyond_a_table_springs_stay_and_times_follow_the_damping(place, row):
    """Half a row beyond the end, so that their sum K theta is the damping of slow motion, which goes on straight."""
    memory, law = no_memory((1, 2, 1), 3), film()
    approach = moved_on(place, [2.0, 8.0, 4.0, 3.0], memory)
    damping = contacts_at(law, np.array([approach]))[2, 0]
    np.testing.assert_allclose(memory[0, :, TIME], 3.0 * damping / np.exp(law.table[row, 2]), rtol=1e-9)
    np.testing.assert_array_equal(memory[0, 0, HEAD + STIFFNESS :: EACH, 0], [2.0, 8.0, 4.0])
