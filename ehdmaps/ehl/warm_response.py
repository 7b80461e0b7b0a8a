"""Linear response of a film with temperatures: these follow the film, and oil and surfaces store heat.

As in `linearisation` the spike's place is an unknown besides. What motion adds to the equations is what the film
stores: mass between each face and the exit, heat in the oil, and heat in the surfaces. A surface remembers,
(d/dX + 1/U d/dT)^(1/2) T = q; to the first order in d/dT, which is exact of slow motion and bounded of any,

    T + 1/(2 U) Int dT/dT dS = that of the steady source

The response to slow motion is that of the first order in the frequency; the others are those of the Krylov space of
`spectrum`, with the temperatures among the unknowns.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.dense import Factorised, factorised, solved
from ehdmaps.ehl.energy import EnergyEquations, followed, marched, stored
from ehdmaps.ehl.grid import Grid, log_kernel
from ehdmaps.ehl.linearisation import Neighbour, Response, StoredOil, accumulated, carried_mass, stored_mass_rate
from ehdmaps.ehl.reynolds import Factors, LineProblem, face_films, film, node_pressure, residual_with
from ehdmaps.ehl.spectrum import FilmSpace, arnoldi
from ehdmaps.ehl.warm_column import Columns, empty_columns
from ehdmaps.ehl.warm_newton import MOST_STEPS, wall_weights, warm_factors, warm_temperatures
from ehdmaps.physics.hertz import DRY_COMPLIANCE
from ehdmaps.physics.isotherm import density

EXACT = 1e-4
"""Last step of temperatures that are differenced [K]: what it leaves is of the order of its square."""

LEAST_RISE = 1e-3
"""Least unit of temperatures in a state [K]."""

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
    columns, rises = empty_columns(n, rises.shape[1]), rises.copy()
    walls = wall_weights(grid.face, first)
    equations, _ = warm_temperatures(
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
    return 1.0 + problem.heat.density_slope * _at_nodes(rises @ problem.heat.across.weights)


@dataclass(frozen=True)
class _Grid:
    """Effect of a shift of the grid's spike: derivatives by the shift.

    Attributes
    ----------
    face : ndarray, shape (n,)
        Places of the faces.
    mass : ndarray, shape (n + 1,)
        Stored mass, as faces see it that move.
    rises, films : ndarray, shapes (n, k) and (n,)
        Temperatures and films at the faces.
    """

    face: FloatArray
    mass: FloatArray
    rises: FloatArray
    films: FloatArray


@dataclass(frozen=True)
class WarmLinearisation:
    """The transient equations of a film with temperatures to first order: matrix z + storage(dz/dT) = unit dW.

    The state z has the unknowns of the film, the spike's place where the grid follows it, and the temperatures at the
    faces in units of `warmest`.

    Attributes
    ----------
    balance : float
        Heat into the walls and out with the oil less the heat that shear and compression make, over the heat of shear.
    """

    problem: LineProblem
    unknowns: FloatArray
    first: int
    here: _State
    factors: Factors
    following: FloatArray
    by_grid: _Grid | None
    lu: Factorised
    warmest: float
    balance: float

    @property
    def singular(self) -> bool:
        """True where the film has no linear response: a pivot of its matrix is zero to the rounding of the numbers."""
        return self.lu.singular

    @property
    def height(self) -> int:
        """Index of H0 in the state."""
        return self.unknowns.size - 1

    @property
    def rows(self) -> int:
        """Number of unknowns but for the temperatures."""
        return self.lu.scale.size

    def solve(self, right: FloatArray, heat: FloatArray) -> FloatArray:
        """State of the equations without storage.

        Parameters
        ----------
        right : ndarray, shape (rows,)
            Right-hand side of the film's equations.
        heat : ndarray, shape (n, k + 2, 1)
            That of the temperatures and fluxes, see `warm_march.marched`.
        """
        here, size = self.here, self.unknowns.size
        extra = marched(here.equations, heat, self.first)[:, :, 0]
        right = right.copy()
        right[:size] -= self._moved_by(extra)
        film_part = np.asarray(solved(self.lu, right))
        rises = extra + (self.following.reshape(-1, size) @ film_part[:size]).reshape(extra.shape)
        if self.by_grid is not None:
            rises = rises + self.by_grid.rises * film_part[size]
        return np.concatenate([film_part, rises.ravel() / self.warmest])

    def _moved_by(self, rises: FloatArray) -> FloatArray:
        """Change of the film's residual by small changes of the temperatures, shape (n + 2,)."""
        here, columns = self.here, self.here.columns
        none = np.empty((0, 0))
        changed = self.factors._replace(
            slope=self.factors.slope + np.sum(columns.mobility_warm * rises, axis=1),
            carriage=self.factors.carriage + np.sum(columns.carriage_warm * rises, axis=1),
            mobility_rows=none,
            carriage_rows=none,
        )
        size, grid = self.unknowns.size, here.grid
        other, scratch = np.empty(size), np.empty((1, size))
        residual_with(
            self.problem, changed, grid.x, grid.step, grid.face_step, here.kernel, self.unknowns, 0.0, other, scratch
        )
        other[:-1] -= here.residual[:-1]
        other[-1] = 0.0
        return other

    def storage(self, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Contribution of the rate of a state to the equations: to those of the film, shape (rows,), and to the heat.

        The latter, shape (n, k + 2, 1), is that of the other side, as `solve` takes it.
        """
        problem, here, unknowns = self.problem, self.here, self.unknowns
        grid, columns, n = here.grid, here.columns, here.grid.face.size
        rate, rises = state[: unknowns.size], self.warmest * state[self.rows :].reshape(n, -1)
        shift = float(state[unknowns.size]) if self.by_grid is not None else 0.0
        # mass
        pressure, moved = np.maximum(node_pressure(unknowns), 0.0), node_pressure(rate)
        rho, rho_slope = density(problem.isotherm, pressure)
        thinned = _thinned(problem, here.rises)
        by_hand = StoredOil(rho * thinned * grid.step, rho_slope * thinned * here.gap * grid.step)
        mass = np.asarray(stored_mass_rate(by_hand, grid.x, here.kernel, float(unknowns[n]), rate))
        still = rises if self.by_grid is None else rises - self.by_grid.rises * shift
        warming = problem.heat.density_slope * _at_nodes(still @ problem.heat.across.weights)
        mass = mass + np.asarray(accumulated(rho * warming * here.gap * grid.step))
        mass = mass - np.asarray(carried_mass(here.mass)) * rate[n]
        if self.by_grid is not None:
            mass = mass + self.by_grid.mass * shift
        added = np.zeros(self.rows)
        added[:n], added[n] = -mass[:n], mass[n]
        # heat
        films = np.asarray(face_films(rate[n + 1] + (unknowns[n] + grid.x) * rate[n] - here.kernel @ moved))
        moving = np.full(n, float(rate[n]))
        if self.by_grid is not None:
            films = films + self.by_grid.films * shift
            moving = moving + self.by_grid.face * shift
        cells, warmed = _cell_storage(
            problem, columns, grid.face_step, here.rises, rises, 0.5 * (moved[1:] + moved[:-1]), films, moving
        )
        cells[: self.first + 1] = 0.0
        heat = stored(here.equations, columns, cells)
        for g in range(3):
            flow_rate = np.concatenate([np.zeros(g), added[: n - g]])
            heat[:, :, 0] -= here.equations.slopes[:, g, 3, :] * flow_rate[:, None]
        heat[: self.first + 1] = 0.0
        for side, row in ((0, 0), (1, rises.shape[1] - 1)):
            speed = 1.0 + (side - 0.5) * problem.slide
            if speed > SLOWEST_WALL:
                wall = np.where(np.arange(n) > self.first, warmed[:, row], 0.0)
                heat[:, row, 0] -= 0.5 / speed * _from_inlet(wall, grid.face)
        return added, heat

    def static(self) -> FloatArray:
        """State of a unit load: the film's unknowns, the spike's place where the grid follows it, temperatures."""
        unit = np.zeros(self.rows)
        unit[self.height] = 1.0
        return self.solve(unit, np.zeros((self.here.rises.shape[0], self.here.rises.shape[1] + 2, 1)))

    def _next(self, state: FloatArray) -> FloatArray:
        """State that the storage of another one brings about, T z of `spectrum`."""
        added, heat = self.storage(state)
        return self.solve(added, -heat)

    def slow_response(self) -> Response:
        """Film compliance and loss in the limit of slow motion."""
        static = self.static()
        slow = self._next(static)
        return Response(-float(static[self.height]) - DRY_COMPLIANCE, -float(slow[self.height]))

    def space(self, fastest: float) -> FilmSpace:
        """Return the Krylov space that serves all frequencies up to a highest one.

        Parameters
        ----------
        fastest : float
            Highest Omega = omega b/u.
        """
        return arnoldi(self._next, self.static(), self.height, fastest)


def _from_inlet(values: FloatArray, x: FloatArray) -> FloatArray:
    """Integral from the inlet to each place, by trapezia."""
    pieces = 0.5 * (values[1:] + values[:-1]) * np.diff(x)
    return np.concatenate([[0.0], np.cumsum(pieces)])


@njit
def _along(values: FloatArray, face_step: FloatArray, f: int) -> float:
    """Derivative by X at face f."""
    last = values.size - 1
    if f == 0:
        return 0.0
    if f == last:
        return float((values[last] - values[last - 1]) / face_step[f])
    return float(0.5 * (values[f + 1] - values[f - 1]) / face_step[f])


@njit
def _cell_storage(
    problem: LineProblem,
    columns: Columns,
    face_step: FloatArray,
    rises: FloatArray,
    rate: FloatArray,
    pressure_rate: FloatArray,
    film_rate: FloatArray,
    moving: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Contribution of storage to the energy of each cell, shape (n, k), and rates of the temperatures at standing
    places.

    Rates are those of faces that move with `moving`.
    """
    heat, (n, k) = problem.heat, rises.shape
    across, weights = heat.across, heat.across.weights
    added, still = np.zeros((n, k)), np.empty((n, k))
    for j in range(k):
        mass = columns.density[:, j] * columns.place[:, 1]
        for f in range(n):
            still[f, j] = rate[f, j] - moving[f] * _along(rises[:, j], face_step, f)
            film, gradient = columns.place[f, 1], columns.place[f, 2]
            share = weights[j] * heat.convection * film
            added[f, j] += share * mass[f] * still[f, j]
            squeezed = heat.compression * film * film * (pressure_rate[f] - moving[f] * gradient)
            warm = (heat.temperature + rises[f, j]) * columns.density_warm[f] / columns.density[f, j]
            added[f, j] += weights[j] * squeezed * warm
    for f in range(2, n):
        film = columns.place[f, 1]
        upwards = change = 0.0
        for j in range(k - 1):
            mass = columns.density[:, j] * columns.place[:, 1]
            density_rate = columns.density_slope[f, j] * pressure_rate[f] + columns.density_warm[f] * rate[f, j]
            mass_rate = film_rate[f] * columns.density[f, j] + film * density_rate
            change -= weights[j] * (mass_rate - moving[f] * _along(mass, face_step, f))
            flow = columns.flow[:, j]
            upwards -= weights[j] * (1.5 * flow[f] - 2.0 * flow[f - 1] + 0.5 * flow[f - 2])
            face = 0.0
            for q in range(k):
                face += (across.rising[j, q] if upwards >= 0.0 else across.falling[j, q]) * rises[f, q]
            added[f, j] += heat.convection * film * change * (face - rises[f, j])
            added[f, j + 1] += heat.convection * film * change * (rises[f, j + 1] - face)
    return added, still


def warm_linearised(
    problem: LineProblem,
    grid: Grid,
    unknowns: FloatArray,
    rises: FloatArray,
    first: int,
    load: float,
    neighbour: Neighbour | None = None,
) -> WarmLinearisation:
    """The transient equations to first order about a converged film with its temperatures.

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
    x, kernel = grid.x, here.kernel
    following, mobility_rows, carriage_rows = followed(
        here.equations, here.columns, x, grid.face_step, kernel, unknowns, first
    )
    following = np.ascontiguousarray(following[:, :, :-1])
    factors = warm_factors(here.columns, unknowns, mobility_rows, carriage_rows)
    size = unknowns.size
    total = size + (neighbour is not None)
    matrix, jacobian, out = np.zeros((total, total)), np.empty((size, size)), np.empty(size)
    residual_with(problem, factors, x, grid.step, grid.face_step, kernel, unknowns, load, out, jacobian)
    matrix[:size, :size] = jacobian
    by_grid: _Grid | None = None
    if neighbour is not None:
        moved = _state(problem, neighbour.grid, unknowns, here.rises, first, load)
        matrix[:size, size] = (moved.residual - out) / neighbour.shift
        matrix[size, neighbour.node - 1] = 1.0
        faces = (neighbour.grid.face - grid.face) / neighbour.shift
        after, now = (np.asarray(accumulated(s.mass * s.grid.step)) for s in (moved, here))
        swept = np.asarray(carried_mass(here.mass)) * np.append(faces, 0.0)
        by_grid = _Grid(
            face=faces,
            mass=(after - now) / neighbour.shift - swept,
            rises=(moved.rises - here.rises) / neighbour.shift,
            films=(np.asarray(face_films(moved.gap)) - np.asarray(face_films(here.gap))) / neighbour.shift,
        )
    lu = factorised(matrix)
    warmest = max(float(np.max(here.rises)), LEAST_RISE)
    balance = _balance(problem, here, first)
    return WarmLinearisation(problem, unknowns, first, here, factors, following, by_grid, lu, warmest, balance)


def _balance(problem: LineProblem, here: _State, first: int) -> float:
    """Heat into the walls and out with the oil less heat made, over the heat of shear."""
    heat, columns, weights = problem.heat, here.columns, problem.heat.across.weights
    faces, step, rises = columns.place[:, 1], here.grid.face_step, here.rises
    on = slice(first + 1, None)
    shear = heat.dissipation * (faces * step * (columns.heat @ weights))[on].sum()
    warm = (heat.temperature + rises) * columns.density_warm[:, None] / columns.density**2 * columns.flow
    pressed = -heat.compression * (columns.place[:, 2] * step * (warm @ weights))[on].sum()
    walls = float(np.sum(here.equations.flux[:, on] * step[on]))
    leaves = (1.5 * columns.flow[-1] - 0.5 * columns.flow[-2]) * (1.5 * rises[-1] - 0.5 * rises[-2])
    # what flows back out of the first heated column
    enters = np.minimum(1.5 * columns.flow[first] - 0.5 * columns.flow[first - 1], 0.0)
    enters = enters * (1.5 * rises[first + 1] - 0.5 * rises[first + 2])
    carried = heat.convection * float((leaves - enters) @ weights)
    return float((walls + carried - shear - pressed) / shear)
