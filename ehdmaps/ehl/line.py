"""The story of one solve: coarse grid, place of the spike, fine grid, linear response, error estimate.

Everything here is in the groups of the problem (Hertz-dimensionless); `solver` adds the units.
"""

from __future__ import annotations

import math
from dataclasses import replace

from ehdmaps.ehl.group_solution import GroupSolution, assembled
from ehdmaps.ehl.newton import CONVERGED
from ehdmaps.ehl.profile import Profile
from ehdmaps.ehl.resolution import Resolution
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.ehl.two_grids import on_fine_grid
from ehdmaps.ehl.ways import coarse_solution
from ehdmaps.physics.moes import valley_load_number
from ehdmaps.physics.rheology import LIMITING

VALLEY_REFINEMENT = 1.2
"""Density of cells at the bottom of the damping valley, relative to the density elsewhere."""

OTHER_PLACES = 0.85, 0.75, 1.1
"""Densities of cells, relative to the one asked for, that are tried besides: on some grids Newton goes round in
circles, as a front stands between two cells. First of all where an oil has a limiting stress, else last of all."""

THIN_FILM = 20.0
"""Load M above which a negative loss can only be a numerical one."""


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
    """Whether film compliance and loss are small differences of large parts: the bottom of the damping valley."""
    return L > 10.0 and abs(math.log(M / valley_load_number(L))) < 0.35


def _solve_once(
    problem: LineProblem,
    M: float,
    L: float,
    resolution: Resolution,
    previous: Profile | None,
) -> GroupSolution:
    """One solve at one resolution."""
    coarse, steps, outcome = coarse_solution(problem, M, L, resolution, previous)
    if coarse is None:
        return GroupSolution(outcome=outcome, profile=None, steps=steps)
    fine, more, outcome = on_fine_grid(coarse, resolution.tolerance)
    steps += more
    if fine is None:
        return GroupSolution(outcome=outcome, profile=None, steps=steps)
    return assembled(M, L, fine, coarse, resolution, steps)
