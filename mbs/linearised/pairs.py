"""Modes of two systems that belong together: those of a reference, and those of a system that is a little different.

Modes are paired by their shapes in the coordinates that both systems have, weighted with the mass (modal assurance), so
that the sum of all assurances is largest. Two modes of nearly one frequency, as those of the two planes of a shaft,
have no shapes of their own: a small change turns both. Such a pair, which is damped alike, is taken by the order of its
frequencies.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from mbs.model.system import System

LEAST_ASSURANCE = 0.5
"""Modal assurance above which two modes are one."""

CLOSE = 0.03
"""Part of a frequency within which two modes may exchange their shapes."""


def partners(system: System, shapes: ComplexArray, other: System, others: ComplexArray) -> IntArray:
    """Mode of another system that each mode of a reference is, shape (modes,); -1 where there is none.

    Parameters
    ----------
    system : System
        The reference.
    shapes : array, shape (n, modes)
        Shapes of its modes.
    other : System
        The other system; it may have other coordinates.
    others : array, shape (m, modes of it)
        Shapes of its modes.
    """
    places = {name: k for k, name in enumerate(other.coordinates)}
    common = [k for k, name in enumerate(system.coordinates) if name in places]
    mass = system.mass[np.ix_(common, common)]
    first = shapes[common]
    second = others[[places[system.coordinates[k]] for k in common]]
    sizes = [np.sum(part.conj() * (mass @ part), axis=0).real for part in (first, second)]
    assurance = np.abs(first.conj().T @ mass @ second) ** 2 / np.maximum(np.multiply.outer(*sizes), 1e-300)
    rows, columns = linear_sum_assignment(assurance, maximize=True)
    found = np.full(shapes.shape[1], -1)
    kept = assurance[rows, columns] >= LEAST_ASSURANCE
    found[rows[kept]] = columns[kept]
    return found


ALIKE = 2.0
"""Factor of damping ratios up to which two such modes are those of two planes, and no others that meet."""


def in_order(frequency: FloatArray, damping_ratio: FloatArray, partner: IntArray, found: FloatArray) -> IntArray:
    """Partners with those of nearly equal frequencies in the order of their own frequencies.

    Parameters
    ----------
    frequency : array, shape (modes,)
        Frequencies of the reference, rising [Hz].
    damping_ratio : array, shape (modes,)
        Damping ratios of these.
    partner : array, shape (modes,)
        What `partners` finds.
    found : array, shape (modes of the other system,)
        Frequencies of the other system [Hz].
    """
    ordered = partner.copy()
    first = 0
    while first < ordered.size - 1:
        pair = slice(first, first + 2)
        apart = frequency[first + 1] > (1.0 + CLOSE) * frequency[first]
        least, most = np.sort(damping_ratio[pair])
        if apart or most > ALIKE * least or np.any(ordered[pair] < 0):
            first += 1
            continue
        ordered[pair] = ordered[pair][np.argsort(found[ordered[pair]], kind="stable")]
        first += 2
    return ordered
