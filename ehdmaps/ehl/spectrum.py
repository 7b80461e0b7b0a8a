"""Film compliance over frequency: one Krylov space of the linearised equations serves all frequencies.

A load that oscillates with Omega = omega b/u moves the unknowns by (A + i Omega B) z = e. With T = A^-1 B this is
(I + i Omega T) z = A^-1 e. T is real and the same for every Omega, so that the Krylov space of T and A^-1 e holds the
solutions at all of them: V' (I + i Omega H) y = |A^-1 e| e_1, z = V y, with the small Hessenberg matrix H of Arnoldi's
process (W. E. Arnoldi, Quart. Appl. Math. 9 (1951) 17-29). 10 to 50 vectors reach round-off. Where frequencies are so
high that they do not, the space grows to that of all unknowns, which is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.dense import solved
from ehdmaps.ehl.linearisation import Arrays, Linearisation, storage, unit_load
from ehdmaps.physics.hertz import DRY_COMPLIANCE

SMALL_RESIDUAL = 1e-13
"""Residual at which the space is large enough, relative to the static response."""

CHECK_EVERY = 3
"""Vectors that are added between two looks at the residual."""

MOST_VECTORS, LITTLE_RESIDUAL = 150, 1e-9
"""Vectors of the space of equations that are known by what they do, and the residual at which it is large enough."""

_TINY = float(np.finfo(float).tiny)


class Followed(Protocol):
    """Equations of a film with more than its own unknowns, that make their space themselves."""

    def space(self, fastest: float) -> FilmSpace:
        """Return the Krylov space that serves all frequencies up to a highest one, Omega."""
        ...


def film_compliances(linear: Linearisation | Followed, frequencies: FloatArray) -> ComplexArray:
    """Complex film compliance S = -dH0/dW - ln(2)/pi; S = compliance - i Omega loss for slow motion.

    Parameters
    ----------
    linear : Linearisation or Followed
        The equations about a steady solution.
    frequencies : ndarray, shape (k,)
        Omega = omega b/u, > 0.

    Returns
    -------
    ndarray, shape (k,)
        Film compliances in units of b/(p_H R).
    """
    fastest = float(np.max(frequencies))
    space = film_space(linear, fastest) if isinstance(linear, Linearisation) else linear.space(fastest)
    return space.compliances(np.ascontiguousarray(frequencies, dtype=float))


@dataclass(frozen=True, eq=False)
class FilmSpace:
    """The Krylov space of a film, projected: what gives its compliance at any frequency, real or complex.

    Attributes
    ----------
    norm : float
        Length of the static response.
    hessenberg : ndarray, shape (n, n)
        T in the space.
    heights : ndarray, shape (n,)
        H0 of its vectors.
    """

    norm: float
    hessenberg: FloatArray
    heights: FloatArray

    def compliances(self, frequencies: FloatArray | ComplexArray) -> ComplexArray:
        """Film compliances S in units of b/(p_H R) at Omega = omega b/u, shape (k,).

        Parameters
        ----------
        frequencies : ndarray, shape (k,)
            Frequencies Omega; complex for a motion e^(lambda t), -i lambda b/u. With a size up to that of which the
            space was made.
        """
        return np.asarray(-self.motions(frequencies) - DRY_COMPLIANCE)

    def motions(self, frequencies: FloatArray | ComplexArray) -> ComplexArray:
        """H0 by a load of one, over frequency, shape (k,).

        Parameters
        ----------
        frequencies : ndarray, shape (k,)
            Frequencies as of `compliances`.
        """
        return np.asarray(self.norm * _projected(self.hessenberg, self.heights.size, self.heights, frequencies))


def film_space(linear: Linearisation, fastest: float) -> FilmSpace:
    """Return the Krylov space that serves all frequencies up to a highest one.

    Parameters
    ----------
    linear : Linearisation
        The equations about a steady solution.
    fastest : float
        Highest Omega = omega b/u.
    """
    return FilmSpace(*_space(linear.arrays, fastest))


def arnoldi(step: Callable[[FloatArray], FloatArray], static: FloatArray, height: int, fastest: float) -> FilmSpace:
    """Return the Krylov space of equations that are known by what they do.

    Parameters
    ----------
    step : callable
        T z of a state z, shape (size,).
    static : ndarray, shape (size,)
        Static response A^-1 e.
    height : int
        Index of H0 in a state.
    fastest : float
        Highest Omega = omega b/u.
    """
    norm, most = float(np.linalg.norm(static)), min(static.size, MOST_VECTORS)
    basis, hessenberg = np.empty((most + 1, static.size)), np.zeros((most + 1, most))
    basis[0] = static / norm
    count = 0
    while count < most:
        orthogonalised(step(basis[count]), basis, hessenberg, count)
        count += 1
        if _residual(hessenberg, count, fastest) < LITTLE_RESIDUAL or hessenberg[count, count - 1] < _TINY:
            break
    return FilmSpace(norm, hessenberg[:count, :count].copy(), basis[:count, height].copy())


@njit
def _space(linear: Arrays, fastest: float) -> tuple[float, FloatArray, FloatArray]:
    """Length of the static response, T in the space of its vectors, and H0 of these."""
    static = solved(linear.lu, unit_load(linear))
    norm = float(np.linalg.norm(static))
    size, height = static.size, linear.x.size
    basis = np.empty((size + 1, size))
    hessenberg = np.zeros((size + 1, size))
    basis[0] = static / norm
    count = 0
    for last in range(size):  # an index of numba's own: for the literal 0 it would compile `_extend` once more
        _extend(linear, basis, hessenberg, last)
        count = last + 1
        if count % CHECK_EVERY == 0 and _residual(hessenberg, count, fastest) < SMALL_RESIDUAL:
            break
        if hessenberg[count, last] < _TINY:
            break
    return norm, hessenberg[:count, :count].copy(), basis[:count, height].copy()


@njit
def _extend(linear: Arrays, basis: FloatArray, hessenberg: FloatArray, count: int) -> None:
    """Add T times the last vector to the basis, orthogonal to all before it."""
    orthogonalised(solved(linear.lu, storage(linear, basis[count])), basis, hessenberg, count)


@njit
def orthogonalised(vector: FloatArray, basis: FloatArray, hessenberg: FloatArray, count: int) -> None:
    """Add a vector to the basis, orthogonal to all before it; twice, for round-off.

    Parameters
    ----------
    vector : ndarray, shape (size,)
        The vector; it is changed.
    basis : ndarray, shape (at least count + 2, size)
        Vectors so far; it comes after them.
    hessenberg : ndarray, shape (at least count + 2, at least count + 1)
        What is along each, and its length; the column has to be zero.
    count : int
        Index of the last vector.
    """
    for _ in range(2):
        along = basis[: count + 1] @ vector
        for i in range(count + 1):
            hessenberg[i, count] += along[i]
        vector -= along @ basis[: count + 1]
    length = float(np.linalg.norm(vector))
    hessenberg[count + 1, count] = length
    basis[count + 1] = vector / max(length, _TINY)


@njit
def _residual(hessenberg: FloatArray, count: int, frequency: float) -> float:
    """Residual that the space leaves in the equations at a frequency, relative to the static response."""
    last = abs(_reduced(hessenberg, count, frequency)[count - 1])
    return float(frequency * hessenberg[count, count - 1] * last)


@njit
def _projected(
    hessenberg: FloatArray, count: int, heights: FloatArray, frequencies: FloatArray | ComplexArray
) -> ComplexArray:
    """H0 of the reduced equations at each frequency, for a start of length one."""
    responses = np.empty(frequencies.size, dtype=np.complex128)
    for i in range(frequencies.size):
        solution = _reduced(hessenberg, count, frequencies[i])
        total = 0.0 + 0.0j
        for k in range(count):
            total += solution[k] * heights[k]
        responses[i] = total
    return responses


@njit
def _reduced(hessenberg: FloatArray, count: int, frequency: complex) -> ComplexArray:
    """Solve (I + i Omega H) y = e_1 by elimination: a Hessenberg matrix has one entry a column to eliminate."""
    matrix = 1j * frequency * hessenberg[:count, :count]
    right = np.zeros(count, dtype=np.complex128)
    right[0] = 1.0
    for k in range(count):
        matrix[k, k] += 1.0
    for k in range(count - 1):
        if abs(matrix[k + 1, k]) > abs(matrix[k, k]):
            for j in range(k, count):
                matrix[k, j], matrix[k + 1, j] = matrix[k + 1, j], matrix[k, j]
            right[k], right[k + 1] = right[k + 1], right[k]
        factor = matrix[k + 1, k] / matrix[k, k]
        if factor != 0.0:
            for j in range(k + 1, count):
                matrix[k + 1, j] -= factor * matrix[k, j]
            right[k + 1] -= factor * right[k]
    for k in range(count - 1, -1, -1):
        total = right[k]
        for j in range(k + 1, count):
            total -= matrix[k, j] * right[j]
        right[k] = total / matrix[k, k]
    return right
