"""Full Newton for the discrete contact: dense Jacobian, rows scaled, steps limited in ln eta, film kept positive.

Full steps of a Newtonian film are followed by chords, which solve with the factors that are there already.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.copies import put
from ehdmaps.ehl.dense import factorised, solved
from ehdmaps.ehl.reynolds import (
    LineProblem,
    film,
    no_factors,
    residual_with,
    shear_factors,
    steepest_viscosity_step,
)
from ehdmaps.physics.rheology import LIMITING, NEWTONIAN

LOG_VISCOSITY_STEP = 5.0
"""Largest change of ln eta in one step."""

EXIT_STEP = 0.3
"""Largest change of the exit's coordinate in one step, of 1 + the coordinate [b]: the grid hangs on the exit."""

LEAST_LEFT = 0.2
"""Part of the smallest film that a step has to leave: the Poiseuille flux goes with the cube of the film."""

MOST_HALVINGS = 15
"""Halvings of a step in search of one that leaves a film."""

LEAST_RELAXATION = 0.1
"""Smallest part of a step that is taken where an oil that yields makes steps turn back and forth."""

TURNED = 0.3
"""Minus the cosine between two steps from which on the second counts as turned back."""

YIELDING_STEP = 0.1
"""Largest step of an oil that yields, in its size as of `step_size`: a pressure that rises over the front of a spike by
more than the oil bears asks for flows of any size."""

SOFT_ABOVE = 1e-4
"""Size of the last step above which the tangents of an oil that yields are soft, see `shear_factors`."""

LARGEST_BEFORE = 0.3
"""Size as which a larger full step counts for the chords behind it: most of such a step is a film that moves as a
whole, of which the equations are linear. A chord takes a tenth to a third of the time of a Newton step."""

CHORDS_FROM = 1e-3
"""Largest tolerance with chords: where the place of a spike is still being looked for, Newton's own steps decide it."""

SHRINKING, MOST_CHORDS = 0.3, 12
"""Part of the step before that a chord may be at most, and chords after one full step, which is counted with them;
where they shrink less, Newton goes on with a matrix anew."""

CONVERGED, STAGNATED, DIVERGED = 0, 1, 2

THICK_START = 0.3
"""Film [b^2/R] above which the cold start is a hump, and no longer Hertz' pressure, which a film of the order of the
dry deformation has lost. As the next two it is a choice: with others Newton finds the same solution in other steps."""

START_ROUNDING, START_DECAY = 0.15, 0.6
"""Where the inlet leaves Hertz' pressure inside of its edge, and the length of the exponential before, both in widths
H^(2/3) of the inlet zone, over which the pressure of a thin film rises."""


class NewtonResult(NamedTuple):
    """Unknowns, outcome (CONVERGED, STAGNATED or DIVERGED), Newton steps without chords, and size of the last step."""

    unknowns: FloatArray
    outcome: int
    steps: int
    last_step: float


@njit
def step_size(unknowns: FloatArray, move: FloatArray) -> float:
    """Size of a step: pressure relative to its maximum, film and exit relative to film and exit."""
    n = unknowns.size - 2
    peak = 0.0
    for i in range(n - 1):
        peak = max(peak, unknowns[i])
    outflow = abs(unknowns[n - 1])
    size: float = max(
        abs(move[n - 1]) / outflow,
        abs(move[n]) / (1.0 + abs(unknowns[n])),
        abs(move[n + 1]) / (outflow + 1e-3),
    )
    for i in range(n - 1):
        size = max(size, abs(move[i]) / peak)
    return size


@njit
def step_length(
    problem: LineProblem,
    x: FloatArray,
    kernel: FloatArray,
    unknowns: FloatArray,
    move: FloatArray,
    lowest: float,
    most: float,
) -> float:
    """Part of a step that may be taken.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    x, kernel, unknowns
        The arguments of `reynolds.residual`.
    move : ndarray, shape (n + 2,)
        The step.
    lowest : float
        Smallest film before it.
    most : float
        Part to take at most.
    """
    n = unknowns.size - 2
    length: float = most
    thickening = steepest_viscosity_step(problem, unknowns, move)
    if thickening * length > LOG_VISCOSITY_STEP:
        length = LOG_VISCOSITY_STEP / thickening
    length = min(length, EXIT_STEP * (1.0 + abs(unknowns[n])) / max(abs(move[n]), 1e-300))
    for _ in range(MOST_HALVINGS):
        trial = unknowns + length * move
        if trial[n - 1] > 0.0 and np.min(film(x, kernel, trial)) >= LEAST_LEFT * min(lowest, trial[n - 1]):
            break
        length *= 0.5
    return length


@njit
def lifted(x: FloatArray, kernel: FloatArray, start: FloatArray) -> FloatArray:
    """A start, clear of contact: one that is interpolated from another grid can touch.

    Parameters
    ----------
    x, kernel, start
        The arguments of `newton`.
    """
    unknowns = start.copy()
    n = start.size - 2
    clearance = np.min(film(x, kernel, unknowns)) - LEAST_LEFT * unknowns[n - 1]
    if clearance < 0.0:
        unknowns[n + 1] -= clearance
    return unknowns


@njit
def relaxed(move: FloatArray, old: FloatArray, before: float) -> float:
    """Part of a step to take: half as much where pressures turn back, half as much again where they go on.

    Parameters
    ----------
    move : ndarray, shape (n + 2,)
        The step.
    old : ndarray, shape (n - 1,)
        Pressures of the step before; overwritten with those of this one.
    before : float
        Part of the step before.
    """
    along = new = past = 0.0
    for i in range(old.size):
        along += move[i] * old[i]
        new += move[i] * move[i]
        past += old[i] * old[i]
        old[i] = move[i]
    if along < -TURNED * math.sqrt(new * past):
        return max(LEAST_RELAXATION, 0.5 * before)
    return min(1.0, 1.5 * before)


@njit
def _secant(moves: FloatArray, chord: FloatArray) -> FloatArray:
    """A chord with what the moves before it, each as long as such a chord, have shown of the matrix: Broyden's.

    C. T. Kelley, Solving Nonlinear Equations with Newton's Method, SIAM 2003, section 4.1.
    """
    last = moves.shape[0] - 1
    for k in range(last):
        chord = chord + _along(moves[k], chord) * moves[k + 1]
    return chord / (1.0 - _along(moves[last], chord))


@njit(error_model="numpy")
def _along(move: FloatArray, chord: FloatArray) -> float:
    """Part of a chord that goes along a move."""
    along = squared = 0.0
    for i in range(move.size):
        along += move[i] * chord[i]
        squared += move[i] * move[i]
    return along / squared


@njit
def newton(
    problem: LineProblem,
    x: FloatArray,
    step: FloatArray,
    face_step: FloatArray,
    kernel: FloatArray,
    start: FloatArray,
    load: float,
    tolerance: float,
    most_steps: int,
) -> NewtonResult:
    """Solve the discrete contact from `start`.

    Parameters
    ----------
    problem : LineProblem
        Dimensionless groups.
    x, step, face_step : ndarray
        The grid, see `Grid`.
    kernel : ndarray, shape (n + 1, n + 1)
        Deflection at the nodes by the pressures at the nodes.
    start : ndarray, shape (n + 2,)
        Unknowns to start from.
    load : float
        Integral of the dimensionless pressure.
    tolerance : float
        Bound of the last full step: pressure relative to its maximum, film and exit relative to film and exit. What it
        leaves is about its square, and chords go on until they leave less.
    most_steps : int
        Steps after which the point counts as stagnated.
    """
    size = start.size
    n = size - 2
    unknowns = lifted(x, kernel, start)
    out = np.empty(size)
    jacobian, scratch, moves = np.empty((size, size)), np.empty((1, size)), np.empty((MOST_CHORDS, size))
    last, relaxation = math.inf, 1.0
    yields = problem.shear.form != NEWTONIAN
    old = np.zeros(n - 1)
    for count in range(most_steps):
        factors = no_factors()
        if yields:
            factors = shear_factors(problem, x, face_step, kernel, unknowns, last > SOFT_ABOVE)[0]
        lowest = residual_with(problem, factors, x, step, face_step, kernel, unknowns, load, out, jacobian)
        if not np.all(np.isfinite(out)):
            return NewtonResult(unknowns, DIVERGED, count, last)
        matrix = factorised(jacobian)
        move = solved(matrix, -out)
        last = step_size(unknowns, move)
        if not math.isfinite(last):
            return NewtonResult(unknowns, DIVERGED, count, last)
        if yields:
            relaxation = relaxed(move, old, relaxation) if last > SOFT_ABOVE else 1.0
        most = min(relaxation, YIELDING_STEP / last) if problem.shear.form == LIMITING else relaxation
        length = step_length(problem, x, kernel, unknowns, move, lowest, most)
        unknowns = unknowns + length * move
        if length == 1.0 and last < tolerance:
            return NewtonResult(unknowns, CONVERGED, count + 1, last)
        if length < 1.0 or yields or tolerance > CHORDS_FROM:
            continue
        before = min(last, LARGEST_BEFORE)
        put(move, moves[0])
        for k in range(1, MOST_CHORDS):
            residual_with(problem, factors, x, step, face_step, kernel, unknowns, load, out, scratch)
            put(_secant(moves[:k], solved(matrix, -out)), moves[k])
            chord = step_size(unknowns, moves[k])
            if not chord <= SHRINKING * before:
                break
            unknowns = unknowns + moves[k]
            # what is left, if the next chords shrink as this one did
            if chord * chord < tolerance * tolerance * before:
                return NewtonResult(unknowns, CONVERGED, count + 1, chord)
            before = chord
    return NewtonResult(unknowns, STAGNATED, most_steps, last)


@njit
def hertz_start(
    x: FloatArray, step: FloatArray, kernel: FloatArray, film_guess: float, exit_guess: float, load: float
) -> FloatArray:
    """Cold start: Hertz pressure with its edges rounded by the film, and a film of about `film_guess` at the centre.

    The pressure of a thick film is a hump s^2/(1 + t^2)^(5/2), t = X/sqrt(1 + 2 H), with s the distance before the
    exit in the same unit: P = dP/dX = 0 at the exit, and far upstream the P ~ |X|^-3 of a parabolic gap.

    Parameters
    ----------
    x : ndarray
        Nodes, counted from the exit [b].
    step : ndarray
        dx/ds at the nodes, s counted in cells [b].
    kernel : ndarray, shape (n + 1, n + 1)
        Deflection at the nodes by the pressures at the nodes.
    film_guess : float
        Film at the centre [b^2/R].
    exit_guess : float
        Coordinate of the exit [b].
    load : float
        Integral of the dimensionless pressure.
    """
    n = x.size - 1
    zone = film_guess ** (2 / 3)
    rounding = START_ROUNDING * zone
    stretch = math.sqrt(1.0 + 2.0 * film_guess) if film_guess > THICK_START else 1.0
    pressure = np.zeros(n + 1)
    for i in range(1, n):
        place = exit_guess + x[i]
        if film_guess > THICK_START:
            t = place / stretch
            pressure[i] = max(0.0, -x[i] / stretch) ** 2 / (1.0 + t * t) ** 2.5
        elif place > 0.0:
            pressure[i] = math.sqrt(max(0.0, 1.0 - (place / exit_guess) ** 2))
        elif place < -1.0 + rounding:
            # goes on from Hertz' sqrt(1 - X^2), which is nearly sqrt(2 rounding) there
            decay = START_DECAY * zone + 1e-9
            pressure[i] = math.sqrt(2.0 * rounding) * math.exp((place + 1.0 - rounding) / decay)
        else:
            pressure[i] = math.sqrt(max(0.0, 1.0 - place * place))
    pressure *= load / np.sum(step * pressure)
    centre = np.argmin(np.abs(x + exit_guess))
    deflection = kernel[centre] @ pressure
    start = np.empty(n + 2)
    put(pressure[1:n], start[: n - 1])
    start[n - 1] = film_guess
    start[n] = exit_guess
    start[n + 1] = film_guess - 0.5 * (exit_guess + x[centre]) ** 2 + deflection
    return start
