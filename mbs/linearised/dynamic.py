"""The dynamic stiffness of a system at any frequency, real or complex, with films that relax or without.

    Z(s) = M s^2 + (D + speed G) s + K + what relaxing films add,    exactly, with all slices.

Without relaxing films Z is that of stiffness and damping of slow motion.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.linearised.film_states import FilmStates, film_states, together
from mbs.model.equilibrium import Equilibrium
from mbs.model.relaxation import Relaxation

_BEYOND = 10.0


def element_dynamic_stiffness(balance: Equilibrium, index: int, s: ComplexArray) -> ComplexArray:
    """Dynamic stiffness of an element in its ports.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    index : int
        Which element of the system.
    s : array, shape (k,)
        Complex frequencies [1/s], such as i omega.

    Returns
    -------
    array, shape (k, m, m)
        -d force/d displacement of an oscillation e^(s t) [N/m and the like].
    """
    found = balance.element_stiffness[index] + s[:, None, None] * balance.element_damping[index]
    relaxation = balance.relaxations[index]
    return np.asarray(found if relaxation is None else found + relaxation.more(s), dtype=np.complex128)


def dynamic_stiffness(balance: Equilibrium, s: ComplexArray) -> ComplexArray:
    """Dynamic stiffness Z(s) of the whole system, inertia included, shape (k, n, n).

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at; the gyroscopic terms are those of its speed.
    s : array, shape (k,)
        Complex frequencies [1/s], such as i omega.
    """
    place = s[:, None, None]
    found = place * balance.system.mass
    found += balance.damping
    found *= place
    found += balance.stiffness
    relaxing = relaxing_elements(balance)
    if relaxing:
        # All ports together, real and imaginary part apart: real matrices are multiplied twice as fast.
        transform = np.concatenate([one for one, _ in relaxing])
        parts = [relaxation.more(s) for _, relaxation in relaxing]
        more = np.zeros((s.size, transform.shape[0], transform.shape[0]), dtype=np.complex128)
        first = 0
        for part in parts:
            more[:, first : first + part.shape[1], first : first + part.shape[1]] = part
            first += part.shape[1]
        found.real += transform.T @ np.ascontiguousarray(more.real) @ transform
        found.imag += transform.T @ np.ascontiguousarray(more.imag) @ transform
    return np.asarray(found, dtype=np.complex128)


def dynamic_slope(balance: Equilibrium, s: ComplexArray) -> ComplexArray:
    """Derivative of `dynamic_stiffness` by s, shape (k, n, n); arguments as there."""
    found = balance.damping + 2.0 * s[:, None, None] * balance.system.mass
    for transform, relaxation in relaxing_elements(balance):
        found = found + transform.T @ relaxation.slope(s) @ transform
    return np.asarray(found, dtype=np.complex128)


def system_film_states(balance: Equilibrium) -> FilmStates | None:
    """The relaxing films of all elements as few states in the coordinates of the system; None without any.

    They hold up to ten times the highest undamped frequency of slow motion.
    """
    found = []
    relaxing = relaxing_elements(balance)
    if relaxing:
        stiffness = 0.5 * (balance.stiffness + balance.stiffness.T)
        squares = eigh(stiffness, balance.system.mass, eigvals_only=True)
        highest = _BEYOND * float(np.sqrt(max(squares[-1], 0.0)))
    for transform, relaxation in relaxing:
        few = film_states(relaxation, highest)
        found.append(FilmStates(few.relaxation.seen_by(transform), few.lift, few.slowest))
    return together(found)


def relaxing_elements(balance: Equilibrium) -> list[tuple[FloatArray, Relaxation]]:
    """Elements that relax: how their ports follow the coordinates, and what relaxes."""
    return [
        (connected.transform, relaxation)
        for connected, relaxation in zip(balance.system.elements, balance.relaxations, strict=True)
        if relaxation is not None
    ]
