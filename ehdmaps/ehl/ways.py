"""The ways to a coarse solution: from the point before, from Hertz, up a ladder of loads, with heat let in by parts.

Grids that are finer than one on which the spike is found start from the solution there.
"""

from __future__ import annotations

import math
from dataclasses import replace

from ehdmaps.ehl.newton import CONVERGED, STAGNATED
from ehdmaps.ehl.profile import Profile
from ehdmaps.ehl.resolution import SEARCH_DENSITY, Resolution
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.ehl.two_grids import expected_film, on_coarse_grid
from ehdmaps.ehl.warm_oil import NO_HEAT
from ehdmaps.physics.rheology import NEWTONIAN

COLD_START_BELOW = 1.0
"""Load M below which the cold start is as good as any other."""

REFINEMENT = 1.5
"""Ratio of the densities of grids that are finer than `SEARCH_DENSITY`, one after another."""

LADDER_RATIO, STEEP_LADDER_RATIO = 1.5, 1.2
"""Steps in M from a light load up to a point that does not converge by itself, up to L = 30 and above."""

LADDER_FEET = 1.0, 0.2
"""Starts of such a ladder, over the load `COLD_START_BELOW`/2 or a lighter one: the second where the first fails."""

FIRST_HEAT, LEAST_HEAT = 0.25, 0.1
"""First part of the heat that is let in on the way to a film with temperatures, and the least part at once."""


def coarse_solution(
    problem: LineProblem, M: float, L: float, resolution: Resolution, previous: Profile | None
) -> tuple[Profile | None, int, int]:
    """Coarse solution with the spike in its place, on finer and finer grids up to the density that is asked for.

    Parameters
    ----------
    problem : LineProblem
        The groups that enter the equations.
    M, L : float
        Moes' load and lubricant parameters of the same point; used for grids and starts.
    resolution : Resolution
        Accuracy and cost.
    previous : Profile or None
        Solution at a neighbouring load, a better start than none.

    Returns
    -------
    profile : Profile or None
        The solution; None where no way leads to one.
    steps, outcome : int
        Newton steps of all grids, and how the last of them ended.
    """
    density = min(resolution.density, SEARCH_DENSITY)
    found, total, outcome = _first(problem, M, L, replace(resolution, density=density), previous)
    finer = resolution
    while found is not None and density < resolution.density:
        growth = min(REFINEMENT, resolution.density / density)
        density *= growth
        for widening in (1.0, growth * growth):
            finer = replace(finer, density=density, spike_width=widening * finer.spike_width)
            trial, steps, outcome = on_coarse_grid(problem, expected_film(M, L), finer, found)
            total += steps
            if trial is not None:
                break
        found = trial
    return found, total, outcome


def _first(
    problem: LineProblem, M: float, L: float, resolution: Resolution, previous: Profile | None
) -> tuple[Profile | None, int, int]:
    """Coarse solution with the spike in its place: from the previous point, from Hertz, or up a ladder of loads."""
    if problem.heat.log_eta.size > 0:
        return _heated(problem, M, L, resolution, previous)
    guess = expected_film(M, L)
    total, outcome = 0, CONVERGED
    warm = previous if M >= COLD_START_BELOW else None
    found: Profile | None = None
    if warm is not None:
        found, steps, outcome = on_coarse_grid(problem, guess, resolution, warm)
        total += steps
    if found is None and (M < 20.0 or problem.shear.form != NEWTONIAN):
        found, steps, outcome = on_coarse_grid(problem, guess, resolution, None)
        total += steps
    if found is None:
        found, steps, outcome = _climb(problem, M, L, resolution)
        total += steps
    return found, total, outcome


def _heated(
    problem: LineProblem, M: float, L: float, resolution: Resolution, previous: Profile | None
) -> tuple[Profile | None, int, int]:
    """Coarse solution of a film with temperatures: from the previous point, or from the isothermal film, heated up."""
    guess, total, outcome = expected_film(M, L), 0, STAGNATED
    if previous is not None and M >= COLD_START_BELOW:
        found, steps, outcome = on_coarse_grid(problem, guess, resolution, previous)
        total += steps
        if found is not None:
            return found, total, outcome
    cold, steps, outcome = _first(problem._replace(heat=NO_HEAT), M, L, resolution, None)
    total += steps
    if cold is None:
        return None, total, outcome
    found, steps, outcome = on_coarse_grid(problem, guess, resolution, cold)
    total += steps
    if found is not None:
        return found, total, outcome
    reached, part, found = 0.0, FIRST_HEAT, cold
    while reached < 1.0 and part > LEAST_HEAT:
        share = min(1.0, reached + part)
        trial, steps, outcome = on_coarse_grid(_less_heated(problem, share), guess, resolution, found)
        total += steps
        if trial is None:
            part *= 0.5
        else:
            found, reached, part = trial, share, 1.5 * part
    return found if reached == 1.0 else None, total, outcome


def _less_heated(problem: LineProblem, share: float) -> LineProblem:
    """The same with a part of the heat of shear and compression."""
    heat = problem.heat
    return problem._replace(
        heat=heat._replace(dissipation=share * heat.dissipation, compression=share * heat.compression)
    )


def _climb(problem: LineProblem, M: float, L: float, resolution: Resolution) -> tuple[Profile | None, int, int]:
    """Start at a light load, and raise M step by step at the same L."""
    total, outcome = 0, CONVERGED
    for foot in LADDER_FEET:
        rung, steps, outcome = _climb_from(foot * min(M, 0.5 * COLD_START_BELOW), problem, M, L, resolution)
        total += steps
        if rung is not None:
            return rung, total, outcome
    return None, total, outcome


def _climb_from(
    foot: float, problem: LineProblem, M: float, L: float, resolution: Resolution
) -> tuple[Profile | None, int, int]:
    """Up the ladder from the load `foot`."""
    ratio = LADDER_RATIO if L < 30.0 else STEEP_LADDER_RATIO
    rungs = max(1, math.ceil(math.log(M / foot) / math.log(ratio)))
    rung: Profile | None = None
    total, outcome = 0, CONVERGED
    for k in range(rungs + 1):
        factor = (foot / M) ** (1.0 - k / rungs)
        rung_film = expected_film(M * factor, L)
        rung, steps, outcome = on_coarse_grid(at_load(problem, factor), rung_film, resolution, rung)
        total += steps
        if rung is None:
            break
    return rung, total, outcome


def at_load(problem: LineProblem, factor: float) -> LineProblem:
    """The same contact, oil and speed at `factor` times the load: p_H and b go with its square root."""
    root = math.sqrt(factor)
    return problem._replace(
        wedge=problem.wedge / (factor * factor),
        isotherm=problem.isotherm.scaled(root),
        shear=problem.shear.scaled(1.0 / factor, root),
        heat=problem.heat.scaled(factor) if problem.heat.log_eta.size > 0 else problem.heat,
    )
