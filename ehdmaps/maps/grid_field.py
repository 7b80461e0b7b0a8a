"""The film of a map between its own grid points, and between refinement lines that contacts share or have alone.

The film of one contact and oil depends on load and speed through Moes' groups M and L; along speed at constant M it
changes slowly, at constant load it does not (a narrow valley of the damping stays at constant M). So the line of
loads of each speed and temperature is first taken to an axis of ln M that all lines share, then the lines are
interpolated in ln u and T at constant M, then each wanted load is found on the common axis.

Where a map has refinement lines, these are read, see `backbone`. Isothermal films of one oil go by Moes' M and L at a
temperature, so that one reference contact stands for all. Heat has a group of its own, QL = -(d eta0/dT) u^2/k_f, in
which contacts of equal M and L differ: the outer contact then has lines of its own, on the axes of those of the inner
one (`ehdmaps.maps.schema.OWN`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, reduce
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from ehdmaps.arrays import ComplexArray, FloatArray, IndexArray
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import BackboneField
from ehdmaps.maps.film_field import FilmField, lifted_loss, same_load
from ehdmaps.maps.kernels.ends import one_end
from ehdmaps.maps.kernels.splines import hermite, spline_weights
from ehdmaps.maps.records import contacts_from_json
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_speed_number

if TYPE_CHECKING:
    import xarray as xr

    from ehdmaps.maps.edges.reach import Reach

_STEP = 0.02
_FORGOTTEN = 0.5


class Lines(NamedTuple):
    """Film of one contact over ln M (first axis), speed and temperature, in Moes' scaling.

    Attributes
    ----------
    start : float
        First node of ln M; nodes are `_STEP` apart.
    film, film_slope : array (n, n_u, n_T)
        ln H and d ln H/d ln M, H = h_eff/R (eta0 us/(E'R))^(-1/2).
    loss, loss_slope : array (n, n_u, n_T)
        ln B and d ln B/d ln M, B = E' u times the loss compliance.
    trends : array (4, n, n_T)
        How the four go on beyond the highest speed, by ln u.
    """

    start: float
    film: FloatArray
    film_slope: FloatArray
    loss: FloatArray
    loss_slope: FloatArray
    trends: FloatArray


@dataclass(frozen=True)
class GridField:
    """Film field of a regular grid of solved points; see `FilmField`.

    Attributes
    ----------
    line_contacts : tuple of LineContact
        Contacts in the order of the first axis of the arrays.
    lubricant : Lubricant
        The oil.
    loads, speeds, temperatures : array
        Axes [N/m], [m/s], [K]; only speeds above zero are used.
    film_offset, film_compliance, loss_compliance : array (contacts, n_w, n_u, n_T)
        [m], [m2/N], [m2 s/N]; the offset is positive where the speed is, or all zero in a dry map; NaN where nothing
        is known: each line of loads is known along one stretch. Where the loss of a contact is not positive everywhere
        (at the bottom of its valley it may be solved negative), it is lifted smoothly, see `lifted_loss`.
    reach : Reach, optional
        Loads between which all contacts are known; those of the axis if left out.
    """

    line_contacts: tuple[LineContact, ...]
    lubricant: Lubricant
    loads: FloatArray
    speeds: FloatArray
    temperatures: FloatArray
    film_offset: FloatArray
    film_compliance: FloatArray
    loss_compliance: FloatArray
    reach: Reach | None = field(default=None, kw_only=True)

    @property
    def contacts(self) -> tuple[str, ...]:
        """Names of the contacts."""
        return tuple(contact.name for contact in self.line_contacts)

    @property
    def load_range(self) -> tuple[float, float]:
        """Lowest and highest load [N/m]."""
        return (float(self.loads[0]), float(self.loads[-1])) if self.reach is None else self.reach.load_range

    @property
    def speed_range(self) -> tuple[float, float]:
        """Lowest speed above zero and highest speed [m/s]; 0 and 0 if there is only standstill."""
        moving = self.speeds[self.speeds > 0.0]
        return (float(moving[0]), float(moving[-1])) if moving.size else (0.0, 0.0)

    @property
    def temperature_range(self) -> tuple[float, float]:
        """Lowest and highest temperature [K]."""
        return float(self.temperatures[0]), float(self.temperatures[-1])

    @property
    def dry(self) -> bool:
        """True where there is no film anywhere."""
        return not np.any(self.film_offset)

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """The lowest known load; see `FilmField.first_loads`."""
        if self.reach is None:
            return same_load(self.load_range[0], speeds, temperatures)
        return self.reach.first_loads(speeds, temperatures)

    @property
    def ends(self) -> FloatArray:
        """The highest known load; see `FilmField.ends`."""
        return one_end(self.load_range[1]) if self.reach is None else self.reach.ends

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> None:
        """Nothing is known of films that oscillate; see `FilmField.locked_factors`."""

    def film_differences(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> None:
        """Nothing is known of films that oscillate; see `FilmField.film_differences`."""

    def films(
        self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Film of one contact; see `FilmField.films`."""
        solids = self.line_contacts[self.contacts.index(contact)]
        lines = self._lines[contact]
        log_speeds = np.log(speeds)
        inside = np.minimum(log_speeds, math.log(self.speed_range[1]))
        along_u = spline_weights(np.log(self.speeds[self.speeds > 0.0]), inside)
        along_t = spline_weights(self.temperatures, temperatures)
        film, film_slope, loss, loss_slope = (
            np.einsum("mjk,uj,tk->mut", values, along_u, along_t, optimize=True)
            + np.einsum("mk,u,tk->mut", trend, log_speeds - inside, along_t, optimize=True)
            for values, trend in zip(lines[1:5], lines.trends, strict=True)
        )
        speed_numbers = self._speed_numbers(solids, speeds, temperatures)
        modulus = solids.reduced_modulus
        place = np.log(loads / (modulus * solids.radius * np.sqrt(speed_numbers)))
        log_film, exponent = _along(place, lines.start, film, film_slope)
        log_loss, _ = _along(place, lines.start, loss, loss_slope)
        offset = solids.radius * np.sqrt(speed_numbers) * np.exp(log_film)
        return offset, -offset * exponent / loads, np.exp(log_loss) / (modulus * speeds[:, None])

    def _speed_numbers(self, contact: LineContact, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Group eta0 us/(E'R) of each speed and temperature."""
        viscosities = [self.lubricant.at(float(temperature)).viscosity for temperature in temperatures]
        per_speed = [moes_speed_number(1.0, eta, contact.radius, contact.reduced_modulus) for eta in viscosities]
        numbers: FloatArray = speeds[:, None] * np.array(per_speed)
        return numbers

    @cached_property
    def _lines(self) -> Mapping[str, Lines]:
        """Lines of every contact."""
        return {contact.name: self._common_lines(i, contact) for i, contact in enumerate(self.line_contacts)}

    def _common_lines(self, index: int, contact: LineContact) -> Lines:
        """Lines of one contact on an axis of ln M that covers all of them."""
        moving = self.speeds > 0.0
        speeds = self.speeds[moving]
        numbers = self._speed_numbers(contact, speeds, self.temperatures)
        loads = self.loads[:, None, None]
        offset, compliance, loss = (
            values[index][:, moving, :] for values in (self.film_offset, self.film_compliance, self.loss_compliance)
        )
        modulus, radius = contact.reduced_modulus, contact.radius
        log_load = np.log(loads / (modulus * radius * np.sqrt(numbers)))
        log_film = np.log(offset / (radius * np.sqrt(numbers)))
        film_slope = -compliance * loads / offset
        if np.any(loss <= 0.0):
            loss = self._lifted(contact, loss, compliance, speeds)
        log_loss = np.log(loss * modulus * speeds[:, None])

        start = float(np.min(log_load))
        nodes = start + _STEP * np.arange(int((np.max(log_load) - start) / _STEP) + 2)
        tables = np.empty((4, nodes.size, *numbers.shape))
        ends = np.empty((2, *numbers.shape), dtype=int)
        places = np.empty((2, *numbers.shape))
        for j, k in np.ndindex(*numbers.shape):
            known = np.isfinite(offset[:, j, k])
            line = log_load[known, j, k]
            places[:, j, k] = line[0], line[-1]
            inside = np.clip(nodes, line[0], line[-1])
            pieces: Sequence[CubicHermiteSpline | PchipInterpolator]
            if line.size > 1:
                pieces = (
                    CubicHermiteSpline(line, log_film[known, j, k], film_slope[known, j, k]),
                    PchipInterpolator(line, log_loss[known, j, k]),
                )
                for row, piece in enumerate(pieces):
                    slope = piece(inside, nu=1)
                    tables[2 * row, :, j, k] = piece(inside) + (nodes - inside) * slope
                    tables[2 * row + 1, :, j, k] = slope
            ends[:, j, k] = np.searchsorted(nodes, line[0]), np.searchsorted(nodes, line[-1], side="right") - 1
        _complete(tables, ends, [np.argsort(places[0], axis=None), np.argsort(-places[1], axis=None)])
        trends = _trends(tables, ends[:, -1, :], np.log(speeds))
        return Lines(start, tables[0], tables[1], tables[2], tables[3], trends)

    def _lifted(
        self, contact: LineContact, loss: FloatArray, film_compliance: FloatArray, speeds: FloatArray
    ) -> FloatArray:
        """Loss compliance made positive, (n_w, n_u, n_T); see `loss_compliance`."""
        compliance = film_compliance + contact.structural_compliance(self.loads)[:, None, None]
        width = half_width(self.loads, contact.radius, contact.reduced_modulus)[:, None, None]
        return lifted_loss(loss, width, speeds[:, None], compliance)


def _trends(tables: FloatArray, ends: IndexArray, log_speeds: FloatArray) -> FloatArray:
    """Change of the lines with ln u at the highest speed and constant M, (4, n, n_T).

    A parabola in ln M over the range of the line of the highest speed, constant beyond: what lies between two lines
    (a valley that moves a little) must not grow out of proportion far beyond them.
    """
    trends = np.zeros((4, tables.shape[1], tables.shape[3]))
    if log_speeds.size == 1:
        return trends
    step = 1e-3 * (log_speeds[-1] - log_speeds[-2])
    last_two = np.array([log_speeds[-1] - step, log_speeds[-1]])
    quotient = np.diff(spline_weights(log_speeds, last_two), axis=0)[0] / step
    places = _STEP * np.arange(tables.shape[1])
    for k in range(tables.shape[3]):
        first, last = ends[:, k]
        inside = np.clip(places, places[first], places[last])
        covered = slice(first, last + 1)
        for row in (0, 2):
            change = np.einsum("mj,j->m", tables[row, covered, :, k], quotient)
            parabola = np.polynomial.Polynomial.fit(places[covered], change, min(2, int(last - first)))
            trends[row, :, k] = parabola(inside)
            trends[row + 1, :, k] = np.where(inside == places, parabola.deriv()(inside), 0.0)
    return trends


def _along(place: FloatArray, start: float, values: FloatArray, slopes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and slopes at places of a uniform axis, line by line; tangents beyond its ends."""
    x = (place - start) / _STEP
    inside = np.clip(x, 0.0, values.shape[0] - 1)
    cell = np.minimum(inside.astype(np.intp), values.shape[0] - 2)
    left, right = ((np.take_along_axis(values, at, 0), np.take_along_axis(slopes, at, 0)) for at in (cell, cell + 1))
    value, slope = hermite(left, right, inside - cell, _STEP)
    return value + _STEP * (x - inside) * slope, slope


def _complete(tables: FloatArray, ends: IndexArray, farthest: Sequence[IndexArray]) -> None:
    """Continue each line beyond its own loads in the shape of the next line that goes there.

    Of two lines of all loads the one with the larger speed number reaches lower M, the other one higher M. The shape is
    followed from equal value and slope; the difference of slopes dies away within `_FORGOTTEN` of ln M.

    Parameters
    ----------
    tables : array (4, n, n_u, n_T)
        Values, slopes, values, slopes; changed in place. Beyond the lines' ends they hold tangents.
    ends : array (2, n_u, n_T)
        First and last node inside each line.
    farthest : sequence of array
        Lines in the order in which they reach low M, and high M.
    """
    shape = ends.shape[1:]
    for end, order in enumerate(farthest):
        for leader, follower in pairwise(order):
            a, b = np.unravel_index(leader, shape), np.unravel_index(follower, shape)
            last = ends[(end, *b)]
            beyond = slice(None, last) if end == 0 else slice(last + 1, None)
            nodes = np.arange(tables.shape[1])[beyond]
            distance = _STEP * (nodes - last)
            fading = np.exp(-np.abs(distance) / _FORGOTTEN)
            for row in (0, 2):
                values, slopes = tables[row], tables[row + 1]
                kink = slopes[(last, *b)] - slopes[(last, *a)]
                values[(beyond, *b)] = (
                    values[(last, *b)]
                    + values[(beyond, *a)]
                    - values[(last, *a)]
                    + kink * _FORGOTTEN * np.sign(distance) * (1.0 - fading)
                )
                slopes[(beyond, *b)] = slopes[(beyond, *a)] + kink * fading


_OF_OUTER = "outer"


def has_own_lines(group: xr.Dataset) -> bool:
    """Tell whether each contact has lines of its own.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of a map.
    """
    return f"{schema.OWN}film_offset" in group.variables


def lines_by_contact(
    group: xr.Dataset, contacts: Sequence[LineContact]
) -> tuple[tuple[xr.Dataset, LineContact, tuple[LineContact, ...]], ...]:
    """Lines, the contact that they were solved for, and the contacts that are read from them.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of a map.
    contacts : sequence of LineContact
        Contacts that are wanted.

    Raises
    ------
    MapError
        If the record of the reference contact does not read.
    """
    (reference,) = contacts_from_json(f"[{group.attrs[schema.REFERENCE_CONTACT]}]")
    if not has_own_lines(group):
        return ((group, reference, tuple(contacts)),)
    found = []
    for contact in contacts:
        own = contact.name == _OF_OUTER
        found.append((_of_outer(group) if own else group, contact if own else reference, (contact,)))
    return tuple(found)


def _of_outer(group: xr.Dataset) -> xr.Dataset:
    """The lines of the outer contact, named as those of a reference contact."""
    names = {name: str(name).removeprefix(schema.OWN) for name in group.data_vars if str(name).startswith(schema.OWN)}
    return group[list(names)].rename(names)


def line_field(
    group: xr.Dataset,
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    load_range: tuple[float, float],
    speed_range: tuple[float, float],
    temperature_range: tuple[float, float],
) -> FilmField:
    """Films of contacts between their lines: a `BackboneField`, or one a contact where each has its own.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of a map.
    contacts : sequence of LineContact
        Contacts that are wanted.
    lubricant : Lubricant
        The oil.
    load_range, speed_range, temperature_range : tuple of float
        Range of the map's axes [N/m], [m/s], [K].

    Raises
    ------
    MapError
        If a line has too few solved points to be read.
    """
    fields = tuple(
        BackboneField(lines, reference, read, lubricant, load_range, speed_range, temperature_range)
        for lines, reference, read in lines_by_contact(group, contacts)
    )
    return fields[0] if len(fields) == 1 else _OwnFields(fields)


class _OwnFields:
    """Films of contacts that each have their own lines; a `FilmField`.

    Parameters
    ----------
    fields : tuple of BackboneField
        One a contact.
    """

    def __init__(self, fields: tuple[BackboneField, ...]) -> None:
        self.contacts = tuple(name for field in fields for name in field.contacts)
        self.load_range = fields[0].load_range
        self.speed_range = fields[0].speed_range
        self.temperature_range = fields[0].temperature_range
        self.dry = False
        self._fields = {name: field for field in fields for name in field.contacts}

    def films(
        self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Film offset, film compliance and loss compliance of one contact; see `FilmField.films`."""
        return self._fields[contact].films(contact, loads, speeds, temperatures)

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Loads from which on the lines are read, the lowest of all contacts; see `FilmField.first_loads`."""
        return reduce(np.minimum, (field.first_loads(speeds, temperatures) for field in self._fields.values()))

    @property
    def ends(self) -> FloatArray:
        """The highest load everywhere; see `FilmField.ends`."""
        return one_end(self.load_range[1])

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> FloatArray | None:
        """Factors of the closed formula of the locked film; see `FilmField.locked_factors`."""
        return self._fields[contact].locked_factors(contact, loads, speed, temperature)

    def film_differences(
        self, contact: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, ComplexArray] | None:
        """Part that films with memory leave out; see `FilmField.film_differences`."""
        return self._fields[contact].film_differences(contact, loads, speed, temperature)
