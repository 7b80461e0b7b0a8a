"""Loads of the slices of a bearing at rest, from a prepared law, in compiled code.

Each kind of law finds its slices in its own way: a power law by its formula, tables by their cells. Above the load that
the law is held at, all go on along its tangent.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.maps.binary_cells import FIRST, SHIFT
from ehdmaps.maps.lines import FAST
from mbs.bearings.powers import power
from mbs.bearings.roller_motion import RingMotion, Shape, Work, roller_of
from mbs.bearings.slice_table import CELLS, LAST, POWER, ROWS, LawNumbers, PreparedLaw, read_cells

_NO_APPROACH = 1e-30


@njit(error_model="numpy", fastmath=FAST)
def find_cells(motion: RingMotion, shape: Shape, numbers: LawNumbers, rows: IntArray, places: FloatArray) -> None:
    """Row of the table of each slice, and the place in the cell.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    numbers : LawNumbers
        Centre and scale of the cells.
    rows : array (Z, n), of int
        Rows, written.
    places : array (Z, n)
        Places in the cells, written.
    """
    x, lost = shape.positions, shape.profile
    inverse = numbers.inverse_scale
    for j in range(rows.shape[0]):
        roller = roller_of(motion, shape, j)
        start, tilt = (roller.gap - numbers.centre) * inverse, roller.tilt * inverse
        row, place = rows[j], places[j]
        for i in range(x.size):
            z = start + x[i] * tilt - lost[i] * inverse
            a = 1.0 + abs(z)
            a = a if a < LAST else LAST
            cell = np.uint64(np.float64(a).view(np.uint64) >> SHIFT)
            t = a - np.uint64(cell << SHIFT).view(np.float64)
            place[i] = t if z >= 0.0 else -t
            row[i] = np.int64(cell) - FIRST + (0 if z >= 0.0 else ROWS)


@njit(error_model="numpy", fastmath=FAST)
def power_states(motion: RingMotion, shape: Shape, numbers: LawNumbers, states: FloatArray) -> None:
    """States of w = a delta^b with c = damping + damping_time dw; rollers without load are left out.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    numbers : LawNumbers
        The power law.
    states : array (4, Z, n)
        States of the slices, written.
    """
    x, lost = shape.positions, shape.profile
    a, b, damping, time = numbers.coefficient, numbers.exponent, numbers.damping, numbers.damping_time
    bend = time * (b - 1.0) / b
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        w, dw, c, dc = states[0, j], states[1, j], states[2, j], states[3, j]
        if roller.deepest <= 0.0:
            for i in range(x.size):
                w[i] = dw[i] = c[i] = dc[i] = 0.0
            continue
        for i in range(x.size):
            delta = roller.gap + x[i] * roller.tilt - lost[i]
            safe = delta if delta > _NO_APPROACH else _NO_APPROACH
            slope = a * b * power(safe, b - 1.0)
            dw[i] = slope if delta > 0.0 else 0.0
            w[i] = slope * safe / b if delta > 0.0 else 0.0
        for i in range(x.size):
            loaded = w[i] > 0.0
            c[i] = damping + time * dw[i] if loaded else 0.0
            # The second derivative of the power, from load and slope.
            dc[i] = bend * dw[i] * dw[i] / (w[i] if loaded else 1.0)


@njit(error_model="numpy", fastmath=FAST)
def find_knots(motion: RingMotion, shape: Shape, knots: FloatArray, rows: IntArray, places: FloatArray) -> None:
    """Cell between knots of each slice, and the place there, as `find_cells`.

    Parameters
    ----------
    motion, shape : RingMotion, Shape
        Motion of the ring, and the bearing.
    knots : array (2 ROWS,)
        Approaches at which cells begin [m].
    rows, places : array (Z, n)
        Written: cells, and places there [m].
    """
    x, lost = shape.positions, shape.profile
    last = knots.size - 2
    for j in range(rows.shape[0]):
        roller = roller_of(motion, shape, j)
        row, place = rows[j], places[j]
        found = 0
        for i in range(x.size):
            delta = roller.gap + x[i] * roller.tilt - lost[i]
            if delta <= knots[0]:
                row[i], place[i] = 0, 0.0
                continue
            if not knots[found] <= delta < knots[found + 1]:  # not that of the slice before
                low, high = 0, last + 1
                while high - low > 1:
                    middle = (low + high) // 2
                    if knots[middle] <= delta:
                        low = middle
                    else:
                        high = middle
                found = low
            row[i], place[i] = found, delta - knots[found]


@njit(error_model="numpy", fastmath=FAST)
def _hold(motion: RingMotion, shape: Shape, numbers: LawNumbers, states: FloatArray) -> None:
    """States on the tangent, for slices above the held load."""
    x, lost = shape.positions, shape.profile
    for j in range(shape.cos.size):
        roller = roller_of(motion, shape, j)
        if roller.deepest <= numbers.safe_approach:
            continue
        w, dw, c, dc = states[0, j], states[1, j], states[2, j], states[3, j]
        for i in range(x.size):
            above = roller.gap + x[i] * roller.tilt - lost[i] - numbers.held_approach
            if above > 0.0:
                w[i] = numbers.held_load + numbers.held_stiffness * above
                dw[i], c[i], dc[i] = numbers.held_stiffness / numbers.slope, numbers.held_damping, 0.0


@njit(error_model="numpy", fastmath=FAST)
def read_states(motion: RingMotion, shape: Shape, law: PreparedLaw, work: Work) -> None:
    """States of all slices at rest, from the rows of a table and the places there.

    Parameters
    ----------
    motion, shape, law
        The same as for `rest_states`.
    work : Work
        Rows, and places where the load is written; overwritten by the states.
    """
    read_cells(law.cells, work.rows.reshape(-1), work.states.reshape(4, -1))
    _hold(motion, shape, law.numbers, work.states)


@njit(error_model="numpy", fastmath=FAST)
def rest_states(motion: RingMotion, shape: Shape, law: PreparedLaw, work: Work) -> None:
    """States of all slices at rest.

    Parameters
    ----------
    motion : RingMotion
        Motion of the ring.
    shape : Shape
        The bearing.
    law : PreparedLaw
        Law of a roller between both raceways, at a speed and temperature.
    work : Work
        Work space, overwritten.
    """
    states, numbers = work.states, law.numbers
    if numbers.kind == POWER:
        power_states(motion, shape, numbers, states)
        _hold(motion, shape, numbers, states)
        return
    # The places lie where the load is written, at the same time as they are read.
    if numbers.kind == CELLS:
        find_cells(motion, shape, numbers, work.rows, states[0])
    else:
        find_knots(motion, shape, law.knots, work.rows, states[0])
    read_states(motion, shape, law, work)
