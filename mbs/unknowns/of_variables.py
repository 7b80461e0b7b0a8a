"""Bands of the variables of a result, such as K, C, pressures and films: each look makes the variables again."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from mbs.scene.scene import Scene
from mbs.unknowns.looks import Band, band
from mbs.unknowns.unknown import Unknown

FREEDOMS = 6
"""Rows of K and C of a bearing."""

EITHER_SIGN = ("bearing_force",)
"""Variables that may have either sign."""

Variables = Mapping[str, FloatArray]
"""Values by the names that files have for them, each of its own shape."""


def variable_bands(
    make: Callable[[Scene, bool], Variables],
    centre: Variables,
    unknowns: Sequence[Unknown],
    numerics: Variables | None = None,
) -> dict[str, Band]:
    """Find the bands of variables.

    Parameters
    ----------
    make : callable
        Makes them of a changed scene; True: its cages stand.
    centre : mapping of str to array
        What is printed.
    unknowns : sequence of Unknown
        What is not known of its scene.
    numerics : mapping of str to array, optional
        What numerics leave open, either way; of those that are not named it is not known.
    """
    values = _row(centre, centre)
    open_ones = {name: np.full(np.shape(value), np.nan) for name, value in centre.items()} | dict(numerics or {})
    errors = _row(open_ones, centre)
    both = band(lambda scene, standing: _row(make(scene, standing), centre), values, unknowns, errors)
    found, first = {}, 0
    for name, value in centre.items():
        place = first + np.arange(value.size).reshape(value.shape)
        found[name] = dataclasses.replace(both.of(place), signed=_signed(name, value))
        first += value.size
    return found


def _signed(name: str, value: FloatArray) -> BoolArray:
    """Values that may have either sign: forces, and entries of matrices that couple two motions."""
    if name in EITHER_SIGN:
        return np.ones(value.shape, dtype=np.bool_)
    matrices = value.ndim > 1 and value.shape[-1] == value.shape[-2] == FREEDOMS
    coupling = ~np.eye(FREEDOMS, dtype=np.bool_) if matrices else np.False_
    return np.broadcast_to(coupling, value.shape)


def _row(variables: Variables, like: Variables) -> FloatArray:
    """All values in one row, in the order of others."""
    return np.concatenate([np.asarray(variables[name], dtype=np.float64).reshape(-1) for name in like])
