"""Films of points along loads, in their groups: each from the one before, in the forms of the table."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.isotherm import PressureViscosity
from ehdmaps.physics.point.ellipse import elliptic_numbers
from ehdmaps.physics.viscosity import ROELANDS_PRESSURE
from ehdmaps.point.problem import PointProblem, start_film
from ehdmaps.point.two_grids import MOST_ERROR, SHARES, THIN, PointGroups, Resolution, responses, solve_groups
from ehdmaps.table.fields import NATURAL_FREQUENCIES
from ehdmaps.table.points.nodes import FILMS, point_load_number
from examples.tables.files import exponent_of

RESOLUTION, THIN_RESOLUTION = Resolution(), Resolution((44, 16), (66, 24))
"""Grids of the table, and those of thin films, whose damping and smallest film need more cells."""


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


def table_grids(problem: PointProblem) -> Resolution:
    """Grids on which the table has a point.

    Parameters
    ----------
    problem : PointProblem
        The point.
    """
    return RESOLUTION if start_film(problem) > THIN else THIN_RESOLUTION


@dataclass(frozen=True, eq=False)
class SolvedPoint:
    """A film in the forms of the table.

    Attributes
    ----------
    values : ndarray, shape (fields,)
        The forms of `FIELDS`: logarithms, and damping over frequency over that of slow motion.
    stiffness : float
        Logarithm of k.
    errors : ndarray, shape (errors,)
        What the solver states of these forms, in the order of `ERRORS`.
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
    logged = np.r_[[numbers[field.name] for field in FILMS], dynamic.real * spring, found.stiffness * spring]
    if not (np.all(logged > 0.0) and np.all(np.isfinite(logged))):
        return None
    logs, count = np.log(logged), len(FILMS)
    ratios = dynamic.imag / turning / found.damping
    moved = np.abs(left.imag) / turning / found.damping
    wrong = np.column_stack(
        [
            np.maximum(SHARES["stiffness"][0] * np.abs(left.real / dynamic.real), stated.stiffness),
            np.maximum(SHARES["damping"][0] * moved, np.abs(ratios) * stated.damping),
        ]
    ).ravel()
    response = np.column_stack([logs[count:-1], ratios]).ravel()
    errors = np.r_[[getattr(stated, field.name) for field in FILMS], wrong, stated.stiffness]
    return SolvedPoint(np.r_[logs[:count], response], float(logs[-1]), errors)


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
        groups = solve_groups(problem, table_grids(problem), previous, finer=False)
        point = solved_point(problem, groups)
        found.append(point)
        if point is not None:
            previous = groups
    return found


def finer_point(problem: PointProblem) -> SolvedPoint | None:
    """A point on grids with half as many cells more in each direction than those of the table.

    Parameters
    ----------
    problem : PointProblem
        The point.
    """
    return solved_point(problem, solve_groups(problem, table_grids(problem).finer, finer=False))
