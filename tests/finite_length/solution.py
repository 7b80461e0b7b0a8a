"""Pressures of a roller over width and length, and of any contact without friction and tension.

The surface of each body is cut into rectangles of even pressure. A half space yields under one of them after Love; what
depth and ends of the bodies change has `ehdmaps.solids.finite_line`. Pressures are found where they are positive and
gaps elsewhere, by the set of places that touch; bodies are linear, dry and without friction.

    gap = x^2/(2 R) + P(y) - approach - tilt y + u(p) >= 0,    p >= 0,    p gap = 0
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.solids.finite_line import FiniteLine, depth_term, mirror_factor

_MOST_CHANGES = 200


def touching(
    compliance: FloatArray, gap: FloatArray, rigid: FloatArray, shares: FloatArray, wanted: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Forces >= 0 where gaps are closed, zero where they are open, under given loads.

    Places that pull leave the set of those that touch; once none pulls, those that overlap join it, until none does.

    Parameters
    ----------
    compliance : array (n, n)
        Approach of the surfaces at each place by a force at each other one.
    gap : array (n,)
        Gap at each place before bodies move or yield [m].
    rigid : array (n, r)
        How far each rigid motion closes each gap.
    shares : array (n,)
        What a force counts for in the loads.
    wanted : array (r,)
        Load that each rigid motion does its work against.

    Returns
    -------
    forces : array (n,)
        Forces, in the unit that belongs to `compliance`.
    motions : array (r,)
        The rigid motions.

    Raises
    ------
    AnalysisError
        If the set does not settle.

    References
    ----------
    J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer, 1990: the algorithm NORM.
    """
    active = gap <= np.quantile(gap, 0.5)
    count = wanted.size
    unit, largest, spans = float(np.abs(compliance).max()), float(shares.max()), np.abs(rigid).max(axis=0)
    for _ in range(_MOST_CHANGES):
        inside = np.flatnonzero(active)
        size = inside.size
        # Forces are measured by what they yield, motions by themselves, loads by the largest share: all near one.
        system = np.zeros((size + count, size + count))
        system[:size, :size] = compliance[np.ix_(inside, inside)] / unit
        system[:size, size:] = -rigid[inside] / spans
        system[size:, :size] = (rigid[inside] / spans * (shares[inside, None] / largest)).T
        right = np.concatenate([-gap[inside], wanted / spans * (unit / largest)])
        try:
            solution = np.linalg.solve(system, right)
        except np.linalg.LinAlgError:  # places in a row bear no moment
            break
        motions = solution[size:] / spans
        forces = np.zeros(gap.size)
        forces[inside] = solution[:size] / unit
        pulling = active & (forces <= 0.0)
        # New places only where none pulls: both at once may go round in circles.
        if np.any(pulling):
            active = active & ~pulling
            continue
        left = gap - rigid @ motions + compliance @ forces
        overlapping = ~active & (left < 0.0)
        if not np.any(overlapping):
            return forces, motions
        active = active | overlapping
    raise AnalysisError(
        f"contact: the places that touch did not settle in {_MOST_CHANGES} changes; the load may lie outside the "
        "roller, or be no load"
    )


Profile = Callable[[FloatArray], FloatArray]
"""Depth of the profile of the roller below its cylinder, on one side [m], by the places along it [m]."""


_WIDER = 1.35


@dataclass(frozen=True, eq=False)
class LengthSolution:
    """Pressures of a roller.

    Attributes
    ----------
    places : array (n,)
        Middles of the cells along the roller [m].
    widths : array (n,)
        Their lengths [m].
    load_per_length : array (n,)
        w [N/m].
    peak_pressure : array (n,)
        Pressure in the middle of the width [Pa].
    approach, tilt : float
        Approach of the bodies in the middle of the roller [m], and how it grows along it.
    """

    places: FloatArray
    widths: FloatArray
    load_per_length: FloatArray
    peak_pressure: FloatArray
    approach: float
    tilt: float

    @property
    def load(self) -> float:
        """Load of the roller [N]."""
        return float(self.load_per_length @ self.widths)

    @property
    def moment(self) -> float:
        """Moment of the load about the middle of the roller [N m]."""
        return float(self.load_per_length @ (self.widths * self.places))


def love(x: FloatArray, y: FloatArray, half_x: FloatArray | float, half_y: FloatArray | float) -> FloatArray:
    """Integral of 1/distance over a rectangle [m]; an even pressure p moves the surface by p (1 - nu^2)/(pi E) of it.

    Parameters
    ----------
    x, y : array
        Places on the surface, from the middle of the rectangle [m].
    half_x, half_y : array or float
        Half its sides [m].

    References
    ----------
    A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377-420; K. L. Johnson, Contact Mechanics, Cambridge, 1985,
    section 3.5.

    Examples
    --------
    Under the middle of a square of side 2: 8 ln(1 + sqrt 2):

    >>> float(round(love(np.array(0.0), np.array(0.0), 1.0, 1.0) / (8.0 * math.log(1.0 + math.sqrt(2.0))), 12))
    1.0
    """
    total = np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y), np.shape(half_x), np.shape(half_y)))
    for sign_x in (1.0, -1.0):
        for sign_y in (1.0, -1.0):
            a, b = x + sign_x * half_x, y + sign_y * half_y
            total += sign_x * sign_y * (a * np.arcsinh(b / np.abs(a)) + b * np.arcsinh(a / np.abs(b)))
    return total


def length_cells(length: float, cells: int) -> FloatArray:
    """Ends of cells along a roller that get shorter towards both ends, (cells + 1,) [m], from its middle.

    Parameters
    ----------
    length : float
        [m].
    cells : int
        How many.
    """
    return np.asarray(-0.5 * length * np.cos(np.linspace(0.0, math.pi, cells + 1)))


def solve_length(
    line: FiniteLine,
    profile: Profile,
    load: float,
    moment: float | None = 0.0,
    cells: tuple[int, int] = (12, 60),
    mirrored: float | None = None,
) -> LengthSolution:
    """Pressures of a roller under a load and a moment.

    Parameters
    ----------
    line : FiniteLine
        Roller and raceway.
    profile : callable
        P(y) [m].
    load : float
        Load of the roller [N].
    moment : float or None
        Moment about its middle [N m]; None for a roller that may not tilt.
    cells : (int, int)
        Cells over half the width, and along the roller.
    mirrored : float, optional
        Factor on pressures mirrored at a free end; `mirror_factor` if left out.

    Raises
    ------
    InputError
        For a load that is not positive.
    AnalysisError
        If no pressures are found.
    """
    if not (math.isfinite(load) and load > 0.0):
        raise InputError(f"finite line, load: got {load!r} N; allowed: finite and > 0")
    edges = length_cells(line.length, cells[1])
    y, widths = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    wanted = np.array([load] if moment is None else [load, moment])
    wide = _WIDER * line.half_width(load / line.length)
    factor = mirror_factor(line.material) if mirrored is None else mirrored
    while True:
        x_edges = np.linspace(0.0, wide, cells[0] + 1)
        x = 0.5 * (x_edges[1:] + x_edges[:-1])
        matrix = _influence(line, x, x_edges[1] * 0.5, y, 0.5 * widths, factor)
        gap = (x[None, :] ** 2 / (2.0 * line.radius) + profile(y)[:, None]).ravel()
        areas, arms = np.repeat(2.0 * x_edges[1] * widths, x.size), np.repeat(y, x.size)
        rigid = np.stack([np.ones(gap.size), arms], axis=1)[:, : wanted.size]
        pressure, motions = touching(matrix, gap, rigid, areas, wanted)
        shape = pressure.reshape(y.size, x.size)
        if not np.any(shape[:, -1]):
            break
        wide *= _WIDER
    w = 2.0 * x_edges[1] * shape.sum(axis=1)
    # The parabola through the first two cells, even in x.
    peak = shape[:, 0] + (shape[:, 0] - shape[:, 1]) * x[0] ** 2 / (x[1] ** 2 - x[0] ** 2)
    tilt = 0.0 if moment is None else float(motions[1])
    return LengthSolution(y, widths, w, peak, float(motions[0]), tilt)


def _influence(
    line: FiniteLine, x: FloatArray, half_x: float, y: FloatArray, half_y: FloatArray, factor: float
) -> FloatArray:
    """Approach of both surfaces in the middles of cells by pressures of cells at x and -x, (cells, cells) [m/Pa]."""
    # Cells of one width: their middles are whole numbers of widths apart.
    index = np.arange(x.size)
    apart, mirrored_apart = np.abs(index[:, None] - index[None, :]), index[:, None] + index[None, :] + 1
    shifts: FloatArray = 2.0 * half_x * np.arange(2 * x.size, dtype=np.float64)

    def placed(sources: FloatArray) -> FloatArray:
        far = y[:, None] - sources[None, :]
        influence = love(shifts[:, None, None], far[None], half_x, half_y[None, None, :])
        return np.asarray((influence[apart] + influence[mirrored_apart]).transpose(2, 0, 3, 1))

    def deep(sources: FloatArray, depth: float) -> FloatArray:
        return depth_term(y[:, None] - sources[None, :], depth) * (4.0 * half_x) * (2.0 * half_y)[None, :]

    direct = placed(y)
    ends = [line.length - y, -line.length - y]
    mirrored = placed(ends[0]) + placed(ends[1])
    free = 2 if line.flush else 1
    total = 2.0 * direct + free * factor * mirrored
    smooth = np.zeros((y.size, y.size))
    for depth, has_ends in ((line.roller_depth, True), (line.race_depth, line.flush)):
        smooth += deep(y, depth)
        if has_ends:
            smooth += factor * sum(deep(end, depth) for end in ends)
    total += smooth[:, None, :, None]
    count = y.size * x.size
    return np.asarray(line.body_compliance * total.reshape(count, count))
