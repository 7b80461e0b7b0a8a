"""The story of one solve: coarse grid, place of the spike, fine grid, linear response, error estimate.

Everything here is in the groups of the problem (Hertz-dimensionless); `solver` adds the units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.elastic import log_kernel
from ehdmaps.ehl.grid import Grid, GridShape, Layout, Spike, lay_out, thick_film_exit, zone_width
from ehdmaps.ehl.linearisation import GridShift, Linearisation, Neighbour, linearised
from ehdmaps.ehl.newton import CONVERGED, DIVERGED, STAGNATED, hertz_start, newton
from ehdmaps.ehl.profile import (
    Profile,
    Warmth,
    films_of,
    front,
    front_cell,
    front_node,
    moved,
    refined,
    starved_start,
    warm_start,
)
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.ehl.warm_newton import warm_newton
from ehdmaps.ehl.warm_oil import NO_HEAT
from ehdmaps.ehl.warm_response import WarmLinearisation, warm_linearised
from ehdmaps.physics.films import moes_central
from ehdmaps.physics.isotherm import log_viscosity
from ehdmaps.physics.moes import valley_load_number
from ehdmaps.physics.peak import peak_sampling_error
from ehdmaps.physics.rheology import LIMITING, NEWTONIAN

LOAD = 0.5 * math.pi
"""Int P dX of a pressure in units of p_H over lengths in units of b."""

MOST_STEPS = 60
"""Newton steps on one grid after which a point counts as stagnated."""

SPIKE_SHIFT = 1e-4
"""Shift of the spike, in its widths, over which the effect of the grid's motion is differenced."""

LENGTH_SHIFT = 1e-5
"""Change of a starved inlet's length over which the effect of its end is differenced, relative to the length, or to the
film where that is less: nodes that move by more change the gap of a thin film."""

LEAST_SPAN = 8.0
"""e-folds of distance for which a starved film gets cells at least: it can be short beside the gap's own length."""

MOST_MOVES = 6
"""Coarse grids laid in search of the spike."""

MOST_WARM_STEPS = 30
"""The same for a film with temperatures, whose steps take longer."""

LOOSE_TOLERANCE = 1e-2
"""Newton tolerance while the place of the spike is still being looked for."""

COLD_START_BELOW = 1.0
"""Load M below which the cold start is as good as any other."""

VALLEY_REFINEMENT = 1.2
"""Density of cells at the bottom of the damping valley, relative to the density elsewhere."""

OTHER_PLACES = 0.85, 0.75, 1.1
"""Densities of cells, relative to the one asked for, that are tried besides where an oil has a limiting stress: on some
grids Newton goes round in circles, as its front stands between two cells."""

THIN_FILM = 20.0
"""Load M above which a negative loss can only be a numerical one."""

SEARCH_DENSITY = 6.5
"""Density of cells up to which a spike is looked for from afar; finer grids start from the solution there. Newton moves
a front by one cell a step, and a narrower cell lets it move less far."""

REFINEMENT = 1.5
"""Ratio of the densities of such grids, one after another."""

NARROWING = 2.0
"""Ratio of two spikes' widths up to which both grids have the spike at about the same share of their nodes."""

LADDER_RATIO, STEEP_LADDER_RATIO = 1.5, 1.2
"""Steps in M from a light load up to a point that does not converge by itself, up to L = 30 and above."""

LADDER_FEET = 1.0, 0.2
"""Starts of such a ladder, over the load `COLD_START_BELOW`/2 or a lighter one: the second where the first fails."""


FIRST_HEAT, LEAST_HEAT = 0.25, 0.1
"""First part of the heat that is let in on the way to a film with temperatures, and the least part at once."""

STRONGEST = 64.0
"""Largest strength of the oil, a factor on its stresses, with which the way to an oil that yields may begin."""

WEAKENING, LEAST_WEAKENING = 0.5, 0.98
"""First factor from one strength to the next on that way, and the factor closest to one that is tried."""


@dataclass(frozen=True)
class Resolution:
    """What decides accuracy and cost of a solve.

    Attributes
    ----------
    density : float
        Cells of the fine grid per e-fold of distance from inlet, exit and spike (about 100 cells a contact at 7);
        the error is estimated against the grid with half as many.
    inlet_length : float
        Length of the inlet in units of sqrt(2 h R).
    tolerance : float
        Newton tolerance on the last step; convergence is quadratic, so what remains is about its square.
    spike_width : float
        Width of the finest cells around the pressure spike [b], see `finest_spike`; less where inlet and exit zones are
        narrower.
    spike_steepness : float
        Fall of pressure behind the spike, in p_H per width of the exit zone, above which the spike gets cells of its
        own and the linearised grid follows it; M/100 times as much above M = 100, where the edge of the Hertz
        zone alone is that steep.
    shape : GridShape
        Distribution of the grid's cells.
    """

    density: float = 6.5
    inlet_length: float = 300.0
    tolerance: float = 1e-6
    spike_width: float = 0.1
    spike_steepness: float = 0.6
    shape: GridShape = field(default_factory=GridShape)

    @property
    def finest_spike(self) -> float:
        """Width of the finest cells around the pressure spike [b] for this density.

        Where the spike stands between two nodes is an error of the order of its cell. On finer grids the width falls
        with the square of the density, so that this error falls with the third power.
        """
        return self.spike_width * self._narrowing

    @property
    def _narrowing(self) -> float:
        """How much narrower the finest cells around the spike are than on a coarse grid."""
        return min(1.0, SEARCH_DENSITY / self.density) ** 2

    @property
    def with_wide_spike(self) -> Resolution:
        """The same but for a spike whose finest cells are as wide as on a coarse grid."""
        return replace(self, spike_width=self.spike_width / self._narrowing)


@dataclass(frozen=True)
class GroupSolution:
    """Film of one point in units of b, p_H, b^2/R and b/u, with estimated relative errors.

    The rolling force has the unit p_H b^2/R, the mass flow b^2/R times density at rest and u. Rises are those of the
    highest temperatures in the film and of its surfaces [K], NaN of an isothermal film.
    Those of film offset, film compliance and loss are positive where the value is too large, the others always.
    `profile` is the fine solution and `rough` the coarse one, `linear` and `rough_linear` the equations about them;
    None where there is none.
    """

    outcome: int
    profile: Profile | None
    rough: Profile | None = None
    linear: Linearisation | WarmLinearisation | None = None
    rough_linear: Linearisation | WarmLinearisation | None = None
    film_offset: float = math.nan
    film_compliance: float = math.nan
    loss: float = math.nan
    central_film: float = math.nan
    minimum_film: float = math.nan
    max_pressure: float = math.nan
    rolling_force: float = math.nan
    mass_flow: float = math.nan
    film_rise: float = math.nan
    surface_rise: float = math.nan
    film_offset_error: float = math.nan
    film_compliance_error: float = math.nan
    loss_error: float = math.nan
    central_film_error: float = math.nan
    minimum_film_error: float = math.nan
    max_pressure_error: float = math.nan
    rolling_force_error: float = math.nan
    mass_flow_error: float = math.nan
    steps: int = 0


def expected_film(M: float, L: float) -> float:
    """Film H [b^2/R] about which the grid is laid: 0.8 of the Moes central film."""
    return 0.8 * float(moes_central(M, max(L, 1e-6))) * math.pi / (8.0 * M)


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
    steps = solution.steps
    nearby = OTHER_PLACES if problem.shear.form == LIMITING else ()
    others = [replace(resolution, density=factor * resolution.density) for factor in nearby]
    if problem.heat.log_eta.size == 0:  # with temperatures these take minutes, for few points
        others += [resolution.with_wide_spike, replace(resolution, density=2.0 * resolution.density)]
    for again in others:
        if solution.outcome == CONVERGED and (solution.loss > 0.0 or M < THIN_FILM):
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
    coarse, steps, outcome = _coarse(problem, M, L, resolution, previous)
    if coarse is None:
        return GroupSolution(outcome=outcome, profile=None, steps=steps)
    fine, more, outcome = on_fine_grid(coarse, resolution.tolerance)
    steps += more
    if fine is None:
        return GroupSolution(outcome=outcome, profile=None, steps=steps)
    return assembled(M, L, fine, coarse, resolution, steps)


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
        Solution nearby that gives temperatures to start from.
    """
    kernel = log_kernel(grid.x, grid.step)
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
    try:
        result = newton(problem, grid.x, grid.step, grid.face_step, kernel, start, LOAD, tolerance, MOST_STEPS)
    except np.linalg.LinAlgError:  # a start that is too far away
        return start, 0, DIVERGED
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


def _coarse(
    problem: LineProblem, M: float, L: float, resolution: Resolution, previous: Profile | None
) -> tuple[Profile | None, int, int]:
    """Coarse solution with the spike in its place, on finer and finer grids up to the density that is asked for."""
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


def _stronger(problem: LineProblem, factor: float) -> LineProblem:
    """The same with an oil that bears more stress before it yields."""
    shear = problem.shear
    return problem._replace(shear=shear._replace(stress=factor * shear.stress, ratio=factor * shear.ratio))


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


def problem_load(problem: LineProblem) -> float:
    """Moes' M of the groups."""
    return math.sqrt(3.0 * math.pi**2 / (8.0 * problem.wedge))


def at_load(problem: LineProblem, factor: float) -> LineProblem:
    """The same contact, oil and speed at `factor` times the load: p_H and b go with its square root."""
    root = math.sqrt(factor)
    return problem._replace(
        wedge=problem.wedge / (factor * factor),
        isotherm=problem.isotherm.scaled(root),
        shear=problem.shear.scaled(1.0 / factor, root),
        heat=problem.heat.scaled(factor) if problem.heat.log_eta.size > 0 else problem.heat,
    )


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


def linearised_profile(profile: Profile, resolution: Resolution) -> Linearisation | WarmLinearisation:
    """The equations to first order about a profile, its grid following the spike where there is one.

    The meniscus of a starved contact is held where it is.

    Parameters
    ----------
    profile : Profile
        A converged solution.
    resolution : Resolution
        Settings of the solve that gave it.
    """
    neighbour, longer = None, None
    spike, laid = profile.spike, profile.layout
    if spike is not None:
        shift = SPIKE_SHIFT * spike.width
        moved_spike = Spike(spike.position + shift, spike.width)
        length = laid.length if laid.starved else None
        layout = lay_out(laid.film, resolution.inlet_length, resolution.shape, moved_spike, length)
        neighbour = Neighbour(layout.grid(profile.cells), shift, front_node(profile))
    if profile.warmth is not None:
        rises, first = profile.warmth.rises, profile.warmth.first
        return warm_linearised(profile.problem, profile.grid, profile.unknowns, rises, first, LOAD, neighbour)
    if laid.starved:
        shift = LENGTH_SHIFT * min(laid.length, laid.film)
        longer = GridShift(replace(laid, length=laid.length + shift).grid(profile.cells), shift)
    return linearised(profile.problem, profile.grid, profile.kernel, profile.unknowns, LOAD, neighbour, longer)


def assembled(
    M: float,
    L: float,
    fine: Profile,
    coarse: Profile,
    resolution: Resolution,
    steps: int,
) -> GroupSolution:
    """Response, numbers and error estimates from the fine and the coarse solution.

    Parameters
    ----------
    M, L : float
        Moes' load and lubricant parameters of the point.
    fine, coarse : Profile
        Converged solutions, one with twice the cells of the other.
    resolution : Resolution
        Settings of the solve that gave them.
    steps : int
        Newton steps that they took.
    """
    linear, rough_linear = linearised_profile(fine, resolution), linearised_profile(coarse, resolution)
    if linear.singular or rough_linear.singular:
        return GroupSolution(outcome=STAGNATED, profile=None, steps=steps)
    response, rough = linear.slow_response(), rough_linear.slow_response()
    starved = fine.layout.starved
    # the pressure rises from a meniscus with a kink, where sums are of second order
    by_offset = SECOND if starved else _offset_share(M, fine.spike is not None)
    by_response = SECOND if starved else response_share(M, L, fine.spike is not None)
    inlet = 0.0 if starved else 1.0 / resolution.inlet_length**2
    central, minimum = films_of(fine)
    # the coarse grid of a starved contact has the same part of its own flooded flow; films go with the layer
    scale = fine.mass_flow / coarse.mass_flow if starved else 1.0
    central_error, minimum_error = _film_errors(fine, coarse, scale, by_offset)

    def error(value: float, rough_value: float, share: float, lost: float, least: float = 0.0) -> float:
        """Relative, > 0 where refinement lowers the value; what the inlet's end loses is added in magnitude.

        `least` is a difference of grids that this value shares at least.
        """
        grid = (rough_value - value) * share / value
        return math.copysign(max(abs(grid), abs(least * share / value)) + lost * inlet, grid)

    # parts of one complex number: where a spike between two nodes hides the error of the loss, the compliance shows it
    hidden = rough.compliance - response.compliance if fine.spike is not None or starved else 0.0
    hidden_too = rough.loss - response.loss if starved else 0.0
    return GroupSolution(
        outcome=CONVERGED,
        profile=fine,
        rough=coarse,
        linear=linear,
        rough_linear=rough_linear,
        film_offset=fine.film_offset,
        film_compliance=response.compliance,
        loss=response.loss,
        central_film=central,
        minimum_film=minimum,
        max_pressure=float(np.max(fine.pressure)),
        rolling_force=fine.rolling_force,
        mass_flow=fine.mass_flow,
        film_rise=math.nan if fine.warmth is None else float(np.max(fine.warmth.rises)),
        surface_rise=math.nan if fine.warmth is None else float(np.max(fine.warmth.rises[:, [0, -1]])),
        film_offset_error=error(fine.film_offset, scale * coarse.film_offset, by_offset, 3.0),
        film_compliance_error=error(response.compliance, rough.compliance, by_response, 6.0, hidden_too),
        loss_error=error(response.loss, rough.loss, by_response, 6.0, hidden),
        central_film_error=central_error + 3.0 * inlet,
        minimum_film_error=minimum_error + 3.0 * inlet,
        max_pressure_error=_peak_error(fine, coarse),
        rolling_force_error=_rolling_error(fine, coarse) + inlet,
        mass_flow_error=0.0 if starved else FOURTH * abs(coarse.mass_flow / fine.mass_flow - 1.0) + 3.0 * inlet,
        steps=steps,
    )


FIRST_ORDER = 1.5
"""Share of the difference between both grids that is left where the order is one, half as much again for safety."""


def _film_errors(fine: Profile, coarse: Profile, scale: float, share: float) -> tuple[float, float]:
    """Relative errors of the central and the smallest film; `share` is that of the film offset.

    Films of the coarse grid count `scale` times.

    Behind a spike the smallest film follows the spike's place, which is found to first order, and it moves with the
    whole film, to second order.
    """
    (central, minimum), (rough, rough_minimum) = films_of(fine), films_of(coarse)
    moved_by, narrowed = abs(scale * rough / central - 1.0), abs(scale * rough_minimum / minimum - 1.0)
    if fine.spike is None:
        return share * moved_by, share * narrowed
    return share * moved_by, FIRST_ORDER * narrowed + 0.5 * moved_by


def _peak_error(fine: Profile, coarse: Profile) -> float:
    """Relative error of the largest pressure, which is that of a node.

    What stands between two nodes; the difference between both grids: of the nodes where there is a spike, whose tip is
    resolved to first order at best, else of the peaks by parabolas, whose order is four; and what the tip of a spike
    may rise above its cell.
    """
    highest, spiked = float(np.max(fine.pressure)), fine.spike is not None
    between = peak_sampling_error(fine.position, fine.pressure, spiked)
    if spiked:
        apart = abs(float(np.max(coarse.pressure)) / highest - 1.0)
        return between + FIRST_ORDER * apart + max(tip_pressure(fine) / highest - 1.0, 0.0)
    rough = float(np.max(coarse.pressure)) * (1.0 + peak_sampling_error(coarse.position, coarse.pressure, False))
    return 1.5 * between + 1.5 / 15.0 * abs(rough / highest - 1.0 - between)


def tip_pressure(profile: Profile) -> float:
    """Pressure that the tip of a spike may have above the cell that holds it [p_H].

    Before a spike the oil is a plug, behind it Q = Int dP/eta falls with the square of the distance x, so that there
    ln eta ~ -2 ln x, and upstream about -ln x. This goes on down to x = 1/sqrt(pi lambda eta/H^3), where the flow by
    pressure in the plug is what the film behind takes: with -ln x from the cell to the tip, ln eta rises from that of
    the highest node of the front by twice the logarithm of the cell over that width. An estimate of size, not a bound.

    Parameters
    ----------
    profile : Profile
        A solution with a spike.
    """
    pressure, x = profile.pressure, profile.grid.x
    cell = front_cell(profile)
    top = max(cell - 2, 1) + int(np.argmax(pressure[max(cell - 2, 1) : cell + 2]))
    law = profile.problem.isotherm
    log_eta = float(log_viscosity(law, float(pressure[top]))[0])
    squared = math.pi * profile.problem.wedge / float(profile.film[top]) ** 3 * float(x[top + 1] - x[top]) ** 2
    above = float(pressure[top]) * np.linspace(1.0, MOST_TIP, 200)
    return float(np.interp(2.0 * log_eta + math.log(squared), log_viscosity(law, above)[0], above))


MOST_TIP = 5.0
"""Pressure of a tip over that of its cell to which an estimate goes: an oil with a largest viscosity has no limit."""


def _rolling_error(fine: Profile, coarse: Profile) -> float:
    """Relative error of the rolling force.

    Order four; behind a spike the film falls where the pressure does, within few cells and to first order only: there a
    tenth of what the terms of fourth order change comes to it. At a meniscus the pressure rises where the film is
    thickest, which is as rough.
    """
    moved_by = abs(coarse.rolling_force / fine.rolling_force - 1.0)
    if fine.spike is None and not fine.layout.starved:
        return FOURTH * moved_by
    return FIRST_ORDER * moved_by + 0.1 * fine.fourth_order_share


FOURTH, SECOND = 1.5 / 15.0, 1.5 / 3.0
"""Share of the difference between both grids that is left where the order is four or two: 1/(2^p - 1), and half as much
again for safety."""


def _offset_share(M: float, spike: bool) -> float:
    """Share that is left as error of the film offset: p = 4, and 2 where a front narrower than a cell carries load."""
    return SECOND if spike and M < 20.0 else FOURTH


def response_share(M: float, L: float, spike: bool) -> float:
    """Share of the difference between both grids that is left as error of the response on the finer one.

    p = 4; p = 2 at a front narrower than a cell (L > 12), and at the valley, where the response is a small difference
    of large parts whose errors have either sign.

    Parameters
    ----------
    M, L : float
        Moes' load and lubricant parameters of the point.
    spike : bool
        Whether the grid has a spike term.
    """
    if 0.6 < M < 2.0 or L > 30.0 or (spike and L > 12.0):
        return 1.0 / 3.0
    if 0.2 < M < 0.6:
        return 1.5 * FOURTH
    return FOURTH
