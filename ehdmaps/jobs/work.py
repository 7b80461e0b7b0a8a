"""What a job or a batch comes to, as tasks: what its shards are parts of."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs.batch import Batch, is_batch, read_batch
from ehdmaps.jobs.batch_generate import batch_path, make_folder
from ehdmaps.jobs.batch_plan import plan_batch
from ehdmaps.jobs.generate import planned_tasks
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.reader import is_map, read_job
from ehdmaps.jobs.shards import Merged, Shard, check_found, merge_shards, solve_shard, unique
from ehdmaps.jobs.status import about
from ehdmaps.jobs.store import Store, store_path
from ehdmaps.jobs.sweep import Progress, SweepResult, Task
from ehdmaps.outputs import MAP, Output, check_outputs


@dataclass(frozen=True)
class Work:
    """A job or a batch, with all of its tasks that are known before anything is solved.

    Attributes
    ----------
    source : str
        How the command was given it.
    asked : Job or Batch
        What is made.
    output : Path
        The map, or the folder of the maps.
    place : Path
        What stores and status are named after.
    what : str
        What is made, in words.
    sha256 : str
        Hash of the file and of the solver.
    tasks : tuple of Task
        The tasks, each once.
    """

    source: str
    asked: Job | Batch
    output: Path
    place: Path
    what: str
    sha256: str
    tasks: tuple[Task, ...]


def read_work(
    source: str | PathLike[str], output: str | PathLike[str] | None = None, solver: str | None = None
) -> Work:
    """Read a job or a batch, and lay out its tasks.

    Parameters
    ----------
    source : str or path
        Job file, map file, name of a shipped job, or batch file.
    output : str or path, optional
        The map, or the folder of a batch; named after the job or the batch if left out.
    solver : str, optional
        Takes the place of the solver of every job.

    Raises
    ------
    InputError
        With every problem found, also where the map could not be written at the end.
    """
    if is_batch(source):
        batch = read_batch(source, solver, to_run=True)
        folder = Path(batch.name if output is None else output)
        tasks = unique(plan_batch(batch).tasks())
        what = f"batch {batch.name}, {len(batch.members)} maps"
        return Work(fspath(source), batch, folder, batch_path(batch, folder), what, _hash(batch.sha256, solver), tasks)
    job = read_job(source, solver, to_run=True)
    if output is None and is_map(fspath(source)):
        raise InputError(f"-o: missing; {fspath(source)} is a map itself; give the map to write with -o")
    path = Path(f"{job.name}.nc" if output is None else output)
    check_outputs([Output("-o", path, MAP)], [fspath(source)])
    return Work(fspath(source), job, path, path, about(job), _hash(job.sha256, job.solver), unique(planned_tasks(job)))


def run_shard(
    work: Work,
    shard: Shard,
    workers: int | None = None,
    fresh: bool = False,
    progress: Callable[[int], Progress] | None = None,
    executor: Executor | None = None,
) -> SweepResult:
    """Solve one shard of a job or a batch into its own store.

    Parameters
    ----------
    work : Work
        The job or the batch.
    shard : Shard
        Which part.
    workers, fresh, progress, executor
        The same as for `ehdmaps.jobs.generate.generate`.

    Raises
    ------
    InputError
        If the folder of a batch cannot be made.
    StoreError
        If the store cannot be read or written.
    """
    if isinstance(work.asked, Batch):
        make_folder(work.output)
    return solve_shard(work.tasks, work.place, shard, work.what, work.sha256, workers, fresh, progress, executor)


def merge(work: Work) -> Merged:
    """Bring the stores of the shards together into the store of the whole.

    Parameters
    ----------
    work : Work
        The job or the batch.

    Raises
    ------
    InputError, StoreError
        If a store is missing, is another job's, or cannot be read.
    """
    check_found(work.place)  # before a store of the whole is made
    with Store(store_path(work.place)) as store:
        return merge_shards(work.tasks, work.place, work.sha256, store)


def _hash(sha256: str, solver: str | None) -> str:
    """Hash of a file and a solver."""
    return hashlib.sha256(f"{sha256} {solver or ''}".encode()).hexdigest()
