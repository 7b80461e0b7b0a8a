"""Bearing forces while speed, temperature and centrifugal load change: the cells that are made are those of a table."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from ehdmaps.errors import InputError, OutsideMapError
from mbs.bearings import cylinder as table
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.cylinder import GROWING, WHOLE, Arrays, LawRoom, functions
from tests.cases.bearings import bearing, map_law

POSE = np.array([0.0, 7e-6, 9e-6, 0.0, 1e-4, -2e-4])
VELOCITY = np.array([0.0, 2e-4, -3e-4, 0.0, 1e-2, 2e-2])
CENTRIFUGAL = (0.0, 50.0, 3e3)

ITERATION = 1e-11
"""Of rollers between their contacts: where an iteration starts shows in the last digits, near lift-off in some more."""


def element(slices=21, outside="clamp"):
    return BearingForce(bearing(slices=slices), map_law(outside))


def assert_alike(found, expected, tolerance):
    for got, wanted in zip(found, expected, strict=True):
        size = np.sqrt(np.outer(np.diag(wanted), np.diag(wanted))) if wanted.ndim == 2 else np.max(np.abs(wanted))
        assert np.all(np.abs(got - wanted) <= tolerance * size)


@pytest.mark.parametrize("slices", [20, 41])
def test_changing_conditions_give_what_a_whole_table_gives(slices):
    force, random = element(slices=slices), np.random.default_rng(3)
    for u, T, q in itertools.product((0.3, -1.3, 2.0), (305.0, 330.0), CENTRIFUGAL):
        whole = force.at(u, T, q)
        for scale in (1.0, 1.0, 0.4, -2.0):  # the second call misses no cells, the others do
            pose, angle = scale * POSE, random.uniform(0.0, 6.0)
            found = force(pose, VELOCITY, cage_angle=angle, entrainment_speed=u, temperature=T, centrifugal_load=q)
            assert_alike(found, whole(pose, VELOCITY, angle), ITERATION if q else 0.0)


def test_through_the_lowest_speed_and_back():
    force = element()
    for u in (1.0, 0.1, 0.0, 0.1, 1.0):  # whole, faded, dry
        found = force(POSE, VELOCITY, entrainment_speed=u, temperature=330.0)
        assert_alike(found, force.at(u, 330.0)(POSE, VELOCITY), 0.0)


@pytest.mark.parametrize("q", CENTRIFUGAL)
def test_cells_are_the_same_in_any_order(q):
    """Those that slices of random poses need are made one by one; the others are not."""
    force, at = element(), (1.0, 330.0, q)
    whole, parts = LawRoom(), Arrays(force.bearing)
    data = force.flat_law.data(force.law, q > 0.0)
    assert whole.prepare(data, at, WHOLE) == 0 and parts.prepare(data, at, GROWING) == 0
    np.testing.assert_array_equal(parts.numbers, whole.numbers)
    cells = parts.array("cells")
    cells[:] = np.nan
    random, made = np.random.default_rng(5), 0
    for n in range(40):
        parts.state[1:3], parts.state[4:6] = random.normal(0.0, 2e-5, 2), random.normal(0.0, 2e-3, 2)
        functions().force(parts.call.address)
        before, made = made, np.sum(np.isfinite(cells[:, 0, 0]))
        assert made > 0 and made >= before and (n > 0 or made < 400)
    known = np.isfinite(cells[:, 0, 0])
    assert 0.1 < np.mean(known) < 0.9
    np.testing.assert_array_equal(cells[known], whole.array("cells")[known])
    assert np.all(np.isnan(cells[~known]))


@pytest.mark.parametrize("q", CENTRIFUGAL)
def test_cells_are_those_of_the_law(q):
    """Values and slopes at the ends of cells are those of the law at rest, up to the load at which it is held."""
    force, at = element(), (1.0, 330.0, q)
    room, point = LawRoom(), force.law.at(*at)
    assert room.prepare(force.flat_law.data(force.law, q > 0.0), at, WHOLE) == 0
    numbers, cells = table.LawNumbers(*room.numbers), room.array("cells")
    # the ends of cells above the centre, each 1/32 of its doubling wide
    ends = np.concatenate([2.0**k * (1.0 + np.arange(32) / 32.0) for k in range(14)]) - 1.0
    approach = numbers.centre + ends / numbers.inverse_scale
    below = approach < numbers.held_approach
    load, slope, damping = (part[below] for part in point(approach, np.zeros_like(approach)))
    found = cells[: table.ROWS][below]
    assert load.max() > 0.5 * numbers.held_load
    np.testing.assert_allclose(found[:, 0, 0], load, rtol=1e-9)
    np.testing.assert_allclose(found[:, 1, 0] * numbers.inverse_scale, slope, rtol=1e-9)
    np.testing.assert_allclose(found[:, 0, 1], damping, rtol=1e-9)


@pytest.mark.parametrize("q", [1e-3, 50.0, 3e3])
def test_rollers_between_their_contacts_carry_what_both_contacts_do(q):
    at = map_law().at(1.0, 330.0, q)
    loads = np.geomspace(1e-2, 0.9e6, 120)
    delta = np.array([at.approach(load) for load in loads])
    assert not np.any(at(at.point.lift_off - np.array([1e-6, 0.0]), 0.0)[:2])
    states = np.array(at(delta, 0.0))
    np.testing.assert_allclose(states[0], loads, rtol=ITERATION)  # of both iterations
    # the slope of the load, and that of the damping by a rate, against central differences of the second order
    step, rate = 1e-5 / at.point.inner.inverse_scale, 1e-5
    low, high = (np.array(at(delta + sign * step, 0.0)) for sign in (-1.0, 1.0))
    by_rate = (np.array(at(delta, rate))[1] - np.array(at(delta, -rate))[1]) / (2.0 * rate)
    for slope, k in ((states[1], 0), (by_rate, 2)):
        wanted = (high[k] - low[k]) / (2.0 * step)
        np.testing.assert_allclose(slope, wanted, rtol=1e-5, atol=1e-6 * np.max(np.abs(slope)))


def test_what_is_wrong_is_said_and_leaves_no_trace():
    force, at = element(outside="error"), {"entrainment_speed": 1.0, "temperature": 330.0}
    with pytest.raises(InputError, match="pose: got"):
        force([0.0, np.nan, 0.0, 0.0, 0.0, 0.0], **at)
    with pytest.raises(InputError, match="allowed: within"):
        force([0.0, 1.0, 0.0, 0.0, 0.0, 0.0], **at)
    expected = force.at(1.0, 330.0)(POSE, VELOCITY)
    assert_alike(force(POSE, VELOCITY, **at), expected, 0.0)
    for outside in ({"entrainment_speed": 50.0}, {"temperature": 500.0}):
        with pytest.raises(OutsideMapError):
            force(POSE, VELOCITY, **(at | outside))
    with pytest.raises(OutsideMapError, match="load: got about"):
        force([0.0, 2e-4, 0.0, 0.0, 0.0, 0.0], **at)
    assert_alike(force(POSE, VELOCITY, **at), expected, 0.0)


def test_outside_a_map_that_is_clamped_each_call_says_so():
    force = element()
    for u, outside in ((1.0, False), (50.0, True), (1.0, False)):
        assert force.evaluate(POSE, entrainment_speed=u, temperature=330.0).outside is outside
