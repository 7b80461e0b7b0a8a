"""`ehdmaps solve`: one operating point of every contact of a job, at rest or over frequency."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.choices import supply_from_text
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError, Problems
from ehdmaps.jobs import solvers
from ehdmaps.jobs.estimate_bands import band_lines
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.problem import RING_SPEED_AXIS, SPEED_AXIS
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.solve.contact_table import records_json
from ehdmaps.jobs.solve.film_output import film_outputs
from ehdmaps.jobs.solve.options import HERTZ, Options, of_unit
from ehdmaps.jobs.solve.point_report import point_place, point_record, point_table, supplied_record, supplied_table
from ehdmaps.jobs.solve.spectrum import spectrum_dataset, spectrum_record, spectrum_table
from ehdmaps.jobs.solve.traction import (
    LEAST_SLIP,
    MOST_SLIP,
    MOST_SLIPS,
    STRESS,
    TractionRequest,
    solve_traction,
    traction_record,
    traction_table,
)
from ehdmaps.outputs import FIGURE, Output, check_outputs
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.rheology import EYRING_STRESS, LIMITING_RATIO
from ehdmaps.physics.solution import ContactSolution, ContactSolver, FilmSolution, Status, contact_solution
from ehdmaps.physics.spectrum import HIGHEST_FREQUENCY, LOWEST_FREQUENCY, contact_spectrum
from ehdmaps.program import tell
from ehdmaps.units import LENGTH, LOAD, Display

_BESIDE = "stands beside {}; allowed: one of the two; delete one"


@dataclass(frozen=True)
class _Request:
    """Request for a solve; length [m], frequencies [Hz], slips and supply are None where they are not given."""

    job: Job
    point: OperatingPoint
    length: float | None
    frequencies: FloatArray | None
    traction: TractionRequest | None
    supply: OilSupply | None


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Solve the point for every contact; status 1 if one of them has no solution."""
    request = _read(arguments)
    if len(arguments.frequency or ()) > 1:
        return _over_frequency(arguments, request)
    job, point = request.job, request.point
    outputs = film_outputs(job, arguments.fields, arguments.plot, arguments.job)
    solver = _solver(arguments, job)
    beside: Sequence[Mapping[str, Any]] = [{}] * len(job.contacts)
    table, films = "", list[FilmSolution]()
    if outputs:
        films, written = outputs.solve(solver, job, point)
        for line in written:
            tell(line)
        solutions = [contact_solution(film, contact, point) for film, contact in zip(films, job.contacts, strict=True)]
    elif request.traction is not None or request.supply is not None:
        films, beside, table = _with_more(solver, request)
        solutions = [contact_solution(film, contact, point) for film, contact in zip(films, job.contacts, strict=True)]
    else:
        solutions = [_solved(solver, contact, request) for contact in job.contacts]
    frequency = 0.0 if request.frequencies is None else float(request.frequencies[0])
    records = [
        point_record(solution, contact, job, point, frequency)
        for solution, contact in zip(solutions, job.contacts, strict=True)
    ]
    if arguments.json:
        return records_json({**one, **more} for one, more in zip(records, beside, strict=True)), _exit_status(records)
    bands = band_lines(job, point) if job.tolerances and frequency == 0.0 and not table else ()
    lines = [point_table(job, records, point, request.length), *filter(None, [table]), *bands]
    return "\n".join(lines), _exit_status(records)


def _over_frequency(arguments: argparse.Namespace, request: _Request) -> tuple[str, int]:
    """Solve each contact once and tell its response at all frequencies."""
    job, point = request.job, request.point
    assert request.frequencies is not None
    check_outputs([Output("--plot", arguments.plot, FIGURE)], [arguments.job])
    solver = _solver(arguments, job)
    dataset = spectrum_dataset(job.contacts, job.lubricant, point, request.frequencies, solver)
    if arguments.plot is not None:
        from ehdmaps.jobs.solve.plots import spectrum_figure, write_page

        write_page(Path(arguments.plot), spectrum_figure, dataset, f"{job.title}, {job.lubricant.title}")
        tell(f"{arguments.plot}: written")
    records = [
        {
            "contact": contact.name,
            **point_place(contact, job.lubricant, point),
            **spectrum_record(dataset, contact.name),
        }
        for contact in job.contacts
    ]
    text = records_json(records) if arguments.json else spectrum_table(job, dataset, request.length)
    return text, _exit_status(records)


def _with_more(solver: ContactSolver, request: _Request) -> tuple[list[FilmSolution], Sequence[Mapping[str, Any]], str]:
    """Films with their traction over the slip, or behind an oil layer; what that adds to their records, and a table."""
    assert isinstance(solver, ReynoldsSolver)
    job, slips, supply = request.job, request.traction, request.supply
    at, names = (job.lubricant, request.point), [contact.name for contact in job.contacts]
    if slips is not None:
        films, coefficients = zip(*(solve_traction(solver, one, *at, slips) for one in job.contacts), strict=True)
        table = traction_table(slips, dict(zip(names, coefficients, strict=True)))
        return list(films), [traction_record(slips, mu) for mu in coefficients], table
    assert supply is not None
    found = [solver.supplied_film(contact, *at, supply) for contact in job.contacts]
    table = supplied_table(supply, dict(zip(names, found, strict=True)))
    return [one.film for one in found], [supplied_record(supply, one) for one in found], table


def _exit_status(records: list[dict[str, Any]]) -> int:
    """1 if a contact has no solution."""
    return 0 if all(Status[str(record["status"]).upper()].usable for record in records) else 1


def _solver(arguments: argparse.Namespace, job: Job) -> ContactSolver:
    """The job's solver, which keeps its cases where it is asked to."""
    return solvers.build(job.solver, {**job.solver_options, **solvers.case_options(job.solver, arguments.keep_cases)})


def _solved(solver: ContactSolver, contact: LineContact, request: _Request) -> ContactSolution:
    """Solve one contact, at a frequency if there is one."""
    point, oil = request.point, request.job.lubricant
    if request.frequencies is None:
        (film,) = solver.solve_line(contact, oil, (point.load,), point.entrainment_speed, point.temperature)
        return contact_solution(film, contact, point)
    return contact_spectrum(solver.film_spectrum(contact, oil, point, request.frequencies), contact, point).at(0)


def _read(arguments: argparse.Namespace) -> _Request:
    """Read job, point, length and frequencies; all problems at once."""
    problems = Problems()
    job: Job | None = None
    if arguments.films is not None:
        problems.append("--films: is one of the balls of a bearing; allowed: films = ... of [solver] in a job")
    with problems:
        job = read_job(arguments.job, arguments.solver, to_run=True)

    read = Options(problems)
    # of a load that does not read nobody knows whether it needs a length
    total = of_unit(arguments.load, "N")
    if not total and arguments.length is not None:
        total = not of_unit(arguments.load, "N/m")
    length: float | None = None
    if arguments.length is not None:
        length = read.quantity("--length", arguments.length, "m", (1e-6, 100.0), LENGTH)
    elif total:
        problems.append('--length: missing; a load in N needs the length that carries it; or give --load in "N/mm"')
    if not total:
        load = read.quantity("--load", arguments.load, "N/m", (1.0, 1e7), LOAD)
    else:
        load = read.quantity("--load", arguments.load, "N", (1e-6, 1e9), Display("N")) / (length or math.nan)
        if math.isfinite(load) and not 1.0 <= load <= 1e7:
            problems.append(
                f"--load over --length: got {LOAD.text(load)}; allowed: {LOAD.text(1.0)} to {LOAD.text(1e7)}"
            )
    bearing, speeds = None if job is None else job.bearing, (SPEED_AXIS.low, SPEED_AXIS.high)
    if job is not None and bearing is None and of_unit(arguments.speed, "rad/s"):
        problems.append(
            f"--speed: got {arguments.speed!r:.60}; allowed: m/s, since the job has a bare contact; rpm are those of "
            "the inner ring of a bearing"
        )
    fastest = math.inf if bearing is None else bearing.inner_speed(SPEED_AXIS.high)
    speed = read.speed(arguments.speed, bearing, speeds, (RING_SPEED_AXIS.low, fastest))
    temperature = read.temperature(arguments.temperature, None if job is None else job.lubricant)
    frequencies = None if arguments.frequency is None else _frequencies(arguments, read, problems)
    if job is not None:
        job = _with_stated(arguments, job, problems)
    traction = _traction(arguments, job, read, problems)
    supply = _supply(arguments, job, read, problems)
    if problems or job is None:
        raise InputError(problems)
    return _Request(job, OperatingPoint(load, speed, temperature), length, frequencies, traction, supply)


def _with_stated(arguments: argparse.Namespace, job: Job, problems: Problems) -> Job:
    """The job with physics, law of shear and sliding of the command line."""
    given = {key: getattr(arguments, key) for key in ("physics", "shear")}
    if _slips(arguments) == 1:
        (given["slide_to_roll"],) = arguments.slide_to_roll
    if _slips(arguments) < 2:
        given |= {key: getattr(arguments, key) for key in ("shear_stress", "limiting_ratio")}
    texts = {key: text for key, text in given.items() if text is not None}
    return replace(job, solver_options={**job.solver_options, **solvers.stated(job.solver, texts, problems)})


def _slips(arguments: argparse.Namespace) -> int:
    """Number of values that --slide-to-roll has."""
    return len(arguments.slide_to_roll or ())


def _frequencies(arguments: argparse.Namespace, read: Options, problems: Problems) -> FloatArray | None:
    """The frequencies of --frequency; None where a problem was noted, and for 0 Hz, the limit of slow motion."""
    if len(arguments.frequency) > 1:
        if arguments.fields is not None:
            problems.append("--fields: stands beside --frequency, but fields are at rest; delete one")
        return read.frequencies(arguments.frequency)
    if arguments.fields is not None or arguments.plot is not None:
        problems.append("--frequency: stands beside --fields or --plot, whose film is at rest; leave it out")
    (text,) = arguments.frequency
    value = read.quantity("--frequency", text, "Hz", (0.0, HIGHEST_FREQUENCY), HERTZ)
    if 0.0 < value < LOWEST_FREQUENCY:
        problems.append(
            f"--frequency: got {text!r}; allowed: 0 Hz, the limit of slow motion, and "
            f"{HERTZ.text(LOWEST_FREQUENCY)} to {HERTZ.text(HIGHEST_FREQUENCY)}"
        )
    return np.array([value]) if value else None


def _traction(
    arguments: argparse.Namespace, job: Job | None, read: Options, problems: Problems
) -> TractionRequest | None:
    """Slips and stresses of --slide-to-roll FROM TO POINTS; None where there are none, or a problem was noted."""
    option, before = "--slide-to-roll", len(problems)
    if _slips(arguments) not in (0, 1, 3):
        problems.append(f"{option}: got {_slips(arguments)} values; allowed: one ratio, or FROM TO POINTS")
        return None
    if _slips(arguments) < 3:
        return None
    if job is not None and (words := solvers.solver_words(job.solver_options)):
        problems.append(
            f"{option}: got FROM TO POINTS beside {words[2:]}; traction over the ratio is that of isothermal, "
            "newtonian films of pure rolling; allowed: one ratio, with which the film is solved"
        )
    if job is not None and job.solver != "reynolds":
        problems.append(f"{option}: the solver {job.solver!r} keeps no film for it; allowed: with --solver reynolds")
    read.refuse(arguments, ("frequency", "fields", "plot"), f"{option}: {_BESIDE}")
    ratios = read.spaced(
        option, arguments.slide_to_roll, lambda text: read.number(option, text, LEAST_SLIP, MOST_SLIP), MOST_SLIPS
    )
    eyring, ratio = EYRING_STRESS, LIMITING_RATIO
    if arguments.shear_stress is not None:
        eyring = read.quantity("--shear-stress", arguments.shear_stress, "Pa", (1e5, 1e9), STRESS)
    if arguments.limiting_ratio is not None:
        ratio = read.number("--limiting-ratio", arguments.limiting_ratio, 1e-3, 1.0)
    return None if len(problems) > before or ratios is None else TractionRequest(ratios, eyring, ratio)


def _supply(arguments: argparse.Namespace, job: Job | None, read: Options, problems: Problems) -> OilSupply | None:
    """Supply of --supply; None where there is none, or a problem was noted."""
    if arguments.supply is None:
        return None
    if job is not None and job.solver != "reynolds":
        problems.append(f"--supply: the solver {job.solver!r} knows no meniscus; allowed: with --solver reynolds")
    elif job is not None and (words := solvers.solver_words(job.solver_options)):
        problems.append(
            f"--supply: stands beside {words[2:]}; allowed: with isothermal, newtonian films of pure rolling"
        )
    read.refuse(arguments, ("frequency", "slide_to_roll", "fields", "plot"), f"--supply: {_BESIDE}")
    with problems.after("--supply: "):
        return supply_from_text(arguments.supply)
    return None
