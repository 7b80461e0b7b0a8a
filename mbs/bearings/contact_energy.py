"""Energy of the contacts of a bearing at rest, what changes of the speed bring in, and the moment on its cage.

They follow from the laws of the forces, see `mbs.bearings.bearing_force`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.bearing import Bearing
from mbs.bearings.laws import DryLaw, Law

LoadsOf = Callable[[FloatArray], FloatArray]
"""Loads of contacts at rest by their approaches."""

Potential = Callable[[FloatArray], FloatArray]
"""Energies of contacts at rest by their approaches."""

Conditions = tuple[float, float, float]
"""u [m/s], T [K], centrifugal load [N/m]."""

_CELLS = 400
_PARTS, _SAMPLES = 100, 16
_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_NEAR, _FAR, _SOUGHT = 1e-12, 0.1, 100


def cage_moment(force: FloatArray, displacement: FloatArray, rings: int) -> float:
    """Moment that a bearing asks of its cage [N m].

    Turning cage and rings together does no work, so that the cage has to give what the forces on the rings turn:
    y f_z - z f_y + theta_y M_z - theta_z M_y of each.

    Parameters
    ----------
    force, displacement : array (6 rings + ...,)
        Forces on the rings, and displacements of these [N or N m], [m or rad].
    rings : int
        How many rings there are.
    """
    total = 0.0
    for first in range(0, 6 * rings, 6):
        for i in (first + 1, first + 4):
            total += float(displacement[i] * force[i + 1] - displacement[i + 1] * force[i])
    return total


def energy_at_rest(law: Law, conditions: Conditions, bearing: Bearing, approach: FloatArray) -> float:
    """Energy of contacts at rest [J]: the integral of their loads over the approach.

    Parameters
    ----------
    law : DryLaw or ContactLaw
        Law of the contacts.
    conditions : (float, float, float)
        u [m/s], T [K] and centrifugal load [N/m] of the law of a map.
    bearing : Bearing
        The bearing, for the length of its slices.
    approach : array
        Approach of slices [m].
    """
    return float(np.sum(potential(law, conditions, bearing, float(np.max(approach)))(approach)))


def potential(law: Law, conditions: Conditions, bearing: Bearing, deepest: float) -> Potential:
    """Energy of slices by their approach, up to the deepest one [m].

    By Gauss points in cells that grow with the distance from where a film begins to carry, and a cubic within a cell.

    Parameters
    ----------
    law, conditions, bearing
        What `energy_at_rest` takes.
    deepest : float
        [m].
    """
    if isinstance(law, DryLaw):
        return lambda approach: np.asarray(law.energy(approach) / bearing.slices)
    point = law.at(*conditions)

    def loads(delta: FloatArray) -> FloatArray:
        return np.asarray(point.evaluate(delta, np.zeros_like(delta))[0])

    first = _lift_off(loads, deepest)
    if first >= deepest:
        return np.zeros_like
    centre, inverse = point.point.film * point.point.own.offset, point.point.own.inverse_scale
    ends = np.arcsinh((np.array([first, deepest]) - centre) * inverse)
    nodes = centre + np.sinh(np.linspace(ends[0], ends[1], _CELLS + 1)) / inverse
    widths = np.diff(nodes)
    at = nodes[:-1, None] + 0.5 * widths[:, None] * (1.0 + _PLACES)
    cells = 0.5 * widths * (loads(at.ravel()).reshape(at.shape) @ _WEIGHTS)
    sums, slopes = np.concatenate([[0.0], np.cumsum(cells)]), loads(nodes)

    def energies(approach: FloatArray) -> FloatArray:
        cell = np.clip(np.searchsorted(nodes, approach, side="right") - 1, 0, _CELLS - 1)
        h = widths[cell]
        t = np.clip((approach - nodes[cell]) / h, 0.0, 1.0)
        # Hermite's cubic through the sums, whose slopes are the loads.
        low, rise = slopes[cell] * h, sums[cell + 1] - sums[cell]
        bend = slopes[cell + 1] * h + low - 2.0 * rise
        return np.asarray(sums[cell] + t * (low + t * (rise - low - bend + t * bend))) * bearing.slice_length

    return energies


def brought_by_speed(
    law: Law,
    bearing: Bearing,
    conditions: Sequence[Conditions],
    approaches: Callable[[int], FloatArray],
) -> float:
    """Energy that changes of the speed bring into contacts by changing their law [J].

    At a held approach a thicker film is pressed harder. The energy of the approaches of a few samples in each part of
    the run is taken with the laws at both ends of the part. Films with memory are taken as at rest. It is an estimate:
    what it leaves out is how approaches go on between the samples.

    Parameters
    ----------
    law, bearing
        What `energy_at_rest` takes.
    conditions : sequence of (float, float, float)
        Conditions of the law at all samples of a run.
    approaches : callable
        Approaches of all slices at a sample [m], by its index.
    """

    def change(begin: int, end: int, inside: FloatArray) -> float:
        delta = np.stack([approaches(int(index)) for index in inside])
        deepest = float(np.max(delta))
        first, last = (potential(law, conditions[at], bearing, deepest)(delta) for at in (begin, end))
        return float(np.sum(last - first)) / inside.size

    return 0.0 if isinstance(law, DryLaw) else over_parts(conditions, change)


def over_parts(conditions: Sequence[Any], change: Callable[[int, int, FloatArray], float]) -> float:
    """Sum what changes of the conditions do over the parts of a run.

    Parameters
    ----------
    conditions : sequence
        Conditions at all samples of the run.
    change : callable
        What one of them does [J], by its first and last sample, and samples inside of it.
    """
    count, total = len(conditions), 0.0
    if len(set(conditions)) == 1:
        return 0.0
    ends = np.unique(np.linspace(0, count - 1, min(_PARTS, count - 1) + 1).astype(int)).tolist()
    for begin, end in pairwise(ends):
        if conditions[begin] != conditions[end]:
            width, samples = end - begin, min(_SAMPLES, end - begin)
            total += change(begin, end, begin + (np.arange(samples) + 0.5) * (width / samples))
    return total


def _lift_off(loads: LoadsOf, deepest: float) -> float:
    """An approach without load, close below the first one with load [m]; `deepest` where there is none."""
    if not loads(np.array([deepest]))[0] > 0.0:
        return deepest
    below = deepest - np.append(0.0, np.geomspace(_NEAR, _FAR, _SOUGHT))[::-1]
    while True:
        first = int(np.argmax(loads(below) > 0.0))
        if first == 0 or below[first] - below[first - 1] < _NEAR:
            return float(below[max(first - 1, 0)])
        below = np.linspace(below[first - 1], below[first], _SOUGHT)
