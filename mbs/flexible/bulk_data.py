"""Bulk data of Nastran, split into entries: to count by, not to read by.

Libraries read bulk data, and leave out in silence what they do not expect. So the entries of a file are counted here.

GRID,1,,0.,0.,1.       fields apart by commas: ten a line; of a name with a star, as GRID*, six
GRID           1       or in columns of 8, of a name with a star 8 and four times 16
+, * or blanks         begin a line that goes on
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ehdmaps.errors import InputError
from ehdmaps.units import short


class Entry(NamedTuple):
    """An entry of bulk data.

    Attributes
    ----------
    line : int
        Number of its first line.
    name : str
        Name of the entry, without a star.
    fields : list of str
        Fields behind the name; those that a line leaves out are empty.
    """

    line: int
    name: str
    fields: list[str]


def entries(path: Path, names: tuple[str, ...]) -> Iterator[Entry]:
    """Split bulk data into entries.

    Parameters
    ----------
    path : Path
        Bulk data, with or without what stands before BEGIN BULK.
    names : tuple of str
        Names of the entries that are wanted.

    Raises
    ------
    InputError
        For a line of a wanted entry with more fields than it may have, lines that repeat others, and INCLUDE.
    """
    entry: Entry | None = None
    for number, text in _lines(path):
        first, fields, surplus = _split(text)
        begins = first[:1] not in ("", "+", "*")
        if begins:
            if entry is not None and entry.name in names:
                yield entry
            if first.startswith("="):
                raise _refused(path, number, text, "each entry written out; = repeats the one above")
            entry = Entry(number, first.rstrip("*").strip(), fields)
            if entry.name == "ENDDATA":
                return
        elif entry is not None:
            entry.fields.extend(fields)
        if surplus and entry is not None and entry.name in names:
            most = len(fields)
            raise _refused(
                path, number, text, f"up to {most + 2} fields a line, {most} of them data; go on in a line more"
            )
    if entry is not None and entry.name in names:
        yield entry


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """Lines of the bulk data without comments, and their numbers."""
    with path.open(encoding="latin-1") as file:
        begun = not any(line.lstrip().upper().startswith("BEGIN") for line in file)
        file.seek(0)
        for number, line in enumerate(file, start=1):
            text = line.partition("$")[0].rstrip()
            if text.lstrip()[:7].upper() == "INCLUDE":
                raise _refused(path, number, text.strip(), "bulk data in one file")
            if begun and text:
                yield number, text
            begun = begun or text.lstrip().upper().startswith("BEGIN")


def _split(text: str) -> tuple[str, list[str], bool]:
    """First field of a line; the others without the last one, which says that it goes on; whether there are more."""
    free = "," in text
    if free:
        parts = [part.strip() for part in text.split(",")]
    else:
        columns = text.expandtabs(8)
        width = 16 if "*" in columns[:8] else 8
        ends = [0, 8, *range(8 + width, 73, width), 80]
        parts = [columns[begin:end].strip() for begin, end in itertools.pairwise(ends)]
    first = parts[0].upper()
    most = 4 if "*" in first else 8
    fields = parts[1 : most + 1]
    return first, fields + [""] * (most - len(fields)), free and any(parts[most + 2 :])


def _refused(path: Path, number: int, text: str, allowed: str) -> InputError:
    """An error at a line."""
    return InputError(f"{path}, line {number}: got {short(text)}; allowed: {allowed}")
