"""Film of one point in groups: solved on two grids, extrapolated, with errors from their difference.

The ways to a solution, in their order: on the coarse grid from the pressure of Hertz with films of several thicknesses,
then from solutions at other loads, step by step; on the fine grid from the coarse one, then by the same ways. The order
of the scheme is two, so that the finer of both grids leaves 1/(r - 1) of their difference, r the ratio of their cells
squared. Values are extrapolated by that; the errors that are stated are the shares `SHARES` of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, RectBivariateSpline

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.physics.solution import Status, peak_sampling_error
from ehdmaps.point.grid import Cells, PointGrid, point_grid
from ehdmaps.point.linearisation import Tangent
from ehdmaps.point.newton import PointState, newton, starts
from ehdmaps.point.problem import PointProblem, start_film

THICKNESSES = (1.0, 1.6, 2.5, 0.7, 4.0)
"""Films from which solutions are sought, over that of the formula."""

MARCH = (2.0, 0.5, 4.0, 0.25)
"""Loads from which solutions are sought where no start leads to one, over the load."""

MARCH_STEPS = 4
"""Steps to the next octave of load."""

SCALE_STEP, WIDE = 1.25, 0.55
"""Ladder of grids that grow with a thick film, and where it begins: kernels are shared along it."""

THIN, THIN_EDGE, THIN_INLET = 0.07, 0.5, 0.625
"""Film [a^2/Rx] below which the cells at the edge of the dry contact are smaller, see `Cells.edge`, and the length of
the inlet over the usual one: the far inlet of a thin film carries little."""

MOST_ERROR = 0.3
"""Stated error of film, film offset or stiffness above which both grids tell different stories."""

SHARES = {
    "film_offset": (1.0, 0.0, 0.0),
    "compliance": (1.5, 0.5, 0.0),
    "loss": (2.0, 2.0, 0.0),
    "film_compliance": (0.0, 0.0, 0.0),
    "stiffness": (1.5, 0.5, 0.0),
    "damping": (2.0, 2.0, 0.0),
    "central_film": (1.0, 0.0, 0.0),
    "minimum_film": (2.0, 1.0, 0.0),
    "max_pressure": (1.0, 0.0, 0.0),
}
"""Stated error over what extrapolation changes: of the number itself, of the central film, of the smallest film; the
largest counts. The differences of A and B change sign over load and oil, and say little alone. The film compliance has
the error of A, the largest pressure at least that of a peak between nodes."""


class Resolution(NamedTuple):
    """Both grids: cells along and across half of the contact, and the length of the inlet [a]."""

    coarse: tuple[int, int] = (34, 12)
    fine: tuple[int, int] = (51, 18)
    inlet: float = 8.0

    @property
    def finer(self) -> Resolution:
        """The next pair of grids: its coarse one is the fine one here."""
        along, across = self.fine
        return self._replace(coarse=self.fine, fine=(3 * along // 2, 3 * across // 2))

    @property
    def left(self) -> float:
        """1/(r - 1), what extrapolation adds over the difference of both grids."""
        return 1.0 / ((self.fine[0] / self.coarse[0]) ** 2 - 1.0)


class PointNumbers(NamedTuple):
    """Numbers of one point, or their errors, in groups: lengths in a^2/Rx, pressures in p_H, forces in p_H a^2.

    Attributes
    ----------
    film_offset : float
        Dry less lubricated approach.
    compliance, loss : float
        A and B of `linearisation`.
    film_compliance : float
        A less that of the dry contact.
    stiffness, damping : float
        1/A and B/A^2.
    central_film, minimum_film, max_pressure : float
        H at the centre, smallest H, largest P.
    """

    film_offset: float
    compliance: float
    loss: float
    film_compliance: float
    stiffness: float
    damping: float
    central_film: float
    minimum_film: float
    max_pressure: float


@dataclass(frozen=True, eq=False)
class PointGroups:
    """A point that was solved, or was not.

    Attributes
    ----------
    status : Status
        CONVERGED, or why not: STAGNATED, DIVERGED.
    steps : int
        Newton steps, all grids and starts together.
    resolution : Resolution
        The grids.
    numbers, errors : PointNumbers or None
        Values, and their errors relative to them; None without a solution.
    coarse, fine : PointState or None
        The states on both grids; None where there is none.
    """

    status: Status
    steps: int
    resolution: Resolution
    numbers: PointNumbers | None = None
    errors: PointNumbers | None = None
    coarse: PointState | None = None
    fine: PointState | None = None

    @property
    def worst(self) -> tuple[str, float]:
        """Number with the largest stated error of central film, film offset and stiffness, and that; inf without any.

        The smallest film, that of a narrow strip in heavy contacts, and damping stand for themselves.
        """
        if self.errors is None:
            return "", math.inf
        errors = {
            "central film": self.errors.central_film,
            "film offset": self.errors.film_offset,
            "stiffness": self.errors.stiffness,
        }
        name = max(errors, key=lambda key: errors[key])
        return name, errors[name] if math.isfinite(errors[name]) else math.inf

    @property
    def resolved(self) -> bool:
        """True where both grids tell the same, of the smallest film too."""
        return self.errors is not None and max(self.worst[1], self.errors.minimum_film) <= MOST_ERROR


def solve_groups(
    problem: PointProblem, resolution: Resolution, previous: PointGroups | None = None, finer: bool = True
) -> PointGroups:
    """Solve a point on two grids, and where these do not resolve it on finer ones.

    Parameters
    ----------
    problem : PointProblem
        The contact.
    resolution : Resolution
        The grids.
    previous : PointGroups, optional
        A neighbour, of the same ellipticity, to start from.
    finer : bool
        Whether finer grids are tried, at ten times the cost.
    """
    found = _solved_on(problem, resolution, previous)
    if not finer or found.resolved:
        return found
    better = _solved_on(problem, resolution.finer, replace(found, coarse=found.fine))
    steps = found.steps + better.steps
    return replace(found if better.numbers is None else better, steps=steps)


def _solved_on(problem: PointProblem, resolution: Resolution, previous: PointGroups | None) -> PointGroups:
    """Solve a point on both grids of a resolution."""
    scale, edge, inlet = _ladders(problem)
    grids = [
        point_grid(problem.ellipticity, scale, Cells(along, across, inlet * resolution.inlet, edge))
        for along, across in (resolution.coarse, resolution.fine)
    ]
    steps = 0
    states: list[PointState] = []
    known = None if previous is None else previous.coarse
    for grid in grids:
        state: PointState | None = None
        for state in _tries(problem, grid, states[0] if states else known):
            steps += state.steps
            if state.status.usable:
                break
        assert state is not None
        if not state.status.usable:
            return PointGroups(state.status, steps, resolution)
        states.append(state)
    before, behind = (numbers_of(state) for state in states)
    values, errors = extrapolated(before, behind, resolution.left, states[1], cusp=problem.isotherm.alpha > 0.0)
    return PointGroups(Status.CONVERGED, steps, resolution, values, errors, states[0], states[1])


def extrapolated(
    coarse: PointNumbers, fine: PointNumbers, left: float, state: PointState, *, cusp: bool
) -> tuple[PointNumbers, PointNumbers]:
    """Numbers by those of two grids, and their errors relative to them.

    Parameters
    ----------
    coarse, fine : PointNumbers
        Numbers on both grids.
    left : float
        What extrapolation adds over their difference, `Resolution.left`.
    state : PointState
        The state on the finer one.
    cusp : bool
        Whether pressures may have a spike.
    """
    compliance = fine.compliance + left * (fine.compliance - coarse.compliance)
    loss = fine.loss + left * (fine.loss - coarse.loss)
    values = PointNumbers(*(b + left * (b - a) for a, b in zip(coarse, fine, strict=True)))
    values = values._replace(stiffness=1.0 / compliance, damping=loss / compliance**2)
    moved = PointNumbers(
        *(left * abs(b - a) / max(abs(v), 1e-300) for a, b, v in zip(coarse, fine, values, strict=True))
    )
    errors = PointNumbers(
        *(
            max(own * change, central * moved.central_film, smallest * moved.minimum_film)
            for change, (own, central, smallest) in zip(moved, SHARES.values(), strict=True)
        )
    )
    # the dry contact is exact: what is left of the compliance has its error
    film_compliance = errors.compliance * abs(values.compliance / values.film_compliance)
    top = state.pressure
    row = top[:, int(np.unravel_index(np.argmax(top), top.shape)[1])]
    between = peak_sampling_error(state.grid.x, row, cusp=cusp)
    errors = errors._replace(film_compliance=film_compliance, max_pressure=max(errors.max_pressure, between))
    return values, errors


def responses(groups: PointGroups, frequencies: FloatArray) -> tuple[ComplexArray, FloatArray]:
    """Dynamic stiffness 1/z over frequency [p_H Rx], and the difference that extrapolation leaves, complex.

    Parameters
    ----------
    groups : PointGroups
        A point that is solved.
    frequencies : ndarray, shape (k,)
        Omega = omega a/u, > 0.

    Returns
    -------
    stiffness, error : ndarray, shape (k,)
        1/z, and by how much extrapolation changed it; both complex.
    """
    assert groups.coarse is not None and groups.fine is not None
    coarse, fine = (-Tangent.of(state).motions(frequencies) for state in (groups.coarse, groups.fine))
    found = 1.0 / (fine + groups.resolution.left * (fine - coarse))
    return found, np.asarray(found - 1.0 / fine)


def numbers_of(state: PointState) -> PointNumbers:
    """Numbers of a point on one grid.

    Parameters
    ----------
    state : PointState
        A state that is solved.
    """
    problem = state.problem
    assert isinstance(problem, PointProblem)  # others have no closed form of the dry contact
    return numbers_beside(state, problem.dry_approach, problem.dry_compliance)


def numbers_beside(state: PointState, dry_approach: float, dry_compliance: float) -> PointNumbers:
    """Numbers of a contact on one grid beside the dry one.

    Parameters
    ----------
    state : PointState
        A state that is solved.
    dry_approach, dry_compliance : float
        Approach of the dry contact [a^2/Rx], and its derivative by the load.
    """
    grid = state.grid
    compliance, loss = Tangent.of(state).slow()
    return PointNumbers(
        film_offset=state.datum + dry_approach,
        compliance=compliance,
        loss=loss,
        film_compliance=compliance - dry_compliance,
        stiffness=1.0 / compliance,
        damping=loss / compliance**2,
        central_film=float(CubicSpline(grid.x, state.film[:, 0])(0.0)),
        minimum_film=_smallest(grid, state.film),
        max_pressure=float(np.max(state.pressure)),
    )


def _ladders(problem: PointProblem) -> tuple[float, float, float]:
    """Scale of the grid, size of its cells at the edge, and its inlet over the usual one, by the film's thickness."""
    return ladder(start_film(problem))


def ladder(film: float) -> tuple[float, float, float]:
    """Scale of a grid, size of its cells at the edge, and its inlet over the usual one, by a film.

    Parameters
    ----------
    film : float
        Film that a formula gives [a^2/Rx].
    """
    width = WIDE * math.sqrt(2.0 * film)
    if width > 1.0:
        return SCALE_STEP ** math.ceil(math.log(width) / math.log(SCALE_STEP)), 1.0, 1.0
    return (1.0, 1.0, 1.0) if film > THIN else (1.0, THIN_EDGE, THIN_INLET)


def _tries(problem: PointProblem, grid: PointGrid, known: PointState | None) -> Iterator[PointState]:
    """Solutions by one way after another, to be taken until one of them is."""
    if known is not None:
        yield newton(problem, grid, *carried_over(known, grid))
    for start in starts(problem, grid, THICKNESSES):
        yield newton(problem, grid, *start)
    for factor in MARCH:
        yield from _marched(problem, grid, factor)


def _marched(problem: PointProblem, grid: PointGrid, factor: float) -> Iterator[PointState]:
    """The solution from that at another load, in steps; nothing where one of them has none."""
    steps = max(1, round(MARCH_STEPS * abs(math.log2(factor))))
    state: PointState | None = None
    for count in range(steps + 1):
        there = problem.at_load(factor ** (1.0 - count / steps))
        if state is None:
            state = newton(there, grid, *next(starts(there, grid, (1.0,))))
        else:
            state = newton(there, grid, state.pressure, state.height)
        if not state.status.usable:
            break
    assert state is not None
    # what was found on the way is no solution of the point that is asked for
    yield state if count == steps else replace(state, status=Status.STAGNATED)


def carried_over(state: PointState, grid: PointGrid) -> tuple[FloatArray, float]:
    """Pressure and H0 of a state on another grid.

    Parameters
    ----------
    state : PointState
        The state.
    grid : PointGrid
        The other grid.
    """
    if state.grid is grid:
        return state.pressure, state.height
    spline = RectBivariateSpline(state.grid.x, state.grid.y, state.pressure)
    pressure = np.maximum(spline(grid.x, grid.y), 0.0)
    pressure[~(grid.inner | grid.tail.far)] = 0.0
    return np.asarray(pressure), state.height


def _smallest(grid: PointGrid, film: FloatArray) -> float:
    """Smallest film between the nodes: that of a bicubic spline about the smallest one at a node."""
    x, y = grid.x, np.r_[-grid.y[:0:-1], grid.y]
    whole = np.concatenate([film[:, :0:-1], film], axis=1)
    i, j = (int(k) for k in np.unravel_index(np.argmin(whole), whole.shape))
    a, b = slice(max(i - 4, 0), i + 5), slice(max(j - 4, 0), j + 5)
    spline = RectBivariateSpline(x[a], y[b], whole[a, b])
    along = np.linspace(x[max(i - 1, 0)], x[min(i + 1, x.size - 1)], 41)
    across = np.linspace(y[max(j - 1, 0)], y[min(j + 1, y.size - 1)], 41)
    return min(float(np.min(spline(along, across))), float(np.min(whole)))
