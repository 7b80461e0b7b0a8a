"""Time data as tables of numbers: names and units in the first line, a row a sample.

::

    time [s],speed [rpm],S1 [m/s2]
    0,500,0.0132
    1e-05,500.004,0.0127

Lines that begin with # are passed over. Units stand in square or round brackets. Columns are apart by commas,
semicolons or tabulators; with the last two, numbers may have a decimal comma. Numbers are written with 12 digits.
"""

from __future__ import annotations

import io
import re
import warnings
from itertools import islice
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.inputs import check_input
from ehdmaps.outputs import MARK, TABLE, written_aside
from ehdmaps.units import RPM, short
from mbs.timedata.quantities import read_unit
from mbs.timedata.records import MOST, MOST_CHANNELS, TimeChannel, TimeData, TimeRecord

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
    check_input(path, LONGEST_FILE, f"a table of numbers with names and units ({_EXAMPLE})", "record less in one file")
    head, skipped = _head(path)
    delimiter = max((";", "\t", ","), key=head.count)
    names = head.split(delimiter)
    if len(names) > MOST_CHANNELS + 2:
        raise InputError(f"{path}: got {len(names)} columns; allowed: up to {MOST_CHANNELS + 2}")
    problems: list[str] = []
    channels, factors = [], []
    for column, text in enumerate(names, start=1):
        title = _HEAD.fullmatch(text)
        if title is None:
            problems.append(
                f"{path}, column {column}: got {short(text.strip())} without a unit; allowed: a name and a unit, as in "
                f"{_EXAMPLE}"
            )
            continue
        try:
            recorded, unit, factor = read_unit(title["unit"], title["name"])
        except InputError as error:
            problems += [f"{path}, column {column} ({title['name']:.40}): {line}" for line in error.problems]
            continue
        channels.append(TimeChannel(title["name"] or f"column {column}", recorded, unit))
        factors.append(factor)
    if problems:
        raise InputError(problems)
    return channels, np.array(factors), _numbers(path, skipped, delimiter, len(names))


def _head(path: Path) -> tuple[str, int]:
    """The line of names, and how many lines the table has up to it."""
    try:
        with path.open(encoding="utf-8-sig") as file:
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
    try:
        with path.open(encoding="utf-8-sig") as file, warnings.catch_warnings():
            warnings.simplefilter("error")
            lines = islice(file, skipped, None)
            given = (line.replace(",", ".") for line in lines) if delimiter != "," else lines
            # One more than allowed, so that what is too long is known without being read to its end.
            values = np.loadtxt(given, comments="#", delimiter=delimiter, ndmin=2, max_rows=MOST + 1)
    except (ValueError, Warning, OSError, MemoryError) as error:
        raise _bad_row(path, skipped, delimiter, columns) from error
    if values.shape[0] > MOST:
        raise InputError(
            f"{path}: got more than {MOST} rows; allowed: {MOST}; cut the record, or take every second row"
        )
    if values.shape[1] != columns:
        raise _bad_row(path, skipped, delimiter, columns)
    return np.asarray(values, dtype=np.float64)


def _bad_row(path: Path, skipped: int, delimiter: str, columns: int) -> InputError:
    """Look for the line that is no row of so many numbers."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            text = line.partition("#")[0].strip()
            if number <= skipped or not text:
                continue
            parts = (text.replace(",", ".") if delimiter != "," else text).split(delimiter)
            wrong = len(parts) != columns
            for part in parts:
                try:
                    np.loadtxt(io.StringIO(part if part.strip() else "?"))
                except ValueError:
                    wrong = True
            if wrong:
                return InputError(f"{path}, line {number}: got {short(text)}; allowed: {columns} numbers, as the names")
    return InputError(f"{path}: has no numbers below its line of names; allowed: a row a sample")
