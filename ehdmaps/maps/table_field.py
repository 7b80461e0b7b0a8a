"""Films of a contact law straight from the film table: lines are read at just the speeds and temperatures asked for.

A backbone holds lines at its own speeds and temperatures, between which a law interpolates. The film table knows every
line, so nothing is interpolated but along the loads: film offset, film compliance and loss compliance are read at nodes
of zeta = ln(M/M_valley(L)), and joined as those of a backbone are, so that the film compliance of a law is the exact
derivative of its film offset.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline, PPoly

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray
from ehdmaps.errors import MapError
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import ERROR, IMAGINARY, LOSS_SCALE, REAL, BackboneField, OffsetLine
from ehdmaps.maps.backbone_plan import NAME, STEPS, plan_backbone, zeta_axis
from ehdmaps.maps.film_field import RIGID, first_loads, lifted_loss
from ehdmaps.maps.records import reference_json
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, moes_speed_number, valley_load_number
from ehdmaps.table.fields import NATURAL_FREQUENCIES
from ehdmaps.table.file import film_table
from ehdmaps.table.films import FilmTable
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

_STEP = 0.05
"""Step of zeta in the valley, about that of the nodes of the table."""

_BESIDE = 2
"""Nodes of a line beyond its loads on either side."""

_KEPT = 6
"""Sets of lines that are kept: a law asks for those of each of its contacts several times."""

Range = tuple[float, float]


class _Groups(NamedTuple):
    """M per N/m, M at the valley and the film whose Moes number is one [m], each (n_u, n_T)."""

    unit: FloatArray
    valley: FloatArray
    film: FloatArray


class _Lines(NamedTuple):
    """Lines of one contact, a column each: ln of the film offset over its unit, and the damping, over zeta."""

    film: OffsetLine
    damping: CubicSpline
    ends: Range
    groups: _Groups


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
    """

    dry = False

    def __init__(
        self,
        contacts: Sequence[LineContact],
        lubricant: Lubricant,
        load_range: Range,
        speed_range: Range,
        temperature_range: Range,
    ) -> None:
        self.contacts = tuple(contact.name for contact in contacts)
        self.load_range, self.speed_range, self.temperature_range = load_range, speed_range, temperature_range
        self._contacts = {contact.name: contact for contact in contacts}
        self._lubricant = lubricant
        self._kept: dict[tuple[str, bytes, bytes], _Lines] = {}

    @cached_property
    def _table(self) -> FilmTable:
        return film_table(self._lubricant)

    @cached_property
    def _memory(self) -> BackboneField:
        """Lines with responses."""
        contacts, ranges = tuple(self._contacts.values()), (self.load_range, self.speed_range, self.temperature_range)
        group = table_lines(contacts, self._lubricant, *ranges)
        return BackboneField(group, replace(contacts[0], name=NAME), contacts, self._lubricant, *ranges)

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
        zeta = np.log(loads * lines.groups.unit / lines.groups.valley).reshape(loads.shape[0], -1)
        inside = np.clip(zeta, *lines.ends)
        beyond = zeta - inside
        value, steep = columns(lines.film.integral, inside)
        slope = steep + lines.film.bent(inside, 1)
        log_film = value + lines.film.bent(inside, 0) + slope * beyond
        share, rate = columns(lines.damping, inside)
        log_film, slope, share = (values.reshape(loads.shape) for values in (log_film, slope, share + rate * beyond))
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

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> FloatArray | None:
        """Factors of the closed formula of the locked film; see `FilmField.locked_factors`."""
        return self._memory.locked_factors(contact, loads, speed, temperature)

    def film_differences(
        self, contact: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, ComplexArray] | None:
        """Part that films with memory leave out at natural frequencies; see `FilmField.film_differences`."""
        return self._memory.film_differences(contact, loads, speed, temperature)

    def _groups(self, contact: LineContact, speeds: FloatArray, temperatures: FloatArray) -> _Groups:
        """Groups of a contact."""
        found = np.empty((3, speeds.size, temperatures.size))
        radius, modulus = contact.radius, contact.reduced_modulus
        for k, temperature in enumerate(temperatures.tolist()):
            state = self._lubricant.at(temperature)
            alpha = state.pressure_viscosity.pressure_viscosity
            for j, speed in enumerate(speeds.tolist()):
                unit, L = moes_groups(1.0, speed, state.viscosity, alpha, radius, modulus)
                scale = radius * math.sqrt(moes_speed_number(speed, state.viscosity, radius, modulus))
                found[:, j, k] = float(unit), float(valley_load_number(L)), scale
        return _Groups(*found)

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
        loads = np.exp(axis)[:, None, None] * groups.valley / groups.unit
        u, T = np.broadcast_arrays(*np.meshgrid(speeds, temperatures, indexing="ij"))
        at = np.nonzero(wanted)
        read = self._table.films(
            contact, self._lubricant, loads[at], u[at[1:]], T[at[1:]], others=False, thickest_film=math.inf
        )
        needed = (loads >= self.first_loads(speeds, temperatures)) & (loads <= self.load_range[1])
        lacking = np.flatnonzero(~read.usable & needed[at])
        if lacking.size:
            i = int(lacking[0])
            raise MapError(
                f"{read.reason.flat[i]!s} at {LOAD.text(float(loads[at][i]))}, {SPEED.text(float(u[at[1:]][i]))}, "
                f'{TEMPERATURE.text(float(T[at[1:]][i]))}; have the films solved: [solver] films = "solved"'
            )
        w = loads[at]
        width = half_width(w, contact.radius, contact.reduced_modulus)
        film = groups.film[at[1:]]
        values = np.full((3, *wanted.shape), np.nan)
        with np.errstate(invalid="ignore"):
            values[:, wanted] = (
                np.log(read.film_offset / film),
                -read.film_compliance * w / read.film_offset,
                np.arcsinh(read.loss_compliance * u[at[1:]] * w / (read.film_offset * width) / LOSS_SCALE),
            )
        held = values.reshape(3, axis.size, -1)
        _go_on(axis, held)
        film_line = OffsetLine.through(axis, held[0], held[1])
        return _Lines(film_line, CubicSpline(axis, held[2]), (float(axis[0]), float(axis[-1])), groups)


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


def columns(lines: PPoly, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and derivatives of lines, each at places of its own.

    Parameters
    ----------
    lines : PPoly
        Polynomials with coefficients (k, n, lines).
    x : ndarray, shape (m, lines)
        Places within the breakpoints.
    """
    cell = np.clip(np.searchsorted(lines.x, x, side="right") - 1, 0, lines.x.size - 2)
    part, which = x - lines.x[cell], np.arange(x.shape[1])
    value, slope = np.zeros_like(x), np.zeros_like(x)
    for coefficient in lines.c:
        slope = slope * part + value
        value = value * part + coefficient[cell, which]
    return value, slope


def table_lines(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    loads: Range,
    speeds: Range,
    temperatures: Range,
    reach: float = 1.0,
) -> xr.Dataset:
    """The group "backbone" of a map, with films and responses read from the film table.

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
    axes = {"zeta": plan.zeta, "reference_speed": plan.speeds, "temperature": plan.temperatures}
    return schema.backbone(
        axes | {schema.NATURAL: NATURAL_FREQUENCIES},
        {**values, "status": status},
        {
            "title": "films of a reference contact, read from the film table",
            schema.REFERENCE_CONTACT: reference_json(plan.contact),
        },
    )
