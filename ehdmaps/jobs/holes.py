"""Fill isolated holes of a map from their neighbours."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray


def isolated_holes(usable: BoolArray) -> tuple[BoolArray, BoolArray]:
    """Find the holes that can be filled.

    Parameters
    ----------
    usable : array, dims (contact, load, entrainment_speed, temperature)
        Whether a point has values.

    Returns
    -------
    along_load, along_speed : arrays of bool
        Holes with usable neighbours on both sides along the load axis; and of the others (those at the ends
        of the load axis among them) the ones with usable neighbours along the speed axis.
    """
    along_load = ~usable & _both_neighbours(usable, axis=1)
    along_speed = ~usable & ~along_load & _both_neighbours(usable, axis=2)
    return along_load, along_speed


def filled(values: FloatArray, holes: BoolArray, axis: int, coordinate: FloatArray) -> FloatArray:
    """Interpolate between the two neighbours along one axis.

    Log-log where coordinate and both neighbours are positive, since films and losses are nearly power laws;
    linear in the value elsewhere.

    Parameters
    ----------
    values : array
        Values with NaN in the holes.
    holes : array of bool
        Points to fill; neither at an end of the axis.
    axis : int
        Axis of the neighbours.
    coordinate : array
        Rising values of that axis.

    Returns
    -------
    array
        Copy of `values` with the holes filled.

    Examples
    --------
    >>> line = np.array([1.0, np.nan, 16.0])
    >>> float(filled(line, np.isnan(line), 0, np.array([1.0, 2.0, 4.0]))[1])
    4.0
    """
    moved = np.moveaxis(values, axis, 0)
    result = moved.copy()
    place = np.nonzero(np.moveaxis(holes, axis, 0))
    at, rest = place[0], place[1:]
    before, after = moved[(at - 1, *rest)], moved[(at + 1, *rest)]
    x0, x, x1 = coordinate[at - 1], coordinate[at], coordinate[at + 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(x0 > 0, np.log(x / x0) / np.log(x1 / x0), (x - x0) / (x1 - x0))
        logarithmic = np.exp((1 - share) * np.log(before) + share * np.log(after))
    result[place] = np.where((before > 0) & (after > 0), logarithmic, (1 - share) * before + share * after)
    return np.moveaxis(result, 0, axis)


def _both_neighbours(usable: BoolArray, axis: int) -> BoolArray:
    """Whether both neighbours along an axis are usable; False at its ends."""
    moved = np.moveaxis(usable, axis, 0)
    both = np.zeros_like(moved)
    both[1:-1] = moved[:-2] & moved[2:]
    return np.moveaxis(both, 0, axis)
