"""Ball bearings in compiled runs, by `ehdmaps/kernel/c/ball/ball_block.c`."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from ehdmaps.kernel.record import numbers
from mbs.bearings.balls.ball_data import COLUMNS, START, BallShape
from mbs.bearings.balls.ball_speed import Drive
from mbs.bearings.balls.laws import NODES
from mbs.bearings.locating.locating_block import LocatingBlock, PairBlock, kind_of


class Balls(PairBlock):
    """Ball bearings as C takes them, see `PairBlock`.

    Attributes
    ----------
    spins : array (count, 2)
        Speeds of the rings by that of the system.
    lengths, drives : array (count, 7), (count, 7)
        `BallShape` and `Drive` in their order, at rest.
    cosine, sine : array (count, longest)
        Directions of the balls in the cage.
    ways : array (count, longest, 4)
        `BallForce.rows`.
    centres, rows : array (count, longest, START), (count, longest, COLUMNS)
        Starts of the balls, and what is known of each, at the last answer, see `mbs.bearings.balls.ball_data`.
    rests : array (count,)
        Approach at the outer raceway under the centrifugal load alone [m].
    """

    _fields_ = tuple(
        (name, numbers) for name in ("spins", "lengths", "drives", "cosine", "sine", "ways", "centres", "rows", "rests")
    )
    shapes: ClassVar = {
        **PairBlock.shapes,
        "spins": ("count", 2),
        "lengths": ("count", len(BallShape._fields)),
        "drives": ("count", len(Drive._fields)),
        **dict.fromkeys(("cosine", "sine"), ("count", "longest")),
        "ways": ("count", "longest", 4),
        "centres": ("count", "longest", START),
        "rows": ("count", "longest", COLUMNS),
        "rests": ("count",),
    }


class BallBlock(LocatingBlock):
    """The ball bearings of a run; see `LocatingBlock`.

    Parameters
    ----------
    members : sequence of Member
        Bearings, each a `LocatingElement` with a `BallForce`.
    """

    record, name, nodes = Balls, "ehd_ball_block", NODES

    def own(self) -> dict[str, Any]:
        """See `LocatingBlock.own`."""
        cosine, sine = np.zeros((2, len(self.elements), self.longest))
        ways = np.zeros((*cosine.shape, 4))
        for b, one in enumerate(self.elements):
            cosine[b, : self.size(b)], sine[b, : self.size(b)] = one.force.directions
            ways[b, : self.size(b)] = one.force.rows
        return {
            "spins": self.rows([(one.inner_spin, one.outer_spin) for one in self.elements], 2),
            "lengths": self.rows([one.force.shape for one in self.elements], len(BallShape._fields)),
            "drives": self.rows([one.force.drive for one in self.elements], len(Drive._fields)),
            "cosine": cosine,
            "sine": sine,
            "ways": ways,
        }


BALLS = kind_of(BallBlock)
"""For `mbs.transient.kinds`."""
