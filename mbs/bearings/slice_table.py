"""Tables of a contact law at one speed, temperature and centrifugal load, which a bearing reads in nanoseconds.

They are made in C, see `cylinder_law.h` of `ehdmaps.kernel`: what their cells are, and their numbers. Slices differ
from the law by some 1e-7 in load and 1e-5 in stiffness at most, a bearing by 1e-9 and 1e-7.
"""

from __future__ import annotations

from typing import NamedTuple

from ehdmaps.maps.kernels.tables import last_of, nodes_of, rows_of

ROWS = rows_of(14)
"""Rows of the table on each side of the centre."""

NODES = 2 * ROWS + 1
"""Number of the ends of cells."""

LAST = last_of(nodes_of(ROWS))
"""The largest a that is in a cell."""

POWER, CELLS, KNOTS, BY_SLICES = 0.0, 1.0, 2.0, 3.0
"""Kinds of prepared laws: a formula; cells at even places around a centre; cells between knots, for faded films; and
the law itself for each slice, where no table reaches down to lift-off."""


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
