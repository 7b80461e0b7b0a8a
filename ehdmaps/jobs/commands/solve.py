"""`ehdmaps solve`: one operating point of every contact of a job."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Iterator
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.axes import RING_SPEED_AXIS, SPEED_AXIS
from ehdmaps.jobs.film_output import film_outputs
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.report import ERRORS
from ehdmaps.physics import hertz
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups
from ehdmaps.physics.operating_point import OperatingPoint
from ehdmaps.physics.solution import ContactSolution, ContactSolver, FilmSolution, Status, contact_solution
from ehdmaps.program import tell
from ehdmaps.units import FILM, LENGTH, LOAD, PRESSURE, RPM, SPEED, TEMPERATURE, Display, quantity

_SOLUTION_FIELDS = (
    "approach",
    "film_offset",
    "stiffness",
    "damping",
    "central_film",
    "minimum_film",
    "max_pressure",
    "film_offset_error",
    "film_compliance_error",
    "stiffness_error",
    "damping_error",
    "central_film_error",
    "minimum_film_error",
    "max_pressure_error",
    "iterations",
    "solve_seconds",
    "viscosity_extrapolated",
)


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Solve the point for every contact; status 1 if one of them has no solution."""
    job, point, length, frequency = _read(arguments)
    outputs = film_outputs(job, arguments.fields, arguments.plot, arguments.job)
    options = {**job.solver_options, **solvers.case_options(job.solver, arguments.keep_cases)}
    solver = solvers.build(job.solver, options)
    if outputs:
        films, written = outputs.solve(solver, job, point, frequency)
        for line in written:
            tell(line)
    else:
        films = [_film(solver, contact, job.lubricant, point, frequency) for contact in job.contacts]
    records = [
        _record(film, contact, job.lubricant, point, frequency)
        for film, contact in zip(films, job.contacts, strict=True)
    ]
    usable = all(Status[str(record["status"]).upper()].usable for record in records)
    text = json.dumps(records, indent=2, allow_nan=False) if arguments.json else _table(job, records, point, length)
    return text, 0 if usable else 1


def _read(arguments: argparse.Namespace) -> tuple[Job, OperatingPoint, float | None, float]:
    """Read job, point, length [m] (None if not given) and frequency [Hz]; all problems at once."""
    problems: list[str] = []
    job: Job | None = None
    try:
        job = read_job(arguments.job, arguments.solver, to_run=True)
    except InputError as error:
        problems.extend(error.problems)

    def read(option: str, text: str | None, unit: str, low: float, high: float, display: Display) -> float | None:
        try:
            value = quantity(text, unit)
        except InputError as error:
            problems.append(f"{option}: {error.problems[0]}")
            return None
        if low <= value <= high:
            return value
        problems.append(f"{option}: got {text!r}; allowed: {display.text(low)} to {display.text(high)}")
        return None

    per_length = _is_of_unit(arguments.load, "N/m")
    length: float | None = None
    if arguments.length is not None:
        length = read("--length", arguments.length, "m", 1e-6, 100.0, LENGTH)
    elif not per_length:
        problems.append('--length: missing; a load in N needs the length that carries it; or give --load in "N/mm"')
    if per_length:
        load = read("--load", arguments.load, "N/m", 1.0, 1e7, LOAD)
    else:
        force = read("--load", arguments.load, "N", 1e-6, 1e9, Display("N"))
        load = force / length if force is not None and length is not None else None
        if load is not None and not 1.0 <= load <= 1e7:
            problems.append(
                f"--load over --length: got {LOAD.text(load)}; allowed: {LOAD.text(1.0)} to {LOAD.text(1e7)}"
            )
    speed: float | None = None
    if not _is_of_unit(arguments.speed, "rad/s"):
        speed = read("--speed", arguments.speed, SPEED_AXIS.unit, SPEED_AXIS.low, SPEED_AXIS.high, SPEED)
    elif job is not None and job.bearing is not None:
        fastest = job.bearing.inner_speed(SPEED_AXIS.high)
        ring = read("--speed", arguments.speed, RING_SPEED_AXIS.unit, RING_SPEED_AXIS.low, fastest, RPM)
        speed = None if ring is None else job.bearing.entrainment_speed(ring)
    elif job is not None:
        problems.append(
            f"--speed: got {arguments.speed!r:.60}; allowed: m/s, since the job has a bare contact; rpm are those of "
            "the inner ring of a bearing"
        )
    temperature = read("--temperature", arguments.temperature, "K", 213.15, 573.15, TEMPERATURE)
    frequency: float | None = 0.0
    if arguments.frequency is not None:
        frequency = read("--frequency", arguments.frequency, "Hz", 0.0, 1e7, Display("kHz", 1e-3))
    if job is not None and temperature is not None:
        try:
            job.lubricant.at(temperature)
        except InputError as error:
            problems.extend(f"--temperature: {problem}" for problem in error.problems)
    if problems or job is None or load is None or speed is None or temperature is None or frequency is None:
        raise InputError(problems)
    return job, OperatingPoint(load, speed, temperature), length, frequency


def _is_of_unit(text: str, unit: str) -> bool:
    """Whether a quantity was given in a unit of this kind."""
    try:
        quantity(text, unit)
    except InputError:
        return False
    return True


def _film(
    solver: ContactSolver, contact: LineContact, oil: Lubricant, point: OperatingPoint, frequency: float
) -> FilmSolution:
    """Solve one contact."""
    (film,) = solver.solve_line(
        contact, oil, (point.load,), point.entrainment_speed, point.temperature, frequency=frequency
    )
    return film


def _record(
    film: FilmSolution, contact: LineContact, oil: Lubricant, point: OperatingPoint, frequency: float
) -> dict[str, Any]:
    """Return one contact's solution as plain values, SI; None where there is no number."""
    solution = contact_solution(film, contact, point, frequency)
    modulus = contact.reduced_modulus
    record: dict[str, Any] = {
        "contact": contact.name,
        "load_per_length": point.load,
        "entrainment_speed": point.entrainment_speed,
        "temperature": point.temperature,
        "frequency": frequency,
        **_groups(contact, oil, point),
        "hertz_half_width": hertz.half_width(point.load, contact.radius, modulus),
        "hertz_pressure": hertz.max_pressure(point.load, contact.radius, modulus),
        **_numbers(solution),
        "status": solution.status.word,
        "reason": solution.reason,
    }
    return {
        key: None if isinstance(value, float) and not math.isfinite(value) else value for key, value in record.items()
    }


def _numbers(solution: ContactSolution) -> dict[str, Any]:
    """Return the numbers of a solution; a hole has none."""
    values = {name: getattr(solution, name) for name in _SOLUTION_FIELDS}
    values["viscosity_extrapolated"] = int(solution.viscosity_extrapolated)
    return values


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


def _table(job: Job, records: list[dict[str, Any]], point: OperatingPoint, length: float | None) -> str:
    """Return the printed table: one column a contact, per length and, if known, times the length."""
    rows: list[tuple[str, str, list[Any]]] = list(_rows(records, length))
    law = job.contacts[0].structural_law
    header = f"{job.title}, {job.lubricant.title}, solver {job.solver}, structural law {law}"
    place = f"{LOAD.text(point.load)}, {_speed(job, point)}, {TEMPERATURE.text(point.temperature)}"
    if length is not None:
        place += f", slice of {LENGTH.text(length)} ({point.load * length:.5g} N)"
    lines = [header, place, f"{'':38s}" + "".join(f"{record['contact']:>14s}" for record in records)]
    for label, unit, values in rows:
        shown = "".join(f"{_shown(value):>14s}" for value in values)
        lines.append(f"  {label:22s} {unit:12s} {shown}")
    lines.extend(f"  {record['contact']}: {record['reason']}" for record in records if record["reason"])
    lines.extend(f"  {record['contact']}: {note}" for record in records if (note := _extrapolated(job, record)))
    return "\n".join(lines)


def _speed(job: Job, point: OperatingPoint) -> str:
    """Return the entrainment speed, and what it is of the inner ring of a bearing."""
    speed = f"{point.entrainment_speed:.6g} m/s"
    if job.bearing is None:
        return speed
    return f"{speed} (inner ring {RPM.text(job.bearing.inner_speed(point.entrainment_speed), 6)}, outer ring fixed)"


def _extrapolated(job: Job, record: dict[str, Any]) -> str:
    """Say that the pressure of a contact lies beyond the viscosity's fit; empty where it does not."""
    if not record["viscosity_extrapolated"]:
        return ""
    limit = PRESSURE.text(job.lubricant.fitted_pressure)
    return f"viscosity extrapolated: pressure above {limit}, to which it was fitted"


def _rows(records: list[dict[str, Any]], length: float | None) -> Iterator[tuple[str, str, list[Any]]]:
    """Yield label, unit and values of each line of the table."""

    def row(label: str, key: str, display: Display, times: float = 1.0) -> tuple[str, str, list[Any]]:
        values = [None if record[key] is None else display.value(record[key] * times) for record in records]
        return label, display.unit, values

    plain = Display("")
    yield "status", "", [record["status"] for record in records]
    yield row("M", "M", plain)
    yield row("L", "L", plain)
    yield row("Hertz half-width", "hertz_half_width", FILM)
    yield row("Hertz pressure", "hertz_pressure", PRESSURE)
    yield row("largest pressure", "max_pressure", PRESSURE)
    yield row("approach", "approach", FILM)
    yield row("film offset", "film_offset", FILM)
    yield row("central film", "central_film", FILM)
    yield row("minimum film", "minimum_film", FILM)
    yield row("stiffness k", "stiffness", Display("N/m2"))
    yield row("damping c", "damping", Display("N s/m2"))
    if length is not None:
        yield row("k x length", "stiffness", Display("N/m"), length)
        yield row("c x length", "damping", Display("N s/m"), length)
    for name in ERRORS:
        yield row(f"error of {name.removesuffix('_error').replace('_', ' ')}", name, plain)
    yield row("time to solve", "solve_seconds", Display("ms", 1e3))


def _shown(value: Any) -> str:
    """Return a value for the table."""
    if value is None:
        return "-"
    return value if isinstance(value, str) else f"{value:.5g}"
