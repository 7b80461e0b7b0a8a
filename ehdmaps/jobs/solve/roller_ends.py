"""`ehdmaps solve --solver roller`: whole rollers with their profile, so also the film at their ends."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.problem import SPEED_AXIS
from ehdmaps.jobs.profiles import RollerProfile, profile_from_text
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.solve.ball_points import FORCE
from ehdmaps.jobs.solve.contact_table import (
    Row,
    number_rows,
    records_json,
    rows_text,
    shown_with_error,
    with_errors,
)
from ehdmaps.jobs.solve.options import Options
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.surface import iso_profile
from ehdmaps.point.finite_roller import FiniteRoller, RollerSolution, solve_roller
from ehdmaps.units import DAMPER, FILM, LENGTH, PRESSURE, SPEED, SPRING, TEMPERATURE

NAME = "roller"
"""Word of --solver; behind a colon a profile, as `mbs bearing --profile` has it."""

NUMBERS = (
    ("largest pressure", "max_pressure", PRESSURE),
    ("film offset", "film_offset", FILM),
    ("central film", "central_film", FILM),
    ("smallest, middle", "middle_film", FILM),
    ("smallest film", "minimum_film", FILM),
    ("stiffness k", "stiffness", SPRING),
    ("damping c", "damping", DAMPER),
)
"""Lines of the table with an error: label, attribute of `RollerSolution`, display."""

_ROUND_OFF = 1e-9
_PLACES = 101
_REFUSED = ("length", "frequency", "physics", "shear", "shear_stress", "slide_to_roll", "limiting_ratio")
_REFUSED_TOO = ("films", "keep_cases", "fields", "plot", "supply")


@dataclass(frozen=True)
class _Request:
    """Question: job, bearing, profile, load of a roller [N], speed [m/s], temperature [K]."""

    job: Job
    bearing: BearingGeometry
    profile: RollerProfile
    load: float
    speed: float
    temperature: float


def is_roller(solver: str | None) -> bool:
    """Tell whether --solver asks for whole rollers.

    Parameters
    ----------
    solver : str or None
        The option as it was typed.
    """
    return solver is not None and solver.partition(":")[0] == NAME


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Solve both contacts of a roller; status 1 if one of them has no solution.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of `ehdmaps solve`.
    """
    request = _read(arguments)
    bearing = request.bearing
    depth = request.profile if callable(request.profile) else partial(_named, request.profile, bearing)
    solutions = {
        contact.name: solve_roller(
            FiniteRoller(contact.radius, bearing.roller_length, contact.reduced_modulus, depth),
            request.job.lubricant,
            request.load,
            request.speed,
            request.temperature,
        )
        for contact in request.job.contacts
    }
    text = records_json(_record(*one) for one in solutions.items()) if arguments.json else _table(request, solutions)
    return text, 0 if all(solution.status.usable for solution in solutions.values()) else 1


def _named(name: str, bearing: BearingGeometry, places: FloatArray) -> FloatArray:
    """Depths of a profile by its name."""
    if name == "straight":
        return np.zeros_like(places)
    return iso_profile(places, bearing.roller_diameter, bearing.roller_length)


def _read(arguments: argparse.Namespace) -> _Request:
    """Read the arguments; all problems at once."""
    problems = Problems()
    read = Options(problems)
    read.refuse(arguments, (*_REFUSED, *_REFUSED_TOO), f"{{}}: not with --solver {NAME}; leave it out")
    job: Job | None = None
    with problems:
        job = read_job(arguments.job)
    bearing = None if job is None else job.bearing
    if job is not None and bearing is None:
        problems.append(f"--solver {NAME}: got a job of a bare [contact]; allowed: one with [bearing], or --bearing")
    noted: list[str] = []
    profile = profile_from_text(arguments.solver.partition(":")[2] or "iso", bearing, noted)
    problems += [problem.replace("--profile", f"--solver {NAME}", 1) for problem in noted]
    if callable(profile) and bearing is not None and not noted:
        places = np.linspace(0.0, 0.5 * bearing.roller_length, _PLACES)
        if np.max(np.abs(profile(places) - profile(-places))) > _ROUND_OFF * bearing.roller_diameter:
            problems.append(f"--solver {NAME}: got a profile that differs on both sides; allowed: alike on both")

    load = read.quantity("--load", arguments.load, "N", (1e-3, 1e9), FORCE)
    speed = read.speed(arguments.speed, bearing, (SPEED_AXIS.low, SPEED_AXIS.high), (1e-3, 1e6))
    temperature = read.temperature(arguments.temperature, None if job is None else job.lubricant)
    if problems or job is None or bearing is None:
        raise InputError(problems)
    return _Request(job, bearing, profile, load, speed, temperature)


def _record(name: str, found: RollerSolution) -> dict[str, Any]:
    """Plain values of a contact, SI."""
    return {
        "contact": name,
        "load": found.load,
        "entrainment_speed": found.entrainment_speed,
        "temperature": found.temperature,
        "M": found.load_number,
        "L": found.oil_number,
        **with_errors(found, [attribute for _, attribute, _ in NUMBERS]),
        "minimum_place": found.minimum_place,
        "dry_stiffness": found.dry_stiffness,
        "film_compliance": found.film_compliance,
        "film_compliance_error": found.film_compliance.error,
        "steps": found.steps,
        "solve_seconds": found.solve_seconds,
        "status": found.status.word,
        "reason": found.reason,
    }


def _table(request: _Request, solutions: dict[str, RollerSolution]) -> str:
    """The printed table: a column a contact, each number with its error."""
    found, bearing = list(solutions.values()), request.bearing
    numbers = number_rows(found, NUMBERS)
    off_middle = [name for _, name, _ in NUMBERS].index("minimum_film") + 1
    rows: list[Row] = [
        ("status", "", [each.status.word for each in found]),
        *numbers[:off_middle],
        ("off the middle by", LENGTH.unit, [shown_with_error(each.minimum_place, math.nan, LENGTH) for each in found]),
        *numbers[off_middle:],
        ("dry k", SPRING.unit, [shown_with_error(each.dry_stiffness, math.nan, SPRING) for each in found]),
        ("processor time to solve", "s", [f"{each.solve_seconds:.3g}" for each in found]),
    ]
    place = f"{FORCE.text(request.load)} a roller, {SPEED.text(request.speed)}, {TEMPERATURE.text(request.temperature)}"
    head = [
        f"{request.job.title}, {request.job.lubricant.title}: {place}",
        f"rollers of {LENGTH.value(bearing.roller_diameter):.4g} x {LENGTH.text(bearing.roller_length)}, profile "
        f"{request.profile}, half-spaces",
        bearing.estimated,
    ]
    reasons = [f"{name}: {each.reason}" for name, each in solutions.items() if each.reason]
    return rows_text(head, solutions, rows, reasons)
