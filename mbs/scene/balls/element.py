"""Ball bearings of a scene: the law in force, what is wrong about it, and the element."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.film_formulas import POINT_FILMS
from ehdmaps.units import TEMPERATURE
from mbs.model.relaxation import FILM_WORDS
from mbs.scene.specs import BallSpec

if TYPE_CHECKING:
    from mbs.bearings.balls.films import BallFilms
    from mbs.bearings.balls.laws import BallLaw
    from mbs.scene.contact_laws import ContactLaws
    from mbs.scene.surroundings import Built, Surroundings


FILMS = ("table", "map")
"""Laws with which ball bearings have films, from the film table of points."""


def ball_problems(spec: BallSpec, surroundings: Surroundings) -> list[str]:
    """Problems with a ball bearing: it has one body only, or no law of balls is in force.

    Parameters
    ----------
    spec : BallSpec
        The bearing.
    surroundings : Surroundings
        What it is built into.
    """
    problems = []
    if spec.inner.partition(":")[0] == spec.outer.partition(":")[0]:
        problems.append(f"bearing {spec.name!r}: got {spec.inner} and {spec.outer}; allowed: rings on two bodies")
    return problems + ball_law_problems(spec.name, surroundings.laws)


def ball_law_problems(name: str, laws: ContactLaws) -> list[str]:
    """In what the law in force is none for a ball bearing.

    Parameters
    ----------
    name : str
        Name of the bearing.
    laws : ContactLaws
        Laws in force.
    """
    from mbs.scene.contact_laws import HERTZ_FORMS, hertz_damper

    if laws.chosen in FILMS:
        oil, kelvin = laws.scene.lubricant, laws.scene.temperature
        if oil is None:
            return [f"bearing {name!r}: films of ball bearings need the oil of the scene; add [lubricant]"]
        supply = laws.asked_supply or laws.scene.supply
        if supply is not None and not supply.flooded:
            return [
                f"bearing {name!r}: got {supply.label}; films of ball bearings are flooded; allowed: no [supply] and "
                "no --supply, or dry contacts"
            ]
        try:
            oil.at(kelvin)
        except InputError as error:
            return [f"bearing {name!r}, {TEMPERATURE.text(kelvin)}: {problem}" for problem in error.problems]
        return []
    try:
        damper = hertz_damper(laws.chosen)
    except InputError:
        return []  # said of the law itself
    if damper is not None:
        return []
    return [
        f"bearing {name!r}: got the law {laws.chosen!r:.60} for a ball bearing; allowed: hertz, {HERTZ_FORMS}, table "
        "(films from the film table of points)"
    ]


def ball_law_words(laws: ContactLaws) -> str:
    """Law of the ball bearings of a scene, for people.

    Parameters
    ----------
    laws : ContactLaws
        Laws in force, without problems.
    """
    from mbs.scene.contact_laws import hertz_damper

    if laws.chosen in FILMS:
        source = f"ball bearings with films from the film table of points, {laws.lubricant.title}, {POINT_FILMS}"
        return f"{source}, {FILM_WORDS[laws.memory]}"
    damper = hertz_damper(laws.chosen)
    words = f", {damper.words} of each contact" if damper is not None and damper.words else ""
    return f"ball bearings dry Hertz{words}"


def build_ball(spec: BallSpec, surroundings: Surroundings) -> Built:
    """The element of a ball bearing.

    Parameters
    ----------
    spec : BallSpec
        The bearing; its places exist.
    surroundings : Surroundings
        What it is built into.
    """
    from mbs.bearings.balls.ball_bearing import BallForce
    from mbs.bearings.balls.ball_element import MachineBalls
    from mbs.bearings.balls.laws import dry_law
    from mbs.scene.contact_laws import Damper, hertz_damper
    from mbs.scene.surroundings import Built

    laws = surroundings.laws
    has_films = laws.chosen in FILMS
    damper = (None if has_films else hertz_damper(laws.chosen)) or Damper()
    law = dry_law(spec.geometry, damping=damper.constant, damping_time=damper.time)
    element = MachineBalls(
        name=spec.name,
        inner=spec.inner,
        outer=spec.outer,
        force=BallForce(spec.geometry, law),
        inner_spin=surroundings.places.spin(spec.inner),
        outer_spin=surroundings.places.spin(spec.outer),
        start_angle=spec.start_angle,
        axial_offset=spec.axial_offset,
        films=_TableFilms(_contacts_of(spec.geometry), laws.lubricant, surroundings.temperature) if has_films else None,
        memory=laws.memory if has_films else "slow",
    )
    return Built(element, element)


def _contacts_of(geometry: BallGeometry) -> BallGeometry:
    """The geometry without what its films do not depend on: clearance, and which way it stands."""
    return dataclasses.replace(geometry, clearance=0.0, contact_angle=abs(geometry.contact_angle))


@dataclass(frozen=True)
class _TableFilms:
    """Law of a geometry with the films of two speeds of the rings, read from the film table of points."""

    geometry: BallGeometry
    oil: Lubricant
    temperature: float

    def __call__(self, inner_speed: float, outer_speed: float) -> BallLaw:
        return _film_law(self, self.geometry.entrainment_speed(inner_speed, outer_speed))

    source = "the film table of points"

    @property
    def slowest(self) -> float:
        """Entrainment speed below which films fade to the dry contacts [m/s]."""
        from mbs.bearings.balls.films import slowest_films

        return slowest_films(self.geometry, self.oil, self.temperature)


@functools.lru_cache(maxsize=512)  # a run over a decade of speed has 120 laws, and comes back to them
def _film_law(films: _TableFilms, u: float) -> BallLaw:
    """The law at an entrainment speed [m/s]; alike bearings read it once."""
    from mbs.bearings.balls.films import ball_films

    slowest, read = _slowest(films)
    if u >= slowest:
        return ball_films(films.geometry, films.oil, u, films.temperature, solves=False).law
    return read().faded(films.geometry, u / slowest)


@functools.lru_cache(maxsize=16)
def _slowest(films: _TableFilms) -> tuple[float, Callable[[], BallFilms]]:
    """The lowest speed with films [m/s], and a function that reads these once."""
    from mbs.bearings.balls.films import ball_films

    slowest = films.slowest

    @functools.cache
    def read() -> BallFilms:
        return ball_films(films.geometry, films.oil, slowest, films.temperature, solves=False)

    return slowest, read
