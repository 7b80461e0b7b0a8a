"""Effect of errors of known size on what a linear analysis finds: first derivatives, and sums of their sizes.

They are the errors that a map states, and what films with memory leave out.

A contact law is the approach, the stiffness and the damping at each load. Each may be wrong by its bound
(`ehdmaps.maps.law_errors`), at all loads of a bearing with the same sign, which makes three changes a bearing:

- stiffness: k of each contact by its bound, at the load that it has;
- damping: c likewise;
- film: each film thicker by its bound, which shifts the equilibrium, hence the loads, hence k and c.

Each changes the dynamic stiffness Z(s) of the system by dZ(s). To first order an eigenvalue then moves by

    d lambda = -y' dZ(lambda) x,    with y' Z'(lambda) x = 1,

and a response by dH = -S Z^-1 dZ Z^-1 B. dZ(s) of a bearing, whose rolling elements are in balance between their
contacts, is that of `mbs.model.condensed`. A slice with a film that relaxes has Z = k + s c/(1 + s theta) with
theta = c/(k_s - k); k_s, the stiffness of the locked film, is held.

A band is the sum of the sizes of these changes: of the three kinds, and over the bearings, which share the errors of
one map. That is the largest change to first order that the bounds allow. Films with memory leave out a part that
depends on the frequency, see `mbs.linearised.film_part`: the size of it for all bearings together, and that of its
possible error, are added to bands of modes and responses. Undamped modes and k and c of bearings are those of slow
motion, of which they leave out nothing.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from mbs.linearised.film_part import CondensedBearing, FilmPart, condensed_bearings, film_part
from mbs.linearised.mode_part import ModePart
from mbs.model.contacts import LAW_CHANGES
from mbs.model.elements import OnRings
from mbs.model.equilibrium import Equilibrium
from mbs.model.on_rings import ring_following

KINDS = LAW_CHANGES
"""Kinds of changes, in the order in which each bearing has them."""

_PER_DECADE = 12
"""Frequencies of a decade at which the change of a dynamic stiffness is worked out, for cubic splines between them.
Each slice turns from damper to spring over about a decade, so that they are right within a thousandth."""

_SOFT = 1e-9
"""Mass that is added to a singular stiffness, in squares of its mean frequency, as where an equilibrium is sought."""


class ModeBands(NamedTuple):
    """Bands of modes, either way, shape (modes,) each.

    Attributes
    ----------
    frequency : array
        Bands of |eigenvalue|/(2 pi) [Hz].
    damping_ratio : array
        Bands of the damping ratio.
    by_films : array, shape (2, modes)
        Part of both that is what films with memory leave out; 0 of motions that do not oscillate, and of other films.
    """

    frequency: FloatArray
    damping_ratio: FloatArray
    by_films: FloatArray

    @property
    def film_share(self) -> float:
        """Median part of bands of damping ratios that is what films with memory leave out; 0 without any band."""
        return film_share(self.by_films[1], self.damping_ratio)


def with_reduction(bands: ModeBands, part: ModePart | None) -> ModeBands:
    """Bands of modes with the size of what modes of bodies leave out that are not kept."""
    if part is None:
        return bands
    frequency, damping_ratio = part.sizes
    return bands._replace(frequency=bands.frequency + frequency, damping_ratio=bands.damping_ratio + damping_ratio)


def film_share(by_films: FloatArray, bands: FloatArray) -> float:
    """Median part of bands that is what films with memory leave out, arrays of one shape; 0 without any band."""
    some = bands > 0.0
    return float(np.median(by_films[some] / bands[some])) if np.any(some) else 0.0


@dataclass(frozen=True, eq=False)
class LawBands:
    """Changes that the errors of the laws of a system may make at an equilibrium: for each bearing those of `KINDS`.

    Attributes
    ----------
    bearings : tuple of CondensedBearing
        All bearings, with their derivatives by the changes of the system.
    films : FilmPart or None
        What films leave out; None of films without memory.
    """

    bearings: tuple[CondensedBearing, ...]
    films: FilmPart | None
    _balance: Equilibrium

    def change_of(self, element: int, kind: str) -> int:
        """Place among all changes of one of `KINDS` of a bearing, by its place among the elements of the system."""
        places = [one.element for one in self.bearings]
        return len(KINDS) * places.index(element) + KINDS.index(kind)

    def only(self, change: int) -> LawBands:
        """One of the changes alone, without what films leave out."""
        one = np.eye(self._changes)[[change]]
        bearings = tuple(dataclasses.replace(b, condensed=b.condensed.with_changes(one)) for b in self.bearings)
        return dataclasses.replace(self, bearings=bearings, films=None)

    def eigenvalue_changes(self, eigenvalues: ComplexArray, right: ComplexArray, left: ComplexArray) -> ComplexArray:
        """Change of eigenvalues by each of the changes, shape (changes, modes) [1/s].

        Parameters
        ----------
        eigenvalues : array, shape (modes,)
            [1/s].
        right : array, shape (n, modes)
            Displacements of the right eigenvectors of the state.
        left : array, shape (modes, n)
            Velocities of the left ones, with left . right = 1 for the whole state.
        """
        turned = np.linalg.solve(self._balance.system.mass, left.T)
        shifts = np.zeros((self._changes, eigenvalues.size), dtype=np.complex128)
        for one in self.bearings:
            ends = ((one.transform @ vectors).T[:, :, None] for vectors in (turned, right))
            shifts -= one.condensed.changes_along(eigenvalues, *ends)[..., 0, 0]
        return shifts

    def of_modes(self, eigenvalues: ComplexArray, right: ComplexArray, left: ComplexArray) -> ModeBands:
        """Bands of modes; arguments as of `eigenvalue_changes`."""
        by_laws = _sizes(self.eigenvalue_changes(eigenvalues, right, left), eigenvalues).sum(axis=1)
        by_films = np.zeros_like(by_laws)
        if self.films is not None:
            change, doubt = self.films.eigenvalue_changes(eigenvalues, right, left)
            size = np.maximum(np.abs(eigenvalues), 1e-300)
            by_films = _sizes(change, eigenvalues) + np.array([doubt / (2.0 * np.pi), doubt / size])
        frequency, damping_ratio = by_laws + by_films
        return ModeBands(frequency, damping_ratio, by_films)

    def of_undamped(self, frequency: FloatArray, shapes: FloatArray) -> FloatArray:
        """Bands of undamped frequencies [Hz], either way, shape (n,).

        Parameters
        ----------
        frequency : array, shape (n,)
            [Hz].
        shapes : array, shape (n, n)
            Columns phi with phi' M phi = 1.
        """
        energy = np.zeros((self._changes, frequency.size))
        for one in self.bearings:
            moved = one.transform @ shapes
            energy += np.einsum("mn,qmn->qn", moved, one.condensed.changes_of_slow_motion[0] @ moved)
        omega = 2.0 * np.pi * frequency
        swings = omega > 1e-6 * omega.max(initial=0.0)
        band = np.abs(energy).sum(axis=0) / (2.0 * np.where(swings, omega, 1.0)) / (2.0 * np.pi)
        return np.asarray(np.where(swings, band, 0.0))

    @property
    def _changes(self) -> int:
        """Number of changes."""
        return int(self.bearings[0].condensed.stated.forces.shape[0])

    @cached_property
    def _active(self) -> tuple[IntArray, ...]:
        """Ports of each bearing that its contacts feel at all."""
        return tuple(np.flatnonzero(np.any(one.condensed.pose, axis=(0, 1))) for one in self.bearings)

    @property
    def ports(self) -> FloatArray:
        """Matrix from the coordinates to the ports that contacts feel, shape (ports, n)."""
        return np.concatenate([one.transform[active] for one, active in zip(self.bearings, self._active, strict=True)])

    def of_responses(
        self, frequencies: FloatArray, motion: ComplexArray, back: ComplexArray, responses: ComplexArray
    ) -> tuple[FloatArray, FloatArray]:
        """Bands of the size of frequency responses, either way, shape (frequencies, sensors, inputs) [their unit].

        The second are the part of them that is what films with memory leave out.

        Parameters
        ----------
        frequencies : array, shape (frequencies,)
            [Hz].
        motion : array, shape (frequencies, ports, inputs)
            Complex amplitudes of the `ports` for each input.
        back : array, shape (frequencies, sensors, ports)
            What each sensor sees of a load on each of the ports, in its unit.
        responses : array, shape (frequencies, sensors, inputs)
            The responses.
        """
        unit = responses.conj() / np.maximum(np.abs(responses), 1e-300)
        places = _places(frequencies)
        s = np.asarray(1j * places, dtype=np.complex128)
        logs = np.log(np.clip(2.0 * np.pi * frequencies, places[0], places[-1]))
        moved = np.zeros((self._changes, *responses.shape), dtype=np.complex128)
        missing, wrong = np.zeros_like(moved[0]), np.zeros(responses.shape)
        memory = {} if self.films is None else {one.element: one for one in self.films.bearings}
        for one, active, at in self._parts():
            seen = back[:, :, at], motion[:, at]
            changes = one.condensed.changes(s)[:, :, active][..., active]
            for change in np.flatnonzero(np.any(changes, axis=(1, 2, 3))):
                moved[change] -= _through(changes[change], s, logs, *seen)
            if one.element in memory:
                every = np.eye(one.condensed.pose.shape[2], dtype=np.complex128)[None]
                both = memory[one.element].left_out(s, every, every)
                part, possible = (each[:, active][..., active] for each in both)
                missing -= _through(part, s, logs, *seen)
                wrong += np.abs(_through(possible, s, logs, *seen))
        by_films = np.abs((missing * unit).real) + wrong
        return np.abs((moved * unit).real).sum(axis=0) + by_films, by_films

    def _parts(self) -> Iterator[tuple[CondensedBearing, IntArray, slice]]:
        """Each bearing, which of its ports its contacts feel, and where these are among the `ports`."""
        first = 0
        for one, active in zip(self.bearings, self._active, strict=True):
            yield one, active, slice(first, first + active.size)
            first += active.size

    def of_bearings(self) -> FloatArray:
        """Bands of k [N/m] and c [N s/m] of each bearing along its force, either way, shape (2, bearings).

        Those of `mbs.linearised.sweep.along_load`; NaN for a bearing without force.
        """
        balance, bands = self._balance, []
        condensed = {one.element: one.condensed for one in self.bearings}
        for index in balance.system.select(OnRings):
            radial = balance.forces[index][1:3]
            load = float(np.linalg.norm(radial))
            if load == 0.0:
                bands.append([np.nan, np.nan])
                continue
            stiffness, damping = balance.element_stiffness[index], balance.element_damping[index]
            motion = ring_following(stiffness) @ np.array([0.0, *(radial / load), 0.0, 0.0, 0.0])
            dk, dc = (part @ motion for part in condensed[index].changes_of_slow_motion)
            follows = np.array([_moved(stiffness, one) for one in dk]) @ (2.0 * motion @ damping)
            bands.append(np.abs([dk @ motion, dc @ motion + follows]).sum(axis=1).tolist())
        return np.array(bands).reshape(-1, 2).T

    def of_matrices(self) -> FloatArray:
        """Bands of K and C [SI] of each bearing on its inner ring, either way, shape (2, bearings, 6, 6)."""
        balance, bands = self._balance, []
        condensed = {one.element: one.condensed for one in self.bearings}
        for index in balance.system.select(OnRings):
            stiffness, damping = balance.element_stiffness[index], balance.element_damping[index]
            following = ring_following(stiffness)
            by_stiffness, by_damping = condensed[index].changes_of_slow_motion
            moved = [np.array([_moved(stiffness, column) for column in (one @ following).T]).T for one in by_stiffness]
            follows = np.array([one.T @ damping @ following for one in moved])
            both = following.T @ by_damping @ following + follows + np.swapaxes(follows, -1, -2)
            bands.append(np.abs([following.T @ by_stiffness @ following, both]).sum(axis=1))
        return np.swapaxes(np.array(bands).reshape(-1, 2, 6, 6), 0, 1)


def law_bands(balance: Equilibrium) -> LawBands | None:
    """Find what errors of the laws of a system may change; None where a bearing states no errors, or none has films.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which the system is linearised.
    """
    bearings = condensed_bearings(balance)
    stated = all(one.condensed.slopes is not None for one in bearings)
    if not bearings or not stated or len(bearings) < len(balance.system.select(OnRings)):
        return None
    weights: list[list[FloatArray]] = [[] for _ in bearings]
    stiffness = _giving(balance, bearings)
    for changed in bearings:
        for kind in KINDS:
            given = np.zeros(balance.system.size)
            if kind == "film":
                force = changed.condensed.stated.forces[changed.condensed.direction(kind)]
                given = np.asarray(np.linalg.solve(stiffness, changed.transform.T @ force))
            for one, rows in zip(bearings, weights, strict=True):
                of_law = [float(one is changed and kind == own) for own in KINDS]
                rows.append(np.concatenate([one.transform @ given, of_law]))
    by_changes = tuple(
        dataclasses.replace(one, condensed=one.condensed.with_changes(np.array(rows)))
        for one, rows in zip(bearings, weights, strict=True)
    )
    return LawBands(by_changes, film_part(balance, bearings), balance)


def _through(
    at_places: ComplexArray, s: ComplexArray, logs: FloatArray, back: ComplexArray, motion: ComplexArray
) -> ComplexArray:
    """Change that sensors see by one of Z (k, p, p) at places s (k,), at the logarithms of all frequencies.

    Shape (frequencies, sensors, inputs); by what sensors see of loads on the ports, and by motions of these.
    """
    at_all = CubicSpline(np.log(s.imag), at_places)(logs) if s.size > 1 else at_places
    return np.asarray(back @ at_all @ motion, dtype=np.complex128)


def _sizes(changes: ComplexArray, eigenvalues: ComplexArray) -> FloatArray:
    """Sizes of changes of |eigenvalue|/(2 pi) [Hz] and of the damping ratio, shape (2, ..., modes)."""
    size = np.maximum(np.abs(eigenvalues), 1e-300)
    grown = (changes * eigenvalues.conj()).real / size
    ratio = -(changes.real - eigenvalues.real * grown / size) / size
    return np.asarray(np.abs([grown / (2.0 * np.pi), ratio]))


def _giving(balance: Equilibrium, bearings: tuple[CondensedBearing, ...]) -> FloatArray:
    """Stiffness by which the equilibrium gives way: cages of bearings follow, with a little mass added."""
    mass, stiffness = balance.system.mass, balance.stiffness.copy()
    size = max(float(np.trace(stiffness) / np.trace(mass)), 1.0)
    for one in bearings:
        cages = -one.condensed.stated.forces[: one.transform.shape[0]].T - one.condensed.stiffness
        stiffness += one.transform.T @ cages @ one.transform
    return np.asarray(stiffness + _SOFT * size * mass)


def _places(frequencies: FloatArray) -> FloatArray:
    """Angular frequencies [rad/s] at which the slices are looked at, evenly over the logarithm of a range, or one."""
    omega = 2.0 * np.pi * np.asarray(frequencies, dtype=np.float64)
    highest = float(omega.max())
    lowest = float(omega[omega > 1e-6 * highest].min()) if highest > 0.0 else 0.0
    if not highest > lowest:
        return np.array([max(highest, 1e-300)])
    return np.geomspace(lowest, highest, 2 + math.ceil(_PER_DECADE * math.log10(highest / lowest)))


def _moved(stiffness: FloatArray, force: FloatArray) -> FloatArray:
    """Displacements of rollers that are bodies under a change of force on the ports, both rings held, shape (m,)."""
    moved = np.zeros_like(force)
    if stiffness.shape[0] > 6:
        own = stiffness[12:, 12:]
        loaded = np.nonzero(np.diag(own) > 0.0)[0]
        moved[12 + loaded] = -np.linalg.solve(own[np.ix_(loaded, loaded)], force[12 + loaded])
    return moved
