"""Rolling force and mass flow of the contacts of a map, at any load, speed and temperature.

In Moes' groups both depend on M and L alone, as the film does: with the speed number Us = 2 eta0 u/(E'R)

    rolling force = E' R Us^(3/4) f(M, L),        mass flow = rho0 u R Us^(1/2) g(M, L).

What a map holds of them is read as ln f and ln g: of its backbone at constant zeta = ln(M/M_valley(L)), as the films of
a contact law are, or of its own grid at constant load where it has no backbone.

- A backbone is read also below the lowest mapped load, down to where the contact is rigid, see
  `ehdmaps.maps.film_field`. Below that, or below the lowest mapped load, both go over into the film between rigid
  surfaces, f = 2.941 M^(1/2) and g = 3/M, which the piezoviscous effect leaves as the pressure does, like M^(3/2).
  Where no backbone reaches the rigid regime the way there is a guess.
- Above the highest load they go on with their last exponent.
- Beyond the speeds of the map too they go on with their last exponents. Temperatures are held at the edge.
- A law on an oil layer asks for the mass flow outside the speeds and temperatures of the map too. There the flow over
  the film is that at the edge of the map, at the same zeta: it is 1.2257 of rigid contacts and near one of loaded ones,
  while the film itself changes by powers of ten.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.maps.backbone import FEWEST_NODES, LATTICE_STEP, lagrange
from ehdmaps.maps.film_field import RIGID, FilmField, known_from, load_at, loads_at
from ehdmaps.maps.grid_field import lines_by_contact
from ehdmaps.maps.kernels.splines import mix_lines, spline_weights
from ehdmaps.maps.schema import BACKBONE_DIMS
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.films import RIGID_ROLLING_CONSTANT
from ehdmaps.physics.heat import inlet_heats
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, moes_speed_number, valley_load_number
from ehdmaps.physics.oil_supply import FLOODED, OilSupply, rolling_ratio

if TYPE_CHECKING:
    import xarray as xr

NAMES = ("rolling_force", "mass_flow")
"""Variables of the map and of its backbone."""

RIGID_FLOW_NUMBER = 3.0
"""M times the flow number of the rigid film: 6.000 eta u R/w is the film at its highest pressure."""

_PRESSURE_EXPONENT = 1.5
_STEP = 1e-3
_FLOW_STEP = 0.1

_KEPT = 4
"""Flows that are kept: laws on layers of other thickness ask for the same."""

_Reader = Callable[[LineContact, FloatArray, float, float], FloatArray]
"""From contact, loads (n,) from the first known to the highest one, speed and temperature to ln f and ln g, (2, n)."""


@dataclass(frozen=True)
class FlowFilm:
    """Mass flow over density at rest and speed [m] along loads, each speed and temperature over its own range.

    None is read below its own first load: there the flow of a map goes over into that of the exact rigid film, and a
    film may not.

    Attributes
    ----------
    line : CubicSpline
        ln of it over ln(w/w1)/ln(w2/w1), 0 to 1, values (n_u, n_T).
    first, reach : array (n_u, n_T)
        ln(w1) of the first load [N/m], and ln(w2/w1) to the highest one of the map.
    """

    line: CubicSpline
    first: FloatArray
    reach: FloatArray

    def at(self, log_load: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln of it and its derivative by ln(w), straight above the map.

        Parameters
        ----------
        log_load : array (n, n_u, n_T)
            ln(w), w in N/m, from the first load on.
        """
        places = (log_load - self.first) / self.reach
        held = np.minimum(places, 1.0)
        # each speed and temperature has its own places, which no spline of scipy takes
        part = np.clip(np.searchsorted(self.line.x, held, side="right") - 1, 0, self.line.x.size - 2)
        third, second, first, begin = np.take_along_axis(self.line.c, part[None], axis=1)
        step = held - self.line.x[part]
        logs = begin + step * (first + step * (second + step * third))
        slopes = first + step * (2.0 * second + step * 3.0 * third)
        return logs + slopes * (places - held), slopes / self.reach


class RollingFilm:
    """Rolling force and mass flow over load, speed and temperature; see `rolling_film`.

    Parameters
    ----------
    contacts : sequence of LineContact
        Contacts of the map.
    lubricant : Lubricant
        The oil.
    reader : callable
        What reads ln f and ln g within the map.
    load_range, temperature_range : tuple of float
        Range of the map's axes [N/m], [K].
    start : float
        zeta from which on the reader holds also below the lowest load; inf where it does not.
    speed_range : tuple of float
        Speeds of the map above zero [m/s].
    """

    def __init__(
        self,
        contacts: Sequence[LineContact],
        lubricant: Lubricant,
        reader: _Reader,
        load_range: tuple[float, float],
        temperature_range: tuple[float, float],
        start: float = math.inf,
        speed_range: tuple[float, float] = (0.0, math.inf),
    ) -> None:
        self._speeds = speed_range
        self._start = start
        self._contacts = {contact.name: contact for contact in contacts}
        self._lubricant = lubricant
        self._reader = reader
        self._loads, self._temperatures = load_range, temperature_range
        self._flows: dict[tuple[str | bytes, ...], tuple[FilmField | None, FlowFilm]] = {}

    def __getstate__(self) -> dict[str, Any]:
        """For other processes: without flows that were made of it."""
        return {**self.__dict__, "_flows": {}}

    def rolling_force(
        self,
        contact: str,
        load: npt.ArrayLike,
        entrainment_speed: float,
        temperature: float,
        supply: OilSupply = FLOODED,
    ) -> FloatArray:
        """Rolling force of both walls together [N/m], in the shape of the loads; zero without load or speed.

        Parameters
        ----------
        contact : str
            Name of a contact of the map.
        load : float or array
            w [N/m], >= 0.
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K].
        supply : OilSupply, optional
            Oil before the contact. On a layer the force is less, see `ehdmaps.physics.oil_supply.rolling_ratio`.
        """
        force = self._found(0, contact, load, entrainment_speed, temperature)
        if supply.flooded:
            return force
        loads = np.asarray(load, dtype=np.float64)
        at = entrainment_speed, temperature
        flow, heavier = (self.flow(contact, part * loads, *at) for part in (1.0, 1.0 + _STEP))
        with np.errstate(invalid="ignore", divide="ignore"):
            exponent = np.nan_to_num(np.clip(np.log(flow / heavier) / math.log1p(_STEP), 0.0, 1.0), nan=1.0)
            passed = np.minimum(supply.oil_layer / flow, 1.0)  # a force that nothing rests on needs no rounded corner
        return force * rolling_ratio(np.sqrt(passed), exponent)

    def mass_flow(self, contact: str, load: npt.ArrayLike, entrainment_speed: float, temperature: float) -> FloatArray:
        """Mass flow through the contact [kg/(m s)], inf without load, zero without speed; arguments as before.

        Parameters
        ----------
        contact, load, entrainment_speed, temperature
            Arguments of `rolling_force`.
        """
        return self._found(1, contact, load, entrainment_speed, temperature)

    def flow(self, contact: str, load: npt.ArrayLike, entrainment_speed: float, temperature: float) -> FloatArray:
        """Mass flow over density at rest and speed [m], inf without load, zero without speed; arguments as before.

        Parameters
        ----------
        contact, load, entrainment_speed, temperature
            Arguments of `rolling_force`.
        """
        mass = self.mass_flow(contact, load, entrainment_speed, temperature)
        if entrainment_speed == 0.0:
            return mass
        T = float(np.clip(temperature, *self._temperatures))
        return mass / (self._lubricant.at(T).density * abs(entrainment_speed))

    def flow_film(
        self,
        contact: str,
        first: FloatArray,
        speeds: FloatArray,
        temperatures: FloatArray,
        field: FilmField | None = None,
    ) -> FlowFilm:
        """Mass flow over density at rest and speed along the loads of each speed and temperature.

        Parameters
        ----------
        contact : str
            Name of a contact of the map.
        first : array (n_u, n_T)
            Loads from which on it is asked for [N/m], > 0, each below the highest load of the map.
        speeds, temperatures : array (n_u,), (n_T,)
            Entrainment speeds [m/s], > 0, and temperatures [K].
        field : FilmField, optional
            Films of the contact. Outside the map the flow then follows them, see above; it goes on straight without.
        """
        key: tuple[str | bytes, ...] = (contact, first.tobytes(), speeds.tobytes(), temperatures.tobytes())
        kept = self._flows.get(key)
        if kept is None or kept[0] is not field:
            if len(self._flows) >= _KEPT:
                self._flows.pop(next(iter(self._flows)))
            kept = self._flows[key] = field, self._flow_film(contact, first, speeds, temperatures, field)
        return kept[1]

    def _flow_film(
        self, contact: str, first: FloatArray, speeds: FloatArray, temperatures: FloatArray, field: FilmField | None
    ) -> FlowFilm:
        """Flow along the loads, as `flow_film` says."""
        line, reach = self._contacts[contact], np.log(self._loads[1] / first)
        places = np.linspace(0.0, 1.0, 4 + math.ceil(float(np.max(reach)) / _FLOW_STEP))
        logs = np.empty((places.size, speeds.size, temperatures.size))
        held_speeds, held = np.clip(speeds, *self._speeds), np.clip(temperatures, *self._temperatures)
        same = growth = np.ones_like(logs)
        if field is not None:
            same, growth = self._from_edge(
                line, first * np.exp(places[:, None, None] * reach), field, speeds, temperatures, held_speeds, held
            )
        for j, k in np.ndindex(speeds.size, temperatures.size):
            speed, kelvin, loads = float(speeds[j]), float(temperatures[k]), first[j, k] * np.exp(places * reach[j, k])
            loads = np.minimum(loads, self._loads[1])  # round-off
            if field is not None and (float(held_speeds[j]), float(held[k])) != (speed, kelvin):
                speed, kelvin, loads = float(held_speeds[j]), float(held[k]), same[:, j, k]
            state = self._lubricant.at(kelvin)
            number = moes_speed_number(speed, state.viscosity, line.radius, line.reduced_modulus)
            known = self._logarithms(line, loads, speed, kelvin, float(loads[0]))[1]
            logs[:, j, k] = known + math.log(line.radius * math.sqrt(number))
        logs += np.log(growth)
        return FlowFilm(CubicSpline(places, logs), np.log(first), reach)

    def _from_edge(
        self,
        line: LineContact,
        loads: FloatArray,
        field: FilmField,
        speeds: FloatArray,
        temperatures: FloatArray,
        held_speeds: FloatArray,
        held: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """Loads at the edge of the map with the same zeta, and how films grow from there, (n, n_u, n_T) each."""
        units, at_edge = (
            loads_at([line], self._lubricant, 0.0, *at) for at in ((speeds, temperatures), (held_speeds, held))
        )
        same = loads * at_edge / units
        if np.array_equal(speeds, held_speeds) and np.array_equal(temperatures, held):
            return same, np.ones_like(loads)
        here = field.films(line.name, loads, speeds, temperatures)[0]
        return same, np.asarray(here / field.films(line.name, same, held_speeds, held)[0])

    def _found(self, which: int, name: str, load: npt.ArrayLike, speed: float, temperature: float) -> FloatArray:
        """One of both, in SI."""
        contact, speed = self._contacts[name], abs(speed)
        loads = np.asarray(load, dtype=np.float64)
        empty = 0.0 if which == 0 or speed == 0.0 else math.inf
        found = np.full(loads.shape, empty)
        loaded = loads > 0.0
        if speed == 0.0 or not np.any(loaded):
            return found
        T = float(np.clip(temperature, *self._temperatures))
        groups = np.exp(self._logarithms(contact, loads[loaded], speed, T)[which])
        found[loaded] = rolling_units(contact, self._lubricant, speed, T)[which] * groups
        return found

    def _logarithms(
        self, contact: LineContact, loads: FloatArray, speed: float, T: float, first: float = math.inf
    ) -> FloatArray:
        """Logarithms of f and g at loads (n,) > 0, shape (2, n), at a temperature within the map.

        A backbone is read down to `first` at least.
        """
        low, high = self._loads
        if math.isfinite(self._start):
            low = min(low, first, load_at(contact, self._lubricant, self._start, speed, T))
        found = self._reader(contact, np.clip(loads, low, high), speed, T)
        below, above = loads < low, loads > high
        if np.any(below):
            (end,) = self._reader(contact, np.array([low]), speed, T).T
            fading = (loads[below] / low) ** _PRESSURE_EXPONENT
            left = end - self._rigid(contact, np.array([low]), speed, T)[:, 0]
            found[:, below] = self._rigid(contact, loads[below], speed, T) + left[:, None] * fading
        if np.any(above):
            last = self._reader(contact, high * np.exp([-_STEP, 0.0]), speed, T)
            exponent = (last[:, 1] - last[:, 0]) / _STEP
            found[:, above] += exponent[:, None] * np.log(loads[above] / high)
        return found

    def _rigid(self, contact: LineContact, loads: FloatArray, speed: float, T: float) -> FloatArray:
        """Logarithms of f and g between rigid surfaces, shape (2, n)."""
        viscosity = self._lubricant.at(T).viscosity
        M, _ = moes_groups(loads, speed, viscosity, 0.0, contact.radius, contact.reduced_modulus)
        force = RIGID_ROLLING_CONSTANT * np.sqrt(0.5 * M)
        return np.log(np.stack([force, RIGID_FLOW_NUMBER / M]))


LaterLines = Callable[[], tuple[Mapping[str, npt.NDArray[Any]], LineContact]]
"""What makes arrays of a backbone by name, and their reference contact, where they are asked for only."""


def rolling_film(
    values: FloatArray,
    known: BoolArray,
    axes: Sequence[FloatArray],
    backbone: xr.Dataset | LaterLines | None,
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    inlet_heat: bool = False,
) -> RollingFilm | None:
    """Rolling force and mass flow of a map; None where it does not hold them at all points that are known.

    Parameters
    ----------
    values : ndarray, shape (2, n_contacts, n_w, n_u, n_T)
        Both at the points of the map with a speed, by `NAMES`.
    known : ndarray, shape (n_contacts, n_w, n_u, n_T)
        Which points are known, along one stretch of loads; both go on straight beyond it.
    axes : sequence of ndarray
        Their loads [N/m], speeds [m/s], > 0, and temperatures [K].
    backbone : xarray.Dataset, callable or None
        Group of its refinement lines, or what makes its arrays down to rigid films.
    contacts : sequence of LineContact
        Contacts of the map.
    lubricant : Lubricant
        The oil.
    inlet_heat : bool
        Whether heat in the inlet thins the films of the lines, which know nothing of it.
    """
    if not axes[1].size or not np.all((np.isfinite(values) & (values > 0.0))[:, known]):
        return None
    reader: _Reader | None = None
    start = math.inf
    if callable(backbone):
        reader, start = _MadeLater(backbone, lubricant), RIGID
        reader = _Heated(reader, lubricant) if inlet_heat else reader
    elif backbone is not None and all(name in backbone for name in NAMES):
        reader, start = _lines_reader(backbone, contacts, lubricant)
    if reader is None:
        reader, start = _grid_reader(values, axes, contacts, lubricant), math.inf
    load_range, speed_range, temperature_range = ((float(axis[0]), float(axis[-1])) for axis in axes)
    return RollingFilm(contacts, lubricant, reader, load_range, temperature_range, start, speed_range)


# Readers are classes, not functions in functions, so that laws can be pickled.


@dataclass(frozen=True, eq=False)
class _MadeLater:
    """Reader of lines that are made when it is first called."""

    lines: LaterLines
    lubricant: Lubricant

    def __getstate__(self) -> dict[str, Any]:
        """For other processes, which make it again."""
        return {"lines": self.lines, "lubricant": self.lubricant}

    @cached_property
    def reader(self) -> _Reader:
        """The reader."""
        found = _backbone_reader(*self.lines(), self.lubricant)
        assert found is not None  # lines of the film table are whole
        return found

    def __call__(self, contact: LineContact, loads: FloatArray, speed: float, T: float) -> FloatArray:
        return self.reader(contact, loads, speed, T)


@dataclass(frozen=True, eq=False)
class _Heated:
    """Reader of films that heat in the inlet thins: rolling force and flow go with them."""

    isothermal: _Reader
    lubricant: Lubricant

    def __call__(self, contact: LineContact, loads: FloatArray, speed: float, T: float) -> FloatArray:
        every = (np.full(loads.shape, value) for value in (speed, T))
        logs = np.log(inlet_heats(contact, self.lubricant, loads, *every).factor)
        return np.asarray(self.isothermal(contact, loads, speed, T) + logs)


@dataclass(frozen=True, eq=False)
class _ByContact:
    """Readers by the names of the contacts."""

    readers: Mapping[str, _Reader]

    def __call__(self, contact: LineContact, loads: FloatArray, speed: float, T: float) -> FloatArray:
        return self.readers[contact.name](contact, loads, speed, T)


def _lines_reader(
    backbone: xr.Dataset, contacts: Sequence[LineContact], lubricant: Lubricant
) -> tuple[_Reader | None, float]:
    """Reader of the backbone, and the zeta from which on it is read; None where a line has too few solved points."""
    readers: dict[str, _Reader] = {}
    starts = []
    for lines, reference, read in lines_by_contact(backbone, contacts):
        group = lines.transpose(*BACKBONE_DIMS, ...)
        reader = _backbone_reader(group, reference, lubricant)
        if reader is None:
            return None, math.inf
        readers |= {contact.name: reader for contact in read}
        solved = [np.isfinite(group[name].values) for name in NAMES]
        starts.append(known_from(group[BACKBONE_DIMS[0]].values, np.all(solved, axis=0)))
    return _ByContact(readers), max(starts)


def _backbone_reader(group: Mapping[Any, Any], reference: LineContact, lubricant: Lubricant) -> _Reader | None:
    """Reader of the backbone; None where a line has too few solved points."""
    zeta, speeds, kelvins = (np.asarray(group[name], dtype=np.float64) for name in BACKBONE_DIMS)
    first = float(zeta[0])
    nodes = 2 + math.ceil((zeta[-1] - first) / LATTICE_STEP)
    places = first + LATTICE_STEP * np.arange(nodes)
    solved_lines = [np.asarray(group[name], dtype=np.float64) for name in NAMES]
    lattices = np.zeros((2, speeds.size * kelvins.size, nodes, 5))
    for j, speed in enumerate(speeds):
        for k, kelvin in enumerate(kelvins):
            units = rolling_units(reference, lubricant, float(speed), float(kelvin))
            for i, of_name in enumerate(solved_lines):
                line = of_name[:, j, k]
                solved = np.isfinite(line) & (line > 0.0)
                if np.count_nonzero(solved) < FEWEST_NODES:
                    return None
                spline = CubicSpline(zeta[solved], np.log(line[solved] / units[i]))
                inside = np.clip(places, zeta[solved][0], zeta[solved][-1])
                slope = spline(inside, 1)
                values = spline(inside) + slope * (places - inside)
                bend = np.where(inside == places, spline(inside, 2), 0.0)
                lattices[i, j * kelvins.size + k, :, :3] = np.column_stack([values, slope, bend])
    return _Backbone(lattices, first, np.log(speeds), kelvins, reference, lubricant)


@dataclass(frozen=True, eq=False)
class _Backbone:
    """Reader of lattices (2, n_u n_T, nodes, 5) over zeta from `first` on, by speed and temperature."""

    lattices: FloatArray
    first: float
    log_speeds: FloatArray
    kelvins: FloatArray
    reference: LineContact
    lubricant: Lubricant

    def __call__(self, contact: LineContact, loads: FloatArray, speed: float, T: float) -> FloatArray:
        state = self.lubricant.at(T)
        alpha = state.pressure_viscosity.pressure_viscosity
        unit, L = moes_groups(1.0, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
        zetas = np.log(loads * unit / valley_load_number(L))
        rows, by_speed = lagrange(self.log_speeds, math.log(speed * self.reference.radius / contact.radius))
        columns, by_temperature = lagrange(self.kelvins, T)
        lines = (rows[:, None] * self.kelvins.size + columns).ravel()
        weights = np.outer(by_speed, by_temperature).ravel()
        found = np.empty((2, 3, loads.size))
        for lattice, out in zip(self.lattices, found, strict=True):
            mix_lines(lattice, self.first, LATTICE_STEP, lines, weights, zetas, out)
        return found[:, 0]


def _grid_reader(
    values: FloatArray, axes: Sequence[FloatArray], contacts: Sequence[LineContact], lubricant: Lubricant
) -> _Reader:
    """Reader of the map's own grid: splines over ln(load), ln(speed) and temperature."""
    loads, speeds, kelvins = axes
    units = np.array(
        [[[rolling_units(contact, lubricant, u, T) for T in kelvins] for u in speeds.tolist()] for contact in contacts]
    )
    logs, log_loads = np.log(values / np.moveaxis(units, -1, 0)[:, :, None]), np.log(loads)
    from ehdmaps.maps.edges.reach import (
        continued_lines,  # with points of a map, that laws of the film table do not need
    )

    by_load = np.moveaxis(logs, 2, 0)
    logs = np.moveaxis(continued_lines(by_load.reshape(loads.size, -1), log_loads).reshape(by_load.shape), 0, 2)
    return _Grid([contact.name for contact in contacts], logs, log_loads, np.log(speeds), kelvins)


@dataclass(frozen=True, eq=False)
class _Grid:
    """Reader of ln f and ln g (2, n_contacts, n_w, n_u, n_T)."""

    names: Sequence[str]
    logs: FloatArray
    log_loads: FloatArray
    log_speeds: FloatArray
    kelvins: FloatArray

    def __call__(self, contact: LineContact, wanted: FloatArray, speed: float, T: float) -> FloatArray:
        along_w = spline_weights(self.log_loads, np.log(wanted))
        (along_u,) = spline_weights(self.log_speeds, np.array([math.log(speed)]))
        (along_t,) = spline_weights(self.kelvins, np.array([T]))
        logs = self.logs[:, self.names.index(contact.name)]
        return np.asarray(np.einsum("vwut,nw,u,t->vn", logs, along_w, along_u, along_t))


def rolling_units(contact: LineContact, lubricant: Lubricant, speed: float, T: float) -> tuple[float, float]:
    """Rolling force [N/m] and mass flow [kg/(m s)] whose numbers f and g are one.

    Parameters
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    speed, T : float
        Entrainment speed [m/s], > 0, and temperature [K].
    """
    state = lubricant.at(float(T))
    number = moes_speed_number(speed, state.viscosity, contact.radius, contact.reduced_modulus)
    force = contact.reduced_modulus * contact.radius * number**0.75
    return force, state.density * speed * contact.radius * math.sqrt(number)
