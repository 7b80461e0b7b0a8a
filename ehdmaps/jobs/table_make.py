"""Making of the film table: lines of films solved in their groups, node by node.

Each line holds L, alpha and the bend, and goes through all nodes of zeta from light to heavy, every film from the one
before.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import maximum_filter

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.ehl.frequency import group_spectrum
from ehdmaps.ehl.group_solution import GroupSolution
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.newton import CONVERGED
from ehdmaps.ehl.resolution import Resolution
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.physics.isotherm import PressureViscosity
from ehdmaps.physics.moes import viscosity_exponent
from ehdmaps.physics.pressure_viscosity import ROELANDS_PRESSURE
from ehdmaps.physics.rheology import ShearLaw
from ehdmaps.table.coordinates import exponent_of, load_number_at
from ehdmaps.table.family import GRID
from ehdmaps.table.fields import FIELDS, FILMS, NATURAL_FREQUENCIES
from ehdmaps.table.file import ROUNDING, TableFile, rounded
from ehdmaps.table.films import LARGEST_ERROR, FilmTable, encoded
from ehdmaps.table.interpolation import Axes, left_out
from ehdmaps.version import version

RESOLUTION = Resolution(**GRID)
"""Of all solves: with half as many cells the grid's errors are what limits the table, with more the nodes are."""

LARGEST_EXPONENT = 250.0
"""alpha p_H up to which films are solved; beyond, lines go on with their slope. At 10 GPa it is that of 25 1/GPa."""


def _steps(*parts: tuple[float, float, float]) -> FloatArray:
    """Places from part to part, each uniform with a step near the one that is asked for."""
    places = [parts[0][0]]
    for low, high, step in parts:
        count = max(1, round((high - low) / step))
        places += [low + (high - low) * (i + 1) / count for i in range(count)]
    return np.round(places, 6)


AXES = Axes(
    zeta=_steps(
        (-6.0, -1.6, 0.55),
        (-1.6, -0.6, 0.125),
        (-0.6, -0.3, 0.1),
        (-0.3, 0.45, 0.05),
        (0.45, 0.8, 0.07),
        (0.8, 1.4, 0.12),
        (1.4, 2.6, 0.24),
        (2.6, 8.6, 0.5),
    ),
    log_l=np.log([0.2, 0.7, 1.6, 3.0, 5.0, 7.5, 10.5, 14.0, 18.5, 24.0, 31.0, 40.0, 52.0, 68.0, 90.0, 118.0, 150.0]),
    log_alpha=np.log([5e-9, 8.5e-9, 17e-9, 34e-9, 60e-9]),
    bend=np.array([-0.35, 0.0, 0.35, 0.8, 1.4]),
)
"""Nodes for oils that are compressed. The steps of zeta are what the narrow valley of large L needs."""

INCOMPRESSIBLE = replace(AXES, log_alpha=np.log([5e-9, 15e-9, 60e-9]), bend=np.array([-0.35, 0.1, 0.7, 1.4]))
"""Nodes for oils of constant density: alpha then says how far Roelands' law bends, and less hangs on it."""


@dataclass(frozen=True, eq=False)
class SolvedLine:
    """Films along one line of the table, shape (n_zeta, fields): reduced numbers and their relative errors."""

    values: FloatArray
    errors: FloatArray


def solve_table_line(
    zeta: FloatArray,
    oil_number: float,
    alpha: float,
    bend: float,
    compressible: bool,
    resolution: Resolution = RESOLUTION,
) -> SolvedLine:
    """Films at each zeta; NaN where there is no solution.

    Parameters
    ----------
    zeta : ndarray, shape (n,)
        Rising places.
    oil_number, alpha, bend : float
        L, alpha [1/Pa] and the bend.
    compressible : bool
        Whether the density is that of Dowson and Higginson.
    resolution : Resolution
        Accuracy of the solves.
    """
    exponent = exponent_of(alpha, bend)
    loads = load_number_at(zeta, *(np.array(x) for x in (oil_number, alpha, exponent)))
    isotherm = PressureViscosity(alpha, exponent, ROELANDS_PRESSURE)
    values, errors = (np.full((zeta.size, len(FIELDS)), math.nan) for _ in range(2))
    previous = None
    for i, M in enumerate(map(float, loads)):
        exponent_there = viscosity_exponent(M, oil_number)
        if exponent_there > LARGEST_EXPONENT:
            break
        peak = exponent_there / alpha
        problem = LineProblem(3.0 * math.pi**2 / (8.0 * M * M), isotherm.isotherm(peak, compressible), ShearLaw(), 0.0)
        try:
            with np.errstate(all="ignore"):
                groups = solve_groups(problem, M, oil_number, resolution, previous)
                if groups.outcome != CONVERGED:
                    continue
                values[i], errors[i] = _reduced(M, oil_number, groups)
        except (np.linalg.LinAlgError, OverflowError, ZeroDivisionError):
            continue
        previous = groups.profile
    return SolvedLine(values, errors)


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
    values = {
        "film_offset": groups.film_offset * film,
        "film_compliance": 4.0 * groups.film_compliance,
        "loss_compliance": 4.0 * groups.loss,
        "central_film": groups.central_film * film,
        "minimum_film": groups.minimum_film * film,
        "max_pressure": groups.max_pressure,
        "rolling_force": groups.rolling_force * force,
        "mass_flow": groups.mass_flow * film,
        "wall_stress": profile.wall_stress * stress,
    }
    errors = {
        "film_offset": groups.film_offset_error,
        "film_compliance": groups.film_compliance_error,
        "loss_compliance": groups.loss_error,
        "central_film": groups.central_film_error,
        "minimum_film": groups.minimum_film_error,
        "max_pressure": groups.max_pressure_error,
        "rolling_force": groups.rolling_force_error,
        "mass_flow": groups.mass_flow_error,
        # of first order, as it is that of the steepest cell of a spike
        "wall_stress": 1.5 * abs(rough.wall_stress / profile.wall_stress - 1.0),
    }
    # omega sqrt(b^2 + 2 h R)/u, with h R/b^2 the film offset in Hertz' units
    frequencies = np.array(NATURAL_FREQUENCIES) / math.sqrt(1.0 + 2.0 * groups.film_offset)
    spectrum = group_spectrum(M, L, groups, frequencies)
    response = 4.0 * spectrum.compliance
    wrong = 4.0 * np.max(np.abs(spectrum.errors), axis=1)
    parts = np.column_stack([response.real, response.imag]).ravel()
    part_errors = np.repeat(wrong, 2) / np.abs(parts)
    return (
        np.r_[[values[field.name] for field in FILMS], parts],
        np.r_[[abs(errors[field.name]) for field in FILMS], part_errors],
    )


def filled(axes: Axes, values: FloatArray, errors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Smooth forms and their errors with what is missing filled in along zeta, so that polynomials can go through all.

    A hole between solved films is bridged by a cubic; beyond the last solved film of a line the values go on with
    their slope there. What is filled in gets an error by which no film of it is taken.

    Parameters
    ----------
    axes : Axes
        The nodes.
    values, errors : ndarray, shape (n_zeta, n_L, n_alpha, n_bend, fields)
        Reduced numbers and their relative errors; NaN where there is no film.
    """
    lifted, wrong = np.empty_like(values), np.empty_like(values)
    for k, field in enumerate(FIELDS):
        lifted[..., k] = field.lifted(values[..., k])
        wrong[..., k] = field.lifted_error(values[..., k], errors[..., k])
    solved: BoolArray = np.asarray(np.isfinite(lifted).all(axis=-1))
    for place in np.ndindex(solved.shape[1:]):
        known = solved[(slice(None), *place)]
        line = lifted[(slice(None), *place)]
        line[:] = _along(axes.zeta, line, known)
        wrong[(~known, *place)] = np.nan
    return lifted, wrong


def _along(zeta: FloatArray, line: FloatArray, known: BoolArray) -> FloatArray:
    """A line with what is missing."""
    z, held = zeta[known], line[known]
    found = line.copy()
    inside = np.asarray(~known & (zeta < z[-1]))
    found[inside] = PchipInterpolator(z, held)(zeta[inside])
    beyond = zeta > z[-1]
    slope = (held[-1] - held[-3]) / (z[-1] - z[-3])
    found[beyond] = held[-1] + slope * (zeta[beyond] - z[-1])[:, None]
    return found


def assembled_table(axes: Axes, values: FloatArray, errors: FloatArray, compressible: bool) -> FilmTable:
    """A table of solved films.

    Its errors are those that the solver states, what reading between the nodes is wrong by, from leaving nodes out, and
    what rounding takes; the worst of neighbouring nodes along zeta and ln L.

    Parameters
    ----------
    axes : Axes
        The nodes.
    values, errors : ndarray, shape (n_zeta, n_L, n_alpha, n_bend, fields)
        Reduced numbers and their relative errors; NaN where there is no film.
    compressible : bool
        Whether the density is that of Dowson and Higginson.
    """
    lifted, wrong = filled(axes, values, errors)
    total = np.nan_to_num(wrong, nan=LARGEST_ERROR) + left_out(axes, lifted) + ROUNDING * np.abs(lifted)
    nearby = maximum_filter(total, size=(3, 3, 1, 1, 1), mode="nearest")
    return FilmTable(axes, rounded(lifted), encoded(nearby), compressible)


def make_table(
    axes: Axes,
    compressible: bool,
    resolution: Resolution = RESOLUTION,
    progress: Callable[[int, int], None] = lambda done, of: None,
) -> FilmTable:
    """Solve all nodes of a table.

    Parameters
    ----------
    axes : Axes
        The nodes.
    compressible : bool
        Whether the density is that of Dowson and Higginson.
    resolution : Resolution
        Accuracy of the solves.
    progress : callable
        Told the lines that are done, and all of them.
    """
    values, errors = (np.full((*axes.shape, len(FIELDS)), math.nan) for _ in range(2))
    places = list(np.ndindex(axes.shape[1:]))
    for done, (j, k, p) in enumerate(places):
        oil = float(np.exp(axes.log_l[j])), float(np.exp(axes.log_alpha[k])), float(axes.bend[p])
        line = solve_table_line(axes.zeta, *oil, compressible, resolution)
        values[:, j, k, p], errors[:, j, k, p] = line.values, line.errors
        progress(done + 1, len(places))
    return assembled_table(axes, values, errors, compressible)


def make_tables(progress: Callable[[str, int, int], None] = lambda law, done, of: None) -> TableFile:
    """Solve the tables that the package ships.

    Parameters
    ----------
    progress : callable
        Told the density law, the lines that are done, and all of them.
    """
    tables = {
        law: make_table(axes, law != "incompressible", progress=partial(progress, law))
        for law, axes in (("dowson-higginson", AXES), ("incompressible", INCOMPRESSIBLE))
    }
    return TableFile(
        tables,
        {
            "title": "Films of smooth, flooded, Newtonian, isothermal line contacts over their groups",
            "source": "solver reynolds of ehdmaps",
            "settings": str(RESOLUTION),
            "software": version(),
            "made_by": "ehdmaps table make",
        },
    )
