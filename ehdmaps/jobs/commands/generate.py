"""`ehdmaps generate`: make maps, or go on with them."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from typing import Any

from ehdmaps.errors import InputError, Problems
from ehdmaps.jobs import solvers
from ehdmaps.jobs.executors import executor_problem, named_executor
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.batch import SUMMARY, is_batch, read_batch
from ehdmaps.jobs.make.batch_generate import batch_path, generate_batch, make_folder, write_table
from ehdmaps.jobs.make.batch_generate import summary as batch_summary
from ehdmaps.jobs.make.generate import generate, summary
from ehdmaps.jobs.make.law_check import TOLERANCES, unmet
from ehdmaps.jobs.make.report import holes, unsolved
from ehdmaps.jobs.make.status import progress
from ehdmaps.jobs.make.store import store_path
from ehdmaps.jobs.reader import is_map, read_job
from ehdmaps.outputs import MAP, TABLE, Output, check_outputs
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.program import tell
from ehdmaps.units import quantity_within

INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells have it."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Make the maps, one after the other; status 1 if one has points without a solution, or a law not good enough."""
    batches = [source for source in arguments.jobs if is_batch(source)]
    if batches:
        return _batch(batches[0], arguments)
    tolerance = None if arguments.law_tolerance is None else read_tolerance(arguments.law_tolerance)
    texts, status = [], 0
    planned = _planned(arguments)
    with named_executor(arguments.executor, arguments.workers) as executor:
        for job, output in planned:
            text, map_status = _made(job, output, arguments, tolerance, executor)
            texts.append(text)
            status = max(status, map_status)
            if map_status == INTERRUPTED:
                break
    return "\n\n".join(text for text in texts if text), status


def _batch(source: str, arguments: argparse.Namespace) -> tuple[str, int]:
    """Make the maps of a batch file."""
    beside = {
        "JOB": len(arguments.jobs) > 1,
        "--keep-cases": arguments.keep_cases is not None,
        "--law-tolerance": arguments.law_tolerance is not None,
        "--check (say checked = 3 in [batch])": arguments.check,
        '--fresh-films (say films = "solved" in [solver])': arguments.fresh_films,
    }
    problems = Problems(
        f"{option}: stands beside a batch file, {source}; allowed: with jobs; leave it out, or give a job"
        for option, given in beside.items()
        if given
    )
    problems.check()
    batch = read_batch(source, arguments.solver, to_run=True)
    folder = Path(arguments.output or batch.name)
    make_folder(folder)
    check_outputs([Output("summary", folder / SUMMARY, TABLE)], [source])
    store = store_path(batch_path(batch, folder))
    try:
        with named_executor(arguments.executor, arguments.workers) as executor:
            result = generate_batch(
                batch,
                folder,
                arguments.workers,
                arguments.fresh,
                progress,
                executor,
                told=lambda total: progress(total, "map"),
            )
    except KeyboardInterrupt:
        tell(f"\nstopped; what is solved is kept in {store}: the same command goes on from there")
        return "", INTERRUPTED
    return batch_summary(result, write_table(result, folder)), result.status


def _planned(arguments: argparse.Namespace) -> list[tuple[Job, Path]]:
    """All jobs with the maps that they become; all problems at once, before the first one is made."""
    several = len(arguments.jobs) > 1
    problems = Problems()
    if arguments.executor is not None and (problem := executor_problem(arguments.executor)):
        problems.append(problem)
    if several and arguments.output is not None:
        problems.append("-o: stands beside several jobs; allowed: with one; each map is called after its job")
    planned: list[tuple[Job, Path]] = []
    for source in arguments.jobs:
        try:
            job = read_job(source, arguments.solver, to_run=True)
            if arguments.output is None and is_map(source):
                advice = "give its job" if several else "give the map to write with -o"
                raise InputError(f"-o: missing; {source} is a map itself; {advice}")
            output = Path(arguments.output or f"{job.name}.nc")
            check_outputs([Output("-o", output, MAP)], [source])
            if output in (other for _, other in planned):
                raise InputError(f"{source}: its map {output} is that of another job, too; give each another name")
        except InputError as error:
            problems += error.problems
        else:
            planned.append((job, output))
    problems.check()
    return planned


def read_tolerance(text: str) -> float:
    """Read the tolerance of contact laws, such as "1 %".

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
    low, high = TOLERANCES
    allowed = f'allowed: a share of k, c and film offset of the laws from "{100 * low:g} %" to "{100 * high:g} %"'
    return quantity_within(text, "", low, high, f"--law-tolerance: got {text[:40]!r}; {allowed}")


def _made(
    job: Job, output: Path, arguments: argparse.Namespace, tolerance: float | None, executor: Executor | None
) -> tuple[str, int]:
    """Make one map."""
    by = job.corrected_by
    if arguments.fresh_films:
        job = _with_fresh_films(job)
    kept = solvers.case_options(by.solver if by and _keeps_cases(by.solver) else job.solver, arguments.keep_cases)
    solver = _built(job.solver, job.solver_options, kept) if kept else None
    corrector = _built(by.solver, by.options, kept) if by else None
    try:
        generated = generate(
            job,
            output,
            arguments.workers,
            arguments.fresh,
            progress,
            solver,
            corrector,
            executor,
            tolerance=tolerance,
            check=arguments.check,
        )
    except KeyboardInterrupt:
        tell(f"\nstopped; what is solved is kept in {store_path(output)}: the same command goes on from there")
        return "", INTERRUPTED
    without_solution = holes(generated.dataset) + unsolved(generated.dataset)
    missed = unmet(generated.dataset, generated.backbone is not None)
    text = "\n".join([summary(generated, output), *_not_in_it(job, output), *missed])
    return text, 1 if without_solution or missed else 0


def _not_in_it(job: Job, output: Path) -> list[str]:
    """A line on what the job holds open; none where it states nothing."""
    known = {name: one.text for name, one in job.tolerances.items() if name != "clearance"}  # in no film
    if not known:
        return []
    told = ", ".join(f"{name.replace('_', '-')} {text}" for name, text in known.items())
    return [
        f"not in the map: {told}; its points are those of the numbers as stated, and `ehdmaps solve {output} ...` says "
        "what these may change at a point"
    ]


def _with_fresh_films(job: Job) -> Job:
    """A job whose films are all solved.

    Raises
    ------
    InputError
        If its solver reads none.
    """
    if job.solver != "reynolds":
        raise InputError(f"--fresh-films: the solver {job.solver!r} reads no films; allowed: with the solver reynolds")
    return replace(job, solver_options={**job.solver_options, "films": solvers.SOLVED})


def _keeps_cases(name: str) -> bool:
    """Tell whether a solver can keep its cases."""
    return solvers.SOLVERS[name].keeps_cases


def _built(name: str, options: Mapping[str, Any], kept: Mapping[str, Any]) -> ContactSolver:
    """A solver of the job, which keeps its cases where it has some and that is wanted."""
    return solvers.build(name, {**options, **(kept if _keeps_cases(name) else {})})
