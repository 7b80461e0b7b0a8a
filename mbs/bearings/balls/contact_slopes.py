"""Derivatives of load, stiffness and damping of many contacts of one law by the approach."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.balls.normal_law import NormalLaw, contacts_at

STEP = 1e-10
"""Step of the approach, either way, by which laws are differentiated [m]."""


def contact_slopes(law: NormalLaw, approach: FloatArray) -> FloatArray:
    """Derivatives of load, stiffness and damping by the approach, shape (3, ...).

    Parameters
    ----------
    law : NormalLaw
        Their law.
    approach : array (...)
        Approaches [m].
    """
    return np.asarray((contacts_at(law, approach + STEP) - contacts_at(law, approach - STEP)) / (2.0 * STEP))
