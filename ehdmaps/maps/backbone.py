"""The backbone of a map: films solved where a contact law needs them, in the groups that all contacts share.

At one temperature the film of every contact of a bearing depends on Moes' M and L alone, exactly: the same oil and the
same E' leave no other group. So one reference contact is solved for all of them, over reference speed, temperature and

    zeta = ln(M/M_valley(L)),

densely around zeta = 0, where damping dives through a valley far narrower than a step of any load axis, sparsely
elsewhere. Load, speed and radius of a real contact lead to (zeta, speed, temperature) of the reference contact; what is
read there is scaled back by the groups.

Between nodes: along zeta the film offset is the integral of its solved slope (the film compliance), bent outside the
valley to meet its solved values on the average. Offsets of neighbouring loads carry independent grid errors; their
quotient with a small step would drown the slope, which is nearly zero at the bottom of the valley. Cubic spline for the
loss; six-point Lagrange in ln(speed) and temperature at constant zeta.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator, PPoly

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from ehdmaps.errors import MapError
from ehdmaps.maps import schema
from ehdmaps.maps.backbone_plan import NEIGHBOURS, VALLEY, Axis
from ehdmaps.maps.film_field import first_loads, known_from, lifted_loss
from ehdmaps.maps.kernels.ends import one_end
from ehdmaps.maps.kernels.locked_film import MOST, film_of, fitted_factors, response_error
from ehdmaps.maps.kernels.splines import mix_lines
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant, LubricantState
from ehdmaps.physics.moes import moes_groups, moes_speed_number, valley_load_number

HEAVY = 2.5
"""zeta above which the slope of the film offset comes from its values: steps are long there, and film compliance is so
small a part of the compliance that it is solved less accurately than the offset."""

FEWEST_NODES = 8
"""Solved points that a line needs at least."""

LOSS_SCALE = 6e-2
"""Loss, as a share of film offset over speed, below which its interpolation turns from logarithmic to linear: at the
valley it runs through zero, where a logarithm has no slope to follow."""

LATTICE_STEP = 0.02
"""Step of zeta to which lines are refined for reading."""

_FEWER = 4
"""Lines in each direction, to tell what an interpolation is worth."""

FILMS = ("film_offset", "film_compliance", "loss_compliance")
"""Variables of the group that a law is made from."""

REAL, IMAGINARY, ERROR = "film_compliance_real", "film_compliance_imaginary", "film_compliance_error"
"""Variables with the response of the films, where a map has them."""


@dataclass(frozen=True)
class OffsetLine:
    """ln(film offset) along a line or several: integral of its slope, bent outside the valley to meet its values.

    Attributes
    ----------
    steep, integral : CubicSpline, PPoly
        Slope over zeta and its integral; of several lines with values (n, lines).
    bend : ndarray, shape (5,) or (5, lines)
        What is added, see `bent`.
    """

    steep: CubicSpline
    integral: PPoly
    bend: FloatArray

    @classmethod
    def through(cls, zeta: FloatArray, value: FloatArray, slope: FloatArray) -> OffsetLine:
        """Line through the slopes at the nodes, exactly in the valley, and through the values on the average.

        Parameters
        ----------
        zeta : ndarray, shape (n,)
            Nodes of the lines.
        value, slope : ndarray, shape (n,) or (n, lines)
            ln(film offset) and its derivative there.
        """
        heavy = zeta > HEAVY
        if np.any(heavy):
            by_values = CubicSpline(zeta, value)(zeta, 1)
            slope = np.where(heavy.reshape(-1, *(1,) * (slope.ndim - 1)), by_values, slope)
        steep = CubicSpline(zeta, slope)
        integral = steep.antiderivative()
        bend, *_ = np.linalg.lstsq(np.column_stack(_bends(zeta, 0)), value - integral(zeta), rcond=None)
        return cls(steep, integral, bend)

    def bent(self, zeta: FloatArray, order: int) -> FloatArray:
        """Term added to the integral or its derivatives of an order at places (n,), of several lines (n, lines)."""
        return np.asarray(sum(column * part for column, part in zip(_bends(zeta, order), self.bend, strict=True)))

    def value(self, zeta: FloatArray) -> FloatArray:
        """Value of ln(film offset) of one line at places (n,)."""
        return np.asarray(self.integral(zeta) + self.bent(zeta, 0))

    def slope(self, zeta: FloatArray) -> FloatArray:
        """Its derivative."""
        return np.asarray(self.steep(zeta) + self.bent(zeta, 1))

    def curvature(self, zeta: FloatArray) -> FloatArray:
        """Its second derivative."""
        return np.asarray(self.steep(zeta, 1) + self.bent(zeta, 2))


def _bends(zeta: FloatArray, order: int) -> list[FloatArray]:
    """Derivatives of a constant, and of a square and a cube on either side of the valley."""
    columns = [np.full_like(zeta, float(order == 0))]
    for away in (np.minimum(zeta - VALLEY[0], 0.0), np.maximum(zeta - VALLEY[1], 0.0)):
        if order == 0:
            columns += [away**2, away * away**2]  # numpy's cube takes ten times as long
        elif order == 1:
            columns += [2.0 * away, 3.0 * away**2]
        else:
            columns += [2.0 * (away != 0.0), 6.0 * away]
    return columns


class _Responses(NamedTuple):
    """Film compliances of the reference contact at natural frequencies.

    `natural` are these, shape (k,); `compliance` is complex [m2/N] and `errors` relative to its magnitude, both of
    shape (zeta, reference_speed, temperature, k).
    """

    natural: FloatArray
    compliance: ComplexArray
    errors: FloatArray

    @classmethod
    def of(cls, group: Mapping[Any, Any]) -> _Responses | None:
        """Those of a group; None where it has none."""
        if schema.NATURAL not in group:
            return None
        names = (schema.NATURAL, REAL, IMAGINARY, ERROR)
        natural, real, imaginary, errors = (np.asarray(group[name], dtype=float) for name in names)
        return cls(natural, real + 1j * imaginary, errors)


class BackboneField:
    """Films of any contact of the map from its backbone; a `FilmField`.

    The loss compliance is kept positive, see `lifted_loss`.

    Parameters
    ----------
    group : mapping of str to array
        Group "backbone" of a map file, or arrays by the names of its variables: film_offset [m], film_compliance
        [m2/N] and loss_compliance [m2 s/N] of the reference contact over (zeta, reference_speed, temperature), NaN
        where not solved.
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
        group: Mapping[Any, Any],
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
        self.dry = False
        self._contacts = {c.name: c for c in contacts}
        self._lubricant = lubricant
        self._states: dict[float, LubricantState] = {}
        self._reference = reference
        self._solids = replace(contacts[0], radius=reference.radius)
        self._log_speeds = np.log(np.asarray(group["reference_speed"], dtype=float))
        self._temperatures = np.asarray(group["temperature"], dtype=float)
        zeta = np.asarray(group["zeta"], dtype=float)
        self._first = float(zeta[0])
        nodes = 2 + math.ceil((zeta[-1] - zeta[0]) / LATTICE_STEP)
        offset, compliance, loss = (np.asarray(group[name], dtype=float) for name in FILMS)
        self._responses = _Responses.of(group)
        self._zeta, self._films = zeta, (offset, compliance, loss)
        self._start = known_from(zeta, np.isfinite(offset) & np.isfinite(compliance) & np.isfinite(loss))
        self._nodes = nodes
        self._check_lines()
        self._lattice = self._lines(slice(None))

    def _lines(self, which: slice) -> FloatArray:
        """All lines on the common lattice, through some of their points, (lines, nodes, 5)."""
        return np.array(
            [self._line(which, j, k) for j in range(self._log_speeds.size) for k in range(self._temperatures.size)]
        )

    def _check_lines(self) -> None:
        """Refuse lines that cannot be read."""
        offset, compliance, loss = self._films
        solved = np.isfinite(offset) & np.isfinite(compliance) & np.isfinite(loss) & (offset > 0.0)
        counts = np.count_nonzero(solved, axis=0)
        for j, k in np.argwhere(counts < FEWEST_NODES)[:1]:
            raise MapError(
                f"backbone: {counts[j, k]} solved points at reference speed {math.exp(self._log_speeds[j]):.4g} m/s "
                f"and {self._temperatures[k]:.2f} K; at least {FEWEST_NODES} are needed; generate the map again"
            )

    @cached_property
    def _coarse_lattice(self) -> FloatArray:
        """Lines through every second one of their points."""
        return self._lines(slice(None, None, 2))

    def _line(self, which: slice, j: int, k: int) -> FloatArray:
        """One line on the common lattice, shape (nodes, 5), linear beyond the line's own ends."""
        zeta, (offset, compliance, loss) = self._zeta[which], (values[which, j, k] for values in self._films)
        speed, temperature = math.exp(self._log_speeds[j]), float(self._temperatures[k])
        solved = np.isfinite(offset) & np.isfinite(compliance) & np.isfinite(loss) & (offset > 0.0)
        z, h, s, b = zeta[solved], offset[solved], compliance[solved], loss[solved]
        unit, valley, scale = self._scales(self._reference, speed, temperature)
        loads = np.exp(z) * valley / unit
        share = b * speed * loads / (h * half_width(loads, self._reference.radius, self._reference.reduced_modulus))
        film = OffsetLine.through(z, np.log(h / scale), -s * loads / h)
        damping = CubicSpline(z, np.arcsinh(share / LOSS_SCALE))
        places = self._first + LATTICE_STEP * np.arange(self._nodes)
        inside = np.clip(places, z[0], z[-1])
        beyond = places - inside
        within = (beyond == 0.0).astype(float)
        slope, damping_slope = film.slope(inside), damping(inside, 1)
        return np.column_stack(
            [
                film.value(inside) + slope * beyond,
                slope,
                film.curvature(inside) * within,
                damping(inside) + damping_slope * beyond,
                damping_slope,
            ]
        )

    def _scales(self, contact: LineContact, speed: float, temperature: float) -> tuple[float, float, float]:
        """Moes' M per N/m, M at the valley, and the film whose Moes number is one [m]."""
        state = self._states.get(temperature)
        if state is None:
            state = self._states[temperature] = self._lubricant.at(temperature)
        radius, modulus = contact.radius, contact.reduced_modulus
        alpha = state.pressure_viscosity.pressure_viscosity
        unit, L = moes_groups(1.0, speed, state.viscosity, alpha, radius, modulus)
        film = radius * math.sqrt(moes_speed_number(speed, state.viscosity, radius, modulus))
        return float(unit), float(valley_load_number(L)), film

    def films(
        self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
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
        results = np.empty((3, *loads.shape))
        by_speed = [lagrange(self._log_speeds, math.log(u * self._reference.radius / chosen.radius)) for u in speeds]
        by_temperature = [lagrange(self._temperatures, float(T)) for T in temperatures]
        for n, T in enumerate(temperatures):
            columns, column_weights = by_temperature[n]
            for m, u in enumerate(speeds):
                rows, row_weights = by_speed[m]
                lines = (rows[:, None] * self._temperatures.size + columns).ravel()
                weights = np.outer(row_weights, column_weights).ravel()
                results[:, :, m, n] = self._at(chosen, loads[:, m, n], float(u), float(T), lines, weights)
        return results[0], results[1], results[2]

    def changes(self, contact: str, load: float, speed: float, temperature: float) -> dict[Axis, float]:
        """Relative changes of the loss if it is read from fewer points along an axis.

        From four lines instead of six along speed and temperature, from every second point along the loads.

        Parameters
        ----------
        contact : str
            Name of a contact.
        load, speed, temperature : float
            [N/m], [m/s] and [K].
        """
        chosen = self._contacts[contact]
        at = math.log(speed * self._reference.radius / chosen.radius)

        def loss(by_speed: int = NEIGHBOURS, by_temperature: int = NEIGHBOURS, coarse: bool = False) -> float:
            rows, row_weights = lagrange(self._log_speeds, at, by_speed)
            columns, column_weights = lagrange(self._temperatures, temperature, by_temperature)
            lines = (rows[:, None] * self._temperatures.size + columns).ravel()
            weights = np.outer(row_weights, column_weights).ravel()
            lattice = self._coarse_lattice if coarse else self._lattice
            return float(self._at(chosen, np.array([load]), speed, temperature, lines, weights, lattice)[2, 0])

        full = loss()
        fewer: dict[Axis, float] = {
            "load": loss(coarse=True),
            "entrainment_speed": loss(by_speed=_FEWER),
            "temperature": loss(by_temperature=_FEWER),
        }
        return {axis: abs(value / full - 1.0) for axis, value in fewer.items()}

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Loads from which on the backbone is read [N/m], (n_u, n_T); see `FilmField.first_loads`.

        Parameters
        ----------
        speeds, temperatures : array (n_u,), (n_T,)
            [m/s], > 0, and [K].
        """
        contacts = list(self._contacts.values())
        return first_loads(contacts, self._lubricant, self.load_range[0], self._start, speeds, temperatures)

    @property
    def ends(self) -> FloatArray:
        """The highest load everywhere; see `FilmField.ends`."""
        return one_end(self.load_range[1])

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> FloatArray | None:
        """Factors of the closed formula of the locked film; see `FilmField.locked_factors`."""
        if self._responses is None:
            return None
        mixed = self._read(self._log_factors[..., None], self._contacts[contact], loads, speed, temperature)[:, 0]
        return np.asarray(np.exp(np.clip(mixed, -math.log(MOST), math.log(MOST))))

    def film_differences(
        self, contact: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, ComplexArray] | None:
        """Part that films with memory leave out at natural frequencies; see `FilmField.film_differences`."""
        if self._responses is None:
            return None
        natural, chosen = self._responses.natural, self._contacts[contact]
        mixed = self._read(self._differences, chosen, loads, speed, temperature)
        return natural, np.asarray(mixed[:, : natural.size] + 1j * mixed[:, natural.size :])

    def _read(
        self, lattice: FloatArray, contact: LineContact, loads: FloatArray, speed: float, temperature: float
    ) -> FloatArray:
        """Values on the common lattice (lines, nodes, m) at loads (n,) of a contact, shape (n, m)."""
        lines, weights = self.stencil(contact, speed, temperature)
        last = lattice.shape[1] - 1
        place = np.clip((self.zeta(contact, loads, speed, temperature) - self._first) / LATTICE_STEP, 0.0, last)
        cell = np.minimum(place.astype(np.int64), last - 1)
        near, part = lattice[lines], (place - cell)[:, None]
        return np.asarray(np.tensordot(weights, near[:, cell] + part * (near[:, cell + 1] - near[:, cell]), axes=1))

    @cached_property
    def _log_factors(self) -> FloatArray:
        """Logarithms of the factors of each line on the common lattice, (lines, nodes); held beyond the line's ends."""
        return self._on_lattice([(zeta, logs[:, None]) for zeta, logs, _ in self._fits])[..., 0]

    @cached_property
    def _differences(self) -> FloatArray:
        """Real and imaginary parts of what the law leaves out on the common lattice, (lines, nodes, 2 k)."""
        return self._on_lattice([(zeta, np.hstack([apart.real, apart.imag])) for zeta, _, apart in self._fits])

    def _on_lattice(self, lines: list[tuple[FloatArray, FloatArray]]) -> FloatArray:
        """Values (n, m) at places (n,) of each line, on the common lattice."""
        places = self._first + LATTICE_STEP * np.arange(self._lattice.shape[1])
        found = []
        for zeta, values in lines:
            inside = np.clip(places, zeta[0], zeta[-1])
            found.append(
                PchipInterpolator(zeta, values)(inside) if zeta.size > 1 else values[np.zeros(inside.size, int)]
            )
        return np.array(found)

    @cached_property
    def _fits(self) -> list[tuple[FloatArray, FloatArray, ComplexArray]]:
        """Results of `_fitted` for each line."""
        return [
            self._fitted(j, k, math.exp(log_speed), float(temperature))
            for j, log_speed in enumerate(self._log_speeds)
            for k, temperature in enumerate(self._temperatures)
        ]

    def _fitted(self, j: int, k: int, speed: float, temperature: float) -> tuple[FloatArray, FloatArray, ComplexArray]:
        """Places zeta of a line whose response is known, logarithms of the factors there, and what the law leaves out.

        Shapes (n,), (n,) and (n, natural frequencies); zero at one place where no response is known.
        """
        assert self._responses is not None
        offset, compliance, loss = (values[:, j, k] for values in self._films)
        response, errors = self._responses.compliance[:, j, k], self._responses.errors[:, j, k]
        known = np.isfinite(offset + compliance + loss) & (offset > 0.0) & np.all(np.isfinite(response), axis=1)
        if not np.any(known):
            return np.zeros(1), np.zeros(1), np.zeros((1, response.shape[1]), dtype=np.complex128)
        unit, valley, _ = self._scales(self._reference, speed, temperature)
        loads = np.exp(self._zeta) * valley / unit
        # the backbone reaches beyond the loads of the map, where a structural law need not hold
        solids = self._solids.structural_compliance(np.minimum(loads, self.load_range[1]))
        width = half_width(loads, self._reference.radius, self._reference.reduced_modulus)
        lifted = lifted_loss(loss, width, speed, solids + compliance)
        error = response_error(solids, response, errors)
        film, natural = film_of((self._reference,), speed), self._responses.natural
        factors, apart = fitted_factors(
            film, loads[known], offset[known], solids[known], compliance[known], lifted[known], natural,
            response[known], error[known],
        )  # fmt: skip
        return self._zeta[known], np.log(factors), apart

    def _at(
        self,
        contact: LineContact,
        loads: FloatArray,
        speed: float,
        temperature: float,
        lines: IntArray,
        weights: FloatArray,
        lattice: FloatArray | None = None,
    ) -> FloatArray:
        """Films along loads at one speed and temperature with their loss lifted, shape (3, n)."""
        unit, valley, scale = self._scales(contact, speed, temperature)
        mixed = np.empty((3, loads.size))
        zeta = np.log(loads * unit / valley)
        mix_lines(self._lattice if lattice is None else lattice, self._first, LATTICE_STEP, lines, weights, zeta, mixed)
        offset = scale * np.exp(mixed[0])
        compliance = -mixed[1] * offset / loads
        width = half_width(loads, contact.radius, contact.reduced_modulus)
        loss = LOSS_SCALE * np.sinh(mixed[2]) * offset / loads * width / speed
        total = contact.structural_compliance(loads) + compliance
        return np.stack([offset, compliance, lifted_loss(loss, width, speed, total)])

    def stencil(self, contact: LineContact, speed: float, temperature: float) -> tuple[IntArray, FloatArray]:
        """Lines that a contact is read from at one speed and temperature, and their weights; both of shape (m,).

        Parameters
        ----------
        contact : LineContact
            The contact.
        speed, temperature : float
            [m/s], > 0, and [K].
        """
        rows, row_weights = lagrange(self._log_speeds, math.log(speed * self._reference.radius / contact.radius))
        columns, column_weights = lagrange(self._temperatures, temperature)
        lines = (rows[:, None] * self._temperatures.size + columns).ravel()
        return lines, np.outer(row_weights, column_weights).ravel()

    def zeta(self, contact: LineContact, loads: FloatArray, speed: float, temperature: float) -> FloatArray:
        """ln(M/M_valley) of a contact at loads [N/m], shape (n,), at one speed [m/s] and temperature [K].

        Parameters
        ----------
        contact : LineContact
            The contact.
        loads : ndarray, shape (n,)
            [N/m].
        speed, temperature : float
            [m/s], > 0, and [K].
        """
        unit, valley, _ = self._scales(contact, speed, temperature)
        return np.log(loads * unit / valley)


def lagrange(nodes: FloatArray, at: float, most: int = NEIGHBOURS) -> tuple[IntArray, FloatArray]:
    """Indices and Lagrange weights of the nodes around `at`; linear through the end nodes beyond them.

    Parameters
    ----------
    nodes : array (n,)
        Places of the nodes, rising.
    at : float
        Place that is read.
    most : int
        Largest number of nodes.
    """
    count = min(most, nodes.size)
    if not nodes[0] <= at <= nodes[-1]:
        count = min(2, nodes.size)
    first = int(np.searchsorted(nodes, at)) - count // 2
    first = min(max(first, 0), nodes.size - count)
    near = nodes[first : first + count]
    weights = [np.prod([(at - near[q]) / (near[p] - near[q]) for q in range(count) if q != p]) for p in range(count)]
    return first + np.arange(count), np.array(weights, dtype=float)
