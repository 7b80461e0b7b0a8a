"""Jobs that share their refinement lines: one oil, one material, one solver, any bearing.

At one temperature an isothermal film depends on Moes' M and L alone, whatever the radius of the contact: see
`ehdmaps.maps.backbone`. The lines that one map is refined by therefore serve all bearings with that oil, laid over the
range of all their contacts; the points of the maps are read from them too, see `ehdmaps.jobs.family_films`.

What breaks the similarity has lines of its own: films with heat, which have a group more, and corrected films. Sheared
and sliding films would keep it, but what they state besides (traction, wall stress) is solved and not read, so that
these maps are made one by one as well.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs.job import Job, record_json
from ehdmaps.jobs.law_check import LawCheck, plan_check
from ehdmaps.jobs.refinement import Refinement, refinement
from ehdmaps.jobs.tasks import LineTask, solver_version
from ehdmaps.maps.backbone_plan import NEIGHBOURS, Steps
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.heat import ISOTHERMAL
from ehdmaps.physics.rheology import NEWTONIAN
from ehdmaps.physics.solution import ContactSolver

FEWEST_MEMBERS = 2
"""Maps that lines are shared by: one on its own is solved at its points."""

_MARGIN = NEIGHBOURS // 2
"""Lines beyond the range of a map that its interpolation reads."""

_ROUND_OFF = 1e-9


def shares(job: Job, solver: ContactSolver) -> bool:
    """Whether the films of a job are functions of M and L alone at a temperature, and all that it states is read.

    Parameters
    ----------
    job : Job
        The job.
    solver : ContactSolver
        What solves it.
    """
    return (
        isinstance(solver, ReynoldsSolver)
        and solver.physics == ISOTHERMAL
        and solver.shear_law.form == NEWTONIAN
        and solver.slide_to_roll == 0.0
        and job.backbone == "law"
        and job.corrected_by is None
        and max(job.entrainment_speeds) > 0.0
    )


def family_key(job: Job, solver: ContactSolver) -> str:
    """What jobs must have in common to share lines: oil, material, temperatures, steps, solver with its settings.

    Parameters
    ----------
    job : Job
        The job.
    solver : ContactSolver
        What solves it.
    """
    material = job.contacts[0].material
    return record_json(
        {
            "lubricant": {key: value for key, value in job.lubricant.record().items() if key != "label"},
            "youngs_modulus": material.youngs_modulus,
            "poisson_ratio": material.poisson_ratio,
            "temperatures": (min(job.temperatures), max(job.temperatures)),
            "steps": list(job.line_steps.__dict__.values()),
            "solver": solver.name,
            "settings": solver.settings(),
            "version": solver_version(solver),
        }
    )


@dataclass(frozen=True)
class Family:
    """Jobs that share lines, these lines, and the checks of some of the jobs.

    Attributes
    ----------
    jobs : tuple of Job
        The members.
    solver : ContactSolver
        What solves the lines.
    lines : Refinement
        Lines that cover all members.
    checks : tuple of (int, LawCheck)
        Indices of the members whose laws are held against fresh solves, with their points.
    """

    jobs: tuple[Job, ...]
    solver: ContactSolver
    lines: Refinement
    checks: tuple[tuple[int, LawCheck], ...]

    @property
    def tasks(self) -> tuple[LineTask, ...]:
        """All that is solved."""
        return (*self.lines.tasks, *(task for _, check in self.checks for task in check.tasks))

    @property
    def points(self) -> int:
        """Number of points that are solved."""
        return sum(task.points for task in self.tasks)

    @cached_property
    def sha256(self) -> str:
        """Hash of all that the lines are."""
        return hashlib.sha256("".join(task.key for task in self.lines.tasks).encode()).hexdigest()

    def check_of(self, member: int) -> LawCheck | None:
        """The check of a member; None where it has none."""
        return dict(self.checks).get(member)

    def with_steps(self, steps: Steps) -> Family:
        """The same members on lines of other steps."""
        return replace(self, lines=_lines(self.jobs, self.solver, steps))

    def record(self) -> dict[str, int | str]:
        """What a map says of the lines that it was read from."""
        return {"members": len(self.jobs), "line_points": self.lines.points, "lines_sha256": self.sha256}


def family(jobs: Sequence[Job], solver: ContactSolver, checked: int) -> Family:
    """Lay the lines of jobs that have their key in common.

    Parameters
    ----------
    jobs : sequence of Job
        The members.
    solver : ContactSolver
        What solves the lines.
    checked : int
        Number of members, from the smallest radius to the largest, whose laws are checked as their jobs say.
    """
    by_radius = sorted(range(len(jobs)), key=lambda index: (jobs[index].contacts[0].radius, index))
    places = np.unique(np.linspace(0, len(jobs) - 1, min(checked, len(jobs))).round().astype(int)) if checked else ()
    found = ((by_radius[place], plan_check(jobs[by_radius[place]], solver)) for place in places)
    checks = tuple((index, check) for index, check in found if check is not None)
    return Family(tuple(jobs), solver, _lines(jobs, solver, jobs[0].line_steps), checks)


def _lines(jobs: Sequence[Job], solver: ContactSolver, steps: Steps) -> Refinement:
    """Lines over the range of all contacts, loads and speeds."""
    contacts = [contact for job in jobs for contact in job.contacts]
    # the ends of every range belong to the smallest and to the largest radius: M of a load goes like 1/R at equal u/R
    ends = [min(contacts, key=_radius), max(contacts, key=_radius)]
    speeds = [speed for job in jobs for speed in job.entrainment_speeds if speed > 0.0]
    loads = [load for job in jobs for load in job.loads]
    over = replace(
        jobs[0],
        contacts=tuple(ends),
        loads=(min(loads), max(loads)),
        entrainment_speeds=(min(speeds), max(speeds)),
        line_steps=steps,
    )
    lines = refinement(over, solver, steps)
    assert lines is not None  # `shares`
    return lines


def _radius(contact: LineContact) -> float:
    """Reduced radius."""
    return contact.radius


def own_part(group: xr.Dataset, reference: LineContact, job: Job) -> xr.Dataset:
    """The part of a family's lines that the contacts of one job are read from, with the neighbours that are read too.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of the whole family.
    reference : LineContact
        Reference contact of the group.
    job : Job
        The member.
    """
    speeds = [u for u in job.entrainment_speeds if u > 0.0]
    ratios = [reference.radius / contact.radius for contact in job.contacts]
    low, high = min(speeds) * min(ratios) * (1.0 - _ROUND_OFF), max(speeds) * max(ratios) * (1.0 + _ROUND_OFF)
    axis = group["reference_speed"].values
    first = max(int(np.searchsorted(axis, low)) - _MARGIN, 0)
    last = min(int(np.searchsorted(axis, high)) + _MARGIN, axis.size)
    return group.isel(reference_speed=slice(first, last))
