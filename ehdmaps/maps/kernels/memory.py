"""Films with memory for other programs: a contact law that goes from step to step, with a state for each slice.

::

    at = law.at(entrainment_speed=1.7, temperature=313.15)
    state = at.memory.settled(delta)
    for delta in course:
        w, dw_ddelta, state = at.memory.advance(state, delta, dt)

The equations are in `ehdmaps.maps.kernels.memory_table`. `ContactLaw.advance` takes speed and temperature at each call.

The work on a contact is w da + p dy + (w - p) dy. The first two terms are stored: they depend on the load w and the
state xi alone. The last one is taken up for good. This holds at one speed and temperature.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.errors import InputError
from ehdmaps.maps.kernels import memory_table
from ehdmaps.maps.kernels.locked_film import LockedFactors, film_of
from ehdmaps.maps.kernels.memory_table import (
    LIGHTEST,
    LOAD_ROWS,
    NODES,
    ROWS,
    MemoryTable,
    advanced,
    cubic_at,
    equilibrium_at,
    fill_memory,
    step_of,
)
from ehdmaps.maps.kernels.memory_table import LOAD_NODES as _LOAD_NODES
from ehdmaps.maps.kernels.tables import Point
from ehdmaps.physics.contact import LineContact

_PLACES = np.array([0.5 - 0.5 * np.sqrt(0.6), 0.5, 0.5 + 0.5 * np.sqrt(0.6)])
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
_WIDTHS, _LOAD_WIDTHS = np.diff(NODES), np.diff(_LOAD_NODES)


@njit(error_model="numpy")
def spent_by(table: MemoryTable, before: float, load_before: float, state: float, load: float) -> float:
    """Energy that a film takes up over a step, (w - p) dy by the trapezoidal rule [J/m].

    Parameters
    ----------
    table : MemoryTable
        The contact.
    before, load_before : float
        State [m] and load [N/m] at the beginning of the step.
    state, load : float
        The same at its end.
    """
    if before == state:
        return 0.0
    p0, _, y0, _, _, _ = equilibrium_at(table, before)
    p1, _, y1, _, _, _ = equilibrium_at(table, state)
    return 0.5 * (load_before - p0 + load - p1) * (y1 - y0)


@njit(error_model="numpy")
def spent_by_all(
    table: MemoryTable,
    before: FloatArray,
    loads_before: FloatArray,
    states: FloatArray,
    loads: FloatArray,
    out: FloatArray,
) -> None:
    """`spent_by` of many contacts.

    Parameters
    ----------
    table : MemoryTable
        The contact.
    before, loads_before, states, loads : array (n,)
        States [m] and loads [N/m] at both ends of the step.
    out : array (n,)
        Energies of all contacts, filled [J/m].
    """
    for i in range(out.size):
        out[i] = spent_by(table, before[i], loads_before[i], states[i], loads[i])


@njit(error_model="numpy")
def _over_cell(cells: FloatArray, first: int, second: int, begin: float, end: float) -> float:
    """Integral of one cubic by another over a part of a cell; exact, by three points."""
    total = 0.0
    for i in range(3):
        t = begin + _PLACES[i] * (end - begin)
        total += _WEIGHTS[i] * cubic_at(cells, first, t)[0] * cubic_at(cells, second, t)[1]
    return total * (end - begin)


@njit(error_model="numpy")
def _film_energy(table: MemoryTable, state: float) -> float:
    """Integral of p dy up to a state [J/m], cell by cell: those below the centre, then those above it."""
    z, total = (state - table.centre) * table.inverse_scale, 0.0
    place = 0.0
    for side in range(2):
        place = 0.0
        for row in range(ROWS):
            near, width = place, _WIDTHS[row]
            place += width
            if side == 0:
                # cells are counted from the centre down; a state within ends its cell
                upper = min(-near, z)
                if upper > -place:
                    total += _over_cell(table.cells[ROWS + row], 0, 4, -width, upper + near)
            elif z > near:
                last = z - near if row == ROWS - 1 else min(z - near, width)
                total += _over_cell(table.cells[row], 0, 4, 0.0, last)
    return total


@njit(error_model="numpy")
def _load_energy(table: MemoryTable, load: float) -> float:
    """Integral of w da up to a load [J/m]."""
    total, begin, end = 0.0, 0.0, load / LIGHTEST
    for row in range(LOAD_ROWS):
        if end <= begin:
            break
        width = _LOAD_WIDTHS[row]
        last = end - begin if row == LOAD_ROWS - 1 else min(end - begin, width)
        for i in range(3):
            t = _PLACES[i] * last
            total += _WEIGHTS[i] * last * LIGHTEST * (begin + t) * cubic_at(table.load_cells[row], 0, t)[1]
        begin += width
    return total


@njit(error_model="numpy")
def energies_of(table: MemoryTable, states: FloatArray, loads: FloatArray, out: FloatArray) -> None:
    """Stored energy of many contacts (n,) into `out` [J/m]; without contact it is zero.

    Parameters
    ----------
    table : MemoryTable
        The contact.
    states, loads : array (n,)
        Approaches at which the films would be in equilibrium [m], loads [N/m].
    out : array (n,)
        Energies of all contacts, filled.
    """
    for i in range(out.size):
        out[i] = _film_energy(table, states[i]) + _load_energy(table, loads[i])


_NO_LOAD = 1e-20


@dataclass(frozen=True, eq=False)
class FilmState:
    """States of films, of any shape.

    Attributes
    ----------
    approach : array
        Approach at which each film would be in equilibrium [m].
    change : array
        What the last step changed in its squeezing G [N s/m2], see `ehdmaps.maps.kernels.memory_table`.
    load : array
        Load at the end of the last step [N/m].
    step : float
        Length of the last step [s]; 0 after a rest.
    """

    approach: FloatArray
    change: FloatArray
    load: FloatArray
    step: float = 0.0


class FilmMemory:
    """A contact law with memory at one speed and temperature.

    Parameters
    ----------
    point : Point
        The law without memory: at rest both are alike, and at low frequency.
    contacts : sequence of LineContact
        What is in series.
    entrainment_speed : float
        u [m/s], of either sign.
    factors : LockedFactors
        Factors of the closed formula of the locked film.
    check : callable
        Is told the loads of each step [N/m]; it may raise for those above the map.

    Raises
    ------
    InputError
        With a centrifugal load: films with memory take none.
    """

    def __init__(
        self,
        point: Point,
        contacts: Sequence[LineContact],
        entrainment_speed: float,
        factors: LockedFactors,
        check: Callable[[FloatArray], None],
    ) -> None:
        if point.centrifugal_load != 0.0:
            raise InputError(
                f"film memory, centrifugal_load: got {point.centrifugal_load:.6g} N/m; allowed: 0; take the law "
                "without memory for rollers with centrifugal load"
            )
        self._check = check
        film = film_of(contacts, entrainment_speed)
        cells = np.zeros((2 * memory_table.ROWS, 12))
        load_cells = np.zeros((memory_table.LOAD_ROWS, 4))
        nodes, load_nodes = memory_table.NODES, memory_table.LOAD_NODES
        counts = np.zeros(4, dtype=np.int64)
        self._table = fill_memory(point, film, factors, nodes, load_nodes, cells, load_cells, counts)

    @property
    def table(self) -> MemoryTable:
        """Arrays for compiled code, see `ehdmaps.maps.kernels.memory_table`."""
        return self._table

    def settled(self, delta: npt.ArrayLike) -> FilmState:
        """Films in equilibrium at an approach.

        Parameters
        ----------
        delta : float or array
            [m].

        Raises
        ------
        InputError
            For approaches that are no finite numbers.
        """
        approach = np.maximum(_finite("delta", delta), self._table.lift_off)
        loads = np.empty(approach.size)
        _loads_at_rest(self._table, np.ascontiguousarray(approach).reshape(-1), loads)
        return FilmState(approach, np.zeros_like(approach), loads.reshape(approach.shape))

    def advance(self, state: FilmState, delta: npt.ArrayLike, dt: float) -> tuple[Any, Any, FilmState]:
        """A step in time. The state that goes in is left as it is: the step may be tried again.

        Parameters
        ----------
        state : FilmState
            State at the beginning of the step.
        delta : float or array
            Approach at its end [m], in the shape of the state.
        dt : float
            Length of the step [s], > 0. The method is of second order while steps grow by no more than a fifth.

        Returns
        -------
        w, dw_ddelta : float or array
            Load at the end of the step [N/m], >= 0, and its exact derivative by the approach there [N/m2].
        state : FilmState
            State at the end of the step.

        Raises
        ------
        InputError
            For values that are no finite numbers, other shapes, and steps that are not longer than zero.
        OutsideMapError
            For loads above the map, where the law has the policy "error".
        """
        ends = _finite("delta", delta)
        if ends.shape != state.approach.shape:
            raise InputError(
                f"film memory, delta: got the shape {ends.shape}; the state has {state.approach.shape}; "
                "they must be alike"
            )
        if not (isinstance(dt, int | float) and 0.0 < dt < math.inf):
            raise InputError(f"film memory, dt: got {dt!r} s; allowed: finite and > 0 s")
        flat = np.ascontiguousarray(ends).reshape(-1)
        found = np.empty((4, flat.size))
        before, change = (np.ascontiguousarray(part).reshape(-1) for part in (state.approach, state.change))
        _advance_many(self._table, float(dt), state.step, flat, before, change, found)
        w, tangent, approach, changed = (row.reshape(ends.shape) for row in found)
        self._check(w)
        return w[()], tangent[()], FilmState(approach, changed, w, float(dt))

    def spent(self, before: FilmState, state: FilmState) -> FloatArray:
        """Energy that films take up for good over a step from one state to another [J/m], in their shape."""
        begin, load, end, last = (
            part.reshape(-1) for part in (before.approach, before.load, state.approach, state.load)
        )
        out = np.empty(state.approach.size)
        spent_by_all(self._table, begin, load, end, last, out)
        return out.reshape(state.approach.shape)

    def stored(self, state: FilmState) -> FloatArray:
        """Energy that contacts store [J/m], in the shape of the state; zero without contact."""
        out = np.empty(state.approach.size)
        energies_of(self._table, state.approach.reshape(-1), state.load.reshape(-1), out)
        return out.reshape(state.approach.shape)


@njit(error_model="numpy")
def _loads_at_rest(table: MemoryTable, approach: FloatArray, loads: FloatArray) -> None:
    """Loads of films in equilibrium, flat."""
    for i in range(approach.size):
        loads[i] = equilibrium_at(table, approach[i])[0]


@njit(error_model="numpy")
def _advance_many(
    table: MemoryTable,
    h: float,
    last: float,
    delta: FloatArray,
    before: FloatArray,
    change: FloatArray,
    found: FloatArray,
) -> None:
    """Advance flat arrays: loads, tangents, states and changes of G, into `found` (4, n)."""
    step = step_of(h, last)
    for i in range(delta.size):
        g = equilibrium_at(table, before[i])[4]
        w, tangent, xi = advanced(table, step, delta[i], g, change[i], before[i])
        found[0, i], found[1, i], found[2, i] = (w if w > _NO_LOAD else 0.0), tangent, xi
        found[3, i] = equilibrium_at(table, xi)[4] - g


def _finite(name: str, values: npt.ArrayLike) -> FloatArray:
    """Finite doubles, or an error."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"film memory, {name}: got {values!r}; allowed: real numbers") from None
    if not np.all(np.isfinite(array)):
        raise InputError(f"film memory, {name}: got {array[~np.isfinite(array)].flat[0]}; allowed: finite numbers")
    return array
