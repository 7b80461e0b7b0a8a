"""From a job to a map file: the whole story in one function."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from ehdmaps.jobs import solvers
from ehdmaps.jobs.assemble import assemble
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.law_check import checked_laws, plan_check
from ehdmaps.jobs.refinement import backbone_group, refinement
from ehdmaps.jobs.status import StatusFile
from ehdmaps.jobs.store import Store, store_path
from ehdmaps.jobs.sweep import Progress, SweepResult, sweep
from ehdmaps.jobs.tasks import line_tasks
from ehdmaps.jobs.write import write_map
from ehdmaps.maps import schema
from ehdmaps.maps.checksum import content_sha256
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.validation import validate
from ehdmaps.physics.solution import ContactSolver


@dataclass(frozen=True)
class Generated:
    """A finished map and how it came about.

    Attributes
    ----------
    dataset : xarray.Dataset
        As written.
    sweep : SweepResult
        Counts and times.
    """

    dataset: xr.Dataset
    sweep: SweepResult


def generate(
    job: Job,
    output: Path,
    workers: int | None = None,
    fresh: bool = False,
    progress: Callable[[int], Progress] | None = None,
    solver: ContactSolver | None = None,
) -> Generated:
    """Make a map; what its store has already is taken over.

    Parameters
    ----------
    job : Job
        What to make.
    output : Path
        The map file; its store stands beside it.
    workers : int, optional
        Processes; all cores if left out. A script that uses more than one needs the usual
        ``if __name__ == "__main__":``.
    fresh : bool
        Drop the store first.
    progress : callable, optional
        Takes the number of points, gives the `Progress` to tell.
    solver : ContactSolver, optional
        Instead of the job's; picklable.

    Raises
    ------
    InputError, StoreError, MapError
        With what to do; everything solved is kept.
    """
    chosen = solver or solvers.build(job.solver, job.solver_options)
    tasks = line_tasks(job, chosen)
    refined = refinement(job, chosen)
    check = plan_check(job, chosen)
    everything = (*tasks, *(refined.tasks if refined else ()), *(check.tasks if check else ()))
    total = sum(task.points for task in everything)
    processes = workers or available_cores()
    with Store(store_path(output), fresh) as store, StatusFile(output, job, total, processes) as status:
        told = progress(total) if progress else None
        result = sweep(everything, store, processes, told, [status])
        status.write()
        dataset = assemble(job, chosen, tasks, result.arrays)
        validate(dataset, str(output))
        group = backbone_group(refined, result.arrays) if refined else None
        if check:
            dataset.attrs.update(checked_laws(check, EHDMap(dataset, group), result.arrays))
        dataset.attrs[schema.CHECKSUM] = content_sha256(dataset, group)
        write_map(dataset, output, {schema.BACKBONE_GROUP: group} if group is not None else None)
    return Generated(dataset, result)


def available_cores() -> int:
    """Return the cores that this process may use, which may be fewer than the machine has."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
