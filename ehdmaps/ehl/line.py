"""One solve: coarse grid, place of the spike, fine grid, linear response, error; the same over frequency.

Everything here is in the groups of the problem (Hertz-dimensionless); `solver` adds the units.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.ehl.group_solution import GroupSolution, assembled, left_across, response_share
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.newton import CONVERGED
from ehdmaps.ehl.profile import Profile
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.ehl.spectrum import film_compliances
from ehdmaps.ehl.ways import coarse_solution, on_fine_grid, with_points
from ehdmaps.physics.moes import valley_load_number
from ehdmaps.physics.rheology import LIMITING
from ehdmaps.physics.spectrum import NEIGHBOUR, neighbours, read_beside

VALLEY_REFINEMENT = 1.2
"""Density of cells at the bottom of the damping valley, relative to the density elsewhere."""

OTHER_PLACES = 0.85, 0.75, 1.1
"""Densities of cells, relative to the one asked for, that are tried besides: on some grids Newton goes round in
circles, as a front stands between two cells. First of all where an oil has a limiting stress, else last of all."""

THIN_FILM = 20.0
"""Load M above which a negative loss can only be a numerical one."""


MORE_ACROSS, LESS_ACROSS = (13, 19, 29), 7
"""Points across a film with temperatures that are tried after `ACROSS`, and instead where none of them are found."""

ACROSS_TOLERANCE = 1e-3
"""Relative error of the film offset by the points across up to which they are enough."""


def solve_groups(
    problem: LineProblem,
    M: float,
    L: float,
    resolution: Resolution,
    previous: Profile | None = None,
) -> GroupSolution:
    """Film of one point and its response to slow motion.

    Parameters
    ----------
    problem : LineProblem
        The groups that enter the equations.
    M, L : float
        Moes' load and lubricant parameters of the same point; used for grids and starts.
    resolution : Resolution
        Accuracy and cost.
    previous : Profile, optional
        Solution at a neighbouring load, a better start than none.
    """
    if _at_valley_bottom(M, L):
        resolution = replace(resolution, density=VALLEY_REFINEMENT * resolution.density)
    solution = _solve_once(problem, M, L, resolution, previous)
    if solution.outcome == CONVERGED and (solution.loss > 0.0 or M < THIN_FILM):
        return solution
    steps = solution.steps
    nearby = [replace(resolution, density=factor * resolution.density) for factor in OTHER_PLACES]
    others, last = (nearby, []) if problem.shear.form == LIMITING else ([], nearby)
    if problem.heat.log_eta.size == 0:  # with temperatures these take minutes, for few points
        others = [*others, resolution.with_wide_spike, replace(resolution, density=2.0 * resolution.density), *last]
    for again in others:
        # a coarser grid is no remedy for a negative loss
        if solution.outcome == CONVERGED and (solution.loss > 0.0 or M < THIN_FILM or again in last):
            break
        if again == resolution:
            continue
        # a front that is narrower than Newton finds its way to; a grid too coarse for the inlet of a heavily loaded
        # contact, which does not converge either, or shows a negative loss
        trial = _solve_once(problem, M, L, again, solution.profile)
        steps += trial.steps
        solution = trial if trial.outcome == CONVERGED else solution
    return replace(solution, steps=steps)


def _at_valley_bottom(M: float, L: float) -> bool:
    """True where film compliance and loss are small differences of large parts: the bottom of the damping valley."""
    return L > 10.0 and abs(math.log(M / valley_load_number(L))) < 0.35


def _solve_once(
    problem: LineProblem,
    M: float,
    L: float,
    resolution: Resolution,
    previous: Profile | None,
) -> GroupSolution:
    """One solve at one resolution.

    A film with temperatures takes as many points across as its error asks for; where that leads to no solution, those
    that do, and says what error they leave.
    """
    coarse, steps, outcome = coarse_solution(problem, M, L, resolution, previous)
    if coarse is None:
        return GroupSolution(outcome=outcome, profile=None, steps=steps)
    if coarse.warmth is None:
        fine, more, outcome = on_fine_grid(coarse, resolution.tolerance)
        if fine is None:
            return GroupSolution(outcome=outcome, profile=None, steps=steps + more)
        return assembled(M, L, fine, coarse, resolution, steps + more)
    known, more, outcome = _by_points(coarse, resolution.tolerance)
    steps += more
    for chosen in _in_turn(known):
        fine, more, outcome = on_fine_grid(chosen, resolution.tolerance)
        steps += more
        if fine is not None:
            return assembled(M, L, fine, chosen, resolution, steps, _witness(known, chosen))
    return GroupSolution(outcome=outcome, profile=None, steps=steps)


def _by_points(coarse: Profile, tolerance: float) -> tuple[list[Profile], int, int]:
    """Films on the coarse grid by their points across, up to where the error of these is small: two at least, or none.

    Newton steps that they took, and how the last one that was asked for ended.
    """
    known, total, outcome = [coarse], 0, CONVERGED
    for points in MORE_ACROSS:
        trial, steps, outcome = with_points(known[-1], points, tolerance)
        total += steps
        if trial is None:
            break
        known.append(trial)
        if left_across(known[-1], known[-2]) <= ACROSS_TOLERANCE:
            break
    if len(known) == 1:
        trial, steps, _ = with_points(coarse, LESS_ACROSS, tolerance)
        total += steps
        known = [] if trial is None else [trial, coarse]
    return known, total, outcome


def _witness(known: list[Profile], chosen: Profile) -> Profile:
    """The film with the most points but for the chosen one, which shows the error of the points of that."""
    return [each for each in known if each is not chosen][-1]


def _in_turn(known: list[Profile]) -> list[Profile]:
    """The same, the one that is to be refined first: that of the fewest points whose error is small, or of the most."""
    good = [each for each in known if left_across(each, _witness(known, each)) <= ACROSS_TOLERANCE]
    first = good[0] if good else known[-1] if known else None
    return [] if first is None else [first, *(each for each in reversed(known) if each is not first)]


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
    compliances = film_compliances(linear, where)
    difference = film_compliances(rough, where) - compliances
    index = index.reshape(beside.shape)
    nearby = read_beside(difference, where, index, frequencies)
    share = response_share(M, L, fine.spike is not None)
    share = max(share, SPIKED) if fine.spike is not None else share
    share_at = share + (1.0 - share) * np.minimum(1.0, (frequencies * cell) ** 2)
    return GroupSpectrum(compliances[index[:, 0]], share_at[:, None] * nearby)


def _widest_cell(profile: Profile) -> float:
    """Widest cell of the Hertz zone [b]; 0 where the film is so thick that there is none."""
    inside = np.abs(profile.position) < 1.0
    return float(np.max(profile.grid.step[inside], initial=0.0))
