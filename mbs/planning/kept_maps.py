"""Maps that `--auto` made before: one of a wider range serves a command that visits less."""

from __future__ import annotations

from pathlib import Path

from ehdmaps.errors import EhdmapsError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.tasks import solver_version
from ehdmaps.jobs.reader import read_job
from ehdmaps.maps.emap import EHDMap, open_map
from mbs.planning.ranges import LIGHT


def covering(paths: list[Path], job: Job) -> tuple[Path, EHDMap] | None:
    """The first map that holds all that a job would make, by this solver as it is now; None where there is none.

    Files that are no maps, are damaged, or were changed since are passed over.

    Parameters
    ----------
    paths : list of Path
        Files to look at, in this order.
    job : Job
        The job.
    """
    version = solver_version(solvers.of_map(job))
    for path in paths:
        try:
            if not covers(read_job(path), job):
                continue
            emap = open_map(path)
        except EhdmapsError:
            continue
        if emap.dataset.attrs.get("solver_version") == version:
            return path, emap
    return None


def covers(wide: Job, job: Job) -> bool:
    """Tell whether a job asks for the same contacts, oil, temperatures and solver, over loads and speeds as wide.

    A map that begins at `LIGHT` or below is light enough, since laws go on below their lowest load.

    Parameters
    ----------
    wide, job : Job
        The job that was made, and the one that is asked for.
    """
    light = min(wide.loads) <= max(min(job.loads), LIGHT) and max(job.loads) <= max(wide.loads)
    slow, fast = min(wide.entrainment_speeds), max(wide.entrainment_speeds)
    inside = slow <= min(job.entrainment_speeds) and max(job.entrainment_speeds) <= fast
    return light and inside and _asked(wide) == _asked(job)


def _asked(job: Job) -> tuple[object, ...]:
    """All that a map depends on, but for loads and speeds."""
    options = tuple(sorted(job.solver_options.items()))
    told = (job.temperatures, job.solver, options, job.fill, job.backbone, job.supply, job.surface, job.corrected_by)
    return (job.contacts, job.lubricant, *told)
