"""Time data as tables of numbers: names and units in the first line, a row a sample.

::

    time [s],speed [rpm],S1 [m/s2]
    0,500,0.0132
    1e-05,500.004,0.0127

Lines that begin with # are passed over. Units stand in square or round brackets. Columns are apart by tabulators, else
semicolons, else commas; with the first two, numbers may have a decimal comma and names any. Text is in UTF-8, UTF-16 or
Windows' own letters. Numbers are written with 12 digits.

pandas reads such tables faster, but fills short rows up with NaN, and says of what is no number not where it stands.
"""

from __future__ import annotations

import codecs
import io
import re
import warnings
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.inputs import check_input, decimal_points, first_bytes, separator
from ehdmaps.outputs import MARK, TABLE, written_aside
from ehdmaps.units import RPM, short
from mbs.timedata.records import MOST, MOST_CHANNELS, TimeChannel, TimeData, TimeRecord, read_unit

LONGEST_FILE = 2**31
"""Bytes."""

_LONGEST_LINE = 20_000
_HEAD = re.compile(r"\s*\"?(?P<name>.*?)\s*[\[(](?P<unit>[^\[\]()]*)[\])]\"?\s*")
_EXAMPLE = "time [s],speed [rpm],S1 [m/s2]"


def write_csv(path: Path, data: TimeData) -> None:
    """Write the one record of time data, by the rule of all files that are written.

    Parameters
    ----------
    path : Path
        The file.
    data : TimeData
        Time data of one record.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    (record,) = data.records
    names, columns = ["time [s]"], [record.time]
    if record.speed is not None:
        names.append("speed [rpm]")
        columns.append(np.asarray(RPM.value(1.0) * record.speed))
    names += [f"{channel.name.replace(',', ' ')} [{channel.unit}]" for channel in record.channels]
    with written_aside(path, TABLE) as aside, aside.open("w", encoding="utf-8", newline="\n") as file:
        title = " ".join(f"{data.title}, {record.label}".split())
        file.write(f"# {MARK}: {title}\n{','.join(names)}\n")
        np.savetxt(file, np.column_stack([*columns, record.values]), fmt="%.12g", delimiter=",")


def read_csv(path: Path) -> TimeData:
    """Read time data from a table.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    InputError
        With what is wrong about it.
    """
    channels, factors, values = read_table(path)
    clocks = [place for place, channel in enumerate(channels) if channel.recorded == "time"]
    if len(clocks) != 1:
        raise InputError(
            f"{path}: got {len(clocks)} columns of a time; allowed: one with a unit of time, such as 'time [s]'"
        )
    values = values * factors
    others = [place for place in range(len(channels)) if place != clocks[0]]
    named = tuple(channels[place] for place in others)
    return TimeData("", (TimeRecord(path.name, values[:, clocks[0]].copy(), named, values[:, others]),))


def read_table(path: Path) -> tuple[list[TimeChannel], FloatArray, FloatArray]:
    """Columns of a table, factors to SI, and the numbers as they stand there, shape (rows, columns).

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    InputError
        With what is wrong about it.
    """
    titles, values = titled_columns(path)
    problems = Problems()
    channels, factors = [], []
    for column, (name, given) in enumerate(titles, start=1):
        with problems.after(f"{path}, column {column} ({name:.40}): "):
            recorded, unit, factor = read_unit(given, name)
            channels.append(TimeChannel(name or f"column {column}", recorded, unit))
            factors.append(factor)
    problems.check()
    return channels, np.array(factors), values


def titled_columns(path: Path, example: str = _EXAMPLE) -> tuple[list[tuple[str, str]], FloatArray]:
    """Name and unit of each column of a table, and its numbers, shape (rows, columns).

    Parameters
    ----------
    path : Path
        The file.
    example : str
        Line of names that it might have, for messages.

    Raises
    ------
    InputError
        With what is wrong about it.
    """
    check_input(path, LONGEST_FILE, f"a table of numbers with names and units ({example})", "record less in one file")
    head, skipped = _head(path)
    delimiter = separator(head)
    names = head.split(delimiter)
    while len(names) > 1 and not names[-1].strip():  # lines that end with a delimiter
        names.pop()
    if len(names) > MOST_CHANNELS + 2:
        raise InputError(f"{path}: got {len(names)} columns; allowed: up to {MOST_CHANNELS + 2}")
    problems = Problems()
    titles = []
    for column, text in enumerate(names, start=1):
        title = _HEAD.fullmatch(text)
        if title is None:
            problems.append(
                f"{path}, column {column}: got {short(text.strip())} without a unit; allowed: a name and a unit, as in "
                f"{example}"
            )
            continue
        titles.append((title["name"], title["unit"]))
    problems.check()
    return titles, _numbers(path, skipped, delimiter, len(names))


def _encoding(path: Path) -> str:
    """Encoding of a table; of what is no UTF the one of Windows, which units such as m/s² need."""
    start = first_bytes(path, _LONGEST_LINE, "a table of numbers")
    if start[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE):
        return "utf-16"
    try:
        codecs.getincrementaldecoder("utf-8")().decode(start)
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig"


def _head(path: Path) -> tuple[str, int]:
    """The line of names, and how many lines the table has up to it."""
    try:
        with path.open(encoding=_encoding(path)) as file:
            for number, line in enumerate(islice(file, 1000), start=1):
                if len(line) > _LONGEST_LINE:
                    break
                if line.strip() and not line.lstrip().startswith("#"):
                    return line.strip("\r\n"), number
    except (UnicodeDecodeError, OSError) as error:
        raise InputError(f"{path}: is no text ({error}); allowed: a table that begins with {_EXAMPLE}") from error
    raise InputError(f"{path}: has no line of names; allowed: a table that begins with {_EXAMPLE}")


def _numbers(path: Path, skipped: int, delimiter: str, columns: int) -> FloatArray:
    """All rows below the line of names."""
    marks: set[str] = set()

    def given(lines: Iterable[str]) -> Iterator[str]:
        """Lines as numpy reads them."""
        for line in lines:
            text = line.partition("#")[0]
            marks.update(mark for mark in ",." if mark in text)
            yield _plain(text, delimiter, columns)

    try:
        with path.open(encoding=_encoding(path)) as file, warnings.catch_warnings():
            warnings.simplefilter("error")
            # One more than allowed, so that what is too long is known without being read to its end.
            rows = given(islice(file, skipped, None))
            values = np.loadtxt(rows, comments="#", delimiter=delimiter, ndmin=2, max_rows=MOST + 1)
    except (ValueError, Warning, OSError, MemoryError) as error:
        raise _bad_row(path, skipped, delimiter, columns) from error
    if values.shape[0] > MOST:
        raise InputError(
            f"{path}: got more than {MOST} rows; allowed: {MOST}; cut the record, or take every second row"
        )
    if values.shape[1] != columns:
        raise _bad_row(path, skipped, delimiter, columns)
    if delimiter != "," and len(marks) > 1:
        raise InputError(
            f"{path}: got numbers with commas and numbers with points; allowed: one of them before the decimals, and "
            "none between thousands"
        )
    return np.asarray(values, dtype=np.float64)


def _plain(text: str, delimiter: str, columns: int) -> str:
    """A row with decimal points, and without a delimiter behind its last number."""
    text = decimal_points(text, delimiter)
    ended = text.rstrip(" \r\n")
    if ended.endswith(delimiter) and ended.count(delimiter) == columns:
        return ended[: -len(delimiter)]
    return text


def _bad_row(path: Path, skipped: int, delimiter: str, columns: int) -> InputError:
    """Look for the line that is no row of so many numbers."""
    with path.open(encoding=_encoding(path), errors="replace") as file:
        for number, line in enumerate(file, start=1):
            text = line.partition("#")[0].strip()
            if number <= skipped or not text:
                continue
            parts = _plain(text, delimiter, columns).split(delimiter)
            wrong = len(parts) != columns
            for part in parts:
                try:
                    np.loadtxt(io.StringIO(part if part.strip() else "?"))
                except ValueError:
                    wrong = True
            if wrong:
                return InputError(f"{path}, line {number}: got {short(text)}; allowed: {columns} numbers, as the names")
    return InputError(f"{path}: has no numbers below its line of names; allowed: a row a sample")
