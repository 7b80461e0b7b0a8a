"""The contact law at one speed, temperature and centrifugal load, as a table that a bearing reads in nanoseconds.

The cells of the table are the binary digits of a = 1 + |z|, z = (delta - centre)/scale: 32 cells to each doubling of a.
So no logarithm is needed to find a cell; cells are fine around the valley of the damping, where the centre lies, and
coarse far from it. In each cell load and damping are cubics through the values and slopes of the law at its ends:
C1, and with slopes held so that the load never falls with the approach and the damping is never negative. Slices
differ from the law by some 1e-7 in load and 1e-5 in stiffness at most, a bearing by 1e-9 and 1e-7.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numba.np.unsafe.ndarray import to_fixed_tuple

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.copies import put
from ehdmaps.maps.binary_cells import last_of, nodes_of, rows_of
from ehdmaps.maps.bulk import evaluate_many_at
from ehdmaps.maps.kernel import LOAD_TOLERANCE, collapse
from ehdmaps.maps.lines import FAST, line_approach, line_state
from ehdmaps.maps.tables import ApproachTable, LawTable, Point

fixed_tuple: Any = to_fixed_tuple
"""The first numbers of an array as a tuple, in compiled code."""

ROWS = rows_of(14)
"""Rows of the table on each side of the centre."""

NODES = nodes_of(ROWS)
"""Ends of the cells, as values of a."""

LAST = last_of(NODES)

POWER, CELLS = 0.0, 1.0
"""Kinds of prepared laws."""

_PROBE = 1e4


class LawNumbers(NamedTuple):
    """The numbers of a prepared law.

    Attributes
    ----------
    kind : float
        POWER or CELLS.
    coefficient, exponent : float
        Constants of w = a delta^b [N/m]; for POWER.
    damping, damping_time : float
        Constant part of c per unit length [N s/m2], and the ratio of its other part to dw/d approach [s]; for POWER.
    centre, inverse_scale : float
        Places of the table [m], [1/m]; for CELLS.
    highest : float
        Load above which slices are outside the map [N/m].
    safe_approach : float
        Up to it no slice is [m].
    lift_off : float
        Up to it there is no load [m].
    slope : float
        What slopes are multiplied by.
    """

    kind: float
    coefficient: float
    exponent: float
    damping: float
    damping_time: float
    centre: float
    inverse_scale: float
    highest: float
    safe_approach: float
    lift_off: float
    slope: float


NUMBERS = len(LawNumbers._fields)
"""Length of an array that holds them in their order."""


class PreparedLaw(NamedTuple):
    """A law at one speed, temperature and centrifugal load.

    Attributes
    ----------
    numbers : LawNumbers
        Numbers of the law.
    cells : array (2 ROWS, 8)
        Table of the law; anything for POWER.
    """

    numbers: LawNumbers
    cells: FloatArray


@njit(cache=True, error_model="numpy")
def law_numbers(numbers: FloatArray) -> LawNumbers:
    """The numbers of a law from an array (NUMBERS,) in their order."""
    return LawNumbers(*fixed_tuple(numbers, 11))


@njit(cache=True, error_model="numpy")
def store_numbers(found: LawNumbers, numbers: FloatArray) -> None:
    """Write the numbers of a law into an array (NUMBERS,)."""
    for i in range(len(found)):
        numbers[i] = found[i]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def read_cells(cells: FloatArray, rows: IntArray, states: FloatArray) -> None:
    """Load, slope, damping and its slope, into `states` (4, n), from rows (n,) and places in the cells, states[0]."""
    w, dw, c, dc = states[0], states[1], states[2], states[3]
    for i in range(rows.size):
        m, t = np.uint64(rows[i]), w[i]
        high = cells[m, np.uint64(3)]
        bend = cells[m, np.uint64(2)] + t * high
        mean = cells[m, np.uint64(1)] + t * bend
        w[i], dw[i] = cells[m, np.uint64(0)] + t * mean, mean + t * (bend + t * high)
        high = cells[m, np.uint64(7)]
        bend = cells[m, np.uint64(6)] + t * high
        mean = cells[m, np.uint64(5)] + t * bend
        c[i], dc[i] = cells[m, np.uint64(4)] + t * mean, mean + t * (bend + t * high)


@njit(cache=True, error_model="numpy")
def _centre(point: Point) -> float:
    """Approach around which the law is finest."""
    if point.centrifugal_load == 0.0:
        return point.own.offset
    load = line_state(point.inner, point.inner.offset)[0] + point.centrifugal_load
    approach: float = point.inner.offset + line_approach(point.outer, load)
    return approach


@njit(cache=True, error_model="numpy")
def tabulate(
    point: Point, nodes: FloatArray, buffer: FloatArray, cells: FloatArray, highest: float, numbers: FloatArray
) -> bool:
    """Fill a table with the law of a point.

    Parameters
    ----------
    point : Point
        Law at a point, with the whole film.
    nodes : array (ROWS + 1,)
        `NODES`.
    buffer : array (8, 2 ROWS + 1)
        Scratch space.
    cells : array (2 ROWS, 8)
        Filled: four coefficients of w, four of c, over the distance from the end of the cell that is nearer to the
        centre, in scales.
    highest : float
        Load above which slices are outside the map [N/m].
    numbers : array (NUMBERS,)
        Filled with `LawNumbers`, if there is a table.

    Returns
    -------
    bool
        False if the table does not reach down to lift-off.
    """
    rows = nodes.size - 1
    centre, inverse = _centre(point), point.own.inverse_scale
    z, delta, w, dw, c, dc = buffer[0], buffer[1], buffer[2], buffer[3], buffer[4], buffer[5]
    first, end = 0, 0
    for i in range(2 * rows + 1):
        z[i] = nodes[i - rows] - 1.0 if i >= rows else 1.0 - nodes[rows - i]
        delta[i] = centre + z[i] / inverse
        if delta[i] <= point.lift_off:
            first = i + 1
        if i > 0 and delta[i - 1] <= point.held_approach:
            end = i + 1
    if first == 0:
        return False
    # Up to the first node beyond the hold the table has the law as if it went on: beyond, it is not used.
    free = Point(
        point.own, point.inner, point.outer, point.structure, point.film, point.centrifugal_load, point.inner_lift_off,
        point.outer_start, point.lift_off, point.highest_load, point.held_load, np.inf, point.held_stiffness,
        point.held_damping,
    )  # fmt: skip
    counts = np.zeros(4, dtype=np.int64)
    rate, forces = buffer[6, first:end], np.empty((3, end - first))
    rate[:] = 0.0
    evaluate_many_at(free, delta[first:end], rate, forces, counts)
    put(forces[0], w[first:end])
    put(forces[1], dw[first:end])
    put(forces[2], c[first:end])
    # At a high rate the slope is nearly all damping.
    rate[:] = _PROBE
    evaluate_many_at(free, delta[first:end], rate, forces, counts)
    for i in range(first, end):
        dc[i] = (forces[1, i - first] - dw[i]) / _PROBE
    for i in range(first):
        w[i] = dw[i] = c[i] = dc[i] = 0.0
    for i in range(end, 2 * rows + 1):
        w[i] = w[end - 1] + dw[end - 1] * (delta[i] - delta[end - 1])
        dw[i], c[i], dc[i] = dw[end - 1], c[end - 1], 0.0
    safe = delta[0]
    for i in range(2 * rows + 1):
        if w[i] <= highest:
            safe = delta[i]
    found = LawNumbers(
        kind=CELLS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=centre,
        inverse_scale=inverse, highest=highest, safe_approach=safe, lift_off=delta[first - 1], slope=inverse,
    )  # fmt: skip
    store_numbers(found, numbers)
    _fill(z, inverse, w, dw, c, dc, cells)
    return True


@njit(cache=True, error_model="numpy")
def _fill(
    z: FloatArray, inverse: float, w: FloatArray, dw: FloatArray, c: FloatArray, dc: FloatArray, cells: FloatArray
) -> None:
    """Cubics of all cells from values and slopes (by the approach) at the nodes z."""
    rows, last = (z.size - 1) // 2, z.size - 1
    for i in range(z.size):
        slope, change = max(dw[i] / inverse, 0.0), dc[i] / inverse
        if i > 0:
            h = z[i] - z[i - 1]
            slope = min(slope, 3.0 * (w[i] - w[i - 1]) / h)
            change = min(change, 3.0 * c[i] / h)
        if i < last:
            h = z[i + 1] - z[i]
            slope = min(slope, 3.0 * (w[i + 1] - w[i]) / h)
            change = max(change, -3.0 * c[i] / h)
        dw[i], dc[i] = max(slope, 0.0), change
    for k in range(rows):
        for side in range(2):
            near, far = (rows + k, rows + k + 1) if side == 0 else (rows - k, rows - k - 1)
            cell = cells[side * rows + k]
            h = z[far] - z[near]
            secant = (w[far] - w[near]) / h
            cell[0], cell[1] = w[near], dw[near]
            cell[2] = (3.0 * secant - 2.0 * dw[near] - dw[far]) / h
            cell[3] = (dw[near] + dw[far] - 2.0 * secant) / (h * h)
            secant = (c[far] - c[near]) / h
            cell[4], cell[5] = c[near], dc[near]
            cell[6] = (3.0 * secant - 2.0 * dc[near] - dc[far]) / h
            cell[7] = (dc[near] + dc[far] - 2.0 * secant) / (h * h)


class FlatTable(NamedTuple):
    """A `LawTable` in arrays: compiled code takes few of them from Python much faster than nested tuples.

    Attributes
    ----------
    own, inner, outer : array
        `ApproachTable.coefficients` of each.
    own_place, inner_place, outer_place : array
        `ApproachTable.place` of each.
    axes : array (3, 6)
        The numbers of each, in their order.
    structure : array (n, 3)
        The array of the `LawTable`.
    numbers : array (9,)
        The numbers of the `LawTable`, in their order.
    """

    own: FloatArray
    inner: FloatArray
    outer: FloatArray
    own_place: FloatArray
    inner_place: FloatArray
    outer_place: FloatArray
    axes: FloatArray
    structure: FloatArray
    numbers: FloatArray


def flat_table(table: LawTable) -> FlatTable:
    """Flatten a `LawTable`."""
    parts = (table.own, table.inner, table.outer)
    return FlatTable(
        own=table.own.coefficients,
        inner=table.inner.coefficients,
        outer=table.outer.coefficients,
        own_place=table.own.place,
        inner_place=table.inner.place,
        outer_place=table.outer.place,
        axes=np.array([part[2:] for part in parts]),
        structure=table.structure,
        numbers=np.array(table[4:]),
    )


@njit(cache=True, error_model="numpy")
def _law_table(flat: FlatTable) -> LawTable:
    """The `LawTable` again."""
    return LawTable(
        ApproachTable(flat.own, flat.own_place, *fixed_tuple(flat.axes[0], 6)),
        ApproachTable(flat.inner, flat.inner_place, *fixed_tuple(flat.axes[1], 6)),
        ApproachTable(flat.outer, flat.outer_place, *fixed_tuple(flat.axes[2], 6)),
        flat.structure,
        *fixed_tuple(flat.numbers, 9),
    )


@njit(cache=True, error_model="numpy")
def tabulate_law(
    law: FlatTable,
    workspace: FloatArray,
    conditions: FloatArray,
    nodes: FloatArray,
    buffer: FloatArray,
    cells: FloatArray,
    numbers: FloatArray,
    counts: IntArray,
) -> bool:
    """Collapse a law at its conditions, and fill a table with it.

    Parameters
    ----------
    law : FlatTable
        The law.
    workspace : array (4, n, 8)
        Workspace of the law.
    conditions : array (3,)
        u [m/s], T [K], q [N/m].
    nodes, buffer, cells, numbers
        The same as for `tabulate`.
    counts : array (4,)
        int64, counted up outside the map.

    Returns
    -------
    bool
        False if the film is not whole, or does not fit into a table.
    """
    table = _law_table(law)
    if abs(conditions[0]) < table.film_speed:
        return False
    point = collapse(table, workspace, conditions[0], conditions[1], conditions[2], counts)
    highest = min(point.highest_load * (1.0 + LOAD_TOLERANCE), point.held_load)
    return tabulate(point, nodes, buffer, cells, highest, numbers)
