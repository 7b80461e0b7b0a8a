"""A map by its tolerance: which settings bring its contact laws within it, confirmed by fresh solves at random points.

The density of the solver's grid is chosen on a trial sample. The steps of the refinement lines begin where their order
of convergence lets expect enough. They are shortened as long as fresh points say no: new ones in each round, solved on
a grid twice as dense as that of the map. All that is decided follows from what is solved, so that a run that was
interrupted goes on as if it had not been.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.special import betaincinv

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.ehl.limits import SETTING_LIMITS
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs import toml_text
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.job_text import steps_keys, with_solver
from ehdmaps.jobs.law_check import loosest_axis
from ehdmaps.jobs.law_points import (
    DAMPING,
    OFFSET,
    STIFFNESS,
    FreshPoints,
    by_solver,
    errors_of,
    film_values,
    fresh_points,
    fresh_solution,
    judged_by_share,
    law_values,
    random_points,
    solved_values,
)
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.refinement import MOST_LINE_POINTS, Refinement, backbone_group, line_field, refinement
from ehdmaps.jobs.sampling import drawable
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import LineTask
from ehdmaps.maps.backbone import BackboneField
from ehdmaps.maps.backbone_plan import STEP_LIMITS, STEPS, Axis, Steps
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.law_errors import quantiles_text
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.table.solver import TableSolver
from ehdmaps.units import quantity_within

SMALLEST, LARGEST = 1e-3, 0.2
"""Allowed tolerances. Below the smallest, what stands between a law and its films, its table, is what is seen."""

JUDGED = (STIFFNESS, DAMPING, OFFSET)
"""Quantities that are held to the tolerance."""

SHARE, VALLEY_SHARE = 0.99, 0.95
"""Share of the fresh points within the tolerance, over the map and in the damping valley, by each quantity."""

POINTS, TRIALS = 500, 50
"""Fresh points of a round, and points on which the density is chosen; a fifth of them in the damping valley."""

SEED = 71_000
"""Seed of the trial; round n has this seed plus n."""

MOST_ROUNDS = 6

DENSITIES = (3.0, 4.0, 5.0, 6.5, 9.0, 13.0)
"""Grid densities that are tried, from the cheapest on."""

TRIAL_DENSITY = 18.0
"""Density of the reference of the trial."""

NUMERICAL_SHARE, MOST_NUMERICAL = 1.0 / 3.0, 0.5
"""Shares of the tolerance that the numerical error of the map's points may take, at 95 % of the points and at most."""

REFERENCE = 2.0
"""Density and inlet length of fresh solves, over those of the map."""

USUAL = 0.01
"""Tolerance that the usual steps are expected to meet; others follow by the order of convergence."""

ORDERS: Mapping[Axis, int] = {"load": 4, "entrainment_speed": 6, "temperature": 6}
"""Order of convergence along each axis: a cubic spline over the loads, six lines otherwise."""

FINER = 0.7
"""Steps of a round over those of the one before, along the axis that asks for it: a quarter of the error of a cubic
spline. What is missed is mostly missed by little, and half the step would be more than is needed."""

_OF_ALL_SOLVERS = ("structural_law", "fill", "backbone")
"""Keys of [solver] that every solver has, and that are kept."""

Solve = Callable[[Sequence[LineTask]], Mapping[str, Arrays]]
"""Solves what is not solved yet; gives the arrays of all tasks so far, by key."""


@dataclass(frozen=True)
class Settings:
    """What is chosen: density of the solver's grid and steps of the refinement lines."""

    density: float
    steps: Steps

    @property
    def text(self) -> str:
        """The same in words."""
        steps = self.steps
        return (
            f"density {self.density:g}, steps of the lines {steps.load:.3g} over ln(M/M_valley), "
            f"{steps.entrainment_speed:.3g} over ln(u), {steps.temperature:.3g} K"
        )


@dataclass(frozen=True)
class Tolerated:
    """The job with what was chosen for its tolerance, and what was found, as attributes of the map.

    Attributes
    ----------
    job : Job
        Job whose text states the chosen settings, and no check of the laws: the confirmation takes its place.
    solver : ReynoldsSolver
        The solver with the chosen density.
    attributes : dict
        `tolerance` and `tolerance_...`.
    """

    job: Job
    solver: ReynoldsSolver
    attributes: dict[str, float | int | str]


@dataclass(frozen=True)
class _Round:
    """One choice of settings and what fresh points say of its laws, and of films between its lines.

    `refused` says why there is no law.
    """

    settings: Settings
    job: Job
    solver: ReynoldsSolver
    lines: Refinement
    fresh: FreshPoints
    errors: Mapping[str, FloatArray]
    film_errors: Mapping[str, FloatArray]
    refused: str = ""

    def within(self, tolerance: float) -> BoolArray:
        """Which points of the laws are within the tolerance by each quantity, (3, n)."""
        return _within(self.errors, tolerance)

    def met(self, tolerance: float) -> bool:
        """Whether enough points of the laws are."""
        return not self.refused and self._enough(self.within(tolerance))

    def curable(self, tolerance: float) -> bool:
        """Whether enough would be, were the films between the lines right: what the table of a law misses stays."""
        return self._enough(self.within(tolerance) | ~_within(self.film_errors, tolerance))

    def _enough(self, within: BoolArray) -> bool:
        """Whether enough points are within by each quantity, over the map and in the valley."""
        if not self.fresh.tasks:
            return False
        valley = self.fresh.valley
        parts = ((within[:, ~valley], SHARE), (within[:, valley], VALLEY_SHARE))
        return all(bool(np.all(part.mean(axis=1) >= share)) for part, share in parts if part.shape[1])


def _within(errors: Mapping[str, FloatArray], tolerance: float) -> BoolArray:
    """Which errors are within the tolerance by each quantity, (3, n)."""
    return np.array([np.abs(errors[name]) <= tolerance for name in JUDGED]).reshape(len(JUDGED), -1)


def read_tolerance(text: str) -> float:
    """Read a tolerance, such as "1 %".

    Parameters
    ----------
    text : str
        What was typed.

    Raises
    ------
    InputError
        If it is none that is allowed.

    Examples
    --------
    >>> read_tolerance("1 %")
    0.01
    """
    return quantity_within(text, "", SMALLEST, LARGEST, f"--tolerance: got {text[:40]!r}; {_ALLOWED}")


_ALLOWED = (
    f'allowed: a relative tolerance of the contact laws from "{100 * SMALLEST:g} %" to "{100 * LARGEST:g} %", '
    'such as "1 %"'
)


def check_tolerance(job: Job, solver: ContactSolver, tolerance: float) -> ReynoldsSolver:
    """Refuse what is no tolerance between the limits, and jobs whose laws are not made from refinement lines.

    Parameters
    ----------
    job : Job
        The job.
    solver : ContactSolver
        What is to solve it.
    tolerance : float
        Relative tolerance.

    Raises
    ------
    InputError
        With what is allowed.
    """
    problems = []
    if isinstance(tolerance, bool) or not isinstance(tolerance, (int, float)) or not SMALLEST <= tolerance <= LARGEST:
        problems.append(f"tolerance: got {tolerance!r:.40}; {_ALLOWED}, which is 0.01 in Python")
    if isinstance(solver, TableSolver):
        problems.append(
            'tolerance: the job has [solver] films = "table", whose errors are what they are; allowed: films = "solved"'
        )
    elif not isinstance(solver, ReynoldsSolver):
        problems.append(
            f"tolerance: the solver {solver.name!r} has no grid density and no refinement lines to choose; allowed: "
            "the solver reynolds; how far other solvers are from it is measured by `ehdmaps tradeoff`"
        )
    elif job.backbone == "none":
        problems.append(
            'tolerance: the job has [solver] backbone = "none", and a tolerance is met by refinement lines; allowed: '
            'backbone = "law"'
        )
    if job.corrected_by is not None:
        problems.append(
            "tolerance: the job has [solver] corrected_by, and a tolerance is against the solver itself, which the "
            "corrected films leave; allowed: a job without it, whose density and line_steps may be taken over"
        )
    if not drawable(job):
        problems.append(
            "tolerance: the job has one point, or no speed above zero: nothing lies between its points; allowed: a job "
            "with an axis of two values, one speed of which is above zero"
        )
    if problems or not isinstance(solver, ReynoldsSolver):
        raise InputError(problems)
    return solver


def within_tolerance(job: Job, solver: ReynoldsSolver, tolerance: float, solve: Solve) -> Tolerated:
    """Choose the settings with which the contact laws of a map are within a tolerance.

    Parameters
    ----------
    job : Job
        What to make; its own density, steps of lines and check of the laws give way.
    solver : ReynoldsSolver
        What solves it, see `check_tolerance`.
    tolerance : float
        Relative tolerance of stiffness, damping and film offset, see `ehdmaps.jobs.law_points.errors_of`.
    solve : callable
        Solves tasks.
    """
    settings: Settings | None = Settings(_density(job, solver, tolerance, solve), _first_steps(tolerance))
    rounds: list[_Round] = []
    reason = ""
    while settings is not None:
        rounds.append(_tried(job, solver, settings, len(rounds) + 1, solve))
        if rounds[-1].met(tolerance):
            break
        if len(rounds) == MOST_ROUNDS:
            settings, reason = None, f"{MOST_ROUNDS} rounds were not enough"
        else:
            settings, reason = _finer(rounds[-1], tolerance, solve)
    last = rounds[-1]
    return Tolerated(last.job, last.solver, _attributes(job, rounds, tolerance, reason, solve(())))


def _first_steps(tolerance: float) -> Steps:
    """Steps that are expected to meet a tolerance; three digits, so that a job states them exactly."""
    ratio = tolerance / USUAL
    return Steps(**{axis: float(f"{getattr(STEPS, axis) * ratio ** (1.0 / n):.3g}") for axis, n in ORDERS.items()})


def _density(job: Job, solver: ReynoldsSolver, tolerance: float, solve: Solve) -> float:
    """The cheapest density whose numerical error leaves enough of the tolerance, at the trial points."""
    reference = _reference(solver, TRIAL_DENSITY / REFERENCE)
    points = random_points(job, reference, TRIALS, np.random.default_rng(SEED))
    fresh = fresh_points(points, solve(points.tasks))
    for density in DENSITIES[:-1]:
        errors = _numerical(fresh, replace(solver, density=density), solve)
        sizes = np.abs(np.array([errors[name] for name in JUDGED]))
        if not sizes.size or np.any(np.isnan(sizes)):
            continue
        high = np.quantile(sizes, 0.95, axis=1)
        if np.all(high <= NUMERICAL_SHARE * tolerance) and np.all(sizes <= MOST_NUMERICAL * tolerance):
            return density
    return DENSITIES[-1]


def _reference(solver: ReynoldsSolver, density: float) -> ReynoldsSolver:
    """The solver of fresh points for maps of a density."""
    _, highest = SETTING_LIMITS["density"]
    _, longest = SETTING_LIMITS["inlet_length"]
    return replace(
        solver,
        density=min(REFERENCE * density, highest),
        inlet_length=min(REFERENCE * solver.inlet_length, longest),
    )


def _numerical(fresh: FreshPoints, solver: ReynoldsSolver, solve: Solve) -> Mapping[str, FloatArray]:
    """Errors of the map's own solver at points; NaN where it has no solution."""
    tasks = by_solver(fresh.tasks, solver)
    results = solve(tasks)
    return errors_of(solved_values([fresh_solution(task, results[task.key]) for task in tasks], tasks), fresh)


def _tried(job: Job, solver: ReynoldsSolver, settings: Settings, number: int, solve: Solve) -> _Round:
    """Solve the lines of one choice of settings, and fresh points; compare."""
    chosen, own = _chosen(job, solver, settings), replace(solver, density=settings.density)
    lines = refinement(chosen, own)
    assert lines is not None  # `check_tolerance`
    points = random_points(chosen, _reference(solver, settings.density), POINTS, np.random.default_rng(SEED + number))
    results = solve((*lines.tasks, *points.tasks))
    fresh = fresh_points(points, results)
    try:
        fields = _fields(chosen, lines, results)
        laws = {
            contact.name: ContactLaw(
                contact.name,  # type: ignore[arg-type]
                (contact,),
                chosen.lubricant,
                fields[contact.name],
                "clamp",
            )
            for contact in chosen.contacts
        }
    except MapError as error:
        return _Round(settings, chosen, own, lines, fresh, {}, {}, str(error))
    of_laws, of_films = errors_of(law_values(laws, fresh), fresh), errors_of(film_values(fields, fresh), fresh)
    return _Round(settings, chosen, own, lines, fresh, of_laws, of_films)


def _fields(job: Job, lines: Refinement, results: Mapping[str, Arrays]) -> dict[str, BackboneField]:
    """Films of each contact between the lines."""
    group = backbone_group(lines, results)
    return {contact.name: line_field(job, group, contact) for contact in job.contacts}


def _chosen(job: Job, solver: ReynoldsSolver, settings: Settings) -> Job:
    """The job, read again from a text that states the settings."""
    table = toml_text.parse(job.text, job.name)["solver"]
    # own keys of another solver, in whose place this one was asked for, say nothing of it
    known = table if table["name"] == solver.name else {key: table[key] for key in _OF_ALL_SOLVERS if key in table}
    keys: dict[str, Any] = {
        **{key: value for key, value in known.items() if key != "law_check"},
        "name": solver.name,
        "density": settings.density,
        "inlet_length": solver.inlet_length,
        "tolerance": solver.tolerance,
        "line_steps": steps_keys(settings.steps),
    }
    return parse_job(with_solver(job.text, keys), job.name, f"{job.name} (with a tolerance)")


def _finer(tried: _Round, tolerance: float, solve: Solve) -> tuple[Settings | None, str]:
    """Settings that bring the missed points closer; none, and why, where that would not help, or be too much."""
    if tried.refused:
        return None, f"no contact law: {tried.refused}"
    if not tried.curable(tolerance):
        return None, "the table of a law misses, where damping nears zero, by more than finer lines would mend"
    settings = tried.settings
    for name, _ in _votes(tried, tolerance, solve).most_common():
        if (settings := _refined(tried.settings, name)) != tried.settings:
            break
    if settings == tried.settings:
        return None, "no finer settings are left"
    lines = refinement(_chosen(tried.job, tried.solver, settings), replace(tried.solver, density=settings.density))
    if lines is None or lines.points > MOST_LINE_POINTS:
        points = 0 if lines is None else lines.points
        return None, f"finer lines would take {points} points, more than {MOST_LINE_POINTS}"
    return settings, ""


def _refined(settings: Settings, name: str) -> Settings:
    """The next finer setting of one name; the same where there is none."""
    if name == "density":
        finer = [density for density in DENSITIES if density > settings.density]
        return replace(settings, density=finer[0]) if finer else settings
    step = float(f"{FINER * getattr(settings.steps, name):.3g}")
    smallest, _ = getattr(STEP_LIMITS, name)
    return settings if step < smallest else replace(settings, steps=replace(settings.steps, **{name: step}))


def _votes(tried: _Round, tolerance: float, solve: Solve) -> Counter[str]:
    """What each point hangs on at which films miss: the density, or an axis of the lines."""
    missed = np.flatnonzero(~np.all(_within(tried.film_errors, tolerance), axis=0))
    there = FreshPoints(
        tuple(tried.fresh.tasks[i] for i in missed),
        tried.fresh.valley[missed],
        tuple(tried.fresh.solutions[i] for i in missed),
        (),
    )
    numerical = _numerical(there, tried.solver, solve)
    fields = _fields(tried.job, tried.lines, solve(()))
    votes: Counter[str] = Counter()
    for i, task in enumerate(there.tasks):
        if any(not abs(numerical[name][i]) <= MOST_NUMERICAL * tolerance for name in JUDGED):
            votes["density"] += 1
        else:
            votes[loosest_axis(fields[task.contact.name], task)] += 1
    return votes


def _attributes(
    job: Job, rounds: Sequence[_Round], tolerance: float, reason: str, results: Mapping[str, Arrays]
) -> dict[str, float | int | str]:
    """What was asked for, chosen, found and spent."""
    last = rounds[-1]
    fresh, met = last.fresh, last.met(tolerance)
    seconds = sum(float(np.nansum(arrays["solve_seconds"])) for arrays in results.values())
    points = sum(arrays["status"].size for arrays in results.values())
    record: dict[str, float | int | str] = {
        "tolerance": tolerance,
        "tolerance_met": int(met),
        "tolerance_settings": last.settings.text,
        "tolerance_reference": f"reynolds, density {_reference(last.solver, last.settings.density).density:g}, "
        f"inlet {_reference(last.solver, last.settings.density).inlet_length:g}",
        "tolerance_seed": SEED + len(rounds),
        "tolerance_points": len(fresh.tasks),
        "tolerance_lost_points": len(fresh.lost),
    }
    if last.errors and fresh.tasks:
        for prefix, here in (("", ~fresh.valley), ("valley_", fresh.valley)):
            if np.any(here):
                within = np.all(last.within(tolerance)[:, here], axis=0)
                record[f"tolerance_{prefix}points_within"] = float(np.mean(within))
                films = np.all(_within(last.film_errors, tolerance)[:, here], axis=0)
                record[f"tolerance_{prefix}films_within"] = float(np.mean(films))
                record[f"tolerance_{prefix}points_surely_within"] = surely(int(np.count_nonzero(within)), within.size)
                for name in JUDGED:
                    sizes = np.abs(last.errors[name][here])
                    record[f"tolerance_{prefix}{name.replace(' ', '_')}_error"] = quantiles_text(sizes)
        record["tolerance_damping_related_to_itself"] = judged_by_share(fresh)
        record |= {key: _worst(last, name) for name, key in _WORST.items()}
    record["tolerance_rounds"] = len(rounds)
    record |= {f"tolerance_round_{number}": _words(tried, tolerance) for number, tried in enumerate(rounds, start=1)}
    record["tolerance_spent"] = f"{points} points and {seconds:.3g} s of solving besides the points of the map"
    record["tolerance_job_sha256"] = job.sha256
    if not met:
        record["tolerance_unmet"] = reason
    return record


def surely(found: int, points: int) -> float:
    """Share of all places of which it is 95 % sure that they are within, from so many of random points.

    Lower limit of C. J. Clopper and E. S. Pearson, Biometrika 26, 1934, 404.

    Parameters
    ----------
    found : int
        Points within.
    points : int
        All points, > 0.

    Examples
    --------
    >>> round(surely(200, 200), 4), round(surely(198, 200), 4), surely(0, 200)
    (0.9851, 0.9689, 0.0)
    """
    return float(betaincinv(found, points - found + 1, 0.05)) if found else 0.0


def _worst(tried: _Round, name: str) -> str:
    """The largest error of a quantity, and where."""
    sizes = np.abs(tried.errors[name])
    worst = int(np.argmax(np.where(np.isnan(sizes), math.inf, sizes)))
    return f"{sizes[worst]:.2g} at {tried.fresh.places[worst]}"


_WORST = {name: f"tolerance_worst_{name.replace(' ', '_')}" for name in JUDGED}
"""Attributes with the worst points."""


def _words(tried: _Round, tolerance: float) -> str:
    """One round in words."""
    count = len(tried.fresh.tasks)
    found = tried.refused or f"{np.mean(np.all(tried.within(tolerance), axis=0)):.1%} of {count} points within"
    return f"{tried.settings.text}, {tried.lines.points} points of lines: {found}"


def unmet_tolerance(attributes: Mapping[str, Any]) -> list[str]:
    """What a map misses of its tolerance, a line each; nothing where it is met, or none was asked for.

    Parameters
    ----------
    attributes : mapping
        Attributes of the map.
    """
    if "tolerance_unmet" not in attributes:
        return []
    worst = [f"{name} {attributes[key]}" for name, key in _WORST.items() if key in attributes]
    return [
        f"unmet: the contact laws are not within {100.0 * float(attributes['tolerance']):.3g} % at {SHARE:.0%} of the "
        f"fresh points over the map and {VALLEY_SHARE:.0%} of those in the valley: {attributes['tolerance_unmet']}",
        f"worst points: {'; '.join(worst) or 'none compared'}",
    ]
