"""The bearing force while speed, temperature and centrifugal load change from call to call, in compiled code.

A whole table of the law costs as much as ten bearing forces, or a hundred with a centrifugal load; the slices of a
bearing lie in a tenth of its cells. So the law is collapsed at its new conditions, and only those cells are made where
slices are. As long as the conditions stay, later calls make what is still missing.
"""

from __future__ import annotations

from ehdmaps.arrays import ByteArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernel import collapse
from mbs.bearings.bearing_kernel import assemble
from mbs.bearings.flat_law import FlatTable, counted_load, law_table
from mbs.bearings.roller_motion import NOT_FINITE, Shape, Work, all_finite, check_motion, ring_motion, sizes_of
from mbs.bearings.slice_states import find_cells, read_states
from mbs.bearings.slice_table import (
    PreparedLaw,
    all_made,
    fill,
    is_placed,
    law_numbers,
    place_numbers,
    store_numbers,
)

NO_TABLE, CELLS_MISSING = -4, -5
"""Status where no table fits the law, and where slices are in cells that are not made yet."""


@njit(error_model="numpy")
def changed_force(
    law: FlatTable,
    workspace: FloatArray,
    conditions: FloatArray,
    nodes: FloatArray,
    counts: IntArray,
    marks: ByteArray,
    state: FloatArray,
    sizes: FloatArray,
    slices: FloatArray,
    angles: FloatArray,
    numbers: FloatArray,
    cells: FloatArray,
    knots: FloatArray,
    rows: IntArray,
    states: FloatArray,
    out: FloatArray,
) -> int:
    """Force, stiffness and damping at new conditions, or where `remade_force` misses cells.

    Parameters
    ----------
    law, workspace
        The same as for `mbs.bearings.flat_law.tabulate_law`.
    conditions : array (4,)
        u [m/s], at which the whole film is there, T [K], q [N/m], within the map; and zero where they are new, one
        after the first call that has an answer.
    nodes : array (4, NODES)
        Work space of `mbs.bearings.slice_table.fill`, kept from call to call.
    counts : array (4,)
        int64, for the law to count in.
    marks, state, sizes, slices, angles, numbers, cells, knots, rows, states, out
        The same as for `remade_force`.

    Returns
    -------
    int
        Status of `bearing_force`, or `NO_TABLE`.
    """
    if not all_finite(state):
        return NOT_FINITE
    shape = Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1])
    motion = ring_motion(state)
    wrong: int = check_motion(motion, shape.sizes)
    if wrong != 0:
        return wrong
    point = collapse(law_table(law), workspace, conditions[0], conditions[1], conditions[2], counts)
    if conditions[3] == 0.0:
        placed = place_numbers(point, counted_load(point))
        if not is_placed(placed):
            return NO_TABLE
        store_numbers(placed, numbers)
        marks[:] = 0
        conditions[3] = 1.0
    prepared = PreparedLaw(law_numbers(numbers), cells, knots)
    find_cells(motion, shape, prepared.numbers, rows, states[0])
    fill(point, prepared.numbers, rows.reshape(-1), nodes, marks, cells)
    read_states(motion, shape, prepared, Work(rows, states))
    return 1 if assemble(motion, shape, prepared.numbers, states, out) > 0 else 0


@njit(error_model="numpy")
def remade_force(
    marks: ByteArray,
    state: FloatArray,
    sizes: FloatArray,
    slices: FloatArray,
    angles: FloatArray,
    numbers: FloatArray,
    cells: FloatArray,
    knots: FloatArray,
    rows: IntArray,
    states: FloatArray,
    out: FloatArray,
) -> int:
    """Force, stiffness and damping at the conditions of the call before.

    Parameters
    ----------
    marks : array (2, NODES), of uint8
        Work space of `mbs.bearings.slice_table.fill`: which cells are made.
    state, sizes, slices, angles, numbers, cells, knots, rows, states, out
        The same as for `force_of_arrays`; numbers and cells are those of the call before.

    Returns
    -------
    int
        Status of `bearing_force`, or `CELLS_MISSING`, with `out` left alone.
    """
    if not all_finite(state):
        return NOT_FINITE
    shape = Shape(sizes_of(sizes), slices[0], slices[1], angles[0], angles[1])
    motion = ring_motion(state)
    wrong: int = check_motion(motion, shape.sizes)
    if wrong != 0:
        return wrong
    prepared = PreparedLaw(law_numbers(numbers), cells, knots)
    find_cells(motion, shape, prepared.numbers, rows, states[0])
    if not all_made(rows.reshape(-1), marks):
        return CELLS_MISSING
    read_states(motion, shape, prepared, Work(rows, states))
    return 1 if assemble(motion, shape, prepared.numbers, states, out) > 0 else 0
