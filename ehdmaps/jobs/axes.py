"""The axes of the grid: from-to-points tables or lists of strings, in SI, rising."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

from ehdmaps.jobs.table import Table
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.units import LOAD, RPM, SPEED, TEMPERATURE, Display, short

MOST_VALUES = 100_000
"""Values on one axis; the product of the axes has its own limit."""


@dataclass(frozen=True)
class AxisRule:
    """What one axis of the grid may hold.

    Attributes
    ----------
    key, unit : str
        Name in [grid], SI unit.
    low, high : float
        Allowed values; wide enough for every bearing, tight enough to catch a wrong unit.
    display : Display
        Unit and format for messages.
    """

    key: str
    unit: str
    low: float
    high: float
    display: Display


LOAD_AXIS = AxisRule("load", "N/m", 1.0, 1e7, LOAD)
SPEED_AXIS = AxisRule("entrainment_speed", "m/s", 0.0, 200.0, SPEED)
RING_SPEED_AXIS = AxisRule("inner_ring_speed", "rad/s", 0.0, 1e5, RPM)
TEMPERATURE_AXIS = AxisRule("temperature", "K", *OIL_TEMPERATURES, TEMPERATURE)


def read_speeds(grid: Table, bearing: BearingGeometry | None, known: bool = True) -> tuple[float, ...] | None:
    """Read the speed axis of [grid]: entrainment speeds, or speeds of the inner ring of a bearing.

    Parameters
    ----------
    grid : Table
        [grid].
    bearing : BearingGeometry or None
        Whose inner ring turns, the outer one fixed; None where there is none, or it was wrong already.
    known : bool
        False where the bearing was wrong already, which need not be said again.

    Returns
    -------
    tuple of float or None
        Rising entrainment speeds [m/s]; None where a problem was noted.
    """
    ring, own = RING_SPEED_AXIS.key, SPEED_AXIS.key
    if ring not in grid:
        return read_axis(grid, SPEED_AXIS)
    speeds = read_axis(grid, RING_SPEED_AXIS)
    if own in grid:
        grid.get(own)
        grid.note(ring, f"stands beside {own}; allowed: one of the two; delete one")
        return None
    if bearing is None and not known:
        return None
    if bearing is None:
        grid.note(ring, f"got no bearing to turn; allowed: with a [bearing]; give {own} in m/s for a bare contact")
        return None
    found = tuple(bearing.entrainment_speed(speed) for speed in speeds or ())
    if found and found[-1] > SPEED_AXIS.high:
        limit = RPM.text(bearing.inner_speed(SPEED_AXIS.high))
        grid.note(ring, f"got {RPM.text((speeds or (0.0,))[-1])}; allowed: up to {limit} for this bearing")
        return None
    return found or None


def read_axis(grid: Table, rule: AxisRule) -> tuple[float, ...] | None:
    """Read one axis of [grid].

    Returns
    -------
    tuple of float or None
        Rising values in SI; None where a problem was noted.
    """
    form = '{ from = "...", to = "...", points = ..., spacing = "log" } or a list of strings'
    value = grid.get(rule.key, required=form)
    if rule.key not in grid:
        return None
    if isinstance(value, dict):
        return _spaced(Table(value, f"{grid.where} {rule.key}", grid.problems), rule)
    if isinstance(value, list):
        return _listed(value, grid, rule)
    grid.note(rule.key, f"got {short(value)}; allowed: {form}")
    return None


def _spaced(table: Table, rule: AxisRule) -> tuple[float, ...] | None:
    """Read the from-to-points form."""
    before = len(table.problems)
    first = table.quantity("from", rule.unit, rule.low, rule.high, rule.display, required=True)
    last = table.quantity("to", rule.unit, rule.low, rule.high, rule.display, required=True)
    points = table.integer("points", 2, MOST_VALUES, required=True)
    spacing = table.choice("spacing", ("log", "linear"), required=True)
    table.close()
    if first is not None and last is not None and not first < last:
        table.note("from", f"got {rule.display.text(first)}, not below to = {rule.display.text(last)}; exchange them")
    if first is not None and first <= 0 and spacing == "log":
        table.note(
            "from",
            f'got {rule.display.text(first)}; a log axis starts above zero; raise it or use spacing = "linear"',
        )
    if len(table.problems) > before or first is None or last is None or points is None:
        return None
    steps = [index / (points - 1) for index in range(1, points - 1)]
    if spacing == "log":
        inside = [first * math.exp(step * math.log(last / first)) for step in steps]
    else:
        inside = [first + step * (last - first) for step in steps]
    values = (first, *inside, last)
    if any(b <= a for a, b in pairwise(values)):
        table.note("points", f"got {points}; the values fall together; use fewer, or a wider range")
        return None
    return values


def _listed(entries: list[object], grid: Table, rule: AxisRule) -> tuple[float, ...] | None:
    """Read the list form."""
    if not entries:
        grid.note(rule.key, "got an empty list; allowed: at least one value")
        return None
    if len(entries) > MOST_VALUES:
        grid.note(rule.key, f"got {len(entries)} values; allowed: at most {MOST_VALUES}")
        return None
    before = len(grid.problems)
    values = [
        grid.quantity_of(entry, f"{rule.key}[{index}]", rule.unit, rule.low, rule.high, rule.display)
        for index, entry in enumerate(entries)
    ]
    found = [value for value in values if value is not None]
    if len(grid.problems) > before or len(found) < len(values):
        return None
    for index in range(1, len(found)):
        if found[index] <= found[index - 1]:
            word = "twice" if found[index] == found[index - 1] else "after " + rule.display.text(found[index - 1])
            grid.note(
                rule.key,
                f"got {rule.display.text(found[index])} {word}; allowed: rising values, each once; sort the list",
            )
            return None
    return tuple(found)
