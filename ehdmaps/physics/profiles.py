"""Profiles of rollers: how far the surface lies below the cylinder, along the roller."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray

_LONG = 2.5


def iso_profile(x: FloatArray, roller_diameter: float, roller_length: float) -> FloatArray:
    """Profile of a roller: how far its surface lies below the cylinder, on one side [m].

    P(x) = 0.00035 D ln(1/(1 - (2x/L)^2)) for L <= 2.5 D. Longer rollers are straight in the middle, with
    P(x) = 0.0005 D ln(1/(1 - ((2|x| - (L - 2.5 D))/(2.5 D))^2)) outside it.

    Parameters
    ----------
    x : array
        Distance from the middle of the roller [m], |x| < L/2.
    roller_diameter, roller_length : float
        D and L [m].

    References
    ----------
    ISO/TS 16281:2008; DIN 26281:2010.

    Examples
    --------
    A quarter of the length from the middle of the roller of an NU308:

    >>> float(round(1e6 * iso_profile(np.array([3.75e-3]), 14e-3, 15e-3)[0], 4))
    1.4096
    """
    if roller_length <= _LONG * roller_diameter:
        part, depth = 2.0 * np.abs(x) / roller_length, 0.00035 * roller_diameter
    else:
        crowned = _LONG * roller_diameter
        part = np.maximum(2.0 * np.abs(x) - (roller_length - crowned), 0.0) / crowned
        depth = 0.0005 * roller_diameter
    return np.asarray(-depth * np.log1p(-(part**2)))
