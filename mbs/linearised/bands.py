"""Effect of errors of known size on what a linear analysis finds: first derivatives, and sums of their sizes.

They are the errors that a map states, and what films with memory leave out.

A contact law is the approach, the stiffness and the damping at each load. Each may be wrong by its bound
(`ehdmaps.maps.law_errors`), at all loads of a bearing with the same sign, which makes three changes a bearing:

- stiffness: k of each slice by its bound, at the load that it has;
- damping: c likewise;
- film: each film thicker by its bound, which shifts the equilibrium, hence the loads, hence k and c.

Each changes the dynamic stiffness Z(s) of the system by dZ(s). To first order an eigenvalue then moves by

    d lambda = -y' dZ(lambda) x,    with y' Z'(lambda) x = 1,

and a response by dH = -S Z^-1 dZ Z^-1 B. A slice with a film that relaxes has Z = k + s c/(1 + s theta) with
theta = c/(k_s - k); k_s, the stiffness of the locked film, is held. Balls and tapered rollers are in balance between
their contacts: dZ(s) of such bearings is that of `mbs.model.condensed`.

A band is the sum of the sizes of these changes: of the three kinds, and over the bearings, which share the errors of
one map. That is the largest change to first order that the bounds allow. Films with memory leave out a part that
depends on the frequency, see `mbs.linearised.film_part`: the size of it for all bearings together, and that of its
possible error, are added to bands of modes and responses. Undamped modes and k and c of bearings are those of slow
motion, of which they leave out nothing.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from mbs.bearings.bearing_element import RingElement, ring_following
from mbs.bearings.roller_contacts import ContactGroup
from mbs.linearised.film_part import FilmPart, film_part
from mbs.model.condensed import DIRECTIONS, LAW_CHANGES, Condensed
from mbs.model.elements import OnRings
from mbs.model.equilibrium import Equilibrium

if TYPE_CHECKING:
    from ehdmaps.maps.law_errors import LawBounds

KINDS = LAW_CHANGES
"""Kinds of changes, in the order in which each bearing has them."""

_State = tuple[FloatArray, FloatArray, FloatArray, FloatArray]
"""Load, stiffness, damping and relaxation time of the slices of a group, shape (r,) each."""

_SMALL = 1e-10
"""Step of the approach by which the law is differentiated once more [m]."""

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


def film_share(by_films: FloatArray, bands: FloatArray) -> float:
    """Median part of bands that is what films with memory leave out, arrays of one shape; 0 without any band."""
    some = bands > 0.0
    return float(np.median(by_films[some] / bands[some])) if np.any(some) else 0.0


class SliceChange(NamedTuple):
    """Effect of a change on the slices of a group, shape (r,) each.

    Attributes
    ----------
    group : int
        Which group.
    stiffness, damping, times : array
        Changes of k [N/m], of c [N s/m] and of the relaxation times [s].
    """

    group: int
    stiffness: FloatArray
    damping: FloatArray
    times: FloatArray


@dataclass(frozen=True, eq=False)
class _Slices:
    """Slices of a group in the coordinates of the system: damping [N s/m] and times [s] (r,), rows (r, n)."""

    element: int
    rows: FloatArray
    port_rows: FloatArray
    damping: FloatArray
    times: FloatArray


@dataclass(frozen=True, eq=False)
class CondensedBearing:
    """A bearing whose rolling elements are in balance, in a system whose laws change.

    Attributes
    ----------
    element : int
        Which element of the system it is.
    condensed : Condensed
        The bearing with the errors of its law.
    weights : array, shape (changes, 9)
        Part that each change of the system has in each of its `mbs.model.condensed.DIRECTIONS`.
    """

    element: int
    condensed: Condensed
    weights: FloatArray


@dataclass(frozen=True, eq=False)
class LawBands:
    """Changes that the errors of the laws of a system may make at an equilibrium.

    Attributes
    ----------
    changes : tuple of tuple of SliceChange
        Each change with all slices that it reaches: for each bearing those of `KINDS`, first of bearings in slices.
    films : FilmPart or None
        What films leave out, in groups as those of the changes; None of films without memory.
    """

    changes: tuple[tuple[SliceChange, ...], ...]
    films: FilmPart | None
    _balance: Equilibrium
    _groups: tuple[_Slices, ...]
    _condensed: tuple[CondensedBearing, ...] = ()

    def only(self, change: int) -> LawBands:
        """One of the changes alone, without what films leave out."""
        of_bearings = tuple(dataclasses.replace(one, weights=one.weights[[change]]) for one in self._condensed)
        return dataclasses.replace(self, changes=(self.changes[change],), films=None, _condensed=of_bearings)

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
        shifts = np.zeros((len(self.changes), eigenvalues.size), dtype=np.complex128)
        for g, slices in enumerate(self._groups):
            product = (slices.rows @ turned) * (slices.rows @ right)
            # Of dZ = dk + s dc/(1 + s theta) - s^2 c d theta/(1 + s theta)^2 what all changes have alike.
            slow = eigenvalues / (1.0 + np.multiply.outer(slices.times, eigenvalues))
            by_damping = slow * product
            by_times = slices.damping[:, None] * slow * by_damping
            own = [next((part for part in change if part.group == g), None) for change in self.changes]
            there = [index for index, part in enumerate(own) if part is not None]
            parts = [part for part in own if part is not None]
            if not parts:
                continue
            shifts[there] -= np.array([part.stiffness for part in parts]) @ product
            shifts[there] -= np.array([part.damping for part in parts]) @ by_damping
            shifts[there] += np.array([part.times for part in parts]) @ by_times
        for one in self._condensed:
            transform = self._balance.system.elements[one.element].transform
            ends = ((transform @ vectors).T[:, :, None] for vectors in (turned, right))
            shifts -= one.weights @ one.condensed.changes_along(eigenvalues, *ends)[..., 0, 0]
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
        nothing = np.zeros_like(frequency)
        energy = np.array(
            [
                sum((part.stiffness @ (self._groups[part.group].rows @ shapes) ** 2 for part in change), nothing)
                for change in self.changes
            ]
        )
        for one in self._condensed:
            moved = self._balance.system.elements[one.element].transform @ shapes
            by_direction = np.einsum("mn,qmn->qn", moved, one.condensed.changes_of_slow_motion[0] @ moved)
            energy = energy + one.weights @ by_direction
        omega = 2.0 * np.pi * frequency
        swings = omega > 1e-6 * omega.max(initial=0.0)
        band = np.abs(energy).sum(axis=0) / (2.0 * np.where(swings, omega, 1.0)) / (2.0 * np.pi)
        return np.asarray(np.where(swings, band, 0.0))

    @cached_property
    def _active(self) -> dict[int, IntArray]:
        """Ports of each element that its slices feel at all."""
        active: dict[int, IntArray] = {}
        for one in self._groups:
            ports = np.flatnonzero(np.any(one.port_rows != 0.0, axis=0))
            active[one.element] = np.union1d(active.get(one.element, ports), ports)
        return active | {
            one.element: np.flatnonzero(np.any(one.condensed.pose, axis=(0, 1))) for one in self._condensed
        }

    @property
    def ports(self) -> FloatArray:
        """Matrix from the coordinates to the ports that slices feel, shape (ports, n)."""
        elements = self._balance.system.elements
        return np.concatenate([elements[index].transform[active] for index, active in self._active.items()])

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
        logs = np.log(np.clip(2.0 * np.pi * frequencies, places[0], places[-1]))
        band = np.zeros(responses.shape)
        ends = np.cumsum([active.size for active in self._active.values()]).tolist()
        places_of = {
            index: slice(end - active.size, end)
            for (index, active), end in zip(self._active.items(), ends, strict=True)
        }
        products = []
        for one in self._groups:
            rows = one.port_rows[:, self._active[one.element]]
            products.append((rows[:, :, None] * rows[:, None, :]).reshape(one.times.size, -1))

        def moved_by(parts: Sequence[tuple[int, ComplexArray]]) -> list[ComplexArray]:
            """Change of the responses by each element, of changes of the slices of groups at the places."""
            by_element: dict[int, ComplexArray] = {}
            for group, dynamic in parts:
                element = self._groups[group].element
                matrix = (dynamic.real @ products[group]) + 1j * (dynamic.imag @ products[group])
                by_element[element] = by_element.get(element, np.zeros_like(matrix)) + matrix
            moved = []
            for element, matrix in by_element.items():
                at, size = places_of[element], self._active[element].size
                at_all = CubicSpline(np.log(places), matrix)(logs) if places.size > 1 else matrix
                moved.append(-back[:, :, at] @ at_all.reshape(-1, size, size) @ motion[:, at])
            return moved

        s = np.asarray(1j * places, dtype=np.complex128)
        by_balance = [
            (one.weights, _through(self._by_directions(one, s), s, logs, motion[:, at], back[:, :, at]))
            for one, at in ((one, places_of[one.element]) for one in self._condensed)
        ]
        for index, change in enumerate(self.changes):
            moved = moved_by([(part.group, _dynamic(self._groups[part.group], part, s)) for part in change])
            moved += [np.tensordot(weights[index], by_direction, 1) for weights, by_direction in by_balance]
            band += np.abs((np.sum(moved, axis=0) * unit).real)
        by_films = np.zeros_like(band)
        if self.films is not None:
            of_slices = [group.left_out(s) for group in self.films.groups]
            missing = moved_by([(index, part) for index, (part, _) in enumerate(of_slices)])
            wrong = moved_by([(index, doubt.astype(np.complex128)) for index, (_, doubt) in enumerate(of_slices)])
            for bearing in self.films.in_balance:
                at, active = places_of[bearing.element], self._active[bearing.element]
                every = np.eye(6, dtype=np.complex128)[None]
                both = np.stack(bearing.left_out(s, every, every), axis=1)[:, :, active][..., active]
                own, possible = _through(both, s, logs, motion[:, at], back[:, :, at])
                missing, wrong = [*missing, own], [*wrong, possible]
            by_films += np.abs((np.sum(missing, axis=0) * unit).real)
            by_films += np.sum(np.abs(wrong), axis=0)
        return band + by_films, by_films

    def _by_directions(self, one: CondensedBearing, s: ComplexArray) -> ComplexArray:
        """Derivatives of Z at places s (k,) by the directions of a bearing, by the ports that it feels (k, 9, p, p)."""
        active = self._active[one.element]
        return np.moveaxis(one.condensed.changes(s)[:, :, active][..., active], 0, 1)

    def of_bearings(self) -> FloatArray:
        """Bands of k [N/m] and c [N s/m] of each bearing along its force, either way, shape (2, bearings).

        Those of `mbs.linearised.sweep.along_load`; NaN for a bearing without force.
        """
        balance, bands = self._balance, []
        condensed = {one.element: one for one in self._condensed}
        for index in balance.system.select(OnRings):
            radial = balance.forces[index][1:3]
            load = float(np.linalg.norm(radial))
            if load == 0.0:
                bands.append([np.nan, np.nan])
                continue
            if index in condensed:
                along, one = np.array([0.0, *(radial / load), 0.0, 0.0, 0.0]), condensed[index]
                by_direction = [along @ part @ along for part in one.condensed.changes_of_slow_motion]
                bands.append([float(np.abs(one.weights @ part).sum()) for part in by_direction])
                continue
            stiffness, damping = balance.element_stiffness[index], balance.element_damping[index]
            following = ring_following(stiffness)
            motion = following @ np.array([0.0, *(radial / load), 0.0, 0.0, 0.0])
            sums = np.zeros(2)
            for change in self.changes:
                parts = [part for part in change if self._groups[part.group].element == index]
                dk, dc = np.zeros((2, motion.size))
                for part in parts:
                    rows = self._groups[part.group].port_rows
                    dk += rows.T @ (part.stiffness * (rows @ motion))
                    dc += rows.T @ (part.damping * (rows @ motion))
                sums += np.abs([motion @ dk, motion @ dc + 2.0 * (motion @ damping) @ _moved(stiffness, dk)])
            bands.append(sums.tolist())
        return np.array(bands).reshape(-1, 2).T


def law_bands(balance: Equilibrium) -> LawBands | None:
    """Find what errors of the laws of a system may change; None where a bearing states no errors, or none has films.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which the system is linearised.
    """
    system = balance.system
    slices: list[_Slices] = []
    groups: list[tuple[int, ContactGroup]] = []
    in_balance: dict[int, Condensed] = {}
    for index in system.select(OnRings):
        connected = system.elements[index]
        ports = connected.transform @ balance.displacement
        element = connected.element
        if isinstance(element, RingElement):
            own = [(index, group) for group in element.contact_groups(ports, balance.operation)]
            groups += own
            states_errors = bool(own)
        else:
            condensed = element.law_errors(ports, balance.operation) if isinstance(element, OnRings) else None
            in_balance |= {} if condensed is None else {index: condensed}
            states_errors = condensed is not None
        if not states_errors:
            return None
    bounds: list[LawBounds] = []
    states: list[_State] = []
    for index, group in groups:
        state = group.state()
        bound = group.law.bounds(state[0])
        if bound is None:
            return None
        states.append(state)
        bounds.append(bound)
        transform = system.elements[index].transform
        slices.append(_Slices(index, group.rows @ transform, group.rows, state[2], state[3]))
    if not groups and not in_balance:
        return None
    slopes = [_slopes(group, state) for (_, group), state in zip(groups, states, strict=True)]
    changes: list[tuple[SliceChange, ...]] = []
    weights: dict[int, list[FloatArray]] = {index: [] for index in in_balance}
    stiffness = _giving(balance, in_balance)

    def add(change: tuple[SliceChange, ...], given: FloatArray, of: int = -1, kind: str = "") -> None:
        """Add a change with the places that give way, and with that of the law of a bearing in balance."""
        changes.append(change)
        for index, rows in weights.items():
            part = np.concatenate([system.elements[index].transform @ given, np.zeros(len(KINDS))])
            part[DIRECTIONS.index(kind) if index == of else slice(0)] = 1.0
            rows.append(part)

    for index in dict.fromkeys(index for index, _ in groups):
        own_groups = [g for g, (of, _) in enumerate(groups) if of == index]
        add(tuple(_stiffer(g, states[g], bounds[g].stiffness) for g in own_groups), np.zeros(system.size))
        add(tuple(_damped(g, states[g], bounds[g].damping) for g in own_groups), np.zeros(system.size))
        thicker = {g: bounds[g].film_offset for g in own_groups}
        force = np.zeros(system.size)
        for g, films in thicker.items():
            force -= slices[g].rows.T @ (states[g][1] * films)
        given = np.asarray(np.linalg.solve(stiffness, force))
        add(_moved_slices(slices, slopes, given, thicker), given)
    for index, one in in_balance.items():
        add((), np.zeros(system.size), index, "stiffness")
        add((), np.zeros(system.size), index, "damping")
        force = system.elements[index].transform.T @ one.forces[DIRECTIONS.index("film")]
        given = np.asarray(np.linalg.solve(stiffness, force))
        add(_moved_slices(slices, slopes, given, {}), given, index, "film")
    bearings = tuple(CondensedBearing(index, one, np.array(weights[index])) for index, one in in_balance.items())
    return LawBands(tuple(changes), film_part(balance, in_balance), balance, tuple(slices), bearings)


def _through(
    at_places: ComplexArray, s: ComplexArray, logs: FloatArray, motion: ComplexArray, back: ComplexArray
) -> ComplexArray:
    """Changes of responses by changes of Z (k, q, p, p) at places s (k,), at the logarithms of all frequencies.

    Shape (q, frequencies, sensors, inputs); by motions of the ports, and by what sensors see of loads there.
    """
    at_all = CubicSpline(np.log(s.imag), at_places)(logs) if s.size > 1 else at_places
    return np.asarray(np.moveaxis(-back[:, None] @ at_all @ motion[:, None], 1, 0), dtype=np.complex128)


def _sizes(changes: ComplexArray, eigenvalues: ComplexArray) -> FloatArray:
    """Sizes of changes of |eigenvalue|/(2 pi) [Hz] and of the damping ratio, shape (2, ..., modes)."""
    size = np.maximum(np.abs(eigenvalues), 1e-300)
    grown = (changes * eigenvalues.conj()).real / size
    ratio = -(changes.real - eigenvalues.real * grown / size) / size
    return np.asarray(np.abs([grown / (2.0 * np.pi), ratio]))


def _stiffer(group: int, state: _State, bound: FloatArray) -> SliceChange:
    """Slices whose stiffness is higher by a relative bound; theta = c/(k_s - k) grows where k nears k_s."""
    _, stiffness, damping, times = state
    more = stiffness * bound
    longer = np.where(damping > 0.0, times**2 * more / np.where(damping > 0.0, damping, 1.0), 0.0)
    return SliceChange(group, more, np.zeros_like(more), longer)


def _damped(group: int, state: _State, bound: FloatArray) -> SliceChange:
    """Slices whose damping is higher by a relative bound, and theta with it."""
    _, stiffness, damping, times = state
    return SliceChange(group, np.zeros_like(stiffness), damping * bound, times * bound)


def _slopes(group: ContactGroup, state: _State) -> _State:
    """Derivatives of the state by the approach."""
    after = group.state(_SMALL)
    load, stiffness, damping, times = ((new - old) / _SMALL for new, old in zip(after, state, strict=True))
    return load, stiffness, damping, times


def _giving(balance: Equilibrium, in_balance: dict[int, Condensed]) -> FloatArray:
    """Stiffness by which the equilibrium gives way: cages of bearings in balance follow, with a little mass added."""
    mass = balance.system.mass
    stiffness = 0.5 * (balance.stiffness + balance.stiffness.T)
    size = max(float(np.trace(stiffness) / np.trace(mass)), 1.0)
    if in_balance:
        stiffness = balance.stiffness.copy()
    for index, one in in_balance.items():
        transform = balance.system.elements[index].transform
        stiffness += transform.T @ (-one.forces[:6].T - one.stiffness) @ transform
    return stiffness + _SOFT * size * mass


def _moved_slices(
    slices: Sequence[_Slices], slopes: Sequence[_State], given: FloatArray, thicker: dict[int, FloatArray]
) -> tuple[SliceChange, ...]:
    """Changes of the slices of all groups, by an equilibrium that gives way and thicker films [m] of some of them."""
    changes = []
    for g, (_, by_stiffness, by_damping, by_times) in enumerate(slopes):
        shift = slices[g].rows @ given + thicker.get(g, 0.0)
        changes.append(SliceChange(g, by_stiffness * shift, by_damping * shift, by_times * shift))
    return tuple(changes)


def _dynamic(slices: _Slices, change: SliceChange, s: ComplexArray) -> ComplexArray:
    """Change of the dynamic stiffness of each slice at complex frequencies s (k,), shape (k, r)."""
    rate = s[:, None]
    slow = 1.0 / (1.0 + rate * slices.times)
    return np.asarray(
        change.stiffness + rate * slow * (change.damping - rate * slow * slices.damping * change.times),
        dtype=np.complex128,
    )


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
