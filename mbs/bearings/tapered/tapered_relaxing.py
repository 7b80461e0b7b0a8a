"""Relaxation that films of tapered rollers would have: an estimate of what films of slow motion leave out.

Each slice of a line is a damper in series with a spring, as of cylindrical rollers, and moves as it does in slow
motion, where rollers go with the ring by S of `mbs.bearings.tapered.tapered_kernel`.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.balls.normal_law import contact
from mbs.bearings.roller_contacts import natural_times, relaxation_times, relaxing
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_kernel import FIRST_SHARE
from mbs.model.relaxation import Relaxation


def line_relaxation(force: TaperedForce, cage_angle: float) -> tuple[Relaxation, FloatArray]:
    """Relaxation of all slices of cone and cup in the pose (6,), and natural times of these contacts [s].

    Parameters
    ----------
    force : TaperedForce
        A force with films, at the pose of its last call.
    cage_angle : float
        Angle of the first roller at that call [rad].
    """
    rollers, shape, angle = force.last_rollers, force.shape, force.angles + cage_angle
    c, s = np.cos(angle), np.sin(angle)
    # D by the pose, (Z, 3, 6)
    by_pose = np.zeros((angle.size, 3, 6))
    by_pose[:, 2, 4], by_pose[:, 2, 5] = -s, c
    by_pose[:, 0, 0], by_pose[:, 1, 1], by_pose[:, 1, 2] = 1.0, c, s
    by_pose[:, 0] -= shape.pitch_radius * by_pose[:, 2]
    share = rollers[:, FIRST_SHARE : FIRST_SHARE + 9].reshape(-1, 3, 3)
    place, ring = rollers[:, 9:12], rollers[:, 12:15]
    rows, damping, times, natural = [], [], [], []
    for normal, moved, motion, law, point in (
        (shape.cone, ring - place, np.eye(3) - share, force.films.inner, force.films.points[0]),
        (shape.cup, place, share, force.films.outer, force.films.points[1]),
    ):
        normals = np.stack([np.full_like(shape.levers, e) for e in normal] + [shape.levers], axis=1)
        approach = moved @ normals.T - shape.profile
        rows.append(np.einsum("na,zab,zbp->znp", normals, motion, by_pose).reshape(-1, 6))
        damping.append(np.array([contact(law, g)[2] for g in approach.ravel().tolist()]) / shape.levers.size)
        times.append(relaxation_times(point, approach).ravel())
        natural.append(natural_times(point, approach).ravel())
    return relaxing(*(np.concatenate(parts) for parts in (rows, damping, times))), np.concatenate(natural)
