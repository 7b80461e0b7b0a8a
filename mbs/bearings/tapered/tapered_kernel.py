"""Compiled sums over the rollers of a tapered roller bearing: force, stiffness, damping, place of each roller.

All of a roller happens in the plane of the bearing's axis and the roller, where it has three freedoms: V = (axial,
radial, rotation from the axis outwards), of its middle. D = (axial, radial, rotation) is what the inner ring does to
the middle of the roller, as a rigid body. Displacements are small against the roller, so that normals stand still. A
contact with the normal e (axial, radial) and the lever b about the middle of the roller has the approach

    n.V at the cup and its ribs,     n.(D - V) at the cone and its ribs,     n = (e, b),

less the depth of its profile, or the play of a rib. With A and B the sums of k n n' over the contacts with the inner
ring and with the outer one, and M = A + B, the roller is in balance where

    sum Q n (cup) - sum Q n (cone) = F,

F its centrifugal load and gyroscopic moment: the minimum of a convex potential, found by Newton's method, with shorter
steps where they lead beyond the minimum along them. Slow motion has

    stiffness  A - A M^-1 A,        damping  (1 - S)' A_c (1 - S) + S' B_c S,     S = M^-1 A,

with the dampers' sums A_c and B_c. Slices of a line carry q = C g^(10/9)/n each, or what a table with films says; a
rib has Q = C g^(3/2).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.compiled import njit
from ehdmaps.copies import put
from mbs.bearings.balls.normal_law import NormalLaw
from mbs.bearings.tapered.line_kernel import (
    AT,
    PULL,
    SPRING,
    dry_line,
    film_dampers,
    film_line,
    held_dampers,
    held_line,
)

NOT_FINITE, TOO_FAR, NO_BALANCE = -1, -2, -3
"""What `tapered_force` finds instead of an answer."""

FIRST_RIB, MOST_RIBS = 15, 4
FIRST_SHARE = FIRST_RIB + MOST_RIBS
COLUMNS = FIRST_SHARE + 9
"""Numbers that are kept of a roller, see `place_roller`: loads of its ribs before S."""

_STEPS, _CUTS = 80, 40
_BALANCE, _ROUGH = 1e-13, 1e-9
_NOTHING = 1e-10
"""Load below which a contact counts as unloaded [N]."""

_NEAR = 0.1
"""Part of the forces on a roller that may be left at a place from which Newton's method begins at once."""

_LIGHT = 1e-6
"""Load on a roller that is left out of dry contacts [N]: approaches by it would be rounding."""

_SOFT = 1e-13
"""Stiffness, over that of a contact, that holds rollers which nothing holds."""


class Ribs(NamedTuple):
    """Ribs that the end of a roller may lean on, m of them.

    Attributes
    ----------
    normals : array (m, 2)
        Normals, axial and radial.
    levers, plays : array (m,)
        Levers of the normals about the middle of the roller, and distances from the ends where nothing moved [m].
    laws : array (m,)
        C of each [N/m^1.5].
    outer : array (m,), of bool
        Whether it is a rib of the cup.
    """

    normals: FloatArray
    levers: FloatArray
    plays: FloatArray
    laws: FloatArray
    outer: BoolArray


class TaperedShape(NamedTuple):
    """Numbers of a bearing that do not change.

    Attributes
    ----------
    pitch_radius : float
        Distance of the middles of rollers from the axis [m].
    cup, cone : (float, float)
        Normals of the lines: axial, radial.
    ribs : Ribs
        What holds a roller along its axis.
    levers, profile : array (n,)
        Levers of the slices of both lines, and depths of the profile on one side with the play there [m].
    cos, sin : array (Z,)
        Directions of the rollers in the cage, y and z.
    most_travel, most_tilt : float
        Largest accepted displacement [m] and tilt [rad] of the ring.
    """

    pitch_radius: float
    cup: tuple[float, float]
    cone: tuple[float, float]
    ribs: Ribs
    levers: FloatArray
    profile: FloatArray
    cos: FloatArray
    sin: FloatArray
    most_travel: float
    most_tilt: float


class RollerLaws(NamedTuple):
    """Laws of the contacts of a roller.

    Attributes
    ----------
    cup, cone : float
        C of the whole roller [N/m^(10/9)].
    damping : float
        Constant damping of each contact while it carries load [N s/m]; of lines, for the whole roller.
    damping_time : float
        Damping over stiffness of each contact [s].
    cup_film, cone_film : NormalLaw
        Tables of a whole roller with films; without a table for dry lines.
    relaxes : bool
        Whether films have a memory over a step, see `mbs.bearings.tapered.tapered_memory`.
    """

    cup: float
    cone: float
    damping: float
    damping_time: float
    cup_film: NormalLaw
    cone_film: NormalLaw
    relaxes: bool


@njit(error_model="numpy", _nrt=False)
def _film_line(
    film: NormalLaw,
    relaxes: bool,
    held: FloatArray,
    approach: float,
    turn: float,
    levers: FloatArray,
    profile: FloatArray,
    places: FloatArray,
    sums: FloatArray,
) -> None:
    """Sums of a line with a film at an approach and a rotation, but for damping."""
    count = levers.size
    if relaxes:
        pull, spring, at = held[PULL, :count], held[SPRING, :count], held[AT, :count]
        held_line(film, pull, spring, at, approach, turn, levers, profile, places[:count], sums)
    else:
        film_line(film, approach, turn, levers, profile, places[:count], sums)


@njit(error_model="numpy", _nrt=False)
def _film_dampers(
    film: NormalLaw, relaxes: bool, held: FloatArray, levers: FloatArray, places: FloatArray, sums: FloatArray
) -> None:
    """Damping of a line with a film where `_film_line` was asked last."""
    if relaxes:
        held_dampers(film, held[SPRING, : levers.size], places[: levers.size], levers, sums)
    else:
        film_dampers(film, places[: levers.size], levers, sums)


@njit(error_model="numpy", _nrt=False)
def _add(normal: tuple[float, float], sums: FloatArray, first: int, matrix: FloatArray) -> None:
    """Add k n n' of a contact to a matrix (3, 3): sums [first] k, k b, k b b."""
    k, kb, kbb = sums[first], sums[first + 1], sums[first + 2]
    ex, er = normal
    matrix[0, 0] += k * ex * ex
    matrix[0, 1] += k * ex * er
    matrix[1, 0] += k * ex * er
    matrix[1, 1] += k * er * er
    matrix[0, 2] += kb * ex
    matrix[2, 0] += kb * ex
    matrix[1, 2] += kb * er
    matrix[2, 1] += kb * er
    matrix[2, 2] += kbb


@njit(error_model="numpy", _nrt=False)
def _solve(m: FloatArray, b: FloatArray, out: FloatArray) -> None:
    """Solve M out = b for a symmetric positive M (3, 3), by its Cholesky factors."""
    l00 = math.sqrt(m[0, 0])
    l10, l20 = m[1, 0] / l00, m[2, 0] / l00
    l11 = math.sqrt(max(m[1, 1] - l10 * l10, 1e-30 * m[1, 1]))
    l21 = (m[2, 1] - l20 * l10) / l11
    l22 = math.sqrt(max(m[2, 2] - l20 * l20 - l21 * l21, 1e-30 * m[2, 2]))
    y0 = b[0] / l00
    y1 = (b[1] - l10 * y0) / l11
    y2 = (b[2] - l20 * y0 - l21 * y1) / l22
    out[2] = y2 / l22
    out[1] = (y1 - l21 * out[2]) / l11
    out[0] = (y0 - l10 * out[1] - l20 * out[2]) / l00


class RollerWork(NamedTuple):
    """Work space of a roller.

    Attributes
    ----------
    cup, cone : array (8,)
        Sums of the lines, of the lines, see `mbs.bearings.tapered.line_kernel`.
    places : array (2, n)
        Places of the slices of cone and cup on the tables of films.
    ribs : array (m, 8)
        The same of the ribs.
    inner, whole, damped_inner, damped_outer : array (3, 3)
        A, M, A_c, B_c.
    loads, rest, step, trial : array (3,)
        F, force that is left, Newton's step, a place.
    share : array (3, 3)
        S = M^-1 A.
    plane : array (2, 3, 3)
        Stiffness and damping of the roller.
    """

    cup: FloatArray
    cone: FloatArray
    places: FloatArray
    ribs: FloatArray
    inner: FloatArray
    whole: FloatArray
    damped_inner: FloatArray
    damped_outer: FloatArray
    loads: FloatArray
    rest: FloatArray
    step: FloatArray
    trial: FloatArray
    share: FloatArray
    plane: FloatArray


def roller_work(ribs: int, slices: int) -> RollerWork:
    """Work space for one bearing.

    Parameters
    ----------
    ribs, slices : int
        Ribs and slices of a roller.
    """
    return RollerWork(
        cup=np.zeros(8),
        cone=np.zeros(8),
        places=np.zeros((2, slices)),
        ribs=np.zeros((ribs, 8)),
        inner=np.zeros((3, 3)),
        whole=np.zeros((3, 3)),
        damped_inner=np.zeros((3, 3)),
        damped_outer=np.zeros((3, 3)),
        loads=np.zeros(3),
        rest=np.zeros(3),
        step=np.zeros(3),
        trial=np.zeros(3),
        share=np.zeros((3, 3)),
        plane=np.zeros((2, 3, 3)),
    )


@njit(error_model="numpy", _nrt=False)
def _state(
    d: tuple[float, float, float],
    v: FloatArray,
    loads: FloatArray,
    shape: TaperedShape,
    laws: RollerLaws,
    held: FloatArray,
    w: RollerWork,
) -> float:
    """Contacts at a place of the roller; the force that is left in `w.rest`, and the sum of the sizes of its parts."""
    x, r, turn = d[0] - v[0], d[1] - v[1], d[2] - v[2]
    cup, cone = shape.cup[0] * v[0] + shape.cup[1] * v[1], shape.cone[0] * x + shape.cone[1] * r
    levers, profile, part = shape.levers, shape.profile, 1.0 / shape.levers.size
    if laws.cup_film.table.shape[0] == 0:
        dry_line((part * laws.cup, part * laws.damping, laws.damping_time), cup, v[2], levers, profile, w.cup)
        dry_line((part * laws.cone, part * laws.damping, laws.damping_time), cone, turn, levers, profile, w.cone)
    else:
        _film_line(laws.cup_film, laws.relaxes, held[1], cup, v[2], levers, profile, w.places[1], w.cup)
        _film_line(laws.cone_film, laws.relaxes, held[0], cone, turn, levers, profile, w.places[0], w.cone)
    for i in range(2):
        w.rest[i] = loads[i] + w.cone[0] * shape.cone[i] - w.cup[0] * shape.cup[i]
    w.rest[2] = loads[2] + w.cone[1] - w.cup[1]
    size: float = w.cup[0] + w.cone[0] + abs(loads[0]) + abs(loads[1]) + abs(loads[2] / shape.levers[-1])
    ribs = shape.ribs
    for m in range(ribs.levers.size):
        sums, sign = w.ribs[m], -1.0 if ribs.outer[m] else 1.0
        sums[:] = 0.0
        ex, er, b = ribs.normals[m, 0], ribs.normals[m, 1], ribs.levers[m]
        g = (ex * v[0] + er * v[1] + b * v[2] if ribs.outer[m] else ex * x + er * r + b * turn) - ribs.plays[m]
        if not g > 0.0:
            continue
        root = ribs.laws[m] * math.sqrt(g)
        q, k = root * g, 1.5 * root
        c = laws.damping + laws.damping_time * k
        sums[0], sums[1], sums[2], sums[3], sums[4] = q, q * b, k, k * b, k * b * b
        sums[5], sums[6], sums[7] = c, c * b, c * b * b
        w.rest[0] += sign * q * ex
        w.rest[1] += sign * q * er
        w.rest[2] += sign * q * b
        size += q
    return size


@njit(error_model="numpy", _nrt=False)
def _left(w: RollerWork, length: float) -> float:
    """Size of the force that is left [N]; moments over half of the length of the roller."""
    left: float = max(abs(w.rest[0]), abs(w.rest[1]), abs(w.rest[2]) / length)
    return left


@njit(error_model="numpy", _nrt=False, forceinline=True)
def place_roller(
    d: tuple[float, float, float],
    loads: FloatArray,
    shape: TaperedShape,
    laws: RollerLaws,
    held: FloatArray,
    place: FloatArray,
    w: RollerWork,
    out: FloatArray,
) -> bool:
    """Find the balance of a roller; tell whether it was found.

    Parameters
    ----------
    d : (float, float, float)
        Displacement of the inner ring at the middle of the roller, axial and radial [m], and its rotation [rad].
    loads : array (3,)
        Loads F on the roller: axial, radial [N], moment [N m].
    shape, laws : TaperedShape, RollerLaws
        Lengths, and laws of the contacts.
    held : array (2, MEMORY, n)
        What the slices of cone and cup hold over a step, with films that have a memory.
    place : array (3,)
        V at the beginning, and then where it is; NaN for a start from nothing.
    w : RollerWork
        Work space; stiffness and damping in `plane`.
    out : array (28,)
        Written: forces on the inner ring without their sign, axial, radial [N], moment about the middle of the roller
        [N m]; loads of cone, cup, all ribs of the cone [N]; where along the roller the lines carry, cone and cup [m];
        load of all ribs of the cup [N]; V; D; loads of the ribs; S, by which V follows D. D and S of the last call are
        read.
    """
    length = abs(shape.levers[-1])
    hard = laws.cup + laws.cone
    soft = _SOFT * 0.2 * hard
    # the roller goes with the ring as it did at the last call
    for i in range(3):
        for k in range(3):
            place[i] += out[FIRST_SHARE + 3 * i + k] * (d[k] - out[12 + k])
    size, error = 0.0, math.inf
    if abs(place[0]) + abs(place[1]) + abs(place[2]) < math.inf:
        size = _state(d, place, loads, shape, laws, held, w)
        error = _left(w, length) / (size + _NOTHING)
    if not error < _NEAR:
        for i in range(3):
            # every contact shares the approach in halves: rings that press have rollers that are pressed
            w.trial[i] = 0.5 * d[i]
        size = _state(d, w.trial, loads, shape, laws, held, w)
        if _left(w, length) / (size + _NOTHING) < error:
            put(w.trial, place)
        else:
            size = _state(d, place, loads, shape, laws, held, w)
    found = False
    for _ in range(_STEPS):
        left = _left(w, length)
        found = left <= _ROUGH * size + 10.0 * _NOTHING
        if left <= _BALANCE * size + _NOTHING:
            break
        _matrices(shape, w)
        for i in range(3):
            w.whole[i, i] += soft * (1.0 if i < 2 else length * length)
        _solve(w.whole, w.rest, w.step)
        # no further than makes sense: a roller that nothing holds would go anywhere
        reach = max(abs(w.step[0]), abs(w.step[1]), abs(w.step[2]) * length)
        most = 1e-5 + abs(d[0]) + abs(d[1]) + abs(d[2]) * length
        part = min(1.0, most / reach)
        slope = w.rest[0] * w.step[0] + w.rest[1] * w.step[1] + w.rest[2] * w.step[2]
        low, high = 0.0, math.inf
        for _ in range(_CUTS):
            for i in range(3):
                w.trial[i] = place[i] + part * w.step[i]
            size = _state(d, w.trial, loads, shape, laws, held, w)
            here = w.rest[0] * w.step[0] + w.rest[1] * w.step[1] + w.rest[2] * w.step[2]
            if abs(here) <= _BALANCE * size * reach:
                break
            if here >= -0.5 * slope and (here <= 0.5 * slope or high == math.inf):
                break
            # an idle roller meets its contacts as walls: they are come to from behind, by their stiffness there
            if here < 0.0:
                high = part
                _matrices(shape, w)
                part += here / _along(w.whole, w.step)
            else:
                low = part
            if not low < part < high:
                part = 0.5 * (low + high)
        if part * reach <= 1e-16 * most:
            break
        put(w.trial, place)
    if laws.cup_film.table.shape[0] > 0:
        _film_dampers(laws.cup_film, laws.relaxes, held[1], shape.levers, w.places[1], w.cup)
        _film_dampers(laws.cone_film, laws.relaxes, held[0], shape.levers, w.places[0], w.cone)
    _matrices(shape, w)
    _dampers(shape, w)
    _answer(shape, soft, length, w)
    out[0] = w.cone[0] * shape.cone[0]
    out[1] = w.cone[0] * shape.cone[1]
    out[2] = w.cone[1]
    out[3], out[4], out[5], out[8] = w.cone[0], w.cup[0], 0.0, 0.0
    ribs = shape.ribs
    for m in range(ribs.levers.size):
        q = w.ribs[m, 0]
        out[FIRST_RIB + m] = q
        if ribs.outer[m]:
            out[8] += q
            continue
        out[0] += q * ribs.normals[m, 0]
        out[1] += q * ribs.normals[m, 1]
        out[2] += q * ribs.levers[m]
        out[5] += q
    out[6] = w.cone[1] / w.cone[0] if w.cone[0] > 0.0 else 0.0
    out[7] = w.cup[1] / w.cup[0] if w.cup[0] > 0.0 else 0.0
    put(place, out[9:12])
    out[12], out[13], out[14] = d
    for i in range(3):
        put(w.share[i], out[FIRST_SHARE + 3 * i : FIRST_SHARE + 3 * i + 3])
    return found


@njit(error_model="numpy", _nrt=False)
def _along(m: FloatArray, step: FloatArray) -> float:
    """Stiffness along a step, s' M s [J] of a whole one."""
    total = 0.0
    for i in range(3):
        for k in range(3):
            total += step[i] * m[i, k] * step[k]
    return total


@njit(error_model="numpy", _nrt=False)
def _matrices(shape: TaperedShape, w: RollerWork) -> None:
    """A and M = A + B from the sums of the contacts."""
    w.inner[:] = 0.0
    _add(shape.cone, w.cone, 2, w.inner)
    ribs = shape.ribs
    for m in range(ribs.levers.size):
        if not ribs.outer[m] and w.ribs[m, 0] > 0.0:
            _add((ribs.normals[m, 0], ribs.normals[m, 1]), w.ribs[m], 2, w.inner)
    for i in range(3):
        put(w.inner[i], w.whole[i])
    _add(shape.cup, w.cup, 2, w.whole)
    for m in range(ribs.levers.size):
        if ribs.outer[m] and w.ribs[m, 0] > 0.0:
            _add((ribs.normals[m, 0], ribs.normals[m, 1]), w.ribs[m], 2, w.whole)


@njit(error_model="numpy", _nrt=False)
def _dampers(shape: TaperedShape, w: RollerWork) -> None:
    """A_c and B_c from the sums of the contacts."""
    w.damped_inner[:] = 0.0
    w.damped_outer[:] = 0.0
    _add(shape.cone, w.cone, 5, w.damped_inner)
    _add(shape.cup, w.cup, 5, w.damped_outer)
    ribs = shape.ribs
    for m in range(ribs.levers.size):
        damped = w.damped_outer if ribs.outer[m] else w.damped_inner
        _add((ribs.normals[m, 0], ribs.normals[m, 1]), w.ribs[m], 5, damped)


@njit(error_model="numpy", _nrt=False)
def _answer(shape: TaperedShape, soft: float, length: float, w: RollerWork) -> None:
    """Stiffness and damping of a roller in balance."""
    w.plane[:] = 0.0
    w.share[:] = 0.0
    carried = w.cone[0]
    for m in range(shape.ribs.levers.size):
        carried += 0.0 if shape.ribs.outer[m] else w.ribs[m, 0]
    if carried <= 0.0:
        return
    for i in range(3):
        w.whole[i, i] += soft * (1.0 if i < 2 else length * length)
    for j in range(3):
        for i in range(3):
            w.rest[i] = w.inner[i, j]
        _solve(w.whole, w.rest, w.step)
        for i in range(3):
            w.share[i, j] = w.step[i]
    # A - A M^-1 A = S' B without the difference of nearly equal numbers, B = M - A
    s = w.share
    for j in range(3):
        for m in range(3):
            inner = outer = 0.0
            for n in range(3):
                inner += w.damped_inner[m, n] * ((1.0 if n == j else 0.0) - s[n, j])
                outer += w.damped_outer[m, n] * s[n, j]
            w.rest[m], w.step[m] = inner, outer
        for i in range(3):
            stiffness = damping = 0.0
            for m in range(3):
                stiffness += s[m, i] * (w.whole[m, j] - w.inner[m, j])
                damping += ((1.0 if m == i else 0.0) - s[m, i]) * w.rest[m] + s[m, i] * w.step[m]
            w.plane[0, i, j], w.plane[1, i, j] = stiffness, damping


@njit(error_model="numpy", _nrt=False)
def _on_ring(plane: FloatArray, c: float, s: float, radius: float, matrix: FloatArray) -> None:
    """Add the symmetric matrix (3, 3) of a roller to the upper half of that of the ring (6, 6).

    D = (x - R turn, c y + s z, turn), turn = c theta_z - s theta_y.
    """
    xx, xr, rr = plane[0, 0], 0.5 * (plane[0, 1] + plane[1, 0]), plane[1, 1]
    x_turn = 0.5 * (plane[0, 2] + plane[2, 0]) - radius * xx
    r_turn = 0.5 * (plane[1, 2] + plane[2, 1]) - radius * xr
    turn = plane[2, 2] - radius * (plane[0, 2] + plane[2, 0]) + radius * radius * xx
    matrix[0, 0] += xx
    matrix[0, 1] += c * xr
    matrix[0, 2] += s * xr
    matrix[0, 4] -= s * x_turn
    matrix[0, 5] += c * x_turn
    matrix[1, 1] += c * c * rr
    matrix[1, 2] += c * s * rr
    matrix[1, 4] -= c * s * r_turn
    matrix[1, 5] += c * c * r_turn
    matrix[2, 2] += s * s * rr
    matrix[2, 4] -= s * s * r_turn
    matrix[2, 5] += c * s * r_turn
    matrix[4, 4] += s * s * turn
    matrix[4, 5] -= c * s * turn
    matrix[5, 5] += c * c * turn


@njit(error_model="numpy", _nrt=False)
def tapered_force(
    pose: FloatArray,
    cage_angle: float,
    loads: FloatArray,
    shape: TaperedShape,
    laws: RollerLaws,
    memory: FloatArray,
    force: FloatArray,
    stiffness: FloatArray,
    damping: FloatArray,
    places: FloatArray,
    rollers: FloatArray,
    w: RollerWork,
) -> int:
    """Force on the inner ring at rest, and its derivatives; the number of loaded rollers, or what is wrong.

    Parameters
    ----------
    pose : array (6,)
        Pose of the inner ring in O [m], [rad].
    cage_angle : float
        Angle of the first roller [rad].
    loads : array (3,)
        Loads on each roller: axial, radial [N], moment [N m].
    shape, laws : TaperedShape, RollerLaws
        Lengths, and laws of the contacts.
    memory : array (Z, 2, MEMORY, n)
        Memory of the slices of cone and cup, with films that have one, see `mbs.bearings.tapered.tapered_memory`.
    force, stiffness, damping : array (6,), (6, 6), (6, 6)
        Written: force [N], [N m], and -df/dpose, -df/dvelocity.
    places : array (Z, 3)
        Places of the rollers of the last call, or NaN; written.
    rollers : array (Z, 28)
        What the last call wrote; written: see `place_roller`.
    w : RollerWork
        Work space.
    """
    total = abs(cage_angle)
    for value in pose:
        total += abs(value)
    for value in loads:
        total += abs(value)
    if not total < math.inf:
        return NOT_FINITE
    far, tilt = shape.most_travel, shape.most_tilt
    if not (abs(pose[0]) <= far and abs(pose[1]) <= far and abs(pose[2]) <= far):
        return TOO_FAR
    if not (abs(pose[4]) <= tilt and abs(pose[5]) <= tilt):
        return TOO_FAR
    force[:] = 0.0
    stiffness[:] = 0.0
    damping[:] = 0.0
    size = abs(loads[0]) + abs(loads[1]) + abs(loads[2] / shape.levers[-1])
    part = 0.0 if size < _LIGHT and laws.cup_film.table.shape[0] == 0 else 1.0
    for i in range(3):
        w.loads[i] = part * loads[i]
    turn_c, turn_s = math.cos(cage_angle), math.sin(cage_angle)
    loaded = 0
    radius = shape.pitch_radius
    for j in range(shape.cos.size):
        c, s = turn_c * shape.cos[j] - turn_s * shape.sin[j], turn_s * shape.cos[j] + turn_c * shape.sin[j]
        turn = pose[5] * c - pose[4] * s
        d = (pose[0] - radius * turn, pose[1] * c + pose[2] * s, turn)
        out, found = rollers[j], False
        for _ in range(2):
            found = place_roller(d, w.loads, shape, laws, memory[j if laws.relaxes else 0], places[j], w, out)
            if found:
                break
            places[j, :] = math.nan  # once more, from nothing
        if not found:
            return NO_BALANCE
        if out[3] + out[5] <= 0.0:
            continue
        loaded += 1
        moment = out[2] - radius * out[0]
        force[0] -= out[0]
        force[1] -= c * out[1]
        force[2] -= s * out[1]
        force[4] += s * moment
        force[5] -= c * moment
        _on_ring(w.plane[0], c, s, radius, stiffness)
        _on_ring(w.plane[1], c, s, radius, damping)
    for matrix in (stiffness, damping):
        for a in range(6):
            for b in range(a):
                matrix[a, b] = matrix[b, a]
    return loaded
