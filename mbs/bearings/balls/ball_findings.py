"""Findings of ball bearings alone: shoulders, too little axial load, gyroscopic sliding, centrifugal load.

A groove of radius f Dw ends at its shoulder, h_s above its bottom: at acos(1 - h_s/(f Dw)) along its arc. The ellipse
of a ball at the contact angle alpha, with the semi-axis b across the direction of rolling, reaches to
alpha + asin(2 b/Dw). Catalogues do not give h_s, so that it is assumed.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.hertz import POINT_LIMIT
from ehdmaps.physics.point.ball_geometry import LARGEST_ANGLE, BallGeometry
from mbs.bearings.balls.ball_bearing import BallForce, BallLoads
from mbs.model.findings import CARRIES, OPEN, SIDES, Cause, Finding, Gauge

SHOULDERS = (0.2, 0.35)
"""Height of the loaded shoulder over the ball diameter, of deep groove and of angular contact bearings: usual, assumed.
Axial loads that reach it go with the height: of a 6208 from 11 kN (0.17) to 24 kN (0.25)."""

_SLIP = 0.05
"""Traction over load that a film is trusted to hold a ball by against its gyroscopic moment."""


def ball_gauge(force: BallForce, balls: BallLoads) -> Gauge:
    """Measure what the balls feel, and what is beyond their limits.

    Parameters
    ----------
    force : BallForce
        The bearing.
    balls : BallLoads
        Loads and contact angles.
    """
    own = [
        _shoulder(force, balls),
        _missing_shoulder(force, balls),
        _slack(force, balls),
        _sliding(balls),
        _thrown(balls),
    ]
    pressure = np.array([float(np.max(side)) for side in ball_pressures(force, balls)])
    load = balls.load
    if force.geometry.spherical or force.geometry.thrust:  # idle balls slide out until both grooves hold them
        load = np.where(load[0] <= balls.centrifugal, 0.0, load)
    return Gauge("ball", load, pressure, POINT_LIMIT, tuple(one for one in own if one is not None))


def ball_pressures(force: BallForce, balls: BallLoads) -> FloatArray:
    """Hertz pressures of the inner and outer contacts, shape (2, Z) [Pa].

    Parameters
    ----------
    force : BallForce
        The bearing.
    balls : BallLoads
        Loads of the balls.
    """
    contacts = force.geometry.contacts(force.material)
    return np.array([contact.max_pressure(balls.load[side]) for side, contact in enumerate(contacts)])


def groove_half_width(geometry: BallGeometry, side: int) -> float:
    """Half of the width of a groove from shoulder to shoulder, both as high as the loaded one is taken [m].

    Parameters
    ----------
    geometry : BallGeometry
        The bearing.
    side : int
        0: inner groove, 1: outer groove.
    """
    conformity = (geometry.inner_conformity, geometry.outer_conformity)[side]
    return conformity * geometry.ball_diameter * math.sin(_end(geometry, side))


def _height(geometry: BallGeometry) -> float:
    """Height of the loaded shoulder over the ball diameter; washers have two alike."""
    return SHOULDERS[geometry.contact_angle != 0.0 and not geometry.thrust]


def _end(geometry: BallGeometry, side: int) -> float:
    """Angle along its arc at which a groove ends [rad]."""
    if side == 1 and geometry.spherical:  # which ends nowhere near
        return math.asin(0.5 / geometry.outer_conformity)
    return math.acos(1.0 - _height(geometry) / (geometry.inner_conformity, geometry.outer_conformity)[side])


def _shoulder(force: BallForce, balls: BallLoads) -> Finding | None:
    """Ellipses that reach over the shoulder of their groove."""
    geometry = force.geometry
    height, half = _height(geometry), 0.5 * geometry.ball_diameter
    bottom = LARGEST_ANGLE if geometry.thrust else 0.0
    worst, place = 1.0, ""
    for side, contact in enumerate(geometry.contacts(force.material)):
        end = 0.5 * math.pi if side == 1 and geometry.spherical else _end(geometry, side)
        carries = balls.load[side] > CARRIES * balls.load[side].max()
        _, across = contact.semi_axes(balls.load[side])
        reach = np.abs(np.abs(balls.contact_angle[side]) - bottom) + np.arcsin(np.minimum(across / half, 1.0))
        reach = float(np.max(reach, where=carries, initial=0.0))
        if reach / end > worst:
            worst = reach / end
            place = (
                f"{math.degrees(reach):.3g} deg of the {SIDES[side]} groove, which ends at {math.degrees(end):.3g} deg"
            )
    if not place:
        return None
    words = (
        f"the ellipse of a ball reaches to {place}, with a shoulder of {height:g} of the ball diameter (assumed): the "
        "shoulder cuts it off, pressures at its edge are higher than those of Hertz"
    )
    return Finding(Cause.SHOULDER, words, excess=worst)


def _missing_shoulder(force: BallForce, balls: BallLoads) -> Finding | None:
    """Balls of an angular contact bearing that press the other way."""
    nominal = force.geometry.contact_angle
    wrong = (balls.load[0] > 1e-3 * balls.load[0].max()) & (balls.contact_angle[0] * nominal < -1e-6)
    count = int(np.count_nonzero(wrong))
    if not count:
        return None
    words = (
        f"{count} balls press against the shoulder that angular contact bearings lack; give an axial load that holds "
        "the contact angle"
    )
    return Finding(Cause.SHOULDER, words, excess=1.0 + count)


def _slack(force: BallForce, balls: BallLoads) -> Finding | None:
    """An axial load that does not hold the contact angle of an angular contact bearing."""
    nominal, found = (abs(math.degrees(angle)) for angle in (force.geometry.contact_angle, balls.mean_angle(0)))
    if found >= 0.5 * nominal or not np.any(balls.load[0] > OPEN):
        return None
    words = (
        f"the axial load is too small to hold the contact angle: the rings slide to {found:.3g} deg of {nominal:.3g}; "
        "a mounted bearing gets an axial load from the other one"
    )
    return Finding(Cause.SLACK, words, excess=nominal / max(found, 1e-3))


def _sliding(balls: BallLoads) -> Finding | None:
    """A gyroscopic moment that asks for more traction than a film is trusted to have."""
    share = balls.gyroscopic_traction
    if share <= _SLIP:
        return None
    words = (
        f"the gyroscopic moment asks for a traction of {share:.2g} of the load at a raceway, more than films hold "
        f"({_SLIP:g}): balls may slide, and no rule of their axis is the truth here; more axial load prevents it"
    )
    return Finding(Cause.SLIDING, words, excess=share / _SLIP)


def _thrown(balls: BallLoads) -> Finding | None:
    """Balls that their centrifugal load lifts off the inner raceway."""
    count = int(np.count_nonzero((balls.load[0] <= 0.0) & (balls.load[1] > 0.0)))
    if not count or float(balls.centrifugal.max()) < 1e-2 * float(balls.load.max()):
        return None
    words = f"{count} of {balls.angle.size} balls run on the outer raceway alone, by their centrifugal load"
    return Finding(Cause.THROWN, words, excess=float(count))
