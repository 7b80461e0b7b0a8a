"""The dynamic stiffness of a system at any frequency, real or complex, and films that relax in states and modes.

Films that relax, as states of a linear system: few of them, and as exact as all slices.

Thousands of slices relax, but what they add to a bearing is a matrix of its few ports,

    F(s) = V' (1 + s Theta)^-1 V,    rows v of V and times Theta of `mbs.model.relaxation`.

Projected on the space of V and of both parts of (1 + i w_j Theta)^-1 V for some frequencies w_j, F and its derivative
are exact at s = 0 and at each i w_j (rational Krylov). The projected Theta has its eigenvalues among those of Theta, so
that what is left are springs in series with dampers again: they take up energy at every frequency. The w_j are placed
where F is worst on the frequency axis, until it is within `TOLERANCE` of all slices there.

The dynamic stiffness of a system at any frequency, real or complex, with films that relax or without.

Z(s) = M s^2 + (D + speed G) s + K + what relaxing films add,    exactly, with all slices.

Without relaxing films Z is that of stiffness and damping of slow motion.

Each complex mode brought to the films of its own complex frequency, with all slices.

Modes of a system whose films are a few states are nearly those of all slices. What is left is the first-order change of
an eigenvalue; where that is not small, Newton's method solves Z(lambda) phi = 0 from there. A mode that it does not
find, or that it finds elsewhere, is lost, with the reason: it is in no result.
"""

from __future__ import annotations

import dataclasses
import enum
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag, eigh, svd

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray
from mbs.model.equilibrium import Equilibrium
from mbs.model.relaxation import Relaxation

TOLERANCE, COARSE = 1e-8, 1e-4
"""Error of F on the frequency axis, as a part of F(0): of results, and of looks that change them by some per cent."""

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
    tolerance : float
        Error of F on the frequency axis, as a part of F(0).
    """

    relaxation: Relaxation
    lift: FloatArray
    slowest: float = 0.0
    tolerance: float = TOLERANCE

    @property
    def size(self) -> int:
        """Number q of the few."""
        return self.relaxation.times.size


def film_states(relaxation: Relaxation, highest: float = math.inf, tolerance: float = TOLERANCE) -> FilmStates:
    """Reduce springs in series with dampers to few that act alike.

    Parameters
    ----------
    relaxation : Relaxation
        All of them, in ports that are few.
    highest : float
        Frequency up to which they do [rad/s].
    tolerance : float
        Error of F on the frequency axis, as a part of F(0).
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
        few_times, turned = np.linalg.eigh(0.5 * (few + few.T))
        error = np.abs(_transfer((begin.T @ space @ turned).T, few_times, omega) - exact).max(axis=(1, 2))
        if error.max() <= tolerance or space.shape[1] >= times.size or poles == _MOST_POLES:
            break
        place = omega[int(np.argmax(error))] * times
        seen = begin / (1.0 + place**2)[:, None]
        space = _extended(space, np.hstack([seen, place[:, None] * seen]))
    lift = space @ turned
    slowest = float(times[np.any(rows != 0.0, axis=1)].max())
    return FilmStates(Relaxation(lift.T @ begin @ ports, few_times), lift, slowest, tolerance)


def together(parts: Iterable[FilmStates]) -> FilmStates | None:
    """The films of several elements, seen by the same coordinates, as one; None if there are none."""
    given = list(parts)
    if not given:
        return None
    rows = np.concatenate([part.relaxation.rows for part in given])
    times = np.concatenate([part.relaxation.times for part in given])
    lift = np.asarray(block_diag(*(part.lift for part in given)), dtype=np.float64)
    slowest, tolerance = (max(getattr(part, name) for part in given) for name in ("slowest", "tolerance"))
    return FilmStates(Relaxation(rows, times), lift, slowest, tolerance)


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
    stiffness = balance.element_stiffness[index] + s[:, None, None] * balance.element_damping[index]
    relaxation = balance.relaxations[index]
    return np.asarray(stiffness if relaxation is None else stiffness + relaxation.more(s), dtype=np.complex128)


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
    stiffness = place * balance.system.mass
    stiffness += balance.damping
    stiffness *= place
    stiffness += balance.stiffness
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
        stiffness.real += transform.T @ np.ascontiguousarray(more.real) @ transform
        stiffness.imag += transform.T @ np.ascontiguousarray(more.imag) @ transform
    return np.asarray(stiffness, dtype=np.complex128)


def dynamic_slope(balance: Equilibrium, s: ComplexArray) -> ComplexArray:
    """Derivative of `dynamic_stiffness` by s, shape (k, n, n); arguments as there."""
    slope = balance.damping + 2.0 * s[:, None, None] * balance.system.mass
    for transform, relaxation in relaxing_elements(balance):
        slope = slope + transform.T @ relaxation.slope(s) @ transform
    return np.asarray(slope, dtype=np.complex128)


def system_film_states(balance: Equilibrium, tolerance: float = TOLERANCE) -> FilmStates | None:
    """The relaxing films of all elements as few states in the coordinates of the system; None without any.

    They hold up to ten times the highest undamped frequency of slow motion, within a part of the films.
    """
    states = []
    relaxing = relaxing_elements(balance)
    if relaxing:
        stiffness = 0.5 * (balance.stiffness + balance.stiffness.T)
        squares = eigh(stiffness, balance.system.mass, eigvals_only=True)
        highest = _BEYOND * float(np.sqrt(max(squares[-1], 0.0)))
    for transform, relaxation in relaxing:
        few = film_states(relaxation, highest, tolerance)
        states.append(dataclasses.replace(few, relaxation=few.relaxation.seen_by(transform)))
    return together(states)


def relaxing_elements(balance: Equilibrium) -> list[tuple[FloatArray, Relaxation]]:
    """Elements that relax: how their ports follow the coordinates, and what relaxes."""
    return [
        (connected.transform, relaxation)
        for connected, relaxation in zip(balance.system.elements, balance.relaxations, strict=True)
        if relaxation is not None
    ]


_SMALL = 1e-2
"""Change of an eigenvalue, as a part of it and of the root of the films' error, up to which its first order does: what
is left is a ten-thousandth of that error."""

FARTHEST = 0.05
"""Change of an eigenvalue, as a part of it, above which another mode was found."""

_CONVERGED = 1e-10
_STEPS = 20


class Reason(enum.Enum):
    """Reason why a mode is lost."""

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
    reasons: dict[int, Reason] = {}
    searched = np.flatnonzero(~(np.abs(change) <= _SMALL * math.sqrt(films.tolerance) * np.abs(values)))
    start = values.copy()
    values += change
    for k in searched.tolist():
        eigenvalue = newton(balance, complex(start[k]), right[:, k])
        if eigenvalue is None:
            reasons[k] = Reason.NOT_CONVERGED
        elif abs(eigenvalue - start[k]) > FARTHEST * abs(start[k]):
            reasons[k] = Reason.ELSEWHERE
        else:
            values[k] = eigenvalue
            others = np.delete(values, [k, *reasons])
            if np.any(np.abs(others - eigenvalue) <= _CONVERGED * abs(eigenvalue)):
                reasons[k] = Reason.TWICE
    values[list(reasons)] = complex(np.nan, np.nan)
    missing = tuple(LostMode(complex(start[k]), reason) for k, reason in sorted(reasons.items()))
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
