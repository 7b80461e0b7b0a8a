"""A map for a planned job: one that was made for the same job before, or a new one.

Maps are called after their job, ``gearbox_nu308_5e1f09a3c2d4.nc``: the scene, the bearing, the beginning of the job's
sha256. A file of that name is taken where it carries the very job; whatever else stands there is never written over.
A run that is stopped leaves its store beside the map, and the next one goes on from there.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs.batch_generate import make_folder
from ehdmaps.jobs.generate import generate
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.law_check import STANDS_ON_LINES, STANDS_ON_POINTS, STANDS_ON_TABLE, unmet
from ehdmaps.jobs.sweep import Progress
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.outputs import MAP, Output, check_outputs

DIGITS = 12
"""Digits of the job's hash in the name of its map."""

_UNSAFE = re.compile(r"[^a-z0-9_-]+")

TellMap = Callable[[int], Progress]
"""Takes the number of points that are to be solved, gives what is told."""


@dataclass(frozen=True, eq=False)
class KeptMap:
    """A map for a job.

    Attributes
    ----------
    path : Path
        File of the map.
    emap : EHDMap
        The map.
    solved : int
        Points that were solved for it now; 0 where it was there.
    reused : bool
        Whether it was there.
    unmet : tuple of str
        Which bars its contact laws miss, as `ehdmaps generate` says it.
    """

    path: Path
    emap: EHDMap
    solved: int
    reused: bool
    unmet: tuple[str, ...]


def map_name(scene: str, job: Job) -> str:
    """Name of the map of a job.

    Parameters
    ----------
    scene : str
        Name of the scene.
    job : Job
        The job.

    Examples
    --------
    >>> from mbs import plan, read_scene
    >>> job, = plan(read_scene("nu308_rigid")).jobs()
    >>> map_name("nu308_rigid", job).startswith("nu308_rigid_nu308_")
    True
    """
    bearing = job.bearing.name if job.bearing else job.title
    words = (_UNSAFE.sub("-", text.lower()).strip("-") or "map" for text in (Path(scene).stem, bearing))
    return "_".join((*words, job.sha256[:DIGITS])) + ".nc"


def kept_map(
    scene: str,
    job: Job,
    folder: Path,
    others: Sequence[Path] = (),
    workers: int | None = None,
    progress: TellMap | None = None,
) -> KeptMap:
    """The map of a job: one that is there, or a new one.

    Parameters
    ----------
    scene : str
        Name of the scene.
    job : Job
        What is wanted.
    folder : Path
        Folder of the map; each is made where it is not there yet.
    others : sequence of Path
        Further folders with maps.
    workers : int, optional
        Number of processes that make it; all cores if left out.
    progress : callable, optional
        Told about a map that is made.

    Raises
    ------
    InputError
        If the folder cannot be made, or a file of that name is no map of this job.
    EhdmapsError
        If the map cannot be read, made or written; what was solved is kept.
    """
    make_folder(folder, "--maps")
    name = map_name(scene, job)
    for place in dict.fromkeys((folder, *others)):
        if (place / name).exists() and (emap := _of_job(place / name, job)) is not None:
            return KeptMap(place / name, emap, 0, True, _unmet(emap))
    path = folder / name
    check_outputs([Output("--maps", path, MAP)])
    made = generate(dataclasses.replace(job, name=path.stem), path, workers, progress=progress)
    emap = open_map(path)
    return KeptMap(path, emap, made.sweep.solved, False, _unmet(emap))


def _of_job(path: Path, job: Job) -> EHDMap | None:
    """The map of a file, which is to be that of a job; None for one of an older schema, which is made again."""
    emap = open_map(path)
    attributes = emap.dataset.attrs
    if attributes.get("job_sha256") != job.sha256 or attributes.get("job_toml") != job.text:
        raise InputError(
            f"{path}: has the name of the map that is wanted, but was made for another job; move it away, or give "
            "another folder with --maps"
        )
    return emap if int(attributes["schema_version"]) == schema.SCHEMA_VERSION else None


def _unmet(emap: EHDMap) -> tuple[str, ...]:
    """Which bars the laws of a map miss; without the advice, as the job was planned."""
    found = unmet(emap.dataset, emap.backbone is not None)
    return tuple(line for line in found if line not in (STANDS_ON_LINES, STANDS_ON_POINTS, STANDS_ON_TABLE))
