"""Motion and matrices of the inner ring of a bearing from those of the ports of its element.

Ports of a bearing are the displacement of its inner ring against the outer one, (6,), or both rings and the radial
places of Z rollers that are bodies, (12 + Z,).
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray


def ring_matrices(stiffness: FloatArray, damping: FloatArray) -> tuple[FloatArray, FloatArray]:
    """K and C (6, 6) of the inner ring against the outer one from those of an element in its ports.

    Rollers that are bodies follow in equilibrium; those without load are left where they are.

    Parameters
    ----------
    stiffness, damping : array, shape (6, 6) or (12 + Z, 12 + Z)
        Matrices of massless rollers, or of rings and rollers.
    """
    following = ring_following(stiffness)
    return following.T @ stiffness @ following, following.T @ damping @ following


def ring_following(stiffness: FloatArray) -> FloatArray:
    """Motion by which the ports of an element follow the inner ring, the outer one being held, shape (m, 6).

    Parameters
    ----------
    stiffness : array, shape (6, 6) or (12 + Z, 12 + Z)
        Matrix of massless rollers, or of rings and rollers.
    """
    if stiffness.shape[0] == 6:
        return np.eye(6)
    own = stiffness[12:, 12:]
    following = np.zeros((stiffness.shape[0], 6))
    following[:6] = np.eye(6)
    loaded = np.nonzero(np.diag(own) > 0.0)[0]
    following[12 + loaded] = -np.linalg.solve(own[np.ix_(loaded, loaded)], stiffness[12 + loaded, :6])
    return following


def ring_motion(ports: FloatArray) -> FloatArray:
    """Displacement of an inner ring against the outer one from that of the ports of its element, shape (..., 6).

    Parameters
    ----------
    ports : array, shape (..., 6) or (..., 12 + Z)
        Displacements of the ports [m or rad]; rollers that are bodies have both rings in theirs.
    """
    return ports if ports.shape[-1] == 6 else ports[..., :6] - ports[..., 6:12]
