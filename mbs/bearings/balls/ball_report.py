"""Pressures and films of the contacts of balls at rest, and the cost of rolling.

Pressures are those of dry Hertz. Central and smallest films are those of the law in force. The rolling force of an
ellipse is that of strips along the motion, each a line contact under the load that Hertz gives it: side flow is left
out. Drilling, which often takes more than the films, is that of one traction all over the ellipse; so is no slip along
the motion within it, by the curved contact, nor that across by the gyroscopic moment, which is held without slip.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Protocol

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.point.ellipse import Ellipse
from mbs.bearings.balls.ball_bearing import BallForce, BallLoads
from mbs.bearings.balls.ball_motion import ball_motion
from mbs.bearings.contact_report import TRACTION, BearingContacts, RollingLoss, loss_of
from mbs.bearings.films import ContactState

STRIPS = 12
"""Places of Gauss' rule across an ellipse; 24 change the force by less than 1e-3."""


class PointFilmSource(Protocol):
    """Films of both contacts of a ball."""

    def films(self, side: int, load: FloatArray, entrainment_speed: float) -> tuple[FloatArray, FloatArray]:
        """Central and smallest film of the inner (0) or outer (1) contact at loads [N], > 0, each (k,) [m].

        Parameters
        ----------
        side : int
            0: inner contact, 1: outer contact.
        load : array (k,)
            Loads [N], > 0.
        entrainment_speed : float
            u [m/s], > 0.
        """
        ...

    def line_force(self, side: int, load: FloatArray, entrainment_speed: float) -> FloatArray:
        """Rolling force of lines with the radius of a contact along the motion, in the shape of the loads [N/m].

        Parameters
        ----------
        side : int
            0: inner contact, 1: outer contact.
        load : array
            Loads per length [N/m], >= 0.
        entrainment_speed : float
            u [m/s], > 0.
        """
        ...


def strips(ellipse: Ellipse, load: FloatArray, line_force: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Force of an ellipse by strips along the motion, each under the load per length that Hertz gives it, (k,) [N].

    Parameters
    ----------
    ellipse : Ellipse
        The contact.
    load : array (k,)
        Loads [N], > 0.
    line_force : callable
        Force per length of a line contact [N/m] over its load per length [N/m].
    """
    places, weights = np.polynomial.legendre.leggauss(STRIPS)
    half = np.asarray(ellipse.semi_axes(load)[1])[:, None]
    return np.asarray((half * line_force(0.75 * load[:, None] / half * (1.0 - places**2))) @ weights)


def drilling_power(ellipse: Ellipse, load: FloatArray, spin: FloatArray) -> FloatArray:
    """Power of contacts that drill at a traction of `TRACTION` everywhere, in the shape of the loads [W].

    The moment over a Hertz ellipse is 3/8 mu Q b E(m), with the longer semi-axis b and the elliptic integral E.

    Parameters
    ----------
    ellipse : Ellipse
        The contact, kappa >= 1.
    load, spin : array
        Loads [N], and angular velocities about the normal [rad/s], of either sign.
    """
    longer = np.asarray(ellipse.semi_axes(load)[1])
    moment = 0.375 * TRACTION * load * longer * float(ellipse.numbers.second_integral)
    return np.asarray(moment * np.abs(spin))


def ball_contacts(
    force: BallForce, balls: BallLoads, films: Any, speeds: tuple[float, float]
) -> tuple[BearingContacts, RollingLoss]:
    """Pressures and films of all balls, and the loss of rolling.

    Parameters
    ----------
    force : BallForce
        Geometry and laws.
    balls : BallLoads
        Loads at rest.
    films : callable or None
        Films over the speed, of which `points`, a `PointFilmSource`, knows those of contacts; None for dry contacts.
    speeds : (float, float)
        Speeds of the inner and the outer ring [rad/s].
    """
    u, points = abs(force.geometry.entrainment_speed(*speeds)), getattr(films, "points", None)
    sides = []
    for side, ellipse in enumerate(force.geometry.contacts(force.material)):
        load = balls.load[side][:, None]
        pressure, loaded = np.asarray(ellipse.max_pressure(load)), load > 0.0
        central, smallest, rolling = np.full((3, *load.shape), np.nan)
        if points is not None and u > 0.0:
            central[loaded], smallest[loaded] = points.films(side, load[loaded], u)
            rolling[~loaded] = 0.0
            rolling[loaded] = strips(ellipse, load[loaded], partial(points.line_force, side, entrainment_speed=u))
        sides.append(ContactState(pressure, pressure, central, smallest, rolling, np.zeros(load.shape)))
    power = np.stack([side.rolling_force[:, 0] for side in sides]) * u
    spins = zip(
        force.geometry.contacts(force.material), balls.load, ball_motion(force, balls, *speeds).spin, strict=True
    )
    sliding = float(sum(drilling_power(*each).sum() for each in spins))
    return BearingContacts(*sides), loss_of(power, balls.load[0], speeds[0] - speeds[1], sliding=sliding)
