"""Newton for a point contact: dense Jacobian, and nodes that cavitate chosen anew in each step.

A node has either no pressure and an outflow, or a pressure and a balance (Reynolds' condition at the exit). Which of
the two is asked of the pressure that its own equation alone would give it: the semi-smooth form of the complementarity,
whose steps end as fast as Newton's. Steps are limited in ln(eta), and leave a part of the film.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.physics.solution import Status
from ehdmaps.point.equations import Equations, Factors, own_slopes
from ehdmaps.point.grid import PointGrid
from ehdmaps.point.problem import FilmProblem, PointProblem, start_film
from ehdmaps.point.reynolds import Balance, balance, changed

TOLERANCE = 1e-5
"""Size of the last full step that ends a solve: pressures by their largest, films by the film."""

NEAR = 0.03
"""Size of a full step, measured likewise, after which its factors serve the next one too."""

STEP_LEFT = 1e-4
"""What a solve with factors of another step leaves of a step."""

LOG_VISCOSITY_STEP = 5.0
"""Largest change of ln(eta) in one step."""

MOST_OF_FILM = 0.7
"""Largest part of the film that a step may take away."""

LEAST_STEP = 1e-3
"""Part of a step below which a solve ends: a film that the grid cannot carry closes."""

MOST_STEPS = 150
"""Steps after which a solve ends. At L of 60 the limit in ln(eta) makes them short, and up to a hundred are needed."""

_MOST_ABOUT = 0.1
"""Largest pressure of a rigid paraboloid that a start takes: solids give way to higher ones [p_H]."""

_LEAST_FILM = 1e-4
"""Film to which a start is lifted that touches, over that of the start's guess."""


@dataclass(frozen=True, eq=False)
class PointState:
    """Pressures and film on a grid, with what the last step knew of them.

    Attributes
    ----------
    problem : FilmProblem
        What was solved.
    grid : PointGrid
        Grid of the state.
    pressure, film : ndarray, shape (n, m)
        P and H.
    height : float
        H0.
    status : Status
        CONVERGED, STAGNATED or DIVERGED.
    steps : int
        Newton steps.
    free : ndarray of bool, shape (n, m)
        Nodes with a pressure.
    equations : Equations or None
        Equations of the last step; None where there is none.
    factors : Factors or None
        Factors of them, or of a step nearby.
    """

    problem: FilmProblem
    grid: PointGrid
    pressure: FloatArray
    film: FloatArray
    height: float
    status: Status
    steps: int
    free: BoolArray
    equations: Equations | None
    factors: Factors | None

    @property
    def datum(self) -> float:
        """H0 less the deflection of the contact by the tail outside of the grid, which `height` contains."""
        return self.height - self.problem.wedge * self.grid.elasticity * self.grid.tail.deflection


def newton(problem: FilmProblem, grid: PointGrid, pressure: FloatArray, height: float) -> PointState:
    """Solve a contact on a grid from a start.

    Parameters
    ----------
    problem : FilmProblem
        The contact.
    grid : PointGrid
        The grid.
    pressure : ndarray, shape (n, m)
        Pressures to start from, >= 0.
    height : float
        H0 to start from.
    """
    pressure, wedge, peak = pressure.copy(), problem.wedge, float(np.max(pressure))
    free, equations, factors, near = (pressure > 0.0) | grid.tail.far, None, None, False
    status, steps = Status.STAGNATED, 0
    film = grid.deflection(pressure) + grid.parabola + height
    for _ in range(MOST_STEPS):
        steps += 1
        lowest = float(np.min(film))
        if not math.isfinite(lowest):
            status = Status.DIVERGED
            break
        if lowest <= 0.0:
            lift = _LEAST_FILM - lowest
            height, film = height + lift, film + lift
        found = balance(grid.x, grid.y, pressure, film, wedge, problem.isotherm, grid.tail.far, grid.tail.rolling)
        before, free = free, _with_pressure(grid, found, pressure)
        tail, tail_slope = grid.tail.loads(height)
        drop = np.where(free, 0.0, -pressure)
        right = np.empty(np.count_nonzero(free) + 1)
        missing = found.residual + (changed(found, drop, grid.deflection(drop)) if np.any(drop) else 0.0)
        right[:-1] = -missing[free]
        right[-1] = problem.load - float(np.sum(grid.weights * (pressure + drop))) - wedge * tail
        equations = Equations(grid, found, free, wedge * tail_slope)
        move = equations.solved(right, factors, STEP_LEFT) if factors is not None and near else None
        if move is None:
            factors = equations.factorised()
            if factors is None:
                status = Status.DIVERGED
                break
            move = factors.solved(right)
        step = drop
        step[free] = move[:-1]
        if not np.all(np.isfinite(move)):
            status = Status.DIVERGED
            break
        change = grid.deflection(step) + move[-1]
        length, size = _length(step, change, film, found), float(np.max(np.abs(step))) / peak
        if length < LEAST_STEP:
            break
        pressure = pressure + length * step
        if length == 1.0:
            pressure[~free] = 0.0
        height += length * float(move[-1])
        if float(np.min(pressure)) < 0.0:
            pressure = np.maximum(pressure, 0.0)
            after = grid.deflection(pressure) + grid.parabola + height
        else:
            after = film + length * change
        peak = max(float(np.max(pressure)), 1e-300)
        thickness = float(np.max(np.abs(change[free] / film[free])))
        film = after
        near = length == 1.0 and max(size, thickness) < NEAR
        if length == 1.0 and max(size, thickness) < TOLERANCE and np.array_equal(free, before):
            status = Status.CONVERGED
            break
    return PointState(problem, grid, pressure, film, height, status, steps, free, equations, factors)


def starts(problem: PointProblem, grid: PointGrid, thickness: tuple[float, ...]) -> Iterator[tuple[FloatArray, float]]:
    """Pressures to start from, each with a film of so many times what a formula gives, and its H0.

    Parameters
    ----------
    problem : PointProblem
        The contact.
    grid : PointGrid
        The grid.
    thickness : tuple of float
        Factors on the film.
    """
    for factor in thickness:
        yield start_about(problem, grid, grid.hertz_pressure(), factor * start_film(problem))


def start_about(problem: FilmProblem, grid: PointGrid, dry: FloatArray, film: float) -> tuple[FloatArray, float]:
    """Pressures to start from by those of the dry contact, and H0.

    About the contact they are those of a rigid paraboloid in the gap that the dry ones leave, so that nearly all nodes
    with a pressure have one from the first step on.

    Parameters
    ----------
    problem : FilmProblem
        The contact.
    grid : PointGrid
        The grid.
    dry : ndarray, shape (n, m)
        Pressures of the dry contact.
    film : float
        Film to start with [a^2/Rx].
    """
    gap = grid.deflection(dry) + grid.parabola
    inside, unknown = dry > 0.0, grid.inner | grid.tail.far
    touching = float(np.min(gap[inside]))
    about = problem.wedge * grid.tail.about / np.maximum(gap - touching + film, film) ** 2
    pressure = np.where(unknown, np.maximum(dry, np.minimum(about, _MOST_ABOUT)), 0.0)
    return pressure, film - float(np.min((grid.deflection(pressure) + grid.parabola)[inside]))


def _with_pressure(grid: PointGrid, found: Balance, pressure: FloatArray) -> BoolArray:
    """Nodes to which their own equation, all others held, gives a pressure; and those of the far tail."""
    asked = pressure - found.residual / own_slopes(grid, found)
    return np.asarray((grid.inner & (asked > 0.0)) | grid.tail.far)


def _length(step: FloatArray, change: FloatArray, film: FloatArray, found: Balance) -> float:
    """Part of a step that may be taken."""
    length = 1.0
    thickening = float(np.max(np.abs(step) * found.viscosity_slope))
    if thickening > LOG_VISCOSITY_STEP:
        length = LOG_VISCOSITY_STEP / thickening
    taken = float(np.max(-change / film))
    return min(length, MOST_OF_FILM / taken) if taken * length > MOST_OF_FILM else length
