"""`ehdmaps solve`: one operating point of every contact of a job."""

from __future__ import annotations

import argparse
import json

from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.axes import RING_SPEED_AXIS, SPEED_AXIS
from ehdmaps.jobs.film_output import film_outputs
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.point_report import point_record, point_table
from ehdmaps.jobs.reader import read_job
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.operating_point import OIL_TEMPERATURES, OperatingPoint
from ehdmaps.physics.solution import ContactSolver, FilmSolution, Status
from ehdmaps.program import tell
from ehdmaps.units import LENGTH, LOAD, RPM, SPEED, TEMPERATURE, Display, quantity


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
        point_record(film, contact, job.lubricant, point, frequency)
        for film, contact in zip(films, job.contacts, strict=True)
    ]
    usable = all(Status[str(record["status"]).upper()].usable for record in records)
    text = (
        json.dumps(records, indent=2, allow_nan=False) if arguments.json else point_table(job, records, point, length)
    )
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
    temperature = read("--temperature", arguments.temperature, "K", *OIL_TEMPERATURES, TEMPERATURE)
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
