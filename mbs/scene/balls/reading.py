"""Ball bearings of a scene: [[bearings]] with the designation of one is read."""

from __future__ import annotations

import dataclasses

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from ehdmaps.physics.point.ball_catalogue import ball_estimate, plain_ball_designation
from mbs.scene.fields import MICROMETRE
from mbs.scene.shafts.standing import read_located
from mbs.scene.specs import BallSpec

WIDEST = 1e-2
"""Largest clearance, either way [m]."""


def is_ball(section: Table) -> bool:
    """Tell whether the table of a bearing names a ball bearing.

    Parameters
    ----------
    section : Table
        A table [[bearings]] with the key `bearing`.
    """
    given = section.get("bearing")
    return isinstance(given, str) and bool(plain_ball_designation(given))


def read_ball(section: Table, name: str) -> BallSpec | None:
    """Read a ball bearing; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the bearing.
    """
    inner, outer, geometry, mirrored, angle, offset = read_located(section, name, ball_estimate)
    clearance = section.quantity("diametral_clearance", "m", -WIDEST, WIDEST, MICROMETRE)
    if geometry is not None:
        if mirrored and geometry.contact_angle == 0.0:
            section.note("mirrored", f"got true for {geometry.name}, which is alike both ways; delete it")
        way = -1.0 if mirrored else 1.0
        try:
            geometry = dataclasses.replace(geometry, contact_angle=way * geometry.contact_angle)
            geometry = geometry if clearance is None else geometry.with_clearance(clearance)
        except InputError as error:
            geometry = None
            for problem in error.problems:
                section.note("diametral_clearance", problem)
    if inner is None or outer is None or geometry is None:
        return None
    return BallSpec(name, inner, outer, geometry, angle, offset)
