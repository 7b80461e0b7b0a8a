"""Films with memory for other programs: a contact law that goes from step to step, with a state for each slice.

::

    at = law.at(entrainment_speed=1.7, temperature=313.15)
    state = at.memory.settled(delta)
    for delta in course:
        w, dw_ddelta, state = at.memory.advance(state, delta, dt)

The equations are in `ehdmaps.maps.kernels.memory_table`. `ContactLaw.advance` takes speed and temperature at each call.

The work on a contact is w da + p dy + (w - p) dy. The first two terms are stored: they depend on the load w and the
state xi alone. The last one is taken up for good. This holds at one speed and temperature.
"""

from __future__ import annotations

import ctypes
import functools
import math
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, at, numbers
from ehdmaps.maps.kernels.law_in_c import with_point
from ehdmaps.maps.kernels.locked_film import LockedFactors, film_of, geometry_of
from ehdmaps.maps.kernels.memory_table import NUMBERS, ROWS, MemoryTable, called, equilibrium_at
from ehdmaps.maps.kernels.tables import Point
from ehdmaps.physics.contact import LineContact


@dataclass(frozen=True, eq=False)
class FilmState:
    """States of films, of any shape.

    Attributes
    ----------
    approach : array
        Approach at which each film would be in equilibrium [m].
    change : array
        What the last step changed in its squeezing G [N s/m2], see `ehdmaps.maps.kernels.memory_table`.
    load : array
        Load at the end of the last step [N/m].
    step : float
        Length of the last step [s]; 0 after a rest.
    """

    approach: FloatArray
    change: FloatArray
    load: FloatArray
    step: float = 0.0


class FilmMemory:
    """A contact law with memory at one speed and temperature.

    Parameters
    ----------
    point : Point
        The law without memory: at rest both are alike, and at low frequency.
    contacts : sequence of LineContact
        What is in series.
    entrainment_speed : float
        u [m/s], of either sign.
    factors : LockedFactors
        Factors of the closed formula of the locked film.
    check : callable
        Is told the loads of each step [N/m]; it may raise for those above the map.

    Raises
    ------
    InputError
        With a centrifugal load: films with memory take none.
    """

    def __init__(
        self,
        point: Point,
        contacts: Sequence[LineContact],
        entrainment_speed: float,
        factors: LockedFactors,
        check: Callable[[FloatArray], None],
    ) -> None:
        if point.centrifugal_load != 0.0:
            raise InputError(
                f"film memory, centrifugal_load: got {point.centrifugal_load:.6g} N/m; allowed: 0; take the law "
                "without memory for rollers with centrifugal load"
            )
        self._check = check
        table = MemoryTable(np.empty(NUMBERS))
        data, room, fill = film_data(contacts, factors), _room(), called("ehd_film_fill")
        with_point(point, entrainment_speed, lambda where: fill(data.address, where, at(room), table.address))
        self._table = table

    @property
    def table(self) -> MemoryTable:
        """The table of the law, see `ehdmaps.maps.kernels.memory_table`."""
        return self._table

    def settled(self, delta: npt.ArrayLike) -> FilmState:
        """Films in equilibrium at an approach.

        Parameters
        ----------
        delta : float or array
            [m].

        Raises
        ------
        InputError
            For approaches that are no finite numbers.
        """
        approach = np.maximum(_finite("delta", delta), self._table.lift_off)
        loads = np.asarray(equilibrium_at(self._table, approach)[0])
        return FilmState(approach, np.zeros_like(approach), loads)

    def advance(self, state: FilmState, delta: npt.ArrayLike, dt: float) -> tuple[Any, Any, FilmState]:
        """A step in time. The state that goes in is left as it is: the step may be tried again.

        Parameters
        ----------
        state : FilmState
            State at the beginning of the step.
        delta : float or array
            Approach at its end [m], in the shape of the state.
        dt : float
            Length of the step [s], > 0. The method is of second order while steps grow by no more than a fifth.

        Returns
        -------
        w, dw_ddelta : float or array
            Load at the end of the step [N/m], >= 0, and its exact derivative by the approach there [N/m2].
        state : FilmState
            State at the end of the step.

        Raises
        ------
        InputError
            For values that are no finite numbers, other shapes, and steps that are not longer than zero.
        OutsideMapError
            For loads above the map, where the law has the policy "error".
        """
        ends = _finite("delta", delta)
        if ends.shape != state.approach.shape:
            raise InputError(
                f"film memory, delta: got the shape {ends.shape}; the state has {state.approach.shape}; "
                "they must be alike"
            )
        if not (isinstance(dt, int | float) and 0.0 < dt < math.inf):
            raise InputError(f"film memory, dt: got {dt!r} s; allowed: finite and > 0 s")
        size, rows = ends.size, np.empty((7, *ends.shape))
        rows[0], rows[1], rows[2] = ends, state.approach, state.change
        first, row = at(rows), 8 * size
        called("ehd_film_steps")(
            self._table.address, dt, state.step, size, first, first + row, first + 2 * row, first + 3 * row
        )
        w, tangent, approach, changed = rows[3:]
        if ends.ndim == 0:
            w, tangent, approach, changed = (np.asarray(value) for value in (w, tangent, approach, changed))
        self._check(w)
        return w[()], tangent[()], FilmState(approach, changed, w, float(dt))

    def spent(self, before: FilmState, state: FilmState) -> FloatArray:
        """Energy that films take up for good over a step from one state to another [J/m], in their shape."""
        return self._energies("ehd_film_spent", before.approach, before.load, state.approach, state.load)

    def stored(self, state: FilmState) -> FloatArray:
        """Energy that contacts store [J/m], in the shape of the state; zero without contact."""
        return self._energies("ehd_film_energies", state.approach, state.load)

    def _energies(self, name: str, *arrays: FloatArray) -> FloatArray:
        """Energies by a function of the kernel."""
        kept, out = [np.ascontiguousarray(array, dtype=np.float64) for array in arrays], np.empty(arrays[0].shape)
        called(name)(self._table.address, out.size, *(at(array) for array in kept), at(out))
        return out


class _FilmData(Record):
    """Contacts in series and the factors of one speed and temperature, an `ehd_film_data`."""

    _fields_ = (
        ("law", ctypes.c_void_p),
        ("contacts", ctypes.c_double * 3),
        ("lowest_speed", ctypes.c_double),
        ("speeds", ctypes.c_int64),
        ("temperatures", ctypes.c_int64),
        ("loads", ctypes.c_int64),
        ("log_speed_start", ctypes.c_double),
        ("log_speed_step", ctypes.c_double),
        ("temperature_start", ctypes.c_double),
        ("temperature_step", ctypes.c_double),
        ("log_load_start", ctypes.c_double),
        ("log_load_step", ctypes.c_double),
        ("factors", numbers),
    )
    shapes: ClassVar = {"factors": ("speeds", "temperatures", "loads")}


@functools.cache
def _film_record() -> type[_FilmData]:
    """The struct, after it was compared with that in C."""
    return checked(_FilmData, "ehd_film_data")


_own = threading.local()


def _room() -> FloatArray:
    """Values at the nodes while a table is made, of this thread."""
    if not hasattr(_own, "room"):
        _own.room = np.empty((9, 2 * ROWS + 1))
    room: FloatArray = _own.room
    return room


def film_data(contacts: Sequence[LineContact], factors: LockedFactors) -> Record:
    """Contacts in series and the factors of one speed and temperature, for C."""
    values = np.ascontiguousarray(factors.values, dtype=np.float64)
    return _film_record()(
        contacts=geometry_of(film_of(contacts, 0.0)),
        speeds=1,
        temperatures=1,
        loads=values.size,
        log_load_start=factors.lowest,
        log_load_step=factors.per_log,
        factors=values,
    )


def _finite(name: str, values: npt.ArrayLike) -> FloatArray:
    """Finite doubles, or an error."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"film memory, {name}: got {values!r}; allowed: real numbers") from None
    if not np.isfinite(array).all():
        raise InputError(f"film memory, {name}: got {array[~np.isfinite(array)].flat[0]}; allowed: finite numbers")
    return array
