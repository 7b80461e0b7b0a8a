"""A bearing of rollers in balance with the errors that its law of lines states: what they, and its pose, change.

Slices of both lines of each roller may have another stiffness or damping at their load, or thicker films, by what the
law states. Normals stand still, so that places change loads alone; ribs stiffen with them, and are dry. A stiffer or
more damped slice keeps the stiffness of its locked film, k_s = k + c/theta, as in `mbs.linearised.bands`.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.balls.contact_slopes import STEP, contact_slopes
from mbs.bearings.balls.normal_law import contacts_at
from mbs.bearings.roller_contacts import natural_times, relaxation_times
from mbs.bearings.tapered.kernel_structs import FIRST_RIB
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_relaxing import SOFT, by_pose
from mbs.model.condensed import DIRECTIONS, Condensed, Contacts, none_moved

_FILM = 8


def roller_errors(force: TaperedForce, cage_angle: float, *, relaxes: bool) -> Condensed | None:
    """Condense the rollers of a bearing; None without stated errors, or without a load.

    Parameters
    ----------
    force : TaperedForce
        The force with the films of a speed, at the pose of its last call.
    cage_angle : float
        Angle of the first roller at that call [rad].
    relaxes : bool
        Whether films have a memory.
    """
    shape, films, rows = force.shape, force.films, force.last_rollers
    on = rows[:, 3] + rows[:, 5] > 0.0
    if films.dry or not np.any(on):
        return None
    rows, place, ring = rows[on], rows[on, 9:12], rows[on, 12:15]
    count, slices = rows.shape[0], shape.levers.size
    ribs, pose = shape.ribs, by_pose(force, cage_angle)[on]
    lines = 2 * slices
    feel = np.zeros((count, lines + ribs.levers.size, 6))
    k, c, times, natural, k_rise, c_rise, times_rise, by_stiffness, by_damping, thicker = np.zeros(
        (10, *feel.shape[:2])
    )
    for side, (normal, moved, law, point) in enumerate(
        ((shape.cone, ring - place, films.inner, films.points[0]), (shape.cup, place, films.outer, films.points[1]))
    ):
        at = slice(side * slices, (side + 1) * slices)
        normals = np.stack([np.full(slices, normal[0]), np.full(slices, normal[1]), shape.levers], axis=1)
        if side == 0:
            feel[:, at, :3], feel[:, at, 3:] = normals, -normals
        else:
            feel[:, at, 3:] = normals
        approach = moved @ normals.T - shape.profile
        load, k[:, at], c[:, at] = contacts_at(law, approach) / slices
        k_rise[:, at], c_rise[:, at] = contact_slopes(law, approach)[1:] / slices
        bounds = point.bounds((load / (force.geometry.roller_length / slices)).ravel())
        if bounds is None:
            return None
        if relaxes:
            times[:, at] = relaxation_times(point, approach)
            ahead, behind = (relaxation_times(point, approach + step) for step in (STEP, -STEP))
            times_rise[:, at] = (ahead - behind) / (2.0 * STEP)
            natural[:, at] = natural_times(point, approach)
        by_stiffness[:, at], by_damping[:, at], thicker[:, at] = (
            part.reshape(approach.shape) for part in (bounds.stiffness, bounds.damping, bounds.film_offset)
        )
    normals = np.column_stack([ribs.normals, ribs.levers])
    feel[:, lines:, :3] = np.where(ribs.outer[:, None], 0.0, normals)
    feel[:, lines:, 3:] = np.where(ribs.outer[:, None], normals, -normals)
    loads = rows[:, FIRST_RIB : FIRST_RIB + ribs.levers.size]
    k[:, lines:] = 1.5 * np.cbrt(loads) * np.cbrt(ribs.laws) ** 2
    pressed = np.where(loads > 0.0, loads, 1.0)
    k_rise[:, lines:] = np.where(loads > 0.0, k[:, lines:] ** 2 / (3.0 * pressed), 0.0)
    soft = SOFT * (force.laws.cup + force.laws.cone) * np.array([1.0, 1.0, shape.levers[-1] ** 2])
    turning = np.zeros((count, 6, 6))
    turning[:, 3:, 3:] = np.diag(soft)
    contacts = Contacts(feel, turning, k, c, np.ones((*k.shape, 1)), times[..., None])

    slopes = none_moved(contacts, len(DIRECTIONS))
    moved, forces = _in_balance(contacts, pose, thicker)
    slopes.stiffness[:], slopes.damping[:], slopes.times[..., 0] = k_rise * moved, c_rise * moved, times_rise * moved
    slopes.stiffness[6], slopes.damping[7] = by_stiffness * k, by_damping * c
    slopes.times[6, ..., 0] = np.where(c > 0.0, times**2 * slopes.stiffness[6] / np.where(c > 0.0, c, 1.0), 0.0)
    slopes.times[7, ..., 0] = by_damping * times
    return Condensed(contacts, slopes, pose, forces, relaxes, natural)


def _in_balance(contacts: Contacts, pose: FloatArray, thicker: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Changes of approaches (9, Z, J), and of the force on the ring (9, 6), by the pose and by films thicker once."""
    feel, k = contacts.feel, contacts.stiffness
    own = np.swapaxes(feel, 1, 2) @ (k[..., None] * feel) + contacts.turning
    ring, film = np.zeros((len(DIRECTIONS), pose.shape[0], 3)), np.zeros((len(DIRECTIONS), *k.shape))
    ring[:6], film[_FILM] = np.moveaxis(pose, 2, 0), thicker
    pushed = (own[:, 3:, :3] @ ring[..., None])[..., 0]
    pushed += (np.swapaxes(feel[:, :, 3:], 1, 2) @ (k * film)[..., None])[..., 0]
    moved = np.concatenate([ring, -np.linalg.solve(own[:, 3:, 3:], pushed[..., None])[..., 0]], axis=-1)
    closer = (feel @ moved[..., None])[..., 0] + film
    on_roller = (np.swapaxes(feel[:, :, :3], 1, 2) @ (k * closer)[..., None])[..., 0]
    return closer, -np.einsum("zmi,qzm->qi", pose, on_roller)
