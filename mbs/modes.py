"""Modes at an equilibrium: complex eigenvalues, shapes, and where their strain energy is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh

from ehdmaps.physics._values import FloatArray
from mbs.linear import ComplexArray, state_space
from mbs.statics import Equilibrium

IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Modes:
    """Modes in the order of their frequency; one of each conjugate pair, and those that do not oscillate.

    Attributes
    ----------
    eigenvalues : array, shape (modes,)
        [1/s].
    shapes : array, shape (n, modes)
        Displacements, largest translation or modal coordinate 1, else largest entry 1.
    parts : tuple of str
        Flexible bodies, springs, elements.
    shares : array, shape (parts, modes)
        Part of the strain energy that each has; 0 everywhere for a mode without any.
    """

    eigenvalues: ComplexArray
    shapes: ComplexArray
    parts: tuple[str, ...]
    shares: FloatArray

    @property
    def frequency(self) -> FloatArray:
        """|eigenvalue|/(2 pi) [Hz]."""
        return np.asarray(np.abs(self.eigenvalues) / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> FloatArray:
        """-real part over magnitude; 0 for a free motion, 1 for one that creeps back."""
        size = np.abs(self.eigenvalues)
        return np.asarray(-self.eigenvalues.real / np.where(size > 0.0, size, 1.0))


def modes(balance: Equilibrium) -> Modes:
    """Modes of small motion about an equilibrium.

    Parameters
    ----------
    balance : Equilibrium
        Where; the gyroscopic terms are those of its speed.
    """
    n = balance.system.size
    values, vectors = np.linalg.eig(state_space(balance).A)
    # A pair of real eigenvalues is one overdamped freedom: both are kept, as is one of each conjugate pair.
    kept = values.imag >= 0.0
    values, shapes = values[kept], vectors[:n, kept]
    order = np.argsort(np.abs(values), kind="stable")
    values, shapes = values[order], shapes[:, order]
    translations = np.array([unit != "rad" for unit in balance.system.units])
    for k in range(shapes.shape[1]):
        column = shapes[:, k]
        size = np.abs(column)
        shown = np.where(translations, size, 0.0)
        # A tilting mode has hardly any translation: scale it by its tilt.
        largest = int(np.argmax(shown if shown.max() > 1e-6 * size.max() else size))
        shapes[:, k] = column / column[largest]
    return Modes(values, shapes, tuple(balance.parts), _shares(balance, shapes))


def _shares(balance: Equilibrium, shapes: ComplexArray) -> FloatArray:
    """Part of the strain energy of each part and shape, shape (parts, modes)."""
    parts = (*balance.parts.values(), np.diag(np.diag(balance.stiffness)))
    energy = np.array([np.einsum("ik,ij,jk->k", shapes.conj(), part, shapes).real for part in parts])
    total = energy[:-1].sum(axis=0)
    # A free motion strains nothing, to rounding.
    strained = total > 1e-9 * energy[-1]
    return np.asarray(np.where(strained, energy[:-1] / np.where(strained, total, 1.0), 0.0))


@dataclass(frozen=True, eq=False)
class UndampedModes:
    """Modes of mass and stiffness alone, as many as there are coordinates, in the order of their frequency.

    Attributes
    ----------
    frequency : array, shape (n,)
        [Hz]; zero for a free motion.
    damping_ratio : array, shape (n,)
        Modal damping ratio phi' C phi/(2 omega) for phi' M phi = 1; may exceed 1.
    shapes : array, shape (n, n)
        Columns phi, with phi' M phi = 1.
    parts : tuple of str
        Flexible bodies, springs, elements.
    shares : array, shape (parts, n)
        Part of the strain energy that each has.
    """

    frequency: FloatArray
    damping_ratio: FloatArray
    shapes: FloatArray
    parts: tuple[str, ...]
    shares: FloatArray


def undamped_modes(balance: Equilibrium) -> UndampedModes:
    """Modes of mass and stiffness, for systems whose damping is so strong that complex modes do not oscillate.

    Parameters
    ----------
    balance : Equilibrium
        Where. Gyroscopic terms are left out.
    """
    squares, shapes = eigh(0.5 * (balance.stiffness + balance.stiffness.T), balance.system.mass)
    omega = np.sqrt(np.maximum(squares, 0.0))
    modal = np.einsum("ik,ij,jk->k", shapes, balance.damping, shapes)
    ratio = np.where(omega > 0.0, modal / (2.0 * np.where(omega > 0.0, omega, 1.0)), 0.0)
    shares = _shares(balance, shapes.astype(np.complex128))
    return UndampedModes(omega / (2.0 * np.pi), ratio, shapes, tuple(balance.parts), shares)


def follow(before: ComplexArray | FloatArray, after: ComplexArray | FloatArray, mass: FloatArray) -> IntArray:
    """Which shape of `after` continues each shape of `before`, by the modal assurance criterion.

    Parameters
    ----------
    before, after : array, shape (n, modes)
        Shapes at neighbouring operating points.
    mass : array, shape (n, n)
        Weights translations against rotations.

    Returns
    -------
    array of int, shape (modes of before,)
        Index in `after`; each is given away once, best matches first; -1 where none is left.
    """
    cross = np.abs(before.conj().T @ mass @ after) ** 2
    sizes = [np.einsum("ik,ij,jk->k", shapes.conj(), mass, shapes).real for shapes in (before, after)]
    assurance = cross / np.outer(*sizes)
    chosen = np.full(before.shape[1], -1)
    for _ in range(min(assurance.shape)):
        i, j = np.unravel_index(int(np.argmax(assurance)), assurance.shape)
        chosen[i] = j
        assurance[i, :] = assurance[:, j] = -1.0
    return chosen
