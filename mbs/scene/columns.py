"""Numbers by columns: CSV files whose titles have units, such as points of a law or of a history."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.inputs import decimal_points, read_text, separator
from ehdmaps.units import quantity

_COLUMN = re.compile(r"\s*([a-z ]+?)\s*\[([^\[\]]*)\]\s*")
_BETWEEN = {",": "commas", ";": "semicolons", "\t": "tabulators"}


def read_columns(
    path: str | Path, units: Mapping[str, str], allowed: str, most: int, longest: int, name: str = ""
) -> dict[str, list[float]]:
    """Numbers of a CSV file by the names of its columns, in SI; at least one column and one row.

    Parameters
    ----------
    path : str or Path
        Text in UTF-8 with commas, semicolons or tabulators; its first line has names with units, such as
        "load [kN]". Empty lines and lines that begin with # are passed over.
    units : mapping of str to str
        Names that columns may have, and a unit of each.
    allowed : str
        Columns, for messages.
    most, longest : int
        Rows and bytes that it may have.
    name : str
        Name of the file in messages; its path if left out.

    Raises
    ------
    InputError
        With what is wrong about the file, and where.
    """
    name = name or str(path)
    text = read_text(path, longest, f"a CSV file of at most {longest // 1_000_000} MB in UTF-8", name=name)
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if not lines:
        raise InputError(f"{name}: got an empty file; allowed: {allowed}")
    if len(lines) > most + 1:
        raise InputError(f"{name}: got {len(lines) - 1} points; allowed: up to {most}")
    (number, head), between = lines[0], separator(lines[0][1])
    factors: dict[str, float] = {}
    for title in head.split(between):
        match = _COLUMN.fullmatch(title)
        if match is None or match[1] not in units or match[1] in factors:
            raise InputError(f"{name}, line {number}: got the column {title.strip()!r:.60}; allowed: {allowed}")
        try:
            factors[match[1]] = quantity(f"1 {match[2]}", units[match[1]])
        except InputError as error:
            raise InputError(f"{name}, line {number}, column {match[1]}: {error}") from None
    rows = [_numbers(name, *line, len(factors), between) for line in lines[1:]]
    return {key: [row[k] * factor for row in rows] for k, (key, factor) in enumerate(factors.items())}


def _numbers(name: str, number: int, line: str, count: int, between: str) -> list[float]:
    """Numbers of a line."""
    try:
        values = [float(text) for text in decimal_points(line, between).split(between)]
    except ValueError:
        values = []
    if len(values) != count:
        raise InputError(
            f"{name}, line {number}: got {line.strip()!r:.60}; allowed: {count} numbers with {_BETWEEN[between]} "
            "between"
        )
    return values
