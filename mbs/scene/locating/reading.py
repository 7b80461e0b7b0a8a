"""Ball and tapered roller bearings of a scene: [[bearings]] with the designation of one is read."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from ehdmaps.errors import InputError
from ehdmaps.jobs.balls import read_balls, says_balls
from ehdmaps.jobs.table import Table
from ehdmaps.physics.designations.reader import BALLS, TAPERED, plain_name
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.rollers.tapered_catalogue import mirrored, tapered_estimate
from mbs.scene.fields import MICROMETRE
from mbs.scene.shafts.standing import read_located
from mbs.scene.specs import BallSpec, LocatingSpec, TaperedSpec

WIDEST = 1e-2
"""Largest clearance, either way [m]."""


def reader_of(section: Table) -> Callable[[Table, str], LocatingSpec | None] | None:
    """Find what reads the table of a bearing that carries axial load; None for others.

    Parameters
    ----------
    section : Table
        A table [[bearings]].
    """
    given = section.get("bearing")
    if not isinstance(given, str):
        return _ball if "bearing" not in section and says_balls(section.get("geometry")) else None
    if plain_name(given, BALLS):
        return _ball
    return _tapered if plain_name(given, (TAPERED,)) else None


def _ball(section: Table, name: str) -> BallSpec | None:
    """Read a ball bearing; None where a problem was noted."""
    keys = "geometry" in section and "bearing" not in section
    own = section.table("geometry", f"{section.where} geometry") if keys else None
    known = read_balls(own) if own is not None else None
    inner, outer, geometry, turned, angle, offset = read_located(
        section, name, _known(known) if keys else ball_estimate
    )
    clearance = None
    if not keys:
        clearance = section.quantity("diametral_clearance", "m", -WIDEST, WIDEST, MICROMETRE)
    if geometry is not None:
        if turned and (geometry.contact_angle == 0.0 or geometry.axial_play or geometry.spherical):
            section.note("mirrored", f"got true for {geometry.name}, which is alike both ways; delete it")
        way = -1.0 if turned else 1.0
        placed = dataclasses.replace(geometry, contact_angle=way * geometry.contact_angle)
        geometry = section.made(
            lambda: _mounted(section, placed if clearance is None else placed.with_clearance(clearance)),
            "diametral_clearance",
        )
    if inner is None or outer is None or geometry is None:
        return None
    return BallSpec(name, inner, outer, geometry, angle, offset)


def _mounted(section: Table, geometry: BallGeometry) -> BallGeometry:
    """The bearing with its `fit`, and `thermal` of stated temperatures; without these at 20 degC."""
    if "fit" not in section and "thermal" not in section:
        return geometry
    from mbs.bearings.balls.ball_mounting import mounted  # with what few scenes of balls state
    from mbs.bearings.thermal import REFERENCE_TEMPERATURE, GivenTemperatures, Mounting
    from mbs.scene.locating.mounting import read_mounting, read_thermal

    mounting, thermal = read_mounting(section), read_thermal(section)
    rings = REFERENCE_TEMPERATURE, REFERENCE_TEMPERATURE
    if isinstance(thermal, GivenTemperatures):
        rings = (thermal.inner or rings[0], thermal.outer or rings[1])
    elif thermal is not None:
        section.note("thermal", "got paths of heat; allowed for balls: inner_ring and outer_ring")
    made = section.made(lambda: mounted(geometry, mounting or Mounting(), *rings)[0], "fit", "fit of the ")
    return geometry if made is None else made


def _known(geometry: BallGeometry | None) -> Callable[[str], BallGeometry]:
    """Reader of a bearing whose keys were read before; it has no problems of its own."""

    def read(_: str) -> BallGeometry:
        if geometry is None:
            raise InputError(())
        return geometry

    return read


def _tapered(section: Table, name: str) -> TaperedSpec | None:
    """Read a tapered roller bearing; None where a problem was noted."""
    inner, outer, geometry, turned, angle, offset = read_located(section, name, tapered_estimate)
    if inner is None or outer is None or geometry is None:
        return None
    return TaperedSpec(name, inner, outer, mirrored(geometry) if turned else geometry, angle, offset)
