"""Modes at an equilibrium: eigenvalues, shapes, and where their strain energy is.

Complex modes have all of damping and gyroscopic terms; undamped ones neither, for systems whose films damp so strongly
that complex modes become overdamped.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray
from ehdmaps.errors import AnalysisError
from mbs.model.equilibrium import Equilibrium

FREE = 1e-6
"""Part of the highest undamped frequency below which a motion counts as free when states are scaled."""

_REAL = 1e-6


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
        return damping_ratio(self.eigenvalues)


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


@dataclass(frozen=True, eq=False)
class StateModes:
    """All eigenvalues of small motion, with right and left vectors of the state (displacement, then velocity).

    Attributes
    ----------
    eigenvalues : array, shape (2 n,)
        [1/s].
    right : array, shape (2 n, 2 n)
        Right eigenvectors in columns, of size 1 where potential and kinetic energy measure the size.
    left : array, shape (2 n, 2 n)
        Rows, with left @ right = 1.
    oscillates : array of bool, shape (2 n,)
        One of each conjugate pair.
    """

    eigenvalues: ComplexArray
    right: ComplexArray
    left: ComplexArray
    oscillates: BoolArray


def damping_ratio(eigenvalues: ComplexArray) -> FloatArray:
    """-real part over magnitude of eigenvalues of any shape [1/s]; 0 where the eigenvalue is 0."""
    size = np.abs(eigenvalues)
    return np.asarray(-eigenvalues.real / np.where(size > 0.0, size, 1.0))


def modes(balance: Equilibrium) -> Modes:
    """Modes of small motion about an equilibrium.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at; the gyroscopic terms are those of its speed.

    Raises
    ------
    AnalysisError
        If a stiffness or damping is not finite.
    """
    n = balance.system.size
    states = state_modes(balance, undamped_modes(balance))
    # A pair of real eigenvalues is one overdamped freedom: both are kept, as is one of each conjugate pair.
    kept = states.eigenvalues.imag >= 0.0
    values, shapes = states.eigenvalues[kept], states.right[:n, kept]
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
    return Modes(values, shapes, tuple(balance.parts), energy_shares(balance, shapes))


def undamped_modes(balance: Equilibrium) -> UndampedModes:
    """Modes of mass and stiffness.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at. Gyroscopic terms are left out.

    Raises
    ------
    AnalysisError
        If a stiffness or damping is not finite.
    """
    if not (np.all(np.isfinite(balance.stiffness)) and np.all(np.isfinite(balance.damping))):
        raise AnalysisError(
            f"modes: a stiffness or damping at the equilibrium is not finite (speed {balance.operation.speed:.6g} "
            "rad/s); look at the laws of the bearings and springs"
        )
    squares, shapes = eigh(0.5 * (balance.stiffness + balance.stiffness.T), balance.system.mass)
    omega = np.sqrt(np.maximum(squares, 0.0))
    modal = np.sum(shapes * (balance.damping @ shapes), axis=0)
    ratio = np.where(omega > 0.0, modal / (2.0 * np.where(omega > 0.0, omega, 1.0)), 0.0)
    return UndampedModes(omega / (2.0 * np.pi), ratio, shapes, tuple(balance.parts), energy_shares(balance, shapes))


def state_modes(balance: Equilibrium, undamped: UndampedModes) -> StateModes:
    """Solve the complex eigenproblem of the state in full.

    It is solved for the state (omega eta, eta') of the undamped modes eta, whose size is its energy: there the matrix
    is skew but for the damping, so that eigenvalues are as accurate as their physics lets them be.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at; the gyroscopic terms are those of its speed.
    undamped : UndampedModes
        Undamped modes of the same equilibrium.
    """
    n = balance.system.size
    phi = undamped.shapes
    omega = 2.0 * np.pi * undamped.frequency
    highest = float(omega.max(initial=0.0))
    scale = np.maximum(omega, FREE * highest if highest > 0.0 else 1.0)
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:] = np.diag(scale)
    matrix[n:, :n] = -(phi.T @ balance.stiffness @ phi) / scale
    matrix[n:, n:] = -(phi.T @ balance.damping @ phi)
    values, right = (np.asarray(part, dtype=np.complex128) for part in np.linalg.eig(matrix))
    try:
        left = np.linalg.inv(right)
    except np.linalg.LinAlgError:
        # Two eigenvectors are one, as in critical damping; the left ones are then those of the least squares.
        left = np.linalg.pinv(right)
    back = phi.T @ balance.system.mass
    to_space = np.vstack([phi @ (right[:n] / scale[:, None]), phi @ right[n:]])
    from_space = np.hstack([(left[:, :n] * scale) @ back, left[:, n:] @ back])
    oscillates = values.imag > _REAL * np.abs(values) + 0.1 * _REAL * highest
    return StateModes(values, to_space, from_space, oscillates)


def energy_shares(balance: Equilibrium, shapes: ComplexArray | FloatArray) -> FloatArray:
    """Part of the strain energy of each part and shape, shape (parts, modes); 0 for shapes that strain nothing.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium, with the stiffness of each part.
    shapes : array, shape (n, modes)
        Real or complex displacements.
    """
    parts = (*balance.parts.values(), np.diag(np.diag(balance.stiffness)))
    energy = np.array([np.sum(shapes.conj() * (part @ shapes), axis=0).real for part in parts])
    total = energy[:-1].sum(axis=0)
    # A free motion strains nothing, to rounding.
    strained = total > 1e-9 * energy[-1]
    return np.asarray(np.where(strained, energy[:-1] / np.where(strained, total, 1.0), 0.0))
