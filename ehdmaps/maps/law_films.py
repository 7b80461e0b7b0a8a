"""Films of a law besides its table: the load below which they are a guess, how they lock; and the law at one speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import InputError, MapError, OutsideMapError
from ehdmaps.maps.contact_curve import ContactCurve
from ehdmaps.maps.film_field import FilmField, LowLoads, guessed_at, looked_at, low_loads
from ehdmaps.maps.kernels.film_response import FilmResponse, FilmsOfContact
from ehdmaps.maps.kernels.law_in_c import PointInC
from ehdmaps.maps.kernels.locked_film import FORMULA, LockedFactors, film_of, locked_compliances, relaxation_times
from ehdmaps.maps.kernels.memory import FilmMemory
from ehdmaps.maps.kernels.tables import LOAD, LOAD_TOLERANCE, Point
from ehdmaps.maps.law_errors import LawBounds
from ehdmaps.maps.oil_layer import oil_layer
from ehdmaps.maps.outside_calls import Excursion, Range, broadcast, check_finite, floats
from ehdmaps.maps.rolling_film import RollingFilm
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width, natural_time
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.units import TEMPERATURE

LEAST_LOAD = 1.0
"""Load from which on the error of a continued film is looked at [N/m]."""

LIGHTEST = 1.0
"""Load down to which it is said what the law leaves out [N/m]; lighter contacts leave out as much."""

_LOAD_STEP = 0.1
"""Step of ln of the load between the factors of the locked film."""

_MOST_LOCKED = 4096
"""Sets of such factors that are kept, of 1 kB each: a run-up over a decade of speed comes to 600."""


@dataclass(frozen=True, eq=False)
class LawFilms:
    """Films of the contacts of a law.

    Attributes
    ----------
    contacts : tuple of LineContact
        Contacts of the law.
    lubricant : Lubricant
        The oil.
    field : FilmField
        Film of each contact; of a dry map its stand-in, see `ehdmaps.maps.film_field`.
    dry : bool
        Whether the map has no film.
    supply : OilSupply
        Oil before each contact.
    rolling : RollingFilm or None
        Rolling force and mass flow of the contacts, where the map holds them.
    """

    contacts: tuple[LineContact, ...]
    lubricant: Lubricant
    field: FilmField
    dry: bool
    supply: OilSupply
    rolling: RollingFilm | None

    @cached_property
    def low_loads(self) -> LowLoads | None:
        """Loads where the film goes over into that of a rigid contact, and whether that is right; None of a dry law."""
        field = self.field
        if self.dry or not field.speed_range[0] > 0.0:
            return None
        first, lowest = field.first_loads, field.load_range[0]
        return low_loads(first, self.contacts, self.lubricant, lowest, field.speed_range, field.temperature_range)

    def guessed_below(self, entrainment_speed: float, temperature: float) -> float:
        """Load [N/m] below which the film is a guess, see `low_loads`; 0 where it is none.

        Parameters
        ----------
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K]; held at the edges of the map.
        """
        if self.low_loads is None or not self.low_loads.guessed:
            return 0.0
        u, T = self._held(entrainment_speed, temperature)
        return guessed_at(self.field.first_loads, self.contacts, self.lubricant, u, T)

    def guesses(self, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray) -> list[Excursion]:
        """Loads that lie where the film is a guess, by the nearest place at which the law was looked at.

        Parameters
        ----------
        loads, speeds, temperatures : array (n,)
            w [N/m], u [m/s], of either sign, and T [K].
        """
        if self.low_loads is None or not self.low_loads.guessed:
            return []
        low = np.nonzero((loads > 0.0) & (loads < self.low_loads.begins[1]))[0]
        if not low.size:
            return []
        limits = self._guessed_below
        (slow, fast), (cold, hot) = self.field.speed_range, self.field.temperature_range
        along = np.log(np.clip(np.abs(speeds[low]), slow, fast) / slow) / math.log(fast / slow) if fast > slow else 0.0
        across = (np.clip(temperatures[low], cold, hot) - cold) / (hot - cold) if hot > cold else 0.0
        rows, columns = (
            np.rint(part * (n - 1)).astype(int) for part, n in zip((along, across), limits.shape, strict=True)
        )
        of = np.broadcast_to(rows * limits.shape[1] + columns, low.shape)
        found: list[Excursion] = []
        for index in np.unique(of):
            found += Range("load", float(limits.flat[index]), np.inf).excursions(loads[low[of == index]])
        return found

    @cached_property
    def _guessed_below(self) -> FloatArray:
        """`guessed_below` at the places at which the law was looked at."""
        speeds, temperatures = looked_at(self.field.speed_range, self.field.temperature_range)
        return np.array([[self.guessed_below(u, T) for T in temperatures.tolist()] for u in speeds.tolist()])

    def locked_factors(self, entrainment_speed: float, temperature: float) -> LockedFactors:
        """Factors of the map for the locked film, see `ContactLaw.locked_factors`.

        Parameters
        ----------
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K]; held at the edges of the map.
        """
        u, T = self._held(entrainment_speed, temperature)
        if (u, T) not in self._locked:
            self._keep([u], T)
        return self._locked[u, T]

    def make_locked_factors(self, entrainment_speeds: FloatArray, temperature: float) -> None:
        """Make `locked_factors` of many speeds at once, which costs a sixth of one after the other.

        Parameters
        ----------
        entrainment_speeds : array (n,)
            u [m/s].
        temperature : float
            T [K].
        """
        held = [self._held(u, temperature) for u in entrainment_speeds.tolist()]
        missing = [u for u, T in dict.fromkeys(held) if (u, T) not in self._locked]
        if missing:
            self._keep(missing, held[0][1])

    def _keep(self, speeds: list[float], T: float) -> None:
        """Make factors, and keep them."""
        if len(self._locked) + len(speeds) > _MOST_LOCKED:
            self._locked.clear()
        self._locked.update(zip([(u, T) for u in speeds], self._locked_factors(np.array(speeds), T), strict=True))

    @cached_property
    def _locked(self) -> dict[tuple[float, float], LockedFactors]:
        """Factors that were made: runs of one law come to the same speeds."""
        return {}

    def _locked_factors(self, speeds: FloatArray, T: float) -> list[LockedFactors]:
        """Factors at speeds (n_u,) and a temperature within the map."""
        field = self.field
        lowest, highest = field.first_loads(speeds, np.array([T]))[:, 0].tolist(), field.load_range[1]
        axes = [np.geomspace(low, highest, 2 + math.ceil(math.log(highest / low) / _LOAD_STEP)) for low in lowest]
        # lines that are shorter than the longest one have the highest load once more
        loads = np.full((max(axis.size for axis in axes), speeds.size), highest)
        for j, axis in enumerate(axes):
            loads[: axis.size, j] = axis
        films = [self._films(contact, loads, speeds, T) for contact in self.contacts]
        found = []
        for j, (axis, u) in enumerate(zip(axes, speeds.tolist(), strict=True)):
            whole, offset, compliance = np.zeros((3, axis.size))
            for contact, (offsets, compliances) in zip(self.contacts, films, strict=True):
                known = field.locked_factors(contact.name, axis, u, T)
                if known is None:
                    return [FORMULA] * speeds.size
                own = offsets[: axis.size, j].copy(), compliances[: axis.size, j].copy()
                whole += locked_compliances((contact,), own[0], axis, own[1]) * known
                offset += own[0]
                compliance += own[1]
            factors = whole / locked_compliances(self.contacts, offset, axis, compliance)
            found.append(LockedFactors(math.log(lowest[j]), (axis.size - 1) / math.log(highest / lowest[j]), factors))
        return found

    def response(self, loads: FloatArray, entrainment_speed: float, temperature: float) -> FilmResponse | None:
        """Part that the law with memory leaves out, see `ContactLaw.film_response`.

        Parameters
        ----------
        loads : array (n,)
            [N/m].
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K]; held at the edges of the map.
        """
        u, T = self._held(entrainment_speed, temperature)
        loads = np.maximum(loads, LIGHTEST)
        solids, offset, compliance, loss, by_formula = np.zeros((5, loads.size))
        each = []
        for contact in self.contacts:
            known = self.field.film_differences(contact.name, loads, u, T)
            factors = self.field.locked_factors(contact.name, loads, u, T)
            if known is None or factors is None:
                return None
            films = self.field.films(contact.name, loads[:, None, None], np.array([u]), np.array([T]))
            own = [contact.structural_compliance(loads), *(part[:, 0, 0] for part in films)]
            each.append(_films_of(contact, loads, u, own, factors, *known))
            by_formula += locked_compliances((contact,), own[1], loads, own[2]) * factors
            solids, offset, compliance, loss = (
                a + b for a, b in zip((solids, offset, compliance, loss), own, strict=True)
            )
        factors = by_formula / locked_compliances(self.contacts, offset, loads, compliance)
        return FilmResponse(*_law(self.contacts, loads, u, [solids, offset, compliance, loss], factors), tuple(each))

    def _held(self, entrainment_speed: float, temperature: float) -> tuple[float, float]:
        """Speed without its sign and temperature, both held at the edges of the map."""
        (slow, fast), (cold, hot) = self.field.speed_range, self.field.temperature_range
        return min(max(abs(entrainment_speed), slow), fast), min(max(temperature, cold), hot)

    def _films(
        self, contact: LineContact, loads: FloatArray, speeds: FloatArray, T: float
    ) -> tuple[FloatArray, FloatArray]:
        """Film offset [m] and film compliance [m2/N] of a contact at loads and speeds within the map; (n, n_u)."""
        kelvins, every = np.array([T]), loads[:, :, None]
        if self.supply.flooded:
            films = self.field.films(contact.name, every, speeds, kelvins)
            return films[0][:, :, 0], films[1][:, :, 0]
        curve = ContactCurve(self.field, contact, speeds, kelvins)
        layer = oil_layer(contact, self.supply.oil_layer, curve.tail, self.rolling, speeds, kelvins)
        film = layer(curve.mapped(every))
        return film.offset[:, :, 0], -film.slope[:, :, 0] / (3.0 * np.cbrt(loads) ** 2)


def _law(
    contacts: Sequence[LineContact], loads: FloatArray, u: float, films: Sequence[FloatArray], factors: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """k, c and relaxation time of contacts in series by their compliances, film offset and loss together, (n,) each."""
    solids, offset, compliance, loss = films
    k = 1.0 / (solids + compliance)
    c = loss * k**2
    return k, c, relaxation_times(film_of(contacts, u), offset, loads, k, c, solids, factors)


def _films_of(
    contact: LineContact,
    loads: FloatArray,
    u: float,
    films: Sequence[FloatArray],
    factors: FloatArray,
    frequencies: FloatArray,
    differences: ComplexArray,
) -> FilmsOfContact:
    """Films of one contact."""
    natural = natural_time(loads, films[1], u, contact.radius, contact.reduced_modulus)
    passing = half_width(loads, contact.radius, contact.reduced_modulus) / u
    return FilmsOfContact(*_law((contact,), loads, u, films, factors), natural, passing, frequencies, differences)


@dataclass(frozen=True)
class LawAtPoint:
    """A contact law at one speed, temperature and centrifugal load.

    Attributes
    ----------
    entrainment_speed, temperature, centrifugal_load : float
        u [m/s], T [K], q [N/m].
    law : ContactLaw
        Where it comes from; it keeps the counts.
    outside : bool
        Whether u, T or q lies outside the map.
    """

    entrainment_speed: float
    temperature: float
    centrifugal_load: float
    _made: PointInC
    law: Any
    outside: bool

    def __repr__(self) -> str:
        """Speed, temperature and load, and the law."""
        thrown = f", {self.centrifugal_load:.4g} N/m centrifugal" if self.centrifugal_load else ""
        at = f"{self.entrainment_speed:.4g} m/s, {TEMPERATURE.text(self.temperature)}{thrown}"
        return f"<LawAtPoint {at}, of {self.law!r}>"

    @property
    def point(self) -> Point:
        """Numbers and lines at this speed, temperature and centrifugal load, as C reads them."""
        return self._made.point

    def approach(self, load: float) -> float:
        """Approach [m] at which the contacts carry a load at rest, with the whole film; for zero the highest without.

        Parameters
        ----------
        load : float
            w >= 0 on the inner contact [N/m].
        """
        return self._made.approach(load)

    @property
    def conditions(self) -> tuple[float, float, float]:
        """Entrainment speed, temperature and centrifugal load."""
        return self.entrainment_speed, self.temperature, self.centrifugal_load

    @cached_property
    def _guessed_below(self) -> float:
        """Load below which the film is a guess [N/m]; 0 where it is none."""
        return float(self.law.guessed_below(self.entrainment_speed, self.temperature))

    @cached_property
    def memory(self) -> FilmMemory:
        """The law with films that need time, for steps in time."""
        factors = self.law.locked_factors(self.entrainment_speed, self.temperature)
        return FilmMemory(self.point, self.law.contacts, self.entrainment_speed, factors, self._check_loads)

    def bounds(self, loads: FloatArray) -> LawBounds | None:
        """Error bounds of stiffness, damping and approach at some loads; None where the law states no errors.

        Parameters
        ----------
        loads : array (n,)
            Loads on the inner contact [N/m].

        Returns
        -------
        LawBounds or None
            None for a law that is not made from a map, and at standstill.
        """
        if self.law.errors is None:
            return None
        names = [contact.name for contact in self.law.contacts]
        u, T, continued = self.entrainment_speed, self.temperature, self.law.continued
        added = None
        if continued is not None and continued.outside(u, T):
            added = {name: continued.errors(name, np.maximum(loads, LEAST_LOAD), abs(u), T) for name in names}
        bounds: LawBounds = self.law.errors.bounds(names, loads, u, T, added)
        return bounds

    def rolling_force(self, load: npt.ArrayLike) -> FloatArray:
        """Rolling force of each contact at a load on the inner one, both walls together [N/m].

        The power that the films take is its sum over the contacts times |u|, per length. For loads outside the map see
        `ehdmaps.maps.rolling_film`.

        Parameters
        ----------
        load : float or array
            w [N/m], >= 0; the outer contact of `series` carries the centrifugal load besides.

        Returns
        -------
        array (contacts, ...)
            In the order of `ContactLaw.contacts`, over the shape of the loads.

        Raises
        ------
        InputError
            For loads that are no finite numbers >= 0.
        MapError
            If the map holds no rolling force.
        """
        if self.law.rolling is None:
            raise MapError(
                "contact law, rolling force: the map holds none, or not at all its points; allowed: maps without holes "
                "by the solvers reynolds and openfoam, of schema 3; generate it again"
            )
        loads = floats(load=load)["load"]
        check_finite({"load": loads})
        if np.any(loads < 0.0):
            raise InputError(f"contact law, load: got {float(np.min(loads)):.6g} N/m; allowed: >= 0")
        extra = {"outer": self.centrifugal_load}
        u, T = self.entrainment_speed, self.temperature
        return np.stack(
            [
                self.law.rolling.rolling_force(
                    contact.name, loads + extra.get(contact.name, 0.0), u, T, self.law.supply
                )
                for contact in self.law.contacts
            ]
        )

    def _check_loads(self, loads: FloatArray) -> None:
        """Count loads above the map, and raise where the law does."""
        above = int(np.count_nonzero(loads > self.point.highest_load * (1.0 + LOAD_TOLERANCE)))
        if not above:
            return
        self.law.counts[LOAD] += above
        self.law._outside.keep(Range("load", -np.inf, self.point.highest_load).excursions(loads))
        if self.law.outside == "error":
            raise OutsideMapError(
                f"film memory, load: got {float(np.max(loads)):.6g} N/m, above the map, which ends at "
                f"{self.point.highest_load:.6g} N/m, at {self.entrainment_speed:.6g} m/s, {self.temperature:.6g} K "
                f"({above} of {loads.size} points above)\nmake a map that reaches there, or take a law with "
                "outside='clamp' or outside='asymptote'"
            )

    def __call__(self, delta: npt.ArrayLike, rate: npt.ArrayLike) -> tuple[Any, Any, Any]:
        """Load and its derivatives; as calling the `ContactLaw`."""
        return self.evaluate(delta, rate)[:3]

    def evaluate(self, delta: npt.ArrayLike, rate: npt.ArrayLike) -> tuple[Any, Any, Any, bool]:
        """As a call, and whether any of it lies outside the map."""
        if isinstance(delta, float) and isinstance(rate, float):
            force = self._made.force(delta, rate)
            if force is not None and not 0.0 < force[0] < self._guessed_below:
                return *map(np.float64, force), self.outside
        named = floats(delta=delta, rate=rate)
        shape, flat = broadcast(named)
        forces, counts = self._made.forces(*flat)
        if np.any(counts):
            fixed = (self.entrainment_speed, self.temperature, self.centrifugal_load)
            flat += [np.full(flat[0].size, value) for value in fixed]
            self.law._settle(counts, named, flat)
        if self._guessed_below > 0.0:
            low = forces[0][(forces[0] > 0.0) & (forces[0] < self._guessed_below)]
            self.law._outside.keep(Range("load", self._guessed_below, np.inf).excursions(low))
        w, dw_ddelta, dw_drate = (force.reshape(shape)[()] for force in forces)
        return w, dw_ddelta, dw_drate, self.outside or bool(counts.any())
