"""Part that films with memory leave out of a linear analysis: of its modes, and of its dynamic stiffness.

Each slice has one relaxation time, which the film solver has not, see `ehdmaps.maps.kernels.film_response`. What it
leaves out of the dynamic stiffness, dZ, moves an eigenvalue by

    d lambda = -y' dZ(lambda) x,    with y' Z'(lambda) x = 1,

as the errors of a map do in `mbs.linearised.bands`. Here the signs are known, so that the parts of all slices and
bearings add up as they are. How wrong dZ may be as it is read is known by its size alone; it counts as having one phase
along the loads of a bearing. A law that holds no response of its films has that size for all of dZ. Balls and tapered
rollers in balance have the dZ of `mbs.model.condensed`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray
from ehdmaps.maps.kernels.film_response import law_stiffness
from mbs.bearings.bearing_element import RingElement
from mbs.linearised.validity import films_in_balance, memory_error
from mbs.model.condensed import Condensed
from mbs.model.equilibrium import Equilibrium

if TYPE_CHECKING:
    from ehdmaps.maps.kernels.film_response import FilmResponse

FIRST_ORDER = 0.3
"""Change of an eigenvalue, by its imaginary part, above which the first order says nothing."""


class FilmLawPart(NamedTuple):
    """Estimated error of the film law, true less found, shape (modes,) each.

    Attributes
    ----------
    frequency : array
        Part in |eigenvalue|/(2 pi) [Hz].
    damping_ratio : array
        Part in the damping ratio.
    """

    frequency: FloatArray
    damping_ratio: FloatArray


@dataclass(frozen=True, eq=False)
class FilmSlices:
    """Slices of a group whose films have a memory.

    Attributes
    ----------
    element : int
        Which element of the system they are of.
    rows : array, shape (r, n)
        Approach of each by the coordinates of the system.
    loaded : array of bool, shape (r,)
        Which have a load; l of them. Others leave out nothing.
    stiffness, damping, times, natural : array, shape (l,)
        k [N/m], c [N s/m], relaxation time and natural time [s].
    response : FilmResponse or None
        What the law leaves out; None where it holds no response of its films.
    """

    element: int
    rows: FloatArray
    loaded: BoolArray
    stiffness: FloatArray
    damping: FloatArray
    times: FloatArray
    natural: FloatArray
    response: FilmResponse | None

    def left_out(self, s: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        """Part of the dynamic stiffness that the law leaves out at frequencies s (k,) [1/s], and its possible error.

        Shape (k, r) each [N/m].
        """
        own = law_stiffness(self.stiffness, self.damping, self.times, s)
        part, doubt = np.zeros((2, s.size, self.loaded.size), dtype=np.complex128)
        if self.response is None:
            doubt[:, self.loaded] = np.abs(own) * memory_error(np.multiply.outer(np.abs(s), self.natural))
        else:
            part[:, self.loaded] = own * self.response.correction(s)
            doubt[:, self.loaded] = np.abs(own) * self.response.doubt(s)
        return part, doubt.real


@dataclass(frozen=True, eq=False)
class FilmsInBalance:
    """Films with memory of a bearing whose rolling elements are in balance.

    Attributes
    ----------
    element : int
        Which element of the system it is.
    condensed : Condensed
        The bearing.
    transform : array, shape (6, n)
        Displacement of its inner ring by the coordinates of the system.
    """

    element: int
    condensed: Condensed
    transform: FloatArray

    def left_out(self, s: ComplexArray, left: ComplexArray, right: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Part of left' Z(s) right that its films leave out, and its possible error, shape (k, a, b) each.

        Parameters
        ----------
        s, left, right
            The same as of `mbs.model.condensed.Condensed.changes_along`.
        """
        return films_in_balance(self.condensed, s, left, right)


@dataclass(frozen=True, eq=False)
class FilmPart:
    """Part that the films of all bearings leave out at an equilibrium.

    Attributes
    ----------
    groups : tuple of FilmSlices
        Groups of all bearings in slices, in the order of the elements.
    in_balance : tuple of FilmsInBalance
        Other bearings, likewise.
    """

    groups: tuple[FilmSlices, ...]
    _mass: FloatArray
    in_balance: tuple[FilmsInBalance, ...] = ()

    @property
    def known(self) -> bool:
        """Tell whether all laws hold a response of their films, so that signs are known."""
        in_slices = all(group.response is not None for group in self.groups)
        return in_slices and all(one.condensed.left_out is not None for one in self.in_balance)

    def eigenvalue_changes(
        self, eigenvalues: ComplexArray, right: ComplexArray, left: ComplexArray
    ) -> tuple[ComplexArray, FloatArray]:
        """Change of eigenvalues, and the size of its possible error, shape (modes,) each [1/s].

        Zero of motions that do not oscillate, at whose decay no film was looked at.

        Parameters
        ----------
        eigenvalues, right, left
            The same as for `mbs.linearised.bands.LawBands.eigenvalue_changes`.
        """
        swings = eigenvalues.imag > 0.0
        turned, moved, s = np.linalg.solve(self._mass, left[swings].T), right[:, swings], eigenvalues[swings]
        change, doubt = np.zeros(eigenvalues.shape, dtype=np.complex128), np.zeros(eigenvalues.shape)
        by_element = {group.element: np.zeros(s.shape, dtype=np.complex128) for group in self.groups}
        for group in self.groups:
            part, possible = group.left_out(s)
            weights = ((group.rows @ turned) * (group.rows @ moved)).T
            change[swings] -= np.sum(part * weights, axis=1)
            by_element[group.element] += np.sum(possible * weights, axis=1)
        for sums in by_element.values():
            doubt[swings] += np.abs(sums)
        for one in self.in_balance:
            ends = ((one.transform @ vectors).T[:, :, None] for vectors in (turned, moved))
            missing, wrong = one.left_out(s, *ends)
            change[swings] -= missing[:, 0, 0]
            doubt[swings] += np.abs(wrong[:, 0, 0])
        return change, doubt


def film_part(balance: Equilibrium, in_balance: Mapping[int, Condensed] = MappingProxyType({})) -> FilmPart | None:
    """Part that films with memory leave out; None where no films have a memory.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which the system is linearised.
    in_balance : mapping of int to Condensed
        Bearings whose rolling elements are in balance, by their elements.
    """
    system, found = balance.system, []
    for index in system.select(RingElement):
        connected = system.elements[index]
        element = connected.element
        assert isinstance(element, RingElement)
        for group in element.contact_groups(connected.transform @ balance.displacement, balance.operation):
            if not group.relaxes or group.law.entrainment_speed == 0.0:
                continue
            on = group.state()[0] > 0.0
            loaded = dataclasses.replace(group, rows=group.rows[on], approach=group.approach[on])
            _, stiffness, damping, times = loaded.state()
            rows, natural = group.rows @ connected.transform, loaded.natural_times()
            found.append(FilmSlices(index, rows, on, stiffness, damping, times, natural, loaded.film_response()))
    others = tuple(
        FilmsInBalance(index, one, system.elements[index].transform)
        for index, one in in_balance.items()
        if one.relaxes and np.any(one.contacts.times)
    )
    return FilmPart(tuple(found), system.mass, others) if found or others else None


def film_law_part(
    part: FilmPart | None, eigenvalues: ComplexArray, right: ComplexArray, left: ComplexArray
) -> FilmLawPart | None:
    """Part that films with memory leave out of frequencies and damping ratios.

    Parameters
    ----------
    part : FilmPart or None
        What the films leave out.
    eigenvalues, right, left
        The same as for `mbs.linearised.bands.LawBands.eigenvalue_changes`.

    Returns
    -------
    FilmLawPart or None
        None where films do not relax, or nothing is known of films that oscillate. NaN of motions that do not
        oscillate, and where the first order says nothing, as near critical damping.
    """
    if part is None or not part.known:
        return None
    swings = eigenvalues.imag > 0.0
    s, change = eigenvalues[swings], part.eigenvalue_changes(eigenvalues, right, left)[0][swings]
    moved = np.where(np.abs(change) <= FIRST_ORDER * s.imag, s + change, np.nan)
    errors = np.full((2, eigenvalues.size), np.nan)
    errors[0, swings] = (np.abs(moved) - np.abs(s)) / (2.0 * np.pi)
    errors[1, swings] = s.real / np.abs(s) - moved.real / np.abs(moved)
    return FilmLawPart(*errors)
