"""Limits of validity of a linear analysis: contacts that lift off, and the estimated error of the films that it has."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.maps.kernels.film_response import by_powers
from mbs.linearised.dynamic import element_dynamic_stiffness
from mbs.model.condensed import Condensed
from mbs.model.elements import Input, OnRings
from mbs.model.equilibrium import Equilibrium
from mbs.model.findings import CARRIES
from mbs.model.on_rings import ring_matrices
from mbs.model.relaxation import NOTABLE, Films

_PLACES = np.array([0.1, 0.3, 1.0, 3.0, 10.0, 30.0])
_WITHIN = np.array([4e-4, 2.5e-3, 1.5e-2, 3.1e-2, 4.1e-2, 7.9e-2])
"""Error of the complex stiffness of a contact with memory beside the film solver, by omega times its natural time
sqrt(b^2 + 2 h R)/u: 95 of 100 random contacts of NU308 and N1014 are below, with three oils of 12 to 30 1/GPa, 20 to
100 degC (`python -m tests.benchmarks.film_memory`)."""

_AT_ONCE = 50
"""Frequencies at which an error is looked at together, from low ones on."""


def memory_error(place: FloatArray) -> FloatArray:
    """Error of the complex stiffness of contacts with memory, as a part of it; 95 of 100 contacts are below.

    Between its points, and beyond them, it goes by powers of `place`; it was measured from 0.1 to 30.

    Parameters
    ----------
    place : array
        omega times the natural time of the contact.

    Examples
    --------
    >>> memory_error(np.array([0.0, 1.0, 10.0])).tolist()
    [0.0, 0.015, 0.041]
    """
    return np.asarray(np.round(by_powers(place, _PLACES, _WITHIN), 12))


class ContactsInBalance(NamedTuple):
    """Contacts of rolling elements in balance, as they are felt along the load of their bearing.

    Attributes
    ----------
    condensed : Condensed
        The bearing.
    motion : array, shape (p,)
        Motion of its ports along the load.
    """

    condensed: Condensed
    motion: FloatArray

    def left_out(self, s: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        """Part that films with memory leave out at frequencies s (k,) [1/s], and its possible error [N/m]; (k,)."""
        along = self.motion.astype(np.complex128)[None, :, None]
        missing, possible = films_in_balance(self.condensed, s, along, along)
        return missing[:, 0, 0], np.abs(possible[:, 0, 0])


def films_in_balance(
    condensed: Condensed, s: ComplexArray, left: ComplexArray, right: ComplexArray
) -> tuple[ComplexArray, ComplexArray]:
    """Part of left' Z(s) right that films with memory leave out, and its possible error, shape (k, a, b) each.

    Parameters
    ----------
    condensed : Condensed
        A bearing whose rolling elements are in balance.
    s, left, right
        The same as of `mbs.model.condensed.Condensed.changes_along`.
    """
    if condensed.left_out is not None:
        part, doubt = condensed.left_out(s)
    else:
        assert condensed.natural is not None
        doubt = memory_error(np.multiply.outer(np.abs(s), condensed.natural))
        part = np.zeros(doubt.shape, dtype=np.complex128)
    return condensed.parts_along(s, left, right, part, doubt)


@dataclass(frozen=True, eq=False)
class FilmError:
    """Possible error of the films that an analysis has against true ones: along the load of a bearing, over frequency.

    The error is |dZ/Z| of the dynamic stiffness Z. With a map that holds the response of its films, Z is that of films
    with memory and what each of their slices leaves out, see `ehdmaps.maps.kernels.film_response`; how wrong that may
    be as it is read is added by its size. Without one, Z is that of films with memory, whose own error is the mean of
    `memory_error` of the slices, each with the weight of c over its natural time, which is some measure of its
    stiffness and all that is known of it here.

    Attributes
    ----------
    bearing : str
        Name of the bearing.
    films : {"slow", "memory"}
        The films that the analysis has.
    at_rest : bool
        Whether nothing turns, so that there is no film.
    stiffness, damping : float
        k [N/m] and c [N s/m] of slow motion.
    springs, times : array, shape (r,)
        Stiffness [N/m] and relaxation time [s] of each slice, as of `mbs.model.relaxation`.
    natural : array, shape (r,)
        Natural time of each slice [s].
    contacts : ContactsInBalance or None
        Rolling elements, where what holds their law holds the response of films, too.
    """

    bearing: str
    films: Films
    at_rest: bool
    stiffness: float
    damping: float
    springs: FloatArray
    times: FloatArray
    natural: FloatArray
    contacts: ContactsInBalance | None = None

    def error(self, frequencies: FloatArray) -> FloatArray:
        """Estimated |dZ/Z| at frequencies (k,) [Hz]; 0 at rest."""
        omega = 2.0 * np.pi * np.asarray(frequencies, dtype=np.float64)
        if self.at_rest or not np.any(self.springs > 0.0):
            return np.zeros(omega.shape)
        if self.contacts is not None:
            return self._by_response(omega, *self.contacts.left_out(np.asarray(1j * omega)))
        if self.films == "memory":
            weights = np.where(self.springs > 0.0, self.springs * self.times / np.maximum(self.natural, 1e-30), 0.0)
            errors = memory_error(np.multiply.outer(omega, self.natural))
            return np.asarray(errors @ (weights / weights.sum()), dtype=np.float64)
        place = 1j * np.multiply.outer(omega, self.times)
        more = -(place**2 / (1.0 + place)) @ self.springs
        return np.asarray(np.abs(more) / np.abs(self.stiffness + 1j * omega * self.damping + more), dtype=np.float64)

    @property
    def held_by(self) -> str:
        """Name of what holds the response of its films, for people; empty where nothing does."""
        return "" if self.contacts is None else self.contacts.condensed.held_by

    def _by_response(self, omega: FloatArray, left_out: ComplexArray, doubt: FloatArray) -> FloatArray:
        """The error at angular frequencies (k,) [rad/s], by the part that films with memory leave out [N/m]."""
        s = np.asarray(1j * omega)
        place = np.multiply.outer(s, self.times)
        more = -(place**2 / (1.0 + place)) @ self.springs
        true = self.stiffness + s * self.damping + more + left_out
        wrong = left_out if self.films == "memory" else more + left_out
        return np.asarray((np.abs(wrong) + doubt) / np.abs(true), dtype=np.float64)

    def dynamic_stiffness(self, frequencies: FloatArray) -> ComplexArray:
        """Dynamic stiffness of films with memory along the load at frequencies (k,) [N/m]."""
        s = np.asarray(2j * np.pi * np.asarray(frequencies, dtype=np.float64))
        place = np.multiply.outer(s, self.times)
        return np.asarray(self.stiffness + s * self.damping - (place**2 / (1.0 + place)) @ self.springs)

    def at(self, frequency: float) -> float:
        """The error at one frequency [Hz]."""
        return float(self.error(np.array([frequency]))[0])

    @cached_property
    def frequency(self) -> float:
        """Lowest frequency at which the error is `NOTABLE` [Hz], between 1 Hz and 1 MHz; infinite if it never is."""
        for part in np.split(np.geomspace(1.0, 1e6, 601), range(1, 601, _AT_ONCE)):
            above = np.flatnonzero(self.error(part) > NOTABLE)
            if above.size:
                return float(part[above[0]])
        return math.inf


@dataclass(frozen=True)
class DynamicLoad:
    """Largest dynamic load of a bearing in a linear analysis, beside the static one that it takes away.

    Attributes
    ----------
    element, input : str
        Which bearing, and excited by what.
    dynamic, static : float
        The loads that decide [N]: on the rolling element that lifts off first where all carry load at rest, as in a
        preloaded bearing, else the force on the inner ring.
    frequency : float
        Frequency at which the dynamic load is largest beside the static one [Hz].
    of : str
        What rolling element it is a load of: ball, roller; empty for the force on the inner ring.
    """

    element: str
    input: str
    dynamic: float
    static: float
    frequency: float
    of: str = ""

    @property
    def exceeds(self) -> bool:
        """True where contacts would lift off, so that a linear analysis is not valid."""
        return self.dynamic > self.static

    @property
    def words(self) -> str:
        """The loads for people, without what excites them."""
        whose = f"a {self.of}" if self.of else "the bearing"
        return f"the dynamic load of {whose}, {self.dynamic:.3g} N, exceeds its static one of {self.static:.4g} N"


class Lifting(NamedTuple):
    """Rule by which the contacts of a bearing lift off.

    Attributes
    ----------
    static : array, shape (k,)
        Loads at rest [N]: of all rolling elements where all carry load, else of the bearing alone.
    by_force : array, shape (k, 6) or None
        The same by a force on the inner ring; None where it is that of the bearing.
    of : str
        What the loads are of, as of `DynamicLoad`.
    """

    static: FloatArray
    by_force: FloatArray | None
    of: str

    def worst(self, force: ComplexArray) -> tuple[float, float]:
        """Dynamic and static load that decide under an oscillating force (6,) on the inner ring [N], [N m]."""
        if self.by_force is None:
            # the longest of the directions that the force takes in a turn
            parts = np.array([force[:3].real, force[:3].imag])
            return float(np.linalg.norm(parts, 2)), float(self.static[0])
        dynamic = np.abs(self.by_force @ force)
        first = int(np.argmax(dynamic / self.static))
        return float(dynamic[first]), float(self.static[first])


def lifting(balance: Equilibrium, index: int) -> Lifting:
    """Find what lifts the contacts of a bearing off: a rolling element of a preloaded one, else all of them.

    Loads of rolling elements go with the force as in slow motion: films that relax stiffen all of them alike, nearly.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    index : int
        Which element of the system it is: one on rings.
    """
    connected = balance.system.elements[index]
    element, whole = connected.element, np.array([float(np.linalg.norm(balance.forces[index][:3]))])
    assert isinstance(element, OnRings)
    ports, operation = connected.transform @ balance.displacement, balance.operation
    rest = element.element_loads(ports, operation)
    if rest is None or not np.all(rest > CARRIES * rest.max()):
        return Lifting(whole, None, "")
    slopes = np.zeros((rest.size, 6))
    for column in _MOVED:
        step = np.zeros(ports.size)
        step[column] = _STEP if column < 3 else _TILT
        ends = [element.element_loads(ports + way * step, operation) for way in (1.0, -1.0)]
        if ends[0] is None or ends[1] is None:
            return Lifting(whole, None, "")
        slopes[:, column] = (ends[0] - ends[1]) / (2.0 * step[column])
    stiffness, _ = ring_matrices(balance.element_stiffness[index], balance.element_damping[index])
    gauge = element.gauge(ports, operation)
    scale = np.array([1.0, 1.0, 1.0, _ARM, _ARM, _ARM])
    by_force = slopes / scale @ np.linalg.pinv(stiffness / np.outer(scale, scale), rcond=_SINGULAR) / scale
    return Lifting(rest, by_force, "" if gauge is None else gauge.element)


_MOVED = (0, 1, 2, 4, 5)
"""Displacements of an inner ring that change loads: none about the axis."""

_STEP, _TILT, _ARM = 1e-9, 1e-8, 0.05
"""Steps of differences [m], [rad], and the lever by which tilts are compared with displacements [m]."""

_SINGULAR = 1e-9
"""Part of the largest stiffness below which a bearing holds nothing."""


def dynamic_loads(
    balance: Equilibrium, inputs: Sequence[Input], frequencies: FloatArray, motion: ComplexArray
) -> tuple[DynamicLoad, ...]:
    """Dynamic load of each bearing for each input, at the frequency at which it is largest beside the static one.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    inputs : sequence of Input
        Inputs with their amplitudes.
    frequencies : array, shape (frequencies,)
        [Hz].
    motion : array, shape (frequencies, n, inputs)
        Amplitudes of the coordinates at 1 N or 1 N m of each input, see `mbs.linearised.linear.responses`.
    """
    loads: list[DynamicLoad] = []
    if not inputs or not frequencies.size:
        return ()
    s = np.asarray(2j * np.pi * frequencies, dtype=np.complex128)
    motion = motion * np.array([entry.amplitude for entry in inputs])
    for index in balance.system.select(OnRings):
        connected, rule = balance.system.elements[index], lifting(balance, index)
        ports = np.einsum("mn,fni->fmi", connected.transform, motion)
        # The first port of a bearing is the inner ring.
        force = (element_dynamic_stiffness(balance, index, s) @ ports)[:, :6]
        for i, entry in enumerate(inputs):
            each = np.array([rule.worst(force[k, :, i]) for k in range(frequencies.size)])
            with np.errstate(divide="ignore", invalid="ignore"):
                worst = int(np.argmax(np.nan_to_num(each[:, 0] / each[:, 1], nan=0.0)))
            found = float(each[worst, 0]), float(each[worst, 1])
            loads.append(DynamicLoad(connected.element.name, entry.name, *found, float(frequencies[worst]), rule.of))
    return tuple(loads)
