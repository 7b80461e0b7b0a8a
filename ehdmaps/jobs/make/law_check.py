"""The contact laws of a map against films at random points: how good they are between nodes.

Films are solved fresh. Those of laws that read the film table are read from it: how wrong the table is was found when
it was made, and is stated at each point of a map; such laws beside fresh solves are a fact of the release, see
`ehdmaps.table.checked`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import bdtrc

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.sampling import COMPLIANCE_BARS, DAMPING_BARS, draw_apart, draw_beyond, drawable
from ehdmaps.jobs.make.store import Arrays
from ehdmaps.jobs.make.table_films import read_points
from ehdmaps.jobs.make.tasks import LineTask
from ehdmaps.maps.backbone import BackboneField
from ehdmaps.maps.backbone_plan import Axis
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import FilmField, known_at
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.law_errors import quantiles_text
from ehdmaps.maps.schema import FILM_TABLE
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.oil_supply import FLOODED
from ehdmaps.physics.solution import ContactSolution, ContactSolver, FilmSolution, Status, contact_solution
from ehdmaps.physics.surface import SMOOTH
from ehdmaps.table.solver import TableSolver

READ_COMPLIANCE_BARS = (0.01, 1e-3)
"""The bar of film compliance for laws whose films are read from the film table: a thousandth of a stiffness. Whoever
needs more has the films solved."""

SMALL_DAMPING = DAMPING_BARS[1] / DAMPING_BARS[0]
"""Damping, as a share of k b/u, below which an error is related to this share: damping runs through zero in its valley,
and a share of nothing is no measure."""


def fresh_solution(task: LineTask, arrays: Arrays) -> ContactSolution:
    """The first point of a line with its structure.

    Parameters
    ----------
    task : LineTask
        The line.
    arrays : Arrays
        Films of the line.
    """
    film = FilmSolution(
        **{name: array[0].item() for name, array in arrays.items() if name != "status" and array.ndim == 1},
        status=Status(int(arrays["status"][0])),
    )
    point = OperatingPoint(task.loads[0], task.entrainment_speed, task.temperature)
    return contact_solution(film, task.contact, point)


def at_loads(
    law: ContactLaw, approach: FloatArray, load: FloatArray, speed: FloatArray, temperature: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Approach [m] at which a law of one contact has these loads, with stiffness [N/m2] and damping [N s/m2] there.

    Parameters
    ----------
    law : ContactLaw
        Law of one contact.
    approach : array (n,)
        Begin of the search [m].
    load, speed, temperature : array (n,)
        [N/m], [m/s] and [K].
    """
    dry = np.array([law.contacts[0].structural_compliance(float(w)) for w in load])
    approach = approach.copy()
    for _ in range(8):
        law_load, stiffness, damping = law(approach, 0.0, speed, temperature)
        approach -= (law_load - load) / np.maximum(stiffness, 1e-12 / dry)
    _, stiffness, damping = law(approach, 0.0, speed, temperature)
    return approach, stiffness, damping


SEED = 20260

INSIDE = ("", "valley")
"""Regions of the points: over the map, and in its damping valley."""

EDGES = ("slow", "beyond")
"""Regions outside the map, where laws continue their films: below its lowest speed, and outside its temperatures."""

EDGE_SHARE = 0.1
"""Points in each of these, as a share of those inside."""

TOLERANCES = (1e-3, 0.1)
"""Smallest and largest tolerance of contact laws."""

MOST_OF_READ = 100
"""Points within a map with films from the film table: they prove that reading is right, and lay no lines."""

SHARES = {"law_": 0.99, "law_valley_": 0.95}
"""Share of the points that should be within the bars, over the whole map and in the valley."""

CHANCE = 1e-3
"""Chance with which as many random points miss a bar, of films that miss it at as many as may, from which on these are
taken to miss it: some do of a hundred points of any good map, and none is solved for that."""

REFUSED, HALVED, TOLERANCE = "law_refused", "law_lines_halved_along", "law_tolerance"
"""Attributes of the map: why it makes no law, the axes along which the steps of its lines were halved, and the
tolerance that its laws were asked to keep."""

AGAINST, READ = "law_check_against", "the film table"
"""Attribute of the map: what its laws were held against, where that is no fresh solve."""

STANDS_ON_LINES = (
    "these laws are made from refinement lines, whose steps are halved where the films between them miss, three times "
    "at most; what misses then is the table of the law, or lines that would take too many points; other axes of [grid] "
    "do not bring them closer to their bars; the quantiles of their errors stand above; `ehdmaps solve` gives a single "
    "point without a law"
)
STANDS_ON_POINTS = (
    "these laws are made from the points of the map: more temperatures, speeds or loads help; so do refinement lines, "
    "of reynolds, which CFD corrects in nu308_cfd"
)
STANDS_ON_TABLE = (
    "films from the film table are within these bars: what misses is the table of the law, at the bottom of the "
    "damping valley; the quantiles of its errors stand above; `ehdmaps solve` gives a single point without a law"
)
"""What can be done where a bar is unmet; for the lines see `coarse_axis`."""

NOTHING = {
    "film_compliance": "none: no film to relate to",
    "damping": "none: no damping above zero to relate to",
    "film_offset": "none: no film to relate to",
}
"""What stands in place of quantiles where no point has one."""


_WORTH: Mapping[Axis, float] = {"load": 0.25}
"""Weight of an axis in `coarse_axis`, where it is not 1."""


@dataclass(frozen=True)
class LawCheck:
    """Random points over the map, in its valley and beyond its edges; `regions` says which is which.

    `compliance_bars` and `damping_bars` are those that the laws are held to; by a `tolerance` they are held to it by
    stiffness, damping and film offset, with what the fresh solves state to be wrong by themselves. Where it `reads`,
    films of the points are read from the film table by `TableSolver`.
    """

    contacts: tuple[LineContact, ...]
    tasks: tuple[LineTask, ...]
    regions: tuple[str, ...]
    compliance_bars: tuple[float, float] = COMPLIANCE_BARS
    damping_bars: tuple[float, float] = DAMPING_BARS
    tolerance: float | None = None
    reads: TableSolver | None = None

    @property
    def to_solve(self) -> tuple[LineTask, ...]:
        """Points that are solved."""
        return () if self.reads else self.tasks

    def films(self, results: Mapping[str, Arrays]) -> Mapping[str, Arrays]:
        """Films of the points by key: solved ones, or those of the table.

        Parameters
        ----------
        results : mapping
            What was solved, by key of the tasks.
        """
        return read_points(self.tasks, self.reads) if self.reads else results


def plan_check(
    job: Job, solver: ContactSolver, tolerance: float | None = None, solves: bool = False
) -> LawCheck | None:
    """Draw the points: load and speed log-uniform, temperature uniform, contact at random; None if `law_check` is 0.

    Parameters
    ----------
    job : Job
        Job of the map.
    solver : ContactSolver
        What gives its films.
    tolerance : float, optional
        Share that the laws are held to; by fresh solves in any case.
    solves : bool
        Whether laws that read the film table are held against fresh solves, too.
    """
    if tolerance is not None and not (TOLERANCES[0] <= tolerance <= TOLERANCES[1] and job.law_check and drawable(job)):
        raise InputError(
            f"tolerance: got {tolerance:g} and law_check = {job.law_check}; allowed: {TOLERANCES[0]:g} to "
            f"{TOLERANCES[1]:g} (0.01 is 1 %), with a law_check above 0 and a solver that has films"
        )
    read = solver if isinstance(solver, TableSolver) else None
    count = min(job.law_check, MOST_OF_READ) if read else job.law_check
    if not count or not drawable(job):
        return None
    rng = np.random.default_rng(SEED)
    over, valley = draw_apart(job, rng, count)
    drawn = [("", point) for point in over] + [("valley", point) for point in valley]
    slow, beyond = draw_beyond(job, rng, round(EDGE_SHARE * count))
    drawn += [("slow", point) for point in slow] + [("beyond", point) for point in beyond]
    fresh = read.other if read else solver
    tasks = tuple(LineTask(contact, job.lubricant, (w,), u, T, fresh) for _, (contact, w, u, T) in drawn)
    check = LawCheck(job.contacts, tasks, tuple(region for region, _ in drawn))
    if tolerance is not None:
        bars = (0.0, tolerance), (tolerance, SMALL_DAMPING * tolerance)
        return replace(check, compliance_bars=bars[0], damping_bars=bars[1], tolerance=tolerance)
    return replace(check, compliance_bars=READ_COMPLIANCE_BARS, reads=None if solves else read) if read else check


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
        inside = sum(region in INSIDE for region in check.regions)
        return {"law_check_points": inside, REFUSED: str(error)}


def unmet(dataset: xr.Dataset, with_backbone: bool) -> list[str]:
    """Shortfalls of the laws of a map, a line each, and what can be done; nothing where they were not checked.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map, with what its check found.
    with_backbone : bool
        Whether its laws are made from a backbone, and not from its own points.
    """
    missed = []
    if REFUSED in dataset.attrs:
        missed.append(f"no contact law: {dataset.attrs[REFUSED]}")
    for prefix, name, within, share in _shares(dataset.attrs):
        if within < share:
            where = "in the damping valley" if "valley" in prefix else "over the map"
            missed.append(
                f"unmet: {name.replace('_', ' ')} of the contact laws is within its bar at {within:.1%} of the "
                f"points {where}; wanted {share:.0%}"
            )
    if any(line.startswith("unmet") for line in missed):
        advice = STANDS_ON_LINES if with_backbone else STANDS_ON_POINTS
        missed.append(STANDS_ON_TABLE if FILM_TABLE in dataset.attrs else advice)
    return missed


def met(attributes: Mapping[str, Any]) -> bool:
    """Tell whether the laws of a map are within their bars at as many of the checked points as they should be.

    Parameters
    ----------
    attributes : mapping
        What `checked_laws` found, of a map that makes laws.
    """
    return not any(within < share for *_, within, share in _shares(attributes))


def _shares(attributes: Mapping[str, Any]) -> Iterator[tuple[str, str, float, float]]:
    """Yield prefix, name, share found and share wanted of points within each bar that was checked."""
    for prefix, share in SHARES.items():
        for name in ("film_compliance", "damping", "film_offset"):
            within = attributes.get(f"{prefix}{name}_within_bar")
            if within is not None:
                yield prefix, name, float(within), share


def coarse_axis(check: LawCheck, emap: EHDMap, results: Mapping[str, Arrays]) -> Axis | None:
    """Along which axis the lines of a backbone are too far apart; None where that is not what laws miss their bars by.

    Only points count at which the films between the lines, without the table of a law, miss the bars of compliance or
    damping. The axis is the one along which reading fewer points changes the loss most, at most of these points; every
    second point of a cubic line changes it sixteen times as much as its own step is worth, four lines instead of six
    less, so that the loads get a quarter of their say.

    Parameters
    ----------
    check : LawCheck
        The points.
    emap : EHDMap
        The finished map.
    results : mapping
        Arrays by key of the tasks.
    """
    votes: Counter[Axis] = Counter()
    for field, task, _, missed in _between(check, emap, results):
        if missed and isinstance(field, BackboneField):
            changes = field.changes(task.contact.name, task.loads[0], task.entrainment_speed, task.temperature)
            votes[max(changes, key=lambda axis: changes[axis] * _WORTH.get(axis, 1.0))] += 1
    return votes.most_common(1)[0][0] if votes else None


def films_met(check: LawCheck, emap: EHDMap, results: Mapping[str, Arrays]) -> bool:
    """Tell whether films between the points, without the table of a law, may be within the bars at as many points as
    wanted: misses are no more than chance has of films that are, see `CHANCE`.

    Parameters
    ----------
    check : LawCheck
        The points.
    emap : EHDMap
        The finished map.
    results : mapping
        Arrays by key of the tasks.
    """
    missed: dict[str, list[bool]] = {region: [] for region in INSIDE}
    for *_, region, wrong in _between(check, emap, results):
        missed[region].append(wrong)
    shares = zip(missed.values(), SHARES.values(), strict=True)
    return all(not any(misses) or bdtrc(sum(misses) - 1, len(misses), 1.0 - share) > CHANCE for misses, share in shares)


def _between(
    check: LawCheck, emap: EHDMap, results: Mapping[str, Arrays]
) -> Iterator[tuple[FilmField, LineTask, str, bool]]:
    """Yield usable points with the films that a law is made from, their region, and whether these films miss a bar."""
    for contact in check.contacts:
        field = emap.film_field((contact.name,))
        for task, region in zip(check.tasks, check.regions, strict=True):
            arrays = results[task.key]
            usable = task.contact == contact and Status(int(arrays["status"][0])).usable
            if region in INSIDE and usable and _is_known(field, task):
                missed = _missed_between(field, task, fresh_solution(task, arrays), check)
                yield field, task, region, missed


def _missed_between(field: FilmField, task: LineTask, fresh: ContactSolution, check: LawCheck) -> bool:
    """Tell whether films between the lines miss a bar."""
    bars, damping_bars = check.compliance_bars, check.damping_bars
    (load,), u, T, contact = task.loads, task.entrainment_speed, task.temperature, task.contact
    films = field.films(contact.name, np.array([[[load]]]), np.array([u]), np.array([T]))
    _, compliance, loss = (float(values[0, 0, 0]) for values in films)
    stiffness = 1.0 / (contact.structural_compliance(load) + compliance)
    wrong, solved_c = abs(1.0 / stiffness - 1.0 / fresh.stiffness), max(fresh.damping, 0.0)
    wrong_c = abs(loss * stiffness**2 - solved_c)
    unit = fresh.stiffness * float(half_width(load, contact.radius, contact.reduced_modulus)) / u
    return wrong > max(bars[0] * abs(fresh.film_compliance), bars[1] / fresh.stiffness) or (
        wrong_c > max(damping_bars[0] * solved_c, damping_bars[1] * unit)
    )


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
        points that are within the bars, over the map and in its valley; quantiles of the error in stiffness and film
        offset, too. The same below the lowest speed and outside the temperatures of the map, as far as laws go on there
        by the policy `asymptote`; no share is asked for there. A law has no damping below zero: where the solved one
        is, the law is held against zero by the second bar, and the quantiles leave the point out. Where there is no
        film, only the second bars count.
    """
    rows: list[FloatArray] = []
    regions: list[str] = []
    for contact, (policy, wanted) in product(check.contacts, (("error", INSIDE), ("asymptote", EDGES))):
        chosen = [
            (task, results[task.key], region)
            for task, region in zip(check.tasks, check.regions, strict=True)
            if region in wanted and task.contact == contact and Status(int(results[task.key]["status"][0])).usable
        ]
        field = emap.film_field((contact.name,))
        chosen = [point for point in chosen if _is_known(field, point[0], policy != "error")]
        if not chosen:
            continue
        # Fresh solves are those of flooded films between smooth surfaces, whatever the job states.
        law = emap.law(contact.name, policy, supply=FLOODED, surface=SMOOTH)  # type: ignore[arg-type]
        chosen = [point for point in chosen if _reaches(law, point[0])]
        if chosen:
            rows.append(_errors(law, [(task, arrays) for task, arrays, _ in chosen], check))
            regions += [region for *_, region in chosen]
    record: dict[str, float | int | str] = {
        "law_check_seed": SEED,
        "law_check_points": sum(region in INSIDE for region in check.regions),
        "law_check_usable": sum(region in INSIDE for region in regions),
    }
    if check.reads:
        record[AGAINST] = READ
    if not rows:
        return record
    table = np.concatenate(rows)
    for region in (*INSIDE, *EDGES):
        mask = np.array([of_point == region for of_point in regions])
        if not np.any(mask):
            continue
        where = f"_{region}" if region else ""
        for name, column in ("film_compliance", 0), ("damping", 1), ("stiffness", 4), ("film_offset", 5):
            known = table[mask, column][np.isfinite(table[mask, column])]
            record[f"law{where}_{name}_error"] = quantiles_text(known) if known.size else NOTHING[name]
            if column < 2:  # the two whose errors have bars
                record[f"law{where}_{name}_within_bar"] = float(np.mean(table[mask, column + 2]))
        if check.tolerance is not None:
            record[f"law{where}_film_offset_within_bar"] = float(np.mean(table[mask, 6]))
    if check.tolerance is not None:
        record[TOLERANCE] = check.tolerance
    return record


def _is_known(field: FilmField, task: LineTask, held: bool = False) -> bool:
    """Tell whether the films of a law are known at a point; where speed and temperature are held, at the edge."""
    u, T = task.entrainment_speed, task.temperature
    if held:
        u, T = float(np.clip(u, *field.speed_range)), float(np.clip(T, *field.temperature_range))
    return bool(known_at(field, np.array(task.loads), u, T).all())


def _reaches(law: ContactLaw, task: LineTask) -> bool:
    """Tell whether a law has whole films at a point, where it lies outside the map."""
    table, u, T = law.plain_table, task.entrainment_speed, task.temperature
    if law.speed_range[0] <= u and law.temperature_range[0] <= T <= law.temperature_range[1]:
        return True
    return u >= table.film_speed and table.lowest_temperature <= T <= table.highest_temperature


def _errors(law: ContactLaw, points: list[tuple[LineTask, Arrays]], check: LawCheck) -> FloatArray:
    """Errors of film compliance and damping, whether each is within its bar, errors of k and film offset, and whether
    that is within the tolerance; shape (n, 7).

    All are relative; that of the film offset is what the approach at the load misses, as a part of the offset. Beside a
    tolerance the fresh solves are taken to be wrong by what they state.
    """
    tasks = [task for task, _ in points]
    fresh = [fresh_solution(task, arrays) for task, arrays in points]
    load = np.array([task.loads[0] for task in tasks])
    speed = np.array([task.entrainment_speed for task in tasks])
    temperature = np.array([task.temperature for task in tasks])
    half = np.array([float(half_width(t.loads[0], t.contact.radius, t.contact.reduced_modulus)) for t in tasks])
    solved_approach = np.array([one.approach for one in fresh])
    approach, stiffness, damping = at_loads(law, solved_approach, load, speed, temperature)
    solved_k = np.array([one.stiffness for one in fresh])
    solved_c = np.maximum([one.damping for one in fresh], 0.0)
    compliance = np.array([one.film_compliance for one in fresh])
    offset = np.abs([one.film_offset for one in fresh])
    missed = np.abs(approach - solved_approach)
    wrong = np.abs(1.0 / stiffness - 1.0 / solved_k)
    wrong_c = np.abs(damping - solved_c)
    # a dry contact has no film compliance to relate to, only 1/k
    relative = np.where(compliance != 0.0, wrong / np.maximum(np.abs(compliance), 1e-300), np.nan)
    relative_c = np.where(solved_c > 0.0, wrong_c / np.maximum(solved_c, 1e-300), np.nan)
    relative_offset = np.where(offset > 0.0, missed / np.maximum(offset, 1e-300), np.nan)
    (share, bar), (share_c, bar_c) = check.compliance_bars, check.damping_bars
    own = np.zeros((3, load.size))
    if check.tolerance is not None:
        own = np.array([[one.stiffness_error, one.damping_error, one.film_offset_error] for one in fresh]).T
        own = np.nan_to_num(own, nan=0.0)  # without a film there is none to be wrong
    unit = solved_k * half / speed
    return np.column_stack(
        [
            relative,
            relative_c,
            (relative <= share) | (wrong * solved_k + own[0] <= bar),
            (wrong_c + own[1] * solved_c <= share_c * solved_c) | (wrong_c + own[1] * solved_c <= bar_c * unit),
            wrong * solved_k,
            relative_offset,
            ~(relative_offset + own[2] > (check.tolerance or 0.0)),
        ]
    )
