"""What is made for a batch: maps with films from the film table, and maps that are solved one by one."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ehdmaps.jobs import solvers
from ehdmaps.jobs.batch import Batch, Member
from ehdmaps.jobs.generate import planned_tasks
from ehdmaps.jobs.job import Job, record_json
from ehdmaps.jobs.table_films import unserved
from ehdmaps.jobs.tasks import LineTask, solver_version
from ehdmaps.maps.schema import SCHEMA_VERSION
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.table.solver import TableSolver


@dataclass(frozen=True)
class Planned:
    """One map of a batch.

    Attributes
    ----------
    member : Member
        Which one.
    job : Job
        What is made: its laws are checked if it is one of those for which the batch wants that.
    """

    member: Member
    job: Job

    @cached_property
    def solver(self) -> ContactSolver:
        """What gives its films."""
        return solvers.of_map(self.job)

    @property
    def reads(self) -> bool:
        """Whether its films are to be read from the film table, where that serves."""
        return isinstance(self.solver, TableSolver)

    @cached_property
    def fingerprint(self) -> str:
        """Hash of all that shapes the map, by which a map that is there is known to be it."""
        solver = record_json([self.solver.name, self.solver.settings(), solver_version(self.solver)])
        parts = str(SCHEMA_VERSION), self.job.sha256, solver, str(self.job.law_check)
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()

    @property
    def tasks(self) -> tuple[LineTask, ...]:
        """All that is known to be solved for it; nothing of a map that is read, which is made in less than a second."""
        return planned_tasks(self.job) if unserved(self.job, self.solver) else ()


def plan_batch(batch: Batch) -> tuple[Planned, ...]:
    """Lay out the maps of a batch, in its order.

    Parameters
    ----------
    batch : Batch
        The batch.
    """
    maps = [Planned(member, member.job) for member in batch.members]
    groups: dict[tuple[str, str], list[int]] = {}
    for index, planned in enumerate(maps):
        if planned.reads:
            groups.setdefault((planned.member.oil, planned.member.override), []).append(index)
    for indices in groups.values():
        # from the smallest radius to the largest
        ordered = sorted(indices, key=lambda index: (maps[index].job.contacts[0].radius, index))
        count = min(batch.checked, len(ordered))
        places = np.unique(np.linspace(0, len(ordered) - 1, count).round().astype(int)) if count else ()
        for index in set(indices) - {ordered[place] for place in places}:
            maps[index] = Planned(maps[index].member, replace(maps[index].job, law_check=0))
    return tuple(maps)
