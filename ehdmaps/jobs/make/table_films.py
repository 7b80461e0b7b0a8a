"""Maps whose films are read from the film table: whether it serves a job, and the points of the map."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import BoolArray
from ehdmaps.errors import MapError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.sampling import COMPLIANCE_BARS, DAMPING_BARS, SamplePoint, draw_apart, drawable
from ehdmaps.maps.film_field import looked_at
from ehdmaps.maps.table_field import TableField
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolver, FilmSolution
from ehdmaps.table.fields import FILMS
from ehdmaps.table.file import film_table
from ehdmaps.table.films import TableFilms
from ehdmaps.table.solver import TableSolver

if TYPE_CHECKING:
    from ehdmaps.jobs.make.store import Arrays
    from ehdmaps.jobs.make.tasks import LineTask

STIFFNESS_BAR, SHARES = 5e-3, (0.9, 0.5)
"""What the table has to state for a job that it serves: errors of the stiffness of no more than this, or of 1 % of the
film compliance, and of the damping within the bar of contact laws, at these shares of the points over the map and in
the damping valley. These are bounds: true errors are a small part of them as a rule, and where the check of the laws
finds that they are not, lines are laid."""

_LOOKED_AT, _SEED = 500, 4
"""Random points at which the errors of the table are looked at, and where their numbers start."""


def unserved(job: Job, solver: ContactSolver) -> str:
    """Reason why points and laws of a job are not read from the film table; empty where they are.

    The table has to have films wherever a law looks, and the errors that it states have to be small enough at enough
    random points, see `STIFFNESS_BAR`.

    Parameters
    ----------
    job : Job
        The job.
    solver : ContactSolver
        What gives its films.
    """
    if not isinstance(solver, TableSolver):
        return "its films are to be solved"
    if job.backbone == "none" or job.corrected_by:
        return "film table: is read for whole laws that nothing corrects"
    speeds = [u for u in job.entrainment_speeds if u > 0.0]
    if not speeds or not drawable(job):
        return "film table: is read for maps of more than one point, with a speed"
    ranges = (
        (min(job.loads), max(job.loads)),
        (min(speeds), max(speeds)),
        (min(job.temperatures), max(job.temperatures)),
    )
    field = TableField(job.contacts, job.lubricant, *ranges)
    try:
        for contact in job.contacts:
            us, kelvins = looked_at(*ranges[1:])
            field.films(contact.name, np.full((1, us.size, kelvins.size), ranges[0][1]), us, kelvins)
    except MapError as error:
        return str(error)
    over, valley = draw_apart(job, np.random.default_rng(_SEED), _LOOKED_AT)
    regions = (over, "over the map"), (valley, "in the damping valley")
    for (points, where), wanted in zip(regions, SHARES, strict=True):
        share = float(np.mean(within_bars(job.lubricant, points))) if points else 1.0
        if share < wanted:
            return (
                f"film table: states errors within {STIFFNESS_BAR:.1%} of the stiffness and {DAMPING_BARS[0]:.0%} of "
                f"the damping at {share:.1%} of the points {where}; wanted {wanted:.0%}"
            )
    return ""


def within_bars(lubricant: Lubricant, points: list[SamplePoint]) -> BoolArray:
    """True where the errors that the table states are small enough, see `STIFFNESS_BAR`.

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    points : list of SamplePoint
        The points.
    """
    good, bars = np.empty(len(points), dtype=bool), (COMPLIANCE_BARS[0], STIFFNESS_BAR)
    for contact in {point.contact for point in points}:
        here = np.array([point.contact == contact for point in points])
        w, u, T = (
            np.array([getattr(point, name) for point in points if point.contact == contact])
            for name in ("load", "speed", "temperature")
        )
        read = film_table(lubricant).films(contact, lubricant, w, u, T, others=False, thickest_film=math.inf)
        with np.errstate(invalid="ignore"):
            k = 1.0 / (contact.structural_compliance(w) + read.film_compliance)
            unit = k * half_width(w, contact.radius, contact.reduced_modulus) / u
            c = np.maximum(read.loss_compliance, 0.0) * k**2
            wrong, wrong_loss = (
                read.errors[name] * np.abs(getattr(read, name)) for name in ("film_compliance", "loss_compliance")
            )
            wrong_c = wrong_loss * k**2 + 2.0 * c * k * wrong
            good[here] = (
                read.usable
                & (wrong <= np.maximum(bars[0] * np.abs(read.film_compliance), bars[1] / k))
                & (wrong_c <= np.maximum(DAMPING_BARS[0] * c, DAMPING_BARS[1] * unit))
            )
    return good


def table_films(job: Job, solver: TableSolver) -> dict[str, npt.NDArray[Any]]:
    """Films of all points of a map, read from the table, by the names of `FilmSolution`; of the shape of the map.

    Parameters
    ----------
    job : Job
        The job.
    solver : TableSolver
        Says which of them are refused, and whether heat in the inlet thins them.
    """
    axes = (np.array(axis, dtype=float) for axis in (job.loads, job.entrainment_speeds, job.temperatures))
    w, u, T = np.meshgrid(*axes, indexing="ij")
    table, thickest, heat = film_table(job.lubricant), solver.thickest_film, solver.inlet_heat
    read = [
        _film_arrays(table.films(contact, job.lubricant, w, u, T, thickest_film=thickest, inlet_heat=heat))
        for contact in job.contacts
    ]
    return {name: np.stack([one[name] for one in read]) for name in read[0]}


def read_points(tasks: Sequence[LineTask], solver: TableSolver) -> dict[str, Arrays]:
    """Films of tasks of one point and one oil, read from the table, by the keys of the tasks.

    Parameters
    ----------
    tasks : sequence of LineTask
        The points.
    solver : TableSolver
        Says which of them are refused, and whether heat in the inlet thins them.
    """
    found = {}
    for contact in dict.fromkeys(task.contact for task in tasks):
        chosen = [task for task in tasks if task.contact == contact]
        w, u, T = np.array([(task.loads[0], task.entrainment_speed, task.temperature) for task in chosen]).T
        oil, thickest = chosen[0].lubricant, solver.thickest_film
        read = film_table(oil).films(contact, oil, w, u, T, thickest_film=thickest, inlet_heat=solver.inlet_heat)
        arrays = _film_arrays(read)
        arrays["reason"] = arrays["reason"].astype(str)
        for n, task in enumerate(chosen):
            found[task.key] = {name: values[n : n + 1] for name, values in arrays.items()}
    return found


def _film_arrays(films: TableFilms) -> dict[str, npt.NDArray[Any]]:
    """Films by the names of `FilmSolution`, of one shape."""
    numbers = {field.name: getattr(films, field.name) for field in FILMS}
    errors = {f"{name}_error": films.errors[name] for name in numbers if name != "wall_stress"}
    arrays: dict[str, npt.NDArray[Any]] = {
        **numbers,
        **errors,
        "status": films.status,
        "reason": films.reason.astype(object),
        "viscosity_extrapolated": films.viscosity_extrapolated.astype(np.int8),
        "traction": np.where(films.usable, 0.0, np.nan),
    }
    for entry in fields(FilmSolution):
        if entry.name not in arrays:
            dtype = np.int32 if entry.name == "iterations" else np.float64
            arrays[entry.name] = np.full(films.status.shape, entry.default, dtype=dtype)
    return arrays
