"""A ball bearing in balance with the errors that the film table states: what they, and its pose, change.

The films of both contacts of each ball may have another stiffness or damping at their load, or be thicker, by what the
table states. At a held pose a thicker film moves the ball, its loads and its contact angles, and with these the speed
of the ball, its centrifugal load and gyroscopic moment: all of it follows, to first order. Springs and dampers
of films with memory keep their times and their parts of c.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.bearings.balls.ball_bearing import BallForce, BallLoads
from mbs.bearings.balls.ball_speed import Drive, speed_slopes
from mbs.bearings.balls.contact_slopes import contact_slopes
from mbs.bearings.balls.normal_law import contacts_at
from mbs.model.condensed import DIRECTIONS, Condensed, Contacts, none_moved

_SMALL = 1e-20
"""Imaginary step by which closed forms are differentiated: exact to round-off."""

_PART = 1e-5
"""Step of loads, angles and speeds, as a part of them or in radians, by which smooth functions are differentiated."""

_LEAST = 1e-9
"""Load of the inner contact, over the highest, below which a ball is left out."""

_FILM = 6


class _Places(NamedTuple):
    """Vectors from groove centres to contacts (..., Z, 2, 2), loads (..., Z, 2): derivatives likewise."""

    arms: FloatArray
    loads: FloatArray


def ball_errors(force: BallForce, balls: BallLoads, conditions: dict[str, Any], *, relaxes: bool) -> Condensed | None:
    """Condense the balls of a bearing; None without stated errors, or without a load.

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
    law, shape, rows = force.law, force.shape, force.last_balls
    on = rows[:, 10] > _LEAST * rows[:, 10].max()
    if not law.responses or not np.any(on):
        return None
    rows = rows[on]
    drive = force.drive_at(**conditions)
    approach, loads = rows[:, 14:16], rows[:, 10:12]
    along = rows[:, 16:20].reshape(-1, 2, 2)
    arms = (np.array([shape.inner_arm, shape.outer_arm]) + approach)[..., None] * along
    at = _Places(arms, loads)
    sides = (law.inner, law.outer)
    _, k, c = _both([contacts_at(one, approach[:, i]) for i, one in enumerate(sides)])
    _, k_rise, c_rise = _both([contact_slopes(one, approach[:, i]) for i, one in enumerate(sides)])
    springs = [one.springs(loads[:, i]) for i, one in enumerate(law.responses)]
    nearby = [
        [one.springs(loads[:, i] * (1.0 + sign * _PART)) for i, one in enumerate(law.responses)] for sign in (1, -1)
    ]
    shares, times = (np.stack([getattr(one, name) for one in springs], axis=1) for name in ("shares", "times"))
    by_load = [
        np.stack([getattr(a, name) - getattr(b, name) for a, b in zip(*nearby, strict=True)], axis=1)
        / (2.0 * _PART * loads)[..., None]
        for name in ("shares", "times")
    ]
    feel, turning = _geometry(at, drive)
    contacts = Contacts(feel, turning, k, c, shares, times)
    pose = _by_pose(shape.arm, balls.angle[on])
    bounds = [one.bounds(loads[:, i]) for i, one in enumerate(law.responses)]
    stiffness_bound, damping_bound, films = (np.stack([one[i] for one in bounds], axis=1) for i in range(3))

    # six directions of the pose, thicker films: places and loads follow
    directions = _FILM + 1
    own = np.swapaxes(feel, 1, 2) @ (k[..., None] * feel) + turning
    ring = np.zeros((directions, on.sum(), 2))
    ring[:6] = np.moveaxis(pose, 2, 0)
    thicker = np.zeros((directions, *loads.shape))
    thicker[_FILM] = films
    pushed = -(own[:, 2:, :2] @ ring[..., None])[..., 0]
    pushed -= (np.swapaxes(feel[:, :, 2:], 1, 2) @ (k * thicker)[..., None])[..., 0]
    moved = np.linalg.solve(own[:, 2:, 2:], pushed[..., None])[..., 0]
    vectors = np.stack([ring - moved, moved], axis=2)
    closer = np.sum(along * vectors, axis=-1) + thicker
    heavier = k * closer
    by = _Places(vectors, heavier)
    step_feel, step_turning = _geometry(_Places(arms + 1j * _SMALL * by.arms, loads + 1j * _SMALL * by.loads), drive)
    found = Contacts(
        step_feel.imag / _SMALL,
        step_turning.imag / _SMALL,
        k_rise * closer,
        c_rise * closer,
        by_load[0] * heavier[..., None],
        by_load[1] * heavier[..., None],
    )
    lengths = np.linalg.norm(arms, axis=-1)
    turned = (vectors - along * np.sum(along * vectors, axis=-1)[..., None]) / lengths[..., None]
    on_ball = heavier[:, :, 0, None] * along[:, 0] + loads[:, 0, None] * turned[:, :, 0]
    forces = -np.einsum("zmi,qzm->qi", pose, on_ball)
    slopes = none_moved(contacts, len(DIRECTIONS))
    for part, value in zip(slopes, found, strict=True):
        part[:6], part[8] = value[:6], value[6]
    slopes.stiffness[6], slopes.damping[7] = stiffness_bound * k, damping_bound * c
    on_ring = np.zeros((len(DIRECTIONS), 6))
    on_ring[:6], on_ring[8] = forces[:6], forces[6]

    def left_out(s: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        sides = [one.left_out(loads[:, i], s) for i, one in enumerate(law.responses)]
        return np.stack([part for part, _ in sides], axis=2), np.stack([doubt for _, doubt in sides], axis=2)

    return Condensed(contacts, slopes, pose, on_ring, relaxes, left_out=left_out)


def _both(sides: list[FloatArray]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Numbers (3, Z) of both sides as three arrays (Z, 2)."""
    first, second, third = np.stack(sides, axis=-1)
    return first, second, third


def _by_pose(arm: float, angle: FloatArray) -> FloatArray:
    """D of each ball by the pose, (Z, 2, 6)."""
    c, s = np.cos(angle), np.sin(angle)
    found = np.zeros((angle.size, 2, 6))
    found[:, 0, 0], found[:, 0, 4], found[:, 0, 5] = 1.0, arm * s, -arm * c
    found[:, 1, 1], found[:, 1, 2] = c, s
    return found


def _geometry(at: _Places, drive: Drive) -> tuple[Any, Any]:
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
    by_d, by_v = speed_slopes(along, length, drive)
    first, second = turns[..., 0, :, :], turns[..., 1, :, :]
    top = np.concatenate([first, -first], axis=-1)
    bottom = np.concatenate([-first - by_d, first + second - by_v], axis=-1)
    return feel, np.concatenate([top, bottom], axis=-2)
