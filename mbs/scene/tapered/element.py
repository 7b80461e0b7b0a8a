"""Bearings of tapered rollers, or of rollers between ribs, in a scene: their law, what is wrong, the element."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ehdmaps.errors import InputError
from ehdmaps.physics.oil_supply import FLOODED
from ehdmaps.physics.rollers.ribbed_geometry import RibbedGeometry
from ehdmaps.physics.surface import SMOOTH
from ehdmaps.units import TEMPERATURE
from mbs.model.relaxation import FILM_WORDS
from mbs.scene.specs import TaperedSpec

if TYPE_CHECKING:
    from mbs.scene.contact_laws import ContactLaws
    from mbs.scene.surroundings import Built, Surroundings
    from mbs.scene.tapered.films import FilmsOfLines, OilOfLines

FILMS = ("table", "map", "formula")
"""Laws with which lines have films: of the formula, else from the film table."""


def tapered_problems(spec: TaperedSpec, surroundings: Surroundings) -> list[str]:
    """Problems with such a bearing: it has one body only, or no law of its own is in force.

    Parameters
    ----------
    spec : TaperedSpec
        The bearing.
    surroundings : Surroundings
        What it is built into.
    """
    from mbs.scene.contact_laws import HERTZ_FORMS, hertz_damper

    problems = []
    if spec.inner.partition(":")[0] == spec.outer.partition(":")[0]:
        problems.append(f"bearing {spec.name!r}: got {spec.inner} and {spec.outer}; allowed: rings on two bodies")
    laws = surroundings.laws
    if laws.chosen in FILMS:
        oil, kelvin = laws.scene.lubricant, surroundings.temperature
        if oil is None:
            return [*problems, f"bearing {spec.name!r}: films need the oil of the scene; add [lubricant]"]
        try:
            oil.at(kelvin)
        except InputError as error:
            problems += [f"bearing {spec.name!r}, {TEMPERATURE.text(kelvin)}: {problem}" for problem in error.problems]
        return problems
    try:
        if hertz_damper(laws.chosen) is not None:
            return problems
    except InputError:
        return problems  # said of the law itself
    problems.append(
        f"bearing {spec.name!r}: got the law {laws.chosen!r:.60} for a {_kind(spec)}; allowed: hertz, "
        f"{HERTZ_FORMS}, table, formula"
    )
    return problems


def tapered_law_words(laws: ContactLaws) -> str:
    """Law of the bearings of tapered rollers, or of rollers between ribs, of a scene, for people.

    Parameters
    ----------
    laws : ContactLaws
        Laws in force, without problems.
    """
    from mbs.scene.contact_laws import hertz_damper, surface_label

    kinds = " and ".join(dict.fromkeys(f"{_kind(spec)}s" for spec in laws.scene.tapered))
    if laws.chosen in FILMS:
        films = _oil_of_lines(laws, 0.0)
        source = "film formula moes" if films.law == "formula" else "films from the film table"
        return (
            f"{kinds} with {source} at radius and speed of the middle of rollers, {films.oil.title}, "
            f"{films.supply.label}, {surface_label(films.surface)}, {FILM_WORDS[laws.memory]}, ribs dry"
        )
    damper = hertz_damper(laws.chosen)
    words = f", {damper.words} of each contact" if damper is not None and damper.words else ""
    return f"{kinds} dry Hertz{words}"


def _kind(spec: TaperedSpec) -> str:
    """Kind of a bearing, in words."""
    return "ribbed roller bearing" if isinstance(spec.geometry, RibbedGeometry) else "tapered roller bearing"


def build_tapered(spec: TaperedSpec, surroundings: Surroundings) -> Built:
    """The element of a bearing of tapered rollers, or of rollers between ribs.

    Parameters
    ----------
    spec : TaperedSpec
        The bearing; its places exist.
    surroundings : Surroundings
        What it is built into.
    """
    from mbs.bearings.tapered.tapered_bearing import TaperedForce
    from mbs.bearings.tapered.tapered_element import TaperedElement
    from mbs.scene.contact_laws import Damper, hertz_damper
    from mbs.scene.surroundings import Built

    laws, spin = surroundings.laws, surroundings.places.spin
    has_films = laws.chosen in FILMS
    damper = (None if has_films else hertz_damper(laws.chosen)) or Damper()
    element = TaperedElement(
        name=spec.name,
        inner=spec.inner,
        outer=spec.outer,
        force=TaperedForce(
            spec.geometry, damper.constant, damper.time, profile=spec.profile, slices=max(spec.slices, 2)
        ),
        inner_spin=spin(spec.inner),
        outer_spin=spin(spec.outer),
        start_angle=spec.start_angle,
        axial_offset=spec.axial_offset,
        films=_films(spec, surroundings) if has_films else None,
        memory=laws.memory if has_films else "slow",
    )
    return Built(element, element)


def _films(spec: TaperedSpec, surroundings: Surroundings) -> FilmsOfLines:
    """Laws of the lines of a bearing over the speeds of its rings."""
    from mbs.scene.tapered.films import FilmsOfLines

    scene = surroundings.laws.scene
    spin = max((abs(body.spin) for body in scene.bodies), default=0.0) * scene.fastest
    # rings turn against each other at most
    fastest = abs(spec.geometry.entrainment_speed(spin, -spin))
    return FilmsOfLines(spec.geometry, _oil_of_lines(surroundings.laws, surroundings.temperature, fastest))


def _oil_of_lines(laws: ContactLaws, temperature: float, fastest: float = 0.0) -> OilOfLines:
    """Films of the law in force."""
    from mbs.scene.tapered.films import OilOfLines

    return OilOfLines(
        "formula" if laws.chosen == "formula" else "table",
        laws.lubricant,
        temperature,
        fastest,
        laws.asked_supply or laws.scene.supply or FLOODED,
        laws.surface or laws.scene.surface or SMOOTH,
    )
