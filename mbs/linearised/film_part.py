"""Part that films with memory leave out of a linear analysis: of its modes, and of its dynamic stiffness.

Each slice has one relaxation time, which the film solver has not, see `ehdmaps.maps.kernels.film_response`; a ball has
a few springs and dampers. What they leave out of the dynamic stiffness, dZ of `mbs.model.condensed`, moves an
eigenvalue by

    d lambda = -y' dZ(lambda) x,    with y' Z'(lambda) x = 1,

as the errors of a map do in `mbs.linearised.bands`. Here the signs are known, so that the parts of all bearings add up
as they are. How wrong dZ may be as it is read is known by its size alone; it counts as having one phase along the loads
of a bearing. A law that holds no response of its films has that size for all of dZ.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.linearised.mode_part import ModePart, moved
from mbs.linearised.validity import films_in_balance
from mbs.model.condensed import Condensed
from mbs.model.elements import OnRings
from mbs.model.equilibrium import Equilibrium

FIRST_ORDER = 0.3
"""Change of an eigenvalue, by its imaginary part, above which the first order says nothing."""


@dataclass(frozen=True, eq=False)
class CondensedBearing:
    """A bearing whose rolling elements are in balance, in a system.

    Attributes
    ----------
    element : int
        Which element of the system it is.
    condensed : Condensed
        The bearing.
    transform : array, shape (p, n)
        Displacement of its ports by the coordinates of the system.
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


def condensed_bearings(balance: Equilibrium) -> tuple[CondensedBearing, ...]:
    """All bearings of a system that have films, in the order of its elements.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which the system is linearised.
    """
    found = []
    for index in balance.system.select(OnRings):
        connected = balance.system.elements[index]
        element, transform = connected.element, connected.transform
        assert isinstance(element, OnRings)
        condensed = element.small_motions(transform @ balance.displacement, balance.operation)
        found += [] if condensed is None else [CondensedBearing(index, condensed, transform)]
    return tuple(found)


@dataclass(frozen=True, eq=False)
class FilmPart:
    """Part that the films of all bearings leave out at an equilibrium.

    Attributes
    ----------
    bearings : tuple of CondensedBearing
        Bearings whose films have a memory, in the order of the elements.
    """

    bearings: tuple[CondensedBearing, ...]
    _mass: FloatArray

    @property
    def known(self) -> bool:
        """Tell whether all laws hold a response of their films, so that signs are known."""
        return all(one.condensed.left_out is not None for one in self.bearings)

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
        for one in self.bearings:
            ends = ((one.transform @ vectors).T[:, :, None] for vectors in (turned, moved))
            missing, wrong = one.left_out(s, *ends)
            change[swings] -= missing[:, 0, 0]
            doubt[swings] += np.abs(wrong[:, 0, 0])
        return change, doubt


def film_part(balance: Equilibrium, bearings: Sequence[CondensedBearing] | None = None) -> FilmPart | None:
    """Part that films with memory leave out; None where no films have a memory.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which the system is linearised.
    bearings : sequence of CondensedBearing, optional
        Bearings of the system, where they are condensed already.
    """
    found = tuple(
        one
        for one in (condensed_bearings(balance) if bearings is None else bearings)
        if one.condensed.relaxes and np.any(one.condensed.contacts.times)
    )
    return FilmPart(found, balance.system.mass) if found else None


def film_law_part(
    part: FilmPart | None, eigenvalues: ComplexArray, right: ComplexArray, left: ComplexArray
) -> ModePart | None:
    """Part that films with memory leave out of frequencies and damping ratios.

    Parameters
    ----------
    part : FilmPart or None
        What the films leave out.
    eigenvalues, right, left
        The same as for `mbs.linearised.bands.LawBands.eigenvalue_changes`.

    Returns
    -------
    ModePart or None
        None where films do not relax, or nothing is known of films that oscillate. NaN of motions that do not
        oscillate, and where the first order says nothing, as near critical damping.
    """
    if part is None or not part.known:
        return None
    swings = eigenvalues.imag > 0.0
    change = np.full(eigenvalues.shape, complex(np.nan, np.nan))
    found = part.eigenvalue_changes(eigenvalues, right, left)[0]
    tells = swings & (np.abs(found) <= FIRST_ORDER * eigenvalues.imag)
    change[tells] = found[tells]
    return moved(eigenvalues, change)
