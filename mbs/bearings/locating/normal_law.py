"""Law of a contact over its approach: load, stiffness, damping, by `ehdmaps/kernel/c/pair/pair_law.c`.

Each law is F = C g^(3/2), with the dry overlap g = approach, or with g(approach) from a table for films.
"""

from __future__ import annotations

import ctypes
import functools
import math
from collections.abc import Callable
from typing import ClassVar, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, numbers

STEP = 1e-10
"""Step of the approach, either way, by which laws are differentiated [m]."""

HELD = 3
"""Numbers that a contact with memory holds over a step."""


class NormalLaw(NamedTuple):
    """Law of a contact over its approach.

    Attributes
    ----------
    coefficient : float
        C of F = C g^(3/2) [N/m^1.5].
    damping, damping_time : float
        Constant part of c while there is load [N s/m], and the part in proportion to the stiffness [s].
    centre, scale, first, step : float
        Table of g: z = asinh((approach - centre)/scale), its first node and the distance of nodes.
    held, spring, at : float
        Force [N] and spring [N/m] of a film with memory beside its rest, by the approach beyond `at` [m], over a step,
        see `mbs.bearings.balls.ball_memory`; without a spring it has none.
    table : array (nodes, 4)
        ln g and its slope by node, ln c and its slope; none for a dry contact.
    """

    coefficient: float
    damping: float
    damping_time: float
    centre: float
    scale: float
    first: float
    step: float
    held: float
    spring: float
    at: float
    table: FloatArray


class LawData(Record):
    """Law of a contact as C has it: `ehd_pair_law`, see `NormalLaw`."""

    _fields_ = (
        *((name, ctypes.c_double) for name in NormalLaw._fields[:7]),
        ("rows", ctypes.c_int64),
        ("table", numbers),
    )
    shapes: ClassVar = {"table": ("rows", 4)}


def law_data(law: NormalLaw) -> LawData:
    """Law of a contact as C has it.

    Parameters
    ----------
    law : NormalLaw
        Law of the contact.
    """
    rows = law.table.shape[0]
    table = np.ascontiguousarray(law.table, dtype=np.float64) if rows else None
    return LawData(**dict(zip(NormalLaw._fields[:7], law[:7], strict=True)), rows=rows, table=table)


@functools.cache
def _contacts() -> Callable[..., None]:
    """Load, stiffness and damping of contacts, in C."""
    checked(LawData, "ehd_pair_law")
    place = ctypes.c_void_p
    return function("ehd_pair_contacts", place, ctypes.c_int64, place, place, place, result=None)


@functools.cache
def _approach() -> Callable[..., float]:
    """Approach by load, in C."""
    checked(LawData, "ehd_pair_law")
    number = ctypes.c_double
    return function("ehd_pair_approach", ctypes.c_void_p, number, number, result=number)


def contacts_at(law: NormalLaw, approach: FloatArray) -> FloatArray:
    """Load [N], stiffness [N/m] and damping [N s/m] of contacts, shape (3, ...); of the end of a step with memory.

    Parameters
    ----------
    law : NormalLaw
        Their law.
    approach : array (...)
        Approaches [m].
    """
    data, found = law_data(law), np.empty((approach.size, 3))
    places = np.ascontiguousarray(approach, dtype=np.float64)
    held = np.array([law.held, law.spring, law.at])
    _contacts()(data.address, places.size, places.ctypes.data, held.ctypes.data, found.ctypes.data)
    return np.ascontiguousarray(found.T).reshape(3, *approach.shape)


def contact_slopes(law: NormalLaw, approach: FloatArray) -> FloatArray:
    """Derivatives of load, stiffness and damping by the approach, shape (3, ...).

    Parameters
    ----------
    law : NormalLaw
        Their law.
    approach : array (...)
        Approaches [m].
    """
    return np.asarray((contacts_at(law, approach + STEP) - contacts_at(law, approach - STEP)) / (2.0 * STEP))


def contact(law: NormalLaw, approach: float) -> tuple[float, float, float]:
    """Load [N], stiffness [N/m] and damping [N s/m] of a contact; of the end of a step with memory.

    Parameters
    ----------
    law : NormalLaw
        Law of the contact.
    approach : float
        Approach [m].
    """
    load, stiffness, damping = contacts_at(law, np.array([approach])).ravel().tolist()
    return load, stiffness, damping


def load_approach(law: NormalLaw, load: float) -> float:
    """Approach at which a contact carries a load > 0 [m].

    Parameters
    ----------
    law : NormalLaw
        Law of the contact.
    load : float
        Load [N].
    """
    data = law_data(law)
    return _approach()(data.address, load, math.nan)


def on_rows(law: NormalLaw, table: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Approach [m], load [N] and damping [N s/m] at rest at the rows of a table, (rows,) each.

    Parameters
    ----------
    law : NormalLaw
        Law with the grid of the table.
    table : array (rows, 4)
        The table.
    """
    approach = law.centre + law.scale * np.sinh(law.first + law.step * np.arange(table.shape[0]))
    return approach, law.coefficient * np.exp(1.5 * table[:, 0]), np.exp(table[:, 2])


def empty_table() -> FloatArray:
    """Table of a dry contact."""
    return np.zeros((0, 4))
