"""Films of tapered rollers with memory in time: small oscillations, closed paths, lift-off, steps, the cylinder."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.jobs.make.table_law import table_map
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rollers.ribbed_geometry import ribbed_estimate
from ehdmaps.physics.solids import STEEL
from mbs.bearings.locating.film_memory import FORCE, HEAD, STIFFNESS, TIME
from mbs.bearings.locating.locating_block import FELT
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.tapered.line_film import LOADS, line_films
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.model.elements import Operation
from tests.cases.tapered_runs import driven
from tests.unit.test_tapered_films import CYLINDER, WARM, U
from tests.unit.test_tapered_scenes import GEOMETRY

SPEED = 300.0
RIBBED = ribbed_estimate("NUP210", 20e-6, 30e-6)
PLACES = {
    "32208": np.array([30e-6, 12e-6, 5e-6, 0.0, 1e-4, 2e-4]),
    # 10 um beyond the play of its rib
    "NUP210": np.array([RIBBED.ribs(STEEL)[0].play + 10e-6, 25e-6, 5e-6, 0.0, 1e-4, 0.0]),
}
LIGHT = np.array([15e-6, 2e-6, 1e-6, 0.0, 1e-5, 2e-5])


@pytest.fixture(scope="module")
def emap():
    return table_map(CYLINDER, Lubricant.named("FVA3"), LOADS, (0.9 * U, 1.1 * U), (WARM, WARM))


@pytest.fixture(scope="module")
def films(emap):
    return line_films((emap.law("inner", "clamp"), emap.law("outer", "clamp")), 15e-3, U, WARM)


def element(films, geometry, memory="memory", **keys):
    return LocatingElement("x", "a", "b", TaperedForce(geometry, **keys), films=lambda *_: films, memory=memory)


def swept(place, turn, axis, size):
    """A path about a place along an axis."""
    path = np.tile(place, (turn.size, 1))
    path[:, axis] += size * np.sin(turn)
    return path


def response(forces, turn, count, size):
    """Complex stiffness by the last two periods, `count` steps each."""
    last = slice(-2 * count, None)
    return -1j * (forces[last] * np.exp(-1j * turn[last])[:, None]).sum(axis=0) / (count * size)


@pytest.mark.parametrize("name", PLACES)
def test_small_oscillations_are_those_of_linear_analyses(films, name):
    """A nanometre, 3e-8 rad, in 80 steps a period under combined load: what is left is the step, of second order."""
    bearing, place = element(films, RIBBED if name == "NUP210" else GEOMETRY), PLACES[name]
    operation, count = Operation(SPEED), 80
    rest = bearing.evaluate(place, np.zeros(6), operation)
    assert np.all(np.abs(rest.force[FELT]) > 10.0)
    size = np.sqrt(np.diag(rest.stiffness))[FELT]
    relaxation, turn = bearing.relaxation(place, operation), 2.0 * math.pi / count * np.arange(4 * count + 1)
    for hertz, axis, way in ((1e3, 0, 1e-9), (4e3, 1, 1e-9), (12e3, 1, 1e-9), (4e3, 5, 3e-8)):
        column, s = FELT.tolist().index(axis), 2j * math.pi * hertz
        forces, _, _ = driven(bearing, SPEED, swept(place, turn, axis, way), 1.0 / (hertz * count))
        found = response(forces, turn, count, way)
        slow = (rest.stiffness + s * rest.damping)[FELT, axis]
        linear = slow + relaxation.more(np.array([s]))[0][FELT, axis]
        assert np.max(np.abs(found - linear) / size) < 6e-4 * abs(linear[column]) / size[column]
    assert abs(slow[column].imag) > 1.2 * abs(linear[column].imag)


def test_steps_in_python_are_the_same(films):
    """The same laws, springs and balances, 1e-10 of the forces, where rollers lift off and come back."""
    bearing, turn = element(films, GEOMETRY), np.linspace(0.0, 4.0, 12)
    path = swept(LIGHT, turn, 0, -45e-6)
    forces, loads, ours = driven(bearing, SPEED, path, 2e-5)
    assert np.min(np.max(loads, axis=1)) < 5e-3 * np.max(loads)
    _, states = bearing.advance(None, path[0], np.zeros(6), Operation(SPEED))
    for i, place in enumerate(path):
        answer, states = bearing.advance(states, place, np.zeros(6), Operation(SPEED, 0.0, 2e-5 * i))
        np.testing.assert_allclose(forces[i], answer.force[FELT], rtol=0.0, atol=1e-10 * np.abs(forces).max())
    kept = [TIME, HEAD + FORCE, HEAD + STIFFNESS]
    np.testing.assert_allclose(ours.films.memory[:, :, kept], states.films.memory[:, :, kept], rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("name", PLACES)
def test_closed_paths_take_energy(films, name):
    """Up to 20 um within 0.1 to 10 ms, by chance: work of the second round by the trapezoidal rule, whose error at 400
    places is below 1e-5 of what goes to and fro; what is stored is the same at both ends of a round."""
    bearing = element(films, RIBBED if name == "NUP210" else GEOMETRY, slices=7)
    rng, turn, lifted = np.random.default_rng(3), 2.0 * math.pi / 400 * np.arange(801), 0
    for span in 3 * ((-8.0, -6.0), (-5.0, -4.6)):
        size, period = 10.0 ** rng.uniform(*span), 10.0 ** rng.uniform(-4.0, -2.0)
        phases = rng.uniform(0.0, 2.0 * math.pi, (5, 3))
        sizes = rng.normal(size=(5, 3)) * size / np.array([1, 2, 3]) / np.array([1, 1, 1, 0.03, 0.03])[:, None]
        path = np.tile(LIGHT if name == "32208" else PLACES[name], (turn.size, 1))
        path[:, FELT] += np.sum(sizes * np.sin(turn[:, None, None] * np.arange(1, 4) + phases), axis=2)
        forces, loads, _ = driven(bearing, SPEED, path, period / 400)
        work = -0.5 * (forces[401:] + forces[400:-1]) * np.diff(path[400:, FELT], axis=0)
        assert work.sum() > 1e-5 * np.abs(work.sum(axis=1)).sum()
        lifted += loads.max() > 300.0 * loads.min()
    assert lifted > 2


def test_loads_leave_and_come_back_without_a_step(films):
    """A ring that is pulled off its rollers and pressed back: a force of no tension that follows the path, whose error
    halves at least with the step."""
    bearing, found = element(films, GEOMETRY, slices=7), []
    for count in (200, 400, 800, 3200):
        turn = 2.0 * math.pi * np.arange(count + 1) / count
        forces, loads, _ = driven(bearing, SPEED, swept(LIGHT, turn, 0, -40e-6), 2e-3 / count)
        assert np.all(loads >= 0.0) and np.min(np.max(loads, axis=1)) < 5e-3 * np.max(loads)
        assert np.max(np.abs(np.diff(forces[:, 0]))) < 20.0 / count * np.ptp(forces[:, 0])
        found.append(forces[:: count // 200, 0])
    left = [np.max(np.abs(one - found[-1])) for one in found[:-1]]
    assert left[0] < 2e-2 * np.ptp(found[-1]) and left[0] > 1.8 * left[1] > 3.2 * left[2]


def test_steps_of_any_length_end_where_they_should(films):
    """Far longer than theta the films are those of rest, to 1e-9 of the forces; far shorter they are springs, but for
    slices that hardly carry, which relax within a nanosecond: 1e-3 of what moves."""
    bearing, place = element(films, GEOMETRY), PLACES["32208"]
    moved = place + np.array([0.0, 1e-8, 0.0, 0.0, 0.0, 0.0])
    rest = bearing.evaluate(moved, np.zeros(6), Operation(SPEED)).force[FELT]
    before = bearing.evaluate(place, np.zeros(6), Operation(SPEED)).force[FELT]
    forces, _, _ = driven(bearing, SPEED, [place, moved, moved, moved], 0.1)
    np.testing.assert_allclose(forces[-1], rest, rtol=0.0, atol=1e-9 * np.abs(rest).max())
    quick, _, _ = driven(bearing, SPEED, [place, moved], 1e-9)
    quicker, _, _ = driven(bearing, SPEED, [place, moved], 1e-15)
    np.testing.assert_allclose(quick[-1], quicker[-1], rtol=0.0, atol=1e-3 * np.abs(rest - before).max())
    assert abs((quicker[-1] - before)[1]) > 1.05 * abs((rest - before)[1])
