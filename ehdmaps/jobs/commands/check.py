"""`ehdmaps check`: every problem of a job file at once, else what it would cost."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass

from ehdmaps.compiling import cpu_seconds, stopwatch
from ehdmaps.jobs import solvers
from ehdmaps.jobs.estimate_bands import band_lines
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.batch import is_batch, read_batch
from ehdmaps.jobs.make.batch_generate import plan_batch
from ehdmaps.jobs.make.generate import planned_tasks
from ehdmaps.jobs.make.report import AXES, span
from ehdmaps.jobs.make.table_films import unserved
from ehdmaps.jobs.make.tasks import LineTask, line_tasks
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.supply import supply_words, surface_words
from ehdmaps.physics.closed_form import film_change
from ehdmaps.physics.solution import ContactSolver, Status
from ehdmaps.table.solver import TableSolver
from ehdmaps.units import LOAD, SPEED, TEMPERATURE
from ehdmaps.workers import available_cores

_BYTES_PER_POINT = 800
_SECONDS_PER_POINT = 1e-4
"""Results, dataset and the copy that is written; keeping and assembling: measured on a map of 200 000 points."""

_SAMPLES = 4

UNSOLVED = " of the job itself, but the point that was tried has no solution"

OFF = 0.2
"""Relative error of the pressure-viscosity for which the change of the film is told."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Read the job (its problems are raised), then estimate points, time and memory.

    The exit status is 1 where a point that a slow solver tries has no solution.
    """
    import numpy as np

    if is_batch(arguments.job):
        return _batch(arguments.job, arguments.solver)
    job = read_job(arguments.job, arguments.solver, to_run=True)
    solver = solvers.of_map(job)
    values = (job.loads, job.entrainment_speeds, job.temperatures)
    axes = [
        f"  {name:20s} {len(axis):6d}  {span(np.array(axis), display)}"
        for (name, display), axis in zip(AXES, values, strict=True)
    ]
    names = ", ".join(contact.name for contact in job.contacts)
    planned = sum(task.points for task in planned_tasks(job))
    read = isinstance(solver, TableSolver) and not unserved(job, solver)
    by = job.corrected_by
    extra = planned if read else planned - job.points
    corrected = f", {by.points} for its correction" if by else ""
    cheap = planned + (by.points if by else 0)
    estimates = [estimated_time(job, solver, cheap)]
    if by is not None:
        estimates.append(estimated_time(job, solvers.build(by.solver, by.options), by.points))
    solved = all(estimate.solved for estimate in estimates)
    lines = [
        f"{arguments.job}: no problems{'' if solved else UNSOLVED}",
        f"  {job.title}, {job.lubricant.title}, solver {job.solver}, structural law {job.contacts[0].structural_law}",
        *([f"  assumed: {', '.join(job.assumed)}"] if job.assumed else []),
        *job.estimates,
        *oil_lines(job),
        *band_lines(job),
        f"  supply  {supply_words(job.supply)}",
        f"  surfaces {surface_words(job.surface)}",
        f"  {'contact':20s} {len(job.contacts):6d}  {names}",
        *axes,
        f"  points  {job.points} of the map read from the film table, {extra} solved to check its contact laws"
        if read
        else f"  points  {job.points} of the map, {extra} for its contact laws{corrected}",
        f"  time    {estimates[0].words}",
        *(
            []
            if by is None
            else [
                f"  correction by {by.solver}: {by.points} points besides, chosen one after the other",
                f"  time    {estimates[1].words}",
            ]
        ),
        f"  memory  about {max(100.0 + cheap * _BYTES_PER_POINT / 1e6, 1.0):.0f} MB",
    ]
    return "\n".join(lines), 0 if solved else 1


def _batch(source: str, solver: str | None) -> tuple[str, int]:
    """Read a batch file, and tell what its maps share."""
    batch = read_batch(source, solver, to_run=True)
    plan = plan_batch(batch)
    solved = [planned for planned in plan if planned.tasks]
    read = len(plan) - len(solved)
    tasks = {task.key: task.points for planned in solved for task in planned.tasks}
    points = sum(tasks.values())
    lines = [
        f"{source}: no problems",
        f"  {len(batch.members)} maps, from {batch.members[0].name} to {batch.members[-1].name}",
        *([f"  {read} maps are read from the film table"] if read else []),
        *([f"  {len(solved)} maps are solved at their own points"] if solved else []),
        f"  points  {points} to solve",
    ]
    job = batch.members[0].job
    estimate = estimated_time(job, solvers.of_map(job), points)
    return "\n".join([*lines, f"  time    {estimate.words}, and that of putting maps together"]), 0


@dataclass(frozen=True)
class Estimate:
    """The time of a run in words, and whether the point that was tried for it has a solution."""

    words: str
    solved: bool = True


def oil_lines(job: Job) -> Iterator[str]:
    """Say what of the oil is estimated, and how much its pressure-viscosity matters in the middle of the map."""
    if job.lubricant.estimated:
        yield f"  lubricant: {job.lubricant.estimated}"
    load, speed, temperature = (axis[len(axis) // 2] for axis in (job.loads, job.entrainment_speeds, job.temperatures))
    state = job.lubricant.at(temperature)
    if job.solver == "hertz" or speed == 0.0 or state.pressure_viscosity.pressure_viscosity == 0.0:
        return
    change = film_change(job.contacts[0], state, load, speed, 1.0 + OFF)
    yield (
        f"  a pressure-viscosity that is {OFF:.0%} higher makes the film {change:.1%} thicker (film formula of Moes at "
        f"{LOAD.text(load)}, {SPEED.text(speed)}, {TEMPERATURE.text(temperature)}, the middle of the map)"
    )


def estimated_time(job: Job, solver: ContactSolver, points: int) -> Estimate:
    """Estimate the time of a run by solving a few lines of it.

    Parameters
    ----------
    job : Job
        What is to be solved.
    solver : ContactSolver
        Solver whose time is estimated.
    points : int
        How many points in all.
    """
    # what is not read is solved
    solver = solver.other if isinstance(solver, TableSolver) else solver
    tasks = line_tasks(job, solver)
    if solver.slow:
        return _time_of_slow(tasks[len(tasks) // 2], points)
    tasks[0].run()  # compiles, where the solver does
    sample = tasks[:: max(len(tasks) // _SAMPLES, 1)][:_SAMPLES]
    watch = stopwatch()
    for task in sample:
        task.run()
    per_point = watch() / sum(task.points for task in sample)
    cores = available_cores()
    seconds = points * (per_point / cores + _SECONDS_PER_POINT)
    words = (
        f"about {seconds:.2g} s of wall time on {cores} cores ({per_point * 1e3:.2g} ms of processor time a point, "
        f"from {len(sample)} lines)"
    )
    return Estimate(words)


def _time_of_slow(task: LineTask, points: int) -> Estimate:
    """Estimate the time from one point in the middle of the map, which shows that the solver runs, too."""
    began = cpu_seconds()  # with the programs that it runs
    arrays = task.run()
    seconds = cpu_seconds() - began
    status = Status(int(arrays["status"][0]))
    trial = f"{seconds:.2g} s of processor time for one point in the middle of the map: {status.word}"
    if not status.usable:
        return Estimate(f"not estimated; {trial}: {arrays['reason'][0]}", solved=False)
    cores = available_cores()
    return Estimate(f"about {points * seconds / cores:.2g} s of wall time on {cores} cores ({trial})")
