"""Bearings of a system as results ask for them: motion and matrices of inner rings, errors of their laws in words.

Ports of a bearing are the displacement of its inner ring against the outer one, (6,), or both rings and the radial
places of Z rollers that are bodies, (12 + Z,).
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.model.elements import OnRings
from mbs.model.system import System

NO_MAP = "none stated: the law is not that of a map or a film table"
"""What is said where laws state no errors."""


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


def error_words(system: System, film_share: float = 0.0) -> str:
    """Name the errors in the bands of a system, for people, the largest first; empty without bearings.

    Parameters
    ----------
    system : System
        The system.
    film_share : float
        Part of the bands that is what films with memory leave out; 0 if that is not in them.
    """
    bearings = [entry.element for entry in system.elements if isinstance(entry.element, OnRings)]
    if not bearings:
        return ""
    words = {element.error_words for element in bearings}
    if "" in words:
        return NO_MAP
    stated = "; ".join(sorted(words))
    if film_share == 0.0:
        return f"{stated}; how films relax is not in it"
    memories = {element.memory_words for element in bearings}
    memory = memories.pop() if len(memories) == 1 else OnRings.memory_words
    films = f"what {memory} out ({100.0 * film_share:.2g} % of the median band)"
    return f"{films}, then {stated}" if film_share > 0.5 else f"{stated}; then {films}"
