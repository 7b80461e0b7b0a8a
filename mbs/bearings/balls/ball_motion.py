"""Motion of the surfaces of a ball and its raceways in the contacts: entrainment, slip and spin.

Seen from the cage at w_c, the ball turns at (w_o - w_c) (1 + cos a_o/g, -sin a_o/g), axial and radial, g = Dw/d_m: it
rolls on the outer raceway and does not drill there, whatever the inner raceway does; by other hypotheses it rolls about
another axis. A ball that goes around at its own speed rolls on the inner raceway, too, where it drills; one that a cage
holds at another speed slips there. Rolling at both raceways, the ball's surface is not as fast at one as at the other
where their contact angles differ.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.balls.ball_bearing import BallForce, BallLoads
from mbs.bearings.balls.ball_speed import rolling_axis


class Motion(NamedTuple):
    """Speeds in the contacts of all balls, (2, Z) each: at the inner and at the outer raceway.

    Attributes
    ----------
    entrainment : array (2, Z)
        Sizes of the mean of both surface speeds [m/s].
    slip : array (2, Z)
        Surface speed of the ring less that of the ball in the middle of the contact [m/s].
    spin : array (2, Z)
        Angular velocity of the ring less that of the ball, about the contact's normal from the inner to the outer
        raceway [rad/s].
    """

    entrainment: FloatArray
    slip: FloatArray
    spin: FloatArray

    def mean(self, balls: BallLoads) -> FloatArray:
        """Entrainment speeds of both raceways, by the loads of their balls [m/s], (2,); of all alike without load.

        Parameters
        ----------
        balls : BallLoads
            The balls that move.
        """
        load = np.where(balls.load.sum(axis=1, keepdims=True) > 0.0, balls.load, 1.0)
        return np.asarray(np.sum(load * self.entrainment, axis=1) / np.sum(load, axis=1))


def ball_motion(force: BallForce, balls: BallLoads, inner_speed: float, outer_speed: float) -> Motion:
    """Entrainment, slip and spin of all balls.

    Parameters
    ----------
    force : BallForce
        The bearing.
    balls : BallLoads
        Loads, contact angles and speeds of its balls.
    inner_speed, outer_speed : float
        Speeds of the rings [rad/s].
    """
    half, ratio = 0.5 * force.geometry.ball_diameter, force.drive.ratio
    sin, cos = np.sin(balls.contact_angle), np.cos(balls.contact_angle)
    rings = np.array([[inner_speed], [outer_speed]]) - balls.speed
    rolled, (across, along) = rolling_axis(force.drive, sin[0], cos[0], sin[1], cos[1])
    turn = rings[1] * rolled / ratio
    axial, radial = turn * along, -turn * across
    # contacts stand at -e_i and +e_o from the middle of the ball
    way = np.array([[-1.0], [1.0]])
    of_rings = rings * half * (1.0 / ratio + way * cos)
    of_balls = half * way * (axial * cos - radial * sin)
    return Motion(0.5 * np.abs(of_rings + of_balls), of_rings - of_balls, rings * sin - axial * sin - radial * cos)
