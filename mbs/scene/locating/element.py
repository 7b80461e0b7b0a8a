"""Bearings of a scene that carry axial load: their laws, what is wrong about them, and the element."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ehdmaps.errors import InputError, Problems
from ehdmaps.units import TEMPERATURE
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.laws import FORMULAS
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.model.relaxation import FILM_WORDS
from mbs.scene.contact_laws import HERTZ_FORMS, ContactLaws, Damper, hertz_damper, surface_label
from mbs.scene.locating.ball_films import films_of_balls
from mbs.scene.locating.line_films import FilmsOfLines, OilOfLines
from mbs.scene.specs import BallSpec, LocatingSpec, TaperedSpec
from mbs.scene.surroundings import Built

if TYPE_CHECKING:
    from mbs.scene.surroundings import Surroundings


@dataclass(frozen=True)
class _Kind:
    """Kind of bearing of a scene: what differs.

    Attributes
    ----------
    allowed : str
        Laws with which it has films, in a message.
    words : callable
        spec -> how it is called.
    sources : callable
        Laws in force, with films -> where these come from, and what is left out.
    force : callable
        (spec, damper) -> the dry force.
    films : callable
        (spec, surroundings) -> law with the films of two speeds of the rings.
    """

    allowed: str
    words: Callable[[Any], str]
    sources: Callable[[ContactLaws], tuple[str, str]]
    force: Callable[[Any, Damper], Any]
    films: Callable[[Any, Surroundings], Any]


def _oil_of_lines(laws: ContactLaws, temperature: float, fastest: float = 0.0) -> OilOfLines:
    """Films of lines by the law in force."""
    return OilOfLines(
        laws.chosen if laws.chosen in FORMULAS else "table",
        laws.lubricant,
        temperature,
        fastest,
        laws.conditions,
    )


def _films_of_lines(spec: TaperedSpec, surroundings: Surroundings) -> FilmsOfLines:
    """Laws of the lines of a bearing over the speeds of its rings."""
    scene = surroundings.laws.scene
    spin = max((abs(body.spin) for body in scene.bodies), default=0.0) * scene.fastest
    # rings turn against each other at most
    fastest = abs(spec.geometry.entrainment_speed(spin, -spin))
    return FilmsOfLines(spec.geometry, _oil_of_lines(surroundings.laws, surroundings.temperature, fastest))


def _sources_of_points(laws: ContactLaws) -> tuple[str, str]:
    """Films of balls in words."""
    return f"films from the film table of points, {laws.lubricant.title}, {laws.conditions.words}", ""


def _sources_of_lines(laws: ContactLaws) -> tuple[str, str]:
    """Films of lines in words."""
    films = _oil_of_lines(laws, 0.0)
    by_formula = FORMULAS.get(films.law)
    source = by_formula.words if by_formula else "films from the film table"
    return (
        f"{source} at radius and speed of the middle of rollers, {films.oil.title}, "
        f"{'' if by_formula else films.conditions.heat_words + ', '}"
        f"{films.conditions.supply.label}, {surface_label(films.conditions.surface)}",
        ", ribs dry",
    )


def _dry_balls(spec: BallSpec, damper: Damper) -> BallForce:
    """Force of a ball bearing."""
    return BallForce(spec.geometry, dry_law(spec.geometry, damping=damper.constant, damping_time=damper.time))


def _dry_rollers(spec: TaperedSpec, damper: Damper) -> TaperedForce:
    """Force of a bearing of rollers and ribs."""
    slices = max(spec.slices, 2)
    return TaperedForce(spec.geometry, damper.constant, damper.time, profile=spec.profile, slices=slices)


_KINDS: dict[type[LocatingSpec], _Kind] = {
    BallSpec: _Kind(
        allowed="table (films from the film table of points)",
        words=lambda spec: "ball bearing",
        sources=_sources_of_points,
        force=_dry_balls,
        films=films_of_balls,
    ),
    TaperedSpec: _Kind(
        allowed="table, formula, dietl",
        words=lambda spec: str(spec.geometry.kind).replace("bearing", "roller bearing"),
        sources=_sources_of_lines,
        force=_dry_rollers,
        films=_films_of_lines,
    ),
}
"""By what a scene holds of a bearing."""


def located_problems(spec: LocatingSpec, surroundings: Surroundings) -> list[str]:
    """Problems with such a bearing: it has one body only, or no law of its own is in force.

    Parameters
    ----------
    spec : LocatingSpec
        The bearing.
    surroundings : Surroundings
        What it is built into.
    """
    problems, kind, where = Problems(), _KINDS[type(spec)], f"bearing {spec.name!r}"
    if spec.inner.partition(":")[0] == spec.outer.partition(":")[0]:
        problems.append(f"{where}: got {spec.inner} and {spec.outer}; allowed: rings on two bodies")
    laws = surroundings.laws
    if laws.films_of(spec):
        oil, kelvin = laws.scene.lubricant, surroundings.temperature
        if oil is None:
            return [*problems, f"{where}: films need the oil of the scene; add [lubricant]"]
        with problems.after(f"{where}, {TEMPERATURE.text(kelvin)}: "):
            oil.at(kelvin)
        return problems
    try:
        if hertz_damper(laws.chosen) is not None:
            return problems
    except InputError:
        return problems  # said of the law itself
    got = f"got the law {laws.chosen!r:.60} for a {kind.words(spec)}"
    return [*problems, f"{where}: {got}; allowed: hertz, {HERTZ_FORMS}, {kind.allowed}"]


def located_law_words(laws: ContactLaws) -> list[str]:
    """Law of the bearings of a scene that carry axial load, for people: a part for each kind.

    Parameters
    ----------
    laws : ContactLaws
        Laws in force, without problems.
    """
    found = []
    for held, kind in _KINDS.items():
        specs = [spec for spec in laws.scene.located if type(spec) is held]
        words = " and ".join(dict.fromkeys(f"{kind.words(spec)}s" for spec in specs))
        if words and laws.films_of(specs[0]):
            source, left_out = kind.sources(laws)
            found.append(f"{words} with {source}, {FILM_WORDS[laws.memory]}{left_out}")
        elif words:
            damper = hertz_damper(laws.chosen)
            damped = f", {damper.words} of each contact" if damper is not None and damper.words else ""
            found.append(f"{words} dry Hertz{damped}")
    return found


def build_located(spec: LocatingSpec, surroundings: Surroundings) -> Built:
    """The element of such a bearing.

    Parameters
    ----------
    spec : LocatingSpec
        The bearing; its places exist.
    surroundings : Surroundings
        What it is built into.
    """
    laws, spin, kind = surroundings.laws, surroundings.places.spin, _KINDS[type(spec)]
    has_films = laws.films_of(spec)
    damper = (None if has_films else hertz_damper(laws.chosen)) or Damper()
    element = LocatingElement(
        name=spec.name,
        inner=spec.inner,
        outer=spec.outer,
        force=kind.force(spec, damper),
        inner_spin=spin(spec.inner),
        outer_spin=spin(spec.outer),
        start_angle=spec.start_angle,
        axial_offset=spec.axial_offset,
        films=kind.films(spec, surroundings) if has_films else None,
        memory=laws.memory if has_films else "slow",
        deviations=spec.deviations,
    )
    return Built(element, element)
