"""What films with memory leave out of modes: the part of the film law in eigenvalues, to first order.

Each slice has one relaxation time, see `ehdmaps.maps.film_response`. What it leaves out of the dynamic stiffness, dZ,
moves an eigenvalue by

    d lambda = -y' dZ(lambda) x,    with y' Z'(lambda) x = 1,

as the errors of a map do in `mbs.linearised.bands`. Here the signs are known, so that the parts of all slices and
bearings add up as they are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.maps.film_response import law_stiffness
from mbs.bearings.bearing_element import RingElement
from mbs.model.equilibrium import Equilibrium

FIRST_ORDER = 0.3
"""Change of an eigenvalue, by its imaginary part, above which the first order says nothing."""


class FilmLawPart(NamedTuple):
    """What the film law is estimated to be wrong by, true less found, shape (modes,) each.

    Attributes
    ----------
    frequency : array
        Part in |eigenvalue|/(2 pi) [Hz].
    damping_ratio : array
        Part in the damping ratio.
    """

    frequency: FloatArray
    damping_ratio: FloatArray


def film_law_part(
    balance: Equilibrium, eigenvalues: ComplexArray, right: ComplexArray, left: ComplexArray
) -> FilmLawPart | None:
    """What films with memory leave out of modes.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which the system is linearised.
    eigenvalues, right, left
        The same as for `mbs.linearised.bands.LawBands.eigenvalue_changes`.

    Returns
    -------
    FilmLawPart or None
        None where films do not relax, or nothing is known of films that oscillate. NaN of motions that do not
        oscillate, and where the first order says nothing, as near critical damping.
    """
    system = balance.system
    turned = np.linalg.solve(system.mass, left.T)
    swings = eigenvalues.imag > 0.0
    s, change, known = eigenvalues[swings], np.zeros(np.count_nonzero(swings), dtype=np.complex128), False
    for index in system.select(RingElement):
        connected = system.elements[index]
        element = connected.element
        assert isinstance(element, RingElement)
        for group in element.contact_groups(connected.transform @ balance.displacement, balance.operation):
            response = group.film_response() if group.relaxes else None
            if response is None:
                return None
            load, stiffness, damping, times = group.state()
            rows = group.rows @ connected.transform
            felt = np.where(load[:, None] > 0.0, (rows @ turned[:, swings]) * (rows @ right[:, swings]), 0.0)
            left_out = law_stiffness(stiffness, damping, times, s) * response.correction(s)
            change -= np.sum(left_out * felt.T, axis=1)
            known = True
    if not known:
        return None
    moved = np.where(np.abs(change) <= FIRST_ORDER * s.imag, s + change, np.nan)
    found = np.full((2, eigenvalues.size), np.nan)
    found[0, swings] = (np.abs(moved) - np.abs(s)) / (2.0 * np.pi)
    found[1, swings] = s.real / np.abs(s) - moved.real / np.abs(moved)
    return FilmLawPart(*found)
