"""Ball bearings of a scene: the law in force, what is wrong about it, and the element."""

from __future__ import annotations

import dataclasses
import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.film_formulas import POINT_FILMS
from ehdmaps.physics.solids import STEEL
from ehdmaps.units import TEMPERATURE
from mbs.model.relaxation import FILM_WORDS
from mbs.scene.specs import BallSpec

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from mbs.bearings.balls.films import BallFilms
    from mbs.bearings.balls.laws import BallLaw
    from mbs.bearings.reports.ball_report import PointFilmSource
    from mbs.scene.contact_laws import ContactLaws
    from mbs.scene.surroundings import Built, Surroundings


FILMS = ("table", "map")
"""Laws with which ball bearings have films, from the film table of points."""

_CENTRAL, _SMALLEST = 0.67, 0.68
"""Exponents of the speed in the film formulas of Hamrock and Dowson."""


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
    error_words = "errors of the film table of points"

    @property
    def points(self) -> PointFilmSource:
        """Source of films and rolling forces of both contacts."""
        return _Points(self)

    @property
    def slowest(self) -> float:
        """Entrainment speed below which films fade to the dry contacts [m/s]."""
        from mbs.bearings.balls.films import slowest_films

        return slowest_films(self.geometry, self.oil, self.temperature)


@functools.lru_cache(maxsize=512)  # a run over a decade of speed has 120 laws, and comes back to them
def _film_law(films: _TableFilms, u: float) -> BallLaw:
    """The law at an entrainment speed [m/s]; alike bearings read it once."""
    slowest = _slowest(films)
    if u >= slowest:
        return _films_at(films, u).law
    return _films_at(films, slowest).faded(films.geometry, u / slowest)


@functools.lru_cache(maxsize=16)
def _slowest(films: _TableFilms) -> float:
    """The lowest speed with films [m/s]."""
    return films.slowest


@functools.lru_cache(maxsize=512)
def _films_at(films: _TableFilms, u: float) -> BallFilms:
    """Films at an entrainment speed of the table [m/s]."""
    from mbs.bearings.balls.films import ball_films

    return ball_films(films.geometry, films.oil, u, films.temperature, solves=False)


@functools.lru_cache(maxsize=32)
def _line_map(films: _TableFilms, side: int) -> EHDMap:
    """Map of a line contact with the radius of a contact along the motion, for its rolling forces."""
    from ehdmaps.jobs.make.table_law import LOADS, TEMPERATURES, table_map

    ellipse = films.geometry.contacts(STEEL)[side]
    contact = LineContact("line", ellipse.rolling_radius, STEEL, "half_space", reference_depth=ellipse.rolling_radius)
    temperatures = min(TEMPERATURES[0], films.temperature), max(TEMPERATURES[1], films.temperature)
    return table_map(contact, films.oil, LOADS, temperatures=temperatures)


@dataclass(frozen=True)
class _Points:
    """Films and rolling forces of the contacts of a geometry, see `PointFilmSource`."""

    of: _TableFilms

    def films(self, side: int, load: FloatArray, entrainment_speed: float) -> tuple[FloatArray, FloatArray]:
        """Those of the table; below its speeds they go on as the formula of Hamrock and Dowson does."""
        u = max(entrainment_speed, _slowest(self.of))
        (_, central, smallest, _), _ = _films_at(self.of, u).sides[side].read(load)
        slower = entrainment_speed / u
        return central * slower**_CENTRAL, smallest * slower**_SMALLEST

    def line_force(self, side: int, load: FloatArray, entrainment_speed: float) -> FloatArray:
        """That of the film table of lines; NaN where it has none."""
        rolling = _line_map(self.of, side).rolling_film
        if rolling is None:
            return np.full(load.shape, np.nan)
        return rolling.rolling_force("line", load, entrainment_speed, self.of.temperature)
