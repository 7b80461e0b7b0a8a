"""Functions of the C library that nothing but other C code calls, for tests of each."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from ehdmaps.kernel.library import function
from ehdmaps.kernel.record import at
from ehdmaps.maps.kernels.memory_table import MemoryTable, called

POINTER, NUMBER, WHOLE = ctypes.c_void_p, ctypes.c_double, ctypes.c_int64


def flank_force(compression: float, rate: float, stiffness: float, damping: float) -> tuple[float, ...]:
    """Force of a flank [N], and its derivatives by compression [m] and by rate [m/s]."""
    out = np.empty(3)
    function("ehd_gear_flank", *[NUMBER] * 4, POINTER, result=None)(compression, rate, stiffness, damping, at(out))
    return tuple(out.tolist())


def eliminate(matrix: np.ndarray, right: np.ndarray) -> bool:
    """Gaussian elimination in place; the solution stands in `right`. False if singular or not finite."""
    return bool(function("ehd_eliminate", WHOLE, POINTER, POINTER)(right.size, at(matrix), at(right)))


def approach_at(table: MemoryTable, load: Any) -> tuple[Any, Any]:
    """Approach a [m] of loads w >= 0 [N/m], and da/dw = 1/k_s [m2/N]."""
    places = np.asarray(load, dtype=np.float64)
    out = np.empty((2, *places.shape))
    called("ehd_film_stretches")(table.address, places.size, at(np.ascontiguousarray(places)), at(out))
    return out[0][()], out[1][()]


def rate_of(h: float, last_h: float, change: Any, last: Any) -> tuple[Any, Any]:
    """x = G' [N/m] at the end of a step by the changes of G over it and over the last one, and dx/dG [1/s]."""
    one, other = np.broadcast_arrays(np.asarray(change, dtype=np.float64), np.asarray(last, dtype=np.float64))
    ends, begins = np.ascontiguousarray(one), np.ascontiguousarray(other)
    out = np.empty((2, *one.shape))
    called("ehd_film_squeezes")(h, last_h, one.size, at(ends), at(begins), at(out))
    return out[0][()], out[1][()]
