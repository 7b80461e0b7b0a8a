"""Tables of a contact law over the speed of a system, for runs whose speed changes all the time.

Making a table of `mbs.bearings.slice_table` costs fifty bearing forces, too much for each step. Its cells lie at equal
places z = (delta - centre)/scale at all speeds; so a run makes tables at nodes evenly spaced in ln of the speed, as
it comes to them, and takes between two nodes the straight blend of cells, centre and scale. The nodes are so close
that the blend is wrong by less than the tables are: `STEP` makes some 1e-8 of load and stiffness of a bearing.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.errors import EhdmapsError
from ehdmaps.maps.law import ContactLaw
from mbs.bearings import slice_table as table
from mbs.bearings.bearing import Bearing
from mbs.bearings.force_at_point import FlatLaw, ForceAtPoint
from mbs.bearings.speed_window import Made, SpeedWindow

STEP = 1e-3
"""Distance of the nodes in ln of the speed."""

NODES = 32
"""How many tables are held."""

_KIND = table.LawNumbers._fields.index("kind")


class SpeedTables:
    """Tables of one law at one temperature, for a window of speeds.

    Parameters
    ----------
    bearing : Bearing
        A bearing with the law.
    law : FlatLaw
        The law; all bearings with the same one, the same temperature and rates may share the tables.
    temperature : float
        [K].
    rates : (float, float)
        Entrainment speed for each speed of the system [m/rad], and centrifugal load for its square [N s2/(m rad2)].

    Attributes
    ----------
    varies : bool
        Whether the law changes with speed; a dry one has one table for all.
    """

    def __init__(self, bearing: Bearing, law: FlatLaw, temperature: float, rates: tuple[float, float]) -> None:
        self._bearing, self._law, self._temperature, self._rates = bearing, law, temperature, rates
        self.varies = isinstance(law.law, ContactLaw)
        self._window = SpeedWindow(STEP, NODES, self.varies)
        self._buffer = np.empty((8, 2 * table.ROWS + 1))

    def places(self, speeds: FloatArray) -> tuple[IntArray, FloatArray]:
        """Nodes and weights of speeds [rad/s], see `SpeedWindow.places`."""
        return self._window.places(speeds)

    def prepare(
        self, speeds: FloatArray, nodes: IntArray, weights: FloatArray, cells: FloatArray, numbers: FloatArray
    ) -> tuple[IntArray, BoolArray, IntArray]:
        """Make the tables for the first of some speeds, see `SpeedWindow.prepare`.

        Parameters
        ----------
        speeds : array (n,)
            Speeds [rad/s].
        nodes, weights : array (n,)
            Nodes and weights from `places`.
        cells, numbers : array (NODES, rows, 8), (NODES, 10)
            Tables, kept from call to call.
        """

        def make(slot: int, speed: float, alone: bool) -> Made:
            if alone:
                return self._copied(self._force_at(self._conditions(speed)), cells[slot], numbers[slot])
            return self._made(speed, cells[slot], numbers[slot])

        return self._window.prepare(speeds, nodes, weights, make)

    def _force_at(self, conditions: tuple[float, float, float]) -> ForceAtPoint | None:
        """The force there, or none where it refuses: the step that asks for it will be told why."""
        try:
            return ForceAtPoint(self._bearing, self._law, conditions)
        except EhdmapsError:
            return None

    def _copied(self, point: ForceAtPoint | None, cells: FloatArray, numbers: FloatArray) -> Made:
        """Take over a table or a power law."""
        if point is None:
            return Made(sound=False)
        numbers[:] = point.arrays[4]
        if numbers[_KIND] == table.CELLS:
            cells[:] = point.arrays[5]
        return _told(point.tabulated, point.outside, numbers)

    def _made(self, speed: float, cells: FloatArray, numbers: FloatArray) -> Made:
        """Make the table of a speed."""
        law = self._law.law
        assert isinstance(law, ContactLaw)
        conditions = np.array(self._conditions(speed))
        centrifugal = float(conditions[2])
        if not 0.0 <= centrifugal < law.load_range[1]:
            return Made(sound=False)
        arrays, workspace = self._law.arrays(law, centrifugal > 0.0)
        counts = np.zeros(4, dtype=np.int64)
        fits = table.tabulate_law(arrays, workspace, conditions, table.NODES, self._buffer, cells, numbers, counts)
        if not fits:
            return self._copied(self._force_at(self._conditions(speed)), cells, numbers)
        outside = bool(counts.any())
        return _told(not (outside and law.outside == "error"), outside, numbers)

    def _conditions(self, speed: float) -> tuple[float, float, float]:
        """Entrainment speed, temperature, centrifugal load."""
        return self._rates[0] * speed, self._temperature, self._rates[1] * speed**2


def _told(sound: bool, outside: bool, numbers: FloatArray) -> Made:
    """What there is to say of a table; only tables of the same kind that count alike are blended."""
    return Made(sound, outside, 2 * int(numbers[_KIND]) + int(outside))
