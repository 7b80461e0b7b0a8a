"""`mbs bearing` of a bearing of any family: every problem at once, points, bands, files."""

from __future__ import annotations

import argparse
import dataclasses
import math
from collections.abc import Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from ehdmaps.errors import AnalysisError, InputError, Problems, SolverError
from ehdmaps.outputs import FIGURE, Output, output_problems
from ehdmaps.physics.heat import beyond_rule
from ehdmaps.physics.lubricant import DEFAULT_OIL
from ehdmaps.physics.oil_supply import FLOODED, FilmConditions
from ehdmaps.physics.surface import SMOOTH
from ehdmaps.units import TEMPERATURE, Tolerance
from mbs.analyses.bearing_point import points_over, without_holes
from mbs.bearings.laws import FORMULAS
from mbs.model.findings import Cause, Finding
from mbs.one_bearing.bands import NAME, point_bands, scene_of, turned
from mbs.one_bearing.family import Asked, AtSpeed, Family, Request
from mbs.one_bearing.files import SOURCE, UNIT, Export, bearing_outputs, is_export, write_export
from mbs.one_bearing.linear_files import count_problems, ending_of
from mbs.one_bearing.shared import (
    CELSIUS_40,
    read_choices,
    read_dielectric,
    read_heat,
    read_law,
    read_oil,
    read_operating,
    read_rings,
    refuse_others,
)
from mbs.output.one_bearing.kind import Description, Number, Points
from mbs.output.one_bearing.table import ROUGHNESS
from mbs.scene.contact_laws import table_path
from mbs.scene.fields import MICROMETRE
from mbs.scene.map_set import TABLE_LAW
from mbs.scene.scene import Scene
from mbs.unknowns.held_open import held_open, hypotheses, other_supplies
from mbs.unknowns.looks import Band
from mbs.unknowns.statement import Statement
from mbs.unknowns.unknown import Unknown

if TYPE_CHECKING:
    from mbs.bearings.deviating.tables import Deviations


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
    problems = Problems()
    chosen = read_choices(arguments, problems)
    asked = family.read(arguments, chosen, problems)
    refuse_others(arguments, chosen, family, problems)
    law, damper = read_law(chosen, family, problems)
    dry = law not in family.film_laws
    operating = read_operating(arguments, problems, axial=family.kind.axial)
    if asked is not None and (wrong := family.wrong(asked, operating)):
        problems.append(wrong)
    if family.memory and "films" in chosen and (dry or ending_of(arguments.output) not in family.memory):
        files = ", ".join(f"NAME{ending}" for ending in family.memory)
        problems.append(
            f"--films: got {chosen['films']!r} for a {family.words}; allowed: with --law {TABLE_LAW} and -o {files}"
        )
    temperature, of_rings = 0.5 * sum(read_rings(arguments, chosen, problems)), arguments.ring_temperatures is not None
    dielectric = read_dielectric(arguments.permittivity, problems)
    stated = None if asked is None else asked.oil
    oil = read_oil(arguments.oil, temperature, problems, stated)
    lack = f"with dry contacts; allowed: with --law {TABLE_LAW}" if dry else ""
    if law == "map" or law in FORMULAS:
        lack = f"without films of the film table; allowed: with --law {TABLE_LAW}"
    heat, said = read_heat(chosen, oil, lack, problems), "physics" in chosen
    if "supply" in chosen and dry and family.kind.axial:  # of others it is in the films of formulas, too
        problems.append(f"--supply: got {chosen['supply'].label} {lack}")
    problems += _output_problems(arguments, chosen, law)
    deviations = _stated_deviations(arguments, asked, problems)
    problems += count_problems(
        arguments.output,
        len(operating.loads),
        len(operating.speeds),
        of_one_load=is_export(arguments.output),
    )
    if problems or asked is None or damper is None or oil is None:
        raise InputError(problems)
    surface = asked.surface or SMOOTH
    if "roughness" in chosen:
        surface = dataclasses.replace(surface, roughness=chosen["roughness"].roughness)
    roughness = ROUGHNESS if surface.smooth else surface.roughness
    supply = chosen.get("supply") or asked.supply or FLOODED
    assumed = (
        *([f"temperature {TEMPERATURE.text(CELSIUS_40)}"] if "temperature" not in chosen and not of_rings else []),
        *([f"combined rms roughness {MICROMETRE.text(ROUGHNESS)} (for Lambda only)"] if surface.smooth else []),
        *asked.assumed,
        *([f"oil {DEFAULT_OIL}"] if arguments.oil is None and stated is None else []),
        *(["no heat in the films, as the oil has no thermal_conductivity"] if not (lack or heat or said) else []),
    )
    request = family.finished(
        Request(
            family=family,
            asked=asked,
            law=law,
            damper=damper,
            by_default="law" not in chosen,
            physics=chosen.get("physics"),
            memory=chosen.get("films") == "memory",
            stated_supply=chosen.get("supply") or asked.supply,
            oil=oil,
            conditions=FilmConditions(heat, supply, surface),
            operating=operating,
            deviations=deviations,
            description=Description(
                law="",
                films="",
                direction=math.degrees(math.atan2(operating.way[1], operating.way[0])),
                temperature=temperature,
                roughness=roughness,
                tilts=family.kind.axial and arguments.tilts,
                assumed=assumed,
                surface=SMOOTH if dry else surface,
                supply=supply,
                oil=oil,
                state=asked.state,
                known=(*_of_file(asked.tolerances, chosen), *chosen.get("know", ())),
                dielectric=dielectric,
                more=() if dielectric is None else _electric(),
            ),
        )
    )
    words, films = family.words_of(request)
    films += "" if oil.verified else " (unverified data of the oil)"
    return dataclasses.replace(request, description=dataclasses.replace(request.description, law=words, films=films))


def _of_file(tolerances: Mapping[str, Tolerance], chosen: Mapping[str, Any]) -> Iterator[Statement]:
    """Statements of a file, but for numbers that the command has anew."""
    for group, tolerance in tolerances.items():
        if group not in chosen:
            yield Statement(group, "", None, tolerance, f"{group} = {tolerance.text}")


def _electric() -> tuple[Number, ...]:
    """Electric numbers of a point."""
    from mbs.output.one_bearing.electric import ELECTRIC  # with what only they need

    return ELECTRIC


def _output_problems(arguments: argparse.Namespace, chosen: Mapping[str, Any], law: str) -> Iterator[str]:
    """Problems with the files that are to be written."""
    read = (arguments.bearing, chosen.get("map"), table_path(law))
    outputs = (*bearing_outputs(arguments.output), Output("--plot", arguments.plot, FIGURE))
    yield from output_problems(outputs, [one for one in read if one])


def _stated_deviations(arguments: argparse.Namespace, asked: Asked | None, problems: list[str]) -> Deviations | None:
    """Deviations from the form that stand in the braces of the bearing; None without."""
    if not (given := getattr(arguments, "deviations", None)) or asked is None:
        return None
    from ehdmaps.jobs.table import Table
    from mbs.scene.locating.deviations import stated_deviations  # with what few bearings have

    if ending_of(arguments.output) not in (SOURCE, UNIT):
        problems.append(
            f"BEARING: got {', '.join(given)}, by which points are not changed; allowed: with -o NAME{SOURCE} or "
            f"NAME{UNIT}, and in scenes"
        )
    return stated_deviations(Table(given, "BEARING", problems), asked.geometry.bodies)


def points_of(request: Request) -> list[list[Any]]:
    """Points at every load and every speed.

    Parameters
    ----------
    request : Request
        What is asked.
    """
    at_speed, asked = cache(request.family.at_speed(request)), request.operating
    loads = [(asked.axial, load * asked.way[0], load * asked.way[1]) for load in asked.loads]
    return points_over(loads, asked.speeds, lambda load, speed: point_at(request, load, speed, at_speed(speed)))


def point_at(request: Request, load: tuple[float, float, float], speed: float, at: AtSpeed) -> Any:
    """The point at a load and a speed, with what is to be said of its films.

    Parameters
    ----------
    request : Request
        What is asked.
    load : (float, float, float)
        Load on the inner ring along x, y and z [N].
    speed : float
        Speed of the inner ring [rad/s].
    at : AtSpeed
        The force there.
    """
    description = request.description
    point = request.family.point(
        at.force,
        load,
        speed,
        request.operating.outer_speed,
        tilts=description.tilts,
        oil=request.oil,
        temperature=description.temperature,
        films=at.films,
    )
    notes = list(at.notes)
    if request.conditions.inlet_heat:
        u = abs(request.asked.geometry.entrainment_speed(speed, request.operating.outer_speed))
        notes += filter(None, [beyond_rule(request.oil, u, description.temperature)])
    told = [Finding(Cause.REACH, words) for words in at.problems] + [Finding(Cause.FILM, words) for words in notes]
    return dataclasses.replace(point, findings=(*point.findings, *told))


def scene_as(request: Request) -> Scene:
    """The bearing as the only one of a scene, to ask what is not known of it.

    Parameters
    ----------
    request : Request
        What is asked.
    """
    spec = request.family.spec(NAME, "", "", request.asked.geometry, **request.asked.options)
    return scene_of(spec, request.oil, request.description, request.stated_supply)


def open_of(request: Request) -> tuple[Unknown, ...]:
    """List what is not known of the bearing: what no band holds, too.

    Parameters
    ----------
    request : Request
        What is asked.
    """
    scene = scene_as(request)
    return (*held_open(scene), *(other_supplies(scene) if request.films else ()), *hypotheses(scene))


def bands_of(request: Request, points: Points) -> dict[str, Band]:
    """Bands of what is not known of a single point, by the names of its numbers; none of several.

    Parameters
    ----------
    request : Request
        What is asked.
    points : sequence of sequence
        Points by load, then by speed.
    """
    if len(points) * len(points[0]) > 1 or points[0][0].failed:
        return {}

    def again(scene: Scene) -> tuple[Description, Any]:
        other = _changed(request, scene)
        return other.description, points_of(other)[0][0]

    return point_bands(request.family.kind, request.description, points[0][0], open_of(request), again)


def _changed(request: Request, scene: Scene) -> Request:
    """The same request of a scene that is a little different; a map from a file stays what it is."""
    (spec,) = scene.of_all_kinds
    options = {name: getattr(spec, name) for name in request.asked.options}
    oil, kelvin, supply = scene.lubricant or request.oil, scene.temperature, scene.supply or FLOODED
    changed = dataclasses.replace(
        request,
        asked=request.asked._replace(geometry=spec.geometry, options=options),
        oil=oil,
        conditions=dataclasses.replace(request.conditions, supply=supply),
        operating=request.operating._replace(way=turned(request.operating.way, spec.start_angle)),
        description=dataclasses.replace(request.description, oil=oil, temperature=kelvin, supply=supply),
        trial=True,
    )
    return request.family.finished(changed)


def write_file(path: str, request: Request, points: Points, bands: dict[str, Band]) -> str:
    """Write the file of -o, and return what was written in words.

    Parameters
    ----------
    path : str
        Path of -o.
    request : Request
        What was asked.
    points : sequence of sequence
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
        from mbs.output.one_bearing.files import write_points

        return write_points(family.kind, description, points, path, bands)
    row, outer_speed = without_holes(path, list(points[0])), request.operating.outer_speed
    films, memory = family.films(request), request.memory
    try:
        own = memory, request.asked.emap, request.deviations
        return write_export(path, Export(family, request.force, description, row, outer_speed, films, *own))
    except SolverError as error:
        raise AnalysisError(f"-o {path}: {error}") from error
