"""The table of points: films at its nodes, in the middles of cells, and on finer grids.

Each line holds oil, L and kappa, and goes from light to heavy loads. A node without a solution makes holes of the cells
around it, unless it is one of a heavy contact: there numbers go on from lighter loads.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.table.points.films import PointTable
from ehdmaps.table.points.nodes import ERRORS, FIELDS, FILMS, PointAxes, PointNodes
from ehdmaps.version import version
from examples.tables.files import encoded, rounded
from examples.tables.lines import middles
from examples.tables.point_errors import (
    COVERED,
    FINER,
    SEED,
    cell_errors,
    corners,
    error_scales,
    finer_points,
    random_points,
    read_errors,
)
from examples.tables.point_heavy import HEAVY, RESOLVED, continued_lines
from examples.tables.point_lines import RESOLUTION, THIN_RESOLUTION, solve_point_line

SOLVED = 6.2
"""zeta of the heaviest load that is solved."""

AXES = PointAxes(
    zeta=np.array(
        [
            *(-3.0, -2.0, -1.3, -0.8),
            *np.round(np.arange(-0.5, 0.65, 0.1), 6),
            *(0.8, 1.1, 1.5, 2.0, 2.6, 3.3, 4.1, 5.0, 5.6, 6.2),
            *(7.2, 8.2, 9.6, 11.2),
        ]
    ),
    size=np.log([3.0, 4.6, 7.0, 10.7, 16.3, 25.0, 38.7, 60.0]),
    shape=np.log([1.0, 1.7, 2.9, 4.9, 8.3, 14.0]),
    alpha=np.log([8e-9, 36e-9]),
    bend=np.array([-0.1, 1.1]),
)
"""Nodes: narrow steps of zeta where the damping dives; two values each of alpha and bend, between which all but the
largest pressure is nearly linear."""

_Progress = Callable[[int, int], None]


def filled(zeta: FloatArray, values: FloatArray) -> FloatArray:
    """Values with what is missing filled in along zeta, so that splines can go through; these cells are holes.

    Parameters
    ----------
    zeta : ndarray, shape (n_zeta,)
        The nodes.
    values : ndarray, shape (n_zeta, ..., fields)
        NaN where there is no film.

    Raises
    ------
    ValueError
        If a line has less than two films.
    """
    whole = values.copy()
    for place in np.ndindex(values.shape[1:-1]):
        line = whole[(slice(None), *place)]
        known = np.isfinite(line).all(axis=-1)
        if np.count_nonzero(known) < 2:
            raise ValueError(f"line {place} of the table has {np.count_nonzero(known)} films")
        for k in range(line.shape[-1]):
            line[~known, k] = np.interp(zeta[~known], zeta[known], line[known, k])
    return whole


def around(marked: BoolArray) -> BoolArray:
    """Cells with a corner that is marked.

    Parameters
    ----------
    marked : ndarray of bool, shape (nodes along each axis)
        The nodes.
    """
    for axis in range(5):
        lower, upper = (np.take(marked, range(i, marked.shape[axis] - 1 + i), axis) for i in (0, 1))
        marked = lower | upper
    return marked


def difference(apart: FloatArray, stated: FloatArray, zeta: float) -> FloatArray:
    """Distances in the middle of a cell; NaN of what a heavy contact does not resolve.

    Parameters
    ----------
    apart, stated : ndarray, shape (errors,)
        What is read less what is solved, and what the solver states.
    zeta : float
        The middle.
    """
    return np.where((stated > RESOLVED) & (zeta > HEAVY), math.nan, apart)


def make_point_table(axes: PointAxes = AXES, progress: _Progress = lambda done, of: None, finer: int = FINER) -> (
    PointTable
):  # fmt: skip
    """Solve the table that the package ships.

    Parameters
    ----------
    axes : PointAxes
        The nodes.
    progress : callable
        Told the lines that are done, and all of them.
    finer : int
        Points on finer grids, by which errors are scaled.
    """
    between = tuple(middles(nodes) for nodes in axes.all)
    of, done = int(np.prod(axes.nodes[1:]) + np.prod(axes.cells[1:])), 0
    tried = axes.zeta <= SOLVED
    values, alone = np.full((*axes.nodes, len(FIELDS)), math.nan), np.full((*axes.nodes, len(ERRORS)), math.nan)
    for place in np.ndindex(*axes.nodes[1:]):
        oil = [float(nodes[i]) for nodes, i in zip(axes.all[1:], place, strict=True)]
        L, kappa, alpha = map(math.exp, oil[:3])
        for i, point in enumerate(solve_point_line(axes.zeta[tried], L, kappa, alpha, oil[3])):
            if point is not None:
                values[(i, *place)], alone[(i, *place)] = point.values, point.errors
        done += 1
        progress(done, of)
    films = int(np.count_nonzero(np.isfinite(values[..., 0])))
    whole = continued_lines(axes.zeta, values, alone)
    heavy = around(whole.continued)
    empty = np.zeros((*axes.cells, len(ERRORS)), dtype=np.uint8)
    nodes = PointNodes(axes, rounded(filled(axes.zeta, whole.values)), empty, heavy)
    wrong = np.full(empty.shape, math.nan)
    for place in np.ndindex(*axes.cells[1:]):
        oil = [float(nodes[i]) for nodes, i in zip(between[1:], place, strict=True)]
        part = np.arange(sum(place) % 2, axes.cells[0], 2)
        part = part[between[0][part] < SOLVED]
        L, kappa, alpha = map(math.exp, oil[:3])
        solved = solve_point_line(between[0][part], L, kappa, alpha, oil[3])
        for i, point in zip(part.tolist(), solved, strict=True):
            if point is not None:
                at = tuple(np.array([x]) for x in (between[0][i], *oil))
                wrong[(i, *place)] = difference(read_errors(nodes, at, [point])[0], point.errors, between[0][i])
        done += 1
        progress(done, of)
    stated = cell_errors(whole.stated, wrong, heavy)
    random = random_points(axes, SOLVED, finer, SEED)
    scales = error_scales(nodes, stated, random, finer_points(random))
    attributes = provenance(axes, films, heavy, whole.rates, scales, finer)
    errors = scales * stated + corners(whole.growth)
    return PointTable(replace(nodes, codes=encoded(errors)), attributes)


def provenance(
    axes: PointAxes, films: int, heavy: BoolArray, rates: FloatArray, scales: FloatArray, finer: int
) -> dict[str, str]:
    """Attributes of a table: how it was made.

    Parameters
    ----------
    axes : PointAxes
        The nodes.
    films : int
        Nodes that were solved.
    heavy : ndarray of bool, shape (cells along each axis)
        Cells with continued numbers.
    rates : ndarray, shape (fields,)
        Growth of the errors of these by a unit of ln M.
    scales : ndarray, shape (errors,)
        Factors of the errors.
    finer : int
        Finer points by which they were found.
    """
    tried = int(np.prod(axes.nodes[1:])) * int(np.count_nonzero(axes.zeta <= SOLVED))
    grown = ", ".join(f"{rate:.3g} of {field.name}" for field, rate in zip(FILMS, rates, strict=False))
    return {
        "title": "Films of smooth, flooded, isothermal point contacts in pure rolling over their groups",
        "source": "solver ehdmaps.point",
        "settings": f"{RESOLUTION}; thin films {THIN_RESOLUTION}",
        "software": version(),
        "made_by": "python -m examples.tables points",
        "solved": f"{films} of {tried} nodes that were tried",
        "continued": f"{np.count_nonzero(heavy)} cells; a unit of ln M adds to their errors {grown}",
        "scales": f"errors times {' '.join(f'{scale:.3g}' for scale in scales)}, so that {100 * COVERED:g} % lie "
        f"within, as {finer} points on finer grids tell",
    }
