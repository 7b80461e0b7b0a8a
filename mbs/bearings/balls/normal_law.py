"""Compiled law of a ball's contact over its approach: load, stiffness, damping.

Each law is F = C g^(3/2), with the dry overlap g = approach, or with g(approach) from a table for films.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit

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


@njit(error_model="numpy", _nrt=False, forceinline=True)
def holding(law: NormalLaw, held: FloatArray, j: int, side: int) -> NormalLaw:
    """A law with what its film holds over a step.

    Parameters
    ----------
    law : NormalLaw
        The law at rest.
    held : array (Z, 2, HELD)
        What the contacts hold.
    j, side : int
        Which contact.
    """
    return NormalLaw(
        law.coefficient, law.damping, law.damping_time, law.centre, law.scale, law.first, law.step,
        held[j, side, 0], held[j, side, 1], held[j, side, 2], law.table,
    )  # fmt: skip


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _asinh(x: float) -> tuple[float, float]:
    """Its value, to the round-off of 1, and one over its slope."""
    root = math.sqrt(1.0 + x * x)
    size = math.log(abs(x) + root)
    return (size if x >= 0.0 else -size), root


@njit(error_model="numpy", _nrt=False, forceinline=True)
def with_held(load: float, stiffness: float, held: float, spring: float) -> tuple[float, float]:
    """Load [N] and stiffness [N/m] of a film with memory at the end of a step; never a tension.

    Parameters
    ----------
    load, stiffness : float
        Load > 0 [N] and stiffness [N/m] at rest.
    held, spring : float
        Force beside it [N], and its spring [N/m].
    """
    if held >= 0.0:
        return load + held, stiffness + spring
    size = math.sqrt(held * held + load * load)
    total = load * load / (size - held)
    return total, (spring * total + stiffness * load) / size


@njit(error_model="numpy", _nrt=False, forceinline=True)
def carried(law: NormalLaw, approach: float) -> tuple[float, float, float]:
    """Load [N] and stiffness [N/m] at rest, or at the end of a step with memory; place on the table, 0 without one.

    Parameters
    ----------
    law : NormalLaw
        Law of the contact.
    approach : float
        Approach [m].
    """
    if law.table.shape[0] == 0:
        if approach <= 0.0:
            return 0.0, 0.0, 0.0
        root = law.coefficient * math.sqrt(approach)
        return root * approach, 1.5 * root, 0.0
    z, root = _asinh((approach - law.centre) * (1.0 / law.scale))
    place = (z - law.first) * (1.0 / law.step)
    cell = min(max(int(place), 0), law.table.shape[0] - 2)
    t = place - cell
    low, rise = law.table[cell, 0], law.table[cell, 1]
    high, rise_high = law.table[cell + 1, 0], law.table[cell + 1, 1]
    if t < 0.0:  # straight beyond the ends
        value, slope = low + rise * t, rise
    elif t > 1.0:
        value, slope = high + rise_high * (t - 1.0), rise_high
    else:
        r = 1.0 - t
        value = low + t * t * (3.0 - 2.0 * t) * (high - low) + t * r * (rise * r - rise_high * t)
        slope = 6.0 * t * r * (high - low) + rise * r * (r - 2.0 * t) + rise_high * t * (t - 2.0 * r)
    load = law.coefficient * math.exp(1.5 * value)
    k = 1.5 * load * slope / (law.scale * law.step * root)
    if law.spring <= 0.0:
        return load, k, place
    total, k = with_held(load, k, law.held + law.spring * (approach - law.at), law.spring)
    return total, k, place


@njit(error_model="numpy", _nrt=False, forceinline=True)
def slowed(law: NormalLaw, stiffness: float, place: float) -> float:
    """Damping of a contact at rest [N s/m]; none of one with memory, which is in its stiffness.

    Parameters
    ----------
    law : NormalLaw
        Law of the contact.
    stiffness, place : float
        Stiffness [N/m] and place on the table, of `carried`.
    """
    if law.table.shape[0] == 0:
        return law.damping + law.damping_time * stiffness if stiffness > 0.0 else 0.0
    if law.spring > 0.0:
        return 0.0
    cell = min(max(int(place), 0), law.table.shape[0] - 2)
    t = place - cell
    low, rise = law.table[cell, 2], law.table[cell, 3]
    high, rise_high = law.table[cell + 1, 2], law.table[cell + 1, 3]
    if t < 0.0:
        return math.exp(low + rise * t)
    if t > 1.0:
        return math.exp(high + rise_high * (t - 1.0))
    r = 1.0 - t
    return math.exp(low + t * t * (3.0 - 2.0 * t) * (high - low) + t * r * (rise * r - rise_high * t))


@njit(error_model="numpy", _nrt=False)
def contact(law: NormalLaw, approach: float) -> tuple[float, float, float]:
    """Load [N], stiffness [N/m] and damping [N s/m] of a contact at rest, or at the end of a step with memory.

    Parameters
    ----------
    law : NormalLaw
        Law of the contact.
    approach : float
        Approach [m].
    """
    load, k, place = carried(law, approach)
    return load, k, slowed(law, k, place)


@njit(error_model="numpy", _nrt=False)
def load_approach(law: NormalLaw, load: float) -> float:
    """Approach at which a contact carries a load > 0 [m].

    Parameters
    ----------
    law : NormalLaw
        Law of the contact.
    load : float
        Load [N].
    """
    g: float = (load / law.coefficient) ** (2.0 / 3.0)
    if law.table.shape[0] == 0:
        return g
    low, high = float(law.centre - 1e3 * law.scale), float(g + 1e3 * law.scale)
    for _ in range(200):
        middle = 0.5 * (low + high)
        if contact(law, middle)[0] < load:
            low = middle
        else:
            high = middle
        if high - low <= 1e-15 * law.scale:
            break
    return 0.5 * (low + high)


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


def nothing_held() -> FloatArray:
    """Numbers that contacts without memory hold: none."""
    return np.zeros((0, 2, HELD))
