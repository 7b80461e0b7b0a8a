"""One point contact in SI: film, approach, stiffness and damping, each with an error and all with a status.

The groups of a contact go to `two_grids`, which knows no units; what comes back is scaled by a, p_H, a^2/Rx and a/u.
Isothermal, Newtonian, fully flooded, smooth; rolling along either axis of the ellipse.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.compiling import stopwatch
from ehdmaps.errors import Problems
from ehdmaps.physics.closed_form import CONTINUUM, NO_CONTINUUM, THICK_NOTE, THIN_FILM_LIMIT, too_thick
from ehdmaps.physics.hertz import LARGEST_PRESSURE
from ehdmaps.physics.lubricant import Lubricant, LubricantState
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.point.film_formulas import point_groups
from ehdmaps.physics.point.inlet_heat import WARM, heated_point, point_heats
from ehdmaps.physics.solution import Estimate, PointNumbers, Status
from ehdmaps.physics.spectrum import checked_frequencies
from ehdmaps.point.problem import PointProblem
from ehdmaps.point.two_grids import MOST_ERROR, SHARES, PointGroups, Resolution, responses, solve_groups

ELLIPTICITIES = (0.2, 40.0)
"""Ellipticities that are solved: beyond, a contact is one of a line."""

LOAD_NUMBERS = (0.05, 3e4)
"""Moes' M that are solved: below, the solids hardly deform; above, the film is below what the grids resolve."""

LARGEST_OIL_NUMBER = 65.0
"""Moes' L above which no solve is tried."""


@dataclass(frozen=True, eq=False)
class PointResponse:
    """Dynamic stiffness of a point contact over frequency.

    Attributes
    ----------
    frequencies : ndarray, shape (k,)
        [Hz], > 0.
    dynamic_stiffness : ndarray, shape (k,)
        K = k + i omega c of film and solids, complex [N/m].
    stiffness_error, damping_error : ndarray, shape (k,)
        Estimated errors of k and c, relative to abs(k) and abs(c); no smaller than those of slow motion.
    """

    frequencies: FloatArray
    dynamic_stiffness: ComplexArray
    stiffness_error: FloatArray
    damping_error: FloatArray

    @property
    def stiffness(self) -> FloatArray:
        """Stiffness k at each frequency, shape (k,) [N/m]."""
        return np.asarray(self.dynamic_stiffness.real)

    @property
    def damping(self) -> FloatArray:
        """Damping c at each frequency, shape (k,) [N s/m]."""
        return np.asarray(self.dynamic_stiffness.imag / (2.0 * math.pi * self.frequencies))


@dataclass(frozen=True, eq=False)
class PointField:
    """Pressure and film over a point contact, on the nodes of the finer grid.

    Attributes
    ----------
    x, y : ndarray, shape (n,), (m,)
        Places in the direction of rolling and across it [m], 0 at the centre; the film is symmetric in y.
    pressure, film : ndarray, shape (n, m)
        [Pa], [m].
    """

    x: FloatArray
    y: FloatArray
    pressure: FloatArray
    film: FloatArray


@dataclass(frozen=True, eq=False)
class PointSolution(PointNumbers):
    """One point contact: where it is, and its numbers.

    Attributes
    ----------
    status, reason
        Typed status, and its cause in words (empty for plain convergence).
    load : float
        F [N].
    entrainment_speed : float
        u [m/s].
    temperature : float
        Temperature of both surfaces [K].
    ellipse : Ellipse
        The dry contact.
    response : PointResponse or None
        Response over frequency, where frequencies were given.
    field : PointField or None
        Pressure and film; None where there is no film.
    groups : PointGroups or None
        The solution in groups, from which a neighbour may start.
    """

    status: Status
    reason: str
    load: float
    entrainment_speed: float
    temperature: float
    ellipse: Ellipse
    response: PointResponse | None = dataclasses.field(default=None, repr=False)
    field: PointField | None = dataclasses.field(default=None, repr=False)
    groups: PointGroups | None = dataclasses.field(default=None, repr=False)


def solve(
    ellipse: Ellipse,
    lubricant: Lubricant,
    load: float,
    entrainment_speed: float,
    temperature: float,
    frequencies: Sequence[float] | FloatArray | None = None,
    resolution: Resolution | None = None,
    previous: PointSolution | None = None,
) -> PointSolution:
    """Solve one point contact; a point without a solution has a status that says so, and no numbers.

    Parameters
    ----------
    ellipse : Ellipse
        Radii and elastic modulus of the contact.
    lubricant : Lubricant
        The oil.
    load : float
        F [N], >= 0.
    entrainment_speed : float
        Mean u of the two surface speeds, in the direction of x [m/s], >= 0.
    temperature : float
        Temperature of both surfaces [K].
    frequencies : sequence of float, optional
        Frequencies at which the response is wanted [Hz], see `checked_frequencies`.
    resolution : Resolution, optional
        Both grids; 34 x 12 and 51 x 18 cells of half a contact where left out.
    previous : PointSolution, optional
        A neighbour of the same ellipse, to start from.

    Raises
    ------
    InputError
        If load or speed is no number, not finite or negative, or the oil has no temperature like that.

    Examples
    --------
    A ball of 20 mm on a plane, 20 N, 1 m/s:

    >>> from ehdmaps.physics.lubricant import Lubricant
    >>> ball = Ellipse(10e-3, 10e-3, 230.769e9)
    >>> found = solve(ball, Lubricant.named("FVA3"), 20.0, 1.0, 313.15)
    >>> found.status.word, round(1e6 * found.central_film, 2), found.central_film.error < 0.03
    ('converged', 0.45, True)
    """
    problems = Problems(
        f"point contact, {name}: got {value!r:.60}; allowed: a finite number >= 0 [{unit}]"
        for name, value, unit in (("load", load, "N"), ("entrainment_speed", entrainment_speed, "m/s"))
        if not (isinstance(value, int | float) and math.isfinite(value) and value >= 0.0)
    )
    problems.check()
    state = lubricant.at(temperature)
    asked = None if frequencies is None else checked_frequencies(frequencies)
    where = (float(load), float(entrainment_speed), temperature, ellipse)
    if load == 0.0:
        return PointSolution(Status.OUTSIDE_VALIDITY, "no load: the bodies do not meet, no film to solve", *where)
    if entrainment_speed == 0.0:
        return _dry(where, asked)
    M, L = point_groups(ellipse, state, load, entrainment_speed)
    beyond = _beyond_reach(ellipse, load, M, L)
    if beyond:
        return PointSolution(Status.OUTSIDE_VALIDITY, beyond, *where, load_number=M, oil_number=L)
    seconds = stopwatch()
    peak = float(ellipse.max_pressure(load))
    problem = PointProblem(ellipse.ellipticity, M, L, state.isotherm(peak))
    grids = resolution or Resolution()
    groups = solve_groups(problem, grids, None if previous is None else previous.groups)
    if groups.numbers is None:
        reason = f"Newton {groups.status.word} at M = {M:.4g}, L = {L:.4g}, ellipticity {ellipse.ellipticity:.4g} "
        reason += "from every start and load tried"
        steps = groups.steps
        return PointSolution(
            groups.status, reason, *where, load_number=M, oil_number=L, steps=steps, solve_seconds=seconds()
        )
    response = None
    if asked is not None:
        response = _response(groups, asked, ellipse, load, entrainment_speed)
    return _in_si(groups, where, (M, L), state, response, seconds())


def _beyond_reach(ellipse: Ellipse, load: float, M: float, L: float) -> str:
    """Reason why a point is not even tried; empty if it is."""
    peak, kappa = float(ellipse.max_pressure(load)), ellipse.ellipticity
    if not (math.isfinite(M) and math.isfinite(L)):
        return f"groups M = {M:.4g}, L = {L:.4g} are not finite: load, speed or viscosity is absurd"
    if peak > LARGEST_PRESSURE:
        return f"Hertz pressure {peak / 1e9:.3g} GPa above {LARGEST_PRESSURE / 1e9:g} GPa"
    if not ELLIPTICITIES[0] <= kappa <= ELLIPTICITIES[1]:
        return f"ellipticity {kappa:.4g} outside of {ELLIPTICITIES[0]:g} to {ELLIPTICITIES[1]:g}: a contact of a line"
    if LOAD_NUMBERS[0] > M:
        return f"M = {M:.3g} below {LOAD_NUMBERS[0]:g}: a rigid contact, whose film is wider than the grid"
    if LOAD_NUMBERS[1] < M:
        return f"M = {M:.3g} above {LOAD_NUMBERS[1]:g}: the film is thinner than the grid resolves"
    if L > LARGEST_OIL_NUMBER:
        return f"L = {L:.3g} above {LARGEST_OIL_NUMBER:g}"
    return ""


def _dry(where: tuple[float, float, float, Ellipse], frequencies: FloatArray | None) -> PointSolution:
    """The limit u = 0: no film, no loss, the contact of Hertz."""
    load, _, _, ellipse = where
    stiffness, none, response = float(ellipse.stiffness(load)), Estimate(0.0, 0.0), None
    if frequencies is not None:
        exact = np.zeros(frequencies.size)
        response = PointResponse(frequencies, np.full(frequencies.size, stiffness + 0j), exact, exact)
    return PointSolution(
        Status.ASYMPTOTE,
        "no entrainment: dry contact",
        *where,
        approach=Estimate(float(ellipse.approach(load)), 0.0),
        film_offset=none,
        stiffness=Estimate(stiffness, 0.0),
        damping=none,
        film_compliance=none,
        loss_compliance=none,
        central_film=none,
        minimum_film=none,
        max_pressure=Estimate(float(ellipse.max_pressure(load)), 0.0),
        response=response,
    )


def _response(
    groups: PointGroups, frequencies: FloatArray, ellipse: Ellipse, load: float, speed: float
) -> PointResponse:
    """Dynamic stiffness in SI."""
    half = float(ellipse.semi_axes(load)[0])
    unit = float(ellipse.max_pressure(load)) * ellipse.rolling_radius
    found, left = responses(groups, 2.0 * math.pi * frequencies * half / speed)
    slow = groups.errors
    assert slow is not None
    stiffness = np.maximum(SHARES["stiffness"][0] * np.abs(left.real / found.real), slow.stiffness)
    damping = np.maximum(SHARES["damping"][0] * np.abs(left.imag / found.imag), slow.damping)
    return PointResponse(frequencies, unit * found, stiffness, damping)


def _in_si(
    groups: PointGroups,
    where: tuple[float, float, float, Ellipse],
    moes: tuple[float, float],
    state: LubricantState,
    response: PointResponse | None,
    seconds: float,
) -> PointSolution:
    """Scale films by a^2/Rx, stiffness by p_H Rx, damping by p_H Rx a/u; refuse what the grids do not resolve."""
    load, speed, _, ellipse = where
    found, errors = groups.numbers, groups.errors
    assert found is not None and errors is not None and groups.fine is not None
    worst, error = groups.worst
    half, peak = float(ellipse.semi_axes(load)[0]), float(ellipse.max_pressure(load))
    film, spring = half * half / ellipse.rolling_radius, peak * ellipse.rolling_radius
    offset = found.film_offset * film
    thick = too_thick(offset, ellipse.rolling_radius) or ellipse.too_wide(offset)
    physical = found.minimum_film > 0.0 and found.compliance > 0.0
    if not physical or error > MOST_ERROR or thick:
        reason = thick or f"not resolved: both grids differ by {100.0 * error:.0f} % in the {worst}"
        reason = reason if physical or thick else "not resolved: no film, or no stiffness, is left by extrapolation"
        return PointSolution(
            Status.OUTSIDE_VALIDITY,
            reason,
            *where,
            load_number=moes[0],
            oil_number=moes[1],
            steps=groups.steps,
            solve_seconds=seconds,
        )
    status, notes = Status.CONVERGED, []
    if found.film_offset * film / ellipse.rolling_radius > THIN_FILM_LIMIT:
        status = Status.ASYMPTOTE
        notes.append(THICK_NOTE)
    if found.loss < 0.0:
        notes.append("negative damping of an isothermal, Newtonian film")
    if errors.minimum_film > MOST_ERROR:
        notes.append(f"minimum film not resolved: both grids differ by {100.0 * errors.minimum_film:.0f} %")
    if found.minimum_film * film < CONTINUUM:
        notes.append(NO_CONTINUUM)
    approach = float(ellipse.approach(load)) - found.film_offset * film
    grid = groups.fine.grid
    return PointSolution(
        status,
        "; ".join(notes),
        *where,
        load_number=moes[0],
        oil_number=moes[1],
        approach=Estimate(approach, errors.film_offset * found.film_offset * film / max(abs(approach), 1e-300)),
        film_offset=Estimate(found.film_offset * film, errors.film_offset),
        stiffness=Estimate(found.stiffness * spring, errors.stiffness),
        damping=Estimate(found.damping * spring * half / speed, errors.damping),
        film_compliance=Estimate(found.film_compliance / spring, errors.film_compliance),
        loss_compliance=Estimate(found.loss / spring * half / speed, errors.loss),
        central_film=Estimate(found.central_film * film, errors.central_film),
        minimum_film=Estimate(found.minimum_film * film, errors.minimum_film),
        max_pressure=Estimate(found.max_pressure * peak, errors.max_pressure),
        steps=groups.steps,
        solve_seconds=seconds,
        viscosity_extrapolated=found.max_pressure * peak * (1.0 + errors.max_pressure) > state.fitted_pressure,
        response=response,
        field=PointField(half * grid.x, half * grid.y, peak * groups.fine.pressure, film * groups.fine.film),
        groups=groups,
    )


def heated_solution(solution: PointSolution, lubricant: Lubricant) -> PointSolution:
    """A point contact with heat in its inlet, by the rule; one without a film stays what it is.

    Its fields, and its response over frequency, are those of the isothermal film, and are left out.

    Parameters
    ----------
    solution : PointSolution
        The isothermal film.
    lubricant : Lubricant
        The oil, whose conductivity has to be known.

    Raises
    ------
    InputError
        Without the conductivity of the oil.
    """
    if not solution.status.usable or solution.entrainment_speed == 0.0:
        return solution
    at = (np.array([x]) for x in (solution.load, solution.entrainment_speed, solution.temperature))
    heat = point_heats(solution.ellipse, lubricant, *at)
    cold: dict[str, float] = {}
    for name in WARM:
        number: Estimate = getattr(solution, name)
        cold |= {name: float(number), f"{name}_error": number.error}
    warm = heated_point(cold, heat, float(solution.ellipse.stiffness(solution.load)))
    numbers: dict[str, Any] = {name: Estimate(float(warm[name][0]), float(warm[f"{name}_error"][0])) for name in WARM}
    return dataclasses.replace(
        solution,
        reason="; ".join(filter(None, (solution.reason, heat.of(0).note))),
        response=None,
        field=None,
        groups=None,
        **numbers,
    )
