"""Law of a contact over its approach: load, stiffness, damping, by `ehdmaps/kernel/c/pair/pair_law.c`.

Each law is F = C g^(3/2), with the dry overlap g = approach, or with g(approach) from a table for films.
"""

from __future__ import annotations

import ctypes
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, numbers

STEP = 1e-10
"""Step of the approach, either way, by which laws are differentiated [m]."""


_FAR = 10.0
"""How far below a table, in z, energies go on."""

_PLACES, _WEIGHTS = 0.5 * (np.polynomial.legendre.leggauss(4)[0] + 1.0), 0.5 * np.polynomial.legendre.leggauss(4)[1]
"""Gauss points over 0 to 1, and their weights."""

_NO_ROWS = np.zeros((0, 4))


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
    table : array (nodes, 4)
        ln g and its slope by node, ln c and its slope; none for a dry contact.
    """

    coefficient: float
    damping: float = 0.0
    damping_time: float = 0.0
    centre: float = 0.0
    scale: float = 1.0
    first: float = 0.0
    step: float = 1.0
    table: FloatArray = _NO_ROWS


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


def contacts_at(law: NormalLaw, approach: FloatArray, held: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> FloatArray:
    """Load [N], stiffness [N/m] and damping [N s/m] of contacts, shape (3, ...); of the end of a step with memory.

    Parameters
    ----------
    law : NormalLaw
        Their law.
    approach : array (...)
        Approaches [m].
    held : (float, float, float)
        Force [N] and spring [N/m] of films with memory beside their rest over a step, by the approach beyond the third
        number [m]; without a spring they have none.
    """
    data, found = law_data(law), np.empty((approach.size, 3))
    places = np.ascontiguousarray(approach, dtype=np.float64)
    over = np.array(held)
    _contacts()(data.address, places.size, places.ctypes.data, over.ctypes.data, found.ctypes.data)
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


def energies(law: NormalLaw, approach: FloatArray, exponent: float = 1.5) -> FloatArray:
    """Energies of contacts at rest [J]: the integral of the load over the approach, by Gauss points between the rows.

    It begins at no approach of dry contacts, and at the first row of a table.

    Parameters
    ----------
    law : NormalLaw
        Their law.
    approach : array (...)
        Approaches [m].
    exponent : float
        That of dry contacts: 3/2 of points, 10/9 of lines.
    """
    if law.table.shape[0] == 0:
        dry = law.coefficient / (exponent + 1.0) * np.maximum(approach, 0.0) ** (exponent + 1.0)
        return np.asarray(dry)

    def over(begin: FloatArray, width: FloatArray) -> FloatArray:
        z = begin[:, None] + width[:, None] * _PLACES
        load = contacts_at(law, law.centre + law.scale * np.sinh(z))[0]
        return np.asarray(width * ((load * law.scale * np.cosh(z)) @ _WEIGHTS))

    below = math.ceil(_FAR / law.step)
    first = law.first - law.step * below
    places = np.maximum(np.arcsinh((approach.ravel() - law.centre) / law.scale) - first, 0.0)
    cells = (places / law.step).astype(np.int64)
    nodes = np.asarray(first + law.step * np.arange(int(cells.max(initial=below)) + 1), dtype=np.float64)
    sums = np.concatenate([[0.0], np.cumsum(over(nodes, np.full(nodes.size, law.step)))])
    found = sums[cells] - sums[below] + over(nodes[cells], places - law.step * cells)
    return np.asarray(found.reshape(approach.shape))


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


@dataclass(frozen=True, eq=False)
class PairLaw:
    """Laws of the inner and the outer contact of a rolling element at one speed; kinds inherit from it.

    Attributes
    ----------
    inner, outer : NormalLaw
        Laws for the kernel; without tables for dry contacts.
    loads : (float, float)
        Lowest and highest load for which both were made [N]; 0 and infinity for dry contacts.
    """

    inner: NormalLaw
    outer: NormalLaw
    loads: tuple[float, float] = (0.0, math.inf)

    @property
    def sides(self) -> tuple[NormalLaw, NormalLaw]:
        """Inner and outer."""
        return self.inner, self.outer

    @property
    def dry(self) -> bool:
        """Sign of contacts without films."""
        return self.inner.table.size == 0 and self.outer.table.size == 0

    @cached_property
    def springs(self) -> tuple[FloatArray, FloatArray]:
        """Springs of films with memory at the rows of both tables, see `springs_on`; none of dry contacts."""
        inner, outer = (
            self.springs_on(side, law, law.table) if law.table.size else np.zeros((0, 1))
            for side, law in enumerate(self.sides)
        )
        return inner, outer

    def springs_on(self, side: int, law: NormalLaw, table: FloatArray) -> FloatArray:
        """Springs of films with memory [N/m] at the rows of a table, and the longest of their times [s], (rows, r + 1).

        Parameters
        ----------
        side : int
            0 the inner contact.
        law : NormalLaw
            Law of the table.
        table : array (rows, 4)
            The table.
        """
        raise NotImplementedError
