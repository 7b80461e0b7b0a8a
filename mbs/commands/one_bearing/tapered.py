"""`mbs bearing` of rollers and ribs, tapered or NJ and NUP under axial load, by designation; every problem at once."""

from __future__ import annotations

import argparse
import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.outputs import output_problems
from ehdmaps.physics.catalogue import designated
from ehdmaps.physics.lubricant import DEFAULT_OIL, Lubricant
from ehdmaps.physics.rollers.ribbed_geometry import RibbedGeometry, ribbed_estimate, ribbed_way
from ehdmaps.physics.rollers.tapered_catalogue import tapered_estimate
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.physics.surface import Surface
from ehdmaps.units import RPM, TEMPERATURE
from mbs.analyses.bearing_point import points_over, without_holes
from mbs.bearings.tapered.line_film import LineFilms
from mbs.bearings.tapered.tapered_bearing import MOST_SLICES, SLICES, TaperedForce
from mbs.bearings.tapered.tapered_point import TaperedPoint, tapered_point
from mbs.commands.one_bearing.bearing_files import bearing_outputs, is_export, is_source
from mbs.commands.one_bearing.linear_files import count_problems
from mbs.commands.one_bearing.shared import (
    CELSIUS_40,
    assumed_clearance,
    read_damper,
    read_oil,
    read_profile_text,
    read_surface,
    refuse_others,
)
from mbs.commands.one_bearing.tapered_files import TaperedExport, write_export
from mbs.commands.one_bearing.tapered_table import (
    TaperedDescription,
    tapered_dataset,
    tapered_text,
    write_tapered_csv,
)
from mbs.commands.one_bearing.values import (
    LOADS,
    MOST_POINTS,
    SPEEDS,
    read_choices,
    read_direction,
    read_one,
    read_values,
    read_whole,
)
from mbs.model.findings import Cause, Finding
from mbs.output.files import write_dataset
from mbs.scene.contact_laws import Damper
from mbs.scene.fields import FORCE
from mbs.scene.map_set import TABLE_LAW

_TAKEN = ("law", "temperature", "roughness", "films")
"""Choices that all of them take; those without a contact angle have a clearance too."""


@dataclass(frozen=True, eq=False)
class TaperedRequest:
    """Request to be answered.

    Attributes
    ----------
    force : TaperedForce
        Geometry and laws.
    films : bool
        Whether films act in the balance.
    by_default : bool
        Whether films are those of the default: speeds without any are dry then, and say why.
    memory : bool
        Whether the films of a file for another program have a memory.
    oil : Lubricant
        Oil of the films.
    surface : Surface
        Surfaces of the lines with films; smooth where a roughness is only assumed.
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
    description : TaperedDescription
        The same in words.
    """

    force: TaperedForce
    films: bool
    by_default: bool
    memory: bool
    oil: Lubricant
    surface: Surface
    loads: tuple[float, ...]
    axial: float
    way: tuple[float, float]
    speeds: tuple[float, ...]
    outer_speed: float
    description: TaperedDescription


def read_tapered(arguments: argparse.Namespace) -> TaperedRequest:
    """Read the bearing and all options.

    Raises
    ------
    InputError
        With every problem.
    """
    problems: list[str] = []
    chosen = read_choices(arguments, problems)
    ribbed = bool(ribbed_way(arguments.bearing))
    kind = "ribbed roller bearing" if ribbed else "tapered roller bearing"
    geometry = _geometry(arguments.bearing, chosen.get("clearance"), problems)
    taken = (*_TAKEN, "clearance") if ribbed else _TAKEN
    refuse_others(arguments, list(chosen), taken, kind, problems, ("profile", "slices"))
    axial = read_one("--axial", arguments.axial, "N", (-LOADS[1], LOADS[1]), FORCE, 0.0, problems)
    least = 0.0 if axial else LOADS[0]
    loads = read_values("--load", arguments.load, "N", (least, LOADS[1]), FORCE, problems)
    if isinstance(geometry, RibbedGeometry) and not (axial > 0.0 or (axial < 0.0 and geometry.carries == "both")):
        allowed = "not zero; without the option it is a bearing without ribs"
        allowed = allowed if geometry.carries == "both" else "above zero: NJ carries one way, here along x"
        problems.append(f"--axial: got {FORCE.text(axial)}; allowed: {allowed}")
    elif geometry is not None and not (ribbed or axial > 0.0):
        problems.append(
            f"--axial: got {FORCE.text(axial)}; allowed: above zero: the rings of a single {kind} fall apart without; "
            f"half of its rollers carry at {1.25 * math.tan(geometry.cup_angle):.3g} of the radial load"
        )
    speeds = read_values("--speed", arguments.speed, "rad/s", SPEEDS, RPM, problems)
    limits = (-SPEEDS[1], SPEEDS[1])
    outer = read_one("--outer-speed", arguments.outer_speed, "rad/s", limits, RPM, 0.0, problems)
    if len(loads) * len(speeds) > MOST_POINTS:
        problems.append(f"--load, --speed: got {len(loads) * len(speeds)} points; allowed: at most {MOST_POINTS}")
    way = read_direction(arguments.direction, problems)
    law = chosen.get("law", TABLE_LAW)
    films = law == TABLE_LAW
    if "films" in chosen and not (films and is_source(arguments.output)):
        problems.append(
            f"--films: got {chosen['films']!r} for a {kind}; allowed: with --law {TABLE_LAW} and -o NAME.c, NAME.fmu"
        )
    damper = Damper() if films else read_damper(law, kind, f", {TABLE_LAW}", problems)
    profile = arguments.profile
    if isinstance(geometry, RibbedGeometry):
        profile = read_profile_text(profile, designated(arguments.bearing), problems)
    elif profile not in ("iso", "straight"):
        problems.append(f"--profile: got {profile!r:.60} for a {kind}; allowed: iso, straight")
    slices = SLICES if arguments.slices == "41" else read_whole("--slices", arguments.slices, 2, MOST_SLICES, problems)
    temperature = float(chosen.get("temperature", CELSIUS_40))
    oil = read_oil(arguments.oil, temperature, problems)
    problems += output_problems(bearing_outputs(arguments.output), [])
    one_load = is_export(arguments.output)
    problems += count_problems(arguments.output, len(loads), len(speeds), of_one_load=one_load)
    if problems or geometry is None or damper is None or oil is None or slices is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    surface, roughness, for_lambda = read_surface(chosen)
    assumed = [
        *([f"temperature {TEMPERATURE.text(CELSIUS_40)}"] if "temperature" not in chosen else []),
        *for_lambda,
        *([f"oil {DEFAULT_OIL}"] if arguments.oil is None else []),
        *(["no axial clearance"] if ribbed else []),
        *(assumed_clearance(geometry, "clearance" in chosen) if ribbed else []),
    ]
    return TaperedRequest(
        films=films,
        by_default="law" not in chosen,
        memory=chosen.get("films") == "memory",
        force=TaperedForce(geometry, damper.constant, damper.time, profile=profile, slices=slices),
        oil=oil,
        surface=surface,
        loads=loads,
        axial=axial,
        way=way,
        speeds=speeds,
        outer_speed=outer,
        description=TaperedDescription(
            law="film table at radius and speed of the middle, rib dry" + (f", {surface.label}" * (not surface.smooth))
            if films
            else "dry, ISO/TS 16281, rib Hertz" + (f", {damper.words} of each contact" if damper.words else ""),
            films=f"films by the formulas of Moes and Dowson-Higginson, {oil.title}"
            + ("" if oil.verified else " (unverified data of the oil)"),
            direction=math.degrees(math.atan2(way[1], way[0])),
            temperature=temperature,
            roughness=roughness,
            tilts=arguments.tilts,
            assumed=tuple(assumed),
        ),
    )


def run_tapered(arguments: argparse.Namespace) -> tuple[str, int]:
    """Compute all points, describe and write them; status 1 where one is outside of what the laws hold for."""
    request = read_tapered(arguments)
    points = tapered_points(request)
    lines = tapered_text(request.description, points)
    if arguments.output:
        lines.append(_written(arguments.output, request, points))
    return "\n".join(lines), 1 if any(point.problems for row in points for point in row) else 0


def _written(path: str, request: TaperedRequest, points: list[list[TaperedPoint]]) -> str:
    """Write the file of -o, and return what was written in words."""
    if is_export(path):
        films, row = _films(request) if request.films else None, without_holes(path, points[0])
        return write_export(
            path, TaperedExport(request.force, request.description, row, request.outer_speed, films, request.memory)
        )
    dataset = tapered_dataset(request.description, points)
    if Path(path).suffix.lower() == ".csv":
        write_tapered_csv(dataset, path)
    else:
        write_dataset(dataset, Path(path))
    return f"{path}: written"


def tapered_points(request: TaperedRequest) -> list[list[TaperedPoint]]:
    """Points at every load and every speed."""
    at_speed = cache(_force_at(request))
    loads = [(request.axial, load * request.way[0], load * request.way[1]) for load in request.loads]
    return points_over(loads, request.speeds, lambda load, speed: _at_load(request, load, speed, *at_speed(speed)))


def _at_load(
    request: TaperedRequest,
    load: tuple[float, float, float],
    speed: float,
    force: TaperedForce,
    lacks: tuple[str, ...],
) -> TaperedPoint:
    """The point at a load and a speed, with why films are lacking."""
    point = tapered_point(
        force,
        load,
        speed,
        request.outer_speed,
        tilts=request.description.tilts,
        oil=request.oil,
        temperature=request.description.temperature,
    )
    return dataclasses.replace(point, findings=(*point.findings, *(Finding(Cause.REACH, words) for words in lacks)))


def _force_at(request: TaperedRequest) -> Callable[[float], tuple[TaperedForce, tuple[str, ...]]]:
    """The force by the speed of the inner ring, and why it has no films; none where nothing rolls."""
    films = _films(request) if request.films else None

    def at(speed: float) -> tuple[TaperedForce, tuple[str, ...]]:
        if films is None:
            return request.force, ()
        try:
            at_speed = films(request.force.geometry.entrainment_speed(speed, request.outer_speed))
        except InputError as error:
            if not request.by_default:
                raise
            words = f"{RPM.text(speed)}: dry and without damping, as the film table has no films there ({error})"
            return request.force, (words,)
        return request.force.with_films(at_speed), ()

    return at


def _films(request: TaperedRequest) -> Callable[[float], LineFilms] | None:
    """Laws of both lines by the entrainment speed [m/s]; None where nothing rolls."""
    geometry = request.force.geometry
    fastest = max(geometry.entrainment_speed(speed, request.outer_speed) for speed in request.speeds)
    if not fastest > 0.0:
        return None
    from mbs.scene.tapered.films import FilmsOfLines, OilOfLines

    temperature = request.description.temperature
    films = FilmsOfLines(geometry, OilOfLines("table", request.oil, temperature, fastest, surface=request.surface))
    return lambda u: films(u / geometry.entrainment_speed(1.0), 0.0)


def _geometry(source: str, clearance: float | None, problems: list[str]) -> TaperedGeometry | None:
    """The bearing of a designation."""
    try:
        return ribbed_estimate(source, clearance) if ribbed_way(source) else tapered_estimate(source)
    except InputError as error:
        problems += [f"BEARING: {problem}" for problem in error.problems]
        return None
