"""`ehdmaps solve` of a ball bearing: both contacts at one load of a ball, solved, by CFD, or read from the table."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.choices import supply_from_text
from ehdmaps.compiling import stopwatch
from ehdmaps.errors import InputError, Problems
from ehdmaps.jobs.balls import balls_of
from ehdmaps.jobs.solve.contact_table import (
    Row,
    number_rows,
    records_json,
    rows_text,
    shown_with_error,
    with_errors,
)
from ehdmaps.jobs.solve.options import Options
from ehdmaps.outputs import FIGURE, Output, output_problems
from ehdmaps.physics.heat import INLET_HEAT, ISOTHERMAL, heat_data
from ehdmaps.physics.lubricant import DEFAULT_OIL, Lubricant
from ehdmaps.physics.oil_supply import FLOODED, PLAIN, FilmConditions
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.point.inlet_heat import heat_note
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import Estimate, Status
from ehdmaps.point.solver import PointResponse, PointSolution, heated_solution, solve
from ehdmaps.program import tell
from ehdmaps.units import DAMPER, FILM, LENGTH, PRESSURE, SPEED, SPRING, TEMPERATURE, Display, short

if TYPE_CHECKING:
    from ehdmaps.jobs.solve.cfd_points import CfdPoints

FORCE = Display("N")

NUMBERS = (
    ("largest pressure", "max_pressure", PRESSURE),
    ("approach", "approach", FILM),
    ("film offset", "film_offset", FILM),
    ("central film", "central_film", FILM),
    ("minimum film", "minimum_film", FILM),
    ("stiffness k", "stiffness", SPRING),
    ("damping c", "damping", DAMPER),
)
"""Lines of the table with an error: label, attribute of `PointSolution`, display."""

CONTACTS = ("inner", "outer")
"""Names of the contacts of a ball."""

SOLVED, TABLE = "solved", "table"
"""Films of the contacts, as films of [solver] says it of lines."""

REYNOLDS, OPENFOAM = "reynolds", "openfoam"
"""What solves them."""

_BESIDE = 0.1 * np.arange(-4.0, 5.0)
"""ln of loads beside one, by which the stiffness of a film on a layer is known."""

_FASTEST = 1e6 * math.pi / 30.0
_OF_LINES, _OF_CFD = ("length", "shear_stress", "slide_to_roll", "limiting_ratio", "shear"), ("fields", "keep_cases")
"""Options of line contacts, and of CFD."""


@dataclass(frozen=True)
class _Request:
    """Question: bearing, oil, load of a ball [N], speed [m/s], temperature [K], frequencies [Hz], films, picture.

    `cfd` is what solves them by OpenFOAM; None by `reynolds`.
    """

    bearing: BallGeometry
    oil: Lubricant
    load: float
    speed: float
    temperature: float
    frequencies: FloatArray | None
    films: str
    conditions: FilmConditions
    plot: Path | None
    cfd: CfdPoints | None


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Solve both contacts; status 1 if one of them has no solution.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of `ehdmaps solve`.
    """
    request = _read(arguments)
    solutions = {
        name: _contact(request, name, ellipse)
        for name, ellipse in zip(CONTACTS, request.bearing.contacts(STEEL), strict=True)
    }
    if request.plot is not None:
        from ehdmaps.jobs.solve.plots import points_figure, write_page

        write_page(request.plot, points_figure, solutions, _heading(request))
        tell(f"{request.plot}: written")
    text = (
        records_json(_record(request, *one) for one in solutions.items())
        if arguments.json
        else _table(request, solutions)
    )
    return text, 0 if all(solution.status.usable for solution in solutions.values()) else 1


def _contact(request: _Request, name: str, ellipse: Ellipse) -> PointSolution:
    """One contact, as the request asks."""
    point = (request.oil, request.load, request.speed, request.temperature)
    if request.cfd is not None:
        solution, said = request.cfd.solve(name, ellipse, *point)
        if said:
            tell(said)
        return solution
    if request.films == TABLE:
        return read_point(ellipse, *point, request.frequencies, request.conditions)
    solution = solve(ellipse, *point, request.frequencies)
    return heated_solution(solution, request.oil) if request.conditions.inlet_heat else solution


def read_point(
    ellipse: Ellipse,
    oil: Lubricant,
    load: float,
    speed: float,
    temperature: float,
    frequencies: FloatArray | None = None,
    conditions: FilmConditions = PLAIN,
) -> PointSolution:
    """A point as the table of points has it, with the words of a solution.

    Parameters
    ----------
    ellipse : Ellipse
        The contact.
    oil : Lubricant
        The oil.
    load, speed, temperature : float
        F [N], u [m/s], T [K].
    frequencies : ndarray, optional
        Frequencies of the response [Hz].
    conditions : FilmConditions
        Heat in the inlet, oil supply and surfaces; the response over frequency has heat alone.

    Raises
    ------
    InputError
        If a frequency is above those of the table.
    """
    from ehdmaps.table.points.file import shipped_point_table
    from ehdmaps.table.points.films import NUMBERS as KNOWN
    from ehdmaps.table.points.response import read_response

    seconds = stopwatch()
    loads = np.array([load]) if conditions.plain else load * np.exp(_BESIDE)
    at, heat = loads.size // 2, conditions.inlet_heat
    films = shipped_point_table().films(ellipse, oil, loads, speed, temperature, heat)
    if not conditions.plain and np.all(films.usable) and speed > 0.0:
        from ehdmaps.maps.points.layers import PointPlace, films_under

        films = films_under(PointPlace(ellipse, oil, speed, temperature), conditions, loads, films)
    numbers = {name: Estimate(float(getattr(films, name)[at]), float(films.errors[name][at])) for name in KNOWN}
    response = None
    if frequencies is not None and films.usable[at]:
        found = read_response(films, frequencies)
        if not np.all(np.isfinite(found.stiffness)):
            highest = float(films.frequencies[0, -1])
            raise InputError(
                f"--frequency: got {frequencies[-1]:.5g} Hz; allowed beside --films {TABLE}: up to {highest:.5g} Hz at "
                f"this load and speed, or --films {SOLVED}"
            )
        dynamic = found.stiffness + 2j * math.pi * frequencies * found.damping
        response = PointResponse(frequencies, dynamic, found.stiffness_error, found.damping_error)
    note = heat_note(ellipse, oil, load, speed, temperature) if conditions.inlet_heat and films.usable[at] else ""
    return PointSolution(
        Status(int(films.status[at])),
        "; ".join(filter(None, (str(films.reason[at]), note))),
        *(load, speed, temperature, ellipse),
        load_number=float(films.load_number[at]),
        oil_number=float(films.oil_number[at]),
        **numbers,  # type: ignore[arg-type]
        solve_seconds=seconds(),
        viscosity_extrapolated=bool(films.viscosity_extrapolated[at]),
        response=response,
    )


def _read(arguments: argparse.Namespace) -> _Request:
    """Read the arguments; all problems at once."""
    problems = Problems()
    if arguments.job is not None and arguments.bearing is not None:
        problems.append(f"--bearing: got {short(arguments.bearing)} beside a job; allowed: one of the two")
    read = Options(problems)
    read.refuse(arguments, _OF_LINES, "{}: is one of line contacts; allowed: without it for the balls of a bearing")
    if arguments.solver not in (None, REYNOLDS, OPENFOAM):
        problems.append(
            f"--solver: got {short(arguments.solver)}; allowed: {REYNOLDS}, {OPENFOAM} for the balls of a bearing"
        )
    by_cfd = arguments.solver == OPENFOAM
    if not by_cfd:
        read.refuse(arguments, _OF_CFD, f"{{}}: is one of OpenFOAM; allowed: with --solver {OPENFOAM}")
    else:
        beside = f"{{}}: stands beside --solver {OPENFOAM}, which has k and c of slow motion of a ball; allowed: "
        read.refuse(arguments, ("frequency",), f"{beside}--solver {REYNOLDS}")
        if arguments.films == TABLE:
            problems.append(f"--films: got {TABLE} beside --solver {OPENFOAM}; allowed: {SOLVED}")
    bearing: BallGeometry | None = None
    oil: Lubricant | None = None
    with problems:
        asked = arguments.job or arguments.bearing
        bearing = balls_of(asked) or ball_estimate(asked)
    with problems.after("--oil: "):
        oil = Lubricant.named(arguments.oil or DEFAULT_OIL)
    load = read.quantity("--load", arguments.load, "N", (0.0, 1e9), FORCE)
    speed = read.speed(arguments.speed, bearing, (0.0, 1e3), (0.0, _FASTEST))
    temperature = read.temperature(arguments.temperature, oil)
    frequencies = None if arguments.frequency is None else read.frequencies(arguments.frequency)
    films = SOLVED if arguments.films is None else arguments.films
    if films not in (SOLVED, TABLE):
        problems.append(f"--films: got {short(films)}; allowed: {SOLVED}, {TABLE}")
    if films == TABLE and arguments.plot is not None:
        problems.append(f"--plot: stands beside --films {TABLE}, which has no field; allowed: --films {SOLVED}")
    problems += output_problems([Output("--plot", arguments.plot, FIGURE)])
    supply = FLOODED
    if arguments.supply is not None:
        with problems.after("--supply: "):
            supply = supply_from_text(arguments.supply)
        if films != TABLE or frequencies is not None:
            problems.append(f"--supply: stands beside films that are solved, or a frequency; allowed: --films {TABLE}")
    physics = _physics(arguments, oil, problems)
    cfd = None
    if by_cfd:
        from ehdmaps.jobs.solve.cfd_points import cfd_points

        with problems:
            cfd = cfd_points(arguments.fields, arguments.keep_cases, CONTACTS)
    if problems or bearing is None or oil is None:
        raise InputError(problems)
    plot = None if arguments.plot is None else Path(arguments.plot)
    conditions = FilmConditions(physics == INLET_HEAT, supply)
    return _Request(bearing, oil, load, speed, temperature, frequencies, films, conditions, plot, cfd)


def _physics(arguments: argparse.Namespace, oil: Lubricant | None, problems: Problems) -> str:
    """Physics of the films by --physics: isothermal, or with heat in the inlet."""
    physics = getattr(arguments, "physics", None) or ISOTHERMAL
    if physics not in (ISOTHERMAL, INLET_HEAT):
        problems.append(
            f"--physics: got {short(physics)}; allowed for the balls of a bearing: {ISOTHERMAL}, {INLET_HEAT}"
        )
    if physics != INLET_HEAT:
        return physics
    beside = {
        "plot": "pressures and films in plan view are isothermal",
        "frequency": f"solved films over frequency are isothermal; --films {TABLE} has it",
    }
    for name, why in beside.items():
        if getattr(arguments, name) is not None and not (name == "frequency" and arguments.films == TABLE):
            problems.append(f"--physics: got {physics} beside --{name}; {why}; leave one of the two out")
    if arguments.solver == OPENFOAM:
        problems.append(f"--physics: got {physics} beside --solver {OPENFOAM}; allowed: --solver {REYNOLDS}")
    if oil is not None:
        with problems.after("--physics: "):
            heat_data(oil, STEEL)
    return physics


def _heading(request: _Request) -> str:
    """Bearing, oil and point in words."""
    by = "" if request.cfd is None else ", OpenFOAM"
    place = f"{FORCE.text(request.load)} a ball, {SPEED.text(request.speed)}, {TEMPERATURE.text(request.temperature)}"
    return f"{request.bearing.title}, {request.oil.title}{by}, {request.conditions.words}: {place}"


def _record(request: _Request, name: str, solution: PointSolution) -> dict[str, Any]:
    """Plain values of a contact."""
    a, b = solution.ellipse.semi_axes(solution.load)
    values: dict[str, Any] = {
        "contact": name,
        "load": solution.load,
        "entrainment_speed": solution.entrainment_speed,
        "temperature": solution.temperature,
        "ellipticity": solution.ellipse.ellipticity,
        "M": solution.load_number,
        "L": solution.oil_number,
        "hertz_semi_axes": [a, b],
        "hertz_pressure": solution.ellipse.max_pressure(solution.load),
        **with_errors(solution, [attribute for _, attribute, _ in NUMBERS]),
        "steps": solution.steps,
        "solve_seconds": solution.solve_seconds,
        "viscosity_extrapolated": solution.viscosity_extrapolated,
        "films": request.conditions.words,
        "status": solution.status.word,
        "reason": solution.reason,
    }
    if solution.response is not None:
        response = solution.response
        values["frequency"] = response.frequencies.tolist()
        for key in ("stiffness", "damping", "stiffness_error", "damping_error"):
            values[f"{key}_over_frequency"] = getattr(response, key).tolist()
    return values


def _table(request: _Request, solutions: dict[str, PointSolution]) -> str:
    """The printed table: a column a contact, each number with its error."""
    found = list(solutions.values())
    axes = [solution.ellipse.semi_axes(solution.load) for solution in found]
    pressures = [PRESSURE.value(float(solution.ellipse.max_pressure(solution.load))) for solution in found]
    plain, how = Display(""), "read" if request.films == TABLE else "solve"
    rows: list[Row] = [
        ("status", "", [solution.status.word for solution in found]),
        ("ellipticity", "", [f"{solution.ellipse.ellipticity:.4g}" for solution in found]),
        ("M", "", [shown_with_error(solution.load_number, math.nan, plain) for solution in found]),
        ("L", "", [shown_with_error(solution.oil_number, math.nan, plain) for solution in found]),
        ("Hertz semi-axes", LENGTH.unit, [f"{LENGTH.value(a):.4g} x {LENGTH.value(b):.4g}" for a, b in axes]),
        ("Hertz pressure", PRESSURE.unit, [f"{pressure:.4g}" for pressure in pressures]),
        *number_rows(found, NUMBERS),
        (f"processor time to {how}", "ms", [f"{1e3 * solution.solve_seconds:.3g}" for solution in found]),
    ]
    more: list[str] = []
    for name, solution in solutions.items():
        if solution.reason:
            more.append(f"{name}: {solution.reason}")
        if solution.viscosity_extrapolated:
            more.append(f"{name}: viscosity extrapolated: pressure above {request.oil.reach}")
        if solution.response is not None:
            more += ["", *_over_frequency(name, solution)]
    return rows_text([_heading(request), request.bearing.estimated], solutions, rows, more)


def _over_frequency(name: str, solution: PointSolution) -> list[str]:
    """Lines of a contact over frequency."""
    response = solution.response
    assert response is not None
    lines = [f"{name}: {'frequency, Hz':>14s}{f'k, {SPRING.unit}':>24s}{f'c, {DAMPER.unit}':>24s}"]
    columns = (response.stiffness, response.stiffness_error, response.damping, response.damping_error)
    for frequency, k, k_error, c, c_error in zip(response.frequencies, *columns, strict=True):
        lines.append(
            f"{frequency:21.5g}{shown_with_error(k, k_error, SPRING):>24s}{shown_with_error(c, c_error, DAMPER):>24s}"
        )
    return lines
