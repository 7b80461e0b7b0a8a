"""The backbone of a map: films solved where a contact law needs them, in the groups that all contacts share.

At one temperature the film of every contact of a bearing depends on Moes' M and L alone, exactly: the same oil and the
same E' leave no other group. So one reference contact is solved for all of them, over reference speed, temperature and

    zeta = ln(M/M_valley(L)),      M_valley = 2.2/(1 + L/12),

densely around zeta = 0, where damping dives through a valley far narrower than a step of any load axis, sparsely
elsewhere. Load, speed and radius of a real contact lead to (zeta, speed, temperature) of the reference contact; what is
read there is scaled back by the groups.

Between nodes: along zeta the film offset is the integral of its solved slope (the film compliance), tied to its solved
values by a spline that varies slowly, because offsets of neighbouring loads carry independent grid errors, whose
quotient with a small step would drown the slope; cubic spline for the loss; six-point Lagrange in ln(speed) and
temperature at
constant zeta.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import BSpline, CubicSpline, PPoly, make_lsq_spline

from ehdmaps.errors import MapError
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, moes_speed_number

Array = NDArray[np.float64]

VALLEY_STEP, OUTER_STEP = 0.06, 0.3
"""Steps of zeta inside and outside the valley."""

VALLEY = (-1.1, 1.5)
"""zeta of the valley: from where film compliance and loss begin to fall to where they have recovered."""

SPEED_STEP = 0.55
"""Largest step of ln(reference speed)."""

TEMPERATURE_STEP = 12.5
"""Largest step of temperature [K]."""

NEIGHBOURS = 6
"""Lines in each direction that the interpolation between lines uses."""

TIE_NODES = 10
"""Nodes of zeta over which the values of a line are averaged."""

HEAVY = 2.5
"""zeta above which the slope of the film offset comes from its values: steps are long there, and film compliance is so
small a part of the compliance that it is solved less accurately than the offset."""

LOSS_SCALE = 1e-3
"""Loss, as a share of film offset over speed, below which its interpolation turns from logarithmic to linear."""

NAME = "backbone"
GROUP_VARIABLES = ("film_offset", "film_compliance", "loss_compliance")


def valley_load_number(oil_number: Array | float) -> Array | float:
    """Moes' M at the bottom of the damping valley, found over L = 3 to 48 with FVA 3; used as a coordinate only."""
    return 2.2 / (1.0 + oil_number / 12.0)


@dataclass(frozen=True)
class BackboneLine:
    """One line of the backbone: loads of the reference contact at one speed and temperature.

    Attributes
    ----------
    place : tuple of int
        Indices of the first load on the zeta axis, of the speed and of the temperature.
    loads : tuple of float
        [N/m].
    speed, temperature : float
        [m/s], [K].
    """

    place: tuple[int, int, int]
    loads: tuple[float, ...]
    speed: float
    temperature: float


@dataclass(frozen=True)
class BackbonePlan:
    """Axes and lines of a backbone.

    Attributes
    ----------
    contact : LineContact
        The reference contact.
    zeta, speeds, temperatures : tuple of float
        Axes; speeds [m/s] of the reference contact, temperatures [K].
    lines : tuple of BackboneLine
        What has to be solved.
    """

    contact: LineContact
    zeta: tuple[float, ...]
    speeds: tuple[float, ...]
    temperatures: tuple[float, ...]
    lines: tuple[BackboneLine, ...]


def plan_backbone(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    loads: Sequence[float],
    speeds: Sequence[float],
    temperatures: Sequence[float],
) -> BackbonePlan | None:
    """Backbone that covers the axes of a map for all its contacts; None where no speed is positive.

    Parameters
    ----------
    contacts
        Contacts of the map; all of one material.
    loads, speeds, temperatures
        Axes of the map [N/m], [m/s], [K].
    """
    positive = [u for u in speeds if u > 0.0]
    if not positive:
        return None
    reference = replace(contacts[0], name=NAME)
    # the same L needs u/R equal
    ratios = [reference.radius / c.radius for c in contacts]
    speed_axis = _log_axis(min(positive) * min(ratios), max(positive) * max(ratios), SPEED_STEP)
    temperature_axis = _linear_axis(min(temperatures), max(temperatures), TEMPERATURE_STEP)
    span = {
        (j, k): _zeta_span(contacts, lubricant, reference, loads, u, T)
        for j, u in enumerate(speed_axis)
        for k, T in enumerate(temperature_axis)
    }
    zeta = _zeta_axis(min(low for low, _ in span.values()), max(high for _, high in span.values()))
    reach = NEIGHBOURS // 2
    lines = []
    for k, T in enumerate(temperature_axis):
        state = lubricant.at(T)
        for j, u in enumerate(speed_axis):
            # what any line of a stencil needs, this line has to have
            near = [
                span[(p, q)]
                for p in range(max(0, j - reach), min(len(speed_axis), j + reach + 1))
                for q in range(max(0, k - reach), min(len(temperature_axis), k + reach + 1))
            ]
            low, high = min(a for a, _ in near), max(b for _, b in near)
            first = max(int(np.searchsorted(zeta, low)) - 2, 0)
            last = min(int(np.searchsorted(zeta, high)) + 2, len(zeta))
            unit, L = moes_groups(
                1.0,
                u,
                state.viscosity,
                state.pressure_viscosity.pressure_viscosity,
                reference.radius,
                reference.reduced_modulus,
            )
            valley = float(valley_load_number(L))
            lines.append(
                BackboneLine(
                    place=(first, j, k),
                    loads=tuple(float(math.exp(z)) * valley / unit for z in zeta[first:last]),
                    speed=u,
                    temperature=T,
                )
            )
    return BackbonePlan(reference, zeta, speed_axis, temperature_axis, tuple(lines))


def _zeta_span(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    reference: LineContact,
    loads: Sequence[float],
    u: float,
    T: float,
) -> tuple[float, float]:
    """Range of zeta that the loads of a map cover at one reference speed and temperature, over all contacts."""
    state = lubricant.at(T)
    ends = []
    for contact in contacts:
        speed = u * contact.radius / reference.radius
        unit, L = moes_groups(
            1.0,
            speed,
            state.viscosity,
            state.pressure_viscosity.pressure_viscosity,
            contact.radius,
            contact.reduced_modulus,
        )
        valley = float(valley_load_number(L))
        ends += [math.log(w * unit / valley) for w in (min(loads), max(loads))]
    return min(ends), max(ends)


def _log_axis(low: float, high: float, step: float) -> tuple[float, ...]:
    """Log-uniform axis with at most `step` between logs."""
    if high <= low * (1.0 + 1e-12):
        return (low,)
    count = max(NEIGHBOURS, 1 + math.ceil(math.log(high / low) / step))
    return tuple(float(v) for v in np.geomspace(low, high, count))


def _linear_axis(low: float, high: float, step: float) -> tuple[float, ...]:
    """Uniform axis with at most `step` between values."""
    if high <= low:
        return (low,)
    count = max(NEIGHBOURS, 1 + math.ceil((high - low) / step))
    return tuple(float(v) for v in np.linspace(low, high, count))


def _zeta_axis(low: float, high: float) -> tuple[float, ...]:
    """Fine steps in the valley, coarse ones outside."""
    axis = list(np.arange(VALLEY[0], VALLEY[1] + 0.5 * VALLEY_STEP, VALLEY_STEP))
    while axis[0] > low:
        axis.insert(0, axis[0] - min(OUTER_STEP, 1.25 * (axis[1] - axis[0])))
    while axis[-1] < high:
        axis.append(axis[-1] + min(OUTER_STEP, 1.25 * (axis[-1] - axis[-2])))
    return tuple(float(z) for z in axis)


@dataclass(frozen=True)
class _OffsetLine:
    """ln(film offset) along one line: integral of its slope plus a slow tie to its values."""

    steep: CubicSpline
    integral: PPoly
    tie: BSpline

    @classmethod
    def through(cls, zeta: Array, value: Array, slope: Array) -> _OffsetLine:
        """Line through slopes at the nodes, and through values on the average over TIE_NODES of them."""
        heavy = zeta > HEAVY
        if np.any(heavy):
            slope = np.where(heavy, CubicSpline(zeta, value)(zeta, 1), slope)
        steep = CubicSpline(zeta, slope)
        integral = steep.antiderivative()
        inner = zeta[TIE_NODES:-TIE_NODES:TIE_NODES]
        knots = np.concatenate([[zeta[0]] * 4, inner, [zeta[-1]] * 4])
        return cls(steep, integral, make_lsq_spline(zeta, value - integral(zeta), knots, k=3))

    def value(self, zeta: Array) -> Array:
        """ln(film offset)."""
        return np.asarray(self.integral(zeta) + self.tie(zeta))

    def slope(self, zeta: Array) -> Array:
        """Its derivative."""
        return np.asarray(self.steep(zeta) + self.tie(zeta, 1))


class BackboneField:
    """Films of any contact of the map from its backbone; a `FilmField`.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of a map file: film_offset [m], film_compliance [m2/N] and loss_compliance [m2 s/N] of the
        reference contact over (zeta, reference_speed, temperature), NaN where not solved.
    reference : LineContact
        The reference contact.
    contacts, lubricant
        Contacts and oil of the map.
    load_range, speed_range, temperature_range : tuple of float
        Range of the map's axes, for which the backbone was laid [N/m], [m/s], [K].

    Raises
    ------
    MapError
        If a line has too few solved points to be read.
    """

    def __init__(
        self,
        group: xr.Dataset,
        reference: LineContact,
        contacts: Sequence[LineContact],
        lubricant: Lubricant,
        load_range: tuple[float, float],
        speed_range: tuple[float, float],
        temperature_range: tuple[float, float],
    ) -> None:
        self.contacts = tuple(c.name for c in contacts)
        self.load_range = load_range
        self.speed_range = speed_range
        self.temperature_range = temperature_range
        self._contacts = {c.name: c for c in contacts}
        self._lubricant = lubricant
        self._reference = reference
        self._speeds = np.asarray(group["reference_speed"].values, dtype=float)
        self._temperatures = np.asarray(group["temperature"].values, dtype=float)
        zeta = np.asarray(group["zeta"].values, dtype=float)
        offset, compliance, loss = (np.asarray(group[name].values, dtype=float) for name in GROUP_VARIABLES)
        self._lines = {
            (j, k): self._line(zeta, offset[:, j, k], compliance[:, j, k], loss[:, j, k], j, k)
            for j in range(self._speeds.size)
            for k in range(self._temperatures.size)
        }

    def _line(
        self, zeta: Array, offset: Array, compliance: Array, loss: Array, j: int, k: int
    ) -> tuple[_OffsetLine, CubicSpline, float, float]:
        """ln(film offset) and the scaled loss along one line, and the ends of the line."""
        solved = np.isfinite(offset) & np.isfinite(compliance) & np.isfinite(loss) & (offset > 0.0)
        if np.count_nonzero(solved) < NEIGHBOURS:
            raise MapError(
                f"backbone: {np.count_nonzero(solved)} solved points at reference speed {self._speeds[j]:.4g} m/s and "
                f"{self._temperatures[k]:.2f} K; at least {NEIGHBOURS} are needed; generate the map again"
            )
        z, h, s, b = zeta[solved], offset[solved], compliance[solved], loss[solved]
        unit, valley = self._unit(self._reference, self._speeds[j], self._temperatures[k])
        loads = np.exp(z) * valley / unit
        share = b * self._speeds[j] * loads / (h * self._half_width(self._reference, loads))
        return (
            _OffsetLine.through(z, np.log(h), -s * loads / h),
            CubicSpline(z, np.arcsinh(share / LOSS_SCALE)),
            float(z[0]),
            float(z[-1]),
        )

    def _unit(self, contact: LineContact, speed: float, temperature: float) -> tuple[float, float]:
        """Moes' M per N/m and M at the valley."""
        state = self._lubricant.at(temperature)
        unit, L = moes_groups(
            1.0,
            speed,
            state.viscosity,
            state.pressure_viscosity.pressure_viscosity,
            contact.radius,
            contact.reduced_modulus,
        )
        return float(unit), float(valley_load_number(L))

    @staticmethod
    def _half_width(contact: LineContact, loads: Array) -> Array:
        """Hertz half-width [m]."""
        return np.sqrt(8.0 * loads * contact.radius / (math.pi * contact.reduced_modulus))

    def films(self, contact: str, loads: Array, speeds: Array, temperatures: Array) -> tuple[Array, Array, Array]:
        """Film offset [m], film compliance [m2/N] and loss compliance [m2 s/N].

        Parameters
        ----------
        contact : str
            Name of a contact.
        loads : ndarray, shape (n_w, n_u, n_T)
            [N/m].
        speeds, temperatures : ndarray, shapes (n_u,) and (n_T,)
            [m/s], > 0, and [K].
        """
        chosen = self._contacts[contact]
        offset, compliance, loss = np.empty_like(loads), np.empty_like(loads), np.empty_like(loads)
        for m, u in enumerate(speeds):
            for n, T in enumerate(temperatures):
                offset[:, m, n], compliance[:, m, n], loss[:, m, n] = self._at(
                    chosen, loads[:, m, n], float(u), float(T)
                )
        return offset, compliance, loss

    def _at(self, contact: LineContact, loads: Array, speed: float, temperature: float) -> tuple[Array, Array, Array]:
        """Films along loads at one speed and temperature."""
        reference_speed = speed * self._reference.radius / contact.radius
        unit, valley = self._unit(contact, speed, temperature)
        zeta = np.log(loads * unit / valley)
        log_offset, slope, scaled = np.zeros_like(loads), np.zeros_like(loads), np.zeros_like(loads)
        for j, weight_j in _lagrange(np.log(self._speeds), math.log(reference_speed)):
            for k, weight_k in _lagrange(self._temperatures, temperature):
                weight = weight_j * weight_k
                film, damping, low, high = self._lines[(j, k)]
                inside = np.clip(zeta, low, high)
                beyond = zeta - inside
                rate = film.slope(inside)
                # Moes' film number, so that lines of other speeds and temperatures can be mixed
                log_offset += weight * (film.value(inside) + rate * beyond - self._film_scale(j, k))
                slope += weight * rate
                scaled += weight * (damping(inside) + damping(inside, 1) * beyond)
        state = self._lubricant.at(temperature)
        scale = contact.radius * math.sqrt(
            moes_speed_number(speed, state.viscosity, contact.radius, contact.reduced_modulus)
        )
        offset = np.exp(log_offset) * scale
        share = LOSS_SCALE * np.sinh(scaled)
        loss = share * offset * self._half_width(contact, loads) / (speed * loads)
        return offset, -slope * offset / loads, loss

    def _film_scale(self, j: int, k: int) -> float:
        """ln of the length by which Moes' film number of the reference contact is a film."""
        state = self._lubricant.at(float(self._temperatures[k]))
        number = moes_speed_number(
            float(self._speeds[j]), state.viscosity, self._reference.radius, self._reference.reduced_modulus
        )
        return math.log(self._reference.radius * math.sqrt(number))


def _lagrange(nodes: Array, at: float) -> list[tuple[int, float]]:
    """Indices and Lagrange weights of the nodes around `at`."""
    count = min(NEIGHBOURS, nodes.size)
    first = int(np.searchsorted(nodes, at)) - count // 2
    first = min(max(first, 0), nodes.size - count)
    near = nodes[first : first + count]
    weights = [
        float(np.prod([(at - near[q]) / (near[p] - near[q]) for q in range(count) if q != p])) for p in range(count)
    ]
    return [(first + p, w) for p, w in enumerate(weights)]
