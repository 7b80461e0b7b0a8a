"""A law in few flat arrays, as compiled code takes it from Python, and its tables at a speed, temperature and load."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.arrays import ByteArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernel import LOAD_TOLERANCE, collapse
from ehdmaps.maps.tables import ApproachTable, LawTable, Point
from mbs.bearings.faded_table import write_film
from mbs.bearings.laws import Law
from mbs.bearings.slice_table import fixed_tuple, tabulate

if TYPE_CHECKING:
    from ehdmaps.maps.law import ContactLaw


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


class FlatLaw:
    """A law, and its table flat for compiled code; with the single contacts only where they are needed.

    Parameters
    ----------
    law : Law
        Law of a roller between both raceways.
    """

    def __init__(self, law: Law) -> None:
        self.law = law
        self._made: dict[bool, tuple[FlatTable, FloatArray]] = {}

    def arrays(self, law: ContactLaw, centrifugal: bool) -> tuple[FlatTable, FloatArray]:
        """Flat table of `law`, and work space for it."""
        if centrifugal not in self._made:
            whole = law.table if centrifugal else law.plain_table
            width = max(part.coefficients.shape[2] for part in (whole.own, whole.inner, whole.outer))
            self._made[centrifugal] = flat_table(whole), np.empty((4, width // 2, 8))
        return self._made[centrifugal]


@njit(error_model="numpy")
def law_table(flat: FlatTable) -> LawTable:
    """The `LawTable` of a flat one again."""
    return LawTable(
        ApproachTable(flat.own, flat.own_place, *fixed_tuple(flat.axes[0], 6)),
        ApproachTable(flat.inner, flat.inner_place, *fixed_tuple(flat.axes[1], 6)),
        ApproachTable(flat.outer, flat.outer_place, *fixed_tuple(flat.axes[2], 6)),
        flat.structure,
        *fixed_tuple(flat.numbers, 9),
    )


@njit(error_model="numpy")
def counted_load(point: Point) -> float:
    """Load above which slices are outside the map [N/m]."""
    load: float = point.highest_load * (1.0 + LOAD_TOLERANCE)
    return load


@njit(error_model="numpy")
def tabulate_law(
    law: FlatTable,
    workspace: FloatArray,
    conditions: FloatArray,
    nodes: FloatArray,
    marks: ByteArray,
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
    nodes, marks, cells, numbers
        The same as for `tabulate`; with a faded film cells are filled with the nodes that `fade` takes, which are the
        same at all speeds.
    counts : array (4,)
        int64, counted up outside the map.

    Returns
    -------
    bool
        False if the law does not fit into a table.
    """
    table = law_table(law)
    point = collapse(table, workspace, conditions[0], conditions[1], conditions[2], counts)
    highest = counted_load(point)
    if abs(conditions[0]) < table.film_speed:
        return write_film(point, nodes, cells, highest, numbers)
    return tabulate(point, nodes, marks, cells, highest, numbers)
