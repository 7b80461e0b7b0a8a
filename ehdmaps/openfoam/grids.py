"""The grids of one point, and what they say together: a number less the error of its rows, and what may be left."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeVar

from ehdmaps.arrays import ComplexArray
from ehdmaps.openfoam.grid_solver import GridSolution, GridSolver
from ehdmaps.openfoam.parameters import Parameters
from ehdmaps.openfoam.run import RunError, TimeLimit

Number = TypeVar("Number", float, ComplexArray)

ORDER_DIVISOR = 3.0
"""2^2 - 1: the error of the finer of two grids, of second order, is this part of their difference."""

ROWS_MATTER = {"film_offset": 5e-4, "loss_compliance": 5e-3}
"""Relative error of half the rows beside the asked ones, above which twice as many are solved too."""

ROWS_SHARE = 0.5
"""Of the time that is left, which the grid may take that tells what rows cost: the film itself needs the rest."""


@dataclass(frozen=True)
class Grids:
    """Solutions of one point.

    Attributes
    ----------
    coarse, fine : GridSolution
        Solutions on half the columns and rows, and on those that are asked for.
    rows, more_rows : GridSolution, optional
        Solutions on half the columns, with the rows that are asked for and with twice as many: films with heat.
    note : str
        Text on a grid that was not solved.
    """

    coarse: GridSolution
    fine: GridSolution
    rows: GridSolution | None = None
    more_rows: GridSolution | None = None
    note: str = ""

    def number(self, number: Callable[[GridSolution], Number], order: int = 2) -> tuple[Number, Number, Number]:
        """Return a number, the error of its columns (> 0 where more of them lower it), and that of its rows.

        The rows' error is of second order from a few rows on. What taking it off changes counts as what is left: with
        few rows other orders have their share.

        Parameters
        ----------
        number : callable
            Function of a grid's solution.
        order : int
            Order by which more columns lower its error.
        """
        fine, divisor = number(self.fine), 2.0**order - 1.0
        if self.rows is None:
            return fine, (number(self.coarse) - fine) / divisor, fine * 0.0
        rows = number(self.rows)
        columns = (rows - fine) / divisor
        if self.more_rows is None:
            left = (number(self.coarse) - rows) / ORDER_DIVISOR
            return fine - left, columns, left
        more = number(self.more_rows)
        left = (rows - more) / ORDER_DIVISOR
        return fine + more - rows - left, columns, left

    @property
    def iterations(self) -> int:
        """Iterations of all of them."""
        return sum(grid.results.iterations for grid in self._solved)

    @property
    def notes(self) -> list[str]:
        """Notes of all of them."""
        return [*(grid.note for grid in self._solved), self.note]

    @property
    def _solved(self) -> tuple[GridSolution, ...]:
        return tuple(grid for grid in (self.coarse, self.rows, self.fine, self.more_rows) if grid is not None)


def with_rows(
    grids: GridSolver, coarse: GridSolution, fine: Parameters, name: str, with_fields: bool, limit: TimeLimit
) -> Grids:
    """Solve a point on the fine grid, and what its rows cost on half the columns.

    Parameters
    ----------
    grids : GridSolver
        The program.
    coarse : GridSolution
        Solution on half the columns and rows.
    fine : Parameters
        Parameters of the fine grid.
    name, with_fields, limit
        The arguments of `GridSolver.solve`.

    Raises
    ------
    RunError
        If the fine grid is not solved.
    SolverError
        If no case can be made.
    """
    halved = replace(fine, columns=fine.columns // 2)
    part = TimeLimit(ROWS_SHARE * limit.left)
    try:
        rows = grids.solve(halved, name, False, part, coarse.start)
    except RunError:
        limit.waited += part.waited
        note = f"not solved on {halved.columns} x {halved.rows} cells: the error of {fine.rows} rows is in the film"
        return Grids(coarse, grids.solve(fine, name, with_fields, limit, coarse.start), note=note)
    limit.waited += part.waited
    solved = Grids(coarse, grids.solve(fine, name, with_fields, limit, rows.start), rows)
    if not _rows_matter(coarse, rows):
        return solved
    try:
        twice = grids.solve(replace(halved, rows=2 * fine.rows), name, False, limit, rows.start)
    except RunError:
        return replace(solved, note=f"not solved on {halved.columns} x {2 * fine.rows} cells: rows from fewer ones")
    return replace(solved, more_rows=twice)


def _rows_matter(coarse: GridSolution, rows: GridSolution) -> bool:
    """Tell whether what half the rows change of a film, or of its loss, is more than a trifle."""
    few, some = coarse.results, rows.results
    changes = {
        "film_offset": (few.film_offset, some.film_offset),
        "loss_compliance": (few.loss_compliance[0], some.loss_compliance[0]),
    }
    return any(
        abs(before - after) > ORDER_DIVISOR * ROWS_MATTER[name] * abs(after)
        for name, (before, after) in changes.items()
    )
