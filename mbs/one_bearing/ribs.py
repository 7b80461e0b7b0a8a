"""`mbs bearing` of rollers and ribs, tapered or NJ and NUP under axial load: their rows of the families."""

from __future__ import annotations

import argparse
import dataclasses
import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.catalogue import designated
from ehdmaps.physics.rollers.ribbed_geometry import ribbed_estimate
from ehdmaps.physics.rollers.tapered_catalogue import tapered_estimate
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.units import RPM
from mbs.bearings.laws import FORMULAS
from mbs.bearings.tapered.line_film import LineFilms
from mbs.bearings.tapered.tapered_bearing import MOST_SLICES, SLICES, TaperedForce
from mbs.bearings.tapered.tapered_point import TaperedPoint
from mbs.one_bearing.family import Asked, AtSpeed, Family, Operating, Request
from mbs.one_bearing.shared import assumed_clearance, read_profile_text, read_whole
from mbs.output.one_bearing.ribs import RIBBED
from mbs.scene.fields import FORCE
from mbs.scene.map_set import TABLE_LAW
from mbs.scene.specs import TaperedSpec

if TYPE_CHECKING:
    from mbs.exports.one_bearing.kind import ExportKind
    from mbs.scene.locating.line_films import FilmsOfLines

_TAKEN = ("law", "physics", "temperature", "supply", "roughness", "films")
"""Choices that all of them take; those without a contact angle have a clearance too."""


def _read_tapered(arguments: argparse.Namespace, _: Mapping[str, Any], problems: Problems) -> Asked | None:
    """The tapered roller bearing of a designation, with profile and slices."""
    geometry: TaperedGeometry | None = None
    with problems.after("BEARING: "):
        geometry = tapered_estimate(arguments.bearing)
    if arguments.profile not in ("iso", "straight"):
        problems.append(
            f"--profile: got {arguments.profile!r:.60} for a tapered roller bearing; allowed: iso, straight"
        )
    slices = _slices(arguments, problems)
    return None if geometry is None else Asked(geometry, {"profile": arguments.profile, "slices": slices})


def _read_ribbed(arguments: argparse.Namespace, chosen: Mapping[str, Any], problems: Problems) -> Asked | None:
    """The bearing NJ or NUP of a designation, with its clearance, profile and slices."""
    geometry: TaperedGeometry | None = None
    with problems.after("BEARING: "):
        geometry = ribbed_estimate(arguments.bearing, chosen.get("clearance"))
    slices = _slices(arguments, problems)
    if geometry is None:
        return None
    profile = read_profile_text(arguments.profile, designated(arguments.bearing), problems)
    assumed = (*assumed_clearance(geometry, "clearance" in chosen), "no axial clearance")
    return Asked(geometry, {"profile": profile, "slices": slices}, assumed)


def _slices(arguments: argparse.Namespace, problems: Problems) -> int:
    """Slices of a roller: fewer than those of cylindrical ones where nothing is asked for."""
    return SLICES if arguments.slices == "41" else read_whole("--slices", arguments.slices, 2, MOST_SLICES, problems)


def _axial_of_tapered(asked: Asked, operating: Operating) -> str:
    """A problem with an axial load of a tapered roller bearing; empty without one."""
    if operating.axial > 0.0:
        return ""
    half = 1.25 * math.tan(asked.geometry.cup_angle)
    return (
        f"--axial: got {FORCE.text(operating.axial)}; allowed: above zero: the rings of a single tapered roller "
        f"bearing fall apart without; half of its rollers carry at {half:.3g} of the radial load"
    )


def _axial_of_ribs(asked: Asked, operating: Operating) -> str:
    """A problem with an axial load of ribs; empty without one."""
    axial, both = operating.axial, asked.geometry.carries == "both"
    if axial > 0.0 or (axial < 0.0 and both):
        return ""
    allowed = "not zero; without the option it is a bearing without ribs"
    allowed = allowed if both else f"above zero: {asked.geometry.name} carries one way, here along x"
    return f"--axial: got {FORCE.text(axial)}; allowed: {allowed}"


def _words_of(request: Request) -> tuple[str, str]:
    """Law and films."""
    conditions, damper = request.conditions, request.damper
    films = f"films by the formulas of Moes and Dowson-Higginson, {request.oil.title}"
    if request.films:
        rough = "" if conditions.surface.smooth else f", {conditions.surface.label}"
        warm = "" if request.law in FORMULAS else f", {conditions.heat_words}"
        layer = "" if conditions.supply.flooded else f", {conditions.supply.label}"
        formula = FORMULAS.get(request.law)
        source = f"{formula.words}{formula.remark}" if formula else "film table"
        return f"{source} at radius and speed of the middle{warm}{layer}, rib dry{rough}", "films of the law"
    return "dry, ISO/TS 16281, rib Hertz" + (f", {damper.words} of each contact" if damper.words else ""), films


def _force(request: Request) -> TaperedForce:
    """The force with its dry law."""
    damper = request.damper
    return TaperedForce(request.asked.geometry, damper.constant, damper.time, **request.asked.options)


def _lines(request: Request) -> FilmsOfLines | None:
    """Films of both lines by the speeds of the rings; None where nothing rolls, or none are asked for."""
    fastest = max(request.entrainment_speed(speed) for speed in request.operating.speeds)
    if not request.films or not fastest > 0.0:
        return None
    from mbs.scene.locating.line_films import FilmsOfLines, OilOfLines

    geometry, temperature = request.force.geometry, request.description.temperature
    law = request.law if request.law in FORMULAS else TABLE_LAW
    oil = OilOfLines(law, request.oil, temperature, fastest, request.conditions)
    return FilmsOfLines(geometry, oil)


def _films(request: Request) -> Callable[[float], LineFilms] | None:
    """Laws of both lines by the entrainment speed [m/s]; None where nothing rolls, or none are asked for."""
    films, geometry = _lines(request), request.force.geometry
    return None if films is None else lambda u: films(u / geometry.entrainment_speed(1.0), 0.0)


def _at_speed(request: Request) -> Callable[[float], AtSpeed]:
    """The force at a speed of the inner ring; dry where nothing rolls, or no films are asked for."""
    films, lines = _films(request), _lines(request)

    def at(speed: float) -> AtSpeed:
        if films is None:
            return AtSpeed(request.force)
        try:
            at_speed = films(request.entrainment_speed(speed))
        except InputError as error:
            if not request.by_default:
                raise
            words = f"{RPM.text(speed)}: dry and without damping, as the film table has no films there ({error})"
            return AtSpeed(request.force, problems=(words,))
        return AtSpeed(request.force.with_films(at_speed), lines)

    return at


def _exported_tapered() -> ExportKind:
    """Sources and units of tapered rollers."""
    from mbs.exports.one_bearing import rollers

    return rollers.TAPERED


def _exported_ribbed() -> ExportKind:
    """Sources and units of rollers between ribs."""
    from mbs.exports.one_bearing import rollers

    return rollers.RIBBED


TAPERED_BEARINGS = Family(
    kind=RIBBED,
    words="tapered roller bearing",
    taken=_TAKEN,
    own=("profile", "slices"),
    film_laws=(TABLE_LAW, *FORMULAS),
    beside_laws="",
    memory=(".c", ".fmu"),
    spec=TaperedSpec,
    read=_read_tapered,
    wrong=_axial_of_tapered,
    force=_force,
    words_of=_words_of,
    films=_films,
    at_speed=_at_speed,
    point=TaperedPoint.at,
    exported=_exported_tapered,
)
"""Tapered roller bearings."""

RIBBED_BEARINGS = dataclasses.replace(
    TAPERED_BEARINGS,
    words="ribbed roller bearing",
    taken=(*_TAKEN, "clearance"),
    read=_read_ribbed,
    wrong=_axial_of_ribs,
    exported=_exported_ribbed,
)
"""Cylindrical roller bearings whose ribs carry an axial load: NJ and NUP."""
