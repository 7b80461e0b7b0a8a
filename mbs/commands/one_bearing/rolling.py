"""`mbs bearing` of bearings that carry axial load, by designation: every problem at once, points, files."""

from __future__ import annotations

import argparse
import dataclasses
import math
from functools import cache
from typing import Any

from ehdmaps.choices import SUPPLY
from ehdmaps.errors import AnalysisError, InputError, SolverError
from ehdmaps.outputs import FIGURE, Output, output_problems
from ehdmaps.physics.lubricant import DEFAULT_OIL
from ehdmaps.physics.oil_supply import FLOODED, FilmConditions
from ehdmaps.units import TEMPERATURE
from mbs.analyses.bearing_point import points_over, without_holes
from mbs.commands.one_bearing.bands import NAME, point_bands, scene_of, turned
from mbs.commands.one_bearing.family import Asked, AtSpeed, Family, Request
from mbs.commands.one_bearing.files import Export, bearing_outputs, is_export, write_export
from mbs.commands.one_bearing.linear_files import count_problems, ending_of
from mbs.commands.one_bearing.shared import (
    CELSIUS_40,
    assumed_clearance,
    read_choices,
    read_damper,
    read_heat,
    read_oil,
    read_operating,
    read_surface,
    refuse_others,
)
from mbs.model.findings import Cause, Finding
from mbs.output.one_bearing.files import write_points
from mbs.output.one_bearing.kind import Description
from mbs.scene.contact_laws import Damper
from mbs.scene.map_set import TABLE_LAW
from mbs.scene.scene import Scene
from mbs.scene.specs import BallSpec, TaperedSpec
from mbs.unknowns.looks import Band


def read_request(arguments: argparse.Namespace, family: Family) -> Request:
    """Read the bearing and all options.

    Parameters
    ----------
    arguments : Namespace
        Options as they were parsed.
    family : Family
        Family of the bearing.

    Raises
    ------
    InputError
        With every problem.
    """
    problems: list[str] = []
    chosen = read_choices(arguments, problems)
    asked = family.read(arguments, chosen, problems)
    refuse_others(arguments, list(chosen), family.taken, family.words, problems, family.own)
    operating = read_operating(arguments, problems)
    if asked is not None and (wrong := family.axial_problem(asked.geometry, operating.axial)):
        problems.append(wrong)
    law = chosen.get("law", TABLE_LAW)
    films = law if law in family.film_laws else ""
    if "films" in chosen and not (films and ending_of(arguments.output) in family.memory):
        files = ", ".join(f"NAME{ending}" for ending in family.memory)
        problems.append(
            f"--films: got {chosen['films']!r} for a {family.words}; allowed: with --law {TABLE_LAW} and -o {files}"
        )
    more = "".join(f", {name}" for name in family.film_laws) + family.beside_laws
    damper = Damper() if films else read_damper(law, family.words, more, problems)
    temperature = float(chosen.get("temperature", CELSIUS_40))
    oil = read_oil(arguments.oil, temperature, problems)
    dry = f"with dry contacts; allowed: with --law {TABLE_LAW}"
    heat = read_heat(chosen, oil, "" if films else dry, problems)
    supply = chosen.get(SUPPLY.name, FLOODED)
    if SUPPLY.name in chosen and not films:
        problems.append(f"--{SUPPLY.name}: got {supply.label} {dry}")
    problems += output_problems((*bearing_outputs(arguments.output), Output("--plot", arguments.plot, FIGURE)), [])
    counts = len(operating.loads), len(operating.speeds)
    problems += count_problems(arguments.output, *counts, of_one_load=is_export(arguments.output))
    if problems or asked is None or damper is None or oil is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    surface, roughness, for_lambda = read_surface(chosen)
    conditions = FilmConditions(heat, supply, surface)
    words, source = family.words_of(films, oil, damper, conditions)
    with_clearance = "clearance" in family.taken
    assumed = (
        *([f"temperature {TEMPERATURE.text(CELSIUS_40)}"] if "temperature" not in chosen else []),
        *for_lambda,
        *(assumed_clearance(asked.geometry, "clearance" in chosen) if with_clearance else []),
        *family.assumed,
        *([f"oil {DEFAULT_OIL}"] if arguments.oil is None else []),
    )
    return Request(
        family=family,
        asked=asked,
        damper=damper,
        films=films,
        by_default="law" not in chosen,
        memory=chosen.get("films") == "memory",
        oil=oil,
        conditions=conditions,
        operating=operating,
        description=Description(
            law=words,
            films=source + ("" if oil.verified else " (unverified data of the oil)"),
            direction=math.degrees(math.atan2(operating.way[1], operating.way[0])),
            temperature=temperature,
            roughness=roughness,
            tilts=arguments.tilts,
            assumed=assumed,
            oil=oil,
            known=chosen.get("know", ()),
        ),
    )


def points_of(request: Request) -> list[list[Any]]:
    """Points at every load and every speed.

    Parameters
    ----------
    request : Request
        What is asked.
    """
    at_speed = cache(request.family.at_speed(request))
    asked = request.operating
    loads = [(asked.axial, load * asked.way[0], load * asked.way[1]) for load in asked.loads]
    return points_over(loads, asked.speeds, lambda load, speed: _point(request, load, speed, at_speed(speed)))


def scene_as(request: Request) -> Scene:
    """The bearing as the only one of a scene, to ask what is not known of it.

    Parameters
    ----------
    request : Request
        What is asked.
    """
    geometry, options = request.asked
    kind = TaperedSpec if "profile" in options else BallSpec
    spec = kind(NAME, "", "", geometry, **options)
    return scene_of(spec, request.oil, request.description)


def bands_of(request: Request, points: list[list[Any]]) -> dict[str, Band]:
    """Bands of what is not known of a single point, by the names of its numbers; none of several.

    Parameters
    ----------
    request : Request
        What is asked.
    points : list of list
        Points by load, then by speed.
    """
    if len(points) * len(points[0]) > 1 or points[0][0].failed:
        return {}

    def again(scene: Scene) -> tuple[Description, Any]:
        other = _changed(request, scene)
        return other.description, points_of(other)[0][0]

    return point_bands(request.family.kind, request.description, points[0][0], scene_as(request), again)


def _changed(request: Request, scene: Scene) -> Request:
    """The same request of a scene that is a little different."""
    (spec,) = scene.located
    options = {name: getattr(spec, name) for name in request.asked.options}
    oil, kelvin = scene.lubricant or request.oil, scene.temperature
    return dataclasses.replace(
        request,
        asked=Asked(spec.geometry, options),
        oil=oil,
        operating=request.operating._replace(way=turned(request.operating.way, spec.start_angle)),
        description=dataclasses.replace(request.description, oil=oil, temperature=kelvin),
        trial=True,
    )


def _point(request: Request, load: tuple[float, float, float], speed: float, at: AtSpeed) -> Any:
    """The point at a load and a speed, with what is to be said of its films."""
    description = request.description
    point = request.family.point.at(
        at.force,
        load,
        speed,
        request.operating.outer_speed,
        tilts=description.tilts,
        oil=request.oil,
        temperature=description.temperature,
        films=at.films,
    )
    told = [Finding(Cause.REACH, words) for words in at.problems] + [Finding(Cause.FILM, words) for words in at.notes]
    return dataclasses.replace(point, findings=(*point.findings, *told))


def write_file(path: str, request: Request, points: list[list[Any]], bands: dict[str, Band]) -> str:
    """Write the file of -o, and return what was written in words.

    Parameters
    ----------
    path : str
        Path of -o.
    request : Request
        What was asked.
    points : list of list
        Points by load, then by speed.
    bands : dict of str to Band
        Bands of the only one.

    Raises
    ------
    InputError, AnalysisError
        If it cannot be written, or a point or a speed has no answer.
    """
    family, description = request.family, request.description
    if not is_export(path):
        return write_points(family.kind, description, points, path, bands)
    row, outer_speed = without_holes(path, points[0]), request.operating.outer_speed
    films, memory = family.films(request), request.memory
    try:
        return write_export(path, Export(family, request.force, description, row, outer_speed, films, memory))
    except SolverError as error:
        raise AnalysisError(f"-o {path}: {error}") from error
