"""One grid of a point by `ehlFoam`, in as many tries as it takes."""

from __future__ import annotations

import shutil
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import SolverError
from ehdmaps.openfoam.case import working_case
from ehdmaps.openfoam.fields import FilmFields, read_fields
from ehdmaps.openfoam.installation import Installation
from ehdmaps.openfoam.parameters import Parameters, Start, Temperatures
from ehdmaps.openfoam.results import THIN_FILM, FilmTable, Results, read_film, read_results, read_temperatures
from ehdmaps.openfoam.run import KilledError, RunError, TimeLimit, log_tail, run
from ehdmaps.physics.rheology import NEWTONIAN, wall_stress_note
from ehdmaps.physics.solution import Status

MOVED_COLUMNS = 1.1
"""Columns of a second try, over those asked for."""

TRIED_AGAIN = (Status.STAGNATED, Status.OUTSIDE_VALIDITY)
"""Statuses of a run that may converge from another start or on other columns."""

LEAST_ROWS = 2
"""Rows from which the solver takes the gradient at a wall."""

BETWEEN = 0.75
"""Cells each way of a grid between the coarse one and the fine one, over those of the fine one."""

QUARTER = -7.0 / 128.0, 105.0 / 128.0, 35.0 / 128.0, -5.0 / 128.0
"""Weights of four points of equal distance in the cubic through them, a quarter of the way from second to third."""


@dataclass(frozen=True)
class GridSolution:
    """Result of one run; `temperatures` are None of an isothermal film, `note` says so where it took two tries."""

    results: Results
    film: FilmTable
    fields: FilmFields | None
    cavitation_range: float
    temperatures: Temperatures | None = None
    note: str = ""

    @property
    def start(self) -> Start:
        """Start for another grid.

        The mixture behind the film's rupture is told by a pressure below zero. With all stresses what loads the
        surfaces there is another one, of the oil that is drawn apart.

        With heat it has values between the columns, too: on straight lines between those of a coarse grid the front of
        a spike stands beside its place, by more than Newton's method finds back with a limiting stress.
        """
        mixture = -self.cavitation_range * (1.0 - self.film.liquid_fraction)
        pressure = np.where(self.film.liquid_fraction < 1.0, mixture, self.film.pressure)
        if self.temperatures is None:
            return Start(self.film.x, pressure, self.results.central_film)
        temperatures = replace(self.temperatures, values=_between(self.temperatures.values))
        return Start(_between(self.film.x), _between(pressure), self.results.central_film, temperatures)


@dataclass(frozen=True)
class GridSolver:
    """Runs of single grids.

    Attributes
    ----------
    installed : Installation
        The programs.
    keep_cases : Path or None
        Folder in which the cases of all runs are kept, with their fields.
    """

    installed: Installation
    keep_cases: Path | None = None

    def solve(
        self, parameters: Parameters, name: str, with_fields: bool, limit: TimeLimit, start: Start | None = None
    ) -> GridSolution:
        """Run one grid from `start`; where that fails to converge over a grid between, from its own start, on others.

        Behind a steep pressure spike, whether Newton's method converges depends on the positions of the columns, and
        the spike of a grid twice as coarse may be too far from that of the fine one.

        Parameters
        ----------
        parameters : Parameters
            Parameters of the run, with its own start.
        name : str
            Name of the folder, if cases are kept.
        with_fields : bool
            Whether to read the fields.
        limit : TimeLimit
            Time after which a run is stopped.
        start : Start, optional
            What to start from first, such as the solution on a coarser grid.

        Raises
        ------
        RunError
            If the last try gives no converged solution, or one fails in another way than by stagnating.
        SolverError
            If no case can be made.
        """
        moved = _resized(parameters, MOVED_COLUMNS, 1.0)
        tries: list[tuple[Parameters, ...]] = [(parameters,), (moved,)]
        if start is not None:
            begun = replace(parameters, start=start)
            # without its temperatures it begins with an oil that hardly stiffens, in many stages
            cold = [] if start.temperatures is None else [(replace(begun, start=replace(start, temperatures=None)),)]
            # all stresses start from the thin film of the same grid in any case: whatever that was started from
            thin = parameters.flow == "thin_film"
            through = [(_resized(begun, BETWEEN, BETWEEN), parameters)] if thin else []
            tries = [(begun,), *through, *cold, *tries[0 if thin else 1 :]]
        for attempt in tries:
            try:
                grid = self._in_turn(attempt, name, with_fields, limit)
            except RunError as error:
                if error.status not in TRIED_AGAIN or attempt is tries[-1]:
                    raise
                self._forget(error)
            else:
                note = "" if attempt is not tries[-1] else f"solved on {moved.columns} columns"
                return replace(grid, note="; ".join(filter(None, [grid.note, note])))
        raise AssertionError("unreachable: the last try returns or raises")

    def run_case(self, parameters: Parameters, name: str, with_fields: bool, limit: TimeLimit) -> GridSolution:
        """Run one case; one that was killed from outside is tried a second time.

        Parameters
        ----------
        parameters : Parameters
            Parameters of the run.
        name : str
            Name of the folder, if cases are kept.
        with_fields : bool
            Whether to read the fields.
        limit : TimeLimit
            Time after which it is stopped.

        Raises
        ------
        RunError
            If it gives no converged solution.
        SolverError
            If no case can be made.
        """
        try:
            return self._run_once(parameters, name, with_fields, limit)
        except KilledError as first:
            self._forget(first)
            try:
                second = self._run_once(parameters, name, with_fields, limit)
            except KilledError as error:
                raise RunError(f"killed twice: {error}", case=error.case) from error
            # Its log is gone.
            return replace(second, note=f"solved at the second try, the first {str(first).partition(';')[0]}")

    def _run_once(self, parameters: Parameters, name: str, with_fields: bool, limit: TimeLimit) -> GridSolution:
        """One run in a folder of its own."""
        kept = self.keep_cases
        text = replace(parameters, write_fields=with_fields or kept is not None).text()
        folder = f"{name}_{parameters.columns}x{parameters.rows}"
        environment = self.installed.full_environment()
        with working_case(self.installed.template, text, folder, kept) as case:
            log = run(self.installed.solver, case, environment, limit)
            try:
                results = read_results(case)
                if results.status is Status.CONVERGED and len(results.frequencies) != len(parameters.frequencies):
                    raise SolverError(
                        f"{case / 'results'}: got responses at {results.frequencies} Hz; allowed: as asked"
                    )
                if results.status is Status.CONVERGED:
                    film = read_film(case, parameters.columns)
                    fields = read_fields(case) if with_fields else None
                    return GridSolution(results, film, fields, parameters.cavitation_range, _warmth(case, parameters))
                status, reason = _cause(parameters, results, case)
            except SolverError as error:
                raise RunError(f"{error}; {log_tail(log)}") from error
            raise RunError(f"ehlFoam {status.word}: {reason}; {log_tail(log)}", status, results.iterations)

    def _in_turn(self, grids: tuple[Parameters, ...], name: str, with_fields: bool, limit: TimeLimit) -> GridSolution:
        """Run the last of some grids, from the solution of the one before if there is one."""
        *before, last = grids
        for grid in before:
            last = replace(last, start=self.run_case(grid, name, False, limit).start)
        return self.run_case(last, name, with_fields, limit)

    def _forget(self, error: RunError) -> None:
        """Remove the folder of a failed run after which another one follows, unless cases are kept."""
        if self.keep_cases is None and error.case is not None:
            shutil.rmtree(error.case, ignore_errors=True)


def _warmth(case: Path, parameters: Parameters) -> Temperatures | None:
    """Temperatures of a run, over its columns; None of an isothermal film."""
    if parameters.heat is None:
        return None
    rows = parameters.rows
    levels = np.concatenate([[0.0], (np.arange(rows) + 0.5) / rows, [1.0]])
    return Temperatures(levels, read_temperatures(case, parameters.columns, rows))


def _between(values: FloatArray) -> FloatArray:
    """Values of columns, and those a quarter of the way to the columns beside them: where twice as many have theirs.

    On cubics through four columns, kept between the two at both sides.

    Parameters
    ----------
    values : ndarray, shape (..., n)

    Returns
    -------
    ndarray, shape (..., 3 n - 2)
        Values of the columns and between them, none beyond the first and the last column.
    """
    count = values.shape[-1]
    table = np.empty((*values.shape[:-1], 3 * count - 2))
    table[..., ::3] = values
    near, far = values[..., :-1], values[..., 1:]
    before = np.concatenate([values[..., :1], values[..., :-2]], axis=-1)
    behind = np.concatenate([values[..., 2:], values[..., -1:]], axis=-1)
    for first, ends in ((1, (before, near, far, behind)), (2, (behind, far, near, before))):
        curve = sum(weight * end for weight, end in zip(QUARTER, ends, strict=True))
        table[..., first::3] = np.clip(curve, np.minimum(near, far), np.maximum(near, far))
    return table


def _cause(parameters: Parameters, results: Results, case: Path) -> tuple[Status, str]:
    """Status and reason of a run without a solution: whether all stresses of a Newtonian oil can have one there."""
    if results.status is Status.STAGNATED and parameters.flow == "full_stress" and parameters.shear.form == NEWTONIAN:
        thin = read_film(case, parameters.columns, THIN_FILM) if (case / THIN_FILM).exists() else None
        note = wall_stress_note(thin.x, thin.pressure, thin.film) if thin else ""
        if note:
            return Status.OUTSIDE_VALIDITY, (
                f"the thin film has a {note}; with all stresses {results.reason}: take flow thin_film, or a law of "
                "shear that limits the stress"
            )
    return results.status, results.reason


def _resized(parameters: Parameters, columns: float, rows: float) -> Parameters:
    """The same on so many times the cells."""
    return replace(
        parameters, columns=round(columns * parameters.columns), rows=max(round(rows * parameters.rows), LEAST_ROWS)
    )
