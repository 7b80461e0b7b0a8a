"""Contacts side by side: a printed table with a column each, numbers with their errors, and JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ehdmaps.units import Display

Row = tuple[str, str, list[str]]
"""Label, unit, and a text for each contact."""


def without_nan(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return values for JSON, which has no NaN: None where there is no number.

    Parameters
    ----------
    record : mapping
        Values by name.
    """
    none = [key for key, value in record.items() if isinstance(value, float) and not math.isfinite(value)]
    return {**record, **dict.fromkeys(none)}


def records_json(records: Iterable[Mapping[str, Any]]) -> str:
    """Return one object a contact.

    Parameters
    ----------
    records : iterable of mapping
        Values of each contact, in SI.
    """
    return json.dumps([without_nan(record) for record in records], indent=2, allow_nan=False)


def with_errors(solution: Any, names: Iterable[str]) -> dict[str, float]:
    """Numbers of a solution and their errors, by name.

    Parameters
    ----------
    solution : PointSolution or RollerSolution
        The solution.
    names : iterable of str
        Names of its estimates.
    """
    found = {name: getattr(solution, name) for name in names}
    return {key: value for name, one in found.items() for key, value in ((name, one), (f"{name}_error", one.error))}


def shown_with_error(value: float, error: float, display: Display) -> str:
    """A number with its error in per cent; a dash where there is none.

    Parameters
    ----------
    value, error : float
        Number in SI, and its relative error; NaN where there is none.
    display : Display
        How it is shown.
    """
    if not math.isfinite(value):
        return "-"
    text = f"{display.value(value):.5g}"
    return text if not math.isfinite(error) else f"{text} +-{100.0 * error:.2g} %"


def number_rows(solutions: Iterable[Any], numbers: Iterable[tuple[str, str, Display]]) -> list[Row]:
    """Rows of numbers that each have an error.

    Parameters
    ----------
    solutions : iterable
        The solution of each contact.
    numbers : iterable of tuple
        Label, attribute of a solution, and display of each row.
    """
    found = list(solutions)
    return [
        (label, display.unit, [shown_with_error(one, one.error, display) for one in (getattr(s, name) for s in found)])
        for label, name, display in numbers
    ]


def rows_text(head: Sequence[str | None], names: Iterable[str], rows: Iterable[Row], more: Iterable[str] = ()) -> str:
    """Return the printed table.

    Parameters
    ----------
    head : sequence of str
        Lines above it; None and empty ones are left out.
    names : iterable of str
        Names of the contacts.
    rows : iterable of Row
        The rows.
    more : iterable of str, optional
        Lines below it.
    """
    table: list[Row] = [("", "", list(names)), *rows]
    lines = [f"  {label:18s}{unit:8s}" + "".join(f"{value:>24s}" for value in shown) for label, unit, shown in table]
    return "\n".join(line.rstrip() for line in (*filter(None, head), *lines, *more))
