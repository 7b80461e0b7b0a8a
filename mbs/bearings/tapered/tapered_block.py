"""Bearings of tapered rollers, or between ribs, in compiled runs, by `ehdmaps/kernel/c/taper/taper_block.c`."""

from __future__ import annotations

import ctypes
from typing import Any, ClassVar

import numpy as np

from ehdmaps.kernel.record import numbers
from mbs.bearings.locating.locating_block import LocatingBlock, PairBlock, kind_of
from mbs.bearings.locating.locating_force import FASTEST
from mbs.bearings.tapered.kernel_structs import COLUMNS, TaperedData, data_of, functions
from mbs.bearings.tapered.line_film import NODES


class Tapered(PairBlock):
    """Bearings of rollers with ribs as C takes them, see `PairBlock`.

    Attributes
    ----------
    bearings : address of `TaperedData` (count,)
        What does not change of each.
    fastest : array (count,)
        Largest speed of the system [rad/s].
    loads : array (count, 2)
        Centrifugal load and gyroscopic moment over the square of the speed [N s2], [N m s2].
    rollers : array (count, longest, COLUMNS)
        What is known of each roller at the last answer, see `mbs.bearings.tapered.kernel_structs`.
    approaches : array (slices at most,)
        Work space.
    """

    _fields_ = (
        ("bearings", ctypes.c_void_p),
        *((name, numbers) for name in ("fastest", "loads", "rollers", "approaches")),
    )
    shapes: ClassVar = {
        **PairBlock.shapes,
        "fastest": ("count",),
        "loads": ("count", 2),
        "rollers": ("count", "longest", COLUMNS),
    }


class TaperedBlock(LocatingBlock):
    """The bearings of tapered rollers, or of rollers between ribs, of a run; see `LocatingBlock`.

    Parameters
    ----------
    members : sequence of Member
        Bearings, each a `LocatingElement` with a `TaperedForce`.
    """

    record, name, nodes, last_rows = Tapered, "ehd_taper_block", NODES, "rollers"

    def own(self) -> dict[str, Any]:
        """See `LocatingBlock.own`."""
        elements = self.elements
        own = [data_of(one.force.shape, one.force.dry_law.inner) for one in elements]
        self._kept = own, (TaperedData * len(own))(*own)
        spins = [(one.inner_spin, one.outer_spin, one.cage_turn) for one in elements]
        functions()  # which compares the structs
        return {
            "bearings": ctypes.addressof(self._kept[1]),
            "fastest": self.rows([FASTEST / max(*map(abs, each), 1e-12) for each in spins]),
            "loads": self.rows([one.force.speed_loads(*e[:2]) for one, e in zip(elements, spins, strict=True)], 2),
            "approaches": np.zeros(max((one.force.slices for one in elements), default=0)),
        }


TAPERED = kind_of(TaperedBlock)
"""For `mbs.transient.kinds`."""
