"""The contact law at one speed, temperature and centrifugal load, as a table that a bearing reads in nanoseconds.

The cells of the table are the binary digits of a = 1 + |z|, z = (delta - centre)/scale: 32 cells to each doubling of a.
So no logarithm is needed to find a cell; cells are fine around the valley of the damping, where the centre lies, and
coarse far from it. In each cell load and damping are cubics through the values and slopes of the law at its ends:
C1, and with slopes held so that the load never falls with the approach and the damping is never negative. Slices
differ from the law by some 1e-7 in load and 1e-5 in stiffness at most, a bearing by 1e-9 and 1e-7.

A cell follows from the law at its ends and, as slopes are held by what the neighbours carry, at the ends of these. So
each can be made alone: all of them at once for a law that stays, by `tabulate`; for a law that changes from call to
call only those where there are slices, by `fill`. Both give the same cells.

Below the lowest mapped speed only a part of the film is there: `fade` makes its table from the nodes of the whole one.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba.np.unsafe.ndarray import to_fixed_tuple

from ehdmaps.arrays import ByteArray, FloatArray, IntArray
from ehdmaps.compiled import COMPILES, njit
from ehdmaps.maps.kernels.bulk import rest_states
from ehdmaps.maps.kernels.kernel import full_state, structural_state
from ehdmaps.maps.kernels.lines import FAST, line_approach, line_state
from ehdmaps.maps.kernels.roller_balance import balanced_approach
from ehdmaps.maps.kernels.tables import Point, last_of, nodes_of, rows_of

fixed_tuple: Any = to_fixed_tuple if COMPILES else lambda values, size: tuple(values[:size])
"""The first numbers of an array as a tuple."""

ROWS = rows_of(14)
"""Rows of the table on each side of the centre."""

NODES = 2 * ROWS + 1
"""Number of the ends of cells."""

_ENDS = nodes_of(ROWS)

LAST = last_of(_ENDS)
"""The largest a that is in a cell."""

PLACES: FloatArray = np.concatenate((1.0 - _ENDS[:0:-1], _ENDS - 1.0))
"""Ends of all cells, as values of z, rising."""

_BY: FloatArray = np.diff(PLACES) ** -1.0
"""Inverse lengths of the cells, in the order of their ends."""

_UNKNOWN, _KNOWN, _WANTED = np.uint8(0), np.uint8(1), np.uint8(2)

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


@njit(error_model="numpy")
def law_numbers(numbers: FloatArray) -> LawNumbers:
    """The numbers of a law from an array (NUMBERS,) in their order."""
    return LawNumbers(*fixed_tuple(numbers, 15))


@njit(error_model="numpy")
def store_numbers(law: LawNumbers, numbers: FloatArray) -> None:
    """Write the numbers of a law into an array (NUMBERS,)."""
    for i in range(len(law)):
        numbers[i] = law[i]


@njit(error_model="numpy")
def unbounded() -> LawNumbers:
    """Numbers for states that are there already: whole slopes, loads of any size."""
    inf = math.inf
    return LawNumbers(POWER, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inf, inf, -inf, 1.0, inf, inf, 0.0, 0.0)


@njit(error_model="numpy", fastmath=FAST)
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


@njit(error_model="numpy")
def _centre(point: Point) -> float:
    """Approach around which the law is finest."""
    if point.centrifugal_load == 0.0:
        return point.own.offset
    load = line_state(point.inner, point.inner.offset)[0] + point.centrifugal_load
    approach: float = point.inner.offset + line_approach(point.outer, load)
    return approach


@njit(error_model="numpy")
def whole_approach(point: Point, load: float) -> float:
    """Approach at which a point with its whole film carries a load.

    Parameters
    ----------
    point : Point
        Law at a point.
    load : float
        [N/m]
    """
    approach: float = line_approach(point.own, load)
    if point.centrifugal_load > 0.0:
        approach = balanced_approach(point, load)
    return approach


@njit(error_model="numpy")
def nodes_up_to(centre: float, scale: float, approach: float) -> int:
    """Count the nodes that lie at or below an approach.

    Parameters
    ----------
    centre, scale, approach : float
        [m]
    """
    low, high = 0, PLACES.size
    while low < high:
        middle = (low + high) // 2
        if centre + PLACES[middle] * scale <= approach:
            low = middle + 1
        else:
            high = middle
    return low


@njit(error_model="numpy")
def place_numbers(point: Point, highest: float) -> LawNumbers:
    """Find where the cells of a point with its whole film lie, and the limits of its law.

    Parameters
    ----------
    point : Point
        Law at a point.
    highest : float
        Load above which slices are outside the map [N/m].

    Returns
    -------
    LawNumbers
        Numbers of a table; its `lift_off` is infinite if the nodes do not reach down to it.
    """
    centre, inverse = _centre(point), point.own.inverse_scale
    scale = 1.0 / inverse
    held, held_damping = point.held_approach, point.held_damping
    if point.film < 1.0:
        held = whole_approach(point, point.held_load)
        held_damping = full_state(point, held)[2] * point.held_load
    below = nodes_up_to(centre, scale, point.lift_off)
    most = held if point.held_load <= highest else whole_approach(point, highest)
    safe = max(nodes_up_to(centre, scale, most) - 1, 0)
    return LawNumbers(
        kind=CELLS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=centre,
        inverse_scale=inverse, highest=highest, safe_approach=centre + PLACES[safe] * scale,
        lift_off=centre + PLACES[below - 1] * scale if below > 0 else math.inf, slope=inverse,
        held_approach=held, held_load=point.held_load, held_stiffness=point.held_stiffness,
        held_damping=held_damping,
    )  # fmt: skip


@njit(error_model="numpy")
def is_placed(numbers: LawNumbers) -> bool:
    """Tell whether the nodes of a table reach down to lift-off."""
    return numbers.lift_off < math.inf


@njit(error_model="numpy")
def node_states(point: Point, numbers: LawNumbers, wanted: IntArray, nodes: FloatArray) -> None:
    """States of the whole film at some nodes.

    Above the first node beyond the hold the law goes on straight; up to it as if there were no hold.

    Parameters
    ----------
    point : Point
        Law at a point.
    numbers : LawNumbers
        What `place_numbers` gave for it.
    wanted : array (n,), of int
        Nodes, rising.
    nodes : array (4, NODES)
        Loads, slopes, damping and its slopes; written at these nodes.
    """
    centre, scale = numbers.centre, 1.0 / numbers.inverse_scale
    first = nodes_up_to(centre, scale, point.lift_off)
    end = min(nodes_up_to(centre, scale, numbers.held_approach) + 1, NODES)
    low, high = np.searchsorted(wanted, first), np.searchsorted(wanted, end)
    straight = 1 if high < wanted.size else 0
    delta, states = np.empty(high - low + straight), np.empty((4, high - low + straight))
    for i in range(delta.size):
        delta[i] = centre + PLACES[wanted[low + i] if low + i < high else end - 1] * scale
    rest_states(point, delta, states)
    for i in range(low):
        nodes[:, wanted[i]] = 0.0
    for k in range(4):
        for i in range(low, high):
            nodes[k, wanted[i]] = states[k, i - low]
    for i in range(high, wanted.size):
        ahead = centre + PLACES[wanted[i]] * scale - delta[-1]
        nodes[0, wanted[i]] = states[0, -1] + states[1, -1] * ahead
        nodes[1, wanted[i]], nodes[2, wanted[i]], nodes[3, wanted[i]] = states[1, -1], states[2, -1], 0.0


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _held_slopes(nodes: FloatArray, scale: float, i: int) -> tuple[float, float]:
    """Slopes of load and damping by z at a node, held so that neither falls below where it must not."""
    k, below, above = np.uint64(i), np.uint64(max(i - 1, 0)), np.uint64(min(i + 1, NODES - 1))
    w, c = nodes[0, k], nodes[2, k]
    # at the outermost nodes only one side holds them
    before = 3.0 * _BY[below] if i > 0 else 3.0 * _BY[k]
    after = 3.0 * _BY[k] if i < NODES - 1 else before
    slope, change = nodes[1, k] * scale, nodes[3, k] * scale
    rise, further = (w - nodes[0, below]) * before, (nodes[0, above] - w) * after
    slope = rise if i > 0 and rise < slope else slope
    slope = further if i < NODES - 1 and further < slope else slope
    most, least = c * before, -c * after
    change = most if i > 0 and most < change else change
    change = least if i < NODES - 1 and least > change else change
    return (slope if slope > 0.0 else 0.0), change


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _write_cell(nodes: FloatArray, scale: float, row: int, cells: FloatArray) -> None:
    """Cubics of a cell, over the distance from the end that is nearer to the centre."""
    upwards = row < ROWS
    first, other = (ROWS + row, ROWS + row + 1) if upwards else (NODES - 1 - row, NODES - 2 - row)
    (slope, bend), (far_slope, far_bend) = _held_slopes(nodes, scale, first), _held_slopes(nodes, scale, other)
    near, far, k = np.uint64(first), np.uint64(other), np.uint64(row)
    by = _BY[near] if upwards else -_BY[far]
    secant = (nodes[0, far] - nodes[0, near]) * by
    cells[k, np.uint64(0)], cells[k, np.uint64(1)] = nodes[0, near], slope
    cells[k, np.uint64(2)] = (3.0 * secant - 2.0 * slope - far_slope) * by
    cells[k, np.uint64(3)] = (slope + far_slope - 2.0 * secant) * by * by
    secant = (nodes[2, far] - nodes[2, near]) * by
    cells[k, np.uint64(4)], cells[k, np.uint64(5)] = nodes[2, near], bend
    cells[k, np.uint64(6)] = (3.0 * secant - 2.0 * bend - far_bend) * by
    cells[k, np.uint64(7)] = (bend + far_bend - 2.0 * secant) * by * by


@njit(error_model="numpy")
def all_made(rows: IntArray, marks: ByteArray) -> bool:
    """Tell whether the cells of some rows are made, see `fill`."""
    missing = 0
    for row in rows:
        # without the compiler a sum of bytes would be a byte, 0 again after 256 of them
        missing += 1 - int(marks[1, row])
    return missing == 0


@njit(error_model="numpy")
def fill(
    point: Point, numbers: LawNumbers, rows: IntArray, nodes: FloatArray, marks: ByteArray, cells: FloatArray
) -> None:
    """Make the cells of some rows that are not made yet.

    Parameters
    ----------
    point : Point
        Law at a point.
    numbers : LawNumbers
        What `place_numbers` gave for it.
    rows : array (n,), of int
        Rows, any number of times each.
    nodes : array (4, NODES)
        Loads, slopes, damping and its slopes at the nodes that are known; more of them after the call.
    marks : array (2, NODES), of uint8
        One at the nodes that are known and at the rows that are made; zeros for a new law.
    cells : array (2 ROWS, 8)
        Four coefficients of w, four of c, over the distance from the end of the cell that is nearer to the centre, in
        scales; written in these rows.
    """
    known, made = marks[0], marks[1]
    pending, count = np.empty(rows.size, dtype=np.int64), 0
    lowest, highest = NODES, 0
    for row in rows:
        if made[row] != _UNKNOWN:
            continue
        made[row] = _KNOWN
        pending[count] = row
        count += 1
        low = ROWS + row if row < ROWS else NODES - 2 - row
        begin, end = max(low - 1, 0), min(low + 3, NODES)
        lowest, highest = min(lowest, begin), max(highest, end)
        for i in range(begin, end):
            known[i] = _WANTED if known[i] == _UNKNOWN else known[i]
    if count == 0:
        return
    wanted, size = np.empty(highest - lowest, dtype=np.int64), 0
    for i in range(lowest, highest):
        if known[i] == _WANTED:
            known[i] = _KNOWN
            wanted[size] = i
            size += 1
    node_states(point, numbers, wanted[:size], nodes)
    scale = 1.0 / numbers.inverse_scale
    for i in range(count):
        _write_cell(nodes, scale, pending[i], cells)


@njit(error_model="numpy")
def tabulate(
    point: Point, nodes: FloatArray, marks: ByteArray, cells: FloatArray, highest: float, numbers: FloatArray
) -> bool:
    """Fill a table with the law of a point, with its whole film whatever part of it is there.

    Parameters
    ----------
    point : Point
        Law at a point.
    nodes, marks, cells
        The same as for `fill`; overwritten.
    highest : float
        Load above which slices are outside the map [N/m].
    numbers : array (NUMBERS,)
        Filled with `LawNumbers`.

    Returns
    -------
    bool
        False if the table does not reach down to lift-off.
    """
    law = place_numbers(point, highest)
    store_numbers(law, numbers)
    if not is_placed(law):
        return False
    marks[:] = _UNKNOWN
    fill(point, law, np.arange(2 * ROWS), nodes, marks, cells)
    return True


WHOLE, DRY, RISE, LOADS, SLOPES, DAMPINGS, BENDS = range(7)
"""Columns of the nodes of a faded film: approach with the whole film and without [m], growth of the latter by the
former; load [N/m] and damping [N s/m2], each with its slope by the approach with the whole film."""


@njit(error_model="numpy")
def write_film(point: Point, nodes: FloatArray, out: FloatArray, highest: float, numbers: FloatArray) -> bool:
    """Nodes of a film of which only a part is there: what holds for every part of it.

    At equal load the approach is that part of the one with the whole film, and the rest of that without any, see
    `ehdmaps.maps.kernels.kernel`. So the nodes of a whole film serve all parts, as knots that move.

    Parameters
    ----------
    point : Point
        Law at a point.
    nodes : array (4, NODES)
        Work space, overwritten.
    out : array (2 ROWS, 8)
        Filled: columns `WHOLE` to `BENDS` of all nodes but the outermost; the held load in the last row.
    highest : float
        Load above which slices are outside the map [N/m].
    numbers : array (NUMBERS,)
        Filled with `LawNumbers`, if the nodes fit; `lift_off` and `safe_approach` are the numbers of their nodes.
    """
    whole = place_numbers(point, highest)
    centre, scale = whole.centre, 1.0 / whole.inverse_scale
    first = nodes_up_to(centre, scale, point.lift_off)
    if first < 2:
        return False
    node_states(point, whole, np.arange(NODES), nodes)
    w, dw, c, dc = nodes[0], nodes[1], nodes[2], nodes[3]
    safe, most, last = 0, min(highest, point.held_load), out.shape[0] - 1
    structure, q = point.structure, point.centrifugal_load
    for i in range(last):
        k = i + 1
        dry, compliance = structural_state(structure, q, w[k])
        out[i, WHOLE], out[i, DRY], out[i, RISE] = centre + PLACES[k] * scale, dry, compliance * dw[k]
        out[i, LOADS], out[i, SLOPES], out[i, DAMPINGS], out[i, BENDS] = w[k], dw[k], c[k], dc[k]
        if w[k] <= most:
            safe = i
    dry, _ = structural_state(structure, q, point.held_load)
    out[last, WHOLE], out[last, DRY] = whole.held_approach, dry
    out[last, LOADS], out[last, DAMPINGS] = point.held_load, whole.held_damping
    law = LawNumbers(
        kind=KNOTS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=0.0, inverse_scale=0.0,
        highest=highest, safe_approach=float(safe), lift_off=float(first - 2), slope=1.0, held_approach=0.0,
        held_load=point.held_load, held_stiffness=point.held_stiffness, held_damping=0.0,
    )  # fmt: skip
    store_numbers(law, numbers)
    return True


@njit(error_model="numpy", fastmath=FAST)
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
    whole = law_numbers(given)
    faded = LawNumbers(
        kind=KNOTS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=0.0, inverse_scale=0.0,
        highest=whole.highest, safe_approach=knots[int(whole.safe_approach)], lift_off=knots[int(whole.lift_off)],
        slope=1.0, held_approach=rest * film[last, DRY] + part * film[last, WHOLE], held_load=whole.held_load,
        held_stiffness=whole.held_stiffness, held_damping=part * film[last, DAMPINGS],
    )  # fmt: skip
    store_numbers(faded, numbers)
