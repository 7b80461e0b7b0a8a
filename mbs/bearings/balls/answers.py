"""Displacements of five freedoms that bearings of balls and of tapered rollers feel in runs."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray

FELT = np.array([0, 1, 2, 4, 5])
"""Displacements of its port that a bearing feels."""


def felt_rows(element: object) -> FloatArray:
    """Rows of what a bearing feels of its port; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    element : object
        The bearing.
    """
    return np.asarray(np.eye(6)[FELT])
