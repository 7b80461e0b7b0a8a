"""Films of a ball bearing that relax: what both contacts of each ball add to K and C of slow motion at a frequency.

A ball is at d and v as in `ehdmaps/kernel/c/ball/ball_balance.c`, without mass against small motions. Its contacts have
springs k, dampers c_r in series with springs c_r/theta_r along their directions, and the stiffness Q/l by which loads
turn. With the ends xi of the dampers, their places at rest by d, Xi, the matrix D of the c_r and A of the stiffness
that the xi feel where the ball is in balance, small motions of d see

    Z(s) = K + s C - s^2 Xi' D (A + s D)^-1 D Xi.

The eigenvalues of D^-1 A are one over the times of some springs in series with dampers, which is what
`mbs.model.relaxation` takes; K and C are those of the bearing, exactly. Speed, by centrifugal load and traction, makes
M unsymmetrical: here A comes from its symmetric part, and Xi is the mean of what goes in and what comes back, which
changes nothing at low frequency.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.balls.ball_data import BallShape
from mbs.bearings.balls.ball_speed import Drive, speed_slopes
from mbs.bearings.balls.laws import BallLaw
from mbs.bearings.balls.normal_law import contact
from mbs.bearings.balls.response import TIMES
from mbs.model.relaxation import Relaxation

_LEAST = 1e-9
"""Part of the damping of a bearing below which dampers stay without springs."""


def ball_relaxation(law: BallLaw, shape: BallShape, balls: FloatArray, drive: Drive, angles: FloatArray) -> Relaxation:
    """Relaxation of a bearing in the pose (6,) of its inner ring.

    There are as many springs at any speed and pose; some have no stiffness.

    Parameters
    ----------
    law : BallLaw
        Laws of the contacts; without responses, springs have no stiffness.
    shape : BallShape
        Lengths of the bearing.
    balls : array (Z, COLUMNS)
        Rows of all balls.
    drive : Drive
        Speeds and masses.
    angles : array (Z,)
        Angles of the balls from y towards z [rad].
    """
    rows, times = np.zeros((angles.size, 2 * TIMES.size, 2)), np.ones((angles.size, 2 * TIMES.size))
    if law.responses:
        loaded = np.flatnonzero(balls[:, 10] > 0.0)  # others do nothing
        springs = [response.springs(balls[loaded, 10 + side]) for side, response in enumerate(law.responses)]
        for i, j in enumerate(loaded.tolist()):
            dampers = [(one.shares[i], one.times[i]) for one in springs]
            _of_ball(law, shape, balls[j], drive, dampers, rows[j], times[j])
    axial, radial = rows[..., 0], rows[..., 1]
    c, s, arm = np.cos(angles)[:, None], np.sin(angles)[:, None], shape.arm * axial
    moved = np.stack([axial, radial * c, radial * s, np.zeros_like(arm), arm * s, -arm * c], axis=-1)
    damping = times * np.sum(rows**2, axis=-1)
    moved[damping <= _LEAST * damping.sum()] = 0.0
    return Relaxation(moved.reshape(-1, 6), times.reshape(-1))


def _of_ball(
    law: BallLaw,
    shape: BallShape,
    ball: FloatArray,
    drive: Drive,
    dampers: list[tuple[FloatArray, FloatArray]],
    rows: FloatArray,
    times: FloatArray,
) -> None:
    """Fill rows (r, 2) by d, and times of the springs in series with dampers that a ball is."""
    directions = ball[16:18], ball[18:20]
    lengths = shape.inner_arm + ball[14], shape.outer_arm + ball[15]
    at_rest, values, felt = [], [], []
    for side, of_side in enumerate((law.inner, law.outer)):
        e = directions[side]
        _, k, c = contact(of_side, float(ball[14 + side]))
        turns = ball[10 + side] / lengths[side]
        at_rest.append((k - turns) * np.outer(e, e) + turns * np.eye(2))
        values.append(dampers[side][0] * c)
        # the inner contact feels d - v, the outer one v
        felt.append(np.tile(e if side else -e, (TIMES.size, 1)))
    by_d, by_v = speed_slopes(np.array(directions), np.array(lengths), drive)
    whole = at_rest[0] + at_rest[1] - by_v
    balance = 0.5 * (whole + whole.T)
    along, damping, theta = np.concatenate(felt), np.concatenate(values), np.concatenate([one for _, one in dampers])
    # places of the dampers' ends at rest, by d: approaches of the contacts
    into, back = np.linalg.solve(whole, at_rest[0] + by_d), np.linalg.solve(whole.T, at_rest[0])
    ends = along @ (0.5 * (into + back))
    ends[: TIMES.size] += directions[0]
    on = np.flatnonzero(damping > 0.0)
    on = on[np.argsort(-theta[on], kind="stable")]
    c, felt_on = damping[on], along[on]  # type: ignore[assignment]
    # the ball, at any frequency, feels all springs
    pulled = (c / theta[on])[:, None] * felt_on
    own = np.diag(c / theta[on]) - pulled @ np.linalg.solve(balance + felt_on.T @ pulled, pulled.T)
    root = np.sqrt(c)
    rates, turns = np.linalg.eigh(own / np.multiply.outer(root, root))
    # v v' theta is the square of what a mode has of the dampers
    rows[on] = (turns.T @ (root[:, None] * ends[on])) * np.sqrt(rates)[:, None]
    times[on] = 1.0 / rates
