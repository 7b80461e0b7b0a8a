"""Films of tapered rollers, and of rollers between ribs: laws of lines at the middle of a roller, over the speed.

They are those of a cylindrical roller bearing with the same contacts, `mbs.bearings.tapered.line_film.cylinder_of`:
from the film table, or of the formula.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.heat import beyond_rule
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import PLAIN, FilmConditions
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.physics.solids import STEEL
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.films import FilmSource, FormulaFilms, MapFilms
from mbs.bearings.tapered.line_film import LOADS, LineFilms, cylinder_of, line_films

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from ehdmaps.maps.law import ContactLaw

_SPEEDS, _BEYOND = (0.05, 10.0), 1.05
"""Entrainment speeds of the laws [m/s], and how far they go beyond what is asked for."""


@dataclass(frozen=True)
class OilOfLines:
    """Films that lines of a bearing are to have.

    Attributes
    ----------
    law : str
        Source of the films: "table" for the film table, or one of `FORMULAS` of `mbs.bearings.laws`.
    oil : Lubricant
        The oil.
    temperature : float
        Temperature of the raceways [K].
    fastest : float
        Highest entrainment speed that is asked for [m/s].
    conditions : FilmConditions
        Heat in the inlet of films of the table, oil supply and surfaces.
    """

    law: str
    oil: Lubricant
    temperature: float
    fastest: float = 0.0
    conditions: FilmConditions = PLAIN


@dataclass(frozen=True)
class FilmsOfLines:
    """Laws of both lines of a roller by the speeds of the rings.

    Attributes
    ----------
    geometry : TaperedGeometry
        The bearing.
    films : OilOfLines
        What films it has.
    """

    geometry: TaperedGeometry
    films: OilOfLines

    def __call__(self, inner_speed: float, outer_speed: float) -> LineFilms:
        """Laws at speeds of the inner and the outer ring [rad/s]."""
        u = abs(self.geometry.entrainment_speed(inner_speed, outer_speed))
        return _films_at(cylinder_of(self.geometry), self.films, u)

    def note(self, inner_speed: float, outer_speed: float) -> str:
        """Remark on the films at speeds of the rings [rad/s]; empty where there is nothing to say."""
        if not self.films.conditions.inlet_heat or self.films.law in laws.FORMULAS:
            return ""
        u = abs(self.geometry.entrainment_speed(inner_speed, outer_speed))
        return beyond_rule(self.films.oil, u, self.temperature)

    @property
    def lines(self) -> FilmSource:
        """Source of pressures, films and rolling forces of both lines."""
        return _lines(cylinder_of(self.geometry), self.films)

    @property
    def temperature(self) -> float:
        """Temperature of the raceways [K]."""
        return self.films.temperature

    @property
    def source(self) -> str:
        """Name what films are read from, for people."""
        return "the table of the film formula" if self.films.law in laws.FORMULAS else "the film table"

    @property
    def slowest(self) -> float:
        """Entrainment speed below which films fade to dry lines [m/s]."""
        return _laws(cylinder_of(self.geometry), self.films)[0].speed_range[0]

    @property
    def error_words(self) -> str:
        """Name the errors that its laws state, for people; empty for laws that state none."""
        errors = _laws(cylinder_of(self.geometry), self.films)[0].errors
        return "" if errors is None else errors.words


@functools.lru_cache(maxsize=512)
def _films_at(cylinder: BearingGeometry, films: OilOfLines, u: float) -> LineFilms:
    """Laws at an entrainment speed [m/s]; alike bearings have them made once."""
    return line_films(_laws(cylinder, films), cylinder.roller_length, u, films.temperature)


@functools.lru_cache(maxsize=16)
def _map(cylinder: BearingGeometry, films: OilOfLines) -> EHDMap:
    """The map with the films of the table."""
    from ehdmaps.jobs.make.table_law import TEMPERATURES, table_map

    temperatures = min(TEMPERATURES[0], films.temperature), max(TEMPERATURES[1], films.temperature)
    return table_map(cylinder, films.oil, LOADS, _speeds(films), temperatures, inlet_heat=films.conditions.inlet_heat)


@functools.lru_cache(maxsize=16)
def _lines(cylinder: BearingGeometry, films: OilOfLines) -> FilmSource:
    """Pressures, films and rolling forces."""
    if films.law in laws.FORMULAS:
        return FormulaFilms(cylinder.contacts(STEEL, "iso16281"), films.oil, films.conditions.supply)
    return MapFilms(_map(cylinder, films), films.conditions.supply)


def _speeds(films: OilOfLines) -> tuple[float, float]:
    """Entrainment speeds of the laws [m/s]."""
    return _SPEEDS[0], max(_SPEEDS[1], _BEYOND * films.fastest)


@functools.lru_cache(maxsize=16)
def _laws(cylinder: BearingGeometry, films: OilOfLines) -> tuple[ContactLaw, ContactLaw]:
    """Laws of the inner and the outer contact, held where the table ends."""
    speeds = _speeds(films)
    if films.law in laws.FORMULAS:
        inner, outer = (
            laws.formula(
                Bearing(cylinder),
                films.oil,
                load=LOADS,
                entrainment_speed=speeds,
                damping=laws.FORMULAS[films.law].damping,
                kind=kind,
                outside="clamp",
                supply=films.conditions.supply,
                surface=films.conditions.surface,
            )
            for kind in ("inner", "outer")
        )
        return inner, outer
    emap = _map(cylinder, films)
    chosen = films.conditions
    inner, outer = (
        emap.law(kind, "clamp", supply=chosen.supply, surface=chosen.surface) for kind in ("inner", "outer")
    )
    return inner, outer
