"""Reading [campbell]: what of a run-up `mbs campbell` looks at."""

from __future__ import annotations

from ehdmaps.jobs.table import Table
from ehdmaps.units import short
from mbs.scene import fields
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.settings import HIGHEST, CampbellSettings

LOWEST_HIGHEST, HIGHEST_HIGHEST = 1.0, 1e6
"""Limits of the highest frequency [Hz]."""

SHORTEST, LONGEST = 1e-6, 1e3
"""Limits of the window [s]."""

_MOST_ORDERS = 50
_LARGEST_ORDER = 1e4


def read_campbell(section: Table) -> CampbellSettings | None:
    """Read [campbell]; None where a problem was noted. All keys may be left out."""
    before = len(section.problems)
    sensor = fields.text(section, "sensor")
    highest = section.quantity("highest", "Hz", LOWEST_HIGHEST, HIGHEST_HIGHEST, HERTZ)
    window = section.quantity("window", "s", SHORTEST, LONGEST, MILLISECOND)
    orders = _orders(section)
    if len(section.problems) > before:
        return None
    return CampbellSettings(sensor, HIGHEST if highest is None else highest, window, orders)


def _orders(section: Table) -> tuple[float, ...]:
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
