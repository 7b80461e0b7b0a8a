"""A case of a point contact: its file `constant/ehlProperties`, and what `ehlFoam` writes of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.openfoam.dictionary import HEADER, block, count, entry, line, oil_blocks, switch
from ehdmaps.openfoam.results import FILM, ended, key_of, number, numbers, read_table
from ehdmaps.physics.lubricant import LubricantState
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solution import Status

COLUMNS = ("x", "y", "pressure", "film", "liquid_fraction")
"""Columns of the table of the film."""

_PAIRS = ("central_film", "minimum_film", "film_offset", "max_pressure", "compliance", "loss_compliance")
"""Numbers that a run writes of both meshes."""

INLET_LENGTH = 20.0
"""Length of the inlet in sqrt(2 h Rx); around the mesh the pressure goes on as it falls there."""

TOLERANCE, MOST_STEPS = 1e-8, 60
"""Length of a step that counts as none, and Newton's steps of a mesh."""


@dataclass(frozen=True)
class PointParameters:
    """One run of a point contact, on a mesh and on one of two thirds of its cells each way.

    Attributes
    ----------
    ellipse : Ellipse
        Radii and E'.
    load : float
        F [N].
    entrainment_speed : float
        Mean u of both surface speeds, which are alike [m/s].
    oil : LubricantState
        State of the oil.
    film : float
        Expected film h Rx/a^2; meshes are laid anew where they find another one.
    columns, lines, rows : int
        Cells along the motion, beside it over half of the contact, and across the film.
    write_fields : bool
        Whether mesh and fields are written when the run is done.
    """

    ellipse: Ellipse
    load: float
    entrainment_speed: float
    oil: LubricantState
    film: float
    columns: int
    lines: int
    rows: int
    write_fields: bool = False

    def text(self) -> str:
        """Return the dictionary.

        Raises
        ------
        InputError
            For anything but a finite number where a number belongs.
        """
        mesh = [entry("film", self.film, "expected film, h Rx/a^2"), entry("inletLength", INLET_LENGTH)]
        lines = [
            entry("reducedRadius", self.ellipse.rolling_radius, "Rx, in the direction of motion [m]"),
            entry("transverseRadius", self.ellipse.transverse_radius, "Ry, across it [m]"),
            entry("reducedModulus", self.ellipse.reduced_modulus),
            entry("load", self.load, "[N]"),
            entry("lowerSpeed", self.entrainment_speed),
            entry("upperSpeed", self.entrainment_speed),
            *oil_blocks(self.oil),
            *block("shear", [line("type", "Newtonian")]),
            line("flow", "thinFilm"),
            count("columns", self.columns),
            count("lines", self.lines, "cells beside the middle, of half the contact"),
            count("rows", self.rows),
            *block("mesh", mesh),
            count("maxIterations", MOST_STEPS),
            entry("tolerance", TOLERANCE),
            switch("writeFields", self.write_fields),
        ]
        return "\n".join([HEADER, "", *lines, ""])


@dataclass(frozen=True)
class PointResults:
    """Numbers of a run, those of the coarse mesh and of the fine one each; NaN in one that did not converge.

    Attributes
    ----------
    status, reason
        How the run ended.
    iterations : int
        Newton's steps on all meshes.
    central_film, minimum_film, film_offset : tuple of float
        [m].
    max_pressure : tuple of float
        [Pa].
    compliance : tuple of float
        1/k [m/N].
    loss_compliance : tuple of float
        c/k^2 [m s/N].
    mass_defect, load_defect : float
        What columns lack of mass, and of the load, on the fine mesh; relative.
    """

    status: Status
    reason: str
    iterations: int
    central_film: tuple[float, ...] = (math.nan, math.nan)
    minimum_film: tuple[float, ...] = (math.nan, math.nan)
    film_offset: tuple[float, ...] = (math.nan, math.nan)
    max_pressure: tuple[float, ...] = (math.nan, math.nan)
    compliance: tuple[float, ...] = (math.nan, math.nan)
    loss_compliance: tuple[float, ...] = (math.nan, math.nan)
    mass_defect: float = math.nan
    load_defect: float = math.nan


@dataclass(frozen=True)
class PointColumns:
    """Half of a film over the centres of its columns.

    Attributes
    ----------
    x, y : ndarray, shape (n,), (m,)
        Centres along the motion and beside it, y > 0 [m].
    pressure, film : ndarray, shape (n, m)
        [Pa], [m].
    liquid_fraction : ndarray, shape (n, m)
        1 where there is oil only.
    """

    x: FloatArray
    y: FloatArray
    pressure: FloatArray
    film: FloatArray
    liquid_fraction: FloatArray


def read_point_results(case: Path) -> PointResults:
    """Read the dictionary `results` of a point contact.

    Parameters
    ----------
    case : Path
        The case folder.

    Raises
    ------
    SolverError
        If it is not there or is not what `ehlFoam` writes: where, what was got, what is allowed.
    """
    path, entries, end = ended(case)
    if end["status"] is not Status.CONVERGED:
        return PointResults(**end)
    end |= {name: numbers(path, entries, key_of(name), 2) for name in _PAIRS}
    end |= {name: number(path, entries, key_of(name)) for name in ("mass_defect", "load_defect")}
    return PointResults(**end)


def read_point_columns(case: Path, columns: int, lines: int) -> PointColumns:
    """Read the table of the film of a point contact.

    Parameters
    ----------
    case : Path
        The case folder.
    columns, lines : int
        Cells along the motion and beside it.

    Raises
    ------
    SolverError
        If it is not there or is not a table of finite numbers with the columns of `COLUMNS`.
    """
    x, y, pressure, film, fraction = (
        np.ascontiguousarray(values.reshape(lines, columns).T)
        for values in read_table(case / FILM, columns * lines, COLUMNS)
    )
    return PointColumns(x[:, 0], y[0], pressure, film, fraction)
