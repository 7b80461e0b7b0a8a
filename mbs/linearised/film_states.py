"""Films that relax, as states of a linear system: few of them, and as exact as all slices.

Thousands of slices relax, but what they add to a bearing is a matrix of its few ports,

    F(s) = V' (1 + s Theta)^-1 V,    rows v of V and times Theta of `mbs.model.relaxation`.

Projected on the space of V and of both parts of (1 + i w_j Theta)^-1 V for some frequencies w_j, F and its derivative
are exact at s = 0 and at each i w_j (rational Krylov). The projected Theta has its eigenvalues among those of Theta, so
that what is left are springs in series with dampers again: they take up energy at every frequency. The w_j are placed
where F is worst on the frequency axis, until it is within `TOLERANCE` of all slices there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag, svd

from ehdmaps.arrays import FloatArray
from mbs.model.relaxation import Relaxation

TOLERANCE = 1e-8
"""Error of F on the frequency axis, as a part of F(0)."""

_MOST_POLES = 16
_FREQUENCIES = 61
_ALIKE = 1e-12


@dataclass(frozen=True, eq=False)
class FilmStates:
    """Some springs in series with dampers that act like many.

    Attributes
    ----------
    relaxation : Relaxation
        The few, q of them.
    lift : array, shape (r, q)
        Orthonormal columns: forces of the many, in the roots of their springs, by those of the few.
    slowest : float
        Longest time of the many [s].
    """

    relaxation: Relaxation
    lift: FloatArray
    slowest: float = 0.0

    @property
    def size(self) -> int:
        """Number q of the few."""
        return self.relaxation.times.size


def film_states(relaxation: Relaxation, highest: float = math.inf) -> FilmStates:
    """Reduce springs in series with dampers to few that act alike.

    Parameters
    ----------
    relaxation : Relaxation
        All of them, in ports that are few.
    highest : float
        Frequency up to which they do [rad/s].
    """
    rows, times = relaxation.rows, relaxation.times
    if not np.any(rows):
        return FilmStates(Relaxation(rows[:0], times[:0]), np.zeros((times.size, 0)))
    left, sizes, right = svd(rows, full_matrices=False)
    rank = int(np.count_nonzero(sizes > _ALIKE * sizes[0]))
    begin, ports = left[:, :rank], sizes[:rank, None] * right[:rank]
    low = 1e-2 / times.max()
    omega = np.geomspace(low, max(min(1e2 / times.min(), highest), 10.0 * low), _FREQUENCIES)
    exact = _transfer(begin, times, omega)
    space = begin
    for poles in range(_MOST_POLES + 1):
        few = space.T @ (times[:, None] * space)
        found, turned = np.linalg.eigh(0.5 * (few + few.T))
        error = np.abs(_transfer((begin.T @ space @ turned).T, found, omega) - exact).max(axis=(1, 2))
        if error.max() <= TOLERANCE or space.shape[1] >= times.size or poles == _MOST_POLES:
            break
        place = omega[int(np.argmax(error))] * times
        seen = begin / (1.0 + place**2)[:, None]
        space = _extended(space, np.hstack([seen, place[:, None] * seen]))
    lift = space @ turned
    slowest = float(times[np.any(rows != 0.0, axis=1)].max())
    return FilmStates(Relaxation(lift.T @ begin @ ports, found), lift, slowest)


def together(parts: Iterable[FilmStates]) -> FilmStates | None:
    """The films of several elements, seen by the same coordinates, as one; None if there are none."""
    given = list(parts)
    if not given:
        return None
    rows = np.concatenate([part.relaxation.rows for part in given])
    times = np.concatenate([part.relaxation.times for part in given])
    lift = np.asarray(block_diag(*(part.lift for part in given)), dtype=np.float64)
    return FilmStates(Relaxation(rows, times), lift, max(part.slowest for part in given))


def _transfer(rows: FloatArray, times: FloatArray, omega: FloatArray) -> FloatArray:
    """F at i omega (k,), real and imaginary part side by side, shape (k, m, 2 m)."""
    weights = 1.0 / (1.0 + 1j * np.multiply.outer(omega, times))
    m = rows.shape[1]
    products = (rows[:, :, None] * rows[:, None, :]).reshape(-1, m * m)
    values = (weights @ products).reshape(-1, m, m)
    return np.concatenate([values.real, values.imag], axis=2)


def _extended(space: FloatArray, added: FloatArray) -> FloatArray:
    """Orthonormal columns of a space and of what is added to it."""
    for _ in range(2):
        added = added - space @ (space.T @ added)
    left, sizes, _ = svd(added, full_matrices=False)
    new = left[:, sizes > _ALIKE * max(float(sizes[0]), 1e-300)]
    new = new - space @ (space.T @ new)
    return np.hstack([space, np.linalg.qr(new)[0]])
