"""Tables of a contact law over the speed of a system, for runs whose speed changes all the time.

Making a table of `mbs.bearings.slice_table` costs fifty bearing forces, too much for each step. Its cells lie at equal
places z = (delta - centre)/scale at all speeds; so a run makes tables at nodes evenly spaced in ln of the speed, as
it comes to them, and takes between two nodes the straight blend of cells, centre and scale. The nodes are so close
that the blend is wrong by less than the tables are: `STEP` makes some 1e-8 of load and stiffness of a bearing.

Below the speeds with a whole film one table serves all: what is left of the film moves its knots, see `fade` of
`mbs.bearings.faded_table`. With a centrifugal load, which changes with the speed, each step has a table of its own.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.errors import EhdmapsError
from mbs.bearings import slice_table as table
from mbs.bearings.bearing import Bearing
from mbs.bearings.flat_law import FlatLaw, tabulate_law
from mbs.bearings.force_at_point import ForceAtPoint, is_faded, is_one_power, part_of_film
from mbs.bearings.laws import DryLaw
from mbs.bearings.speed_window import Made, SpeedWindow

if TYPE_CHECKING:
    from ehdmaps.maps.law import ContactLaw

STEP = 1e-3
"""Distance of the nodes in ln of the speed."""

NODES = 32
"""How many tables are held, besides that of a faded film."""

_FADED = -(2**60)
"""Node of the speeds at which a film is faded."""

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
    has_cells : bool
        Whether the law is read from cells; a power law is not.
    """

    def __init__(self, bearing: Bearing, law: FlatLaw, temperature: float, rates: tuple[float, float]) -> None:
        self._bearing, self._law, self._temperature, self._rates = bearing, law, temperature, rates
        self.varies = not isinstance(law.law, DryLaw)
        self.has_cells = not isinstance(law.law, DryLaw) or law.law.prepared(1.0)[1] is not None
        lowest, self._faded_below = 1.0, 0.0
        if not isinstance(law.law, DryLaw):
            lowest, self._faded_below = _limits(law.law, abs(rates[0]))
        self._window = SpeedWindow(STEP, NODES, lowest, self.varies)
        self._nodes, self._marks = np.empty((4, table.NODES)), np.zeros((2, table.NODES), dtype=np.uint8)
        self._film = Made(sound=False)
        self._has_film = False

    def places(self, speeds: FloatArray) -> tuple[IntArray, FloatArray]:
        """Nodes and weights of speeds [rad/s], see `SpeedWindow.places`; the part of the film where it is faded."""
        nodes, weights = self._window.places(speeds)
        law, faded = self._law.law, np.abs(speeds) < self._faded_below
        # Dry contacts that are one power law need no table.
        if not isinstance(law, DryLaw) and faded.any() and (np.any(speeds) or not is_one_power(law)):
            nodes[faded] = _FADED
            weights[faded] = [part_of_film(law, self._rates[0] * speed) for speed in speeds[faded].tolist()]
        return nodes, weights

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
        cells, numbers : array (NODES + 1, rows, 8), (NODES + 1, NUMBERS)
            Tables, kept from call to call; the last one for the faded film.
        """
        faded = nodes == _FADED
        if faded[0]:
            return self._faded(speeds[: _leading(faded)], cells, numbers)
        count = _leading(~faded)
        speeds, nodes, weights = speeds[:count], nodes[:count], weights[:count]

        def make(slot: int, speed: float, alone: bool) -> Made:
            if alone:
                return self._copied(self._force_at(self._conditions(speed)), cells[slot], numbers[slot])
            return self._made(speed, cells[slot], numbers[slot])

        return self._window.prepare(speeds, nodes, weights, make)

    def _faded(
        self, speeds: FloatArray, cells: FloatArray, numbers: FloatArray
    ) -> tuple[IntArray, BoolArray, IntArray]:
        """Have the table of the faded film made, unless it is there."""
        one = self._rates[1] == 0.0
        count = speeds.size if one else 1
        if not (one and self._has_film):
            self._film = self._tabulated(self._conditions(abs(float(speeds[0]))), cells[NODES], numbers[NODES])
            self._has_film = True
        slots, sound = np.full(count, NODES, dtype=np.int64), np.full(count, self._film.sound)
        return slots, sound, np.full(count, int(self._film.outside), dtype=np.int64)

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
        return _told(point.tabulated and numbers[_KIND] != table.KNOTS, point.outside, numbers)

    def _made(self, speed: float, cells: FloatArray, numbers: FloatArray) -> Made:
        """Make the table of a speed, or take over its power law."""
        law, (u, temperature, centrifugal) = self._law.law, self._conditions(speed)
        assert not isinstance(law, DryLaw)
        if speed >= self._faded_below > 0.0:
            # The node at the lowest speed has its whole film, whatever the rounding.
            u = max(abs(u), law.plain_table.lowest_speed)
        made = Made(sound=False)
        if not is_faded(law, u):
            made = self._tabulated((u, temperature, centrifugal), cells, numbers)
        return made if made.sound else self._copied(self._force_at((u, temperature, centrifugal)), cells, numbers)

    def _tabulated(self, given: tuple[float, float, float], cells: FloatArray, numbers: FloatArray) -> Made:
        """Make a table at some conditions."""
        law, centrifugal = self._law.law, given[2]
        assert not isinstance(law, DryLaw)
        if not 0.0 <= centrifugal < law.load_range[1]:
            return Made(sound=False)
        arrays, workspace = self._law.arrays(law, centrifugal > 0.0)
        conditions, counts = np.array(given), np.zeros(4, dtype=np.int64)
        fits = tabulate_law(arrays, workspace, conditions, self._nodes, self._marks, cells, numbers, counts)
        outside = bool(counts.any())
        return _told(fits and not (outside and law.outside == "error"), outside, numbers)

    def _conditions(self, speed: float) -> tuple[float, float, float]:
        """Entrainment speed, temperature, centrifugal load."""
        return self._rates[0] * speed, self._temperature, self._rates[1] * speed**2


def _limits(law: ContactLaw, rate: float) -> tuple[float, float]:
    """Speed from which on the law changes with ln of the speed, and below which its film is faded [rad/s]."""
    numbers = law.plain_table
    if rate == 0.0 or math.isinf(numbers.film_speed):
        # no film at any speed of the map
        return 1.0, 0.0 if is_one_power(law) else numbers.counted_speed / rate if rate else math.inf
    return numbers.lowest_speed / rate, numbers.film_speed / rate


def _leading(marked: BoolArray) -> int:
    """How many at the beginning are marked."""
    return marked.size if marked.all() else int(np.argmin(marked))


def _told(sound: bool, outside: bool, numbers: FloatArray) -> Made:
    """What there is to say of a table; only tables of the same kind that count alike are blended."""
    return Made(sound, outside, 2 * int(numbers[_KIND]) + int(outside))
