"""The contact laws of a map against fresh solves at random points: how good the law is between its nodes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import MapError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import LineTask
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.moes import moes_groups, valley_load_number
from ehdmaps.physics.operating_point import OperatingPoint
from ehdmaps.physics.roughness import SMOOTH
from ehdmaps.physics.solution import ContactSolution, ContactSolver, FilmSolution, Status, contact_solution

SEED = 20260

VALLEY_SHARE = 0.2
"""Share of the points that are drawn inside the damping valley."""

VALLEY_WIDTH = (-0.6, 0.8)
"""Range of ln(M/M_valley) from which they are drawn."""

COMPLIANCE_BARS, DAMPING_BARS = (0.01, 1e-4), (0.05, 1e-3)
"""An error is within its bar where it is below a share of the film compliance or of 1/k; of c or of k b/u."""

SHARES = {"law_": 0.99, "law_valley_": 0.95}
"""Share of the points that should be within the bars, over the whole map and in the valley."""

MOST_TRIES = 10
"""Draws per point in the valley: a map may hold a part of it, or none."""

STANDS_ON_LINES = (
    "these laws are made from refinement lines whose steps are fixed: other axes of [grid] do not bring them closer to "
    "their bars; the quantiles of their errors stand above; `ehdmaps solve` gives a single point without a law"
)
STANDS_ON_POINTS = "these laws are made from the points of the map: more temperatures, speeds or loads help"
"""What can be done where a bar is unmet: the steps of a backbone are constants of `ehdmaps.maps.backbone_plan`."""

NOTHING = {"film_compliance": "none: no film to relate to", "damping": "none: no damping above zero to relate to"}
"""What stands in place of quantiles where no point has one."""

QUANTILES = (0.5, 0.95, 0.99, 1.0)


@dataclass(frozen=True)
class LawCheck:
    """Random points of a map: the first `general` over its whole range, the others in the valley."""

    contacts: tuple[LineContact, ...]
    tasks: tuple[LineTask, ...]
    general: int


def plan_check(job: Job, solver: ContactSolver) -> LawCheck | None:
    """Draw the points: load and speed log-uniform, temperature uniform, contact at random; None if `law_check` is 0."""
    count = job.law_check
    speeds = [u for u in job.entrainment_speeds if u > 0.0]
    if not count or not speeds or len(speeds) * len(job.loads) * len(job.temperatures) < 2:
        return None
    rng = np.random.default_rng(SEED)
    valley = round(VALLEY_SHARE * count)
    general = [_draw(job, rng) for _ in range(count - valley)]
    inside = [drawn for _ in range(MOST_TRIES * valley) if (drawn := _draw_in_valley(job, rng)) is not None][:valley]
    tasks = tuple(LineTask(contact, job.lubricant, (w,), u, T, solver) for contact, w, u, T in (*general, *inside))
    return LawCheck(job.contacts, tasks, len(general))


def _draw(job: Job, rng: np.random.Generator) -> tuple[LineContact, float, float, float]:
    """Contact, load, speed and temperature of a random point."""
    contact = job.contacts[rng.integers(len(job.contacts))]
    speeds = [u for u in job.entrainment_speeds if u > 0.0]
    speed = _log_uniform(rng, min(speeds), max(speeds))
    temperature = float(rng.uniform(min(job.temperatures), max(job.temperatures)))
    return contact, _log_uniform(rng, min(job.loads), max(job.loads)), speed, temperature


def _draw_in_valley(job: Job, rng: np.random.Generator) -> tuple[LineContact, float, float, float] | None:
    """The same with a load in the damping valley; None where the map's loads do not reach it."""
    contact, _, speed, temperature = _draw(job, rng)
    load = _valley_load(job, contact, speed, temperature) * float(np.exp(rng.uniform(*VALLEY_WIDTH)))
    return (contact, load, speed, temperature) if min(job.loads) < load < max(job.loads) else None


def _log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """One number."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _valley_load(job: Job, contact: LineContact, speed: float, temperature: float) -> float:
    """Load at the bottom of the damping valley [N/m]."""
    state = job.lubricant.at(temperature)
    alpha = state.pressure_viscosity.pressure_viscosity
    unit, L = moes_groups(1.0, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    return float(valley_load_number(L)) / float(unit)


def checked_laws(check: LawCheck, emap: EHDMap, results: Mapping[str, Arrays]) -> dict[str, float | int | str]:
    """Errors of the laws as attributes, or why there are none: a map with holes makes no law.

    Parameters
    ----------
    check : LawCheck
        Which points are checked.
    emap : EHDMap
        The map.
    results : Mapping[str, Arrays]
        Fresh solves of the tasks of the check, by key.
    """
    try:
        return check_laws(check, emap, results)
    except MapError as error:
        return {"law_check_points": len(check.tasks), "law_refused": str(error)}


def unmet(dataset: xr.Dataset, with_backbone: bool) -> list[str]:
    """What the laws of a map miss, a line each, and what can be done; nothing where they were not checked.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map, with what its check found.
    with_backbone : bool
        Whether its laws are made from a backbone, and not from its own points.
    """
    missed = []
    if "law_refused" in dataset.attrs:
        missed.append(f"no contact law: {dataset.attrs['law_refused']}")
    for prefix, share in SHARES.items():
        for name in ("film_compliance", "damping"):
            found = dataset.attrs.get(f"{prefix}{name}_within_bar")
            if found is not None and found < share:
                where = "in the damping valley" if "valley" in prefix else "over the map"
                missed.append(
                    f"unmet: {name.replace('_', ' ')} of the contact laws is within its bar at {found:.1%} of the "
                    f"points {where}; wanted {share:.0%}"
                )
    if any(line.startswith("unmet") for line in missed):
        missed.append(STANDS_ON_LINES if with_backbone else STANDS_ON_POINTS)
    return missed


def check_laws(check: LawCheck, emap: EHDMap, results: Mapping[str, Arrays]) -> dict[str, float | int | str]:
    """Errors of the laws as attributes of the map.

    Parameters
    ----------
    check : LawCheck
        The points.
    emap : EHDMap
        The finished map; its laws are made here.
    results : mapping
        Arrays by key of the tasks.

    Returns
    -------
    dict
        Quantiles of the relative error in film compliance and damping of each contact's law, and the shares of the
        points that are within the bars. A law has no damping below zero: where the solved one is, the law is held
        against zero by the second bar, and the quantiles leave the point out. Where there is no film, only the second
        bars count.
    """
    errors, within, valley = [], [], []
    for contact in check.contacts:
        chosen = [i for i, task in enumerate(check.tasks) if task.contact == contact]
        usable = [i for i in chosen if Status(int(results[check.tasks[i].key]["status"][0])).usable]
        if not usable:
            continue
        # Fresh solves are those of smooth surfaces, whatever the job states.
        law = emap.law(contact.name, surface=SMOOTH)  # type: ignore[arg-type]
        rows = _errors(law, [(check.tasks[i], results[check.tasks[i].key]) for i in usable])
        errors.append(rows[:, :2])
        within.append(rows[:, 2:])
        valley.append(np.array(usable) >= check.general)
    record: dict[str, float | int | str] = {
        "law_check_seed": SEED,
        "law_check_points": len(check.tasks),
        "law_check_usable": sum(len(rows) for rows in errors),
    }
    if not errors:
        return record
    table, passed, inside = np.concatenate(errors), np.concatenate(within), np.concatenate(valley)
    for where, mask in (("", ~inside), ("_valley", inside)):
        if not np.any(mask):
            continue
        for column, name in enumerate(("film_compliance", "damping")):
            known = table[mask, column][np.isfinite(table[mask, column])]
            record[f"law{where}_{name}_error"] = _quantiles(known) if known.size else NOTHING[name]
            record[f"law{where}_{name}_within_bar"] = float(np.mean(passed[mask, column]))
    return record


def _quantiles(errors: FloatArray) -> str:
    """Quantiles of errors in words."""
    words = ("median", "95 %", "99 %", "largest")
    return ", ".join(f"{word} {value:.2g}" for word, value in zip(words, np.quantile(errors, QUANTILES), strict=True))


def _errors(law: ContactLaw, points: list[tuple[LineTask, Arrays]]) -> FloatArray:
    """Relative errors of film compliance and damping, and whether each is within its bar; shape (n, 4)."""
    tasks = [task for task, _ in points]
    fresh = [_solution(task, arrays) for task, arrays in points]
    load = np.array([task.loads[0] for task in tasks])
    speed = np.array([task.entrainment_speed for task in tasks])
    temperature = np.array([task.temperature for task in tasks])
    dry = np.array([task.contact.structural_compliance(task.loads[0]) for task in tasks])
    half = np.array([float(half_width(t.loads[0], t.contact.radius, t.contact.reduced_modulus)) for t in tasks])
    approach = np.array([one.approach for one in fresh])
    for _ in range(8):  # the approach at which the law has the load
        found, stiffness, damping = law(approach, 0.0, speed, temperature)
        approach -= (found - load) / np.maximum(stiffness, 1e-12 / dry)
    _, stiffness, damping = law(approach, 0.0, speed, temperature)
    solved_k = np.array([one.stiffness for one in fresh])
    solved_c = np.maximum([one.damping for one in fresh], 0.0)
    compliance = np.array([one.film_compliance for one in fresh])
    wrong = np.abs(1.0 / stiffness - 1.0 / solved_k)
    wrong_c = np.abs(damping - solved_c)
    # a dry contact has no film compliance to relate to, only 1/k
    relative = np.where(compliance != 0.0, wrong / np.maximum(np.abs(compliance), 1e-300), np.nan)
    relative_c = np.where(solved_c > 0.0, wrong_c / np.maximum(solved_c, 1e-300), np.nan)
    return np.column_stack(
        [
            relative,
            relative_c,
            (relative <= COMPLIANCE_BARS[0]) | (wrong * solved_k <= COMPLIANCE_BARS[1]),
            (relative_c <= DAMPING_BARS[0]) | (wrong_c * speed <= DAMPING_BARS[1] * solved_k * half),
        ]
    )


def _solution(task: LineTask, arrays: Arrays) -> ContactSolution:
    """The fresh solve with its structure."""
    film = FilmSolution(
        **{name: array[0].item() for name, array in arrays.items() if name != "status"},
        status=Status(int(arrays["status"][0])),
    )
    point = OperatingPoint(task.loads[0], task.entrainment_speed, task.temperature)
    return contact_solution(film, task.contact, point)
