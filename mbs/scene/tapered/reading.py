"""Tapered roller bearings of a scene: [[bearings]] with the designation of one is read."""

from __future__ import annotations

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from ehdmaps.physics.rollers.tapered_catalogue import mirrored, plain_tapered_designation, tapered_estimate
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.units import short
from mbs.scene.fields import DEGREE, MICROMETRE
from mbs.scene.shafts.standing import read_rings
from mbs.scene.specs import TaperedSpec

FARTHEST = 1e-3
"""Largest axial offset, either way [m]."""


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
    inner, outer = read_rings(section, name)
    geometry: TaperedGeometry | None = None
    try:
        geometry = tapered_estimate(str(section.get("bearing")))
    except InputError as error:
        for problem in error.problems:
            section.note("bearing", problem.removeprefix("tapered bearing designation: "))
    turned = section.get("mirrored")
    if "mirrored" in section and not isinstance(turned, bool):
        section.note("mirrored", f"got {short(turned)}; allowed: true, false")
    angle = section.quantity("start_angle", "rad", -7.0, 7.0, DEGREE) or 0.0
    offset = section.quantity("axial_offset", "m", -FARTHEST, FARTHEST, MICROMETRE) or 0.0
    if inner is None or outer is None or geometry is None:
        return None
    return TaperedSpec(name, inner, outer, mirrored(geometry) if turned is True else geometry, angle, offset)
