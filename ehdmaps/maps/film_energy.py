"""What films with memory store and take up, after `ehdmaps.maps.memory_table`.

The work on a contact is w da + p dy + (w - p) dy. The first two terms are stored: they depend on the load w and the
state xi alone. The last one is taken up for good. This holds at one speed and temperature.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.memory_table import LIGHTEST, LOAD_ROWS, NODES, ROWS, MemoryTable, cubic_at, equilibrium_at
from ehdmaps.maps.memory_table import LOAD_NODES as _LOAD_NODES

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
