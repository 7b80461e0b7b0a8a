"""Sections of a shaft: rows of the scene, or of a CSV file with units in its header; lengths follow each other."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path

from ehdmaps.errors import InputError, Problems
from ehdmaps.inputs import decimal_points, read_text, separator
from ehdmaps.jobs.table import Table
from ehdmaps.units import LENGTH, PRESSURE, short
from mbs.flexible.shaft_parts import MOST_PARTS, Section
from mbs.scene import fields
from mbs.scene.fields import LONGEST_FILE

CSV_FORM = "length [mm], outer diameter [mm], inner diameter [mm]"
"""Header of a file of sections; its last column may be left out."""

_COLUMNS = {
    "length": "length",
    "l": "length",
    "from": "from",
    "to": "to",
    "x": "x",
    "outer diameter": "diameter",
    "diameter": "diameter",
    "inner diameter": "bore",
    "bore": "bore",
    "end outer diameter": "end_diameter",
    "end diameter": "end_diameter",
    "end inner diameter": "end_bore",
    "end bore": "end_bore",
    "youngs modulus": "youngs_modulus",
    "poisson ratio": "poisson_ratio",
    "density": "density",
}
"""Titles of the columns of a file, and the keys of a row in a scene that they stand for.

In a column x stand the places where the sections begin; its last row ends the shaft. Drawings have d for the bore
beside D for the outer diameter; either of them alone is the diameter.
"""

_LETTERS = ("d", "D")

_TITLE = re.compile(r"(.*?)[\s_]*(?:\[([^\[\]]*)\]|\(([^()]*)\)|/\s*(\S+)|[\s_](mm|cm|m|in|inch|um|GPa|MPa|Pa))?\s*")
_ALLOWED = f"a table in CSV whose first line is such as: {CSV_FORM}"


def read_sections(section: Table, folder: Path | None) -> tuple[list[Section], tuple[Path, ...]]:
    """Read `sections` of a shaft; problems are noted.

    Rows with a `length` follow each other, the first from 0; rows with `from` and `to` lie where these say.

    Parameters
    ----------
    section : Table
        The table of the shaft.
    folder : Path or None
        Folder in which the path of a file begins; None for that of the shipped systems.

    Returns
    -------
    sections : list of Section
        Those without a problem.
    files : tuple of Path
        The file that was read, if any.
    """
    allowed = f"a list of tables with length, diameter, or from, to, diameter; or the path of {_ALLOWED}"
    given = section.get("sections", allowed)
    if isinstance(given, str):
        path = fields.file_path(section, "sections", folder)
        if path is None:
            return [], ()
        rows = section.made(lambda: csv_rows(path))
        return _chained(rows or [], section.problems), (path,)
    if not isinstance(given, list):
        if "sections" in section:
            section.note("sections", f"got {short(given)}; allowed: {allowed}")
        return [], ()
    where = f"{section.where} sections"
    return _chained(((f"{where}[{index}]", values) for index, values in enumerate(given)), section.problems), ()


def csv_rows(path: Path) -> list[tuple[str, dict[str, object]]]:
    """Rows of a file of sections, each with how messages call it; values are texts with a unit, as in a scene.

    Parameters
    ----------
    path : Path
        Text in UTF-8 with commas, semicolons or tabulators; with the last two, numbers may have a decimal comma. Empty
        lines and lines that begin with # are passed over.

    Raises
    ------
    InputError
        If the file cannot be read, is too long, or is no such table; with every wrong column.
    """
    text = read_text(path, LONGEST_FILE, _ALLOWED)
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip() and line[:1] != "#"]
    if not lines:
        raise InputError(f"{path}: has no lines; allowed: {_ALLOWED}")
    if len(lines) - 1 > MOST_PARTS:
        raise InputError(f"{path}: got {len(lines) - 1} rows; allowed: 1 to {MOST_PARTS}; take longer sections")
    between = separator(lines[0][1])
    try:
        cells = list(csv.reader((line for _, line in lines), delimiter=between, strict=True))
    except csv.Error as error:
        raise InputError(f"{path}: is not CSV ({error}); allowed: {_ALLOWED}") from error
    if len(cells) != len(lines):
        raise InputError(f"{path}: a cell goes over several lines; allowed: {_ALLOWED}")
    columns = _columns(path, cells[0])
    keys = [key for key, _ in columns]
    rows = []
    for (number, _), row in zip(lines[1:], cells[1:], strict=True):
        where = f"{path}, line {number}"
        if len(row) > len(columns):
            raise InputError(f"{where}: got {len(row)} cells; allowed: up to {len(columns)}, as in the first line")
        rows.append((where, dict(_values(columns, [decimal_points(cell, between) for cell in row]))))
    return rows if "x" not in keys else _between_places(path, rows)


def _between_places(path: Path, rows: list[tuple[str, dict[str, object]]]) -> list[tuple[str, dict[str, object]]]:
    """Rows with `from` and `to`: each section goes on to where the next one begins, and the last row ends the shaft."""
    if len(rows) < 2:
        raise InputError(f"{path}: got {len(rows)} rows with x; allowed: at least two, the last one ends the shaft")
    lacking = [where for where, values in rows if "x" not in values]
    if lacking:
        raise InputError([f"{where}: has no x; allowed: one in each row" for where in lacking])
    return [
        (where, {key: value for key, value in values.items() if key != "x"} | {"from": values["x"], "to": after["x"]})
        for (where, values), (_, after) in pairwise(rows)
    ]


def csv_sections(path: Path) -> list[Section]:
    """Sections of a file, in the order of its rows.

    Parameters
    ----------
    path : Path
        The file, see `csv_rows`.

    Raises
    ------
    InputError
        With every problem.
    """
    problems = Problems()
    found = _chained(csv_rows(path), problems)
    if not found and not problems:
        problems.append(f"{path}: got no rows; allowed: 1 to {MOST_PARTS}")
    problems.check()
    return found


def _columns(path: Path, titles: Sequence[str]) -> list[tuple[str, str]]:
    """Key and unit of each column."""
    found: list[tuple[str, str]] = []
    problems = []
    split = [_split(title) for title in titles]
    both = {name for name, _ in split} >= set(_LETTERS)
    for title, (name, unit) in zip(titles, split, strict=True):
        key = _COLUMNS.get(" ".join(name.lower().replace("_", " ").split()))
        if name in _LETTERS:
            key = "bore" if both and name == "d" else "diameter"
        if key is None:
            problems.append(f"got the column {short(title.strip())}; allowed: {', '.join(_COLUMNS)}, d, D")
        elif key in (other for other, _ in found):
            problems.append(f"got the column {short(title.strip())} twice; allowed: each once")
        elif key != "poisson_ratio" and not unit:
            problems.append(f"column {short(title.strip())}: has no unit; allowed: in brackets, such as {CSV_FORM}")
        found.append((key or title, unit))
    keys = {key for key, _ in found}
    missing = [] if keys & {"length", "x"} or {"from", "to"} <= keys else ["length"]
    missing += [] if "diameter" in keys else ["diameter"]
    problems += [f"has no column of the {key}; allowed: {_ALLOWED}" for key in missing]
    if "x" in keys and keys & {"length", "from", "to"}:
        problems.append("got x beside length, from or to; allowed: one way to say where sections lie")
    if problems:
        raise InputError([f"{path}, first line: {problem}" for problem in problems])
    return found


def _split(title: str) -> tuple[str, str]:
    """Name and unit of a title such as `length [mm]`, `D (mm)`, `d_mm` or `x / mm`; no unit is empty."""
    match = _TITLE.fullmatch(title.strip())
    if match is None:
        return title.strip(), ""
    return match[1].strip(), next((unit.strip() for unit in match.groups()[1:] if unit), "")


def _values(columns: Sequence[tuple[str, str]], row: Sequence[str]) -> Iterator[tuple[str, object]]:
    """Keys and values of a row, without empty cells; a pure number only where it has no unit."""
    for (key, unit), cell in zip(columns, row, strict=False):
        text = cell.strip()
        if not text:
            continue
        if key != "poisson_ratio":
            yield key, f"{text} {unit}"
            continue
        try:
            yield key, float(text)
        except ValueError:
            yield key, text


def _chained(rows: Iterable[tuple[str, object]], problems: list[str]) -> list[Section]:
    """Sections of rows; each with a length begins where the last one with a length ends."""
    found, reached = [], 0.0
    for where, values in rows:
        table = Table(values, where, problems)
        made, end = _section(table, reached)
        reached = reached if end is None else end
        if made is not None:
            found.append(made)
    return found


def _section(table: Table, reached: float) -> tuple[Section | None, float | None]:
    """Read a cylinder or cone, and where the next one with a length begins."""
    begin: float | None
    end: float | None
    chained = "length" in table
    if chained:
        length = table.quantity("length", "m", 1e-6, 100.0, LENGTH, required=True)
        begin, end = reached, None if length is None else reached + length
        for key in ("from", "to"):
            if key in table:
                table.get(key)
                table.note(key, "stands beside length; allowed: length alone, or from and to; delete one")
    else:
        begin = table.quantity("from", "m", -100.0, 100.0, LENGTH, required=True)
        end = table.quantity("to", "m", -100.0, 100.0, LENGTH, required=True)
    diameter = table.quantity("diameter", "m", 1e-5, 100.0, LENGTH, required=True)
    bore = table.quantity("bore", "m", 0.0, 100.0, LENGTH)
    end_diameter = table.quantity("end_diameter", "m", 1e-5, 100.0, LENGTH)
    end_bore = table.quantity("end_bore", "m", 0.0, 100.0, LENGTH)
    modulus = table.quantity("youngs_modulus", "Pa", 0.0, 2e12, PRESSURE)
    ratio = table.number("poisson_ratio", -0.999, 0.499)
    material = fields.material(table)
    table.close(("length", "from", "to"))
    onward = end if chained else None
    if begin is None or end is None or diameter is None:
        return None, onward
    ends = (begin, end)
    made = table.made(
        lambda: Section(
            *ends,
            diameter,
            bore or 0.0,
            material.youngs_modulus if modulus is None else modulus,
            material.poisson_ratio if ratio is None else ratio,
            material.density,
            end_diameter,
            end_bore,
        ),
    )
    return made, onward
