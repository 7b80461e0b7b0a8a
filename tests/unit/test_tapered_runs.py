"""Tapered roller bearings in runs in time: compiled code against the element in Python, and their work."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.physics.rollers.tapered_catalogue import mirrored
from mbs.bearings.locating.locating_block import FELT
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_block import TAPERED, TaperedBlock
from mbs.model.blocks import FOUND, IN_PYTHON, Member, Moment
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import run
from tests.cases.c_blocks import AskedBlock
from tests.unit.test_tapered_scenes import GEOMETRY, O_PAIR, model

PLACE = np.array([12e-6, -6e-6, 3e-6, 0.0, 5e-5, -8e-5])
RATE = np.array([1e-3, -2e-3, 1e-3, 0.0, 0.1, 0.2])
ELEMENTS = [
    LocatingElement("loaded", "a", "b", TaperedForce(GEOMETRY, 3.0, 1e-5), start_angle=0.2, axial_offset=5e-6),
    LocatingElement("parted", "a", "b", TaperedForce(mirrored(GEOMETRY), 0.0, 1e-5), inner_spin=-0.5, outer_spin=0.2),
    LocatingElement("other", "a", "b", TaperedForce(GEOMETRY, slices=5, profile="straight"), outer_spin=0.4),
]


@pytest.mark.parametrize("speed", [0.0, 900.0, -900.0])
def test_compiled_block_is_the_element(speed):
    """Three bearings at once, one with half of its rollers loaded: the same kernel and the same balance, to 1e-13 of
    the forces on a roller; two steps, so that works of speed are there."""
    block = TaperedBlock([Member(one, place, 5 * place) for place, one in enumerate(ELEMENTS)])
    states = [one.advance(None, 0.9 * PLACE, 0.0 * RATE, Operation(speed))[1] for one in ELEMENTS]
    block.begin(np.array([speed]))
    block.resume(states)
    data, sound = block.prepare(0, 1)
    assert np.all(sound)
    asked = AskedBlock(TAPERED, data, 15, 3)
    found = asked.found
    moment = Moment(0, 1e-5, speed, 0.3, 1.0, 1e3)
    motion = np.array([np.tile(PLACE[FELT], 3), np.tile(RATE[FELT], 3)])
    assert asked.answer(moment, motion) == FOUND
    asked.accept(moment)
    powers = asked.powers(moment, motion)
    for place, one in enumerate(ELEMENTS):
        theirs, after = one.advance(states[place], PLACE, RATE, Operation(speed, 0.3, 1e-5))
        part = slice(5 * place, 5 * place + 5)
        slopes = (theirs.stiffness + 1e3 * theirs.damping)[np.ix_(FELT, FELT)]
        np.testing.assert_allclose(found.force[part], theirs.force[FELT], atol=1e-10 * np.abs(theirs.force).max())
        np.testing.assert_allclose(found.slopes[part, part], slopes, atol=1e-9 * np.abs(slopes).max())
        ours = block.states()[place]
        told, stored = (after.dissipated, after.driven), one.stored(after, PLACE, Operation(speed))
        assert (ours.dissipated, ours.driven) == pytest.approx(told, rel=1e-8, abs=1e-12)
        assert one.stored(ours, PLACE, Operation(speed)) == pytest.approx(stored, rel=1e-8, abs=1e-12)
        assert powers[place, :2] == pytest.approx(told, rel=1e-8, abs=1e-12)
        held = one.loads(PLACE, Operation(speed, 0.3)).load[1] > 1e-6  # others lie anywhere
        np.testing.assert_allclose(ours.last[held], after.last[held], rtol=1e-8, atol=1e-17)
    loads = ELEMENTS[1].force.loads(PLACE).load[0]
    assert 2 < np.count_nonzero(loads) < loads.size
    far = motion.copy()
    far[0, 0] = -2e-3
    assert asked.answer(moment, far) == IN_PYTHON
    assert asked.answer(moment._replace(speed=3e4), motion) == IN_PYTHON


def swung(pair, way, law="hertz:1.25e-5 s"):
    """A preloaded rotor pushed 30 um along its axis, beyond its preload of 15 um, and 2 um aside, and let go."""
    machine = model(law, **pair)
    rest = equilibrium(machine.system, machine.operation)
    start = rest.displacement.copy()
    for name, push in (("rotor.x", way * 30e-6), ("rotor.y", 2e-6)):
        start[machine.system.coordinates.index(name)] += push
    return machine, start


@pytest.mark.slow
def test_energy_of_a_run_closes():
    """Rows lift off and come back: the residual is the trapezoidal rule's, of second order: a fourth of the step leaves
    a sixteenth."""
    machine, start = swung(O_PAIR, -1.0)
    left = []
    for steps in (1000, 4000):
        settings = Settings(step=0.01 / steps, sample=1e-4)
        done = run(machine.system, SpeedProfile.ramp(300.0, 900.0, 0.01), 0.01, settings, displacement=start)
        assert done.compiled == done.steps and all(one.told for one in done.energy.elements)
        assert min(one.dissipated for one in done.energy.elements) > 0.0
        left.append(abs(done.energy.relative_residual))
    assert left[1] < 5e-4
    assert left[0] > 8.0 * left[1]
