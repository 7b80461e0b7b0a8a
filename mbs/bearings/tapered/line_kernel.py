"""Compiled sums over the slices of a line of a roller: load, stiffness, damping; dry, with a film, or with its memory.

Without branches or calls, so that slices stand side by side in vector instructions. Sums of a line are Q, Q b; k, k b,
k b b; the same of c, b the levers of the slices.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.lines import FAST, exp, stretched
from mbs.bearings.balls.normal_law import NormalLaw, with_held
from mbs.bearings.slices import power

PULL, SPRING, AT = range(3)
"""Rows of what slices hold over a step: force [N] at the approach `AT` [m], and spring of the end of the step [N/m], of
a whole roller."""

_NO_APPROACH = 1e-290
"""Approach in the place of none [m], whose power is a number."""

_SHIFT, _WHOLE = 2.0**52, np.uint64(2**52 - 1)


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def dry_line(
    law: tuple[float, float, float],
    approach: float,
    turn: float,
    levers: FloatArray,
    profile: FloatArray,
    sums: FloatArray,
) -> None:
    """Sums of a dry line.

    Parameters
    ----------
    law : (float, float, float)
        C of a slice [N/m^(10/9)], damping of one that carries [N s/m], and damping over stiffness [s].
    approach, turn : float
        Approach of the line [m], and rotation [rad].
    levers, profile : array (n,)
        Levers of the slices, and depths of the profile [m].
    sums : array (8,)
        Sums of the line, which are written.
    """
    each, damper, time = law
    q = qb = k = kb = kbb = n = nb = nbb = 0.0
    for i in range(levers.size):
        lever = levers[i]
        g = approach + turn * lever - profile[i]
        on = 1.0 if g > 0.0 else 0.0
        root = on * each * power(g if g > _NO_APPROACH else _NO_APPROACH, 1.0 / 9.0)
        q += root * g
        qb += root * g * lever
        k += root
        kb += root * lever
        kbb += root * lever * lever
        n += on
        nb += on * lever
        nbb += on * lever * lever
    by_root = 10.0 / 9.0
    sums[0], sums[1] = q, qb
    sums[2], sums[3], sums[4] = by_root * k, by_root * kb, by_root * kbb
    sums[5] = damper * n + time * sums[2]
    sums[6] = damper * nb + time * sums[3]
    sums[7] = damper * nbb + time * sums[4]


@njit(error_model="numpy", fastmath=FAST, _nrt=False, forceinline=True)
def cell_of_place(place: float, last: float) -> tuple[np.uint64, float]:
    """Row of a table in which a place is, up to the row `last`, and where beyond it; outside 0 to 1 beyond the ends."""
    x = place if place > 0.0 else 0.0
    x = x if x < last else last
    low = math.floor(x)
    return np.uint64(np.float64(low + _SHIFT).view(np.uint64) & _WHOLE), place - low


@njit(error_model="numpy", fastmath=FAST, _nrt=False, forceinline=True)
def _hermite(table: FloatArray, cell: np.uint64, first: int, t: float) -> tuple[float, float]:
    """Value and slope of a column and its slope in a cell; straight beyond it."""
    one, value_at, rise_at = np.uint64(1), np.uint64(first), np.uint64(first + 1)
    low, rise = table[cell, value_at], table[cell, rise_at]
    change, rise_high = table[cell + one, value_at] - low, table[cell + one, rise_at]
    s = t if t > 0.0 else 0.0
    s = s if s < 1.0 else 1.0
    r = 1.0 - s
    slope = 6.0 * s * r * change + rise * r * (r - 2.0 * s) + rise_high * s * (s - 2.0 * r)
    value = low + s * s * (3.0 - 2.0 * s) * change + s * r * (rise * r - rise_high * s)
    return value + slope * (t - s), slope


@njit(error_model="numpy", fastmath=FAST, _nrt=False, forceinline=True)
def find_places(
    law: NormalLaw, approach: float, turn: float, levers: FloatArray, profile: FloatArray, places: FloatArray
) -> None:
    """Write the places of slices on the table; apart from what reads there, which may lie where this is written.

    Parameters
    ----------
    law, approach, turn, levers, profile, places
        The same as of `film_line`.
    """
    inverse, per = 1.0 / law.scale, 1.0 / law.step
    for i in range(levers.size):
        z = stretched((approach + turn * levers[i] - profile[i] - law.centre) * inverse)[0]
        places[i] = (z - law.first) * per


@njit(error_model="numpy", fastmath=FAST, _nrt=False, forceinline=True)
def _at_rest(law: NormalLaw, approach: float, place: float) -> tuple[float, float]:
    """Load and stiffness at a place on the table, as `mbs.bearings.balls.normal_law.carried` has them."""
    cell, t = cell_of_place(place, law.table.shape[0] - 2.0)
    value, slope = _hermite(law.table, cell, 0, t)
    load = law.coefficient * exp(1.5 * value)
    z = (approach - law.centre) * (1.0 / law.scale)
    return load, 1.5 * load * slope / math.sqrt(1.0 + z * z) * (1.0 / (law.scale * law.step))


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def film_line(
    law: NormalLaw,
    approach: float,
    turn: float,
    levers: FloatArray,
    profile: FloatArray,
    places: FloatArray,
    sums: FloatArray,
) -> None:
    """Sums of a line with a film at rest, but for damping.

    Parameters
    ----------
    law : NormalLaw
        Table of a whole roller.
    approach, turn : float
        Approach of the line [m], and rotation [rad].
    levers, profile : array (n,)
        Levers of the slices, and depths of the profile [m].
    places : array (n,)
        Places on the table; written.
    sums : array (8,)
        Sums of the line, which are written.
    """
    find_places(law, approach, turn, levers, profile, places)
    q = qb = k = kb = kbb = 0.0
    for i in range(levers.size):
        lever = levers[i]
        load, slope = _at_rest(law, approach + turn * lever - profile[i], places[i])
        q += load
        qb += load * lever
        k += slope
        kb += slope * lever
        kbb += slope * lever * lever
    _mean(q, qb, k, kb, kbb, levers.size, sums)


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def held_line(
    law: NormalLaw,
    pull: FloatArray,
    spring: FloatArray,
    at: FloatArray,
    approach: float,
    turn: float,
    levers: FloatArray,
    profile: FloatArray,
    places: FloatArray,
    sums: FloatArray,
) -> None:
    """Sums of a line at the end of a step with memory, see `mbs.bearings.tapered.tapered_memory`.

    Parameters
    ----------
    law : NormalLaw
        Table of a whole roller.
    pull, spring, at : array (n,)
        Rows that slices hold.
    approach, turn, levers, profile, places, sums
        The same as of `film_line`.
    """
    find_places(law, approach, turn, levers, profile, places)
    q = qb = k = kb = kbb = 0.0
    for i in range(levers.size):
        lever = levers[i]
        g = approach + turn * lever - profile[i]
        rest, soft = _at_rest(law, g, places[i])
        load, slope = with_held(rest, soft, pull[i] + spring[i] * (g - at[i]), spring[i])
        q += load
        qb += load * lever
        k += slope
        kb += slope * lever
        kbb += slope * lever * lever
    _mean(q, qb, k, kb, kbb, levers.size, sums)


@njit(error_model="numpy", fastmath=FAST, _nrt=False, forceinline=True)
def _mean(q: float, qb: float, k: float, kb: float, kbb: float, count: int, sums: FloatArray) -> None:
    """Write sums of slices that are parts of a roller."""
    part = 1.0 / count
    sums[0], sums[1], sums[2], sums[3], sums[4] = q * part, qb * part, k * part, kb * part, kbb * part
    sums[5] = sums[6] = sums[7] = 0.0


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def film_dampers(law: NormalLaw, places: FloatArray, levers: FloatArray, sums: FloatArray) -> None:
    """Damping of a line with a film in slow motion.

    Parameters
    ----------
    law, places, levers
        The same as of `film_line`, which wrote the places.
    sums : array (8,)
        The last three are written.
    """
    c0 = c1 = c2 = 0.0
    for i in range(levers.size):
        cell, t = cell_of_place(places[i], law.table.shape[0] - 2.0)
        c = exp(_hermite(law.table, cell, 2, t)[0])
        c0 += c
        c1 += c * levers[i]
        c2 += c * levers[i] * levers[i]
    part = 1.0 / levers.size
    sums[5], sums[6], sums[7] = c0 * part, c1 * part, c2 * part


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def held_dampers(law: NormalLaw, spring: FloatArray, places: FloatArray, levers: FloatArray, sums: FloatArray) -> None:
    """Damping of the slices of a line with memory that have no spring.

    Parameters
    ----------
    law : NormalLaw
        Table of a whole roller.
    spring : array (n,)
        Springs that slices hold.
    places, levers, sums
        The same as of `film_dampers`.
    """
    least = math.inf
    for i in range(levers.size):
        least = min(least, spring[i])
    if least > 0.0:
        return
    c0 = c1 = c2 = 0.0
    for i in range(levers.size):
        if spring[i] <= 0.0:
            cell, t = cell_of_place(places[i], law.table.shape[0] - 2.0)
            c = exp(_hermite(law.table, cell, 2, t)[0])
            c0 += c
            c1 += c * levers[i]
            c2 += c * levers[i] * levers[i]
    part = 1.0 / levers.size
    sums[5], sums[6], sums[7] = c0 * part, c1 * part, c2 * part
