"""From a job to a map file: the whole story in one function, and what the run did in words."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr

from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.assemble import assemble, placed, with_correction
from ehdmaps.jobs.make.correction import Correction, correction, correction_by_points
from ehdmaps.jobs.make.law_check import HALVED, REFUSED, LawCheck, checked_laws, coarse_axis, films_met, met, plan_check
from ehdmaps.jobs.make.log import RunLog, job_lines
from ehdmaps.jobs.make.report import (
    correction_lines,
    error_lines,
    extrapolated_lines,
    films_lines,
    holes,
    law_lines,
    reach_lines,
    spacing_lines,
    status_lines,
)
from ehdmaps.jobs.make.sampling import SamplePoint
from ehdmaps.jobs.make.spacing import SpacingPlan, plan_spacing, with_spacing
from ehdmaps.jobs.make.status import StatusFile, about
from ehdmaps.jobs.make.store import Arrays, NoStore, Results, Store, store_path
from ehdmaps.jobs.make.sweep import Progress, SweepResult, sweep
from ehdmaps.jobs.make.table_films import table_films, unserved
from ehdmaps.jobs.make.tasks import (
    MOST_LINE_POINTS,
    LineTask,
    Refinement,
    backbone_group,
    knows_heat,
    line_tasks,
    refinement,
)
from ehdmaps.maps import schema
from ehdmaps.maps.backbone_plan import Axis
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.reading import content_sha256, points_seal, validate
from ehdmaps.maps.records import record_from_json
from ehdmaps.outputs import MAP, written_aside
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.table.file import CHECKSUM, shipped_tables
from ehdmaps.table.solver import TableSolver
from ehdmaps.workers import available_cores

_ADVICE = "free space or choose another output with -o, and run the same command again: what was solved is kept"


def write_map(dataset: xr.Dataset, path: Path, groups: Mapping[str, xr.Dataset] | None = None) -> None:
    """Write a map; a map that stands there is replaced at once and whole, or not at all.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map as `assemble` made it.
    path : Path
        The map file.
    groups : mapping, optional
        Datasets of further netCDF groups, such as "backbone".

    Raises
    ------
    MapError
        If it cannot be written, or something else stands there; that is untouched.
    """
    try:
        with written_aside(path, MAP, _ADVICE) as aside:
            dataset.to_netcdf(aside, engine="netcdf4", mode="w")
            for name, group in (groups or {}).items():
                group.to_netcdf(aside, engine="netcdf4", mode="a", group=name)
    except InputError as error:
        raise MapError(str(error)) from error


def summary(generated: Generated, output: Path) -> str:
    """Return the summary that is printed after a run.

    Parameters
    ----------
    generated : Generated
        The finished map.
    output : Path
        File of the map.
    """
    return "\n".join(_lines(generated, output))


def _lines(generated: Generated, output: Path) -> Iterator[str]:
    dataset, sweep = generated.dataset, generated.sweep
    yield f"{output}: {dataset.attrs['title']}"
    if estimated := record_from_json(dataset.attrs["geometry"], "geometry").get("estimated"):
        yield f"  bearing: {estimated}"
    if assumed := dataset.attrs.get(schema.ASSUMED):
        yield f"  assumed: {assumed}"
    counts = f"{sweep.taken_over} taken over, {sweep.solved} solved now"
    yield f"points: {counts}, {holes(dataset)} without a solution"
    yield from films_lines(dataset)
    if sweep.damaged:
        yield f"store: {sweep.damaged} damaged entries were solved again"
    yield from status_lines(dataset)
    yield from extrapolated_lines(dataset)
    yield from reach_lines(EHDMap(dataset, generated.backbone))
    yield "accuracy"
    yield from error_lines(dataset)
    yield from law_lines(dataset)
    yield from spacing_lines(dataset)
    yield from correction_lines(dataset)
    seconds = float(np.nansum(dataset["solve_seconds"].values))
    yield (
        f"time: {sweep.wall_seconds:.1f} s now (wall time); {seconds:.1f} s of processor time for solving the whole map"
    )
    estimated = json.loads(dataset.attrs["lubricant"]).get("estimated")
    if estimated or int(dataset.attrs["lubricant_verified"]) == 0:
        yield f"lubricant: {estimated or 'its data are not verified: compare them with a data sheet'}"


FEW = 200
"""Points that are solved sooner than a process has started: those of the check of a map from the film table."""

MOST_HALVINGS = 3
"""How often the steps of the lines of a law are halved, each time along one axis."""


@dataclass(frozen=True)
class Within:
    """Surroundings of a map that is one of several: their store, status and log, and what marks it as theirs."""

    store: Results
    status: StatusFile
    log: RunLog
    attributes: Mapping[str, str | int]


@dataclass(frozen=True)
class Generated:
    """A finished map and how it came about.

    Attributes
    ----------
    dataset : xarray.Dataset
        The map as it is written.
    backbone : xarray.Dataset or None
        The group of refinement lines, where there are some.
    sweep : SweepResult
        Counts and times.
    """

    dataset: xr.Dataset
    backbone: xr.Dataset | None
    sweep: SweepResult


def generate(
    job: Job,
    output: Path,
    workers: int | None = None,
    fresh: bool = False,
    progress: Callable[[int], Progress] | None = None,
    solver: ContactSolver | None = None,
    corrector: ContactSolver | None = None,
    executor: Executor | None = None,
    within: Within | None = None,
    tolerance: float | None = None,
    check: bool = False,
) -> Generated:
    """Make a map; what its store has already is taken over.

    Parameters
    ----------
    job : Job
        What to make.
    output : Path
        The map file; its store and its log stand beside it.
    workers : int, optional
        Number of processes; all cores if left out. A script that uses more than one needs the usual
        ``if __name__ == "__main__":``.
    fresh : bool
        Drop store and log first.
    progress : callable, optional
        Takes the number of points, gives the `Progress` to tell.
    solver : ContactSolver, optional
        Instead of the job's; picklable.
    corrector : ContactSolver, optional
        Instead of the dearer solver that the job names in `corrected_by`; picklable.
    executor : concurrent.futures.Executor, optional
        What solves the points in place of processes that are started here.
    within : Within, optional
        The batch that the map belongs to, whose store is open.
    tolerance : float, optional
        Share of stiffness, damping and film offset that the contact laws may be wrong by, in place of the usual bars of
        their check: lines that are solved are laid more closely until they keep it.
    check : bool
        Whether laws that read the film table are held against fresh solves, as solved ones are in any case.

    Raises
    ------
    InputError, StoreError, MapError, WorkerError, DiskFullError
        With what to do; everything solved is kept.
    """
    chosen_solver = _solver(job, solver)
    planned = _plan(job, chosen_solver, _corrector(job, corrector), tolerance, check)
    processes = workers or available_cores()
    with ExitStack() as stack:
        if within is None:
            store: Results = stack.enter_context(Store(store_path(output), fresh))
            status = stack.enter_context(StatusFile(output, about(job), planned.points, processes))
            lines = job_lines(job, chosen_solver, planned.corrector)
            log = stack.enter_context(RunLog(output, lines, planned.points, processes, fresh))
        else:
            store, status, log = within.store, within.status, within.log
            log.told(f"map {output}", list(job_lines(job, chosen_solver, planned.corrector)))
        result = SweepResult()

        def solve(tasks: Sequence[LineTask], more: bool = True) -> Mapping[str, Arrays]:
            missing = [task for task in tasks if task.key not in result.arrays]
            points = sum(task.points for task in missing)
            if more:
                status.more(points)
                log.more(points)
            if missing:
                counter = progress(points) if progress else None
                few = isinstance(chosen_solver, TableSolver) and points <= FEW
                result.add(sweep(missing, store, 1 if few else processes, counter, [status, log], executor))
            status.write()
            return result.arrays

        planned = _corrected(planned, solve)
        solve(planned.everything, more=False)
        dataset, group = _refined(planned, result, str(output), solve)
        dataset.attrs.update(within.attributes if within else {})
        write_map(dataset, output, {schema.BACKBONE: group} if group is not None else None)
        generated = Generated(dataset, group, result)
        if within is None:
            log.finish(summary(generated, output))
    return generated


def generate_in_memory(
    job: Job,
    workers: int | None = None,
    progress: Callable[[int], Progress] | None = None,
    solver: ContactSolver | None = None,
    corrector: ContactSolver | None = None,
    executor: Executor | None = None,
    check: bool = False,
) -> Generated:
    """Make a map without a file and without a store: what is not finished is lost.

    Arguments and errors as of `generate`.
    """
    planned = _plan(job, _solver(job, solver), _corrector(job, corrector), solves=check)

    result = SweepResult()

    def solve(tasks: Sequence[LineTask]) -> Mapping[str, Arrays]:
        points = sum(task.points for task in tasks)
        counter = progress(points) if progress else None
        result.add(sweep(tasks, NoStore(), workers or available_cores(), counter, executor=executor))
        return result.arrays

    planned = _corrected(planned, solve)
    solve(planned.everything)
    dataset, group = _refined(planned, result, job.name, solve)
    return Generated(dataset, group, result)


def read_in_memory(job: Job, solver: TableSolver) -> xr.Dataset:
    """Make the dataset of a map without a check of its laws, that the film table serves, see `unserved`.

    Parameters
    ----------
    job : Job
        What to make.
    solver : TableSolver
        What gives its films.
    """
    planned = _Plan(job, solver, None, (), None, None, from_table=True)
    return _finished(planned, SweepResult(), job.name)[0]


def read_map(job: Job, output: Path, attributes: Mapping[str, str | int]) -> xr.Dataset | None:
    """Make a map whose films are all read from the film table, in this process; None where that does not serve it.

    Parameters
    ----------
    job : Job
        What to make.
    output : Path
        The map file.
    attributes : mapping
        Attributes of the map besides.

    Raises
    ------
    MapError
        If it cannot be written.
    """
    planned = _plan(job, solvers.of_map(job), None, solves=True)
    if not planned.from_table:
        return None
    result = sweep(planned.everything, NoStore(), 1)
    dataset, _ = _finished(planned, result, str(output))
    if not _served(planned, dataset, result):
        return None
    dataset.attrs.update(attributes)
    write_map(dataset, output, None)
    return dataset


def planned_tasks(job: Job, solver: ContactSolver | None = None) -> tuple[LineTask, ...]:
    """All that is known to be solved by the solver of a map before anything is solved.

    Points that hang on results come later: those of a correction, of lines that turn out too coarse, of a tolerance.
    Those that a faster solver is asked for besides are left out, see `ehdmaps.jobs.make.spacing`.

    Parameters
    ----------
    job : Job
        What to make.
    solver : ContactSolver, optional
        Instead of the job's.
    """
    plan = _plan(job, _solver(job, solver), None)
    return tuple(task for task in plan.everything if task.solver.name == plan.solver.name)


def tasks_besides(job: Job) -> tuple[LineTask, ...]:
    """Points that a faster solver than that of a job is asked for besides, see `ehdmaps.jobs.make.spacing`.

    Parameters
    ----------
    job : Job
        What to make.
    """
    plan = _plan(job, _solver(job, None), None)
    return tuple(task for task in plan.everything if task.solver.name != plan.solver.name)


@dataclass(frozen=True)
class _Plan:
    """All that is solved for a map: its points, the lines of a contact law, and the check of the laws.

    Laws that are made from the points alone, and not checked, have points for the errors of their spacing.

    With `from_table` points and laws are read from the film table, and the check is all that is solved; `unserved` says
    why they are not, where they were to be. `halved` are the axes along which the steps of the lines were halved, in
    turn; `correction` is what the points of the `corrector` made, once they are solved. With `own_lines` it is made by
    the points of the map: the lines are those of a fast solver, and it corrects nothing else.
    """

    job: Job
    solver: ContactSolver
    corrector: ContactSolver | None
    tasks: tuple[LineTask, ...]
    refined: Refinement | None
    check: LawCheck | None
    spacing: SpacingPlan | None = None
    from_table: bool = False
    unserved: str = ""
    halved: tuple[Axis, ...] = ()
    correction: Correction | None = None
    own_lines: bool = False

    @property
    def line_solver(self) -> ContactSolver:
        """Solver of the lines."""
        return (self.own_lines and _beside(self.job, self.solver)) or self.solver

    @property
    def everything(self) -> tuple[LineTask, ...]:
        """All tasks, in the order in which they are solved."""
        lines = self.refined.tasks if self.refined else ()
        besides = self.spacing.besides(self.tasks) if self.spacing else ()
        return (*self.tasks, *lines, *(self.check.to_solve if self.check else ()), *besides)

    @property
    def points(self) -> int:
        """Number of points in all."""
        return sum(task.points for task in self.everything)


def _solver(job: Job, instead: ContactSolver | None) -> ContactSolver:
    """The solver of a job, or another one."""
    return solvers.complete(instead or solvers.of_map(job))


def _corrector(job: Job, instead: ContactSolver | None) -> ContactSolver | None:
    """The solver that corrects the films of a job, or another one; None where nothing is to be corrected."""
    by = job.corrected_by
    if by is None:
        if instead is not None:
            raise InputError("corrector: got one for a job without corrected_by; allowed: for a job with it")
        return None
    return solvers.complete(instead or solvers.build(by.solver, by.options))


def _plan(
    job: Job,
    solver: ContactSolver,
    corrector: ContactSolver | None,
    tolerance: float | None = None,
    solves: bool = False,
) -> _Plan:
    """Lay out what is to be solved; `solves` says whether laws of the film table are held against fresh solves."""
    if not (why := unserved(job, solver)):
        return _Plan(job, solver, corrector, (), None, plan_check(job, solver, tolerance, solves), from_table=True)
    return _solved(job, solver, corrector, why, tolerance)


def _solved(
    job: Job, solver: ContactSolver, corrector: ContactSolver | None, why: str, tolerance: float | None
) -> _Plan:
    """Lay out points and lines that are solved, in place of the film table where that was to be read."""
    if isinstance(solver, TableSolver):
        solver = solvers.in_place_of_table(job, solver)
    else:
        why = ""
    lines, check = refinement(job, solver), plan_check(job, solver, tolerance)
    fast = None if lines else _beside(job, solver)
    own = refinement(job, fast) if fast else None
    spacing = plan_spacing(job, solver) if lines is None and (check is None or own) else None
    if spacing is None:
        own = None
    tasks = line_tasks(job, solver)
    return _Plan(job, solver, corrector, tasks, lines or own, check, spacing, unserved=why, own_lines=own is not None)


def _beside(job: Job, solver: ContactSolver) -> ContactSolver | None:
    """Solver of the lines of a map by CFD, in seconds; None where that takes as long as the map, as with heat."""
    fast = solvers.reference(job, solver)
    return None if fast is None or fast is solver or knows_heat(fast) else fast


def _with_own_lines(planned: _Plan, result: SweepResult) -> _Plan:
    """The plan with its lines corrected by its points, once these are solved; without lines where they are too few."""
    if not planned.own_lines or planned.spacing is None:
        return planned
    cheap, dear = (_by_place(tasks, result) for tasks in (planned.spacing.nodes, planned.tasks))
    job = planned.job
    axes = job.contacts, job.loads, job.entrainment_speeds, job.temperatures
    points = {
        place: SamplePoint(*(axis[index] for axis, index in zip(axes, place, strict=True)))  # type: ignore[arg-type]
        for place in dear
        if job.entrainment_speeds[place[2]] > 0.0
    }
    made = correction_by_points(job, list(points.values()), *([found[at] for at in points] for found in (cheap, dear)))
    if made is None:
        return replace(planned, refined=None, own_lines=False)
    return replace(planned, correction=made)


def _by_place(tasks: Sequence[LineTask], result: SweepResult) -> dict[tuple[int, int, int, int], Arrays]:
    """Arrays of single points by their indices in the map."""
    return {
        (i, load + n, j, k): {name: values[n : n + 1] for name, values in result.arrays[task.key].items()}
        for task in tasks
        for n in range(task.points)
        for i, load, j, k in [task.place]
    }


def _corrected(planned: _Plan, solve: Callable[[Sequence[LineTask]], Mapping[str, Arrays]]) -> _Plan:
    """The plan with its correction, where there is to be one: first of all, since without it there is no map."""
    by = planned.job.corrected_by
    if by is None or planned.corrector is None:
        return planned
    made = correction(planned.job, planned.solver, planned.corrector, by.points, solve)
    return replace(planned, correction=made)


def _results(planned: _Plan, result: SweepResult) -> Mapping[str, Arrays]:
    """Arrays of all tasks by key, corrected where that is wanted."""
    if planned.correction is None:
        return result.arrays
    tasks = planned.refined.tasks if planned.own_lines and planned.refined else planned.everything
    return {**result.arrays, **{t.key: planned.correction.corrected(t, result.arrays[t.key]) for t in tasks}}


def _refined(
    planned: _Plan, result: SweepResult, where: str, solve: Callable[[Sequence[LineTask]], object]
) -> tuple[xr.Dataset, xr.Dataset | None]:
    """Finish a map: films are solved where those of the film table miss, and lines laid more closely where these do.

    `solve` adds to the result.
    """
    planned = _with_own_lines(planned, result)
    dataset, group = _finished(planned, result, where)
    if planned.from_table and not _served(planned, dataset, result):
        tolerance = planned.check.tolerance if planned.check else None
        planned = _solved(planned.job, planned.solver, planned.corrector, not_served(dataset.attrs), tolerance)
        solve(planned.everything)
        dataset, group = _finished(planned, result, where)
    while len(planned.halved) < MOST_HALVINGS and (finer := _finer(planned, dataset, group, result)) is not None:
        planned = finer
        solve(finer.refined.tasks if finer.refined else ())
        dataset, group = _finished(planned, result, where)
    return dataset, group


def not_served(attributes: Mapping[str, object]) -> str:
    """Reason why a map that the film table was to serve is solved, by what the check of its laws found.

    Parameters
    ----------
    attributes : mapping
        Those of the map.
    """
    if REFUSED in attributes:
        return f"film table: makes no law ({attributes[REFUSED]})"
    return "film table: the laws that it makes miss their bars beside fresh solves"


def _served(planned: _Plan, dataset: xr.Dataset, result: SweepResult) -> bool:
    """Tell whether the film table has served a map: it makes laws, and films miss no bars that these miss."""
    if REFUSED in dataset.attrs:
        return False
    check = planned.check
    return met(dataset.attrs) or check is None or films_met(check, EHDMap(dataset), check.films(result.arrays))


def _makes_laws(dataset: xr.Dataset, group: xr.Dataset | None) -> bool:
    """Tell whether laws can be made from the lines of a map."""
    try:
        EHDMap(dataset, group).check_usable()
    except MapError:
        return False
    return True


def _finer(planned: _Plan, dataset: xr.Dataset, group: xr.Dataset | None, result: SweepResult) -> _Plan | None:
    """The plan with half the step along one axis of its lines; None where that would not help, or be too much."""
    if planned.check is None or planned.refined is None or met(dataset.attrs) or REFUSED in dataset.attrs:
        return None
    axis = coarse_axis(planned.check, EHDMap(dataset, group), _results(planned, result))
    if axis is None:
        return None
    lines = refinement(planned.job, planned.line_solver, planned.refined.steps.finer(axis))
    if lines is None or lines.points > MOST_LINE_POINTS:
        return None
    return replace(planned, refined=lines, halved=(*planned.halved, axis))


def _finished(planned: _Plan, result: SweepResult, where: str) -> tuple[xr.Dataset, xr.Dataset | None]:
    """Put results together, with the check of the laws and a checksum: the map and its backbone."""
    arrays = _results(planned, result)
    if planned.from_table and isinstance(planned.solver, TableSolver):
        films = table_films(planned.job, planned.solver)
    else:
        films = placed(planned.job, planned.tasks, arrays)
    dataset = assemble(planned.job, planned.solver, films)
    if planned.from_table:
        dataset.attrs[schema.FILM_TABLE] = shipped_tables().attributes[CHECKSUM]
    if planned.correction:
        by, lines_of = planned.corrector or planned.solver, planned.line_solver.name if planned.own_lines else ""
        dataset = with_correction(dataset, planned.job, planned.correction, by, lines_of)
    validate(dataset, where)
    group = None
    if planned.refined:
        group = backbone_group(planned.refined, arrays).assign_attrs({schema.SEAL: points_seal(dataset)})
    if planned.own_lines and not _makes_laws(dataset, group):
        return _finished(replace(planned, refined=None, correction=None, own_lines=False), result, where)
    if planned.check:
        dataset.attrs.update(checked_laws(planned.check, EHDMap(dataset, group), planned.check.films(arrays)))
    if planned.spacing and not planned.refined and not planned.check:
        dataset = with_spacing(dataset, planned.job, planned.spacing, result.arrays)
    if planned.unserved:
        dataset.attrs[schema.UNSERVED] = planned.unserved
    if planned.halved:
        dataset.attrs[HALVED] = ", ".join(planned.halved)
    dataset.attrs[schema.CHECKSUM] = content_sha256(dataset, group)
    return dataset, group
