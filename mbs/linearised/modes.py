"""Modes at an equilibrium: eigenvalues, shapes, and where their strain energy is.

Complex modes have all of damping and gyroscopic terms; undamped ones neither, for systems whose films damp so strongly
that complex modes become overdamped.

Where films relax, each complex mode is one of the nonlinear eigenproblem Z(lambda) phi = 0, with the stiffness and
damping that the films have at its own complex frequency. All of them are found together, as those of a linear system
with some states for the films (`mbs.linearised.dynamic`), and each is then brought to all slices
(`mbs.linearised.dynamic`). Undamped modes have the stiffness of slow motion, which does not relax.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from ehdmaps.errors import AnalysisError
from mbs.linearised.bands import ModeBands, law_bands, with_reduction
from mbs.linearised.dynamic import (
    COARSE,
    TOLERANCE,
    FilmStates,
    LostMode,
    OwnFrequency,
    at_own_frequency,
    system_film_states,
)
from mbs.linearised.film_part import film_law_part, film_part
from mbs.linearised.mode_part import ModePart
from mbs.linearised.reduction import reduction_part
from mbs.model.equilibrium import Equilibrium

FREE = 1e-6
"""Part of the highest undamped frequency below which a motion counts as free when states are scaled."""

_REAL = 1e-6

_FREE_ALONE, _NO_FREQUENCY = 1e-6, 1e-8
"""Parts of the highest frequency below which a motion without strain energy is free, and below which any is."""


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
        Part of the strain energy that each has; 0 everywhere for a mode without any. Films that relax count with their
        stiffness at the frequency of the mode.
    lost : tuple of LostMode
        Modes that could not be brought to the films of their own frequency; they are in no array.
    among_films : int
        Motions that do not oscillate and are as quick as films relax. They cannot be told from these, and are in no
        array.
    bands : ModeBands or None
        What errors of known size may change, see `mbs.linearised.bands`; None for laws that state none.
    film_law : ModePart or None
        What films with memory leave out, see `mbs.linearised.film_part`; None where that is not known.
    reduction : ModePart or None
        What modes of bodies leave out that are not kept, see `mbs.linearised.reduction`; its size is in the bands, too.
        None where no body is reduced, or none tells.
    """

    eigenvalues: ComplexArray
    shapes: ComplexArray
    parts: tuple[str, ...]
    shares: FloatArray
    lost: tuple[LostMode, ...] = ()
    among_films: int = 0
    bands: ModeBands | None = None
    film_law: ModePart | None = None
    reduction: ModePart | None = None

    @property
    def frequency(self) -> FloatArray:
        """|eigenvalue|/(2 pi) [Hz]."""
        return np.asarray(np.abs(self.eigenvalues) / (2.0 * np.pi))

    @property
    def free(self) -> BoolArray:
        """True for free motions, as of unloaded rollers, whose eigenvalues are round-off, shape (modes,)."""
        return free_motions(self.frequency, self.shares.sum(axis=0) > 0.0)

    @property
    def damping_ratio(self) -> FloatArray:
        """-real part over magnitude; 0 for a free motion, 1 for one that creeps back."""
        return np.where(self.free, 0.0, damping_ratio(self.eigenvalues))


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
    """All eigenvalues of small motion, with right and left vectors of the state.

    The state is the displacement (n), the velocity (n) and, where films relax, their forces by the roots of their
    springs (q); N = 2 n + q.

    Attributes
    ----------
    eigenvalues : array, shape (N,)
        [1/s].
    right : array, shape (N, N)
        Right eigenvectors in columns, of size 1 where potential and kinetic energy measure the size.
    left : array, shape (N, N)
        Rows, with left @ right = 1.
    oscillates : array of bool, shape (N,)
        One of each conjugate pair.
    films : FilmStates or None
        The films that relax; None if there are none.
    """

    eigenvalues: ComplexArray
    right: ComplexArray
    left: ComplexArray
    oscillates: BoolArray
    films: FilmStates | None = None

    @property
    def among_films(self) -> BoolArray:
        """True for modes that do not oscillate and are at least as quick as the slowest film relaxes, shape (N,)."""
        if self.films is None or not self.films.size:
            return np.zeros(self.eigenvalues.shape, dtype=np.bool_)
        still = np.abs(self.eigenvalues.imag) <= _REAL * np.abs(self.eigenvalues)
        return np.asarray(still & (self.eigenvalues.real <= -(1.0 - _REAL) / self.films.slowest))

    def comparable(self, which: IntArray) -> tuple[ComplexArray, ComplexArray]:
        """Right and left vectors of some modes in a state that is the same at every speed: of all slices of the films.

        Shapes (2 n + r, modes) and (modes, 2 n + r), for r slices; the few states of the films differ from speed to
        speed.
        """
        right, left = self.right[:, which], self.left[which]
        if self.films is None:
            return right, left
        lift = self.films.lift
        begin = right.shape[0] - lift.shape[1]
        return np.vstack([right[:begin], lift @ right[begin:]]), np.hstack([left[:, :begin], left[:, begin:] @ lift.T])

    def at_own_frequency(self, balance: Equilibrium, which: IntArray) -> OwnFrequency:
        """Some of the modes, brought to all slices of the films at their own frequencies."""
        n = balance.system.size
        return at_own_frequency(
            balance, self.films, self.eigenvalues[which], self.right[:n, which], self.left[which, n : 2 * n]
        )


def free_motions(frequency: FloatArray, strained: BoolArray | bool = True) -> BoolArray:
    """Find the motions that nothing holds: their frequency is 0 but for round-off, of any sign of their damping.

    Parameters
    ----------
    frequency : array, shape (modes,)
        |eigenvalue|/(2 pi) [Hz].
    strained : array of bool, shape (modes,), or bool
        Which have strain energy; those without any are free at higher frequencies already.
    """
    part = frequency / max(float(np.nanmax(frequency, initial=0.0)), 1e-300)
    return np.asarray((part <= _NO_FREQUENCY) | (~np.asarray(strained) & (part <= _FREE_ALONE)))


def damping_ratio(eigenvalues: ComplexArray) -> FloatArray:
    """-real part over magnitude of eigenvalues of any shape [1/s]; 0 where the eigenvalue is 0."""
    size = np.abs(eigenvalues)
    return np.asarray(-eigenvalues.real / np.where(size > 0.0, size, 1.0))


def modes(balance: Equilibrium, errors: bool = True) -> Modes:
    """Modes of small motion about an equilibrium.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at; the gyroscopic terms are those of its speed.
    errors : bool
        Whether it is found, too, what errors of known size change. Without them, and with films of few states that are
        `COARSE` and corrected, modes take a third of the time, and are as exact to 1e-7 of their frequencies.

    Raises
    ------
    AnalysisError
        If a stiffness or damping is not finite.
    """
    states = state_modes(balance, undamped_modes(balance), TOLERANCE if errors else COARSE)
    return modes_of(balance, states, errors)


def modes_of(balance: Equilibrium, states: StateModes, errors: bool = True) -> Modes:
    """Modes of small motion from all eigenvalues of the state.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    states : StateModes
        What `state_modes` finds there.
    errors : bool
        The same as for `modes`.
    """
    n = balance.system.size
    # A pair of real eigenvalues is one overdamped freedom: both are kept, as is one of each conjugate pair.
    among = states.among_films
    kept = np.flatnonzero((states.eigenvalues.imag >= 0.0) & ~among)
    own = states.at_own_frequency(balance, kept)
    values, kept = own.eigenvalues[own.found], kept[own.found]
    order = np.argsort(np.abs(values), kind="stable")
    values, kept = values[order], kept[order]
    shapes = states.right[:n, kept]
    bands, film_law, reduction = None, None, None
    if errors:
        laws, left = law_bands(balance), states.left[kept, n : 2 * n]
        reduction = reduction_part(balance.system, values, shapes, left)
        bands = None if laws is None else with_reduction(laws.of_modes(values, shapes, left), reduction)
        film_law = film_law_part(film_part(balance) if laws is None else laws.films, values, shapes, left)
    translations = np.array([unit != "rad" for unit in balance.system.units])
    for k in range(shapes.shape[1]):
        column = shapes[:, k]
        size = np.abs(column)
        shown = np.where(translations, size, 0.0)
        # A tilting mode has hardly any translation: scale it by its tilt.
        largest = int(np.argmax(shown if shown.max() > 1e-6 * size.max() else size))
        shapes[:, k] = column / column[largest]
    shares = energy_shares(balance, shapes, np.abs(values))
    count = int(np.count_nonzero(among))
    return Modes(values, shapes, tuple(balance.parts), shares, own.lost, count, bands, film_law, reduction)


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


def state_modes(balance: Equilibrium, undamped: UndampedModes, tolerance: float = TOLERANCE) -> StateModes:
    """Solve the complex eigenproblem of the state in full.

    It is solved for the state (omega eta, eta') of the undamped modes eta, whose size is its energy: there the matrix
    is skew but for the damping, so that eigenvalues are as accurate as their physics lets them be.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at; the gyroscopic terms are those of its speed.
    undamped : UndampedModes
        Undamped modes of the same equilibrium.
    tolerance : float
        Error of films that are a few states, see `mbs.linearised.dynamic.film_states`.
    """
    n = balance.system.size
    phi = undamped.shapes
    films = system_film_states(balance, tolerance)
    omega = 2.0 * np.pi * undamped.frequency
    highest = float(omega.max(initial=0.0))
    scale = np.maximum(omega, FREE * highest if highest > 0.0 else 1.0)
    size = 2 * n + (films.size if films else 0)
    damping = balance.damping if films is None else balance.damping - films.relaxation.damping
    matrix = np.zeros((size, size))
    matrix[:n, n : 2 * n] = np.diag(scale)
    matrix[n : 2 * n, :n] = -(phi.T @ balance.stiffness @ phi) / scale
    matrix[n : 2 * n, n : 2 * n] = -(phi.T @ damping @ phi)
    if films is not None:
        # A spring in series with a damper, e = v x theta s/(1 + theta s): its stretch is energy too.
        matrix[2 * n :, n : 2 * n] = films.relaxation.rows @ phi
        matrix[n : 2 * n, 2 * n :] = -matrix[2 * n :, n : 2 * n].T
        matrix[2 * n :, 2 * n :] = -np.diag(1.0 / films.relaxation.times)
    values, right = (np.asarray(part, dtype=np.complex128) for part in np.linalg.eig(matrix))
    try:
        left = np.linalg.inv(right)
    except np.linalg.LinAlgError:
        # Two eigenvectors are one, as in critical damping; the left ones are then those of the least squares.
        left = np.linalg.pinv(right)
    back = phi.T @ balance.system.mass
    to_space = np.vstack([phi @ (right[:n] / scale[:, None]), phi @ right[n : 2 * n], right[2 * n :]])
    from_space = np.hstack([(left[:, :n] * scale) @ back, left[:, n : 2 * n] @ back, left[:, 2 * n :]])
    oscillates = values.imag > _REAL * np.abs(values) + 0.1 * _REAL * highest
    return StateModes(values, to_space, from_space, oscillates, films)


def energy_shares(
    balance: Equilibrium, shapes: ComplexArray | FloatArray, omega: FloatArray | None = None
) -> FloatArray:
    """Part of the strain energy of each part and shape, shape (parts, modes); 0 for shapes that strain nothing.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium, with the stiffness of each part.
    shapes : array, shape (n, modes)
        Real or complex displacements.
    omega : array, shape (modes,), optional
        Frequency of each shape [rad/s], for films that relax; that of slow motion if left out.
    """
    parts = (*balance.parts.values(), np.diag(np.diag(balance.stiffness)))
    energy = np.array([np.sum(shapes.conj() * (part @ shapes), axis=0).real for part in parts])
    if omega is not None:
        names = list(balance.parts)
        for connected, relaxation in zip(balance.system.elements, balance.relaxations, strict=True):
            if relaxation is not None:
                place = np.multiply.outer(relaxation.times, omega) ** 2
                stretched = np.abs(relaxation.rows @ connected.transform @ shapes) ** 2
                energy[names.index(connected.element.name)] += np.sum(stretched * place / (1.0 + place), axis=0)
    total = energy[:-1].sum(axis=0)
    # A free motion strains nothing, to rounding.
    strained = total > 1e-9 * energy[-1]
    return np.asarray(np.where(strained, energy[:-1] / np.where(strained, total, 1.0), 0.0))
