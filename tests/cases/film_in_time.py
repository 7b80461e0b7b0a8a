"""The film in time: the nonlinear equations under a load that moves, from a steady solution.

Backward differences of second order in time of the mass between each face and the exit; the first step is of first
order. The grid hangs on the exit of the film, which moves: what a face sweeps is subtracted. It stands still otherwise,
so that it has to resolve the pressure spike wherever that goes: take a solution without spike cells
(`Resolution.spike_steepness`), on a dense grid. Where the exit would run faster than the surfaces carry oil, in fast
unloading, Reynolds' condition has no solution, and the steps end there.

Loads and times are in the units of the starting point: p_H b and b/u.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.dense import factorised, solved
from ehdmaps.ehl.linearisation import accumulated, stored_mass, stored_oil
from ehdmaps.ehl.newton import LOG_VISCOSITY_STEP
from ehdmaps.ehl.profile import Profile
from ehdmaps.ehl.reynolds import LineProblem, film, residual, steepest_viscosity_step

MOST_STEPS = 30
"""Newton steps of one time step after which it counts as failed."""


class Motion(NamedTuple):
    """What a load makes of the film.

    Attributes
    ----------
    height : ndarray, shape (k + 1,)
        H0 at the start and after each step [b^2/R], NaN from a step on that does not converge.
    newton_steps : int
        Newton steps of all time steps together.
    """

    height: FloatArray
    newton_steps: int


def follow(profile: Profile, loads: FloatArray, time_step: float, tolerance: float = 1e-9) -> Motion:
    """Follow the film under loads at equal steps of time.

    Parameters
    ----------
    profile : Profile
        The steady solution to start from.
    loads : ndarray, shape (k,)
        Integral of the pressure after each step [p_H b].
    time_step : float
        [b/u].
    tolerance : float
        Size of Newton's last step, relative to the largest pressure and to film and exit.
    """
    grid = profile.grid
    height, newton_steps = _follow(
        profile.problem,
        grid.x,
        grid.step,
        grid.face_step,
        profile.kernel,
        profile.unknowns,
        np.ascontiguousarray(loads, dtype=float),
        time_step,
        tolerance,
    )
    return Motion(height, newton_steps)


def _follow(
    problem: LineProblem,
    x: FloatArray,
    step: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    steady: FloatArray,
    loads: FloatArray,
    time_step: float,
    tolerance: float,
) -> tuple[FloatArray, int]:
    """H0 after each time step, and Newton steps taken."""
    n = steady.size - 2
    height = np.full(loads.size + 1, np.nan)
    height[0] = steady[n + 1]
    old = steady.copy()
    older = steady.copy()
    mass_old = stored_mass(problem, x, step, kernel, steady)[0]
    mass_older = mass_old.copy()
    total = 0
    for k in range(loads.size):
        # (now, old, older) over the step; a start at rest makes the first one as if it had always been so
        now, before, long_before = (1.5, -2.0, 0.5) if k > 0 else (1.0, -1.0, 0.0)
        mass_before = (before * mass_old + long_before * mass_older) / time_step
        exit_before = (before * old[n] + long_before * older[n]) / time_step
        start = old.copy() if k == 0 else 2.0 * old - older
        start[: n - 1] = np.maximum(start[: n - 1], 0.0)
        found, taken = _one_step(
            problem,
            x,
            step,
            face_step,
            kernel,
            start,
            loads[k],
            now / time_step,
            mass_before,
            exit_before,
            tolerance,
        )
        total += taken
        if taken > MOST_STEPS:
            break
        older, old = old, found
        mass_older, mass_old = mass_old, stored_mass(problem, x, step, kernel, found)[0]
        height[k + 1] = found[n + 1]
    return height, total


@cache
def _accumulation(size: int) -> FloatArray:
    """The matrix of `accumulated`, which is linear."""
    return np.column_stack([accumulated(one) for one in np.eye(size)])


def stored_mass_jacobian(
    problem: LineProblem, x: FloatArray, step: FloatArray, kernel: FloatArray, unknowns: FloatArray
) -> FloatArray:
    """Derivative of `stored_mass`[0] by the unknowns, shape (n + 1, n + 2), on a grid that moves with the exit."""
    n = x.size - 1
    stored = stored_oil(problem, x, step, kernel, unknowns)
    by_pressure = np.diag(stored.by_pressure) - stored.by_film[:, None] * kernel
    columns = np.zeros((n + 1, n + 2))
    columns[:, : n - 1] = by_pressure[:, 1:n]
    columns[:, n] = stored.by_film * (unknowns[n] + x)
    columns[:, n + 1] = stored.by_film
    return np.asarray(_accumulation(n + 1) @ columns)


def _one_step(
    problem: LineProblem,
    x: FloatArray,
    step: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    start: FloatArray,
    load: float,
    rate: float,
    mass_before: FloatArray,
    exit_before: float,
    tolerance: float,
) -> tuple[FloatArray, int]:
    """Newton for one time step: unknowns and steps taken, more than `MOST_STEPS` if it does not converge.

    The matrix lacks how the swept mass changes with the film, which is as small as the exit is slow.
    """
    size = start.size
    n = size - 2
    unknowns = start.copy()
    out = np.empty(size)
    matrix = np.empty((size, size))
    for count in range(MOST_STEPS):
        residual(problem, x, step, face_step, kernel, unknowns, load, out, matrix)
        mass, carried = stored_mass(problem, x, step, kernel, unknowns)
        growth = rate * mass + mass_before - carried * (rate * unknowns[n] + exit_before)
        by_unknowns = rate * stored_mass_jacobian(problem, x, step, kernel, unknowns)
        by_unknowns[:, n] -= rate * carried
        side = np.append(-np.ones(n), 1.0)
        out[: n + 1] += side * growth
        matrix[: n + 1] += side[:, None] * by_unknowns
        move = solved(factorised(matrix), -out)
        peak = max(np.max(unknowns[: n - 1]), 1e-300)
        last = max(
            np.max(np.abs(move[: n - 1])) / peak,
            abs(move[n]) / (1.0 + abs(unknowns[n])),
            abs(move[n + 1]) / (1.0 + abs(unknowns[n + 1])),
        )
        if not math.isfinite(last):
            break
        length = 1.0
        thickening = steepest_viscosity_step(problem, unknowns, move)
        if thickening > LOG_VISCOSITY_STEP:
            length = LOG_VISCOSITY_STEP / thickening
        for _ in range(12):
            trial = unknowns + length * move
            if trial[n - 1] > 0.0 and np.min(film(x, kernel, trial)) > 0.0:
                break
            length *= 0.5
        unknowns = unknowns + length * move
        if length == 1.0 and last < tolerance:
            return unknowns, count + 1
    return unknowns, MOST_STEPS + 1
