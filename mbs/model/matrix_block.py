"""Connections by matrices in compiled runs. Their functions are in `ehdmaps/kernel/c/run/matrix.c`."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.model.blocks import Kind, Member, SteadyBlock
from mbs.model.matrices import MatrixElement


class Matrices(Record):
    """Connections by matrices as C takes them.

    Attributes
    ----------
    count, longest : int
        How many connections, and speeds of the longest table.
    firsts, places, counts : array (count,), of int
        First of what each feels, its place among all elements, and the number of its speeds.
    speeds : array (count, longest)
        Speeds of the tables [rad/s].
    tables : array (count, longest, 2, 6, 6)
        Stiffness and damping.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("count", "longest")),
        *((name, integers) for name in ("firsts", "places", "counts")),
        *((name, numbers) for name in ("speeds", "tables")),
    )
    shapes: ClassVar = {
        **dict.fromkeys(("firsts", "places", "counts"), ("count",)),
        "speeds": ("count", "longest"),
        "tables": ("count", "longest", 72),
    }


def _gather(members: Sequence[Member]) -> SteadyBlock:
    """Data of some connections; tables as long as the longest."""
    elements: list[MatrixElement] = [member.element for member in members]
    longest = max((element.speeds.size for element in elements), default=1)
    speeds, tables = np.zeros((len(elements), longest)), np.zeros((len(elements), longest, 2, 6, 6))
    for index, element in enumerate(elements):
        count = element.speeds.size
        speeds[index, :count] = element.speeds
        tables[index, :count, 0], tables[index, :count, 1] = element.stiffness, element.damping
    firsts, places = (np.array([getattr(m, key) for m in members], dtype=np.int64) for key in ("first", "place"))
    return SteadyBlock(
        checked(Matrices, "ehd_matrix_block")(
            count=len(elements),
            longest=longest,
            firsts=firsts,
            places=places,
            counts=np.array([element.speeds.size for element in elements], dtype=np.int64),
            speeds=speeds,
            tables=tables,
        )
    )


def _all_six(element: MatrixElement) -> FloatArray:
    """All displacements of the port."""
    return np.eye(6)


MATRICES = Kind(answer="ehd_matrix_block_answer", feels=_all_six, gather=_gather, powers="ehd_matrix_block_powers")
"""For `mbs.transient.kinds`."""
