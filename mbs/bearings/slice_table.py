"""The contact law at one speed, temperature and centrifugal load, as a table that a bearing reads in nanoseconds.

The cells of the table are the binary digits of a = 1 + |z|, z = (delta - centre)/scale: 32 cells to each doubling of a.
So no logarithm is needed to find a cell; cells are fine around the valley of the damping, where the centre lies, and
coarse far from it. In each cell load and damping are cubics through the values and slopes of the law at its ends:
C1, and with slopes held so that the load never falls with the approach and the damping is never negative. Slices
differ from the law by some 1e-7 in load and 1e-5 in stiffness at most, a bearing by 1e-9 and 1e-7.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numba.np.unsafe.ndarray import to_fixed_tuple

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.maps.binary_cells import last_of, nodes_of, rows_of
from ehdmaps.maps.bulk import rest_states
from ehdmaps.maps.kernel import LOAD_TOLERANCE, collapse, full_state, structural_state
from ehdmaps.maps.lines import FAST, line_approach, line_state
from ehdmaps.maps.tables import ApproachTable, LawTable, Point

fixed_tuple: Any = to_fixed_tuple
"""The first numbers of an array as a tuple, in compiled code."""

ROWS = rows_of(14)
"""Rows of the table on each side of the centre."""

NODES = nodes_of(ROWS)
"""Ends of the cells, as values of a."""

LAST = last_of(NODES)

POWER, CELLS, KNOTS = 0.0, 1.0, 2.0
"""Kinds of prepared laws: a formula; cells at even places around a centre; cells between knots, for faded films."""


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
        Up to it no slice is, nor above the held load [m].
    lift_off : float
        Up to it there is no load [m].
    slope : float
        What slopes are multiplied by.
    held_approach, held_load, held_stiffness, held_damping : float
        Approach [m] and load [N/m] above which the law is the tangent with this stiffness [N/m2] and damping [N s/m2].
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
    held_approach: float
    held_load: float
    held_stiffness: float
    held_damping: float


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
    knots : array (2 ROWS,)
        Approaches at which the cells begin [m], the last one infinite; anything but for KNOTS.
    """

    numbers: LawNumbers
    cells: FloatArray
    knots: FloatArray


@njit(cache=True, error_model="numpy")
def law_numbers(numbers: FloatArray) -> LawNumbers:
    """The numbers of a law from an array (NUMBERS,) in their order."""
    return LawNumbers(*fixed_tuple(numbers, 15))


@njit(cache=True, error_model="numpy")
def store_numbers(found: LawNumbers, numbers: FloatArray) -> None:
    """Write the numbers of a law into an array (NUMBERS,)."""
    for i in range(len(found)):
        numbers[i] = found[i]


@njit(cache=True, error_model="numpy")
def unbounded() -> LawNumbers:
    """Numbers for states that are there already: whole slopes, loads of any size."""
    inf = math.inf
    return LawNumbers(POWER, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inf, inf, -inf, 1.0, inf, inf, 0.0, 0.0)


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
def _node_states(point: Point, nodes: FloatArray, buffer: FloatArray) -> tuple[int, int, float, float]:
    """Places z, approaches and states of the whole film at all nodes, into rows of the buffer.

    Above the first node beyond the hold the law goes on straight; up to it as if there were no hold. Returned are the
    first loaded node, the end of those that are the law's, and approach and damping of the held load.
    """
    rows = nodes.size - 1
    centre, inverse, own = _centre(point), point.own.inverse_scale, point.own
    z, delta, w, dw, c, dc = buffer[0], buffer[1], buffer[2], buffer[3], buffer[4], buffer[5]
    held = line_approach(own, point.held_load)
    if point.centrifugal_load > 0.0:
        held = line_approach(point.inner, point.held_load)
        held += line_approach(point.outer, point.held_load + point.centrifugal_load)
    first, end = 0, 0
    for i in range(2 * rows + 1):
        z[i] = nodes[i - rows] - 1.0 if i >= rows else 1.0 - nodes[rows - i]
        delta[i] = centre + z[i] / inverse
        if delta[i] <= point.lift_off:
            first = i + 1
            w[i] = dw[i] = c[i] = dc[i] = 0.0
        if i > 0 and delta[i - 1] <= held:
            end = i + 1
    rest_states(point, delta[first:end], buffer[2:6, first:end])
    for i in range(end, 2 * rows + 1):
        w[i] = w[end - 1] + dw[end - 1] * (delta[i] - delta[end - 1])
        dw[i], c[i], dc[i] = dw[end - 1], c[end - 1], 0.0
    _, _, ratio, _ = full_state(point, held)
    return first, end, held, ratio * point.held_load


@njit(cache=True, error_model="numpy")
def tabulate(
    point: Point, nodes: FloatArray, buffer: FloatArray, cells: FloatArray, highest: float, numbers: FloatArray
) -> bool:
    """Fill a table with the law of a point, with its whole film whatever part of it is there.

    Parameters
    ----------
    point : Point
        Law at a point.
    nodes : array (ROWS + 1,)
        `NODES`.
    buffer : array (6, 2 ROWS + 1)
        Places z, approaches, loads, slopes, damping and its slopes at the nodes; filled.
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
    first, _, held, held_damping = _node_states(point, nodes, buffer)
    if first == 0:
        return False
    inverse = point.own.inverse_scale
    z, delta, w, dw, c, dc = buffer[0], buffer[1], buffer[2], buffer[3], buffer[4], buffer[5]
    safe, most = delta[0], min(highest, point.held_load)
    for i in range(delta.size):
        if w[i] <= most:
            safe = delta[i]
    found = LawNumbers(
        kind=CELLS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=_centre(point),
        inverse_scale=inverse, highest=highest, safe_approach=safe, lift_off=delta[first - 1], slope=inverse,
        held_approach=held, held_load=point.held_load, held_stiffness=point.held_stiffness, held_damping=held_damping,
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


WHOLE, DRY, RISE, LOADS, SLOPES, DAMPINGS, BENDS = range(7)
"""Columns of the nodes of a faded film: approach with the whole film and without [m], growth of the latter by the
former; load [N/m] and damping [N s/m2], each with its slope by the approach with the whole film."""


@njit(cache=True, error_model="numpy")
def write_film(
    point: Point, nodes: FloatArray, buffer: FloatArray, out: FloatArray, highest: float, numbers: FloatArray
) -> bool:
    """Nodes of a film of which only a part is there: what holds for every part of it.

    At equal load the approach is that part of the one with the whole film, and the rest of that without any, see
    `ehdmaps.maps.kernel`. So the nodes of `tabulate` serve all parts, as knots that move.

    Parameters
    ----------
    point : Point
        Law at a point.
    nodes, buffer
        The same as for `tabulate`.
    out : array (2 ROWS, 8)
        Filled: columns `WHOLE` to `BENDS` of all nodes but the outermost; the held load in the last row.
    highest : float
        Load above which slices are outside the map [N/m].
    numbers : array (NUMBERS,)
        Filled with `LawNumbers`, if the nodes fit; `lift_off` and `safe_approach` are the numbers of their nodes.
    """
    first, _, held, held_damping = _node_states(point, nodes, buffer)
    if first < 2:
        return False
    delta, w, dw, c, dc = buffer[1], buffer[2], buffer[3], buffer[4], buffer[5]
    safe, most, last = 0, min(highest, point.held_load), out.shape[0] - 1
    structure, q = point.structure, point.centrifugal_load
    for i in range(last):
        k = i + 1
        dry, compliance = structural_state(structure, q, w[k])
        out[i, WHOLE], out[i, DRY], out[i, RISE] = delta[k], dry, compliance * dw[k]
        out[i, LOADS], out[i, SLOPES], out[i, DAMPINGS], out[i, BENDS] = w[k], dw[k], c[k], dc[k]
        if w[k] <= most:
            safe = i
    dry, _ = structural_state(structure, q, point.held_load)
    out[last, WHOLE], out[last, DRY], out[last, LOADS], out[last, DAMPINGS] = held, dry, point.held_load, held_damping
    found = LawNumbers(
        kind=KNOTS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=0.0, inverse_scale=0.0,
        highest=highest, safe_approach=float(safe), lift_off=float(first - 2), slope=1.0, held_approach=0.0,
        held_load=point.held_load, held_stiffness=point.held_stiffness, held_damping=0.0,
    )  # fmt: skip
    store_numbers(found, numbers)
    return True


@njit(cache=True, error_model="numpy", fastmath=FAST)
def fade(
    film: FloatArray, given: FloatArray, part: float, cells: FloatArray, knots: FloatArray, numbers: FloatArray
) -> None:
    """The table of a part of a film, from the nodes of the film.

    Parameters
    ----------
    film, given : array (2 ROWS, 8), (NUMBERS,)
        What `write_film` wrote.
    part : float
        Part of the film that is there, 0 to 1.
    cells, knots : array (2 ROWS, 8), (2 ROWS,)
        Filled: coefficients as of `tabulate`, over the distance from the lower end of a cell [m]; where
        cells begin [m].
    numbers : array (NUMBERS,)
        Filled with `LawNumbers`.
    """
    last, rest = film.shape[0] - 1, 1.0 - part
    slopes, bends = np.empty(last), np.empty(last)
    for i in range(last):
        knots[i] = rest * film[i, DRY] + part * film[i, WHOLE]
        stretch = rest * film[i, RISE] + part
        loaded = film[i, LOADS] > 0.0
        slopes[i] = film[i, SLOPES] / (stretch if loaded else 1.0)
        bends[i] = part * film[i, BENDS] / (stretch if loaded else 1.0)
    knots[last] = math.inf
    for i in range(last - 1):
        h = knots[i + 1] - knots[i]
        # Without film all nodes without load are one.
        rise = 3.0 * (film[i + 1, LOADS] - film[i, LOADS]) / h if h > 0.0 else 0.0
        slopes[i], slopes[i + 1] = min(slopes[i], rise), min(slopes[i + 1], rise)
        if h > 0.0:
            bends[i] = max(bends[i], -3.0 * part * film[i, DAMPINGS] / h)
            bends[i + 1] = min(bends[i + 1], 3.0 * part * film[i + 1, DAMPINGS] / h)
    for i in range(last - 1):
        h, cell = knots[i + 1] - knots[i], cells[i]
        by = 1.0 / h if h > 0.0 else 0.0
        secant = (film[i + 1, LOADS] - film[i, LOADS]) * by
        cell[0], cell[1] = film[i, LOADS], slopes[i]
        cell[2] = (3.0 * secant - 2.0 * slopes[i] - slopes[i + 1]) * by
        cell[3] = (slopes[i] + slopes[i + 1] - 2.0 * secant) * by * by
        secant = part * (film[i + 1, DAMPINGS] - film[i, DAMPINGS]) * by
        cell[4], cell[5] = part * film[i, DAMPINGS], bends[i]
        cell[6] = (3.0 * secant - 2.0 * bends[i] - bends[i + 1]) * by
        cell[7] = (bends[i] + bends[i + 1] - 2.0 * secant) * by * by
    for k in range(8):
        for i in range(last - 1, last + 1):
            cells[i, k] = 0.0
    found = law_numbers(given)
    faded = LawNumbers(
        kind=KNOTS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=0.0, inverse_scale=0.0,
        highest=found.highest, safe_approach=knots[int(found.safe_approach)], lift_off=knots[int(found.lift_off)],
        slope=1.0, held_approach=rest * film[last, DRY] + part * film[last, WHOLE], held_load=found.held_load,
        held_stiffness=found.held_stiffness, held_damping=part * film[last, DAMPINGS],
    )  # fmt: skip
    store_numbers(faded, numbers)


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
    """Collapse a law at its conditions, and fill a table with it; below the lowest speed nodes of a faded film.

    Parameters
    ----------
    law : FlatTable
        The law.
    workspace : array (4, n, 8)
        Workspace of the law.
    conditions : array (3,)
        u [m/s], T [K], q [N/m].
    nodes, buffer, cells, numbers
        The same as for `tabulate`; with a faded film cells are filled with the nodes that
        `fade` takes, which are the same at all speeds.
    counts : array (4,)
        int64, counted up outside the map.

    Returns
    -------
    bool
        False if the law does not fit into a table.
    """
    table = _law_table(law)
    point = collapse(table, workspace, conditions[0], conditions[1], conditions[2], counts)
    highest = point.highest_load * (1.0 + LOAD_TOLERANCE)
    if abs(conditions[0]) < table.film_speed:
        return write_film(point, nodes, buffer, cells, highest, numbers)
    return tabulate(point, nodes, buffer, cells, highest, numbers)
