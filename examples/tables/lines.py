"""Making of the film table: lines of films solved in their groups, through nodes and through the middles of cells.

Each line holds the oil and the size, and goes through all places of zeta from light to heavy, every film from the one
before. What is read at the middles is held against what is solved there: these are the errors of the table.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import maximum_filter

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.ehl.group_solution import GroupSolution
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.line import group_spectrum, solve_groups
from ehdmaps.ehl.newton import CONVERGED
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.physics.isotherm import PressureViscosity
from ehdmaps.physics.rheology import ShearLaw
from ehdmaps.physics.solution import Estimate
from ehdmaps.physics.viscosity import ROELANDS_PRESSURE
from ehdmaps.table.coordinates import GRID, valley_shift
from ehdmaps.table.fields import FIELDS, FILMS, LAW, NATURAL_FREQUENCIES, RESPONSES
from ehdmaps.table.file import TableFile
from ehdmaps.table.films import FilmTable
from ehdmaps.table.interpolation import Axes, heavier_films, place_of
from ehdmaps.table.nodes import BEYOND_HEAVY, OTHER_FILMS, Nodes
from ehdmaps.version import version
from examples.tables.files import encoded, exponent_of, load_number_at, rounded

RESOLUTION = Resolution(**GRID)
"""Of all solves: with half as many cells the grid's errors are what limits the table, with more the nodes are."""

LARGEST_EXPONENT, LARGEST_PEAK = 250.0, 15e9
"""alpha p_H, and p_H [Pa], up to which films are solved; beyond, lines go on with their slope."""


def _steps(*parts: tuple[float, float, float]) -> FloatArray:
    """Places from part to part, each uniform with a step near the one that is asked for."""
    places = [parts[0][0]]
    for low, high, step in parts:
        count = max(1, round((high - low) / step))
        places += [low + (high - low) * (i + 1) / count for i in range(count)]
    return np.round(places, 6)


PIEZOVISCOUS = Axes(
    zeta=_steps(
        (-6.0, -1.6, 0.55),
        (-1.6, -0.6, 0.125),
        (-0.6, -0.4, 0.067),
        (-0.4, 0.2, 0.04),
        (0.2, 0.5, 0.06),
        (0.5, 0.8, 0.075),
        (0.8, 1.4, 0.12),
        (1.4, 2.6, 0.24),
        (2.6, 8.6, 0.5),
    ),
    size=np.log([0.2, 0.5, 1.0, 1.8, 3.1, 5, 7.5, 10.5, 14, 18.5, 24, 31, 40, 52, 70, 100, 150]),
    alpha=np.log([5e-9, 8.5e-9, 17e-9, 34e-9, 60e-9]),
    bend=np.array([-0.35, 0.0, 0.35, 0.75, 1.25, 1.85]),
)
"""Nodes for oils that are compressed. The steps of zeta are what the narrow valley of large L needs."""

ISOVISCOUS = Axes(
    zeta=_steps(
        (-6.0, -1.6, 0.55), (-1.6, -0.6, 0.15), (-0.6, 0.8, 0.08), (0.8, 1.4, 0.15), (1.4, 2.6, 0.3), (2.6, 8.6, 0.6)
    ),
    size=np.log([3e7, 1e8, 2.5e8, 5e8, 8e8, 1.2e9, 1.8e9, 2.6e9, 3.8e9, 5.5e9, 8e9, 1.2e10]),
    alpha=np.array([0.0, 1.2e-9, 2.8e-9, 4.8e-9, 7e-9]),
    bend=np.array([-0.23, 0.2, 0.7, 1.19]),
)
"""Nodes for oils of hardly any piezoviscosity."""

INCOMPRESSIBLE = replace(
    PIEZOVISCOUS,
    size=np.log([0.2, 0.7, 1.8, 4, 7.5, 12, 18.5, 28, 40, 60, 95, 150]),
    alpha=np.log([5e-9, 15e-9, 60e-9]),
    bend=np.array([-0.35, 0.15, 0.9, 1.85]),
)
INCOMPRESSIBLE_ISOVISCOUS = replace(ISOVISCOUS, alpha=np.array([0.0, 2.5e-9, 7e-9]), bend=np.array([-0.23, 0.45, 1.19]))
"""Nodes for oils of constant density: alpha then says how far Roelands' law bends, and less hangs on it."""


class Oil(NamedTuple):
    """An oil on the axes of a table: P = L/alpha [Pa], alpha [1/Pa], Roelands' z, and the shift of zeta."""

    pressure: float
    alpha: float
    exponent: float
    shift: float = 0.0


OilOf = Callable[[float, float, float], Oil]
"""The oil at a place of size, alpha and bend."""


def piezoviscous_oil(size: float, alpha: float, bend: float) -> Oil:
    """The oil at a place of the piezoviscous part.

    Parameters
    ----------
    size, alpha, bend : float
        ln L, ln alpha [ln 1/Pa] and the bend.
    """
    value = math.exp(alpha)
    exponent = exponent_of(value, bend)
    shift = float(valley_shift(*(np.array(x) for x in (math.exp(size), value, exponent))))
    return Oil(math.exp(size) / value, value, exponent, shift)


def isoviscous_oil(size: float, alpha: float, bend: float) -> Oil:
    """The oil at a place of the isoviscous part.

    Parameters
    ----------
    size, alpha, bend : float
        ln P [ln Pa], alpha [1/Pa] and 1 - z.
    """
    return Oil(math.exp(size), alpha, 1.0 - bend)


@dataclass(frozen=True, eq=False)
class SolvedLine:
    """Films along one line of the table, shape (n_zeta, fields): smooth forms and their errors."""

    values: FloatArray
    errors: FloatArray


def solve_table_line(zeta: FloatArray, oil: Oil, compressible: bool, resolution: Resolution = RESOLUTION) -> SolvedLine:
    """Films at each zeta; NaN where there is no solution.

    Parameters
    ----------
    zeta : ndarray, shape (n,)
        Rising places.
    oil : Oil
        The oil.
    compressible : bool
        Whether the density is that of Dowson and Higginson.
    resolution : Resolution
        Accuracy of the solves.
    """
    isotherm, oil_number = PressureViscosity(oil.alpha, oil.exponent, ROELANDS_PRESSURE), oil.alpha * oil.pressure
    loads = load_number_at(zeta, np.array(oil_number), oil.shift)
    values, errors = (np.full((zeta.size, len(FIELDS)), math.nan) for _ in range(2))
    previous = None
    for i, M in enumerate(map(float, loads)):
        peak = oil.pressure * math.sqrt(M / (2.0 * math.pi))
        if peak > LARGEST_PEAK or oil.alpha * peak > LARGEST_EXPONENT:
            break
        problem = LineProblem(3.0 * math.pi**2 / (8.0 * M * M), isotherm.isotherm(peak, compressible), ShearLaw(), 0.0)
        try:
            with np.errstate(all="ignore"):
                groups = solve_groups(problem, M, oil_number, resolution, previous)
                if groups.outcome != CONVERGED:
                    continue
                values[i], errors[i] = _smooth(*_reduced(M, oil_number, groups))
        except (np.linalg.LinAlgError, OverflowError, ZeroDivisionError):
            continue
        previous = groups.profile
    return SolvedLine(values, errors)


def _smooth(reduced: FloatArray, relative: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Smooth forms of a film's reduced numbers and their errors; NaN where any of them has none."""
    lifted = np.array([field.lifted(x) for field, x in zip(FIELDS, reduced, strict=True)])
    wrong = np.array([field.lifted_error(x, e) for field, x, e in zip(FIELDS, reduced, relative, strict=True)])
    return (lifted, wrong) if np.all(np.isfinite(lifted)) else (lifted * math.nan, wrong * math.nan)


def _reduced(M: float, L: float, groups: GroupSolution) -> tuple[FloatArray, FloatArray]:
    """Numbers of one film by the units of `ehdmaps.table.fields`, and their errors.

    In Hertz' units b^2/R = R sqrt(Us) 8 M/pi and b/(p_H R) = 4/E'.
    """
    profile, rough = groups.profile, groups.rough
    assert profile is not None and rough is not None
    film = 8.0 * M / math.pi
    # p_H = E' sqrt(M/(2 pi)) Us^(1/4), sqrt(eta u w) = E' R sqrt(M/2) Us^(3/4)
    force = film * math.sqrt(M / (2.0 * math.pi)) / math.sqrt(0.5 * M)
    # eta u R/b^2 = (Us/2) E' R^2/b^2 over p_H b/R
    stress = 0.5 / film / (math.sqrt(M / (2.0 * math.pi)) * math.sqrt(film))
    # of first order, as it is that of the steepest cell of a spike
    steepest = Estimate(profile.wall_stress, 1.5 * abs(rough.wall_stress / profile.wall_stress - 1.0))
    numbers = {
        "film_offset": (groups.film_offset, film),
        "film_compliance": (groups.film_compliance, 4.0),
        "loss_compliance": (groups.loss, 4.0),
        "central_film": (groups.central_film, film),
        "minimum_film": (groups.minimum_film, film),
        "max_pressure": (groups.max_pressure, 1.0),
        "rolling_force": (groups.rolling_force, force),
        "mass_flow": (groups.mass_flow, film),
        "wall_stress": (steepest, stress),
    }
    found = [numbers[field.name] for field in FILMS]
    # omega sqrt(b^2 + 2 h R)/u, with h R/b^2 the film offset in Hertz' units
    frequencies = np.array(NATURAL_FREQUENCIES) / math.sqrt(1.0 + 2.0 * groups.film_offset)
    spectrum = group_spectrum(M, L, groups, frequencies)
    response = 4.0 * spectrum.compliance
    wrong = 4.0 * np.max(np.abs(spectrum.errors), axis=1)
    parts = np.column_stack([response.real, response.imag]).ravel()
    part_errors = np.repeat(wrong, 2) / np.abs(parts)
    return (
        np.r_[[number * unit for number, unit in found], parts],
        np.r_[[abs(number.error) for number, _ in found], part_errors],
    )


def filled(zeta: FloatArray, values: FloatArray) -> FloatArray:
    """Smooth forms with what is missing filled in along zeta, so that polynomials can go through all.

    A hole between solved films is bridged by a cubic; beyond the last solved film of a line the values go on as beyond
    the end of a table.

    Parameters
    ----------
    zeta : ndarray, shape (n_zeta,)
        The nodes.
    values : ndarray, shape (n_zeta, n_size, n_alpha, n_bend, fields)
        Smooth forms; NaN where there is no film.
    """
    whole = values.copy()
    solved: BoolArray = np.asarray(np.isfinite(values).all(axis=-1))
    for place in np.ndindex(solved.shape[1:]):
        line, known = whole[(slice(None), *place)], solved[(slice(None), *place)]
        z, held = zeta[known], line[known]
        inside, beyond = ~known & (zeta < z[-1]), zeta > z[-1]
        line[inside] = PchipInterpolator(z, held)(zeta[inside])
        slope = (held[-1] - held[-3]) / (z[-1] - z[-3])
        for k, field in enumerate(FIELDS):
            line[beyond, k] = heavier_films(field, held[-1:, k], slope[k : k + 1], zeta[beyond] - z[-1])
    return whole


def middles(nodes: FloatArray) -> FloatArray:
    """Middles between nodes."""
    return 0.5 * (nodes[1:] + nodes[:-1])


def measured(nodes: Nodes, values: FloatArray, errors: FloatArray) -> FloatArray:
    """Errors of the smooth forms in each cell, shape (n_zeta - 1, n_size - 1, n_alpha - 1, n_bend - 1, fields).

    They are what films in the middle of the cells are read wrong by, and what the solver says that these are wrong by;
    the worst of neighbouring cells along zeta and the size. Above the heaviest film that was solved they grow as above
    the end of a table.

    Parameters
    ----------
    nodes : Nodes
        The nodes; their errors count for nothing.
    values, errors : ndarray, shape as of what is returned
        Smooth forms of solved films in the middle of the cells, and their errors; NaN where there is none.
    """
    axes = nodes.axes
    places = np.meshgrid(*(middles(x) for x in (axes.zeta, axes.size, axes.alpha, axes.bend)), indexing="ij")
    place = place_of(axes, *(x.ravel() for x in places))
    read = np.hstack([nodes.read(place, fields) for fields in (LAW, OTHER_FILMS, RESPONSES)]).reshape(values.shape)
    wrong = np.abs(read - values) + errors
    nearby = maximum_filter(np.nan_to_num(wrong, nan=-1.0), size=(3, 3, 1, 1, 1), mode="nearest")
    for i in range(1, nearby.shape[0]):
        # a unit above the last film
        carried = nearby[i - 1] + BEYOND_HEAVY * (axes.zeta[i + 1] - axes.zeta[i])
        nearby[i] = np.where(nearby[i] < 0.0, carried, nearby[i])
    return np.asarray(np.where(nearby < 0.0, math.nan, nearby))


def make_nodes(
    axes: Axes,
    oil_of: OilOf,
    compressible: bool,
    resolution: Resolution = RESOLUTION,
    progress: Callable[[int, int], None] = lambda done, of: None,
) -> Nodes:
    """Solve all nodes of one part of a table, and films in the middle of its cells, every second one along zeta.

    Parameters
    ----------
    axes : Axes
        The nodes.
    oil_of : callable
        The oil at their places.
    compressible : bool
        Whether the density is that of Dowson and Higginson.
    resolution : Resolution
        Accuracy of the solves.
    progress : callable
        Told the lines that are done, and all of them.
    """
    of, done = int(np.prod(axes.shape[1:]) + np.prod(axes.cells[1:])), 0
    solved = []
    for between in (False, True):
        zeta, *oil = (middles(x) if between else x for x in (axes.zeta, axes.size, axes.alpha, axes.bend))
        values, errors = (np.full((*(x.size for x in (zeta, *oil)), len(FIELDS)), math.nan) for _ in range(2))
        for j, k, p in np.ndindex(values.shape[1:-1]):
            place = oil_of(float(oil[0][j]), float(oil[1][k]), float(oil[2][p]))
            part = slice((j + k + p) % 2, None, 2) if between else slice(None)
            if place.alpha == 0.0 and p > 0:
                values[:, j, k, p], errors[:, j, k, p] = values[:, j, k, 0], errors[:, j, k, 0]
            else:
                line = solve_table_line(zeta[part], place, compressible, resolution)
                values[part, j, k, p], errors[part, j, k, p] = line.values, line.errors
            done += 1
            progress(done, of)
        solved.append((values, errors))
    (values, _), (between_values, between_errors) = solved
    empty = np.zeros((*axes.cells, len(FIELDS)), dtype=np.uint8)
    nodes = Nodes(axes, rounded(filled(axes.zeta, values)), empty)
    return replace(nodes, codes=encoded(measured(nodes, between_values, between_errors)))


def make_tables(progress: Callable[[str, int, int], None] = lambda law, done, of: None) -> TableFile:
    """Solve the tables that the package ships.

    Parameters
    ----------
    progress : callable
        Told what is solved, the lines that are done, and all of them.
    """
    tables = {}
    for law, piezoviscous, isoviscous in (
        ("dowson-higginson", PIEZOVISCOUS, ISOVISCOUS),
        ("incompressible", INCOMPRESSIBLE, INCOMPRESSIBLE_ISOVISCOUS),
    ):
        compressible = law != "incompressible"
        tables[law] = FilmTable(
            make_nodes(
                piezoviscous, piezoviscous_oil, compressible, progress=partial(progress, f"{law}, piezoviscous")
            ),
            make_nodes(isoviscous, isoviscous_oil, compressible, progress=partial(progress, f"{law}, isoviscous")),
            compressible,
        )
    return TableFile(
        tables,
        {
            "title": "Films of smooth, flooded, Newtonian, isothermal line contacts over their groups",
            "source": "solver reynolds of ehdmaps",
            "settings": str(RESOLUTION),
            "software": version(),
            "made_by": "python -m examples.tables lines",
        },
    )
