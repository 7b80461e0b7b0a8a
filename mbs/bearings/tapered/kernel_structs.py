"""Structs and functions of tapered roller bearings in C, see `ehdmaps.kernel`: taper.h, pair_law.h."""

from __future__ import annotations

import functools
from collections.abc import Callable
from ctypes import c_double, c_int64, c_void_p
from typing import ClassVar, NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, numbers
from mbs.bearings.locating.locating_force import BY_RATES
from mbs.bearings.locating.normal_law import LawData, NormalLaw

RIB_NUMBERS = 6
"""Numbers of a rib, see `rib_rows`."""

PLACE, RING, FIRST_RIB, FIRST_SHARE, ADDED, COLUMNS = slice(9, 12), slice(12, 15), 15, 19, slice(49, 51), 55
"""Places of numbers that are kept of a roller, and how many there are: `ehd_taper_roller` in taper.h."""

ANSWER = 78
"""Numbers of an answer: force (6,), stiffness and damping (6, 6) each."""


class Ribs(NamedTuple):
    """Ribs that the end of a roller may lean on, m of them.

    Attributes
    ----------
    normals : array (m, 2)
        Normals, axial and radial.
    levers, plays : array (m,)
        Levers of the normals about the middle of the roller, and distances from the ends where nothing moved [m].
    laws : array (m,)
        C of each [N/m^1.5].
    outer : array (m,), of bool
        Whether it is a rib of the cup.
    """

    normals: FloatArray
    levers: FloatArray
    plays: FloatArray
    laws: FloatArray
    outer: BoolArray


class TaperedShape(NamedTuple):
    """Numbers of a bearing that do not change.

    Attributes
    ----------
    rows : tuple of float
        Places of the rows along the axis [m]; the rollers of the first one stand first, and lean on the ribs.
    pitch_radius : float
        Distance of the middles of rollers from the axis [m].
    cup, cone : (float, float)
        Normals of the lines: axial, radial.
    ribs : Ribs
        What holds a roller along its axis.
    levers, profile : array (n,)
        Levers of the slices of both lines, and depths of the profile on one side with the play there [m].
    cos, sin : array (Z,)
        Directions of the rollers in the cage, y and z.
    most_travel, most_tilt : float
        Largest accepted displacement [m] and tilt [rad] of the ring.
    """

    rows: tuple[float, ...]
    pitch_radius: float
    cup: tuple[float, float]
    cone: tuple[float, float]
    ribs: Ribs
    levers: FloatArray
    profile: FloatArray
    cos: FloatArray
    sin: FloatArray
    most_travel: float
    most_tilt: float


class TaperedData(Record):
    """Numbers of a bearing that do not change, ``ehd_taper_data``."""

    _fields_: ClassVar = [
        ("rollers", c_int64),
        ("slices", c_int64),
        ("ribs", c_int64),
        ("held", c_int64),
        ("row", c_double * 2),
        ("pitch_radius", c_double),
        ("cup", c_double * 2),
        ("cone", c_double * 2),
        ("play", c_double),
        ("most_travel", c_double),
        ("most_tilt", c_double),
        ("hard", c_double),
        ("damping", c_double),
        ("damping_time", c_double),
        ("rib", numbers),
        ("lever", numbers),
        ("profile", numbers),
        ("cosine", numbers),
        ("sine", numbers),
        ("added", numbers),
        ("by_rates", numbers),
    ]
    shapes: ClassVar = {
        "rib": ("ribs", RIB_NUMBERS),
        "lever": ("slices",),
        "profile": ("slices",),
        "cosine": ("rollers",),
        "sine": ("rollers",),
        "added": ("rollers", 2, 2),
        "by_rates": (BY_RATES,),
    }


class _Roller(Record):
    """A roller, ``ehd_taper_roller``; Python has it as a row of numbers."""

    _fields_: ClassVar = [("numbers", c_double * COLUMNS)]


class _Answer(Record):
    """An answer, ``ehd_taper_answer``; the same."""

    _fields_: ClassVar = [("numbers", c_double * ANSWER)]


class Functions(NamedTuple):
    """Functions of the library, which take addresses; what they write and return is said in taper_bearing.c.

    Attributes
    ----------
    force : callable
        Data, laws, pose, cage angle, loads, memory, rollers and answer; how many rollers carry, or what is wrong.
    go_on : callable
        Data, laws, springs, rollers, room for approaches of slices, memory.
    works : callable
        Data, rollers, loads, what is kept of the last call, room for two works.
    """

    force: Callable[..., int]
    go_on: Callable[..., None]
    works: Callable[..., None]


@functools.cache
def functions() -> Functions:
    """Return the functions, after structs were compared."""
    checked(LawData, "ehd_pair_law")
    checked(TaperedData, "ehd_taper_data")
    checked(_Roller, "ehd_taper_roller")
    checked(_Answer, "ehd_taper_answer")
    place = c_void_p
    return Functions(
        function("ehd_taper_force", place, place, place, c_double, place, place, place, place),
        function("ehd_taper_go_on", *6 * (place,), result=None),
        function("ehd_taper_works", *5 * (place,), result=None),
    )


def rib_rows(ribs: Ribs) -> FloatArray:
    """Ribs as C reads them, (m, 6): normal, lever, play, coefficient, and 1 on the outer ring.

    Parameters
    ----------
    ribs : Ribs
        The ribs.
    """
    rows = [ribs.normals, ribs.levers, ribs.plays, ribs.laws, ribs.outer.astype(np.float64)]
    return np.ascontiguousarray(np.column_stack(rows))


def data_of(shape: TaperedShape, line: NormalLaw) -> TaperedData:
    """The numbers of a bearing.

    Parameters
    ----------
    shape : TaperedShape
        Lengths, with the play of the raceways in its profile.
    line : NormalLaw
        Law of a dry line, whole rollers; ribs have its dampers.
    """
    return TaperedData(
        rollers=shape.cos.size,
        slices=shape.levers.size,
        ribs=shape.ribs.levers.size,
        held=shape.cos.size // len(shape.rows),
        row=np.array([shape.rows[0], shape.rows[-1]]),
        pitch_radius=shape.pitch_radius,
        cup=np.array(shape.cup),
        cone=np.array(shape.cone),
        most_travel=shape.most_travel,
        most_tilt=shape.most_tilt,
        hard=2.0 * line.coefficient,
        damping=line.damping,
        damping_time=line.damping_time,
        rib=rib_rows(shape.ribs),
        lever=shape.levers,
        profile=shape.profile,
        cosine=shape.cos,
        sine=shape.sin,
    )
