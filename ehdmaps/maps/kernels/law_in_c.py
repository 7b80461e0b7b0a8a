"""The contact law in C, as Python calls it: its numbers as a struct, calls of one place and of many, points.

The equations are in `ehdmaps/kernel/c/law/law.c` and `law_many.c`. Nothing is refused here: what lies outside the map
is counted by cause, and held.
"""

from __future__ import annotations

import ctypes
import functools
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.kernel import library
from ehdmaps.kernel.record import Record, at, numbers
from ehdmaps.maps.kernels.tables import ApproachTable, LawTable, Line, Point

_REFUSED = 8 + 64
"""Parts of a status that refuse: numbers that are not finite, and null pointers."""

ABOVE_LOAD, ABOVE_SPEED, OUTSIDE_TEMPERATURE, NOT_FINITE, BAD_CENTRIFUGAL = 1, 2, 4, 8, 16
"""Parts of a status."""

_NUMBERS = (
    "film_speed", "lowest_speed", "highest_speed", "lowest_temperature", "highest_temperature", "highest_load",
    "known_load", "held_load", "counted_speed", "counted_cold", "counted_hot",
)  # fmt: skip
_AXES = "log_speed_start", "log_speed_step", "temperature_start", "temperature_step", "start", "step"


class TableRecord(Record):
    """`ehd_law_table`: an `ApproachTable`."""

    _fields_: ClassVar = [
        *((name, ctypes.c_int64) for name in ("speeds", "temperatures", "places")),
        *((name, ctypes.c_double) for name in _AXES),
        ("coefficients", numbers),
        ("place", numbers),
    ]
    shapes: ClassVar = {"coefficients": ("speeds", "temperatures", "places", 2), "place": ("speeds", "temperatures", 2)}

    @classmethod
    def of(cls, table: ApproachTable) -> TableRecord:
        """Make it of a table.

        Parameters
        ----------
        table : ApproachTable
            The table.
        """
        speeds, temperatures, both = table.coefficients.shape
        return cls(
            speeds=speeds,
            temperatures=temperatures,
            places=both // 2,
            **{name: getattr(table, name) for name in _AXES},
            coefficients=np.ascontiguousarray(table.coefficients),
            place=np.ascontiguousarray(table.place),
        )


class LawRecord(Record):
    """`ehd_law_data`: a `LawTable`, with or without the single contacts of a series."""

    _fields_: ClassVar = [
        *((name, ctypes.c_int64) for name in ("refused", "contacts", "centrifugal")),
        *((name, ctypes.c_double) for name in _NUMBERS),
        ("structure", numbers),
        ("end_rows", ctypes.c_int64),
        ("end_columns", ctypes.c_int64),
        ("ends", numbers),
        *((name, TableRecord) for name in ("own", "inner", "outer")),
    ]
    shapes: ClassVar = {"structure": ("contacts", 3), "ends": ("end_rows", "end_columns")}

    @classmethod
    def of(cls, table: LawTable, centrifugal: bool) -> LawRecord:
        """Make it of a law.

        Parameters
        ----------
        table : LawTable
            The law.
        centrifugal : bool
            Whether centrifugal loads are taken, with tables of both contacts.
        """
        tables = {"own": table.own, "inner": table.inner, "outer": table.outer}
        taken = tables if centrifugal else {"own": table.own}
        return cls(
            refused=_REFUSED,
            contacts=table.structure.shape[0],
            centrifugal=int(centrifugal),
            **{name: getattr(table, name) for name in _NUMBERS},
            structure=np.ascontiguousarray(table.structure),
            end_rows=table.ends.shape[0],
            end_columns=table.ends.shape[1],
            ends=np.ascontiguousarray(table.ends),
            **{name: TableRecord.of(part) for name, part in taken.items()},
        )


class ForceRecord(ctypes.Structure):
    """`ehd_force`: load [N/m], stiffness [N/m2], damping [N s/m2]."""

    _fields_: ClassVar = [("load", ctypes.c_double), ("stiffness", ctypes.c_double), ("damping", ctypes.c_double)]


class _ErrandRecord(ctypes.Structure):
    """`ehd_law_errand`."""

    _fields_: ClassVar = [
        ("force", ForceRecord),
        *((name, ctypes.c_double) for name in ("approach", "rate", "u", "T", "q")),
        ("data", ctypes.c_void_p),
        ("room", ctypes.c_void_p),
    ]


_ask = struct.Struct("5d").pack_into
"""Puts the arguments into an errand, behind the force."""

_ARGUMENTS = ctypes.sizeof(ForceRecord)
"""Place of the arguments there [bytes]."""


class _LineRecord(ctypes.Structure):
    """`ehd_line`."""

    _fields_: ClassVar = [
        *((name, ctypes.c_double) for name in ("offset", "inverse_scale", "start", "step")),
        ("cells", ctypes.c_int64),
        ("to_cells", ctypes.c_int64),
    ]


class _PointRecord(ctypes.Structure):
    """`ehd_law_point`, but for the cells behind it."""

    _fields_: ClassVar = [
        ("data", ctypes.c_void_p),
        *(
            (name, ctypes.c_double)
            for name in (
                "entrainment_speed", "temperature", "centrifugal_load", "film", "inner_lift_off", "outer_start",
                "lift_off", "highest_load", "held_load", "held_approach", "held_stiffness", "held_damping",
            )
        ),
        ("status", ctypes.c_int64),
        *((name, _LineRecord) for name in ("own", "inner", "outer")),
    ]  # fmt: skip


def with_point(point: Point, entrainment_speed: float, call: Callable[[int], None]) -> None:
    """Call a function with the address of an `ehd_law_point` that has the cells of a point.

    Parameters
    ----------
    point : Point
        The point, without centrifugal load.
    entrainment_speed : float
        u [m/s], of either sign.
    call : callable
        Takes the address, which holds during the call.
    """
    cells, structure = np.ascontiguousarray(point.own.coefficients), np.ascontiguousarray(point.structure)
    law = LawRecord(contacts=structure.shape[0], structure=structure)
    same = [name for name in Point._fields if name not in ("own", "inner", "outer", "structure")]
    record = _PointRecord(
        data=law.address, entrainment_speed=abs(entrainment_speed), **{name: getattr(point, name) for name in same}
    )
    for name in ("offset", "inverse_scale", "start", "step"):
        setattr(record.own, name, getattr(point.own, name))
    record.own.cells, record.own.to_cells = cells.shape[0], at(cells) - ctypes.addressof(record.own)
    call(ctypes.addressof(record))


class _Functions(NamedTuple):
    """Functions of the library."""

    size: Callable[..., int]
    make: Callable[..., int]
    force: Callable[..., int]
    call: Callable[..., int]
    run: Callable[[int], int]
    approach: Callable[..., float]
    force_many: Callable[..., None]
    call_many: Callable[..., None]


@functools.cache
def _functions() -> _Functions:
    """The library's functions, after its structs were compared with those here."""
    pointer, number, count = ctypes.c_void_p, ctypes.c_double, ctypes.c_int64
    library.checked(LawRecord, "ehd_law_data")
    library.checked(_PointRecord, "ehd_law_point_head")
    library.checked(_ErrandRecord, "ehd_law_errand")
    return _Functions(
        library.function("ehd_law_point_size", pointer, result=ctypes.c_size_t),
        library.function("ehd_law_make", pointer, number, number, number, pointer),
        library.function("ehd_law_force", pointer, number, number, pointer),
        library.function("ehd_law_call", pointer, *[number] * 5, pointer, pointer),
        library.function("ehd_law_run", pointer),
        library.function("ehd_law_approach", pointer, number, result=number),
        library.function("ehd_law_force_many", pointer, count, *[pointer] * 4, result=None),
        library.function("ehd_law_call_many", pointer, count, *[pointer] * 8, result=None),
    )


class _Scratch:
    """Memory of one call at a time: the errand as a row of numbers, and the room of its point."""

    __slots__ = "address", "numbers", "room"

    def __init__(self, size: int, data: int) -> None:
        self.room = np.empty(size // 8)
        self.numbers: Any = np.zeros(ctypes.sizeof(_ErrandRecord) // 8)
        self.address = at(self.numbers)
        errand = _ErrandRecord.from_address(self.address)
        errand.data, errand.room = data, at(self.room)


@dataclass(frozen=True)
class LawAddress:
    """A law in C, for programs that call it themselves.

    `PROTOTYPE` is the type of the function for `ctypes`, which numba's compiled code calls as well:
    ``int ehd_law_call(const void *data, double approach, double rate, double entrainment_speed, double temperature,
    double centrifugal_load, void *room, double force[3])``, in SI units, see `ehdmaps/kernel/c/law/law.h`. It fills
    load, stiffness and damping, and returns 0, or a sum of `ABOVE_LOAD`, `ABOVE_SPEED` and so on: the law is held
    there, and NaN for numbers that are not finite. Each thread has memory of its own.

    Attributes
    ----------
    function, data : int
        Addresses of the function and of the numbers of the law.
    room : int
        Bytes of memory for `room`.
    """

    function: int
    data: int
    room: int

    PROTOTYPE: ClassVar = ctypes.CFUNCTYPE(
        ctypes.c_int, ctypes.c_void_p, *[ctypes.c_double] * 5, ctypes.c_void_p, ctypes.c_void_p
    )


class LawInC:
    """A law in C.

    Parameters
    ----------
    table : LawTable
        The law.
    centrifugal : bool
        Whether centrifugal loads are taken; the table has both contacts then.

    Attributes
    ----------
    data : LawRecord
        Numbers of the law.
    """

    def __init__(self, table: LawTable, centrifugal: bool) -> None:
        self._table, self._centrifugal = table, centrifugal
        self.data = LawRecord.of(table, centrifugal)
        self._address = self.data.address
        self._functions = _functions()
        self._run = self._functions.run
        self.point_size = int(self._functions.size(self._address))
        self._free: list[_Scratch] = []

    def __reduce__(self) -> tuple[Any, ...]:
        return LawInC, (self._table, self._centrifugal)

    @property
    def door(self) -> LawAddress:
        """Addresses for other programs."""
        function = ctypes.cast(self._functions.call, ctypes.c_void_p).value  # type: ignore[arg-type]
        return LawAddress(function or 0, self._address, self.point_size)

    def _scratch(self) -> _Scratch:
        """Memory that no other call has; whoever has done with it puts it back."""
        try:
            return self._free.pop()
        except IndexError:
            return _Scratch(self.point_size, self._address)

    def force(
        self, delta: float, rate: float, entrainment_speed: float, temperature: float, centrifugal_load: float
    ) -> tuple[np.float64, np.float64, np.float64] | None:
        """Load and its derivatives at one place; None where any of it is outside the map or not finite.

        Parameters
        ----------
        delta, rate : float
            Approach [m] and rate [m/s].
        entrainment_speed, temperature, centrifugal_load : float
            u [m/s], T [K], q [N/m].
        """
        # each argument of a call by ctypes takes as long as packing all
        try:
            scratch = self._free.pop()
        except IndexError:
            scratch = _Scratch(self.point_size, self._address)
        numbers = scratch.numbers
        _ask(numbers, _ARGUMENTS, delta, rate, entrainment_speed, temperature, centrifugal_load)
        status = self._run(scratch.address)
        found = numbers[0], numbers[1], numbers[2]
        self._free.append(scratch)
        return None if status else found

    def forces(self, flat: Sequence[FloatArray]) -> tuple[FloatArray, IntArray]:
        """Loads and derivatives at many places.

        Parameters
        ----------
        flat : sequence of array (n,)
            Approaches [m], rates [m/s], speeds [m/s], temperatures [K] and centrifugal loads [N/m], contiguous.

        Returns
        -------
        forces : array (3, n)
            [N/m], [N/m2], [N s/m2]; NaN for numbers that are not finite.
        counts : array (4,)
            Places outside the map by cause, see `ehdmaps.maps.kernels.tables`.
        """
        forces, counts, scratch = np.empty((3, flat[0].size)), np.zeros(4, dtype=np.int64), self._scratch()
        self._functions.call_many(self._address, flat[0].size, *map(at, flat), at(scratch.room), at(forces), at(counts))
        self._free.append(scratch)
        return forces, counts

    def point(self, entrainment_speed: float, temperature: float, centrifugal_load: float) -> PointInC:
        """The law at one speed, temperature and centrifugal load.

        Parameters
        ----------
        entrainment_speed, temperature, centrifugal_load : float
            u [m/s], T [K], q [N/m]; finite.
        """
        return PointInC(self, entrainment_speed, temperature, centrifugal_load)


class PointInC:
    """A law at one speed, temperature and centrifugal load, in C.

    Parameters
    ----------
    law : LawInC
        The law.
    entrainment_speed, temperature, centrifugal_load : float
        u [m/s], T [K], q [N/m]; finite.

    Attributes
    ----------
    counts : array (4,)
        Whether speed, temperature and centrifugal load are outside the map, as counts by cause.
    """

    def __init__(self, law: LawInC, entrainment_speed: float, temperature: float, centrifugal_load: float) -> None:
        self._asked = law, entrainment_speed, temperature, centrifugal_load
        self._memory = np.empty(law.point_size // 8)
        self._functions = _functions()
        self.address = at(self._memory)
        self._force = self._functions.force
        self._status = int(
            self._functions.make(law.data.address, entrainment_speed, temperature, centrifugal_load, self.address)
        )
        causes = BAD_CENTRIFUGAL, ABOVE_SPEED, OUTSIDE_TEMPERATURE, NOT_FINITE
        self.counts: IntArray = np.array([int(bool(self._status & cause)) for cause in causes], dtype=np.int64)
        self._free: list[ForceRecord] = []

    def __reduce__(self) -> tuple[Any, ...]:
        return PointInC, self._asked

    @functools.cached_property
    def point(self) -> Point:
        """Its numbers and lines; arrays are views of the memory in C."""
        record = _PointRecord.from_buffer(self._memory)  # type: ignore[arg-type]
        lines = {
            name: self._line(getattr(record, name))
            for name in ("own", "inner", "outer")[: 3 if record.centrifugal_load > 0.0 else 1]
        }
        own = lines["own"]
        return Point(
            own=own,
            inner=lines.get("inner", own),
            outer=lines.get("outer", own),
            structure=self._asked[0].data.given("structure"),
            **{
                name: float(getattr(record, name))
                for name in Point._fields
                if name not in ("own", "inner", "outer", "structure")
            },
        )

    def _line(self, line: _LineRecord) -> Line:
        """A line whose cells lie in the memory."""
        first = (ctypes.addressof(line) + line.to_cells - self.address) // 8
        cells = self._memory[first : first + 8 * line.cells].reshape(line.cells, 8)
        return Line(cells, line.offset, line.inverse_scale, line.start, line.step)

    def force(self, delta: float, rate: float) -> tuple[float, float, float] | None:
        """Load and its derivatives at one place; None where it is above the map or not finite.

        Parameters
        ----------
        delta, rate : float
            Approach [m] and rate [m/s].
        """
        try:
            force = self._free.pop()
        except IndexError:
            force = ForceRecord()
        status = self._force(self.address, delta, rate, ctypes.addressof(force))
        found = force.load, force.stiffness, force.damping
        self._free.append(force)
        return found if status == self._status else None

    def approach(self, load: float) -> float:
        """Approach [m] at which the contacts carry a load at rest, with the whole film; for zero the highest without.

        Parameters
        ----------
        load : float
            w >= 0 on the inner contact [N/m].
        """
        return self._functions.approach(self.address, load)

    def forces(self, delta: FloatArray, rate: FloatArray) -> tuple[FloatArray, IntArray]:
        """Loads and derivatives at many places.

        Parameters
        ----------
        delta, rate : array (n,)
            Approaches [m] and rates [m/s], contiguous.

        Returns
        -------
        forces : array (3, n)
            [N/m], [N/m2], [N s/m2]; NaN for numbers that are not finite.
        counts : array (4,)
            Places with loads above the map, and those that are not finite, by cause.
        """
        forces, counts = np.empty((3, delta.size)), np.zeros(4, dtype=np.int64)
        self._functions.force_many(self.address, delta.size, at(delta), at(rate), at(forces), at(counts))
        return forces, counts
