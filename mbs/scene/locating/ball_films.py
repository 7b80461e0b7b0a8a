"""Films of ball bearings: laws of their contacts over the speed, from the film table of points."""

from __future__ import annotations

import dataclasses
import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.heat import beyond_rule
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import PLAIN, FilmConditions
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.solids import STEEL
from mbs.scene.specs import BallSpec

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from mbs.bearings.balls.ball_report import PointFilmSource
    from mbs.bearings.balls.films import BallFilms
    from mbs.bearings.balls.laws import BallLaw
    from mbs.scene.surroundings import Surroundings


_CENTRAL, _SMALLEST = 0.67, 0.68
"""Exponents of the speed in the film formulas of Hamrock and Dowson."""


def films_of_balls(spec: BallSpec, surroundings: Surroundings) -> FilmsOfPoints:
    """Laws of the contacts of a ball bearing over the speeds of its rings.

    Parameters
    ----------
    spec : BallSpec
        The bearing.
    surroundings : Surroundings
        What it is built into.
    """
    laws = surroundings.laws
    return FilmsOfPoints(spec.geometry, laws.lubricant, surroundings.temperature, laws.conditions)


@dataclass(frozen=True)
class FilmsOfPoints:
    """Laws of a geometry with the films of two speeds of the rings, from the film table of points.

    Attributes
    ----------
    geometry : BallGeometry
        The bearing.
    oil : Lubricant
        The oil.
    temperature : float
        Temperature of the raceways [K].
    conditions : FilmConditions
        Heat in the inlet, oil supply and surfaces.
    solves : bool
        Whether films that the table has not are solved, at any speed; else they fade below its speeds.
    """

    geometry: BallGeometry
    oil: Lubricant
    temperature: float
    conditions: FilmConditions = PLAIN
    solves: bool = False

    def __post_init__(self) -> None:
        # films depend neither on the clearance nor on which way it stands
        same = dataclasses.replace(self.geometry, clearance=0.0, contact_angle=abs(self.geometry.contact_angle))
        object.__setattr__(self, "geometry", same)

    def __call__(self, inner_speed: float, outer_speed: float) -> BallLaw:
        """Laws at speeds of the inner and the outer ring [rad/s]."""
        return _film_law(self, self.geometry.entrainment_speed(inner_speed, outer_speed))

    def at(self, entrainment_speed: float) -> BallFilms:
        """Films at an entrainment speed of the table, or at any where they are solved [m/s].

        Raises
        ------
        SolverError
            Where there are none.
        """
        return _films_at(self, entrainment_speed)

    def note(self, inner_speed: float, outer_speed: float) -> str:
        """Remark on the films at speeds of the rings [rad/s]; empty where there is nothing to say."""
        if not self.conditions.inlet_heat:
            return ""
        return beyond_rule(self.oil, self.geometry.entrainment_speed(inner_speed, outer_speed), self.temperature)

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

        return 0.0 if self.solves else slowest_films(self.geometry, self.oil, self.temperature)


@functools.lru_cache(maxsize=512)  # a run over a decade of speed has 120 laws, and comes back to them
def _film_law(films: FilmsOfPoints, u: float) -> BallLaw:
    """The law at an entrainment speed [m/s]; alike bearings read it once."""
    slowest = _slowest(films)
    if u >= slowest:
        return _films_at(films, u).law
    return _films_at(films, slowest).faded(films.geometry, u / slowest)


@functools.lru_cache(maxsize=16)
def _slowest(films: FilmsOfPoints) -> float:
    """The lowest speed with films [m/s]."""
    return films.slowest


@functools.lru_cache(maxsize=512)
def _films_at(films: FilmsOfPoints, u: float) -> BallFilms:
    """Films at an entrainment speed of the table [m/s]."""
    from mbs.bearings.balls.films import ball_films

    at = films.geometry, films.oil, u, films.temperature
    return ball_films(*at, solves=films.solves, conditions=films.conditions)


@functools.lru_cache(maxsize=32)
def _line_map(films: FilmsOfPoints, side: int) -> EHDMap:
    """Map of a line contact with the radius of a contact along the motion, for its rolling forces."""
    from ehdmaps.jobs.make.table_law import LOADS, TEMPERATURES, table_map

    ellipse = films.geometry.contacts(STEEL)[side]
    contact = LineContact("line", ellipse.rolling_radius, STEEL, "half_space", reference_depth=ellipse.rolling_radius)
    temperatures = min(TEMPERATURES[0], films.temperature), max(TEMPERATURES[1], films.temperature)
    return table_map(contact, films.oil, LOADS, temperatures=temperatures, inlet_heat=films.conditions.inlet_heat)


@dataclass(frozen=True)
class _Points:
    """Films and rolling forces of the contacts of a geometry, see `PointFilmSource`."""

    of: FilmsOfPoints

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
        at = "line", load, entrainment_speed, self.of.temperature
        return rolling.rolling_force(*at, self.of.conditions.supply)
