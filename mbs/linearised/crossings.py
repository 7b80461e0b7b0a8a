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

import numpy as np

from ehdmaps.physics._values import FloatArray
from mbs.linearised.modes import IntArray
from mbs.linearised.sweep_result import UndampedSweep


def exchanged(found: UndampedSweep) -> list[tuple[int, int]]:
    """Pairs of modes of which each has the shape of the other one at the last speed, counted from 0."""
    like = found.resembles
    return [(k, int(other)) for k, other in enumerate(like) if other > k and like[other] == k]


def straightened(found: UndampedSweep) -> UndampedSweep:
    """The same modes, with both branches exchanged behind each crossing.

    Parameters
    ----------
    found : UndampedSweep
        Each mode followed along its frequency.
    """
    order = np.tile(np.arange(found.frequency.shape[1]), (found.frequency.shape[0], 1))
    shift = np.log1p(found.summed_shift)
    resembles = found.resembles.copy()
    for first, second in exchanged(found):
        near = _nearest(found, first, second)
        if not _cross(found, first, second, near):
            continue
        at = near if _is_other(found, first, second, near) else near + 1
        order[at:, [first, second]] = order[at:, [second, first]]
        shift[at:, [first, second]] = _continued(found, shift, first, second, at)
        resembles[[first, second]] = first, second
    return dataclasses.replace(
        found,
        frequency=np.take_along_axis(found.frequency, order, axis=1),
        damping_ratio=np.take_along_axis(found.damping_ratio, order, axis=1),
        shares=np.take_along_axis(found.shares, order[None], axis=2),
        bearing_share=np.take_along_axis(found.bearing_share, order, axis=1),
        assurance=np.take_along_axis(found.assurance, order, axis=1),
        summed_shift=np.expm1(shift),
        resembles=resembles,
    )


def _nearest(found: UndampedSweep, first: int, second: int) -> int:
    """Index of the speed at which two modes are closest."""
    return int(np.argmin(np.abs(found.frequency[:, first] - found.frequency[:, second])))


def _cross(found: UndampedSweep, first: int, second: int, near: int) -> bool:
    """Whether the decay rates of two modes, where their shapes are their own, differ by more than the gap."""
    gap = abs(float(found.frequency[near, first] - found.frequency[near, second]))
    widths = (found.damping_ratio * found.frequency)[[0, -1]][:, [first, second]]
    return gap < float(np.min(np.abs(widths[:, 0] - widths[:, 1])))


def _is_other(found: UndampedSweep, first: int, second: int, near: int) -> bool:
    """Whether the shapes are exchanged already at a speed, by where the strain energy is there and at both ends."""
    here, begin, end = (found.shares[:, index, first] for index in (near, 0, -1))
    return bool(np.abs(here - end).sum() < np.abs(here - begin).sum())


def _continued(found: UndampedSweep, shift: FloatArray, first: int, second: int, at: int) -> FloatArray:
    """Logarithms of the shift from a speed on, each along the other branch, and the step over the gap before it."""
    before = max(at - 1, 0)
    columns: IntArray = np.array([second, first])
    along = shift[at:, columns] - shift[before, columns]
    step = np.log(found.frequency[before, columns] / found.frequency[before, columns[::-1]])
    return np.asarray(shift[before, columns[::-1]] + step + along)
