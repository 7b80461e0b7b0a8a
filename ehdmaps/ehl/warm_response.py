"""Linear response of a film with temperatures to slow motion: they follow, and oil and surfaces store heat.

As in `linearisation` the spike's place is an unknown besides. In the order of the frequency the film moves as if it
were steady at each instant; what that misses is stored: mass between each face and the exit, heat in the oil, and heat
in the surfaces, which carry what they took up at S to X in the time (X - S)/U. All three add to the equations of the
next order, whose solution gives the loss.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.elastic import log_kernel
from ehdmaps.ehl.energy import EnergyEquations, followed, marched, wall_weights, warm_temperatures
from ehdmaps.ehl.grid import Grid
from ehdmaps.ehl.linearisation import Neighbour, Response
from ehdmaps.ehl.reynolds import (
    Factors,
    LineProblem,
    StoredOil,
    accumulated,
    carried_mass,
    face_films,
    film,
    node_pressure,
    residual_with,
    stored_mass_rate,
)
from ehdmaps.ehl.warm_column import INTEGRAL, POINTS, SLOPE, WEIGHTS, Columns, empty_columns
from ehdmaps.ehl.warm_newton import MOST_STEPS, warm_factors
from ehdmaps.physics.hertz import DRY_COMPLIANCE
from ehdmaps.physics.isotherm import density

EXACT = 1e-8
"""Last step of temperatures that are differenced [K]."""

SLOWEST_WALL = 1e-3
"""Speed of a wall, in that of the entrainment, below which it does not store what it took up elsewhere."""


@dataclass(frozen=True)
class _State:
    """A film with its temperatures on one grid."""

    grid: Grid
    kernel: FloatArray
    rises: FloatArray
    columns: Columns
    equations: EnergyEquations
    residual: FloatArray
    gap: FloatArray
    mass: FloatArray


def _state(
    problem: LineProblem, grid: Grid, unknowns: FloatArray, rises: FloatArray, first: int, load: float
) -> _State:
    """Temperatures, residual and mass of a film on a grid."""
    kernel, n = log_kernel(grid.x, grid.step), grid.face.size
    columns, rises = empty_columns(n), rises.copy()
    walls = wall_weights(grid.face, first)[0]
    equations, _, _ = warm_temperatures(
        problem, grid.x, grid.face_step, kernel, unknowns, walls, first, rises, columns, np.empty(0), EXACT, MOST_STEPS
    )
    none, out = np.empty((0, 0)), np.empty(n + 2)
    factors = warm_factors(columns, unknowns, none, none)
    scratch = np.empty((1, n + 2))
    residual_with(problem, factors, grid.x, grid.step, grid.face_step, kernel, unknowns, load, out, scratch)
    gap = np.asarray(film(grid.x, kernel, unknowns))
    pressure = np.maximum(node_pressure(unknowns), 0.0)
    mass = density(problem.isotherm, pressure)[0] * _thinned(problem, rises) * gap
    return _State(grid, kernel, rises, columns, equations, out, gap, mass)


def _at_nodes(faces: FloatArray) -> FloatArray:
    """Means of two faces at the nodes between them; the nearest face at the ends."""
    return np.concatenate([faces[:1], 0.5 * (faces[1:] + faces[:-1]), faces[-1:]])


def _thinned(problem: LineProblem, rises: FloatArray) -> FloatArray:
    """Mean density across the film at the nodes over that at the temperature of the surfaces."""
    return 1.0 + problem.heat.density_slope * _at_nodes(rises @ WEIGHTS)


@dataclass(frozen=True)
class WarmLinearisation:
    """Film compliance and loss of a film with temperatures, in the limit of slow motion.

    Attributes
    ----------
    response : Response or None
        None where the film has no linear response: its matrix is singular.
    balance : float
        Heat into the walls and out with the oil less the heat that shear and compression make, over the heat of shear.
    """

    response: Response | None
    balance: float

    @property
    def singular(self) -> bool:
        """Whether the film has no linear response."""
        return self.response is None

    def slow_response(self) -> Response:
        """Film compliance and loss."""
        assert self.response is not None
        return self.response


def warm_linearised(
    problem: LineProblem,
    grid: Grid,
    unknowns: FloatArray,
    rises: FloatArray,
    first: int,
    load: float,
    neighbour: Neighbour | None = None,
) -> WarmLinearisation:
    """Response of a converged film with its temperatures.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    grid : Grid
        The grid of the solution.
    unknowns : ndarray, shape (n + 2,)
        Converged unknowns.
    rises : ndarray, shape (n, k)
        Temperatures [K above T_0].
    first : int
        Last column that is not heated.
    load : float
        Integral of the dimensionless pressure.
    neighbour : Neighbour, optional
        Needed where the grid has a spike term: the grid then follows the spike.
    """
    here = _state(problem, grid, unknowns, rises, first, load)
    n, columns, x, kernel = grid.face.size, here.columns, grid.x, here.kernel
    by_unknowns, mobility_rows, carriage_rows = followed(
        here.equations, columns, x, grid.face_step, kernel, unknowns, first, False, np.empty(0)
    )
    factors = warm_factors(columns, unknowns, mobility_rows, carriage_rows)
    size = n + 2
    total = size + (neighbour is not None)
    matrix, jacobian, out = np.zeros((total, total)), np.empty((size, size)), np.empty(size)
    residual_with(problem, factors, x, grid.step, grid.face_step, kernel, unknowns, load, out, jacobian)
    matrix[:size, :size] = jacobian
    carried = np.asarray(carried_mass(here.mass))
    faces = np.asarray(face_films(here.gap))
    grid_mass, grid_rises, grid_films = np.zeros(n + 1), np.zeros_like(here.rises), np.zeros(n)
    face_move = np.zeros(n)
    if neighbour is not None:
        moved = _state(problem, neighbour.grid, unknowns, here.rises, first, load)
        face_move = (neighbour.grid.face - grid.face) / neighbour.shift
        matrix[:size, size] = (moved.residual - out) / neighbour.shift
        matrix[size, neighbour.node - 1] = 1.0
        stored, now = (np.asarray(accumulated(s.mass * s.grid.step)) for s in (moved, here))
        grid_mass = (stored - now) / neighbour.shift - carried * np.append(face_move, 0.0)
        grid_rises = (moved.rises - here.rises) / neighbour.shift
        grid_films = (np.asarray(face_films(moved.gap)) - faces) / neighbour.shift
    scale = 1.0 / np.max(np.abs(matrix), axis=1)
    balance = _balance(problem, here, first)
    if not np.all(np.isfinite(matrix)):
        return WarmLinearisation(None, balance)
    lu = lu_factor(matrix * scale[:, None])
    if not np.all(np.diagonal(lu[0])):
        return WarmLinearisation(None, balance)
    unit = np.zeros(total)
    unit[n + 1] = 1.0
    static = lu_solve(lu, scale * unit)
    shift = static[size] if neighbour is not None else 0.0
    following = (by_unknowns.reshape(n * POINTS, size) @ static[:size]).reshape(n, POINTS)
    rate = following + grid_rises * shift
    # mass
    pressure = np.maximum(node_pressure(unknowns), 0.0)
    rho, rho_slope = density(problem.isotherm, pressure)
    thinned = _thinned(problem, here.rises)
    oil = StoredOil(rho * thinned * grid.step, rho_slope * thinned * here.gap * grid.step)
    mass_rate = np.asarray(stored_mass_rate(oil, x, kernel, float(unknowns[n]), static[:size]))
    warming = problem.heat.density_slope * _at_nodes(following @ WEIGHTS)
    mass_rate = mass_rate + np.asarray(accumulated(rho * warming * here.gap * grid.step))
    mass_rate = mass_rate - carried * static[n] + grid_mass * shift
    added = np.zeros(total)
    added[:n], added[n] = -mass_rate[:n], mass_rate[n]
    # heat
    pressure_rate = 0.5 * np.diff(node_pressure(static[:size])) + node_pressure(static[:size])[:-1]
    gap_rate = static[n + 1] + (unknowns[n] + x) * static[n] - kernel @ node_pressure(static[:size])
    film_rate = np.asarray(face_films(gap_rate)) + grid_films * shift
    moving = static[n] + face_move * shift
    stored_heat = _stored_heat(problem, here, first, rate, pressure_rate, film_rate, moving, added[:n])
    right, none = -stored_heat[:, :, None], np.zeros((2, n, 1))
    extra = marched(here.equations, columns.place[:, 1].copy(), right, none, first)[:, :, 0]
    changed = _with(factors, columns, extra)
    other, scratch = np.empty(size), np.empty((1, size))
    residual_with(problem, changed, x, grid.step, grid.face_step, kernel, unknowns, load, other, scratch)
    added[:size] += other - out
    slow = lu_solve(lu, -scale * added)
    return WarmLinearisation(Response(-float(static[n + 1]) - DRY_COMPLIANCE, float(slow[n + 1])), balance)


def _with(factors: Factors, columns: Columns, rises: FloatArray) -> Factors:
    """Factors with small changes of the temperatures, to first order."""
    none = np.empty((0, 0))
    return factors._replace(
        slope=factors.slope + np.sum(columns.mobility_warm * rises, axis=1),
        carriage=factors.carriage + np.sum(columns.carriage_warm * rises, axis=1),
        mobility_rows=none,
        carriage_rows=none,
    )


def _stored_heat(
    problem: LineProblem,
    here: _State,
    first: int,
    rate: FloatArray,
    pressure_rate: FloatArray,
    film_rate: FloatArray,
    moving: FloatArray,
    flow_rate: FloatArray,
) -> FloatArray:
    """What slow storage adds to the energy of each height, shape (n, k).

    Rates are those of faces that move with `moving`; `flow_rate` is what comes to the flow through each face.
    """
    heat, columns, step = problem.heat, here.columns, here.grid.face_step
    faces, gradient = columns.place[:, 1], columns.place[:, 2]
    n = faces.size

    def along(values: FloatArray) -> FloatArray:
        """Derivative by X at the faces."""
        slope = np.zeros_like(values)
        slope[1:-1] = 0.5 * (values[2:] - values[:-2])
        slope[-1] = values[-1] - values[-2]
        return (slope.T / step).T

    still = rate - moving[:, None] * along(here.rises)
    rho = columns.density
    rho_rate = columns.density_slope * pressure_rate[:, None] + columns.density_warm[:, None] * rate
    below = faces[:, None] * (rho @ INTEGRAL.T)
    below_rate = film_rate[:, None] * (rho @ INTEGRAL.T) + faces[:, None] * (rho_rate @ INTEGRAL.T)
    below_rate = below_rate - moving[:, None] * along(below)
    lean = here.rises @ SLOPE.T
    warm = heat.temperature + here.rises
    added = heat.convection * (faces[:, None] ** 2 * rho * still - faces[:, None] * below_rate * lean)
    squeezed = heat.compression * faces**2 * (pressure_rate - moving * gradient)
    added += squeezed[:, None] * warm * columns.density_warm[:, None] / rho
    for g in range(3):
        earlier = np.concatenate([np.zeros(g), flow_rate[: n - g]])
        added += here.equations.slopes[:, g, 3, :] * earlier[:, None]
    late = wall_weights(here.grid.face, first)[1]
    for side, row in ((0, 0), (1, POINTS - 1)):
        sign = 1.0 if side == 0 else -1.0
        speed = 1.0 + (side - 0.5) * problem.slide
        flux = here.equations.flux[side]
        flux_rate = sign * (rate @ SLOPE[row]) / faces - flux * film_rate / faces - moving * along(flux)
        flux_rate[: first + 1] = 0.0
        taken = (heat.lower, heat.upper)[side]
        added[:, row] = taken / speed * (late @ flux_rate) if speed > SLOWEST_WALL else 0.0
    added[: first + 1] = 0.0
    return np.ascontiguousarray(added)


def _balance(problem: LineProblem, here: _State, first: int) -> float:
    """Heat into the walls and out with the oil less heat made, over the heat of shear."""
    heat, columns = problem.heat, here.columns
    faces, step, rises = columns.place[:, 1], here.grid.face_step, here.rises
    on = slice(first + 1, None)
    shear = heat.dissipation * (faces * step * (columns.heat @ WEIGHTS))[on].sum()
    warm = (heat.temperature + rises) * columns.density_warm[:, None] / columns.density**2 * columns.flow
    pressed = -heat.compression * (columns.place[:, 2] * step * (warm @ WEIGHTS))[on].sum()
    walls = float(np.sum(here.equations.flux[:, on] * step[on]))
    leaves = (1.5 * columns.flow[-1] - 0.5 * columns.flow[-2]) * (1.5 * rises[-1] - 0.5 * rises[-2])
    # what flows back out of the first heated column
    enters = np.minimum(1.5 * columns.flow[first] - 0.5 * columns.flow[first - 1], 0.0)
    enters = enters * (1.5 * rises[first + 1] - 0.5 * rises[first + 2])
    carried = heat.convection * float((leaves - enters) @ WEIGHTS)
    return float((walls + carried - shear - pressed) / shear)
