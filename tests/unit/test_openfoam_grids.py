"""What the grids of a point say together: numbers of known error in columns and rows."""

from __future__ import annotations

import time
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import pytest

from ehdmaps.openfoam import grids
from ehdmaps.openfoam.grids import Grids, with_rows
from ehdmaps.openfoam.run import RunError, TimeLimit

TRUE, BY_COLUMNS, BY_ROWS = 2.0, 0.4, 0.9


def _grid(columns: int, rows: int) -> Any:
    """A solution whose number has errors of second order."""
    return SimpleNamespace(value=TRUE + BY_COLUMNS / columns**2 + BY_ROWS / rows**2)


@pytest.mark.parametrize("twice", [False, True])
def test_errors_of_second_order_are_told_apart(twice: bool) -> None:
    """The rows' is taken off, the columns' is stated; with twice the rows less of the rows' counts as left."""
    both = Grids(_grid(10, 3), _grid(20, 6), _grid(10, 6), _grid(10, 12) if twice else None)
    value, columns, rows = both.number(lambda grid: grid.value)  # type: ignore[attr-defined]
    assert value == pytest.approx(TRUE + BY_COLUMNS / 20**2, abs=1e-14)  # round-off
    assert columns == pytest.approx(BY_COLUMNS / 20**2, rel=1e-11)
    assert rows == pytest.approx(BY_ROWS / (12 if twice else 6) ** 2, rel=1e-11)


def test_two_grids_give_the_fine_one() -> None:
    """Without grids of more rows alone: the fine grid's number, and a third of the difference."""
    value, error, rows = Grids(_grid(10, 3), _grid(20, 6)).number(lambda grid: grid.value)  # type: ignore[attr-defined]
    assert value == _grid(20, 6).value
    assert error == pytest.approx(BY_COLUMNS / 20**2 + BY_ROWS / 6**2, rel=1e-11)
    assert rows == 0.0


@dataclass(frozen=True)
class Size:
    """Cells of a grid."""

    columns: int
    rows: int


class Clock:
    """A solver of grids whose one on half the columns takes all the time it has; half of that it waits."""

    def __init__(self) -> None:
        self.now, self.left = 100.0, 0.0

    def solve(self, size: Any, name: str, with_fields: bool, limit: TimeLimit, start: Any) -> Any:
        """The fine grid, or no time left."""
        if size.columns == 20:
            self.left = limit.left
            return _grid(size.columns, size.rows)
        limit.waited += limit.left
        self.now += limit.left
        raise RunError("did not end")


def test_a_grid_that_tells_of_rows_leaves_time_for_the_film(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 80 s that are left the fine grid has 40, though 80 s went by, in 40 of which the run waited."""
    clock = Clock()
    monkeypatch.setattr(time, "monotonic", lambda: clock.now)
    monkeypatch.setattr(grids, "TimeLimit", lambda seconds: TimeLimit(seconds, clock.now))
    limit = TimeLimit(80.0, clock.now)
    solved = with_rows(clock, SimpleNamespace(start=None), Size(20, 6), "point", False, limit)  # type: ignore[arg-type]
    assert clock.left == pytest.approx(40.0, rel=1e-12)  # round-off
    assert solved.rows is None and "not solved on 10 x 6 cells" in solved.note
