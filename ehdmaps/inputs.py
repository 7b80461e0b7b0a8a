"""Files that a user named: looked at before they are opened. One rule for every reader.

A file is read only where it is a regular one and not longer than its kind can be: a pipe would be waited for and a
device has no end, whatever link leads to them. What is longer than the folder said when it was looked at is not read.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

from ehdmaps.errors import InputError

_SORTS = (
    (stat.S_ISDIR, "it is a folder"),
    (stat.S_ISFIFO, "it is a pipe"),
    (stat.S_ISCHR, "it is a device"),
    (stat.S_ISBLK, "it is a device"),
    (stat.S_ISSOCK, "it is a socket"),
)


def check_input(path: str | Path, longest: int, allowed: str, advice: str = "", name: str = "") -> int:
    """Make sure that a file can be opened and read to its end.

    Parameters
    ----------
    path : str or Path
        The file.
    longest : int
        Bytes that it may have.
    allowed : str
        What the file should have been.
    advice : str
        What to do where it is too long.
    name : str
        How messages call the file; its path if left out.

    Returns
    -------
    int
        Size of the file in bytes.

    Raises
    ------
    InputError
        If it is not there, is no regular file, may not be read, or is too long.
    """
    size = _size(path, allowed, name)
    if size > longest:
        raise InputError(
            f"{name or path}: longer than {longest} bytes (got {size}); allowed: {allowed}{'; ' * bool(advice)}{advice}"
        )
    return size


def first_bytes(path: str | Path, count: int, allowed: str, name: str = "") -> bytes:
    """Return how a file begins.

    Parameters
    ----------
    path : str or Path
        The file, of any length.
    count : int
        Bytes that are wanted; fewer come where it ends before.
    allowed, name : str
        The same as for `check_input`.

    Raises
    ------
    InputError
        If it is not there, is no regular file, or may not be read.
    """
    size = _size(path, allowed, name)
    try:
        with open(path, "rb") as file:
            return file.read(min(count, size))
    except OSError as error:
        raise _unreadable(path, error.strerror or str(error), allowed, name) from error


def read_text(path: str | Path, longest: int, allowed: str, advice: str = "", name: str = "") -> str:
    """Read a whole text; a mark at its beginning, which some editors write, is left out.

    Parameters
    ----------
    path, longest, allowed, advice, name
        The same as for `check_input`.

    Raises
    ------
    InputError
        As `check_input` does; also if it is not UTF-8.
    """
    content = first_bytes(path, check_input(path, longest, allowed, advice, name), allowed, name)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{name or path}: is not UTF-8 text (byte {error.start}); allowed: {allowed}") from error


def separator(head: str) -> str:
    r"""Character between the cells of a table: the tabulator where its first line has one, else semicolon or comma.

    Parameters
    ----------
    head : str
        First line of the table.

    Examples
    --------
    >>> separator("length [mm];outer diameter [mm]"), separator("a\tb, c\td")
    (';', '\t')
    """
    return next((mark for mark in ("\t", ";") if mark in head), ",")


def decimal_points(text: str, between: str) -> str:
    """Return cells of a table with decimal points: a comma is one where it does not stand between cells.

    Parameters
    ----------
    text : str
        A cell, or a line of numbers.
    between : str
        Character between the cells.

    Examples
    --------
    >>> decimal_points("12,5;3", ";"), decimal_points("12,5", ",")
    ('12.5;3', '12,5')
    """
    return text if between == "," else text.replace(",", ".")


def _size(path: str | Path, allowed: str, name: str) -> int:
    """Bytes of a regular file that may be read; InputError for anything else."""
    try:
        status = os.stat(path)
        if not stat.S_ISREG(status.st_mode):
            # Nothing else is opened: that alone may wait, or do something.
            sort = next((words for test, words in _SORTS if test(status.st_mode)), "it is no file")
            raise _unreadable(path, sort, allowed, name)
        with open(path, "rb"):
            return status.st_size
    except (OSError, ValueError) as error:
        raise _unreadable(path, getattr(error, "strerror", None) or str(error), allowed, name) from error


def _unreadable(path: str | Path, cause: str, allowed: str, name: str) -> InputError:
    """Error about a file that cannot be read."""
    return InputError(f"{name or path}: cannot be read ({cause}); allowed: {allowed}")
