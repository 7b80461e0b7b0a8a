"""Films of a map below its lowest speed and outside its temperatures: at the same zeta, by the film table.

There the oil is known, and so are Moes' groups. What changes from the edge of the map to a point outside it is taken
from the film table, at the same zeta = ln(M/M_valley(L)); what the map's own film differs from the table's at the edge
is kept. In reduced numbers, the film offset H, n = -d ln h/d ln w, and asinh of the loss as a share of h b/(u w),

    ln H = ln H_table + (ln H_map - ln H_table)_edge,    and likewise n and the loss,

so that the film compliance stays the exact derivative of the film offset, a map whose films are those of the table is
the table itself, and a map with heat, or of another solver, joins its own edge.

- Films are whole down to a tenth of the lowest mapped speed (`WHOLE_TO`), and fade into the dry contact below it.
- Temperatures go on by `TEMPERATURE_REACH` at most, as far as the oil has a state and the table has films.
- Of an oil that the table does not know, the map's own trends at constant zeta go on: along ln u and T straight.

What is stated as the error outside the map is the error of the table there, and all of the difference that is kept.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray, IndexArray
from ehdmaps.errors import EhdmapsError
from ehdmaps.maps.backbone import LOSS_SCALE
from ehdmaps.maps.compilation import Resolution
from ehdmaps.maps.film_field import FilmField, lifted_loss, valley_loads
from ehdmaps.maps.kernels.tables import COLDEST
from ehdmaps.maps.law_errors import LawBounds
from ehdmaps.maps.rough_layer import TEMPERATURE_REACH, WHOLE_TO
from ehdmaps.maps.table_field import TableField
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_speed_number

_TRIED = 16
"""Temperatures that are tried within the reach."""

_COLDEST = COLDEST + 40.0
"""Below this no law is laid [K]: its axis of temperature 1/(T - `COLDEST`) grows without end there."""

Range = tuple[float, float]


@dataclass(frozen=True, eq=False)
class ContinuedField:
    """Films of a map and beyond it; a `FilmField`, whose ranges stay those of the map.

    Attributes
    ----------
    origin : FilmField
        Films of the map.
    line_contacts : tuple of LineContact
        Contacts of the field.
    lubricant : Lubricant
        The oil.
    table : TableField or None
        Films of the film table over the same loads; None where it does not know the oil.
    share : float
        Share of the reach that a law takes, 0 to 1: of `TEMPERATURE_REACH`, and of the logarithm of that in speed.
    """

    origin: FilmField
    line_contacts: tuple[LineContact, ...]
    lubricant: Lubricant
    table: TableField | None
    share: float = 1.0

    @property
    def contacts(self) -> tuple[str, ...]:
        """Names of the contacts."""
        return self.origin.contacts

    @property
    def load_range(self) -> Range:
        """Lowest and highest load of the map [N/m]."""
        return self.origin.load_range

    @property
    def speed_range(self) -> Range:
        """Lowest speed above zero and highest speed of the map [m/s]."""
        return self.origin.speed_range

    @property
    def temperature_range(self) -> Range:
        """Lowest and highest temperature of the map [K]."""
        return self.origin.temperature_range

    @property
    def dry(self) -> bool:
        """True where the map has no film."""
        return self.origin.dry

    @property
    def slowest(self) -> float:
        """Speed down to which films are whole [m/s]."""
        return self.speed_range[0] / WHOLE_TO

    @cached_property
    def reach(self) -> Range:
        """Lowest and highest temperature to which films go on [K]."""
        cold, hot = self.temperature_range
        return self._farthest(cold, -1.0), self._farthest(hot, 1.0)

    def _farthest(self, end: float, way: float) -> float:
        """The farthest temperature beyond an end of the map at which there are films, of those that are tried.

        A law has a node up to a step of its axis beyond its reach: there are films there, too.
        """
        steps = np.arange(1.0, _TRIED + 1.0 if self.share and end >= _COLDEST else 1.0)
        tried = end + way * self.share * TEMPERATURE_REACH * steps / _TRIED
        tried = tried[tried >= _COLDEST]
        nodes = COLDEST + 1.0 / (1.0 / (tried - COLDEST) - way * 1e-3 * Resolution().temperature)
        known = np.all(self._known(np.concatenate((tried, nodes))).reshape(2, -1), axis=0)
        return float(np.append(end, tried)[np.argmin(np.append(known, False))])

    def _known(self, temperatures: FloatArray) -> BoolArray:
        """Tell at which temperatures [K] there are films, at the slowest speed and the highest one, (n_T,)."""
        known: BoolArray = np.array([self._has_state(temperature) for temperature in temperatures.tolist()], dtype=bool)
        speeds = np.array([self.slowest, *self.speed_range])
        for contact in self.line_contacts:
            if self.table is not None and np.any(known):
                known[known] = self.table.knows(contact.name, speeds, temperatures[known])
        return known

    def _has_state(self, temperature: float) -> bool:
        """Tell whether the oil has a viscosity at a temperature [K]."""
        try:
            viscosity = self.lubricant.at(temperature).viscosity
        except EhdmapsError:
            return False
        return math.isfinite(viscosity) and viscosity > 0.0

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Loads from which on films are known [N/m], (n_u, n_T); see `FilmField.first_loads`."""
        return self.origin.first_loads(speeds, temperatures)

    @property
    def ends(self) -> FloatArray:
        """Loads up to which films are known; see `FilmField.ends`."""
        return self.origin.ends

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> FloatArray | None:
        """Factors of the closed formula of the locked film; see `FilmField.locked_factors`."""
        return self.origin.locked_factors(contact, loads, speed, temperature)

    def film_differences(
        self, contact: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, ComplexArray] | None:
        """Part that films with memory leave out at natural frequencies; see `FilmField.film_differences`."""
        return self.origin.film_differences(contact, loads, speed, temperature)

    def films(
        self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Film of one contact; see `FilmField.films`."""
        if self.table is None or isinstance(self.origin, TableField):
            return self.origin.films(contact, loads, speeds, temperatures)
        found = np.empty((3, *loads.shape))
        for rows, columns, outside in self._blocks(speeds, temperatures):
            at = np.ix_(np.arange(loads.shape[0]), rows, columns)
            u, T = speeds[rows], temperatures[columns]
            films = self._outside(contact, loads[at], u, T) if outside else None
            inside = self.origin.films(contact, loads[at], u, T) if films is None else films
            for k in range(3):
                found[k][at] = inside[k]
        return found[0], found[1], found[2]

    def _blocks(self, speeds: FloatArray, temperatures: FloatArray) -> list[tuple[IndexArray, IndexArray, bool]]:
        """Rows and columns with the same edge of the map, and whether they lie outside it."""
        cold, hot = self.temperature_range
        slow = speeds < self.speed_range[0]
        sides = np.where(temperatures < cold, -1, np.where(temperatures > hot, 1, 0))
        blocks = []
        for below in (False, True):
            for side in (0, -1, 1):
                rows, columns = np.flatnonzero(slow == below), np.flatnonzero(sides == side)
                if rows.size and columns.size:
                    blocks.append((rows, columns, below or side != 0))
        return blocks

    def _outside(self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Films of a block outside the map, (3, n, n_u, n_T)."""
        assert self.table is not None
        chosen = self._named(contact)
        here = self.table.films(contact, loads, speeds, temperatures)
        edge, own, known = self._at_edge(chosen, loads, speeds, temperatures)
        reduced = _reduced(chosen, loads, speeds, here)
        reduced = reduced + _reduced(chosen, edge.loads, edge.speeds, own)
        reduced -= _reduced(chosen, edge.loads, edge.speeds, known)
        # the unit of the film offset at the edge has cancelled
        return _restored(chosen, loads, speeds, reduced)

    def _at_edge(
        self, contact: LineContact, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[_Edge, FloatArray, FloatArray]:
        """Places where the edge of the map has the same zeta, with the films of the map and of the table there."""
        assert self.table is not None
        held_speeds = np.maximum(speeds, self.speed_range[0])
        held = np.clip(temperatures, *self.temperature_range)
        factor = self._load_units(contact, speeds, temperatures) / self._load_units(contact, held_speeds, held)
        edge = _Edge(loads / factor, held_speeds)
        # equal speeds and temperatures of the edge are read at once, as more loads
        one_speed, one_kelvin = (bool(np.all(values == values[0])) for values in (held_speeds, held))
        u, T = held_speeds[:1] if one_speed else held_speeds, held[:1] if one_kelvin else held
        n, n_u, n_t = loads.shape
        order = [0, *([1] if one_speed else []), *([2] if one_kelvin else [])]
        order += [axis for axis in (1, 2) if axis not in order]
        folded = edge.loads.transpose(order).reshape(-1, u.size, T.size)
        films = []
        for field in (self.origin, self.table):
            read = np.stack(field.films(contact.name, folded, u, T))
            spread = read.reshape(3, *(loads.shape[axis] for axis in order))
            films.append(spread.transpose(0, *(1 + np.argsort(order))))
        assert films[0].shape == (3, n, n_u, n_t)
        return edge, films[0], films[1]

    def _load_units(self, contact: LineContact, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Loads at the bottom of the valley [N/m], (n_u, n_T): zeta is ln of the load over them."""
        return valley_loads(contact, self.lubricant, speeds, temperatures)

    def _named(self, contact: str) -> LineContact:
        """The contact of a name."""
        return next(one for one in self.line_contacts if one.name == contact)

    def outside(self, speed: float, temperature: float) -> bool:
        """Tell whether a speed [m/s] above zero lies below the map, or a temperature [K] outside it.

        Parameters
        ----------
        speed, temperature : float
            u [m/s], of either sign, and T [K].
        """
        (slow, _), (cold, hot) = self.speed_range, self.temperature_range
        return 0.0 < abs(speed) < slow or not cold <= temperature <= hot

    def errors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> LawBounds:
        """Errors that come from continuing the film of one contact.

        Parameters
        ----------
        contact : str
            Name of the contact.
        loads : array (n,)
            [N/m].
        speed, temperature : float
            u [m/s], > 0, and T [K]. Below `slowest`, and beyond `reach`, the whole film and its damping count as wrong.
        """
        chosen = self._named(contact)
        (_, fast), (cold, hot) = self.speed_range, self.reach
        u, T = min(max(speed, self.slowest), fast), min(max(temperature, cold), hot)
        at, kelvin, every = np.array([u]), np.array([T]), loads[:, None, None]
        offset, compliance, loss = (values[:, 0, 0] for values in self.films(contact, every, at, kelvin))
        solids = np.asarray(chosen.structural_compliance(loads))
        share = np.abs(compliance) / (solids + compliance)
        if (u, T) != (min(speed, fast), temperature):
            return LawBounds(share, np.ones(loads.size), offset)
        if self.table is None:
            wrong = self._by_trend(chosen, loads, u, T)
        else:
            wrong = np.stack(self.table.film_errors(contact, loads, u, T))
            if not isinstance(self.origin, TableField):
                edge, own, known = self._at_edge(chosen, every, at, kelvin)
                kept = _reduced(chosen, edge.loads, edge.speeds, own) - _reduced(chosen, edge.loads, edge.speeds, known)
                wrong = wrong + np.abs(kept[:, :, 0, 0])
        by_offset, by_slope, by_loss = wrong
        unit = half_width(loads, chosen.radius, chosen.reduced_modulus) * offset / (loads * u)
        stiffness = by_slope * offset / loads / (solids + compliance)
        lost = by_loss * np.hypot(LOSS_SCALE, loss / unit) * unit / loss
        return LawBounds(stiffness, lost + 2.0 * stiffness, by_offset * offset)

    def _by_trend(self, contact: LineContact, loads: FloatArray, u: float, T: float) -> FloatArray:
        """Changes of reduced films from the edge of the map at the same zeta, (3, n): as large as the trend itself."""
        at, kelvin = np.array([u]), np.array([T])
        held_u, held = np.maximum(at, self.speed_range[0]), np.clip(kelvin, *self.temperature_range)
        factor = self._load_units(contact, at, kelvin) / self._load_units(contact, held_u, held)
        every = loads[:, None, None]
        here = _reduced(contact, every, at, np.stack(self.origin.films(contact.name, every, at, kelvin)))
        edge = np.stack(self.origin.films(contact.name, every / factor, held_u, held))
        there = _reduced(contact, every / factor, held_u, edge)
        units = [
            math.sqrt(moes_speed_number(float(v[0]), self.lubricant.at(float(t[0])).viscosity, 1.0, 1.0))
            for v, t in ((at, kelvin), (held_u, held))
        ]
        here[0] -= math.log(units[0])
        there[0] -= math.log(units[1])
        return np.abs(here - there)[:, :, 0, 0]


@dataclass(frozen=True)
class _Edge:
    """Loads (n, n_u, n_T) [N/m] and speeds (n_u,) [m/s] of the edge."""

    loads: FloatArray
    speeds: FloatArray


def _reduced(
    contact: LineContact, loads: FloatArray, speeds: FloatArray, films: Sequence[FloatArray] | FloatArray
) -> FloatArray:
    """ln of the film offset, n = -d ln h/d ln w and asinh of the loss, (3, n, n_u, n_T)."""
    offset, compliance, loss = films
    width = half_width(loads, contact.radius, contact.reduced_modulus)
    share = loss * speeds[:, None] * loads / (offset * width)
    return np.stack([np.log(offset), compliance * loads / offset, np.arcsinh(share / LOSS_SCALE)])


def _restored(contact: LineContact, loads: FloatArray, speeds: FloatArray, reduced: FloatArray) -> FloatArray:
    """Film offset, film compliance and loss compliance, the inverse of `_reduced`."""
    offset = np.exp(reduced[0])
    compliance = reduced[1] * offset / loads
    width, u = half_width(loads, contact.radius, contact.reduced_modulus), speeds[:, None]
    loss = LOSS_SCALE * np.sinh(reduced[2]) * offset * width / (u * loads)
    total = np.asarray(contact.structural_compliance(loads)) + compliance
    return np.stack([offset, compliance, lifted_loss(loss, width, u, total)])


def continued_field(origin: FilmField, contacts: Sequence[LineContact], lubricant: Lubricant) -> ContinuedField | None:
    """Films of a map that go on beyond it; None of a dry one.

    Parameters
    ----------
    origin : FilmField
        Films of the map.
    contacts : sequence of LineContact
        Contacts of the field, all of one material.
    lubricant : Lubricant
        The oil.
    """
    if origin.dry or not origin.speed_range[0] > 0.0:
        return None
    line_contacts = tuple(contacts)
    if isinstance(origin, TableField):
        return ContinuedField(origin, line_contacts, lubricant, origin)
    table: TableField | None = None
    try:
        table = TableField(
            line_contacts, lubricant, origin.load_range, origin.speed_range, origin.temperature_range, lenient=True
        )
        cold, hot = origin.temperature_range
        slow, fast = origin.speed_range
        speeds, kelvins = np.array([slow / WHOLE_TO, slow, fast]), np.array(sorted({cold, hot}))
        if not all(np.all(table.knows(contact.name, speeds, kelvins)) for contact in line_contacts):
            table = None
    except EhdmapsError:
        table = None
    return ContinuedField(origin, line_contacts, lubricant, table)
