"""A contact law by points from a CSV file: its columns, units and limits."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Literal

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.inputs import read_text
from ehdmaps.units import quantity
from mbs.bearings.laws import TableLaw, curve_problems

_LONGEST, _MOST = 1_000_000, 10_000
"""Longest file [bytes], and most points."""

_UNITS = {"approach": "m", "contact approach": "m", "load": "N/m", "damping": "N s/m^2"}
_ALLOWED = (
    "columns 'approach [um]' of both contacts in series, or 'contact approach [um]' of one; "
    "'load [N/mm]'; and 'damping [N s/m^2]' or none"
)
_COLUMN = re.compile(r"\s*([a-z ]+?)\s*\[([^\[\]]*)\]\s*")


def read_law(path: Path, roller_length: float) -> TableLaw:
    """Law of a roller between both raceways from a file of points, held above its last one.

    Parameters
    ----------
    path : Path
        CSV file: lines that begin with # are left out, a line of names with units, a line for each point.
    roller_length : float
        Length by which load and damping per unit length become those of a roller [m].

    Raises
    ------
    InputError
        With what is wrong about the file, and where.
    """
    name = f"law table:{path}"
    text = read_text(path, _LONGEST, "a CSV file of at most 1 MB in UTF-8", name=name)
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if not lines:
        raise InputError(f"{name}: got an empty file; allowed: {_ALLOWED}")
    names, factors = _columns(name, *lines[0])
    if len(lines) > _MOST + 1:
        raise InputError(f"{name}: got {len(lines) - 1} points; allowed: 2 to {_MOST}")
    rows = [_numbers(name, number, line, len(names)) for number, line in lines[1:]]
    values = np.array(rows).reshape(-1, len(names)) * factors
    found: dict[str, FloatArray] = dict(zip(names, values.T, strict=True))
    kind: Literal["series", "single"] = "series" if "approach" in found else "single"
    approach = found.get("approach", found.get("contact approach"))
    assert approach is not None
    damping = found.get("damping", np.zeros(approach.size))
    if problems := curve_problems(approach, found["load"], damping):
        raise InputError([f"{name}, {line}" for line in problems])
    short = f"table:{path.name}"
    law = TableLaw(short, kind, approach, found["load"], damping, roller_length, "clamp")
    return law.series()


def _columns(where: str, number: int, line: str) -> tuple[list[str], FloatArray]:
    """Names of the columns, and factors of their units to SI."""
    names, factors = [], []
    for text in line.split(","):
        match = _COLUMN.fullmatch(text)
        if match is None or match[1] not in _UNITS or match[1] in names:
            raise InputError(f"{where}, line {number}: got the column {text.strip()!r:.60}; allowed: {_ALLOWED}")
        try:
            factors.append(quantity(f"1 {match[2]}", _UNITS[match[1]]))
        except InputError as error:
            raise InputError(f"{where}, line {number}, column {match[1]}: {error}") from None
        names.append(match[1])
    if "load" not in names or ("approach" in names) == ("contact approach" in names):
        raise InputError(f"{where}, line {number}: got {line.strip()!r:.80}; allowed: {_ALLOWED}")
    return names, np.array(factors)


def _numbers(where: str, number: int, line: str, count: int) -> list[float]:
    """The numbers of a line."""
    try:
        values = [float(text) for text in line.split(",")]
    except ValueError:
        values = []
    if len(values) != count:
        raise InputError(
            f"{where}, line {number}: got {line.strip()!r:.60}; allowed: {count} numbers with commas between"
        )
    return values
