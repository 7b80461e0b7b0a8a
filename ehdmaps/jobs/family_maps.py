"""Maps of the members of a family: read from its lines, checked, written; a worker process may do each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import BoolArray
from ehdmaps.jobs.assemble import assemble, placed
from ehdmaps.jobs.family import Family, own_part
from ehdmaps.jobs.family_films import FamilyFilms
from ehdmaps.jobs.job import record_json
from ehdmaps.jobs.law_check import REFUSED, LawCheck, checked_laws, coarse_axis, met
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import LineTask, line_tasks
from ehdmaps.jobs.write import write_map
from ehdmaps.maps import schema
from ehdmaps.maps.backbone_plan import Axis
from ehdmaps.maps.checksum import content_sha256
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.validation import validate


@dataclass(frozen=True)
class Solved:
    """A family with the arrays of its lines by key, and what the checks of its laws found, for worker processes."""

    family: Family
    results: Mapping[str, Arrays]
    checked: Mapping[str, Mapping[str, Any]]

    @property
    def films(self) -> FamilyFilms:
        """Its films; made once a process."""
        if _kept.get("sha256") != self.family.sha256:
            _kept.clear()
            _kept.update(sha256=self.family.sha256, films=FamilyFilms(self.family, self.results))
        films: FamilyFilms = _kept["films"]
        return films


_kept: dict[str, Any] = {}
"""The films of the family that this process was busy with last."""


def read_map(solved: Solved, member: int) -> tuple[xr.Dataset, xr.Dataset]:
    """Points and lines of a member, before its laws are checked.

    Points that cannot be read are solved here.

    Parameters
    ----------
    solved : Solved
        The family.
    member : int
        Which of its jobs.

    Raises
    ------
    MapError
        If the lines have too few solved points to be read, or the map would be none.
    """
    films, job, solver = solved.films, solved.family.jobs[member], solved.family.solver
    tasks = line_tasks(job, solver)
    dataset = assemble(job, solver, placed(job, tasks, {task.key: _with_solved(task, *films.read(task)) for task in tasks}))
    group = own_part(films.group, films.reference, job)
    validate(dataset, job.name)
    return dataset, group


def _with_solved(task: LineTask, arrays: Arrays, known: BoolArray) -> Arrays:
    """Films of a line with those solved that were not read."""
    if known.all():
        return arrays
    found = {name: list(array) for name, array in arrays.items()}
    at = task.entrainment_speed, task.temperature
    for i in np.flatnonzero(~known):
        own = LineTask(task.contact, task.lubricant, (task.loads[i],), *at, task.solver)
        for name, value in own.run().items():
            found[name][i] = value[0]
    types = {name: np.str_ if array.dtype.kind == "U" else array.dtype for name, array in arrays.items()}
    return {name: np.array(values, types[name]) for name, values in found.items()}


@dataclass(frozen=True)
class Checked:
    """What the check of a member's laws found, as attributes of its map; the axis along which lines are too coarse."""

    attributes: Mapping[str, Any]
    coarse: Axis | None


def check_member(solved: Solved, member: int, check: LawCheck) -> Checked:
    """Hold the laws of a member against fresh solves.

    Parameters
    ----------
    solved : Solved
        The family; its results hold those of the check too.
    member : int
        Which of its jobs.
    check : LawCheck
        The points.
    """
    dataset, group = read_map(solved, member)
    emap = EHDMap(dataset, group)
    attributes = checked_laws(check, emap, solved.results)
    good = met(attributes) or REFUSED in attributes
    return Checked(attributes, None if good else coarse_axis(check, emap, solved.results))


def make_map(solved: Solved, member: int, output: Path, attributes: Mapping[str, Any]) -> xr.Dataset:
    """Write the map of a member.

    Parameters
    ----------
    solved : Solved
        The family, with what the checks found.
    member : int
        Which of its jobs.
    output : Path
        File of the map.
    attributes : mapping
        Attributes of the map besides.

    Returns
    -------
    xarray.Dataset
        The map.

    Raises
    ------
    MapError
        If there is none, or it cannot be written.
    """
    dataset, group = read_map(solved, member)
    name = solved.family.jobs[member].name
    dataset.attrs.update(solved.checked.get(name, {}))
    dataset.attrs[schema.FAMILY] = record_json({**solved.family.record(), "checked": _shares(solved.checked)})
    dataset.attrs.update(attributes)
    dataset.attrs[schema.CHECKSUM] = content_sha256(dataset, group)
    write_map(dataset, output, {schema.BACKBONE: group})
    return dataset


def _shares(checked: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """Of each checked member the shares of points within their bars, or why it has no laws."""
    return {
        name: {key: value for key, value in found.items() if key.endswith("_within_bar") or key == REFUSED}
        for name, found in checked.items()
    }
