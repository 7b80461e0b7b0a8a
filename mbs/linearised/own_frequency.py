"""Each complex mode brought to the films of its own complex frequency, with all slices.

Modes of a system whose films are a few states are nearly those of all slices. What is left is the first-order change of
an eigenvalue; where that is not small, Newton's method solves Z(lambda) phi = 0 from there. A mode that it does not
find, or that it finds elsewhere, is lost, with the reason: it is in no result.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, ComplexArray
from mbs.linearised.dynamic import dynamic_slope, dynamic_stiffness, relaxing_elements
from mbs.linearised.film_states import FilmStates
from mbs.model.equilibrium import Equilibrium

SMALL = 1e-6
"""Change of an eigenvalue, as a part of it, up to which its first order is enough."""

FARTHEST = 0.05
"""Change of an eigenvalue, as a part of it, above which another mode was found."""

_CONVERGED = 1e-10
_STEPS = 20


class Reason(enum.Enum):
    """Why a mode is lost."""

    NOT_CONVERGED = "Newton's method does not converge"
    ELSEWHERE = "Newton's method leads to another mode"
    TWICE = "two modes become the same one"


class LostMode(NamedTuple):
    """A mode that could not be brought to the films of its own frequency.

    Attributes
    ----------
    eigenvalue : complex
        Place at which it was looked for [1/s].
    reason : Reason
        Why it is lost.
    """

    eigenvalue: complex
    reason: Reason


@dataclass(frozen=True, eq=False)
class OwnFrequency:
    """Modes at their own frequencies.

    Attributes
    ----------
    eigenvalues : array, shape (modes,)
        [1/s]; NaN for a mode that is lost.
    found : array of bool, shape (modes,)
        Which are not lost.
    lost : tuple of LostMode
        The others.
    """

    eigenvalues: ComplexArray
    found: BoolArray
    lost: tuple[LostMode, ...]


def at_own_frequency(
    balance: Equilibrium, films: FilmStates | None, eigenvalues: ComplexArray, right: ComplexArray, left: ComplexArray
) -> OwnFrequency:
    """Bring modes to their own frequency.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    films : FilmStates or None
        The films as a few states; None if nothing relaxes, so that nothing changes.
    eigenvalues : array, shape (modes,)
        Eigenvalues of the system with these states [1/s].
    right : array, shape (n, modes)
        Displacements of the right eigenvectors of the state.
    left : array, shape (modes, n)
        Velocities of the left ones, with left . right = 1 for the whole state.
    """
    values = eigenvalues.copy()
    if films is None:
        return OwnFrequency(values, np.ones(values.shape, dtype=np.bool_), ())
    change = _first_order(balance, films, eigenvalues, right, left)
    lost: dict[int, Reason] = {}
    searched = np.flatnonzero(~(np.abs(change) <= SMALL * np.abs(values)))
    start = values.copy()
    values += change
    for k in searched.tolist():
        found = newton(balance, complex(start[k]), right[:, k])
        if found is None:
            lost[k] = Reason.NOT_CONVERGED
        elif abs(found - start[k]) > FARTHEST * abs(start[k]):
            lost[k] = Reason.ELSEWHERE
        else:
            values[k] = found
            others = np.delete(values, [k, *lost])
            if np.any(np.abs(others - found) <= _CONVERGED * abs(found)):
                lost[k] = Reason.TWICE
    values[list(lost)] = complex(np.nan, np.nan)
    missing = tuple(LostMode(complex(start[k]), reason) for k, reason in sorted(lost.items()))
    return OwnFrequency(values, np.isfinite(values), missing)


def newton(balance: Equilibrium, eigenvalue: complex, shape: ComplexArray) -> complex | None:
    """Eigenvalue of Z(lambda) phi = 0 near a first guess; None if Newton's method does not converge.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    eigenvalue : complex
        First guess [1/s].
    shape : array, shape (n,)
        First guess of phi.
    """
    n = balance.system.size
    norm = shape.conj() / float(np.vdot(shape, shape).real)
    bordered = np.zeros((n + 1, n + 1), dtype=np.complex128)
    for _ in range(_STEPS):
        at = np.array([eigenvalue])
        matrix, slope = dynamic_stiffness(balance, at)[0], dynamic_slope(balance, at)[0]
        bordered[:n, :n], bordered[:n, n], bordered[n, :n] = matrix, slope @ shape, norm
        scale = 1.0 / np.max(np.abs(bordered), axis=1)
        try:
            step = np.linalg.solve(bordered * scale[:, None], scale * np.append(matrix @ shape, norm @ shape - 1.0))
        except np.linalg.LinAlgError:
            return None
        shape, eigenvalue = shape - step[:n], eigenvalue - complex(step[n])
        if not np.isfinite(eigenvalue):
            return None
        if abs(step[n]) <= _CONVERGED * abs(eigenvalue):
            return eigenvalue
    return None


def _first_order(
    balance: Equilibrium, films: FilmStates, eigenvalues: ComplexArray, right: ComplexArray, left: ComplexArray
) -> ComplexArray:
    """First-order change of eigenvalues from the films of a few states to all slices, shape (modes,) [1/s]."""
    differing = -films.relaxation.more_of(eigenvalues, right)
    for transform, relaxation in relaxing_elements(balance):
        differing = differing + transform.T @ relaxation.more_of(eigenvalues, transform @ right)
    return np.asarray(-np.sum(np.linalg.solve(balance.system.mass, left.T) * differing, axis=0))
