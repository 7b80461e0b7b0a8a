"""Tables of a contact law with memory over the speed of a system: as `mbs.bearings.speed_tables`, for films in time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.errors import EhdmapsError
from ehdmaps.maps.kernel import LOAD_TOLERANCE
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.lines import FAST
from ehdmaps.maps.memory_table import LOAD_ROWS, ROWS, MemoryTable
from mbs.bearings.speed_window import Made, SpeedWindow

STEP = 4e-3
"""Distance of the nodes in ln of the speed: the straight blend between two is right to some 1e-6 of the load."""

NODES = 8
"""How many tables are held."""

_ROUND_OFF = 1e-12

CENTRE, INVERSE_SCALE, LIFT_OFF, HIGHEST = range(4)
"""Numbers of a table: as of `MemoryTable`, and the load above which slices are counted [N/m]."""


class MemoryFilms(NamedTuple):
    """Tables of the laws at nodes over the speed, and the tables in use.

    Attributes
    ----------
    cells, load_cells, numbers : array (films, NODES, 2 ROWS, 12), (films, NODES, LOAD_ROWS, 4), (films, NODES, 4)
        Tables, as of `ehdmaps.maps.memory_table`.
    mixed_cells, mixed_load_cells, mixed : array (films, 2 ROWS, 12), (films, LOAD_ROWS, 4), (films, 4)
        The table in use.
    in_use : array (films, 2)
        Node and weight of those; negative for none.
    """

    cells: FloatArray
    load_cells: FloatArray
    numbers: FloatArray
    mixed_cells: FloatArray
    mixed_load_cells: FloatArray
    mixed: FloatArray
    in_use: FloatArray


def room(films: int) -> MemoryFilms:
    """Room for the tables of so many laws."""
    return MemoryFilms(
        cells=np.zeros((films, NODES, 2 * ROWS, 12)),
        load_cells=np.zeros((films, NODES, LOAD_ROWS, 4)),
        numbers=np.zeros((films, NODES, 4)),
        mixed_cells=np.zeros((films, 2 * ROWS, 12)),
        mixed_load_cells=np.zeros((films, LOAD_ROWS, 4)),
        mixed=np.zeros((films, 4)),
        in_use=np.full((films, 2), -1.0),
    )


@njit(error_model="numpy", fastmath=FAST)
def mix(films: MemoryFilms, film: int, node: int, weight: float) -> None:
    """Bring the table in use to a place between two nodes, straight in ln of the speed.

    Parameters
    ----------
    films : MemoryFilms
        Tables over the speed; those in use are written.
    film : int
        Index of the law.
    node : int
        The lower node.
    weight : float
        Weight of the upper node, 0 to 1.
    """
    if films.in_use[film, 0] == node and films.in_use[film, 1] == weight:
        return
    films.in_use[film, 0], films.in_use[film, 1] = node, weight
    other = (node + 1) % films.numbers.shape[1] if weight > 0.0 else node
    _straight(films.cells[film, node].reshape(-1), films.cells[film, other].reshape(-1), weight,
              films.mixed_cells[film].reshape(-1))  # fmt: skip
    _straight(films.load_cells[film, node].reshape(-1), films.load_cells[film, other].reshape(-1), weight,
              films.mixed_load_cells[film].reshape(-1))  # fmt: skip
    _straight(films.numbers[film, node], films.numbers[film, other], weight, films.mixed[film])


@njit(error_model="numpy", fastmath=FAST)
def _straight(low: FloatArray, high: FloatArray, weight: float, out: FloatArray) -> None:
    """Straight between two arrays."""
    for i in range(out.size):
        out[i] = low[i] + weight * (high[i] - low[i])


@njit(error_model="numpy")
def table_in_use(films: MemoryFilms, film: int) -> MemoryTable:
    """The table in use.

    Parameters
    ----------
    films : MemoryFilms
        Tables over the speed.
    film : int
        Index of the law.
    """
    numbers = films.mixed[film]
    return MemoryTable(
        films.mixed_cells[film],
        films.mixed_load_cells[film],
        numbers[CENTRE],
        numbers[INVERSE_SCALE],
        numbers[LIFT_OFF],
    )


class MemoryTables:
    """Tables of one law at one temperature, for a window of speeds.

    Parameters
    ----------
    law : ContactLaw
        The law of a roller between both raceways; all bearings with the same one, the same temperature and rate share
        the tables.
    temperature : float
        [K].
    rate : float
        Entrainment speed for each speed of the system [m/rad].
    """

    def __init__(self, law: ContactLaw, temperature: float, rate: float) -> None:
        self._law, self._temperature, self._rate = law, temperature, rate
        self._window = SpeedWindow(STEP, NODES, law.plain_table.lowest_speed / abs(rate) if rate else 1.0)

    def places(self, speeds: FloatArray) -> tuple[IntArray, FloatArray]:
        """Nodes and weights of speeds [rad/s], see `SpeedWindow.places`."""
        return self._window.places(speeds)

    def prepare(
        self, speeds: FloatArray, nodes: IntArray, weights: FloatArray, films: MemoryFilms, film: int
    ) -> tuple[IntArray, BoolArray, IntArray]:
        """Make the tables for the first of some speeds, see `SpeedWindow.prepare`.

        Parameters
        ----------
        speeds : array (n,)
            Speeds [rad/s].
        nodes, weights : array (n,)
            Nodes and weights from `places`.
        films : MemoryFilms
            Room for the tables.
        film : int
            Index of this law there.
        """
        return self._window.prepare(speeds, nodes, weights, lambda slot, speed, _: self._made(slot, speed, films, film))

    def _made(self, slot: int, speed: float, films: MemoryFilms, film: int) -> Made:
        """Make the table of a speed."""
        before = dict(self._law.outside_counts)
        try:
            # the node at the lowest speed has its whole film, whatever the rounding
            lowest, u = self._law.plain_table.lowest_speed, abs(self._rate * speed)
            at = self._law.at(lowest if abs(u - lowest) < _ROUND_OFF * lowest else u, self._temperature)
            table = at.memory.table
        except EhdmapsError:
            return Made(sound=False)  # the step that asks for it will be told why
        films.cells[film, slot], films.load_cells[film, slot] = table.cells, table.load_cells
        highest = at.point.highest_load * (1.0 + LOAD_TOLERANCE)
        films.numbers[film, slot] = table.centre, table.inverse_scale, table.lift_off, highest
        return Made(sound=True, outside=self._law.outside_counts != before)
