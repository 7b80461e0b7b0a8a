"""The solvers without a discretisation, `hertz` and `formula`; how far their films have a meaning.

How thick and how thin a film may be before its numbers lose their meaning.

Thick: the gap of two cylinders is taken as a parabola, and the flow in it as that of a thin film. At the places
x = sqrt(2 h R), where the gap is twice the film and much of the pressure is built up, a parabola is h/(2 R) off the
circle, relatively, to first order, and the surfaces are inclined by sqrt(2 h/R). At h/R = 0.01 that is half a per cent
and 8 degrees: up to there nobody needs a word. At h/R = 0.3 the parabola is 18 % off, the inclination is 51 degrees,
and the whole film would reach around three quarters of the cylinder: nothing is left of the theory.

Thin: below a nanometre a film is no continuum, but some molecules. Below the roughness the surfaces touch before such a
film is all that carries.

The solvers without a discretisation: `hertz` (dry) and `formula` (a published central film formula).

They state no errors (NaN): a closed form has no numerical error, and how far it is from a full solution, a model error,
is not known here. Against `reynolds` the damping of a formula is often wrong by most of its size. Both are
low-frequency limits: their film compliance and loss compliance do not depend on frequency.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ehdmaps.arrays import FloatArray, Values
from ehdmaps.errors import InputError
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.films import (
    dietl_damping,
    dowson_higginson_minimum,
    dowson_toyoda_central,
    elastic_piezoviscous,
    martin_minimum,
    moes_central,
    moes_central_and_slope,
    pan_hamrock_central,
    rolling_film_damping,
)
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant, LubricantState
from ehdmaps.physics.moes import dowson_groups, film_from_moes, moes_groups
from ehdmaps.physics.solution import ContactSolverDefaults, FilmSolution, Status

THIN_FILM_LIMIT = 0.01
"""h/R above which a film is outside thin-film theory, and is said to be an asymptote."""

THICK_NOTE = "film thicker than 1 % of the radius: limit of thin-film theory, Reynolds with a parabolic gap"
"""What is said of a film above `THIN_FILM_LIMIT`."""

THICKEST_FILM = 0.3
"""h/R above which a film is refused."""

CONTINUUM = 1e-9
"""Film below which there is no continuum [m]."""

NO_CONTINUUM, BELOW_ROUGHNESS = "film below 1 nm: no continuum", "film below the roughness"
"""What is said of films that are too thin for their solution to be taken as it is."""

HEAVIEST_LOAD_NUMBER = 2e6
"""Moes' M above which the film is too thin for double precision to see it beside the elastic deflection."""

LIGHTEST_LOAD_NUMBER = 1e-12
"""Moes' M below which double precision does not see the elastic deflection, of size b^2/R, beside the film, H ~ 1/M:
the linear response, made of both, loses digits, and its equations are singular from 1e-16 on."""


def too_thick(film: float, radius: float, thickest: float = THICKEST_FILM) -> str:
    """Reason why a film is refused; empty where it is not.

    Lines that stand for their groups only, from which contact laws are made, have no thickness of their own: for them
    the limit is infinite.

    Parameters
    ----------
    film : float
        Film offset h [m].
    radius : float
        Reduced radius R [m].
    thickest : float
        Largest h/R that is taken.
    """
    if not film > thickest * radius:
        return ""
    return (
        f"film h/R = {film / radius:.3g} above {thickest:g}: neither thin-film theory nor a parabolic gap holds; "
        "take a higher load, a lower speed or a thinner oil"
    )


def too_thin(film: float, roughness: float = 0.0) -> str:
    """Note on what a film is too thin for, in words that follow its status; empty where it is not.

    Parameters
    ----------
    film : float
        Minimum film [m]; 0 is the dry contact, of which nobody is told that it has a thin film.
    roughness : float
        Combined rms roughness [m]; 0 where none is known.
    """
    if not film > 0.0:
        return ""
    if film < CONTINUUM:
        return NO_CONTINUUM
    return BELOW_ROUGHNESS if film < roughness else ""


FilmFormula = Literal["moes", "dowson-toyoda", "pan-hamrock"]
DampingFormula = Literal["rigid", "dietl"]


@dataclass(frozen=True)
class HertzSolver(ContactSolverDefaults):
    """Dry contact: no film, no film compliance, no loss."""

    @property
    def name(self) -> str:
        """Name of the solver."""
        return "hertz"

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        """Dry films at each load, whatever the oil and its speed; arguments as of `ContactSolver.solve_line`."""
        _check(loads, entrainment_speed, temperature)
        return tuple(_dry(contact, load, Status.CONVERGED) for load in loads)

    def settings(self) -> dict[str, float | int | str]:
        """Nothing changes its numbers."""
        return {}


@dataclass(frozen=True)
class FormulaSolver(ContactSolverDefaults):
    """Film offset = central film h_c of a published formula; its load derivative gives the film compliance.

    The loss compliance is c/k_h^2 with the rigid rolling film, c = 6.548 eta0 (R/h_c)^1.5, and k_h =
    -dw/dh_c. With Dietl's regression for the contact c_D/k_dry^2 is added: of loaded contacts, where solids yield more
    than films, c is c_D; of light ones that of the film. The minimum film is the larger of Dowson-Higginson's and
    Martin's, at most h_c; the largest pressure is Hertz's.

    Attributes
    ----------
    film_formula : {"moes", "dowson-toyoda", "pan-hamrock"}
        `moes` covers all regimes; the other two are for loaded contacts, 2 <= M <= 1000, and say so elsewhere
        as the reason of a film.
    thickest_film : float
        Largest h/R that is no refusal; infinite for lines that stand for their groups only.
    damping : {"rigid", "dietl"}
        What gives the damping.
    inlet_length_factor : float
        Length factor f of Dietl's inlet zone.

    Raises
    ------
    InputError
        If there is no formula of that name.
    """

    film_formula: FilmFormula = "moes"
    thickest_film: float = THICKEST_FILM
    damping: DampingFormula = "rigid"
    inlet_length_factor: float = 1.0

    def __post_init__(self) -> None:
        if self.film_formula not in FILM_FORMULAS:
            raise InputError(
                f"film_formula: got {self.film_formula!r}; allowed: {', '.join(FILM_FORMULAS)}; choose one of them"
            )

    @property
    def name(self) -> str:
        """Name of the solver."""
        return "formula"

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        """Films at each load; arguments as of `ContactSolver.solve_line`."""
        _check(loads, entrainment_speed, temperature)
        if entrainment_speed == 0.0:
            reason = "entrainment speed zero: dry contact"
            return tuple(_dry(contact, load, Status.ASYMPTOTE, reason) for load in loads)
        state, w = lubricant.at(temperature), np.array(loads)
        try:
            with np.errstate(all="ignore"):
                film, slope = FILM_FORMULAS[self.film_formula](contact, state, w, entrainment_speed)
                loss = self._loss(contact, state, w, entrainment_speed, film, slope)
                minimum = np.minimum(film, minimum_film(contact, state, w, entrainment_speed))
        except (OverflowError, ZeroDivisionError):  # of numbers that all loads share
            film = slope = loss = minimum = np.full(w.shape, math.nan)
        columns = zip(loads, *(part.tolist() for part in (film, slope, loss, minimum)), strict=True)
        return tuple(self._film(contact, state, entrainment_speed, *row) for row in columns)

    def settings(self) -> dict[str, float | int | str]:
        """The formula."""
        thickest = {} if self.thickest_film == THICKEST_FILM else {"thickest_film": self.thickest_film}
        dietl = {"damping": self.damping, "inlet_length_factor": self.inlet_length_factor}
        return {"film_formula": self.film_formula, **thickest, **(dietl if self.damping == "dietl" else {})}

    def _loss(
        self,
        contact: LineContact,
        state: LubricantState,
        load: FloatArray,
        speed: float,
        film: FloatArray,
        slope: FloatArray,
    ) -> FloatArray:
        """Loss compliance c/k^2 a length [m2 s/N]."""
        rigid = np.asarray(rolling_film_damping(film, state.viscosity, contact.radius) * slope**2)
        if self.damping == "rigid":
            return rigid
        length = contact.roller_length
        if length is None:
            raise InputError(
                f"damping: got 'dietl' for {contact.name!r}, whose length is not known; allowed: in a [bearing], or "
                "with roller_length of a [contact]"
            )
        alpha = state.pressure_viscosity.pressure_viscosity
        numbers = load, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus, length
        whole = dietl_damping(*numbers, self.inlet_length_factor)
        return rigid + np.asarray(whole / length * np.asarray(contact.structural_compliance(load)) ** 2)

    def _film(
        self,
        contact: LineContact,
        state: LubricantState,
        speed: float,
        load: float,
        film: float,
        slope: float,
        loss: float,
        minimum: float,
    ) -> FilmSolution:
        """One point, or why it is none."""
        peak = float(max_pressure(load, contact.radius, contact.reduced_modulus))
        if not (film > 0.0 and minimum > 0.0 and all(map(math.isfinite, (film, slope, loss, peak)))):
            return FilmSolution(
                status=Status.OUTSIDE_VALIDITY,
                reason=f"the film formula {self.film_formula} gives no finite, positive film here",
            )
        refused = too_thick(film, contact.radius, self.thickest_film)
        if refused:
            return FilmSolution(status=Status.OUTSIDE_VALIDITY, reason=refused)
        status, reason = Status.CONVERGED, ""
        if film / contact.radius > THIN_FILM_LIMIT:
            status = Status.ASYMPTOTE
            reason = f"film h/R = {film / contact.radius:.3g} above {THIN_FILM_LIMIT}: outside thin-film theory"
        elif self.film_formula != "moes":
            M, L = moes_groups(*_group_arguments(contact, state, load, speed))
            if not elastic_piezoviscous(M, L):
                reason = (
                    f"M = {M:.3g}, L = {L:.3g} outside the range of {self.film_formula}: 2 <= M <= 1000, L <= 150, "
                    "elastic and piezoviscous"
                )
        return FilmSolution(
            status=status,
            reason=reason,
            film_offset=film,
            film_compliance=-slope,
            loss_compliance=loss,
            central_film=film,
            minimum_film=minimum,
            max_pressure=peak,
            viscosity_extrapolated=peak > state.fitted_pressure,
        )


def _dry(contact: LineContact, load: float, status: Status, reason: str = "") -> FilmSolution:
    """The dry contact as a film of zero thickness."""
    peak = float(max_pressure(load, contact.radius, contact.reduced_modulus))
    if not math.isfinite(peak):
        return FilmSolution(status=Status.OUTSIDE_VALIDITY, reason="the Hertz pressure is not finite here")
    return FilmSolution(
        status=status,
        reason=reason,
        film_offset=0.0,
        film_compliance=0.0,
        loss_compliance=0.0,
        central_film=0.0,
        minimum_film=0.0,
        max_pressure=peak,
    )


def _check(loads: tuple[float, ...], speed: float, temperature: float) -> None:
    """Refuse loads, speeds and temperatures that no point of a map can have."""
    for load in loads:
        OperatingPoint(load, speed, temperature)


_Film = Callable[[LineContact, LubricantState, FloatArray, float], tuple[FloatArray, FloatArray]]


def moes_film(
    contact: LineContact, state: LubricantState, load: FloatArray, speed: float
) -> tuple[FloatArray, FloatArray]:
    """Central film of Moes [m] and its derivative with respect to load [m2/N].

    Parameters
    ----------
    contact : LineContact
        The contact.
    state : LubricantState
        The oil at its temperature.
    load : array
        w [N/m], > 0.
    speed : float
        Entrainment speed u [m/s], > 0.
    """
    M, L = moes_groups(*_group_arguments(contact, state, load, speed))
    film_number, slope = moes_central_and_slope(M, L)
    film = film_from_moes(film_number, speed, state.viscosity, contact.radius, contact.reduced_modulus)
    return film, film * slope / film_number * M / load


def _dowson_toyoda(
    contact: LineContact, state: LubricantState, load: FloatArray, speed: float
) -> tuple[FloatArray, FloatArray]:
    """Central film of Dowson and Toyoda [m] and its derivative with respect to load [m2/N]."""
    film = contact.radius * dowson_toyoda_central(*dowson_groups(*_group_arguments(contact, state, load, speed)))
    return film, -0.10 * film / load


def _pan_hamrock(
    contact: LineContact, state: LubricantState, load: FloatArray, speed: float
) -> tuple[FloatArray, FloatArray]:
    """Central film of Pan and Hamrock [m] and its derivative with respect to load [m2/N]."""
    film = contact.radius * pan_hamrock_central(*dowson_groups(*_group_arguments(contact, state, load, speed)))
    return film, -0.166 * film / load


FILM_FORMULAS: Mapping[str, _Film] = {
    "moes": moes_film,
    "dowson-toyoda": _dowson_toyoda,
    "pan-hamrock": _pan_hamrock,
}


def minimum_film(contact: LineContact, state: LubricantState, load: FloatArray, speed: float) -> FloatArray:
    """Larger of the minimum films of Dowson-Higginson and of Martin [m].

    Parameters
    ----------
    contact, state, load, speed
        Arguments of `moes_film`.
    """
    arguments = _group_arguments(contact, state, load, speed)
    elastic = contact.radius * dowson_higginson_minimum(*dowson_groups(*arguments))
    M, _ = moes_groups(*arguments)
    rigid = film_from_moes(martin_minimum(M), speed, state.viscosity, contact.radius, contact.reduced_modulus)
    return np.maximum(elastic, rigid)


def _group_arguments(
    contact: LineContact, state: LubricantState, load: Values, speed: float
) -> tuple[Values, float, float, float, float, float]:
    """Arguments of the dimensionless groups."""
    alpha = state.pressure_viscosity.pressure_viscosity
    return load, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus


def film_change(contact: LineContact, state: LubricantState, load: float, speed: float, factor: float) -> float:
    """Relative change of the central film where alpha is `factor` times what is taken.

    Only L changes: it goes with alpha. In the piezoviscous-elastic regime a film goes with about the square root of
    alpha; where the oil is nearly isoviscous or the contact nearly rigid, with less or a little more.

    Parameters
    ----------
    contact : LineContact
        The contact.
    state : LubricantState
        The oil at its temperature.
    load, speed : float
        w [N/m] and entrainment speed u [m/s], both > 0.
    factor : float
        alpha over the alpha of the oil, >= 0.
    """
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = moes_groups(load, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    return float(moes_central(M, factor * L) / moes_central(M, L) - 1.0)
