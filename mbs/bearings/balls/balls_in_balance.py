"""Both contacts of each ball of a bearing in balance, for small motions: films that relax, errors of the film table.

A ball is at D and V as in `ehdmaps/kernel/c/ball/ball_balance.c`, without mass against small motions. Its contacts have
springs k, dampers in series with springs along their directions, and the stiffness Q/l by which loads turn; speed, by
centrifugal load and traction, turns them without symmetry. Films may have another stiffness or damping at their load,
or be thicker, by what the table states. At a held pose a thicker film moves the ball, its loads and its contact angles,
and with these the speed of the ball, its centrifugal load and gyroscopic moment: all of it follows, to first order.
Springs and dampers of films with memory keep their times and their parts of c.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.bearings.balls.ball_bearing import BallForce, BallLoads
from mbs.bearings.balls.ball_data import BallShape
from mbs.bearings.balls.ball_speed import Drive, speed_slopes
from mbs.bearings.balls.laws import BallLaw
from mbs.bearings.balls.response import TIMES
from mbs.bearings.locating.normal_law import contact_slopes, contacts_at
from mbs.model.condensed import Condensed
from mbs.model.contacts import Contacts, LawSlopes, film_directions, followed, law_slopes, relaxation
from mbs.model.relaxation import Relaxation

_SMALL = 1e-20
"""Imaginary step by which closed forms are differentiated: exact to round-off."""

_PART = 1e-5
"""Step of loads, as a part of them, by which smooth functions are differentiated."""

_LEAST = 1e-9
"""Load of the inner contact, over the highest, below which errors of a law leave a ball out."""


class _Places(NamedTuple):
    """Vectors from groove centres to contacts (..., Z, 2, 2), loads (..., Z, 2): derivatives likewise."""

    arms: FloatArray
    loads: FloatArray


def ball_relaxation(force: BallForce, balls: BallLoads, conditions: dict[str, Any]) -> Relaxation:
    """Relaxation of a bearing in the pose (6,) of its inner ring.

    There are as many springs at any speed and pose; some have no stiffness, and none has of a law without responses.

    Parameters
    ----------
    force : BallForce
        The force with the films of a speed, at the pose of its last call.
    balls : BallLoads
        What that call found.
    conditions : dict
        Angle of the cage and speeds at that call.
    """
    law, shape, found = force.law, force.shape, force.last_rows
    rows, times = np.zeros((balls.angle.size, 2 * TIMES.size, 6)), np.ones((balls.angle.size, 2 * TIMES.size))
    on = found[:, 10] > 0.0  # others do nothing
    if law.responses and np.any(on):
        contacts, _ = _contacts(law, shape, found[on], force.drive_of(found[on], conditions))
        made = relaxation(contacts, force.by_pose(balls.angle)[on])
        rows[on], times[on] = made.rows.reshape(rows[on].shape), made.times.reshape(times[on].shape)
    return Relaxation(rows.reshape(-1, 6), times.reshape(-1))


def balls_in_balance(force: BallForce, balls: BallLoads, conditions: dict[str, Any], relaxes: bool) -> Condensed | None:
    """Condense the balls of a bearing; None without films, or without a load.

    Parameters
    ----------
    force : BallForce
        The force with the films of a speed, at the pose of its last call.
    balls : BallLoads
        What that call found.
    conditions : dict
        Angle of the cage and speeds at that call.
    relaxes : bool
        Whether films have a memory.
    """
    law, shape, rows = force.law, force.shape, force.last_rows
    on = rows[:, 10] > _LEAST * rows[:, 10].max()
    if not law.responses or not np.any(on):
        return None
    rows = rows[on]
    drive = force.drive_of(rows, conditions)
    contacts, at = _contacts(law, shape, rows, drive)
    pose, slopes_of_law = force.by_pose(balls.angle)[on], _law_slopes(law, rows, contacts.stiffness)
    moved = followed(contacts, pose, slopes_of_law.thicker)
    slopes = law_slopes(contacts, moved, slopes_of_law, locked=False)
    arms = np.stack([moved.motion[..., :2] - moved.motion[..., 2:], moved.motion[..., 2:]], axis=2)
    by = _Places(arms, contacts.stiffness * moved.approach)
    stepped = _geometry(
        _Places(*(one + 1j * _SMALL * more for one, more in zip(at, by, strict=True))), drive, contacts.stiffness
    )
    where = film_directions(pose.shape[2])
    slopes.contacts.feel[where], slopes.contacts.turning[where] = (part.imag / _SMALL for part in stepped)

    def left_out(s: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        sides = [one.left_out(at.loads[:, i], s) for i, one in enumerate(law.responses)]
        return np.stack([part for part, _ in sides], axis=2), np.stack([doubt for _, doubt in sides], axis=2)

    which = np.flatnonzero(on)
    return Condensed(contacts, pose, relaxes, slopes, left_out=left_out, held_by="film table", which=which)


def _contacts(law: BallLaw, shape: BallShape, rows: FloatArray, drive: Drive) -> tuple[Contacts, _Places]:
    """Contacts of balls by their rows, and their places; of a law with responses."""
    loads, along = rows[:, 10:12], rows[:, 16:20].reshape(-1, 2, 2)
    at = _Places((np.array([shape.inner_arm, shape.outer_arm]) + rows[:, 14:16])[..., None] * along, loads)
    _, k, c = _both([contacts_at(one, rows[:, 14 + i]) for i, one in enumerate((law.inner, law.outer))])
    springs = [one.springs(loads[:, i]) for i, one in enumerate(law.responses)]
    shares, times = (np.stack([getattr(one, name) for one in springs], axis=1) for name in ("shares", "times"))
    return Contacts(*_geometry(at, drive, k), k, c, shares, times), at


def _law_slopes(law: BallLaw, rows: FloatArray, stiffness: FloatArray) -> LawSlopes:
    """Law nearby, by rows of balls and the stiffness (Z, 2) of their contacts; springs go with the load."""
    loads = rows[:, 10:12]
    _, k_rise, c_rise = _both([contact_slopes(one, rows[:, 14 + i]) for i, one in enumerate((law.inner, law.outer))])
    nearby = [
        [one.springs(loads[:, i] * (1.0 + sign * _PART)) for i, one in enumerate(law.responses)] for sign in (1, -1)
    ]
    shares_rise, times_rise = (
        np.stack([getattr(a, name) - getattr(b, name) for a, b in zip(*nearby, strict=True)], axis=1)
        * (stiffness / (2.0 * _PART * loads))[..., None]
        for name in ("shares", "times")
    )
    bounds = np.stack([one.bounds(loads[:, i]) for i, one in enumerate(law.responses)], axis=-1)
    return LawSlopes(k_rise, c_rise, shares_rise, times_rise, *bounds)


def _both(sides: list[FloatArray]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Numbers (3, Z) of both sides as three arrays (Z, 2)."""
    first, second, third = np.stack(sides, axis=-1)
    return first, second, third


def _geometry(at: _Places, drive: Drive, stiffness: FloatArray) -> tuple[Any, Any]:
    """Vectors h of contacts, (..., Z, 2, 4), and stiffness by which loads turn, (..., Z, 4, 4); of complex ones, too.

    The inner contact stands on D - V, the outer one on V.
    """
    length = np.sqrt(np.sum(at.arms**2, axis=-1))
    along = at.arms / length[..., None]
    inner, outer = along[..., 0, :], along[..., 1, :]
    feel = np.stack(
        [np.concatenate([inner, -inner], axis=-1), np.concatenate([np.zeros_like(outer), outer], axis=-1)], axis=-2
    )
    across = np.eye(2) - along[..., :, None] * along[..., None, :]
    turns = (at.loads / length)[..., None, None] * across
    by_d, by_v, inner_d, inner_v = speed_slopes(along, length, drive, at.loads, stiffness)
    first, second = turns[..., 0, :, :], turns[..., 1, :, :]
    top = np.concatenate([first + inner_d, inner_v - first], axis=-1)
    bottom = np.concatenate([-first - by_d, first + second - by_v], axis=-1)
    return feel, np.concatenate([top, bottom], axis=-2)
