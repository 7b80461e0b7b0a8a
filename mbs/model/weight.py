"""Weight of a body: the load on its coordinates where its whole mass is accelerated."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.model.body import Body

_SMALL = 1e-6
"""Part that may be rounding: of a translation of frames, of the stiffness that it strains."""


def load_by_gravity(body: Body) -> FloatArray | None:
    """Load on the coordinates of a body by gravity along x, y, z of 1 m/s2, shape (n, 3) [kg or kg m].

    Parameters
    ----------
    body : Body
        Rigid, a shaft, or of finite elements. A freedom that a body does not have carries its share unseen.

    Returns
    -------
    array or None
        None for a body of finite elements that are held themselves: how its mass is spread over what moves is not in
        its reduced matrices.

    Notes
    -----
    A rigid body says so itself. Of any other, M r is the load, where r are the coordinates of a translation. Static
    shapes of interfaces have that translation exactly, and modes with held interfaces have no part in it.
    """
    if body.gravity is not None:
        return body.gravity
    frames = list(body.frames.values())
    if not frames:
        return np.zeros((body.size, 3))
    seen = np.concatenate([frame.transform for frame in frames])
    wanted = np.zeros((seen.shape[0], 3))
    for place in range(len(frames)):
        wanted[6 * place : 6 * place + 3] = np.eye(3)
    plain = np.array([unit != "1" for unit in body.units])
    translation = np.zeros((body.size, 3))
    free = np.any(seen[:, plain] != 0.0, axis=1)
    translation[plain] = np.linalg.lstsq(seen[np.ix_(free, plain)], wanted[free], rcond=None)[0]
    missed = np.max(np.abs(seen[free] @ translation - wanted[free]), initial=0.0)
    energy = np.einsum("id,ij,jd->d", translation, body.stiffness, translation)
    stiff = np.einsum("id,i,id->d", translation, np.abs(np.diag(body.stiffness)), translation)
    if missed > _SMALL or np.any(energy > _SMALL * stiff):
        return None
    return np.asarray(body.mass @ translation)
