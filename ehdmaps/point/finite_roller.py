"""Film of a roller of finite length with its profile, ends and sides included: one contact in SI.

What `ehdmaps.point.solver` does for ellipses, with a profile across in place of a parabola. The dry contact has no
closed form then: it is solved on the same grids, and what films change is the difference.

Isothermal, Newtonian, fully flooded, smooth; both halves of the roller alike, no tilt. The solids are half-spaces, so
that at a sharp end pressures are too high.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import FloatArray
from ehdmaps.compiling import stopwatch
from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.closed_form import CONTINUUM, NO_CONTINUUM, too_thick
from ehdmaps.physics.hertz import LARGEST_PRESSURE, half_width, max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups
from ehdmaps.physics.solution import UNKNOWN, Estimate, Status
from ehdmaps.physics.surface import CrownedProfile
from ehdmaps.point.newton import PointState, newton, start_about
from ehdmaps.point.roller_grid import (
    LARGEST_DEPTH,
    DryContact,
    RollerGrid,
    RollerProblem,
    dry_compliance,
    dry_contact,
    dry_extent,
)
from ehdmaps.point.roller_grid import roller_grid as make_grid
from ehdmaps.point.solver import PointField
from ehdmaps.point.two_grids import (
    MARCH,
    MARCH_STEPS,
    MOST_ERROR,
    THICKNESSES,
    PointNumbers,
    Resolution,
    carried_over,
    extrapolated,
    ladder,
    numbers_beside,
)

GRIDS = Resolution((34, 20), (51, 30))
"""Cells along and across half of the roller."""

LOAD_NUMBERS = (0.3, 2000.0)
"""Moes' M of lines that are solved."""

HALF_LENGTHS = (4.0, 400.0)
"""Half of the length over half the width of the contact that is solved."""

AT_THE_END = "; the dry contact reaches the end of the roller, where no film is held: take a deeper profile"
"""Words on rollers whose profile does not relieve their ends."""

_RELIEF = 0.02
"""Part of the half length before a sharp end beyond which no place is refined."""


@dataclass(frozen=True)
class FiniteRoller:
    """Contact of a roller of finite length and a raceway.

    Attributes
    ----------
    radius : float
        Reduced radius R in the direction of rolling [m].
    length : float
        Length of the roller [m].
    reduced_modulus : float
        E' [Pa].
    profile : callable
        Depth of the profile, of both bodies together, over the distance from the middle, arrays [m]; alike on both
        sides.
    corners : tuple of float
        Distances of corners of the profile from the middle [m], where the grid is finer; those of a `CrownedProfile`
        are known.

    Raises
    ------
    InputError
        For lengths or a modulus that are not finite and above zero.
    """

    radius: float
    length: float
    reduced_modulus: float
    profile: Callable[[FloatArray], FloatArray]
    corners: Sequence[float] = ()

    def __post_init__(self) -> None:
        problems = Problems(
            f"finite roller, {name}: got {value!r:.60} {unit}; allowed: finite and > 0"
            for name, value, unit in (
                ("radius", self.radius, "m"),
                ("length", self.length, "m"),
                ("reduced_modulus", self.reduced_modulus, "Pa"),
            )
            if not (isinstance(value, int | float) and math.isfinite(value) and value > 0.0)
        )
        problems.check()

    @property
    def kinks(self) -> tuple[float, ...]:
        """Distances of corners of the profile from the middle [m]."""
        own = self.profile.straight if isinstance(self.profile, CrownedProfile) else 0.0
        return (*self.corners, *([0.5 * own] if own > 0.0 else []))


@dataclass(frozen=True, eq=False)
class RollerSolution:
    """Film of a roller. Numbers with their errors, which are NaN where the status is not usable.

    Attributes
    ----------
    status, reason
        Typed status, and its cause in words (empty for plain convergence).
    load, entrainment_speed, temperature : float
        F [N], u [m/s], T [K].
    roller : FiniteRoller
        The contact.
    load_number, oil_number : float
        Moes' M and L of the line with the highest load per length of the dry roller.
    film_offset : float
        Dry less lubricated approach at equal load [m].
    stiffness, damping : float
        k [N/m] and c [N s/m], in the limit of slow motion.
    dry_stiffness : float
        k of the dry contact [N/m].
    film_compliance : float
        1/k - 1/k_dry [m/N]; a small part of both, mostly below their errors.
    central_film, middle_film, minimum_film : float
        h at the centre, smallest h across the middle of the roller, smallest h [m].
    minimum_place : float
        Distance of the smallest film from the middle of the roller [m].
    max_pressure : float
        [Pa].
    steps : int
        Newton steps.
    solve_seconds : float
        Processor time.
    field : PointField or None
        Pressure and film of half of the roller; None where there is no film.
    """

    status: Status
    reason: str
    load: float
    entrainment_speed: float
    temperature: float
    roller: FiniteRoller
    load_number: float = math.nan
    oil_number: float = math.nan
    film_offset: Estimate = UNKNOWN
    stiffness: Estimate = UNKNOWN
    damping: Estimate = UNKNOWN
    dry_stiffness: float = math.nan
    film_compliance: Estimate = UNKNOWN
    central_film: Estimate = UNKNOWN
    middle_film: Estimate = UNKNOWN
    minimum_film: Estimate = UNKNOWN
    minimum_place: float = math.nan
    max_pressure: Estimate = UNKNOWN
    steps: int = 0
    solve_seconds: float = 0.0
    field: PointField | None = dataclasses.field(default=None, repr=False)


def solve_roller(
    roller: FiniteRoller,
    lubricant: Lubricant,
    load: float,
    entrainment_speed: float,
    temperature: float,
    resolution: Resolution = GRIDS,
) -> RollerSolution:
    """Solve the film of a roller; a point without a solution has a status that says so, and no numbers.

    Parameters
    ----------
    roller : FiniteRoller
        Radius, length, modulus and profile.
    lubricant : Lubricant
        The oil.
    load : float
        F of the whole roller [N], > 0.
    entrainment_speed : float
        Mean u of the two surface speeds [m/s], > 0.
    temperature : float
        Temperature of both surfaces [K].
    resolution : Resolution
        Both grids.

    Raises
    ------
    InputError
        If load or speed is no number above zero, the fine grid is not finer than the coarse one both ways, the profile
        has no depths, or the oil has no temperature like that.

    Examples
    --------
    >>> from ehdmaps.physics.lubricant import Lubricant
    >>> roller = FiniteRoller(5.5e-3, 14e-3, 230.769e9, CrownedProfile.of_drop(10e-6, 14e-3, 12.6e-3))
    >>> found = solve_roller(roller, Lubricant.named("FVA3"), 500.0, 2.0, 333.15, Resolution((24, 10), (36, 15)))
    >>> found.status.word, found.minimum_film < found.middle_film < found.central_film
    ('converged', True)
    """
    problems = Problems(
        f"finite roller, {name}: got {value!r:.60}; allowed: a finite number > 0 [{unit}]"
        for name, value, unit in (("load", load, "N"), ("entrainment_speed", entrainment_speed, "m/s"))
        if not (isinstance(value, int | float) and math.isfinite(value) and value > 0.0)
    )
    if not all(fine > coarse for fine, coarse in zip(resolution.fine, resolution.coarse, strict=True)):
        problems.append(
            f"finite roller, resolution: got cells {resolution.coarse} and {resolution.fine}; allowed: more in the "
            "second grid, along and across, as errors are stated by both"
        )
    problems.check()
    state = lubricant.at(temperature)
    modulus, radius, seconds = roller.reduced_modulus, roller.radius, stopwatch()
    asked = (float(load), float(entrainment_speed), temperature, roller)
    mean = load / roller.length
    half = float(half_width(mean, radius, modulus))
    kinks = [kink for kink in roller.kinks if kink < 0.5 * roller.length]
    extent = None
    if HALF_LENGTHS[0] <= 0.5 * roller.length / half <= HALF_LENGTHS[1]:
        extent = dry_extent(partial(_depth, roller, half), 0.5 * roller.length / half, [kink / half for kink in kinks])
    if extent is None:
        reason = f"length over width of the contact {0.5 * roller.length / half:.3g} outside of {HALF_LENGTHS[0]:g} to "
        reason += f"{HALF_LENGTHS[1]:g}, or no dry contact was found"
        return RollerSolution(Status.OUTSIDE_VALIDITY, reason, *asked, solve_seconds=seconds())
    highest, end = mean * extent[1], half * extent[0]
    half, peak = float(half_width(highest, radius, modulus)), float(max_pressure(highest, radius, modulus))
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = (float(v) for v in moes_groups(highest, entrainment_speed, state.viscosity, alpha, radius, modulus))
    where = (*asked, M, L)
    if reason := _beyond_reach(M, peak):
        return RollerSolution(Status.OUTSIDE_VALIDITY, reason, *where, solve_seconds=seconds())
    depth, half_length = partial(_depth, roller, half), 0.5 * roller.length / half
    problem = RollerProblem(M, L, load / (peak * half**2), state.isotherm(peak))
    scale, edge, inlet = ladder(problem.start_film)
    places = [min(end / half, (1.0 - _RELIEF) * half_length), *(kink / half for kink in kinks)]
    states: list[PointState] = []
    numbers: list[PointNumbers] = []
    middles: list[float] = []
    steps = 0
    for cells in (resolution.coarse, resolution.fine):
        grid = make_grid(depth, half_length, places, cells, inlet * resolution.inlet, edge, scale)
        dry = dry_contact(grid.kernel, grid.parabola, grid.weights, problem.load)
        if dry is None:
            return RollerSolution(Status.STAGNATED, "the dry contact was not found", *where, solve_seconds=seconds())
        found, taken = _solved(problem, grid, dry, states[-1] if states else None)
        steps += taken
        if not found.status.usable:
            reason = f"Newton {found.status.word} at M = {M:.4g}, L = {L:.4g} from every start tried"
            reason += AT_THE_END if end > (1.0 - _RELIEF) * 0.5 * roller.length else ""
            return RollerSolution(found.status, reason, *where, steps=steps, solve_seconds=seconds())
        states.append(found)
        numbers.append(numbers_beside(found, -dry.height, dry_compliance(grid, problem.load)))
        middles.append(_smallest_along(grid.x, found.film[:, 0]))
    left = resolution.left
    values, errors = extrapolated(numbers[0], numbers[1], left, states[1], cusp=problem.isotherm.alpha > 0.0)
    middle = middles[1] + left * (middles[1] - middles[0])
    film, spring = half * half / radius, peak * radius
    status, reason = _judged(values, errors, film, radius)
    if not status.usable:
        return RollerSolution(status, reason, *where, steps=steps, solve_seconds=seconds())
    nodes = states[1].grid
    across = np.min(states[1].film, axis=0)
    return RollerSolution(
        status,
        reason,
        *where,
        film_offset=Estimate(values.film_offset * film, errors.film_offset),
        stiffness=Estimate(values.stiffness * spring, errors.stiffness),
        damping=Estimate(values.damping * spring * half / entrainment_speed, errors.damping),
        dry_stiffness=spring / (values.compliance - values.film_compliance),
        film_compliance=Estimate(values.film_compliance / spring, errors.film_compliance),
        central_film=Estimate(values.central_film * film, errors.central_film),
        middle_film=Estimate(
            middle * film, max(2.0 * left * abs(middles[1] - middles[0]) / middle, errors.central_film)
        ),
        minimum_film=Estimate(values.minimum_film * film, errors.minimum_film),
        minimum_place=half * float(nodes.y[int(np.argmin(across))]),
        max_pressure=Estimate(values.max_pressure * peak, errors.max_pressure),
        steps=steps,
        solve_seconds=seconds(),
        field=PointField(half * nodes.x, half * nodes.y, peak * states[1].pressure, film * states[1].film),
    )


def _smallest_along(x: FloatArray, film: FloatArray) -> float:
    """Smallest film between nodes along one line."""
    at = int(np.argmin(film))
    between = np.linspace(x[max(at - 1, 0)], x[min(at + 1, x.size - 1)], 81)
    return min(float(np.min(CubicSpline(x, film)(between))), float(film[at]))


def _depth(roller: FiniteRoller, half: float, places: FloatArray) -> FloatArray:
    """Depth of the profile [a^2/R] at places [a]; cut off where it is deep."""
    with np.errstate(divide="ignore"):  # infinite at the very end
        given = np.asarray(roller.profile(np.minimum(half * places, 0.5 * roller.length)), dtype=np.float64)
    if given.shape != places.shape or np.any(np.isnan(given)):
        raise InputError("finite roller, profile: got no depth at every place; allowed: a number for each, in m")
    return np.minimum(given * roller.radius / half**2, LARGEST_DEPTH)


def _beyond_reach(M: float, peak: float) -> str:
    """Reason why a roller is not even tried; empty if it is."""
    if not LOAD_NUMBERS[0] <= M <= LOAD_NUMBERS[1]:
        return f"M = {M:.3g} outside of {LOAD_NUMBERS[0]:g} to {LOAD_NUMBERS[1]:g}"
    if peak > LARGEST_PRESSURE:
        return f"Hertz pressure {peak / 1e9:.3g} GPa above {LARGEST_PRESSURE / 1e9:g} GPa"
    return ""


def _solved(
    problem: RollerProblem, grid: RollerGrid, dry: DryContact, known: PointState | None
) -> tuple[PointState, int]:
    """A solution from one start after another, until one leads there, and the steps of all."""
    steps = 0
    if known is not None:
        state = newton(problem, grid, *carried_over(known, grid))
        steps += state.steps
        if state.status.usable:
            return state, steps
    for factor in THICKNESSES:
        state = newton(problem, grid, *start_about(problem, grid, dry.pressure, factor * problem.start_film))
        steps += state.steps
        if state.status.usable:
            return state, steps
    for factor in MARCH:
        for part in np.geomspace(factor, 1.0, 1 + round(MARCH_STEPS * abs(math.log2(factor)))).tolist():
            there = problem._replace(load=problem.load * part)
            if part == factor:
                dryer = dry_contact(grid.kernel, grid.parabola, grid.weights, there.load) or dry
                start = start_about(there, grid, dryer.pressure, problem.start_film)
            state = newton(there, grid, *start)
            steps += state.steps
            if not state.status.usable:
                break
            start = state.pressure, state.height
        if state.status.usable:
            return state, steps
    return dataclasses.replace(state, status=Status.STAGNATED), steps


def _judged(values: PointNumbers, errors: PointNumbers, film: float, radius: float) -> tuple[Status, str]:
    """Status of what two grids found, and why."""
    if not (values.minimum_film > 0.0 and values.compliance > 0.0):
        return Status.OUTSIDE_VALIDITY, "not resolved: no film, or no stiffness, is left by extrapolation"
    if thick := too_thick(values.film_offset * film, radius):
        return Status.OUTSIDE_VALIDITY, thick
    for name, error in (
        ("central film", errors.central_film),
        ("film offset", errors.film_offset),
        ("stiffness", errors.stiffness),
    ):
        if not error <= MOST_ERROR:
            return Status.OUTSIDE_VALIDITY, f"not resolved: both grids differ by {100.0 * error:.0f} % in the {name}"
    notes = []
    if errors.minimum_film > MOST_ERROR:
        notes.append(f"minimum film not resolved: both grids differ by {100.0 * errors.minimum_film:.0f} %")
    if values.minimum_film * film < CONTINUUM:
        notes.append(NO_CONTINUUM)
    return Status.CONVERGED, "; ".join(notes)
