"""What the grids of a point say together: numbers of known error in columns and rows."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from ehdmaps.openfoam.grids import Grids

TRUE, BY_COLUMNS, BY_ROWS = 2.0, 0.4, 0.9


def _grid(columns: int, rows: int) -> Any:
    """A solution whose number has errors of second order."""
    return SimpleNamespace(value=TRUE + BY_COLUMNS / columns**2 + BY_ROWS / rows**2)


@pytest.mark.parametrize("twice", [False, True])
def test_errors_of_second_order_are_told_apart(twice: bool) -> None:
    """The rows' is taken off, the columns' is stated; with twice the rows less of the rows' counts as left."""
    grids = Grids(_grid(10, 3), _grid(20, 6), _grid(10, 6), _grid(10, 12) if twice else None)
    value, columns, rows = grids.number(lambda grid: grid.value)  # type: ignore[attr-defined]
    assert value == pytest.approx(TRUE + BY_COLUMNS / 20**2, abs=1e-14)  # round-off
    assert columns == pytest.approx(BY_COLUMNS / 20**2, rel=1e-11)
    assert rows == pytest.approx(BY_ROWS / (12 if twice else 6) ** 2, rel=1e-11)


def test_two_grids_give_the_fine_one() -> None:
    """Without grids of more rows alone: the fine grid's number, and a third of the difference."""
    value, error, rows = Grids(_grid(10, 3), _grid(20, 6)).number(lambda grid: grid.value)  # type: ignore[attr-defined]
    assert value == _grid(20, 6).value
    assert error == pytest.approx(BY_COLUMNS / 20**2 + BY_ROWS / 6**2, rel=1e-11)
    assert rows == 0.0
