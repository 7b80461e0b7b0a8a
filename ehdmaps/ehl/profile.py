"""The converged profile that a solve gives, and how it starts the next one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.grid import DRY_DATUM, Grid, Layout, Spike, moved_across
from ehdmaps.ehl.reynolds import MOST_LOG_VISCOSITY, LineProblem, face_films, film, node_pressure, shear_factors
from ehdmaps.ehl.warm_column import empty_columns, fill_columns
from ehdmaps.physics.films import film_times_rise, rolling_force_of_inlet
from ehdmaps.physics.isotherm import log_viscosity
from ehdmaps.physics.rheology import NEWTONIAN


@dataclass(frozen=True)
class Warmth:
    """Temperatures of a film at the faces of its grid.

    Attributes
    ----------
    rises : ndarray, shape (n, k)
        Temperatures at the Lobatto points across the film, from the lower to the upper wall [K above T_0].
    first : int
        Last face before which nothing is heated.
    """

    rises: FloatArray
    first: int


class Measures(NamedTuple):
    """Numbers that pressure and film at the nodes give, read in one call of compiled code.

    Attributes
    ----------
    central, minimum : float
        Film at X = 0 and smallest film, by parabolas through three nodes [b^2/R].
    rise_integral, plain_integral : float
        Int H dP by `film_times_rise`, and without its terms of fourth order [b^2/R p_H].
    """

    central: float
    minimum: float
    rise_integral: float
    plain_integral: float


@dataclass(frozen=True)
class Profile:
    """A converged discrete solution on its grid."""

    problem: LineProblem
    layout: Layout
    grid: Grid
    kernel: FloatArray
    unknowns: FloatArray
    spike: Spike | None
    warmth: Warmth | None = None

    @property
    def cells(self) -> int:
        """Number of cells."""
        return self.grid.face.size

    @property
    def points(self) -> int:
        """Points across the film; 0 without temperatures."""
        return 0 if self.warmth is None else self.warmth.rises.shape[1]

    @cached_property
    def pressure(self) -> FloatArray:
        """P at the nodes, shape (n + 1,) [p_H]."""
        return np.asarray(node_pressure(self.unknowns))

    @cached_property
    def film(self) -> FloatArray:
        """H at the nodes, shape (n + 1,) [b^2/R]."""
        return np.asarray(film(self.grid.x, self.kernel, self.unknowns))

    @cached_property
    def position(self) -> FloatArray:
        """X of the nodes from the centre of the Hertz contact, shape (n + 1,) [b]."""
        return np.asarray(self.grid.x + self.unknowns[-2])

    @property
    def film_offset(self) -> float:
        """Dry minus lubricated approach [b^2/R]: H0 above the datum of the dry contact."""
        return float(self.unknowns[-1]) - DRY_DATUM

    @property
    def mass_flow(self) -> float:
        """Mass of oil through the contact [b^2/R], over density at rest and speed."""
        return float(self.unknowns[-3])

    @cached_property
    def rolling_force(self) -> float:
        """Int H dP, that of a flooded inlet before the grid included [b^2/R p_H]."""
        inside = self.measures.rise_integral
        if self.layout.starved:
            return inside
        before = rolling_force_of_inlet(
            -float(self.position[0]), float(self.film[0]), self.mass_flow, self.problem.wedge, radius=1.0
        )
        return inside + before

    @cached_property
    def stresses(self) -> tuple[FloatArray, FloatArray]:
        """Mean stress across the film and difference of the stresses at both walls, at the faces, shape (n,)."""
        problem, grid, pressure = self.problem, self.grid, self.pressure
        faces = np.asarray(face_films(self.film))
        rise = 12.0 / problem.wedge * faces * (pressure[1:] - pressure[:-1]) / grid.face_step
        if problem.shear.form == NEWTONIAN and self.warmth is None:
            if problem.slide == 0.0:
                return np.zeros_like(faces), rise
            log_eta = log_viscosity(problem.isotherm, 0.5 * (pressure[1:] + pressure[:-1]))[0]
            return problem.slide * np.exp(np.minimum(log_eta, MOST_LOG_VISCOSITY)) / faces, rise
        if self.warmth is not None:
            columns, nothing = empty_columns(self.cells, self.warmth.rises.shape[1]), np.empty(0)
            fill_columns(
                problem, grid.x, grid.face_step, self.kernel, self.unknowns, self.warmth.rises, nothing, columns
            )
            return columns.stress + 0.5 * rise, rise
        mean = shear_factors(problem, grid.x, grid.face_step, self.kernel, self.unknowns, False)[1]
        return np.asarray(mean), rise

    @property
    def wall_stress(self) -> float:
        """Largest stress at a wall [eta0 u R/b^2]."""
        mean, rise = self.stresses
        return float(np.max(np.abs(mean) + 0.5 * np.abs(rise)))

    @property
    def traction(self) -> float:
        """Integral of the mean stress along the film, of the sign of the slide-to-roll ratio [eta0 u R/b]."""
        return float(self.stresses[0] @ self.grid.face_step)

    @cached_property
    def measures(self) -> Measures:
        """Numbers that are read from pressure and film."""
        return Measures(*_measured(self.pressure, self.position, self.film))

    @cached_property
    def front(self) -> tuple[int, float]:
        """The cell in which the pressure falls fastest behind its maximum, and that fall [p_H/b]."""
        cell, fall = _steepest(self.grid.x, self.pressure)
        return cell, fall

    @property
    def front_cell(self) -> int:
        """The cell in which the pressure falls fastest behind its maximum."""
        return self.front[0]

    @property
    def fourth_order_share(self) -> float:
        """Change of the rolling force by the terms of fourth order, as a share of it."""
        return abs(self.measures.plain_integral - self.measures.rise_integral) / self.rolling_force


_film_times_rise = njit(film_times_rise)


@njit
def _steepest(x: FloatArray, pressure: FloatArray) -> tuple[int, float]:
    """Cell of the fastest fall of pressure behind its maximum, and that fall."""
    top = int(np.argmax(pressure))
    cell, steepness = top, -np.inf
    for i in range(top, x.size - 1):
        fall = (pressure[i] - pressure[i + 1]) / (x[i + 1] - x[i])
        if fall > steepness:
            cell, steepness = i, fall
    return cell, steepness


@njit
def _measured(pressure: FloatArray, position: FloatArray, gap: FloatArray) -> tuple[float, float, float, float]:
    """The fields of `Measures`."""
    last = gap.size - 2
    plain = 0.0
    for i in range(last + 1):
        plain += 0.5 * (gap[i + 1] + gap[i]) * (pressure[i + 1] - pressure[i])
    centre = min(max(int(np.argmin(np.abs(position))), 1), last)
    value, slope, curvature = _parabola(position, gap, centre)
    away = -position[centre]
    central = value + slope * away + 0.5 * curvature * away * away
    value, slope, curvature = _parabola(position, gap, min(max(int(np.argmin(gap)), 1), last))
    minimum = value - 0.5 * slope * slope / curvature if curvature > 0.0 else value
    return central, minimum, _film_times_rise(gap, pressure), plain


def front(profile: Profile) -> tuple[float, float]:
    """Place where the pressure falls fastest behind its maximum, relative to the exit [b], and that slope [p_H/b]."""
    cell, fall = profile.front
    return float(profile.grid.face[cell]), fall


def front_node(profile: Profile) -> int:
    """The node half-way down the front."""
    pressure, cell = profile.pressure, profile.front_cell
    around = 0.5 * (pressure[max(cell - 1, 0)] + pressure[min(cell + 2, pressure.size - 1)])
    node = cell if abs(pressure[cell] - around) < abs(pressure[cell + 1] - around) else cell + 1
    return min(max(node, 1), pressure.size - 2)


@njit
def _parabola(x: FloatArray, y: FloatArray, i: int) -> tuple[float, float, float]:
    """Value, slope and second derivative at node i of the parabola through nodes i-1, i, i+1."""
    left, right = x[i] - x[i - 1], x[i + 1] - x[i]
    down, up = (y[i] - y[i - 1]) / left, (y[i + 1] - y[i]) / right
    curvature = 2.0 * (up - down) / (left + right)
    return y[i], (down * right + up * left) / (left + right), curvature


def warm_start(profile: Profile | None, grid: Grid, points: int) -> FloatArray:
    """Temperatures of a solution nearby at the faces of another grid, shape (n, k); zero where it has none.

    Parameters
    ----------
    profile : Profile or None
        Solution nearby.
    grid : Grid
        The other grid.
    points : int
        Number k of points across the film.
    """
    rises = np.zeros((grid.face.size, points))
    if profile is not None and profile.warmth is not None:
        known = moved_across(profile.warmth.rises, points)
        for k in range(points):
            rises[:, k] = np.interp(grid.face, profile.grid.face, known[:, k])
    return rises


def moved(profile: Profile, grid: Grid, by_index: bool) -> FloatArray:
    """Start on another grid from a solution nearby, at the same places or at the same share of the nodes.

    What differs from the Hertz pressure is interpolated.

    Parameters
    ----------
    profile : Profile
        Solution nearby, on its own grid.
    grid : Grid
        Grid of the start.
    by_index : bool
        True: at the same share of the nodes; False: at the same places.
    """
    if by_index:
        place = np.arange(float(grid.x.size)) * (profile.cells / grid.face.size)
        old = np.arange(profile.cells + 1.0)
    else:
        place, old = grid.x, profile.grid.x
    return np.asarray(_moved(profile.grid.x, profile.pressure, profile.unknowns, grid.x, place, old))


@njit
def _moved(
    x: FloatArray, pressure: FloatArray, unknowns: FloatArray, new_x: FloatArray, place: FloatArray, old: FloatArray
) -> FloatArray:
    """Start at new nodes: what differs from the Hertz pressure at the old ones is interpolated over places of both."""
    exit_at = unknowns[-2]
    excess = np.empty(x.size)
    for i in range(x.size):
        excess[i] = pressure[i] - _hertz(x[i] + exit_at)
    return _started(np.interp(place, old, excess), new_x, unknowns)


@njit
def _started(excess: FloatArray, x: FloatArray, unknowns: FloatArray) -> FloatArray:
    """Unknowns of a start from what differs from the Hertz pressure at the nodes; the last three as they were."""
    n = x.size - 1
    start = np.empty(n + 2)
    for i in range(1, n):
        start[i - 1] = max(excess[i] + _hertz(x[i] + unknowns[-2]), 0.0)
    for i in range(3):
        start[n - 1 + i] = unknowns[unknowns.size - 3 + i]
    return start


def starved_start(profile: Profile, grid: Grid) -> FloatArray:
    """Start on a starved grid at the same places.

    Without a spike by monotone cubics: a kink of the pressure spoils the derivative of the flow by the film, and Newton
    misses a thick film for it. The pressure that the profile has where the grid begins is taken away in the shape of a
    cubic that ends at the exit.

    Parameters
    ----------
    profile : Profile
        Solution nearby, on its own grid.
    grid : Grid
        Grid of the start.
    """
    if profile.spike is not None:
        return moved(profile, grid, by_index=False)
    pressure = _monotone(profile.grid.x, profile.pressure, np.maximum(grid.x, profile.grid.x[0]))
    pressure -= pressure[0] * (grid.x / grid.x[0]) ** 3
    return np.concatenate([np.maximum(pressure[1:-1], 0.0), profile.unknowns[-3:]])


def _monotone(x: FloatArray, y: FloatArray, at: FloatArray) -> FloatArray:
    """Cubics that rise and fall no more than the points do, level at the last one.

    Slopes are harmonic means of those of both sides (F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5, 1984,
    300-304). scipy has the same, and takes long to import.
    """
    step = np.diff(x)
    rise = np.diff(y) / step
    slope = np.zeros_like(y)
    slope[0] = rise[0]
    before, after = 2.0 * step[1:] + step[:-1], step[1:] + 2.0 * step[:-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (before + after) / (before / rise[:-1] + after / rise[1:])
    slope[1:-1] = np.where(rise[:-1] * rise[1:] > 0.0, mean, 0.0)
    cell = np.clip(np.searchsorted(x, at, side="right") - 1, 0, step.size - 1)
    width, part = step[cell], (at - x[cell]) / step[cell]
    rest = 1.0 - part
    bent = width * (slope[cell] * rest - slope[cell + 1] * part)
    curve: FloatArray = rest * rest * (1.0 + 2.0 * part) * y[cell] + part * part * (3.0 - 2.0 * part) * y[cell + 1]
    return curve + part * rest * bent


def refined(coarse: Profile, grid: Grid) -> FloatArray:
    """Start on the grid with twice the cells: old nodes stay, new ones by cubic interpolation in the index."""
    return np.asarray(_refined(coarse.grid.x, coarse.pressure, coarse.unknowns, grid.x))


@njit
def _refined(x: FloatArray, pressure: FloatArray, unknowns: FloatArray, new_x: FloatArray) -> FloatArray:
    """The same in arrays."""
    n, exit_at = x.size, unknowns[-2]
    new = np.empty(2 * n - 1)
    for i in range(n):
        new[2 * i] = pressure[i] - _hertz(x[i] + exit_at)
    for i in range(n - 1):
        left, right = new[2 * i], new[2 * i + 2]
        new[2 * i + 1] = 0.5 * (left + right)
        if 0 < i < n - 2:
            cubic = (9.0 * (left + right) - new[2 * i - 2] - new[2 * i + 4]) / 16.0
            if min(left, right) < cubic < max(left, right):
                new[2 * i + 1] = cubic
    return _started(new, new_x, unknowns)


@njit
def _hertz(position: float) -> float:
    """Pressure of the dry contact."""
    return math.sqrt(max(0.0, 1.0 - position * position))
