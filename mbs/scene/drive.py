"""The drive of a scene: the table [drive], by which [runup] has a speed by torques instead of a prescribed one."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.jobs.table import Table
from ehdmaps.units import RPM, Display, short
from mbs.model.drive import Drive, TorqueCurve
from mbs.scene import fields
from mbs.scene.fields import MOMENT

MOST_POINTS = 1000
"""Points of a torque over speed."""

_LARGEST = 1e9


def read_drive(section: Table) -> Drive | None:
    """Read a drive; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    """
    inertia = section.quantity("inertia", "kg m^2", 1e-12, 1e9, Display("kg m^2"), required=True)
    motor = _torque(section, "motor", 'a torque such as "12 N m", or { speeds = [...], torques = [...] }')
    load = _torque(section, "load", "")
    until = section.quantity("motor_until", "s", 1e-9, 1e6, Display("s"))
    if inertia is None or motor is None or load is None:
        return None
    return fields.built(section, lambda: Drive(inertia, motor, load, math.inf if until is None else until))


def _torque(section: Table, key: str, required: str) -> TorqueCurve | None:
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
