"""Ball bearings with memory along a path in compiled code."""

from __future__ import annotations

import math

import numpy as np

from mbs.bearings.balls.ball_block import BALLS, BallBlock
from mbs.bearings.locating.locating_block import FELT
from mbs.model.blocks import FOUND, Member, Moment
from mbs.model.elements import Operation
from tests.cases.c_blocks import AskedBlock


def driven(element, speed, path, step):
    """Forces (n, 5) in compiled code along a path (n, 6) of even steps from films at rest, and least inner loads."""
    _, states = element.advance(None, path[0], np.zeros(6), Operation(speed))
    block = BallBlock([Member(element, 0, 0)])
    block.begin(np.array([speed]))
    block.resume([states])
    data, sound = block.prepare(0, 1)
    assert sound[0]
    asked, rows = AskedBlock(BALLS, data, 5), data.given("rows")[0, : element.force.geometry.balls]
    forces, least = np.empty((len(path), 5)), math.inf
    for i, place in enumerate(path):
        moment = Moment(0, step * i, speed, 0.0, 1.0, 0.0)
        assert asked.answer(moment, [place[FELT], np.zeros(5)]) == FOUND
        asked.accept(moment)
        forces[i] = asked.found.force
        least = min(least, float(rows[:, 10].min()))
    return forces, least
