"""What a machine is put through, as a scene says it: the tables [drive] of a run-up, [sweep] and [campbell]."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.jobs.table import Table
from ehdmaps.units import RPM, Display, short
from mbs.model.drive import Drive, TorqueCurve
from mbs.scene import fields
from mbs.scene.fields import HERTZ, MILLISECOND, MOMENT
from mbs.settings import HIGHEST, MOST_SPEEDS, CampbellSettings, SweepRange

MOST_POINTS = 1000
"""Points of a torque over speed."""

_LARGEST = 1e9
"""Largest torque [N m]."""

LOWEST_HIGHEST, HIGHEST_HIGHEST = 1.0, 1e6
"""Limits of the highest frequency [Hz]."""

SHORTEST, LONGEST = 1e-6, 1e3
"""Limits of the window [s]."""

_MOST_ORDERS = 50
_LARGEST_ORDER = 1e4


def read_drive(section: Table) -> Drive | None:
    """Read a drive; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    """
    inertia = section.quantity("inertia", "kg m^2", 1e-12, 1e9, Display("kg m^2"), required=True)
    motor = _read_torque(section, "motor", 'a torque such as "12 N m", or { speeds = [...], torques = [...] }')
    load = _read_torque(section, "load", "")
    until = section.quantity("motor_until", "s", 1e-9, 1e6, Display("s"))
    if inertia is None or motor is None or load is None:
        return None
    return fields.built(section, lambda: Drive(inertia, motor, load, math.inf if until is None else until))


def _read_torque(section: Table, key: str, required: str) -> TorqueCurve | None:
    """Read a torque, constant or over speed; none at all if it may be absent and is."""
    value = section.get(key, required)
    if key not in section:
        return None if required else TorqueCurve.constant(0.0)
    if not isinstance(value, dict):
        torque = section.quantity_of(value, key, "N m", -_LARGEST, _LARGEST, MOMENT)
        return None if torque is None else TorqueCurve.constant(torque)
    table = Table(value, f"{section.where} {key}", section.problems)
    before = len(table.problems)
    speeds, torques = (table.get(name, "a list") for name in ("speeds", "torques"))
    table.close()
    if not (isinstance(speeds, list) and isinstance(torques, list) and 2 <= len(speeds) == len(torques) <= MOST_POINTS):
        table.note("speeds", f"got {short(speeds)} and {short(torques)}; allowed: 2 to {MOST_POINTS} of each, as many")
        return None
    at = [table.quantity_of(part, f"speeds[{k}]", "rad/s", 0.0, 1e5, RPM) for k, part in enumerate(speeds)]
    found = [
        table.quantity_of(part, f"torques[{k}]", "N m", -_LARGEST, _LARGEST, MOMENT) for k, part in enumerate(torques)
    ]
    if len(table.problems) > before:
        return None
    given = [part for part in at if part is not None]
    if np.any(np.diff(given) <= 0.0):
        table.note("speeds", f"got {short(speeds)}; allowed: each above the last")
        return None
    return TorqueCurve(tuple(given), tuple(part for part in found if part is not None))


def read_sweep(section: Table) -> SweepRange | None:
    """Read from, to and points; None where a problem was noted.

    Parameters
    ----------
    section : Table
        [sweep]; whoever calls closes it.
    """
    begin = section.quantity("from", "rad/s", 0.0, 1e5, RPM, required=True)
    end = section.quantity("to", "rad/s", 0.0, 1e5, RPM, required=True)
    points = section.integer("points", 2, MOST_SPEEDS, required=True)
    if begin is None or end is None or points is None:
        return None
    return fields.built(section, lambda: SweepRange(begin, end, points))


def read_campbell(section: Table) -> CampbellSettings | None:
    """Read [campbell]; None where a problem was noted. All keys may be left out."""
    before = len(section.problems)
    sensor = fields.text(section, "sensor")
    highest = section.quantity("highest", "Hz", LOWEST_HIGHEST, HIGHEST_HIGHEST, HERTZ)
    window = section.quantity("window", "s", SHORTEST, LONGEST, MILLISECOND)
    orders = _read_orders(section)
    if len(section.problems) > before:
        return None
    return CampbellSettings(sensor, HIGHEST if highest is None else highest, window, orders)


def _read_orders(section: Table) -> tuple[float, ...]:
    """Read a list of orders; empty if absent or wrong."""
    values = section.get("orders")
    if "orders" not in section:
        return ()
    allowed = f"a list of 1 to {_MOST_ORDERS} numbers above 0, up to {_LARGEST_ORDER:g}, such as [21, 42]"
    if not isinstance(values, list) or not 1 <= len(values) <= _MOST_ORDERS:
        section.note("orders", f"got {short(values)}; allowed: {allowed}")
        return ()
    for value in values:
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not number or not 0.0 < value <= _LARGEST_ORDER:
            section.note("orders", f"got {short(value)} in the list; allowed: {allowed}")
            return ()
    return tuple(float(value) for value in values)
