"""Bearings whose rings cannot tilt: runs compute one slice of each depth and no tilts, with the same results."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.laws import hertz
from mbs.bearings.memory_block import MemoryBlock
from mbs.bearings.rings import LEVEL, feels, folding_of, placed
from mbs.bearings.speed_tables import SpeedWindow
from mbs.model.blocks import Member
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient import run_elements
from mbs.transient.run import run
from tests.cases.bearings import TEMPERATURE, map_law

LOAD = np.array([0.0, 900.0, 200.0, 0.0, 0.0, 0.0])
SPEED = 150.0


def system(law=None, profile="iso", freedoms=("y", "z"), memory=False):
    """A shaft on a bearing, which a load that jumps excites."""
    bearing = Bearing.named("NU308", clearance=5e-6, profile=profile, slices=9)
    force = BearingForce(bearing, law or hertz(bearing, 100.0))
    films = "memory" if memory else "slow"
    element = BearingElement("bearing", "shaft", "ground", bearing, force, TEMPERATURE, films=films)
    body = rigid_body("shaft", [Inertia(2.0, 0.01, 0.02)], freedoms, spin=1.0)
    return System([body], loads=[Load("weight", "shaft", LOAD)], elements=[element])


def recorded(given, share, duration=2e-3):
    """A run from an equilibrium at a share of the load."""
    less = System(given.bodies, loads=[Load("weight", "shaft", share * LOAD)], elements=[
        entry.element for entry in given.elements
    ])  # fmt: skip
    start = equilibrium(less, Operation(SPEED)).displacement
    settings = Settings(step=5e-6, sample=5e-5)
    return run(given, SpeedProfile.ramp(SPEED, 1.02 * SPEED, duration), duration, settings, displacement=start)


def both(given, monkeypatch, share=0.5):
    """The run as it is, and with all slices and tilts."""
    used = recorded(given, share)
    monkeypatch.setattr(run_elements, "_placed", lambda entry: entry)
    return used, recorded(given, share)


@pytest.mark.parametrize("profile", ["iso", "straight"])
@pytest.mark.parametrize("law", [None, map_law])
def test_runs_are_those_with_all_slices_to_round_off(law, profile, monkeypatch):
    used, whole = both(system(law() if law else None, profile), monkeypatch)
    assert used.compiled == used.steps
    for one, other in ((used.forces[0], whole.forces[0]), (used.motions[0], whole.motions[0])):
        # Newton's steps end below 1e-9 of the largest force; sums in another order end elsewhere there
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-8 * np.max(np.abs(other)))
    assert np.ptp(used.forces[0][:, 1]) > 100.0


def test_films_with_memory_agree_as_well_as_their_parabolas(monkeypatch):
    used, whole = both(system(map_law(), memory=True), monkeypatch, share=0.95)
    assert used.compiled == used.steps
    # slices take their parabolas anew in turn, other slices in other turns: 1e-5 of the force, as beside Python
    np.testing.assert_allclose(used.forces[0], whole.forces[0], rtol=0.0, atol=1e-4 * np.max(np.abs(whole.forces[0])))


def test_films_come_back_for_all_slices():
    given = system(map_law(), memory=True).elements[0]
    level = placed(given.element, given.transform)
    block = MemoryBlock([Member(level, 0, 0)])
    _, states = given.element.advance(None, np.array([0.0, 1e-5, 3e-6, 0.0, 0.0, 0.0]), np.zeros(6), Operation(SPEED))
    block.resume([states])
    (back,) = block.states()
    # slices left and right of the middle are solved apart, to round-off; a change is a difference of two larger numbers
    for name, close in (("approach", 1e-12), ("change", 1e-8), ("load", 1e-12)):
        one, other = getattr(back.films[0], name), getattr(states.films[0], name)
        np.testing.assert_allclose(one, other, rtol=0.0, atol=close * np.max(np.abs(other)))


def test_only_rings_that_cannot_tilt_are_level():
    for freedoms, profile, level in (
        (("y", "z"), "iso", True),
        (("y", "z", "theta_y", "theta_z"), "iso", False),
        (("y", "z", "theta_z"), "iso", False),
        # moments of a profile that is not the same on both sides are recorded
        (("y", "z"), np.linspace(0.0, 1e-6, 9), False),
    ):
        entry = system(profile=profile, freedoms=freedoms).elements[0]
        element = placed(entry.element, entry.transform)
        assert element.tilts is not level
        assert feels(element).shape == (LEVEL if level else 4, 6)
        assert folding_of(element).weights.sum() == 9.0
    for profile, count in (("iso", 5), ("straight", 1)):
        element = dataclasses.replace(system(profile=profile).elements[0].element, tilts=False)
        assert folding_of(element).firsts.size == count


@pytest.mark.parametrize("memory", [False, True])
def test_a_speed_that_does_not_change_has_one_table(memory, monkeypatch):
    made = []
    hold = SpeedWindow._hold

    def counted(window, slot, key, speed):
        made.extend([slot] if window._held[slot] != key else [])
        hold(window, slot, key, speed)

    monkeypatch.setattr(SpeedWindow, "_hold", counted)
    given = system(map_law(), memory=memory)
    start = equilibrium(given, Operation(SPEED)).displacement
    steps = run(given, SpeedProfile.constant(SPEED), 2e-3, Settings(5e-6, 5e-5), displacement=start).compiled
    assert steps == 400
    assert len(made) == 1
