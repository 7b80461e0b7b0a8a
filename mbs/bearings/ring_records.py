"""Bearings with cylindrical rollers of a run as C takes them, see `ehdmaps/kernel/c/run/rings.h`."""

from __future__ import annotations

import ctypes
from typing import ClassVar

from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings.rings import Rings
from mbs.bearings.speed_tables import Course

_WHOLE = ("firsts", "places", "films_of", "rollers", "slices", "felt", "alone")
_REAL = ("start_angles", "cage_rates", "sizes", "positions", "profiles", "weights", "cosine", "sine", "outward")


class RingsRecord(Record):
    """Bearings, one row a bearing: the arrays of `mbs.bearings.rings.Rings`.

    Attributes
    ----------
    count, sides : int
        How many bearings, and contacts of a roller.
    most_rollers, most_slices : int
        Lengths of the rows of rollers and slices.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("count", "sides", "most_rollers", "most_slices")),
        *((name, integers) for name in _WHOLE),
        *((name, numbers) for name in _REAL),
    )
    shapes: ClassVar = {
        **dict.fromkeys((*_WHOLE, "start_angles", "cage_rates", "outward"), ("count",)),
        "films_of": ("count", "sides"),
        "sizes": ("count", 6),
        **dict.fromkeys(("positions", "profiles", "weights"), ("count", "most_slices")),
        **dict.fromkeys(("cosine", "sine"), ("count", "most_rollers")),
    }


def rings_record(rings: Rings) -> RingsRecord:
    """Bearings for C."""
    count, sides = rings.films_of.shape
    named = {name: getattr(rings, name) for name in (*_WHOLE, *_REAL) if name not in ("cosine", "sine")}
    return checked(RingsRecord, "ehd_rings")(
        count=count,
        sides=sides,
        most_rollers=rings.cos.shape[1],
        most_slices=rings.positions.shape[1],
        cosine=rings.cos,
        sine=rings.sin,
        **named,
    )


class CourseRecord(Record):
    """Places of some steps on tables over the speed: the arrays of `mbs.bearings.speed_tables.Course`.

    Attributes
    ----------
    films : int
        How many tables.
    """

    _fields_ = (
        ("films", ctypes.c_int64),
        ("nodes", integers),
        ("outside", integers),
        ("weights", numbers),
        ("kept", integers),
    )


def course_record(course: Course) -> CourseRecord:
    """Course for C."""
    return checked(CourseRecord, "ehd_film_course")(films=course.nodes.shape[1], **course._asdict())
