"""Tapered roller bearings of a scene: [[bearings]] with the designation of one is read."""

from __future__ import annotations

from ehdmaps.jobs.table import Table
from ehdmaps.physics.rollers.tapered_catalogue import mirrored, plain_tapered_designation, tapered_estimate
from mbs.scene.shafts.standing import read_located
from mbs.scene.specs import TaperedSpec


def is_tapered(section: Table) -> bool:
    """Tell whether the table of a bearing names a tapered roller bearing.

    Parameters
    ----------
    section : Table
        A table [[bearings]] with the key `bearing`.
    """
    given = section.get("bearing")
    return isinstance(given, str) and bool(plain_tapered_designation(given))


def read_tapered(section: Table, name: str) -> TaperedSpec | None:
    """Read a tapered roller bearing; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the bearing.
    """
    inner, outer, geometry, turned, angle, offset = read_located(section, name, tapered_estimate)
    if inner is None or outer is None or geometry is None:
        return None
    return TaperedSpec(name, inner, outer, mirrored(geometry) if turned else geometry, angle, offset)
