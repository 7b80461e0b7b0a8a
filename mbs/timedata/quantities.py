"""Units of channels: what was measured by them, and how they become SI."""

from __future__ import annotations

import math
from typing import Literal

from ehdmaps.errors import InputError
from ehdmaps.units import closest
from mbs.model.elements import Quantity

Recorded = Literal["displacement", "velocity", "acceleration", "speed", "time", "other"]
"""What a channel may be: motion, the speed of the system, time, or anything else, such as the voltage of a tacho."""

STANDARD_GRAVITY = 9.80665
"""[m/s2], of a channel in g."""

_TURN = 2.0 * math.pi
_UNITS: dict[str, tuple[Recorded, str, float]] = {
    "m/s2": ("acceleration", "m/s2", 1.0),
    "mm/s2": ("acceleration", "m/s2", 1e-3),
    "g": ("acceleration", "m/s2", STANDARD_GRAVITY),
    "rad/s2": ("acceleration", "rad/s2", 1.0),
    "m/s": ("velocity", "m/s", 1.0),
    "mm/s": ("velocity", "m/s", 1e-3),
    "rad/s": ("velocity", "rad/s", 1.0),
    "m": ("displacement", "m", 1.0),
    "mm": ("displacement", "m", 1e-3),
    "um": ("displacement", "m", 1e-6),
    "nm": ("displacement", "m", 1e-9),
    "rad": ("displacement", "rad", 1.0),
    "deg": ("displacement", "rad", _TURN / 360.0),
    "rpm": ("speed", "rad/s", _TURN / 60.0),
    "1/min": ("speed", "rad/s", _TURN / 60.0),
    "min-1": ("speed", "rad/s", _TURN / 60.0),
    "r/min": ("speed", "rad/s", _TURN / 60.0),
    "U/min": ("speed", "rad/s", _TURN / 60.0),
    "Hz": ("speed", "rad/s", _TURN),
    "1/s": ("speed", "rad/s", _TURN),
    "s-1": ("speed", "rad/s", _TURN),
    "s": ("time", "s", 1.0),
    "ms": ("time", "s", 1e-3),
    "us": ("time", "s", 1e-6),
    "V": ("other", "V", 1.0),
    "mV": ("other", "V", 1e-3),
    "N": ("other", "N", 1.0),
    "1": ("other", "1", 1.0),
}
_SPEED_NAMES = ("speed", "rotational speed", "n")

SPEED_UNITS = ("rpm", "rad/s", "Hz")
"""Some units of a speed, for messages."""

SHOWN = "m/s2, g, m/s, mm/s, m, um, rad, rpm, Hz, V"
"""Some units, for messages."""


def plain(unit: str) -> str:
    """A unit in the letters of the table: ``m/s^2`` and ``m/s²`` are ``m/s2``.

    Examples
    --------
    >>> plain("m/s^2"), plain("µm"), plain("RPM")
    ('m/s2', 'um', 'rpm')
    """
    text = unit.strip().replace("²", "2").replace("**", "").replace("^", "").replace("µ", "u").replace("μ", "u")
    return "rpm" if text.lower() == "rpm" else text


def read_unit(unit: str, name: str) -> tuple[Recorded, str, float]:
    """Quantity of a channel by its unit, the SI unit, and the factor to it.

    Parameters
    ----------
    unit : str
        Unit as it stands in a file.
    name : str
        Name of the channel: one in rad/s that is called a speed is the speed of the system.

    Raises
    ------
    InputError
        If the unit is not known; the caller says where.

    Examples
    --------
    >>> read_unit("g", "S1")
    ('acceleration', 'm/s2', 9.80665)
    """
    entry = _UNITS.get(plain(unit))
    if entry is None:
        raise InputError(f"got the unit {unit!r:.40}{closest(plain(unit), tuple(_UNITS))}; allowed: {SHOWN}")
    if entry[1] == "rad/s" and name.strip().lower() in _SPEED_NAMES:
        return ("speed", "rad/s", entry[2])
    return entry


def motion(recorded: Recorded) -> Quantity | None:
    """The quantity of a channel that has levels; None of any other channel."""
    return recorded if recorded in ("displacement", "velocity", "acceleration") else None
