"""Slices and ribs of a bearing of rollers in balance, for small motions: films that relax, and errors of its law.

A roller is at D and V as in `ehdmaps/kernel/c/taper/taper_balance.c`, without mass against small motions. Each slice
has a spring k, and a damper c in series with a spring c/theta, as of cylindrical rollers, see
`mbs.bearings.slices_in_balance`. It feels n.V at the cup and n.(D - V) at the cone. Normals stand still, so that places
change loads alone; ribs stiffen with them, and are dry. A stiffer or more damped slice keeps the stiffness of its
locked film, k_s = k + c/theta, as in `mbs.linearised.bands`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from mbs.bearings.locating.normal_law import STEP, contact_slopes, contacts_at
from mbs.bearings.slices_in_balance import natural_times, relaxation_times
from mbs.bearings.tapered.kernel_structs import FIRST_RIB
from mbs.bearings.tapered.tapered_bearing import TaperedForce, TaperedLoads
from mbs.model.condensed import Condensed
from mbs.model.contacts import Contacts, LawSlopes, Slopes, followed, law_slopes, relaxation
from mbs.model.relaxation import Relaxation

SOFT = 2e-14
"""Stiffness, over the sum of the C of both lines, that holds rollers where nothing does, as in the kernel."""


class _Lines(NamedTuple):
    """Contacts of some rollers, D by the pose (Z, 3, 6), and approaches of cone and cup (Z, 2, n) [m]."""

    contacts: Contacts
    pose: FloatArray
    approaches: FloatArray


def line_relaxation(force: TaperedForce, rollers: TaperedLoads, conditions: dict[str, Any]) -> Relaxation:
    """Relaxation in the pose (6,) of the inner ring; as many springs at any speed, dry lines have none of stiffness.

    Parameters
    ----------
    force : TaperedForce
        The force, at the pose of its last call.
    rollers : TaperedLoads
        What that call found; of no effect.
    conditions : dict
        Angle of the cage at that call, and speeds.
    """
    lines = _lines(force, conditions["cage_angle"], np.ones(force.angles.size, dtype=np.bool_))
    return relaxation(lines.contacts, lines.pose, 2 * force.shape.levers.size)


def rollers_in_balance(
    force: TaperedForce, rollers: TaperedLoads, conditions: dict[str, Any], relaxes: bool
) -> Condensed | None:
    """Condense the rollers of a bearing; None without films, or without a load.

    Parameters
    ----------
    force, rollers, conditions
        The same as of `line_relaxation`.
    relaxes : bool
        Whether films have a memory.
    """
    rows = force.last_rows
    on = rows[:, 3] + rows[:, 5] > 0.0
    if force.films.dry or not np.any(on):
        return None
    lines = _lines(force, conditions["cage_angle"], on)
    found = [natural_times(point, lines.approaches[:, side]) for side, point in enumerate(force.films.points)]
    natural, slices = np.zeros_like(lines.contacts.stiffness), 2 * lines.approaches.shape[2]
    natural[:, :slices] = np.concatenate(found, axis=1)
    slopes = _slopes(force, lines, rows[on, FIRST_RIB : FIRST_RIB + natural.shape[1] - slices], relaxes)
    return Condensed(lines.contacts, lines.pose, relaxes, slopes, natural, which=np.flatnonzero(on), raceways=slices)


def by_pose(force: TaperedForce, cage_angle: float) -> FloatArray:
    """D of each roller by the pose of the inner ring, shape (Z, 3, 6).

    Parameters
    ----------
    force : TaperedForce
        The bearing.
    cage_angle : float
        Angle of the first roller [rad].
    """
    angle = force.angles + cage_angle
    c, s = np.cos(angle), np.sin(angle)
    found = np.zeros((angle.size, 3, 6))
    found[:, 2, 4], found[:, 2, 5] = -s, c
    found[:, 0, 0], found[:, 1, 1], found[:, 1, 2] = 1.0, c, s
    found[:, 0] -= force.shape.pitch_radius * found[:, 2]
    places = np.repeat(force.shape.rows, angle.size // len(force.shape.rows))
    found[:, 1] += places[:, None] * found[:, 2]
    return found


def _lines(force: TaperedForce, cage_angle: float, on: BoolArray) -> _Lines:
    """Slices of cone and cup, then ribs, of rollers that are on; dry lines have neither stiffness nor dampers."""
    shape, films, ribs, rows = force.shape, force.films, force.shape.ribs, force.last_rows[on]
    count, n = rows.shape[0], shape.levers.size
    feel, turning = np.zeros((count, 2 * n + ribs.levers.size, 6)), np.zeros((count, 6, 6))
    k, c, times = np.zeros((3, *feel.shape[:2]))
    approaches = np.zeros((count, 2, n))
    for side, (normal, moved, law) in enumerate(
        ((shape.cone, rows[:, 12:15] - rows[:, 9:12], films.inner), (shape.cup, rows[:, 9:12], films.outer))
    ):
        at = slice(side * n, (side + 1) * n)
        normals = np.stack([np.full(n, normal[0]), np.full(n, normal[1]), shape.levers], axis=1)
        feel[:, at, :3], feel[:, at, 3:] = (normals, -normals) if side == 0 else (0.0, normals)
        approaches[:, side] = moved @ normals.T - shape.profile
        if not films.dry:
            _, k[:, at], c[:, at] = contacts_at(law, approaches[:, side]) / n
            times[:, at] = relaxation_times(films.points[side], approaches[:, side])
    normals, outer = np.column_stack([ribs.normals, ribs.levers]), ribs.outer[:, None]
    feel[:, 2 * n :, :3], feel[:, 2 * n :, 3:] = np.where(outer, 0.0, normals), np.where(outer, normals, -normals)
    k[:, 2 * n :] = 1.5 * np.cbrt(rows[:, FIRST_RIB : FIRST_RIB + ribs.levers.size]) * np.cbrt(ribs.laws) ** 2
    soft = 2.0 * SOFT * force.dry_law.inner.coefficient
    turning[:, 3:, 3:] = np.diag(soft * np.array([1.0, 1.0, shape.levers[-1] ** 2]))
    contacts = Contacts(feel, turning, k, c, np.ones((*k.shape, 1)), times[..., None])
    return _Lines(contacts, by_pose(force, cage_angle)[on], approaches)


def _slopes(force: TaperedForce, lines: _Lines, ribs: FloatArray, relaxes: bool) -> Slopes | None:
    """Derivatives of lines, and of ribs by their loads; None where the law states no errors."""
    films, k = force.films, lines.contacts.stiffness
    n = lines.approaches.shape[2]
    k_rise, c_rise, times_rise, by_stiffness, by_damping, thicker = np.zeros((6, *k.shape))
    for side, (law, point) in enumerate(zip((films.inner, films.outer), films.points, strict=True)):
        at, approach = slice(side * n, (side + 1) * n), lines.approaches[:, side]
        bounds = point.bounds((contacts_at(law, approach)[0] / force.geometry.roller_length).ravel())
        if bounds is None:
            return None
        k_rise[:, at], c_rise[:, at] = contact_slopes(law, approach)[1:] / n
        if relaxes:
            ahead, behind = (relaxation_times(point, approach + step) for step in (STEP, -STEP))
            times_rise[:, at] = (ahead - behind) / (2.0 * STEP)
        by_stiffness[:, at], by_damping[:, at], thicker[:, at] = (
            part.reshape(approach.shape) for part in (bounds.stiffness, bounds.damping, bounds.film_offset)
        )
    k_rise[:, 2 * n :] = np.where(ribs > 0.0, k[:, 2 * n :] ** 2 / (3.0 * np.where(ribs > 0.0, ribs, 1.0)), 0.0)
    no_shares = np.zeros((*k.shape, 1))
    law_nearby = LawSlopes(k_rise, c_rise, no_shares, times_rise[..., None], by_stiffness, by_damping, thicker)
    return law_slopes(lines.contacts, followed(lines.contacts, lines.pose, thicker), law_nearby, locked=True)
