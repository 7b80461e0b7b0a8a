"""`ehdmaps check`: every problem of a job file at once, else what it would cost."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from ehdmaps.jobs import solvers
from ehdmaps.jobs.cost import Cost, cost, total
from ehdmaps.jobs.estimate_bands import band_lines
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.batch import is_batch, read_batch
from ehdmaps.jobs.make.batch_generate import plan_batch
from ehdmaps.jobs.make.generate import FEW, planned_tasks, tasks_besides
from ehdmaps.jobs.make.report import AXES
from ehdmaps.jobs.make.table_films import unserved
from ehdmaps.jobs.make.tasks import line_tasks
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.supply import supply_words, surface_words
from ehdmaps.physics.closed_form import film_change
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.table.solver import TableSolver
from ehdmaps.units import point_text, span
from ehdmaps.workers import available_cores

UNSOLVED = " of the job itself, but no point that was tried has a solution"

OFF = 0.2
"""Relative error of the pressure-viscosity for which the change of the film is told."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Read the job (its problems are raised), then estimate points, time and memory.

    The exit status is 1 where no point that a slow solver tries has a solution.
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
    by, besides = job.corrected_by, tasks_besides(job)
    extra = planned if read else planned - job.points
    corrected = f", {by.points} for its correction" if by else ""
    costs = {job.solver: cost_of(job, solver, planned + (by.points if by else 0))}
    if by is not None:
        costs[by.solver] = cost_of(job, solvers.build(by.solver, by.options), by.points)
    if besides:
        points = sum(task.points for task in besides)
        costs[besides[0].solver.name] = cost(besides, points, available_cores())
    solved = all(one.solved for one in costs.values())
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
        total(tuple(costs.values())),
        *(f"    {name:20s} {one.words}" for name, one in costs.items()),
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
    found = cost_of(job, solvers.of_map(job), points)
    parts = [f"    {found.words}, and what putting maps together takes"]
    return "\n".join([*lines, total([found]), *parts]), 0


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
        f"{point_text(load, speed, temperature)}, the middle of the map)"
    )


def cost_of(job: Job, solver: ContactSolver, points: int) -> Cost:
    """Estimate what a run costs by solving a little of it.

    Parameters
    ----------
    job : Job
        What is to be solved.
    solver : ContactSolver
        Solver whose cost is estimated.
    points : int
        How many points in all.
    """
    # what is not read is solved
    few = isinstance(solver, TableSolver) and points <= FEW
    solver = solver.other if isinstance(solver, TableSolver) else solver
    return cost(line_tasks(job, solver), points, 1 if few else available_cores())
