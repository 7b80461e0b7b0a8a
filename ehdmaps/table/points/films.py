"""Films of point contacts in SI, read from the table: each point with a status, and numbers with errors or none.

The family: flooded, smooth, isothermal films of pure rolling along the short axis of the ellipse, of an oil whose
density goes after Dowson and Higginson; with heat in the inlet by its rule, where that is asked for. Stiffness is that
of the dry contact and the slope of the film offset, 1/k = 1/k_dry - dh/dF; loss compliance is c/k^2.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.physics.closed_form import THICK_NOTE, THICKEST_FILM, THIN_FILM_LIMIT
from ehdmaps.physics.hertz import LARGEST_PRESSURE
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import WIDEST, Ellipse
from ehdmaps.physics.solution import Status
from ehdmaps.table.coordinates import bend_of
from ehdmaps.table.fields import NATURAL_FREQUENCIES
from ehdmaps.table.oils import BESIDE, exponent_at, matched_pressure, oil_states
from ehdmaps.table.points.nodes import (
    ERRORS,
    FIELDS,
    FILMS,
    RESPONSES,
    SLOPE,
    PointNodes,
    PointUnits,
    point_load_number,
    point_units,
    point_zeta,
)

LIGHTEST = -14.0
"""zeta of the lightest load: a millionth of that of the first node."""

_SLACK = 1e-9
_FAR_FROM_KNEE = np.inf

CAUSES = (
    "",
    THICK_NOTE,
    "table of points: heavier than what was solved; numbers go on from lighter loads, and errors grow",
    "no entrainment: dry contact",
    "no load: the bodies do not meet, no film to read",
    "table of points: the oil has no state at this temperature",
    "table of points: has no oil of constant density; solve these films",
    "table of points: groups M and L are not finite: load, speed or viscosity is absurd",
    f"table of points: Hertz pressure above {LARGEST_PRESSURE / 1e9:g} GPa",
    "table of points: ellipticity outside of its nodes; solve these films",
    "table of points: L outside of its nodes; solve these films",
    "table of points: pressure-viscosity coefficient, or its change over pressure, as none of its oils has",
    "table of points: beyond its highest loads; the contact tends to that of Hertz",
    "table of points: below its lowest loads",
    "table of points: a node beside it has no solution; solve this film",
    f"film thicker than {THICKEST_FILM:g} of the radius: neither thin-film theory nor a parabolic gap holds",
    f"film wider than {WIDEST:g} of the ball's radius: the gap between ball and groove is no paraboloid",
)
"""Causes of a status in words, by their number; empty for a plain film."""

_NONE, _THICK, _CONTINUED, _DRY, _NO_LOAD, _NO_STATE, _LAW, _ABSURD, _PRESSURE = range(9)
_KAPPA, _L, _OIL, _HEAVY, _LIGHT, _HOLE, _TOO_THICK, _TOO_WIDE = range(9, len(CAUSES))

NUMBERS = (
    *("approach", "film_offset", "stiffness", "damping", "film_compliance", "loss_compliance"),
    *("central_film", "minimum_film", "max_pressure"),
)
"""Numbers of a film, each with an error."""


@dataclass(frozen=True, eq=False)
class PointFilms:
    """Films of points, arrays of the shape of the points; NaN where the status is not usable.

    Attributes
    ----------
    status : ndarray of int8
        Values of `Status`.
    cause : ndarray of int8
        Why, as a number; `reason` has it in words.
    load_number, oil_number : ndarray
        Moes' M and L.
    approach, film_offset : ndarray
        Approach of the bodies, and dry less lubricated approach [m].
    stiffness, damping : ndarray
        k [N/m] and c [N s/m], in the limit of slow motion.
    film_compliance, loss_compliance : ndarray
        1/k - 1/k_dry [m/N] and c/k^2 [m s/N].
    central_film, minimum_film, max_pressure : ndarray
        [m], [m], [Pa].
    frequencies, response_stiffness, response_damping : ndarray, shape (..., 5)
        Natural frequencies of the points, [Hz], and k [N/m] and c [N s/m] there.
    errors : mapping of str to ndarray
        Relative errors by the names of `NUMBERS`; "response_stiffness" and "response_damping", shape (..., 5).
    viscosity_extrapolated : ndarray of bool
        The pressure left the range in which the viscosity law was fitted.
    """

    status: npt.NDArray[np.int8]
    cause: npt.NDArray[np.int8]
    load_number: FloatArray
    oil_number: FloatArray
    approach: FloatArray
    film_offset: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    film_compliance: FloatArray
    loss_compliance: FloatArray
    central_film: FloatArray
    minimum_film: FloatArray
    max_pressure: FloatArray
    frequencies: FloatArray
    response_stiffness: FloatArray
    response_damping: FloatArray
    errors: Mapping[str, FloatArray]
    viscosity_extrapolated: BoolArray

    @property
    def usable(self) -> BoolArray:
        """True where there are films."""
        return np.asarray(self.status <= int(Status.ASYMPTOTE))

    @property
    def reason(self) -> npt.NDArray[np.str_]:
        """Cause of the status in words; empty for a plain film."""
        return np.array(CAUSES)[self.cause]


@dataclass(frozen=True, eq=False)
class PointTable:
    """The table of films of point contacts.

    Attributes
    ----------
    nodes : PointNodes
        Values and errors.
    attributes : mapping of str to str
        Provenance, by name.
    """

    nodes: PointNodes
    attributes: Mapping[str, str]

    def films(
        self,
        ellipse: Ellipse,
        lubricant: Lubricant,
        load: npt.ArrayLike,
        entrainment_speed: npt.ArrayLike,
        temperature: npt.ArrayLike,
        inlet_heat: bool = False,
    ) -> PointFilms:
        """Films at points.

        Parameters
        ----------
        ellipse : Ellipse
            Radii and elastic modulus of the contact.
        lubricant : Lubricant
            The oil.
        load, entrainment_speed, temperature : float or ndarray
            F [N] >= 0, u [m/s] >= 0 and T [K] > 0; they are broadcast. Other numbers have a status that says so.
        inlet_heat : bool
            Whether heat in the inlet thins them, by its rule (`ehdmaps.physics.point.inlet_heat`), whose errors are
            added; status, M and L are those of the isothermal film.

        Raises
        ------
        InputError
            For heat of an oil whose conductivity is not known.
        """
        given = (np.asarray(x, dtype=float) for x in (load, entrainment_speed, temperature))
        F, u, T = (x.ravel() for x in np.broadcast_arrays(*given))
        unique, index = np.unique(T, return_inverse=True)
        oil = oil_states(lubricant, unique)
        viscosity, alpha = oil.viscosity[index], oil.alpha[index]
        kappa = np.full(F.shape, ellipse.ellipticity)
        with np.errstate(all="ignore"):
            unit = point_units(ellipse, F, u, viscosity)
            number = np.square(unit.film / ellipse.rolling_radius)
            M = F / (ellipse.reduced_modulus * ellipse.rolling_radius**2) * number**-0.75
            L = alpha * ellipse.reduced_modulus * np.sqrt(np.sqrt(number))
            zeta = point_zeta(M, L, kappa)
            matched = matched_pressure(np.full(F.shape, _FAR_FROM_KNEE), L)
            exponents = oil.exponents[index]
            own = np.all(exponents == exponents[:, :1], axis=1)
            exponent, beside = (
                np.where(own, exponents[:, 0], exponent_at(exponents, factor * matched)) for factor in (1.0, BESIDE)
            )
            bend, other = (bend_of(alpha, z) for z in (exponent, beside))
        cause = self._refused(ellipse, oil.compressible, (F, u, alpha, bend), (M, L, zeta), unit)
        good = np.flatnonzero(cause == _NONE)
        found, hole, continued = self._numbers(ellipse, F[good], u[good], PointUnits(*(x[good] for x in unit)), (
            zeta[good], np.log(L[good]), np.log(kappa[good]), np.log(alpha[good]), bend[good], other[good],
        ))  # fmt: skip
        thickness = found["film_offset"] / ellipse.rolling_radius
        tests = (
            (hole, _HOLE), (thickness > THICKEST_FILM, _TOO_THICK),
            (found["film_offset"] > ellipse.widest_film, _TOO_WIDE), (thickness > THIN_FILM_LIMIT, _THICK),
            (continued, _CONTINUED),
        )  # fmt: skip
        cause[good] = np.select([test for test, _ in tests], [code for _, code in tests], _NONE)
        status = np.where(cause > _DRY, int(Status.OUTSIDE_VALIDITY), int(Status.CONVERGED)).astype(np.int8)
        status[(cause > _NONE) & (cause <= _DRY)] = int(Status.ASYMPTOTE)
        if inlet_heat:
            from ehdmaps.physics.point.inlet_heat import point_heats  # with what only heat needs
            from ehdmaps.table.points.heat import heated_films

            heat = point_heats(ellipse, lubricant, F[good], u[good], T[good])
            found |= heated_films(found, heat, np.asarray(ellipse.stiffness(F[good])))
        count, whole = len(NATURAL_FREQUENCIES), {}
        for name, values in found.items():
            place = np.full((F.size, *values.shape[1:]), np.nan)
            place[good] = values
            place[cause > _DRY] = np.nan
            place[cause == _DRY] = 0.0
            whole[name] = place
        dry = cause == _DRY
        whole["approach"][dry] = ellipse.approach(F[dry])
        whole["max_pressure"][dry] = unit.pressure[dry]
        whole["stiffness"][dry] = ellipse.stiffness(F[dry])
        whole["response_stiffness"][dry] = np.repeat(whole["stiffness"][dry][:, None], count, axis=1)
        whole["frequencies"][dry] = np.nan
        shape = np.broadcast_shapes(*(np.shape(x) for x in (load, entrainment_speed, temperature)))

        def shaped(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
            return values.reshape(shape + values.shape[1:])

        errors = {name[:-6]: shaped(whole.pop(name)) for name in list(whole) if name.endswith("_error")}
        with np.errstate(invalid="ignore"):
            extrapolated = np.fmax(whole["max_pressure"], unit.pressure) > oil.fitted_pressure
        return PointFilms(
            status=shaped(status),
            cause=shaped(cause),
            load_number=shaped(np.where(u > 0.0, M, np.nan)),
            oil_number=shaped(np.where(u > 0.0, L, np.nan)),
            errors=errors,
            viscosity_extrapolated=shaped((cause <= _DRY) & extrapolated),
            **{name: shaped(values) for name, values in whole.items()},
        )

    def _refused(
        self,
        ellipse: Ellipse,
        compressible: bool,
        point: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
        groups: tuple[FloatArray, FloatArray, FloatArray],
        unit: PointUnits,
    ) -> npt.NDArray[np.int8]:
        """Find why there is no film at points, before it is read."""
        axes = self.nodes.axes
        (F, u, alpha, bend), (M, L, zeta) = point, groups
        with np.errstate(all="ignore"):
            absurd = ~((F >= 0.0) & (u >= 0.0) & np.isfinite(F) & np.isfinite(u))
            kappa = np.full(F.shape, np.log(ellipse.ellipticity))
            oil = _within(np.log(alpha), axes.alpha) & _within(bend, axes.bend)
            tests = (
                (absurd, _ABSURD),
                (F == 0.0, _NO_LOAD),
                (u == 0.0, _DRY),
                (np.isnan(alpha), _NO_STATE),
                (np.full(F.shape, not compressible), _LAW),
                (~(np.isfinite(M) & np.isfinite(L) & (M > 0.0)), _ABSURD),
                (unit.pressure > LARGEST_PRESSURE, _PRESSURE),
                (~_within(kappa, axes.shape), _KAPPA),
                (~oil, _OIL),
                (~_within(np.log(L), axes.size), _L),
                (zeta > axes.zeta[-1] + _SLACK, _HEAVY),
                (zeta < LIGHTEST, _LIGHT),
            )
        return np.select([test for test, _ in tests], [code for _, code in tests], _NONE).astype(np.int8)

    def _numbers(
        self, ellipse: Ellipse, load: FloatArray, speed: FloatArray, unit: PointUnits, place: tuple[FloatArray, ...]
    ) -> tuple[dict[str, FloatArray], BoolArray, BoolArray]:
        """Numbers of points that are read with their errors, which of them are holes, and which are continued."""
        *along, bend, other = place
        zeta, size, shape, alpha = along
        here = self.nodes.place(zeta, size, shape, (alpha, bend))
        logs, slopes = self.nodes.read(here)
        moved = logs
        errors, hole = self.nodes.errors(here)
        mapped = bool(np.any(other != bend))
        if mapped:
            beside = self.nodes.place(zeta, size, shape, (alpha, other))
            moved, moved_slopes = self.nodes.read(beside)
        values = np.exp(logs)
        offset = values[:, 0] * unit.film
        slope = slopes[:, 0] * offset / load
        dry = np.asarray(1.0 / ellipse.stiffness(load))
        compliance = dry - slope
        wrong = {name: errors[:, k].copy() for k, name in enumerate(ERRORS)}
        for k, field in enumerate(FILMS):
            wrong[field.name] += np.abs(moved[:, k] - logs[:, k])
        if mapped:
            wrong[SLOPE] += np.abs(moved_slopes[:, 0] - slopes[:, 0]) * offset / load / compliance
        stiffness, damping = 1.0 / compliance, values[:, 1] * unit.damping
        approach = np.asarray(ellipse.approach(load)) - offset
        # both films are cubics between nodes: no film is smallest above the central one
        central, smallest = values[:, 2], values[:, 3]
        wrong["minimum_film"] = np.where(
            smallest > central, np.maximum(wrong["minimum_film"], wrong["central_film"]), wrong["minimum_film"]
        )
        found = {
            "approach": approach,
            "film_offset": offset,
            "stiffness": stiffness,
            "damping": damping,
            "film_compliance": -slope,
            "loss_compliance": damping / stiffness**2,
            "central_film": central * unit.film,
            "minimum_film": np.minimum(smallest, central) * unit.film,
            "max_pressure": values[:, 4] * unit.pressure,
        }
        with np.errstate(divide="ignore"):
            wrong |= {
                "approach": wrong["film_offset"] * offset / np.abs(approach),
                "film_compliance": wrong[SLOPE] * compliance / np.abs(slope),
                "loss_compliance": wrong["damping"] + 2.0 * wrong[SLOPE],
            }
        found |= {f"{name}_error": wrong[name] for name in NUMBERS}
        dynamic, _ = self.nodes.read(here, RESPONSES)
        first = len(FILMS)
        a = np.asarray(ellipse.semi_axes(load)[0])
        width = np.sqrt(np.square(a) + 2.0 * offset * ellipse.rolling_radius)
        turning = np.array(NATURAL_FREQUENCIES) / (2.0 * np.pi) * (speed / width)[:, None]
        found |= {
            "frequencies": turning,
            "response_stiffness": np.exp(dynamic[:, 0::2]) * unit.stiffness[:, None],
            "response_damping": dynamic[:, 1::2] * damping[:, None],
            "response_stiffness_error": errors[:, first : len(FIELDS) : 2],
            "response_damping_error": errors[:, first + 1 : len(FIELDS) : 2] / np.abs(dynamic[:, 1::2])
            + wrong["damping"][:, None],
        }
        return found, hole, np.asarray(self.nodes.continued.ravel()[here.cell])

    def loads(self, ellipse: Ellipse, lubricant: Lubricant, entrainment_speed: float, temperature: float) -> FloatArray:
        """Loads of the nodes along zeta at a speed and a temperature [N]: between them a cubic is what the table reads.

        Parameters
        ----------
        ellipse : Ellipse
            The contact.
        lubricant : Lubricant
            The oil.
        entrainment_speed, temperature : float
            u [m/s] > 0, T [K].
        """
        state = lubricant.at(temperature)
        modulus, radius = ellipse.reduced_modulus, ellipse.rolling_radius
        number = 2.0 * state.viscosity * entrainment_speed / (modulus * radius)
        L = state.pressure_viscosity.pressure_viscosity * modulus * number**0.25
        M = point_load_number(self.nodes.axes.zeta, np.asarray(L), np.asarray(ellipse.ellipticity))
        return np.asarray(M * modulus * radius**2 * number**0.75)

    def slowest(self, ellipse: Ellipse, lubricant: Lubricant, temperature: float) -> float:
        """Lowest entrainment speed that has films [m/s], at the smallest L of the nodes.

        Parameters
        ----------
        ellipse : Ellipse
            The contact.
        lubricant : Lubricant
            The oil.
        temperature : float
            T [K].
        """
        state = lubricant.at(temperature)
        modulus, radius = ellipse.reduced_modulus, ellipse.rolling_radius
        per_speed = state.pressure_viscosity.pressure_viscosity * modulus
        if not per_speed > 0.0:
            return math.inf
        number = (math.exp(float(self.nodes.axes.size[0])) / per_speed) ** 4
        return number * modulus * radius / (2.0 * state.viscosity)


def _within(x: FloatArray, nodes: FloatArray) -> BoolArray:
    """True where places lie within nodes, but for round-off."""
    return np.asarray((x >= nodes[0] - _SLACK) & (x <= nodes[-1] + _SLACK))
