"""Tapered roller bearings with memory along a path in compiled code."""

from __future__ import annotations

import numpy as np

from mbs.bearings.locating.locating_block import FELT
from mbs.bearings.tapered.tapered_block import TAPERED, TaperedBlock
from mbs.model.blocks import FOUND, Member, Moment
from mbs.model.elements import Operation
from tests.cases.c_blocks import AskedBlock


def driven(element, speed, path, step):
    """Forces (n, 5) in compiled code along a path (n, 6) of even steps from films at rest, loads of the cones (n, Z),
    and the states at the end."""
    _, states = element.advance(None, path[0], np.zeros(6), Operation(speed))
    block = TaperedBlock([Member(element, 0, 0)])
    block.begin(np.array([speed]))
    block.resume([states])
    data, sound = block.prepare(0, 1)
    assert sound[0]
    asked, rows = AskedBlock(TAPERED, data, 5), data.given("rollers")[0]
    forces, loads = np.empty((len(path), 5)), np.empty((len(path), rows.shape[0]))
    for i, place in enumerate(path):
        moment = Moment(0, step * i, speed, 0.0, 1.0, 0.0)
        assert asked.answer(moment, [place[FELT], np.zeros(5)]) == FOUND
        asked.accept(moment)
        forces[i], loads[i] = asked.found.force, rows[:, 3]
    return forces, loads, block.states()[0]
