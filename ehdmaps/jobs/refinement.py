"""The backbone of a map: which lines are solved for the contact law, and the netCDF group they become."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs.job import Job, record_json
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import SPECTRUM_FIELDS, LineTask, with_later_fields
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import ERROR, FILMS, IMAGINARY, REAL, BackboneField
from ehdmaps.maps.backbone_plan import BackbonePlan, Steps, plan_backbone
from ehdmaps.maps.records import contact_record, contacts_from_json
from ehdmaps.maps.rolling_film import NAMES as ROLLING
from ehdmaps.maps.usable import check_backbone
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.solution import ContactSolver, Status

MOST_LINE_POINTS = 40_000
"""Points of the lines that are not exceeded by halving a step: minutes on one core."""


@dataclass(frozen=True)
class Refinement:
    """Plan of a backbone, the steps that it was made with, and its tasks, one a line and in the plan's order."""

    plan: BackbonePlan
    steps: Steps
    tasks: tuple[LineTask, ...]

    @property
    def points(self) -> int:
        """Number of points to solve."""
        return sum(task.points for task in self.tasks)


def refinement(job: Job, solver: ContactSolver, steps: Steps | None = None) -> Refinement | None:
    """Plan the backbone of a job; None where the solver does not ask for one or the job declines it.

    Parameters
    ----------
    job : Job
        What to make.
    solver : ContactSolver
        What solves it.
    steps : Steps, optional
        Largest steps of the backbone; those of the job if left out.
    """
    steps = steps or job.line_steps
    if not solver.wants_backbone or job.backbone == "none":
        return None
    plan = plan_backbone(job.contacts, job.lubricant, job.loads, job.entrainment_speeds, job.temperatures, steps)
    if plan is None:
        return None
    # these lines stand for their groups: how thick their own film is does not matter
    of_groups = replace(solver, thickest_film=math.inf) if isinstance(solver, ReynoldsSolver) else solver
    tasks = tuple(
        LineTask(
            contact=plan.contact,
            lubricant=job.lubricant,
            loads=line.loads,
            entrainment_speed=line.speed,
            temperature=line.temperature,
            solver=of_groups,
            natural_frequencies=solver.natural_frequencies,
        )
        for line in plan.lines
    )
    return Refinement(plan, steps, tasks)


def backbone_group(refined: Refinement, results: Mapping[str, Arrays]) -> xr.Dataset:
    """Put the lines in their places: the group "backbone" of the map file."""
    plan = refined.plan
    shape = (len(plan.zeta), len(plan.speeds), len(plan.temperatures))
    values = {name: np.full(shape, np.nan) for name in (*FILMS, *ROLLING)}
    natural = refined.tasks[0].natural_frequencies if refined.tasks else ()
    sources = {name: name for name in (*FILMS, *ROLLING)}
    if natural:
        sources |= dict(zip((REAL, IMAGINARY, ERROR), SPECTRUM_FIELDS, strict=True))
        values |= {name: np.full((*shape, len(natural)), np.nan) for name in (REAL, IMAGINARY, ERROR)}
    status = np.full(shape, schema.NOT_NEEDED, dtype=np.int8)
    for line, task in zip(plan.lines, refined.tasks, strict=True):
        first, speed, temperature = line.place
        along = slice(first, first + task.points)
        arrays = with_later_fields(results[task.key])
        status[along, speed, temperature] = arrays["status"]
        usable = np.isin(arrays["status"], [int(known) for known in Status if known.usable])
        for name, array in values.items():
            found = arrays[sources[name]]
            array[along, speed, temperature] = np.where(usable if found.ndim == 1 else usable[:, None], found, np.nan)
    axes = {"zeta": plan.zeta, "reference_speed": plan.speeds, "temperature": plan.temperatures}
    return schema.backbone(
        axes | ({schema.NATURAL: natural} if natural else {}),
        {**values, "status": status},
        {
            "title": "films of a reference contact, from which the contact laws of the map are made",
            schema.REFERENCE_CONTACT: record_json(contact_record(plan.contact)),
        },
    )


def line_field(job: Job, group: xr.Dataset, contact: LineContact) -> BackboneField:
    """Films of one contact between the lines: what its law is made from, without the points of the map.

    Parameters
    ----------
    job : Job
        The job whose axes the lines cover.
    group : xarray.Dataset
        The group "backbone".
    contact : LineContact
        A contact of the job.

    Raises
    ------
    MapError
        If the lines have holes that cannot be bridged.
    """
    (reference,) = contacts_from_json(f"[{group.attrs[schema.REFERENCE_CONTACT]}]")
    speeds = [u for u in job.entrainment_speeds if u > 0.0]
    load_range, speed_range = (min(job.loads), max(job.loads)), (min(speeds), max(speeds))
    check_backbone(group, reference, (contact,), job.lubricant, load_range, speed_range)
    temperature_range = min(job.temperatures), max(job.temperatures)
    return BackboneField(group, reference, (contact,), job.lubricant, load_range, speed_range, temperature_range)
