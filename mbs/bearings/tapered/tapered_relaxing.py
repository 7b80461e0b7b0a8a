"""Films of tapered rollers that relax: what both lines of each roller add to K and C of slow motion at a frequency.

A roller is at D and V as in `ehdmaps/kernel/c/taper/taper_balance.c`, without mass against small motions. Each slice
has a spring k, and a damper c in series with a spring c/theta, as of cylindrical rollers, see
`mbs.bearings.roller_contacts`. It feels n.V at the cup and n.(D - V) at the cone: a V + b D. With the ends of the
dampers at rest, Xi = a S + b by D, and the diagonal matrices of c and theta, small motions of D see

    Z(s) = K + s C - s^2 Xi' c^(1/2) T (1 + s T)^-1 c^(1/2) Xi,       T = theta + c^(1/2) a M^-1 a' c^(1/2),

where T is the compliance that the dampers feel while the roller is in balance, by the roots of these. Its eigenvalues
are the times of as many springs in series with dampers, which is what `mbs.model.relaxation` takes; T has no difference
of numbers, so that none is negative. K and C are those of the bearing, exactly. Ribs have no dampers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.balls.normal_law import contacts_at
from mbs.bearings.roller_contacts import natural_times, relaxation_times, relaxing
from mbs.bearings.tapered.kernel_structs import FIRST_RIB, FIRST_SHARE
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.model.relaxation import Relaxation

SOFT = 2e-14
"""Stiffness, over the sum of the C of both lines, that holds rollers where nothing does, as in the kernel."""

_LEAST = 1e-9
"""Part of the damping of a bearing below which dampers stay without springs."""


class LineSlices(NamedTuple):
    """Slices of cone and cup of all rollers, n of each line.

    Attributes
    ----------
    felt : array (2 n, 3)
        a of each: what it feels of V.
    ends : array (Z, 2 n, 3)
        Xi of each: its approach by D in slow motion.
    stiffness, damping, times, natural : array (Z, 2 n)
        k [N/m], c [N s/m], theta [s]; natural times [s].
    """

    felt: FloatArray
    ends: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    times: FloatArray
    natural: FloatArray


def line_slices(force: TaperedForce) -> LineSlices:
    """Slices of a force with films at the pose of its last call.

    Parameters
    ----------
    force : TaperedForce
        A force with films.
    """
    rollers, shape, films = force.last_rollers, force.shape, force.films
    share = rollers[:, FIRST_SHARE : FIRST_SHARE + 9].reshape(-1, 3, 3)
    place, ring = rollers[:, 9:12], rollers[:, 12:15]
    parts: list[list[FloatArray]] = [[], [], [], [], [], []]
    for normal, way, moved, law, point in (
        (shape.cone, -1.0, ring - place, films.inner, films.points[0]),
        (shape.cup, 1.0, place, films.outer, films.points[1]),
    ):
        normals = np.stack([np.full_like(shape.levers, e) for e in normal] + [shape.levers], axis=1)
        approach = moved @ normals.T - shape.profile
        _, stiffness, damping = contacts_at(law, approach) / shape.levers.size
        motion = share if way > 0.0 else np.eye(3) - share
        found = (
            way * normals, normals @ motion, stiffness, damping,
            relaxation_times(point, approach), natural_times(point, approach),
        )  # fmt: skip
        for part, one in zip(parts, found, strict=True):
            part.append(np.asarray(one))
    felt, *others = parts
    return LineSlices(np.concatenate(felt), *(np.concatenate(one, axis=1) for one in others))


def line_relaxation(force: TaperedForce, cage_angle: float) -> Relaxation:
    """Relaxation in the pose (6,) of the inner ring; as many springs at any speed, dry lines have none of stiffness.

    Parameters
    ----------
    force : TaperedForce
        The force, at the pose of its last call.
    cage_angle : float
        Angle of the first roller at that call [rad].
    """
    count, lines = force.angles.size, 2 * force.shape.levers.size
    if force.films.dry:
        return Relaxation(np.zeros((count * lines, 6)), np.ones(count * lines))
    slices = line_slices(force)
    relaxes = (slices.damping > 0.0) & (slices.times > 0.0)
    root = np.sqrt(np.where(relaxes, slices.damping, 0.0))
    felt = root[:, :, None] * slices.felt
    compliance = felt @ np.linalg.solve(_balance(force, slices), np.swapaxes(felt, 1, 2))
    compliance[:, np.arange(lines), np.arange(lines)] += np.where(relaxes, slices.times, 1.0)
    times, turns = np.linalg.eigh(0.5 * (compliance + np.swapaxes(compliance, 1, 2)))
    seen = np.swapaxes(turns, 1, 2) @ (root[:, :, None] * slices.ends)
    rows = (seen / np.sqrt(times)[:, :, None] @ by_pose(force, cage_angle)).reshape(-1, 6)
    size = np.array([1.0, 1.0, 1.0 / abs(force.shape.levers[-1])])
    damping = np.sum((seen * size) ** 2, axis=2).ravel()
    keeps = damping > _LEAST * damping.sum()
    longest = float(times.ravel()[keeps].max()) if np.any(keeps) else 1.0
    return Relaxation(np.where(keeps[:, None], rows, 0.0), np.where(keeps, times.ravel(), longest))


def slice_relaxation(force: TaperedForce, cage_angle: float) -> tuple[Relaxation, FloatArray]:
    """Relaxation of the slices one by one as they move in slow motion, and their natural times [s]: of estimates.

    Parameters
    ----------
    force, cage_angle
        The same as of `line_relaxation`; a force with films.
    """
    slices = line_slices(force)
    rows = (slices.ends @ by_pose(force, cage_angle)).reshape(-1, 6)
    return relaxing(rows, slices.damping.ravel(), slices.times.ravel()), slices.natural.ravel()


def _balance(force: TaperedForce, slices: LineSlices) -> FloatArray:
    """M of each roller, (Z, 3, 3)."""
    shape, rollers = force.shape, force.last_rollers
    whole = np.swapaxes(slices.stiffness[:, :, None] * slices.felt, 1, 2) @ slices.felt
    ribs = shape.ribs
    loads = rollers[:, FIRST_RIB : FIRST_RIB + ribs.levers.size]
    normals = np.column_stack([ribs.normals, ribs.levers])
    stiffness = 1.5 * np.cbrt(loads) * np.cbrt(ribs.laws) ** 2
    whole += np.swapaxes(stiffness[:, :, None] * normals, 1, 2) @ normals
    soft = SOFT * (force.laws.cup + force.laws.cone)
    whole += np.diag(soft * np.array([1.0, 1.0, shape.levers[-1] ** 2]))
    return np.asarray(whole)


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
    return found
