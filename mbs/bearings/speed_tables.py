"""Tables of a contact law over the speed of a system, for runs whose speed changes all the time.

Making a table of `mbs.bearings.slice_table` costs fifty bearing forces, too much for each step. Its cells lie at equal
places z = (delta - centre)/scale at all speeds; so a run makes tables at nodes evenly spaced in ln of the speed, as
it comes to them, and takes between two nodes the straight blend of cells, centre and scale. The nodes are so close
that the blend is wrong by less than the tables are: `STEP` makes some 1e-8 of load and stiffness of a bearing.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.errors import EhdmapsError
from ehdmaps.maps.law import ContactLaw
from mbs.bearings import slice_table as table
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.force_at_point import ForceAtPoint

STEP = 1e-3
"""Distance of the nodes in ln of the speed."""

NODES = 32
"""How many tables are held."""

_KIND = table.LawNumbers._fields.index("kind")

_STANDSTILL = -700.0
"""ln of a speed that stands for rest: the part of the film that is left there is zero in double precision."""


class SpeedTables:
    """Tables of one law at one temperature, for a window of speeds.

    Parameters
    ----------
    force : BearingForce
        Whose law; all bearings with the same law, temperature and rates may share the tables.
    temperature : float
        [K].
    rates : (float, float)
        Entrainment speed for each speed of the system [m/rad], and centrifugal load for its square [N s2/(m rad2)].

    Attributes
    ----------
    varies : bool
        Whether the law changes with speed; a dry one has one table for all.
    """

    def __init__(self, force: BearingForce, temperature: float, rates: tuple[float, float]) -> None:
        self._force, self._temperature, self._rates = force, temperature, rates
        self.varies = isinstance(force.law, ContactLaw)
        self._range = (0, -1)
        self._fixed: float | None = None
        self._sound = np.zeros(NODES, dtype=bool)
        self._outside = np.zeros(NODES, dtype=bool)
        self._buffer = np.empty((8, 2 * table.ROWS + 1))

    def places(self, speeds: FloatArray) -> tuple[IntArray, FloatArray]:
        """Nodes below speeds [rad/s], and parts of the way to the next nodes; both zero for one speed alone."""
        size = np.abs(speeds)
        if not self.varies or np.all(size == size[0]):
            return np.zeros(size.size, dtype=np.int64), np.zeros(size.size)
        with np.errstate(divide="ignore"):
            place = np.maximum(np.log(size), _STANDSTILL) / STEP
        node = np.floor(place)
        return node.astype(np.int64), place - node

    def prepare(
        self, speeds: FloatArray, nodes: IntArray, weights: FloatArray, cells: FloatArray, numbers: FloatArray
    ) -> tuple[IntArray, BoolArray, IntArray]:
        """Make the tables for the first of some speeds, as many as are held at once.

        Parameters
        ----------
        speeds : array (n,)
            [rad/s].
        nodes, weights : array (n,)
            Nodes and weights from `places`.
        cells, numbers : array (NODES, rows, 8), (NODES, 10)
            Tables, kept from call to call.

        Returns
        -------
        slots : array (k,)
            Slots of the tables of the first k speeds.
        sound : array (k,)
            Whether tables hold the law there; else it must be called for each slice.
        outside : array (k,)
            One where every call counts as outside the map.
        """
        if not self.varies or not (np.any(weights) or np.any(nodes)):
            self._fix(abs(float(speeds[0])), cells, numbers)
            sound, outside = self._sound[:1], self._outside[:1]
            return np.zeros_like(nodes), np.repeat(sound, nodes.size), np.repeat(outside, nodes.size).astype(np.int64)
        low, high = np.minimum.accumulate(nodes), np.maximum.accumulate(nodes)
        count = int(np.searchsorted(high - low, NODES - 2, side="right"))
        first, last = int(low[count - 1]), int(high[count - 1]) + 1
        self._fill(first, last, cells, numbers)
        slots = nodes[:count] % NODES
        following = (nodes[:count] + 1) % NODES
        outside = self._outside[slots]
        alike = numbers[slots, _KIND] == numbers[following, _KIND]
        sound = alike & self._sound[slots] & self._sound[following] & (outside == self._outside[following])
        return slots, sound, outside.astype(np.int64)

    def _fix(self, speed: float, cells: FloatArray, numbers: FloatArray) -> None:
        """The table of one speed, in the first place."""
        if self._fixed is not None and (self._fixed == speed or not self.varies):
            return
        self._fixed, self._range = speed, (0, -1)
        self._copy(0, self._force_at(self._conditions(speed)), cells[0], numbers[0])

    def _force_at(self, conditions: tuple[float, float, float]) -> ForceAtPoint | None:
        """The force there, or none where it refuses: the step that asks for it will be told why."""
        try:
            return self._force.at(*conditions)
        except EhdmapsError:
            return None

    def _copy(self, slot: int, point: ForceAtPoint | None, cells: FloatArray, numbers: FloatArray) -> None:
        """Take over a table or a power law."""
        self._sound[slot] = point is not None and point.tabulated
        if point is None:
            return
        self._outside[slot] = point.outside
        numbers[:] = point.arrays[4]
        if numbers[_KIND] == table.CELLS:
            cells[:] = point.arrays[5]

    def _fill(self, first: int, last: int, cells: FloatArray, numbers: FloatArray) -> None:
        """Tables of the nodes first to last; the node k lies at the place k modulo NODES."""
        begin, end = self._range if self._fixed is None else (0, -1)
        self._fixed = None
        for node in range(first, last + 1):
            if not begin <= node <= end:
                self._make(node, cells[node % NODES], numbers[node % NODES])
        # The window only grows where what it held before is still there.
        low, high = min(first, begin), max(last, end)
        touching = begin <= end and first <= end + 1 and last >= begin - 1
        self._range = (low, high) if touching and high - low < NODES else (first, last)

    def _make(self, node: int, cells: FloatArray, numbers: FloatArray) -> None:
        """Make one table."""
        law, slot = self._force.law, node % NODES
        assert isinstance(law, ContactLaw)
        speed = math.exp(node * STEP)
        conditions = np.array(self._conditions(speed))
        centrifugal = float(conditions[2])
        self._sound[slot] = False
        if not 0.0 <= centrifugal < law.load_range[1]:
            return
        arrays, workspace = self._force.flat_law.arrays(law, centrifugal > 0.0)
        counts = np.zeros(4, dtype=np.int64)
        fits = table.tabulate_law(arrays, workspace, conditions, table.NODES, self._buffer, cells, numbers, counts)
        self._outside[slot] = bool(counts.any())
        if not fits:
            self._copy(slot, self._force_at(self._conditions(speed)), cells, numbers)
        elif not (self._outside[slot] and law.outside == "error"):
            self._sound[slot] = True

    def _conditions(self, speed: float) -> tuple[float, float, float]:
        """Entrainment speed, temperature, centrifugal load."""
        return self._rates[0] * speed, self._temperature, self._rates[1] * speed**2
