"""Films of any contact and oil of the family, read from the table.

The family: smooth line contacts, fully flooded, with a Newtonian, isothermal oil whose density goes after Dowson and
Higginson, or is constant where the table holds such an oil too.

A table has two parts, one for oils with a piezoviscosity to speak of and one for all that have less, down to none.
Where both know an oil, the one goes over into the other smoothly.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray, IndexArray
from ehdmaps.errors import InputError
from ehdmaps.physics.closed_form import (
    HEAVIEST_LOAD_NUMBER,
    LIGHTEST_LOAD_NUMBER,
    THICK_NOTE,
    THICKEST_FILM,
    THIN_FILM_LIMIT,
)
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.heat import THINNED, inlet_heats
from ehdmaps.physics.hertz import LARGEST_PRESSURE
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rheology import NEWTONIAN_LIMIT, NEWTONIAN_STRESS
from ehdmaps.physics.solution import FilmSolution, Status
from ehdmaps.table.coordinates import LEAST_ALPHA, bend_of, valley_shift, zeta_of
from ehdmaps.table.fields import FILMS, LAW, NATURAL_FREQUENCIES, RESPONSES, Field, Units, units
from ehdmaps.table.interpolation import Place, place_of
from ehdmaps.table.nodes import FARTHEST, OTHER_FILMS, Nodes
from ehdmaps.table.oils import BESIDE, OilStates, exponent_at, mapping_factor, matched_pressure, oil_states

WORST_ERROR = 0.5
"""Error of the smooth form of a film above which the table has no number there."""

_SLACK = 1e-9
_TINY = float(np.finfo(float).tiny)

_CAUSES = (
    "",
    THICK_NOTE,
    "negative damping at the valley of an isothermal, Newtonian film; a contact law takes zero",
    f"wall stress above {NEWTONIAN_LIMIT:g} of the largest pressure: no oil is Newtonian there",
    "no entrainment: dry contact",
    "film table: the oil has no state at this temperature",
    "film table: groups M and L are not finite: load, speed or viscosity is absurd",
    f"film table: Hertz pressure above {LARGEST_PRESSURE / 1e9:g} GPa",
    f"film table: M outside {LIGHTEST_LOAD_NUMBER:g} to {HEAVIEST_LOAD_NUMBER:g}",
    "film table: L above its range, or L/alpha of an oil of hardly any piezoviscosity",
    "film table: pressure-viscosity coefficient above its range",
    "film table: viscosity bends over pressure as none of its oils does",
    "film table: beyond its highest loads",
    f"film thicker than {THICKEST_FILM:g} of the radius: neither thin-film theory nor a parabolic gap holds",
    "film table: no solved film near",
    "film table: viscosity over pressure goes too far from the law of Roelands that is nearest to it",
)
_NONE, _THICK, _NEGATIVE, _STRESSED, _DRY, _NO_STATE, _ABSURD, _PRESSURE = range(8)
_LOAD, _SPEED, _ALPHA, _BEND, _HEAVY, _TOO_THICK, _HOLE, _FAR = range(8, len(_CAUSES))


@dataclass(frozen=True, eq=False)
class TableFilms:
    """Films of points, arrays of the shape of the points; NaN where the status is not usable or not asked for.

    Attributes
    ----------
    status : ndarray of int8
        Values of `Status`.
    cause : ndarray of int8
        Why, as a number; `reason` has it in words.
    film_offset, film_compliance, loss_compliance, central_film, minimum_film, max_pressure, rolling_force, mass_flow
        Numbers of the film, see `FilmSolution`.
    wall_stress : ndarray
        Largest shear stress at a wall in pure rolling [Pa].
    response : ndarray, shape (..., k)
        Film compliance at the natural frequencies, complex [m2/N]; k = 0 where it was not asked for.
    errors : mapping of str to ndarray
        Estimated relative errors without a sign, by the name of the number; that of "response" relative to its
        magnitude, shape (..., k).
    viscosity_extrapolated : ndarray of bool
        The pressure left the range in which the viscosity law was fitted.
    law_error : ndarray
        Largest error of ln(film offset), asinh(E' film compliance/0.3) and asinh(u E' loss compliance/(0.5 b)): unlike
        a relative error it stays finite where these run through zero.
    """

    status: npt.NDArray[np.int8]
    cause: npt.NDArray[np.int8]
    film_offset: FloatArray
    film_compliance: FloatArray
    loss_compliance: FloatArray
    central_film: FloatArray
    minimum_film: FloatArray
    max_pressure: FloatArray
    rolling_force: FloatArray
    mass_flow: FloatArray
    wall_stress: FloatArray
    response: ComplexArray
    errors: Mapping[str, FloatArray]
    viscosity_extrapolated: BoolArray
    law_error: FloatArray

    @property
    def usable(self) -> BoolArray:
        """True where there are films."""
        return np.asarray(self.status <= int(Status.ASYMPTOTE))

    @property
    def reason(self) -> npt.NDArray[np.str_]:
        """Cause of the status in words; empty for a plain film."""
        return np.array(_CAUSES)[self.cause]

    def solution(self, index: int) -> FilmSolution:
        """The film of one point.

        Parameters
        ----------
        index : int
            Number of the point, of points in a row.
        """
        numbers: dict[str, Any] = {field.name: float(getattr(self, field.name)[index]) for field in FILMS}
        errors: dict[str, Any] = {
            f"{name}_error": float(self.errors[name][index]) for name in numbers if name != "wall_stress"
        }
        reason = str(_CAUSES[self.cause[index]])
        return FilmSolution(Status(int(self.status[index])), reason, **numbers, **errors)


@dataclass(frozen=True, eq=False)
class FilmTable:
    """Films of one density law.

    Attributes
    ----------
    piezoviscous, isoviscous : Nodes
        The two parts, see `ehdmaps.table.coordinates`. The second one ends where the first one has begun.
    compressible : bool
        Whether the density is that of Dowson and Higginson; constant if not.
    """

    piezoviscous: Nodes
    isoviscous: Nodes
    compressible: bool

    @property
    def _seam(self) -> tuple[float, float]:
        """Values of ln alpha where the piezoviscous part begins, and the isoviscous one ends."""
        return float(self.piezoviscous.axes.alpha[0]), float(np.log(self.isoviscous.axes.alpha[-1]))

    @property
    def largest_oil_number(self) -> float:
        """Largest L of the table."""
        return float(np.exp(self.piezoviscous.axes.size[-1]))

    def films(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        load: npt.ArrayLike,
        entrainment_speed: npt.ArrayLike,
        temperature: npt.ArrayLike,
        others: bool = True,
        response: bool = False,
        thickest_film: float = THICKEST_FILM,
        inlet_heat: bool = False,
    ) -> TableFilms:
        """Films at points.

        Parameters
        ----------
        contact : LineContact
            The contact: its radius and its material.
        lubricant : Lubricant
            The oil.
        load, entrainment_speed, temperature : float or ndarray
            w [N/m] > 0, u [m/s] >= 0 and T [K] > 0; they are broadcast.
        others : bool
            Whether more is wanted than film offset, film compliance and loss compliance.
        response : bool
            Whether the film compliance at the natural frequencies is wanted.
        thickest_film : float
            Largest h/R that is no refusal; infinite for points that stand for their groups only.
        inlet_heat : bool
            Whether heat in the inlet thins them, by its rule (`ehdmaps.physics.heat`), whose errors are added. The
            response is isothermal in any case.

        Raises
        ------
        InputError
            For loads, speeds and temperatures that no point can have, an oil with the other density law, and one whose
            conductivity heat would need.
        """
        if (lubricant.density_law != "incompressible") != self.compressible:
            held = "dowson-higginson" if self.compressible else "incompressible"
            raise InputError(
                f"film table, density_law: got {lubricant.density_law!r}; this table holds {held}; take the table of "
                "the other law"
            )
        w, u, T = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in (load, entrainment_speed, temperature)))
        points = _points(contact, lubricant, w.ravel(), u.ravel(), T.ravel())
        cause = self._refused(points)
        good = np.flatnonzero(cause == _NONE)
        read = self._reader(points, good)
        numbers, errors = ({field.name: np.full(w.size, np.nan) for field in FILMS} for _ in range(2))
        law_error = np.full(w.size, np.nan)
        hole = np.full(w.size, _NONE, dtype=np.int8)
        for fields in (LAW, OTHER_FILMS) if others else (LAW,):
            reduced, wrong = read(fields)
            if fields is LAW:
                law_error[good] = np.max(
                    [f.judged_error(reduced[:, k], wrong[:, k]) for k, f in enumerate(LAW)], axis=0
                )
                unknown = np.where((points.beside != points.exponent)[good], _FAR, _HOLE)
                hole[good] = np.where(np.all(wrong < WORST_ERROR, axis=1), _NONE, unknown)
            for k, field in enumerate(fields):
                numbers[field.name][good] = reduced[:, k] * points.unit.of(field)[good]
                errors[field.name][good] = field.relative_error(reduced[:, k], wrong[:, k])
        complex_response = np.full((w.size, len(NATURAL_FREQUENCIES) if response else 0), complex(np.nan, np.nan))
        errors["response"] = np.full(complex_response.shape, np.nan)
        if response:
            reduced, wrong = read(RESPONSES)
            wrong *= np.hypot(reduced, [field.scale for field in RESPONSES])
            reduced_response = reduced[:, 0::2] + 1j * reduced[:, 1::2]
            complex_response[good] = reduced_response * points.unit.compliance[good, None]
            errors["response"][good] = np.hypot(wrong[:, 0::2], wrong[:, 1::2]) / np.abs(reduced_response)
        cause[good] = _noted(numbers, hole, thickest_film * contact.radius, contact.radius, good)
        if inlet_heat:
            heat = inlet_heats(contact, lubricant, *(x.ravel()[good] for x in (w, u, T)))
            kept = heat.compliance(numbers["film_compliance"][good], numbers["film_offset"][good])
            numbers["film_compliance"][good] = kept
            numbers["film_offset"][good] *= heat.offset_factor
            numbers["loss_compliance"][good] *= heat.loss_factor
            for name in THINNED:
                numbers[name][good] *= heat.factor
            for name in ("film_offset", *THINNED):
                errors[name][good] += heat.film_error
            for wrong in (errors["film_compliance"], errors["loss_compliance"], law_error):
                wrong[good] += heat.loss_error
        refused, dry = cause > _DRY, cause == _DRY
        for number in (*numbers.values(), *errors.values(), complex_response, law_error):
            number[refused], number[dry] = np.nan, 0.0
        numbers["max_pressure"][dry] = points.unit.pressure[dry]
        status = np.where(refused, int(Status.OUTSIDE_VALIDITY), int(Status.CONVERGED)).astype(np.int8)
        status[dry | (cause == _THICK)] = int(Status.ASYMPTOTE)
        top = np.fmax(numbers["max_pressure"], points.unit.pressure)

        def shaped(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
            return values.reshape(w.shape + values.shape[1:])

        return TableFilms(
            status=shaped(status),
            cause=shaped(cause),
            response=shaped(complex_response),
            law_error=shaped(law_error),
            errors={name: shaped(values) for name, values in errors.items()},
            viscosity_extrapolated=shaped(~refused & (top > points.fitted_pressure)),
            **{name: shaped(values) for name, values in numbers.items()},
        )

    def _refused(self, points: _Points) -> npt.NDArray[np.int8]:
        """Find why there is no film at points, before it is read."""
        iso, piezo = self.isoviscous.axes, self.piezoviscous.axes
        M, L, alpha = points.load_number, points.oil_number, points.alpha
        begin, end = np.exp(self._seam)
        fastest, fastest_thin = (np.exp(axes.size[-1]) * (1.0 + _SLACK) for axes in (piezo, iso))
        with np.errstate(invalid="ignore"):
            tests = (
                (points.speed == 0.0, _DRY),
                (np.isnan(points.alpha), _NO_STATE),
                (~(np.isfinite(M) & np.isfinite(L) & (M > 0.0)), _ABSURD),
                (points.unit.pressure > LARGEST_PRESSURE, _PRESSURE),
                ((M > HEAVIEST_LOAD_NUMBER) | (M < LIGHTEST_LOAD_NUMBER), _LOAD),
                ((fastest < L) | ((alpha < end) & (fastest_thin * alpha < L)), _SPEED),
                (np.log(alpha) > piezo.alpha[-1] + _SLACK, _ALPHA),
                (~_within(bend_of(np.maximum(alpha, begin), points.exponent), piezo.bend), _BEND),
                (points.zeta > piezo.zeta[-1] + FARTHEST, _HEAVY),
            )
        return np.select([test for test, _ in tests], [cause for _, cause in tests], _NONE).astype(np.int8)

    def _reader(
        self, points: _Points, good: IndexArray
    ) -> Callable[[tuple[Field, ...]], tuple[FloatArray, FloatArray]]:
        """Function that reads reduced numbers of some points, and errors of their smooth forms, both (n, fields)."""
        pieces = self._pieces(points, good, points.exponent[good])
        mapped = np.flatnonzero(points.beside[good] != points.exponent[good])
        other = []
        if mapped.size:
            at = good[mapped]
            alpha, exponent, beside = points.alpha[at], points.exponent[at], points.beside[at]
            # an oil that is beyond the nodes counts on the other side
            begin = np.exp(self._seam[0])
            inside = _within(bend_of(np.maximum(alpha, begin), beside), self.piezoviscous.axes.bend)
            other = self._pieces(points, at, np.where(inside, beside, 2.0 * exponent - beside))

        def read(fields: tuple[Field, ...]) -> tuple[FloatArray, FloatArray]:
            lifted, wrong = (np.zeros((good.size, len(fields))) for _ in range(2))
            for piece in pieces:
                lifted[piece.at] += piece.share * piece.nodes.read(piece.place, fields)
                wrong[piece.at] += piece.share * piece.nodes.errors(piece.place, fields)
            moved = lifted[mapped]
            for piece in other:
                moved[piece.at] -= piece.share * piece.nodes.read(piece.place, fields)
            wrong[mapped] += np.abs(moved) * [mapping_factor(field.name, points.fitted) for field in fields]
            return np.column_stack([field.reduced(lifted[:, k]) for k, field in enumerate(fields)]), wrong

        return read

    def _pieces(self, points: _Points, at: IndexArray, exponent: FloatArray) -> list[_Piece]:
        """Parts that count for some points, and how much, with one z or another."""
        M, L, alpha = points.load_number[at], points.oil_number[at], points.alpha[at]
        begin, end = self._seam
        t = np.clip((np.log(alpha) - begin) / (end - begin), 0.0, 1.0)
        share = t * t * (3.0 - 2.0 * t)
        shift, bend = valley_shift(L, alpha, exponent), bend_of(alpha, exponent)
        pieces = []
        for nodes, part, coordinates in (
            (self.piezoviscous, share, (zeta_of(M, L, shift), np.log(L), np.log(alpha), bend)),
            (self.isoviscous, 1.0 - share, (zeta_of(M, L), np.log(L / alpha), alpha, 1.0 - exponent)),
        ):
            (counting,) = np.nonzero(part)
            if counting.size:
                zeta, size, by_alpha, by_bend = (x[counting] for x in coordinates)
                by_bend = np.clip(by_bend, nodes.axes.bend[0], nodes.axes.bend[-1])
                place = place_of(nodes.axes, zeta, size, by_alpha, by_bend)
                pieces.append(_Piece(nodes, counting, part[counting, None], place))
        return pieces


class _Piece(NamedTuple):
    """Points for which one part of a table counts: their indices, shape (n,), and its share, shape (n, 1)."""

    nodes: Nodes
    at: IndexArray
    share: FloatArray
    place: Place


class _Points(NamedTuple):
    """Points in the groups of the table, arrays of shape (n,); `beside` is the z of an oil matched elsewhere."""

    speed: FloatArray
    unit: Units
    load_number: FloatArray
    oil_number: FloatArray
    alpha: FloatArray
    exponent: FloatArray
    beside: FloatArray
    zeta: FloatArray
    fitted_pressure: float
    fitted: bool


def _points(
    contact: LineContact, lubricant: Lubricant, load: FloatArray, speed: FloatArray, temperature: FloatArray
) -> _Points:
    """Groups of points, NaN where the oil has no state."""
    _check(load, speed, temperature)
    unique, index = np.unique(temperature, return_inverse=True)
    oil = oil_states(lubricant, unique)
    viscosity, density = oil.viscosity[index], oil.density[index]
    alpha = np.maximum(oil.alpha, LEAST_ALPHA)[index]
    R, E = contact.radius, contact.reduced_modulus
    with np.errstate(all="ignore"):
        unit = units(load, np.maximum(speed, _TINY), viscosity, density, R, E)
        number = 2.0 * viscosity * speed / (E * R)
        M, L = load / (E * R) / np.sqrt(number), alpha * E * np.sqrt(np.sqrt(number))
        exponent, beside = _on_axes(oil, index, M, L, alpha)
        zeta = zeta_of(M, L, valley_shift(L, alpha, exponent))
    return _Points(speed, unit, M, L, alpha, exponent, beside, zeta, oil.fitted_pressure, oil.fitted)


def _on_axes(
    oil: OilStates, index: IndexArray, M: FloatArray, L: FloatArray, alpha: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Roelands' z of points, and that of an oil matched at another pressure; the same of his own law."""
    exponents = oil.exponents[index]
    middle = exponents[:, 1]
    own = np.all(oil.exponents == oil.exponents[:, 1:2], axis=1)[index]
    if np.all(own | np.isnan(middle)):
        return middle, middle
    matched = matched_pressure(zeta_of(M, L, valley_shift(L, alpha, middle)), L)
    return (
        np.where(own, middle, exponent_at(exponents, matched)),
        np.where(own, middle, exponent_at(exponents, BESIDE * matched)),
    )


def _noted(
    numbers: Mapping[str, FloatArray], hole: npt.NDArray[np.int8], thickest: float, radius: float, good: IndexArray
) -> npt.NDArray[np.int8]:
    """Remarks on films that were read."""
    film, stress = numbers["film_offset"][good], numbers["wall_stress"][good]  # the latter NaN where not asked for
    tests = (
        (hole[good] == _HOLE, _HOLE),
        (hole[good] == _FAR, _FAR),
        (film > thickest, _TOO_THICK),
        (film > THIN_FILM_LIMIT * radius, _THICK),
        (numbers["loss_compliance"][good] < 0.0, _NEGATIVE),
        (stress > np.fmax(NEWTONIAN_STRESS, NEWTONIAN_LIMIT * numbers["max_pressure"][good]), _STRESSED),
    )
    return np.select([test for test, _ in tests], [cause for _, cause in tests], _NONE).astype(np.int8)


def _within(x: FloatArray, nodes: FloatArray) -> BoolArray:
    """True where places lie within nodes, but for round-off."""
    slack = _SLACK * (nodes[-1] - nodes[0])
    return np.asarray((x >= nodes[0] - slack) & (x <= nodes[-1] + slack))


def _check(load: FloatArray, speed: FloatArray, temperature: FloatArray) -> None:
    """Refuse what no point can have."""
    wrong = ~((load > 0.0) & np.isfinite(load) & (speed >= 0.0) & np.isfinite(speed))
    wrong |= ~((temperature > 0.0) & np.isfinite(temperature))
    for i in np.flatnonzero(wrong)[:1]:
        OperatingPoint(float(load[i]), float(speed[i]), float(temperature[i]))
