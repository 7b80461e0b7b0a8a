"""A point on its two grids: coarse ones until the spike stands where the grid expects it, then twice the cells."""

from __future__ import annotations

import math

from ehdmaps.ehl.grid import Spike, lay_out, zone_width
from ehdmaps.ehl.newton import CONVERGED
from ehdmaps.ehl.one_grid import LOOSE_TOLERANCE, converged
from ehdmaps.ehl.profile import Profile, front, moved, refined, starved_start
from ehdmaps.ehl.resolution import Resolution
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.physics.films import moes_central

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
        layout = lay_out(guess, resolution.inlet_length, resolution.shape, spike, length)
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
