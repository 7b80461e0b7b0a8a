"""Load, stiffness and damping of many contacts of one law, and their derivatives by the approach."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from mbs.bearings.balls.normal_law import NormalLaw, contact

STEP = 1e-10
"""Step of the approach, either way, by which laws are differentiated [m]."""


@njit(error_model="numpy")
def _fill(law: NormalLaw, approaches: FloatArray, out: FloatArray) -> None:
    """Write load, stiffness and damping of contacts (n, 3)."""
    for i in range(approaches.size):
        out[i, 0], out[i, 1], out[i, 2] = contact(law, approaches[i])


def contacts_at(law: NormalLaw, approach: FloatArray) -> FloatArray:
    """Load [N], stiffness [N/m] and damping [N s/m] of contacts, shape (3, ...).

    Parameters
    ----------
    law : NormalLaw
        Their law.
    approach : array (...)
        Approaches [m].
    """
    found = np.zeros((approach.size, 3))
    _fill(law, np.ascontiguousarray(approach, dtype=np.float64).reshape(-1), found)
    return np.ascontiguousarray(found.T).reshape(3, *approach.shape)


def contact_slopes(law: NormalLaw, approach: FloatArray) -> FloatArray:
    """Derivatives of the same by the approach, shape (3, ...); parameters as of `contacts_at`."""
    return np.asarray((contacts_at(law, approach + STEP) - contacts_at(law, approach - STEP)) / (2.0 * STEP))
