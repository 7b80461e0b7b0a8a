"""Undamped modes that come close and exchange their shapes: where that is a crossing, they are followed straight on.

Two undamped modes of one system come close and turn away from each other, with a gap g as wide as they are coupled
(veering); each then has the shape of the other. With damping the eigenvalues of the pair are those of

    [[a1 + i w1, i k], [i k, a2 + i w2]],    a decay rates, k the coupling, g = 2 k:

at w1 = w2 they differ by sqrt((a1 - a2)^2 - 4 k^2). Where the decay rates differ by more than g that is real: the
complex modes cross, each keeps its shape, and what turns away is an accident of leaving damping out. Numbers follow
the shapes there, and the frequency otherwise.

References
----------
W. D. Heiss, J. Phys. A 37 (2004) 2455-2464 (crossing and avoided crossing on both sides of an exceptional point).
"""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.linearised.sweep_result import UndampedSweep

_BESIDE = 3
"""Speeds beside a crossing where both modes have shapes of their own."""


def exchanged(found: UndampedSweep) -> list[tuple[int, int]]:
    """Modes, from 0 on, each with the one that has its shape at the last speed; of two that exchange, the first."""
    like = found.resembles
    return [(k, int(other)) for k, other in enumerate(like) if other > k or (other < k and like[other] != k)]


def straightened(found: UndampedSweep) -> UndampedSweep:
    """The same modes, with both branches exchanged behind each crossing.

    Parameters
    ----------
    found : UndampedSweep
        Each mode followed along its frequency.
    """
    # Each exchange gives at least one mode of a cycle its own shape back.
    for _ in range(found.resembles.size):
        crossing = [pair for pair in _candidates(found) if _cross(found, *pair)]
        if not crossing:
            break
        found = _swapped(found, *min(crossing, key=lambda pair: _gap(found, *pair)))
    return found


def _candidates(found: UndampedSweep) -> list[tuple[int, int]]:
    """Pairs of modes whose exchange gives one of them its own shape back at the last speed."""
    like = found.resembles
    away = np.flatnonzero(like != np.arange(like.size)).tolist()
    return [(k, j) for k, j in itertools.combinations(away, 2) if _same_cycle(found, k, j)]


def _same_cycle(found: UndampedSweep, first: int, second: int) -> bool:
    """Whether the shape of one mode goes over to the other one, perhaps by way of more."""
    at = int(found.resembles[first])
    while at not in (first, second):
        at = int(found.resembles[at])
    return at == second


def _nearest(found: UndampedSweep, first: int, second: int) -> int:
    """Index of the speed at which two modes are closest."""
    return int(np.argmin(np.abs(found.frequency[:, first] - found.frequency[:, second])))


def _gap(found: UndampedSweep, first: int, second: int) -> float:
    """Least distance of two modes [Hz]."""
    return float(np.min(np.abs(found.frequency[:, first] - found.frequency[:, second])))


def _cross(found: UndampedSweep, first: int, second: int) -> bool:
    """Whether the decay rates of two modes, beside the place where they are closest, differ by more than the gap."""
    near = _nearest(found, first, second)
    widths = found.damping_ratio * found.frequency
    apart = np.abs(widths[:, first] - widths[:, second])
    before, after = apart[max(near - _BESIDE, 0) : near + 1], apart[near : near + _BESIDE + 1]
    return _gap(found, first, second) < min(float(before.max()), float(after.max()))


def _swapped(found: UndampedSweep, first: int, second: int) -> UndampedSweep:
    """The modes with two of them exchanged from where they are closest on."""
    near = _nearest(found, first, second)
    at = near if _is_other(found, first, near) else near + 1
    order = np.tile(np.arange(found.frequency.shape[1]), (found.frequency.shape[0], 1))
    order[at:, [first, second]] = [second, first]
    shift = np.log1p(found.summed_shift)
    shift[at:, [first, second]] = _continued(found, shift, first, second, at)
    resembles = found.resembles.copy()
    resembles[found.resembles == first], resembles[found.resembles == second] = second, first
    return dataclasses.replace(
        found,
        frequency=np.take_along_axis(found.frequency, order, axis=1),
        damping_ratio=np.take_along_axis(found.damping_ratio, order, axis=1),
        shares=np.take_along_axis(found.shares, order[None], axis=2),
        bearing_share=np.take_along_axis(found.bearing_share, order, axis=1),
        frequency_error=np.take_along_axis(found.frequency_error, order, axis=1),
        assurance=np.take_along_axis(found.assurance, order, axis=1),
        summed_shift=np.expm1(shift),
        resembles=resembles,
    )


def _is_other(found: UndampedSweep, mode: int, near: int) -> bool:
    """Whether the shapes are exchanged already at a speed, by where the strain energy is there and beside it."""
    last = found.frequency.shape[0] - 1
    before, after = (found.shares[:, index, mode] for index in (max(near - _BESIDE, 0), min(near + _BESIDE, last)))
    here = found.shares[:, near, mode]
    return bool(np.abs(here - after).sum() < np.abs(here - before).sum())


def _continued(found: UndampedSweep, shift: FloatArray, first: int, second: int, at: int) -> FloatArray:
    """Logarithms of the shift from a speed on, each along the other branch, and the step over the gap before it."""
    before = max(at - 1, 0)
    columns = np.array([second, first])
    along = shift[at:, columns] - shift[before, columns]
    step = np.log(found.frequency[before, columns] / found.frequency[before, columns[::-1]])
    return np.asarray(shift[before, columns[::-1]] + step + along)
