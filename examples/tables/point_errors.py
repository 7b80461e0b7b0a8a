"""Errors of the table of points: what is read against what is solved, in the middle of cells and on finer grids.

A cell has the mean of what its nodes state, and of the differences in the middles of cells nearby. What both tell of a
place that was not looked at, finer grids say at random points: the sum is scaled so that `COVERED` of all points lie
within, as sure as their number makes it (a tolerance limit without assumptions on the distribution: S. S. Wilks,
Annals of Mathematical Statistics 12, 1941, 91-96).
What is continued has the growth of its errors besides, which is not scaled.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.ndimage import uniform_filter
from scipy.stats import binom

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.physics.point.ellipse import elliptic_numbers
from ehdmaps.table.points.nodes import ERRORS, RESPONSES, PointAxes, PointNodes, point_load_number
from examples.tables.point_lines import SolvedPoint, finer_point, group_problem

COVERED, CONFIDENT = 0.95, 0.9
"""Part of all points that is to lie within what is stated, and how sure that is by so few finer ones."""

FINER, SEED, LIGHTEST = 95, 34, -1.5
"""Points that are solved on finer grids, the seed that places them, and the zeta of the lightest one."""


def corners(known: FloatArray) -> FloatArray:
    """Mean of the corners of each cell; NaN where one of them is NaN.

    Parameters
    ----------
    known : ndarray, shape (nodes along each of five axes, ...)
        Numbers at the nodes.
    """
    for axis in range(5):
        lower, upper = (np.take(known, range(i, known.shape[axis] - 1 + i), axis) for i in (0, 1))
        known = 0.5 * (lower + upper)
    return known


def nearby(wrong: FloatArray) -> FloatArray:
    """Mean of the cells that were checked among a cell and its neighbours along zeta, L and kappa; NaN without any.

    Parameters
    ----------
    wrong : ndarray, shape (cells along each axis, errors)
        NaN where a cell was not checked.
    """
    known = np.isfinite(wrong)
    size = (3, 3, 3, 1, 1, 1)
    total = uniform_filter(np.where(known, wrong, 0.0), size, mode="nearest")
    share = uniform_filter(known.astype(float), size, mode="nearest")
    return np.where(share > 1e-6, total / np.maximum(share, 1e-6), math.nan)


def read_errors(nodes: PointNodes, place: tuple[FloatArray, ...], solved: list[SolvedPoint]) -> FloatArray:
    """Distances of what is read from what is solved, shape (n, errors).

    Parameters
    ----------
    nodes : PointNodes
        The table; its errors count for nothing.
    place : tuple of ndarray, shape (n,)
        zeta, ln L, ln kappa, ln alpha, bend of the points.
    solved : list of SolvedPoint
        Their films.
    """
    zeta, size, shape, alpha, bend = place
    here = nodes.place(zeta, size, shape, (alpha, bend))
    logs, slopes = nodes.read(here)
    dynamic, _ = nodes.read(here, RESPONSES)
    M, kappa = point_load_number(zeta, np.exp(size), np.exp(shape)), np.exp(shape)
    numbers = elliptic_numbers(kappa)
    g = np.asarray(numbers.pressure_factor)
    q = 3.0 * M / (math.pi * kappa * g)
    # g K/(pi kappa) in units of p_H Rx, and these in Moes' units
    dry = g * np.asarray(numbers.integral) / (math.pi * kappa) / (0.5 * g * np.cbrt(q))
    stiffness = -np.log(dry - slopes[:, 0] * np.exp(logs[:, 0]) / M)
    wanted = np.array([[*point.values, point.stiffness] for point in solved])
    return np.asarray(np.abs(np.column_stack([logs, dynamic, stiffness]) - wanted))


def cell_errors(stated: FloatArray, wrong: FloatArray, continued: BoolArray) -> FloatArray:
    """Errors of the cells before they are scaled; NaN for holes.

    Parameters
    ----------
    stated : ndarray, shape (nodes along each axis, errors)
        Errors at the nodes; NaN where there is no film.
    wrong : ndarray, shape (cells along each axis, errors)
        Differences in the middles of cells; NaN where there is none.
    continued : ndarray of bool, shape (cells along each axis)
        Cells under heavy loads, whose numbers go on straight.
    """
    found = nearby(wrong)
    found[continued] = np.nan_to_num(found[continued])
    return corners(stated) + found


def random_points(axes: PointAxes, heaviest: float, count: int, seed: int) -> FloatArray:
    """Coordinates of random points within the axes, shape (5, count).

    Parameters
    ----------
    axes : PointAxes
        The nodes.
    heaviest : float
        Largest zeta.
    count, seed : int
        How many, and which.
    """
    random = np.random.default_rng(seed)
    low, high = ([nodes[end] for nodes in axes.all] for end in (0, -1))
    low[0], high[0] = max(LIGHTEST, low[0]), heaviest
    return np.asarray(random.uniform(low, high, (count, 5)).T)


def finer_points(place: FloatArray) -> list[SolvedPoint | None]:
    """Points on grids finer than those of the table.

    Parameters
    ----------
    place : ndarray, shape (5, n)
        Their coordinates.
    """
    found = []
    for zeta, size, shape, alpha, bend in place.T:
        L, kappa = math.exp(size), math.exp(shape)
        M = float(point_load_number(zeta, np.asarray(L), np.asarray(kappa)))
        found.append(finer_point(group_problem(M, L, kappa, math.exp(alpha), float(bend))))
    return found


def error_scales(
    nodes: PointNodes, stated: FloatArray, place: FloatArray, finer: list[SolvedPoint | None]
) -> FloatArray:
    """Factors of the stated errors, (errors,); one where there is no finer point.

    Parameters
    ----------
    nodes : PointNodes
        The table; its errors count for nothing.
    stated : ndarray, shape (cells along each axis, errors)
        Stated errors before they are scaled; NaN for holes.
    place : ndarray, shape (5, n)
        Coordinates of the finer points.
    finer : list of SolvedPoint or None
        Films on finer grids at these places.
    """
    known = np.array([point is not None for point in finer], dtype=bool)
    if not np.any(known):
        return np.ones(len(ERRORS))
    at = tuple(place[:, known])
    wrong = read_errors(nodes, at, [point for point in finer if point is not None])
    cell = nodes.place(at[0], at[1], at[2], at[3:]).cell
    share = (wrong / stated.reshape(-1, len(ERRORS))[cell])[~nodes.continued.ravel()[cell]]
    return np.array([tolerance_limit(column[np.isfinite(column)]) for column in share.T])


def tolerance_limit(found: FloatArray) -> float:
    """Limit below which `COVERED` of all values lie, by some of them: the largest if these are few; one without any.

    Parameters
    ----------
    found : ndarray, shape (n,)
        Some of the values.

    Examples
    --------
    >>> tolerance_limit(np.arange(1.0, 201.0))
    195.0
    """
    if not found.size:
        return 1.0
    # the most that may lie above, so that chance alone has so few above for a worse limit in one of ten cases
    above = int(binom.ppf(1.0 - CONFIDENT, found.size, 1.0 - COVERED)) - 1
    return float(np.sort(found)[max(-1 - max(above, 0), -found.size)])
