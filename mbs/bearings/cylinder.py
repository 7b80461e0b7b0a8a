"""Structs and functions of bearings with cylindrical rollers in C, see `ehdmaps.kernel`.

`Arrays` holds what C reads of one bearing, and its work space; `mbs.bearings.force_at_point` calls it.

A law at one speed, temperature and centrifugal load is a table of cells, which a bearing reads in nanoseconds. It is
made in C, see `cylinder_law.h`. Slices differ from the law by some 1e-7 in load and 1e-5 in stiffness at most, a
bearing by 1e-9 and 1e-7.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from ctypes import POINTER, c_double, c_int64, c_size_t, c_void_p
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, at, integers, numbers
from ehdmaps.maps.kernels.tables import last_of, nodes_of, rows_of
from mbs.bearings.bearing import Bearing

if TYPE_CHECKING:
    from ehdmaps.maps.kernels.law_in_c import LawRecord

ABOVE_LOAD, NOT_FINITE, TOO_FAR, NO_LOADS = 1, 8, 32, 128
"""What a call finds: a slice above the mapped load; numbers that are no finite ones, or poses beyond reason; coupled
slices that are found no loads, whose contacts are wider than the coupling was made for."""

WHOLE, GROWING, WITHOUT_KNOTS, FILM_ALONE = 0, 1, 2, 4
"""What `ehd_cylinder_prepare` is asked for: all cells at once, or as slices need them; no table of a faded film; of a
faded film its nodes alone."""

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

_MOST_TILT = 0.5
_ROUND_OFF = 1e-12


class CylinderLaw(Record):
    """A prepared law, ``ehd_cylinder_law``: arrays of the caller."""

    _fields_: ClassVar = [
        ("numbers", numbers),
        ("cells", numbers),
        ("knots", numbers),
        ("film", numbers),
        ("nodes", numbers),
        ("marks", integers),
        ("point", numbers),
        ("first", c_int64),
        ("end", c_int64),
        ("grows", c_int64),
    ]
    shapes: ClassVar = {
        "numbers": (NUMBERS,),
        "cells": (2 * ROWS, 4, 2),
        "knots": (2 * ROWS,),
        "film": (2 * ROWS, 8),
        "nodes": (NODES, 4),
        "marks": (-(-2 * NODES // 8),),
    }


class Cylinder(Record):
    """Constants of a bearing, ``ehd_cylinder``; arrays of slices have a last number more."""

    _fields_: ClassVar = [
        ("rollers", c_int64),
        ("slices", c_int64),
        ("symmetric", c_int64),
        ("half_clearance", c_double),
        ("slice_length", c_double),
        ("most_travel", c_double),
        ("most_tilt", c_double),
        ("half_length", c_double),
        ("least_profile", c_double),
        ("most_profile", c_double),
        ("position", numbers),
        ("profile", numbers),
        ("cosine", numbers),
        ("sine", numbers),
        ("weight", numbers),
        ("added", numbers),
        ("row", numbers),
    ]
    shapes: ClassVar = {
        **dict.fromkeys(("cosine", "sine", "row"), ("rollers",)),
        "weight": ("slices",),
        "added": ("rollers", 2, 2),
    }


class CylinderWork(Record):
    """Work space of a bearing, ``ehd_cylinder_work``."""

    _fields_: ClassVar = [
        ("states", numbers),
        ("place", numbers),
        ("row", integers),
        ("stride", c_int64),
        ("whole", c_int64),
    ]


class CylinderCall(Record):
    """A bearing with a law as it is called, ``ehd_cylinder_call``."""

    _fields_: ClassVar = [
        ("bearing", POINTER(Cylinder)),
        ("law", POINTER(CylinderLaw)),
        ("work", POINTER(CylinderWork)),
        ("state", numbers),
        ("answer", numbers),
        ("coupling", numbers),
        ("own", numbers),
        ("scratch", numbers),
    ]
    shapes: ClassVar = {"state": (13,), "answer": (13, 6)}


class Functions(NamedTuple):
    """Functions of the library that take records, as addresses."""

    point_size: Callable[..., int]
    prepare: Callable[..., int]
    force: Callable[..., int]
    approaches: Callable[..., int]
    rollers: Callable[..., int]
    of_loads: Callable[..., int]
    forces: Callable[..., None]
    film_part: Callable[..., float]


@functools.cache
def functions() -> Functions:
    """Load the functions, after the structs were compared with those in C."""
    for record, name in (
        (CylinderLaw, "ehd_cylinder_law"),
        (Cylinder, "ehd_cylinder"),
        (CylinderWork, "ehd_cylinder_work"),
        (CylinderCall, "ehd_cylinder_call"),
    ):
        checked(record, name)
    address, number = c_void_p, c_double
    return Functions(
        point_size=function("ehd_law_point_size", address, result=c_size_t),
        prepare=function("ehd_cylinder_prepare", address, number, number, number, c_int64, address),
        force=function("ehd_cylinder_force", address),
        approaches=function("ehd_cylinder_approaches", address, address, address),
        rollers=function("ehd_cylinder_rollers", address, address, address),
        of_loads=function("ehd_cylinder_of_loads", address, address, address, address, address),
        forces=function("ehd_contact_forces", c_int64, address, address, result=None),
        film_part=function("ehd_law_film_part", address, number, result=c_double),
    )


def cylinder_of(
    bearing: Bearing,
    which: Any = slice(None),
    weights: FloatArray | None = None,
) -> Cylinder:
    """The struct of a bearing.

    Parameters
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    which : index of arrays (slices,)
        Slices to compute; all if left out.
    weights : array, optional
        How many slices each of them stands for, where rings do not tilt.
    """
    geometry = bearing.geometry
    x, depth = bearing.slice_positions, 2.0 * bearing.profile_depths
    symmetric = bool(np.all(np.abs(depth - depth[::-1]) <= _ROUND_OFF * np.max(np.abs(depth))))
    if symmetric:
        # left and right to the bit
        x, depth = 0.5 * (x - x[::-1]), 0.5 * (depth + depth[::-1])
    positions, profile = x[which], depth[which]
    return Cylinder(
        rollers=geometry.rolling_elements,
        slices=positions.size,
        symmetric=int(symmetric and positions.size == x.size),
        half_clearance=0.5 * geometry.diametral_clearance,
        slice_length=bearing.slice_length,
        most_travel=geometry.roller_diameter,
        most_tilt=_MOST_TILT,
        half_length=0.5 * geometry.roller_length,
        least_profile=float(np.min(depth)),
        most_profile=float(np.max(depth)),
        position=np.append(positions, 0.0),
        profile=np.append(profile, 0.0),
        cosine=np.cos(bearing.roller_angles),
        sine=np.sin(bearing.roller_angles),
        weight=weights,
        row=bearing.row_places,
    )


class LawRoom:
    """Room for a prepared law.

    Attributes
    ----------
    numbers : array (NUMBERS,)
        Numbers of the law, those of `LawNumbers`.
    law : CylinderLaw
        The struct.
    """

    def __init__(self) -> None:
        self.numbers = np.zeros(NUMBERS)
        self.law = CylinderLaw(numbers=self.numbers)
        self._room = 0

    def array(self, name: str) -> FloatArray:
        """Array of the struct by its name, such as "cells", shape (2 ROWS, 4, 2); made if it is not there yet."""
        found: FloatArray | None = self.law.given(name)
        if found is None:
            found = np.zeros(CylinderLaw.shapes[name], dtype=np.int64 if name == "marks" else np.float64)  # type: ignore[arg-type]
            self.law.put(**{name: found})
        return found

    def prepare(self, data: LawRecord, conditions: tuple[float, float, float], asked: int) -> int:
        """Make a law ready; returns a status, of which speed, temperature or centrifugal load are the cause.

        Parameters
        ----------
        data : LawRecord
            The law.
        conditions : (float, float, float)
            u [m/s], T [K], centrifugal load [N/m].
        asked : int
            What is asked for, such as `WHOLE`.
        """
        called = functions()
        needed = called.point_size(data.address)
        if needed > self._room:
            self._room = needed
            self.law.put(point=np.zeros(-(-needed // 8)))
            for name in ("cells", "nodes", "marks"):
                self.array(name)
        if not asked & WITHOUT_KNOTS and abs(conditions[0]) < data.film_speed:
            self.array("film")
            self.array("knots")
        return called.prepare(data.address, *conditions, asked, self.law.address)


class Arrays(LawRoom):
    """Arrays of one bearing in C: its constants, a law, and work space. They are for one thread.

    Parameters
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    coupling : array (slices, slices), optional
        Compliances between slices [m2/N]; none for slices on their own.

    Attributes
    ----------
    shape : Cylinder
        The bearing.
    state : array (13,)
        Pose (6), velocity (6) and angle of the cage of a call.
    answer : array (13, 6)
        Force, six rows of stiffness, six rows of damping.
    call : CylinderCall
        All of it together.
    """

    def __init__(self, bearing: Bearing, coupling: FloatArray | None = None) -> None:
        super().__init__()
        rollers, slices = bearing.geometry.rolling_elements, bearing.slices
        self.shape = cylinder_of(bearing)
        self.state, self.answer = np.zeros(13), np.zeros((13, 6))
        self._states = np.zeros((rollers, 2, slices, 2))
        self._work = CylinderWork(
            states=self._states,
            place=np.zeros(slices + 1),
            row=np.zeros(slices + 1, dtype=np.int64),
        )
        self.coupling = coupling
        self.own: FloatArray | None = None
        coupled: dict[str, FloatArray] = {}
        if coupling is not None:
            self.own = np.zeros((rollers, slices))
            scratch = np.zeros((slices, slices + 9))
            coupled = {"coupling": np.ascontiguousarray(coupling), "own": self.own, "scratch": scratch}
        self.call = CylinderCall(
            bearing=self.shape, law=self.law, work=self._work, state=self.state, answer=self.answer, **coupled
        )

    def states(self) -> FloatArray:
        """States of all slices at the motion of `state`, shape (4, rollers, slices).

        Load w [N/m], dw/d approach, damping c [N s/m2], dc/d approach; the slopes are to be multiplied by that of the
        law. Where the law is called for each slice they are those at its rate.
        """
        work = self._work
        work.whole, work.stride = 1, 4 * self.shape.slices
        try:
            functions().force(self.call.address)
        finally:
            work.whole = work.stride = 0
        return np.ascontiguousarray(self._states.transpose(3, 1, 0, 2)).reshape(4, *self._states.shape[::2])

    def rollers(self) -> FloatArray:
        """Gap [m], tilt and their rates of all rollers at the motion of `state`, shape (4, rollers)."""
        out = np.empty((4, self.shape.rollers))
        functions().rollers(self.shape.address, at(self.state), at(out))
        return out

    def approaches(self, state: FloatArray, out: FloatArray) -> int:
        """Approaches of all slices into `out` (rollers, slices) [m]; zero, or what is wrong about the pose.

        Parameters
        ----------
        state : array (13,)
            Pose (6), velocity (6) and angle of the cage.
        out : array (rollers, slices)
            Approaches, written [m].
        """
        return functions().approaches(self.shape.address, at(state), at(out))

    def of_loads(self, state: FloatArray, loads: FloatArray, slopes: FloatArray) -> FloatArray:
        """Force, stiffness and damping, which is zero, in rows (13, 6), of slices whose loads are there.

        Parameters
        ----------
        state : array (13,)
            Pose (6), velocity (6) and angle of the cage.
        loads, slopes : array (rollers, slices)
            Loads [N/m], and their slopes by the approach [N/m2].
        """
        out: FloatArray = np.empty((13, 6))
        given = (state, np.ascontiguousarray(loads), np.ascontiguousarray(slopes), out)
        functions().of_loads(self.shape.address, *(at(array) for array in given))
        return out
