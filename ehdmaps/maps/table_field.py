"""Films of a contact law straight from the film table: lines are read at just the speeds and temperatures asked for.

A backbone holds lines at its own speeds and temperatures, between which a law interpolates. The film table knows every
line, so nothing is interpolated but along the loads: film offset, film compliance and loss compliance are read at nodes
of zeta = ln(M/M_valley(L)), and joined as those of a backbone are, so that the film compliance of a law is the exact
derivative of its film offset.
"""

from __future__ import annotations

import ctypes
import functools
import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray, IndexArray
from ehdmaps.errors import MapError
from ehdmaps.kernel import library, record
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import ERROR, IMAGINARY, LOSS_SCALE, REAL, BackboneField, OffsetLine
from ehdmaps.maps.backbone_plan import STEPS, VALLEY, plan_backbone, zeta_axis
from ehdmaps.maps.film_field import RIGID, first_loads, groups_at, lifted_loss
from ehdmaps.maps.kernels.ends import one_end
from ehdmaps.maps.kernels.splines import hermite
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import valley_load_number
from ehdmaps.table.fields import NATURAL_FREQUENCIES
from ehdmaps.table.file import film_table
from ehdmaps.table.films import FilmTable, TableFilms
from ehdmaps.units import point_text

_STEP = 0.05
"""Step of zeta in the valley, about that of the nodes of the table."""

_BESIDE = 2
"""Nodes of a line beyond its loads on either side."""

_KEPT = 6
"""Sets of lines that are kept: a law asks for those of each of its contacts several times."""

_FEWEST = 2
"""Films of a line that the table must have."""

_CLOSE, _EDGE = 1.0 - 1e-9, 1e-9
"""Round-off of L, and of speeds and temperatures."""

Range = tuple[float, float]


class _Groups(NamedTuple):
    """M per N/m, M at the valley, the film whose Moes number is one [m], L and the speed [m/s], each (n_u, n_T)."""

    unit: FloatArray
    valley: FloatArray
    film: FloatArray
    oil_number: FloatArray
    speed: FloatArray


class _Lines(NamedTuple):
    """Lines of one contact, a column each: ln of the film offset over its unit, and the damping, over zeta."""

    film: OffsetLine
    damping: CubicSpline
    groups: _Groups

    def at(self, zeta: FloatArray) -> FloatArray:
        """ln of the film offset over its unit, its slope, and the damping, (3, n, n_u, n_T), straight beyond the ends.

        `zeta` is (n, n_u, n_T).
        """
        found, cells = np.empty((3, *zeta.shape)), self.damping.c.shape[1]
        numbers = self.damping.x, self.film.integral.c, self.film.bend, np.array(VALLEY), self.damping.c
        breaks, quartic, bend, valley, cubic = (np.ascontiguousarray(part) for part in numbers)
        places, room = np.ascontiguousarray(zeta), np.empty(bend.shape[1], dtype=np.int64)
        before, after = (breaks, quartic, bend, valley, cubic), (places, room, *found)
        _columns()(room.size, cells, *map(record.at, before), zeta.shape[0], *map(record.at, after))
        return found


class TableField:
    """Films of contacts from the film table; a `FilmField`.

    The loss compliance is kept positive, see `lifted_loss`. What films with memory need is read from lines at the steps
    of a backbone, which are made where they are asked for.

    Parameters
    ----------
    contacts : sequence of LineContact
        Contacts, all of one material.
    lubricant : Lubricant
        An oil of the family of the table.
    load_range, speed_range, temperature_range : (float, float)
        Ranges of a law [N/m], [m/s], > 0, and [K].
    lenient : bool
        Whether films that the table lacks are continued within these ranges too, and not only outside them: straight
        along the loads, and at the largest L that the table knows.
    inlet_heat : bool
        Whether heat in the inlet thins the films, by its rule, see `ehdmaps.physics.heat`.
    """

    dry = False

    def __init__(
        self,
        contacts: Sequence[LineContact],
        lubricant: Lubricant,
        load_range: Range,
        speed_range: Range,
        temperature_range: Range,
        lenient: bool = False,
        inlet_heat: bool = False,
    ) -> None:
        self._lenient, self._inlet_heat = lenient, inlet_heat
        self.contacts = tuple(contact.name for contact in contacts)
        self.load_range, self.speed_range, self.temperature_range = load_range, speed_range, temperature_range
        self._contacts = {contact.name: contact for contact in contacts}
        self._lubricant = lubricant
        self._kept: dict[tuple[str, bytes, bytes], _Lines] = {}

    def __getstate__(self) -> dict[str, object]:
        """For other processes: without what is read from the film table, which every process has."""
        state = {name: value for name, value in self.__dict__.items() if name not in ("_table", "_memory")}
        return {**state, "_kept": {}}

    @cached_property
    def _table(self) -> FilmTable:
        return film_table(self._lubricant)

    @cached_property
    def _memory(self) -> BackboneField:
        """Lines with responses, isothermal in any case: what is read of them is parts of a film that relaxes."""
        contacts, ranges = tuple(self._contacts.values()), (self.load_range, self.speed_range, self.temperature_range)
        lines, reference = table_lines(contacts, self._lubricant, *ranges)
        return BackboneField(lines, reference, contacts, self._lubricant, *ranges)

    def films(
        self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Film offset, film compliance and loss compliance of one contact; see `FilmField.films`.

        Raises
        ------
        MapError
            If the table has no films of these loads.
        """
        chosen = self._contacts[contact]
        key = contact, speeds.tobytes(), temperatures.tobytes()
        lines = self._kept.get(key)
        if lines is None:
            if len(self._kept) >= _KEPT:
                self._kept.pop(next(iter(self._kept)))
            lines = self._kept[key] = self._lines(chosen, speeds, temperatures)
        zeta = np.log(loads * lines.groups.unit / lines.groups.valley)
        log_film, slope, share = lines.at(zeta)
        offset = lines.groups.film * np.exp(log_film)
        compliance = -slope * offset / loads
        width = half_width(loads, chosen.radius, chosen.reduced_modulus)
        u = speeds[:, None]
        loss = LOSS_SCALE * np.sinh(share) * offset / loads * width / u
        total = np.asarray(chosen.structural_compliance(loads)) + compliance
        return offset, compliance, lifted_loss(loss, width, u, total)

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Loads from which on films are read [N/m], (n_u, n_T): down to rigid ones; see `FilmField.first_loads`."""
        contacts = list(self._contacts.values())
        return first_loads(contacts, self._lubricant, self.load_range[0], RIGID, speeds, temperatures)

    @property
    def ends(self) -> FloatArray:
        """The highest load everywhere; see `FilmField.ends`."""
        return one_end(self.load_range[1])

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> FloatArray | None:
        """Factors of the closed formula of the locked film; see `FilmField.locked_factors`."""
        return self._memory.locked_factors(contact, loads, speed, temperature)

    def film_differences(
        self, contact: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, ComplexArray] | None:
        """Part that films with memory leave out at natural frequencies; see `FilmField.film_differences`."""
        return self._memory.film_differences(contact, loads, speed, temperature)

    def _groups(self, contact: LineContact, speeds: FloatArray, temperatures: FloatArray) -> _Groups:
        """Groups of a contact at speeds (n_u,) or (n_u, n_T)."""
        units, numbers = groups_at(contact, self._lubricant, speeds, temperatures)
        every = np.broadcast_to(speeds if speeds.ndim == 2 else speeds[:, None], units.shape)
        # film and load of one have the same speed number
        films = 1.0 / (contact.reduced_modulus * units)
        return _Groups(units, valley_load_number(numbers), films, numbers, every)

    def _lines(self, contact: LineContact, speeds: FloatArray, temperatures: FloatArray) -> _Lines:
        """Lines over the loads of the field, from rigid films on, at each speed and temperature."""
        groups = self._groups(contact, speeds, temperatures)
        low, high = (
            np.log(w * groups.unit / groups.valley)
            for w in (self.first_loads(speeds, temperatures), self.load_range[1])
        )
        axis = np.array(zeta_axis(float(np.min(low)), float(np.max(high)), _STEP))
        first = np.maximum(np.searchsorted(axis, low) - _BESIDE, 0)
        last = np.minimum(np.searchsorted(axis, high) + _BESIDE, axis.size)
        places = np.arange(axis.size)[:, None, None]
        wanted = (places >= first) & (places < last)
        at = np.nonzero(wanted)
        values, read = self._read(contact, axis[at[0]], at[1:], speeds, temperatures)
        needed = (np.exp(axis)[:, None, None] * groups.valley / groups.unit)[at]
        in_range = (needed >= self.first_loads(speeds, temperatures)[at[1:]]) & (needed <= self.load_range[1])
        lacking = np.flatnonzero(~read.usable & in_range & ~self._goes_on(speeds, temperatures)[at[1:]])
        if lacking.size:
            self._refuse(read, int(lacking[0]), float(needed[lacking[0]]), speeds[at[1]], temperatures[at[2]])
        held = np.full((3, *wanted.shape), np.nan)
        held[:, wanted] = values
        held = held.reshape(3, axis.size, -1)
        shortest = np.flatnonzero(np.count_nonzero(np.isfinite(held[0]), axis=0) < _FEWEST)
        if shortest.size:
            j, k = np.unravel_index(int(shortest[0]), groups.unit.shape)
            i = int(np.flatnonzero((at[1] == j) & (at[2] == k) & ~read.usable)[0])
            self._refuse(read, i, float(needed[i]), speeds[at[1]], temperatures[at[2]])
        _bridge(axis, held)
        _go_on(axis, held)
        film_line = OffsetLine.through(axis, held[0], held[1])
        return _Lines(film_line, CubicSpline(axis, held[2]), groups)

    def _read(
        self,
        contact: LineContact,
        zeta: FloatArray,
        at: tuple[IndexArray, ...],
        speeds: FloatArray,
        temperatures: FloatArray,
    ) -> tuple[FloatArray, TableFilms]:
        """Read reduced films (3, n) at zeta (n,) of the lines `at`; those of too large an L at the largest one."""
        groups = self._groups(contact, speeds, temperatures)
        largest = _CLOSE * self._table.largest_oil_number
        # an isoviscous oil has no L
        held = groups.speed * (largest / np.maximum(groups.oil_number, largest)) ** 4
        held = np.where(self._goes_on(speeds, temperatures), held, groups.speed)
        groups = self._groups(contact, held, temperatures) if np.any(held < groups.speed) else groups
        unit, valley, film, u = (part[at] for part in (groups.unit, groups.valley, groups.film, groups.speed))
        w = np.exp(zeta) * valley / unit
        T, heat = temperatures[at[1]], self._inlet_heat
        read = self._table.films(
            contact, self._lubricant, w, u, T, others=False, thickest_film=math.inf, inlet_heat=heat
        )
        width = half_width(w, contact.radius, contact.reduced_modulus)
        with np.errstate(invalid="ignore"):
            values = np.stack(
                [
                    np.log(read.film_offset / film),
                    -read.film_compliance * w / read.film_offset,
                    np.arcsinh(read.loss_compliance * u * w / (read.film_offset * width) / LOSS_SCALE),
                ]
            )
        return np.where(read.usable, values, np.nan), read

    def _goes_on(self, speeds: FloatArray, temperatures: FloatArray) -> BoolArray:
        """Tell which lines go on straight where the table lacks films, (n_u, n_T): those outside the ranges."""
        (slow, fast), (cold, hot) = self.speed_range, self.temperature_range
        outside = (speeds < slow * (1.0 - _EDGE)) | (speeds > fast * (1.0 + _EDGE))
        beyond = (temperatures < cold * (1.0 - _EDGE)) | (temperatures > hot * (1.0 + _EDGE))
        return np.asarray(self._lenient | outside[:, None] | beyond)

    def _refuse(self, read: TableFilms, i: int, load: float, speeds: FloatArray, temperatures: FloatArray) -> None:
        """Say what the table lacks."""
        raise MapError(
            f"{read.reason.flat[i]!s} at {point_text(load, float(speeds[i]), float(temperatures[i]))}; have the films "
            'solved: [solver] films = "solved"'
        )

    def knows(self, contact: str, speeds: FloatArray, temperatures: FloatArray) -> BoolArray:
        """Tell at which temperatures the table has films in the middle of the loads of a contact, (n_T,).

        Parameters
        ----------
        contact : str
            Name of the contact.
        speeds, temperatures : array (n_u,), (n_T,)
            [m/s], > 0, at all of which there are films, and [K].
        """
        chosen = self._contacts[contact]
        groups = self._groups(chosen, speeds, temperatures)
        middle = np.log(math.sqrt(self.load_range[0] * self.load_range[1]) * groups.unit / groups.valley)
        at = np.nonzero(np.ones(groups.unit.shape, dtype=bool))
        _, read = self._read(chosen, middle[at], at, speeds, temperatures)
        return np.asarray(np.all(read.usable.reshape(middle.shape), axis=0))

    def film_errors(
        self, contact: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Errors of the reduced film of one contact, (n,) each: of ln h, of -d ln h/d ln w, and of asinh of the loss.

        Where the table lacks the film, and lines go on straight, the errors are those at the last film that it has, and
        what the line has changed since.

        Parameters
        ----------
        contact : str
            Name of the contact.
        loads : array (n,)
            [N/m].
        speed, temperature : float
            [m/s], > 0, and [K].
        """
        chosen, at, kelvin = self._contacts[contact], np.array([speed]), np.array([temperature])
        groups = self._groups(chosen, at, kelvin)
        zeta = np.log(np.asarray(loads, dtype=np.float64) * groups.unit[0, 0] / groups.valley[0, 0])
        low, high = np.log(np.array(self.load_range) * groups.unit[0, 0] / groups.valley[0, 0])
        axis = np.array(zeta_axis(min(low, float(np.min(zeta))), max(high, float(np.max(zeta))), 4.0 * _STEP))
        zero = np.zeros(axis.size, dtype=np.intp)
        values, read = self._read(chosen, axis, (zero, zero), at, kelvin)
        known = np.flatnonzero(read.usable)
        if not known.size:
            whole = np.ones(zeta.size)
            return whole, whole, whole
        slope, share = np.abs(values[1, known]), np.sinh(values[2, known])
        errors = [
            read.errors["film_offset"][known],
            slope * (read.errors["film_compliance"][known] + read.errors["film_offset"][known]),
            np.abs(share) / np.hypot(1.0, share) * read.errors["loss_compliance"][known],
        ]
        held = np.clip(zeta, axis[known[0]], axis[known[-1]])
        away = np.abs(zeta - held)
        rates = np.gradient(values[2, known], axis[known]) if known.size > 1 else np.zeros(known.size)
        moved = [np.interp(held, axis[known], np.abs(part)) * away for part in (values[1, known], rates)]
        by_offset, by_slope, by_loss = (
            np.interp(held, axis[known], np.nan_to_num(error, posinf=1.0)) for error in errors
        )
        return by_offset + moved[0], by_slope + moved[0], by_loss + moved[1]


def _bridge(axis: FloatArray, values: FloatArray) -> None:
    """Fill gaps within lines, in place: ln(film offset) by a cubic with the slopes at both ends, the damping straight.

    `values` as of `_go_on`. One film that the table does not vouch for says nothing against those on both sides of it.
    """
    known: BoolArray = np.isfinite(values[0])
    gaps = ~known & np.logical_or.accumulate(known, 0) & np.logical_or.accumulate(known[::-1], 0)[::-1]
    for line in np.flatnonzero(gaps.any(axis=0)):
        at, gap = np.flatnonzero(known[:, line]), np.flatnonzero(gaps[:, line])
        before = np.searchsorted(at, gap) - 1
        left, right = at[before], at[before + 1]
        step = axis[right] - axis[left]
        part = (axis[gap] - axis[left]) / step
        begin, end = ((values[0, place, line], values[1, place, line]) for place in (left, right))
        values[0, gap, line], values[1, gap, line] = hermite(begin, end, part, step)
        values[2, gap, line] = (1.0 - part) * values[2, left, line] + part * values[2, right, line]


def _go_on(axis: FloatArray, values: FloatArray) -> None:
    """Continue lines to both ends of the axis where they are not known, in place: straight, as a law would read them.

    `values` are ln(film offset), its slope and the damping, (3, n, lines); each line is known along one stretch.
    """
    known: BoolArray = np.isfinite(values[0])
    first, last = np.argmax(known, axis=0), axis.size - 1 - np.argmax(known[::-1], axis=0)
    lines = np.arange(known.shape[1])
    for end, beside, outside in (
        (first, first + 1, np.arange(axis.size)[:, None] < first),
        (last, last - 1, np.arange(axis.size)[:, None] > last),
    ):
        away = axis[:, None] - axis[end]
        slope = values[1, end, lines]
        rate = (values[2, end, lines] - values[2, beside, lines]) / (axis[end] - axis[beside])
        values[0] = np.where(outside, values[0, end, lines] + slope * away, values[0])
        values[1] = np.where(outside, slope, values[1])
        values[2] = np.where(outside, values[2, end, lines] + rate * away, values[2])


@functools.cache
def _columns() -> Callable[..., None]:
    """The function of the C library that reads lines."""
    pointer, count = ctypes.c_void_p, ctypes.c_int64
    return library.function("ehd_film_columns", count, count, *[pointer] * 5, count, *[pointer] * 5, result=None)


def table_lines(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    loads: Range,
    speeds: Range,
    temperatures: Range,
    reach: float = 1.0,
) -> tuple[dict[str, npt.NDArray[Any]], LineContact]:
    """Arrays of a backbone by name, with films and responses read from the film table, and its reference contact.

    Parameters
    ----------
    contacts, lubricant
        Contacts and oil of the map.
    loads, speeds, temperatures : (float, float)
        Ranges of the map [N/m], [m/s], > 0, and [K].
    reach : float
        Up to this multiple of the highest speed lines are laid, where the table has films there.
    """
    plan = plan_backbone(contacts, lubricant, loads, (speeds[0], reach * speeds[1]), temperatures, STEPS)
    assert plan is not None
    shape = (len(plan.zeta), len(plan.speeds), len(plan.temperatures))
    of = [(line.place[0] + i, *line.place[1:]) for line in plan.lines for i in range(len(line.loads))]
    at = tuple(np.array(of).T)
    w = np.concatenate([line.loads for line in plan.lines])
    u, T = np.array(plan.speeds)[at[1]], np.array(plan.temperatures)[at[2]]
    read = film_table(lubricant).films(plan.contact, lubricant, w, u, T, response=True, thickest_film=math.inf)
    if reach > 1.0 and not np.all(read.usable):
        return table_lines(contacts, lubricant, loads, speeds, temperatures)
    values = {}
    for name in ("film_offset", "film_compliance", "loss_compliance", "rolling_force", "mass_flow"):
        values[name] = np.full(shape, np.nan)
        values[name][at] = getattr(read, name)
    responses = (read.response.real, read.response.imag, read.errors["response"])
    for name, response in zip((REAL, IMAGINARY, ERROR), responses, strict=True):
        values[name] = np.full((*shape, len(NATURAL_FREQUENCIES)), np.nan)
        values[name][at] = response
    status = np.full(shape, schema.NOT_NEEDED, dtype=np.int8)
    status[at] = read.status
    axes = (*schema.BACKBONE_DIMS, schema.NATURAL), (plan.zeta, plan.speeds, plan.temperatures, NATURAL_FREQUENCIES)
    return {**dict(zip(axes[0], map(np.array, axes[1]), strict=True)), **values, "status": status}, plan.contact
