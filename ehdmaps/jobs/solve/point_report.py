"""One operating point in words: the record of a contact, as JSON has it, and the table of all contacts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ehdmaps.ehl.solver import SuppliedFilm
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.report import ERRORS, FOUND_BY_SOME, NONE_STATED
from ehdmaps.jobs.make.tasks import ERRORS_OF_SOME
from ehdmaps.jobs.solve.contact_table import without_nan
from ehdmaps.jobs.solvers import solver_words
from ehdmaps.maps.rough_layer import (
    DEEPEST_MEANT,
    FILM_PARAMETER,
    FILM_SHARE,
    LEAST_SPEED,
    MEAN_DISTANCE,
    MeanPlanes,
    RoughLayer,
    SmoothContact,
    load_sharing,
    sharing_effect,
)
from ehdmaps.physics import hertz
from ehdmaps.physics.closed_form import too_thin
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solution import ContactSolution, Status, tip_words
from ehdmaps.physics.surface import SMOOTH, Surface
from ehdmaps.units import (
    DAMPER,
    DAMPING,
    FILM,
    LENGTH,
    LOAD,
    MASS_FLOW,
    PRESSURE,
    ROLLING_FORCE,
    RPM,
    SPRING,
    STIFFNESS,
    TEMPERATURE,
    Display,
)

_SOLUTION_FIELDS = (
    "approach",
    "film_offset",
    "film_compliance",
    "loss_compliance",
    "stiffness",
    "damping",
    "central_film",
    "minimum_film",
    "max_pressure",
    "rolling_force",
    "mass_flow",
    *(name for name, _, _ in FOUND_BY_SOME),
    *ERRORS_OF_SOME,
    *ERRORS,
    "loss_compliance_error",
    "iterations",
    "solve_seconds",
    "viscosity_extrapolated",
)


ROUGH_BAND = {
    "stiffness": ("stiffness_soft_asperities", "stiffness_stiff_asperities"),
    "damping": ("damping_soft_asperities", "damping_stiff_asperities"),
}
"""Names of k and c between rough surfaces, with the softest and the stiffest usual asperities."""

SOFT_DISTANCE = f"{MEAN_DISTANCE}_soft_asperities"


def point_record(
    solution: ContactSolution, contact: LineContact, job: Job, point: OperatingPoint, frequency: float
) -> dict[str, Any]:
    """Return one contact's solution as plain values, SI; None where there is no number.

    Parameters
    ----------
    solution : ContactSolution
        What the solver and the solids give.
    contact : LineContact
        The contact.
    job : Job
        What it belongs to: oil, and surfaces.
    point : OperatingPoint
        Load, entrainment speed, temperature.
    frequency : float
        [Hz].
    """
    surface = job.surface or SMOOTH
    record: dict[str, Any] = {
        "contact": contact.name,
        **point_place(contact, job.lubricant, point),
        "frequency": frequency,
        **_numbers(solution),
        **_rough(solution, contact, job.lubricant, point, surface, frequency),
        "status": solution.status.word,
        "film_note": too_thin(solution.minimum_film, surface.roughness),
        "reason": solution.reason,
    }
    return without_nan(record)


def point_place(contact: LineContact, oil: Lubricant, point: OperatingPoint) -> dict[str, float | None]:
    """Return where a contact works, SI: the point, Moes' groups, and the dry contact.

    Parameters
    ----------
    contact : LineContact
        The contact.
    oil : Lubricant
        The oil.
    point : OperatingPoint
        Load, entrainment speed, temperature.
    """
    return {
        "load_per_length": point.load,
        "entrainment_speed": point.entrainment_speed,
        "temperature": point.temperature,
        **_groups(contact, oil, point),
        "hertz_half_width": float(hertz.half_width(point.load, contact.radius, contact.reduced_modulus)),
        "hertz_pressure": float(hertz.max_pressure(point.load, contact.radius, contact.reduced_modulus)),
    }


def _numbers(solution: ContactSolution) -> dict[str, Any]:
    """Return the numbers of a solution; a hole has none."""
    values = {name: getattr(solution, name) for name in _SOLUTION_FIELDS}
    values["viscosity_extrapolated"] = int(solution.viscosity_extrapolated)
    return values


def _rough(
    solution: ContactSolution,
    contact: LineContact,
    oil: Lubricant,
    point: OperatingPoint,
    surface: Surface,
    frequency: float,
) -> dict[str, float]:
    """Return what the roughness makes of the film; nothing between smooth surfaces."""
    if surface.smooth:
        return {}
    layer = RoughLayer(surface, contact, oil, max(point.entrainment_speed, LEAST_SPEED))
    place = [np.array([value]) for value in (point.load, point.entrainment_speed, point.temperature)]
    share, distance = load_sharing(layer, np.full((1, 1, 1), solution.film_offset), *place)
    found = {
        "roughness": surface.roughness,
        FILM_PARAMETER: solution.minimum_film / surface.roughness,
        FILM_SHARE: float(share.item()),
        MEAN_DISTANCE: float(distance.item()),
    }
    if frequency:  # shares are those of slow motion
        return found
    values = point.load, solution.film_offset, solution.film_compliance, solution.loss_compliance
    smooth = SmoothContact(*(np.array([value]) for value in (*values, contact.structural_compliance(point.load))))
    for corner, names in zip(surface.corners, zip(*ROUGH_BAND.values(), strict=True), strict=True):
        times = sharing_effect(replace(layer, surface=corner), smooth, point.entrainment_speed, point.temperature)
        stiffness, damping = solution.stiffness * times[0, 0], solution.damping * times[1, 0]
        found |= dict(zip(names, (float(stiffness), float(damping)), strict=True))
    soft = replace(layer, surface=surface.corners[0])
    _, distance = load_sharing(soft, np.full((1, 1, 1), solution.film_offset), *place)
    return {**found, SOFT_DISTANCE: float(distance.item())}


def _groups(contact: LineContact, oil: Lubricant, point: OperatingPoint) -> dict[str, float | None]:
    """Return Moes' M and L; none at standstill."""
    if point.entrainment_speed == 0:
        return {"M": None, "L": None}
    state = oil.at(point.temperature)
    M, L = moes_groups(
        point.load,
        point.entrainment_speed,
        state.viscosity,
        state.pressure_viscosity.pressure_viscosity,
        contact.radius,
        contact.reduced_modulus,
    )
    return {"M": M, "L": L}


def point_table(job: Job, records: list[dict[str, Any]], point: OperatingPoint, length: float | None) -> str:
    """Return the printed table: one column a contact, per length and, if known, times the length.

    Parameters
    ----------
    job : Job
        What the contacts belong to.
    records : list of dict
        Records of the contacts, see `point_record`.
    point : OperatingPoint
        Load, entrainment speed, temperature.
    length : float or None
        Length of a slice [m].
    """
    rows: list[tuple[str, str, list[Any]]] = list(_rows(records, length))
    law = job.contacts[0].structural_law
    solver = f"solver {job.solver}{solver_words(job.solver_options)}"
    header = f"{job.title}, {job.lubricant.title}, {solver}, structural law {law}"
    place = f"{LOAD.text(point.load)}, {_speed(job, point)}, {TEMPERATURE.text(point.temperature)}"
    if length is not None:
        place += f", slice of {LENGTH.text(length)} ({point.load * length:.5g} N)"
    if job.surface is not None and not job.surface.smooth:
        place += f", {job.surface.label} (films, k and c are those of smooth surfaces)"
    if records and records[0]["frequency"]:
        place += f", oscillating at {records[0]['frequency']:.6g} Hz"
    # a long status must not run into the next column
    cells = [[record["contact"] for record in records], *([_shown(value) for value in row[2]] for row in rows)]
    width = max(14, *(len(cell) + 2 for line in cells for cell in line))
    lines = [header, *job.estimates, place, f"{'':38s}" + "".join(f"{cell:>{width}s}" for cell in cells[0])]
    for (label, unit, _), values in zip(rows, cells[1:], strict=True):
        shown = "".join(f"{cell:>{width}s}" for cell in values)
        lines.append(f"  {label:22s} {unit:12s} {shown}")
    lines.extend(f"  {record['contact']}: {record['reason']}" for record in records if record["reason"])
    lines.extend(f"  {record['contact']}: {note}" for record in records if (note := _extrapolated(job, record)))
    lines.extend(f"  {record['contact']}: {note}" for record in records if (note := _tip(record)))
    lines.extend(f"  {record['contact']}: {planes}" for record in records if (planes := _mean_planes(record)))
    return "\n".join(lines)


def _mean_planes(record: dict[str, Any]) -> str:
    """Say where the load sharing of a rough contact is out of its range; empty where it is not."""
    share, distance, soft = (record.get(name) for name in (FILM_SHARE, MEAN_DISTANCE, SOFT_DISTANCE))
    if share is None or distance is None:
        return ""
    stated = MeanPlanes.of(share, distance)
    if stated is not MeanPlanes.MERGED and soft is not None and soft < DEEPEST_MEANT:
        merged = f"with the softest usual asperities {MeanPlanes.MERGED.value}"
        return f"{stated.value}; {merged}" if stated.value else merged
    return stated.value


def _tip(record: dict[str, Any]) -> str:
    """Say what the largest pressure of a contact lacks of its spike; empty where it lacks nothing."""
    error = record["max_pressure_error"]
    return "" if error is None else tip_words(error)


def _speed(job: Job, point: OperatingPoint) -> str:
    """Return the entrainment speed, and what it is of the inner ring of a bearing."""
    speed = f"{point.entrainment_speed:.6g} m/s"
    if job.bearing is None:
        return speed
    return f"{speed} (inner ring {RPM.text(job.bearing.inner_speed(point.entrainment_speed), 6)}, outer ring fixed)"


def _extrapolated(job: Job, record: dict[str, Any]) -> str:
    """Say that the pressure of a contact lies beyond the reach of the viscosity; empty where it does not."""
    if not record["viscosity_extrapolated"]:
        return ""
    return f"viscosity extrapolated: pressure above {job.lubricant.reach}"


def _rows(records: list[dict[str, Any]], length: float | None) -> Iterator[tuple[str, str, list[Any]]]:
    """Yield label, unit and values of each line of the table."""

    def row(label: str, key: str, display: Display, times: float = 1.0) -> tuple[str, str, list[Any]]:
        values = [None if record[key] is None else display.value(record[key] * times) for record in records]
        return label, display.unit, values

    plain = Display("")
    yield "status", "", [words_of(record) for record in records]
    yield row("M", "M", plain)
    yield row("L", "L", plain)
    yield row("Hertz half-width", "hertz_half_width", FILM)
    yield row("Hertz pressure", "hertz_pressure", PRESSURE)
    yield row("largest pressure", "max_pressure", PRESSURE)
    yield row("approach", "approach", FILM)
    yield row("film offset", "film_offset", FILM)
    yield row("central film", "central_film", FILM)
    yield row("minimum film", "minimum_film", FILM)
    if FILM_PARAMETER in records[0]:
        yield row("film over roughness", FILM_PARAMETER, plain)
        yield row("film's share of load", FILM_SHARE, plain)
        yield row("mean planes/roughness", MEAN_DISTANCE, plain)
    yield row("rolling force", "rolling_force", ROLLING_FORCE)
    yield row("mass flow", "mass_flow", MASS_FLOW)
    for name, words, display in FOUND_BY_SOME:
        if any(record[name] is not None for record in records):
            yield row(words, name, display)
    yield row("stiffness k", "stiffness", STIFFNESS)
    yield row("damping c", "damping", DAMPING)
    if ROUGH_BAND["stiffness"][0] in records[0]:
        for letter, display, names in zip("kc", (STIFFNESS, DAMPING), ROUGH_BAND.values(), strict=True):
            for kind, name in zip(("soft", "stiff"), names, strict=True):
                yield row(f"{letter}, {kind} asperities", name, display)
    if length is not None:
        yield row("k x length", "stiffness", SPRING, length)
        yield row("c x length", "damping", DAMPER, length)
    for name in ERRORS:
        stated = [_stated(record, name) for record in records]
        yield f"error of {name.removesuffix('_error').replace('_', ' ')}", "", stated
    for name in ERRORS_OF_SOME:
        if any(record[name] is not None for record in records):
            yield row(f"error of {name.removesuffix('_error').replace('_', ' ')}", name, Display("K"))
    yield row("processor time", "solve_seconds", Display("ms", 1e3))


def words_of(record: dict[str, Any]) -> str:
    """Return the status of a record; no film is plainly converged that is too thin for the theory.

    Parameters
    ----------
    record : dict
        Record of a contact, see `point_record`.
    """
    thin = record["film_note"] if record["status"] == Status.CONVERGED.word else ""
    return f"{record['status']}, {thin}" if thin else str(record["status"])


def _stated(record: dict[str, Any], error: str) -> float | str | None:
    """Return an error of a contact; words where its value is known and the error is not."""
    value = record[error.removesuffix("_error")]
    return NONE_STATED if value is not None and record[error] is None else record[error]


def _shown(value: Any) -> str:
    """Return a value for the table."""
    if value is None:
        return "-"
    return value if isinstance(value, str) else f"{value:.5g}"


def supplied_record(supply: OilSupply, film: SuppliedFilm) -> dict[str, Any]:
    """Return what a supply adds to the plain values of one contact, SI; None where there is no number.

    Parameters
    ----------
    supply : OilSupply
        Oil supply of the contact.
    film : SuppliedFilm
        Film behind it.
    """
    values = {
        "oil_layer": supply.oil_layer,
        "flow_ratio": film.flow_ratio,
        "meniscus": film.meniscus,
        "supplied_compliance": film.supplied_compliance,
    }
    return {"supply": supply.label, **without_nan(values)}


def supplied_table(supply: OilSupply, films: dict[str, SuppliedFilm]) -> str:
    """Return the printed table: a line a contact.

    Parameters
    ----------
    supply : OilSupply
        Oil supply of the contacts.
    films : dict
        Films by the name of the contact.
    """
    lines = [
        f"oil supply: {supply.label}; k and c of a starved contact are those of a meniscus that stays where it is",
        f"  {'':12s}{'flow over flooded':>20s}{'meniscus before the centre':>30s}",
    ]
    lines += [
        f"  {name:12s}{_number(film.flow_ratio):>20s}{_place(film.meniscus):>30s}" for name, film in films.items()
    ]
    return "\n".join(lines)


def _number(ratio: float) -> str:
    return "-" if math.isnan(ratio) else f"{ratio:.4g}"


def _place(meniscus: float) -> str:
    if math.isnan(meniscus):
        return "-"
    return "flooded" if meniscus == math.inf else FILM.text(meniscus)
