"""`ehdmaps solve --solver roller`: whole rollers with their profile, so also the film at their ends."""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.problem import SPEED_AXIS
from ehdmaps.jobs.profiles import RollerProfile, profile_from_text
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.solve.ball_points import FORCE, shown_with_error, with_errors
from ehdmaps.jobs.solve.options import option_reader
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.physics.surface import iso_profile
from ehdmaps.point.finite_roller import FiniteRoller, RollerSolution, solve_roller
from ehdmaps.units import DAMPER, FILM, LENGTH, PRESSURE, RPM, SPEED, SPRING, TEMPERATURE

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
    text = _json(solutions) if arguments.json else _table(request, solutions)
    return text, 0 if all(solution.status.usable for solution in solutions.values()) else 1


def _named(name: str, bearing: BearingGeometry, places: FloatArray) -> FloatArray:
    """Depths of a profile by its name."""
    if name == "straight":
        return np.zeros_like(places)
    return iso_profile(places, bearing.roller_diameter, bearing.roller_length)


def _read(arguments: argparse.Namespace) -> _Request:
    """Read the arguments; all problems at once."""
    problems: list[str] = []
    for name in (*_REFUSED, *_REFUSED_TOO):
        if getattr(arguments, name, None) is not None:
            problems.append(f"--{name.replace('_', '-')}: not with --solver {NAME}; leave it out")
    job: Job | None = None
    try:
        job = read_job(arguments.job)
    except InputError as error:
        problems.extend(error.problems)
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

    read = option_reader(problems, math.nan)

    load = read("--load", arguments.load, "N", 1e-3, 1e9, FORCE)
    if any(unit in arguments.speed for unit in ("rpm", "rad")):
        ring = read("--speed", arguments.speed, "rad/s", 1e-3, 1e6, RPM)
        speed = bearing.entrainment_speed(ring) if bearing is not None else math.nan
    else:
        speed = read("--speed", arguments.speed, "m/s", SPEED_AXIS.low, SPEED_AXIS.high, SPEED)
    temperature = read("--temperature", arguments.temperature, "K", *OIL_TEMPERATURES, TEMPERATURE)
    if job is not None and math.isfinite(temperature):
        try:
            job.lubricant.at(temperature)
        except InputError as error:
            problems.extend(f"--temperature: {problem}" for problem in error.problems)
    if problems or job is None or bearing is None:
        raise InputError(problems)
    return _Request(job, bearing, profile, load, speed, temperature)


def _json(solutions: dict[str, RollerSolution]) -> str:
    """One object a contact, SI; None where there is no number."""
    records = []
    for name, found in solutions.items():
        values: dict[str, Any] = {
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
        none = [key for key, value in values.items() if isinstance(value, float) and math.isnan(value)]
        records.append(values | dict.fromkeys(none))
    return json.dumps(records, indent=2, allow_nan=False)


def _table(request: _Request, solutions: dict[str, RollerSolution]) -> str:
    """The printed table: a column a contact, each number with its error."""
    found, bearing = list(solutions.values()), request.bearing
    rows: list[tuple[str, str, list[str]]] = [("status", "", [each.status.word for each in found])]
    for label, name, display in NUMBERS:
        shown = [shown_with_error(getattr(each, name), getattr(each, name).error, display) for each in found]
        rows.append((label, display.unit, shown))
        if name == "minimum_film":
            places = [shown_with_error(each.minimum_place, math.nan, LENGTH) for each in found]
            rows.append(("off the middle by", LENGTH.unit, places))
    rows.append(("dry k", SPRING.unit, [shown_with_error(each.dry_stiffness, math.nan, SPRING) for each in found]))
    rows.append(("processor time to solve", "s", [f"{each.solve_seconds:.3g}" for each in found]))
    place = f"{FORCE.text(request.load)} a roller, {SPEED.text(request.speed)}, {TEMPERATURE.text(request.temperature)}"
    lines = [
        f"{request.job.title}, {request.job.lubricant.title}: {place}",
        f"rollers of {LENGTH.value(bearing.roller_diameter):.4g} x {LENGTH.text(bearing.roller_length)}, profile "
        f"{request.profile}, half-spaces",
    ]
    if bearing.estimated:
        lines.append(bearing.estimated)
    lines += [f"  {'':18s}{'':8s}" + "".join(f"{name:>24s}" for name in solutions)]
    lines += [f"  {label:18s}{unit:8s}" + "".join(f"{value:>24s}" for value in shown) for label, unit, shown in rows]
    lines += [f"{name}: {each.reason}" for name, each in solutions.items() if each.reason]
    return "\n".join(line.rstrip() for line in lines)
