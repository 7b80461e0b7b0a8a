"""Newton for a point contact: dense Jacobian, and nodes that cavitate chosen anew in each step.

A node has either no pressure and an outflow, or a pressure and a balance (Reynolds' condition at the exit). Which of
the two is asked of the pressure that its own equation alone would give it: the semi-smooth form of the complementarity,
whose steps end as fast as Newton's. Steps are limited in ln(eta), and leave a part of the film.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.physics.solution import Status
from ehdmaps.point.grid import PointGrid
from ehdmaps.point.problem import PointProblem, start_film
from ehdmaps.point.reynolds import Balance, balance, changed, jacobian

TOLERANCE = 1e-5
"""Size of the last full step that ends a solve: pressures by their largest, films by the film."""

LOG_VISCOSITY_STEP = 5.0
"""Largest change of ln(eta) in one step."""

MOST_OF_FILM = 0.7
"""Largest part of the film that a step may take away."""

LEAST_STEP = 1e-3
"""Part of a step below which a solve ends: a film that the grid cannot carry closes."""

MOST_STEPS = 60

_LEAST_FILM = 1e-4
"""Film to which a start is lifted that touches, over that of the start's guess."""


@dataclass(frozen=True, eq=False)
class Factors:
    """LU factors of the equations of free nodes, rows scaled.

    Attributes
    ----------
    factors : tuple of ndarray
        Factors as `scipy.linalg.lu_factor` gives them.
    scale : ndarray, shape (k + 1,)
        What rows were multiplied by.
    """

    factors: tuple[FloatArray, FloatArray]
    scale: FloatArray

    def solved(self, right: FloatArray) -> FloatArray:
        """Solve for one right-hand side, shape (k + 1,).

        Parameters
        ----------
        right : ndarray, shape (k + 1,)
            Right-hand side: free nodes, then the load.
        """
        return np.asarray(lu_solve(self.factors, right * self.scale, check_finite=False))


@dataclass(frozen=True, eq=False)
class PointState:
    """Pressures and film on a grid, with what the last step knew of them.

    Attributes
    ----------
    problem : PointProblem
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
    found : Balance or None
        Equations of the last step; None where there is none.
    factors : Factors or None
        Their factors.
    """

    problem: PointProblem
    grid: PointGrid
    pressure: FloatArray
    film: FloatArray
    height: float
    status: Status
    steps: int
    free: BoolArray
    found: Balance | None
    factors: Factors | None

    @property
    def datum(self) -> float:
        """H0 less the deflection of the contact by the tail outside of the grid, which `height` contains."""
        return self.height - self.problem.wedge * self.grid.elasticity * self.grid.tail.deflection


def newton(problem: PointProblem, grid: PointGrid, pressure: FloatArray, height: float) -> PointState:
    """Solve a contact on a grid from a start.

    Parameters
    ----------
    problem : PointProblem
        The contact.
    grid : PointGrid
        The grid.
    pressure : ndarray, shape (n, m)
        Pressures to start from, >= 0.
    height : float
        H0 to start from.
    """
    pressure, wedge, peak = pressure.copy(), problem.wedge, float(np.max(pressure))
    free, found, factors = grid.inner, None, None
    status, steps = Status.STAGNATED, 0
    for _ in range(MOST_STEPS):
        steps += 1
        film = grid.deflection(pressure) + grid.parabola + height
        lowest = float(np.min(film))
        if not math.isfinite(lowest):
            status = Status.DIVERGED
            break
        if lowest <= 0.0:
            lift = _LEAST_FILM - lowest
            height, film = height + lift, film + lift
        found = balance(grid.x, grid.y, pressure, film, wedge, problem.isotherm, grid.tail.far, grid.tail.rolling)
        free = _with_pressure(grid, found, pressure)
        tail, tail_slope = grid.tail.loads(height)
        drop = np.where(free, 0.0, -pressure)
        right = np.empty(np.count_nonzero(free) + 1)
        missing = found.residual + (changed(found, drop, grid.deflection(drop)) if np.any(drop) else 0.0)
        right[:-1] = -missing[free]
        right[-1] = problem.load - float(np.sum(grid.weights * (pressure + drop))) - wedge * tail
        factors = factorised(jacobian(found, grid.kernel, free, grid.weights, wedge * tail_slope))
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
        pressure = np.maximum(pressure, 0.0)
        height += length * float(move[-1])
        peak = max(float(np.max(pressure)), 1e-300)
        thickness = float(np.max(np.abs(change[free] / film[free])))
        if length == 1.0 and max(size, thickness) < TOLERANCE:
            status = Status.CONVERGED
            break
    film = grid.deflection(pressure) + grid.parabola + height
    return PointState(problem, grid, pressure, film, height, status, steps, free, found, factors)


def starts(problem: PointProblem, grid: PointGrid, thickness: tuple[float, ...]) -> Iterator[tuple[FloatArray, float]]:
    """Pressures of Hertz, each with a film of so many times what a formula gives, and its H0.

    Parameters
    ----------
    problem : PointProblem
        The contact.
    grid : PointGrid
        The grid.
    thickness : tuple of float
        Factors on the film.
    """
    pressure = grid.hertz_pressure()
    touching = float(np.min((grid.deflection(pressure) + grid.parabola)[pressure > 0.0]))
    for factor in thickness:
        yield pressure, factor * start_film(problem) - touching


def factorised(matrix: FloatArray) -> Factors | None:
    """Factorise a matrix with its rows scaled to a largest entry of one; None where it is singular.

    Parameters
    ----------
    matrix : ndarray, shape (k, k)
        It is overwritten.
    """
    largest = np.max(np.abs(matrix), axis=1)
    if not (np.all(np.isfinite(largest)) and np.all(largest > 0.0)):
        return None
    scale = 1.0 / largest
    matrix *= scale[:, None]
    with warnings.catch_warnings():
        warnings.simplefilter("error", LinAlgWarning)
        try:
            return Factors(lu_factor(matrix, overwrite_a=True, check_finite=False), scale)
        except LinAlgWarning:
            return None


def _with_pressure(grid: PointGrid, found: Balance, pressure: FloatArray) -> BoolArray:
    """Nodes to which their own equation, all others held, gives a pressure; and those of the far tail."""
    own = found.by_pressure[:, :, 0] + found.by_film[:, :, 0] * np.diagonal(grid.kernel).reshape(grid.shape)
    asked = pressure - found.residual / np.maximum(own, 1e-300)
    return np.asarray((grid.inner & (asked > 0.0)) | grid.tail.far)


def _length(step: FloatArray, change: FloatArray, film: FloatArray, found: Balance) -> float:
    """Part of a step that may be taken."""
    length = 1.0
    thickening = float(np.max(np.abs(step) * found.viscosity_slope))
    if thickening > LOG_VISCOSITY_STEP:
        length = LOG_VISCOSITY_STEP / thickening
    taken = float(np.max(-change / film))
    return min(length, MOST_OF_FILM / taken) if taken * length > MOST_OF_FILM else length
