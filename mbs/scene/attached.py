"""Reads what is fixed to the frames of a flexible body: the key `attached` of a table [[flexible]]."""

from __future__ import annotations

from ehdmaps.jobs.table import Table
from ehdmaps.units import short
from mbs.flexible.attached import Attached
from mbs.scene import fields


def read_attached(section: Table) -> tuple[Attached, ...] | None:
    """Read hollow cylinders on frames; none if the key is absent, None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table of the body.
    """
    given = section.get("attached")
    if "attached" not in section:
        return ()
    if not isinstance(given, list):
        section.note("attached", f"got {short(given)}; allowed: a list of tables with at, from, to, diameter")
        return None
    before = len(section.problems)
    parts = []
    for index, values in enumerate(given):
        table = Table(values, f"{section.where} attached[{index}]", section.problems)
        frame = table.get("at", 'the name of a frame, such as "left"')
        inertia = fields.cylinder(table)
        if "at" in table and not isinstance(frame, str):
            table.note("at", f"got {short(frame)}; allowed: the name of a frame")
        elif inertia is not None and "at" in table:
            parts.append(Attached(frame, inertia))
    return tuple(parts) if len(section.problems) == before else None
