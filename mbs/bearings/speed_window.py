"""Which speeds have a table: nodes evenly spaced in ln of the speed, in a few slots that are used again and again.

Below a lowest speed, where a film fades out, laws change with the speed itself and not with its logarithm: nodes there
are evenly spaced in the speed, as closely as at the lowest one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray


class Made(NamedTuple):
    """What there is to say of a table that was made.

    Attributes
    ----------
    sound : bool
        Whether it holds the law; else compiled code has no answer at this speed.
    outside : bool
        Whether every call counts as outside the map.
    kind : int
        Tables of two kinds cannot be blended.
    """

    sound: bool
    outside: bool = False
    kind: int = 0


Maker = Callable[[int, float, bool], Made]
"""Makes the table of a slot for a speed [rad/s], which is a node or the only speed of the run so far."""


class SpeedWindow:
    """The slots of the tables of one law.

    Parameters
    ----------
    step : float
        Distance of the nodes in ln of the speed.
    slots : int
        How many tables are held.
    lowest : float
        Speed at which the nodes change from even in ln of the speed to even in the speed [rad/s], > 0.
    varies : bool
        Whether the law changes with speed; a dry one has one table for all.
    """

    def __init__(self, step: float, slots: int, lowest: float, varies: bool = True) -> None:
        self._step, self._slots, self._lowest, self._varies = step, slots, lowest, varies
        self._held: list[tuple[bool, float] | None] = [None] * slots
        self._sound, self._outside = np.zeros(slots, dtype=np.bool_), np.zeros(slots, dtype=np.bool_)
        self._kinds = np.zeros(slots, dtype=np.int64)

    def places(self, speeds: FloatArray) -> tuple[IntArray, FloatArray]:
        """Nodes below speeds [rad/s], and parts of the way to the next nodes; both zero for one speed alone."""
        size = np.abs(speeds)
        if not self._varies or np.all(size == size[0]):
            return np.zeros(size.size, dtype=np.int64), np.zeros(size.size)
        by_lowest = size / self._lowest
        place = np.where(by_lowest < 1.0, by_lowest - 1.0, np.log(np.maximum(by_lowest, 1.0))) / self._step
        node = np.floor(place)
        return node.astype(np.int64), place - node

    def speed_of(self, node: int) -> float:
        """Speed of a node [rad/s]; exactly the lowest one for the node 0."""
        place = node * self._step
        return self._lowest * (math.exp(place) if node > 0 else max(1.0 + place, 0.0))

    def prepare(
        self, speeds: FloatArray, nodes: IntArray, weights: FloatArray, make: Maker
    ) -> tuple[IntArray, BoolArray, IntArray]:
        """Have the tables made for the first of some speeds, as many as are held at once.

        Parameters
        ----------
        speeds : array (n,)
            Speeds [rad/s].
        nodes, weights : array (n,)
            Nodes and weights from `places`.
        make : callable
            Makes the table of a slot.

        Returns
        -------
        slots : array (k,)
            Slots of the tables of the first k speeds.
        sound : array (k,)
            Whether tables hold the law there.
        outside : array (k,), of int
            One where every call counts as outside the map.
        """
        if not self._varies or not (np.any(weights) or np.any(nodes)):
            speed = abs(float(speeds[0]))
            self._hold(0, (True, speed if self._varies else 0.0), speed, make)
            sound, outside = self._sound[:1], self._outside[:1]
            return np.zeros_like(nodes), np.repeat(sound, nodes.size), np.repeat(outside, nodes.size).astype(np.int64)
        low, high = np.minimum.accumulate(nodes), np.maximum.accumulate(nodes)
        count = int(np.searchsorted(high - low, self._slots - 2, side="right"))
        for node in range(int(low[count - 1]), int(high[count - 1]) + 2):
            self._hold(node % self._slots, (False, float(node)), self.speed_of(node), make)
        slots, following = nodes[:count] % self._slots, (nodes[:count] + 1) % self._slots
        alike = self._kinds[slots] == self._kinds[following]
        return slots, alike & self._sound[slots] & self._sound[following], self._outside[slots].astype(np.int64)

    def _hold(self, slot: int, key: tuple[bool, float], speed: float, make: Maker) -> None:
        """Have the table of a slot made, unless it is there."""
        if self._held[slot] != key:
            self._held[slot] = key
            self._sound[slot], self._outside[slot], self._kinds[slot] = make(slot, speed, key[0])
