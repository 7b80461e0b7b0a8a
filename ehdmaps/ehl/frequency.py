"""Film compliance of one point over frequency, with its error from both grids at each frequency."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.ehl.group_solution import GroupSolution, response_share
from ehdmaps.ehl.profile import Profile
from ehdmaps.ehl.spectrum import film_compliances
from ehdmaps.physics.spectrum import NEIGHBOUR, neighbours, read_beside

RESOLVED = 1.0 / 3.0
"""Phase a cell up to which a wave of film thickness is resolved by both grids [rad]."""

SPIKED = 1.0 / 3.0
"""Least share of the difference between both grids that is left where there is a pressure spike, whose front lets the
order of the response at a frequency fall to two: 1/(2^p - 1)."""

CARRIED_ABOVE = 2.0
"""Load M above which the surfaces carry the film through a Hertz zone, as a wave of omega b/u a half-width."""


class GroupSpectrum(NamedTuple):
    """Film compliance over frequency in units of b/(p_H R).

    Attributes
    ----------
    compliance : ndarray, shape (k,)
        S = -dH0/dW - ln(2)/pi, complex.
    errors : ndarray, shape (k, 5)
        Estimates of what is wrong with S, complex; their largest effect counts.
    """

    compliance: ComplexArray
    errors: ComplexArray


def group_spectrum(M: float, L: float, solution: GroupSolution, frequencies: FloatArray) -> GroupSpectrum:
    """Film compliance of a solved point at some frequencies.

    The error is what the difference between both grids at the same frequency leaves: a share of it as for slow motion,
    which rises to the whole difference where a wave of film thickness, which has omega b/u a half-width, turns by one
    radian a cell and more. The coarse grid then loses the wave. Where the fine grid loses it too, both agree on what
    is wrong: so at these frequencies the difference at the last ones that are resolved counts as well.

    Parameters
    ----------
    M, L : float
        Moes' load and lubricant parameters of the point.
    solution : GroupSolution
        Converged solution of the point.
    frequencies : ndarray, shape (k,)
        Omega = omega b/u, > 0.
    """
    fine, linear, rough = solution.profile, solution.linear, solution.rough_linear
    assert fine is not None and linear is not None and rough is not None
    cell = _widest_cell(fine) if M > CARRIED_ABOVE else 0.0
    last = RESOLVED / cell if cell > 0.0 else math.inf
    beside = np.column_stack(
        [
            neighbours(frequencies),
            np.minimum(frequencies, last),
            np.minimum(frequencies, last * NEIGHBOUR),
        ]
    )
    where, index = np.unique(beside, return_inverse=True)
    found = film_compliances(linear, where)
    difference = film_compliances(rough, where) - found
    index = index.reshape(beside.shape)
    nearby = read_beside(difference, where, index, frequencies)
    share = response_share(M, L, fine.spike is not None)
    share = max(share, SPIKED) if fine.spike is not None else share
    share_at = share + (1.0 - share) * np.minimum(1.0, (frequencies * cell) ** 2)
    return GroupSpectrum(found[index[:, 0]], share_at[:, None] * nearby)


def _widest_cell(profile: Profile) -> float:
    """Widest cell of the Hertz zone [b]; 0 where the film is so thick that there is none."""
    inside = np.abs(profile.position) < 1.0
    return float(np.max(profile.grid.step[inside], initial=0.0))
