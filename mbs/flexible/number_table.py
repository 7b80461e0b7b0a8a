"""Tables of numbers in text files, read strictly: every message has file and line."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError
from ehdmaps.inputs import check_input, first_bytes
from ehdmaps.units import short

LONGEST_FILE = 4_000_000_000
"""Bytes."""

_LONGEST_LINE = 10_000
"""Bytes; a row of a table has some tens."""

_LARGEST_WHOLE = 1e12
"""Node numbers and indices beyond this are slips."""


@dataclass(frozen=True, eq=False)
class NumberTable:
    """A table of finite numbers.

    Attributes
    ----------
    path : Path
        The file.
    values : array, shape (lines, columns)
        All numbers.
    comment : str
        Lines that begin with it were passed over, as were empty ones.
    """

    path: Path
    values: FloatArray
    comment: str

    def whole(self, columns: int) -> IntArray:
        """The first columns as whole numbers, shape (lines, columns); InputError if they are none."""
        given = self.values[:, :columns]
        bad = np.flatnonzero(((given != np.round(given)) | (np.abs(given) > _LARGEST_WHOLE)).any(axis=1))
        if bad.size:
            raise self.problem(int(bad[0]), f"allowed: whole numbers up to {_LARGEST_WHOLE:.0e} for nodes and indices")
        return given.astype(np.int64)

    def problem(self, row: int, words: str) -> InputError:
        """An error that names file and line of a row, and shows the line."""
        number, text = _lines(self.path, self.comment, row)
        return InputError(f"{self.path}, line {number}: got {short(text)}; {words}")


def read_numbers(path: Path, columns: int, comment: str, delimiter: str | None = None) -> NumberTable:
    """Read a table of finite numbers.

    Parameters
    ----------
    path : Path
        Text, one row a line.
    columns : int
        Numbers in each line.
    comment : str
        One character, with which lines begin that are passed over.
    delimiter : str, optional
        Character between numbers; blanks if left out.

    Raises
    ------
    InputError
        If the file cannot be read, is empty, or a line is not made of so many finite numbers.
    """
    check_file(path)
    start = first_bytes(path, _LONGEST_LINE, "a table of numbers")
    # A line is read as one: it must not be the whole of a large file.
    if len(start) == _LONGEST_LINE and b"\n" not in start:
        raise InputError(
            f"{path}: begins with {short(start[:20])}, which is no text in lines; allowed: {columns} numbers a line; "
            "the file is of another kind, or was damaged"
        )
    check_last_line(path)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            values = np.loadtxt(path, dtype=np.float64, comments=comment, delimiter=delimiter, ndmin=2)
    except MemoryError as error:
        raise InputError(f"{path}: does not fit into the memory; take a coarser mesh") from error
    except (OSError, ValueError, Warning) as error:
        raise _found(path, columns, comment, delimiter) from error
    table = NumberTable(path, values, comment)
    if values.shape[1] != columns:
        raise table.problem(0, f"allowed: {columns} numbers a line")
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if bad.size:
        raise table.problem(int(bad[0]), "allowed: finite numbers")
    return table


def check_file(path: Path) -> None:
    """Raise InputError if there is no such file of a finite-element body, or it is too long."""
    check_input(path, LONGEST_FILE, "a file of the body", "take a coarser mesh")


def check_last_line(path: Path) -> None:
    """Raise InputError if a table ends without a line break: what is left of a number is a number, too."""
    size = check_input(path, LONGEST_FILE, "a table of numbers")
    with path.open("rb") as file:
        file.seek(max(size - 1, 0))
        if size and file.read(1) not in (b"\n", b"\r"):
            raise InputError(
                f"{path}: its last line has no end; allowed: a table that is whole; the file was cut off, or add a "
                "line break where it was not"
            )


def _found(path: Path, columns: int, comment: str, delimiter: str | None) -> InputError:
    """Look for the line that is no row of numbers."""
    empty = True
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            text = line.partition(comment)[0].strip()
            if not text:
                continue
            empty = False
            try:
                count = len([float(part) for part in text.split(delimiter)])
            except ValueError:
                count = -1
            if count != columns:
                return InputError(
                    f"{path}, line {number}: got {short(text)}; allowed: {columns} numbers a line; the file is of "
                    "another kind, or was cut off"
                )
    words = "has no numbers" if empty else "is not a table of numbers"
    return InputError(
        f"{path}: {words}; allowed: {columns} numbers a line; the file is of another kind, or was cut off"
    )


def _lines(path: Path, comment: str, row: int) -> tuple[int, str]:
    """Number and text of the line of a row."""
    seen = -1
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            text = line.partition(comment)[0].strip()
            seen += bool(text)
            if seen == row:
                return number, text
    return 0, ""
