"""Modal damping of a flexible body."""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import eigh

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError


def modal_damping(mass: FloatArray, stiffness: FloatArray, ratio: float) -> FloatArray:
    """Damping matrix that gives every mode of M q'' + K q = 0 the same damping ratio.

    D = M Phi diag(2 zeta omega) Phi' M with the mass-normalised modes Phi. Rigid-body modes are not damped, so a free
    body moves without loss.

    Parameters
    ----------
    mass, stiffness : array, shape (n, n)
        Symmetric matrices; M positive definite, K positive semi-definite.
    ratio : float
        zeta, 0 <= zeta < 1.

    Returns
    -------
    array, shape (n, n)
        Symmetric, positive semi-definite.

    Raises
    ------
    InputError
        For another ratio, or where M is not positive definite.
    """
    if not (math.isfinite(ratio) and 0.0 <= ratio < 1.0):
        raise InputError(f"damping ratio: got {ratio!r}; allowed: 0 <= ratio < 1; steel structures have 0.001 to 0.02")
    if ratio == 0.0:
        return np.zeros_like(mass)
    try:
        squares, shapes = eigh(stiffness, mass)
    except (np.linalg.LinAlgError, ValueError) as error:
        raise InputError(
            f"modal damping: the modes cannot be computed ({error}); allowed: finite matrices, the mass positive "
            "definite"
        ) from error
    # The square of a rigid-body frequency is round-off of the highest one.
    noise = 1e3 * mass.shape[0] * np.finfo(np.float64).eps * abs(squares[-1])
    omega = np.sqrt(np.where(squares > noise, squares, 0.0))
    momentum = mass @ shapes
    damping = (momentum * (2.0 * ratio * omega)) @ momentum.T
    return np.asarray(0.5 * (damping + damping.T), dtype=np.float64)
