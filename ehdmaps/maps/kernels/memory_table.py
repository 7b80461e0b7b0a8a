"""A contact whose film has a memory, as a table at one speed and temperature.

A film answers a change of load with a delay. Its state is xi, the approach at which it would be in equilibrium; the
load of that equilibrium is p(xi). Approach and load w of the contact are

    delta = a(w) + y(p),          w = x + sqrt(x^2 + p^2),    x = G',    dG/dxi = C = c k_s/(k_s - k).

a is what answers at once: the structure, and the little by which oil that cannot leave the inlet stiffens it,
da/dw = 1/k_s. y is what follows: y(p) = xi - a(p), so that at rest w = p and delta = xi, the law of the map. To first
order w = p + x, and a small oscillation sees k + i omega c/(1 + i omega c/(k_s - k)): k and c of the map at low
frequency, k_s at high frequency. w follows the exact load of rigid rollers that are squeezed while they roll
(x + sqrt(x^2 + p^2) within 3 %), is never a tension, and rises with x.

Why it is passive: a and y rise with their arguments (k_s > k > 0), and w - p has the sign of x, which is that of p'.
So the work is w da + p dy + (w - p) dy: the first two are stored, the last one is never negative. Taken by backward
Euler, or by any rate x with the sign of the change of G, this holds for steps of any size.

The table has p, y and G over xi in cells which are the binary digits of 1 + |z|, z = (xi - centre)/scale, and a over w
in cells which are those of 1 + w/`LIGHTEST`: no logarithm is needed to find one. All are cubics through values and
slopes that rise. The equations are in `ehdmaps/kernel/c/film/film.c`.

The stiffness k_s of the locked film and its bound: `ehdmaps.maps.kernels.locked_film`.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import function
from ehdmaps.kernel.record import at
from ehdmaps.maps.kernels.tables import rows_of

LIGHTEST = 1.0
"""Load up to which the cells of a over w are even [N/m]."""

ROWS, LOAD_ROWS = rows_of(14), rows_of(24)
"""Cells on each side of the centre, and of the load."""

_HEAD, _CELL, _LOAD_CELL = 5, 12, 4
_FIRST_LOAD = _HEAD + 2 * ROWS * _CELL

NUMBERS = _FIRST_LOAD + LOAD_ROWS * _LOAD_CELL
"""How many numbers a table has."""


class MemoryTable:
    """A contact with memory at one speed and temperature.

    Parameters
    ----------
    numbers : array (NUMBERS,)
        An `ehd_film_table` of `ehdmaps/kernel/c/film/film.h`: numbers alone.

    Attributes
    ----------
    numbers : array (NUMBERS,)
        The same.
    address : int
        Address of the numbers, for `ctypes.c_void_p`.
    """

    __slots__ = ("address", "numbers")

    def __init__(self, numbers: FloatArray) -> None:
        self.numbers, self.address = numbers, at(numbers)

    def __reduce__(self) -> tuple[Any, ...]:
        return MemoryTable, (self.numbers,)

    @property
    def centre(self) -> float:
        """Centre of the cells [m]."""
        return float(self.numbers[0])

    @property
    def inverse_scale(self) -> float:
        """Inverse scale of the cells [1/m]."""
        return float(self.numbers[1])

    @property
    def lift_off(self) -> float:
        """Highest end of a cell without load [m]: below it nothing changes, load and slopes are zero there."""
        return float(self.numbers[2])

    @property
    def highest(self) -> float:
        """Load above which slices are outside the map [N/m]."""
        return float(self.numbers[3])

    @property
    def cells(self) -> FloatArray:
        """Cubics over the distance in scales from the end of a cell that is nearer to the centre, (2 ROWS, 12).

        Four coefficients of p [N/m], of y [m] and of G [N s/m2].
        """
        return self.numbers[_HEAD:_FIRST_LOAD].reshape(2 * ROWS, _CELL)

    @property
    def load_cells(self) -> FloatArray:
        """Cubics of a [m] over the distance from the lower end of a cell, in `LIGHTEST`, (LOAD_ROWS, 4)."""
        return self.numbers[_FIRST_LOAD:].reshape(LOAD_ROWS, _LOAD_CELL)


def equilibrium_at(table: MemoryTable, approach: npt.ArrayLike) -> tuple[Any, ...]:
    """p [N/m], y [m] and G [N s/m2] of films in equilibrium, each with its slope by the approach.

    Parameters
    ----------
    table : MemoryTable
        The contact.
    approach : float or array
        [m].

    Returns
    -------
    p, dp, y, dy, G, dG : float or array
        Values and slopes in the shape of the approaches.
    """
    array = np.asarray(approach, dtype=np.float64)
    flat = np.ascontiguousarray(array).reshape(-1)
    out = np.empty((6, flat.size))
    called("ehd_film_equilibria")(table.address, flat.size, at(flat), at(out))
    return tuple(row.reshape(array.shape)[()] for row in out)


_POINTER, _NUMBER, _COUNT = ctypes.c_void_p, ctypes.c_double, ctypes.c_int64

_ARGUMENTS: dict[str, tuple[Any, ...]] = {
    "ehd_film_fill": (_POINTER,) * 4,
    "ehd_film_factors": (_POINTER, _COUNT, _POINTER, _POINTER),
    "ehd_film_equilibria": (_POINTER, _COUNT, _POINTER, _POINTER),
    "ehd_film_stretches": (_POINTER, _COUNT, _POINTER, _POINTER),
    "ehd_film_steps": (_POINTER, _NUMBER, _NUMBER, _COUNT, *(_POINTER,) * 4),
    "ehd_film_squeezes": (_NUMBER, _NUMBER, _COUNT, *(_POINTER,) * 3),
    "ehd_film_energies": (_POINTER, _COUNT, *(_POINTER,) * 3),
    "ehd_film_spent": (_POINTER, _COUNT, *(_POINTER,) * 5),
    "ehd_film_locked": (_POINTER, _COUNT, *(_POINTER,) * 4),
    "ehd_film_stiff": (_POINTER, _NUMBER, _COUNT, *(_POINTER,) * 7),
    "ehd_film_fits": (_POINTER, _NUMBER, _NUMBER, _COUNT, _POINTER, _COUNT, *(_POINTER,) * 4),
}
"""Arguments of the functions of `film_arrays.c` and `film_fit.c` in `ehdmaps/kernel/c/film`."""


@functools.cache
def called(name: str) -> Callable[..., Any]:
    """Return a function of `film_arrays.c` or `film_fit.c`, which returns nothing."""
    if function("ehd_film_table_size", result=ctypes.c_size_t)() != 8 * NUMBERS:
        raise AssertionError("ehd_film_table of ehdmaps/kernel/c/film/film.h has not NUMBERS numbers")
    return function(name, *_ARGUMENTS[name], result=None)
