"""Basis of a contact law: the film of each contact as a smooth field, and down to which load it is known.

A film between rigid surfaces of an oil whose viscosity the pressure does not change is w ~ 1/h and c ~ h^(-3/2), and so
is the tail of a law. It is right where zeta = ln(M/M_valley(L)) is below `RIGID`. A backbone reaches down to there, and
a law reads it there also below the lowest load of its map; the tail takes over at `RIGID`. Where no backbone reaches
that far, the tail begins at the lowest load that is known, and is a guess.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray
from ehdmaps.maps.kernels.ends import ends_at
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, valley_load_number
from ehdmaps.units import LOAD

LOSS_FLOOR = 1e-4
"""Smallest loss compliance of a field, as a share of b/(u k): a tenth of what the solver's damping is good to."""


def lifted_loss(
    loss: FloatArray, half_width: FloatArray, speed: FloatArray | float, compliance: FloatArray
) -> FloatArray:
    """The larger one of a loss compliance and its floor, smoothly: a contact law is passive, and takes logarithms.

    Nothing lies below the floor: a logarithm that fell further, where a solved damping is negative, would make the
    splines of the law ring on both sides of it.

    Parameters
    ----------
    loss : array
        Loss compliance c/k^2 [m2 s/N]; below zero at the bottom of some damping valleys.
    half_width, speed, compliance : arrays that broadcast
        b [m], u [m/s] and 1/k [m2/N].
    """
    floor = LOSS_FLOOR * half_width / speed * compliance
    away = loss - floor
    lifted = 0.5 * (loss + floor + np.sqrt(away * away + 4.0 * floor * floor))  # numpy's hypot takes five times as long
    return np.maximum(lifted, floor)  # of a loss far below zero nothing but round-off is left


class FilmField(Protocol):
    """Film offset, film compliance and loss compliance at any load, speed and temperature of a map.

    The film compliance is the exact derivative of the film offset: -d(film_offset)/dw. Film offset and loss
    compliance are positive, unless `dry`. Loads and speeds beyond the ranges are continued smoothly, by the
    trend at the end of the range and at constant Moes number M in speed; temperatures are never outside.
    """

    @property
    def contacts(self) -> tuple[str, ...]:
        """Names of the contacts."""
        ...

    @property
    def load_range(self) -> tuple[float, float]:
        """Lowest and highest load [N/m]."""
        ...

    @property
    def speed_range(self) -> tuple[float, float]:
        """Lowest entrainment speed above zero, and highest [m/s]."""
        ...

    @property
    def temperature_range(self) -> tuple[float, float]:
        """Lowest and highest temperature [K]."""
        ...

    @property
    def dry(self) -> bool:
        """True where no contact has any film anywhere; `films` is then of no use."""
        ...

    def films(
        self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Film of one contact.

        Parameters
        ----------
        contact : str
            One of `contacts`.
        loads : array (n, n_u, n_T)
            Loads w [N/m], > 0, of each pair of speed and temperature.
        speeds : array (n_u,)
            Entrainment speeds [m/s], > 0.
        temperatures : array (n_T,)
            [K].

        Returns
        -------
        film_offset, film_compliance, loss_compliance : array (n, n_u, n_T)
            [m], [m2/N], [m2 s/N].
        """
        ...

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Loads from which on the film of every contact is known [N/m], (n_u, n_T).

        That of `load_range` or lower; of a map with holes it may be higher.

        Parameters
        ----------
        speeds : array (n_u,)
            Entrainment speeds [m/s], > 0.
        temperatures : array (n_T,)
            [K].
        """
        ...

    @property
    def ends(self) -> FloatArray:
        """Loads up to which the film of every contact is known, see `ehdmaps.maps.kernels.ends`.

        That of `load_range` or lower.
        """
        ...

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> FloatArray | None:
        """Factors of the closed formula of the locked film, see `ehdmaps.maps.kernels.locked_film`.

        Parameters
        ----------
        contact : str
            One of `contacts`.
        loads : array (n,)
            [N/m], > 0.
        speed, temperature : float
            [m/s], > 0, and [K].

        Returns
        -------
        array (n,) or None
            None where nothing is known of films that oscillate: the closed formula then stands as it is.
        """
        ...

    def film_differences(
        self, contact: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, ComplexArray] | None:
        """Part of the complex stiffness that films with memory leave out, see `ehdmaps.maps.kernels.film_response`.

        Parameters
        ----------
        contact, loads, speed, temperature
            The same as for `locked_factors`.

        Returns
        -------
        natural, differences : array (k,), complex array (n, k), or None
            Natural frequencies omega T, and how far the law is from the film solver there, relatively. None where
            nothing is known of films that oscillate.
        """
        ...


RIGID = -4.0
"""zeta at and below which the tail meets solved films within 0.3 % in film offset, stiffness and damping: measured with
FVA 3, L = 3 to 73, tails from there down to M = 3e-4. From zeta = -3 on it is 2 % off, from -2 on 9 %."""

FirstLoads = Callable[[FloatArray, FloatArray], FloatArray]
"""From speeds (n_u,) and temperatures (n_T,) to the loads from which on films are known, (n_u, n_T)."""

_JUST_BELOW = 0.98
"""Share of the lowest load of a map down to which its backbone is read in any case: the lines begin two nodes lower."""

_SPEEDS, _TEMPERATURES = 7, 5
"""Places at which a law is looked at."""

_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class LowLoads:
    """Loads at which the tail of a law begins, over the speeds and temperatures of its map.

    Attributes
    ----------
    lowest_load : float
        Lowest load of the map [N/m].
    begins : (float, float)
        Smallest and largest load at which the tail begins [N/m].
    guessed : float
        Share of the speeds and temperatures at which it begins where the film is not yet rigid, 0 to 1.
    largest_zeta : float
        Largest zeta at which it begins; right is `RIGID` and below.
    """

    lowest_load: float
    begins: tuple[float, float]
    guessed: float
    largest_zeta: float

    @property
    def text(self) -> str:
        """In words, such as 'films are known down to 0.2 N/mm, and below that the contact is rigid'."""
        low, high = self.begins
        known = LOAD.text(low) if low == high else f"{LOAD.text(low)} to {LOAD.text(high)}"
        if not self.guessed:
            return f"films are known down to {known}; below that the contact is rigid"
        return (
            f"films are known down to {known}; below that they are continued as those of a rigid contact, a guess at "
            f"{self.guessed:.0%} of the speeds and temperatures: M reaches {math.exp(self.largest_zeta):.2g} "
            f"M_valley(L) there, right is up to {math.exp(RIGID):.2g}"
        )


def looked_at(
    speed_range: tuple[float, float], temperature_range: tuple[float, float]
) -> tuple[FloatArray, FloatArray]:
    """Speeds [m/s] and temperatures [K] at which a law is looked at, (7,) and (5,), over the ranges of its map.

    Parameters
    ----------
    speed_range, temperature_range : (float, float)
        Ranges of the map [m/s], > 0, and [K].
    """
    return np.geomspace(*speed_range, _SPEEDS), np.linspace(*temperature_range, _TEMPERATURES)


def known_from(zeta: FloatArray, solved: BoolArray) -> float:
    """Lowest zeta from which on all lines of a backbone are solved, but not below `RIGID`.

    Parameters
    ----------
    zeta : array (n,)
        Axis of the backbone.
    solved : array (n, ...)
        Which points of each line have their numbers.
    """
    first = np.where(solved.any(axis=0), np.argmax(solved, axis=0), -1)
    return max(RIGID, float(np.max(zeta[first])))


def groups_at(
    contact: LineContact, lubricant: Lubricant, speeds: FloatArray, temperatures: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Moes' M per N/m and L of a contact at speeds and temperatures, (n_u, n_T) each.

    Parameters
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    speeds : array (n_u,) or (n_u, n_T)
        u [m/s], > 0.
    temperatures : array (n_T,)
        T [K].
    """
    every = np.broadcast_to(speeds if speeds.ndim == 2 else speeds[:, None], (len(speeds), temperatures.size))
    units, numbers = np.empty((2, *every.shape))
    for k, temperature in enumerate(temperatures.tolist()):
        state = lubricant.at(temperature)
        alpha = state.pressure_viscosity.pressure_viscosity
        units[:, k], numbers[:, k] = moes_groups(
            np.ones(len(speeds)), every[:, k], state.viscosity, alpha, contact.radius, contact.reduced_modulus
        )
    return units, numbers


def load_at(contact: LineContact, lubricant: Lubricant, zeta: float, speed: float, temperature: float) -> float:
    """Load [N/m] of a contact at a zeta.

    Parameters
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    zeta : float
        ln(M/M_valley(L)).
    speed, temperature : float
        u [m/s], > 0, and T [K].
    """
    return float(loads_at([contact], lubricant, zeta, np.array([speed]), np.array([temperature]))[0, 0])


def first_loads(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    lowest_load: float,
    start: float,
    speeds: FloatArray,
    temperatures: FloatArray,
) -> FloatArray:
    """Loads [N/m] from which on a backbone holds the films of some contacts, one for all of them, (n_u, n_T).

    Parameters
    ----------
    contacts : sequence of LineContact
        Contacts of a law.
    lubricant : Lubricant
        The oil.
    lowest_load : float
        Of the map [N/m].
    start : float
        zeta from which on films are known also below that load.
    speeds, temperatures : array (n_u,), (n_T,)
        u [m/s], > 0, and T [K].
    """
    return np.minimum(_JUST_BELOW * lowest_load, loads_at(contacts, lubricant, start, speeds, temperatures))


def valley_loads(
    contact: LineContact, lubricant: Lubricant, speeds: FloatArray, temperatures: FloatArray
) -> FloatArray:
    """Loads [N/m] of a contact at the bottom of the damping valley, (n_u, n_T).

    Parameters
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    speeds, temperatures : array (n_u,), (n_T,)
        u [m/s], > 0, and T [K].
    """
    return loads_at([contact], lubricant, 0.0, speeds, temperatures)


def same_load(lowest_load: float, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
    """One load for all speeds and temperatures, (n_u, n_T): films are known from there on only.

    Parameters
    ----------
    lowest_load : float
        [N/m].
    speeds, temperatures : array (n_u,), (n_T,)
        u [m/s] and T [K].
    """
    return np.full((len(speeds), len(temperatures)), lowest_load)


def known_at(field: FilmField, loads: FloatArray, speed: float, temperature: float) -> BoolArray:
    """Tell at which loads the films of all contacts are known, (n,): within the reach of a law.

    Parameters
    ----------
    field : FilmField
        The films.
    loads : array (n,)
        [N/m].
    speed, temperature : float
        u [m/s] and T [K]; at a standstill, where there is no film, all is known.
    """
    (slow, fast), (cold, hot) = field.speed_range, field.temperature_range
    if speed == 0.0 or field.dry:
        return np.ones(loads.shape, dtype=bool)
    low, high = 1.0 - _ROUND_OFF, 1.0 + _ROUND_OFF
    if not (low * slow <= speed <= high * fast and low * cold <= temperature <= high * hot):
        return np.zeros(loads.shape, dtype=bool)
    at = np.array([speed]), np.array([temperature])
    first, last = float(field.first_loads(*at)[0, 0]), float(ends_at(field.ends, *at)[0, 0])
    return np.asarray((loads >= low * first) & (loads <= high * last))


def low_loads(
    first: FirstLoads,
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    lowest_load: float,
    speed_range: tuple[float, float],
    temperature_range: tuple[float, float],
) -> LowLoads:
    """Loads at which the tail of a law begins.

    Parameters
    ----------
    first : callable
        From speeds (n_u,) and temperatures (n_T,) to the loads from which on films are known, as
        `FilmField.first_loads`.
    contacts : sequence of LineContact
        Contacts of the law.
    lubricant : Lubricant
        The oil.
    lowest_load : float
        Of the map [N/m].
    speed_range, temperature_range : (float, float)
        Of the map [m/s], > 0, and [K].
    """
    speeds, temperatures = looked_at(speed_range, temperature_range)
    begins = first(speeds, temperatures)
    zeta = np.log(begins / loads_at(contacts, lubricant, 0.0, speeds, temperatures))
    guessed = zeta > RIGID + _ROUND_OFF
    ends = float(np.min(begins)), float(np.max(begins))
    return LowLoads(lowest_load, ends, float(np.mean(guessed)), float(np.max(zeta)))


def guessed_at(
    first: FirstLoads, contacts: Sequence[LineContact], lubricant: Lubricant, speed: float, temperature: float
) -> float:
    """Load [N/m] below which the film of a law is a guess at one speed and temperature; 0 where it is none.

    Parameters
    ----------
    first, contacts, lubricant
        Arguments of `low_loads`.
    speed, temperature : float
        u [m/s], > 0, and T [K], within the map.
    """
    speeds, temperatures = np.array([speed]), np.array([temperature])
    begins = float(first(speeds, temperatures)[0, 0])
    right = float(loads_at(contacts, lubricant, RIGID, speeds, temperatures)[0, 0])
    return begins if begins > right * (1.0 + _ROUND_OFF) else 0.0


def loads_at(
    contacts: Sequence[LineContact], lubricant: Lubricant, zeta: float, speeds: FloatArray, temperatures: FloatArray
) -> FloatArray:
    """Smallest load of some contacts at a zeta [N/m], (n_u, n_T).

    Parameters
    ----------
    contacts : sequence of LineContact
        The contacts.
    lubricant : Lubricant
        The oil.
    zeta : float
        ln(M/M_valley(L)).
    speeds, temperatures : array (n_u,), (n_T,)
        u [m/s], > 0, and T [K].
    """
    groups = [groups_at(contact, lubricant, np.asarray(speeds), np.asarray(temperatures)) for contact in contacts]
    loads: FloatArray = np.min([math.exp(zeta) * valley_load_number(L) / unit for unit, L in groups], axis=0)
    return loads


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

    @property
    def ends(self) -> FloatArray:
        """Those of the map; see `FilmField.ends`."""
        return self.origin.ends

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> None:
        """Nothing is known of films that oscillate; see `FilmField.locked_factors`."""

    def film_differences(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> None:
        """Nothing is known of films that oscillate; see `FilmField.film_differences`."""
