"""Tapered roller bearings with memory along a path in compiled code."""

from __future__ import annotations

import numpy as np

from mbs.bearings.balls.answers import FELT
from mbs.bearings.tapered.tapered_block import TaperedBlock, tapered_accept, tapered_answer
from mbs.model.blocks import FOUND, Answers, Member, Moment
from mbs.model.elements import Operation


def driven(element, speed, path, step):
    """Forces (n, 5) in compiled code along a path (n, 6) of even steps from films at rest, loads of the cones (n, Z),
    and the states at the end."""
    _, states = element.advance(None, path[0], np.zeros(6), Operation(speed))
    block = TaperedBlock([Member(element, 0, 0)])
    block.begin(np.array([speed]))
    block.resume([states])
    arrays, sound = block.prepare(0, 1)
    assert sound[0]
    forces, loads = np.empty((len(path), 5)), np.empty((len(path), arrays.counts[0]))
    for i, place in enumerate(path):
        found = Answers(forces[i], np.zeros((5, 5)), np.zeros(1, dtype=np.int64))
        moment = Moment(0, step * i, speed, 0.0, 1.0, 0.0)
        assert tapered_answer(arrays, moment, np.array([place[FELT], np.zeros(5)]), found) == FOUND
        tapered_accept(arrays, moment)
        loads[i] = arrays.rows[0, : arrays.counts[0], 3]
    return forces, loads, block.states()[0]
