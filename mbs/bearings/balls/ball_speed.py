"""Speed of the balls around the axis by their contact angles, loads that it gives them, and their work.

Rings turn at w_i and w_o, g = Dw/d_m. A ball rolls at both raceways without slip in the middle of the contacts, and
does not drill at the outer one (outer race control, Jones 1959): it turns about an axis in the plane of a_i and a_o,
whose angle b from that of the bearing has tan b = sin a_o/(cos a_o + g), and goes around at

    w_c = (w_i (1 - g cos a_i) + w_o (c + g cos a_i))/(1 + c),        c = cos(a_i - a_o).

Forces have it from `ehdmaps/kernel/c/ball/ball_balance.c`; here it is for arrays that may be complex, by which linear
analyses differentiate it, and `tests.cases.balls` has it by vectors in space. Each ball has a speed of its own, as
pockets let it: slow motion of the ring changes w_c, and with it the loads. A cage that holds the balls gives them its
speed: of motion too fast for the ball to follow.

Contacts at rest store U, the sum of the integrals of their loads over the approaches. With the balance of each ball

    dU/dt = Q_i e_i . dd/dt + (F_c (0, 1) + T) . dv/dt,

T the traction: the first part is the work of the ring and of the turning cage, the second one that of speed.

References
----------
A. B. Jones, Journal of Basic Engineering 82 (1960) 309. T. A. Harris, M. N. Kotzalas, Advanced Concepts of Bearing
Technology, CRC, 2007, chapter 3.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import function


class Drive(NamedTuple):
    """Speeds that turn the balls of a bearing, and what they weigh.

    Attributes
    ----------
    inner, outer : float
        Speeds of the rings [rad/s].
    cage : float
        Speed at which a cage holds the balls [rad/s]; NaN for balls that roll.
    ratio : float
        Dw/d_m.
    centrifugal, gyroscopic : float
        F_c/w_c^2 = m d_m/2 [kg m], and 2 J d_m/Dw^2 [kg m] with J = m Dw^2/10.
    """

    inner: float
    outer: float
    cage: float
    ratio: float
    centrifugal: float
    gyroscopic: float


def orbit(drive: Drive, ix: Any, ir: Any, ox: Any, orr: Any) -> tuple[Any, Any, Any]:
    """Speed of a ball around the axis [rad/s], and its derivatives by both contact angles.

    Parameters
    ----------
    drive : Drive
        Speeds of the rings and the cage.
    ix, ir, ox, orr : float or array
        Directions e_i and e_o of the contacts, axial and radial: sines and cosines of the contact angles.
    """
    if drive.cage == drive.cage:
        return drive.cage, 0.0, 0.0
    c, s = ix * ox + ir * orr, ix * orr - ir * ox
    driven = c.real > 0.0  # else no inner raceway is there that could
    c, s = c * driven, s * driven
    one = 1.0 / (1.0 + c)
    slow = drive.outer - drive.inner
    turn = slow * (c + drive.ratio * ir) * one
    speed = drive.inner + turn
    by_c = s * (drive.outer - speed) * one
    return speed, -by_c - slow * drive.ratio * ix * one, by_c


def ball_loads(drive: Drive, speed: Any) -> tuple[Any, Any, Any, Any]:
    """Centrifugal load F_c of a ball and t of its traction t sin(a_o) [N], and their derivatives by the speed [N s].

    F_c = m (d_m/2) w_c^2. The ball turns at w_R = (w_c - w_o) (1 + g cos a_o)/(g cos(a_o - b)) against the cage, and
    its spin is turned by w_c: the gyroscopic moment M_g = J w_R w_c sin b is J w_c (w_c - w_o) (d_m/Dw) sin a_o, and
    2 M_g/Dw at the outer raceway holds it. The traction of rings that turn against each other, with balls that go
    around slowly, would drive an idle ball out of its groove: t is at least -F_c/2, by which it stays.

    Parameters
    ----------
    drive : Drive
        Speeds and masses.
    speed : float or array
        Speed of the ball around the axis [rad/s].
    """
    load = drive.centrifugal * speed * speed
    by_load = 2.0 * drive.centrifugal * speed
    traction, by_traction = (
        drive.gyroscopic * speed * (speed - drive.outer),
        drive.gyroscopic * (2.0 * speed - drive.outer),
    )
    least = traction.real < -0.5 * load.real
    traction = traction - (traction + 0.5 * load) * least
    by_traction = by_traction - (by_traction + 0.5 * by_load) * least
    return load, traction, by_load, by_traction


def mean_speed(balls: FloatArray, idle: float) -> float:
    """Speed of the cage: that of the balls, by their loads at the inner raceway [rad/s].

    Parameters
    ----------
    balls : array (Z, COLUMNS)
        Rows of all balls.
    idle : float
        That of a bearing without load [rad/s].
    """
    load = float(balls[:, 10].sum())
    return float(balls[:, 10] @ balls[:, 22]) / load if load > 0.0 else idle


@functools.cache
def _work() -> Callable[..., float]:
    """Work of the loads by speed, in C."""
    place, number = ctypes.c_void_p, ctypes.c_double
    return function("ehd_ball_speed_work", ctypes.c_int64, place, number, place, result=number)


def speed_work(balls: FloatArray, arm: float, last: FloatArray) -> float:
    """Work of the centrifugal loads and tractions on the balls since the last call [J], by the trapezoidal rule.

    Parameters
    ----------
    balls : array (Z, COLUMNS)
        Rows of all balls.
    arm : float
        Distance of the outer groove's centre and the centre of a ball that touches it [m].
    last : array (Z, 4)
        Centres [m] and forces [N] of the last call, axial and radial; written.
    """
    return _work()(balls.shape[0], balls.ctypes.data, arm, last.ctypes.data)


def speed_slopes(along: Any, length: Any, drive: Drive) -> tuple[Any, Any]:
    """Derivatives of P, centrifugal load and traction together, by d and by v, (..., 2, 2) each [N/m].

    Parameters
    ----------
    along : array (..., 2, 2)
        Directions e_i and e_o, axial and radial; may be complex.
    length : array (..., 2)
        Distances of the ball's centre from those of the inner and the outer groove [m].
    drive : Drive
        Speeds and masses.
    """
    (ix, ir), (ox, orr) = (np.moveaxis(along[..., side, :], -1, 0) for side in (0, 1))
    speed, by_i, by_o = (part + 0.0 * ix for part in orbit(drive, ix, ir, ox, orr))
    _, traction, by_load, by_traction = ball_loads(drive, speed)
    faster = np.stack([-by_traction * ox * orr, by_load + by_traction * ox * ox], axis=-1)
    turned = traction[..., None] * np.stack([ox * ox - orr * orr, 2.0 * ox * orr], axis=-1)
    at_inner = np.stack([ir, -ix], axis=-1) / length[..., 0, None]
    at_outer = np.stack([orr, -ox], axis=-1) / length[..., 1, None]
    by_d = (by_i[..., None] * faster)[..., :, None] * at_inner[..., None, :]
    return by_d, (by_o[..., None] * faster + turned)[..., :, None] * at_outer[..., None, :] - by_d


def dry_energy(balls: FloatArray) -> float:
    """Energy of dry contacts [J], 2/5 F times the approach of each.

    Parameters
    ----------
    balls : array (Z, COLUMNS)
        Rows of all balls.
    """
    return 0.4 * float((balls[:, 10:12] * balls[:, 14:16].clip(min=0.0)).sum())
