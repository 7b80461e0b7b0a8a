"""Heat in the surfaces of a contact: moving half-spaces, warmed by what flows into them.

T(X) = T_0 + B Int q(S)/sqrt(X - S) dS        J. C. Jaeger, Proc. R. Soc. NSW 76, 1942, 203-224

Full Newton for a film with its temperatures, which follow the film's unknowns by their own equations.

Nothing here is compiled: numba compiles what a function calls once more with it, and these call all that is large.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.dense import factorised, solved
from ehdmaps.ehl.energy import EnergyEquations, energy, followed, marched
from ehdmaps.ehl.newton import CONVERGED, DIVERGED, SOFT_ABOVE, STAGNATED, YIELDING_STEP, lifted, relaxed, step_length
from ehdmaps.ehl.newton import step_size as size_of
from ehdmaps.ehl.reynolds import Factors, LineProblem, film, node_pressure, residual_with
from ehdmaps.ehl.warm_column import (
    Columns,
    asked_flows,
    empty_columns,
    fill_columns,
    first_column,
    hold_gradients,
)
from ehdmaps.physics.rheology import LIMITING


@njit
def wall_weights(x: FloatArray, first: int) -> FloatArray:
    """Matrix of Int q(S)/sqrt(X - S) dS from place `first` on, q linear between places.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Places along the wall [b].
    first : int
        Place before which nothing flows.
    """
    n = x.size
    weights = np.zeros((n, n))
    for i in range(first + 1, n):
        for j in range(first, i):
            far, near = x[i] - x[j], x[i] - x[j + 1]
            if j + 1 == i:
                near = 0.0
            width = far - near
            a, b = math.sqrt(far), math.sqrt(near)
            total = 2.0 * width / (a + b)
            # Int of sqrt(t) dt, and of the distance from the nearer place, without differences of nearly equal numbers
            part = 2.0 / 3.0 * width * (far + a * b + near) / (a + b) - near * total
            weights[i, j] += part / width
            weights[i, j + 1] += total - part / width
    return weights


LOOSE, TIGHT, LITTLE = 0.1, 1e-7, 1e-4
"""Last step of the temperatures for a film that is far from its solution, for one that is near, and the one that leaves
its square [K]."""

JOINT, NEAR = 1.0, 10.0
"""Size of the last step, and its change of a temperature [K], below which film and temperatures move in one step."""

MOST_STEPS = 15
"""Steps of the temperatures of one film."""

SMOOTH, MOST_FROZEN = 0.05, 12
"""Size of the last step from which on temperatures follow, and the steps after which they do at all events."""

LARGEST_RISE = 30.0
"""Largest change of a temperature in one step [K]."""

MOST_RETURNS = 4
"""Halvings of a step after which the film has no temperatures."""


class WarmResult(NamedTuple):
    """Unknowns and temperatures, outcome, Newton steps, last step.

    Attributes
    ----------
    unknowns : ndarray, shape (n + 2,)
        Pressures, flow, exit and height.
    rises : ndarray, shape (n, k)
        Temperatures at the faces [K above T_0].
    first : int
        Last column that is not heated.
    outcome, steps : int
        CONVERGED, STAGNATED or DIVERGED, and Newton steps taken.
    last_step : float
        Size of the last step.
    """

    unknowns: FloatArray
    rises: FloatArray
    first: int
    outcome: int
    steps: int
    last_step: float


def warm_factors(
    columns: Columns,
    unknowns: FloatArray,
    mobility_rows: FloatArray,
    carriage_rows: FloatArray,
    drop: FloatArray | None = None,
) -> Factors:
    """Factors at the faces of a film with temperatures.

    Parameters
    ----------
    columns : Columns
        Columns of the film.
    unknowns : ndarray, shape (n + 2,)
        Unknowns of the film.
    mobility_rows, carriage_rows : ndarray, shape (n, n + 3)
        Derivatives by all unknowns and what else changes them, see `followed`; of no length for the residual alone.
    drop : ndarray, shape (n,), optional
        Steps of pressure of the columns, about which the factors are tangents; those of the film where they are left
        out.
    """
    none = np.empty((0, 0))
    mobility, carriage = columns.mobility[:, 0].copy(), columns.carriage[:, 0].copy()
    if drop is None:
        drop = np.diff(node_pressure(unknowns))
    if mobility_rows.size == 0:
        return Factors(mobility, np.zeros(drop.size), drop, carriage, none, none, mobility_rows, carriage_rows)
    offset, carriage = drop * mobility_rows[:, -1], carriage + carriage_rows[:, -1]
    return Factors(mobility, offset, drop, carriage, none, none, mobility_rows, carriage_rows)


def warm_temperatures(
    problem: LineProblem,
    x: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    walls: FloatArray,
    first: int,
    rises: FloatArray,
    columns: Columns,
    flows: FloatArray,
    tolerance: float,
    most_steps: int,
) -> tuple[EnergyEquations, float]:
    """Temperatures of a film by Newton, from `rises`, which is overwritten: equations there, and the last step [K].

    Parameters
    ----------
    problem, x, face_step, kernel, unknowns
        The arguments of `reynolds.residual`.
    walls : ndarray, shape (n, n)
        Matrix of `wall_heat.wall_weights`.
    first : int
        Last column that is not heated.
    rises : ndarray, shape (n, k)
        Temperatures [K above T_0].
    columns : Columns
        Columns of the film, on return those at its temperatures.
    flows : ndarray, shape (n,)
        Flow that the gradient of a column follows, see `asked_flows`, NaN where it is that of the pressures; of no
        length where it is so everywhere.
    tolerance : float
        Largest last step [K].
    most_steps : int
        Steps at most.
    """
    n, k = rises.shape
    right = np.zeros((n, k + 2, 1))
    last = math.inf
    count = 0
    while True:
        fill_columns(problem, x, face_step, kernel, unknowns, rises, flows, columns)
        equations = energy(problem, columns, face_step, walls, rises, first)
        if not np.all(np.isfinite(equations.residual)):
            return equations, math.inf
        if last <= tolerance or count >= most_steps:
            if flows.size > 0:
                hold_gradients(problem, unknowns[n - 1], rises, columns)
                equations = energy(problem, columns, face_step, walls, rises, first)
            return equations, last
        right[:, :k, 0] = -equations.residual
        move = marched(equations, right, first)[:, :, 0]
        last = np.max(np.abs(move))
        if not math.isfinite(last):
            return equations, math.inf
        part = min(1.0, LARGEST_RISE / max(last, 1e-300))
        rises += part * move
        count += 1


def warm_newton(
    problem: LineProblem,
    x: FloatArray,
    step: FloatArray,
    face: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    start: FloatArray,
    warm_start: FloatArray,
    load: float,
    tolerance: float,
    most_steps: int,
    near: bool,
) -> WarmResult:
    """Solve the discrete contact with its temperatures.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups, those of heat among them.
    x, step, face, face_step : ndarray
        The grid, see `Grid`.
    kernel, start
        The arguments of `newton`.
    warm_start : ndarray, shape (n, k)
        Temperatures to start from [K above T_0].
    load, tolerance, most_steps
        The other arguments of `newton`.
    near : bool
        Whether the start is a solution on the same grid, with its temperatures.
    """
    size = start.size
    n = size - 2
    unknowns = lifted(x, kernel, start)
    rises = warm_start.copy()
    first = first_column(film(x, kernel, unknowns), unknowns[n - 1])
    rises[: first + 1] = 0.0
    walls = wall_weights(face, first)
    k = rises.shape[1]
    columns = empty_columns(n, k)
    out, jacobian = np.empty(size), np.empty((size, size))
    last, relaxation = math.inf, 1.0
    old = np.zeros(n - 1)
    before, warm_before, taken, warming = unknowns, rises, np.zeros(size), np.zeros((n, k))
    frozen, known = not near, near

    def flows() -> FloatArray:
        """Flows that the columns are asked to pass: far from a solution, where the stress hardly depends on them."""
        if problem.shear.form != LIMITING or last <= SOFT_ABOVE:
            return np.empty(0)
        fill_columns(problem, x, face_step, kernel, unknowns, rises, np.empty(0), columns)
        return np.asarray(asked_flows(problem, x, kernel, unknowns, columns))

    def settled(tolerance: float, steps: int = MOST_STEPS) -> tuple[EnergyEquations, float]:
        """Temperatures of these unknowns."""
        return warm_temperatures(
            problem, x, face_step, kernel, unknowns, walls, first, rises, columns, flows(), tolerance, steps
        )

    for count in range(most_steps):
        close = max(TIGHT, min(LOOSE, 0.1 * last))
        equations: EnergyEquations | None = None
        if frozen:
            # from another grid pressures are too rough to heat anything: first with the temperatures as they are
            fill_columns(problem, x, face_step, kernel, unknowns, rises, flows(), columns)
        elif known and (last < JOINT or (near and count == 0)) and np.max(np.abs(warming)) < NEAR:
            # film and temperatures in one step
            equations, left = settled(close, 0)
        else:
            equations, left = settled(close)
            for _ in range(MOST_RETURNS):
                if left <= close or not known:
                    break
                # too far: an oil that yields too much is heated without bound
                taken, warming = 0.5 * taken, 0.5 * warming
                unknowns, rises = before + taken, warm_before + warming
                equations, left = settled(close)
            if not left <= close:
                return WarmResult(unknowns, rises, first, DIVERGED, count, last)
        drop = columns.place[:, 2] * face_step
        following, mobility, carriage = followed(equations, columns, x, face_step, kernel, unknowns, first)
        known = not frozen
        factors = warm_factors(columns, unknowns, mobility, carriage, drop)
        lowest = residual_with(problem, factors, x, step, face_step, kernel, unknowns, load, out, jacobian)
        if not np.all(np.isfinite(out)):
            return WarmResult(unknowns, rises, first, DIVERGED, count, last)
        move = solved(factorised(jacobian), -out)
        last = size_of(unknowns, move)
        if not math.isfinite(last):
            return WarmResult(unknowns, rises, first, DIVERGED, count, last)
        relaxation = relaxed(move, old, relaxation) if last > SOFT_ABOVE else 1.0
        most = min(relaxation, YIELDING_STEP / last) if problem.shear.form == LIMITING else relaxation
        length = step_length(problem, x, kernel, unknowns, move, lowest, most)
        before, warm_before, taken = unknowns, rises, length * move
        warming = (following.reshape((n * k, size + 1)) @ np.append(taken, length)).reshape((n, k))
        warming *= min(1.0, LARGEST_RISE / max(np.max(np.abs(warming)), 1e-300))
        unknowns, rises = before + taken, warm_before + warming
        if frozen and (last < SMOOTH or count == MOST_FROZEN):
            frozen = False
        elif length == 1.0 and last < tolerance:
            # what a step leaves is of the order of its square
            left = float(np.max(np.abs(warming)))
            if left > LITTLE:
                left = settled(LITTLE)[1]
            outcome = CONVERGED if left <= LITTLE else DIVERGED
            return WarmResult(unknowns, rises, first, outcome, count + 1, last)
    return WarmResult(unknowns, rises, first, STAGNATED, most_steps, last)
