"""The backbone of a map: which lines are solved for the contact law, and the netCDF group they become."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ehdmaps.jobs.job import Job, record_json
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import LineTask
from ehdmaps.maps.backbone_plan import BackbonePlan, plan_backbone
from ehdmaps.physics.solution import ContactSolver, Status

_VARIABLES = (
    ("film_offset", "m", "dry minus lubricated approach at equal load, reference contact"),
    ("film_compliance", "m2 N-1", "minus the derivative of the film offset by load, reference contact"),
    ("loss_compliance", "m2 s N-1", "damping over squared stiffness, low-frequency limit, reference contact"),
)


@dataclass(frozen=True)
class Refinement:
    """Plan of a backbone and its tasks, one a line and in the plan's order."""

    plan: BackbonePlan
    tasks: tuple[LineTask, ...]

    @property
    def points(self) -> int:
        """Number of points to solve."""
        return sum(task.points for task in self.tasks)


def refinement(job: Job, solver: ContactSolver) -> Refinement | None:
    """Plan the backbone of a job; None where the solver does not ask for one or the job declines it."""
    if not getattr(solver, "wants_backbone", False) or job.backbone == "none":
        return None
    plan = plan_backbone(job.contacts, job.lubricant, job.loads, job.entrainment_speeds, job.temperatures)
    if plan is None:
        return None
    tasks = tuple(
        LineTask(
            contact=plan.contact,
            lubricant=job.lubricant,
            loads=line.loads,
            entrainment_speed=line.speed,
            temperature=line.temperature,
            solver=solver,
        )
        for line in plan.lines
    )
    return Refinement(plan, tasks)


def backbone_group(refined: Refinement, results: Mapping[str, Arrays]) -> xr.Dataset:
    """Put the lines in their places: the group "backbone" of the map file."""
    plan = refined.plan
    shape = (len(plan.zeta), len(plan.speeds), len(plan.temperatures))
    dims = ("zeta", "reference_speed", "temperature")
    values = {name: np.full(shape, np.nan) for name, _, _ in _VARIABLES}
    status = np.full(shape, -1, dtype=np.int8)
    for line, task in zip(plan.lines, refined.tasks, strict=True):
        first, speed, temperature = line.place
        along = slice(first, first + task.points)
        arrays = results[task.key]
        status[along, speed, temperature] = arrays["status"]
        usable = np.isin(arrays["status"], [int(known) for known in Status if known.usable])
        for name, array in values.items():
            array[along, speed, temperature] = np.where(usable, arrays[name], np.nan)
    group = xr.Dataset(
        {name: (dims, values[name], {"units": units, "long_name": long_name}) for name, units, long_name in _VARIABLES},
        coords={
            "zeta": (dims[:1], np.array(plan.zeta), {"units": "1", "long_name": "ln(M/M_valley(L))"}),
            "reference_speed": (
                dims[1:2],
                np.array(plan.speeds),
                {"units": "m s-1", "long_name": "entrainment speed of the reference contact"},
            ),
            "temperature": (dims[2:], np.array(plan.temperatures), {"units": "K", "long_name": "oil temperature"}),
        },
        attrs={
            "title": "films of a reference contact, from which the contact laws of the map are made",
            "reference_contact": record_json(plan.contact),
        },
    )
    group["status"] = (
        dims,
        status,
        {
            "units": "1",
            "long_name": "how the point ended; -1: no contact of the map comes here",
            "flag_values": np.array([-1, *(int(known) for known in Status)], dtype=np.int8),
            "flag_meanings": " ".join(["not_needed", *(known.word for known in Status)]),
        },
    )
    for variable in group.data_vars.values():
        variable.encoding = {"zlib": True, "complevel": 4, "shuffle": True}
    return group
