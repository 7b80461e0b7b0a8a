"""Modes followed from one operating point to the next by their shapes.

Two sets of modes are compared by their right and left vectors, left . right = 1 for the same mode and 0 for another
one of the same set. The assurance |(left_i . right_j)(left_j . right_i)| is then 1 for a mode that stayed and 0 for
another one, however strongly damped and however far from orthogonal the modes are. For undamped modes, whose left
vector is the right one times the mass matrix, it is the mass-weighted modal assurance criterion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse.csgraph import connected_components

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray

SAME = 1e-6
"""Eigenvalues that differ by less than this part of their size, or a tenth of it of the largest one, are equal."""

_KEEP_ORDER = 1e-9


@dataclass(frozen=True, eq=False)
class ModeSet:
    """The modes of one operating point, ready to be compared with those of another.

    Attributes
    ----------
    eigenvalues : array, shape (modes,)
        [1/s].
    right : array, shape (N, modes)
        Right eigenvectors, of any size.
    left : array, shape (modes, N)
        Left ones, with left @ right = 1.
    """

    eigenvalues: ComplexArray
    right: ComplexArray | FloatArray
    left: ComplexArray | FloatArray


@dataclass(frozen=True, eq=False)
class Match:
    """Modes of a set that continue those of another.

    Attributes
    ----------
    chosen : array of int, shape (modes before,)
        Index after; -1 for a mode that ends.
    assurance : array, shape (modes before,)
        Modal assurance of the best continuation, from 0 to 1, also where it was refused.
    size : int
        Modes after; those that nothing continues begin there.
    """

    chosen: IntArray
    assurance: FloatArray
    size: int


def assurance(before: ModeSet, after: ModeSet) -> FloatArray:
    """Modal assurance of each mode of a set with each of another, shape (modes before, modes after), from 0 to 1.

    Modes of equal eigenvalue have no shapes of their own, as every mixture of them is a mode too: such a group is
    compared as a whole.
    """
    product = (before.left @ after.right) * (after.left @ before.right).T
    first, last = _groups(before.eigenvalues), _groups(after.eigenvalues)
    most = np.minimum(first.sum(axis=1)[:, None], last.sum(axis=1)[None, :])
    mac = np.abs(first @ product @ last) / np.maximum(most, 1.0)
    return np.asarray(np.minimum(mac, 1.0), dtype=np.float64)


def match(before: ModeSet, after: ModeSet, least: float = 0.0) -> Match:
    """Assign modes to modes so that the sum of their assurances is largest.

    Parameters
    ----------
    before, after : ModeSet
        Modes at neighbouring operating points.
    least : float
        A continuation with less assurance is refused: the mode ends, and the other one begins.
    """
    mac = assurance(before, after)
    rows, columns = np.arange(mac.shape[0]), np.arange(mac.shape[1])
    # Among equals the order is kept.
    drift = np.abs(rows[:, None] - columns[None, :]) / max(mac.size, 1)
    i, j = linear_sum_assignment(mac - _KEEP_ORDER * drift, maximize=True)
    chosen, sure = np.full(rows.size, -1), np.zeros(rows.size)
    sure[i] = mac[i, j]
    kept = mac[i, j] >= least
    chosen[i[kept]] = j[kept]
    return Match(chosen, sure, columns.size)


def compose(steps: Sequence[Match]) -> Match:
    """The match from the first to the last of several sets; its assurance is the least on the way."""
    chosen, sure = steps[0].chosen, steps[0].assurance
    for step in steps[1:]:
        alive = chosen >= 0
        sure = np.where(alive, np.minimum(sure, step.assurance[chosen]), sure) if step.chosen.size else sure
        chosen = np.where(alive, step.chosen[chosen], -1) if step.chosen.size else np.full(chosen.size, -1)
    return Match(chosen, sure, steps[-1].size)


def tracks(size: int, matches: Sequence[Match]) -> IntArray:
    """Index of each followed mode at each operating point, shape (points, tracks); -1 where it does not exist.

    Parameters
    ----------
    size : int
        Modes at the first point: the first tracks, in their order. Modes that begin later follow.
    matches : sequence of Match
        Matches from each point to the next.
    """
    now = np.arange(size)
    rows = [now]
    count = size
    for step in matches:
        following = np.full(count, -1)
        alive = np.nonzero(now >= 0)[0]
        following[alive] = step.chosen[now[alive]]
        free = np.setdiff1d(np.arange(step.size), step.chosen[step.chosen >= 0])
        now = np.concatenate([following, free])
        count = now.size
        rows.append(now)
    return np.stack([np.concatenate([row, np.full(count - row.size, -1)]) for row in rows])


def numbers(order: IntArray, plain: IntArray, kinship: Sequence[FloatArray]) -> IntArray:
    """Undamped mode that each complex one is nearest to where it begins, each at most once at a time.

    Parameters
    ----------
    order : array, shape (points, complex tracks)
        Index of each complex track at each point; -1 where it does not exist.
    plain : array, shape (points, undamped tracks)
        The same of the undamped ones, which exist everywhere.
    kinship : sequence of array, shape (complex modes, undamped modes)
        Share of each undamped mode in each complex mode, at each point.

    Returns
    -------
    array, shape (complex tracks,)
        Undamped track, from 0 on.
    """
    nearest = np.full(order.shape[1], -1)
    for row, columns, near in zip(order, plain, kinship, strict=True):
        here = row >= 0
        new = np.flatnonzero(here & (nearest < 0))
        free = np.setdiff1d(np.arange(columns.size), nearest[here])
        if new.size:
            i, j = linear_sum_assignment(near[np.ix_(row[new], columns[free])], maximize=True)
            nearest[new[i]] = free[j]
    return nearest


def _groups(values: ComplexArray) -> FloatArray:
    """Marks of equal eigenvalues, 1 or 0, shape (modes, modes)."""
    size = np.abs(values)
    close = SAME * np.maximum(size, 0.1 * size.max(initial=0.0))
    near = np.abs(values[:, None] - values[None, :]) <= np.minimum(close[:, None], close[None, :])
    labels = connected_components(near, directed=False)[1]
    return np.asarray(labels[:, None] == labels[None, :], dtype=np.float64)
