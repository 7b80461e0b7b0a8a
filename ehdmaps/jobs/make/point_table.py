"""Making of the table of points: lines of films solved in their groups, through nodes and through the middles of cells.

Each line holds oil, L and kappa, and goes from light to heavy loads, every film from the one before. A node without a
solution, or whose grids tell different stories, makes holes of the cells around it. What is read in the middle of a
cell is held against what is solved there: with what the solver states, that is the error of the table.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import maximum_filter

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs.make.table_make import middles
from ehdmaps.physics.isotherm import PressureViscosity
from ehdmaps.physics.point.ellipse import elliptic_numbers
from ehdmaps.physics.viscosity import ROELANDS_PRESSURE
from ehdmaps.point.problem import PointProblem
from ehdmaps.point.two_grids import MOST_ERROR, SHARES, PointGroups, Resolution, responses, solve_groups
from ehdmaps.table.coordinates import exponent_of
from ehdmaps.table.fields import NATURAL_FREQUENCIES
from ehdmaps.table.file import rounded
from ehdmaps.table.nodes import encoded
from ehdmaps.table.points.coordinates import PointAxes, point_load_number
from ehdmaps.table.points.films import PointTable
from ehdmaps.table.points.nodes import ERRORS, FIELDS, FILMS, RESPONSES, PointNodes
from ehdmaps.version import version

RESOLUTION = Resolution()

_KNEE = np.round(np.arange(-0.5, 0.65, 0.1), 6)

AXES = PointAxes(
    zeta=np.array(
        [
            -3.0,
            -2.0,
            -1.3,
            -0.8,
            *np.round(np.arange(-0.5, 0.65, 0.1), 6),
            0.8,
            1.1,
            1.5,
            2.0,
            2.6,
            3.3,
            4.1,
            5.0,
            5.6,
            6.2,
        ]
    ),
    size=np.log([3.0, 4.6, 7.0, 10.7, 16.3, 25.0]),
    shape=np.log([1.0, 1.7, 2.9, 4.9, 8.3, 14.0]),
    alpha=np.log([8e-9, 36e-9]),
    bend=np.array([-0.1, 1.1]),
)
"""Nodes: narrow steps of zeta where the damping dives; two values each of alpha and bend, between which all but the
largest pressure is nearly linear."""

_Progress = Callable[[int, int], None]


def group_problem(load_number: float, oil_number: float, ellipticity: float, alpha: float, bend: float) -> PointProblem:
    """A point in groups, of an oil of Roelands' law.

    Parameters
    ----------
    load_number, oil_number, ellipticity : float
        M, L, kappa.
    alpha, bend : float
        alpha [1/Pa], and the bend of `ehdmaps.table.coordinates`.
    """
    factor = float(elliptic_numbers(ellipticity).pressure_factor)
    scale = 3.0 * load_number / (math.pi * ellipticity * factor)
    law = PressureViscosity(alpha, exponent_of(alpha, bend), ROELANDS_PRESSURE)
    peak = 0.5 * factor * oil_number * scale ** (1.0 / 3.0) / alpha
    return PointProblem(ellipticity, load_number, oil_number, law.isotherm(peak, compressible=True))


@dataclass(frozen=True, eq=False)
class SolvedPoint:
    """A film in the forms of the table.

    Attributes
    ----------
    values : ndarray, shape (fields,)
        Logarithms of `FIELDS`.
    stiffness : float
        Logarithm of k.
    errors : ndarray, shape (errors,)
        What the solver states, in the order of `ERRORS`.
    """

    values: FloatArray
    stiffness: float
    errors: FloatArray


def solved_point(problem: PointProblem, groups: PointGroups) -> SolvedPoint | None:
    """A solved film in the forms of the table; None where it is not resolved.

    Parameters
    ----------
    problem : PointProblem
        The point.
    groups : PointGroups
        Solution of it.
    """
    found, stated = groups.numbers, groups.errors
    if found is None or stated is None or groups.worst[1] > MOST_ERROR:
        return None
    film = problem.moes
    spring = 0.5 * float(problem.numbers.pressure_factor) * problem.load_scale ** (1.0 / 3.0)
    damper = spring * problem.load_scale ** (1.0 / 3.0)
    turning = np.array(NATURAL_FREQUENCIES) / math.sqrt(1.0 + 2.0 * found.film_offset)
    dynamic, left = responses(groups, turning)
    numbers = {
        "film_offset": found.film_offset * film,
        "damping": found.damping * damper,
        "central_film": found.central_film * film,
        "minimum_film": found.minimum_film * film,
        "max_pressure": found.max_pressure,
    }
    response = np.column_stack([dynamic.real * spring, dynamic.imag / turning * damper]).ravel()
    everything = np.r_[[numbers[field.name] for field in FILMS], response, found.stiffness * spring]
    if not np.all(everything > 0.0) or not np.all(np.isfinite(everything)):
        return None
    shares = SHARES["stiffness"][0], SHARES["damping"][0]
    wrong = np.column_stack(
        [
            np.maximum(shares[0] * np.abs(left.real / dynamic.real), stated.stiffness),
            np.maximum(shares[1] * np.abs(left.imag / dynamic.imag), stated.damping),
        ]
    ).ravel()
    errors = np.r_[[getattr(stated, field.name) for field in FILMS], wrong, stated.stiffness]
    logs = np.log(everything)
    return SolvedPoint(logs[:-1], float(logs[-1]), errors)


def solve_point_line(
    zeta: FloatArray, oil_number: float, ellipticity: float, alpha: float, bend: float
) -> list[SolvedPoint | None]:
    """Films at each zeta; None where there is no solution.

    Parameters
    ----------
    zeta : ndarray, shape (n,)
        Rising places.
    oil_number, ellipticity, alpha, bend : float
        The arguments of `group_problem`.
    """
    loads = point_load_number(zeta, np.asarray(oil_number), np.asarray(ellipticity))
    found: list[SolvedPoint | None] = []
    previous: PointGroups | None = None
    for M in map(float, loads):
        problem = group_problem(M, oil_number, ellipticity, alpha, bend)
        groups = solve_groups(problem, RESOLUTION, previous, finer=False)
        point = solved_point(problem, groups)
        found.append(point)
        if point is not None:
            previous = groups
    return found


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
        z, held = zeta[known], line[known]
        slope = (held[-1] - held[-2]) / (z[-1] - z[-2])
        for k in range(line.shape[-1]):
            line[~known, k] = np.interp(zeta[~known], z, held[:, k])
        beyond = zeta > z[-1]
        line[beyond] = held[-1] + slope * (zeta[beyond] - z[-1])[:, None]
    return whole


def corners(known: FloatArray) -> FloatArray:
    """Largest of the corners of each cell; NaN where one of them is NaN.

    Parameters
    ----------
    known : ndarray, shape (nodes along each of five axes, ...)
        Numbers at the nodes.
    """
    for axis in range(5):
        lower, upper = (np.take(known, range(i, known.shape[axis] - 1 + i), axis) for i in (0, 1))
        known = np.maximum(lower, upper)  # NaN goes on
    return known


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


def make_point_table(axes: PointAxes = AXES, progress: _Progress = lambda done, of: None) -> PointTable:
    """Solve the table that the package ships.

    Parameters
    ----------
    axes : PointAxes
        The nodes.
    progress : callable
        Told the lines that are done, and all of them.
    """
    between = tuple(middles(nodes) for nodes in axes.all)
    of, done = int(np.prod(axes.nodes[1:]) + np.prod(axes.cells[1:])), 0
    values, stated = np.full((*axes.nodes, len(FIELDS)), math.nan), np.full((*axes.nodes, len(ERRORS)), math.nan)
    for place in np.ndindex(*axes.nodes[1:]):
        oil = [float(nodes[i]) for nodes, i in zip(axes.all[1:], place, strict=True)]
        L, kappa, alpha = map(math.exp, oil[:3])
        line = solve_point_line(axes.zeta, L, kappa, alpha, oil[3])
        for i, point in enumerate(line):
            if point is not None:
                values[(i, *place)], stated[(i, *place)] = point.values, point.errors
        done += 1
        progress(done, of)
    films = int(np.count_nonzero(np.isfinite(values[..., 0])))
    empty = np.zeros((*axes.cells, len(ERRORS)), dtype=np.uint8)
    nodes = PointNodes(axes, rounded(filled(axes.zeta, values)), empty)
    wrong = np.full(empty.shape, math.nan)
    for place in np.ndindex(*axes.cells[1:]):
        oil = [float(nodes[i]) for nodes, i in zip(between[1:], place, strict=True)]
        part = np.arange(sum(place) % 2, axes.cells[0], 2)
        L, kappa, alpha = map(math.exp, oil[:3])
        solved = solve_point_line(between[0][part], L, kappa, alpha, oil[3])
        for i, point in zip(part.tolist(), solved, strict=True):
            if point is not None:
                at = tuple(np.array([x]) for x in (between[0][i], *oil))
                wrong[(i, *place)] = read_errors(nodes, at, [point])[0] + point.errors
        done += 1
        progress(done, of)
    nearby = maximum_filter(np.nan_to_num(wrong, nan=-1.0), size=(3, 3, 3, 1, 1, 1), mode="nearest")
    known = np.where(nearby < 0.0, math.nan, nearby)
    whole = np.maximum(corners(stated), known)  # NaN where a corner has no film, or nothing near was checked
    return PointTable(
        replace(nodes, codes=encoded(whole)),
        {
            "title": "Films of smooth, flooded, isothermal point contacts in pure rolling over their groups",
            "source": "solver ehdmaps.point",
            "settings": str(RESOLUTION),
            "software": version(),
            "made_by": "ehdmaps table make --points",
            "solved": f"{films} of {np.prod(axes.nodes)} nodes",
        },
    )
