"""Newton on one grid: an isothermal film, a warm one, or that of an oil that is let yield step by step."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.elastic import log_kernel
from ehdmaps.ehl.grid import Grid, Layout, Spike, thick_film_exit
from ehdmaps.ehl.newton import CONVERGED, DIVERGED, STAGNATED, hertz_start, newton
from ehdmaps.ehl.profile import Profile, Warmth, warm_start
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.ehl.warm_newton import warm_newton
from ehdmaps.ehl.warm_oil import NO_HEAT
from ehdmaps.physics.rheology import LIMITING, NEWTONIAN

LOAD = 0.5 * math.pi
"""Int P dX of a pressure in units of p_H over lengths in units of b."""

MOST_STEPS = 60
"""Newton steps on one grid after which a point counts as stagnated."""

MOST_WARM_STEPS = 30
"""The same for a film with temperatures, whose steps take longer."""

LOOSE_TOLERANCE = 1e-2
"""Newton tolerance while the place of the spike is still being looked for."""

STRONGEST = 64.0
"""Largest strength of the oil, a factor on its stresses, with which the way to an oil that yields may begin."""

WEAKENING, LEAST_WEAKENING = 0.5, 0.98
"""First factor from one strength to the next on that way, and the factor closest to one that is tried."""


def converged(
    problem: LineProblem,
    layout: Layout,
    grid: Grid,
    start: FloatArray | None,
    spike: Spike | None,
    tolerance: float,
    near: Profile | None = None,
) -> tuple[Profile | None, int, int]:
    """Newton on one grid: profile (None unless converged), steps, outcome.

    Parameters
    ----------
    problem : LineProblem
        The groups that enter the equations.
    layout, grid
        Grid, and the layout that it was made of.
    start : ndarray, shape (n + 2,), or None
        Unknowns to start from; None for a start from Hertz' pressure.
    spike : Spike or None
        Spike for which the grid is laid.
    tolerance : float
        Newton tolerance.
    near : Profile, optional
        Solution nearby that gives temperatures to start from, and the kernel where it has the same grid.
    """
    kernel = near.kernel if near is not None and near.grid is grid else log_kernel(grid.x, grid.step)
    if start is None:
        guess = layout.film
        start = hertz_start(grid.x, grid.step, kernel, guess, thick_film_exit(guess), LOAD)
    if problem.heat.log_eta.size > 0:
        return _converged_warm(problem, layout, grid, kernel, start, spike, tolerance, near)
    unknowns, steps, outcome = _isothermal(problem, grid, kernel, start, tolerance)
    if outcome != CONVERGED and problem.shear.form != NEWTONIAN:
        unknowns, more, outcome = _weakened(problem, grid, kernel, start, tolerance)
        steps += more
    if outcome != CONVERGED:
        return None, steps, outcome
    return Profile(problem, layout, grid, kernel, unknowns, spike), steps, CONVERGED


def _isothermal(
    problem: LineProblem, grid: Grid, kernel: FloatArray, start: FloatArray, tolerance: float
) -> tuple[FloatArray, int, int]:
    """Newton on one grid without temperatures: unknowns, steps, outcome."""
    result = newton(problem, grid.x, grid.step, grid.face_step, kernel, start, LOAD, tolerance, MOST_STEPS)
    return result.unknowns, result.steps, result.outcome


def _weakened(
    problem: LineProblem, grid: Grid, kernel: FloatArray, start: FloatArray, tolerance: float
) -> tuple[FloatArray, int, int]:
    """Newton on one grid for an oil that bears more stress, which is let yield more and more."""
    strength, total, outcome, unknowns = 1.0, 0, STAGNATED, start
    while outcome != CONVERGED and strength < STRONGEST:
        strength /= WEAKENING
        unknowns, steps, outcome = _isothermal(_stronger(problem, strength), grid, kernel, start, tolerance)
        total += steps
    weakening = WEAKENING
    while outcome == CONVERGED and strength > 1.0:
        weaker = max(1.0, strength * weakening)
        trial, steps, found = _isothermal(_stronger(problem, weaker), grid, kernel, unknowns, tolerance)
        total += steps
        if found == CONVERGED:
            unknowns, strength, weakening = trial, weaker, weakening**1.5
        else:
            weakening = math.sqrt(weakening)
            outcome = found if weakening > LEAST_WEAKENING else CONVERGED
    return unknowns, total, outcome


def _stronger(problem: LineProblem, factor: float) -> LineProblem:
    """The same with an oil that bears more stress before it yields."""
    shear = problem.shear
    return problem._replace(shear=shear._replace(stress=factor * shear.stress, ratio=factor * shear.ratio))


def _converged_warm(
    problem: LineProblem,
    layout: Layout,
    grid: Grid,
    kernel: FloatArray,
    start: FloatArray,
    spike: Spike | None,
    tolerance: float,
    near: Profile | None,
) -> tuple[Profile | None, int, int]:
    """Newton on one grid for a film with its temperatures."""
    rises = warm_start(near, grid)
    metric = (grid.x, grid.step, grid.face, grid.face_step, kernel)
    steps = 0
    try:
        here = near is not None and near.warmth is not None and near.grid is grid and near.problem is problem
        result = warm_newton(problem, *metric, start, rises, LOAD, tolerance, MOST_WARM_STEPS, here)
        steps = result.steps
        if result.outcome != CONVERGED and problem.shear.form == LIMITING:
            # a start from another grid asks for more stress than the oil bears: the isothermal film has soft tangents
            cold = problem._replace(heat=NO_HEAT)
            iso = newton(cold, *metric[:2], *metric[3:], start, LOAD, LOOSE_TOLERANCE, MOST_STEPS)
            steps += iso.steps
            if iso.outcome == CONVERGED:
                result = warm_newton(problem, *metric, iso.unknowns, rises, LOAD, tolerance, MOST_WARM_STEPS, False)
                steps += result.steps
    except np.linalg.LinAlgError:
        return None, steps, DIVERGED
    if result.outcome != CONVERGED:
        return None, steps, result.outcome
    warmth = Warmth(result.rises, result.first)
    return Profile(problem, layout, grid, kernel, result.unknowns, spike, warmth), steps, CONVERGED
