"""Read [sweep] of a scene: the speeds of `mbs sweep`."""

from __future__ import annotations

from ehdmaps.jobs.table import Table
from ehdmaps.units import RPM
from mbs.scene import fields
from mbs.settings import MOST_SPEEDS, SweepRange


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
