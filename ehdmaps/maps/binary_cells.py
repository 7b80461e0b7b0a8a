"""Cells of a table that are the binary digits of a number a >= 1: 32 to each doubling, found without a logarithm.

Cells are fine where a is near 1, and as wide as they are far from it. The digits of a above `SHIFT` are the number of
its cell, those below its place there.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray

_BITS = 5

SHIFT = np.uint64(52 - _BITS)
"""Binary digits of a double that are the place in a cell."""

FIRST = np.int64(np.float64(1.0).view(np.int64) >> (52 - _BITS))
"""Number of the cell that begins at 1."""


def rows_of(octaves: int) -> int:
    """Number of cells up to a = 2^octaves."""
    return octaves << _BITS


def nodes_of(rows: int) -> FloatArray:
    """Ends of so many cells, shape (rows + 1,), as values of a from 1 on."""
    nodes: FloatArray = ((FIRST + np.arange(rows + 1)) << np.int64(52 - _BITS)).view(np.float64)
    return nodes


def last_of(nodes: FloatArray) -> float:
    """The largest a that is still in a cell."""
    return float(np.nextafter(nodes[-1], 0.0))
