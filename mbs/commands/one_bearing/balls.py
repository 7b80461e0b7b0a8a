"""`mbs bearing` of a ball bearing: deep groove or angular contact, by its designation; every problem at once."""

from __future__ import annotations

import argparse
import dataclasses
import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ehdmaps.errors import AnalysisError, InputError, SolverError
from ehdmaps.outputs import output_problems
from ehdmaps.physics.lubricant import DEFAULT_OIL, Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.film_formulas import POINT_FILMS
from ehdmaps.physics.solids import STEEL
from ehdmaps.program import tell
from ehdmaps.units import RPM, SPEED, TEMPERATURE
from mbs.analyses.bearing_point import points_over, without_holes
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_point import BallPoint, ball_point
from mbs.bearings.balls.laws import BallLaw, dry_law
from mbs.commands.one_bearing.ball_files import BallExport, has_memory, write_export
from mbs.commands.one_bearing.bearing_files import bearing_outputs, is_export
from mbs.commands.one_bearing.linear_files import count_problems
from mbs.commands.one_bearing.shared import (
    CELSIUS_40,
    assumed_clearance,
    read_damper,
    read_oil,
    read_surface,
    refuse_others,
)
from mbs.commands.one_bearing.values import (
    LOADS,
    MOST_POINTS,
    SPEEDS,
    read_choices,
    read_direction,
    read_one,
    read_values,
)
from mbs.model.findings import Cause, Finding
from mbs.output.ball_table import BallDescription, ball_dataset, ball_text, write_ball_csv
from mbs.output.files import write_dataset
from mbs.scene.contact_laws import Damper
from mbs.scene.fields import FORCE
from mbs.scene.map_set import TABLE_LAW

if TYPE_CHECKING:
    from mbs.bearings.balls.films import BallFilms

FILMS = "films"
"""Law of contacts with films that are read from the table of points, and solved where it has none; `table` reads."""

_TAKEN = ("law", "clearance", "temperature", "roughness", "films")
"""Choices that ball bearings take."""


@dataclass(frozen=True, eq=False)
class BallRequest:
    """Request to be answered.

    Attributes
    ----------
    force : BallForce
        Geometry with its clearance, and its dry law.
    films : str
        `FILMS`, `table`, or empty where the law is dry.
    by_default : bool
        Whether films are those of the default: speeds without any are dry then, and say why.
    oil : Lubricant
        Oil of the films.
    loads : tuple of float
        Sizes of the radial load on the inner ring [N].
    axial : float
        Axial load on the inner ring [N].
    way : (float, float)
        Direction of the radial load, y and z; a unit vector.
    speeds : tuple of float
        Speeds of the inner ring [rad/s].
    outer_speed : float
        Speed of the outer ring [rad/s].
    memory : bool
        Whether the films of a file for another program have a memory.
    description : BallDescription
        The same in words.
    """

    force: BallForce
    films: str
    by_default: bool
    oil: Lubricant
    loads: tuple[float, ...]
    axial: float
    way: tuple[float, float]
    speeds: tuple[float, ...]
    outer_speed: float
    memory: bool
    description: BallDescription


def read_balls(arguments: argparse.Namespace) -> BallRequest:
    """Read the bearing and all options.

    Raises
    ------
    InputError
        With every problem.
    """
    problems: list[str] = []
    geometry = _geometry(arguments.bearing, problems)
    chosen = read_choices(arguments, problems)
    refuse_others(arguments, list(chosen), _TAKEN, "ball bearing", problems)
    axial = read_one("--axial", arguments.axial, "N", (-LOADS[1], LOADS[1]), FORCE, 0.0, problems)
    least = 0.0 if axial else LOADS[0]
    loads = read_values("--load", arguments.load, "N", (least, LOADS[1]), FORCE, problems)
    speeds = read_values("--speed", arguments.speed, "rad/s", SPEEDS, RPM, problems)
    limits = (-SPEEDS[1], SPEEDS[1])
    outer = read_one("--outer-speed", arguments.outer_speed, "rad/s", limits, RPM, 0.0, problems)
    if len(loads) * len(speeds) > MOST_POINTS:
        problems.append(f"--load, --speed: got {len(loads) * len(speeds)} points; allowed: at most {MOST_POINTS}")
    way = read_direction(arguments.direction, problems)
    law = chosen.get("law", TABLE_LAW)
    films = law if law in (FILMS, TABLE_LAW) else ""
    more = f", {FILMS}, {TABLE_LAW}; maps are of line contacts"
    if "films" in chosen and not (films and has_memory(arguments.output)):
        problems.append(
            f"--films: got {chosen['films']!r} for a ball bearing; allowed: with --law {TABLE_LAW} and -o NAME.c, "
            "NAME.fmu, NAME.toml"
        )
    damper = Damper() if films else read_damper(law, "ball bearing", more, problems)
    temperature = float(chosen.get("temperature", CELSIUS_40))
    oil = read_oil(arguments.oil, temperature, problems)
    clearance = chosen.get("clearance")
    if geometry is not None and clearance is not None:
        try:
            geometry = geometry.with_clearance(float(clearance))
        except InputError as error:
            problems += [f"--clearance: {problem}" for problem in error.problems]
    problems += output_problems(bearing_outputs(arguments.output), [])
    one_load = is_export(arguments.output)
    problems += count_problems(arguments.output, len(loads), len(speeds), of_one_load=one_load)
    if problems or geometry is None or damper is None or oil is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    _, roughness, for_lambda = read_surface(chosen)
    assumed = [
        *([f"temperature {TEMPERATURE.text(CELSIUS_40)}"] if "temperature" not in chosen else []),
        *for_lambda,
        *assumed_clearance(geometry, clearance is not None),
        *([f"oil {DEFAULT_OIL}"] if arguments.oil is None else []),
    ]
    dry = dry_law(geometry, STEEL, damper.constant, damper.time)
    source = {FILMS: "read from the film table, or solved", TABLE_LAW: "read from the film table"}
    return BallRequest(
        force=BallForce(geometry, dry),
        films=films,
        by_default="law" not in chosen,
        oil=oil,
        loads=loads,
        axial=axial,
        way=way,
        speeds=speeds,
        outer_speed=outer,
        memory=chosen.get("films") == "memory",
        description=BallDescription(
            law=f"films of {oil.title}, {POINT_FILMS}, {source[films]}"
            if films
            else "dry Hertz" + (f", {damper.words} of each contact" if damper.words else ""),
            films=(
                "films of the law"
                if films
                else f"films by the formula of Hamrock and Dowson, {oil.title}, {POINT_FILMS}"
            )
            + ("" if oil.verified else " (unverified data of the oil)"),
            direction=math.degrees(math.atan2(way[1], way[0])),
            temperature=temperature,
            roughness=roughness,
            tilts=arguments.tilts,
            assumed=tuple(assumed),
        ),
    )


def run_balls(arguments: argparse.Namespace) -> tuple[str, int]:
    """Compute all points, describe and write them; status 1 where one is outside of what the laws hold for."""
    request = read_balls(arguments)
    points = ball_points(request)
    lines = ball_text(request.description, points)
    if arguments.output:
        lines.append(_written(arguments.output, request, points))
    return "\n".join(lines), 1 if any(point.problems for row in points for point in row) else 0


def _written(path: str, request: BallRequest, points: list[list[BallPoint]]) -> str:
    """Write the file of -o, and return what was written in words."""
    if is_export(path):
        try:
            return write_export(path, _exported(request, without_holes(path, points[0])))
        except SolverError as error:
            raise AnalysisError(f"-o {path}: {error}") from error
    dataset = ball_dataset(request.description, points)
    if Path(path).suffix.lower() == ".csv":
        write_ball_csv(dataset, path)
    else:
        write_dataset(dataset, Path(path))
    return f"{path}: written"


def ball_points(request: BallRequest) -> list[list[BallPoint]]:
    """Points at every load and every speed."""
    at_speed = cache(lambda speed: _at_speed(request, speed))
    loads = [(request.axial, load * request.way[0], load * request.way[1]) for load in request.loads]
    return points_over(loads, request.speeds, lambda load, speed: _at_load(request, load, speed, at_speed(speed)))


def _at_load(request: BallRequest, load: tuple[float, float, float], speed: float, at: _AtSpeed) -> BallPoint:
    """The point at a load and a speed."""
    point = ball_point(
        at.force,
        load,
        speed,
        request.outer_speed,
        tilts=request.description.tilts,
        oil=request.oil,
        temperature=request.description.temperature,
        films=at.films,
    )
    lacks = [Finding(Cause.REACH, words) for words in at.problems]
    return dataclasses.replace(
        point, findings=(*point.findings, *lacks, *(Finding(Cause.FILM, words) for words in at.notes))
    )


def _exported(request: BallRequest, points: list[BallPoint]) -> BallExport:
    """Request and points that a file for another program is made of."""

    def films(entrainment_speed: float) -> BallLaw:
        return _films(request, entrainment_speed).law

    made = films if request.films else None
    return BallExport(request.force, request.description, points, request.outer_speed, made, request.memory)


class _AtSpeed(NamedTuple):
    """The force at a speed, its films where it has those of a table or of the solver, and what is to be said of it."""

    force: BallForce
    films: BallFilms | None = None
    problems: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


_BY_FORMULA = "; thickness of films by the formula of Hamrock and Dowson"


def _at_speed(request: BallRequest, speed: float) -> _AtSpeed:
    """The force at a speed of the inner ring; dry where nothing rolls, or none are asked for."""
    geometry = request.force.geometry
    u = geometry.entrainment_speed(speed, request.outer_speed)
    if not request.films or u == 0.0:
        return _AtSpeed(request.force)
    if request.films == TABLE_LAW and u < (slowest := _slowest(request)):
        law = _films(request, slowest).faded(geometry, u / slowest)
        words = f"{RPM.text(speed)}: films fade, as the film table of points begins at {SPEED.text(slowest)}"
        return _AtSpeed(BallForce(geometry, law), notes=(words + _BY_FORMULA,))
    try:
        films = _films(request, u)
    except SolverError as error:
        words = f"film table has no films there ({error}); --law {FILMS} solves them"
        if not request.by_default:
            raise AnalysisError(f"{RPM.text(speed)}: {words}, and contacts of --law hertz have none") from error
        words = f"{RPM.text(speed)}: dry and without damping, as the {words}{_BY_FORMULA}"
        return _AtSpeed(request.force, problems=(words,))
    tell(f"{RPM.text(speed)}: films {films.words}")
    return _AtSpeed(BallForce(geometry, films.law), films)


def _slowest(request: BallRequest) -> float:
    """Entrainment speed at which the film table of points begins [m/s]."""
    from mbs.bearings.balls.films import slowest_films  # with the table of point contacts

    return slowest_films(request.force.geometry, request.oil, request.description.temperature)


def _films(request: BallRequest, entrainment_speed: float) -> BallFilms:
    """Films of an entrainment speed [m/s]."""
    from mbs.bearings.balls.films import ball_films  # with the table of point contacts

    temperature, solves = request.description.temperature, request.films == FILMS
    return ball_films(request.force.geometry, request.oil, entrainment_speed, temperature, solves=solves)


def _geometry(source: str, problems: list[str]) -> BallGeometry | None:
    """The bearing of a designation."""
    try:
        return ball_estimate(source)
    except InputError as error:
        problems += [f"BEARING: {problem}" for problem in error.problems]
        return None
