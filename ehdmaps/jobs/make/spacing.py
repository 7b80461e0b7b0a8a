"""Errors of contact laws between the points of a map, where these points are all that they are made from.

A damping valley that lies between two loads is in no law of these loads, however well the points are solved. A law is
read between its points, so that only films that are known there can tell: those of a reference, which is the solver of
the map where that is fast, and `reynolds` with the same heat, oil and sliding beside CFD. It solves the points of the
map, of which the same law is made, and others between them. What the law misses there is the error, with no difference
between two solvers in it.

Each cell of the axes is looked at where its load is a quarter and three quarters of the way (in the logarithm), in the
middle of its speeds (likewise) and temperatures: in the middle of the loads the errors of a cubic line are often nil. A
point of the map has the largest error of the cells around it, and what is read between points is linear. Random points
then tell at what share of them that is enough.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import xarray as xr
from scipy.interpolate import RegularGridInterpolator

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.assemble import only_usable, placed
from ehdmaps.jobs.make.sampling import draw_sample, drawable
from ehdmaps.jobs.make.store import Arrays
from ehdmaps.jobs.make.tasks import LONGEST_LINE, LineTask, line_tasks
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import FILMS
from ehdmaps.maps.grid_field import GridField
from ehdmaps.maps.records import SPACING_ERRORS
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.solution import ContactSolver, usable_points

SHARES = (0.25, 0.75)
"""Of the way from one load to the next, where a cell is looked at."""

RANDOM, RAISING, SEED = 100, 80, 20262
"""Random points, and how many of them raise the estimate; the others tell how often it is enough."""

WANTED, SURE = 0.95, 0.9
"""Share of all points at which the estimate is enough then, and how sure that is of any one map: a quantile of the
points that raise it would fall short of that share in every second map."""


@dataclass(frozen=True)
class SpacingPlan:
    """Points by which the error is estimated.

    Attributes
    ----------
    name : str
        Name of the reference.
    nodes, between, random : tuple of LineTask
        Points of the map, those in its cells with the indices of their contact, speed and temperature as `place`, and
        random points.
    """

    name: str
    nodes: tuple[LineTask, ...]
    between: tuple[LineTask, ...]
    random: tuple[LineTask, ...]

    def besides(self, tasks: Sequence[LineTask]) -> tuple[LineTask, ...]:
        """All tasks but those of the map itself, where the reference is its solver.

        Parameters
        ----------
        tasks : sequence of LineTask
            Those of the map.
        """
        own = {task.key for task in tasks}
        return tuple(task for task in (*self.nodes, *self.between, *self.random) if task.key not in own)


def plan_spacing(job: Job, solver: ContactSolver) -> SpacingPlan | None:
    """Lay out the points; None where there is nothing between the points of a map, or no reference for its films.

    Parameters
    ----------
    job : Job
        What to make, whose laws are made from its points.
    solver : ContactSolver
        What solves it.
    """
    reference = solvers.reference(job, solver)
    if reference is None or not drawable(job) or len(job.loads) < 2:
        return None
    loads = np.log(np.array(job.loads))
    within = tuple(np.exp(loads[:-1, None] + np.outer(np.diff(loads), SHARES)).ravel().tolist())
    speeds = _middles(np.log([u for u in job.entrainment_speeds if u > 0.0]))
    temperatures = _middles(np.array(job.temperatures))
    between = tuple(
        LineTask(
            contact=contact,
            lubricant=job.lubricant,
            loads=within[start : start + LONGEST_LINE],
            entrainment_speed=float(np.exp(u)),
            temperature=float(T),
            solver=reference,
            place=(i, start, j, k),
        )
        for (i, contact), (j, u), (k, T) in product(enumerate(job.contacts), enumerate(speeds), enumerate(temperatures))
        for start in range(0, len(within), LONGEST_LINE)
    )
    random = tuple(
        LineTask(contact, job.lubricant, (w,), u, T, reference)
        for contact, w, u, T in draw_sample(job, RANDOM, np.random.default_rng(SEED))
    )
    return SpacingPlan(reference.name, line_tasks(job, reference), between, random)


def with_spacing(dataset: xr.Dataset, job: Job, plan: SpacingPlan, results: Mapping[str, Arrays]) -> xr.Dataset:
    """The map with the errors of its laws between its points; without where the reference solves too little.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map, as `assemble` makes it.
    job : Job
        What was asked for.
    plan : SpacingPlan
        The points.
    results : mapping
        Arrays by key of the tasks.
    """
    moving = np.array(job.entrainment_speeds) > 0.0
    films = only_usable(placed(job, plan.nodes, results))
    known = np.isfinite(films["film_offset"])[:, :, moving]
    nodes = [_bridged(films[name][:, :, moving]) for name in FILMS]
    if not all(np.all(np.isfinite(values)) for values in nodes):
        return dataset
    axes = np.array(job.loads), np.array(job.entrainment_speeds)[moving], np.array(job.temperatures)
    field = GridField(job.contacts, job.lubricant, *axes, *nodes)
    cells = np.full((len(SPACING_ERRORS), len(job.contacts), *(max(axis.size - 1, 1) for axis in axes)), np.nan)
    for i, contact in enumerate(job.contacts):
        for j, k in np.ndindex(*cells.shape[3:]):
            tasks = [task for task in plan.between if (task.place[0], *task.place[2:]) == (i, j, k)]
            found = np.concatenate([_missed(field, contact, task, results[task.key]) for task in tasks], axis=1)
            cells[:, i, :, j, k] = found.reshape(len(found), -1, len(SHARES)).max(axis=2)
    cells[:, ~_all_around(known)] = np.nan
    if not np.any(np.isfinite(cells)):
        return dataset
    errors = np.full((len(SPACING_ERRORS), *job.shape), np.nan)
    around = _around(cells, known.shape)
    ratios = _at_random(plan, field, around, axes, results)
    raised, told = ratios[: len(ratios) * RAISING // RANDOM], ratios[len(ratios) * RAISING // RANDOM :]
    factors = np.maximum(bound_of_most(raised), 1.0) if len(raised) else np.ones(len(SPACING_ERRORS))
    errors[:, :, :, moving] = factors[:, None, None, None, None] * around
    variables = {
        name: schema.typed(schema.variable(name), values) for name, values in zip(SPACING_ERRORS, errors, strict=True)
    }
    shares = np.mean(told <= factors, axis=0).tolist() if len(told) else []
    within = dict(zip((f"{name}_within" for name in SPACING_ERRORS), shares, strict=False))
    return dataset.assign(variables).assign_attrs({"spacing_solver": plan.name, "spacing_points": len(told), **within})


def bound_of_most(values: FloatArray) -> FloatArray:
    """Bound that as good as surely most values keep, whatever their distribution, from some drawn at random.

    The share of all values below the r-th largest of n has a known distribution: it exceeds `WANTED` as often as n
    values have r or more above their quantile (S. S. Wilks, Ann. Math. Stat. 12 (1941) 91-96). Too few values give the
    largest.

    Parameters
    ----------
    values : ndarray, shape (n, k)
        Values of k kinds.

    Returns
    -------
    ndarray, shape (k,)
        Bound of each kind.
    """
    n, above, rank = len(values), 1.0 - WANTED, 0
    fewer = 0.0  # how likely so few are above
    while fewer <= 1.0 - SURE:
        fewer += math.comb(n, rank) * above**rank * WANTED ** (n - rank)
        rank += 1
    return np.asarray(np.sort(values, axis=0)[-max(rank - 1, 1)])


def _middles(axis: FloatArray) -> FloatArray:
    """Middles between the values of an axis; its value where it has one only."""
    return axis if axis.size == 1 else 0.5 * (axis[1:] + axis[:-1])


def _bridged(values: FloatArray) -> FloatArray:
    """Films (contacts, n_w, n_u, n_T) with those of unsolved points from solved ones beside them, along one axis.

    They only complete lines that are read as a whole: no error is stated beside them.
    """

    def along(line: FloatArray) -> FloatArray:
        good, places = np.isfinite(line), np.arange(line.size)
        return np.interp(places, places[good], line[good]) if good.any() else line

    for axis in (1, 2, 3):
        values = np.apply_along_axis(along, axis, values)
    return np.asarray(values)


def _missed(field: GridField, contact: LineContact, task: LineTask, arrays: Arrays) -> FloatArray:
    """Errors of film offset, k and c over what is read between the points, shape (3, n); NaN where unknown.

    As a law has it, damping below zero is none.
    """
    loads = np.array(task.loads)
    u, T = np.array([task.entrainment_speed]), np.array([task.temperature])
    read = [values[:, 0, 0] for values in field.films(contact.name, loads[:, None, None], u, T)]
    true = [np.where(usable_points(arrays["status"]), arrays[name], np.nan) for name in FILMS]
    dry = contact.structural_compliance(loads)
    stiffer = (dry + read[1]) / (dry + true[1])
    ratios = true[0] / read[0], stiffer, np.maximum(true[2], 0.0) / read[2] * stiffer**2
    return np.abs(np.array(ratios) - 1.0)


def _all_around(known: BoolArray) -> BoolArray:
    """Tell around which cells all points are known."""
    for axis in (1, 2, 3):
        if known.shape[axis] > 1:
            moved = np.moveaxis(known, axis, 0)
            known = np.moveaxis(moved[1:] & moved[:-1], 0, axis)
    return known


def _around(cells: FloatArray, shape: Sequence[int]) -> FloatArray:
    """Largest of the cells around each point; NaN where none of them is known."""
    errors = np.full((len(cells), *shape), np.nan)
    sides = [range(2 if size > 1 else 1) for size in shape[1:]]
    for shift in product(*sides):
        along = (slice(s, s + size) for s, size in zip(shift, cells.shape[2:], strict=True))
        here = errors[(slice(None), slice(None), *along)]
        np.fmax(here, cells, out=here)
    return errors


def _at_random(
    plan: SpacingPlan,
    field: GridField,
    errors: FloatArray,
    axes: tuple[FloatArray, FloatArray, FloatArray],
    results: Mapping[str, Arrays],
) -> FloatArray:
    """Errors of the law of the reference at random points, over those that are read there, shape (n, 3)."""
    several = [axis.size > 1 for axis in axes]
    names = [contact.name for contact in field.line_contacts]
    scaled = [np.log(axes[0]), np.log(axes[1]), axes[2]]
    found = []
    for task in plan.random:
        missed = _missed(field, task.contact, task, results[task.key])[:, 0]
        at = [np.log(task.loads[0]), np.log(task.entrainment_speed), task.temperature]
        values = errors[:, names.index(task.contact.name)]
        values = values[(slice(None), *(slice(None) if more else 0 for more in several))]
        nodes = [axis for axis, more in zip(scaled, several, strict=True) if more]
        place = [value for value, more in zip(at, several, strict=True) if more]
        ratios = missed / RegularGridInterpolator(nodes, np.moveaxis(values, 0, -1))(place)[0]
        if np.all(np.isfinite(ratios)):
            found.append(ratios)
    return np.array(found).reshape(-1, len(SPACING_ERRORS))
