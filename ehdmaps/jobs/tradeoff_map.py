"""Speed against accuracy of whole maps: what the contact laws of coarser and finer ones are worth between their points.

Each choice is a map that is made: its refinement lines, its grid, the law that its points come from, or its structural
law. Errors are those of its contact laws against fresh fine solves at random points. Films are flooded and surfaces
smooth, whatever the job states.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.ehl.limits import SETTING_LIMITS
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.assemble import assemble, placed
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.law_points import (
    APPROACH,
    DAMPING,
    OFFSET,
    SMALL_DAMPING,
    SMALL_OFFSET,
    STIFFNESS,
    FreshPoints,
    by_solver,
    errors_of,
    fresh_points,
    fresh_solution,
    judged_by_share,
    law_values,
    random_points,
    solved_values,
)
from ehdmaps.jobs.refinement import backbone_group, line_field, refinement
from ehdmaps.jobs.sampling import drawable
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import LineTask, line_tasks
from ehdmaps.maps.backbone_plan import STEPS, Steps
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.bearing import with_law
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.oil_supply import FLOODED
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.surface import SMOOTH
from ehdmaps.trade.record import Choice, ErrorSummary, Judged, Trade
from ehdmaps.units import KELVIN

VALLEY = f"{DAMPING}, valley"
JUDGED = (STIFFNESS, DAMPING, VALLEY, OFFSET, APPROACH)
"""Columns; the second one leaves out the points that were drawn inside the valley, the third has nothing else."""

REFERENCE_DENSITY, REFERENCE_INLET = 18.0, 2.0
"""Grid density of the fresh solves, and the length of their inlet over that of the map."""

LOAD_STEPS = (4.0, 2.0, 1.0, 0.5)
"""Steps of the lines over the load that are measured, over the usual one."""

COARSE_LINES = Steps(entrainment_speed=STEPS.entrainment_speed * 2.0, temperature=STEPS.temperature * 2.0)
"""Steps with lines at half as many speeds and temperatures."""

DENSITIES = (0.5, 0.7, 1.0, 1.4)
"""Grid densities that are measured, over that of the job."""

TIMED_LINES = 24
"""Lines of the grid whose time stands for all of them, where the laws do not hang on the grid."""

Tell = Callable[[str], None]


@dataclass(frozen=True)
class _Measurement:
    """What all rows have in common: the job, its solver, and the points."""

    job: Job
    solver: ReynoldsSolver
    points: FreshPoints

    def choice(
        self,
        group: str,
        label: str,
        seconds: float,
        laws: Callable[[], Mapping[str, ContactLaw]],
        default: bool = False,
        exact: Mapping[str, FloatArray] | None = None,
    ) -> Choice:
        """A row; `exact` is what the same model solves at the points, which tells its error from the numerical one."""
        try:
            values = law_values(laws(), self.points)
        except (MapError, InputError) as error:
            return Choice(group, label, seconds, {}, solved=0, asked=len(self.points.tasks), lost=(str(error),))
        errors = errors_of(values, self.points)
        model = None if exact is None else errors_of(exact, self.points)
        numerical = None if model is None else {name: errors[name] - model[name] for name in errors}
        known = np.isfinite(errors[STIFFNESS])
        return Choice(
            group,
            label,
            seconds,
            self._summed(errors),
            {} if numerical is None else self._summed(numerical),
            {} if model is None else self._summed(model),
            solved=int(np.count_nonzero(known)),
            asked=known.size,
            default=default,
        )

    def _summed(self, errors: Mapping[str, FloatArray]) -> dict[str, ErrorSummary]:
        """Errors by column."""
        valley = self.points.valley
        every: BoolArray = np.ones_like(valley)
        columns = {
            STIFFNESS: (STIFFNESS, every),
            DAMPING: (DAMPING, ~valley),
            VALLEY: (DAMPING, valley),
            OFFSET: (OFFSET, every),
            APPROACH: (APPROACH, every),
        }
        places = np.array(self.points.places, dtype=object)
        return {
            name: ErrorSummary.of(errors[quantity][here], list(places[here]))
            for name, (quantity, here) in columns.items()
        }


def measure_map(job: Job, points: int, seed: int, tell: Tell | None = None) -> Trade:
    """Make maps of a job by several settings and laws, and compare their contact laws with fresh solves.

    Parameters
    ----------
    job : Job
        The job. Of its solver `reynolds` is taken what it states of it, else the default settings.
    points : int
        Random points, a fifth of them in the damping valley.
    seed : int
        Seed of these points.
    tell : callable, optional
        Takes a line of progress.

    Raises
    ------
    InputError
        If nothing lies between the points of the job.
    """
    if not drawable(job):
        raise InputError(
            "tradeoff, level map: the job has one point, or no speed above zero: nothing lies between its points; "
            "allowed: a job with an axis of two values, one speed of which is above zero"
        )
    say = tell or (lambda _: None)
    own = dict(job.solver_options) if job.solver == "reynolds" else {}
    solver = ReynoldsSolver(**own)
    fine = replace(
        solver,
        density=REFERENCE_DENSITY,
        inlet_length=min(REFERENCE_INLET * solver.inlet_length, SETTING_LIMITS["inlet_length"][1]),
    )
    drawn = random_points(job, fine, points, np.random.default_rng(seed))
    say(f"reference at {len(drawn.tasks)} points")
    solved, seconds = _solved(drawn.tasks)
    fresh = fresh_points(drawn, solved)
    if not fresh.tasks:
        raise InputError("tradeoff, level map: no point has a solution; see `ehdmaps check` for the range of the job")
    measurement = _Measurement(replace(job, backbone="law", line_steps=STEPS), solver, fresh)
    choices: list[Choice] = []
    for choice in _rows(measurement):
        say(f"{choice.group}: {choice.label}")
        choices.append(choice)
    return Trade(
        level="map",
        title=f"{job.title}, {job.lubricant.title}: contact laws between the points of a map",
        cost="s a map",
        reference=f"fresh solves, reynolds, density {REFERENCE_DENSITY:g}, inlet {fine.inlet_length:g}, structural law "
        f"{job.contacts[0].structural_law} ({seconds / len(drawn.tasks) * 1e3:.3g} ms a point)",
        judged=tuple(Judged(name) for name in JUDGED),
        choices=tuple(choices),
        frame=_frame(measurement, seed),
    )


def _frame(measurement: _Measurement, seed: int) -> tuple[str, ...]:
    """What a reader must know besides."""
    points, share = measurement.points, judged_by_share(measurement.points)
    return (
        f"{len(points.tasks)} random points, seed {seed}; {np.count_nonzero(points.valley)} in the damping valley",
        f"damping relative to c, or to {SMALL_DAMPING:g} k b/u where c is less ({1.0 - share:.0%} of the points); film "
        f"offset to h, or to {SMALL_OFFSET:g} of the elastic approach where h is less; approach to the sum of both",
        "seconds: processor time of all points of the map and its lines; that of the grid is scaled from a sample of "
        "its lines where laws are made from refinement lines; without the check of the laws",
        "step over ln(M/M_valley) in the valley; sizes are loads x speeds x temperatures, the points are those of the "
        "lines + those of the map; of maps without lines the largest step of each axis is told",
        "films are flooded and surfaces smooth",
        *(f"no reference, and left out: {point}" for point in points.lost),
    )


def _rows(measurement: _Measurement) -> Iterator[Choice]:
    """Yield the rows, group by group."""
    job, solver = measurement.job, measurement.solver
    grid_seconds = _grid_seconds(job, solver)
    usual = _lines(job, solver, STEPS)
    yield from _line_rows(measurement, grid_seconds, usual)
    yield from _density_rows(measurement, grid_seconds, usual)
    yield from _grid_rows(measurement)
    yield from _law_rows(measurement)
    yield from _structure_rows(measurement, grid_seconds, usual)


@dataclass(frozen=True)
class _Lines:
    """Solved refinement lines: their films, and what they cost."""

    job: Job
    points: int
    sizes: tuple[int, int, int]
    seconds: float
    fields: Callable[[LineContact], FilmField]

    def laws(self, contacts: Sequence[LineContact]) -> dict[str, ContactLaw]:
        """Laws of contacts from these films."""
        return {
            contact.name: ContactLaw(
                contact.name,  # type: ignore[arg-type]
                (contact,),
                self.job.lubricant,
                self.fields(contact),
                "clamp",
            )
            for contact in contacts
        }


def _lines(job: Job, solver: ReynoldsSolver, steps: Steps) -> _Lines:
    """Solve the refinement lines of some steps."""
    refined = refinement(job, solver, steps)
    assert refined is not None  # a speed above zero, and backbone = "law"
    results, seconds = _solved(refined.tasks)
    group = backbone_group(refined, results)
    plan = refined.plans[0]
    sizes = len(plan.zeta), len(plan.speeds), len(plan.temperatures)
    return _Lines(job, refined.points, sizes, seconds, lambda contact: line_field(job, group, contact))


def _line_rows(measurement: _Measurement, grid_seconds: float, usual: _Lines) -> Iterator[Choice]:
    """Yield maps with other refinement lines."""
    job, solver, points = measurement.job, measurement.solver, measurement.job.points
    for factor in LOAD_STEPS:
        steps = replace(STEPS, load=factor * STEPS.load)
        lines = usual if steps == STEPS else _lines(job, solver, steps)
        yield _line_choice(measurement, lines, steps, points, grid_seconds, steps == STEPS)
    lines = _lines(job, solver, COARSE_LINES)
    if lines.sizes != usual.sizes:
        yield _line_choice(measurement, lines, COARSE_LINES, points, grid_seconds, False)


def _line_choice(
    measurement: _Measurement, lines: _Lines, steps: Steps, points: int, grid_seconds: float, default: bool
) -> Choice:
    """One of them."""
    loads, speeds, temperatures = lines.sizes
    label = f"step {steps.load:g}, {loads} x {speeds} x {temperatures}: {lines.points} + {points} points"
    laws = lines.laws
    contacts = measurement.job.contacts
    return measurement.choice(
        "refinement lines", label, grid_seconds + lines.seconds, lambda: laws(contacts), default=default
    )


def _density_rows(measurement: _Measurement, grid_seconds: float, usual: _Lines) -> Iterator[Choice]:
    """Yield maps by other grids of the solver."""
    job, solver = measurement.job, measurement.solver
    low, high = SETTING_LIMITS["density"]
    for density in dict.fromkeys(round(min(max(solver.density * factor, low), high), 2) for factor in DENSITIES):
        own = density == solver.density
        other = replace(solver, density=density)
        lines = usual if own else _lines(job, other, STEPS)
        seconds = (grid_seconds if own else _grid_seconds(job, other)) + lines.seconds
        laws, contacts = lines.laws, job.contacts
        yield measurement.choice(
            "grid of the solver",
            f"density {density:g}",
            seconds,
            lambda laws=laws, contacts=contacts: laws(contacts),  # type: ignore[misc]
            default=density == ReynoldsSolver.density,
        )


def _grid_rows(measurement: _Measurement) -> Iterator[Choice]:
    """Yield maps without refinement lines, of fewer points and of more."""
    job = measurement.job
    every_second = replace(
        job,
        loads=_thinned(job.loads),
        entrainment_speeds=_thinned(job.entrainment_speeds),
        temperatures=job.temperatures,
    )
    seen = set()
    for own in (every_second, job, replace(job, loads=_between(job.loads))):
        if own.shape not in seen:
            seen.add(own.shape)
            laws, seconds = _grid_laws(own, measurement.solver)
            yield measurement.choice('no lines (backbone = "none")', _grid_label(own), seconds, laws)


def _law_rows(measurement: _Measurement) -> Iterator[Choice]:
    """Yield maps of closed forms, on the points of the job."""
    job, points = measurement.job, measurement.points
    for name in ("hertz", "formula"):
        solver = solvers.build(name, dict(job.solver_options) if job.solver == name else {})
        laws, seconds = _grid_laws(job, solver)
        tasks = by_solver(points.tasks, solver)
        exact = solved_values([fresh_solution(task, task.run()) for task in tasks], tasks)
        words = ", ".join([name, *(str(value) for value in solver.settings().values())])
        yield measurement.choice(
            "closed form in place of the film", f"{words}, {job.points} points", seconds, laws, False, exact
        )


def _structure_rows(measurement: _Measurement, grid_seconds: float, usual: _Lines) -> Iterator[Choice]:
    """Yield the usual map with the structural laws; one that lacks a length is left out with its reason."""
    job, points = measurement.job, measurement.points
    for name in STRUCTURAL_LAWS:
        seconds = grid_seconds + usual.seconds
        try:
            contacts = {contact.name: with_law(contact, name, job.bearing) for contact in job.contacts}
            tasks = tuple(replace(task, contact=contacts[task.contact.name]) for task in points.tasks)
            exact = _with_contacts(points, tasks)
        except InputError as error:
            group = "structural law, by the same films"
            yield Choice(group, name, seconds, {}, solved=0, asked=len(points.tasks), lost=tuple(error.problems))
            continue
        own = name == job.contacts[0].structural_law
        laws, chosen = usual.laws, tuple(contacts.values())
        yield measurement.choice(
            "structural law, by the same films",
            f"{name} (that of the job)" if own else name,
            seconds,
            lambda laws=laws, chosen=chosen: laws(chosen),  # type: ignore[misc]
            default=own,
            exact=exact,
        )


def _with_contacts(points: FreshPoints, tasks: Sequence[LineTask]) -> dict[str, FloatArray]:
    """Values of the fresh films between other solids."""
    rows = []
    for one, task in zip(points.solutions, tasks, strict=True):
        (load,), contact = task.loads, task.contact
        stiffness = 1.0 / (contact.structural_compliance(load) + one.film_compliance)
        approach = contact.structural_approach(load) - one.film_offset
        damping = max(one.loss_compliance, 0.0) * stiffness**2
        rows.append((stiffness, damping, one.film_offset, approach))
    columns = np.array(rows, dtype=np.float64).reshape(-1, 4).T
    return dict(zip((STIFFNESS, DAMPING, OFFSET, APPROACH), columns, strict=True))


def _grid_laws(job: Job, solver: ContactSolver) -> tuple[Callable[[], dict[str, ContactLaw]], float]:
    """Laws of a map without lines, and its processor time."""
    tasks = line_tasks(job, solver)
    results, seconds = _solved(tasks)

    def laws() -> dict[str, ContactLaw]:
        emap = EHDMap(assemble(job, solver, placed(job, tasks, results)))
        return {
            contact.name: emap.law(contact.name, "clamp", supply=FLOODED, surface=SMOOTH)  # type: ignore[arg-type]
            for contact in job.contacts
        }

    return laws, seconds


def _grid_seconds(job: Job, solver: ContactSolver) -> float:
    """Processor time of the grid of a map, from some of its lines."""
    tasks = line_tasks(job, solver)
    timed = tasks[:: max(len(tasks) // TIMED_LINES, 1)]
    _, seconds = _solved(timed)
    return seconds * job.points / sum(task.points for task in timed)


def _solved(tasks: Sequence[LineTask]) -> tuple[dict[str, Arrays], float]:
    """Arrays of tasks by key, and the processor time that they took; what a first solve compiles is not in it."""
    first = tasks[0]
    replace(first, loads=first.loads[:1]).run()
    begin = time.process_time()
    found = {task.key: task.run() for task in tasks}
    return found, time.process_time() - begin


def _grid_label(job: Job) -> str:
    """Points of the axes and their distances, in words."""
    loads, speeds, temperatures = job.loads, job.entrainment_speeds, job.temperatures
    words = [f"{len(loads)}{_ratio(loads)}", f"{len(speeds)}{_ratio([u for u in speeds if u > 0.0])}"]
    apart = f" ({KELVIN.text(max(np.diff(temperatures)))})" if len(temperatures) > 1 else ""
    return " x ".join([*words, f"{len(temperatures)}{apart}"]) + f": {job.points} points"


def _ratio(axis: Sequence[float]) -> str:
    """Largest ratio of neighbours, in words."""
    return f" (by {max(np.asarray(axis[1:]) / np.asarray(axis[:-1])):.3g})" if len(axis) > 1 else ""


def _thinned(axis: Sequence[float]) -> tuple[float, ...]:
    """Every second value of an axis, with both ends."""
    return tuple(dict.fromkeys((*axis[:-1:2], axis[-1])))


def _between(axis: Sequence[float]) -> tuple[float, ...]:
    """An axis with the geometric mean between each two values besides."""
    values = np.asarray(axis)
    return tuple(np.sort(np.concatenate([values, np.sqrt(values[1:] * values[:-1])])).tolist())
