"""Ball bearings on their seats, with warm rings: clearance and preload in operation.

Fits and warmth change the raceways as those of cylindrical rollers, see `mbs.bearings.thermal`: the contact line of a
ball stands for the raceway, d_m -+ Dw cos(alpha). What they take of the radial distance is a tightening; of deep groove
and of single angular contact bearings it is part of the clearance. A ring that is warmer than the other one is longer,
too, so that rows at a distance move against each other: in O arrangement apart.
"""

from __future__ import annotations

import dataclasses
import math

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.solids import STEEL, Material
from mbs.bearings.thermal import Clearance, Mounting, operating_clearance


def raceways_of(geometry: BallGeometry) -> BearingGeometry:
    """Raceways and balls as those of cylindrical rollers that expand alike.

    Parameters
    ----------
    geometry : BallGeometry
        The bearing.
    """
    across = geometry.ball_diameter * math.cos(geometry.contact_angle)
    pitch, balls = geometry.pitch_diameter, geometry.balls
    return BearingGeometry(geometry.name, pitch - across, pitch + across, across, across, balls, 0.0)


def mounted(
    geometry: BallGeometry, mounting: Mounting, inner: float, outer: float, ring: Material = STEEL
) -> tuple[BallGeometry, Clearance]:
    """The bearing on its seats, with warm rings, and what that does to its radial clearance.

    Parameters
    ----------
    geometry : BallGeometry
        The bearing before it is mounted, at 20 degC.
    mounting : Mounting
        Fits, and expansion of rings and balls.
    inner, outer : float
        Temperatures of both rings [K].
    ring : Material
        Material of the rings, where the geometry has none.

    Raises
    ------
    InputError
        If seats and rings do not fit together.
    """
    if geometry.thrust:
        raise InputError(
            f"fit of the {geometry.kind} {geometry.name}: got a fit, or temperatures of its rings; allowed: none, as "
            "washers of thrust bearings have no radial clearance that they would change"
        )
    found = operating_clearance(raceways_of(geometry), mounting, inner, outer, geometry.ring_material or ring)
    taken = found.by_temperature + found.by_fits
    longer = mounting.expansion * (inner - outer)
    rows = tuple(row._replace(shift=row.shift + row.way * row.place * longer) for row in geometry.rows)
    if geometry.axial_play:
        made = dataclasses.replace(geometry, rows=rows, tightening=geometry.tightening - taken)
    else:
        made = dataclasses.replace(geometry, rows=rows, clearance=geometry.clearance + taken)
    return made, Clearance(geometry.clearance, found.by_temperature, found.by_fits)
