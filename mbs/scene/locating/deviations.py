"""Deviations of a bearing from its form in a scene: `waviness`, `size_difference` and `spall` of [[bearings]]."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from ehdmaps.jobs.table import Table
from ehdmaps.units import short
from mbs.bearings.deviating.tables import PARTS, Deviations, Spall, Wave, spectrum
from mbs.scene.fields import DEGREE, MICROMETRE
from mbs.scene.specs import BearingSpec, LocatingSpec

KEYS = ("waviness", "size_difference", "spall")
"""Keys of [[bearings]] that are read here."""

MOST_WAVES = 1000
"""Waves in a turn."""

_LARGEST, _SMALLEST = 1e-3, 1e-12
"""Sizes of deviations [m]."""

_TURN = 2.0 * math.pi


def read_deviations(section: Table, spec: Any) -> Any:
    """Read the deviations of a bearing that was read; the bearing with them.

    Parameters
    ----------
    section : Table
        A table [[bearings]].
    spec : BearingSpec, LocatingSpec, MatrixSpec or None
        The bearing; None where a problem was noted.
    """
    if spec is not None and not isinstance(spec, BearingSpec | LocatingSpec):
        for key in KEYS:
            if section.get(key) is not None:
                section.note(key, "has no effect on a bearing by matrices; allowed: bearings with rolling elements")
        return spec
    found = stated_deviations(section, MOST_WAVES if spec is None else spec.geometry.bodies)
    if spec is None or found == Deviations():
        return spec
    if isinstance(spec, BearingSpec) and spec.between_ribs is not None:
        spec = dataclasses.replace(spec, between_ribs=dataclasses.replace(spec.between_ribs, deviations=found))
    return dataclasses.replace(spec, deviations=found)


def stated_deviations(section: Table, count: int) -> Deviations:
    """Read the deviations that a table states.

    Parameters
    ----------
    section : Table
        What has the keys.
    count : int
        Number of rolling elements.
    """
    waves = [wave for table in section.tables("waviness", "a list of tables") for wave in _waves(table, count)]
    spalls = [one for table in section.tables("spall", "a list of tables") if (one := _spall(table, count)) is not None]
    return Deviations(tuple(waves), tuple(spalls), _sizes(section, count))


def _element(table: Table, on: str | None, count: int) -> int | None:
    """Number of the rolling element; None for all of them."""
    number = table.integer("element", 1, count)
    if number is not None and on != "elements":
        table.note("element", f'got {number} beside on = "{on}"; allowed: with on = "elements"')
    return number


def _waves(table: Table, count: int) -> tuple[Wave, ...]:
    """Read an entry of `waviness`: one wave, or a range of them with phases by chance."""
    on, number = (
        table.choice("on", PARTS, required=True),
        table.get("waves", "a whole number, or the first and the last"),
    )
    amplitude = table.quantity("amplitude", "m", _SMALLEST, _LARGEST, MICROMETRE, required=True)
    element = _element(table, on, count)
    several = isinstance(number, list)
    given = number if several else [number]
    whole = all(isinstance(n, int) and not isinstance(n, bool) and 1 <= n <= MOST_WAVES for n in given)
    sound = whole and (not several or (len(given) == 2 and given[0] <= given[1]))
    if number is not None and not sound:
        allowed = f"a whole number from 1 to {MOST_WAVES}, or a list of the first and the last one"
        table.note("waves", f"got {short(number)}; allowed: {allowed}")
    if several:
        decay, seed = table.number("decay", 0.0, 10.0), table.integer("seed", 0, 2**31 - 1) or 0
    else:
        phase = table.quantity("phase", "rad", -_TURN, _TURN, DEGREE) or 0.0
    table.close()
    if on is None or amplitude is None or number is None or not sound:
        return ()
    part = next(one for one in PARTS if one == on)
    if not several:
        return (Wave(part, number, amplitude, phase, element),)
    alone = tuple(range(1, count + 1)) if part == "elements" and element is None else (element,)
    return spectrum(part, (given[0], given[1]), amplitude, 1.0 if decay is None else decay, seed, alone)


def _spall(table: Table, count: int) -> Spall | None:
    """Read an entry of `spall`."""
    on = table.choice("on", PARTS, required=True)
    angle = table.quantity("angle", "rad", -_TURN, _TURN, DEGREE) or 0.0
    length = table.quantity("length", "m", 1e-5, 0.1, MICROMETRE, required=True)
    depth = table.quantity("depth", "m", _SMALLEST, _LARGEST, MICROMETRE, required=True)
    element = _element(table, on, count)
    table.close()
    if on is None or length is None or depth is None:
        return None
    return Spall(next(one for one in PARTS if one == on), angle, length, depth, element)


def _sizes(section: Table, count: int) -> tuple[float, ...]:
    """Read `size_difference`: lengths in the order of the rolling elements."""
    given = section.get("size_difference")
    if given is None:
        return ()
    if not isinstance(given, list) or len(given) > count:
        section.note(
            "size_difference", f"got {short(given)}; allowed: a list of at most {count} lengths, one an element"
        )
        return ()
    found = [
        section.quantity_of(one, f"size_difference[{index}]", "m", -_LARGEST, _LARGEST, MICROMETRE)
        for index, one in enumerate(given)
    ]
    return tuple(one or 0.0 for one in found)
