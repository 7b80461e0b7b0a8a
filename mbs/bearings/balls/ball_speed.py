"""Speed of the balls around the axis by their contact angles, loads that it gives them, and their work.

Rings turn at w_i and w_o, g = Dw/d_m. A ball rolls at both raceways without slip in the middle of the contacts, and
does not drill at the outer one (outer race control, Jones 1959): it turns about an axis in the plane of a_i and a_o,
whose angle b from that of the bearing has tan b = sin a_o/(cos a_o + g), and goes around at

    w_c = (w_i (1 - g cos a_i) + w_o (c + g cos a_i))/(1 + c),        c = cos(a_i - a_o).

Which axis a ball turns about is a hypothesis, `HYPOTHESES`. For any b, with p = 1 - g cos a_i and q = 1 + g cos a_o,

    w_c = (w_i p cos(a_o - b) + w_o q cos(a_i - b))/(q cos(a_i - b) + p cos(a_o - b)),    M_g = J w_R w_c sin b:

inner race control has tan b = sin a_i/(cos a_i - g), without drilling at the inner raceway; the bisector b =
(a_i + a_o)/2. The raceway that controls the ball holds M_g, both of them by the bisector, as far as they are loaded,
see `inner_share`. The last hypothesis is the bisector without M_g.

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
from ehdmaps.physics.point.ball_geometry import BISECTOR, HYPOTHESES, INNER, NO_MOMENT, OUTER


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
    axis : float
        Place of the hypothesis in `HYPOTHESES`.
    """

    inner: float
    outer: float
    cage: float
    ratio: float
    centrifugal: float
    gyroscopic: float
    axis: float = 0.0


class Turn(NamedTuple):
    """A ball that turns, and derivatives by both contact angles.

    Attributes
    ----------
    speed, by_i, by_o : float or array
        Speed around the axis [rad/s].
    k, k_i, k_o : float or array
        k of its traction t k at the outer raceway.
    """

    speed: Any
    by_i: Any
    by_o: Any
    k: Any
    k_i: Any
    k_o: Any


def turned(drive: Drive, ix: Any, ir: Any, ox: Any, orr: Any) -> Turn:
    """Speed of a ball around the axis by its contact angles, and what its traction goes with.

    Parameters
    ----------
    drive : Drive
        Speeds of the rings and the cage.
    ix, ir, ox, orr : float or array
        Directions e_i and e_o of the contacts, axial and radial: sines and cosines of the contact angles.
    """
    g, p, q, (nx, nr), (x_i, r_i), (x_o, r_o) = drive.ratio, *_rolled(drive, ix, ir, ox, orr)
    p_i, q_o = g * ix, -g * ox
    v, v_i, v_o = ix * nx + ir * nr, ir * nx - ix * nr + ix * x_i + ir * r_i, ix * x_o + ir * r_o
    y, y_i, y_o = ox * nx + orr * nr, ox * x_i + orr * r_i, orr * nx - ox * nr + ox * x_o + orr * r_o
    holds = HYPOTHESES.index(NO_MOMENT) != drive.axis
    k = holds * q * nx / y
    k_i, k_o = holds * q * x_i / y - k * y_i / y, holds * (q_o * nx + q * x_o) / y - k * y_o / y
    driven = (ix * ox + ir * orr).real > 0.0  # else no inner raceway is there that could
    traction = (np.where(driven, one, other) for one, other in ((k, ox), (k_i, 0.0 * ox), (k_o, orr)))
    if drive.cage == drive.cage:
        return Turn(drive.cage, 0.0, 0.0, *traction)
    one, slow = 1.0 / (q * v + p * y), drive.outer - drive.inner
    part = q * v * one
    by_i = np.where(driven, one * (q * v_i - part * (q * v_i + p_i * y + p * y_i)), -p_i)
    by_o = driven * one * (q_o * v + q * v_o - part * (q_o * v + q * v_o + p * y_o))
    return Turn(drive.inner + slow * np.where(driven, part, 1.0 - p), slow * by_i, slow * by_o, *traction)


def rolling_axis(drive: Drive, ix: Any, ir: Any, ox: Any, orr: Any) -> tuple[Any, tuple[Any, Any]]:
    """Axis n of balls, radial and axial, after q/y: seen from the cage they turn at (w_c - w_o) q/(g y) n.

    Parameters
    ----------
    drive : Drive
        Hypothesis, and size of the balls.
    ix, ir, ox, orr : float or array
        Directions e_i and e_o of the contacts, axial and radial.
    """
    _, q, (nx, nr), *_ = _rolled(drive, ix, ir, ox, orr)
    return q / (ox * nx + orr * nr), (nx, nr)


def _rolled(drive: Drive, ix: Any, ir: Any, ox: Any, orr: Any) -> tuple[Any, ...]:
    """Numbers 1 - g cos a_i, 1 + g cos a_o, and the axis n of a ball with its derivatives by both angles."""
    g, name = drive.ratio, HYPOTHESES[int(drive.axis)]
    p, q, still = 1.0 - g * ir, 1.0 + g * orr, (0.0 * ix, 0.0 * ix)
    if name == OUTER:
        return p, q, (ox, orr + g), still, (orr, -ox)
    if name == INNER:
        return p, q, (ix, ir - g), (ir, -ix), still
    return p, q, (ix + ox, ir + orr), (ir, -ix), (orr, -ox)


def ball_loads(drive: Drive, speed: Any) -> tuple[Any, Any, Any, Any]:
    """Centrifugal load F_c of a ball and t of its traction t k [N], and their derivatives by the speed [N s].

    F_c = m (d_m/2) w_c^2. The ball turns at w_R = (w_c - w_o) (1 + g cos a_o)/(g cos(a_o - b)) against the cage, and
    its spin is turned by w_c: the gyroscopic moment M_g = J w_R w_c sin b is J w_c (w_c - w_o) (d_m/Dw) k, with
    k = sin a_o of outer race control, and 2 M_g/Dw at the outer raceway holds it. The traction of rings that turn
    against each other, with balls that go around slowly, would drive an idle ball out of its groove: t is at least
    -F_c/2, by which it stays.

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
def _works() -> Callable[..., None]:
    """Works of a step, in C."""
    return function("ehd_ball_works", ctypes.c_int64, *5 * (ctypes.c_void_p,), result=None)


def ball_works(
    balls: FloatArray, shape: ctypes.Structure, last: FloatArray, added: FloatArray | None = None
) -> tuple[float, float]:
    """Works since the last call [J], see `LocatingForce.works`, by the trapezoidal rule.

    Parameters
    ----------
    balls : array (Z, COLUMNS)
        Rows of all balls.
    shape : Structure
        Lengths of the bearing, in C.
    last : array (Z, LAST)
        Centres from both grooves [m] and forces [N] of the last call, axial and radial; approaches [m] and what memory
        adds to the loads [N]; written.
    added : array (Z, 2, 2), optional
        What deviations add to the contacts, see `mbs.bearings.deviating.tables`.
    """
    more, found = None if added is None else added.ctypes.data, np.empty(2)
    places = balls.ctypes.data, ctypes.addressof(shape), more, last.ctypes.data, found.ctypes.data
    _works()(balls.shape[0], *places)
    return float(found[0]), float(found[1])


def inner_share(drive: Drive, loads: Any) -> tuple[Any, Any]:
    """Part of the traction that the inner raceway takes, and its derivatives by both loads [1/N], (..., 2).

    All of it by inner race control and half of it by the bisector where both loads are alike; a ball that is thrown off
    the inner raceway is held by the outer one.

    Parameters
    ----------
    drive : Drive
        The hypothesis.
    loads : array (..., 2)
        Loads of the inner and the outer contact [N].
    """
    most = {INNER: 2.0, BISECTOR: 1.0}.get(HYPOTHESES[int(drive.axis)], 0.0)
    one = 1.0 / (loads[..., 0] + loads[..., 1])
    slopes = most * one[..., None] ** 2 * loads[..., ::-1] * np.array([1.0, -1.0])
    return most * loads[..., 0] * one, slopes


def speed_slopes(along: Any, length: Any, drive: Drive, loads: Any, stiffness: FloatArray) -> tuple[Any, Any, Any, Any]:
    """Derivatives of P by d and by v, and those of the inner raceway's part of it, (..., 2, 2) each [N/m].

    P is the centrifugal load and both tractions together.

    Parameters
    ----------
    along : array (..., 2, 2)
        Directions e_i and e_o, axial and radial; may be complex.
    length : array (..., 2)
        Distances of the ball's centre from those of the inner and the outer groove [m].
    drive : Drive
        Speeds and masses.
    loads, stiffness : array (..., 2)
        Loads [N] and stiffness [N/m] of both contacts.
    """
    (ix, ir), (ox, orr) = (np.moveaxis(along[..., side, :], -1, 0) for side in (0, 1))
    speed, by_i, by_o, k, k_i, k_o = (part + 0.0 * ix for part in turned(drive, ix, ir, ox, orr))
    _, t, by_load, by_t = ball_loads(drive, speed)
    share, by_loads = inner_share(drive, loads)
    traction, traction_i, traction_o = t * k, by_t * k * by_i + t * k_i, by_t * k * by_o + t * k_o
    e_i, e_o, none = along[..., 0, :], along[..., 1, :], 0.0 * ix
    u_i, u_o = np.stack([ir, -ix], axis=-1), np.stack([-orr, ox], axis=-1)
    part, rest = share[..., None], 1.0 - share[..., None]
    inner_i = part * (traction_i[..., None] * u_i - traction[..., None] * e_i)
    inner_o = part * traction_o[..., None] * u_i
    both_i = inner_i + rest * traction_i[..., None] * u_o + np.stack([none, by_load * by_i], axis=-1)
    both_o = inner_o + rest * (traction_o[..., None] * u_o + traction[..., None] * e_o)
    both_o = both_o + np.stack([none, by_load * by_o], axis=-1)
    at_inner, at_outer = u_i / length[..., 0, None], -u_o / length[..., 1, None]
    by_d = (by_loads * stiffness)[..., 0, None] * e_i
    by_v = (by_loads * stiffness)[..., 1, None] * e_o - by_d
    found = []
    for one_i, one_o, way in ((both_i, both_o, u_i - u_o), (inner_i, inner_o, u_i)):
        along_d = one_i[..., :, None] * at_inner[..., None, :]
        more = (traction[..., None] * way)[..., :, None]
        found += [
            along_d + more * by_d[..., None, :],
            one_o[..., :, None] * at_outer[..., None, :] - along_d + more * by_v[..., None, :],
        ]
    return found[0], found[1], found[2], found[3]
