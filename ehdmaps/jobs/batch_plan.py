"""What is solved for a batch: the families that share lines, and the maps on their own."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from ehdmaps.jobs import solvers
from ehdmaps.jobs.batch import SHARED, Batch, Member
from ehdmaps.jobs.family import FEWEST_MEMBERS, Family, family, family_key, shares
from ehdmaps.jobs.generate import planned_tasks
from ehdmaps.jobs.tasks import LineTask
from ehdmaps.maps.schema import SCHEMA_VERSION


@dataclass(frozen=True)
class Shared:
    """Members of a batch that share lines, in the order of the family's jobs."""

    members: tuple[Member, ...]
    family: Family

    def fingerprint(self, index: int) -> str:
        """Hash of all that shapes the map of a member, by which a map that is there is known to be it."""
        checked = str(self.family.check_of(index) is not None)
        return _hash(self.members[index].job.sha256, self.family.sha256, checked)


@dataclass(frozen=True)
class Alone:
    """A member of a batch that is solved at its own points."""

    member: Member

    @cached_property
    def tasks(self) -> tuple[LineTask, ...]:
        """All that is known to be solved for it."""
        return planned_tasks(self.member.job)

    @property
    def points(self) -> int:
        """Their points."""
        return sum(task.points for task in self.tasks)

    @property
    def fingerprint(self) -> str:
        """Hash of all that shapes its map."""
        return _hash(self.member.job.sha256, *(task.key for task in self.tasks))


@dataclass(frozen=True)
class BatchPlan:
    """Families, and maps on their own."""

    batch: Batch
    shared: tuple[Shared, ...]
    alone: tuple[Alone, ...]

    def tasks(self) -> Iterator[LineTask]:
        """Yield all that is known to be solved, families first; tasks of equal keys may come again."""
        for shared in self.shared:
            yield from shared.family.tasks
        for alone in self.alone:
            yield from alone.tasks


def plan_batch(batch: Batch) -> BatchPlan:
    """Lay out what is solved.

    Parameters
    ----------
    batch : Batch
        The batch.
    """
    groups: dict[str, list[Member]] = {}
    alone: list[Member] = []
    built = {}
    for member in batch.members:
        job = member.job
        solver = solvers.build(job.solver, job.solver_options)
        if batch.films == SHARED and shares(job, solver):
            key = family_key(job, solver)
            groups.setdefault(key, []).append(member)
            built[key] = solver
        else:
            alone.append(member)
    shared = []
    for key, members in groups.items():
        if len(members) < FEWEST_MEMBERS:
            alone += members
        else:
            jobs = [member.job for member in members]
            shared.append(Shared(tuple(members), family(jobs, built[key], batch.checked)))
    return BatchPlan(batch, tuple(shared), tuple(Alone(member) for member in alone))


def _hash(*parts: str) -> str:
    """Hash of texts and of the version of the map file."""
    return hashlib.sha256("\0".join((str(SCHEMA_VERSION), *parts)).encode()).hexdigest()
