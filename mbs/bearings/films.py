"""Largest pressure, films and rolling force of the contacts of a roller, at loads per length: dry, by formula, by map.

Three sources answer the same question, `state(side, load, entrainment_speed, temperature)`, for arrays of loads:

- `DryContacts`: Hertz' pressure, no film;
- `FormulaFilms`: Hertz' pressure, Moes' central film, and the larger of the minimum films of Dowson-Higginson and of
  Martin, as the solver `formula` has them;
- `MapFilms`: pressures and films of a map, read between its points as ratios to Hertz and to Moes. The ratios are near
  one and change little, so that straight lines between the points are enough for them. Rolling forces only a map knows,
  see `ehdmaps.maps.rolling_film`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.errors import MapError
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.films import dowson_higginson_minimum, martin_minimum, moes_central
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import dowson_groups, film_from_moes, moes_groups
from ehdmaps.physics.oil_supply import FLOODED, RIGID_FLOW, OilSupply, film_ratio, passing, pressure_ratio

if TYPE_CHECKING:
    from ehdmaps.maps.edges.reach import Reach
    from ehdmaps.maps.emap import EHDMap

SIDES = ("inner", "outer")
"""The contacts of a roller, in the order of all arrays."""

_VARIABLES = ("max_pressure", "central_film", "minimum_film")
_ERRORS = ("max_pressure_error", "minimum_film_error")


@dataclass(frozen=True, eq=False)
class ContactState:
    """Contacts at given loads; all arrays have the shape of the loads.

    Attributes
    ----------
    hertz_pressure : array
        Largest pressure of the dry contact after Hertz [Pa]; zero without load.
    max_pressure : array
        Largest pressure of the film, its spike included, where a map knows it; else that of Hertz [Pa].
    central_film, minimum_film : array
        Film at the centre and smallest film [m]; NaN without load, and where no film is known.
    rolling_force : array
        Force of both walls together against pure rolling [N/m]; zero without load, NaN where none is known.
    pressure_error : array
        Stated error of the largest pressure, see `ehdmaps.physics.solution`; zero for that of Hertz, NaN where none is
        stated.
    film_error : array or None
        Stated error of the smallest film, over it, or NaN; None of sources that state none.
    """

    hertz_pressure: FloatArray
    max_pressure: FloatArray
    central_film: FloatArray
    minimum_film: FloatArray
    rolling_force: FloatArray
    pressure_error: FloatArray
    film_error: FloatArray | None = None


def error_of_smallest(film: FloatArray, error: FloatArray | None) -> float:
    """Stated error of the smallest of some films, over it; NaN where there is no film, or none is stated.

    Parameters
    ----------
    film : array
        Films [m]; NaN where there is none.
    error : array or None
        Their stated errors.
    """
    known = np.isfinite(film)
    return math.nan if error is None or not known.any() else float(error.flat[int(np.nanargmin(film))])


class FilmSource(Protocol):
    """Source of pressures, films and rolling forces of both contacts of a roller."""

    @property
    def words(self) -> str:
        """Origin of the films, for people."""
        ...

    @property
    def lubricant(self) -> Lubricant | None:
        """The oil; None where none is known."""
        ...

    def state(self, side: int, load: FloatArray, entrainment_speed: float, temperature: float) -> ContactState:
        """Pressure and films of the inner (0) or outer (1) contact at loads w [N/m], at u [m/s] and T [K].

        Parameters
        ----------
        side : int
            0: inner contact, 1: outer contact.
        load : ndarray
            Loads w [N/m].
        entrainment_speed : float
            u [m/s].
        temperature : float
            T [K].
        """
        ...


def on_supply(state: ContactState, flow: FloatArray, supply: OilSupply) -> ContactState:
    """Contacts on an oil layer, from those that are flooded; see `ehdmaps.physics.oil_supply`.

    The film has the ratio of the starved contact between rigid surfaces. So has the largest pressure, up to that of
    Hertz; a spike above it is left as it is. The rolling force is left alone.

    Parameters
    ----------
    state : ContactState
        Flooded contacts.
    flow : array
        Their mass flow over density at rest and speed [m].
    supply : OilSupply
        Oil before the contacts.
    """
    if supply.flooded:
        return state
    passed = passing(flow, supply.oil_layer)
    root = np.sqrt(passed)
    film = passed * film_ratio(root)[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        risen = np.where(passed > 0.0, state.max_pressure * pressure_ratio(root) * root**-1.5, 0.0)
    return replace(
        state,
        max_pressure=np.minimum(risen, np.maximum(state.max_pressure, state.hertz_pressure)),
        central_film=film * state.central_film,
        minimum_film=film * state.minimum_film,
    )


@dataclass(frozen=True)
class DryContacts:
    """Contacts without a film.

    Attributes
    ----------
    contacts : tuple of LineContact
        Inner and outer.
    """

    contacts: tuple[LineContact, ...]

    @property
    def words(self) -> str:
        """No films."""
        return "no films: no oil is known"

    @property
    def lubricant(self) -> Lubricant | None:
        """No oil."""
        return None

    def state(self, side: int, load: FloatArray, entrainment_speed: float, temperature: float) -> ContactState:
        """Hertz' pressure; see `FilmSource.state`."""
        contact = self.contacts[side]
        pressure = np.asarray(max_pressure(load, contact.radius, contact.reduced_modulus))
        unknown = np.full(load.shape, np.nan)
        return ContactState(pressure, pressure, unknown, unknown, unknown, np.zeros(load.shape))


@dataclass(frozen=True)
class FormulaFilms:
    """Films by published formulas; for the limits of these see `ehdmaps.physics.films`.

    Attributes
    ----------
    contacts : tuple of LineContact
        Inner and outer.
    lubricant : Lubricant
        The oil.
    supply : OilSupply
        Oil before each contact; flooded if left out.
    """

    contacts: tuple[LineContact, ...]
    lubricant: Lubricant
    supply: OilSupply = FLOODED

    @property
    def words(self) -> str:
        """The formulas."""
        formulas = "Moes' formula (minimum: Dowson-Higginson, Martin)"
        return f"films: {formulas} for {self.lubricant.title}, {self.supply.label}"

    def state(self, side: int, load: FloatArray, entrainment_speed: float, temperature: float) -> ContactState:
        """Hertz' pressure and films by formula, zero at standstill; see `FilmSource.state`."""
        contact = self.contacts[side]
        pressure = np.asarray(max_pressure(load, contact.radius, contact.reduced_modulus))
        loaded = load > 0.0
        central, minimum = np.full(load.shape, np.nan), np.full(load.shape, np.nan)
        central[loaded], minimum[loaded] = self._films(contact, load[loaded], abs(entrainment_speed), temperature)
        state = ContactState(pressure, pressure, central, minimum, np.full(load.shape, np.nan), np.zeros(load.shape))
        return on_supply(state, RIGID_FLOW * central, self.supply)

    def _films(
        self, contact: LineContact, load: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, FloatArray]:
        """Central and minimum film at positive loads."""
        if speed == 0.0:
            return np.zeros(load.shape), np.zeros(load.shape)
        state = self.lubricant.at(temperature)
        alpha, radius, modulus = state.pressure_viscosity.pressure_viscosity, contact.radius, contact.reduced_modulus
        arguments = (load, speed, state.viscosity, alpha, radius, modulus)
        M, L = moes_groups(*arguments)
        central = film_from_moes(moes_central(M, L), speed, state.viscosity, radius, modulus)
        rigid = film_from_moes(martin_minimum(M), speed, state.viscosity, radius, modulus)
        elastic = radius * dowson_higginson_minimum(*dowson_groups(*arguments))
        return np.asarray(central), np.minimum(np.maximum(rigid, elastic), central)


@dataclass(frozen=True, eq=False)
class MapFilms:
    """Pressures and films of a map.

    The ratios of central and minimum film to Moes' central film, and of the largest pressure to that of Hertz, are read
    on the lines of the map, linearly in ln(load) at the same Moes number M, and taken linearly in ln(entrainment speed)
    and temperature between the lines. Outside the map they are those of its edge; the temperature is held there,
    as a law with the policy `clamp` holds it.

    Attributes
    ----------
    emap : EHDMap
        Map of a bearing.
    supply : OilSupply, optional
        Oil before each contact; what the job of the map states if left out.

    Raises
    ------
    MapError
        For a map without the contacts of a roller, or without pressures and films at any of its points.
    """

    emap: EHDMap
    supply: OilSupply | None = None
    _formula: FormulaFilms = field(init=False)

    def __post_init__(self) -> None:
        if tuple(contact.name for contact in self.emap.contacts) != SIDES:
            raise MapError("films: got the map of a bare contact; allowed: a map of a bearing")
        if self._known[0] is None:
            raise MapError(
                f"films: the map has no two loads at any speed and temperature with {', '.join(_VARIABLES)}; solve its "
                "points again with other settings of the solver, or take films that need no points: --law table"
            )
        object.__setattr__(self, "_formula", FormulaFilms(self.emap.contacts, self.emap.lubricant))

    @property
    def words(self) -> str:
        """The map."""
        return f"films of the map, {self.lubricant.title}, {self.in_force.label}"

    @property
    def in_force(self) -> OilSupply:
        """The oil supply: what was given, else what the job of the map states."""
        return self.supply or self.emap.supply

    @property
    def lubricant(self) -> Lubricant:
        """The oil of the map."""
        return self.emap.lubricant

    def state(self, side: int, load: FloatArray, entrainment_speed: float, temperature: float) -> ContactState:
        """Pressure and films from the map; see `FilmSource.state`."""
        kelvins = self.emap.axis("temperature")
        temperature = float(np.clip(temperature, kelvins[0], kelvins[-1]))
        plain = self._formula.state(side, load, entrainment_speed, temperature)
        loaded = load > 0.0
        rolling_film = self.emap.rolling_film
        rolling = plain.rolling_force
        if rolling_film is not None:
            at = SIDES[side], np.maximum(load, 0.0), entrainment_speed, temperature
            rolling = rolling_film.rolling_force(*at, self.in_force)
        if entrainment_speed == 0.0 or not np.any(loaded):
            return replace(plain, rolling_force=rolling)
        ratios = np.full((*load.shape, len(_VARIABLES) + len(_ERRORS)), np.nan)
        ratios[loaded] = self._ratios(side, load[loaded], abs(entrainment_speed), temperature)
        pressure = np.where(loaded, ratios[..., 0] * plain.hertz_pressure, 0.0)
        central, minimum = (ratios[..., part] * plain.central_film for part in (1, 2))
        error = np.where(loaded, ratios[..., 3], 0.0)
        state = ContactState(plain.hertz_pressure, pressure, central, minimum, rolling, error, ratios[..., 4])
        if rolling_film is None:
            return on_supply(state, RIGID_FLOW * central, self.in_force)
        flow = rolling_film.flow(SIDES[side], np.maximum(load, 0.0), entrainment_speed, temperature)
        return on_supply(state, flow, self.in_force)

    def _ratios(self, side: int, load: FloatArray, speed: float, temperature: float) -> FloatArray:
        """Ratios and errors of pressure and smallest film, (n, 5), at positive loads, held at the edges of the map."""
        lines = self._lines[side]
        speeds, kelvins = lines.nodes
        place = np.log(load) - self._shift(side, speed, temperature)
        ratios = np.zeros((load.size, lines.ratios.shape[-1]))
        for j, by_speed in _corners(np.log(speeds), float(np.log(speed))):
            for k, by_temperature in _corners(kelvins, temperature):
                at = place + self._shift(side, float(speeds[j]), float(kelvins[k]))
                for part in range(ratios.shape[1]):
                    line = np.interp(at, lines.log_load, lines.ratios[:, j, k, part])
                    ratios[:, part] += by_speed * by_temperature * line
        return ratios

    def _shift(self, side: int, speed: float, temperature: float) -> float:
        """ln of the load at which Moes' M is 1."""
        contact, state = self.emap.contacts[side], self.lubricant.at(temperature)
        number, _ = moes_groups(1.0, speed, state.viscosity, 0.0, contact.radius, contact.reduced_modulus)
        return -math.log(number)

    def _points(self, name: str) -> FloatArray:
        """A variable at all points, (2, n_w, n_u, n_T); NaN where the map does not hold it."""
        found = self.emap.points(name)
        return np.full((2, *(axis.size for axis in self._axes)), np.nan) if found is None else found

    @property
    def _axes(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Loads, speeds and temperatures of the map."""
        return self.emap.axis("load"), self.emap.axis("entrainment_speed"), self.emap.axis("temperature")

    @cached_property
    def _known(self) -> tuple[Reach | None, BoolArray]:
        """Reach of the points of both contacts that have all variables, and which points of each have."""
        from ehdmaps.maps.edges.reach import known_runs, reach_of  # with a map only

        known = known_runs(np.all([np.isfinite(self._points(name)) for name in _VARIABLES], axis=0))
        return reach_of(known, self._axes), known

    @cached_property
    def _lines(self) -> tuple[_Lines, ...]:
        """Ratios of each contact at the points of the map; beyond those that are known the last ones."""
        reach, known = self._known
        assert reach is not None
        loads, speeds, kelvins = reach.loads, reach.speeds, reach.temperatures
        both, here = [reach.part(self._points(name)) for name in (*_VARIABLES, *_ERRORS)], reach.part(known)
        lines = []
        for side in range(len(SIDES)):
            values = np.stack([variable[side] for variable in both], axis=-1)
            for j, speed in enumerate(speeds):
                for k, kelvin in enumerate(kelvins):
                    plain = self._formula.state(side, loads, float(speed), float(kelvin))
                    values[:, j, k, 0] /= plain.hertz_pressure
                    values[:, j, k, 1:3] /= plain.central_film[:, None]
                    at = np.flatnonzero(here[side, :, j, k])
                    values[:, j, k] = values[np.clip(np.arange(loads.size), at[0], at[-1]), j, k]
            lines.append(_Lines(np.log(loads), (speeds, kelvins), values))
        return tuple(lines)


@dataclass(frozen=True, eq=False)
class _Lines:
    """Ratios and errors (loads, speeds, temperatures, 5) of a contact, over ln(load)."""

    log_load: FloatArray
    nodes: tuple[FloatArray, FloatArray]
    ratios: FloatArray


def _corners(axis: FloatArray, place: float) -> list[tuple[int, float]]:
    """Nodes beside a place and their weights; one node at the edges and outside."""
    if place <= axis[0]:
        return [(0, 1.0)]
    if place >= axis[-1]:
        return [(axis.size - 1, 1.0)]
    upper = int(np.searchsorted(axis, place, side="right"))
    part = float((place - axis[upper - 1]) / (axis[upper] - axis[upper - 1]))
    return [(upper - 1, 1.0 - part), (upper, part)] if part > 0.0 else [(upper - 1, 1.0)]
