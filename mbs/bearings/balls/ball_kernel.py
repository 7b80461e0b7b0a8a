"""Compiled sums over the balls of a bearing: force, stiffness, damping, and the place of each ball.

All of a ball happens in the plane of the axis and the ball. There the centre of the outer groove is the origin, d the
centre of the inner groove, v that of the ball, each (axial, radial). With e_o = v/|v|, e_i = (d - v)/|d - v|, the arms
l = (f - 1/2) Dw and the approaches |v| - l_o, |d - v| - l_i, the ball is in balance where

    Q_i e_i - Q_o e_o + F_c (0, 1) + 2 (M/Dw) (-cos a_o, sin a_o) = 0,       a_o the angle of e_o,

with the centrifugal load F_c and the gyroscopic moment M = G sin a_o that the outer raceway's traction holds. The force
on the inner ring is -Q_i e_i. With K_i, K_o the stiffness of the contacts (their rotation included), T the derivative
of the traction, M = K_i + K_o - T, S = M^-1 K_i and S' = K_i M^-1, slow motion has

    stiffness  K_i - K_i M^-1 K_i,        damping  C_i - C_i S - S' C_i + S' (C_i + C_o) S,

exact for a ball without mass of its own against its balance: M comes from the balance as it is solved, by Newton's
method. Without gyroscopic moment the balance is the minimum of a convex potential.

Each contact law is F = C g^(3/2), with the dry overlap g = approach, or with g(approach) from a table for films.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit

NOT_FINITE, TOO_FAR, NO_BALANCE = -1, -2, -3
"""What `ball_force` finds instead of an answer."""

NEWTON_STEPS, LAST_STEPS = 12, 6
"""Steps of Newton's method until the angle is searched, and after that."""

_CUTS = 12
_BALANCE, _ROUGH_BALANCE = 1e-13, 1e-9
_ROUND_OFF = 1e-15


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


class NormalLaw(NamedTuple):
    """Law of a contact over its approach.

    Attributes
    ----------
    coefficient : float
        C of F = C g^(3/2) [N/m^1.5].
    damping, damping_time : float
        Constant part of c while there is load [N s/m], and the part in proportion to the stiffness [s].
    centre, scale, first, step : float
        Table of g: z = asinh((approach - centre)/scale), its first node and the distance of nodes.
    held, spring, at : float
        Force [N] and spring [N/m] of a film with memory beside its rest, by the approach beyond `at` [m], over a step,
        see `mbs.bearings.balls.ball_memory`; without a spring it has none.
    table : array (nodes, 4)
        ln g and its slope by node, ln c and its slope; none for a dry contact.
    """

    coefficient: float
    damping: float
    damping_time: float
    centre: float
    scale: float
    first: float
    step: float
    held: float
    spring: float
    at: float
    table: FloatArray


HELD = 3
"""Numbers that a contact with memory holds over a step."""


@njit(error_model="numpy")
def _holding(law: NormalLaw, held: FloatArray) -> NormalLaw:
    """A law with what its film holds over a step."""
    return NormalLaw(
        law.coefficient, law.damping, law.damping_time, law.centre, law.scale, law.first, law.step,
        held[0], held[1], held[2], law.table,
    )  # fmt: skip


@njit(error_model="numpy")
def contact(law: NormalLaw, approach: float) -> tuple[float, float, float]:
    """Load [N], stiffness [N/m] and damping [N s/m] of a contact at rest, or at the end of a step with memory."""
    if law.table.shape[0] == 0:
        if approach <= 0.0:
            return 0.0, 0.0, 0.0
        root = law.coefficient * math.sqrt(approach)
        k = 1.5 * root
        return root * approach, k, law.damping + law.damping_time * k
    zeta = (approach - law.centre) / law.scale
    place = (math.asinh(zeta) - law.first) / law.step
    last = law.table.shape[0] - 1
    cell = min(max(int(place), 0), last - 1)
    t = place - cell
    low, high = law.table[cell], law.table[cell + 1]
    slope_of_place = 1.0 / (law.scale * law.step * math.sqrt(1.0 + zeta * zeta))
    if t < 0.0:  # straight beyond the ends
        value, slope, damping = low[0] + low[1] * t, low[1], low[2] + low[3] * t
    elif t > 1.0:
        value, slope, damping = high[0] + high[1] * (t - 1.0), high[1], high[2] + high[3] * (t - 1.0)
    else:
        r = 1.0 - t
        bend = t * t * (3.0 - 2.0 * t)
        value = low[0] * (1.0 - bend) + high[0] * bend + t * r * (low[1] * r - high[1] * t)
        slope = 6.0 * t * r * (high[0] - low[0]) + low[1] * r * (r - 2.0 * t) + high[1] * t * (t - 2.0 * r)
        damping = low[2] * (1.0 - bend) + high[2] * bend + t * r * (low[3] * r - high[3] * t)
    g = math.exp(value)
    root = law.coefficient * math.sqrt(g)
    load, k = root * g, 1.5 * root * g * slope * slope_of_place
    if law.spring <= 0.0:
        return load, k, math.exp(damping)
    more = law.held + law.spring * (approach - law.at)
    if more >= 0.0:
        return load + more, k + law.spring, 0.0
    size = math.sqrt(more * more + load * load)
    total = load * load / (size - more)
    return total, (law.spring * total + k * load) / size, 0.0


@njit(error_model="numpy")
def place_ball(
    d: tuple[float, float],
    centrifugal: float,
    traction: float,
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
    centrifugal, traction : float
        F_c, and 2 G/Dw [N].
    rest : float
        Approach at the outer raceway of a ball that bears its centrifugal load alone [m].
    shape, inner, outer : BallShape, NormalLaw, NormalLaw
        Lengths, and laws of the contacts.
    centre : array (2,)
        Centre of the ball at the beginning, and then where it is; NaN for a start from nothing.
    out : array (16,)
        Written: force on the inner ring without its sign (2), stiffness (4), damping (4) of the pair, loads Q_i and
        Q_o [N], angles a_i and a_o [rad], approaches [m].
    """
    length = math.sqrt(d[0] * d[0] + d[1] * d[1])
    overlap = length - shape.inner_arm - shape.outer_arm
    out[:] = 0.0
    dry = inner.table.shape[0] == 0 and outer.table.shape[0] == 0
    if dry and centrifugal <= 0.0 and overlap <= 0.0:
        reach = shape.outer_arm + 0.5 * overlap
        centre[0], centre[1] = reach * d[0] / length, reach * d[1] / length
        out[12] = out[13] = math.atan2(d[0], d[1])
        out[14] = out[15] = 0.5 * overlap
        return True
    share = outer.coefficient ** (-2.0 / 3.0)
    share /= share + inner.coefficient ** (-2.0 / 3.0)
    if dry and centrifugal <= 0.0:  # two dry contacts in line share the overlap
        reach = (shape.outer_arm + share * overlap) / length
        centre[0], centre[1] = reach * d[0], reach * d[1]
        _answer(_state(centre[0], centre[1], d, 0.0, 0.0, shape, inner, outer), shape, out)
        return True
    # starts: where the ball was; in line between the grooves; on the outer raceway alone, in line and at its bottom
    best, x, r = math.inf, 0.0, shape.outer_arm + rest
    state = _state(x, r, d, centrifugal, traction, shape, inner, outer)
    for start in range(4):
        if start == 0:
            px, pr = centre[0], centre[1]
        elif start < 3:
            reach = (shape.outer_arm + (share * overlap if start == 1 else rest)) / length
            px, pr = reach * d[0], reach * d[1]
        else:
            px, pr = 0.0, shape.outer_arm + rest
        if not px * px + pr * pr > 0.0:
            continue
        here = _state(px, pr, d, centrifugal, traction, shape, inner, outer)
        # a ball between both raceways, without load, would not know where to go
        if not here.qo > 0.0:
            continue
        error = math.sqrt(here.fx * here.fx + here.fr * here.fr) / here.size
        # at the bottom: no inner contact, and in balance
        if error < best or (start == 3 and error < 1e-3):
            best, x, r, state = error, px, pr, here
        if best < 0.3 and start == 0:
            break
    x, r, state, found = _newton(x, r, state, NEWTON_STEPS, d, centrifugal, traction, shape, inner, outer)
    if not found:
        x, r = _searched(d, centrifugal, traction, shape, inner, outer)
        state = _state(x, r, d, centrifugal, traction, shape, inner, outer)
        x, r, state, found = _newton(x, r, state, LAST_STEPS, d, centrifugal, traction, shape, inner, outer)
    centre[0], centre[1] = x, r
    _answer(state, shape, out)
    return found


@njit(error_model="numpy")
def _newton(
    x: float,
    r: float,
    state: BallState,
    steps: int,
    d: tuple[float, float],
    centrifugal: float,
    traction: float,
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
            ahead = _state(nx, nr, d, centrifugal, traction, shape, inner, outer)
            if math.sqrt(ahead.fx * ahead.fx + ahead.fr * ahead.fr) < (1.0 - 1e-4 * part) * norm:
                moved = True
                break
            part *= 0.5
        if not moved:
            break
        x, r, state = nx, nr, ahead
    norm = math.sqrt(state.fx * state.fx + state.fr * state.fr)
    return x, r, state, norm <= _ROUGH_BALANCE * state.size + allowed


@njit(error_model="numpy")
def _searched(
    d: tuple[float, float],
    centrifugal: float,
    traction: float,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
) -> tuple[float, float]:
    """Place of a ball by its angle a_o, which lies between zero and the direction of d: slow and safe.

    At each angle the balance along e_o gives the distance, and what is left across e_o has one zero.
    """
    low, high = 0.0, math.atan2(d[0], d[1])
    sign = 1.0 if high >= 0.0 else -1.0
    reach = _reach(low, shape.outer_arm, d, centrifugal, traction, shape, inner, outer)
    at_low = sign * _across(low, reach, d, centrifugal, traction, shape, inner, outer)
    if at_low <= 0.0:
        return 0.0, reach
    reach = _reach(high, reach, d, centrifugal, traction, shape, inner, outer)
    at_high = sign * _across(high, reach, d, centrifugal, traction, shape, inner, outer)
    if at_high >= 0.0:
        return reach * math.sin(high), reach * math.cos(high)
    angle, first = high, min(at_low, -at_high)
    for step in range(100):
        # regula falsi (Illinois), and halves in between
        share = at_low / (at_low - at_high) if step % 4 else 0.5
        angle = low + share * (high - low)
        reach = _reach(angle, reach, d, centrifugal, traction, shape, inner, outer)
        here = sign * _across(angle, reach, d, centrifugal, traction, shape, inner, outer)
        if here > 0.0:
            low, at_low, at_high = angle, here, 0.5 * at_high
        else:
            high, at_high, at_low = angle, here, 0.5 * at_low
        if abs(high - low) <= 1e-12 or abs(here) <= 1e-12 * first:
            break
    return reach * math.sin(angle), reach * math.cos(angle)


@njit(error_model="numpy")
def _across(
    angle: float,
    reach: float,
    d: tuple[float, float],
    centrifugal: float,
    traction: float,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
) -> float:
    """Force on a ball across e_o, towards larger angles [N]."""
    cos, sin = math.cos(angle), math.sin(angle)
    state = _state(reach * sin, reach * cos, d, centrifugal, traction, shape, inner, outer)
    return state.fx * cos - state.fr * sin


@njit(error_model="numpy")
def _reach(
    angle: float,
    guess: float,
    d: tuple[float, float],
    centrifugal: float,
    traction: float,
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
        state = _state(place * sin, place * cos, d, centrifugal, traction, shape, inner, outer)
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
    qi, qo, ki, ci, co : float
        Loads [N], stiffness [N/m], damping [N s/m] of the contacts.
    ix, ir, ox, orr : float
        Directions e_i and e_o.
    inner_distance, reach : float
        Distances of the ball's centre from both groove centres [m].
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
    ci: float
    co: float
    ix: float
    ir: float
    ox: float
    orr: float
    inner_distance: float
    reach: float


@njit(error_model="numpy")
def _state(
    x: float,
    r: float,
    d: tuple[float, float],
    centrifugal: float,
    traction: float,
    shape: BallShape,
    inner: NormalLaw,
    outer: NormalLaw,
) -> BallState:
    """Forces on a ball at a place."""
    reach = math.sqrt(x * x + r * r)
    ix, ir = d[0] - x, d[1] - r
    distance = max(math.sqrt(ix * ix + ir * ir), 1e-300)
    qo, ko, co = contact(outer, reach - shape.outer_arm)
    qi, ki, ci = contact(inner, distance - shape.inner_arm)
    one_o, one_i = 1.0 / reach, 1.0 / distance
    ox, orr, ix, ir = x * one_o, r * one_o, ix * one_i, ir * one_i
    to, ti = qo * one_o, qi * one_i
    # the traction turns with the angle a_o, whose derivative by the place is (cos, -sin)/reach
    turn_x, turn_r = traction * (orr * orr - ox * ox) * one_o, -2.0 * traction * ox * orr * one_o
    mixed = (ko - to) * ox * orr + (ki - ti) * ix * ir
    return BallState(
        qi * ix - qo * ox - traction * ox * orr,
        qi * ir - qo * orr + centrifugal + traction * ox * ox,
        qi + qo + centrifugal,
        (ko - to) * ox * ox + to + (ki - ti) * ix * ix + ti + turn_x * orr,
        mixed - turn_x * ox,
        mixed + turn_r * orr,
        (ko - to) * orr * orr + to + (ki - ti) * ir * ir + ti - turn_r * ox,
        qi,
        qo,
        ki,
        ci,
        co,
        ix,
        ir,
        ox,
        orr,
        distance,
        reach,
    )


@njit(error_model="numpy")
def _answer(state: BallState, shape: BallShape, out: FloatArray) -> None:
    """Force, stiffness and damping of a ball in balance, see `place_ball`."""
    qi, ki, ci, co = state.qi, state.ki, state.ci, state.co
    ix, ir, ox, orr = state.ix, state.ir, state.ox, state.orr
    ti = qi / state.inner_distance
    k00, k01, k11 = (ki - ti) * ix * ix + ti, (ki - ti) * ix * ir, (ki - ti) * ir * ir + ti
    m00, m01, m10, m11 = state.m00, state.m01, state.m10, state.m11
    determinant = m00 * m11 - m01 * m10
    out[0], out[1] = qi * ix, qi * ir
    out[10], out[11] = qi, state.qo
    out[12], out[13] = math.atan2(ix, ir), math.atan2(ox, orr)
    out[14], out[15] = state.inner_distance - shape.inner_arm, state.reach - shape.outer_arm
    if qi <= 0.0 or determinant == 0.0:
        return
    one = 1.0 / determinant
    n00, n01, n10, n11 = m11 * one, -m01 * one, -m10 * one, m00 * one
    # S = M^-1 K_i and S' = K_i M^-1
    s00, s01 = n00 * k00 + n01 * k01, n00 * k01 + n01 * k11
    s10, s11 = n10 * k00 + n11 * k01, n10 * k01 + n11 * k11
    p00, p01 = k00 * n00 + k01 * n10, k00 * n01 + k01 * n11
    p10, p11 = k01 * n00 + k11 * n10, k01 * n01 + k11 * n11
    # K_i (1 - S), without the difference of nearly equal numbers: S' (M - K_i)
    b00, b01, b10, b11 = m00 - k00, m01 - k01, m10 - k01, m11 - k11
    out[2], out[3] = p00 * b00 + p01 * b10, p00 * b01 + p01 * b11
    out[4], out[5] = p10 * b00 + p11 * b10, p10 * b01 + p11 * b11
    # dampers act along the contacts: their rates are u.(1 - S) and w.S, and their forces come back by S'
    ux, ur = ix - (ix * s00 + ir * s10), ir - (ix * s01 + ir * s11)
    vx, vr = ix - (p00 * ix + p01 * ir), ir - (p10 * ix + p11 * ir)
    wx, wr = ox * s00 + orr * s10, ox * s01 + orr * s11
    yx, yr = p00 * ox + p01 * orr, p10 * ox + p11 * orr
    out[6], out[7] = ci * vx * ux + co * yx * wx, ci * vx * ur + co * yx * wr
    out[8], out[9] = ci * vr * ux + co * yr * wx, ci * vr * ur + co * yr * wr


@njit(error_model="numpy")
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
    numbers : array (4,)
        Angle of the cage [rad], F_c [N], 2 G/Dw [N], and the approach at the outer raceway under F_c alone [m].
    cos, sin : array (Z,)
        Directions of the balls in the cage, y and z.
    shape, inner, outer : BallShape, NormalLaw, NormalLaw
        Lengths, and laws of the contacts.
    force, stiffness, damping : array (6,), (6, 6), (6, 6)
        Written: force [N], [N m], and -df/dpose, -df/dvelocity.
    centres : array (Z, 2)
        Centres of the balls of the last call, or NaN; written.
    balls : array (Z, 16)
        Written: see `place_ball`.
    held : array (Z, 2, HELD), or none (0, 2, HELD)
        What the inner and the outer contacts hold over a step, see `NormalLaw`.
    """
    total = 0.0
    for value in pose:
        total += abs(value)
    if not total + abs(numbers[0]) + abs(numbers[1]) + abs(numbers[2]) < math.inf:
        return NOT_FINITE
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
            own_i, own_o = _holding(inner, held[j, 0]), _holding(outer, held[j, 1])
        if not place_ball(d, numbers[1], numbers[2], numbers[3], shape, own_i, own_o, centres[j], out):
            return NO_BALANCE
        if out[10] <= 0.0:
            continue
        loaded += 1
        # derivatives of d by the pose: axial (1, 0, 0, 0, a s, -a c), radial (0, c, s, 0, 0, 0)
        axial = (1.0, shape.arm * s, -shape.arm * c)
        radial = (c, s)
        for m in range(3):
            row = 0 if m == 0 else m + 3
            force[row] -= axial[m] * out[0]
            for n in range(3):
                column = 0 if n == 0 else n + 3
                stiffness[row, column] += axial[m] * out[2] * axial[n]
                damping[row, column] += axial[m] * out[6] * axial[n]
            for n in range(2):
                stiffness[row, n + 1] += axial[m] * out[3] * radial[n]
                damping[row, n + 1] += axial[m] * out[7] * radial[n]
                stiffness[n + 1, row] += radial[n] * out[4] * axial[m]
                damping[n + 1, row] += radial[n] * out[8] * axial[m]
        for m in range(2):
            force[m + 1] -= radial[m] * out[1]
            for n in range(2):
                stiffness[m + 1, n + 1] += radial[m] * out[5] * radial[n]
                damping[m + 1, n + 1] += radial[m] * out[9] * radial[n]
    return loaded


@njit(error_model="numpy")
def load_approach(law: NormalLaw, load: float) -> float:
    """Approach at which a contact carries a load > 0 [m]."""
    g: float = (load / law.coefficient) ** (2.0 / 3.0)
    if law.table.shape[0] == 0:
        return g
    low, high = float(law.centre - 1e3 * law.scale), float(g + 1e3 * law.scale)
    for _ in range(200):
        middle = 0.5 * (low + high)
        if contact(law, middle)[0] < load:
            low = middle
        else:
            high = middle
        if high - low <= 1e-15 * law.scale:
            break
    return 0.5 * (low + high)


def empty_table() -> FloatArray:
    """Table of a dry contact."""
    return np.zeros((0, 4))


def nothing_held() -> FloatArray:
    """Numbers that contacts without memory hold: none."""
    return np.zeros((0, 2, HELD))
