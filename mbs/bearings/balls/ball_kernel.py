"""Compiled sums over the balls of a bearing: force, stiffness, damping, and the place of each ball.

All of a ball happens in the plane of the axis and the ball. There the centre of the outer groove is the origin, d the
centre of the inner groove, v that of the ball, each (axial, radial). With e_o = v/|v|, e_i = (d - v)/|d - v|, the arms
l = (f - 1/2) Dw and the approaches |v| - l_o, |d - v| - l_i, the ball is in balance where

    Q_i e_i - Q_o e_o + P = 0,    P = F_c (0, 1) + t sin(a_o) (-cos a_o, sin a_o),    a_o the angle of e_o,

with the centrifugal load F_c and the traction t sin(a_o) at the outer raceway that holds the gyroscopic moment. Both
come from the ball's own speed around the axis, which its contact angles give it, see `mbs.bearings.balls.ball_speed`:
P = P(d, v). The force on the inner ring is -Q_i e_i. With K_i, K_o the stiffness of the contacts (their rotation
included), L = K_i + dP/dd, M = K_i + K_o - dP/dv, S = M^-1 L and S' = K_i M^-1, slow motion has

    stiffness  K_i - K_i S = S' (M - L),        damping  C_i - C_i S - S' C_i + S' (C_i + C_o) S,

exact for a ball without mass of its own against its balance: M comes from the balance as it is solved, by Newton's
method. Without speed the balance is the minimum of a convex potential.

A ball begins where it was, moved by S as the groove's centre has moved since.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from mbs.bearings.balls.ball_speed import Drive, ball_loads, orbit
from mbs.bearings.balls.normal_law import NormalLaw, carried, holding, slowed

COLUMNS = 25
"""Numbers that are kept of a ball, see `place_ball`."""

START = 8
"""Numbers by which a ball begins, see `place_ball`."""

NUMBERS = 8
"""Numbers of a bearing at a time, see `ball_force`."""

NOT_FINITE, TOO_FAR, NO_BALANCE = -1, -2, -3
"""What `ball_force` finds instead of an answer."""

NEWTON_STEPS, LAST_STEPS = 12, 6
"""Steps of Newton's method until the angle is searched, and after that."""

_CUTS = 12
_BALANCE, _ROUGH_BALANCE = 1e-11, 1e-9
"""Force out of balance, over the sizes of its parts, at which Newton's method ends: its last step is gone by the
derivatives alone, so that forces are exact to the square of it, stiffness and damping to itself."""

_ROUND_OFF = 1e-15
_NOTHING = 1e-7
"""Force [N] by which an idle ball is in balance that hardly goes around, between rings that turn against each other."""

_NEAR = 0.3
"""Force out of balance, over the sizes of its parts, from which Newton's method begins at once."""


class BallShape(NamedTuple):
    """Numbers of a bearing that do not change.

    Attributes
    ----------
    axial, radial : float
        Places of the inner groove's centre against the outer one, of rings in their middle [m].
    arm : float
        Distance of the inner groove's centre from the axis [m].
    inner_arm, outer_arm : float
        Distances of a groove's centre and the centre of a ball that touches it, l_i and l_o [m].
    most_travel, most_tilt : float
        Largest accepted displacement [m] and tilt [rad] of the ring.
    """

    axial: float
    radial: float
    arm: float
    inner_arm: float
    outer_arm: float
    most_travel: float
    most_tilt: float


@njit(error_model="numpy", _nrt=False, forceinline=True)
def place_ball(
    d: tuple[float, float],
    drive: Drive,
    rest: float,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
    centre: FloatArray,
    out: FloatArray,
) -> bool:
    """Find the balance of a ball; tell whether it was found.

    Parameters
    ----------
    d : (float, float)
        Centre of the inner groove against the outer one, axial and radial [m].
    drive : Drive
        Speeds and masses.
    rest : float
        Approach at the outer raceway of a ball that bears its centrifugal load alone [m].
    shape, inner, outer : BallShape, NormalLaw, NormalLaw
        Lengths, and laws of the contacts.
    centre : array (START,)
        Centre of the ball at the last call, d there [m], and S (4); NaN for a start from nothing. Written.
    out : array (COLUMNS,)
        Written: force on the inner ring without its sign (2), stiffness (4), damping (4) of the pair, loads Q_i and
        Q_o [N]; room for the contact angles, see `write_angles`; approaches [m], directions e_i (2) and
        e_o (2), places of the contacts on their tables; speed around the axis [rad/s], F_c and t [N].
    """
    length = math.sqrt(d[0] * d[0] + d[1] * d[1])
    overlap = length - shape.inner_arm - shape.outer_arm
    dry = inner.table.shape[0] == 0 and outer.table.shape[0] == 0
    still = drive.inner == 0.0 and drive.outer == 0.0 and not abs(drive.cage) > 0.0
    if dry and still and overlap <= 0.0:
        one = 1.0 / length
        reach = shape.outer_arm + 0.5 * overlap
        _keep(reach * d[0] * one, reach * d[1] * one, d, centre)
        for i in range(COLUMNS):
            out[i] = 0.0
        out[14] = out[15] = 0.5 * overlap
        out[16] = out[18] = d[0] * one
        out[17] = out[19] = d[1] * one
        return True
    if dry and still:  # two dry contacts in line share the overlap
        reach = (shape.outer_arm + _share(inner, outer) * overlap) / length
        _keep(reach * d[0], reach * d[1], d, centre)
        _answer(_state(centre[0], centre[1], d, drive, shape, inner, outer), shape, inner, outer, centre, out)
        return True
    mx, mr = d[0] - centre[2], d[1] - centre[3]
    x, r = centre[0] + centre[4] * mx + centre[5] * mr, centre[1] + centre[6] * mx + centre[7] * mr
    found = False
    if x * x + r * r > 0.0:
        state = _state(x, r, d, drive, shape, inner, outer)
        # a ball between both raceways, without load, would not know where to go
        if state.qo > 0.0 and state.fx * state.fx + state.fr * state.fr < (_NEAR * state.size) ** 2:
            x, r, state, found = _newton(x, r, state, NEWTON_STEPS, d, drive, shape, inner, outer)
    if not found:
        x, r, state, found = _anew(centre, d, drive, rest, shape, inner, outer)
    _keep(x, r, d, centre)
    _answer(state, shape, inner, outer, centre, out)
    return found


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _keep(x: float, r: float, d: tuple[float, float], centre: FloatArray) -> None:
    """Keep where a ball is, and by which d."""
    centre[0], centre[1], centre[2], centre[3] = x, r, d[0], d[1]
    centre[4] = centre[5] = centre[6] = centre[7] = 0.0


@njit(error_model="numpy", _nrt=False)
def _share(inner: NormalLaw, outer: NormalLaw) -> float:
    """Part of an overlap that the outer contact takes, both dry and in line."""
    share: float = 1.0 / (1.0 + (outer.coefficient / inner.coefficient) ** (2.0 / 3.0))
    return share


@njit(error_model="numpy", _nrt=False)
def _anew(
    centre: FloatArray,
    d: tuple[float, float],
    drive: Drive,
    rest: float,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
) -> tuple[float, float, BallState, bool]:
    """Balance of a ball from the best of some starts: its place, and whether it was found.

    Where the ball was; in line between the grooves; on the outer raceway alone, in line and at its bottom.
    """
    length = math.sqrt(d[0] * d[0] + d[1] * d[1])
    overlap = length - shape.inner_arm - shape.outer_arm
    best, x, r = math.inf, 0.0, shape.outer_arm + rest
    state = _state(x, r, d, drive, shape, inner, outer)
    for start in range(4):
        if start == 0:
            px, pr = centre[0], centre[1]
        elif start < 3:
            reach = (shape.outer_arm + (_share(inner, outer) * overlap if start == 1 else rest)) / length
            px, pr = reach * d[0], reach * d[1]
        else:
            px, pr = 0.0, shape.outer_arm + rest
        if not px * px + pr * pr > 0.0:
            continue
        here = _state(px, pr, d, drive, shape, inner, outer)
        if not here.qo > 0.0:
            continue
        error = math.sqrt(here.fx * here.fx + here.fr * here.fr) / here.size
        # at the bottom: no inner contact, and in balance
        if error < best or (start == 3 and error < 1e-3):
            best, x, r, state = error, px, pr, here
        if best < _NEAR and start == 0:
            break
    x, r, state, found = _newton(x, r, state, NEWTON_STEPS, d, drive, shape, inner, outer)
    if not found:
        x, r = _searched(d, drive, shape, inner, outer)
        state = _state(x, r, d, drive, shape, inner, outer)
        x, r, state, found = _newton(x, r, state, LAST_STEPS, d, drive, shape, inner, outer)
    return x, r, state, found


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _newton(
    x: float,
    r: float,
    state: BallState,
    steps: int,
    d: tuple[float, float],
    drive: Drive,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
) -> tuple[float, float, BallState, bool]:
    """Newton's method from a place of the ball: where it ends, and whether that is the balance."""
    allowed = 0.0
    for _ in range(steps):
        norm = math.sqrt(state.fx * state.fx + state.fr * state.fr)
        trace = state.m00 + state.m11
        # what the rounding of lengths leaves of small loads
        allowed = _ROUND_OFF * trace * state.reach
        if norm <= _BALANCE * state.size + 0.1 * allowed:
            return x, r, state, True
        m00, m11 = state.m00, state.m11
        determinant = m00 * m11 - state.m01 * state.m10
        if not determinant > 1e-14 * trace * trace:
            more = 1e-6 * trace + 1e-300
            m00 += more
            m11 += more
            determinant = m00 * m11 - state.m01 * state.m10
        one = 1.0 / determinant
        sx, sr = (m11 * state.fx - state.m01 * state.fr) * one, (m00 * state.fr - state.m10 * state.fx) * one
        # the step is gone around the outer groove's centre, and not straight: its contact is stiff
        along, turn = (sx * state.ox + sr * state.orr) / state.reach, (sx * state.orr - sr * state.ox) / state.reach
        turn = min(max(turn, -0.5), 0.5)
        part = 1.0
        moved = False
        for _ in range(_CUTS):
            angle = part * turn
            if abs(angle) < 1e-3:
                sin = angle * (1.0 - angle * angle / 6.0)
                cos = 1.0 - 0.5 * angle * angle * (1.0 - angle * angle / 12.0)
            else:
                cos, sin = math.cos(angle), math.sin(angle)
            far = 1.0 + part * along
            nx, nr = far * (x * cos + r * sin), far * (r * cos - x * sin)
            ahead = _state(nx, nr, d, drive, shape, inner, outer)
            if math.sqrt(ahead.fx * ahead.fx + ahead.fr * ahead.fr) < (1.0 - 1e-4 * part) * norm:
                moved = True
                break
            part *= 0.5
        if not moved:
            break
        x, r, state = nx, nr, ahead
    norm = math.sqrt(state.fx * state.fx + state.fr * state.fr)
    return x, r, state, norm <= _ROUGH_BALANCE * state.size + allowed + _NOTHING


@njit(error_model="numpy", _nrt=False)
def _searched(
    d: tuple[float, float],
    drive: Drive,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
) -> tuple[float, float]:
    """Place of a ball by its angle a_o, which lies between zero and the direction of d: slow and safe.

    At each angle the balance along e_o gives the distance, and what is left across e_o has one zero.
    """
    low, high = 0.0, math.atan2(d[0], d[1])
    sign = 1.0 if high >= 0.0 else -1.0
    reach = _reach(low, shape.outer_arm, d, drive, shape, inner, outer)
    at_low = sign * _across(low, reach, d, drive, shape, inner, outer)
    if at_low <= 0.0:
        return 0.0, reach
    reach = _reach(high, reach, d, drive, shape, inner, outer)
    at_high = sign * _across(high, reach, d, drive, shape, inner, outer)
    if at_high >= 0.0:
        return reach * math.sin(high), reach * math.cos(high)
    angle, first = high, min(at_low, -at_high)
    for step in range(100):
        # regula falsi (Illinois), and halves in between
        share = at_low / (at_low - at_high) if step % 4 else 0.5
        angle = low + share * (high - low)
        reach = _reach(angle, reach, d, drive, shape, inner, outer)
        here = sign * _across(angle, reach, d, drive, shape, inner, outer)
        if here > 0.0:
            low, at_low, at_high = angle, here, 0.5 * at_high
        else:
            high, at_high, at_low = angle, here, 0.5 * at_low
        if abs(high - low) <= 1e-12 or abs(here) <= 1e-12 * first:
            break
    return reach * math.sin(angle), reach * math.cos(angle)


@njit(error_model="numpy", _nrt=False)
def _across(
    angle: float,
    reach: float,
    d: tuple[float, float],
    drive: Drive,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
) -> float:
    """Force on a ball across e_o, towards larger angles [N]."""
    cos, sin = math.cos(angle), math.sin(angle)
    state = _state(reach * sin, reach * cos, d, drive, shape, inner, outer)
    return state.fx * cos - state.fr * sin


@njit(error_model="numpy", _nrt=False)
def _reach(
    angle: float,
    guess: float,
    d: tuple[float, float],
    drive: Drive,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
) -> float:
    """Distance of a ball from the outer groove's centre by which forces along e_o are in balance [m]."""
    cos, sin = math.cos(angle), math.sin(angle)
    # the force falls with the distance: Newton's method between bounds, whose slope leaves turns aside
    low, high = 0.0, math.inf
    place = guess
    for _ in range(100):
        state = _state(place * sin, place * cos, d, drive, shape, inner, outer)
        force = state.fx * sin + state.fr * cos
        if force > 0.0:
            low = place
        else:
            high = place
        if abs(force) <= 1e-14 * state.size:
            break
        slope = state.m00 * sin * sin + (state.m01 + state.m10) * sin * cos + state.m11 * cos * cos
        ahead = place + force / slope if slope > 0.0 else math.inf
        if not low < ahead < high:
            ahead = 0.5 * (low + high) if high < math.inf else place + 1e-2 * shape.outer_arm
        if abs(ahead - place) <= 1e-15 * place:
            break
        place = ahead
    return place


class BallState(NamedTuple):
    """Forces on a ball at a place, and what they come from.

    Attributes
    ----------
    fx, fr, size : float
        Force that is left, axial and radial, and the sum of the sizes of its parts [N].
    m00, m01, m10, m11 : float
        Minus its derivative by the place of the ball [N/m].
    qi, qo, ki, ko : float
        Loads [N] and stiffness [N/m] of the contacts.
    at_i, at_o : float
        Their places on their tables.
    ix, ir, ox, orr : float
        Directions e_i and e_o.
    inner_distance, reach : float
        Distances of the ball's centre from both groove centres [m].
    speed, centrifugal, traction : float
        Speed around the axis [rad/s], F_c and t [N].
    px, pr, dx, dr : float
        Derivative of P by the speed [N s], and that of the speed by d [rad/(s m)].
    """

    fx: float
    fr: float
    size: float
    m00: float
    m01: float
    m10: float
    m11: float
    qi: float
    qo: float
    ki: float
    ko: float
    at_i: float
    at_o: float
    ix: float
    ir: float
    ox: float
    orr: float
    inner_distance: float
    reach: float
    speed: float
    centrifugal: float
    traction: float
    px: float
    pr: float
    dx: float
    dr: float


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _state(
    x: float,
    r: float,
    d: tuple[float, float],
    drive: Drive,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
) -> BallState:
    """Forces on a ball at a place."""
    reach = math.sqrt(x * x + r * r)
    ix, ir = d[0] - x, d[1] - r
    distance = max(math.sqrt(ix * ix + ir * ir), 1e-300)
    qo, ko, at_o = carried(outer, reach - shape.outer_arm)
    qi, ki, at_i = carried(inner, distance - shape.inner_arm)
    one_o, one_i = 1.0 / reach, 1.0 / distance
    ox, orr, ix, ir = x * one_o, r * one_o, ix * one_i, ir * one_i
    to, ti = qo * one_o, qi * one_i
    speed, by_i, by_o = orbit(drive, ix, ir, ox, orr)
    centrifugal, traction, by_load, by_traction = ball_loads(drive, speed)
    px, pr = -by_traction * ox * orr, by_load + by_traction * ox * ox
    # a_i and a_o follow d and v by (cos, -sin) over the distance
    dx, dr = by_i * ir * one_i, -by_i * ix * one_i
    vx, vr = by_o * orr * one_o - dx, -by_o * ox * one_o - dr
    # the traction turns with the angle a_o, whose derivative by the place is (cos, -sin)/reach
    turn_x, turn_r = traction * (orr * orr - ox * ox) * one_o, -2.0 * traction * ox * orr * one_o
    mixed = (ko - to) * ox * orr + (ki - ti) * ix * ir
    return BallState(
        qi * ix - qo * ox - traction * ox * orr,
        qi * ir - qo * orr + centrifugal + traction * ox * ox,
        qi + qo + centrifugal,
        (ko - to) * ox * ox + to + (ki - ti) * ix * ix + ti + turn_x * orr - px * vx,
        mixed - turn_x * ox - px * vr,
        mixed + turn_r * orr - pr * vx,
        (ko - to) * orr * orr + to + (ki - ti) * ir * ir + ti - turn_r * ox - pr * vr,
        qi,
        qo,
        ki,
        ko,
        at_i,
        at_o,
        ix,
        ir,
        ox,
        orr,
        distance,
        reach,
        speed,
        centrifugal,
        traction,
        px,
        pr,
        dx,
        dr,
    )


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _answer(
    state: BallState, shape: BallShape, inner: NormalLaw, outer: NormalLaw, centre: FloatArray, out: FloatArray
) -> None:
    """Force, stiffness and damping of a ball in balance, and S, see `place_ball`."""
    qi, ki = state.qi, state.ki
    ix, ir, ox, orr = state.ix, state.ir, state.ox, state.orr
    ti = qi / state.inner_distance
    k00, k01, k11 = (ki - ti) * ix * ix + ti, (ki - ti) * ix * ir, (ki - ti) * ir * ir + ti
    m00, m01, m10, m11 = state.m00, state.m01, state.m10, state.m11
    determinant = m00 * m11 - m01 * m10
    l00, l01, l10, l11 = (
        k00 + state.px * state.dx,
        k01 + state.px * state.dr,
        k01 + state.pr * state.dx,
        k11 + state.pr * state.dr,
    )
    out[0], out[1] = qi * ix, qi * ir
    out[10], out[11] = qi, state.qo
    out[12] = out[13] = 0.0
    out[14], out[15] = state.inner_distance - shape.inner_arm, state.reach - shape.outer_arm
    out[16], out[17], out[18], out[19], out[20], out[21] = ix, ir, ox, orr, state.at_i, state.at_o
    out[22], out[23], out[24] = state.speed, state.centrifugal, state.traction
    if qi <= 0.0 or determinant == 0.0:
        for i in range(2, 10):
            out[i] = 0.0
        return
    ci, co = slowed(inner, ki, state.at_i), slowed(outer, state.ko, state.at_o)
    one = 1.0 / determinant
    n00, n01, n10, n11 = m11 * one, -m01 * one, -m10 * one, m00 * one
    # S = M^-1 L and S' = K_i M^-1
    s00, s01 = n00 * l00 + n01 * l10, n00 * l01 + n01 * l11
    s10, s11 = n10 * l00 + n11 * l10, n10 * l01 + n11 * l11
    centre[4], centre[5], centre[6], centre[7] = s00, s01, s10, s11
    p00, p01 = k00 * n00 + k01 * n10, k00 * n01 + k01 * n11
    p10, p11 = k01 * n00 + k11 * n10, k01 * n01 + k11 * n11
    # what is left out of balance moves the ball by one step more
    centre[0] += n00 * state.fx + n01 * state.fr
    centre[1] += n10 * state.fx + n11 * state.fr
    out[0] -= p00 * state.fx + p01 * state.fr
    out[1] -= p10 * state.fx + p11 * state.fr
    # K_i (1 - S), without the difference of nearly equal numbers: S' (M - L)
    b00, b01, b10, b11 = m00 - l00, m01 - l01, m10 - l10, m11 - l11
    out[2], out[3] = p00 * b00 + p01 * b10, p00 * b01 + p01 * b11
    out[4], out[5] = p10 * b00 + p11 * b10, p10 * b01 + p11 * b11
    # dampers act along the contacts: their rates are u.(1 - S) and w.S, and their forces come back by S'
    ux, ur = ix - (ix * s00 + ir * s10), ir - (ix * s01 + ir * s11)
    vx, vr = ix - (p00 * ix + p01 * ir), ir - (p10 * ix + p11 * ir)
    wx, wr = ox * s00 + orr * s10, ox * s01 + orr * s11
    yx, yr = p00 * ox + p01 * orr, p10 * ox + p11 * orr
    out[6], out[7] = ci * vx * ux + co * yx * wx, ci * vx * ur + co * yx * wr
    out[8], out[9] = ci * vr * ux + co * yr * wx, ci * vr * ur + co * yr * wr


@njit(error_model="numpy", _nrt=False)
def ball_force(
    pose: FloatArray,
    numbers: FloatArray,
    cos: FloatArray,
    sin: FloatArray,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
    force: FloatArray,
    stiffness: FloatArray,
    damping: FloatArray,
    centres: FloatArray,
    balls: FloatArray,
    held: FloatArray,
) -> int:
    """Force on the inner ring at rest, and its derivatives; the number of loaded balls, or what is wrong.

    Parameters
    ----------
    pose : array (6,)
        Pose of the inner ring in O [m], [rad].
    numbers : array (NUMBERS,)
        Angle of the cage [rad], the approach at the outer raceway under F_c alone [m], and `Drive` in its order.
    cos, sin : array (Z,)
        Directions of the balls in the cage, y and z.
    shape, inner, outer : BallShape, NormalLaw, NormalLaw
        Lengths, and laws of the contacts.
    force, stiffness, damping : array (6,), (6, 6), (6, 6)
        Written: force [N], [N m], and -df/dpose, -df/dvelocity.
    centres : array (Z, START)
        Starts of the balls, or NaN; written, see `place_ball`.
    balls : array (Z, COLUMNS)
        Written: see `place_ball`.
    held : array (Z, 2, HELD), or none (0, 2, HELD)
        What the inner and the outer contacts hold over a step, see `NormalLaw`.
    """
    total = 0.0
    for value in pose:
        total += abs(value)
    if not total + abs(numbers[0]) + abs(numbers[2]) + abs(numbers[3]) < math.inf:
        return NOT_FINITE
    drive = Drive(numbers[2], numbers[3], numbers[4], numbers[5], numbers[6], numbers[7])
    far, tilt = shape.most_travel, shape.most_tilt
    if not (abs(pose[0]) <= far and abs(pose[1]) <= far and abs(pose[2]) <= far):
        return TOO_FAR
    if not (abs(pose[4]) <= tilt and abs(pose[5]) <= tilt):
        return TOO_FAR
    force[:] = 0.0
    stiffness[:] = 0.0
    damping[:] = 0.0
    turn_c, turn_s = math.cos(numbers[0]), math.sin(numbers[0])
    loaded = 0
    for j in range(cos.size):
        c, s = turn_c * cos[j] - turn_s * sin[j], turn_s * cos[j] + turn_c * sin[j]
        d = (
            shape.axial + pose[0] + shape.arm * (pose[4] * s - pose[5] * c),
            shape.radial + pose[1] * c + pose[2] * s,
        )
        out, own_i, own_o = balls[j], inner, outer
        if held.shape[0] > 0:
            own_i, own_o = holding(inner, held, j, 0), holding(outer, held, j, 1)
        if not place_ball(d, drive, numbers[1], shape, own_i, own_o, centres[j], out):
            return NO_BALANCE
        if out[10] <= 0.0:
            continue
        loaded += 1
        y, z = shape.arm * s, -shape.arm * c
        force[0] -= out[0]
        force[1] -= c * out[1]
        force[2] -= s * out[1]
        force[4] -= y * out[0]
        force[5] -= z * out[0]
        _add(out[2], out[3], out[4], out[5], c, s, y, z, stiffness)
        _add(out[6], out[7], out[8], out[9], c, s, y, z, damping)
    return loaded


@njit(error_model="numpy", _nrt=False, forceinline=True)
def _add(xx: float, xr: float, rx: float, rr: float, c: float, s: float, y: float, z: float, out: FloatArray) -> None:
    """Add what a ball has by d to a matrix (6, 6); d by pose: axial (1, 0, 0, 0, y, z), radial (0, c, s, 0, 0, 0)."""
    out[0, 0] += xx
    out[0, 1] += xr * c
    out[0, 2] += xr * s
    out[0, 4] += xx * y
    out[0, 5] += xx * z
    out[1, 0] += rx * c
    out[1, 1] += rr * c * c
    out[1, 2] += rr * c * s
    out[1, 4] += rx * c * y
    out[1, 5] += rx * c * z
    out[2, 0] += rx * s
    out[2, 1] += rr * s * c
    out[2, 2] += rr * s * s
    out[2, 4] += rx * s * y
    out[2, 5] += rx * s * z
    out[4, 0] += xx * y
    out[4, 1] += xr * y * c
    out[4, 2] += xr * y * s
    out[4, 4] += xx * y * y
    out[4, 5] += xx * y * z
    out[5, 0] += xx * z
    out[5, 1] += xr * z * c
    out[5, 2] += xr * z * s
    out[5, 4] += xx * z * y
    out[5, 5] += xx * z * z


@njit(error_model="numpy", _nrt=False)
def write_angles(balls: FloatArray) -> None:
    """Write the contact angles of the inner and the outer side [rad], by the directions of the contacts.

    Parameters
    ----------
    balls : array (Z, COLUMNS)
        What `place_ball` writes of each ball; angles written into columns 12 and 13.
    """
    for j in range(balls.shape[0]):
        for side in range(2):
            balls[j, 12 + side] = math.atan2(balls[j, 16 + 2 * side], balls[j, 17 + 2 * side])
