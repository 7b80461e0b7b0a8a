"""Films of balls with memory in time: small oscillations against linear analyses, closed paths, lift-off, rest."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbs import assemble, read_scene
from mbs.bearings.locating.locating_block import FELT
from mbs.bearings.locating.normal_law import contacts_at
from mbs.model.elements import Operation
from tests.cases.ball_runs import driven

RPM = math.pi / 30.0
PLACE = np.array([95e-6, -3e-6, 1e-6, 0.0, 2e-5, -4e-5])


@pytest.fixture(scope="module")
def element():
    return assemble(read_scene("electric_drive"), "table").balls[0]


def test_closed_paths_take_energy_and_balls_lift_off(element):
    """Up to 10 um within 0.1 to 10 ms: work of the second round by the trapezoidal rule, whose error at 400 places is
    below 1e-5 of what goes to and fro."""
    rng, turn = np.random.default_rng(3), 2.0 * math.pi / 400 * np.arange(801)
    lifted = 0
    for _ in range(6):
        size, period = 10.0 ** rng.uniform(-8, -5), 10.0 ** rng.uniform(-4, -2)
        phases = rng.uniform(0.0, 2.0 * math.pi, (5, 3))
        sizes = rng.normal(size=(5, 3)) * size / np.array([1, 2, 3]) / np.array([1, 1, 1, 0.02, 0.02])[:, None]
        path = np.tile([60e-6, 0.0, 0.0, 0.0, 0.0, 0.0], (turn.size, 1))
        path[:, FELT] += np.sum(sizes * np.sin(turn[:, None, None] * np.arange(1, 4) + phases), axis=2)
        forces, least = driven(element, 600.0 * RPM, path, period / 400)
        work = -0.5 * (forces[401:] + forces[400:-1]) * np.diff(path[400:, FELT], axis=0)
        assert work.sum() > 1e-5 * np.abs(work.sum(axis=1)).sum()
        lifted += least < 0.1
    assert lifted > 2


def test_loads_leave_without_a_step(element):
    """A contact that is pulled keeps a load above zero, with an exact slope on both sides of where pulling begins."""
    law = element.law_at(600.0 * RPM).inner

    def contact(approach):
        return contacts_at(law, np.array([approach]), held=(20.0, 3e7, 2e-6)).ravel().tolist()

    begins = 2e-6 - 20.0 / 3e7
    for approach in (*np.linspace(-3e-6, 6e-6, 19), begins):
        load, slope, damping = contact(approach)
        ahead, back = (contact(approach + way * 1e-12)[0] for way in (1.0, -1.0))
        assert load > 0.0 and damping == 0.0
        # round-off of a load in steps of a picometre
        assert slope == pytest.approx((ahead - back) / 2e-12, rel=1e-3, abs=1e-15 * load / 1e-12)
    assert contact(-3e-6)[0] < 0.1


def test_rings_at_rest_are_dry(element):
    dry = assemble(read_scene("electric_drive"), "hertz").balls[0]
    forces, _ = driven(element, 0.0, [PLACE, PLACE + 1e-7, PLACE], 1e-5)
    for force, place in zip(forces, (PLACE, PLACE + 1e-7, PLACE), strict=True):
        theirs = dry.evaluate(place, np.zeros(6), Operation()).force[FELT]
        np.testing.assert_allclose(force, theirs, rtol=1e-9, atol=1e-9 * np.abs(theirs).max())


def test_steps_in_python_are_the_same(element):
    """Both end in the balance of the same balls, to some 1e-9 where it is stiff across them; compiled springs are read
    between rows of a table, 1e-4 of them."""
    path, step, speed = PLACE + np.array([0.0, 1e-7, 3e-7, -2e-7])[:, None] * np.eye(6)[1], 1e-5, 6000.0 * RPM
    forces, _ = driven(element, speed, path, step)
    states, rest = None, element.evaluate(path[-1], np.zeros(6), Operation(speed)).force[FELT]
    for i, place in enumerate(path):
        answer, states = element.advance(states, place, np.zeros(6), Operation(speed, 0.0, step * i))
        if i == 0:
            answer, states = element.advance(states, place, np.zeros(6), Operation(speed, 0.0, 0.0))
    moved = np.abs(answer.force[FELT] - rest).max()
    assert moved > 1e-4 * np.abs(rest).max()
    np.testing.assert_allclose(forces[-1], answer.force[FELT], atol=2e-4 * moved + 1e-9 * np.abs(rest).max())
