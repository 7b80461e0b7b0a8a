"""`mbs bearing` of a ball bearing, deep groove or angular contact, by its designation: its row of the families."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.errors import AnalysisError, Problems, SolverError, problems_after
from ehdmaps.jobs.balls import balls_of
from ehdmaps.physics.oil_supply import PLAIN
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.solids import STEEL
from ehdmaps.program import tell
from ehdmaps.units import RPM, SPEED
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_mounting import mounted
from mbs.bearings.balls.ball_point import BallPoint, ball_dynamic_stiffness
from mbs.bearings.balls.laws import BallLaw, dry_law
from mbs.bearings.thermal import Mounting
from mbs.one_bearing.family import Asked, AtSpeed, Family, Request
from mbs.one_bearing.linear_files import Oscillating
from mbs.one_bearing.shared import assumed_clearance, read_rings
from mbs.output.one_bearing.balls import BALLS
from mbs.scene.map_set import TABLE_LAW
from mbs.scene.specs import BallSpec

if TYPE_CHECKING:
    from mbs.exports.one_bearing.kind import ExportKind
    from mbs.scene.locating.ball_films import FilmsOfPoints

FILMS = "films"
"""Law of contacts with films that are read from the table of points, and solved where it has none; `table` reads."""

FREQUENCIES = np.array([0.0, *np.geomspace(10.0, 2e4, 34)])
"""Frequencies of films with memory at one speed [Hz], ten in a decade: K and C are cubics between them in ROSS."""

_SOURCES = {FILMS: "read from the film table, or solved", TABLE_LAW: "read from the film table"}
_BY_FORMULA = "; thickness of films by the formula of Hamrock and Dowson"


def _read(arguments: argparse.Namespace, chosen: Mapping[str, Any], problems: Problems) -> Asked | None:
    """The bearing of a designation, with its clearance."""
    with problems:
        with problems_after("BEARING: "):
            geometry = balls_of(arguments.bearing) or ball_estimate(arguments.bearing)
        with problems_after("--clearance: "):
            if "clearance" in chosen:
                geometry = geometry.with_clearance(float(chosen["clearance"]))
        with problems_after("--ring-temperatures: "):
            if arguments.ring_temperatures is not None:
                geometry, _ = mounted(geometry, Mounting(), *read_rings(arguments, chosen, Problems()))
        return Asked(geometry, {}, tuple(assumed_clearance(geometry, "clearance" in chosen)))
    return None


def _words_of(request: Request) -> tuple[str, str]:
    """Law and films."""
    oil, damper = request.oil, request.damper
    if request.films:
        return f"films of {oil.title}, {request.conditions.words}, {_SOURCES[request.law]}", "films of the law"
    dry = "dry Hertz" + (f", {damper.words} of each contact" if damper.words else "")
    return dry, f"films by the formula of Hamrock and Dowson, {oil.title}, {PLAIN.words}"


def _force(request: Request) -> BallForce:
    """The force with its dry law."""
    geometry, damper = request.asked.geometry, request.damper
    return BallForce(geometry, dry_law(geometry, STEEL, damper.constant, damper.time))


def _films(request: Request) -> Callable[[float], BallLaw] | None:
    """Law with the films of an entrainment speed [m/s]."""
    return (lambda u: _points(request).at(u).law) if request.films else None


def _points(request: Request) -> FilmsOfPoints:
    """Films over the speed."""
    from mbs.scene.locating.ball_films import FilmsOfPoints

    at = request.force.geometry, request.oil, request.description.temperature, request.conditions
    return FilmsOfPoints(*at, solves=request.films == FILMS)


def _at_speed(request: Request) -> Callable[[float], AtSpeed]:
    """The force at a speed of the inner ring; dry where nothing rolls, or no films are asked for."""
    geometry = request.force.geometry

    def at(speed: float) -> AtSpeed:
        u = request.entrainment_speed(speed)
        if not request.films or u == 0.0:
            return AtSpeed(request.force)
        points = _points(request)
        if u < points.slowest:
            words = f"{RPM.text(speed)}: films fade, as the film table of points begins at {SPEED.text(points.slowest)}"
            law = points(speed, request.operating.outer_speed)
            return AtSpeed(BallForce(geometry, law), notes=(words + _BY_FORMULA,))
        try:
            films = points.at(u)
        except SolverError as error:
            words = f"film table has no films there ({error}); --law {FILMS} solves them"
            if not request.by_default:
                raise AnalysisError(f"{RPM.text(speed)}: {words}, and contacts of --law hertz have none") from error
            words = f"{RPM.text(speed)}: dry and without damping, as the {words}{_BY_FORMULA}"
            return AtSpeed(request.force, problems=(words,))
        if not request.trial:
            tell(f"{RPM.text(speed)}: films {films.words}")
        return AtSpeed(BallForce(geometry, films.law), films)

    return at


def _exported() -> ExportKind:
    """Its sources and units."""
    from mbs.exports.one_bearing import balls

    return balls.BALLS


def _oscillating(points: Sequence[BallPoint]) -> Oscillating:
    """K and C of films with memory: of one speed over frequency, of several at the frequency of turning of each."""
    one = len(points) == 1
    found = []
    for point in points:
        if not (point.force.law.dry or point.force.law.responses):
            raise SolverError(
                f"films with memory at {RPM.text(point.inner_speed)}: those that are solved have no response over "
                "frequency; take speeds and oils that --law table has, or leave --films out"
            )
        omega = 2.0 * np.pi * FREQUENCIES if one else np.array([abs(point.inner_speed)])
        z = ball_dynamic_stiffness(point, omega)
        rate = z.imag / np.where(omega > 0.0, omega, 1.0)[:, None, None]
        found.append([z.real, np.where(omega[:, None, None] > 0.0, rate, point.damping)])
    if one:
        return Oscillating("of films with memory over the frequency, 0: slow motion", FREQUENCIES, np.array(found))
    words = "of films with memory at the frequency of turning of the inner ring: of unbalances"
    return Oscillating(words, np.zeros(1), np.array(found))


BALL_BEARINGS = Family(
    kind=BALLS,
    words="ball bearing",
    taken=("law", "physics", "supply", "clearance", "temperature", "roughness", "films"),
    own=("ring-temperatures",),
    film_laws=(FILMS, TABLE_LAW),
    beside_laws="; maps are of line contacts",
    memory=(".c", ".fmu", ".toml"),
    spec=BallSpec,
    read=_read,
    wrong=lambda asked, operating: "",
    force=_force,
    words_of=_words_of,
    films=_films,
    at_speed=_at_speed,
    point=BallPoint.at,
    exported=_exported,
    oscillating=_oscillating,
)
"""Ball bearings."""
