"""The backbone of a map: which lines are solved for the contact law, and the netCDF group they become."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import SPECTRUM_FIELDS, LineTask, knows_heat, with_later_fields
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import ERROR, FILMS, IMAGINARY, REAL
from ehdmaps.maps.backbone_plan import BackbonePlan, Steps, plan_backbone, plan_own_lines
from ehdmaps.maps.records import reference_json
from ehdmaps.maps.rolling_film import NAMES as ROLLING
from ehdmaps.physics.solution import ContactSolver, Status
from ehdmaps.table.solver import TableSolver

MOST_LINE_POINTS = 40_000
"""Points of the lines that are not exceeded by halving a step: minutes on one core."""


@dataclass(frozen=True)
class Refinement:
    """Plans of a backbone, its steps, and its tasks, one a line and in the plans' order.

    There is one plan for all contacts, or one a contact where films know heat, see `ehdmaps.maps.grid_field`.
    """

    plans: tuple[BackbonePlan, ...]
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
    axes = job.lubricant, job.loads, job.entrainment_speeds, job.temperatures, steps
    if knows_heat(solver):
        plans = plan_own_lines(job.contacts, *axes)
    else:
        shared = plan_backbone(job.contacts, *axes)
        plans = (shared,) if shared is not None else ()
    if not plans:
        return None
    # these lines stand for their groups: how thick their own film is does not matter
    generous = of_groups(solver)
    tasks = tuple(
        LineTask(
            contact=plan.contact,
            lubricant=job.lubricant,
            loads=line.loads,
            entrainment_speed=line.speed,
            temperature=line.temperature,
            solver=generous,
            natural_frequencies=solver.natural_frequencies,
        )
        for plan in plans
        for line in plan.lines
    )
    return Refinement(plans, steps, tasks)


def of_groups(solver: ContactSolver) -> ContactSolver:
    """The solver for films whose own thickness does not matter.

    Parameters
    ----------
    solver : ContactSolver
        Any solver; `reynolds`, and the film table above it, then refuse no thick film.
    """
    if isinstance(solver, TableSolver):
        return replace(solver, other=of_groups(solver.other), thickest_film=math.inf)
    return replace(solver, thickest_film=math.inf) if isinstance(solver, ReynoldsSolver) else solver


def backbone_group(refined: Refinement, results: Mapping[str, Arrays]) -> xr.Dataset:
    """Put the lines in their places: the group "backbone" of the map file."""
    first = refined.plans[0]
    natural = refined.tasks[0].natural_frequencies if refined.tasks else ()
    values: dict[str, npt.NDArray[Any]] = {}
    start = 0
    for plan, prefix in zip(refined.plans, ("", schema.OWN), strict=False):
        tasks = refined.tasks[start : start + len(plan.lines)]
        start += len(plan.lines)
        values |= {f"{prefix}{name}": array for name, array in _films(plan, tasks, natural, results).items()}
    axes = {"zeta": first.zeta, "reference_speed": first.speeds, "temperature": first.temperatures}
    return schema.backbone(
        axes | ({schema.NATURAL: natural} if natural else {}),
        values,
        {
            "title": "films of a reference contact, from which the contact laws of the map are made",
            schema.REFERENCE_CONTACT: reference_json(first.contact),
        },
    )


def _films(
    plan: BackbonePlan, tasks: Sequence[LineTask], natural: tuple[float, ...], results: Mapping[str, Arrays]
) -> dict[str, npt.NDArray[Any]]:
    """Arrays of the films of one plan, by the names of the table."""
    shape = (len(plan.zeta), len(plan.speeds), len(plan.temperatures))
    values = {name: np.full(shape, np.nan) for name in (*FILMS, *ROLLING)}
    sources = {name: name for name in (*FILMS, *ROLLING)}
    if natural:
        sources |= dict(zip((REAL, IMAGINARY, ERROR), SPECTRUM_FIELDS, strict=True))
        values |= {name: np.full((*shape, len(natural)), np.nan) for name in (REAL, IMAGINARY, ERROR)}
    status = np.full(shape, schema.NOT_NEEDED, dtype=np.int8)
    for line, task in zip(plan.lines, tasks, strict=True):
        first, speed, temperature = line.place
        along = slice(first, first + task.points)
        arrays = with_later_fields(results[task.key])
        status[along, speed, temperature] = arrays["status"]
        usable = np.isin(arrays["status"], [int(known) for known in Status if known.usable])
        for name, array in values.items():
            found = arrays[sources[name]]
            array[along, speed, temperature] = np.where(usable if found.ndim == 1 else usable[:, None], found, np.nan)
    return {**values, "status": status}
