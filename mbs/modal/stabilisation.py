"""Poles that are modes: those that come back from order to order, with the same frequency, damping and shape.

A fit of high order has poles for the noise as well; they wander when the order changes. A pole is stable where one of
the orders before has it too. Poles that lie together and have company in other orders are a chain; a chain that is
long enough is a mode, its pole the median of the chain. sdypy-EMA compares orders by frequency and damping too, but
leaves the choice to a person.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import connected_components

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray, IntArray

_FREQUENCY, _DAMPING, _ASSURANCE = 0.005, 0.1, 0.9
"""Largest relative change of |pole| and of the decay from order to order, and smallest modal assurance criterion
between the residues of both, which says nothing for a single response."""

_WITHIN = 3
"""Orders that may lie between a pole and the one it continues, and one more."""

_LEAST = 6
"""Orders in a chain, its first one included."""

_MOST_DAMPED = 0.3
"""Damping ratio: poles beyond it shape the background."""


@dataclass(frozen=True)
class Candidate:
    """A pole of the stabilisation diagram.

    Attributes
    ----------
    order : int
        Pole pairs of the fit.
    pole : complex
        Pole as found, with what an exponential window added [1/s].
    stable : bool
        Whether it continues one of the orders before.
    """

    order: int
    pole: complex
    stable: bool


@dataclass(frozen=True, eq=False)
class Stabilisation:
    """Modes, and the diagram that they were taken from.

    Attributes
    ----------
    poles : array of complex, shape (modes,)
        Medians of the chains, rising in frequency [1/s].
    scatter : array, shape (modes, 2)
        Standard deviations of real and imaginary part over the orders [1/s].
    counts : tuple of int
        Poles in the chain of each mode.
    candidates : tuple of Candidate
        All poles in the band.
    """

    poles: ComplexArray
    scatter: FloatArray
    counts: tuple[int, ...]
    candidates: tuple[Candidate, ...]

    def of(self, chosen: IntArray) -> Stabilisation:
        """The same with some of its modes.

        Parameters
        ----------
        chosen : array of int
            Indices of the modes that stay.
        """
        counts = tuple(self.counts[k] for k in chosen)
        return Stabilisation(self.poles[chosen], self.scatter[chosen], counts, self.candidates)

    def and_one(self, pole: complex) -> Stabilisation:
        """The same with a further mode that no chain has; the diagram stays.

        Parameters
        ----------
        pole : complex
            Pole of the mode [1/s].
        """
        scatter = np.concatenate([self.scatter, np.full((1, 2), np.nan)])
        return Stabilisation(np.append(self.poles, pole), scatter, (*self.counts, 0), self.candidates)


def stabilise(
    poles: Sequence[ComplexArray],
    orders: Sequence[int],
    band: tuple[float, float],
    shapes: Callable[[ComplexArray], ComplexArray],
) -> Stabilisation:
    """Follow poles over the orders.

    Parameters
    ----------
    poles : sequence of array of complex
        All poles of each order [1/s].
    orders : sequence of int
        Rising numbers of pole pairs.
    band : (float, float)
        Band in which a mode may be [Hz].
    shapes : callable
        Residues (poles, rows) of given poles.
    """
    physical = [_physical(of_order, band) for of_order in poles]
    place = np.repeat(np.arange(len(physical)), [here.size for here in physical])
    every = np.concatenate(physical)
    kept: list[ComplexArray] = []
    stable = np.zeros(every.size, dtype=np.bool_)
    if every.size:
        shape = np.concatenate([shapes(here) for here in physical if here.size])
        near = _near(every)
        apart = place[:, None] - place
        link = near & (apart != 0) & (np.abs(apart) <= _WITHIN) & (_assurance(shape) >= _ASSURANCE)
        stable = np.any(link & (apart > 0), axis=1)
        followed = np.flatnonzero(np.any(link, axis=1))
        chains = connected_components(near[np.ix_(followed, followed)], directed=False)[1]
        for members in (followed[chains == chain] for chain in range(chains.max(initial=-1) + 1)):
            # A chain that ends early is what low orders make of several modes; no more orders than there are.
            if members.size >= min(_LEAST, len(orders)) and place[members].max() >= len(orders) // 2:
                kept.append(every[members])
    kept.sort(key=lambda members: float(np.median(members.imag)))
    return Stabilisation(
        np.array([complex(np.median(m.real), np.median(m.imag)) for m in kept], dtype=np.complex128),
        np.array([(np.std(m.real), np.std(m.imag)) for m in kept], dtype=np.float64).reshape(-1, 2),
        tuple(members.size for members in kept),
        tuple(Candidate(orders[int(k)], complex(p), bool(s)) for k, p, s in zip(place, every, stable, strict=True)),
    )


def _physical(poles: ComplexArray, band: tuple[float, float]) -> ComplexArray:
    """Poles that may be modes: oscillating, decaying, in the band."""
    size = np.abs(poles)
    kept = (poles.imag > 0.0) & (poles.real < 0.0) & (-poles.real <= _MOST_DAMPED * size)
    kept &= (size >= 2.0 * np.pi * band[0]) & (size <= 2.0 * np.pi * band[1])
    return np.asarray(poles[kept][np.argsort(size[kept])], dtype=np.complex128)


def _near(poles: ComplexArray) -> BoolArray:
    """Tell which poles are alike, shape (poles, poles): nearer than half their widths, two are one to any method."""
    size, half = np.abs(poles), -poles.real
    near = np.abs(poles[:, None] - poles) <= 0.5 * np.minimum(half[:, None], half)
    near &= np.abs(size[:, None] - size) <= _FREQUENCY * size
    return np.asarray(near & (np.abs(half[:, None] - half) <= _DAMPING * np.maximum(half[:, None], half)))


def _assurance(shapes: ComplexArray) -> FloatArray:
    """Modal assurance criteria of shapes (poles, rows) with each other, 0 to 1; of shapes of one row 1."""
    size = np.linalg.norm(shapes, axis=1, keepdims=True)
    unit = shapes / np.where(size > 0.0, size, 1.0)
    return np.asarray(np.abs(unit.conj() @ unit.T) ** 2, dtype=np.float64)
