"""Points of a ball bearing by OpenFOAM, in the words of a solution by `reynolds`; the fields of their films."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.extras import lacking
from ehdmaps.jobs import solvers
from ehdmaps.openfoam.fields import write_fields
from ehdmaps.openfoam.point import OpenFoamPointSolver, PointFilm
from ehdmaps.openfoam.point_case import PointColumns
from ehdmaps.outputs import FIELDS, Output, output_problems
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solution import PointNumbers
from ehdmaps.point.solver import PointField, PointSolution


@dataclass(frozen=True)
class CfdPoints:
    """Points by OpenFOAM: where cases and fields go.

    Attributes
    ----------
    solver : OpenFoamPointSolver
        What solves them.
    fields : Path or None
        VTU or XDMF; the name of each contact is added.
    """

    solver: OpenFoamPointSolver
    fields: Path | None

    def solve(
        self, name: str, ellipse: Ellipse, oil: Lubricant, load: float, speed: float, temperature: float
    ) -> tuple[PointSolution, str]:
        """Solve a contact and write its fields.

        Parameters
        ----------
        name : str
            Name of the contact.
        ellipse : Ellipse
            The contact.
        oil : Lubricant
            The oil.
        load, speed, temperature : float
            F [N], u [m/s], T [K].

        Returns
        -------
        solution : PointSolution
            Numbers of the point, without a response over frequency, and groups.
        written : str
            What was written, and the mesh, in words.
        """
        found = self.solver.solve(ellipse, oil, load, speed, temperature, self.fields is not None, name)
        said = ""
        if found.status.usable:
            columns, lines, rows = found.mesh
            said = f"{name}: half of the contact on {columns} x {lines} columns of {rows} cells"
            if self.fields is not None and found.fields is not None:
                path = fields_path(self.fields, name)
                write_fields(found.fields, path)
                said += f"; {path}: written"
        return _solution(found, ellipse, load, speed, temperature), said


def cfd_points(fields: str | None, keep_cases: str | None, contacts: tuple[str, ...]) -> CfdPoints:
    """Check what is asked for before anything is solved.

    Parameters
    ----------
    fields : str or None
        File for the fields of the films.
    keep_cases : str or None
        Folder in which cases are kept.
    contacts : tuple of str
        Names of the contacts.

    Raises
    ------
    InputError
        If OpenFOAM or `ehlFoam` is missing, or a file or folder may not be written.
    """
    problems = Problems()
    if fields is not None:
        problems += lacking("openfoam", "meshio", "--fields")
        problems += output_problems([Output("--fields", fields_path(Path(fields), name), FIELDS) for name in contacts])
    try:
        solver = OpenFoamPointSolver(**solvers.case_options("openfoam", keep_cases))
    except InputError as error:
        raise InputError([*problems, *error.problems]) from None
    problems.check()
    return CfdPoints(solver, None if fields is None else Path(fields))


def fields_path(path: Path, contact: str) -> Path:
    """Return the file of the fields of a contact.

    Parameters
    ----------
    path : Path
        File as it was given.
    contact : str
        Name of the contact.
    """
    return path.with_name(f"{path.stem}-{contact}{path.suffix}") if path.name else path


def _solution(found: PointFilm, ellipse: Ellipse, load: float, speed: float, temperature: float) -> PointSolution:
    """The same numbers in the words of the other solver."""
    numbers: dict[str, Any] = {one.name: getattr(found, one.name) for one in dataclasses.fields(PointNumbers)}
    field = None if found.columns is None else _field(found.columns)
    return PointSolution(found.status, found.reason, load, speed, temperature, ellipse, **numbers, field=field)


def _field(columns: PointColumns) -> PointField:
    """Pressure and film with the middle y = 0, where they are even."""
    first, second = columns.y[0] ** 2, columns.y[1] ** 2

    def with_middle(values: FloatArray) -> FloatArray:
        middle = (second * values[:, 0] - first * values[:, 1]) / (second - first)
        return np.column_stack([np.maximum(middle, 0.0), values])

    return PointField(columns.x, np.r_[0.0, columns.y], with_middle(columns.pressure), with_middle(columns.film))
