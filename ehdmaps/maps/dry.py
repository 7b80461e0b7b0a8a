"""Stand-in for a map without any film: a law needs a smooth curve to hang the dry contact on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.low_loads import same_load

_FILM, _THIN_FILM = 1e-6, 1e-12


@dataclass(frozen=True)
class DryField:
    """A rigid film h ~ 1/w over the ranges of a dry map.

    Between smooth surfaces the law fades it out entirely, as at standstill, so that its size is of no consequence.
    Between rough ones it is there, below the size of an atom, so that asperities carry everything.

    Attributes
    ----------
    origin : FilmField
        Field without a film.
    rough : bool
        Whether the surfaces are rough.
    """

    origin: FilmField
    rough: bool = False

    @property
    def contacts(self) -> tuple[str, ...]:
        """Those of the map."""
        return self.origin.contacts

    @property
    def load_range(self) -> tuple[float, float]:
        """That of the map [N/m]."""
        return self.origin.load_range

    @property
    def speed_range(self) -> tuple[float, float]:
        """That of the map [m/s]."""
        return self.origin.speed_range

    @property
    def temperature_range(self) -> tuple[float, float]:
        """That of the map [K]."""
        return self.origin.temperature_range

    @property
    def dry(self) -> bool:
        """The stand-in has a film."""
        return False

    def films(
        self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """h ~ w1/w, its compliance and some loss; see `FilmField.films`."""
        film = (_THIN_FILM if self.rough else _FILM) * self.load_range[0] / loads
        return film, film / loads, np.asarray(1e-3 * film / loads)

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """The lowest load everywhere; see `FilmField.first_loads`."""
        return same_load(self.load_range[0], speeds, temperatures)

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> None:
        """Nothing is known of films that oscillate; see `FilmField.locked_factors`."""

    def film_differences(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> None:
        """Nothing is known of films that oscillate; see `FilmField.film_differences`."""
