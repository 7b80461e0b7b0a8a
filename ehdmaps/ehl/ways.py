"""The ways to a solution: Newton on one grid, a point on two, starts from before, from Hertz, up ladders of loads.

Grids that are finer than one on which the spike is found start from the solution there.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.column import NO_HEAT
from ehdmaps.ehl.grid import Grid, Layout, Spike, lay_out, log_kernel, points_across, thick_film_exit, zone_width
from ehdmaps.ehl.limits import SEARCH_DENSITY, Resolution
from ehdmaps.ehl.newton import CONVERGED, DIVERGED, STAGNATED, hertz_start, newton
from ehdmaps.ehl.profile import Profile, Warmth, front, moved, refined, starved_start, warm_start
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.ehl.warm_newton import warm_newton
from ehdmaps.physics.films import moes_central
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
        trial, steps, trial_outcome = _isothermal(_stronger(problem, weaker), grid, kernel, unknowns, tolerance)
        total += steps
        if trial_outcome == CONVERGED:
            unknowns, strength, weakening = trial, weaker, weakening**1.5
        else:
            weakening = math.sqrt(weakening)
            outcome = trial_outcome if weakening > LEAST_WEAKENING else CONVERGED
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
    rises = warm_start(near, grid, problem.heat.across.heights.size)
    metric = (grid.x, grid.step, grid.face, grid.face_step, kernel)
    steps = 0
    try:
        here = near is not None and near.warmth is not None and near.grid is grid
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


LEAST_SPAN = 8.0
"""e-folds of distance for which a starved film gets cells at least: it can be short beside the gap's own length."""

MOST_MOVES = 6
"""Coarse grids laid in search of the spike."""

NARROWING = 2.0
"""Ratio of two spikes' widths up to which both grids have the spike at about the same share of their nodes."""


def expected_film(M: float, L: float) -> float:
    """Film H [b^2/R] about which the grid is laid: 0.8 of the Moes central film."""
    return 0.8 * float(moes_central(M, max(L, 1e-6))) * math.pi / (8.0 * M)


def problem_load(problem: LineProblem) -> float:
    """Moes' M of the groups."""
    return math.sqrt(3.0 * math.pi**2 / (8.0 * problem.wedge))


def on_coarse_grid(
    problem: LineProblem,
    guess: float,
    resolution: Resolution,
    previous: Profile | None,
    length: float | None = None,
) -> tuple[Profile | None, int, int]:
    """Solve on one coarse grid after another, loosely at first, until the spike stands where the grid expects it.

    From a neighbouring load the spike is expected where it was, times the ratio of loads to the power of -0.7 (seen
    over L = 10 to 50), and the start is carried over by index, so that the front moves with its cells: Newton moves it
    by one cell a step only.

    Parameters
    ----------
    problem : LineProblem
        The groups that enter the equations.
    guess : float
        Film about which the grid is laid [b^2/R].
    resolution : Resolution
        Accuracy and cost.
    previous : Profile or None
        Solution nearby to start from; None for a start from Hertz' pressure.
    length : float, optional
        Distance from the meniscus of a starved contact to the exit [b]; left out where it is flooded.

    Returns
    -------
    profile : Profile or None
        Solution on the last grid; None where Newton found none.
    steps, outcome : int
        Newton steps, all grids together, and how the last of them ended.
    """
    total = 0
    zone = zone_width(guess)
    finest = resolution.finest_spike * min(1.0, zone / 0.3)
    spike, same_share = None, False
    if previous is not None and previous.spike is not None:
        ratio = problem_load(problem) / problem_load(previous.problem)
        same_share = previous.spike.width < NARROWING * finest and finest < NARROWING * previous.spike.width
        place = previous.spike.position if same_share else front(previous)[0]
        spike = Spike(place * ratio**-0.7, finest)
    solution = near = previous
    for attempt in range(MOST_MOVES):
        layout = lay_out(guess, resolution.inlet, resolution.shape, spike, length)
        span = layout.span if length is None else max(layout.span, LEAST_SPAN)
        grid = layout.grid(math.ceil(0.5 * resolution.density * span))
        if solution is None:
            unknowns = None
        elif length is None:
            unknowns = moved(solution, grid, by_index=attempt == 0 and same_share)
        else:
            unknowns = starved_start(solution, grid)
        for tolerance in (LOOSE_TOLERANCE, resolution.tolerance):
            solution, steps, outcome = converged(problem, layout, grid, unknowns, spike, tolerance, near)
            total += steps
            if solution is None:
                return None, total, outcome
            unknowns, near = solution.unknowns, solution
            place, steepness = front(solution)
            if spike is None:
                settled = steepness * zone < resolution.spike_steepness * max(1.0, problem_load(problem) / 100.0)
            else:
                settled = abs(place - spike.position) < 0.5 * finest and spike.width == finest
            if not settled and attempt < MOST_MOVES - 1:
                spike = Spike(place, finest)
                break
        else:
            break
    return solution, total, CONVERGED


def on_fine_grid(coarse: Profile, tolerance: float) -> tuple[Profile | None, int, int]:
    """Newton on the grid with twice the cells, by way of one with half as many more if need be."""
    problem, layout, spike = coarse.problem, coarse.layout, coarse.spike
    grid = layout.grid(2 * coarse.cells)
    start = starved_start(coarse, grid) if layout.starved else refined(coarse, grid)
    fine, total, outcome = converged(problem, layout, grid, start, spike, tolerance, coarse)
    if fine is None:
        halfway = layout.grid(3 * coarse.cells // 2)
        start = moved(coarse, halfway, by_index=False)
        between, steps, _ = converged(problem, layout, halfway, start, spike, tolerance, coarse)
        total += steps
        if between is not None:
            start = moved(between, grid, by_index=False)
            fine, steps, outcome = converged(problem, layout, grid, start, spike, tolerance, between)
            total += steps
    return fine, total, outcome


def with_points(profile: Profile, points: int, tolerance: float) -> tuple[Profile | None, int, int]:
    """The same film on the same grid with other points across it: profile (None unless converged), steps, outcome.

    Parameters
    ----------
    profile : Profile
        A film with its temperatures.
    points : int
        Points across.
    tolerance : float
        Newton tolerance.
    """
    heat = profile.problem.heat
    problem = profile.problem._replace(heat=heat._replace(across=points_across(points)))
    return converged(problem, profile.layout, profile.grid, profile.unknowns, profile.spike, tolerance, profile)


COLD_START_BELOW = 1.0
"""Load M below which the cold start is as good as any other."""

REFINEMENT = 1.5
"""Ratio of the densities of grids that are finer than `SEARCH_DENSITY`, one after another."""

LADDER_RATIO, STEEP_LADDER_RATIO = 1.5, 1.2
"""Steps in M from a light load up to a point that does not converge by itself, up to L = 30 and above."""

LADDER_FEET = 1.0, 0.2
"""Starts of such a ladder, over the load `COLD_START_BELOW`/2 or a lighter one: the second where the first fails."""

FIRST_HEAT, LEAST_HEAT = 0.25, 0.01
"""First part of the heat that is let in on the way to a film with temperatures, and the least part at once. A contact
at 10 m/s and 20 degC is not found in steps of a tenth from 30 N/mm on, in steps of a hundredth it is up to 80."""


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
    searched = resolution if density == resolution.density else replace(resolution, density=density)
    profile, total, outcome = _first(problem, M, L, searched, previous)
    finer = resolution
    while profile is not None and density < resolution.density:
        growth = min(REFINEMENT, resolution.density / density)
        density *= growth
        for widening in (1.0, growth * growth):
            finer = replace(finer, density=density, spike_width=widening * finer.spike_width)
            trial, steps, outcome = on_coarse_grid(problem, expected_film(M, L), finer, profile)
            total += steps
            if trial is not None:
                break
        profile = trial
    return profile, total, outcome


def _first(
    problem: LineProblem, M: float, L: float, resolution: Resolution, previous: Profile | None
) -> tuple[Profile | None, int, int]:
    """Coarse solution with the spike in its place: from the previous point, from Hertz, or up a ladder of loads."""
    if problem.heat.log_eta.size > 0:
        return _heated(problem, M, L, resolution, previous)
    guess = expected_film(M, L)
    total, outcome = 0, CONVERGED
    warm = previous if M >= COLD_START_BELOW else None
    profile: Profile | None = None
    if warm is not None:
        profile, steps, outcome = on_coarse_grid(problem, guess, resolution, warm)
        total += steps
    if profile is None and (M < 20.0 or problem.shear.form != NEWTONIAN):
        profile, steps, outcome = on_coarse_grid(problem, guess, resolution, None)
        total += steps
    if profile is None:
        profile, steps, outcome = _climb(problem, M, L, resolution)
        total += steps
    return profile, total, outcome


def _heated(
    problem: LineProblem, M: float, L: float, resolution: Resolution, previous: Profile | None
) -> tuple[Profile | None, int, int]:
    """Coarse solution of a film with temperatures: from the previous point, or from the isothermal film, heated up."""
    guess, total, outcome = expected_film(M, L), 0, STAGNATED
    if previous is not None and M >= COLD_START_BELOW:
        profile, steps, outcome = on_coarse_grid(problem, guess, resolution, previous)
        total += steps
        if profile is not None:
            return profile, total, outcome
    cold, steps, outcome = _first(problem._replace(heat=NO_HEAT), M, L, resolution, None)
    total += steps
    if cold is None:
        return None, total, outcome
    profile, steps, outcome = on_coarse_grid(problem, guess, resolution, cold)
    total += steps
    if profile is not None:
        return profile, total, outcome
    reached, part, profile = 0.0, FIRST_HEAT, cold
    while reached < 1.0 and part > LEAST_HEAT:
        share = min(1.0, reached + part)
        trial, steps, outcome = on_coarse_grid(_less_heated(problem, share), guess, resolution, profile)
        total += steps
        if trial is None:
            part *= 0.5
        else:
            profile, reached, part = trial, share, 1.5 * part
    return profile if reached == 1.0 else None, total, outcome


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
