"""Unknowns of a machine whose values are hidden: found again from noisy responses, with bands that hold."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import mbs
from ehdmaps.errors import InputError
from mbs.identification import certainty as certainty_module
from mbs.identification.certainty import APART, certainty, covariance
from mbs.identification.explained import DAMPER, FILMS, damper
from mbs.identification.measured import MeasuredModes
from mbs.identification.planning import information_of, plan
from mbs.identification.search import jacobian_at, search
from mbs.linearised.linear import sensor_matrix
from mbs.linearised.modes import modes
from mbs.scene.changes import with_loads
from tests.cases.identify_twins import BALLS, RPM, balls, rollers

LINES = np.arange(40.0, 1800.0, 16.0)
SPEEDS = 3000.0, 6000.0


@pytest.fixture(scope="module")
def twin():
    """The electric drive at one cage angle."""
    return balls(angles=1)


@pytest.fixture(scope="module")
def fit(twin):
    """The fit of its responses at two speeds, from random starts."""
    question = twin.question(twin.responses(SPEEDS, LINES, np.random.default_rng(5)))
    return search(question, starts=6, kept=3, seed=2)


def test_hidden_values_are_found_from_far_starts(twin, fit) -> None:
    """Preload to 3 %, clearance to 0.5 and 1 um, temperature to 2 K: what noise of 2 % leaves is a third of that."""
    assert fit.agreed == 3
    assert fit.chi2 == pytest.approx(1.0, abs=0.15)  # 880 values: a deviation of 0.05
    off = {one.name: abs(value - BALLS[one.name]) for one, value in zip(twin.free, fit.values, strict=True)}
    assert off["preload.force"] < 0.03 * BALLS["preload.force"]
    assert off["drive.clearance"] < 0.5e-6 and off["end.clearance"] < 1e-6
    assert off["temperature"] < 2.0


def test_the_whole_band_holds_where_loads_are_wrong(twin) -> None:
    other = dataclasses.replace(twin, scene=with_loads(twin.scene, 1.05))
    question = twin.question(other.responses(SPEEDS, LINES, np.random.default_rng(8)))
    found = search(question, starts=0, kept=1)
    sure = certainty(found)
    off = twin.truth - question.coordinates(found.parts)
    assert np.all((off <= sure.rise) & (-off <= sure.fall))
    assert "loads" in [one.name for one in sure.trials]


@pytest.mark.parametrize(("law", "named"), [("", FILMS), ("hertz:1.25e-05 s", DAMPER)])
def test_the_law_that_damps_is_named(twin, fit, law, named) -> None:
    if law:
        other = dataclasses.replace(twin, law=law)
        question = twin.question(other.responses(SPEEDS, LINES, np.random.default_rng(5)))
        fit = search(question, starts=2, kept=1)
    assert damper(fit).explained_by == named


def test_frequencies_of_one_speed_tell_nothing_apart(twin) -> None:
    """At one speed clearance, preload and temperature do the same to frequencies; three speeds tell them apart."""
    near = np.array([190.0, 450.0, 1070.0])
    closest = []
    for speeds in ([6000.0], [1500.0, 3000.0, 6000.0]):
        question = twin.question(twin.modes(speeds, near, np.random.default_rng(3)))
        _, jacobian = jacobian_at(question, (twin.truth - question.low) / question.width)
        deviation, correlation = covariance(jacobian, question.width)
        np.fill_diagonal(correlation, 0.0)
        closest.append((np.abs(correlation).max(), deviation))
    assert closest[0][0] > APART
    assert np.all(closest[1][1] < closest[0][1])


def test_a_plan_goes_on_until_all_is_told_apart(twin) -> None:
    scene = twin.machine.model.scene
    speeds = [0.0, 1500.0 * RPM, *(speed * RPM for speed in SPEEDS)]
    channels = information_of(twin.machine, scene, twin.free, speeds, LINES)
    steps = plan(twin.free, channels)
    sizes = np.array([step.deviation for step in steps])
    assert abs(steps[-1].closest[2]) < APART
    assert np.all(np.diff(sizes, axis=0) < 0.0)  # whatever is measured more, all is known better


def test_without_measurements_there_is_nothing_to_find() -> None:
    with pytest.raises(InputError, match="nothing measured"):
        mbs.identify(mbs.read_scene("electric_drive"), [], ["clearance"])


def test_modes_are_paired_by_their_shapes_where_these_are_measured() -> None:
    """Two bending modes, 30 % apart, whose shapes differ: by frequencies alone they keep their order, by shapes not."""
    twin = rollers(angles=1)
    scene, speed = twin.scene, 4000.0 * RPM
    balance = twin.machine.balance(scene, speed)
    found = modes(balance, errors=False)
    pair = np.flatnonzero((found.frequency > 200.0) & (found.damping_ratio < 0.5))[2:4]
    own = found.frequency[pair]
    seen = (sensor_matrix(balance, scene.sensors) @ found.shapes[:, pair]).T
    sizes = np.linalg.norm(seen, axis=1)
    assert own[1] < 1.3 * own[0] and abs(np.vdot(seen[0], seen[1])) < 0.1 * sizes[0] * sizes[1]
    none = np.full(2, np.nan)
    bare = MeasuredModes("twin", speed, own, 0.01 * own, none, none)
    exchanged = dataclasses.replace(bare, shapes=seen[::-1], sensors=scene.sensors)
    assert twin.machine.modes(scene, bare)[0] == pytest.approx(own, rel=1e-6)
    assert twin.machine.modes(scene, exchanged)[0] == pytest.approx(own[::-1], rel=1e-6)


@pytest.mark.parametrize(("after", "tried"), [(0, 0), (2, 2)])
def test_what_is_found_is_kept_where_the_trials_are_stopped(twin, fit, monkeypatch, after, tried) -> None:
    """Ctrl-C in the trials of assumptions: the values, their noise, and the trials that were made."""
    true, calls = certainty_module._tried, []

    def stopping(*arguments):
        calls.append(1)
        if len(calls) > after:
            raise KeyboardInterrupt
        return true(*arguments)

    monkeypatch.setattr(certainty_module, "_tried", stopping)
    sure = certainty(fit)
    assert sure.stopped and "stopped before" in sure.lost[-1]
    assert len(sure.trials) <= tried and np.all(np.isfinite(sure.deviation))


def test_the_best_so_far_is_kept_where_the_search_is_stopped(twin) -> None:
    """Ctrl-C after the first of the refined starts."""
    question = twin.question(twin.responses(SPEEDS[1:], LINES[::2], np.random.default_rng(5)))

    def stop(done: int, total: int) -> None:
        if done == total - 1:  # within the second refinement
            raise KeyboardInterrupt

    found = search(question, starts=1, kept=2, progress=stop)
    assert found.stopped and len(found.costs) == 1
